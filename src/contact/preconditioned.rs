//! Preconditioned conjugate gradients, deflated by the loaded freedoms.
//!
//! On the contact C = {p > 0} the gap must vanish: K p = Bλ − h. The residual is preconditioned by
//! an approximate inverse of the convolution, and made orthogonal to the loaded freedoms, so that
//! force and moments stay balanced. Cells leave C when their pressure turns negative, and join it
//! when they overlap; neither restarts the iteration (Vollebregt, J. Optim. Theory Appl. 162
//! (2014) 931, doi:10.1007/s10957-013-0499-x, restarts it when cells join). FFT preconditioner and
//! deflation: Vollebregt, J. Comput. Phys. 257 (2014) 333, doi:10.1016/j.jcp.2013.10.005.
//!
//! Passes over arrays would take as long as the transforms, were each operation a pass of its own:
//! those that can share a pass do.

mod arrays;
mod steps;

use super::direct;
use super::passes::{Passes, add};
use super::problem::{
    Limits, Multipliers, Outcome, Problem, Quality, Termination, Watch, join, overlap_of,
};
use super::sums::{ONE, ZERO, all, dot, update, where_member, where_positive};
use crate::convolution::{Convolution, Workspace};
use crate::pool::Lease;
use arrays::Arrays;
pub(super) use arrays::Memory;

/// A convolution and what approximates it.
pub(super) struct Approximation {
    /// Its inverse.
    pub(super) inverse: Convolution,
    /// Itself.
    pub(super) periodic: Convolution,
}

/// The iteration of one problem.
pub(super) struct Preconditioned<'a> {
    problem: &'a Problem<'a>,
    approximation: &'a Approximation,
    passes: Passes<'a>,
    workspace: Workspace,
    memory: Lease<Memory>,
    /// Part of the response that is not yet in the displacement.
    pending: f64,
    /// Whether the contact has changed since the images of the freedoms were made, or last seen.
    changed: bool,
    /// Whether the images are those of another contact.
    stale: bool,
    /// Whether the next direction is conjugate to the last.
    conjugate: bool,
    /// r · z of the last iteration.
    descent: f64,
    /// Curvature of the exact convolution over that of the periodic one, as last seen.
    curvature_ratio: f64,
    pub(super) work: f64,
}

/// Iterations after which a contact of a few cells is left to [`direct`]; most have converged by then.
const PATIENCE: usize = 20;

/// What became of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    /// As planned.
    Whole,
    /// Cells left on the way.
    Truncated,
    /// None: nothing descends any more, and the pressure is what it was.
    None,
}

impl<'a> Preconditioned<'a> {
    pub(super) fn new(
        problem: &'a Problem<'a>,
        approximation: &'a Approximation,
        memory: Lease<Memory>,
    ) -> Self {
        Self {
            problem,
            approximation,
            passes: problem.passes(),
            workspace: problem.convolution.workspace(),
            memory,
            pending: 0.0,
            changed: false,
            stale: false,
            conjugate: false,
            descent: 0.0,
            curvature_ratio: 1.0,
            work: 0.0,
        }
    }

    /// Solves from the balanced pressure `p`, which becomes the solution, or may end with
    /// [`Termination::IterationLimit`] early where [`direct`] can go on. Its displacement is the sum
    /// of those of the steps: whoever needs it computes it afresh.
    pub(super) fn solve(&mut self, p: &mut [f64], limits: Limits, watch: &mut Watch) -> Outcome {
        let mut last = Step::Truncated;
        self.start(p);
        for iterations in 0.. {
            let (lambda, quality) = self.assess(p);
            let work = self.work;
            let end = |termination| Outcome {
                termination,
                iterations,
                work,
                lambda,
            };
            if quality.meets(limits.tolerance) {
                return end(Termination::Converged);
            }
            if watch(iterations, self.work, quality) {
                return end(Termination::Stopped);
            }
            if iterations == limits.max_iterations || (iterations >= PATIENCE && direct::few(p)) {
                return end(Termination::IterationLimit);
            }
            let slope = self.direct();
            last = match last {
                Step::Truncated => match self.step_with_losses(p, slope) {
                    Step::None => self.step(p, slope),
                    done => done,
                },
                _ => self.step(p, slope),
            };
            if last == Step::None {
                return end(Termination::IterationLimit);
            }
        }
        unreachable!("the loop ends by its limit")
    }

