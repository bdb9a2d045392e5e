//! The grid that is chosen where none is given: a method of nacre's own.
//!
//! A coarse grid is enlarged and reduced until it fits the contact. The displacement that its pressure causes
//! elsewhere shows whether the shape, which is looked at as a whole, overlaps there too; then the grid must hold
//! that place as well. Cells are divided until the estimated error of the peak pressure is at most 1 %.

mod outside;
mod refinement;
mod relief;
mod search;
mod task;

use std::ops::ControlFlow;

use super::hardness::Hardness;
use super::options::Motion;
use super::options::{Algorithm, Options, Setup};
use super::plan::bodies;
use super::solution::Solution;
use super::solution::report::{Progress, Report};
use super::solution::warnings::Warning;
use super::solver::Termination;
use crate::compliance::ends::{Ends, check_carried};
use crate::compliance::response::Body;
use crate::error::{Error, Result};
use crate::model::grid::Grid;
use crate::model::surface::Surface;
use outside::overlap;
use refinement::{LARGEST_GRID, Next, Refinement, peak_error};
use search::{Search, moved_out, touched_sides};
use task::{Task, cells_in_contact, frame_of};

/// Enlargements of a grid on which the contact reached the edge, or the shape overlaps outside.
const ENLARGEMENTS: usize = 10;

/// Presses `shape` into `body` with every default: a grid that is chosen as [`choose_grid`] says, exact
/// coefficients, all threads.
///
/// # Errors
/// Bad input; a shape without end; [`Error::NoGrid`]; [`Error::NotConverged`].
///
/// ```
/// use nacre::{Elastic, Motion, Sphere, solve};
/// let steel = Elastic::new(210e9, 0.3)?;
/// let solution = solve(&Sphere::new(5e-3)?, &steel, &Motion::load(10.0))?;
/// let hertz = nacre::hertz::Point::new(5e-3, steel.plane_strain_modulus(), 10.0)?;
/// assert!((solution.peak_pressure() / hertz.peak_pressure - 1.0).abs() < 2e-3);
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn solve(shape: &dyn Surface, body: impl Into<Body>, motion: &Motion) -> Result<Solution> {
    let (setup, options) = (Setup::default(), Options::default());
    let mut go_on = |_: &_| ControlFlow::Continue(());
    let solution = solve_watched(shape, &body.into(), &setup, motion, &options, &mut go_on)?;
    solution.require_converged(options.tolerance)
}

