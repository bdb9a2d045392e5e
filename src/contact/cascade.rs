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

use crate::compliance::convolution::{Addition, Convolution};
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
use crate::numerics::parallel::{Rows, all, update, update_with_largest};

/// Tolerance on coarser grids, whose results tell the discretisation error. With 1e-4, estimates of peak pressures on hard
/// coats that slip are four times too large; with 1e-3 and 1e-2, convolutions are 5 to 7 % fewer.
const COARSE_TOLERANCE: f64 = 1e-5;

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
        for level in levels.iter().rev() {
            let tolerance = criteria.tolerance.max(COARSE_TOLERANCE);
            let criteria = StopCriteria { tolerance, ..criteria };
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
        let found = bounds(&full_window(shape), |i, j| outside(i, j) && g[i * shape[1] + j] < 0.0);
        if let Some(cells) = &found {
            let window = enclosing(cells, &self.patch.window);
            self.patch = self.patch.moved(widened(&window, shape));
        }
        found.is_some()
    }
}

/// Cells of the coarsest grid along each direction, at least. A direction with fewer than twice as many is
/// not halved; chosen by trial.
const COARSEST_CELLS: usize = 32;

/// Directions of a grid that are halved for the next coarser one; none at the coarsest. A period of an odd number of
/// cells is not halved.
fn halved(grid: &Grid) -> [bool; 2] {
    let (shape, periodic) = (grid.shape(), grid.is_periodic());
    [0, 1].map(|k| shape[k] >= 2 * COARSEST_CELLS && !(periodic[k] && shape[k] % 2 == 1))
}

/// The grid whose cells are twice as long in the directions of `halved`; it starts where `fine` does.
fn coarse_grid(fine: &Grid, halved: [bool; 2]) -> Result<Grid> {
    let (shape, spacing, center) = (fine.shape(), fine.spacing(), fine.center());
    let cells = [0, 1].map(|k| if halved[k] { shape[k].div_ceil(2) } else { shape[k] });
    let longer = halved.map(|halved| if halved { 2.0 } else { 1.0 });
    let sides = [0, 1].map(|k| longer[k] * spacing[k] * cells[k] as f64);
    let grown = [0, 1].map(|k| 0.5 * (sides[k] - fine.size()[k]));
    let grid = if fine.is_line() {
        Grid::line(cells[1], sides[1])?
    } else {
        Grid::new(cells, sides)?.periodic(fine.is_periodic())?
    };
    grid.centered_at([0, 1].map(|k| center[k] + grown[k]))
}

/// A grid and all coarser ones, each with its own influence coefficients.
#[derive(Debug)]
pub(crate) struct Levels {
    /// Coefficients of levels 0 (the finest), 1, 2, …
    coefficients: Arc<Vec<Array2<f64>>>,
    /// Convolutions of levels 1, 2, …; level 0 uses the contact's own.
    convolutions: Vec<Convolution>,
    /// Local displacements of levels 1, 2, …; level 0 uses the contact's own.
    locals: Vec<LocalDisplacement>,
    /// Grids of levels 0, 1, 2, …
    grids: Vec<Grid>,
}

impl Levels {
    /// Plans the grids that are coarser than `finest`; `of` computes the coefficients of a grid, what free ends add
    /// to them, and its local displacements.
    pub(crate) fn plan(
        finest: Grid,
        coefficients: Array2<f64>,
        convolution: &Convolution,
        of: impl Fn(&Grid) -> Result<(Array2<f64>, Vec<Addition>, LocalDisplacement)>,
    ) -> Result<Self> {
        let (mut coefficients, mut grids) = (vec![coefficients], vec![finest]);
        let (mut convolutions, mut locals) = (Vec::new(), Vec::new());
        let mut fine = finest;
        while halved(&fine) != [false; 2] {
            fine = coarse_grid(&fine, halved(&fine))?;
            let (coarse, additions, local) = of(&fine)?;
            locals.push(local);
            let companion = convolution.companion(&coarse, fine.is_periodic());
            convolutions.push(companion.plus(additions));
            coefficients.push(coarse);
            grids.push(fine);
        }
        Ok(Self { coefficients: Arc::new(coefficients), convolutions, locals, grids })
    }

    /// These levels on the threads of `finest`; all large arrays are shared.
    pub(crate) fn beside(&self, finest: &Convolution) -> Self {
        let convolutions = self.convolutions.iter();
        Self {
            coefficients: Arc::clone(&self.coefficients),
            convolutions: convolutions.map(|c| c.sharing_with(finest)).collect(),
            locals: self.locals.clone(),
            grids: self.grids.clone(),
        }
    }

