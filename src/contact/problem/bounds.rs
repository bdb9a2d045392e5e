//! Pressures that a cell can carry: surfaces that touch push each other and never pull, up to a hardness.
//!
//! ```text
//! p = 0: g ≥ 0      0 < p < H: g = 0      p = H: g ≤ 0, and −g is the depth of the permanent dent
//! ```
//!
//! A pressure between the bounds is free to change. One at a bound is held there until the gap has the wrong sign. The
//! contact that an iteration works on is made of the cells that are free or have that gap.

use std::borrow::Cow;

use ndarray::{Array2, ArrayRef2};

use crate::error::{Error, Result, none_negative, same_shape};
use crate::model::grid::{Grid, Window};
use crate::numerics::layout::slice;
use crate::numerics::parallel::{Lanes, ONE, ZERO, all, where_positive};

/// The bounds 0 ≤ p ≤ H of the cells of a grid or window.
#[derive(Debug, Clone)]
pub(crate) struct Bounds<'a> {
    /// H of all cells in C order, or of one row where all rows are alike.
    limits: Cow<'a, [f64]>,
    columns: usize,
    is_limited: bool,
}

impl<'a> Bounds<'a> {
    /// p ≥ 0 alone.
    pub(crate) fn none(columns: usize) -> Self {
        Self { limits: vec![f64::INFINITY; columns].into(), columns, is_limited: false }
    }

    /// The bounds of surfaces with this hardness on rows of so many `columns`.
    pub(crate) fn of(hardness: &'a Hardness, columns: usize) -> Self {
        let limits = match hardness {
            Hardness::Uniform(limit) => vec![*limit; columns].into(),
            Hardness::Cells(limits) => slice(limits),
        };
        Self { limits, columns, is_limited: true }
    }

    /// The bounds in a window.
    pub(crate) fn in_window(&self, window: &Window) -> Bounds<'static> {
        let limits = if self.limits.len() == self.columns {
            self.limits[window[1].clone()].to_vec()
        } else {
            let rows = window[0].clone().flat_map(|i| &self.row(i)[window[1].clone()]);
            rows.copied().collect()
        };
        Bounds { limits: limits.into(), columns: window[1].len(), is_limited: self.is_limited }
    }

    /// Whether pressures have an upper bound.
    pub(crate) fn is_limited(&self) -> bool {
        self.is_limited
    }

    /// H along a row.
    pub(crate) fn row(&self, number: usize) -> &[f64] {
        let first = if self.limits.len() == self.columns { 0 } else { number * self.columns };
        &self.limits[first..first + self.columns]
    }

    /// H of a cell.
    pub(crate) fn limit(&self, cell: usize) -> f64 {
        self.limits[cell % self.limits.len()]
    }

    /// Whether the pressure `p` of a cell is free to change.
    pub(crate) fn is_free(&self, cell: usize, p: f64) -> bool {
        p > 0.0 && !self.is_at_limit(cell, p)
    }

    /// Whether the upper bound holds the pressure `p` of a cell.
    fn is_at_limit(&self, cell: usize, p: f64) -> bool {
        p >= self.limit(cell) && self.is_limited
    }

    /// The gap of a cell, positive where it is of the wrong sign for the bound that holds the pressure `p`; 0 where the
    /// pressure is free.
    pub(crate) fn wrong(&self, cell: usize, p: f64, gap: f64) -> f64 {
        if p <= 0.0 {
            -gap
        } else if self.is_at_limit(cell, p) {
            gap
        } else {
            0.0
        }
    }

    /// The allowed pressure nearest to `p`; NaN where it is NaN.
    pub(crate) fn nearest(&self, cell: usize, p: f64) -> f64 {
        p.clamp(0.0, self.limit(cell))
    }
}

/// A mask of the cells whose pressure no upper bound holds. One that overflows is not at a bound of +∞.
pub(crate) fn is_below(p: Lanes, limit: Lanes) -> Lanes {
    p.simd_lt(limit) | limit.simd_ge(all(f64::INFINITY))
}

/// A mask of the cells whose pressure is free to change.
pub(crate) fn is_free(p: Lanes, limit: Lanes) -> Lanes {
    p.simd_gt(ZERO) & is_below(p, limit)
}

/// A mask of the cells in the contact; `r` is the residual, 0 outside it.
pub(crate) fn in_contact(p: Lanes, limit: Lanes, r: Lanes) -> Lanes {
    is_free(p, limit) | r.simd_ne(ZERO)
}

/// The residual of cells with this `overlap`: 0 where a bound holds the pressure.
pub(crate) fn residual(p: Lanes, limit: Lanes, overlap: Lanes) -> Lanes {
    let rises = is_below(p, limit) & overlap.simd_gt(ZERO);
    let falls = p.simd_gt(ZERO) & overlap.simd_lt(ZERO);
    (rises | falls) & overlap
}

/// The allowed pressures nearest to `p`.
pub(crate) fn clip(p: Lanes, limit: Lanes) -> Lanes {
    where_positive(p, p).fast_min(limit)
}

/// 1 in cells where `p` is not allowed, 0 in the others.
pub(crate) fn not_allowed(p: Lanes, limit: Lanes) -> Lanes {
    (p.simd_lt(ZERO) | p.simd_gt(limit)) & ONE
}

/// Largest pressure that an elastic, perfectly plastic surface carries \[Pa\], above 0; +∞ where it does not yield.
///
/// Polonsky & Keer, Wear 231 (1999) 206, §2.3, doi:10.1016/S0043-1648(99)00113-1; Almqvist, Sahlin, Larsson &
/// Glavatskih, Tribol. Int. 40 (2007) 574, doi:10.1016/j.triboint.2005.11.008.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
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
    pub(crate) fn check(&self, grid: &Grid) -> Result<()> {
        let (name, requirement) = ("hardness", "above 0");
        if let Self::Cells(values) = self {
            same_shape(name, values, grid.shape())?;
        }
        match self.values().iter().find(|h| h.is_nan() || **h <= 0.0) {
            Some(&value) => Err(Error::Parameter { name, requirement, value }),
            None => Ok(()),
        }
    }

    /// The one number, or those of the cells in C order.
    fn values(&self) -> Cow<'_, [f64]> {
        match self {
            Self::Uniform(value) => std::slice::from_ref(value).into(),
            Self::Cells(values) => slice(values),
        }
    }

    /// Hardness of a cell by its number in C order.
    pub(crate) fn at(&self, cell: usize) -> f64 {
        match self {
            Self::Uniform(value) => *value,
            Self::Cells(values) => values[[cell / values.ncols(), cell % values.ncols()]],
        }
    }

    /// Largest hardness of the cells that may yield; 0 where none may.
    pub(crate) fn largest(&self) -> f64 {
        self.values().iter().filter(|h| h.is_finite()).fold(0.0, |a, h| a.max(*h))
    }
}

/// An error unless an indentation to start with suits `grid`, and is finite and nowhere below 0.
pub(crate) fn check_indentation(indentation: &ArrayRef2<f64>, grid: &Grid) -> Result<()> {
    same_shape("indentation", indentation, grid.shape())?;
    none_negative("indentation", indentation)
}
