//! Stresses on grids that repeat: shifts, balance, open limits, friction, solved contacts.

use std::f64::consts::PI;

use nacre::stress::{Strengths, StressSummary};
use nacre::{
    Contact, Elastic, Grid, HalfSpace, HeightMap, Layer, Member, Motion, Options, Result, Section,
    Setup, Solution, Stress, StressOptions, stress,
};
use ndarray::{Array2, Axis};

use crate::support::claims::claim;
use crate::support::random::uniform;
use crate::support::stresses::{self, displaced};

fn coated() -> Result<HalfSpace> {
    let (soft, hard) = (Elastic::new(1.0, 0.3)?, Elastic::new(4.0, 0.25)?);
    HalfSpace::new(soft, [Layer::new(hard, 1.5)?])
}

fn sliding(direction: [f64; 2]) -> StressOptions {
    displaced(stresses::sliding(0.3, direction))
}

/// Largest difference of any component.
fn difference(a: &Stress, b: &Stress) -> f64 {
    let pairs = a.components.iter().zip(&b.components);
    pairs.fold(0.0, |most, (a, b)| (a - b).iter().fold(most, |most: f64, d| most.max(d.abs())))
}

/// Values of a grid, moved by whole cells along both directions.
fn rolled(values: &Array2<f64>, by: [usize; 2]) -> Array2<f64> {
    let [nx, ny] = [values.nrows(), values.ncols()];
    Array2::from_shape_fn((nx, ny), |(i, j)| values[[(i + nx - by[0]) % nx, (j + ny - by[1]) % ny]])
}

/// A pressure that is moved has the same stress, moved: sums over images are made once, so that only the rounding of
/// transforms of 280 cells is left. The mean of σ_zz is minus that of the pressure at each depth, and that of the shear minus
/// friction times it.
#[test]
#[ignore = "slow"]
fn shifts_move_the_stress_and_each_depth_bears_the_load() -> Result<()> {
    let shape = [20, 14];
    let grid = Grid::new(shape, [20.0, 14.0])?.periodic([true; 2])?;
    let pressure = uniform(shape, 7);
    let (body, depths) = (coated()?, [0.0, 0.5, 1.5, 4.0, 30.0]);
    let options = sliding([0.6, 0.8]);
    let here = stress(&body, &grid, &pressure, &depths, &options)?;
    let there = stress(&body, &grid, &rolled(&pressure, [7, 5]), &depths, &options)?;
    let mean = pressure.sum() / 280.0;
    for (k, _) in depths.iter().enumerate() {
        for (a, b) in here.components.iter().zip(&there.components) {
            let (a, b) = (a.index_axis(Axis(0), k), b.index_axis(Axis(0), k));
            let moved = rolled(&a.to_owned(), [7, 5]);
            let error = (&moved - &b).iter().fold(0.0_f64, |m, d| m.max(d.abs()));
            assert!(error < 1e-11, "{k}: {error:e}");
        }
        for (component, due) in [(2, -mean), (5, -0.18 * mean), (4, -0.24 * mean)] {
            let plane = here.components[component].index_axis(Axis(0), k);
            let found = plane.sum() / 280.0;
            assert!((found - due).abs() < 1e-12, "{k} {component}: {found} {due}");
        }
    }
    // Far below, nothing but the mean is left: waves of 20 have decayed by e^{−2π 30/20} (1 + …) < 2e-3.
    let deep = here.zz().index_axis(Axis(0), 4);
    assert!(deep.iter().all(|zz| (zz + mean).abs() < 2e-3 * mean));
    Ok(())
}

