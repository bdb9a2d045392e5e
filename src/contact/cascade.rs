//! The contact window on nested grids, around preconditioned conjugate gradients; developed here.
//!
//! The problem is solved on a grid of a few cells first; each solution, interpolated, is where the
//! next finer grid starts. On each grid only a window around the contact is solved. The outside is checked
//! afterwards, when the displacement is computed on the whole grid: where something overlaps there, the
//! window opens.

pub(super) mod discretisation;

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use ndarray::Array2;

use crate::compliance::convolution::Convolution;
use crate::compliance::response::Body;
use crate::contact::cascade::discretisation::GridResult;
use crate::contact::problem::bounds::Bounds;
use crate::contact::problem::freedoms::Freedoms;
use crate::contact::problem::patch::{self, Patch, block, bounds, copied, enclosing, widened};
use crate::contact::problem::{LocalDisplacement, Problem, SolutionFields};
use crate::contact::solver::preconditioned::Preconditioned;
use crate::contact::solver::{
    Outcome, StopCriteria, Tally, Termination, active_set, polonsky_keer,
};
use crate::contact::start::{checked_gaps, uniform_pressure};
use crate::error::Result;
use crate::model::grid::{Grid, full_window, repeating};
use crate::model::surface::Surface;
use crate::numerics::layout::{slice, slice_mut};
use crate::numerics::parallel::{Rows, all, update};

/// Tolerance on coarser grids, whose results tell the discretisation error. With 1e-4, estimates of peak pressures on hard
/// coats that slip are four times too large; with 1e-3 and 1e-2, convolutions are 5 to 7 % fewer.
pub(super) const COARSE_TOLERANCE: f64 = 1e-5;

/// Residual and overlap from which on the reference algorithm goes on where the preconditioned iteration ended. A worse
/// pressure cost it two to five times the iterations that it takes from a uniform one, on coats 1e3 to 1e5 times harder
/// than the body.
const GOOD_START: f64 = 1e-5;

/// Certificates that may fail on a window that need not open, by rounding of the displacement.
const RETRIES: usize = 2;

/// The finest grid, and a window around its contact.
pub(super) struct Cascade<'a> {
    finest: LevelProblem<'a>,
    patch: Patch,
    /// Results of the coarser grids, from the coarsest on.
    pub(super) results: Vec<GridResult>,
    /// The outcome where the caller stopped the solve on a coarser grid.
    stopped: Option<Outcome>,
}

impl<'a> Cascade<'a> {
    /// Solves on the coarser of `levels`, and starts the finest grid from there; `None` where no balanced pressure was
    /// found.
    pub(super) fn nested(
        problem: &Problem<'a>,
        gap: &'a Array2<f64>,
        shape: &dyn Surface,
        levels: &'a [Level],
        criteria: StopCriteria,
        tally: &mut Tally,
    ) -> Option<Self> {
        let mut problems = vec![LevelProblem::finest(&levels[0], problem, gap)];
        for level in &levels[1..] {
            problems.push(problems[problems.len() - 1].coarse(level, shape));
        }
        let tolerance = criteria.tolerance.max(COARSE_TOLERANCE);
        let criteria = StopCriteria { tolerance, ..criteria };
        let (mut pressure, mut results, mut stopped) = (None, Vec::new(), None);
        for level in problems[1..].iter().rev() {
            let Some(mut patch) = level.start(pressure.take(), &mut results) else {
                continue;
            };
            if stopped.is_none() {
                tally.iterations = 0;
                let outcome = level.solve(&mut patch, criteria, tally);
                stopped = (outcome.termination == Termination::Stopped).then_some(outcome);
                results.push(level.result(&patch, outcome.lambda));
            }
            pressure = Some(patch);
        }
        if stopped.is_none() {
            tally.iterations = 0;
        }
        let finest = problems.swap_remove(0);
        let patch = finest.start(pressure, &mut results)?;
        Some(Self { finest, patch, results, stopped })
    }

