//! Tractions under Coulomb's law, by a semismooth Newton's method on the sets of sticking and slipping cells.
//!
//! In sliding, the tractions minimise ½ qᵀKq − qᵀg over the discs |q| ≤ μp, under the forces that are given: one
//! solution. A slipping cell keeps |q| = μp; along it, the curvature λ/μp of its disc adds to K. The method is that of
//! Zhao, Vollebregt & Oosterlee, J. Comput. Phys. 288 (2015) 86, doi:10.1016/j.jcp.2015.02.005 (TangCG), with Newton's
//! equations, forces and preconditioner derived here.

use std::ops::ControlFlow;

use crate::compliance::traction::TangentialWindow;
use crate::error::{Error, Result};
use crate::friction::coulomb::{CellState, Law, restrict};
use crate::friction::second_order::SecondOrder;
use crate::friction::step::RollingDirection;
use crate::numerics::dense::eliminate;
use crate::numerics::parallel::dot;
use crate::numerics::roots::bracketed;

/// What is asked for: A q = g + C δ where cells stick, Cᵀ q = forces.
pub(super) struct TractionProblem<'a> {
    pub(super) operator: Operator<'a>,
    pub(super) law: &'a Law,
    /// g
    pub(super) displacements: Vec<f64>,
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
    /// Largest error of a force or torque, over the largest that friction can carry.
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
/// of what is still missing to the tolerance. Chosen by trial: with 0.03 or 0.3 for the first, or 30 for the second, contacts
/// of 256² cells take up to a quarter more convolutions, with 3 for the second up to half as many again.
const INNER: [f64; 3] = [0.1, 300.0, 0.2];

/// Iterations of one linear system.
const MOST_INNER: usize = 200;

/// Steps without a better misfit before they are damped.
const PATIENCE: i32 = 5;

/// Damping at first, as a share of what a traction makes of its own cell. Chosen by trial: of five long contacts of stiff
/// coats, none converges with halves of steps instead; four do with 0.03 to 0.3 where progress divides damping by four, and
/// all with 0.3 or 1 where it halves it.
const DAMPING: f64 = 0.3;

