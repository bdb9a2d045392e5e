//! Adjoint and tangent solves agree, and derivatives satisfy the sum rules of the discrete contact.

use nacre::gradient::Output;
use nacre::{Axis, Elastic, Grid, Motion, Result, Roller, Surface};
use ndarray::Array2;

use super::cases::{Case, linearised};

use crate::support::checks::largest;
use crate::support::contacts::Random;

/// Linear solves to 1e-12, and sums of some hundred terms.
const EXACT: f64 = 1e-9;

/// Σ w ṗ of the tangent equals the derivative of Σ w p of the adjoint, for every parameter.
#[test]
#[ignore = "slow"]
fn adjoint_and_tangent_agree() -> Result<()> {
    let (mut compared, mut cases) = (0, 0);
    for number in 0..80 {
        let case = Case::new(number)?;
        let Ok(solution) = case.solve(1e-10) else {
            continue;
        };
        cases += 1;
        let plan = linearised(&solution, Some(&*case.shape))?;
        let numbers = &mut Random::new(1000 + number);
        let weights =
            Array2::from_shape_simple_fn(case.grid.shape(), || numbers.between(-1.0, 1.0));
        let gradient = plan.vjp(&weights, None)?;
        let sized = |field: &Array2<f64>| (field * &weights).mapv(f64::abs).sum();
        // A shift that moves the whole contact changes nothing but by its rounding.
        let rest = 1e-3 * sized(&solution.pressure);
        let scale = |rate: &Array2<f64>| sized(rate) + rest;
        for (parameter, value) in &gradient.values {
            let tangent = plan.jvp(&[(&parameter.to_string(), 1.0)], None)?;
            let dot = (&tangent.pressure * &weights).sum();
            if largest(&tangent.pressure) > 0.0 {
                let error = (dot - value).abs() / scale(&tangent.pressure);
                below!(error, EXACT, number, parameter);
                compared += 1;
            }
        }
        // And for a random change of the gap, which the field answers.
        let gap = Array2::from_shape_simple_fn(case.grid.shape(), || numbers.between(-1.0, 1.0));
        let tangent = plan.jvp(&[], Some(&gap))?;
        let one = (&gradient.gap * &gap).sum();
        let other = (&tangent.pressure * &weights).sum();
        below!((one - other).abs() / scale(&tangent.pressure), EXACT);
    }
    assert!(compared > 600 && cases > 78, "{compared} {cases}");
    Ok(())
}

/// Σ dδ/dh = 1 under a load, and Σ dJ/dh = 0 for every J(p); Σ x ds_x/dh = 1 where the tilt is loaded.
#[test]
#[ignore = "slow"]
fn fields_satisfy_the_sum_rules() -> Result<()> {
    let mut seen = [0, 0];
    for number in 0..100 {
        let case = Case::new(number)?;
        let motion = case.motion;
        if motion.load.is_none() || case.grid.is_line() {
            continue;
        }
        let Ok(solution) = case.solve(1e-10) else {
            continue;
        };
        let plan = linearised(&solution, Some(&*case.shape))?;
        let outputs = [Output::Approach, Output::Tilt(Axis::X), Output::PressureNorm(8.0)];
        let gradients = plan.gradients(&outputs, Some(&[]))?;
        let size = |k: usize| gradients[k].gap.iter().map(|g| g.abs()).sum::<f64>();
        seen[0] += 1;
        below!((gradients[0].gap.sum() - 1.0).abs() / size(0), EXACT);
        below!(gradients[2].gap.sum().abs() / size(2), EXACT);
        if motion.eccentricity[0].is_some() || motion.moment[0].is_some() {
            let x = case.grid.x();
            let moment: f64 = (gradients[1].gap.indexed_iter()).map(|((i, _), g)| x[i] * g).sum();
            below!((moment - 1.0).abs() / size(1), EXACT);
            seen[1] += 1;
        }
    }
    assert!(seen[0] > 30 && seen[1] > 10, "{seen:?}");
    Ok(())
}

