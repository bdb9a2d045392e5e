//! Linearisations of a solution, made again whenever Python asks.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::contact::Solution;
use crate::error::Result;
use crate::gradient::{LinearOptions, Linearisation};
use crate::model::surface::Surface;
use crate::python::background::{self, Caller};
use crate::python::shapes::{PyShape, Shape, shape};

/// The call of a method of `nacre.Solution` that makes a value, for pickles.
pub(super) struct Made {
    solution: Py<PyAny>,
    method: &'static str,
    arguments: Py<PyTuple>,
    keywords: Py<PyDict>,
}

impl Made {
    /// Callable and arguments that make the value again.
    pub(super) fn reduced<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let first = PyTuple::new(py, [self.method])?.add(self.arguments.bind(py))?;
        let caller = py.import("operator")?.getattr("methodcaller")?;
        let caller = caller.call(first.cast_into::<PyTuple>()?, Some(self.keywords.bind(py)))?;
        Ok((caller, PyTuple::new(py, [self.solution.bind(py)])?))
    }
}

/// What a linearisation is made of again, for steps that are asked for later.
#[derive(Clone)]
pub(super) struct Linear {
    pub(super) solution: Arc<Solution>,
    pub(super) shape: Option<Shape>,
    tolerance: f64,
    /// The solution as an object of Python.
    object: Arc<Py<PyAny>>,
}

impl Linear {
    /// A solution with the shape that is given, or that it was made with.
    pub(super) fn new(
        (object, solution): (&Bound<'_, PyAny>, &Arc<Solution>),
        known: Option<&Shape>,
        given: Option<&Bound<'_, PyAny>>,
        tolerance: f64,
    ) -> PyResult<Self> {
        let given = given.map(|given| Ok::<_, PyErr>(shape(given)?.get().0.clone())).transpose()?;
        Ok(Self {
            solution: Arc::clone(solution),
            shape: given.or_else(|| known.cloned()),
            tolerance,
            object: Arc::new(object.clone().unbind()),
        })
    }

    /// Result of `work` on the linearisation, in the background, where Ctrl-C stops it.
    pub(super) fn run<T: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&Linearisation) -> Result<T> + Send + 'static,
    ) -> PyResult<T> {
        let Self { solution, shape, tolerance, .. } = self.clone();
        let found = background::run(py, None, move |caller: &mut Caller<()>| {
            let shape = shape.as_ref().map(|shape| shape as &dyn Surface);
            let options = LinearOptions { tolerance, watch: Some(&|| caller.go_on()) };
            work(&Linearisation::plan(&solution, shape, &options)?)
        })?;
        Ok(found?)
    }

    /// The call of `method` with `arguments` that makes a value.
    pub(super) fn made<'py>(
        &self,
        py: Python<'py>,
        method: &'static str,
        arguments: Bound<'py, PyTuple>,
    ) -> PyResult<Made> {
        let keywords = PyDict::new(py);
        let shape = self.shape.as_ref().map(|shape| Py::new(py, PyShape(shape.clone())));
        keywords.set_item("shape", shape.transpose()?)?;
        keywords.set_item("tolerance", self.tolerance)?;
        Ok(Made {
            solution: self.object.clone_ref(py),
            method,
            arguments: arguments.unbind(),
            keywords: keywords.unbind(),
        })
    }
}
