//! Stress and displacement of a plan, on one plane z = const after another: each component is one
//! convolution.

use std::ops::{ControlFlow, Range};

use super::options::StressProgress;
use super::plan::{StressPlan, transforms_memory};
use super::subcell::{NearTable, STRESSES};
use crate::fft::{Keep, KernelRows, Workspace};
use crate::grid::Grid;
use crate::kernel::cells::Source;
use crate::kernel::loads::{
    self, COMPONENTS, EXCHANGED, Load, ODD, PressureStress, TractionStress,
};
use crate::kernel::plane::{Kernel, Plan};
use crate::kernel::plans::Kernels;
use crate::kernel::strip::{self, LinePlan};
use crate::parallel::Threads;
use crate::response::interior::Place;

/// Components that are convolved together. More of them read the load's transform less often; fewer
/// write and read less memory in between. Chosen by trial.
const TOGETHER: usize = 3;

// Stresses and displacements come from different pressures: no three components may mix them.
const _: () = assert!(STRESSES.is_multiple_of(TOGETHER));

/// A plan under one friction, with the memory that all its planes use.
#[derive(Debug)]
pub(super) struct PlaneEvaluator<'a> {
    plan: &'a StressPlan,
    /// μ times the unit vector of the traction.
    friction: [f64; 2],
    /// Number of components: the stresses, or all with the displacements.
    components: usize,
    loads: Vec<LoadRows>,
    workspace: Workspace,
    near: NearTable,
}

/// Transformed coefficients of one load at one depth.
#[derive(Debug)]
struct LoadRows {
    /// Load per unit of pressure: 1, or a component of the friction.
    factor: f64,
    /// Axis along which the traction acts; none for pressure.
    axis: Option<usize>,
    rows: KernelRows,
}

/// Whether each component is odd in x and in y, under traction along `axis` or under pressure.
fn odd(axis: Option<usize>) -> [[bool; 2]; COMPONENTS] {
    ODD.map(|odd| [0, 1].map(|along| odd[along] != (axis == Some(along))))
}

impl<'a> PlaneEvaluator<'a> {
    pub(super) fn new(plan: &'a StressPlan, friction: [f64; 2], displacement: bool) -> Self {
        let components = components(displacement);
        let loads = [(1.0, None), (friction[0], Some(0)), (friction[1], Some(1))];
        let loads = loads.into_iter().filter(|(factor, _)| *factor != 0.0);
        let rows = |axis| {
            let odd = odd(axis)[..components].to_vec();
            plan.transform.kernel_rows(plan.offsets, odd)
        };
        Self {
            plan,
            friction,
            components,
            loads: loads
                .map(|(factor, axis)| LoadRows {
                    factor,
                    axis,
                    rows: rows(axis),
                })
                .collect(),
            workspace: plan.transform.workspace(),
            near: NearTable::default(),
        }
    }

    /// Bytes that an evaluator takes.
    pub(super) fn memory(grid: &Grid, slides: bool, displacement: bool) -> u64 {
        let loads = if slides { 3 } else { 1 };
        // Coefficients of each load and component, and of the components that are convolved together
        // a spectrum and a result each.
        let arrays = loads * components(displacement) + 2 * TOGETHER;
        transforms_memory(grid, arrays as u64)
    }

    /// Writes the components at `place` to `outputs`, whole planes of (nx, ny) cells. `progress` is told
    /// the fraction of this plane that is done; where it breaks, `outputs` are incomplete.
    pub(super) fn evaluate(
        &mut self,
        place: &Place,
        outputs: &mut [&mut [f64]],
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        let plan = self.plan;
        plan.threads.run(|| {
            if let Some(solved) = &plan.solved {
                self.near = solved.subcell.table(place, self.friction);
            }
            self.coefficients(place);
        });
        let sets: Vec<_> = self.loads.iter().map(|l| (l.factor, &l.rows)).collect();
        let mut done = 0;
        for outputs in outputs.chunks_mut(TOGETHER) {
            progress(done as f64 / self.components as f64)?;
            let numbers = done..done + outputs.len();
            done = numbers.end;
            let pressure = match &plan.solved {
                Some(solved) if numbers.start >= STRESSES => &solved.given,
                _ => &plan.uniform,
            };
            plan.threads.run(|| {
                plan.transform.convolve_parities(
                    pressure,
                    (&plan.quarter, &sets),
                    numbers,
                    outputs,
                    &mut self.workspace,
                    &plan.threads,
                );
            });
        }
        if let Some(solved) = &plan.solved {
            let stresses = &mut outputs[..STRESSES];
            let add = || solved.subcell.add(&self.near, self.friction, stresses);
            plan.threads.run(add);
        }
        ControlFlow::Continue(())
    }

