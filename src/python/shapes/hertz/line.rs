//! `nacre.hertz.Line`.

use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::model::hertz;
use crate::python::arguments::{Real, hash, mapped};

/// Contact of two parallel cylinders, per unit length: a roller on a plane or on a raceway.
///
/// Johnson, Contact Mechanics (1985), eqs (4.43)-(4.45), doi:10.1017/CBO9781139171731. The approach of a
/// line contact has no limit on a half-space, and is not among the attributes: it depends on a datum in each
/// body. Two rollers approach by the sum of ``W' (1 - poisson**2)/(pi young) (2 log(4 radius/half_width) - 1)``
/// over both, with the radius of each, from axis to axis (section 5.6).
///
/// Parameters
/// ----------
/// radius : float
///     Equivalent radius R of both bodies [m]; see `equivalent_radius`.
/// contact_modulus : float
///     E* of both bodies [Pa]; see `contact_modulus`.
/// line_load : float
///     Force per unit length W' [N/m].
///
/// Raises
/// ------
/// ValueError
///     If an argument is not finite and above 0.
///
/// Examples
/// --------
/// >>> contact = nacre.hertz.Line(radius=6e-3, contact_modulus=115e9, line_load=1e5)
/// >>> f"{contact.peak_pressure / 1e6:.1f} MPa, {contact.half_width * 1e6:.2f} um"
/// '781.1 MPa, 81.50 um'
#[pyclass(name = "Line", module = "nacre.hertz", frozen, eq)]
#[derive(Clone, PartialEq)]
pub(in crate::python) struct PyLine {
    /// Equivalent radius, contact modulus and force per unit length.
    arguments: [f64; 3],
    contact: hertz::Line,
}

#[pymethods]
impl PyLine {
    #[new]
    fn new(radius: Real, contact_modulus: Real, line_load: Real) -> PyResult<Self> {
        let arguments = [radius.0, contact_modulus.0, line_load.0];
        let contact = hertz::Line::new(radius.0, contact_modulus.0, line_load.0)?;
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

    /// Force per unit length [N/m].
    #[getter]
    fn line_load(&self) -> f64 {
        self.arguments[2]
    }

    /// Half-width of the contact ``b = (4 W' R/(pi E*))**(1/2)`` [m].
    #[getter]
    fn half_width(&self) -> f64 {
        self.contact.half_width
    }

    /// Peak pressure ``p0 = 2 W'/(pi b)`` [Pa].
    #[getter]
    fn peak_pressure(&self) -> f64 {
        self.contact.peak_pressure
    }

    /// Pressure at distances from the middle.
    ///
    /// Parameters
    /// ----------
    /// y : float or array_like
    ///     Distances [m], of any shape.
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray
    ///     Pressures [Pa] in the shape of `y`.
    ///
    /// Raises
    /// ------
    /// TypeError
    ///     If the distances are not real numbers.
    ///
    /// Examples
    /// --------
    /// >>> contact = nacre.hertz.Line(radius=6e-3, contact_modulus=115e9, line_load=1e5)
    /// >>> contact.pressure(0.0) == contact.peak_pressure
    /// True
    fn pressure<'py>(&self, y: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        mapped("y", y, |y| self.contact.pressure(y))
    }

    /// Largest shear stress below the middle, and its depth.
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
    /// >>> contact = nacre.hertz.Line(radius=6e-3, contact_modulus=115e9, line_load=1e5)
    /// >>> stress, depth = contact.max_shear(poisson=0.3)
    /// >>> round(stress / contact.peak_pressure, 3), round(depth / contact.half_width, 3)
    /// (0.3, 0.786)
    fn max_shear(&self, poisson: Real) -> PyResult<(f64, f64)> {
        let shear = self.contact.max_shear(poisson.0)?;
        Ok((shear.stress, shear.depth))
    }

    fn __repr__(&self) -> String {
        let [radius, modulus, line_load] = self.arguments;
        format!("Line(radius={radius:?}, contact_modulus={modulus:?}, line_load={line_load:?})")
    }

    fn __hash__(&self) -> u64 {
        hash(&self.__repr__())
    }

    /// Callable and arguments that make the contact again.
    fn __reduce__<'py>(&self, py: Python<'py>) -> (Bound<'py, PyType>, (f64, f64, f64)) {
        (py.get_type::<Self>(), self.arguments.into())
    }
}
