//! What the stress of a patch of finer cells lacks: that of the load beside it, from plans on the whole grid.

use std::ops::ControlFlow;

use ndarray::Array2;

use super::options::StressProgress;
use super::plan::Evaluation;
use super::subcell::STRESSES;
use crate::compliance::response::interior::Place;
use crate::model::grid::{Grid, Window};
use crate::model::surface::Surface;

/// Values in the cells of a grid, interpolated by cubics through four cells along each axis.
#[derive(Debug)]
pub(super) struct Sampled {
    values: Array2<f64>,
    first: [f64; 2],
    spacing: [f64; 2],
}

impl Sampled {
    pub(super) fn new(grid: &Grid, values: Array2<f64>) -> Self {
        Self { values, first: [grid.x()[0], grid.y()[0]], spacing: grid.spacing() }
    }

    /// Numbers of the cells around a coordinate, and their weights.
    fn stencil(&self, axis: usize, at: f64) -> Vec<(usize, f64)> {
        let count = self.values.shape()[axis];
        if count == 1 {
            return vec![(0, 1.0)];
        }
        let size = count.min(4);
        let position = (at - self.first[axis]) / self.spacing[axis];
        let start = (position.floor() - 1.0).clamp(0.0, (count - size) as f64);
        let t = position - start;
        let weight = |k: usize| -> f64 {
            let others = (0..size).filter(|other| *other != k);
            others.map(|other| (t - other as f64) / (k as f64 - other as f64)).product()
        };
        (0..size).map(|k| (start as usize + k, weight(k))).collect()
    }

    pub(super) fn at(&self, [x, y]: [f64; 2]) -> f64 {
        let columns = self.stencil(1, y);
        let row = |(i, wx): &(usize, f64)| -> f64 {
            wx * columns.iter().map(|(j, wy)| wy * self.values[[*i, *j]]).sum::<f64>()
        };
        self.stencil(0, x).iter().map(row).sum()
    }
}

/// The gap of a patch without its own displacement.
impl Surface for Sampled {
    fn gap(&self, x: f64, y: f64) -> f64 {
        let gap = self.at([x, y]);
        if gap.is_finite() { gap } else { f64::INFINITY }
    }
}

/// What the stress of a patch lacks, from plans on the whole grid, and the cells of the patch that count.
#[derive(Debug)]
pub(super) struct OutsidePatch<'a> {
    pub(super) grid: &'a Grid,
    /// Plans, and the factor of each.
    pub(super) parts: Vec<(Evaluation<'a>, f64)>,
    pub(super) core: Window,
    /// The six components at the place that was evaluated last.
    pub(super) fields: Vec<Sampled>,
}

impl<'a> OutsidePatch<'a> {
    /// Evaluates the stress at `place`, and adds it in the cells of `grid` that count.
    pub(super) fn add(
        &mut self,
        place: &Place,
        grid: &Grid,
        fields: &mut [Vec<f64>; STRESSES],
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        let cells = self.grid.shape().iter().product();
        let mut sums = vec![vec![0.0; cells]; STRESSES];
        let mut planes = vec![vec![0.0; cells]; STRESSES];
        for (evaluation, factor) in &mut self.parts {
            let mut outputs: Vec<&mut [f64]> = planes.iter_mut().map(Vec::as_mut_slice).collect();
            evaluation.plane(place, &mut outputs, progress)?;
            for (sum, plane) in sums.iter_mut().zip(&planes) {
                sum.iter_mut().zip(plane).for_each(|(sum, value)| *sum += *factor * value);
            }
        }
        let shape = self.grid.shape();
        let sampled =
            |sum| Sampled::new(self.grid, Array2::from_shape_vec(shape, sum).unwrap_or_default());
        self.fields = sums.into_iter().map(sampled).collect();
        let (x, y, [_, ny]) = (grid.x(), grid.y(), grid.shape());
        let columns: Vec<_> =
            self.core[1].clone().map(|j| self.fields[0].stencil(1, y[j])).collect();
        for i in self.core[0].clone() {
            let rows = self.fields[0].stencil(0, x[i]);
            for (field, sampled) in fields.iter_mut().zip(&self.fields) {
                for (j, columns) in self.core[1].clone().zip(&columns) {
                    let row = |(i, wx): &(usize, f64)| -> f64 {
                        let along = columns.iter().map(|(j, wy)| wy * sampled.values[[*i, *j]]);
                        wx * along.sum::<f64>()
                    };
                    field[i * ny + j] += rows.iter().map(row).sum::<f64>();
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// The components at a point, at the place that was evaluated last.
    pub(super) fn at(&self, point: [f64; 2]) -> Vec<f64> {
        self.fields.iter().map(|field| field.at(point)).collect()
    }
}
