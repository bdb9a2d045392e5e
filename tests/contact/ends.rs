//! Contacts of bodies with free ends.

mod periodic;
mod refused;
mod rollers;

use std::f64::consts::FRAC_PI_2;
use std::ops::ControlFlow;

use nacre::contact::Case;
use nacre::surface::Extent;
use nacre::{
    Algorithm, Contact, Elastic, Grid, HalfSpace, HeightMap, Motion, Options, Paraboloid, Result,
    Setup, Solution, Solver, Sphere, Surface,
};
use ndarray::Array2;

use crate::support::random::uniform;

/// A straight roller of this half-length with sharp ends, for which half-width and pressure of Hertz's line are 1 at the
/// load π/2 per length.
#[derive(Debug)]
struct Straight(f64);

const HALF_LENGTH: f64 = 10.0;
const ROLLER: Straight = Straight(HALF_LENGTH);
const LOAD: f64 = 2.0 * HALF_LENGTH * FRAC_PI_2;

impl Surface for Straight {
    fn gap(&self, x: f64, y: f64) -> f64 {
        if x.abs() <= self.0 {
            2.0 * y * y
        } else {
            f64::INFINITY
        }
    }

    fn extent(&self) -> [Extent; 2] {
        [Extent::CutOff([-self.0, self.0]), Extent::Rising]
    }
}

/// A load at the distance x from the middle.
fn eccentric(load: f64, x: f64) -> Motion {
    Motion {
        eccentricity: [Some(x), None],
        ..Motion::load(load)
    }
}

/// A body with (1 − ν²)/E = 1 that ends at these places.
fn unit(poisson: f64, ends: [Option<f64>; 2]) -> Result<HalfSpace> {
    HalfSpace::from(Elastic::new(1.0 - poisson * poisson, poisson)?).with_ends(ends)
}

const WHOLE: [Option<f64>; 2] = [None; 2];
const BOTH: [Option<f64>; 2] = [Some(-HALF_LENGTH), Some(HALF_LENGTH)];

fn plan(bodies: [&HalfSpace; 2], grid: Grid) -> Result<Contact> {
    let setup = Setup {
        counterbody: Some(bodies[1].into()),
        ..Setup::default()
    };
    Contact::plan(bodies[0], grid, setup)
}

/// Options of solutions that are compared with each other to 1e-9 of Hertz's pressure.
fn tight() -> Options {
    Options {
        tolerance: 1e-11,
        ..Options::default()
    }
}

/// The straight roller on 160 × 32 cells over its length and |y| ≤ 1.5.
fn straight(bodies: [&HalfSpace; 2], motion: &Motion) -> Result<Solution> {
    let options = tight();
    plan(bodies, Grid::new([160, 32], [2.0 * HALF_LENGTH, 3.0])?)?
        .solve(&ROLLER, motion, &options)?
        .require_converged(options.tolerance)
}

fn differ(a: &Array2<f64>, b: &Array2<f64>) -> f64 {
    (a - b).fold(0.0, |worst: f64, d| worst.max(d.abs()))
}

