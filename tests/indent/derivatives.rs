//! Derivatives of states against two programs and differences.

use nacre::indent::{
    Adhesion, Form, Held, Indent, Parameter, Point, Stack, Tip, TipParameter, Variable,
};
use nacre::{BodyParameter, Elastic, HalfSpace, Interface, Layer, Result};

use super::support::{number, reference};
use crate::support::claims::claim;

/// Derivatives of ln a and ln δ to 1e-9, of the logarithm of the central pressure to 1e-7, under a given load: eleven coated
/// spheres, of complex steps and of polynomials.
#[test]
fn coated_spheres() -> Result<()> {
    let data = reference("sphere_derivatives.json");
    for case in data["cases"].as_array().into_iter().flatten() {
        let get = |key: &str| number(&case[key]);
        let coat = Elastic::new(get("E1"), get("nu1"))?;
        let base = Elastic::new(get("E2"), get("nu2"))?;
        let body = HalfSpace::new(base, [Layer::new(coat, get("h"))?])?;
        let tip = match case["tip"].as_str() {
            Some("sphere") => Tip::sphere(get("R"))?,
            _ => Tip::paraboloid(get("R"))?,
        };
        let stack = Stack::plan(&[body.into()])?;
        let point = Indent::new(&stack, &tip).at_load(get("W"))?;
        assert!((point.radius / get("a") - 1.0).abs() < 1e-9);
        let central = point.pressure(&[0.0])?[0];
        let body = |parameter| Variable::Parameter(Parameter::Body(0, parameter));
        for (key, variable, scale) in [
            ("d/dlnE1", body(BodyParameter::Young(0)), get("E1")),
            ("d/dnu1", body(BodyParameter::Poisson(0)), 1.0),
            ("d/dlnE2", body(BodyParameter::Young(1)), get("E2")),
            ("d/dnu2", body(BodyParameter::Poisson(1)), 1.0),
            ("d/dlnh", body(BodyParameter::Thickness(0)), get("h")),
            (
                "d/dlnR",
                Variable::Parameter(Parameter::Tip(TipParameter::Number(0))),
                get("R"),
            ),
            ("d/dlnW", Variable::Held, get("W")),
        ] {
            let due = &case["derivatives"][key];
            let change = point.derivative(variable, Held::Load)?;
            let of = [
                (
                    "ln_a",
                    change.radius / point.radius,
                    "indentation-derivatives",
                ),
                (
                    "ln_delta",
                    change.approach / point.approach,
                    "indentation-derivatives",
                ),
                (
                    "ln_p0",
                    change.pressure(&[0.0])?[0] / central,
                    "indentation-derivative-of-pressure",
                ),
            ];
            for (name, found, of_claim) in of {
                let (found, due) = (found * scale, number(&due[name]));
                println!("{key} {name}: {found} {due} (E1 {})", get("E1"));
                claim(of_claim, found - due);
            }
        }
    }
    Ok(())
}

