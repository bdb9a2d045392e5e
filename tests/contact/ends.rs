//! Contacts of bodies with free ends.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::ControlFlow;

use nacre::contact::{Case, Report};
use nacre::ends::QuarterSpace;
use nacre::influence::CellInfluence;
use nacre::surface::Extent;
use nacre::{
    Algorithm, Body, Contact, Elastic, Error, Grid, HalfSpace, HeightMap, Layer,
    LogarithmicProfile, Motion, Options, Paraboloid, Result, Roller, Setup, Solution, Solver,
    Sphere, Substrate, Surface, Warning, solve,
};
use ndarray::{Array2, Axis};

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

/// For ν = 0 a pressure that is independent of x leaves the ends of both bodies free, so that the pressure is uniform
/// along x. Superposed quarter spaces leave 1.5 % for the roller of 20 half-widths; the plate's table leaves 5e-5 of the
/// displacement for each coefficient, some of which makes pressures of a few times as much.
#[test]
fn flush_bodies_without_lateral_strain_have_uniform_pressure() -> Result<()> {
    for (half_length, rows) in [(HALF_LENGTH, 160), (2.0, 32)] {
        let body = unit(0.0, [Some(-half_length), Some(half_length)])?;
        let grid = Grid::new([rows, 32], [2.0 * half_length, 3.0])?;
        let solution = plan([&body, &body], grid)?
            .solve(
                &Straight(half_length),
                &Motion::load(half_length * PI),
                &Options::default(),
            )?
            .require_converged(1e-8)?;
        let mean = solution.pressure.mean_axis(Axis(0)).expect("rows");
        let mut worst = 0.0_f64;
        for row in solution.pressure.rows() {
            worst = (&row - &mean).fold(worst, |worst, d| worst.max(d.abs()));
        }
        println!("{half_length}: {worst:e}");
        assert!(worst < 5e-4, "{half_length}: {worst}");
        // Hertz's line, but for the outermost cells in contact, of 0.094, which the circle cuts.
        for (y, p) in grid.y().iter().zip(&mean).filter(|(y, _)| y.abs() < 0.8) {
            let hertz = (1.0 - y * y).sqrt();
            println!("{y} {}", p / hertz - 1.0);
            assert!((p / hertz - 1.0).abs() < 5e-3, "{y}: {p}");
        }
        let warnings = &solution.report.warnings;
        assert!(warnings.is_empty(), "{warnings:?}");
        let counted = solution.report.free_ends().expect("both bodies end");
        assert!(counted.plates && counted.error == Some(2e-4));
    }
    Ok(())
}

/// Where both bodies end at the same place, the pressure falls towards it, the more the larger ν, and is finite. Numbers
/// of the limits ν = ½ and 0 are in the other tests.
#[test]
fn pressure_falls_towards_flush_ends() -> Result<()> {
    let mut beside = Vec::new();
    for poisson in [0.0, 0.3, 0.5] {
        let body = unit(poisson, BOTH)?;
        let solution = straight([&body, &body], &Motion::load(LOAD))?;
        assert!(solution.report.warnings.is_empty());
        beside.push(solution.pressure[[0, 16]]);
    }
    println!("{beside:?}");
    assert!(
        beside[0] > 0.99 && beside[1] < 0.7 && beside[2] < beside[1] && beside[2] > 0.0,
        "{beside:?}"
    );
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
    assert!(
        message.contains("the free end of one body along x, and the other goes on"),
        "{message}"
    );
    let half_space = straight([&whole, &whole], &Motion::load(LOAD))?;
    assert_eq!(half_space.report.warnings, [Warning::SharpEnd { axis: 0 }]);
    assert_eq!(half_space.report.free_ends(), None);
    let message = half_space.report.warnings[0].to_string();
    assert!(message.contains("give the bodies their ends"), "{message}");
    let at_end = |solution: &Solution| solution.pressure[[0, 16]];
    assert!(at_end(&half_space) > 1.7 * at_end(&solution));
    let at_half = 0.5 * (solution.pressure[[3, 16]] + solution.pressure[[4, 16]]);
    println!("{at_half}");
    assert!((at_half / 1.062 - 1.0).abs() < 4e-3, "{at_half}");
    Ok(())
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
    println!("mirrored {:e}", differ(&given, &mirrored));
    assert!(differ(&given, &mirrored) < 1e-9);
    let exchanged = straight([&free, &low], &motion)?.pressure;
    println!("exchanged {:e}", differ(&given, &exchanged));
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
        println!("{shift} {length} {worst:e}");
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
        println!("{name} {worst:e}");
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

/// The tangent stiffness against central differences of load and moments. While the contact stays they agree to the
/// tolerance over the step, 1e-11/1e-5; that contacts grow by whole cells changes nothing, since pressure on a cell
/// grows from 0.
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
            println!("{row} {freedom}: {error:e}");
            assert!(error.abs() < 1e-5, "{row} {freedom}: {stiffness:?} {slope}");
        }
    }
    Ok(())
}

/// A ball beside an end, in a window of the grid that begins behind the end: as by the reference algorithm, which knows
/// no windows. The end draws the contact towards it.
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
        println!(
            "{ends:?} {worst:e} {:?} {:?}",
            found.contact_extent(),
            found.eccentricity()
        );
        assert!(worst < 1e-9, "{ends:?} {worst:e}");
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
    println!("{by_active_set}");
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