/// Mirrored, shifted, scaled and exchanged contacts have the same pressure, to the tolerance.
#[test]
fn symmetries() -> Result<()> {
    let motion = eccentric(LOAD, 1.5);
    let (free, low) = (unit(0.3, BOTH)?, unit(0.2, [Some(-HALF_LENGTH), None])?);
    let given = straight([&low, &free], &motion)?.pressure;
    let high = unit(0.2, [None, Some(HALF_LENGTH)])?;
    let back = eccentric(LOAD, -1.5);
    let mirrored = straight([&high, &free], &back)?.pressure;
    let mirrored = Array2::from_shape_fn(given.dim(), |(i, j)| mirrored[[159 - i, j]]);
    assert!(differ(&given, &mirrored) < 1e-9);
    let exchanged = straight([&free, &low], &motion)?.pressure;
    assert!(differ(&given, &exchanged) < 1e-9);

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
        let contact = plan(
            [&moved(&low)?, &moved(&free)?],
            grid.centered_at([length * shift, 0.0])?,
        )?;
        let load = LOAD * length * length * modulus;
        let motion = eccentric(load, length * (shift + 1.5));
        let found = contact
            .solve(&shape, &motion, &tight())?
            .require_converged(1e-11)?
            .pressure
            / modulus;
        let worst = differ(&given, &found);
        assert!(worst < 1e-9, "{shift} {length}: {worst:e}");
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
fn controls_agree() -> Result<()> {
    let (free, low) = (unit(0.3, BOTH)?, unit(0.3, [Some(-HALF_LENGTH), None])?);
    let contact = plan(
        [&low, &free],
        Grid::new([160, 48], [2.0 * HALF_LENGTH, 6.0])?,
    )?;
    let solved = |motion: &Motion, options: &Options| {
        contact
            .solve(&ROLLER, motion, options)?
            .require_converged(options.tolerance)
    };
    let options = tight();
    let loaded = eccentric(LOAD, 1.0);
    let first = solved(&loaded, &options)?;
    let reference = Options {
        algorithm: Algorithm::PolonskyKeer,
        ..options.clone()
    };
    let same = |name: &str, other: &Solution| {
        let worst = differ(&first.pressure, &other.pressure);
        assert!(worst < 1e-9, "{name}: {worst:e}");
        assert!(
            (other.approach / first.approach - 1.0).abs() < 1e-10,
            "{name}"
        );
    };
    same("reference", &solved(&loaded, &reference)?);
    let tilted = |approach: f64| Motion {
        tilt: [Some(first.tilt[0]), None],
        ..Motion::approach(approach)
    };
    let pressed = tilted(first.approach);
    same("approach", &solved(&pressed, &options)?);
    let moment = Motion {
        moment: [Some(LOAD), None],
        ..Motion::load(LOAD)
    };
    same("moment", &solved(&moment, &options)?);
    let cases = [loaded, pressed].map(|motion| Case {
        shape: &ROLLER,
        motion,
    });
    let mut go_on = |_: usize| ControlFlow::Continue(());
    for solution in contact.solve_many(&cases, &options, &mut go_on)? {
        same("one of many", &solution.expect("nothing stops it")?);
    }
    // Independent of the solver: what is reported follows from the pressure by the operator.
    let u = contact.convolution().apply(&first.pressure)?;
    assert!(differ(&u, &first.displacement) < 1e-12 * first.approach);
    assert!(first.gap().iter().all(|gap| *gap > -1e-7 * first.approach));
    Ok(())
}

/// The tangent stiffness against central differences of load and moments: both err by 1e-6, the tolerance of the
/// solutions, 1e-11, over the step of 1e-5. No cell enters or leaves the contact within such a step.
#[test]
fn stiffness_is_that_of_differences() -> Result<()> {
    let (free, low) = (unit(0.3, BOTH)?, unit(0.3, [Some(-HALF_LENGTH), None])?);
    let contact = plan(
        [&low, &free],
        Grid::new([80, 32], [2.0 * HALF_LENGTH, 4.0])?,
    )?;
    let first = contact
        .solve(&ROLLER, &eccentric(LOAD, 1.0), &tight())?
        .require_converged(1e-11)?;
    let stiffness = first.stiffness()?;
    let at = |freedom: usize, step: f64| -> Result<[f64; 3]> {
        let mut rigid = [first.approach, first.tilt[0], first.tilt[1]];
        rigid[freedom] += step;
        let motion = Motion {
            tilt: [Some(rigid[1]), Some(rigid[2])],
            ..Motion::approach(rigid[0])
        };
        let found = contact
            .solve(&ROLLER, &motion, &tight())?
            .require_converged(1e-11)?;
        Ok([found.load(), found.moment()[0], found.moment()[1]])
    };
    for freedom in 0..3 {
        let step = 1e-5 * first.approach / [1.0, HALF_LENGTH, 1.0][freedom];
        let (above, below) = (at(freedom, step)?, at(freedom, -step)?);
        for row in 0..3 {
            let slope = (above[row] - below[row]) / (2.0 * step);
            let scale = (stiffness[row][row] * stiffness[freedom][freedom]).sqrt();
            let error = (stiffness[row][freedom] - slope) / scale;
            assert!(error.abs() < 1e-5, "{row} {freedom}: {stiffness:?} {slope}");
        }
    }
    Ok(())
}

/// A ball beside an end, in a window of the grid that begins behind the end: as by the reference algorithm, which knows
/// no windows. The contact is softer towards the end, and the load moves away from it.
#[test]
fn windows_keep_their_distance_from_the_end() -> Result<()> {
    let grid = Grid::new([128, 96], [8.0, 6.0])?;
    for ends in [
        [Some(-4.0), None],
        [Some(-1.5), None],
        [Some(-4.0), Some(1.25)],
        [None, Some(1.25)],
    ] {
        let contact = plan([&unit(0.3, ends)?, &unit(0.2, WHOLE)?], grid)?;
        let shape = Sphere::new(50.0)?;
        let motion = Motion::load(0.5 * 4.0 / 3.0 / 50.0);
        let solved = |algorithm: Algorithm| {
            let options = Options {
                algorithm,
                ..tight()
            };
            contact
                .solve(&shape, &motion, &options)?
                .require_converged(1e-11)
        };
        let [found, reference] = [
            solved(Algorithm::Cascade)?,
            solved(Algorithm::PolonskyKeer)?,
        ];
        let scale = reference.peak_pressure();
        let worst = differ(&found.pressure, &reference.pressure) / scale;
        assert!(worst < 1e-9, "{ends:?} {worst:e}");
        let nearer_high = ends[1].is_some();
        assert!(found.eccentricity()[0] * if nearer_high { -1.0 } else { 1.0 } > 1e-3);
        assert!((found.approach / reference.approach - 1.0).abs() < 1e-9);
    }
    Ok(())
}

/// Contacts of three and four cells beside an end under given moments, some of which end by the active set, have no
/// overlap anywhere and balance the load.
#[test]
fn few_cells_beside_an_end() -> Result<()> {
    let grid = Grid::new([45, 64], [4.5e-4, 4.8e-4])?;
    let half = 0.5 * grid.size()[0];
    let spacing = grid.spacing()[0];
    let steel: HalfSpace = Elastic::new(210e9, 0.3)?.into();
    let ended = steel
        .clone()
        .with_ends([Some(5.0 * spacing - half), Some(half)])?;
    let contact = Contact::plan(ended, grid, Setup::default())?;
    let mut by_active_set = 0;
    for seed in 0..8 {
        let rough = HeightMap::new(uniform(grid.shape(), seed) * 3e-7, grid.spacing())?;
        let shape = Paraboloid::new(5e-3, 7.5e-3)?.plus(rough);
        let place = uniform([1, 2], seed + 100);
        let e = [0, 1].map(|k| 0.6 * (place[[0, k]] - 0.5) * grid.size()[k]);
        for load in [1e-7, 1e-5, 1e-3, 1e-2] {
            let motion = Motion {
                eccentricity: e.map(Some),
                ..Motion::load(load)
            };
            let solution = contact
                .solve(&shape, &motion, &Options::default())?
                .require_converged(1e-8)?;
            let report = &solution.report;
            by_active_set += usize::from(report.solver == Some(Solver::ActiveSet));
            let balance = report.balance;
            let worst = balance.force.max(balance.moment[0]).max(balance.moment[1]);
            assert!(worst < 1e-12, "{seed} {load}: {balance:?}");
            assert!(
                solution
                    .pressure
                    .rows()
                    .into_iter()
                    .take(5)
                    .all(|row| row.sum() <= 0.0)
            );
            let u = contact.convolution().apply(&solution.pressure)?;
            assert!(
                differ(&u, &solution.displacement)
                    < 1e-12 * solution.approach.abs().max(u[[22, 32]])
            );
        }
    }
    assert!(by_active_set > 0, "none took this way");
    Ok(())
}

/// The end may lie on any edge: the coarser grids, whose cells it may cut, change the iteration and not the solution.
#[test]
fn an_end_on_any_edge() -> Result<()> {
    let (whole, free) = (unit(0.3, WHOLE)?, unit(0.3, [Some(-HALF_LENGTH), None])?);
    let mut pressures = Vec::new();
    for cells_before in [0, 1, 7, 8] {
        let spacing = 0.125;
        let length = 20.0 + spacing * f64::from(cells_before);
        let grid = Grid::new([160 + cells_before as usize, 32], [length, 3.0])?;
        let grid = grid.centered_at([HALF_LENGTH - 0.5 * length, 0.0])?;
        let solution = plan([&whole, &free], grid)?
            .solve(&ROLLER, &Motion::load(LOAD), &Options::default())?
            .require_converged(1e-8)?;
        let before = cells_before as usize;
        assert!(
            solution
                .pressure
                .rows()
                .into_iter()
                .take(before)
                .all(|row| row.sum() <= 0.0)
        );
        pressures.push(Array2::from_shape_fn((160, 32), |(i, j)| {
            solution.pressure[[before + i, j]]
        }));
    }
    for pressure in &pressures[1..] {
        assert!(differ(&pressures[0], pressure) < 1e-5);
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
        let contact = Contact::plan(body, grid, Setup::default())?;
        Ok(contact
            .solve(&ball, &Motion::load(0.1), &Options::default())?
            .approach)
    };
    let mut steps = Vec::new();
    for [near, far] in [[-1.6, -1.6333], [-1.6333, -1.6667], [-1.6667, -1.7]] {
        steps.push(approach(near)? - approach(far)?);
    }
    assert!(steps.iter().all(|step| *step > 0.0), "{steps:?}");
    assert!(
        steps[0] < 1.3 * steps[2] && steps[2] < 1.3 * steps[0],
        "{steps:?}"
    );
    Ok(())
}
