//! Free ends on grids that repeat along y.

use std::f64::consts::PI;

use nacre::{
    Contact, Elastic, Grid, HalfSpace, HeightMap, Motion, Result, Setup, Solution,
    ends::QuarterSpace,
};
use ndarray::{Array2, concatenate};

use super::{pair, tight, unit};

use crate::support::checks::{difference, largest};
use crate::support::random::uniform;
use crate::support::reference::{cases, number};
use crate::support::settings::{converged, plan, pressed, stack};

/// Error of the displacement that is stated for one end.
const STATED: f64 = 1e-5;

/// A grid that repeats along y, from x = 0 on.
fn repeated(shape: [usize; 2], size: [f64; 2]) -> Result<Grid> {
    let grid = Grid::new(shape, size)?.centered_at([0.5 * size[0], 0.0])?;
    grid.periodic([false, true])
}

/// Amplitudes of u G/(1−ν) for k = 1 at places that are edges of cells, under the pressure cos y over x < `end`, of a
/// body that ends at x = 0. The steps of the pressure along y are divided out; what is left is 2e-6.
fn amplitudes(poisson: f64, end: f64, places: &[f64]) -> Result<Vec<f64>> {
    const DX: f64 = 0.0125;
    let grid = repeated([1120, 512], [1120.0 * DX, 2.0 * PI])?;
    let contact = plan(unit(poisson, [Some(0.0), None])?, grid)?;
    let (x, y) = (grid.x(), grid.y());
    let load = |(i, j): (usize, usize)| if x[i] < end { y[j].cos() } else { 0.0 };
    let u = contact.convolution().apply(&Array2::from_shape_fn((x.len(), y.len()), load))?;
    let amplitude = |row: usize| {
        let terms = u.row(row).into_iter().zip(&y).map(|(u, y)| u * y.cos());
        // G/(1−ν) = 1/2
        let half = PI / y.len() as f64;
        terms.sum::<f64>() / y.len() as f64 * half / half.sin()
    };
    let at = |place: &f64| {
        let row = (place / DX).round() as usize;
        let between = |first: usize, weights: [f64; 4]| {
            let terms = weights.into_iter().enumerate();
            terms.map(|(k, w)| w * amplitude(first + k)).sum::<f64>() / 16.0
        };
        match row {
            // 1, x, x² and x² ln x are exact.
            0 => between(0, [40.144651, -50.433952, 36.433952, -10.144651]),
            _ => between(row - 2, [-1.0, 9.0, 9.0, -1.0]),
        }
    };
    Ok(places.iter().map(at).collect())
}

/// A wave of the period on all of the body, and on a strip beside the end, against solutions of others to 1e-8: the
/// displacement errs by less than is stated.
#[test]
#[ignore = "slow"]
fn waves_of_the_period_are_exact() -> Result<()> {
    for (file, end, place, value) in [
        ("quarter_space_wave.json", f64::INFINITY, "kx", "u_quarter"),
        ("quarter_space_strip.json", 1.0, "x", "hetenyi"),
    ] {
        let rows = cases(file);
        let mut ratios: Vec<f64> = rows.iter().map(|row| number(row, "nu")).collect();
        ratios.dedup();
        for poisson in ratios {
            let rows = rows.iter().filter(|row| (number(row, "nu") - poisson).abs() < 1e-9);
            let [places, due] = [place, value].map(|key| {
                let values = rows.clone().map(|row| number(row, key));
                values.collect::<Vec<f64>>()
            });
            let largest = due.iter().fold(0.0_f64, |most, u| most.max(*u));
            let found = amplitudes(poisson, end, &places)?;
            for ((x, due), found) in places.iter().zip(&due).zip(found) {
                let error = (found - due) / largest;
                below!(error.abs(), STATED, file, poisson, x);
            }
        }
    }
    Ok(())
}

