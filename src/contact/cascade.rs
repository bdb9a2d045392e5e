//! The contact window on nested grids, around preconditioned conjugate gradients: a method of nacre's own.
//!
//! The problem is solved on a grid of a few cells first; each solution, interpolated, is where the
//! next finer grid starts. On each grid only a window around the contact is solved. The outside is checked
//! afterwards, when the displacement is computed on the whole grid: where something overlaps there, the
//! window opens.

pub(super) mod discretisation;
pub(super) mod levels;

use ndarray::Array2;

use super::problem::Problem;
use super::problem::fields::Fields;
use super::problem::freedoms::Freedoms;
use super::problem::patch::{Patch, bounds, enclosing, widened};
use super::solver::{Outcome, StopCriteria, Tally, Termination, polonsky_keer};
use super::start::uniform_pressure;
use crate::error::Result;
use crate::model::grid::full_window;
use crate::model::surface::Surface;
use discretisation::GridResult;
use levels::{Level, Levels};

/// Tolerance on level 1, with which the finest grid is compared; chosen by trial.
const COARSE_TOLERANCE: f64 = 1e-5;

/// Tolerance on the levels above: somewhat below their discretisation error; chosen by trial.
const COARSER_TOLERANCE: f64 = 1e-4;

/// Residual and overlap from which on the reference algorithm goes on where the preconditioned iteration ended. A worse
/// pressure cost it two to five times the iterations that it takes from a uniform one, on coats 1e3 to 1e5 times harder
/// than the body.
const GOOD_START: f64 = 1e-5;

/// Certificates that may fail on a window that need not open, by rounding of the displacement.
const RETRIES: usize = 2;

/// Solutions on the coarser grids.
pub(super) struct Coarser {
    /// Pressure on the last grid that was solved.
    pressure: Option<Patch>,
    /// Results from the coarsest grid on.
    results: Vec<GridResult>,
    /// The outcome on the grid where the caller stopped the solve.
    stopped: Option<Outcome>,
}

impl Coarser {
    /// Solves on the coarser grids of `planned`, for the degrees of freedom and the `gap` of the finest.
    /// `None` where `shape` has no gap for coarser cells, and the `gap` that serves instead is not given.
    pub(super) fn solve(
        freedoms: &Freedoms,
        gap: Option<&Array2<f64>>,
        shape: &dyn Surface,
        planned: &Levels,
        criteria: StopCriteria,
        tally: &mut Tally,
    ) -> Option<Self> {
        let levels = planned.coarser(freedoms, gap, shape)?;
        let mut solved = Self { pressure: None, results: Vec::new(), stopped: None };
        for (number, level) in levels.iter().enumerate().rev() {
            let tolerance = match number {
                0 => COARSE_TOLERANCE,
                _ => COARSER_TOLERANCE,
            };
            let criteria =
                StopCriteria { tolerance: criteria.tolerance.max(tolerance), ..criteria };
            let Some(mut patch) = solved.start(level) else {
                continue;
            };
            if solved.stopped.is_none() {
                tally.iterations = 0;
                let outcome = level.solve(&mut patch, criteria, tally);
                if outcome.termination == Termination::Stopped {
                    solved.stopped = Some(outcome);
                }
                solved.results.push(level.result(&patch, outcome.lambda));
            }
            solved.pressure = Some(patch);
        }
        Some(solved)
    }

    /// The balanced pressure that `level` starts from: the interpolated one, or else a uniform one. `None`
    /// where coarse cells cannot carry the moments that fine ones can.
    fn start(&mut self, level: &Level) -> Option<Patch> {
        let shape = level.shape();
        let halved = level.halved();
        if (halved.iter().zip(shape)).any(|(halved, n)| !halved && n > 1) {
            // Results are comparable only between grids of which all directions were halved.
            self.results.clear();
        }
        let mut patch = match self.pressure.take() {
            Some(coarse) => coarse.interpolated(shape, halved),
            None => {
                let uniform = level.freedoms.typical_pressure(level.gap.len());
                Patch::of_grid(&Array2::from_elem(shape, uniform))
            }
        };
        let balanced = level.balance(&mut patch);
        if !balanced {
            self.results.clear();
        }
        balanced.then_some(patch)
    }
}