/// [`solve`] with a setup and options, that calls `progress` with each iteration on each grid; its break ends
/// the solve with [`Termination::Stopped`]. The solution says whether it converged.
///
/// The grid is chosen as [`choose_grid`] says, with the default algorithm and no pressure to start from. Other
/// options then solve once more on this grid.
///
/// # Errors
/// Bad input; a shape without end in a direction; [`Error::NoGrid`].
pub fn solve_watched(
    shape: &dyn Surface,
    body: &Body,
    setup: &Setup,
    motion: &Motion,
    options: &Options,
    progress: &mut Progress,
) -> Result<Solution> {
    check_carried(setup.counterbody.as_ref(), shape)?;
    let ends = Ends::of(&bodies(body, setup));
    let limited = ends.limit(shape);
    let task = Task {
        shape: if ends.any() { &limited } else { shape },
        body,
        setup,
        motion,
        ends: ends.range(),
    };
    if let Some(grid) = shape.grid() {
        return task.solve(grid, options, progress);
    }
    // A break ends all solves that follow.
    let mut stopped = false;
    let mut watched = |report: &Report| {
        stopped = stopped || progress(report).is_break();
        if stopped { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let plain = Options {
        algorithm: Algorithm::default(),
        initial: None,
        hardness: options.hardness.as_ref().and_then(Hardness::uniform).cloned(),
        indentation: None,
        ..options.clone()
    };
    let (mut solution, warning) = solve_on_fit_grid(task, &plain, &mut watched)?;
    if plain != *options {
        let grid = *solution.grid();
        solution = task.solve(grid, options, &mut watched)?;
    }
    solution.report.warnings.extend(warning);
    Ok(solution)
}

/// The grid of [`solve`]: the grid of a measured surface; for any other shape a grid that holds the whole
/// contact, with 64 cells across its narrower width and more where the peak pressure needs them.
///
/// The contact is solved on a coarse grid, which is enlarged while the contact touches its edge, ten times at
/// most. The search begins in the middle of the shape or where the load acts; under a prescribed motion with
/// which nothing overlaps there, at all places that overlap. Around the contact is a margin of a quarter of its
/// width on every side; cells are oblong where the contact is long.
///
/// The shape is then looked at outside the grid, along lines through its [marks](Surface::marks) and along others.
/// Where it overlaps the displaced surface, the search goes on with a grid that holds this place too. If that
/// does not end, the solution has the warning [`Warning::OutsideGrid`].
///
/// Cells are divided along the axes along which the pressure bends most at its peak, until the estimated error
/// of the peak pressure ([`Report::discretisation`]) is at most 1 %. Where this needs more than 2²² cells, or
/// where dividing the cells does not lower the estimate, the solution has the warning [`Warning::PeakError`].
///
/// To choose the grid takes a solution on it, which [`solve`] and [`solve_watched`] return.
///
/// # Errors
/// Bad input; a shape without end in a direction; [`Error::NoGrid`].
pub fn choose_grid(
    shape: &dyn Surface,
    body: &Body,
    setup: &Setup,
    motion: &Motion,
    options: &Options,
    progress: &mut Progress,
) -> Result<Grid> {
    match shape.grid() {
        Some(grid) => Ok(grid),
        None => {
            let solution = solve_watched(shape, body, setup, motion, options, progress)?;
            Ok(*solution.grid())
        }
    }
}

/// A solution on a grid that fits it, and a warning where no such grid was found.
fn solve_on_fit_grid(
    task: Task,
    options: &Options,
    progress: &mut Progress,
) -> Result<(Solution, Option<Warning>)> {
    let mut search = Search::new(task, options)?;
    let (mut refinement, mut enlargements) = (Refinement::default(), 0);
    let mut grid = search.grid(progress)?;
    let mut solution = task.solve(grid, options, progress)?;
    loop {
        if !solution.report.converged() {
            return Ok((solution, None));
        }
        let frame = frame_of(&grid);
        let missed = overlap(&task, &solution, frame)?;
        let touched = cells_in_contact(&solution)
            .map(|contact| touched_sides(&contact, &grid, task.shape.extent()))
            .unwrap_or_default();
        let warning;
        if let Some(missed) = missed {
            warning = Some(Warning::OutsideGrid { depth: missed.depth });
            if enlargements == ENLARGEMENTS {
                return Ok((solution, warning));
            }
            grid = search.holding(missed, &solution, progress)?;
            (refinement, enlargements) = (Refinement::default(), enlargements + 1);
        } else if touched != [[false; 2]; 2] && enlargements < ENLARGEMENTS {
            warning = None;
            grid = enlarged(&task, &grid, touched)?;
            (refinement, enlargements) = (Refinement::default(), enlargements + 1);
        } else {
            match refinement.next(&solution, task.shape)? {
                Next::Enough => return Ok((solution, None)),
                Next::TooFine(warning) => return Ok((solution, Some(warning))),
                Next::Finer(finer) => grid = finer,
            }
            warning = peak_error(&solution).map(|error| Warning::PeakError { error });
        }
        solution = match task.solve(grid, options, progress) {
            // The grid before was not too large.
            Err(Error::Memory { .. }) => return Ok((solution, warning)),
            Ok(finer) if finer.report.termination == Termination::IterationLimit => {
                return Ok((solution, warning));
            }
            solved => solved?,
        };
    }
}

/// The grid whose `sides` are moved out by half its width, with cells of the same size, or larger ones where
/// there would be too many.
fn enlarged(task: &Task, grid: &Grid, sides: [[bool; 2]; 2]) -> Result<Grid> {
    let (frame, size) = (frame_of(grid), grid.size());
    let wider = [0, 1].map(|k| moved_out(frame[k], sides[k], 0.5 * size[k]));
    let cells = [0, 1].map(|k| {
        let moved = sides[k].iter().filter(|side| **side).count();
        grid.shape()[k] + moved * grid.shape()[k].div_ceil(2)
    });
    let most = cells[0].saturating_mul(cells[1]);
    let larger = (most as f64 / LARGEST_GRID as f64).sqrt().max(1.0);
    task.grid_over(wider, cells.map(|n| (n as f64 / larger) as usize))
}
