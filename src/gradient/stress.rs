//! Outputs that are stresses: their values, and their derivatives with respect to pressure, body and friction.

use ndarray::Array2;

use super::parameter::Parameter;
use super::seed::{Measure, Seed, StressOutput, StressPlace, bilinear};
use super::state::Linearised;
use crate::contact::{Solution, block};
use crate::error::{Error, Result, positive, require};
use crate::model::body::{BodyParameter, HalfSpace};
use crate::stress::{Section, Side, StressOptions, Tensor, Weights};

/// Step of differences with respect to a number of the body, relative to it. By Richardson's extrapolation they are in error
/// by its fourth power, and by the error of kernels, 1e-9, over it: 1e-7 of the stress.
const STEP: f64 = 1e-2;

/// Weight of a soft maximum, relative to the largest, below which a cell counts for nothing.
const NEGLIGIBLE: f64 = 1e-12;

/// One plane of a stress output: its depth, and the weights of the stresses there.
struct Plane {
    at: (f64, Side),
    weights: Weights,
}

/// What the direct dependence of a stress on the body and on friction needs.
pub(super) struct StressSeed {
    output: StressOutput,
    body: HalfSpace,
    pressure: Array2<f64>,
    planes: Vec<Plane>,
}

/// The body that a stress belongs to.
fn body_of(solution: &Solution, output: &StressOutput) -> Result<HalfSpace> {
    let body = solution.member(output.member)?;
    match body.ends() {
        [None, None] => Ok(body.clone()),
        _ => Err(Error::no_derivative(
            "the stress",
            "the body has free ends, whose stress is tabulated for the body as it is; leave the ends out",
        )),
    }
}

/// Depths of an output in `body`, and sides of interfaces.
fn depths(body: &HalfSpace, place: &StressPlace) -> Result<Vec<(f64, Side)>> {
    let interfaces = body.interfaces();
    let find = |number: usize| {
        interfaces.get(number).copied().ok_or(Error::Parameter {
            name: "layer or interface",
            requirement: "one that the body has, counted from 0 at the surface",
            value: number as f64,
        })
    };
    Ok(match *place {
        StressPlace::Point([_, _, z], side) => vec![(z, side)],
        StressPlace::Interface { interface, side, .. } => vec![(find(interface)?, side)],
        StressPlace::Layer { layer, depths, .. } => {
            require("number of depths", depths as f64, depths >= 2, "at least 2")?;
            let bottom = find(layer)?;
            let top = if layer > 0 { interfaces[layer - 1] } else { 0.0 };
            let along = |k: usize| {
                let part = k as f64 / (depths - 1) as f64;
                match k + 1 == depths {
                    true => (bottom, Side::Above),
                    false => (top + part * (bottom - top), Side::Below),
                }
            };
            (0..depths).map(along).collect()
        }
    })
}

fn options(solution: &Solution, output: &StressOutput, friction: f64, side: Side) -> StressOptions {
    StressOptions {
        side,
        friction,
        direction: output.direction.or(solution.report.rolling_direction),
        section: Section::Plane,
        ..StressOptions::default()
    }
}

/// Components of the stress on planes, each in C order.
fn planes(
    solution: &Solution,
    output: &StressOutput,
    body: &HalfSpace,
    pressure: &Array2<f64>,
    friction: f64,
) -> Result<Vec<Weights>> {
    let plan = solution.uniform_stress_plan(output.member, body, pressure)?;
    let mut fields_by_plane = Vec::new();
    for (z, side) in depths(body, &output.place)? {
        let field = plan.stress(&[z], &options(solution, output, friction, side))?;
        let flat = |component: ndarray::Array3<f64>| component.iter().copied().collect();
        fields_by_plane.push(field.components.map(flat));
    }
    Ok(fields_by_plane)
}

