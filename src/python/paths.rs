//! Numbers by path, such as `body.layers[0].material.young`: in arguments by name, in values of nacre, and in the tables of
//! case files. An item of a list has a number, `layers[0]` or `layers.0`, or a name that it alone holds, `layers.DLC`.

use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyLookupError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyInt, PyList, PyTuple};

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

/// Key of the part with that name, or of one whose own parts are meant.
fn key<'py>(parts: &Bound<'py, PyDict>, name: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
    let number = name.parse::<usize>().ok().filter(|number| number.to_string() == name);
    let number = number.into_bound_py_any(parts.py())?;
    for key in [name.into_bound_py_any(parts.py())?, number, INNER.into_bound_py_any(parts.py())?] {
        if parts.contains(&key)? {
            return Ok(Some(key));
        }
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
    Ok(named.pop().filter(|_| named.is_empty()))
}

/// Objects on the way along a path, each with its parts and the key of the next one; and what is at the end.
type Way<'py> = Vec<(Bound<'py, PyAny>, Bound<'py, PyDict>, Bound<'py, PyAny>)>;

fn way<'py>(mut here: Bound<'py, PyAny>, path: &str) -> PyResult<(Way<'py>, Bound<'py, PyAny>)> {
    let mut way = Vec::new();
    for name in path.replace('[', ".").replace(']', "").split('.') {
        let missing = || PyLookupError::new_err(name.to_owned());
        let mut is_inner = true;
        while is_inner {
            let parts = parts(&here)?.ok_or_else(missing)?;
            let key = key(&parts, name)?.ok_or_else(missing)?;
            is_inner = key.eq(INNER)?;
            let next = parts.as_any().get_item(&key)?;
            way.push((here, parts, key));
            here = next;
        }
    }
    Ok((way, here))
}

/// The number, or whatever else is at a path. A `LookupError` names the first part of the path that is not there.
#[pyfunction]
pub(super) fn at<'py>(object: Bound<'py, PyAny>, path: &str) -> PyResult<Bound<'py, PyAny>> {
    Ok(way(object, path)?.1)
}

/// A new object with another value at a path, with the errors of [`at`] and of the constructors of what holds it.
#[pyfunction]
pub(super) fn with_value<'py>(
    object: Bound<'py, PyAny>,
    path: &str,
    value: Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    way(object, path)?.0.into_iter().rev().try_fold(value, |part, (object, parts, key)| {
        parts.set_item(key, part)?;
        let all = parts.values();
        Ok(if object.hasattr("_arguments")? {
            let (make, _): Reduced = object.call_method0("__reduce__")?.extract()?;
            if make.hasattr("keywords")? {
                make.call((), Some(&parts))?
            } else {
                make.call1(all.to_tuple())?
            }
        } else if object.cast::<PyDict>().is_ok() {
            parts.into_any()
        } else if object.cast::<PyTuple>().is_ok() {
            all.to_tuple().into_any()
        } else {
            all.into_any()
        })
    })
}

/// All numbers in an object by path, in their order.
#[pyfunction]
pub(super) fn numbers(object: &Bound<'_, PyAny>) -> PyResult<Vec<(String, f64)>> {
    let mut numbers = Vec::new();
    collect(object, String::new(), &mut numbers)?;
    Ok(numbers)
}

fn collect(
    object: &Bound<'_, PyAny>,
    path: String,
    numbers: &mut Vec<(String, f64)>,
) -> PyResult<()> {
    if let Some(parts) = parts(object)? {
        for (key, part) in parts {
            let inside = match key.extract::<&str>() {
                Ok(INNER) => path.clone(),
                Ok(name) if path.is_empty() => name.to_owned(),
                Ok(name) => format!("{path}.{name}"),
                Err(_) => format!("{path}[{key}]"),
            };
            collect(&part, inside, numbers)?;
        }
    } else if let Ok(number) = object.extract()
        && object.cast::<PyBool>().is_err()
    {
        numbers.push((path, number));
    }
    Ok(())
}
