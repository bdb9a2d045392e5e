//! One solve, as named steps in order.

use std::fmt;
use std::ops::ControlFlow;
use std::sync::Arc;

use ndarray::Array2;

use crate::compliance::ends::check_carried;
use crate::contact::cascade::discretisation::{Discretisation, GridResult, corner_error, estimate};
use crate::contact::cascade::{COARSE_TOLERANCE, Cascade, coarse_means};
use crate::contact::options::{Algorithm, Motion, Options};
use crate::contact::plan::Contact;
use crate::contact::problem::bounds::{Bounds, Hardness, check_indentation};
use crate::contact::problem::freedoms::Freedoms;
use crate::contact::problem::springs::Compliance;
use crate::contact::problem::{Problem, Quality, SolutionFields};
use crate::contact::solution::warnings::{Warning, warnings};
use crate::contact::solution::{Gap, Progress, Report, Resultants, Solution};
use crate::contact::solver::{Outcome, Solver, StopCriteria, Tally, Termination, polonsky_keer};
use crate::contact::start::{
    Sampled, check_curved, check_seam, checked_gaps, initial_pressure, uniform_pressure,
    yielding_pressure,
};
use crate::error::{Error, Result};
use crate::model::grid::Window;
use crate::model::surface::{OffsetShape, Surface};
use crate::numerics::clock::Stopwatch;
use crate::numerics::layout::slice;
use crate::numerics::parallel::Rows;

/// Options of a solve, and the callback that watches it, if there is one: [`Options::watched`].
pub struct WatchedSolve<'a> {
    pub(super) options: &'a Options,
    progress: Option<&'a mut Progress<'a>>,
}

impl Options {
    /// These options, with a callback that is told of each iteration; its break ends the solve with
    /// [`Termination::Stopped`].
    pub fn watched<'a>(&'a self, progress: &'a mut Progress<'a>) -> WatchedSolve<'a> {
        WatchedSolve { options: self, progress: Some(progress) }
    }
}

impl WatchedSolve<'_> {
    /// Tells the callback of an iteration.
    pub(super) fn tell(&mut self, report: &Report) -> ControlFlow<()> {
        match &mut self.progress {
            Some(progress) => progress(report),
            None => ControlFlow::Continue(()),
        }
    }
}

impl<'a> From<&'a Options> for WatchedSolve<'a> {
    fn from(options: &'a Options) -> Self {
        Self { options, progress: None }
    }
}

impl fmt::Debug for WatchedSolve<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.options.fmt(f)
    }
}

