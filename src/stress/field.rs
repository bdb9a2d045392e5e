//! Stress and displacement at some depths, as a value.

use std::fmt;

use ndarray::{Array1, Array3, Axis};

use super::options::Side;
use crate::error::{Error, Result, finite};
use crate::model::body::HalfSpace;

/// Stress at some depths. Arrays are (depths, nx, ny); on a section nx or ny is 1. Tension is
/// positive. Beyond a free end of the body, values are NaN; equal stresses have NaN at the same places.
#[derive(Debug, Clone)]
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
    /// σ_xx, σ_yy, σ_zz, σ_xy, σ_yz, σ_xz \[Pa\], in this order; [`Stress::xx`] to [`Stress::xz`] name
    /// them.
    pub components: [Array3<f64>; 6],
    /// Estimated error of the components at each depth \[Pa\], due to the size of the cells; the errors of
    /// the pressure itself add to it. `None` where the pressure is not that of a solved contact, but
    /// given as uniform over cells.
    ///
    /// It belongs to the worst place of a depth, of those that were evaluated: at the edge of the contact as
    /// a rule. Where it is not small compared with the stress, the cells do not resolve the depth, or the
    /// layer: take smaller cells. Tractions at the surface are those of the cells.
    pub uncertainty: Option<Array1<f64>>,
    /// Displacements u_x, u_y, u_z \[m\], if they were asked for. In line contact they are relative to
    /// the substrate's surface at a distance of the grid's width, as all displacements there.
    pub displacement: Option<[Array3<f64>; 3]>,
}

impl PartialEq for Stress {
    fn eq(&self, other: &Self) -> bool {
        let same = |(a, b): (&f64, &f64)| a == b || a.is_nan() && b.is_nan();
        (&self.z, &self.x, &self.y) == (&other.z, &other.x, &other.y)
            && (&self.body, self.side, self.friction) == (&other.body, other.side, other.friction)
            && self.displacement.is_some() == other.displacement.is_some()
            && self.uncertainty.is_some() == other.uncertainty.is_some()
            && self.values().zip(other.values()).all(same)
    }
}

/// Estimated error over the largest stress of a depth above which a warning says so. The estimate is some
/// three times the error (`tests/stress/resolution.rs`).
const UNRESOLVED: f64 = 0.05;

/// A ratio in per cent, for messages.
pub(super) struct Percent(pub(super) f64);

impl fmt::Display for Percent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            ratio if ratio < 1.0 => write!(f, "{:.0} %", 100.0 * ratio),
            _ => write!(f, "more than 100 %"),
        }
    }
}

impl Stress {
    /// All values, in an order that coordinates and optional fields determine.
    fn values(&self) -> impl Iterator<Item = &f64> {
        let displacement = self.displacement.iter().flatten();
        let fields = self.components.iter().chain(displacement).flatten();
        fields.chain(self.uncertainty.iter().flatten())
    }

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
        uncertainty: Option<Array1<f64>>,
    ) -> Result<Self> {
        let shape = (z.len(), x.len(), y.len());
        let mut fields = components.iter().chain(displacement.iter().flatten());
        if fields.any(|field| field.dim() != shape) {
            return Err(Error::Inconsistent(
                "every component must have shape (len(z), len(x), len(y))",
            ));
        }
        if uncertainty
            .as_ref()
            .is_some_and(|errors| errors.len() != z.len())
        {
            return Err(Error::Inconsistent(
                "uncertainty must have a value for each depth",
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
            uncertainty,
            displacement,
        })
    }

    /// Warnings about what the cells do not resolve, the depth at which the estimated error is largest
    /// compared with the largest stress there, if it is above a twentieth of it; and about friction at free ends.
    pub fn warnings(&self) -> Vec<String> {
        let errors = self.uncertainty.iter().flatten();
        let ratio = |(k, error): (usize, &f64)| {
            let largest = |field: &Array3<f64>| {
                let here = field.index_axis(Axis(0), k);
                here.fold(0.0_f64, |m, s| m.max(s.abs()))
            };
            let largest = self.components.iter().map(largest).fold(0.0, f64::max);
            (k, error / largest)
        };
        let worst = errors
            .enumerate()
            .map(ratio)
            .filter(|(_, ratio)| *ratio > UNRESOLVED)
            .max_by(|a, b| a.1.total_cmp(&b.1));
        let said = |(k, ratio): (usize, f64)| {
            format!(
                "at depth {:e} the stress is uncertain by {} of the largest there, due to the size of \
                 the cells: take smaller cells",
                self.z[k],
                Percent(ratio)
            )
        };
        let slides = self.friction.iter().any(|part| *part != 0.0);
        let ends = (slides && self.body.ends() != [None; 2]).then(|| {
            "the stress of the friction is that of a body that goes on past its free ends"
                .to_owned()
        });
        worst.map(said).into_iter().chain(ends).collect()
    }

    /// Normal stress σ_xx \[Pa\].
    pub fn xx(&self) -> &Array3<f64> {
        &self.components[0]
    }

    /// Normal stress σ_yy \[Pa\].
    pub fn yy(&self) -> &Array3<f64> {
        &self.components[1]
    }

    /// Normal stress σ_zz, minus the pressure at the surface \[Pa\].
    pub fn zz(&self) -> &Array3<f64> {
        &self.components[2]
    }

    /// Shear stress σ_xy, in the plane of the surface \[Pa\].
    pub fn xy(&self) -> &Array3<f64> {
        &self.components[3]
    }

    /// Shear stress σ_yz, along y on planes z = const \[Pa\].
    pub fn yz(&self) -> &Array3<f64> {
        &self.components[4]
    }

    /// Shear stress σ_xz, along x on planes z = const \[Pa\].
    pub fn xz(&self) -> &Array3<f64> {
        &self.components[5]
    }

    /// Displacement u_x along x \[m\], if it was asked for.
    pub fn ux(&self) -> Option<&Array3<f64>> {
        self.displacement.as_ref().map(|fields| &fields[0])
    }

    /// Displacement u_y along y \[m\], if it was asked for.
    pub fn uy(&self) -> Option<&Array3<f64>> {
        self.displacement.as_ref().map(|fields| &fields[1])
    }

    /// Displacement u_z into the body \[m\], if it was asked for.
    pub fn uz(&self) -> Option<&Array3<f64>> {
        self.displacement.as_ref().map(|fields| &fields[2])
    }
}