/// The finest grid, and a window around its contact.
pub(super) struct Cascade<'a> {
    finest: Level<'a>,
    patch: Patch,
    /// Results of the coarser grids, from the coarsest on.
    pub(super) results: Vec<GridResult>,
    /// The outcome where the caller stopped the solve on a coarser grid.
    stopped: Option<Outcome>,
}

impl<'a> Cascade<'a> {
    /// Starts the finest grid from the solutions on the coarser ones; `None` where no balanced pressure was
    /// found.
    pub(super) fn after(
        mut coarser: Coarser,
        problem: &Problem<'a>,
        gap: &'a Array2<f64>,
        planned: &'a Levels,
        tally: &mut Tally,
    ) -> Option<Self> {
        if coarser.stopped.is_none() {
            tally.iterations = 0;
        }
        let finest = planned.finest(problem, gap);
        let patch = coarser.start(&finest)?;
        Some(Self { finest, patch, results: coarser.results, stopped: coarser.stopped })
    }

    /// Starts the finest grid from a `given` pressure.
    pub(super) fn from(
        given: &Array2<f64>,
        problem: &Problem<'a>,
        gap: &'a Array2<f64>,
        planned: &'a Levels,
    ) -> Self {
        let finest = planned.finest(problem, gap);
        let mut patch = Patch::of_grid(given);
        if let Some(contact) = patch.contact() {
            patch = patch.moved(widened(&contact, finest.shape()));
        }
        Self { finest, patch, results: Vec::new(), stopped: None }
    }

    /// Solves in a window, which opens until nothing overlaps on the whole grid. Where the iteration breaks down, the
    /// reference algorithm goes on.
    ///
    /// # Errors
    /// Those of the reference algorithm, and of a pressure for it to start from.
    pub(super) fn solve_in_window(
        mut self,
        problem: &Problem,
        fields: &mut Fields,
        criteria: StopCriteria,
        tally: &mut Tally,
    ) -> Result<Outcome> {
        let mut retries = 0;
        loop {
            // Where the caller stopped a coarser grid, nothing more is solved.
            let outcome = (self.stopped)
                .unwrap_or_else(|| self.finest.solve(&mut self.patch, criteria, tally));
            fields.take(&self.patch);
            let quality = fields.certify(problem, outcome.lambda);
            tally.work += problem.convolution.work();
            let stopped = outcome.termination == Termination::Stopped;
            let limited = tally.iterations >= criteria.max_iterations;
            if stopped || limited || quality.meets(criteria.tolerance) {
                return Ok(outcome);
            }
            let converged = outcome.termination == Termination::Converged;
            if converged && self.open(problem, fields) {
                continue;
            }
            retries += 1;
            if !converged || retries > RETRIES {
                if !converged && !quality.meets(GOOD_START) {
                    fields.pressure = uniform_pressure(problem)?;
                }
                return polonsky_keer::solve(problem, fields, criteria, tally);
            }
        }
    }

    /// Opens the window around the cells that overlap outside it; false where there are none.
    fn open(&mut self, problem: &Problem, fields: &Fields) -> bool {
        let shape = self.finest.shape();
        let [x, y] = self.patch.window.clone();
        let outside = |i: usize, j: usize| !(x.contains(&i) && y.contains(&j));
        let g = fields.gap(problem);
        let found = bounds(&full_window(shape), |i, j| outside(i, j) && g[i * shape[1] + j] < 0.0);
        if let Some(cells) = &found {
            let window = enclosing(cells, &self.patch.window);
            self.patch = self.patch.moved(widened(&window, shape));
        }
        found.is_some()
    }
}
