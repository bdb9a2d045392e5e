//! Steps of wear; `nacre.wear` is around them.

use std::sync::{Arc, Mutex, PoisonError};

use numpy::PyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::arguments::{Argument, read_only, real_matrix};
use super::background::{self, Caller};
use super::contact::{PyMotion, PyOn, shape_of};
use super::data::Plain;
use super::friction::{PyFrictionOptions, PyFrictionStep, PyRolling, planned};
use super::shapes::Shape;
use super::solved::PySolved;
use crate::contact::{Options, Report};
use crate::model::surface::Surface;
use crate::wear::{Idle, Slip, Wear, WearScheme, WearSession, WearSteps, WearThrough};

/// `nacre.wear.arguments.WearOptions`.
#[derive(FromPyObject)]
pub(super) struct PyWear<'py> {
    rate: Vec<f64>,
    counter_rate: Vec<f64>,
    distance: Argument<'py>,
    slip: Argument<'py>,
    cycle: Option<Vec<PyFrictionStep<'py>>>,
    rolling: Option<PyRolling<'py>>,
    friction: Option<PyFrictionOptions<'py>>,
    steps: Option<Vec<f64>>,
    step_tolerance: Argument<'py>,
    scheme: Argument<'py>,
    thickness: Argument<'py>,
    until_through: bool,
    initial: Option<[Bound<'py, PyAny>; 2]>,
    goes_on: bool,
    tolerance: Argument<'py>,
    max_iterations: Argument<'py>,
    grows: bool,
}

impl PyWear<'_> {
    fn read(&self, shape: &Shape) -> PyResult<Wear> {
        let friction = self.friction.as_ref().map(PyFrictionOptions::read).transpose()?;
        let mut friction = friction.unwrap_or_default();
        let slip = match (&self.cycle, &self.rolling, self.slip.get()) {
            (Some(steps), ..) => {
                let steps = steps.iter().map(PyFrictionStep::read).collect::<PyResult<_>>()?;
                Slip::Cycle(steps, friction)
            }
            (_, Some(rolling), _) => {
                friction.order = rolling.order(friction.order)?;
                Slip::Pass(Box::new(rolling.read(shape)?), friction)
            }
            (.., Some(slip)) => Slip::Cells(real_matrix("slip", slip)?),
            _ => Slip::Everywhere,
        };
        let end = self.distance.real("sliding")?;
        let steps = match &self.steps {
            Some(ends) => WearSteps::Ends(ends.clone()),
            None => WearSteps::Auto { end, tolerance: self.step_tolerance.real("step_tolerance")? },
        };
        let scheme: WearScheme = self.scheme.word("scheme")?;
        let initial = self.initial.as_ref().map(|depths| -> PyResult<_> {
            let [body, counterbody] = depths.each_ref().map(|one| real_matrix("initial", one));
            Ok([body?, counterbody?])
        });
        Ok(Wear {
            rates: [self.rate.clone(), self.counter_rate.clone()],
            slip,
            steps,
            scheme,
            thickness: self.thickness.word("thickness")?,
            until_through: self.until_through,
            initial: initial.transpose()?,
            goes_on: self.goes_on,
            options: Options {
                tolerance: self.tolerance.real("tolerance")?,
                max_iterations: self.max_iterations.count("max_iterations", 0)?,
                ..Options::default()
            },
        })
    }
}

/// Iterator of worn states. Each is solved in the background; Ctrl-C can stop it.
#[pyclass(name = "WearSteps", module = "nacre._core", frozen)]
pub(super) struct PyWearSteps(Arc<Mutex<WearSession<Shape>>>);

/// Distance, depths, solution, layers that are through, error by the steps, why it wore nothing, whether it rings and is settled, and
/// how often the grid has grown.
type State<'py> = (
    f64,
    [Bound<'py, PyArray2<f64>>; 2],
    PySolved,
    Plain<Vec<WearThrough>>,
    [f64; 2],
    Plain<Option<Idle>>,
    [bool; 2],
    usize,
);

#[pymethods]
impl PyWearSteps {
    /// Change of the last pressure, over the peak, where the worn layers are as thin as they are worn.
    fn thickness_error(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        let session = Arc::clone(&self.0);
        Ok(background::run(py, None, move |caller: &mut Caller<()>| {
            let session = session.lock().unwrap_or_else(PoisonError::into_inner);
            session.thickness_error(&mut |_: &Report| caller.ask(|| ()))
        })??)
    }

    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __next__<'py>(&self, py: Python<'py>) -> PyResult<Option<State<'py>>> {
        let session = Arc::clone(&self.0);
        let state = background::run(py, None, move |caller: &mut Caller<()>| {
            let mut session = session.lock().unwrap_or_else(PoisonError::into_inner);
            session.advance(&mut |_: &Report| caller.ask(|| ()))
        })??;
        let Some(state) = state else { return Ok(None) };
        let [body, counterbody] = state.depth.map(|depth| read_only(py, depth));
        Ok(Some((
            state.distance,
            [body?, counterbody?],
            state.solution.into(),
            Plain(state.through),
            [state.step_error, state.peak_error],
            Plain(state.idle),
            [state.rings, state.settled],
            state.regrids,
        )))
    }
}

/// Steps of wear of a shape, on a plan or on one that is made for it.
#[pyfunction]
pub(super) fn wear(
    py: Python<'_>,
    shape: &Bound<'_, PyAny>,
    motion: PyMotion<'_>,
    wear: PyWear<'_>,
    on: PyOn<'_>,
) -> PyResult<PyWearSteps> {
    let (shape, motion) = (shape_of(shape)?, motion.read()?);
    if motion.load.is_none() && motion.approach.is_none() {
        return Err(PyValueError::new_err("load or approach must be given"));
    }
    let (grows, wear) = (wear.grows, wear.read(&shape)?);
    let (plan, grows) = match on {
        PyOn::Plan(plan) => (Arc::clone(&plan.get().0), false),
        PyOn::Setup(setup) => {
            let grows = grows && Surface::grid(&shape).is_none();
            (planned(py, &setup, &shape, Some(motion), None)?, grows)
        }
    };
    let session = WearSession::new(plan, shape, motion, wear, grows)?;
    Ok(PyWearSteps(Arc::new(Mutex::new(session))))
}
