//! Friction: steps of `nacre.slide` and `nacre.roll`, their solutions, and `nacre.creep_coefficients`.

mod creep;
mod solved;
mod steps;

pub(in crate::python) use creep::creep_coefficients;
pub(in crate::python) use solved::PyFrictionSolved;
pub(super) use solved::solved;
pub(in crate::python) use steps::{PyFrictionSteps, roll, slide};
