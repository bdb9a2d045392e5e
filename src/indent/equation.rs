//! The integral equation of a contact: response of the bodies, functions on the contact, linear system.

use crate::error::{Error, Result};
use crate::numerics::roots;

pub(super) mod basis;
pub(super) mod stack;
pub(super) mod system;
pub(super) mod waves;

/// The root of `f` in a bracket.
///
/// # Errors
/// Errors of `f`, and equal signs at both ends.
pub(super) fn bracketed(f: impl FnMut(f64) -> Result<f64>, bracket: [f64; 2]) -> Result<f64> {
    roots::bracketed(f, bracket)?.ok_or(Error::Inconsistent(
        "no state of this kind exists within the radii that can be computed",
    ))
}
