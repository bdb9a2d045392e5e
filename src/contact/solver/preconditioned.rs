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

use crate::contact::problem::fit::FitSums;
use crate::contact::problem::{
    Limits, Outcome, Problem, Quality, Termination, Watch, depths, join,
};
use crate::contact::solver::active_set;
use crate::convolution::{Convolution, Workspace};
use crate::parallel::Lease;
use crate::parallel::{
    Lanes, ONE, ZERO, all, dot, update, update_with_largest, where_member, where_positive,
};
use crate::parallel::{Passes, add};
use arrays::Arrays;
pub(crate) use arrays::Memory;

/// A convolution and what approximates it.
pub(crate) struct Approximation {
    /// Its inverse.
    pub(crate) inverse: Convolution,
    /// Itself.
    pub(crate) periodic: Convolution,
}

/// The iteration of one problem.
pub(crate) struct Preconditioned<'a> {
    problem: &'a Problem<'a>,
    approximation: &'a Approximation,
    passes: Passes<'a>,
    workspace: Workspace,
    memory: Lease<Memory>,
    /// Part of the response that is not yet in the displacement.
    pending: f64,
    /// Of the gap, where a step has made them.
    fit: Option<FitSums>,
    /// Cells of the contact.
    members: f64,
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
    pub(crate) work: f64,
}

/// Iterations after which a contact of a few cells is left to [`active_set`]; most have converged by then.
const PATIENCE: usize = 20;

/// How many products [`Freedoms::products_on`] gives.
const OF_EACH: usize = 5;

/// What [`Preconditioned::deflate`] found.
struct Deflated {
    /// Of the images that must be removed.
    factors: [f64; 3],
    /// r · z of what remains; and with the residual before.
    descent: f64,
    with_last: f64,
}

/// What became of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    /// As planned.
    Whole,
    /// Cells left on the way.
    Truncated,
    /// None: nothing descends any more, and the pressure is what it was but for rounding.
    None,
}

