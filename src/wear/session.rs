//! Steps of wear, their control, and the moments at which layers are through.

use std::sync::Arc;

use ndarray::{Array2, Zip};

use super::rates::{Rates, THROUGH};
use super::regrid::{grown, regridded};
use super::thickness::TopLayers;
use super::{Idle, Slip, Thickness, Wear, WearScheme, WearState, WearSteps, WearThrough};
use crate::compliance::response::Body;
use crate::contact::{Contact, Motion, Options, Progress, Setup, Solution, Termination};
use crate::error::{
    Error, Result, fraction, none_negative, not_negative, refuse_if, require, same_shape,
};
use crate::friction::{
    FrictionOptions, FrictionReport, FrictionSolution, Last, Move, Step, TangentialMotion,
};
use crate::model::body::{HalfSpace, Layer, Substrate};
use crate::model::surface::{OffsetShape, Surface};
use crate::stress::Member;

/// Rounds in which the rates of cells that pass from layer to layer within a step, and their pressures, are made to agree.
const ROUNDS: usize = 12;

/// Change of a rate, relative to it, that ends these rounds: far below what a rate is known to.
const SETTLED: f64 = 1e-6;

/// Part of the thickness of a layer by which the depth in the elastic contact may lag behind: the pressure errs by no more, a
/// tenth of the usual error of a step.
const LAG: f64 = 1e-4;

/// Trials of the moment at which a layer is through. The depth is nearly linear in the length of the step.
const TRIALS: usize = 30;

/// Part of the depth left, or beyond, at which a layer counts as through: a tenth of what the rates allow.
const MOMENT: f64 = 0.1 * THROUGH;

/// Change of a step's length from one to the next, and the part of the length that the error permits.
const CHANGE: [f64; 2] = [0.2, 3.0];
const SAFETY: f64 = 0.8;

/// Wear of the first step, as a part of the approach: its error decides the next ones.
const FIRST: f64 = 0.02;

/// Correlation of two changes of the pressure below which it rings, and the least change relative to the peak that counts.
const RINGING: f64 = -0.3;
const LEAST_CHANGE: f64 = 1e-3;

/// Slip in contact, relative to how far the surfaces move, up to which they stick: rounding.
const NO_SLIP: f64 = 1e-6;

/// Growth of the number of cells beyond which cells are doubled instead.
const MORE_CELLS: usize = 4;

/// A history of wear: its steps one after the other.
#[derive(Debug)]
pub struct WearSession<S> {
    plan: Arc<Contact>,
    shape: S,
    motion: Motion,
    wear: Wear,
    rates: [Rates; 2],
    /// Layers that get thinner in the elastic contact; `None` where they do not.
    layers: Option<TopLayers>,
    /// Largest number of cells of a grid that grows; `None` where it was given.
    most_cells: Option<usize>,
    /// Length of the next step, where lengths are chosen.
    length: Option<f64>,
    /// Numbers of layers of body and counterbody of which a cell is through.
    through: [usize; 2],
    ended: bool,
    last: Option<WearState>,
    /// Pressure that wears at the start of the next step, where it is not that of the last solution.
    start: Option<Array2<f64>>,
    /// Change of the pressure in the step before, and its length.
    change: Option<(Array2<f64>, f64)>,
}

/// Where a step begins.
struct Start<'a> {
    state: &'a WearState,
    /// Pressure that wears there.
    pressure: &'a Array2<f64>,
    slipping: Slipping,
    idle: Option<Idle>,
}

/// Where surfaces slip in a step.
enum Slipping {
    /// Slip of each cell per unit of the distance.
    Cells(Array2<f64>),
    /// Σ |slip| p \[N/m\] along the track of a wheel.
    Track(Array2<f64>),
}

/// The end of one step.
struct Trial {
    length: f64,
    depth: [Array2<f64>; 2],
    solution: Solution,
    /// Pressure that wears at the end, where it is not that of the solution: [`worn_by`].
    pressure: Option<Array2<f64>>,
    error: Option<f64>,
    /// Whether the search for the distance at which a layer is through came to its end.
    settled: bool,
    idle: Option<Idle>,
}

impl Trial {
    /// A step whose error is not known.
    fn new(
        length: f64,
        depth: [Array2<f64>; 2],
        solution: Solution,
        pressure: Option<Array2<f64>>,
    ) -> Self {
        Self { length, depth, solution, pressure, error: None, settled: true, idle: None }
    }
}

