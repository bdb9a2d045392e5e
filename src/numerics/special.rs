//! Special functions, orthogonal polynomials, and interpolation from Chebyshev's nodes.

use std::f64::consts::PI;

/// Euler's constant γ, which is in the standard library from Rust 1.94 on.
pub(crate) const EULER_GAMMA: f64 = 0.577_215_664_901_532_9;

/// The Legendre polynomials P_0(x), P_1(x), … without end.
pub(crate) fn legendre(x: f64) -> impl Iterator<Item = f64> {
    let (mut p, mut before) = (1.0, 0.0);
    (0..).map(move |k| {
        let (here, k) = (p, f64::from(k));
        (p, before) = (((2.0 * k + 1.0) * x * p - k * before) / (k + 1.0), p);
        here
    })
}

/// P_{n−1}(x), which is 0 for n = 0, and P_n(x).
pub(crate) fn legendre_pair(n: usize, x: f64) -> [f64; 2] {
    (legendre(x).take(n + 1)).fold([0.0; 2], |[_, before], p| [before, p])
}

/// Chebyshev's polynomials T_0, T_1, … at t.
pub(crate) fn chebyshev<const N: usize>(t: f64) -> [f64; N] {
    let mut values = [1.0; N];
    values[1] = t;
    for n in 2..N {
        values[n] = 2.0 * t * values[n - 1] - values[n - 2];
    }
    values
}

/// Chebyshev's N nodes −cos((k + ½)π/N) on \[−1, 1\], with their barycentric weights.
pub(crate) fn chebyshev_nodes<const N: usize>() -> [[f64; 2]; N] {
    std::array::from_fn(|k| {
        let (sin, cos) = (PI * (k as f64 + 0.5) / N as f64).sin_cos();
        [-cos, if k.is_multiple_of(2) { sin } else { -sin }]
    })
}

/// Weights of the values at `nodes` in the polynomial through them at `x`, from the barycentric weights
/// of the nodes. Berrut & Trefethen, SIAM Rev. 46 (2004) 501, doi:10.1137/S0036144502417715, eq. (4.2).
pub(crate) fn barycentric(nodes: &[[f64; 2]], x: f64) -> Vec<f64> {
    if let Some(at) = nodes.iter().position(|[node, _]| (x - node).abs() < 1e-14) {
        return (0..nodes.len()).map(|k| f64::from(u8::from(k == at))).collect();
    }
    let terms = nodes.iter().map(|[node, weight]| weight / (x - node));
    let sum: f64 = terms.clone().sum();
    terms.map(|term| term / sum).collect()
}