/// Steps without a better misfit before Newton's method is given up. Chosen by trial.
const GIVING_UP: i32 = 25;

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
        let pairs = response.iter().zip(&self.displacements);
        let mismatch: Vec<f64> = pairs.map(|(u, g)| u - g).collect();
        // Cells at their bound slip, or at the δ of all others would slip along the traction and stick.
        let mut states = self.law.at_bound(q);
        let mut residual = mismatch.clone();
        self.operator.centre(&states, &mut residual);
        let multipliers = self.multipliers(weights, &states, &residual);
        residual.copy_from_slice(&mismatch);
        self.release(&mut residual, &multipliers);
        self.law.states(q, &residual, &mut states);
        if let Some(second_order) = self.operator.second_order {
            second_order.weigh(&self.law.bound, &residual, &mut states);
        }
        residual = mismatch;
        self.operator.centre(&states, &mut residual);
        let multipliers = self.multipliers(weights, &states, &residual);
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
            let columns = self.columns.clone();
            return NewtonSystem::new(self.operator, states, columns, 0.0).multipliers(r);
        }
        let mut weights = weights.to_vec();
        weights.iter_mut().for_each(|weight| restrict(states, weight));
        let right: Vec<f64> = weights.iter().map(|weight| dot(weight, r)).collect();
        small_system(&self.columns, &weights, &right)
    }

    /// Solves from the tractions `q`.
    ///
    /// Where hardly a cell sticks and tractions have one direction, the sets of Newton's method are sent to and fro: no cell
    /// is left whose displacement tells the motion. Then the motion is sought outside, with tractions for given motions.
    pub(super) fn solve(
        &self,
        q: Vec<f64>,
        effort: Effort,
        watch: &mut ConvolutionWatch,
    ) -> TractionResult {
        let solution = self.newton(q, effort, watch);
        let gave_up = !solution.stopped && solution.convolutions < effort.most;
        match self.worst_force(&solution.q) {
            Some(number) if gave_up && solution.misfit.worst() > effort.tolerance => {
                MotionSearch::new(self, number, solution, effort).run(watch)
            }
            _ => solution,
        }
    }

    /// Number of the force or torque with the largest error for the tractions `q`; `None` where none is given.
    fn worst_force(&self, q: &[f64]) -> Option<usize> {
        let numbers = 0..self.columns.len();
        numbers.max_by(|a, b| self.imbalance(*a, q).abs().total_cmp(&self.imbalance(*b, q).abs()))
    }

    /// Error of a force or torque for the tractions `q`, over the largest that friction can carry.
    fn imbalance(&self, number: usize, q: &[f64]) -> f64 {
        let column = &self.columns[number];
        let (x, y) = q.split_at(self.law.cells());
        let used = || x.iter().zip(y).map(|(x, y)| x.hypot(*y)).sum();
        let bearing = if self.law.most() > 0.0 { self.law.most() } else { used() };
        let arm = column.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
        (dot(column, q) - self.forces[number]) / (bearing * arm)
    }

    /// Newton's method from the tractions `q`. It gives up where it leads nowhere.
    fn newton(
        &self,
        mut q: Vec<f64>,
        effort: Effort,
        watch: &mut ConvolutionWatch,
    ) -> TractionResult {
        self.law.project(&self.law.at_bound(&q), &mut q);
        let mut response = vec![0.0; q.len()];
        let mut weights = self.columns.clone();
        let (mut convolutions, mut outer, mut stopped) = (0, 0, false);
        let (mut best, mut stalled, mut damping) = (f64::INFINITY, 0, 0.0);
        loop {
            let Standing { states, multipliers, mut residual, misfit } =
                self.stand(&q, &mut response, &weights);
            convolutions += 1;
            let left = effort.most.saturating_sub(convolutions);
            let good = misfit.worst() <= effort.tolerance;
            let ended = good || left == 0 || stalled > GIVING_UP;
            stopped |= !ended && watch(convolutions, misfit).is_break();
            if ended || stopped {
                return TractionResult { q, multipliers, states, misfit, convolutions, stopped };
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
            // Loose systems may send the sets to and fro; so may exact ones, and damped ones then lead on.
            stalled = if misfit.worst() < 0.9 * best { 0 } else { stalled + 1 };
            best = best.min(misfit.worst());
            let inner = (sought * 0.1_f64.powi(stalled)).max(floor);
            damping = match stalled {
                0 if damping > 0.1 * DAMPING => 0.5 * damping,
                0 => 0.0,
                _ if stalled > PATIENCE => DAMPING.max(2.0 * damping),
                _ => damping,
            };
            outer += 1;
            let columns = self.columns.clone();
            let mut linear = NewtonSystem::new(self.operator, &states, columns, damping);
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
            add(&mut q, 1.0, &d);
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
        let scale = if largest > 0.0 { largest } else { largest_of(&self.displacements) };
        let worst = self.worst_force(q);
        let imbalance = worst.map_or(0.0, |number| self.imbalance(number, q).abs());
        let violation = self.law.violation(r, states);
        Misfit { violation: if scale > 0.0 { violation / scale } else { 0.0 }, imbalance }
    }
}

/// Doublings of a bracket of motions; at the last ones all cells slip.
const DOUBLINGS: i32 = 60;

/// Search for one loaded degree of freedom δ, with tractions for given δ: their force grows with δ, from that at which all
/// cells slip one way to that at which all slip the other way.
struct MotionSearch<'p, 'a> {
    problem: &'p TractionProblem<'a>,
    /// Number of the degree of freedom.
    number: usize,
    /// The size of motions.
    unit: f64,
    /// The best of what was found.
    best: TractionResult,
    /// Tractions to start from.
    last: Vec<f64>,
    effort: Effort,
    /// Convolutions so far.
    done: usize,
    stopped: bool,
}

impl<'p, 'a> MotionSearch<'p, 'a> {
    fn new(
        problem: &'p TractionProblem<'a>,
        number: usize,
        solution: TractionResult,
        effort: Effort,
    ) -> Self {
        // What is given, and what a traction at its bound makes of its own cell.
        let [own, other] = problem.operator.diagonal();
        let size =
            largest_of(&problem.displacements) + own.max(other) * largest_of(&problem.law.bound);
        let unit = size / largest_of(&problem.columns[number]);
        let (last, done) = (solution.q.clone(), solution.convolutions);
        Self { problem, number, unit, best: solution, last, effort, done, stopped: false }
    }

    /// The tractions with the least misfit.
    fn run(mut self, watch: &mut ConvolutionWatch) -> TractionResult {
        for power in 0..DOUBLINGS {
            let end = 2.0_f64.powi(power);
            let root = bracketed(|motion| self.imbalance(motion, watch), [-end, end]);
            if !matches!(root, Ok(None)) {
                break;
            }
        }
        // Between two motions that differ by rounding, the set of sticking cells is known.
        let left = self.effort.most.saturating_sub(self.done);
        if !self.stopped && left > 0 && self.best.misfit.worst() > self.effort.tolerance {
            let (done, effort) = (self.done, Effort { most: left, ..self.effort });
            let problem = self.problem;
            let watch = &mut |count: usize, misfit: Misfit| watch(done + count, misfit);
            let solution = problem.newton(self.best.q.clone(), effort, watch);
            self.keep(solution);
        }
        TractionResult { convolutions: self.done, stopped: self.stopped, ..self.best }
    }

    /// Imbalance of the force at a motion, in units of its size; 0 where it is within the tolerance.
    ///
    /// # Errors
    /// [`Error::Stopped`] where the search must end.
    fn imbalance(&mut self, motion: f64, watch: &mut ConvolutionWatch) -> Result<f64> {
        let (problem, number, done) = (self.problem, self.number, self.done);
        let left = self.effort.most.saturating_sub(done);
        if self.stopped || left == 0 {
            return Err(Error::Stopped);
        }
        let delta = motion * self.unit;
        let (mut columns, mut forces) = (problem.columns.clone(), problem.forces.clone());
        let column = columns.remove(number);
        forces.remove(number);
        let mut displacements = problem.displacements.clone();
        add(&mut displacements, delta, &column);
        let (operator, law) = (problem.operator, problem.law);
        let part = TractionProblem { operator, law, displacements, columns, forces };
        let effort = Effort { most: left, ..self.effort };
        let watch = &mut |count: usize, misfit: Misfit| watch(done + count, misfit);
        let mut solution = part.newton(std::mem::take(&mut self.last), effort, watch);
        solution.multipliers.insert(number, delta);
        self.last.clone_from(&solution.q);
        let imbalance = problem.imbalance(number, &solution.q);
        solution.misfit.imbalance = solution.misfit.imbalance.max(imbalance.abs());
        self.keep(solution);
        Ok(if imbalance.abs() <= self.effort.tolerance { 0.0 } else { imbalance })
    }

    /// Counts the work of what was found, and keeps it where it is better.
    fn keep(&mut self, solution: TractionResult) {
        self.done += solution.convolutions;
        self.stopped |= solution.stopped;
        if solution.misfit.worst() <= self.best.misfit.worst() {
            self.best = solution;
        }
    }
}

/// The largest magnitude.
fn largest_of(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// From tractions to what must be given: displacements, or in rolling the change of displacement over a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Operator<'a> {
    pub(super) window: &'a TangentialWindow,
    /// Direction of steady rolling.
    pub(super) rolling: Option<RollingDirection>,
    /// Rolling to second order, steady or by a cell.
    pub(super) second_order: Option<&'a SecondOrder>,
    /// Whether slipping cells that hardly slip are preconditioned as sticking ones; not to first order in rolling, whose
    /// iterates stay what they were.
    pub(super) blends: bool,
}

impl Operator<'_> {
    /// K q, or in rolling u(x) − u(x + d), with u = K q; ahead of the window's last cells it is 0. To second order Γ q is
    /// added. Returns the largest component of K q.
    pub(super) fn apply(&self, q: &[f64], out: &mut [f64]) -> f64 {
        self.window.displace(q, out);
        let largest = out.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
        if let Some(direction) = self.rolling {
            self.difference(direction, out);
        }
        if let Some(second_order) = self.second_order {
            second_order.deviate(q, out);
        }
        largest
    }

    /// Takes residuals of half-points to the centres of slipping cells.
    fn centre(&self, states: &[CellState], r: &mut [f64]) {
        if let Some(second_order) = self.second_order {
            second_order.centre(states, r, 1.0);
        }
    }

    /// Replaces u by u(x) − u(x + d), d to the cell ahead.
    pub(super) fn difference(&self, direction: RollingDirection, u: &mut [f64]) {
        for line in self.lines(direction) {
            let mut ahead = line.clone().skip(1);
            for here in line {
                u[here] -= ahead.next().map_or(u[here], |ahead| u[ahead]);
            }
        }
    }

    /// Sums from the leading edge on, which turn differences back into u; each cell divides what has come to it by its
    /// factor.
    fn sums(&self, direction: RollingDirection, factors: &[f64], u: &mut [f64]) {
        for line in self.lines(direction) {
            let mut sum = 0.0;
            for here in line.rev() {
                sum = (sum + u[here]) / factors[here % factors.len()];
                u[here] = sum;
            }
        }
    }

    /// Places in a field of the cells of each line along the direction of rolling, from the trailing edge on.
    fn lines(
        &self,
        direction: RollingDirection,
    ) -> impl Iterator<Item = impl DoubleEndedIterator<Item = usize> + Clone> {
        let [nx, ny] = self.window.shape;
        let (lines, length, between, along) = match direction.axis() {
            0 => (ny, nx, 1, ny),
            _ => (nx, ny, ny, 1),
        };
        let is_forward = direction.is_forward();
        (0..2 * lines).map(move |line| {
            let first = line / lines * nx * ny + line % lines * between;
            (0..length).map(move |k| {
                let k = if is_forward { k } else { length - 1 - k };
                first + k * along
            })
        })
    }

    /// Diagonal for tractions along x and along y.
    fn diagonal(&self) -> [f64; 2] {
        match self.rolling {
            None => self.window.own,
            Some(direction) => self.window.ahead[direction.axis()],
        }
    }

    /// Π (A + weights + `damping` diag A) Π d, for d within the range of Π.
    fn linearised(&self, states: &[CellState], damping: f64, d: &[f64], out: &mut [f64]) {
        self.apply(d, out);
        if let Some(second_order) = self.second_order {
            second_order.centre(states, out, 0.0);
        }
        let (cells, own) = (states.len(), self.diagonal());
        for (i, state) in states.iter().enumerate() {
            let weight = if let CellState::Slip { weight, .. } = state { *weight } else { 0.0 };
            out[i] += (weight + damping * own[0]) * d[i];
            out[cells + i] += (weight + damping * own[1]) * d[cells + i];
        }
        restrict(states, out);
    }

    /// An approximate inverse of [`Operator::linearised`].
    ///
    /// ```text
    /// z = Π √σ P √σ Π Σ √σ r + (1 − σ)² r/((1 + damping) a + λ/μp)      σ = 1/(1 + λ/μp a)
    /// ```
    ///
    /// P is the inverse on the whole plane, a the diagonal of A across the traction. Σ in rolling are the sums from the leading
    /// edge, u = (u ahead + r)/(1 + λ/μp k) with the diagonal k of K across the traction: where A q + (λ/μp) q = r and
    /// u = K q, the differences of u and (λ/μp k) u make up r. Plain sums, which forget the second term, make tractions too
    /// large that are alike along a line and change from line to line, by up to the cells of a line: on 512² cells rolling
    /// then takes two to nine times as many iterations. Sticking cells have σ = 1. A slipping cell with little slip is coupled to the others as a sticking one, and
    /// one with much slip, λ/μp ≫ a, is alone: σ is the share of a in their sum. Without Π after the sums, what they carry
    /// into the directions of slip comes back: Carter's problem takes fifty times as many iterations. Derived here.
    fn precondition(
        &self,
        states: &[CellState],
        damping: f64,
        r: &[f64],
        memory: &mut [f64],
        z: &mut [f64],
    ) {
        let (cells, own) = (states.len(), self.diagonal());
        let component = |own: [f64; 2], n: &[f64; 2]| own[0] * n[1] * n[1] + own[1] * n[0] * n[0];
        let across = |n: &[f64; 2]| component(own, n);
        let roots: Vec<f64> = (states.iter())
            .map(|state| match state {
                CellState::Free => 0.0,
                CellState::Stick => 1.0,
                CellState::Slip { n, weight, .. } if self.blends => {
                    (1.0 + weight / across(n)).recip().sqrt()
                }
                CellState::Slip { .. } => 0.0,
            })
            .collect();
        let weigh = |field: &mut [f64]| {
            let (x, y) = field.split_at_mut(cells);
            for ((x, y), root) in x.iter_mut().zip(y).zip(&roots) {
                (*x, *y) = (*x * root, *y * root);
            }
        };
        // Places of sticking leading cells, a/(a + Γ) along their axes.
        let sticking: Vec<(usize, f64)> = (self.second_order.into_iter())
            .flat_map(SecondOrder::leading)
            .filter(|(i, _)| states[*i] == CellState::Stick)
            .flat_map(|(i, gamma)| [0, 1].map(|k| (k * cells + i, own[k] / (own[k] + gamma[k]))))
            .collect();
        memory.copy_from_slice(r);
        weigh(memory);
        sticking.iter().for_each(|(place, share)| memory[*place] *= share);
        if let Some(direction) = self.rolling {
            let factors: Vec<f64> = (states.iter())
                .map(|state| match state {
                    CellState::Slip { n, weight, .. } if self.blends => {
                        1.0 + weight / component(self.window.own, n)
                    }
                    _ => 1.0,
                })
                .collect();
            self.sums(direction, &factors, memory);
            restrict(states, memory);
            weigh(memory);
        }
        self.window.precondition(memory, z);
        weigh(z);
        restrict(states, z);
        for (place, share) in sticking {
            // Γ/(a + Γ)² = (1 − share) share/a
            let own = own[place / cells];
            z[place] = share * (z[place] + (1.0 - share) / own * r[place]);
        }
        for (i, state) in states.iter().enumerate() {
            if let CellState::Slip { n, weight, .. } = state {
                let alone = 1.0 - roots[i] * roots[i];
                let factor = alone * alone / ((1.0 + damping) * across(n) + weight);
                z[i] += factor * r[i];
                z[cells + i] += factor * r[cells + i];
            }
        }
    }
}