impl<S: Surface> WearSession<S> {
    /// Wear of `shape` on the body of a plan. The grid grows with the contact where it `grows`.
    ///
    /// # Errors
    /// Rates, slip, distances or depths that are negative or not finite; slip nowhere; steps that do not increase; a hardness.
    pub fn new(
        plan: Arc<Contact>,
        shape: S,
        motion: Motion,
        wear: Wear,
        grows: bool,
    ) -> Result<Self> {
        let options = &wear.options;
        refuse_if(
            options.hardness.is_some() || options.compliance.is_some(),
            "wear has neither hardness nor compliance: leave them out",
        )?;
        let counterbody = plan.setup().counterbody.as_ref();
        let rates = [
            Rates::new("rate", &wear.rates[0], Some(plan.body()))?,
            Rates::new("counter_rate", &wear.rates[1], counterbody)?,
        ];
        match &wear.steps {
            WearSteps::Auto { end, tolerance } => {
                not_negative("sliding", *end)?;
                fraction("step_tolerance", *tolerance)?;
            }
            WearSteps::Ends(ends) => {
                let mut before = 0.0;
                for end in ends {
                    let increases = end.is_finite() && *end > before;
                    require("steps", *end, increases, "finite, above 0 and increasing")?;
                    before = *end;
                }
            }
        }
        let grid = plan.grid();
        if let Slip::Cells(slip) = &wear.slip {
            same_shape("slip", slip, grid.shape())?;
            none_negative("slip", slip)?;
            refuse_if(slip.iter().all(|slip| *slip <= 0.0), "slip must be above 0 somewhere")?;
        }
        let mut through = [0; 2];
        for (k, depth) in wear.initial.iter().flatten().enumerate() {
            same_shape("initial", depth, grid.shape())?;
            none_negative("initial", depth)?;
            let deepest = depth.fold(0.0_f64, |most, d| most.max(*d));
            let bottoms = rates[k].bottoms.iter();
            through[k] = bottoms.filter(|bottom| deepest >= **bottom * (1.0 - THROUGH)).count();
        }
        let layers = match wear.thickness {
            Thickness::Frozen => None,
            Thickness::FirstOrder => {
                Some(TopLayers::plan(&plan, wears(&rates, wear.initial.as_ref()))?)
            }
        };
        let most_cells = grows.then(|| MORE_CELLS * grid.shape()[0] * grid.shape()[1]);
        Ok(Self {
            plan,
            shape,
            motion,
            wear,
            rates,
            layers,
            most_cells,
            length: None,
            through,
            ended: false,
            last: None,
            start: None,
            change: None,
        })
    }

    /// The next state, the contact before any sliding first; `None` at the end, and where `progress`, which is told of each
    /// iteration, breaks.
    ///
    /// # Errors
    /// Those of the solves, [`Error::NotConverged`](crate::Error::NotConverged) among them.
    pub fn advance(&mut self, progress: &mut Progress) -> Result<Option<WearState>> {
        if self.ended {
            return Ok(None);
        }
        let plan = Arc::clone(&self.plan);
        let mut last = self.last.take();
        let next = match &mut last {
            None => plan.run(|| self.first(progress))?,
            Some(last) => plan.run(|| self.step(last, progress))?,
        };
        self.ended = next.is_none()
            || self.wear.until_through
                && next.as_ref().is_some_and(|state| !state.through.is_empty());
        self.last = next.clone().or(last);
        Ok(next)
    }

    /// The contact before any sliding.
    fn first(&self, progress: &mut Progress) -> Result<Option<WearState>> {
        let zeros = || Array2::zeros(self.plan.grid().shape());
        let depth = self.wear.initial.clone().unwrap_or_else(|| [zeros(), zeros()]);
        let solution = self.solved(&depth[0] + &depth[1], Some(&depth), None, None, progress)?;
        Ok(solution.map(|solution| WearState {
            distance: 0.0,
            depth,
            solution,
            through: Vec::new(),
            step_error: None,
            rings: false,
            settled: true,
            regrids: 0,
            idle: None,
        }))
    }

