//! Derivatives of states against two programs and differences.

use std::f64::consts::PI;

use nacre::indent::{
    Adhesion, Form, Held, Indent, IndentParameter, Point, Stack, Tip, TipParameter, Variable,
};
use nacre::{BodyParameter, Elastic, HalfSpace, Interface, Layer, Result};

use crate::support::claims::claim;
use crate::support::reference::{list, number, read};
use crate::support::settings;

/// Closed forms of a few dozen operations.
const ROUNDING: f64 = 1e-12;

/// Derivatives of ln a and ln δ to 1e-9, of the logarithm of the central pressure to 1e-7, under a given load: eleven coated
/// spheres, of complex steps and of polynomials.
#[test]
fn coated_spheres() -> Result<()> {
    let data = read("sphere_derivatives.json");
    for case in list(&data, "cases") {
        let get = |key: &str| number(case, key);
        let base = Elastic::new(get("E2"), get("nu2"))?;
        let body = settings::stack(base, [[get("E1"), get("nu1"), get("h")]])?;
        let tip = match case["tip"].as_str() {
            Some("sphere") => Tip::sphere(get("R"))?,
            _ => Tip::paraboloid(get("R"))?,
        };
        let stack = Stack::plan(&[body.into()])?;
        let point = Indent::new(&stack, &tip).at_load(get("W"))?;
        near!(point.radius, get("a"), 1e-9);
        let central = point.pressure(&[0.0])?[0];
        let body = |parameter| Variable::Parameter(IndentParameter::Body(0, parameter));
        let radius = Variable::Parameter(IndentParameter::Tip(TipParameter::Number(0)));
        for (key, variable, scale) in [
            ("d/dlnE1", body(BodyParameter::Young(0)), get("E1")),
            ("d/dnu1", body(BodyParameter::Poisson(0)), 1.0),
            ("d/dlnE2", body(BodyParameter::Young(1)), get("E2")),
            ("d/dnu2", body(BodyParameter::Poisson(1)), 1.0),
            ("d/dlnh", body(BodyParameter::Thickness(0)), get("h")),
            ("d/dlnR", radius, get("R")),
            ("d/dlnW", Variable::Held, get("W")),
        ] {
            let due = &case["derivatives"][key];
            let change = point.derivative(variable, Held::Load)?;
            let pressure = change.pressure(&[0.0])?[0] / central;
            for (name, found, of_claim) in [
                ("ln_a", change.radius / point.radius, "indentation-derivatives"),
                ("ln_delta", change.approach / point.approach, "indentation-derivatives"),
                ("ln_p0", pressure, "indentation-derivative-of-pressure"),
            ] {
                claim(of_claim, found * scale - number(due, name));
            }
        }
    }
    Ok(())
}

/// A body of two layers, the lower of which slips, and a counterbody.
fn stack(n: &[f64]) -> Result<Stack> {
    let layers = [
        Layer::new(Elastic::new(n[0], n[1])?, n[2])?,
        Layer::new(Elastic::new(n[3], n[4])?, n[5])?.with_interface(Interface::Frictionless),
    ];
    let body = HalfSpace::new(Elastic::new(n[6], n[7])?, layers)?;
    Stack::plan(&[body.into(), Elastic::new(n[8], n[9])?.into()])
}

/// Numbers of such a stack.
const STACK: [f64; 10] = [4.0, 0.2, 0.3, 0.5, 0.35, 0.7, 1.0, 0.3, 2.0, 0.25];

/// Derivatives in the logarithms of numbers that `at` moves by a part, from differences of fourth order.
fn slopes(at: impl Fn(f64) -> Result<Vec<f64>>) -> Result<Vec<f64>> {
    let h = 1e-3;
    let [a, b, c, d] = [at(-2.0 * h)?, at(-h)?, at(h)?, at(2.0 * h)?];
    let slope = |i: usize| (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * h);
    Ok((0..a.len()).map(slope).collect())
}

/// The stack, the two numbers of a tip, the work of adhesion, and what is held.
type Numbers = [f64; 14];

