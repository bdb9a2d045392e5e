//! Contacts of bodies with free ends.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::ControlFlow;

use nacre::contact::{Case, Report};
use nacre::ends::QuarterSpace;
use nacre::influence::CellInfluence;
use nacre::surface::Extent;
use nacre::{
    Algorithm, Body, Contact, Elastic, Error, Grid, HalfSpace, HeightMap, Layer,
    LogarithmicProfile, Motion, Options, Result, Roller, Setup, Solution, Sphere, Substrate,
    Surface, Warning, solve,
};
use ndarray::Array2;

/// A straight roller of length 20 with sharp ends, for which half-width and pressure of Hertz's line are 1 at the
/// load π/2 per length.
#[derive(Debug)]
struct Straight;

const HALF_LENGTH: f64 = 10.0;
const LOAD: f64 = 2.0 * HALF_LENGTH * FRAC_PI_2;

impl Surface for Straight {
    fn gap(&self, x: f64, y: f64) -> f64 {
        if x.abs() <= HALF_LENGTH {
            2.0 * y * y
        } else {
            f64::INFINITY
        }
    }

    fn extent(&self) -> [Extent; 2] {
        [Extent::CutOff([-HALF_LENGTH, HALF_LENGTH]), Extent::Rising]
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

/// The straight roller on 160 × 32 cells over its length and |y| ≤ 1.5.
fn straight(bodies: [&HalfSpace; 2], motion: &Motion) -> Result<Solution> {
    let options = Options::default();
    plan(bodies, Grid::new([160, 32], [2.0 * HALF_LENGTH, 3.0])?)?
        .solve(&Straight, motion, &options)?
        .require_converged(options.tolerance)
}

fn differ(a: &Array2<f64>, b: &Array2<f64>) -> f64 {
    (a - b).fold(0.0, |worst: f64, d| worst.max(d.abs()))
}

/// For ν = 0 a pressure that is independent of x leaves the ends of both bodies free, so that Hertz's line is exact. The
/// plate's table leaves 2e-4 of the displacement; superposed quarter spaces leave 1.5 % of the pressure.
#[test]
fn flush_bodies_without_lateral_strain_have_uniform_pressure() -> Result<()> {
    let body = unit(0.0, BOTH)?;
    let solution = straight([&body, &body], &Motion::load(LOAD))?;
    let middle = solution.pressure.row(80).to_owned();
    for row in solution.pressure.rows() {
        let worst = (&row - &middle).fold(0.0, |worst: f64, d| worst.max(d.abs()));
        assert!(worst < 5e-4, "{worst}");
    }
    assert!(
        solution.report.warnings.is_empty(),
        "{:?}",
        solution.report.warnings
    );
    let counted = solution.report.free_ends().expect("both bodies end");
    assert!(counted.plates && counted.error == Some(2e-4));
    Ok(())
}

/// One end far from the other is that of the superposed reference, `finite_roller.json`, whose error is 1 % at 0.1 and
/// 0.2 % from 0.5 on; beside the far end the quarter space differs from the plate by 1 % of the pressure.
#[test]
fn the_pressure_at_a_sharp_end_grows_slowly() -> Result<()> {
    let (whole, free) = (unit(0.3, WHOLE)?, unit(0.3, BOTH)?);
    let solution = straight([&whole, &free], &Motion::load(LOAD))?;
    assert_eq!(solution.report.warnings, [Warning::FreeEnd]);
    let half_space = straight([&whole, &whole], &Motion::load(LOAD))?;
    assert_eq!(half_space.report.warnings, [Warning::SharpEnd { axis: 0 }]);
    let message = half_space.report.warnings[0].to_string();
    assert!(message.contains("give the bodies their ends"), "{message}");
    // Cells next to the end: 1.22 at 0.1, against 2.25.
    let at_end = |solution: &Solution| solution.pressure[[0, 16]];
    assert!(at_end(&half_space) > 1.7 * at_end(&solution));
    // The plate's pressure is 1.2 % above that of superposed ends, 1.0532 at 0.5, and 0.4 % below in the middle.
    let at_half = 0.5 * (solution.pressure[[3, 16]] + solution.pressure[[4, 16]]);
    assert!((at_half / 1.062 - 1.0).abs() < 4e-3, "{at_half}");
    Ok(())
}

/// Mirrored, shifted, scaled and exchanged contacts have the same pressure, to the tolerance of 1e-8.
#[test]
fn symmetries() -> Result<()> {
    let motion = eccentric(LOAD, 1.5);
    let (free, low) = (unit(0.3, BOTH)?, unit(0.2, [Some(-HALF_LENGTH), None])?);
    let given = straight([&low, &free], &motion)?.pressure;
    let high = unit(0.2, [None, Some(HALF_LENGTH)])?;
    let back = eccentric(LOAD, -1.5);
    let mirrored = straight([&high, &free], &back)?.pressure;
    let mirrored = Array2::from_shape_fn(given.dim(), |(i, j)| mirrored[[159 - i, j]]);
    assert!(differ(&given, &mirrored) < 1e-6);
    let exchanged = straight([&free, &low], &motion)?.pressure;
    assert!(differ(&given, &exchanged) < 1e-6);

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
            .solve(&shape, &motion, &Options::default())?
            .pressure
            / modulus;
        let worst = differ(&given, &found);
        assert!(worst < 1e-6, "{shift} {length}: {worst:e}");
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
        self.length * Straight.gap(x, y / self.length)
    }
}

/// Both algorithms, all controls, batches, stiffness and windows work with ends, and agree with each other.
#[test]
fn controls_agree() -> Result<()> {
    let (free, low) = (unit(0.3, BOTH)?, unit(0.3, [Some(-HALF_LENGTH), None])?);
    let contact = plan(
        [&low, &free],
        Grid::new([160, 48], [2.0 * HALF_LENGTH, 6.0])?,
    )?;
    let solved = |motion: &Motion, options: &Options| {
        contact
            .solve(&Straight, motion, options)?
            .require_converged(options.tolerance)
    };
    let options = Options::default();
    let loaded = eccentric(LOAD, 1.0);
    let first = solved(&loaded, &options)?;
    assert!(first.report.residual < 1e-8 && first.report.overlap < 1e-8);
    let reference = Options {
        algorithm: Algorithm::PolonskyKeer,
        ..options.clone()
    };
    assert!(differ(&first.pressure, &solved(&loaded, &reference)?.pressure) < 1e-5);
    let tilted = |approach: f64| Motion {
        tilt: [Some(first.tilt[0]), None],
        ..Motion::approach(approach)
    };
    let pressed = tilted(first.approach);
    assert!(differ(&first.pressure, &solved(&pressed, &options)?.pressure) < 1e-5);
    let moment = Motion {
        moment: [Some(LOAD), None],
        ..Motion::load(LOAD)
    };
    assert!(differ(&first.pressure, &solved(&moment, &options)?.pressure) < 1e-5);
    let cases = [loaded, pressed].map(|motion| Case {
        shape: &Straight,
        motion,
    });
    let mut go_on = |_: usize| ControlFlow::Continue(());
    for solution in contact.solve_many(&cases, &options, &mut go_on)? {
        let solution = solution.expect("nothing stops it")?;
        assert!(differ(&first.pressure, &solution.pressure) < 1e-5);
    }
    // dW/dδ at constant tilt, by differences.
    let stiffness = first.stiffness()?;
    let step = 1e-4 * first.approach;
    let at = |approach: f64| -> Result<f64> { Ok(solved(&tilted(approach), &options)?.load()) };
    let slope = (at(first.approach + step)? - at(first.approach - step)?) / (2.0 * step);
    assert!(
        (stiffness[0][0] / slope - 1.0).abs() < 2e-3,
        "{stiffness:?} {slope}"
    );
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
            .solve(&Straight, &Motion::load(LOAD), &Options::default())?
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

/// The automatic grid lies between the ends, and its solution is that of a given grid.
#[test]
fn the_automatic_grid_ends_where_the_bodies_do() -> Result<()> {
    let steel = Elastic::new(210e9, 0.3)?;
    let race = HalfSpace::from(steel);
    let crowned = Roller::new(5e-3, 6e-3, 2.0)?.with_length(10e-3)?;
    let profile = LogarithmicProfile::new(2e-6, 10e-3, 0.0, 0.99)?;
    let logarithmic = Roller::with_profile(5e-3, profile)?;
    let roller = HalfSpace::from(steel).with_ends([Some(-5e-3), Some(5e-3)])?;
    for shape in [&crowned as &dyn Surface, &logarithmic] {
        let setup = || Setup {
            counterbody: Some((&roller).into()),
            ..Setup::default()
        };
        let (motion, options) = (Motion::load(3000.0), Options::default());
        let mut go_on = |_: &Report| ControlFlow::Continue(());
        let body = Body::from(&race);
        let found =
            nacre::contact::solve_watched(shape, &body, &setup(), &motion, &options, &mut go_on)?;
        let half = 0.5 * found.grid().size()[0];
        assert!(half <= 5e-3 * (1.0 + 1e-9), "{half}");
        let whole = Grid::new(
            [512, 128],
            [10e-3, 2.0 * found.contact_extent()[1][1] * 1.2],
        )?;
        let expected = Contact::plan(&race, whole, setup())?
            .solve(shape, &motion, &options)?
            .require_converged(1e-8)?;
        let ratio = found.approach / expected.approach;
        assert!((ratio - 1.0).abs() < 2e-3, "{ratio}");
    }
    let cut = solve(&nacre::Cylinder::new(5e-3)?, &roller, &Motion::load(3000.0))?;
    assert!((cut.grid().size()[0] - 10e-3).abs() < 1e-9);
    Ok(())
}

/// A ball 100 contact radii from an end: the pressure does not change, and the approach grows by the displacement that
/// the end adds under a force at this distance, W u/d, uniform over the contact to 1/100.
#[test]
fn a_far_end_adds_to_the_approach_alone() -> Result<()> {
    let (radius, load) = (1.0, 1e-3);
    for poisson in [0.0, 0.3, 0.5] {
        let material = Elastic::new(1.0, poisson)?;
        let hertz = nacre::hertz::Point::new(radius, material.plane_strain_modulus(), load)?;
        let a = hertz.radius;
        let end = -100.0 * a;
        let grid = Grid::new([64, 64], [3.0 * a, 3.0 * a])?;
        let solved = |body: HalfSpace| {
            let contact = Contact::plan(body, grid, Setup::default())?;
            contact.solve(
                &Sphere::new(radius)?,
                &Motion::load(load),
                &Options::default(),
            )
        };
        let whole = solved(material.into())?;
        let ended = solved(HalfSpace::from(material).with_ends([Some(end), None])?)?;
        let ratio = ended.peak_pressure() / whole.peak_pressure();
        assert!((ratio - 1.0).abs() < 1e-4, "{ratio}");
        // A square of side a as the force.
        let at = QuarterSpace::new(material, -end - 0.5 * a, [a, 0.5 * a])?;
        let square = CellInfluence::plan(material, [a, a], 10.0 * a)?;
        let added = (at.displacement([-end, 0.0])? - square.at([0.0, 0.0])) * load / (a * a);
        let found = ended.approach - whole.approach;
        assert!(
            (found / added - 1.0).abs() < 2e-3,
            "{poisson}: {found:e} {added:e}"
        );
        // Of the order of the mirror image, W/(π E* 2d), for ν = 0, and three times that for ν = ½.
        let image = load / (PI * material.plane_strain_modulus() * 200.0 * a);
        assert!(
            added > image && added < 5.0 * image,
            "{poisson} {}",
            added / image
        );
    }
    Ok(())
}

/// A coat warns of its model.
#[test]
fn coated_ends_are_warned_of() -> Result<()> {
    let coat = Layer::new(Elastic::new(2.0, 0.3)?, 0.2)?;
    let coated = HalfSpace::new(Elastic::new(1.0, 0.3)?, [coat])?.with_ends(BOTH)?;
    let solution = straight([&coated, &unit(0.3, BOTH)?], &Motion::load(LOAD))?;
    assert_eq!(solution.report.warnings, [Warning::CoatedEnd]);
    assert_eq!(
        solution.report.free_ends().and_then(|ends| ends.error),
        Some(0.04)
    );
    Ok(())
}

fn message<T>(result: Result<T>) -> String {
    result
        .err()
        .map(|error| error.to_string())
        .unwrap_or_default()
}

#[test]
fn senseless_ends_are_refused() -> Result<()> {
    let steel = || Elastic::new(210e9, 0.3).map(HalfSpace::from);
    let crossed = message(steel()?.with_ends([Some(1.0), Some(-1.0)]));
    assert!(
        crossed.contains("ends") && crossed.contains("ascending"),
        "{crossed}"
    );
    assert!(message(steel()?.with_ends([Some(f64::NAN), None])).contains("finite"));
    let coat = Layer::new(Elastic::new(1.0, 0.3)?, 1.0)?;
    let rigid = HalfSpace::new(Substrate::Rigid, [coat])?.with_ends([Some(0.0), None]);
    assert!(message(rigid).contains("rigid substrate"));

    let grid = Grid::new([8, 8], [8.0, 8.0])?;
    let at = |low: f64, high: f64| -> Result<Contact> {
        Contact::plan(
            steel()?.with_ends([Some(low), Some(high)])?,
            grid,
            Setup::default(),
        )
    };
    let off = message(at(-1.3, 3.0));
    assert!(
        off.contains("-1.3e0 between the edges -2e0 and -1e0"),
        "{off}"
    );
    assert!(message(at(0.0, 1.0)).contains("two rows"));
    assert!(at(0.0, 2.0).is_ok() && at(-40.3, 17.7).is_ok());
    let line = Contact::plan(
        steel()?.with_ends([Some(0.0), None])?,
        Grid::line(8, 8.0)?,
        Setup::default(),
    );
    assert!(message(line).contains("line contact"));

    // The roller's material ends within the roller.
    let setup = Setup {
        counterbody: Some(steel()?.with_ends([Some(-4e-3), Some(5e-3)])?.into()),
        ..Setup::default()
    };
    let roller = Roller::new(5e-3, 6e-3, 2.0)?.with_length(10e-3)?;
    let motion = Motion::load(10.0);
    let contact = Contact::plan(steel()?, Grid::new([20, 8], [10e-3, 1e-3])?, setup.clone())?;
    let short = contact.solve(&roller, &motion, &Options::default());
    assert!(
        matches!(short, Err(Error::EndWithinShape { .. })),
        "{short:?}"
    );
    let mut go_on = |_: &Report| ControlFlow::Continue(());
    let body = Body::from(&steel()?);
    let options = Options::default();
    let short =
        nacre::contact::solve_watched(&roller, &body, &setup, &motion, &options, &mut go_on);
    assert!(matches!(short, Err(Error::EndWithinShape { .. })));
    let map = HeightMap::new(Array2::zeros((8, 8)), [1e-4, 1e-4])?;
    let within = Contact::plan(
        steel()?.with_ends([Some(-0.23e-4), None])?,
        map.grid().expect("a map has a grid"),
        Setup::default(),
    );
    assert!(matches!(within, Err(Error::EndOffGrid { .. })));
    Ok(())
}
