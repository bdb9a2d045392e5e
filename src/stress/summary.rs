//! Summary of a stress field: peaks in each layer, tractions at each interface.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use super::field::{Extreme, Largest, LargestWithError, Peak, Percent, SmallerCells, Tensor};
use super::half_space::plane_arrays;
use super::options::{SlidingSense, StressOptions, StressProgress, WatchedStress};
use super::outside_grid::{OutsideGrid, SAMPLED};
use super::outside_patch::OutsidePatch;
use super::plan::{Evaluation, PressureSource, StressPlan};
use super::subcell::{
    CellPoint, EdgeFit, ErrorOf, LocalSteps, PointStress, STRESSES, StepErrors, around,
};
use crate::compliance::response::interior::Place;
use crate::compliance::response::substrate_material;
use crate::error::{Result, positive, refuse_if};
use crate::model::body::{HalfSpace, Layer};
use crate::model::grid::{Grid, Window, full_window};
use crate::numerics::parallel::{check_memory, memory_of};

/// Strengths of the layers from the surface down, then of the substrate. None, or a shorter list:
/// not known.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Strengths {
    /// Yield stresses \[Pa\], which von Mises' stress is compared with.
    pub yield_stress: Vec<Option<f64>>,
    /// Tensile strengths \[Pa\], which the largest principal stress is compared with.
    pub strength: Vec<Option<f64>>,
}

builders! {
    Strengths {
        with_yield_stress(yield_stress: Vec<Option<f64>>),
        with_strength(strength: Vec<Option<f64>>),
    }
}

/// The extremes in one layer, or in the substrate.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[non_exhaustive]
pub struct LayerSummary {
    /// Number of the layer, from the surface down; the substrate's is the number of layers.
    pub layer: usize,
    /// Name of the layer, if it has one; the substrate has none.
    pub name: Option<String>,
    /// Depths of the top and bottom faces \[m\]; the substrate's bottom is at infinity.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "depths"))]
    pub depths: [f64; 2],
    /// Largest von Mises stress.
    pub von_mises: Peak,
    /// Largest principal stress: tension where it is positive.
    pub tension: Peak,
    /// Largest shear stress on any plane.
    #[cfg_attr(feature = "serde", serde(rename = "max_shear"))]
    pub shear: Peak,
    /// Safety factor against yield: the yield stress divided by the largest von Mises stress.
    pub yield_safety_factor: Option<f64>,
    /// Safety factor against fracture: the tensile strength divided by the largest tension; none where
    /// there is no tension.
    pub strength_safety_factor: Option<f64>,
}

/// Depths of two faces, of which the lower one is infinite where it is null, as JSON has it.
#[cfg(feature = "serde")]
fn depths<'de, D: serde::Deserializer<'de>>(of: D) -> std::result::Result<[f64; 2], D::Error> {
    let (top, bottom) = <(f64, Option<f64>) as serde::Deserialize>::deserialize(of)?;
    Ok([top, bottom.unwrap_or(f64::INFINITY)])
}

/// The extremes at one interface.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[non_exhaustive]
pub struct InterfaceSummary {
    /// Number of the interface, from the surface down.
    pub interface: usize,
    /// Depth of the interface \[m\].
    pub depth: f64,
    /// Largest normal traction σ_zz: tension where it is positive.
    pub tension: Peak,
    /// Smallest normal traction σ_zz.
    pub compression: Peak,
    /// Largest shear traction √(σ_xz² + σ_yz²).
    pub shear: Peak,
    /// Largest jump of the in-plane stress from above to below, as the larger principal value of
    /// its magnitude; none on a rigid base.
    pub jump: Option<Peak>,
}

/// The extremes of all layers and interfaces.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[non_exhaustive]
pub struct StressSummary {
    /// Layers from the surface down; the substrate last, unless it is rigid.
    pub layers: Vec<LayerSummary>,
    /// Interfaces from the surface down.
    pub interfaces: Vec<InterfaceSummary>,
    /// Whether all was done. If `progress` stopped it, layers and interfaces are those finished before.
    pub finished: bool,
}

/// Estimated error over an extreme above which a warning says so. The estimate is some three times the
/// error (`tests/stress/resolution.rs`).
const UNRESOLVED_EXTREME: f64 = 0.25;

/// Error, over the largest von Mises stress of all layers, below which a warning says nothing.
const NEGLIGIBLE_ERROR: f64 = 0.02;

impl StressSummary {
    /// Warnings about what the cells do not resolve: layers and interfaces whose extremes have an estimated
    /// error above a quarter of them.
    pub fn warnings(&self) -> Vec<String> {
        let negligible = self.negligible_error();
        let largest = negligible / NEGLIGIBLE_ERROR;
        // Compression everywhere is no tension to be known.
        let pulls = |peak: &&Peak| peak.value + peak.uncertainty.unwrap_or(0.0) > 0.0;
        // What is unresolved, and the factor by which its largest error has to fall.
        let unresolved = |peaks: &[(&str, Option<&Peak>)]| -> Option<(String, f64)> {
            let excess = |(name, peak): &(&str, Option<&Peak>)| {
                let Peak { value, uncertainty, .. } = (*peak)?;
                let error = (*uncertainty)?;
                let ratio = error / value.abs();
                let excess = (ratio / UNRESOLVED_EXTREME).min(error / negligible);
                let size = match ratio < 1.0 {
                    true => Percent(ratio).to_string(),
                    false => format!("{:.2} of the largest von Mises stress", error / largest),
                };
                (excess > 1.0).then(|| (format!("{name} by {size}"), excess))
            };
            let (texts, excesses): (Vec<_>, Vec<_>) = peaks.iter().filter_map(excess).unzip();
            let largest = excesses.into_iter().reduce(f64::max)?;
            Some((texts.join(", "), largest))
        };
        let layers = self.layers.iter().filter_map(|layer| {
            let LayerSummary { von_mises, tension, shear, .. } = layer;
            let tension = Some(tension).filter(pulls);
            let peaks =
                [("von Mises", Some(von_mises)), ("tension", tension), ("shear", Some(shear))];
            let unresolved = unresolved(&peaks)?;
            let place = match layer.depths[1].is_finite() {
                true => format!("layers[{}]", layer.layer),
                false => "the substrate".to_string(),
            };
            Some((place, unresolved))
        });
        let interfaces = self.interfaces.iter().filter_map(|face| {
            let InterfaceSummary { tension, compression, shear, jump, .. } = face;
            let tension = Some(tension).filter(pulls);
            let peaks = [("shear", Some(shear)), ("compression", Some(compression))];
            let others = [("tension", tension), ("jump", jump.as_ref())];
            let peaks = [peaks, others].concat();
            Some((format!("interfaces[{}]", face.interface), unresolved(&peaks)?))
        });
        let warning = |(place, (extremes, excess)): (String, (String, f64))| {
            format!(
                "the extremes in {place} are uncertain, {extremes}, due to the size of the cells: take {}",
                SmallerCells(excess)
            )
        };
        layers.chain(interfaces).map(warning).collect()
    }
}

impl StressSummary {
    /// Error below which an extreme counts as known.
    pub(super) fn negligible_error(&self) -> f64 {
        let peaks = self.layers.iter().map(|layer| layer.von_mises.value);
        NEGLIGIBLE_ERROR * peaks.fold(0.0, f64::max)
    }

    /// Value below which an extreme matters no more than this one: its error is negligible where it is resolved.
    pub(super) fn least_value(&self) -> f64 {
        self.negligible_error() / UNRESOLVED_EXTREME
    }
}

