//! Pressure and displacement that belong to a density φ on the contact.

use std::f64::consts::{FRAC_PI_2, PI};

use spec_math::cephes64::{j0, j1};

use crate::indent::equation::basis::{Break, Panel, Waves};
use crate::indent::equation::{Parts, add, times};
use crate::indent::tip::{FEW_KINKS, TipParameter};
use crate::numerics::quadrature::Rule;

/// Nodes of the integrals of the pressure, beside four for each thickness of the top layer in the radius.
const PRESSURE: usize = 48;

/// Nodes of the integrals of the displacement, which have no root.
const SURFACE: usize = 24;

/// φ(t) = c₀ − c₁ F(t) − f ∂F/∂θ(t) − 2/π Σ g cos αt on the contact.
#[derive(Debug)]
pub(super) struct Density<'a> {
    pub(super) parts: &'a Parts,
    /// c₀ and c₁.
    pub(super) known: [f64; 2],
    /// θ, for derivatives with respect to a number of the tip.
    pub(super) rate: Option<TipParameter>,
    /// Weights times M p̂ and what else oscillates.
    pub(super) g: Vec<f64>,
    /// φ at the edge.
    pub(super) edge: f64,
}

impl Density<'_> {
    /// φ(t) and φ'(t) at each of `places`.
    pub(super) fn at(&self, places: &[f64]) -> Vec<[f64; 2]> {
        let parts = self.parts;
        let waves = parts.system.level.as_ref().map(|level| &level.waves);
        let rates = self.rate.map(|rate| parts.tip.rate(rate, places));
        let count = self.g.len();
        let (mut cos, mut sin) = (vec![0.0; count], vec![0.0; count]);
        let value = |(k, t): (usize, &f64)| {
            let [value, slope, _] = parts.tip.transform(*t);
            let mut density = [self.known[0] - self.known[1] * value, -self.known[1] * slope];
            if let Some(rates) = &rates {
                density[0] -= parts.f() * rates[k][0];
                density[1] -= parts.f() * rates[k][1];
            }
            if let Some(waves) = waves {
                let layers = oscillating(waves, &self.g, *t, [&mut cos, &mut sin]);
                density[0] += layers[0];
                density[1] += layers[1];
            }
            density
        };
        places.iter().enumerate().map(value).collect()
    }

    /// Displacement over lim α û/p̂ at r ≥ a, where the waves resolve J₀(αr).
    pub(super) fn displaced(&self, r: f64) -> f64 {
        let level = self.parts.system.level.as_ref();
        let layers = level.map_or(0.0, |level| bessel_sum(&self.g, &level.waves.alpha, r));
        self.abel(r) + layers
    }

    /// Derivative of [`Density::displaced`] with respect to r > a.
    pub(super) fn displaced_slope(&self, r: f64) -> f64 {
        let level = self.parts.system.level.as_ref();
        let layers = level.map_or(0.0, |level| bessel_slopes(&self.g, &level.waves.alpha, r));
        self.abel_slope(r) + layers
    }

    /// Derivative of [`Density::abel`] with respect to r > a.
    fn abel_slope(&self, r: f64) -> f64 {
        let a = self.parts.system.radius;
        let inside = self.in_angles(r, |[_, slope], angle| slope * angle.sin());
        inside - self.edge * a / (r * ((r - a) * (r + a)).sqrt())
    }

    /// φ'(a) at the edge.
    pub(super) fn slope_at_edge(&self) -> f64 {
        let parts = self.parts;
        let a = parts.system.radius;
        let [_, slope, _] = parts.tip.transform(a);
        let mut edge_slope = -self.known[1] * slope;
        if let Some(rate) = self.rate {
            edge_slope -= parts.f() * parts.tip.rate(rate, &[a])[0][1];
        }
        if let Some(level) = &parts.system.level {
            let waves = self.g.iter().zip(&level.waves.alpha);
            let terms = waves.zip(&parts.system.edge[1]);
            edge_slope += 2.0 / PI * terms.map(|((g, alpha), sin)| g * alpha * sin).sum::<f64>();
        }
        edge_slope
    }

    /// Pressure \[Pa\] at the distance r < a from the axis:
    ///
    /// ```text
    /// p(r) = φ(a)/√(a²−r²) − ∫_r^a φ'(t)/√(t²−r²) dt      p(0) = φ(a)/a − ∫₀^a φ'(t)/t dt
    /// ```
    pub(super) fn pressure(&self, r: f64) -> f64 {
        let slopes = |places: &[f64]| self.at(places).iter().map(|[_, slope]| *slope).collect();
        self.pressure_of(r, slopes)
    }

    /// [`Density::pressure`] of the slopes φ' that a function gives at places.
    pub(super) fn pressure_of(&self, r: f64, slopes: impl Fn(&[f64]) -> Vec<f64>) -> f64 {
        let parts = self.parts;
        let a = parts.system.radius;
        // Nearer to the axis a/r is beyond the machine.
        let r = if r > 0.0 { r.max(1e-200 * a) } else { r };
        let singular = self.edge / ((a - r) * (a + r)).sqrt();
        let ratio = parts.stack.thickness().map_or(0.0, |h| a / h);
        let rule =
            Rule::kept((parts.stack.finer() * (PRESSURE as f64 + 4.0 * ratio)).ceil() as usize);
        let breaks = self.breaks();
        // t = r cosh θ takes the root away.
        let (panels, is_axis) = match r > 0.0 {
            true => {
                let angle = |t: f64| (t / r).max(1.0).acosh();
                (Panel::between(0.0, &mapped(&breaks, angle), angle(a)), false)
            }
            false => (Panel::between(0.0, &breaks, a), true),
        };
        let nodes = panels.into_iter().flat_map(|panel| panel.nodes(rule));
        let (angles, weights): (Vec<f64>, Vec<f64>) = nodes.unzip();
        let places: Vec<f64> =
            if is_axis { angles } else { angles.iter().map(|angle| r * angle.cosh()).collect() };
        let slopes = slopes(&places);
        let terms = slopes.iter().zip(&weights).zip(&places);
        let sum: f64 =
            terms.map(|((slope, w), t)| if is_axis { w * slope / t } else { w * slope }).sum();
        singular - sum
    }

    fn breaks(&self) -> Vec<Break> {
        let parts = self.parts;
        let breaks = parts.tip.breaks(parts.system.radius, FEW_KINKS);
        breaks.unwrap_or_default()
    }

    /// ∫₀^a φ(t)/√(r²−t²) dt at r ≥ a; t = r sin θ takes the root away.
    pub(super) fn abel(&self, r: f64) -> f64 {
        self.in_angles(r, |[value, _], _| value)
    }

    /// ∫ f dθ of a function of φ and φ' at t = r sin θ, and of θ, over the contact; r ≥ a.
    fn in_angles(&self, r: f64, f: impl Fn([f64; 2], f64) -> f64) -> f64 {
        let parts = self.parts;
        let a = parts.system.radius;
        let ratio = parts.stack.thickness().map_or(0.0, |h| a / h);
        let rule =
            Rule::kept((parts.stack.finer() * (SURFACE as f64 + 4.0 * ratio)).ceil() as usize);
        let angle = |t: f64| (t / r).min(1.0).asin();
        let breaks = mapped(&self.breaks(), angle);
        let panels = Panel::between(0.0, &breaks, angle(a)).into_iter();
        let (angles, weights): (Vec<f64>, Vec<f64>) =
            panels.flat_map(|panel| panel.nodes(rule)).unzip();
        let places: Vec<f64> = angles.iter().map(|angle| r * angle.sin()).collect();
        let values = self.at(&places);
        let terms = values.iter().zip(angles.iter().zip(&weights));
        terms.map(|(value, (angle, w))| w * f(*value, *angle)).sum()
    }
}

