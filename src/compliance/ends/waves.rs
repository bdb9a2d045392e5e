//! Integrals over the wavenumber along y, from smooth amplitudes to functions of the distance.
//!
//! ```text
//! F(y) = ∫₀^∞ f(k) w(k) cos ky dk        w = 1,  sin(ka)/ka,  or [sin(ka)/ka]²
//! ```
//!
//! w is the transform of a load, or of a load and a mean, over the width 2a. f is given at Gauss points of panels
//! that double, so that its polynomial on each is integrated exactly, by spherical Bessel functions, however
//! fast cos ky and w oscillate: Filon's method, with Legendre's polynomials.
//!
//! On a grid that repeats with the period Y, the sum over all images y + mY is one over the waves of the period,
//!
//! ```text
//! Σ_m F(y + mY) = π/Y Σ_n f(k_n) w(k_n) cos k_n y        k_n = 2π|n|/Y
//! ```
//!
//! in which the same polynomials stand for f where many waves are in a panel.

use std::f64::consts::PI;

use crate::compliance::convolution;
use crate::model::grid::Grid;
use crate::numerics::quadrature::Rule;
use crate::numerics::special::{legendre, spherical_bessel};

/// Points of a panel.
const POINTS: usize = 10;

/// Panels below the first octave, each longer than the next by a factor of 30: f is a logarithm there, and the
/// product with k vanishes.
const LOW_PANELS: i32 = 5;
const LOW_RATIO: f64 = 30.0;

/// Half-width times wavenumber below which a load's transform is smooth on a panel.
const NARROW: f64 = 1.0;

/// Waves of a period that are taken one by one, before the panels.
const SINGLE: usize = 16;

/// Distances along y at which coefficients of a grid are needed.
#[derive(Debug)]
pub(super) struct Along {
    pub(super) distances: Vec<f64>,
    /// Width of a cell.
    pub(super) spacing: f64,
    /// Number of cells of the transform, which is that of the period where the grid repeats.
    pub(super) length: usize,
    pub(super) repeats: bool,
}

impl Along {
    pub(super) fn of(grid: &Grid) -> Self {
        let (spacing, repeats) = (grid.spacing()[1], grid.is_periodic()[1]);
        let length = convolution::length(grid.shape()[1], repeats);
        Self {
            distances: (0..=length / 2).map(|l| l as f64 * spacing).collect(),
            spacing,
            length,
            repeats,
        }
    }

    /// Largest distance, to the far edge of the cell.
    pub(super) fn farthest(&self) -> f64 {
        (self.length / 2 + 1) as f64 * self.spacing
    }

    /// Waves for means over cells of loads on cells, and amplitudes that vanish above `highest`: up to distances of
    /// `reach`, or where the grid repeats those of the period, of which the shares of `zeroth` wavenumbers stand for
    /// the first.
    pub(super) fn waves(&self, reach: f64, highest: f64, zeroth: &[(f64, f64)]) -> WaveRule {
        let width = Width::LoadAndMean(0.5 * self.spacing);
        if self.repeats {
            WaveRule::repeated(self.length, self.spacing, width, highest, zeroth)
        } else {
            WaveRule::new(&self.distances, width, reach, highest)
        }
    }
}

/// A transform w.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Width {
    /// Load or displacement at a line.
    #[cfg(test)]
    None,
    /// Load over 2a.
    Load(f64),
    /// Load and mean over 2a.
    LoadAndMean(f64),
}

/// Wavenumbers at which f is needed, with their weights for each distance.
#[derive(Debug)]
pub(super) struct WaveRule {
    pub(super) wavenumbers: Vec<f64>,
    /// Weights: for each wavenumber those of all distances.
    pub(super) weights: Vec<Vec<f64>>,
}

