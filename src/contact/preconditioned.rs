//! Preconditioned conjugate gradients, deflated by the loaded freedoms.
//!
//! On the contact C = {p > 0} the gap must vanish: K p = Bλ − h. The residual is preconditioned by
//! an approximate inverse of the convolution, and made orthogonal to the loaded freedoms, so that
//! force and moments stay balanced. Cells leave C when their pressure turns negative, and join it
//! when they overlap; neither restarts the iteration (Vollebregt, J. Optim. Theory Appl. 162
//! (2014) 931, doi:10.1007/s10957-013-0499-x, restarts it when cells join). FFT preconditioner and
//! deflation: Vollebregt, J. Comput. Phys. 257 (2014) 333, doi:10.1016/j.jcp.2013.10.005.
//!
//! A step that makes cells leave is not the step that was planned, so that its displacement takes a
//! second convolution. While cells leave, a step costs one: its length is taken from the periodic
//! convolution, which costs a fifth, and the exact one is applied to the change that remains
//! when cells have left and balance is restored.

use std::ops::Range;

use super::direct;
use super::problem::{Limits, Outcome, Problem, Termination, Watch};
use super::sums::dot;
use crate::convolution::{Convolution, Workspace};

/// A convolution and what approximates it.
pub(super) struct Approximation {
    /// Its inverse.
    pub(super) inverse: Convolution,
    /// Itself.
    pub(super) periodic: Convolution,
}

/// Work arrays of one problem, and what is made once for it.
pub(super) struct Preconditioned<'a> {
    problem: &'a Problem<'a>,
    approximation: &'a Approximation,
    workspace: Workspace,
    /// The inverse applied to the loaded freedoms on a contact, see [`Self::invert_freedoms`].
    inverse_freedoms: [Vec<f64>; 3],
    /// Displacement K p.
    u: Vec<f64>,
    /// The cells that may have a pressure.
    contact: Vec<bool>,
    /// Whether these have changed since the last iteration.
    changed: bool,
    direction: Vec<f64>,
    /// K applied to the last direction or change.
    response: Vec<f64>,
    /// Curvature of the exact convolution over that of the periodic one, as last seen.
    curvature_ratio: f64,
    pub(super) work: f64,
}

/// Iterations after which a contact of a few cells is left to [`direct`]; most have converged by then.
const PATIENCE: usize = 20;

/// How many cells joined the contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Joined {
    None,
    Few,
    /// So many that the directions so far say little about it.
    Many,
}

/// What became of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    /// As planned.
    Whole,
    /// Cells left on the way.
    Truncated,
    /// Rounding is all that is left.
    None,
}

impl<'a> Preconditioned<'a> {
    pub(super) fn new(problem: &'a Problem<'a>, approximation: &'a Approximation) -> Self {
        let cells = problem.gap.len();
        Self {
            problem,
            approximation,
            workspace: problem.convolution.workspace(),
            inverse_freedoms: [Vec::new(), Vec::new(), Vec::new()],
            u: vec![0.0; cells],
            contact: vec![false; cells],
            changed: false,
            direction: vec![0.0; cells],
            response: vec![0.0; cells],
            curvature_ratio: 1.0,
            work: 0.0,
        }
    }

    /// Applies the inverse to the loaded freedoms, as they are on the contact.
    fn invert_freedoms(&mut self) {
        let freedoms = self.problem.freedoms;
        let mut column = vec![0.0; self.contact.len()];
        for freedom in (0..3).filter(|&k| freedoms.loaded[k]) {
            let unit = [0, 1, 2].map(|k| if k == freedom { 1.0 } else { 0.0 });
            freedoms.for_each(unit, |cell, b| {
                column[cell] = if self.contact[cell] { b } else { 0.0 }
            });
            let mut image = std::mem::take(&mut self.inverse_freedoms[freedom]);
            image.resize(column.len(), 0.0);
            self.precondition(&column, &mut image);
            self.inverse_freedoms[freedom] = image;
        }
    }

    fn precondition(&mut self, r: &[f64], out: &mut [f64]) {
        let inverse = &self.approximation.inverse;
        inverse.apply_slices(r, out, &mut self.workspace);
        self.work += inverse.work();
    }

