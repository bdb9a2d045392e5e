//! `nacre.Gradient` and `nacre.Direction`: derivatives of a solved contact.

use std::sync::Arc;

use ndarray::Array2;
use numpy::PyArray2;
use pyo3::exceptions::{PyKeyError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use super::output::{name, output};
use crate::contact::Solution;
use crate::error::Result;
use crate::gradient::{Direction, Gradient, LinearOptions, Linearisation, Output};
use crate::python::arguments::{read_only, real_matrix};
use crate::python::background::{self, Caller};
use crate::python::shapes::{Shape, shape};
use crate::surface::Surface;

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
#[pyclass(name = "Gradient", module = "nacre", frozen, mapping)]
pub(in crate::python) struct PyGradient {
    gradient: Gradient,
    linear: Linear,
}

/// What a linearisation is made of again, for steps that are asked for later.
#[derive(Clone)]
pub(super) struct Linear {
    pub(super) solution: Arc<Solution>,
    pub(super) shape: Option<Shape>,
    pub(super) options: LinearOptions,
}

impl Linear {
    /// A solution with the shape that is given, or that it was made with.
    pub(super) fn new(
        solution: &Arc<Solution>,
        known: Option<&Shape>,
        given: Option<&Bound<'_, PyAny>>,
        tolerance: f64,
    ) -> PyResult<Self> {
        let given = given
            .map(|given| Ok::<_, PyErr>(shape(given)?.get().0.clone()))
            .transpose()?;
        Ok(Self {
            solution: Arc::clone(solution),
            shape: given.or_else(|| known.cloned()),
            options: LinearOptions { tolerance },
        })
    }

    /// Result of `work` on the linearisation, in the background, where Ctrl-C stops it.
    fn run<T: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&Linearisation, &mut Caller<()>) -> Result<Option<T>> + Send + 'static,
    ) -> PyResult<T> {
        let Self {
            solution,
            shape,
            options,
        } = self.clone();
        let found = background::run(py, None, move |caller: &mut Caller<()>| {
            let shape = shape.as_ref().map(|shape| shape as &dyn Surface);
            let watch = &mut || caller.go_on();
            match Linearisation::plan_watched(&solution, shape, &options, watch)? {
                Some(plan) => work(&plan, caller),
                None => Ok(None),
            }
        })?;
        found?.ok_or_else(|| PyValueError::new_err("the linear solve was stopped"))
    }

    /// Gradients of `outputs` with respect to the parameters `wrt`.
    fn gradients(
        &self,
        py: Python<'_>,
        outputs: Vec<Output>,
        wrt: Option<Vec<String>>,
    ) -> PyResult<Vec<PyGradient>> {
        let found = self.run(py, move |plan, caller| {
            let wrt: Option<Vec<&str>> = wrt
                .as_ref()
                .map(|paths| paths.iter().map(String::as_str).collect());
            plan.gradients_watched(&outputs, wrt.as_deref(), &mut || caller.go_on())
        })?;
        let made = |gradient| PyGradient {
            gradient,
            linear: self.clone(),
        };
        Ok(found.into_iter().map(made).collect())
    }

    /// Gradient of one output, or a list of those of a list.
    pub(super) fn gradient<'py>(
        &self,
        py: Python<'py>,
        outputs: &Bound<'py, PyAny>,
        wrt: Option<Vec<String>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        if let Ok(list) = outputs.cast::<PyList>() {
            let parsed = list.iter().map(|one| output(&one));
            let found = self.gradients(py, parsed.collect::<PyResult<_>>()?, wrt)?;
            return Ok(PyList::new(
                py,
                found
                    .into_iter()
                    .map(|one| Py::new(py, one))
                    .collect::<PyResult<Vec<_>>>()?,
            )?
            .into_any());
        }
        let mut found = self.gradients(py, vec![output(outputs)?], wrt)?;
        Ok(Bound::new(py, found.remove(0))?.into_any())
    }

    /// Gradient of Σ `cotangent` p.
    pub(super) fn vjp(
        &self,
        py: Python<'_>,
        cotangent: &Bound<'_, PyAny>,
        wrt: Option<Vec<String>>,
    ) -> PyResult<PyGradient> {
        let weights = real_matrix("cotangent", cotangent)?;
        Ok(self
            .gradients(py, vec![Output::Weighted(weights)], wrt)?
            .remove(0))
    }

    /// Change of the solution along `directions`, a mapping of paths to rates, and along a rate of the gap.
    pub(super) fn jvp(
        &self,
        py: Python<'_>,
        directions: Option<&Bound<'_, PyAny>>,
        gap: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PyDirection> {
        let mut rates: Vec<(String, f64)> = Vec::new();
        if let Some(given) = directions {
            let given = given.cast::<PyDict>().map_err(|_| {
                PyTypeError::new_err("directions must be a dict of paths and their rates")
            })?;
            for (path, rate) in given {
                rates.push((path.extract()?, rate.extract()?));
            }
        }
        let gap = gap.map(|gap| real_matrix("gap", gap)).transpose()?;
        let found = self.run(py, move |plan, caller| {
            let rates: Vec<(&str, f64)> = rates
                .iter()
                .map(|(path, rate)| (path.as_str(), *rate))
                .collect();
            plan.jvp_watched(&rates, gap.as_deref(), &mut || caller.go_on())
        })?;
        Ok(PyDirection(found))
    }
}

