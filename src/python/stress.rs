//! Stress below the surface: evaluated, summarised and planned for `nacre.contact.stresses`.

use std::sync::Arc;

use ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::arguments::{Argument, Pair, Real, Repr, count, listed, real_array, real_matrix};
use super::background;
use super::bodies::{PyHalfSpace, half_space};
use super::data::{Plain, SummaryWithWarnings};
use super::friction::PyFrictionSolved;
use super::grid::PyGrid;
use super::solved::PySolved;
use crate::model::body::{HalfSpace, Layer, Substrate};
use crate::stress::{
    Member, Section, Strengths, Stress, StressOptions, StressPlan, StressProgress, WatchedStress,
};

mod field;

pub(super) use field::{checked_stress, stress_invariants};

/// Handle of a plan, for `nacre.types.StressPlan`.
#[pyclass(name = "StressPlan", module = "nacre._core", frozen)]
pub(super) struct PyStressPlan(Arc<StressPlan>);

#[pymethods]
impl PyStressPlan {
    /// Plan for a body under a pressure that is uniform over each cell.
    #[new]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = half_space)] body: HalfSpace,
        grid: PyGrid,
        pressure: &Bound<'_, PyAny>,
        threads: Option<usize>,
    ) -> PyResult<Self> {
        let pressure = real_matrix("pressure", pressure)?;
        let plan = background::run(py, None, move |_: &mut background::Caller<()>| {
            StressPlan::plan(&body, &grid.0, &pressure, threads)
        })??;
        Ok(Self(Arc::new(plan)))
    }

    #[getter]
    fn body(&self) -> PyHalfSpace {
        PyHalfSpace(self.0.body().clone())
    }

    /// Points of the edge of the contact (n, 2).
    #[getter]
    fn edge<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        Array2::from(self.0.edge()).into_pyarray(py)
    }

    /// Estimated errors of the extremes of a section at the depths `z`, for `nacre.fatigue`.
    fn extreme_errors(
        &self,
        z: &Bound<'_, PyAny>,
        fields: PyStressFields<'_>,
        options: PyStressOptions<'_>,
    ) -> PyResult<Vec<f64>> {
        let (mut options, _) = options.read(self.0.body())?;
        fields.read(&mut options)?;
        Ok(self.0.extreme_errors(&depths(z)?.0, &options)?)
    }
}

/// What a stress is evaluated of: a solved contact, one with friction, or a plan for one of its bodies.
#[derive(FromPyObject)]
pub(super) enum Of {
    Solved(Py<PySolved>),
    Friction(Py<PyFrictionSolved>),
    Plan(Py<PyStressPlan>),
}

impl Of {
    /// The body that is meant, and its layers; a plan is of one body.
    fn body(&self, member: &Argument<'_>) -> PyResult<(Member, HalfSpace)> {
        let solution = match self {
            Self::Plan(plan) => return Ok((Member::Body, plan.get().0.body().clone())),
            Self::Solved(solved) => &*solved.get().0,
            Self::Friction(solved) => &solved.get().0.normal,
        };
        let member = member.word("body")?;
        Ok((member, solution.member(member)?.clone()))
    }
}

/// `nacre.contact.stresses.StressOptions`.
#[derive(FromPyObject)]
pub(super) struct PyStressOptions<'py> {
    body: Argument<'py>,
    friction: Argument<'py>,
    direction: Argument<'py>,
    residual: Argument<'py>,
    threads: Argument<'py>,
    progress: Argument<'py>,
}

impl PyStressOptions<'_> {
    /// Options with friction, residual stress and threads, and the callback.
    fn read(&self, body: &HalfSpace) -> PyResult<(StressOptions, Option<Py<PyAny>>)> {
        let direction: Option<Pair> = self.direction.of("direction", "a pair of numbers")?;
        let residual = by_layer("residual", &self.residual, body)?;
        let options = StressOptions {
            friction: self.friction.real("friction")?,
            direction: direction.map(|direction| direction.0),
            residual: residual.into_iter().map(|s| s.unwrap_or(0.0)).collect(),
            threads: self.threads.count("threads", 1)?,
            ..StressOptions::default()
        };
        Ok((options, self.progress.callable("progress")?))
    }
}

/// `nacre.contact.stresses.StressFields`.
#[derive(FromPyObject)]
pub(super) struct PyStressFields<'py> {
    side: Argument<'py>,
    x: Argument<'py>,
    y: Argument<'py>,
    displacement: Argument<'py>,
}

