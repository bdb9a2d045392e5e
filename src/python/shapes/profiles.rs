//! `nacre.SampledProfile`, and profiles of either class.

use numpy::PyArray1;
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyTuple};

use super::logarithmic::PyLogarithmicProfile;
use crate::model::surface::{Profile, SampledProfile};
use crate::python::arguments::{Real, Repr, Two, mapped, read_only, real_array};
use crate::python::value::{self, Arguments, Value};

/// A measured axial profile of a roller: drops at positions, a smooth curve through them, +inf beyond.
///
/// The curve is a cubic spline whose slopes are limited so that it does not swing at steps and edges (Huynh,
/// SIAM J. Numer. Anal. 30 (1993) 57, doi:10.1137/0730004). What lies between the positions is not known:
/// solutions count it in ``report.discretisation``, by comparison with the spline through every second position.
///
/// Parameters
/// ----------
/// x : array_like
///     Positions ``(n,)`` along the axis [m], increasing, at least two.
/// drop : array_like
///     Drops ``(n,)`` below the datum [m].
/// smooth : bool, optional
///     Whether the curve is smooth; False joins the positions by straight lines, each of them an edge.
/// corners : array_like, optional
///     Positions of true edges [m], between which the curve is smooth; each is at the nearest of `x`.
/// smoothing : float, optional
///     Wavelength [m] below which waves are taken away as noise, of which half is left: the regression filter
///     of ISO 16610-31, which keeps parabolas. None by default.
///
/// Raises
/// ------
/// TypeError
///     If positions, drops, corners or wavelength are not real numbers.
/// ValueError
///     If there are not as many drops as positions, one is not finite, the positions do not increase, a corner
///     is not between the ends, or the wavelength is not above 0.
///
/// Examples
/// --------
/// >>> profile = nacre.SampledProfile(x=[-10e-3, 0.0, 10e-3], drop=[5e-6, 0.0, 5e-6])
/// >>> roller = nacre.Roller(radius=5e-3, profile=profile)
#[pyclass(name = "SampledProfile", module = "nacre", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub(in crate::python) struct PySampledProfile(pub(super) SampledProfile);

#[pymethods]
impl PySampledProfile {
    #[new]
    #[pyo3(signature = (x, drop, smooth=true, corners=None, smoothing=None))]
    fn new(
        x: &Bound<'_, PyAny>,
        drop: &Bound<'_, PyAny>,
        smooth: bool,
        corners: Option<&Bound<'_, PyAny>>,
        smoothing: Option<Real>,
    ) -> PyResult<Self> {
        let list = |name: &str, object| -> PyResult<Vec<f64>> {
            let array = real_array(name, object)?;
            if array.ndim() != 1 {
                return Err(PyValueError::new_err(format!(
                    "{name} must have one dimension (n,), got shape {:?}",
                    array.shape()
                )));
            }
            Ok(array.into_iter().collect())
        };
        let mut profile = SampledProfile::new(&list("x", x)?, &list("drop", drop)?)?;
        if let Some(corners) = corners {
            profile = profile.with_corners(&list("corners", corners)?)?;
        }
        if let Some(wavelength) = smoothing {
            profile = profile.smoothed(wavelength.0)?;
        }
        Ok(Self(if smooth { profile } else { profile.straight() }))
    }

    /// Drops at any positions along the axis.
    ///
    /// Parameters
    /// ----------
    /// x : float or array_like
    ///     Positions [m], of any shape.
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray
    ///     Drops [m] in the shape of `x`; +inf beyond the ends.
    ///
    /// Raises
    /// ------
    /// TypeError
    ///     If the positions are not real numbers.
    ///
    /// Examples
    /// --------
    /// >>> round(nacre.SampledProfile([-10e-3, 0.0, 10e-3], [5e-6, 0.0, 5e-6]).drop_at(5e-3), 15)
    /// 1.25e-06
    /// >>> nacre.SampledProfile([-10e-3, 0.0, 10e-3], [5e-6, 0.0, 5e-6], smooth=False).drop_at(5e-3)
    /// 2.5e-06
    fn drop_at<'py>(&self, x: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let profile = Profile::from(self.0.clone());
        mapped("x", x, |x| profile.drop(x))
    }

    /// Positions ``(n,)`` [m].
    #[getter]
    fn x<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        read_only(py, self.0.samples().map(|s| s[0]).collect())
    }

    /// Drops ``(n,)`` [m].
    #[getter]
    fn drop<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        read_only(py, self.0.samples().map(|s| s[1]).collect())
    }

    /// Whether the curve is smooth.
    #[getter]
    fn smooth(&self) -> bool {
        !self.0.is_straight()
    }

    /// Positions of true edges [m], or None.
    #[getter]
    fn corners<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyTuple>>> {
        let corners = self.0.corners();
        (!corners.is_empty()).then(|| PyTuple::new(py, corners)).transpose()
    }

    /// Wavelength below which waves are taken away [m], or None.
    #[getter]
    fn smoothing(&self) -> Option<f64> {
        self.0.smoothing()
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        value::repr(self, py)
    }

    fn _arguments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.arguments(py)?.into_py_dict(py)
    }

    /// Callable and arguments that make the profile again.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<value::Reduced<'py>> {
        value::reduced(slf.get(), slf.get_type().as_any())
    }
}

impl Value for PySampledProfile {
    const NAME: &'static str = "SampledProfile";

    fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Arguments<'py>> {
        Ok(vec![
            ("x", self.x(py)?.into_any()),
            ("drop", self.drop(py)?.into_any()),
            ("smooth", self.smooth().into_bound_py_any(py)?),
            ("corners", self.corners(py)?.into_bound_py_any(py)?),
            ("smoothing", self.smoothing().into_bound_py_any(py)?),
        ])
    }
}

/// Profile from an argument: an object of either class, or a pair (x, drop).
pub(super) fn profile(object: &Bound<'_, PyAny>) -> PyResult<Profile> {
    if let Ok(profile) = object.extract::<PyLogarithmicProfile>() {
        return Ok(profile.0.into());
    }
    if let Ok(profile) = object.extract::<PySampledProfile>() {
        return Ok(profile.0.into());
    }
    match object.extract::<Two>() {
        Ok(Two([x, drop])) => Ok(PySampledProfile::new(&x, &drop, true, None, None)?.0.into()),
        Err(_) => Err(PyTypeError::new_err(format!(
            "profile must be a LogarithmicProfile, a SampledProfile or a pair (x, drop), got {}",
            Repr(object)
        ))),
    }
}

/// Python object for a profile; `None` for a crown, which a roller has as arguments of its own.
pub(super) fn to_python<'py>(
    py: Python<'py>,
    profile: &Profile,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    Ok(match profile {
        Profile::Crowned(_) => None,
        Profile::Logarithmic(p) => Some(Bound::new(py, PyLogarithmicProfile(*p))?.into_any()),
        Profile::Sampled(p) => Some(Bound::new(py, PySampledProfile(p.clone()))?.into_any()),
    })
}
