//! Closed-form solutions on a homogeneous half-space, for documentation, tests and scales.
//!
//! E* is the contact modulus, with 1/E* = Σ (1−ν²)/E over both bodies. All solutions are from
//! K. L. Johnson, Contact Mechanics, Cambridge University Press (1985), doi:10.1017/CBO9781139171731.

use std::f64::consts::PI;

use crate::error::{Error, Result, finite, positive};
use crate::model::material::Elastic;

mod ellipse;
mod shear;

pub use ellipse::Ellipse;
pub use shear::Shear;

/// Equivalent radius R \[m\] of two surfaces in contact, in one direction.
///
/// ```text
/// 1/R = 1/R_1 + 1/R_2
/// ```
///
/// `radius` and `counter_radius` \[m\] are above 0 where the surface is convex, below 0 where it is
/// concave (a raceway, a groove), and `None` where it is straight.
///
/// # Errors
/// Unless each radius is finite and not 0, and 1/R is above 0.
///
/// ```
/// use nacre::hertz::equivalent_radius;
/// // A roller of 5 mm in a raceway of 30 mm.
/// assert!((equivalent_radius(Some(5e-3), Some(-30e-3))? / 6e-3 - 1.0).abs() < 1e-14);
/// assert_eq!(equivalent_radius(Some(5e-3), None)?, 5e-3);
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn equivalent_radius(radius: Option<f64>, counter_radius: Option<f64>) -> Result<f64> {
    for (name, given) in [("radius", radius), ("counter_radius", counter_radius)] {
        if let Some(value) = given
            && finite(name, value)?.abs() <= 0.0
        {
            return Err(Error::Parameter {
                name,
                requirement: "other than 0 (None for a straight surface)",
                value,
            });
        }
    }
    let equivalent = match (radius, counter_radius) {
        // Below 0 where both are concave, or the wider one is the convex one.
        (Some(one), Some(two)) => one * (two / (one + two)),
        (Some(one), None) | (None, Some(one)) => one,
        (None, None) => f64::INFINITY,
    };
    if equivalent > 0.0 && equivalent.is_finite() {
        return Ok(equivalent);
    }
    Err(Error::Inconsistent(
        "radius and counter_radius must be convex together: 1/radius + 1/counter_radius must be above 0",
    ))
}

/// Contact modulus E* \[Pa\] of two bodies; without a counterbody that of `body` on a rigid one.
///
/// ```text
/// 1/E* = (1 − ν_1²)/E_1 + (1 − ν_2²)/E_2
/// ```
///
/// ```
/// let steel = nacre::Elastic::new(210e9, 0.3)?;
/// let both = nacre::hertz::contact_modulus(&steel, Some(&steel));
/// assert!((both / 115.385e9 - 1.0).abs() < 1e-5);
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn contact_modulus(body: &Elastic, counterbody: Option<&Elastic>) -> f64 {
    let counter = counterbody.map_or(0.0, |other| 1.0 / other.plane_strain_modulus());
    1.0 / (1.0 / body.plane_strain_modulus() + counter)
}

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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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

    /// Largest shear stress on the axis of a body of Poisson's ratio `poisson`: for 0.3 it is 0.310 p0 at
    /// the depth 0.48 a.
    ///
    /// # Errors
    /// Unless −1 < `poisson` ≤ 0.5.
    pub fn max_shear(&self, poisson: f64) -> Result<Shear> {
        shear::below_ellipse([self.radius; 2], self.peak_pressure, poisson)
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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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

    /// Pressure at distance `y` from the middle \[Pa\]: p0 √(1 − y²/b²), 0 outside.
    pub fn pressure(&self, y: f64) -> f64 {
        self.peak_pressure * (1.0 - (y / self.half_width).powi(2)).max(0.0).sqrt()
    }

    /// Largest shear stress below the middle, in a body of Poisson's ratio `poisson`: 0.300 p0 at the
    /// depth 0.786 b, unless `poisson` is below 0.2.
    ///
    /// # Errors
    /// Unless −1 < `poisson` ≤ 0.5.
    pub fn max_shear(&self, poisson: f64) -> Result<Shear> {
        shear::below_line(self.half_width, self.peak_pressure, poisson)
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