/// The extremes of a body, three of each layer and of the substrate, then four of each interface; no jump on a rigid base.
#[derive(Debug, Clone, Default)]
pub(super) struct Extremes {
    pub(super) values: Vec<Extreme>,
    /// Of each, the largest sum of a value and its error in each cell, over all depths, where it is recorded.
    pub(super) bounds: Vec<Vec<f64>>,
    /// Of each, that beyond the grid, where bounds are recorded.
    pub(super) beyond: Vec<Extreme>,
    /// Whether all was done.
    pub(super) finished: bool,
}

/// Number of extremes of a layer, and of an interface.
const OF_LAYER: usize = 3;
const OF_INTERFACE: usize = 4;

impl Extremes {
    /// The summary of a body of which these are the extremes.
    pub(super) fn summary(&self, body: &HalfSpace, strengths: &Strengths) -> StressSummary {
        let members = body.layers().len() + usize::from(substrate_material(body).is_some());
        let (of_layers, of_interfaces) =
            self.values.split_at(self.values.len().min(OF_LAYER * members));
        let tops = std::iter::once(0.0).chain(bottoms(body));
        let bottoms_and_end = bottoms(body).chain([f64::INFINITY]);
        let layers = of_layers.chunks(OF_LAYER).zip(tops.zip(bottoms_and_end)).enumerate();
        let layers = layers.map(|(number, (extremes, (top, bottom)))| {
            let own = body.layers().get(number);
            let mut layer = LayerSummary {
                layer: number,
                name: own.and_then(Layer::name).map(String::from),
                depths: [top, bottom],
                yield_safety_factor: None,
                strength_safety_factor: None,
                von_mises: extremes[0].peak(),
                tension: extremes[1].peak(),
                shear: extremes[2].peak(),
            };
            layer.compare(strengths);
            layer
        });
        let interfaces = of_interfaces.chunks(OF_INTERFACE).zip(bottoms(body)).enumerate();
        let interfaces = interfaces.map(|(interface, (extremes, depth))| InterfaceSummary {
            interface,
            depth,
            tension: extremes[0].peak(),
            compression: extremes[1].negative_peak(),
            shear: extremes[2].peak(),
            jump: extremes.get(3).map(|jump| jump.peak()),
        });
        StressSummary {
            layers: layers.collect(),
            interfaces: interfaces.collect(),
            finished: self.finished,
        }
    }

    /// The extremes of the places of both.
    pub(super) fn with(&self, other: &Self) -> Self {
        Self { finished: self.finished && other.finished, ..self.with_values(&other.values) }
    }

    /// The extremes of these places and of others.
    pub(super) fn with_values(&self, others: &[Extreme]) -> Self {
        let pairs = self.values.iter().zip(others);
        Self {
            values: pairs.map(|(one, other)| one.with(*other)).collect(),
            finished: self.finished,
            ..Self::default()
        }
    }
}

/// Depths of the bottom faces of the layers.
fn bottoms(body: &HalfSpace) -> impl Iterator<Item = f64> {
    let below = |depth: &mut f64, layer: &Layer| {
        *depth += layer.thickness();
        Some(*depth)
    };
    body.layers().iter().scan(0.0, below)
}

/// The place of an extreme of [`Extremes`] with this number, at a depth in a body of these layers.
pub(super) fn place_of(body: &HalfSpace, which: usize, depth: f64) -> Place {
    let substrate = usize::from(substrate_material(body).is_some());
    let count = body.layers().len();
    let (layer, is_below) = match which.checked_sub(OF_LAYER * (count + substrate)) {
        None => (which / OF_LAYER, false),
        Some(which) if which % OF_INTERFACE == 3 => (which / OF_INTERFACE + 1, true),
        Some(which) => (which / OF_INTERFACE, false),
    };
    let top: f64 = body.layers()[..layer.min(count)].iter().map(Layer::thickness).sum();
    let below_top = if is_below { 0.0 } else { (depth - top).max(0.0) };
    let own = body.layers().get(layer).map(Layer::material);
    let material =
        own.or(substrate_material(body)).unwrap_or_else(|| body.layers()[count - 1].material());
    Place { layer, below_top, depth, material }
}

impl LayerSummary {
    /// Sets the safety factors, where the strengths are known.
    fn compare(&mut self, strengths: &Strengths) {
        let [yield_stress, strength] = strengths.of_layer(self.layer);
        let factor = |strength: Option<f64>, peak: Peak| {
            let strength = strength.filter(|_| peak.value > 0.0);
            strength.map(|strength| strength / peak.value)
        };
        self.yield_safety_factor = factor(yield_stress, self.von_mises);
        self.strength_safety_factor = factor(strength, self.tension);
    }
}

/// How many times a peak inside a layer is refined by a parabola.
const REFINEMENTS: usize = 3;

impl StressPlan {
    /// Peaks in each layer and tractions at each interface. `side`, `section` and `displacement` of the
    /// options are not used. A callback of [`StressOptions::watched`] is told the fraction done.
    ///
    /// Depths are the faces of the layers, and some 18 inside each, spread over its thickness and over
    /// the width of the contact; a peak inside is then refined by parabolas through three depths
    /// (successive parabolic interpolation). Positions are cell centres, or points at the edge of the contact. Where
    /// the largest value at a depth lies on the border of the grid, and as far as layers bend, wider grids are searched.
    ///
    /// # Errors
    /// Bad options, a strength that is not finite and above 0, or too little memory.
    pub fn summary<'a>(
        &self,
        strengths: &Strengths,
        options: impl Into<WatchedStress<'a>>,
    ) -> Result<StressSummary> {
        let mut watched_options = options.into();
        let (body, grid) = (&self.whole.body, &self.whole.grid);
        let request = SummaryRequest::checked(
            body,
            grid,
            &self.sliding,
            strengths,
            watched_options.options(),
        )?;
        check_memory(grid.shape(), request.memory)?;
        refuse_if(
            watched_options.options().refine.is_some(),
            "refine must be None where the tractions of a contact are known, and in the summary of a plan: \
             Solution.stress_summary of a contact without friction solves finer cells",
        )?;
        let scope = Scope::of(self);
        Ok(request
            .evaluate(self, scope, &mut |fraction| watched_options.tell(fraction))
            .summary(&self.whole.body, strengths))
    }
}

/// The summary by a plan that is made for this call. Bad options are refused before planning.
pub(super) fn summary_once(
    source: &PressureSource,
    strengths: &Strengths,
    watched_options: WatchedStress,
) -> Result<StressSummary> {
    let (body, grid, sliding) = (source.body, source.grid, &source.sliding);
    let request =
        SummaryRequest::checked(body, grid, sliding, strengths, watched_options.options())?;
    let evaluate = |plan: &StressPlan, progress: &mut StressProgress| {
        request.evaluate(plan, Scope::of(plan), progress)
    };
    let extremes = source.once(watched_options, request.memory, evaluate)?.unwrap_or_default();
    Ok(extremes.summary(body, strengths))
}

/// What is evaluated of a plan.
pub(super) struct Scope<'a> {
    /// What the plan's stress lacks, and the cells that count.
    pub(super) beside: Option<OutsidePatch<'a>>,
    /// Cells that do not count.
    pub(super) without: &'a [Window],
    /// Half-width of the contact, for which depths are chosen.
    pub(super) half_width: f64,
    /// The plan whose cells tell the width of the contact.
    pub(super) contact: &'a StressPlan,
    /// Whether the bounds of each cell are recorded.
    pub(super) records: bool,
}

