//! Contacts of bodies with free ends.

mod periodic;
mod rollers;

use std::f64::consts::FRAC_PI_2;
use std::ops::ControlFlow;

use nacre::contact::{Case, solve_with};
use nacre::surface::Extent;
use nacre::{
    Algorithm, Body, Contact, Elastic, Error, Grid, HalfSpace, HeightMap, Motion, Options,
    Paraboloid, Result, Roller, Solution, Solver, Sphere, Substrate, Surface, Warning,
};
use ndarray::{Array2, Axis};

use super::stiffness::assert_stiffness;

use crate::messages::message;
use crate::support::checks::{apart, pressure_off};
use crate::support::random::uniform;
use crate::support::settings::{against, by, converged, plan, pressed, stack, steel, tolerance};

/// A straight roller of this half-length with sharp ends, for which half-width and pressure of Hertz's line are 1 at the
/// load π/2 per length.
#[derive(Debug)]
struct Straight(f64);

const HALF_LENGTH: f64 = 10.0;
const ROLLER: Straight = Straight(HALF_LENGTH);
const LOAD: f64 = 2.0 * HALF_LENGTH * FRAC_PI_2;

impl Surface for Straight {
    fn gap(&self, x: f64, y: f64) -> f64 {
        if x.abs() <= self.0 { 2.0 * y * y } else { f64::INFINITY }
    }

    fn extent(&self) -> [Extent; 2] {
        [Extent::CutOff([-self.0, self.0]), Extent::Rising]
    }
}

/// A load at the distance x from the middle.
fn eccentric(load: f64, x: f64) -> Motion {
    Motion::load(load).with_eccentricity([Some(x), None])
}

/// A body with (1 − ν²)/E = 1 that ends at these places.
fn unit(poisson: f64, ends: [Option<f64>; 2]) -> Result<HalfSpace> {
    HalfSpace::from(Elastic::new(1.0 - poisson * poisson, poisson)?).with_ends(ends)
}

const WHOLE: [Option<f64>; 2] = [None; 2];
const BOTH: [Option<f64>; 2] = [Some(-HALF_LENGTH), Some(HALF_LENGTH)];

fn pair(bodies: [&HalfSpace; 2], grid: Grid) -> Result<Contact> {
    let setup = against(bodies[1]);
    Contact::plan(bodies[0], grid, setup)
}

/// Options of solutions that are compared with each other to 1e-9 of Hertz's pressure.
fn tight() -> Options {
    tolerance(1e-11)
}

/// The straight roller on 160 × 32 cells over its length and |y| ≤ 1.5.
fn straight(bodies: [&HalfSpace; 2], motion: &Motion) -> Result<Solution> {
    let contact = pair(bodies, Grid::new([160, 32], [2.0 * HALF_LENGTH, 3.0])?)?;
    converged(&contact, &ROLLER, motion, &tight())
}

/// Mirrored, shifted, scaled and exchanged contacts have the same pressure, to the tolerance.
#[test]
#[ignore = "slow"]
fn symmetries() -> Result<()> {
    let motion = eccentric(LOAD, 1.5);
    let (free, low) = (unit(0.3, BOTH)?, unit(0.2, [Some(-HALF_LENGTH), None])?);
    let given = straight([&low, &free], &motion)?.pressure;
    let high = unit(0.2, [None, Some(HALF_LENGTH)])?;
    let back = eccentric(LOAD, -1.5);
    let mirrored = straight([&high, &free], &back)?.pressure;
    let mirrored = Array2::from_shape_fn(given.dim(), |(i, j)| mirrored[[159 - i, j]]);
    assert!(apart(&given, &mirrored) < 1e-9);
    let exchanged = straight([&free, &low], &motion)?.pressure;
    assert!(apart(&given, &exchanged) < 1e-9);

    // Along x by 3, and lengths by 1e-3 with moduli by 1e9.
    for (shift, length, modulus) in [(3.0, 1.0, 1.0), (0.0, 1e-3, 1e9)] {
        let moved = |body: &HalfSpace| -> Result<HalfSpace> {
            let material = body.surface_material();
            let material = Elastic::new(modulus * material.young(), material.poisson())?;
            let ends = body.ends().map(|end| Some(length * (end? + shift)));
            HalfSpace::from(material).with_ends(ends)
        };
        let shape = Scaled { length, shift };
        let grid = Grid::new([160, 32], [length * 20.0, length * 3.0])?;
        let grid = grid.centered_at([length * shift, 0.0])?;
        let contact = pair([&moved(&low)?, &moved(&free)?], grid)?;
        let load = LOAD * length * length * modulus;
        let motion = eccentric(load, length * (shift + 1.5));
        let found = converged(&contact, &shape, &motion, &tight())?.pressure / modulus;
        let worst = apart(&given, &found);
        below!(worst, 1e-9, shift, length);
    }
    Ok(())
}

