//! The frequency response equals reference values, its closed forms and its limits, for any stack
//! of layers and αh from 1e-8 to 1e4.

use nacre::response::{Compliance, frequency_response, surface_compliance};
use nacre::{Elastic, HalfSpace, Interface, Layer, Result, Substrate};
use proptest::prelude::*;

use crate::support::checks::seeded;
use crate::support::claims::claim;
use crate::support::reference::{cases, list, number};
use crate::support::settings;

/// One layer: a few dozen operations without cancellation, and data of 15 digits.
const ONE_LAYER: f64 = 1e-12;

/// Stacks of up to six layers and contrasts of 1e4.
const STACK: f64 = 1e-11;

/// From αh = 0.1 up the closed form loses two digits by cancellation.
const CLOSED_FORM: f64 = 1e-13;

/// Half-spaces cut into layers of one material: rounding alone.
const CUT: f64 = 1e-12;

/// αh from 1e-8 to 1e4, three to a decade.
fn sweep() -> impl Iterator<Item = f64> {
    (-24..=12).map(|k| 10.0_f64.powf(f64::from(k) / 3.0))
}

/// The largest relative difference of c11, c22, ct, and of c12 relative to √(c11 c22).
fn difference(a: Compliance, b: Compliance) -> f64 {
    let relative = |a: f64, b: f64| (a / b - 1.0).abs();
    relative(a.c11, b.c11)
        .max(relative(a.c22, b.c22))
        .max(relative(a.ct, b.ct))
        .max((a.c12 - b.c12).abs() / (b.c11 * b.c22).sqrt())
}

/// The largest difference between `file` and the response of those of its bodies that `select` takes,
/// and the number of values compared.
fn difference_from(file: &str, select: impl Fn(&HalfSpace) -> bool) -> Result<(f64, usize)> {
    let (mut worst, mut compared) = (0.0_f64, 0);
    for case in cases(file) {
        let body = crate::support::bodies::body(&case)?;
        if !select(&body) {
            continue;
        }
        for row in list(&case, "rows") {
            let found = surface_compliance(&body, number(row, "wavenumber"))?;
            let [c11, c12, c22, ct] = ["c11", "c12", "c22", "ct"].map(|key| number(row, key));
            let expected = Compliance { c11, c12, c22, ct };
            worst = worst.max(difference(found, expected));
            compared += 1;
        }
    }
    Ok((worst, compared))
}

fn one_bonded_layer(body: &HalfSpace) -> bool {
    matches!(body.layers(), [layer] if layer.interface() == Interface::Bonded)
}

#[test]
fn one_layer_and_stacks_equal_reference() -> Result<()> {
    for file in ["response_stacks.json", "response_random.json"] {
        for (single, least) in [(true, 40), (false, 30)] {
            let (worst, compared) = difference_from(file, |b| one_bonded_layer(b) == single)?;
            assert!(compared > least, "{file}");
            claim("response", worst);
        }
    }
    Ok(())
}

/// c11 of one layer of unit thickness in closed form, with the sign of the first term in θ. Nogi &
/// Kato (1997), O'Sullivan & King (1988); the paper prints +1.
fn closed_form(coating: Elastic, substrate: Elastic, alpha: f64, sign: f64) -> f64 {
    let (g1, g2) = (coating.shear(), substrate.shear());
    let (nu1, nu2) = (coating.poisson(), substrate.poisson());
    let mu = g1 / g2;
    let theta = (-2.0 * alpha).exp();
    let kappa = (mu - 1.0) / (mu + 3.0 - 4.0 * nu1);
    let lambda = 1.0 - 4.0 * (1.0 - nu1) / (1.0 + mu * (3.0 - 4.0 * nu2));
    let above = 1.0 + 4.0 * alpha * kappa * theta - lambda * kappa * theta * theta;
    let below = 1.0
        + sign * (lambda + kappa + 4.0 * kappa * alpha * alpha) * theta
        + lambda * kappa * theta * theta;
    (1.0 - nu1) / (g1 * alpha) * above / below
}

/// The largest relative difference between the response and the closed form of either sign.
fn difference_from_closed_form(sign: f64, alphas: &[f64]) -> Result<f64> {
    let mut worst = 0.0_f64;
    for ratio in [0.01, 0.25, 0.8, 4.0, 100.0] {
        for (nu1, nu2) in [(0.3, 0.3), (0.0, 0.5), (0.5, 0.0), (0.2, 0.45), (-0.4, 0.1)] {
            let (coating, substrate) = (Elastic::new(ratio, nu1)?, Elastic::new(1.0, nu2)?);
            let body = HalfSpace::new(substrate, [Layer::new(coating, 1.0)?])?;
            for &alpha in alphas {
                let expected = closed_form(coating, substrate, alpha, sign);
                worst = worst.max((frequency_response(&body, alpha)? / expected - 1.0).abs());
            }
        }
    }
    Ok(worst)
}

