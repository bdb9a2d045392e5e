//! Steps along a search direction.
//!
//! A step on which cells leave is not the step that was planned, and its displacement takes a second
//! convolution. While cells leave, a step therefore takes its length from the periodic convolution, which
//! costs a quarter, and applies the exact convolution to the change that remains when cells have left and
//! balance is restored.

use std::ops::Range;

use super::arrays::Arrays;
use super::{Displacement, Preconditioned, Step};
use crate::compliance::convolution::Convolution;
use crate::contact::problem::Problem;
use crate::contact::problem::bounds::{clip, not_allowed};
use crate::numerics::parallel::{all, sum, update};

impl Preconditioned<'_> {
    /// A step of the pressure `p`, after the step `last`.
    pub(super) fn step(&mut self, p: &mut [f64], last: Step) -> Step {
        let exact = self.problem.convolution;
        if last != Step::Truncated {
            let slope = self.search_direction(p, exact);
            return self.exact_step(p, slope);
        }
        let slope = self.search_direction(p, &self.approximation.periodic);
        match self.step_with_losses(p, slope) {
            Step::Stalled => {
                let Arrays { direction, .. } = self.memory.arrays(p.len());
                exact.rows_in(direction, 0..exact.shape()[0], &mut self.workspace);
                self.exact_step(p, slope)
            }
            done => done,
        }
    }

    /// Finishes the application of `convolution` to the direction, whose rows it has; returns the product of
    /// response and direction.
    fn respond(&mut self, convolution: &Convolution) -> f64 {
        let Arrays { direction, response, .. } = self.memory.arrays(self.problem.gap.len());
        self.work += convolution.work();
        let rows = 0..convolution.shape()[0];
        let outwards = convolution.outwards(direction, rows, &mut self.workspace);
        let [curvature] =
            self.rows.blocks([direction], [response], |block, [direction], [response]| {
                outwards.rows(block.first, response);
                block.each([direction, response], [], |_, fields, []| {
                    sum(fields, |[direction, response]| [direction * response])
                })
            });
        curvature
    }

    /// A step of exact length. Where cells leave, the displacement is computed afresh.
    fn exact_step(&mut self, p: &mut [f64], slope: f64) -> Step {
        let (problem, freedoms) = (self.problem, self.problem.freedoms);
        let bounds = problem.bounds;
        let curvature = self.respond(problem.convolution);
        let Some(length) = best_length(slope, curvature).map(all) else {
            return Step::Stalled;
        };
        let Arrays { u, direction, response, .. } = self.memory.arrays(p.len());
        let (inputs, outputs) = ([&*direction, response, problem.gap], [&mut *p, u]);
        let fit = self.rows.each(inputs, outputs, |row, inputs, fields| {
            let limit = bounds.row(row.number);
            freedoms.fit_row(row, limit, inputs, fields, |[d, response, h, limit, _], [p, u]| {
                let trial = p + length * d;
                let (p, lost) = (clip(trial, limit), not_allowed(trial, limit));
                let u = u + length * response;
                ([p, u], [p, u + h, lost])
            })
        });
        let near = (&*u, self.lambda);
        let (done, factor) = balance(problem, p, near, fit.counted, fit.moments);
        if done == Step::Whole {
            self.displacement = Displacement::Fitted(fit);
            return done;
        }
        self.rows
            .each([], [&mut *p], |_, [], [p]| update([], [p], |[], [p]| ([all(factor) * p], [])));
        self.displace(p);
        done
    }

    /// A step of approximate length, with the exact displacement however many cells leave.
    /// [`Step::Stalled`], with the pressure unchanged up to rounding, where it would not descend.
    fn step_with_losses(&mut self, p: &mut [f64], slope: f64) -> Step {
        // Best length along the change, relative to the planned one. Outside this range so many cells have
        // left that the plan was worth little; beyond 2 the energy would rise. Chosen by trial.
        const AS_PLANNED: Range<f64> = 0.6..1.8;
        // Bounds of one change of the ratio of curvatures, and of the ratio itself; chosen by trial.
        const CHANGE_OF_RATIO: [f64; 2] = [0.8, 1.25];
        const RATIO: [f64; 2] = [0.5, 2.0];
        let (problem, freedoms) = (self.problem, self.problem.freedoms);
        let curvature = self.respond(&self.approximation.periodic) * self.curvature_ratio;
        let Some(length) = best_length(slope, curvature).map(all) else {
            return Step::Stalled;
        };
        let Arrays { u, direction, trial, r, response, .. } = self.memory.arrays(p.len());
        let (lost, moments) =
            self.rows.each([&*direction, p], [&mut *trial], |row, [d, p], [trial]| {
                let inputs = [d, p, problem.bounds.row(row.number)];
                let [lost] = update(inputs, [&mut *trial], |[d, p, limit], _| {
                    let trial = p + length * d;
                    ([clip(trial, limit)], [not_allowed(trial, limit)])
                });
                (lost, freedoms.moments_of(row, trial))
            });
        let (done, factor) = balance(problem, trial, (u, self.lambda), lost, moments);
        let (inwards, halves) = problem.convolution.inwards(&mut self.workspace);
        let outputs = ([&mut *p, &mut *trial], halves);
        self.rows.blocks([], outputs, |block, [], ([p, change], halves)| {
            block.each([], [p, &mut *change], |_, [], fields| {
                update([], fields, |[], [p, trial]| {
                    let trial = all(factor) * trial;
                    ([trial, trial - p], [])
                })
            });
            inwards.rows(change, halves);
        });
        let change = trial;
        self.work += problem.convolution.work();
        let rows = 0..problem.convolution.shape()[0];
        let convolution = problem.convolution;
        let outwards = convolution.outwards(change, rows, &mut self.workspace);
        let [slope, curvature] =
            self.rows.blocks([&*change, r], [response], |block, [change, r], [response]| {
                outwards.rows(block.first, response);
                block.each([change, r, response], [], |_, fields, []| {
                    sum(fields, |[change, r, response]| [change * r, change * response])
                })
            });
        // The best length along the change, and the part of the change that is taken back to reach it.
        let best = best_length(slope, curvature).unwrap_or(0.0);
        let back = if best < AS_PLANNED.start { 1.0 - best } else { 0.0 };
        if back > 0.0 {
            self.rows.each([&*change], [p], |_, [change], [p]| {
                update([change], [p], |[change], [p]| ([p - all(back) * change], []))
            });
        }
        if back >= 1.0 {
            return Step::Stalled;
        }
        let [least, most] = CHANGE_OF_RATIO;
        let ratio = self.curvature_ratio / best.clamp(least, most);
        self.curvature_ratio = ratio.clamp(RATIO[0], RATIO[1]);
        self.displacement = Displacement::Behind(1.0 - back);
        if AS_PLANNED.contains(&best) {
            done
        } else {
            // The next step is an exact one.
            Step::Whole
        }
    }
}