    /// The finest level, for `problem` with this `gap`.
    pub(crate) fn finest<'a>(&'a self, problem: &Problem<'a>, gap: &'a Array2<f64>) -> Level<'a> {
        Level {
            coefficients: &self.coefficients[0],
            convolution: problem.convolution,
            local: problem.local,
            grid: &self.grids[0],
            freedoms: problem.freedoms.clone(),
            gap: Cow::Borrowed(gap),
            bounds: problem.bounds.clone(),
        }
    }

    /// Levels 1, 2, … for the degrees of freedom and the gap of level 0. `None` where `shape` has no gap
    /// for coarser cells and the `gap` of level 0, from which it would be averaged, is not given.
    pub(crate) fn coarser(
        &self,
        freedoms: &Freedoms,
        gap: Option<&Array2<f64>>,
        shape: &dyn Surface,
    ) -> Option<Vec<Level<'_>>> {
        let mut levels: Vec<Level> = Vec::new();
        let coarser = self.coefficients.iter().zip(&self.grids).skip(1);
        let finer = self.grids.iter();
        let locals = self.locals.iter();
        for ((((coefficients, grid), convolution), local), finer) in
            coarser.zip(&self.convolutions).zip(locals).zip(finer)
        {
            let halved = halved(finer);
            let fine = levels.last();
            let freedoms = fine.map_or(freedoms, |fine| &fine.freedoms).coarse(halved);
            let rows = Rows::new(&freedoms.columns, convolution.own_threads());
            // A measured surface has no gap for cells that are much larger than its own.
            let gap = match checked_gaps(shape, grid, &rows) {
                Ok(mut gap) => {
                    if freedoms.any_prescribed() {
                        freedoms.prescribe(&mut gap);
                    }
                    gap
                }
                Err(_) => coarse_gap(fine.map_or(gap, |fine| Some(&fine.gap))?, halved),
            };
            levels.push(Level {
                coefficients,
                convolution,
                local,
                grid,
                freedoms,
                gap: Cow::Owned(gap),
                bounds: Bounds::none(grid.shape()[1]),
            });
        }
        Some(levels)
    }
}

/// Mean gap over each coarse cell, from its fine cells that can touch.
fn coarse_gap(fine: &Array2<f64>, halved: [bool; 2]) -> Array2<f64> {
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

/// One grid with its coefficients and its problem.
pub(crate) struct Level<'a> {
    coefficients: &'a Array2<f64>,
    convolution: &'a Convolution,
    local: &'a LocalDisplacement,
    grid: &'a Grid,
    pub(crate) freedoms: Freedoms,
    pub(crate) gap: Cow<'a, Array2<f64>>,
    bounds: Bounds<'a>,
}

impl Level<'_> {
    /// Numbers of cells.
    pub(crate) fn shape(&self) -> [usize; 2] {
        [self.gap.nrows(), self.gap.ncols()]
    }

    /// Directions that are halved for the next coarser grid.
    pub(crate) fn halved(&self) -> [bool; 2] {
        halved(self.grid)
    }

    /// Peak pressure, approach and load of a solution on this grid.
    pub(crate) fn result(&self, patch: &Patch, lambda: [f64; 3]) -> GridResult {
        let ([peak], [sum]) = update_with_largest([&patch.values], [], |[p], []| ([], [p], [p]));
        GridResult {
            peak_pressure: peak,
            approach: self.freedoms.rigid_motion(lambda).0,
            load: sum * self.freedoms.cell_area,
        }
    }

    /// Takes the pressure from cells that cannot touch, and balances it. False where that is impossible.
    pub(crate) fn balance(&self, patch: &mut Patch) -> bool {
        let pressures = patch.values.chunks_exact_mut(patch.window[1].len().max(1));
        for (p, gaps) in pressures.zip(patch::rows(&self.gap, &patch.window)) {
            update([gaps], [p], |[h], [p]| ([h.simd_lt(all(f64::INFINITY)) & p], []));
        }
        self.freedoms
            .in_window(patch.window.clone())
            .balance(&mut patch.values, &self.bounds.in_window(&patch.window))
    }

    /// Solves in the window of `patch`, and in larger windows while the contact reaches the edge; `patch`
    /// becomes the solution. Where the preconditioned iteration ends early, the active set goes on.
    pub(crate) fn solve(
        &self,
        patch: &mut Patch,
        criteria: StopCriteria,
        tally: &mut Tally,
    ) -> Outcome {
        let shape = self.shape();
        loop {
            let window = &patch.window;
            let whole = *window == full_window(shape);
            let corner = block(self.coefficients, &[0..window[0].len(), 0..window[1].len()]);
            let repeats = repeating(self.grid, window);
            let freedoms = self.freedoms.in_window(window.clone());
            let bounds = self.bounds.in_window(window);
            let first = window[0].start;
            let windowed = (!whole).then(|| self.convolution.on_window(&corner, first));
            let approximation = self.convolution.approximation(&corner, repeats);
            let gap = copied(&self.gap, window);
            let problem = Problem {
                convolution: windowed.as_ref().unwrap_or(self.convolution),
                freedoms: &freedoms,
                gap: &gap,
                local: self.local,
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