    /// Starts the finest grid from an `initial` pressure.
    pub(super) fn from(
        initial: &Array2<f64>,
        problem: &Problem<'a>,
        gap: &'a Array2<f64>,
        finest: &'a Level,
    ) -> Self {
        let finest = LevelProblem::finest(finest, problem, gap);
        let mut patch = Patch::of_grid(initial);
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
        fields: &mut SolutionFields,
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
    fn open(&mut self, problem: &Problem, fields: &SolutionFields) -> bool {
        let shape = self.finest.shape();
        let [x, y] = self.patch.window.clone();
        let outside = |i: usize, j: usize| !(x.contains(&i) && y.contains(&j));
        let g = fields.gap(problem);
        let overlap =
            bounds(&full_window(shape), |i, j| outside(i, j) && g[i * shape[1] + j] < 0.0);
        if let Some(cells) = &overlap {
            let window = enclosing(cells, &self.patch.window);
            self.patch = self.patch.moved(widened(&window, shape));
        }
        overlap.is_some()
    }
}

/// Cells of the coarsest grid along each direction, at least. A direction with fewer than twice as many is
/// not halved. Chosen by trial: 16 saves nothing, and 64 takes 19 % more convolutions on automatic grids.
const COARSEST_CELLS: usize = 32;

/// Directions of a grid that are halved for the next coarser one; none at the coarsest. A period of an odd number of
/// cells is not halved.
pub(super) fn halved(grid: &Grid) -> [bool; 2] {
    let (shape, periodic) = (grid.shape(), grid.is_periodic());
    [0, 1].map(|k| shape[k] >= 2 * COARSEST_CELLS && !(periodic[k] && shape[k] % 2 == 1))
}

/// The next coarser grid, whose cells are twice as long in the directions that are halved; it starts where `fine` does.
/// `None` where there is none.
pub(super) fn next_coarser_grid(fine: &Grid) -> Result<Option<Grid>> {
    let halved = halved(fine);
    if halved == [false; 2] {
        return Ok(None);
    }
    fine.coarser(halved).map(Some)
}

/// A grid with its own influence coefficients.
#[derive(Debug)]
pub(crate) struct Level {
    grid: Grid,
    coefficients: Arc<Array2<f64>>,
    pub(super) convolution: Convolution,
    pub(super) local: LocalDisplacement,
}

impl Level {
    /// A grid with the `coefficients` of `bodies`, and their convolution.
    pub(super) fn new(
        grid: Grid,
        coefficients: &Arc<Array2<f64>>,
        convolution: Convolution,
        bodies: &[&Body],
    ) -> Self {
        let local = LocalDisplacement::new(bodies, &grid);
        Self { grid, coefficients: Arc::clone(coefficients), convolution, local }
    }

    /// The grid.
    pub(super) fn grid(&self) -> &Grid {
        &self.grid
    }

    /// This level on springs of these compliances (nx, ny) \[m/Pa\], with the threads and memory of `finest`.
    pub(super) fn on_springs(&self, springs: &Array2<f64>, finest: &Convolution) -> Self {
        let convolution = self.convolution.sharing_with(finest);
        let level = self.with(convolution.on_springs(&slice(springs)));
        let local = level.local.with_springs(level.convolution.mean_spring());
        Self { local, ..level }
    }

    /// This level with another convolution; the coefficients are shared.
    pub(super) fn with(&self, convolution: Convolution) -> Self {
        let (coefficients, local) = (Arc::clone(&self.coefficients), self.local.clone());
        Self { grid: self.grid, coefficients, convolution, local }
    }
}

/// Mean over each coarse cell of the values of its fine cells, of those that are finite.
pub(super) fn coarse_means(fine: &Array2<f64>, halved: [bool; 2]) -> Array2<f64> {
    let (nx, ny) = fine.dim();
    let span = |i: usize, n: usize, halved: bool| -> Range<usize> {
        if halved { 2 * i..(2 * i + 2).min(n) } else { i..i + 1 }
    };
    let half = |n: usize, halved: bool| if halved { n.div_ceil(2) } else { n };
    Array2::from_shape_fn((half(nx, halved[0]), half(ny, halved[1])), |(i, j)| {
        let (mut sum, mut count) = (0.0, 0);
        for h in block(fine, &[span(i, nx, halved[0]), span(j, ny, halved[1])]) {
            if h.is_finite() {
                sum += h;
                count += 1;
            }
        }
        if count > 0 { sum / f64::from(count) } else { f64::INFINITY }
    })
}

/// The problem on one grid.
struct LevelProblem<'a> {
    level: &'a Level,
    freedoms: Freedoms,
    gap: Cow<'a, Array2<f64>>,
    bounds: Bounds<'a>,
}

impl<'a> LevelProblem<'a> {
    /// The `problem` with this `gap` on the finest grid.
    fn finest(level: &'a Level, problem: &Problem<'a>, gap: &'a Array2<f64>) -> Self {
        let (freedoms, bounds) = (problem.freedoms.clone(), problem.bounds.clone());
        Self { level, freedoms, gap: Cow::Borrowed(gap), bounds }
    }

