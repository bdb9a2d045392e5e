//! Sliding and rolling: pressure and tractions in turn.
//!
//! Where the bodies differ, tractions lift the surfaces and pressure moves them along each other. Pressure and tractions
//! are found in turn, each for the other (Panagiotopoulos, Ing.-Arch. 44 (1975) 421, doi:10.1007/BF00534623), with pressures
//! that are mixed from those of the sweeps before.

use std::borrow::Cow;
use std::cell::RefCell;
use std::ops::ControlFlow;
use std::sync::Arc;

use ndarray::{Array2, Zip};

use super::halved::{LEAST, coarse_friction, coarse_state, discretisation, refined};
use super::newton::{Effort, Misfit, small_system};
use super::solution::{FrictionReport, FrictionSolution, TangentialMotion};
use super::step::{Freedom, Friction, FrictionOptions, Move, Rolling, Step};
use super::tangential_problem::{
    Before, FrictionFields, PressedCells, SolvedTractions, TangentialProblem, bounds, zeros,
};
use crate::compliance::traction::Tangential;
use crate::contact::{
    Contact, Motion, Options, Report, Solution, Termination, Unestimated, Warning,
};
use crate::error::{Error, Result, fraction, require};
use crate::model::surface::{OffsetShape, Surface};
use crate::numerics::clock::Stopwatch;
use crate::numerics::parallel::dot;

/// Callback that gets the report so far, and breaks to stop.
pub type FrictionProgress<'a> = dyn FnMut(&FrictionReport) -> ControlFlow<()> + Send + 'a;

/// Sweeps between pressure and tractions.
const MOST_SWEEPS: usize = 200;

/// Change of the pressure to which tractions are found while it changes.
const LOOSE: f64 = 0.01;

/// Tolerance of a start.
const START: f64 = 1e-3;

/// Least tolerance of a solution on half the cells, above rounding: it is a start, and an error has few digits.
const REACHABLE: f64 = 1e-12;

/// Tolerance on cells of twice the length, over that of the cells: their discretisation differs by far more.
const LOOSER: f64 = 10.0;

/// The operator of the whole grid rounds otherwise than that of the window.
const ROUNDING: f64 = 1e-13;

/// The state at which a move begins.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Last<'a> {
    /// The solution that is left behind.
    pub solution: &'a FrictionSolution,
    /// Whether it was made with the same shape, bodies and tolerance, so that its pressure is known to hold for the same load.
    pub is_own: bool,
}

/// The course of a move, of which its caller is told.
struct FrictionCourse<'a, 'b> {
    start: Stopwatch,
    report: FrictionReport,
    stopped: bool,
    progress: &'a mut FrictionProgress<'b>,
}

impl FrictionCourse<'_, '_> {
    fn tell(&mut self) -> ControlFlow<()> {
        if self.stopped {
            return ControlFlow::Break(());
        }
        self.report.seconds = self.start.elapsed().as_secs_f64();
        let answer = (self.progress)(&self.report);
        self.stopped |= answer.is_break();
        answer
    }
}

/// One shape on one contact.
pub(super) struct Session<'a> {
    contact: &'a Contact,
    shape: &'a dyn Surface,
    tangential: Arc<Tangential>,
    options: FrictionOptions,
    coupled: bool,
    /// Whether solutions are compared with those of alternatives of the shape.
    compares: bool,
    /// Whether solutions that go on from others are to state their errors, for which they are made on coarser cells, too.
    states_errors: bool,
    /// Pressures of [`Session::sticking`] in a cycle.
    sticking: RefCell<Vec<(Motion, Array2<f64>)>>,
}

/// The solution on cells of twice the length, or why there is none.
type Halved = std::result::Result<Arc<FrictionSolution>, Unestimated>;

impl<'a> Session<'a> {
    pub(super) fn new(
        contact: &'a Contact,
        shape: &'a dyn Surface,
        options: FrictionOptions,
    ) -> Result<Self> {
        fraction("tolerance", options.tolerance)?;
        let order = options.order;
        require("order", order as f64, (1..=2).contains(&order), "1 or 2")?;
        let tangential = contact.tangential()?;
        Ok(Self {
            contact,
            shape,
            coupled: options.coupling && tangential.is_coupled(),
            tangential,
            options,
            compares: true,
            states_errors: true,
            sticking: RefCell::default(),
        })
    }