/// [`Step::Whole`] where a pressure of these `moments`, from which `lost` cells were clipped, is balanced.
/// Otherwise restores balance up to a factor on `p`, which is returned with [`Step::Truncated`]. The displacement and λ
/// before the step are `near`.
fn balance(
    problem: &Problem,
    p: &mut [f64],
    near: (&[f64], [f64; 3]),
    lost: f64,
    moments: [f64; 3],
) -> (Step, f64) {
    let freedoms = problem.freedoms;
    // A direction that lost cells since it was made is out of balance, too.
    if lost <= 0.0 && freedoms.on_target(moments) {
        return (Step::Whole, 1.0);
    }
    if problem.bounds.is_limited() {
        problem.rebalance_within(p, near.0, near.1);
        return (Step::Truncated, 1.0);
    }
    let factor = freedoms.to_load(moments[0]);
    let factor = factor.filter(|_| freedoms.only_force()).unwrap_or_else(|| {
        problem.rebalance(p);
        1.0
    });
    (Step::Truncated, factor)
}

/// The length of the step to the least energy; `None` where the energy does not fall.
fn best_length(slope: f64, curvature: f64) -> Option<f64> {
    let length = slope / curvature;
    (slope > 0.0 && curvature > 0.0 && length.is_finite()).then_some(length)
}
