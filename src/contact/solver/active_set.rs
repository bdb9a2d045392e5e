//! A direct method for contacts of a few cells.
//!
//! Where three or four cells carry the load and moments are given, what each of them carries is a
//! matter of statics: the contact walks from cell to cell, and conjugate gradients may walk in
//! circles. This active-set method cannot. Lawson & Hanson, Solving Least Squares Problems (1974),
//! ch. 23, in the form for a given matrix:
//!
//! 1. solve on the cells of the contact; while pressures come out negative, go as far towards that
//!    solution as none does, and drop the cells that reach zero;
//! 2. add the cell that overlaps most; end where none overlaps.
//!
//! Each solution of step 1 has less energy than the one before, so that no contact comes twice and the
//! walk ends.
//!
//! Force and moments are not constraints of it, but costs:
//!
//! ```text
//! minimise ½ pᵀK p + pᵀh + λ₀ᵀ(F − Bᵀp) + |F − Bᵀp|² / 2ε     over p ≥ 0
//! ```
//!
//! of which the multipliers are λ = λ₀ + (F − Bᵀp)/ε. With λ₀ ← λ, again and again, p comes into balance
//! (Rockafellar, Math. Oper. Res. 1 (1976) 97, doi:10.1287/moor.1.2.97). Thus no start need be
//! balanced, and λ is defined on every contact, also on one or two cells that leave tilts free: they
//! keep those of λ₀, unless a moment or an overlap turns them.

use ndarray::ArrayRef2;

use crate::contact::cascade::patch::whole;
use crate::contact::problem::{Limits, Outcome, Problem, Termination, Watch};
use crate::parallel::dot;

/// Cells of the largest contact that is solved so: factors of its matrix cost less than a convolution
/// on 64 × 64 cells.
const FEW: usize = 100;

/// Whether a pressure is on so few cells that it may be solved so.
pub(crate) fn few(p: &[f64]) -> bool {
    p.iter().filter(|&&p| p > 0.0).take(FEW + 1).count() <= FEW
}

/// ε times the displacement of a cell under its own unit pressure. Each λ₀ brings balance nearer by
/// this factor, times the square of cells per half side where the contact is of adjacent cells. With
/// much less, λ would be rounding alone where the contact does not determine it.
const SOFTNESS: f64 = 1e-9;

/// λ₀ without a cell that joins; two or three do, unless rounding is all that is left.
const RENEWALS: usize = 10;

/// Solves from the pressure `p` ≥ 0, which becomes the solution. `coefficients` are those of the
/// problem's convolution, and λ₀ is `lambda` at first.
///
/// It ends with [`Termination::IterationLimit`], too, where there are too many cells, or where
/// rounding is all that is left.
pub(crate) fn solve(
    problem: &Problem,
    coefficients: &ArrayRef2<f64>,
    p: &mut [f64],
    lambda: [f64; 3],
    limits: Limits,
    watch: &mut Watch,
) -> Outcome {
    let mut system = System {
        problem,
        coefficients,
        softness: SOFTNESS / problem.self_influence(),
        contact: (0..p.len()).filter(|&k| p[k] > 0.0).collect(),
        lambda,
    };
    let mut workspace = problem.convolution.workspace();
    let (mut u, mut g) = (vec![0.0; p.len()], vec![0.0; p.len()]);
    let everywhere = whole(problem.convolution.shape());
    let (mut work, mut renewals) = (0.0, 0);
    for iterations in 0.. {
        let Some(lambda) = system.descend(p) else {
            return Outcome {
                termination: Termination::IterationLimit,
                iterations,
                work,
                lambda: system.lambda,
            };
        };
        let (motion, quality) = problem.judge(p, &everywhere, &mut u, lambda, &mut workspace);
        work += problem.convolution.work();
        let lambda = motion.lambda();
        problem.gap_into(&u, motion, &mut g);
        let termination = if quality.meets(limits.tolerance) {
            Some(Termination::Converged)
        } else if watch(iterations, work, quality) {
            Some(Termination::Stopped)
        } else {
            let limited = renewals == RENEWALS || iterations >= limits.max_iterations;
            (limited || quality.overflows()).then_some(Termination::IterationLimit)
        };
        if let Some(termination) = termination {
            return Outcome {
                termination,
                iterations,
                work,
                lambda,
            };
        }
        if quality.overlap > limits.tolerance {
            let outside = (0..p.len()).filter(|&k| p[k] <= 0.0);
            let deepest = outside.min_by(|&a, &b| g[a].total_cmp(&g[b]));
            system.contact.extend(deepest);
            renewals = 0;
        } else {
            system.renew(lambda, &g);
            renewals += 1;
        }
    }
    unreachable!("the loop ends by its limit")
}

/// The problem on its contact.
struct System<'a> {
    problem: &'a Problem<'a>,
    coefficients: &'a ArrayRef2<f64>,
    /// ε
    softness: f64,
    /// The cells that may have a pressure.
    contact: Vec<usize>,
    /// λ₀
    lambda: [f64; 3],
}

