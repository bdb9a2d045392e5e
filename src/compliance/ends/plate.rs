//! Two free ends of one body: what a plate adds to two quarter spaces.
//!
//! A body 0 ≤ x ≤ L, z ≥ 0 with both faces free is displaced as two quarter spaces and, for each wavenumber k
//! along y, by
//!
//! ```text
//! (1−ν)/πG ∫ D(x,x′) p(x′) dx′        D(x,x′) = Σ_ab φ_a(x) D_ab φ_b(x′)        φ_a = √(2a+1) P_a(2x/L − 1)
//! ```
//!
//! D_ab depends on kL and ν. It is tabulated for a, b ≤ 7, which leaves 5e-5 of the displacement; above kL = 15,
//! it is less than 1e-6. It follows from one equation as that of the quarter space: a half-space under a pressure
//! that is even and periodic, and a plate under tractions on its faces (`tests/data/make/plate.py`). The method was
//! derived here.
//!
//! Below kL = 0.1, D_00 and D_11 grow as 1/k: long waves stretch and bend a plate of plane stress. The rest is a
//! logarithm, that of the quarter spaces, and what continues from the table.
//!
//! A plate that is infinitely deep yields without limit to a load that is uniform along y. Its shift and its tilt are
//! therefore counted from those at a depth of about its length, or the width of the grid if that is more: from D_00
//! and D_11 for waves k < 1/depth, the difference from their value at k = 1/depth is taken away where the load is. Under a
//! given load and moment this changes no pressure.

use std::f64::consts::PI;
use std::sync::LazyLock;

use ndarray::Array2;

use super::waves::Along;
use super::{layers_factor, quarter_space};
use crate::compliance::convolution::{RowWeights, pair};
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;
use crate::model::material::Elastic;
use crate::numerics::quadrature::Rule;
use crate::numerics::special::{EULER_GAMMA, chebyshev, legendre};

/// Number of polynomials φ.
const POLYNOMIALS: usize = 8;

/// Chebyshev polynomials of the table, of ν and of ln kL.
const ORDERS: [usize; 2] = [6, 20];

/// kL between which the table holds.
const RANGE: [f64; 2] = [0.1, 15.0];

/// kL that stands for a load that is uniform along y where the grid repeats.
const UNIFORM: f64 = 1e-6;

/// Coefficients of one D_ab.
#[derive(Debug)]
struct Entry {
    pair: [usize; 2],
    coefficients: Vec<f64>,
}

static TABLE: LazyLock<Vec<Entry>> = LazyLock::new(|| {
    let text = include_str!("plate.txt");
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(' ').filter_map(|word| word.parse().ok()).collect()).collect();
    (rows.chunks_exact(1 + ORDERS[0]))
        .map(|block| Entry {
            pair: [block[0][0] as usize, block[0][1] as usize],
            coefficients: block[1..].concat(),
        })
        .collect()
});

impl Entry {
    /// Whether D_ab moves the surface as a whole, by a shift or a tilt.
    fn is_rigid(&self) -> bool {
        self.pair == [0, 0] || self.pair == [1, 1]
    }

    /// D_ab
    fn at(&self, kl: f64, poisson: f64) -> f64 {
        match kl {
            short if short > RANGE[1] => 0.0,
            long if long < RANGE[0] => self.below(long, poisson),
            _ => self.tabulated(kl, poisson),
        }
    }

    /// What grows without limit in D_ab as k → 0: shift and tilt of the edge of a plate in plane stress, and of the
    /// half-space and two quarter spaces.
    fn growing(&self, kl: f64, poisson: f64) -> f64 {
        match self.pair {
            [0, 0] => {
                PI / ((1.0 - poisson * poisson) * kl)
                    + (3.0 + 2.0 * quarter_space::logarithm()) * kl.ln()
            }
            [1, 1] => PI / ((1.0 - poisson) * (3.0 + poisson) * kl),
            _ => 0.0,
        }
    }

    /// D_ab below the table. The rest is linear in k; where nothing grows, it has terms of k² and k³.
    fn below(&self, kl: f64, poisson: f64) -> f64 {
        let rest = |part: f64| {
            let at = part * RANGE[0];
            self.tabulated(at, poisson) - self.growing(at, poisson)
        };
        let (ratio, first) = (kl / RANGE[0], rest(1.0));
        let second = rest(2.0) - first;
        let change = if self.is_rigid() {
            second * (ratio - 1.0)
        } else {
            let third = rest(3.0) - first;
            let square = (26.0 * second - 7.0 * third) / 22.0;
            let cube = (3.0 * third - 8.0 * second) / 22.0;
            square * (ratio.powi(2) - 1.0) + cube * (ratio.powi(3) - 1.0)
        };
        self.growing(kl, poisson) + first + change
    }

