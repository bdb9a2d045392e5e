//! One tangential problem on the window of a contact: sliding in one step, rolling at constant speed, or rolling by one
//! cell.

use std::sync::Arc;

use ndarray::{Array2, Axis};

use super::law::{Law, State};
use super::linear::{Direction, Operator};
use super::newton::{Effort, Outcome, Problem, Watch};
use super::solution::TangentialMotion;
use super::step::{Freedom, Freedoms, Friction, Rolling, RollingDirection};
use crate::compliance::traction::{Tangential, TangentialWindow};
use crate::contact::Warning;
use crate::error::{Error, Result};
use crate::model::grid::{Grid, Window};

/// What is asked of the tangential motion.
#[derive(Debug, Clone)]
pub(super) enum Task<'a> {
    Slide {
        freedoms: Freedoms,
        before: &'a Before,
    },
    Roll {
        rolling: &'a Rolling,
        freedoms: [Freedom; 2],
        /// The state one cell earlier; none for the steady state.
        before: Option<&'a Before>,
    },
}

/// The state before a step.
#[derive(Debug, Clone)]
pub(super) struct Before {
    pub(super) traction: [Array2<f64>; 2],
    pub(super) displacement: [Array2<f64>; 2],
    pub(super) shift: [f64; 2],
    pub(super) twist: f64,
}

impl Before {
    /// Bodies that have not touched.
    pub(super) fn nothing(grid: &Grid) -> Self {
        let zeros = || [(); 2].map(|()| Array2::zeros(grid.shape()));
        Self {
            traction: zeros(),
            displacement: zeros(),
            shift: [0.0; 2],
            twist: 0.0,
        }
    }
}

impl RollingDirection {
    pub(super) fn direction(self) -> Direction {
        Direction {
            axis: usize::from(matches!(self, Self::PlusY | Self::MinusY)),
            forward: matches!(self, Self::PlusX | Self::PlusY),
        }
    }

    /// z × e
    fn across(self) -> [f64; 2] {
        let [x, y] = self.vector();
        [-y, x]
    }
}

