//! Properties of every contact: balance, complementarity, scaling, and that a solution does not
//! depend on which quantities are prescribed.

use nacre::influence::{Method, influence_coefficients};
use nacre::{
    Algorithm, Contact, Elastic, Grid, HalfSpace, HeightMap, Layer, Motion, Options, Paraboloid,
    Result, Setup, Solution, Surface,
};
use ndarray::Array2;
use proptest::prelude::*;

use crate::support::checks::{difference, pressure_off, seeded};
use crate::support::claims::claim;
use crate::support::random::uniform;
use crate::support::settings::{self, by, converged, pressed, steel, tolerance};

/// Error of a layer of the material of the substrate: the tables of the remainder of its response, which is
/// zero.
const NO_LAYER: f64 = 1e-10;

/// Difference of pressures, relative to the peak, between two formulations of one contact, both solved to
/// [`TIGHT`].
const SAME_PRESSURE: f64 = 1e-8;

/// Relative difference of motion, load and moments between them.
const SAME_MOTION: f64 = 1e-9;

/// Tolerance of the iterations, far below the differences that are tested.
const TIGHT: f64 = 1e-12;

const RADIUS: f64 = 5e-3;

/// A body of two layers on steel.
fn stack() -> Result<HalfSpace> {
    let layers = [[420e9, 0.22, 10e-6], [70e9, 0.35, 30e-6]];
    settings::stack(steel()?, layers)
}

/// A grid of oblong cells, odd in number along one axis and even along the other, off the origin.
fn grid() -> Result<Grid> {
    Grid::new([45, 64], [4.5e-4, 4.8e-4])?.centered_at([2e-5, -3e-5])
}

fn tight() -> Options {
    tolerance(TIGHT)
}

fn plan(body: &HalfSpace) -> Result<Contact> {
    Contact::plan(body, grid()?, Setup::default())
}

fn paraboloid() -> Result<Paraboloid> {
    Paraboloid::new(RADIUS, 1.5 * RADIUS)
}

fn assert_same(a: &Solution, b: &Solution, what: &str) {
    assert!(a.report.converged() && b.report.converged(), "{what}");
    below!(pressure_off(a, b), SAME_PRESSURE, what);
    near!(a.load(), b.load(), SAME_MOTION);
    near!(a.approach, b.approach, SAME_MOTION);
    let lever = grid().map_or(1.0, |grid| grid.size()[0]);
    for k in 0..2 {
        let tilt = (a.tilt[k] - b.tilt[k]) * lever / b.approach;
        let moment = (a.moment()[k] - b.moment()[k]) / (b.load() * lever);
        below!(tilt.abs(), SAME_MOTION, what, k);
        below!(moment.abs(), SAME_MOTION, what, k);
    }
}

#[test]
fn layer_of_the_substrates_material_is_no_layer() -> Result<()> {
    let steel = steel()?;
    let motion = Motion::load(30.0).with_eccentricity([Some(1e-5), Some(-2e-5)]);
    let bare = plan(&steel.into())?.solve(&paraboloid()?, &motion, &tight())?;
    for thickness in [1e-8, 1e-5, 1e-3] {
        let same = HalfSpace::new(steel, [Layer::new(steel, thickness)?])?;
        let coated = plan(&same)?.solve(&paraboloid()?, &motion, &tight())?;
        below!(pressure_off(&coated, &bare), NO_LAYER, thickness);
        near!(coated.approach, bare.approach, NO_LAYER);
        near!(coated.tilt[0], bare.tilt[0], NO_LAYER);
        near!(coated.tilt[1], bare.tilt[1], NO_LAYER);
    }
    Ok(())
}

