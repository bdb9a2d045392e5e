//! Pressure within the cells of a solved contact, and the stress that it adds; the method was derived here.
//!
//! # Idea
//!
//! A solver knows the pressure as one value per cell. Farther than a cell or two from the surface that
//! is enough. Nearer, stresses show the steps between cells, and the staircase that the solver's
//! contact has in place of a smooth edge. But the pressure of a smooth contact is known better than
//! that: where the surfaces part smoothly it falls as p = √d (c0 + c1 d + …) at the distance d from
//! the edge (Johnson, Contact Mechanics (1985), §5.1, doi:10.1017/CBO9781139171731), so that p² is
//! smooth up to the edge, and a polynomial can be continued from the interior to it. On layers a factor Φ(d) of
//! the bodies alone joins the law of the coat near the edge to that of what is below (`law`).
//!
//! # Formulas
//!
//! In a cell, with u and v the distances from its centre along x and y, in cells,
//!
//! ```text
//! interior      p = p_cell + s_x u + s_y v + ½ k_x (u² − 1/12) + ½ k_y (v² − 1/12)
//! edge          p = √max(q(u, v), 0) Φ(d)  q a polynomial of degree 2 or 3, fitted to (p/Φ)²
//! elsewhere     p = p_cell
//! ```
//!
//! Slopes s and curvatures k are differences of the neighbours' pressures. q is fitted by least squares
//! to p² of cells that are three cells from the edge and farther; for Hertz' contact it is exact. The
//! edge is then shifted, by thousandths of a cell, until the cells around carry the force that the
//! solver's cells do.
//!
//! The load of a cell is split into three parts:
//!
//! 1. its mean, and
//! 2. shares ±m/2 of its first moment m on the two neighbours along each axis: both are uniform over
//!    cells, and go into the convolution that is made anyway;
//! 3. the rest, which has neither force nor moment. Its stresses fall off as the fourth power of the
//!    distance. They are summed over three cells to each side, at depths of up to four cells, from the
//!    stresses of small rectangles under uniform pressure.
//!
//! # Gain
//!
//! Below Hertz' point contact of 128 cells to the half-width, stresses one cell deep are within 7e-4 of
//! the peak pressure, and 4e-3 with uniform cells; a tenth of a cell deep, farther than three cells
//! from the edge, 3.3e-4 instead of 2.4e-3 (`tests/stress/edge.rs`). Where the edge is sharp, the
//! contact rough or too small, the pressure stays uniform, and no more than 1e-4 of the peak is lost.
//!
//! # Files
//!
//! | file | what it makes |
//! |---|---|
//! | `edge` | the cells near the edge where a polynomial, fitted by least squares, is certain enough |
//! | `squared_pressure` | the square of the pressure near an edge, as a polynomial |
//! | `law` | the factor Φ by which layers change the pressure near an edge |
//! | `reconstruction` | the pressure of all cells: uniform part, slopes and curvatures, roots; cells cut into rectangles |
//! | `near` | the sum of the third part over the cells around |
//! | `uncertainty` | the error that the size of the cells leaves, at a depth |

use std::borrow::Cow;
use std::ops::ControlFlow;
use std::sync::OnceLock;

use rayon::prelude::*;

use crate::compliance::kernel::loads::{COMPONENTS, EXCHANGED, PressureStress, TractionStress};
use crate::compliance::kernel::plane::{Kernel, Kernels};
use crate::compliance::kernel::strip;
use crate::compliance::response::interior::Place;
use crate::model::body::HalfSpace;
use crate::model::grid::{Grid, Window};
use crate::numerics::parallel::Threads;
use crate::stress::options::StressProgress;

mod edge;
mod law;
mod near;
mod reconstruction;
mod squared_pressure;
mod uncertainty;

pub(super) use edge::around;
use edge::{BAND, Fitting};
pub(super) use near::{CellPoint, NearTable, STRESSES};
use near::{Components, NearPlan};
use reconstruction::{Cuts, SMALLEST_AT_POINT};
pub(super) use uncertainty::BodyPair;
pub(super) use uncertainty::{ByComponent, COMPONENTS_APART, ErrorOf, LocalSteps, StepErrors};
use uncertainty::{STEP_REACH, Uncertainty};

