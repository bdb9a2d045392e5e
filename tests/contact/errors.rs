//! Problems that cannot be solved end in errors that say why: contradictory controls, loads that no
//! pressure can balance, invalid plans and options.

use nacre::influence::{Method, influence_coefficients};
use nacre::{
    Contact, Cylinder, Error, FlatPunch, Grid, HalfSpace, HeightMap, Motion, Options, Paraboloid,
    Result, Setup, Solution, Surface, solve,
};
use ndarray::Array2;

use crate::messages::message;
use crate::support::settings::{plan, steel, threads, tolerance};

const NAN: f64 = f64::NAN;
const INFINITY: f64 = f64::INFINITY;

/// A contact on 16 x 12 cells of 1 mm.
fn contact() -> Result<Contact> {
    plan(steel()?, Grid::new([16, 12], [16e-3, 12e-3])?)
}

fn solved(shape: &dyn Surface, motion: &Motion) -> Result<Solution> {
    contact()?.solve(shape, motion, &Options::default())
}

#[test]
fn controls() -> Result<()> {
    let ball = Paraboloid::new(1.0, 1.0)?;
    let (load, approach) = (Motion::load(10.0), Motion::approach(1e-6));
    let moved = |motion: Motion| solved(&ball, &motion);
    let (both, zero) = (load.with_approach(1e-6), Some(0.0));
    refused! {
        moved(Motion::default()) => "exactly one of load and approach must be given";
        moved(both) => "exactly one of load and approach must be given";
        moved(Motion::load(0.0)) => "load must be finite and above 0, got 0";
        moved(Motion::load(-5.0)) => "load must be finite and above 0, got -5";
        moved(Motion::load(NAN)) => "load must be finite and above 0, got NaN";
        moved(Motion::approach(NAN)) => "approach must be finite, got NaN";
        moved(load.with_tilt([Some(NAN), None])) => "tilt must be finite, got NaN";
        moved(load.with_moment([None, Some(INFINITY)])) => "moment must be finite, got inf";
        moved(load.with_eccentricity([Some(NAN), None])) => "eccentricity must be finite, got NaN";
        moved(approach.with_eccentricity([zero, None]))
            => "eccentricity needs load: under a given approach, give moment";
        moved(load.with_eccentricity([zero, None]).with_tilt([zero, None]))
            => "along x at most one of eccentricity, moment and tilt can be a number";
        moved(load.with_moment([None, zero]).with_tilt([None, zero]))
            => "along y at most one of eccentricity, moment and tilt can be a number";
        moved(load.with_eccentricity([zero; 2]).with_moment([None, zero]))
            => "along y at most one of eccentricity, moment and tilt can be a number";
    }
    Ok(())
}

#[test]
fn products_that_overflow() -> Result<()> {
    let shape = Paraboloid::new(1.0, 1.0)?;
    let overflows = "load, lengths, moduli and friction must be in units in which their products neither overflow nor vanish";
    let apart = Motion::load(1e307).with_eccentricity([Some(1e-3), None]);
    // Pressures are about 1e13 times the approach and overflow for the larger one; for the smaller one,
    // products of pressures with displacements underflow.
    refused! {
        solved(&shape, &Motion::approach(1e300)) => overflows;
        solved(&shape, &Motion::approach(1e160)) => overflows;
        solved(&shape, &Motion::load(1e307)) => overflows;
        solved(&shape, &Motion::load(1e200)) => overflows;
        solved(&shape, &apart) => overflows;
    }
    Ok(())
}

#[test]
fn load_point_outside_the_cells_that_can_touch() -> Result<()> {
    // A punch of 4 mm radius on cells of 1 mm has cell centres up to 3.5 mm.
    let punch = FlatPunch::new(4e-3)?;
    for x in [3.5e-3, -5e-3] {
        let motion = Motion::load(10.0).with_eccentricity([Some(x), None]);
        let text = message(solved(&punch, &motion));
        let begins = format!(
            "the load point ({x:.6e}, 0.000000e0) must lie strictly inside the convex hull of the \
             cells that can touch, x [-0.0035"
        );
        assert!(text.starts_with(&begins), "{text}");
    }
    // The first point is inside the rectangle around the cells, and outside their convex hull.
    let at = |x: f64| solved(&punch, &Motion::load(10.0).with_eccentricity([Some(x); 2]));
    assert!(matches!(at(3e-3), Err(Error::LoadPoint { .. })));
    assert!(at(2e-3).is_ok());

    let beside = Motion::approach(1e-6).with_moment([Some(1.0), None]);
    refused! {
        solved(&punch.shifted(-4e-3, 0.0)?, &beside)
            => "no pressure p >= 0 on the cells that can touch has this moment: moment (1.000000e0, 0.000000e0), \
                cells in x [-0.0075, -0.0005], y [-0.0035000000000000005, 0.0035000000000000005]; a moment has the \
                direction of the point where the force acts";
        solved(&punch.shifted(1.0, 0.0)?, &Motion::load(1.0)) => "no cell of the grid can touch: the gap is infinite";
    }
    Ok(())
}

