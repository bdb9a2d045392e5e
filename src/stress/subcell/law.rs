//! The law by which pressure falls to a smooth edge on bodies whose response depends on the wavelength.
//!
//! Where two surfaces part smoothly, the pressure of bodies of one material is p = K √d (1 + c1 d + …) at the distance d
//! from the edge. On a coating K is another one at distances that are short compared with its thickness than at those that
//! are long. Near the edge the contact is a half-line, and the gap there opens smoothly, as if by waves far longer than all
//! distances that matter. With the response α û/p̂ = R(∞) (1 + m(α)) of the bodies together this gives
//!
//! ```text
//! p(d) = K √d (1 + c1 d + …) Φ(d)            Φ(d) = ∫₀¹ G(d (1 − u²)) du
//! G(d) + (1/π) ∫₀^∞ n(d − d') G(d') dd' = const       n(x) = ∫₀^∞ m(α) cos(αx) dα
//! ```
//!
//! G is the pressure written as a sum of flat-ended steps: each element G of the half-line carries 1/(2√(d − d')). One material
//! has Φ = 1. Φ depends on the bodies alone, neither on load, nor shape, nor cells: it is 1 at the edge here, and √(E₂*/E₁*)
//! far inside on a coat of modulus E₁* over E₂* (by Wiener and Hopf's method). Derived here.

use std::f64::consts::PI;

use ndarray::Array2;

use super::squared_pressure::SquaredPressure;
use crate::numerics::dense::Factors;
use crate::numerics::rounding;

/// Wavenumbers per factor e, between which the response is linear.
const WAVES: f64 = 25.0;

/// Distances from the edge, in cells, between which Φ is linear: so many from each power of 2 to the next.
const PER_OCTAVE: usize = 8;
const NODES: usize = 18 * PER_OCTAVE + 1;

/// Shortest and longest of these distances, powers of 2.
const SHORTEST: f64 = 1.0 / 1024.0;
const LONGEST: f64 = 256.0;

/// Most passes of a fit whose distances from the edge are needed for the fit itself. A coat of a third of the modulus, as thick as
/// a cell, takes ten.
const PASSES: usize = 24;

/// Change of the response below which Φ is 1.
const UNCHANGED: f64 = 1e-6;

/// Φ of two bodies, by the distance from the edge.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct EdgeLaw {
    /// Sides of a cell over the shorter one, in which distances are counted.
    sides: [f64; 2],
    /// Φ at distances of which each is a fixed factor longer than the last; none where it is 1.
    values: Vec<f64>,
}

impl Default for EdgeLaw {
    /// The law of one material, √d.
    fn default() -> Self {
        Self { sides: [1.0; 2], values: Vec::new() }
    }
}

impl EdgeLaw {
    /// The law of bodies of which `response` gives α û/p̂ at the wavenumber α, on cells of these sides.
    pub(super) fn new(response: impl Fn(f64) -> f64, sides: [f64; 2]) -> Self {
        let side = sides[0].min(sides[1]);
        let waves: Vec<f64> = grown(0.03 / LONGEST, 100.0 / SHORTEST, WAVES).collect();
        let responses: Vec<f64> = waves.iter().map(|alpha| response(alpha / side)).collect();
        let shortest = responses[responses.len() - 1];
        let changes: Vec<f64> = responses.iter().map(|r| r / shortest - 1.0).collect();
        if !changes.iter().any(|m| m.abs() > UNCHANGED) {
            return Self::default();
        }
        let distances: Vec<f64> = std::iter::once(0.0).chain((0..NODES).map(node)).collect();
        let kernel = SecondIntegral::new(&waves, &changes);
        let pressures = step_pressures(&distances, &kernel, 0.5 * PI * changes[0]);
        let at = |d: &f64| mean_of_steps(&distances, &pressures, *d) / pressures[0];
        let values = distances[1..].iter().map(at).collect();
        Self { sides: sides.map(|longer| longer / side), values }
    }

    /// Whether Φ is not 1 everywhere.
    pub(super) fn is_of_layers(&self) -> bool {
        !self.values.is_empty()
    }

    /// Times that a fit is made at most, each with the distances from the edge of the one before: at the first they are not known.
    pub(super) fn passes(&self) -> usize {
        if self.is_of_layers() { PASSES } else { 1 }
    }