/// A body under the pressure within the cells of a solved contact. The uniform part of the pressure is
/// left to the convolution.
#[derive(Debug)]
pub(super) struct SubcellStress {
    kernels: Kernels,
    /// Kernels down to the smallest pieces at a point, made at the first.
    point_kernels: OnceLock<Kernels>,
    near: NearPlan,
    /// The pressure within cells by simpler fits near the edge, made where it is asked for.
    simpler: OnceLock<NearPlan>,
    uncertainty: Uncertainty,
    /// The solver's pressure: tractions at the surface are those of it.
    solver_pressure: Vec<f64>,
    /// Where the grid repeats, the pressure is reconstructed with a margin of its images.
    margin: Margin,
    /// Pressure that is taken as uniform over the cells of the grid.
    uniform: Vec<f64>,
}

impl SubcellStress {
    /// Reconstructs `pressure` within cells, for one body of a contact of the `pair` with `tractions` where they are known,
    /// which stay uniform over cells. `progress` is asked many times, with 0.
    pub(super) fn plan(
        (body, pair): (&HalfSpace, &BodyPair),
        grid: &Grid,
        (pressure, tractions): (&[f64], Option<&[Vec<f64>; 2]>),
        threads: &Threads,
        progress: &mut StressProgress,
    ) -> ControlFlow<(), Self> {
        let law = pair.edge_law(grid).map(|law| (law, Fitting::BEST));
        let margin = Margin::of(grid);
        let wide = margin.wide(grid);
        let pressure = &*margin.around(pressure);
        let near = NearPlan::new(pressure, &wide, law, threads, progress)?;
        let reach = near.farthest();
        // A free base does not see what has neither force nor moment.
        let kernels =
            threads.run(|| Kernels::new(&body.with_rigid_base(), grid, Cuts::SMALLEST, reach));
        let tractions =
            tractions.map(|both| both.each_ref().map(|q| margin.around(q).into_owned()));
        let loads = (pressure, tractions);
        let uncertainty = Uncertainty::new(body, &wide, loads, &near.reconstruction);
        ControlFlow::Continue(Self {
            uniform: margin.middle(&near.reconstruction.uniform),
            margin,
            kernels,
            point_kernels: OnceLock::new(),
            uncertainty,
            near,
            simpler: OnceLock::new(),
            solver_pressure: pressure.to_vec(),
        })
    }

    /// Largest steps of the pressure that are felt in the cells of `window`.
    pub(super) fn steps(&self, window: &Window) -> LocalSteps {
        self.uncertainty.steps(&self.solver_pressure, &self.margin.window(window))
    }

    /// Errors of the stress in `body` at the depth of `place` \[Pa\] due to the width of the contact, at all places.
    pub(super) fn width_errors(
        &self,
        body: &HalfSpace,
        place: &Place,
        friction: [f64; 2],
    ) -> ByComponent {
        self.uncertainty.width_errors(body, place, friction)
    }

    /// Largest steps of the pressure that are felt in each cell.
    pub(super) fn steps_by_cell(&self) -> Vec<LocalSteps> {
        self.margin.middle(&self.uncertainty.steps_by_cell(&self.solver_pressure))
    }

    /// Estimated errors of the stress in `body` at `place`, from the size of the cells; with the friction, whether known
    /// tractions are taken within cells.
    pub(super) fn errors(
        &self,
        body: &HalfSpace,
        place: &Place,
        friction: ([f64; 2], bool),
    ) -> StepErrors {
        self.uncertainty.at(body, place, friction)
    }

    /// Pressure that is taken as uniform over cells.
    pub(super) fn uniform(&self) -> &[f64] {
        &self.uniform
    }

    /// Stresses of pieces of cells at `place`, under pressure and `friction` times it. On the threads of
    /// the caller.
    pub(super) fn table(&self, place: &Place, friction: [f64; 2]) -> NearTable {
        if !self.near.reaches(place.depth) {
            return NearTable::default();
        }
        let stresses = rectangle_stresses(&self.kernels, place, friction.map(|f| f != 0.0));
        self.near.table(place.depth, |at, half| under(sliding(friction), stresses(at, half)))
    }

