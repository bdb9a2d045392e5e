//! Summary of a stress field: peaks in each layer, tractions at each interface.

use std::ops::ControlFlow;

use super::beside::Beside;
use super::beyond::Beyond;
use super::field::{Largest, Peak, Percent, SmallerCells, Tensor};
use super::half_space::plane_arrays;
use super::options::{SlidingSense, StressOptions, StressProgress, WatchedStress};
use super::plan::{Evaluation, PressureSource, StressPlan};
use super::subcell::{CellPoint, STRESSES};
use crate::compliance::response::interior::Place;
use crate::compliance::response::substrate_material;
use crate::error::{Result, positive, refuse_if};
use crate::model::body::{HalfSpace, Layer};
use crate::model::grid::Grid;
use crate::numerics::parallel::{check_memory, memory_of};

/// Strengths of the layers from the surface down, then of the substrate. None, or a shorter list:
/// not known.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Strengths {
    /// Yield stresses \[Pa\], which von Mises' stress is compared with.
    pub yield_stress: Vec<Option<f64>>,
    /// Tensile strengths \[Pa\], which the largest principal stress is compared with.
    pub strength: Vec<Option<f64>>,
}

/// The extremes in one layer, or in the substrate.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct LayerSummary {
    /// Number of the layer, from the surface down; the substrate's is the number of layers.
    pub layer: usize,
    /// Name of the layer, if it has one; the substrate has none.
    pub name: Option<String>,
    /// Depths of the top and bottom faces \[m\]; the substrate's bottom is at infinity.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "crate::data::depths"))]
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

/// The extremes at one interface.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
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
        let unresolved = |peaks: &[(&str, &Peak)]| -> Option<(String, f64)> {
            let ratio = |(name, peak): &(&str, &Peak)| {
                let error = peak.uncertainty.filter(|error| *error > negligible)?;
                let ratio = error / peak.value.abs();
                (ratio > UNRESOLVED_EXTREME)
                    .then(|| (format!("{name} by {}", Percent(ratio)), ratio))
            };
            let (said, ratios): (Vec<_>, Vec<_>) = peaks.iter().filter_map(ratio).unzip();
            let worst = ratios.into_iter().reduce(f64::max)?;
            Some((said.join(", "), worst))
        };
        let layers = self.layers.iter().filter_map(|layer| {
            let LayerSummary { von_mises, tension, shear, .. } = layer;
            let peaks = [("von Mises", von_mises), ("tension", tension), ("shear", shear)];
            // Compression everywhere is no tension to be known.
            let known = if tension.value > 0.0 { 3 } else { 1 };
            let unresolved = unresolved(&peaks[..known])?;
            let place = match layer.depths[1].is_finite() {
                true => format!("layers[{}]", layer.layer),
                false => "the substrate".to_string(),
            };
            Some((place, unresolved))
        });
        let interfaces = self.interfaces.iter().filter_map(|face| {
            let peaks = [("shear", &face.shear), ("compression", &face.compression)];
            Some((format!("interfaces[{}]", face.interface), unresolved(&peaks)?))
        });
        let said = |(place, (said, worst)): (String, (String, f64))| {
            format!(
                "the extremes in {place} are uncertain, {said}, due to the size of the cells: take {}",
                SmallerCells(worst / UNRESOLVED_EXTREME)
            )
        };
        layers.chain(interfaces).map(said).collect()
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

    /// All extremes, those of the layers first; none for a jump on a rigid base, and for what is no tension.
    pub(super) fn peaks(&mut self) -> Vec<Option<&mut Peak>> {
        let tension = |peak: &&mut Peak| peak.value > 0.0;
        let layers = self.layers.iter_mut().flat_map(|layer| {
            let LayerSummary { von_mises, tension: pulled, shear, .. } = layer;
            [Some(von_mises), Some(pulled).filter(tension), Some(shear)]
        });
        let interfaces = self.interfaces.iter_mut().flat_map(|face| {
            let InterfaceSummary { tension: pulled, compression, shear, jump, .. } = face;
            let pulled = Some(pulled).filter(tension);
            [pulled, Some(compression), Some(shear), jump.as_mut()]
        });
        layers.chain(interfaces).collect()
    }

    /// Sets the safety factors anew.
    pub(super) fn compare(&mut self, strengths: &Strengths) {
        self.layers.iter_mut().for_each(|layer| layer.compare(strengths));
    }
}

