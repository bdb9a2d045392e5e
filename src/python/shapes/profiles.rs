//! `nacre.LogarithmicProfile` and `nacre.SampledProfile`.

use ndarray::Array1;
use numpy::PyArray1;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::python::arguments::{Repr, array_repr, hash, read_only, real_array};
use crate::surface::{LogarithmicProfile, Profile, SampledProfile};

/// A logarithmic axial profile of a roller, straight over its middle where `flat_length` > 0.
///
/// ``d(x) = A ln(1/(1 - f u**2))`` with ``u = (2|x| - flat_length)/(length - flat_length)``, +inf
/// beyond ``|x| = length/2``.
///
/// Parameters
/// ----------
/// amplitude : float
///     A [m], above 0.
/// length : float
///     Whole length [m], above 0.
/// flat_length : float, optional
///     Length of the straight part [m], at least 0 and below `length`.
/// end_factor : float, optional
///     f, above 0 and at most 1; below 1 the drop at the ends is finite.
///
/// Raises
/// ------
/// ValueError
///     If an argument is out of range.
///
/// Examples
/// --------
/// >>> profile = nacre.LogarithmicProfile.iso16281(diameter=10e-3, length=20e-3)
/// >>> round(profile.amplitude * 1e6, 6)
/// 3.5
/// >>> roller = nacre.Roller(radius=5e-3, profile=profile)
#[pyclass(
    name = "LogarithmicProfile",
    module = "nacre",
    frozen,
    eq,
    from_py_object
)]
#[derive(Clone, PartialEq)]
pub(in crate::python) struct PyLogarithmicProfile(pub(super) LogarithmicProfile);

#[pymethods]
impl PyLogarithmicProfile {
    #[new]
    #[pyo3(signature = (amplitude, length, flat_length=0.0, end_factor=1.0))]
    fn new(amplitude: f64, length: f64, flat_length: f64, end_factor: f64) -> PyResult<Self> {
        Ok(Self(LogarithmicProfile::new(
            amplitude,
            length,
            flat_length,
            end_factor,
        )?))
    }

    /// Lundberg's profile: the pressure of this load is the same all along the roller.
    ///
    /// ``A = W/(pi L E*)``. Lundberg, Forsch. Ing.-Wes. 10 (1939) 201.
    ///
    /// Parameters
    /// ----------
    /// length : float
    ///     Length L of the roller [m].
    /// load : float
    ///     Load W [N].
    /// contact_modulus : float
    ///     E* [Pa], ``1/E* = sum of (1 - nu**2)/E`` over both bodies.
    ///
    /// Returns
    /// -------
    /// LogarithmicProfile
    ///     The profile.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If an argument is not finite and above 0.
    ///
    /// Examples
    /// --------
    /// >>> profile = nacre.LogarithmicProfile.lundberg(20e-3, load=20e3, contact_modulus=115e9)
    /// >>> round(profile.amplitude * 1e6, 4)
    /// 2.7679
    #[staticmethod]
    fn lundberg(length: f64, load: f64, contact_modulus: f64) -> PyResult<Self> {
        Ok(Self(LogarithmicProfile::lundberg(
            length,
            load,
            contact_modulus,
        )?))
    }

    /// Johns and Gohar's profile: Lundberg's, with a finite drop at the ends.
    ///
    /// ``f = 1 - 0.3033 b/a`` with the Hertzian half-width b and the half-length a. Johns & Gohar,
    /// Tribol. Int. 14 (1981) 131.
    ///
    /// Parameters
    /// ----------
    /// length : float
    ///     Length of the roller [m].
    /// load : float
    ///     Load [N].
    /// contact_modulus : float
    ///     E* [Pa], of both bodies.
    /// radius : float
    ///     Radius of the roller [m].
    ///
    /// Returns
    /// -------
    /// LogarithmicProfile
    ///     The profile.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If an argument is not finite and above 0.
    ///
    /// Examples
    /// --------
    /// >>> profile = nacre.LogarithmicProfile.johns_gohar(20e-3, 20e3, 115e9, radius=5e-3)
    /// >>> profile.end_factor < 1
    /// True
    #[staticmethod]
    fn johns_gohar(length: f64, load: f64, contact_modulus: f64, radius: f64) -> PyResult<Self> {
        Ok(Self(LogarithmicProfile::johns_gohar(
            length,
            load,
            contact_modulus,
            radius,
        )?))
    }

    /// The profile of ISO/TS 16281.
    ///
    /// ``0.00035 D ln(1/(1 - (2x/L)**2))`` for ``L <= 2.5 D``; for longer rollers
    /// ``0.0005 D ln(1/(1 - u**2))`` over the last 1.25 D at each end.
    ///
    /// Parameters
    /// ----------
    /// diameter : float
    ///     Diameter D of the roller [m].
    /// length : float
    ///     Effective length L [m].
    ///
    /// Returns
    /// -------
    /// LogarithmicProfile
    ///     The profile.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If an argument is not finite and above 0.
    ///
    /// Examples
    /// --------
    /// >>> round(nacre.LogarithmicProfile.iso16281(diameter=10e-3, length=30e-3).flat_length, 9)
    /// 0.005
    #[staticmethod]
    fn iso16281(diameter: f64, length: f64) -> PyResult<Self> {
        Ok(Self(LogarithmicProfile::iso16281(diameter, length)?))
    }

    /// Amplitude A [m].
    #[getter]
    fn amplitude(&self) -> f64 {
        self.0.amplitude()
    }

    /// Whole length [m].
    #[getter]
    fn length(&self) -> f64 {
        self.0.length()
    }

    /// Length of the straight part [m].
    #[getter]
    fn flat_length(&self) -> f64 {
        self.0.flat_length()
    }

    /// End factor f.
    #[getter]
    fn end_factor(&self) -> f64 {
        self.0.end_factor()
    }

    pub(super) fn __repr__(&self) -> String {
        format!(
            "LogarithmicProfile(amplitude={:?}, length={:?}, flat_length={:?}, end_factor={:?})",
            self.amplitude(),
            self.length(),
            self.flat_length(),
            self.end_factor()
        )
    }

    fn __hash__(&self) -> u64 {
        hash(&self.__repr__())
    }

    fn __getnewargs__(&self) -> (f64, f64, f64, f64) {
        (
            self.amplitude(),
            self.length(),
            self.flat_length(),
            self.end_factor(),
        )
    }
}

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
        Ok(Self(SampledProfile::new(
            &list("x", x)?,
            &list("drop", drop)?,
        )?))
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

    pub(super) fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let line = |k: usize| array_repr(py, self.0.samples().map(|s| s[k]).collect::<Array1<_>>());
        Ok(format!("SampledProfile(x={}, drop={})", line(0)?, line(1)?))
    }

    fn __getnewargs__<'py>(&self, py: Python<'py>) -> PyResult<(Line<'py>, Line<'py>)> {
        Ok((self.x(py)?, self.drop(py)?))
    }
}

type Line<'py> = Bound<'py, PyArray1<f64>>;

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