#[test]
fn eccentric_paraboloid_is_a_shifted_one() -> Result<()> {
    // x²/2R − s x = (x − sR)²/2R − s²R/2 holds on any body, and on the grid if the shift is a whole number
    // of half cells from a point about which the cells are symmetric.
    let side = [4.5e-4, 4.8e-4];
    let contact = Contact::plan(&stack()?, Grid::new([45, 64], side)?, Setup::default())?;
    let shape = paraboloid()?;
    let radii = [shape.radius_x(), shape.radius_y()];
    for half_cells in [[3.0, 0.0], [-4.0, 5.0]] {
        let e = [0, 1].map(|k| half_cells[k] * 0.5 * contact.grid().spacing()[k]);
        let motion = Motion::load(30.0).with_eccentricity(e.map(Some));
        let eccentric = contact.solve(&shape, &motion, &tight())?;
        let shifted = contact.solve(&shape.shifted(e[0], e[1])?, &Motion::load(30.0), &tight())?;
        assert!(eccentric.report.converged() && shifted.report.converged());
        below!(pressure_off(&eccentric, &shifted), SAME_PRESSURE);
        let mut lift = 0.0;
        for k in 0..2 {
            let largest = side[k] / radii[k];
            let error = (eccentric.tilt[k] - e[k] / radii[k]) / largest;
            below!(error.abs(), SAME_MOTION);
            lift += e[k] * e[k] / (2.0 * radii[k]);
        }
        near!(eccentric.approach, shifted.approach - lift, SAME_MOTION);
    }
    Ok(())
}

#[test]
fn every_mixture_of_freedoms_finds_the_same_contact() -> Result<()> {
    let contact = plan(&stack()?)?;
    let shape = paraboloid()?;
    let eccentricity = [1.5e-5, -2.5e-5];
    let motion = Motion::load(30.0).with_eccentricity(eccentricity.map(Some));
    let known = contact.solve(&shape, &motion, &tight())?;
    let moment = known.moment();
    let (loaded, moved) = (Motion::load(known.load()), Motion::approach(known.approach));
    let mut mixtures = 0;
    for (start, controls) in [(loaded, 3), (moved, 2)] {
        // An eccentricity, the last of the controls, needs a load.
        for (x, y) in (0..controls).flat_map(|x| (0..controls).map(move |y| (x, y))) {
            let mut motion = start;
            for (k, control) in [x, y].into_iter().enumerate() {
                match control {
                    0 => motion.tilt[k] = Some(known.tilt[k]),
                    1 => motion.moment[k] = Some(moment[k]),
                    _ => motion.eccentricity[k] = Some(eccentricity[k]),
                }
            }
            for algorithm in [Algorithm::Cascade, Algorithm::PolonskyKeer] {
                let found = contact.solve(&shape, &motion, &by(algorithm, TIGHT))?;
                assert_same(&found, &known, &format!("{algorithm:?} {motion:?}"));
            }
            mixtures += 1;
        }
    }
    assert_eq!(mixtures, 13);
    Ok(())
}

#[test]
fn locked_tilt_is_zero_and_carries_a_moment() -> Result<()> {
    let contact = plan(&stack()?)?;
    let shape = paraboloid()?.shifted(3e-5, -4e-5)?;
    let solution = contact.solve(&shape, &Motion::load(30.0), &tight())?;
    assert!(solution.tilt.iter().all(|tilt| tilt.abs() <= 0.0), "{:?}", solution.tilt);
    let [ex, ey] = solution.eccentricity();
    // The discrete contact is symmetric only to a fraction of a cell.
    near!(ex, 3e-5, 5e-3);
    near!(ey, -4e-5, 5e-3);
    Ok(())
}

#[test]
fn approach_at_which_nothing_touches_is_an_answer() -> Result<()> {
    let contact = plan(&stack()?)?;
    let shape = paraboloid()?;
    for algorithm in [Algorithm::Cascade, Algorithm::PolonskyKeer] {
        for approach in [-1e-6, 0.0] {
            let (motion, options) = (Motion::approach(approach), by(algorithm, 1e-8));
            let solution = converged(&contact, &shape, &motion, &options)?;
            assert!(solution.pressure.iter().all(|p| p.abs() <= 0.0));
            assert!(solution.load().abs() <= 0.0 && solution.report.residual.abs() <= 0.0);
            assert_eq!(solution.contact_extent(), [[0.0; 2]; 2]);
            let gap = shape.gaps(contact.grid())? - approach;
            assert!(difference(&solution.gap(), &gap) < 1e-15);
        }
    }
    Ok(())
}

