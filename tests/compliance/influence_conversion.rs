//! The conversions by inverse FFT err as they are known to: `image` least, and on long thin domains
//! only `image` is of use.

use std::ops::Range;

use nacre::influence::{Method, influence_coefficients};
use nacre::{Elastic, Grid, HalfSpace, Result};
use ndarray::Array2;

use crate::support::checks::largest;
use crate::support::reference::{cases, list, number};
use crate::support::settings;

/// The reference errors at the loaded cell have this many digits in common with ours, relative,
/// and absolute where they are themselves near the accuracy of the reference coefficients.
const SAME_ERROR: (f64, f64) = (1e-3, 1e-10);

/// The largest error sits at the far corner, and the grid ends one offset before the reference.
const SAME_LARGEST: std::ops::Range<f64> = 0.85..1.001;

fn coated(modulus_ratio: f64, thickness: f64) -> Result<HalfSpace> {
    settings::coated(Elastic::new(1.0, 0.3)?, modulus_ratio, thickness)
}

/// 2N = 128 offsets of square cells of side 1.
fn square() -> Result<Grid> {
    Grid::new([64, 64], [64.0, 64.0])
}

/// Relative errors against the exact coefficients.
fn errors(body: &HalfSpace, grid: &Grid, method: Method) -> Result<Array2<f64>> {
    let exact = influence_coefficients(body, grid, Method::Exact)?;
    Ok(influence_coefficients(body, grid, method)? / exact - 1.0)
}

#[test]
#[ignore = "slow"]
fn difference_and_image_err_as_the_reference_program_found() -> Result<()> {
    let mut compared = 0;
    for case in cases("influence_conversion.json") {
        let body = coated(number(&case, "modulus_ratio"), number(&case, "h_over_dx"))?;
        for row in list(&case, "rows") {
            let refinement = number(row, "refinement") as usize;
            let method = match row["method"].as_str() {
                Some("difference") => Method::Difference { refinement },
                _ => Method::Image { refinement },
            };
            let errors = errors(&body, &square()?, method)?;
            let (found, expected) = (errors[[0, 0]], number(row, "loaded_cell"));
            let tolerance = SAME_ERROR.0 * expected.abs() + SAME_ERROR.1;
            below!((found - expected).abs(), tolerance, method, row);
            let ratio = largest(&errors) / number(row, "largest");
            assert!(SAME_LARGEST.contains(&ratio), "{method:?}: {ratio}");
            compared += 1;
        }
    }
    assert_eq!(compared, 32);
    Ok(())
}

#[test]
fn errors_stay_below_what_the_documentation_states() -> Result<()> {
    // E1/E2 = 4, h = 8 dx: at the loaded cell, and at any offset.
    let body = coated(4.0, 8.0)?;
    for (refinement, difference, image) in [
        (1, [3.2e-3, 0.175], [4.5e-4, 3.6e-2]),
        (2, [1.3e-3, 5.5e-2], [8.5e-5, 8.1e-3]),
        (4, [5.9e-4, 4.3e-2], [1.3e-5, 1.2e-3]),
        (8, [2.9e-4, 2.45e-2], [1.72e-6, 1.54e-4]),
    ] {
        for (method, bounds) in
            [(Method::Difference { refinement }, difference), (Method::Image { refinement }, image)]
        {
            let errors = errors(&body, &square()?, method)?;
            below!(errors[[0, 0]].abs(), bounds[0], method);
            below!(largest(&errors), bounds[1], method);
        }
    }
    Ok(())
}

#[test]
fn plain_is_right_at_the_loaded_cell_and_rings_next_to_it() -> Result<()> {
    let plain = Method::Plain { refinement: 4 };
    let errors = errors(&coated(4.0, 8.0)?, &square()?, plain)?;
    below!(errors[[0, 0]].abs(), 1e-3);
    below!(0.02, errors[[1, 0]].abs());
    below!(largest(&errors), 0.08);
    // It alternates about a slow drift.
    for i in 1..8 {
        let steps = [0, 1].map(|k| errors[[i + k, 0]] - errors[[i + k - 1, 0]]);
        assert!(steps[0] * steps[1] < 0.0, "offset {i}: {steps:?}");
    }
    Ok(())
}

#[test]
fn refinement_moves_the_periodic_images_away() -> Result<()> {
    // A cell mean is left of a 1/α singularity by `difference`: the error at the loaded cell falls
    // as 1/χ. `image` leaves a regular remainder: 1/χ³.
    let body = coated(4.0, 8.0)?;
    let loaded = |method| -> Result<f64> { Ok(errors(&body, &square()?, method)?[[0, 0]].abs()) };
    let check = |method: fn(usize) -> Method, expected: Range<f64>| -> Result<()> {
        for refinement in [2, 4] {
            let ratio = loaded(method(refinement))? / loaded(method(2 * refinement))?;
            assert!(expected.contains(&ratio), "{refinement}: {ratio}");
        }
        Ok(())
    };
    check(|refinement| Method::Difference { refinement }, 2.0..2.4)?;
    check(|refinement| Method::Image { refinement }, 6.0..9.0)?;
    Ok(())
}

#[test]
#[ignore = "slow"]
fn only_image_serves_a_long_thin_domain() -> Result<()> {
    // The paper's roller: 26.8 x 0.16 mm, coating of 0.04 mm, E1/E2 = 4; lengths in mm.
    let grid = Grid::new([1024, 128], [26.8, 0.16])?;
    let body = coated(4.0, 0.04)?;
    let difference = errors(&body, &grid, Method::Difference { refinement: 4 })?;
    let image = errors(&body, &grid, Method::Image { refinement: 4 })?;
    // 3 % and a factor of 15; 2.6e-3.
    assert!((0.03..0.04).contains(&difference[[0, 0]].abs()));
    assert!((14.0..16.0).contains(&largest(&difference)));
    assert!(image[[0, 0]].abs() < 1e-4 && largest(&image) < 3e-3);
    Ok(())
}

#[test]
fn conversions_of_a_bare_body_are_its_closed_form() -> Result<()> {
    // Nothing is left to transform but rounding.
    let body: HalfSpace = Elastic::new(1.0, 0.3)?.into();
    for method in [Method::Difference { refinement: 2 }, Method::Image { refinement: 2 }] {
        below!(largest(&errors(&body, &square()?, method)?), 1e-12, method);
    }
    Ok(())
}
