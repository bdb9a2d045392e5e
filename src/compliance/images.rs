//! Sums of kernels over the images of a cell, on grids that repeat; derived here.
//!
//! Images nearer than the longer period are summed one by one. The others together are smooth, and interpolated from
//! Chebyshev nodes. There, M rings of them are summed; all beyond have the means of the kernel over whole periods, which
//! are everything less the response U under one rectangle of (2M + 1)² periods. With central differences δ over a
//! period L, and cells of length rL,
//!
//! ```text
//! Σ K(x + kL) = const − (1 + (r² − 1) δ²/24 + (r² − 1)(r² − 9) δ⁴/1920 + …) U     from sinh(r asinh s)/(r s), s = δ/2
//! ```
//!
//! along each direction. What the differences leave falls as M⁻⁹. A constant is left, which the response to a uniform
//! load fixes.

use std::ops::RangeInclusive;

use ndarray::{Array2, ArrayView1, Axis};
use rayon::prelude::*;

use crate::model::grid::Grid;
use crate::numerics::rounding::cells_within;
use crate::numerics::special::{barycentric, chebyshev_nodes};

/// Chebyshev nodes along each direction. Images that are summed lie as far away as the interval is long, so that the
/// interpolation errs by 10⁻¹⁴ of them.
const NODES: usize = 14;

/// The images of the cells of one grid, and where their sums are needed.
#[derive(Debug, Clone)]
pub(crate) struct CellImages {
    spacing: [f64; 2],
    size: [f64; 2],
    shape: [usize; 2],
    periodic: [bool; 2],
    /// Numbers of the farthest images that are summed one by one everywhere, and of those summed at nodes.
    near: [i64; 2],
    all: [i64; 2],
    rings: f64,
    /// From the nodes to the offsets that are computed.
    interpolations: [Array2<f64>; 2],
}

impl CellImages {
    /// The images on `grid`, summed one by one up to so many `rings` of the longest length of what is summed.
    pub(crate) fn plan(grid: &Grid, rings: f64) -> Self {
        let (spacing, size, periodic) = (grid.spacing(), grid.size(), grid.is_periodic());
        let longest = size[0].max(size[1]);
        let images = |distance: f64| {
            [0, 1].map(|k| match periodic[k] {
                true => cells_within(distance, size[k]) as i64,
                false => 0,
            })
        };
        let mut images = Self {
            spacing,
            size,
            shape: grid.shape(),
            periodic,
            near: images(longest),
            all: images(rings * longest),
            rings,
            interpolations: [0, 1].map(|_| Array2::zeros((0, 0))),
        };
        let kept = images.kept();
        images.interpolations = [0, 1].map(|k| {
            let offsets: Vec<f64> = (0..kept[k]).map(|i| i as f64 * spacing[k]).collect();
            interpolation(images.span(k), &offsets)
        });
        images
    }

    /// The images of these cells where their sums are needed at other `offsets` along x, which is open, up to the length
    /// of the grid.
    pub(crate) fn at_offsets(mut self, offsets: &[f64]) -> Self {
        self.interpolations[0] = interpolation(self.span(0), offsets);
        self
    }

    /// Length of the interval from whose nodes sums are interpolated: half a period, or the grid.
    fn span(&self, axis: usize) -> f64 {
        match self.periodic[axis] {
            true => 0.5 * self.size[axis],
            false => self.size[axis],
        }
    }

    /// Numbers of offsets that are computed: half a period, or all. The others mirror them.
    pub(crate) fn kept(&self) -> [usize; 2] {
        [0, 1].map(|k| match self.periodic[k] {
            true => self.shape[k] / 2 + 1,
            false => self.shape[k],
        })
    }

    /// Largest distance at which cells are evaluated.
    pub(crate) fn reach(&self) -> f64 {
        2.0 * (self.rings + 2.0) * self.size[0].max(self.size[1])
    }

    /// Largest distance at which a block is evaluated.
    pub(crate) fn block_reach(&self) -> f64 {
        3.0 * (self.size[0] + self.size[1])
    }

    /// Images that are summed one by one along a direction: from −(near − 1) to near, the middle of which is that of
    /// the offsets.
    pub(crate) fn near(&self, k: usize) -> RangeInclusive<i64> {
        match self.periodic[k] {
            true => 1 - self.near[k]..=self.near[k],
            false => 0..=0,
        }
    }

    /// Place of an image relative to `at`.
    pub(crate) fn place(&self, at: [f64; 2], [k, l]: [i64; 2]) -> [f64; 2] {
        [at[0] - k as f64 * self.size[0], at[1] - l as f64 * self.size[1]]
    }

    /// Periods along each direction; an open direction has the cell itself.
    fn periods(&self) -> [f64; 2] {
        [0, 1].map(|k| match self.periodic[k] {
            true => self.size[k],
            false => self.spacing[k],
        })
    }

    /// Sides of the rectangle that holds all rings.
    pub(crate) fn block_sides(&self) -> [f64; 2] {
        let periods = self.periods();
        [0, 1].map(|k| (2 * self.all[k] + 1) as f64 * periods[k])
    }

