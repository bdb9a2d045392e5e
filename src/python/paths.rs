//! Numbers by path, such as `body.layers[0].material.young`: in arguments by name, in values of nacre, and in the tables of
//! case files. An item of a list has a number, `layers[0]` or `layers.0`, or a name that it alone holds, `layers.DLC`.

use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyLookupError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyTuple};

use super::value::{INNER, Reduced};

/// Parts of an object by name or number; `None` where it has none.
fn parts<'py>(object: &Bound<'py, PyAny>) -> PyResult<Option<Bound<'py, PyDict>>> {
    if let Ok(table) = object.cast::<PyDict>() {
        return Ok(Some(table.copy()?));
    }
    if let Some(arguments) = object.getattr_opt("_arguments")? {
        return Ok(Some(arguments.call0()?.cast_into()?));
    }
    let is_line = matches!(object.getattr_opt("ndim")?, Some(axes) if axes.eq(1)?);
    if !(is_line || object.cast::<PyList>().is_ok() || object.cast::<PyTuple>().is_ok()) {
        return Ok(None);
    }
    let items = PyDict::new(object.py());
    for (number, item) in object.try_iter()?.enumerate() {
        items.set_item(number, item?)?;
    }
    Ok(Some(items))
}

/// An object as `object` is, of these parts.
fn made<'py>(object: &Bound<'py, PyAny>, parts: Bound<'py, PyDict>) -> PyResult<Bound<'py, PyAny>> {
    let all = parts.values();
    if object.cast::<PyDict>().is_ok() {
        Ok(parts.into_any())
    } else if object.hasattr("_arguments")? {
        let (make, _): Reduced = object.call_method0("__reduce__")?.extract()?;
        make.call1(all.to_tuple())
    } else if object.cast::<PyTuple>().is_ok() {
        Ok(all.to_tuple().into_any())
    } else {
        Ok(all.into_any())
    }
}

/// The next part on the way from an object.
struct Step<'py> {
    /// All parts of the object.
    parts: Bound<'py, PyDict>,
    key: Bound<'py, PyAny>,
    /// Whether paths do not name the part, but its own parts.
    inner: bool,
}

/// The step to the part of that name.
///
/// # Errors
/// A `LookupError` with the name where there is no such part.
fn step<'py>(object: &Bound<'py, PyAny>, name: &str) -> PyResult<Step<'py>> {
    let (py, missing) = (object.py(), || PyLookupError::new_err(name.to_owned()));
    let parts = parts(object)?.ok_or_else(missing)?;
    let is_number = name.bytes().all(|byte| byte.is_ascii_digit());
    let number = name.parse::<usize>().ok().filter(|_| is_number);
    let keys =
        [Some(name.into_bound_py_any(py)?), number.map(|n| n.into_bound_py_any(py)).transpose()?];
    for key in keys.into_iter().flatten() {
        if parts.contains(&key)? {
            return Ok(Step { parts, key, inner: false });
        }
    }
    if parts.contains(INNER)? {
        return Ok(Step { parts, key: INNER.into_bound_py_any(py)?, inner: true });
    }
    let mut named = Vec::new();
    for (key, item) in parts.iter().filter(|(key, _)| key.cast::<PyInt>().is_ok()) {
        let own = match item.cast::<PyDict>() {
            Ok(table) => table.get_item("name")?,
            Err(_) => item.getattr_opt("name")?,
        };
        if matches!(own, Some(own) if own.eq(name)?) {
            named.push(key);
        }
    }
    match (named.pop(), named.is_empty()) {
        (Some(key), true) => Ok(Step { parts, key, inner: false }),
        _ => Err(missing()),
    }
}

fn names(path: &str) -> Vec<String> {
    path.replace('[', ".").replace(']', "").split('.').map(str::to_owned).collect()
}

/// The number, or whatever else is at a path.
///
/// # Errors
/// A `LookupError` with the first part of the path that is not there.
#[pyfunction]
pub(super) fn at<'py>(object: Bound<'py, PyAny>, path: &str) -> PyResult<Bound<'py, PyAny>> {
    let (names, mut here) = (names(path), object);
    let mut left = &names[..];
    while let Some((name, rest)) = left.split_first() {
        let Step { parts, key, inner } = step(&here, name)?;
        here = parts.as_any().get_item(key)?;
        left = if inner { left } else { rest };
    }
    Ok(here)
}

/// The object with another value at a path; the object itself is left as it is.
///
/// # Errors
/// As [`at`], and those of the constructors of values with the new part.
#[pyfunction]
pub(super) fn with_value<'py>(
    object: &Bound<'py, PyAny>,
    path: &str,
    value: Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    changed(object, &names(path), value)
}

fn changed<'py>(
    object: &Bound<'py, PyAny>,
    path: &[String],
    value: Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let Some((name, rest)) = path.split_first() else {
        return Ok(value);
    };
    let Step { parts, key, inner } = step(object, name)?;
    let part = parts.as_any().get_item(&key)?;
    parts.set_item(key, changed(&part, if inner { path } else { rest }, value)?)?;
    made(object, parts)
}

/// All numbers in an object by path, in their order.
#[pyfunction]
pub(super) fn numbers(object: &Bound<'_, PyAny>) -> PyResult<Vec<(String, f64)>> {
    let mut found = Vec::new();
    collect(object, String::new(), &mut found)?;
    Ok(found)
}

fn collect(
    object: &Bound<'_, PyAny>,
    path: String,
    found: &mut Vec<(String, f64)>,
) -> PyResult<()> {
    let is_number = object.cast::<PyFloat>().is_ok() || object.cast::<PyInt>().is_ok();
    if is_number && object.cast::<PyBool>().is_err() {
        found.push((path, object.extract()?));
    } else if let Some(parts) = parts(object)? {
        for (key, part) in parts {
            let inside = match key.extract::<&str>() {
                Ok(INNER) => path.clone(),
                Ok(name) if path.is_empty() => name.to_owned(),
                Ok(name) => format!("{path}.{name}"),
                Err(_) => format!("{path}[{key}]"),
            };
            collect(&part, inside, found)?;
        }
    }
    Ok(())
}
