//! Curves through stations: slopes of smooth ones, pieces, and smoothing of noise.

use std::f64::consts::PI;

use crate::numerics::dense::eliminate;

/// A cubic between two stations, given by values and slopes at both; straight where the slopes are that of the chord.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Piece {
    pub(super) ends: [f64; 2],
    values: [f64; 2],
    slopes: [f64; 2],
}

impl Piece {
    /// The pieces through stations `x` with these `values`, two at least, and `slopes` in each piece.
    pub(super) fn between(
        x: &[f64],
        values: &[f64],
        slopes: impl Iterator<Item = [f64; 2]>,
    ) -> Vec<Self> {
        let pairs = x.windows(2).zip(values.windows(2)).zip(slopes);
        let piece = |((x, values), slopes): ((&[f64], &[f64]), [f64; 2])| Self {
            ends: [x[0], x[1]],
            values: [values[0], values[1]],
            slopes,
        };
        pairs.map(piece).collect()
    }

    /// Value at x.
    pub(super) fn at(&self, x: f64) -> f64 {
        let h = self.ends[1] - self.ends[0];
        let t = ((x - self.ends[0]) / h).clamp(0.0, 1.0);
        let rest = 1.0 - t;
        let [v0, v1] = self.values;
        let [s0, s1] = self.slopes.map(|slope| slope * h);
        // The chord, and what the slopes differ from it.
        let chord = v1 - v0;
        v0 + chord * t + t * rest * ((s0 - chord) * rest - (s1 - chord) * t)
    }

    /// Integral from a to b, within the piece, by Gauss's rule of two points, which is exact.
    pub(super) fn integral(&self, a: f64, b: f64) -> f64 {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let beside = half / 3.0_f64.sqrt();
        half * (self.at(middle - beside) + self.at(middle + beside))
    }
}

/// Slopes of the chords.
pub(super) fn chords(x: &[f64], values: &[f64]) -> Vec<f64> {
    let pairs = x.windows(2).zip(values.windows(2));
    pairs.map(|(x, v)| (v[1] - v[0]) / (x[1] - x[0])).collect()
}

/// Slopes at the stations, two at least, of the cubic spline through them: the one whose third derivative does not jump at
/// the second and at the last but one station; the parabola through three, and the chord of two.
pub(super) fn spline(x: &[f64], values: &[f64]) -> Vec<f64> {
    let chords = chords(x, values);
    let h: Vec<f64> = x.windows(2).map(|x| x[1] - x[0]).collect();
    let n = x.len();
    if n == 2 {
        return vec![chords[0]; 2];
    }
    let bend = |k: usize| (chords[k] - chords[k - 1]) / (h[k] + h[k - 1]);
    if n == 3 {
        let bend = bend(1);
        return vec![chords[0] - bend * h[0], chords[0] + bend * h[0], chords[1] + bend * h[1]];
    }
    // h_k s_{k−1} + 2 (h_{k−1} + h_k) s_k + h_{k−1} s_{k+1} = 3 (h_k c_{k−1} + h_{k−1} c_k), and at the ends de Boor, A
    // Practical Guide to Splines (2001), chapter IV. Rows are `before`, `own`, `after`, `right`.
    let end = |h0: f64, h1: f64, c0: f64, c1: f64| {
        let both = h0 + h1;
        ([h1, both], ((h0 + 2.0 * both) * h1 * c0 + h0 * h0 * c1) / both)
    };
    let ([own, after], right) = end(h[0], h[1], chords[0], chords[1]);
    let mut rows = vec![[own, after, right]];
    for k in 1..n - 1 {
        let right = 3.0 * (h[k] * chords[k - 1] + h[k - 1] * chords[k]);
        let [own, after, before_right] = rows[k - 1];
        let factor = h[k] / own;
        rows.push([
            2.0 * (h[k - 1] + h[k]) - factor * after,
            h[k - 1],
            right - factor * before_right,
        ]);
    }
    let ([own, before], right) = end(h[n - 2], h[n - 3], chords[n - 2], chords[n - 3]);
    let [above, after, above_right] = rows[n - 2];
    let factor = before / above;
    rows.push([own - factor * after, 0.0, right - factor * above_right]);
    let mut slopes = vec![0.0; n];
    for (k, [own, after, right]) in rows.into_iter().enumerate().rev() {
        let next = slopes.get(k + 1).copied().unwrap_or(0.0);
        slopes[k] = (right - after * next) / own;
    }
    slopes
}

