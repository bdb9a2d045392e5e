//! Adhesion against the closed forms of Johnson, Kendall, Roberts and Maugis, two programs and the energy.

use std::f64::consts::PI;

use nacre::indent::{Adhesion, Branch, Control, Indent, Stack, Tip};
use nacre::{Elastic, Result};

use super::coated;

use crate::support::claims::claim;
use crate::support::numerics::{slope, unit_rule};
use crate::support::reference::{float, list, number, read};

/// Work of adhesion with which a0 = 1 where E2* = R = 1: a0³ = 9πwR²/8E2*.
const WORK: f64 = 8.0 / (9.0 * PI);

/// Johnson, Kendall and Roberts on a bare body: the load at any radius, pull-off at 1.5 πwR and at 5/6 of πwR.
#[test]
fn jkr_on_a_bare_body() -> Result<()> {
    let body = Elastic::new(1.0, 0.3)?;
    let (modulus, radius, work) = (body.plane_strain_modulus(), 10.0, 1e-3);
    let stack = Stack::plan(&[body.into()])?;
    let tip = Tip::paraboloid(radius)?;
    let indent = Indent::new(&stack, &tip).with_adhesion(Adhesion::Jkr { work })?;
    for a in [0.1, 0.4, 1.5] {
        let point = indent.at_radius(a)?;
        let due = 4.0 * modulus * a.powi(3) / (3.0 * radius)
            - (8.0 * PI * work * modulus * a.powi(3)).sqrt();
        claim("jkr-bare", point.load / due - 1.0);
        // The energy form and the edge form are the same.
        let edge = -(2.0 * a * modulus * work / PI).sqrt();
        let near = a * (1.0 - 1e-9);
        let singular = edge / (a * a - near * near).sqrt();
        near!(point.pressure(&[near])?[0], singular, 1e-4);
    }
    let scale = PI * work * radius;
    for (control, due) in [(Control::Load, 1.5), (Control::Approach, 5.0 / 6.0)] {
        let found = indent.pull_off(control)?;
        claim("jkr-bare", -found.load / scale - due);
        let again = indent.work_from_pull_off(-found.load, control)?;
        near!(again, work, 1e-9, control);
    }
    // Under no load: a³ = 9πwR²/2E*, and the tip jumps there.
    let jumped = indent.snap_in(Control::Load)?;
    let due = (4.5 * PI * work * radius * radius / modulus).cbrt();
    near!(jumped.radius, due, 1e-12);
    Ok(())
}

/// Pull-off and whole curves on coated bodies, of an edge condition and of an energy form, which agree to 1e-13.
#[test]
fn jkr_on_coated_bodies() -> Result<()> {
    let data = read("jkr.json");
    let indent = |ratio: f64, h: f64| -> Result<Indent> {
        let stack = Stack::plan(&[coated(ratio, h)?.into()])?;
        Indent::new(&stack, &Tip::paraboloid(1.0)?).with_adhesion(Adhesion::Jkr { work: WORK })
    };
    for row in list(&data, "table") {
        let (ratio, h) = (number(row, "E1_over_E2"), number(row, "h_over_a0"));
        let indent = indent(ratio, h)?;
        for (control, key) in
            [(Control::Load, "load_control"), (Control::Approach, "displacement_control")]
        {
            let Some(due) = row[key]["pull_off_over_piwR"].as_f64() else {
                continue;
            };
            let load = -indent.pull_off(control)?.load / (PI * WORK);
            claim("jkr-coated", load - due);
        }
    }
    for curve in list(&data, "curves") {
        let (ratio, h) = (number(curve, "E1_over_E2"), number(curve, "h_over_a0"));
        let indent = indent(ratio, h)?;
        for row in list(curve, "rows") {
            let [a, load, approach] = [0, 1, 2].map(|k| float(&row[k]).expect("a number"));
            let point = indent.at_radius(a)?;
            let error = (point.load / (PI * WORK) - load) / load.abs().max(1.0);
            claim("jkr-coated", error);
            let error = (point.approach - approach) / approach.abs().max(1.0);
            claim("jkr-coated", error);
            // The energy form: w = S' (δ − δ_H)²/4πa.
            let without = Indent::new(indent.stack(), indent.tip()).at_radius(a)?;
            let apart = point.approach - without.approach;
            let work = point.stiffness_slope * apart * apart / (4.0 * PI * a);
            near!(work, WORK, 1e-9);
        }
    }
    Ok(())
}

