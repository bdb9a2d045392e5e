//! An active-set method for contacts of a few cells.
//!
//! Where moments are given and three or four cells carry the load, statics decides what each cell carries.
//! The contact then moves from cell to cell, and conjugate gradients may move in circles. This method
//! cannot: Lawson & Hanson, Solving Least Squares Problems (1974), ch. 23, in the form for a given matrix:
//!
//! 1. solve on the cells of the contact; while pressures come out negative, go towards that solution as
//!    far as no pressure is negative, and drop the cells that reach zero;
//! 2. add the cell that overlaps most; end where none overlaps.
//!
//! With a hardness, cells drop at either bound and are added from either (Stark & Parker, Comput. Stat. 10 (1995)
//! 129); what the cells at the hardness displace and carry is part of h and F.
//!
//! Each solution of step 1 has less energy than the one before, so that no contact comes twice and the
//! iteration ends.
//!
//! Force and moments are costs here, not constraints:
//!
//! ```text
//! minimise ½ pᵀK p + pᵀh + λ₀ᵀ(F − Bᵀp) + |F − Bᵀp|² / 2ε     over p ≥ 0
//! ```
//!
//! The multipliers are λ = λ₀ + (F − Bᵀp)/ε. Repeating λ₀ ← λ brings p into balance (Rockafellar, Math.
//! Oper. Res. 1 (1976) 97, doi:10.1287/moor.1.2.97). No start need be balanced, and λ is defined on
//! every contact: one or two cells, which leave tilts free, keep the tilts of λ₀ unless a moment or an
//! overlap changes them.

use ndarray::ArrayRef2;

use super::{Outcome, Solver, StopCriteria, Tally, Termination};
use crate::compliance::convolution::Workspace;
use crate::contact::problem::Problem;
use crate::model::grid::full_window;
use crate::numerics::dense::{backward, cholesky, forward};
use crate::numerics::parallel::dot;

/// Cells of the largest contact that this method takes: to factorise its matrix costs less than a
/// convolution on 64 × 64 cells.
const LARGEST_CONTACT: usize = 100;

/// Whether so few cells have a free pressure that this method may solve the problem.
pub(crate) fn is_small(problem: &Problem, p: &[f64]) -> bool {
    free_cells(problem, p).take(LARGEST_CONTACT + 1).count() <= LARGEST_CONTACT
}

/// Cells whose pressure is free.
fn free_cells(problem: &Problem, p: &[f64]) -> impl Iterator<Item = usize> {
    (0..p.len()).filter(|&k| problem.bounds.is_free(k, p[k]))
}

/// ε times the displacement of a cell under its own unit pressure. Each renewal of λ₀ brings the balance
/// nearer by this factor, times the square of cells per half side where the cells of the contact are
/// adjacent. With a much smaller value, λ would be rounding alone where the contact does not determine it.
const SOFTNESS: f64 = 1e-9;

/// Renewals of λ₀ without a new cell; two or three suffice, unless rounding is all that is left.
const RENEWALS: usize = 10;

