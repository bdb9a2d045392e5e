//! `nacre.hertz`: closed forms for the contact of curved bodies.

use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::model::hertz;
use crate::python::arguments::{Real, hash, mapped};
use crate::python::bodies::PyElastic;

mod ellipse;
mod line;

pub(in crate::python) use ellipse::PyEllipse;
pub(in crate::python) use line::PyLine;

/// Equivalent radius of two surfaces in contact, in one direction: ``1/R = 1/R_1 + 1/R_2``.
///
/// Parameters
/// ----------
/// radius : float or None
///     Radius R_1 [m]: above 0 where the surface is convex, below 0 where it is concave; None where it
///     is straight.
/// counter_radius : float, optional
///     Radius R_2 of the other surface [m], likewise; below 0 for a raceway of an outer ring or a groove.
///
/// Returns
/// -------
/// float
///     Equivalent radius R [m].
///
/// Raises
/// ------
/// ValueError
///     If a radius is 0 or not finite, or 1/R is not above 0.
///
/// Examples
/// --------
/// A roller of 5 mm on an inner ring of 20 mm and in an outer ring of 30 mm:
///
/// >>> round(nacre.hertz.equivalent_radius(5e-3, 20e-3), 9)
/// 0.004
/// >>> round(nacre.hertz.equivalent_radius(5e-3, -30e-3), 9)
/// 0.006
#[pyfunction]
#[pyo3(signature = (radius, counter_radius=None))]
pub(in crate::python) fn equivalent_radius(
    radius: Option<Real>,
    counter_radius: Option<Real>,
) -> PyResult<f64> {
    let [radius, counter_radius] = [radius, counter_radius].map(|r| r.map(|r| r.0));
    Ok(hertz::equivalent_radius(radius, counter_radius)?)
}

/// Contact modulus of two bodies: ``1/E* = (1 - nu_1**2)/E_1 + (1 - nu_2**2)/E_2``.
///
/// Parameters
/// ----------
/// body : Elastic
///     Material of one body.
/// counterbody : Elastic, optional
///     Material of the other body; rigid by default.
///
/// Returns
/// -------
/// float
///     Contact modulus E* [Pa].
///
/// Raises
/// ------
/// TypeError
///     If an argument is no material.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> round(nacre.hertz.contact_modulus(steel, steel) / 1e9, 3)
/// 115.385
#[pyfunction]
#[pyo3(signature = (body, counterbody=None))]
pub(in crate::python) fn contact_modulus(body: PyElastic, counterbody: Option<PyElastic>) -> f64 {
    hertz::contact_modulus(&body.0, counterbody.as_ref().map(|other| &other.0))
}

/// Contact of two bodies that are round: a ball on a plane, on a ball or in a socket.
///
/// Johnson, Contact Mechanics (1985), eqs (4.22)-(4.24), doi:10.1017/CBO9781139171731.
///
/// Parameters
/// ----------
/// radius : float
///     Equivalent radius R of both bodies [m]; see `equivalent_radius`.
/// contact_modulus : float
///     E* of both bodies [Pa]; see `contact_modulus`.
/// load : float
///     Force W [N].
///
/// Raises
/// ------
/// ValueError
///     If an argument is not finite and above 0.
///
/// Examples
/// --------
/// >>> contact = nacre.hertz.Point(radius=5e-3, contact_modulus=115e9, load=10.0)
/// >>> f"{contact.peak_pressure / 1e6:.1f} MPa, {contact.contact_radius * 1e6:.2f} um"
/// '1007.8 MPa, 68.83 um'
#[pyclass(name = "Point", module = "nacre.hertz", frozen, eq)]
#[derive(Clone, PartialEq)]
pub(in crate::python) struct PyPoint {
    /// Equivalent radius, contact modulus and force.
    arguments: [f64; 3],
    contact: hertz::Point,
}

#[pymethods]
impl PyPoint {
    #[new]
    fn new(radius: Real, contact_modulus: Real, load: Real) -> PyResult<Self> {
        let arguments = [radius.0, contact_modulus.0, load.0];
        let contact = hertz::Point::new(radius.0, contact_modulus.0, load.0)?;
        Ok(Self { arguments, contact })
    }

    /// Equivalent radius [m].
    #[getter]
    fn radius(&self) -> f64 {
        self.arguments[0]
    }

    /// Contact modulus E* [Pa].
    #[getter]
    fn contact_modulus(&self) -> f64 {
        self.arguments[1]
    }

    /// Force [N].
    #[getter]
    fn load(&self) -> f64 {
        self.arguments[2]
    }

    /// Radius of the contact ``a = (3 W R/4 E*)**(1/3)`` [m].
    #[getter]
    fn contact_radius(&self) -> f64 {
        self.contact.radius
    }

    /// Peak pressure ``p0 = 3 W/(2 pi a**2)`` [Pa].
    #[getter]
    fn peak_pressure(&self) -> f64 {
        self.contact.peak_pressure
    }

    /// Approach ``a**2/R`` [m].
    #[getter]
    fn approach(&self) -> f64 {
        self.contact.approach
    }

    /// Pressure at distances from the axis.
    ///
    /// Parameters
    /// ----------
    /// r : float or array_like
    ///     Distances [m], of any shape.
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray
    ///     Pressures [Pa] in the shape of `r`.
    ///
    /// Raises
    /// ------
    /// TypeError
    ///     If the distances are not real numbers.
    ///
    /// Examples
    /// --------
    /// >>> contact = nacre.hertz.Point(radius=5e-3, contact_modulus=115e9, load=10.0)
    /// >>> contact.pressure(0.0) == contact.peak_pressure
    /// True
    fn pressure<'py>(&self, r: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        mapped("r", r, |r| self.contact.pressure(r))
    }

    /// Largest shear stress on the axis, and its depth.
    ///
    /// Parameters
    /// ----------
    /// poisson : float
    ///     Poisson's ratio of the body that is looked at.
    ///
    /// Returns
    /// -------
    /// tuple of float
    ///     Half the difference of the principal stresses [Pa] and the depth [m].
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     Unless `poisson` is above -1 and at most 0.5.
    ///
    /// Examples
    /// --------
    /// >>> contact = nacre.hertz.Point(radius=5e-3, contact_modulus=115e9, load=10.0)
    /// >>> stress, depth = contact.max_shear(poisson=0.3)
    /// >>> round(stress / contact.peak_pressure, 3), round(depth / contact.contact_radius, 2)
    /// (0.31, 0.48)
    fn max_shear(&self, poisson: Real) -> PyResult<(f64, f64)> {
        let shear = self.contact.max_shear(poisson.0)?;
        Ok((shear.stress, shear.depth))
    }

    fn __repr__(&self) -> String {
        let [radius, modulus, load] = self.arguments;
        format!("Point(radius={radius:?}, contact_modulus={modulus:?}, load={load:?})")
    }

    fn __hash__(&self) -> u64 {
        hash(&self.__repr__())
    }

    /// Callable and arguments that make the contact again.
    fn __reduce__<'py>(&self, py: Python<'py>) -> (Bound<'py, PyType>, (f64, f64, f64)) {
        (py.get_type::<Self>(), self.arguments.into())
    }
}
