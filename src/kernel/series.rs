//! Hankel transforms of functions of the wavenumber, by series in its logarithm.
//!
//! ```text
//! H(r) = 1/2π ∫₀^∞ D(α) α^w J_ν(αr) dα          r η(r) = ∫₀^r H r' dr'
//! ```
//!
//! with w = 1 for stresses, 0 for displacements (of which D is α times). α^b D, b = w for the first
//! and ½ for the second, vanishes at both ends of the spectrum. Sampled evenly in ln α it is a
//! Fourier series, of which each term has a transform in closed form, with μ = w − b + it:
//!
//! ```text
//! ∫₀^∞ u^μ J_ν(u) du = 2^μ Γ((1+ν+μ)/2) / Γ((1+ν−μ)/2)          DLMF 10.22.43
//! ```
//!
//! Talman, J. Comput. Phys. 29 (1978) 35; Hamilton, Mon. Not. R. Astron. Soc. 312 (2000) 257,
//! appendix B ("FFTLog").

use std::f64::consts::{LN_2, PI};

use rayon::prelude::*;

use crate::fft::{fast_length, fourier_coefficients};

/// What is transformed: order ν of the Bessel function, and kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Order {
    pub(crate) nu: f64,
    pub(crate) kind: Kind,
}

/// w and b of the module's formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Stress,
    Displacement,
    /// Cosine (ν = −½) and sine (ν = ½) transforms 1/π ∫ D {cos, sin} αy dα of a line contact;
    /// η is then ∫₀^r H dr.
    Line,
}

impl Kind {
    /// b: the power of α that is transformed with D.
    pub(crate) fn bias(self) -> f64 {
        match self {
            Self::Stress => 1.0,
            Self::Displacement | Self::Line => 0.5,
        }
    }

    /// w − b, and for a line 0: cos u = √(πu/2) J_{−½}(u).
    fn shift(self) -> f64 {
        match self {
            Self::Stress | Self::Line => 0.0,
            Self::Displacement => -0.5,
        }
    }

    /// What the series is multiplied by: H = `scale`(r) · series.
    fn scale(self, r: f64) -> f64 {
        match self {
            Self::Stress => 1.0 / (2.0 * PI * r),
            Self::Displacement => 1.0 / (2.0 * PI * r.sqrt()),
            Self::Line => 1.0 / (2.0 * PI * r).sqrt(),
        }
    }

    /// The power of r, less −it, of the terms of r η.
    fn power(self) -> f64 {
        match self {
            Self::Stress => 1.0,
            Self::Displacement => 1.5,
            Self::Line => 0.5,
        }
    }
}

/// Wavenumbers, even in their logarithms, and the transforms of the powers of them.
#[derive(Debug)]
pub(crate) struct LogMesh {
    low: f64,
    spacing: f64,
    points: usize,
    /// Those at which anything is left of a response.
    sampled: usize,
}

/// How far, in ln r or ln α, what falls by ½ in its logarithm is followed: e^{−32} = 1e-14.
const DECAY: f64 = 64.0;

impl LogMesh {
    /// For responses that vary between the wavenumbers `1/long` and `1/short`, and are nothing
    /// beyond 80/short; transformed to distances in `range`.
    pub(crate) fn new(short: f64, long: f64, range: [f64; 2]) -> Self {
        let low = -long.ln() - DECAY;
        let high = (HIGHEST / short).ln();
        let outer = (range[1] / short).ln().max(0.0);
        let inner = (long / range[0]).ln().max(0.0);
        let period = (high - low).max(DECAY + outer).max(DECAY + inner) + 4.0;
        let spacing = SPACING;
        Self {
            low,
            spacing,
            points: fast_length((period / spacing).ceil() as usize),
            sampled: ((high - low) / spacing).ceil() as usize,
        }
    }

    /// The wavenumbers at which responses are sampled.
    pub(crate) fn wavenumbers(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.sampled).map(|n| (self.low + n as f64 * self.spacing).exp())
    }

    fn step(&self) -> f64 {
        2.0 * PI / (self.points as f64 * self.spacing)
    }

    /// Transforms of α^{it} for every term: real and imaginary parts.
    pub(crate) fn multipliers(&self, order: Order) -> Vec<(f64, f64)> {
        let shift = order.kind.shift();
        let (above, below) = (
            0.5 * (1.0 + order.nu + shift),
            0.5 * (1.0 + order.nu - shift),
        );
        (0..=self.points / 2)
            .map(|m| {
                let t = m as f64 * self.step();
                let (num, den) = (ln_gamma(above, 0.5 * t), ln_gamma(below, 0.5 * t));
                // The denominator is at −it: the conjugate.
                let size = (shift * LN_2 + num.0 - den.0).exp();
                let (sin, cos) = (t * LN_2 + num.1 + den.1).sin_cos();
                (size * cos, size * sin)
            })
            .collect()
    }
}

/// e^{−80}, times the highest power that [`Series`] takes moments of, is below rounding.
const HIGHEST: f64 = 80.0;

/// Terms of the power series of a transform at small distances.
const MOMENTS: usize = 8;

/// Spacing in ln α: a response that is analytic in a sector of half-angle θ leaves e^{−πθ/spacing}.
const SPACING: f64 = 0.06;

