//! Profiles that are singular or have kinks: loads and their derivatives against closed forms, and P' = S δ' on layers.

use std::f64::consts::PI;

use nacre::indent::{
    Form, Held, Indent, IndentParameter, Point, Stack, Tip, TipParameter, Variable,
};
use nacre::{Elastic, HalfSpace, Result};

use super::coated;

use crate::support::numerics::slope;

/// ∫₀^a F ds and F(a) of a step m and of a hinge c at b.
fn step(m: f64, b: f64, a: f64) -> [f64; 2] {
    if a <= b {
        return [0.0; 2];
    }
    let root = ((a - b) * (a + b)).sqrt();
    let angle = root.atan2(b);
    [0.5 * m * (a * a * angle - b * root), m * a * angle]
}

fn hinge(c: f64, b: f64, a: f64) -> [f64; 2] {
    let root = ((a - b) * (a + b)).max(0.0).sqrt();
    let [sum, value] = step(b, b, a);
    [c * (root.powi(3) / 3.0 - sum), c * (a * root - value)]
}

fn add(x: [f64; 2], y: [f64; 2]) -> [f64; 2] {
    [x[0] + y[0], x[1] + y[1]]
}

/// ∫₀^a F ds and F(a) of a tip.
fn transform(form: &Form, a: f64) -> [f64; 2] {
    match form {
        Form::Sphere { radius } => {
            let angle = (a / radius).atanh();
            let square = (a - radius) * (a + radius);
            [0.5 * (square * angle + radius * a), a * angle]
        }
        Form::Power { factor, exponent } => {
            // n (√π/2) Γ(n/2)/Γ((n+1)/2) = √π Γ(n/2+1)/Γ((n+1)/2).
            let gamma = spec_math::cephes64::gamma;
            let ratio = gamma(0.5 * exponent + 1.0) / gamma(0.5 * exponent + 0.5);
            let value = factor * PI.sqrt() * ratio * a.powf(*exponent);
            [value * a / (exponent + 1.0), value]
        }
        Form::RoundedCone { slope, radius } => {
            let b = slope * radius;
            let root = ((a - b) * (a + b)).max(0.0).sqrt();
            // s² up to b, and s [b²/(s + √(s²−b²)) + b arccos(b/s)] beyond; a³ − √(a²−b²)³ without a difference.
            let cubes = b * b / (a + root) * (a * a + a * root + root * root);
            let [sum, value] = step(b, b, a);
            [(cubes / 3.0 + sum) / radius, (a * b * b / (a + root) + value) / radius]
        }
        Form::RoundedPunch { flat, radius } => hinge(1.0 / radius, *flat, a),
        Form::FlatCone { flat, slope } => step(*slope, *flat, a),
        Form::Profile { radii, heights } => {
            // The slope is linear between the middles of the samples.
            let (mut place, mut slope, mut last, mut sum) = (0.0, 0.0, 0.0, [0.0; 2]);
            for (r, g) in radii.windows(2).zip(heights.windows(2)) {
                let next = (g[1] - g[0]) / (r[1] - r[0]);
                let middle = 0.5 * (r[0] + r[1]);
                let curvature = (next - slope) / (middle - place);
                sum = add(sum, hinge(curvature - last, place, a));
                (place, slope, last) = (middle, next, curvature);
            }
            sum
        }
        _ => unreachable!("{form:?}"),
    }
}

/// Load at the contact radius `a` on a bare body of E* = 1: 2 [a F(a) − ∫ F].
fn load(form: &Form, a: f64) -> f64 {
    let [sum, value] = transform(form, a);
    2.0 * (a * value - sum)
}

/// Tips at the contact radius 1, each with the part of its numbers that is small for its profile: up to 1e-9 of the edge of a
/// sphere, and from flat ends of 1e-9 of the contact to all but 1e-4 of it.
fn tips() -> Vec<(Form, f64)> {
    let mut all = Vec::new();
    for part in [1e-9, 1e-4, 0.01, 0.1, 0.3, 0.6, 1.5] {
        let radius = 1.0 + part;
        all.push((Form::Sphere { radius }, part.min(1.0)));
    }
    for exponent in [0.01, 0.2, 0.5, 1.0, 1.3, 2.0, 2.5, 7.0, 20.0, 64.5, 99.0] {
        let factor = 0.1;
        all.push((Form::Power { factor, exponent }, 1.0 / (1.0 + exponent)));
    }
    for flat in [1e-9, 1e-3, 0.1, 0.5, 0.9, 0.9999] {
        let slope = 0.2;
        let radius = 5.0;
        all.push((Form::FlatCone { flat, slope }, 1.0 - flat));
        all.push((Form::RoundedPunch { flat, radius }, 1.0 - flat));
        let radius = flat / slope;
        all.push((Form::RoundedCone { slope, radius }, 1.0 - flat));
    }
    // Uneven samples, whose kinks are 0.01 to 0.2 of the contact apart.
    for count in [5, 20, 60] {
        let place = |k: i32| 1.4 * (f64::from(k) / f64::from(count)).powf(1.7);
        let radii: Vec<f64> = (0..=count).map(place).collect();
        let heights = radii.iter().map(|r| 0.1 * r * r * (1.0 + 0.3 * r)).collect();
        all.push((Form::Profile { radii, heights }, 1.0));
    }
    all
}

