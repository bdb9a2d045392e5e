//! Contacts near ends, against exact statements, a reference and given grids.

use std::f64::consts::PI;

use nacre::contact::solve_with;
use nacre::ends::QuarterSpace;
use nacre::influence::CellInfluence;
use nacre::{
    Body, Contact, Cylinder, Elastic, Grid, HalfSpace, LogarithmicProfile, Motion, Options, Result,
    Roller, Solution, Sphere, Surface, Warning, solve,
};
use ndarray::Axis;

use super::{BOTH, HALF_LENGTH, LOAD, ROLLER, Straight, WHOLE, pair, straight, unit};

use crate::support::checks::largest;
use crate::support::reference::{cases, list, number};
use crate::support::settings::{against, converged, plan, pressed, steel};

/// For ν = 0 a pressure that is independent of x leaves the ends of both bodies free, so that the pressure is uniform
/// along x. Superposed quarter spaces leave 1.5 % for the roller of 20 half-widths; the plate's table leaves 2e-5 of the
/// displacement for each coefficient, some of which makes pressures of many times as much.
#[test]
#[ignore = "slow"]
fn flush_bodies_without_lateral_strain_have_uniform_pressure() -> Result<()> {
    for (half_length, rows) in [(HALF_LENGTH, 160), (2.0, 32)] {
        let body = unit(0.0, [Some(-half_length), Some(half_length)])?;
        let grid = Grid::new([rows, 32], [2.0 * half_length, 3.0])?;
        let (contact, motion) = (pair([&body, &body], grid)?, Motion::load(half_length * PI));
        let solution = pressed(&contact, &Straight(half_length), &motion)?;
        let mean = solution.pressure.mean_axis(Axis(0)).expect("rows");
        below!(largest(&(&solution.pressure - &mean)), 5e-4, half_length);
        // Hertz's line, but for the outermost cells in contact, of 0.094, which the circle cuts.
        for (y, p) in grid.y().iter().zip(&mean).filter(|(y, _)| y.abs() < 0.8) {
            near!(p, (1.0 - y * y).sqrt(), 5e-3, y);
        }
        let warnings = &solution.report.warnings;
        assert!(warnings.is_empty(), "{warnings:?}");
        let counted = solution.report.free_ends().expect("both bodies end");
        assert!(counted.plates && counted.error == Some(1e-3));
    }
    Ok(())
}

/// Where both bodies end at the same place, the pressure falls towards it, the more the larger ν, and is finite. Numbers
/// of the limits ν = ½ and 0 are in the other tests.
#[test]
#[ignore = "slow"]
fn pressure_falls_towards_flush_ends() -> Result<()> {
    let mut beside = Vec::new();
    for poisson in [0.0, 0.3, 0.5] {
        let body = unit(poisson, BOTH)?;
        let solution = straight([&body, &body], &Motion::load(LOAD))?;
        assert!(solution.report.warnings.is_empty());
        beside.push(solution.pressure[[0, 16]]);
    }
    let [first, middle, last] = beside[..] else { unreachable!() };
    let falls = first > 0.99 && middle < 0.7 && last < middle && last > 0.0;
    assert!(falls, "{beside:?}");
    Ok(())
}

/// Pressures beside the end, against the half-space: 1.22 of Hertz's line at 0.1 instead of 2.25. A plate's pressure is
/// 0.9 % above that of superposed quarter spaces at 0.5, 1.0532 (`src/contact/plan/superposed.rs`).
#[test]
fn the_pressure_at_a_sharp_end_grows_slowly() -> Result<()> {
    let (whole, free) = (unit(0.3, WHOLE)?, unit(0.3, BOTH)?);
    let solution = straight([&whole, &free], &Motion::load(LOAD))?;
    assert_eq!(solution.report.warnings, [Warning::FreeEnd]);
    let message = solution.report.warnings[0].to_string();
    let words = "the free end of one body along x, beyond which the other extends";
    assert!(message.contains(words), "{message}");
    let half_space = straight([&whole, &whole], &Motion::load(LOAD))?;
    assert_eq!(half_space.report.warnings, [Warning::SharpEnd { axis: nacre::Axis::X }]);
    assert_eq!(half_space.report.free_ends(), None);
    let message = half_space.report.warnings[0].to_string();
    assert!(message.contains("give the bodies their ends"), "{message}");
    let at_end = |solution: &Solution| solution.pressure[[0, 16]];
    assert!(at_end(&half_space) > 1.7 * at_end(&solution));
    let at_half = 0.5 * (solution.pressure[[3, 16]] + solution.pressure[[4, 16]]);
    near!(at_half, 1.062, 4e-3);
    Ok(())
}

