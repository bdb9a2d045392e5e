//! Functions in which a contact is expanded, with their cosine transforms.

use std::f64::consts::FRAC_PI_2;

use crate::numerics::parallel::Lanes;
use crate::numerics::quadrature::Rule;
use crate::numerics::rounding;
use crate::numerics::special::{legendre, legendre_pair, spherical_bessel};

/// Contact radius, in thicknesses of the top layer, up to which values at nodes are cheaper than polynomials.
const NODAL: f64 = 40.0;

/// Nodes of each panel of the projection of a profile on polynomials, beyond their number.
const MORE: usize = 24;

/// Polynomials of a profile with singularities, beyond those of a smooth one: what they leave of the profile meets what they leave of
/// the smooth solution of a flat punch.
const FINER: f64 = 8.0;

/// Place at which panels end, since the profile is not smooth there or near.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::indent) struct Break {
    pub(in crate::indent) at: f64,
    /// Whether the profile has roots of the distance from it beyond, as behind a kink.
    pub(in crate::indent) has_root: bool,
}

/// Part of the contact on which the profile is smooth.
#[derive(Debug, Clone, Copy)]
pub(in crate::indent) struct Panel {
    pub(in crate::indent) low: f64,
    pub(in crate::indent) high: f64,
    /// Whether the profile has roots of the distance from the lower end, as behind a kink.
    pub(in crate::indent) has_root: bool,
}

impl Panel {
    /// Panels from `low` to `high` that end at the breaks; a break at `low` itself has its roots in the first panel.
    pub(in crate::indent) fn between(low: f64, breaks: &[Break], high: f64) -> Vec<Self> {
        let at_low = |b: &Break| b.has_root && (b.at - low).abs() <= 0.0;
        let mut start = Break { at: low, has_root: breaks.iter().any(at_low) };
        let inside = breaks.iter().filter(|b| b.at > low && b.at < high);
        let end = Break { at: high, has_root: false };
        let mut panels = Vec::new();
        for stop in inside.chain(std::iter::once(&end)) {
            panels.push(Self { low: start.at, high: stop.at, has_root: start.has_root });
            start = *stop;
        }
        panels
    }

    /// Nodes and weights; a root is taken away by squares.
    pub(in crate::indent) fn nodes(self, rule: &Rule) -> Vec<(f64, f64)> {
        let length = self.high - self.low;
        match self.has_root {
            false => rule.nodes(0.5 * (self.low + self.high), 0.5 * length).collect(),
            true => {
                let place = |(v, w): (f64, f64)| (self.low + length * v * v, 2.0 * length * v * w);
                rule.nodes(0.5, 0.5).map(place).collect()
            }
        }
    }
}

/// Orthonormal functions on \[0, a\].
#[derive(Debug, Clone)]
pub(in crate::indent) struct Basis {
    radius: f64,
    functions: Functions,
    /// Nodes of the projection on polynomials; none where values at nodes serve.
    projection: Vec<(f64, f64)>,
}

#[derive(Debug, Clone)]
enum Functions {
    /// Values at nodes times the roots of their weights (Nyström's method).
    Nodes(Vec<(f64, f64)>),
    /// This number of Legendre polynomials (Galerkin's method).
    Polynomials(usize),
}

impl Basis {
    /// Functions for the contact radius `a` on a top layer of this `thickness`; the profile has `breaks`, if it is not smooth, and
    /// `finer` raises their number.
    ///
    /// The response of layers is smooth over some thickness of the top layer: eight nodes and two for each thickness in the
    /// radius, from three thicknesses on 4.3 for each, leave 1e-10 at all contrasts; found by trial. Polynomials cluster at the edge, where the pressure varies over a thickness: 34 + 10 √(a/h).
    ///
    /// A profile that is not smooth is projected on polynomials on panels of its own, and has the values of these at the nodes: all
    /// its products with smooth functions stay exact, whatever the polynomials leave of it.
    pub(in crate::indent) fn new(
        a: f64,
        thickness: Option<f64>,
        breaks: Option<&[Break]>,
        finer: f64,
    ) -> Self {
        let ratio = thickness.map_or(0.0, |h| a / h);
        let is_nodal = ratio <= NODAL;
        let count = match is_nodal {
            true => (8.0 + 2.0 * ratio).max(1.0 + 4.3 * ratio),
            false => 34.0 + 10.0 * ratio.sqrt(),
        };
        let more = if breaks.is_some() { FINER } else { 0.0 };
        let count = (finer * (count + more)).ceil() as usize;
        let functions = match is_nodal {
            true => Functions::Nodes(Rule::kept(count).nodes(0.5 * a, 0.5 * a).collect()),
            false => Functions::Polynomials(count),
        };
        let projection = match is_nodal && breaks.is_none() {
            true => vec![],
            false => Panel::between(0.0, breaks.unwrap_or(&[]), a)
                .into_iter()
                .flat_map(|panel| panel.nodes(Rule::kept(count + MORE)))
                .collect(),
        };
        Self { radius: a, functions, projection }
    }

