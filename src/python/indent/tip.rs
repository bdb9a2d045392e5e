//! `nacre.indent.Tip` and `nacre.indent.slope_of`.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::indent::{self, Form, Tip};
use crate::python::arguments::{Real, hash, mapped, real_array};

/// Half angle of the cone whose area at each depth is that of Berkovich's pyramid, 24.5 times the depth squared [rad].
const BERKOVICH: f64 = 24.5;

/// Slope of the flanks of a cone, which is what `Tip.cone` takes.
///
/// Parameters
/// ----------
/// half_angle : float
///     Angle between axis and flank [rad], between 0 and pi/2.
///
/// Returns
/// -------
/// float
///     Cotangent of the angle.
///
/// Raises
/// ------
/// ValueError
///     If the angle is not between 0 and pi/2, as an angle in degrees is not.
///
/// Examples
/// --------
/// >>> import math
/// >>> round(nacre.indent.slope_of(math.radians(70.3)), 4)
/// 0.358
#[pyfunction]
pub(in crate::python) fn slope_of(half_angle: Real) -> PyResult<f64> {
    Ok(indent::slope_of(half_angle.0)?)
}

/// An axisymmetric tip, made by one of its static methods.
///
/// Its profile g(r) is the gap of the undeformed bodies, with g(0) = 0.
///
/// Examples
/// --------
/// >>> tip = nacre.indent.Tip.sphere(radius=10e-6)
/// >>> tip
/// Tip.sphere(radius=1e-05)
/// >>> tip.numbers
/// {'radius': 1e-05}
#[pyclass(name = "Tip", module = "nacre.indent", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub(in crate::python) struct PyTip(pub(in crate::python) Tip);

/// The slope of a cone, of which either it or the half angle [rad] is given.
fn sloped(slope: Option<Real>, half_angle: Option<Real>) -> PyResult<f64> {
    match (slope, half_angle) {
        (Some(Real(slope)), None) => Ok(slope),
        (None, Some(Real(angle))) => Ok(indent::slope_of(angle)?),
        _ => Err(PyValueError::new_err(
            "exactly one of slope and half_angle must be given: a slope against the surface, or an angle between axis and flank [rad]",
        )),
    }
}

fn list(values: &[f64]) -> String {
    let numbers: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
    format!("[{}]", numbers.join(", "))
}

#[pymethods]
impl PyTip {
    /// Sphere of this radius [m], with its true profile R - sqrt(R**2 - r**2).
    #[staticmethod]
    fn sphere(radius: Real) -> PyResult<Self> {
        Ok(Self(Tip::sphere(radius.0)?))
    }

    /// Paraboloid r**2/2R of this radius of curvature [m].
    #[staticmethod]
    fn paraboloid(radius: Real) -> PyResult<Self> {
        Ok(Self(Tip::paraboloid(radius.0)?))
    }

    /// Cone whose flanks have this slope against the surface, at most 5, or of this half angle between axis and flank [rad].
    #[staticmethod]
    #[pyo3(signature = (slope=None, *, half_angle=None))]
    fn cone(slope: Option<Real>, half_angle: Option<Real>) -> PyResult<Self> {
        Ok(Self(Tip::cone(sloped(slope, half_angle)?)?))
    }

    /// Flat punch of this radius [m], with a sharp edge.
    #[staticmethod]
    fn flat_punch(radius: Real) -> PyResult<Self> {
        Ok(Self(Tip::flat_punch(radius.0)?))
    }

    /// Tip of the profile factor * r**exponent.
    #[staticmethod]
    fn power(factor: Real, exponent: Real) -> PyResult<Self> {
        let (factor, exponent) = (factor.0, exponent.0);
        Ok(Self(Tip::new(Form::Power { factor, exponent })?))
    }

    /// Cone of this slope, or half angle [rad], with a paraboloid of this radius [m] at its end, up to where both have the same
    /// slope. The radius must be given.
    #[staticmethod]
    #[pyo3(signature = (slope=None, radius=None, *, half_angle=None))]
    fn rounded_cone(
        slope: Option<Real>,
        radius: Option<Real>,
        half_angle: Option<Real>,
    ) -> PyResult<Self> {
        let slope = sloped(slope, half_angle)?;
        let radius = radius.ok_or_else(|| PyTypeError::new_err("radius must be given"))?.0;
        Ok(Self(Tip::new(Form::RoundedCone { slope, radius })?))
    }

    /// Flat end of radius `flat` [m] with an edge of the radius of curvature `radius` [m].
    #[staticmethod]
    fn rounded_punch(flat: Real, radius: Real) -> PyResult<Self> {
        let (flat, radius) = (flat.0, radius.0);
        Ok(Self(Tip::new(Form::RoundedPunch { flat, radius })?))
    }