impl<'a> Scope<'a> {
    /// All cells of a plan.
    pub(super) fn of(plan: &'a StressPlan) -> Self {
        Self {
            beside: None,
            without: &[],
            half_width: plan.whole.half_width(),
            contact: plan,
            records: false,
        }
    }
}

/// Arguments of one summary, checked.
pub(super) struct SummaryRequest {
    /// Residual stress of each layer and of the substrate.
    residual: Vec<f64>,
    /// μ times the unit vector of the traction on the body.
    friction: [f64; 2],
    /// Bytes that the summary takes, without the plan.
    memory: u64,
}

impl Strengths {
    /// Refuses a strength that is not finite and above 0.
    fn check(&self) -> Result<()> {
        let yields = self.yield_stress.iter().map(|value| ("yield_stress", value));
        let strengths = self.strength.iter().map(|value| ("strength", value));
        for (name, value) in yields.chain(strengths) {
            value.map(|value| positive(name, value)).transpose()?;
        }
        Ok(())
    }

    /// Yield stress and tensile strength of one layer, where they are known.
    fn of_layer(&self, layer: usize) -> [Option<f64>; 2] {
        [&self.yield_stress, &self.strength].map(|values| values.get(layer).copied().flatten())
    }
}

impl SummaryRequest {
    pub(super) fn checked(
        body: &HalfSpace,
        grid: &Grid,
        sliding: &SlidingSense,
        strengths: &Strengths,
        options: &StressOptions,
    ) -> Result<Self> {
        strengths.check()?;
        // Bounds of each cell.
        let layers = body.layers().len();
        let bounds = options.refine.map_or(0, |_| OF_LAYER * (layers + 1) + OF_INTERFACE * layers);
        // Six components, and the in-plane stress above an interface; steps of the pressure, and two arrays on the way to them;
        // stresses without what pressure within cells adds, and that.
        let within_cells = 2 * STRESSES;
        let arrays = 9 + 8 + within_cells + bounds + plane_arrays(options.friction != 0.0, false);
        Ok(Self {
            residual: options.residual_by_layer(body)?,
            friction: sliding.traction(body, options)?,
            memory: memory_of(grid.shape(), arrays),
        })
    }

    /// The extremes of a plan.
    pub(super) fn evaluate(
        &self,
        plan: &StressPlan,
        scope: Scope<'_>,
        progress: &mut StressProgress,
    ) -> Extremes {
        let body = &plan.whole.body;
        let regions = regions(body, scope.half_width);
        let in_layers = regions.iter().map(|region| region.len() + 3 * REFINEMENTS);
        let planned = in_layers.sum::<usize>() + body.layers().len();
        let mut planes = Planes::new(plan, scope, self.friction, &self.residual, planned, progress);
        let mut values = Vec::new();
        let finished = fill(&regions, &mut planes, &mut values).is_continue();
        if finished {
            // A break has nothing left to stop.
            let _ = (planes.progress)(1.0);
        }
        Extremes { values, bounds: planes.bounds, beyond: planes.beyond_grid, finished }
    }
}

/// Adds the extremes of all layers and interfaces to `extremes`.
fn fill(
    regions: &[Vec<Place>],
    planes: &mut Planes,
    extremes: &mut Vec<Extreme>,
) -> ControlFlow<()> {
    let body = &planes.plan.whole.body;
    for region in regions {
        planes.begin(extremes.len(), OF_LAYER);
        extremes.extend(layer(planes, region)?);
    }
    for (number, (layer, depth)) in body.layers().iter().zip(bottoms(body)).enumerate() {
        planes.begin(extremes.len(), OF_INTERFACE);
        interface(planes, body, (number, layer, depth), extremes)?;
    }
    ControlFlow::Continue(())
}

/// Extremes of a layer, from the places of `region`.
fn layer(planes: &mut Planes, region: &[Place]) -> ControlFlow<(), [Extreme; OF_LAYER]> {
    let mut evaluated: Vec<(Place, [Extreme; OF_LAYER])> = Vec::new();
    let mut best = [f64::NEG_INFINITY; OF_LAYER];
    for place in region {
        let peaks = planes.extremes(place, best)?;
        best = [0, 1, 2].map(|which| peaks[which].value.max(best[which]));
        evaluated.push((*place, peaks));
    }
    for (place, peaks) in &mut evaluated {
        *peaks = planes.beyond(*peaks, place, best)?;
    }
    for which in 0..3 {
        for _ in 0..REFINEMENTS {
            let values = evaluated.iter().map(|(place, peaks)| (*place, peaks[which].value));
            let values: Vec<_> = values.collect();
            let Some(place) = refined_peak(&values) else {
                break;
            };
            let peaks = planes.extremes(&place, best)?;
            let best = [0, 1, 2].map(|k| if k == which { best[k] } else { f64::INFINITY });
            evaluated.push((place, planes.beyond(peaks, &place, best)?));
            // By the depth in the layer: depths below the surface are equal where a layer is thinner than
            // their rounding.
            evaluated.sort_by(|a, b| a.0.below_top.total_cmp(&b.0.below_top));
        }
    }
    let first = evaluated[0].1;
    ControlFlow::Continue(evaluated.iter().fold(first, |largest, (_, peaks)| {
        std::array::from_fn(|which| largest[which].with(peaks[which]))
    }))
}

/// Adds the extremes of the interface below a `layer`, which has the `number` and this depth of its bottom, to `extremes`.
fn interface(
    planes: &mut Planes,
    body: &HalfSpace,
    (number, layer, depth): (usize, &Layer, f64),
    extremes: &mut Vec<Extreme>,
) -> ControlFlow<()> {
    let next = body.layers().get(number + 1).map(Layer::material);
    let below = next.or(substrate_material(body));
    let above =
        Place { layer: number, below_top: layer.thickness(), depth, material: layer.material() };
    let tractions = planes.tractions(&above)?;
    let jump = match below {
        None => None,
        Some(material) => {
            let below = Place { layer: number + 1, below_top: 0.0, depth, material };
            Some(planes.jump(&above, &below)?)
        }
    };
    extremes.extend(tractions.into_iter().chain(jump));
    ControlFlow::Continue(())
}

/// The plane of stress that was evaluated last, and what evaluates the next.
struct Planes<'a, 'b> {
    plan: &'a StressPlan,
    scope: Scope<'a>,
    friction: [f64; 2],
    residual: &'a [f64],
    evaluation: Evaluation<'a>,
    /// The six components at the cells.
    fields: [Vec<f64>; STRESSES],
    /// The same without what pressure within cells adds, where points of the edge are evaluated, too.
    smooth: Option<[Vec<f64>; STRESSES]>,
    /// Points of the edge of the contact, around which values are searched between cells.
    edge: Vec<CellPoint>,
    /// Whether the edge turns at each of them within a cell, as at the ends of slender contacts, on layers.
    is_end: Vec<bool>,
    /// Whether the law of the edge is that of layers.
    is_on_layers: bool,
    /// Whether a point of the edge lies in a cell or beside it: larger values between centres are those at points.
    near_edge: Vec<bool>,
    /// Whether the values between centres of those cells are found at points of the edge, at the place that was evaluated last.
    by_points: bool,
    /// Largest steps of the pressure that are felt in each cell; no cells where errors do not depend on them.
    steps: Vec<LocalSteps>,
    /// Errors of the components by those steps, in cells that feel no other edges than those with points and in the others; none
    /// where they are not known.
    errors: Option<[StepErrors; 2]>,
    /// Largest error in all cells at the place that was evaluated last, and the largest steps.
    most_error: f64,
    most_steps: LocalSteps,
    /// Whether each cell feels a stretch of an edge without points.
    feels_lost_edge: Vec<bool>,
    /// Bounds of each extreme in each cell, where they are recorded.
    bounds: Vec<Vec<f64>>,
    /// Each extreme beyond the grid, where bounds are recorded.
    beyond_grid: Vec<Extreme>,
    /// Number of the first of the extremes that are evaluated.
    first: usize,
    progress: &'a mut StressProgress<'b>,
    /// Planes evaluated so far.
    done: usize,
    /// Planes that are evaluated at most, but for those below an interface.
    planned: usize,
    beyond: OutsideGrid<'a>,
}

