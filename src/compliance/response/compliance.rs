//! The four surface compliances of a half-space at one wavenumber.

use crate::model::material::Elastic;

/// Surface compliance at one wavenumber: [`c11`](Self::c11), [`c12`](Self::c12),
/// [`c22`](Self::c22), [`ct`](Self::ct), as in the formula of [`response`](crate::compliance::response).
///
/// In \[m/Pa\] when returned by [`surface_compliance`](super::surface_compliance).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compliance {
    /// Normal displacement under pressure.
    pub c11: f64,
    /// Lateral displacement under pressure, and normal displacement under lateral traction.
    pub c12: f64,
    /// Lateral displacement under traction along the wave vector.
    pub c22: f64,
    /// Displacement under traction across the wave vector.
    pub ct: f64,
}

impl Compliance {
    /// Compliance of a rigid base.
    pub(super) const RIGID: Self = Self {
        c11: 0.0,
        c12: 0.0,
        c22: 0.0,
        ct: 0.0,
    };

    /// α times the compliance of a homogeneous half-space \[1/Pa\], the same at every α.
    ///
    /// ```text
    /// α c11 = α c22 = (1 − ν)/G     α c12 = (1 − 2ν)/2G     α ct = 1/G
    /// ```
    pub fn homogeneous(material: Elastic) -> Self {
        let (g, nu) = (material.shear(), material.poisson());
        let c11 = (1.0 - nu) / g;
        Self {
            c11,
            c12: (1.0 - 2.0 * nu) / (2.0 * g),
            c22: c11,
            ct: 1.0 / g,
        }
    }

    /// All four compliances times `factor`.
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self {
            c11: self.c11 * factor,
            c12: self.c12 * factor,
            c22: self.c22 * factor,
            ct: self.ct * factor,
        }
    }
}
