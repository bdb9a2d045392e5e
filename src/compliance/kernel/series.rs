//! Hankel transforms of functions of the wavenumber, by series in its logarithm.
//!
//! ```text
//! H(r) = 1/2π ∫₀^∞ D(α) α^w J_ν(αr) dα          r η(r) = ∫₀^r H r' dr'
//! ```
//!
//! with w = 1 for stresses, 0 for displacements (D is α times those). α^b D, with the bias b of
//! [`Kind`](super::mesh::Kind), vanishes at both ends of the spectrum. Sampled on a [`LogMesh`] it is a Fourier series in
//! ln α, and each term has a transform in closed form. The series converges exponentially, since D is
//! analytic in a sector around the positive axis.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::mesh::{LogMesh, Multipliers, Order};
use crate::numerics::fft::fourier_coefficients;

/// Number of terms of the power series of a transform at small distances.
const MOMENTS: usize = 8;

/// Distance, in depths, below which the power series is used: the first term that is left out
/// is 0.2^16 = 7e-12 of the first one, times a binomial coefficient.
const POWER_SERIES_REACH: f64 = 0.2;

/// N transforms at once.
#[derive(Debug)]
pub(crate) struct Series<const N: usize> {
    /// ln of the lowest wavenumber.
    low: f64,
    /// Step in t from term to term.
    step: f64,
    /// Real and imaginary parts of the terms of H.
    terms: Vec<[[f64; N]; 2]>,
    /// Real and imaginary parts of the terms of r η.
    means: Vec<[[f64; N]; 2]>,
    orders: [Order; N],
    depth: f64,
    /// FourierTerms of H/r^ν by powers of (r/depth)².
    powers: [[f64; MOMENTS]; N],
}

/// Fourier coefficients of one function on a mesh, and the size below which the last are dropped.
struct FourierTerms {
    values: Vec<(f64, f64)>,
    negligible: f64,
}

impl<const N: usize> Series<N> {
    /// The series of N functions; `samples[k]` are α^b D at the mesh's wavenumbers, which fall off as
    /// e^{−α depth} or faster. On the threads of the caller.
    pub(crate) fn new(
        mesh: &LogMesh,
        orders: &[Order; N],
        multipliers: &[Multipliers],
        samples: [Vec<f64>; N],
        depth: f64,
    ) -> Self {
        let transformed: Vec<_> = samples
            .into_par_iter()
            .enumerate()
            .map(|(k, samples)| {
                let powers = powers(mesh, orders[k], &samples, depth);
                let largest = samples.iter().fold(0.0, |a: f64, s| a.max(s.abs()));
                let spectrum = FourierTerms {
                    values: coefficients(mesh, samples),
                    // All terms of this size together are rounding.
                    negligible: 1e-15 * largest / mesh.points as f64,
                };
                (powers, spectrum)
            })
            .collect();
        let (powers, spectra): (Vec<_>, Vec<_>) = transformed.into_iter().unzip();
        Self {
            depth,
            powers: std::array::from_fn(|k| powers[k]),
            ..Self::at_surface(mesh, orders, multipliers, &spectra)
        }
    }

    /// The series of functions whose spectra are given; at small distances as elsewhere.
    fn at_surface(
        mesh: &LogMesh,
        orders: &[Order; N],
        multipliers: &[Multipliers],
        spectra: &[FourierTerms],
    ) -> Self {
        let step = mesh.step();
        let kept = |spectrum: &FourierTerms| {
            let size = |c: &(f64, f64)| c.0.hypot(c.1);
            let last = (spectrum.values.iter()).rposition(|c| size(c) > spectrum.negligible);
            last.map_or(0, |last| last + 1)
        };
        let kept = spectra.iter().map(kept).max().unwrap_or(0);
        let mut terms = vec![[[0.0; N]; 2]; kept];
        let mut means = terms.clone();
        for (k, spectrum) in spectra.iter().enumerate() {
            let power = orders[k].kind.power();
            let kept = spectrum.values[..kept].iter();
            for (m, ((re, im), (cos, sin))) in kept.zip(&multipliers[k]).enumerate() {
                let t = m as f64 * step;
                // The series is real: each term but the first stands for its conjugate, too.
                let twice = if m == 0 { 1.0 } else { 2.0 };
                let (hr, hi) = (twice * (re * cos - im * sin), twice * (re * sin + im * cos));
                // Over power − it.
                let norm = 1.0 / (power * power + t * t);
                (terms[m][0][k], terms[m][1][k]) = (hr, hi);
                means[m][0][k] = (power * hr - t * hi) * norm;
                means[m][1][k] = (power * hi + t * hr) * norm;
            }
        }
        Self {
            low: mesh.low,
            step,
            terms,
            means,
            orders: *orders,
            depth: 0.0,
            powers: [[0.0; MOMENTS]; N],
        }
    }