/// The first units are m and Pa, others mm and MPa. Without other lengths, E → kE and W → kW leave contact and approach.
#[test]
fn any_consistent_units_give_the_same_contact() -> Result<()> {
    let solve = |length: f64, pressure: f64| -> Result<Solution> {
        let steel = Elastic::new(210e9 * pressure, 0.3)?;
        let body = settings::stack(steel, [[800e9 * pressure, 0.1, 1e-5 * length]])?;
        let grid = grid()?;
        let center = grid.center().map(|x| x * length);
        let grid = Grid::new(grid.shape(), grid.size().map(|l| l * length))?.centered_at(center)?;
        let shape = Paraboloid::new(RADIUS * length, RADIUS * length)?;
        let motion = Motion::load(30.0 * length * length * pressure)
            .with_eccentricity([Some(1e-5 * length), None]);
        converged(&settings::plan(&body, grid)?, &shape, &motion, &tight())
    };
    let si = solve(1.0, 1.0)?;
    for (length, pressure) in [(1e3, 1e-6), (1.0, 3.0)] {
        let other = solve(length, pressure)?;
        below!(difference(&(&other.pressure / pressure), &si.pressure), SAME_PRESSURE);
        near!(other.approach, si.approach * length, SAME_MOTION);
        near!(other.tilt[0], si.tilt[0], SAME_MOTION);
        let moment = si.moment()[0] * length.powi(3) * pressure;
        near!(other.moment()[0], moment, SAME_MOTION);
        assert_eq!(other.in_contact(), si.in_contact());
    }
    Ok(())
}

#[test]
fn solution_does_not_depend_on_the_start_or_the_algorithm() -> Result<()> {
    let contact = plan(&stack()?)?;
    let motion = Motion::load(30.0).with_eccentricity([Some(1e-5), Some(0.0)]);
    let known = contact.solve(&paraboloid()?, &motion, &tight())?;
    let starts = [
        None,
        Some(known.pressure.clone()),
        Some(uniform(contact.grid().shape(), 3) * 1e9),
        Some(Array2::zeros(contact.grid().shape())),
    ];
    for initial in starts {
        for algorithm in [Algorithm::Cascade, Algorithm::PolonskyKeer] {
            let options = tight().with_algorithm(algorithm).with_initial(initial.clone());
            let found = contact.solve(&paraboloid()?, &motion, &options)?;
            assert_same(&found, &known, &format!("{algorithm:?}"));
        }
    }
    Ok(())
}

/// A paraboloid with finite gaps on the grid of these tests only.
#[derive(Debug)]
struct OnOneGrid(Paraboloid, f64);

impl Surface for OnOneGrid {
    fn gap(&self, x: f64, y: f64) -> f64 {
        self.0.gap(x, y)
    }
    fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
        match grid.shape() {
            [45, 64] => self.0.gaps(grid),
            shape => Ok(Array2::from_elem(shape, self.1)),
        }
    }
}

/// Coarser grids only provide the starting point.
#[test]
fn gaps_of_coarser_grids_do_not_change_the_solution() -> Result<()> {
    for motion in [Motion::load(30.0), Motion::approach(2e-7)] {
        let contact = plan(&stack()?)?;
        let known = contact.solve(&paraboloid()?, &motion, &tight())?;
        for coarser in [f64::NAN, f64::NEG_INFINITY, f64::INFINITY, 0.0] {
            let shape = OnOneGrid(paraboloid()?, coarser);
            let found = contact.solve(&shape, &motion, &tight())?;
            assert_same(&found, &known, &format!("{coarser}, {motion:?}"));
        }
    }
    Ok(())
}

/// Solutions do not depend on the number of threads, in a window of some cells and on so many cells that
/// every pass is divided.
#[test]
#[ignore = "slow"]
fn bits_of_a_solution_do_not_depend_on_threads() -> Result<()> {
    let small = (Grid::new([300, 256], [4.5e-4, 4.8e-4])?, 200.0);
    let large = (Grid::new([290, 270], [2e-4, 2e-4])?, 600.0);
    for (grid, load) in [small, large] {
        let solve = |threads: usize| -> Result<Solution> {
            let contact = Contact::plan(&stack()?, grid, settings::threads(threads))?;
            let motion = Motion::load(load).with_eccentricity([Some(1e-6), None]);
            pressed(&contact, &paraboloid()?, &motion)
        };
        let bits = |solution: &Solution| -> Vec<u64> {
            let gap = solution.gap();
            let fields = solution.pressure.iter().chain(&gap);
            let values = fields.chain([&solution.approach, &solution.tilt[0]]);
            values.map(|x| x.to_bits()).collect()
        };
        let one = solve(1)?;
        let touching = one.in_contact().iter().filter(|inside| **inside).count();
        assert_eq!(touching > 1 << 16, load > 500.0, "{touching} cells");
        assert!(touching > 1 << 15, "{touching} cells");
        for threads in [2, 5] {
            assert!(bits(&solve(threads)?) == bits(&one), "{threads} threads");
        }
    }
    Ok(())
}