/// N transforms at once.
#[derive(Debug)]
pub(crate) struct Series<const N: usize> {
    low: f64,
    step: f64,
    /// Real and imaginary parts, of H and of r η.
    terms: Vec<[[f64; N]; 2]>,
    means: Vec<[[f64; N]; 2]>,
    orders: [Order; N],
    depth: f64,
    /// H/r^ν by powers of (r/depth)².
    powers: [[f64; MOMENTS]; N],
}

impl<const N: usize> Series<N> {
    /// Of the functions of which `samples[k]` are α^b D at the mesh's wavenumbers; they fall off as
    /// e^{−α depth}, or faster. On the threads of the caller.
    pub(crate) fn new(
        mesh: &LogMesh,
        orders: &[Order; N],
        multipliers: &[Vec<(f64, f64)>],
        samples: [Vec<f64>; N],
        depth: f64,
    ) -> Self {
        let step = mesh.step();
        let mut terms = vec![[[0.0; N]; 2]; mesh.points / 2 + 1];
        let mut means = terms.clone();
        let transformed: Vec<_> = samples
            .into_par_iter()
            .enumerate()
            .map(|(k, mut samples)| {
                let powers = powers(mesh, orders[k], &samples, depth);
                let largest = samples.iter().fold(0.0, |a: f64, s| a.max(s.abs()));
                samples.resize(mesh.points, 0.0);
                (powers, largest, fourier_coefficients(samples))
            })
            .collect();
        let powers = std::array::from_fn(|k| transformed[k].0);
        let mut kept = 0;
        for (k, (_, largest, coefficients)) in transformed.into_iter().enumerate() {
            let power = orders[k].kind.power();
            for (m, (re, im)) in coefficients.into_iter().enumerate() {
                if re.hypot(im) * mesh.points as f64 > 1e-15 * largest {
                    kept = kept.max(m + 1);
                }
                let (cos, sin) = multipliers[k][m];
                let t = m as f64 * step;
                // Real series: each term but the first stands for itself and its conjugate.
                let twice = if m == 0 { 1.0 } else { 2.0 };
                let (hr, hi) = (twice * (re * cos - im * sin), twice * (re * sin + im * cos));
                // Over power − it.
                let norm = 1.0 / (power * power + t * t);
                (terms[m][0][k], terms[m][1][k]) = (hr, hi);
                means[m][0][k] = (power * hr - t * hi) * norm;
                means[m][1][k] = (power * hi + t * hr) * norm;
            }
        }
        terms.truncate(kept);
        means.truncate(kept);
        Self {
            low: mesh.low,
            step,
            orders: *orders,
            terms,
            means,
            depth,
            powers,
        }
    }

    /// H/r^ν at R distances r ≥ 0. Nearer than a fifth of the depth the series' rounding would grow by
    /// r^{−ν}, and the powers of r² take its place.
    pub(crate) fn reduced<const R: usize>(&self, distances: [f64; R]) -> [[f64; N]; R] {
        let mut values = self.sum(&self.terms, distances);
        for (values, r) in values.iter_mut().zip(distances) {
            if r < 0.2 * self.depth {
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

    /// Several at once, so that one recurrence does not wait for itself.
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

/// Coefficients of (r/z)^{2k} in H/r^ν, z the `depth`; none at the surface.
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

/// ln Γ(re + i im), re > 0: ln of the modulus, and phase. Stirling's series after ten steps of the
/// recurrence; DLMF 5.11.1.
fn ln_gamma(re: f64, im: f64) -> (f64, f64) {
    const BERNOULLI: [f64; 5] = [
        1.0 / 12.0,
        -1.0 / 360.0,
        1.0 / 1260.0,
        -1.0 / 1680.0,
        1.0 / 1188.0,
    ];
    let (mut log, mut phase) = (0.0, 0.0);
    for k in 0..10 {
        let x = re + f64::from(k);
        log -= x.hypot(im).ln();
        phase -= im.atan2(x);
    }
    let x = re + 10.0;
    let (modulus, angle) = (x.hypot(im), im.atan2(x));
    let ln = modulus.ln();
    // (z − ½) ln z − z + ½ ln 2π + Σ B_2k / (2k (2k−1) z^{2k−1})
    log += (x - 0.5) * ln - im * angle - x + 0.5 * (2.0 * PI).ln();
    phase += (x - 0.5) * angle + im * ln - im;
    for (k, b) in BERNOULLI.into_iter().enumerate() {
        let power = 2 * k as i32 + 1;
        let size = b * modulus.powi(-power);
        let (sin, cos) = (f64::from(power) * angle).sin_cos();
        log += size * cos;
        phase -= size * sin;
    }
    (log, phase)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of e^{−αz}: t^ν/R and (z + νR) t^ν/R³ over 2π, with t = r/(R + z); Gradshteyn & Ryzhik
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
                mesh.wavenumbers()
                    .map(|a| a.powf(order.kind.bias()) * (-a * z).exp())
                    .collect()
            });
            let series = Series::new(&mesh, &orders, &multipliers, samples, z);
            for r in [1e-3_f64, 0.1, 0.7, 5.0, 300.0, 1e4] {
                let root = r.hypot(z);
                let t = (r / (root + z)).powf(nu);
                let [values] = series.sum(&series.terms, [r]);
                let [stress, displacement] = [0, 1].map(|k| values[k] * orders[k].kind.scale(r));
                let exact = [
                    (z + nu * root) * t / root.powi(3) / (2.0 * PI),
                    t / root / (2.0 * PI),
                ];
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
