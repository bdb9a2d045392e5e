//! Tractions under Coulomb's law, by a semismooth Newton's method on the sets of sticking and slipping cells.
//!
//! In sliding, the tractions minimise ½ qᵀKq − qᵀg over the discs |q| ≤ μp, under the forces that are given: one
//! solution. A slipping cell keeps |q| = μp; along it, the curvature λ/μp of its disc adds to K. The method is that of
//! Zhao, Vollebregt & Oosterlee, J. Comput. Phys. 288 (2015) 86, doi:10.1016/j.jcp.2015.02.005 (TangCG), with Newton's
//! equations, forces and preconditioner derived here.

use std::ops::ControlFlow;

use super::law::{CellState, Law, restrict};
use super::linear::{NewtonSystem, Operator, small_system};
use crate::numerics::parallel::dot;

/// What is asked for: A q = g + C δ where cells stick, Cᵀ q = forces.
pub(super) struct TractionProblem<'a> {
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
pub(super) struct TractionResult {
    pub(super) q: Vec<f64>,
    /// δ of the loaded degrees of freedom.
    pub(super) multipliers: Vec<f64>,
    pub(super) states: Vec<CellState>,
    pub(super) misfit: Misfit,
    pub(super) convolutions: usize,
    pub(super) stopped: bool,
}

/// How well the laws hold.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Misfit {
    /// Largest slip of a sticking cell, or slip across the traction, over the largest displacement.
    pub(super) violation: f64,
    /// Largest error of a force or torque, over the largest that friction bears.
    pub(super) imbalance: f64,
}

impl Misfit {
    pub(super) fn worst(self) -> f64 {
        self.violation.max(self.imbalance)
    }
}

/// Called with each convolution: their number and the misfit at the last outer iteration; a break stops.
pub(super) type ConvolutionWatch<'a> = dyn FnMut(usize, Misfit) -> ControlFlow<()> + 'a;

/// Inner residuals relative to their start: at most the first; the second times the misfit; and no less than the third
/// of what is still missing to the tolerance. Chosen by trial.
const INNER: [f64; 3] = [0.1, 30.0, 0.2];

/// Iterations of one linear system.
const MOST_INNER: usize = 200;

/// Steps without a better misfit before they are halved.
const PATIENCE: i32 = 5;

/// Tractions, and how they stand to the laws.
struct Standing {
    states: Vec<CellState>,
    /// δ
    multipliers: Vec<f64>,
    /// A q − g − C δ
    residual: Vec<f64>,
    misfit: Misfit,
}

