//! Two free ends of one body: what a plate adds to two quarter spaces.
//!
//! A body 0 ≤ x ≤ L, z ≥ 0 with both faces free is displaced as two quarter spaces and, for each wavenumber k
//! along y, by
//!
//! ```text
//! (1−ν)/πG ∫ D(x,x′) p(x′) dx′        D(x,x′) = Σ_ab φ_a(x) D_ab φ_b(x′)        φ_a = √(2a+1) P_a(2x/L − 1)
//! ```
//!
//! D_ab/L depends on kL and ν. It is tabulated for a, b ≤ 7, which leaves 5e-5 of the displacement; above kL = 15,
//! it is less than 1e-6. It follows from one equation as that of the quarter space: a half-space under a pressure
//! that is even and periodic, and a plate under tractions on its faces (`tests/data/plate`). The method is nacre's
//! own.
//!
//! A plate that is infinitely deep yields without limit to a load that is local along y: D_00 and D_11 grow as
//! 1/k. They move the plate's surface as a whole, and change no pressure under a given load and moment. Below
//! kL = 1 they are kept as they are there: the body counts as about as deep as it is long.

use std::sync::LazyLock;

use ndarray::Array2;

use super::waves::{Waves, Width};
use crate::convolution::{RowWeights, distances, pair};
use crate::kernel::quadrature::Rule;
use crate::material::Elastic;

/// Number of polynomials φ.
const POLYNOMIALS: usize = 8;

/// Chebyshev polynomials of the table, of ν and of ln kL.
const ORDERS: [usize; 2] = [6, 20];

/// kL between which the table holds.
const RANGE: [f64; 2] = [0.1, 15.0];

/// kL below which the motion of the surface as a whole does not grow.
const AS_DEEP_AS_LONG: f64 = 1.0;

/// Coefficients of one D_ab.
#[derive(Debug)]
struct Entry {
    pair: [usize; 2],
    coefficients: Vec<f64>,
}

static TABLE: LazyLock<Vec<Entry>> = LazyLock::new(|| {
    let text = include_str!("plate.txt");
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let rows: Vec<Vec<f64>> = lines
        .map(|line| {
            line.split(' ')
                .filter_map(|word| word.parse().ok())
                .collect()
        })
        .collect();
    (rows.chunks_exact(1 + ORDERS[0]))
        .map(|block| Entry {
            pair: [block[0][0] as usize, block[0][1] as usize],
            coefficients: block[1..].concat(),
        })
        .collect()
});

impl Entry {
    /// D_ab/L
    fn at(&self, kl: f64, poisson: f64) -> f64 {
        let lowest = if self.pair == [0, 0] || self.pair == [1, 1] {
            AS_DEEP_AS_LONG
        } else {
            RANGE[0]
        };
        let kl = kl.max(lowest);
        if kl > RANGE[1] {
            return 0.0;
        }
        let of_poisson = chebyshev::<{ ORDERS[0] }>(4.0 * poisson - 1.0);
        let place = (kl / RANGE[0]).ln() / (RANGE[1] / RANGE[0]).ln();
        let of_length = chebyshev::<{ ORDERS[1] }>(2.0 * place - 1.0);
        let rows = self.coefficients.chunks_exact(ORDERS[1]).zip(of_poisson);
        let sum: f64 = rows
            .map(|(row, p)| p * row.iter().zip(of_length).map(|(c, q)| c * q).sum::<f64>())
            .sum();
        sum * (-kl).exp() / kl
    }
}

/// Chebyshev's polynomials T_0, T_1, … at t.
fn chebyshev<const N: usize>(t: f64) -> [f64; N] {
    let mut values = [1.0; N];
    values[1] = t;
    for n in 2..N {
        values[n] = 2.0 * t * values[n - 1] - values[n - 2];
    }
    values
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
            let (mut p, mut before) = (1.0, 0.0);
            for (a, weight) in weights.iter_mut().enumerate() {
                let n = a as f64;
                *weight += w * length / dx * (2.0 * n + 1.0).sqrt() * p;
                (p, before) = (((2.0 * n + 1.0) * t * p - n * before) / (n + 1.0), p);
            }
        }
        RowWeights { first: 0, weights }
    };
    x.map(means).collect()
}

/// Coefficients \[m/Pa\] for a body of `material` and this `length` on cells of sides \[dx, dy\]: pairs of
/// polynomials, distances along y for `ny` cells.
pub(super) fn coefficients(
    material: Elastic,
    length: f64,
    [dx, dy]: [f64; 2],
    ny: usize,
) -> Array2<f64> {
    let along_y: Vec<f64> = (0..distances(ny)).map(|l| l as f64 * dy).collect();
    let farthest = along_y.last().copied().unwrap_or(0.0) + dy;
    let reach = farthest.max(length / AS_DEEP_AS_LONG);
    let width = Width::LoadAndMean(0.5 * dy);
    let waves = Waves::new(&along_y, width, reach, RANGE[1] / length);
    let last = POLYNOMIALS - 1;
    let mut coefficients = Array2::zeros((pair(last, last) + 1, along_y.len()));
    let short = 2.0 / material.plane_strain_modulus();
    let factor = short * dx * dy / std::f64::consts::PI.powi(2);
    for entry in TABLE.iter() {
        let [a, b] = entry.pair;
        let mut row = coefficients.row_mut(pair(a, b));
        for (k, weights) in waves.wavenumbers.iter().zip(&waves.weights) {
            let amplitude = factor * entry.at(k * length, material.poisson());
            row.iter_mut()
                .zip(weights)
                .for_each(|(sum, weight)| *sum += amplitude * weight);
        }
    }
    coefficients
}
