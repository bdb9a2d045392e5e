//! The grid that is chosen where none is given; the method was developed here.
//!
//! A coarse grid is enlarged and reduced until it fits the contact. The displacement that its pressure causes
//! elsewhere shows whether the shape, which is looked at as a whole, overlaps there too; then the grid must hold
//! that place as well. Cells are divided until the estimated error of the peak pressure is at most 1 %.

mod relief;
mod search;
mod task;

use std::ops::ControlFlow;

use crate::compliance::ends::{Ends, check_carried};
use crate::compliance::response::Body;
use crate::contact::automatic::relief::overlap;
use crate::contact::automatic::search::{Search, moved_out, touched_sides};
use crate::contact::automatic::task::{Task, frame_of};
use crate::contact::driver::WatchedSolve;
use crate::contact::options::{Algorithm, Motion, Options, Setup};
use crate::contact::plan::{Contact, bodies};
use crate::contact::problem::bounds::Hardness;
use crate::contact::solution::warnings::Warning;
use crate::contact::solution::{Progress, Report, Solution};
use crate::contact::solver::Termination;
use crate::error::{Error, Result};
use crate::model::grid::Grid;
use crate::model::surface::Surface;

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
    let mut asked = options.into();
    let options = asked.options;
    let ends = Ends::of(&bodies(body, setup));
    let limited = ends.limit(shape);
    let task = Task {
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
        stopped = stopped || asked.tell(report).is_break();
        if stopped { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let mut solution = match shape.grid() {
        Some(grid) => task.solve(grid, options, &mut watched)?,
        None => solve_on_own_grid(task, options, &mut watched)?,
    };
    if !shape.alternatives().is_empty() {
        let plan = Contact::plan(body, *solution.grid(), setup.clone())?;
        plan.run(|| plan.compare(&mut solution, shape, motion, options, &mut watched));
    }
    Ok(solution)
}

/// A solution on a grid that is chosen, with these options.
fn solve_on_own_grid(task: Task, options: &Options, watched: &mut Progress) -> Result<Solution> {
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
    let (mut solution, warning) = solve_on_fit_grid(task, &plain, watched)?;
    if plain != *options {
        let grid = *solution.grid();
        solution = task.solve(grid, options, watched)?;
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
        let touched = solution
            .cells_in_contact()
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
            match refinement.next(&solution, &task)? {
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
    task.grid_over(wider, task.at_most(cells))
}

/// Estimated error of the peak pressure, relative to the peak, above which cells are divided.
const PEAK_ERROR: f64 = 0.01;

/// Cells in contact on the line through the peak below which they are divided whatever the estimate says.
const NARROW: usize = 8;

/// Cells on either side of the peak whose pressure says along which axis it bends; chosen by trial.
const AROUND_PEAK: usize = 3;

/// Second difference of the pressure along one axis, relative to the other, above which cells are divided along
/// this axis too; chosen by trial.
const BENDS_TOO: f64 = 0.25;

/// Error after a division, relative to the smallest before, above which the division was of no use. Halving the
/// cells halves the error of a finite peak at least; the peak at a sharp edge has no error that falls.
const NO_USE: f64 = 0.75;

/// Divisions without use in a row after which the peak is given up: the estimate remembers the changes from
/// three grids.
const GIVEN_UP: usize = 3;

/// What follows a solution on a grid that holds the contact.
enum Next {
    /// Nothing: the peak pressure is accurate, or nobody can tell.
    Enough,
    /// A solution on finer cells.
    Finer(Grid),
    /// A warning that the peak pressure is not accurate.
    TooFine(Warning),
}

/// The divisions of one grid.
#[derive(Debug, Default)]
struct Refinement {
    /// Smallest relative error so far; `None` before the first division.
    least: Option<f64>,
    /// Divisions without use, in a row.
    in_vain: usize,
}

impl Refinement {
    /// The next step after `solution`, which has converged.
    fn next(&mut self, solution: &Solution, task: &Task) -> Result<Next> {
        let edges = edges(solution, task.shape);
        if edges.contains(&Edge::Reached) {
            return Ok(Next::Enough);
        }
        let short_of_edge = edges.map(|edge| edge == Edge::OutOfReach);
        if short_of_edge.contains(&true) {
            let finer = divided(task, solution.grid(), short_of_edge, &[4, 2])?;
            return Ok(finer.map_or(Next::Enough, Next::Finer));
        }
        let Some(error) = peak_error(solution) else {
            return Ok(Next::Enough);
        };
        let (bends, narrow) = around_peak(solution);
        if error <= PEAK_ERROR && narrow == [false; 2] {
            return Ok(Next::Enough);
        }
        let useless = self.least.is_some_and(|least| error > NO_USE * least);
        self.in_vain = if useless { self.in_vain + 1 } else { 0 };
        self.least = Some(self.least.map_or(error, |least| least.min(error)));
        if self.in_vain == GIVEN_UP {
            return Ok(Next::TooFine(Warning::PeakError { error }));
        }
        // Where division along one axis was of no use twice, the other axis may need it.
        let both = self.in_vain + 1 == GIVEN_UP;
        let axes = [0, 1].map(|k| both || narrow[k] || (bends[k] && error > PEAK_ERROR));
        let far = error > 4.0 * PEAK_ERROR && axes != [true; 2];
        let parts: &[usize] = if far { &[4, 2] } else { &[2] };
        let finer = divided(task, solution.grid(), axes, parts)?;
        Ok(finer.map_or(Next::TooFine(Warning::PeakError { error }), Next::Finer))
    }
}

/// The grid whose cells are divided along `axes`, into the first of these numbers of `parts` with which there are
/// not too many; `None` where there always are.
fn divided(task: &Task, grid: &Grid, axes: [bool; 2], parts: &[usize]) -> Result<Option<Grid>> {
    for parts in parts {
        let shape = [0, 1].map(|k| grid.shape()[k] * if axes[k] { *parts } else { 1 });
        if shape[0].saturating_mul(shape[1]) <= task.most {
            let finer = Grid::new(shape, grid.size())?.centered_at(grid.center())?;
            return Ok(Some(finer));
        }
    }
    Ok(None)
}

/// How a contact meets the edges of a shape along one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Edge {
    /// The contact stays away from them.
    Away,
    /// The contact reaches the cell at an edge, but the gap at the edge itself is too large to touch, as at the
    /// end of a logarithmic profile: cells are too long.
    OutOfReach,
    /// The contact reaches an edge, where the pressure is singular.
    Reached,
}

/// How the contact meets the edges of `shape` along both axes; it does where the solution has a warning of them.
fn edges(solution: &Solution, shape: &dyn Surface) -> [Edge; 2] {
    let warned = |warning: &Warning| {
        matches!(warning, Warning::SharpEnd { .. } | Warning::FreeEnd | Warning::SharpEdge)
    };
    let mut edges = [Edge::Away; 2];
    if !solution.report.warnings.iter().any(warned) {
        return edges;
    }
    let (grid, pressure) = (solution.grid(), &solution.pressure);
    let (x, y, spacing) = (grid.x(), grid.y(), grid.spacing());
    for ((i, j), _) in pressure.indexed_iter().filter(|(_, p)| **p > 0.0) {
        for (axis, side) in [(0, -1_isize), (0, 1), (1, -1), (1, 1)] {
            let beside = if axis == 0 {
                [i.checked_add_signed(side), Some(j)]
            } else {
                [Some(i), j.checked_add_signed(side)]
            };
            let in_contact = match beside {
                [Some(i), Some(j)] => pressure.get([i, j]).is_some_and(|p| *p > 0.0),
                _ => false,
            };
            if in_contact {
                continue;
            }
            let mut step = [0.0; 2];
            step[axis] = side as f64 * spacing[axis];
            match touches_edge(solution, shape, [x[i], y[j]], step) {
                Some(true) => return [Edge::Reached; 2],
                Some(false) => edges[axis] = Edge::OutOfReach,
                None => {}
            }
        }
    }
    edges
}

/// Whether the edge of `shape` between `[x, y]` and the place a `step` further can touch the surface; `None` where
/// there is no edge between them.
fn touches_edge(
    solution: &Solution,
    shape: &dyn Surface,
    [x, y]: [f64; 2],
    step: [f64; 2],
) -> Option<bool> {
    // Halvings of a cell's length, to the rounding of coordinates.
    const HALVINGS: usize = 50;
    let at = |part: f64| [x + part * step[0], y + part * step[1]];
    let gap = |[x, y]: [f64; 2]| shape.gap(x, y);
    if gap(at(1.0)).is_finite() {
        return None;
    }
    let (mut inside, mut outside) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inside + outside);
        if gap(at(middle)).is_finite() {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    let edge @ [x, y] = at(inside);
    Some(gap(edge) < solution.approach + solution.tilt[0] * x + solution.tilt[1] * y)
}

/// The estimated error of the peak pressure, relative to the peak; `None` where there is no estimate.
fn peak_error(solution: &Solution) -> Option<f64> {
    let (peak, errors) = (solution.peak_pressure(), solution.report.discretisation?);
    errors.peak_pressure.filter(|_| peak > 0.0).map(|error| error / peak)
}

/// Along each axis: whether the pressure bends about as much as along the other, and whether few cells are in
/// contact, both on the line through the peak.
fn around_peak(solution: &Solution) -> ([bool; 2], [bool; 2]) {
    let (pressure, peak) = (&solution.pressure, solution.peak_pressure());
    let found = pressure.indexed_iter().find(|(_, p)| **p >= peak);
    let (row, column) = found.map_or((0, 0), |(at, _)| at);
    let lines = [(pressure.column(column), row), (pressure.row(row), column)];
    let bends = lines.map(|(line, at)| {
        let value = |k: usize| line.get(k).copied().unwrap_or(0.0);
        let near = at.saturating_sub(AROUND_PEAK)..=at + AROUND_PEAK;
        let second = |k: usize| {
            let before = if k == 0 { 0.0 } else { value(k - 1) };
            (before - 2.0 * value(k) + value(k + 1)).abs()
        };
        near.map(second).fold(0.0, f64::max)
    });
    let narrow = lines.map(|(line, at)| {
        let free = |k: &usize| line.get(*k).is_some_and(|p| *p > 0.0);
        let above = (at..line.len()).take_while(free).count();
        let below = (0..at).rev().take_while(free).count();
        above + below < NARROW
    });
    let most = bends[0].max(bends[1]);
    (bends.map(|bend| bend >= BENDS_TOO * most), narrow)
}
