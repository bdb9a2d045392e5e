//! Terms of which the profiles of tips are sums, and their rates of change with a number.

use std::f64::consts::PI;

use spec_math::cephes64::{gamma, psi};

use crate::error::{Error, Result, require};

/// A term of F(s) = s ∫₀^s g'(r)/√(s²−r²) dr, the indentation at which a bare body is in contact up to s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ProfileTerm {
    /// g = b rⁿ, with rate = b n (√π/2) Γ(n/2)/Γ((n+1)/2): F = rate sⁿ.
    Power { factor: f64, exponent: f64, rate: f64 },
    /// g = R − √(R² − r²): F = s artanh(s/R).
    Sphere { radius: f64 },
    /// The slope g' jumps at r = b: F = slope s arccos(b/s) beyond.
    Step { at: f64, slope: f64 },
    /// The curvature g'' jumps at r = b: F = curvature s [√(s²−b²) − b arccos(b/s)] beyond.
    Hinge { at: f64, curvature: f64 },
    /// g = c r²/2 up to r = b, and with the slope c b beyond: F = c s², and c s [b²/(s + √(s²−b²)) + b arccos(b/s)] beyond.
    Rounded { at: f64, curvature: f64 },
    /// The derivative of `Sphere` with respect to its radius.
    SphereRate { radius: f64 },
    /// The derivative of `Power` with respect to its exponent.
    ExponentRate { exponent: f64, rate: f64 },
    /// The derivative of `Step` with respect to its place.
    PlaceRate { at: f64, slope: f64 },
}

impl ProfileTerm {
    /// g = b rⁿ.
    pub(super) fn power(factor: f64, exponent: f64) -> Self {
        let ratio = gamma(0.5 * exponent) / gamma(0.5 * exponent + 0.5);
        Self::Power { factor, exponent, rate: factor * exponent * 0.5 * PI.sqrt() * ratio }
    }

    /// g = r²/2R, of curvature 1/R.
    pub(super) fn paraboloid(curvature: f64) -> Self {
        Self::Power { factor: 0.5 * curvature, exponent: 2.0, rate: curvature }
    }

    /// Place of a kink, where F has a root of the distance from it.
    pub(super) fn kink(&self) -> Option<f64> {
        match *self {
            Self::Step { at, .. }
            | Self::Hinge { at, .. }
            | Self::Rounded { at, .. }
            | Self::PlaceRate { at, .. } => Some(at),
            _ => None,
        }
    }

    /// The profile g(r) \[m\] of a term that is no rate.
    pub(super) fn gap(&self, r: f64) -> f64 {
        match *self {
            Self::Power { factor, exponent, .. } => factor * r.powf(exponent),
            Self::Sphere { radius } => r * r / (radius + ((radius - r) * (radius + r)).sqrt()),
            Self::Step { at, slope } => slope * (r - at).max(0.0),
            Self::Hinge { at, curvature } => 0.5 * curvature * (r - at).max(0.0).powi(2),
            Self::Rounded { at, curvature } => {
                let inner = r.min(at);
                curvature * inner * (r - 0.5 * inner)
            }
            Self::SphereRate { radius } => {
                // ∂/∂R of R − √(R² − r²).
                1.0 - radius / ((radius - r) * (radius + r)).sqrt()
            }
            Self::ExponentRate { exponent, rate } => {
                let factor = rate / Self::power(1.0, exponent).rate();
                if r > 0.0 { factor * r.powf(exponent) * r.ln() } else { 0.0 }
            }
            Self::PlaceRate { at, slope } if r > at => -slope,
            Self::PlaceRate { .. } => 0.0,
        }
    }

    /// The slope g'(r) of a term that is no rate.
    pub(super) fn slope(&self, r: f64) -> f64 {
        match *self {
            Self::Power { factor, exponent, .. } => factor * exponent * r.powf(exponent - 1.0),
            Self::Sphere { radius } => r / ((radius - r) * (radius + r)).sqrt(),
            Self::Step { at, slope } if r > at => slope,
            Self::Hinge { at, curvature } => curvature * (r - at).max(0.0),
            Self::Rounded { at, curvature } => curvature * r.min(at),
            _ => 0.0,
        }
    }

    fn rate(&self) -> f64 {
        match *self {
            Self::Power { rate, .. } => rate,
            _ => 0.0,
        }
    }

