//! Arrays and numbers from Python, checked, and arrays for Python.

use std::fmt;
use std::hash::{DefaultHasher, Hash, Hasher};

use ndarray::{Array2, ArrayD, Ix2};
use numpy::{
    IntoPyArray, PyArray, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray,
    get_array_module,
};
use pyo3::conversion::FromPyObjectOwned;
use pyo3::exceptions::{PyException, PyMemoryError, PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyBool, PyComplex, PyDict, PyFloat, PyList, PyTuple};
use serde::de::DeserializeOwned;
use serde::de::value::StrDeserializer;

mod labels;

use crate::numerics::parallel::too_little;
pub(super) use labels::Coordinate;
use labels::{axes, in_si};

/// A real number from Python, for arguments. An integer beyond the largest f64 becomes infinite, so that
/// whoever takes the number refuses it by name.
#[derive(Debug, Clone, Copy)]
pub(super) struct Real(pub(super) f64);

impl<'a, 'py> FromPyObject<'a, 'py> for Real {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(number) = object.cast_exact::<PyFloat>() {
            return Ok(Self(number.value()));
        }
        let in_si = if is_bool_or_complex(&object)? { None } else { in_si(&object)? };
        let Some(number) = in_si else {
            return Err(no_real_number(&object));
        };
        match number.extract::<f64>() {
            Ok(number) => Ok(Self(number)),
            Err(error) if error.is_instance_of::<PyOverflowError>(object.py()) => {
                let negative = number.lt(0)?;
                Ok(Self(if negative { f64::NEG_INFINITY } else { f64::INFINITY }))
            }
            Err(_) => Err(no_real_number(&object)),
        }
    }
}

fn no_real_number(object: &Bound<'_, PyAny>) -> PyErr {
    PyTypeError::new_err(format!("expected a real number, got {}", Repr(object)))
}

/// Whether `object` is a bool or a complex number of Python or NumPy, which would be made real.
fn is_bool_or_complex(object: &Bound<'_, PyAny>) -> PyResult<bool> {
    let Some(dtype) = object.getattr_opt("dtype")? else {
        return Ok(object.cast::<PyBool>().is_ok() || object.cast::<PyComplex>().is_ok());
    };
    match dtype.getattr_opt("kind")? {
        Some(kind) => Ok(kind.eq("b")? || kind.eq("c")?),
        None => Ok(false),
    }
}

/// Real number, for arguments with a default.
pub(super) fn real(object: &Bound<'_, PyAny>) -> PyResult<f64> {
    Ok(object.extract::<Real>()?.0)
}

/// Items of a list, a tuple, or an array.
pub(super) fn listed<'py>(object: &Bound<'py, PyAny>) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let mut object = plain("sequence", object.clone())?;
    if !object.is_instance_of::<PyList>() {
        let array = get_array_module(object.py())?.call_method1("asarray", (&object,))?;
        if array.getattr("ndim")?.eq(0)? {
            return Err(PyTypeError::new_err(format!(
                "expected a sequence, got {}",
                Repr(&object)
            )));
        }
        object = array.call_method0("tolist")?;
    }
    object.try_iter()?.collect()
}

/// The two items of a list, a tuple, or an array, for arguments.
pub(super) struct Two<'py>(pub(super) [Bound<'py, PyAny>; 2]);

impl<'a, 'py> FromPyObject<'a, 'py> for Two<'py> {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        let items = listed(&object)?;
        let count = items.len();
        items.try_into().map(Self).map_err(|_| {
            PyValueError::new_err(format!("expected a sequence of length 2 (got {count})"))
        })
    }
}

/// Two real numbers, for arguments.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair(pub(super) [f64; 2]);

impl<'a, 'py> FromPyObject<'a, 'py> for Pair {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        let two = object.extract::<Two>();
        let numbers = two.and_then(|Two([x, y])| Ok([real(&x)?, real(&y)?]));
        numbers.map(Self).map_err(|error| match error.is_instance_of::<PyValueError>(object.py()) {
            true => error,
            false => {
                PyTypeError::new_err(format!("expected a pair of numbers, got {}", Repr(&object)))
            }
        })
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

/// Argument as it is, or as an array without labels: one (y, x) of xarray or scipp becomes (x, y). What would be read
/// with another meaning is refused: masked arrays, numbers with a unit, other labels beside x or y.
#[pyfunction]
pub(super) fn plain<'py>(name: &str, value: Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    nested(name, value, 0)
}

