//! Layers on springs and plates with a free base: response and derivatives equal those of the dense boundary-value
//! system, and have their limits.

use std::f64::consts::PI;

use nacre::ends::QuarterSpace;
use nacre::influence::{Method, influence_coefficients};
use nacre::response::{
    Asymptotes, Compliance, Response, asymptote_derivatives, frequency_response,
    normal_derivatives, surface_compliance,
};
use nacre::{
    BodyParameter, Contact, Elastic, Error, Grid, HalfSpace, Interface, Layer, Result, Setup,
    Spring, Substrate, traction_coefficients,
};

use crate::support::bodies::body;
use crate::support::reference::{cases, list, number};

/// Rounding of a few dozen operations; the numbers of the file have 16 digits.
const ROUNDING: f64 = 1e-12;

fn spring(normal: impl Into<Option<f64>>, tangential: impl Into<Option<f64>>) -> Result<Interface> {
    Ok(Interface::Spring(Spring::new(normal.into(), tangential.into())?))
}

/// The largest relative difference of c11, c22, ct, and of c12 relative to √(c11 c22).
fn difference(a: Compliance, b: Compliance) -> f64 {
    let relative = |a: f64, b: f64| (a / b - 1.0).abs();
    relative(a.c11, b.c11)
        .max(relative(a.c22, b.c22))
        .max(relative(a.ct, b.ct))
        .max((a.c12 - b.c12).abs() / (b.c11 * b.c22).sqrt())
}

/// Wavenumbers from 1e-3 to 1e2, three to a decade.
fn sweep() -> impl Iterator<Item = f64> {
    (-9..=6).map(|k| 10f64.powf(f64::from(k) / 3.0))
}

#[test]
fn compliances_equal_the_dense_system() -> Result<()> {
    let mut compared = 0;
    for case in cases("springs.json") {
        let body = body(&case)?;
        for row in list(&case, "rows") {
            let found = surface_compliance(&body, number(row, "wavenumber"))?;
            let [c11, c12, c22, ct] = ["c11", "c12", "c22", "ct"].map(|key| number(row, key));
            let due = Compliance { c11, c12, c22, ct };
            below!(difference(found, due), ROUNDING, body, row["wavenumber"]);
            compared += 1;
        }
    }
    assert_eq!(compared, 77);
    Ok(())
}

/// Derivatives relative to the response over the number: sums of energies of one sign are as accurate, and the others
/// cancel in part.
#[test]
fn derivatives_equal_the_dense_system() -> Result<()> {
    let mut compared = 0;
    for case in cases("springs.json") {
        let body = body(&case)?;
        let parameters = body.parameters();
        for row in list(&case, "rows") {
            let alpha = number(row, "wavenumber");
            let mut found = vec![0.0; parameters.len()];
            let value = normal_derivatives(&body, &parameters, alpha, &mut found);
            for (parameter, found) in parameters.iter().zip(found) {
                let path = parameter.path(&body);
                let due = number(&row["slopes"], &path) * alpha;
                let own = body.value(*parameter).unwrap_or(1.0).abs().max(0.1);
                let scale = due.abs().max(1e-3 * value / own);
                below!((found - due).abs(), 10.0 * ROUNDING * scale, body, path, alpha);
                compared += 1;
            }
        }
    }
    assert!(compared > 300, "{compared}");
    Ok(())
}

/// Long waves of bodies on springs reach their limits: the remainder is of the order of α in c11.
#[test]
fn asymptotes_are_limits_and_so_are_their_derivatives() -> Result<()> {
    for case in cases("springs.json") {
        let body = body(&case)?;
        if body.substrate() == Substrate::Free {
            continue;
        }
        let Asymptotes { long, constant, .. } = body.asymptotes();
        // Beyond the longest length of all, 1e4 of the weakest spring.
        let alpha = 1e-9;
        let parameters = body.parameters();
        let mut slopes = vec![0.0; parameters.len()];
        let value = normal_derivatives(&body, &parameters, alpha, &mut slopes);
        let scale = constant.abs().max(1.0);
        below!((value - long - constant * alpha).abs(), 1e-5 * scale * alpha, body);
        let due = asymptote_derivatives(&body, &parameters);
        for ((slope, due), parameter) in slopes.iter().zip(due).zip(&parameters) {
            let rest = (slope - due.long - due.constant * alpha).abs();
            below!(rest, 1e-4 * scale * scale.max(due.constant.abs()) * alpha, body, parameter);
        }
    }
    Ok(())
}

