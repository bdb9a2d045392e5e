//! The constrained conjugate gradient method of the paper.
//!
//! Polonsky & Keer, Wear 231 (1999) 206, doi:10.1016/S0043-1648(99)00113-1. Departures:
//!
//! - the mean gap over the contact is one of up to three multipliers, found together by least
//!   squares: force and moments are balanced in the same iteration;
//! - scaling p to the load becomes p ← [p (1 + Bμ)]₊, which restores force and moments;
//! - it ends on complementarity and overlap, not on the change of pressure.

use crate::contact::cascade::patch::whole;
use crate::contact::problem::{Limits, Outcome, Problem, Termination, Watch};
use crate::contact::solution::fields::{Fields, slice_mut};

/// Solves from the balanced pressure `p`, which becomes the solution.
pub(crate) fn solve(
    problem: &Problem,
    fields: &mut Fields,
    limits: Limits,
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
    *window = whole(problem.convolution.shape());
    let window = window.clone();
    let workspace = &mut problem.convolution.workspace();
    let (p, u) = (slice_mut(pressure), slice_mut(displacement));
    let cells = p.len();
    let mut g = vec![0.0; cells];
    let mut direction = vec![0.0; cells];
    let mut response = vec![0.0; cells];
    let none = vec![0.0; cells];
    let mut steepness_before = 1.0;
    let mut conjugate = false;
    let mut work = 0.0;

    for iterations in 0.. {
        let (motion, quality) = problem.judge(p, &window, u, [0.0; 3], workspace);
        work += problem.convolution.work();
        problem.gap_into(u, motion, &mut g);
        let end = |termination| Outcome {
            termination,
            iterations,
            work,
            lambda: motion.lambda(),
        };
        if quality.meets(limits.tolerance) {
            return end(Termination::Converged);
        }
        if watch(iterations, work, quality) {
            return end(Termination::Stopped);
        }
        if quality.overflows() || iterations == limits.max_iterations {
            return end(Termination::IterationLimit);
        }

        // Where nothing touches yet, the cells that overlap are the contact.
        let empty = p.iter().all(|&p| p == 0.0);
        let in_contact = |p: f64, g: f64| p > 0.0 || (empty && g < 0.0);
        let mut steepness = 0.0;
        for (&p, &g) in p.iter().zip(&g) {
            if in_contact(p, g) {
                steepness += g * g;
            }
        }
        let beta = if conjugate {
            steepness / steepness_before
        } else {
            0.0
        };
        steepness_before = steepness;
        for ((t, &p), &g) in direction.iter_mut().zip(&*p).zip(&g) {
            *t = if in_contact(p, g) { g + beta * *t } else { 0.0 };
        }

        problem.apply(&direction, &mut response, workspace);
        work += problem.convolution.work();
        let mean = problem.fit(p, &response, &none);
        freedoms.for_each(mean, |k, b| response[k] -= b);
        let (mut slope, mut curvature) = (0.0, 0.0);
        for (k, &t) in direction.iter().enumerate() {
            if in_contact(p[k], g[k]) {
                slope += g[k] * t;
                curvature += response[k] * t;
            }
        }
        // Where the contact has a gap of exactly zero there is nothing left but cells that join;
        // their step is that of a single cell.
        let step = if curvature > 0.0 {
            slope / curvature
        } else {
            1.0 / problem.self_influence()
        };

        let mut joined = false;
        for (k, p) in p.iter_mut().enumerate() {
            let inside = in_contact(*p, g[k]);
            if inside {
                *p = (*p - step * direction[k]).max(0.0);
            }
            if *p == 0.0 && g[k] < 0.0 && problem.gap[k].is_finite() {
                joined |= !inside;
                *p = -step * g[k];
            }
        }
        conjugate = !joined;
        problem.rebalance(p);
    }
    unreachable!("the loop ends by its limit")
}