/// Breaks at the places that `place` makes of theirs.
fn mapped(breaks: &[Break], place: impl Fn(f64) -> f64) -> Vec<Break> {
    let moved = |b: &Break| Break { at: place(b.at), ..*b };
    breaks.iter().map(moved).collect()
}

/// −2/π Σ g cos αt and its slope at a place `t`; the last argument is memory for the waves.
pub(super) fn oscillating(
    waves: &Waves,
    g: &[f64],
    t: f64,
    [cos, sin]: [&mut [f64]; 2],
) -> [f64; 2] {
    waves.circular(t, cos, sin);
    let terms = g.iter().zip(&waves.alpha).zip(cos.iter().zip(sin.iter()));
    let (mut even, mut odd) = (0.0, 0.0);
    for ((g, alpha), (cos, sin)) in terms {
        even += g * cos;
        odd += g * alpha * sin;
    }
    [-2.0 / PI * even, 2.0 / PI * odd]
}

/// ∫ g J₀(αr) over waves.
pub(super) fn bessel_sum(g: &[f64], alpha: &[f64], r: f64) -> f64 {
    g.iter().zip(alpha).map(|(g, alpha)| g * j0(alpha * r)).sum()
}

/// Derivative of ∫ g J₀(αr) with respect to r.
fn bessel_slopes(g: &[f64], alpha: &[f64], r: f64) -> f64 {
    let terms = g.iter().zip(alpha);
    terms.map(|(g, alpha)| -g * alpha * j1(alpha * r)).sum()
}

/// Nodes of the integral over a panel of a zone, beside half of the phase of the shortest wave over it.
const NODES: usize = 24;

/// Phase of the shortest wave over a panel of a zone.
const PHASE: f64 = 300.0;

/// Nodes of the integrals with a root of r² − t².
const ROOT_NODES: usize = 16;

/// Change of a zone: that of its stress, relative to it, and that of its outer radius \[m\].
pub(super) type Rate = [f64; 2];

/// Rate of a zone that grows from nothing: the zone itself.
pub(super) const WHOLE: Rate = [1.0, 0.0];