/// Solves from the pressure `p` ≥ 0, which becomes the solution. The problem's convolution was planned
/// from `coefficients`, and λ₀ starts at `lambda`.
///
/// Where there are too many cells, or rounding is all that is left, it ends with
/// [`Termination::IterationLimit`] as well.
pub(crate) fn solve(
    problem: &Problem,
    coefficients: &ArrayRef2<f64>,
    p: &mut [f64],
    lambda: [f64; 3],
    criteria: StopCriteria,
    tally: &mut Tally,
) -> Outcome {
    let before = tally.work;
    let mut system = System {
        problem,
        coefficients,
        softness: SOFTNESS / problem.self_influence(),
        contact: free_cells(problem, p).collect(),
        lambda,
        limited_pressure: vec![0.0; p.len()],
        displaced: vec![0.0; p.len()],
        workspace: problem.convolution.workspace(),
        work: 0.0,
    };
    system.hold(p);
    let mut workspace = problem.convolution.workspace();
    let (mut u, mut g) = (vec![0.0; p.len()], vec![0.0; p.len()]);
    let everywhere = full_window(problem.convolution.shape());
    let mut renewals = 0;
    loop {
        let Some(lambda) = system.descend(p) else {
            tally.work = before + system.work;
            return Outcome {
                solver: Solver::ActiveSet,
                termination: Termination::IterationLimit,
                lambda: system.lambda,
            };
        };
        let (multipliers, quality) = problem.judge(p, &everywhere, &mut u, lambda, &mut workspace);
        system.work += problem.convolution.work();
        tally.work = before + system.work;
        let lambda = multipliers.lambda();
        problem.gap_into(&u, multipliers, &mut g);
        let termination = if quality.meets(criteria.tolerance) {
            Some(Termination::Converged)
        } else if tally.tell(quality).is_break() {
            Some(Termination::Stopped)
        } else {
            let limited = renewals == RENEWALS || tally.iterations >= criteria.max_iterations;
            (limited || quality.overflows()).then_some(Termination::IterationLimit)
        };
        if let Some(termination) = termination {
            return Outcome { solver: Solver::ActiveSet, termination, lambda };
        }
        // What is wrong with the cell where most is: it overlaps, or parts at the hardness.
        let wrong = |k: usize| problem.bounds.wrong(k, p[k], g[k]);
        let bound_cells = (0..p.len()).filter(|&k| !problem.bounds.is_free(k, p[k]));
        let worst = bound_cells.min_by(|&a, &b| wrong(b).total_cmp(&wrong(a)));
        let parts = worst.is_some_and(|k| p[k] > 0.0 && wrong(k) > 0.0);
        if quality.overlap > criteria.tolerance || (parts && quality.residual > criteria.tolerance)
        {
            system.contact.extend(worst);
            renewals = 0;
            if parts {
                system.hold(p);
            }
        } else {
            system.renew(lambda, &g);
            renewals += 1;
        }
        tally.iterations += 1;
    }
}

/// The problem on the cells of a contact.
struct System<'a> {
    problem: &'a Problem<'a>,
    coefficients: &'a ArrayRef2<f64>,
    /// ε
    softness: f64,
    /// Cells that may have a pressure.
    contact: Vec<usize>,
    /// λ₀
    lambda: [f64; 3],
    /// Pressure of the cells that stay at the hardness, 0 elsewhere.
    limited_pressure: Vec<f64>,
    /// Displacement under it.
    displaced: Vec<f64>,
    workspace: Workspace,
    /// Work done so far.
    work: f64,
}

