//! Preconditioned conjugate gradients with bounds, deflated by the loaded degrees of freedom; developed here
//! from known parts.
//!
//! On the contact C the gap must vanish: K p = Bλ − h. One iteration, in the order of the code:
//!
//! ```text
//! u = K p
//! λ    least |u + h − Bλ| over the cells whose pressure is free
//! r  = Bλ − h − u on C, the cells that are free or overlap
//! z  = M r − (MB)_C [B_Cᵀ (MB)_C]⁻¹ B_Cᵀ M r
//! d  ← z + β d on C
//! p  ← [p + d (r·d)/(d·K d)]₊, brought into balance
//! ```
//!
//! M approximates the inverse of K, and the deflated z changes neither force nor moments. Cells leave C when their
//! pressure reaches a bound, and join it when they overlap; neither restarts the iteration.
//!
//! - Vollebregt, J. Optim. Theory Appl. 162 (2014) 931, doi:10.1007/s10957-013-0499-x: conjugate gradients
//!   with bounds. There they restart when cells join.
//! - Vollebregt, J. Comput. Phys. 257 (2014) 333, doi:10.1016/j.jcp.2013.10.005: preconditioning by FFT,
//!   and deflation. There the images MB are those of the contact; here they may be those of an earlier one while the
//!   contact changes.
//! - A step on which cells leave is not the step that was planned, and its displacement takes a second
//!   convolution. After such a step, the next takes its length from a periodic convolution, at a quarter of the cost.
//!
//! Operations that share a pass over arrays are those that would otherwise take as long as the transforms.

use std::mem;
use std::ops::Range;

use crate::compliance::convolution::{Approximation, Workspace};
use crate::contact::problem::balance::Products;
use crate::contact::problem::bounds::{clip, in_contact, is_free, not_allowed, residual};
use crate::contact::problem::freedoms::Freedoms;
use crate::contact::problem::{Problem, Quality, QualitySums, depths, works};
use crate::contact::solver::{Outcome, Solver, StopCriteria, Tally, Termination, active_set};
use crate::numerics::linear_cg::Conjugacy;
use crate::numerics::parallel::{
    ONE, Rows, Total, ZERO, all, dot, sum, update, update_with_largest,
};

/// Iterations by which most contacts have converged. After them a contact of a few cells is left to [`active_set`]. Chosen by
/// trial: without it, 2 of 32 eccentric rough contacts take 13 convolutions more and 2 others 11 and 26 fewer, and 2 of 3
/// contacts on coats 1000 times harder than the body take 36 more.
const PATIENCE: usize = 20;

/// Best length along the change of a step, relative to the planned one. Outside this range so many cells have left that the
/// plan was worth little; beyond 2 the energy would rise. Chosen by trial.
const AS_PLANNED: Range<f64> = 0.6..1.8;

/// Bounds of one change of the ratio of curvatures, and of the ratio itself. Chosen by trial: without the ratio, coats 70
/// times harder than the body are left to the reference.
const CHANGE_OF_RATIO: [f64; 2] = [0.8, 1.25];
const RATIO: [f64; 2] = [0.5, 2.0];

/// Iterations within which the error must halve. Chosen by trial: with fifty, contacts that take 250 to 400 iterations were
/// given up, and the reference took 500 to 5000.
const HALVING: usize = 150;

