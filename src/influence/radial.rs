//! Radial kernels of a layered half-space: displacement under a point force, and its integral.
//!
//! ```text
//! κ(r) = r ∫ [α c11 − A1] J0(αr) dα          A1 = (1−ν1)/G1, of the surface material
//! η(R) = 1/R ∫₀ᴿ κ(r) dr
//! ```
//!
//! so that u_z = (A1 + κ)/(2πr) per unit force. Both are smooth functions of ln r, from 0 at r → 0
//! to A − A1 far off (A of the substrate).
//!
//! D(α) = α c11 − A1, less an image (A − A1) e^{−αd} of which both kernels are known, vanishes at
//! both ends of the spectrum. Sampled evenly in ln α it is a Fourier series in ln α, of which each
//! term (α/α_c)^{it} has the transform
//!
//! ```text
//! ∫ u^{it} J0(u) du = 2^{it} Γ((1+it)/2) / Γ((1−it)/2),     of modulus 1,
//! ```
//!
//! and, for η, that over 1 − it. The series converges exponentially, since D is analytic in a
//! sector around the positive axis. Talman, J. Comput. Phys. 29 (1978) 35; Hamilton, Mon. Not. R.
//! Astron. Soc. 312 (2000) 257, appendix B ("FFTLog").

use crate::fft::{fast_length, fourier_coefficients};
use crate::response::Response;

/// Series of κ and η, as functions of ln r.
#[derive(Debug)]
pub(super) struct RadialKernel {
    /// A1 \[1/Pa\].
    pub(super) short: f64,
    /// A − A1 \[1/Pa\].
    rest: f64,
    image_depth: f64,
    log_center: f64,
    /// Step in t of the series.
    step: f64,
    /// Real and imaginary parts of the terms of κ and of η, from t = 0 on.
    terms: Vec<Term>,
    /// Estimated error of κ and η \[1/Pa\].
    pub(super) error: f64,
}

#[derive(Debug, Clone, Copy)]
struct Term {
    kappa: (f64, f64),
    eta: (f64, f64),
}

/// Finest sampling in ln α, for bodies whose response varies fast: 1/320.
const HALVINGS: usize = 4;

impl RadialKernel {
    /// The kernels of `body` for distances from `shortest` to `longest`; none where its response
    /// is homogeneous.
    pub(super) fn new(body: &dyn Response, shortest: f64, longest: f64) -> Option<Self> {
        let limits = body.asymptotes();
        let scale = limits.short.max(limits.long);
        let rest = limits.long - limits.short;
        let [top, thickness] = body.lengths()?;
        // This depth takes the term of first order in α as well, where it is a depth at all.
        let matched = -limits.constant / rest;
        let image_depth = if (0.1 * top..1e3 * thickness).contains(&matched) {
            matched
        } else {
            2.0 * thickness
        };
        let remainder =
            |alpha: f64| body.normal(alpha) - limits.short - rest * (-alpha * image_depth).exp();
        // Where the remainder has vanished: from there on, it is below rounding.
        let (mut low, mut high) = ((1.0 / thickness).ln(), (1.0 / top).ln());
        let vanished =
            |log: f64| (0..3).all(|k| remainder((log + f64::from(k)).exp()).abs() < 1e-16 * scale);
        while low > (1.0 / thickness).ln() - 60.0 && !vanished(low - 3.0) {
            low -= 1.0;
        }
        while high < (1.0 / top).ln() + 12.0 && !vanished(high) {
            high += 1.0;
        }
        // The kernels of the remainder fall off as r at small and r^{−2} at large distance; the
        // period must keep them from overlapping.
        let inner = (longest / top).ln().max(0.0) + 38.0;
        let outer = (thickness / shortest).ln().max(0.0) + 38.0;
        let period = (high - low + 4.0).max(inner).max(outer);

        let mut spacing = 0.05;
        let mut halvings = 0;
        loop {
            let points = fast_length((period / spacing).ceil() as usize);
            let samples = (0..points)
                .map(|n| {
                    let log = low + n as f64 * spacing;
                    if log > high {
                        0.0
                    } else {
                        remainder(log.exp())
                    }
                })
                .collect();
            let series = fourier_coefficients(samples);
            let tail = series[series.len() * 9 / 10..]
                .iter()
                .map(|c| c.0.hypot(c.1));
            let tail = tail.fold(0.0, f64::max) * series.len() as f64;
            if tail < 1e-13 * scale || halvings == HALVINGS {
                let step = 2.0 * std::f64::consts::PI / (points as f64 * spacing);
                let error = tail + 1e-15 * scale;
                let terms = transform(&series, step, 1e-18 * scale);
                let short = limits.short;
                return Some(Self {
                    short,
                    rest,
                    image_depth,
                    log_center: low,
                    step,
                    terms,
                    error,
                });
            }
            spacing *= 0.5;
            halvings += 1;
        }
    }

