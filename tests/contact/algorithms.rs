//! The default algorithm and the reference algorithm find the same solution, for every shape and control,
//! on coated and bare bodies.

use nacre::influence::Method;
use nacre::{
    Algorithm, Contact, Elastic, FlatPunch, Grid, HalfSpace, HeightMap, Layer, Motion, Options,
    Paraboloid, Result, Setup, Solution, Sphere, Surface,
};
use ndarray::Array2;

/// Residual and overlap to which both algorithms solve.
const TOLERANCE: f64 = 1e-12;

/// Difference of pressures, relative to the peak: the residual times the condition of the problem, which
/// grows as the number of cells across the grid: some 1e-10 of the peak.
const SAME: f64 = 1e-9;

fn motions() -> [(&'static str, Motion); 8] {
    let load = Motion::load(10.0);
    let approach = Motion::approach(1e-6);
    [
        ("load", load),
        (
            "eccentric load",
            Motion {
                eccentricity: [Some(2e-5), Some(1e-5)],
                ..load
            },
        ),
        (
            "eccentric along x, locked along y",
            Motion {
                eccentricity: [Some(2e-5), None],
                ..load
            },
        ),
        (
            "moment along x, tilt along y",
            Motion {
                moment: [Some(1e-4), None],
                tilt: [None, Some(1e-4)],
                ..load
            },
        ),
        ("approach", approach),
        (
            "approach and moments",
            Motion {
                moment: [Some(1e-5), Some(0.0)],
                ..approach
            },
        ),
        (
            "approach and tilt",
            Motion {
                tilt: [Some(1e-4), None],
                ..approach
            },
        ),
        (
            "approach, no moment along x",
            Motion {
                moment: [Some(0.0), None],
                ..approach
            },
        ),
    ]
}

/// A sum of waves with about the roughness of a ground surface.
fn rough(grid: &Grid) -> Result<HeightMap> {
    let (x, y) = (grid.x(), grid.y());
    let waves = [
        (1.0, 3.0, 0.3),
        (5.0, 2.0, 1.1),
        (4.0, 7.0, 2.9),
        (9.0, 8.0, 4.2),
        (3.0, 12.0, 5.5),
    ];
    let heights = Array2::from_shape_fn(grid.shape(), |(i, j)| {
        waves
            .iter()
            .map(|(m, n, phase)| (1.6e4 * (m * x[i] + n * y[j]) + phase).cos() / (m * m + n * n))
            .sum::<f64>()
            * 2e-6
    });
    HeightMap::new(heights, grid.spacing())
}

fn solve(
    contact: &Contact,
    shape: &dyn Surface,
    motion: &Motion,
    algorithm: Algorithm,
) -> Result<Solution> {
    let options = Options {
        tolerance: TOLERANCE,
        algorithm,
        ..Options::default()
    };
    contact
        .solve(shape, motion, &options)?
        .require_converged(TOLERANCE)
}

#[test]
fn cascade_finds_the_solution_of_polonsky_and_keer() -> Result<()> {
    let steel = Elastic::new(210e9, 0.3)?;
    let coating = Layer::new(Elastic::new(840e9, 0.3)?, 40e-6)?;
    let grid = Grid::new([72, 59], [4e-4, 3.28e-4])?;
    let map = rough(&grid)?;
    let sphere = Sphere::new(5e-3)?;
    let shapes: [(&str, Box<dyn Surface>); 6] = [
        ("sphere", Box::new(sphere)),
        ("paraboloid", Box::new(Paraboloid::new(5e-3, 2e-3)?)),
        ("punch", Box::new(FlatPunch::new(1e-4)?)),
        ("rough", Box::new(map.clone())),
        ("rough sphere", Box::new(sphere.plus(map))),
        ("shifted sphere", Box::new(sphere.shifted(3e-5, -2e-5)?)),
    ];
    for body in [HalfSpace::from(steel), HalfSpace::new(steel, [coating])?] {
        let contact = Contact::plan(&body, grid, Setup::default())?;
        for (name, shape) in &shapes {
            for (control, motion) in motions() {
                let fast = solve(&contact, shape, &motion, Algorithm::Cascade)?;
                let reference = solve(&contact, shape, &motion, Algorithm::PolonskyKeer)?;
                let peak = reference.peak_pressure();
                assert!(peak > 1e6, "{name}, {control}: nothing touches");
                let difference = (&fast.pressure - &reference.pressure)
                    .fold(0.0, |worst: f64, d| worst.max(d.abs()));
                assert!(
                    difference < SAME * peak,
                    "{name}, {control}: {:e}",
                    difference / peak
                );
                assert!(
                    fast.report.convolutions < reference.report.convolutions,
                    "{name}, {control}: {} against {} convolutions",
                    fast.report.convolutions,
                    reference.report.convolutions
                );
            }
        }
    }
    Ok(())
}

/// Where a direction of the reference algorithm does not descend, a step backwards would give cells that join
/// a pressure below 0.
#[test]
fn no_pressure_is_below_zero() -> Result<()> {
    let coat = Layer::new(Elastic::new(1.0, -0.99)?, 1.0 / 12.0)?;
    let body = HalfSpace::new(Elastic::new(1.0, 0.3)?, [coat])?;
    let contact = Contact::plan(body, Grid::line(24, 1.0)?, Setup::default())?;
    let shape = FlatPunch::new(0.4)?;
    for tilt in [0.002, 0.003, 0.004] {
        let motion = Motion {
            tilt: [None, Some(tilt)],
            ..Motion::load(0.003)
        };
        let fast = solve(&contact, &shape, &motion, Algorithm::Cascade)?;
        let reference = solve(&contact, &shape, &motion, Algorithm::PolonskyKeer)?;
        let peak = fast.peak_pressure();
        for (p, q) in fast.pressure.iter().zip(&reference.pressure) {
            assert!(*p >= 0.0 && *q >= 0.0, "{tilt}: {p} {q}");
            assert!((p - q).abs() < SAME * peak, "{tilt}: {p} {q}");
        }
    }
    Ok(())
}

/// Influence coefficients by conversion on two cells are not positive definite: some pressure would pull.
#[test]
fn conversions_on_too_few_cells_are_named() -> Result<()> {
    let coat = Layer::new(Elastic::new(5.0, 0.3)?, 4e-4)?;
    let body = HalfSpace::new(Elastic::new(35425.0, 0.3)?, [coat])?;
    let setup = Setup {
        method: Method::Difference { refinement: 4 },
        ..Setup::default()
    };
    let planned = Contact::plan(body, Grid::new([2, 2], [2e-3, 8e-7])?, setup);
    let text = planned.map_or_else(|error| error.to_string(), |_| "planned".into());
    let begins = "the influence coefficients are not positive definite, so that";
    assert!(text.starts_with(begins), "{text}");
    Ok(())
}

/// On a substrate 1e12 times softer than its coat, the displacement is uniform to 3e-8. The default tolerance
/// refers to the part that is not, or to 1e-6 of the displacement, which leaves 30 · 1e-8 of the pressure.
#[test]
fn tolerance_is_that_of_the_local_displacement() -> Result<()> {
    let coat = Layer::new(Elastic::new(200e9, 0.3)?, 3e-4)?;
    let body = HalfSpace::new(Elastic::new(0.2, 0.45)?, [coat])?;
    let contact = Contact::plan(body, Grid::new([48, 48], [1e-3; 2])?, Setup::default())?;
    let (punch, motion) = (FlatPunch::new(2.5e-4)?, Motion::load(1.0));
    let peak = |tolerance: f64, algorithm: Algorithm| -> Result<f64> {
        let options = Options {
            tolerance,
            algorithm,
            ..Options::default()
        };
        let solution = contact.solve(&punch, &motion, &options)?;
        Ok(solution.require_converged(tolerance)?.peak_pressure())
    };
    let exact = peak(1e-9, Algorithm::Cascade)?;
    for algorithm in [Algorithm::Cascade, Algorithm::PolonskyKeer] {
        let error = peak(1e-8, algorithm)? / exact - 1.0;
        assert!(error.abs() < 1e-5, "{algorithm:?}: {error:e}");
    }
    Ok(())
}