/// The iteration of one problem, with a field on all cells for each letter.
pub(crate) struct Preconditioned<'a> {
    problem: &'a Problem<'a>,
    approximation: &'a Approximation,
    rows: Rows<'a>,
    workspace: Workspace,
    /// u, the displacement; it lacks `behind` times `response`.
    u: Vec<f64>,
    behind: f64,
    /// K applied to the last direction, or to the last change of the pressure.
    response: Vec<f64>,
    /// r, 0 outside the contact, and the one of the iteration before.
    r: Vec<f64>,
    r_before: Vec<f64>,
    /// z
    z: Vec<f64>,
    /// d
    direction: Vec<f64>,
    /// The pressure of the iteration before, and then the change from it.
    change: Vec<f64>,
    /// M applied to each loaded degree of freedom on a contact; the others are empty.
    images: [Vec<f64>; 3],
    /// Whether the images are those of an earlier contact.
    stale: bool,
    /// Whether any cell has left or joined the contact in the last step.
    contact_changed: bool,
    conjugacy: Conjugacy,
    /// Number of cells in the contact.
    members: f64,
    lambda: [f64; 3],
    /// Whether cells left in the last step, which went as planned otherwise.
    losing: bool,
    /// Curvature of the energy by the exact convolution, relative to that by the periodic one, in the last
    /// step that used both.
    curvature_ratio: f64,
    /// Work done so far, in the unit of `Convolution::work`.
    work: f64,
}

impl<'a> Preconditioned<'a> {
    pub(crate) fn new(problem: &'a Problem<'a>, approximation: &'a Approximation) -> Self {
        let zeros = || vec![0.0; problem.gap.len()];
        let image = |loaded| if loaded { zeros() } else { Vec::new() };
        Self {
            problem,
            approximation,
            rows: problem.rows(),
            workspace: problem.convolution.workspace(),
            u: zeros(),
            behind: 0.0,
            response: zeros(),
            r: zeros(),
            r_before: zeros(),
            z: zeros(),
            direction: zeros(),
            change: zeros(),
            images: problem.freedoms.loaded.map(image),
            stale: false,
            contact_changed: false,
            conjugacy: Conjugacy::default(),
            members: 0.0,
            lambda: [0.0; 3],
            losing: true,
            curvature_ratio: 1.0,
            work: 0.0,
        }
    }

    /// Solves from the balanced pressure `p`, which becomes the solution. It ends early with
    /// [`Termination::IterationLimit`] where [`active_set`] or the reference algorithm can go on. Displacements are sums
    /// over the steps and carry their rounding: a caller that needs them computes them afresh.
    pub(crate) fn solve(
        &mut self,
        p: &mut Vec<f64>,
        criteria: StopCriteria,
        tally: &mut Tally,
    ) -> Outcome {
        let before = tally.work;
        self.start(p);
        let (mut least, mut halved) = (f64::INFINITY, 0);
        for iterations in 0.. {
            let quality = self.assess(p);
            tally.work = before + self.work;
            let lambda = self.lambda;
            let end = |termination| Outcome { solver: Solver::Preconditioned, termination, lambda };
            if quality.meets(criteria.tolerance) {
                return end(Termination::Converged);
            }
            if tally.tell(quality).is_break() {
                return end(Termination::Stopped);
            }
            let limited = tally.iterations >= criteria.max_iterations || quality.overflows();
            let error = quality.residual.max(quality.overlap);
            if error <= 0.5 * least {
                (least, halved) = (error, iterations);
            }
            if limited
                || iterations - halved >= HALVING
                || (iterations >= PATIENCE && active_set::is_small(self.problem, p))
            {
                return end(Termination::IterationLimit);
            }
            let descends = self.step(p);
            tally.work = before + self.work;
            if !descends {
                return end(Termination::IterationLimit);
            }
            tally.iterations += 1;
        }
        unreachable!("the loop ends by its limit")
    }

    /// Takes the cells whose pressure is free for the contact. u = K p
    fn start(&mut self, p: &[f64]) {
        let bounds = self.problem.bounds;
        [self.members] = self.rows.each([p], [&mut self.r], |row, [p], [r]| {
            update([p, bounds.row(row.number)], [r], |[p, limit], _| {
                ([ZERO], [is_free(p, limit) & ONE])
            })
        });
        self.invert_freedoms(p);
        self.problem.apply(p, &mut self.u, &mut self.workspace);
        self.work += self.problem.convolution.work();
    }

