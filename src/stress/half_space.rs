//! Stress and displacement of the body that extends along x and y: one plan, and its influence coefficients at any
//! place.

use std::ops::Range;

use ndarray::ArrayRef2;

use crate::compliance::influence::PlateWaves;
use crate::compliance::kernel::loads::{
    COMPONENTS, EXCHANGED, ODD, Pressure, PressureStress, Radial, Traction, TractionStress,
};
use crate::compliance::kernel::plane::{CellPlan, CellSource, Kernel, Kernels};
use crate::compliance::kernel::strip::LinePlan;
use crate::compliance::response::interior::Place;
use crate::compliance::response::{is_free, refuse_free, substrate_material};
use crate::error::{Result, all_finite, require, same_shape};
use crate::model::body::HalfSpace;
use crate::model::grid::{Grid, Window};
use crate::numerics::fft::{Keep, PaddedTransform, QuarterTransform, Transformed};
use crate::numerics::parallel::{Threads, check_memory, memory_of};
use crate::stress::subcell::{ByComponent, LocalSteps, STRESSES, StepErrors, SubcellStress};

mod evaluation;
mod repeats;

pub(super) use evaluation::{HalfSpacePart, Part, PlaneMemory, plane_arrays};
use repeats::{Repeats, RowSource, rows_of};

/// A half-space under a pressure, planned once and evaluated any number of times.
#[derive(Debug)]
pub(super) struct HalfSpacePlan {
    pub(super) body: HalfSpace,
    pub(super) grid: Grid,
    kernels: Kernels,
    repeats: Option<Repeats>,
    /// First and last row, then first and last column, of the loaded cells; none where no cell is loaded.
    loaded: Option<[[usize; 2]; 2]>,
    /// Number of offsets along x and y between a loaded cell and any other.
    offsets: [usize; 2],
    /// The pressure \[Pa\], in C order.
    pub(super) pressure: Vec<f64>,
    transform: PaddedTransform,
    quarter: QuarterTransform,
    /// Transform of the pressure that is taken as uniform over cells for stresses.
    uniform: Transformed,
    /// Present where the pressure is reconstructed within cells.
    pub(super) solved: Option<SolvedPressure>,
    pub(super) threads: Threads,
}

/// Additional parts of a solved contact's plan.
#[derive(Debug)]
pub(super) struct SolvedPressure {
    pub(super) subcell: SubcellStress,
    /// Transform of the solver's pressure, whose convolution gives displacements.
    solver_pressure: Transformed,
}

/// A load on the surface, in proportion to the pressure.
#[derive(Debug, Clone, Copy)]
pub(super) struct SurfaceLoad {
    /// Load per unit of pressure: 1, or a component of the friction.
    pub(super) factor: f64,
    /// Axis along which the traction acts; none for pressure.
    pub(super) axis: Option<usize>,
}

impl SurfaceLoad {
    pub(super) const PRESSURE: Self = Self { factor: 1.0, axis: None };

    /// Whether each component is odd in x and in y.
    fn odd(self) -> [[bool; 2]; COMPONENTS] {
        ODD.map(|odd| [0, 1].map(|along| odd[along] != (self.axis == Some(along))))
    }
}

/// The loads that act on a plan, and the components that are wanted.
#[derive(Debug)]
pub(super) struct Loading {
    loads: Vec<SurfaceLoad>,
    /// μ times the unit vector of the traction, under the pressure within cells.
    friction: [f64; 2],
    displacement: bool,
}

impl Loading {
    /// The pressure, and the tractions of `friction` that are not 0.
    pub(super) fn new(friction: [f64; 2], displacement: bool) -> Self {
        let tractions = friction.into_iter().enumerate();
        let tractions = tractions.map(|(axis, factor)| SurfaceLoad { factor, axis: Some(axis) });
        let tractions = tractions.filter(|load| load.factor != 0.0);
        Self {
            loads: std::iter::once(SurfaceLoad::PRESSURE).chain(tractions).collect(),
            friction,
            displacement,
        }
    }

    /// One load, which may be other than the pressure.
    fn one(load: SurfaceLoad, displacement: bool) -> Self {
        Self { loads: vec![load], friction: [0.0; 2], displacement }
    }

    fn components(&self) -> usize {
        components(self.displacement)
    }

    /// μ times the unit vector of the traction.
    pub(super) fn friction(&self) -> [f64; 2] {
        self.friction
    }
}

