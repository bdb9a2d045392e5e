//! Tractions under Coulomb's law, by a semismooth Newton's method on the sets of sticking and slipping cells.
//!
//! In sliding, the tractions minimise ½ qᵀKq − qᵀg over the discs |q| ≤ μp, under the forces that are given: one
//! solution. A slipping cell keeps |q| = μp; along it, the curvature λ/μp of its disc adds to K. The method is that of
//! Zhao, Vollebregt & Oosterlee, J. Comput. Phys. 288 (2015) 86, doi:10.1016/j.jcp.2015.02.005 (TangCG), with Newton's
//! equations, forces and preconditioner of nacre's own.

use super::law::{Law, State, restrict};
use super::linear::Linear;
use super::operator::Operator;
use crate::parallel::dot;

/// What is asked for: A q = g + C δ where cells stick, Cᵀ q = forces.
pub(super) struct Problem<'a> {
    pub(super) operator: Operator<'a>,
    pub(super) law: &'a Law,
    /// g
    pub(super) given: Vec<f64>,
    /// Columns of the loaded degrees of freedom, and their forces over the area of a cell.
    pub(super) columns: Vec<Vec<f64>>,
    pub(super) forces: Vec<f64>,
}

/// How to iterate.
#[derive(Debug, Clone, Copy)]
pub(super) struct Effort {
    pub(super) tolerance: f64,
    /// Largest number of convolutions.
    pub(super) most: usize,
}

/// Where an iteration ended.
pub(super) struct Outcome {
    pub(super) q: Vec<f64>,
    /// δ of the loaded degrees of freedom.
    pub(super) multipliers: Vec<f64>,
    pub(super) states: Vec<State>,
    pub(super) quality: Quality,
    pub(super) convolutions: usize,
    pub(super) stopped: bool,
}

/// How well the laws hold.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Quality {
    /// Largest slip of a sticking cell, or slip across the traction, over the largest displacement.
    pub(super) violation: f64,
    /// Largest error of a force or torque, over the largest that friction bears.
    pub(super) imbalance: f64,
}

impl Quality {
    pub(super) fn worst(self) -> f64 {
        self.violation.max(self.imbalance)
    }
}

/// Called with each convolution: their number and the quality at the last outer iteration; false stops.
pub(super) type Watch<'a> = dyn FnMut(usize, Quality) -> bool + 'a;

/// Inner residuals relative to their start: at most the first; the second times the quality; and no less than the third
/// of what is still missing to the tolerance. Chosen by trial.
const INNER: [f64; 3] = [0.1, 30.0, 0.2];

/// Iterations of one linear system.
const MOST_INNER: usize = 200;

impl Problem<'_> {
    /// Solves from the tractions `q`.
    pub(super) fn solve(&self, mut q: Vec<f64>, effort: Effort, watch: &mut Watch) -> Outcome {
        let size = q.len();
        let mut states: Vec<State> = self
            .law
            .bound
            .iter()
            .map(|bound| {
                if *bound > 0.0 {
                    State::Stick
                } else {
                    State::Free
                }
            })
            .collect();
        self.law.project(&states, &mut q);
        let mut response = vec![0.0; size];
        let (mut convolutions, mut outer, mut stopped) = (0, 0, false);
        loop {
            let largest = self.operator.apply_measured(&q, &mut response);
            convolutions += 1;
            let mut r: Vec<f64> = response
                .iter()
                .zip(&self.given)
                .map(|(u, g)| u - g)
                .collect();
            let before = self.law.at_bound(&q);
            let mut linear = Linear::new(self.operator, &before, self.columns.clone());
            let multipliers = linear.multipliers(&r);
            let mut free = r.clone();
            self.release(&mut free, &multipliers);
            self.law.states(&q, &free, &mut states);
            let mut linear = Linear::new(self.operator, &states, self.columns.clone());
            let multipliers = linear.multipliers(&r);
            self.release(&mut r, &multipliers);
            let quality = self.quality(&q, &r, largest, &states);
            let left = effort.most.saturating_sub(convolutions);
            if quality.worst() <= effort.tolerance
                || left == 0
                || stopped
                || !watch(convolutions, quality)
            {
                stopped |= quality.worst() > effort.tolerance && left > 0;
                return Outcome {
                    q,
                    multipliers,
                    states,
                    quality,
                    convolutions,
                    stopped,
                };
            }
            restrict(&states, &mut r);
            r.iter_mut().for_each(|r| *r = -*r);
            let missing: Vec<f64> = self
                .columns
                .iter()
                .zip(&self.forces)
                .map(|(column, force)| force - dot(column, &q))
                .collect();
            let [most, factor, least] = INNER;
            let sticks = !states
                .iter()
                .any(|state| matches!(state, State::Slip { .. }));
            let sought = if sticks && outer > 0 {
                // Nothing slipped after a first solve: the problem is linear.
                0.0
            } else {
                most.min(factor * quality.worst())
            };
            let inner = sought.max((least * effort.tolerance / quality.worst()).min(most));
            outer += 1;
            let mut count = convolutions;
            let (d, done) = linear.solve(&r, &missing, inner, left.min(MOST_INNER), &mut || {
                count += 1;
                let goes_on = watch(count, quality);
                stopped |= !goes_on;
                goes_on
            });
            convolutions += done;
            q.iter_mut().zip(&d).for_each(|(q, d)| *q += d);
            self.law.project(&states, &mut q);
        }
    }

    /// Takes C δ from residuals.
    fn release(&self, r: &mut [f64], multipliers: &[f64]) {
        for (column, delta) in self.columns.iter().zip(multipliers) {
            r.iter_mut().zip(column).for_each(|(r, c)| *r -= delta * c);
        }
    }

    fn quality(&self, q: &[f64], r: &[f64], largest: f64, states: &[State]) -> Quality {
        let given = self.given.iter().fold(0.0_f64, |most, g| most.max(g.abs()));
        let scale = if largest > 0.0 { largest } else { given };
        let (x, y) = q.split_at(states.len());
        let used: f64 = x.iter().zip(y).map(|(x, y)| x.hypot(*y)).sum();
        let bearing = if self.law.most() > 0.0 {
            self.law.most()
        } else {
            used
        };
        let forces = self.columns.iter().zip(&self.forces);
        let imbalance = forces.fold(0.0_f64, |worst, (column, force)| {
            let arm = column.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
            worst.max((force - dot(column, q)).abs() / (bearing * arm))
        });
        let violation = self.law.violation(r, states);
        Quality {
            violation: if scale > 0.0 { violation / scale } else { 0.0 },
            imbalance,
        }
    }
}