/// Bodies with ends in the grid, at its edge, and far outside; bare and coated.
fn bodies() -> Result<Vec<HalfSpace>> {
    let coated = stack(Elastic::new(1.0, 0.3)?, [[5.0, 0.2, 0.3]])?;
    Ok(vec![
        unit(0.3, [Some(0.0), None])?,
        unit(0.0, [None, Some(3.0)])?,
        unit(0.5, [Some(-7.3), Some(3.5)])?,
        unit(0.25, [Some(0.5), Some(4.0)])?,
        unit(0.3, [Some(-300.0), None])?,
        coated.clone().with_ends([Some(0.5), None])?,
        coated.with_ends([Some(0.0), Some(4.0)])?,
    ])
}

/// Layers that are thicker than the period carry what is uniform along y, for which the model of an end with layers takes the
/// substrate; they are refused, and what the message advises helps: a longer period, a grid that does not repeat, no ends.
#[test]
fn layers_thicker_than_the_period_are_refused() -> Result<()> {
    let hard = stack(Elastic::new(50e9, 0.3)?, [[500e9, 0.3, 2e-5]])?;
    let ended = hard.clone().with_ends([None, Some(3.6e-6)])?;
    let side = 1.26e-5;
    let grid = |times: usize| Grid::new([28, 8 * times], [side, times as f64 * side]);
    // Curved along x, where the body ends.
    let shape = |repeats: bool| {
        let x = grid(1)?.x();
        let heights = Array2::from_shape_fn([28, 8], |(i, _)| -x[i] * x[i] / 2.6e-3);
        HeightMap::new(heights, grid(1)?.spacing())?.periodic([false, repeats])
    };
    for (body, grid, is_refused) in [
        (&ended, grid(1)?.periodic([false, true])?, true),
        (&ended, grid(2)?.periodic([false, true])?, false),
        (&ended, grid(1)?, false),
        (&hard, grid(1)?.periodic([false, true])?, false),
    ] {
        let contact = Contact::plan(body, grid, Setup::default());
        if is_refused {
            let message = contact.map(|_| ()).map_err(|error| error.to_string());
            let expected = "at most as thick as the period of the grid along y, 1.26e-5, were 2e-5";
            assert!(message.clone().is_err_and(|text| text.contains(expected)), "{message:?}");
            continue;
        }
        let shape = shape(grid.is_periodic()[1])?;
        let solution = pressed(&contact?, &shape, &Motion::load(5e-2))?;
        assert!(solution.peak_pressure() > 0.0, "{grid:?}");
    }
    Ok(())
}

/// Twice a period is the same: the displacement to 1e-8, where panels of waves and sums over images err, and pressure,
/// approach and stiffness of contacts. Periods are shorter and longer than the grid is wide, of odd and even numbers of
/// cells.
#[test]
#[ignore = "slow"]
fn twice_a_period_is_the_same() -> Result<()> {
    for (cells, period) in [(6, 0.4), (9, 3.0), (40, 20.0)] {
        let once = repeated([8, cells], [4.0, period])?;
        let twice = repeated([8, 2 * cells], [4.0, 2.0 * period])?;
        for (number, body) in bodies()?.iter().enumerate() {
            let name = format!("{period}, body {number}");
            let other = unit(0.2, [None; 2])?;
            let (first, second) = (pair([body, &other], once)?, pair([body, &other], twice)?);
            let p = uniform(once.shape(), 3);
            let double = |field: &Array2<f64>| {
                concatenate(ndarray::Axis(1), &[field.view(), field.view()]).expect("same rows")
            };
            let one = first.convolution().apply(&p)?;
            let two = second.convolution().apply(&double(&p))?;
            below!(difference(&two, &double(&one)), 1e-8, name);

            let heights = uniform(once.shape(), 5) * (1e-3 * period);
            let solved = |contact: &Contact, grid: &Grid, heights: Array2<f64>, motion: &Motion| {
                let shape = HeightMap::new(heights, grid.spacing())?
                    .centered_at(grid.center())?
                    .periodic([false, true])?;
                converged(contact, &shape, motion, &tight())
            };
            let motion = Motion::load(2e-4 * period).with_eccentricity([Some(2.2), None]);
            let twofold = Motion::load(4e-4 * period).with_eccentricity([Some(2.2), None]);
            let a = solved(&first, &once, heights.clone(), &motion)?;
            let b = solved(&second, &twice, double(&heights), &twofold)?;
            let same = |a: &Solution, b: &Solution, name: &str| {
                let found = Array2::from_shape_fn(a.pressure.dim(), |at| b.pressure[at]);
                below!(difference(&found, &a.pressure), 1e-6, name);
                near!(b.approach, a.approach, 1e-6, name);
            };
            same(&a, &b, &name);
            let [k, l] = [a.stiffness(None)?, b.stiffness(None)?].map(|k| k[0][0]);
            near!(l, 2.0 * k, 1e-5, name, k);
            // Under its approach, the contact is the same.
            let motion = Motion::approach(a.approach).with_tilt([Some(a.tilt[0]), None]);
            let c = solved(&first, &once, heights, &motion)?;
            same(&a, &c, &format!("{name}, approach"));
        }
    }
    Ok(())
}