    /// Finds λ, the residual r on the contact, and the quality of the pressure.
    fn assess(&mut self, p: &[f64]) -> Quality {
        let (problem, bounds, freedoms) =
            (self.problem, self.problem.bounds, self.problem.freedoms);
        mem::swap(&mut self.r, &mut self.r_before);
        let behind = all(mem::take(&mut self.behind));
        let (inputs, outputs) = ([p, &self.response, problem.gap], [&mut self.u[..]]);
        let fit = self.rows.each(inputs, outputs, |row, inputs, [u]| {
            let limit = bounds.row(row.number);
            Freedoms::fit_row(row, limit, inputs, [u], |[p, response, h, ..], [u]| {
                let u = u + behind * response;
                ([u], [p, u + h])
            })
        });
        self.lambda = match fit.cells() > 0.0 {
            true => freedoms.fitted(fit),
            false => problem.until_touching(p, &self.u, self.lambda),
        };
        let [approach, tilt_x, tilt_y] = self.lambda;
        let (inputs, outputs) = ([p, &self.u, problem.gap], [&mut self.r[..]]);
        let (sums, [free, inside]) = self.rows.each(inputs, outputs, |row, [p, u, h], [r]| {
            let (motion, slope) = (all(approach + tilt_x * row.x), all(tilt_y));
            let inputs = [p, bounds.row(row.number), u, h, row.y];
            let (extremes, [work, mismatch, at_hardness, free, inside]) =
                update_with_largest(inputs, [r], |[p, limit, u, h, y], _| {
                    let overlap = motion + slope * y - (h + u);
                    let residual = residual(p, limit, overlap);
                    let free = is_free(p, limit) & ONE;
                    let inside = in_contact(p, limit, residual) & ONE;
                    let [work, mismatch, at_hardness] = works(p, limit, u, overlap);
                    let sums = [work, mismatch, at_hardness, free, inside];
                    ([residual], depths(p, limit, u, overlap), sums)
                });
            let sums = QualitySums::of_row(extremes, [work, mismatch, at_hardness]);
            (sums, [free, inside])
        });
        // A step gives no pressure to cells outside the contact: the difference is the cells that left.
        let left = mem::replace(&mut self.members, inside) - free;
        self.contact_changed = inside > free || left.abs() > 0.0;
        problem.quality(sums, &fit)
    }

    /// Applies M to the loaded degrees of freedom, restricted to the contact.
    fn invert_freedoms(&mut self, p: &[f64]) {
        let (inverse, bounds) = (&self.approximation.inverse, self.problem.bounds);
        for (freedom, image) in self.images.iter_mut().enumerate().filter(|(_, i)| !i.is_empty()) {
            self.rows.each([p, &self.r], [&mut self.z], |row, [p, r], [z]| {
                let inputs = [p, bounds.row(row.number), r, row.y];
                update(inputs, [z], |[p, limit, r, y], _| {
                    let column = [ONE, all(row.x), y][freedom];
                    ([in_contact(p, limit, r) & column], [])
                })
            });
            inverse.apply_slices(&self.z, image, &mut self.workspace);
            self.work += inverse.work();
        }
    }

    /// Moves the pressure `p` along a new direction. False where none descends: the pressure is unchanged then, up to
    /// rounding.
    fn step(&mut self, p: &mut Vec<f64>) -> bool {
        // The projection is symmetric only with the images of the contact: once it stays, they must be.
        if self.stale && !self.contact_changed {
            self.invert_freedoms(p);
            self.conjugacy.restart();
        }
        self.stale = self.contact_changed;
        let slope = self.search_direction(p);
        let losing = mem::take(&mut self.losing);
        losing && self.advance(p, slope, true) || self.advance(p, slope, false)
    }

