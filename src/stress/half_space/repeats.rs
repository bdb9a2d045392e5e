//! Coefficients of stress on grids that repeat: sums over the images of a cell.
//!
//! The mean over a period is that of a uniform load with which the body does not stretch along the periods: under the
//! pressure p, σ_zz = −p and σ_xx = σ_yy = −ν p/(1 − ν) in every layer. Where one direction is open, it is that of a
//! strip.

#[cfg(test)]
mod tests;

use std::ops::Range;

use ndarray::Array2;
use rayon::prelude::*;

use crate::compliance::images::CellImages;
use crate::compliance::kernel::loads::{COMPONENTS, EXCHANGED, Pressure, Radial, Traction};
use crate::compliance::kernel::plane::{CellSource, ComponentsAt, FAR};
use crate::compliance::kernel::plane::{Kernel, Kernels};
use crate::compliance::kernel::strip::LinePlan;
use crate::compliance::response::interior::Place;
use crate::model::body::{HalfSpace, Substrate};
use crate::model::grid::Grid;
use crate::model::material::Elastic;
use crate::numerics::fft::Keep;

/// Distance of the end of the sums, in longest lengths of what is summed: 1e-7 of the coefficient of the loaded cell is
/// left.
const STRESS_RINGS: f64 = 8.0;

/// Rows of coefficients that one thread makes at a time.
const ROWS_TOGETHER: usize = 8;

/// What a plan on a grid that repeats has besides the kernels of its cells.
#[derive(Debug)]
pub(in crate::stress) struct Repeats {
    images: CellImages,
    /// Kernels of the rectangle of all images that are summed.
    block: Kernels,
    block_half: [f64; 2],
    /// Strips along the direction that is open, where there is one.
    strips: Option<LinePlan>,
    /// The direction that is open.
    open: usize,
    body: HalfSpace,
    grid: Grid,
}

/// Gives the coefficients of some rows to its second argument.
pub(super) type RowSource<'a> = dyn Fn(Range<usize>, &mut Keep) + Sync + 'a;

/// A load whose coefficients are summed: pressure, or traction along an axis.
pub(super) type Axis = Option<usize>;

impl Repeats {
    /// The plan for `grid`; none where it does not repeat. On the threads of the caller.
    pub(in crate::stress) fn plan(body: &HalfSpace, grid: &Grid) -> Option<Self> {
        let periodic = grid.is_periodic();
        if periodic == [false; 2] {
            return None;
        }
        let images = CellImages::plan(grid, STRESS_RINGS);
        let sides = images.block_sides();
        // From one end of the rectangle to places beyond the other.
        let reach = images.block_reach() + sides[0].hypot(sides[1]);
        let open = usize::from(periodic[0]);
        // A line grid of the cells along the open direction, which is valid where the grid is.
        let line = Grid::line(grid.shape()[open], grid.size()[open]);
        let strips = line.ok().filter(|_| periodic != [true; 2]);
        Some(Self {
            block: Kernels::of_cells::<6, Pressure>(body, sides, 1.0, reach),
            block_half: sides.map(|side| 0.5 * side),
            strips: strips.map(|line| LinePlan::new(body, &line, 1.0)),
            open,
            body: body.clone(),
            grid: *grid,
            images,
        })
    }

