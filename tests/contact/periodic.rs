//! Grids that repeat, along one direction or both.

use std::f64::consts::PI;

use nacre::influence::{Method, influence_coefficients};
use nacre::response::frequency_response;
use nacre::{
    Contact, Cylinder, Elastic, Error, Grid, HalfSpace, Hardness, HeightMap, Motion, Options,
    Paraboloid, Result, Solution, Substrate, Surface,
};
use ndarray::Array2;

use crate::support::checks::largest;
use crate::support::claims::claim;
use crate::support::random::uniform;
use crate::support::settings::{self, converged, converted, plan, stack, tolerance};

/// Bare, under thin and thick coats, and a layer on a rigid base; thicknesses in units of `dx`.
fn bodies(dx: f64) -> Result<Vec<HalfSpace>> {
    let soft = Elastic::new(1.0, 0.3)?;
    let mut bodies = vec![soft.into()];
    for h in [0.01, 1.0, 100.0] {
        bodies.push(stack(soft, [[5.0, 0.2, h * dx]])?);
    }
    bodies.push(stack(Substrate::Rigid, [[5.0, 0.2, 3.0 * dx]])?);
    Ok(bodies)
}

fn tight() -> Options {
    tolerance(1e-12)
}

/// A periodic map of heights on the cells of `grid`.
fn map(grid: &Grid, height: impl Fn(f64, f64) -> f64) -> Result<HeightMap> {
    let (x, y) = (grid.x(), grid.y());
    let heights = Array2::from_shape_fn((x.len(), y.len()), |(i, j)| height(x[i], y[j]));
    HeightMap::new(heights, grid.spacing())?.periodic(grid.is_periodic())
}

/// A wave of pressure on cells along one direction has the displacement Σ û/p̂ sinc over all waves that look the same on
/// the cells. The terms alternate.
#[test]
#[ignore = "slow"]
fn waves_have_the_displacement_of_their_aliases() -> Result<()> {
    let even = [1.0, 1.0];
    for (shape, spacing) in [([32, 32], even), ([32, 32], [20.0, 1.0]), ([30, 64], even)] {
        let size = [0, 1].map(|k| shape[k] as f64 * spacing[k]);
        let grid = Grid::new(shape, size)?.periodic([true; 2])?;
        for (number, body) in bodies(1.0)?.iter().enumerate() {
            let c = influence_coefficients(body, &grid, Method::Exact)?;
            for (axis, wave) in [(0, 1), (0, 7), (0, 15), (1, 1), (1, 9)] {
                let n = shape[axis];
                let lines = c.sum_axis(ndarray::Axis(1 - axis));
                let cosine = |i: usize| (2.0 * PI * (wave * i) as f64 / n as f64).cos();
                let found: f64 = lines.iter().enumerate().map(|(i, c)| c * cosine(i)).sum();
                let term = |alias: i64| -> Result<f64> {
                    let k = 2.0 * PI * (wave as f64 + alias as f64 * n as f64) / size[axis];
                    let x = 0.5 * k * spacing[axis];
                    Ok(frequency_response(body, k.abs())? * x.sin() / x)
                };
                // The mean of means of three sums.
                let last = 300;
                let mut due = term(0)?;
                for alias in 1..=last {
                    let weight = [0.25, 0.75, 1.0][(last - alias).min(2) as usize];
                    due += weight * (term(alias)? + term(-alias)?);
                }
                let bar = 1e-9 * due.abs().max(c[[0, 0]]);
                below!((found - due).abs(), bar, grid, number, axis, wave);
            }
        }
    }
    Ok(())
}