    /// Error of the last pressure by the thickness of the layers: the root of its mean square within the contact, relative to the
    /// peak. It is the difference from the pressure on layers that are thinner by the mean of their depths, weighted by the
    /// pressure; to first order, that between two pressures on layers that are thinner by this mean, to first order and
    /// exactly. Given influence coefficients change by what exact ones do. `None` where no layer wears, where nothing would be
    /// left on a rigid or free base, and where given coefficients do not hold so thin a layer.
    ///
    /// # Errors
    /// As [`WearSession::advance`].
    pub fn thickness_error(&self, progress: &mut Progress) -> Result<Option<f64>> {
        let Some(last) = &self.last else { return Ok(None) };
        let (pressure, setup) = (&last.solution.pressure, self.plan.setup());
        let force = pressure.sum();
        if force <= 0.0 {
            return Ok(None);
        }
        let means = [0, 1].map(|k| (&last.depth[k] * pressure).sum() / force);
        let both = [Some(self.plan.body()), setup.counterbody.as_ref()];
        let is_gone = |(body, depth): (Option<&Body>, f64)| {
            body.and_then(|body| body.half_space()).is_some_and(|body| {
                !matches!(body.substrate(), Substrate::Elastic(_))
                    && depth >= body.thickness() * (1.0 - THROUGH)
            })
        };
        if both.into_iter().zip(means).any(is_gone) {
            return Ok(None);
        }
        let thinner = |k: usize, body: &Body| -> Result<Option<Body>> {
            let depth = means[k];
            match body.half_space() {
                Some(half_space) if depth > 0.0 && !half_space.layers().is_empty() => {
                    thinned(half_space, depth).map(Some)
                }
                _ => Ok(None),
            }
        };
        let body = thinner(0, self.plan.body())?;
        let counterbody = setup.counterbody.as_ref().map(|body| thinner(1, body)).transpose()?;
        let counterbody = counterbody.flatten();
        if body.is_none() && counterbody.is_none() {
            return Ok(None);
        }
        let body = body.unwrap_or_else(|| self.plan.body().clone());
        let counterbody = counterbody.or_else(|| setup.counterbody.clone());
        let setup = Setup { counterbody, coefficients: None, ..setup.clone() };
        let coefficients = self.plan.given_coefficients_of(&body, &setup)?;
        let is_given = coefficients.is_some();
        let setup = Setup { coefficients, ..setup };
        let plan = match Contact::plan(body, *self.plan.grid(), setup) {
            // Given coefficients may have too little of the layer that is taken away.
            Err(Error::Indefinite) if is_given => return Ok(None),
            plan => plan?,
        };
        let options = Options { initial: Some(pressure.clone()), ..self.wear.options.clone() };
        let worn = self.worn(last);
        let other = plan.run(|| plan.solve_alone(&worn, &self.motion, &options, progress))?;
        let even = means.map(|mean| Array2::from_elem(pressure.dim(), mean));
        let even = self
            .thinned_plan(&even)
            .map(|plan| plan.run(|| plan.solve_alone(&worn, &self.motion, &options, progress)));
        let even = even.transpose()?;
        if !even.iter().chain([&other]).all(|one| one.report.converged()) {
            return Ok(None);
        }
        let pressure = even.as_ref().map_or(pressure, |even| &even.pressure);
        let peak = last.solution.peak_pressure();
        let apart = difference([pressure, pressure, &other.pressure]);
        Ok((peak > 0.0).then_some(apart / peak))
    }

    /// The plan of bodies whose layers are thinner by these depths; `None` where that changes nothing.
    fn thinned_plan(&self, depth: &[Array2<f64>; 2]) -> Option<Contact> {
        let operators = self.layers.as_ref()?.thinned(depth, self.plan.convolution().own_threads());
        (!operators.is_empty()).then(|| self.plan.with_beside(operators))
    }

    /// The contact of the shape on bodies from which so much is `worn` together, on `springs`, with layers that are thinner by
    /// the depths `missing`; `None` where it was stopped.
    fn solved(
        &self,
        worn: Array2<f64>,
        missing: Option<&[Array2<f64>; 2]>,
        springs: Option<&Array2<f64>>,
        initial: Option<Array2<f64>>,
        progress: &mut Progress,
    ) -> Result<Option<Solution>> {
        let mut options = Options { initial, ..self.wear.options.clone() };
        let is_new = worn.iter().all(|depth| *depth <= 0.0) && options.initial.is_none();
        let worn = OffsetShape::new(&self.shape as &dyn Surface, self.plan.grid(), worn);
        let shape: &dyn Surface = if is_new { &self.shape } else { &worn };
        let thinned = missing.and_then(|missing| self.thinned_plan(missing));
        if thinned.is_some() && options.initial.is_none() {
            // Coarser grids have layers as thick as before.
            let start = self.plan.solve_alone(shape, &self.motion, &options, progress)?;
            options.initial = Some(start.pressure);
        }
        let plan = thinned.as_ref().unwrap_or(&self.plan);
        let solution = match springs {
            Some(springs) => {
                plan.solve_on_springs(shape, springs, &self.motion, &options, progress)?
            }
            None => plan.solve_alone(shape, &self.motion, &options, progress)?,
        };
        if solution.report.termination == Termination::Stopped {
            return Ok(None);
        }
        refuse_if(
            thinned.is_some() && !solution.report.converged(),
            "thickness must be \"frozen\" here: to first order in the depth, the contact of so thin a layer did not converge",
        )?;
        solution.require_converged(options.tolerance).map(Some)
    }

    /// The state after `last`, which is on the grid of the plan then.
    fn step(&mut self, last: &mut WearState, progress: &mut Progress) -> Result<Option<WearState>> {
        loop {
            let Some(left) = self.left(last.distance) else {
                return Ok(None);
            };
            let Some(trial) = self.controlled(last, left, progress)? else {
                return Ok(None);
            };
            if let Some(most) = self.most_cells
                && let grow = self.touched(&trial.solution)
                && grow != [false; 2]
            {
                let Some(wider) = self.regrid(last, grow, most, progress)? else {
                    return Ok(None);
                };
                *last = wider;
                continue;
            }
            let is_end = trial.length >= left * (1.0 - 1e-12);
            let distance = match (&self.wear.steps, is_end) {
                (WearSteps::Auto { end, .. }, true) => *end,
                (WearSteps::Ends(_), true) => last.distance + left,
                _ => last.distance + trial.length,
            };
            let through = self.through_at(distance, &trial.depth);
            let change = &trial.solution.pressure - &last.solution.pressure;
            let rings = self.wear.scheme == WearScheme::Trapezoidal
                && self.change.as_ref().is_some_and(|(before, _)| {
                    correlation(&change, before, LEAST_CHANGE * trial.solution.peak_pressure())
                        < RINGING
                });
            self.change = through.is_empty().then_some((change, trial.length));
            self.start = trial.pressure;
            return Ok(Some(WearState {
                distance,
                depth: trial.depth,
                solution: trial.solution,
                through,
                step_error: trial.error,
                rings,
                settled: trial.settled,
                regrids: last.regrids,
                idle: trial.idle,
            }));
        }
    }