#[test]
fn one_layer_equals_closed_form_with_the_minus_sign() -> Result<()> {
    let alphas: Vec<f64> = sweep().filter(|&alpha| alpha > 0.09).collect();
    below!(difference_from_closed_form(-1.0, &alphas)?, CLOSED_FORM);
    Ok(())
}

#[test]
fn closed_form_with_the_printed_plus_sign_is_another_function() -> Result<()> {
    let worst = difference_from_closed_form(1.0, &[0.5])?;
    assert!(worst > 0.5, "{worst}");

    // The wrong sign also misses the limit of a thin layer, the substrate's response.
    let (coating, substrate) = (Elastic::new(5.2, 0.3)?, Elastic::new(1.25, 0.25)?);
    let alpha = 1e-3;
    let limit = Compliance::homogeneous(substrate).c11;
    let of_sign = |sign| closed_form(coating, substrate, alpha, sign) * alpha / limit;
    below!((of_sign(-1.0) - 1.0).abs(), 0.01, of_sign(-1.0));
    below!(of_sign(1.0), 0.1);
    Ok(())
}

#[test]
fn thin_layer_is_the_substrate_and_its_own_compression() -> Result<()> {
    // c11 = A/α + h (1+g)(1−2ν1−g) / 2G1(1−ν1) + O(α h²), g = (1−2ν2) G1/G2.
    for (ratio, nu1, nu2) in [(4.0, 0.3, 0.3), (0.25, 0.45, 0.2), (0.1, 0.0, 0.5), (2.0, 0.2, 0.4)]
    {
        let (coating, substrate) = (Elastic::new(ratio, nu1)?, Elastic::new(1.0, nu2)?);
        let g1 = coating.shear();
        let g = (1.0 - 2.0 * nu2) * g1 / substrate.shear();
        let constant = (1.0 + g) * (1.0 - 2.0 * nu1 - g) / (2.0 * g1 * (1.0 - nu1));
        let body = HalfSpace::new(substrate, [Layer::new(coating, 1.0)?])?;
        let alpha = 1e-5;
        let a = Compliance::homogeneous(substrate).c11;
        let rest = frequency_response(&body, alpha)? - a / alpha;
        // Next term of order α h² A, and rounding of A/α, both against 1/G1.
        let tolerance = 10.0 * (alpha * a.max(1.0 / g1).powi(2) * g1 + f64::EPSILON * a / alpha);
        below!((rest - constant).abs(), tolerance, rest, constant);

        // A layer that slips is free to stretch: h (1−ν1)/2G1.
        let layer = Layer::new(coating, 1.0)?.with_interface(Interface::Frictionless);
        let rest = frequency_response(&HalfSpace::new(substrate, [layer])?, alpha)? - a / alpha;
        let constant = (1.0 - nu1) / (2.0 * g1);
        below!((rest - constant).abs(), tolerance, rest, constant);
    }
    Ok(())
}

#[test]
fn thick_layer_is_a_half_space_of_its_material() -> Result<()> {
    for (ratio, nu1) in [(1e-4, 0.3), (1e4, 0.5), (0.25, 0.0)] {
        let coating = Elastic::new(ratio, nu1)?;
        for substrate in [Elastic::new(1.0, 0.3)?.into(), Substrate::Rigid] {
            let body = HalfSpace::new(substrate, [Layer::new(coating, 1.0)?])?;
            for alpha in [40.0, 1e4] {
                // e^{−80} is below rounding.
                let half_space = surface_compliance(&coating.into(), alpha)?;
                let found = surface_compliance(&body, alpha)?;
                below!(difference(found, half_space), ONE_LAYER, found);
            }
        }
    }
    Ok(())
}

#[test]
fn layer_on_a_rigid_base_equals_closed_form() -> Result<()> {
    // (1−ν)/(Gα) · [k sinh 2x − 2x] / [k cosh 2x + 2x² + 5 − 12ν + 8ν²], x = αh, k = 3 − 4ν
    for nu in [0.0, 0.3, 0.45] {
        let coating = Elastic::new(1.0, nu)?;
        let body = HalfSpace::new(Substrate::Rigid, [Layer::new(coating, 2.0)?])?;
        let k = 3.0 - 4.0 * nu;
        for x in sweep().filter(|x| (1e-8..100.0).contains(x)) {
            let alpha = x / 2.0;
            let above = k * (2.0 * x).sinh() - 2.0 * x;
            let below = k * (2.0 * x).cosh() + 2.0 * x * x + 5.0 - 12.0 * nu + 8.0 * nu * nu;
            let expected = Compliance::homogeneous(coating).c11 / alpha * above / below;
            let found = frequency_response(&body, alpha)?;
            near!(found, expected, ONE_LAYER, nu, x);
        }
        // α → 0: compression of the layer alone, h (1−2ν)/2G(1−ν).
        let found = frequency_response(&body, 1e-9)?;
        let expected = 2.0 * (1.0 - 2.0 * nu) / (2.0 * coating.shear() * (1.0 - nu));
        near!(found, expected, ONE_LAYER, nu);
    }
    Ok(())
}

