//! What a designer asks of a stress field: peaks in each layer, tractions at each interface.

use std::ops::ControlFlow;

use super::depths::{refined_peak, regions};
use super::derived::{Peak, Tensor};
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
    /// Depths of the top and bottom faces \[m\]; the substrate's bottom is at infinity.
    pub depths: [f64; 2],
    /// Largest von Mises stress.
    pub von_mises: Peak,
    /// Largest principal stress: tension where it is positive.
    pub tension: Peak,
    /// Largest shear stress on any plane.
    pub shear: Peak,
    /// Yield stress over the largest von Mises stress.
    pub yield_margin: Option<f64>,
    /// Tensile strength over the largest tension; none where there is no tension.
    pub strength_margin: Option<f64>,
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
struct SummaryRequest {
    /// Strengths of each layer and of the substrate.
    strengths: Vec<LayerStrength>,
    /// Residual stress of each layer and of the substrate.
    residual: Vec<f64>,
    /// μ times the unit vector of the traction on the body.
    friction: [f64; 2],
    /// Bytes that the summary takes, without the plan.
    memory: u64,
}

/// Strengths of one layer, where they are known.
struct LayerStrength {
    yield_stress: Option<f64>,
    strength: Option<f64>,
}

impl SummaryRequest {
    fn checked(
        body: &HalfSpace,
        grid: &Grid,
        friction_sign: f64,
        strengths: &Strengths,
        options: &StressOptions,
    ) -> Result<Self> {
        let of_layer = |name, values: &[Option<f64>], layer: usize| {
            let value = values.get(layer).copied().flatten();
            value.map(|value| positive(name, value)).transpose()
        };
        let strength = |layer| {
            Ok(LayerStrength {
                yield_stress: of_layer("yield_stress", &strengths.yield_stress, layer)?,
                strength: of_layer("strength", &strengths.strength, layer)?,
            })
        };
        let [nx, ny] = grid.shape();
        // Six components, and the in-plane stress above an interface.
        let planes = 8 * 9 * (nx * ny) as u64;
        Ok(Self {
            strengths: (0..=body.layers().len())
                .map(strength)
                .collect::<Result<_>>()?,
            residual: options.residual_by_layer(body)?,
            friction: friction(body, friction_sign, options)?,
            memory: planes + PlaneEvaluator::memory(grid, options.friction != 0.0, false),
        })
    }

    fn evaluate(&self, plan: &StressPlan, progress: &mut StressProgress) -> StressSummary {
        let regions = regions(&plan.body, plan.half_width);
        let in_layers: usize = regions
            .iter()
            .map(|region| region.len() + 3 * REFINEMENTS)
            .sum();
        let mut planes = Planes {
            body: &plan.body,
            grid: &plan.grid,
            residual: &self.residual,
            evaluator: PlaneEvaluator::new(plan, self.friction, false),
            fields: std::array::from_fn(|_| vec![0.0; plan.grid.shape().iter().product()]),
            progress,
            done: 0,
            planned: in_layers + plan.body.layers().len(),
        };
        let mut summary = StressSummary::default();
        let finished = planes.summarise(&regions, &self.strengths, &mut summary);
        summary.finished = finished.is_continue();
        if summary.finished {
            // All is done: a break has nothing left to stop.
            let _ = (planes.progress)(1.0);
        }
        summary
    }
}

/// The plane of stress that was evaluated last, and what evaluates the next.
struct Planes<'a, 'b> {
    body: &'a HalfSpace,
    grid: &'a Grid,
    residual: &'a [f64],
    evaluator: PlaneEvaluator<'a>,
    /// The six components at the cells.
    fields: [Vec<f64>; 6],
    progress: &'a mut StressProgress<'b>,
    /// Planes evaluated so far.
    done: usize,
    /// Planes that are evaluated at most, but for those below an interface.
    planned: usize,
}

/// The extremes on one plane, or in one layer.
#[derive(Debug, Clone, Copy)]
struct Extremes {
    von_mises: Peak,
    tension: Peak,
    shear: Peak,
}

impl Extremes {
    /// Each of the extremes, to be refined by itself.
    const EACH: [fn(&Self) -> Peak; 3] = [|e| e.von_mises, |e| e.tension, |e| e.shear];
}

/// The largest value found so far, and its cell.
#[derive(Debug, Clone, Copy)]
struct Largest {
    value: f64,
    cell: usize,
}

impl Largest {
    /// Before any value.
    const NONE: Self = Self {
        value: f64::NEG_INFINITY,
        cell: 0,
    };

    fn offer(&mut self, value: f64, cell: usize) {
        if value > self.value {
            *self = Self { value, cell };
        }
    }
}

impl Planes<'_, '_> {
    /// Adds the summaries of all layers and interfaces to `summary`.
    fn summarise(
        &mut self,
        regions: &[Vec<Place>],
        strengths: &[LayerStrength],
        summary: &mut StressSummary,
    ) -> ControlFlow<()> {
        let mut top = 0.0;
        for (region, strengths) in regions.iter().zip(strengths) {
            let layer = self.layer(region, top, strengths)?;
            top = layer.depths[1];
            summary.layers.push(layer);
        }
        for (number, depth) in self.body.interfaces().into_iter().enumerate() {
            let interface = self.interface(number, depth)?;
            summary.interfaces.push(interface);
        }
        ControlFlow::Continue(())
    }