#[test]
fn plans_and_options() -> Result<()> {
    let body: HalfSpace = steel()?.into();
    let grid = Grid::new([16, 12], [1.0, 1.0])?;
    let plan = |setup: Setup| Contact::plan(&body, grid, setup);
    refused! {
        plan(threads(0)) => "threads must be at least 1, got 0";
        influence_coefficients(&body, &grid, Method::Image { refinement: 0 })
            => "refinement must be at least 1, got 0";
        influence_coefficients(&body, &Grid::line(64, 1.0)?, Method::Image { refinement: 4 })
            => "method must be \"exact\" on the grid of a line contact";
    }
    let given = |coefficients: Array2<f64>, grid: Grid| {
        let coefficients = Some(coefficients.into_shared());
        Contact::plan(&body, grid, Setup::default().with_coefficients(coefficients))
    };
    let exact = influence_coefficients(&body, &grid, Method::Exact)?;
    let mut infinite = exact.clone();
    infinite[[3, 4]] = INFINITY;
    refused! {
        given(Array2::ones([12, 16]), grid) => "coefficients: expected shape [16, 12], got [12, 16]";
        given(infinite, grid) => "coefficients is not finite at [3, 4]";
        given(exact, grid.periodic([true, false])?)
            => "coefficients must be the same at the offsets d and n - d along a direction in which a grid of n cells repeats";
    }
    let refined = Method::Plain { refinement: usize::MAX / 8 };
    let text = message(influence_coefficients(&body, &grid, refined));
    let begins = "refinement must be small enough";
    assert!(text.starts_with(begins), "{text}");

    let shape = Paraboloid::new(1.0, 1.0)?;
    let with = |options: Options| contact()?.solve(&shape, &Motion::load(1.0), &options);
    let start = |initial| with(Options::default().with_initial(initial));
    let mut broken = Array2::zeros([16, 12]);
    broken[[7, 8]] = NAN;
    let to = |asked| with(tolerance(asked));
    refused! {
        to(0.0) => "tolerance must be above 0 and below 1, got 0";
        to(1.0) => "tolerance must be above 0 and below 1, got 1";
        to(NAN) => "tolerance must be above 0 and below 1, got NaN";
        start(Array2::zeros([12, 16])) => "initial: expected shape [16, 12], got [12, 16]";
        start(broken) => "initial is not finite at [7, 8]";
    }
    Ok(())
}

#[test]
fn shapes_that_do_not_fit_the_grid_or_have_no_gap() -> Result<()> {
    // The cells have sides of 1 mm, and the samples are 0.1 mm apart.
    let fine = HeightMap::new(Array2::zeros([160, 120]), [1e-4, 1e-4])?;
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
    refused! {
        solved(&fine, &Motion::load(1.0))
            => "grid spacing must be at most twice the spacing of the height map, got 0.001";
        solved(&Broken(NAN, 16), &Motion::load(1.0)) => "shape is not finite at [0, 0]";
        solved(&Broken(-INFINITY, 16), &Motion::load(1.0)) => "shape is not finite at [0, 0]";
        solved(&Broken(0.0, 15), &Motion::load(1.0)) => "shape: expected shape [16, 12], got [15, 12]";
    }
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
    for count in [1, 2] {
        let contact = Contact::plan(steel()?, grid, threads(count))?;
        refused! {
            contact.solve(&shape, &Motion::load(1e3), &Options::default()) => "shape is not finite at [17, 5]";
        }
    }
    Ok(())
}

#[test]
fn grids_that_are_not_to_be_found() -> Result<()> {
    let body: HalfSpace = steel()?.into();
    refused! {
        solve(&Cylinder::new(1.0)?, &body, &Motion::load(1.0))
            => "grid must be given for a shape without end: its contact is as long as the grid";
    }
    // The contact of a plane covers any grid.
    #[derive(Debug)]
    struct Plane;
    impl Surface for Plane {
        fn gap(&self, _: f64, _: f64) -> f64 {
            0.0
        }
    }
    let text = message(solve(&Plane, &body, &Motion::load(1.0)));
    let begins = "no grid found: after 10 enlargements, to [";
    assert!(text.starts_with(begins), "{text}");
    let ends = "the contact still touches the edge; give a grid";
    assert!(text.ends_with(ends), "{text}");
    Ok(())
}

#[test]
fn an_iteration_that_did_not_converge_says_how_far_it_came() -> Result<()> {
    let options = Options::default().with_max_iterations(1).with_tolerance(1e-10);
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
    let fields = [&solution.pressure, &solution.gap(), &solution.displacement].map(Clone::clone);
    let kept = |changed: usize, field: Array2<f64>| {
        let (mut fields, report) = (fields.clone(), solution.report.clone());
        fields[changed] = field;
        Solution::from_fields(fields, solution.approach, solution.tilt, report)
    };
    assert_eq!(kept(1, solution.gap())?, solution);
    assert_ne!(kept(1, solution.gap() + 1e-9)?, solution);
    // A gap may be +inf, where the shape cannot touch.
    assert!(kept(1, solution.gap() + INFINITY).is_ok());
    let pressed = |pressure: f64| {
        let mut field = solution.pressure.clone();
        field[[3, 2]] = pressure;
        kept(0, field)
    };
    refused! {
        kept(1, Array2::zeros((12, 16))) => "gap: expected shape [16, 12], got [12, 16]";
        kept(1, solution.gap() * NAN) => "gap must be a number or +inf, got NaN";
        pressed(INFINITY) => "pressure is not finite at [3, 2]";
        pressed(-1.0) => "pressure must be at least 0, got -1";
    }
    Ok(())
}