    /// F, dF/ds and d²F/ds² at s.
    pub(super) fn transform(&self, s: f64) -> [f64; 3] {
        match *self {
            Self::Power { exponent, rate, .. } => power(rate, exponent, s),
            Self::Sphere { radius } => {
                let (x, rest) = (s / radius, (radius - s) * (radius + s) / (radius * radius));
                [s * x.atanh(), x.atanh() + x / rest, 2.0 / (radius * rest * rest)]
            }
            Self::SphereRate { radius } => {
                let rest = (radius - s) * (radius + s);
                let r2 = radius * radius;
                [
                    -s * s / rest,
                    -2.0 * s * r2 / (rest * rest),
                    -2.0 * r2 * (r2 + 3.0 * s * s) / (rest * rest * rest),
                ]
            }
            Self::ExponentRate { exponent: n, rate } => {
                if s <= 0.0 {
                    return [0.0; 3];
                }
                let [value, slope, bend] = power(rate, n, s);
                let log = 1.0 / n + s.ln() + 0.5 * (psi(0.5 * n) - psi(0.5 * n + 0.5));
                [
                    value * log,
                    slope * log + value / s,
                    bend * log + 2.0 * slope / s - value / (s * s),
                ]
            }
            Self::Rounded { at, curvature } if s <= at => power(curvature, 2.0, s),
            Self::Step { at, .. } | Self::Hinge { at, .. } | Self::PlaceRate { at, .. }
                if s <= at =>
            {
                [0.0; 3]
            }
            Self::Step { at, slope } => {
                let (root, angle) = beyond(s, at);
                [
                    slope * s * angle,
                    slope * (angle + at / root),
                    slope * (at / (s * root) - at * s / root.powi(3)),
                ]
            }
            Self::Hinge { at, curvature } => {
                let (root, angle) = beyond(s, at);
                let rest = rest(root, angle, at);
                [
                    curvature * s * rest,
                    curvature * (root + rest),
                    curvature * (2.0 * s / root - at * at / (s * root)),
                ]
            }
            Self::Rounded { at, curvature } => {
                let (root, angle) = beyond(s, at);
                let (sum, square) = (s + root, at * at);
                [
                    curvature * s * (square / sum + at * angle),
                    curvature * (2.0 * square / sum + at * angle),
                    -curvature * square * square / (s * root * sum * sum),
                ]
            }
            Self::PlaceRate { at, slope } => {
                let (root, _) = beyond(s, at);
                [
                    -slope * s / root,
                    slope * at * at / root.powi(3),
                    -3.0 * slope * at * at * s / root.powi(5),
                ]
            }
        }
    }
}

/// √(s² − b²) and arccos(b/s).
fn beyond(s: f64, b: f64) -> (f64, f64) {
    let root = ((s - b) * (s + b)).sqrt();
    (root, root.atan2(b))
}

/// √(s² − b²) − b arccos(b/s), b (tan θ − θ) of the angle, without the rounding of a difference where it is small.
fn rest(root: f64, angle: f64, b: f64) -> f64 {
    let square = (root / b) * (root / b);
    if square > 0.01 {
        return root - b * angle;
    }
    // tan θ − θ = x³/3 − x⁵/5 + … of x = tan θ < 0.1; the next term is 1e-16 of the first.
    let series = (0..8).rev().fold(0.0, |sum, k| 1.0 / f64::from(2 * k + 3) - square * sum);
    root * square * series
}

/// rate sⁿ and its two derivatives.
fn power(rate: f64, n: f64, s: f64) -> [f64; 3] {
    let whole = n.round();
    let raised = |k: f64| match (n - whole).abs() > 0.0 || whole > 64.0 {
        true => s.powf(n - k),
        false => s.powi((whole - k) as i32),
    };
    // A factor of 0 stands before a power that may be infinite at s = 0.
    let term = |factor: f64, k: f64| match factor.abs() > 0.0 {
        true => rate * factor * raised(k),
        false => 0.0,
    };
    [term(1.0, 0.0), term(n, 1.0), term(n * (n - 1.0), 2.0)]
}

/// Depths of an area function at which its profile is taken, evenly in their logarithms.
const SAMPLES: usize = 600;

/// Shallowest of these depths, in the deepest.
const SHALLOWEST: f64 = 1e-9;

