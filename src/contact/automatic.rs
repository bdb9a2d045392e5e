//! The grid that is chosen where none is given: a method of nacre's own.

use std::ops::ControlFlow;

use super::motion::Motion;
use super::options::{Options, Setup};
use super::plan::Plan;
use super::problem::constraint::NonNegative;
use super::solution::Solution;
use super::solution::report::Progress;
use super::solver::Termination;
use super::start::Sampled;
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::response::Body;
use crate::surface::{Extent, Surface};

/// Cells across the narrower width of the contact. The 64 that are promised are raised by 7 %, because the
/// contact on the coarse grid is up to 6 % too wide.
const ACROSS: f64 = 64.0 * 1.07;

/// Free width on either side of the contact, relative to the width of the contact; chosen by trial.
const FRAME_MARGIN: f64 = 0.25;

/// Cells of the coarse grid in each direction; chosen by trial.
const COARSE_CELLS: usize = 48;

/// Tolerance on the coarse grid; chosen by trial.
const FRAME_TOLERANCE: f64 = 1e-4;

/// Largest ratio of a cell's sides; chosen by trial.
const ASPECT_RATIO: f64 = 16.0;

/// Smallest number of cells along a contact whose cells are oblong; chosen by trial.
const LONG_CONTACT: f64 = 1024.0;

/// Enlargements of the coarse grid by a factor of up to 3: 3¹⁰ in all.
const ENLARGEMENTS: usize = 10;

/// Reductions of the coarse grid around a contact that is small on it, by a factor of 4/3 at least.
const REDUCTIONS: usize = 40;

/// Presses `shape` into `body` with every default: a grid from [`choose_grid`] (a measured
/// surface's own), exact coefficients, all threads.
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
    let body = &body.into();
    let (setup, options) = (Setup::default(), Options::default());
    let mut go_on = |_: &_| ControlFlow::Continue(());
    let grid = choose_grid(shape, body, &setup, motion, &options, &mut go_on)?;
    let solution = solve_once(shape, body, grid, &setup, motion, &options, &mut go_on)?;
    solution.require_converged(options.tolerance)
}

/// A grid for the contact of `shape` and `body`: a measured surface's own; else one with 64 cells
/// across the narrower width of the contact, oblong where it is long, and a margin of a quarter of
/// the contact on every side.
///
/// The contact is solved on a coarse grid, which is enlarged while the contact touches its edge, ten
/// times at most.
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
        None => search(shape, body, setup, motion, options, progress),
    }
}

/// Plans one grid, and solves on it.
fn solve_once(
    shape: &dyn Surface,
    body: &Body,
    grid: Grid,
    setup: &Setup,
    motion: &Motion,
    options: &Options,
    progress: &mut Progress,
) -> Result<Solution> {
    let plan = Plan::new(body.clone(), grid, setup.clone())?;
    plan.run(|| plan.solve(shape, &mut Sampled::default(), motion, options, progress))
}

/// Ends of a rectangle along x and along y.
type Frame = [[f64; 2]; 2];

/// Enlarges and reduces a coarse grid until it fits the contact.
fn search(
    shape: &dyn Surface,
    body: &Body,
    setup: &Setup,
    motion: &Motion,
    options: &Options,
    progress: &mut Progress,
) -> Result<Grid> {
    let extent = shape.extent();
    if extent.contains(&Extent::Endless) {
        return Err(Error::Inconsistent(
            "grid must be given for a shape without end: its contact is as long as the grid",
        ));
    }
    // Options that only the real grid can meet are checked here and left out.
    options.stop_criteria()?;
    let coarse = Options {
        tolerance: FRAME_TOLERANCE,
        initial: None,
        ..options.clone()
    };
    let mut frame = first_frame(shape, body, setup, motion)?;
    let (mut enlargements, mut reductions) = (0, 0);
    loop {
        let grid = grid_over(frame, [COARSE_CELLS; 2])?;
        let solution = solve_once(shape, body, grid, setup, motion, &coarse, progress)?;
        let Some(contact) = cells_in_contact(&solution) else {
            // Nothing touches there: any grid shows that.
            return Ok(grid);
        };
        if solution.report.termination == Termination::Stopped {
            return Ok(grid);
        }
        let mut next = frame;
        let (mut grown, mut shrunk) = (false, false);
        for axis in [0, 1] {
            let [low, high] = frame[axis];
            let width = high - low;
            let spacing = grid.spacing()[axis];
            let [first, last] = contact[axis];
            let range = extent[axis].range();
            // An edge that is touched moves out by the width, as far as the shape goes.
            let touched = [
                first == 0 && low > range[0],
                last == COARSE_CELLS - 1 && high < range[1],
            ];
            if touched[0] || touched[1] {
                grown = true;
                next[axis] = [
                    if touched[0] { low - width } else { low },
                    if touched[1] { high + width } else { high },
                ];
            } else if last - first + 1 < COARSE_CELLS / 4 {
                shrunk = true;
                let contact = [
                    low + first as f64 * spacing,
                    low + (last + 1) as f64 * spacing,
                ];
                let margin = contact[1] - contact[0];
                next[axis] = [contact[0] - margin, contact[1] + margin];
            }
        }
        if grown {
            if enlargements == ENLARGEMENTS {
                return Err(Error::NoGrid {
                    enlargements,
                    size: grid.size(),
                });
            }
            enlargements += 1;
        } else if shrunk && reductions < REDUCTIONS {
            reductions += 1;
        } else {
            return final_grid(&solution, extent);
        }
        frame = next;
    }
}

