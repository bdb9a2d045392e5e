//! Stresses below the surface of an indentation.

use spec_math::cephes64::{j0, j1};

use crate::compliance::response::interior::{Column, Place};
use crate::error::{Error, Result, require};
use crate::indent::equation::add;
use crate::indent::equation::basis::{Panel, Waves};
use crate::indent::point::{Point, check_distances};
use crate::indent::pressure::WHOLE;
use crate::indent::tip::FEW_KINKS;
use crate::numerics::quadrature::Rule;

/// Depth, in contact radii, above which the waves that matter are too many.
const SHALLOWEST: f64 = 1e-2;

/// Depth, in contact radii, below which all stresses are those of a force at a point.
const DEEPEST: f64 = 1e6;

/// Distance from the axis, in depths and contact radii, beyond which the waves that matter are too many.
const FARTHEST: f64 = 1e4;

/// Nodes of a panel of the contact.
const FINE: usize = 32;

/// Phase over a panel that its nodes resolve: half of it and twelve is at most their number.
const PHASE: f64 = 40.0;

/// Stresses at one place below the surface \[Pa\], tension positive, in the frame of the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct InteriorStress {
    /// σ_rr.
    pub rr: f64,
    /// σ_θθ.
    pub tt: f64,
    /// σ_zz.
    pub zz: f64,
    /// σ_rz.
    pub rz: f64,
}

impl InteriorStress {
    /// Equivalent stress of von Mises \[Pa\].
    pub fn von_mises(&self) -> f64 {
        let squares =
            (self.rr - self.tt).powi(2) + (self.tt - self.zz).powi(2) + (self.zz - self.rr).powi(2);
        (0.5 * squares + 3.0 * self.rz * self.rz).sqrt()
    }
}

impl Point {
    /// Stresses in the body of this number at the depth `z` \[m\], at each distance r from the axis \[m\]. On an interface they are those of
    /// the layer below it.
    ///
    /// With P, τ and (σ_LL ± σ_TT)/2 = S, D of the response under a unit pressure, and H_ν f = ∫ p̂ f J_ν(αr) α dα,
    ///
    /// ```text
    /// σ_zz = −H₀ P      σ_rz = H₁ τ      σ_rr, σ_θθ = H₀ S ∓ H₂ D
    /// ```
    ///
    /// # Errors
    /// A distance that is negative or not finite, a depth below 1e-2 of the contact radius or above 1e6 of it, a distance above
    /// 1e4 of both, and no such half-space.
    pub fn stress(&self, body: usize, z: f64, r: &[f64]) -> Result<Vec<InteriorStress>> {
        check_distances(r)?;
        let holds = (SHALLOWEST..=DEEPEST).contains(&(z / self.radius));
        let requirement = "at least 1e-2 of the contact radius and at most 1e6 of it; at the surface, see the pressure";
        require("z", z, holds, requirement)?;
        let far = r.iter().fold(0.0_f64, |most, r| most.max(*r));
        let is_near = far <= FARTHEST * z.max(self.radius);
        require("r", far, is_near, "at most 1e4 of the depth or of the contact radius")?;
        let bodies = self.parts.stack.bodies();
        let body = bodies.get(body).and_then(|body| body.half_space());
        let body = body
            .ok_or(Error::Inconsistent("body must be one of the half-spaces that are indented"))?;
        let mut place = Place::surface(body);
        let mut top = 0.0;
        for (number, depth) in body.interfaces().iter().enumerate() {
            if z >= *depth {
                top = *depth;
                place.layer = number + 1;
            }
        }
        place.depth = z;
        place.below_top = z - top;
        place.material = body.material(place.layer).ok_or(Error::Parameter {
            name: "z",
            requirement: "above the rigid base",
            value: z,
        })?;
        // All decays with e^{−αz}: TAIL/thickness = 48/z ends at e^{−48}; J_ν and p̂ oscillate over r and the outer radius.
        let layers = body.interfaces().into_iter().reduce(f64::min);
        let thinnest = layers.map_or(z / 3.0, |h| h.min(z / 3.0));
        let waves = Waves::plan(
            z / 3.0,
            (self.outer_radius.unwrap_or(self.radius) + far).max(z / 3.0),
            (z / 3.0 / thinnest).max(1.0),
            |_| 0.0,
        );
        let hat = self.fine_transform(&waves);
        let mut sums = vec![[0.0; 4]; r.len()];
        for (q, (alpha, weight)) in waves.alpha.iter().zip(&waves.weight).enumerate() {
            let fields = Column::new(body, *alpha).at(body, &place).pressure;
            let (along, across) = fields.lateral_stress(place.material);
            let (mean, difference) = (0.5 * (along + across), 0.5 * (along - across));
            let load = weight * hat[q] * alpha;
            for (sum, r) in sums.iter_mut().zip(r) {
                let x = alpha * r;
                let (zeroth, first) = (j0(x), j1(x));
                let second = if x > 1e-4 { 2.0 * first / x - zeroth } else { x * x / 8.0 };
                sum[0] += load * (mean * zeroth - difference * second);
                sum[1] += load * (mean * zeroth + difference * second);
                sum[2] -= load * fields.p * zeroth;
                sum[3] += load * fields.tau * first;
            }
        }
        let stress = |[rr, tt, zz, rz]: [f64; 4]| InteriorStress { rr, tt, zz, rz };
        Ok(sums.into_iter().map(stress).collect())
    }

    /// p̂ at waves that are shorter than the nodes of the contact resolve: of φ at panels of at most `PHASE` radians.
    fn fine_transform(&self, waves: &Waves) -> Vec<f64> {
        let (a, tip) = (self.radius, &self.parts.tip);
        let shortest = waves.alpha.iter().fold(0.0_f64, |most, alpha| most.max(*alpha));
        let (mut places, mut weights) = (Vec::new(), Vec::new());
        let breaks = tip.breaks(a, FEW_KINKS).unwrap_or_default();
        for panel in Panel::between(0.0, &breaks, a) {
            let count = (shortest * (panel.high - panel.low) / PHASE).ceil().max(1.0);
            let length = (panel.high - panel.low) / count;
            for k in 0..count as usize {
                let low = panel.low + k as f64 * length;
                let part = Panel { low, high: low + length, has_root: panel.has_root && k == 0 };
                for (place, weight) in part.nodes(Rule::kept(FINE)) {
                    places.push(place);
                    weights.push(weight);
                }
            }
        }
        let density = self.density().at(&places);
        let mut hat = vec![0.0; waves.alpha.len()];
        let (mut cos, mut sin) = (hat.clone(), hat.clone());
        for (place, (weight, [value, _])) in places.iter().zip(weights.iter().zip(density)) {
            waves.circular(*place, &mut cos, &mut sin);
            let weight = weight * value;
            add(&mut hat, weight, &cos);
        }
        if let Some(zone) = &self.zone {
            add(&mut hat, 1.0, &zone.transform(WHOLE, waves));
        }
        hat
    }
}