impl PyGradient {
    fn paths(&self) -> Vec<String> {
        self.gradient
            .values
            .iter()
            .map(|(parameter, _)| parameter.to_string())
            .collect()
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
        let paths: Vec<String> = self
            .paths()
            .into_iter()
            .filter(|path| path != "friction")
            .collect();
        let steps = self.linear.run(py, move |plan, caller| {
            let mut steps = Vec::new();
            for path in paths {
                match plan.jvp_watched(&[(&path, 1.0)], None, &mut || caller.go_on())? {
                    Some(found) => steps.push((path, found.valid_step)),
                    None => return Ok(None),
                }
            }
            Ok(Some(steps))
        })?;
        let found = PyDict::new(py);
        for (path, step) in steps {
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
        self.gradient
            .values
            .iter()
            .map(|(_, value)| *value)
            .collect()
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

    fn __repr__(&self) -> String {
        let items = self
            .items()
            .into_iter()
            .map(|(path, value)| format!("{path}: {value:.6e}"));
        let items = items.collect::<Vec<_>>().join(", ");
        format!(
            "Gradient({} = {:.6e}, {{{items}}})",
            self.output(),
            self.gradient.value
        )
    }
}

/// Change of a solved contact along a direction of parameters; `Solution.jvp` makes it.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
/// >>> change = solution.jvp({"load": 1.0})
/// >>> round(change.approach * 10.0 / solution.approach, 2)
/// 0.67
#[pyclass(name = "Direction", module = "nacre", frozen)]
pub(in crate::python) struct PyDirection(Direction);

#[pymethods]
impl PyDirection {
    /// Change of the pressure ``(nx, ny)``; 0 outside the contact.
    #[getter]
    fn pressure<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let pressure: Array2<f64> = self.0.pressure.clone();
        read_only(py, pressure)
    }

    /// Change of the approach.
    #[getter]
    fn approach(&self) -> f64 {
        self.0.approach
    }

    /// Change of the tilts.
    #[getter]
    fn tilt(&self) -> (f64, f64) {
        self.0.tilt.into()
    }

    /// Largest step along the direction, of either sign, for which the contact keeps its cells to first order.
    #[getter]
    fn valid_step(&self) -> f64 {
        self.0.valid_step
    }

    fn __repr__(&self) -> String {
        format!(
            "Direction(approach={:.6e}, tilt=({:.6e}, {:.6e}), valid_step={:.3e})",
            self.0.approach, self.0.tilt[0], self.0.tilt[1], self.0.valid_step
        )
    }
}