impl Contact {
    /// Presses `shape` into the body. The solution says whether it converged.
    ///
    /// # Errors
    /// Bad input, and too little memory.
    pub fn solve<'a>(
        &self,
        shape: &dyn Surface,
        motion: &Motion,
        options: impl Into<WatchedSolve<'a>>,
    ) -> Result<Solution> {
        let mut watched_options = options.into();
        let options = watched_options.options;
        let progress = &mut |report: &Report| watched_options.tell(report);
        self.solve_watched(shape, &mut Sampled::default(), motion, options, progress)
    }

    /// [`Contact::solve`] with a callback that is told of each iteration. Where `shape` was sampled last, its gaps are not
    /// computed again.
    pub(super) fn solve_watched<'a>(
        &self,
        shape: &'a dyn Surface,
        sampled: &mut Sampled<'a>,
        motion: &Motion,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Solution> {
        self.run(|| {
            let mut solution = self.solve_sampled(shape, sampled, motion, options, progress)?;
            self.state_errors(&mut solution, shape, options, progress);
            self.compare(&mut solution, shape, motion, options, progress);
            Ok(solution)
        })
    }

    /// [`Contact::solve`] without comparison with alternatives of the shape, on this thread and on threads of the plan that
    /// are free.
    pub(crate) fn solve_alone(
        &self,
        shape: &dyn Surface,
        motion: &Motion,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Solution> {
        self.solve_sampled(shape, &mut Sampled::default(), motion, options, progress)
    }

    fn solve_sampled<'a>(
        &self,
        shape: &'a dyn Surface,
        sampled: &mut Sampled<'a>,
        motion: &Motion,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Solution> {
        check_carried(self.setup.counterbody.as_ref(), shape)?;
        check_seam(shape, &self.grid)?;
        check_curved(shape, &self.grid)?;
        self.check_memory_of_solve(options.hardness.is_some())?;
        if let Some(compliance) = &options.compliance {
            let springs = compliance.on(&self.grid)?;
            let without = Options { compliance: None, ..options.clone() };
            let mut solution =
                self.press_springs(shape, sampled, &springs, motion, &without, progress)?;
            solution.compliance = Some(compliance.clone());
            return Ok(solution);
        }
        let Some(before) = &options.indentation else {
            return self.press(shape, sampled, motion, options, progress);
        };
        check_indentation(before, &self.grid)?;
        let dented = OffsetShape::new(shape, &self.grid, before.clone());
        let mut solution =
            self.press(&dented, &mut Sampled::default(), motion, options, progress)?;
        solution.indentation = Some(match solution.indentation {
            Some(deeper) => deeper + before,
            None => before.clone(),
        });
        Ok(solution)
    }

    /// [`Contact::solve_alone`] with springs of these compliances (nx, ny) \[m/Pa\] between the surfaces, which the options do
    /// not have. The gap has what they give; the displacement is that of the bodies.
    pub(crate) fn solve_on_springs(
        &self,
        shape: &dyn Surface,
        springs: &Array2<f64>,
        motion: &Motion,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Solution> {
        self.press_springs(shape, &mut Sampled::default(), springs, motion, options, progress)
    }

    fn press_springs<'a>(
        &self,
        shape: &'a dyn Surface,
        sampled: &mut Sampled<'a>,
        springs: &Array2<f64>,
        motion: &Motion,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Solution> {
        // From a given pressure, a solve begins on the finest grid.
        let grids = if options.initial.is_some() { 1 } else { self.levels.len() };
        // Without any give, nothing is changed.
        let soft = springs.iter().any(|c| *c > 0.0).then(|| self.on_springs(springs, grids));
        let plan = soft.as_ref().unwrap_or(self);
        let mut solution = plan.solve_sampled(shape, sampled, motion, options, progress)?;
        solution.take_springs(springs);
        Ok(solution)
    }

    /// Presses a shape into the body that has the indentations of earlier solves.
    fn press<'a>(
        &self,
        shape: &'a dyn Surface,
        sampled: &mut Sampled<'a>,
        motion: &Motion,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Solution> {
        let start = Stopwatch::start();
        let freedoms = Freedoms::new(motion, &self.grid)?;
        let columns = self.grid.shape()[1];
        let limits = (options.hardness.as_ref())
            .map(|hardness| hardness.check(&self.grid).map(|()| Bounds::of(hardness, columns)))
            .transpose()?;
        if !freedoms.loaded[0] {
            self.datum.check_approach()?;
        }
        let limited = self.ends.limit(shape);
        let steps = Steps {
            plan: self,
            shape: if self.ends.any() { &limited } else { shape },
            motion,
            options,
            freedoms: &freedoms,
            criteria: options.stop_criteria()?,
        };
        let mut report = Report::planned(self, steps.shape, motion, options);
        let unit = self.convolution().work();
        let mut count = |iterations: usize, work: f64, quality: Quality| -> ControlFlow<()> {
            report.count(iterations, work / unit, quality);
            report.seconds = start.elapsed().as_secs_f64();
            progress(&report)
        };
        let tally = &mut Tally::new(&mut count);

        let gap = steps.sample(shape, sampled)?;
        let mut fields = SolutionFields::new(self.grid.shape());
        let elastic = Problem {
            convolution: self.convolution(),
            freedoms: &freedoms,
            gap: &slice(&gap),
            bounds: &Bounds::none(columns),
            local: &self.levels[0].local,
        };
        if let Some(hardness) = &options.hardness {
            check_load(&elastic, hardness)?;
        }
        let (mut outcome, results) = steps.iterate(&elastic, &gap, &mut fields, tally)?;
        let exceeded = |limits: &Bounds| {
            let pressures = slice(&fields.pressure);
            pressures.iter().enumerate().any(|(k, p)| *p > limits.limit(k))
        };
        let stopped = outcome.termination == Termination::Stopped;
        let limits = limits.filter(|limits| !stopped && exceeded(limits));
        let problem = Problem { bounds: limits.as_ref().unwrap_or(elastic.bounds), ..elastic };
        if problem.bounds.is_limited() {
            let g = fields.gap(&problem);
            let start = yielding_pressure(&problem, &slice(&fields.pressure), &g)?;
            fields.pressure.fill(0.0);
            outcome = steps.solve_from(start, &problem, &gap, &mut fields, tally)?;
        }
        let (iterations, work) = (tally.iterations, tally.work);
        let quality = (fields.quality).unwrap_or_else(|| fields.certify(&problem, outcome.lambda));
        report.count(iterations, work / unit, quality);
        let indentation = problem.bounds.is_limited().then(|| fields.indentation(&problem));
        let fields = (gap, indentation, fields);
        let mut solution = steps.report(fields, (outcome, quality), results, report)?;
        solution.report.seconds = start.elapsed().as_secs_f64();
        Ok(solution)
    }
}

/// What the steps of one solve share.
struct Steps<'a> {
    plan: &'a Contact,
    /// The shape between the free ends of the bodies.
    shape: &'a dyn Surface,
    motion: &'a Motion,
    options: &'a Options,
    freedoms: &'a Freedoms,
    criteria: StopCriteria,
}

