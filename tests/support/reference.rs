//! Reference data under `tests/data`; each file describes itself.

use std::fs;

use serde_json::Value;

/// Cases of a reference file.
pub(crate) fn cases(name: &str) -> Vec<Value> {
    list(&read(name), "cases").clone()
}

/// A reference file.
pub(crate) fn read(name: &str) -> Value {
    let path = format!("{}/tests/data/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// List of numbers `value[key]`.
pub(crate) fn list<'a>(value: &'a Value, key: &str) -> &'a Vec<Value> {
    let found = value[key].as_array();
    found.unwrap_or_else(|| panic!("no list {key:?} in {value}"))
}

/// Number `value[key]`, which may be written as text.
pub(crate) fn number(value: &Value, key: &str) -> f64 {
    float(&value[key]).unwrap_or_else(|| panic!("no number {key:?} in {value}"))
}

/// A number, which may be written as text.
pub(crate) fn float(value: &Value) -> Option<f64> {
    value.as_f64().or_else(|| value.as_str()?.parse().ok())
}