/// The place of an extreme of [`StressSummary::peaks`] with this number, in a body of these layers.
pub(super) fn place_of(body: &HalfSpace, which: usize, peak: Peak) -> Place {
    let depth = peak.position[2];
    let substrate = usize::from(substrate_material(body).is_some());
    let count = body.layers().len();
    let (layer, is_below) = match which.checked_sub(3 * (count + substrate)) {
        None => (which / 3, false),
        Some(which) if which % 4 == 3 => (which / 4 + 1, true),
        Some(which) => (which / 4, false),
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
        let mut asked = options.into();
        let (body, grid) = (&self.whole.body, &self.whole.grid);
        let request =
            SummaryRequest::checked(body, grid, &self.sliding, strengths, asked.options())?;
        check_memory(grid.shape(), request.memory)?;
        refuse_if(
            asked.options().refine.is_some(),
            "refine must be None where the tractions of a contact are known, and in the summary of a plan: \
             Solution.stress_summary of a contact without friction solves finer cells",
        )?;
        Ok(request.evaluate(self, None, self.whole.half_width(), &mut |part| asked.tell(part)))
    }
}

/// The summary by a plan that is made for this call. Bad options are refused before planning.
pub(super) fn summary_once(
    source: &PressureSource,
    strengths: &Strengths,
    asked: WatchedStress,
) -> Result<StressSummary> {
    let (body, grid, sliding) = (source.body, source.grid, &source.sliding);
    let request = SummaryRequest::checked(body, grid, sliding, strengths, asked.options())?;
    let evaluate = |plan: &StressPlan, progress: &mut StressProgress| {
        request.evaluate(plan, None, plan.whole.half_width(), progress)
    };
    Ok(source.once(asked, request.memory, evaluate)?.unwrap_or_default())
}

/// Arguments of one summary, checked.
pub(super) struct SummaryRequest<'a> {
    strengths: &'a Strengths,
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

impl<'a> SummaryRequest<'a> {
    pub(super) fn checked(
        body: &HalfSpace,
        grid: &Grid,
        sliding: &SlidingSense,
        strengths: &'a Strengths,
        options: &StressOptions,
    ) -> Result<Self> {
        strengths.check()?;
        // Six components, and the in-plane stress above an interface.
        let arrays = 9 + plane_arrays(options.friction != 0.0, false);
        Ok(Self {
            strengths,
            residual: options.residual_by_layer(body)?,
            friction: sliding.traction(body, options)?,
            memory: memory_of(grid.shape(), arrays),
        })
    }

    /// The summary of a plan, at depths for a contact of this half-width. `beside` has what the plan's stress lacks.
    pub(super) fn evaluate(
        &self,
        plan: &StressPlan,
        beside: Option<Beside<'_>>,
        half_width: f64,
        progress: &mut StressProgress,
    ) -> StressSummary {
        let body = &plan.whole.body;
        let regions = regions(body, half_width);
        let in_layers = regions.iter().map(|region| region.len() + 3 * REFINEMENTS);
        let planned = in_layers.sum::<usize>() + body.layers().len();
        let mut planes =
            Planes::new(plan, beside, self.friction, &self.residual, planned, progress);
        let mut summary = StressSummary::default();
        if self.fill(&regions, &mut planes, &mut summary).is_continue() {
            summary.finished = true;
            // A break has nothing left to stop.
            let _ = (planes.progress)(1.0);
        }
        summary
    }

    /// Adds all layers and interfaces to `summary`.
    fn fill(
        &self,
        regions: &[Vec<Place>],
        planes: &mut Planes,
        summary: &mut StressSummary,
    ) -> ControlFlow<()> {
        let body = &planes.plan.whole.body;
        let mut top = 0.0;
        for region in regions {
            let layer = layer(planes, body, region, top, self.strengths)?;
            top = layer.depths[1];
            summary.layers.push(layer);
        }
        for (number, layer) in body.layers().iter().enumerate() {
            summary.interfaces.push(interface(planes, body, number, layer)?);
        }
        ControlFlow::Continue(())
    }
}

