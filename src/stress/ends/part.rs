//! Half-spaces whose stresses add up to that of a body near its ends.

use std::ops::{ControlFlow, Range};

use super::images::Images;
use super::strip::Strip;
use crate::compliance::response::interior::Place;
use crate::error::Result;
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;
use crate::numerics::parallel::Threads;
use crate::stress::half_space::{HalfSpacePlan, PlaneEvaluator, Source, SurfaceLoad};
use crate::stress::options::StressProgress;

/// A half-space under a pressure on more, or finer, cells than those in which its stress is wanted.
#[derive(Debug)]
pub(super) struct Part {
    pub(super) plan: HalfSpacePlan,
    /// 1, or −1 for what another part replaces.
    factor: f64,
    /// The wanted rows in which it counts.
    rows: Range<usize>,
    /// The plan's row of the first of these, and its rows to one of them.
    first: usize,
    stride: usize,
    /// The plan's column of the first wanted one.
    column: usize,
}

impl Part {
    /// The `body` under `images`, whose grid are the wanted cells.
    pub(super) fn new(body: &HalfSpace, images: &Images, threads: &Threads) -> Result<Self> {
        let (pressure, grid, [first, column]) = images.together()?;
        Ok(Self {
            plan: Source::uniform(body, &grid, &pressure).plan_unwatched(Some(threads.count()))?,
            factor: 1.0,
            rows: 0..images.grid().shape()[0],
            first,
            stride: 1,
            column,
        })
    }

    /// What a `strip` beside an edge at x = `end` changes in the `rows` of `grid`: it takes away the stress of its
    /// cells and adds that of the finer ones. Its pressure has a `margin` of columns beyond those of the grid.
    pub(super) fn beside(
        body: &HalfSpace,
        (grid, rows): (&Grid, Range<usize>),
        strip: &Strip,
        end: f64,
        margin: usize,
        threads: &Threads,
    ) -> Result<[Self; 2]> {
        let part = |factor: f64, division: usize, pressure| {
            let mut images = Images::new(&rows_of(grid, &rows, division)?);
            images.add_excess(pressure, end, margin);
            let whole = Self::new(body, &images, threads)?;
            Ok(Self {
                factor,
                rows: rows.clone(),
                first: whole.first + division / 2,
                stride: division,
                ..whole
            })
        };
        let finer = part(1.0, strip.division, &strip.fine)?;
        Ok([part(-1.0, 1, &strip.coarse)?, finer])
    }

    /// This part in every finer cell.
    pub(super) fn in_finer_cells(self) -> Self {
        Self {
            first: self.first - self.stride / 2,
            rows: 0..self.rows.len() * self.stride,
            stride: 1,
            ..self
        }
    }

    /// Adds the `plane` of a component to an `output` of `columns`.
    pub(super) fn add(&self, plane: &[f64], columns: usize, output: &mut [f64]) {
        let width = self.plan.grid.shape()[1];
        let from = plane.chunks_exact(width).skip(self.first);
        let outputs = output.chunks_exact_mut(columns).skip(self.rows.start);
        let outputs = outputs.take(self.rows.len());
        for (output, row) in outputs.zip(from.step_by(self.stride)) {
            let values = output.iter_mut().zip(&row[self.column..]);
            values.for_each(|(output, value)| *output += self.factor * value);
        }
    }

    /// Adds the components at `place` on the line between the wanted rows `row` − 1 and `row` to `lines`, for each of them
    /// along y.
    pub(super) fn add_between(
        &self,
        (place, row): (&Place, usize),
        displacement: bool,
        lines: &mut [Vec<f64>],
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        if !(self.rows.start..=self.rows.end).contains(&row) {
            return ControlFlow::Continue(());
        }
        let there = self.first - self.stride / 2 + (row - self.rows.start) * self.stride;
        let pressure = SurfaceLoad::all([0.0; 2]);
        let at = (place, there);
        let found = PlaneEvaluator::between(&self.plan, pressure, displacement, at, progress)?;
        for (line, found) in lines.iter_mut().zip(found) {
            let values = line.iter_mut().zip(&found[self.column..]);
            values.for_each(|(sum, value)| *sum += self.factor * value);
        }
        ControlFlow::Continue(())
    }

    /// The plan's cell for a wanted one, and the factor of what it adds there.
    pub(super) fn cell(&self, [i, j]: [usize; 2]) -> ([usize; 2], f64) {
        if self.rows.contains(&i) {
            let row = self.first + (i - self.rows.start) * self.stride;
            ([row, j + self.column], self.factor)
        } else {
            ([self.first, j + self.column], 0.0)
        }
    }
}

/// The `rows` of a grid, each divided.
fn rows_of(grid: &Grid, rows: &Range<usize>, division: usize) -> Result<Grid> {
    let ([_, ny], [dx, dy], [x, y]) = (grid.shape(), grid.spacing(), grid.center());
    let count = rows.len();
    let moved = 0.5 * (rows.start as f64 + rows.end as f64 - grid.shape()[0] as f64) * dx;
    let size = [count as f64 * dx, ny as f64 * dy];
    Grid::new([count * division, ny], size)?.centered_at([x + moved, y])
}