/// Number of components: six stresses, and three displacements where they are asked for.
pub(super) const fn components(displacement: bool) -> usize {
    if displacement { COMPONENTS } else { STRESSES }
}

impl HalfSpacePlan {
    /// The plan of a body under a `pressure` of [`checked_pressure`]; `subcell` has what is known of it within cells.
    /// Components are right in the cells of the window `wanted` only.
    pub(super) fn new(
        body: &HalfSpace,
        (grid, wanted): (&Grid, &Window),
        pressure: Vec<f64>,
        subcell: Option<SubcellStress>,
        threads: Threads,
    ) -> Self {
        let [lx, ly] = grid.size();
        let repeats = threads.run(|| Repeats::plan(body, grid));
        // One per cent more than the diagonal, for rounding.
        let reach = (repeats.as_ref()).map_or(1.01 * lx.hypot(ly), Repeats::reach);
        let kernels = threads.run(|| Kernels::new(&body.with_rigid_base(), grid, 1.0, reach));
        let uniform = subcell.as_ref().map_or(&*pressure, SubcellStress::uniform);
        let shape = grid.shape();
        let loaded = loaded_cells(shape, &[&pressure, uniform]);
        // From the first loaded cell to the last wanted one, from the first wanted cell to the last loaded one; and the
        // transforms are of the whole grid.
        let offsets = loaded.map_or(shape, |loaded| {
            [0, 1].map(|k| {
                let ahead = wanted[k].end.saturating_sub(loaded[k][0]);
                let behind = (loaded[k][1] + 1).saturating_sub(wanted[k].start);
                ahead.max(behind).max(shape[k].div_ceil(2))
            })
        });
        let transform = PaddedTransform::plan_even(shape, offsets, &threads);
        let transformed =
            |input: &[f64]| transform.transform(input, &mut transform.workspace(), &threads);
        let uniform = transformed(uniform);
        let solved = subcell
            .map(|subcell| SolvedPressure { subcell, solver_pressure: transformed(&pressure) });
        Self {
            body: body.clone(),
            grid: *grid,
            kernels,
            repeats,
            loaded,
            offsets,
            quarter: transform.quarter_transform(),
            pressure,
            transform,
            uniform,
            solved,
            threads,
        }
    }

    /// The plan of a body under a `pressure` that is uniform over cells, for the cells of the window `wanted`.
    pub(super) fn uniform(
        body: &HalfSpace,
        (grid, wanted): (&Grid, &Window),
        pressure: &ArrayRef2<f64>,
        threads: &Threads,
    ) -> Result<Self> {
        let pressure = checked_pressure(body, grid, pressure)?;
        check_memory(grid.shape(), Self::memory(grid, false))?;
        let threads = Threads::new(Some(threads.count()))?;
        Ok(Self::new(body, (grid, wanted), pressure, None, threads))
    }

    /// Bytes that planning takes.
    pub(super) fn memory(grid: &Grid, is_solved: bool) -> u64 {
        // The transform of the pressure and its rows, counted as 8 arrays of cells; the reconstruction
        // and the transform of the solver's pressure, as 24.
        let pressure = if is_solved { 8 + 24 } else { 8 };
        // Where the grid repeats, the coefficients of a component, at all offsets.
        let images = if grid.is_periodic() == [false; 2] { 0 } else { 2 * COMPONENTS };
        memory_of(grid.shape(), pressure + images)
    }

    /// Estimated errors of the stress at `place`, from the size of the cells, under this friction, and whether known tractions
    /// are taken within cells; none where the pressure is given as uniform over them.
    pub(super) fn errors(&self, place: &Place, friction: ([f64; 2], bool)) -> Option<StepErrors> {
        Some(self.solved.as_ref()?.subcell.errors(&self.body, place, friction))
    }

    /// Errors of the stress at the depth of `place` \[Pa\] due to the width of the contact in cells, at all places.
    pub(super) fn width_errors(&self, place: &Place, friction: [f64; 2]) -> ByComponent {
        let solved = self.solved.as_ref();
        let errors = |of: &SolvedPressure| of.subcell.width_errors(&self.body, place, friction);
        solved.map_or_else(ByComponent::default, errors)
    }

    /// Largest steps of the pressure that are felt in the cells of `window`.
    pub(super) fn steps(&self, window: &Window) -> LocalSteps {
        self.solved.as_ref().map_or_else(LocalSteps::default, |solved| solved.subcell.steps(window))
    }

