//! Stress has the same bits for any number of threads, and stops when it is told to.

use std::ops::ControlFlow;

use nacre::stress::Strengths;
use nacre::{
    Contact, Elastic, Grid, HalfSpace, Layer, Member, Motion, Options, Paraboloid, Result, Setup,
    Solution, StressOptions, stress,
};

use crate::support::stresses::bits;

/// A smooth contact of a coated body, on more than the 181² cells from which on threads share the
/// work.
fn solution() -> Result<Solution> {
    let coating = Layer::new(Elastic::new(4.0, 0.25)?, 0.2)?;
    let body = HalfSpace::new(Elastic::new(1.0, 0.3)?, [coating])?;
    let contact = Contact::plan(&body, Grid::new([195, 169], [3.0, 2.6])?, Setup::default())?;
    let shape = Paraboloid::new(1.2e3, 1e3)?;
    contact.solve(&shape, &Motion::load(1e-3), &Options::default())
}

fn options(threads: usize) -> StressOptions {
    StressOptions::default()
        .with_friction(0.3)
        .with_direction([1.0, 2.0])
        .with_displacement(true)
        .with_threads(threads)
}

/// Pressure within cells is felt at the surface and at a tenth of a cell, not at the interface and
/// in the substrate.
#[test]
#[ignore = "slow"]
fn bits_do_not_depend_on_the_number_of_threads() -> Result<()> {
    const DEPTHS: [f64; 4] = [0.0, 0.002, 0.2, 0.7];
    let solution = solution()?;
    let body = solution.member(Member::Body)?;
    let both = |threads: usize| -> Result<[Vec<u64>; 2]> {
        let options = options(threads);
        let uniform = stress(body, solution.grid(), &solution.pressure, &DEPTHS, &options)?;
        let solved = solution.stress(&DEPTHS, Member::Body, &options)?;
        Ok([&uniform, &solved].map(bits))
    };
    let one = both(1)?;
    assert_eq!(one[0].len(), DEPTHS.len() * 9 * 195 * 169);
    assert!(one[0] != one[1]);
    for threads in [2, 5] {
        let [uniform, solved] = both(threads)?;
        assert!(uniform == one[0], "{threads} threads");
        assert!(solved == one[1], "solution, {threads} threads");
    }
    Ok(())
}

/// Planning asks progress too, and its break leaves no depth.
#[test]
fn planning_for_one_call_stops_when_told() -> Result<()> {
    let solution = solution()?;
    let (options, strengths) = (options(2), Strengths::default());
    for last in 1..=3 {
        let mut calls = 0;
        let mut stop = |part: f64| {
            assert!(part.abs() < f64::EPSILON);
            calls += 1;
            match calls {
                call if call < last => ControlFlow::Continue(()),
                _ => ControlFlow::Break(()),
            }
        };
        let field = solution.stress(&[0.0, 0.1], Member::Body, options.watched(&mut stop))?;
        assert!(field.z.is_empty() && field.components[0].is_empty());
        assert_eq!(calls, last);
        calls = 0;
        let mut stop = |_| {
            calls += 1;
            match calls {
                call if call < last => ControlFlow::Continue(()),
                _ => ControlFlow::Break(()),
            }
        };
        let options = options.watched(&mut stop);
        let summary = solution.stress_summary(Member::Body, &strengths, options)?;
        assert!(!summary.finished && summary.layers.is_empty());
        assert_eq!(calls, last);
    }
    Ok(())
}
