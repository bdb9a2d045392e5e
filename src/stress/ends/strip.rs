//! The pressure beside an edge on cells finer than those of the contact.
//!
//! Beside the edge, the excess P − p on the surface and Q on the end face change as the logarithm of the distance,
//! which the contact's cells do not resolve. On a strip beside the edge, their stress is therefore replaced by that
//! of finer cells.

use std::f64::consts::PI;

use ndarray::{Array2, ArrayRef2};

/// Cells from the edge on of which the pressure is replaced, and those that keep none of it: in between, the share
/// falls as a cosine, so that the stress of either part is smooth.
const REPLACED: [usize; 2] = [3, 12];

/// Cells from the edge on in which the stress is that of finer cells.
pub(super) const STRIP: usize = 18;

/// Finer cells in one of the contact's, at least.
const FINER: f64 = 9.0;

/// A pressure beside an edge, by the distance from it.
pub(super) struct Strip {
    /// Finer cells in one.
    pub(super) division: usize,
    /// Means over cells, and over finer ones.
    pub(super) coarse: Array2<f64>,
    pub(super) fine: Array2<f64>,
}

impl Strip {
    /// A strip of cells of a length `spacing`, beside a contact with cells of length `dx`. `means` takes the length
    /// of cells and their number, and returns the pressure.
    pub(super) fn new(
        spacing: f64,
        dx: f64,
        means: impl FnOnce(f64, usize) -> Array2<f64>,
    ) -> Self {
        // An odd number, so that centres coincide.
        let half = 0.5 * (FINER * spacing / dx - 1.0);
        let division = 2 * half.ceil() as usize + 1;
        let [all, none] = REPLACED.map(|cells| (cells * division) as f64);
        let mut fine = means(spacing / division as f64, REPLACED[1] * division);
        for (i, mut row) in fine.rows_mut().into_iter().enumerate() {
            let t = ((i as f64 + 0.5 - all) / (none - all)).clamp(0.0, 1.0);
            row *= 0.5 * (1.0 + (PI * t).cos());
        }
        Self {
            division,
            coarse: means_of(&fine, division),
            fine,
        }
    }
}

/// Means over groups of `division` rows.
fn means_of(fine: &ArrayRef2<f64>, division: usize) -> Array2<f64> {
    let mut means = Array2::zeros((fine.nrows() / division, fine.ncols()));
    for (i, row) in fine.rows().into_iter().enumerate() {
        means
            .row_mut(i / division)
            .scaled_add(1.0 / division as f64, &row);
    }
    means
}
