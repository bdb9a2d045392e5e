//! Stress and displacement of a plan on whole planes, in some cells, and on the line between two rows; and the parts of
//! which those of a body are made.

use std::fmt;
use std::ops::{ControlFlow, Range};

use ndarray::Array2;
use rayon::prelude::*;

use super::repeats::RowSource;
use super::{Coefficients, HalfSpacePlan, Loading, SurfaceLoad, components};
use crate::compliance::kernel::COMPONENTS;
use crate::compliance::response::interior::Place;
use crate::numerics::fft::{KernelRows, TransformMemory, Transformed};
use crate::stress::options::StressProgress;
use crate::stress::subcell::{PointStress, STRESSES, Tractions};

/// Components that are convolved together. More of them read the load's transform less often; fewer
/// write and read less memory in between.
const TOGETHER: usize = 3;

// Stresses and displacements come from different pressures: no three components may mix them.
const _: () = assert!(STRESSES.is_multiple_of(TOGETHER));

/// Depth in cells that stands for the surface, at edges of cells.
const SURFACE_DEPTH: f64 = 1e-9;

/// Rows of coefficients that one thread makes at a time for points. Each such block makes two more rows; few blocks
/// leave threads idle.
const POINT_ROWS: usize = 8;

/// Memory that all planes of a plan under one loading use.
#[derive(Debug)]
pub(in crate::stress) struct PlaneMemory {
    /// Transformed coefficients of each load at one depth.
    rows: Vec<KernelRows>,
    workspace: TransformMemory,
    /// Components of a part, on its own cells.
    fields: Vec<Vec<f64>>,
    /// What pressure within cells added to the last plane, if that is kept.
    within_cells: Option<[Vec<f64>; STRESSES]>,
}

impl PlaneMemory {
    /// Keeps what pressure within cells adds to a plane, or no longer.
    pub(in crate::stress) fn keep_within_cells(&mut self, keep: bool) {
        self.within_cells = keep.then(|| self.within_cells.take().unwrap_or_default());
    }

    /// What pressure within cells added to the last plane, if that is kept.
    pub(in crate::stress) fn within_cells(&self) -> Option<&[Vec<f64>; STRESSES]> {
        self.within_cells.as_ref()
    }
}

/// Arrays of cells of [`PlaneMemory`]: coefficients of each load and component, and of the components that are convolved
/// together a spectrum and a result each.
pub(in crate::stress) fn plane_arrays(slides: bool, displacement: bool) -> usize {
    let loads = if slides { 3 } else { 1 };
    loads * components(displacement) + 2 * TOGETHER
}

impl HalfSpacePlan {
    pub(in crate::stress) fn plane_memory(&self, loading: &Loading) -> PlaneMemory {
        self.memory_with_parity(loading, |odd| odd)
    }

    /// Memory for kernels of which each component has the parity of `odd`, given its own.
    fn memory_with_parity(
        &self,
        loading: &Loading,
        odd: impl Fn([bool; 2]) -> [bool; 2],
    ) -> PlaneMemory {
        let rows = |load: &SurfaceLoad| {
            let odd = load.odd().map(&odd)[..loading.components()].to_vec();
            self.transform.kernel_rows(self.offsets, odd)
        };
        PlaneMemory {
            rows: loading.loads.iter().map(rows).collect(),
            workspace: self.transform.workspace(),
            fields: Vec::new(),
            within_cells: None,
        }
    }

