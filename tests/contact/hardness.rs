//! A limit of the pressure: complementarity of both bounds, histories, and a dent of its own computation.

use std::f64::consts::PI;

use nacre::{
    Algorithm, Contact, Elastic, Error, FlatPunch, Grid, HalfSpace, Hardness, HeightMap, Layer,
    Motion, Options, Paraboloid, Result, Setup, Solution, Substrate, Surface, solve,
};
use ndarray::{Array2, Zip};

use crate::support::checks::{apart, largest};
use crate::support::claims::claim;
use crate::support::contacts::{Random, RandomContact};
use crate::support::random::uniform;
use crate::support::rings::Rings;
use crate::support::settings::{against, plan};

/// Largest residual, overlap and gap of a converged solution, relative to displacements.
const TOLERANCE: f64 = 1e-8;

/// Options with a hardness of all cells.
fn limited(hardness: f64) -> Options {
    Options::default().with_hardness(Hardness::Uniform(hardness))
}

/// Options of the step after `before`.
fn next(before: &Solution, hardness: f64) -> Options {
    limited(hardness)
        .with_initial(before.pressure.clone())
        .with_indentation(before.indentation.clone())
}

/// A body of modulus 1 on a square of so many cells.
fn soft(cells: usize, side: f64) -> Result<Contact> {
    plan(Elastic::new(1.0, 0.3)?, Grid::new([cells; 2], [side; 2])?)
}

fn sphere() -> Result<Paraboloid> {
    Paraboloid::new(1e3, 1e3)
}

/// Both bounds of a first loading, from pressure and motion alone: h + u − δ is 0 where the pressure is between them,
/// not below 0 at p = 0 and not above 0 at p = H, where it is minus the indentation. Gaps are compared with the largest
/// displacement.
fn check_bounds(
    name: &str,
    contact: &Contact,
    shape: &dyn Surface,
    solution: &Solution,
    hardness: &dyn Fn(usize) -> f64,
) -> Result<()> {
    assert!(solution.report.converged(), "{name}: {:?}", solution.report);
    let grid = contact.grid();
    let gaps = shape.gaps(grid)?;
    let u = contact.convolution().apply(&solution.pressure)?;
    let (x, y) = (grid.x(), grid.y());
    let most = largest(&u);
    // Displacement and approach may both have another datum.
    let raised = (&solution.displacement - &u).sum() / u.len() as f64;
    let none = Array2::zeros(u.dim());
    let indentation = solution.indentation.as_ref().unwrap_or(&none);
    let mut sums = [0.0; 2];
    for (k, ((i, j), &p)) in solution.pressure.indexed_iter().enumerate() {
        if gaps[[i, j]].is_infinite() {
            assert!(p.abs() <= 0.0 && indentation[[i, j]].abs() <= 0.0);
            continue;
        }
        let motion = solution.approach + solution.tilt[0] * x[i] + solution.tilt[1] * y[j];
        let g = gaps[[i, j]] + u[[i, j]] + raised - motion;
        let w = indentation[[i, j]];
        assert!((0.0..=hardness(k)).contains(&p), "{name}: {p:e}");
        assert!(g + w > -TOLERANCE * most, "{name}: {:e}", g + w);
        if p < hardness(k) {
            assert!(w <= 0.0, "{name}: {w:e} at a pressure below the hardness");
        }
        sums[0] += p * (g + w).abs();
        sums[1] += p * most;
    }
    assert!(sums[0] <= TOLERANCE * sums[1], "{name}: {sums:?}");
    Ok(())
}

/// An infinite hardness, and one above the peak, change no bit of the elastic solution.
#[test]
fn surfaces_that_do_not_yield_are_elastic_to_the_bit() -> Result<()> {
    let steel = Elastic::new(1.0, 0.3)?;
    let body = HalfSpace::new(steel, [Layer::new(Elastic::new(4.0, 0.2)?, 0.3)?])?;
    let contact = plan(&body, Grid::new([96, 80], [4.0, 4.0])?)?;
    let motion = Motion::load(1e-3).with_eccentricity([Some(0.1), None]);
    let elastic = contact.solve(&sphere()?, &motion, &Options::default())?;
    for hardness in [f64::INFINITY, 1.0001 * elastic.peak_pressure()] {
        let found = contact.solve(&sphere()?, &motion, &limited(hardness))?;
        assert_eq!(found.pressure, elastic.pressure);
        assert_eq!(found.gap(), elastic.gap());
        assert_eq!(found.indentation, None);
        assert_eq!(found.report.discretisation, elastic.report.discretisation);
    }
    Ok(())
}