    /// This elastic problem on the next coarser grid.
    fn coarse<'b>(&self, level: &'b Level, shape: &dyn Surface) -> LevelProblem<'b> {
        let freedoms = self.freedoms.coarse(self.halved());
        let rows = Rows::new(&freedoms.columns, level.convolution.own_threads());
        // A measured surface has no gap for cells that are much larger than its own.
        let gap = match checked_gaps(shape, &level.grid, &rows) {
            Ok(mut gap) => {
                freedoms.prescribe(&mut gap);
                gap
            }
            Err(_) => coarse_means(&self.gap, self.halved()),
        };
        let bounds = Bounds::none(level.grid.shape()[1]);
        LevelProblem { level, freedoms, gap: Cow::Owned(gap), bounds }
    }

    /// Numbers of cells.
    fn shape(&self) -> [usize; 2] {
        self.level.grid.shape()
    }

    /// Directions that are halved for the next coarser grid.
    fn halved(&self) -> [bool; 2] {
        halved(&self.level.grid)
    }

    /// The balanced pressure to start from: the `coarse` one, interpolated, or else a uniform one. `None` where these
    /// cells cannot carry the moments that finer ones can. Clears `results` with which those of this grid cannot be compared.
    fn start(&self, coarse: Option<Patch>, results: &mut Vec<GridResult>) -> Option<Patch> {
        let (shape, halved) = (self.shape(), self.halved());
        if (halved.iter().zip(shape)).any(|(halved, n)| !halved && n > 1) {
            // Results are comparable only between grids of which all directions were halved.
            results.clear();
        }
        let mut patch = match coarse {
            Some(coarse) => coarse.interpolated(shape, halved),
            None => {
                let uniform = self.freedoms.typical_pressure(self.gap.len());
                Patch::of_grid(&Array2::from_elem(shape, uniform))
            }
        };
        let balanced = self.balance(&mut patch);
        if !balanced {
            results.clear();
        }
        balanced.then_some(patch)
    }

    /// Numbers of a solution on this grid.
    fn result(&self, patch: &Patch, lambda: [f64; 3]) -> GridResult {
        let mut pressure = Array2::zeros(self.shape());
        patch.paste(slice_mut(&mut pressure), self.shape()[1]);
        let (approach, tilt) = self.freedoms.rigid_motion(lambda);
        GridResult { approach, tilt, ..GridResult::of_pressure(&pressure, &self.level.grid) }
    }

    /// Takes the pressure from cells that cannot touch, and balances it. False where that is impossible.
    fn balance(&self, patch: &mut Patch) -> bool {
        let pressures = patch.values.chunks_exact_mut(patch.window[1].len().max(1));
        let gap = slice(&self.gap);
        for (p, gaps) in pressures.zip(patch::rows(&gap, self.shape()[1], &patch.window)) {
            update([gaps], [p], |[h], [p]| ([h.simd_lt(all(f64::INFINITY)) & p], []));
        }
        self.freedoms
            .in_window(patch.window.clone())
            .balance(&mut patch.values, &self.bounds.in_window(&patch.window))
    }

    /// Solves in the window of `patch`, and in larger windows while the contact reaches the edge; `patch`
    /// becomes the solution. Where the preconditioned iteration ends early, the active set goes on.
    fn solve(&self, patch: &mut Patch, criteria: StopCriteria, tally: &mut Tally) -> Outcome {
        let shape = self.shape();
        loop {
            let window = &patch.window;
            let whole = *window == full_window(shape);
            let corner = block(&self.level.coefficients, &[0..window[0].len(), 0..window[1].len()]);
            let repeats = repeating(&self.level.grid, window);
            let freedoms = self.freedoms.in_window(window.clone());
            let bounds = self.bounds.in_window(window);
            let windowed = (!whole).then(|| self.level.convolution.on_window(&corner, window));
            let operator = windowed.as_ref().unwrap_or(&self.level.convolution);
            let approximation = operator.approximation(&corner, repeats);
            let gap = copied(&self.gap, window);
            let problem = Problem {
                convolution: operator,
                freedoms: &freedoms,
                gap: &gap,
                local: &self.level.local,
                bounds: &bounds,
            };
            let mut solver = Preconditioned::new(&problem, &approximation);
            let mut outcome = solver.solve(&mut patch.values, criteria, tally);
            // The next solver reuses its workspace.
            drop(solver);
            let limited = outcome.termination == Termination::IterationLimit;
            if limited
                && tally.iterations < criteria.max_iterations
                && active_set::is_small(&problem, &patch.values)
            {
                outcome = active_set::solve(
                    &problem,
                    &corner,
                    &mut patch.values,
                    outcome.lambda,
                    criteria,
                    tally,
                );
            }
            let Some(contact) = patch.contact() else {
                return outcome;
            };
            let reached = (0..2).any(|k| {
                (contact[k].start == patch.window[k].start && contact[k].start > 0)
                    || (contact[k].end == patch.window[k].end && contact[k].end < shape[k])
            });
            if whole || !reached || outcome.termination != Termination::Converged {
                return outcome;
            }
            *patch = patch.moved(widened(&enclosing(&contact, &patch.window), shape));
        }
    }
}