impl<'a, 'b> Planes<'a, 'b> {
    /// Planes of `plan` under a friction and the residual stress of each layer; `progress` is told how
    /// many of those `planned` are done.
    fn new(
        plan: &'a StressPlan,
        scope: Scope<'a>,
        friction: [f64; 2],
        residual: &'a [f64],
        planned: usize,
        progress: &'a mut StressProgress<'b>,
    ) -> Self {
        let shape @ [_, ny] = plan.whole.grid.shape();
        let cells = shape.iter().product();
        let edge = plan.edge_points_on_body();
        let mut near_edge = vec![false; cells];
        for [i, j] in edge.iter().flat_map(|point| around(shape, point.cell, 1)) {
            near_edge[i * ny + j] = true;
        }
        let is_on_layers = plan.whole.solved.as_ref().is_some_and(|of| of.subcell.is_on_layers());
        let turns = |k: usize| is_on_layers && plan.turn_of_edge(&edge, k) > TURN_OF_END;
        Self {
            feels_lost_edge: plan.feels_lost_edge(&edge),
            is_end: (0..edge.len()).map(turns).collect(),
            is_on_layers,
            plan,
            scope,
            friction,
            residual,
            evaluation: Evaluation::new(plan, friction, false),
            fields: std::array::from_fn(|_| vec![0.0; cells]),
            smooth: None,
            edge,
            near_edge,
            by_points: false,
            steps: plan.steps_by_cell(),
            errors: None,
            most_error: 0.0,
            most_steps: plan.whole.steps(&full_window(shape)),
            bounds: Vec::new(),
            beyond_grid: Vec::new(),
            first: 0,
            progress,
            done: 0,
            planned,
            beyond: OutsideGrid::new(plan, friction),
        }
    }

    /// Begins `count` extremes of which the first has this number.
    fn begin(&mut self, first: usize, count: usize) {
        self.first = first;
        if self.scope.records {
            let none = vec![f64::NEG_INFINITY; self.fields[0].len()];
            self.bounds.resize(first + count, none);
            self.beyond_grid.resize(first + count, Extreme::NONE);
        }
    }

    /// Records the bounds of a cell, of the extremes from number `from` of those that were begun.
    fn record<const N: usize>(&mut self, from: usize, cell: usize, bounds: [f64; N]) {
        if self.scope.records {
            for (recorded, bound) in self.bounds[self.first + from..].iter_mut().zip(bounds) {
                recorded[cell] = recorded[cell].max(bound);
            }
        }
    }

    /// Evaluates the stress at `place`. With `points`, the larger values at an edge are those at its points.
    fn evaluate(&mut self, place: &Place, points: bool) -> ControlFlow<()> {
        let (done, planned) = (self.done as f64, self.planned as f64);
        let progress = &mut self.progress;
        let mut progress = |fraction: f64| progress(((done + fraction) / planned).min(1.0));
        let mut outputs = self.fields.each_mut().map(Vec::as_mut_slice);
        // In line contact the sum over all strips is as cheap.
        let is_line = self.plan.whole.grid.is_line();
        self.evaluation.keeps_smooth = points && !is_line && self.scope.beside.is_none();
        self.evaluation.plane(place, &mut outputs, &mut progress)?;
        self.smooth = self.evaluation.smooth(&self.fields);
        if let Some(beside) = &mut self.scope.beside {
            beside.add(place, &self.plan.whole.grid, &mut self.fields, &mut progress)?;
        }
        let residual = self.residual[place.layer];
        for field in &mut self.fields[..2] {
            field.iter_mut().for_each(|s| *s += residual);
        }
        self.by_points = self.is_near_edges(place);
        let of = (!self.edge.is_empty(), self.scope.contact);
        self.errors = self.plan.errors_of_extremes(place, self.friction, of);
        let largest = |errors: [StepErrors; 2]| {
            errors
                .map(|errors| errors.at(&self.most_steps, ErrorOf::Any))
                .into_iter()
                .fold(0.0, f64::max)
        };
        self.most_error = self.errors.map_or(0.0, largest);
        self.done += 1;
        ControlFlow::Continue(())
    }

    /// Whether a cell counts.
    fn counts(&self, cell: usize) -> bool {
        let ny = self.plan.whole.grid.shape()[1];
        self.has([cell / ny, cell % ny])
    }

    /// Whether a cell of this row and column counts.
    fn has(&self, cell: [usize; 2]) -> bool {
        let holds =
            |window: &Window| [0, 1].iter().all(|axis| window[*axis].contains(&cell[*axis]));
        self.scope.beside.as_ref().is_none_or(|beside| holds(&beside.core))
            && !self.scope.without.iter().any(holds)
    }

    /// Numbers of the cells that count.
    fn cells(&self) -> Vec<usize> {
        (0..self.fields[0].len()).filter(|cell| self.counts(*cell)).collect()
    }

    fn tensor(&self, cell: usize) -> Tensor {
        Tensor::new(self.fields.each_ref().map(|field| field[cell]))
    }

    /// The steps of the pressure that are felt in a cell.
    fn steps(&self, cell: usize) -> LocalSteps {
        self.steps.get(cell).copied().unwrap_or_default()
    }

    /// The error of a cell at the place that was evaluated last; 0 where it is not known.
    fn error(&self, cell: usize, of: ErrorOf) -> f64 {
        let is_lost = self.feels_lost_edge.get(cell).copied().unwrap_or_default();
        let by_points = self.by_points && self.is_on_layers && self.near_edge[cell] && !is_lost;
        let error = |[beside, elsewhere]: [StepErrors; 2]| match (by_points, is_lost) {
            (true, _) => beside.without_edges(),
            (_, true) => elsewhere,
            (_, false) => beside,
        };
        self.errors.map_or(0.0, |errors| error(errors).at(&self.steps(cell), of))
    }

    /// Whether larger values at `place` are searched around points of the edge: at the faces of layers and half way between
    /// them, where these are less than [`SEARCHED`] cells deep.
    fn has_points(&self, place: &Place) -> bool {
        let is_chosen = match self.plan.whole.body.layers().get(place.layer) {
            Some(layer) => {
                let part = place.below_top / layer.thickness();
                [0.0, 0.5, 1.0].iter().any(|chosen| (part - chosen).abs() < ONE_DEPTH)
            }
            None => place.below_top <= 0.0,
        };
        self.is_near_edges(place) && is_chosen
    }

    /// Whether values at `place` change between the centres of cells near the edge, of which the largest are searched there or at
    /// depths beside.
    fn is_near_edges(&self, place: &Place) -> bool {
        let spacing = self.plan.whole.grid.spacing();
        let cell =
            if self.plan.whole.grid.is_line() { spacing[1] } else { spacing[0].max(spacing[1]) };
        !self.edge.is_empty() && place.depth < SEARCHED * cell
    }