    /// Writes the components at `place` to `outputs`, whole planes of (nx, ny) cells. `progress` is told
    /// the fraction of this plane that is done; where it breaks, `outputs` are incomplete.
    pub(in crate::stress) fn plane(
        &self,
        loading: &Loading,
        place: &Place,
        memory: &mut PlaneMemory,
        outputs: &mut [&mut [f64]],
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        let friction = loading.friction;
        let near = self.threads.run(|| {
            let solved = self.solved.as_ref();
            let near = solved.map(|solved| solved.subcell.table(place, friction));
            self.transform_coefficients(loading, place, false, memory);
            near
        });
        let mut done = 0;
        for outputs in outputs.chunks_mut(TOGETHER) {
            progress(done as f64 / loading.components() as f64)?;
            let numbers = done..done + outputs.len();
            done = numbers.end;
            let pressure = match &self.solved {
                Some(solved) if numbers.start >= STRESSES => &solved.solver_pressure,
                _ => &self.uniform,
            };
            let factor = |load: &SurfaceLoad| load.factor;
            self.convolve(pressure, loading, factor, numbers, memory, outputs);
        }
        if let (Some(solved), Some(near)) = (&self.solved, near) {
            let stresses = &mut outputs[..STRESSES];
            let kept = memory.within_cells.iter_mut().flatten();
            kept.zip(&*stresses).for_each(|(kept, stress)| kept.clone_from(&stress.to_vec()));
            self.threads.run(|| solved.subcell.add(&near, friction, stresses));
            for (kept, stress) in memory.within_cells.iter_mut().flatten().zip(stresses) {
                kept.iter_mut().zip(&**stress).for_each(|(kept, stress)| *kept = stress - *kept);
            }
        }
        ControlFlow::Continue(())
    }

    /// Convolutions of a pressure with the components of these `numbers`, summed over the loads times a `factor` each.
    fn convolve(
        &self,
        pressure: &Transformed,
        loading: &Loading,
        factor: impl Fn(&SurfaceLoad) -> f64,
        numbers: Range<usize>,
        memory: &mut PlaneMemory,
        outputs: &mut [&mut [f64]],
    ) {
        let PlaneMemory { rows, workspace, .. } = memory;
        let sets: Vec<_> = loading.loads.iter().map(factor).zip(&*rows).collect();
        let kernels = (&self.quarter, &*sets);
        self.threads.run(|| {
            self.transform.convolve_parities(
                pressure,
                kernels,
                numbers,
                outputs,
                workspace,
                &self.threads,
            );
        });
    }

    /// Transforms the coefficients of all loads at `place` along y. On the threads of the caller.
    fn transform_coefficients(
        &self,
        loading: &Loading,
        place: &Place,
        between: bool,
        memory: &mut PlaneMemory,
    ) {
        let coefficients =
            Coefficients { plan: self, place, loading, offsets: self.offsets, between };
        let PlaneMemory { rows, workspace, .. } = memory;
        coefficients.each(&mut |number, source| {
            let rows = &mut rows[number];
            self.transform.transform_rows(&self.quarter, rows, source, workspace, &self.threads);
        });
    }

    /// The convolutions of `weights`, one for each stress, with the transposed kernels at `place`, summed.
    pub(in crate::stress) fn transposed(
        &self,
        loading: &Loading,
        place: &Place,
        weights: &[Vec<f64>; STRESSES],
    ) -> Array2<f64> {
        let mut memory = self.plane_memory(loading);
        self.threads.run(|| self.transform_coefficients(loading, place, false, &mut memory));
        let mut sums = Array2::zeros(self.grid.shape());
        let mut part = vec![0.0; sums.len()];
        for (number, weights) in weights.iter().enumerate() {
            if weights.iter().all(|w| *w == 0.0) {
                continue;
            }
            let factor = |load: &SurfaceLoad| {
                let odd = load.odd()[number].into_iter().filter(|odd| *odd).count();
                if odd == 1 { -load.factor } else { load.factor }
            };
            let input = self.transformed(weights, &mut memory);
            let numbers = number..number + 1;
            self.convolve(&input, loading, factor, numbers, &mut memory, &mut [&mut part]);
            add_scaled(sums.iter_mut(), 1.0, &part);
        }
        sums
    }

    fn transformed(&self, input: &[f64], memory: &mut PlaneMemory) -> Transformed {
        let workspace = &mut memory.workspace;
        self.threads.run(|| self.transform.transform(input, workspace, &self.threads))
    }