/// All numbers of a two-layer body with a slipping interface, an elastic counterbody, several tips and adhesions: derivatives
/// equal differences of fourth order, of radius, load, approach, stiffness, pressure and displacement, whatever is held.
#[test]
fn differences() -> Result<()> {
    let numbers = [4.0, 0.2, 0.3, 0.5, 0.35, 0.7, 1.0, 0.3, 2.0, 0.25];
    let stack = |n: &[f64; 10]| -> Result<Stack> {
        let layers = [
            Layer::new(Elastic::new(n[0], n[1])?, n[2])?,
            Layer::new(Elastic::new(n[3], n[4])?, n[5])?.with_interface(Interface::Frictionless),
        ];
        let body = HalfSpace::new(Elastic::new(n[6], n[7])?, layers)?;
        Stack::plan(&[body.into(), Elastic::new(n[8], n[9])?.into()])
    };
    let forms: [fn(f64, f64) -> Form; 5] = [
        |radius, _| Form::Sphere { radius },
        |slope, radius| Form::RoundedCone {
            slope: 0.05 * slope,
            radius,
        },
        |flat, radius| Form::RoundedPunch {
            flat: 0.1 * flat,
            radius,
        },
        |factor, exponent| Form::Power {
            factor: 0.1 * factor,
            exponent,
        },
        |radius, _| Form::FlatPunch {
            radius: 0.2 * radius,
        },
    ];
    let jkr = Adhesion::Jkr { work: 0.02 };
    for (k, form) in forms.into_iter().enumerate() {
        for adhesion in [Adhesion::None, jkr] {
            if adhesion != Adhesion::None && k > 0 {
                continue;
            }
            let tip_numbers = [3.0, 4.5];
            let solve =
                |n: &[f64; 10], t: [f64; 2], work: f64, held, value: f64| -> Result<Point> {
                    let adhesion = match adhesion {
                        Adhesion::None => Adhesion::None,
                        _ => Adhesion::Jkr { work },
                    };
                    let tip = Tip::new(form(t[0], t[1]))?;
                    let indent = Indent::new(&stack(n)?, &tip).with_adhesion(adhesion)?;
                    match held {
                        Held::Radius => indent.at_radius(value),
                        Held::Load => indent.at_load(value),
                        Held::Approach => indent.at_approach(value),
                    }
                };
            for held in [Held::Load, Held::Approach, Held::Radius] {
                // What is held is one line of the code: a sphere and a punch show it; each pull-off takes as long as fifty points.
                let is_shown = match (k, adhesion) {
                    (0, Adhesion::None) => true,
                    (0, _) => held == Held::Approach,
                    (4, _) => held != Held::Radius,
                    _ => held == Held::Load,
                };
                if !is_shown {
                    continue;
                }
                let value = match held {
                    Held::Radius => 0.6,
                    Held::Load => 0.08,
                    Held::Approach => 0.1,
                };
                let point = solve(&numbers, tip_numbers, 0.02, held, value)?;
                let stack = stack(&numbers)?;
                let mut variables: Vec<Variable> = stack
                    .parameters()
                    .iter()
                    .map(|p| Variable::Parameter(*p))
                    .collect();
                assert_eq!(variables.len(), 10);
                // The interfaces are in order: layer, layer, substrate, counterbody.
                let tips =
                    [0, 1].map(|k| Variable::Parameter(Parameter::Tip(TipParameter::Number(k))));
                let count = Tip::new(form(3.0, 4.5))?.numbers().len();
                variables.extend(&tips[..count]);
                variables.push(Variable::Held);
                if adhesion != Adhesion::None {
                    variables.push(Variable::Parameter(Parameter::Work));
                }
                for (number, variable) in variables.iter().enumerate() {
                    let at = |step: f64| -> Result<Point> {
                        let (mut n, mut t, mut work, mut value) =
                            (numbers, tip_numbers, 0.02, value);
                        match variable {
                            Variable::Held => value *= 1.0 + step,
                            Variable::Parameter(Parameter::Work) => work *= 1.0 + step,
                            Variable::Parameter(Parameter::Tip(TipParameter::Number(k))) => {
                                t[*k] *= 1.0 + step;
                            }
                            _ => n[number] *= 1.0 + step,
                        }
                        solve(&n, t, work, held, value)
                    };
                    let size = match variable {
                        Variable::Held => value,
                        Variable::Parameter(Parameter::Work) => 0.02,
                        Variable::Parameter(Parameter::Tip(TipParameter::Number(i))) => {
                            let tip = Tip::new(form(3.0, 4.5))?;
                            tip.numbers()[*i].1
                        }
                        _ => numbers[number],
                    };
                    let change = point.derivative(*variable, held)?;
                    let (inside, outside) = ([0.3 * point.radius], [1.7 * point.radius]);
                    let of = |p: &Point| -> Result<[f64; 6]> {
                        Ok([
                            p.radius,
                            p.load,
                            p.approach,
                            p.stiffness,
                            p.pressure(&inside)?[0],
                            p.displacement(&outside)?[0],
                        ])
                    };
                    let found = [
                        change.radius,
                        change.load,
                        change.approach,
                        change.stiffness,
                        change.pressure(&inside)?[0],
                        change.displacement(&outside)?[0],
                    ];
                    // Fourth order in 1e-3 leaves 1e-11 of smooth functions, 1e-7 near the kink of a rounded cone; rounding of
                    // 1e-12 in the states leaves 1e-9.
                    let error = if k == 1 { 2e-7 } else { 2e-8 };
                    let h = 1e-3;
                    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|s| at(s * h));
                    let [a, b, c, d] = [of(&a?)?, of(&b?)?, of(&c?)?, of(&d?)?];
                    let sizes = of(&point)?;
                    for i in 0..6 {
                        let due = (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * h);
                        assert!(
                            (found[i] * size - due).abs() < error * (sizes[i].abs() + due.abs()),
                            "tip {k} {adhesion:?} {held:?} {variable:?} {i}: {} {due} of {}",
                            found[i] * size,
                            sizes[i]
                        );
                    }
                }
            }
        }
    }
    Ok(())
}

