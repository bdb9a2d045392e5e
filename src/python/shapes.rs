//! Shapes: `nacre.Shape`, its kinds, and the profiles of rollers.

use pyo3::prelude::*;

mod base;
mod height_map;
mod profiles;
mod quadric;
mod roller;

pub(super) use base::{PyShape, Shape, shape};
pub(super) use profiles::{PyLogarithmicProfile, PySampledProfile};

/// Adds the classes of shapes to the module.
pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PyShape>()?;
    quadric::register(module)?;
    module.add_class::<roller::PyRoller>()?;
    module.add_class::<height_map::PyHeightMap>()
}
