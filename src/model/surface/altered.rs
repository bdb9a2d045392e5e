//! Shapes of a solve: raised by a field, and cut off at the ends of the bodies.

use ndarray::{Array2, Axis};

use super::{Extent, Surface};
use crate::error::Result;
use crate::model::grid::Grid;

/// A shape plus a field on the cells of a grid, bilinear between cell centres and constant beyond the outer ones.
#[derive(Debug)]
pub(crate) struct Lifted<'a> {
    shape: &'a dyn Surface,
    grid: Grid,
    lift: Array2<f64>,
}

impl<'a> Lifted<'a> {
    pub(crate) fn new(shape: &'a dyn Surface, grid: &Grid, lift: Array2<f64>) -> Self {
        Self { shape, grid: *grid, lift }
    }

    fn at(&self, x: f64, y: f64) -> f64 {
        let around = |axis: usize, at: f64| {
            let (n, spacing) = (self.grid.shape()[axis], self.grid.spacing()[axis]);
            let first = self.grid.center()[axis] - 0.5 * (n - 1) as f64 * spacing;
            let position = ((at - first) / spacing).clamp(0.0, (n - 1) as f64);
            let below = (position as usize).min(n.saturating_sub(2));
            (below, (below + 1).min(n - 1), position - below as f64)
        };
        let ((i, k, s), (j, l, t)) = (around(0, x), around(1, y));
        let along = |i: usize| self.lift[[i, j]] * (1.0 - t) + self.lift[[i, l]] * t;
        along(i) * (1.0 - s) + along(k) * s
    }
}

impl Surface for Lifted<'_> {
    fn base(&self) -> Option<&dyn Surface> {
        Some(self.shape)
    }

    fn gap(&self, x: f64, y: f64) -> f64 {
        self.shape.gap(x, y) + self.at(x, y)
    }

    fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
        let gaps = self.shape.gaps(grid)?;
        if *grid == self.grid {
            return Ok(gaps + &self.lift);
        }
        let (x, y) = (grid.x(), grid.y());
        let lift = Array2::from_shape_fn(gaps.dim(), |(i, j)| self.at(x[i], y[j]));
        Ok(gaps + lift)
    }
}

/// A shape within a range of x.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limited<'a> {
    shape: &'a dyn Surface,
    range: [f64; 2],
}

impl<'a> Limited<'a> {
    pub(crate) fn new(shape: &'a dyn Surface, range: [f64; 2]) -> Self {
        Self { shape, range }
    }

    fn is_within(&self, x: f64) -> bool {
        x >= self.range[0] && x <= self.range[1]
    }
}

impl Surface for Limited<'_> {
    fn base(&self) -> Option<&dyn Surface> {
        Some(self.shape)
    }

    fn gap(&self, x: f64, y: f64) -> f64 {
        if self.is_within(x) { self.shape.gap(x, y) } else { f64::INFINITY }
    }

    fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
        let mut gaps = self.shape.gaps(grid)?;
        for (x, mut row) in grid.x().iter().zip(gaps.axis_iter_mut(Axis(0))) {
            if !self.is_within(*x) {
                row.fill(f64::INFINITY);
            }
        }
        Ok(gaps)
    }

    fn extent(&self) -> [Extent; 2] {
        let [along_x, along_y] = self.shape.extent();
        [along_x.and(Extent::CutOff(self.range)), along_y]
    }
}