    /// κ and η at distance r > 0.
    pub(super) fn at(&self, r: f64) -> (f64, f64) {
        let (sin, cos) = (-self.step * (r.ln() + self.log_center)).sin_cos();
        let (mut re, mut im) = (1.0, 0.0);
        let (mut kappa, mut eta) = (0.0, 0.0);
        for term in &self.terms {
            kappa += term.kappa.0 * re - term.kappa.1 * im;
            eta += term.eta.0 * re - term.eta.1 * im;
            (re, im) = (re * cos - im * sin, re * sin + im * cos);
        }
        let root = r.hypot(self.image_depth);
        (
            kappa + self.rest * r / root,
            eta + self.rest * r / (root + self.image_depth),
        )
    }
}

/// Terms of κ and η from those of the remainder; those below `negligible` at the end are dropped.
fn transform(series: &[(f64, f64)], step: f64, negligible: f64) -> Vec<Term> {
    let kept = series
        .iter()
        .rposition(|c| c.0.hypot(c.1) > negligible)
        .map_or(0, |last| last + 1);
    series[..kept]
        .iter()
        .enumerate()
        .map(|(m, &(re, im))| {
            let t = m as f64 * step;
            let phase = t * std::f64::consts::LN_2 + 2.0 * gamma_phase(t);
            let (sin, cos) = phase.sin_cos();
            // Real series: each term but the first stands for itself and its conjugate.
            let twice = if m == 0 { 1.0 } else { 2.0 };
            let (kr, ki) = (twice * (re * cos - im * sin), twice * (re * sin + im * cos));
            // Over 1 − it.
            let norm = 1.0 / (1.0 + t * t);
            Term {
                kappa: (kr, ki),
                eta: ((kr - t * ki) * norm, (ki + t * kr) * norm),
            }
        })
        .collect()
}

/// arg Γ((1 + it)/2), t ≥ 0, by Stirling's series after ten steps of the recurrence; DLMF 5.11.1.
fn gamma_phase(t: f64) -> f64 {
    let im = 0.5 * t;
    let steps: f64 = (0..10).map(|k| im.atan2(0.5 + f64::from(k))).sum();
    let re = 10.5;
    // Im of (z − ½) ln z − z + Σ B_2k / (2k (2k−1) z^{2k−1})
    let (modulus, angle) = (f64::hypot(re, im), im.atan2(re));
    let mut phase = (re - 0.5) * angle + im * modulus.ln() - im;
    let coefficients = [
        1.0 / 12.0,
        -1.0 / 360.0,
        1.0 / 1260.0,
        -1.0 / 1680.0,
        1.0 / 1188.0,
    ];
    for (k, b) in coefficients.into_iter().enumerate() {
        let power = 2 * k as i32 + 1;
        phase -= b * modulus.powi(-power) * (f64::from(power) * angle).sin();
    }
    phase - steps
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By mpmath, 30 digits.
    #[test]
    fn gamma_phase_matches_high_precision() {
        for (t, expected) in [
            (1.0, -0.750_729_202_122_050_7),
            (4.0, -0.592_536_981_977_034_6),
            (40.0, 39.916_729_108_473_33),
        ] {
            let value = gamma_phase(t);
            assert!(
                (value - expected).abs() < 1e-14 * expected.abs().max(1.0),
                "{t}: {value}"
            );
        }
    }
}