/// Along the open direction, the coefficients of a grid that repeats along the other are those of line contact where the
/// pressure does not change along it.
#[test]
fn one_direction_and_the_line() -> Result<()> {
    let body = stack(Elastic::new(1.0, 0.3)?, [[4.0, 0.3, 0.3]])?;
    let shape = Cylinder::new(50.0)?;
    let motion = Motion::load(0.02);
    let line = plan(&body, Grid::line(128, 4.0)?)?;
    let line = line.solve(&shape, &motion, &tight())?;
    let grid = Grid::new([24, 128], [1.0, 4.0])?.periodic([true, false])?;
    let contact = plan(&body, grid)?;
    let found = contact.solve(&shape, &motion, &tight())?;
    assert!(found.report.converged() && found.report.warnings.is_empty());
    let peak = line.peak_pressure();
    for ((_, j), p) in found.pressure.indexed_iter() {
        assert!((p - line.pressure[[0, j]]).abs() < 1e-6 * peak);
    }
    near!(found.approach, line.approach, 1e-9);
    // A period has no first cell: what depends on it is no number, and the other direction keeps its own.
    let ([mx, my], [ex, ey], [x, y]) =
        (found.moment(), found.eccentricity(), found.contact_extent());
    assert!(mx.is_nan() && ex.is_nan() && x.iter().all(|end| end.is_nan()));
    let half = 0.5 * grid.size()[1];
    assert!(my.abs() < 1e-6 * found.load() * half && ey.abs() < 1e-6 * half);
    for (end, due) in y.into_iter().zip(line.contact_extent()[1]) {
        near!(end, due, 1e-6);
    }
    Ok(())
}

/// The ends of a spot are those of the spot until it goes on from the last cell to the first.
#[test]
fn a_spot_that_wraps_has_no_ends() -> Result<()> {
    let grid = Grid::new([32, 32], [1.0, 1.0])?.periodic([true; 2])?;
    let contact = plan(Elastic::new(1.0, 0.3)?, grid)?;
    for (at, wraps) in [(0.0, false), (0.5, true)] {
        let height = |x: f64, y: f64| 1e-3 * ((2.0 * PI * (x - at)).cos() + (2.0 * PI * y).cos());
        let found = contact.solve(&map(&grid, height)?, &Motion::load(1e-4), &tight())?;
        let [x, y] = found.contact_extent();
        assert_eq!(x[0].is_nan() && x[1].is_nan(), wraps);
        assert!((y[0] + y[1]).abs() < 1e-6 && y[1] > 0.0);
        assert!(found.moment().into_iter().chain(found.eccentricity()).all(f64::is_nan));
    }
    Ok(())
}

/// Full contact of a wave h = Δ cos kx cos ky on any layers: p = p̄ + Δ/c11(√2 k) cos kx cos ky. The spectral method has it
/// to rounding, the cells to the second order.
#[test]
#[ignore = "slow"]
fn full_contact_of_crossed_waves() -> Result<()> {
    let (k, height) = (2.0 * PI / 10.0, 1e-3);
    for (number, body) in bodies(0.3)?.iter().enumerate() {
        let amplitude = height / frequency_response(body, k * 2.0_f64.sqrt())?;
        let error = |n: usize, method: Method| -> Result<f64> {
            let grid = Grid::new([n, n], [10.0, 10.0])?.periodic([true; 2])?;
            let shape = map(&grid, |x, y| height * (k * x).cos() * (k * y).cos())?;
            let contact = converted(body, grid, method)?;
            let solution = contact.solve(&shape, &Motion::load(150.0 * amplitude), &tight())?;
            let (x, y) = (grid.x(), grid.y());
            let wrong = solution.pressure.indexed_iter().map(|((i, j), p)| {
                (p / amplitude - 1.5 - (k * x[i]).cos() * (k * y[j]).cos()).abs()
            });
            Ok(wrong.fold(0.0, f64::max))
        };
        claim("waves", error(48, Method::Spectral)?);
        let [coarse, fine] = [error(32, Method::Exact)?, error(64, Method::Exact)?];
        below!(fine, 1e-3, number);
        near!(coarse / fine, 4.0, 0.2, number);
    }
    Ok(())
}