    /// u = K p
    fn displace(&mut self, p: &[f64]) {
        self.problem.apply(p, &mut self.u, &mut self.workspace);
        self.work += self.problem.convolution.work();
    }

    /// Solves from the balanced pressure `p`, which becomes the solution, or may end with
    /// [`Termination::IterationLimit`] early where [`direct`] can go on. Its displacement is the sum
    /// of those of the steps: whoever needs it computes it afresh.
    pub(super) fn solve(&mut self, p: &mut [f64], limits: Limits, watch: &mut Watch) -> Outcome {
        let problem = self.problem;
        let cells = p.len();
        let mut g = vec![0.0; cells];
        let mut r = vec![0.0; cells];
        let mut r_before = vec![0.0; cells];
        let mut z = vec![0.0; cells];
        let mut descent_before = 0.0;
        let mut conjugate = false;
        // Whether the inverse freedoms are those of another contact.
        let mut stale = false;
        let mut last = Step::Truncated;
        self.locate(p);
        self.changed = false;
        self.invert_freedoms();
        self.displace(p);

        for iterations in 0.. {
            let (lambda, quality) = problem.gap_into(p, &self.u, &mut g);
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

            if self.join(&g) == Joined::Many {
                conjugate = false;
            }
            // The projection is symmetric only if these belong to the contact. While the contact
            // changes they need not: once it stays, they must.
            if stale && !self.changed {
                self.invert_freedoms();
                conjugate = false;
            }
            stale = self.changed;
            self.changed = false;

            std::mem::swap(&mut r, &mut r_before);
            let members = r.iter_mut().zip(&g).zip(&self.contact);
            members.for_each(|((r, g), inside)| *r = if *inside { -g } else { 0.0 });
            self.precondition(&r, &mut z);
            self.deflate(&mut z);
            let mut descent = dot(&r, &z);
            if descent <= 0.0 {
                // The oblique projection failed: steepest descent, projected orthogonally.
                z.copy_from_slice(&r);
                problem.freedoms.project(&mut z, &self.contact);
                descent = dot(&r, &z);
                conjugate = false;
            }
            // Polak and Ribière's.
            let beta = if conjugate {
                ((descent - dot(&r_before, &z)) / descent_before).max(0.0)
            } else {
                0.0
            };
            descent_before = descent;
            let members = self.direction.iter_mut().zip(&z).zip(&self.contact);
            members.for_each(|((d, z), inside)| *d = if *inside { z + beta * *d } else { 0.0 });
            let mut slope = dot(&r, &self.direction);
            if slope <= 0.0 {
                // The direction lost too many cells: start again along the gradient.
                self.direction.copy_from_slice(&z);
                slope = descent;
            }

            conjugate = true;
            // z and g are no longer needed.
            last = match last {
                Step::Truncated => self.step_with_losses(p, &r, slope, &mut z, &mut g),
                _ => Step::None,
            };
            if last == Step::None {
                last = self.step(p, slope);
            }
            if last == Step::None {
                return end(Termination::IterationLimit);
            }
        }
        unreachable!("the loop ends by its limit")
    }

    /// Cells that overlap join the contact.
    fn join(&mut self, g: &[f64]) -> Joined {
        // One in so many.
        const MANY: usize = 10;
        let (mut joined, mut members) = (0, 0);
        let cells = self.contact.iter_mut().zip(g).zip(self.problem.gap);
        for ((inside, &g), gap) in cells {
            members += usize::from(*inside);
            if !*inside && g < 0.0 && gap.is_finite() {
                *inside = true;
                joined += 1;
            }
        }
        self.changed |= joined > 0;
        match joined {
            0 => Joined::None,
            _ if joined * MANY > members => Joined::Many,
            _ => Joined::Few,
        }
    }

    /// Takes the cells with a pressure for the contact.
    fn locate(&mut self, p: &[f64]) {
        for (inside, p) in self.contact.iter_mut().zip(p) {
            self.changed |= *inside != (*p > 0.0);
            *inside = *p > 0.0;
        }
    }

    /// Moves `p` by `step` times the direction as far as it stays ≥ 0, and restores balance. Returns
    /// whether it was moved so alone.
    fn advance(&self, p: &mut [f64], step: f64) -> Step {
        let mut truncated = false;
        for (p, d) in p.iter_mut().zip(&self.direction) {
            *p += step * d;
            if *p < 0.0 {
                *p = 0.0;
                truncated = true;
            }
        }
        // A direction that lost cells since it was made is out of balance, too.
        if truncated || !self.problem.freedoms.balanced(p) {
            self.problem.rebalance(p);
            return Step::Truncated;
        }
        Step::Whole
    }