    /// Cone of this slope, or half angle [rad], that is cut off at the radius `flat` [m].
    #[staticmethod]
    #[pyo3(signature = (flat, slope=None, *, half_angle=None))]
    fn flat_cone(flat: Real, slope: Option<Real>, half_angle: Option<Real>) -> PyResult<Self> {
        let (flat, slope) = (flat.0, sloped(slope, half_angle)?);
        Ok(Self(Tip::new(Form::FlatCone { flat, slope })?))
    }

    /// Measured profile: heights [m] at ascending radii [m], both from 0 on. Its slope is linear between the middles of the samples.
    #[staticmethod]
    fn profile(radii: &Bound<'_, PyAny>, heights: &Bound<'_, PyAny>) -> PyResult<Self> {
        let radii = real_array("radii", radii)?.into_iter().collect();
        let heights = real_array("heights", heights)?.into_iter().collect();
        Ok(Self(Tip::new(Form::Profile { radii, heights })?))
    }

    /// Tip whose section at the distance d from its end has the area C0 d**2 + C1 d + C2 d**(1/2) + ..., up to `depth` [m]
    /// (Oliver & Pharr, J. Mater. Res. 7 (1992) 1564, eq. (21), doi:10.1557/JMR.1992.1564).
    #[staticmethod]
    fn area_function(coefficients: &Bound<'_, PyAny>, depth: Real) -> PyResult<Self> {
        let coefficients = real_array("coefficients", coefficients)?.into_iter().collect();
        let depth = depth.0;
        Ok(Self(Tip::new(Form::Area { coefficients, depth })?))
    }

    /// Cone with the area of Berkovich's pyramid at each depth, 24.5 d**2, of half angle 70.30 degrees; with an end of this radius [m]
    /// where it is given.
    #[staticmethod]
    #[pyo3(signature = (radius=None))]
    fn berkovich(radius: Option<Real>) -> PyResult<Self> {
        let slope = (std::f64::consts::PI / BERKOVICH).sqrt();
        Ok(Self(match radius {
            Some(Real(radius)) => Tip::new(Form::RoundedCone { slope, radius })?,
            None => Tip::cone(slope)?,
        }))
    }

    /// Form: the name of the static method that makes it.
    #[getter]
    fn kind(&self) -> &'static str {
        match self.0.form() {
            Form::FlatPunch { .. } => "flat_punch",
            Form::Paraboloid { .. } => "paraboloid",
            Form::Sphere { .. } => "sphere",
            Form::Cone { .. } => "cone",
            Form::Power { .. } => "power",
            Form::RoundedCone { .. } => "rounded_cone",
            Form::RoundedPunch { .. } => "rounded_punch",
            Form::FlatCone { .. } => "flat_cone",
            Form::Profile { .. } => "profile",
            Form::Area { .. } => "area_function",
        }
    }

    /// Names and values of the numbers of the form.
    #[getter]
    fn numbers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let numbers = PyDict::new(py);
        for (name, value) in self.0.numbers() {
            numbers.set_item(name, value)?;
        }
        Ok(numbers)
    }

    /// Radius of curvature of the end [m]; None of tips that are not round there.
    #[getter]
    fn end_radius(&self) -> Option<f64> {
        self.0.end_radius()
    }

    /// Profile g [m] at distances r from the axis [m], which must be numbers, in their shape; infinite beyond a sphere or a flat punch.
    fn gap<'py>(&self, r: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let values = real_array("r", r)?;
        if let Some(r) = values.iter().find(|r| self.0.gap(r.abs()).is_nan()) {
            return Err(PyValueError::new_err(format!(
                "r must be distances at which the profile is known, got {r}"
            )));
        }
        mapped("r", r, |r| self.0.gap(r.abs()))
    }

    pub(super) fn __repr__(&self) -> String {
        let arguments = match self.0.form() {
            Form::Profile { radii, heights } => {
                format!("radii={}, heights={}", list(radii), list(heights))
            }
            Form::Area { coefficients, depth } => {
                format!("coefficients={}, depth={depth:?}", list(coefficients))
            }
            _ => {
                let numbers = self.0.numbers().into_iter();
                let words: Vec<String> = numbers.map(|(name, v)| format!("{name}={v:?}")).collect();
                words.join(", ")
            }
        };
        format!("Tip.{}({arguments})", self.kind())
    }

    fn __hash__(&self) -> u64 {
        hash(&self.__repr__())
    }

    /// Callable and arguments that make the tip again.
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let make = py.get_type::<Self>().getattr(self.kind())?;
        let arguments = match self.0.form() {
            Form::Profile { radii, heights } => {
                (radii.clone(), heights.clone()).into_pyobject(py)?
            }
            Form::Area { coefficients, depth } => {
                (coefficients.clone(), *depth).into_pyobject(py)?
            }
            _ => PyTuple::new(py, self.0.numbers().into_iter().map(|(_, value)| value))?,
        };
        Ok((make, arguments))
    }
}
