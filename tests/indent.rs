//! Indentation against two other programs, Sneddon's closed forms and those of Johnson, Kendall and Roberts.

use std::f64::consts::PI;

use nacre::indent::{Control, Stack, Tip};
use nacre::{Elastic, Error, HalfSpace, Interface, Layer, Response, Result, Substrate};
use serde_json::Value;

/// Numbers of two programs, with digits beyond those that are asked for here.
fn reference(name: &str) -> Value {
    let path = format!("{}/tests/data/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} must be a number"))
}

fn body(case: &Value) -> Result<HalfSpace> {
    let elastic = |v: &Value| Elastic::new(number(&v["young"]), number(&v["poisson"]));
    let layers = case["layers"]
        .as_array()
        .into_iter()
        .flatten()
        .map(|layer| {
            let interface = match layer["interface"].as_str() {
                Some("frictionless") => Interface::Frictionless,
                _ => Interface::Bonded,
            };
            let made = Layer::new(elastic(layer)?, number(&layer["thickness"]))?;
            Ok(made.with_interface(interface))
        });
    let layers: Vec<Layer> = layers.collect::<Result<_>>()?;
    let base = match case["substrate"].is_object() {
        true => Substrate::Elastic(elastic(&case["substrate"])?),
        false => Substrate::Rigid,
    };
    HalfSpace::new(base, layers)
}

fn tip(case: &Value) -> Tip {
    let (radius, n) = (number(&case["tip"]["R"]), number(&case["tip"]["n"]));
    match case["tip"]["kind"].as_str() {
        Some("flat") => Tip::Flat,
        Some("sphere") => Tip::Sphere(radius),
        Some("cone") => Tip::Cone(radius),
        Some("power") => Tip::Power(radius, n),
        _ => Tip::Paraboloid(radius),
    }
}

/// Load, approach, stiffness and its derivative to 1e-10, pressure to 1e-8, on sixteen stacks and tips: both programs
/// agree to 1e-12 and 1e-9. The rule of the nodes is made for 1e-10.
#[test]
fn two_programs_find_the_same() -> Result<()> {
    for case in reference("axisym.json")["cases"]
        .as_array()
        .into_iter()
        .flatten()
    {
        let rows: Vec<&Value> = case["rows"].as_array().into_iter().flatten().collect();
        let most = rows.iter().map(|row| number(&row["a"])).fold(0.0, f64::max);
        let stack = Stack::plan(&[body(case)?.into()], most)?;
        let tip = tip(case);
        let indent = stack.indent(&tip)?;
        for row in rows {
            let a = number(&row["a"]);
            let point = indent.at_radius(a)?;
            let mut pairs = vec![
                (point.stiffness, &row["S"]),
                (point.stiffness_slope, &row["dS_da"]),
            ];
            if tip != Tip::Flat {
                pairs.extend([(point.load, &row["P"]), (point.approach, &row["delta"])]);
            }
            for (found, due) in pairs {
                let error = found / number(due) - 1.0;
                assert!(error.abs() < 1e-10, "{} a {a}: {error:e}", case["name"]);
            }
            let mean = point.load / (PI * a * a);
            for (place, due) in row["p_at_r_over_a"].as_object().into_iter().flatten() {
                let Some(due) = due.as_f64() else { continue };
                let place: f64 = place.parse().unwrap_or(f64::NAN);
                let found = point.pressure(place * a)?;
                assert!(
                    (found - due).abs() < 1e-8 * mean.max(due.abs()),
                    "{} a {a} r {place}: {found} {due}",
                    case["name"]
                );
            }
        }
    }
    Ok(())
}

