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

use super::{Outcome, Solver, StopCriteria, Tally, Termination};
use crate::compliance::convolution::Workspace;
use crate::contact::problem::{Multipliers, Problem, Quality, SolutionFields};
use crate::error::{Error, Result};
use crate::model::grid::full_window;
use crate::numerics::layout::slice_mut;
use crate::numerics::linear_cg::Conjugacy;
use crate::numerics::parallel::dot;

/// Energy below 0 that may be rounding: of the displacement, some 1e-15 of that of one cell under the sum of
/// all magnitudes.
const ROUNDING: f64 = 1e-12;

/// Solves from the balanced pressure and the multipliers in `fields`, which become the solution, with its
/// quality.
///
/// # Errors
/// [`Error::Indefinite`].
pub(crate) fn solve(
    problem: &Problem,
    fields: &mut SolutionFields,
    criteria: StopCriteria,
    tally: &mut Tally,
) -> Result<Outcome> {
    // All of the grid may come into contact.
    fields.window = full_window(problem.convolution.shape());
    let workspace = &mut problem.convolution.workspace();
    let cells = fields.pressure.len();
    let mut g = vec![0.0; cells];
    let mut search = Search {
        direction: vec![0.0; cells],
        response: vec![0.0; cells],
        no_gap: vec![0.0; cells],
        conjugacy: Conjugacy::default(),
    };
    loop {
        let (multipliers, now) = assess(problem, fields, criteria.tolerance, workspace, tally);
        let SolutionFields { pressure, displacement, .. } = fields;
        let (p, u) = (slice_mut(pressure), slice_mut(displacement));
        problem.gap_into(u, multipliers, &mut g);
        let end = |termination| {
            Ok(Outcome { solver: Solver::PolonskyKeer, termination, lambda: multipliers.lambda() })
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
        let inside = contact(problem, p, &g);
        let step = search.turn(problem, &inside, &g, p, workspace, tally)?;
        if advance(problem, &inside, &g, &search.direction, step, p) {
            search.conjugacy.restart();
        }
        problem.rebalance(p, u, multipliers.lambda());
        tally.iterations += 1;
    }
}

/// Displacement, multipliers and quality of the pressure.
fn assess(
    problem: &Problem,
    fields: &mut SolutionFields,
    tolerance: f64,
    workspace: &mut Workspace,
    tally: &mut Tally,
) -> (Multipliers, Quality) {
    let SolutionFields { pressure, displacement, window, multipliers, quality } = fields;
    let (p, u) = (slice_mut(pressure), slice_mut(displacement));
    let mut judge = |near| {
        tally.work += problem.convolution.work();
        problem.judge(p, window, u, near, workspace)
    };
    let mut near = multipliers.lambda();
    let (mut new_multipliers, mut now) = judge(near);
    // A tilt that the contact does not determine is 0, and not what it was before.
    let stale = [1, 2].map(|k| near[k].abs() > 0.0 && new_multipliers.change[k].abs() <= 0.0);
    if stale[0] || stale[1] {
        for k in [1, 2] {
            near[k] *= f64::from(!stale[k - 1]);
        }
        (new_multipliers, now) = judge(near);
    }
    if now.meets(tolerance) {
        // Gaps are exact only near the multipliers that they are counted from.
        (new_multipliers, now) = judge(new_multipliers.lambda());
    }
    (*multipliers, *quality) = (new_multipliers, Some(now));
    (new_multipliers, now)
}

/// Whether each cell is in the contact. Where nothing touches yet, the cells that overlap are the contact.
fn contact(problem: &Problem, p: &[f64], g: &[f64]) -> Vec<bool> {
    let bounds = problem.bounds;
    let free: Vec<bool> = p.iter().enumerate().map(|(k, &p)| bounds.is_free(k, p)).collect();
    if free.contains(&true) {
        return free;
    }
    (0..p.len()).map(|k| bounds.wrong(k, p[k], g[k]) > 0.0).collect()
}

/// Direction of the search, the displacement that it makes, and its recurrence.
struct Search {
    direction: Vec<f64>,
    response: Vec<f64>,
    /// Zeros.
    no_gap: Vec<f64>,
    conjugacy: Conjugacy,
}

impl Search {
    /// Turns the direction to g + βt on the contact; returns the step to the least energy along it.
    fn turn(
        &mut self,
        problem: &Problem,
        inside: &[bool],
        g: &[f64],
        p: &[f64],
        workspace: &mut Workspace,
        tally: &mut Tally,
    ) -> Result<f64> {
        let Self { direction, response, no_gap, conjugacy } = self;
        let steepness: f64 =
            g.iter().zip(inside).map(|(g, inside)| if *inside { g * g } else { 0.0 }).sum();
        let mut beta = conjugacy.beta(steepness, 0.0);
        loop {
            let (mut slope, mut size, mut energy) = (0.0, 0.0_f64, 0.0);
            for ((t, &inside), &g) in direction.iter_mut().zip(inside).zip(g) {
                // Outside the contact the gap may be infinite.
                if !inside {
                    *t = 0.0;
                    continue;
                }
                *t = g + beta * *t;
                slope += g * *t;
                size += t.abs();
            }
            if slope > 0.0 || beta <= 0.0 {
                problem.apply(direction, response, workspace);
                tally.work += problem.convolution.work();
                energy = dot(direction, response);
                let mean = problem.fit(p, response, no_gap);
                problem.freedoms.for_each(mean, |k, b| response[k] -= b);
                let curvature = dot(direction, response);
                if curvature > 0.0 {
                    return Ok(slope / curvature);
                }
            }
            if beta <= 0.0 {
                let one_cell = problem.self_influence();
                if one_cell <= 0.0 || energy < -ROUNDING * one_cell * size * size {
                    return Err(Error::Indefinite);
                }
                // A contact whose gap is exactly zero everywhere has only cells that join; their step is
                // that of a single cell.
                return Ok(1.0 / one_cell);
            }
            conjugacy.restart();
            conjugacy.beta(steepness, 0.0);
            beta = 0.0;
        }
    }
}

/// Moves the pressure by a step along the direction, within its bounds; cells outside the contact whose gap has the
/// wrong sign join it. Returns whether any did.
fn advance(
    problem: &Problem,
    inside: &[bool],
    g: &[f64],
    direction: &[f64],
    step: f64,
    p: &mut [f64],
) -> bool {
    let bounds = problem.bounds;
    let mut joined = false;
    for (k, p) in p.iter_mut().enumerate() {
        if inside[k] {
            *p = bounds.nearest(k, *p - step * direction[k]);
        }
        if bounds.wrong(k, *p, g[k]) > 0.0 && problem.gap[k].is_finite() {
            joined |= !inside[k];
            *p = bounds.nearest(k, *p - step * g[k]);
        }
    }
    joined
}
