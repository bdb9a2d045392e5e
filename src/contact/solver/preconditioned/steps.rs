//! Steps along a direction.
//!
//! A step that makes cells leave is not the step that was planned, so that its displacement takes a
//! second convolution. While cells leave, a step costs one: its length is taken from the periodic
//! convolution, which costs a fifth, and the exact one is applied to the change that remains
//! when cells have left and balance is restored.

use std::ops::Range;

use super::arrays::Arrays;
use super::{Preconditioned, Step};
use crate::contact::problem::Problem;
use crate::convolution::Convolution;
use crate::parallel::add;
use crate::parallel::{Lanes, ONE, all, sum, update, where_positive};

impl Preconditioned<'_> {
    /// A step of `p`, after one that was the `last`.
    pub(super) fn step(&mut self, p: &mut [f64], last: Step) -> Step {
        let exact = self.problem.convolution;
        if last != Step::Truncated {
            let slope = self.direct(exact);
            return self.exact_step(p, slope);
        }
        let slope = self.direct(&self.approximation.periodic);
        match self.step_with_losses(p, slope) {
            Step::None => {
                let Arrays { direction, .. } = self.memory.arrays(self.problem.gap.len());
                exact.rows_in(direction, 0..exact.shape()[0], &mut self.workspace);
                self.exact_step(p, slope)
            }
            done => done,
        }
    }

    /// Applies `convolution`, which has the rows of the direction; returns what that gives times the
    /// direction.
    fn respond(&mut self, convolution: &Convolution) -> f64 {
        let Arrays {
            direction,
            response,
            ..
        } = self.memory.arrays(self.problem.gap.len());
        self.work += convolution.work();
        let rows = 0..convolution.shape()[0];
        let outwards = convolution.outwards(rows, &mut self.workspace);
        let [curvature] = self.passes.parts(
            [direction],
            [response],
            add,
            |part, [direction], [response]| {
                outwards.rows(part.first, response);
                part.each([direction, response], [], add, |_, fields, []| {
                    sum(fields, |[direction, response]| [direction * response])
                })
            },
        );
        curvature
    }

    /// A step of exact length. Where cells leave, the displacement is computed afresh.
    fn exact_step(&mut self, p: &mut [f64], slope: f64) -> Step {
        let (problem, freedoms) = (self.problem, self.problem.freedoms);
        let curvature = self.respond(problem.convolution);
        let Some(length) = best_length(slope, curvature).map(all) else {
            return Step::None;
        };
        let Arrays {
            u,
            direction,
            response,
            ..
        } = self.memory.arrays(problem.gap.len());
        let (inputs, outputs) = ([&*direction, response, problem.gap], [&mut *p, u]);
        let fit = self
            .passes
            .each(inputs, outputs, add, |row, inputs, fields| {
                freedoms.fit_of(row, inputs, fields, |[d, response, h, _], [p, u]| {
                    let (p, lost) = moved(p, length * d);
                    let u = u + length * response;
                    ([p, u], [p, u + h, lost])
                })
            });
        let [lost, f, fx, fy, ..] = fit;
        let (done, factor) = balanced(problem, p, lost, [f, fx, fy]);
        if done == Step::Whole {
            self.fit = Some(fit);
            return done;
        }
        self.passes.each([], [&mut *p], add, |_, [], [p]| {
            update([], [p], |[], [p]| ([all(factor) * p], []))
        });
        self.displace(p);
        done
    }

    /// A step of approximate length, exactly displaced however many cells leave. None,
    /// with the pressure as it was but for rounding, where it would not descend.
    fn step_with_losses(&mut self, p: &mut [f64], slope: f64) -> Step {
        // Where the best length along the change is further from the planned one, so many cells have
        // left that the plan was worth little. Beyond twice the best length the energy would rise.
        const AS_PLANNED: Range<f64> = 0.6..1.8;
        let (problem, freedoms) = (self.problem, self.problem.freedoms);
        let curvature = self.respond(&self.approximation.periodic) * self.curvature_ratio;
        let Some(length) = best_length(slope, curvature).map(all) else {
            return Step::None;
        };
        let Arrays {
            direction, z: next, ..
        } = self.memory.arrays(problem.gap.len());
        let inputs = [&*direction, p];
        let sums = self
            .passes
            .each(inputs, [next], add, |row, [d, p], [next]| {
                let [lost] = update([d, p], [&mut *next], |[d, p], _| {
                    let (next, lost) = moved(p, length * d);
                    ([next], [lost])
                });
                let [f, fx, fy] = freedoms.moments_of(row, next);
                [lost, f, fx, fy]
            });
        let [lost, moments @ ..] = sums;
        let (done, factor) = balanced(problem, next, lost, moments);
        let Arrays {
            r,
            z: change,
            response,
            ..
        } = self.memory.arrays(problem.gap.len());
        let (inwards, rows) = problem.convolution.inwards(&mut self.workspace);
        let outputs = ([&mut *p, &mut *change], rows);
        self.passes
            .parts([], outputs, add, |part, [], ([p, change], halves)| {
                let fields = [p, &mut *change];
                let sums = part.each([], fields, add, |_, [], fields| {
                    update([], fields, |[], [p, next]| {
                        let next = all(factor) * next;
                        ([next, next - p], [])
                    })
                });
                inwards.rows(change, halves);
                sums
            });
        self.work += problem.convolution.work();
        let rows = 0..problem.convolution.shape()[0];
        let outwards = problem.convolution.outwards(rows, &mut self.workspace);
        // The best length along the change.
        let [slope, curvature] = self.passes.parts(
            [&*change, r],
            [response],
            add,
            |part, [change, r], [response]| {
                outwards.rows(part.first, response);
                part.each([change, r, response], [], add, |_, fields, []| {
                    sum(fields, |[change, r, response]| {
                        [change * r, change * response]
                    })
                })
            },
        );
        let best = best_length(slope, curvature).unwrap_or(0.0);
        let back = if best < AS_PLANNED.start {
            1.0 - best
        } else {
            0.0
        };
        if back > 0.0 {
            self.passes.each([&*change], [p], add, |_, [change], [p]| {
                update([change], [p], |[change], [p]| {
                    ([p - all(back) * change], [])
                })
            });
        }
        if back >= 1.0 {
            return Step::None;
        }
        self.curvature_ratio = (self.curvature_ratio / best.clamp(0.8, 1.25)).clamp(0.5, 2.0);
        self.pending = 1.0 - back;
        if AS_PLANNED.contains(&best) {
            done
        } else {
            // The next step is an exact one.
            Step::Whole
        }
    }
}

