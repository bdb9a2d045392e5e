//! The zone around a contact in which a constant stress acts: its density, its load and what the contact answers.
//!
//! ```text
//! ψ(t) = −2/π σ₀ √(c²−t²)      a < t < c
//! ```
//!
//! is the density of a uniform stress −σ₀ on r < c, without the part of the contact.

use std::f64::consts::{FRAC_PI_2, PI};

use spec_math::cephes64::{j0, j1};

use super::equation::system::{Parts, add, times};
use super::equation::waves::Waves;
use crate::numerics::quadrature::Rule;

/// Nodes of the integral over a panel of a zone, beside half of the phase of the shortest wave over it.
const NODES: usize = 24;

/// Phase of the shortest wave over a panel of a zone.
const PHASE: f64 = 300.0;

/// Nodes of the integrals with a root of r² − t².
const ROOT_NODES: usize = 16;

/// Change of a zone: that of its stress, relative to it, and that of its outer radius \[m\].
pub(super) type Rate = [f64; 2];

/// Rate of a zone that grows from nothing: the zone itself.
const WHOLE: Rate = [1.0, 0.0];

/// A cohesive zone, and what the contact answers to it at approach 0.
#[derive(Debug, Clone)]
pub(super) struct Zone {
    pub(super) inner: f64,
    pub(super) outer: f64,
    strength: f64,
    pub(super) answer: Answer,
}

/// What a contact answers to the density around it.
#[derive(Debug, Clone, Default)]
pub(super) struct Answer {
    /// φ of the contact, in its basis.
    pub(super) values: Vec<f64>,
    /// Transform of this φ and of what it answers, at the waves.
    pub(super) hat: Vec<f64>,
    /// This φ at the edge.
    pub(super) edge: f64,
}

impl Answer {
    /// Adds `factor` times `more`, but for its edge.
    pub(super) fn add(&mut self, factor: f64, more: &Self) {
        add(&mut self.values, factor, &more.values);
        add(&mut self.hat, factor, &more.hat);
    }
}

impl Zone {
    /// The zone from `inner` to `outer` without an answer.
    fn alone(inner: f64, outer: f64, strength: f64) -> Self {
        Self { inner, outer, strength, answer: Answer::default() }
    }

    /// The zone around the contact of `parts`.
    pub(super) fn around(parts: &Parts, outer: f64, strength: f64) -> Self {
        let mut zone = Self::alone(parts.system.radius, outer, strength);
        zone.answer = zone.answer(parts, WHOLE);
        zone
    }

    /// What the contact answers to a change of the zone.
    pub(super) fn answer(&self, parts: &Parts, rate: Rate) -> Answer {
        let system = &parts.system;
        let Some(level) = &system.level else {
            return Answer { values: vec![0.0; system.ones.len()], ..Answer::default() };
        };
        let own = self.transform_rate(rate, &level.waves);
        let right = system.couple(&times(&level.excess, &own));
        let values = system.solve(right.iter().map(|c| -c).collect());
        let mut hat = system.transform(&values);
        add(&mut hat, 1.0, &own);
        let edge = -system.couple_edge(&times(&level.excess, &hat));
        Answer { values, hat, edge }
    }

    /// σ₀
    pub(super) fn strength(&self) -> f64 {
        self.strength
    }

    /// √(c² − a²)
    fn reach(&self) -> f64 {
        ((self.outer - self.inner) * (self.outer + self.inner)).sqrt()
    }

    /// ψ at the inner edge.
    pub(super) fn density(&self) -> f64 {
        self.density_rate(WHOLE)
    }

    /// Change of ψ at the inner edge.
    pub(super) fn density_rate(&self, [stress, outer]: Rate) -> f64 {
        let reach = self.reach();
        -2.0 / PI * self.strength * (stress * reach + outer * self.outer / reach)
    }

    /// ψ' at the inner edge.
    pub(super) fn slope(&self) -> f64 {
        2.0 / PI * self.strength * self.inner / self.reach()
    }

    /// 2π ∫ ψ over the zone: its load.
    pub(super) fn load(&self) -> f64 {
        self.load_rate(WHOLE)
    }

    /// Change of its load.
    pub(super) fn load_rate(&self, [stress, outer]: Rate) -> f64 {
        let angle = self.reach().atan2(self.inner);
        let area = self.outer * self.outer * angle - self.inner * self.reach();
        -2.0 * self.strength * (stress * area + outer * 2.0 * self.outer * angle)
    }

    /// ψ̂(α) at all waves.
    pub(super) fn transform(&self, waves: &Waves) -> Vec<f64> {
        self.transform_rate(WHOLE, waves)
    }

