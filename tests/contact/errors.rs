//! Problems that cannot be solved end in errors that say why: contradictory controls, loads that no
//! pressure can balance, invalid plans and options.

use nacre::influence::{Method, influence_coefficients};
use nacre::{
    Contact, Cylinder, Elastic, Error, FlatPunch, Grid, HalfSpace, HeightMap, Motion, Options,
    Paraboloid, Result, Setup, Solution, Surface, solve,
};
use ndarray::Array2;

use crate::support::messages::{check, message};

const NAN: f64 = f64::NAN;
const INFINITY: f64 = f64::INFINITY;

fn steel() -> Result<Elastic> {
    Elastic::new(210e9, 0.3)
}

/// A contact on 16 x 12 cells of 1 mm.
fn contact() -> Result<Contact> {
    let grid = Grid::new([16, 12], [16e-3, 12e-3])?;
    Contact::plan(steel()?, grid, Setup::default())
}

fn solved(shape: &dyn Surface, motion: &Motion) -> Result<()> {
    contact()?
        .solve(shape, motion, &Options::default())
        .map(drop)
}

#[test]
fn controls() -> Result<()> {
    let shape = Paraboloid::new(1.0, 1.0)?;
    let load = Motion::load(10.0);
    let approach = Motion::approach(1e-6);
    let cases = [
        (
            Motion::default(),
            "exactly one of load and approach must be given",
        ),
        (
            Motion {
                approach: Some(1e-6),
                ..load
            },
            "exactly one of load and approach must be given",
        ),
        (Motion::load(0.0), "load must be finite and above 0, got 0"),
        (
            Motion::load(-5.0),
            "load must be finite and above 0, got -5",
        ),
        (
            Motion::load(NAN),
            "load must be finite and above 0, got NaN",
        ),
        (Motion::approach(NAN), "approach must be finite, got NaN"),
        (
            Motion {
                tilt: [Some(NAN), None],
                ..load
            },
            "tilt must be finite, got NaN",
        ),
        (
            Motion {
                moment: [None, Some(INFINITY)],
                ..load
            },
            "moment must be finite, got inf",
        ),
        (
            Motion {
                eccentricity: [Some(NAN), None],
                ..load
            },
            "eccentricity must be finite, got NaN",
        ),
        (
            Motion {
                eccentricity: [Some(0.0), None],
                ..approach
            },
            "eccentricity needs load: under a given approach, give moment",
        ),
        (
            Motion {
                eccentricity: [Some(0.0), None],
                tilt: [Some(0.0), None],
                ..load
            },
            "along x at most one of eccentricity, moment and tilt can be a number",
        ),
        (
            Motion {
                moment: [None, Some(0.0)],
                tilt: [None, Some(0.0)],
                ..load
            },
            "along y at most one of eccentricity, moment and tilt can be a number",
        ),
        (
            Motion {
                eccentricity: [Some(0.0); 2],
                moment: [None, Some(0.0)],
                ..load
            },
            "along y at most one of eccentricity, moment and tilt can be a number",
        ),
    ];
    check(cases.map(|(motion, text)| (solved(&shape, &motion), text)));
    Ok(())
}

#[test]
fn products_that_overflow() -> Result<()> {
    let shape = Paraboloid::new(1.0, 1.0)?;
    let overflows = "load, lengths, moduli and friction must be in units in which their products neither overflow nor vanish";
    let apart = Motion {
        eccentricity: [Some(1e-3), None],
        ..Motion::load(1e307)
    };
    // Pressures are about 1e13 times the approach and overflow for the larger one; for the smaller one,
    // products of pressures with displacements underflow.
    check([
        (solved(&shape, &Motion::approach(1e300)), overflows),
        (solved(&shape, &Motion::approach(1e160)), overflows),
        (solved(&shape, &Motion::load(1e307)), overflows),
        (solved(&shape, &Motion::load(1e200)), overflows),
        (solved(&shape, &apart), overflows),
    ]);
    Ok(())
}

