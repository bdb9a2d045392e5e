//! The contact problem: g = h + u − δ − s_x x − s_y y ≥ 0, p ≥ 0, p g = 0.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use ndarray::Array2;

use crate::convolution::Convolution;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::coefficients_on;
use crate::parallel::Threads;
use crate::parallel::check_memory;
use crate::response::Body;
use crate::surface::Surface;

mod automatic;
mod batch;
mod cascade;
mod options;
mod problem;
mod solution;
mod solver;
mod start;

pub use automatic::{choose_grid, solve};
pub use batch::Case;
pub use cascade::discretisation::Discretisation;
pub use options::{Algorithm, Options, Setup};
pub use problem::Termination;
pub use problem::freedoms::Motion;
pub use solution::{Balance, Report, Solution, Warning};

use crate::parallel::Passes;
use cascade::discretisation::estimate;
use cascade::levels::Levels;
use cascade::{Cascade, Coarser};
use problem::freedoms::{Freedoms, OVERFLOW};
use problem::{Limits, Outcome, Problem, Quality, Watch};
use solution::fields::{Fields, slice};
use solution::gap::Gap;
use solution::warnings::{Carried, warnings};
use start::{Sampled, checked_gaps, given_pressure, uniform_pressure};

/// Is told of each iteration, perhaps on one of the plan's threads, and breaks to stop.
pub type Progress<'a> = dyn FnMut(&Report) -> ControlFlow<()> + Send + 'a;

/// A body on a grid, planned once: influence coefficients and their transform.
///
/// A plan and a solve take up to 160 bytes a cell: what does not fit is refused before it starts.
/// Between solves a plan keeps the memory that they worked in: up to 120 bytes a cell.
///
/// ```
/// use nacre::{Contact, Elastic, Grid, Motion, Options, Paraboloid, Setup};
///
/// // Hertz: δ = (9 W² / 16 R E*²)^{1/3}
/// let contact = Contact::plan(&Elastic::new(1.0, 0.0)?, Grid::new([64, 64], [4.0, 4.0])?, Setup::default())?;
/// let solution = contact.solve(&Paraboloid::new(1e3, 1e3)?, &Motion::load(1e-3), &Options::default())?;
/// let hertz = (9.0 * 1e-6 / (16.0 * 1e3_f64)).powf(1.0 / 3.0);
/// assert!((solution.approach / hertz - 1.0).abs() < 2e-3);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug)]
pub struct Contact {
    body: Body,
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
    pub fn plan(body: impl Into<Body>, grid: Grid, setup: Setup) -> Result<Self> {
        let body = body.into();
        check_memory(grid.shape(), memory(&grid))?;
        let threads = Arc::new(Threads::new(setup.threads)?);
        let both = |grid: &Grid| -> Result<Array2<f64>> {
            let mut coefficients = coefficients_on(&*body, grid, setup.method, &threads)?;
            if let Some(counterbody) = &setup.counterbody {
                coefficients += &coefficients_on(&**counterbody, grid, setup.method, &threads)?;
            }
            Ok(coefficients)
        };
        let coefficients = both(&grid)?;
        let convolution = Convolution::plan_on(&coefficients, Arc::clone(&threads))?;
        let levels = Levels::plan(grid, coefficients, &convolution, both)?;
        Ok(Self {
            body,
            grid,
            setup,
            convolution,
            levels,
        })
    }

    /// The same plan on other threads; it shares all that is large.
    fn on_threads(&self, threads: &Arc<Threads>) -> Self {
        let convolution = self.convolution.on_threads(threads);
        Self {
            body: self.body.clone(),
            grid: self.grid,
            setup: self.setup.clone(),
            levels: self.levels.beside(&convolution),
            convolution,
        }
    }

    /// The body that shapes are pressed into.
    pub fn body(&self) -> &Body {
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
        let sampled = &mut Sampled::default();
        self.whole(|| self.solve_here(shape, sampled, motion, options, progress))
    }