/// Sneddon's closed forms of a bare body, to rounding: P of the cone, the paraboloid, the sphere, the flat end and rⁿ.
#[test]
fn bare_bodies_are_sneddons() -> Result<()> {
    let body = Elastic::new(3.0, 0.3)?;
    let modulus = body.plane_strain_modulus();
    let stack = Stack::plan(&[HalfSpace::from(body).into()], 2.0)?;
    let a: f64 = 0.7;
    let sphere = modulus * ((a * a + 4.0) * (a / 2.0).atanh() - 2.0 * a);
    // ∫ of s atanh(s/R): Sneddon (1965), §5, eq. (6.15), with R = 2.
    for (tip, load, approach) in [
        (Tip::Flat, 2.0 * modulus * a, 1.0),
        (
            Tip::Paraboloid(5.0),
            4.0 / 3.0 * modulus * a.powi(3) / 5.0,
            a * a / 5.0,
        ),
        (Tip::Sphere(2.0), sphere, a * (a / 2.0).atanh()),
        (
            Tip::Cone(0.2),
            0.5 * PI * modulus * 0.2 * a * a,
            0.5 * PI * 0.2 * a,
        ),
        (
            Tip::Power(0.1, 4.0),
            // δ = B n (√π/2) Γ(2)/Γ(5/2) a⁴ = 8/3 B a⁴, P = 2E* n/(n+1) δ a.
            2.0 * modulus * 0.8 * (8.0 / 3.0 * 0.1 * a.powi(4)) * a,
            8.0 / 3.0 * 0.1 * a.powi(4),
        ),
    ] {
        let point = stack.indent(&tip)?.at_radius(a)?;
        assert!((point.approach / approach - 1.0).abs() < 1e-12, "{tip:?}");
        assert!(
            (point.load / load - 1.0).abs() < 1e-12,
            "{tip:?}: {} {load}",
            point.load
        );
        assert!((point.stiffness / (2.0 * modulus * a) - 1.0).abs() < 1e-12);
    }
    // Hertz' pressure.
    let point = stack.indent(&Tip::Paraboloid(5.0))?.at_radius(a)?;
    for r in [0.0, 0.2, 0.5, 0.69] {
        let due = 2.0 * modulus / PI * a / 5.0 * (1.0 - (r / a).powi(2)).sqrt();
        assert!((point.pressure(r)? / due - 1.0).abs() < 1e-10, "{r}");
    }
    Ok(())
}

/// The load and the approach that a radius gives give the radius back; along the curve dP/dδ = S.
#[test]
fn radius_load_and_approach_are_one() -> Result<()> {
    let (soft, hard) = (Elastic::new(1.0, 0.3)?, Elastic::new(9.0, 0.2)?);
    let body = HalfSpace::new(soft, [Layer::new(hard, 0.4)?])?;
    let stack = Stack::plan(&[body.into(), HalfSpace::from(hard).into()], 1.5)?;
    for tip in [
        Tip::Paraboloid(10.0),
        Tip::Cone(0.1),
        Tip::RoundedCone(0.1, 2.0),
        Tip::RoundedPunch(0.1, 8.0),
    ] {
        let indent = stack.indent(&tip)?;
        for a in [0.15, 0.6, 1.2] {
            let point = indent.at_radius(a)?;
            for again in [
                indent.at_load(point.load)?,
                indent.at_approach(point.approach)?,
            ] {
                assert!(
                    (again.radius / a - 1.0).abs() < 1e-11,
                    "{tip:?} {a}: {}",
                    again.radius
                );
            }
            let [low, high] = [
                indent.at_radius(a * (1.0 - 1e-4))?,
                indent.at_radius(a * (1.0 + 1e-4))?,
            ];
            let slope = (high.load - low.load) / (high.approach - low.approach);
            // The differences are of second order in 1e-4, of cones of first in the rounding 1e-12.
            assert!((slope / point.stiffness - 1.0).abs() < 1e-6, "{tip:?} {a}");
        }
    }
    Ok(())
}

/// Johnson, Kendall and Roberts on a bare body: the load at any radius, pull-off at 1.5 πwR and at 5/6 of πwR.
#[test]
fn adhesion_on_a_bare_body() -> Result<()> {
    let body = Elastic::new(1.0, 0.3)?;
    let (modulus, radius, w) = (body.plane_strain_modulus(), 10.0, 1e-3);
    let stack = Stack::plan(&[HalfSpace::from(body).into()], 3.0)?;
    let indent = stack.indent(&Tip::Paraboloid(radius))?;
    for a in [0.1, 0.4, 1.5] {
        let point = indent.adhering_at(a, w)?;
        let due = 4.0 * modulus * a.powi(3) / (3.0 * radius)
            - (8.0 * PI * w * modulus * a.powi(3)).sqrt();
        assert!(
            (point.load - due).abs() < 1e-12 * due.abs(),
            "{a}: {} {due}",
            point.load
        );
    }
    let scale = PI * w * radius;
    for (control, due) in [(Control::Load, 1.5), (Control::Approach, 5.0 / 6.0)] {
        let found = indent.pull_off(w, control)?;
        // A minimum is known to the square root of rounding, in radius; its load under load control to rounding.
        let error = if control == Control::Load {
            1e-12
        } else {
            1e-7
        };
        assert!(
            (-found.point.load / scale - due).abs() < error,
            "{control:?}: {}",
            found.point.load / scale
        );
    }
    Ok(())
}

