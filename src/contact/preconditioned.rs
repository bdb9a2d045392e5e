//! Preconditioned conjugate gradients, deflated by the loaded freedoms.
//!
//! On the contact C = {p > 0} the gap must vanish: K p = Bλ − h. The residual is preconditioned by
//! an approximate inverse of the convolution, and made orthogonal to the loaded freedoms, so that
//! force and moments stay balanced. Cells leave C when their pressure turns negative, without
//! restarting the iteration (Vollebregt, J. Optim. Theory Appl. 162 (2014) 931,
//! doi:10.1007/s10957-013-0499-x), and join it when they overlap, which restarts it. FFT
//! preconditioner and deflation: Vollebregt, J. Comput. Phys. 257 (2014) 333,
//! doi:10.1016/j.jcp.2013.10.005.

use super::problem::{Limits, Outcome, Problem, Termination, Watch};
use crate::convolution::{Convolution, Workspace};

/// Work arrays of one problem, and what is made once for it.
pub(super) struct Preconditioned<'a> {
    problem: &'a Problem<'a>,
    inverse: &'a Convolution,
    workspace: Workspace,
    inverse_workspace: Workspace,
    /// The inverse applied to the loaded freedoms on a contact, see [`Self::invert_freedoms`].
    inverse_freedoms: [Vec<f64>; 3],
    pub(super) work: f64,
}

impl<'a> Preconditioned<'a> {
    pub(super) fn new(problem: &'a Problem<'a>, inverse: &'a Convolution) -> Self {
        Self {
            problem,
            inverse,
            workspace: problem.convolution.workspace(),
            inverse_workspace: inverse.workspace(),
            inverse_freedoms: [Vec::new(), Vec::new(), Vec::new()],
            work: 0.0,
        }
    }

    /// Applies the inverse to the loaded freedoms, as they are on the contact.
    fn invert_freedoms(&mut self, contact: &[bool]) {
        let freedoms = self.problem.freedoms;
        let mut column = vec![0.0; contact.len()];
        for freedom in (0..3).filter(|&k| freedoms.loaded[k]) {
            let unit = [0, 1, 2].map(|k| if k == freedom { 1.0 } else { 0.0 });
            freedoms.for_each(unit, |cell, b| {
                column[cell] = if contact[cell] { b } else { 0.0 }
            });
            let mut image = std::mem::take(&mut self.inverse_freedoms[freedom]);
            image.resize(contact.len(), 0.0);
            self.precondition(&column, &mut image);
            self.inverse_freedoms[freedom] = image;
        }
    }

    fn apply(&mut self, p: &[f64], out: &mut [f64]) {
        self.problem.apply(p, out, &mut self.workspace);
        self.work += self.problem.convolution.work();
    }

    fn precondition(&mut self, r: &[f64], out: &mut [f64]) {
        self.inverse
            .apply_slices(r, out, &mut self.inverse_workspace);
        self.work += self.inverse.work();
    }

