//! Sliding and rolling: pressure and tractions in turn.
//!
//! Where the bodies differ, tractions lift the surfaces and pressure moves them along each other. Pressure and tractions
//! are found in turn, each for the other (Panagiotopoulos, Ing.-Arch. 44 (1975) 421, doi:10.1007/BF00534623).

use std::borrow::Cow;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use ndarray::Array2;

use super::newton::{Effort, Quality};
use super::solution::{FrictionReport, FrictionSolution, TangentialMotion};
use super::step::{Freedom, Friction, FrictionOptions, Rolling, Step};
use super::task::{Before, Task, bounds, check_bound, check_forces};
use crate::compliance::traction::Tangential;
use crate::contact::{Contact, Motion, OVERFLOW, Options, Solution, Termination, Warning};
use crate::error::{Error, Result, require};
use crate::model::grid::Grid;
use crate::model::surface::{Lifted, Surface};

/// Callback that gets the number of the step and its report so far, and breaks to stop.
pub type FrictionProgress<'a> = dyn FnMut(usize, &FrictionReport) -> ControlFlow<()> + Send + 'a;

/// [`FrictionProgress`] of one step.
pub(super) type Watching<'a> = dyn FnMut(&FrictionReport) -> ControlFlow<()> + Send + 'a;

/// Sweeps between pressure and tractions.
const MOST_SWEEPS: usize = 60;

/// One shape on one contact.
pub(super) struct Session<'a> {
    pub(super) contact: &'a Contact,
    pub(super) shape: &'a dyn Surface,
    tangential: Arc<Tangential>,
    options: FrictionOptions,
    coupled: bool,
}

impl<'a> Session<'a> {
    pub(super) fn new(
        contact: &'a Contact,
        shape: &'a dyn Surface,
        options: FrictionOptions,
    ) -> Result<Self> {
        require(
            "tolerance",
            options.tolerance,
            options.tolerance > 0.0 && options.tolerance < 1.0,
            "above 0 and below 1",
        )?;
        let tangential = contact.tangential()?;
        Ok(Self {
            contact,
            shape,
            coupled: options.coupling && tangential.is_coupled(),
            tangential,
            options,
        })
    }

    /// One step of a history after `last`.
    pub(super) fn step(
        &self,
        step: &Step,
        last: Option<Last>,
        progress: &mut Watching,
    ) -> Result<FrictionSolution> {
        let grid = self.contact.grid();
        let known = last.and_then(|last| last.pressure(self));
        let last = last.map(|last| last.solution);
        let before = last.map(|last| last.normal.report.motion);
        let motion = match (step.motion, before) {
            (Some(motion), Some(before)) => Some(motion.after(&before)),
            (motion, before) => motion.or(before),
        };
        let motion = motion.ok_or(Error::Inconsistent(
            "the first step must have a load or an approach",
        ))?;
        let friction = step
            .friction
            .as_ref()
            .or_else(|| last.map(|last| &last.friction));
        let friction = friction.ok_or(Error::Inconsistent(
            "the first step must have a coefficient of friction",
        ))?;
        friction.check(grid)?;
        let freedoms = step.freedoms(grid)?;
        let before = match last {
            Some(last) => state(last, grid)?,
            None => Before::nothing(grid),
        };
        let task = Task::Slide {
            freedoms,
            before: &before,
        };
        let forces = freedoms.map(Freedom::force);
        let start = Start {
            normal: known.filter(|known| known.report.motion == motion),
            pressure: last.map(|last| &last.normal.pressure),
            traction: &before.traction,
        };
        self.settle(&task, &motion, friction, forces, start, progress)
    }

    /// Rolling: steady, or by one cell after `last`.
    pub(super) fn roll(
        &self,
        rolling: &Rolling,
        last: Option<Option<Last>>,
        progress: &mut Watching,
    ) -> Result<FrictionSolution> {
        let grid = self.contact.grid();
        rolling.friction.check(grid)?;
        let freedoms = rolling.freedoms(grid)?;
        let nothing = Before::nothing(grid);
        let before = match last {
            None => None,
            Some(Some(last)) => Some(state(last.solution, grid)?),
            Some(None) => Some(nothing.clone()),
        };
        let task = Task::Roll {
            rolling,
            freedoms,
            before: before.as_ref(),
        };
        let [along, across] = freedoms.map(Freedom::force);
        let last = last.flatten();
        let known = last.and_then(|last| last.pressure(self));
        let start = Start {
            normal: known.filter(|known| known.report.motion == rolling.motion),
            pressure: last.map(|last| &last.solution.normal.pressure),
            traction: before
                .as_ref()
                .map_or(&nothing.traction, |before| &before.traction),
        };
        self.settle(
            &task,
            &rolling.motion,
            &rolling.friction,
            [along, across, 0.0],
            start,
            progress,
        )
    }

