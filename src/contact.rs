//! The contact problem: g = h + u − δ − s_x x − s_y y ≥ 0, p ≥ 0, p g = 0.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use ndarray::{Array2, ArrayRef2};

use crate::body::HalfSpace;
use crate::convolution::Convolution;
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::influence::coefficients_on;
use crate::memory::check_memory;
use crate::surface::Surface;
use crate::threads::Threads;

mod automatic;
mod balance;
mod batch;
mod cascade;
mod direct;
mod discretisation;
mod fields;
mod fit;
mod freedoms;
mod hull;
mod options;
mod passes;
mod patch;
mod polonsky_keer;
mod preconditioned;
mod problem;
mod review;
mod solution;
mod stiffness;
mod sums;

pub use automatic::{choose_grid, solve};
pub use batch::Case;
pub use discretisation::Discretisation;
pub use freedoms::Motion;
pub use options::{Algorithm, Options, Setup};
pub use problem::Termination;
pub use solution::{Balance, Report, Solution, Warning};

use cascade::{Cascade, Levels};
use discretisation::estimate;
use fields::{Fields, array, slice};
use freedoms::Freedoms;
use passes::Passes;
use problem::{Limits, Outcome, Problem, Quality, Watch};
use review::{Carried, warnings};

/// Is told of each iteration, and breaks to stop.
pub type Progress<'a> = dyn FnMut(&Report) -> ControlFlow<()> + 'a;

/// A body on a grid, planned once: influence coefficients and their transform.
///
/// A plan and a solve take up to 170 bytes a cell: what does not fit is refused before it starts.
///
/// ```
/// use nacre::{Contact, Elastic, Grid, Motion, Options, Paraboloid, Setup};
///
/// // Hertz: δ = (9 W² / 16 R E*²)^{1/3}
/// let contact = Contact::plan(&Elastic::new(1.0, 0.0)?.into(), Grid::new([64, 64], [4.0, 4.0])?, Setup::default())?;
/// let solution = contact.solve(&Paraboloid::new(1e3, 1e3)?, &Motion::load(1e-3), &Options::default())?;
/// let hertz = (9.0 * 1e-6 / (16.0 * 1e3_f64)).powf(1.0 / 3.0);
/// assert!((solution.approach / hertz - 1.0).abs() < 2e-3);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug)]
pub struct Contact {
    body: HalfSpace,
    grid: Grid,
    setup: Setup,
    convolution: Convolution,
    levels: Levels,
}

impl Contact {
    /// Plans contacts of `body` on `grid`.
    ///
    /// # Errors
    /// A method that does not suit, no threads, too little memory.
    pub fn plan(body: &HalfSpace, grid: Grid, setup: Setup) -> Result<Self> {
        check_memory(grid.shape(), memory(&grid))?;
        let threads = Arc::new(Threads::new(setup.threads)?);
        let both = |grid: &Grid| -> Result<Array2<f64>> {
            let mut coefficients = coefficients_on(body, grid, setup.method, &threads)?;
            if let Some(counterbody) = &setup.counterbody {
                coefficients += &coefficients_on(counterbody, grid, setup.method, &threads)?;
            }
            Ok(coefficients)
        };
        let coefficients = both(&grid)?;
        let convolution = Convolution::plan_on(&coefficients, Arc::clone(&threads))?;
        let levels = Levels::plan(grid, coefficients, &convolution, both)?;
        Ok(Self {
            body: body.clone(),
            grid,
            setup,
            convolution,
            levels,
        })
    }

    /// The same plan on other threads; it shares all that is large.
    fn on_threads(&self, threads: &Arc<Threads>) -> Self {
        Self {
            body: self.body.clone(),
            grid: self.grid,
            setup: self.setup.clone(),
            convolution: self.convolution.on_threads(threads),
            levels: self.levels.on_threads(threads),
        }
    }

    /// The body that shapes are pressed into.
    pub fn body(&self) -> &HalfSpace {
        &self.body
    }

    /// What was planned beside body and grid.
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The convolution with the influence coefficients of both bodies together.
    pub fn convolution(&self) -> &Convolution {
        &self.convolution
    }

    /// Presses `shape` into the body. The solution says whether it converged.
    ///
    /// # Errors
    /// Bad input alone.
    pub fn solve(
        &self,
        shape: &dyn Surface,
        motion: &Motion,
        options: &Options,
    ) -> Result<Solution> {
        self.solve_watched(shape, motion, options, &mut |_| ControlFlow::Continue(()))
    }

