//! Steps along a direction.
//!
//! A step that makes cells leave is not the step that was planned, so that its displacement takes a
//! second convolution. While cells leave, a step costs one: its length is taken from the periodic
//! convolution, which costs a fifth, and the exact one is applied to the change that remains
//! when cells have left and balance is restored.

use std::ops::Range;

use super::arrays::Arrays;
use super::{Preconditioned, Step};
use crate::contact::passes::add;
use crate::contact::sums::{ONE, all, sum, update, where_positive};

impl Preconditioned<'_> {
    /// Moves `p` by `step` times the direction as far as it stays ≥ 0, and restores balance. Returns
    /// [`Step::Whole`] where neither was needed.
    fn advance(&mut self, p: &mut [f64], step: f64) -> Step {
        let freedoms = self.problem.freedoms;
        let Arrays {
            direction, before, ..
        } = self.memory.arrays(self.problem.gap.len());
        let [truncated, moments @ ..] = self.passes.each(
            [direction],
            [&mut *p, before],
            add,
            |row, [direction], [p, before]| {
                let [truncated] = update([direction], [&mut *p, before], |[d], [p, _]| {
                    let moved = p + all(step) * d;
                    let kept = where_positive(moved, moved);
                    ([kept, p], [where_positive(-moved, ONE)])
                });
                let [f, fx, fy] = freedoms.moments_of(row, p);
                [truncated, f, fx, fy]
            },
        );
        // A direction that lost cells since it was made is out of balance, too.
        if truncated > 0.0 || !freedoms.on_target(moments) {
            self.problem.rebalance(p);
            return Step::Truncated;
        }
        Step::Whole
    }

    /// A step of exact length. Where cells leave, the displacement is computed afresh.
    pub(super) fn step(&mut self, p: &mut [f64], slope: f64) -> Step {
        let problem = self.problem;
        let Arrays {
            direction,
            response,
            ..
        } = self.memory.arrays(self.problem.gap.len());
        problem.apply(direction, response, &mut self.workspace);
        self.work += problem.convolution.work();
        let curvature = self.passes.dot(response, direction);
        if !(curvature > 0.0 && slope > 0.0) {
            return Step::None;
        }
        let length = slope / curvature;
        let done = self.advance(p, length);
        if done == Step::Truncated {
            self.displace(p);
        } else {
            self.pending = length;
        }
        done
    }

    /// A step of approximate length, exactly displaced however many cells leave. None,
    /// with the pressure as it was, where it would not descend.
    pub(super) fn step_with_losses(&mut self, p: &mut [f64], slope: f64) -> Step {
        // Where the best length along the change is further from the planned one, so many cells have
        // left that the plan was worth little. Beyond twice the best length the energy would rise.
        const AS_PLANNED: Range<f64> = 0.6..1.8;
        let periodic = &self.approximation.periodic;
        let Arrays {
            direction,
            response,
            ..
        } = self.memory.arrays(self.problem.gap.len());
        periodic.apply_slices(direction, response, &mut self.workspace);
        self.work += periodic.work();
        let curvature = self.passes.dot(response, direction);
        let curvature = curvature * self.curvature_ratio;
        if !(curvature > 0.0 && slope > 0.0) {
            return Step::None;
        }
        let done = self.advance(p, slope / curvature);
        let Arrays {
            r,
            z: change,
            response,
            before,
            ..
        } = self.memory.arrays(self.problem.gap.len());
        self.passes
            .each([p, before], [change], add, |_, inputs, [change]| {
                update(inputs, [change], |[p, before], _| ([p - before], []))
            });
        let problem = self.problem;
        problem.apply(change, response, &mut self.workspace);
        self.work += problem.convolution.work();
        // The best length along the change.
        let [slope, curvature] =
            self.passes
                .each([change, r, response], [], add, |_, inputs, []| {
                    sum(inputs, |[change, r, response]| {
                        [change * r, change * response]
                    })
                });
        let best = slope / curvature;
        if !(best > 0.0 && best.is_finite()) {
            p.copy_from_slice(before);
            return Step::None;
        }
        self.curvature_ratio = (self.curvature_ratio / best.clamp(0.8, 1.25)).clamp(0.5, 2.0);
        self.pending = if best < AS_PLANNED.start { best } else { 1.0 };
        if best < AS_PLANNED.start {
            for ((p, before), change) in p.iter_mut().zip(&*before).zip(&*change) {
                *p = before + best * change;
            }
        }
        if AS_PLANNED.contains(&best) {
            done
        } else {
            // The next step is an exact one.
            Step::Whole
        }
    }
}