    fn settle(
        &self,
        task: &Task,
        motion: &Motion,
        friction: &Friction,
        [x, y, torque]: [f64; 3],
        start: Start,
        progress: &mut Watching,
    ) -> Result<FrictionSolution> {
        let (begun, forces) = (Instant::now(), [x, y]);
        let (grid, tolerance) = (self.contact.grid(), self.options.tolerance);
        let mut report = FrictionReport {
            termination: Termination::Running,
            convolutions: 0,
            sweeps: 0,
            violation: 0.0,
            imbalance: 0.0,
            excess: 0.0,
            pressure_change: 0.0,
            coupled: self.coupled,
            full_slip: false,
            tolerance,
            seconds: 0.0,
        };
        let mut traction = start.traction.clone();
        let mut pressure: Option<Array2<f64>> = start.pressure.cloned();
        let mut stopped = false;
        let (mut normal, solved) = loop {
            let normal = match start.normal {
                Some(known) => known.clone(),
                None => {
                    let mut watch = |_: &crate::contact::Report| {
                        report.seconds = begun.elapsed().as_secs_f64();
                        let answer = progress(&report);
                        stopped |= answer.is_break();
                        answer
                    };
                    self.press(motion, &traction, pressure.as_ref(), &mut watch)?
                }
            };
            report.sweeps += 1;
            let change = pressure.as_ref().map_or(f64::INFINITY, |before| {
                let peak = normal.peak_pressure();
                let moved = normal
                    .pressure
                    .iter()
                    .zip(before)
                    .map(|(a, b)| (a - b).abs());
                let moved = moved.fold(0.0, f64::max);
                if moved > 0.0 { moved / peak } else { 0.0 }
            });
            report.pressure_change = if self.coupled && report.sweeps > 1 {
                change
            } else {
                0.0
            };
            let bound = bounds(&normal.pressure, friction);
            check_bound(&bound)?;
            let bears = bound.sum() * grid.cell_area();
            let force = forces[0].hypot(forces[1]);
            if stopped {
                break (normal, None);
            }
            check_forces(grid, &bound, forces, torque, tolerance)?;
            if task.leaves_the_grid(&bound) {
                return Err(Error::Inconsistent(
                    "in rolling, the contact must end a cell or more before the edge of the grid: give a wider grid",
                ));
            }
            // While the pressure still changes, tractions need not be exact.
            let settled = !self.coupled || report.sweeps > 1 && change <= tolerance;
            let goal = if settled {
                tolerance
            } else {
                tolerance.max(LOOSE * change.min(1.0))
            };
            let effort = Effort {
                tolerance: goal,
                most: self
                    .options
                    .max_convolutions
                    .saturating_sub(report.convolutions),
            };
            let mut starts = vec![traction.clone()];
            if report.sweeps == 1 && force > 0.0 && task.slides() {
                starts = self.starts(motion, &normal, (forces, bears), friction, &traction)?;
            }
            let counted = report.convolutions;
            let mut watch = |convolutions: usize, quality: Quality| {
                report.convolutions = counted + convolutions;
                (report.violation, report.imbalance) = (quality.violation, quality.imbalance);
                report.seconds = begun.elapsed().as_secs_f64();
                let answer = progress(&report);
                stopped |= answer.is_break();
                !stopped
            };
            let given = (grid, &bound, &*self.spreading(&normal.pressure));
            let solved = task.solve(&self.tangential, given, &starts, effort, &mut watch);
            if let Some(solved) = &solved {
                report.convolutions = counted + solved.outcome.convolutions;
                report.imbalance = solved.outcome.quality.imbalance;
                traction = solved.tractions(grid.shape());
            }
            let spent = report.convolutions >= self.options.max_convolutions;
            let failed = !normal.report.converged();
            if settled || stopped || spent || failed || report.sweeps >= MOST_SWEEPS {
                break (normal, solved);
            }
            pressure = Some(normal.pressure);
        };
        let bound = bounds(&normal.pressure, friction);
        let mut fields = task.fields(
            &self.tangential,
            (grid, &bound, &*self.spreading(&normal.pressure)),
            solved.as_ref(),
        );
        report.violation = fields.violation;
        report.excess = fields.excess;
        report.full_slip = fields.full_slip;
        if !fields.are_finite() {
            return Err(OVERFLOW);
        }
        if stopped {
            fields.restore(task);
        }
        // The operator of the whole grid rounds otherwise than that of the window.
        let rounding = 1e-13;
        let good = fields.violation <= tolerance + rounding
            && report.imbalance <= tolerance + rounding
            && report.pressure_change <= tolerance
            && normal.report.converged();
        report.termination = match (stopped, good) {
            (true, _) => Termination::Stopped,
            (_, true) => Termination::Converged,
            _ => Termination::IterationLimit,
        };
        report.seconds = begun.elapsed().as_secs_f64();
        let warnings = &mut normal.report.warnings;
        warnings.retain(|warning| !matches!(warning, Warning::LargeMotion { .. }));
        warnings.extend(fields.warning(task, grid, &normal.pressure));
        Ok(FrictionSolution {
            normal,
            friction: friction.clone(),
            traction: fields.traction,
            displacement: fields.displacement,
            slip: fields.slip,
            motion: fields.motion,
            report,
        })
    }