    /// Number of functions.
    pub(in crate::indent) fn len(&self) -> usize {
        match &self.functions {
            Functions::Nodes(nodes) => nodes.len(),
            Functions::Polynomials(count) => *count,
        }
    }

    /// Places at which [`Basis::project`] needs a function.
    pub(in crate::indent) fn places(&self) -> Vec<f64> {
        let nodes = match &self.functions {
            Functions::Nodes(nodes) if self.projection.is_empty() => nodes,
            _ => &self.projection,
        };
        nodes.iter().map(|(s, _)| *s).collect()
    }

    /// ∫ f bᵢ for each function, of the values of f at [`Basis::places`].
    pub(in crate::indent) fn project(&self, values: &[f64]) -> Vec<f64> {
        if let Functions::Nodes(nodes) = &self.functions
            && self.projection.is_empty()
        {
            let pairs = nodes.iter().zip(values);
            return pairs.map(|((_, w), f)| w.sqrt() * f).collect();
        }
        let mut sums = vec![0.0; self.len()];
        let mut own = sums.clone();
        for ((s, w), f) in self.projection.iter().zip(values) {
            orthonormal(2.0 * s / self.radius - 1.0, self.radius, &mut own);
            let pairs = sums.iter_mut().zip(&own);
            pairs.for_each(|(sum, p)| *sum += w * f * p);
        }
        let Functions::Nodes(nodes) = &self.functions else {
            return sums;
        };
        let value = |(s, w): &(f64, f64)| {
            orthonormal(2.0 * s / self.radius - 1.0, self.radius, &mut own);
            w.sqrt() * own.iter().zip(&sums).map(|(p, sum)| p * sum).sum::<f64>()
        };
        nodes.iter().map(value).collect()
    }

    /// Transforms b̂ᵢ(α) = ∫ bᵢ(t) cos αt dt at all waves, one row for each function.
    pub(in crate::indent) fn transforms(&self, waves: &Waves) -> Vec<Vec<f64>> {
        match &self.functions {
            Functions::Nodes(nodes) => {
                let mut sin = vec![0.0; waves.len()];
                let row = |(s, w): &(f64, f64)| {
                    let mut cos = vec![0.0; waves.len()];
                    waves.circular(*s, &mut cos, &mut sin);
                    let root = w.sqrt();
                    cos.iter_mut().for_each(|c| *c *= root);
                    cos
                };
                nodes.iter().map(row).collect()
            }
            Functions::Polynomials(count) => {
                let mut rows = vec![vec![0.0; waves.len()]; *count];
                let half = 0.5 * self.radius;
                let mut bessel = vec![0.0; *count];
                for (q, alpha) in waves.alpha.iter().enumerate() {
                    spherical_bessel(alpha * half, &mut bessel);
                    // cos(αa/2 + kπ/2) repeats every four.
                    let phase =
                        [0, 1, 2, 3].map(|k| (alpha * half + f64::from(k) * FRAC_PI_2).cos());
                    for (k, (row, j)) in rows.iter_mut().zip(&bessel).enumerate() {
                        let scale = ((2 * k + 1) as f64 * self.radius).sqrt();
                        row[q] = scale * j * phase[k % 4];
                    }
                }
                rows
            }
        }
    }
}

/// Orthonormal Legendre polynomials on an interval of this `length` at x from −1 to 1, into `out`.
fn orthonormal(x: f64, length: f64, out: &mut [f64]) {
    for ((k, value), p) in out.iter_mut().enumerate().zip(legendre(x)) {
        *value = p * ((2.0 * k as f64 + 1.0) / length).sqrt();
    }
}

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
        let halvings = rounding::round((width / top).log2()) as usize;
        let panels = rounding::ceil(TAIL / thickness / width) as usize;
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

#[cfg(test)]
mod tests {
    use super::Basis;
    use crate::indent::equation::basis::Waves;
    use crate::numerics::quadrature::Rule;

    /// Transforms of polynomials equal their quadrature.
    #[test]
    fn transforms_of_polynomials() {
        let a = 1.5;
        let basis = Basis::new(a, Some(0.02), None, 1.0);
        let waves = Waves::plan(1.0, 3.0, 1.0, |alpha| (-alpha).exp());
        let rows = basis.transforms(&waves);
        let rule = Rule::gauss_legendre(40);
        for (q, alpha) in waves.alpha.iter().enumerate().step_by(17) {
            let x = |t: f64| 2.0 * t / a - 1.0;
            let second = |t: f64| (5.0 / a).sqrt() * 0.5 * (3.0 * x(t).powi(2) - 1.0);
            let first = |t: f64| (3.0 / a).sqrt() * x(t);
            let due = [
                rule.around(0.75, 0.75, |t| second(t) * (alpha * t).cos()),
                rule.around(0.75, 0.75, |t| first(t) * (alpha * t).cos()),
            ];
            for (transform, due) in [rows[2][q], rows[1][q]].iter().zip(due) {
                assert!((transform - due).abs() < 1e-13, "{alpha}: {transform} {due}");
            }
        }
    }
}
