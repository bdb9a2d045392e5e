//! Stress and displacement of a plan, on one plane z = const after another: each component is one
//! convolution.

use std::ops::ControlFlow;

use ndarray::Array2;

use super::plan::{HalfSpacePlan, transforms_memory};
use crate::compliance::response::interior::Place;
use crate::model::grid::Grid;
use crate::numerics::fft::{KernelRows, Workspace};
use crate::numerics::parallel::Threads;
use crate::stress::options::StressProgress;
use crate::stress::subcell::{NearTable, STRESSES};

use super::coefficients::{Coefficients, RowSource, SurfaceLoad, components};

/// Components that are convolved together. More of them read the load's transform less often; fewer
/// write and read less memory in between. Chosen by trial.
const TOGETHER: usize = 3;

/// Depth in cells that stands for the surface, at edges of cells.
const SHALLOW: f64 = 1e-9;

// Stresses and displacements come from different pressures: no three components may mix them.
const _: () = assert!(STRESSES.is_multiple_of(TOGETHER));

/// A plan under one friction, with the memory that all its planes use.
#[derive(Debug)]
pub(in crate::stress) struct PlaneEvaluator<'a> {
    plan: &'a HalfSpacePlan,
    /// μ times the unit vector of the traction.
    friction: [f64; 2],
    /// Number of components: the stresses, or all with the displacements.
    components: usize,
    loads: Vec<SurfaceLoad>,
    /// Transformed coefficients of each load at one depth.
    rows: Vec<KernelRows>,
    workspace: Workspace,
    near: NearTable,
    /// Whether coefficients are those of the line between two rows.
    between: bool,
}

impl<'a> PlaneEvaluator<'a> {
    pub(in crate::stress) fn new(
        plan: &'a HalfSpacePlan,
        friction: [f64; 2],
        displacement: bool,
    ) -> Self {
        Self {
            friction,
            ..Self::under(plan, SurfaceLoad::all(friction), displacement)
        }
    }

    /// The plan under `loads` in proportion to its pressure, which may leave out the pressure itself.
    pub(super) fn under(
        plan: &'a HalfSpacePlan,
        loads: Vec<SurfaceLoad>,
        displacement: bool,
    ) -> Self {
        let components = components(displacement);
        let rows = |load: &SurfaceLoad| {
            let odd = load.odd()[..components].to_vec();
            plan.transform.kernel_rows(plan.offsets, odd)
        };
        Self {
            plan,
            friction: [0.0; 2],
            components,
            rows: loads.iter().map(rows).collect(),
            loads,
            workspace: plan.transform.workspace(),
            near: NearTable::default(),
            between: false,
        }
    }

    /// The components at `place` below the line between the rows `row` − 1 and `row`, for each of them along y, under the
    /// pressure of a `plan` that is uniform over cells. `progress` is told 0.
    pub(in crate::stress) fn between(
        plan: &'a HalfSpacePlan,
        loads: Vec<SurfaceLoad>,
        displacement: bool,
        (place, row): (&Place, usize),
        progress: &mut StressProgress,
    ) -> ControlFlow<(), Vec<Vec<f64>>> {
        let [nx, ny] = plan.grid.shape();
        let components = components(displacement);
        // At the surface, the line is on edges of cells, where kernels have the mean of both sides as their limit.
        let mut below = *place;
        if place.depth <= 0.0 {
            below.depth = SHALLOW * plan.grid.spacing()[0];
            below.below_top = below.depth;
        }
        // The loads on either side are convolved for themselves, at the row beside the line: the kernel's offsets then
        // are whole numbers of cells and half a cell, and its parity along x is a sign.
        let along_y = |load: &SurfaceLoad| {
            let odd = load.odd().map(|[_, y]| [false, y])[..components].to_vec();
            plan.transform.kernel_rows(plan.offsets, odd)
        };
        let mut evaluator = Self {
            rows: loads.iter().map(along_y).collect(),
            between: true,
            ..Self::under(plan, loads, displacement)
        };
        plan.threads.run(|| evaluator.coefficients(&below));
        let mut lines = vec![vec![0.0; ny]; components];
        let mut plane = vec![0.0; nx * ny];
        for (loaded, beside) in [(0..row, row.wrapping_sub(1)), (row..nx, row)] {
            if loaded.is_empty() {
                continue;
            }
            let mut pressure = vec![0.0; nx * ny];
            let cells = loaded.start * ny..loaded.end * ny;
            pressure[cells.clone()].copy_from_slice(&plan.pressure[cells]);
            let is_behind = beside == row;
            let workspace = &mut evaluator.workspace;
            let transformed = plan.threads.run(|| {
                plan.transform
                    .transform(&pressure, workspace, &plan.threads)
            });
            for (number, line) in lines.iter_mut().enumerate() {
                progress(0.0)?;
                let sets = evaluator.loads.iter().zip(&evaluator.rows);
                let sets: Vec<_> = sets
                    .map(|(load, rows)| {
                        let turns = is_behind && load.odd()[number][0];
                        (if turns { -load.factor } else { load.factor }, rows)
                    })
                    .collect();
                plan.threads.run(|| {
                    plan.transform.convolve_parities(
                        &transformed,
                        (&plan.quarter, &sets),
                        number..number + 1,
                        &mut [&mut plane],
                        &mut evaluator.workspace,
                        &plan.threads,
                    );
                });
                let values = line.iter_mut().zip(&plane[beside * ny..]);
                values.for_each(|(sum, value)| *sum += value);
            }
        }
        ControlFlow::Continue(lines)
    }