    /// The largest von Mises stress, principal stress and shear stress at `place`.
    fn extremes(
        &mut self,
        place: &Place,
        best: [f64; OF_LAYER],
    ) -> ControlFlow<(), [Extreme; OF_LAYER]> {
        self.evaluate(place, self.has_points(place))?;
        if let (true, Some(solved)) = (place.depth == 0.0, &self.plan.whole.solved) {
            solved.subcell.set_tractions_at_centres(self.friction, &mut self.fields);
        }
        let cells = self.cells();
        // Values that some cells reach rule out most of the others at once.
        let sample = cells.iter().copied().step_by(SAMPLED);
        let reached = self.largest_three(sample, [LargestWithError::NONE; OF_LAYER], false);
        let at_least = reached.map(LargestWithError::or_equal);
        let largest = self.largest_three(cells.into_iter(), at_least, self.scope.records);
        let of = |tensors: &[Tensor; 1]| three(&tensors[0]);
        let peaks = self.peaks((largest, [ErrorOf::Any; OF_LAYER]), place, &[], of);
        self.with_edge((0, peaks, best), place, [ErrorOf::Any; OF_LAYER], three)
    }

    /// The largest three stresses of `cells`, where they are larger than the `largest` so far. With `records`, the bounds of each
    /// cell are recorded that are larger than the largest value, and no others matter.
    fn largest_three(
        &mut self,
        cells: impl Iterator<Item = usize>,
        mut largest: [LargestWithError; OF_LAYER],
        records: bool,
    ) -> [LargestWithError; OF_LAYER] {
        for cell in cells {
            let tensor = self.tensor(cell);
            let mises = tensor.von_mises();
            // Which of the three may be, with an error, larger than those that matter.
            let may_count = |error: f64| {
                let least = |which: usize| {
                    let LargestWithError { value, bound } = largest[which];
                    let bounds = self.bounds.get(self.first + which).filter(|_| records);
                    let recorded = bounds.map(|bounds| bounds[cell].max(value.value));
                    let bound = recorded.map_or(bound.value, |most| bound.value.min(most));
                    value.value.min(bound - error)
                };
                let shears = || tensor.may_shear(least(2), mises);
                [mises > least(0), tensor.may_pull(least(1), mises) || shears()]
            };
            if may_count(self.most_error) == [false; 2] {
                continue;
            }
            let error = self.error(cell, ErrorOf::Any);
            let [_, needs_principal] = may_count(error);
            largest[0].offer(mises, error, cell);
            if needs_principal {
                let values = three(&tensor);
                for (largest, value) in largest.iter_mut().zip(values).skip(1) {
                    largest.offer(value, error, cell);
                }
                if records {
                    self.record(0, cell, values.map(|value| value + error));
                }
            } else if records {
                self.record(0, cell, [mises + error]);
            }
        }
        largest
    }

    /// The peaks at `place`, or larger ones between the centres of cells near the edge of the contact, which are the extremes from
    /// number `from` of those that were begun: at the surface at points of the edge, from which stresses fall off as the root of the
    /// distance, and farther below around them. Nothing is searched that cannot exceed the peaks and the `best` of other places.
    fn with_edge<const N: usize>(
        &mut self,
        (from, mut peaks, best): (usize, [Extreme; N], [f64; N]),
        place: &Place,
        kinds: [ErrorOf; N],
        of: impl Fn(&Tensor) -> [f64; N],
    ) -> ControlFlow<(), [Extreme; N]> {
        let counted = self.edge.iter().zip(&self.is_end).filter(|(point, _)| self.has(point.cell));
        let (points, is_end): (Vec<CellPoint>, Vec<bool>) =
            counted.map(|(point, is_end)| (*point, *is_end)).unzip();
        if points.is_empty() || !self.has_points(place) {
            return ControlFlow::Continue(peaks);
        }
        let Some(at) = self.evaluation.point_stress(place) else {
            return ControlFlow::Continue(peaks);
        };
        let at = match self.smooth.take() {
            Some(smooth) => self.plan.whole.threads.run(|| at.with_cells(smooth)),
            None => at,
        };
        let shape @ [_, ny] = self.plan.whole.grid.shape();
        // Where the largest values are, from those in the cells of the edge and beside it.
        let beside: Vec<_> = points
            .iter()
            .map(|point| {
                let cells = around(shape, point.cell, 1).filter(|cell| self.has(*cell));
                let values = cells.map(|[i, j]| of(&self.tensor(i * ny + j)));
                let larger = |a: [f64; N], b: [f64; N]| std::array::from_fn(|k| a[k].max(b[k]));
                values.fold([f64::NEG_INFINITY; N], larger)
            })
            .collect();
        let errors = self.plan.errors_between(place, self.friction);
        let mut search = EdgeSearch::new(self, &at, place, &points);
        for which in 0..N {
            let largest = best[which].max(peaks[which].value);
            let may_exceed = |k: &usize| {
                let [i, j] = points[*k].cell;
                let steps = search.planes.steps(i * ny + j);
                let error = errors.map_or(0.0, |errors| errors.at(&steps, kinds[which]));
                beside[*k][which] + error > largest
            };
            let mut starts: Vec<usize> = (0..points.len()).filter(may_exceed).collect();
            starts.sort_by(|a, b| beside[*b][which].total_cmp(&beside[*a][which]));
            starts.truncate(EDGE_STARTS);
            let of = |tensor: &Tensor| of(tensor)[which];
            // Larger values may be at ends whose cells do not show them.
            for k in (0..points.len()).filter(|k| is_end[*k]) {
                if let Some(value) = search.value((k, 0), of)? {
                    let error = search.error((k, 0), (value, kinds[which]), of)?;
                    let [x, y] = search.planes.plan.position(&points[k]);
                    let end = Extreme::of(value, [x, y, place.depth], error);
                    peaks[which] = peaks[which].bounded_by(end);
                }
            }
            let Some((place_at, value)) = search.largest(&starts, of)? else { continue };
            let error = search.error(place_at, (value, kinds[which]), of)?;
            let Some(point) = search.point(place_at) else { continue };
            let planes = &mut *search.planes;
            let [x, y] = planes.plan.position(&point);
            let extreme = Extreme::of(value, [x, y, place.depth], error);
            peaks[which] = peaks[which].with(extreme);
            let mut bounds = [f64::NEG_INFINITY; N];
            bounds[which] = value + error.unwrap_or(0.0);
            planes.record(from, point.cell[0] * ny + point.cell[1], bounds);
        }
        ControlFlow::Continue(peaks)
    }

    /// Extremes of the traction at `place`: the largest σ_zz and −σ_zz, and the largest √(σ_xz² + σ_yz²).
    fn tractions(&mut self, place: &Place) -> ControlFlow<(), [Extreme; 3]> {
        self.evaluate(place, self.has_points(place))?;
        let three = |Tensor { zz, yz, xz, .. }: &Tensor| [*zz, -zz, xz.hypot(*yz)];
        let of = |tensors: &[Tensor; 1]| three(&tensors[0]);
        let kinds = [ErrorOf::Normal, ErrorOf::Normal, ErrorOf::Shear];
        let peaks = self.largest(place, (0, &[]), kinds, of);
        let peaks = self.with_edge((0, peaks, [f64::NEG_INFINITY; 3]), place, kinds, three)?;
        self.with_beyond((0, peaks, [f64::NEG_INFINITY; 3]), &[*place], (of, |_: &_, _| None))
    }

    /// Largest jump of the in-plane stress from the plane at `above`, which was evaluated last, to that at `below`.
    fn jump(&mut self, above: &Place, below: &Place) -> ControlFlow<(), Extreme> {
        let (before, errors) = ([self.fields.clone()], self.errors);
        self.evaluate(below, false)?;
        self.errors =
            self.errors.zip(errors).map(|(below, above)| [0, 1].map(|k| below[k].larger(above[k])));
        let of = |tensors: &[Tensor; 2]| [jump(*tensors)];
        let peaks = self.largest(below, (3, &before), [ErrorOf::Lateral], of);
        let inside = (3, peaks, [f64::NEG_INFINITY; 1]);
        let [peak] = self.with_beyond(inside, &[*above, *below], (of, |_: &_, _| None))?;
        ControlFlow::Continue(peak)
    }