    /// Takes the cells with a pressure for the contact.
    fn start(&mut self, p: &[f64]) {
        let Arrays { r, .. } = self.memory.arrays(self.problem.gap.len());
        self.passes.each([p], [r], add, |_, [p], [r]| {
            update([p], [r], |[p], _| ([where_positive(p, ONE)], []))
        });
        self.invert_freedoms();
        self.displace(p);
    }

    /// Applies the inverse to the loaded freedoms, as they are on the contact.
    fn invert_freedoms(&mut self) {
        let inverse = &self.approximation.inverse;
        let Arrays { r, z, images, .. } = self.memory.arrays(self.problem.gap.len());
        let loaded = self.problem.freedoms.loaded;
        for (freedom, image) in images.into_iter().enumerate().filter(|(k, _)| loaded[*k]) {
            self.passes.each([r], [z], add, |row, [r], [z]| {
                update([r, row.y], [z], |[r, y], _| {
                    ([where_member(r, [ONE, all(row.x), y][freedom])], [])
                })
            });
            inverse.apply_slices(z, image, &mut self.workspace);
            self.work += inverse.work();
        }
    }

    /// u = K p
    fn displace(&mut self, p: &[f64]) {
        let Arrays { u, .. } = self.memory.arrays(self.problem.gap.len());
        self.problem.apply(p, u, &mut self.workspace);
        self.work += self.problem.convolution.work();
        self.pending = 0.0;
    }

    /// The multipliers and how good the pressure is; and the residual on the contact, which cells
    /// without a pressure have left, and cells that overlap join.
    fn assess(&mut self, p: &[f64]) -> ([f64; 3], Quality) {
        // Where more than one cell in so many joins, the directions so far say little.
        const MANY: f64 = 10.0;
        let (problem, freedoms) = (self.problem, self.problem.freedoms);
        self.memory.keep_residual();
        let Arrays {
            u,
            r,
            r_before,
            response,
            ..
        } = self.memory.arrays(self.problem.gap.len());
        let pending = all(std::mem::take(&mut self.pending));
        let fit = self
            .passes
            .each([p, problem.gap, response], [u], add, |row, inputs, [u]| {
                let [p, h, response] = inputs;
                update([response], [&mut *u], |[response], [u]| {
                    ([u + where_positive(pending, pending * response)], [])
                });
                freedoms.fit_of(row, [p, u, h], [0.0; 3])
            });
        let motion = Multipliers {
            change: freedoms.fitted(fit),
            ..Multipliers::default()
        };
        let sums = self.passes.each(
            [p, u, problem.gap, r_before],
            [r],
            join,
            |row, [p, u, h, before], [r]| {
                motion.gap(row, [u, h], r);
                let [deepest, most] = overlap_of([u, r]);
                let [a, b, c, d, e] = problem.carried_of(row, [p, u, r]);
                let [left, joined, members] = update([p, before], [r], |[p, before], [g]| {
                    let pressed = where_positive(p, ONE);
                    let inside = pressed.simd_gt(ZERO) | g.simd_lt(ZERO);
                    let now = inside & ONE;
                    let before = where_member(before, ONE);
                    // A gap of 0 is told from a cell outside.
                    (
                        [inside & (all(f64::MIN_POSITIVE) - g)],
                        [(pressed - before).abs(), now - pressed, pressed],
                    )
                });
                [deepest, most, a, b, c, d, e, left, joined, members]
            },
        );
        let [quality @ .., left, joined, members] = sums;
        if MANY * joined > members {
            self.conjugate = false;
        }
        self.changed |= left + joined > 0.0;
        (motion.lambda(), problem.quality(quality))
    }