impl<'a> Preconditioned<'a> {
    pub(crate) fn new(
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
            fit: None,
            members: 0.0,
            changed: false,
            stale: false,
            conjugate: false,
            descent: 0.0,
            curvature_ratio: 1.0,
            work: 0.0,
        }
    }

    /// Solves from the balanced pressure `p`, which becomes the solution, or may end with
    /// [`Termination::IterationLimit`] early where [`active_set`] can go on. Its displacement is the sum
    /// of those of the steps: whoever needs it computes it afresh.
    pub(crate) fn solve(&mut self, p: &mut [f64], limits: Limits, watch: &mut Watch) -> Outcome {
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
            let limited = iterations == limits.max_iterations || quality.overflows();
            if limited || (iterations >= PATIENCE && active_set::few(p)) {
                return end(Termination::IterationLimit);
            }
            last = self.step(p, last);
            if last == Step::None {
                return end(Termination::IterationLimit);
            }
        }
        unreachable!("the loop ends by its limit")
    }

    /// Takes the cells with a pressure for the contact.
    fn start(&mut self, p: &[f64]) {
        let Arrays { r, .. } = self.memory.arrays(self.problem.gap.len());
        [self.members] = self.passes.each([p], [r], add, |_, [p], [r]| {
            update([p], [r], |[p], _| {
                let pressed = where_positive(p, ONE);
                ([pressed], [pressed])
            })
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
            self.passes.each([r], [&mut *z], add, |row, [r], [z]| {
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
        let Arrays { u, r, response, .. } = self.memory.arrays(self.problem.gap.len());
        let pending = all(std::mem::take(&mut self.pending));
        let fit = self.fit.take().unwrap_or_else(|| {
            let inputs = [p, response, problem.gap];
            self.passes
                .each(inputs, [&mut *u], add, |row, inputs, [u]| {
                    freedoms.fit_of(row, inputs, [u], |[p, response, h, _], [u]| {
                        let u = u + where_positive(pending, pending * response);
                        ([u], [p, u + h, ZERO])
                    })
                })
        });
        let [_, f, fx, fy, ..] = fit;
        let lambda = freedoms.fitted(fit);
        let inputs = [p, u, problem.gap];
        let sums = self.passes.each(inputs, [r], join, |row, [p, u, h], [r]| {
            let (base, slope) = (all(lambda[0] + lambda[1] * row.x), all(lambda[2]));
            let step = |p: Lanes, u: Lanes, h: Lanes, motion: Lanes| {
                let overlap = motion - (h + u);
                let pressed = p.simd_gt(ZERO);
                let inside = pressed | overlap.simd_gt(ZERO);
                // A gap of 0 is told from a cell outside.
                let residual = inside & (overlap + all(f64::MIN_POSITIVE));
                let sums = [p * u, p * residual.abs(), pressed & ONE, inside & ONE];
                ([residual], depths(u, overlap), sums)
            };
            let (largest, sums) = if freedoms.loaded[2] {
                let inputs = [p, u, h, row.y];
                update_with_largest(inputs, [r], |[p, u, h, y], _| {
                    step(p, u, h, base + slope * y)
                })
            } else {
                update_with_largest([p, u, h], [r], |[p, u, h], _| step(p, u, h, base))
            };
            let [deepest, most] = largest;
            let [work, mismatch, pressed, inside] = sums;
            [deepest, most, work, mismatch, pressed, inside]
        });
        let [sums @ .., pressed, inside] = sums;
        let quality = problem.quality(sums, [f, fx, fy]);
        let joined = inside - pressed;
        if MANY * joined > pressed {
            self.conjugate = false;
        }
        // None gets a pressure in a step that was not in the contact before.
        let left = std::mem::replace(&mut self.members, inside) - pressed;
        self.changed |= joined > 0.0 || left.abs() > 0.0;
        (lambda, quality)
    }

    /// Makes the direction of the next step, of which the rows are then in `convolution`; returns its
    /// product with the residual.
    fn direct(&mut self, convolution: &Convolution) -> f64 {
        // The projection is symmetric only if the images belong to the contact. While the contact
        // changes they need not: once it stays, they must.
        if self.stale && !self.changed {
            self.invert_freedoms();
            self.conjugate = false;
        }
        self.stale = std::mem::take(&mut self.changed);
        let Deflated {
            factors,
            descent,
            with_last,
        } = self.deflate();
        // Polak and Ribière's.
        let beta = if self.conjugate {
            ((descent - with_last) / self.descent).max(0.0)
        } else {
            0.0
        };
        self.descent = descent;
        self.conjugate = true;
        let slope = self.turn(convolution, factors, beta);
        if slope > 0.0 {
            return slope;
        }
        // The direction lost too many cells: start again along the gradient.
        self.turn(convolution, factors, 0.0)
    }

    /// Preconditions the residual, and finds what must be removed from that on the contact C so that it
    /// does not change force and moments.
    ///
    /// ```text
    /// z ← z − (MB)_C [B_Cᵀ (MB)_C]⁻¹ B_Cᵀ z
    /// ```
    fn deflate(&mut self) -> Deflated {
        let freedoms = self.problem.freedoms;
        let Arrays {
            r,
            r_before,
            z,
            images,
            ..
        } = self.memory.arrays(self.problem.gap.len());
        let inverse = &self.approximation.inverse;
        let rows = || 0..inverse.shape()[0];
        inverse.rows_in(r, rows(), &mut self.workspace);
        let outwards = inverse.outwards(rows(), &mut self.workspace);
        self.work += inverse.work();
        let [i0, i1, i2] = with_weight(freedoms.loaded, images, r);
        // Of z and of each image.
        let inputs = [&*r, r_before, i0, i1, i2];
        let sums = self
            .passes
            .parts(inputs, [&mut *z], add, |part, inputs, [z]| {
                outwards.rows(part.first, z);
                let [r, before, i0, i1, i2] = inputs;
                let inputs = [r, before, z, i0, i1, i2];
                part.each(inputs, [], add, |row, [r, before, z, images @ ..], []| {
                    let mut sums = [0.0; 4 * OF_EACH];
                    sums[..OF_EACH].copy_from_slice(&freedoms.products_on(row, [r, before], z));
                    let parts = sums[OF_EACH..].chunks_exact_mut(OF_EACH);
                    for (k, (part, image)) in parts.zip(images).enumerate() {
                        if freedoms.loaded[k] {
                            part.copy_from_slice(&freedoms.products_on(row, [r, before], image));
                        }
                    }
                    sums
                })
            });
        let [of_z, of_images @ ..]: [[f64; OF_EACH]; 4] =
            std::array::from_fn(|n| std::array::from_fn(|k| sums[n * OF_EACH + k]));
        let matrix = [0, 1, 2].map(|row| of_images.map(|sums| sums[row]));
        let factors = freedoms.solve(&matrix, [of_z[0], of_z[1], of_z[2]]);
        let remains = |k: usize| {
            let removed = factors.iter().zip(of_images).map(|(f, sums)| f * sums[k]);
            of_z[k] - removed.sum::<f64>()
        };
        let [descent, with_last] = [3, 4].map(remains);
        if descent <= 0.0 {
            // The oblique projection failed: steepest descent, projected orthogonally.
            z.copy_from_slice(r);
            freedoms.project(z, r);
            self.conjugate = false;
            return Deflated {
                factors: [0.0; 3],
                descent: dot(r, z),
                with_last: 0.0,
            };
        }
        Deflated {
            factors,
            descent,
            with_last,
        }
    }

    /// The direction: z less these images, and `beta` times the last.
    fn turn(&mut self, convolution: &Convolution, factors: [f64; 3], beta: f64) -> f64 {
        let Arrays {
            r,
            z,
            direction,
            images,
            ..
        } = self.memory.arrays(self.problem.gap.len());
        let [i0, i1, i2] = with_weight(self.problem.freedoms.loaded, images, r);
        let ([f0, f1, f2], beta) = (factors.map(all), all(beta));
        let (inwards, rows) = convolution.inwards(&mut self.workspace);
        let (inputs, outputs) = ([&*r, z, i0, i1, i2], ([direction], rows));
        let [slope] = self.passes.parts(
            inputs,
            outputs,
            add,
            |part, inputs, ([direction], halves)| {
                let slope = part.each(inputs, [&mut *direction], add, |_, inputs, [direction]| {
                    update(inputs, [direction], |[r, z, a, b, c], [d]| {
                        let z = z - f0 * a - f1 * b - f2 * c;
                        // What the direction was before it was ever one is not read.
                        let d = where_member(r, z + where_member(beta, beta * d));
                        ([d], [r * d])
                    })
                });
                inwards.rows(direction, halves);
                slope
            },
        );
        slope
    }
}

/// Images of the loaded freedoms; whatever stands for the others has no weight.
fn with_weight<'a>(
    loaded: [bool; 3],
    images: [&'a mut [f64]; 3],
    other: &'a [f64],
) -> [&'a [f64]; 3] {
    let mut loaded = loaded.into_iter();
    images.map(|image| match loaded.next() {
        Some(true) => &*image,
        _ => other,
    })
}