impl<'a> Steps<'a> {
    fn rows(&self) -> Rows<'a> {
        Rows::new(&self.freedoms.columns, self.plan.convolution().own_threads())
    }

    /// Whether the solve starts with nested grids.
    fn cascades(&self) -> bool {
        self.options.algorithm == Algorithm::Cascade
    }

    /// The gap, less the prescribed motion. The shape that is `original` tells whether it was sampled before.
    fn sample<'s>(
        &self,
        original: &'s dyn Surface,
        sampled: &mut Sampled<'s>,
    ) -> Result<Arc<Array2<f64>>> {
        let sample = || checked_gaps(self.shape, &self.plan.grid, &self.rows());
        let mut gap = sampled.gaps(original, sample)?;
        self.freedoms.check_feasible(&gap)?;
        if self.freedoms.any_prescribed() {
            self.freedoms.prescribe(Arc::make_mut(&mut gap));
        }
        Ok(gap)
    }

    /// Solves the elastic problem from a given pressure, or from the solutions on coarser grids, whose results it
    /// returns.
    fn iterate(
        &self,
        problem: &Problem,
        gap: &Array2<f64>,
        fields: &mut SolutionFields,
        tally: &mut Tally,
    ) -> Result<(Outcome, Vec<GridResult>)> {
        let levels = &self.plan.levels;
        let approach = self.motion.approach;
        let possible = approach.map_or(Ok(()), |approach| self.plan.datum.check_gap(approach, gap));
        if let Err(full_contact) = possible {
            let hardness = self.options.hardness.as_ref().map_or(0.0, Hardness::largest);
            if hardness <= 0.0 {
                return Err(full_contact);
            }
            // There is no elastic solution; that with the hardness is sought from where all cells yield.
            fields.pressure.fill(2.0 * hardness);
            let (solver, termination) = (Solver::Preconditioned, Termination::IterationLimit);
            return Ok((Outcome { solver, termination, lambda: [0.0; 3] }, Vec::new()));
        }
        if let Some(initial) = initial_pressure(problem, self.options.initial.as_deref())? {
            let outcome = self.solve_from(initial, problem, gap, fields, tally)?;
            return Ok((outcome, Vec::new()));
        }
        if self.cascades()
            && let Some(mut cascade) =
                Cascade::nested(problem, gap, self.shape, levels, self.criteria, tally)
        {
            let results = std::mem::take(&mut cascade.results);
            let outcome = cascade.solve_in_window(problem, fields, self.criteria, tally)?;
            return Ok((outcome, results));
        }
        fields.pressure = uniform_pressure(problem)?;
        let outcome = polonsky_keer::solve(problem, fields, self.criteria, tally)?;
        Ok((outcome, Vec::new()))
    }

    /// Solves the problem from a balanced pressure.
    fn solve_from(
        &self,
        start: Array2<f64>,
        problem: &Problem,
        gap: &Array2<f64>,
        fields: &mut SolutionFields,
        tally: &mut Tally,
    ) -> Result<Outcome> {
        if self.cascades() {
            let cascade = Cascade::from(&start, problem, gap, &self.plan.levels[0]);
            return cascade.solve_in_window(problem, fields, self.criteria, tally);
        }
        fields.pressure = start;
        polonsky_keer::solve(problem, fields, self.criteria, tally)
    }

    /// The solution. All that it reports is computed from the pressure, with the `quality` that was found afresh.
    fn report(
        &self,
        (gap, indentation, mut fields): (Arc<Array2<f64>>, Option<Array2<f64>>, SolutionFields),
        (outcome, quality): (Outcome, Quality),
        results: Vec<GridResult>,
        mut report: Report,
    ) -> Result<Solution> {
        if quality.overflows() {
            return Err(Error::Overflow);
        }
        let (plan, grid) = (self.plan, &self.plan.grid);
        let undeformed = match &indentation {
            Some(deeper) => Arc::new(&*gap + deeper),
            None => gap,
        };
        let (approach, tilt) = self.freedoms.rigid_motion(fields.multipliers.lambda());
        let (pressure, window) = (&fields.pressure, &fields.window);
        let (resultants, warnings) = self.rows().both(
            || Resultants::of(pressure, window, grid),
            || warnings(pressure, window, &undeformed, grid, self.shape, &plan.ends),
        );
        // One rule decides, on the numbers that are reported.
        report.termination = match outcome.termination {
            Termination::Stopped => Termination::Stopped,
            _ if quality.meets(self.criteria.tolerance) => Termination::Converged,
            _ => Termination::IterationLimit,
        };
        report.solver = Some(outcome.solver);
        report.balance = resultants.balance(grid, self.motion);
        report.warnings = warnings;
        // Where cells yield, the coarser grids of the elastic contact say nothing.
        if report.converged() && indentation.is_none() {
            let finest = GridResult {
                peak_pressure: resultants.peak,
                approach,
                load: resultants.force,
                tilt,
                ..GridResult::of_pressure(pressure, grid)
            };
            let loaded = self.freedoms.loaded;
            let fields = ([pressure, &fields.displacement], window);
            report.discretisation = plan.discretisation(
                self.shape,
                (results, finest),
                fields,
                loaded,
                &report.warnings,
            );
        }
        let raised = plan.datum.raise() * resultants.force;
        if raised != 0.0 {
            fields.lower(raised);
        }
        Ok(Solution {
            pressure: fields.pressure,
            displacement: fields.displacement,
            approach: approach - raised,
            tilt,
            hardness: self.options.hardness.clone(),
            indentation,
            compliance: None,
            coefficients: plan.setup.coefficients.clone(),
            report,
            operator: Some(Arc::clone(&plan.operator)),
            gap: Gap::Computed {
                undeformed,
                freedoms: Box::new(self.freedoms.clone()),
                multipliers: fields.multipliers,
                deflection: None,
            },
        })
    }
}