    /// Makes the direction of the next step; returns its product with the residual.
    fn search_direction(&mut self, p: &[f64]) -> f64 {
        let (factors, [descent, with_last]) = self.deflate(p);
        let beta = self.conjugacy.beta(descent, with_last);
        let slope = self.turn(p, factors, beta);
        if slope > 0.0 {
            return slope;
        }
        // The direction lost too many cells: start again along the gradient.
        self.turn(p, factors, 0.0)
    }

    /// Preconditions the residual, z = M r, and finds the multiples of the images that must be subtracted
    /// from z so that, on the contact, it changes neither force nor moments. Returns them and the products of the rest
    /// with the residual and with that of the iteration before.
    fn deflate(&mut self, p: &[f64]) -> ([f64; 3], [f64; 2]) {
        let (freedoms, bounds) = (self.problem.freedoms, self.problem.bounds);
        let inverse = &self.approximation.inverse;
        inverse.apply_slices(&self.r, &mut self.z, &mut self.workspace);
        self.work += inverse.work();
        let [i0, i1, i2] = self.loaded_images();
        let inputs = [p, &self.r, &self.r_before, &self.z, i0, i1, i2];
        let [of_z, of_images @ ..] = self.rows.each(inputs, [], |row, inputs, []| {
            let [p, r, before, z, images @ ..] = inputs;
            let here = [p, bounds.row(row.number), r, before];
            let mut products: [Products; 4] = Total::ZERO;
            products[0] = Freedoms::products(row, here, z);
            for (k, image) in images.into_iter().enumerate().filter(|(k, _)| freedoms.loaded[*k]) {
                products[k + 1] = Freedoms::products(row, here, image);
            }
            products
        });
        let matrix = [0, 1, 2].map(|row| of_images.map(|image| image.moments[row]));
        let factors = freedoms.solve(&matrix, of_z.moments);
        let remains = |product: fn(&Products) -> f64| {
            let removed = factors.iter().zip(&of_images).map(|(f, image)| f * product(image));
            product(&of_z) - removed.sum::<f64>()
        };
        let products = [|of: &Products| of.with_residual, |of: &Products| of.with_last];
        let [descent, with_last] = products.map(remains);
        if descent > 0.0 {
            return (factors, [descent, with_last]);
        }
        // The oblique projection failed: steepest descent, projected orthogonally.
        self.z.copy_from_slice(&self.r);
        freedoms.project(&mut self.z, |k| bounds.is_free(k, p[k]) || self.r[k] != 0.0);
        self.conjugacy.restart();
        ([0.0; 3], [dot(&self.r, &self.z), 0.0])
    }

    /// Images of the loaded degrees of freedom; r, which has no weight there, in place of the others.
    fn loaded_images(&self) -> [&[f64]; 3] {
        let image = |image| if Vec::is_empty(image) { &self.r } else { image };
        self.images.each_ref().map(|one| &image(one)[..])
    }

    /// d ← z − Σ `factors` images + `beta` d on the contact, 0 elsewhere; returns r · d.
    fn turn(&mut self, p: &[f64], factors: [f64; 3], beta: f64) -> f64 {
        let mut direction = mem::take(&mut self.direction);
        let [i0, i1, i2] = self.loaded_images();
        let ([f0, f1, f2], beta) = (factors.map(all), all(beta));
        let bounds = self.problem.bounds;
        let (inputs, outputs) = ([p, &self.r, &self.z, i0, i1, i2], [&mut direction[..]]);
        let [slope] = self.rows.each(inputs, outputs, |row, [p, r, z, i0, i1, i2], [direction]| {
            let inputs = [p, bounds.row(row.number), r, z, i0, i1, i2];
            update(inputs, [direction], |[p, limit, r, z, a, b, c], [d]| {
                let z = z - f0 * a - f1 * b - f2 * c;
                let d = in_contact(p, limit, r) & (z + beta * d);
                ([d], [r * d])
            })
        });
        self.direction = direction;
        slope
    }

