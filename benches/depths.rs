//! Cost of a depth of stresses, in convolutions: `depths [CELLS DEPTHS]`, by default 512 and 64.
//!
//! Prints one line of JSON for each load and number of threads. The first lines hold the best of some
//! evaluations of six components on whole planes in a coated body, planning included, and of
//! convolutions between them. The last lines hold the times of planning for a solved contact, whose
//! pressure is reconstructed within cells, of evaluating that plan on the same planes, and on one line
//! of the plane at the surface.

use std::time::Instant;

use nacre::influence::{Method, influence_coefficients};
use nacre::{
    Contact, Convolution, Elastic, Grid, HalfSpace, Layer, Member, Motion, Options, Paraboloid,
    Result, Section, Setup, StressOptions, stress,
};
use ndarray::Array2;

/// Rounds; in each an evaluation, and convolutions before and after it.
const ROUNDS: usize = 3;
const CONVOLUTIONS: usize = 50;

/// Seconds that `work` takes, without dropping its result; and the result.
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

/// A half-space with a layer of a 64th of the grid's side, and a grid of unit cells.
fn problem(cells: usize) -> Result<(HalfSpace, Grid)> {
    let side = cells as f64;
    let layer = Layer::new(Elastic::new(4.0, 0.3)?, side / 64.0)?;
    let body = HalfSpace::new(Elastic::new(1.0, 0.3)?, vec![layer])?;
    Ok((body, Grid::new([cells, cells], [side, side])?))
}

/// Depths through the layer and as far again below it.
fn planes(cells: usize, depths: usize) -> Vec<f64> {
    let step = cells as f64 / 32.0 / depths as f64;
    (0..depths).map(|k| (k as f64 + 0.5) * step).collect()
}

/// Prints what `depths` planes under `pressure` cost on `threads`.
fn measure(name: &str, pressure: &Array2<f64>, depths: usize, threads: usize) -> Result<()> {
    let cells = pressure.nrows();
    let (body, grid) = problem(cells)?;
    let coefficients = influence_coefficients(&body, &grid, Method::Exact)?;
    let convolution = Convolution::plan(&coefficients, Some(threads))?;
    let mut workspace = convolution.workspace();
    let mut displacement = Array2::zeros([cells, cells]);
    let options = StressOptions::default().with_threads(threads);
    let planes = planes(cells, depths);
    let (mut one, mut all) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        for _ in 0..CONVOLUTIONS {
            let apply = || convolution.apply_into(pressure, &mut displacement, &mut workspace);
            one = one.min(seconds(apply)?.0);
        }
        let (time, field) = seconds(|| stress(&body, &grid, pressure, &planes, &options))?;
        assert!(field.zz()[[0, cells / 2, cells / 2]] < 0.0);
        all = all.min(time);
    }
    let convolutions = all / depths as f64 / one;
    println!(
        r#"{{"load": "{name}", "cells": {cells}, "depths": {depths}, "threads": {threads}, "seconds": {all:e}, "convolution": {one:e}, "convolutions_a_depth": {convolutions:.2}}}"#
    );
    Ok(())
}

/// Prints what a plan of a solved contact costs on `threads`, and its evaluations.
fn measure_plan(cells: usize, depths: usize, threads: usize) -> Result<()> {
    let (body, grid) = problem(cells)?;
    let side = cells as f64;
    let shape = Paraboloid::new(10.0 * side, 10.0 * side)?;
    // A radius of about a quarter of the grid.
    let load = Motion::load(2e-3 * side * side);
    let contact = Contact::plan(body, grid, Setup::default())?;
    let solution = contact.solve(&shape, &load, &Options::default())?;
    let planes = planes(cells, depths);
    let whole = StressOptions::default();
    let line = StressOptions::default().with_section(Section::Y(0.0));
    let [mut plan, mut evaluate, mut section] = [f64::INFINITY; 3];
    for _ in 0..ROUNDS {
        let (time, planned) = seconds(|| {
            solution.stress_plan(Member::Body, &StressOptions::default().with_threads(threads))
        })?;
        plan = plan.min(time);
        let (time, field) = seconds(|| planned.stress(&planes, &whole))?;
        assert!(field.zz()[[0, cells / 2, cells / 2]] < 0.0);
        evaluate = evaluate.min(time);
        section = section.min(seconds(|| planned.stress(&[0.0], &line))?.0);
    }
    println!(
        r#"{{"load": "solved sphere", "cells": {cells}, "depths": {depths}, "threads": {threads}, "plan": {plan:e}, "evaluate": {evaluate:e}, "surface_line": {section:e}}}"#
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
        measure_plan(cells, depths, threads)?;
    }
    Ok(())
}
