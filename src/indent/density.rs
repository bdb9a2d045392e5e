//! Pressure and displacement that belong to a density φ on the contact.

use std::f64::consts::PI;

use spec_math::cephes64::{j0, j1};

use super::equation::basis::{Break, Panel};
use super::equation::system::Parts;
use super::equation::waves::Waves;
use super::tip::{FEW_KINKS, TipParameter};
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
            let mut found = [self.known[0] - self.known[1] * value, -self.known[1] * slope];
            if let Some(rates) = &rates {
                found[0] -= parts.f() * rates[k][0];
                found[1] -= parts.f() * rates[k][1];
            }
            if let Some(waves) = waves {
                let layers = oscillating(waves, &self.g, *t, [&mut cos, &mut sin]);
                found[0] += layers[0];
                found[1] += layers[1];
            }
            found
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
    pub(super) fn edge_slope(&self) -> f64 {
        let parts = self.parts;
        let a = parts.system.radius;
        let [_, slope, _] = parts.tip.transform(a);
        let mut found = -self.known[1] * slope;
        if let Some(rate) = self.rate {
            found -= parts.f() * parts.tip.rate(rate, &[a])[0][1];
        }
        if let Some(level) = &parts.system.level {
            let waves = self.g.iter().zip(&level.waves.alpha);
            let terms = waves.zip(&parts.system.edge[1]);
            found += 2.0 / PI * terms.map(|((g, alpha), sin)| g * alpha * sin).sum::<f64>();
        }
        found
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
        let places: Vec<f64> = match is_axis {
            true => angles,
            false => angles.iter().map(|angle| r * angle.cosh()).collect(),
        };
        let slopes = slopes(&places);
        let terms = slopes.iter().zip(&weights).zip(&places);
        let sum: f64 = terms
            .map(|((slope, w), t)| match is_axis {
                true => w * slope / t,
                false => w * slope,
            })
            .sum();
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
