//! One tangential problem on the window of a contact: sliding in one step, rolling at constant speed, or rolling by one
//! cell. Its fields on the whole grid, and how well the laws hold there.

use std::ops::Range;

use ndarray::{Array2, Axis, Zip};

use super::coulomb::{CellState, Law};
use super::newton::{ConvolutionWatch, Effort, Operator, TractionProblem, TractionResult};
use super::second_order::SecondOrder;
use super::solution::TangentialMotion;
use super::step::{Freedom, Friction, Rolling, RollingDirection};
use crate::compliance::traction::{Tangential, TangentialWindow};
use crate::contact::{self, Warning};
use crate::error::{Error, Result, require};
use crate::model::grid::{Grid, Window, each_cell, full_window};
use crate::numerics::dense::eliminate;
use crate::numerics::parallel::check_memory;

/// Bytes that the fields of a solution, and the operators on the whole grid take for each cell. Measured, as those of
/// iterations: 185.
pub(super) const GRID_BYTES: u64 = 200;

/// Bytes of an iteration for each cell of its window, in sliding. Measured: 720.
const SLIDING_BYTES: u64 = 800;

/// The same in rolling. Measured: 1120.
pub(super) const ROLLING_BYTES: u64 = 1200;

/// What is asked of the tangential motion.
#[derive(Debug)]
pub(super) struct TangentialProblem<'a> {
    /// Rolling; `None` in sliding.
    pub(super) rolling: Option<&'a Rolling>,
    /// Whether rolling is steady, so that no state comes before.
    pub(super) is_steady: bool,
    /// Whether it rolls to second order in the cells.
    pub(super) is_second_order: bool,
    /// Degrees of freedom along both axes (of the grid, or along and across rolling) and about z: in sliding less what was
    /// before, in rolling over a cell.
    pub(super) increments: [Freedom; 3],
    /// The state before the step, or one cell earlier.
    pub(super) before: Before,
}

/// The state before a step.
#[derive(Debug)]
pub(super) struct Before {
    pub(super) traction: [Array2<f64>; 2],
    pub(super) displacement: [Array2<f64>; 2],
    pub(super) shift: [f64; 2],
    pub(super) twist: f64,
}

impl Before {
    /// Bodies that have not touched.
    pub(super) fn nothing(grid: &Grid) -> Self {
        Self {
            traction: zeros(grid.shape()),
            displacement: zeros(grid.shape()),
            shift: [0.0; 2],
            twist: 0.0,
        }
    }
}

/// A field of two components.
pub(super) fn zeros(shape: [usize; 2]) -> [Array2<f64>; 2] {
    [(); 2].map(|()| Array2::zeros(shape))
}

/// What the tractions belong to.
#[derive(Clone, Copy)]
pub(super) struct PressedCells<'a> {
    pub(super) grid: &'a Grid,
    /// μp of each cell.
    pub(super) bound: &'a Array2<f64>,
    /// The pressure that displaces the surfaces along each other.
    pub(super) spreading: &'a Array2<f64>,
    /// Pressure and gap, which tell where the contact leads.
    pub(super) pressure: &'a Array2<f64>,
    pub(super) gap: &'a Array2<f64>,
}

