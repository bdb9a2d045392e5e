//! A paraboloid on a coating has the pressure, the approach and the contact radius of the Fredholm
//! solution.

use nacre::{Elastic, HalfSpace, Layer, Method, Result, Substrate};
use serde_json::Value;

use crate::support::claims::claim;
use crate::support::reference::{cases, number};
use crate::support::sphere::{Measures, measures, solve};

/// Error of peak pressure and approach on 512² cells over a side of 6 a_H, of second order in the cells.
const AT_512: f64 = 2e-4;

/// Error of peak pressure and approach, extrapolated from 256² and 512² cells.
const EXTRAPOLATED: f64 = 2e-5;

/// Error of the contact radius on 512² cells, where p² is extrapolated to zero.
const CONTACT_RADIUS: f64 = 1e-3;

/// Error of the contact radius of layers on a rigid base. p² is least linear near the edge for the
/// thinnest layer.
const RADIUS_ON_RIGID: f64 = 2e-3;

/// Error of the pressure on the axis with 256² cells: half the error of the peak, which is read off
/// the axis.
const CENTRAL: f64 = 5e-5;

/// Error of the peak pressure by any conversion, and of the approach by `image`, with 256² cells and
/// χ = 8.
const CONVERTED: f64 = 1e-3;

fn coated(case: &Value) -> Result<(HalfSpace, f64)> {
    let nu = number(case, "poisson");
    let substrate = Elastic::new(1.0, nu)?;
    let coating = Elastic::new(number(case, "modulus_ratio"), nu)?;
    let body = HalfSpace::new(substrate, [Layer::new(coating, number(case, "h"))?])?;
    Ok((body, substrate.plane_strain_modulus()))
}

fn exact(case: &Value) -> Measures {
    Measures {
        peak: number(case, "peak"),
        approach: number(case, "approach"),
        radius: number(case, "radius"),
    }
}

/// Errors on 256² and 512² cells, and extrapolated from both.
fn errors(body: &HalfSpace, modulus: f64, exact: Measures) -> Result<[Measures; 3]> {
    let of = |n: usize| measures(&solve(body, modulus, n, Method::Exact)?, modulus);
    let (coarse, fine) = (of(256)?, of(512)?);
    Ok([coarse, fine, coarse.extrapolated(fine)].map(|found| found.errors(exact)))
}

fn check(name: &str, [_, fine, extrapolated]: [Measures; 3], radius: f64) {
    assert!(
        fine.peak.abs() < AT_512 && fine.approach.abs() < AT_512,
        "{name}: {fine:?}"
    );
    let limit = extrapolated.peak.abs().max(extrapolated.approach.abs());
    below!(limit, EXTRAPOLATED, name, extrapolated);
    below!(fine.radius.abs(), radius, name, fine);
}

/// Compares all thicknesses of one modulus ratio; there are `expected` of them.
fn check_ratio(modulus_ratio: f64, expected: usize) -> Result<()> {
    let rows = cases("sphere_coated.json");
    let of_ratio = rows
        .iter()
        .filter(|case| (number(case, "modulus_ratio") - modulus_ratio).abs() < 1e-9)
        .take(expected);
    let mut compared = 0;
    for case in of_ratio {
        let (body, modulus) = coated(case)?;
        let name = format!("E1/E2 = {modulus_ratio}, h/a_H = {}", number(case, "h"));
        let errors = errors(&body, modulus, exact(case))?;
        claim("coated-sphere-peak", errors[0].peak);
        claim("coated-sphere-approach", errors[0].approach);
        check(&name, errors, CONTACT_RADIUS);
        compared += 1;
    }
    assert_eq!(compared, expected);
    Ok(())
}

#[test]
fn coating_of_a_quarter_of_the_modulus() -> Result<()> {
    check_ratio(0.25, 5)
}

#[test]
fn coating_of_half_the_modulus() -> Result<()> {
    check_ratio(0.5, 5)
}

#[test]
fn coating_of_the_same_modulus() -> Result<()> {
    // A coating of the material of the substrate leaves a bare body, whatever its thickness.
    check_ratio(1.0, 1)
}

#[test]
fn coating_of_twice_the_modulus() -> Result<()> {
    check_ratio(2.0, 5)
}

#[test]
fn coating_of_four_times_the_modulus() -> Result<()> {
    check_ratio(4.0, 5)
}

#[test]
fn layer_on_a_rigid_base() -> Result<()> {
    for case in &cases("sphere_rigid_base.json") {
        let layer = Elastic::new(1.0, number(case, "poisson"))?;
        let body = HalfSpace::new(Substrate::Rigid, [Layer::new(layer, number(case, "h"))?])?;
        let name = format!("h/a_H = {}, nu = {}", number(case, "h"), layer.poisson());
        let errors = errors(&body, layer.plane_strain_modulus(), exact(case))?;
        check(&name, errors, RADIUS_ON_RIGID);
    }
    Ok(())
}

#[test]
fn central_pressure_is_read_between_the_cells() -> Result<()> {
    // The pressure on the axis is interpolated, since no cell has its centre there.
    let rows = cases("sphere_coated.json");
    for case in rows
        .iter()
        .filter(|case| (number(case, "h") - 0.5).abs() < 1e-9)
    {
        let (body, modulus) = coated(case)?;
        let solution = solve(&body, modulus, 256, Method::Exact)?;
        let central = solution.central_pressure() / solution.peak_pressure();
        let found = measures(&solution, modulus)?.peak * central;
        near!(found, number(case, "peak"), CENTRAL);
    }
    Ok(())
}

#[test]
fn conversions_get_the_pressure_and_image_the_approach() -> Result<()> {
    let refinement = 8;
    let rows = cases("sphere_coated.json");
    for case in rows
        .iter()
        .filter(|case| (number(case, "h") - 1.0).abs() < 1e-9)
    {
        let (body, modulus) = coated(case)?;
        let mut approaches = Vec::new();
        for method in [
            Method::Plain { refinement },
            Method::Difference { refinement },
            Method::Image { refinement },
        ] {
            let solution = solve(&body, modulus, 256, method)?;
            let errors = measures(&solution, modulus)?.errors(exact(case));
            below!(errors.peak.abs(), CONVERTED, method, errors);
            approaches.push(errors.approach);
        }
        below!(approaches[2].abs(), CONVERTED, approaches);
    }
    Ok(())
}