impl Contact {
    /// Discretisation errors, from results on the coarser grids and on the finest one.
    fn discretisation(
        &self,
        shape: &dyn Surface,
        (mut results, finest): (Vec<GridResult>, GridResult),
        (fields, window): ([&Array2<f64>; 2], &Window),
        loaded: [bool; 3],
        warnings: &[Warning],
    ) -> Option<Discretisation> {
        results.push(finest);
        let (pressure, unresolved) = (fields[0], &self.unresolved);
        let singular = warnings.iter().any(Warning::is_singular);
        let changes = estimate(&results, singular, unresolved.stands_at_rim(pressure))?;
        let unseen = unresolved.errors(fields, window, &self.grid, loaded, singular);
        let corners = corner_error(pressure, &self.grid, shape, unresolved.short_waves);
        // Changes between grids show where the rim lies as well as what is known of one grid does.
        let Discretisation { contact_area, contact_extent, tilt, .. } = changes.or_larger(unseen);
        let all = changes.plus(unseen).at_least(corners);
        Some(Discretisation { contact_area, contact_extent, tilt, ..all })
    }

    /// Discretisation errors of a `solution`, from those on cells of twice, of four times … the length.
    ///
    /// # Errors
    /// Motions that the grid does not permit.
    pub(crate) fn errors_from(
        &self,
        solution: &Solution,
        coarser: &[&Solution],
        shape: &dyn Surface,
    ) -> Result<Option<Discretisation>> {
        let results = coarser.iter().rev().map(|coarse| GridResult::from(*coarse)).collect();
        let Some(window) = solution.cells_in_contact() else { return Ok(None) };
        let fields = ([&solution.pressure, &solution.total_displacement()], &window);
        let loaded = Freedoms::new(&solution.report.motion, &self.grid)?.loaded;
        let results = (results, GridResult::from(solution));
        let errors = self.discretisation(shape, results, fields, loaded, &solution.report.warnings);
        // A peak that is the hardness of all cells has no error.
        let limit = match &solution.hardness {
            Some(Hardness::Uniform(limit)) => *limit,
            _ => f64::INFINITY,
        };
        let is_known = solution.peak_pressure() >= limit;
        Ok(errors.map(|errors| match is_known {
            true => Discretisation { peak_pressure: Some(0.0), ..errors },
            false => errors,
        }))
    }

