//! Tractions, displacements and slip on the whole grid, and how well the laws hold there.

use ndarray::Array2;

use super::law::State;
use super::solution::TangentialMotion;
use super::step::Freedom;
use super::task::{Solved, Task, ahead, each};
use crate::compliance::traction::Tangential;
use crate::contact::Warning;
use crate::model::grid::Grid;

/// Tractions, displacements and slip of the whole grid.
pub(super) struct Fields {
    pub(super) traction: [Array2<f64>; 2],
    pub(super) displacement: [Array2<f64>; 2],
    pub(super) slip: [Array2<f64>; 2],
    pub(super) motion: TangentialMotion,
    pub(super) violation: f64,
    pub(super) excess: f64,
    pub(super) full_slip: bool,
}

/// Creepage or twist from which on their squares, of which half is left out, are 5 % of them.
const LARGE: f64 = 0.1;

impl Fields {
    pub(super) fn are_finite(&self) -> bool {
        let fields = [&self.traction, &self.displacement, &self.slip];
        let motion = match self.motion {
            TangentialMotion::Slide {
                shift: [x, y],
                twist,
            } => [x, y, twist],
            TangentialMotion::Roll {
                creepage: [x, y],
                spin,
                ..
            } => [x, y, spin],
        };
        let mut values = fields.into_iter().flatten().flatten().chain(&motion);
        values.all(|value| value.is_finite())
    }

    /// The warning of creepages or a twist that are not small, where `pressure` is.
    pub(super) fn warning(
        &self,
        task: &Task,
        grid: &Grid,
        pressure: &Array2<f64>,
    ) -> Option<Warning> {
        let TangentialMotion::Roll { creepage, spin, .. } = self.motion else {
            let TangentialMotion::Slide { twist, .. } = self.motion else {
                return None;
            };
            return (twist.abs() > LARGE).then_some(Warning::LargeMotion { size: twist.abs() });
        };
        let (x, y) = (grid.x(), grid.y());
        let touching = pressure.indexed_iter().filter(|(_, p)| **p > 0.0);
        let size = touching.fold(0.0_f64, |most, ((i, j), _)| {
            let unit = task.unit_motions([x[i], y[j]]);
            let along = |axis: usize| {
                creepage[0] * unit[0][axis] + creepage[1] * unit[1][axis] + spin * unit[2][axis]
            };
            most.max(along(0).hypot(along(1)))
        });
        (size > LARGE).then_some(Warning::LargeMotion { size })
    }

    /// Brings back the state before the step, where there was one: the history can go on from there.
    pub(super) fn restore(&mut self, task: &Task) {
        let (Task::Slide { before, .. }
        | Task::Roll {
            before: Some(before),
            ..
        }) = task
        else {
            return;
        };
        self.traction.clone_from(&before.traction);
        self.displacement.clone_from(&before.displacement);
        self.slip.iter_mut().for_each(|s| s.fill(0.0));
        if let TangentialMotion::Slide { shift, twist } = &mut self.motion {
            (*shift, *twist) = (before.shift, before.twist);
        }
    }
}