/// The straight roller in other units, and shifted.
#[derive(Debug)]
struct Scaled {
    length: f64,
    shift: f64,
}

impl Surface for Scaled {
    fn gap(&self, x: f64, y: f64) -> f64 {
        // Rounding must not cut the outermost cells.
        let x = (x / self.length - self.shift) * (1.0 - 1e-12);
        self.length * ROLLER.gap(x, y / self.length)
    }
}

/// Both algorithms, all controls and batches agree with each other to the tolerance, and the certificate is that of the
/// whole operator.
#[test]
#[ignore = "slow"]
fn controls_agree() -> Result<()> {
    let (free, low) = (unit(0.3, BOTH)?, unit(0.3, [Some(-HALF_LENGTH), None])?);
    let grid = Grid::new([160, 48], [2.0 * HALF_LENGTH, 6.0])?;
    let contact = pair([&low, &free], grid)?;
    let solved = |motion: &Motion, options: &Options| converged(&contact, &ROLLER, motion, options);
    let options = tight();
    let loaded = eccentric(LOAD, 1.0);
    let first = solved(&loaded, &options)?;
    let reference = by(Algorithm::PolonskyKeer, 1e-11);
    let same = |name: &str, other: &Solution| {
        below!(apart(&first.pressure, &other.pressure), 1e-9, name);
        near!(other.approach, first.approach, 1e-10, name);
    };
    same("reference", &solved(&loaded, &reference)?);
    let moved = Motion::approach(first.approach).with_tilt([Some(first.tilt[0]), None]);
    same("approach", &solved(&moved, &options)?);
    let moment = Motion::load(LOAD).with_moment([Some(LOAD), None]);
    same("moment", &solved(&moment, &options)?);
    let shape = &ROLLER;
    let cases = [loaded, moved].map(|motion| Case::new(shape, motion));
    let mut go_on = |_: usize| ControlFlow::Continue(());
    for solution in contact.solve_many(&cases, &options, &mut go_on)? {
        same("one of many", &solution.expect("nothing stops it")?);
    }
    // Independent of the solver: what is reported follows from the pressure by the operator.
    let u = contact.convolution().apply(&first.pressure)?;
    assert!(apart(&u, &first.displacement) < 1e-12 * first.approach);
    assert!(first.gap().iter().all(|gap| *gap > -1e-7 * first.approach));
    Ok(())
}

/// The tangent stiffness against central differences of load and moments: both err by 1e-6, the tolerance of the
/// solutions, 1e-13, over the step of 1e-5. No cell enters or leaves the contact within such a step.
#[test]
#[ignore = "slow"]
fn stiffness_is_that_of_differences() -> Result<()> {
    let (free, low) = (unit(0.3, BOTH)?, unit(0.3, [Some(-HALF_LENGTH), None])?);
    let grid = Grid::new([80, 32], [2.0 * HALF_LENGTH, 4.0])?;
    let contact = pair([&low, &free], grid)?;
    let first = converged(&contact, &ROLLER, &eccentric(LOAD, 1.0), &tight())?;
    let at = [first.approach, first.tilt[0], first.tilt[1]];
    assert_stiffness(&contact, &ROLLER, at, 1e-5, 1e-5)
}