    /// States the errors of a `solution` that nested grids do not tell, from solutions on cells of twice and of four times
    /// the length: on small grids, and where surfaces yield. From a given pressure none is sought.
    pub(super) fn state_errors(
        &self,
        solution: &mut Solution,
        shape: &dyn Surface,
        options: &Options,
        progress: &mut Progress,
    ) {
        let is_told = solution.report.discretisation.is_some() || !solution.report.converged();
        if is_told || options.initial.is_some() || options.algorithm != Algorithm::Cascade {
            return;
        }
        let (motion, spent) = (solution.report.motion, solution.report.seconds);
        let begin = std::time::Instant::now();
        let mut goes_on = |report: &Report| {
            let seconds = spent + begin.elapsed().as_secs_f64();
            progress(&Report { seconds, ..report.clone() })
        };
        let progress: &mut Progress = &mut goes_on;
        let solved = |plan: &Self, options: &Options, progress: &mut Progress| {
            let (shape_of_grid, periodic) = (plan.grid.shape(), plan.grid.is_periodic());
            let halved = [!plan.grid.is_line(), true];
            let divides =
                |k: usize| shape_of_grid[k] >= FEW && !(periodic[k] && shape_of_grid[k] % 2 == 1);
            if !(0..2).all(|axis| !halved[axis] || divides(axis)) {
                return None;
            }
            let coarse = plan.halved().ok()?;
            let options = coarse_options(options, halved);
            let of = coarse.solve_alone(shape, &motion, &options, progress).ok()?;
            of.report.converged().then_some((coarse, options, of))
        };
        let Some((half, of_half, first)) = solved(self, options, progress) else { return };
        let second = solved(&half, &of_half, progress).map(|(_, _, second)| second);
        let coarser: Vec<&Solution> =
            [Some(&first), second.as_ref()].into_iter().flatten().collect();
        for coarse in &coarser {
            solution.report.convolutions += coarse.report.convolutions
                * coarse.pressure.len() as f64
                / solution.pressure.len() as f64;
            solution.report.seconds += coarse.report.seconds;
        }
        solution.report.discretisation = self.errors_from(solution, &coarser, shape).ok().flatten();
    }
}

