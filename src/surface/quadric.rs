//! Spheres, paraboloids, cylinders and flat punches.

use super::{Extent, Surface};
use crate::error::{Result, positive};

/// Rolling direction of a shape whose axis lies along x.
pub(super) const ACROSS: [f64; 2] = [0.0, 1.0];

/// R − √(R² − s), computed without cancellation; +∞ where s > R².
///
/// ```text
/// R − √(R² − s) = s / (R + √(R² − s))
/// ```
pub(super) fn sagitta(radius: f64, s: f64) -> f64 {
    let under = radius * radius - s;
    if under < 0.0 {
        f64::INFINITY
    } else {
        s / (radius + under.sqrt())
    }
}

/// A sphere: h = R − √(R² − r²), and +∞ for r > R.
///
/// ```
/// use nacre::{Sphere, Surface};
/// assert_eq!(Sphere::new(5.0)?.gap(3.0, 0.0), 1.0);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    radius: f64,
}

impl Sphere {
    /// A sphere of `radius` \[m\].
    ///
    /// # Errors
    /// Unless `radius` is finite and above 0.
    pub fn new(radius: f64) -> Result<Self> {
        Ok(Self {
            radius: positive("radius", radius)?,
        })
    }

    /// Radius of the sphere \[m\].
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

impl Surface for Sphere {
    fn gap(&self, x: f64, y: f64) -> f64 {
        sagitta(self.radius, x * x + y * y)
    }

    fn extent(&self) -> [Extent; 2] {
        [Extent::Within([-self.radius, self.radius]); 2]
    }

    fn radii(&self) -> [f64; 2] {
        [self.radius; 2]
    }
}

/// An elliptic paraboloid: h = x²/2R_x + y²/2R_y.
///
/// ```
/// use nacre::{Paraboloid, Surface};
/// assert_eq!(Paraboloid::new(2.0, 1.0)?.gap(2.0, 1.0), 1.5);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paraboloid {
    radius_x: f64,
    radius_y: f64,
}

impl Paraboloid {
    /// A paraboloid of radii of curvature `radius_x` and `radius_y` \[m\] at its apex.
    ///
    /// # Errors
    /// Unless both radii are finite and above 0.
    pub fn new(radius_x: f64, radius_y: f64) -> Result<Self> {
        Ok(Self {
            radius_x: positive("radius_x", radius_x)?,
            radius_y: positive("radius_y", radius_y)?,
        })
    }

    /// Radius of curvature along x \[m\].
    pub fn radius_x(&self) -> f64 {
        self.radius_x
    }

    /// Radius of curvature along y \[m\].
    pub fn radius_y(&self) -> f64 {
        self.radius_y
    }
}

impl Surface for Paraboloid {
    fn gap(&self, x: f64, y: f64) -> f64 {
        x * x / (2.0 * self.radius_x) + y * y / (2.0 * self.radius_y)
    }

    fn radii(&self) -> [f64; 2] {
        [self.radius_x, self.radius_y]
    }
}

/// A cylinder of infinite length along x: h = R − √(R² − y²), and +∞ for |y| > R.
///
/// ```
/// use nacre::{Cylinder, Surface};
/// assert_eq!(Cylinder::new(5.0)?.gap(7.0, 4.0), 2.0);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cylinder {
    radius: f64,
}

impl Cylinder {
    /// A cylinder of `radius` \[m\].
    ///
    /// # Errors
    /// Unless `radius` is finite and above 0.
    pub fn new(radius: f64) -> Result<Self> {
        Ok(Self {
            radius: positive("radius", radius)?,
        })
    }

    /// Radius of the cylinder \[m\].
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

impl Surface for Cylinder {
    fn gap(&self, _x: f64, y: f64) -> f64 {
        sagitta(self.radius, y * y)
    }

    fn extent(&self) -> [Extent; 2] {
        [Extent::Endless, Extent::Within([-self.radius, self.radius])]
    }

    fn radii(&self) -> [f64; 2] {
        [f64::INFINITY, self.radius]
    }

    fn rolling_direction(&self) -> Option<[f64; 2]> {
        Some(ACROSS)
    }
}

/// A flat circular punch: h = 0 for r ≤ a, and +∞ beyond.
///
/// ```
/// use nacre::{FlatPunch, Surface};
/// let punch = FlatPunch::new(1.0)?;
/// assert_eq!((punch.gap(1.0, 0.0), punch.gap(1.0, 0.1)), (0.0, f64::INFINITY));
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlatPunch {
    radius: f64,
}

impl FlatPunch {
    /// A punch of `radius` a \[m\].
    ///
    /// # Errors
    /// Unless `radius` is finite and above 0.
    pub fn new(radius: f64) -> Result<Self> {
        Ok(Self {
            radius: positive("radius", radius)?,
        })
    }

    /// Radius of the punch \[m\].
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

impl Surface for FlatPunch {
    fn gap(&self, x: f64, y: f64) -> f64 {
        if x * x + y * y <= self.radius * self.radius {
            0.0
        } else {
            f64::INFINITY
        }
    }

    fn extent(&self) -> [Extent; 2] {
        [Extent::Within([-self.radius, self.radius]); 2]
    }
}