/// Most dimensions of an array of NumPy, which refuses lists in more lists.
const MOST_AXES: usize = 64;

/// [`plain`] of what stands in lists of this `depth`.
fn nested<'py>(name: &str, value: Bound<'py, PyAny>, depth: usize) -> PyResult<Bound<'py, PyAny>> {
    if value.is_exact_instance_of::<PyFloat>() || value.cast_exact::<PyUntypedArray>().is_ok() {
        return Ok(value);
    }
    if value.is_exact_instance_of::<PyList>() || value.is_exact_instance_of::<PyTuple>() {
        if depth == MOST_AXES {
            return Ok(value);
        }
        let items = value.try_iter()?.map(|item| nested(name, item?, depth + 1));
        let items = items.collect::<PyResult<Vec<_>>>()?;
        return Ok(PyList::new(value.py(), items)?.into_any());
    }
    let mask = value.getattr_opt("mask")?;
    if mask.is_some_and(|mask| !mask.is_callable()) && value.hasattr("filled")? {
        return Err(PyTypeError::new_err(format!(
            "{name} must be a real array without a mask: fill the missing values first"
        )));
    }
    let Some(value) = in_si(&value)? else {
        return Err(PyTypeError::new_err(format!(
            "{name} must be a real number or array in SI units, got {:.60} with a unit: convert it, and pass its \
             magnitude",
            Repr(&value).to_string()
        )));
    };
    let Some(axes) = axes(&value)? else {
        return Ok(value);
    };
    let array = match value.getattr_opt("data")? {
        Some(data) => data,
        None => value.getattr("values")?,
    };
    let labelled = array.hasattr("dims")?;
    // The data may have a unit of its own.
    let array = plain(name, array)?;
    if labelled {
        return Ok(array);
    }
    let lower: Vec<String> = axes.iter().map(|axis| axis.to_lowercase()).collect();
    let lower: Vec<&str> = lower.iter().map(String::as_str).collect();
    match lower[..] {
        ["x", "y"] | ["y", "x"] => {
            for axis in &axes {
                if let Some(coordinate) = Coordinate::of(&value, axis)? {
                    coordinate.check_ascending(name)?;
                }
            }
            if lower[0] == "y" { array.getattr("T") } else { Ok(array) }
        }
        ["x" | "y"] => Ok(array),
        _ if lower.contains(&"x") || lower.contains(&"y") => Err(PyValueError::new_err(format!(
            "{name} must have the dimensions x and y, got {}",
            lower.join(", ")
        ))),
        _ => Ok(array),
    }
}

/// Array of f64 in C order with the numbers of `object`, which may have any real dtype, order and stride; what [`plain`]
/// refuses is refused.
///
/// Complex numbers, objects, text and a single bool raise a `TypeError` that names the argument.
pub(super) fn real_array(name: &str, object: &Bound<'_, PyAny>) -> PyResult<ArrayD<f64>> {
    let numpy = get_array_module(object.py())?;
    let ragged = |error: PyErr| match error.is_instance_of::<PyException>(object.py()) {
        true => PyTypeError::new_err(format!("{name} must be a real array: {error}")),
        false => error, // such as an interrupt
    };
    let array = plain(name, object.clone())?;
    let array = numpy.call_method1("asarray", (array,)).map_err(ragged)?;
    let dtype = array.getattr("dtype")?;
    let kind: String = dtype.getattr("kind")?.extract()?;
    if kind == "b" && array.getattr("ndim")?.eq(0)? {
        return Err(PyTypeError::new_err(format!(
            "{name} must be a real number, got {}",
            Repr(&array)
        )));
    }
    if !["i", "u", "f"].contains(&kind.as_str()) {
        return Err(PyTypeError::new_err(format!(
            "{name} must be a real array, got dtype {dtype}"
        )));
    }
    let options = [("dtype", "float64"), ("order", "C")].into_py_dict(object.py())?;
    let array = numpy.call_method("array", (array,), Some(&options))?;
    let array: PyReadonlyArrayDyn<f64> = array.cast::<PyArrayDyn<f64>>()?.readonly();
    Ok(array.as_array().to_owned())
}

/// Values of a function at the numbers of `object`, in their shape: a number or an array.
pub(super) fn mapped<'py>(
    name: &str,
    object: &Bound<'py, PyAny>,
    value: impl Fn(f64) -> f64,
) -> PyResult<Bound<'py, PyAny>> {
    shaped(object.py(), real_array(name, object)?.mapv(value))
}