    /// Points of the edge of the contact, at most one in a cell; none where the grid repeats.
    pub(super) fn edge(&self) -> Vec<CellPoint> {
        if self.margin.is_empty() { self.near.edge() } else { Vec::new() }
    }

    /// Whether each cell feels a stretch of an edge that is reconstructed, but has none of these `points`.
    pub(super) fn feels_lost_edge(&self, points: &[CellPoint]) -> Vec<bool> {
        let shape @ [nx, ny] = self.margin.wide_shape();
        let marked = |cells: &mut dyn Iterator<Item = [usize; 2]>, reach: usize| {
            let mut marked = vec![false; nx * ny];
            for [i, j] in cells.flat_map(|cell| around(shape, cell, reach)) {
                marked[i * ny + j] = true;
            }
            marked
        };
        let has_point = marked(&mut points.iter().map(|point| point.cell), usize::from(BAND) + 1);
        let mut lost = self.near.edge_cells().filter(|[i, j]| !has_point[i * ny + j]);
        self.margin.middle(&marked(&mut lost, STEP_REACH))
    }

    /// Whether the law of the edge is that of layers.
    pub(super) fn is_on_layers(&self) -> bool {
        self.near.reconstruction.law.is_of_layers()
    }

    /// Unit vector towards the inside of the contact at one of the points of its edge.
    pub(super) fn inward(&self, point: &CellPoint) -> Option<[f64; 2]> {
        self.near.inward(point)
    }

    /// Makes the pressure within cells by simpler fits near the edge, of a grid that does not repeat.
    pub(super) fn make_simpler(
        &self,
        grid: &Grid,
        threads: &Threads,
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        if self.simpler.get().is_none() {
            let law = (self.near.reconstruction.law.clone(), Fitting::SIMPLER);
            let plan = NearPlan::new(&self.solver_pressure, grid, Some(law), threads, progress)?;
            // Another thread may have made the same.
            let _ = self.simpler.set(plan);
        }
        ControlFlow::Continue(())
    }

    /// Sets the tractions at the surface, in the cells near an edge, to those at their centres: a cell that the edge crosses has
    /// the mean of a pressure that is larger on one side of it.
    pub(super) fn set_tractions_at_centres(&self, friction: [f64; 2], stresses: &mut [Vec<f64>]) {
        if !self.margin.is_empty() {
            return;
        }
        for (cell, p) in self.near.central_pressures() {
            for (k, factor) in tractions(friction) {
                stresses[k][cell] = -factor * p;
            }
        }
    }

    /// Whether the pressure around a point is known within cells, and its stress with it.
    pub(super) fn has_point(&self, point: &CellPoint) -> bool {
        self.margin.is_empty() && self.uncertainty.is_known_around(point.cell)
    }

    /// What gives stresses at `place` below any point of a grid that does not repeat, under the pressure and `tractions`.
    pub(super) fn point_stress<'a>(
        &'a self,
        (body, grid): (&HalfSpace, &'a Grid),
        place: &Place,
        tractions: Tractions<'a>,
        threads: &Threads,
    ) -> PointStress<'a> {
        let [lx, ly] = grid.size();
        // Not on the threads: one that waits for the kernels cannot be asked to make them.
        let kernels = || threads.run(|| Kernels::new(body, grid, SMALLEST_AT_POINT, lx.hypot(ly)));
        let kernels = self.point_kernels.get_or_init(kernels);
        let stresses = threads.run(|| rectangle_stresses(kernels, place, tractions.act()));
        PointStress { subcell: self, grid, depth: place.depth, tractions, stresses, around: None }
    }

    /// Adds the stresses of a table to those of the uniform part, one plane of each component; at the
    /// surface, sets the tractions to those of the solver's pressure. On the threads of the caller.
    pub(super) fn add(&self, near: &NearTable, friction: [f64; 2], stresses: &mut [&mut [f64]]) {
        self.margin.add(stresses, |stresses| self.near.add(near, stresses));
        if near.at_surface() {
            let pressure = self.margin.middle(&self.solver_pressure);
            for (k, factor) in tractions(friction) {
                let tractions = stresses[k].iter_mut().zip(&pressure);
                tractions.for_each(|(stress, p)| *stress = -factor * p);
            }
        }
    }

    /// What [`SubcellStress::add`] does, for the `stresses` of one cell.
    pub(super) fn add_at(
        &self,
        near: &NearTable,
        friction: [f64; 2],
        cell: [usize; 2],
        stresses: &mut [f64],
    ) {
        let cell = self.margin.cell(cell);
        let added = self.near.sum_at(near, cell);
        stresses.iter_mut().zip(added).for_each(|(s, d)| *s += d);
        if near.at_surface() {
            let p = self.solver_pressure[self.near.number(cell)];
            for (k, factor) in tractions(friction) {
                stresses[k] = -factor * p;
            }
        }
    }
}

