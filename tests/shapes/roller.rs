//! The roller of Spinu et al. has the known pressure, ends and tilt, under centred and eccentric loads.

use nacre::{Grid, Motion, Result, Roller, Solution};
use ndarray::{Array2, Axis};

use crate::support::checks::difference;
use crate::support::claims::claim;
use crate::support::settings::{plan, pressed, steel};

/// Relative tolerance of the known values, which have three digits.
const KNOWN: f64 = 5e-3;

/// Tolerance of the ends: two cells along x, and half of the last digit of the known ends.
const ENDS: f64 = 2.0 * LENGTH / 1024.0 + 0.05e-3;

/// Asymmetry of the pressure, relative to the peak, and of the tilt.
const SYMMETRIC: f64 = 1e-9;

/// Side lengths of the grid \[m\].
const LENGTH: f64 = 28.8e-3;

const LOAD: f64 = 1e3;
const HALF_FLAT: f64 = 9.565e-3;

/// The rigid roller on steel, free to tilt along x and y under a force at x = `eccentricity`.
fn solve(eccentricity: f64) -> Result<Solution> {
    let roller = Roller::new(5e-3, 2.0 * HALF_FLAT, 7.5)?;
    let contact = plan(steel()?, Grid::new([1024, 128], [LENGTH, 0.16e-3])?)?;
    let motion = Motion::load(LOAD).with_eccentricity([Some(eccentricity), Some(0.0)]);
    pressed(&contact, &roller, &motion)
}

/// Half-width at the section nearest to x = 0: p² falls linearly with y² in a line contact.
fn central_half_width(solution: &Solution) -> f64 {
    let section = solution.pressure.row(solution.grid().shape()[0] / 2);
    let half = solution.peak_pressure() / 2.0;
    let points = solution.grid().y().into_iter().zip(section);
    let inner: Vec<(f64, f64)> =
        points.filter(|(_, p)| **p > half).map(|(y, p)| (y * y, p * p)).collect();
    let n = inner.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| inner.iter().map(f).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let slope = (mean(|p| p.0 * p.1) - x * y) / (mean(|p| p.0 * p.0) - x * x);
    (x - y / slope).sqrt()
}

/// A field seen from the other end of an axis.
fn mirrored(field: &Array2<f64>, axis: usize) -> Array2<f64> {
    let mut view = field.view();
    view.invert_axis(Axis(axis));
    view.to_owned()
}

#[test]
fn centred_roller_has_the_known_pressure_and_ends_and_is_symmetric() -> Result<()> {
    let solution = solve(0.0)?;
    let [x, y] = solution.peak_position();
    let [ends, _] = solution.contact_extent();
    claim("roller", solution.central_pressure() / 774e6 - 1.0);
    claim("roller", solution.peak_pressure() / 822e6 - 1.0);
    below!((x.abs() - 9.8e-3).abs(), ENDS);
    below!(y.abs(), solution.grid().spacing()[1]);
    near!(central_half_width(&solution), 0.0335e-3, KNOWN);
    near!(solution.approach, 0.878e-6, KNOWN);
    for (end, known) in ends.into_iter().zip([-12.7e-3, 12.7e-3]) {
        below!((end - known).abs(), ENDS);
    }
    for axis in [0, 1] {
        let other = mirrored(&solution.pressure, axis);
        below!(difference(&solution.pressure, &other), SYMMETRIC, axis);
        let tilt = solution.tilt[axis] * HALF_FLAT / solution.approach;
        below!(tilt.abs(), SYMMETRIC, axis);
    }
    Ok(())
}

#[test]
#[ignore = "slow"]
fn eccentric_force_gives_the_known_peak_tilt_and_ends() -> Result<()> {
    let solution = solve(0.3 * HALF_FLAT)?;
    let [ends, _] = solution.contact_extent();
    claim("roller", solution.peak_pressure() / 985e6 - 1.0);
    claim("roller", solution.tilt[0] / 3.40e-5 - 1.0);
    for (end, known) in ends.into_iter().zip([-11.6e-3, 13.5e-3]) {
        below!((end - known).abs(), ENDS);
    }
    let balance = solution.report.balance;
    below!(balance.force, 1e-12);
    below!(balance.moment[0], 1e-12);

    let other = solve(-0.3 * HALF_FLAT)?;
    below!(difference(&solution.pressure, &mirrored(&other.pressure, 0)), SYMMETRIC);
    near!(solution.tilt[0], -other.tilt[0], SYMMETRIC);
    Ok(())
}
