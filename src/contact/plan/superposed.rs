//! Two free ends of a body as two quarter spaces, against a reference of this form, and against the plate.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use super::{Plan, bodies};
use crate::body::HalfSpace;
use crate::contact::{Motion, Options, Setup, Solution};
use crate::ends::Ends;
use crate::error::Result;
use crate::grid::Grid;
use crate::material::Elastic;
use crate::response::Body;
use crate::surface::{Extent, Surface};

/// A straight roller of this half-length, for which half-width and pressure of Hertz's line are 1 at the load π/2 per
/// length.
#[derive(Debug)]
struct Straight(f64);

impl Surface for Straight {
    fn gap(&self, x: f64, y: f64) -> f64 {
        if x.abs() <= self.0 {
            2.0 * y * y
        } else {
            f64::INFINITY
        }
    }

    fn extent(&self) -> [Extent; 2] {
        [Extent::CutOff([-self.0, self.0]), Extent::Rising]
    }
}

/// How the ends of the roller are counted.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Form {
    Plate,
    QuarterSpaces,
    /// Its low end as that of a quarter space, and the other not at all.
    LowEnd,
}

/// The roller on a race that goes on, on cells of 1/16 of the half-width.
fn roller(half_length: f64, poisson: f64, form: Form) -> Result<Solution> {
    let race = HalfSpace::from(Elastic::new(1.0 - poisson * poisson, poisson)?);
    let high = (form != Form::LowEnd).then_some(half_length);
    let ended = race.clone().with_ends([Some(-half_length), high])?;
    let setup = Setup {
        counterbody: Some(ended.into()),
        ..Setup::default()
    };
    let rows = (32.0 * half_length) as usize;
    let grid = Grid::new([rows, 48], [2.0 * half_length, 3.0])?;
    let body = Body::from(&race);
    let ends = Ends::of(&bodies(&body, &setup));
    let ends = if form == Form::QuarterSpaces {
        ends.superposed()
    } else {
        ends
    };
    let plan = Plan::ending(body, grid, setup, ends)?;
    let (shape, options) = (Straight(half_length), Options::default());
    let mut go_on = |_: &crate::contact::Report| ControlFlow::Continue(());
    let motion = Motion::load(PI * half_length);
    plan.solve(
        &shape,
        &mut Default::default(),
        &motion,
        &options,
        &mut go_on,
    )?
    .require_converged(options.tolerance)
}

/// Pressure beside the axis at the distance `x` from the low end: between cells by a power of the distance.
fn pressure(solution: &Solution, x: f64) -> f64 {
    let spacing = solution.grid().spacing()[0];
    let below = (x / spacing - 0.5).floor() as usize;
    let [(a, p), (b, q)] = [below, below + 1].map(|row| {
        let center = (row as f64 + 0.5) * spacing;
        (center.ln(), solution.pressure[[row, 24]].ln())
    });
    (p + (q - p) * (x.ln() - a) / (b - a)).exp()
}

/// Distances from the end.
const PLACES: [f64; 7] = [0.25, 0.5, 1.0, 2.0, 3.0, 5.0, 8.0];

/// Cases C of `tests/data/finite_roller.json`: dense collocation on graded cells, whose pressures err by 0.2 % from 0.5
/// on, and more at 0.25; its two grids differ by 0.15 % there, and by 0.1 % to 0.2 % elsewhere. Cells of 1/16, the
/// second of which is at 0.1, err by 0.2 % at 0.25. For ν = 0 there is the coarse grid alone.
#[test]
fn superposed_ends_agree_with_the_reference() -> Result<()> {
    let reference = [
        (
            0.3,
            10.176_918,
            [
                1.104_468, 1.053_244, 1.022_842, 1.004_121, 0.996_443, 0.989_300, 0.985_258,
            ],
        ),
        (
            0.0,
            9.510_726,
            [
                1.241_668, 1.127_338, 1.053_362, 1.009_502, 0.993_055, 0.978_443, 0.970_476,
            ],
        ),
    ];
    for (poisson, approach, pressures) in reference {
        let solution = roller(10.0, poisson, Form::QuarterSpaces)?;
        println!("{poisson}: {}", solution.approach / approach - 1.0);
        for (x, expected) in PLACES.into_iter().zip(pressures) {
            let found = pressure(&solution, x);
            println!("{x} {found} {}", found / expected - 1.0);
        }
    }
    Ok(())
}

#[test]
fn forms() -> Result<()> {
    for (half_length, poisson) in [(10.0, 0.3), (10.0, 0.0), (20.0, 0.3)] {
        let [plate, two, low] = [Form::Plate, Form::QuarterSpaces, Form::LowEnd]
            .map(|form| roller(half_length, poisson, form));
        let (plate, two, low) = (plate?, two?, low?);
        println!(
            "{half_length} {poisson} approach {} {}",
            plate.approach / two.approach - 1.0,
            low.approach / two.approach - 1.0
        );
        for x in [0.1, 0.25, 0.5, 1.0, 2.0, 3.0, 5.0, 8.0, 9.9] {
            let at = |s: &Solution| pressure(s, x);
            println!(
                "{x} {} {}",
                at(&plate) / at(&two) - 1.0,
                at(&low) / at(&two) - 1.0
            );
        }
    }
    Ok(())
}