    /// [`Contact::solve`], telling `progress` of each iteration; its break ends the solve with
    /// [`Termination::Stopped`].
    ///
    /// # Errors
    /// Bad input alone.
    pub fn solve_watched(
        &self,
        shape: &dyn Surface,
        motion: &Motion,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Solution> {
        let start = Instant::now();
        let freedoms = Freedoms::new(motion, &self.grid)?;
        let limits = options.limits()?;
        let mut gap = checked_gaps(shape, &self.grid)?;
        freedoms.check_feasible(&gap)?;
        freedoms.prescribe(&mut gap);
        let passes = Passes::new(&freedoms.columns, self.convolution.own_threads());
        let problem = Problem {
            convolution: &self.convolution,
            freedoms: &freedoms,
            gap: slice(&gap),
        };
        let initial = self.given_pressure(&problem, options.initial.as_deref())?;
        let mut report = self.report(motion, limits.tolerance);
        let unit = self.convolution.work();
        let mut watch = |iterations: usize, work: f64, quality: Quality| {
            report.iterations = iterations;
            report.convolutions = work / unit;
            report.residual = quality.residual;
            report.overlap = quality.overlap;
            report.seconds = start.elapsed().as_secs_f64();
            progress(&report).is_break()
        };
        let mut fields = Fields::new(self.grid.shape());
        let cascade = match options.algorithm {
            Algorithm::Cascade => Cascade::new(
                &problem,
                &gap,
                shape,
                &self.levels,
                initial.as_ref(),
                limits,
                &mut watch,
            ),
            Algorithm::PolonskyKeer => Err(()),
        };
        let mut figures = Vec::new();
        let solved = match cascade {
            Ok((cascade, Some(stopped))) => {
                cascade.give(&mut fields);
                stopped
            }
            Ok((mut cascade, None)) => {
                figures = std::mem::take(&mut cascade.figures);
                solve_in_window(&problem, cascade, &mut fields, limits, &mut watch)
            }
            Err(()) => {
                fields.pressure = initial.map_or_else(|| uniform_pressure(&problem), Ok)?;
                polonsky_keer::solve(&problem, &mut fields, limits, &mut watch)
            }
        };
        let quality = (fields.quality).unwrap_or_else(|| fields.certify(&problem, solved.lambda));
        // The undeformed gap is no longer needed.
        if !fields.close(&passes, &mut gap) {
            return Err(Error::Inconsistent(
                "load, lengths and moduli must be in units in which their products do not overflow",
            ));
        }
        report.termination = solved.termination;
        report.iterations = solved.iterations;
        report.convolutions = solved.work / unit;
        report.residual = quality.residual;
        report.overlap = quality.overlap;
        let (approach, tilt) = freedoms.motion(fields.motion.lambda());
        let Fields {
            pressure,
            window,
            displacement,
            ..
        } = fields;
        let mut solution = Solution {
            pressure,
            gap,
            displacement,
            approach,
            tilt,
            report,
        };
        let carried = Carried::by(&solution, &window);
        if solution.report.converged() {
            figures.push(carried.figures(solution.approach));
            solution.report.discretisation = estimate(&figures);
        }
        solution.report.balance = carried.balance(&self.grid, motion);
        solution.report.warnings = warnings(&solution, &window, shape);
        solution.report.seconds = start.elapsed().as_secs_f64();
        Ok(solution)
    }

    /// Of an iteration that has not begun.
    fn report(&self, motion: &Motion, tolerance: f64) -> Report {
        Report {
            termination: Termination::IterationLimit,
            iterations: 0,
            convolutions: 0.0,
            residual: 0.0,
            overlap: 0.0,
            balance: Balance::default(),
            discretisation: None,
            warnings: Vec::new(),
            grid: self.grid,
            body: self.body.clone(),
            counterbody: self.setup.counterbody.clone(),
            method: self.setup.method,
            motion: *motion,
            tolerance,
            seconds: 0.0,
        }
    }

    /// The pressure to start from that the caller gave, balanced.
    fn given_pressure(
        &self,
        problem: &Problem,
        initial: Option<&ArrayRef2<f64>>,
    ) -> Result<Option<Array2<f64>>> {
        let Some(initial) = initial else {
            return Ok(None);
        };
        let (name, expected) = ("initial", self.grid.shape());
        let found = [initial.nrows(), initial.ncols()];
        if found != expected {
            return Err(Error::Shape {
                name,
                expected,
                found,
            });
        }
        if let Some(((i, j), _)) = initial.indexed_iter().find(|(_, p)| !p.is_finite()) {
            return Err(Error::NonFinite {
                name,
                index: [i, j],
            });
        }
        if let Some(&value) = initial.iter().find(|p| **p < 0.0) {
            return Err(Error::Parameter {
                name,
                requirement: "at least 0 everywhere",
                value,
            });
        }
        let cells = initial.iter().zip(problem.gap);
        let mut p: Vec<f64> = cells
            .map(|(&p, h)| if h.is_finite() { p } else { 0.0 })
            .collect();
        // One that cannot carry the load is no help.
        Ok(problem.freedoms.balance(&mut p).then(|| array(expected, p)))
    }
}

/// Bytes that a plan, its coefficients, and the arrays of one solve take: 168 a cell (measured: 157
/// where the contact fills the grid, 91 where it fills a ninth).
fn memory(grid: &Grid) -> u64 {
    const ARRAYS: u64 = 16;
    let [nx, ny] = grid.shape();
    Convolution::memory(grid.shape()) + (nx as u64 * ny as u64) * 8 * ARRAYS
}

/// A balanced pressure on all cells that can touch.
fn uniform_pressure(problem: &Problem) -> Result<Array2<f64>> {
    let shape = problem.convolution.shape();
    let mut p = vec![0.0; problem.gap.len()];
    if problem.freedoms.balance(&mut p) {
        return Ok(array(shape, p));
    }
    let uniform = problem.freedoms.typical_pressure(p.len());
    for (p, h) in p.iter_mut().zip(problem.gap) {
        *p = if h.is_finite() { uniform } else { 0.0 };
    }
    if problem.freedoms.balance(&mut p) {
        return Ok(array(shape, p));
    }
    Err(Error::Inconsistent(
        "eccentricity or moment is too near the rim of the cells that can touch",
    ))
}

/// Solves in a window, which opens until nothing overlaps on the whole grid.
fn solve_in_window(
    problem: &Problem,
    mut cascade: Cascade,
    fields: &mut Fields,
    limits: Limits,
    watch: &mut Watch,
) -> Outcome {
    const RETRIES: usize = 2;
    let (mut iterations, mut retries) = (0, 0);
    loop {
        let left = limits.after(iterations);
        let outcome = cascade.solve(fields, left, watch);
        let quality = fields.certify(problem, outcome.lambda);
        cascade.work += problem.convolution.work();
        iterations += outcome.iterations;
        let outcome = Outcome {
            iterations,
            work: cascade.work,
            ..outcome
        };
        if outcome.termination == Termination::Stopped || quality.meets(limits.tolerance) {
            return outcome;
        }
        if iterations >= limits.max_iterations {
            return Outcome {
                termination: Termination::IterationLimit,
                ..outcome
            };
        }
        let converged = outcome.termination == Termination::Converged;
        if converged && cascade.open(problem, fields) {
            continue;
        }
        // What it took for the displacement may have drifted, by rounding.
        retries += 1;
        if !converged || retries > RETRIES {
            // It broke down, by rounding: the reference goes on from there.
            let left = limits.after(iterations);
            let before = cascade.work;
            let end = polonsky_keer::solve(problem, fields, left, &mut |more, work, quality| {
                watch(iterations + more, before + work, quality)
            });
            fields.certify(problem, end.lambda);
            let (iterations, work) = (iterations + end.iterations, before + end.work);
            return Outcome {
                iterations,
                work,
                ..end
            };
        }
    }
}

/// Gaps of `shape` on `grid`, finite or +∞.
fn checked_gaps(shape: &dyn Surface, grid: &Grid) -> Result<Array2<f64>> {
    let gaps = shape.gaps(grid)?;
    let found = [gaps.nrows(), gaps.ncols()];
    if found != grid.shape() {
        return Err(Error::Shape {
            name: "shape",
            expected: grid.shape(),
            found,
        });
    }
    let gaps = if gaps.is_standard_layout() {
        gaps
    } else {
        gaps.as_standard_layout().into_owned()
    };
    let bad = |h: &f64| h.is_nan() || *h == f64::NEG_INFINITY;
    if let Some(cell) = slice(&gaps).iter().position(bad) {
        return Err(Error::NonFinite {
            name: "shape",
            index: [cell / found[1], cell % found[1]],
        });
    }
    Ok(gaps)
}