    /// Distance to the end of the next given step, or of all; `None` at the end.
    fn left(&self, distance: f64) -> Option<f64> {
        let rounding = |end: &f64| *end > distance * (1.0 + 1e-12);
        let end = match &self.wear.steps {
            WearSteps::Auto { end, .. } => Some(*end).filter(rounding),
            WearSteps::Ends(ends) => ends.iter().copied().find(rounding),
        };
        end.map(|end| end - distance)
    }

    /// A step of a length that the error permits, which ends where a layer is through.
    fn controlled(
        &mut self,
        last: &WearState,
        left: f64,
        progress: &mut Progress,
    ) -> Result<Option<Trial>> {
        let start = self.start.clone();
        let Some(begun) = self.begun(last, start.as_ref(), progress)? else {
            return Ok(None);
        };
        let WearSteps::Auto { tolerance, .. } = self.wear.steps else {
            let trial = self.trial(&begun, left, self.expected(&begun, left), progress)?;
            return trial.map_or(Ok(None), |trial| self.until_through(&begun, trial, progress));
        };
        if self.rates.iter().all(Rates::vanish) {
            return self.trial(&begun, left, begun.pressure.clone(), progress);
        }
        let mut length = self.length.unwrap_or_else(|| self.first_length(&begun)).min(left);
        loop {
            let Some(trial) = self.halved(&begun, length, progress)? else {
                return Ok(None);
            };
            let error = trial.error.unwrap_or(0.0);
            let order = if self.is_second_order() { 3.0 } else { 2.0 };
            let factor = SAFETY * (tolerance / error.max(1e-9 * tolerance)).powf(1.0 / order);
            let next = length * factor.clamp(CHANGE[0], CHANGE[1]);
            if error <= tolerance {
                self.length = Some(if length < left { next } else { next.max(length) });
                return self.until_through(&begun, trial, progress);
            }
            length = next.min(0.8 * length);
        }
    }

    fn is_second_order(&self) -> bool {
        self.wear.scheme == WearScheme::Trapezoidal && !matches!(self.wear.slip, Slip::Pass(..))
    }

    /// Length of the first step.
    fn first_length(&self, begun: &Start) -> f64 {
        let solution = &begun.state.solution;
        let deepest = solution.displacement.iter().zip(&solution.pressure);
        let deepest = deepest.filter(|(_, p)| **p > 0.0).fold(0.0_f64, |a, (u, _)| a.max(u.abs()));
        let rate: f64 = self.rates.iter().map(|rates| rates.at(0.0)).sum();
        let work = match &begun.slipping {
            Slipping::Cells(slip) => slip * &solution.pressure,
            Slipping::Track(track) => track.clone(),
        };
        let length = FIRST * deepest / (rate * work.fold(0.0_f64, |most, work| most.max(*work)));
        if length.is_finite() && length > 0.0 { length } else { f64::MAX }
    }

