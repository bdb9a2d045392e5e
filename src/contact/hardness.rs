//! A limit of the pressure: elastic, perfectly plastic surfaces, which yield at their hardness.
//!
//! ```text
//! p = 0: g ≥ 0      0 < p < H: g = 0      p = H: g ≤ 0, and −g is the depth of the permanent dent
//! ```
//!
//! Polonsky & Keer, Wear 231 (1999) 206, §2.3, doi:10.1016/S0043-1648(99)00113-1; Almqvist, Sahlin, Larsson &
//! Glavatskih, Tribol. Int. 40 (2007) 574, doi:10.1016/j.triboint.2005.11.008. The iteration holds a cell at the hardness
//! as it holds one at 0 (`problem/bounds.rs`).

use ndarray::{Array2, ArrayRef2};

use crate::error::{Error, Result};
use crate::model::grid::Grid;

/// Largest pressure that a surface bears \[Pa\], above 0; +∞ where it does not yield.
#[derive(Debug, Clone, PartialEq)]
pub enum Hardness {
    /// One number for all cells.
    Uniform(f64),
    /// One for each cell of the grid, (nx, ny).
    Cells(Array2<f64>),
}

impl Hardness {
    /// The hardness as it was given, on `grid`.
    ///
    /// # Errors
    /// An array of another shape than the grid, and a value that is not above 0.
    pub(super) fn check(&self, grid: &Grid) -> Result<()> {
        let (name, requirement) = ("hardness", "above 0");
        let values = match self {
            Self::Uniform(value) => std::slice::from_ref(value),
            Self::Cells(values) => {
                check_shape(name, values, grid)?;
                values.as_slice().unwrap_or(&[])
            }
        };
        match values.iter().find(|h| h.is_nan() || **h <= 0.0) {
            Some(&value) => Err(Error::Parameter { name, requirement, value }),
            None => Ok(()),
        }
    }

    /// Hardness of a cell by its number in C order.
    pub(crate) fn at(&self, cell: usize) -> f64 {
        match self {
            Self::Uniform(value) => *value,
            Self::Cells(values) => values.as_slice().unwrap_or(&[])[cell],
        }
    }

    /// Whether any cell may yield.
    pub(super) fn is_limited(&self) -> bool {
        match self {
            Self::Uniform(value) => value.is_finite(),
            Self::Cells(values) => values.iter().any(|value| value.is_finite()),
        }
    }

    /// The hardness, where it is the same everywhere: grids may be chosen with it.
    pub(super) fn uniform(&self) -> Option<&Self> {
        matches!(self, Self::Uniform(_)).then_some(self)
    }
}

/// An error unless an array has the shape of `grid`.
fn check_shape(name: &'static str, values: &ArrayRef2<f64>, grid: &Grid) -> Result<()> {
    let (expected, found) = (grid.shape(), [values.nrows(), values.ncols()]);
    match found == expected {
        true => Ok(()),
        false => Err(Error::Shape { name, expected, found }),
    }
}

/// An error unless an indentation to start with suits `grid`, and is finite and nowhere below 0.
pub(super) fn check_indentation(indentation: &ArrayRef2<f64>, grid: &Grid) -> Result<()> {
    let name = "indentation";
    check_shape(name, indentation, grid)?;
    if let Some((index, _)) = indentation.indexed_iter().find(|(_, w)| !w.is_finite()) {
        return Err(Error::NonFinite { name, index: index.into() });
    }
    match indentation.iter().find(|w| **w < 0.0) {
        Some(&value) => Err(Error::Parameter { name, requirement: "at least 0 everywhere", value }),
        None => Ok(()),
    }
}