    /// H/r^ν at R distances r ≥ 0 (r > 0 at the surface). Near the axis of a deep plane the series'
    /// rounding would grow by r^{−ν}, and the powers of r² take its place.
    pub(crate) fn reduced<const R: usize>(&self, distances: [f64; R]) -> [[f64; N]; R] {
        let mut values = self.sum(&self.terms, distances);
        for (values, r) in values.iter_mut().zip(distances) {
            if r < POWER_SERIES_REACH * self.depth {
                let s = (r / self.depth).powi(2);
                let horner = |sum: f64, c: &f64| sum * s + c;
                *values = self.powers.map(|c| c.iter().rev().fold(0.0, horner));
                continue;
            }
            for (value, order) in values.iter_mut().zip(&self.orders) {
                *value *= order.kind.scale(r) / r.powi(order.nu as i32);
            }
        }
        values
    }

    /// η at R distances r > 0.
    pub(crate) fn mean<const R: usize>(&self, distances: [f64; R]) -> [[f64; N]; R] {
        let mut values = self.sum(&self.means, distances);
        for (values, r) in values.iter_mut().zip(distances) {
            for (value, order) in values.iter_mut().zip(&self.orders) {
                *value *= order.kind.scale(r) * r;
            }
        }
        values
    }

    /// Sums at several distances together, so that no recurrence waits for itself.
    fn sum<const R: usize>(&self, terms: &[[[f64; N]; 2]], distances: [f64; R]) -> [[f64; N]; R] {
        let turns = distances.map(|r| (-self.step * (r.ln() + self.low)).sin_cos());
        let (mut re, mut im) = ([1.0; R], [0.0; R]);
        let mut sums = [[0.0; R]; N];
        for [real, imaginary] in terms {
            for k in 0..N {
                for p in 0..R {
                    sums[k][p] += real[k] * re[p] - imaginary[k] * im[p];
                }
            }
            for p in 0..R {
                let (sin, cos) = turns[p];
                (re[p], im[p]) = (re[p] * cos - im[p] * sin, re[p] * sin + im[p] * cos);
            }
        }
        std::array::from_fn(|p| std::array::from_fn(|k| sums[k][p]))
    }
}

impl Series<1> {
    /// The series of one function `d` of α, sampled in ln α between `ends` ever closer until its terms
    /// have fallen off, and the error that is left in 2πr H. `size` is that of the numbers whose
    /// difference `d` is.
    pub(crate) fn resolved(
        d: impl Fn(f64) -> f64,
        ends: [f64; 2],
        period: f64,
        order: Order,
        size: f64,
    ) -> (Self, f64) {
        // 0.05, and four halvings at most: responses that vary faster keep a larger error.
        const SPACINGS: [f64; 5] = [0.05, 0.025, 0.0125, 0.00625, 0.003125];
        const CONVERGED: f64 = 1e-13;
        const ROUNDING: f64 = 1e-15;
        let sampled = |spacing: f64| {
            let mesh = LogMesh::over(ends, period, spacing);
            let samples = mesh.wavenumbers().map(&d).collect();
            let coefficients = coefficients(&mesh, samples);
            let last_tenth = &coefficients[coefficients.len() * 9 / 10..];
            let largest = (last_tenth.iter()).fold(0.0, |a: f64, c| a.max(c.0.hypot(c.1)));
            let tail = largest * coefficients.len() as f64;
            (mesh, coefficients, tail)
        };
        let [first, finer @ ..] = SPACINGS;
        let mut found = sampled(first);
        for spacing in finer {
            if found.2 < CONVERGED * size {
                break;
            }
            found = sampled(spacing);
        }
        let (mesh, coefficients, tail) = found;
        let spectrum = FourierTerms { values: coefficients, negligible: 1e-3 * ROUNDING * size };
        let series = Self::at_surface(&mesh, &[order], &[mesh.multipliers(order)], &[spectrum]);
        (series, tail + ROUNDING * size)
    }
}

