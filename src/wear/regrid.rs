//! Grids that grow with the contact, and depths on them.

use ndarray::Array2;

use crate::error::Result;
use crate::model::grid::Grid;

/// `grid` with a quarter of its cells more on both sides along `axes`; with cells twice as long where it would have more than
/// `most` cells.
pub(super) fn grown(grid: &Grid, axes: [bool; 2], most: usize) -> Result<Grid> {
    let spacing = grid.spacing();
    let wider = [0, 1].map(|k| {
        let n = grid.shape()[k];
        if axes[k] { n + 2 * n.div_ceil(4) } else { n }
    });
    let longer = if wider[0] * wider[1] > most { 2 } else { 1 };
    let is_line = grid.is_line();
    let cells = [0, 1].map(|k| if is_line && k == 0 { 1 } else { wider[k].div_ceil(longer) });
    let size = [0, 1].map(|k| (cells[k] * longer) as f64 * spacing[k]);
    match is_line {
        true => Grid::line(cells[1], size[1])?,
        false => Grid::new(cells, size)?,
    }
    .centered_at(grid.center())
}

/// Means over the cells of `to` of `values` on the cells of `from`, 0 outside: their sum times the area stays where `to` holds
/// `from`.
pub(super) fn regridded(values: &Array2<f64>, from: &Grid, to: &Grid) -> Array2<f64> {
    let [along_x, along_y] = [0, 1].map(|axis| shares(from, to, axis));
    along_x.dot(values).dot(&along_y.t())
}

/// Share of each cell of `to` that each cell of `from` covers along an axis.
fn shares(from: &Grid, to: &Grid, axis: usize) -> Array2<f64> {
    // In units of a cell of `from`, whose first one begins at 0: exact where the cells of `to` are multiples of them.
    let (cells, ratio) =
        (from.shape()[axis], (to.spacing()[axis] / from.spacing()[axis]).max(f64::MIN_POSITIVE));
    if cells == 1 && to.shape()[axis] == 1 {
        return Array2::ones([1, 1]);
    }
    let start = 0.5 * (cells as f64 - to.shape()[axis] as f64 * ratio)
        + (to.center()[axis] - from.center()[axis]) / from.spacing()[axis];
    Array2::from_shape_fn([to.shape()[axis], cells], |(i, j)| {
        let low = (start + i as f64 * ratio).max(j as f64);
        let high = (start + (i + 1) as f64 * ratio).min((j + 1) as f64);
        (high - low).max(0.0) / ratio
    })
}

#[cfg(test)]
mod tests {
    use ndarray::Array2;

    use super::{grown, regridded};
    use crate::error::Result;
    use crate::model::grid::Grid;

    /// The volume stays to rounding, whether cells are as long as before or twice as long.
    #[test]
    fn volume_is_kept() -> Result<()> {
        for (from, axes) in [
            (Grid::new([10, 7], [2.0, 3.0])?.centered_at([0.3, -0.2])?, [true, true]),
            (Grid::new([10, 8], [2.0, 3.0])?, [false, true]),
            (Grid::line(9, 1.8)?, [false, true]),
        ] {
            let depth = Array2::from_shape_fn(from.shape(), |(i, j)| ((7 * i + 3 * j) % 5) as f64);
            for most in [usize::MAX, 1] {
                let to = grown(&from, axes, most)?;
                let volume = regridded(&depth, &from, &to).sum() * to.cell_area();
                let due = depth.sum() * from.cell_area();
                assert!((volume / due - 1.0).abs() < 1e-14, "{volume} {due}");
                assert!(to.size()[1] > 1.4 * from.size()[1]);
            }
        }
        Ok(())
    }
}
