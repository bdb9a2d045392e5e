//! `nacre.creep_coefficients`.

use pyo3::prelude::*;

use crate::compliance::response::Body;
use crate::friction;
use crate::model::body::HalfSpace;
use crate::python::arguments::{Pair, count};
use crate::python::background::{self, Caller};
use crate::python::bodies::body;
use crate::python::data::text;

fn cells(given: &Bound<'_, PyAny>) -> PyResult<usize> {
    count("cells", 8, given)
}

/// JSON text of Kalker's linear coefficients of two bodies with any layers; `nacre.creep_coefficients`.
#[pyfunction]
pub(in crate::python) fn creep_coefficients(
    py: Python<'_>,
    #[pyo3(from_py_with = body)] body: HalfSpace,
    counterbody: Option<&Bound<'_, PyAny>>,
    semi_axes: Pair,
    #[pyo3(from_py_with = cells)] cells: usize,
) -> PyResult<String> {
    let counterbody = counterbody.map(crate::python::bodies::body).transpose()?.map(Body::from);
    let Pair(axes) = semi_axes;
    let found = background::run(py, None, move |caller: &mut Caller<()>| {
        let mut watch = || caller.ask(|| ());
        friction::creep_coefficients(body, counterbody, axes, Some(cells), Some(&mut watch))
    })??;
    text(&found)
}