/// Westergaard's wave in partial contact, J. Appl. Mech. 6 (1939) A49: pressure from two cells inside the edge on, and the
/// width of the contact.
#[test]
fn westergaards_wave() -> Result<()> {
    let n = 1024;
    let grid = Grid::new([2, n], [0.25, 1.0])?.periodic([true; 2])?;
    let contact = plan(Elastic::new(1.0, 0.0)?, grid)?;
    let height = 1e-3;
    let shape = map(&grid, |_, y| height * (2.0 * PI * y).cos())?;
    let cell = grid.spacing()[1];
    for share in [0.1_f64, 0.3, 0.5, 0.7, 0.9] {
        let mean = share * PI * height;
        let motion = Motion::load(mean * grid.size()[0]);
        let solution = contact.solve(&shape, &motion, &Options::default())?;
        let half = share.sqrt().asin() / PI;
        for (j, y) in grid.y().iter().enumerate() {
            if y.abs() < half - 2.0 * cell {
                let rest = (share - (PI * y).sin().powi(2)).sqrt();
                let due = 2.0 * mean * (PI * y).cos() / share * rest;
                let found = solution.pressure[[0, j]];
                near!(found, due, 1e-3, share, y);
            }
        }
        let row = solution.pressure.row(0);
        let touching = row.iter().filter(|p| **p > 0.0).count() as f64;
        below!((0.5 * touching * cell - half).abs(), 0.5 * cell, share);
    }
    Ok(())
}

/// A rough surface of random heights, smoothed over some cells.
fn rough(grid: &Grid) -> Result<HeightMap> {
    let phases = uniform([6, 6], 7);
    map(grid, |x, y| {
        phases
            .indexed_iter()
            .map(|((k, l), phase)| {
                let wave = 2.0 * PI * (k as f64 * x + (l as f64 - 2.0) * y + phase);
                2e-3 / (1.0 + (k * k + l * l) as f64) * wave.cos()
            })
            .sum()
    })
}

fn solved(body: &HalfSpace, shape: &dyn Surface, grid: Grid, motion: &Motion) -> Result<Solution> {
    converged(&plan(body, grid)?, shape, motion, &tight())
}

/// A shift by whole cells along a direction that repeats shifts the pressure; so do approach and load, exchanged, give it
/// back.
#[test]
#[ignore = "slow"]
fn shifts_and_controls() -> Result<()> {
    let grid = Grid::new([64, 48], [1.0, 1.0])?.periodic([true; 2])?;
    let shape = rough(&grid)?;
    for body in &bodies(0.02)? {
        let one = solved(body, &shape, grid, &Motion::load(5e-4))?;
        let moved = shape.clone().shifted(17.0 / 64.0, -5.0 / 48.0)?;
        let other = solved(body, &moved, grid, &Motion::load(5e-4))?;
        let peak = one.peak_pressure();
        for ((i, j), p) in one.pressure.indexed_iter() {
            let q = other.pressure[[(i + 17) % 64, (j + 43) % 48]];
            below!((p - q).abs(), 1e-7 * peak, i, j, p, q);
        }
        let back = solved(body, &shape, grid, &Motion::approach(one.approach))?;
        near!(back.load(), one.load(), 1e-8);
        let stiffness = one.stiffness(None)?;
        let step = 1e-4 * one.approach.abs();
        let more = solved(body, &shape, grid, &Motion::approach(one.approach + step))?;
        let secant = (more.load() - one.load()) / step;
        near!(stiffness[0][0], secant, 0.02);
    }
    Ok(())
}

/// As the period grows, the contact becomes the open one: the approach at first order, −3.900 W/(πE* L) being that of the
/// other balls on a square lattice, and the pressure at third order.
#[test]
fn a_long_period_is_none() -> Result<()> {
    let (body, ball) = (Elastic::new(1.0, 0.0)?.into(), Paraboloid::new(10.0, 10.0)?);
    let motion = Motion::load(0.05);
    let cell = 1.0 / 32.0;
    let open = solved(&body, &ball, Grid::new([64, 64], [2.0, 2.0])?, &motion)?;
    let wrong = |n: usize| -> Result<[f64; 2]> {
        let side = n as f64 * cell;
        let grid = Grid::new([n, n], [side, side])?.periodic([true; 2])?;
        let repeated = solved(&body, &ball, grid, &motion)?;
        let lattice = -3.900 * 0.05 / (PI * side);
        let middle = n / 2 - 32;
        let pressures = open.pressure.indexed_iter();
        let apart = pressures.map(|((i, j), p)| {
            (p - repeated.pressure[[i + middle, j + middle]]).abs() / open.peak_pressure()
        });
        let approach = (repeated.approach - open.approach - lattice) / open.approach;
        Ok([approach.abs(), apart.fold(0.0, f64::max)])
    };
    let [near, far] = [wrong(128)?, wrong(256)?];
    for (k, bar) in [1e-2, 5e-2].into_iter().enumerate() {
        below!(near[k], bar, k);
        below!(far[k], 0.16 * near[k], k);
    }
    Ok(())
}

