//! Derivatives of gaps with respect to the numbers of a shape.

use ndarray::Array2;

use crate::error::{Error, Result};

/// Step of differences, relative to the number: gaps are analytic in it, so that the sixth-order formula leaves some
/// 1e-18 of the derivative, and rounding 1e-13.
const STEP: f64 = 1e-3;

/// Weights of the central difference of sixth order at one, two and three steps, per step.
const WEIGHTS: [f64; 3] = [0.75, -0.15, 1.0 / 60.0];

/// Derivative of `values(θ)` at θ = `value` by central differences of sixth order, for values that are analytic.
pub(super) fn difference(
    value: f64,
    step: f64,
    values: impl Fn(f64) -> Result<Array2<f64>>,
) -> Result<Array2<f64>> {
    let mut sum: Option<Array2<f64>> = None;
    for (k, weight) in (1..=3).zip(WEIGHTS) {
        let away = f64::from(k) * step;
        let mut change = values(value + away)?;
        // +∞ at both places leaves no number: such cells never touch.
        change.zip_mut_with(&values(value - away)?, |a, b| {
            let d = (*a - b) * (weight / step);
            *a = if d.is_finite() { d } else { 0.0 };
        });
        sum = Some(match sum {
            None => change,
            Some(sum) => sum + change,
        });
    }
    Ok(sum.unwrap_or_default())
}

/// [`difference`] with a step for numbers other than 0.
pub(super) fn by_difference(
    value: f64,
    values: impl Fn(f64) -> Result<Array2<f64>>,
) -> Result<Array2<f64>> {
    difference(value, STEP * value.abs(), values)
}

/// ∂(R − √(R² − s))/∂R = 1 − R/√(R² − s), without cancellation; 0 where s ≥ R².
pub(super) fn sagitta_slope(radius: f64, s: f64) -> f64 {
    let under = radius * radius - s;
    if under <= 0.0 {
        return 0.0;
    }
    let root = under.sqrt();
    -s / (root * (radius + root))
}

/// The error for a name that is not among a shape's parameters.
pub(super) fn absent(name: &str) -> Error {
    Error::Choice {
        name: "parameter of the shape",
        requirement: "one of those that its parameters() lists: numbers on which the gap depends smoothly",
        value: name.to_owned(),
    }
}

/// Parameters of the part `number` of a sum, with the names `parts[number].…`.
pub(super) fn of_part(number: usize, parameters: Vec<(String, f64)>) -> Vec<(String, f64)> {
    let named = |(name, value): (String, f64)| (format!("parts[{number}].{name}"), value);
    parameters.into_iter().map(named).collect()
}

/// Number of the part that a name of [`of_part`] belongs to, and its name there.
pub(super) fn part(name: &str) -> Option<(usize, &str)> {
    let (number, rest) = name.strip_prefix("parts[")?.split_once("].")?;
    Some((number.parse().ok()?, rest))
}