impl StressSeed {
    /// The seed of a stress under `pressure`, the polished one on the whole grid.
    pub(super) fn new(
        solution: &Solution,
        state: &Linearised,
        output: &StressOutput,
        pressure: Array2<f64>,
    ) -> Result<(Seed, Self)> {
        let body = body_of(solution, output)?;
        let fields = planes(solution, output, &body, &pressure, output.friction)?;
        let at = depths(&body, &output.place)?;
        let (value, weights, warning) = match &output.place {
            StressPlace::Point([x, y, _], _) => {
                let (value, weights) = at_point(solution, output, [*x, *y], &fields[0])?;
                (value, vec![weights], None)
            }
            place => {
                let sharpness = place.sharpness().unwrap_or(0.0);
                soft_maximum(output, sharpness, &fields)?
            }
        };
        let planes: Vec<Plane> =
            (at.into_iter().zip(weights)).map(|(at, weights)| Plane { at, weights }).collect();
        let plan = solution.uniform_stress_plan(output.member, &body, &pressure)?;
        let mut slopes = Array2::zeros(pressure.dim());
        for plane in &planes {
            let (z, side) = plane.at;
            let options = options(solution, output, output.friction, side);
            slopes += &plan.transposed(z, &plane.weights, &options)?;
        }
        let window = block(&slopes, &state.tangent.window);
        let window: Vec<f64> = window.iter().copied().collect();
        let mut seed = Seed::linear(state, value, state.masked(&window));
        seed.warning = warning;
        let source = Self { output: output.clone(), body, pressure, planes };
        Ok((seed, source))
    }

    /// Σ w σ of planes of another body or friction.
    fn weighted(&self, solution: &Solution, body: &HalfSpace, friction: f64) -> Result<f64> {
        let fields_by_plane = planes(solution, &self.output, body, &self.pressure, friction)?;
        let mut sum = 0.0;
        for (plane, fields) in self.planes.iter().zip(&fields_by_plane) {
            for (weights, field) in plane.weights.iter().zip(fields) {
                sum += weights.iter().zip(field).map(|(w, s)| w * s).sum::<f64>();
            }
        }
        Ok(sum)
    }

    /// ∂J/∂θ at fixed pressure: how the stress itself depends on a number of the body, at depths that move with interfaces,
    /// and on the coefficient of friction.
    pub(super) fn direct(&self, solution: &Solution, parameter: &Parameter) -> Result<f64> {
        match parameter {
            Parameter::Body(member, one, _) if *member == self.output.member => {
                let value = self.body.value(*one).unwrap_or(0.0);
                let is_ratio = matches!(one, BodyParameter::Poisson(_));
                let step = STEP * if is_ratio { 0.1 } else { value };
                // Poisson's ratio has no neighbours above 0.5, where differences look back.
                let ahead = !is_ratio || value + step <= 0.5;
                let at = |factor: f64| -> Result<f64> {
                    let body = self.body.with_value(*one, value + factor * step)?;
                    self.weighted(solution, &body, self.output.friction)
                };
                if ahead {
                    let slope =
                        |h: f64| -> Result<f64> { Ok((at(h)? - at(-h)?) / (2.0 * h * step)) };
                    let (wide, narrow) = (slope(1.0)?, slope(0.5)?);
                    return Ok(narrow + (narrow - wide) / 3.0);
                }
                // Fourth order, one-sided: (25 f0 − 48 f1 + 36 f2 − 16 f3 + 3 f4)/12 per step.
                let mut sum = 0.0;
                for (k, weight) in [25.0, -48.0, 36.0, -16.0, 3.0].into_iter().enumerate() {
                    sum += weight * at(-(k as f64))?;
                }
                Ok(sum / (12.0 * step))
            }
            Parameter::Friction => {
                let with = self.weighted(solution, &self.body, 1.0)?;
                Ok(with - self.weighted(solution, &self.body, 0.0)?)
            }
            _ => Ok(0.0),
        }
    }

    /// Whether the stress depends on the coefficient of friction: a direction is known, and nothing slips inside the body.
    pub(super) fn slides(&self, solution: &Solution) -> bool {
        let known = self.output.direction.or(solution.report.rolling_direction).is_some();
        known && !self.body.slips()
    }
}

/// The measure at a point, and the weights of the stresses of the cells around.
fn at_point(
    solution: &Solution,
    output: &StressOutput,
    at: [f64; 2],
    fields: &Weights,
) -> Result<(f64, Weights)> {
    let ny = solution.grid().shape()[1];
    let cells = bilinear(solution.grid(), at)?;
    let mut stress = [0.0; 6];
    for ([i, j], weight) in &cells {
        for (sum, field) in stress.iter_mut().zip(fields) {
            *sum += weight * field[i * ny + j];
        }
    }
    let measure = measured(output.measure, stress);
    if measure.is_repeated {
        return Err(Error::no_derivative(
            "the principal stress",
            "it is repeated there, where its directions are undetermined; take von Mises' stress or a component",
        ));
    }
    let mut weights: Weights = std::array::from_fn(|k| vec![0.0; fields[k].len()]);
    for ([i, j], weight) in cells {
        for (weights, slope) in weights.iter_mut().zip(measure.slopes) {
            weights[i * ny + j] = weight * slope;
        }
    }
    Ok((measure.value, weights))
}

