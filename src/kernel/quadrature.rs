//! Gauss–Legendre rules on [−1, 1].

use std::f64::consts::PI;

/// Nodes and weights of the rule of n points, exact for polynomials of degree 2n − 1.
#[derive(Debug, Clone)]
pub(crate) struct Rule(Vec<(f64, f64)>);

impl Rule {
    /// Newton's iteration on the Legendre polynomial from Tricomi's guess; Press et al., Numerical
    /// Recipes, 3rd ed., §4.6.1.
    pub(crate) fn gauss_legendre(n: usize) -> Self {
        let node = |i: usize| {
            let mut x = (PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..8 {
                let (mut p, mut before) = (1.0, 0.0);
                for k in 0..n {
                    let k = k as f64;
                    (p, before) = (((2.0 * k + 1.0) * x * p - k * before) / (k + 1.0), p);
                }
                slope = n as f64 * (x * p - before) / (x * x - 1.0);
                x -= p / slope;
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        };
        Self((0..n).map(node).collect())
    }

    /// ∫ f over \[a, b\].
    pub(crate) fn integrate(&self, a: f64, b: f64, f: impl FnMut(f64) -> f64) -> f64 {
        self.around(0.5 * (a + b), 0.5 * (b - a), f)
    }

    /// ∫ f over \[middle − half, middle + half\], which keeps the digits of a short interval.
    pub(crate) fn around(&self, middle: f64, half: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
        half * self
            .0
            .iter()
            .map(|&(x, w)| w * f(middle + half * x))
            .sum::<f64>()
    }

    /// The nodes and weights on \[middle − half, middle + half\].
    pub(crate) fn nodes(&self, middle: f64, half: f64) -> impl Iterator<Item = (f64, f64)> {
        self.0
            .iter()
            .map(move |&(x, w)| (middle + half * x, half * w))
    }

    /// Those on \[a, b\], in panels of length 1 at most.
    pub(crate) fn panels(&self, a: f64, b: f64) -> impl Iterator<Item = (f64, f64)> {
        let count = (b - a).ceil().max(1.0);
        let half = 0.5 * (b - a) / count;
        (0..count as usize).flat_map(move |k| self.nodes(a + (2 * k + 1) as f64 * half, half))
    }

    /// ∫ f over \[a, b\], in panels of length 1 at most.
    pub(crate) fn over_panels(&self, a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
        let count = (b - a).ceil().max(1.0);
        let width = (b - a) / count;
        (0..count as usize)
            .map(|k| {
                let start = a + k as f64 * width;
                self.integrate(start, start + width, &f)
            })
            .sum()
    }
}

/// Rules for an integrand that is analytic up to some distance from the interval.
#[derive(Debug)]
pub(crate) struct Rules {
    rules: [(f64, Rule); 6],
}

impl Rules {
    /// With a singularity at q half-intervals from it, n points leave an error of the order of
    /// (q + √(q² + 1))^{−2n}: for 1/r, some 1e-12 at these bounds.
    pub(crate) fn new() -> Self {
        let rule = |q: f64, n: usize| (q, Rule::gauss_legendre(n));
        Self {
            rules: [
                rule(400.0, 2),
                rule(40.0, 3),
                rule(16.0, 4),
                rule(8.0, 5),
                rule(5.0, 7),
                rule(NEAREST, 11),
            ],
        }
    }

    /// The same for errors of some 1e-9.
    pub(crate) fn coarse() -> Self {
        let rule = |q: f64, n: usize| (q, Rule::gauss_legendre(n));
        Self {
            rules: [
                rule(60.0, 2),
                rule(13.0, 3),
                rule(6.5, 4),
                rule(4.2, 5),
                rule(2.9, 7),
                rule(NEAREST, 11),
            ],
        }
    }

    /// The rule for a singularity at `q` half-intervals; none below [`NEAREST`].
    pub(crate) fn at(&self, q: f64) -> Option<&Rule> {
        self.rules
            .iter()
            .find(|(bound, _)| q >= *bound)
            .map(|(_, rule)| rule)
    }
}

/// The nearest singularity, in half-intervals, for which there is a rule.
pub(crate) const NEAREST: f64 = 2.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rule_of_n_points_is_exact_to_degree_2n_minus_1() {
        for n in [2, 3, 5, 8, 11] {
            let rule = Rule::gauss_legendre(n);
            for degree in 0..2 * n {
                let exact = if degree % 2 == 0 {
                    2.0 / (degree as f64 + 1.0)
                } else {
                    0.0
                };
                let sum = rule.integrate(-1.0, 1.0, |x| x.powi(degree as i32));
                assert!(
                    (sum - exact).abs() < 1e-14,
                    "n {n}, degree {degree}: {sum} {exact}"
                );
            }
            let beyond = rule.integrate(-1.0, 1.0, |x| x.powi(2 * n as i32));
            assert!((beyond - 2.0 / (2.0 * n as f64 + 1.0)).abs() > 1e-8);
        }
    }
}