    /// Calls `work`, a whole solve, on the plan's threads.
    fn whole<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        let [nx, ny] = self.grid.shape();
        self.convolution.own_threads().run_inside(nx * ny, work)
    }

    /// [`Contact::solve_watched`] on this thread and those that it finds free; where `shape` is the one
    /// of `sampled`, its gaps are not computed again.
    fn solve_here<'a>(
        &self,
        shape: &'a dyn Surface,
        sampled: &mut Sampled<'a>,
        motion: &Motion,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Solution> {
        let start = Instant::now();
        let freedoms = Freedoms::new(motion, &self.grid)?;
        let limits = options.limits()?;
        let passes = Passes::new(&freedoms.columns, self.convolution.own_threads());
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
        let cascades = options.algorithm == Algorithm::Cascade;
        let mut coarser = |gap: Option<&Array2<f64>>| {
            Coarser::solve(&freedoms, gap, shape, &self.levels, limits, &mut watch)
        };
        // The system may take long to hand out memory, and the coarsest grids are too small to be divided.
        let (finest, ahead) = passes.both(
            || -> Result<_> {
                let sample = || checked_gaps(shape, &self.grid, &passes);
                let mut gap = sampled.gaps(shape, sample)?;
                freedoms.check_feasible(&gap)?;
                if freedoms.any_prescribed() {
                    freedoms.prescribe(Arc::make_mut(&mut gap));
                }
                Ok((gap, Fields::new(self.grid.shape(), &passes)))
            },
            || (cascades && options.initial.is_none()).then(|| coarser(None)),
        );
        let (gap, mut fields) = finest?;
        let problem = Problem {
            convolution: &self.convolution,
            freedoms: &freedoms,
            gap: slice(&gap),
        };
        let initial = given_pressure(&problem, options.initial.as_deref())?;
        let cascade = match &initial {
            _ if !cascades => None,
            Some(given) => Some((Cascade::from(given, &problem, &gap, &self.levels), None)),
            None => (ahead.flatten())
                .or_else(|| coarser(Some(&gap)))
                .and_then(|coarser| Cascade::after(coarser, &problem, &gap, &self.levels)),
        };
        let mut figures = Vec::new();
        let solved = match cascade {
            Some((cascade, Some(stopped))) => {
                cascade.give(&mut fields);
                stopped
            }
            Some((mut cascade, None)) => {
                figures = std::mem::take(&mut cascade.figures);
                solve_in_window(&problem, cascade, &mut fields, limits, &mut watch)
            }
            None => {
                fields.pressure = initial.map_or_else(|| uniform_pressure(&problem), Ok)?;
                solver::polonsky_keer::solve(&problem, &mut fields, limits, &mut watch)
            }
        };
        let quality = (fields.quality).unwrap_or_else(|| fields.certify(&problem, solved.lambda));
        if !quality.finite || quality.residual.is_infinite() {
            return Err(OVERFLOW);
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
            motion: multipliers,
            ..
        } = fields;
        let (carried, warnings) = passes.both(
            || Carried::by(&pressure, &window, &self.grid),
            || warnings(&pressure, &window, &self.grid, shape),
        );
        if report.converged() {
            figures.push(carried.figures(approach));
            report.discretisation = estimate(&figures);
        }
        report.balance = carried.balance(&self.grid, motion);
        report.warnings = warnings;
        report.seconds = start.elapsed().as_secs_f64();
        Ok(Solution {
            pressure,
            displacement,
            approach,
            tilt,
            report,
            gap: Gap::Computed {
                undeformed: gap,
                freedoms: Box::new(freedoms),
                multipliers,
            },
        })
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
}

/// Bytes that a plan, its coefficients, and the arrays of one solve take: 160 a cell (measured: 135
/// where the contact fills the grid, 151 where it tilts, too; 67 where it fills a ninth).
fn memory(grid: &Grid) -> u64 {
    const ARRAYS: u64 = 17;
    let [nx, ny] = grid.shape();
    Convolution::memory(grid.shape()) + (nx as u64 * ny as u64) * 8 * ARRAYS
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
            let end =
                solver::polonsky_keer::solve(problem, fields, left, &mut |more, work, quality| {
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