/// Order q of the mean that stands for the largest stress: it is below it by the q-th root of the number of cells, a
/// quarter for ten thousand.
const ORDER: i32 = 32;

/// A soft maximum of stresses σ over N places, and its derivative with respect to each.
///
/// ```text
/// J = (1/β) ln mean e^{βσ}      β = κ/s      s = (mean |σ|^q)^{1/q}
/// ∂J/∂σ_k = w_k + (J − Σ w σ)/s · ∂s/∂σ_k      w = e^{βσ}/Σ e^{βσ}      ∂s/∂σ_k = |σ_k/s|^{q−1} sgn σ_k / N
/// ```
///
/// κ is the `sharpness`, and q = [`ORDER`]; s, unlike the largest stress, is smooth. The choice of s is made here; not published elsewhere.
fn soft_mean(values: &[f64], sharpness: f64) -> (f64, Vec<f64>) {
    let count = values.len() as f64;
    let largest = values.iter().fold(f64::NEG_INFINITY, |a, v| a.max(*v));
    let most = values.iter().fold(0.0, |a: f64, v| a.max(v.abs()));
    if most <= 0.0 {
        return (0.0, vec![1.0 / count; values.len()]);
    }
    let powers = values.iter().map(|v| (v / most).powi(ORDER));
    let size = most * (powers.sum::<f64>() / count).powf(1.0 / f64::from(ORDER));
    let beta = sharpness / size;
    let shares: Vec<f64> = values.iter().map(|v| (beta * (v - largest)).exp()).collect();
    let sum: f64 = shares.iter().sum();
    let value = largest + (sum / count).ln() / beta;
    let weighted = values.iter().zip(&shares).map(|(v, w)| v * w).sum::<f64>() / sum;
    let of_size = (value - weighted) / size;
    let slope =
        |(v, share): (&f64, &f64)| share / sum + of_size * (v / size).powi(ORDER - 1) / count;
    (value, values.iter().zip(&shares).map(slope).collect())
}

/// The soft maximum of a measure over all cells of `planes`, and the weights of their stresses.
fn soft_maximum(
    output: &StressOutput,
    sharpness: f64,
    planes: &[Weights],
) -> Result<(f64, Vec<Weights>, Option<String>)> {
    positive("sharpness", sharpness)?;
    let cells = planes[0][0].len();
    let stress = |plane: &Weights, k: usize| std::array::from_fn(|c| plane[c][k]);
    let values: Vec<f64> = planes
        .iter()
        .flat_map(|plane| (0..cells).map(|k| measured(output.measure, stress(plane, k)).value))
        .collect();
    let (value, slopes) = soft_mean(&values, sharpness);
    let largest = slopes.iter().fold(0.0, |a: f64, v| a.max(v.abs()));
    let mut repeated = false;
    let weights = planes.iter().zip(slopes.chunks(cells)).map(|(plane, slopes)| {
        let mut weights: Weights = std::array::from_fn(|_| vec![0.0; cells]);
        for (k, share) in slopes.iter().enumerate() {
            if share.abs() < NEGLIGIBLE * largest {
                continue;
            }
            let measure = measured(output.measure, stress(plane, k));
            repeated |= measure.is_repeated;
            for (weights, slope) in weights.iter_mut().zip(measure.slopes) {
                weights[k] = share * slope;
            }
        }
        weights
    });
    let weights = weights.collect();
    let warning = repeated.then(|| {
        "a principal stress is repeated in a cell of the soft maximum, whose share is left out: take von Mises' stress or a \
         component"
            .to_owned()
    });
    Ok((value, weights, warning))
}

/// Distance of principal stresses, relative to the largest, below which they are repeated.
const REPEATED: f64 = 1e-9;

/// A measure, its derivatives with respect to σ_xx, σ_yy, σ_zz, σ_xy, σ_yz, σ_xz, and whether a principal stress that it
/// takes is repeated.
pub(super) struct Measured {
    pub(super) value: f64,
    pub(super) slopes: [f64; 6],
    pub(super) is_repeated: bool,
}

impl Measured {
    fn smooth(value: f64, slopes: [f64; 6]) -> Self {
        Self { value, slopes, is_repeated: false }
    }
}