    /// The kernel of the rectangle of all images, for the load L.
    pub(super) fn block_kernel<const N: usize, L: Radial<N>>(
        &self,
        place: &Place,
    ) -> Option<Kernel<'_, N>> {
        let Kernels::Plane { plan, pressure, traction } = &self.block else {
            return None;
        };
        let multipliers = match L::IS_TRACTION {
            false => pressure,
            // Made without rayon, so that a thread that waits for it cannot be asked to make it.
            true => traction.get_or_init(|| plan.multipliers::<9, Traction>()),
        };
        Some(Kernel::new::<L>(plan, multipliers, place))
    }

    /// Largest distance at which the cells' kernels are evaluated.
    pub(in crate::stress) fn reach(&self) -> f64 {
        self.images.reach()
    }

    /// Numbers of offsets of the cells that are summed one by one.
    pub(super) fn extents(&self) -> [usize; 2] {
        [0, 1].map(|k| match self.grid.is_periodic()[k] {
            true => *self.images.near(k).end() as usize * self.grid.shape()[k] + 1,
            false => self.grid.shape()[k],
        })
    }

    /// Arrays of the coefficients of C components at all offsets. `source` has those of one cell alone, at offsets up to
    /// [`Repeats::extents`], `block` those of the rectangle of half sides `half`.
    pub(super) fn coefficients<M: ComponentsAt, P: ComponentsAt, const C: usize>(
        &self,
        source: &CellSource<M, P, C>,
        block: impl Fn([f64; 2], [f64; 2]) -> [f64; COMPONENTS] + Sync,
        (place, axis): (&Place, Axis),
    ) -> Vec<Array2<f64>> {
        let far = self.images.far(
            |[x, y]| mean_of_cell(source, x, y),
            |at| {
                let values = block(at, self.block_half);
                std::array::from_fn(|k| values[k])
            },
        );
        let uniform = self.uniform(place, axis);
        let kept = self.images.kept();
        let starts: Vec<usize> = (0..kept[0]).step_by(ROWS_TOGETHER).collect();
        let near: Vec<Vec<f64>> = starts
            .par_iter()
            .map(|start| self.near_rows(source, *start..(start + ROWS_TOGETHER).min(kept[0])))
            .collect();
        (0..C)
            .map(|component| {
                let sum = Array2::from_shape_fn((kept[0], kept[1]), |(i, j)| {
                    let (block, row) = (i / ROWS_TOGETHER, i % ROWS_TOGETHER);
                    let rows = near[block].len() / (C * kept[1]);
                    near[block][(component * rows + row) * kept[1] + j] + far[component][[i, j]]
                });
                let mut whole = self.images.whole(&sum, source.odd[component]);
                let means: Vec<f64> = uniform.iter().map(|values| values[component]).collect();
                self.images.with_mean(&mut whole, &means);
                whole
            })
            .collect()
    }

    /// Sums over the near images of some rows, component by component.
    fn near_rows<M: ComponentsAt, P: ComponentsAt, const C: usize>(
        &self,
        source: &CellSource<M, P, C>,
        rows: Range<usize>,
    ) -> Vec<f64> {
        let (kept, [nx, ny]) = (self.images.kept(), self.grid.shape());
        let mut sums = vec![0.0; C * rows.len() * kept[1]];
        for k in self.images.near(0) {
            // Rows of offsets |i − k nx| from the cell, in rising order.
            let shift = k.unsigned_abs() as usize * nx;
            let behind = k > 0;
            let range = match behind {
                true => shift + 1 - rows.end..shift + 1 - rows.start,
                false => rows.start + shift..rows.end + shift,
            };
            let mut keep = |row: usize, component: usize, values: &[f64]| {
                let i = if behind { shift - row } else { row - shift };
                let [odd_x, odd_y] = source.odd[component];
                let along = if behind && odd_x { -1.0 } else { 1.0 };
                let start = (component * rows.len() + i - rows.start) * kept[1];
                let sums = &mut sums[start..start + kept[1]];
                for l in self.images.near(1) {
                    let across = if l > 0 && odd_y { -1.0 } else { 1.0 };
                    for (j, sum) in sums.iter_mut().enumerate() {
                        let offset = j as i64 - l * ny as i64;
                        *sum += along * across * values[offset.unsigned_abs() as usize];
                    }
                }
            };
            source.rows(range, &mut keep);
        }
        sums
    }

    /// Components under a unit load on all cells, where both directions repeat; otherwise those at each offset along
    /// the open direction, of a strip under a unit load.
    fn uniform(&self, place: &Place, axis: Axis) -> Vec<[f64; COMPONENTS]> {
        let Some(strips) = &self.strips else {
            return vec![everywhere(&self.body, place, axis)];
        };
        // Strips are endless along x: where y repeats, x and y are exchanged.
        let exchanged = self.open == 0;
        let values =
            strips.coefficients(place, axis.map(|axis| if exchanged { 1 - axis } else { axis }));
        let turned = |values: [f64; COMPONENTS]| match exchanged {
            true => EXCHANGED.map(|k| values[k]),
            false => values,
        };
        values.into_iter().map(turned).collect()
    }
}

/// Components at (x, y) from a cell under a unit load: means, or differences where the cell is far.
fn mean_of_cell<M: ComponentsAt, P: ComponentsAt, const C: usize>(
    source: &CellSource<M, P, C>,
    x: f64,
    y: f64,
) -> [f64; C] {
    let [dx, dy] = source.spacing;
    let values = if x.hypot(y).hypot(source.depth) < (FAR + 1.0) * dx.max(dy) {
        (source.mean)(x, y)
    } else {
        let point = |x: f64, y: f64| (source.point)(x, y);
        let here = point(x, y);
        let around = [point(x - dx, y), point(x + dx, y), point(x, y - dy), point(x, y + dy)];
        std::array::from_fn(|k| {
            let sum: f64 = around.iter().map(|values| values[k]).sum();
            dx * dy * (here[k] + (sum - 4.0 * here[k]) / 24.0)
        })
    };
    std::array::from_fn(|k| values[k])
}

/// Components at `place` under a unit load everywhere. The displacement is counted from the mean of the surface, or
/// from the rigid base.
fn everywhere(body: &HalfSpace, place: &Place, axis: Axis) -> [f64; COMPONENTS] {
    let compliance = |material: Elastic| match axis {
        None => (1.0 - 2.0 * material.poisson()) / (2.0 - 2.0 * material.poisson()),
        Some(_) => 1.0,
    } / material.shear();
    let layers = || body.layers().iter().enumerate();
    let above: f64 = layers()
        .take(place.layer)
        .map(|(_, layer)| layer.thickness() * compliance(layer.material()))
        .sum();
    let above = above + place.below_top * compliance(place.material);
    let whole: f64 = match body.substrate() {
        Substrate::Rigid => {
            layers().map(|(_, layer)| layer.thickness() * compliance(layer.material())).sum()
        }
        Substrate::Elastic(_) => 0.0,
    };
    let mut values = [0.0; COMPONENTS];
    match axis {
        None => {
            let nu = place.material.poisson();
            let side = -nu / (1.0 - nu);
            [values[0], values[1], values[2], values[8]] = [side, side, -1.0, whole - above];
        }
        Some(axis) => {
            values[if axis == 0 { 5 } else { 4 }] = -1.0;
            values[6 + axis] = whole - above;
        }
    }
    values
}

/// Gives the coefficients of arrays to whoever asks for rows.
pub(super) fn rows_of<'a>(arrays: &'a [Array2<f64>], columns: usize) -> Box<RowSource<'a>> {
    Box::new(move |rows: Range<usize>, keep: &mut Keep| {
        for i in rows {
            for (k, array) in arrays.iter().enumerate() {
                let row: Vec<f64> = array.row(i).iter().take(columns).copied().collect();
                keep(i, k, &row);
            }
        }
    })
}