    /// Solves from the balanced pressure `p`, which becomes the solution.
    pub(super) fn solve(&mut self, p: &mut [f64], limits: Limits, watch: &mut Watch) -> Outcome {
        let problem = self.problem;
        let freedoms = problem.freedoms;
        let cells = p.len();
        let mut u = vec![0.0; cells];
        let mut g = vec![0.0; cells];
        let mut r = vec![0.0; cells];
        let mut z = vec![0.0; cells];
        let mut direction = vec![0.0; cells];
        let mut response = vec![0.0; cells];
        let mut contact: Vec<bool> = p.iter().map(|&p| p > 0.0).collect();
        let mut descent_before = 0.0;
        let mut conjugate = false;
        // Whether the inverse freedoms are those of another contact, and whether the contact has
        // changed since the last iteration.
        let (mut stale, mut changed) = (false, false);
        self.invert_freedoms(&contact);
        self.apply(p, &mut u);
        // Whether u is that of p, or the sum of the changes.
        let mut fresh = true;

        for iterations in 0.. {
            problem.gap_into(p, &u, &mut g);
            let mut quality = problem.quality(p, &u, &g);
            if quality.meets(limits.tolerance) && !fresh {
                self.apply(p, &mut u);
                problem.gap_into(p, &u, &mut g);
                quality = problem.quality(p, &u, &g);
            }
            let work = self.work;
            let end = |termination| Outcome {
                termination,
                iterations,
                work,
            };
            if quality.meets(limits.tolerance) {
                return end(Termination::Converged);
            }
            if watch(iterations, self.work, quality) {
                return end(Termination::Stopped);
            }
            if iterations == limits.max_iterations {
                return end(Termination::IterationLimit);
            }

            for (k, inside) in contact.iter_mut().enumerate() {
                if !*inside && g[k] < 0.0 && problem.gap[k].is_finite() {
                    *inside = true;
                    changed = true;
                    conjugate = false;
                }
            }
            // The projection is symmetric only if these belong to the contact. While the contact
            // changes they need not: once it stays, they must.
            if stale && !changed {
                self.invert_freedoms(&contact);
                conjugate = false;
            }
            stale = changed;
            changed = false;
            // The part of the last residual along the new direction, for Polak and Ribière's β.
            let mut overlap = 0.0;
            std::mem::swap(&mut r, &mut response);
            for k in 0..cells {
                r[k] = if contact[k] { -g[k] } else { 0.0 };
            }
            let before = &mut response;
            self.precondition(&r, &mut z);
            self.deflate(&mut z, &contact);
            let mut descent: f64 = dot(&r, &z);
            if descent <= 0.0 {
                // The oblique projection failed: steepest descent, projected orthogonally.
                z.copy_from_slice(&r);
                let mean = freedoms.fit(&z, |k| contact[k]);
                freedoms.for_each(mean, |k, b| z[k] = if contact[k] { z[k] - b } else { 0.0 });
                descent = dot(&r, &z);
                conjugate = false;
            }
            if conjugate {
                overlap = dot(before, &z);
            }
            let beta = if conjugate {
                ((descent - overlap) / descent_before).max(0.0)
            } else {
                0.0
            };
            descent_before = descent;
            for k in 0..cells {
                direction[k] = if contact[k] {
                    z[k] + beta * direction[k]
                } else {
                    0.0
                };
            }

            let mut slope = dot(&r, &direction);
            if slope <= 0.0 {
                // The direction lost too many cells: start again along the gradient.
                direction.copy_from_slice(&z);
                slope = descent;
            }
            let response = before;
            self.apply(&direction, response);
            let curvature = dot(response, &direction);
            if !(curvature > 0.0 && slope > 0.0) {
                // Rounding is all that is left.
                return end(Termination::IterationLimit);
            }
            let step = slope / curvature;
            let mut truncated = false;
            for k in 0..cells {
                p[k] += step * direction[k];
                u[k] += step * response[k];
                if p[k] < 0.0 {
                    p[k] = 0.0;
                    truncated = true;
                }
                changed |= contact[k] != (p[k] > 0.0);
                contact[k] = p[k] > 0.0;
            }
            conjugate = true;
            fresh = false;
            // A direction that lost cells since it was made is out of balance, too.
            if truncated || !freedoms.balanced(p) {
                problem.rebalance(p);
                for k in 0..cells {
                    changed |= contact[k] != (p[k] > 0.0);
                    contact[k] = p[k] > 0.0;
                }
                self.apply(p, &mut u);
                fresh = true;
            }
        }
        unreachable!("the loop ends by its limit")
    }

    /// Restricts `z` to the contact C and removes from it what would change force and moments.
    ///
    /// ```text
    /// z ← z − (MB)_C [B_Cᵀ (MB)_C]⁻¹ B_Cᵀ z
    /// ```
    fn deflate(&self, z: &mut [f64], contact: &[bool]) {
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
                let sums = freedoms.moments(|k| if contact[k] { image[k] } else { 0.0 });
                for (row, sum) in sums.into_iter().enumerate() {
                    matrix[row][column] = sum;
                }
            }
        }
        let right = freedoms.moments(|k| z[k]);
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

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