    /// Those that are felt in each cell; no cells where the pressure is given as uniform over them.
    pub(super) fn steps_by_cell(&self) -> Vec<LocalSteps> {
        self.solved.as_ref().map_or_else(Vec::new, |solved| solved.subcell.steps_by_cell())
    }

    /// Pressure that is taken as uniform over cells for stresses.
    fn stress_pressure(&self) -> &[f64] {
        let solved = self.solved.as_ref();
        solved.map_or(&self.pressure, |solved| solved.subcell.uniform())
    }

    /// Number of cells between the loaded ones and the border of the grid along an axis.
    pub(super) fn gap(&self, axis: usize) -> usize {
        let count = self.grid.shape()[axis];
        self.loaded.map_or(count, |ends| ends[axis][0].min(count - 1 - ends[axis][1]))
    }

    /// Half the width of the cells with a pressure along their shorter side \[m\]; of the whole grid if there are none.
    /// Along directions that repeat, which have no first cell, the lines with a pressure count.
    pub(super) fn half_width(&self) -> f64 {
        let (grid, [nx, ny]) = (&self.grid, self.grid.shape());
        let loaded = loaded_cells([nx, ny], &[&self.pressure]);
        let lines = |axis: usize| -> usize {
            let touches = |line: &usize| match axis {
                0 => (0..ny).any(|j| self.pressure[line * ny + j] != 0.0),
                _ => (0..nx).any(|i| self.pressure[i * ny + line] != 0.0),
            };
            (0..[nx, ny][axis]).filter(touches).count()
        };
        let width = |axis: usize| {
            let cells = match loaded {
                None => grid.shape()[axis],
                Some(_) if grid.is_periodic()[axis] => lines(axis),
                Some(ends) => ends[axis][1] - ends[axis][0] + 1,
            };
            0.5 * cells as f64 * grid.spacing()[axis]
        };
        match grid.is_line() {
            true => width(1),
            false => width(0).min(width(1)),
        }
    }
}

/// Coefficients of a plan at one place.
#[derive(Debug, Clone, Copy)]
struct Coefficients<'a> {
    plan: &'a HalfSpacePlan,
    place: &'a Place,
    loading: &'a Loading,
    /// Numbers of offsets along x and y.
    offsets: [usize; 2],
    /// Whether offsets along x are half a cell longer: those between cells and the line between two rows.
    between: bool,
}

impl Coefficients<'_> {
    /// Calls `take` with the number of each load, and the source of its coefficients. On the threads of the caller.
    fn each(&self, take: &mut dyn FnMut(usize, &RowSource)) {
        let slides = self.loading.loads.iter().any(|load| load.axis.is_some());
        match &self.plan.kernels {
            Kernels::Line(plan) => self.strips(plan, take),
            // Stresses alone need fewer radial functions.
            Kernels::Plane(plan) if self.loading.displacement => {
                self.cells::<6, COMPONENTS, Pressure>(plan, take);
                if slides {
                    self.cells::<9, COMPONENTS, Traction>(plan, take);
                }
            }
            Kernels::Plane(plan) => {
                self.cells::<4, STRESSES, PressureStress>(plan, take);
                if slides {
                    self.cells::<6, STRESSES, TractionStress>(plan, take);
                }
            }
        }
    }

    fn strips(&self, plan: &LinePlan, take: &mut dyn FnMut(usize, &RowSource)) {
        for (number, load) in self.loading.loads.iter().enumerate() {
            let values = plan.coefficients(self.place, load.axis);
            take(number, &|rows: Range<usize>, keep: &mut Keep| {
                for i in rows {
                    for k in 0..self.loading.components() {
                        let row: Vec<f64> = values.iter().map(|values| values[k]).collect();
                        keep(i, k, &row);
                    }
                }
            });
        }
    }

    /// C coefficients of the loads of the kind L: of pressure, or of the tractions along x and along y. Where the grid
    /// repeats, all offsets are computed at once, from those of one cell at the near ones.
    fn cells<const N: usize, const C: usize, L: Radial<N>>(
        &self,
        plan: &CellPlan,
        take: &mut dyn FnMut(usize, &RowSource),
    ) {
        let kernel = Kernel::new::<L>(plan, self.place);
        let repeats = self.plan.repeats.as_ref();
        let block = repeats.map(|repeats| repeats.block_kernel::<N, L>(self.place));
        let of_kind = |load: &SurfaceLoad| load.axis.is_some() == L::IS_TRACTION;
        let loads = self.loading.loads.iter().enumerate();
        for (number, load) in loads.filter(|(_, load)| of_kind(load)) {
            // Traction along y is traction along x with both exchanged.
            let is_exchanged = load.axis == Some(1);
            let seen = |[x, y]: [f64; 2]| if is_exchanged { [y, x] } else { [x, y] };
            let turned = |values: [f64; COMPONENTS]| match is_exchanged {
                true => EXCHANGED.map(|k| values[k]),
                false => values,
            };
            let half = seen(self.plan.grid.spacing().map(|d| 0.5 * d));
            let odd = load.odd();
            let source = CellSource {
                offsets: repeats.map_or(self.offsets, Repeats::extents),
                spacing: self.plan.grid.spacing(),
                depth: self.place.depth,
                between: self.between,
                odd: std::array::from_fn::<_, C, _>(|k| odd[k]),
                mean: |x, y| turned(kernel.at::<L>(seen([x, y]), half)),
                point: |x, y| {
                    let [x, y] = seen([x, y]);
                    turned(kernel.far::<L>(x, y))
                },
            };
            let Some(repeats) = repeats else {
                take(number, &|rows, keep| source.rows(rows, keep));
                continue;
            };
            let of_block = |at: [f64; 2], half: [f64; 2]| match &block {
                Some(block) => turned(block.at::<L>(seen(at), seen(half))),
                None => [0.0; COMPONENTS],
            };
            let summed = repeats.coefficients(&source, of_block, (self.place, load.axis));
            take(number, &*rows_of(&summed, self.offsets[1]));
        }
    }
}