    /// Change of ψ̂(α) at all waves; t = c cos η. Over a wide zone it is that of the whole disc, of π/2 c σ₀ J₁(αc)/α, without that
    /// of the contact, over which there are fewer oscillations.
    pub(super) fn transform_rate(&self, rate: Rate, waves: &Waves) -> Vec<f64> {
        let [stress, outer] = rate;
        let angle = self.reach().atan2(self.inner);
        if self.inner > 0.5 * self.outer {
            return self.transform_over(rate, waves, [0.0, angle]);
        }
        let within = self.transform_over(rate, waves, [angle, FRAC_PI_2]);
        let c = self.outer;
        let disc = |alpha: &f64| {
            // d/dc of c J₁(αc)/α is c J₀(αc).
            -self.strength * c * (stress * j1(alpha * c) / alpha + outer * j0(alpha * c))
        };
        let pairs = waves.alpha.iter().zip(within);
        pairs.map(|(alpha, within)| disc(alpha) - within).collect()
    }

    /// Its part over the angles η from `low` to `high`.
    fn transform_over(
        &self,
        [stress, outer]: Rate,
        waves: &Waves,
        [low, high]: [f64; 2],
    ) -> Vec<f64> {
        let shortest = waves.alpha.iter().fold(0.0_f64, |most, alpha| most.max(*alpha));
        let phase = shortest * self.outer * (low.cos() - high.cos());
        let panels = (phase / PHASE).ceil().max(1.0);
        // The phase is up to twice as dense as on average.
        let count = NODES + (0.5 * phase * (2.0 / panels).min(1.0)).ceil() as usize;
        let half = 0.5 * (high - low) / panels;
        let mut sums = vec![0.0; waves.len()];
        let (mut cos, mut sin) = (sums.clone(), sums.clone());
        for panel in 0..panels as usize {
            let middle = low + (2 * panel + 1) as f64 * half;
            for (angle, w) in Rule::kept(count).nodes(middle, half) {
                waves.circular(self.outer * angle.cos(), &mut cos, &mut sin);
                let rate = stress * (self.outer * angle.sin()).powi(2) + outer * self.outer;
                let weight = -2.0 / PI * self.strength * w * rate;
                add(&mut sums, weight, &cos);
            }
        }
        sums
    }

    /// ∫ ψ/√(r²−t²) over a < t < min(r, c).
    pub(super) fn abel(&self, r: f64) -> f64 {
        self.abel_rate(WHOLE, r)
    }

    /// Change of ∫ ψ/√(r²−t²) over a < t < min(r, c). With m = min(r, c), t = m cos η and η = ε sinh x, where ε is the distance
    /// from the root's double zero. At r = c that with the outer radius has no limit: it is −∞.
    pub(super) fn abel_rate(&self, [stress, outer]: Rate, r: f64) -> f64 {
        let (a, c) = (self.inner, self.outer);
        let factor = -2.0 / PI * self.strength;
        let m = r.min(c);
        let most = ((m - a) * (m + a)).max(0.0).sqrt().atan2(a);
        let near = ((c - r) * (c + r)).abs().sqrt();
        if near <= 1e-12 * c {
            return match outer.abs() > 0.0 {
                true => -outer.signum() * f64::INFINITY,
                false => stress * factor * (c - a),
            };
        }
        let size = near / m;
        let integrand = |x: f64| {
            let eta = size * x.sinh();
            let sine = m * eta.sin();
            let larger = (near * near + sine * sine).sqrt();
            let value = match r < c {
                true => larger,
                false => sine * sine / larger,
            };
            (stress * value + outer * c / larger) * size * x.cosh()
        };
        factor * Rule::kept(ROOT_NODES).over_panels(0.0, (most / size).asinh(), integrand)
    }

    /// Part of the pressure within the contact, r ≤ a, that is due to the zone; at its edge −σ₀.
    pub(super) fn inside(&self, r: f64) -> f64 {
        self.inside_rate(WHOLE, r)
    }

    /// Change of −∫ ψ'/√(t²−r²) over the zone at r ≤ a.
    pub(super) fn inside_rate(&self, [stress, outer]: Rate, r: f64) -> f64 {
        let (a, c) = (self.inner, self.outer);
        let rest = (c - r) * (c + r);
        let angle = (self.reach() / rest.sqrt()).min(1.0).asin();
        let wider = c * ((a - r) * (a + r)).max(0.0).sqrt() / (rest * self.reach());
        -2.0 / PI * self.strength * (stress * angle + outer * wider)
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
        let zone = Zone::alone(0.0, c, strength);
        assert!((zone.load() / (-PI * c * c * strength) - 1.0).abs() < 1e-14);
        assert!(
            (zone.inside(0.3) / (-2.0 / PI * strength)
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
            assert!((zone.abel(r) / due - 1.0).abs() < 1e-6, "{r}: {} {due}", zone.abel(r));
        }
    }
}
