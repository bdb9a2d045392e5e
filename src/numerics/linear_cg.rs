//! Preconditioned conjugate gradients for a linear system, without constraints.
//!
//! Hestenes & Stiefel, J. Res. Natl. Bur. Stand. 49 (1952) 409, doi:10.6028/jres.049.044. [`Conjugacy`] is the
//! recurrence of directions that the conjugate gradients with constraints share.

use std::ops::ControlFlow;

use crate::error::{Error, Result};
use crate::numerics::parallel::dot;

/// Iterations after which a system counts as unsolvable; solvable ones take some tens.
const MAX_ITERATIONS: usize = 10_000;

/// Callback that says whether to continue.
pub type Watch<'a> = dyn FnMut() -> ControlFlow<()> + 'a;

/// Solves A x = `right` to a residual of `tolerance`, relative to `right`. `apply` computes A v, and
/// `precondition` an approximation of A⁻¹ v. Both must be symmetric and positive definite. `watch` is asked before each
/// iteration whether to continue.
///
/// # Errors
/// [`Error::Indefinite`] where A is not positive definite and the iteration meets it; [`Error::NotConverged`]; [`Error::Stopped`]
/// where `watch` breaks.
pub(crate) fn solve(
    right: &[f64],
    mut apply: impl FnMut(&[f64], &mut [f64]),
    mut precondition: impl FnMut(&[f64], &mut [f64]),
    tolerance: f64,
    watch: &mut Watch,
) -> Result<Vec<f64>> {
    let cells = right.len();
    let (mut x, mut r) = (vec![0.0; cells], right.to_vec());
    let (mut z, mut image) = (vec![0.0; cells], vec![0.0; cells]);
    let mut direction = vec![0.0; cells];
    let mut conjugacy = Conjugacy::default();
    let size = dot(right, right).sqrt();
    for _ in 0..MAX_ITERATIONS {
        if dot(&r, &r).sqrt() <= tolerance * size {
            return Ok(x);
        }
        if watch().is_break() {
            return Err(Error::Stopped);
        }
        precondition(&r, &mut z);
        let descent = dot(&r, &z);
        let beta = conjugacy.beta(descent, 0.0);
        for (d, z) in direction.iter_mut().zip(&z) {
            *d = z + beta * *d;
        }
        apply(&direction, &mut image);
        let curvature = dot(&direction, &image);
        if curvature <= 0.0 {
            return Err(Error::Indefinite);
        }
        let step = descent / curvature;
        for k in 0..cells {
            x[k] += step * direction[k];
            r[k] -= step * image[k];
        }
    }
    let residual = dot(&r, &r).sqrt() / size;
    Err(Error::not_converged(MAX_ITERATIONS, residual, tolerance, "max_iterations"))
}

/// Memory of the last direction: d ← z + β d.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Conjugacy {
    /// r · z of the last iteration; `None` where the next direction is z alone.
    descent: Option<f64>,
}

impl Conjugacy {
    /// β of the next direction, for the residual r and its preconditioned form z: `descent` is r · z,
    /// `with_last` the product of the last residual with z.
    ///
    /// Polak & Ribière, Rev. Fr. Inform. Rech. Opér. 3 (1969) 35: β = (r − r_last) · z / r_last · z_last.
    /// It is that of Fletcher and Reeves where `with_last` is 0, as it is for a linear problem.
    pub(crate) fn beta(&mut self, descent: f64, with_last: f64) -> f64 {
        let last = self.descent.replace(descent);
        last.map_or(0.0, |last| ((descent - with_last) / last).max(0.0))
    }

    /// Makes the next direction z alone.
    pub(crate) fn restart(&mut self) {
        self.descent = None;
    }
}
