//! Named state: results as dictionaries of plain data, which pickles and files keep.
//!
//! A dictionary holds the fields of a result by their names. Under "format" it holds the number of the
//! format, under "nacre" the version that wrote it and under "kind" the name of the class. Materials,
//! layers, bodies and grids stand in it as `nacre.values` encodes them: by the call that makes them.

use ndarray::{Array, Dimension};
use pyo3::conversion::FromPyObjectOwned;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use super::arguments::{Repr, read_only, real_array};

/// Number of the format.
pub(super) const FORMAT: u64 = 1;

/// A result that has a named state.
pub(super) trait State: Sized {
    /// Name of the Python class.
    const KIND: &'static str;

    /// Writes every field.
    fn write(&self, fields: &Fields) -> PyResult<()>;

    /// Reads every field that [`State::write`] wrote.
    fn read(fields: &Fields) -> PyResult<Self>;
}

/// Named state of `value`.
pub(super) fn to_dict<'py, S: State>(py: Python<'py>, value: &S) -> PyResult<Bound<'py, PyDict>> {
    let fields = Fields::new(py, S::KIND);
    fields.set("format", FORMAT)?;
    fields.set("nacre", env!("CARGO_PKG_VERSION"))?;
    fields.set("kind", S::KIND)?;
    value.write(&fields)?;
    Ok(fields.dict)
}

/// Result with the named state `data`.
///
/// # Errors
/// A `ValueError` if the state is of a newer format or of another kind, or if a key is missing, unknown or
/// holds a value that does not fit.
pub(super) fn from_dict<S: State>(data: &Bound<'_, PyAny>) -> PyResult<S> {
    let fields = Fields::of(S::KIND, data)?;
    let (format, version): (u64, String) = (fields.get("format")?, fields.get("nacre")?);
    if format > FORMAT {
        return Err(PyValueError::new_err(format!(
            "this {} has format {format}, written by nacre {version}; nacre {} reads formats up to \
             {FORMAT}: install a newer version",
            S::KIND,
            env!("CARGO_PKG_VERSION"),
        )));
    }
    let kind: String = fields.get("kind")?;
    if kind != S::KIND {
        return Err(PyValueError::new_err(format!(
            "the key \"kind\" must be {:?}, got {kind:?}",
            S::KIND
        )));
    }
    fields.read(S::read)
}

/// What `__reduce__` returns: `from_dict` of the class, and the named state.
pub(super) type Reduced<'py> = (Bound<'py, PyAny>, (Bound<'py, PyDict>,));

/// Pickled form of `value`.
pub(super) fn reduce<'py, S: State>(py: Python<'py>, value: &S) -> PyResult<Reduced<'py>> {
    let class = py.import("nacre._core")?.getattr(S::KIND)?;
    Ok((class.getattr("from_dict")?, (to_dict(py, value)?,)))
}

/// Fields of a state by their names, to be written or read. Each is read once.
pub(super) struct Fields<'py> {
    /// Place of the fields in the whole state, for messages.
    place: String,
    dict: Bound<'py, PyDict>,
}

impl<'py> Fields<'py> {
    fn new(py: Python<'py>, place: &str) -> Self {
        Self { place: place.into(), dict: PyDict::new(py) }
    }

    fn of(place: &str, data: &Bound<'py, PyAny>) -> PyResult<Self> {
        let dict = data.cast::<PyDict>().map_err(|_| {
            PyValueError::new_err(format!(
                "{place} must be a dict of named fields, got {}",
                Repr(data)
            ))
        })?;
        Ok(Self { place: place.into(), dict: dict.copy()? })
    }

