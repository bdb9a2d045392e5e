//! Thin and thick layers, soft and hard ones, random stacks: identities, two resolutions, and the stated error.

use nacre::indent::{Form, Indent, Point, Stack, Tip};
use nacre::{Elastic, HalfSpace, Interface, Layer, Result, Substrate};

use super::coated;

use crate::support::claims::claim;
use crate::support::numerics::slope;

/// Layers from 1e-3 to 1e3 of the contact radius, moduli from 1e-3 to 1e3 of the substrate's: no failure, P' = S δ' by
/// differences, and 1.5 times as many nodes change load, approach and stiffness by less than 1e-9.
#[test]
#[ignore = "slow"]
fn all_thicknesses_and_moduli() -> Result<()> {
    for ratio in [1e-3, 0.1, 10.0, 1e3] {
        for h in [1e-3, 0.02, 0.3, 10.0, 1e3] {
            // The thinnest layers take seconds.
            if h < 0.01 && (0.01..100.0).contains(&ratio) {
                continue;
            }
            let stack = Stack::plan(&[coated(ratio, h)?.into()])?;
            let indent = Indent::new(&stack, &Tip::paraboloid(10.0)?);
            let point = indent.at_radius(1.0)?;
            assert!(point.load > 0.0 && point.approach > 0.0);
            if h >= 0.01 {
                below!(indent.error_at(&point)?, 1e-9, ratio, h);
            }
            // Both limits: a layer that is thin or thick counts as none. Moduli of h/a = 1e±3 differ from these by some h/a
            // times the contrast.
            let modulus = if h > 1.0 { ratio } else { 1.0 };
            let bare = 4.0 / 3.0 * modulus / 10.0;
            let contrast = ratio.max(1.0 / ratio);
            let share = if h > 1.0 { 1.0 / h } else { h };
            if share * contrast <= 0.02 {
                near!(point.load, bare, 3.0 * share * contrast, ratio, h);
            }
        }
    }
    Ok(())
}

/// Two hundred random stacks of up to four layers, rigid bases and slipping interfaces among them, with random tips: P_H' = S δ_H'
/// and S' = 2π²φ₁²/E* by differences, and two resolutions agree, each to 1e-10.
#[test]
fn random_stacks() -> Result<()> {
    let mut state = 12345_u64;
    let mut random = move || {
        // Knuth's linear congruence, upper bits.
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut refused = 0;
    for case in 0..200 {
        let count = 1 + (4.0 * random()) as usize;
        let mut layers = Vec::new();
        for _ in 0..count {
            let material = Elastic::new(10.0_f64.powf(2.0 * random() - 1.0), 0.5 * random())?;
            let interface = match random() < 0.2 {
                true => Interface::Frictionless,
                false => Interface::Bonded,
            };
            let thickness = 10.0_f64.powf(1.5 * random() - 1.0);
            layers.push(Layer::new(material, thickness)?.with_interface(interface));
        }
        let base = match random() < 0.3 {
            true => Substrate::Rigid,
            false => Substrate::Elastic(Elastic::new(1.0, 0.49 * random())?),
        };
        let stack = Stack::plan(&[HalfSpace::new(base, layers)?.into()])?;
        let (factor, exponent) = (0.1, 4.0);
        let fourth = Form::Power { factor, exponent };
        let tip = match (4.0 * random()) as usize {
            0 => Tip::sphere(8.0)?,
            1 => Tip::cone(0.2)?,
            2 => Tip::new(fourth)?,
            _ => Tip::paraboloid(5.0)?,
        };
        let a = 10.0_f64.powf(1.5 * random() - 1.2);
        let indent = Indent::new(&stack, &tip);
        let point = match indent.at_radius(a) {
            Ok(point) => point,
            // A tip that is flat in its middle may touch on a ring.
            Err(error) => {
                assert!(error.to_string().contains("no disc"), "{case}: {error}");
                assert!(matches!(tip.form(), Form::Power { .. }), "{case}");
                refused += 1;
                continue;
            }
        };
        claim("random-stacks", indent.error_at(&point)?);
        // Differences of eighth order in 0.02 of ln a leave some 1e-12, and the rounding of 1e-13 over 0.02.
        let near = (-4..=4).map(|k| indent.at_radius(a * (0.02 * f64::from(k)).exp()));
        let near: Vec<Point> = near.collect::<Result<_>>()?;
        let at = |k: i32| &near[(4 + k) as usize];
        let along = |of: fn(&Point) -> f64| slope(|k| of(at(k))) / (0.02 * a);
        let [load, approach] = [along(|p| p.load), along(|p| p.approach)];
        claim("random-stacks", load / (point.stiffness * approach) - 1.0);
        let due = along(|p| p.stiffness);
        claim("random-stacks", point.stiffness_slope / due - 1.0);
    }
    assert!(refused <= 2, "{refused} of 200");
    Ok(())
}
