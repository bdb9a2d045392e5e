//! The curved surface that a shape is pressed on: a raceway, a groove or a socket.

use crate::error::{Error, Result};
use crate::model::hertz::equivalent_radius;

/// Surface of the body that a shape is pressed on: a piece of a torus, of which every section along x and
/// the section y = 0 are circles. It touches the plane z = 0 at the origin.
///
/// ```text
/// d(x)    = R_x − √(R_x² − x²)                  in the section y = 0
/// h(x, y) = R_y − √((R_y − d(x))² − y²)
/// ```
///
/// A radius is above 0 where the counterpart is convex, below 0 where it is concave, and `None` where it
/// is straight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Counterpart {
    radii: [Option<f64>; 2],
}

impl Counterpart {
    /// A counterpart with `radii` along x and y \[m\] under a shape with the convex radii `shape`.
    ///
    /// # Errors
    /// Unless each radius is finite and, with that of the shape, gives an equivalent radius above 0.
    pub(super) fn new(
        names: [&'static str; 2],
        radii: [Option<f64>; 2],
        shape: [f64; 2],
    ) -> Result<Self> {
        for ((name, counter), own) in names.into_iter().zip(radii).zip(shape) {
            if let Some(value) = counter
                && equivalent_radius(Some(own), counter).is_err()
            {
                return Err(Error::Parameter {
                    name,
                    requirement: "finite, and above 0 (convex) or below minus the radius of the \
                                  shape (a concave raceway or groove is wider than the shape)",
                    value,
                });
            }
        }
        Ok(Self { radii })
    }

    /// A counterpart that is straight along x.
    ///
    /// # Errors
    /// As [`Counterpart::new`].
    pub(super) fn cylindrical(counter_radius: f64, shape: f64) -> Result<Self> {
        let names = ["counter_radius"; 2];
        Self::new(names, [None, Some(counter_radius)], [shape; 2])
    }

    /// Radii along x and y \[m\].
    pub(super) fn radii(&self) -> [Option<f64>; 2] {
        self.radii
    }

    /// Equivalent radii \[m\] of a shape with the radii `shape` on this counterpart.
    pub(super) fn equivalent(&self, shape: [f64; 2]) -> [f64; 2] {
        [0, 1].map(
            |axis| match equivalent_radius(Some(shape[axis]), self.radii[axis]) {
                Ok(radius) => radius,
                Err(_) => unreachable!("the constructor has checked it"),
            },
        )
    }

    /// Smaller of the radii of shape and counterpart along x and y \[m\], without their signs.
    pub(super) fn smaller(&self, shape: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| self.radii[axis].map_or(shape[axis], |r| shape[axis].min(r.abs())))
    }

    /// Half-widths \[m\] along x and y of a shape with the half-widths `shape`, as far as a convex
    /// counterpart reaches.
    pub(super) fn reach(&self, shape: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| match self.radii[axis] {
            Some(radius) if radius > 0.0 => shape[axis].min(radius),
            _ => shape[axis],
        })
    }

    /// Distance \[m\] of this surface from the plane z = 0 at (x, y), below 0 where it rises beside a
    /// concave origin, and +∞ beyond its end.
    pub(super) fn gap(&self, x: f64, y: f64) -> f64 {
        let drop = self.radii[0].map_or(0.0, |radius| arc(radius, x * x));
        let Some(radius) = self.radii[1] else {
            return drop;
        };
        let local = radius - drop;
        if drop.is_infinite() || local * radius <= 0.0 {
            return f64::INFINITY;
        }
        drop + arc(local, y * y)
    }
}

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

/// R − √(R² − s) with the sign of R, and +∞ where s > R².
fn arc(radius: f64, s: f64) -> f64 {
    let depth = sagitta(radius.abs(), s);
    if depth.is_infinite() {
        depth
    } else {
        depth.copysign(radius)
    }
}
