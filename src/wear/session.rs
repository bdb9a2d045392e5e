//! Steps of wear, their control, and the moments at which layers are through.

use std::sync::{Arc, Mutex, PoisonError};

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
    FrictionOptions, FrictionReport, FrictionSolution, Move, Step, TangentialMotion,
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
/// The same where a step adds no more error than solves have: nothing is worn any more, and what is left ends soon.
const IDLE_CHANGE: f64 = 1e3;
const SAFETY: f64 = 0.8;

/// Wear of the first step, as a part of the approach: its error decides the next ones.
const FIRST: f64 = 0.02;

/// Bound of the error of a step in its halves, and of a whole one, over the difference of both. Of waves that fade as exp(−z) in
/// the step, Euler's rule has at most 1.41 and 2.41, at z = 1.6 and 1.5, the trapezoidal rule 1/2 and 4/3, and the explicit one of
/// passes 1 and 2 (derived here). Halves have the bound of whole steps, too: cells at the edge, whose pressures are no sums of few
/// waves, err by up to 2.2.
const ERROR: f64 = 3.0;

/// Error of a pressure, relative to the peak, over the tolerance of its solve: solves of the same contact from other starts differ by
/// no more where nothing is worn.
const OF_SOLVES: f64 = 100.0;

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
    /// End of the same history in steps of another length, which tells the error: whole ones where the history is that of their
    /// halves, and halves where lengths are given. `None` where it is the same.
    twin: Option<Trial>,
    /// Largest pressure of the history.
    peak: f64,
    /// Convolutions since the last state.
    convolutions: Mutex<f64>,
}

/// Where a step begins.
#[derive(Clone)]
struct Start<'a> {
    depth: &'a [Array2<f64>; 2],
    /// [`Trial::reach`] before.
    reach: &'a [Array2<f64>; 2],
    solution: &'a Solution,
    /// Pressure that wears there.
    pressure: &'a Array2<f64>,
    slipping: Slipping,
    idle: Option<Idle>,
    /// Weight θ of the ends of steps; `None` where the scheme and the step choose it.
    weight: Option<f64>,
}

/// Where surfaces slip in a step.
#[derive(Clone)]
enum Slipping {
    /// Slip of each cell per unit of the distance.
    Cells(Array2<f64>),
    /// Σ |slip| p \[N/m\] along the track of a wheel.
    Track(Array2<f64>),
}

/// The end of one step.
#[derive(Debug)]
struct Trial {
    length: f64,
    depth: [Array2<f64>; 2],
    /// Depths if all that is below the next layer wore at the rate of this layer: they pass its bottom whatever lies there.
    reach: [Array2<f64>; 2],
    solution: Solution,
    /// Pressure that wears at the end, where it is not that of the solution: [`worn_by`].
    pressure: Option<Array2<f64>>,
    /// Weight θ of the end; of two halves the larger.
    weight: f64,
    /// Whether the search for the distance at which a layer is through came to its end.
    settled: bool,
}

impl Trial {
    /// A step in which nothing wears.
    fn at_rest(length: f64, [depth, reach]: [[Array2<f64>; 2]; 2], solution: Solution) -> Self {
        Self { length, depth, reach, solution, pressure: None, weight: 1.0, settled: true }
    }

