//! Functions in which a contact is expanded, with their cosine transforms.

use std::f64::consts::FRAC_PI_2;
use std::sync::OnceLock;

use super::waves::Waves;
use crate::kernel::quadrature::Rule;

/// Contact radius, in thicknesses of the top layer, up to which values at nodes are cheaper than polynomials.
const NODAL: f64 = 40.0;

/// Nodes where the profile is no polynomial at the axis: they leave 1e-12 of s^1.3, whose square root they take.
const ROOTED: f64 = 24.0;

/// Nodes of the projection of a profile on polynomials, beyond their number.
const MORE: usize = 24;

/// Rules of Gauss and Legendre that have been asked for; the largest serves beyond.
static RULES: [OnceLock<Rule>; 1024] = [const { OnceLock::new() }; 1024];

/// The rule of `count` nodes, computed once.
pub(in crate::indent) fn rule(count: usize) -> &'static Rule {
    let count = count.clamp(1, RULES.len() - 1);
    RULES[count].get_or_init(|| Rule::gauss_legendre(count))
}

/// Part of the contact on which the profile has no kink.
#[derive(Debug, Clone, Copy)]
pub(in crate::indent) struct Panel {
    pub(in crate::indent) low: f64,
    pub(in crate::indent) high: f64,
    /// Whether the profile has roots of the distance from the lower end, as beyond a kink.
    pub(in crate::indent) has_root: bool,
}

impl Panel {
    /// Panels from `low` to `high` that end at the kinks; a kink at `low` itself has its roots in the first panel.
    pub(in crate::indent) fn between(low: f64, kinks: &[f64], high: f64) -> Vec<Self> {
        let inside = kinks.iter().copied().filter(|b| *b > low && *b < high);
        let mut panels = Vec::new();
        let (mut start, mut has_root) =
            (low, kinks.first().is_some_and(|b| (b - low).abs() <= 0.0));
        for end in inside.chain(std::iter::once(high)) {
            panels.push(Self {
                low: start,
                high: end,
                has_root,
            });
            (start, has_root) = (end, true);
        }
        panels
    }

    /// Nodes and weights; a root is taken away by squares.
    pub(in crate::indent) fn nodes(self, rule: &Rule) -> Vec<(f64, f64)> {
        let length = self.high - self.low;
        match self.has_root {
            false => rule
                .nodes(0.5 * (self.low + self.high), 0.5 * length)
                .collect(),
            true => {
                let place = |(v, w): (f64, f64)| (self.low + length * v * v, 2.0 * length * v * w);
                rule.nodes(0.5, 0.5).map(place).collect()
            }
        }
    }
}

/// Orthonormal functions on \[0, a\].
#[derive(Debug, Clone)]
pub(in crate::indent) enum Basis {
    /// Values at nodes times the roots of their weights (Nyström's method).
    Nodes(Vec<(f64, f64)>),
    /// Legendre polynomials on panels (Galerkin's method): each panel and the number of its polynomials.
    Polynomials(Vec<(Panel, usize)>),
}

impl Basis {
    /// Functions for the contact radius `a` on a top layer of this `thickness`, with kinks of the profile; `finer` raises
    /// their number.
    ///
    /// The response of layers is smooth over some thickness of the top layer: eight nodes and two for each thickness in the
    /// radius, from three thicknesses on 4.3 for each, leave 1e-10 at all contrasts; found by trial. Polynomials cluster at the edge, where the pressure varies over a thickness: 34 + 10 √(a/h).
    pub(in crate::indent) fn new(
        a: f64,
        thickness: Option<f64>,
        kinks: &[f64],
        finer: f64,
    ) -> Self {
        let ratio = thickness.map_or(0.0, |h| a / h);
        let panels = Panel::between(0.0, kinks, a);
        if ratio <= NODAL {
            let count = (8.0 + 2.0 * ratio).max(1.0 + 4.3 * ratio);
            let rooted = if panels[0].has_root { ROOTED } else { 0.0 };
            let count = (finer * count.max(rooted)).ceil() as usize;
            let nodes = panels
                .into_iter()
                .flat_map(|panel| panel.nodes(rule(count)));
            return Self::Nodes(nodes.collect());
        }
        let count = (finer * (34.0 + 10.0 * ratio.sqrt())).ceil() as usize;
        Self::Polynomials(panels.into_iter().map(|panel| (panel, count)).collect())
    }