/// The number of smaller magnitude where both have one sign, else 0.
fn least(a: f64, b: f64) -> f64 {
    if a * b > 0.0 { a.signum() * a.abs().min(b.abs()) } else { 0.0 }
}

/// Limits `slopes` so that the curve does not swing at steps and edges: it is monotone where the values are, but for what
/// parabolas through neighbouring stations show. Slopes of smooth curves, also at their extrema, stay as they are.
///
/// Huynh, SIAM J. Numer. Anal. 30 (1993) 57, doi:10.1137/0730004, constraint M3.
pub(super) fn limit(x: &[f64], values: &[f64], slopes: &mut [f64]) {
    let n = x.len();
    if n < 4 {
        return;
    }
    let chords = chords(x, values);
    let bend = |k: usize| (chords[k] - chords[k - 1]) / (x[k + 1] - x[k - 1]);
    // Of the parabolas at both ends of a chord, the one that bends less.
    let bends: Vec<f64> = (0..n - 1)
        .map(|k| {
            let k = k.clamp(1, n - 3);
            least(bend(k), bend(k + 1))
        })
        .collect();
    let at_end = |k: usize| chords[k] + bends[k] * (x[k + 1] - x[k]);
    let at_start = |k: usize| chords[k] - bends[k] * (x[k + 1] - x[k]);
    for (k, slope) in slopes.iter_mut().enumerate() {
        let (chord, parabola) = match k {
            0 => (chords[0], at_start(0)),
            k if k == n - 1 => (chords[n - 2], at_end(n - 2)),
            k => (least(chords[k - 1], chords[k]), least(at_end(k - 1), at_start(k))),
        };
        let most = parabola.signum() * (3.0 * chord.abs()).max(1.5 * parabola.abs());
        *slope = least(*slope, if parabola.abs() > 0.0 { most } else { 0.0 });
    }
}

/// Ratio of the width of the weights to the wavelength of which half is left: (1 + u) e^{−u} = ½ at u = π γ².
const WIDTH: f64 = 0.730_9;

/// Weights below this are left out.
const LIGHT: f64 = 1e-9;

