//! The traction of friction.

use super::options::StressOptions;
use crate::body::{HalfSpace, Interface, Layer};
use crate::error::{Error, Result, finite};

/// μ times the unit vector of the traction on `body`, whose direction is `sign` times that of the
/// options: −1 for a counterbody.
///
/// # Errors
/// A negative or infinite μ, a direction without length, or friction on a body with a frictionless
/// interface.
pub(super) fn friction(body: &HalfSpace, sign: f64, options: &StressOptions) -> Result<[f64; 2]> {
    let friction = finite("friction", options.friction)?;
    if friction < 0.0 {
        return Err(Error::Parameter {
            name: "friction",
            requirement: "at least 0 (turn the direction)",
            value: friction,
        });
    }
    let [x, y] = options.direction.map(|component| sign * component);
    let length = x.hypot(y);
    if !(length > 0.0 && length.is_finite()) {
        return Err(Error::Parameter {
            name: "direction",
            requirement: "a vector of finite length above 0",
            value: length,
        });
    }
    let slips = |layer: &Layer| layer.interface() == Interface::Frictionless;
    if friction > 0.0 && body.layers().iter().any(slips) {
        return Err(Error::Inconsistent(
            "friction must be 0 on a body with a frictionless interface: nothing holds the layers \
             above it against the traction",
        ));
    }
    Ok([friction * x / length, friction * y / length])
}
