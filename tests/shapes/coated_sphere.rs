//! A paraboloid on a coating has the pressure, the approach and the contact radius of the Fredholm
//! solution.

use nacre::{Elastic, HalfSpace, Method, Result, Substrate};
use serde_json::Value;

use crate::support::claims::claim;
use crate::support::reference::{cases, number};
use crate::support::settings::{self, stack};
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
    let substrate = Elastic::new(1.0, number(case, "poisson"))?;
    let (ratio, h) = (number(case, "modulus_ratio"), number(case, "h"));
    let body = settings::coated(substrate, ratio, h)?;
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

fn check(case: &Value, [_, fine, extrapolated]: [Measures; 3], radius: f64) {
    below!(fine.peak.abs(), AT_512, case);
    below!(fine.approach.abs(), AT_512, case);
    below!(extrapolated.peak.abs(), EXTRAPOLATED, case);
    below!(extrapolated.approach.abs(), EXTRAPOLATED, case);
    below!(fine.radius.abs(), radius, case);
}

/// The cases of which a number has this value.
fn cases_with(key: &'static str, value: f64) -> impl Iterator<Item = Value> {
    let rows = cases("sphere_coated.json").into_iter();
    rows.filter(move |case| (number(case, key) - value).abs() < 1e-9)
}

/// All thicknesses of each modulus ratio; a coating of the material of the substrate leaves a bare body, whatever its
/// thickness.
#[test]
#[ignore = "slow"]
fn coatings_of_a_quarter_to_four_times_the_modulus() -> Result<()> {
    for (ratio, expected) in [(0.25, 5), (0.5, 5), (1.0, 1), (2.0, 5), (4.0, 5)] {
        let cases: Vec<Value> = cases_with("modulus_ratio", ratio).take(expected).collect();
        assert_eq!(cases.len(), expected, "{ratio}");
        for case in cases {
            let (body, modulus) = coated(&case)?;
            let errors = errors(&body, modulus, exact(&case))?;
            claim("coated-sphere-peak", errors[0].peak);
            claim("coated-sphere-approach", errors[0].approach);
            check(&case, errors, CONTACT_RADIUS);
        }
    }
    Ok(())
}

#[test]
#[ignore = "slow"]
fn layer_on_a_rigid_base() -> Result<()> {
    for case in &cases("sphere_rigid_base.json") {
        let layer = Elastic::new(1.0, number(case, "poisson"))?;
        let body = stack(Substrate::Rigid, [[1.0, layer.poisson(), number(case, "h")]])?;
        let errors = errors(&body, layer.plane_strain_modulus(), exact(case))?;
        check(case, errors, RADIUS_ON_RIGID);
    }
    Ok(())
}

#[test]
fn central_pressure_is_read_between_the_cells() -> Result<()> {
    // The pressure on the axis is interpolated, since no cell has its centre there.
    for case in cases_with("h", 0.5) {
        let (body, modulus) = coated(&case)?;
        let solution = solve(&body, modulus, 256, Method::Exact)?;
        let central = solution.central_pressure() / solution.peak_pressure();
        let found = measures(&solution, modulus)?.peak * central;
        near!(found, number(&case, "peak"), CENTRAL);
    }
    Ok(())
}

#[test]
#[ignore = "slow"]
fn conversions_get_the_pressure_and_image_the_approach() -> Result<()> {
    let refinement = 8;
    for case in cases_with("h", 1.0) {
        let (body, modulus) = coated(&case)?;
        for (method, is_image) in [
            (Method::Plain { refinement }, false),
            (Method::Difference { refinement }, false),
            (Method::Image { refinement }, true),
        ] {
            let solution = solve(&body, modulus, 256, method)?;
            let errors = measures(&solution, modulus)?.errors(exact(&case));
            below!(errors.peak.abs(), CONVERTED, method, case);
            if is_image {
                below!(errors.approach.abs(), CONVERTED, case);
            }
        }
    }
    Ok(())
}