    /// The largest values of all cells at `place`, which are the extremes from number `from` of those that were begun. `of`
    /// has the values of a cell, from its stresses at one place or more: those of the planes `before`, and of the one
    /// evaluated last.
    fn largest<const N: usize, const K: usize>(
        &mut self,
        place: &Place,
        (from, before): (usize, &[[Vec<f64>; STRESSES]]),
        kinds: [ErrorOf; N],
        of: impl Fn(&[Tensor; K]) -> [f64; N],
    ) -> [Extreme; N] {
        let mut largest = [LargestWithError::NONE; N];
        for cell in self.cells() {
            let mut bounds = of(&self.tensors(before, cell));
            for ((largest, value), kind) in largest.iter_mut().zip(&mut bounds).zip(kinds) {
                let error = self.error(cell, kind);
                largest.offer(*value, error, cell);
                *value += error;
            }
            self.record(from, cell, bounds);
        }
        self.peaks((largest, kinds), place, before, of)
    }

    /// Stresses of a cell at one place or more: those of the planes `before`, and of the one evaluated last.
    fn tensors<const K: usize>(&self, before: &[[Vec<f64>; STRESSES]], cell: usize) -> [Tensor; K] {
        std::array::from_fn(|k| {
            let fields = before.get(k).unwrap_or(&self.fields);
            Tensor::new(fields.each_ref().map(|field| field[cell]))
        })
    }

    /// The extremes of the largest values at `place`, with what is missed between centres of cells. `of` has the values of a
    /// cell, from its stresses at one place or more: those of the planes `before`, and of the one evaluated last.
    fn peaks<const N: usize, const K: usize>(
        &self,
        (largest, kinds): ([LargestWithError; N], [ErrorOf; N]),
        place: &Place,
        before: &[[Vec<f64>; STRESSES]],
        of: impl Fn(&[Tensor; K]) -> [f64; N],
    ) -> [Extreme; N] {
        let grid = &self.plan.whole.grid;
        std::array::from_fn(|n| {
            let of_cell =
                |cell: usize| self.counts(cell).then(|| of(&self.tensors(before, cell))[n]);
            let extreme = |at: Largest, error: f64| {
                let centre = CellPoint {
                    cell: {
                        let ny = grid.shape()[1];
                        [at.cell / ny, at.cell % ny]
                    },
                    within: [0.0; 2],
                };
                let [x, y] = self.plan.position(&centre);
                let between = match self.by_points && self.near_edge[at.cell] {
                    true => 0.0,
                    false => at.between(grid, of_cell),
                };
                let error = error + between;
                Extreme::of(at.value, [x, y, place.depth], self.errors.map(|_| error))
            };
            let LargestWithError { value, bound } = largest[n];
            extreme(value, self.error(value.cell, kinds[n])).bounded_by(extreme(bound, 0.0))
        })
    }

    /// The peaks of [`Planes::extremes`], or larger ones beyond the grid.
    fn beyond(
        &mut self,
        peaks: [Extreme; OF_LAYER],
        place: &Place,
        best: [f64; OF_LAYER],
    ) -> ControlFlow<(), [Extreme; OF_LAYER]> {
        let of = |tensors: &[Tensor; 1]| three(&tensors[0]);
        let bound = |[tensor]: &[Tensor; 1], least: [f64; OF_LAYER]| {
            let mises = tensor.von_mises();
            let may_exceed = mises > least[0]
                || tensor.may_pull(least[1], mises)
                || tensor.may_shear(least[2], mises);
            // A largest principal stress below 0 is less far from it than the mean.
            (!may_exceed).then(|| mises.max(-tensor.mean()))
        };
        self.with_beyond((0, peaks, best), &[*place], (of, bound))
    }

    /// The peaks at the last of `places`, which are the extremes from number `from` of those that were begun, or larger ones
    /// beyond the grid; `of` has the values and the bound of [`OutsideGrid::peaks`].
    fn with_beyond<const N: usize, const K: usize>(
        &mut self,
        (from, peaks, best): (usize, [Extreme; N], [f64; N]),
        places: &[Place; K],
        of: (impl Fn(&[Tensor; K]) -> [f64; N], impl Fn(&[Tensor; K], [f64; N]) -> Option<f64>),
    ) -> ControlFlow<(), [Extreme; N]> {
        // Places beyond the grid are those of its first evaluation, as a whole.
        if self.scope.beside.is_some() || !self.scope.without.is_empty() {
            return ControlFlow::Continue(peaks);
        }
        let fraction = (self.done as f64 / self.planned as f64).min(1.0);
        let mut progress = |_| (self.progress)(fraction);
        let inside = (peaks, largest_of(&peaks), best);
        let [peaks, beyond] =
            self.beyond.peaks(inside, places, self.residual, of, &mut progress)?;
        if self.scope.records {
            for (recorded, extreme) in self.beyond_grid[self.first + from..].iter_mut().zip(beyond)
            {
                *recorded = recorded.with(extreme);
            }
        }
        ControlFlow::Continue(peaks)
    }
}

/// The largest magnitude of peaks; 0 where no cell counts.
fn largest_of(peaks: &[Extreme]) -> f64 {
    let values = peaks.iter().map(|peak| peak.value.abs());
    values.filter(|value| value.is_finite()).fold(0.0, f64::max)
}

/// Jump of the in-plane stress from above to below, as the larger principal value of its magnitude.
fn jump([above, below]: [Tensor; 2]) -> f64 {
    let (xx, yy, xy) = (below.xx - above.xx, below.yy - above.yy, below.xy - above.xy);
    (0.5 * (xx + yy)).abs() + (0.5 * (xx - yy)).hypot(xy)
}

/// Von Mises stress, largest principal stress and largest shear stress.
fn three(tensor: &Tensor) -> [f64; OF_LAYER] {
    let [first, _, last] = tensor.principal();
    [tensor.von_mises(), first, 0.5 * (first - last)]
}

/// A search for the largest values at a depth around points of the edge of the contact.
struct EdgeSearch<'s, 'a, 'b> {
    planes: &'s mut Planes<'a, 'b>,
    at: &'s PointStress<'a>,
    place: &'s Place,
    points: &'s [CellPoint],
    /// Length over which stresses change: the depth and, at the surface, the thickness of the layer, but not more than a cell.
    length: f64,
    /// Stresses that were evaluated.
    known: BTreeMap<AcrossEdge, Tensor>,
}

/// A place near the edge: number of a point of the edge, and the distance from it towards the inside, in parts of a length.
type AcrossEdge = (usize, i32);

impl<'s, 'a, 'b> EdgeSearch<'s, 'a, 'b> {
    fn new(
        planes: &'s mut Planes<'a, 'b>,
        at: &'s PointStress<'a>,
        place: &'s Place,
        points: &'s [CellPoint],
    ) -> Self {
        let whole = &planes.plan.whole;
        let cell = whole.grid.spacing().into_iter().fold(f64::INFINITY, f64::min);
        let layer = whole.body.layers().get(place.layer).map_or(cell, Layer::thickness);
        let length = if place.depth > 0.0 { place.depth } else { layer.min(cell) };
        Self { planes, at, place, points, length, known: BTreeMap::new() }
    }