/// A pressure that is uniform along y displaces the body as one on a rectangle that is thousands of times as long as wide,
/// up to a shift: the rectangle's ends tilt the surface, by the inverse of its length, and change it by 1e-7 beyond that.
#[test]
#[ignore = "slow"]
fn a_uniform_pressure_is_that_of_plane_strain() -> Result<()> {
    let grid = repeated([320, 6], [4.0, 0.7])?;
    let x = grid.x();
    for poisson in [0.0, 0.3, 0.5] {
        let material = unit(poisson, [None; 2])?.surface_material();
        let body = HalfSpace::from(material).with_ends([Some(0.0), None])?;
        let contact = plan(body, grid)?;
        let loaded = |i: usize| x[i] > 0.5 && x[i] < 2.0;
        let p = Array2::from_shape_fn((320, 6), |(i, _)| f64::from(u8::from(loaded(i))));
        let u = contact.convolution().apply(&p)?;
        let apart = |half_length: f64, i: usize| -> Result<f64> {
            let long = QuarterSpace::new(material, 0.5, [1.5, half_length])?;
            Ok(long.displacement([x[i], 0.0])? - long.displacement([x[319], 0.0])?)
        };
        for i in [0, 1, 5, 30, 80, 140, 200] {
            let due = 2.0 * apart(6000.0, i)? - apart(3000.0, i)?;
            // The mean over a cell instead of the middle: 1e-5 beside the end, by the square of the cell.
            near!(u[[i, 2]] - u[[319, 2]], due, 2.0 * STATED, poisson, i);
        }
    }
    Ok(())
}

/// For ν = 0, a pressure that does not depend on x leaves the faces of a plate free: two flush bodies have the pressure of
/// bodies that repeat along x as well.
#[test]
#[ignore = "slow"]
fn flush_plates_without_contraction_have_the_pressure_of_a_repeated_cylinder() -> Result<()> {
    for (length, period) in [(0.5, 2.0), (2.0, 2.0), (2.0, 20.0), (20.0, 2.0)] {
        let wave = |shape: [usize; 2], repeats: [bool; 2], ends: [Option<f64>; 2]| {
            let grid = Grid::new(shape, [length, period])?.periodic(repeats)?;
            let y = grid.y();
            let heights = Array2::from_shape_fn((shape[0], shape[1]), |(_, j)| {
                1e-3 * period * (2.0 * PI * y[j] / period).cos()
            });
            let shape = HeightMap::new(heights, grid.spacing())?.periodic(repeats)?;
            let body = unit(0.0, ends)?;
            // The wave touches over half of it.
            let load = 5e-4 * period * length;
            let contact = pair([&body, &body], grid)?;
            converged(&contact, &shape, &Motion::load(load), &tight())
        };
        let ends = [Some(-0.5 * length), Some(0.5 * length)];
        let plate = wave([12, 40], [false, true], ends)?;
        let whole = wave([2, 40], [true; 2], [None; 2])?;
        assert!(plate.pressure[[6, 20]] > 0.0 && plate.pressure[[6, 0]] <= 0.0);
        let error = largest(&(&plate.pressure - &whole.pressure.row(0))) / whole.peak_pressure();
        let stated = plate.report.free_ends().and_then(|form| form.error);
        below!(error, stated.expect("a plate's"), length, period);
    }
    Ok(())
}