    /// Where a step from a state begins; `pressure` wears there, if it is not that of its solution. `None` where it was stopped.
    fn begun<'a>(
        &self,
        state: &'a WearState,
        pressure: Option<&'a Array2<f64>>,
        progress: &mut Progress,
    ) -> Result<Option<Start<'a>>> {
        let slipping = self.slipping(state, progress)?;
        let pressure = pressure.unwrap_or(&state.solution.pressure);
        Ok(slipping.map(|(slipping, idle)| Start { state, pressure, slipping, idle }))
    }

    /// Where worn bodies slip, and why nowhere; `None` where it was stopped.
    fn slipping(
        &self,
        state: &WearState,
        progress: &mut Progress,
    ) -> Result<Option<(Slipping, Option<Idle>)>> {
        let shape = self.plan.grid().shape();
        if self.rates.iter().all(Rates::vanish) {
            return Ok(Some((Slipping::Cells(Array2::zeros(shape)), None)));
        }
        Ok(match &self.wear.slip {
            Slip::Everywhere => Some((Slipping::Cells(Array2::ones(shape)), None)),
            Slip::Cells(slip) => Some((Slipping::Cells(slip.clone()), None)),
            Slip::Cycle(steps, options) => {
                let mut twice: Vec<Step> = [&steps[..], &steps[..]].concat();
                if let Some(first) = twice.first_mut() {
                    first.motion = Some(self.motion);
                }
                let moves = twice.iter().map(Move::Slide);
                let solutions = self.moved(state, moves, options, progress)?;
                solutions.map(|solutions| {
                    let mut slip = Array2::zeros(shape);
                    for pair in solutions.windows(2).skip(steps.len().saturating_sub(1)) {
                        slip += &passed(&pair[0], &pair[1]);
                    }
                    let idle = idle(&solutions, steps.len());
                    (Slipping::Cells(slip), idle)
                })
            }
            Slip::Pass(rolling, options) => {
                let moves = std::iter::once(Move::RollSteadily(rolling));
                let solutions = self.moved(state, moves, options, progress)?;
                let axis = ndarray::Axis(rolling.direction.axis());
                let track = solutions.into_iter().flatten().next().and_then(|pass| {
                    let line = pass.track(rolling.direction).insert_axis(axis);
                    line.broadcast(shape).map(|track| track.to_owned())
                });
                track.map(|track| (Slipping::Track(track), None))
            }
        })
    }

    /// Solutions of `moves` of the worn bodies with friction, in which `progress` is told of the last contact; `None` where it
    /// breaks.
    fn moved<'m>(
        &self,
        state: &WearState,
        moves: impl Iterator<Item = Move<'m>>,
        options: &FrictionOptions,
        progress: &mut Progress,
    ) -> Result<Option<Vec<FrictionSolution>>> {
        let worn = self.worn(state);
        let tell = &mut |_: &FrictionReport| progress(&state.solution.report);
        let mut solutions: Vec<FrictionSolution> = Vec::new();
        for next in moves {
            let last = solutions.last().map(|solution| Last { solution, is_own: true });
            let solution = self.plan.friction_step(&worn, next, options, last, tell)?;
            if solution.report.termination == Termination::Stopped {
                return Ok(None);
            }
            solutions.push(solution.require_converged()?);
        }
        Ok(Some(solutions))
    }

    /// Pressure that is to be expected at the end of a step: it goes on as in the step before, and no further where the step
    /// is longer, as pressures fall ever more slowly. That takes a fifth of the iterations less than from the last pressure; a
    /// parabola through three takes half as many more than the line, as cells at the edge jump.
    fn expected(&self, begun: &Start, length: f64) -> Array2<f64> {
        let now = &begun.state.solution.pressure;
        match &self.change {
            Some((change, over)) if change.dim() == now.dim() => {
                let part = (length / over).min(1.0);
                Zip::from(now).and(change).map_collect(|p, change| (p + part * change).max(0.0))
            }
            _ => now.clone(),
        }
    }

    /// A step in two halves, with the error that the whole one shows.
    fn halved(&self, begun: &Start, length: f64, progress: &mut Progress) -> Result<Option<Trial>> {
        let Some(whole) = self.trial(begun, length, self.expected(begun, length), progress)? else {
            return Ok(None);
        };
        let middle = 0.5 * (&begun.state.solution.pressure + &whole.solution.pressure);
        let Some(half) = self.trial(begun, 0.5 * length, middle, progress)? else {
            return Ok(None);
        };
        let middle =
            WearState { depth: half.depth, solution: half.solution, ..begun.state.clone() };
        let Some(middle) = self.begun(&middle, half.pressure.as_ref(), progress)? else {
            return Ok(None);
        };
        let expected = whole.solution.pressure.clone();
        let Some(end) = self.trial(&middle, 0.5 * length, expected, progress)? else {
            return Ok(None);
        };
        let [before, after] = [&begun.state.solution, &whole.solution].map(|one| &one.pressure);
        let error = difference([before, after, &end.solution.pressure]);
        let orders = if self.is_second_order() { 3.0 } else { 1.0 };
        let peak = end.solution.peak_pressure();
        let error = if peak > 0.0 { error / (orders * peak) } else { 0.0 };
        Ok(Some(Trial { length, error: Some(error), idle: begun.idle, ..end }))
    }

    /// The step, or the shorter one at whose end the first cell of a layer is through.
    fn until_through(
        &self,
        begun: &Start,
        trial: Trial,
        progress: &mut Progress,
    ) -> Result<Option<Trial>> {
        let part = self.part_of_layer(&trial.depth);
        if part <= 1.0 + MOMENT {
            return Ok(Some(trial));
        }
        // Length, and what the part lacks or has beyond; a side that stays counts half (the Illinois method).
        let mut least = [0.0, 1.0 - self.part_of_layer(&begun.state.depth)];
        let mut most = [trial.length, part - 1.0];
        let mut was_beyond = true;
        // The depth jumps, by what a pressure is known to: the nearest trial counts.
        let (mut off, mut nearest) = (part - 1.0, trial);
        for _ in 0..TRIALS {
            let [[a, lacks], [b, beyond]] = [least, most];
            let length = a + (b - a) * lacks / (lacks + beyond);
            let next = match nearest.error {
                Some(_) => self.halved(begun, length, progress)?,
                None => self.trial(begun, length, nearest.solution.pressure.clone(), progress)?,
            };
            let Some(next) = next else { return Ok(None) };
            let part = self.part_of_layer(&next.depth);
            let is_beyond = part > 1.0;
            let [own, other] =
                if is_beyond { [&mut most, &mut least] } else { [&mut least, &mut most] };
            *own = [next.length, (part - 1.0).abs()];
            if was_beyond == is_beyond {
                other[1] *= 0.5;
            }
            was_beyond = is_beyond;
            if (part - 1.0).abs() < off {
                (off, nearest) = ((part - 1.0).abs(), next);
            }
            if off <= MOMENT {
                return Ok(Some(nearest));
            }
        }
        Ok(Some(Trial { settled: off <= THROUGH, ..nearest }))
    }

    /// Largest depth of a cell over that of the bottom of the next layer; 1 where it is just through.
    fn part_of_layer(&self, depth: &[Array2<f64>; 2]) -> f64 {
        let mut most = 0.0_f64;
        for (k, depth) in depth.iter().enumerate() {
            let Some(bottom) = self.rates[k].bottoms.get(self.through[k]) else {
                continue;
            };
            most = depth.fold(most, |most, depth| most.max(depth / bottom));
        }
        most
    }

    /// Layers that are through at these depths, and were not before.
    fn through_at(&mut self, distance: f64, depth: &[Array2<f64>; 2]) -> Vec<WearThrough> {
        let grid = self.plan.grid();
        let mut events = Vec::new();
        for (k, member) in [Member::Body, Member::Counterbody].into_iter().enumerate() {
            if self.through[k] >= self.rates[k].bottoms.len() {
                continue;
            }
            let cells = depth[k].indexed_iter();
            let Some(((i, j), deepest)) = cells.max_by(|a, b| a.1.total_cmp(b.1)) else {
                continue;
            };
            while let Some(bottom) = self.rates[k].bottoms.get(self.through[k])
                && *deepest >= bottom * (1.0 - THROUGH)
            {
                let (layer, position) = (self.through[k], [grid.x()[i], grid.y()[j]]);
                events.push(WearThrough { distance, position, layer, member });
                self.through[k] += 1;
            }
        }
        events
    }

    /// One step of this `length`, whose end is `expected` at this pressure.
    fn trial(
        &self,
        begun: &Start,
        length: f64,
        expected: Array2<f64>,
        progress: &mut Progress,
    ) -> Result<Option<Trial>> {
        let last = begun.state;
        if self.rates.iter().all(Rates::vanish) {
            let (depth, solution) = (last.depth.clone(), last.solution.clone());
            return Ok(Some(Trial::new(length, depth, solution, None)));
        }
        let end_weight = if self.is_second_order() { 0.5 } else { 1.0 };
        // Work \[N/m\] of the start of the step, and what its end adds per pressure.
        let (first, per_pressure) = match &begun.slipping {
            Slipping::Track(track) => (track * length, Array2::zeros(track.dim())),
            Slipping::Cells(slip) => (
                slip * begun.pressure * (length * (1.0 - end_weight)),
                slip * (length * end_weight),
            ),
        };
        let mut rates = [0, 1].map(|k| match self.rates[k].uniform() {
            Some(rate) => Array2::from_elem(last.depth[k].dim(), rate),
            None => last.depth[k].mapv(|depth| self.rates[k].at(depth)),
        });
        let work = |pressure: &Array2<f64>| {
            let cells = Zip::from(&per_pressure).and(pressure).and(&first);
            cells.map_collect(|per_pressure, p, first| per_pressure * p + first)
        };
        // Depths by which layers are thinner.
        let mut missing = self.layers.as_ref().map(|_| {
            let work = work(&expected);
            [0, 1].map(|k| &last.depth[k] + &(&rates[k] * &work))
        });
        let mut initial = expected;
        for round in 1.. {
            let cells = Zip::from(&rates[0]).and(&rates[1]);
            let springs = cells.and(&per_pressure).map_collect(|a, b, work| (a + b) * work);
            let cells = Zip::from(&last.depth[0]).and(&last.depth[1]).and(&rates[0]).and(&rates[1]);
            let worn = cells.and(&first).map_collect(|v, w, a, b, work| v + w + (a + b) * work);
            let solution =
                self.solved(worn, missing.as_ref(), Some(&springs), Some(initial), progress)?;
            let Some(mut solution) = solution else {
                return Ok(None);
            };
            let one_cell = self.plan.convolution().self_influence();
            let pressure = worn_by(&solution, &springs, one_cell);
            // What springs gave is worn off.
            solution.release_springs(pressure.as_ref().map(|pressure| springs * pressure));
            let work = work(pressure.as_ref().unwrap_or(&solution.pressure));
            let mut reached = last.depth.clone();
            let mut changed = 0.0_f64;
            for (k, (rates, depth)) in rates.iter_mut().zip(&mut reached).enumerate() {
                match self.rates[k].uniform() {
                    Some(rate) if rate > 0.0 => depth.scaled_add(rate, &work),
                    Some(_) => (),
                    None => Zip::from(rates).and(depth).and(&work).for_each(|rate, depth, work| {
                        let mean = self.rates[k].mean(*depth, *work);
                        changed = changed
                            .max((mean - *rate).abs() / mean.max(*rate).max(f64::MIN_POSITIVE));
                        *depth += *rate * work;
                        *rate = mean;
                    }),
                }
            }
            let lag = self.layers.as_ref().zip(missing.as_ref());
            let lag = lag.map_or(0.0, |(layers, missing)| layers.apart(&reached, missing));
            if changed <= SETTLED && lag <= LAG || round == ROUNDS {
                let idle = begun.idle;
                return Ok(Some(Trial { idle, ..Trial::new(length, reached, solution, pressure) }));
            }
            missing = self.layers.as_ref().map(|_| reached);
            initial = solution.pressure;
        }
        unreachable!("the loop ends by its limit")
    }

    /// The shape on the worn bodies.
    fn worn(&self, state: &WearState) -> OffsetShape<&dyn Surface> {
        let worn = &state.depth[0] + &state.depth[1];
        OffsetShape::new(&self.shape as &dyn Surface, self.plan.grid(), worn)
    }

    /// Axes along which the contact reaches a side of the grid that it may leave.
    fn touched(&self, solution: &Solution) -> [bool; 2] {
        let (grid, extent) = (solution.grid(), self.shape.extent());
        let Some(window) = solution.cells_in_contact() else {
            return [false; 2];
        };
        [0, 1].map(|k| {
            let [low, high] = extent[k].range();
            let half = 0.5 * grid.size()[k] * (1.0 + 1e-9);
            let goes_on = low < grid.center()[k] - half || high > grid.center()[k] + half;
            let reached = window[k].start == 0 || window[k].end == grid.shape()[k];
            let is_free = !(grid.is_periodic()[k] || grid.is_line() && k == 0);
            is_free && goes_on && reached
        })
    }

    /// `last` on a larger grid, solved there.
    fn regrid(
        &mut self,
        last: &WearState,
        axes: [bool; 2],
        most: usize,
        progress: &mut Progress,
    ) -> Result<Option<WearState>> {
        refuse_if(
            matches!(self.wear.slip, Slip::Cells(_)),
            "the contact has outgrown the grid that slip has: give a larger grid",
        )?;
        let from = *self.plan.grid();
        let grid = grown(&from, axes, most)?;
        let setup = self.plan.setup().clone();
        self.plan = Arc::new(Contact::plan(self.plan.body().clone(), grid, setup)?);
        if self.layers.is_some() {
            self.layers = Some(TopLayers::plan(&self.plan, wears(&self.rates, Some(&last.depth)))?);
        }
        let depth = [0, 1].map(|k| regridded(&last.depth[k], &from, &grid));
        let worn = &depth[0] + &depth[1];
        let solution = self.solved(worn, Some(&depth), None, None, progress)?;
        (self.change, self.start) = (None, None);
        Ok(solution.map(|solution| WearState {
            depth,
            solution,
            regrids: last.regrids + 1,
            ..last.clone()
        }))
    }
}

