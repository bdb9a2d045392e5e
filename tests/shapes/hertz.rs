//! Contacts of a bare body equal the closed forms of Hertz and Boussinesq, and converge to them
//! with the grid.

use std::f64::consts::PI;

use nacre::{Contact, FlatPunch, Grid, Motion, Options, Paraboloid, Result, Solution, hertz};

use crate::support::claims::claim;
use crate::support::numerics::elliptic;
use crate::support::settings::{self, converged, pressed, steel, tolerance};

/// Error of a flat punch, whose singular rim is a staircase of cells with dx/a = 1/64.
const FLAT_PUNCH: f64 = 5e-3;

const RADIUS: f64 = 5e-3;
const CONTACT_RADIUS: f64 = 1e-4;

fn modulus() -> Result<f64> {
    Ok(steel()?.plane_strain_modulus())
}

/// The load at which the contact radius is [`CONTACT_RADIUS`].
fn load() -> Result<f64> {
    Ok(4.0 * modulus()? * CONTACT_RADIUS.powi(3) / (3.0 * RADIUS))
}

fn plan(shape: [usize; 2], sides: [f64; 2]) -> Result<Contact> {
    let grid = Grid::new(shape, sides.map(|side| side * CONTACT_RADIUS))?;
    settings::plan(steel()?, grid)
}

/// The ball under the load.
fn loaded(shape: [usize; 2], sides: [f64; 2]) -> Result<Solution> {
    let paraboloid = Paraboloid::new(RADIUS, RADIUS)?;
    pressed(&plan(shape, sides)?, &paraboloid, &Motion::load(load()?))
}

/// Relative errors of peak pressure, approach, and half the larger extent.
fn errors(solution: &Solution) -> Result<[f64; 3]> {
    let exact = hertz::Point::new(RADIUS, modulus()?, load()?)?;
    let [x, y] = solution.contact_extent().map(|[low, high]| 0.5 * (high - low));
    Ok([
        solution.peak_pressure() / exact.peak_pressure - 1.0,
        solution.approach / exact.approach - 1.0,
        x.max(y) / exact.radius - 1.0,
    ])
}

#[test]
fn paraboloid_equals_hertz() -> Result<()> {
    let solution = loaded([256, 256], [6.0, 6.0])?;
    let [peak, approach, radius] = errors(&solution)?;
    // The peak is read half a cell diagonal off the axis, (dx/a)²/4 = 1.4e-4 with 43 cells to a radius.
    claim("hertz-peak", peak);
    claim("hertz-approach", approach);
    // The radius from a straight line through p² is right to a tenth of a cell.
    below!(radius.abs(), 2e-3);
    Ok(())
}

#[test]
fn pressure_equals_hertz_everywhere() -> Result<()> {
    let solution = loaded([201, 150], [6.3, 5.7])?;
    let exact = hertz::Point::new(RADIUS, modulus()?, load()?)?;
    let (x, y) = (solution.grid().x(), solution.grid().y());
    for ((i, j), p) in solution.pressure.indexed_iter() {
        let r = x[i].hypot(y[j]);
        // Cells near the rim are left out, since the rim is a staircase of cells.
        let beyond = (r / exact.radius - 1.0).abs();
        let tolerance = if beyond > 0.1 { 5e-3 } else { 0.25 };
        let error = (p - exact.pressure(r)) / exact.peak_pressure;
        below!(error.abs(), tolerance, r / exact.radius);
    }
    // Displacement outside the contact, Johnson (1985), eq. (3.42a).
    let (a, r) = (exact.radius, x[0].hypot(y[0]));
    let inside = (2.0 * a * a - r * r) * (a / r).asin() + r * a * (1.0 - a * a / (r * r)).sqrt();
    let displacement = exact.peak_pressure / (2.0 * modulus()? * a) * inside;
    near!(solution.displacement[[0, 0]], displacement, 1e-4);
    Ok(())
}

