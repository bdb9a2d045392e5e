//! Integrals over a cell of kernels of the distance from a point.
//!
//! - Far from the cell: Gauss quadrature over it.
//! - Near a long thin cell: Gauss quadrature across it, and along it with x = s sinh u beside the cell,
//!   x = e^v ahead of it, where s is the distance from the cell's line.
//! - On the cell and next to it: the sum over the four corners, with their signs, of
//!
//! ```text
//! ∫₀^x ∫₀^y H(r) a(φ) dy dx = x ∫ η(x cosh u) a du + y ∫ η(y cosh u) a du      r η(r) = ∫₀^r H r' dr'
//! ```
//!
//!   with tan φ = sinh u, and its inverse in the second. This holds however thin a layer is.

use crate::numerics::quadrature::Rule;

/// Rules for an integrand that is analytic up to some distance from the interval.
#[derive(Debug)]
pub(crate) struct Rules {
    /// Each rule with the distance, in half-intervals, from which on it serves.
    rules: [(f64, Rule); 6],
}

/// Nearest singularity, in half-intervals, for which there is a rule.
const NEAREST_RULED: f64 = 2.0;

impl Rules {
    /// Rules for displacements. With a singularity at q half-intervals from it, n points leave an error
    /// of the order of (q + √(q² + 1))^{−2n}: for 1/r, some 1e-12 at these bounds.
    pub(crate) fn displacement() -> Self {
        Self::from_bounds([400.0, 40.0, 16.0, 8.0, 5.0])
    }

    /// Rules for stresses: errors of some 1e-9.
    pub(crate) fn stress() -> Self {
        Self::from_bounds([60.0, 13.0, 6.5, 4.2, 2.9])
    }

    /// Rules of 2, 3, 4, 5 and 7 points for singularities from `bounds` on, and of 11 points nearer.
    fn from_bounds([two, three, four, five, seven]: [f64; 5]) -> Self {
        let numbers = [(two, 2), (three, 3), (four, 4), (five, 5), (seven, 7), (NEAREST_RULED, 11)];
        Self { rules: numbers.map(|(bound, n)| (bound, Rule::gauss_legendre(n))) }
    }

    /// The rule for a singularity at `q` half-intervals; none where that is nearer than any rule serves.
    pub(crate) fn at(&self, q: f64) -> Option<&Rule> {
        self.rules.iter().find(|(bound, _)| q >= *bound).map(|(_, rule)| rule)
    }
}

/// How a kernel is integrated over cells.
#[derive(Debug)]
pub(crate) struct CellRules {
    rules: Rules,
    /// For panels of length 1 in u and v.
    panel: Rule,
}

/// Distance to the rules, over the true one. Kernels of layered bodies have their singularities in a
/// sector beside the imaginary axis, so that they are nearer to the interval than the point r = 0 is.
/// Chosen by trial.
const SECTOR: f64 = 0.7;

/// Number of points on a panel: 1/r integrated in u leaves 3e-12 at most.
const PANEL_POINTS: usize = 10;

impl CellRules {
    pub(crate) fn new(rules: Rules) -> Self {
        Self { rules, panel: Rule::gauss_legendre(PANEL_POINTS) }
    }

    /// The rules for single intervals.
    pub(crate) fn rules(&self) -> &Rules {
        &self.rules
    }

    /// The rule for panels of length 1.
    pub(crate) fn panel(&self) -> &Rule {
        &self.panel
    }

    /// Whether a plane is so deep that no cell of half side `half` is near.
    pub(crate) fn all_far(&self, depth: f64, half: f64) -> bool {
        self.rules.at(SECTOR * depth / half).is_some()
    }

    /// Calls `node(weight, x, y)` with the points of a quadrature over a cell of half sides (a, b), seen
    /// from (x, y) relative to its centre and at `depth`. Returns false, without a call, where the cell
    /// is near: its [`CellRules::corners`] are to be taken.
    #[inline]
    pub(crate) fn nodes(
        &self,
        [x, y]: [f64; 2],
        [a, b]: [f64; 2],
        depth: f64,
        mut node: impl FnMut(f64, f64, f64),
    ) -> bool {
        let outside = [(x.abs() - a).max(0.0), (y.abs() - b).max(0.0), depth];
        let distance = SECTOR * outside.iter().map(|d| d * d).sum::<f64>().sqrt();
        let rule = |half: f64| self.rules.at(distance / half);
        match (rule(a), rule(b)) {
            (Some(along), Some(across)) => {
                for (x, wx) in along.nodes(x, a) {
                    for (y, wy) in across.nodes(y, b) {
                        node(wx * wy, x, y);
                    }
                }
            }
            (None, Some(across)) => {
                for (y, wy) in across.nodes(y, b) {
                    self.strip(x - a, x + a, y.hypot(depth), |x, wx| node(wx * wy, x, y));
                }
            }
            (Some(along), None) => {
                for (x, wx) in along.nodes(x, a) {
                    self.strip(y - b, y + b, x.hypot(depth), |y, wy| node(wx * wy, x, y));
                }
            }
            (None, None) => return false,
        }
        true
    }

    /// Calls `node(x, weight)` with the points of a quadrature from x1 to x2 of a function that varies
    /// over √(x² + s²).
    fn strip(&self, x1: f64, x2: f64, s: f64, mut node: impl FnMut(f64, f64)) {
        if x1 > s {
            for (v, weight) in self.panel.panels(x1.ln(), x2.ln()) {
                let x = v.exp();
                node(x, x * weight);
            }
        } else if x2 < -s {
            for (v, weight) in self.panel.panels((-x2).ln(), (-x1).ln()) {
                let x = v.exp();
                node(-x, x * weight);
            }
        } else {
            let ends = [x1, x2].map(|x| (x / s).asinh());
            for (u, weight) in self.panel.panels(ends[0], ends[1]) {
                node(s * u.sinh(), s * u.cosh() * weight);
            }
        }
    }

    /// Calls `node(weight, r, (cos φ, sin φ))` with the points of the sum over the corners.
    pub(crate) fn corners(
        &self,
        [x, y]: [f64; 2],
        [a, b]: [f64; 2],
        mut node: impl FnMut(f64, f64, [f64; 2]),
    ) {
        for (sign, x, y) in
            [(1.0, x + a, y + b), (-1.0, x - a, y + b), (-1.0, x + a, y - b), (1.0, x - a, y - b)]
        {
            let (sx, sy) = (x.signum(), y.signum());
            let (x, y) = (x.abs(), y.abs());
            for (near, far, first) in [(x, y, true), (y, x, false)] {
                // A corner on the axis itself.
                if near <= f64::MIN_POSITIVE {
                    continue;
                }
                for (u, weight) in self.panel.panels(0.0, (far / near).asinh()) {
                    let cosh = u.cosh();
                    let (cos, sin) = (1.0 / cosh, u.tanh());
                    let (cos, sin) = if first { (cos, sin) } else { (sin, cos) };
                    let weight = sign * sx * sy * near * weight;
                    node(weight, near * cosh, [sx * cos, sy * sin]);
                }
            }
        }
    }
}