    /// The point at a place, if it counts.
    fn point(&self, (k, across): AcrossEdge) -> Option<CellPoint> {
        let distance = f64::from(across) * self.length * LAST_STEP_ACROSS_EDGE;
        let point = self.planes.plan.inside_of(&self.points[k], distance)?;
        let [i, j] = point.cell;
        // Farther off, the largest value is that of a cell.
        let is_near = self.planes.near_edge[i * self.planes.plan.whole.grid.shape()[1] + j];
        (is_near && self.planes.has(point.cell)).then_some(point)
    }

    fn tensor(&mut self, point: &CellPoint, fit: EdgeFit) -> ControlFlow<(), Tensor> {
        let planes = &mut *self.planes;
        let part = (planes.done as f64 / planes.planned as f64).min(1.0);
        let mut progress = |_| (planes.progress)(part);
        let at = (point, fit);
        let mut sum = planes.evaluation.at_point(self.place, self.at, at, &mut progress)?;
        if let Some(beside) = &planes.scope.beside {
            let added = beside.at(planes.plan.position(point));
            sum.iter_mut().zip(added).for_each(|(sum, value)| *sum += value);
        }
        let residual = planes.residual[self.place.layer];
        sum[..2].iter_mut().for_each(|s| *s += residual);
        ControlFlow::Continue(Tensor::new(sum))
    }

    /// The value at a place; none where that does not count.
    fn value(
        &mut self,
        at: AcrossEdge,
        of: impl Fn(&Tensor) -> f64,
    ) -> ControlFlow<(), Option<f64>> {
        if let Some(tensor) = self.known.get(&at) {
            return ControlFlow::Continue(Some(of(tensor)));
        }
        let Some(point) = self.point(at) else { return ControlFlow::Continue(None) };
        let tensor = self.tensor(&point, EdgeFit::Best)?;
        let value = of(&tensor);
        self.known.insert(at, tensor);
        ControlFlow::Continue(Some(value))
    }

    /// The largest value, and its place: uphill from the best of the `starts` in steps along the edge and across it,
    /// which are halved down to half a cell and to a part of the length over which stresses change.
    fn largest(
        &mut self,
        starts: &[usize],
        of: impl Fn(&Tensor) -> f64,
    ) -> ControlFlow<(), Option<(AcrossEdge, f64)>> {
        let mut best: Option<(AcrossEdge, f64)> = None;
        let better = |best: &mut Option<(AcrossEdge, f64)>, at, value: Option<f64>| {
            let is_better = value.is_some_and(|value| best.is_none_or(|(_, best)| value > best));
            if is_better {
                *best = value.map(|value| (at, value));
            }
            is_better
        };
        for k in starts {
            let value = self.value((*k, 0), &of)?;
            better(&mut best, (*k, 0), value);
        }
        let spacing = self.planes.plan.whole.grid.spacing();
        let shortest = 0.5 * spacing.into_iter().fold(f64::INFINITY, f64::min);
        let mut step = self.planes.plan.whole.half_width() * FIRST_STEP_ALONG_EDGE;
        // At the surface of one material, and with tractions that follow the pressure within one cell, values are largest at the edge.
        let plan = self.planes.plan;
        let is_at_edge = !self.planes.is_on_layers || plan.known.is_some();
        let mut across = match self.place.depth > 0.0 || !is_at_edge {
            true => FIRST_STEP_ACROSS_EDGE,
            false => 0,
        };
        while let Some(((k, offset), _)) = best
            && (step > shortest || across > 0)
        {
            let along = match step > shortest {
                true => self.planes.plan.along_edge(self.points, k, step),
                false => Vec::new(),
            };
            let mut places: Vec<AcrossEdge> = along.iter().map(|k| (*k, offset)).collect();
            if across > 0 {
                places.extend([(k, offset + across), (k, offset - across)]);
            }
            let mut rises = false;
            for at in places {
                let value = self.value(at, &of)?;
                rises |= better(&mut best, at, value);
            }
            if !rises {
                step *= 0.5;
                across /= 2;
            }
        }
        ControlFlow::Continue(best)
    }

    /// The error of a value: on layers what it changes by with simpler fits near the edge, and a share of it; elsewhere that of the
    /// steps of the pressure; with the width of the contact, and what known tractions and free ends leave uncertain.
    fn error(
        &mut self,
        at: AcrossEdge,
        (value, kind): (f64, ErrorOf),
        of: impl Fn(&Tensor) -> f64,
    ) -> ControlFlow<(), Option<f64>> {
        let plan = self.planes.plan;
        let errors = plan.errors(self.place, self.planes.friction, true);
        let (Some(solved), Some(errors)) = (&plan.whole.solved, errors) else {
            return ControlFlow::Continue(None);
        };
        let Some(point) = self.point(at) else { return ControlFlow::Continue(None) };
        let steps = self.planes.steps(point.cell[0] * plan.whole.grid.shape()[1] + point.cell[1]);
        let of_width = self.planes.scope.contact.width_errors(self.place, self.planes.friction);
        let errors = errors.plus(of_width);
        if !solved.subcell.is_on_layers() {
            return ControlFlow::Continue(Some(errors.at(&steps, kind)));
        }
        let part = (self.planes.done as f64 / self.planes.planned as f64).min(1.0);
        let mut progress = |_| (self.planes.progress)(part);
        let (grid, threads) = (&plan.whole.grid, &plan.whole.threads);
        solved.subcell.make_simpler(grid, threads, &mut progress)?;
        let change = (of(&self.tensor(&point, EdgeFit::Simpler)?) - value).abs();
        let others = match plan.known {
            Some(_) => errors.at(&steps, kind),
            None => errors.everywhere(kind),
        };
        let peak = plan.whole.pressure.iter().copied().fold(0.0, f64::max);
        let size = value.abs().max(LEAST_PART * peak);
        let share = if plan.whole.grid.is_line() { FIT_SHARE_OF_LINE } else { FIT_SHARE };
        let turn = plan.turn_of_edge(self.points, at.0) / FITTED_TURN;
        let turned = (FIT_SHARE * (turn * turn - 1.0)).clamp(0.0, SHARE_OF_END);
        ControlFlow::Continue(Some(change + share * size + turned * value.abs() + others))
    }
}

/// Share of a value at a point that makes its error, with its change by simpler fits. Chosen on 161 extremes of 56 coated balls, and tried
/// on other contacts (`tests/python/contact/test_coat_shapes.py`).
const FIT_SHARE: f64 = 0.005;

/// The same in line contact, where the fit has one row of cells, and steps of a strip make stresses up to 0.7 % too large.
const FIT_SHARE_OF_LINE: f64 = 0.0075;

/// Turn of the edge over a cell, in radians, up to which [`FIT_SHARE`] holds: that of a ball of eight cells to the radius. The fits
/// take the edge of a cell for straight, and beyond, a share of the value is added that grows as the square of the turn.
const FITTED_TURN: f64 = 0.12;

/// Largest such share, at an end that lies within one cell. The largest tension of slender contacts is up to 21 % too small there
/// (`tests/python/contact/test_stress.py`).
const SHARE_OF_END: f64 = 0.25;

/// Turn of the edge over a cell, in radians, above which a point is at such an end: the share is then a tenth.
const TURN_OF_END: f64 = 0.5;

/// Stress over the largest pressure below which errors are shares of that pressure.
const LEAST_PART: f64 = 0.2;

/// Depth in cells down to which larger values are searched between the centres of cells.
const SEARCHED: f64 = 3.0;