/// The bodies whose interface is a spring, bonded or frictionless, on an elastic and on a rigid base.
fn with_interface(interface: Interface) -> Result<[HalfSpace; 2]> {
    let (hard, soft) = (Elastic::new(5.0, 0.2)?, Elastic::new(1.0, 0.35)?);
    let layers = [Layer::new(hard, 1.0)?.with_interface(interface), Layer::new(soft, 0.5)?];
    Ok([HalfSpace::new(soft, layers.clone())?, HalfSpace::new(Substrate::Rigid, layers)?])
}

#[test]
fn stiff_springs_bond_and_weak_ones_slip() -> Result<()> {
    // α/k of 1e-14 in moduli of 1; the response changes as α/k at most.
    let stiff = with_interface(spring(1e16, 1e16)?)?;
    let bonded = with_interface(Interface::Bonded)?;
    // Long waves feel α/k_t only if it is above the shear lag, α² h E: 1e-22 / 1e-3³ = 1e-13.
    let weak = with_interface(spring(1e22, 1e-22)?)?;
    let slipping = with_interface(Interface::Frictionless)?;
    let loose = with_interface(spring(None::<f64>, 0.0)?)?;
    for alpha in sweep() {
        for k in 0..2 {
            let at = |body: &HalfSpace| surface_compliance(body, alpha);
            below!(difference(at(&stiff[k])?, at(&bonded[k])?), 1e-12, alpha);
            below!(difference(at(&weak[k])?, at(&slipping[k])?), 1e-12, alpha);
            assert_eq!(at(&loose[k])?, at(&slipping[k])?);
        }
    }
    Ok(())
}

/// 1/k is what a film of thickness t and the constrained modulus adds; the next term is of the order of t.
#[test]
fn a_thin_soft_film_is_a_spring() -> Result<()> {
    let (hard, glue) = (Elastic::new(5.0, 0.2)?, Elastic::new(1e-3, 0.3)?);
    let t = 1e-4;
    let constrained = 2.0 * glue.shear() * 0.7 / 0.4;
    let springs = spring(constrained / t, glue.shear() / t)?;
    let of = |layers: Vec<Layer>| HalfSpace::new(hard, layers);
    let film = of(vec![Layer::new(hard, 1.0)?, Layer::new(glue, t)?])?;
    let joined = of(vec![Layer::new(hard, 1.0)?.with_interface(springs)])?;
    let bonded = HalfSpace::from(hard);
    for alpha in [0.1, 0.5, 1.0, 2.0] {
        let [film, joined, bonded] =
            [&film, &joined, &bonded].map(|body| frequency_response(body, alpha));
        let (film, joined, bonded) = (film?, joined?, bonded?);
        assert!((joined / bonded - 1.0).abs() > 1e-3);
        // Relative to what the springs change.
        below!((film - joined).abs(), 1e-3 * (joined - bonded), alpha);
    }
    Ok(())
}

/// Kirchhoff's plate: D α⁴ w = p, D = E h³/12(1−ν²); shear adds a part of order (αh)², 2e-5 here.
#[test]
fn long_waves_bend_a_free_plate() -> Result<()> {
    let (e, nu, h) = (2.0, 0.3, 1.0);
    let plate = HalfSpace::new(Substrate::Free, [Layer::new(Elastic::new(e, nu)?, h)?])?;
    let rigidity = e * h * h * h / (12.0 * (1.0 - nu * nu));
    for alpha in [1e-5, 1e-4, 1e-3, 1e-2] {
        let alpha: f64 = alpha;
        let compliance = surface_compliance(&plate, alpha)?;
        near!(compliance.c11 * rigidity * alpha.powi(4), 1.0, 1e-3 * (alpha / 1e-2), alpha);
        // A traction along it stretches it, and bends it by q h/2: 4/(E' h α²), E' = E/(1−ν²).
        let stretched = e / (1.0 - nu * nu) * h * alpha * alpha;
        near!(compliance.c22 * stretched, 4.0, 1e-3 * (alpha / 1e-2), alpha);
        // Across it, shear of the whole: 1/(G h α²).
        near!(compliance.ct * e / (2.0 + 2.0 * nu) * h * alpha * alpha, 1.0, 1e-4, alpha);
    }
    Ok(())
}