impl TangentialProblem<'_> {
    pub(super) fn slides(&self) -> bool {
        self.rolling.is_none()
    }

    fn direction(&self) -> Option<RollingDirection> {
        self.rolling.map(|rolling| rolling.direction)
    }

    /// Direction of a steady state.
    fn steady(&self) -> Option<RollingDirection> {
        self.direction().filter(|_| self.is_steady)
    }

    /// Whether the force along an axis is given.
    pub(super) fn is_loaded(&self, axis: usize) -> bool {
        let turned = self.direction().map_or(0, RollingDirection::axis);
        matches!(self.increments[(axis + turned) % 2], Freedom::Loaded(_))
    }

    /// Increments that are prescribed; 0 elsewhere.
    fn prescribed(&self) -> [f64; 3] {
        self.increments.map(|freedom| match freedom {
            Freedom::Prescribed(value) => value,
            _ => 0.0,
        })
    }

    /// An error where friction does not carry a force or a torque, where one is so small that its tractions vanish, and
    /// where rolling needs the displacement ahead of the grid.
    pub(super) fn check(&self, grid: &Grid, bound: &Array2<f64>, tolerance: f64) -> Result<()> {
        let [x, y, torque] = self.increments.map(Freedom::force);
        let (force, area) = (x.hypot(y), grid.cell_area());
        for (name, value, capacity) in [
            ("force", force, bound.sum() * area),
            ("torque", torque.abs(), largest_torque(grid, bound)),
        ] {
            if value > 0.0 && value >= (1.0 - tolerance) * capacity {
                return Err(Error::FullSlip { name, value, bears: capacity });
            }
            let counts = value <= 0.0 || value >= 1e-100 * capacity;
            let requirement = "0, or at least 1e-100 of what friction can carry";
            require(name, value, counts, requirement)?;
        }
        if torque != 0.0 {
            let reserve = self.reserve(grid, bound);
            let (name, value) = match force > 0.0 {
                true => ("force, with torque in the same ratio,", force),
                false => ("torque", torque.abs()),
            };
            if reserve <= 1.0 + tolerance {
                return Err(Error::FullSlip { name, value, bears: reserve * value });
            }
        }
        let leaves = |direction: RollingDirection| {
            let axis = Axis(direction.axis());
            let edge = if direction.is_forward() { bound.len_of(axis) - 1 } else { 0 };
            bound.index_axis(axis, edge).iter().any(|bound| *bound > 0.0)
        };
        if self.direction().is_some_and(leaves) { Err(Error::RollsOffGrid) } else { Ok(()) }
    }

    /// The factor by which the given forces and torque F may grow, at most. Where the counterbody slides by C δ, they do the
    /// work F · δ, and friction at most Σ μp |C δ| dA: the least ratio of both over all δ, by steps that each lower it
    /// (Weiszfeld, Tôhoku Math. J. 43 (1937) 355). It ends where the ratio is below 1, or far from it.
    fn reserve(&self, grid: &Grid, bound: &Array2<f64>) -> f64 {
        // Share of what is above 1 by which a step must lower the ratio.
        const PROGRESS: f64 = 1e-3;
        let (x, y) = (grid.x(), grid.y());
        let length = grid.size()[0].hypot(grid.size()[1]);
        let loaded = self.increments.map(|freedom| matches!(freedom, Freedom::Loaded(_)));
        let [fx, fy, torque] = self.increments.map(Freedom::force);
        let forces = [fx, fy, torque / length].map(|force| force / grid.cell_area());
        let slip = |[dx, dy, turn]: [f64; 3], x: f64, y: f64| [dx - turn * y, dy + turn * x];
        let cells: Vec<[f64; 3]> = (bound.indexed_iter().filter(|(_, bound)| **bound > 0.0))
            .map(|((i, j), bound)| [x[i] / length, y[j] / length, *bound])
            .collect();
        let (mut motion, mut least) = (None, f64::INFINITY);
        loop {
            let mut matrix = [[0.0; 3]; 3];
            for [x, y, bound] in &cells {
                let size = motion.map_or(1.0, |motion| {
                    let [sx, sy] = slip(motion, *x, *y);
                    sx.hypot(sy).max(f64::MIN_POSITIVE)
                });
                let weight = bound / size;
                let rows = [[1.0, 0.0, -y], [0.0, 1.0, *x], [-y, *x, x * x + y * y]];
                let sums = matrix.as_flattened_mut().iter_mut();
                sums.zip(rows.as_flattened()).for_each(|(sum, row)| *sum += weight * row);
            }
            let mut next = forces;
            eliminate(&mut matrix, &mut next, |k, _| loaded[k]);
            let work: f64 = next.iter().zip(forces).map(|(by, force)| by * force).sum();
            let next = next.map(|by| by / work);
            let taken = cells.iter().map(|[x, y, bound]| {
                let [sx, sy] = slip(next, *x, *y);
                bound * sx.hypot(sy)
            });
            let ratio: f64 = taken.sum();
            let goes_on = ratio > 1.0 && least - ratio > PROGRESS * (ratio - 1.0);
            (motion, least) = (Some(next), least.min(ratio));
            if !goes_on {
                return least;
            }
        }
    }

    /// An error where there is too little memory for tractions within `bound`.
    pub(super) fn check_memory(&self, grid: &Grid, bound: &Array2<f64>) -> Result<()> {
        let window = self.window(bound, bound);
        let pressed = window.map_or(0, |[rows, columns]| rows.len() * columns.len());
        let [nx, ny] = grid.shape();
        let of_iteration = if self.slides() { SLIDING_BYTES } else { ROLLING_BYTES };
        check_memory([nx, ny], (nx * ny) as u64 * GRID_BYTES + pressed as u64 * of_iteration)
    }

    /// The smallest window that holds all cells with friction or pressure, and in steady rolling a cell more on both sides;
    /// `None` where no cell has friction.
    fn window(&self, bound: &Array2<f64>, spreading: &Array2<f64>) -> Option<Window> {
        if bound.iter().all(|bound| *bound <= 0.0) {
            return None;
        }
        // Pressure spreads the surfaces also where there is no friction.
        let used = |i: usize, j: usize| bound[[i, j]] > 0.0 || spreading[[i, j]] > 0.0;
        let [rows, columns] = contact::bounds(&full_window([bound.nrows(), bound.ncols()]), used)?;
        let wider = |axis: usize, cells: Range<usize>| {
            let margin = usize::from(self.steady().is_some_and(|d| d.axis() == axis));
            let most = bound.len_of(Axis(axis));
            cells.start.saturating_sub(margin)..(cells.end + margin).min(most)
        };
        Some([wider(0, rows), wider(1, columns)])
    }

    /// The unit motions of the degrees of freedom at (x, y).
    fn unit_motions(&self, [x, y]: [f64; 2]) -> [[f64; 2]; 3] {
        let [along, across] = match self.direction() {
            None => [[1.0, 0.0], [0.0, 1.0]],
            Some(direction) => {
                let [x, y] = direction.vector();
                [[x, y], [-y, x]]
            }
        };
        [along, across, [-y, x]]
    }

    /// Where the motion of the cell with its centre at (x, y) is taken: there, or in rolling to second order half a cell
    /// ahead. To first order it stays at the centre, as that of the traction.
    fn arm(&self, grid: &Grid, [x, y]: [f64; 2]) -> [f64; 2] {
        match self.direction().filter(|_| self.is_second_order) {
            None => [x, y],
            Some(direction) => {
                let half = 0.5 * grid.spacing()[direction.axis()];
                let [ex, ey] = direction.vector();
                [x + half * ex, y + half * ey]
            }
        }
    }

    /// Rolling to second order on a window.
    fn second_order(
        &self,
        tangential: &Tangential,
        operators: &TangentialWindow,
        pressed: PressedCells,
        window: &Window,
    ) -> Option<SecondOrder> {
        let direction = self.direction().filter(|_| self.is_second_order)?;
        let own = match self.is_steady {
            true => operators.ahead[direction.axis()],
            false => operators.own,
        };
        let fields = [pressed.pressure, pressed.gap];
        let (on, of) = ((pressed.grid, window), (tangential, own));
        Some(SecondOrder::new(direction, self.prescribed()[2], fields, on, of))
    }

    /// Displacements before, at the cell itself or in rolling at that ahead.
    fn earlier(&self, cell: [usize; 2]) -> [f64; 2] {
        let field = &self.before.displacement;
        let cell = match self.direction() {
            None => cell,
            Some(direction) => ahead(direction, cell, &field[0]),
        };
        field.each_ref().map(|u| u[cell])
    }

    /// Tractions for a pressure, starting from the best of `starts`; `None` where no cell has friction.
    pub(super) fn solve(
        &self,
        tangential: &Tangential,
        pressed: PressedCells,
        starts: &[[Array2<f64>; 2]],
        effort: Effort,
        watch: &mut ConvolutionWatch,
    ) -> Option<SolvedTractions> {
        let window = self.window(pressed.bound, pressed.spreading)?;
        let operators = tangential.window([window[0].len(), window[1].len()]);
        let law = Law { bound: cut(pressed.bound, &window) };
        let second_order = self.second_order(tangential, &operators, pressed, &window);
        let operator = Operator {
            window: &operators,
            rolling: self.steady(),
            second_order: second_order.as_ref(),
            blends: self.slides() || self.is_second_order,
        };
        let problem = self.problem(operator, &law, pressed, &window);
        let mut starts: Vec<Vec<f64>> = (starts.iter())
            .map(|start| start.each_ref().map(|q| cut(q, &window)).concat())
            .collect();
        let compared = if starts.len() > 1 { starts.len() } else { 0 };
        if compared > 0 {
            let worst = |q: &Vec<f64>| problem.misfit_of(q.clone()).worst();
            let worst: Vec<f64> = starts.iter().map(worst).collect();
            let best = (0..compared).min_by(|a, b| worst[*a].total_cmp(&worst[*b]));
            starts.swap(0, best.unwrap_or(0));
        }
        let best = starts.into_iter().next()?;
        let mut solution = problem.solve(best, effort, watch);
        solution.convolutions += compared;
        let mut moved = self.prescribed();
        let mut loaded = solution.multipliers.iter();
        for (moved, freedom) in moved.iter_mut().zip(self.increments) {
            if matches!(freedom, Freedom::Loaded(_)) {
                *moved = *loaded.next()?;
            }
        }
        Some(SolvedTractions { window, cells: operators.cells(), solution, moved })
    }

    /// The problem on a window: what the displacements must be, and the columns and forces of the loaded degrees of freedom.
    fn problem<'p>(
        &self,
        operator: Operator<'p>,
        law: &'p Law,
        pressed: PressedCells,
        window: &Window,
    ) -> TractionProblem<'p> {
        let operators = operator.window;
        let mut displacements = operators.spread(&cut(pressed.spreading, window));
        if let Some(direction) = operator.rolling {
            operator.difference(direction, &mut displacements);
        }
        displacements.iter_mut().for_each(|g| *g = -*g);
        let (grid, cells) = (pressed.grid, operators.cells());
        let (x, y) = (grid.x(), grid.y());
        let mut units = vec![vec![0.0; 2 * cells]; 3];
        for (at, (i, j)) in each_cell(window).enumerate() {
            let earlier = self.earlier([i, j]);
            let motions = self.unit_motions(self.arm(grid, [x[i], y[j]]));
            for (axis, earlier) in earlier.into_iter().enumerate() {
                displacements[axis * cells + at] += earlier;
                for (unit, motion) in units.iter_mut().zip(motions) {
                    unit[axis * cells + at] = motion[axis];
                }
            }
        }
        let (mut columns, mut forces) = (Vec::new(), Vec::new());
        for (freedom, unit) in self.increments.into_iter().zip(units) {
            match freedom {
                Freedom::Loaded(force) => {
                    forces.push(force / grid.cell_area());
                    columns.push(unit);
                }
                Freedom::Prescribed(value) if value != 0.0 => {
                    let pairs = displacements.iter_mut().zip(unit);
                    pairs.for_each(|(g, unit)| *g += value * unit);
                }
                _ => {}
            }
        }
        TractionProblem { operator, law, displacements, columns, forces }
    }

    /// Fields on the whole grid, with the operator of the whole grid.
    pub(super) fn fields(
        &self,
        tangential: &Tangential,
        pressed: PressedCells,
        solved: Option<&SolvedTractions>,
    ) -> FrictionFields {
        let grid = pressed.grid;
        let shape = grid.shape();
        let traction = solved.map_or_else(|| zeros(shape), |solved| solved.tractions(shape));
        let moved = solved.map_or_else(|| self.prescribed(), |solved| solved.moved);
        let whole = tangential.window(shape);
        let q: Vec<f64> = traction.iter().flatten().copied().collect();
        let mut own = vec![0.0; q.len()];
        whole.displace(&q, &mut own);
        let p: Vec<f64> = pressed.spreading.iter().copied().collect();
        let spread = whole.spread(&p);
        let (cells, columns) = (whole.cells(), shape[1]);
        let place = |axis: usize, [i, j]: [usize; 2]| axis * cells + i * columns + j;
        let displacement = [0, 1].map(|axis| {
            Array2::from_shape_fn(shape, |(i, j)| {
                let at = place(axis, [i, j]);
                own[at] + spread[at]
            })
        });
        // The change of displacement that slip makes up for.
        let change = |axis: usize, cell: [usize; 2]| {
            let u: &Array2<f64> = &displacement[axis];
            match self.steady() {
                None => u[cell],
                Some(direction) => u[cell] - u[ahead(direction, cell, u)],
            }
        };
        let (x, y, spacing) = (grid.x(), grid.y(), grid.spacing());
        let unit = self.direction().map_or(1.0, |d| 1.0 / spacing[d.axis()]);
        let mut states = vec![CellState::Free; cells];
        for (cell, state) in solved.into_iter().flat_map(SolvedTractions::states) {
            states[place(0, cell)] = *state;
        }
        // −s d
        let mut residual = vec![0.0; 2 * cells];
        for (i, j) in each_cell(&full_window(shape)) {
            let cell = [i, j];
            if pressed.pressure[cell] <= 0.0 && states[place(0, cell)] == CellState::Free {
                continue;
            }
            let motions = self.unit_motions(self.arm(grid, [x[i], y[j]]));
            for (axis, earlier) in self.earlier(cell).into_iter().enumerate() {
                let parts = moved.iter().zip(motions);
                let rigid: f64 = parts.map(|(by, motion)| by * motion[axis]).sum();
                let slip = rigid + earlier - change(axis, cell);
                residual[place(axis, cell)] = -slip;
            }
        }
        let second_order = self.second_order(tangential, &whole, pressed, &full_window(shape));
        if let Some(second_order) = second_order {
            second_order.deviate(&q, &mut residual);
            second_order.centre(&states, &mut residual, 1.0);
        }
        let mut slip = zeros(shape);
        let (mut violation, mut scale, mut excess, mut most) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        let mut full_slip = solved.is_some();
        for (cell, state) in solved.into_iter().flat_map(SolvedTractions::states) {
            if *state == CellState::Free {
                continue;
            }
            let s = [0, 1].map(|axis| -residual[place(axis, cell)]);
            scale = scale.max(own[place(0, cell)].hypot(own[place(1, cell)]));
            let bound = pressed.bound[cell];
            excess = excess.max(traction[0][cell].hypot(traction[1][cell]) - bound);
            most = most.max(bound);
            violation = violation.max(match state {
                CellState::Slip { n, .. } => (s[1] * n[0] - s[0] * n[1]).abs(),
                _ => s[0].hypot(s[1]),
            });
            full_slip &= matches!(state, CellState::Slip { .. });
            for (field, s) in slip.iter_mut().zip(s) {
                field[cell] = s * unit;
            }
        }
        let over = |amount: f64, whole: f64| if whole > 0.0 { amount / whole } else { 0.0 };
        FrictionFields {
            traction,
            displacement,
            slip,
            motion: self.motion(moved, unit),
            violation: over(violation, scale),
            excess: over(excess.max(0.0), most),
            full_slip,
        }
    }

    /// The tangential motion after increments of the degrees of freedom.
    fn motion(&self, moved: [f64; 3], unit: f64) -> TangentialMotion {
        let Before { shift, twist, .. } = self.before;
        match self.rolling {
            None => TangentialMotion::Slide {
                shift: [shift[0] + moved[0], shift[1] + moved[1]],
                twist: twist + moved[2],
            },
            Some(rolling) => TangentialMotion::Roll {
                creepage: [moved[0] * unit, moved[1] * unit],
                spin: rolling.spin,
                direction: rolling.direction,
            },
        }
    }
}