impl Task<'_> {
    /// Fields on the whole grid, with the operator of the whole grid.
    pub(super) fn fields(
        &self,
        tangential: &Tangential,
        (grid, bound, pressure): (&Grid, &Array2<f64>, &Array2<f64>),
        solved: Option<&Solved>,
    ) -> Fields {
        let shape = grid.shape();
        let spacing = grid.spacing();
        let mut traction = [(); 2].map(|()| Array2::<f64>::zeros(shape));
        let mut moved = self.increments(spacing).map(|freedom| match freedom {
            Freedom::Prescribed(value) => value,
            _ => 0.0,
        });
        if let Some(solved) = solved {
            moved = solved.moved;
            let cells = solved.operators.cells();
            for (at, (i, j)) in each(&solved.window).enumerate() {
                for (axis, q) in traction.iter_mut().enumerate() {
                    q[[i, j]] = solved.outcome.q[axis * cells + at];
                }
            }
        }
        let whole = tangential.window(shape);
        let q: Vec<f64> = traction.iter().flatten().copied().collect();
        let mut own = vec![0.0; q.len()];
        whole.displace(&q, &mut own);
        let p: Vec<f64> = pressure.iter().copied().collect();
        let spread = whole.spread(&p);
        let (cells, columns) = (whole.cells(), shape[1]);
        let field = |values: &dyn Fn(usize) -> f64| {
            Array2::from_shape_fn(shape, |(i, j)| values(i * columns + j))
        };
        let displacement =
            [0, 1].map(|axis| field(&|at| own[axis * cells + at] + spread[axis * cells + at]));
        // The change of displacement that slip makes up for, and the part of the tractions in it.
        let change =
            |u: &dyn Fn(usize, [usize; 2]) -> f64, axis: usize, cell: [usize; 2]| match self
                .steady()
            {
                None => u(axis, cell),
                Some(direction) => {
                    u(axis, cell) - u(axis, ahead(direction, cell, &displacement[0]))
                }
            };
        let total = |axis: usize, cell: [usize; 2]| displacement[axis][cell];
        let of_traction = |axis: usize, [i, j]: [usize; 2]| own[axis * cells + i * columns + j];
        let (x, y) = (grid.x(), grid.y());
        let unit = match self {
            Self::Slide { .. } => 1.0,
            Self::Roll { rolling, .. } => 1.0 / spacing[rolling.direction.direction().axis],
        };
        let mut slip = [(); 2].map(|()| Array2::<f64>::zeros(shape));
        let (mut violation, mut scale, mut excess, mut most) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        let mut full_slip = solved.is_some();
        let states = solved.map(|solved| &solved.outcome.states);
        let mut windowed = states.into_iter().flatten();
        let window = solved.map_or([0..0, 0..0], |solved| solved.window.clone());
        for (i, j) in each(&window) {
            let Some(state) = windowed.next() else { break };
            if *state == State::Free {
                continue;
            }
            let motions = self.unit_motions([x[i], y[j]]);
            let earlier = self.earlier([i, j]);
            let s = [0, 1].map(|axis| {
                let rigid: f64 = moved
                    .iter()
                    .zip(motions)
                    .map(|(by, motion)| by * motion[axis])
                    .sum();
                rigid + earlier[axis] - change(&total, axis, [i, j])
            });
            let own = [0, 1].map(|axis| of_traction(axis, [i, j]));
            scale = scale.max(own[0].hypot(own[1]));
            let q = [0, 1].map(|axis| traction[axis][[i, j]]);
            excess = excess.max(q[0].hypot(q[1]) - bound[[i, j]]);
            most = most.max(bound[[i, j]]);
            violation = violation.max(match state {
                State::Slip { n, .. } => (s[1] * n[0] - s[0] * n[1]).abs(),
                _ => s[0].hypot(s[1]),
            });
            full_slip &= matches!(state, State::Slip { .. });
            for (field, s) in slip.iter_mut().zip(s) {
                field[[i, j]] = s * unit;
            }
        }
        let motion = match self {
            Self::Slide { before, .. } => TangentialMotion::Slide {
                shift: [before.shift[0] + moved[0], before.shift[1] + moved[1]],
                twist: before.twist + moved[2],
            },
            Self::Roll { rolling, .. } => TangentialMotion::Roll {
                creepage: [moved[0] * unit, moved[1] * unit],
                spin: rolling.spin,
                direction: rolling.direction,
            },
        };
        Fields {
            traction,
            displacement,
            slip,
            motion,
            violation: if scale > 0.0 { violation / scale } else { 0.0 },
            excess: if most > 0.0 {
                excess.max(0.0) / most
            } else {
                0.0
            },
            full_slip,
        }
    }
}
