//! What a designer asks of a stress field: peaks in each layer, tractions at each interface.

use std::ops::ControlFlow;

use ndarray::ArrayRef2;

use super::depths::{between, half_width, regions};
use super::derived::{Peak, Tensor, principal, von_mises};
use super::loaded::{Form, Loaded, Scratch};
use super::section::place;
use super::{Side, StressOptions, StressProgress, residual};
use crate::body::HalfSpace;
use crate::error::{Result, positive};
use crate::grid::Grid;
use crate::parallel::check_memory;
use crate::response::interior::Place;

/// What the layers bear: of each from the surface down, and of the substrate. Those that are left
/// out are not known.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Limits {
    /// Yield stresses \[Pa\], which von Mises' stress is compared with.
    pub yield_stress: Vec<Option<f64>>,
    /// Tensile strengths \[Pa\], which the largest principal stress is compared with.
    pub strength: Vec<Option<f64>>,
}

/// The extremes in one layer, or in the substrate.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerSummary {
    /// Its number, from the surface down; that of the substrate is the number of layers.
    pub layer: usize,
    /// Depths of its faces \[m\]; of the substrate, that of its top and infinity.
    pub depths: [f64; 2],
    /// Largest von Mises stress.
    pub von_mises: Peak,
    /// Largest principal stress: tension where it is positive.
    pub tension: Peak,
    /// Largest shear stress on any plane.
    pub shear: Peak,
    /// Yield stress over the largest von Mises stress.
    pub yield_margin: Option<f64>,
    /// Strength over the largest tension; none where there is no tension.
    pub strength_margin: Option<f64>,
}