    /// Change of ln Φ from an eighth of a cell to the cells of a fit.
    pub(super) fn change(&self) -> f64 {
        match self.is_of_layers() {
            true => (self.at(8.0) / self.at(0.125)).ln().abs(),
            false => 0.0,
        }
    }

    /// The pressure whose square is a polynomial times Φ².
    pub(super) fn profile<'a>(&'a self, squared: &'a SquaredPressure) -> EdgeProfile<'a> {
        let [slope, curvature] = squared.slope_at_edge(self.sides);
        EdgeProfile { law: self, squared, slope, curvature }
    }

    /// Φ at a distance from the edge, in shorter sides of a cell.
    fn at(&self, distance: f64) -> f64 {
        let distance = distance.clamp(node(0), node(NODES - 1));
        let before = number_of(distance).min(NODES - 2);
        let [from, to] = [node(before), node(before + 1)];
        let part = (distance - from) / (to - from);
        self.values[before] + part * (self.values[before + 1] - self.values[before])
    }
}

/// The pressure near an edge.
#[derive(Debug)]
pub(super) struct EdgeProfile<'a> {
    law: &'a EdgeLaw,
    /// p² without Φ.
    pub(super) squared: &'a SquaredPressure,
    /// Slope of that at the edge, per shorter side of a cell, and its change per side.
    slope: f64,
    curvature: f64,
}

impl EdgeProfile<'_> {
    /// The pressure at a point.
    pub(super) fn at(&self, [u, v]: [f64; 2]) -> f64 {
        self.root(self.squared.at(u, v))
    }

    /// The pressure where its square without Φ has this value; 0 beyond the edge.
    pub(super) fn root(&self, value: f64) -> f64 {
        if value > 0.0 { value.sqrt() * self.factor(value) } else { 0.0 }
    }

    /// Φ at a point.
    pub(super) fn factor_at(&self, [u, v]: [f64; 2]) -> f64 {
        self.factor(self.squared.at(u, v).max(0.0))
    }

    /// Φ where p² without it has this value.
    fn factor(&self, value: f64) -> f64 {
        if self.law.values.is_empty() {
            return 1.0;
        }
        let end = (self.slope * self.slope + 2.0 * self.curvature * value).max(0.0).sqrt();
        self.law.at(2.0 * value / (self.slope + end))
    }
}

/// Digits of the binary form of a distance behind those that tell its node: exponent and leading digits.
const DIGITS: u32 = f64::MANTISSA_DIGITS - 1 - PER_OCTAVE.ilog2();

/// Distance of a node.
fn node(number: usize) -> f64 {
    f64::from_bits(((SHORTEST.to_bits() >> DIGITS) + number as u64) << DIGITS)
}

/// Number of the last node that is not beyond a distance, which is not below the first.
fn number_of(distance: f64) -> usize {
    ((distance.to_bits() >> DIGITS) - (SHORTEST.to_bits() >> DIGITS)) as usize
}

/// Values from the first to the last, so many per factor e.
fn grown(first: f64, last: f64, per_factor: f64) -> impl Iterator<Item = f64> {
    let count = rounding::ceil((last / first).ln() * per_factor) as u32;
    (0..=count).map(move |k| first * (f64::from(k) / per_factor).exp())
}

/// The second integral of n from 0, which is even, and its slope, at distances.
struct SecondIntegral {
    distances: Vec<f64>,
    /// n, its integral, and the integral of that.
    values: Vec<[f64; 3]>,
}

impl SecondIntegral {
    /// Of changes m of the response at `waves`: m is linear between them, constant below and 0 above.
    fn new(waves: &[f64], changes: &[f64]) -> Self {
        let panels = waves.windows(2).zip(changes.windows(2));
        let slopes: Vec<[f64; 3]> = panels
            .filter(|(_, m)| (m[1] - m[0]).abs() > UNCHANGED * UNCHANGED)
            .map(|(alpha, m)| {
                let width = alpha[1] - alpha[0];
                [(m[1] - m[0]) / width, 0.5 * (alpha[0] + alpha[1]), 0.5 * width]
            })
            .collect();
        // By parts, with cos(bx) - cos(ax) as a product.
        let n = |x: f64| -> f64 {
            let of =
                |[slope, middle, half]: &[f64; 3]| slope * (middle * x).sin() * (half * x).sin();
            -2.0 * slopes.iter().map(of).sum::<f64>() / (x * x)
        };
        let first = 0.1 * SHORTEST;
        let mut distances = vec![0.0];
        distances.extend(grown(first, 1.1 * LONGEST, 0.6 * WAVES));
        let mut values: Vec<[f64; 3]> = vec![[n(first), 0.0, 0.0]];
        for k in 1..distances.len() {
            let (step, [before, once, twice]) = (distances[k] - distances[k - 1], values[k - 1]);
            let here = n(distances[k]);
            let rise = step * (2.0 * before + here) / 6.0;
            values.push([here, once + 0.5 * step * (before + here), twice + step * (once + rise)]);
        }
        Self { distances, values }
    }