/// Cells along a side below which no coarser grid tells the error.
const FEW: usize = 8;

/// Options of the same solve on a grid whose cells are twice as long in the directions of `halved`.
fn coarse_options(options: &Options, halved: [bool; 2]) -> Options {
    let means = |cells: &Array2<f64>| coarse_means(cells, halved);
    Options {
        tolerance: options.tolerance.max(COARSE_TOLERANCE),
        hardness: options.hardness.as_ref().map(|hardness| match hardness {
            Hardness::Cells(cells) => Hardness::Cells(means(cells)),
            Hardness::Uniform(_) => hardness.clone(),
        }),
        compliance: options.compliance.as_ref().map(|compliance| match compliance {
            Compliance::Cells(cells) => Compliance::Cells(means(cells)),
            Compliance::Uniform(_) => compliance.clone(),
        }),
        indentation: options.indentation.as_ref().map(means),
        ..options.clone()
    }
}

/// Share of what the cells carry that is rounding of their sum.
const BEARING_ROUNDING: f64 = 1e-12;

/// An error where the load, or a moment along one axis, is what the cells that can touch carry or above. At that limit
/// all of them yield, and the rigid motion is not determined.
///
/// # Errors
/// [`Error::Overload`], [`Error::Overturned`].
fn check_load(problem: &Problem, hardness: &Hardness) -> Result<()> {
    let touching = (0..problem.gap.len()).filter(|&k| problem.gap[k].is_finite());
    let capacity: f64 = touching.map(|k| hardness.at(k)).sum();
    let freedoms = problem.freedoms;
    if freedoms.loaded[0] && freedoms.target[0] >= (1.0 - BEARING_ROUNDING) * capacity {
        return Err(Error::Overload {
            load: freedoms.target[0] * freedoms.cell_area,
            bears: capacity * freedoms.cell_area,
        });
    }
    for axis in (0..2).filter(|axis| freedoms.loaded[axis + 1]) {
        let (moment, at) = (freedoms.target[axis + 1], &freedoms.columns[axis]);
        let mut lines = vec![0.0; at.len()];
        let columns = freedoms.columns[1].len();
        for cell in (0..problem.gap.len()).filter(|&cell| problem.gap[cell].is_finite()) {
            lines[[cell / columns, cell % columns][axis]] += hardness.at(cell);
        }
        let load = freedoms.loaded[0].then_some(freedoms.target[0]);
        let lines: Vec<[f64; 2]> = at.iter().copied().zip(lines).map(Into::into).collect();
        let [low, high] = [-1.0, 1.0].map(|side| side * farthest(&lines, side, load));
        let rounding = BEARING_ROUNDING * (high - low);
        if moment <= low + rounding || moment >= high - rounding {
            return Err(Error::Overturned {
                axis: ["x", "y"][axis],
                moment: freedoms.moment(axis, moment),
                range: [low, high].map(|bound| freedoms.moment(axis, bound)),
            });
        }
    }
    Ok(())
}

/// The largest moment Σ p (side · x) of a load that lines of cells carry up to their limit, each given as its
/// coordinate x and its limit; of any load where none is given.
fn farthest(lines: &[[f64; 2]], side: f64, load: Option<f64>) -> f64 {
    let mut rest = load.unwrap_or(f64::INFINITY);
    let mut lines: Vec<[f64; 2]> = lines.iter().map(|[x, most]| [side * x, *most]).collect();
    lines.sort_by(|a, b| b[0].total_cmp(&a[0]));
    let mut moment = 0.0;
    for [x, most] in lines {
        let force = most.min(rest);
        // A load that is not given stays on its side of the origin.
        if force > 0.0 && (load.is_some() || x > 0.0) {
            moment += force * x;
            rest -= force;
        }
    }
    moment
}
