//! Stress and displacement of a plan at a few cells, at one depth after another. A direct sum over the
//! loaded cells is far cheaper than the convolutions of a plane of which all other cells are dropped.

use std::ops::{ControlFlow, Range};

use rayon::prelude::*;

use super::coefficients::{Coefficients, RowSource, SurfaceLoad};
use crate::compliance::kernel::COMPONENTS;
use crate::compliance::response::interior::Place;
use crate::model::grid::Grid;
use crate::stress::half_space::plan::{HalfSpacePlan, loaded_cells};
use crate::stress::options::StressProgress;
use crate::stress::subcell::STRESSES;

/// Rows of coefficients that one thread makes at a time. Each such block makes two more rows; few blocks
/// leave threads idle.
const ROWS: usize = 8;

/// A plan under one friction, at some cells.
#[derive(Debug)]
pub(in crate::stress) struct PointEvaluator<'a> {
    plan: &'a HalfSpacePlan,
    friction: [f64; 2],
    displacement: bool,
    loads: Vec<SurfaceLoad>,
    cells: Vec<[usize; 2]>,
    /// Numbers of offsets along x and y between a loaded cell and any of `cells`.
    offsets: [usize; 2],
}

impl<'a> PointEvaluator<'a> {
    pub(in crate::stress) fn new(
        plan: &'a HalfSpacePlan,
        friction: [f64; 2],
        displacement: bool,
        cells: Vec<[usize; 2]>,
    ) -> Self {
        Self {
            friction,
            ..Self::under(plan, SurfaceLoad::all(friction), displacement, cells)
        }
    }

    /// The plan under `loads` in proportion to its pressure, which may leave out the pressure itself.
    pub(super) fn under(
        plan: &'a HalfSpacePlan,
        loads: Vec<SurfaceLoad>,
        displacement: bool,
        cells: Vec<[usize; 2]>,
    ) -> Self {
        let [nx, ny] = plan.grid.shape();
        let loaded = loaded_cells([nx, ny], &[plan.stress_pressure(), &plan.pressure]);
        // From a cell to the loaded cell that is farthest from it.
        let offsets = [0, 1].map(|axis| {
            let [first, last] = loaded.map_or([0, 0], |ends| ends[axis]);
            let distance =
                |cell: &[usize; 2]| cell[axis].abs_diff(first).max(cell[axis].abs_diff(last));
            cells.iter().map(distance).max().unwrap_or(0) + 1
        });
        Self {
            plan,
            friction: [0.0; 2],
            displacement,
            loads,
            cells,
            offsets,
        }
    }

    /// Bytes that an evaluator takes.
    pub(in crate::stress) fn memory(grid: &Grid) -> u64 {
        // Sums of one row of coefficients for each cell.
        grid.shape()[0] as u64 * 8 * (4 * COMPONENTS) as u64
    }

    /// Components at `place` in each of the cells; with displacements, nine. `progress` is told 0.
    pub(in crate::stress) fn evaluate(
        &self,
        place: &Place,
        progress: &mut StressProgress,
    ) -> ControlFlow<(), Vec<[f64; COMPONENTS]>> {
        progress(0.0)?;
        let mut sums = vec![[0.0; COMPONENTS]; self.cells.len()];
        let plan = self.plan;
        plan.threads.run(|| {
            let coefficients = Coefficients {
                plan,
                place,
                offsets: self.offsets,
                displacement: self.displacement,
                between: false,
            };
            coefficients.each(&self.loads, &mut |number, source| {
                self.add(self.loads[number], source, &mut sums);
            });
            if let Some(solved) = &plan.solved {
                let near = solved.subcell.table(place, self.friction);
                for (cell, sums) in self.cells.iter().zip(&mut sums) {
                    solved
                        .subcell
                        .add_at(&near, self.friction, *cell, &mut sums[..STRESSES]);
                }
            }
        });
        ControlFlow::Continue(sums)
    }

    /// Adds what a load with the coefficients of `source` makes in each cell.
    fn add(&self, load: SurfaceLoad, source: &RowSource, sums: &mut [[f64; COMPONENTS]]) {
        let starts: Vec<usize> = (0..self.offsets[0]).step_by(ROWS).collect();
        let block = |start: &usize| {
            let end = (start + ROWS).min(self.offsets[0]);
            self.block(load, source, *start..end)
        };
        // In the order of the rows, whatever the number of threads.
        let blocks: Vec<_> = starts.par_iter().map(block).collect();
        for block in blocks {
            for (sums, parts) in sums.iter_mut().zip(block) {
                for (sum, part) in sums.iter_mut().zip(parts) {
                    *sum += load.factor * part;
                }
            }
        }
    }

    /// Sums over the loaded cells at some offsets along x, before and behind each cell.
    fn block(
        &self,
        load: SurfaceLoad,
        source: &RowSource,
        rows: Range<usize>,
    ) -> Vec<[f64; COMPONENTS]> {
        let [nx, ny] = self.plan.grid.shape();
        let odd = load.odd();
        let mut sums = vec![[0.0; COMPONENTS]; self.cells.len()];
        source(rows, &mut |offset, k, coefficients| {
            let pressure = match k < STRESSES {
                true => self.plan.stress_pressure(),
                false => &self.plan.pressure,
            };
            let row = |i: usize| &pressure[i * ny..(i + 1) * ny];
            for ([i, j], sums) in self.cells.iter().zip(&mut sums) {
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