/// Terms of the profile whose slope g' is linear between the places `r`, from (0, slope) on: each piece adds a hinge. The
/// profile continues with the last curvature.
fn hinges(r: &[f64], slopes: &[f64]) -> Vec<ProfileTerm> {
    let mut terms = vec![ProfileTerm::power(slopes[0], 1.0)];
    let mut last = 0.0;
    for k in 0..r.len() - 1 {
        let curvature = (slopes[k + 1] - slopes[k]) / (r[k + 1] - r[k]);
        terms.push(match k {
            0 => ProfileTerm::paraboloid(curvature),
            _ => ProfileTerm::Hinge { at: r[k], curvature: curvature - last },
        });
        last = curvature;
    }
    terms
}

/// Terms of the profile through the samples g(r), which begin on the axis at 0. Its slope is linear between the midpoints
/// of the samples, and 0 on the axis.
pub(super) fn profile(r: &[f64], g: &[f64]) -> Result<Vec<ProfileTerm>> {
    if r.len() != g.len() || r.len() < 3 {
        return Err(Error::Shape {
            name: "profile",
            expected: [r.len().max(3), 2],
            found: [g.len(), 2],
        });
    }
    for (name, values) in [("profile radii", r), ("profile heights", g)] {
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            return Err(Error::NonFinite { name, index: [index, 0] });
        }
        let requirement = "0 at the first sample, which lies on the axis";
        require(name, values[0], values[0].abs() <= 0.0, requirement)?;
    }
    if let Some(k) = (1..r.len()).find(|&k| r[k] <= r[k - 1]) {
        require("profile radii", r[k], false, "ascending")?;
    }
    let middles = (1..r.len()).map(|k| 0.5 * (r[k] + r[k - 1]));
    let slopes = (1..r.len()).map(|k| (g[k] - g[k - 1]) / (r[k] - r[k - 1]));
    let middles: Vec<f64> = std::iter::once(0.0).chain(middles).collect();
    let slopes: Vec<f64> = std::iter::once(0.0).chain(slopes).collect();
    Ok(hinges(&middles, &slopes))
}

/// Area A(d) = Σ C_k d^(2^(1−k)) at the distance d from the end, and dA/dd; Oliver & Pharr, J. Mater. Res. 7 (1992) 1564, eq. (21),
/// doi:10.1557/JMR.1992.1564.
fn area(coefficients: &[f64], depth: f64) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for (k, c) in coefficients.iter().enumerate() {
        let exponent = 2.0_f64.powi(1 - k as i32);
        let value = c * depth.powf(exponent);
        sums[0] += value;
        sums[1] += exponent * value / depth;
    }
    sums
}

/// Terms of the tip whose section at the distance d from its end has the area A(d), up to the deepest `depth`.
pub(super) fn area_function(coefficients: &[f64], depth: f64) -> Result<Vec<ProfileTerm>> {
    if let Some(index) = coefficients.iter().position(|c| !c.is_finite()) {
        return Err(Error::NonFinite { name: "area coefficients", index: [index, 0] });
    }
    let (mut r, mut slopes) = (vec![0.0], vec![0.0]);
    for k in 0..SAMPLES {
        let d = depth * SHALLOWEST.powf(1.0 - (k + 1) as f64 / SAMPLES as f64);
        let [area, growth] = area(coefficients, d);
        let requirement = "above 0 and ascending at all depths up to the deepest; here is the depth where it is not";
        let ascends = area > 0.0 && growth > 0.0 && !coefficients.is_empty();
        require("area function", d, ascends, requirement)?;
        // π r² = A(g): g' = 2πr/A'.
        let radius = (area / PI).sqrt();
        if radius > r[r.len() - 1] * (1.0 + 1e-9) {
            r.push(radius);
            slopes.push(2.0 * PI * radius / growth);
        }
    }
    // The slope on the axis is that of the first sample where the tip is sharp there.
    if let [_, first, second, ..] = slopes[..]
        && (first / second - 1.0).abs() < 0.1
    {
        slopes[0] = first;
    }
    Ok(hinges(&r, &slopes))
}

/// Radius of the section at the distance `depth` from the end.
pub(super) fn radius(coefficients: &[f64], depth: f64) -> f64 {
    (area(coefficients, depth)[0] / PI).sqrt()
}
