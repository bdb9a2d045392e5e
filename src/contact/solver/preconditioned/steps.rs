//! Steps along a search direction.
//!
//! A step on which cells leave is not the step that was planned, and its displacement takes a second
//! convolution. While cells leave, a step therefore takes its length from the periodic convolution, which
//! costs a quarter, and applies the exact convolution to the change that remains when cells have left and
//! balance is restored.

use std::ops::Range;

use crate::compliance::convolution::Convolution;
use crate::contact::problem::Problem;
use crate::contact::problem::balance::Products;
use crate::contact::problem::bounds::{clip, in_contact, not_allowed};
use crate::contact::solver::preconditioned::{
    Arrays, Displacement, Images, PATIENCE, Preconditioned, StepOutcome,
};
use crate::numerics::parallel::{ONE, Total, all, dot, sum, update, where_positive};

impl Preconditioned<'_> {
    /// A step of the pressure `p`, after the step `last`.
    pub(super) fn step(&mut self, p: &mut [f64], last: StepOutcome) -> StepOutcome {
        let exact = self.problem.convolution;
        if last != StepOutcome::Truncated {
            let slope = self.search_direction(p, exact);
            return self.exact_step(p, slope);
        }
        let slope = self.search_direction(p, &self.approximation.periodic);
        match self.step_with_losses(p, slope) {
            StepOutcome::Stalled => {
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
    fn exact_step(&mut self, p: &mut [f64], slope: f64) -> StepOutcome {
        let (problem, freedoms) = (self.problem, self.problem.freedoms);
        let bounds = problem.bounds;
        let curvature = self.respond(problem.convolution);
        let Some(length) = best_length(slope, curvature).map(all) else {
            return StepOutcome::Stalled;
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
        if done == StepOutcome::Whole {
            self.displacement = Displacement::Fitted(fit);
            return done;
        }
        self.rows
            .each([], [&mut *p], |_, [], [p]| update([], [p], |[], [p]| ([all(factor) * p], [])));
        self.displace(p);
        done
    }

    /// A step of approximate length, with the exact displacement however many cells leave.
    /// [`StepOutcome::Stalled`], with the pressure unchanged up to rounding, where it would not descend.
    fn step_with_losses(&mut self, p: &mut [f64], slope: f64) -> StepOutcome {
        // Best length along the change, relative to the planned one. Outside this range so many cells have
        // left that the plan was worth little; beyond 2 the energy would rise. Chosen by trial.
        const AS_PLANNED: Range<f64> = 0.6..1.8;
        // Bounds of one change of the ratio of curvatures, and of the ratio itself; chosen by trial.
        const CHANGE_OF_RATIO: [f64; 2] = [0.8, 1.25];
        const RATIO: [f64; 2] = [0.5, 2.0];
        let (problem, freedoms) = (self.problem, self.problem.freedoms);
        let curvature = self.respond(&self.approximation.periodic) * self.curvature_ratio;
        let Some(length) = best_length(slope, curvature).map(all) else {
            return StepOutcome::Stalled;
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
            return StepOutcome::Stalled;
        }
        let [least, most] = CHANGE_OF_RATIO;
        let ratio = self.curvature_ratio / best.clamp(least, most);
        self.curvature_ratio = ratio.clamp(RATIO[0], RATIO[1]);
        self.displacement = Displacement::Behind(1.0 - back);
        if AS_PLANNED.contains(&best) {
            done
        } else {
            // The next step is an exact one.
            StepOutcome::Whole
        }
    }
}

/// [`StepOutcome::Whole`] where a pressure of these `moments`, from which `lost` cells were clipped, is balanced.
/// Otherwise restores balance up to a factor on `p`, which is returned with [`StepOutcome::Truncated`]. The displacement and λ
/// before the step are `near`.
fn balance(
    problem: &Problem,
    p: &mut [f64],
    near: (&[f64], [f64; 3]),
    lost: f64,
    moments: [f64; 3],
) -> (StepOutcome, f64) {
    let freedoms = problem.freedoms;
    // A direction that lost cells since it was made is out of balance, too.
    if lost <= 0.0 && freedoms.on_target(moments) {
        return (StepOutcome::Whole, 1.0);
    }
    if problem.bounds.is_limited() {
        problem.rebalance_within(p, near.0, near.1);
        return (StepOutcome::Truncated, 1.0);
    }
    let factor = freedoms.to_load(moments[0]);
    let factor = factor.filter(|_| freedoms.only_force()).unwrap_or_else(|| {
        problem.rebalance(p);
        1.0
    });
    (StepOutcome::Truncated, factor)
}

/// The length of the step to the least energy; `None` where the energy does not fall.
fn best_length(slope: f64, curvature: f64) -> Option<f64> {
    let length = slope / curvature;
    (slope > 0.0 && curvature > 0.0 && length.is_finite()).then_some(length)
}

/// A preconditioned residual that is orthogonal to the loaded degrees of freedom: z − Σ `factors` images.
struct Deflated {
    factors: [f64; 3],
    /// Product with the residual.
    descent: f64,
    /// Product with the residual of the iteration before.
    with_last: f64,
}

impl Preconditioned<'_> {
    /// Computes the images M B of the loaded degrees of freedom anew where they must belong to the contact.
    ///
    /// The projection is symmetric only if the images belong to the contact. While the contact changes
    /// they need not; once it stays, they must. Where it still changes after so many `iterations` that most
    /// contacts have converged, old images may be the reason: they grow old no more.
    pub(super) fn prepare_images(&mut self, p: &[f64], contact_changed: bool, iterations: usize) {
        // Age of the oldest images after [`PATIENCE`] iterations; chosen by trial.
        const OLDEST: usize = 3;
        self.images = match self.images {
            Images::Current if !contact_changed => return,
            Images::Current => Images::Stale(1),
            Images::Stale(age) if contact_changed && (age < OLDEST || iterations < PATIENCE) => {
                Images::Stale(age + 1)
            }
            Images::Stale(_) => {
                self.invert_freedoms(p);
                if !contact_changed {
                    self.conjugacy.restart();
                }
                Images::Current
            }
        };
    }

    /// Applies M to the loaded degrees of freedom, restricted to the contact.
    pub(super) fn invert_freedoms(&mut self, p: &[f64]) {
        let inverse = &self.approximation.inverse;
        let Arrays { r, z, images, .. } = self.memory.arrays(p.len());
        let (loaded, bounds) = (self.problem.freedoms.loaded, self.problem.bounds);
        for (freedom, image) in images.into_iter().enumerate().filter(|(k, _)| loaded[*k]) {
            self.rows.each([p, r], [&mut *z], |row, [p, r], [z]| {
                let inputs = [p, bounds.row(row.number), r, row.y];
                update(inputs, [z], |[p, limit, r, y], _| {
                    let column = [ONE, all(row.x), y][freedom];
                    ([in_contact(p, limit, r) & column], [])
                })
            });
            inverse.apply_slices(z, image, &mut self.workspace);
            self.work += inverse.work();
        }
    }

    /// Makes the direction of the next step and hands its rows to `convolution`; returns its product with
    /// the residual.
    pub(super) fn search_direction(&mut self, p: &[f64], convolution: &Convolution) -> f64 {
        let Deflated { factors, descent, with_last } = self.deflate(p);
        let beta = self.conjugacy.beta(descent, with_last);
        let slope = self.turn(p, convolution, factors, beta);
        if slope > 0.0 {
            return slope;
        }
        // The direction lost too many cells: start again along the gradient.
        self.turn(p, convolution, factors, 0.0)
    }

    /// Preconditions the residual, z = M r, and finds the multiples of the images that must be subtracted
    /// from z so that, on the contact C, it changes neither force nor moments.
    ///
    /// ```text
    /// z ← z − (MB)_C [B_Cᵀ (MB)_C]⁻¹ B_Cᵀ z
    /// ```
    fn deflate(&mut self, p: &[f64]) -> Deflated {
        let (freedoms, bounds) = (self.problem.freedoms, self.problem.bounds);
        let Arrays { r, r_before, z, images, .. } = self.memory.arrays(p.len());
        let inverse = &self.approximation.inverse;
        let rows = || 0..inverse.shape()[0];
        inverse.rows_in(r, rows(), &mut self.workspace);
        let outwards = inverse.outwards(r, rows(), &mut self.workspace);
        self.work += inverse.work();
        let [i0, i1, i2] = loaded_images(freedoms.loaded, images, r);
        let inputs = [p, &*r, r_before, i0, i1, i2];
        // Products of z and of each image.
        let [of_z, of_images @ ..] = self.rows.blocks(inputs, [&mut *z], |block, inputs, [z]| {
            outwards.rows(block.first, z);
            let [p, r, before, i0, i1, i2] = inputs;
            let inputs = [p, r, before, z, i0, i1, i2];
            block.each(inputs, [], |row, [p, r, before, z, images @ ..], []| {
                let mut products: [Products; 4] = Total::ZERO;
                let fields = [p, bounds.row(row.number), r, before];
                products[0] = freedoms.products(row, fields, z);
                for (k, image) in images.into_iter().enumerate() {
                    if freedoms.loaded[k] {
                        products[k + 1] = freedoms.products(row, fields, image);
                    }
                }
                products
            })
        });
        let matrix = [0, 1, 2].map(|row| of_images.map(|image| image.moments[row]));
        let factors = freedoms.solve(&matrix, of_z.moments);
        let remains = |product: fn(&Products) -> f64| {
            let removed = factors.iter().zip(&of_images).map(|(f, image)| f * product(image));
            product(&of_z) - removed.sum::<f64>()
        };
        let descent = remains(|products| products.with_residual);
        if descent <= 0.0 {
            // The oblique projection failed: steepest descent, projected orthogonally.
            z.copy_from_slice(r);
            freedoms.project(z, p, r, bounds);
            self.conjugacy.restart();
            return Deflated { factors: [0.0; 3], descent: dot(r, z), with_last: 0.0 };
        }
        Deflated { factors, descent, with_last: remains(|products| products.with_last) }
    }

    /// Direction d ← z − Σ `factors` images + `beta` d on the contact, 0 elsewhere; returns r · d.
    fn turn(&mut self, p: &[f64], convolution: &Convolution, factors: [f64; 3], beta: f64) -> f64 {
        let Arrays { r, z, direction, images, .. } = self.memory.arrays(p.len());
        let [i0, i1, i2] = loaded_images(self.problem.freedoms.loaded, images, r);
        let ([f0, f1, f2], beta) = (factors.map(all), all(beta));
        let bounds = self.problem.bounds;
        let (inwards, halves) = convolution.inwards(&mut self.workspace);
        let (inputs, outputs) = ([p, &*r, z, i0, i1, i2], ([direction], halves));
        let [slope] = self.rows.blocks(inputs, outputs, |block, inputs, ([direction], halves)| {
            let slope = block.each(inputs, [&mut *direction], |row, inputs, [direction]| {
                let [p, r, z, i0, i1, i2] = inputs;
                let inputs = [p, bounds.row(row.number), r, z, i0, i1, i2];
                update(inputs, [direction], |[p, limit, r, z, a, b, c], [d]| {
                    let z = z - f0 * a - f1 * b - f2 * c;
                    // At a β of 0 the last direction may hold anything.
                    let last = where_positive(beta, beta * d);
                    let d = in_contact(p, limit, r) & (z + last);
                    ([d], [r * d])
                })
            });
            inwards.rows(direction, halves);
            slope
        });
        slope
    }
}

/// Images of the loaded degrees of freedom; the others get `other`, which has no weight.
fn loaded_images<'a>(
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