/// Vectors between restarts.
const RESTART: usize = 40;

/// One linear system of Newton's method, solved by GMRES that keeps forces.
///
/// ```text
/// (A + weights + damping) d − C δ = b      Cᵀ d = c
/// ```
///
/// Damping holds back tractions that displace little, such as short waves on a stiff coat (Levenberg, Q. Appl. Math. 2 (1944)
/// 164). M approximates the inverse. With S = Cᵀ M C, the operator G = M − M C S⁻¹ Cᵀ M makes nothing that has a force, Cᵀ G = 0, and
/// G C = 0: GMRES on G A d = G b leaves C δ free and keeps Cᵀ d. Saad, Iterative Methods for Sparse Linear Systems,
/// 2nd ed., SIAM (2003), §6.5 and §14; the preconditioner for rolling is derived here.
struct NewtonSystem<'a> {
    operator: Operator<'a>,
    states: &'a [CellState],
    damping: f64,
    /// Columns C of the loaded degrees of freedom, within the range of Π.
    columns: Vec<Vec<f64>>,
    /// M C
    preconditioned: Vec<Vec<f64>>,
    memory: Vec<f64>,
}

impl<'a> NewtonSystem<'a> {
    /// The system for `columns` that are restricted here.
    fn new(
        operator: Operator<'a>,
        states: &'a [CellState],
        whole_columns: Vec<Vec<f64>>,
        damping: f64,
    ) -> Self {
        let size = 2 * states.len();
        let (memory, [columns, preconditioned]) = (vec![0.0; size], [Vec::new(), Vec::new()]);
        let mut linear = Self { operator, states, damping, columns, preconditioned, memory };
        for mut column in whole_columns {
            restrict(states, &mut column);
            let mut z = vec![0.0; size];
            linear.precondition(&column, &mut z);
            linear.columns.push(column);
            linear.preconditioned.push(z);
        }
        linear
    }

