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

use ndarray::{Array2, ArrayRef2};

use super::problem::Problem;
use super::problem::fields::slice;
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

/// An error where the load, or a moment along one axis, is above what the cells that can touch bear.
///
/// # Errors
/// [`Error::Overload`], [`Error::Overturned`].
pub(super) fn check_load(problem: &Problem, hardness: &Hardness) -> Result<()> {
    let touching = (0..problem.gap.len()).filter(|&k| problem.gap[k].is_finite());
    let bears: f64 = touching.map(|k| hardness.at(k)).sum();
    let freedoms = problem.freedoms;
    if freedoms.loaded[0] && freedoms.target[0] >= bears {
        return Err(Error::Overload {
            load: freedoms.target[0] * freedoms.cell_area,
            bears: bears * freedoms.cell_area,
        });
    }
    for axis in (0..2).filter(|axis| freedoms.loaded[axis + 1]) {
        let (asked, at) = (freedoms.target[axis + 1], &freedoms.columns[axis]);
        let mut lines = vec![0.0; at.len()];
        let columns = freedoms.columns[1].len();
        for cell in (0..problem.gap.len()).filter(|&cell| problem.gap[cell].is_finite()) {
            lines[[cell / columns, cell % columns][axis]] += hardness.at(cell);
        }
        let load = freedoms.loaded[0].then_some(freedoms.target[0]);
        let lines: Vec<[f64; 2]> = at.iter().copied().zip(lines).map(Into::into).collect();
        let [low, high] = [-1.0, 1.0].map(|side| side * farthest(&lines, side, load));
        if asked <= low || asked >= high {
            return Err(Error::Overturned {
                axis: ["x", "y"][axis],
                moment: freedoms.moment(axis, asked),
                range: [low, high].map(|bound| freedoms.moment(axis, bound)),
            });
        }
    }
    Ok(())
}

/// The largest moment Σ p (side · x) of a load that lines of cells bear up to their limit, each given as its coordinate x
/// and its limit; of any load where none is given.
fn farthest(lines: &[[f64; 2]], side: f64, load: Option<f64>) -> f64 {
    let mut rest = load.unwrap_or(f64::INFINITY);
    let mut lines: Vec<[f64; 2]> = lines.iter().map(|[x, most]| [side * x, *most]).collect();
    lines.sort_by(|a, b| b[0].total_cmp(&a[0]));
    let mut moment = 0.0;
    for [x, most] in lines {
        let borne = most.min(rest);
        // A load that is not given stays on its side of the origin.
        if borne > 0.0 && (load.is_some() || x > 0.0) {
            moment += borne * x;
            rest -= borne;
        }
    }
    moment
}
