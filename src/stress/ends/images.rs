//! Mirror images and excesses of a pressure, on the rows and columns of cells that continue those of a grid.

use ndarray::{Array2, ArrayRef2};

use crate::error::Result;
use crate::model::grid::Grid;

/// Pressures that are added up on cells beside those of a grid, and on these.
#[derive(Debug)]
pub(super) struct Images {
    grid: Grid,
    pieces: Vec<Piece>,
}

/// Pressure on consecutive rows.
#[derive(Debug)]
struct Piece {
    /// Number of its first row, counted as the grid's are; not a whole number where the end is not on an edge of
    /// cells. Such rows are shared by their two neighbours, with their force and moment.
    first: f64,
    /// Columns beyond those of the grid on both sides.
    margin: usize,
    pressure: Array2<f64>,
}

/// Share of a row that is rounding.
const ROUNDING: f64 = 1e-6;

impl Images {
    pub(super) fn new(grid: &Grid) -> Self {
        Self {
            grid: *grid,
            pieces: Vec::new(),
        }
    }

    pub(super) fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Number of the row with its centre at x.
    fn row(&self, x: f64) -> f64 {
        let at = (x - self.grid.x()[0]) / self.grid.spacing()[0];
        if (at - at.round()).abs() < ROUNDING {
            at.round()
        } else {
            at
        }
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
        self.pieces.push(Piece {
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
        self.pieces.push(Piece {
            first: self.row(end - (count as f64 - 0.5) * dx),
            margin,
            pressure: Array2::from_shape_fn(shape, |(i, j)| {
                let distance = if i < count { count - 1 - i } else { i - count };
                excess[[distance, j]]
            }),
        });
    }

    /// The sum of all, the grid that it is on, and the first row and column there of the grid that it continues.
    pub(super) fn together(&self) -> Result<(Array2<f64>, Grid, [usize; 2])> {
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
            let (first, column) = (
                (piece.first.floor() as i64 - low) as usize,
                margin - piece.margin,
            );
            for (i, from) in piece.pressure.rows().into_iter().enumerate() {
                for (row, share) in [(first + i, 1.0 - share), (first + i + 1, share)] {
                    if share > 0.0 {
                        let mut row = sum.row_mut(row);
                        let to = row.iter_mut().skip(column);
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
