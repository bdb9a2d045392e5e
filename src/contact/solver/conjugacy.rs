//! The recurrence of conjugate directions, which all conjugate gradients here share.

/// Memory of the last direction: d ← z + β d.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Conjugacy {
    /// r · z of the last iteration; `None` where the next direction is z alone.
    descent: Option<f64>,
}

impl Conjugacy {
    /// β of the next direction, for the residual r and its preconditioned form z: `descent` is r · z,
    /// `with_last` the product of the last residual with z.
    ///
    /// Polak & Ribière, Rev. Fr. Inform. Rech. Opér. 3 (1969) 35: β = (r − r_last) · z / r_last · z_last.
    /// It is that of Fletcher and Reeves where `with_last` is 0, as it is for a linear problem.
    pub(super) fn beta(&mut self, descent: f64, with_last: f64) -> f64 {
        let last = self.descent.replace(descent);
        last.map_or(0.0, |last| ((descent - with_last) / last).max(0.0))
    }

    /// Makes the next direction z alone.
    pub(super) fn restart(&mut self) {
        self.descent = None;
    }
}
