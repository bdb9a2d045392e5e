//! Wavenumbers that are even in their logarithm, and the Hankel transforms of powers of them.
//!
//! Samples on such a mesh are a Fourier series in ln α, of terms α^{it}. With μ = s + it, s the shift
//! of [`Kind`], a term has the transform
//!
//! ```text
//! ∫₀^∞ u^μ J_ν(u) du = 2^μ Γ((1+ν+μ)/2) / Γ((1+ν−μ)/2)          DLMF 10.22.43
//! ```
//!
//! Talman, J. Comput. Phys. 29 (1978) 35, doi:10.1016/0021-9991(78)90107-9; Hamilton, Mon. Not. R.
//! Astron. Soc. 312 (2000) 257, appendix B ("FFTLog"), doi:10.1046/j.1365-8711.2000.03071.x.

use std::f64::consts::{E, LN_2, PI};

use rayon::prelude::*;

use crate::compliance::response::interior::{Column, Fields, Place};
use crate::model::body::HalfSpace;
use crate::model::material::Elastic;
use crate::numerics::fft::fast_length;

/// Order ν of the Bessel function of a transform, and its kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Order {
    pub(crate) nu: f64,
    pub(crate) kind: Kind,
}

/// Exponents w and b of the transforms in [`super::series`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
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

impl Kind {
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
pub(crate) type Multipliers = Vec<(f64, f64)>;

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
/// [`super::series`] takes, is below rounding.
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
    pub(crate) fn multipliers(&self, order: Order) -> Multipliers {
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
        let top = body.layers().first()?;
        let mesh = LogMesh::new(top.thickness(), body.thickness(), range);
        let columns = mesh.wavenumbers().map(|alpha| (alpha, Column::new(body, alpha))).collect();
        Some(Self { mesh, columns })
    }

    /// N functions of the fields at `place`, less those of a half-space of the material there, at each
    /// wavenumber. On the threads of the caller.
    pub(crate) fn differences<const N: usize>(
        &self,
        body: &HalfSpace,
        place: &Place,
        functions: impl Fn(&Fields, Elastic) -> [f64; N] + Sync,
    ) -> Vec<(f64, [f64; N])> {
        let material = place.material;
        let difference = |(alpha, column): &(f64, Column)| {
            let layered = functions(&column.at(body, place), material);
            let homogeneous = Fields::homogeneous(material, alpha * place.depth);
            let homogeneous = functions(&homogeneous, material);
            (*alpha, std::array::from_fn(|k| layered[k] - homogeneous[k]))
        };
        self.columns.par_iter().map(difference).collect()
    }
}

/// c0 and c1 of N functions of a half-space's fields, each (c0 + c1 αz) e^{−αz}.
pub(super) fn homogeneous<const N: usize>(
    material: Elastic,
    functions: impl Fn(&Fields, Elastic) -> [f64; N],
) -> [[f64; 2]; N] {
    let at = |y: f64| functions(&Fields::homogeneous(material, y), material);
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
    use super::*;

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