    /// Makes the direction of the next step; returns its product with the residual.
    fn direct(&mut self) -> f64 {
        // The projection is symmetric only if the images belong to the contact. While the contact
        // changes they need not: once it stays, they must.
        if self.stale && !self.changed {
            self.invert_freedoms();
            self.conjugate = false;
        }
        self.stale = std::mem::take(&mut self.changed);
        let Arrays { r, z, .. } = self.memory.arrays(self.problem.gap.len());
        let inverse = &self.approximation.inverse;
        inverse.apply_slices(r, z, &mut self.workspace);
        self.work += inverse.work();
        let [mut descent, with_last] = self.deflate();
        let Arrays {
            r, z, direction, ..
        } = self.memory.arrays(self.problem.gap.len());
        if descent <= 0.0 {
            // The oblique projection failed: steepest descent, projected orthogonally.
            z.copy_from_slice(r);
            self.problem.freedoms.project(z, r);
            descent = dot(r, z);
            self.conjugate = false;
        }
        // Polak and Ribière's.
        let beta = if self.conjugate {
            ((descent - with_last) / self.descent).max(0.0)
        } else {
            0.0
        };
        self.descent = descent;
        self.conjugate = true;
        let beta = all(beta);
        let [slope] = self
            .passes
            .each([z, r], [direction], add, |_, inputs, [direction]| {
                update(inputs, [direction], |[z, r], [d]| {
                    // What the direction was before it was ever one is not read.
                    let d = z + where_member(beta * where_member(r, ONE), beta * d);
                    ([d], [r * d])
                })
            });
        if slope > 0.0 {
            return slope;
        }
        // The direction lost too many cells: start again along the gradient.
        direction.copy_from_slice(z);
        descent
    }

    /// Restricts z to the contact C and removes from it what would change force and moments. Returns
    /// its products with the residual and with the one before.
    ///
    /// ```text
    /// z ← z − (MB)_C [B_Cᵀ (MB)_C]⁻¹ B_Cᵀ z
    /// ```
    fn deflate(&mut self) -> [f64; 2] {
        let freedoms = self.problem.freedoms;
        let Arrays {
            r,
            r_before,
            z,
            images,
            ..
        } = self.memory.arrays(self.problem.gap.len());
        // Whatever stands for those that are not loaded has no weight.
        let images = [0, 1, 2].map(|k| match freedoms.loaded[k] {
            true => &*images[k],
            false => &*r,
        });
        let mut factors = [0.0; 3];
        if freedoms.any_loaded() {
            let [i0, i1, i2] = images;
            let sums = self.passes.each(
                [&*r, z, i0, i1, i2],
                [],
                add,
                |row, [r, z, images @ ..], []| {
                    let mut sums = [[0.0; 3]; 4];
                    sums[3] = freedoms.moments_on(row, r, z);
                    for (k, image) in images.into_iter().enumerate() {
                        if freedoms.loaded[k] {
                            sums[k] = freedoms.moments_on(row, r, image);
                        }
                    }
                    let flat: [f64; 12] = std::array::from_fn(|k| sums[k / 3][k % 3]);
                    flat
                },
            );
            let matrix = [0, 1, 2].map(|row| [0, 1, 2].map(|column| sums[3 * column + row]));
            factors = freedoms.solve(&matrix, [sums[9], sums[10], sums[11]]);
        }
        let [f0, f1, f2] = factors.map(all);
        let [i0, i1, i2] = images;
        if freedoms.loaded[1] || freedoms.loaded[2] {
            return self
                .passes
                .each([&*r, r_before, i0, i1, i2], [z], add, |_, inputs, [z]| {
                    update(inputs, [z], |[r, last, a, b, c], [z]| {
                        let z = where_member(r, z - f0 * a - f1 * b - f2 * c);
                        ([z], [r * z, last * z])
                    })
                });
        }
        self.passes
            .each([&*r, r_before, i0], [z], add, |_, inputs, [z]| {
                update(inputs, [z], |[r, last, a], [z]| {
                    let z = where_member(r, z - f0 * a);
                    ([z], [r * z, last * z])
                })
            })
    }
}
