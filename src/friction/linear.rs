//! The linear systems of Newton's method: GMRES that keeps forces.
//!
//! ```text
//! A d − C δ = b      Cᵀ d = c
//! ```
//!
//! M approximates A⁻¹. With S = Cᵀ M C, the operator G = M − M C S⁻¹ Cᵀ M makes nothing that has a force, Cᵀ G = 0, and
//! G C = 0: GMRES on G A d = G b leaves C δ free and keeps Cᵀ d. Saad, Iterative Methods for Sparse Linear Systems,
//! 2nd ed., SIAM (2003), §6.5 and §14; the preconditioner for rolling is derived here.

use std::ops::ControlFlow;

use super::law::{CellState, restrict};
use super::step::RollingDirection;
use crate::compliance::traction::TangentialWindow;
use crate::numerics::dense::eliminate;
use crate::numerics::parallel::dot;

/// From tractions to what must be given: displacements, or in rolling the change of displacement over a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Operator<'a> {
    pub(super) window: &'a TangentialWindow,
    pub(super) rolling: Option<RollingDirection>,
}

impl Operator<'_> {
    /// K q, or in rolling u(x) − u(x + d), with u = K q; ahead of the window's last cells it is 0. Returns the largest
    /// component of K q.
    pub(super) fn apply(&self, q: &[f64], out: &mut [f64]) -> f64 {
        self.window.displace(q, out);
        let largest = out.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
        if let Some(direction) = self.rolling {
            self.difference(direction, out);
        }
        largest
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

    /// Sums from the leading edge on, which turn differences back into u.
    fn sums(&self, direction: RollingDirection, u: &mut [f64]) {
        for line in self.lines(direction) {
            let mut sum = 0.0;
            for here in line.rev() {
                sum += u[here];
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

    /// Π (A + weights) Π d, for d within the range of Π.
    pub(super) fn linearised(&self, states: &[CellState], d: &[f64], out: &mut [f64]) {
        self.apply(d, out);
        let cells = states.len();
        for (i, state) in states.iter().enumerate() {
            if let CellState::Slip { weight, .. } = state {
                out[i] += weight * d[i];
                out[cells + i] += weight * d[cells + i];
            }
        }
        restrict(states, out);
    }

    /// An approximate inverse of [`Operator::linearised`]: that of the whole plane on sticking cells, in rolling after
    /// sums from the leading edge, and the diagonal's on slipping ones.
    pub(super) fn precondition(
        &self,
        states: &[CellState],
        r: &[f64],
        memory: &mut [f64],
        z: &mut [f64],
    ) {
        let cells = states.len();
        memory.copy_from_slice(r);
        let only_stick = |field: &mut [f64]| {
            for (i, state) in states.iter().enumerate() {
                if *state != CellState::Stick {
                    field[i] = 0.0;
                    field[cells + i] = 0.0;
                }
            }
        };
        only_stick(memory);
        if let Some(direction) = self.rolling {
            self.sums(direction, memory);
            only_stick(memory);
        }
        self.window.precondition(memory, z);
        only_stick(z);
        let own = self.diagonal();
        for (i, state) in states.iter().enumerate() {
            if let CellState::Slip { n, weight } = state {
                let along = own[0] * n[1] * n[1] + own[1] * n[0] * n[0];
                let factor = 1.0 / (along + weight);
                z[i] = factor * r[i];
                z[cells + i] = factor * r[cells + i];
            }
        }
    }
}

/// Vectors between restarts.
const RESTART: usize = 40;

/// Columns C of the loaded degrees of freedom, within the range of Π, and M C.
#[derive(Debug, Default)]
pub(super) struct Constraints {
    pub(super) columns: Vec<Vec<f64>>,
    preconditioned: Vec<Vec<f64>>,
}

/// One linear system.
pub(super) struct NewtonSystem<'a> {
    pub(super) operator: Operator<'a>,
    pub(super) states: &'a [CellState],
    pub(super) constraints: Constraints,
    memory: Vec<f64>,
}

impl<'a> NewtonSystem<'a> {
    /// The system for `columns` that are restricted here.
    pub(super) fn new(
        operator: Operator<'a>,
        states: &'a [CellState],
        columns: Vec<Vec<f64>>,
    ) -> Self {
        let size = 2 * states.len();
        let mut linear =
            Self { operator, states, constraints: Constraints::default(), memory: vec![0.0; size] };
        for mut column in columns {
            restrict(states, &mut column);
            let mut z = vec![0.0; size];
            linear.precondition(&column, &mut z);
            linear.constraints.columns.push(column);
            linear.constraints.preconditioned.push(z);
        }
        linear
    }

    fn precondition(&mut self, r: &[f64], z: &mut [f64]) {
        self.operator.precondition(self.states, r, &mut self.memory, z);
    }

    /// Coefficients y with S y = `right`; 0 for columns that are 0.
    fn small(&self, right: &[f64]) -> Vec<f64> {
        small_system(&self.constraints.preconditioned, &self.constraints.columns, right)
    }

    /// Replaces z = M r by G r.
    fn project(&self, z: &mut [f64]) {
        let Constraints { columns, preconditioned } = &self.constraints;
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
        let columns = self.constraints.columns.iter();
        let forces: Vec<f64> = columns.map(|c| dot(c, &z)).collect();
        self.small(&forces)
    }

    /// M C, which weighs the residuals of cells.
    pub(super) fn into_weights(self) -> Vec<Vec<f64>> {
        self.constraints.preconditioned
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
        for (y, column) in self.small(c).into_iter().zip(&self.constraints.preconditioned) {
            add(&mut d, y, column);
        }
        let (mut r, mut z) = (vec![0.0; size], vec![0.0; size]);
        let moved = d.iter().any(|d| *d != 0.0);
        let (mut iterations, mut start) = (usize::from(moved), None);
        loop {
            if d.iter().any(|d| *d != 0.0) {
                self.operator.linearised(self.states, &d, &mut r);
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
                self.operator.linearised(self.states, last, &mut r);
                self.precondition(&r, &mut z);
                self.project(&mut z);
                iterations += 1;
                let mut column: Vec<f64> = Vec::with_capacity(basis.len() + 1);
                for v in &basis {
                    let h = dot(v, &z);
                    add(&mut z, -h, v);
                    column.push(h);
                }
                let rest = dot(&z, &z).sqrt();
                column.push(rest);
                stop = watch().is_break();
                let residual = least.add(column);
                if residual <= goal || rest <= 1e-300 {
                    break;
                }
                basis.push(z.iter().map(|z| z / rest).collect());
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