/// The extremes at one interface.
#[derive(Debug, Clone, PartialEq)]
pub struct InterfaceSummary {
    /// Its number, from the surface down.
    pub interface: usize,
    /// Its depth \[m\].
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
#[derive(Debug, Clone, PartialEq)]
pub struct StressSummary {
    /// From the surface down; the substrate last, unless it is rigid.
    pub layers: Vec<LayerSummary>,
    /// From the surface down.
    pub interfaces: Vec<InterfaceSummary>,
    /// Whether `progress` let it finish: otherwise peaks are those of the depths that were done.
    pub finished: bool,
}

/// How often the neighbourhood of a peak is looked at again.
const REFINEMENTS: usize = 3;

/// The summary of `body` under the `pressure` (nx, ny) of a contact on `grid`; `section` and
/// `displacement` of the options are not used.
///
/// Depths are the faces of layers, and inside them some 18 that are spread over its thickness and
/// over the width of the contact; a peak inside is then found by parabolas through three depths.
/// Positions are cell centres.
///
/// # Errors
/// Bad input, or too little memory.
pub(super) fn stress_summary(
    body: &HalfSpace,
    grid: &Grid,
    pressure: &ArrayRef2<f64>,
    limits: &Limits,
    options: &StressOptions,
    progress: &mut StressProgress,
) -> Result<StressSummary> {
    let limit = |name, values: &[Option<f64>], layer: usize| {
        let value = values.get(layer).copied().flatten();
        value.map(|value| positive(name, value)).transpose()
    };
    let count = body.layers().len() + 1;
    let mut bears = Vec::new();
    for layer in 0..count {
        bears.push((
            limit("yield_stress", &limits.yield_stress, layer)?,
            limit("strength", &limits.strength, layer)?,
        ));
    }
    check_memory(
        grid.shape(),
        8 * 7 * pressure.len() as u64 + Loaded::memory(grid, Form::Solved, options),
    )?;
    let options = &StressOptions {
        displacement: false,
        ..options.clone()
    };
    let residual = residual(body, &options.residual)?;
    let mut summary = StressSummary {
        layers: Vec::new(),
        interfaces: Vec::new(),
        finished: false,
    };
    let mut go_on = || progress(0.0) == ControlFlow::Continue(());
    let loaded = Loaded::new(body, grid, pressure, Form::Solved, options, &mut go_on)?;
    let Some(loaded) = loaded else {
        return Ok(summary);
    };
    let mut planes = Planes {
        body,
        grid,
        residual,
        scratch: loaded.scratch(6),
        loaded,
        fields: (0..6).map(|_| vec![0.0; pressure.len()]).collect(),
        progress,
        done: 0,
        planned: 0,
    };
    let regions = regions(body, half_width(grid, pressure));
    planes.planned = regions
        .iter()
        .map(|region| region.len() + 3 * REFINEMENTS)
        .sum();
    planes.planned += body.layers().len();
    let finished = planes.layers(&regions, &bears, &mut summary.layers)
        && planes.interfaces(&mut summary.interfaces);
    if finished {
        let _ = (planes.progress)(1.0);
    }
    summary.finished = finished;
    Ok(summary)
}

/// Planes of stress, one after another.
struct Planes<'a, 'b> {
    body: &'a HalfSpace,
    grid: &'a Grid,
    residual: Vec<f64>,
    loaded: Loaded,
    scratch: Scratch,
    /// The six components.
    fields: Vec<Vec<f64>>,
    progress: &'a mut StressProgress<'b>,
    done: usize,
    planned: usize,
}

/// Von Mises, tension and shear.
type Extremes = [Peak; 3];

/// One of the extremes at each place.
fn values(seen: &[(Place, Extremes)], which: usize) -> Vec<(Place, f64)> {
    let value = |(place, extremes): &(Place, Extremes)| (*place, extremes[which].value);
    seen.iter().map(value).collect()
}

impl Planes<'_, '_> {
    /// Computes the stress at `place`; false where it is to stop.
    fn compute(&mut self, place: &Place) -> bool {
        self.loaded.coefficients(place, &mut self.scratch);
        let (done, planned) = (self.done as f64, self.planned as f64);
        let progress = &mut self.progress;
        let mut go_on =
            |part: f64| progress(((done + part) / planned).min(1.0)) == ControlFlow::Continue(());
        let mut outputs: Vec<_> = self.fields.iter_mut().map(Vec::as_mut_slice).collect();
        if !self
            .loaded
            .plane(&mut outputs, &mut self.scratch, &mut go_on)
        {
            return false;
        }
        for field in &mut self.fields[..2] {
            field
                .iter_mut()
                .for_each(|s| *s += self.residual[place.layer]);
        }
        self.done += 1;
        true
    }

    fn tensor(&self, cell: usize) -> Tensor {
        std::array::from_fn(|k| self.fields[k][cell])
    }

    fn peak(&self, value: f64, cell: usize, depth: f64) -> Peak {
        let ny = self.grid.shape()[1];
        let (x, y) = (self.grid.x()[cell / ny], self.grid.y()[cell % ny]);
        Peak {
            value,
            position: [x, y, depth],
        }
    }

    /// Extremes of the plane that was computed last.
    fn extremes(&self, depth: f64) -> Extremes {
        let mut best = [(f64::NEG_INFINITY, 0); 3];
        for cell in 0..self.fields[0].len() {
            let tensor = self.tensor(cell);
            let mises = von_mises(tensor);
            let mean = (tensor[0] + tensor[1] + tensor[2]) / 3.0;
            // σ1 ≤ mean + 2/3 of von Mises' stress, the shear ≤ 1/√3 of it: most cells need no
            // principal stresses.
            if mises > best[0].0 {
                best[0] = (mises, cell);
            }
            if mean + 0.67 * mises > best[1].0 || 0.58 * mises > best[2].0 {
                let [first, _, last] = principal(tensor);
                if first > best[1].0 {
                    best[1] = (first, cell);
                }
                if 0.5 * (first - last) > best[2].0 {
                    best[2] = (0.5 * (first - last), cell);
                }
            }
        }
        best.map(|(value, cell)| self.peak(value, cell, depth))
    }