/// All numbers of a two-layer body with a slipping interface, an elastic counterbody, several tips and adhesions: derivatives
/// equal differences of fourth order, of radius, load, approach, stiffness, pressure and displacement, whatever is held.
#[test]
#[ignore = "slow"]
fn differences() -> Result<()> {
    #[rustfmt::skip]
    let forms: [fn(f64, f64) -> Form; 5] = [
        |radius, _| Form::Sphere { radius },
        |slope, radius| Form::RoundedCone { slope: 0.05 * slope, radius },
        |flat, radius| Form::RoundedPunch { flat: 0.1 * flat, radius },
        |factor, exponent| Form::Power { factor: 0.1 * factor, exponent },
        |radius, _| Form::FlatPunch { radius: 0.2 * radius },
    ];
    // What is held is one line of the code: a sphere and a punch show it; each pull-off takes as long as fifty points.
    let (load, approach, radius) = (Held::Load, Held::Approach, Held::Radius);
    for (k, adheres, held) in [
        (0, false, load),
        (0, false, approach),
        (0, false, radius),
        (0, true, approach),
        (1, false, load),
        (2, false, load),
        (3, false, load),
        (4, false, load),
        (4, false, approach),
    ] {
        let solve = |n: &Numbers| -> Result<Point> {
            let adhesion = match adheres {
                true => Adhesion::Jkr { work: n[12] },
                false => Adhesion::None,
            };
            let tip = Tip::new(forms[k](n[10], n[11]))?;
            let indent = Indent::new(&stack(n)?, &tip).with_adhesion(adhesion)?;
            match held {
                Held::Radius => indent.at_radius(n[13]),
                Held::Load => indent.at_load(n[13]),
                Held::Approach => indent.at_approach(n[13]),
            }
        };
        let value = match held {
            Held::Radius => 0.6,
            Held::Load => 0.08,
            Held::Approach => 0.1,
        };
        let mut numbers: Numbers = [0.0; 14];
        numbers[..10].copy_from_slice(&STACK);
        numbers[10..].copy_from_slice(&[3.0, 4.5, 0.02, value]);
        let point = solve(&numbers)?;
        // The interfaces are in order: layer, layer, substrate, counterbody.
        let mut variables: Vec<(usize, Variable)> = Vec::new();
        let of_stack = stack(&numbers)?.parameters().to_vec();
        assert_eq!(of_stack.len(), 10);
        variables.extend(of_stack.iter().map(|one| Variable::Parameter(*one)).enumerate());
        let tip = Tip::new(forms[k](3.0, 4.5))?;
        for i in 0..tip.numbers().len() {
            let number = IndentParameter::Tip(TipParameter::Number(i));
            variables.push((10 + i, Variable::Parameter(number)));
        }
        if adheres {
            variables.push((12, Variable::Parameter(IndentParameter::Work)));
        }
        variables.push((13, Variable::Held));
        for (number, variable) in variables {
            // Numbers of a tip may be parts of those of its form.
            let size = match number {
                10 | 11 => tip.numbers()[number - 10].1,
                _ => numbers[number],
            };
            let (inside, outside) = ([0.3 * point.radius], [1.7 * point.radius]);
            let of = |p: &Point| -> Result<Vec<f64>> {
                let numbers = vec![p.radius, p.load, p.approach, p.stiffness];
                Ok([numbers, p.pressure(&inside)?, p.displacement(&outside)?].concat())
            };
            let change = point.derivative(variable, held)?;
            let found = [change.radius, change.load, change.approach, change.stiffness];
            let (pressure, displacement) =
                (change.pressure(&inside)?, change.displacement(&outside)?);
            let found = [&found[..], &pressure, &displacement].concat();
            let due = slopes(|step| {
                let mut moved = numbers;
                moved[number] *= 1.0 + step;
                of(&solve(&moved)?)
            })?;
            // Fourth order in 1e-3 leaves 1e-11 of smooth functions, 1e-7 near the kink of a rounded cone; rounding of
            // 1e-12 in the states leaves 1e-9.
            let error = if k == 1 { 2e-7 } else { 2e-8 };
            for (i, size_of) in of(&point)?.into_iter().enumerate() {
                let bar = error * (size_of.abs() + due[i].abs());
                below!((found[i] * size - due[i]).abs(), bar, k, adheres, held, variable, i);
            }
        }
    }
    Ok(())
}