impl WaveRule {
    /// Wavenumbers for distances |y| up to `reach`, and amplitudes f that vanish above `highest`.
    pub(super) fn new(distances: &[f64], width: Width, reach: f64, highest: f64) -> Self {
        let rule = Rule::gauss_legendre(POINTS);
        let mut waves = Self { wavenumbers: Vec::new(), weights: Vec::new() };
        let lowest = 1.0 / reach;
        for panel in (0..LOW_PANELS).rev() {
            let half = 0.5 * LOW_RATIO.ln();
            let middle = lowest.ln() - half * f64::from(2 * panel + 1);
            for (u, w) in rule.nodes(middle, half) {
                let k = u.exp();
                waves.wavenumbers.push(k);
                let factor = w * k * width.transform(k);
                let weight = |y: &f64| factor * (k * y).cos();
                waves.weights.push(distances.iter().map(weight).collect());
            }
        }
        let mut start = lowest;
        while start < highest {
            waves.add_octave(&rule, start, distances, width);
            start *= 2.0;
        }
        waves
    }

    /// Waves of a period of so many `cells` of width `spacing`, for distances of whole cells up to half of it.
    fn repeated(
        cells: usize,
        spacing: f64,
        width: Width,
        highest: f64,
        zeroth: &[(f64, f64)],
    ) -> Self {
        let (step, distances) = (2.0 * PI / (cells as f64 * spacing), cells / 2 + 1);
        let cosines: Vec<f64> =
            (0..cells).map(|l| (2.0 * PI * l as f64 / cells as f64).cos()).collect();
        let column = |n: usize, factor: f64| {
            let places = (0..distances).map(|l| n % cells * l % cells);
            places.map(|at| factor * cosines[at]).collect::<Vec<f64>>()
        };
        let mut waves = Self {
            wavenumbers: zeroth.iter().map(|(k, _)| *k).collect(),
            weights: (zeroth.iter().map(|(_, share)| column(0, 0.5 * share * step))).collect(),
        };
        for n in 1..SINGLE {
            let k = n as f64 * step;
            waves.wavenumbers.push(k);
            waves.weights.push(column(n, step * width.transform(k)));
        }
        let rule = Rule::gauss_legendre(POINTS);
        let points: Vec<(f64, f64)> = rule.nodes(0.0, 1.0).collect();
        let polynomials: Vec<[f64; POINTS]> =
            points.iter().map(|(t, w)| weighted_legendre(*t, *w)).collect();
        let mut start = SINGLE;
        while (start as f64) * step < highest {
            let (middle, half) = (1.5 * start as f64 - 0.5, 0.5 * start as f64);
            let mut weights = vec![vec![0.0; distances]; POINTS];
            for n in start..2 * start {
                let at = weighted_legendre((n as f64 - middle) / half, 1.0);
                let transform = step * width.transform(n as f64 * step);
                let cosines = column(n, transform);
                for (polynomial, weights) in polynomials.iter().zip(&mut weights) {
                    // Lagrange's polynomial of the point, ½ Σ (2n + 1) w P_n(t) P_n
                    let terms = polynomial.iter().zip(at).enumerate();
                    let factor: f64 = terms.map(|(m, (p, at))| p * at / (4 * m + 2) as f64).sum();
                    let sums = weights.iter_mut().zip(&cosines);
                    sums.for_each(|(sum, cosine)| *sum += factor * cosine);
                }
            }
            let wavenumbers = points.iter().map(|(t, _)| (middle + half * t) * step);
            waves.wavenumbers.extend(wavenumbers);
            waves.weights.extend(weights);
            start *= 2;
        }
        waves
    }

    fn add_octave(&mut self, rule: &Rule, start: f64, distances: &[f64], width: Width) {
        let (middle, half) = (1.5 * start, 0.5 * start);
        let points: Vec<(f64, f64)> = rule.nodes(0.0, 1.0).collect();
        let panel = WavePanel {
            middle,
            half,
            polynomials: points.iter().map(|(t, w)| weighted_legendre(*t, *w)).collect(),
        };
        let first = self.weights.len();
        for (t, _) in &points {
            self.wavenumbers.push(middle + half * t);
            self.weights.push(Vec::with_capacity(distances.len()));
        }
        let wavenumbers = self.wavenumbers[first..].to_vec();
        for y in distances {
            let weights: [f64; POINTS] = match width {
                Width::Load(a) if a * start > NARROW => {
                    // sin ka cos ky = [sin k(a+y) + sin k(a−y)]/2
                    let [near, far] = [panel.moments(a - y), panel.moments(a + y)];
                    std::array::from_fn(|q| 0.5 * (near[q][1] + far[q][1]) / (a * wavenumbers[q]))
                }
                Width::LoadAndMean(a) if a * start > NARROW => {
                    // sin² ka cos ky = [2 cos ky − cos k(y+2a) − cos k(y−2a)]/4
                    let [at, near, far] =
                        [0.0, -2.0, 2.0].map(|shift| panel.moments(y + shift * a));
                    std::array::from_fn(|q| {
                        let sum = 2.0 * at[q][0] - near[q][0] - far[q][0];
                        0.25 * sum / (a * wavenumbers[q]).powi(2)
                    })
                }
                _ => {
                    let at = panel.moments(*y);
                    std::array::from_fn(|q| at[q][0] * width.transform(wavenumbers[q]))
                }
            };
            for (column, weight) in self.weights[first..].iter_mut().zip(weights) {
                column.push(weight);
            }
        }
    }
}