/// Values left in the memory that a plan keeps do not change later solutions.
#[test]
fn a_solve_that_failed_leaves_no_trace() -> Result<()> {
    let contact = plan(&stack()?)?;
    let solve = |contact: &Contact, load: f64| {
        contact.solve(&paraboloid()?, &Motion::load(load), &Options::default())
    };
    assert!(solve(&contact, 1e307).is_err(), "products overflow");
    let (again, fresh) = (solve(&contact, 30.0)?, solve(&plan(&stack()?)?, 30.0)?);
    assert_eq!(again.pressure, fresh.pressure);
    assert_eq!(again.gap(), fresh.gap());
    Ok(())
}

#[test]
fn displacement_is_the_convolution_of_the_pressure() -> Result<()> {
    // The displacement is compared with the double sum over the coefficients, at a few cells.
    let contact = plan(&stack()?)?;
    let solution = contact.solve(&paraboloid()?, &Motion::load(30.0), &Options::default())?;
    let c = influence_coefficients(&stack()?, contact.grid(), Method::Exact)?;
    for (i, j) in [(0_usize, 0_usize), (22, 31), (44, 10)] {
        let pressed = solution.pressure.indexed_iter();
        let sum: f64 = pressed.map(|((k, l), p)| c[[i.abs_diff(k), j.abs_diff(l)]] * p).sum();
        near!(solution.displacement[[i, j]], sum, 1e-11);
    }
    Ok(())
}

proptest! {
    #![proptest_config(seeded(24))]

    #[test]
    #[ignore = "slow"]
    fn rough_contacts_are_complementary_and_balanced(
        seed in any::<u64>(),
        log_load in 0.0..2.5,
        ex in -0.3..0.3,
        ey in -0.3..0.3,
        free in any::<[bool; 2]>(),
        old in any::<bool>(),
    ) {
        // A rough paraboloid, with heights of the size of the approach.
        let grid = grid()?;
        let rough = HeightMap::new(uniform(grid.shape(), seed) * 3e-7, grid.spacing())?
            .centered_at(grid.center())?;
        let shape = paraboloid()?.plus(rough);
        let load = 10.0_f64.powf(log_load);
        let [lx, ly] = grid.size();
        let e = [grid.center()[0] + ex * lx, grid.center()[1] + ey * ly];
        let eccentricity = [0, 1].map(|k| free[k].then_some(e[k]));
        let motion = Motion::load(load).with_eccentricity(eccentricity);
        let algorithm = if old { Algorithm::PolonskyKeer } else { Algorithm::Cascade };
        let options = by(algorithm, 1e-8);
        let solution = plan(&stack()?)?.solve(&shape, &motion, &options)?;

        let report = &solution.report;
        prop_assert!(report.converged(), "{:?}", report);
        prop_assert!(solution.pressure.iter().all(|p| *p >= 0.0 && p.is_finite()));
        claim("balance", solution.load() / load - 1.0);
        for k in (0..2).filter(|&k| free[k]) {
            let off = (solution.moment()[k] - load * e[k]) / (load * 0.5 * grid.size()[k]);
            claim("balance", off);
        }

        // The numbers of the report follow from the fields.
        let gap = shape.gaps(&grid)? + &solution.displacement;
        let gaps = solution.gap();
        let (x, y) = (grid.x(), grid.y());
        let (mut mismatch, mut work, mut overlap, mut deepest) = (0.0, 0.0, 0.0_f64, 0.0_f64);
        for ((i, j), p) in solution.pressure.indexed_iter() {
            let rigid = solution.approach + solution.tilt[0] * x[i] + solution.tilt[1] * y[j];
            let (g, u) = (gap[[i, j]] - rigid, solution.displacement[[i, j]]);
            prop_assert!((g - gaps[[i, j]]).abs() < 1e-12 * u.abs().max(g.abs()));
            mismatch += p * g.abs();
            work += p * u;
            overlap = overlap.max(-g);
            deepest = deepest.max(u);
        }
        prop_assert!(mismatch <= 1.01 * options.tolerance * work);
        prop_assert!(overlap <= 1.01 * options.tolerance * deepest);
        prop_assert!(report.residual <= options.tolerance && report.overlap <= options.tolerance);
    }
}