    /// Number of functions.
    pub(in crate::indent) fn len(&self) -> usize {
        match self {
            Self::Nodes(nodes) => nodes.len(),
            Self::Polynomials(panels) => panels.iter().map(|(_, count)| count).sum(),
        }
    }

    /// Places at which [`Basis::project`] needs a function.
    pub(in crate::indent) fn places(&self) -> Vec<f64> {
        match self {
            Self::Nodes(nodes) => nodes.iter().map(|(s, _)| *s).collect(),
            Self::Polynomials(panels) => panels
                .iter()
                .flat_map(|(panel, count)| panel.nodes(rule(count + MORE)))
                .map(|(s, _)| s)
                .collect(),
        }
    }

    /// ∫ f bᵢ for each function, of the values of f at [`Basis::places`].
    pub(in crate::indent) fn project(&self, values: &[f64]) -> Vec<f64> {
        match self {
            Self::Nodes(nodes) => nodes
                .iter()
                .zip(values)
                .map(|((_, w), f)| w.sqrt() * f)
                .collect(),
            Self::Polynomials(panels) => {
                let mut all = Vec::new();
                let mut values = values.iter();
                for (panel, count) in panels {
                    let mut sums = vec![0.0; *count];
                    let length = panel.high - panel.low;
                    for ((s, w), f) in panel
                        .nodes(&Rule::gauss_legendre(count + MORE))
                        .into_iter()
                        .zip(&mut values)
                    {
                        let x = 2.0 * (s - panel.low) / length - 1.0;
                        let (mut p, mut before) = (1.0, 0.0);
                        for (k, sum) in sums.iter_mut().enumerate() {
                            let order = k as f64;
                            *sum += w * f * p * ((2.0 * order + 1.0) / length).sqrt();
                            (p, before) = (
                                ((2.0 * order + 1.0) * x * p - order * before) / (order + 1.0),
                                p,
                            );
                        }
                    }
                    all.extend(sums);
                }
                all
            }
        }
    }

    /// Transforms b̂ᵢ(α) = ∫ bᵢ(t) cos αt dt at all waves, one row for each function.
    pub(in crate::indent) fn transforms(&self, waves: &Waves) -> Vec<Vec<f64>> {
        match self {
            Self::Nodes(nodes) => {
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
            Self::Polynomials(panels) => {
                let mut rows = vec![vec![0.0; waves.len()]; self.len()];
                let mut first = 0;
                for (panel, count) in panels {
                    let (middle, half) = (
                        0.5 * (panel.low + panel.high),
                        0.5 * (panel.high - panel.low),
                    );
                    let mut bessel = vec![0.0; *count];
                    for (q, alpha) in waves.alpha.iter().enumerate() {
                        spherical_bessel(alpha * half, &mut bessel);
                        // cos(αc + kπ/2) repeats every four.
                        let phase =
                            (0..4).map(|k| (alpha * middle + f64::from(k) * FRAC_PI_2).cos());
                        let phase: Vec<f64> = phase.collect();
                        for (k, j) in bessel.iter().enumerate() {
                            let scale = ((2 * k + 1) as f64 * 2.0 * half).sqrt();
                            rows[first + k][q] = scale * j * phase[k % 4];
                        }
                    }
                    first += count;
                }
                rows
            }
        }
    }
}

/// Spherical Bessel functions j_k(y) for k from 0, into `out`: upwards where y exceeds the order, and downwards from where
/// they vanish elsewhere (Miller's algorithm; Abramowitz & Stegun (1964), §10.5).
fn spherical_bessel(y: f64, out: &mut [f64]) {
    let count = out.len();
    if y < 1e-8 {
        out.fill(0.0);
        out[0] = 1.0;
        if count > 1 {
            out[1] = y / 3.0;
        }
        return;
    }
    let zeroth = y.sin() / y;
    let first = (zeroth - y.cos()) / y;
    if y >= count as f64 {
        let (mut below, mut here) = (zeroth, first);
        for (k, value) in out.iter_mut().enumerate() {
            *value = below;
            let next = (2 * k + 3) as f64 / y * here - below;
            (below, here) = (here, next);
        }
        return;
    }
    let start = count + 20 + (60.0 * count as f64).sqrt() as usize;
    let (mut above, mut here) = (0.0, 1e-200);
    for k in (0..start).rev() {
        let below = (2 * k + 3) as f64 / y * here - above;
        (above, here) = (here, below);
        if k < count {
            out[k] = here;
        }
        if here.abs() > 1e200 {
            above *= 1e-200;
            here *= 1e-200;
            out.iter_mut().for_each(|value| *value *= 1e-200);
        }
    }
    // The larger of the first two gives the scale.
    let scale = match zeroth.abs() > first.abs() || count == 1 {
        true => zeroth / out[0],
        false => first / out[1],
    };
    out.iter_mut().for_each(|value| *value *= scale);
}

#[cfg(test)]
mod tests {
    use super::{Basis, Panel, spherical_bessel};
    use crate::indent::equation::waves::Waves;
    use crate::kernel::quadrature::Rule;