    fn wearing(&self) -> &Array2<f64> {
        self.pressure.as_ref().unwrap_or(&self.solution.pressure)
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
        for depth in wear.initial.iter().flatten() {
            same_shape("initial", depth, grid.shape())?;
            none_negative("initial", depth)?;
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
            through: [0; 2],
            ended: false,
            last: None,
            start: None,
            change: None,
            twin: None,
            peak: 0.0,
            convolutions: Mutex::new(0.0),
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
        let peak = next.as_ref().map_or(0.0, |state| state.solution.peak_pressure());
        self.peak = self.peak.max(peak);
        self.last = next.clone().or(last);
        Ok(next)
    }

    /// The contact before any sliding.
    fn first(&mut self, progress: &mut Progress) -> Result<Option<WearState>> {
        let zeros = || Array2::zeros(self.plan.grid().shape());
        let depth = self.wear.initial.clone().unwrap_or_else(|| [zeros(), zeros()]);
        let solution = self.solved(&depth[0] + &depth[1], Some(&depth), None, None, progress)?;
        let mut through = self.through_at(0.0, 0.0, [&depth, &depth]);
        if self.wear.goes_on {
            through.clear();
        }
        self.spent();
        Ok(solution.map(|solution| WearState {
            distance: 0.0,
            depth,
            solution,
            through,
            step_error: 0.0,
            peak_error: 0.0,
            rings: false,
            settled: true,
            regrids: 0,
            idle: None,
        }))
    }

    /// Error of the last pressure by the thickness of the layers, the largest within the contact and of the peak, relative to the
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
        let worn = self.worn(&last.depth);
        let other = plan.run(|| plan.solve_alone(&worn, &self.motion, &options, progress))?;
        let even = means.map(|mean| Array2::from_elem(pressure.dim(), mean));
        let even = self
            .thinned_plan(&even)
            .map(|plan| plan.run(|| plan.solve_alone(&worn, &self.motion, &options, progress)));
        let even = even.transpose()?;
        if !even.iter().chain([&other]).all(|solution| solution.report.converged()) {
            return Ok(None);
        }
        let pressure = even.as_ref().map_or(pressure, |even| &even.pressure);
        let both = [pressure, pressure, &other.pressure];
        let apart = Zip::indexed(pressure).and(&other.pressure);
        let apart = apart.fold(0.0_f64, |most, at, p, other| {
            if is_within(both, at) { most.max((p - other).abs()) } else { most }
        });
        let peaks = [pressure, &other.pressure].map(|p| p.fold(0.0_f64, |most, p| most.max(*p)));
        let peak = peaks[0].min(peaks[1]);
        Ok((peak > 0.0).then_some(apart.max((peaks[0] - peaks[1]).abs()) / peak))
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
        *self.convolutions.lock().unwrap_or_else(PoisonError::into_inner) +=
            solution.report.convolutions;
        if solution.report.termination == Termination::Stopped {
            return Ok(None);
        }
        refuse_if(
            thinned.is_some() && !solution.report.converged(),
            "thickness must be \"frozen\" here: to first order in the depth, the contact of so thin a layer did not converge",
        )?;
        solution.require_converged(options.tolerance).map(Some)
    }

