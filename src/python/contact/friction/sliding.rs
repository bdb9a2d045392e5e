//! `nacre.slide`, and the arguments that it shares with `Contact.slide`.

use std::sync::Arc;

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyMapping};

use super::keywords::{Found, found, friction};
use super::report::PyFrictionReport;
use super::solution::PyFrictionSolution;
use super::{found_docs, found_signature, slid_docs, slide_docs, slide_signature};
use crate::compliance::response::Body;
use crate::contact::{Contact, Motion, Options, choose_grid};
use crate::friction::{FrictionProgress, FrictionReport, FrictionSolution, Last, Move, Step};
use crate::model::body::HalfSpace;
use crate::python::arguments::Repr;
use crate::python::arguments::keywords::{self, Keywords, motion_signature};
use crate::python::arguments::{number, pair};
use crate::python::background::{self, Caller};
use crate::python::bodies::body;
use crate::python::contact::single::setup;
use crate::python::grid::PyGrid;
use crate::python::shapes::{Shape, shape};

/// Message of progress: number of the step and report.
pub(super) type Told = (usize, PyFrictionReport);

/// Arguments of sliding.
pub(in crate::python::contact) struct Sliding {
    shape: Shape,
    /// Steps; whether they were given as a history.
    steps: Vec<Step>,
    history: bool,
    initial: Option<Py<PyFrictionSolution>>,
    found: Found,
}

/// One step of `keywords`. Along z it moves as they say, if they say anything.
fn step(keywords: &Keywords) -> PyResult<Step> {
    let motion = keywords::motion(keywords)?;
    Ok(Step {
        motion: (motion != Motion::default()).then_some(motion),
        friction: friction(keywords)?,
        shift: pair("shift", keywords.given("shift")?.as_ref())?,
        force: pair("force", keywords.given("force")?.as_ref())?,
        twist: number("twist", keywords.given("twist")?.as_ref())?,
        torque: number("torque", keywords.given("torque")?.as_ref())?,
    })
}

impl Sliding {
    pub(in crate::python::contact) fn new(
        given: &Bound<'_, PyAny>,
        steps: Option<&Bound<'_, PyAny>>,
        keywords: &Keywords,
    ) -> PyResult<Self> {
        let first = step(keywords)?;
        let initial: Option<Py<PyFrictionSolution>> =
            keywords.object("initial", "a nacre.types.FrictionSolution")?;
        let found = found(keywords)?;
        let shape = shape(given)?.get().0.clone();
        let Some(given) = steps else {
            return Ok(Self { shape, steps: vec![first], history: false, initial, found });
        };
        let plain =
            Step { motion: first.motion, friction: first.friction.clone(), ..Step::default() };
        if plain != first {
            return Err(PyValueError::new_err(
                "shift, force, twist and torque must be given in the steps, where there are steps",
            ));
        }
        let mut steps = Vec::new();
        let listed = given.try_iter().map_err(|_| {
            PyTypeError::new_err(format!(
                "steps must be an iterable of mappings, got {}",
                Repr(given)
            ))
        })?;
        for (number, given) in listed.enumerate() {
            let given = given?;
            let mapping = given.cast::<PyMapping>().map_err(|_| {
                PyTypeError::new_err(format!(
                    "a step must be a mapping of keywords of `slide`, got {}",
                    Repr(&given)
                ))
            })?;
            let keywords = Keywords::of_mapping(mapping)?;
            let named = |error: PyErr| {
                let _ = error.add_note(given.py(), format!("step {number}"));
                error
            };
            let mut next = step(&keywords).map_err(named)?;
            keywords.finish("keys of a step").map_err(named)?;
            if number == 0 {
                next.motion = next.motion.or(first.motion);
                next.friction = next.friction.or(first.friction.clone());
            }
            steps.push(next);
        }
        if steps.is_empty() {
            return Err(PyValueError::new_err("steps must hold a step at least"));
        }
        Ok(Self { shape, steps, history: true, initial, found })
    }

    /// The motion of the step with the largest load, or the deepest one, for the choice of a grid.
    fn widest(&self) -> Option<Motion> {
        let size = |motion: &Motion| motion.load.or(motion.approach).unwrap_or(0.0);
        let motions = self.steps.iter().filter_map(|step| step.motion);
        motions.max_by(|a, b| size(a).total_cmp(&size(b)))
    }

    pub(in crate::python::contact) fn run<'py>(
        self,
        py: Python<'py>,
        contact: &Arc<Contact>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let Self { shape, steps, history, initial, found } = self;
        let options = found.options;
        let shape = Arc::new(shape);
        let last = initial.map(|solution| Arc::clone(solution.get().inner()));
        let steps = steps.into_iter().map(|step| {
            let (contact, shape) = (Arc::clone(contact), Arc::clone(&shape));
            move |last: Option<Last>, progress: &mut FrictionProgress| {
                contact.friction_step(&*shape, Move::Slide(&step), &options, last, progress)
            }
        });
        series(py, steps, last, &found, history)
    }
}

