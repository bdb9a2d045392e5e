//! Cells and weights of points and peaks.

use crate::error::{Error, Result, finite};
use crate::model::grid::Grid;

/// Distance, in cells, within which a coordinate counts as that of a cell centre or of the grid's border.
const CENTRE: f64 = 1e-9;

/// Cells around (x, y) and their weights, bilinear between cell centres and constant beyond the outer ones. A line contact is
/// the same at every x.
///
/// # Errors
/// A point that is not on the grid.
pub(super) fn bilinear(grid: &Grid, at: [f64; 2]) -> Result<Vec<([usize; 2], f64)>> {
    let along = |axis: usize| -> Result<Vec<(usize, f64)>> {
        let n = grid.shape()[axis];
        if axis == 0 && grid.is_line() {
            return Ok(vec![(0, 1.0)]);
        }
        let name = ["x", "y"][axis];
        let value = finite(name, at[axis])?;
        let position = (value - grid.center()[axis]) / grid.spacing()[axis] + 0.5 * (n - 1) as f64;
        if !(-0.5 - CENTRE..=n as f64 - 0.5 + CENTRE).contains(&position) {
            return Err(Error::Parameter {
                name,
                requirement: "on the grid",
                value,
            });
        }
        let nearest = position.round();
        let position = match (position - nearest).abs() < CENTRE {
            true => nearest,
            false => position,
        };
        let position = position.clamp(0.0, (n - 1) as f64);
        let below = position as usize;
        let weight = position - below as f64;
        Ok([(below, 1.0 - weight), (below + 1, weight)]
            .into_iter()
            .filter(|(_, weight)| *weight > 0.0)
            .collect())
    };
    let (rows, columns) = (along(0)?, along(1)?);
    let pairs = rows.iter().flat_map(|(i, s)| {
        let pair = move |(j, t): &(usize, f64)| ([*i, *j], s * t);
        columns.iter().map(pair)
    });
    Ok(pairs.collect())
}

/// Weights (before, at, after) whose sum with three values is the peak of the parabola through them, and whose sum is 1;
/// none where the middle is no maximum.
///
/// ```text
/// w = (t (t − 1)/2, 1 − t², t (t + 1)/2)      t = (p₋ − p₊)/(2 (p₋ − 2 p + p₊))
/// ```
pub(super) fn parabola([before, at, after]: [f64; 3]) -> Option<[f64; 3]> {
    let bend = before - 2.0 * at + after;
    if bend >= 0.0 {
        return None;
    }
    let t = 0.5 * (before - after) / bend;
    Some([0.5 * t * (t - 1.0), 1.0 - t * t, 0.5 * t * (t + 1.0)])
}
