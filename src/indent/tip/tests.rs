//! Transforms of tips against their definition, differences and closed forms.

use super::{Form, Tip, TipParameter};
use crate::error::Result;
use crate::indent::equation::basis::{Break, Panel};
use crate::numerics::quadrature::Rule;

/// Forms with their numbers as `numbers` has them.
fn forms([x, y]: [f64; 2]) -> [Form; 9] {
    [
        Form::Paraboloid { radius: 3.0 * x },
        Form::Sphere { radius: 2.0 * x },
        Form::Cone { slope: 0.3 * x },
        Form::Power { factor: 0.2 * x, exponent: 4.0 * y },
        Form::Power { factor: 0.2 * x, exponent: 2.5 * y },
        Form::RoundedCone { slope: 0.3 * x, radius: 2.0 * y },
        Form::RoundedPunch { flat: 0.5 * x, radius: 4.0 * y },
        Form::FlatCone { flat: 0.5 * x, slope: 0.2 * y },
        Form::FlatPunch { radius: x },
    ]
}

/// F equals its definition s ∫ g'(r)/√(s² − r²) dr, with r = s sin θ and differences of the profile; its two derivatives and
/// its rates with the numbers and the area equal differences.
#[test]
fn transforms_are_those_of_the_profiles() -> Result<()> {
    let rule = Rule::gauss_legendre(60);
    for (k, form) in forms([1.0; 2]).into_iter().enumerate() {
        let tip = Tip::new(form)?;
        for s in [0.3, 0.8, 1.4] {
            let angle = |b: &f64| Break { at: (b / s).min(1.0).asin(), has_root: true };
            let kinks: Vec<Break> = tip.kinks().iter().map(angle).collect();
            let mut due = 0.0;
            if k < 8 {
                for panel in Panel::between(0.0, &kinks, std::f64::consts::FRAC_PI_2) {
                    for (angle, w) in panel.nodes(&rule) {
                        let r = s * angle.sin();
                        let h = 1e-5 * r;
                        due += w * s * (tip.gap(r + h) - tip.gap(r - h)) / (2.0 * h);
                    }
                }
            }
            let [value, slope, bend] = tip.transform(s);
            // Differences leave h²/6 g''' and 1e-16/h, next to a kink some h of the slope.
            assert!((value - due).abs() <= 2e-6, "{tip:?} {s}: {value} {due}");
            let h = 1e-4;
            let [low, high] = [s - h, s + h].map(|s| tip.transform(s));
            assert!((slope - (high[0] - low[0]) / (2.0 * h)).abs() < 1e-6, "{tip:?} {s}");
            assert!((bend - (high[1] - low[1]) / (2.0 * h)).abs() < 1e-5, "{tip:?} {s}");
            for number in 0..tip.numbers().len() {
                let step = |part: f64| {
                    let mut numbers = [1.0; 2];
                    numbers[number] += part;
                    Tip::new(forms(numbers)[k].clone())
                };
                let (low, high) = (step(-1e-5)?, step(1e-5)?);
                let size = tip.numbers()[number].1;
                let [found, of_slope] =
                    tip.rate(TipParameter::Number(number), &[s])[0].map(|rate| rate * size);
                let (low, high) = (low.transform(s), high.transform(s));
                assert!((found - (high[0] - low[0]) / 2e-5).abs() < 1e-7, "{tip:?} {s} {number}");
                assert!(
                    (of_slope - (high[1] - low[1]) / 2e-5).abs() < 1e-6,
                    "{tip:?} {s} {number}"
                );
            }
            let [found, of_slope] = tip.rate(TipParameter::Area, &[s])[0];
            // F of g(r/√κ) is F(s/√κ).
            let at = |part: f64| {
                let root = (1.0 + part).sqrt();
                let [value, slope, _] = tip.transform(s / root);
                [value, slope / root]
            };
            let (low, high) = (at(-1e-5), at(1e-5));
            assert!((found - (high[0] - low[0]) / 2e-5).abs() < 1e-7, "{tip:?} {s}");
            assert!((of_slope - (high[1] - low[1]) / 2e-5).abs() < 1e-6, "{tip:?} {s}");
        }
    }
    Ok(())
}

/// Samples of a paraboloid and the area function 2πRd of one have its F, as closely as their intervals are fine.
#[test]
fn sampled_tips() -> Result<()> {
    let (radius, due) = (5.0, Tip::paraboloid(5.0)?);
    let radii: Vec<f64> = (0..101).map(|k| 0.02 * f64::from(k)).collect();
    let heights = radii.iter().map(|r| r * r / (2.0 * radius)).collect();
    let profile = Tip::new(Form::Profile { radii, heights })?;
    let area = Tip::new(Form::Area {
        coefficients: vec![0.0, 2.0 * std::f64::consts::PI * radius],
        depth: 0.4,
    })?;
    // A cone: A = π (d/m)².
    let cone =
        Tip::new(Form::Area { coefficients: vec![std::f64::consts::PI / 0.09], depth: 0.6 })?;
    for s in [0.3, 1.0, 1.7] {
        assert!((profile.transform(s)[0] / due.transform(s)[0] - 1.0).abs() < 1e-12);
        assert!((area.transform(s)[0] / due.transform(s)[0] - 1.0).abs() < 1e-4);
        let due = Tip::cone(0.3)?.transform(s)[0];
        assert!((cone.transform(s)[0] / due - 1.0).abs() < 1e-4);
    }
    assert!(area.range()[1] > 1.99 && area.range()[1] < 2.01);
    let wrong = Form::Area { coefficients: vec![1.0, -1.0], depth: 1.0 };
    assert!(Tip::new(wrong).is_err());
    Ok(())
}