/// The measure of a stress with these components.
pub(super) fn measured(measure: Measure, s: [f64; 6]) -> Measured {
    let [xx, yy, zz, xy, yz, xz] = s;
    match measure {
        Measure::Component(k) => {
            let mut slopes = [0.0; 6];
            slopes[k] = 1.0;
            Measured::smooth(s[k], slopes)
        }
        Measure::PlaneShear => {
            let value = yz.hypot(xz);
            let over = |t: f64| if value > 0.0 { t / value } else { 0.0 };
            Measured::smooth(value, [0.0, 0.0, 0.0, 0.0, over(yz), over(xz)])
        }
        Measure::VonMises => {
            let mean = (xx + yy + zz) / 3.0;
            let deviator = [xx - mean, yy - mean, zz - mean];
            let square: f64 =
                deviator.iter().map(|d| d * d).sum::<f64>() + 2.0 * (xy * xy + yz * yz + xz * xz);
            let value = (1.5 * square).sqrt();
            let over = |t: f64| if value > 0.0 { 1.5 * t / value } else { 0.0 };
            let [a, b, c] = deviator.map(over);
            Measured::smooth(value, [a, b, c, over(2.0 * xy), over(2.0 * yz), over(2.0 * xz)])
        }
        Measure::Principal(k) => {
            let values = Tensor::new(s).principal();
            let near = (0..3).filter(|&j| j != k).any(|j| are_equal(values, k, j));
            Measured { value: values[k], slopes: dyad(s, values, k), is_repeated: near }
        }
        Measure::MaxShear => {
            let values = Tensor::new(s).principal();
            let (first, last) = (dyad(s, values, 0), dyad(s, values, 2));
            Measured {
                value: 0.5 * (values[0] - values[2]),
                slopes: std::array::from_fn(|k| 0.5 * (first[k] - last[k])),
                is_repeated: are_equal(values, 0, 1) || are_equal(values, 1, 2),
            }
        }
    }
}

fn are_equal(values: [f64; 3], i: usize, j: usize) -> bool {
    let size = values.iter().fold(0.0, |a: f64, v| a.max(v.abs()));
    (values[i] - values[j]).abs() <= REPEATED * size
}

/// ∂σ_k/∂σ = n nᵀ of the direction n, from the adjugate of σ − σ_k; shear components count twice.
fn dyad([xx, yy, zz, xy, yz, xz]: [f64; 6], values: [f64; 3], k: usize) -> [f64; 6] {
    let [a, b, c] = [xx, yy, zz].map(|s| s - values[k]);
    let adjugate = [
        b * c - yz * yz,
        a * c - xz * xz,
        a * b - xy * xy,
        xz * yz - xy * c,
        xy * xz - a * yz,
        xy * yz - b * xz,
    ];
    let trace = adjugate[0] + adjugate[1] + adjugate[2];
    let over = |t: f64| if trace == 0.0 { 0.0 } else { t / trace };
    let [a, b, c, d, e, f] = adjugate.map(over);
    [a, b, c, 2.0 * d, 2.0 * e, 2.0 * f]
}

#[cfg(test)]
mod tests {
    use super::soft_mean;

    /// A soft maximum lies below the largest of N values by ln N/β at most, follows a change of unit, and its slopes equal
    /// differences: their error is 1e-6² of a third derivative of some κ³.
    #[test]
    fn slopes_of_soft_maxima() {
        let values: Vec<f64> = (0..50).map(|k| (f64::from(k) * 12.9898).sin() * 3.0).collect();
        let largest = values.iter().fold(0.0, |a: f64, v| a.max(*v));
        let size = values.iter().fold(0.0, |a: f64, v| a.max(v.abs()));
        for sharpness in [5.0, 40.0, 200.0] {
            let (value, slopes) = soft_mean(&values, sharpness);
            // s is at most the largest size.
            assert!(value < largest && value > largest - size * 50.0_f64.ln() / sharpness);
            let twice: Vec<f64> = values.iter().map(|v| 2.0 * v).collect();
            assert!((soft_mean(&twice, sharpness).0 / value - 2.0).abs() < 1e-14);
            // Euler: J is of first degree.
            let sum: f64 = slopes.iter().zip(&values).map(|(s, v)| s * v).sum();
            assert!((sum / value - 1.0).abs() < 1e-12);
            for k in 0..values.len() {
                let at = |step: f64| {
                    let mut values = values.clone();
                    values[k] += step;
                    soft_mean(&values, sharpness).0
                };
                let due = (at(1e-6) - at(-1e-6)) / 2e-6;
                assert!((slopes[k] - due).abs() < 1e-8, "{k}: {} {due}", slopes[k]);
            }
        }
    }
}