/// Along a period, a pressure that does not vary is that of a line contact, under friction along it and across it.
#[test]
#[ignore = "slow"]
fn strips_along_the_period_are_line_contacts() -> Result<()> {
    let body = coated()?;
    let profile: Vec<f64> =
        (0..24).map(|j| if (6..15).contains(&j) { 1.0 + 0.1 * j as f64 } else { 0.0 }).collect();
    let line = Grid::line(24, 12.0)?;
    let on_line = Array2::from_shape_fn((1, 24), |(_, j)| profile[j]);
    let depths = [0.0, 0.2, 1.5, 5.0];
    for (direction, turned) in [([1.0, 0.0], [0.0, 1.0]), ([0.0, 1.0], [1.0, 0.0])] {
        let due = stress(&body, &line, &on_line, &depths, &sliding(direction))?;
        let along_x = Grid::new([10, 24], [7.0, 12.0])?.periodic([true, false])?;
        let pressure = Array2::from_shape_fn((10, 24), |(_, j)| profile[j]);
        let found = stress(&body, &along_x, &pressure, &depths, &sliding(direction))?;
        let along_y = Grid::new([24, 10], [12.0, 7.0])?.periodic([false, true])?;
        let pressure = Array2::from_shape_fn((24, 10), |(i, _)| profile[i]);
        let turned = stress(&body, &along_y, &pressure, &depths, &sliding(turned))?;
        let exchanged = [1, 0, 2, 3, 5, 4];
        for (component, turned_component) in exchanged.into_iter().enumerate() {
            for k in 0..depths.len() {
                for j in 0..24 {
                    let due = due.components[component][[k, 0, j]];
                    let a = found.components[component][[k, 3, j]];
                    let b = turned.components[turned_component][[k, j, 3]];
                    // Coefficients err by 1e-7 of that of the loaded cell, and nine cells are loaded.
                    println!("{component} {k} {j}: {a} {b} {due}");
                    claim("periodic-stress", (a - due).abs().max((b - due).abs()));
                }
            }
        }
    }
    Ok(())
}

/// A wave along the period of a strip of cells does not feel whether far strips repeat: its stress falls off as
/// e^{−q|x|}, q = 2π/6, which is 1e-8 at half of 36 cells.
#[test]
#[ignore = "slow"]
fn waves_along_the_period_are_the_same_whether_the_other_direction_repeats() -> Result<()> {
    let body = coated()?;
    let shape = [36, 12];
    let wave = |j: usize| (2.0 * PI * (j as f64 + 0.5) / 6.0).cos();
    let pressure =
        Array2::from_shape_fn(shape, |(i, j)| if (16..20).contains(&i) { wave(j) } else { 0.0 });
    let grid = Grid::new(shape, [36.0, 12.0])?;
    let depths = [0.3, 1.5, 3.0];
    let one =
        stress(&body, &grid.periodic([false, true])?, &pressure, &depths, &sliding([1.0, 0.0]))?;
    let both = stress(&body, &grid.periodic([true; 2])?, &pressure, &depths, &sliding([1.0, 0.0]))?;
    assert!(difference(&one, &both) < 2e-6, "{:e}", difference(&one, &both));
    assert!(one.zz().iter().any(|zz| zz.abs() > 0.1));
    Ok(())
}

/// In a large period, a patch has the stress of an open grid: at a depth z the others add some (z/L)³ of its σ_zz, and
/// the mean pressure of the period to the sides.
#[test]
fn a_lone_patch_has_the_stress_of_an_open_grid() -> Result<()> {
    let body = coated()?;
    let shape = [120, 120];
    let grid = Grid::new(shape, [120.0, 120.0])?;
    let pressure = Array2::from_shape_fn(shape, |(i, j)| {
        f64::from(u8::from((58..62).contains(&i) && (58..62).contains(&j)))
    });
    let depths = [0.5, 2.0];
    let options = StressOptions::default();
    let open = stress(&body, &grid, &pressure, &depths, &options)?;
    let periodic = stress(&body, &grid.periodic([true; 2])?, &pressure, &depths, &options)?;
    let mean = 16.0 / 14400.0;
    let difference = difference(&open, &periodic);
    assert!(difference < 3.0 * mean, "{difference:e} {mean:e}");
    let at = [1, 60, 60];
    let change = open.zz()[at] - periodic.zz()[at];
    assert!(change.abs() < 1e-2 * mean && open.zz()[at] < -0.5, "{change:e}");
    Ok(())
}

