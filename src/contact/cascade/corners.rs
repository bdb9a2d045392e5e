//! Corners of a shape: the error of the peak pressure that coarser grids do not show, since their cells average
//! corners away.
//!
//! Where the gap has a corner at which its slope grows by Δs, as a profile of straight lines has between two of them,
//! the pressure rises as (E* Δs/2π) ln(2a/|x|): Johnson, Contact Mechanics (1985), §5.2,
//! doi:10.1017/CBO9781139171731. It has no limit, and cells half as long bear E* Δs ln 2/2π more. The error is what
//! cells four times shorter would add to the peak. The estimate is nacre's own.

use std::f64::consts::PI;

use ndarray::Array2;

use crate::model::grid::Grid;
use crate::model::surface::Surface;

/// Parts into which an interval is divided in the search for a corner.
const PARTS: usize = 8;

/// Divisions of a cell: a smooth gap leaves 4⁻⁴ of the change of its slope over the cell.
const DIVISIONS: usize = 5;

/// Share of the largest change of the slope over an eighth of the cell that a corner keeps: all of it, or half where it
/// lies between two points.
const KEPT: f64 = 0.4;

/// How much finer cells are that the estimate looks at.
const FINER: f64 = 4.0;

/// Error of the peak of a `pressure` \[Pa\], on the lines of cells through it, for bodies whose responses α û/p̂ to waves
/// of a cell's length have this sum \[1/Pa\]. Measured surfaces have no other points than the cells.
pub(crate) fn peak_error(
    pressure: &Array2<f64>,
    grid: &Grid,
    shape: &dyn Surface,
    short: f64,
) -> f64 {
    if shape.grid().is_some() || short <= 0.0 {
        return 0.0;
    }
    let peak = pressure.fold(0.0_f64, |most, p| most.max(*p));
    let found = pressure.indexed_iter().find(|(_, p)| **p >= peak);
    let Some(((row, column), _)) = found.filter(|(_, p)| **p > 0.0) else {
        return 0.0;
    };
    let (x, y, spacing) = (grid.x(), grid.y(), grid.spacing());
    // E* ln 4/2π
    let per_slope = 2.0 / short * FINER.ln() / (2.0 * PI);
    let mut most = 0.0_f64;
    let mut look = |p: f64, axis: usize, at: [f64; 2]| {
        if p > 0.0 {
            let gap = |offset: f64| {
                let mut at = at;
                at[axis] += offset;
                shape.gap(at[0], at[1])
            };
            most = most.max(p + per_slope * corner(gap, spacing[axis]) - peak);
        }
    };
    if !grid.is_line() {
        for (p, x) in pressure.column(column).iter().zip(&x) {
            look(*p, 0, [*x, y[column]]);
        }
    }
    for (p, y) in pressure.row(row).iter().zip(&y) {
        look(*p, 1, [x[row], *y]);
    }
    most
}

/// Growth of the slope at a corner of `gap` within half a `length` of 0; 0 where there is none.
fn corner(gap: impl Fn(f64) -> f64, length: f64) -> f64 {
    let (mut middle, mut length) = (0.0, length);
    let mut widest = None;
    let mut total = 0.0;
    for _ in 0..DIVISIONS {
        let part = length / PARTS as f64;
        // Slopes of the parts, and of one before and after: a corner may lie on the rim.
        let at = |k: usize| gap(middle + part * (k as f64 - 0.5 * PARTS as f64 - 1.0));
        let heights: [f64; PARTS + 3] = std::array::from_fn(at);
        let growths = heights
            .windows(3)
            .map(|h| (h[2] - 2.0 * h[1] + h[0]) / part);
        total = growths.clone().sum();
        let sharpest = growths.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((place, found)) = sharpest.filter(|(_, found)| found.is_finite()) else {
            return 0.0;
        };
        if found <= 0.0 || found < KEPT * *widest.get_or_insert(found) {
            return 0.0;
        }
        middle += part * (place as f64 - 0.5 * PARTS as f64);
        length = 2.0 * part;
    }
    total
}

#[cfg(test)]
mod tests {
    use super::corner;

    /// A corner is found wherever it lies in the cell, to the rounding of second differences; circles, parabolas and
    /// logarithms have none.
    #[test]
    fn corners_are_told_from_curvature() {
        for place in [-0.5, -0.31, 0.0, 0.123, 0.5] {
            let gap = |x: f64| 0.2 * x + 1e-3 * (x - place).max(0.0) + 1e-3 * x * x;
            let found = corner(gap, 1.0);
            assert!((found / 1e-3 - 1.0).abs() < 0.02, "{place}: {found}");
        }
        for gap in [
            |x: f64| x * x,
            |x: f64| 1.0 - (1.0 - x * x).sqrt(),
            |x: f64| -(0.9 - x).ln(),
        ] {
            assert!(corner(gap, 1.0).abs() <= 0.0);
        }
        assert!(
            corner(|x| -x.abs(), 1.0).abs() <= 0.0,
            "a reentrant corner lowers the pressure"
        );
        assert!(corner(|x| if x < 0.2 { 0.0 } else { f64::INFINITY }, 1.0).abs() <= 0.0);
    }
}