/// A pressure beside the axis at the distance `x` from the low end: between cells by a power of the distance.
fn pressure_at(solution: &Solution, x: f64) -> f64 {
    let spacing = solution.grid().spacing()[0];
    let below = (x / spacing - 0.5).floor() as usize;
    let [(a, p), (b, q)] = [below, below + 1].map(|row| {
        let center = (row as f64 + 0.5) * spacing;
        let column = solution.pressure.ncols() / 2;
        (center.ln(), solution.pressure[[row, column]].ln())
    });
    (p + (q - p) * (x.ln() - a) / (b - a)).exp()
}

/// The straight roller on cells of 1/16 of the half-width.
fn fine(bodies: [&HalfSpace; 2]) -> Result<Solution> {
    let grid = Grid::new([320, 48], [2.0 * HALF_LENGTH, 3.0])?;
    pressed(&pair(bodies, grid)?, &ROLLER, &Motion::load(LOAD))
}

/// Two quarter spaces, one for each end, are those of two equal bodies with one free end each. The reference of this form
/// is by dense collocation on graded cells, whose two grids differ by up to 0.15 % in pressure, and by 1.4e-4 in
/// approach; for ν = 0 there is the coarse one alone.
#[test]
#[ignore = "slow"]
fn superposed_ends_agree_with_the_reference() -> Result<()> {
    let mut count = 0;
    for case in cases("finite_roller.json") {
        let name = case["case"].as_str().expect("a name");
        if !name.ends_with("C roller exact, raceway half-space") {
            continue;
        }
        count += 1;
        let poisson = number(&case, "nu");
        let low = unit(poisson, [Some(-HALF_LENGTH), None])?;
        let high = unit(poisson, [None, Some(HALF_LENGTH)])?;
        let solution = fine([&low, &high])?;
        near!(solution.approach, number(&case, "approach"), 2e-4, name);
        let values = list(&case, "x_over_b").iter().zip(list(&case, "p_axis"));
        for (x, p) in values {
            let [x, p] = [x, p].map(|value| value.as_f64().unwrap_or(f64::NAN));
            let error = pressure_at(&solution, x) / p - 1.0;
            let tolerance = match x {
                // The second cell, whose pressure is a mean beside a singularity.
                x if x < 0.2 => 1.5e-2,
                _ if poisson > 0.0 => 1e-3,
                _ => 1.5e-3,
            };
            below!(error.abs(), tolerance, name, x);
        }
    }
    assert_eq!(count, 2);
    Ok(())
}

/// Where a body is 20 half-widths long, pressure and approach of the plate differ from those of superposed ends by up to
/// 1.4 %. The numbers are the library's own, to their last digit: they fix the sum of parts that are tested by themselves.
#[test]
#[ignore = "slow"]
fn a_plate_differs_from_superposed_ends_by_a_percent() -> Result<()> {
    for (poisson, approach, pressures) in [
        (0.3, -3.959e-3, [1.203e-2, 8.41e-3, 1.099e-3, -3.603e-3]),
        (0.0, 1.3542e-2, [7.038e-3, 5.124e-3, 4.47e-4, -2.355e-3]),
    ] {
        let low = unit(poisson, [Some(-HALF_LENGTH), None])?;
        let high = unit(poisson, [None, Some(HALF_LENGTH)])?;
        let two = fine([&low, &high])?;
        let plate = fine([&unit(poisson, WHOLE)?, &unit(poisson, BOTH)?])?;
        let found = plate.approach / two.approach - 1.0;
        below!((found - approach).abs(), 2e-5, poisson, found);
        for (x, expected) in [0.1, 0.5, 3.0, 8.0].into_iter().zip(pressures) {
            let found = pressure_at(&plate, x) / pressure_at(&two, x) - 1.0;
            below!((found - expected).abs(), 2e-5, poisson, x, found);
        }
    }
    Ok(())
}

