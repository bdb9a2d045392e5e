//! Wavenumbers at which the response of the bodies is known, and cosines and sines there.

use crate::numerics::parallel::Lanes;
use crate::numerics::quadrature::Rule;
use crate::numerics::special::legendre_pair;

/// Wavenumber, in inverse top layers, from which on the response is that of the top layer: what is left of the rest is
/// some x² e^{−2x} = 3e-12 of it.
const TAIL: f64 = 16.0;

/// Nodes of a panel, a multiple of the lanes.
const NODES: usize = 12;

/// Length of a panel, in inverse top layers, on which twelve nodes resolve polynomials times e^{−2x} to 1e-15.
const WIDEST: f64 = 2.5;

/// Phase of an oscillation over a panel that twelve nodes resolve: the rule leaves 4²⁴ (12!)⁴ 2²⁵/(25 (24!)³) = 1e-16 of
/// cos αx over a phase of 8.
const RESOLVED: f64 = 8.0;

/// Halvings of the first panel towards wavenumber 0 at most.
const MOST_HALVINGS: usize = 40;

/// Last Legendre coefficient of M on a panel, of the largest value of 1 + M, at which it counts as resolved.
const SMOOTH: f64 = 1e-14;

/// Panels after which cosines are computed anew and not by rotation, whose rounding grows.
const ROTATIONS: usize = 64;

/// A quadrature over the wavenumbers: panels that halve towards 0, then panels of equal length.
#[derive(Debug, Clone)]
pub(in crate::indent) struct Waves {
    /// Wavenumbers α \[1/m\].
    pub(in crate::indent) alpha: Vec<f64>,
    /// Weights \[1/m\].
    pub(in crate::indent) weight: Vec<f64>,
    /// Nodes before the panels of equal length.
    graded: usize,
    /// Length of the equal panels \[1/m\].
    width: f64,
}

impl Waves {
    /// Waves for top layers of `thickness` \[m\] and functions that oscillate over lengths up to `length` \[m\] in α;
    /// `excess` is M(α). `finer` divides all panels.
    pub(in crate::indent) fn plan(
        thickness: f64,
        length: f64,
        finer: f64,
        excess: impl Fn(f64) -> f64,
    ) -> Self {
        let width = (WIDEST / thickness).min(RESOLVED / length) / finer;
        let rule = Rule::gauss_legendre(NODES);
        let (mut alpha, mut weight) = (Vec::new(), Vec::new());
        let mut add = |low: f64, high: f64| {
            for (a, w) in rule.nodes(0.5 * (low + high), 0.5 * (high - low)) {
                alpha.push(a);
                weight.push(w);
            }
        };
        // The first panels: M may vary over all scales at long waves.
        let mut top = width;
        for _ in 0..MOST_HALVINGS {
            if is_smooth(&rule, top, &excess) {
                break;
            }
            add(0.5 * top, top);
            top *= 0.5;
        }
        add(0.0, top);
        let halvings = (width / top).log2().round() as usize;
        let panels = (TAIL / thickness / width).ceil() as usize;
        for k in 1..panels {
            add(k as f64 * width, (k + 1) as f64 * width);
        }
        Self { alpha, weight, graded: NODES * (halvings + 1), width }
    }

    /// Number of wavenumbers.
    pub(in crate::indent) fn len(&self) -> usize {
        self.alpha.len()
    }

    /// cos αs at all wavenumbers, into `cos`, and sin αs into `sin`.
    pub(in crate::indent) fn circular(&self, s: f64, cos: &mut [f64], sin: &mut [f64]) {
        let lanes =
            |values: &[f64]| -> Lanes { Lanes::from([values[0], values[1], values[2], values[3]]) };
        let exact = |k: usize, cos: &mut [f64], sin: &mut [f64]| {
            let (y, x) = (lanes(&self.alpha[k..k + 4]) * Lanes::splat(s)).sin_cos();
            cos[k..k + 4].copy_from_slice(&x.to_array());
            sin[k..k + 4].copy_from_slice(&y.to_array());
        };
        // Each of the first panels is twice the one that follows it, but for the last two.
        let doubled = self.graded.saturating_sub(2 * NODES);
        for k in (doubled..self.graded).step_by(4) {
            exact(k, cos, sin);
        }
        for k in (0..doubled).step_by(4).rev() {
            let (x, y) = (lanes(&cos[k + NODES..]), lanes(&sin[k + NODES..]));
            let twice = y + y;
            cos[k..k + 4].copy_from_slice(&(Lanes::ONE - twice * y).to_array());
            sin[k..k + 4].copy_from_slice(&(twice * x).to_array());
        }
        let (turn_y, turn_x) = (self.width * s).sin_cos();
        let [turn_x, turn_y] = [Lanes::splat(turn_x), Lanes::splat(turn_y)];
        let mut start = self.graded;
        while start < self.len() {
            let end = (start + ROTATIONS * NODES).min(self.len());
            for k in (start..start + NODES).step_by(4) {
                exact(k, cos, sin);
                let (mut x, mut y) = (lanes(&cos[k..k + 4]), lanes(&sin[k..k + 4]));
                for place in (k + NODES..end).step_by(NODES) {
                    (x, y) = (x * turn_x - y * turn_y, y * turn_x + x * turn_y);
                    cos[place..place + 4].copy_from_slice(&x.to_array());
                    sin[place..place + 4].copy_from_slice(&y.to_array());
                }
            }
            start = end;
        }
    }
}

/// Whether `excess` on \[0, top\] is a polynomial that the rule resolves: its last two Legendre coefficients vanish.
fn is_smooth(rule: &Rule, top: f64, excess: &impl Fn(f64) -> f64) -> bool {
    let (mut last, mut size) = ([0.0; 2], 0.0_f64);
    for (alpha, w) in rule.nodes(0.5 * top, 0.5 * top) {
        let value = excess(alpha);
        size = size.max((1.0 + value).abs());
        let x = 2.0 * alpha / top - 1.0;
        let [before, p] = legendre_pair(NODES - 1, x);
        // (2k+1)/2 ∫ f P_k over −1 … 1.
        for (sum, (k, p)) in last.iter_mut().zip([(NODES - 1, p), (NODES - 2, before)]) {
            *sum += (k as f64 + 0.5) * (w * 2.0 / top) * value * p;
        }
    }
    last.iter().all(|c| c.abs() <= SMOOTH * size)
}
