//! Hankel transforms of functions of the wavenumber, by series in its logarithm.
//!
//! ```text
//! H(r) = 1/2π ∫₀^∞ D(α) α^w J_ν(αr) dα          r η(r) = ∫₀^r H r' dr'
//! ```
//!
//! with w = 1 for stresses, 0 for displacements (D is α times those). α^b D, with the bias b of [`TransformKind`],
//! vanishes at both ends of the spectrum. Sampled on a [`LogMesh`] it is a Fourier series in ln α, of terms α^{it}. The
//! series converges exponentially, since D is analytic in a sector around the positive axis. With μ = s + it, s the shift
//! of [`TransformKind`], a term has the transform
//!
//! ```text
//! ∫₀^∞ u^μ J_ν(u) du = 2^μ Γ((1+ν+μ)/2) / Γ((1+ν−μ)/2)          DLMF 10.22.43
//! ```
//!
//! Talman, J. Comput. Phys. 29 (1978) 35, doi:10.1016/0021-9991(78)90107-9; Hamilton, Mon. Not. R.
//! Astron. Soc. 312 (2000) 257, appendix B ("FFTLog"), doi:10.1046/j.1365-8711.2000.03071.x.

use std::f64::consts::{E, LN_2, PI};

use rayon::prelude::*;

use crate::compliance::response::Response;
use crate::compliance::response::interior::{Column, Place, UnitFields};
use crate::model::body::HalfSpace;
use crate::model::material::Elastic;
use crate::numerics::fft::{fast_length, fourier_coefficients};

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
    /// Coefficients of H/r^ν by powers of (r/depth)².
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
        transforms: &[TermTransforms],
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
            ..Self::at_surface(mesh, orders, transforms, &spectra)
        }
    }

    /// The series of functions whose spectra are given; at small distances as elsewhere.
    fn at_surface(
        mesh: &LogMesh,
        orders: &[Order; N],
        transforms: &[TermTransforms],
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
            for (m, ((re, im), (cos, sin))) in kept.zip(&transforms[k]).enumerate() {
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
    /// have fallen off, and the error that is left in 2πr H. `d` is a difference of numbers as large as `size`,
    /// of which its rounding and the terms that are negligible are shares.
    pub(crate) fn resolved(
        d: impl Fn(f64) -> f64,
        ends: [f64; 2],
        period: f64,
        order: Order,
        size: f64,
    ) -> (Self, f64) {
        // 0.05, and four halvings at most: responses that vary faster keep a larger error.
        const SPACINGS: [f64; 5] = [0.05, 0.025, 0.0125, 0.00625, 0.003125];
        // Terms over `size` below which closer samples change nothing: a hundred times its rounding.
        const CONVERGED: f64 = 1e-13;
        // Some units in the last place of `size`.
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
        let mut samples = sampled(first);
        for spacing in finer {
            if samples.2 < CONVERGED * size {
                break;
            }
            samples = sampled(spacing);
        }
        let (mesh, coefficients, tail) = samples;
        let spectrum = FourierTerms { values: coefficients, negligible: 1e-3 * ROUNDING * size };
        let series = Self::at_surface(&mesh, &[order], &[mesh.transforms(order)], &[spectrum]);
        (series, tail + ROUNDING * size)
    }
}

/// Fourier coefficients of samples on a mesh, followed by zeros to the end of its period.
fn coefficients(mesh: &LogMesh, mut samples: Vec<f64>) -> Vec<(f64, f64)> {
    samples.resize(mesh.points, 0.0);
    fourier_coefficients(samples)
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

/// Order ν of the Bessel function of a transform, and its kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Order {
    pub(crate) nu: f64,
    pub(crate) kind: TransformKind,
}

/// Exponents w and b of a transform.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TransformKind {
    /// w = b = 1.
    Stress,
    /// w = 0, b = ½: D may be finite at α = 0.
    Displacement,
    /// w = b = 0: a displacement whose D vanishes at α = 0 too.
    Vanishing,
    /// Cosine (ν = −½) and sine (ν = ½) transforms 1/π ∫ D {cos, sin} αy dα of a line contact;
    /// b = ½, and η is ∫₀^r H dr.
    Line,
}

