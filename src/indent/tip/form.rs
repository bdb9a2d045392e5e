//! Forms of tips and their numbers.

use crate::error::{Error, Result, positive};

/// Steepest slope of a cone, of a half angle of 11°. The theory is that of small slopes, and errs by their square: there is no such tip
/// above, and the number is a half angle, in degrees or radians.
pub const STEEPEST: f64 = 5.0;

/// Form of a tip: its profile g(r) is the gap of the undeformed bodies, and g(0) = 0. Lengths in \[m\].
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Form {
    /// A flat end of this radius, with a sharp edge.
    FlatPunch {
        /// Radius of the end, which is that of the contact.
        radius: f64,
    },
    /// g = r²/2R.
    Paraboloid {
        /// Radius of curvature R.
        radius: f64,
    },
    /// g = R − √(R² − r²).
    Sphere {
        /// Radius R.
        radius: f64,
    },
    /// g = m r.
    Cone {
        /// Slope m of the flanks against the surface: cot of the half angle.
        slope: f64,
    },
    /// g = b rⁿ.
    Power {
        /// Factor b \[m^(1−n)\].
        factor: f64,
        /// Exponent n.
        exponent: f64,
    },
    /// A cone with a spherical end: a paraboloid up to where both have the same slope.
    RoundedCone {
        /// Slope of the flanks.
        slope: f64,
        /// Radius of curvature of the end.
        radius: f64,
    },
    /// A flat end with a rounded edge: g = (r − b)²/2R beyond b.
    RoundedPunch {
        /// Radius b of the flat end.
        flat: f64,
        /// Radius of curvature R of the edge.
        radius: f64,
    },
    /// A cone whose end is cut off: g = m (r − b) beyond b.
    FlatCone {
        /// Radius b of the flat end.
        flat: f64,
        /// Slope m of the flanks.
        slope: f64,
    },
    /// Samples g(r), from the axis on.
    Profile {
        /// Distances from the axis, ascending from 0.
        radii: Vec<f64>,
        /// Heights g, from 0 on.
        heights: Vec<f64>,
    },
    /// A tip whose section at the distance d from its end has the area Σ C_k d^(2^(1−k)).
    Area {
        /// Coefficients C_0, C_1, …
        coefficients: Vec<f64>,
        /// Deepest distance from the end up to which the function holds.
        depth: f64,
    },
}

impl Form {
    /// Names and values of the numbers, in the order in which they are written.
    pub(super) fn numbers(&self) -> Vec<(&'static str, f64)> {
        match self {
            Self::FlatPunch { radius } | Self::Paraboloid { radius } | Self::Sphere { radius } => {
                vec![("radius", *radius)]
            }
            Self::Cone { slope } => vec![("slope", *slope)],
            Self::Power { factor, exponent } => {
                vec![("factor", *factor), ("exponent", *exponent)]
            }
            Self::RoundedCone { slope, radius } => vec![("slope", *slope), ("radius", *radius)],
            Self::RoundedPunch { flat, radius } => vec![("flat", *flat), ("radius", *radius)],
            Self::FlatCone { flat, slope } => vec![("flat", *flat), ("slope", *slope)],
            Self::Profile { .. } => vec![],
            Self::Area { depth, .. } => vec![("depth", *depth)],
        }
    }

    /// An error unless the numbers are those of a tip, in any unit.
    pub(super) fn check(&self) -> Result<()> {
        for (name, value) in self.numbers() {
            let (range, requirement) = match name {
                "slope" => (
                    0.0..=STEEPEST,
                    "above 0 and at most 5, a half angle of 11 degrees; half_angle= takes an angle in radians",
                ),
                "exponent" => (0.01..=100.0, "between 0.01 and 100"),
                "factor" => (0.0..=f64::MAX, "finite and above 0"),
                _ => (1e-100..=1e100, "between 1e-100 and 1e100"),
            };
            positive(name, value)?;
            if !range.contains(&value) {
                return Err(Error::Parameter {
                    name,
                    requirement,
                    value,
                });
            }
        }
        Ok(())
    }
}