/// Summary of the layer whose top face is at depth `top`, from the places of `region`.
fn layer(
    planes: &mut Planes,
    body: &HalfSpace,
    region: &[Place],
    top: f64,
    strengths: &Strengths,
) -> ControlFlow<(), LayerSummary> {
    let mut evaluated: Vec<(Place, [Peak; 3])> = Vec::new();
    for place in region {
        evaluated.push((*place, planes.extremes(place)?));
    }
    let best = [0, 1, 2].map(|which| {
        evaluated.iter().map(|(_, peaks)| peaks[which].value).fold(f64::NEG_INFINITY, f64::max)
    });
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
            let peaks = planes.extremes(&place)?;
            let best = [0, 1, 2].map(|k| if k == which { best[k] } else { f64::INFINITY });
            evaluated.push((place, planes.beyond(peaks, &place, best)?));
            // By the depth in the layer: depths below the surface are equal where a layer is thinner than
            // their rounding.
            evaluated.sort_by(|a, b| a.0.below_top.total_cmp(&b.0.below_top));
        }
    }
    let [von_mises, tension, shear] = [0, 1, 2].map(|which| {
        let peaks = evaluated.iter().map(|(_, peaks)| peaks[which]);
        let first = evaluated[0].1[which];
        peaks.fold(first, |a, b| if b.value > a.value { b } else { a })
    });
    let layer = region[0].layer;
    let own = body.layers().get(layer);
    let thickness = own.map(Layer::thickness);
    let mut summary = LayerSummary {
        layer,
        name: own.and_then(Layer::name).map(String::from),
        depths: [top, thickness.map_or(f64::INFINITY, |h| top + h)],
        yield_safety_factor: None,
        strength_safety_factor: None,
        von_mises,
        tension,
        shear,
    };
    summary.compare(strengths);
    ControlFlow::Continue(summary)
}

/// Summary of the interface below `layer`, which has the `number`.
fn interface(
    planes: &mut Planes,
    body: &HalfSpace,
    number: usize,
    layer: &Layer,
) -> ControlFlow<(), InterfaceSummary> {
    let depth = body.layers()[..=number].iter().map(Layer::thickness).sum();
    let next = body.layers().get(number + 1).map(Layer::material);
    let below = next.or(substrate_material(body));
    let above =
        Place { layer: number, below_top: layer.thickness(), depth, material: layer.material() };
    let [tension, compression, shear] = planes.tractions(&above)?;
    let jump = match below {
        None => None,
        Some(material) => {
            let below = Place { layer: number + 1, below_top: 0.0, depth, material };
            Some(planes.jump(&above, &below)?)
        }
    };
    ControlFlow::Continue(InterfaceSummary {
        interface: number,
        depth,
        tension,
        compression,
        shear,
        jump,
    })
}

/// The plane of stress that was evaluated last, and what evaluates the next.
struct Planes<'a, 'b> {
    plan: &'a StressPlan,
    beside: Option<Beside<'a>>,
    friction: [f64; 2],
    residual: &'a [f64],
    evaluation: Evaluation<'a>,
    /// The six components at the cells.
    fields: [Vec<f64>; STRESSES],
    progress: &'a mut StressProgress<'b>,
    /// Planes evaluated so far.
    done: usize,
    /// Planes that are evaluated at most, but for those below an interface.
    planned: usize,
    beyond: Beyond<'a>,
}

impl<'a, 'b> Planes<'a, 'b> {
    /// Planes of `plan` under a friction and the residual stress of each layer; `progress` is told how
    /// many of those `planned` are done.
    fn new(
        plan: &'a StressPlan,
        beside: Option<Beside<'a>>,
        friction: [f64; 2],
        residual: &'a [f64],
        planned: usize,
        progress: &'a mut StressProgress<'b>,
    ) -> Self {
        let cells = plan.whole.grid.shape().iter().product();
        Self {
            plan,
            beside,
            friction,
            residual,
            evaluation: Evaluation::new(plan, friction, false),
            fields: std::array::from_fn(|_| vec![0.0; cells]),
            progress,
            done: 0,
            planned,
            beyond: Beyond::new(plan, friction),
        }
    }