    /// p ← [p + d (r·d)/(d·K d)]₊, brought into balance, with the `slope` r·d. Where the curvature d·K d is
    /// `approximate`, the best length along the change that remains is found afterwards, and much shorter ones count.
    /// False, with the pressure unchanged up to rounding, where the step would not descend.
    fn advance(&mut self, p: &mut Vec<f64>, slope: f64, approximate: bool) -> bool {
        let (problem, bounds, freedoms) =
            (self.problem, self.problem.bounds, self.problem.freedoms);
        let (operator, ratio) = match approximate {
            true => (&self.approximation.periodic, self.curvature_ratio),
            false => (problem.convolution, 1.0),
        };
        operator.apply_slices(&self.direction, &mut self.response, &mut self.workspace);
        self.work += operator.work();
        let fields = [&self.direction[..], &self.response];
        let [curvature] = self.rows.each(fields, [], |_, fields, []| sum(fields, |[d, k]| [d * k]));
        let Some(length) = best_length(slope, ratio * curvature) else {
            return false;
        };
        let (inputs, outputs) = ([&p[..], &self.direction], [&mut self.change[..]]);
        let (lost, moments) = self.rows.each(inputs, outputs, |row, [p, d], [next]| {
            let inputs = [p, d, bounds.row(row.number)];
            let [lost] = update(inputs, [&mut *next], |[p, d, limit], _| {
                let next = p + all(length) * d;
                ([clip(next, limit)], [not_allowed(next, limit)])
            });
            (lost, Freedoms::moments_of(row, next))
        });
        // From here on `change` is the pressure before the step.
        mem::swap(p, &mut self.change);
        // A direction that lost cells since it was made is out of balance, too.
        let whole = lost <= 0.0 && freedoms.on_target(moments);
        if whole && !approximate {
            self.behind = length;
            return true;
        }
        let factor = if whole { 1.0 } else { self.balance(p, moments[0]) };
        self.rows.each([], [&mut p[..], &mut self.change], |_, [], fields| {
            update([], fields, |[], [p, before]| {
                let p = all(factor) * p;
                ([p, p - before], [])
            })
        });
        problem.apply(&self.change, &mut self.response, &mut self.workspace);
        self.work += problem.convolution.work();
        (self.behind, self.losing) = (1.0, !whole);
        if !approximate {
            return true;
        }
        let fields = [&self.change[..], &self.r, &self.response];
        let [slope, curvature] = self.rows.each(fields, [], |_, fields, []| {
            sum(fields, |[change, r, response]| [change * r, change * response])
        });
        let best = best_length(slope, curvature).unwrap_or(0.0);
        let of_ratio = best.clamp(CHANGE_OF_RATIO[0], CHANGE_OF_RATIO[1]);
        self.curvature_ratio = (ratio / of_ratio).clamp(RATIO[0], RATIO[1]);
        // Where the plan was worth little, an exact step follows.
        self.losing &= AS_PLANNED.contains(&best);
        if best < AS_PLANNED.start {
            self.behind = best;
            let back = all(1.0 - best);
            self.rows.each([&self.change], [&mut p[..]], |_, [change], [p]| {
                update([change], [p], |[change], [p]| ([p - back * change], []))
            });
        }
        best > 0.0
    }

    /// Brings the pressure of this `force` into balance up to the factor that is returned.
    fn balance(&self, p: &mut [f64], force: f64) -> f64 {
        let (problem, freedoms) = (self.problem, self.problem.freedoms);
        let scales = freedoms.only_force() && !problem.bounds.is_limited();
        freedoms.to_load(force).filter(|_| scales).unwrap_or_else(|| {
            problem.rebalance(p, &self.u, self.lambda);
            1.0
        })
    }
}

/// The length of the step to the least energy; `None` where the energy does not fall.
fn best_length(slope: f64, curvature: f64) -> Option<f64> {
    let length = slope / curvature;
    (slope > 0.0 && curvature > 0.0 && length.is_finite()).then_some(length)
}

#[cfg(test)]
mod tests;
