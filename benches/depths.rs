//! What a depth of stresses costs, in convolutions: `depths [CELLS DEPTHS]`, by default 512 and 64.
//!
//! Prints one line of JSON for each load and number of threads: the best of some evaluations of six
//! components on whole planes in a coated body, everything included, and of convolutions between
//! them.

use std::time::Instant;

use nacre::influence::{Method, influence_coefficients};
use nacre::{Convolution, Elastic, Grid, HalfSpace, Layer, Result, StressOptions, stress};
use ndarray::Array2;

/// Rounds; in each an evaluation, and convolutions before and after it.
const ROUNDS: usize = 3;
const CONVOLUTIONS: usize = 50;

/// Seconds that `work` takes; not counted is what its result takes to drop.
fn seconds<T>(work: impl FnOnce() -> Result<T>) -> Result<(f64, T)> {
    let start = Instant::now();
    let result = work()?;
    Ok((start.elapsed().as_secs_f64(), result))
}

/// The pressure of a sphere on a circle of `radius` sides, around the middle of the grid.
fn hertz(cells: usize, radius: f64) -> Array2<f64> {
    let centre = |k: usize| (k as f64 + 0.5) / cells as f64 - 0.5;
    Array2::from_shape_fn((cells, cells), |(i, j)| {
        let distance = centre(i).hypot(centre(j)) / radius;
        (1.0 - distance * distance).max(0.0).sqrt()
    })
}

/// Prints what `depths` planes under `pressure` cost on `threads`.
fn measure(name: &str, pressure: &Array2<f64>, depths: usize, threads: usize) -> Result<()> {
    let cells = pressure.nrows();
    let side = cells as f64;
    let layer = Layer::new(Elastic::new(4.0, 0.3)?, side / 64.0)?;
    let body = HalfSpace::new(Elastic::new(1.0, 0.3)?, vec![layer])?;
    let grid = Grid::new([cells, cells], [side, side])?;
    let coefficients = influence_coefficients(&body, &grid, Method::Exact)?;
    let convolution = Convolution::plan(&coefficients, Some(threads))?;
    let mut workspace = convolution.workspace();
    let mut displacement = Array2::zeros([cells, cells]);
    let options = StressOptions {
        threads: Some(threads),
        ..StressOptions::default()
    };
    // Through the layer and as far again below it.
    let step = side / 32.0 / depths as f64;
    let planes: Vec<f64> = (0..depths).map(|k| (k as f64 + 0.5) * step).collect();
    let (mut one, mut all) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        for _ in 0..CONVOLUTIONS {
            let apply = || convolution.apply_into(pressure, &mut displacement, &mut workspace);
            one = one.min(seconds(apply)?.0);
        }
        let (time, field) = seconds(|| stress(&body, &grid, pressure, &planes, &options))?;
        assert!(field.components[2][[0, cells / 2, cells / 2]] < 0.0);
        all = all.min(time);
    }
    let convolutions = all / depths as f64 / one;
    println!(
        r#"{{"load": "{name}", "cells": {cells}, "depths": {depths}, "threads": {threads}, "seconds": {all:e}, "convolution": {one:e}, "convolutions_a_depth": {convolutions:.2}}}"#
    );
    Ok(())
}

fn main() -> Result<()> {
    // Cargo adds options of its own.
    let given: Vec<String> = std::env::args().skip(1).collect();
    let given = given.iter().filter(|word| !word.starts_with("--"));
    let numbers: Vec<Option<usize>> = given.map(|word| word.parse().ok()).collect();
    let (cells, depths) = match numbers[..] {
        [] => (512, 64),
        [Some(cells), Some(depths)] if cells > 0 && depths > 0 => (cells, depths),
        _ => {
            eprintln!("usage: depths [CELLS DEPTHS], both at least 1");
            std::process::exit(2);
        }
    };
    let whole = Array2::ones((cells, cells));
    for threads in [1, 2] {
        measure("sphere", &hertz(cells, 1.0 / 6.0), depths, threads)?;
        measure("sphere, wide", &hertz(cells, 1.0 / 3.0), depths, threads)?;
        measure("everywhere", &whole, depths, threads)?;
    }
    Ok(())
}
