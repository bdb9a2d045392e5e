//! Stress below the surface: evaluated, summarised and planned for `nacre.stresses`.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::arguments::keywords::Keywords;
use super::arguments::{count, real_matrix};
use super::bodies::{PyHalfSpace, body};
use super::data::summary_text;
use super::grid::PyGrid;
use crate::model::body::HalfSpace;
use crate::stress::{Strengths, Stress, StressOptions, StressPlan, StressSummary, WatchedStress};

mod field;
mod keywords;

pub(super) use field::{checked_stress, stress_invariants};

use keywords::{depths, options, section, strengths, watched};

/// Fields of `nacre.types.Stress` for the stress of `body` that `evaluate` finds at the depths `z`.
pub(super) fn evaluated<'py>(
    z: &Bound<'py, PyAny>,
    keywords: &Keywords<'py>,
    body: &HalfSpace,
    evaluate: impl FnOnce(&[f64], WatchedStress) -> crate::Result<Stress> + Send + 'static,
) -> PyResult<Bound<'py, PyDict>> {
    let (depths, one) = depths(z)?;
    let mut options = options(keywords, body)?;
    options.threads = keywords.count("threads", 1)?;
    let [x, y] = section(keywords, &mut options)?;
    let progress = keywords.callable("progress")?;
    keywords.finish("keywords of a stress")?;
    let stress =
        watched(z.py(), progress, move |progress| evaluate(&depths, options.watched(progress)))?;
    field::fields(z.py(), stress, [one, x, y])
}

/// JSON text of the summary of the stress of `body` that `evaluate` finds.
pub(super) fn summarised(
    py: Python<'_>,
    keywords: &Keywords,
    body: &HalfSpace,
    evaluate: impl FnOnce(&Strengths, WatchedStress) -> crate::Result<StressSummary> + Send + 'static,
) -> PyResult<String> {
    let strengths = strengths(keywords, body)?;
    let mut options = options(keywords, body)?;
    options.threads = keywords.count("threads", 1)?;
    let progress = keywords.callable("progress")?;
    keywords.finish("keywords of a summary")?;
    let summary =
        watched(py, progress, move |progress| evaluate(&strengths, options.watched(progress)))?;
    summary_text(&summary)
}

/// The plan that `plan` makes on a number of threads.
pub(super) fn planned(
    py: Python<'_>,
    threads: Option<&Bound<'_, PyAny>>,
    plan: impl FnOnce(WatchedStress) -> crate::Result<StressPlan> + Send + 'static,
) -> PyResult<PyStressPlan> {
    let threads = threads.map(|given| count("threads", 1, given)).transpose()?;
    let options = StressOptions::with_threads(threads);
    let plan = watched(py, None, move |progress| plan(options.watched(progress)))?;
    Ok(PyStressPlan(Arc::new(plan)))
}

/// Fields of the stress under a pressure that is uniform over each cell; `nacre.stress`.
#[pyfunction]
pub(super) fn stress<'py>(
    #[pyo3(from_py_with = body)] body: HalfSpace,
    grid: PyGrid,
    pressure: &Bound<'py, PyAny>,
    z: &Bound<'py, PyAny>,
    asked: &Bound<'py, PyDict>,
) -> PyResult<Bound<'py, PyDict>> {
    let pressure = real_matrix("pressure", pressure)?;
    let keywords = Keywords::new(z.py(), Some(asked))?;
    let loaded = body.clone();
    evaluated(z, &keywords, &body, move |depths, options| {
        crate::stress::stress(&loaded, &grid.0, &pressure, depths, options)
    })
}

/// Handle of a plan, for `nacre.types.StressPlan`.
#[pyclass(name = "StressPlan", module = "nacre", frozen)]
pub(super) struct PyStressPlan(Arc<StressPlan>);

#[pymethods]
impl PyStressPlan {
    #[getter]
    fn body(&self) -> PyHalfSpace {
        PyHalfSpace(self.0.body().clone())
    }

    fn stress<'py>(
        &self,
        z: &Bound<'py, PyAny>,
        asked: &Bound<'py, PyDict>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let keywords = Keywords::new(z.py(), Some(asked))?;
        let plan = Arc::clone(&self.0);
        evaluated(z, &keywords, self.0.body(), move |depths, options| plan.stress(depths, options))
    }

    fn summary(&self, asked: &Bound<'_, PyDict>) -> PyResult<String> {
        let keywords = Keywords::new(asked.py(), Some(asked))?;
        let plan = Arc::clone(&self.0);
        summarised(asked.py(), &keywords, self.0.body(), move |strengths, options| {
            plan.summary(strengths, options)
        })
    }
}
