//! A limit of the pressure: elastic, perfectly plastic surfaces, which yield at their hardness.
//!
//! ```text
//! p = 0: g ≥ 0      0 < p < H: g = 0      p = H: g ≤ 0, and −g is the permanent indentation
//! ```
//!
//! Polonsky & Keer, Wear 231 (1999) 206, §2.3, doi:10.1016/S0043-1648(99)00113-1; Almqvist, Sahlin, Larsson &
//! Glavatskih, Tribol. Int. 40 (2007) 574, doi:10.1016/j.triboint.2005.11.008. The algorithm is nacre's own.
//!
//! Cells that yield bear H. The others are an elastic contact, under the rest of the load, with the surface that
//! the yielding cells have displaced. From the elastic solution on, cells that bear more than H yield, until there are
//! none. On a half-space no cell yields too early: the others can only come to bear more while cells yield. Cells that
//! part nevertheless, as they may on layers, bear less than H again.

mod yielding;

use ndarray::{Array2, ArrayRef2};

use super::problem::Problem;
use super::problem::fields::slice;
use crate::error::{Error, Result};
use crate::grid::Grid;

pub(super) use yielding::{Elastic, Yielding};

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
            Some(&value) => Err(Error::Parameter {
                name,
                requirement,
                value,
            }),
            None => Ok(()),
        }
    }

    /// Hardness of a cell by its number in C order.
    pub(crate) fn at(&self, cell: usize) -> f64 {
        match self {
            Self::Uniform(value) => *value,
            Self::Cells(values) => slice(values)[cell],
        }
    }

    /// Whether no cell has a `pressure` above it.
    pub(super) fn bears(&self, pressure: &Array2<f64>) -> bool {
        let cells = slice(pressure).iter().enumerate();
        cells.into_iter().all(|(k, p)| *p <= self.at(k))
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
        false => Err(Error::Shape {
            name,
            expected,
            found,
        }),
    }
}

/// An error unless an indentation to start with suits `grid`, and is finite and nowhere below 0.
pub(super) fn check_indentation(indentation: &ArrayRef2<f64>, grid: &Grid) -> Result<()> {
    let name = "indentation";
    check_shape(name, indentation, grid)?;
    if let Some((index, _)) = indentation.indexed_iter().find(|(_, w)| !w.is_finite()) {
        return Err(Error::NonFinite {
            name,
            index: index.into(),
        });
    }
    match indentation.iter().find(|w| **w < 0.0) {
        Some(&value) => Err(Error::Parameter {
            name,
            requirement: "at least 0 everywhere",
            value,
        }),
        None => Ok(()),
    }
}

/// An error where the load is above what the cells that can touch bear.
///
/// # Errors
/// [`Error::Overload`].
pub(super) fn check_load(problem: &Problem, hardness: &Hardness) -> Result<()> {
    let touching = (0..problem.gap.len()).filter(|&k| problem.gap[k].is_finite());
    let bears: f64 = touching.map(|k| hardness.at(k)).sum();
    let freedoms = problem.freedoms;
    match freedoms.loaded[0] && freedoms.target[0] >= bears {
        true => Err(Error::Overload {
            load: freedoms.target[0] * freedoms.cell_area,
            bears: bears * freedoms.cell_area,
        }),
        false => Ok(()),
    }
}
