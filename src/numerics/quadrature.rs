//! Gauss–Legendre quadrature.

use std::f64::consts::PI;
use std::sync::OnceLock;

use super::special::legendre_pair;

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
                let [before, p] = legendre_pair(n, x);
                slope = n as f64 * (x * p - before) / (x * x - 1.0);
                x -= p / slope;
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        };
        Self((0..n).map(node).collect())
    }

    /// The rule of `n` points, computed once; the largest that is kept serves beyond.
    pub(crate) fn kept(n: usize) -> &'static Self {
        static RULES: [OnceLock<Rule>; 1024] = [const { OnceLock::new() }; 1024];
        let n = n.clamp(1, RULES.len() - 1);
        RULES[n].get_or_init(|| Self::gauss_legendre(n))
    }

    /// ∫ f over \[middle − half, middle + half\], which keeps the digits of a short interval.
    pub(crate) fn around(&self, middle: f64, half: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
        half * self.0.iter().map(|&(x, w)| w * f(middle + half * x)).sum::<f64>()
    }

    /// The nodes and weights on \[middle − half, middle + half\].
    pub(crate) fn nodes(&self, middle: f64, half: f64) -> impl Iterator<Item = (f64, f64)> {
        self.0.iter().map(move |&(x, w)| (middle + half * x, half * w))
    }

    /// The nodes and weights on \[a, b\], in panels of length 1 at most.
    pub(crate) fn panels(&self, a: f64, b: f64) -> impl Iterator<Item = (f64, f64)> {
        let count = (b - a).ceil().max(1.0);
        let half = 0.5 * (b - a) / count;
        (0..count as usize).flat_map(move |k| self.nodes(a + (2 * k + 1) as f64 * half, half))
    }

    /// ∫ f over \[a, b\], in panels of length 1 at most.
    pub(crate) fn over_panels(&self, a: f64, b: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
        self.panels(a, b).map(|(x, weight)| weight * f(x)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rule_of_n_points_is_exact_to_degree_2n_minus_1() {
        for n in [2, 3, 5, 8, 11] {
            let rule = Rule::gauss_legendre(n);
            for degree in 0..2 * n {
                let exact = if degree % 2 == 0 { 2.0 / (degree as f64 + 1.0) } else { 0.0 };
                let sum = rule.around(0.0, 1.0, |x| x.powi(degree as i32));
                assert!((sum - exact).abs() < 1e-14, "n {n}, degree {degree}: {sum} {exact}");
            }
            let beyond = rule.around(0.0, 1.0, |x| x.powi(2 * n as i32));
            assert!((beyond - 2.0 / (2.0 * n as f64 + 1.0)).abs() > 1e-8);
        }
    }
}