    /// A step of exact length. Where cells leave, the displacement is computed afresh.
    fn step(&mut self, p: &mut [f64], slope: f64) -> Step {
        let problem = self.problem;
        problem.apply(&self.direction, &mut self.response, &mut self.workspace);
        self.work += problem.convolution.work();
        let curvature = dot(&self.response, &self.direction);
        if !(curvature > 0.0 && slope > 0.0) {
            return Step::None;
        }
        let step = slope / curvature;
        let done = self.advance(p, step);
        self.locate(p);
        if done == Step::Truncated {
            self.displace(p);
        } else {
            for (u, response) in self.u.iter_mut().zip(&self.response) {
                *u += step * response;
            }
        }
        done
    }

    /// A step of approximate length, exactly displaced however many cells leave. `r` is the residual;
    /// `before` and `change` are scratch. None, with nothing done, where it would not descend.
    fn step_with_losses(
        &mut self,
        p: &mut [f64],
        r: &[f64],
        slope: f64,
        before: &mut [f64],
        change: &mut [f64],
    ) -> Step {
        // Where the best length along the change is further from the planned one, so many cells have
        // left that the plan was worth little. Beyond twice the best length the energy would rise.
        const AS_PLANNED: Range<f64> = 0.6..1.8;
        let periodic = &self.approximation.periodic;
        periodic.apply_slices(&self.direction, &mut self.response, &mut self.workspace);
        self.work += periodic.work();
        let curvature = dot(&self.response, &self.direction) * self.curvature_ratio;
        if !(curvature > 0.0 && slope > 0.0) {
            return Step::None;
        }
        before.copy_from_slice(p);
        let done = self.advance(p, slope / curvature);
        for ((change, p), before) in change.iter_mut().zip(&*p).zip(&*before) {
            *change = p - before;
        }
        let problem = self.problem;
        problem.apply(change, &mut self.response, &mut self.workspace);
        self.work += problem.convolution.work();
        // The best length along the change.
        let best = dot(r, change) / dot(&self.response, change);
        if !(best > 0.0 && best.is_finite()) {
            p.copy_from_slice(before);
            return Step::None;
        }
        self.curvature_ratio = (self.curvature_ratio / best.clamp(0.8, 1.25)).clamp(0.5, 2.0);
        let length = if best < AS_PLANNED.start { best } else { 1.0 };
        if length < 1.0 {
            for ((p, before), change) in p.iter_mut().zip(&*before).zip(&*change) {
                *p = before + length * change;
            }
        }
        for (u, response) in self.u.iter_mut().zip(&self.response) {
            *u += length * response;
        }
        self.locate(p);
        if AS_PLANNED.contains(&best) {
            done
        } else {
            // The next step is an exact one.
            Step::Whole
        }
    }

    /// Restricts `z` to the contact C and removes from it what would change force and moments.
    ///
    /// ```text
    /// z ← z − (MB)_C [B_Cᵀ (MB)_C]⁻¹ B_Cᵀ z
    /// ```
    fn deflate(&self, z: &mut [f64]) {
        let contact = &self.contact;
        for (z, inside) in z.iter_mut().zip(contact) {
            if !inside {
                *z = 0.0;
            }
        }
        let freedoms = self.problem.freedoms;
        if !freedoms.any_loaded() {
            return;
        }
        let mut matrix = [[0.0; 3]; 3];
        for (column, image) in self.inverse_freedoms.iter().enumerate() {
            if freedoms.loaded[column] {
                let sums = freedoms.moments_on(image, contact);
                for (row, sum) in sums.into_iter().enumerate() {
                    matrix[row][column] = sum;
                }
            }
        }
        let right = freedoms.moments(z);
        let factors = freedoms.solve(&matrix, right);
        for (factor, image) in factors.into_iter().zip(&self.inverse_freedoms) {
            if factor != 0.0 {
                for k in (0..z.len()).filter(|&k| contact[k]) {
                    z[k] -= factor * image[k];
                }
            }
        }
    }
}