/// Values without the waves that are shorter than a `wavelength`, of which half is left: those of the parabolas that fit best
/// around each station, with Gaussian weights. Parabolas stay as they are, also at the ends.
///
/// The regression filter of ISO 16610-31, not robust, of second degree.
pub(super) fn smoothed(x: &[f64], values: &[f64], wavelength: f64) -> Vec<f64> {
    let width = WIDTH * wavelength;
    let n = x.len();
    // The length that a station stands for.
    let share = |k: usize| x[(k + 1).min(n - 1)] - x[k.saturating_sub(1)];
    let at = |k: usize| {
        let weight = |j: usize| {
            let u = (x[j] - x[k]) / width;
            (u, (-PI * u * u).exp() * share(j))
        };
        let heavy = |j: &usize| weight(*j).1 > LIGHT * share(k);
        let first = (0..k).rev().take_while(heavy).last().unwrap_or(k);
        let last = (k + 1..n).take_while(heavy).last().unwrap_or(k);
        if last - first < 2 {
            return values[k];
        }
        let (mut matrix, mut right) = (vec![vec![0.0; 3]; 3], vec![0.0; 3]);
        for j in first..=last {
            let (u, weight) = weight(j);
            let powers = [1.0, u, u * u];
            for (row, a) in powers.into_iter().enumerate() {
                right[row] += weight * a * (values[j] - values[k]);
                for (entry, b) in matrix[row].iter_mut().zip(powers) {
                    *entry += weight * a * b;
                }
            }
        }
        eliminate(&mut matrix, &mut right, |_, _| true);
        values[k] + right[0]
    };
    (0..n).map(at).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::{Piece, limit, smoothed, spline};

    /// Rounding of sums of some products.
    const ROUNDING: f64 = 1e-12;

    fn uneven(n: usize) -> Vec<f64> {
        (0..n).map(|k| k as f64 + 0.3 * (7.0 * k as f64).sin()).collect()
    }

    #[test]
    fn splines_contain_cubics_and_limits_leave_parabolas() {
        let cubic = |x: f64| 1.0 + x * (2.0 + x * (-0.7 + 0.05 * x));
        let slope = |x: f64| 2.0 + x * (-1.4 + 0.15 * x);
        for n in 4..12 {
            let x = uneven(n);
            let values: Vec<f64> = x.iter().map(|x| cubic(*x)).collect();
            for (x, spline_slope) in x.iter().zip(spline(&x, &values)) {
                assert!((spline_slope - slope(*x)).abs() < ROUNDING, "{n}: {spline_slope}");
            }
        }
        for n in 3..12 {
            let x = uneven(n);
            let parabola: Vec<f64> = x.iter().map(|x| (x - 0.4 * n as f64).powi(2)).collect();
            let mut slopes = spline(&x, &parabola);
            limit(&x, &parabola, &mut slopes);
            for (x, slope) in x.iter().zip(slopes) {
                assert!((slope - 2.0 * (x - 0.4 * n as f64)).abs() < ROUNDING, "{n}: {slope}");
            }
        }
    }

    #[test]
    fn limited_curves_do_not_swing_at_steps() {
        let x = uneven(12);
        let steps = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.3, 0.3, 0.3, 0.5, 0.5];
        let mut slopes = spline(&x, &steps);
        let pieces =
            |slopes: &[f64]| Piece::between(&x, &steps, slopes.windows(2).map(|s| [s[0], s[1]]));
        let swing = |slopes: &[f64]| {
            let beyond = |piece: &Piece| {
                let [low, high] =
                    [piece.values[0].min(piece.values[1]), piece.values[0].max(piece.values[1])];
                (0..=40)
                    .map(|k| {
                        let x =
                            piece.ends[0] + f64::from(k) / 40.0 * (piece.ends[1] - piece.ends[0]);
                        (low - piece.at(x)).max(piece.at(x) - high)
                    })
                    .fold(0.0, f64::max)
            };
            pieces(slopes).iter().map(beyond).fold(0.0, f64::max)
        };
        assert!(swing(&slopes) > 0.05);
        limit(&x, &steps, &mut slopes);
        assert!(swing(&slopes) < ROUNDING);
    }

    #[test]
    fn integrals_of_cubics_are_exact() {
        let piece = Piece { ends: [1.0, 3.0], values: [2.0, -1.0], slopes: [0.5, 4.0] };
        // ∫ v = h (v0 + v1)/2 + h² (s0 − s1)/12
        let whole = 1.0 + 4.0 * (0.5 - 4.0) / 12.0;
        assert!((piece.integral(1.0, 3.0) - whole).abs() < ROUNDING);
        let parts = piece.integral(1.0, 1.3) + piece.integral(1.3, 3.0);
        assert!((parts - whole).abs() < ROUNDING);
    }

    #[test]
    fn smoothing_leaves_parabolas_and_half_of_a_wave() {
        let x = uneven(60);
        let parabola: Vec<f64> = x.iter().map(|x| 3.0 + (x - 20.0).powi(2)).collect();
        for (value, smooth) in parabola.iter().zip(smoothed(&x, &parabola, 9.0)) {
            assert!((value - smooth).abs() < 1e-9, "{smooth}");
        }
        let even: Vec<f64> = (0..400).map(|k| 0.1 * f64::from(k)).collect();
        let wave: Vec<f64> = even.iter().map(|x| (2.0 * PI * x / 5.0).cos()).collect();
        let middle = smoothed(&even, &wave, 5.0)[200] / wave[200];
        assert!((middle - 0.5).abs() < 1e-4, "{middle}");
        // Shorter than the stations are apart, it does nothing.
        assert_eq!(smoothed(&even, &wave, 0.02), wave);
    }
}