/// A ball beside an end, in a window of the grid that begins behind the end: as by the reference algorithm, which knows
/// no windows. The contact is softer towards the end, and the load moves away from it.
#[test]
#[ignore = "slow"]
fn windows_keep_their_distance_from_the_end() -> Result<()> {
    let grid = Grid::new([128, 96], [8.0, 6.0])?;
    for ends in
        [[Some(-4.0), None], [Some(-1.5), None], [Some(-4.0), Some(1.25)], [None, Some(1.25)]]
    {
        let contact = pair([&unit(0.3, ends)?, &unit(0.2, WHOLE)?], grid)?;
        let shape = Sphere::new(50.0)?;
        let motion = Motion::load(0.5 * 4.0 / 3.0 / 50.0);
        let [found, reference] = [Algorithm::Cascade, Algorithm::PolonskyKeer]
            .map(|algorithm| converged(&contact, &shape, &motion, &by(algorithm, 1e-11)));
        let (found, reference) = (found?, reference?);
        below!(pressure_off(&found, &reference), 1e-9, ends);
        let away = if ends[1].is_some() { -1.0 } else { 1.0 };
        assert!(found.eccentricity()[0] * away > 1e-3);
        near!(found.approach, reference.approach, 1e-9);
    }
    Ok(())
}

/// Contacts of three and four cells beside an end under given moments, some of which end by the active set, have no
/// overlap anywhere and balance the load.
#[test]
#[ignore = "slow"]
fn few_cells_beside_an_end() -> Result<()> {
    let grid = Grid::new([45, 64], [4.5e-4, 4.8e-4])?;
    let half = 0.5 * grid.size()[0];
    let spacing = grid.spacing()[0];
    let ends = [Some(5.0 * spacing - half), Some(half)];
    let ended = HalfSpace::from(steel()?).with_ends(ends)?;
    let contact = plan(ended, grid)?;
    let mut by_active_set = 0;
    for seed in 0..8 {
        let rough = HeightMap::new(uniform(grid.shape(), seed) * 3e-7, grid.spacing())?;
        let shape = Paraboloid::new(5e-3, 7.5e-3)?.plus(rough);
        let place = uniform([1, 2], seed + 100);
        let e = [0, 1].map(|k| 0.6 * (place[[0, k]] - 0.5) * grid.size()[k]);
        for load in [1e-7, 1e-5, 1e-3, 1e-2] {
            let motion = Motion::load(load).with_eccentricity(e.map(Some));
            let solution = pressed(&contact, &shape, &motion)?;
            let report = &solution.report;
            by_active_set += usize::from(report.solver == Some(Solver::ActiveSet));
            let balance = report.balance;
            let worst = balance.force.max(balance.moment[0]).max(balance.moment[1]);
            below!(worst, 1e-12, seed, load, balance);
            assert!(solution.pressure.slice_axis(Axis(0), (..5).into()).sum() <= 0.0);
            let u = contact.convolution().apply(&solution.pressure)?;
            let scale = solution.approach.abs().max(u[[22, 32]]);
            below!(apart(&u, &solution.displacement), 1e-12 * scale, seed, load);
        }
    }
    assert!(by_active_set > 0, "none took this way");
    Ok(())
}

/// The end may lie on any edge: the coarser grids, whose cells it may cut, change the iteration and not the solution.
#[test]
#[ignore = "slow"]
fn an_end_on_any_edge() -> Result<()> {
    let (whole, free) = (unit(0.3, WHOLE)?, unit(0.3, [Some(-HALF_LENGTH), None])?);
    let mut pressures = Vec::new();
    for before in [0, 1, 7, 8] {
        let length = 20.0 + 0.125 * before as f64;
        let grid = Grid::new([160 + before, 32], [length, 3.0])?;
        let grid = grid.centered_at([HALF_LENGTH - 0.5 * length, 0.0])?;
        let solution = pressed(&pair([&whole, &free], grid)?, &ROLLER, &Motion::load(LOAD))?;
        let (outside, inside) = solution.pressure.view().split_at(Axis(0), before);
        assert!(outside.sum() <= 0.0);
        pressures.push(inside.to_owned());
    }
    for pressure in &pressures[1..] {
        assert!(apart(&pressures[0], pressure) < 1e-5);
    }
    Ok(())
}

