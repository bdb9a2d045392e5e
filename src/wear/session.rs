//! Steps of wear, their control, and the moments at which layers are through.

use std::sync::Arc;

use ndarray::{Array2, Zip};

use super::rates::{Rates, THROUGH};
use super::regrid::{grown, regridded};
use super::{Slip, Wear, WearScheme, WearState, WearSteps, WearThrough};
use crate::compliance::response::Body;
use crate::contact::{
    Compliance, Contact, Motion, Options, Progress, Setup, Solution, Termination,
};
use crate::error::{Result, fraction, none_negative, not_negative, refuse_if, require, same_shape};
use crate::friction::{FrictionSolution, Step};
use crate::model::body::{HalfSpace, Layer};
use crate::model::surface::{OffsetShape, Surface};
use crate::stress::Member;

/// Rounds in which the rates of cells that pass from layer to layer within a step, and their pressures, are made to agree.
const ROUNDS: usize = 12;

/// Change of a rate, relative to it, that ends these rounds: far below what a rate is known to.
const SETTLED: f64 = 1e-6;

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
    /// Change of the pressure in the step before.
    change: Option<Array2<f64>>,
}

/// The end of one step.
struct Trial {
    length: f64,
    depth: [Array2<f64>; 2],
    solution: Solution,
    /// Pressure that wears at the end: [`worn_by`].
    pressure: Array2<f64>,
    error: Option<f64>,
    /// Whether the search for the distance at which a layer is through came to its end.
    settled: bool,
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
        let most_cells = grows.then(|| MORE_CELLS * grid.shape()[0] * grid.shape()[1]);
        Ok(Self {
            plan,
            shape,
            motion,
            wear,
            rates,
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
        let next = match self.last.take() {
            None => plan.run(|| self.first(progress))?,
            Some(last) => plan.run(|| self.step(last, progress))?,
        };
        self.ended = next.is_none()
            || self.wear.until_through
                && next.as_ref().is_some_and(|state| !state.through.is_empty());
        self.last.clone_from(&next);
        Ok(next)
    }

    /// The contact before any sliding.
    fn first(&self, progress: &mut Progress) -> Result<Option<WearState>> {
        let zeros = || Array2::zeros(self.plan.grid().shape());
        let depth = self.wear.initial.clone().unwrap_or_else(|| [zeros(), zeros()]);
        let solution = self.solved(&depth, &zeros(), None, None, progress)?;
        Ok(solution.map(|solution| WearState {
            distance: 0.0,
            depth,
            solution,
            through: Vec::new(),
            step_error: None,
            rings: false,
            settled: true,
            regrids: 0,
        }))
    }

    /// Largest change of the last pressure, over the peak, where the layers that wear are thinner by the mean of their depths,
    /// weighted by the pressure; `None` where no layer wears, or all of one is gone.
    ///
    /// # Errors
    /// As [`WearSession::advance`].
    pub fn thickness_error(&self, progress: &mut Progress) -> Result<Option<f64>> {
        let Some(last) = &self.last else { return Ok(None) };
        let (pressure, setup) = (&last.solution.pressure, self.plan.setup());
        let force = pressure.sum();
        let thinner = |k: usize, body: &Body| -> Result<Option<Body>> {
            let depth = (&last.depth[k] * pressure).sum() / force;
            match body.half_space() {
                Some(half_space) if depth > 0.0 => thinned(half_space, depth).map(Some),
                _ => Ok(None),
            }
        };
        let body = thinner(0, self.plan.body())?;
        let counterbody = setup.counterbody.as_ref().map(|body| thinner(1, body)).transpose()?;
        let counterbody = counterbody.flatten();
        if body.is_none() && counterbody.is_none() || setup.coefficients.is_some() {
            return Ok(None);
        }
        let body = body.unwrap_or_else(|| self.plan.body().clone());
        let counterbody = counterbody.or_else(|| setup.counterbody.clone());
        let setup = Setup { counterbody, ..setup.clone() };
        let plan = Contact::plan(body, *self.plan.grid(), setup)?;
        let options = Options { initial: Some(pressure.clone()), ..self.wear.options.clone() };
        let worn = self.worn(last);
        let other =
            plan.run(|| plan.solve_alone(&worn, &self.motion, &options, progress))?.pressure;
        let peak = last.solution.peak_pressure();
        let apart =
            Zip::from(pressure).and(&other).fold(0.0_f64, |most, a, b| most.max((a - b).abs()));
        Ok((peak > 0.0).then_some(apart / peak))
    }

    /// The contact of the worn bodies, between which `removed` is taken off too, on `springs`; `None` where it was stopped.
    fn solved(
        &self,
        [body, counterbody]: &[Array2<f64>; 2],
        removed: &Array2<f64>,
        springs: Option<Array2<f64>>,
        initial: Option<&Solution>,
        progress: &mut Progress,
    ) -> Result<Option<Solution>> {
        let options = Options {
            compliance: springs.map(Compliance::Cells),
            initial: initial.map(|solution| solution.pressure.clone()),
            ..self.wear.options.clone()
        };
        let worn = body + counterbody + removed;
        let solution = if worn.iter().all(|depth| *depth <= 0.0) && initial.is_none() {
            self.plan.solve_alone(&self.shape, &self.motion, &options, progress)?
        } else {
            let worn = OffsetShape::new(&self.shape as &dyn Surface, self.plan.grid(), worn);
            self.plan.solve_alone(&worn, &self.motion, &options, progress)?
        };
        if solution.report.termination == Termination::Stopped {
            return Ok(None);
        }
        solution.require_converged(options.tolerance).map(Some)
    }

    /// The state after `last`.
    fn step(&mut self, mut last: WearState, progress: &mut Progress) -> Result<Option<WearState>> {
        loop {
            let Some(left) = self.left(last.distance) else {
                return Ok(None);
            };
            let Some(trial) = self.controlled(&last, left, progress)? else {
                return Ok(None);
            };
            let grow = self.touched(&trial.solution);
            if let Some(most) = self.most_cells.filter(|_| grow != [false; 2]) {
                let Some(wider) = self.regrid(&last, grow, most, progress)? else {
                    return Ok(None);
                };
                last = wider;
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
                && self.change.as_ref().is_some_and(|before| {
                    correlation(&change, before, LEAST_CHANGE * trial.solution.peak_pressure())
                        < RINGING
                });
            self.change = through.is_empty().then_some(change);
            self.start = Some(trial.pressure);
            return Ok(Some(WearState {
                distance,
                depth: trial.depth,
                solution: trial.solution,
                through,
                step_error: trial.error,
                rings,
                settled: trial.settled,
                regrids: last.regrids,
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
        let WearSteps::Auto { tolerance, .. } = self.wear.steps else {
            let trial = self.trial(last, self.start.as_ref(), left, progress)?;
            return trial.map_or(Ok(None), |trial| self.until_through(last, trial, progress));
        };
        if self.rates.iter().all(Rates::vanish) {
            return self.trial(last, self.start.as_ref(), left, progress);
        }
        let mut length = self.length.unwrap_or_else(|| self.first_length(last)).min(left);
        loop {
            let Some(trial) = self.halved(last, length, progress)? else {
                return Ok(None);
            };
            let error = trial.error.unwrap_or(0.0);
            let order = if self.is_second_order() { 3.0 } else { 2.0 };
            let factor = SAFETY * (tolerance / error.max(1e-9 * tolerance)).powf(1.0 / order);
            let next = length * factor.clamp(CHANGE[0], CHANGE[1]);
            if error <= tolerance {
                self.length = Some(if length < left { next } else { next.max(length) });
                return self.until_through(last, trial, progress);
            }
            length = next.min(0.8 * length);
        }
    }

    fn is_second_order(&self) -> bool {
        self.wear.scheme == WearScheme::Trapezoidal && !matches!(self.wear.slip, Slip::Pass(..))
    }

    /// Length of the first step.
    fn first_length(&self, last: &WearState) -> f64 {
        let solution = &last.solution;
        let deepest = solution.displacement.iter().zip(&solution.pressure);
        let deepest = deepest.filter(|(_, p)| **p > 0.0).fold(0.0_f64, |a, (u, _)| a.max(u.abs()));
        let rate: f64 = self.rates.iter().map(|rates| rates.at(0.0)).sum();
        let slip = match &self.wear.slip {
            Slip::Cells(slip) => slip.fold(0.0_f64, |most, s| most.max(*s)),
            _ => 1.0,
        };
        let length = FIRST * deepest / (rate * slip * solution.peak_pressure());
        if length.is_finite() && length > 0.0 { length } else { f64::MAX }
    }

    /// A step in two halves, with the error that the whole one shows.
    fn halved(
        &self,
        last: &WearState,
        length: f64,
        progress: &mut Progress,
    ) -> Result<Option<Trial>> {
        let Some(whole) = self.trial(last, self.start.as_ref(), length, progress)? else {
            return Ok(None);
        };
        let Some(half) = self.trial(last, self.start.as_ref(), 0.5 * length, progress)? else {
            return Ok(None);
        };
        let middle = WearState { depth: half.depth, solution: half.solution, ..last.clone() };
        let Some(end) = self.trial(&middle, Some(&half.pressure), 0.5 * length, progress)? else {
            return Ok(None);
        };
        let peak = end.solution.peak_pressure();
        // The root of the mean square over the contact: cells that join it jump, however short the step.
        let (mut sum, mut cells) = (0.0, 0.0);
        let both = Zip::from(&end.solution.pressure).and(&whole.solution.pressure);
        both.for_each(|a, b| {
            sum += (a - b).powi(2);
            cells += f64::from(*a > 0.0);
        });
        let orders = if self.is_second_order() { 3.0 } else { 1.0 };
        let error = if peak > 0.0 { (sum / cells).sqrt() / (orders * peak) } else { 0.0 };
        Ok(Some(Trial { length, error: Some(error), ..end }))
    }

    /// The step, or the shorter one at whose end the first cell of a layer is through.
    fn until_through(
        &self,
        last: &WearState,
        mut trial: Trial,
        progress: &mut Progress,
    ) -> Result<Option<Trial>> {
        // Length, and what the part lacks or has beyond; a side that stays counts half (the Illinois method).
        let mut least = [0.0, 1.0 - self.part_of_layer(&last.depth)];
        let mut most: Option<[f64; 2]> = None;
        let mut was_beyond = None;
        let mut nearest: Option<(f64, Trial)> = None;
        for _ in 0..TRIALS {
            let part = self.part_of_layer(&trial.depth);
            if part <= 1.0 + MOMENT && (most.is_none() || part >= 1.0 - MOMENT) {
                return Ok(Some(trial));
            }
            let off = (part - 1.0).abs();
            let is_beyond = part > 1.0;
            if is_beyond {
                most = Some([trial.length, part - 1.0]);
            } else {
                least = [trial.length, 1.0 - part];
            }
            if was_beyond == Some(is_beyond) {
                let stays = if is_beyond { Some(&mut least) } else { most.as_mut() };
                stays.into_iter().for_each(|side| side[1] *= 0.5);
            }
            was_beyond = Some(is_beyond);
            let [[a, lacks], [b, beyond]] = [least, most.unwrap_or([trial.length, part - 1.0])];
            let length = a + (b - a) * lacks / (lacks + beyond);
            let next = match trial.error {
                Some(_) => self.halved(last, length, progress)?,
                None => self.trial(last, self.start.as_ref(), length, progress)?,
            };
            let Some(next) = next else { return Ok(None) };
            // The depth jumps, by what a pressure is known to: the nearest trial counts.
            if nearest.as_ref().is_none_or(|(least, _)| off < *least) {
                nearest = Some((off, trial));
            }
            trial = next;
        }
        let (off, trial) = nearest.unwrap_or((f64::INFINITY, trial));
        Ok(Some(Trial { settled: off <= THROUGH, ..trial }))
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

    /// One step from `last`, of this `length`; `start` is the pressure that wears there, if not that of its solution.
    fn trial(
        &self,
        last: &WearState,
        start: Option<&Array2<f64>>,
        length: f64,
        progress: &mut Progress,
    ) -> Result<Option<Trial>> {
        let shape = self.plan.grid().shape();
        let unchanged = || {
            let (depth, solution) = (last.depth.clone(), last.solution.clone());
            let pressure = solution.pressure.clone();
            Some(Trial { length, depth, solution, pressure, error: None, settled: true })
        };
        if self.rates.iter().all(Rates::vanish) {
            return Ok(unchanged());
        }
        let before = start.unwrap_or(&last.solution.pressure);
        let (track, slip) = match &self.wear.slip {
            Slip::Everywhere => (None, Array2::ones(shape)),
            Slip::Cells(slip) => (None, slip.clone()),
            Slip::Cycle(steps, options) => {
                let worn = self.worn(last);
                let mut twice: Vec<Step> = [&steps[..], &steps[..]].concat();
                if let Some(first) = twice.first_mut() {
                    first.motion = Some(self.motion);
                }
                let solutions = self.plan.slide(&worn, &twice, options, None)?;
                let mut slip = Array2::zeros(shape);
                for one in solutions.into_iter().skip(steps.len()) {
                    slip += &magnitude(&one.require_converged()?);
                }
                (None, slip)
            }
            Slip::Pass(rolling, options) => {
                let pass = self.plan.roll(&self.worn(last), rolling, options)?;
                let pass = pass.require_converged()?;
                let axis = ndarray::Axis(rolling.direction.axis());
                let worked = magnitude(&pass) * &pass.normal.pressure;
                let line = worked.sum_axis(axis) * self.plan.grid().spacing()[axis.index()];
                let track = line.insert_axis(axis).broadcast(shape).map(|track| track.to_owned());
                (track, Array2::zeros(shape))
            }
        };
        let end_weight = if self.is_second_order() { 0.5 } else { 1.0 };
        // Work \[N/m\] of the start of the step, and what its end adds per pressure.
        let (first, per_pressure) = match track {
            Some(track) => (track * length, Array2::zeros(shape)),
            None => (&slip * before * (length * (1.0 - end_weight)), slip * (length * end_weight)),
        };
        let mut rates = [0, 1].map(|k| last.depth[k].mapv(|depth| self.rates[k].at(depth)));
        for round in 1.. {
            let total = &rates[0] + &rates[1];
            let springs = &total * &per_pressure;
            let removed = total * &first;
            let soft = springs.iter().any(|c| *c > 0.0).then(|| springs.clone());
            let (depth, initial) = (&last.depth, Some(&last.solution));
            let Some(mut solution) = self.solved(depth, &removed, soft, initial, progress)? else {
                return Ok(None);
            };
            let one_cell = self.plan.convolution().self_influence();
            let pressure = worn_by(&solution, &springs, one_cell);
            // What springs gave is worn off.
            solution.release_springs(springs * &pressure);
            let work = &per_pressure * &pressure + &first;
            let mut changed = 0.0_f64;
            let mut next = rates.clone();
            for (k, next) in next.iter_mut().enumerate() {
                Zip::from(next).and(&last.depth[k]).and(&work).for_each(|rate, depth, work| {
                    let mean = self.rates[k].mean(*depth, *work);
                    changed =
                        changed.max((mean - *rate).abs() / mean.max(*rate).max(f64::MIN_POSITIVE));
                    *rate = mean;
                });
            }
            if changed <= SETTLED || round == ROUNDS {
                let depth = [0, 1].map(|k| &last.depth[k] + &(&rates[k] * &work));
                return Ok(Some(Trial {
                    length,
                    depth,
                    solution,
                    pressure,
                    error: None,
                    settled: true,
                }));
            }
            rates = next;
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
        let depth = [0, 1].map(|k| regridded(&last.depth[k], &from, &grid));
        let solution = self.solved(&depth, &Array2::zeros(grid.shape()), None, None, progress)?;
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
    HalfSpace::new(body.substrate(), layers).map(Body::from)
}

/// Pressure by which a step wears. It is that of the solution, but where springs are softer than the contact as a whole, a
/// residual within the tolerance is a large part of what they give, c p: there the gap is closed, p ← [p − g/(c + K₀)]₊, with
/// the displacement K₀ of a cell under its own unit pressure. Springs that are alike stay as they are: the worn volume is
/// κ s W as exactly as the pressure carries the load.
fn worn_by(solution: &Solution, springs: &Array2<f64>, one_cell: f64) -> Array2<f64> {
    let (mut given, mut squares) = (0.0, 0.0);
    Zip::from(&solution.pressure).and(springs).for_each(|p, c| {
        given += c * p * p;
        squares += p * p;
    });
    let softest = springs.fold(0.0_f64, |most, c| most.max(*c));
    if softest * squares <= given + one_cell * squares {
        return solution.pressure.clone();
    }
    Zip::from(&solution.pressure).and(springs).and(&solution.gap()).map_collect(|p, c, g| {
        let is_soft = *c * squares > given + one_cell * squares;
        if is_soft { (p - g / (c + one_cell)).max(0.0) } else { *p }
    })
}

/// Size of the slip of each cell.
fn magnitude(solution: &FrictionSolution) -> Array2<f64> {
    let [x, y] = &solution.slip;
    Zip::from(x).and(y).map_collect(|x, y| x.hypot(*y))
}

/// Correlation of two changes of a pressure; 0 where the largest is below `least`, and where the grids differ.
fn correlation(a: &Array2<f64>, b: &Array2<f64>, least: f64) -> f64 {
    let largest = a.fold(0.0_f64, |most, v| most.max(v.abs()));
    if a.dim() != b.dim() || largest < least {
        return 0.0;
    }
    let product = |a: &Array2<f64>, b: &Array2<f64>| (a * b).sum();
    product(a, b) / (product(a, a) * product(b, b)).sqrt().max(f64::MIN_POSITIVE)
}