/// A solved problem on its window.
pub(super) struct SolvedTractions {
    window: Window,
    cells: usize,
    pub(super) solution: TractionResult,
    /// Increments of the three degrees of freedom; in rolling over a cell.
    moved: [f64; 3],
}

impl SolvedTractions {
    /// Cells of the window, and what they do.
    fn states(&self) -> impl Iterator<Item = ([usize; 2], &CellState)> {
        each_cell(&self.window).map(|(i, j)| [i, j]).zip(&self.solution.states)
    }

    /// Tractions on the whole grid, 0 outside of the window.
    pub(super) fn tractions(&self, shape: [usize; 2]) -> [Array2<f64>; 2] {
        let mut traction = zeros(shape);
        for (at, (i, j)) in each_cell(&self.window).enumerate() {
            for (axis, q) in traction.iter_mut().enumerate() {
                q[[i, j]] = self.solution.q[axis * self.cells + at];
            }
        }
        traction
    }
}

/// Tractions, displacements and slip of the whole grid.
pub(super) struct FrictionFields {
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

impl FrictionFields {
    pub(super) fn are_finite(&self) -> bool {
        let fields = [&self.traction, &self.displacement, &self.slip];
        let (TangentialMotion::Slide { shift: [x, y], twist: z }
        | TangentialMotion::Roll { creepage: [x, y], spin: z, .. }) = &self.motion;
        let mut values = fields.into_iter().flatten().flatten().chain([x, y, z]);
        values.all(|value| value.is_finite())
    }