/// Both bounds hold on open, line and periodic grids, for layers, a rigid base and two bodies, under load, eccentric
/// load and approach, with each algorithm.
#[test]
#[ignore = "slow"]
fn both_bounds_hold_for_every_domain_body_and_control() -> Result<()> {
    let soft = Elastic::new(1.0, 0.3)?;
    let coat = Layer::new(Elastic::new(5.0, 0.2)?, 0.2)?;
    let bodies: [HalfSpace; 3] = [
        soft.into(),
        HalfSpace::new(soft, [coat.clone()])?,
        HalfSpace::new(Substrate::Rigid, [Layer::new(soft, 0.5)?])?,
    ];
    let grid = Grid::new([64, 60], [4.0, 4.0])?;
    let grids =
        [grid, Grid::line(200, 4.0)?, grid.periodic([true; 2])?, grid.periodic([true, false])?];
    for (number, body) in bodies.iter().enumerate() {
        for grid in grids {
            let setup = if number == 1 { against(soft) } else { Setup::default() };
            let contact = Contact::plan(body, grid, setup)?;
            let [px, py] = grid.is_periodic();
            let wave = |x: f64, y: f64| {
                0.002 * ((2.0 - (0.5 * PI * x).cos()) - (0.5 * PI * y).cos())
                    + if py { 0.0 } else { 0.001 * y * y }
            };
            let sphere = sphere()?;
            let map;
            let shape: &dyn Surface = if px || py {
                let (x, y) = (grid.x(), grid.y());
                let heights = Array2::from_shape_fn(grid.shape(), |(i, j)| -wave(x[i], y[j]));
                map = HeightMap::new(heights, grid.spacing())?.periodic([px, py])?;
                &map
            } else {
                &sphere
            };
            let load = if grid.is_line() { 6e-4 } else { 2e-3 };
            let mut motions = vec![Motion::load(load)];
            if !py {
                let eccentricity = [None, Some(0.05)];
                motions.push(Motion::load(load).with_eccentricity(eccentricity));
            }
            let elastic = contact.solve(shape, &motions[0], &Options::default())?;
            motions.push(Motion::approach(elastic.approach));
            for motion in motions {
                for algorithm in [Algorithm::Cascade, Algorithm::PolonskyKeer] {
                    let name = format!("body {number}, {grid:?}, {motion:?}, {algorithm:?}");
                    let elastic = contact.solve(shape, &motion, &Options::default())?;
                    let hardness = 0.6 * elastic.peak_pressure();
                    let options = limited(hardness).with_algorithm(algorithm);
                    let found = contact.solve(shape, &motion, &options);
                    let found = found.unwrap_or_else(|error| panic!("{name}: {error}"));
                    check_bounds(&name, &contact, shape, &found, &|_| hardness)?;
                    assert!(found.indentation.is_some(), "{name}");
                    assert!(found.report.balance.force < 1e-12, "{name}");
                }
            }
        }
    }
    Ok(())
}

/// Random contacts of all shapes and bodies with random hardnesses, of which half differ from cell to cell.
#[test]
#[ignore = "slow"]
fn random_contacts_keep_both_bounds() -> Result<()> {
    for number in 0..60 {
        let case = RandomContact::new(7000 + number)?;
        let contact = plan(&case.body, case.grid)?;
        let shape = case.shape_on(&case.grid)?;
        let elastic = contact.solve(&*shape, &case.motion, &Options::default())?;
        // Contacts at the limit of what can be solved are other tests' business.
        if !elastic.report.converged() || elastic.peak_pressure() <= 0.0 {
            continue;
        }
        let random = &mut Random::new(number);
        let least = random.between(0.3, 1.0) * elastic.peak_pressure();
        let spread = if random.choice(2) == 0 { 0.0 } else { 1.0 };
        let cells = uniform(case.grid.shape(), number).mapv(|r| least * (1.0 + spread * r));
        let options = Options::default().with_hardness(Hardness::Cells(cells.clone()));
        let found = contact.solve(&*shape, &case.motion, &options);
        if matches!(found, Err(Error::Overload { .. })) {
            continue;
        }
        let flat: Vec<f64> = cells.iter().copied().collect();
        check_bounds(&case.name, &contact, &*shape, &found?, &|k| flat[k])?;
    }
    Ok(())
}