    /// Evaluates the stress at `place`.
    fn evaluate(&mut self, place: &Place) -> ControlFlow<()> {
        let (done, planned) = (self.done as f64, self.planned as f64);
        let progress = &mut self.progress;
        let mut progress = |part: f64| progress(((done + part) / planned).min(1.0));
        let mut outputs = self.fields.each_mut().map(Vec::as_mut_slice);
        self.evaluation.plane(place, &mut outputs, &mut progress)?;
        if let Some(beside) = &mut self.beside {
            beside.add(place, &self.plan.whole.grid, &mut self.fields, &mut progress)?;
        }
        let residual = self.residual[place.layer];
        for field in &mut self.fields[..2] {
            field.iter_mut().for_each(|s| *s += residual);
        }
        self.done += 1;
        ControlFlow::Continue(())
    }

    /// Whether a cell counts.
    fn counts(&self, cell: usize) -> bool {
        let ny = self.plan.whole.grid.shape()[1];
        self.beside.as_ref().is_none_or(|beside| beside.has([cell / ny, cell % ny]))
    }

    /// Numbers of the cells that count.
    fn cells(&self) -> Vec<usize> {
        (0..self.fields[0].len()).filter(|cell| self.counts(*cell)).collect()
    }

    fn tensor(&self, cell: usize) -> Tensor {
        Tensor::new(self.fields.each_ref().map(|field| field[cell]))
    }

    fn peak(&self, Largest { value, cell }: Largest, place: &Place) -> Peak {
        let ny = self.plan.whole.grid.shape()[1];
        let centre = CellPoint { cell: [cell / ny, cell % ny], within: [0.0; 2] };
        self.peak_at(value, &centre, place, false)
    }

    /// A peak at a point, whose stress is that of loads `within` cells or that of the cell.
    fn peak_at(&self, value: f64, point: &CellPoint, place: &Place, within: bool) -> Peak {
        let [x, y] = self.plan.position(point);
        let window = point.cell.map(|cell| cell..cell + 1);
        let places = std::slice::from_ref(place);
        let error = self.plan.uncertainties(places, self.friction, &window, within);
        Peak { value, position: [x, y, place.depth], uncertainty: error.map(|errors| errors[0]) }
    }

    /// The largest von Mises stress, principal stress and shear stress at `place`.
    fn extremes(&mut self, place: &Place) -> ControlFlow<(), [Peak; 3]> {
        self.evaluate(place)?;
        if let (true, Some(solved)) = (place.depth == 0.0, &self.plan.whole.solved) {
            solved.subcell.set_tractions_at_centres(self.friction, &mut self.fields);
        }
        let [mut von_mises, mut tension, mut shear] = [Largest::NONE; 3];
        for cell in self.cells() {
            let tensor = self.tensor(cell);
            let mises = tensor.von_mises();
            von_mises.offer(mises, cell);
            // The largest principal stress is at most the mean plus 2/3 of von Mises' stress, and the
            // largest shear stress at most 1/√3 of it: most cells need no principal stresses.
            if tensor.mean() + 0.67 * mises > tension.value || 0.58 * mises > shear.value {
                let [first, _, last] = tensor.principal();
                tension.offer(first, cell);
                shear.offer(0.5 * (first - last), cell);
            }
        }
        let of = |tensors: &[Tensor; 1]| three(&tensors[0]);
        let peaks = self.peaks([von_mises, tension, shear], place, &[], of);
        if place.depth == 0.0 { self.with_edge(peaks, place) } else { ControlFlow::Continue(peaks) }
    }

