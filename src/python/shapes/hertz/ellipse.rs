//! `nacre.hertz.Ellipse`.

use numpy::IntoPyArray;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::model::hertz;
use crate::python::arguments::{Real, hash, real_array};

/// Contact of two bodies that are curved differently along x and y: a ball in a groove, a barrel on a ring.
///
/// The radii are signed: above 0 where a surface is convex, below 0 where it is concave, None where it is
/// straight. Johnson, Contact Mechanics (1985), eqs (4.25)-(4.32), doi:10.1017/CBO9781139171731.
///
/// Parameters
/// ----------
/// radius_x, radius_y : float or None
///     Radii of one body along x and y [m].
/// contact_modulus : float
///     E* of both bodies [Pa]; see `contact_modulus`.
/// load : float
///     Force W [N].
/// counter_radius_x, counter_radius_y : float, optional
///     Radii of the other body along x and y [m].
///
/// Raises
/// ------
/// ValueError
///     If modulus or load are not finite and above 0, or the bodies are not convex together in a direction.
///
/// Examples
/// --------
/// A ball in the groove of an inner ring:
///
/// >>> contact = nacre.hertz.Ellipse(
/// ...     5e-3, 5e-3, contact_modulus=115.4e9, load=1e3, counter_radius_x=-5.2e-3, counter_radius_y=20e-3
/// ... )
/// >>> a, b = contact.semi_axes
/// >>> round(a / b, 2)
/// 9.32
#[pyclass(name = "Ellipse", module = "nacre.hertz", frozen, eq)]
#[derive(Clone, PartialEq)]
pub(in crate::python) struct PyEllipse {
    /// Radii of the one body and of the other.
    radii: [Option<f64>; 2],
    counter_radii: [Option<f64>; 2],
    /// Contact modulus and force.
    arguments: [f64; 2],
    contact: hertz::Ellipse,
}

#[pymethods]
impl PyEllipse {
    #[new]
    #[pyo3(
        signature = (radius_x, radius_y, contact_modulus, load, counter_radius_x=None, counter_radius_y=None)
    )]
    fn new(
        radius_x: Option<Real>,
        radius_y: Option<Real>,
        contact_modulus: Real,
        load: Real,
        counter_radius_x: Option<Real>,
        counter_radius_y: Option<Real>,
    ) -> PyResult<Self> {
        let radii = [radius_x, radius_y].map(|radius| radius.map(|r| r.0));
        let counter_radii = [counter_radius_x, counter_radius_y].map(|radius| radius.map(|r| r.0));
        let equivalent = [
            hertz::equivalent_radius(radii[0], counter_radii[0])?,
            hertz::equivalent_radius(radii[1], counter_radii[1])?,
        ];
        Ok(Self {
            radii,
            counter_radii,
            arguments: [contact_modulus.0, load.0],
            contact: hertz::Ellipse::new(equivalent, contact_modulus.0, load.0)?,
        })
    }

    /// Radius of the one body along x [m]; None where it is straight.
    #[getter]
    fn radius_x(&self) -> Option<f64> {
        self.radii[0]
    }

    /// Radius of the one body along y [m]; None where it is straight.
    #[getter]
    fn radius_y(&self) -> Option<f64> {
        self.radii[1]
    }

    /// Radius of the other body along x [m]; None where it is straight.
    #[getter]
    fn counter_radius_x(&self) -> Option<f64> {
        self.counter_radii[0]
    }

    /// Radius of the other body along y [m]; None where it is straight.
    #[getter]
    fn counter_radius_y(&self) -> Option<f64> {
        self.counter_radii[1]
    }

    /// Contact modulus E* [Pa].
    #[getter]
    fn contact_modulus(&self) -> f64 {
        self.arguments[0]
    }

    /// Force [N].
    #[getter]
    fn load(&self) -> f64 {
        self.arguments[1]
    }

    /// Semi-axes of the contact along x and y [m].
    #[getter]
    fn semi_axes(&self) -> (f64, f64) {
        self.contact.semi_axes.into()
    }

    /// Peak pressure ``p0 = 3 W/(2 pi a b)`` [Pa].
    #[getter]
    fn peak_pressure(&self) -> f64 {
        self.contact.peak_pressure
    }

    /// Approach [m].
    #[getter]
    fn approach(&self) -> f64 {
        self.contact.approach
    }

    /// Pressure at points of the surface.
    ///
    /// Parameters
    /// ----------
    /// x, y : float or array_like
    ///     Coordinates from the middle [m], of the same shape.
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray
    ///     Pressures [Pa] in the shape of `x`.
    ///
    /// Raises
    /// ------
    /// TypeError
    ///     If the coordinates are not real numbers.
    /// ValueError
    ///     If they are not of the same shape.
    ///
    /// Examples
    /// --------
    /// >>> contact = nacre.hertz.Ellipse(1e-2, 5e-3, contact_modulus=115.4e9, load=10.0)
    /// >>> a, b = contact.semi_axes
    /// >>> contact.pressure([0.0, a, 0.0], [0.0, 0.0, b]) / contact.peak_pressure
    /// array([1., 0., 0.])
    fn pressure<'py>(
        &self,
        x: &Bound<'py, PyAny>,
        y: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (mut values, y) = (real_array("x", x)?, real_array("y", y)?);
        if values.shape() != y.shape() {
            return Err(PyValueError::new_err(format!(
                "x and y must have the same shape, got {:?} and {:?}",
                values.shape(),
                y.shape()
            )));
        }
        values.zip_mut_with(&y, |x, y| *x = self.contact.pressure(*x, *y));
        if values.ndim() == 0 {
            return Ok(values.sum().into_pyobject(x.py())?.into_any());
        }
        Ok(values.into_pyarray(x.py()).into_any())
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
    /// >>> contact = nacre.hertz.Ellipse(1e-2, 5e-3, contact_modulus=115.4e9, load=10.0)
    /// >>> stress, depth = contact.max_shear(poisson=0.3)
    /// >>> round(stress / contact.peak_pressure, 2), round(depth / min(contact.semi_axes), 2)
    /// (0.32, 0.59)
    fn max_shear(&self, poisson: Real) -> PyResult<(f64, f64)> {
        let shear = self.contact.max_shear(poisson.0)?;
        Ok((shear.stress, shear.depth))
    }

    fn __repr__(&self) -> String {
        let text = |radius: Option<f64>| radius.map_or("None".into(), |r| format!("{r:?}"));
        let [[x, y], [cx, cy]] = [self.radii, self.counter_radii].map(|radii| radii.map(text));
        let [modulus, load] = self.arguments;
        format!(
            "Ellipse(radius_x={x}, radius_y={y}, contact_modulus={modulus:?}, load={load:?}, \
             counter_radius_x={cx}, counter_radius_y={cy})"
        )
    }

    fn __hash__(&self) -> u64 {
        hash(&self.__repr__())
    }

    /// Callable and arguments that make the contact again.
    fn __reduce__<'py>(&self, py: Python<'py>) -> (Bound<'py, PyType>, Arguments) {
        let ([x, y], [cx, cy]) = (self.radii, self.counter_radii);
        let [modulus, load] = self.arguments;
        (py.get_type::<Self>(), (x, y, modulus, load, cx, cy))
    }
}

/// Arguments of the constructor.
type Arguments = (Option<f64>, Option<f64>, f64, f64, Option<f64>, Option<f64>);
