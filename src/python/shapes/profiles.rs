//! `nacre.SampledProfile`, and profiles of either class.

use ndarray::Array1;
use numpy::PyArray1;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use super::logarithmic::PyLogarithmicProfile;
use crate::model::surface::{Profile, SampledProfile};
use crate::python::arguments::{Repr, mapped, read_only, real_array};
use crate::python::value::{self, Arguments, Value};

/// A measured axial profile of a roller: drops at positions, linear in between, +inf beyond.
///
/// Parameters
/// ----------
/// x : array_like
///     Positions ``(n,)`` along the axis [m], increasing, at least two.
/// drop : array_like
///     Drops ``(n,)`` below the datum [m].
///
/// Raises
/// ------
/// TypeError
///     If positions or drops are not real numbers.
/// ValueError
///     If there are not as many drops as positions, one is not finite, or the positions do not
///     increase.
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
    fn new(x: &Bound<'_, PyAny>, drop: &Bound<'_, PyAny>) -> PyResult<Self> {
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
        Ok(Self(SampledProfile::new(&list("x", x)?, &list("drop", drop)?)?))
    }

    /// Drops at any positions along the axis, linear between the samples.
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
    /// >>> nacre.SampledProfile(x=[-10e-3, 0.0, 10e-3], drop=[5e-6, 0.0, 5e-6]).drop_at(5e-3)
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
        let line = |k: usize| {
            let numbers: Array1<f64> = self.0.samples().map(|sample| sample[k]).collect();
            read_only(py, numbers.into_dyn())
        };
        Ok(vec![("x", line(0)?.into_any()), ("drop", line(1)?.into_any())])
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
    match object.extract::<[Bound<'_, PyAny>; 2]>() {
        Ok([x, drop]) => Ok(PySampledProfile::new(&x, &drop)?.0.into()),
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
