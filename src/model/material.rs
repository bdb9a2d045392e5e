//! Isotropic linear elastic materials.

use crate::error::{Result, positive, require};
use crate::model::data::value;

/// An isotropic linear elastic material.
///
/// ```
/// let steel = nacre::Elastic::new(210e9, 0.3)?;
/// assert!((steel.plane_strain_modulus() / 210e9 - 1.0 / 0.91).abs() < 1e-15);
/// assert!((steel.shear() - 210e9 / 2.6).abs() < 1.0);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    young: f64,
    poisson: f64,
}

impl Elastic {
    /// A material of Young's modulus `young` \[Pa\] and Poisson's ratio `poisson`.
    ///
    /// # Errors
    /// Unless `young` > 0 and −1 < `poisson` ≤ 0.5.
    pub fn new(young: f64, poisson: f64) -> Result<Self> {
        positive("young", young)?;
        require("poisson", poisson, poisson > -1.0 && poisson <= 0.5, "above -1 and at most 0.5")?;
        // Adding 0.0 turns −0.0 into 0.0: equal values then print alike.
        Ok(Self { young, poisson: poisson + 0.0 })
    }

    /// Young's modulus E \[Pa\].
    pub fn young(&self) -> f64 {
        self.young
    }

    /// Poisson's ratio ν.
    pub fn poisson(&self) -> f64 {
        self.poisson
    }

    /// Shear modulus G = E / (2 (1 + ν)) \[Pa\].
    pub fn shear(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }

    /// Plane strain modulus E / (1 − ν²) \[Pa\], the contact modulus against a rigid counterbody.
    pub fn plane_strain_modulus(&self) -> f64 {
        self.young / ((1.0 - self.poisson) * (1.0 + self.poisson))
    }
}

value! {
    Elastic by ElasticData { young: f64 = of.young(); poisson: f64 = of.poisson(); }
    of, fields => Self::new(fields.young, fields.poisson)
}
