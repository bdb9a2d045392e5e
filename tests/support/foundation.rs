//! Elastic foundations as bodies, and their closed forms.

use nacre::response::{Asymptotes, Response};

/// Springs of stiffness k \[Pa/m\], joined by a shear layer G \[N/m\] (Pasternak) or free (Winkler):
/// p = k w − G ∇²w.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Foundation {
    pub(crate) stiffness: f64,
    pub(crate) shear: f64,
}

impl Foundation {
    /// The length ℓ = √(G/k) over which a load spreads.
    pub(crate) fn length(&self) -> f64 {
        (self.shear / self.stiffness).sqrt()
    }
}

impl Response for Foundation {
    fn normal(&self, alpha: f64) -> f64 {
        if self.shear > 0.0 { alpha / (self.stiffness + self.shear * alpha * alpha) } else { 0.0 }
    }

    fn asymptotes(&self) -> Asymptotes {
        Asymptotes {
            long: 0.0,
            constant: if self.shear > 0.0 { 1.0 / self.stiffness } else { 0.0 },
            short: 0.0,
        }
    }

    fn lengths(&self) -> Option<[f64; 2]> {
        (self.shear > 0.0).then(|| [self.length(); 2])
    }

    fn local(&self) -> f64 {
        if self.shear > 0.0 { 0.0 } else { 1.0 / self.stiffness }
    }
}

/// K0 and K1: ∫₀^∞ e^{−x cosh t} {1, cosh t} dt, DLMF 10.32.9, by the trapezoidal rule, which converges
/// exponentially here.
pub(crate) fn bessel_k(x: f64) -> [f64; 2] {
    const STEP: f64 = 0.02;
    let mut sums = [0.5 * (-x).exp(); 2];
    let mut t: f64 = STEP;
    while x * t.cosh() < x + 45.0 {
        let weight = (-x * t.cosh()).exp();
        sums[0] += weight;
        sums[1] += weight * t.cosh();
        t += STEP;
    }
    sums.map(|sum| sum * STEP)
}
