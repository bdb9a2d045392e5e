//! Arrays and numbers from Python, checked, and arrays for Python.

use std::hash::{DefaultHasher, Hash, Hasher};

use ndarray::{Array2, ArrayD, Ix2};
use numpy::{IntoPyArray, PyArray, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn};
use pyo3::conversion::FromPyObjectOwned;
use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyComplex, PyDict, PyFloat, PyTuple, PyType};

pub(super) mod keywords;

/// A real number from Python, for arguments. An integer beyond the largest f64 becomes infinite, so that
/// whoever takes the number refuses it by name.
#[derive(Debug, Clone, Copy)]
pub(super) struct Real(pub(super) f64);

impl<'a, 'py> FromPyObject<'a, 'py> for Real {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        if object.cast_exact::<PyFloat>().is_err() && is_complex(&object)? {
            return Err(no_real_number(&object));
        }
        match object.extract::<f64>() {
            Ok(number) => Ok(Self(number)),
            Err(error) if error.is_instance_of::<PyOverflowError>(object.py()) => {
                let negative = object.lt(0)?;
                Ok(Self(if negative { f64::NEG_INFINITY } else { f64::INFINITY }))
            }
            Err(_) => Err(no_real_number(&object)),
        }
    }
}

fn no_real_number(object: &Bound<'_, PyAny>) -> PyErr {
    PyTypeError::new_err(format!("expected a real number, got {}", Repr(object)))
}

/// Whether `object` is a complex number of Python or NumPy, which the latter would make real.
fn is_complex(object: &Bound<'_, PyAny>) -> PyResult<bool> {
    let Some(dtype) = object.getattr_opt("dtype")? else {
        return Ok(object.cast::<PyComplex>().is_ok());
    };
    match dtype.getattr_opt("kind")? {
        Some(kind) => kind.eq("c"),
        None => Ok(false),
    }
}

/// Two real numbers from any sequence of Python, for arguments.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair(pub(super) [f64; 2]);

impl<'a, 'py> FromPyObject<'a, 'py> for Pair {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        match object.extract::<[Real; 2]>() {
            Ok([first, second]) => Ok(Self([first.0, second.0])),
            Err(error) if error.is_instance_of::<PyValueError>(object.py()) => Err(error),
            Err(_) => Err(PyTypeError::new_err(format!(
                "expected a pair of numbers, got {}",
                Repr(&object)
            ))),
        }
    }
}

/// Items of any iterable of Python, each of the class `T`, which `kind` names in the error.
pub(super) fn items<'py, T: FromPyObjectOwned<'py>>(
    name: &str,
    kind: &str,
    object: &Bound<'py, PyAny>,
) -> PyResult<Vec<T>> {
    let listed = object.try_iter().map_err(|_| {
        PyTypeError::new_err(format!("{name} must be a sequence of {kind}, got {}", Repr(object)))
    })?;
    listed
        .map(|item| {
            let item = item?;
            item.extract().map_err(|_| {
                PyTypeError::new_err(format!(
                    "{name} must be a sequence of {kind}, got {} in it",
                    Repr(&item)
                ))
            })
        })
        .collect()
}

/// Array of f64 with the numbers of `object`, which may have any real dtype, order and stride.
///
/// Complex numbers, objects and text raise a `TypeError` that names the argument.
pub(super) fn real_array(name: &str, object: &Bound<'_, PyAny>) -> PyResult<ArrayD<f64>> {
    let numpy = object.py().import("numpy")?;
    if object.is_instance(&numpy.getattr("ma")?.getattr("MaskedArray")?)? {
        return Err(PyTypeError::new_err(format!(
            "{name} must be a real array without a mask: fill the missing values first"
        )));
    }
    let ragged =
        |error: PyErr| PyTypeError::new_err(format!("{name} must be a real array: {error}"));
    let array = numpy.call_method1("asarray", (object,)).map_err(ragged)?;
    let dtype = array.getattr("dtype")?;
    let kind: String = dtype.getattr("kind")?.extract()?;
    if !["b", "i", "u", "f"].contains(&kind.as_str()) {
        return Err(PyTypeError::new_err(format!(
            "{name} must be a real array, got dtype {dtype}"
        )));
    }
    let array = array.call_method1("astype", ("float64",))?;
    let array: PyReadonlyArrayDyn<f64> = array.cast::<PyArrayDyn<f64>>()?.readonly();
    Ok(array.as_array().to_owned())
}

/// Values of a function at the numbers of `object`, in their shape: a number or an array.
pub(super) fn mapped<'py>(
    name: &str,
    object: &Bound<'py, PyAny>,
    value: impl Fn(f64) -> f64,
) -> PyResult<Bound<'py, PyAny>> {
    let values = real_array(name, object)?.mapv(value);
    if values.ndim() == 0 {
        return Ok(values.sum().into_pyobject(object.py())?.into_any());
    }
    Ok(values.into_pyarray(object.py()).into_any())
}

/// Array (nx, ny) of f64 with the numbers of `object`.
pub(super) fn real_matrix(name: &str, object: &Bound<'_, PyAny>) -> PyResult<Array2<f64>> {
    let array = real_array(name, object)?;
    let shape = array.shape().to_vec();
    array.into_dimensionality::<Ix2>().map_err(|_| {
        PyValueError::new_err(format!(
            "{name} must have two dimensions (nx, ny), got shape {shape:?}"
        ))
    })
}

