//! Whether a contact is a disc: pressure within it, gap outside of it.
//!
//! With Φ(t) = f [δ − F(t)] − 2/π ∫ M p̂ cos αt dα at every t, which is φ within the contact, and the density ψ of a cohesive zone,
//!
//! ```text
//! p(r) = φ(a)/√(a²−r²) − ∫_r^a Φ'(t)/√(t²−r²) dt      r < a
//! gap(r) = −A1 ∫_a^r [Φ(t) − ψ(t)]/√(r²−t²) dt        r > a
//! ```
//!
//! Where Φ falls within the contact, and is below 0 outside of it, all is well, and no integral is needed. The second formula
//! follows from that of the displacement with J₀(αr) = 2/π ∫₀^r cos αt/√(r²−t²) dt; both tests were derived here.

use std::f64::consts::PI;

use super::Point;
use crate::error::{Error, Result};
use crate::indent::adhesion::Adhesion;
use crate::indent::equation::basis::Waves;
use crate::indent::pressure::{Density, WHOLE, oscillating};
use crate::numerics::special::chebyshev_nodes;

/// Nodes of a panel. What oscillates is analytic up to two thicknesses from the real axis, so that eight nodes on a panel of one
/// thickness leave (4 + √17)⁻⁸ = 5e-8 of it.
const NODES: usize = 8;

/// Pressure below 0 that counts as rounding, of the mean one; it lies above what the panels leave.
const TENSION: f64 = 1e-6;

/// Overlap that counts as rounding, of the sizes of approach, opening and F at the edge.
const OVERLAP: f64 = 1e-9;

/// Steps of the search for a minimum between three places: each leaves 0.62 of the interval.
const GOLDEN: usize = 14;

/// Knots of a sampled tip at most at which the surfaces are looked at.
const MOST_KNOTS: usize = 64;

/// What oscillates in Φ, interpolated on panels.
struct Layers {
    ends: Vec<f64>,
    /// Value and slope at Chebyshev's points of each panel.
    rows: Vec<[[f64; 2]; NODES]>,
}

/// Chebyshev's points on each of the panels between `ends`.
fn nodes(ends: &[f64]) -> impl Iterator<Item = f64> {
    let on = |pair: &[f64]| {
        let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
        chebyshev_nodes::<NODES>().map(|[x, _]| middle + half * x)
    };
    ends.windows(2).flat_map(on)
}

impl Layers {
    fn new(ends: Vec<f64>, waves: Option<(&[f64], &Waves)>) -> Self {
        let mut all = vec![[0.0; 2]; NODES * (ends.len() - 1)];
        if let Some((g, waves)) = waves {
            let (mut cos, mut sin) = (vec![0.0; g.len()], vec![0.0; g.len()]);
            for (value, t) in all.iter_mut().zip(nodes(&ends)) {
                *value = oscillating(waves, g, t, [&mut cos, &mut sin]);
            }
        }
        let rows = all.as_chunks().0.to_vec();
        Self { ends, rows }
    }

    /// The slope at `t`: the polynomial through the values at the nodes of its panel, by the barycentric formula
    /// (Berrut and Trefethen 2004, eq. 4.2, doi:10.1137/S0036144502417715). `points` are the nodes in −1 to 1 with their
    /// barycentric weights. Beyond the first and the last panel these continue.
    fn slope(&self, t: f64, points: &[[f64; 2]; NODES]) -> f64 {
        let after = self.ends.partition_point(|end| *end <= t);
        let panel = after.clamp(1, self.rows.len()) - 1;
        let [low, high] = [self.ends[panel], self.ends[panel + 1]];
        let x = (2.0 * t - low - high) / (high - low);
        let (mut weighted_slopes, mut weights) = (0.0, 0.0);
        for ([place, weight], [_, slope]) in points.iter().zip(&self.rows[panel]) {
            let distance = x - place;
            if distance.abs() < 1e-14 {
                return *slope;
            }
            weighted_slopes += weight / distance * slope;
            weights += weight / distance;
        }
        weighted_slopes / weights
    }
}

