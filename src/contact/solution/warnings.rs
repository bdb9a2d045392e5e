//! Warnings about a finished solution.

use std::fmt;

use ndarray::Array2;

use crate::contact::problem::constraint::NonNegative;
use crate::contact::problem::patch::rows;
use crate::grid::{Grid, Window};
use crate::parallel::update_with_largest;
use crate::surface::{Extent, Surface};

/// A warning: something about a solution that its user should know.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// The contact touches the edge of the grid, and the shape goes on beyond it.
    GridEdge,
    /// The contact reaches the end of a shape of finite length.
    SharpEnd {
        /// 0 along x, 1 along y.
        axis: usize,
    },
    /// Fewer than eight cells resolve the contact.
    Coarse {
        /// 0 along x, 1 along y.
        axis: usize,
        /// Number of cells across the contact.
        cells: usize,
    },
    /// The contact is not small compared with a radius of curvature.
    LargeContact {
        /// 0 along x, 1 along y.
        axis: usize,
        /// Half-width over radius.
        ratio: f64,
    },
}

/// Half-width over radius at which a circle leaves its parabola by 1 %: (a/R)²/4.
const LARGE_CONTACT: f64 = 0.2;

/// Cells across the contact below which pressure errs by some per cent.
const FEW_CELLS: usize = 8;

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let along = |axis: &usize| if *axis == 0 { "x" } else { "y" };
        match self {
            Self::GridEdge => {
                write!(
                    f,
                    "the contact touches the edge of the grid; take a larger grid"
                )
            }
            Self::SharpEnd { axis } => write!(
                f,
                "the contact reaches the end of the shape along {}: the pressure there is that of \
                 a sharp edge on a half-space that goes on, and grows as the grid is refined",
                along(axis)
            ),
            Self::Coarse { axis, cells } => write!(
                f,
                "the contact is only {cells} cells wide along {}; take a finer grid",
                along(axis)
            ),
            Self::LargeContact { axis, ratio } => write!(
                f,
                "the contact is not small compared with the radius along {}: half-width/radius = \
                 {ratio:.2}; the bodies are taken as half-spaces",
                along(axis)
            ),
        }
    }
}

/// What the user of a solution should know.
pub(crate) fn warnings(
    pressure: &Array2<f64>,
    window: &Window,
    grid: &Grid,
    shape: &dyn Surface,
) -> Vec<Warning> {
    let [nx, ny] = grid.shape();
    let [dx, dy] = grid.spacing();
    let (x, y) = (grid.x(), grid.y());
    let mut warnings = Vec::new();

    let goes_on = |i: usize, j: usize| {
        let beyond = |at: usize, n: usize, d: f64| match at {
            _ if n == 1 => 0.0,
            0 => -d,
            _ if at == n - 1 => d,
            _ => 0.0,
        };
        shape
            .gap(x[i] + beyond(i, nx, dx), y[j] + beyond(j, ny, dy))
            .is_finite()
    };
    let mut at_edge = false;
    // Largest pressures of the lines of cells across each axis.
    let mut highest = [vec![0.0; nx], vec![0.0; ny]];
    for (i, row) in window[0].clone().zip(rows(pressure, window)) {
        let columns = &mut highest[1][window[1].clone()];
        let ([top], []) = update_with_largest([row], [columns], |[p], [highest]| {
            ([highest.fast_max(p)], [p], [])
        });
        highest[0][i] = top;
        let reaches = |j: usize| NonNegative.is_free(row[j - window[1].start]) && goes_on(i, j);
        let mut ends = [0, ny - 1].into_iter().filter(|j| window[1].contains(j));
        at_edge |= if !grid.is_line() && (i == 0 || i == nx - 1) {
            window[1].clone().any(reaches)
        } else {
            ends.any(reaches)
        };
    }
    if at_edge {
        warnings.push(Warning::GridEdge);
    }

    let (mut cells, mut ends) = ([0; 2], [[f64::INFINITY, f64::NEG_INFINITY]; 2]);
    for (axis, coordinates) in [&x, &y].into_iter().enumerate() {
        let lines = coordinates.iter().zip(&highest[axis]);
        for (at, _) in lines.filter(|(_, highest)| NonNegative.is_free(**highest)) {
            cells[axis] += 1;
            ends[axis] = [ends[axis][0].min(*at), ends[axis][1].max(*at)];
        }
    }
    if cells[0] == 0 {
        return warnings;
    }
    for axis in if grid.is_line() { 1..2 } else { 0..2 } {
        let spacing = grid.spacing()[axis];
        if let Extent::CutOff([low, high]) = shape.extent()[axis]
            && (ends[axis][0] - spacing < low || ends[axis][1] + spacing > high)
        {
            warnings.push(Warning::SharpEnd { axis });
        }
        if cells[axis] < FEW_CELLS {
            warnings.push(Warning::Coarse {
                axis,
                cells: cells[axis],
            });
        }
        let half_width = 0.5 * (ends[axis][1] - ends[axis][0] + spacing);
        let ratio = half_width / shape.radii()[axis];
        if ratio > LARGE_CONTACT {
            warnings.push(Warning::LargeContact { axis, ratio });
        }
    }
    warnings
}