/// Array for Python, or a number where it has no dimension.
pub(super) fn shaped(py: Python<'_>, values: ArrayD<f64>) -> PyResult<Bound<'_, PyAny>> {
    match values.ndim() {
        0 => Ok(values.sum().into_pyobject(py)?.into_any()),
        _ => Ok(values.into_pyarray(py).into_any()),
    }
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

/// The same for Python.
#[pyfunction(name = "real_array")]
pub(super) fn py_real_array<'py>(
    py: Python<'py>,
    name: &str,
    value: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    Ok(real_array(name, value)?.into_pyarray(py))
}

/// Integer of Python: an integer of Python or NumPy, or a whole real number; no bool.
#[pyfunction]
pub(super) fn integer<'py>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let refuse = || PyTypeError::new_err(format!("{name} must be an integer, got {}", Repr(value)));
    if is_bool_or_complex(value)? {
        return Err(refuse());
    }
    if let Ok(index) = value.call_method0("__index__") {
        return Ok(index);
    }
    let number = real(value).map_err(|_| refuse())?;
    if number.fract() != 0.0 {
        return Err(refuse());
    }
    PyFloat::new(value.py(), number).call_method0("__int__")
}

/// Integer that is at least `least`.
pub(super) fn count(name: &str, least: usize, value: &Bound<'_, PyAny>) -> PyResult<usize> {
    let refuse = || {
        let few = value.lt(least).unwrap_or(false);
        let least = format!("an integer of at least {least}");
        let requirement = if few { &least } else { "an integer that this machine can count to" };
        PyValueError::new_err(format!("{name} must be {requirement}, got {value}"))
    };
    integer(name, value)?.extract::<usize>().ok().filter(|&n| n >= least).ok_or_else(refuse)
}

/// An error where there is too little memory for `count` items of `each` bytes, of which the argument `name` says how many.
#[pyfunction]
pub(super) fn check_memory(name: &str, count: &Bound<'_, PyAny>, each: f64) -> PyResult<()> {
    let needed = count.extract::<f64>().unwrap_or(f64::INFINITY) * each;
    let Some([needed, available]) = too_little(needed as u64) else { return Ok(()) };
    let (needed, available) = (needed >> 20, available >> 20);
    Err(PyMemoryError::new_err(format!(
        "{name}, {count}, needs about {needed} MiB, and {available} MiB are available; take fewer"
    )))
}

/// So many numbers, each of which may be `None`.
#[pyfunction]
pub(super) fn vector(
    name: &str,
    length: usize,
    value: &Bound<'_, PyAny>,
) -> PyResult<Vec<Option<f64>>> {
    let kind = if length == 2 { "a pair of".into() } else { length.to_string() };
    let text = || format!("{name} must be {kind} numbers or None, got {}", Repr(value));
    let items = listed(value).map_err(|_| PyTypeError::new_err(text()))?;
    if items.len() != length {
        return Err(PyValueError::new_err(text()));
    }
    let numbers = items.iter().map(|item| item.extract::<Option<Real>>());
    let numbers = numbers.collect::<PyResult<Vec<_>>>();
    let numbers = numbers.map_err(|_| PyTypeError::new_err(text()))?;
    Ok(numbers.into_iter().map(|number| number.map(|number| number.0)).collect())
}

/// Pair of numbers, each of which may be `None`; no numbers where `value` is `None`.
pub(super) fn pair(name: &str, value: Option<&Bound<'_, PyAny>>) -> PyResult<[Option<f64>; 2]> {
    let Some(value) = value else {
        return Ok([None; 2]);
    };
    let numbers = vector(name, 2, value)?;
    Ok([numbers[0], numbers[1]])
}

/// Pair of truth values; `False` where `value` is `None`.
pub(super) fn flags(name: &str, value: Option<&Bound<'_, PyAny>>) -> PyResult<[bool; 2]> {
    let Some(value) = value else {
        return Ok([false; 2]);
    };
    let both = value.extract::<Two>();
    both.and_then(|Two([x, y])| Ok([x.extract()?, y.extract()?])).map_err(|_| {
        PyTypeError::new_err(format!("{name} must be a pair of bools, got {}", Repr(value)))
    })
}

