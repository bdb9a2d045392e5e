//! Transforms of even and odd sequences by cosine and sine transforms of half the length.
//!
//! A sequence of M = 2N points is even or odd, with the values f_j at 0 ≤ j ≤ N and f_N = 0. Then
//!
//! ```text
//! even: y_j = ½ (f_j + f_{N−j}) − sin(πj/N) (f_j − f_{N−j})
//!       C_2k = Re Y_k    C_{2k+1} = C_{2k−1} − Im Y_k
//! odd:  y_j = ½ (f_j − f_{N−j}) + sin(πj/N) (f_j + f_{N−j})
//!       S_2k = −Im Y_k   S_{2k+1} = S_{2k−1} + Re Y_k
//! ```
//!
//! where Y is the transform of y over N points, C_1 = ½ f_0 + Σ f_j cos(πj/N) and S_1 = ½ Y_0. The
//! transform of the full sequence is 2C where it is even, and −2i S where it is odd. Press et al.,
//! Numerical Recipes, 3rd ed., Cambridge University Press (2007), §12.4.

use rustfft::num_complex::Complex64;

/// sin and cos of πj/N, 0 < j < N.
pub(super) struct Angles {
    pub(super) sin: Vec<f64>,
    pub(super) cos: Vec<f64>,
}

/// Computes y of the module's formula from f for W sequences together, where `line(j)` has the entries j of all, and hands
/// over the entries of y. Returns C_1 of even sequences, or 0 of odd ones. The entries j and N − j have the same sine and
/// are computed together.
fn fold_lines<'a, const W: usize>(
    line: impl Fn(usize) -> &'a [f64; W],
    odd: bool,
    angles: &Angles,
    mut write: impl FnMut(usize, [f64; W]),
) -> [f64; W] {
    let length = angles.sin.len() + 1;
    let mut c1 = [0.0; W];
    for j in 1..length.div_ceil(2) {
        let (a, b) = (line(j), line(length - j));
        let (sin, cos) = (angles.sin[j - 1], angles.cos[j - 1]);
        let (mut low, mut high) = ([0.0; W], [0.0; W]);
        if odd {
            for k in 0..W {
                let (half, sum) = (0.5 * (a[k] - b[k]), (a[k] + b[k]) * sin);
                (low[k], high[k]) = (sum + half, sum - half);
            }
        } else {
            for k in 0..W {
                let (half, difference) = (0.5 * (a[k] + b[k]), a[k] - b[k]);
                let turned = difference * sin;
                (low[k], high[k]) = (half - turned, half + turned);
                c1[k] += difference * cos;
            }
        }
        write(j, low);
        write(length - j, high);
    }
    // For even N, the entry j = N/2 has no partner; its sine is 1 and its cosine 0.
    if length.is_multiple_of(2) {
        let middle = if odd { 2.0 } else { 1.0 };
        write(length / 2, line(length / 2).map(|value| middle * value));
    }
    if odd {
        write(0, [0.0; W]);
    } else {
        let top = line(0).map(|value| 0.5 * value);
        write(0, top);
        for (c1, top) in c1.iter_mut().zip(top) {
            *c1 += top;
        }
    }
    c1
}

/// [`fold_lines`] for one sequence.
pub(super) fn fold(f: &[f64], odd: bool, angles: &Angles, y: &mut [f64]) -> f64 {
    let (f, _) = f.as_chunks::<1>();
    let [c1] = fold_lines(|j| &f[j], odd, angles, |j, [value]| y[j] = value);
    c1
}

/// [`fold_lines`] for columns, of which two form one complex sequence of `y`; as many pairs are computed as fit into it.
pub(super) fn fold_pairs<'a, const W: usize>(
    line: impl Fn(usize) -> &'a [f64; W],
    odd: bool,
    angles: &Angles,
    y: &mut [Complex64],
) -> [f64; W] {
    let length = angles.sin.len() + 1;
    fold_lines(line, odd, angles, |j, values| {
        let (pairs, _) = values.as_chunks::<2>();
        for (y, [one, other]) in y[j..].iter_mut().step_by(length).zip(pairs) {
            *y = Complex64::new(*one, *other);
        }
    })
}

/// Computes the transform of the full sequence from Y at 0 … N/2; for an odd sequence without the
/// factor −i.
pub(super) fn unfold(y: &[Complex64], odd: bool, c1: f64, values: &mut [f64]) {
    if odd {
        unfold_with(y, -y[0].re, values, |y| (2.0 * y.im, -2.0 * y.re));
    } else {
        unfold_with(y, 2.0 * c1, values, |y| (2.0 * y.re, -2.0 * y.im));
    }
}

/// Computes `values` from the term 1, `c1`, C_1, and from `terms`, which gives the term 2k and the
/// difference of the terms 2k + 1 and 2k − 1.
fn unfold_with(
    y: &[Complex64],
    c1: f64,
    values: &mut [f64],
    terms: impl Fn(Complex64) -> (f64, f64),
) {
    let mut last = c1;
    (values[0], values[1]) = (terms(y[0]).0, last);
    let (twos, rest) = values[2..].as_chunks_mut::<2>();
    for (two, y) in twos.iter_mut().zip(&y[1..]) {
        let (even, step) = terms(*y);
        last += step;
        *two = [even, last];
    }
    if let ([end], Some(y)) = (rest, y.get(1 + twos.len())) {
        *end = terms(*y).0;
    }
}

/// Computes the transforms of two full sequences, as [`unfold`] does. `y` at 0 … N − 1 is Y of the first
/// sequence plus i times Y of the second.
pub(super) fn unfold_pair(
    y: &[Complex64],
    odd: bool,
    c1: Complex64,
    one: &mut [f64],
    other: &mut [f64],
) {
    // 2 Y of the first sequence is y + y*, and 2 Y of the second −i (y − y*), where y* is y mirrored
    // and conjugated. With m mirrored but not conjugated, the real parts of both, as one complex
    // number, are y + m, and the imaginary parts −i (y − m).
    let real = |y: Complex64, m: Complex64| y + m;
    let imaginary = |y: Complex64, m: Complex64| Complex64::new(y.im - m.im, m.re - y.re);
    if odd {
        unfold_pair_with(y, -y[0], one, other, |y, m| (imaginary(y, m), -real(y, m)));
    } else {
        let c1 = 2.0 * c1;
        unfold_pair_with(y, c1, one, other, |y, m| (real(y, m), -imaginary(y, m)));
    }
}

fn unfold_pair_with(
    y: &[Complex64],
    c1: Complex64,
    one: &mut [f64],
    other: &mut [f64],
    terms: impl Fn(Complex64, Complex64) -> (Complex64, Complex64),
) {
    let mut last = c1;
    let even = terms(y[0], y[0]).0;
    (one[0], one[1]) = (even.re, last.re);
    (other[0], other[1]) = (even.im, last.im);
    let (ones, one) = one[2..].as_chunks_mut::<2>();
    let (others, other) = other[2..].as_chunks_mut::<2>();
    let mirrored = y[1..].iter().zip(y[1..].iter().rev());
    let middle = 1 + ones.len();
    for ((one, other), (y, m)) in ones.iter_mut().zip(others).zip(mirrored) {
        let (even, step) = terms(*y, *m);
        last += step;
        *one = [even.re, last.re];
        *other = [even.im, last.im];
    }
    if let ([one], [other]) = (one, other) {
        let y = y[middle];
        let even = terms(y, y).0;
        (*one, *other) = (even.re, even.im);
    }
}