impl Width {
    fn transform(self, k: f64) -> f64 {
        let ratio = |a: f64| match k * a {
            small if small < 1e-4 => 1.0 - small * small / 6.0,
            x => x.sin() / x,
        };
        match self {
            #[cfg(test)]
            Self::None => 1.0,
            Self::Load(a) => ratio(a),
            Self::LoadAndMean(a) => ratio(a).powi(2),
        }
    }
}

/// Wavenumbers middle ± half.
struct WavePanel {
    middle: f64,
    half: f64,
    /// (2n + 1) w P_n at each point.
    polynomials: Vec<[f64; POINTS]>,
}

impl WavePanel {
    /// Weights of the points in the integrals of f cos ky and f sin ky.
    fn moments(&self, y: f64) -> [[f64; 2]; POINTS] {
        let mut bessel = [0.0; POINTS];
        spherical_bessel((self.half * y).abs(), &mut bessel);
        let (sine, cosine) = (self.middle * y.abs()).sin_cos();
        let sign = y.signum();
        std::array::from_fn(|q| {
            let mut sums = [0.0; 2];
            for (n, (polynomial, j)) in self.polynomials[q].iter().zip(bessel).enumerate() {
                // Real and imaginary part of iⁿ exp(i k y)
                let [re, im] = match n % 4 {
                    0 => [cosine, sine],
                    1 => [-sine, cosine],
                    2 => [-cosine, -sine],
                    _ => [sine, -cosine],
                };
                sums[0] += polynomial * j * re;
                sums[1] += polynomial * j * im;
            }
            [self.half * sums[0], sign * self.half * sums[1]]
        })
    }
}

/// (2n + 1) w P_n(t)
fn weighted_legendre(t: f64, w: f64) -> [f64; POINTS] {
    let mut polynomials = legendre(t);
    std::array::from_fn(|n| (2.0 * n as f64 + 1.0) * w * polynomials.next().unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::{WaveRule, Width};

    /// ∫ e^{−ck} cos ky dk = c/(c²+y²), and its means over the width of a load.
    #[test]
    fn exponentials_are_transformed_in_closed_form() {
        let (c, a) = (0.05, 0.4);
        let atan = |y: f64| (y / c).atan();
        let log = |y: f64| y * (y / c).atan() - 0.5 * c * (1.0 + (y / c).powi(2)).ln();
        let distances = [0.0, 0.3, 0.8, 5.6, 40.0];
        for width in [Width::None, Width::Load(a), Width::LoadAndMean(a)] {
            let waves = WaveRule::new(&distances, width, 41.0, 40.0 / c);
            for (i, y) in distances.into_iter().enumerate() {
                let terms = waves.wavenumbers.iter().zip(&waves.weights);
                let integral: f64 = terms.map(|(k, w)| (-c * k).exp() * w[i]).sum();
                let expected = match width {
                    Width::None => c / (c * c + y * y),
                    Width::Load(a) => (atan(y + a) - atan(y - a)) / (2.0 * a),
                    Width::LoadAndMean(a) => {
                        (log(y + 2.0 * a) - 2.0 * log(y) + log(y - 2.0 * a)) / (4.0 * a * a)
                    }
                };
                assert!((integral - expected).abs() < 1e-7, "{width:?} {y}: {integral} {expected}");
            }
        }
    }
}
