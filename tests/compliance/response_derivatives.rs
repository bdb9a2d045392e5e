//! Derivatives of the frequency response equal reference values of 50 digits and two exact identities, for any stack.

use nacre::response::{Asymptotes, Response, asymptote_derivatives, normal_derivatives};
use nacre::{BodyParameter, Elastic, HalfSpace, Interface, Layer, Result, Substrate};

use crate::support::bodies::body;
use crate::support::random::uniform;
use crate::support::reference::{list, number, read};

/// Relative to max(|∂|, 1e-6 |c|/|θ|): the energies are sums of a few terms of one size.
const EXACT: f64 = 1e-12;

/// Identities between sums of derivatives, relative to the response: rounding of the terms.
const IDENTITY: f64 = 1e-13;

/// [`IDENTITY`] for thicknesses; one random body of 200, stiff and thin on a soft layer that slides, has 1.7e-13.
const LENGTHS: f64 = 2e-13;

/// A random body of up to five layers, contrasts up to 1e3, and Poisson's ratios up to 0.5.
fn random_body(seed: u64) -> Result<HalfSpace> {
    let numbers = uniform([8, 5], seed);
    let count = 1 + (5.0 * numbers[[7, 0]]) as usize;
    let interface = |u: f64| [Interface::Bonded, Interface::Frictionless][usize::from(u < 0.25)];
    let poisson = |u: f64| (u * 1.2 - 0.6).clamp(-0.5, 0.5);
    let layers: Result<Vec<Layer>> = (0..count.min(5))
        .map(|k| {
            let u = |row: usize| numbers[[row, k]];
            let young = 10f64.powf(3.0 * u(0) - 1.5);
            let material = Elastic::new(young, poisson(u(1)))?;
            let layer = Layer::new(material, 10f64.powf(2.0 * u(2) - 1.0))?;
            Ok(layer.with_interface(interface(u(3))))
        })
        .collect();
    let substrate = match numbers[[6, 0]] {
        u if u < 0.2 => Substrate::Rigid,
        u => Elastic::new(u, poisson(numbers[[6, 1]]))?.into(),
    };
    HalfSpace::new(substrate, layers?)
}

/// All derivatives at a wavenumber, and the response.
fn all(body: &HalfSpace, alpha: f64) -> (f64, Vec<(BodyParameter, f64)>) {
    let parameters = body.parameters();
    let mut out = vec![0.0; parameters.len()];
    let value = normal_derivatives(body, &parameters, alpha, &mut out);
    (value, parameters.into_iter().zip(out).collect())
}

/// Wavenumbers from 1e-6 to 1e3, two to a decade.
fn sweep() -> impl Iterator<Item = f64> {
    (-12..=6).map(|k| 10f64.powf(0.5 * f64::from(k)))
}

#[test]
fn derivatives_equal_those_of_fifty_digits() -> Result<()> {
    let mut compared = 0;
    for case in list(&read("response_derivatives.json"), "stacks") {
        let body = body(case)?;
        let layers = body.layers().len();
        for row in list(case, "rows") {
            let (value, slopes) = all(&body, number(row, "alpha"));
            let expected = number(row, "alpha_c11");
            near!(value, expected, EXACT);
            for (parameter, slope) in slopes {
                let name = match parameter {
                    BodyParameter::Young(_) => "young",
                    BodyParameter::Poisson(_) => "poisson",
                    BodyParameter::Thickness(_) => "thickness",
                    BodyParameter::NormalStiffness(_) => "normal",
                    BodyParameter::TangentialStiffness(_) => "tangential",
                };
                let key = match parameter.layer() {
                    place if place == layers => format!("d_{name}_substrate"),
                    place => format!("d_{name}_{place}"),
                };
                let reference = number(row, &key);
                let theta = body.value(parameter).unwrap_or(1.0).abs();
                let scale = reference.abs().max(1e-6 * expected / theta);
                let error = (slope - reference).abs() / scale;
                below!(error, EXACT);
                compared += 1;
            }
        }
    }
    assert!(compared == 242, "{compared}");
    Ok(())
}

/// α ∂(α c11)/∂α by a central difference of 24 points in ln α.
fn along(body: &HalfSpace, alpha: f64) -> f64 {
    const STEP: f64 = 0.04;
    const POINTS: i32 = 12;
    let mut weight = -1.0;
    (1..=POINTS)
        .map(|k| {
            // (−1)^{k+1} n!²/((n−k)! (n+k)!)
            let (n, j) = (f64::from(POINTS), f64::from(k));
            weight *= -(n - j + 1.0) / (n + j);
            let at = |sign: f64| body.normal(alpha * (sign * j * STEP).exp());
            weight * (at(1.0) - at(-1.0)) / (j * STEP)
        })
        .sum()
}