#[test]
fn equal_layers_are_a_half_space() -> Result<()> {
    for nu in [-0.5, 0.0, 0.3, 0.499, 0.5] {
        let material = Elastic::new(210e9, nu)?;
        for thicknesses in [vec![1.0], vec![0.2, 0.5, 0.3], vec![0.01; 100]] {
            let stack = settings::stack(material, thicknesses.iter().map(|h| [210e9, nu, *h]))?;
            for alpha in sweep() {
                let half_space = surface_compliance(&material.into(), alpha)?;
                let found = surface_compliance(&stack, alpha)?;
                below!(difference(found, half_space), CUT, nu, alpha);
            }
        }
    }
    Ok(())
}

#[test]
fn layer_cut_in_ten_is_the_layer() -> Result<()> {
    let [soft, rigid] = [Elastic::new(1.0, 0.3)?.into(), Substrate::Rigid];
    let (bonded, slips) = (Interface::Bonded, Interface::Frictionless);
    let ends = [(soft, bonded), (soft, slips), (rigid, bonded), (rigid, slips)];
    for (ratio, nu) in [(1e4, 0.3), (1e-4, 0.499), (4.0, 0.0), (0.25, 0.5)] {
        let coating = Elastic::new(ratio, nu)?;
        for (substrate, interface) in ends {
            let last = |h: f64| Ok(Layer::new(coating, h)?.with_interface(interface));
            let whole = HalfSpace::new(substrate, [last(1.0)?])?;
            let mut cut = vec![Layer::new(coating, 0.1)?; 9];
            cut.push(last(0.1)?);
            let cut = HalfSpace::new(substrate, cut)?;
            for alpha in sweep() {
                let expected = surface_compliance(&whole, alpha)?;
                let error = difference(surface_compliance(&cut, alpha)?, expected);
                below!(error, CUT, whole, alpha);
            }
        }
    }
    Ok(())
}

/// `count` sublayers, alternately hard and soft, of unit thickness together.
fn laminate(count: usize) -> Result<HalfSpace> {
    let layers = (0..count).map(|k| [[1e3, 0.2], [1e-1, 0.49]][k % 2]);
    let layers = layers.map(|[young, nu]| [young, nu, 1.0 / count as f64]);
    settings::stack(Elastic::new(1.0, 0.3)?, layers)
}

#[test]
fn a_thousand_layers_stay_finite_and_positive_definite() -> Result<()> {
    let body = laminate(1000)?;
    for alpha in sweep() {
        let Compliance { c11, c12, c22, ct } = surface_compliance(&body, alpha)?;
        let finite = [c11, c12, c22, ct].iter().all(|c| c.is_finite());
        let definite = c11 > 0.0 && c22 > 0.0 && ct > 0.0 && c12 * c12 < c11 * c22;
        assert!(finite && definite, "alpha {alpha}");
    }
    Ok(())
}

fn any_layer() -> impl Strategy<Value = (f64, f64, f64, bool)> {
    (-4.0..4.0, -0.9..0.5, -3.0..3.0, any::<bool>())
}

/// A stack on a half-space of modulus `modulus`, lengths in units of `length`.
fn stack(layers: &[(f64, f64, f64, bool)], modulus: f64, length: f64) -> Result<HalfSpace> {
    let layers: Result<Vec<Layer>> = layers
        .iter()
        .map(|&(log_young, nu, log_h, slips)| {
            let material = Elastic::new(modulus * 10.0_f64.powf(log_young), nu)?;
            let layer = Layer::new(material, length * 10.0_f64.powf(log_h))?;
            let interfaces = [Interface::Bonded, Interface::Frictionless];
            Ok(layer.with_interface(interfaces[usize::from(slips)]))
        })
        .collect();
    HalfSpace::new(Elastic::new(modulus, 0.3)?, layers?)
}

proptest! {
    #![proptest_config(seeded(256))]

    #[test]
    fn any_stack_is_positive_definite_and_scales(
        layers in prop::collection::vec(any_layer(), 0..8),
        log_alpha in -8.0..4.0,
    ) {
        let alpha = 10.0_f64.powf(log_alpha);
        let found = surface_compliance(&stack(&layers, 1.0, 1.0)?, alpha)?;
        prop_assert!(found.c11 > 0.0 && found.c22 > 0.0 && found.ct > 0.0);
        prop_assert!(found.c12 * found.c12 < found.c11 * found.c22);

        // Units: m → 1e-6 m and Pa → 1e11 Pa.
        let Compliance { c11, c12, c22, ct } =
            surface_compliance(&stack(&layers, 1e11, 1e-6)?, alpha * 1e6)?;
        let [c11, c12, c22, ct] = [c11, c12, c22, ct].map(|c| c / 1e-17);
        let back = Compliance { c11, c12, c22, ct };
        prop_assert!(difference(back, found) < STACK);
    }
}