    /// The components at `place` below the line between the rows `row` − 1 and `row`, for each of them along y, under a
    /// pressure that is uniform over cells. `progress` is told 0.
    ///
    /// The loads on either side are convolved for themselves, at the row beside the line: the kernel's offsets then
    /// are whole numbers of cells and half a cell, and its parity along x is a sign.
    pub(in crate::stress) fn line(
        &self,
        loading: &Loading,
        (place, row): (&Place, usize),
        progress: &mut StressProgress,
    ) -> ControlFlow<(), Vec<Vec<f64>>> {
        let [nx, ny] = self.grid.shape();
        // At the surface, the line is on edges of cells, where kernels have the mean of both sides as their limit.
        let mut below = *place;
        if place.depth <= 0.0 {
            below.depth = SURFACE_DEPTH * self.grid.spacing()[0];
            below.below_top = below.depth;
        }
        let mut memory = self.memory_with_parity(loading, |[_, y]| [false, y]);
        self.threads.run(|| self.transform_coefficients(loading, &below, true, &mut memory));
        let mut lines = vec![vec![0.0; ny]; loading.components()];
        let mut plane = vec![0.0; nx * ny];
        for (loaded, beside) in [(0..row, row.wrapping_sub(1)), (row..nx, row)] {
            if loaded.is_empty() {
                continue;
            }
            let mut pressure = vec![0.0; nx * ny];
            let cells = loaded.start * ny..loaded.end * ny;
            pressure[cells.clone()].copy_from_slice(&self.pressure[cells]);
            let is_behind = beside == row;
            let input = self.transformed(&pressure, &mut memory);
            for (number, line) in lines.iter_mut().enumerate() {
                progress(0.0)?;
                let factor = |load: &SurfaceLoad| match is_behind && load.odd()[number][0] {
                    true => -load.factor,
                    false => load.factor,
                };
                let numbers = number..number + 1;
                self.convolve(&input, loading, factor, numbers, &mut memory, &mut [&mut plane]);
                add_scaled(line.iter_mut(), 1.0, &plane[beside * ny..]);
            }
        }
        ControlFlow::Continue(lines)
    }

    /// Components at `place` in each of the `cells`; without displacements, the last three are 0. `progress` is told 0.
    ///
    /// A direct sum over the loaded cells is far cheaper than the convolutions of a plane of which all other cells are
    /// dropped.
    pub(in crate::stress) fn points(
        &self,
        loading: &Loading,
        place: &Place,
        cells: &[[usize; 2]],
        progress: &mut StressProgress,
    ) -> ControlFlow<(), Vec<[f64; COMPONENTS]>> {
        progress(0.0)?;
        // From a cell to the loaded cell that is farthest from it.
        let offsets = [0, 1].map(|axis| {
            let [first, last] = self.loaded.map_or([0, 0], |ends| ends[axis]);
            let distance =
                |cell: &[usize; 2]| cell[axis].abs_diff(first).max(cell[axis].abs_diff(last));
            cells.iter().map(distance).max().unwrap_or(0) + 1
        });
        let coefficients = Coefficients { plan: self, place, loading, offsets, between: false };
        let mut sums = vec![[0.0; COMPONENTS]; cells.len()];
        self.threads.run(|| {
            coefficients.each(&mut |number, source| {
                let load = loading.loads[number];
                let starts: Vec<usize> = (0..offsets[0]).step_by(POINT_ROWS).collect();
                let block = |start: &usize| {
                    let rows = *start..(start + POINT_ROWS).min(offsets[0]);
                    self.sums_of_rows(load, source, rows, cells)
                };
                // In the order of the rows, whatever the number of threads.
                let blocks: Vec<_> = starts.par_iter().map(block).collect();
                for block in blocks {
                    for (sums, parts) in sums.iter_mut().zip(block) {
                        add_scaled(sums.iter_mut(), load.factor, &parts);
                    }
                }
            });
            if let Some(solved) = &self.solved {
                let near = solved.subcell.table(place, loading.friction);
                for (cell, sums) in cells.iter().zip(&mut sums) {
                    let stresses = &mut sums[..STRESSES];
                    solved.subcell.add_at(&near, loading.friction, *cell, stresses);
                }
            }
        });
        ControlFlow::Continue(sums)
    }