    /// The integral and the second integral from 0 to `x` ≥ 0.
    fn at(&self, x: f64) -> [f64; 2] {
        let last = self.distances.len() - 1;
        let k = self.distances.partition_point(|d| *d <= x).clamp(1, last) - 1;
        let (by, [n, once, twice]) = (x - self.distances[k], self.values[k]);
        let slope = (self.values[k + 1][0] - n) / (self.distances[k + 1] - self.distances[k]);
        let rise = by * (n + by * slope / 3.0);
        [once + by * (n + 0.5 * by * slope), twice + by * (once + 0.5 * rise)]
    }
}

/// G at the `distances`, between which it is linear, and beyond which it does not change; `whole` is the integral of n.
fn step_pressures(distances: &[f64], kernel: &SecondIntegral, whole: f64) -> Vec<f64> {
    let count = distances.len();
    let mut matrix = Array2::<f64>::eye(count);
    for (i, at) in distances.iter().enumerate() {
        // By parts twice: the slopes of G between nodes times the rise of the second integral.
        let twice: Vec<f64> = distances.iter().map(|d| kernel.at((at - d).abs())[1]).collect();
        let slope = |k: usize| (twice[k + 1] - twice[k]) / (distances[k + 1] - distances[k]);
        for k in 0..count {
            let before = if k > 0 { slope(k - 1) } else { -kernel.at(*at)[0] };
            let after = if k + 1 < count { slope(k) } else { whole };
            matrix[[i, k]] += (after - before) / PI;
        }
    }
    let ones = Array2::ones((count, 1));
    Factors::new(matrix).solve(ones).into_iter().collect()
}

/// ∫₀¹ G(d (1 − u²)) du of a G that is linear between the distances.
fn mean_of_steps(distances: &[f64], pressures: &[f64], d: f64) -> f64 {
    let mut sum = 0.0;
    for (ends, values) in distances.windows(2).zip(pressures.windows(2)) {
        if ends[0] >= d {
            break;
        }
        let slope = (values[1] - values[0]) / (ends[1] - ends[0]);
        let from = (1.0 - ends[0] / d).sqrt();
        let to = (1.0 - ends[1].min(d) / d).sqrt();
        let value = |u: f64| u * (values[0] + slope * (d - ends[0] - d * u * u / 3.0));
        sum += value(from) - value(to);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compliance::response::Response;
    use crate::error::Result;
    use crate::model::body::{HalfSpace, Layer};
    use crate::model::material::Elastic;

    /// Far inside, the law is that of what is below the coat: √(E₂*/E₁*) times as large as at the edge. It gets there as the
    /// inverse of the distance, which is 2560 thicknesses here; at the edge, nodes are 1/100 of one apart.
    #[test]
    fn both_limits_are_those_of_one_material() -> Result<()> {
        let below = Elastic::new(1.0, 0.3)?;
        let bare = HalfSpace::from(below);
        assert_eq!(EdgeLaw::new(|alpha| bare.normal(alpha), [1.0; 2]), EdgeLaw::default());
        for modulus in [0.2, 0.5, 1.233, 2.0, 5.0] {
            let coat = Elastic::new(modulus, 0.25)?;
            let coated = HalfSpace::new(below, [Layer::new(coat, 0.1)?])?;
            let law = EdgeLaw::new(|alpha| coated.normal(alpha), [1.0; 2]);
            let limit = (below.plane_strain_modulus() / coat.plane_strain_modulus()).sqrt();
            assert!((law.at(0.0) - 1.0).abs() < 5e-3, "{modulus}: {}", law.at(0.0));
            assert!((law.at(LONGEST) / limit - 1.0).abs() < 2e-3, "{modulus}: {}", law.at(LONGEST));
        }
        Ok(())
    }
}