    /// This session for solutions whose errors nobody asks for.
    pub(super) fn without_errors(self) -> Self {
        Self { compares: false, states_errors: false, ..self }
    }

    /// The next move after `last`, which steady rolling does not depend on.
    pub(super) fn solve(
        &self,
        next: Move,
        last: Option<Last>,
        progress: &mut FrictionProgress,
    ) -> Result<FrictionSolution> {
        let last = last.filter(|_| !matches!(next, Move::RollSteadily(_)));
        let solution = last.map(|last| last.solution);
        let (motion, friction, problem) = match next {
            Move::Slide(step) => self.slide(step, solution)?,
            Move::RollSteadily(rolling) | Move::RollOneCell(rolling) => {
                let is_steady = matches!(next, Move::RollSteadily(_));
                let problem = self.roll(rolling, is_steady, solution)?;
                (rolling.motion, &rolling.friction, problem)
            }
        };
        let earlier = solution.map(|last| &last.normal);
        // The pressure of bodies whose tractions do not act on it is known for the same motion.
        let known = earlier.filter(|normal| {
            last.is_some_and(|last| last.is_own)
                && !self.coupled
                && normal.report.converged()
                && normal.report.motion == motion
        });
        let mut course = FrictionCourse {
            start: Stopwatch::start(),
            report: FrictionReport {
                coupled: self.coupled,
                order: if problem.is_steady { self.options.order } else { 0 },
                tolerance: self.options.tolerance,
                ..FrictionReport::default()
            },
            stopped: false,
            progress,
        };
        let is_halved = self.states_errors || last.is_none();
        let half = if is_halved { self.halved(next, last, &mut course) } else { None };
        // A history goes on from a copy to the bit, and copies do not have the cells of twice the length.
        let start = half.as_ref().and_then(|half| half.as_deref().ok()).filter(|_| last.is_none());
        let pressures = [earlier, known];
        let (normal, solved) =
            self.settle(&problem, &motion, friction, pressures, start, &mut course)?;
        let mut solution = self.finish(&problem, friction, (normal, solved), course)?;
        if let Some(half) = half.filter(|_| self.states_errors && solution.report.converged()) {
            // A pressure on which tractions act is found from one before, without nested grids.
            if let (Ok(half), None) = (&half, solution.normal.report.discretisation) {
                solution.normal.report.discretisation =
                    self.contact.errors_from(&solution.normal, &[&half.normal], self.shape)?;
            }
            let errors = half.and_then(|half| {
                let freedoms = &problem.increments;
                let errors = discretisation(&solution, &half, freedoms, last.map(|l| l.solution))?;
                solution.half = Some(half);
                Ok(errors)
            });
            match errors {
                Ok(errors) => solution.report.discretisation = Some(errors),
                Err(reason) => {
                    solution.normal.report.warnings.push(Warning::Unestimated { reason });
                }
            }
        }
        Ok(solution)
    }