    /// What gives stresses at `place` below any point, under the pressure and `tractions`; none where the pressure is given
    /// as uniform over cells.
    pub(in crate::stress) fn point_stress<'a>(
        &'a self,
        place: &Place,
        tractions: Tractions<'a>,
    ) -> Option<PointStress<'a>> {
        let solved = self.solved.as_ref()?;
        Some(solved.subcell.point_stress((&self.body, &self.grid), place, tractions, &self.threads))
    }

    /// Sums over the loaded cells at some offsets along x, before and behind each cell.
    fn sums_of_rows(
        &self,
        load: SurfaceLoad,
        source: &RowSource,
        rows: Range<usize>,
        cells: &[[usize; 2]],
    ) -> Vec<[f64; COMPONENTS]> {
        let [nx, ny] = self.grid.shape();
        let odd = load.odd();
        let mut sums = vec![[0.0; COMPONENTS]; cells.len()];
        source(rows, &mut |offset, k, coefficients| {
            let pressure = match k < STRESSES {
                true => self.stress_pressure(),
                false => &self.pressure,
            };
            let row = |i: usize| &pressure[i * ny..(i + 1) * ny];
            for ([i, j], sums) in cells.iter().zip(&mut sums) {
                let mut sum = 0.0;
                if *i >= offset {
                    sum += along_row(coefficients, row(i - offset), *j, odd[k][1]);
                }
                if offset > 0 && i + offset < nx {
                    let behind = along_row(coefficients, row(i + offset), *j, odd[k][1]);
                    sum += if odd[k][0] { -behind } else { behind };
                }
                sums[k] += sum;
            }
        });
        sums
    }
}

/// Sum of `coefficients`, by offset along y, times the pressures of a row, seen from column j.
fn along_row(coefficients: &[f64], pressures: &[f64], j: usize, odd: bool) -> f64 {
    let (before, rest) = pressures.split_at(j);
    let behind = before.iter().rev().zip(coefficients.iter().skip(1));
    let mut ahead = rest.iter().zip(coefficients);
    let of = |sum: f64, (p, c): (&f64, &f64)| sum + p * c;
    // The offset is that of the cell from the load: positive from loads at smaller y, and 0 once.
    let here = ahead.next().map_or(0.0, |(p, c)| p * c);
    let (behind, ahead) = (behind.fold(here, of), ahead.fold(0.0, of));
    if odd { behind - ahead } else { behind + ahead }
}

/// Adds `factor` times the `values` to `sums`.
fn add_scaled<'a>(sums: impl Iterator<Item = &'a mut f64>, factor: f64, values: &[f64]) {
    sums.zip(values).for_each(|(sum, value)| *sum += factor * value);
}

/// A part of the stress of a body, which is the sum of its parts.
pub(in crate::stress) trait Part: fmt::Debug + Send + Sync {
    /// Adds the components at `place` to `outputs`, planes of the wanted cells.
    fn plane(
        &self,
        place: &Place,
        displacement: bool,
        memory: &mut Option<PlaneMemory>,
        outputs: &mut [&mut [f64]],
        progress: &mut StressProgress,
    ) -> ControlFlow<()>;

    /// Adds the components at `place` in each of the `cells` to `sums`.
    fn points(
        &self,
        place: &Place,
        displacement: bool,
        cells: &[[usize; 2]],
        sums: &mut [[f64; COMPONENTS]],
        progress: &mut StressProgress,
    ) -> ControlFlow<()>;

    /// Adds the components at `place` on the face of the end of this number, which lies between the wanted rows
    /// `row` − 1 and `row`, to `lines`, for each of them along y.
    fn on_face(
        &self,
        place: &Place,
        displacement: bool,
        face: (usize, usize),
        lines: &mut [Vec<f64>],
        progress: &mut StressProgress,
    ) -> ControlFlow<()>;
}

/// A half-space under one load, which may be on more, or finer, cells than those in which its stress is wanted.
#[derive(Debug)]
pub(in crate::stress) struct HalfSpacePart {
    pub(in crate::stress) plan: HalfSpacePlan,
    pub(in crate::stress) load: SurfaceLoad,
    /// 1, or −1 for what another part replaces.
    pub(in crate::stress) factor: f64,
    /// The wanted rows in which it counts, and the number of wanted columns.
    pub(in crate::stress) rows: Range<usize>,
    pub(in crate::stress) columns: usize,
    /// The plan's row of the first of these, and its rows to one of them.
    pub(in crate::stress) first: usize,
    pub(in crate::stress) stride: usize,
    /// The plan's column of the first wanted one.
    pub(in crate::stress) column: usize,
    /// Depth from which on it does not count \[m\].
    pub(in crate::stress) reach: f64,
}