#[test]
fn approach_converges_with_the_grid() -> Result<()> {
    // The rim on staircase cells makes the error uneven; over a factor of eight in the cell it
    // falls by the power 1.5 at least.
    let error = |n: usize| -> Result<f64> {
        let [_, approach, _] = errors(&loaded([n; 2], [3.0; 2])?)?;
        Ok(approach.abs())
    };
    let errors = [error(32)?, error(64)?, error(128)?, error(256)?];
    let order = (errors[0] / errors[3]).log2() / 3.0;
    assert!(order > 1.5 && errors[3] < 2e-5, "{order}: {errors:?}");
    Ok(())
}

#[test]
fn load_gives_approach_gives_load() -> Result<()> {
    let (contact, shape) = (plan([96, 80], [3.0, 2.8])?, Paraboloid::new(RADIUS, RADIUS)?);
    let solve = |motion: Motion| converged(&contact, &shape, &motion, &tolerance(1e-12));
    let given = solve(Motion::load(load()?))?;
    let moved = solve(Motion::approach(given.approach))?;
    near!(moved.load(), load()?, 1e-9);
    near!(solve(Motion::load(moved.load()))?.approach, given.approach, 1e-9);
    Ok(())
}

#[test]
fn load_grows_as_the_approach_to_three_halves() -> Result<()> {
    // Under a prescribed approach, the coefficients alone determine the scale of the pressure.
    let contact = plan([160, 160], [4.0, 4.0])?;
    let shape = Paraboloid::new(RADIUS, RADIUS)?;
    for factor in [0.5, 1.0, 2.0] {
        let approach = factor * CONTACT_RADIUS.powi(2) / RADIUS;
        let solution = contact.solve(&shape, &Motion::approach(approach), &Options::default())?;
        let expected = load()? * f64::powf(factor, 1.5);
        near!(solution.load(), expected, 2e-3);
    }
    Ok(())
}

#[test]
fn eccentric_flat_punch_tilts_as_boussinesq_found() -> Result<()> {
    let a = 1e-3;
    let contact = settings::plan(steel()?, Grid::new([256, 256], [4.0 * a; 2])?)?;
    let punch = FlatPunch::new(a)?;
    for eccentricity in [[Some(0.25 * a), None], [Some(0.0), Some(-0.25 * a)]] {
        let motion = Motion::load(1e3).with_eccentricity(eccentricity);
        let solution = pressed(&contact, &punch, &motion)?;
        let moment = eccentricity.map(|e| 1e3 * e.unwrap_or(0.0));
        for (tilt, moment) in solution.tilt.into_iter().zip(moment) {
            let (approach, exact) = hertz::flat_punch(a, modulus()?, 1e3, moment)?;
            claim("punch-approach", solution.approach / approach - 1.0);
            // The tilt is 3M/(4E*a³) where it is free, and 0 where it is locked.
            let scale = 0.75 * 0.25 * a * 1e3 / (modulus()? * a.powi(3));
            claim("punch-tilt", (tilt - exact) / scale);
        }
        // The pressure in the middle is W/2πa² (1 + 3 e x/a²).
        let central = 1e3 / (2.0 * PI * a * a);
        near!(solution.central_pressure(), central, FLAT_PUNCH);
    }
    Ok(())
}

#[test]
fn elliptic_contact_equals_hertz() -> Result<()> {
    // Johnson (1985), eqs (4.26), (4.28), for half-axes a = 3 along x and b = 1 along y, p0 = E*/20.
    let (a, b) = (3.0, 1.0);
    let (modulus, peak) = (modulus()?, 0.05 * modulus()?);
    let m: f64 = 1.0 - b * b / (a * a);
    let [k, e] = elliptic(m.sqrt());
    let common = peak / modulus * b / (m * a * a);
    let along = common * (k - e);
    let across = common * (a * a / (b * b) * e - k);
    let shape = Paraboloid::new(0.5 / along, 0.5 / across)?;
    let load = 2.0 / 3.0 * PI * a * b * peak;

    let contact = settings::plan(steel()?, Grid::new([161, 128], [8.0, 3.0])?)?;
    let solution = pressed(&contact, &shape, &Motion::load(load))?;
    near!(solution.peak_pressure(), peak, 1e-3);
    near!(solution.approach, peak * b / modulus * k, 2e-4);
    let [x, y] = solution.contact_extent();
    for (found, exact) in [(x[0], -a), (x[1], a), (y[0], -b), (y[1], b)] {
        near!(found, exact, 5e-3);
    }
    Ok(())
}