    /// Motion, friction and problem of a step of sliding.
    fn slide<'s>(
        &self,
        step: &'s Step,
        last: Option<&'s FrictionSolution>,
    ) -> Result<(Motion, &'s Friction, TangentialProblem<'s>)> {
        let grid = self.contact.grid();
        let before = last.map(|last| last.normal.report.motion);
        let motion = match (step.motion, before) {
            (Some(motion), Some(before)) => Some(motion.after(&before)),
            (motion, before) => motion.or(before),
        };
        let motion =
            motion.ok_or(Error::Inconsistent("the first step must have a load or an approach"))?;
        let friction = step.friction.as_ref();
        let friction = friction.or_else(|| last.map(|last| &last.friction));
        let friction = friction
            .ok_or(Error::Inconsistent("the first step must have a coefficient of friction"))?;
        friction.check(grid)?;
        let freedoms = step.freedoms(grid)?;
        let before = self.before(last)?;
        let [x, y] = before.shift;
        let starts = [x, y, before.twist];
        let problem = TangentialProblem {
            rolling: None,
            is_steady: false,
            is_second_order: false,
            increments: [0, 1, 2].map(|k| match freedoms[k] {
                Freedom::Prescribed(value) => Freedom::Prescribed(value - starts[k]),
                other => other,
            }),
            before,
        };
        Ok((motion, friction, problem))
    }

    /// The state that a solution leaves, or that of bodies that have not touched, with the data of the operator.
    ///
    /// # Errors
    /// Where the solution is one on another grid, or of other bodies.
    fn before(&self, last: Option<&FrictionSolution>) -> Result<Before> {
        let contact = self.contact;
        let Some(last) = last else {
            return Ok(Before::nothing(contact.grid()));
        };
        contact.grid().check_initial(Some(last.grid()))?;
        last.normal.report.check_bodies(contact.body(), contact.setup().counterbody.as_ref())?;
        let (shift, twist) = match last.motion {
            TangentialMotion::Slide { shift, twist } => (shift, twist),
            TangentialMotion::Roll { .. } => ([0.0; 2], 0.0),
        };
        let raised = self.tangential.raised(last.force());
        Ok(Before {
            traction: last.traction.clone(),
            displacement: [0, 1].map(|axis| &last.displacement[axis] + raised[axis]),
            shift,
            twist,
        })
    }

    /// Takes back by how much the data of the operator raise displacements and shifts.
    ///
    /// # Errors
    /// Where a shift that is given, or stays where it was, would change by that: the force that it needs is not known.
    fn lower(&self, problem: &TangentialProblem, fields: &mut FrictionFields) -> Result<()> {
        let area = self.contact.grid().cell_area();
        let force = |q: &[Array2<f64>; 2]| q.each_ref().map(|q| q.sum() * area);
        let raised = self.tangential.raised(force(&fields.traction));
        let before = self.tangential.raised(force(&problem.before.traction));
        let motion = if problem.slides() { "shift" } else { "creepage" };
        for axis in 0..2 {
            let largest = fields.displacement[axis].fold(0.0_f64, |most, u| most.max(u.abs()));
            let change = raised[axis] - before[axis];
            let is_changed = change.abs() > self.options.tolerance * largest;
            if is_changed && !problem.is_steady && !problem.is_loaded(axis) {
                self.tangential.check_prescribed(motion, axis)?;
            }
            fields.displacement[axis] -= raised[axis];
            if let TangentialMotion::Slide { shift, .. } = &mut fields.motion {
                shift[axis] -= change;
            }
        }
        Ok(())
    }

    /// The problem of rolling, steady or by one cell after `last`.
    fn roll<'r>(
        &self,
        rolling: &'r Rolling,
        is_steady: bool,
        last: Option<&FrictionSolution>,
    ) -> Result<TangentialProblem<'r>> {
        let grid = self.contact.grid();
        rolling.friction.check(grid)?;
        let [along, across] = rolling.freedoms(grid)?;
        let d = grid.spacing()[rolling.direction.axis()];
        let over_a_cell = |freedom: Freedom| match freedom {
            Freedom::Prescribed(value) => Freedom::Prescribed(value * d),
            other => other,
        };
        Ok(TangentialProblem {
            rolling: Some(rolling),
            is_steady,
            is_second_order: self.options.order == 2,
            increments: [along, across, Freedom::Prescribed(rolling.spin)].map(over_a_cell),
            before: self.before(last)?,
        })
    }

    /// Pressure and tractions in turn until neither changes the other, from the pressure of the `earlier` solution, or with
    /// the `known` one; where nothing came before, from the `start` on half the cells.
    fn settle(
        &self,
        problem: &TangentialProblem,
        motion: &Motion,
        friction: &Friction,
        [earlier, known]: [Option<&Solution>; 2],
        start: Option<&FrictionSolution>,
        course: &mut FrictionCourse,
    ) -> Result<(Solution, Option<SolvedTractions>)> {
        let (grid, tolerance) = (self.contact.grid(), self.options.tolerance);
        let keeps_shares = problem.slides() || problem.is_second_order;
        let mut traction = problem.before.traction.clone();
        let mut last_bound: Option<Array2<f64>> = None;
        let mut pressure: Option<Array2<f64>> = earlier.map(|normal| normal.pressure.clone());
        let mut mixing = Mixing::default();
        let (mut normal, solved) = loop {
            let normal = match known {
                Some(known) => known.clone(),
                None => self.press(motion, &traction, pressure.as_ref(), course)?,
            };
            course.report.sweeps += 1;
            let is_first = course.report.sweeps == 1;
            let change = change(&normal, pressure.as_ref());
            course.report.pressure_change = if self.coupled && !is_first { change } else { 0.0 };
            if course.stopped {
                break (normal, None);
            }
            let is_settled = !self.coupled || !is_first && change <= tolerance;
            let acting = match pressure.take().filter(|_| !is_settled && !is_first) {
                Some(before) => mixing.next(before, &normal.pressure),
                None => normal.pressure.clone(),
            };
            let bound = bounds(&acting, friction)?;
            if let Some(last) = last_bound.filter(|_| keeps_shares) {
                for q in &mut traction {
                    let share = |q: f64, bound: f64, last: f64| {
                        if last > 0.0 { q * (bound / last) } else { q }
                    };
                    Zip::from(q).and(&bound).and(&last).for_each(|q, b, l| *q = share(*q, *b, *l));
                }
            }
            problem.check(grid, &bound, tolerance)?;
            problem.check_memory(grid, &bound)?;
            // While the pressure still changes, tractions need not be exact.
            let goal = if is_settled { tolerance } else { tolerance.max(LOOSE * change.min(1.0)) };
            let [x, y, _] = problem.increments.map(Freedom::force);
            let starts = match start {
                Some(half) if is_first => vec![refined(half, grid, &bound)],
                _ if is_first && x.hypot(y) > 0.0 && problem.slides() => {
                    self.starts(motion, &normal, [x, y], friction, &traction)?
                }
                _ => vec![traction.clone()],
            };
            let gap = normal.gap();
            let pressed = PressedCells {
                grid,
                bound: &bound,
                spreading: &self.spreading(&acting),
                pressure: &normal.pressure,
                gap: &gap,
            };
            let solved = self.tractions(problem, pressed, &starts, goal, course);
            if let Some(solved) = &solved {
                traction = solved.tractions(grid.shape());
            }
            let report = &course.report;
            let is_spent = report.convolutions >= self.options.max_convolutions
                || report.sweeps >= MOST_SWEEPS;
            if is_settled || course.stopped || is_spent || !normal.report.converged() {
                break (normal, solved);
            }
            pressure = Some(acting);
            last_bound = Some(bound);
        };
        if self.compares && known.is_none() && !course.stopped {
            let (shape, mut watch) = (self.lifted(&traction), |_: &Report| course.tell());
            self.contact.compare(&mut normal, &shape, motion, &self.pressing(), &mut watch);
        }
        Ok((normal, solved))
    }

    /// Tractions for a pressure, with what is left of the convolutions.
    fn tractions(
        &self,
        problem: &TangentialProblem,
        pressed: PressedCells,
        starts: &[[Array2<f64>; 2]],
        tolerance: f64,
        course: &mut FrictionCourse,
    ) -> Option<SolvedTractions> {
        let counted = course.report.convolutions;
        let effort =
            Effort { tolerance, most: self.options.max_convolutions.saturating_sub(counted) };
        let mut watch = |convolutions: usize, misfit: Misfit| {
            course.report.convolutions = counted + convolutions;
            course.report.violation = misfit.violation;
            course.report.imbalance = misfit.imbalance;
            course.tell()
        };
        let solved = problem.solve(&self.tangential, pressed, starts, effort, &mut watch)?;
        course.report.convolutions = counted + solved.solution.convolutions;
        course.report.imbalance = solved.solution.misfit.imbalance;
        Some(solved)
    }

    /// The solution with its errors on the whole grid.
    fn finish(
        &self,
        problem: &TangentialProblem,
        friction: &Friction,
        (mut normal, solved): (Solution, Option<SolvedTractions>),
        course: FrictionCourse,
    ) -> Result<FrictionSolution> {
        let (grid, tolerance) = (self.contact.grid(), self.options.tolerance);
        let pressed = PressedCells {
            grid,
            bound: &bounds(&normal.pressure, friction)?,
            spreading: &self.spreading(&normal.pressure),
            pressure: &normal.pressure,
            gap: &normal.gap(),
        };
        let mut fields = problem.fields(&self.tangential, pressed, solved.as_ref());
        if !fields.are_finite() {
            return Err(Error::Overflow);
        }
        if course.stopped {
            fields.restore(problem);
        }
        self.lower(problem, &mut fields)?;
        let is_good = fields.violation <= tolerance + ROUNDING
            && course.report.imbalance <= tolerance + ROUNDING
            && course.report.pressure_change <= tolerance
            && normal.report.converged();
        let coupling_energy = match self.coupled {
            true => 0.5 * grid.cell_area() * (&normal.pressure * self.lift(&fields.traction)).sum(),
            false => 0.0,
        };
        let report = FrictionReport {
            violation: fields.violation,
            excess: fields.excess,
            full_slip: fields.full_slip,
            coupling_energy,
            termination: match (course.stopped, is_good) {
                (true, _) => Termination::Stopped,
                (_, true) => Termination::Converged,
                _ => Termination::IterationLimit,
            },
            seconds: course.start.elapsed().as_secs_f64(),
            ..course.report
        };
        let warning = fields.warning(problem, grid, &normal.pressure);
        let warnings = &mut normal.report.warnings;
        warnings.retain(|warning| !matches!(warning, Warning::LargeMotion { .. }));
        warnings.extend(warning);
        Ok(FrictionSolution {
            normal,
            friction: friction.clone(),
            traction: fields.traction,
            displacement: fields.displacement,
            slip: fields.slip,
            motion: fields.motion,
            report,
            half: None,
        })
    }

    /// The move `next` on cells of twice the length, which in turn compares itself with cells of four times the length, and
    /// so on. A step goes on from where `last` was on those cells. `None` for rolling cell by cell, and to first order.
    fn halved(
        &self,
        next: Move,
        last: Option<Last>,
        course: &mut FrictionCourse,
    ) -> Option<Halved> {
        match next {
            Move::Slide(_) => {}
            Move::RollSteadily(_) if self.options.order == 2 => {}
            _ => return None,
        }
        let grid = self.contact.grid();
        let [rows, columns] = grid.shape();
        if columns < 2 * LEAST || !grid.is_line() && rows < 2 * LEAST {
            return Some(Err(Unestimated::Coarse));
        }
        if self.contact.setup().coefficients.is_some() {
            return Some(Err(Unestimated::Coefficients));
        }
        let mut solve = || -> Result<FrictionSolution> {
            let contact = self.contact.halved()?;
            let tolerance = (LOOSER * self.options.tolerance)
                .min(START.max(self.options.tolerance))
                .max(REACHABLE);
            let options = FrictionOptions { tolerance, ..self.options };
            let states_errors = self.states_errors;
            let session = Session::new(&contact, self.shape, options)?;
            let session = Session { compares: false, states_errors, ..session };
            let coarse = |friction: &Friction| coarse_friction(friction, grid, contact.grid());
            let mut progress = |_: &FrictionReport| course.tell();
            let last_half = match last.map(|last| last.solution) {
                None => None,
                Some(FrictionSolution { half: Some(half), .. }) => Some(Arc::clone(half)),
                Some(last) => Some(Arc::new(coarse_state(last, contact.grid())?)),
            };
            let is_own = last.is_some_and(|last| last.is_own && last.solution.half.is_some());
            let last = last_half.as_deref().map(|solution| Last { solution, is_own });
            match next {
                Move::Slide(step) => {
                    let friction = step.friction.as_ref().map(coarse);
                    let step = Step { friction, ..step.clone() };
                    session.solve(Move::Slide(&step), last, &mut progress)
                }
                Move::RollSteadily(rolling) | Move::RollOneCell(rolling) => {
                    let friction = coarse(&rolling.friction);
                    let rolling = Rolling { friction, ..rolling.clone() };
                    session.solve(Move::RollSteadily(&rolling), None, &mut progress)
                }
            }
        };
        Some(solve().map(Arc::new).map_err(|_| Unestimated::Unsolved))
    }

    /// The pressure that displaces the surfaces along each other: all of it, or none without coupling.
    fn spreading<'p>(&self, pressure: &'p Array2<f64>) -> Cow<'p, Array2<f64>> {
        match self.coupled {
            true => Cow::Borrowed(pressure),
            false => Cow::Owned(Array2::zeros(pressure.dim())),
        }
    }

    /// The pressure for given tractions.
    fn press(
        &self,
        motion: &Motion,
        traction: &[Array2<f64>; 2],
        pressure: Option<&Array2<f64>>,
        course: &mut FrictionCourse,
    ) -> Result<Solution> {
        let initial = pressure.filter(|p| self.coupled && p.iter().any(|p| *p > 0.0));
        let options = Options { initial: initial.cloned(), ..self.pressing() };
        let mut watch = |_: &Report| course.tell();
        self.contact.solve_alone(&self.lifted(traction), motion, &options, &mut watch)
    }

    /// Options of solves for the pressure.
    fn pressing(&self) -> Options {
        Options { tolerance: self.options.tolerance, ..Options::default() }
    }

    /// The shape, lifted by tractions where they act on the pressure.
    fn lifted(&self, traction: &[Array2<f64>; 2]) -> Box<dyn Surface + 'a> {
        if !self.coupled {
            return Box::new(self.shape);
        }
        Box::new(OffsetShape::new(self.shape, self.contact.grid(), self.lift(traction)))
    }

    /// The normal displacement of both bodies together that tractions make.
    fn lift(&self, traction: &[Array2<f64>; 2]) -> Array2<f64> {
        let shape = self.contact.grid().shape();
        let q: Vec<f64> = traction.iter().flatten().copied().collect();
        let lift = self.tangential.window(shape).lift(&q);
        Array2::from_shape_fn(shape, |(i, j)| lift[i * shape[1] + j])
    }

    /// Tractions to start from: those before; for the whole force by superposition, as if there had been no history;
    /// and those before with the change of the force by superposition, as after a reversal.
    fn starts(
        &self,
        motion: &Motion,
        normal: &Solution,
        forces: [f64; 2],
        friction: &Friction,
        traction: &[Array2<f64>; 2],
    ) -> Result<Vec<[Array2<f64>; 2]>> {
        let area = normal.grid().cell_area();
        let capacity = friction.times(&normal.pressure).sum() * area;
        let before = traction.each_ref().map(|q| q.sum() * area);
        let superposed = |forces| self.superposed(motion, normal, forces, capacity, friction);
        let whole = superposed(forces)?;
        if before[0].hypot(before[1]) <= 0.0 {
            return Ok(vec![whole]);
        }
        let mut starts = vec![traction.clone(), whole];
        let half = [0, 1].map(|axis| 0.5 * (forces[axis] - before[axis]));
        if half[0].hypot(half[1]) < capacity {
            let mut changed = superposed(half)?;
            for (changed, before) in changed.iter_mut().zip(traction) {
                changed.zip_mut_with(before, |q, before| *q = 2.0 * *q + before);
            }
            starts.push(changed);
        }
        Ok(starts)
    }

    /// Tractions after Cattaneo, Mindlin, Jäger and Ciavarella: μ times the pressure less that of the load less
    /// |Q|/μ. They are exact for equal bodies with ν = 0, and a good start elsewhere. Ciavarella, J. Appl. Mech. 65
    /// (1998) 998, doi:10.1115/1.2791936.
    fn superposed(
        &self,
        motion: &Motion,
        normal: &Solution,
        forces: [f64; 2],
        capacity: f64,
        friction: &Friction,
    ) -> Result<[Array2<f64>; 2]> {
        let force = forces[0].hypot(forces[1]);
        let mut tractions = zeros(normal.grid().shape());
        if force <= 0.0 {
            return Ok(tractions);
        }
        let less = Motion {
            load: Some(normal.load() * (1.0 - force / capacity)),
            approach: None,
            ..*motion
        };
        let sticking = self.sticking(less)?;
        let more = (&normal.pressure - &sticking).mapv(|p| p.max(0.0));
        let bound = friction.times(&more);
        for (traction, component) in tractions.iter_mut().zip(forces) {
            *traction = bound.mapv(|q| q * component / force);
        }
        Ok(tractions)
    }

    /// Pressure under the load that sticks, within the tolerance of a start. A cycle has the same loads again and again.
    fn sticking(&self, motion: Motion) -> Result<Array2<f64>> {
        let is_near = |known: &Motion| {
            let [load, other] = [motion, *known].map(|motion| motion.load.unwrap_or(0.0));
            (load - other).abs() <= START * load && known.with_load(load) == motion
        };
        if let Some((_, pressure)) = self.sticking.borrow().iter().find(|(known, _)| is_near(known))
        {
            return Ok(pressure.clone());
        }
        let options = Options { tolerance: START, ..Options::default() };
        let go_on = &mut |_: &Report| ControlFlow::Continue(());
        let solution = self.contact.solve_alone(self.shape, &motion, &options, go_on)?;
        if !self.states_errors {
            self.sticking.borrow_mut().push((motion, solution.pressure.clone()));
        }
        Ok(solution.pressure)
    }
}