/// Spherical Bessel functions j_k(y) for k from 0, into `out`: upwards where y exceeds the order, and downwards from where
/// they vanish elsewhere (Miller's algorithm; Abramowitz & Stegun (1964), §10.5).
pub(crate) fn spherical_bessel(y: f64, out: &mut [f64]) {
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

/// Carlson's integral of the second kind, for x + y > 0 and z > 0:
///
/// ```text
/// R_D(x, y, z) = 3/2 ∫_0^∞ dt / [(t + x)^{1/2} (t + y)^{1/2} (t + z)^{3/2}]
/// ```
///
/// By duplication, until the arguments differ by so little that a series of the fifth order has all
/// digits. Carlson, Numer. Algorithms 10 (1995) 13, doi:10.1007/BF02198293, algorithm 4.
pub(crate) fn carlson_rd(arguments: [f64; 3]) -> f64 {
    let [mut x, mut y, mut z] = arguments;
    let (mut sum, mut factor) = (0.0, 1.0);
    // The largest relative difference is divided by four each time, after as many steps as the arguments'
    // ratio has powers of four.
    for _ in 0..600 {
        let mean = 0.2 * (x + y + 3.0 * z);
        let spread = (mean - x).abs().max((mean - y).abs()).max((mean - z).abs());
        if spread <= 1.5e-3 * mean {
            break;
        }
        let [rx, ry, rz] = [x.sqrt(), y.sqrt(), z.sqrt()];
        let lambda = rx * ry + ry * rz + rz * rx;
        sum += factor / (rz * (z + lambda));
        factor *= 0.25;
        (x, y, z) = (0.25 * (x + lambda), 0.25 * (y + lambda), 0.25 * (z + lambda));
    }
    let mean = 0.2 * (x + y + 3.0 * z);
    let [dx, dy] = [(mean - x) / mean, (mean - y) / mean];
    let dz = -(dx + dy) / 3.0;
    let e2 = dx * dy - 6.0 * dz * dz;
    let e3 = (3.0 * dx * dy - 8.0 * dz * dz) * dz;
    let e4 = 3.0 * (dx * dy - dz * dz) * dz * dz;
    let e5 = dx * dy * dz * dz * dz;
    let series = 1.0 - 3.0 / 14.0 * e2 + e3 / 6.0 + 9.0 / 88.0 * e2 * e2
        - 3.0 / 22.0 * e4
        - 9.0 / 52.0 * e2 * e3
        + 3.0 / 26.0 * e5;
    3.0 * sum + factor * series / (mean * mean.sqrt())
}

/// Arithmetic-geometric mean of two numbers above 0.
pub(crate) fn arithmetic_geometric_mean(mut a: f64, mut g: f64) -> f64 {
    // The number of digits doubles with each step; the first steps halve the exponent of a/g.
    for _ in 0..64 {
        if (a - g).abs() <= f64::EPSILON * a {
            break;
        }
        (a, g) = (0.5 * (a + g), (a * g).sqrt());
    }
    a
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    fn bessel<const N: usize>(y: f64) -> [f64; N] {
        let mut j = [0.0; N];
        spherical_bessel(y, &mut j);
        j
    }

    /// The sum Σ (2k+1) j_k² = 1 (Abramowitz & Stegun, 10.1.50), below, at and above the orders; j_0, j_2 and j_9 in closed
    /// form or by their series; upward and downward recurrences agree where they meet.
    #[test]
    fn spherical_bessel_functions() {
        for y in [1e-9, 1e-3, 0.7, 20.0, 60.0] {
            let j = bessel::<120>(y);
            let sum: f64 = j.iter().enumerate().map(|(k, j)| (2 * k + 1) as f64 * j * j).sum();
            assert!((sum - 1.0).abs() < 1e-13, "{y}: {sum}");
            assert!((j[0] - y.sin() / y).abs() < 1e-15);
        }
        // j_2 = (3/y² − 1) sin y/y − 3 cos y/y².
        let second = |y: f64| (3.0 / (y * y) - 1.0) * y.sin() / y - 3.0 * y.cos() / (y * y);
        for y in [3.0, 130.0, 500.0_f64] {
            let j = bessel::<120>(y);
            assert!((j[2] - second(y)).abs() < 1e-15, "{y}: {} {}", j[2], second(y));
        }
        for x in [1e-9, 1e-3, 0.3, 3.0, PI, 9.99, 10.01, 50.0] {
            let j = bessel::<10>(x);
            let due = if x < 0.1 { x * x / 15.0 * (1.0 - x * x / 14.0) } else { second(x) };
            let rounding = 1e-13 * (1.0 + 1.0 / x.powi(2)).min(10.0);
            assert!((j[2] - due).abs() < rounding, "{x} {} {due}", j[2]);
        }
        // x⁹/19!! (1 − x²/42 + x⁴/3864 − …) at x = 1.
        let expected = 1.0 / 654_729_075.0 * (1.0 - 1.0 / 42.0 + 1.0 / 3864.0 - 1.0 / 579_600.0);
        assert!((bessel::<10>(1.0)[9] / expected - 1.0).abs() < 1e-6);
        let [below, above] = [10.0 - 1e-9, 10.0 + 1e-9].map(bessel::<10>);
        for (below, above) in below.iter().zip(above) {
            assert!((below - above).abs() < 1e-9, "{below} {above}");
        }
    }

    /// A polynomial of degree N − 1 is what it is between its values at N nodes, and at a node.
    #[test]
    fn polynomials_are_interpolated_exactly() {
        let nodes = chebyshev_nodes::<6>();
        let polynomial = |x: f64| 3.0 * x.powi(5) - x.powi(2) + 0.5;
        for x in [-1.0, -0.3, nodes[2][0], 0.77, 1.0] {
            let terms = nodes.iter().zip(barycentric(&nodes, x));
            let value: f64 = terms.map(|([node, _], w)| w * polynomial(*node)).sum();
            assert!((value - polynomial(x)).abs() < 1e-14, "{x}: {value}");
        }
    }
}
