//! Stress and displacement at some depths, as a value.

use ndarray::{Array1, Array3};

use super::options::Side;
use crate::body::HalfSpace;
use crate::error::{Error, Result, finite};

/// Stress at some depths. Arrays are (depths, nx, ny); on a section nx or ny is 1. Tension is
/// positive.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Stress {
    /// Depths z \[m\].
    pub z: Array1<f64>,
    /// Coordinates x \[m\].
    pub x: Array1<f64>,
    /// Coordinates y \[m\].
    pub y: Array1<f64>,
    /// The body.
    pub body: HalfSpace,
    /// Side on which depths at an interface were evaluated.
    pub side: Side,
    /// μ times the unit vector of the traction that acts on the body.
    pub friction: [f64; 2],
    /// σ_xx, σ_yy, σ_zz, σ_xy, σ_yz, σ_xz \[Pa\], in this order.
    pub components: [Array3<f64>; 6],
    /// Displacements u_x, u_y, u_z \[m\], if they were asked for. In line contact they are relative to
    /// the substrate's surface at a distance of the grid's width, as all displacements there.
    pub displacement: Option<[Array3<f64>; 3]>,
}

impl Stress {
    /// A stress field from coordinates and fields of shape (depths, nx, ny).
    ///
    /// # Errors
    /// A field whose shape is not that of its coordinates, and a coordinate that is not finite.
    pub fn from_fields(
        [z, x, y]: [Array1<f64>; 3],
        body: HalfSpace,
        side: Side,
        friction: [f64; 2],
        components: [Array3<f64>; 6],
        displacement: Option<[Array3<f64>; 3]>,
    ) -> Result<Self> {
        let shape = (z.len(), x.len(), y.len());
        let mut fields = components.iter().chain(displacement.iter().flatten());
        if fields.any(|field| field.dim() != shape) {
            return Err(Error::Inconsistent(
                "every component must have shape (len(z), len(x), len(y))",
            ));
        }
        for coordinate in [&z, &x, &y].into_iter().flatten() {
            finite("coordinates of a stress", *coordinate)?;
        }
        Ok(Self {
            z,
            x,
            y,
            body,
            side,
            friction,
            components,
            displacement,
        })
    }
}
