//! The operators of sliding and of rolling, on the cells that may change.

use super::law::{State, restrict};
use crate::compliance::traction::TangentialWindow;

/// Direction of rolling: an axis, and the sign of the direction in which the leading edge lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Direction {
    pub(super) axis: usize,
    pub(super) forward: bool,
}

/// From tractions to what must be given: displacements, or in rolling the change of displacement over a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Operator<'a> {
    pub(super) window: &'a TangentialWindow,
    pub(super) rolling: Option<Direction>,
}

impl Operator<'_> {
    /// K q, or in rolling u(x) − u(x + d), with u = K q. Ahead of the window's last cells it is 0.
    pub(super) fn apply(&self, q: &[f64], out: &mut [f64]) {
        self.window.displace(q, out);
        if let Some(direction) = self.rolling {
            self.difference(direction, out);
        }
    }

    /// [`Operator::apply`], and the largest component of K q.
    pub(super) fn apply_measured(&self, q: &[f64], out: &mut [f64]) -> f64 {
        self.window.displace(q, out);
        let largest = out.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
        if let Some(direction) = self.rolling {
            self.difference(direction, out);
        }
        largest
    }

    /// Replaces u by u(x) − u(x + d), d to the cell ahead.
    pub(super) fn difference(&self, direction: Direction, u: &mut [f64]) {
        self.sweep(direction, u, |here, ahead| here - ahead.unwrap_or(here));
    }

    /// Replaces each value by a function of it and of that ahead, from the trailing edge on.
    fn sweep(&self, direction: Direction, u: &mut [f64], f: impl Fn(f64, Option<f64>) -> f64) {
        let [nx, ny] = self.window.shape;
        let (lines, length, between, along) = match direction.axis {
            0 => (ny, nx, 1, ny),
            _ => (nx, ny, ny, 1),
        };
        for part in u.chunks_exact_mut(nx * ny) {
            for line in 0..lines {
                let at = |k: usize| {
                    let k = if direction.forward { k } else { length - 1 - k };
                    line * between + k * along
                };
                for k in 0..length {
                    let ahead = (k + 1 < length).then(|| part[at(k + 1)]);
                    part[at(k)] = f(part[at(k)], ahead);
                }
            }
        }
    }

    /// Sums from the leading edge on, which turn differences back into u.
    fn sums(&self, direction: Direction, u: &mut [f64]) {
        let [nx, ny] = self.window.shape;
        let (lines, length, between, along) = match direction.axis {
            0 => (ny, nx, 1, ny),
            _ => (nx, ny, ny, 1),
        };
        for part in u.chunks_exact_mut(nx * ny) {
            for line in 0..lines {
                let mut sum = 0.0;
                for k in (0..length).rev() {
                    let k = if direction.forward { k } else { length - 1 - k };
                    let at = line * between + k * along;
                    sum += part[at];
                    part[at] = sum;
                }
            }
        }
    }

    /// Diagonal for tractions along x and along y.
    fn diagonal(&self) -> [f64; 2] {
        match self.rolling {
            None => self.window.own,
            Some(direction) => self.window.ahead[direction.axis],
        }
    }

    /// Π (A + weights) Π d, for d within the range of Π.
    pub(super) fn linearised(&self, states: &[State], d: &[f64], out: &mut [f64]) {
        self.apply(d, out);
        let cells = states.len();
        for (i, state) in states.iter().enumerate() {
            if let State::Slip { weight, .. } = state {
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
        states: &[State],
        r: &[f64],
        memory: &mut [f64],
        z: &mut [f64],
    ) {
        let cells = states.len();
        memory.copy_from_slice(r);
        let only_stick = |field: &mut [f64]| {
            for (i, state) in states.iter().enumerate() {
                if *state != State::Stick {
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
            if let State::Slip { n, weight } = state {
                let along = own[0] * n[1] * n[1] + own[1] * n[0] * n[0];
                let factor = 1.0 / (along + weight);
                z[i] = factor * r[i];
                z[cells + i] = factor * r[cells + i];
            }
        }
    }
}