impl Task<'_> {
    fn direction(&self) -> Option<Direction> {
        match self {
            Self::Slide { .. } => None,
            Self::Roll { rolling, .. } => Some(rolling.direction.direction()),
        }
    }

    /// Whether rolling needs the displacement ahead of the grid.
    pub(super) fn leaves_the_grid(&self, bound: &Array2<f64>) -> bool {
        self.direction().is_some_and(|Direction { axis, forward }| {
            let edge = if forward {
                bound.len_of(Axis(axis)) - 1
            } else {
                0
            };
            bound
                .index_axis(Axis(axis), edge)
                .iter()
                .any(|bound| *bound > 0.0)
        })
    }

    pub(super) fn slides(&self) -> bool {
        matches!(self, Self::Slide { .. })
    }

    /// Direction of a steady state.
    pub(super) fn steady(&self) -> Option<Direction> {
        match self {
            Self::Roll { before: None, .. } => self.direction(),
            _ => None,
        }
    }

    /// The smallest window that holds all cells with friction or pressure, and in rolling a cell more on both sides; none
    /// where no cell has friction.
    pub(super) fn window(&self, bound: &Array2<f64>, pressure: &Array2<f64>) -> Option<Window> {
        if bound.iter().all(|bound| *bound <= 0.0) {
            return None;
        }
        let mut window: Option<[[usize; 2]; 2]> = None;
        // Pressure spreads the surfaces also where there is no friction.
        let cells = bound.indexed_iter().zip(pressure);
        let used = cells.filter(|((_, bound), p)| **bound > 0.0 || **p > 0.0);
        for (((i, j), _), _) in used {
            let [[x0, x1], [y0, y1]] = window.unwrap_or([[i, i], [j, j]]);
            window = Some([[x0.min(i), x1.max(i)], [y0.min(j), y1.max(j)]]);
        }
        let margin = |axis: usize| usize::from(self.steady().is_some_and(|d| d.axis == axis));
        window.map(|ends| {
            [0, 1].map(|axis| {
                let [first, last] = ends[axis];
                let most = [bound.nrows(), bound.ncols()][axis];
                first.saturating_sub(margin(axis))..(last + 1 + margin(axis)).min(most)
            })
        })
    }

    /// The unit motions along both axes (of the grid, or along and across rolling), and about the origin, at the cell
    /// with its centre at (x, y). Rolling compares a cell with that ahead; with the spin's arm in the middle between
    /// them, the condition would lie half a cell ahead of the traction.
    pub(super) fn unit_motions(&self, [x, y]: [f64; 2]) -> [[f64; 2]; 3] {
        match self {
            Self::Slide { .. } => [[1.0, 0.0], [0.0, 1.0], [-y, x]],
            Self::Roll { rolling, .. } => {
                let direction = rolling.direction;
                [direction.vector(), direction.across(), [-y, x]]
            }
        }
    }

    /// The degrees of freedom: in sliding less what was before, in rolling over a cell.
    pub(super) fn increments(&self, spacing: [f64; 2]) -> Freedoms {
        match self {
            Self::Slide { freedoms, before } => {
                let start = [before.shift[0], before.shift[1], before.twist];
                let mut increments = *freedoms;
                for (freedom, start) in increments.iter_mut().zip(start) {
                    *freedom = match freedom {
                        Freedom::Kept => Freedom::Prescribed(0.0),
                        Freedom::Prescribed(value) => Freedom::Prescribed(*value - start),
                        Freedom::Loaded(force) => Freedom::Loaded(*force),
                    };
                }
                increments
            }
            Self::Roll {
                rolling, freedoms, ..
            } => {
                let d = spacing[rolling.direction.direction().axis];
                let over = |freedom: Freedom| match freedom {
                    Freedom::Prescribed(value) => Freedom::Prescribed(value * d),
                    other => other,
                };
                [
                    over(freedoms[0]),
                    over(freedoms[1]),
                    Freedom::Prescribed(rolling.spin * d),
                ]
            }
        }
    }

    /// Displacements before, at the cell itself or in rolling at that ahead.
    pub(super) fn earlier(&self, [i, j]: [usize; 2]) -> [f64; 2] {
        let (before, [k, l]) = match self {
            Self::Slide { before, .. } => (before, [i, j]),
            Self::Roll { before: None, .. } => return [0.0; 2],
            Self::Roll {
                before: Some(before),
                rolling,
                ..
            } => (
                before,
                ahead(
                    rolling.direction.direction(),
                    [i, j],
                    &before.displacement[0],
                ),
            ),
        };
        before.displacement.each_ref().map(|u| u[[k, l]])
    }

    /// Tractions for a `pressure`, starting from the best of `starts`.
    pub(super) fn solve(
        &self,
        tangential: &Tangential,
        (grid, bound, pressure): (&Grid, &Array2<f64>, &Array2<f64>),
        starts: &[[Array2<f64>; 2]],
        effort: Effort,
        watch: &mut Watch,
    ) -> Option<Solved> {
        let window = self.window(bound, pressure)?;
        let operators = tangential.window([window[0].len(), window[1].len()]);
        let law = Law {
            bound: cut(bound, &window),
        };
        let operator = Operator {
            window: &operators,
            rolling: self.steady(),
        };
        let mut given = operators.spread(&cut(pressure, &window));
        if let Some(direction) = operator.rolling {
            operator.difference(direction, &mut given);
        }
        given.iter_mut().for_each(|g| *g = -*g);
        let cells = operators.cells();
        let (x, y, spacing) = (grid.x(), grid.y(), grid.spacing());
        let mut columns = vec![vec![0.0; 2 * cells]; 3];
        for (at, (i, j)) in each(&window).enumerate() {
            let earlier = self.earlier([i, j]);
            let motions = self.unit_motions([x[i], y[j]]);
            for (axis, earlier) in earlier.into_iter().enumerate() {
                given[axis * cells + at] += earlier;
                for (column, motion) in columns.iter_mut().zip(motions) {
                    column[axis * cells + at] = motion[axis];
                }
            }
        }
        let (mut loaded, mut forces, mut which) = (Vec::new(), Vec::new(), Vec::new());
        let increments = self.increments(spacing);
        for (number, (freedom, column)) in increments.into_iter().zip(columns).enumerate() {
            match freedom {
                Freedom::Loaded(force) => {
                    forces.push(force / grid.cell_area());
                    loaded.push(column);
                    which.push(number);
                }
                Freedom::Prescribed(value) if value != 0.0 => {
                    given
                        .iter_mut()
                        .zip(column)
                        .for_each(|(g, c)| *g += value * c);
                }
                _ => {}
            }
        }
        let problem = Problem {
            operator,
            law: &law,
            given,
            columns: loaded,
            forces,
        };
        let starts = starts
            .iter()
            .map(|start| start.each_ref().map(|q| cut(q, &window)).concat());
        let mut starts: Vec<Vec<f64>> = starts.collect();
        let compared = if starts.len() > 1 { starts.len() } else { 0 };
        if compared > 0 {
            let worst = |q: &Vec<f64>| problem.quality_of(q.clone()).worst();
            let quality: Vec<f64> = starts.iter().map(worst).collect();
            let best = (0..compared).min_by(|a, b| quality[*a].total_cmp(&quality[*b]));
            starts.swap(0, best.unwrap_or(0));
        }
        let best = starts.into_iter().next()?;
        let mut outcome = problem.solve(best, effort, watch);
        outcome.convolutions += compared;
        let mut moved = increments.map(|freedom| match freedom {
            Freedom::Prescribed(value) => value,
            _ => 0.0,
        });
        for (number, delta) in which.into_iter().zip(&outcome.multipliers) {
            moved[number] = *delta;
        }
        Some(Solved {
            window,
            operators,
            outcome,
            moved,
        })
    }
}