impl System<'_> {
    /// λ₀ ← `lambda`, the multipliers of the last solution, whose gap is `g`. Where the contact cannot carry
    /// the moments and does not hinder the motion, λ₀ goes on until the next cell touches.
    fn renew(&mut self, lambda: [f64; 3], g: &[f64]) {
        // Motion of a contact cell, relative to the largest, above which the contact hinders it: far more
        // than rounding leaves.
        const HINDERED_MOTION: f64 = 1e-6;
        let change = [0, 1, 2].map(|k| lambda[k] - self.lambda[k]);
        let mut closing = vec![0.0; g.len()];
        self.problem.freedoms.for_each(change, |k, b| closing[k] = b);
        let largest = closing.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        let free = self.contact.iter().all(|&k| closing[k].abs() <= HINDERED_MOTION * largest);
        let touching = g.iter().zip(&closing).filter(|(_, c)| **c > HINDERED_MOTION * largest);
        let further = touching.map(|(g, c)| (g / c).max(0.0)).fold(f64::INFINITY, f64::min);
        let further = if free && further.is_finite() { further } else { 0.0 };
        self.lambda = [0, 1, 2].map(|k| lambda[k] + further * change[k]);
    }

    /// Holds the cells outside the contact at their pressure `p`.
    fn hold(&mut self, p: &[f64]) {
        if !self.problem.bounds.is_limited() {
            return;
        }
        self.limited_pressure.copy_from_slice(p);
        for &k in &self.contact {
            self.limited_pressure[k] = 0.0;
        }
        self.problem.apply(&self.limited_pressure, &mut self.displaced, &mut self.workspace);
        self.work += self.problem.convolution.work();
    }

    /// Step 1: from `p` to the solution on the contact, without the cells that lose their pressure on the
    /// way. Returns λ, or `None` where there are too many cells or rounding is all that is left.
    fn descend(&mut self, p: &mut [f64]) -> Option<[f64; 3]> {
        if self.contact.len() > LARGEST_CONTACT {
            return None;
        }
        loop {
            let (aim, lambda) = self.solve()?;
            // Fraction of the way to the solution after which the pressure of each cell is at a bound.
            let bounds = self.problem.bounds;
            let ends = self.contact.iter().zip(&aim).map(|(&k, &aim)| match p[k] {
                _ if bounds.is_free(k, aim) => f64::INFINITY,
                p if aim <= 0.0 => p / (p - aim).max(f64::MIN_POSITIVE),
                p => (bounds.limit(k) - p) / (aim - p).max(f64::MIN_POSITIVE),
            });
            let ends: Vec<f64> = ends.collect();
            let length = ends.iter().fold(1.0, |a: f64, &b| a.min(b));
            // A cell that overlaps takes a pressure, unless the overlap is rounding.
            if length <= 0.0 {
                return None;
            }
            for ((&k, aim), &end) in self.contact.iter().zip(aim).zip(&ends) {
                p[k] = if end > length {
                    p[k] + length * (aim - p[k])
                } else if aim > 0.0 {
                    bounds.limit(k)
                } else {
                    0.0
                };
            }
            if ends.iter().all(|end| end.is_infinite()) {
                return Some(lambda);
            }
            let reaches_limit = self.contact.iter().any(|&k| p[k] >= bounds.limit(k));
            self.contact.retain(|&k| bounds.is_free(k, p[k]));
            if reaches_limit {
                self.hold(p);
            }
        }
    }

    /// Pressure of either sign on the contact, and λ, for which the gap vanishes on all of it.
    ///
    /// ```text
    /// K p = Bλ − h,  Bᵀp + ε (λ − λ₀) = F     K = L Lᵀ, Y = L⁻¹B, y = L⁻¹(h − Bλ₀)
    /// (YᵀY + ε) (λ − λ₀) = F + Yᵀy,  p = L⁻ᵀ(Y (λ − λ₀) − y)
    /// ```
    fn solve(&self) -> Option<(Vec<f64>, [f64; 3])> {
        let freedoms = self.problem.freedoms;
        let columns = freedoms.columns[1].len();
        let places: Vec<[usize; 2]> =
            (self.contact.iter()).map(|k| [k / columns, k % columns]).collect();
        let lower = cholesky(places.len(), 0.0, |a, b| {
            let offset = [0, 1].map(|k| places[a][k].abs_diff(places[b][k]));
            self.coefficients[offset] + self.problem.convolution.added(places[a], places[b])
        })?;
        let b = places.iter().map(|&[i, j]| [1.0, freedoms.columns[0][i], freedoms.columns[1][j]]);
        let b: Vec<[f64; 3]> = b.collect();
        let gap = self.contact.iter().zip(&b);
        let gap = gap.map(|(&k, b)| self.problem.gap[k] + self.displaced[k] - dot(b, &self.lambda));
        let gap = forward(&lower, gap.collect());
        let images = [0, 1, 2].map(|k| forward(&lower, b.iter().map(|b| b[k]).collect()));
        let mut matrix =
            images.each_ref().map(|row| images.each_ref().map(|column| dot(row, column)));
        let limited_moments = freedoms.moments(&self.limited_pressure);
        let mut right = [0, 1, 2].map(|k| freedoms.target[k] - limited_moments[k]);
        for k in 0..3 {
            matrix[k][k] += self.softness;
            right[k] += dot(&images[k], &gap);
        }
        let change = freedoms.solve(&matrix, right);
        let aim =
            (0..gap.len()).map(|a| dot(&images.each_ref().map(|image| image[a]), &change) - gap[a]);
        let lambda = [0, 1, 2].map(|k| self.lambda[k] + change[k]);
        Some((backward(&lower, aim.collect()), lambda))
    }
}