/// `body` without a `depth` of its layers, as far as they go.
fn thinned(body: &HalfSpace, depth: f64) -> Result<Body> {
    let (mut left, mut layers) = (depth, Vec::new());
    for layer in body.layers() {
        let rest = layer.thickness() - left;
        left = (left - layer.thickness()).max(0.0);
        if rest > 0.0 {
            let thin = Layer::new(layer.material(), rest)?.with_interface(layer.interface());
            layers.push(thin);
        }
    }
    HalfSpace::new(body.substrate(), layers)?.with_ends(body.ends()).map(Body::from)
}

/// Pressure by which a step wears. It is that of the solution, but where springs are softer than the contact as a whole, a
/// residual within the tolerance is a large part of what they give, c p: there the gap is closed, p ← [p − g/(c + K₀)]₊, with
/// the displacement K₀ of a cell under its own unit pressure. Springs that are alike stay as they are: the worn volume is
/// κ s W as exactly as the pressure carries the load.
/// `None` where all stay.
fn worn_by(solution: &Solution, springs: &Array2<f64>, one_cell: f64) -> Option<Array2<f64>> {
    let (mut given, mut squares) = (0.0, 0.0);
    Zip::from(&solution.pressure).and(springs).for_each(|p, c| {
        given += c * p * p;
        squares += p * p;
    });
    let softest = springs.fold(0.0_f64, |most, c| most.max(*c));
    if softest * squares <= given + one_cell * squares {
        return None;
    }
    let gap = solution.gap();
    let cells = Zip::from(&solution.pressure).and(springs).and(&gap);
    Some(cells.map_collect(|p, c, g| {
        let is_soft = *c * squares > given + one_cell * squares;
        if is_soft { (p - g / (c + one_cell)).max(0.0) } else { *p }
    }))
}