/// Solves one step after another, each in the background; Ctrl-C and the callback can stop it. Steps get the solution
/// before, and whether it is one of these steps. An exception carries the finished solutions.
pub(super) fn series<'py, S>(
    py: Python<'py>,
    steps: impl Iterator<Item = S>,
    mut last: Option<Arc<FrictionSolution>>,
    found: &Found,
    history: bool,
) -> PyResult<Bound<'py, PyAny>>
where
    S: FnOnce(Option<Last>, &mut FrictionProgress) -> crate::Result<FrictionSolution>
        + Send
        + 'static,
{
    let solutions = PyList::empty(py);
    let result = (|| {
        for (number, step) in steps.enumerate() {
            let progress = found.progress.as_ref().map(|progress| progress.clone_ref(py));
            let before = last.take();
            let solved = background::run(py, progress, move |caller: &mut Caller<Told>| {
                let mut tell = |report: &FrictionReport| {
                    caller.ask(|| (number, PyFrictionReport(report.clone())))
                };
                let before =
                    before.as_deref().map(|solution| Last { solution, is_own: number > 0 });
                step(before, &mut tell)
            })?;
            let solved = solved.map_err(|error| {
                let error = PyErr::from(error);
                if history {
                    let _ = error.add_note(py, format!("step {number}"));
                }
                error
            })?;
            let solution = PyFrictionSolution::finished(py, solved, found.check)?;
            last = Some(Arc::clone(solution.inner()));
            let stopped = solution.is_stopped();
            solutions.append(solution)?;
            if stopped {
                break;
            }
        }
        Ok(())
    })();
    match result {
        Ok(()) if history => Ok(solutions.into_any()),
        Ok(()) => solutions.get_item(0),
        Err(error) => {
            let error: PyErr = error;
            if history {
                error.value(py).setattr("solutions", solutions)?;
            }
            Err(error)
        }
    }
}

#[doc = concat!("slide(shape, body, counterbody=None, *, grid=None, threads=None, steps=None, ", motion_signature!(), ", ", slide_signature!(), ", ", found_signature!(), ")\n--\n")]
/// Presses a shape into a body and moves it tangentially, with friction, in one call.
///
/// It chooses a grid where none is given, plans, and solves.
///
/// Parameters
/// ----------
/// shape : Shape
///     Shape that is pressed in.
/// body : HalfSpace or Elastic
///     Body that it is pressed into.
/// counterbody : HalfSpace or Elastic, optional
///     Body that carries the shape and moves over the body; rigid where there is none.
/// grid : Grid, optional
///     Cells of pressure and traction; by default that of `solve` for the largest load.
/// threads : int, optional
///     Number of threads; all of the machine's by default.
#[doc = slide_docs!()]
#[doc = found_docs!()]
#[doc = slid_docs!()]
///
/// Examples
/// --------
/// A fretting loop of a ball:
///
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> steps = [{"force": (force, None)} for force in (2.0, -2.0, 2.0)]
/// >>> loop = nacre.slide(nacre.Sphere(5e-3), steel, steel, load=10.0, friction=0.3, steps=steps)
/// >>> [round(solution.force[0], 6) for solution in loop], loop[2].dissipated > 0
/// ([2.0, -2.0, 2.0], True)
#[pyfunction]
#[pyo3(signature = (shape, body, counterbody=None, **keywords), text_signature = None)]
pub(in crate::python) fn slide<'py>(
    py: Python<'py>,
    shape: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = body)] body: HalfSpace,
    counterbody: Option<&Bound<'py, PyAny>>,
    keywords: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let keywords = Keywords::new(py, keywords)?;
    let grid: Option<PyGrid> = keywords.object("grid", "a nacre.Grid")?;
    let setup = setup(counterbody, &keywords)?;
    let steps = keywords.given("steps")?;
    let sliding = Sliding::new(shape, steps.as_ref(), &keywords)?;
    keywords.finish("keywords of slide")?;
    let widest = sliding.widest();
    let contact = planned(py, (&sliding.shape, Body::from(body), setup), grid, widest)?;
    sliding.run(py, &contact)
}

/// A contact on a grid, or on that which fits the shape.
pub(super) fn planned(
    py: Python<'_>,
    (shape, body, setup): (&Shape, Body, crate::contact::Setup),
    grid: Option<PyGrid>,
    motion: Option<Motion>,
) -> PyResult<Arc<Contact>> {
    let motion = motion.ok_or_else(|| {
        PyValueError::new_err("load or approach must be given, in the call or in the first step")
    })?;
    let shape = shape.clone();
    let contact = background::run(py, None, move |caller: &mut Caller<()>| {
        let grid = match grid {
            Some(PyGrid(grid)) => grid,
            None => {
                let (options, ask) = (Options::default(), &mut |_: &_| caller.ask(|| ()));
                choose_grid(&shape, &body, &setup, &motion, options.watched(ask))?
            }
        };
        Contact::plan(&body, grid, setup)
    })??;
    Ok(Arc::new(contact))
}