/// Where all of the contact yields, W = H·A to rounding: below a flat punch and on a rough periodic surface, both
/// pressed far in.
#[test]
fn full_plasticity_bears_hardness_times_area() -> Result<()> {
    let body = Elastic::new(1.0, 0.3)?;
    let hardness = 1e-4;
    let open = Grid::new([48, 48], [4.0, 4.0])?;
    let periodic = open.periodic([true; 2])?;
    let heights = uniform(open.shape(), 3).mapv(|h| 1e-3 * h);
    let rough = HeightMap::new(heights, open.spacing())?.periodic([true; 2])?;
    let punch = FlatPunch::new(1.0)?;
    let cases: [(Grid, &dyn Surface); 2] = [(open, &punch), (periodic, &rough)];
    for (grid, shape) in cases {
        let contact = plan(body, grid)?;
        let found = contact.solve(shape, &Motion::approach(0.1), &limited(hardness))?;
        assert!(found.report.converged());
        let ratio = found.load() / (hardness * found.contact_area());
        assert!((ratio - 1.0).abs() < 1e-12, "{ratio}");
        // All that can touch does.
        let touching = shape.gaps(&grid)?.iter().filter(|h| h.is_finite()).count();
        let area = touching as f64 * grid.cell_area();
        assert!((found.contact_area() / area - 1.0).abs() < 1e-12);
    }
    Ok(())
}

/// A load of exactly so many cells at the hardness leaves nothing for the others, and is balanced to rounding.
#[test]
fn a_load_of_whole_cells_is_borne() -> Result<()> {
    let contact = soft(32, 4.0)?;
    let heights = uniform([32, 32], 5).mapv(|h| 1e-3 * h);
    let rough = HeightMap::new(heights, contact.grid().spacing())?;
    // So soft that the cells touch one after the other.
    let (hardness, cells) = (1e-7, 50.0);
    let load = cells * hardness * contact.grid().cell_area();
    let found = contact.solve(&rough, &Motion::load(load), &limited(hardness))?;
    check_bounds("50 cells", &contact, &rough, &found, &|_| hardness)?;
    assert!((found.load() / load - 1.0).abs() < 1e-12);
    assert!((found.contact_area() / (cells * contact.grid().cell_area()) - 1.0).abs() < 0.05);
    Ok(())
}

/// Unloading and reloading is elastic: the state under a load does not depend on the steps that lead to it, below the
/// largest load so far; and the dent does not change.
#[test]
fn the_order_of_unloading_does_not_matter() -> Result<()> {
    let contact = soft(96, 4.0)?;
    let shape = sphere()?;
    let hardness = 3e-4;
    let options = |options: Options| options.with_tolerance(1e-10);
    let loaded = contact.solve(&shape, &Motion::load(1e-3), &options(limited(hardness)))?;
    let dent = loaded.indentation.clone().expect("it yields");
    let mut ends = Vec::new();
    for path in [vec![0.3], vec![0.8, 0.1, 0.5, 0.3], vec![0.05, 1.0, 0.3]] {
        let mut last = loaded.clone();
        for part in path {
            let motion = Motion::load(part * 1e-3);
            last = contact.solve(&shape, &motion, &options(next(&last, hardness)))?;
            assert!(last.report.converged());
        }
        ends.push(last);
    }
    let deepest = largest(&dent);
    for end in &ends {
        let kept = end.indentation.as_ref().expect("a dent stays");
        let change = apart(kept, &dent);
        assert!(change < 1e-8 * deepest, "{:e}", change / deepest);
        below!(apart(&end.pressure, &ends[0].pressure), 1e-8 * end.peak_pressure());
        assert!((end.approach / ends[0].approach - 1.0).abs() < 1e-8);
    }
    // Loading further deepens it.
    let more = contact.solve(&shape, &Motion::load(2e-3), &next(&ends[0], hardness))?;
    let deeper = more.indentation.clone().expect("it yields");
    assert!(Zip::from(&deeper).and(&dent).all(|more, less| more >= less));
    // Without any history, up to what the tolerance leaves.
    let direct = contact.solve(&shape, &Motion::load(2e-3), &limited(hardness))?;
    let straight = direct.indentation.expect("it yields");
    let change = apart(&deeper, &straight);
    assert!(change < 1e-2 * deepest, "{:e}", change / deepest);
    Ok(())
}

