//! Summary of a stress field: peaks in each layer, tractions at each interface.

use std::ops::ControlFlow;

use super::derived::Peak;
use super::friction::friction;
use super::options::{Side, StressOptions, StressProgress};
use super::plan::{Source, StressPlan};
use super::plane::PlaneEvaluator;
use super::section::place;
use crate::body::{HalfSpace, Layer};
use crate::error::{Result, positive};
use crate::grid::Grid;
use crate::parallel::check_memory;
use crate::response::interior::Place;

mod depths;
mod extremes;

use depths::{refined_peak, regions};
use extremes::{Extremes, Planes, Tractions};

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
pub struct LayerSummary {
    /// Number of the layer, from the surface down; the substrate's is the number of layers.
    pub layer: usize,
    /// Name of the layer, if it has one; the substrate has none.
    pub name: Option<String>,
    /// Depths of the top and bottom faces \[m\]; the substrate's bottom is at infinity.
    pub depths: [f64; 2],
    /// Largest von Mises stress.
    pub von_mises: Peak,
    /// Largest principal stress: tension where it is positive.
    pub tension: Peak,
    /// Largest shear stress on any plane.
    pub shear: Peak,
    /// Safety factor against yield: the yield stress divided by the largest von Mises stress.
    pub yield_safety_factor: Option<f64>,
    /// Safety factor against fracture: the tensile strength divided by the largest tension; none where
    /// there is no tension.
    pub strength_safety_factor: Option<f64>,
}

/// The extremes at one interface.
#[derive(Debug, Clone, PartialEq)]
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
pub struct StressSummary {
    /// Layers from the surface down; the substrate last, unless it is rigid.
    pub layers: Vec<LayerSummary>,
    /// Interfaces from the surface down.
    pub interfaces: Vec<InterfaceSummary>,
    /// Whether all was done. If `progress` stopped it, layers and interfaces are those finished before.
    pub finished: bool,
}

/// How many times a peak inside a layer is refined by a parabola. Chosen by trial.
const REFINEMENTS: usize = 3;

impl StressPlan {
    /// Peaks in each layer and tractions at each interface. `side`, `section` and `displacement` of the
    /// options are not used.
    ///
    /// Depths are the faces of the layers, and some 18 inside each, spread over its thickness and over
    /// the width of the contact; a peak inside is then refined by parabolas through three depths
    /// (successive parabolic interpolation). Positions are cell centres.
    ///
    /// # Errors
    /// Bad options, a strength that is not finite and above 0, or too little memory.
    pub fn summary(
        &self,
        strengths: &Strengths,
        options: &StressOptions,
        progress: &mut StressProgress,
    ) -> Result<StressSummary> {
        let request = SummaryRequest::checked(
            &self.body,
            &self.grid,
            self.friction_sign,
            strengths,
            options,
        )?;
        check_memory(self.grid.shape(), request.memory)?;
        Ok(request.evaluate(self, progress))
    }
}

/// The summary by a plan that is made for this call. Bad options are refused before planning.
pub(super) fn summary_once(
    source: &Source,
    strengths: &Strengths,
    options: &StressOptions,
    progress: &mut StressProgress,
) -> Result<StressSummary> {
    let (body, grid) = (source.body, source.grid);
    let request = SummaryRequest::checked(body, grid, source.friction_sign, strengths, options)?;
    check_memory(grid.shape(), request.memory + source.memory())?;
    Ok(match source.plan(options.threads, progress)? {
        Some(plan) => request.evaluate(&plan, progress),
        None => StressSummary::default(),
    })
}