/// Smallest and largest length and modulus, in whatever units: kernels take fifth powers of lengths and
/// fourth powers of moduli, which neither overflow nor vanish between these.
pub(super) const MAGNITUDES: [f64; 2] = [1e-60, 1e60];

/// Refuses lengths and moduli outside of [`MAGNITUDES`].
fn check_magnitudes(body: &HalfSpace, grid: &Grid) -> Result<()> {
    let check = |name, value: f64| {
        let requirement = "between 1e-60 and 1e60 for stresses (take other units)";
        require(name, value, (MAGNITUDES[0]..=MAGNITUDES[1]).contains(&value), requirement)
    };
    for axis in 0..2 {
        check("size of the grid", grid.size()[axis])?;
        check("spacing of the grid", grid.spacing()[axis])?;
    }
    for layer in body.layers() {
        check("thickness", layer.thickness())?;
        check("young", layer.material().young())?;
    }
    if let Some(material) = substrate_material(body) {
        check("young", material.young())?;
    }
    Ok(())
}

/// Refuses a plate with a free base where its load has no equilibrium, or cells are much wider than it is thick.
fn check_base(body: &HalfSpace, grid: &Grid) -> Result<()> {
    if !is_free(body) {
        return Ok(());
    }
    if grid.is_periodic() != [true; 2] {
        refuse_free(body, "a body on a grid that is not periodic along x and along y")?;
    }
    PlateWaves::new(body, grid).map(|_| ())
}

/// `pressure` in C order.
///
/// # Errors
/// A plate with a free base on a grid that is not periodic along x and along y; lengths and moduli outside of [`MAGNITUDES`]; a pressure that is not finite or not of the grid's shape.
pub(super) fn checked_pressure(
    body: &HalfSpace,
    grid: &Grid,
    pressure: &ArrayRef2<f64>,
) -> Result<Vec<f64>> {
    check_magnitudes(body, grid)?;
    check_base(body, grid)?;
    same_shape("pressure", pressure, grid.shape())?;
    all_finite("pressure", pressure)?;
    Ok(pressure.iter().copied().collect())
}

/// First and last row, then first and last column, of the cells that any of `pressures` loads; none
/// where all are zero.
fn loaded_cells(shape: [usize; 2], pressures: &[&[f64]]) -> Option<[[usize; 2]; 2]> {
    let mut ends = [[usize::MAX, 0]; 2];
    for pressure in pressures {
        for (k, _) in pressure.iter().enumerate().filter(|(_, p)| **p != 0.0) {
            for (end, at) in ends.iter_mut().zip([k / shape[1], k % shape[1]]) {
                *end = [end[0].min(at), end[1].max(at)];
            }
        }
    }
    (ends[0][0] <= ends[0][1]).then_some(ends)
}