/// Difference of the last two pressures: the root of its mean square over the cells that are in contact with all their
/// neighbours under all three, over all cells where there are none. At the edge, pressures differ by which cells the contact
/// covers, however short a step is.
fn difference([before, one, other]: [&Array2<f64>; 3]) -> f64 {
    let carries = |i: usize, j: usize| [before, one, other].iter().all(|p| p[[i, j]] > 0.0);
    let (nx, ny) = before.dim();
    let around = |i: usize, n: usize| i.saturating_sub(1)..(i + 2).min(n);
    let inside = |i: usize, j: usize| around(i, nx).all(|k| around(j, ny).all(|l| carries(k, l)));
    let squares = |member: &dyn Fn(usize, usize) -> bool| {
        let (mut sum, mut cells) = (0.0, 0.0);
        for ((i, j), p) in one.indexed_iter().filter(|((i, j), _)| member(*i, *j)) {
            sum += (p - other[[i, j]]).powi(2);
            cells += 1.0;
        }
        (cells > 0.0).then(|| f64::sqrt(sum / cells))
    };
    squares(&inside).or_else(|| squares(&|_, _| true)).unwrap_or(0.0)
}

/// Size of the slip of each cell.
fn magnitude(solution: &FrictionSolution) -> Array2<f64> {
    let [x, y] = &solution.slip;
    Zip::from(x).and(y).map_collect(|x, y| x.hypot(*y))
}