impl PyStressFields<'_> {
    /// Puts section, side and displacement into the options; returns whether x and y were given.
    fn read(&self, options: &mut StressOptions) -> PyResult<[bool; 2]> {
        options.side = self.side.word("side")?;
        let x = self.x.number("x")?;
        let y = self.y.number("y")?;
        options.section = match (x, y) {
            (None, None) => Section::Plane,
            (Some(x), None) => Section::X(x),
            (None, Some(y)) => Section::Y(y),
            (Some(x), Some(y)) => Section::Axis([x, y]),
        };
        options.displacement = self.displacement.flag("displacement")?;
        Ok([x.is_some(), y.is_some()])
    }
}

/// `nacre.contact.stresses.StressLimits`.
#[derive(FromPyObject)]
pub(super) struct PyStressLimits<'py> {
    yield_stress: Argument<'py>,
    strength: Argument<'py>,
    refine: Argument<'py>,
}

/// Fields of the stress at the depths `z`, for `nacre.types.Stress`.
#[pyfunction]
pub(super) fn stress<'py>(
    of: Of,
    z: &Bound<'py, PyAny>,
    fields: PyStressFields<'py>,
    options: PyStressOptions<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let (member, body) = of.body(&options.body)?;
    evaluated(z, &fields, &options, &body, move |depths, options| match of {
        Of::Solved(solved) => solved.get().0.stress(depths, member, options),
        Of::Friction(solved) => solved.get().0.stress(depths, member, options),
        Of::Plan(plan) => plan.get().0.stress(depths, options),
    })
}

/// Fields of the stress under a pressure that is uniform over each cell; `nacre.stress`.
#[pyfunction]
pub(super) fn stress_under<'py>(
    #[pyo3(from_py_with = half_space)] body: HalfSpace,
    grid: PyGrid,
    pressure: &Bound<'py, PyAny>,
    z: &Bound<'py, PyAny>,
    fields: PyStressFields<'py>,
    options: PyStressOptions<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let pressure = real_matrix("pressure", pressure)?;
    let loaded = body.clone();
    evaluated(z, &fields, &options, &body, move |depths, options| {
        crate::stress::stress(&loaded, &grid.0, &pressure, depths, options)
    })
}

fn evaluated<'py>(
    z: &Bound<'py, PyAny>,
    fields: &PyStressFields<'_>,
    options: &PyStressOptions<'_>,
    body: &HalfSpace,
    evaluate: impl FnOnce(&[f64], WatchedStress) -> crate::Result<Stress> + Send + 'static,
) -> PyResult<Bound<'py, PyDict>> {
    let (depths, one) = depths(z)?;
    let (mut options, progress) = options.read(body)?;
    let [x, y] = fields.read(&mut options)?;
    let stress =
        watched(z.py(), progress, move |progress| evaluate(&depths, options.watched(progress)))?;
    field::fields(z.py(), stress, [one, x, y])
}

/// Summary of the stress.
#[pyfunction]
pub(super) fn stress_summary(
    py: Python<'_>,
    of: Of,
    limits: PyStressLimits<'_>,
    options: PyStressOptions<'_>,
) -> PyResult<Plain<SummaryWithWarnings>> {
    let (member, body) = of.body(&options.body)?;
    let strengths = Strengths {
        yield_stress: by_layer("yield_stress", &limits.yield_stress, &body)?,
        strength: by_layer("strength", &limits.strength, &body)?,
    };
    let (mut options, progress) = options.read(&body)?;
    options.refine = limits.refine.number("refine")?;
    let summary = watched(py, progress, move |progress| {
        let options = options.watched(progress);
        match of {
            Of::Solved(solved) => solved.get().0.stress_summary(member, &strengths, options),
            Of::Friction(solved) => solved.get().0.stress_summary(member, &strengths, options),
            Of::Plan(plan) => plan.get().0.summary(&strengths, options),
        }
    })?;
    Ok(Plain(summary.into()))
}

/// Plan of the stress in a body of a solved contact.
#[pyfunction]
pub(super) fn stress_plan(
    py: Python<'_>,
    of: Of,
    body: Argument<'_>,
    threads: Argument<'_>,
) -> PyResult<PyStressPlan> {
    let (member, _) = of.body(&body)?;
    let options = StressOptions::default().with_threads(threads.count("threads", 1)?);
    let plan = watched(py, None, move |progress| {
        let options = options.watched(progress);
        Ok(match of {
            Of::Solved(solved) => Arc::new(solved.get().0.stress_plan(member, options)?),
            Of::Friction(solved) => Arc::new(solved.get().0.stress_plan(member, options)?),
            Of::Plan(plan) => Arc::clone(&plan.get().0),
        })
    })?;
    Ok(PyStressPlan(plan))
}

