//! Summary of a stress field: peaks in each layer, tractions at each interface.

use std::ops::ControlFlow;

use super::derived::Peak;
use super::field::Percent;
use super::friction::Sliding;
use super::half_space::Source;
use super::options::{StressOptions, StressProgress};
use super::plan::{PlaneStress, StressPlan};
use crate::compliance::response::interior::Place;
use crate::error::{Result, positive};
use crate::model::body::{HalfSpace, Layer, Substrate};
use crate::model::grid::Grid;
use crate::numerics::parallel::check_memory;

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

/// Estimated error over an extreme above which a warning says so. The estimate is some three times the
/// error (`tests/stress/resolution.rs`).
const UNRESOLVED: f64 = 0.25;

/// Error, over the largest von Mises stress of all layers, below which a warning says nothing.
const NEGLIGIBLE: f64 = 0.02;

impl StressSummary {
    /// Warnings about what the cells do not resolve: layers and interfaces whose extremes have an estimated
    /// error above a quarter of them.
    pub fn warnings(&self) -> Vec<String> {
        let peaks = self.layers.iter().map(|layer| layer.von_mises.value);
        let negligible = NEGLIGIBLE * peaks.fold(0.0, f64::max);
        let unresolved = |peaks: &[(&str, &Peak)]| -> Option<String> {
            let ratio = |(name, peak): &(&str, &Peak)| {
                let error = peak.uncertainty.filter(|error| *error > negligible)?;
                let ratio = error / peak.value.abs();
                (ratio > UNRESOLVED).then(|| format!("{name} by {}", Percent(ratio)))
            };
            let said: Vec<String> = peaks.iter().filter_map(ratio).collect();
            (!said.is_empty()).then(|| said.join(", "))
        };
        let layers = self.layers.iter().filter_map(|layer| {
            let LayerSummary {
                von_mises,
                tension,
                shear,
                ..
            } = layer;
            let peaks = [
                ("von Mises", von_mises),
                ("tension", tension),
                ("shear", shear),
            ];
            // Compression everywhere is no tension to be known.
            let known = if tension.value > 0.0 { 3 } else { 1 };
            let said = unresolved(&peaks[..known])?;
            Some((format!("layers[{}]", layer.layer), said))
        });
        let interfaces = self.interfaces.iter().filter_map(|face| {
            let said = unresolved(&[("shear", &face.shear), ("compression", &face.compression)])?;
            Some((format!("interfaces[{}]", face.interface), said))
        });
        let said = |(place, said): (String, String)| {
            format!(
                "the extremes in {place} are uncertain, {said}, due to the size of the cells: take \
                 smaller cells"
            )
        };
        layers.chain(interfaces).map(said).collect()
    }
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
            &self.whole.body,
            &self.whole.grid,
            &self.whole.sliding,
            strengths,
            options,
        )?;
        check_memory(self.whole.grid.shape(), request.memory)?;
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
    let request = SummaryRequest::checked(body, grid, &source.sliding, strengths, options)?;
    check_memory(grid.shape(), request.memory + source.memory())?;
    Ok(match source.complete(options.threads, progress)? {
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
        sliding: &Sliding,
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
            friction: sliding.traction(body, options)?,
            memory: planes + PlaneStress::memory(grid, options.friction != 0.0, false),
        })
    }

    fn evaluate(&self, plan: &StressPlan, progress: &mut StressProgress) -> StressSummary {
        let body = &plan.whole.body;
        let regions = regions(body, plan.whole.half_width);
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
        for (number, layer) in body.layers().iter().enumerate() {
            let faces = faces(body, number, layer);
            summary.interfaces.push(interface(planes, number, &faces)?);
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
            // By the depth in the layer: depths below the surface are equal where a layer is thinner than
            // their rounding.
            evaluated.sort_by(|a, b| a.0.below_top.total_cmp(&b.0.below_top));
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

/// Places on both sides of an interface. There is none below it on a rigid base.
struct Faces {
    above: Place,
    below: Option<Place>,
}

/// The two sides of the interface below `layer`, which has the `number`.
fn faces(body: &HalfSpace, number: usize, layer: &Layer) -> Faces {
    let depth = body.layers()[..=number].iter().map(Layer::thickness).sum();
    let next = body.layers().get(number + 1).map(Layer::material);
    let below = next.or(match body.substrate() {
        Substrate::Elastic(material) => Some(material),
        Substrate::Rigid => None,
    });
    Faces {
        above: Place {
            layer: number,
            below_top: layer.thickness(),
            depth,
            material: layer.material(),
        },
        below: below.map(|material| Place {
            layer: number + 1,
            below_top: 0.0,
            depth,
            material,
        }),
    }
}

/// Summary of interface `number`, which has these `faces`.
fn interface(
    planes: &mut Planes,
    number: usize,
    faces: &Faces,
) -> ControlFlow<(), InterfaceSummary> {
    let Tractions {
        tension,
        compression,
        shear,
    } = planes.tractions(&faces.above)?;
    let below = faces.below.as_ref();
    let jump = below.map(|below| planes.jump(below));
    ControlFlow::Continue(InterfaceSummary {
        interface: number,
        depth: faces.above.depth,
        tension,
        compression,
        shear,
        jump: match jump {
            Some(jump) => Some(jump?),
            None => None,
        },
    })
}