    /// The pressure that displaces the surfaces along each other: all of it, or none without coupling.
    fn spreading<'p>(&self, pressure: &'p Array2<f64>) -> Cow<'p, Array2<f64>> {
        if self.coupled {
            Cow::Borrowed(pressure)
        } else {
            Cow::Owned(Array2::zeros(pressure.dim()))
        }
    }

    /// The pressure for given tractions.
    fn press(
        &self,
        motion: &Motion,
        traction: &[Array2<f64>; 2],
        pressure: Option<&Array2<f64>>,
        watch: &mut (dyn FnMut(&crate::contact::Report) -> ControlFlow<()> + Send),
    ) -> Result<Solution> {
        let mut options = Options {
            tolerance: self.options.tolerance,
            ..Options::default()
        };
        let grid = self.contact.grid();
        if !self.coupled {
            return self
                .contact
                .solve_watched(self.shape, motion, &options, watch);
        }
        options.initial = pressure.filter(|p| p.iter().any(|p| *p > 0.0)).cloned();
        let q: Vec<f64> = traction.iter().flatten().copied().collect();
        let lift = self.tangential.window(grid.shape()).lift(&q);
        let lift = Array2::from_shape_fn(grid.shape(), |(i, j)| lift[i * grid.shape()[1] + j]);
        let lifted = Lifted::new(self.shape, grid, lift);
        self.contact.solve_watched(&lifted, motion, &options, watch)
    }
}

/// Change of the pressure to which tractions are found while it changes.
const LOOSE: f64 = 0.01;

/// The state that a step goes on from.
#[derive(Clone, Copy)]
pub(super) struct Last<'a> {
    pub(super) solution: &'a FrictionSolution,
    /// Whether it is a step of the same call, with the same shape and bodies, to the same tolerance.
    pub(super) own: bool,
}

impl<'a> Last<'a> {
    /// The pressure, where it is known for the same motion: that of bodies whose tractions do not act on it.
    fn pressure(self, session: &Session) -> Option<&'a Solution> {
        let normal = &self.solution.normal;
        (self.own && !session.coupled && normal.report.converged()).then_some(normal)
    }
}

/// What a step starts from.
#[derive(Clone, Copy)]
struct Start<'a> {
    /// The pressure's solution, where it is known.
    normal: Option<&'a Solution>,
    pressure: Option<&'a Array2<f64>>,
    traction: &'a [Array2<f64>; 2],
}

/// The state that a solution leaves.
///
/// # Errors
/// Where it is on another grid.
fn state(last: &FrictionSolution, grid: &Grid) -> Result<Before> {
    grid.check_initial(Some(last.grid()))?;
    let (shift, twist) = match last.motion {
        TangentialMotion::Slide { shift, twist } => (shift, twist),
        TangentialMotion::Roll { .. } => ([0.0; 2], 0.0),
    };
    Ok(Before {
        traction: last.traction.clone(),
        displacement: last.displacement.clone(),
        shift,
        twist,
    })
}

/// Tolerance of a start.
const START: f64 = 1e-3;

impl Session<'_> {
    /// Tractions to start from: those before; for the whole force by superposition, as if there had been no history;
    /// and those before with the change of the force by superposition, as after a reversal.
    pub(super) fn starts(
        &self,
        motion: &Motion,
        normal: &Solution,
        (forces, bears): ([f64; 2], f64),
        friction: &Friction,
        traction: &[Array2<f64>; 2],
    ) -> Result<Vec<[Array2<f64>; 2]>> {
        let area = normal.grid().cell_area();
        let before = traction.each_ref().map(|q| q.sum() * area);
        let whole = self.superposed(motion, normal, (forces, bears), friction)?;
        if before[0].hypot(before[1]) <= 0.0 {
            return Ok(vec![whole]);
        }
        let mut starts = vec![traction.clone(), whole];
        let half = [0, 1].map(|axis| 0.5 * (forces[axis] - before[axis]));
        if half[0].hypot(half[1]) < bears {
            let mut changed = self.superposed(motion, normal, (half, bears), friction)?;
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
        (forces, bears): ([f64; 2], f64),
        friction: &Friction,
    ) -> Result<[Array2<f64>; 2]> {
        let force = forces[0].hypot(forces[1]);
        let zero = || Array2::zeros(normal.grid().shape());
        if force <= 0.0 {
            return Ok([zero(), zero()]);
        }
        let less = Motion {
            load: Some(normal.load() * (1.0 - force / bears)),
            approach: None,
            ..*motion
        };
        let options = Options {
            tolerance: START,
            ..Options::default()
        };
        let sticking = self.contact.solve(self.shape, &less, &options)?;
        let mut tractions = [zero(), zero()];
        for ((i, j), p) in normal.pressure.indexed_iter() {
            let q = friction.at([i, j]) * (p - sticking.pressure[[i, j]]).max(0.0);
            for (traction, component) in tractions.iter_mut().zip(forces) {
                traction[[i, j]] = q * component / force;
            }
        }
        Ok(tractions)
    }
}
