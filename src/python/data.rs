//! Results as JSON text, in which they cross to Python and back. `src/data.rs` says which fields they have.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::friction::{CreepCoefficients, FrictionReport};
use crate::stress::{InterfaceSummary, LayerSummary, StressSummary};

/// JSON text of `value`.
pub(super) fn text(value: &impl Serialize) -> PyResult<String> {
    serde_json::to_string(value).map_err(|error| PyValueError::new_err(error.to_string()))
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

/// The last key of JSON text before a column.
fn key_before(text: &str, column: usize) -> Option<&str> {
    let (before, _) = text.get(..column)?.rsplit_once("\":")?;
    Some(before.rsplit_once('"')?.1)
}

/// JSON text of a summary and its warnings.
pub(super) fn summary_text(summary: &StressSummary) -> PyResult<String> {
    #[derive(Serialize)]
    struct SummaryWithWarnings<'a> {
        #[serde(flatten)]
        summary: &'a StressSummary,
        warnings: Vec<String>,
    }
    text(&SummaryWithWarnings { summary, warnings: summary.warnings() })
}

/// JSON text of the result of a `kind` that `given` describes, read and written again: checked.
#[pyfunction]
pub(super) fn checked(kind: &str, given: &str) -> PyResult<String> {
    fn again<T: Serialize + DeserializeOwned>(kind: &str, json: &str) -> PyResult<String> {
        text(&read::<T>(kind, json)?)
    }
    match kind {
        "CreepCoefficients" => again::<CreepCoefficients>(kind, given),
        "StressSummary" => summary_text(&read(kind, given)?),
        "LayerStress" => again::<LayerSummary>(kind, given),
        "InterfaceStress" => again::<InterfaceSummary>(kind, given),
        "FrictionReport" => again::<FrictionReport>(kind, given),
        _ => Err(PyValueError::new_err(format!("no result of nacre is a {kind:?}"))),
    }
}