    fn precondition(&mut self, r: &[f64], z: &mut [f64]) {
        self.operator.precondition(self.states, self.damping, r, &mut self.memory, z);
    }

    /// Coefficients y with S y = `right`; 0 for columns that are 0.
    fn small(&self, right: &[f64]) -> Vec<f64> {
        small_system(&self.preconditioned, &self.columns, right)
    }

    /// Replaces z = M r by G r.
    fn project(&self, z: &mut [f64]) {
        let (columns, preconditioned) = (&self.columns, &self.preconditioned);
        let forces: Vec<f64> = columns.iter().map(|c| dot(c, z)).collect();
        for (y, column) in self.small(&forces).into_iter().zip(preconditioned) {
            add(z, -y, column);
        }
    }

    /// δ with which M (r − C δ) has no force.
    pub(super) fn multipliers(&mut self, r: &[f64]) -> Vec<f64> {
        let mut restricted = r.to_vec();
        restrict(self.states, &mut restricted);
        let mut z = vec![0.0; r.len()];
        self.precondition(&restricted, &mut z);
        let columns = self.columns.iter();
        let forces: Vec<f64> = columns.map(|c| dot(c, &z)).collect();
        self.small(&forces)
    }

    /// M C, which weighs the residuals of cells.
    pub(super) fn into_weights(self) -> Vec<Vec<f64>> {
        self.preconditioned
    }

