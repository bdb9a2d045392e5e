//! The zone around a contact in which a constant stress acts: its density, its load and what the contact answers.
//!
//! ```text
//! ψ(t) = −2/π σ₀ √(c²−t²)      a < t < c
//! ```
//!
//! is the density of a uniform stress −σ₀ on r < c, without the part of the contact.

use std::f64::consts::PI;

use super::equation::basis::rule;
use super::equation::system::times;
use super::equation::waves::Waves;
use super::parts::Parts;

/// Nodes of the integral over a zone, beside eight for each thickness of the top layer in it.
const NODES: usize = 24;

/// Nodes of the integrals with a root of r² − t².
const ROOT_NODES: usize = 16;

/// A cohesive zone, and what the contact answers to it at approach 0.
#[derive(Debug, Clone)]
pub(super) struct Zone {
    inner: f64,
    pub(super) outer: f64,
    strength: f64,
    thickness: Option<f64>,
    /// φ of the contact, in its basis.
    pub(super) values: Vec<f64>,
    /// Transform of ψ and of this φ, at the waves.
    pub(super) hat: Vec<f64>,
    /// This φ at the edge.
    pub(super) edge: f64,
}

impl Zone {
    /// The zone from `inner` to `outer` without an answer.
    fn alone(inner: f64, outer: f64, strength: f64, thickness: Option<f64>) -> Self {
        Self {
            inner,
            outer,
            strength,
            thickness,
            values: Vec::new(),
            hat: Vec::new(),
            edge: 0.0,
        }
    }

    /// The zone around the contact of `parts`.
    pub(super) fn around(parts: &Parts, outer: f64, strength: f64) -> Self {
        let system = &parts.system;
        let mut zone = Self::alone(system.radius, outer, strength, parts.stack.thickness());
        let Some(level) = &system.level else {
            zone.values = vec![0.0; system.ones.len()];
            return zone;
        };
        let own = zone.transform(&level.waves);
        let right = system
            .couple(&times(&level.excess, &own))
            .iter()
            .map(|c| -c)
            .collect();
        zone.values = system.solve(right);
        zone.hat = system.transform(&zone.values);
        zone.hat
            .iter_mut()
            .zip(own)
            .for_each(|(sum, own)| *sum += own);
        zone.edge = -system.couple_edge(&times(&level.excess, &zone.hat));
        zone
    }

    /// √(c² − a²)
    fn reach(&self) -> f64 {
        ((self.outer - self.inner) * (self.outer + self.inner)).sqrt()
    }

    /// ψ at the inner edge.
    pub(super) fn density(&self) -> f64 {
        -2.0 / PI * self.strength * self.reach()
    }

    /// 2π ∫ ψ over the zone: its load.
    pub(super) fn load(&self) -> f64 {
        let angle = self.reach().atan2(self.inner);
        let area = self.outer * self.outer * angle - self.inner * self.reach();
        -2.0 * self.strength * area
    }

    /// ψ̂(α) at all waves; t = c cos η.
    pub(super) fn transform(&self, waves: &Waves) -> Vec<f64> {
        let thicknesses = self
            .thickness
            .map_or(0.0, |h| (self.outer - self.inner) / h);
        let count = NODES + (8.0 * thicknesses).ceil() as usize;
        let most = 0.5 * self.reach().atan2(self.inner);
        let mut sums = vec![0.0; waves.len()];
        let (mut cos, mut sin) = (sums.clone(), sums.clone());
        for (angle, w) in rule(count).nodes(most, most) {
            waves.circular(self.outer * angle.cos(), &mut cos, &mut sin);
            let weight = -2.0 / PI * self.strength * w * (self.outer * angle.sin()).powi(2);
            sums.iter_mut()
                .zip(&cos)
                .for_each(|(sum, cos)| *sum += weight * cos);
        }
        sums
    }

    /// ∫ ψ/√(r²−t²) over a < t < min(r, c). With m = min(r, c), t = m cos η and η = ε sinh x, where ε is the distance from the
    /// root's double zero.
    pub(super) fn abel(&self, r: f64) -> f64 {
        let (a, c) = (self.inner, self.outer);
        let factor = -2.0 / PI * self.strength;
        let m = r.min(c);
        let most = ((m - a) * (m + a)).max(0.0).sqrt().atan2(a);
        let near = ((c - r) * (c + r)).abs().sqrt();
        if near <= 1e-12 * c {
            return factor * (c - a);
        }
        let size = near / m;
        let integrand = |x: f64| {
            let eta = size * x.sinh();
            let sine = m * eta.sin();
            let value = match r < c {
                true => (near * near + sine * sine).sqrt(),
                false => sine * sine / (near * near + sine * sine).sqrt(),
            };
            value * size * x.cosh()
        };
        factor * rule(ROOT_NODES).over_panels(0.0, (most / size).asinh(), integrand)
    }

    /// Part of the pressure within the contact, r ≤ a, that is due to the zone; at its edge −σ₀.
    pub(super) fn inside(&self, r: f64, a: f64) -> f64 {
        let ratio = (self.outer - a) * (self.outer + a) / ((self.outer - r) * (self.outer + r));
        -2.0 / PI * self.strength * ratio.sqrt().min(1.0).asin()
    }

    /// Pressure beyond the contact.
    pub(super) fn outside(&self, r: f64) -> f64 {
        match r <= self.outer {
            true => -self.strength,
            false => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::Zone;
    use crate::indent::equation::waves::Waves;

    /// A zone from the axis on is a disc of uniform stress: its load, its transform J₁, its displacement at the edge, and the
    /// stress itself.
    #[test]
    fn a_disc_of_uniform_stress() {
        let (c, strength) = (0.7, 3.0);
        let zone = Zone::alone(0.0, c, strength, Some(1.0));
        assert!((zone.load() / (-PI * c * c * strength) - 1.0).abs() < 1e-14);
        assert!(
            (zone.inside(0.3, 0.0) / (-2.0 / PI * strength)
                - (c / (c * c - 0.09_f64).sqrt()).min(1.0).asin())
            .abs()
                < 1e-14
        );
        let waves = Waves::plan(1.0, 3.0, 1.0, |alpha| (-alpha).exp());
        for (alpha, found) in waves.alpha.iter().zip(zone.transform(&waves)) {
            let due = -strength * c * spec_math::cephes64::j1(alpha * c) / alpha;
            assert!((found - due).abs() < 1e-14, "{alpha}: {found} {due}");
        }
        // ∫ √(c²−t²)/√(r²−t²): elliptic integrals E at r < c; r E(c... ) is π/2 · c at r → 0.
        let near_axis = zone.abel(1e-6) / (-2.0 / PI * strength);
        assert!((near_axis / (FRAC_PI_2 * c) - 1.0).abs() < 1e-10);
        for r in [0.2, 0.6999999, 0.7000001, 2.0] {
            let fine = 4000;
            let m = f64::min(r, c);
            // The midpoint rule in t = m sin θ.
            let sum: f64 = (0..fine)
                .map(|k| {
                    let angle = FRAC_PI_2 * (f64::from(k) + 0.5) / f64::from(fine);
                    let t = m * angle.sin();
                    m * angle.cos() * ((c * c - t * t) / (r * r - t * t)).sqrt()
                })
                .sum();
            let due = -2.0 / PI * strength * sum * FRAC_PI_2 / f64::from(fine);
            assert!(
                (zone.abel(r) / due - 1.0).abs() < 1e-6,
                "{r}: {} {due}",
                zone.abel(r)
            );
        }
    }
}