/// Last step of a search across the edge, over the length in which stresses change, and the first one, in last ones.
const LAST_STEP_ACROSS_EDGE: f64 = 0.125;
const FIRST_STEP_ACROSS_EDGE: i32 = 8;

/// Points of the edge from the cells with the largest values, at which a search along the edge starts.
const EDGE_STARTS: usize = 2;

/// First step of a search along the edge, in half-widths of the contact; steps are halved down to half a cell.
const FIRST_STEP_ALONG_EDGE: f64 = 0.125;

/// Depths below the top of a layer, in half-widths of the contact: dense where the
/// shear stress of a contact has its peak (0.48 below a sphere, 0.79 below a cylinder).
const DEPTHS_SEARCHED: [f64; 13] =
    [0.02, 0.1, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 1.0, 1.3, 1.8, 2.5, 4.0];

/// Depths within a layer, in its thickness.
const FRACTIONS: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];

/// Depth, in a layer's thickness, below which its bottom face stands for the depths of [`DEPTHS_SEARCHED`].
const BOTTOM: f64 = 0.999;

/// Distance, in a layer's thickness, below which two depths are one.
const ONE_DEPTH: f64 = 1e-6;

/// Places in each layer and in the substrate, from the surface down.
fn regions(body: &HalfSpace, half_width: f64) -> Vec<Vec<Place>> {
    let mut top = 0.0;
    let mut regions = Vec::new();
    let at = |layer: usize, top: f64, below_top: f64, material| Place {
        layer,
        below_top,
        depth: top + below_top,
        material,
    };
    for (count, layer) in body.layers().iter().enumerate() {
        let h = layer.thickness();
        let mut depths: Vec<f64> = DEPTHS_SEARCHED.iter().map(|d| d * half_width).collect();
        depths.extend(FRACTIONS.map(|f| f * h));
        depths.retain(|z| *z < BOTTOM * h);
        depths.extend([0.0, h]);
        depths.sort_by(f64::total_cmp);
        // Refinement divides by the distances between depths.
        depths.dedup_by(|next, before| *next - *before < ONE_DEPTH * h);
        let place = |z: &f64| at(count, top, *z, layer.material());
        regions.push(depths.iter().map(place).collect());
        top += h;
    }
    if let Some(material) = substrate_material(body) {
        let depths = [0.0].into_iter().chain(DEPTHS_SEARCHED.map(|d| d * half_width));
        let place = |z: f64| at(body.layers().len(), top, z, material);
        regions.push(depths.map(place).collect());
    }
    regions
}

/// Steps of less than this fraction of the distance to the next depth are not taken: the peak is at
/// the depth already evaluated, or the value falls off there as at a kink.
const SHORTEST_REFINEMENT: f64 = 1e-3;

/// Rise of a parabola over the largest value, as a part of it, below which its vertex is not evaluated: a third of the error of
/// extremes on cells however small.
const SMALLEST_RISE: f64 = 1e-5;

/// The largest step, as a fraction of the distance to the next depth.
const LONGEST_REFINEMENT: f64 = 0.9;

/// Place of the vertex of the parabola through the largest value in `evaluated` and its two
/// neighbours. None where the largest value is the first or the last, or is that vertex already.
fn refined_peak(evaluated: &[(Place, f64)]) -> Option<Place> {
    let value = |k: usize| evaluated[k].1;
    let best = (0..evaluated.len()).reduce(|a, b| if value(b) > value(a) { b } else { a })?;
    if best == 0 || best + 1 == evaluated.len() || value(best) == f64::NEG_INFINITY {
        return None;
    }
    let z = |k: usize| evaluated[k].0.below_top;
    let (a, b) = (z(best) - z(best - 1), z(best + 1) - z(best));
    let (left, right) = ((value(best) - value(best - 1)) / a, (value(best) - value(best + 1)) / b);
    if left + right <= 0.0 {
        return None;
    }
    // The slope of the parabola at `best`, over its curvature.
    let slope = (left * b - right * a) / (a + b);
    let step = 0.5 * slope * (a + b) / (left + right);
    let rise = 0.5 * slope * step;
    if step.abs() < SHORTEST_REFINEMENT * a.min(b) || rise < SMALLEST_RISE * value(best).abs() {
        return None;
    }
    let step = step.clamp(-LONGEST_REFINEMENT * a, LONGEST_REFINEMENT * b);
    let place = evaluated[best].0;
    Some(Place { below_top: place.below_top + step, depth: place.depth + step, ..place })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;
    use crate::model::body::Layer;
    use crate::model::material::Elastic;

    /// Errors below an extreme are in per cent of it, larger ones over the largest von Mises stress, in no unit. No size of
    /// cells is named where it is not known.
    #[test]
    fn warnings_say_the_size_of_errors() {
        let peak = |value: f64, uncertainty: f64| Peak {
            value,
            position: [0.0; 3],
            uncertainty: Some(uncertainty),
        };
        let summary = |tension: Peak| StressSummary {
            layers: vec![LayerSummary {
                layer: 0,
                name: None,
                depths: [0.0, 1.0],
                von_mises: peak(10.0, 0.1),
                tension,
                shear: peak(5.0, 0.1),
                yield_safety_factor: None,
                strength_safety_factor: None,
            }],
            ..StressSummary::default()
        };
        let warnings = |value, error| summary(peak(value, error)).warnings();
        // A quarter of the extreme, or 2 % of the largest von Mises stress, is enough.
        assert_eq!(warnings(4.0, 0.9), [] as [&str; 0]);
        let start = "the extremes in layers[0] are uncertain, tension by";
        let end = "due to the size of the cells: take";
        assert_eq!(warnings(1.0, 0.6), [format!("{start} 60 %, {end} cells 3 times smaller")]);
        let size = "0.30 of the largest von Mises stress";
        let smaller = "cells 6 times smaller";
        assert_eq!(warnings(2.0, 3.0), [format!("{start} {size}, {end} {smaller}")]);
        let size = "600.00 of the largest von Mises stress";
        assert_eq!(warnings(2.0, 6e3), [format!("{start} {size}, {end} much smaller cells")]);
    }

    /// Where the thickness is the half-width, some depths come from both lists: each is a place once.
    #[test]
    fn depths_increase() -> Result<()> {
        let material = Elastic::new(1.0, 0.3)?;
        for thickness in [1e-18, 0.1, 1.0, 1.0 + 1e-12, 4.0] {
            let layers = [1e3, thickness].map(|h| Layer::new(material, h));
            let [upper, lower] = layers;
            let body = HalfSpace::new(material, [upper?, lower?])?;
            for region in regions(&body, 1.0) {
                assert!(region.is_sorted_by(|a, b| a.below_top < b.below_top));
            }
        }
        Ok(())
    }

    /// On a parabola its vertex is found exactly; evaluated there, nothing is left to find.
    #[test]
    fn the_vertex_of_a_parabola_is_found() -> Result<()> {
        const ROUNDING: f64 = 1e-15;
        let material = Elastic::new(1.0, 0.3)?;
        let at = |z: f64| {
            let place = Place { layer: 0, below_top: z, depth: z, material };
            (place, 3.0 - 2.0 * (z - 0.7) * (z - 0.7))
        };
        let mut evaluated = vec![at(0.0), at(0.5), at(1.1), at(2.0)];
        let vertex = refined_peak(&evaluated).map(|place| place.depth);
        assert!(vertex.is_some_and(|z| (z - 0.7).abs() < ROUNDING), "{vertex:?}");
        evaluated.insert(2, at(0.7));
        assert_eq!(refined_peak(&evaluated), None);
        assert_eq!(refined_peak(&[at(0.7), at(1.0), at(2.0)]), None);
        Ok(())
    }
}