impl TractionProblem<'_> {
    /// How well the laws hold for the tractions `q`, within their bounds. It takes a convolution.
    pub(super) fn misfit_of(&self, mut q: Vec<f64>) -> Misfit {
        self.law.project(&self.law.at_bound(&q), &mut q);
        let mut response = vec![0.0; q.len()];
        self.stand(&q, &mut response, &self.columns).misfit
    }

    /// Computes `response` = A q, and what cells do. `weights` weigh the residuals of sticking cells for δ, one field
    /// for each column.
    fn stand(&self, q: &[f64], response: &mut [f64], weights: &[Vec<f64>]) -> Standing {
        let largest = self.operator.apply(q, response);
        let given = response.iter().zip(&self.given);
        let rest: Vec<f64> = given.map(|(u, g)| u - g).collect();
        // Cells at their bound slip, or at the δ of all others would slip along the traction and stick.
        let mut states = self.law.at_bound(q);
        let mut residual = rest.clone();
        self.release(&mut residual, &self.multipliers(weights, &states, &rest));
        self.law.states(q, &residual, &mut states);
        let multipliers = self.multipliers(weights, &states, &rest);
        residual = rest;
        self.release(&mut residual, &multipliers);
        let misfit = self.misfit(q, &residual, largest, &states);
        Standing { states, multipliers, residual, misfit }
    }

    /// δ with which the residuals `r` − C δ vanish in the mean: those of sticking cells, and those across the tractions of
    /// slipping ones.
    /// In rolling M is not symmetric, and M C is no weight: M weighs the residuals themselves.
    fn multipliers(&self, weights: &[Vec<f64>], states: &[CellState], r: &[f64]) -> Vec<f64> {
        if self.columns.is_empty() {
            return Vec::new();
        }
        if self.operator.rolling.is_some() {
            return NewtonSystem::new(self.operator, states, self.columns.clone()).multipliers(r);
        }
        let mut weights = weights.to_vec();
        weights.iter_mut().for_each(|weight| restrict(states, weight));
        let right: Vec<f64> = weights.iter().map(|weight| dot(weight, r)).collect();
        small_system(&self.columns, &weights, &right)
    }

    /// Solves from the tractions `q`.
    pub(super) fn solve(
        &self,
        mut q: Vec<f64>,
        effort: Effort,
        watch: &mut ConvolutionWatch,
    ) -> TractionResult {
        self.law.project(&self.law.at_bound(&q), &mut q);
        let mut response = vec![0.0; q.len()];
        let mut weights = self.columns.clone();
        let (mut convolutions, mut outer, mut stopped) = (0, 0, false);
        let (mut best, mut stalled) = (f64::INFINITY, 0);
        loop {
            let Standing { states, multipliers, mut residual, misfit } =
                self.stand(&q, &mut response, &weights);
            convolutions += 1;
            let left = effort.most.saturating_sub(convolutions);
            let good = misfit.worst() <= effort.tolerance;
            if good || left == 0 || stopped || watch(convolutions, misfit).is_break() {
                return TractionResult {
                    q,
                    multipliers,
                    states,
                    misfit,
                    convolutions,
                    stopped: !good && left > 0,
                };
            }
            restrict(&states, &mut residual);
            residual.iter_mut().for_each(|r| *r = -*r);
            let pairs = self.columns.iter().zip(&self.forces);
            let missing: Vec<f64> = pairs.map(|(column, force)| force - dot(column, &q)).collect();
            let [most, factor, least] = INNER;
            let sticks = !states.iter().any(|state| matches!(state, CellState::Slip { .. }));
            let sought = if sticks && outer > 0 {
                // Nothing slipped after a first solve: the problem is linear.
                0.0
            } else {
                most.min(factor * misfit.worst())
            };
            let floor = (least * effort.tolerance / misfit.worst()).min(most);
            // Loose systems may send the sets to and fro; so may exact ones, and shorter steps then lead on.
            stalled = if misfit.worst() < 0.9 * best { 0 } else { stalled + 1 };
            best = best.min(misfit.worst());
            let inner = (sought * 0.1_f64.powi(stalled)).max(floor);
            let part = if stalled > PATIENCE { 0.5 } else { 1.0 };
            outer += 1;
            let mut linear = NewtonSystem::new(self.operator, &states, self.columns.clone());
            let mut count = convolutions;
            let most = left.min(MOST_INNER);
            let (d, done) = linear.solve(&residual, &missing, inner, most, &mut || {
                count += 1;
                let answer = watch(count, misfit);
                stopped |= answer.is_break();
                answer
            });
            convolutions += done;
            weights = linear.into_weights();
            q.iter_mut().zip(&d).for_each(|(q, d)| *q += part * d);
            self.law.project(&states, &mut q);
        }
    }

    /// Takes C δ from residuals.
    fn release(&self, r: &mut [f64], multipliers: &[f64]) {
        for (column, delta) in self.columns.iter().zip(multipliers) {
            r.iter_mut().zip(column).for_each(|(r, c)| *r -= delta * c);
        }
    }

    fn misfit(&self, q: &[f64], r: &[f64], largest: f64, states: &[CellState]) -> Misfit {
        let given = self.given.iter().fold(0.0_f64, |most, g| most.max(g.abs()));
        let scale = if largest > 0.0 { largest } else { given };
        let (x, y) = q.split_at(states.len());
        let used: f64 = x.iter().zip(y).map(|(x, y)| x.hypot(*y)).sum();
        let bearing = if self.law.most() > 0.0 { self.law.most() } else { used };
        let forces = self.columns.iter().zip(&self.forces);
        let imbalance = forces.fold(0.0_f64, |worst, (column, force)| {
            let arm = column.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
            worst.max((force - dot(column, q)).abs() / (bearing * arm))
        });
        let violation = self.law.violation(r, states);
        Misfit { violation: if scale > 0.0 { violation / scale } else { 0.0 }, imbalance }
    }
}
