//! The pressures whose half-spaces add up to a body near its ends: mirror images, excesses beside an edge, and these
//! again on finer cells next to it.

use std::f64::consts::PI;
use std::ops::Range;

use ndarray::{Array2, ArrayRef2};

use crate::compliance::ends::{EndPressure, Where};
use crate::error::Result;
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;
use crate::model::material::Elastic;
use crate::numerics::parallel::Threads;
use crate::numerics::rounding::{self, cells_within};
use crate::stress::half_space::{HalfSpacePart, HalfSpacePlan, SurfaceLoad};

/// Length over which the pressures beside the load are followed, in widths of the contact or in distances of it from
/// the end, if that is more: they fall with the square of the distance at least.
pub(super) const FOLLOWED: f64 = 3.0;

/// Columns beyond the contact's on either side, in the same unit.
const MARGIN_BESIDE: f64 = 3.0;

/// Rows of cells on which the excess is followed.
const MOST_ROWS: usize = 1024;

/// The pressure of a contact, seen from an end, and those that it makes there.
pub(super) struct NearEnd {
    /// x of the end.
    pub(super) end: f64,
    /// 1 where the body extends towards larger x from there, else −1.
    pub(super) sign: f64,
    /// Distance of the first row of the grid from the end \[m\].
    pub(super) first: f64,
    /// Rows between the grid's first one and that, which lie beyond the end.
    pub(super) beyond: usize,
    /// Distance of the first row that carries pressure \[m\].
    pub(super) nearest: f64,
    /// Number of the grid's rows in the body.
    rows: usize,
    /// Length from the end over which pressures are followed \[m\].
    pub(super) reach: f64,
    /// Columns beyond the contact's on either side.
    pub(super) margin: usize,
    /// Width of a column \[m\].
    column: f64,
    spread: EndPressure,
    pub(super) material: Elastic,
}

impl NearEnd {
    /// The `pressure`, on columns of the total `width`, on `grid`, from an end at x = `end` from which the body extends
    /// in the direction of `sign`. None where there is no pressure.
    pub(super) fn new(
        (pressure, width): (&ArrayRef2<f64>, f64),
        grid: &Grid,
        (end, sign): (f64, f64),
        material: Elastic,
    ) -> Option<Self> {
        let [nx, ny] = grid.shape();
        let row = |k: usize| if sign > 0.0 { k } else { nx - 1 - k };
        let x = grid.x();
        let distance = |k: usize| sign * (x[row(k)] - end);
        let beyond = (0..nx).take_while(|k| distance(*k) < 0.0).count();
        let is_loaded = |k: &usize| pressure.row(row(*k)).iter().any(|p| *p != 0.0);
        let nearest = distance((beyond..nx).find(is_loaded)?);
        let scale = width.max(nearest);
        // On rows at increasing distances.
        let from_end =
            Array2::from_shape_fn((nx - beyond, ny), |(k, j)| pressure[[row(beyond + k), j]]);
        Some(Self {
            end,
            sign,
            first: distance(beyond),
            beyond,
            nearest,
            rows: nx - beyond,
            reach: FOLLOWED * scale,
            margin: cells_within(MARGIN_BESIDE * scale, grid.spacing()[1]).min(2 * ny),
            column: grid.spacing()[1],
            spread: EndPressure::new(&from_end, distance(beyond), grid.spacing()),
            material,
        })
    }

    /// The `count` rows of the contact next to the end, or as many as it has.
    pub(super) fn rows(&self, count: usize) -> Range<usize> {
        let count = count.min(self.rows);
        if self.sign > 0.0 {
            self.beyond..self.beyond + count
        } else {
            self.rows - count..self.rows
        }
    }

    /// Means of the pressure at a `place` over `count` rows of cells of a length `spacing`, from the edge on.
    fn means(
        &self,
        (place, margin): (Where, usize),
        spacing: f64,
        count: usize,
        threads: &Threads,
    ) -> Array2<f64> {
        let nu = self.material.poisson();
        threads.run(|| self.spread.spread(place, nu, spacing, count, margin))
    }

    /// The means as far as the pressure is followed.
    pub(super) fn followed(&self, place: Where, spacing: f64, threads: &Threads) -> Array2<f64> {
        let count = cells_within(self.reach, spacing).min(MOST_ROWS);
        self.means((place, self.margin), spacing, count, threads)
    }
}

/// Pressures that are added up on cells beside those of a grid, and on these.
#[derive(Debug)]
pub(super) struct EndImages {
    grid: Grid,
    pieces: Vec<ImageRows>,
}

