//! Steps along a direction.
//!
//! A step that makes cells leave is not the step that was planned, so that its displacement takes a
//! second convolution. While cells leave, a step costs one: its length is taken from the periodic
//! convolution, which costs a fifth, and the exact one is applied to the change that remains
//! when cells have left and balance is restored.

use std::ops::Range;

use super::arrays::Arrays;
use super::{Preconditioned, Step};
use crate::contact::passes::{Row, add};
use crate::contact::sums::{Lanes, ONE, all, sum, update, where_positive};

impl Preconditioned<'_> {
    /// Moves `p` by `step` times the direction as far as it stays ≥ 0, having kept what it was where
    /// `keep` asks. Returns [`Step::Whole`] where it is balanced and none would be negative; else,
    /// with [`Step::Truncated`], the factor on `p` that is left of restoring balance.
    fn advance(&mut self, p: &mut [f64], step: f64, keep: bool) -> (Step, f64) {
        let freedoms = self.problem.freedoms;
        let Arrays {
            direction, before, ..
        } = self.memory.arrays(self.problem.gap.len());
        let moved = |d: Lanes, p: Lanes| {
            let moved = p + all(step) * d;
            (where_positive(moved, moved), where_positive(-moved, ONE))
        };
        let with_moments = |row: Row, truncated: f64, p: &[f64]| {
            let [f, fx, fy] = freedoms.moments_of(row, p);
            [truncated, f, fx, fy]
        };
        let [truncated, moments @ ..] = if keep {
            let outputs = [&mut *p, before];
            self.passes
                .each([direction], outputs, add, |row, [d], [p, before]| {
                    let [truncated] = update([d], [&mut *p, before], |[d], [p, _]| {
                        let (kept, lost) = moved(d, p);
                        ([kept, p], [lost])
                    });
                    with_moments(row, truncated, p)
                })
        } else {
            self.passes
                .each([direction], [&mut *p], add, |row, [d], [p]| {
                    let [truncated] = update([d], [&mut *p], |[d], [p]| {
                        let (kept, lost) = moved(d, p);
                        ([kept], [lost])
                    });
                    with_moments(row, truncated, p)
                })
        };
        // A direction that lost cells since it was made is out of balance, too.
        if truncated <= 0.0 && freedoms.on_target(moments) {
            return (Step::Whole, 1.0);
        }
        let factor = freedoms.to_load(moments[0]);
        let factor = factor.filter(|_| freedoms.only_force()).unwrap_or_else(|| {
            self.problem.rebalance(p);
            1.0
        });
        (Step::Truncated, factor)
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
        let (done, factor) = self.advance(p, length, false);
        if done == Step::Truncated {
            self.passes.each([], [&mut *p], add, |_, [], [p]| {
                update([], [p], |[], [p]| ([all(factor) * p], []))
            });
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
        let (done, factor) = self.advance(p, slope / curvature, true);
        let Arrays {
            r,
            z: change,
            response,
            before,
            ..
        } = self.memory.arrays(self.problem.gap.len());
        let outputs = [&mut *p, &mut *change];
        self.passes
            .each([&*before], outputs, add, |_, [before], outputs| {
                update([before], outputs, |[before], [p, _]| {
                    let p = all(factor) * p;
                    ([p, p - before], [])
                })
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