/// Pull-off and whole curves on coated bodies, of an edge condition and of an energy form, which agree to 1e-13.
#[test]
fn adhesion_on_coated_bodies() -> Result<()> {
    let data = reference("jkr.json");
    // E2* = 1, R = 1, and w so that a0 = 1: a0³ = 9πwR²/8E2*.
    let w = 8.0 / (9.0 * PI);
    let substrate = Elastic::new(1.0 - 0.09, 0.3)?;
    let plan = |ratio: f64, h: f64, most: f64| {
        let coat = Elastic::new(ratio * substrate.young(), 0.3)?;
        Stack::plan(
            &[HalfSpace::new(substrate, [Layer::new(coat, h)?])?.into()],
            most,
        )
    };
    for row in data["table"].as_array().into_iter().flatten() {
        let (ratio, h) = (number(&row["E1_over_E2"]), number(&row["h_over_a0"]));
        let stack = plan(ratio, h, 5.0)?;
        let indent = stack.indent(&Tip::Paraboloid(1.0))?;
        for (control, key) in [
            (Control::Load, "load_control"),
            (Control::Approach, "displacement_control"),
        ] {
            let Some(due) = row[key]["pull_off_over_piwR"].as_f64() else {
                continue;
            };
            let found = indent.pull_off(w, control)?;
            let load = -found.point.load / (PI * w);
            let error = if control == Control::Load { 1e-9 } else { 1e-6 };
            assert!(
                (load - due).abs() < error,
                "{ratio} {h} {control:?}: {load} {due}"
            );
        }
    }
    for curve in data["curves"].as_array().into_iter().flatten() {
        let (ratio, h) = (number(&curve["E1_over_E2"]), number(&curve["h_over_a0"]));
        let stack = plan(ratio, h, 5.0)?;
        let indent = stack.indent(&Tip::Paraboloid(1.0))?;
        for row in curve["rows"].as_array().into_iter().flatten() {
            let [a, load, approach] = [0, 1, 2].map(|k| number(&row[k]));
            let point = indent.adhering_at(a, w)?;
            assert!((point.load / (PI * w) - load).abs() < 1e-9 * load.abs().max(1.0));
            assert!((point.approach - approach).abs() < 1e-9 * approach.abs().max(1.0));
        }
    }
    Ok(())
}

/// Wrong numbers are refused with the argument, what it must be and what it was.
#[test]
fn wrong_input_is_refused() -> Result<()> {
    let coated = HalfSpace::new(
        Elastic::new(1.0, 0.3)?,
        [Layer::new(Elastic::new(2.0, 0.3)?, 0.1)?],
    )?;
    assert_eq!(coated.lengths().map(|[top, _]| top), Some(0.1));
    let message = |result: Result<Stack>| {
        result
            .err()
            .map(|error| error.to_string())
            .unwrap_or_default()
    };
    assert!(message(Stack::plan(&[], 1.0)).contains("at least one"));
    assert!(message(Stack::plan(&[coated.clone().into()], 0.0)).contains("largest contact radius"));
    assert!(message(Stack::plan(&[coated.clone().into()], 2e3)).contains("at most 1e4 times"));
    let stack = Stack::plan(&[coated.into()], 1.0)?;
    assert!(stack.indent(&Tip::Cone(0.0)).is_err());
    let indent = stack.indent(&Tip::Sphere(0.5))?;
    assert!(matches!(
        indent.at_radius(0.5),
        Err(Error::Parameter {
            name: "contact radius",
            ..
        })
    ));
    assert!(indent.at_radius(-1.0).is_err() && indent.at_load(1e9).is_err());
    assert!(indent.at_radius(0.3)?.pressure(-1.0).is_err());
    assert!(stack.indent(&Tip::Flat)?.at_load(1.0).is_err());
    Ok(())
}