    /// Evaluates the stress at `place`.
    fn evaluate(&mut self, place: &Place) -> ControlFlow<()> {
        let (done, planned) = (self.done as f64, self.planned as f64);
        let progress = &mut self.progress;
        let mut progress = |part: f64| progress(((done + part) / planned).min(1.0));
        let mut outputs = self.fields.each_mut().map(Vec::as_mut_slice);
        self.evaluator
            .evaluate(place, &mut outputs, &mut progress)?;
        let residual = self.residual[place.layer];
        for field in &mut self.fields[..2] {
            field.iter_mut().for_each(|s| *s += residual);
        }
        self.done += 1;
        ControlFlow::Continue(())
    }

    fn tensor(&self, cell: usize) -> Tensor {
        Tensor::new(self.fields.each_ref().map(|field| field[cell]))
    }

    fn peak(&self, largest: Largest, depth: f64) -> Peak {
        let ny = self.grid.shape()[1];
        let Largest { value, cell } = largest;
        let (x, y) = (self.grid.x()[cell / ny], self.grid.y()[cell % ny]);
        Peak {
            value,
            position: [x, y, depth],
        }
    }

    /// Extremes at `place`.
    fn extremes(&mut self, place: &Place) -> ControlFlow<(), Extremes> {
        self.evaluate(place)?;
        let [mut von_mises, mut tension, mut shear] = [Largest::NONE; 3];
        for cell in 0..self.fields[0].len() {
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
        ControlFlow::Continue(Extremes {
            von_mises: self.peak(von_mises, place.depth),
            tension: self.peak(tension, place.depth),
            shear: self.peak(shear, place.depth),
        })
    }

    /// Summary of the layer whose top face is at depth `top`, from the places of `region`.
    fn layer(
        &mut self,
        region: &[Place],
        top: f64,
        strengths: &LayerStrength,
    ) -> ControlFlow<(), LayerSummary> {
        let mut evaluated: Vec<(Place, Extremes)> = Vec::new();
        for place in region {
            evaluated.push((*place, self.extremes(place)?));
        }
        for which in Extremes::EACH {
            for _ in 0..REFINEMENTS {
                let value = |(place, e): &(Place, Extremes)| (*place, which(e).value);
                let values: Vec<_> = evaluated.iter().map(value).collect();
                let Some(place) = refined_peak(&values) else {
                    break;
                };
                evaluated.push((place, self.extremes(&place)?));
                evaluated.sort_by(|a, b| a.0.depth.total_cmp(&b.0.depth));
            }
        }
        let [von_mises, tension, shear] = Extremes::EACH.map(|which| {
            let peaks = evaluated[1..].iter().map(|(_, extremes)| which(extremes));
            let first = which(&evaluated[0].1);
            peaks.fold(first, |a, b| if b.value > a.value { b } else { a })
        });
        let layer = region[0].layer;
        let thickness = self.body.layers().get(layer).map(Layer::thickness);
        let margin = |strength: Option<f64>, peak: Peak| {
            let strength = strength.filter(|_| peak.value > 0.0);
            strength.map(|strength| strength / peak.value)
        };
        ControlFlow::Continue(LayerSummary {
            layer,
            depths: [top, thickness.map_or(f64::INFINITY, |h| top + h)],
            yield_margin: margin(strengths.yield_stress, von_mises),
            strength_margin: margin(strengths.strength, tension),
            von_mises,
            tension,
            shear,
        })
    }

    /// Summary of interface `number`, which is at `depth`.
    fn interface(&mut self, number: usize, depth: f64) -> ControlFlow<(), InterfaceSummary> {
        let on = |side: Side| place(self.body, depth, side).ok();
        let (above, below) = (on(Side::Above), on(Side::Below));
        // Every interface has a layer above it.
        let Some(above) = above else {
            return ControlFlow::Break(());
        };
        self.evaluate(&above)?;
        let [mut tension, mut compression, mut shear] = [Largest::NONE; 3];
        for cell in 0..self.fields[0].len() {
            let Tensor { zz, yz, xz, .. } = self.tensor(cell);
            tension.offer(zz, cell);
            compression.offer(-zz, cell);
            shear.offer(xz.hypot(yz), cell);
        }
        compression.value = -compression.value;
        let jump = match below {
            Some(below) => Some(self.jump(&below)?),
            // On a rigid base there is no stress below.
            None => None,
        };
        ControlFlow::Continue(InterfaceSummary {
            interface: number,
            depth,
            tension: self.peak(tension, depth),
            compression: self.peak(compression, depth),
            shear: self.peak(shear, depth),
            jump,
        })
    }

    /// Largest jump of the in-plane stress from the plane evaluated last to that at `below`.
    fn jump(&mut self, below: &Place) -> ControlFlow<(), Peak> {
        let [above_xx, above_yy, above_xy] = [0, 1, 3].map(|k| self.fields[k].clone());
        self.evaluate(below)?;
        let mut largest = Largest::NONE;
        let above = above_xx.iter().zip(&above_yy).zip(&above_xy).enumerate();
        for (cell, ((above_xx, above_yy), above_xy)) in above {
            let below = self.tensor(cell);
            let (xx, yy, xy) = (
                below.xx - above_xx,
                below.yy - above_yy,
                below.xy - above_xy,
            );
            let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
            largest.offer(mean.abs() + half.hypot(xy), cell);
        }
        ControlFlow::Continue(self.peak(largest, below.depth))
    }
}