/// An end outside the grid, even by less than half a cell, acts from where it is: the approach changes evenly with it.
#[test]
fn an_end_outside_the_grid() -> Result<()> {
    let grid = Grid::new([32, 32], [3.2, 3.2])?;
    let ball = Sphere::new(10.0)?;
    let approach = |end: f64| -> Result<f64> {
        let body = unit(0.3, [Some(end), None])?;
        let contact = plan(body, grid)?;
        Ok(pressed(&contact, &ball, &Motion::load(0.1))?.approach)
    };
    let mut steps = Vec::new();
    for [near, far] in [[-1.6, -1.6333], [-1.6333, -1.6667], [-1.6667, -1.7]] {
        steps.push(approach(near)? - approach(far)?);
        below!(0.0, steps[steps.len() - 1], near);
    }
    below!(steps[0], 1.3 * steps[2]);
    below!(steps[2], 1.3 * steps[0]);
    Ok(())
}

/// A coat warns of its model.
#[test]
fn coated_ends_are_warned_of() -> Result<()> {
    let coated = stack(Elastic::new(1.0, 0.3)?, [[2.0, 0.3, 0.2]])?.with_ends(BOTH)?;
    let solution = straight([&coated, &unit(0.3, BOTH)?], &Motion::load(LOAD))?;
    assert_eq!(solution.report.warnings, [Warning::CoatedEnd]);
    let error = solution.report.free_ends().and_then(|ends| ends.error);
    assert_eq!(error, Some(0.04));
    Ok(())
}

#[test]
fn senseless_ends_are_refused() -> Result<()> {
    let steel = || steel().map(HalfSpace::from);
    let crossed = message(steel()?.with_ends([Some(1.0), Some(-1.0)]));
    let says = ["ends", "ascending"].map(|word| crossed.contains(word));
    assert!(says[0] && says[1], "{crossed}");
    assert!(message(steel()?.with_ends([Some(f64::NAN), None])).contains("finite"));
    let rigid = stack(Substrate::Rigid, [[1.0, 0.3, 1.0]])?.with_ends([Some(0.0), None]);
    assert!(message(rigid).contains("rigid substrate"));

    let grid = Grid::new([8, 8], [8.0, 8.0])?;
    let at = |low: f64, high: f64| -> Result<Contact> {
        plan(steel()?.with_ends([Some(low), Some(high)])?, grid)
    };
    let off = message(at(-1.3, 3.0));
    let places = "-1.3e0 between the edges -2e0 and -1e0";
    assert!(off.contains(places), "{off}");
    assert!(message(at(0.0, 1.0)).contains("two rows"));
    assert!(at(0.0, 2.0).is_ok() && at(-40.3, 17.7).is_ok());
    let line = plan(steel()?.with_ends([Some(0.0), None])?, Grid::line(8, 8.0)?);
    assert!(message(line).contains("line contact"));

    // The roller's material ends within the roller.
    let setup = against(steel()?.with_ends([Some(-4e-3), Some(5e-3)])?);
    let roller = Roller::new(5e-3, 6e-3, 2.0)?.with_length(10e-3)?;
    let motion = Motion::load(10.0);
    let contact = Contact::plan(steel()?, Grid::new([20, 8], [10e-3, 1e-3])?, setup.clone())?;
    let short = contact.solve(&roller, &motion, &Options::default());
    let (body, options) = (Body::from(&steel()?), Options::default());
    let searched = solve_with(&roller, &body, &setup, &motion, &options);
    for found in [short, searched] {
        let named = matches!(found, Err(Error::EndWithinShape { .. }));
        assert!(named, "{found:?}");
    }
    let map = HeightMap::new(Array2::zeros((8, 8)), [1e-4, 1e-4])?;
    let cells = map.grid().expect("a map has a grid");
    let within = plan(steel()?.with_ends([Some(-0.23e-4), None])?, cells);
    assert!(matches!(within, Err(Error::EndOffGrid { .. })));
    Ok(())
}