/// The work of loading less that of unloading is Σ H w dA, above 0. Trapezoids over 40 steps miss it by (1/40)² of
/// the work times a factor of some ten, for a force that begins as δ^{3/2} and leaves as steeply.
#[test]
fn the_loop_of_loading_and_unloading_dissipates_the_plastic_work() -> Result<()> {
    let contact = soft(64, 4.0)?;
    let shape = sphere()?;
    let hardness = 2.5e-4;
    let steps = 40;
    let deepest = 1.2e-3;
    let path = (0..=2 * steps).map(|k| deepest * (1.0 - (k as f64 / f64::from(steps) - 1.0).abs()));
    let (mut loop_work, mut last): (f64, Option<Solution>) = (0.0, None);
    for approach in path {
        let options = last.as_ref().map_or_else(|| limited(hardness), |last| next(last, hardness));
        let found = contact.solve(&shape, &Motion::approach(approach), &options)?;
        if let Some(last) = &last {
            loop_work += 0.5 * (found.load() + last.load()) * (found.approach - last.approach);
        }
        last = Some(found);
    }
    let last = last.expect("steps were made");
    assert!(last.load().abs() <= 0.0);
    let work = last.plastic_work();
    assert!(work > 0.0 && (loop_work / work - 1.0).abs() < 0.01, "{loop_work:e} {work:e}");
    Ok(())
}

/// The dent below a sphere, against rings of uniform pressure on a half-space: another discretisation, and another
/// algorithm, that of the active sets of both bounds with dense elimination.
#[test]
fn the_dent_of_a_sphere_is_that_of_an_axisymmetric_computation() -> Result<()> {
    let (radius, load, hardness) = (1e3, 1e-3, 3.5e-4);
    let contact = plan(Elastic::new(1.0, 0.0)?, Grid::new([256, 256], [3.2, 3.2])?)?;
    let found = contact.solve(&sphere()?, &Motion::load(load), &limited(hardness))?;
    let dent = found.indentation.as_ref().expect("it yields");
    let rings = Rings::new(1.5, 400);
    let (pressure, approach) = rings.solve(radius, load, hardness);
    let ring_dent: Vec<f64> = rings.dent(radius, &pressure, approach, hardness);
    assert!((found.approach / approach - 1.0).abs() < 1e-3, "{:e} {approach:e}", found.approach);
    let deepest = ring_dent[0];
    let (x, y) = (contact.grid().x(), contact.grid().y());
    let mut worst = 0.0_f64;
    for ((i, j), w) in dent.indexed_iter() {
        let r = x[i].hypot(y[j]);
        let expected = rings.at(&ring_dent, r);
        worst = worst.max((w - expected).abs());
    }
    claim("dent", worst / deepest);
    Ok(())
}

/// The grid that is chosen holds the whole contact, which is larger than the elastic one, and the solution is that on
/// this grid.
#[test]
fn a_grid_is_chosen_for_contacts_that_yield() -> Result<()> {
    let body = Elastic::new(1.0, 0.0)?;
    let shape = sphere()?;
    let elastic = solve(&shape, body, &Motion::load(1e-3))?;
    let options = limited(0.3 * elastic.peak_pressure());
    let (setup, motion) = (Setup::default(), Motion::load(1e-3));
    let found = nacre::contact::solve_with(&shape, &body.into(), &setup, &motion, &options)?;
    assert!(found.report.converged() && found.report.warnings.is_empty());
    // W = H A within the elastic rim.
    let area = 1e-3 / (0.3 * elastic.peak_pressure());
    assert!((found.contact_area() / area - 1.0).abs() < 0.02);
    let again = Contact::plan(body, *found.grid(), setup)?.solve(&shape, &motion, &options)?;
    assert_eq!(again.pressure, found.pressure);
    Ok(())
}

