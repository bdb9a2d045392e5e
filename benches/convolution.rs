//! Time of one convolution, for `benches/peers`: `convolution [CELLS THREADS]`, by default several of
//! both.
//!
//! Prints one line of JSON for each number of cells and threads: the best time of five applications to
//! random pressures after one that is not counted, the time of the fastest of several solves of a
//! sphere, and the share of this solve outside convolutions.

use std::time::Instant;

use nacre::influence::{Method, influence_coefficients};
use nacre::{Contact, Convolution, Elastic, Grid, Motion, Options, Paraboloid, Result, Setup};
use ndarray::Array2;

const REPETITIONS: usize = 5;

/// Smallest duration of all solves together \[s\], so that some run while no other program uses the
/// memory.
const SECONDS: f64 = 2.0;

/// Reproducible pseudo-random numbers in [0, 1), by Knuth's MMIX generator.
fn random(shape: [usize; 2]) -> Array2<f64> {
    let mut state = 1_u64;
    Array2::from_shape_simple_fn(shape, || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    })
}

/// Time of the fastest application \[s\].
fn best(cells: usize, threads: usize) -> Result<f64> {
    let grid = Grid::new([cells, cells], [2.0, 2.0])?;
    let body = Elastic::new(1.0, 0.0)?;
    let coefficients = influence_coefficients(body, &grid, Method::Exact)?;
    let convolution = Convolution::plan(&coefficients, Some(threads))?;
    let mut workspace = convolution.workspace();
    let pressure = random([cells, cells]);
    let mut displacement = Array2::zeros([cells, cells]);
    let mut best = f64::INFINITY;
    for repetition in 0..=REPETITIONS {
        let start = Instant::now();
        convolution.apply_into(&pressure, &mut displacement, &mut workspace)?;
        if repetition > 0 {
            best = best.min(start.elapsed().as_secs_f64());
        }
    }
    assert!(displacement.iter().all(|u| *u > 0.0));
    Ok(best)
}

/// Time of the fastest solve of a sphere whose contact radius is a sixth of the side \[s\], and its
/// share outside kernels, transforms and products.
fn solve(cells: usize, threads: usize) -> Result<(f64, f64)> {
    const SIDE: f64 = 2.0;
    let setup = Setup::default().with_threads(threads);
    let grid = Grid::new([cells, cells], [SIDE; 2])?;
    let contact = Contact::plan(Elastic::new(1.0, 0.0)?, grid, setup)?;
    let shape = Paraboloid::new(1.0, 1.0)?;
    // Hertz: a³ = 3 W R / 4 E*.
    let motion = Motion::load(4.0 / 3.0 * (SIDE / 6.0).powi(3));
    let (mut best, mut share) = (f64::INFINITY, f64::NAN);
    let begin = Instant::now();
    for repetition in 0.. {
        if repetition > REPETITIONS && begin.elapsed().as_secs_f64() > SECONDS {
            break;
        }
        let (start, before) = (Instant::now(), contact.convolution().seconds());
        let solution = contact.solve(&shape, &motion, &Options::default())?;
        let seconds = start.elapsed().as_secs_f64();
        assert!(solution.report.converged());
        if repetition > 0 && seconds < best {
            best = seconds;
            share = 1.0 - (contact.convolution().seconds() - before) / seconds;
        }
    }
    Ok((best, share))
}

fn main() -> Result<()> {
    // Cargo adds options, which are ignored.
    let numbers: Vec<usize> = std::env::args().filter_map(|a| a.parse().ok()).collect();
    let cases = match numbers[..] {
        [cells, threads] => vec![(cells, threads)],
        _ => vec![(512, 1), (512, 2), (1024, 1), (1024, 2)],
    };
    for (cells, threads) in cases {
        let seconds = best(cells, threads)?;
        let (solve, outside) = solve(cells, threads)?;
        println!(
            r#"{{"cells": {cells}, "threads": {threads}, "seconds": {seconds:e}, "solve": {solve:e}, "outside": {outside:.3}}}"#
        );
    }
    Ok(())
}
