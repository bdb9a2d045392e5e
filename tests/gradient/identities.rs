//! Adjoint and tangent solves agree, and derivatives satisfy the sum rules of the discrete contact.

use nacre::gradient::{LinearOptions, Linearisation, Output};
use nacre::{Result, Surface};
use ndarray::Array2;

use super::cases::{Case, Numbers};

/// Linear solves to 1e-12, and sums of some hundred terms.
const EXACT: f64 = 1e-9;

const TIGHT: LinearOptions = LinearOptions {
    tolerance: 1e-12,
    watch: None,
};

/// Σ w ṗ of the tangent equals the derivative of Σ w p of the adjoint, for every parameter.
#[test]
fn adjoint_and_tangent_agree() -> Result<()> {
    let (mut worst, mut compared, mut cases) = (0.0_f64, 0, 0);
    for number in 0..200 {
        let case = Case::new(number)?;
        let Ok(solution) = case.solve(1e-10) else {
            continue;
        };
        cases += 1;
        let plan = Linearisation::plan(&solution, Some(&*case.shape), &TIGHT)?;
        let numbers = &mut Numbers::new(1000 + number);
        let weights =
            Array2::from_shape_simple_fn(case.grid.shape(), || numbers.between(-1.0, 1.0));
        let gradient = plan.vjp(&weights, None)?;
        let sized = |field: &Array2<f64>| {
            (field.iter().zip(&weights))
                .map(|(p, w)| (p * w).abs())
                .sum::<f64>()
        };
        // A shift that moves the whole contact changes nothing but by its rounding.
        let rest = 1e-3 * sized(&solution.pressure);
        let scale = |rate: &Array2<f64>| sized(rate) + rest;
        let largest = |a: &Array2<f64>| a.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        for (parameter, value) in &gradient.values {
            let tangent = plan.jvp(&[(&parameter.to_string(), 1.0)], None)?;
            let dot: f64 = (tangent.pressure.iter().zip(&weights))
                .map(|(p, w)| p * w)
                .sum();
            if largest(&tangent.pressure) > 0.0 {
                let error = (dot - value).abs() / scale(&tangent.pressure);
                worst = worst.max(error);
                compared += 1;
            }
        }
        // And for a random change of the gap, which the field answers.
        let gap = Array2::from_shape_simple_fn(case.grid.shape(), || numbers.between(-1.0, 1.0));
        let tangent = plan.jvp(&[], Some(&gap))?;
        let one: f64 = (gradient.gap.iter().zip(&gap)).map(|(a, b)| a * b).sum();
        let other: f64 = (tangent.pressure.iter().zip(&weights))
            .map(|(p, w)| p * w)
            .sum();
        worst = worst.max((one - other).abs() / scale(&tangent.pressure));
    }
    println!("largest difference {worst:.1e} of {compared} in {cases} cases");
    assert!(
        worst < EXACT && compared > 1500 && cases > 195,
        "{worst:e} {compared} {cases}"
    );
    Ok(())
}

/// Σ dδ/dh = 1 under a load, and Σ dJ/dh = 0 for every J(p); Σ x ds_x/dh = 1 where the tilt is loaded.
#[test]
fn fields_satisfy_the_sum_rules() -> Result<()> {
    let (mut worst, mut seen) = (0.0_f64, [0, 0]);
    for number in 0..100 {
        let case = Case::new(number)?;
        let motion = case.motion;
        if motion.load.is_none() || case.grid.is_line() {
            continue;
        }
        let Ok(solution) = case.solve(1e-10) else {
            continue;
        };
        let plan = Linearisation::plan(&solution, Some(&*case.shape), &TIGHT)?;
        let outputs = [Output::Approach, Output::Tilt(0), Output::PressureNorm(8.0)];
        let gradients = plan.gradients(&outputs, Some(&[]))?;
        let size = |k: usize| gradients[k].gap.iter().map(|g| g.abs()).sum::<f64>();
        seen[0] += 1;
        worst = worst.max((gradients[0].gap.sum() - 1.0).abs() / size(0));
        worst = worst.max(gradients[2].gap.sum().abs() / size(2));
        if motion.eccentricity[0].is_some() || motion.moment[0].is_some() {
            let x = case.grid.x();
            let moment: f64 = (gradients[1].gap.indexed_iter())
                .map(|((i, _), g)| x[i] * g)
                .sum();
            worst = worst.max((moment - 1.0).abs() / size(1));
            seen[1] += 1;
        }
    }
    println!("largest difference {worst:.1e} of {seen:?}");
    assert!(
        worst < EXACT && seen[0] > 30 && seen[1] > 10,
        "{worst:e} {seen:?}"
    );
    Ok(())
}

/// Moduli and load scaled together leave the approach, and scale pressures: Σ E ∂/∂E + W ∂/∂W.
#[test]
fn moduli_and_load_scale_together() -> Result<()> {
    let (mut worst, mut seen) = (0.0_f64, 0);
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
        let plan = Linearisation::plan(&solution, Some(&*case.shape), &TIGHT)?;
        for (gradient, degree) in plan.gradients(&outputs, None)?.iter().zip([0.0, 1.0]) {
            let mut sum = 0.0;
            for (parameter, slope) in &gradient.values {
                let path = parameter.to_string();
                sum += slope
                    * young(&case, &path)
                        .or((path == "load").then_some(load))
                        .unwrap_or(0.0);
            }
            worst = worst.max((sum / gradient.value - degree).abs());
        }
        seen += 1;
    }
    println!("largest difference {worst:.1e} of {seen}");
    // The exact method's coefficients hold to 1e-9.
    assert!(worst < 1e-8 && seen > 12, "{worst:e} {seen}");
    Ok(())
}

/// Young's modulus with this path.
fn young(case: &Case, path: &str) -> Option<f64> {
    let (body, rest) = match path.split_once('.')? {
        ("body", rest) => (&case.body, rest),
        ("counterbody", rest) => (case.counterbody.as_ref()?, rest),
        _ => return None,
    };
    let found = body
        .parameters()
        .into_iter()
        .find(|one| one.path(body) == rest)?;
    matches!(found, nacre::BodyParameter::Young(_)).then(|| body.value(found))?
}

/// Lengths scaled together, the grid among them: approach and lengths are of degree 1, the load of degree 2, pressures of
/// degree 0. The grid is no parameter, but the field of the gap takes its place: x ∂h/∂x.
#[test]
fn the_gap_field_stands_for_any_shape() -> Result<()> {
    let case = Case::new(0)?;
    let solution = case.solve(1e-10)?;
    let plan = Linearisation::plan(&solution, Some(&*case.shape), &TIGHT)?;
    let gradient = &plan.gradients(&[Output::PressureNorm(8.0)], None)?[0];
    for (name, _) in case.shape.parameters() {
        let slopes = case.shape.gap_derivative(&name, &case.grid)?;
        let sum: f64 = (slopes.iter().zip(&gradient.gap)).map(|(a, b)| a * b).sum();
        let found = gradient.get(&format!("shape.{name}")).unwrap_or(f64::NAN);
        assert!(
            (sum - found).abs() < 1e-12 * found.abs().max(1e-3 * gradient.value),
            "{name}"
        );
    }
    Ok(())
}
