//! Tips that are given by samples: measured profiles, and area functions of indenters.

use super::term::Term;
use crate::error::{Error, Result};

/// Depths of an area function at which its profile is taken, evenly in their logarithms.
const SAMPLES: usize = 600;

/// Shallowest of these depths, in the deepest.
const SHALLOWEST: f64 = 1e-9;

/// Terms of the profile whose slope g' is linear between the places `r`, from (0, slope) on: each piece adds a hinge. The
/// profile goes on with the last curvature.
fn hinges(r: &[f64], slopes: &[f64]) -> Vec<Term> {
    let mut terms = vec![Term::power(slopes[0], 1.0)];
    let mut last = 0.0;
    for k in 0..r.len() - 1 {
        let curvature = (slopes[k + 1] - slopes[k]) / (r[k + 1] - r[k]);
        terms.push(match k {
            0 => Term::paraboloid(curvature),
            _ => Term::Hinge {
                at: r[k],
                curvature: curvature - last,
            },
        });
        last = curvature;
    }
    terms
}

/// Terms of the profile through the samples g(r), which begin on the axis at 0. Its slope is linear between the midpoints
/// of the samples, and 0 on the axis.
///
/// # Errors
/// Fewer than three samples, places that do not ascend from 0, numbers that are not finite, and heights that do not begin
/// with 0.
pub(super) fn profile(r: &[f64], g: &[f64]) -> Result<Vec<Term>> {
    if r.len() != g.len() || r.len() < 3 {
        return Err(Error::Shape {
            name: "profile",
            expected: [r.len().max(3), 2],
            found: [g.len(), 2],
        });
    }
    for (name, values) in [("profile radii", r), ("profile heights", g)] {
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            return Err(Error::NonFinite {
                name,
                index: [index, 0],
            });
        }
        if values[0].abs() > 0.0 {
            return Err(Error::Parameter {
                name,
                requirement: "0 at the first sample, which lies on the axis",
                value: values[0],
            });
        }
    }
    if let Some(k) = (1..r.len()).find(|&k| r[k] <= r[k - 1]) {
        return Err(Error::Parameter {
            name: "profile radii",
            requirement: "ascending",
            value: r[k],
        });
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
///
/// # Errors
/// No coefficients, such that are not finite, and an area that does not grow.
pub(super) fn area_function(coefficients: &[f64], depth: f64) -> Result<Vec<Term>> {
    if let Some(index) = coefficients.iter().position(|c| !c.is_finite()) {
        return Err(Error::NonFinite {
            name: "area coefficients",
            index: [index, 0],
        });
    }
    let (mut r, mut slopes) = (vec![0.0], vec![0.0]);
    for k in 0..SAMPLES {
        let d = depth * SHALLOWEST.powf(1.0 - (k + 1) as f64 / SAMPLES as f64);
        let [area, growth] = area(coefficients, d);
        if area <= 0.0 || growth <= 0.0 || coefficients.is_empty() {
            return Err(Error::Parameter {
                name: "area function",
                requirement: "above 0 and ascending at all depths up to the deepest; here is the depth where it is not",
                value: d,
            });
        }
        // π r² = A(g): g' = 2πr/A'.
        let radius = (area / std::f64::consts::PI).sqrt();
        if radius > r[r.len() - 1] * (1.0 + 1e-9) {
            r.push(radius);
            slopes.push(2.0 * std::f64::consts::PI * radius / growth);
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
    (area(coefficients, depth)[0] / std::f64::consts::PI).sqrt()
}