    /// d for the right side `b`, restricted, and the forces `c`. It iterates until the residual, as M weighs it, has
    /// fallen to `tolerance` of its start, at most `most` times. `watch` is told each iteration.
    pub(super) fn solve(
        &mut self,
        b: &[f64],
        c: &[f64],
        tolerance: f64,
        most: usize,
        watch: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> (Vec<f64>, usize) {
        let size = b.len();
        let mut d = vec![0.0; size];
        for (y, column) in self.small(c).into_iter().zip(&self.preconditioned) {
            add(&mut d, y, column);
        }
        let (mut r, mut z) = (vec![0.0; size], vec![0.0; size]);
        let moved = d.iter().any(|d| *d != 0.0);
        let (mut iterations, mut start) = (usize::from(moved), None);
        loop {
            if d.iter().any(|d| *d != 0.0) {
                self.operator.linearised(self.states, self.damping, &d, &mut r);
                r.iter_mut().zip(b).for_each(|(r, b)| *r = b - *r);
            } else {
                r.copy_from_slice(b);
            }
            self.precondition(&r, &mut z);
            self.project(&mut z);
            let norm = dot(&z, &z).sqrt();
            let goal = tolerance * *start.get_or_insert(norm);
            if norm <= goal || norm == 0.0 || iterations >= most {
                return (d, iterations);
            }
            let mut basis = vec![z.iter().map(|z| z / norm).collect::<Vec<f64>>()];
            let mut least = LeastSquares::new(norm);
            let mut stop = false;
            while basis.len() <= RESTART && iterations < most && !stop {
                let last = &basis[basis.len() - 1];
                self.operator.linearised(self.states, self.damping, last, &mut r);
                self.precondition(&r, &mut z);
                self.project(&mut z);
                iterations += 1;
                let mut column: Vec<f64> = Vec::with_capacity(basis.len() + 1);
                for v in &basis {
                    let h = dot(v, &z);
                    add(&mut z, -h, v);
                    column.push(h);
                }
                let norm = dot(&z, &z).sqrt();
                column.push(norm);
                stop = watch().is_break();
                let residual = least.add(column);
                if residual <= goal || norm <= 1e-300 {
                    break;
                }
                basis.push(z.iter().map(|z| z / norm).collect());
            }
            for (y, v) in least.solve().into_iter().zip(&basis) {
                add(&mut d, y, v);
            }
            if least.residual <= goal || iterations >= most || stop {
                return (d, iterations);
            }
        }
    }
}

/// Coefficients y with Σ_l (c_k · z_l) y_l = `right`_k; 0 for columns that are 0.
pub(super) fn small_system(z: &[Vec<f64>], columns: &[Vec<f64>], right: &[f64]) -> Vec<f64> {
    let row = |c: &Vec<f64>| z.iter().map(|z| dot(c, z)).collect();
    let mut matrix: Vec<Vec<f64>> = columns.iter().map(row).collect();
    let mut y = right.to_vec();
    eliminate(&mut matrix, &mut y, |_, _| true);
    y
}

/// to += factor · from
fn add(to: &mut [f64], factor: f64, from: &[f64]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to += factor * from);
}