/// The rectangle around the load point in which the undeformed shape overlaps, at the approach that carries
/// the load by the estimate W = 2 E* δ √(a b), which holds for a flat square punch within 10 %.
fn first_frame(shape: &dyn Surface, body: &Body, setup: &Setup, motion: &Motion) -> Result<Frame> {
    let (extent, radii) = (shape.extent(), shape.radii());
    // α û/p̂ of both bodies, for waves of a contact of half-width 1/α: where the limits say nothing, the
    // response itself, and the local compliance.
    let bodies = [Some(body), setup.counterbody.as_ref()];
    let compliance = |alpha: f64| -> f64 {
        let bodies = bodies.iter().flatten();
        bodies
            .map(|body| {
                let limits = body.asymptotes();
                let larger = match limits.short.max(limits.long) {
                    0.0 => body.normal(alpha),
                    larger => larger,
                };
                larger + alpha * body.local()
            })
            .sum()
    };
    let center: [f64; 2] = std::array::from_fn(|axis| {
        let [low, high] = extent[axis].range();
        let middle = if low.is_finite() && high.is_finite() {
            0.5 * (low + high)
        } else {
            0.0
        };
        motion.eccentricity[axis]
            .filter(|e| *e > low && *e < high)
            .unwrap_or(middle)
    });
    let base = shape.gap(center[0], center[1]);
    let base = if base.is_finite() { base } else { 0.0 };
    // Half-widths of the overlap at approach δ, along both axes.
    let widths = |approach: f64| -> [f64; 2] {
        std::array::from_fn(|axis| {
            let inside = |d: f64| {
                [-d, d].into_iter().any(|d| {
                    let mut at = center;
                    at[axis] += d;
                    shape.gap(at[0], at[1]) < base + approach
                })
            };
            // By powers of √2 from far below any contact to far above.
            let mut width = f64::MIN_POSITIVE.sqrt();
            while width < 1e12 && inside(width) {
                width *= std::f64::consts::SQRT_2;
            }
            width
        })
    };
    let approach = match (motion.load, motion.approach) {
        (Some(load), _) => {
            let carries = |approach: f64| {
                let [a, b] = widths(approach);
                let half = (a * b).sqrt();
                4.0 * approach * half / compliance(1.0 / half)
            };
            let mut approach = 1.0;
            while approach > 1e-30 && carries(approach) > load {
                approach *= 0.5;
            }
            while approach < 1e12 && carries(approach) < load {
                approach *= 2.0;
            }
            approach
        }
        (None, Some(approach)) => (approach - base).max(0.0),
        (None, None) => 0.0,
    };
    let halves = widths(approach);
    let frame = std::array::from_fn(|axis| {
        let half = 1.5 * halves[axis];
        let [low, high] = extent[axis].range();
        // Somewhat beyond the ends of the shape, where it has any.
        let beyond = 0.02 * (high - low);
        let (low, high) = (low - beyond, high + beyond);
        [
            (center[axis] - half).max(low),
            (center[axis] + half).min(high),
        ]
    });
    for [low, high] in &frame {
        if high - low <= 1e-100 || !(high - low).is_finite() {
            // Nothing overlaps: a grid around the middle shows that nothing touches.
            let sizes = [
                extent[0].range()[1],
                extent[1].range()[1],
                radii[0],
                radii[1],
            ];
            let size = sizes
                .into_iter()
                .map(f64::abs)
                .filter(|s| s.is_finite() && *s > 0.0);
            let half = 0.01 * size.reduce(f64::min).unwrap_or(1.0);
            return Ok(center.map(|c| [c - half, c + half]));
        }
    }
    Ok(frame)
}

/// A grid over a rectangle.
fn grid_over(frame: Frame, shape: [usize; 2]) -> Result<Grid> {
    Grid::new(shape, frame.map(|[low, high]| high - low))?
        .centered_at(frame.map(|[low, high]| 0.5 * (low + high)))
}

/// First and last cell in contact along each axis.
fn cells_in_contact(solution: &Solution) -> Option<[[usize; 2]; 2]> {
    let mut found: Option<[[usize; 2]; 2]> = None;
    let cells = solution.pressure.indexed_iter();
    for ((i, j), _) in cells.filter(|(_, p)| NonNegative.is_free(**p)) {
        let [x, y] = found.unwrap_or([[i; 2], [j; 2]]);
        found = Some([[x[0].min(i), x[1].max(i)], [y[0].min(j), y[1].max(j)]]);
    }
    found
}

/// The final grid: the contact of the coarse `solution` and a margin around it, in fine cells.
fn final_grid(solution: &Solution, extent: [Extent; 2]) -> Result<Grid> {
    let contact = solution.contact_extent();
    let widths = contact.map(|[low, high]| high - low);
    let finest = widths[0].min(widths[1]) / ACROSS;
    let frame: Frame = std::array::from_fn(|axis| {
        let margin = FRAME_MARGIN * widths[axis];
        let [low, high] = extent[axis].range();
        // A shape that ends needs no more than a cell beyond its end.
        let low = (contact[axis][0] - margin).max(low - 2.0 * finest);
        let high = (contact[axis][1] + margin).min(high + 2.0 * finest);
        [low, high]
    });
    let shape = std::array::from_fn(|axis| {
        let cells =
            (widths[axis] / finest).min((widths[axis] / (ASPECT_RATIO * finest)).max(LONG_CONTACT));
        let cell = widths[axis] / cells.max(ACROSS);
        // Rounding must not add a cell where the frame is a whole number of them.
        let count = ((frame[axis][1] - frame[axis][0]) / cell * (1.0 - 1e-9)).ceil();
        // Even, so that the middle of a symmetric contact lies between cells.
        2 * (0.5 * count).ceil() as usize
    });
    grid_over(frame, shape)
}