/// NumPy array that takes over the memory of `array` and cannot be written.
pub(super) fn read_only<'py, D: ndarray::Dimension, T: numpy::Element>(
    py: Python<'py>,
    array: ndarray::Array<T, D>,
) -> PyResult<Bound<'py, PyArray<T, D>>> {
    let array = PyArray::from_owned_array(py, array);
    let flags = PyDict::new(py);
    flags.set_item("write", false)?;
    array.call_method("setflags", (), Some(&flags))?;
    Ok(array)
}

/// Integer that is at least `least`.
pub(super) fn count(name: &str, least: usize, value: &Bound<'_, PyAny>) -> PyResult<usize> {
    let refuse = || {
        let few = value.lt(least).unwrap_or(false);
        let least = format!("an integer of at least {least}");
        let asked = if few { &least } else { "an integer that this machine can count to" };
        PyValueError::new_err(format!("{name} must be {asked}, got {value}"))
    };
    let index = value.call_method0("__index__").map_err(|_| {
        PyTypeError::new_err(format!("{name} must be an integer, got {}", Repr(value)))
    })?;
    index.extract::<usize>().ok().filter(|&n| n >= least).ok_or_else(refuse)
}

/// Pair of numbers, each of which may be `None`; no numbers where `value` is `None`.
pub(super) fn pair(name: &str, value: Option<&Bound<'_, PyAny>>) -> PyResult<[Option<f64>; 2]> {
    let Some(value) = value else {
        return Ok([None; 2]);
    };
    let pair: [Option<Real>; 2] = value.extract().map_err(|_| {
        PyTypeError::new_err(format!(
            "{name} must be a pair of numbers or None, got {}",
            Repr(value)
        ))
    })?;
    Ok(pair.map(|number| number.map(|number| number.0)))
}

/// Pair of truth values; `False` where `value` is `None`.
pub(super) fn flags(name: &str, value: Option<&Bound<'_, PyAny>>) -> PyResult<[bool; 2]> {
    let Some(value) = value else {
        return Ok([false; 2]);
    };
    value.extract().map_err(|_| {
        PyTypeError::new_err(format!("{name} must be a pair of bools, got {}", Repr(value)))
    })
}

/// Python's word for a truth value.
pub(super) fn truth(value: bool) -> &'static str {
    if value { "True" } else { "False" }
}

/// Coordinates of the free ends of a body; it goes on where one is `None`, or infinite on its own side.
pub(super) fn ends(value: Option<&Bound<'_, PyAny>>) -> PyResult<[Option<f64>; 2]> {
    let [low, high] = pair("ends", value)?;
    Ok([low.filter(|x| *x != f64::NEG_INFINITY), high.filter(|x| *x != f64::INFINITY)])
}

/// Real number, or `None` where `value` is.
pub(super) fn number(name: &str, value: Option<&Bound<'_, PyAny>>) -> PyResult<Option<f64>> {
    let extract = |value: &Bound<'_, PyAny>| match value.extract::<Real>() {
        Ok(number) => Ok(number.0),
        Err(_) => {
            Err(PyTypeError::new_err(format!("{name} must be a real number, got {}", Repr(value))))
        }
    };
    value.map(extract).transpose()
}

/// Callable and arguments with which a pickle of any protocol makes an object of `class` again.
pub(super) fn remade<'py>(
    class: Bound<'py, PyType>,
    arguments: impl IntoPyObject<'py>,
    keywords: Bound<'py, PyDict>,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
    let py = class.py();
    let make = py.import("copyreg")?.getattr("__newobj_ex__")?;
    Ok((make, (class, arguments, keywords).into_pyobject(py)?))
}

/// Hash of a value from its `repr`, which equal values share.
pub(super) fn hash(repr: &str) -> u64 {
    let mut hasher = DefaultHasher::new();
    repr.hash(&mut hasher);
    hasher.finish()
}

/// Displays a Python object by its `repr`, in messages.
pub(super) struct Repr<'a, 'py>(pub(super) &'a Bound<'py, PyAny>);

impl std::fmt::Display for Repr<'_, '_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.0.repr() {
            Ok(repr) => write!(f, "{repr}"),
            Err(_) => write!(f, "a {}", self.0.get_type()),
        }
    }
}

/// Python text of an array: exact up to 1000 numbers, abbreviated beyond.
pub(super) fn array_repr<D: ndarray::Dimension>(
    py: Python<'_>,
    array: ndarray::Array<f64, D>,
) -> PyResult<String> {
    let short = array.len() <= 1000;
    let array = read_only(py, array)?;
    let text = if short { array.call_method0("tolist")?.repr()? } else { array.repr()? };
    Ok(text.to_string())
}

/// Arguments of a constructor whose values are numbers; one that is `None` is left out.
pub(super) fn numbers<'py>(
    py: Python<'py>,
    arguments: impl IntoIterator<Item = (&'static str, Option<f64>)>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = PyDict::new(py);
    for (name, value) in arguments {
        if let Some(value) = value {
            given.set_item(name, value)?;
        }
    }
    Ok(given)
}