/// Pressure on consecutive rows.
#[derive(Debug)]
struct ImageRows {
    /// Number of its first row, counted as the grid's are; not a whole number where the end is not on an edge of
    /// cells. Such rows are shared by their two neighbours, with their force and moment.
    first: f64,
    /// Columns beyond those of the grid on both sides.
    margin: usize,
    pressure: Array2<f64>,
}

/// Share of a row that is rounding.
const ROUNDED_SHARE: f64 = 1e-6;

impl EndImages {
    pub(super) fn new(grid: &Grid) -> Self {
        Self { grid: *grid, pieces: Vec::new() }
    }

    /// Number of the row with its centre at x.
    fn row(&self, x: f64) -> f64 {
        let at = (x - self.grid.x()[0]) / self.grid.spacing()[0];
        if (at - at.round()).abs() < ROUNDED_SHARE { at.round() } else { at }
    }

    /// Adds the mirror image of the grid's `pressure` about x = `end`.
    pub(super) fn add_mirror(&mut self, pressure: &ArrayRef2<f64>, end: f64) {
        let x = self.grid.x();
        let loaded = |i: &usize| pressure.row(*i).iter().any(|p| *p != 0.0);
        let rows = 0..x.len();
        let (Some(low), Some(high)) = (rows.clone().find(loaded), rows.rev().find(loaded)) else {
            return;
        };
        let shape = (high - low + 1, pressure.ncols());
        self.pieces.push(ImageRows {
            first: self.row(2.0 * end - x[high]),
            margin: 0,
            pressure: Array2::from_shape_fn(shape, |(i, j)| pressure[[high - i, j]]),
        });
    }

    /// Adds an `excess` on rows of increasing distance from x = `end`, on both sides of it.
    pub(super) fn add_excess(&mut self, excess: &ArrayRef2<f64>, end: f64, margin: usize) {
        let count = excess.nrows();
        let dx = self.grid.spacing()[0];
        let shape = (2 * count, excess.ncols());
        self.pieces.push(ImageRows {
            first: self.row(end - (count as f64 - 0.5) * dx),
            margin,
            pressure: Array2::from_shape_fn(shape, |(i, j)| {
                let distance = if i < count { count - 1 - i } else { i - count };
                excess[[distance, j]]
            }),
        });
    }

    /// The stress of `body` under the sum of all, in the cells of the grid.
    pub(super) fn part(&self, body: &HalfSpace, threads: &Threads) -> Result<HalfSpacePart> {
        let (pressure, grid, [first, column]) = self.together()?;
        let [rows, columns] = self.grid.shape();
        let wanted = [first..first + rows, column..column + columns];
        let plan = HalfSpacePlan::uniform(body, (&grid, &wanted), &pressure, threads)?;
        Ok(HalfSpacePart {
            rows: 0..rows,
            columns,
            first,
            column,
            ..HalfSpacePart::new(plan, SurfaceLoad::PRESSURE)
        })
    }

    /// The sum of all, the grid that it is on, and the first row and column there of the grid that it continues.
    fn together(&self) -> Result<(Array2<f64>, Grid, [usize; 2])> {
        let [nx, ny] = self.grid.shape();
        let (mut low, mut high, mut margin) = (0, nx as i64, 0);
        for piece in &self.pieces {
            let start = piece.first.floor();
            low = low.min(start as i64);
            // A row more, where rows are shared.
            high = high.max(start as i64 + piece.pressure.nrows() as i64 + 1);
            margin = margin.max(piece.margin);
        }
        let shape = [(high - low) as usize, ny + 2 * margin];
        let mut sum = Array2::zeros(shape);
        for piece in &self.pieces {
            let share = piece.first - piece.first.floor();
            let first = (piece.first.floor() as i64 - low) as usize;
            for (i, from) in piece.pressure.rows().into_iter().enumerate() {
                for (row, share) in [(first + i, 1.0 - share), (first + i + 1, share)] {
                    if share > 0.0 {
                        let mut row = sum.row_mut(row);
                        let to = row.iter_mut().skip(margin - piece.margin);
                        to.zip(from).for_each(|(to, p)| *to += share * p);
                    }
                }
            }
        }
        let ([dx, dy], [x, y]) = (self.grid.spacing(), self.grid.center());
        let moved = 0.5 * ((high + low) as f64 - nx as f64) * dx;
        let size = [shape[0] as f64 * dx, shape[1] as f64 * dy];
        let grid = Grid::new(shape, size)?.centered_at([x + moved, y])?;
        Ok((sum, grid, [(-low) as usize, margin]))
    }
}

