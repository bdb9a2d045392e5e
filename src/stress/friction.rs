//! The traction of friction.

use super::options::StressOptions;
use crate::error::{Error, Result, finite};
use crate::model::body::{HalfSpace, Interface, Layer};

/// How one body of a contact slides on the other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sliding {
    /// 1, or −1 for a counterbody, on which the traction acts the other way.
    pub(super) sign: f64,
    /// Direction of the traction where the options have none.
    pub(super) direction: Option<[f64; 2]>,
    /// Whether the tractions of the contact are known, and no others may be added.
    pub(super) is_known: bool,
}

impl Sliding {
    /// μ times the unit vector of the traction on `body`.
    ///
    /// # Errors
    /// A negative or infinite μ, a direction without length, friction without a direction, or friction on
    /// a body with a frictionless interface.
    pub(super) fn traction(&self, body: &HalfSpace, options: &StressOptions) -> Result<[f64; 2]> {
        let friction = finite("friction", options.friction)?;
        if friction < 0.0 {
            return Err(Error::Parameter {
                name: "friction",
                requirement: "at least 0 (turn the direction)",
                value: friction,
            });
        }
        if friction > 1e100 {
            return Err(Error::Parameter {
                name: "friction",
                requirement: "at most 1e100",
                value: friction,
            });
        }
        let given = options.direction.map(check_direction).transpose()?;
        if friction <= 0.0 {
            return Ok([0.0; 2]);
        }
        if self.is_known {
            return Err(Error::Inconsistent(
                "friction must be 0: the tractions of this contact are known, and their stress is part of the result",
            ));
        }
        let slips = |layer: &Layer| layer.interface() == Interface::Frictionless;
        if body.layers().iter().any(slips) {
            return Err(Error::Inconsistent(
                "friction must be 0 on a body with a frictionless interface: nothing holds the layers \
                 above it against the traction",
            ));
        }
        let [x, y] = given.or(self.direction).ok_or(Error::Inconsistent(
            "direction must be given where friction is above 0: only rollers, cylinders and line \
             contacts have a rolling direction to take instead; (1, 0) is along x",
        ))?;
        let length = x.hypot(y);
        Ok([x, y].map(|component| friction * (self.sign * component) / length))
    }
}

/// `direction`, if it has a finite length above 0.
fn check_direction(direction @ [x, y]: [f64; 2]) -> Result<[f64; 2]> {
    let length = x.hypot(y);
    if length > 0.0 && length.is_finite() {
        return Ok(direction);
    }
    Err(Error::Parameter {
        name: "direction",
        requirement: "a vector of finite length above 0",
        value: length,
    })
}