/// Moduli and load scaled together leave the approach, and scale pressures: Σ E ∂/∂E + W ∂/∂W.
#[test]
#[ignore = "slow"]
fn moduli_and_load_scale_together() -> Result<()> {
    let mut seen = 0;
    for number in 0..60 {
        let case = Case::new(number)?;
        let Some(load) = case.motion.load else {
            continue;
        };
        if case.motion.moment != [None; 2] {
            continue;
        }
        let Ok(solution) = case.solve(1e-10) else {
            continue;
        };
        let outputs = [Output::Approach, Output::PressureNorm(10.0)];
        let plan = linearised(&solution, Some(&*case.shape))?;
        for (gradient, degree) in plan.gradients(&outputs, None)?.iter().zip([0.0, 1.0]) {
            let mut sum = 0.0;
            for (parameter, slope) in &gradient.values {
                let path = parameter.to_string();
                sum +=
                    slope * young(&case, &path).or((path == "load").then_some(load)).unwrap_or(0.0);
            }
            // The exact method's coefficients hold to 1e-9.
            below!((sum / gradient.value - degree).abs(), 1e-8);
        }
        seen += 1;
    }
    assert!(seen > 12, "{seen}");
    Ok(())
}

/// The same of the tilt under one load off the middle, whose moment grows with it.
#[test]
fn the_moment_of_a_load_off_the_middle_grows_with_it() -> Result<()> {
    let load = 0.02;
    let case = Case {
        body: Elastic::new(1.0, 0.3)?.into(),
        counterbody: None,
        grid: Grid::new([20, 16], [2.4, 2.4])?,
        shape: Box::new(Roller::new(10.0, 0.6, 10.0)?),
        motion: Motion::load(load).with_eccentricity([Some(0.05), None]),
    };
    let solution = case.solve(1e-10)?;
    let plan = linearised(&solution, Some(&*case.shape))?;
    let gradient = plan.gradient(&Output::Tilt(Axis::X), None)?;
    let paths = [("load", load), ("body.substrate.young", 1.0)];
    let terms = paths.map(|(path, number)| gradient.get(path).unwrap_or(f64::NAN) * number);
    below!((terms[0] + terms[1]).abs(), 1e-8 * terms[0].abs());
    below!(0.1 * gradient.value.abs(), terms[0].abs());
    Ok(())
}

/// Young's modulus with this path.
fn young(case: &Case, path: &str) -> Option<f64> {
    let (body, rest) = match path.split_once('.')? {
        ("body", rest) => (&case.body, rest),
        ("counterbody", rest) => (case.counterbody.as_ref()?, rest),
        _ => return None,
    };
    let found = body.parameters().into_iter().find(|one| one.path(body) == rest)?;
    matches!(found, nacre::BodyParameter::Young(_)).then(|| body.value(found))?
}

/// Lengths scaled together, the grid among them: approach and lengths are of degree 1, the load of degree 2, pressures of
/// degree 0. The grid is no parameter, but the field of the gap takes its place: x ∂h/∂x.
#[test]
fn the_gap_field_stands_for_any_shape() -> Result<()> {
    let case = Case::new(0)?;
    let solution = case.solve(1e-10)?;
    let plan = linearised(&solution, Some(&*case.shape))?;
    let gradient = &plan.gradients(&[Output::PressureNorm(8.0)], None)?[0];
    for (name, _) in case.shape.parameters() {
        let slopes = case.shape.gap_derivative(&name, &case.grid)?;
        let sum = (&slopes * &gradient.gap).sum();
        let found = gradient.get(&format!("shape.{name}")).unwrap_or(f64::NAN);
        let bar = 1e-12 * found.abs().max(1e-3 * gradient.value);
        below!((sum - found).abs(), bar, name);
    }
    Ok(())
}