    /// The warning of creepages or a twist that are not small, where `pressure` is.
    pub(super) fn warning(
        &self,
        problem: &TangentialProblem,
        grid: &Grid,
        pressure: &Array2<f64>,
    ) -> Option<Warning> {
        let size = match self.motion {
            TangentialMotion::Slide { twist, .. } => twist.abs(),
            TangentialMotion::Roll { creepage, spin, .. } => {
                let (x, y) = (grid.x(), grid.y());
                let touching = pressure.indexed_iter().filter(|(_, p)| **p > 0.0);
                touching.fold(0.0_f64, |most, ((i, j), _)| {
                    let unit = problem.unit_motions([x[i], y[j]]);
                    let along = |axis: usize| {
                        creepage[0] * unit[0][axis]
                            + creepage[1] * unit[1][axis]
                            + spin * unit[2][axis]
                    };
                    most.max(along(0).hypot(along(1)))
                })
            }
        };
        (size > LARGE).then_some(Warning::LargeMotion { size })
    }

    /// Brings back the state before the step, where there was one: the history can continue from there.
    pub(super) fn restore(&mut self, problem: &TangentialProblem) {
        if problem.is_steady {
            return;
        }
        let before = &problem.before;
        self.traction.clone_from(&before.traction);
        self.displacement.clone_from(&before.displacement);
        self.slip.iter_mut().for_each(|s| s.fill(0.0));
        if let TangentialMotion::Slide { shift, twist } = &mut self.motion {
            (*shift, *twist) = (before.shift, before.twist);
        }
    }
}

/// Bounds μp; 0 where μ is below the rounding of 1.
///
/// # Errors
/// Where products of tractions would overflow or vanish.
pub(super) fn bounds(pressure: &Array2<f64>, friction: &Friction) -> Result<Array2<f64>> {
    let mut bound = friction.times(pressure);
    Zip::from(&mut bound).and(pressure).for_each(|bound, p| {
        if *bound < f64::EPSILON * p {
            *bound = 0.0;
        }
    });
    let most = bound.iter().fold(0.0_f64, |most, bound| most.max(*bound));
    let (name, counts) = ("friction times the largest pressure", (1e-150..=1e150).contains(&most));
    require(name, most, most <= 0.0 || counts, "0, or between 1e-150 and 1e150")?;
    Ok(bound)
}

/// Σ μp r dA: the largest torque about the origin.
fn largest_torque(grid: &Grid, bound: &Array2<f64>) -> f64 {
    let (x, y) = (grid.x(), grid.y());
    let each = bound.indexed_iter();
    let each = each.map(|((i, j), bound)| bound * x[i].hypot(y[j]));
    each.sum::<f64>() * grid.cell_area()
}

/// The cell ahead, or the last one.
fn ahead(direction: RollingDirection, [i, j]: [usize; 2], field: &Array2<f64>) -> [usize; 2] {
    let next = |at: usize, cells: usize| match direction.is_forward() {
        true => (at + 1).min(cells - 1),
        false => at.saturating_sub(1),
    };
    match direction.axis() {
        0 => [next(i, field.nrows()), j],
        _ => [i, next(j, field.ncols())],
    }
}

fn cut(field: &Array2<f64>, window: &Window) -> Vec<f64> {
    each_cell(window).map(|(i, j)| field[[i, j]]).collect()
}
