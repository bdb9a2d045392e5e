//! The roller of Spinu et al. has the known pressure, ends and tilt, under centred and eccentric loads.

use approx::assert_relative_eq;
use nacre::{Contact, Elastic, Grid, Motion, Options, Result, Roller, Setup, Solution};

use crate::support::claims::claim;

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
fn solve(eccentricity: f64, shape: [usize; 2]) -> Result<Solution> {
    let steel = steel()?;
    let roller = Roller::new(5e-3, 2.0 * HALF_FLAT, 7.5)?;
    let grid = Grid::new(shape, [LENGTH, 0.16e-3])?;
    let motion = Motion::load(LOAD).with_eccentricity([Some(eccentricity), Some(0.0)]);
    let options = Options::default();
    let contact = plan(steel, grid)?;
    converged(&contact, &roller, &motion, &options)
}

/// Half-width at the section nearest to x = 0: p² falls linearly with y² in a line contact.
fn central_half_width(solution: &Solution) -> f64 {
    let section = solution.pressure.row(solution.grid().shape()[0] / 2);
    let half = solution.peak_pressure() / 2.0;
    let points = solution.grid().y().into_iter().zip(section);
    let inner: Vec<(f64, f64)> = points
        .filter(|(_, p)| **p > half)
        .map(|(y, p)| (y * y, p * p))
        .collect();
    let n = inner.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| inner.iter().map(f).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let slope = (mean(|p| p.0 * p.1) - x * y) / (mean(|p| p.0 * p.0) - x * x);
    (x - y / slope).sqrt()
}

/// Largest |a − b| relative to the peak, where `other(cell)` is b.
fn asymmetry(solution: &Solution, other: impl Fn(usize, usize) -> f64) -> f64 {
    let difference = solution
        .pressure
        .indexed_iter()
        .map(|((i, j), p)| (p - other(i, j)).abs());
    difference.fold(0.0, f64::max) / solution.peak_pressure()
}

#[test]
fn centred_roller_has_the_known_pressure_and_ends() -> Result<()> {
    let solution = solve(0.0, [1024, 128])?;
    let [x, y] = solution.peak_position();
    let [ends, _] = solution.contact_extent();
    let width = central_half_width(&solution);
    claim("roller", solution.central_pressure() / 774e6 - 1.0);
    claim("roller", solution.peak_pressure() / 822e6 - 1.0);
    assert_relative_eq!(x.abs(), 9.8e-3, epsilon = ENDS);
    assert!(y.abs() < solution.grid().spacing()[1]);
    near!(width, 0.0335e-3, KNOWN);
    near!(solution.approach, 0.878e-6, KNOWN);
    for (end, known) in ends.into_iter().zip([-12.7e-3, 12.7e-3]) {
        assert_relative_eq!(end, known, epsilon = ENDS);
    }
    Ok(())
}

#[test]
fn centred_roller_is_symmetric_and_does_not_tilt() -> Result<()> {
    let solution = solve(0.0, [1024, 128])?;
    let [nx, ny] = solution.grid().shape();
    let along = asymmetry(&solution, |i, j| solution.pressure[[nx - 1 - i, j]]);
    let across = asymmetry(&solution, |i, j| solution.pressure[[i, ny - 1 - j]]);
    let tilt = solution
        .tilt
        .map(|s| (s * HALF_FLAT / solution.approach).abs());
    assert!(
        along < SYMMETRIC && across < SYMMETRIC,
        "{along:e} {across:e}"
    );
    assert!(tilt[0] < SYMMETRIC && tilt[1] < SYMMETRIC, "{tilt:?}");
    Ok(())
}

#[test]
fn eccentric_force_gives_the_known_peak_tilt_and_ends() -> Result<()> {
    let solution = solve(0.3 * HALF_FLAT, [1024, 128])?;
    let [ends, _] = solution.contact_extent();
    claim("roller", solution.peak_pressure() / 985e6 - 1.0);
    claim("roller", solution.tilt[0] / 3.40e-5 - 1.0);
    for (end, known) in ends.into_iter().zip([-11.6e-3, 13.5e-3]) {
        assert_relative_eq!(end, known, epsilon = ENDS);
    }
    let balance = solution.report.balance;
    assert!(
        balance.force < 1e-12 && balance.moment[0] < 1e-12,
        "{balance:?}"
    );

    let mirrored = solve(-0.3 * HALF_FLAT, [1024, 128])?;
    let last = mirrored.grid().shape()[0] - 1;
    let difference = asymmetry(&solution, |i, j| mirrored.pressure[[last - i, j]]);
    below!(difference, SYMMETRIC);
    near!(solution.tilt[0], -mirrored.tilt[0], SYMMETRIC);
    Ok(())
}
