//! `nacre.Sphere`, `nacre.Paraboloid`, `nacre.Cylinder` and `nacre.FlatPunch`.

use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::{PyShape, numbers};
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

impl PySphere {
    pub(super) fn arguments<'py>(py: Python<'py>, shape: &Sphere) -> PyResult<Bound<'py, PyDict>> {
        numbers(py, [("radius", shape.radius())])
    }
}

#[pymethods]
impl PySphere {
    #[new]
    fn new(radius: f64) -> PyResult<PyClassInitializer<Self>> {
        Ok(Self::make(Sphere::new(radius)?))
    }

    /// Radius [m].
    #[getter]
    fn radius(slf: &Bound<'_, Self>) -> f64 {
        Self::shape(slf).radius()
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

impl PyParaboloid {
    pub(super) fn arguments<'py>(
        py: Python<'py>,
        shape: &Paraboloid,
    ) -> PyResult<Bound<'py, PyDict>> {
        let radii = [
            ("radius_x", shape.radius_x()),
            ("radius_y", shape.radius_y()),
        ];
        numbers(py, radii)
    }
}

#[pymethods]
impl PyParaboloid {
    #[new]
    fn new(radius_x: f64, radius_y: f64) -> PyResult<PyClassInitializer<Self>> {
        Ok(Self::make(Paraboloid::new(radius_x, radius_y)?))
    }

    /// Radius of curvature along x [m].
    #[getter]
    fn radius_x(slf: &Bound<'_, Self>) -> f64 {
        Self::shape(slf).radius_x()
    }

    /// Radius of curvature along y [m].
    #[getter]
    fn radius_y(slf: &Bound<'_, Self>) -> f64 {
        Self::shape(slf).radius_y()
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

impl PyCylinder {
    pub(super) fn arguments<'py>(
        py: Python<'py>,
        shape: &Cylinder,
    ) -> PyResult<Bound<'py, PyDict>> {
        numbers(py, [("radius", shape.radius())])
    }
}

#[pymethods]
impl PyCylinder {
    #[new]
    fn new(radius: f64) -> PyResult<PyClassInitializer<Self>> {
        Ok(Self::make(Cylinder::new(radius)?))
    }

    /// Radius [m].
    #[getter]
    fn radius(slf: &Bound<'_, Self>) -> f64 {
        Self::shape(slf).radius()
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

impl PyFlatPunch {
    pub(super) fn arguments<'py>(
        py: Python<'py>,
        shape: &FlatPunch,
    ) -> PyResult<Bound<'py, PyDict>> {
        numbers(py, [("radius", shape.radius())])
    }
}

#[pymethods]
impl PyFlatPunch {
    #[new]
    fn new(radius: f64) -> PyResult<PyClassInitializer<Self>> {
        Ok(Self::make(FlatPunch::new(radius)?))
    }

    /// Radius [m].
    #[getter]
    fn radius(slf: &Bound<'_, Self>) -> f64 {
        Self::shape(slf).radius()
    }
}