/// Full contact of one wave and of two crossed ones on ten random stacks, to rounding with the spectral method.
#[test]
fn random_stacks_in_full_contact() -> Result<()> {
    let grid = Grid::new([24, 20], [2.4, 2.0])?.periodic([true; 2])?;
    for number in 0..10 {
        let r = uniform([1, 14], 900 + number);
        let power = |k: usize, least: f64| 10_f64.powf(2.0 * r[[0, k]] + least);
        let layer = |k: usize| [power(k, -1.0), 0.49 * r[[0, k + 1]], power(k + 2, -1.5)];
        let base = match number % 3 {
            0 => Substrate::Rigid,
            _ => Elastic::new(power(12, -1.0), 0.49 * r[[0, 13]])?.into(),
        };
        let body = stack(base, (0..=number as usize % 4).map(|k| layer(3 * k)))?;
        for [k, l] in [[1, 0], [2, 3]] {
            let (qx, qy) = (2.0 * PI * f64::from(k) / 2.4, 2.0 * PI * f64::from(l) / 2.0);
            let wave = |x: f64, y: f64| (qx * x).cos() * (qy * y).cos();
            let alpha = qx.hypot(qy);
            let amplitude = 1e-3 / frequency_response(&body, alpha)?;
            let contact = converted(&body, grid, Method::Spectral)?;
            let shape = map(&grid, |x, y| 1e-3 * wave(x, y))?;
            let found = contact.solve(&shape, &Motion::load(1.2 * amplitude * 4.8), &tight())?;
            let (x, y) = (grid.x(), grid.y());
            let mut worst = 0.0_f64;
            for ((i, j), p) in found.pressure.indexed_iter() {
                let due = amplitude * (1.2 + wave(x[i], y[j]));
                worst = worst.max((p - due).abs() / amplitude);
            }
            claim("waves", worst);
            let largest = found.gap().iter().fold(0.0_f64, |m, g| m.max(g.abs()));
            below!(largest, 1e-12 * 1e-3, number);
        }
    }
    Ok(())
}

/// The operator of a mirrored pressure is mirrored, that of a shifted one shifted, and with x and y exchanged transposed.
#[test]
#[ignore = "slow"]
fn the_operator_is_mirrored_shifted_and_transposed() -> Result<()> {
    let shape = [30, 18];
    let pressure = uniform(shape, 31);
    for repeats in [[true, true], [true, false], [false, true]] {
        for body in &bodies(1.0)? {
            let displaced = |p: &Array2<f64>, turned: bool| -> Result<Array2<f64>> {
                let (shape, repeats) = match turned {
                    true => ([18, 30], [repeats[1], repeats[0]]),
                    false => (shape, repeats),
                };
                let size = shape.map(|n| n as f64);
                let grid = Grid::new(shape, size)?.periodic(repeats)?;
                plan(body, grid)?.convolution().apply(p)
            };
            let at = |values: &Array2<f64>, [i, j]: [usize; 2]| values[[i % 30, j % 18]];
            let here = displaced(&pressure, false)?;
            let most = largest(&here);
            let moved = |i: usize| if repeats[0] { i + 7 } else { i };
            let shifted = Array2::from_shape_fn(shape, |(i, j)| at(&pressure, [moved(i), j]));
            let mirrored = Array2::from_shape_fn(shape, |(i, j)| pressure[[29 - i, 17 - j]]);
            let transposed = pressure.t().to_owned();
            let [shifted, mirrored] = [displaced(&shifted, false)?, displaced(&mirrored, false)?];
            let transposed = displaced(&transposed, true)?;
            for ((i, j), u) in here.indexed_iter() {
                for error in [
                    shifted[[i, j]] - at(&here, [moved(i), j]),
                    mirrored[[29 - i, 17 - j]] - u,
                    transposed[[j, i]] - u,
                ] {
                    below!(error.abs(), 1e-12 * most, repeats, i, j);
                }
            }
        }
    }
    Ok(())
}