/// Distance by which the surfaces pass each other in each cell in a step, |Δw − Δu|: the slip of cells in contact. Others may come
/// into contact within a step of wear, and would then press without being worn.
fn passed(before: &FrictionSolution, after: &FrictionSolution) -> Array2<f64> {
    let mut slip = magnitude(after);
    let [Some(from), Some(to)] = [before, after].map(shift_and_twist) else { return slip };
    let moved = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
    let (x, y) = (after.normal.grid().x(), after.normal.grid().y());
    for ((i, j), slip) in slip.indexed_iter_mut() {
        if after.normal.pressure[[i, j]] <= 0.0 {
            let rigid = [moved[0] - moved[2] * y[j], moved[1] + moved[2] * x[i]];
            let [along, across] = [0, 1].map(|axis| {
                let [a, b] = [before, after].map(|one| one.displacement[axis][[i, j]]);
                rigid[axis] - (b - a)
            });
            *slip = along.hypot(across);
        }
    }
    slip
}

/// Shift along x and y, and twist; `None` of rolling.
fn shift_and_twist(solution: &FrictionSolution) -> Option<[f64; 3]> {
    match solution.motion {
        TangentialMotion::Slide { shift, twist } => Some([shift[0], shift[1], twist]),
        TangentialMotion::Roll { .. } => None,
    }
}

/// Why the second of two times that so many `steps` are made lets nothing slip in contact; `None` where something does.
fn idle(solutions: &[FrictionSolution], steps: usize) -> Option<Idle> {
    let most = |solutions: &[FrictionSolution]| {
        let mut slip = Array2::<f64>::zeros(solutions.first()?.normal.pressure.dim());
        for solution in solutions {
            let own = magnitude(solution);
            let cells = Zip::from(&mut slip).and(&own).and(&solution.normal.pressure);
            cells.for_each(|slip, own, p| *slip += if *p > 0.0 { *own } else { 0.0 });
        }
        Some(slip.fold(0.0_f64, |most, slip| most.max(*slip)))
    };
    let (first, second) = solutions.split_at(steps.min(solutions.len()));
    let [first_slip, second_slip] = [most(first)?, most(second)?];
    let (mut moved, mut before) = (0.0, [0.0; 3]);
    for solution in first {
        let [lx, ly] = solution.normal.grid().size();
        let at = shift_and_twist(solution)?;
        let [x, y, turn] = [0, 1, 2].map(|k| at[k] - before[k]);
        moved += x.hypot(y) + turn.abs() * lx.hypot(ly);
        before = at;
    }
    let reason = if first_slip > NO_SLIP * moved { Idle::DoesNotReturn } else { Idle::Sticks };
    (second_slip <= NO_SLIP * first_slip.max(moved)).then_some(reason)
}

/// Which bodies wear, or are worn before.
fn wears(rates: &[Rates; 2], before: Option<&[Array2<f64>; 2]>) -> [bool; 2] {
    [0, 1].map(|k| {
        !rates[k].vanish() || before.is_some_and(|depth| depth[k].iter().any(|depth| *depth > 0.0))
    })
}

/// Correlation of two changes of a pressure; 0 where the largest is below `least`, and where the grids differ.
fn correlation(a: &Array2<f64>, b: &Array2<f64>, least: f64) -> f64 {
    if a.dim() != b.dim() {
        return 0.0;
    }
    let (mut largest, mut product, mut squares) = (0.0_f64, 0.0, [0.0; 2]);
    Zip::from(a).and(b).for_each(|a, b| {
        largest = largest.max(a.abs());
        product += a * b;
        squares[0] += a * a;
        squares[1] += b * b;
    });
    if largest < least {
        return 0.0;
    }
    product / (squares[0] * squares[1]).sqrt().max(f64::MIN_POSITIVE)
}