/// [`Step::Whole`] where a pressure of these `moments`, of which so many cells were `lost`, is balanced; else
/// balance is restored, but for the factor on `p` that is returned with [`Step::Truncated`].
fn balanced(problem: &Problem, p: &mut [f64], lost: f64, moments: [f64; 3]) -> (Step, f64) {
    let freedoms = problem.freedoms;
    // A direction that lost cells since it was made is out of balance, too.
    if lost <= 0.0 && freedoms.on_target(moments) {
        return (Step::Whole, 1.0);
    }
    let factor = freedoms.to_load(moments[0]);
    let factor = factor.filter(|_| freedoms.only_force()).unwrap_or_else(|| {
        problem.rebalance(p);
        1.0
    });
    (Step::Truncated, factor)
}

/// The best length of a step along which the energy falls with this slope. None where it does not.
fn best_length(slope: f64, curvature: f64) -> Option<f64> {
    let length = slope / curvature;
    (slope > 0.0 && curvature > 0.0 && length.is_finite()).then_some(length)
}

/// A pressure moved as far as it stays ≥ 0; and 1 where it would not, 0 elsewhere.
fn moved(p: Lanes, change: Lanes) -> (Lanes, Lanes) {
    let moved = p + change;
    (where_positive(moved, moved), where_positive(-moved, ONE))
}