    /// The peaks of the surface, or those at the edge of the contact where they are larger. Between the centres of cells
    /// stresses at the surface fall off from the edge as the root of the distance.
    fn with_edge(&mut self, mut peaks: [Peak; 3], place: &Place) -> ControlFlow<(), [Peak; 3]> {
        let mut points = self.plan.edge_points();
        points.retain(|point| self.beside.as_ref().is_none_or(|beside| beside.has(point.cell)));
        let Some(at) = self.evaluation.point_stress(place) else {
            return ControlFlow::Continue(peaks);
        };
        let ny = self.plan.whole.grid.shape()[1];
        // Where the largest values are, from those in the cells of the edge.
        let in_cells =
            points.iter().map(|point| three(&self.tensor(point.cell[0] * ny + point.cell[1])));
        let in_cells: Vec<_> = in_cells.collect();
        let mut known: Vec<Option<[f64; 3]>> = vec![None; points.len()];
        let (residual, part) = (self.residual[place.layer], self.done as f64 / self.planned as f64);
        let mut value = |k: usize, which: usize| -> ControlFlow<(), f64> {
            if known[k].is_none() {
                let mut told = |_| (self.progress)(part.min(1.0));
                let mut sum = self.evaluation.at_point(place, &at, &points[k], &mut told)?;
                if let Some(beside) = &self.beside {
                    let added = beside.at(self.plan.position(&points[k]));
                    sum.iter_mut().zip(added).for_each(|(sum, value)| *sum += value);
                }
                sum[..2].iter_mut().for_each(|s| *s += residual);
                known[k] = Some(three(&Tensor::new(sum)));
            }
            ControlFlow::Continue(known[k].map_or(f64::NEG_INFINITY, |values| values[which]))
        };
        let mut found = Vec::new();
        for which in [0, 1, 2] {
            let mut starts: Vec<usize> = (0..points.len()).collect();
            starts.sort_by(|a, b| in_cells[*b][which].total_cmp(&in_cells[*a][which]));
            starts.truncate(EDGE_STARTS);
            let mut best: Option<(usize, f64)> = None;
            for k in starts {
                let value = value(k, which)?;
                if best.is_none_or(|(_, largest)| value > largest) {
                    best = Some((k, value));
                }
            }
            let Some((mut k, mut largest)) = best else {
                break;
            };
            let mut step = self.plan.whole.half_width() * FIRST_STEP_ALONG_EDGE;
            let shortest =
                0.5 * self.plan.whole.grid.spacing().into_iter().fold(f64::INFINITY, f64::min);
            while step > shortest {
                let mut moved = false;
                for beside in self.plan.along_edge(&points, k, step) {
                    let value = value(beside, which)?;
                    if value > largest {
                        (k, largest, moved) = (beside, value, true);
                    }
                }
                if !moved {
                    step *= 0.5;
                }
            }
            found.push((which, largest, points[k]));
        }
        for (which, value, point) in found {
            if value > peaks[which].value {
                peaks[which] = self.peak_at(value, &point, place, true);
            }
        }
        ControlFlow::Continue(peaks)
    }

    /// Extremes of the traction at `place`: the largest and the smallest σ_zz, and the largest √(σ_xz² + σ_yz²).
    fn tractions(&mut self, place: &Place) -> ControlFlow<(), [Peak; 3]> {
        self.evaluate(place)?;
        let [mut tension, mut compression, mut shear] = [Largest::NONE; 3];
        for cell in self.cells() {
            let Tensor { zz, yz, xz, .. } = self.tensor(cell);
            tension.offer(zz, cell);
            compression.offer(-zz, cell);
            shear.offer(xz.hypot(yz), cell);
        }
        let of = |tensors: &[Tensor; 1]| {
            let Tensor { zz, yz, xz, .. } = tensors[0];
            [zz, -zz, xz.hypot(yz)]
        };
        let peaks = self.peaks([tension, compression, shear], place, &[], of);
        let mut peaks =
            self.with_beyond((peaks, largest_of(&peaks), [f64::NEG_INFINITY; 3]), &[*place], of)?;
        peaks[1].value = -peaks[1].value;
        ControlFlow::Continue(peaks)
    }

    /// Largest jump of the in-plane stress from the plane at `above`, which was evaluated last, to that at `below`.
    fn jump(&mut self, above: &Place, below: &Place) -> ControlFlow<(), Peak> {
        let before = [self.fields.clone()];
        self.evaluate(below)?;
        let mut largest = Largest::NONE;
        for cell in self.cells() {
            largest.offer(jump(self.tensors(&before, cell)), cell);
        }
        let of = |tensors: &[Tensor; 2]| [jump(*tensors)];
        let peaks = self.peaks([largest], below, &before, of);
        let [peak] = self.with_beyond(
            (peaks, largest_of(&peaks), [f64::NEG_INFINITY; 1]),
            &[*above, *below],
            of,
        )?;
        ControlFlow::Continue(peak)
    }

