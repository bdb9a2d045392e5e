//! Derivatives of solved contacts, for `nacre.types.Gradient` and `nacre.types.Direction`.

use std::sync::Arc;

use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

use super::arguments::{Real, read_only, real_matrix};
use super::background::{self, Caller};
use super::data::fitting;
use super::shapes::{Shape, shape};
use super::solved::PySolved;
use crate::contact::Solution;
use crate::error::Result;
use crate::gradient::{LinearOptions, Linearisation, Output};
use crate::model::surface::Surface;

/// A linearisation, made again whenever Python asks.
#[pyclass(name = "Linear", module = "nacre._core", frozen)]
pub(super) struct PyLinear {
    solution: Arc<Solution>,
    shape: Option<Shape>,
    tolerance: f64,
}

/// Value, derivatives by path, margin, warnings, and the derivative with respect to the gap of each cell.
type Derivatives<'py> = (f64, Vec<(String, f64)>, f64, Vec<String>, Bound<'py, PyArray2<f64>>);

/// Changes of the pressure, of the approach and of the tilts, and the largest step.
type Change<'py> = (Bound<'py, PyArray2<f64>>, f64, (f64, f64), f64);

impl PyLinear {
    /// Result of `work` on the linearisation, in the background, where Ctrl-C stops it.
    fn run<T: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&Linearisation) -> Result<T> + Send + 'static,
    ) -> PyResult<T> {
        let (solution, shape) = (Arc::clone(&self.solution), self.shape.clone());
        let tolerance = self.tolerance;
        let outcome = background::run(py, None, move |caller: &mut Caller<()>| {
            let shape = shape.as_ref().map(|shape| shape as &dyn Surface);
            let options = LinearOptions { tolerance, watch: Some(&|| caller.go_on()) };
            work(&Linearisation::plan(&solution, shape, &options)?)
        })?;
        Ok(outcome?)
    }
}

#[pymethods]
impl PyLinear {
    #[new]
    fn new(
        solved: &Bound<'_, PySolved>,
        shape: Option<&Bound<'_, PyAny>>,
        tolerance: Real,
    ) -> PyResult<Self> {
        let shape = shape.map(|object| Ok::<_, PyErr>(self::shape(object)?.get().0.clone()));
        Ok(Self {
            solution: Arc::clone(&solved.get().0),
            shape: shape.transpose()?,
            tolerance: tolerance.0,
        })
    }

    /// Derivatives of outputs, each described by a word or a dict or given as weights of the pressures.
    fn gradients<'py>(
        &self,
        py: Python<'py>,
        outputs: Vec<Bound<'py, PyAny>>,
        wrt: Option<Vec<String>>,
    ) -> PyResult<Vec<Derivatives<'py>>> {
        let parsed = outputs.iter().map(|output| {
            if output.is_instance_of::<PyString>() || output.is_instance_of::<PyDict>() {
                return fitting("output", output);
            }
            Ok(Output::Weighted(real_matrix("cotangent", output)?))
        });
        let parsed = parsed.collect::<PyResult<Vec<_>>>()?;
        let gradients = self.run(py, move |plan| {
            let wrt: Option<Vec<&str>> =
                wrt.as_ref().map(|paths| paths.iter().map(String::as_str).collect());
            plan.gradients(&parsed, wrt.as_deref())
        })?;
        let parts = |gradient: crate::gradient::Gradient| {
            let values = gradient.values.into_iter();
            let values = values.map(|(parameter, value)| (parameter.to_string(), value)).collect();
            Ok((
                gradient.value,
                values,
                gradient.margin,
                gradient.warnings,
                read_only(py, gradient.gap)?,
            ))
        };
        gradients.into_iter().map(parts).collect()
    }

    /// Largest change of each parameter for which the contact keeps its cells.
    fn valid_steps(&self, py: Python<'_>, paths: Vec<String>) -> PyResult<Vec<f64>> {
        self.run(py, move |plan| paths.iter().map(|path| plan.valid_step(path)).collect())
    }

    /// Change along rates of parameters, by path, and of the undeformed gap.
    fn jvp<'py>(
        &self,
        py: Python<'py>,
        rates: Vec<(String, f64)>,
        gap: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Change<'py>> {
        let gap = gap.map(|gap| real_matrix("gap", gap)).transpose()?;
        let change = self.run(py, move |plan| {
            let rates: Vec<(&str, f64)> =
                rates.iter().map(|(path, rate)| (path.as_str(), *rate)).collect();
            plan.jvp(&rates, gap.as_deref())
        })?;
        Ok((
            read_only(py, change.pressure)?,
            change.approach,
            change.tilt.into(),
            change.valid_step,
        ))
    }
}
