//! Tractions to start from, found on cells that are twice as long.

use std::ops::ControlFlow;

use super::newton::{CellState, ConvolutionWatch, Effort, Law, Misfit, Operator, TractionProblem};
use crate::compliance::traction::Tangential;

/// Cells along each direction of a window that is halved, at least.
const HALVED: usize = 64;

/// Tolerance on longer cells: about what they differ by from those that are half as long.
const TOLERANCE: f64 = 1e-3;

/// Convolutions on longer cells, at most: where they do not do, nothing is gained.
const MOST: usize = 100;

/// A start, and what it took.
pub(super) struct NestedStart {
    pub(super) q: Vec<f64>,
    /// Convolutions, as those of the problem.
    pub(super) convolutions: f64,
    pub(super) stopped: bool,
}

/// The tractions of `problem` on longer cells, in shares of the bound; `q` where these are not found.
pub(super) fn start(
    problem: &TractionProblem,
    tangential: &Tangential,
    q: Vec<f64>,
    effort: Effort,
    watch: &mut ConvolutionWatch,
) -> NestedStart {
    let shape = problem.operator.window.shape;
    let halved = tangential.halved();
    let none = |q, convolutions, stopped| NestedStart { q, convolutions, stopped };
    if halved.iter().zip(shape).any(|(halved, n)| *halved && n < HALVED) {
        return none(q, 0.0, false);
    }
    let Ok(coarser) = tangential.coarser() else {
        return none(q, 0.0, false);
    };
    // In rolling, displacements change over a longer cell; and as ahead of the window there are none, no cell there bears.
    let rolling = problem.operator.rolling;
    let cells = Nested { shape, halved, beside: usize::from(rolling.is_some()) };
    let window = coarser.window(cells.coarse_shape());
    let longer = rolling.map_or(1.0, |direction| if halved[direction.axis()] { 2.0 } else { 1.0 });
    let law = Law { bound: cells.means(&problem.law.bound, 1.0) };
    let coarse = TractionProblem {
        operator: Operator { window: &window, rolling },
        law: &law,
        given: cells.both(&problem.given, longer),
        columns: problem.columns.iter().map(|column| cells.both(column, longer)).collect(),
        forces: problem.forces.iter().map(|force| longer * force / cells.count()).collect(),
    };
    let effort = Effort { tolerance: effort.tolerance.max(TOLERANCE), most: MOST };
    let share = 1.0 / cells.count();
    let mut told = |done: usize, misfit: Misfit| watch((share * done as f64) as usize, misfit);
    let before = start(&coarse, &coarser, cells.both(&q, 1.0), effort, &mut told);
    if before.stopped {
        return none(q, share * before.convolutions, true);
    }
    let spent = before.convolutions;
    let mut told = |done: usize, misfit: Misfit| -> ControlFlow<()> {
        watch((share * (spent + done as f64)) as usize, misfit)
    };
    let found = coarse.newton(before.q, effort, &mut told);
    let convolutions = share * (spent + found.convolutions as f64);
    let q = match found.misfit.worst() <= effort.tolerance {
        true => cells.shares(&found.q, &found.states, &law.bound, &problem.law.bound),
        false => q,
    };
    none(q, convolutions, found.stopped)
}

/// The cells of a window, and those of which each holds two along some directions.
struct Nested {
    shape: [usize; 2],
    halved: [bool; 2],
    /// Longer cells on either side, as many as [`Tangential::coarser`] has more.
    beside: usize,
}

impl Nested {
    fn coarse_shape(&self) -> [usize; 2] {
        [0, 1].map(|k| match self.halved[k] {
            true => self.shape[k].div_ceil(2) + 2 * self.beside,
            false => self.shape[k],
        })
    }

    /// The longer cell that holds a cell.
    fn of(&self, at: usize, k: usize) -> usize {
        if self.halved[k] { at / 2 + self.beside } else { at }
    }

    /// Cells in one.
    fn count(&self) -> f64 {
        self.halved.iter().map(|halved| if *halved { 2.0 } else { 1.0 }).product()
    }

    /// `factor` times the means over longer cells; beyond the window there is 0.
    fn means(&self, field: &[f64], factor: f64) -> Vec<f64> {
        let [columns, coarse] = [self.shape[1], self.coarse_shape()[1]];
        let mut means = vec![0.0; coarse * self.coarse_shape()[0]];
        for (at, value) in field.iter().enumerate() {
            means[self.of(at / columns, 0) * coarse + self.of(at % columns, 1)] +=
                factor * value / self.count();
        }
        means
    }

    /// The means of both components of a field.
    fn both(&self, field: &[f64], factor: f64) -> Vec<f64> {
        let (x, y) = field.split_at(self.shape[0] * self.shape[1]);
        [self.means(x, factor), self.means(y, factor)].concat()
    }

    /// Tractions within `bound` that are the same share of it as `q` of the `coarse_bound`, interpolated; those of cells
    /// that slip reach it.
    fn shares(
        &self,
        q: &[f64],
        states: &[CellState],
        coarse_bound: &[f64],
        bound: &[f64],
    ) -> Vec<f64> {
        let [rows, columns] = self.coarse_shape();
        let (cells, coarse) = (bound.len(), rows * columns);
        // The longer cell and the neighbour on whose side a cell is, with their weights.
        let beside = |at: usize, k: usize, n: usize| -> [(usize, f64); 2] {
            let own = self.of(at, k);
            if !self.halved[k] {
                return [(own, 1.0), (own, 0.0)];
            }
            let next = if at % 2 == 0 { own.saturating_sub(1) } else { (own + 1).min(n - 1) };
            [(own, 0.75), (next, 0.25)]
        };
        let mut fine = vec![0.0; 2 * cells];
        for (at, bound) in bound.iter().enumerate().filter(|(_, bound)| **bound > 0.0) {
            let (i, j) = (at / self.shape[1], at % self.shape[1]);
            let (mut sum, mut weight) = ([0.0; 2], 0.0);
            let [along, across] = [beside(i, 0, rows), beside(j, 1, columns)];
            for (i, wi) in along {
                for (j, wj) in across {
                    let k = i * columns + j;
                    if coarse_bound[k] > 0.0 {
                        sum[0] += wi * wj * q[k] / coarse_bound[k];
                        sum[1] += wi * wj * q[coarse + k] / coarse_bound[k];
                        weight += wi * wj;
                    }
                }
            }
            let own = along[0].0 * columns + across[0].0;
            let size = sum[0].hypot(sum[1]);
            let slips = matches!(states[own], CellState::Slip { .. }) && size > 0.0;
            let scale = bound / if slips { size } else { weight };
            fine[at] = sum[0] * scale;
            fine[cells + at] = sum[1] * scale;
        }
        fine
    }
}
