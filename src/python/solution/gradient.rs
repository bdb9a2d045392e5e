//! `nacre.Gradient`: derivatives of outputs of a solved contact.

use numpy::PyArray2;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};

use super::linear::{Linear, Made};
use super::output::{name, output};
use crate::error::Result;
use crate::gradient::{Gradient, Output};
use crate::python::arguments::{read_only, real_matrix};

/// Derivatives of one output of a solved contact, by the paths of the parameters.
///
/// It is a mapping: ``gradient["body.layers[0].material.young"]`` is the derivative per unit of that
/// parameter. `Solution.gradient` makes it.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
/// >>> gradient = solution.gradient("approach")
/// >>> round(gradient["load"] * 10.0 / gradient.value, 2)  # δ ~ W^(2/3)
/// 0.67
/// >>> list(gradient)[:2]
/// ['body.substrate.young', 'body.substrate.poisson']
#[pyclass(name = "Gradient", module = "nacre.types", frozen, mapping)]
pub(in crate::python) struct PyGradient {
    gradient: Gradient,
    linear: Linear,
    made: Made,
}

impl Linear {
    /// Gradients of `outputs`, which `method` makes of as many `objects`, with respect to the parameters `wrt`.
    fn gradients(
        &self,
        py: Python<'_>,
        (method, objects): (&'static str, Vec<Bound<'_, PyAny>>),
        outputs: Vec<Output>,
        wrt: Option<Vec<String>>,
    ) -> PyResult<Vec<PyGradient>> {
        let asked = wrt.clone();
        let found = self.run(py, move |plan| {
            let wrt: Option<Vec<&str>> =
                wrt.as_ref().map(|paths| paths.iter().map(String::as_str).collect());
            plan.gradients(&outputs, wrt.as_deref())
        })?;
        let made = |(gradient, object): (Gradient, Bound<'_, PyAny>)| {
            let arguments = (object, asked.clone()).into_pyobject(py)?;
            Ok(PyGradient {
                gradient,
                linear: self.clone(),
                made: self.made(py, method, arguments)?,
            })
        };
        found.into_iter().zip(objects).map(made).collect()
    }

    /// Gradient of one output, or a list of those of a list.
    pub(super) fn gradient<'py>(
        &self,
        py: Python<'py>,
        outputs: &Bound<'py, PyAny>,
        wrt: Option<Vec<String>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        const METHOD: &str = "gradient";
        if let Ok(list) = outputs.cast::<PyList>() {
            let objects: Vec<_> = list.iter().collect();
            let parsed = objects.iter().map(output).collect::<PyResult<_>>()?;
            let found = self.gradients(py, (METHOD, objects), parsed, wrt)?;
            let found = found.into_iter().map(|one| Py::new(py, one));
            return Ok(PyList::new(py, found.collect::<PyResult<Vec<_>>>()?)?.into_any());
        }
        let parsed = vec![output(outputs)?];
        let mut found = self.gradients(py, (METHOD, vec![outputs.clone()]), parsed, wrt)?;
        Ok(Bound::new(py, found.remove(0))?.into_any())
    }

    /// Gradient of Σ `cotangent` p.
    pub(super) fn vjp(
        &self,
        py: Python<'_>,
        cotangent: &Bound<'_, PyAny>,
        wrt: Option<Vec<String>>,
    ) -> PyResult<PyGradient> {
        let weights = vec![Output::Weighted(real_matrix("cotangent", cotangent)?)];
        let mut found = self.gradients(py, ("vjp", vec![cotangent.clone()]), weights, wrt)?;
        Ok(found.remove(0))
    }
}

impl PyGradient {
    fn paths(&self) -> Vec<String> {
        self.gradient.values.iter().map(|(parameter, _)| parameter.to_string()).collect()
    }
}

#[pymethods]
impl PyGradient {
    /// Name of the output.
    #[getter]
    fn output(&self) -> String {
        name(&self.gradient.output)
    }

    /// Value of the output.
    #[getter]
    fn value(&self) -> f64 {
        self.gradient.value
    }

    /// Derivative with respect to the undeformed gap of each cell ``(nx, ny)``; heights count ``-gap``.
    #[getter]
    fn gap<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        read_only(py, self.gradient.gap.clone())
    }

    /// How far the contact is from one of other cells, where derivatives jump.
    ///
    /// The smaller of the least pressure in contact over the peak, and of the least gap outside over the
    /// largest displacement. It falls with the square of the cells and is 1e-5 or so as a rule.
    #[getter]
    fn margin(&self) -> f64 {
        self.gradient.margin
    }

    /// What makes the derivatives doubtful: a list of sentences, empty as a rule.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.gradient.warnings.clone()
    }

    /// Largest change of each parameter, of either sign, for which the contact keeps its cells.
    ///
    /// To first order: no pressure, and no gap up to two cells around the contact, changes its sign. Each
    /// step takes a linear solve, at the time when it is asked for.
    #[getter]
    fn valid_step<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let paths: Vec<String> =
            self.paths().into_iter().filter(|path| path != "friction").collect();
        let steps = self.linear.run(py, move |plan| {
            let step = |path: String| Ok((plan.valid_step(&path)?, path));
            paths.into_iter().map(step).collect::<Result<Vec<_>>>()
        })?;
        let found = PyDict::new(py);
        for (step, path) in steps {
            found.set_item(path, step)?;
        }
        Ok(found)
    }

    /// Paths of the parameters.
    fn keys(&self) -> Vec<String> {
        self.paths()
    }

    /// Derivatives, in the order of the paths.
    fn values(&self) -> Vec<f64> {
        self.gradient.values.iter().map(|(_, value)| *value).collect()
    }

    /// Paths and derivatives.
    fn items(&self) -> Vec<(String, f64)> {
        self.paths().into_iter().zip(self.values()).collect()
    }

    fn __getitem__(&self, path: &str) -> PyResult<f64> {
        let known = || self.paths().join(", ");
        let message = || PyKeyError::new_err(format!("{path:?} is none of {}", known()));
        self.gradient.get(path).ok_or_else(message)
    }

    fn __contains__(&self, path: &str) -> bool {
        self.gradient.get(path).is_some()
    }

    fn __len__(&self) -> usize {
        self.gradient.values.len()
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        PyList::new(py, self.paths())?.call_method0("__iter__")
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.gradient == other.gradient
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        self.made.reduced(py)
    }

    fn __repr__(&self) -> String {
        let items = self.items().into_iter().map(|(path, value)| format!("{path}: {value:.6e}"));
        let items = items.collect::<Vec<_>>().join(", ");
        format!("Gradient({} = {:.6e}, {{{items}}})", self.output(), self.gradient.value)
    }
}