#[test]
fn moduli_and_lengths_scale_the_response() -> Result<()> {
    for seed in 0..200 {
        let body = random_body(seed)?;
        for alpha in sweep() {
            let (value, slopes) = all(&body, alpha);
            let (mut young, mut lengths) = (value, -along(&body, alpha));
            for (one, slope) in slopes {
                let weighted = body.value(one).unwrap_or(0.0) * slope;
                match one {
                    BodyParameter::Young(_) => young += weighted,
                    BodyParameter::Thickness(_) => lengths += weighted,
                    BodyParameter::Poisson(_) => {}
                    BodyParameter::NormalStiffness(_) | BodyParameter::TangentialStiffness(_) => {
                        young += weighted;
                        lengths -= weighted;
                    }
                }
            }
            below!((young / value).abs(), IDENTITY, seed, alpha);
            below!((lengths / value).abs(), LENGTHS, seed, alpha);
        }
    }
    Ok(())
}

#[test]
fn a_layer_cut_in_two_shares_its_derivatives() -> Result<()> {
    for seed in 0..100 {
        let body = random_body(seed)?;
        let cut = |layer: &Layer| -> Result<[Layer; 2]> {
            let (top, rest) = (0.3 * layer.thickness(), 0.7 * layer.thickness());
            let lower = Layer::new(layer.material(), rest)?.with_interface(layer.interface());
            Ok([Layer::new(layer.material(), top)?, lower])
        };
        let halves: Result<Vec<[Layer; 2]>> = body.layers().iter().map(cut).collect();
        let halved = HalfSpace::new(body.substrate(), halves?.into_iter().flatten())?;
        for alpha in sweep() {
            let (value, slopes) = all(&body, alpha);
            let (_, parts) = all(&halved, alpha);
            for (k, (parameter, slope)) in slopes.iter().enumerate() {
                let theta = body.value(*parameter).unwrap_or(0.0).abs().max(0.1);
                let at = |j: usize| parts[j].1;
                let layer = k / 3;
                let sum = match parameter {
                    BodyParameter::Thickness(_) => {
                        0.3 * at(6 * layer + 2) + 0.7 * at(6 * layer + 5)
                    }
                    _ if layer == body.layers().len() => at(6 * layer + k % 3),
                    _ => at(6 * layer + k % 3) + at(6 * layer + k % 3 + 3),
                };
                below!((sum - slope).abs() * theta / value, EXACT);
            }
        }
    }
    Ok(())
}

/// Differences of the limits, at a step of 1e-4, in error by its square.
#[test]
fn limits_have_the_derivatives_of_their_differences() -> Result<()> {
    const STEP: f64 = 1e-4;
    for seed in 0..200 {
        let body = random_body(seed)?;
        let parameters = body.parameters();
        let limits = asymptote_derivatives(&body, &parameters);
        let largest = parameters.iter().zip(&limits).fold([0.0_f64; 3], |most, (one, slope)| {
            let theta = body.value(*one).unwrap_or(0.0).abs();
            let [a, b, c] = numbers(*slope).map(|x| (x * theta).abs());
            [most[0].max(a), most[1].max(b), most[2].max(c)]
        });
        for (parameter, slope) in parameters.iter().zip(limits) {
            let theta = body.value(*parameter).unwrap_or(0.0);
            let step = STEP * theta.abs().max(1e-2);
            let at = |sign: f64| body.with_value(*parameter, theta + sign * step);
            // Poisson's ratio of 0.5 has no neighbour above.
            let (Ok(above), Ok(below)) = (at(1.0), at(-1.0)) else {
                continue;
            };
            let (above, below) = (above.asymptotes(), below.asymptotes());
            for (k, found) in numbers(slope).into_iter().enumerate() {
                let difference = (numbers(above)[k] - numbers(below)[k]) / (2.0 * step);
                let error = (difference - found).abs() * theta.abs().max(0.1);
                if largest[k] > 0.0 {
                    // The square of the step, and second derivatives that are some tens larger.
                    below!(error / largest[k], 1e-6);
                } else {
                    assert!(error <= 0.0);
                }
            }
        }
    }
    Ok(())
}

fn numbers(limits: Asymptotes) -> [f64; 3] {
    [limits.long, limits.constant, limits.short]
}

#[test]
fn long_waves_leave_for_the_derivatives_of_the_limits() -> Result<()> {
    for seed in 0..100 {
        let body = random_body(seed)?;
        let limits = asymptote_derivatives(&body, &body.parameters());
        let alpha = 1e-7;
        let (value, slopes) = all(&body, alpha);
        for ((parameter, slope), limit) in slopes.into_iter().zip(limits) {
            let theta = body.value(parameter).unwrap_or(0.0).abs();
            let error = slope - (limit.long + alpha * limit.constant);
            // Terms of the order (αh)², with the largest contrasts.
            below!((error * theta).abs() / value, 1e-6);
        }
    }
    Ok(())
}