/// Earlier changes of the pressure that are looked at. Of 1500 random contacts with coefficients of friction of up to 5, with
/// 0, 5, 20 and 30 of them 141, 31, 5 and 5 do not settle in 60 sweeps.
const DEPTH: usize = 20;

/// The pressure of the next sweep, from those of the last ones and what became of them: Anderson, J. ACM 12 (1965) 547,
/// doi:10.1145/321296.321305, as Walker & Ni, SIAM J. Numer. Anal. 49 (2011) 1715, eq. (2.1), doi:10.1137/10078356X, have
/// it. In turn alone, pressure and tractions do not settle where friction is large.
#[derive(Default)]
struct Mixing {
    /// A pressure that was found, and its change in the sweep.
    last: Option<[Vec<f64>; 2]>,
    /// Differences of both between sweeps.
    pressures: Vec<Vec<f64>>,
    changes: Vec<Vec<f64>>,
}

impl Mixing {
    /// The next pressure where tractions under the pressure `before` lead to `after`.
    fn next(&mut self, before: Array2<f64>, after: &Array2<f64>) -> Array2<f64> {
        let change: Vec<f64> = after.iter().zip(&before).map(|(after, p)| after - p).collect();
        let values: Vec<f64> = after.iter().copied().collect();
        if let Some([last_pressure, last_change]) = self.last.take() {
            let less = |a: &[f64], b: Vec<f64>| a.iter().zip(b).map(|(a, b)| a - b).collect();
            for (kept, difference) in [
                (&mut self.pressures, less(&values, last_pressure)),
                (&mut self.changes, less(&change, last_change)),
            ] {
                if kept.len() == DEPTH {
                    kept.remove(0);
                }
                kept.push(difference);
            }
        }
        let right: Vec<f64> = self.changes.iter().map(|column| dot(column, &change)).collect();
        let shares = small_system(&self.changes, &self.changes, &right);
        let mut next = values.clone();
        for (share, column) in shares.iter().zip(&self.pressures) {
            next.iter_mut().zip(column).for_each(|(p, column)| *p -= share * column);
        }
        self.last = Some([values, change]);
        let mut pressure = before;
        pressure.iter_mut().zip(next).for_each(|(p, next)| *p = next.max(0.0));
        pressure
    }
}

/// Largest change of the pressure over its peak; infinite where there was none before.
fn change(normal: &Solution, before: Option<&Array2<f64>>) -> f64 {
    let Some(before) = before else {
        return f64::INFINITY;
    };
    let pairs = normal.pressure.iter().zip(before);
    let moved = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    if moved > 0.0 { moved / normal.peak_pressure() } else { 0.0 }
}
