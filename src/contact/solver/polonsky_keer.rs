//! The constrained conjugate gradient method of Polonsky and Keer, which Spinu et al. use.
//!
//! Polonsky & Keer, Wear 231 (1999) 206, doi:10.1016/S0043-1648(99)00113-1. Departures:
//!
//! - the mean gap over the contact is one of up to three multipliers, found together by least
//!   squares: force and moments are balanced in the same iteration;
//! - scaling p to the load becomes p ← [p (1 + Bμ)]₊, which restores force and moments;
//! - the iteration ends on complementarity and overlap, not on the change of pressure.

use super::conjugacy::Conjugacy;
use super::{Outcome, Solver, StopCriteria, Termination, Watch};
use crate::contact::problem::Problem;
use crate::contact::problem::constraint::NonNegative;
use crate::contact::problem::fields::{Fields, slice_mut};
use crate::grid::full_window;

/// Solves from the balanced pressure in `fields`, which becomes the solution.
pub(crate) fn solve(
    problem: &Problem,
    fields: &mut Fields,
    criteria: StopCriteria,
    watch: &mut Watch,
) -> Outcome {
    let freedoms = problem.freedoms;
    let Fields {
        pressure,
        displacement,
        window,
        ..
    } = fields;
    // All of the grid may come into contact.
    *window = full_window(problem.convolution.shape());
    let window = window.clone();
    let workspace = &mut problem.convolution.workspace();
    let (p, u) = (slice_mut(pressure), slice_mut(displacement));
    let cells = p.len();
    let mut g = vec![0.0; cells];
    let mut direction = vec![0.0; cells];
    let mut response = vec![0.0; cells];
    let no_gap = vec![0.0; cells];
    let mut conjugacy = Conjugacy::default();
    let mut work = 0.0;

    for iterations in 0.. {
        let (multipliers, quality) = problem.judge(p, &window, u, [0.0; 3], workspace);
        work += problem.convolution.work();
        problem.gap_into(u, multipliers, &mut g);
        let end = |termination| Outcome {
            solver: Solver::PolonskyKeer,
            termination,
            iterations,
            work,
            lambda: multipliers.lambda(),
        };
        if quality.meets(criteria.tolerance) {
            return end(Termination::Converged);
        }
        if watch(iterations, work, quality).is_break() {
            return end(Termination::Stopped);
        }
        if quality.overflows() || iterations == criteria.max_iterations {
            return end(Termination::IterationLimit);
        }

        // Where nothing touches yet, the cells that overlap are the contact.
        let empty = !p.iter().any(|&p| NonNegative.is_free(p));
        let in_contact = |p: f64, g: f64| NonNegative.is_free(p) || (empty && g < 0.0);
        let mut steepness = 0.0;
        for (&p, &g) in p.iter().zip(&g) {
            if in_contact(p, g) {
                steepness += g * g;
            }
        }
        let beta = conjugacy.beta(steepness, 0.0);
        for ((t, &p), &g) in direction.iter_mut().zip(&*p).zip(&g) {
            *t = if in_contact(p, g) { g + beta * *t } else { 0.0 };
        }

        problem.apply(&direction, &mut response, workspace);
        work += problem.convolution.work();
        let mean = problem.fit(p, &response, &no_gap);
        freedoms.for_each(mean, |k, b| response[k] -= b);
        let (mut slope, mut curvature) = (0.0, 0.0);
        for (k, &t) in direction.iter().enumerate() {
            if in_contact(p[k], g[k]) {
                slope += g[k] * t;
                curvature += response[k] * t;
            }
        }
        // A contact whose gap is exactly zero everywhere has only cells that join; their step is that of a
        // single cell.
        let step = if curvature > 0.0 {
            slope / curvature
        } else {
            1.0 / problem.self_influence()
        };

        let mut joined = false;
        for (k, p) in p.iter_mut().enumerate() {
            let inside = in_contact(*p, g[k]);
            if inside {
                *p = NonNegative.nearest(*p - step * direction[k]);
            }
            if !NonNegative.is_free(*p) && g[k] < 0.0 && problem.gap[k].is_finite() {
                joined |= !inside;
                *p = -step * g[k];
            }
        }
        if joined {
            conjugacy.restart();
        }
        problem.rebalance(p);
    }
    unreachable!("the loop ends by its limit")
}
