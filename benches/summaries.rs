//! Cost of a summary of stresses, in plans and solves of its contact: `summaries [CELLS]`, by default 128, 256 and 512.
//!
//! Prints one line of JSON for each body under a ball whose contact is as wide as a 3.2th of the grid: a half-space, one with
//! a coating, and one with a free end. Times are the best of some rounds, on one thread.

use std::time::Instant;

use nacre::{
    Contact, Elastic, Grid, HalfSpace, Layer, Member, Motion, Options, Result, Setup, Sphere,
    StressOptions,
};

const ROUNDS: usize = 3;

/// Half-width of the contact \[m\], and the grid's side in whole widths of it.
const HALF_WIDTH: f64 = 93e-6;
const WIDTHS: f64 = 3.2;

/// Seconds that `work` takes, and the result.
fn seconds<T>(work: impl FnOnce() -> Result<T>) -> Result<(f64, T)> {
    let start = Instant::now();
    let result = work()?;
    Ok((start.elapsed().as_secs_f64(), result))
}

/// Prints what the contact of a body and the summary of its stresses cost.
fn measure(name: &str, body: &HalfSpace, cells: usize) -> Result<()> {
    let side = 2.0 * WIDTHS * HALF_WIDTH;
    let grid = Grid::new([cells, cells], [side, side])?;
    let ball = Sphere::new(5e-3)?;
    let options = StressOptions::default().with_threads(1);
    let [mut solve, mut summary] = [f64::INFINITY; 2];
    for _ in 0..ROUNDS {
        let (time, solution) = seconds(|| {
            let contact = Contact::plan(body.clone(), grid, Setup::default().with_threads(1))?;
            contact.solve(&ball, &Motion::load(50.0), &Options::default())
        })?;
        solve = solve.min(time);
        let strengths = nacre::stress::Strengths::default();
        let summarised = || solution.stress_summary(Member::Body, &strengths, &options);
        summary = summary.min(seconds(summarised)?.0);
    }
    let ratio = summary / solve;
    println!(
        r#"{{"body": "{name}", "cells": {cells}, "solve": {solve:e}, "summary": {summary:e}, "solves": {ratio:.1}}}"#
    );
    Ok(())
}

fn main() -> Result<()> {
    // Cargo adds options of its own.
    let given: Vec<String> = std::env::args().skip(1).collect();
    let given = given.iter().filter(|word| !word.starts_with("--"));
    let numbers: Vec<usize> = given.filter_map(|word| word.parse().ok()).collect();
    let sizes = if numbers.is_empty() { vec![128, 256, 512] } else { numbers };
    let steel = Elastic::new(210e9, 0.3)?;
    let coating = Layer::new(Elastic::new(252e9, 0.3)?, 10e-6)?;
    let bodies = [
        ("half-space", HalfSpace::from(steel)),
        ("coated", HalfSpace::new(steel, [coating])?),
        ("ended", HalfSpace::from(steel).with_ends([Some(-1.5 * HALF_WIDTH), None])?),
    ];
    for cells in sizes {
        for (name, body) in &bodies {
            measure(name, body, cells)?;
        }
    }
    Ok(())
}