impl HalfSpacePart {
    /// The stress of a plan in its own cells.
    pub(in crate::stress) fn new(plan: HalfSpacePlan, load: SurfaceLoad) -> Self {
        let [rows, columns] = plan.grid.shape();
        let (first, stride, column, reach) = (0, 1, 0, f64::INFINITY);
        Self { plan, load, factor: 1.0, rows: 0..rows, columns, first, stride, column, reach }
    }

    /// Adds the `plane` of a component to an `output`.
    pub(in crate::stress) fn add(&self, plane: &[f64], output: &mut [f64]) {
        let width = self.plan.grid.shape()[1];
        let from = plane.chunks_exact(width).skip(self.first);
        let outputs = output.chunks_exact_mut(self.columns).skip(self.rows.start);
        let outputs = outputs.take(self.rows.len());
        for (output, row) in outputs.zip(from.step_by(self.stride)) {
            add_scaled(output.iter_mut(), self.factor, &row[self.column..]);
        }
    }

    /// The plan's cell for a wanted one; none where the part does not count.
    fn cell(&self, [i, j]: [usize; 2]) -> Option<[usize; 2]> {
        let row = |i| self.first + (i - self.rows.start) * self.stride;
        self.rows.contains(&i).then(|| [row(i), j + self.column])
    }
}

impl Part for HalfSpacePart {
    fn plane(
        &self,
        place: &Place,
        displacement: bool,
        memory: &mut Option<PlaneMemory>,
        outputs: &mut [&mut [f64]],
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        if place.depth >= self.reach {
            return ControlFlow::Continue(());
        }
        let loading = Loading::one(self.load, displacement);
        let memory = memory.get_or_insert_with(|| self.plan.plane_memory(&loading));
        let mut fields = std::mem::take(&mut memory.fields);
        fields.resize_with(outputs.len(), || vec![0.0; self.plan.pressure.len()]);
        let mut planes: Vec<&mut [f64]> = fields.iter_mut().map(Vec::as_mut_slice).collect();
        self.plan.plane(&loading, place, memory, &mut planes, progress)?;
        for (output, field) in outputs.iter_mut().zip(&fields) {
            self.add(field, output);
        }
        memory.fields = fields;
        ControlFlow::Continue(())
    }

    fn points(
        &self,
        place: &Place,
        displacement: bool,
        cells: &[[usize; 2]],
        sums: &mut [[f64; COMPONENTS]],
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        let there = sums.iter_mut().zip(cells);
        let there = there.filter_map(|(sums, cell)| Some((sums, self.cell(*cell)?)));
        let (sums, cells): (Vec<_>, Vec<_>) = there.unzip();
        if cells.is_empty() || place.depth >= self.reach {
            return ControlFlow::Continue(());
        }
        let loading = Loading::one(self.load, displacement);
        let components = self.plan.points(&loading, place, &cells, progress)?;
        for (sums, components) in sums.into_iter().zip(components) {
            add_scaled(sums.iter_mut(), self.factor, &components);
        }
        ControlFlow::Continue(())
    }

    fn on_face(
        &self,
        place: &Place,
        displacement: bool,
        (_, row): (usize, usize),
        lines: &mut [Vec<f64>],
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        if !(self.rows.start..=self.rows.end).contains(&row) || place.depth >= self.reach {
            return ControlFlow::Continue(());
        }
        let there = self.first - self.stride / 2 + (row - self.rows.start) * self.stride;
        let loading = Loading::one(self.load, displacement);
        let components = self.plan.line(&loading, (place, there), progress)?;
        for (line, component) in lines.iter_mut().zip(components) {
            add_scaled(line.iter_mut(), self.factor, &component[self.column..]);
        }
        ControlFlow::Continue(())
    }
}