/// Fourier coefficients of samples on a mesh, followed by zeros to the end of its period.
fn coefficients(mesh: &LogMesh, mut samples: Vec<f64>) -> Vec<(f64, f64)> {
    samples.resize(mesh.points, 0.0);
    fourier_coefficients(samples)
}

/// FourierTerms of (r/z)^{2k} in H/r^ν, z the `depth`; none at the surface.
///
/// ```text
/// (−1)^k / (2^{ν+2k} k! (ν+k)!) · z^{−2k} / 2π ∫ D α^{w+ν+2k} dα
/// ```
fn powers(mesh: &LogMesh, order: Order, samples: &[f64], depth: f64) -> [f64; MOMENTS] {
    if depth <= 0.0 {
        return [0.0; MOMENTS];
    }
    let nu = order.nu;
    let mut factor = 0.5_f64.powf(nu) / (2.0 * PI);
    let mut divisor = 1.0;
    while divisor <= nu {
        factor /= divisor;
        divisor += 1.0;
    }
    // dα = α d(ln α).
    let power = order.kind.shift() + nu + 1.0;
    let mut moments = [0.0; MOMENTS];
    for (alpha, sample) in mesh.wavenumbers().zip(samples) {
        let mut term = alpha.powf(power) * sample;
        for moment in &mut moments {
            *moment += term;
            term *= (alpha * depth).powi(2);
        }
    }
    std::array::from_fn(|k| {
        if k > 0 {
            let k = k as f64;
            factor *= -0.25 / (k * (nu + k));
        }
        factor * moments[k] * mesh.spacing
    })
}

#[cfg(test)]
mod tests {
    use super::super::mesh::Kind;
    use super::*;

    /// Transforms of e^{−αz}: t^ν/R and (z + νR) t^ν/R³ over 2π, with t = r/(R + z); Gradshteyn & Ryzhik
    /// 6.611.1 and its derivative.
    #[test]
    fn transform_of_an_exponential_is_that_of_the_tables() {
        let z: f64 = 0.7;
        let range = [1e-3, 1e4];
        let mesh = LogMesh::new(0.7, 0.7, range);
        for nu in [0.0, 1.0, 2.0, 3.0] {
            let orders = [Kind::Stress, Kind::Displacement].map(|kind| Order { nu, kind });
            let multipliers = orders.map(|order| mesh.multipliers(order));
            let samples = orders.map(|order| {
                mesh.wavenumbers().map(|a| a.powf(order.kind.bias()) * (-a * z).exp()).collect()
            });
            let series = Series::new(&mesh, &orders, &multipliers, samples, z);
            for r in [1e-3_f64, 0.1, 0.7, 5.0, 300.0, 1e4] {
                let root = r.hypot(z);
                let t = (r / (root + z)).powf(nu);
                let [values] = series.sum(&series.terms, [r]);
                let [stress, displacement] = [0, 1].map(|k| values[k] * orders[k].kind.scale(r));
                let exact =
                    [(z + nu * root) * t / root.powi(3) / (2.0 * PI), t / root / (2.0 * PI)];
                // Rounding, in the units in which the transform is a sum of waves.
                let scale = [1.0 / (z * r), 1.0 / (z * r).sqrt()];
                for k in 0..2 {
                    let value = [stress, displacement][k];
                    assert!(
                        (value - exact[k]).abs() < 1e-13 * scale[k],
                        "nu {nu}, r {r}, {k}: {value} {}",
                        exact[k]
                    );
                }
            }
        }
    }
}