    /// D_ab in the range of the table.
    fn tabulated(&self, kl: f64, poisson: f64) -> f64 {
        let of_poisson = chebyshev::<{ ORDERS[0] }>(4.0 * poisson - 1.0);
        let place = (kl / RANGE[0]).ln() / (RANGE[1] / RANGE[0]).ln();
        let of_length = chebyshev::<{ ORDERS[1] }>(2.0 * place - 1.0);
        let rows = self.coefficients.chunks_exact(ORDERS[1]).zip(of_poisson);
        let sum: f64 = rows
            .map(|(row, p)| p * row.iter().zip(of_length).map(|(c, q)| c * q).sum::<f64>())
            .sum();
        sum * (-0.5 * kl).exp() / kl
    }
}

/// Means of all φ over cells of length `dx` around the places `x`, from the body's start, for a body of this
/// `length`.
pub(super) fn rows(x: impl Iterator<Item = f64>, dx: f64, length: f64) -> Vec<RowWeights> {
    let rule = Rule::gauss_legendre(POLYNOMIALS / 2);
    let means = |x: f64| {
        if !(0.0..=length).contains(&x) {
            return RowWeights::default();
        }
        let mut weights = vec![0.0; POLYNOMIALS];
        for (at, w) in rule.nodes(x / length, 0.5 * dx / length) {
            let t = 2.0 * at - 1.0;
            for ((n, weight), p) in weights.iter_mut().enumerate().zip(legendre(t)) {
                *weight += w * length / dx * (2.0 * n as f64 + 1.0).sqrt() * p;
            }
        }
        RowWeights { first: 0, weights }
    };
    x.map(means).collect()
}