#[test]
fn load_point_outside_the_cells_that_can_touch() -> Result<()> {
    // A punch of 4 mm radius on cells of 1 mm has cell centres up to 3.5 mm.
    let punch = FlatPunch::new(4e-3)?;
    for x in [3.5e-3, -5e-3] {
        let motion = Motion {
            eccentricity: [Some(x), None],
            ..Motion::load(10.0)
        };
        let text = message(solved(&punch, &motion));
        let begins = format!(
            "the load point ({x:.6e}, 0.000000e0) must lie strictly inside the convex hull of the \
             cells that can touch, x [-0.0035"
        );
        assert!(text.starts_with(&begins), "{text}");
    }
    // The point is inside the rectangle around the cells, and outside their convex hull.
    let corner = [Some(3e-3), Some(3e-3)];
    let motion = Motion {
        eccentricity: corner,
        ..Motion::load(10.0)
    };
    assert!(matches!(
        solved(&punch, &motion),
        Err(Error::LoadPoint { .. })
    ));
    let motion = Motion {
        eccentricity: [Some(2e-3), Some(2e-3)],
        ..Motion::load(10.0)
    };
    assert_eq!(message(solved(&punch, &motion)), "no error");

    let beside = Motion {
        moment: [Some(1.0), None],
        ..Motion::approach(1e-6)
    };
    check([(
        solved(&punch.shifted(-4e-3, 0.0)?, &beside),
        "no pressure p >= 0 on the cells that can touch has this moment: moment (1.000000e0, 0.000000e0), \
         cells in x [-0.0075, -0.0005], y [-0.0035000000000000005, 0.0035000000000000005]; a moment has the \
         direction of the point where the force acts",
    )]);
    check([(
        solved(&punch.shifted(1.0, 0.0)?, &Motion::load(1.0)),
        "no cell of the grid can touch: the gap is infinite",
    )]);
    Ok(())
}

#[test]
fn plans_and_options() -> Result<()> {
    let body: HalfSpace = steel()?.into();
    let grid = Grid::new([16, 12], [1.0, 1.0])?;
    let plan = |setup: Setup| Contact::plan(&body, grid, setup);
    check([
        (
            plan(Setup {
                threads: Some(0),
                ..Setup::default()
            }),
            "threads must be at least 1, got 0",
        ),
        (
            plan(Setup {
                method: Method::Image { refinement: 0 },
                ..Setup::default()
            }),
            "refinement must be at least 1, got 0",
        ),
        (
            Contact::plan(
                &body,
                Grid::line(64, 1.0)?,
                Setup {
                    method: Method::Image { refinement: 4 },
                    ..Setup::default()
                },
            ),
            "method must be \"exact\" on the grid of a line contact",
        ),
    ]);
    let refined = Method::Plain {
        refinement: usize::MAX / 8,
    };
    let text = message(influence_coefficients(&body, &grid, refined));
    assert!(
        text.starts_with("refinement must be small enough"),
        "{text}"
    );

    let shape = Paraboloid::new(1.0, 1.0)?;
    let with = |options: Options| contact()?.solve(&shape, &Motion::load(1.0), &options);
    let start = |initial| {
        with(Options {
            initial: Some(initial),
            ..Options::default()
        })
    };
    let mut broken = Array2::zeros([16, 12]);
    broken[[7, 8]] = NAN;
    let tolerance = |tolerance| {
        with(Options {
            tolerance,
            ..Options::default()
        })
    };
    check([
        (
            tolerance(0.0),
            "tolerance must be above 0 and below 1, got 0",
        ),
        (
            tolerance(1.0),
            "tolerance must be above 0 and below 1, got 1",
        ),
        (
            tolerance(NAN),
            "tolerance must be above 0 and below 1, got NaN",
        ),
        (
            start(Array2::zeros([12, 16])),
            "initial: expected shape [16, 12], got [12, 16]",
        ),
        (start(broken), "initial is not finite at [7, 8]"),
    ]);
    Ok(())
}

#[test]
fn cells_too_coarse_for_a_height_map() -> Result<()> {
    // The cells have sides of 1 mm, and the samples are 0.1 mm apart.
    let fine = HeightMap::new(Array2::zeros([160, 120]), [1e-4, 1e-4])?;
    check([(
        solved(&fine, &Motion::load(1.0)),
        "grid spacing must be at most twice the spacing of the height map, got 0.001",
    )]);
    Ok(())
}

#[test]
fn a_shape_of_the_wrong_size_or_without_a_gap() -> Result<()> {
    #[derive(Debug)]
    struct Broken(f64, usize);
    impl Surface for Broken {
        fn gap(&self, _: f64, _: f64) -> f64 {
            self.0
        }
        fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
            Ok(Array2::from_elem([self.1, grid.shape()[1]], self.0))
        }
    }
    check([
        (
            solved(&Broken(NAN, 16), &Motion::load(1.0)),
            "shape is not finite at [0, 0]",
        ),
        (
            solved(&Broken(-INFINITY, 16), &Motion::load(1.0)),
            "shape is not finite at [0, 0]",
        ),
        (
            solved(&Broken(0.0, 15), &Motion::load(1.0)),
            "shape: expected shape [16, 12], got [15, 12]",
        ),
    ]);
    Ok(())
}