#[test]
fn two_half_plates_that_are_bonded_are_one() -> Result<()> {
    let material = Elastic::new(2.0, 0.3)?;
    let half = Layer::new(material, 0.5)?;
    let one = HalfSpace::new(Substrate::Free, [Layer::new(material, 1.0)?])?;
    let two = HalfSpace::new(Substrate::Free, [half.clone(), half.clone()])?;
    let stiff = half.clone().with_interface(spring(1e16, 1e16)?);
    let joined = HalfSpace::new(Substrate::Free, [stiff, half])?;
    for alpha in sweep() {
        let at = |body: &HalfSpace| surface_compliance(body, alpha);
        below!(difference(at(&two)?, at(&one)?), 1e-10, alpha);
        below!(difference(at(&joined)?, at(&one)?), 1e-10, alpha);
    }
    Ok(())
}

/// A sandwich whose core is springs, in long waves: a beam of two faces, each of E'h, at the distance h (Newmark, Siess &
/// Viest, Proc. Soc. Exp. Stress Anal. 9 (1951) 75), under p = α⁴ w D.
///
/// ```text
/// 1/D = 1/D_∞ + (1/D_0 − 1/D_∞) α²/(α² + λ²)      λ² = k_t [2/(E'h) + h²/D_0]
/// ```
///
/// D_0 is that of both faces apart, D_∞ that of one plate of twice the thickness.
#[test]
fn a_sandwich_of_springs_is_a_composite_plate() -> Result<()> {
    let (e, nu, h) = (2.0, 0.3, 1.0);
    let material = Elastic::new(e, nu)?;
    let of = |interface: Interface| -> Result<HalfSpace> {
        let face = Layer::new(material, h)?;
        HalfSpace::new(Substrate::Free, [face.clone().with_interface(interface), face])
    };
    let plane = e / (1.0 - nu * nu);
    let (apart, together) = (2.0 * plane * h.powi(3) / 12.0, plane * (2.0 * h).powi(3) / 12.0);
    let alpha: f64 = 3e-3;
    let rigidity = |body: &HalfSpace| -> Result<f64> {
        Ok(1.0 / (frequency_response(body, alpha)? * alpha.powi(4)))
    };
    near!(rigidity(&of(spring(1e6, 1e6)?)?)?, together, 1e-3);
    near!(rigidity(&of(spring(1e6, 1e-12)?)?)?, apart, 1e-3);
    near!(rigidity(&of(spring(1e6, 0.0)?)?)?, apart, 1e-3);
    for tangential in [1e-6, 1e-5, 1e-4] {
        let lambda2 = tangential * (2.0 / (plane * h) + h * h / apart);
        let share = alpha * alpha / (alpha * alpha + lambda2);
        let compliance = 1.0 / together + (1.0 / apart - 1.0 / together) * share;
        near!(rigidity(&of(spring(1e6, tangential)?)?)?, 1.0 / compliance, 1e-3, tangential);
    }
    Ok(())
}

/// Coefficients of cells on a plate that repeats: sums of all waves, up to the 60th alias of the grid along both
/// directions, where the difference from a half-space has vanished; of that the rest of the sum is known.
#[test]
fn coefficients_of_a_free_plate_are_sums_of_waves() -> Result<()> {
    let (hard, soft) = (Elastic::new(5.0, 0.2)?, Elastic::new(1.0, 0.35)?);
    for (layers, cells) in [
        (vec![Layer::new(soft, 2.0)?], [12, 9]),
        (
            vec![Layer::new(hard, 0.4)?.with_interface(spring(1.0, 0.3)?), Layer::new(soft, 1.0)?],
            [9, 16],
        ),
    ] {
        let plate = HalfSpace::new(Substrate::Free, layers)?;
        let size = [cells[0] as f64 * 1.0, cells[1] as f64 * 1.5];
        let grid = Grid::new(cells, size)?.periodic([true; 2])?;
        let found = influence_coefficients(&plate, &grid, Method::Exact)?;
        below!(found.sum().abs(), 1e-10 * found[[0, 0]], cells);
        // The surface's own half-space has the same short waves.
        let top = HalfSpace::from(plate.surface_material());
        let base = influence_coefficients(&top, &grid, Method::Exact)?;
        let terms = |n: usize, length: f64, spacing: f64| {
            let last = 60 * n as i64;
            (-last..=last)
                .map(move |k| {
                    let m = 2.0 * PI * k as f64 / length;
                    let half = 0.5 * m * spacing;
                    (m, if k == 0 { 1.0 } else { half.sin() / half })
                })
                .filter(|(m, _)| m.abs() < 40.0)
                .collect::<Vec<_>>()
        };
        let along = terms(cells[0], size[0], grid.spacing()[0]);
        let across = terms(cells[1], size[1], grid.spacing()[1]);
        for at in [[0, 0], [1, 0], [0, 3], [5, 4]] {
            let (x, y) = (at[0] as f64 * grid.spacing()[0], at[1] as f64 * grid.spacing()[1]);
            let mut sum = 0.0;
            for (m, weight) in &along {
                for (n, other) in &across {
                    let alpha = m.hypot(*n);
                    if alpha > 0.0 && alpha < 40.0 {
                        let response = plate.normal(alpha) - top.normal(alpha);
                        sum += weight * other * response / alpha * (m * x + n * y).cos();
                    }
                }
            }
            let due = base[at] + sum / (cells[0] * cells[1]) as f64;
            // The sums over images promise 1e-10 of the loaded cell.
            below!((found[at] - due).abs(), 2e-10 * found[[0, 0]], cells, at);
        }
    }
    Ok(())
}

