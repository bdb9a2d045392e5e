//! Quadrature and differences.

/// The first derivative times the step, of eighth order, of what is known at −4 … 4 steps.
pub(crate) fn slope(at: impl Fn(i32) -> f64) -> f64 {
    let weights = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
    let terms = weights.iter().zip(1..);
    terms.map(|(weight, k)| weight * (at(k) - at(-k))).sum()
}

/// Nodes and weights of Gauss and Legendre's rule of `n` points on \[0, 1\], by Newton's iteration.
pub(crate) fn unit_rule(n: usize) -> Vec<[f64; 2]> {
    let node = |i: usize| {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
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
        [0.5 + 0.5 * x, 1.0 / ((1.0 - x * x) * slope * slope)]
    };
    (0..n).map(node).collect()
}

/// Complete elliptic integrals K and E of modulus k, by the arithmetic-geometric mean (DLMF 19.8).
pub(crate) fn elliptic(k: f64) -> [f64; 2] {
    let (mut a, mut b, mut c) = (1.0, (1.0 - k * k).sqrt(), k);
    let (mut sum, mut power) = (0.5 * k * k, 0.5);
    while c.abs() > 1e-16 {
        (a, b, c) = (0.5 * (a + b), (a * b).sqrt(), 0.5 * (a - b));
        power *= 2.0;
        sum += power * c * c;
    }
    let complete = std::f64::consts::PI / (2.0 * a);
    [complete, complete * (1.0 - sum)]
}
