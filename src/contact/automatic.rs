//! The grid that is chosen where none is given; the method was developed here.
//!
//! A coarse grid is enlarged and reduced until it fits the contact. The displacement that its pressure causes
//! elsewhere shows whether the shape, which is looked at as a whole, overlaps there too; then the grid must hold
//! that place as well. Cells are divided until the estimated error of the peak pressure is at most 1 %.

mod relief;
mod search;
mod trial;

use std::ops::ControlFlow;

use crate::compliance::ends::{Ends, check_carried};
use crate::compliance::response::Body;
use crate::contact::automatic::relief::overlap;
use crate::contact::automatic::search::{Search, moved_out, touched_sides};
use crate::contact::automatic::trial::{Trial, frame_of};
use crate::contact::driver::WatchedSolve;
use crate::contact::options::{Algorithm, Motion, Options, Setup};
use crate::contact::plan::{Contact, bodies};
use crate::contact::problem::bounds::Hardness;
use crate::contact::solution::warnings::Warning;
use crate::contact::solution::{Progress, Report, Solution};
use crate::contact::solver::Termination;
use crate::error::{Error, Result};
use crate::model::grid::Grid;
use crate::model::surface::{Extent, Surface};

/// Distance from the end of a shape, relative to its length, that is rounding.
const ROUNDING: f64 = 1e-9;

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
    let solution = solve_with(shape, &body.into(), &setup, motion, &options)?;
    solution.require_converged(options.tolerance)
}

