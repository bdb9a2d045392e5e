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

use super::BodyPair;
use super::edge::SquaredPressure;
use crate::numerics::dense::Factors;
use crate::numerics::rounding;

/// Nodes of distance and of wavenumber per factor e, between which functions are linear.
const DISTANCES: f64 = 7.0;
const WAVES: f64 = 25.0;

/// Shortest and longest distances that matter, in cells: parts of the smallest piece, and several windows of a fit.
const SHORTEST: f64 = 1e-3;
const LONGEST: f64 = 300.0;

/// Passes of a fit whose distances from the edge are needed for the fit itself.
const PASSES: usize = 4;

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
    /// The law of a contact of the `pair` on cells of these sides.
    pub(super) fn new(pair: &BodyPair, sides: [f64; 2]) -> Self {
        let side = sides[0].min(sides[1]);
        let waves: Vec<f64> = grown(0.03 / LONGEST, 100.0 / SHORTEST, WAVES).collect();
        let response = |alpha: &f64| pair.response(alpha / side);
        let responses: Vec<f64> = waves.iter().map(response).collect();
        let shortest = responses[responses.len() - 1];
        let changes: Vec<f64> = responses.iter().map(|r| r / shortest - 1.0).collect();
        if !changes.iter().any(|m| m.abs() > UNCHANGED) {
            return Self::default();
        }
        let distances: Vec<f64> =
            std::iter::once(0.0).chain(grown(SHORTEST, LONGEST, DISTANCES)).collect();
        let kernel = SecondIntegral::new(&waves, &changes);
        let pressures = step_pressures(&distances, &kernel, 0.5 * PI * changes[0]);
        let at = |d: &f64| mean_of_steps(&distances, &pressures, *d) / pressures[0];
        let values = distances[1..].iter().map(at).collect();
        Self { sides: sides.map(|longer| longer / side), values }
    }

    /// Times that a fit is made, each with the distances from the edge of the one before: at the first they are not known.
    pub(super) fn passes(&self) -> usize {
        if self.values.is_empty() { 1 } else { PASSES }
    }

    /// The pressure at a point, from its square without Φ.
    pub(super) fn pressure(&self, squared: &SquaredPressure, at @ [u, v]: [f64; 2]) -> f64 {
        let value = squared.at(u, v);
        if value > 0.0 { value.sqrt() * self.factor(squared, at) } else { 0.0 }
    }

    /// Φ at a point.
    pub(super) fn factor(&self, squared: &SquaredPressure, at: [f64; 2]) -> f64 {
        if self.values.is_empty() { 1.0 } else { self.at(squared.distance(at, self.sides)) }
    }

    /// Φ at a distance from the edge, in shorter sides of a cell.
    fn at(&self, distance: f64) -> f64 {
        let Some(last) = self.values.len().checked_sub(1) else { return 1.0 };
        let place = (distance.max(SHORTEST) / SHORTEST).ln() * DISTANCES;
        let before = (place as usize).min(last);
        let after = (before + 1).min(last);
        let part = place - before as f64;
        self.values[before] + part.min(1.0) * (self.values[after] - self.values[before])
    }
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
            .map(|(alpha, m)| {
                let width = alpha[1] - alpha[0];
                [(m[1] - m[0]) / width, 0.5 * (alpha[0] + alpha[1]), 0.5 * width]
            })
            .collect();
        // By parts, with cos(bx) - cos(ax) as a product.
        let n = |x: f64| -> f64 {
            let of = |[slope, middle, half]: &[f64; 3]| slope * (middle * x).sin() * (half * x).sin();
            -2.0 * slopes.iter().map(of).sum::<f64>() / (x * x)
        };
        let first = 1e-2 * SHORTEST;
        let mut distances = vec![0.0];
        distances.extend(grown(first, 1.1 * LONGEST, 3.0 * DISTANCES));
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
    use crate::error::Result;
    use crate::model::body::{HalfSpace, Layer};
    use crate::model::material::Elastic;

    /// Far inside, the law is that of what is below the coat: √(E₂*/E₁*) times as large as at the edge. It gets there as the
    /// inverse of the distance, which is 300 thicknesses here.
    #[test]
    fn both_limits_are_those_of_one_material() -> Result<()> {
        let below = Elastic::new(1.0, 0.3)?;
        let bare = HalfSpace::from(below);
        assert_eq!(EdgeLaw::new(&BodyPair(vec![&bare]), [1.0; 2]), EdgeLaw::default());
        for modulus in [0.2, 0.5, 1.233, 2.0, 5.0] {
            let coat = Elastic::new(modulus, 0.25)?;
            let coated = HalfSpace::new(below, [Layer::new(coat, 1.0)?])?;
            let law = EdgeLaw::new(&BodyPair(vec![&coated]), [1.0; 2]);
            let limit = (below.plane_strain_modulus() / coat.plane_strain_modulus()).sqrt();
            println!("{modulus} {:?} {limit}", [0.0, 0.01, 0.1, 1.0, 10.0, 100.0, 300.0].map(|d| law.at(d)));
            assert!((law.at(0.0) - 1.0).abs() < 1e-3, "{modulus}: {}", law.at(0.0));
            assert!((law.at(300.0) / limit - 1.0).abs() < 5e-3, "{modulus}: {}", law.at(300.0));
        }
        Ok(())
    }
}