/// The sphere of Derjaguin, Muller and Toporov on a bare body: F = 4/3 E* √R δ^{3/2} − 2πwR at a given approach; κ times the
/// area of all sections is κ times the radius.
#[test]
fn force_around_the_contact() -> Result<()> {
    let body = Elastic::new(1.0, 0.3)?;
    let (radius, work, approach) = (10.0, 1e-3, 0.02_f64);
    let tip = Tip::paraboloid(radius)?;
    let indent =
        Indent::new(&Stack::plan(&[body.into()])?, &tip).with_adhesion(Adhesion::Dmt { work })?;
    let point = indent.at_approach(approach)?;
    let pressed = 4.0 / 3.0 * body.plane_strain_modulus() * radius.sqrt() * approach.powf(1.5);
    near!(point.load, pressed - 2.0 * PI * work * radius, ROUNDING);
    let by_radius = 0.5 * pressed / radius - 2.0 * PI * work;
    for (parameter, due) in [
        (IndentParameter::Tip(TipParameter::Number(0)), by_radius),
        (IndentParameter::Tip(TipParameter::Area), radius * by_radius),
        (IndentParameter::Work, -2.0 * PI * radius),
    ] {
        let change = point.derivative(Variable::Parameter(parameter), Held::Approach)?;
        near!(change.load, due, ROUNDING, parameter);
    }
    Ok(())
}

/// Where a cohesive zone surrounds the contact of a sphere on two layers, one of them slipping, with an elastic counterbody: at
/// fixed radius, derivatives with respect to all numbers equal differences of fourth order, of load, approach, stiffness, outer
/// radius, pressure within the contact and in the zone, and displacement in the zone and beyond. With load or approach held, they
/// are those of fixed radius and along the curve, and equal differences, too.
#[test]
fn cohesive_zones() -> Result<()> {
    let solve = |n: &Numbers| -> Result<Point> {
        let (work, strength) = (n[11], n[12]);
        Indent::new(&stack(n)?, &Tip::sphere(n[10])?)
            .with_adhesion(Adhesion::Maugis { work, strength })?
            .at_radius(n[13])
    };
    let mut numbers: Numbers = [0.0; 14];
    numbers[..10].copy_from_slice(&STACK);
    numbers[10..].copy_from_slice(&[3.0, 0.03, 0.3, 0.6]);
    let point = solve(&numbers)?;
    let outer = point.outer_radius.expect("a cohesive zone");
    // The zone is as wide as a fifth of the contact.
    assert!(outer > 0.65 && outer < 0.85, "{outer}");
    let (inside, outside) = ([0.0, 0.4, 0.61], [0.62, 1.2]);
    let of = |p: &Point| -> Result<Vec<f64>> {
        let zone = p.outer_radius.expect("a cohesive zone");
        let numbers = [p.load, p.approach, p.stiffness, zone];
        Ok([&numbers[..], &p.pressure(&inside)?, &p.displacement(&outside)?].concat())
    };
    let sizes = of(&point)?;
    let of_stack = stack(&numbers)?.parameters().to_vec();
    let radius = IndentParameter::Tip(TipParameter::Number(0));
    let others = [radius, IndentParameter::Work, IndentParameter::Strength];
    let variables = of_stack.into_iter().chain(others).map(Variable::Parameter);
    let variables = variables.chain([Variable::Held]);
    let along = point.derivative(Variable::Held, Held::Radius)?;
    for (number, variable) in variables.enumerate() {
        let change = point.derivative(variable, Held::Radius)?;
        let zone = change.outer_radius.expect("a cohesive zone");
        let found = [change.load, change.approach, change.stiffness, zone];
        let found =
            [&found[..], &change.pressure(&inside)?, &change.displacement(&outside)?].concat();
        // Fourth order in 1e-3 leaves 1e-10; states are known to 1e-12, which leaves 1e-9.
        let due = slopes(|step| {
            let mut moved = numbers;
            moved[number] *= 1.0 + step;
            of(&solve(&moved)?)
        })?;
        for (i, due) in due.into_iter().enumerate() {
            let error = (found[i] * numbers[number] - due) / (sizes[i].abs() + due.abs());
            claim("cohesive-derivatives", error);
        }
        if variable == Variable::Held {
            continue;
        }
        for held in [Held::Load, Held::Approach] {
            let kept = point.derivative(variable, held)?;
            let fixed = [change.load, change.approach];
            let slopes = [along.load, along.approach];
            let found = [kept.load, kept.approach];
            for k in 0..2 {
                let moved = slopes[k] * kept.radius;
                let size = fixed[k].abs() + moved.abs();
                below!((found[k] - fixed[k] - moved).abs(), 1e-12 * size, variable, held, k);
            }
            let rate = if held == Held::Load { kept.load } else { kept.approach };
            below!(rate.abs(), 1e-12 * fixed[0].abs().max(fixed[1].abs()));
        }
    }
    Ok(())
}