/// Tractions on the surface of a solved contact.
#[derive(Debug, Clone, Copy)]
pub(super) enum Tractions<'a> {
    /// This times the pressure, along x and along y.
    Sliding([f64; 2]),
    /// Means over cells, along x and along y.
    Known(&'a [Vec<f64>; 2]),
}

impl Tractions<'_> {
    /// Whether there are any along x and along y.
    fn act(self) -> [bool; 2] {
        match self {
            Self::Sliding(friction) => friction.map(|f| f != 0.0),
            Self::Known(tractions) => tractions.each_ref().map(|q| q.iter().any(|q| *q != 0.0)),
        }
    }
}

/// Stresses at (x, y) from the centre of a rectangle of half sides (a, b), under unit pressure and under unit tractions
/// along x and along y.
type RectangleStresses<'a> = Box<dyn Fn([f64; 2], [f64; 2]) -> [Components; 3] + Send + Sync + 'a>;

/// Stresses at one depth below any point.
pub(in crate::stress) struct PointStress<'a> {
    subcell: &'a SubcellStress,
    grid: &'a Grid,
    depth: f64,
    tractions: Tractions<'a>,
    stresses: RectangleStresses<'a>,
    around: Option<SmoothFields>,
}

/// Stresses in all cells at the depth of points, but for what pressure within cells adds: that of cells farther off than
/// [`AROUND`] is interpolated between centres.
struct SmoothFields {
    fields: [Vec<f64>; STRESSES],
    /// Stresses of a unit load on one cell, by the offset to the target.
    table: Vec<[Components; 3]>,
}

/// Cells to each side of a point whose loads are summed: those beyond are more than four cells from all centres between which their
/// stresses are interpolated by cubics, which errs by some 1e-4 of the pressure there.
const AROUND: usize = 6;

/// Cells to each side of a point between whose centres stresses are interpolated.
const STENCIL: usize = 2;

impl SmoothFields {
    fn new(fields: [Vec<f64>; STRESSES], grid: &Grid, stresses: &RectangleStresses) -> Self {
        let (spacing, half) = (grid.spacing(), grid.spacing().map(|d| 0.5 * d));
        let reach = (AROUND + STENCIL) as isize;
        let rows = if grid.is_line() { 0..=0 } else { -reach..=reach };
        let offset =
            |i: isize, j: isize| stresses([i as f64 * spacing[0], j as f64 * spacing[1]], half);
        let table = rows.flat_map(|i| (-reach..=reach).map(move |j| [i, j]));
        Self { fields, table: table.map(|[i, j]| offset(i, j)).collect() }
    }

