//! Closed-form solutions on a homogeneous half-space, for documentation, tests and scales.
//!
//! E* is the contact modulus, with 1/E* = Σ (1−ν²)/E over both bodies. All solutions are from
//! K. L. Johnson, Contact Mechanics, Cambridge University Press (1985), doi:10.1017/CBO9781139171731.

use std::f64::consts::PI;

use crate::error::{Result, positive};

/// Contact of a paraboloid of revolution. Johnson (1985), eqs (4.22)–(4.24).
///
/// ```
/// let contact = nacre::hertz::Point::new(5e-3, 115e9, 10.0)?;
/// // W = 2/3 π a² p0
/// let load = 2.0 / 3.0 * std::f64::consts::PI * contact.radius.powi(2) * contact.peak_pressure;
/// assert!((load / 10.0 - 1.0).abs() < 1e-14);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Contact radius a = (3WR/4E*)^{1/3} \[m\].
    pub radius: f64,
    /// Peak pressure p0 = 3W/2πa² \[Pa\].
    pub peak_pressure: f64,
    /// Approach δ = a²/R \[m\].
    pub approach: f64,
}

impl Point {
    /// The contact for a radius of curvature `radius` \[m\], a `contact_modulus` E* \[Pa\] and a
    /// `load` \[N\].
    ///
    /// # Errors
    /// Unless all are finite and above 0.
    pub fn new(radius: f64, contact_modulus: f64, load: f64) -> Result<Self> {
        positive("radius", radius)?;
        positive("contact_modulus", contact_modulus)?;
        positive("load", load)?;
        let a = (0.75 * load * radius / contact_modulus).cbrt();
        Ok(Self {
            radius: a,
            peak_pressure: 1.5 * load / (PI * a * a),
            approach: a * a / radius,
        })
    }

    /// Pressure at distance `r` from the axis \[Pa\]: p0 √(1 − r²/a²), 0 outside.
    pub fn pressure(&self, r: f64) -> f64 {
        self.peak_pressure * (1.0 - (r / self.radius).powi(2)).max(0.0).sqrt()
    }
}

/// Contact of a cylinder, per unit length. Johnson (1985), eqs (4.43)–(4.45).
///
/// ```
/// let contact = nacre::hertz::Line::new(5e-3, 115e9, 1e5)?;
/// // W' = π/2 b p0
/// let load = std::f64::consts::FRAC_PI_2 * contact.half_width * contact.peak_pressure;
/// assert!((load / 1e5 - 1.0).abs() < 1e-14);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Half-width b = √(4W'R/πE*) \[m\].
    pub half_width: f64,
    /// Peak pressure p0 = 2W'/πb \[Pa\].
    pub peak_pressure: f64,
}

impl Line {
    /// The contact for a `radius` \[m\], a `contact_modulus` E* \[Pa\] and a `line_load` W'
    /// \[N/m\].
    ///
    /// # Errors
    /// Unless all are finite and above 0.
    pub fn new(radius: f64, contact_modulus: f64, line_load: f64) -> Result<Self> {
        positive("radius", radius)?;
        positive("contact_modulus", contact_modulus)?;
        positive("line_load", line_load)?;
        let b = (4.0 * line_load * radius / (PI * contact_modulus)).sqrt();
        Ok(Self {
            half_width: b,
            peak_pressure: 2.0 * line_load / (PI * b),
        })
    }
}

/// Approach \[m\] and tilt of a rigid flat circular punch of `radius` a \[m\] under a `load` W \[N\]
/// whose first moment about the axis is `moment` M \[N m\].
///
/// ```text
/// δ = W / (2 E* a)        s = 3 M / (4 E* a³)
/// ```
///
/// Valid for |M| ≤ W a/3, where the whole face is in contact. Johnson (1985), eqs (3.36) and (3.37)
/// and §5.6.
///
/// # Errors
/// Unless radius, modulus and load are finite and above 0.
pub fn flat_punch(radius: f64, contact_modulus: f64, load: f64, moment: f64) -> Result<(f64, f64)> {
    positive("radius", radius)?;
    positive("contact_modulus", contact_modulus)?;
    positive("load", load)?;
    let approach = load / (2.0 * contact_modulus * radius);
    Ok((approach, 0.75 * moment / (contact_modulus * radius.powi(3))))
}
