//! `nacre.Sphere`, `nacre.Paraboloid`, `nacre.Cylinder` and `nacre.FlatPunch`.

use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::base::{Kind, PyShape, held, numbers, object};
use crate::surface::{Cylinder, FlatPunch, Paraboloid, Sphere};

/// A sphere: ``h = R - sqrt(R**2 - r**2)``, +inf beyond R.
///
/// Parameters
/// ----------
/// radius : float
///     Radius [m], above 0.
///
/// Raises
/// ------
/// ValueError
///     If the radius is not finite and above 0.
///
/// Examples
/// --------
/// >>> nacre.Sphere(radius=5e-3)
/// Sphere(radius=0.005)
#[pyclass(name = "Sphere", module = "nacre", frozen, extends = PyShape)]
pub(super) struct PySphere;

impl Kind for Sphere {
    type Class = PySphere;

    fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        numbers(py, [("radius", self.radius())])
    }
}

#[pymethods]
impl PySphere {
    #[new]
    fn new(radius: f64) -> PyResult<PyClassInitializer<Self>> {
        Ok(object(Self, Sphere::new(radius)?))
    }

    /// Radius [m].
    #[getter]
    fn radius(slf: &Bound<'_, Self>) -> f64 {
        held::<_, Sphere>(slf).radius()
    }
}

/// An elliptic paraboloid: ``h = x**2/(2 R_x) + y**2/(2 R_y)``.
///
/// Parameters
/// ----------
/// radius_x, radius_y : float
///     Radii of curvature at the apex [m], above 0.
///
/// Raises
/// ------
/// ValueError
///     If a radius is not finite and above 0.
///
/// Examples
/// --------
/// >>> nacre.Paraboloid(5e-3, 5e-3)
/// Paraboloid(radius_x=0.005, radius_y=0.005)
#[pyclass(name = "Paraboloid", module = "nacre", frozen, extends = PyShape)]
pub(super) struct PyParaboloid;

impl Kind for Paraboloid {
    type Class = PyParaboloid;

    fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let radii = [("radius_x", self.radius_x()), ("radius_y", self.radius_y())];
        numbers(py, radii)
    }
}

#[pymethods]
impl PyParaboloid {
    #[new]
    fn new(radius_x: f64, radius_y: f64) -> PyResult<PyClassInitializer<Self>> {
        Ok(object(Self, Paraboloid::new(radius_x, radius_y)?))
    }

    /// Radius of curvature along x [m].
    #[getter]
    fn radius_x(slf: &Bound<'_, Self>) -> f64 {
        held::<_, Paraboloid>(slf).radius_x()
    }

    /// Radius of curvature along y [m].
    #[getter]
    fn radius_y(slf: &Bound<'_, Self>) -> f64 {
        held::<_, Paraboloid>(slf).radius_y()
    }
}

/// An endless cylinder, axis along x: ``h = R - sqrt(R**2 - y**2)``, +inf beyond R.
///
/// The contact is as long as the grid, which must be given.
///
/// Parameters
/// ----------
/// radius : float
///     Radius [m], above 0.
///
/// Raises
/// ------
/// ValueError
///     If the radius is not finite and above 0.
///
/// Examples
/// --------
/// >>> nacre.Cylinder(radius=5e-3)
/// Cylinder(radius=0.005)
#[pyclass(name = "Cylinder", module = "nacre", frozen, extends = PyShape)]
pub(super) struct PyCylinder;

impl Kind for Cylinder {
    type Class = PyCylinder;

    fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        numbers(py, [("radius", self.radius())])
    }
}

#[pymethods]
impl PyCylinder {
    #[new]
    fn new(radius: f64) -> PyResult<PyClassInitializer<Self>> {
        Ok(object(Self, Cylinder::new(radius)?))
    }

    /// Radius [m].
    #[getter]
    fn radius(slf: &Bound<'_, Self>) -> f64 {
        held::<_, Cylinder>(slf).radius()
    }
}

/// A flat circular punch: ``h = 0`` for ``r <= a``, +inf beyond.
///
/// Parameters
/// ----------
/// radius : float
///     Radius a [m], above 0.
///
/// Raises
/// ------
/// ValueError
///     If the radius is not finite and above 0.
///
/// Examples
/// --------
/// >>> nacre.FlatPunch(radius=1e-3)
/// FlatPunch(radius=0.001)
#[pyclass(name = "FlatPunch", module = "nacre", frozen, extends = PyShape)]
pub(super) struct PyFlatPunch;

impl Kind for FlatPunch {
    type Class = PyFlatPunch;

    fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        numbers(py, [("radius", self.radius())])
    }
}

#[pymethods]
impl PyFlatPunch {
    #[new]
    fn new(radius: f64) -> PyResult<PyClassInitializer<Self>> {
        Ok(object(Self, FlatPunch::new(radius)?))
    }

    /// Radius [m].
    #[getter]
    fn radius(slf: &Bound<'_, Self>) -> f64 {
        held::<_, FlatPunch>(slf).radius()
    }
}
