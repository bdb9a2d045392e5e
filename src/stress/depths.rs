//! At which depths a summary looks for the extremes of the stress.

use ndarray::ArrayRef2;

use crate::body::{HalfSpace, Substrate};
use crate::grid::Grid;
use crate::response::interior::Place;

/// Depths below the top of a layer, in half-widths of the contact.
const DEPTHS: [f64; 13] = [
    0.02, 0.1, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 1.0, 1.3, 1.8, 2.5, 4.0,
];

/// Depths within a layer, in thicknesses.
const FRACTIONS: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];

/// Half the width of what is loaded, along its shorter side; of the grid, where nothing is.
pub(super) fn half_width(grid: &Grid, pressure: &ArrayRef2<f64>) -> f64 {
    let mut ends = [[usize::MAX, 0]; 2];
    for ((i, j), p) in pressure.indexed_iter() {
        if *p != 0.0 {
            for (end, at) in ends.iter_mut().zip([i, j]) {
                *end = [end[0].min(at), end[1].max(at)];
            }
        }
    }
    let width = |axis: usize| {
        let [first, last] = ends[axis];
        let cells = if first > last {
            grid.shape()[axis]
        } else {
            last - first + 1
        };
        0.5 * cells as f64 * grid.spacing()[axis]
    };
    if grid.is_line() {
        width(1)
    } else {
        width(0).min(width(1))
    }
}

/// Places in each layer and in the substrate, from above.
pub(super) fn regions(body: &HalfSpace, half_width: f64) -> Vec<Vec<Place>> {
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
        let mut depths: Vec<f64> = DEPTHS.iter().map(|d| d * half_width).collect();
        depths.extend(FRACTIONS.map(|f| f * h));
        depths.retain(|z| *z < 0.999 * h);
        depths.extend([0.0, h]);
        depths.sort_by(f64::total_cmp);
        let place = |z: &f64| at(count, top, *z, layer.material());
        regions.push(depths.iter().map(place).collect());
        top += h;
    }
    if let Substrate::Elastic(material) = body.substrate() {
        let depths = [0.0].into_iter().chain(DEPTHS.map(|d| d * half_width));
        regions.push(
            depths
                .map(|z| at(body.layers().len(), top, z, material))
                .collect(),
        );
    }
    regions
}

/// Where the parabola through the largest value of those that were seen and its neighbours has its
/// top, if it is inside and not yet known.
pub(super) fn between(seen: &[(Place, f64)]) -> Option<Place> {
    let value = |k: usize| seen[k].1;
    let best = (0..seen.len()).reduce(|a, b| if value(b) > value(a) { b } else { a })?;
    if best == 0 || best + 1 == seen.len() {
        return None;
    }
    let z = |k: usize| seen[k].0.below_top;
    let (a, b) = (z(best) - z(best - 1), z(best + 1) - z(best));
    let (left, right) = (
        (value(best) - value(best - 1)) / a,
        (value(best) - value(best + 1)) / b,
    );
    if left + right <= 0.0 {
        return None;
    }
    // The slope of the parabola at `best`, and its curvature.
    let slope = (left * b - right * a) / (a + b);
    let step = 0.5 * slope * (a + b) / (left + right);
    // Where a value falls off at once there is nothing more to find.
    let step = if step.abs() < 1e-3 * a.min(b) {
        return None;
    } else {
        step.clamp(-0.9 * a, 0.9 * b)
    };
    let place = seen[best].0;
    Some(Place {
        below_top: place.below_top + step,
        depth: place.depth + step,
        ..place
    })
}
