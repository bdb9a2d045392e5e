//! A graded coating is the limit of ever thinner layers, approached with their second power, and
//! met to the tolerance asked.

use approx::assert_relative_eq;
use nacre::response::frequency_response;
use nacre::{Elastic, Error, HalfSpace, Layer, Result, Substrate, graded_layers};

/// The rate of a second-order error between stacks of 16 to 128 layers; measured against 1024, which
/// err themselves by 1/64 of the finest, the last rate is 0.02 too high.
const RATE: [f64; 2] = [1.9, 2.1];

/// Layers of equal properties are one layer.
const ROUNDING: f64 = 1e-12;

const THICKNESS: f64 = 5e-6;

/// Wavenumbers, times the thickness, from wavelengths far above it down to a fifth of it.
fn wavenumbers() -> impl Iterator<Item = f64> {
    (0..=60).map(|k| 0.01 * 3200.0_f64.powf(f64::from(k) / 60.0) / THICKNESS)
}

fn steel() -> Result<Elastic> {
    Elastic::new(210e9, 0.3)
}

/// Stiff at the surface, steel at the bottom.
fn exponential(z: f64) -> Result<Elastic> {
    Elastic::new(210e9 * 4.0_f64.powf(1.0 - z / THICKNESS), 0.3)
}

/// Soft at the surface, stiffest in the middle, and of varying Poisson's ratio.
fn sandwich(z: f64) -> Result<Elastic> {
    let x = z / THICKNESS;
    Elastic::new(105e9 + 1200e9 * x * (1.0 - x), 0.2 + 0.25 * x)
}

/// Equal layers, each of the material at its middle.
fn cut(
    substrate: impl Into<Substrate>,
    count: usize,
    material: fn(f64) -> Result<Elastic>,
) -> Result<HalfSpace> {
    let each = THICKNESS / count as f64;
    let layers: Result<Vec<Layer>> = (0..count)
        .map(|k| Layer::new(material((k as f64 + 0.5) * each)?, each))
        .collect();
    HalfSpace::new(substrate, layers?)
}

/// Largest relative difference of two responses.
fn difference(a: &HalfSpace, b: &HalfSpace) -> Result<f64> {
    wavenumbers().try_fold(0.0_f64, |worst, alpha| {
        let ratio = frequency_response(a, alpha)? / frequency_response(b, alpha)?;
        Ok(worst.max((ratio - 1.0).abs()))
    })
}

#[test]
fn error_falls_with_the_second_power_of_the_thickness() -> Result<()> {
    for material in [exponential, sandwich] {
        for substrate in [steel()?.into(), Substrate::Rigid] {
            let limit = cut(substrate, 1024, material)?;
            // At one wavenumber; which one is worst changes with the number of layers.
            for x in [0.1, 1.0, 3.0] {
                let exact = frequency_response(&limit, x / THICKNESS)?;
                let error = |count: usize| -> Result<f64> {
                    let response =
                        frequency_response(&cut(substrate, count, material)?, x / THICKNESS)?;
                    Ok((response / exact - 1.0).abs())
                };
                let errors = [error(16)?, error(32)?, error(64)?, error(128)?];
                let rates = [0, 1, 2].map(|k| (errors[k] / errors[k + 1]).log2());
                println!("αh = {x}: errors {errors:?}, rates {rates:?}");
                for rate in rates {
                    assert!(rate > RATE[0] && rate < RATE[1], "αh = {x}: {rates:?}");
                }
            }
        }
    }
    Ok(())
}

#[test]
fn tolerance_is_met_at_every_wavelength_promised() -> Result<()> {
    for material in [exponential, sandwich] {
        for substrate in [steel()?.into(), Substrate::Rigid] {
            let limit = cut(substrate, 4096, material)?;
            for tolerance in [1e-2, 1e-3, 1e-4, 1e-5] {
                let layers = graded_layers(substrate, THICKNESS, tolerance, material)?;
                let count = layers.len();
                let error = difference(&HalfSpace::new(substrate, layers)?, &limit)?;
                println!("tolerance {tolerance:e}: {count} layers, error {error:.1e}");
                assert!(error < tolerance, "{tolerance:e}: {error:e}");
                // Two doublings must agree: a quarter as many would not do, or hardly.
                let fewer = difference(&cut(substrate, count / 4, material)?, &limit)?;
                assert!(
                    count <= 8 || fewer > 0.5 * tolerance,
                    "{tolerance:e}: {fewer:e}"
                );
            }
        }
    }
    Ok(())
}

#[test]
fn layers_fill_the_thickness_and_take_the_material_at_their_middle() -> Result<()> {
    let layers = graded_layers(steel()?, THICKNESS, 1e-3, sandwich)?;
    let mut depth = 0.0;
    for layer in &layers {
        let material = sandwich(depth + 0.5 * layer.thickness())?;
        assert_relative_eq!(
            layer.material().young(),
            material.young(),
            max_relative = 1e-12
        );
        assert_relative_eq!(
            layer.material().poisson(),
            material.poisson(),
            max_relative = 1e-12
        );
        depth += layer.thickness();
    }
    assert_relative_eq!(depth, THICKNESS, max_relative = 1e-12);
    Ok(())
}

#[test]
fn constant_properties_are_the_plain_layer() -> Result<()> {
    let coating = Elastic::new(420e9, 0.2)?;
    let layers = graded_layers(steel()?, THICKNESS, 1e-6, |_| Ok(coating))?;
    let graded = HalfSpace::new(steel()?, layers)?;
    let plain = HalfSpace::new(steel()?, [Layer::new(coating, THICKNESS)?])?;
    let worst = difference(&graded, &plain)?;
    assert!(worst < ROUNDING, "{worst:e}");
    Ok(())
}

#[test]
fn errors_name_what_is_wrong() -> Result<()> {
    let name = |result: Result<Vec<Layer>>| match result {
        Err(Error::Parameter { name, .. }) => Some(name),
        _ => None,
    };
    let steel = steel()?;
    for tolerance in [0.0, -1e-3, 1.0, f64::NAN, f64::INFINITY] {
        let made = graded_layers(steel, THICKNESS, tolerance, exponential);
        assert_eq!(name(made), Some("tolerance"), "{tolerance}");
    }
    for thickness in [0.0, -1e-6, f64::NAN, f64::INFINITY] {
        let made = graded_layers(steel, thickness, 1e-3, exponential);
        assert_eq!(name(made), Some("thickness"), "{thickness}");
    }
    // Below zero from some depth on.
    let falling = |z: f64| Elastic::new(210e9 * (1.0 - 2.0 * z / THICKNESS), 0.3);
    assert_eq!(
        name(graded_layers(steel, THICKNESS, 1e-3, falling)),
        Some("young")
    );
    let rising = |z: f64| Elastic::new(210e9, 0.3 + 0.4 * z / THICKNESS);
    assert_eq!(
        name(graded_layers(steel, THICKNESS, 1e-3, rising)),
        Some("poisson")
    );
    // 4096 layers err by 1e-7.
    let made = graded_layers(steel, THICKNESS, 1e-9, exponential);
    assert_eq!(name(made), Some("tolerance"));
    Ok(())
}
