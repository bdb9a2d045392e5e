//! The constrained conjugate gradient method of Polonsky and Keer, which Spinu et al. use.
//!
//! Polonsky & Keer, Wear 231 (1999) 206, doi:10.1016/S0043-1648(99)00113-1. Departures:
//!
//! - the mean gap over the contact is one of up to three multipliers, found together by least
//!   squares: force and moments are balanced in the same iteration;
//! - scaling p to the load becomes p ← [p (1 + Bμ)]₊, which restores force and moments;
//! - a pressure at the hardness leaves it where the gap opens;
//! - the iteration ends on complementarity and overlap, not on the change of pressure;
//! - where a direction does not descend, as after a change of the contact it may not, the gradient takes
//!   its place.

use super::linear_cg::Conjugacy;
use super::{Outcome, Solver, StopCriteria, Tally, Termination};
use crate::contact::problem::fields::{Fields, slice_mut};
use crate::contact::problem::{INDEFINITE, Problem};
use crate::error::Result;
use crate::model::grid::full_window;
use crate::numerics::parallel::dot;

/// Energy below 0 that may be rounding: of the displacement, some 1e-15 of that of one cell under the sum of
/// all magnitudes.
const ROUNDING: f64 = 1e-12;

/// Solves from the balanced pressure and the multipliers in `fields`, which become the solution, with its
/// quality.
///
/// # Errors
/// [`INDEFINITE`].
pub(crate) fn solve(
    problem: &Problem,
    fields: &mut Fields,
    criteria: StopCriteria,
    tally: &mut Tally,
) -> Result<Outcome> {
    let freedoms = problem.freedoms;
    let Fields { pressure, displacement, window, multipliers, quality } = fields;
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

    loop {
        let mut near = multipliers.lambda();
        let (mut found, mut now) = problem.judge(p, &window, u, near, workspace);
        tally.work += problem.convolution.work();
        // A tilt that the contact does not determine is 0, and not what it was before.
        let stale = [1, 2].map(|k| near[k].abs() > 0.0 && found.change[k].abs() <= 0.0);
        if stale[0] || stale[1] {
            for k in [1, 2] {
                near[k] *= f64::from(!stale[k - 1]);
            }
            (found, now) = problem.judge(p, &window, u, near, workspace);
            tally.work += problem.convolution.work();
        }
        if now.meets(criteria.tolerance) {
            // Gaps are exact only near the multipliers that they are counted from.
            (found, now) = problem.judge(p, &window, u, found.lambda(), workspace);
            tally.work += problem.convolution.work();
        }
        (*multipliers, *quality) = (found, Some(now));
        problem.gap_into(u, found, &mut g);
        let end = |termination| {
            Ok(Outcome { solver: Solver::PolonskyKeer, termination, lambda: found.lambda() })
        };
        if now.meets(criteria.tolerance) {
            return end(Termination::Converged);
        }
        if tally.tell(now).is_break() {
            return end(Termination::Stopped);
        }
        if now.overflows() || tally.iterations >= criteria.max_iterations {
            return end(Termination::IterationLimit);
        }

        // Where nothing touches yet, the cells that overlap are the contact.
        let bounds = problem.bounds;
        let empty = !p.iter().enumerate().any(|(k, &p)| bounds.is_free(k, p));
        let in_contact = |k: usize, p: f64, g: f64| {
            bounds.is_free(k, p) || (empty && bounds.wrong(k, p, g) > 0.0)
        };
        let mut steepness = 0.0;
        for (k, (&p, &g)) in p.iter().zip(&g).enumerate() {
            if in_contact(k, p, g) {
                steepness += g * g;
            }
        }
        let mut beta = conjugacy.beta(steepness, 0.0);
        // The direction g + βt on the contact, and the step to the least energy along it.
        let step = loop {
            let (mut slope, mut size, mut energy) = (0.0, 0.0_f64, 0.0);
            for (k, ((t, &p), &g)) in direction.iter_mut().zip(&*p).zip(&g).enumerate() {
                *t = if in_contact(k, p, g) {
                    let next = g + beta * *t;
                    slope += g * next;
                    size += next.abs();
                    next
                } else {
                    0.0
                };
            }
            if slope > 0.0 || beta <= 0.0 {
                problem.apply(&direction, &mut response, workspace);
                tally.work += problem.convolution.work();
                energy = dot(&direction, &response);
                let mean = problem.fit(p, &response, &no_gap);
                freedoms.for_each(mean, |k, b| response[k] -= b);
                let curvature = dot(&direction, &response);
                if curvature > 0.0 {
                    break slope / curvature;
                }
            }
            if beta <= 0.0 {
                let one_cell = problem.self_influence();
                if one_cell <= 0.0 || energy < -ROUNDING * one_cell * size * size {
                    return Err(INDEFINITE);
                }
                // A contact whose gap is exactly zero everywhere has only cells that join; their step is
                // that of a single cell.
                break 1.0 / one_cell;
            }
            conjugacy.restart();
            conjugacy.beta(steepness, 0.0);
            beta = 0.0;
        };

        let mut joined = false;
        for (k, p) in p.iter_mut().enumerate() {
            let inside = in_contact(k, *p, g[k]);
            if inside {
                *p = bounds.nearest(k, *p - step * direction[k]);
            }
            if bounds.wrong(k, *p, g[k]) > 0.0 && problem.gap[k].is_finite() {
                joined |= !inside;
                *p = bounds.nearest(k, *p - step * g[k]);
            }
        }
        if joined {
            conjugacy.restart();
        }
        if bounds.is_limited() {
            problem.rebalance_within(p, u, found.lambda());
        } else {
            problem.rebalance(p);
        }
        tally.iterations += 1;
    }
}
