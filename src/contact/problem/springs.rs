//! Springs between the surfaces, one in each cell: their compliances are a diagonal of the operator.

use ndarray::Array2;

use crate::error::{Error, Result, none_negative, not_negative, same_shape};
use crate::model::grid::Grid;

/// Compliance c of springs between the surfaces \[m/Pa\], at least 0: g = h + u + c p − δ − s_x x − s_y y.
///
/// It is that of a bed, of soft asperities, or of what a step of wear removes per pressure. One number for all cells is
/// what [`Response::local`](crate::Response::local) adds to a body.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Compliance {
    /// One number for all cells.
    Uniform(f64),
    /// One for each cell of the grid, (nx, ny).
    Cells(Array2<f64>),
}

impl Compliance {
    /// The compliances of the cells of `grid`.
    ///
    /// # Errors
    /// An array of another shape than the grid, and a value that is negative or not finite.
    pub(crate) fn on(&self, grid: &Grid) -> Result<Array2<f64>> {
        match self {
            Self::Uniform(value) => {
                Ok(Array2::from_elem(grid.shape(), not_negative("compliance", *value)?))
            }
            Self::Cells(values) => {
                same_shape("compliance", values, grid.shape())?;
                none_negative("compliance", values)?;
                Ok(values.clone())
            }
        }
    }

    /// Checks that it does not depend on a grid that is still to be chosen.
    pub(crate) fn check_without_grid(&self) -> Result<()> {
        match self {
            Self::Uniform(value) => not_negative("compliance", *value).map(|_| ()),
            Self::Cells(_) => Err(Error::Inconsistent(
                "compliance of each cell needs a grid: give grid, or one number for all cells",
            )),
        }
    }
}