    /// Bytes that an evaluator takes.
    pub(in crate::stress) fn memory(grid: &Grid, slides: bool, displacement: bool) -> u64 {
        let loads = if slides { 3 } else { 1 };
        // Coefficients of each load and component, and of the components that are convolved together
        // a spectrum and a result each.
        let arrays = loads * components(displacement) + 2 * TOGETHER;
        transforms_memory(grid, arrays as u64)
    }

    /// Writes the components at `place` to `outputs`, whole planes of (nx, ny) cells. `progress` is told
    /// the fraction of this plane that is done; where it breaks, `outputs` are incomplete.
    pub(in crate::stress) fn evaluate(
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
        let factors = self.loads.iter().map(|load| load.factor);
        let sets: Vec<_> = factors.zip(&self.rows).collect();
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

    /// Adds to `sums` (nx, ny) the convolutions of `weights`, one for each stress, with the transposed kernels at `place`.
    pub(in crate::stress) fn transposed(
        &mut self,
        place: &Place,
        weights: &[Vec<f64>; STRESSES],
        sums: &mut Array2<f64>,
    ) {
        let plan = self.plan;
        plan.threads.run(|| self.coefficients(place));
        let mut part = vec![0.0; sums.len()];
        for (number, weights) in weights.iter().enumerate() {
            if weights.iter().all(|w| *w == 0.0) {
                continue;
            }
            let factors = self.loads.iter().map(|load| {
                let odd = load.odd()[number].into_iter().filter(|odd| *odd).count();
                if odd == 1 { -load.factor } else { load.factor }
            });
            let sets: Vec<_> = factors.zip(&self.rows).collect();
            plan.threads.run(|| {
                let input = plan
                    .transform
                    .transform(weights, &mut self.workspace, &plan.threads);
                plan.transform.convolve_parities(
                    &input,
                    (&plan.quarter, &sets),
                    number..number + 1,
                    &mut [&mut part],
                    &mut self.workspace,
                    &plan.threads,
                );
            });
            sums.iter_mut()
                .zip(&part)
                .for_each(|(sum, part)| *sum += part);
        }
    }

    /// Computes the coefficients of all loads at `place`. On the threads of the caller.
    fn coefficients(&mut self, place: &Place) {
        let plan = self.plan;
        let coefficients = Coefficients {
            plan,
            place,
            offsets: plan.offsets,
            displacement: self.components > STRESSES,
            between: self.between,
        };
        let (rows, workspace) = (&mut self.rows, &mut self.workspace);
        coefficients.each(&self.loads, &mut |number, source| {
            transform_rows(plan, &mut rows[number], source, workspace);
        });
    }
}

/// Transforms the coefficients of `source` along y into `rows`.
fn transform_rows(
    plan: &HalfSpacePlan,
    rows: &mut KernelRows,
    source: &RowSource,
    workspace: &mut Workspace,
) {
    let threads: &Threads = &plan.threads;
    plan.transform
        .transform_rows(&plan.quarter, rows, source, workspace, threads);
}