/// [`solve`] with a setup and options; a callback of [`Options::watched`] is told of each iteration on each grid. The
/// solution says whether it converged.
///
/// The grid is chosen as [`choose_grid`] says, with the default algorithm and no pressure to start from. Other
/// options then solve once more on this grid.
///
/// # Errors
/// Bad input; a shape without end in a direction; [`Error::NoGrid`].
pub fn solve_with<'a>(
    shape: &dyn Surface,
    body: &Body,
    setup: &Setup,
    motion: &Motion,
    options: impl Into<WatchedSolve<'a>>,
) -> Result<Solution> {
    check_carried(setup.counterbody.as_ref(), shape)?;
    let mut watched_options = options.into();
    let options = watched_options.options;
    if let (Some(compliance), None) = (&options.compliance, shape.grid()) {
        compliance.check_without_grid()?;
    }
    let ends = Ends::of(&bodies(body, setup));
    let limited = ends.limit(shape);
    let trial = Trial {
        shape: if ends.any() { &limited } else { shape },
        body,
        setup,
        motion,
        ends: ends.range(),
        most: options.largest_grid()?,
    };
    // A break ends all solves that follow.
    let mut stopped = false;
    let mut watched = |report: &Report| {
        stopped = stopped || watched_options.tell(report).is_break();
        if stopped { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let mut solution = match shape.grid() {
        Some(grid) => trial.solve(grid, options, &mut watched)?,
        None => solve_on_own_grid(trial, options, &mut watched)?,
    };
    if !shape.alternatives().is_empty() || solution.report.discretisation.is_none() {
        let plan = Contact::plan(body, *solution.grid(), setup.clone())?;
        plan.run(|| {
            plan.state_errors(&mut solution, shape, options, &mut watched);
            plan.compare(&mut solution, shape, motion, options, &mut watched);
        });
    }
    Ok(solution)
}

/// A solution on a grid that is chosen for the contact. What is given for the cells of one grid alone (pressures to start
/// from, hardness by cell, dents) plays no part in the choice, nor does the algorithm: with such options the contact is solved
/// once more, on the grid that was chosen.
fn solve_on_own_grid(trial: Trial, options: &Options, watched: &mut Progress) -> Result<Solution> {
    let plain = Options {
        algorithm: Algorithm::default(),
        initial: None,
        hardness: options
            .hardness
            .clone()
            .filter(|hardness| matches!(hardness, Hardness::Uniform(_))),
        indentation: None,
        ..options.clone()
    };
    let (mut solution, warning) = solve_on_fit_grid(trial, &plain, watched)?;
    if plain != *options {
        let grid = *solution.grid();
        solution = trial.solve(grid, options, watched)?;
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
/// Cells are halved along the axis along which the pressure bends most at its peak, until the estimated error
/// of the peak pressure ([`Report::discretisation`]) is at most 1 %. Where this needs more than [`Options::cells`], or
/// where dividing the cells does not lower the estimate, the solution has the warning [`Warning::PeakError`].
///
/// To choose the grid takes a solution on it, which [`solve`] and [`solve_with`] return.
///
/// # Errors
/// Bad input; a shape without end in a direction; [`Error::NoGrid`].
pub fn choose_grid<'a>(
    shape: &dyn Surface,
    body: &Body,
    setup: &Setup,
    motion: &Motion,
    options: impl Into<WatchedSolve<'a>>,
) -> Result<Grid> {
    match shape.grid() {
        Some(grid) => Ok(grid),
        None => Ok(*solve_with(shape, body, setup, motion, options)?.grid()),
    }
}

/// A solution on a grid that fits it, and a warning where no such grid was found.
fn solve_on_fit_grid(
    trial: Trial,
    options: &Options,
    progress: &mut Progress,
) -> Result<(Solution, Option<Warning>)> {
    let mut search = Search::new(trial, options)?;
    let (mut refinement, mut enlargements) = (Refinement::default(), 0);
    let mut grid = search.grid(progress)?;
    let mut solution = trial.solve(grid, options, progress)?;
    loop {
        if !solution.report.converged() {
            return Ok((solution, None));
        }
        let missed = overlap(&trial, &solution, frame_of(&grid))?;
        let touched = solution
            .cells_in_contact()
            .map(|contact| touched_sides(&contact, &grid, trial.shape.extent()))
            .unwrap_or_default();
        let too_coarse = peak_error(&solution).filter(|error| *error > PEAK_ERROR);
        let warning = match &missed {
            Some(missed) => Some(Warning::OutsideGrid { depth: missed.depth }),
            None => too_coarse.map(|error| Warning::PeakError { error }),
        };
        let grows = missed.is_some() || touched != [[false; 2]; 2];
        let next = match missed {
            _ if grows && enlargements < ENLARGEMENTS => {
                (refinement, enlargements) = (Refinement::default(), enlargements + 1);
                Some(match missed {
                    Some(missed) => search.holding(missed, &solution, progress)?,
                    None => enlarged(&trial, &grid, touched)?,
                })
            }
            Some(_) => None,
            None => refinement.next(&solution, &trial)?,
        };
        let Some(next) = next else {
            return Ok((solution, warning));
        };
        grid = next;
        solution = match trial.solve(grid, options, progress) {
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
fn enlarged(trial: &Trial, grid: &Grid, sides: [[bool; 2]; 2]) -> Result<Grid> {
    let (frame, size) = (frame_of(grid), grid.size());
    let wider = [0, 1].map(|k| moved_out(frame[k], sides[k], 0.5 * size[k]));
    let cells = [0, 1].map(|k| {
        let moved = sides[k].iter().filter(|side| **side).count();
        grid.shape()[k] + moved * grid.shape()[k].div_ceil(2)
    });
    trial.grid_over(wider, trial.at_most(cells))
}

/// Estimated error of the peak pressure, relative to the peak, above which cells are divided.
const PEAK_ERROR: f64 = 0.01;

/// Cells in contact on the line through the peak below which they are divided whatever the estimate says.
const NARROW: usize = 8;

/// Error after a division, relative to the smallest before, above which the division was of no use. Halving the
/// cells halves the error of a finite peak at least; the peak at a sharp edge has no error that falls.
const NO_USE: f64 = 0.75;

/// Divisions without use in a row after which the peak is given up: the estimate remembers the changes from
/// three grids.
const GIVEN_UP: usize = 3;

/// The divisions of one grid.
#[derive(Debug, Default)]
struct Refinement {
    /// Smallest relative error so far; `None` before the first division.
    least: Option<f64>,
    /// Divisions without use, in a row.
    in_vain: usize,
}

impl Refinement {
    /// The next grid after that of `solution`, which has converged; `None` where the peak pressure is accurate, where
    /// nobody can tell, and where no permitted grid makes it so.
    fn next(&mut self, solution: &Solution, trial: &Trial) -> Result<Option<Grid>> {
        let Some(short_of_end) = short_of_ends(solution, trial.shape) else {
            return Ok(None);
        };
        if short_of_end.contains(&true) {
            return halved(trial, solution.grid(), short_of_end);
        }
        let Some(error) = peak_error(solution) else {
            return Ok(None);
        };
        let (bends, narrow) = around_peak(solution);
        if error <= PEAK_ERROR && narrow == [false; 2] {
            return Ok(None);
        }
        let useless = self.least.is_some_and(|least| error > NO_USE * least);
        self.in_vain = if useless { self.in_vain + 1 } else { 0 };
        self.least = Some(self.least.map_or(error, |least| least.min(error)));
        if self.in_vain == GIVEN_UP {
            return Ok(None);
        }
        // Where halving along one axis was of no use, the other axis may need it.
        let both = self.in_vain > 0;
        let axes = [0, 1].map(|k| both || narrow[k] || (bends[k] && error > PEAK_ERROR));
        halved(trial, solution.grid(), axes)
    }
}

/// The grid whose cells are halved along `axes`; `None` where there would be too many.
fn halved(trial: &Trial, grid: &Grid, axes: [bool; 2]) -> Result<Option<Grid>> {
    let shape = [0, 1].map(|k| grid.shape()[k] * if axes[k] { 2 } else { 1 });
    if shape[0].saturating_mul(shape[1]) > trial.most {
        return Ok(None);
    }
    Ok(Some(Grid::new(shape, grid.size())?.centered_at(grid.center())?))
}

/// Axes along which the contact reaches the cell at an end of the shape, although the gap at the end itself is too large
/// to touch, as on a logarithmic profile: cells are too long. `None` where the contact reaches an edge, at which the
/// pressure is singular.
fn short_of_ends(solution: &Solution, shape: &dyn Surface) -> Option<[bool; 2]> {
    let warned = |kind: fn(&Warning) -> bool| solution.report.warnings.iter().any(kind);
    if warned(|warning| *warning == Warning::SharpEdge) {
        return None;
    }
    let mut short = [false; 2];
    if !warned(|warning| matches!(warning, Warning::SharpEnd { .. } | Warning::FreeEnd)) {
        return Some(short);
    }
    let (grid, contact, tilt) = (solution.grid(), solution.contact_extent(), solution.tilt);
    for axis in 0..2 {
        let Extent::CutOff([low, high]) = shape.extent()[axis] else {
            continue;
        };
        for side in [0, 1] {
            // The gap is infinite beyond the end, and by rounding perhaps at it.
            let end = [low, high][side] + [ROUNDING, -ROUNDING][side] * (high - low);
            if (contact[axis][side] - end).abs() > grid.spacing()[axis] {
                continue;
            }
            let beside = grid.coordinates(1 - axis).to_vec().into_iter();
            let touches = beside
                .map(|at| if axis == 0 { [end, at] } else { [at, end] })
                .any(|[x, y]| shape.gap(x, y) < solution.approach + tilt[0] * x + tilt[1] * y);
            if touches {
                return None;
            }
            short[axis] = true;
        }
    }
    Some(short)
}

/// The estimated error of the peak pressure, relative to the peak; `None` where there is no estimate.
fn peak_error(solution: &Solution) -> Option<f64> {
    let (peak, errors) = (solution.peak_pressure(), solution.report.discretisation?);
    errors.peak_pressure.filter(|_| peak > 0.0).map(|error| error / peak)
}

/// Along each axis: whether the pressure bends most along it at the peak, and whether few cells are in contact on the line
/// through the peak.
fn around_peak(solution: &Solution) -> ([bool; 2], [bool; 2]) {
    let (pressure, peak) = (&solution.pressure, solution.peak_pressure());
    let peak_cell = pressure.indexed_iter().find(|(_, p)| **p >= peak);
    let (row, column) = peak_cell.map_or((0, 0), |(at, _)| at);
    let lines = [(pressure.column(column), row), (pressure.row(row), column)];
    // The less the neighbours of the peak carry, the more the pressure bends.
    let beside = lines.map(|(line, at)| {
        let before = at.checked_sub(1).map_or(0.0, |k| line[k]);
        before + line.get(at + 1).copied().unwrap_or(0.0)
    });
    let narrow = lines.map(|(line, at)| {
        let free = |k: &usize| line.get(*k).is_some_and(|p| *p > 0.0);
        let above = (at..line.len()).take_while(free).count();
        let below = (0..at).rev().take_while(free).count();
        above + below < NARROW
    });
    (beside.map(|sum| sum <= beside[0].min(beside[1])), narrow)
}