    /// Stress of the loads farther off than [`AROUND`] at a point; none where the cells around it do not all have stresses.
    fn beyond(
        &self,
        grid: &Grid,
        point: &CellPoint,
        load: &impl Fn(usize) -> [f64; 3],
    ) -> Option<Components> {
        let ([nx, ny], line) = (grid.shape(), grid.is_line());
        let along = |axis: usize| -> Option<Vec<(usize, f64)>> {
            if line && axis == 0 {
                return Some(vec![(0, 1.0)]);
            }
            let (within, count) = (point.within[axis], grid.shape()[axis]);
            let first = if within < 0.0 { -2 } else { -1 };
            (first..first + 4)
                .map(|k| {
                    let others = (first..first + 4).filter(|other| *other != k);
                    let weight = others.map(|o| (within - o as f64) / (k - o) as f64).product();
                    let cell = point.cell[axis].checked_add_signed(k)?;
                    (cell < count).then_some((cell, weight))
                })
                .collect()
        };
        let (rows, columns) = (along(0)?, along(1)?);
        let reach = (AROUND + STENCIL) as isize;
        let near = around([nx, ny], point.cell, AROUND);
        let loads: Vec<_> = near.map(|cell| (cell, load(cell[0] * ny + cell[1]))).collect();
        let mut sum = [0.0; STRESSES];
        for (i, row) in &rows {
            for (j, column) in &columns {
                let mut own = self.fields.each_ref().map(|field| field[i * ny + j]);
                for ([k, l], load) in &loads {
                    let by = [*i as isize - *k as isize, *j as isize - *l as isize];
                    let row = if line { 0 } else { by[0] + reach };
                    let number = row * (2 * reach + 1) + by[1] + reach;
                    let stress = under(*load, self.table[number as usize]);
                    own.iter_mut().zip(stress).for_each(|(own, stress)| *own -= stress);
                }
                sum = added(sum, own.map(|value| row * column * value));
            }
        }
        sum.iter().all(|value| value.is_finite()).then_some(sum)
    }
}

/// Which fits near the edge the pressure within cells is by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::stress) enum EdgeFit {
    Best,
    Simpler,
}

impl PointStress<'_> {
    /// The same from stresses in all cells at this depth, but for what pressure within cells adds. On the threads of the caller.
    pub(super) fn with_cells(mut self, fields: [Vec<f64>; STRESSES]) -> Self {
        self.around = Some(SmoothFields::new(fields, self.grid, &self.stresses));
        self
    }

    /// Stress of loads farther off from a point than are summed there, with all that adds to the whole half-space's stress; none
    /// where that is not known from the cells around.
    pub(super) fn beyond(&self, point: &CellPoint) -> Option<Components> {
        let load = |cell: usize| {
            let p = self.subcell.uniform[cell];
            match self.tractions {
                Tractions::Sliding([fx, fy]) => [p, fx * p, fy * p],
                Tractions::Known([qx, qy]) => [p, qx[cell], qy[cell]],
            }
        };
        self.around.as_ref()?.beyond(self.grid, point, &load)
    }

    /// Stresses below a point: a sum over loaded cells, or what is `beyond` those around it, and over the pieces of those nearby,
    /// ever finer towards the point. On the threads of the caller.
    ///
    /// Known tractions follow the pressure within the cells around the point, with their ratio to it in the point's cell.
    pub(super) fn at(
        &self,
        point: &CellPoint,
        fit: EdgeFit,
        beyond: Option<Components>,
    ) -> Components {
        let Self { subcell, stresses, .. } = self;
        let near = match fit {
            EdgeFit::Best => &subcell.near,
            EdgeFit::Simpler => subcell.simpler.get().unwrap_or(&subcell.near),
        };
        // No piece may end at the point itself.
        let farthest = 0.5 - SMALLEST_AT_POINT;
        let within = point.within.map(|u| u.clamp(-farthest, farthest));
        let point = &CellPoint { within, ..*point };
        let ([nx, ny], spacing) = (self.grid.shape(), self.grid.spacing());
        let half = spacing.map(|d| 0.5 * d);
        let friction = self.friction_at(point.cell);
        let load = |cell: usize| {
            let p = near.reconstruction.uniform[cell];
            match self.tractions {
                Tractions::Sliding([fx, fy]) => [p, fx * p, fy * p],
                // What is moved between cells goes with the pressure.
                Tractions::Known([qx, qy]) => {
                    let moved = p - subcell.solver_pressure[cell];
                    [p, qx[cell] + friction[0] * moved, qy[cell] + friction[1] * moved]
                }
            }
        };
        let within = |at: usize, count: usize| match beyond {
            Some(_) => at.saturating_sub(AROUND)..(at + AROUND + 1).min(count),
            None => 0..count,
        };
        let [i, j] = point.cell;
        let (rows, columns) = (within(i, nx), within(j, ny));
        let row = |i: usize| {
            let mut sum = [0.0; STRESSES];
            let loads = columns.clone().map(|j| (j, load(i * ny + j)));
            for (j, load) in loads.filter(|(_, load)| load.iter().any(|part| *part != 0.0)) {
                let from = [0, 1].map(|axis| {
                    let cells = point.cell[axis] as f64 - [i, j][axis] as f64;
                    (cells + point.within[axis]) * spacing[axis]
                });
                sum = added(sum, under(load, stresses(from, half)));
            }
            sum
        };
        let rows: Vec<Components> = rows.into_par_iter().map(row).collect();
        // In the order of the rows, whatever the number of threads.
        let mut sum = rows.into_iter().fold(beyond.unwrap_or_default(), added);
        if near.reaches(self.depth) {
            let stress = |at, half| under(sliding(friction), stresses(at, half));
            sum = added(sum, near.sum_at_point(point, self.depth, stress));
        }
        if self.depth == 0.0 {
            let mean = subcell.solver_pressure[near.number(point.cell)];
            let p = near.pressure_at(point, mean);
            for (k, factor) in tractions(friction) {
                sum[k] = -factor * p;
            }
        }
        sum
    }

    /// Ratios of the tractions to the pressure in a cell, or, where it carries none, in the neighbour that carries
    /// most.
    fn friction_at(&self, cell @ [i, j]: [usize; 2]) -> [f64; 2] {
        let known = match self.tractions {
            Tractions::Sliding(friction) => return friction,
            Tractions::Known(known) => known,
        };
        let (p, [nx, ny]) = (&self.subcell.solver_pressure, self.grid.shape());
        let number = |[i, j]: [usize; 2]| i * ny + j;
        let around = (i.saturating_sub(1)..nx.min(i + 2))
            .flat_map(|i| (j.saturating_sub(1)..ny.min(j + 2)).map(move |j| number([i, j])));
        let cell = match p[number(cell)] > 0.0 {
            true => number(cell),
            false => around.max_by(|a, b| p[*a].total_cmp(&p[*b])).unwrap_or_default(),
        };
        known.each_ref().map(|q| if p[cell] > 0.0 { q[cell] / p[cell] } else { 0.0 })
    }
}