/// Both branches have the load that was asked for, the stable one the larger radius, and meet at pull-off.
#[test]
fn branches_of_the_curve() -> Result<()> {
    let stack = Stack::plan(&[coated(4.0, 0.5)?.into()])?;
    let tip = Tip::paraboloid(1.0)?;
    let indent = Indent::new(&stack, &tip).with_adhesion(Adhesion::Jkr { work: WORK })?;
    let last = indent.pull_off(Control::Load)?;
    for part in [0.5, 0.9, 0.999] {
        let load = part * last.load;
        let [stable, unstable] =
            [Branch::Stable, Branch::Unstable].map(|branch| indent.at(Control::Load, load, branch));
        let (stable, unstable) = (stable?, unstable?);
        near!(stable.load, load, 1e-10);
        near!(unstable.load, load, 1e-10);
        assert!(stable.radius > last.radius && unstable.radius < last.radius);
    }
    assert!(indent.at_load(1.001 * last.load).is_err());
    Ok(())
}

/// Pull-off by Maugis's closed form of the bare body, the coated rows of a program of seven digits, and both limits: those of
/// Johnson, Kendall and Roberts where the strength is large for the top layer, and 2πwR where it is small.
#[test]
#[ignore = "slow"]
fn maugis_on_bare_and_coated_bodies() -> Result<()> {
    let data = read("maugis.json");
    let tip = Tip::paraboloid(1.0)?;
    // λ = σ0 (9R/2πwE2*²)^{1/3}
    let strength = |lambda: f64| lambda / (9.0 / (2.0 * PI * WORK)).cbrt();
    let pull_off = |stack: &Stack, lambda: f64| -> Result<f64> {
        let (work, strength) = (WORK, strength(lambda));
        let adhesion = Adhesion::Maugis { work, strength };
        let indent = Indent::new(stack, &tip).with_adhesion(adhesion)?;
        Ok(-indent.pull_off(Control::Load)?.load / (PI * WORK))
    };
    let bare = Stack::plan(&[Elastic::new(0.91, 0.3)?.into()])?;
    for row in list(&data, "bare") {
        let (lambda, due) = (number(row, "lambda_"), number(row, "pull_off_over_piwR"));
        claim("maugis-bare", pull_off(&bare, lambda)? - due);
    }
    for case in list(&data, "coated") {
        let (ratio, h) = (number(case, "E1_over_E2"), number(case, "h_over_a0"));
        let stack = Stack::plan(&[coated(ratio, h)?.into()])?;
        for row in list(case, "rows") {
            let (lambda, due) = (number(row, "lambda_"), number(row, "pull_off_over_piwR"));
            claim("maugis-coated", pull_off(&stack, lambda)? - due);
        }
        let jkr = Indent::new(&stack, &tip).with_adhesion(Adhesion::Jkr { work: WORK })?;
        let due = -jkr.pull_off(Control::Load)?.load / (PI * WORK);
        // λ of the top layer is λ (E2*/E1*)^{2/3}.
        let top = ratio.powf(2.0 / 3.0);
        claim("maugis-jkr", pull_off(&stack, 100.0 * top)? / due - 1.0);
        claim("maugis-dmt", pull_off(&stack, 0.002 * top)? / 2.0 - 1.0);
    }
    Ok(())
}