    /// Stresses of a cell at one place or more: those of the planes `before`, and of the one evaluated last.
    fn tensors<const K: usize>(&self, before: &[[Vec<f64>; STRESSES]], cell: usize) -> [Tensor; K] {
        std::array::from_fn(|k| {
            let fields = before.get(k).unwrap_or(&self.fields);
            Tensor::new(fields.each_ref().map(|field| field[cell]))
        })
    }

    /// The peaks of the largest values at `place`. `of` has the values of a cell, from its stresses at one place or more: those
    /// of the planes `before`, and of the one evaluated last.
    fn peaks<const N: usize, const K: usize>(
        &self,
        found: [Largest; N],
        place: &Place,
        before: &[[Vec<f64>; STRESSES]],
        of: impl Fn(&[Tensor; K]) -> [f64; N],
    ) -> [Peak; N] {
        std::array::from_fn(|n| {
            let peak = self.peak(found[n], place);
            let value = |cell: usize| self.counts(cell).then(|| of(&self.tensors(before, cell))[n]);
            let between = found[n].between(&self.plan.whole.grid, value);
            Peak { uncertainty: peak.uncertainty.map(|error| error + between), ..peak }
        })
    }

    /// The peaks of [`Planes::extremes`], or larger ones beyond the grid.
    fn beyond(
        &mut self,
        peaks: [Peak; 3],
        place: &Place,
        best: [f64; 3],
    ) -> ControlFlow<(), [Peak; 3]> {
        self.with_beyond((peaks, largest_of(&peaks), best), &[*place], |tensors: &[Tensor; 1]| {
            three(&tensors[0])
        })
    }

    /// The peaks at the last of `places`, or larger ones beyond the grid: [`Beyond::peaks`].
    fn with_beyond<const N: usize, const K: usize>(
        &mut self,
        found: ([Peak; N], f64, [f64; N]),
        places: &[Place; K],
        of: impl Fn(&[Tensor; K]) -> [f64; N],
    ) -> ControlFlow<(), [Peak; N]> {
        if self.beside.is_some() {
            return ControlFlow::Continue(found.0);
        }
        let part = (self.done as f64 / self.planned as f64).min(1.0);
        let mut told = |_| (self.progress)(part);
        self.beyond.peaks(found, places, self.residual, of, &mut told)
    }
}

/// The largest magnitude of peaks.
fn largest_of(peaks: &[Peak]) -> f64 {
    peaks.iter().fold(0.0, |largest, peak| peak.value.abs().max(largest))
}

/// Jump of the in-plane stress from above to below, as the larger principal value of its magnitude.
fn jump([above, below]: [Tensor; 2]) -> f64 {
    let (xx, yy, xy) = (below.xx - above.xx, below.yy - above.yy, below.xy - above.xy);
    (0.5 * (xx + yy)).abs() + (0.5 * (xx - yy)).hypot(xy)
}

/// Von Mises stress, largest principal stress and largest shear stress.
fn three(tensor: &Tensor) -> [f64; 3] {
    let [first, _, last] = tensor.principal();
    [tensor.von_mises(), first, 0.5 * (first - last)]
}

/// Points of the edge from the cells with the largest values, at which a search along the edge starts.
const EDGE_STARTS: usize = 4;

/// First step of a search along the edge, in half-widths of the contact; steps are halved down to half a cell.
const FIRST_STEP_ALONG_EDGE: f64 = 0.25;

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

/// The largest step, as a fraction of the distance to the next depth.
const LONGEST_REFINEMENT: f64 = 0.9;

/// Place of the vertex of the parabola through the largest value in `evaluated` and its two
/// neighbours. None where the largest value is the first or the last, or is that vertex already.
fn refined_peak(evaluated: &[(Place, f64)]) -> Option<Place> {
    let value = |k: usize| evaluated[k].1;
    let best = (0..evaluated.len()).reduce(|a, b| if value(b) > value(a) { b } else { a })?;
    if best == 0 || best + 1 == evaluated.len() {
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
    if step.abs() < SHORTEST_REFINEMENT * a.min(b) {
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
