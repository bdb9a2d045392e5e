//! The gap of a solution, which is computed when it is asked for.

use std::sync::Arc;

use ndarray::Array2;

use crate::contact::problem::Multipliers;
use crate::contact::problem::freedoms::Freedoms;
use crate::numerics::parallel::Row;

/// The gap of a solution, or what it is computed from.
#[derive(Debug, Clone)]
pub(crate) enum Gap {
    /// g = h + u − Bλ, with the displacement u of the solution.
    Computed {
        /// h, less the prescribed motion; solutions of one shape may share it.
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
    /// The gap of the solution, for its `displacement`.
    pub(crate) fn field(&self, displacement: &Array2<f64>) -> Array2<f64> {
        let (undeformed, freedoms, multipliers) = match self {
            Self::Computed { undeformed, freedoms, multipliers } => {
                (undeformed, freedoms, multipliers)
            }
            Self::Known(gap) => return gap.clone(),
        };
        let mut gap = Array2::zeros(undeformed.dim());
        // A user may have replaced the displacement.
        let displacement = displacement.as_standard_layout();
        let fields = gap.rows_mut().into_iter().zip(displacement.rows());
        let rows = fields.zip(undeformed.rows()).enumerate();
        let [x, y] = &freedoms.columns;
        for ((number, ((g, u), h)), &x) in rows.zip(x) {
            if let (Some(g), Some(u), Some(h)) = (g.into_slice(), u.to_slice(), h.to_slice()) {
                multipliers.gap(Row { number, x, y }, [u, h], g);
            }
        }
        gap
    }
}