    /// Computes the coefficients of all loads at `place`. On the threads of the caller.
    fn coefficients(&mut self, place: &Place) {
        let slides = self.loads.iter().any(|load| load.axis.is_some());
        match &self.plan.kernels {
            Kernels::Line(plan) => self.strips(plan, place),
            Kernels::Plane {
                plan,
                pressure,
                traction,
            } => {
                // Made without rayon, so that a thread that waits for it cannot be asked to make it.
                let traction = slides
                    .then(|| traction.get_or_init(|| plan.multipliers::<9, loads::Traction>()));
                // Stresses alone need fewer radial functions.
                if self.components > STRESSES {
                    self.cells::<6, COMPONENTS, loads::Pressure>(plan, pressure, place, false);
                    if let Some(traction) = traction {
                        self.cells::<9, COMPONENTS, loads::Traction>(plan, traction, place, true);
                    }
                } else {
                    self.cells::<4, STRESSES, PressureStress>(plan, pressure, place, false);
                    if let Some(traction) = traction {
                        self.cells::<6, STRESSES, TractionStress>(plan, traction, place, true);
                    }
                }
            }
        }
    }

    /// Computes the coefficients of line contact.
    fn strips(&mut self, plan: &LinePlan, place: &Place) {
        for LoadRows { axis, rows, .. } in &mut self.loads {
            let values = match axis {
                None => plan.coefficients::<6, strip::Pressure>(place),
                Some(0) => plan.coefficients::<3, strip::Along>(place),
                Some(_) => plan.coefficients::<6, strip::Across>(place),
            };
            let components = rows.count();
            let source = |rows: Range<usize>, keep: &mut Keep| {
                for i in rows {
                    for k in 0..components {
                        let row: Vec<f64> = values.iter().map(|values| values[k]).collect();
                        keep(i, k, &row);
                    }
                }
            };
            transform_rows(self.plan, rows, &source, &mut self.workspace);
        }
    }

    /// Computes C coefficients of pressure, or, if `lateral`, of the tractions along x and along y.
    fn cells<const N: usize, const C: usize, L: Load<N>>(
        &mut self,
        plan: &Plan,
        multipliers: &[Vec<(f64, f64)>],
        place: &Place,
        lateral: bool,
    ) {
        let kernel = Kernel::new::<L>(plan, multipliers, place);
        let (offsets, spacing) = (self.plan.offsets, self.plan.grid.spacing());
        let half @ [a, b] = spacing.map(|d| 0.5 * d);
        let depth = place.depth;
        let loads = self.loads.iter_mut();
        for load in loads.filter(|load| load.axis.is_some() == lateral) {
            let odd = odd(load.axis);
            let odd: [[bool; 2]; C] = std::array::from_fn(|k| odd[k]);
            let mut transform = |source: &RowSource| {
                transform_rows(self.plan, &mut load.rows, source, &mut self.workspace);
            };
            if load.axis == Some(1) {
                // Traction along y is traction along x with both exchanged.
                let exchanged = |values: [f64; COMPONENTS]| EXCHANGED.map(|k| values[k]);
                let source = Source {
                    offsets,
                    spacing,
                    depth,
                    odd,
                    mean: |x, y| exchanged(kernel.at::<L>([y, x], [b, a])),
                    point: |x, y| exchanged(kernel.far::<L>(y, x)),
                };
                transform(&|rows, keep| source.rows(rows, keep));
            } else {
                let source = Source {
                    offsets,
                    spacing,
                    depth,
                    odd,
                    mean: |x, y| kernel.at::<L>([x, y], half),
                    point: |x, y| kernel.far::<L>(x, y),
                };
                transform(&|rows, keep| source.rows(rows, keep));
            }
        }
    }
}

/// Number of components: six stresses, and three displacements where they are asked for.
pub(super) fn components(displacement: bool) -> usize {
    if displacement { COMPONENTS } else { STRESSES }
}

/// Gives the coefficients of some rows to its second argument.
type RowSource<'a> = dyn Fn(Range<usize>, &mut Keep) + Sync + 'a;

/// Transforms the coefficients of `source` along y into `rows`.
fn transform_rows(
    plan: &StressPlan,
    rows: &mut KernelRows,
    source: &RowSource,
    workspace: &mut Workspace,
) {
    let threads: &Threads = &plan.threads;
    plan.transform
        .transform_rows(&plan.quarter, rows, source, workspace, threads);
}