    /// Sums over the images that are not near, of C kernels at the offsets that are computed, up to constants.
    /// `cell` is the response to a cell at a distance, `block` that to the rectangle under the same load. On the threads
    /// of the caller.
    pub(crate) fn far<const C: usize>(
        &self,
        cell: impl Fn([f64; 2]) -> [f64; C] + Sync,
        block: impl Fn([f64; 2]) -> [f64; C] + Sync,
    ) -> Vec<Array2<f64>> {
        let nodes = chebyshev_nodes::<NODES>();
        let at = |node: usize| {
            let [[x, _], [y, _]] = [nodes[node / NODES], nodes[node % NODES]];
            let at = [0.5 * self.span(0) * (1.0 + x), 0.5 * self.span(1) * (1.0 + y)];
            let mut sums = self.beyond(&block, at).map(|value| -value);
            for k in -self.all[0]..=self.all[0] {
                for l in -self.all[1]..=self.all[1] {
                    if self.near(0).contains(&k) && self.near(1).contains(&l) {
                        continue;
                    }
                    let values = cell(self.place(at, [k, l]));
                    sums.iter_mut().zip(values).for_each(|(s, v)| *s += v);
                }
            }
            sums
        };
        let sums: Vec<[f64; C]> = (0..NODES * NODES).into_par_iter().map(at).collect();
        let [xs, ys] = &self.interpolations;
        let interpolated = |component: usize| {
            let at_nodes =
                Array2::from_shape_fn((NODES, NODES), |(a, b)| sums[a * NODES + b][component]);
            xs.dot(&at_nodes).dot(&ys.t())
        };
        (0..C).map(interpolated).collect()
    }

    /// What all images beyond the rings lack of everything.
    fn beyond<const C: usize>(
        &self,
        block: &impl Fn([f64; 2]) -> [f64; C],
        at: [f64; 2],
    ) -> [f64; C] {
        let periods = self.periods();
        let [along, across] = [0, 1].map(|k| stencil((self.spacing[k] / periods[k]).powi(2)));
        let share = self.spacing[0] * self.spacing[1] / (periods[0] * periods[1]);
        let mut sums = [0.0; C];
        for (k, a) in (-3..=3).zip(along) {
            for (l, b) in (-3..=3).zip(across) {
                if a * b != 0.0 {
                    let place =
                        [at[0] + f64::from(k) * periods[0], at[1] + f64::from(l) * periods[1]];
                    let values = block(place);
                    sums.iter_mut().zip(values).for_each(|(s, v)| *s += share * a * b * v);
                }
            }
        }
        sums
    }

    /// Coefficients at all offsets from those that were computed, of a kernel that is odd along some directions:
    /// C\[n − i\] = ±C\[i\] along periodic ones.
    pub(crate) fn whole(&self, kept: &Array2<f64>, odd: [bool; 2]) -> Array2<f64> {
        let folded = |k: usize, i: usize| {
            let n = self.shape[k];
            let sign = if odd[k] { -1.0 } else { 1.0 };
            match self.periodic[k] {
                true if 2 * i > n => (n - i, sign),
                // What is its own mirror image is 0 where it is odd.
                true if 2 * i == n => (i, 0.5 + 0.5 * sign),
                _ => (i, 1.0),
            }
        };
        Array2::from_shape_fn(self.shape, |(i, j)| {
            let ((i, along), (j, across)) = (folded(0, i), folded(1, j));
            along * across * kept[[i, j]]
        })
    }

    /// Replaces the mean over what repeats: `uniform` is the response to a uniform load, at each offset along a
    /// direction that is open, or anywhere.
    pub(crate) fn with_mean(&self, coefficients: &mut Array2<f64>, uniform: &[f64]) {
        if self.periodic == [true; 2] {
            let cells = coefficients.len() as f64;
            let mean = coefficients.sum() / cells;
            *coefficients += uniform[0] / cells - mean;
            return;
        }
        let open = usize::from(self.periodic[0]);
        for (mut line, uniform) in coefficients.axis_iter_mut(Axis(open)).zip(uniform) {
            let mean = line.sum() / line.len() as f64;
            line += uniform / line.len() as f64 - mean;
        }
    }
}

/// Weights of the places −3, …, 3 for the mean over a period, of cells whose length has the ratio's square `r` to it.
fn stencil(r: f64) -> [f64; 7] {
    let second = (r - 1.0) / 24.0;
    let fourth = second * (r - 9.0) / 80.0;
    let sixth = fourth * (r - 25.0) / 168.0;
    let middle = 1.0 - 2.0 * second + 6.0 * fourth - 20.0 * sixth;
    let first = second - 4.0 * fourth + 15.0 * sixth;
    let next = fourth - 6.0 * sixth;
    [sixth, next, first, middle, first, next, sixth]
}

/// Matrix (offsets, nodes) from values at the nodes on \[0, span\] to those at `offsets`.
fn interpolation(span: f64, offsets: &[f64]) -> Array2<f64> {
    let nodes = chebyshev_nodes::<NODES>();
    let mut matrix = Array2::zeros((offsets.len(), NODES));
    for (offset, mut row) in offsets.iter().zip(matrix.rows_mut()) {
        row.assign(&ArrayView1::from(&barycentric(&nodes, 2.0 * offset / span - 1.0)));
    }
    matrix
}