/// Where a cohesive zone surrounds the contact of a sphere on two layers, one of them slipping, with an elastic counterbody: at
/// fixed radius, derivatives with respect to all numbers equal differences of fourth order, of load, approach, stiffness, outer
/// radius, pressure within the contact and in the zone, and displacement in the zone and beyond. With load or approach held, they
/// are those of fixed radius and along the curve, and equal differences, too.
#[test]
fn cohesive_zones() -> Result<()> {
    let solve = |n: &[f64; 14]| -> Result<Point> {
        let layers = [
            Layer::new(Elastic::new(n[0], n[1])?, n[2])?,
            Layer::new(Elastic::new(n[3], n[4])?, n[5])?.with_interface(Interface::Frictionless),
        ];
        let body = HalfSpace::new(Elastic::new(n[6], n[7])?, layers)?;
        let stack = Stack::plan(&[body.into(), Elastic::new(n[8], n[9])?.into()])?;
        let (work, strength) = (n[11], n[12]);
        Indent::new(&stack, &Tip::sphere(n[10])?)
            .with_adhesion(Adhesion::Maugis { work, strength })?
            .at_radius(n[13])
    };
    let numbers = [
        4.0, 0.2, 0.3, 0.5, 0.35, 0.7, 1.0, 0.3, 2.0, 0.25, 3.0, 0.03, 0.3, 0.6,
    ];
    let point = solve(&numbers)?;
    let outer = point.outer_radius.expect("a cohesive zone");
    // The zone is as wide as a fifth of the contact.
    assert!(outer > 0.65 && outer < 0.85, "{outer}");
    let (inside, outside) = ([0.0, 0.4, 0.61], [0.62, 1.2]);
    let of = |p: &Point| -> Result<Vec<f64>> {
        let zone = p.outer_radius.expect("a cohesive zone");
        let numbers = [p.load, p.approach, p.stiffness, zone];
        Ok([
            &numbers[..],
            &p.pressure(&inside)?,
            &p.displacement(&outside)?,
        ]
        .concat())
    };
    let sizes = of(&point)?;
    let stack_numbers = (0..10).map(|k| match k {
        8 => Parameter::Body(1, BodyParameter::Young(0)),
        9 => Parameter::Body(1, BodyParameter::Poisson(0)),
        _ if k % 3 == 0 => Parameter::Body(0, BodyParameter::Young(k / 3)),
        _ if k % 3 == 1 => Parameter::Body(0, BodyParameter::Poisson(k / 3)),
        _ => Parameter::Body(0, BodyParameter::Thickness(k / 3)),
    });
    let variables = stack_numbers
        .chain([
            Parameter::Tip(TipParameter::Number(0)),
            Parameter::Work,
            Parameter::Strength,
        ])
        .map(Variable::Parameter)
        .chain([Variable::Held]);
    let along = point.derivative(Variable::Held, Held::Radius)?;
    for (number, variable) in variables.enumerate() {
        let change = point.derivative(variable, Held::Radius)?;
        let zone = change.outer_radius.expect("a cohesive zone");
        let found = [change.load, change.approach, change.stiffness, zone];
        let found = [
            &found[..],
            &change.pressure(&inside)?,
            &change.displacement(&outside)?,
        ]
        .concat();
        // Fourth order in 1e-3 leaves 1e-10; states are known to 1e-12, which leaves 1e-9.
        let h = 1e-3;
        let at = |step: f64| {
            let mut n = numbers;
            n[number] *= 1.0 + step * h;
            of(&solve(&n)?)
        };
        let [a, b, c, d] = [at(-2.0)?, at(-1.0)?, at(1.0)?, at(2.0)?];
        for i in 0..found.len() {
            let due = (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * h);
            let error = (found[i] * numbers[number] - due) / (sizes[i].abs() + due.abs());
            println!("{variable:?} {i}: {due} of {}", sizes[i]);
            claim("cohesive-derivatives", error);
        }
        if variable == Variable::Held {
            continue;
        }
        for held in [Held::Load, Held::Approach] {
            let kept = point.derivative(variable, held)?;
            let fixed = [change.load, change.approach];
            let slopes = [along.load, along.approach];
            let rates = [0, 1].map(|k| fixed[k] + slopes[k] * kept.radius);
            for (k, (found, due)) in [kept.load, kept.approach]
                .into_iter()
                .zip(rates)
                .enumerate()
            {
                let size = fixed[k].abs() + (slopes[k] * kept.radius).abs();
                assert!(
                    (found - due).abs() < 1e-12 * size,
                    "{variable:?} {held:?}: {found} {due}"
                );
            }
            let held_rate = if held == Held::Load {
                kept.load
            } else {
                kept.approach
            };
            assert!(held_rate.abs() < 1e-12 * fixed[0].abs().max(fixed[1].abs()));
        }
    }
    Ok(())
}