/// A cohesive zone, in which a constant stress acts, and what the contact answers to it at approach 0.
///
/// ```text
/// ψ(t) = −2/π σ₀ √(c²−t²)      a < t < c
/// ```
///
/// is the density of a uniform stress −σ₀ on r < c, without the part of the contact. What is asked of a [`Rate`] is that of
/// [`WHOLE`] itself, or its change.
#[derive(Debug, Clone)]
pub(super) struct Zone {
    pub(super) inner: f64,
    pub(super) outer: f64,
    /// σ₀
    pub(super) strength: f64,
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
        let own = self.transform(rate, &level.waves);
        let right = system.couple(&times(&level.excess, &own));
        let values = system.solve(right.iter().map(|c| -c).collect());
        let mut hat = system.transform(&values);
        add(&mut hat, 1.0, &own);
        let edge = -system.couple_edge(&times(&level.excess, &hat));
        Answer { values, hat, edge }
    }

    /// √(c² − a²)
    fn reach(&self) -> f64 {
        ((self.outer - self.inner) * (self.outer + self.inner)).sqrt()
    }

    /// ψ at the inner edge.
    pub(super) fn density(&self, [stress, outer]: Rate) -> f64 {
        let reach = self.reach();
        -2.0 / PI * self.strength * (stress * reach + outer * self.outer / reach)
    }

    /// ψ' at the inner edge.
    pub(super) fn slope(&self) -> f64 {
        2.0 / PI * self.strength * self.inner / self.reach()
    }

    /// 2π ∫ ψ over the zone: its load.
    pub(super) fn load(&self, [stress, outer]: Rate) -> f64 {
        let angle = self.reach().atan2(self.inner);
        let area = self.outer * self.outer * angle - self.inner * self.reach();
        -2.0 * self.strength * (stress * area + outer * 2.0 * self.outer * angle)
    }

    /// ψ̂(α) at all waves; t = c cos η. Over a wide zone it is that of the whole disc, of π/2 c σ₀ J₁(αc)/α, without that
    /// of the contact, over which there are fewer oscillations.
    pub(super) fn transform(&self, rate: Rate, waves: &Waves) -> Vec<f64> {
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

    /// ∫ ψ/√(r²−t²) over a < t < min(r, c). With m = min(r, c), t = m cos η and η = ε sinh x, where ε is the distance
    /// from the root's double zero. At r = c that with the outer radius has no limit: it is −∞.
    pub(super) fn abel(&self, [stress, outer]: Rate, r: f64) -> f64 {
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
            let value = if r < c { larger } else { sine * sine / larger };
            (stress * value + outer * c / larger) * size * x.cosh()
        };
        factor * Rule::kept(ROOT_NODES).over_panels(0.0, (most / size).asinh(), integrand)
    }

    /// Part −∫ ψ'/√(t²−r²) of the pressure within the contact, r ≤ a; at its edge −σ₀.
    pub(super) fn inside(&self, [stress, outer]: Rate, r: f64) -> f64 {
        let (a, c) = (self.inner, self.outer);
        let rest = (c - r) * (c + r);
        let angle = (self.reach() / rest.sqrt()).min(1.0).asin();
        let wider = c * ((a - r) * (a + r)).max(0.0).sqrt() / (rest * self.reach());
        -2.0 / PI * self.strength * (stress * angle + outer * wider)
    }

    /// Pressure beyond the contact.
    pub(super) fn outside(&self, r: f64) -> f64 {
        if r <= self.outer { -self.strength } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::{WHOLE, Zone};
    use crate::indent::equation::basis::Waves;

    /// A zone from the axis on is a disc of uniform stress: its load, its transform J₁, its displacement at the edge, and the
    /// stress itself.
    #[test]
    fn a_disc_of_uniform_stress() {
        let (c, strength) = (0.7, 3.0);
        let zone = Zone::alone(0.0, c, strength);
        assert!((zone.load(WHOLE) / (-PI * c * c * strength) - 1.0).abs() < 1e-14);
        assert!(
            (zone.inside(WHOLE, 0.3) / (-2.0 / PI * strength)
                - (c / (c * c - 0.09_f64).sqrt()).min(1.0).asin())
            .abs()
                < 1e-14
        );
        let waves = Waves::plan(1.0, 3.0, 1.0, |alpha| (-alpha).exp());
        for (alpha, value) in waves.alpha.iter().zip(zone.transform(WHOLE, &waves)) {
            let due = -strength * c * spec_math::cephes64::j1(alpha * c) / alpha;
            assert!((value - due).abs() < 1e-14, "{alpha}: {value} {due}");
        }
        // ∫ √(c²−t²)/√(r²−t²): elliptic integrals E at r < c; r E(c... ) is π/2 · c at r → 0.
        let near_axis = zone.abel(WHOLE, 1e-6) / (-2.0 / PI * strength);
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
                (zone.abel(WHOLE, r) / due - 1.0).abs() < 1e-6,
                "{r}: {} {due}",
                zone.abel(WHOLE, r)
            );
        }
    }
}