fn added(a: Components, b: Components) -> Components {
    std::array::from_fn(|k| a[k] + b[k])
}

/// Unit pressure, and tractions of `friction` times it.
fn sliding([fx, fy]: [f64; 2]) -> [f64; 3] {
    [1.0, fx, fy]
}

/// The stresses under a pressure and tractions, from those under units of each.
fn under(load: [f64; 3], stresses: [Components; 3]) -> Components {
    std::array::from_fn(|k| {
        load[0] * stresses[0][k] + load[1] * stresses[1][k] + load[2] * stresses[2][k]
    })
}

/// Stresses at `place` below rectangles, of tractions along x and y where they are `wanted`. On the threads of the caller.
fn rectangle_stresses<'a>(
    kernels: &'a Kernels,
    place: &Place,
    wanted: [bool; 2],
) -> RectangleStresses<'a> {
    let stresses = |values: [f64; COMPONENTS]| std::array::from_fn(|k| values[k]);
    let none = [0.0; STRESSES];
    match kernels {
        Kernels::Line(plan) => {
            let normal = plan.strips::<6, strip::StripPressure>(place);
            let along = wanted[0].then(|| plan.strips::<3, strip::StripAlong>(place));
            let across = wanted[1].then(|| plan.strips::<6, strip::StripAcross>(place));
            Box::new(move |[_, y], [_, half]| {
                let along = along.as_ref().map_or(none, |strips| stresses(strips.at(y, half)));
                let across = across.as_ref().map_or(none, |strips| stresses(strips.at(y, half)));
                [stresses(normal.at(y, half)), along, across]
            })
        }
        Kernels::Plane(plan) => {
            let normal = Kernel::new::<PressureStress>(plan, place);
            let lateral =
                wanted.contains(&true).then(|| Kernel::new::<TractionStress>(plan, place));
            Box::new(move |[x, y], [a, b]| {
                let traction = |axis: usize, at, half| {
                    let lateral = lateral.as_ref().filter(|_| wanted[axis])?;
                    Some(lateral.at::<TractionStress>(at, half))
                };
                let along = traction(0, [x, y], [a, b]).map_or(none, stresses);
                // Traction along y is traction along x with both exchanged.
                let across = traction(1, [y, x], [b, a]);
                let across = across.map_or(none, |values| stresses(EXCHANGED.map(|k| values[k])));
                [stresses(normal.at::<PressureStress>([x, y], [a, b])), along, across]
            })
        }
    }
}

