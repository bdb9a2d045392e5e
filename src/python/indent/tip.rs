//! `nacre.indent.Tip` and `nacre.indent.slope_of`.

use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use crate::indent::{self, Form, Tip};
use crate::python::arguments::{Real, mapped, real_array};
use crate::python::value::{self, Arguments, Value, class};

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

class! {
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
    PyTip(Tip) is "Tip" of "nacre.indent";
    |of, py|
    attributes {
        /// Form: the name of the static method that makes it.
        kind: &'static str = kind(of);
        /// Names and values of the numbers of the form.
        numbers: Bound<'py, PyDict> = of.numbers().into_py_dict(py)?;
        /// Radius of curvature of the end [m]; None of tips that are not round there.
        end_radius: Option<f64> = of.end_radius();
    }
    methods {
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
        #[pyo3(signature = (*, slope=None, half_angle=None))]
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
        /// slope.
        #[staticmethod]
        #[pyo3(signature = (radius, *, slope=None, half_angle=None))]
        fn rounded_cone(
            radius: Real,
            slope: Option<Real>,
            half_angle: Option<Real>,
        ) -> PyResult<Self> {
            let (radius, slope) = (radius.0, sloped(slope, half_angle)?);
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
        #[pyo3(signature = (flat, *, slope=None, half_angle=None))]
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
    }
}

/// Name of the static method that makes a tip.
fn kind(tip: &Tip) -> &'static str {
    match tip.form() {
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

impl Value for PyTip {
    const NAME: &'static str = "Tip";

    fn maker(&self) -> Option<&'static str> {
        Some(kind(&self.0))
    }

    fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Arguments<'py>> {
        Ok(match self.0.form() {
            Form::Profile { radii, heights } => vec![
                ("radii", radii.into_bound_py_any(py)?),
                ("heights", heights.into_bound_py_any(py)?),
            ],
            Form::Area { coefficients, depth } => vec![
                ("coefficients", coefficients.into_bound_py_any(py)?),
                ("depth", depth.into_bound_py_any(py)?),
            ],
            _ => {
                let numbers = self.0.numbers().into_iter();
                let named = numbers.map(|(name, value)| Ok((name, value.into_bound_py_any(py)?)));
                named.collect::<PyResult<_>>()?
            }
        })
    }
}
