//! The quarter space at one wavenumber, and its cells.

mod operator;

use std::f64::consts::PI;

use ndarray::{Array1, Array2};
use spec_math::cephes64::k0;

use super::VANISHED;
use super::reduction::Reduction;
use crate::numerics::dense::Factors;
use crate::numerics::quadrature::Rule;

/// What the face adds at ξ under pressure from 0 to `end`, with the mirror image.
fn added(reduction: &Reduction, xi: f64, end: f64) -> f64 {
    let modes = &reduction.displacement;
    let [mut at, mut load] = [Array1::zeros(modes.count()), Array1::zeros(modes.count())];
    modes.add(xi, 1.0, &mut at);
    modes.add_integrals(end, 1.0, &mut load);
    at.dot(&load)
}

/// ∫ K0(|ξ−η|) dη from a to b, on intervals that halve towards ξ.
fn potential(xi: f64, [a, b]: [f64; 2]) -> f64 {
    let rule = Rule::gauss_legendre(12);
    if xi < a - 2.0 * (b - a) || xi > b + 2.0 * (b - a) {
        return rule.around(0.5 * (a + b), 0.5 * (b - a), |eta| k0((eta - xi).abs()));
    }
    let mut cuts = vec![a, b, xi];
    let span = (b - a).max((xi - a).abs()).max((b - xi).abs());
    for halving in 0..40 {
        let distance = span * 0.5_f64.powi(halving);
        cuts.extend([xi - distance, xi + distance]);
    }
    cuts.retain(|cut| *cut >= a && *cut <= b);
    cuts.sort_by(f64::total_cmp);
    let parts = cuts.windows(2).map(|pair| {
        let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
        rule.around(middle, half, |eta| k0((eta - xi).abs().max(1e-300)))
    });
    parts.sum()
}

/// Pressure cos ky on all x ≥ 0: u k G/(1−ν) at kx, by Nyström's method on panels from 1e-14 on, to 3e-9. Here the
/// panels begin at 1e-11, and end at 45.
#[test]
fn waves_along_the_end() {
    let reference = [
        (0.0, [(0.05, 1.0), (0.5, 1.0), (2.0, 1.0)]),
        (0.3, [(0.05, 1.220_957_396_7), (0.5, 1.120_291_750_4), (2.0, 1.016_493_582_8)]),
        (0.5, [(0.05, 1.643_250_694_9), (0.5, 1.382_950_631_4), (2.0, 1.071_528_488_2)]),
    ];
    for (poisson, values) in reference {
        let reduction = Reduction::of(poisson);
        for (xi, expected) in values {
            // The load and its image are a wave on all x, for which u = 1.
            let found = 1.0 + added(&reduction, xi, VANISHED) / PI;
            assert!((found - expected).abs() < 1e-6, "{poisson} {xi}: {found} {expected}");
        }
    }
    let edge = 1.0 + added(&Reduction::of(0.5), 0.0, VANISHED) / PI;
    let exact = PI * PI / (PI * PI - 4.0);
    assert!((edge / exact - 1.0).abs() < 1e-5, "{edge} {exact}");
}

/// The strip 0 ≤ kx ≤ 1, against finite elements, whose error is 1e-7 at the edge and 1e-8 on the strip.
#[test]
fn strips_against_finite_elements() {
    let reference = [
        (0.0, [(0.0, 0.858_413_35), (0.4, 0.771_561_23), (1.0, 0.462_382_95)]),
        (0.3, [(0.0, 1.033_744_93), (0.4, 0.872_408_97), (1.0, 0.507_385_13)]),
        (0.45, [(0.0, 1.232_675_4), (0.4, 0.999_786_3), (1.0, 0.573_558_04)]),
    ];
    for (poisson, values) in reference {
        let reduction = Reduction::of(poisson);
        for (xi, expected) in values {
            let images = potential(xi, [0.0, 1.0]) + potential(xi, [-1.0, 0.0]);
            let found = (images + added(&reduction, xi, 1.0)) / PI;
            assert!((found - expected).abs() < 1e-5, "{poisson} {xi}: {found} {expected}");
        }
    }
}

/// Pressure of a sharp end on a wider body of the same material at one wavenumber, as x^−s: cot πs =
/// sin πs/(2[cos²(πs/2) − (1−s)²]) has s = 0.2259869 for any ν. It is fitted between kx = 1e-6 and 1e-3,
/// where the next term of the pressure still changes it by 2e-4.
#[test]
fn the_exponent_of_a_sharp_end() {
    const RATIO: f64 = 1.1;
    for poisson in [0.0, 0.3] {
        let reduction = Reduction::of(poisson);
        let mut edges = vec![0.0, 1e-9];
        while edges[edges.len() - 1] < 6.0 {
            edges.push(edges[edges.len() - 1] * RATIO);
        }
        let n = edges.len() - 1;
        let middle = |i: usize| {
            if i == 0 { 0.5 * edges[1] } else { (edges[i] * edges[i + 1]).sqrt() }
        };
        let modes = &reduction.displacement;
        let mut means = Array2::zeros((n, modes.count()));
        let mut values = Array2::zeros((n, modes.count()));
        for i in 0..n {
            let (mut mean, mut value) =
                (Array1::zeros(modes.count()), Array1::zeros(modes.count()));
            modes.add_integrals(edges[i + 1], 1.0, &mut mean);
            modes.add_integrals(edges[i], -1.0, &mut mean);
            modes.add(middle(i), 1.0, &mut value);
            means.row_mut(i).assign(&mean);
            values.row_mut(i).assign(&value);
        }
        let mut matrix = values.dot(&means.t());
        for i in 0..n {
            for j in 0..n {
                let cell = [edges[j], edges[j + 1]];
                let image = [-edges[j + 1], -edges[j]];
                matrix[[i, j]] += 2.0 * potential(middle(i), cell) + potential(middle(i), image);
            }
        }
        let pressure = Factors::new(matrix).solve(Array2::ones((n, 1)));
        let at = |x: f64| (0..n).find(|&i| edges[i + 1] > x).unwrap_or(0);
        let [near, far] = [at(1e-6), at(1e-3)];
        let slope =
            (pressure[[far, 0]] / pressure[[near, 0]]).ln() / (middle(far) / middle(near)).ln();
        assert!((slope + 0.225_987).abs() < 1e-3, "{poisson}: {slope}");
    }
}
