//! `nacre.Sphere`, `nacre.Paraboloid`, `nacre.Cylinder` and `nacre.FlatPunch`.

use pyo3::prelude::*;

use super::{PyShape, Shape, subclass};
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
///     If it is not finite and above 0.
///
/// Examples
/// --------
/// >>> nacre.Sphere(radius=5e-3)
/// Sphere(radius=0.005)
#[pyclass(name = "Sphere", module = "nacre", frozen, extends = PyShape)]
pub(in crate::python) struct PySphere;

#[pymethods]
impl PySphere {
    #[new]
    fn new(radius: f64) -> PyResult<PyClassInitializer<Self>> {
        Ok(subclass(Self, Shape::Sphere(Sphere::new(radius)?)))
    }

    /// Radius [m].
    #[getter]
    fn radius(slf: &Bound<'_, Self>) -> f64 {
        match &slf.as_super().get().0 {
            Shape::Sphere(shape) => shape.radius(),
            _ => unreachable!("made by its own constructor"),
        }
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
///     If one is not finite and above 0.
///
/// Examples
/// --------
/// >>> nacre.Paraboloid(5e-3, 5e-3)
/// Paraboloid(radius_x=0.005, radius_y=0.005)
#[pyclass(name = "Paraboloid", module = "nacre", frozen, extends = PyShape)]
pub(in crate::python) struct PyParaboloid;

#[pymethods]
impl PyParaboloid {
    #[new]
    fn new(radius_x: f64, radius_y: f64) -> PyResult<PyClassInitializer<Self>> {
        Ok(subclass(
            Self,
            Shape::Paraboloid(Paraboloid::new(radius_x, radius_y)?),
        ))
    }

    /// Radius of curvature along x [m].
    #[getter]
    fn radius_x(slf: &Bound<'_, Self>) -> f64 {
        match &slf.as_super().get().0 {
            Shape::Paraboloid(shape) => shape.radius_x(),
            _ => unreachable!("made by its own constructor"),
        }
    }

    /// Radius of curvature along y [m].
    #[getter]
    fn radius_y(slf: &Bound<'_, Self>) -> f64 {
        match &slf.as_super().get().0 {
            Shape::Paraboloid(shape) => shape.radius_y(),
            _ => unreachable!("made by its own constructor"),
        }
    }
}

/// An endless cylinder, axis along x: ``h = R - sqrt(R**2 - y**2)``, +inf beyond R.
///
/// Its contact is as long as the grid, which must be given.
///
/// Parameters
/// ----------
/// radius : float
///     Radius [m], above 0.
///
/// Raises
/// ------
/// ValueError
///     If it is not finite and above 0.
///
/// Examples
/// --------
/// >>> nacre.Cylinder(radius=5e-3)
/// Cylinder(radius=0.005)
#[pyclass(name = "Cylinder", module = "nacre", frozen, extends = PyShape)]
pub(in crate::python) struct PyCylinder;

#[pymethods]
impl PyCylinder {
    #[new]
    fn new(radius: f64) -> PyResult<PyClassInitializer<Self>> {
        Ok(subclass(Self, Shape::Cylinder(Cylinder::new(radius)?)))
    }

    /// Radius [m].
    #[getter]
    fn radius(slf: &Bound<'_, Self>) -> f64 {
        match &slf.as_super().get().0 {
            Shape::Cylinder(shape) => shape.radius(),
            _ => unreachable!("made by its own constructor"),
        }
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
///     If it is not finite and above 0.
///
/// Examples
/// --------
/// >>> nacre.FlatPunch(radius=1e-3)
/// FlatPunch(radius=0.001)
#[pyclass(name = "FlatPunch", module = "nacre", frozen, extends = PyShape)]
pub(in crate::python) struct PyFlatPunch;

#[pymethods]
impl PyFlatPunch {
    #[new]
    fn new(radius: f64) -> PyResult<PyClassInitializer<Self>> {
        Ok(subclass(Self, Shape::FlatPunch(FlatPunch::new(radius)?)))
    }

    /// Radius [m].
    #[getter]
    fn radius(slf: &Bound<'_, Self>) -> f64 {
        match &slf.as_super().get().0 {
            Shape::FlatPunch(shape) => shape.radius(),
            _ => unreachable!("made by its own constructor"),
        }
    }
}