    fn py(&self) -> Python<'py> {
        self.dict.py()
    }

    /// Writes a number, a text or a list of them.
    pub(super) fn set(&self, name: &str, value: impl IntoPyObject<'py>) -> PyResult<()> {
        self.dict.set_item(name, value)
    }

    /// Writes an array.
    pub(super) fn set_array<D: Dimension>(
        &self,
        name: &str,
        array: &Array<f64, D>,
    ) -> PyResult<()> {
        self.set(name, read_only(self.py(), array.clone())?)
    }

    /// Writes a material, layer, body or grid, or `None`.
    pub(super) fn set_part(&self, name: &str, part: impl IntoPyObject<'py>) -> PyResult<()> {
        let values = self.py().import("nacre.values")?;
        self.set(name, values.call_method1("encode", (part,))?)
    }

    /// Writes fields of their own, which `write` writes.
    pub(super) fn set_fields(
        &self,
        name: &str,
        write: impl FnOnce(&Fields<'py>) -> PyResult<()>,
    ) -> PyResult<()> {
        let fields = Fields::new(self.py(), name);
        write(&fields)?;
        self.set(name, fields.dict)
    }

    /// Writes the states of several results.
    pub(super) fn set_list<T>(
        &self,
        name: &str,
        items: &[T],
        write: impl Fn(&T, &Fields<'py>) -> PyResult<()>,
    ) -> PyResult<()> {
        let list = PyList::empty(self.py());
        for item in items {
            let fields = Fields::new(self.py(), name);
            write(item, &fields)?;
            list.append(fields.dict)?;
        }
        self.set(name, list)
    }

    fn take(&self, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let value = self.dict.get_item(name)?.ok_or_else(|| {
            PyValueError::new_err(format!("{}: the key {name:?} is missing", self.place))
        })?;
        self.dict.del_item(name)?;
        Ok(value)
    }

    fn refuse(&self, name: &str, value: &Bound<'py, PyAny>) -> PyErr {
        PyValueError::new_err(format!(
            "{}: the value of the key {name:?} does not fit: {}",
            self.place,
            Repr(value)
        ))
    }

    /// Reads a number, a text or a list of them.
    pub(super) fn get<T: FromPyObjectOwned<'py>>(&self, name: &str) -> PyResult<T> {
        let value = self.take(name)?;
        value.extract().map_err(|_| self.refuse(name, &value))
    }

    /// Reads a number, a text or a list of them; `None` where the key is missing, as in states that
    /// earlier versions wrote.
    pub(super) fn get_newer<T: FromPyObjectOwned<'py>>(&self, name: &str) -> PyResult<Option<T>> {
        match self.dict.contains(name)? {
            true => self.get(name),
            false => Ok(None),
        }
    }

    /// Reads an array; `None` where it is, or where the key is missing as in states that earlier versions
    /// wrote.
    pub(super) fn get_newer_array<D: Dimension>(
        &self,
        name: &str,
    ) -> PyResult<Option<Array<f64, D>>> {
        match self.dict.get_item(name)?.is_some_and(|value| !value.is_none()) {
            true => self.get_array(name).map(Some),
            false => self.get_newer::<Option<f64>>(name).map(|_| None),
        }
    }

    /// Reads an array, or nested lists of numbers.
    pub(super) fn get_array<D: Dimension>(&self, name: &str) -> PyResult<Array<f64, D>> {
        let value = self.take(name)?;
        let array = real_array(name, &value).map_err(|_| self.refuse(name, &value))?;
        let shape = array.shape().to_vec();
        array.into_dimensionality().map_err(|_| {
            PyValueError::new_err(format!(
                "{}: the array of the key {name:?} has the wrong number of dimensions: shape {shape:?}",
                self.place
            ))
        })
    }

    /// Reads a material, layer, body or grid, or `None`.
    pub(super) fn get_part<T: FromPyObjectOwned<'py>>(&self, name: &str) -> PyResult<T> {
        let data = self.take(name)?;
        let values = self.py().import("nacre.values")?;
        let value = values.call_method1("decode", (&data,))?;
        value.extract().map_err(|_| self.refuse(name, &data))
    }

    /// Reads fields of their own.
    pub(super) fn get_fields(&self, name: &str) -> PyResult<Fields<'py>> {
        Fields::of(&format!("{}.{name}", self.place), &self.take(name)?)
    }

    /// Reads fields of their own, or `None`.
    pub(super) fn get_optional(&self, name: &str) -> PyResult<Option<Fields<'py>>> {
        let data = self.take(name)?;
        let place = format!("{}.{name}", self.place);
        Ok(match data.is_none() {
            true => None,
            false => Some(Fields::of(&place, &data)?),
        })
    }

    /// Reads the states of several results.
    pub(super) fn get_list<T>(
        &self,
        name: &str,
        read: impl Fn(&Fields<'py>) -> PyResult<T>,
    ) -> PyResult<Vec<T>> {
        let value = self.take(name)?;
        let items: Vec<Bound<'py, PyAny>> =
            value.extract().map_err(|_| self.refuse(name, &value))?;
        let place = |number: usize| format!("{}.{name}[{number}]", self.place);
        let items = items
            .iter()
            .enumerate()
            .map(|(number, item)| Fields::of(&place(number), item)?.read(&read));
        items.collect()
    }

    /// Value that `read` reads from these fields.
    ///
    /// # Errors
    /// Errors of `read`, and a `ValueError` that names a key that `read` left.
    pub(super) fn read<T>(&self, read: impl FnOnce(&Self) -> PyResult<T>) -> PyResult<T> {
        let value = read(self)?;
        match self.dict.keys().iter().next() {
            None => Ok(value),
            Some(other) => Err(PyValueError::new_err(format!(
                "{}: the key {} is unknown",
                self.place,
                Repr(&other)
            ))),
        }
    }
}

/// Documentation of `to_dict`; an example follows it.
macro_rules! to_dict_docs {
    () => {
        "\
Named state, as plain data: numbers, text, lists, dictionaries and NumPy arrays.

Returns
-------
dict
    Fields by name. ``format`` is the number of the format, ``nacre`` the version that wrote it and
    ``kind`` the class. Bodies and grids stand in it as the calls that make them.

Examples
--------"
    };
}

/// Documentation of `from_dict`; an example follows it.
macro_rules! from_dict_docs {
    () => {
        "\
Value whose named state `to_dict` returned, to the bit.

Parameters
----------
data : dict
    Named state; lists may stand for arrays, as in JSON.

Returns
-------
object
    Value of this class.

Raises
------
ValueError
    If the format is newer than this version, or a key is missing, unknown or holds a wrong value.

Examples
--------"
    };
}

pub(super) use {from_dict_docs, to_dict_docs};