/// A solved problem on its window.
pub(super) struct Solved {
    pub(super) window: Window,
    pub(super) operators: Arc<TangentialWindow>,
    pub(super) outcome: Outcome,
    /// Increments of the three degrees of freedom; in rolling over a cell.
    pub(super) moved: [f64; 3],
}

impl Solved {
    /// Displacement along z that the tractions cause, on the window; 0 elsewhere.
    pub(super) fn tractions(&self, shape: [usize; 2]) -> [Array2<f64>; 2] {
        let mut traction = [(); 2].map(|()| Array2::<f64>::zeros(shape));
        let cells = self.operators.cells();
        for (at, (i, j)) in each(&self.window).enumerate() {
            for (axis, q) in traction.iter_mut().enumerate() {
                q[[i, j]] = self.outcome.q[axis * cells + at];
            }
        }
        traction
    }
}

/// Bounds μp.
pub(super) fn bounds(pressure: &Array2<f64>, friction: &Friction) -> Array2<f64> {
    let mut bound = pressure.clone();
    for ((i, j), p) in bound.indexed_iter_mut() {
        *p *= friction.at([i, j]);
    }
    bound
}

/// An error where products of tractions would overflow or vanish.
pub(super) fn check_bound(bound: &Array2<f64>) -> Result<()> {
    let most = bound.iter().fold(0.0_f64, |most, bound| most.max(*bound));
    match most <= 0.0 || (1e-150..=1e150).contains(&most) {
        true => Ok(()),
        false => Err(Error::Parameter {
            name: "friction times the largest pressure",
            requirement: "0, or between 1e-150 and 1e150",
            value: most,
        }),
    }
}

/// An error where friction does not bear a force or a torque, or where one is so small that its tractions vanish.
pub(super) fn check_forces(
    grid: &Grid,
    bound: &Array2<f64>,
    [x, y]: [f64; 2],
    torque: f64,
    tolerance: f64,
) -> Result<()> {
    let bears = bound.sum() * grid.cell_area();
    for (name, value, bears) in [
        ("force", x.hypot(y), bears),
        ("torque", torque.abs(), largest_torque(grid, bound)),
    ] {
        if value > 0.0 && value >= (1.0 - tolerance) * bears {
            return Err(Error::FullSlip { name, value, bears });
        }
        if value > 0.0 && value < 1e-100 * bears {
            let requirement = "0, or at least 1e-100 of what friction bears";
            return Err(Error::Parameter {
                name,
                requirement,
                value,
            });
        }
    }
    Ok(())
}

/// Σ μp r dA: the largest torque about the origin.
fn largest_torque(grid: &Grid, bound: &Array2<f64>) -> f64 {
    let (x, y) = (grid.x(), grid.y());
    let each = bound
        .indexed_iter()
        .map(|((i, j), bound)| bound * x[i].hypot(y[j]));
    each.sum::<f64>() * grid.cell_area()
}

/// The cell ahead, or the last one.
pub(super) fn ahead(direction: Direction, [i, j]: [usize; 2], field: &Array2<f64>) -> [usize; 2] {
    let step = |k: usize, n: usize| match direction.forward {
        true => (k + 1).min(n - 1),
        false => k.saturating_sub(1),
    };
    match direction.axis {
        0 => [step(i, field.nrows()), j],
        _ => [i, step(j, field.ncols())],
    }
}

pub(super) fn each(window: &Window) -> impl Iterator<Item = (usize, usize)> + use<> {
    let [rows, columns] = window.clone();
    rows.flat_map(move |i| columns.clone().map(move |j| (i, j)))
}

fn cut(field: &Array2<f64>, window: &Window) -> Vec<f64> {
    each(window).map(|(i, j)| field[[i, j]]).collect()
}

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
