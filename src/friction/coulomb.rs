//! Coulomb's law in the cells of a window: states, bounds and what may change.

/// What a cell does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum CellState {
    /// Outside the contact, or without friction.
    Free,
    Stick,
    /// Slip along the unit vector n of the traction, q = μp n. `weight` is λ/μp, where the residual of the slip is −λ n;
    /// `centring` is φ of second order.
    Slip {
        n: [f64; 2],
        weight: f64,
        centring: f64,
    },
}

/// Coulomb's law in the cells of a window: |q| ≤ μp; no slip below the bound; slip against the traction at it.
#[derive(Debug)]
pub(super) struct Law {
    /// μp of each cell, 0 outside the contact \[Pa\].
    pub(super) bound: Vec<f64>,
}

/// Traction relative to its bound from which on a cell slips: it was set to the bound, but for rounding.
const AT_BOUND: f64 = 1.0 - 1e-12;

impl Law {
    pub(super) fn cells(&self) -> usize {
        self.bound.len()
    }

    /// Largest force that all cells together carry, over the area of a cell.
    pub(super) fn most(&self) -> f64 {
        self.bound.iter().sum()
    }

    /// Moves each traction to the nearest one within its bound. Tractions of slipping cells are set to it.
    pub(super) fn project(&self, states: &[CellState], q: &mut [f64]) {
        let (x, y) = q.split_at_mut(self.cells());
        for (((x, y), bound), state) in x.iter_mut().zip(y).zip(&self.bound).zip(states) {
            let size = x.hypot(*y);
            match state {
                CellState::Free => (*x, *y) = (0.0, 0.0),
                CellState::Slip { n, .. } if size <= 0.0 => (*x, *y) = (bound * n[0], bound * n[1]),
                CellState::Stick if size <= *bound => {}
                _ => (*x, *y) = (bound * (*x / size), bound * (*y / size)),
            }
        }
    }

    /// States at the tractions q alone: all cells at their bound slip.
    pub(super) fn at_bound(&self, q: &[f64]) -> Vec<CellState> {
        let (x, y) = q.split_at(self.cells());
        let state = |((bound, x), y): ((&f64, &f64), &f64)| {
            let size = x.hypot(*y);
            match *bound > 0.0 {
                false => CellState::Free,
                true if size >= AT_BOUND * bound => {
                    CellState::Slip { n: [x / size, y / size], weight: 0.0, centring: 1.0 }
                }
                true => CellState::Stick,
            }
        };
        self.bound.iter().zip(x).zip(y).map(state).collect()
    }

    /// States at the tractions q with the residuals r = −s: cells at their bound slip unless that would be along the
    /// traction.
    pub(super) fn states(&self, q: &[f64], r: &[f64], states: &mut [CellState]) {
        let cells = self.cells();
        for (i, state) in states.iter_mut().enumerate() {
            let bound = self.bound[i];
            if bound <= 0.0 {
                *state = CellState::Free;
                continue;
            }
            let (q, r) = ([q[i], q[cells + i]], [r[i], r[cells + i]]);
            let size = q[0].hypot(q[1]);
            *state = CellState::Stick;
            if size >= AT_BOUND * bound {
                let n = q.map(|q| q / size);
                let lambda = -(r[0] * n[0] + r[1] * n[1]);
                if lambda >= 0.0 {
                    let weight = lambda / bound;
                    *state = CellState::Slip { n, weight, centring: 1.0 };
                }
            }
        }
    }

    /// Largest residual: of sticking cells the slip, of slipping cells the part across the traction.
    pub(super) fn violation(&self, r: &[f64], states: &[CellState]) -> f64 {
        let (x, y) = r.split_at(self.cells());
        let mut worst = 0.0_f64;
        for ((x, y), state) in x.iter().zip(y).zip(states) {
            worst = worst.max(match state {
                CellState::Free => 0.0,
                CellState::Stick => x.hypot(*y),
                CellState::Slip { n, .. } => (y * n[0] - x * n[1]).abs(),
            });
        }
        worst
    }
}

/// Restricts a field to what may change: both components of sticking cells, that across the traction of slipping ones.
pub(super) fn restrict(states: &[CellState], field: &mut [f64]) {
    let (x, y) = field.split_at_mut(states.len());
    for ((x, y), state) in x.iter_mut().zip(y).zip(states) {
        match state {
            CellState::Free => (*x, *y) = (0.0, 0.0),
            CellState::Stick => {}
            CellState::Slip { n, .. } => {
                let across = *y * n[0] - *x * n[1];
                (*x, *y) = (-across * n[1], across * n[0]);
            }
        }
    }
}