/// Components of the traction at the surface, σ_zz, σ_yz and σ_xz, and their ratios to minus the pressure.
fn tractions([fx, fy]: [f64; 2]) -> [(usize, f64); 3] {
    [(2, 1.0), (4, fy), (5, fx)]
}

/// Cells of the margin: more than fits, closings of edges and the reach of loads together.
const MARGIN_CELLS: usize = 24;

/// A margin of images around the cells of a grid that repeats, so that the seam is like any other place: numbers of cells
/// of the grid, and of its margin on each side.
#[derive(Debug, Clone, Copy)]
struct Margin {
    shape: [usize; 2],
    width: [usize; 2],
}

impl Margin {
    /// The margin of `grid`; it has no cells along directions that do not repeat.
    fn of(grid: &Grid) -> Self {
        Self {
            shape: grid.shape(),
            width: grid.is_periodic().map(|repeats| if repeats { MARGIN_CELLS } else { 0 }),
        }
    }

    fn is_empty(self) -> bool {
        self.width == [0; 2]
    }

    fn wide_shape(self) -> [usize; 2] {
        [0, 1].map(|k| self.shape[k] + 2 * self.width[k])
    }

    /// The grid with its margin. Sides of cells stay to rounding, and the place does not matter.
    fn wide(self, grid: &Grid) -> Grid {
        let shape = self.wide_shape();
        let size = [0, 1].map(|k| shape[k] as f64 * grid.spacing()[k]);
        match self.is_empty() {
            true => *grid,
            false => Grid::new(shape, size).unwrap_or(*grid),
        }
    }

    /// Values of the cells with those of the margin, which repeat them.
    fn around(self, values: &[f64]) -> Cow<'_, [f64]> {
        if self.is_empty() {
            return Cow::Borrowed(values);
        }
        let ([nx, ny], [wx, wy]) = (self.shape, self.wide_shape());
        // Before the first cell lies the last.
        let place = |k: usize, at: usize| {
            let n = self.shape[k];
            (at + n * MARGIN_CELLS - self.width[k]) % n
        };
        debug_assert!(nx > 0 && ny > 0);
        let cells = (0..wx).flat_map(|i| (0..wy).map(move |j| (i, j)));
        Cow::Owned(cells.map(|(i, j)| values[place(0, i) * ny + place(1, j)]).collect())
    }

    /// Values of the cells from those with the margin.
    fn middle<T: Copy>(self, wide: &[T]) -> Vec<T> {
        let ([nx, ny], [_, wy]) = (self.shape, self.wide_shape());
        let rows = (0..nx).map(|i| (i + self.width[0]) * wy + self.width[1]);
        rows.flat_map(|start| wide[start..start + ny].iter().copied()).collect()
    }

    /// Number of a cell along both directions, counted with the margin.
    fn cell(self, cell: [usize; 2]) -> [usize; 2] {
        [0, 1].map(|k| cell[k] + self.width[k])
    }

    /// A window, counted with the margin.
    fn window(self, window: &Window) -> Window {
        [0, 1].map(|k| window[k].start + self.width[k]..window[k].end + self.width[k])
    }

    /// Calls `add` for stresses on the cells with their margin, and adds the middle of them to `stresses`.
    fn add(self, stresses: &mut [&mut [f64]], add: impl FnOnce(&mut [&mut [f64]])) {
        if self.is_empty() {
            add(stresses);
            return;
        }
        let [wx, wy] = self.wide_shape();
        let mut wide = vec![vec![0.0; wx * wy]; STRESSES];
        let mut planes: Vec<&mut [f64]> = wide.iter_mut().map(Vec::as_mut_slice).collect();
        add(&mut planes);
        for (stress, wide) in stresses.iter_mut().zip(&wide) {
            let middle = self.middle(wide);
            stress.iter_mut().zip(middle).for_each(|(s, w)| *s += w);
        }
    }
}