/// A load that the surfaces cannot bear is refused with both numbers; so are wrong hardnesses and indentations.
#[test]
fn wrong_input_is_refused() -> Result<()> {
    let contact = soft(8, 2.0)?;
    let (shape, motion) = (sphere()?, Motion::load(1e-3));
    let message = |options: &Options| {
        let refused = contact.solve(&shape, &motion, options);
        refused.expect_err("it must be refused").to_string()
    };
    assert_eq!(
        message(&limited(1e-4)),
        "load must be below what the hardness can carry on the cells that can touch, 0.0004, was 0.001: where all of them \
         yield, no approach is determined"
    );
    // A punch that bears 99 % of what it can has 1 % of its area left to shift the force with: by 1 % of its radius, not
    // by a tenth.
    let punch = FlatPunch::new(0.9)?;
    let touching = punch.gaps(contact.grid())?.iter().filter(|h| h.is_finite()).count();
    let area = touching as f64 * contact.grid().cell_area();
    let eccentric = Motion::load(0.99 * 1e-3 * area).with_eccentricity([Some(0.1), None]);
    let refused = contact.solve(&punch, &eccentric, &limited(1e-3));
    let refused = refused.expect_err("it must be refused").to_string();
    let expected = "moment, or load times eccentricity, along x must be between ";
    assert!(refused.starts_with(expected), "{refused}");
    for wrong in [0.0, -1.0, f64::NAN] {
        assert_eq!(message(&limited(wrong)), format!("hardness must be above 0, got {wrong}"));
    }
    let cells = Options::default().with_hardness(Hardness::Cells(Array2::ones((8, 7))));
    assert_eq!(message(&cells), "hardness: expected shape [8, 8], got [8, 7]");
    for (field, expected) in [
        (Array2::zeros((2, 8)), "indentation: expected shape [8, 8], got [2, 8]"),
        (Array2::from_elem((8, 8), -1.0), "indentation must be at least 0 everywhere, got -1"),
        (Array2::from_elem((8, 8), f64::NAN), "indentation is not finite at [0, 0]"),
    ] {
        let options = Options::default().with_indentation(field);
        assert_eq!(message(&options), expected);
    }
    Ok(())
}

/// A break stops the solve in the middle of yielding, with a balanced pressure.
#[test]
fn a_break_stops_yielding() -> Result<()> {
    let contact = soft(64, 4.0)?;
    let (shape, motion) = (sphere()?, Motion::load(1e-3));
    let elastic = contact.solve(&shape, &motion, &Options::default())?;
    let options = limited(0.5 * elastic.peak_pressure());
    let mut calls = 0;
    let mut progress = |_: &nacre::Report| {
        calls += 1;
        match calls > elastic.report.iterations + 4 {
            true => std::ops::ControlFlow::Break(()),
            false => std::ops::ControlFlow::Continue(()),
        }
    };
    let stopped = contact.solve(&shape, &motion, options.watched(&mut progress))?;
    assert_eq!(stopped.report.termination, nacre::Termination::Stopped);
    assert!(stopped.report.balance.force < 1e-12);
    Ok(())
}

/// Loads that leave few cells below the hardness: those that newly touch start from no pressure. Loads at which the last round was
/// solved to a thousandth alone, and histories of loads of all sizes.
#[test]
fn few_cells_below_the_hardness_are_solved_to_the_tolerance() -> Result<()> {
    let steel = Elastic::new(210e9, 0.3)?;
    let contact = plan(steel, Grid::new([64, 64], [4e-4, 4e-4])?)?;
    let (ball, hardness) = (Paraboloid::new(5e-3, 5e-3)?, 3.6985e8);
    for load in [0.5125, 0.8619, 2.2637, 4.6412, 4.995, 5.0, 5.05, 5.5195, 6.8972] {
        let found = contact.solve(&ball, &Motion::load(load), &limited(hardness))?;
        check_bounds(&load.to_string(), &contact, &ball, &found, &|_| hardness)?;
    }
    let loads = crate::support::random::uniform([1, 40], 11).mapv(|r| 10_f64.powf(2.3 * r - 1.0));
    let mut last: Option<Solution> = None;
    for load in &loads {
        let options = last.as_ref().map_or_else(|| limited(hardness), |s| next(s, hardness));
        let found = contact.solve(&ball, &Motion::load(*load), &options)?;
        assert!(found.report.converged(), "{load}: {:?}", found.report);
        last = Some(found);
    }
    Ok(())
}