impl TransformKind {
    /// The bias b: the power of α that is transformed with D.
    pub(crate) fn bias(self) -> f64 {
        match self {
            Self::Stress => 1.0,
            Self::Displacement | Self::Line => 0.5,
            Self::Vanishing => 0.0,
        }
    }

    /// The shift s = w − b; 0 for a line, since cos u = √(πu/2) J_{−½}(u).
    pub(super) fn shift(self) -> f64 {
        match self {
            Self::Stress | Self::Vanishing | Self::Line => 0.0,
            Self::Displacement => -0.5,
        }
    }

    /// The factor of the series: H = `scale`(r) · series.
    pub(super) fn scale(self, r: f64) -> f64 {
        match self {
            Self::Stress | Self::Vanishing => 1.0 / (2.0 * PI * r),
            Self::Displacement => 1.0 / (2.0 * PI * r.sqrt()),
            Self::Line => 1.0 / (2.0 * PI * r).sqrt(),
        }
    }

    /// The power of r, less −it, of the terms of r η.
    pub(super) fn power(self) -> f64 {
        match self {
            Self::Stress | Self::Vanishing => 1.0,
            Self::Displacement => 1.5,
            Self::Line => 0.5,
        }
    }
}

/// Transforms of α^{it} for each term of a series: real and imaginary parts.
pub(crate) type TermTransforms = Vec<(f64, f64)>;

/// Wavenumbers that are even in their logarithm.
#[derive(Debug)]
pub(crate) struct LogMesh {
    /// ln of the lowest wavenumber.
    pub(super) low: f64,
    pub(super) spacing: f64,
    /// Points of a period in ln α.
    pub(super) points: usize,
    /// Points that hold samples; the rest of the period is zero.
    sampled: usize,
}

/// Length in ln r or ln α over which a function that falls as √r or √α is followed: e^{−32} = 1e-14.
const DECAY: f64 = 64.0;

/// Largest αh that is sampled below the surface: e^{−80}, times the highest power of α whose moment
/// [`Series`] takes, is below rounding.
const HIGHEST: f64 = 80.0;

/// Spacing in ln α below the surface. A response that is analytic in a sector of half-angle θ leaves
/// an error of e^{−πθ/spacing}: 2e-14 at θ = 0.6. Chosen by trial on layered bodies.
const SPACING: f64 = 0.06;

impl LogMesh {
    /// The mesh for responses that vary between the wavenumbers `1/long` and `1/short`, and have
    /// vanished beyond 80/`short`; transformed to distances in `range`.
    pub(crate) fn new(short: f64, long: f64, range: [f64; 2]) -> Self {
        let ends = [-long.ln() - DECAY, (HIGHEST / short).ln()];
        let outer = (range[1] / short).ln().max(0.0);
        let inner = (long / range[0]).ln().max(0.0);
        let period = (ends[1] - ends[0]).max(DECAY + outer).max(DECAY + inner) + 4.0;
        Self::over(ends, period, SPACING)
    }