/// Coordinates of the free ends of a body; it extends without end where one is `None`, or infinite on its own side.
pub(super) fn ends(value: Option<&Bound<'_, PyAny>>) -> PyResult<[Option<f64>; 2]> {
    let [low, high] = pair("ends", value)?;
    Ok([low.filter(|x| *x != f64::NEG_INFINITY), high.filter(|x| *x != f64::INFINITY)])
}

/// Real number, no bool.
#[pyfunction(name = "real")]
pub(super) fn number(name: &str, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    real(value).map_err(|_| {
        PyTypeError::new_err(format!("{name} must be a real number, got {}", Repr(value)))
    })
}

/// A keyword of a call, which `None` stands for where it was not given.
#[derive(FromPyObject)]
pub(super) struct Argument<'py>(pub(super) Bound<'py, PyAny>);

impl<'py> Argument<'py> {
    /// Argument that was given.
    pub(super) fn get(&self) -> Option<&Bound<'py, PyAny>> {
        Some(&self.0).filter(|value| !value.is_none())
    }

    /// Argument of type `T`, which `kind` describes in the error.
    pub(super) fn of<T: FromPyObjectOwned<'py>>(&self, name: &str, kind: &str) -> PyResult<T> {
        self.0.extract().map_err(|_| {
            PyTypeError::new_err(format!("{name} must be {kind}, got {}", Repr(&self.0)))
        })
    }

    /// Argument that `read` reads where it was given.
    pub(super) fn map<T>(
        &self,
        read: impl FnOnce(&Bound<'py, PyAny>) -> PyResult<T>,
    ) -> PyResult<Option<T>> {
        self.get().map(read).transpose()
    }

    /// Real number.
    pub(super) fn real(&self, name: &str) -> PyResult<f64> {
        number(name, &self.0)
    }

    /// Real number that may be missing.
    pub(super) fn number(&self, name: &str) -> PyResult<Option<f64>> {
        self.map(|value| number(name, value))
    }

    /// Pair of numbers, each of which may be missing.
    pub(super) fn pair(&self, name: &str) -> PyResult<[Option<f64>; 2]> {
        pair(name, self.get())
    }

    /// Truth value.
    pub(super) fn flag(&self, name: &str) -> PyResult<bool> {
        self.of(name, "a bool")
    }

    /// Value that a word stands for.
    pub(super) fn word<T: DeserializeOwned>(&self, name: &str) -> PyResult<T> {
        word(name, &self.of::<String>(name, "a str")?)
    }

    /// Integer of at least `least`, which may be missing.
    pub(super) fn count(&self, name: &str, least: usize) -> PyResult<Option<usize>> {
        self.map(|value| count(name, least, value))
    }

    /// Function, which may be missing.
    pub(super) fn callable(&self, name: &str) -> PyResult<Option<Py<PyAny>>> {
        self.map(|value| match value.is_callable() {
            true => Ok(value.clone().unbind()),
            false => {
                Err(PyTypeError::new_err(format!("{name} must be callable, got {}", Repr(value))))
            }
        })
    }
}

/// Value of the argument `name` that a word stands for.
pub(super) fn word<T: DeserializeOwned>(name: &str, word: &str) -> PyResult<T> {
    T::deserialize(StrDeserializer::<Unknown>::new(word)).map_err(|Unknown(words)| {
        let words: Vec<_> = words.iter().map(|word| format!("{word:?}")).collect();
        let listed = match words.split_last() {
            Some((last, others)) if !others.is_empty() => {
                format!("{} or {last}", others.join(", "))
            }
            _ => words.concat(),
        };
        PyValueError::new_err(format!("{name} must be {listed}, got {word:?}"))
    })
}

/// Words among which one was not.
#[derive(Debug, Clone, Copy)]
struct Unknown(&'static [&'static str]);

impl fmt::Display for Unknown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self, f)
    }
}

impl std::error::Error for Unknown {}

impl serde::de::Error for Unknown {
    fn custom<T: fmt::Display>(_: T) -> Self {
        Self(&[])
    }

    fn unknown_variant(_: &str, expected: &'static [&'static str]) -> Self {
        Self(expected)
    }
}

/// Hash of a value from its `repr`, which equal values share.
pub(super) fn hash(repr: &str) -> u64 {
    let mut hasher = DefaultHasher::new();
    repr.hash(&mut hasher);
    hasher.finish()
}

/// Displays a Python object by its `repr`, in messages.
pub(super) struct Repr<'a, 'py>(pub(super) &'a Bound<'py, PyAny>);

impl fmt::Display for Repr<'_, '_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
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
