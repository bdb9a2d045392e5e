//! Rollers of finite length.

use super::quadric::sagitta;
use super::{Extent, Surface};
use crate::error::{Error, Result, positive};

/// A crowned roller, axis along x: straight over `flat_length`, rounded beyond with `crown_radius`.
///
/// ```text
/// d(x) = 0                            |x| ≤ L = flat_length / 2
/// d(x) = R_a − √(R_a² − (|x| − L)²)   |x| > L
/// h    = R − √((R − d)² − y²)
/// ```
///
/// +∞ where a root has no value, and beyond |x| = `length` / 2 where a length is given.
/// Spinu et al., The normal contact of finite length coated cylinders, eq. (3).
///
/// ```
/// use nacre::{Roller, Surface};
/// let roller = Roller::new(5e-3, 19.13e-3, 7.5)?.with_length(26e-3)?;
/// assert_eq!(roller.gap(0.0, 3e-3), 1e-3);
/// assert_eq!(roller.gap(14e-3, 0.0), f64::INFINITY);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Roller {
    radius: f64,
    flat_length: f64,
    crown_radius: f64,
    length: Option<f64>,
}

impl Roller {
    /// A roller of `radius` \[m\], straight over `flat_length` \[m\] ≥ 0, with ends rounded to
    /// `crown_radius` \[m\].
    ///
    /// # Errors
    /// Unless the radii are finite and above 0 and the flat length is finite and at least 0.
    pub fn new(radius: f64, flat_length: f64, crown_radius: f64) -> Result<Self> {
        if !(flat_length >= 0.0 && flat_length.is_finite()) {
            return Err(Error::Parameter {
                name: "flat_length",
                requirement: "finite and at least 0",
                value: flat_length,
            });
        }
        Ok(Self {
            radius: positive("radius", radius)?,
            flat_length,
            crown_radius: positive("crown_radius", crown_radius)?,
            length: None,
        })
    }

    /// The same roller, cut off at |x| = `length` / 2 \[m\].
    ///
    /// # Errors
    /// Unless `length` is finite, above 0 and at least the flat length.
    pub fn with_length(self, length: f64) -> Result<Self> {
        positive("length", length)?;
        if length < self.flat_length {
            return Err(Error::Parameter {
                name: "length",
                requirement: "at least flat_length",
                value: length,
            });
        }
        Ok(Self {
            length: Some(length),
            ..self
        })
    }

    /// Its radius \[m\].
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Length of its straight part \[m\].
    pub fn flat_length(&self) -> f64 {
        self.flat_length
    }

    /// Radius of the crown beyond it \[m\].
    pub fn crown_radius(&self) -> f64 {
        self.crown_radius
    }

    /// Its whole length \[m\], where it is cut off.
    pub fn length(&self) -> Option<f64> {
        self.length
    }

    /// Half the length beyond which the gap is +∞ \[m\].
    fn half_length(&self) -> f64 {
        // The crown ends where it has fallen by R, or at a quarter of its circle.
        let (r, ra) = (self.radius, self.crown_radius);
        let crown = if r < ra {
            (r * (2.0 * ra - r)).sqrt()
        } else {
            ra
        };
        let natural = 0.5 * self.flat_length + crown;
        self.length
            .map_or(natural, |length| natural.min(0.5 * length))
    }
}

impl Surface for Roller {
    fn gap(&self, x: f64, y: f64) -> f64 {
        if self.length.is_some_and(|length| x.abs() > 0.5 * length) {
            return f64::INFINITY;
        }
        let beyond = (x.abs() - 0.5 * self.flat_length).max(0.0);
        let drop = sagitta(self.crown_radius, beyond * beyond);
        if drop > self.radius {
            return f64::INFINITY;
        }
        // (R − d)² − y² = R² − (d (2R − d) + y²)
        sagitta(self.radius, drop * (2.0 * self.radius - drop) + y * y)
    }

    fn extent(&self) -> [Extent; 2] {
        let half = self.half_length();
        let x = match self.length {
            Some(_) => Extent::CutOff([-half, half]),
            None => Extent::Within([-half, half]),
        };
        [x, Extent::Within([-self.radius, self.radius])]
    }

    fn radii(&self) -> [f64; 2] {
        [self.crown_radius, self.radius]
    }
}