impl System<'_> {
    /// λ₀ ← `lambda`, the multipliers of the last solution, with gap `g`; and further, until the next
    /// cell touches, where the contact cannot carry the moments and does not hinder that motion.
    fn renew(&mut self, lambda: [f64; 3], g: &[f64]) {
        // Of a motion that a contact hinders: far more than rounding leaves.
        const HINDERED: f64 = 1e-6;
        let change = [0, 1, 2].map(|k| lambda[k] - self.lambda[k]);
        let mut closing = vec![0.0; g.len()];
        self.problem
            .freedoms
            .for_each(change, |k, b| closing[k] = b);
        let most = closing.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        let free = self
            .contact
            .iter()
            .all(|&k| closing[k].abs() <= HINDERED * most);
        let touching = g
            .iter()
            .zip(&closing)
            .filter(|(_, c)| **c > HINDERED * most);
        let further = touching
            .map(|(g, c)| (g / c).max(0.0))
            .fold(f64::INFINITY, f64::min);
        let further = if free && further.is_finite() {
            further
        } else {
            0.0
        };
        self.lambda = [0, 1, 2].map(|k| lambda[k] + further * change[k]);
    }

    /// Step 1: from `p` to the solution on the contact, less the cells that lose their pressure on the
    /// way. Returns λ; nothing where there are too many cells, or rounding is all that is left.
    fn descend(&mut self, p: &mut [f64]) -> Option<[f64; 3]> {
        if self.contact.len() > FEW {
            return None;
        }
        loop {
            let (aim, lambda) = self.solve()?;
            // The part of the way to it on which a pressure that is to vanish stays positive.
            let parts = self.contact.iter().zip(&aim).map(|(&k, &aim)| match p[k] {
                _ if aim > 0.0 => f64::INFINITY,
                p => p / (p - aim).max(f64::MIN_POSITIVE),
            });
            let parts: Vec<f64> = parts.collect();
            let length = parts.iter().fold(1.0, |a: f64, &b| a.min(b));
            // A cell that overlaps takes a pressure, but where the overlap is rounding.
            if length <= 0.0 {
                return None;
            }
            for ((&k, aim), &part) in self.contact.iter().zip(aim).zip(&parts) {
                p[k] = if part <= length {
                    0.0
                } else {
                    p[k] + length * (aim - p[k])
                };
            }
            if parts.iter().all(|part| part.is_infinite()) {
                return Some(lambda);
            }
            self.contact.retain(|&k| p[k] > 0.0);
        }
    }

    /// Pressure on the contact and λ where the gap vanishes on all of it, of either sign.
    ///
    /// ```text
    /// K p = Bλ − h,  Bᵀp + ε (λ − λ₀) = F     K = L Lᵀ, Y = L⁻¹B, y = L⁻¹(h − Bλ₀)
    /// (YᵀY + ε) (λ − λ₀) = F + Yᵀy,  p = L⁻ᵀ(Y (λ − λ₀) − y)
    /// ```
    fn solve(&self) -> Option<(Vec<f64>, [f64; 3])> {
        let freedoms = self.problem.freedoms;
        let columns = freedoms.columns[1].len();
        let places: Vec<[usize; 2]> = (self.contact.iter())
            .map(|k| [k / columns, k % columns])
            .collect();
        let lower = cholesky(places.len(), |a, b| {
            let offset = [0, 1].map(|k| places[a][k].abs_diff(places[b][k]));
            self.coefficients[offset]
        })?;
        let b = places
            .iter()
            .map(|&[i, j]| [1.0, freedoms.columns[0][i], freedoms.columns[1][j]]);
        let b: Vec<[f64; 3]> = b.collect();
        let gap = self.contact.iter().zip(&b);
        let gap = gap.map(|(&k, b)| self.problem.gap[k] - dot(b, &self.lambda));
        let gap = forward(&lower, gap.collect());
        let images = [0, 1, 2].map(|k| forward(&lower, b.iter().map(|b| b[k]).collect()));
        let mut matrix = images
            .each_ref()
            .map(|row| images.each_ref().map(|column| dot(row, column)));
        let mut right = freedoms.target;
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

/// L of K = L Lᵀ, by rows up to the diagonal; none where a pivot is not positive.
fn cholesky(cells: usize, matrix: impl Fn(usize, usize) -> f64) -> Option<Vec<Vec<f64>>> {
    let mut lower: Vec<Vec<f64>> = Vec::with_capacity(cells);
    for a in 0..cells {
        let mut row = Vec::with_capacity(a + 1);
        for (b, above) in lower.iter().enumerate() {
            row.push((matrix(a, b) - dot(&row, &above[..b])) / above[b]);
        }
        let pivot = matrix(a, a) - dot(&row, &row);
        if pivot.is_nan() || pivot <= 0.0 {
            return None;
        }
        row.push(pivot.sqrt());
        lower.push(row);
    }
    Some(lower)
}

/// L⁻¹v
fn forward(lower: &[Vec<f64>], mut v: Vec<f64>) -> Vec<f64> {
    for (a, row) in lower.iter().enumerate() {
        v[a] = (v[a] - dot(&row[..a], &v[..a])) / row[a];
    }
    v
}

/// L⁻ᵀv
fn backward(lower: &[Vec<f64>], mut v: Vec<f64>) -> Vec<f64> {
    for (a, row) in lower.iter().enumerate().rev() {
        v[a] /= row[a];
        let known = v[a];
        for (v, entry) in v.iter_mut().zip(&row[..a]) {
            *v -= entry * known;
        }
    }
    v
}