/// Cells from the edge on of which the pressure is replaced, and those that keep none of it: in between, the share
/// falls as a cosine, so that the stress of either part is smooth.
const REPLACED: [usize; 2] = [3, 12];

/// Cells from the edge on in which the stress is that of finer cells.
pub(super) const STRIP: usize = 18;

/// Finer cells in one of the contact's, at least.
const FINER_CELLS: f64 = 9.0;

/// A pressure beside an edge, by the distance from it, on cells and on finer ones.
///
/// Beside the edge, the excess P − p on the surface and Q on the end face change as the logarithm of the distance,
/// which the contact's cells do not resolve. On a strip beside the edge, their stress is therefore replaced by that
/// of finer cells.
pub(super) struct Strip {
    /// Finer cells in one.
    pub(super) division: usize,
    coarse: Array2<f64>,
    fine: Array2<f64>,
    margin: usize,
    /// Depth from which on it does not count: there as many cells are between as beyond [`STRIP`] \[m\].
    pub(super) reach: f64,
}

impl Strip {
    /// The strip at a `place` of cells of a length `spacing`, beside a contact with cells of length `dx`.
    pub(super) fn new(
        near: &NearEnd,
        place: Where,
        spacing: f64,
        dx: f64,
        threads: &Threads,
    ) -> Self {
        // An odd number, so that centres coincide.
        let half = 0.5 * (FINER_CELLS * spacing / dx - 1.0);
        let division = 2 * rounding::ceil(half) as usize + 1;
        let [all, none] = REPLACED.map(|cells| (cells * division) as f64);
        let count = REPLACED[1] * division;
        // Beyond, finer cells make no more difference than beyond the strip.
        let beside = cells_within(STRIP as f64 * spacing, near.column);
        let margin = near.margin.min(beside);
        let mut fine = near.means((place, margin), spacing / division as f64, count, threads);
        for (i, mut row) in fine.rows_mut().into_iter().enumerate() {
            let t = ((i as f64 + 0.5 - all) / (none - all)).clamp(0.0, 1.0);
            row *= 0.5 * (1.0 + (PI * t).cos());
        }
        let mut coarse = Array2::zeros((REPLACED[1], fine.ncols()));
        for (i, row) in fine.rows().into_iter().enumerate() {
            coarse.row_mut(i / division).scaled_add(1.0 / division as f64, &row);
        }
        let reach = STRIP as f64 * spacing;
        Self { division, coarse, fine, margin, reach }
    }

    /// What the strip beside an edge at x = `end` changes in the `rows` of `grid`: it takes away the stress of its
    /// cells and adds that of the finer ones.
    pub(super) fn parts(
        &self,
        body: &HalfSpace,
        grid: &Grid,
        rows: &Range<usize>,
        end: f64,
        threads: &Threads,
    ) -> Result<[HalfSpacePart; 2]> {
        let part = |factor: f64, division: usize, pressure| {
            let excess = (pressure, end, self.margin);
            let whole = excess_part(excess, body, grid, (rows, division), threads)?;
            Ok(HalfSpacePart { factor, reach: self.reach, ..whole })
        };
        let finer = part(1.0, self.division, &self.fine)?;
        Ok([part(-1.0, 1, &self.coarse)?, finer])
    }
}

/// The stress of `body` in some of the rows of `grid` under an excess beside x = `end`, on cells of the divided rows.
pub(super) fn excess_part(
    (excess, end, margin): (&ArrayRef2<f64>, f64, usize),
    body: &HalfSpace,
    grid: &Grid,
    (rows, division): (&Range<usize>, usize),
    threads: &Threads,
) -> Result<HalfSpacePart> {
    let mut images = EndImages::new(&rows_of(grid, rows, division)?);
    images.add_excess(excess, end, margin);
    let whole = images.part(body, threads)?;
    let first = whole.first + division / 2;
    Ok(HalfSpacePart { rows: rows.clone(), first, stride: division, ..whole })
}

/// The `rows` of a grid, each divided.
fn rows_of(grid: &Grid, rows: &Range<usize>, division: usize) -> Result<Grid> {
    let ([_, ny], [dx, dy], [x, y]) = (grid.shape(), grid.spacing(), grid.center());
    let count = rows.len();
    let moved = 0.5 * (rows.start as f64 + rows.end as f64 - grid.shape()[0] as f64) * dx;
    let size = [count as f64 * dx, ny as f64 * dy];
    Grid::new([count * division, ny], size)?.centered_at([x + moved, y])
}