/// One thread, two and four give the same bits, with a hardness as well.
#[test]
#[ignore = "slow"]
fn threads_change_no_bit() -> Result<()> {
    let grid = Grid::new([128, 96], [1.0, 0.75])?.periodic([true; 2])?;
    let shape = rough(&grid)?;
    let body = &bodies(0.01)?[1];
    let solve = |threads: usize, hardness: Option<f64>| -> Result<Solution> {
        let setup = settings::threads(threads);
        let options = Options::default().with_hardness(hardness.map(Hardness::Uniform));
        Contact::plan(body, grid, setup)?.solve(&shape, &Motion::load(2e-3), &options)
    };
    let elastic = solve(1, None)?;
    let hardness = 0.5 * elastic.peak_pressure();
    let yielding = solve(1, Some(hardness))?;
    assert!(yielding.indentation.is_some());
    for threads in [2, 4] {
        assert_eq!(solve(threads, None)?.pressure, elastic.pressure);
        let found = solve(threads, Some(hardness))?;
        assert_eq!(found.pressure, yielding.pressure);
        assert_eq!(found.indentation, yielding.indentation);
    }
    Ok(())
}

/// Beyond full contact there is no elastic solution, and an approach ends where cells yield: soon, with the force of the
/// gaps that are left. Without a hardness it is refused.
#[test]
fn beyond_full_contact_cells_yield() -> Result<()> {
    let grid = Grid::new([24, 20], [1.0, 0.8])?.periodic([true; 2])?;
    let (shape, contact) = (rough(&grid)?, plan(Elastic::new(1.0, 0.3)?, grid)?);
    let gaps = shape.gaps(&grid)?;
    let mean = gaps.sum() / gaps.len() as f64;
    let most = gaps.fold(0.0_f64, |most, gap| most.max(*gap));
    for (part, hardness) in [(0.1, 1e-3), (0.1, 0.1), (0.6, 1e-2), (1.1, 1e-2)] {
        let approach = mean + part * (most - mean);
        let motion = Motion::approach(approach);
        let refused = contact.solve(&shape, &motion, &Options::default());
        assert!(matches!(refused, Err(Error::FullContact { .. })), "{refused:?}");
        let options = Options::default().with_hardness(Hardness::Uniform(hardness));
        let solution = contact.solve(&shape, &motion, &options)?;
        assert!(solution.report.converged(), "{:?}", solution.report);
        below!(solution.report.convolutions, 300.0, part, hardness);
        // The dents make up for what no elastic displacement does.
        let dents = solution.indentation.clone().expect("cells yield");
        let gap = solution.gap().sum() / gaps.len() as f64;
        near!(dents.sum() / gaps.len() as f64 - gap, approach - mean, 1e-9);
        assert!(solution.peak_pressure() <= hardness);
    }
    Ok(())
}

/// What makes no sense on a grid that repeats is refused.
#[test]
fn what_does_not_repeat_is_refused() -> Result<()> {
    let grid = Grid::new([32, 32], [1.0, 1.0])?.periodic([true, false])?;
    let body: HalfSpace = Elastic::new(1.0, 0.0)?.into();
    let contact = plan(&body, grid)?;
    let ball = Paraboloid::new(10.0, 10.0)?;
    let asked = |shape: &dyn Surface, motion: Motion| {
        let refused = contact.solve(shape, &motion, &Options::default()).err();
        refused.map(|error| error.to_string()).unwrap_or_default()
    };
    let tilted = Motion::load(1e-3).with_tilt([Some(1e-3), None]);
    assert!(asked(&ball, tilted).contains("along x the grid is periodic"));
    let beside = ball.shifted(0.2, 0.0)?;
    assert!(asked(&beside, Motion::load(1e-3)).contains("shape must repeat along x"));
    let ended = body.clone().with_ends([Some(-0.5), None])?;
    assert!(matches!(
        plan(&ended, grid),
        Err(Error::Inconsistent(message)) if message.contains("leave out their ends")
    ));
    assert!(Grid::line(8, 1.0)?.periodic([false, true]).is_err());
    Ok(())
}
