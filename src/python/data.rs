//! Results as fields, in which they cross to Python, and as JSON text of files, in which they come back.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pythonize::{depythonize, pythonize};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::friction::{CreepCoefficients, FrictionReport};
use crate::stress::{InterfaceSummary, LayerSummary, StressSummary};

/// A value that is numbers, words, tuples, lists and dicts of fields in Python.
pub(super) struct Plain<T>(pub(super) T);

impl<'py, T: Serialize> IntoPyObject<'py> for Plain<T> {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        Ok(pythonize(py, &self.0)?)
    }
}

/// Value that the JSON `text` describes; `kind` names it in the error.
///
/// # Errors
/// A `ValueError` if a field is missing, unknown, or holds a value that does not fit.
pub(super) fn read<T: DeserializeOwned>(kind: &str, text: &str) -> PyResult<T> {
    serde_json::from_str(text).map_err(|error| {
        let message = error.to_string();
        let message = message.split(" at line ").next().unwrap_or_default();
        let is_field = message.starts_with("missing field") || message.starts_with("unknown field");
        let key = key_before(text, error.column()).filter(|_| !is_field);
        let place = key.map(|key| format!("the value of the key {key:?} does not fit: "));
        PyValueError::new_err(format!("{kind}: {}{message}", place.unwrap_or_default()))
    })
}

/// Value that words, numbers, lists and dicts of Python describe; `kind` names it in the error.
///
/// # Errors
/// A `ValueError` if a field is missing, unknown, or holds a value that does not fit.
pub(super) fn fitting<T: DeserializeOwned>(kind: &str, value: &Bound<'_, PyAny>) -> PyResult<T> {
    depythonize(value).map_err(|error| PyValueError::new_err(format!("{kind}: {error}")))
}

/// The last key of JSON text before a column.
fn key_before(text: &str, column: usize) -> Option<&str> {
    let (before, _) = text.get(..column)?.rsplit_once("\":")?;
    Some(before.rsplit_once('"')?.1)
}

/// A summary and its warnings.
#[derive(Serialize, Deserialize)]
#[serde(from = "StressSummary")]
pub(super) struct SummaryWithWarnings {
    #[serde(flatten)]
    summary: StressSummary,
    warnings: Vec<String>,
}

impl From<StressSummary> for SummaryWithWarnings {
    fn from(summary: StressSummary) -> Self {
        Self { warnings: summary.warnings(), summary }
    }
}

/// Fields of the result of a `kind` that JSON text of a file describes, checked.
#[pyfunction]
pub(super) fn checked<'py>(py: Python<'py>, kind: &str, text: &str) -> PyResult<Bound<'py, PyAny>> {
    let fields = match kind {
        "CreepCoefficients" => fields::<CreepCoefficients>,
        "StressSummary" => fields::<SummaryWithWarnings>,
        "LayerStress" => fields::<LayerSummary>,
        "InterfaceStress" => fields::<InterfaceSummary>,
        "FrictionReport" => fields::<FrictionReport>,
        _ => return Err(PyValueError::new_err(format!("no result of nacre is a {kind:?}"))),
    };
    fields(py, kind, text)
}

fn fields<'py, T: Serialize + DeserializeOwned>(
    py: Python<'py>,
    kind: &str,
    text: &str,
) -> PyResult<Bound<'py, PyAny>> {
    Plain(read::<T>(kind, text)?).into_pyobject(py)
}