/// The least of `f` over `places`, which ascend, and between them.
fn least(places: &[f64], mut f: impl FnMut(f64) -> Result<f64>) -> Result<f64> {
    let values: Vec<f64> = places.iter().map(|r| f(*r)).collect::<Result<_>>()?;
    let low = values.iter().fold(f64::INFINITY, |low, v| low.min(*v));
    let high = values.iter().fold(low, |high, v| high.max(v.min(1e300)));
    let mut least = low;
    for k in 1..values.len().saturating_sub(1) {
        // A minimum that is far above the others is none that matters.
        if values[k] > values[k - 1]
            || values[k] > values[k + 1]
            || values[k] > low + 0.1 * (high - low)
        {
            continue;
        }
        let (mut a, mut b) = (places[k - 1], places[k + 1]);
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let [mut x, mut y] = [b - golden * (b - a), a + golden * (b - a)];
        let (mut at_x, mut at_y) = (f(x)?, f(y)?);
        for _ in 0..GOLDEN {
            least = least.min(at_x).min(at_y);
            if at_x < at_y {
                (b, y, at_y) = (y, x, at_x);
                x = b - golden * (b - a);
                at_x = f(x)?;
            } else {
                (a, x, at_x) = (x, y, at_y);
                y = a + golden * (b - a);
                at_y = f(y)?;
            }
        }
    }
    Ok(least)
}

impl Point {
    /// An error where the contact is no disc: a pressure below 0, of a cohesive zone below −σ₀, within a contact that
    /// carries no more, or surfaces that overlap outside, of which those beyond a zone are apart by more than w/σ₀, and
    /// those in it by less.
    pub(in crate::indent) fn check_disc(&self) -> Result<()> {
        let tip = &self.parts.tip;
        // The pressure of a bare body below a convex tip falls outwards.
        if self.parts.system.level.is_none() && tip.is_convex() && self.zone.is_none() {
            return Ok(());
        }
        let far = self.farthest();
        let wider = self.wider(far);
        let waves = wider.as_ref().map(|(g, level)| (&g[..], &level.waves));
        let a = self.radius;
        match self.is_pressed(&Layers::new(self.panels([0.0, a]), waves))?
            && (far <= a || self.is_apart(&Layers::new(self.panels([a, far]), waves))?)
        {
            true => Ok(()),
            false => Err(Error::Ring),
        }
    }

    /// Distance from the axis beyond which the gap grows: there f(F − δ), and with it the gap that follows from it, exceeds what
    /// oscillates, which fades away from the edge.
    fn farthest(&self) -> f64 {
        let (tip, a) = (&self.parts.tip, self.radius);
        let edge = tip.transform(a)[0];
        let layers = self.edge() / self.parts.f() - (self.approach - edge);
        let more = (0.5 * self.approach.abs()).max(0.5 * edge).max(2.0 * layers);
        let due = self.approach + more + 2.0 * self.opening();
        let resolved = self.parts.stack.longest() - a;
        let most = (tip.range()[1] * (1.0 - 1e-9)).min(resolved);
        let mut far = 1.1 * self.outer_radius.map_or(a, |c| 2.0 * c);
        while far < most && tip.transform(far)[0] < due {
            far *= 1.2;
        }
        far.min(most).max(a)
    }

    /// Gap w/σ₀ at the end of a cohesive zone, 0 without one.
    fn opening(&self) -> f64 {
        match self.adhesion {
            Adhesion::Maugis { work, strength } => work / strength,
            _ => 0.0,
        }
    }

    /// Ends of panels, at most one thickness long within the contact and half of the distance from it more outside, that do not pass
    /// a kink of the tip.
    fn panels(&self, [low, high]: [f64; 2]) -> Vec<f64> {
        let kinks = self.parts.tip.kinks.iter().copied();
        let mut ends = vec![low];
        let mut start = low;
        for end in kinks.filter(|b| *b > low && *b < high).chain([high]) {
            while start < end {
                let length = self.parts.stack.thickness().unwrap_or(f64::INFINITY)
                    + 0.5 * (start - self.radius).max(0.0);
                start = if end - start < 1.5 * length { end } else { start + length };
                ends.push(start);
            }
        }
        ends
    }