    /// The mesh that samples ln α from one of `ends` to the other, in a `period` of ln α.
    pub(crate) fn over([low, high]: [f64; 2], period: f64, spacing: f64) -> Self {
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

    /// Step in t from one term of the series to the next.
    pub(super) fn step(&self) -> f64 {
        2.0 * PI / (self.points as f64 * self.spacing)
    }

    /// Transforms of all terms for one Bessel order and kind.
    pub(crate) fn transforms(&self, order: Order) -> TermTransforms {
        let shift = order.kind.shift();
        let (above, below) = (0.5 * (1.0 + order.nu + shift), 0.5 * (1.0 + order.nu - shift));
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

/// A layered body at all wavenumbers of a mesh.
#[derive(Debug)]
pub(crate) struct Spectrum {
    pub(crate) mesh: LogMesh,
    columns: Vec<(f64, Column)>,
}

impl Spectrum {
    /// The spectrum of `body` for distances in `range`; none where the body is homogeneous.
    pub(crate) fn new(body: &HalfSpace, range: [f64; 2]) -> Option<Self> {
        let [top, longest] = body.lengths()?;
        let mesh = LogMesh::new(top, longest, range);
        let columns = mesh.wavenumbers().map(|alpha| (alpha, Column::new(body, alpha))).collect();
        Some(Self { mesh, columns })
    }

    /// N functions of the fields at `place`, less those of a half-space of the material there, at each
    /// wavenumber. On the threads of the caller.
    pub(crate) fn differences<const N: usize>(
        &self,
        body: &HalfSpace,
        place: &Place,
        functions: impl Fn(&UnitFields, Elastic) -> [f64; N] + Sync,
    ) -> Vec<(f64, [f64; N])> {
        let material = place.material;
        let difference = |(alpha, column): &(f64, Column)| {
            let layered = functions(&column.at(body, place), material);
            let homogeneous = UnitFields::homogeneous(material, alpha * place.depth);
            let homogeneous = functions(&homogeneous, material);
            (*alpha, std::array::from_fn(|k| layered[k] - homogeneous[k]))
        };
        self.columns.par_iter().map(difference).collect()
    }
}

/// c0 and c1 of N functions of a half-space's fields, each (c0 + c1 αz) e^{−αz}.
pub(super) fn homogeneous<const N: usize>(
    material: Elastic,
    functions: impl Fn(&UnitFields, Elastic) -> [f64; N],
) -> [[f64; 2]; N] {
    let at = |y: f64| functions(&UnitFields::homogeneous(material, y), material);
    let (zero, one) = (at(0.0), at(1.0));
    std::array::from_fn(|k| [zero[k], one[k] * E - zero[k]])
}

/// ln Γ(re + i im), re > 0: ln of the modulus, and phase. Stirling's series (DLMF 5.11.1) after ten
/// steps of the recurrence, where its five terms leave 1e-14.
fn ln_gamma(re: f64, im: f64) -> (f64, f64) {
    const BERNOULLI: [f64; 5] =
        [1.0 / 12.0, -1.0 / 360.0, 1.0 / 1260.0, -1.0 / 1680.0, 1.0 / 1188.0];
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
    use super::super::series::TransformKind;
    use super::*;

    /// Transforms of e^{−αz}: t^ν/R and (z + νR) t^ν/R³ over 2π, with t = r/(R + z); Gradshteyn & Ryzhik
    /// 6.611.1 and its derivative.
    #[test]
    fn transform_of_an_exponential_is_that_of_the_tables() {
        let z: f64 = 0.7;
        let range = [1e-3, 1e4];
        let mesh = LogMesh::new(0.7, 0.7, range);
        for nu in [0.0, 1.0, 2.0, 3.0] {
            let orders =
                [TransformKind::Stress, TransformKind::Displacement].map(|kind| Order { nu, kind });
            let transforms = orders.map(|order| mesh.transforms(order));
            let samples = orders.map(|order| {
                mesh.wavenumbers().map(|a| a.powf(order.kind.bias()) * (-a * z).exp()).collect()
            });
            let series = Series::new(&mesh, &orders, &transforms, samples, z);
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

    /// Phases of Γ(½ + it/2), by mpmath with 30 digits; the modulus is √(π/cosh(πt/2)), DLMF 5.4.4.
    #[test]
    fn ln_gamma_matches_high_precision() {
        for (t, expected) in [
            (1.0, -0.750_729_202_122_050_7),
            (4.0, -0.592_536_981_977_034_6),
            (40.0, 39.916_729_108_473_33),
        ] {
            let (log, phase) = ln_gamma(0.5, 0.5 * t);
            let modulus = 0.5 * (PI / (0.5 * PI * t).cosh()).ln();
            // Logarithms of up to 40 cancel in that of the modulus.
            for (value, expected, rounding) in [(phase, expected, 1e-14), (log, modulus, 4e-14)] {
                let error = (value - expected).abs() / expected.abs().max(1.0);
                assert!(error < rounding, "{t}: {value} {expected}");
            }
        }
    }
}