/// The automatic grid lies between the ends, and its solution is that of a given grid. The first roller touches all along,
/// the last only in its middle; the race goes on, or ends with the roller.
#[test]
#[ignore = "slow"]
fn the_automatic_grid_ends_where_the_bodies_do() -> Result<()> {
    let steel = steel()?;
    let crowned = Roller::new(5e-3, 6e-3, 2.0)?.with_length(10e-3)?;
    let profile = LogarithmicProfile::new(2e-6, 10e-3, 0.0, 0.99)?;
    let logarithmic = Roller::with_profile(5e-3, profile)?;
    let ends = [Some(-5e-3), Some(5e-3)];
    let roller = HalfSpace::from(steel).with_ends(ends)?;
    let options = Options::default();
    for race_ends in [WHOLE, ends] {
        let race = HalfSpace::from(steel).with_ends(race_ends)?;
        let setup = against(&roller);
        let flat: &dyn Surface = &crowned;
        for (shape, load) in [(flat, 3e3), (&logarithmic, 3e3), (&logarithmic, 300.0)] {
            let motion = Motion::load(load);
            let body = Body::from(&race);
            let found = solve_with(shape, &body, &setup, &motion, &options)?
                .require_converged(options.tolerance)?;
            let [length, width] = found.grid().size();
            let [reached, half_width] = found.contact_extent().map(|[_, high]| high);
            assert!(length <= 10e-3 * (1.0 + 1e-12) && width > 2.0 * half_width);
            if reached > 4.9e-3 {
                near!(length, 10e-3, 1e-12);
            }
            let whole = Grid::new([512, 128], [10e-3, 2.4 * half_width])?;
            let expected =
                converged(&Contact::plan(&race, whole, setup.clone())?, shape, &motion, &options)?;
            near!(found.approach, expected.approach, 1e-3);
            near!(found.central_pressure(), expected.central_pressure(), 5e-3);
        }
    }
    // A shape that goes on is cut where the body ends.
    let cut = solve(&Cylinder::new(5e-3)?, &roller, &Motion::load(3000.0))?;
    assert!((cut.grid().size()[0] / 10e-3 - 1.0).abs() < 1e-9 && cut.report.converged());
    Ok(())
}

/// A ball 100 contact radii from an end: the pressure does not change, and the approach grows by the displacement that
/// the end adds under a force at this distance, W u/d, uniform over the contact to 1/100.
#[test]
#[ignore = "slow"]
fn a_far_end_adds_to_the_approach_alone() -> Result<()> {
    let (radius, load) = (1.0, 1e-3);
    for poisson in [0.0, 0.3, 0.5] {
        let material = Elastic::new(1.0, poisson)?;
        let hertz = nacre::hertz::Point::new(radius, material.plane_strain_modulus(), load)?;
        let a = hertz.radius;
        let end = -100.0 * a;
        let grid = Grid::new([64, 64], [3.0 * a, 3.0 * a])?;
        let (ball, motion) = (Sphere::new(radius)?, Motion::load(load));
        let solved = |body: HalfSpace| pressed(&plan(body, grid)?, &ball, &motion);
        let whole = solved(material.into())?;
        let ended = solved(HalfSpace::from(material).with_ends([Some(end), None])?)?;
        near!(ended.peak_pressure(), whole.peak_pressure(), 1e-4);
        // A square of side a as the force.
        let at = QuarterSpace::new(material, -end - 0.5 * a, [a, 0.5 * a])?;
        let square = CellInfluence::plan(material, [a, a], 10.0 * a)?;
        let added = (at.displacement([-end, 0.0])? - square.at([0.0, 0.0])) * load / (a * a);
        near!(ended.approach - whole.approach, added, 2e-3, poisson);
        // Of the order of the mirror image, W/(π E* 2d), for ν = 0, and three times that for ν = ½.
        let image = load / (PI * material.plane_strain_modulus() * 200.0 * a);
        assert!(added > image && added < 5.0 * image, "{poisson} {added}");
    }
    Ok(())
}
