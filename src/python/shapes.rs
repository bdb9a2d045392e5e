//! Shapes: `nacre.Shape`, its kinds, and the profiles of rollers.

mod base;
mod height_map;
mod profiles;
mod quadric;
mod roller;

pub(super) use base::{PyShape, Shape, register, shape};
pub(super) use profiles::{PyLogarithmicProfile, PySampledProfile};
