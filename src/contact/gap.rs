//! The gap of a solution, which is computed when it is asked for.

use std::sync::Arc;

use ndarray::Array2;

use super::fields::{slice, slice_mut};
use super::freedoms::Freedoms;
use super::passes::Row;
use super::problem::Multipliers;

/// What the gap of a solution is made of.
#[derive(Debug, Clone)]
pub(super) enum Gap {
    /// g = h + u − Bλ, of the displacement u.
    Of {
        /// h, less the prescribed motion; solutions of one shape share it.
        undeformed: Arc<Array2<f64>>,
        /// B
        freedoms: Box<Freedoms>,
        /// λ
        multipliers: Multipliers,
    },
    /// g
    Known(Array2<f64>),
}

impl Gap {
    /// It, of a solution with that displacement.
    pub(super) fn of(&self, displacement: &Array2<f64>) -> Array2<f64> {
        let (undeformed, freedoms, multipliers) = match self {
            Self::Of {
                undeformed,
                freedoms,
                multipliers,
            } => (undeformed, freedoms, multipliers),
            Self::Known(gap) => return gap.clone(),
        };
        let mut gap = Array2::zeros(displacement.dim());
        let (u, h, g) = (slice(displacement), slice(undeformed), slice_mut(&mut gap));
        let y = &freedoms.columns[1];
        for (number, (x, cells)) in freedoms.rows().enumerate() {
            let fields = [u, h].map(|field| &field[cells.clone()]);
            multipliers.gap(Row { number, x, y }, fields, &mut g[cells]);
        }
        gap
    }
}