/// The error occurs even where the coarser grids, which are solved at the same time, can be solved.
#[test]
fn a_shape_without_a_gap_on_the_finest_grid() -> Result<()> {
    #[derive(Debug)]
    struct Pierced(Paraboloid);
    impl Surface for Pierced {
        fn gap(&self, x: f64, y: f64) -> f64 {
            self.0.gap(x, y)
        }
        fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
            let mut gaps = self.0.gaps(grid)?;
            if grid.shape() == [256, 192] {
                gaps[[17, 5]] = NAN;
            }
            Ok(gaps)
        }
    }
    let shape = Pierced(Paraboloid::new(1.0, 1.0)?);
    let grid = Grid::new([256, 192], [16e-3, 12e-3])?;
    for threads in [1, 2] {
        let setup = Setup {
            threads: Some(threads),
            ..Setup::default()
        };
        let contact = Contact::plan(steel()?, grid, setup)?;
        check([(
            contact.solve(&shape, &Motion::load(1e3), &Options::default()),
            "shape is not finite at [17, 5]",
        )]);
    }
    Ok(())
}

#[test]
fn grids_that_are_not_to_be_found() -> Result<()> {
    let body: HalfSpace = steel()?.into();
    check([(
        solve(&Cylinder::new(1.0)?, &body, &Motion::load(1.0)),
        "grid must be given for a shape without end: its contact is as long as the grid",
    )]);
    // The contact of a plane covers any grid.
    #[derive(Debug)]
    struct Plane;
    impl Surface for Plane {
        fn gap(&self, _: f64, _: f64) -> f64 {
            0.0
        }
    }
    let text = message(solve(&Plane, &body, &Motion::load(1.0)));
    assert!(
        text.starts_with("no grid found: after 10 enlargements, to ["),
        "{text}"
    );
    assert!(
        text.ends_with("the contact still touches the edge; give a grid"),
        "{text}"
    );
    Ok(())
}

#[test]
fn an_iteration_that_did_not_converge_says_how_far_it_came() -> Result<()> {
    let options = Options {
        max_iterations: Some(1),
        tolerance: 1e-10,
        ..Options::default()
    };
    let shape = Paraboloid::new(1.0, 1.0)?;
    let solution = contact()?.solve(&shape, &Motion::load(1e4), &options)?;
    assert!(!solution.report.converged());
    let text = message(solution.require_converged(1e-10));
    let begins = "not converged after 1 iterations: residual ";
    assert!(text.starts_with(begins), "{text}");
    let ends = "above the tolerance 1e-10; raise max_iterations or the tolerance";
    assert!(text.ends_with(ends), "{text}");
    Ok(())
}

#[test]
fn fields_that_were_kept() -> Result<()> {
    let (contact, shape) = (contact()?, Paraboloid::new(1.0, 1.0)?);
    let solution = contact.solve(&shape, &Motion::load(10.0), &Options::default())?;
    let again = |gap: Array2<f64>| {
        let fields = [
            solution.pressure.clone(),
            gap,
            solution.displacement.clone(),
        ];
        let (approach, tilt) = (solution.approach, solution.tilt);
        Solution::from_fields(fields, approach, tilt, solution.report.clone())
    };
    assert_eq!(again(solution.gap())?, solution);
    assert_ne!(again(solution.gap() + 1e-9)?, solution);
    assert_eq!(
        message(again(Array2::zeros((12, 16)))),
        "gap: expected shape [16, 12], got [12, 16]"
    );
    // A gap may be +inf, where the shape cannot touch.
    assert!(again(solution.gap() + f64::INFINITY).is_ok());
    assert_eq!(
        message(again(solution.gap() * f64::NAN)),
        "gap must be a number or +inf, got NaN"
    );
    let pressed = |pressure: f64| {
        let mut fields = [
            solution.pressure.clone(),
            solution.gap(),
            solution.displacement.clone(),
        ];
        fields[0][[3, 2]] = pressure;
        Solution::from_fields(fields, 0.0, [0.0; 2], solution.report.clone())
    };
    assert_eq!(
        message(pressed(f64::INFINITY)),
        "pressure is not finite at [3, 2]"
    );
    assert_eq!(
        message(pressed(-1.0)),
        "pressure must be at least 0, got -1"
    );
    Ok(())
}