/// The least squares of GMRES, kept triangular by Givens's rotations.
struct LeastSquares {
    columns: Vec<Vec<f64>>,
    rotations: Vec<[f64; 2]>,
    right: Vec<f64>,
    residual: f64,
}

impl LeastSquares {
    fn new(norm: f64) -> Self {
        Self { columns: Vec::new(), rotations: Vec::new(), right: vec![norm], residual: norm }
    }

    /// Adds a column of Hessenberg's matrix, and returns the residual.
    fn add(&mut self, mut column: Vec<f64>) -> f64 {
        for (k, [c, s]) in self.rotations.iter().enumerate() {
            let (a, b) = (column[k], column[k + 1]);
            (column[k], column[k + 1]) = (c * a + s * b, c * b - s * a);
        }
        let k = self.rotations.len();
        let (a, b) = (column[k], column[k + 1]);
        let length = a.hypot(b);
        let [c, s] = if length > 0.0 { [a / length, b / length] } else { [1.0, 0.0] };
        column[k] = length;
        column.truncate(k + 1);
        let last = self.right[k];
        self.right[k] = c * last;
        self.right.push(-s * last);
        self.rotations.push([c, s]);
        self.columns.push(column);
        self.residual = (s * last).abs();
        self.residual
    }

    fn solve(&self) -> Vec<f64> {
        let n = self.columns.len();
        let mut y = vec![0.0; n];
        for k in (0..n).rev() {
            let rest: f64 = (k + 1..n).map(|m| self.columns[m][k] * y[m]).sum();
            let pivot = self.columns[k][k];
            y[k] = if pivot == 0.0 { 0.0 } else { (self.right[k] - rest) / pivot };
        }
        y
    }
}