fn map(grid: &Grid, by: [usize; 2]) -> Result<HeightMap> {
    let [nx, ny] = grid.shape();
    let heights = Array2::from_shape_fn((nx, ny), |(i, j)| {
        let (x, y) = (2.0 * PI * i as f64 / nx as f64, 2.0 * PI * j as f64 / ny as f64);
        0.02 * (x.cos() + (y + 0.4).cos() + 0.4 * (2.0 * x + y).cos())
    });
    HeightMap::new(rolled(&heights, by), grid.spacing())?.periodic([true; 2])
}

fn solved(by: [usize; 2], threads: usize) -> Result<Solution> {
    let grid = Grid::new([48, 40], [6.0, 5.0])?.periodic([true; 2])?;
    let setup = Setup::default()
        .with_counterbody(HalfSpace::from(Elastic::new(2.0, 0.2)?))
        .with_threads(threads);
    let contact = Contact::plan(&coated()?, grid, setup)?;
    let options = Options::default().with_tolerance(1e-11);
    contact.solve(&map(&grid, by)?, &Motion::load(0.2), &options)
}

fn summary(solution: &Solution, member: Member) -> Result<StressSummary> {
    solution.stress_summary(member, &Strengths::default(), &StressOptions::default())
}

/// A contact across the seam has the stresses of the same contact in the middle, with its pressure reconstructed within
/// cells; at points and on planes; and its summary. Pressures of both agree to the tolerance of 1e-11 times the
/// condition of the cells, some 1e3.
#[test]
#[ignore = "slow"]
fn the_seam_is_like_any_other_place() -> Result<()> {
    let (here, there) = (solved([0, 0], 2)?, solved([24, 20], 2)?);
    assert!(here.contact_area() < 0.5 * 30.0 && here.contact_area() > 0.05 * 30.0);
    let depths = [0.0, 0.03, 0.2, 1.5, 2.0];
    let options = sliding([1.0, 0.0]);
    for member in [Member::Body, Member::Counterbody] {
        let a = here.stress(&depths, member, &options)?;
        let b = there.stress(&depths, member, &options)?;
        let peak = here.peak_pressure();
        for (a, b) in a.components.iter().zip(&b.components) {
            for k in 0..depths.len() {
                let moved = rolled(&a.index_axis(Axis(0), k).to_owned(), [24, 20]);
                let error = (&moved - &b.index_axis(Axis(0), k))
                    .iter()
                    .fold(0.0_f64, |m, d| m.max(d.abs()));
                assert!(error < 1e-7 * peak, "{k}: {:e}", error / peak);
            }
        }
        assert!(a.uncertainty.is_some());
        let axis =
            options.clone().with_section(Section::Axis([here.grid().x()[3], here.grid().y()[38]]));
        let points = here.stress(&depths, member, &axis)?;
        for (point, plane) in points.components.iter().zip(&a.components) {
            for k in 0..depths.len() {
                let error = point[[k, 0, 0]] - plane[[k, 3, 38]];
                assert!(error.abs() < 1e-10 * peak, "{k}: {:e}", error / peak);
            }
        }
        let (a, b) = (summary(&here, member)?, summary(&there, member)?);
        for (a, b) in a.layers.iter().zip(&b.layers) {
            let ratio = a.von_mises.value / b.von_mises.value;
            assert!((ratio - 1.0).abs() < 1e-6, "{ratio}");
        }
    }
    Ok(())
}

/// One thread, two and four give the same bits.
#[test]
#[ignore = "slow"]
fn threads_change_no_bit() -> Result<()> {
    let fields: Vec<Stress> = [1, 2, 4]
        .into_iter()
        .map(|threads| {
            let options = sliding([0.0, 1.0]).with_threads(threads);
            solved([0, 0], threads)?.stress(&[0.1, 1.0], Member::Body, &options)
        })
        .collect::<Result<_>>()?;
    assert_eq!(fields[0], fields[1]);
    assert_eq!(fields[0], fields[2]);
    Ok(())
}