/// Values of the layers of a body, as [`by_layer`] reads them.
#[pyfunction]
pub(super) fn layer_values(
    body: &PyHalfSpace,
    name: &str,
    values: Argument<'_>,
) -> PyResult<Vec<Option<f64>>> {
    by_layer(name, &values, &body.0)
}

/// Values of some layers, from the surface down and the substrate last. They are a sequence of
/// them, or a dict from layers, by number or name, and "substrate". A name stands for all layers that
/// have it.
fn by_layer(name: &str, values: &Argument<'_>, body: &HalfSpace) -> PyResult<Vec<Option<f64>>> {
    let Some(mut object) = values.get().cloned() else {
        return Ok(Vec::new());
    };
    // A Series names the layers by its index.
    if object.hasattr("index")?
        && let Some(to_dict) = object.getattr_opt("to_dict")?
    {
        object = to_dict.call0()?;
    }
    let layers = body.layers().len();
    let parts = layers + usize::from(matches!(body.substrate(), Substrate::Elastic(_)));
    let number = |value: &Bound<'_, PyAny>| match value.extract::<Real>() {
        Ok(number) => Ok(number.0),
        Err(_) => {
            Err(PyTypeError::new_err(format!("{name} must hold real numbers, got {}", Repr(value))))
        }
    };
    let Ok(mapping) = object.cast::<PyDict>() else {
        let items = listed(&object).map(|items| items.into_iter().map(|item| item.extract()));
        let values: Vec<Option<Real>> =
            items.and_then(Iterator::collect::<PyResult<_>>).map_err(|_| {
                PyTypeError::new_err(format!(
                    "{name} must be a dict from layers to numbers, or a sequence of them, got {}",
                    Repr(&object)
                ))
            })?;
        if values.len() > parts {
            return Err(PyValueError::new_err(format!(
                "{name} must hold at most {parts} values, one for each layer and the substrate, \
                 got {}",
                values.len()
            )));
        }
        return Ok(values.iter().map(|value| value.map(|v| v.0)).collect());
    };
    let mut values = vec![None; parts];
    for (key, value) in mapping {
        let is_meant = |layer: usize| match key.extract::<String>() {
            Ok(word) if layer == layers => word == "substrate",
            Ok(word) => body.layers()[layer].name() == Some(&word),
            Err(_) => count(name, 0, &key).is_ok_and(|number| number == layer),
        };
        let meant: Vec<_> = (0..parts).filter(|layer| is_meant(*layer)).collect();
        if meant.is_empty() {
            return Err(PyValueError::new_err(format!(
                "keys of {name} must be \"substrate\" (where it is elastic), numbers of layers from 0 \
                 at the surface to {}, or names of layers ({}), got {}",
                parts - 1,
                names(body),
                Repr(&key)
            )));
        }
        let value = number(&value)?;
        for layer in meant {
            values[layer] = Some(value);
        }
    }
    Ok(values)
}

/// Names of the layers of a body, for a message.
fn names(body: &HalfSpace) -> String {
    let names: Vec<_> = body.layers().iter().filter_map(Layer::name).collect();
    match names.is_empty() {
        true => "here they have none".into(),
        false => names.join(", "),
    }
}

/// Depths, and whether the argument was a single number.
fn depths(z: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, bool)> {
    let values = real_array("z", z)?;
    if values.ndim() > 1 {
        return Err(PyValueError::new_err(format!(
            "z must be a depth or a sequence of depths, got shape {:?}",
            values.shape()
        )));
    }
    Ok((values.iter().copied().collect(), values.ndim() == 0))
}

/// Runs `work` in the background; Ctrl-C and the callback can stop it.
fn watched<R: Send + 'static>(
    py: Python<'_>,
    callback: Option<Py<PyAny>>,
    work: impl FnOnce(&mut StressProgress) -> crate::Result<R> + Send + 'static,
) -> PyResult<R> {
    let result =
        background::run(py, callback, move |caller| work(&mut |part: f64| caller.ask(|| (part,))))?;
    Ok(result?)
}