/// With a cohesive zone the load is the derivative of the energy: U = ½ ∫ p u dA of the elastic bodies, − w on the contact and
/// −(w − σ₀ g) where the gap is g < w/σ₀.
#[test]
fn the_load_is_the_derivative_of_the_energy() -> Result<()> {
    let (work, strength) = (WORK, 0.35);
    for stack in [
        Stack::plan(&[coated(4.0, 0.5)?.into()])?,
        Stack::plan(&[Elastic::new(0.91, 0.3)?.into()])?,
    ] {
        let indent = Indent::new(&stack, &Tip::paraboloid(1.0)?)
            .with_adhesion(Adhesion::Maugis { work, strength })?;
        let energy = |a: f64| -> Result<[f64; 3]> {
            let point = indent.at_radius(a)?;
            let outer = point.outer_radius.unwrap_or(a);
            // r = a sin θ and r = a + (c − a) sin²θ take away the roots at a and c.
            let quarter = 0.5 * PI;
            let rule = unit_rule(80);
            let angles: Vec<f64> = rule.iter().map(|[x, _]| quarter * x).collect();
            let inside: Vec<f64> = angles.iter().map(|angle| a * angle.sin()).collect();
            let (pressure, displaced) = (point.pressure(&inside)?, point.displacement(&inside)?);
            let mut sum = 0.0;
            for (k, angle) in angles.iter().enumerate() {
                let density = 0.5 * pressure[k] * displaced[k] - work;
                let area = 2.0 * PI * inside[k] * a * angle.cos() * quarter * rule[k][1];
                sum += density * area;
            }
            let width = outer - a;
            let zone = angles.iter().map(|angle| a + width * angle.sin().powi(2));
            let zone: Vec<f64> = zone.collect();
            let (displaced, gap) = (point.displacement(&zone)?, point.gap(&zone)?);
            for (k, angle) in angles.iter().enumerate() {
                let density = -0.5 * strength * displaced[k] - (work - strength * gap[k]);
                let radial = width * (2.0 * angle).sin() * quarter * rule[k][1];
                sum += density * 2.0 * PI * zone[k] * radial;
            }
            Ok([sum, point.approach, point.load])
        };
        for a in [0.6, 1.3] {
            // Differences of eighth order in 0.02 of a leave 1e-10, and the quadratures some 1e-7.
            let near: Vec<[f64; 3]> =
                (-4..=4).map(|k| energy(a * (1.0 + 0.02 * f64::from(k)))).collect::<Result<_>>()?;
            let along = |quantity: usize| slope(|k| near[(4 + k) as usize][quantity]);
            let (found, due) = (along(0) / along(1), near[4][2]);
            below!((found - due).abs(), 1e-6 * due.abs().max(1.0), a);
        }
    }
    Ok(())
}

/// Stresses on the axis below a contact with a cohesive zone, on a bare body: σ_zz of the pressures by Boussinesq's
/// −3z³ ∫ p r/(r²+z²)^{5/2} dr (Johnson, Contact Mechanics (1985), eq. (3.20)), of which the zone's part is a closed form.
#[test]
fn stresses_with_a_cohesive_zone() -> Result<()> {
    let stack = Stack::plan(&[Elastic::new(1.0, 0.3)?.into()])?;
    let adhesion = Adhesion::Maugis { work: 0.02, strength: 0.1 };
    let indent = Indent::new(&stack, &Tip::paraboloid(2.0)?).with_adhesion(adhesion)?;
    let point = indent.at_radius(0.5)?;
    let (a, c) = (0.5, point.outer_radius.expect("a cohesive zone"));
    // Midpoints in r = a sin θ, which takes the root at the edge away.
    let count = 2000;
    let step = 0.5 * PI / f64::from(count);
    let angles: Vec<f64> = (0..count).map(|k| (f64::from(k) + 0.5) * step).collect();
    let r: Vec<f64> = angles.iter().map(|angle| a * angle.sin()).collect();
    let pressures = point.pressure(&r)?;
    for z in [0.005_f64, 0.1, 0.5, 3.0] {
        let inside: f64 = r
            .iter()
            .zip(&pressures)
            .zip(&angles)
            .map(|((r, p), angle)| p * r * a * angle.cos() * step / (r * r + z * z).powf(2.5))
            .sum();
        // Euler and Maclaurin's term of the midpoint rule: slopes over θ at the edge, where the pressure is −σ₀, and on the axis.
        let slopes = 0.1 * a * a / (a * a + z * z).powf(2.5) - pressures[0] * a * a / z.powi(5);
        let inside = inside + step * step / 24.0 * slopes;
        let end = |r: f64| -1.0 / (3.0 * (r * r + z * z).powf(1.5));
        let due = -3.0 * z.powi(3) * (inside - 0.1 * (end(c) - end(a)));
        let found = point.stress(0, z, &[0.0])?[0].zz;
        // The next term: 4e-5 at the smallest depth, below 1e-9 at the others.
        let error = 1e-8 + (step * a / z).powi(4);
        below!((found - due).abs(), error * pressures[0], z, found, due);
        if z >= 0.1 {
            claim("cohesive-stress", (found - due) / pressures[0]);
        }
    }
    Ok(())
}
