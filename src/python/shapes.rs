//! Shapes: `nacre.Shape`, its kinds, the profiles of rollers.

mod base;
mod height_map;
mod logarithmic;
mod profiles;
mod quadric;
mod roller;
mod surface;

pub(super) use base::{Shape, register, shape};
pub(super) use logarithmic::PyLogarithmicProfile;
pub(super) use profiles::PySampledProfile;