#[test]
fn loads_without_equilibrium_are_refused_by_name() -> Result<()> {
    let steel = Elastic::new(210e9, 0.3)?;
    let plate = HalfSpace::new(Substrate::Free, [Layer::new(steel, 1e-3)?])?;
    let open = Grid::new([16, 16], [1e-2, 1e-2])?;
    let half = open.periodic([true, false])?;
    let line = Grid::line(16, 1e-2)?;
    for grid in [open, half, line] {
        let refused = [
            influence_coefficients(&plate, &grid, Method::Exact).err(),
            Contact::plan(&plate, grid, Setup::default()).err(),
            traction_coefficients(&plate, &grid).err(),
            nacre::indent::Stack::plan(&[(&plate).into()]).err(),
        ];
        for error in refused {
            assert!(matches!(error, Some(Error::FreeBase { .. })), "{error:?}");
        }
    }
    // Cells of five times the thickness.
    let coarse = Grid::new([16, 16], [8e-2, 8e-2])?.periodic([true; 2])?;
    let error = influence_coefficients(&plate, &coarse, Method::Exact).err();
    assert!(error.is_some_and(|error| error.to_string().contains("4 times the thickness")));
    Ok(())
}

#[test]
fn springs_and_plates_are_checked() -> Result<()> {
    let steel = Elastic::new(210e9, 0.3)?;
    let layer = Layer::new(steel, 1e-3)?;
    assert!(Spring::new(None, None).is_err());
    for normal in [0.0, -1.0, f64::INFINITY, f64::NAN] {
        assert!(Spring::new(Some(normal), Some(1.0)).is_err(), "{normal}");
    }
    for tangential in [-1.0, f64::INFINITY, f64::NAN] {
        assert!(Spring::new(Some(1.0), Some(tangential)).is_err(), "{tangential}");
    }
    assert!(HalfSpace::new(Substrate::Free, []).is_err());
    let lowest = layer.clone().with_interface(Interface::Frictionless);
    assert!(HalfSpace::new(Substrate::Free, [lowest]).is_err());
    let ends = [Some(0.0), None];
    let plate = HalfSpace::new(Substrate::Free, [layer.clone()])?;
    assert!(plate.with_ends(ends).is_err());
    let bonded = || HalfSpace::new(steel, [layer.clone(), layer.clone()]);
    assert!(
        bonded()?.with_ends(ends).is_ok() && QuarterSpace::new(bonded()?, 0.0, [1.0; 2]).is_ok()
    );
    // Any interface that slips or has springs, under any number of layers.
    let joined = layer.clone().with_interface(spring(1e15, 1e14)?);
    let slips = layer.clone().with_interface(Interface::Frictionless);
    for one in [&joined, &slips] {
        for layers in [vec![one], vec![&layer, one], vec![one, &layer]] {
            let body = HalfSpace::new(steel, layers.into_iter().cloned())?;
            assert!(body.clone().with_ends(ends).is_err());
            assert!(body.clone().with_ends([None; 2]).is_ok());
            assert!(QuarterSpace::new(body, 0.0, [1.0; 2]).is_err());
        }
    }

    let body = HalfSpace::new(steel, [joined])?;
    let changed = body.with_value(BodyParameter::TangentialStiffness(0), 2e14)?;
    assert_eq!(changed.value(BodyParameter::TangentialStiffness(0)), Some(2e14));
    assert_eq!(changed.value(BodyParameter::NormalStiffness(0)), Some(1e15));
    assert!(HalfSpace::from(steel).with_value(BodyParameter::NormalStiffness(0), 1.0).is_err());
    Ok(())
}