    /// Summaries of all layers; false where it was stopped.
    fn layers(
        &mut self,
        regions: &[Vec<Place>],
        bears: &[(Option<f64>, Option<f64>)],
        summaries: &mut Vec<LayerSummary>,
    ) -> bool {
        let mut top = 0.0;
        for (region, (yields, strength)) in regions.iter().zip(bears) {
            let mut seen: Vec<(Place, Extremes)> = Vec::new();
            for place in region {
                if !self.compute(place) {
                    return false;
                }
                seen.push((*place, self.extremes(place.depth)));
            }
            for which in 0..3 {
                for _ in 0..REFINEMENTS {
                    let Some(place) = between(&values(&seen, which)) else {
                        break;
                    };
                    if !self.compute(&place) {
                        return false;
                    }
                    seen.push((place, self.extremes(place.depth)));
                    seen.sort_by(|a, b| a.0.depth.total_cmp(&b.0.depth));
                }
            }
            let peak = |which: usize| {
                let peaks = seen.iter().map(|(_, extremes)| extremes[which]);
                peaks.reduce(|a, b| if b.value > a.value { b } else { a })
            };
            let (Some(von_mises), Some(tension), Some(shear)) = (peak(0), peak(1), peak(2)) else {
                return false;
            };
            let layer = seen[0].0.layer;
            let thickness = self.body.layers().get(layer).map(crate::Layer::thickness);
            let bottom = thickness.map_or(f64::INFINITY, |h| top + h);
            let over = |limit: &Option<f64>, value: f64| {
                limit.filter(|_| value > 0.0).map(|limit| limit / value)
            };
            summaries.push(LayerSummary {
                layer,
                depths: [top, bottom],
                yield_margin: over(yields, von_mises.value),
                strength_margin: over(strength, tension.value),
                von_mises,
                tension,
                shear,
            });
            top = bottom;
        }
        true
    }

    /// Summaries of all interfaces; false where it was stopped.
    fn interfaces(&mut self, summaries: &mut Vec<InterfaceSummary>) -> bool {
        for (count, depth) in self.body.interfaces().into_iter().enumerate() {
            let Ok(above) = place(self.body, depth, Side::Above) else {
                return false;
            };
            if !self.compute(&above) {
                return false;
            }
            let mut best = [(f64::NEG_INFINITY, 0); 3];
            let mut keep = |which: usize, value: f64, cell: usize| {
                if value > best[which].0 {
                    best[which] = (value, cell);
                }
            };
            for cell in 0..self.fields[0].len() {
                let [_, _, zz, _, yz, xz] = self.tensor(cell);
                keep(0, zz, cell);
                keep(1, -zz, cell);
                keep(2, xz.hypot(yz), cell);
            }
            let [tension, compression, shear] =
                best.map(|(value, cell)| self.peak(value, cell, depth));
            let in_plane = [0, 1, 3].map(|k| self.fields[k].clone());
            let jump = match place(self.body, depth, Side::Below) {
                Ok(below) => {
                    if !self.compute(&below) {
                        return false;
                    }
                    let mut largest = (f64::NEG_INFINITY, 0);
                    let [above_xx, above_yy, above_xy] = &in_plane;
                    let above = above_xx.iter().zip(above_yy).zip(above_xy).enumerate();
                    for (cell, ((xx, yy), xy)) in above {
                        let [below_xx, below_yy, _, below_xy, ..] = self.tensor(cell);
                        let (xx, yy, xy) = (below_xx - xx, below_yy - yy, below_xy - xy);
                        let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
                        let value = mean.abs() + half.hypot(xy);
                        if value > largest.0 {
                            largest = (value, cell);
                        }
                    }
                    Some(self.peak(largest.0, largest.1, depth))
                }
                // Nothing is below a rigid base's surface.
                Err(_) => None,
            };
            summaries.push(InterfaceSummary {
                interface: count,
                depth,
                tension,
                compression: Peak {
                    value: -compression.value,
                    ..compression
                },
                shear,
                jump,
            });
        }
        true
    }
}
