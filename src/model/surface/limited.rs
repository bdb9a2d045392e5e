//! A shape that cannot touch beyond the ends of the bodies.

use ndarray::{Array2, Axis};

use super::{Extent, Surface};
use crate::error::Result;
use crate::model::grid::Grid;

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
    fn gap(&self, x: f64, y: f64) -> f64 {
        if self.is_within(x) {
            self.shape.gap(x, y)
        } else {
            f64::INFINITY
        }
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

    fn marks(&self) -> [Vec<f64>; 2] {
        self.shape.marks()
    }

    fn radii(&self) -> [f64; 2] {
        self.shape.radii()
    }

    fn grid(&self) -> Option<Grid> {
        self.shape.grid()
    }

    fn rolling_direction(&self) -> Option<[f64; 2]> {
        self.shape.rolling_direction()
    }
}