    /// Recurrence and the sum Σ (2k+1) j_k² = 1 (Abramowitz & Stegun, 10.1.50), below, at and above the orders.
    #[test]
    fn spherical_bessel_functions() {
        let mut j = vec![0.0; 120];
        for y in [1e-9, 1e-3, 0.7, 20.0, 60.0] {
            spherical_bessel(y, &mut j);
            let sum: f64 = j
                .iter()
                .enumerate()
                .map(|(k, j)| (2 * k + 1) as f64 * j * j)
                .sum();
            assert!((sum - 1.0).abs() < 1e-13, "{y}: {sum}");
            assert!((j[0] - if y > 0.0 { y.sin() / y } else { 1.0 }).abs() < 1e-15);
        }
        // j_2 = (3/y² − 1) sin y/y − 3 cos y/y².
        for y in [3.0, 130.0, 500.0_f64] {
            spherical_bessel(y, &mut j);
            let due = (3.0 / (y * y) - 1.0) * y.sin() / y - 3.0 * y.cos() / (y * y);
            assert!((j[2] - due).abs() < 1e-15, "{y}: {} {due}", j[2]);
        }
    }

    /// Transforms of polynomials equal their quadrature.
    #[test]
    fn transforms_of_polynomials() {
        let panel = |low, high| Panel {
            low,
            high,
            has_root: false,
        };
        let basis = Basis::Polynomials(vec![(panel(0.0, 0.7), 4), (panel(0.7, 1.5), 3)]);
        let waves = Waves::plan(1.0, 3.0, 1.0, |alpha| (-alpha).exp());
        let rows = basis.transforms(&waves);
        let rule = Rule::gauss_legendre(40);
        for (q, alpha) in waves.alpha.iter().enumerate().step_by(17) {
            // b_2 of the first panel and b_1 of the second.
            let x = |t: f64| 2.0 * t / 0.7 - 1.0;
            let second = |t: f64| (5.0_f64 / 0.7).sqrt() * 0.5 * (3.0 * x(t).powi(2) - 1.0);
            let first = |t: f64| (3.0_f64 / 0.8).sqrt() * (2.0 * (t - 0.7) / 0.8 - 1.0);
            let due = [
                rule.around(0.35, 0.35, |t| second(t) * (alpha * t).cos()),
                rule.around(1.1, 0.4, |t| first(t) * (alpha * t).cos()),
            ];
            for (found, due) in [rows[2][q], rows[5][q]].iter().zip(due) {
                assert!((found - due).abs() < 1e-13, "{alpha}: {found} {due}");
            }
        }
    }
}
