//! Depths at which a summary looks for the extremes of the stress.

use crate::compliance::response::interior::Place;
use crate::model::body::{HalfSpace, Substrate};

/// Depths below the top of a layer, in half-widths of the contact. Chosen by trial: dense where the
/// shear stress of a contact has its peak (0.48 below a sphere, 0.79 below a cylinder).
const DEPTHS: [f64; 13] = [
    0.02, 0.1, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 1.0, 1.3, 1.8, 2.5, 4.0,
];

/// Depths within a layer, in its thickness. Chosen by trial.
const FRACTIONS: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];

/// Depth, in a layer's thickness, below which its bottom face stands for the depths of [`DEPTHS`].
const BOTTOM: f64 = 0.999;

/// Distance, in a layer's thickness, below which two depths are one.
const NEAREST: f64 = 1e-6;

/// Places in each layer and in the substrate, from the surface down.
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
        depths.retain(|z| *z < BOTTOM * h);
        depths.extend([0.0, h]);
        depths.sort_by(f64::total_cmp);
        // Refinement divides by the distances between depths.
        depths.dedup_by(|next, before| *next - *before < NEAREST * h);
        let place = |z: &f64| at(count, top, *z, layer.material());
        regions.push(depths.iter().map(place).collect());
        top += h;
    }
    if let Substrate::Elastic(material) = body.substrate() {
        let depths = [0.0].into_iter().chain(DEPTHS.map(|d| d * half_width));
        let place = |z: f64| at(body.layers().len(), top, z, material);
        regions.push(depths.map(place).collect());
    }
    regions
}

/// Steps of less than this fraction of the distance to the next depth are not taken: the peak is at
/// the depth already evaluated, or the value falls off there as at a kink.
const SHORTEST_STEP: f64 = 1e-3;

/// The largest step, as a fraction of the distance to the next depth.
const LONGEST_STEP: f64 = 0.9;

/// Place of the vertex of the parabola through the largest value in `evaluated` and its two
/// neighbours. None where the largest value is the first or the last, or is that vertex already.
pub(super) fn refined_peak(evaluated: &[(Place, f64)]) -> Option<Place> {
    let value = |k: usize| evaluated[k].1;
    let best = (0..evaluated.len()).reduce(|a, b| if value(b) > value(a) { b } else { a })?;
    if best == 0 || best + 1 == evaluated.len() {
        return None;
    }
    let z = |k: usize| evaluated[k].0.below_top;
    let (a, b) = (z(best) - z(best - 1), z(best + 1) - z(best));
    let (left, right) = (
        (value(best) - value(best - 1)) / a,
        (value(best) - value(best + 1)) / b,
    );
    if left + right <= 0.0 {
        return None;
    }
    // The slope of the parabola at `best`, over its curvature.
    let slope = (left * b - right * a) / (a + b);
    let step = 0.5 * slope * (a + b) / (left + right);
    if step.abs() < SHORTEST_STEP * a.min(b) {
        return None;
    }
    let step = step.clamp(-LONGEST_STEP * a, LONGEST_STEP * b);
    let place = evaluated[best].0;
    Some(Place {
        below_top: place.below_top + step,
        depth: place.depth + step,
        ..place
    })
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
            let place = Place {
                layer: 0,
                below_top: z,
                depth: z,
                material,
            };
            (place, 3.0 - 2.0 * (z - 0.7) * (z - 0.7))
        };
        let mut evaluated = vec![at(0.0), at(0.5), at(1.1), at(2.0)];
        let vertex = refined_peak(&evaluated).map(|place| place.depth);
        assert!(
            vertex.is_some_and(|z| (z - 0.7).abs() < ROUNDING),
            "{vertex:?}"
        );
        evaluated.insert(2, at(0.7));
        assert_eq!(refined_peak(&evaluated), None);
        assert_eq!(refined_peak(&[at(0.7), at(1.0), at(2.0)]), None);
        Ok(())
    }
}