/// Arguments of one summary, checked.
struct SummaryRequest<'a> {
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
        let yields = self
            .yield_stress
            .iter()
            .map(|value| ("yield_stress", value));
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
    fn checked(
        body: &HalfSpace,
        grid: &Grid,
        friction_sign: f64,
        strengths: &'a Strengths,
        options: &StressOptions,
    ) -> Result<Self> {
        strengths.check()?;
        let [nx, ny] = grid.shape();
        // Six components, and the in-plane stress above an interface.
        let planes = 8 * 9 * (nx * ny) as u64;
        Ok(Self {
            strengths,
            residual: options.residual_by_layer(body)?,
            friction: friction(body, friction_sign, options)?,
            memory: planes + PlaneEvaluator::memory(grid, options.friction != 0.0, false),
        })
    }

    fn evaluate(&self, plan: &StressPlan, progress: &mut StressProgress) -> StressSummary {
        let body = &plan.body;
        let regions = regions(body, plan.half_width);
        let in_layers: usize = regions
            .iter()
            .map(|region| region.len() + 3 * REFINEMENTS)
            .sum();
        let planned = in_layers + body.layers().len();
        let mut planes = Planes::new(plan, self.friction, &self.residual, planned, progress);
        let mut summary = StressSummary::default();
        let flow = self.fill(body, &regions, &mut planes, &mut summary);
        if flow.is_continue() {
            summary.finished = true;
            planes.finish();
        }
        summary
    }

    /// Adds all layers and interfaces to `summary`.
    fn fill(
        &self,
        body: &HalfSpace,
        regions: &[Vec<Place>],
        planes: &mut Planes,
        summary: &mut StressSummary,
    ) -> ControlFlow<()> {
        let mut top = 0.0;
        for region in regions {
            let layer = layer(planes, body, region, top, self.strengths)?;
            top = layer.depths[1];
            summary.layers.push(layer);
        }
        for (number, depth) in body.interfaces().into_iter().enumerate() {
            summary
                .interfaces
                .extend(interface(planes, body, number, depth)?);
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
    let mut evaluated: Vec<(Place, Extremes)> = Vec::new();
    for place in region {
        evaluated.push((*place, planes.extremes(place)?));
    }
    for which in Extremes::EACH {
        for _ in 0..REFINEMENTS {
            let value = |(place, e): &(Place, Extremes)| (*place, which(e).value);
            let values: Vec<_> = evaluated.iter().map(value).collect();
            let Some(place) = refined_peak(&values) else {
                break;
            };
            evaluated.push((place, planes.extremes(&place)?));
            evaluated.sort_by(|a, b| a.0.depth.total_cmp(&b.0.depth));
        }
    }
    let [von_mises, tension, shear] = Extremes::EACH.map(|which| {
        let peaks = evaluated[1..].iter().map(|(_, extremes)| which(extremes));
        let first = which(&evaluated[0].1);
        peaks.fold(first, |a, b| if b.value > a.value { b } else { a })
    });
    let layer = region[0].layer;
    let own = body.layers().get(layer);
    let thickness = own.map(Layer::thickness);
    let [yield_stress, strength] = strengths.of_layer(layer);
    let factor = |strength: Option<f64>, peak: Peak| {
        let strength = strength.filter(|_| peak.value > 0.0);
        strength.map(|strength| strength / peak.value)
    };
    ControlFlow::Continue(LayerSummary {
        layer,
        name: own.and_then(Layer::name).map(String::from),
        depths: [top, thickness.map_or(f64::INFINITY, |h| top + h)],
        yield_safety_factor: factor(yield_stress, von_mises),
        strength_safety_factor: factor(strength, tension),
        von_mises,
        tension,
        shear,
    })
}

/// Summary of interface `number`, which is at `depth`; none if no layer ends there.
fn interface(
    planes: &mut Planes,
    body: &HalfSpace,
    number: usize,
    depth: f64,
) -> ControlFlow<(), Option<InterfaceSummary>> {
    let Ok(above) = place(body, depth, Side::Above) else {
        return ControlFlow::Continue(None);
    };
    let Tractions {
        tension,
        compression,
        shear,
    } = planes.tractions(&above)?;
    let jump = match place(body, depth, Side::Below) {
        Ok(below) => Some(planes.jump(&below)?),
        // On a rigid base there is no stress below.
        Err(_) => None,
    };
    ControlFlow::Continue(Some(InterfaceSummary {
        interface: number,
        depth,
        tension,
        compression,
        shear,
        jump,
    }))
}