    /// Convolutions since this was asked the last time.
    fn spent(&self) -> f64 {
        std::mem::take(&mut *self.convolutions.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The state after `last`, which is on the grid of the plan then.
    fn step(&mut self, last: &mut WearState, progress: &mut Progress) -> Result<Option<WearState>> {
        loop {
            let Some(left) = self.left(last.distance) else {
                return Ok(None);
            };
            let (start, before) = (self.start.take(), self.twin.take());
            let pressure = start.as_ref().unwrap_or(&last.solution.pressure);
            let begun = self.begun([&last.depth; 2], &last.solution, pressure, progress)?;
            let Some(begun) = begun else { return Ok(None) };
            let pair = self.controlled(&begun, before.as_ref(), left, progress)?;
            let Some((mut trial, twin)) = pair else { return Ok(None) };
            if let Some(most) = self.most_cells
                && let grow = self.touched(&trial.solution)
                && grow != [false; 2]
            {
                let wider = self.regrid(last, before.as_ref(), grow, most, progress)?;
                let Some(wider) = wider else { return Ok(None) };
                *last = wider;
                continue;
            }
            let is_end = trial.length >= left * (1.0 - 1e-12);
            let distance = match (&self.wear.steps, is_end) {
                (WearSteps::Auto { end, .. }, true) => *end,
                (WearSteps::Ends(_), true) => last.distance + left,
                _ => last.distance + trial.length,
            };
            let error = ERROR * self.apart_in_distance(&begun, [&trial, &twin]);
            let idle = begun.idle;
            let through = self.through_at(distance, error, [&trial.reach, &trial.depth]);
            let change = &trial.solution.pressure - &last.solution.pressure;
            let peak = trial.solution.peak_pressure();
            let rings = self.wear.scheme == WearScheme::Trapezoidal
                && self.change.as_ref().is_some_and(|(before, _)| {
                    correlation(&change, before, LEAST_CHANGE * peak) < RINGING
                });
            self.change = through.is_empty().then_some((change, trial.length));
            let pressures = Zip::from(&trial.solution.pressure).and(&twin.solution.pressure);
            let apart = pressures.fold(0.0_f64, |most, p, other| most.max((p - other).abs()));
            let peak_error = ERROR * (peak - twin.solution.peak_pressure()).abs();
            self.start = trial.pressure;
            self.twin = Some(twin);
            trial.solution.report.convolutions = self.spent();
            return Ok(Some(WearState {
                distance,
                depth: trial.depth,
                solution: trial.solution,
                through,
                peak_error: if peak > 0.0 { peak_error / peak } else { 0.0 },
                step_error: if apart > 0.0 { ERROR * apart / peak } else { 0.0 }
                    .max(OF_SOLVES * self.wear.options.tolerance),
                rings,
                settled: trial.settled,
                regrids: last.regrids,
                idle,
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

    /// A step of a length that the error permits, which ends where a layer is through, and its twin, after that `before`.
    fn controlled(
        &mut self,
        begun: &Start,
        before: Option<&Trial>,
        left: f64,
        progress: &mut Progress,
    ) -> Result<Option<(Trial, Trial)>> {
        let mut beside = begun.clone();
        if let Some(twin) = before {
            (beside.depth, beside.reach) = (&twin.depth, &twin.depth);
            beside.solution = &twin.solution;
        }
        let WearSteps::Auto { tolerance, .. } = self.wear.steps else {
            let trial = self.trial(begun, left, self.expected(begun, left), progress)?;
            let Some(trial) = trial else { return Ok(None) };
            let Some(trial) = self.until_through(begun, trial, progress)? else {
                return Ok(None);
            };
            beside.pressure = before.map_or(begun.pressure, Trial::wearing);
            let twin = self.halved(&beside, trial.length, &trial.solution.pressure, progress)?;
            return Ok(twin.map(|twin| (trial, twin)));
        };
        // By the pressure that wears the halves, whole steps keep no wave that changes its sign: errors fade at half their rate
        // or faster.
        let mut length = self.length.unwrap_or_else(|| self.first_length(begun)).min(left);
        loop {
            let expected = self.expected(&beside, length);
            let Some(whole) = self.trial(&beside, length, expected, progress)? else {
                return Ok(None);
            };
            let Some(halves) = self.halved(begun, length, &whole.solution.pressure, progress)?
            else {
                return Ok(None);
            };
            let error = self.added_error([begun, &beside], [&halves, &whole]);
            let order = if self.is_second_order() { 3.0 } else { 2.0 };
            let factor = SAFETY * (tolerance / error.max(1e-9 * tolerance)).powf(1.0 / order);
            let is_idle = error <= OF_SOLVES * self.wear.options.tolerance;
            let most = if is_idle { IDLE_CHANGE } else { CHANGE[1] };
            let next = length * factor.clamp(CHANGE[0], most);
            if error <= tolerance {
                self.length = Some(if length < left { next } else { next.max(length) });
                let Some(trial) = self.until_through(begun, halves, progress)? else {
                    return Ok(None);
                };
                if trial.length >= length {
                    return Ok(Some((trial, whole)));
                }
                let expected = trial.solution.pressure.clone();
                let twin = self.trial(&beside, trial.length, expected, progress)?;
                return Ok(twin.map(|twin| (trial, twin)));
            }
            length = next.min(0.8 * length);
        }
    }

    /// Error that a step adds to the pressure: what the ends of its halves and of the whole step differ by more than their
    /// `starts` did, relative to the largest pressure of the history: at a given approach, hardly any may be left.
    fn added_error(&self, starts: [&Start; 2], ends: [&Trial; 2]) -> f64 {
        let [start, whole_start] = starts.map(|start| &start.solution.pressure);
        let [end, whole_end] = ends.map(|end| &end.solution.pressure);
        let apart = Zip::from(end).and(whole_end).and(start).and(whole_start);
        let apart = apart.map_collect(|end, whole, start, before| (whole - before) - (end - start));
        let error = mean_within([start, whole_end, end], &apart);
        let orders = if self.is_second_order() { 3.0 } else { 1.0 };
        if error > 0.0 { error / (orders * self.peak) } else { 0.0 }
    }

    fn is_second_order(&self) -> bool {
        self.wear.scheme == WearScheme::Trapezoidal && !matches!(self.wear.slip, Slip::Pass(..))
    }

    /// Length of the first step.
    fn first_length(&self, begun: &Start) -> f64 {
        let solution = begun.solution;
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

    /// Where a step begins at a depth, and with what reach; `pressure` wears there. `None` where it was stopped.
    fn begun<'a>(
        &self,
        [depth, reach]: [&'a [Array2<f64>; 2]; 2],
        solution: &'a Solution,
        pressure: &'a Array2<f64>,
        progress: &mut Progress,
    ) -> Result<Option<Start<'a>>> {
        let slipping = self.slipping(depth, solution, progress)?;
        Ok(slipping.map(|(slipping, idle)| Start {
            depth,
            reach,
            solution,
            pressure,
            slipping,
            idle,
            weight: None,
        }))
    }

    /// Where worn bodies slip, and why nowhere; `None` where it was stopped.
    fn slipping(
        &self,
        depth: &[Array2<f64>; 2],
        solution: &Solution,
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
                let solutions = self.moved(depth, solution, moves, options, progress)?;
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
                let solutions = self.moved(depth, solution, moves, options, progress)?;
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
        depth: &[Array2<f64>; 2],
        solution: &Solution,
        moves: impl Iterator<Item = Move<'m>> + Send,
        options: &FrictionOptions,
        progress: &mut Progress,
    ) -> Result<Option<Vec<FrictionSolution>>> {
        let worn = self.worn(depth);
        let tell = &mut |_: &FrictionReport| progress(&solution.report);
        self.plan.friction_cycle(&worn, moves, options, tell)
    }

    /// Pressure that is to be expected at the end of a step: it goes on as in the step before, and no further where the step
    /// is longer, as pressures fall ever more slowly. That takes a fifth of the iterations less than from the last pressure; a
    /// parabola through three takes half as many more than the line, as cells at the edge jump.
    fn expected(&self, begun: &Start, length: f64) -> Array2<f64> {
        let now = &begun.solution.pressure;
        match &self.change {
            Some((change, over)) if change.dim() == now.dim() => {
                let fraction = (length / over).min(1.0);
                Zip::from(now).and(change).map_collect(|p, change| (p + fraction * change).max(0.0))
            }
            _ => now.clone(),
        }
    }

    /// A step in two halves, whose end is `expected` at this pressure.
    fn halved(
        &self,
        begun: &Start,
        length: f64,
        expected: &Array2<f64>,
        progress: &mut Progress,
    ) -> Result<Option<Trial>> {
        let middle = 0.5 * (&begun.solution.pressure + expected);
        let Some(half) = self.trial(begun, 0.5 * length, middle, progress)? else {
            return Ok(None);
        };
        let from = [&half.depth, &half.reach];
        let Some(middle) = self.begun(from, &half.solution, half.wearing(), progress)? else {
            return Ok(None);
        };
        let middle = Start { weight: begun.weight, ..middle };
        let end = self.trial(&middle, 0.5 * length, expected.clone(), progress)?;
        Ok(end.map(|end| Trial { length, weight: end.weight.max(half.weight), ..end }))
    }

    /// The step, or the shorter one at whose end the first cell of a layer is through.
    fn until_through(
        &self,
        begun: &Start,
        trial: Trial,
        progress: &mut Progress,
    ) -> Result<Option<Trial>> {
        let is_before = |depth: &[Array2<f64>; 2]| self.part_of_layer(depth) <= 1.0 + MOMENT;
        if is_before(&trial.reach) && is_before(&trial.depth) {
            return Ok(Some(trial));
        }
        // The depth is continuous in the length by one rule.
        let begun = &Start { weight: Some(trial.weight), ..begun.clone() };
        let is_halved = matches!(self.wear.steps, WearSteps::Auto { .. });
        let mut step = |length: f64, expected: &Array2<f64>| match is_halved {
            true => self.halved(begun, length, expected, progress),
            false => self.trial(begun, length, expected.clone(), progress),
        };
        let mut trial = trial;
        if is_before(&trial.reach) {
            // Rates of what lies below did not settle: it takes no part before the layer is through.
            let Some(settled) = step(trial.length, &trial.solution.pressure)? else {
                return Ok(None);
            };
            trial = settled;
            if is_before(&trial.reach) {
                return Ok(Some(trial));
            }
        }
        let fraction = self.part_of_layer(&trial.reach);
        // Length, and what the part lacks or has beyond; a side that stays counts half (the Illinois method).
        let mut least = [0.0, 1.0 - self.part_of_layer(begun.depth)];
        let mut most = [trial.length, fraction - 1.0];
        let mut was_beyond = true;
        // The depth jumps, by what a pressure is known to: the nearest trial counts.
        let (mut off, mut nearest) = (fraction - 1.0, trial);
        for _ in 0..TRIALS {
            let [[a, lacks], [b, beyond]] = [least, most];
            let length = a + (b - a) * lacks / (lacks + beyond);
            let Some(next) = step(length, &nearest.solution.pressure)? else { return Ok(None) };
            let fraction = self.part_of_layer(&next.reach);
            let is_beyond = fraction > 1.0;
            let [own, other] =
                if is_beyond { [&mut most, &mut least] } else { [&mut least, &mut most] };
            *own = [next.length, (fraction - 1.0).abs()];
            if was_beyond == is_beyond {
                other[1] *= 0.5;
            }
            was_beyond = is_beyond;
            if (fraction - 1.0).abs() < off {
                (off, nearest) = ((fraction - 1.0).abs(), next);
            }
            if off <= MOMENT {
                return Ok(Some(nearest));
            }
        }
        Ok(Some(Trial { settled: off <= THROUGH, ..nearest }))
    }

    /// Cell whose depth is the largest part of that of the bottom of the next layer of its body, and this part; 1 where it is just
    /// through. `None` where no layer is left.
    fn furthest(&self, reach: &[Array2<f64>; 2]) -> Option<(f64, usize, (usize, usize))> {
        let bodies = (0..2).filter_map(|k| Some((k, *self.rates[k].bottoms.get(self.through[k])?)));
        let cells = bodies.flat_map(|(k, bottom)| {
            reach[k].indexed_iter().map(move |(at, depth)| (depth / bottom, k, at))
        });
        cells.max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Part of [`Self::furthest`].
    fn part_of_layer(&self, reach: &[Array2<f64>; 2]) -> f64 {
        self.furthest(reach).map_or(0.0, |(fraction, ..)| fraction)
    }

    /// Difference of the distances at which a layer is through where a step ends at it, and its twin does before or after; 0 where
    /// none is. Depths go on as they grow at the end of the step: of the two ends, that at which more is worn, and where neither
    /// wears, as in the step.
    fn apart_in_distance(&self, begun: &Start, ends: [&Trial; 2]) -> f64 {
        let (fraction, k, at) = match self.furthest(&ends[0].reach) {
            Some(furthest) if furthest.0 >= 1.0 - THROUGH => furthest,
            _ => return 0.0,
        };
        let (rates, layer) = (&self.rates[k], self.through[k]);
        let growth = ends.map(|end| match &begun.slipping {
            Slipping::Cells(slip) => rates.of(layer) * slip[at] * end.wearing()[at],
            Slipping::Track(track) => rates.of(layer) * track[at],
        });
        let mut growth = growth[0].max(growth[1]);
        if growth <= 0.0 {
            growth = (ends[0].reach[k][at] - begun.depth[k][at]) / ends[0].length;
        }
        let apart = (fraction - self.part_of_layer(&ends[1].reach)).abs().max(THROUGH);
        apart * rates.bottoms[layer] / growth
    }

    /// Layers that are through with this reach and at this depth, and were not before; the distance errs by `error`.
    fn through_at(
        &mut self,
        distance: f64,
        error: f64,
        [reach, depth]: [&[Array2<f64>; 2]; 2],
    ) -> Vec<WearThrough> {
        let grid = self.plan.grid();
        let mut events = Vec::new();
        for (k, member) in [Member::Body, Member::Counterbody].into_iter().enumerate() {
            let cells = reach[k].indexed_iter().max_by(|a, b| a.1.total_cmp(b.1));
            let Some(((i, j), mut deepest)) = cells else { continue };
            while let Some(bottom) = self.rates[k].bottoms.get(self.through[k])
                && *deepest >= bottom * (1.0 - THROUGH)
            {
                let (layer, position) = (self.through[k], [grid.x()[i], grid.y()[j]]);
                events.push(WearThrough { distance, error, position, layer, member });
                self.through[k] += 1;
                // Its rate does not hold below it.
                deepest = &depth[k][[i, j]];
            }
        }
        events
    }

    /// One step of this `length`, whose end is `expected` at this pressure. Cells that have just come into contact would carry too
    /// much by the trapezoidal rule, as their start counts without them or with a part of the step: where one of them then wears
    /// faster than any cell did, or that opens a cell which wore, the step is Euler's.
    fn trial(
        &self,
        begun: &Start,
        length: f64,
        expected: Array2<f64>,
        progress: &mut Progress,
    ) -> Result<Option<Trial>> {
        let weight = begun.weight.unwrap_or(if self.is_second_order() { 0.5 } else { 1.0 });
        let is_free = begun.weight.is_none() && weight < 1.0;
        match self.trial_by(weight, begun, length, expected, progress)? {
            Some(trial) if is_free && self.overshoots(begun, &trial) => {
                self.trial_by(1.0, begun, length, trial.solution.pressure, progress)
            }
            trial => Ok(trial),
        }
    }

    /// Whether a cell that owes most of its depth to the step wears faster at its end than any did at its start, or one that wore is
    /// out of contact.
    fn overshoots(&self, begun: &Start, end: &Trial) -> bool {
        let Slipping::Cells(slip) = &begun.slipping else { return false };
        let work = Zip::from(slip).and(begun.pressure);
        let most = work.fold(0.0_f64, |most, slip, p| most.max(slip * p));
        let [before, after] = [begun.depth, &end.depth].map(|depth| &depth[0] + &depth[1]);
        let ends = Zip::from(slip).and(end.wearing());
        let is_new_peak = ends.and(&before).and(&after).any(|slip, p, before, after| {
            slip * p > most * (1.0 + LEAST_CHANGE) && after - before > *before
        });
        let ends = Zip::from(slip).and(end.wearing()).and(begun.pressure);
        is_new_peak || ends.any(|slip, p, before| *p <= 0.0 && slip * before > most * LEAST_CHANGE)
    }

    /// One step of this `length`, whose end has a weight and is `expected` at this pressure.
    fn trial_by(
        &self,
        weight: f64,
        begun: &Start,
        length: f64,
        expected: Array2<f64>,
        progress: &mut Progress,
    ) -> Result<Option<Trial>> {
        if self.rates.iter().all(Rates::vanish) {
            let (depth, reach) = (begun.depth.clone(), begun.reach.clone());
            let solution = begun.solution.clone();
            let trial = Trial::at_rest(length, [depth, reach], solution);
            return Ok(Some(trial));
        }
        // Work \[N/m\] of the start of the step, and what its end adds per pressure.
        let (first, per_pressure) = match &begun.slipping {
            Slipping::Track(track) => (track * length, Array2::zeros(track.dim())),
            Slipping::Cells(slip) => {
                (slip * begun.pressure * (length * (1.0 - weight)), slip * (length * weight))
            }
        };
        let mut rates = [0, 1].map(|k| match self.rates[k].uniform() {
            Some(rate) => Array2::from_elem(begun.depth[k].dim(), rate),
            None => begun.depth[k].mapv(|depth| self.rates[k].at(depth)),
        });
        let work = |pressure: &Array2<f64>| {
            let cells = Zip::from(&per_pressure).and(pressure).and(&first);
            cells.map_collect(|per_pressure, p, first| per_pressure * p + first)
        };
        // Depths by which layers are thinner.
        let mut missing = self.layers.as_ref().map(|_| {
            let work = work(&expected);
            [0, 1].map(|k| &begun.depth[k] + &(&rates[k] * &work))
        });
        // Where a step is to end as a layer is through, nothing below it wears.
        let last = [0, 1].map(|k| match begun.weight {
            Some(_) => self.through[k],
            None => self.rates[k].bottoms.len(),
        });
        let mut initial = expected;
        for round in 1.. {
            let cells = Zip::from(&rates[0]).and(&rates[1]);
            let springs = cells.and(&per_pressure).map_collect(|a, b, work| (a + b) * work);
            let cells =
                Zip::from(&begun.depth[0]).and(&begun.depth[1]).and(&rates[0]).and(&rates[1]);
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
            let mut reached = begun.depth.clone();
            let mut changed = 0.0_f64;
            for (k, (rates, depth)) in rates.iter_mut().zip(&mut reached).enumerate() {
                match self.rates[k].uniform() {
                    Some(rate) if rate > 0.0 => depth.scaled_add(rate, &work),
                    Some(_) => (),
                    None => Zip::from(rates).and(depth).and(&work).for_each(|rate, depth, work| {
                        let mean = self.rates[k].mean_above(last[k], *depth, *work);
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
                let reach = [0, 1].map(|k| {
                    let cells = Zip::from(&begun.reach[k]).and(&work);
                    cells.map_collect(|from, work| {
                        from + self.rates[k].mean_above(self.through[k], *from, *work) * work
                    })
                });
                let depth = reached;
                let trial =
                    Trial { length, depth, reach, solution, pressure, weight, settled: true };
                return Ok(Some(trial));
            }
            missing = self.layers.as_ref().map(|_| reached);
            initial = solution.pressure;
        }
        unreachable!("the loop ends by its limit")
    }

    /// The shape on the worn bodies.
    fn worn(&self, depth: &[Array2<f64>; 2]) -> OffsetShape<&dyn Surface> {
        let worn = &depth[0] + &depth[1];
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
        twin: Option<&Trial>,
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
        (self.change, self.start) = (None, None);
        let mut solved = |depth: &[Array2<f64>; 2]| {
            let depth = depth.each_ref().map(|depth| regridded(depth, &from, &grid));
            let solution =
                self.solved(&depth[0] + &depth[1], Some(&depth), None, None, progress)?;
            Ok::<_, Error>(solution.map(|solution| (depth, solution)))
        };
        let Some((depth, solution)) = solved(&last.depth)? else { return Ok(None) };
        if let Some(twin) = twin {
            let Some((depth, solution)) = solved(&twin.depth)? else { return Ok(None) };
            let (length, reach) = (0.0, depth.clone());
            let twin = Trial::at_rest(length, [depth, reach], solution);
            self.twin = Some(twin);
        }
        Ok(Some(WearState { depth, solution, regrids: last.regrids + 1, ..last.clone() }))
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

/// Whether a cell is in contact with all its neighbours under all pressures. At the edge, pressures differ by which cells the
/// contact covers, however short a step is.
fn is_within(pressures: [&Array2<f64>; 3], (i, j): (usize, usize)) -> bool {
    let carries = |i: usize, j: usize| pressures.iter().all(|p| p[[i, j]] > 0.0);
    let (nx, ny) = pressures[0].dim();
    let around = |i: usize, n: usize| i.saturating_sub(1)..(i + 2).min(n);
    around(i, nx).all(|k| around(j, ny).all(|l| carries(k, l)))
}

/// Root of the mean square of `apart` within the contact under all `pressures`, over all cells where there are none.
fn mean_within(pressures: [&Array2<f64>; 3], apart: &Array2<f64>) -> f64 {
    let squares = |member: &dyn Fn((usize, usize)) -> bool| {
        let (mut sum, mut cells) = (0.0, 0.0);
        for (_, apart) in apart.indexed_iter().filter(|(at, _)| member(*at)) {
            sum += apart * apart;
            cells += 1.0;
        }
        (cells > 0.0).then(|| f64::sqrt(sum / cells))
    };
    squares(&|at| is_within(pressures, at)).or_else(|| squares(&|_| true)).unwrap_or(0.0)
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
                let [a, b] = [before, after].map(|solution| solution.displacement[axis][[i, j]]);
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