    /// Places of the tip's knots, where they are many, between two distances.
    fn knots(&self, [low, high]: [f64; 2]) -> Vec<f64> {
        let knots = self.parts.tip.knots();
        let inside: Vec<f64> = knots.filter(|b| *b > low && *b < high).collect();
        let step = inside.len().div_ceil(MOST_KNOTS).max(1);
        inside.into_iter().step_by(step).collect()
    }

    /// Whether the pressure is nowhere below what the surfaces carry.
    fn is_pressed(&self, layers: &Layers) -> Result<bool> {
        if matches!(self.adhesion, Adhesion::Jkr { .. }) {
            return Ok(true);
        }
        let (parts, a) = (&*self.parts, self.radius);
        let (tip, f) = (&parts.tip, parts.f());
        let [stiffness, profile] = parts.loads;
        let mean = (stiffness * self.approach - profile).abs() / (PI * a * a);
        let density = Density { edge: self.step(), ..self.density() };
        if density.edge < -TENSION * mean * a {
            return Ok(false);
        }
        let falls = nodes(&layers.ends)
            .zip(layers.rows.as_flattened())
            .all(|(t, [_, slope])| slope - f * tip.transform(t)[1] <= 1e-10 * mean);
        if falls && tip.is_convex() {
            return Ok(true);
        }
        let points = chebyshev_nodes();
        let slopes = |places: &[f64]| -> Vec<f64> {
            let at = |t: &f64| layers.slope(*t, &points) - f * tip.transform(*t)[1];
            places.iter().map(at).collect()
        };
        let mut places = self.knots([0.0, a]);
        places.extend(nodes(&layers.ends));
        places.extend([0.99, 0.999, 0.9999].map(|fraction| fraction * a));
        if !tip.is_sharp() {
            places.push(0.0);
        }
        places.sort_by(f64::total_cmp);
        // Where it ends at the edge, the pressure does so as a root.
        let ends = density.edge.abs() <= 0.0 && self.zone.is_none();
        let most = least(&places, |r| {
            let zone = self.zone.as_ref().map_or(0.0, |zone| zone.inside(WHOLE, r) + zone.strength);
            let pressure = density.pressure_of(r, slopes) + zone;
            Ok(if ends { pressure / (1.0 - (r / a).powi(2)).sqrt() } else { pressure })
        })?;
        let strength = self.zone.as_ref().map_or(0.0, |zone| zone.strength);
        Ok(most >= -TENSION * mean.max(strength))
    }

    /// Whether the surfaces nowhere overlap outside, and attract each other where they are near enough.
    fn is_apart(&self, layers: &Layers) -> Result<bool> {
        let (parts, a) = (&*self.parts, self.radius);
        let (tip, f) = (&parts.tip, parts.f());
        let [low, high] = [a, layers.ends[layers.ends.len() - 1]];
        let mut places = self.knots([low, high]);
        let size = self.approach.abs() + tip.transform(a)[0] + self.opening();
        let Some(zone) = &self.zone else {
            let is_below = |value: f64, t: f64| {
                value + f * (self.approach - tip.transform(t)[0]) <= 1e-10 * f * size
            };
            let below = nodes(&layers.ends)
                .zip(layers.rows.as_flattened())
                .all(|(t, [value, _])| is_below(*value, t));
            if below && places.is_empty() {
                return Ok(true);
            }
            places.extend(nodes(&layers.ends));
            places.sort_by(f64::total_cmp);
            let gap = least(&places, |r| Ok(self.gap(&[r])?[0]))?;
            return Ok(gap >= -OVERLAP * size);
        };
        // Above 0 and below w/σ₀ in the zone, above w/σ₀ beyond it.
        let (c, opening) = (zone.outer, self.opening());
        let inner: Vec<f64> = nodes(&[a, c]).collect();
        places.extend(nodes(&layers.ends));
        places.retain(|r| *r > c * (1.0 + 1e-9));
        places.sort_by(f64::total_cmp);
        let apart = |r: f64| Ok(self.gap(&[r])?[0]);
        let tolerance = OVERLAP * size;
        Ok(least(&inner, apart)? >= -tolerance
            && least(&inner, |r| Ok(opening - apart(r)?))? >= -tolerance
            && least(&places, |r| Ok(apart(r)? - opening))? >= -tolerance)
    }
}