/// Coefficients \[m/Pa\] for a `body` of this `length` on a substrate of `material` on cells of a `grid`: pairs of
/// polynomials, distances along y. `size` is that of the finest grid of a contact.
pub(super) fn coefficients(
    (body, material): (&HalfSpace, Elastic),
    length: f64,
    grid: &Grid,
    size: [f64; 2],
) -> Array2<f64> {
    let ([dx, dy], along) = (grid.spacing(), Along::of(grid));
    let depth = length.max(size[1]);
    let uniform = UNIFORM / length;
    let waves = along.waves(depth, RANGE[1] / length, &[(uniform, 1.0)]);
    // Waves whose shift and tilt are bounded, and the wave whose they have: where the grid repeats, that of the datum.
    let (long, bound) = if along.repeats {
        (2.0 * uniform, 2.0 * (-EULER_GAMMA).exp() / size[0])
    } else {
        (1.0 / depth, 1.0 / depth)
    };
    let last = POLYNOMIALS - 1;
    let mut coefficients = Array2::zeros((pair(last, last) + 1, along.distances.len()));
    let short = 2.0 / material.plane_strain_modulus();
    let factor = short * dx * dy / PI.powi(2);
    for entry in TABLE.iter() {
        let [a, b] = entry.pair;
        let amplitude =
            |k: f64| factor * layers_factor(body, k) * entry.at(k * length, material.poisson());
        let mut row = coefficients.row_mut(pair(a, b));
        for (&k, weights) in waves.wavenumbers.iter().zip(&waves.weights) {
            let here = amplitude(k);
            let taken = match entry.is_rigid() && k < long {
                true => (here - amplitude(bound)) * weights[0],
                false => 0.0,
            };
            row.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += here * weight - taken);
        }
    }
    coefficients
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use ndarray::Array1;
    use spec_math::cephes64::k0;

    use super::{POLYNOMIALS, TABLE, rows};
    use crate::compliance::ends::reduction::Reduction;
    use crate::numerics::quadrature::Rule;

    /// Error of a coefficient, relative to the displacement under unit pressure.
    const OF_TABLE: f64 = 2e-5;

    fn coefficient(pair: [usize; 2], kl: f64, poisson: f64) -> f64 {
        let entry = TABLE.iter().find(|entry| entry.pair == pair);
        entry.map_or(f64::NAN, |entry| entry.at(kl, poisson))
    }

    /// The table agrees with D_ab on a finer mesh (step 0.25, from 1e-9 on) at places that are no nodes:
    /// `tests/data/make/plate.py check`.
    #[test]
    fn table_holds_between_its_nodes() {
        let pairs = [[0, 0], [1, 1], [0, 2], [1, 3], [2, 2], [1, 7]];
        // kL, ν, then D_ab.
        let expected = [
            [0.15, 0.3, 11.44901, 8.100226, -0.049933, 0.024256, -0.015702, -0.000214],
            [0.6, 0.05, 0.903354, 0.923696, -0.036493, 0.017935, -0.014487, -0.00017],
            [1.7, 0.28, -0.055871, 0.169065, -0.021895, 0.010039, -0.010279, -0.000097],
            [3.3, 0.45, -0.038968, 0.044702, -0.014127, 0.005195, -0.00642, -0.000041],
            [6.0, 0.3, -0.00063, 0.000955, -0.00049, 0.000281, -0.000404, -0.000004],
            [11.0, 0.5, -0.000007, 0.000013, -0.000008, 0.000007, -0.000009, 0.0],
        ];
        for [kl, poisson, values @ ..] in expected {
            let displacement = PI / kl * (1.0 + 0.6 * poisson);
            for (pair, value) in pairs.into_iter().zip(values) {
                let coefficient = coefficient(pair, kl, poisson);
                assert!(
                    (coefficient - value).abs() < OF_TABLE * displacement,
                    "{pair:?} kL {kl} ν {poisson}: {coefficient} {value}"
                );
            }
        }
    }

    /// Points and weights on 0 < x′ < 1, on intervals that halve towards 0, x and 1.
    fn sources(x: f64) -> Vec<(f64, f64)> {
        const HALVINGS: i32 = 30;
        let rule = Rule::gauss_legendre(10);
        let mut points = Vec::new();
        for [start, end] in [[0.0, x], [x, 1.0]].into_iter().filter(|[a, b]| b > a) {
            for halving in 1..=HALVINGS {
                let outer = (end - start) * f64::from(-halving).exp2();
                let inner = if halving == HALVINGS { 0.0 } else { 0.5 * outer };
                let (middle, half) = (0.5 * (outer + inner), 0.5 * (outer - inner));
                points.extend(rule.nodes(start + middle, half));
                points.extend(rule.nodes(end - middle, half));
            }
        }
        points
    }

    /// uGk/(1−ν) at x under the pressure 1, or 2x − 1, for L = 1: 1 on a half-space under 1 everywhere.
    fn displacement(k: f64, poisson: f64, x: f64, linear: bool) -> f64 {
        let reduction = Reduction::of(poisson);
        let modes = &reduction.displacement;
        let ends = [x, 1.0 - x].map(|distance| modes.at(k * distance));
        let mut loads = [0, 1].map(|_| Array1::<f64>::zeros(modes.count()));
        let mut sum = 0.0;
        for (source, weight) in sources(x) {
            let load = weight * if linear { 2.0 * source - 1.0 } else { 1.0 };
            for distance in [(x - source).abs(), x + source, 2.0 - x - source] {
                sum += load * k0(k * distance);
            }
            for (loads, distance) in loads.iter_mut().zip([source, 1.0 - source]) {
                modes.add(k * distance, load, loads);
            }
        }
        sum += ends.iter().zip(&loads).map(|(a, b)| a.dot(b)).sum::<f64>();
        // 2x − 1 = φ₁/√3
        let (loaded, load) = if linear { (1, 1.0 / 3_f64.sqrt()) } else { (0, 1.0) };
        let polynomials = &rows([x].into_iter(), 1e-6, 1.0)[0].weights;
        for a in (loaded..POLYNOMIALS).step_by(2) {
            sum += polynomials[a] * coefficient([loaded, a], k, poisson) * load;
        }
        k / PI * sum
    }

    /// Two quarter spaces and their difference from a plate, against the plate's own equation on panels, which
    /// shares no quadrature and no polynomials with the table; its error is below 1e-6. Each coefficient errs by
    /// 5e-5 of the displacement, and φ is at most √15, at the ends: 2e-4 of that under unit pressure.
    #[test]
    #[ignore = "slow"]
    fn quarter_spaces_and_table_make_a_plate() {
        let tolerance = OF_TABLE * 15_f64.sqrt();
        let places = [0.0, 0.1, 0.4];
        // kL, ν, then the displacements under the uniform load, and under the linear one.
        let expected = [
            [1.0, 0.0, 1.0, 1.0, 1.0, -0.476472, -0.384466, -0.09807],
            [1.0, 0.3, 1.119962, 1.107965, 1.08963, -0.599096, -0.480241, -0.121038],
            [1.0, 0.5, 1.378805, 1.353011, 1.312686, -0.777604, -0.620476, -0.155028],
            [3.0, 0.0, 1.0, 1.0, 1.0, -0.698225, -0.578733, -0.154774],
            [3.0, 0.3, 1.194517, 1.12814, 1.049244, -0.850266, -0.678296, -0.172222],
            [3.0, 0.5, 1.562185, 1.402623, 1.197682, -1.09514, -0.847972, -0.205187],
            [10.0, 0.0, 1.0, 1.0, 1.0, -0.903095, -0.762463, -0.198543],
            [10.0, 0.3, 1.23624, 1.061645, 1.001215, -1.104368, -0.814778, -0.199505],
            [10.0, 0.5, 1.681186, 1.217087, 1.009193, -1.467622, -0.940044, -0.204383],
        ];
        for [k, poisson, values @ ..] in expected {
            let places = places.into_iter();
            let loads = places.clone().map(|x| (x, false)).chain(places.map(|x| (x, true)));
            for ((x, linear), value) in loads.zip(values) {
                let displacement = displacement(k, poisson, x, linear);
                assert!(
                    (displacement - value).abs() < tolerance,
                    "kL {k} ν {poisson}, x {x}, linear {linear}: {displacement} {value}"
                );
            }
        }
    }
}
