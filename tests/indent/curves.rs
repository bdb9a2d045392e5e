//! Whole curves against states that are solved for one by one.

use nacre::indent::{Adhesion, Form, Held, Indent, Parameter, Stack, Tip, TipParameter, Variable};
use nacre::{BodyParameter, Result};

use super::support::coated;

/// Loads, radii, slopes and derivatives of a curve equal those of its states to 1e-8, some ten times the error of the table:
/// with and without adhesion, over kinks, and 0 where nothing touches.
#[test]
fn curves_equal_states() -> Result<()> {
    let parameters = [
        Parameter::Body(0, BodyParameter::Young(0)),
        Parameter::Body(0, BodyParameter::Thickness(0)),
        Parameter::Body(0, BodyParameter::Young(1)),
        Parameter::Tip(TipParameter::Area),
    ];
    let work = [&parameters[..], &[Parameter::Work]].concat();
    let jkr = Adhesion::Jkr { work: 0.01 };
    let (sphere, blunt, sampled) = (
        Form::Sphere { radius: 10.0 },
        Form::RoundedCone {
            slope: 0.1,
            radius: 2.0,
        },
        Form::Profile {
            radii: (0..12).map(|k| 0.25 * f64::from(k)).collect(),
            heights: (0..12).map(|k| 0.003 * f64::from(k * k)).collect(),
        },
    );
    let cases = [
        (sphere.clone(), Adhesion::None, &parameters[..]),
        (sphere.clone(), jkr, &work[..]),
        (sphere, Adhesion::Dmt { work: 0.01 }, &work[..]),
        (blunt, Adhesion::None, &parameters[..]),
        (sampled, Adhesion::None, &parameters[..]),
        (
            Form::FlatPunch { radius: 0.3 },
            Adhesion::None,
            &parameters[..],
        ),
    ];
    for (form, adhesion, parameters) in cases {
        let stack = Stack::plan(&[coated(4.0, 1.0)?.into()])?;
        let indent = Indent::new(&stack, &Tip::new(form.clone())?).with_adhesion(adhesion)?;
        let approaches: Vec<f64> = (-3..40).map(|k| 0.004 * f64::from(k)).collect();
        let curve = indent.curve(&approaches, parameters)?;
        let mut touching = 0;
        for (k, approach) in approaches.iter().enumerate() {
            let Ok(point) = indent.at_approach(*approach) else {
                assert!(curve.load[k].abs() <= 0.0 && curve.radius[k].abs() <= 0.0);
                assert!(curve.derivatives[k].iter().all(|d| d.abs() <= 0.0));
                continue;
            };
            touching += 1;
            let size = point.load.abs() + 0.01;
            assert!(
                (curve.load[k] - point.load).abs() < 1e-8 * size,
                "{form:?} {adhesion:?} {approach}"
            );
            assert!((curve.radius[k] / point.radius - 1.0).abs() < 1e-8);
            let held = point.derivative(Variable::Held, Held::Approach)?.load;
            assert!(
                (curve.slope[k] / held - 1.0).abs() < 1e-7,
                "{} {held}",
                curve.slope[k]
            );
            for (found, parameter) in curve.derivatives[k].iter().zip(parameters) {
                let variable = Variable::Parameter(*parameter);
                let due = point.derivative(variable, Held::Approach)?.load;
                assert!(
                    (found - due).abs() < 1e-7 * (due.abs() + size),
                    "{form:?} {adhesion:?} {approach} {parameter:?}: {found} {due}"
                );
            }
        }
        assert!(touching > 30, "{form:?}");
    }
    Ok(())
}