/// The form with its numbers.
#[rustfmt::skip]
fn with(form: &Form, n: &[f64]) -> Form {
    match form {
        Form::Sphere { .. } => Form::Sphere { radius: n[0] },
        Form::Power { .. } => Form::Power { factor: n[0], exponent: n[1] },
        Form::RoundedCone { .. } => Form::RoundedCone { slope: n[0], radius: n[1] },
        Form::RoundedPunch { .. } => Form::RoundedPunch { flat: n[0], radius: n[1] },
        Form::FlatCone { .. } => Form::FlatCone { flat: n[0], slope: n[1] },
        other => other.clone(),
    }
}

/// Loads at a given radius on a bare body are the closed forms to 1e-12, from exponents of 0.01, whose load is a hundredth of what it is
/// the difference of, and their derivatives with respect to each number of the tip are their differences of eighth order. The bar
/// of these is that of the differences: rounding of 1e-15 over the step, relative to the part that is small.
#[test]
fn loads_are_closed_forms() -> Result<()> {
    let stack = Stack::plan(&[HalfSpace::new(Elastic::new(1.0, 0.0)?, [])?.into()])?;
    for (form, part) in tips() {
        let tip = Tip::new(form.clone())?;
        let point = Indent::new(&stack, &tip).at_radius(1.0)?;
        let due = load(&form, 1.0);
        near!(point.load, due, 1e-12, form);
        let numbers: Vec<f64> = tip.numbers().iter().map(|(_, value)| *value).collect();
        for k in 0..numbers.len() {
            let step = 0.02 * part * numbers[k].min(1.0);
            let at = |by: f64| {
                let mut moved = numbers.clone();
                moved[k] += by;
                load(&with(&form, &moved), 1.0)
            };
            let due = slope(|n| at(f64::from(n) * step)) / step;
            let variable = Variable::Parameter(IndentParameter::Tip(TipParameter::Number(k)));
            let found = point.derivative(variable, Held::Radius)?.load;
            // The distance of a radius from the end of a sphere is known to the rounding of both.
            let rounding = match form {
                Form::Sphere { radius } => 2.0 * f64::EPSILON / (radius - 1.0),
                _ => 0.0,
            };
            let bar = (1e-9 + rounding) * due.abs() + 1e-14 * point.load / step;
            assert!((found - due).abs() < bar, "{form:?} number {k}: {found} {due}");
        }
    }
    Ok(())
}

/// On layers P' = S δ' along the curve, of loads by moments and approaches at the edge, and 1.5 times as many nodes change neither
/// by more than 1e-10; kinks lie at least 0.1 % from the edge, so that differences of eighth order do not pass them.
#[test]
#[ignore = "slow"]
fn layers_below_profiles_that_are_not_smooth() -> Result<()> {
    for (ratio, h) in [(0.1, 1.0), (10.0, 0.3), (10.0, 0.05), (0.1, 0.015)] {
        let stack = Stack::plan(&[coated(ratio, h)?.into()])?;
        for (form, part) in tips() {
            if part < 1e-3 || matches!(form, Form::Power { exponent, .. } if exponent > 8.0) {
                continue;
            }
            let indent = Indent::new(&stack, &Tip::new(form.clone())?);
            // Stiff layers are lifted off by tips that are flat in their middle.
            let Ok(point) = indent.at_radius(1.0) else {
                assert!(
                    !matches!(form, Form::Sphere { .. } | Form::RoundedCone { .. }),
                    "{form:?} {ratio} {h}"
                );
                continue;
            };
            below!(indent.error_at(&point)?, 1e-10, form, ratio, h);
            if matches!(form, Form::Profile { .. }) {
                continue;
            }
            let step = 0.02 * part.min(h);
            let near: Result<Vec<Point>> =
                (-4..=4).map(|k| indent.at_radius((f64::from(k) * step).exp())).collect();
            // Some are lifted off at larger radii.
            let Ok(near) = near else { continue };
            let at = |k: i32| -> &Point { &near[(4 + k) as usize] };
            let slopes = [slope(|k| at(k).load), slope(|k| at(k).approach)];
            let error = slopes[0] / (point.stiffness * slopes[1]) - 1.0;
            let bar = 1e-10 + 1e-13 / step;
            below!(error.abs(), bar, form, ratio, h);
        }
    }
    Ok(())
}
