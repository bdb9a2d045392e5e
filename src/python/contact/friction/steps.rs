//! What `nacre.slide` and `nacre.roll` ask for, read and checked by name, and its solutions, step after step.

use std::sync::Arc;

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping};
use serde::Deserialize;
use serde::de::IntoDeserializer;
use serde::de::value::{Error, StrDeserializer};

use super::solved::{PyFrictionSolved, coefficient, solved};
use crate::compliance::response::Body;
use crate::contact::{Contact, Motion, Options, choose_grid};
use crate::friction::{
    Friction, FrictionOptions, FrictionReport, FrictionSolution, Last, Move, Rolling,
    RollingDirection, Step,
};
use crate::model::surface::Surface;
use crate::python::arguments::keywords::{self, Keywords};
use crate::python::arguments::{Repr, number, pair};
use crate::python::background::{self, Caller};
use crate::python::bodies::body;
use crate::python::contact::PyContact;
use crate::python::contact::single::setup;
use crate::python::data::text;
use crate::python::grid::PyGrid;
use crate::python::shapes::{Shape, shape};

/// Steps that are asked for.
enum Asked {
    Slide(Vec<Step>),
    RollSteadily(Rolling),
    /// Rolling by so many cells, one at a time.
    RollCells(Rolling, usize),
}

impl Asked {
    /// The move of the step `number`; none after the last one.
    fn step(&self, number: usize) -> Option<Move<'_>> {
        match self {
            Self::Slide(steps) => steps.get(number).map(Move::Slide),
            Self::RollSteadily(rolling) => (number == 0).then_some(Move::RollSteadily(rolling)),
            Self::RollCells(rolling, cells) => {
                (number < *cells).then_some(Move::RollOneCell(rolling))
            }
        }
    }

    /// The motion of the step with the largest load, or the deepest one, for the choice of a grid.
    fn widest(&self) -> Option<Motion> {
        let size = |motion: &Motion| motion.load.or(motion.approach).unwrap_or(0.0);
        match self {
            Self::Slide(steps) => {
                let motions = steps.iter().filter_map(|step| step.motion);
                motions.max_by(|a, b| size(a).total_cmp(&size(b)))
            }
            Self::RollSteadily(rolling) | Self::RollCells(rolling, _) => Some(rolling.motion),
        }
    }
}

/// A contact with friction, and all that is asked of it.
struct Problem {
    contact: Arc<Contact>,
    shape: Shape,
    asked: Asked,
    options: FrictionOptions,
}

/// Iterator of solutions, step after step. Each is solved in the background; Ctrl-C and the callback can stop it.
#[pyclass(name = "FrictionSteps", module = "nacre._core")]
pub(in crate::python) struct PyFrictionSteps {
    problem: Arc<Problem>,
    /// Whether the steps were asked for as a history, whose errors name the step.
    #[pyo3(get)]
    several: bool,
    progress: Option<Py<PyAny>>,
    number: usize,
    last: Option<Arc<FrictionSolution>>,
}

#[pymethods]
impl PyFrictionSteps {
    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __next__(&mut self, py: Python<'_>) -> PyResult<Option<PyFrictionSolved>> {
        let (number, problem) = (self.number, Arc::clone(&self.problem));
        let progress = self.progress.as_ref().map(|progress| progress.clone_ref(py));
        let last = self.last.take();
        let found = background::run(py, progress, move |caller: &mut Caller<(usize, String)>| {
            let mut tell =
                |report: &FrictionReport| caller.ask(|| (number, text(report).unwrap_or_default()));
            // The first step begins where another call ended.
            let last = last.as_deref().map(|solution| Last { solution, is_own: number > 0 });
            let Problem { contact, shape, asked, options } = &*problem;
            let next = asked.step(number)?;
            Some(contact.friction_step(shape, next, options, last, &mut tell))
        })?;
        let Some(found) = found else {
            return Ok(None);
        };
        let found = found.map_err(|error| {
            let error = PyErr::from(error);
            if self.several {
                let _ = error.add_note(py, format!("step {number}"));
            }
            error
        })?;
        let found = Arc::new(found);
        self.last = Some(Arc::clone(&found));
        self.number += 1;
        Ok(Some(PyFrictionSolved(found)))
    }
}

/// Steps of sliding, as the arguments of `nacre.slide` or of `Contact.slide` say.
#[pyfunction]
#[pyo3(signature = (given, contact=None))]
pub(in crate::python) fn slide(
    py: Python<'_>,
    given: &Bound<'_, PyDict>,
    contact: Option<&Bound<'_, PyContact>>,
) -> PyResult<PyFrictionSteps> {
    let keywords = Keywords::new(py, Some(given))?;
    let first = step(&keywords)?;
    let (asked, several) = match keywords.given("steps")? {
        Some(steps) => (history(first, &steps)?, true),
        None => (vec![first], false),
    };
    begun(py, &keywords, contact, |_| Ok((Asked::Slide(asked), several)))
}

/// Steps of rolling, as the arguments of `nacre.roll` or of `Contact.roll` say.
#[pyfunction]
#[pyo3(signature = (given, contact=None))]
pub(in crate::python) fn roll(
    py: Python<'_>,
    given: &Bound<'_, PyDict>,
    contact: Option<&Bound<'_, PyContact>>,
) -> PyResult<PyFrictionSteps> {
    let keywords = Keywords::new(py, Some(given))?;
    let cells = keywords.count("cells", 1)?;
    if cells.is_none() && keywords.given("initial")?.is_some() {
        return Err(PyValueError::new_err(
            "initial must be given with cells: the steady state does not depend on it",
        ));
    }
    begun(py, &keywords, contact, |shape| {
        let rolling = rolling(shape, &keywords)?;
        Ok(match cells {
            Some(cells) => (Asked::RollCells(rolling, cells), true),
            None => (Asked::RollSteadily(rolling), false),
        })
    })
}

/// What `asked` says of a shape, on `contact` or on one that is planned for it.
fn begun(
    py: Python<'_>,
    keywords: &Keywords,
    contact: Option<&Bound<'_, PyContact>>,
    asked: impl FnOnce(&Shape) -> PyResult<(Asked, bool)>,
) -> PyResult<PyFrictionSteps> {
    let last = match keywords.given("initial")? {
        None => None,
        Some(given) => Some(solved(&given).ok_or_else(|| {
            PyTypeError::new_err(format!(
                "initial must be a nacre.types.FrictionSolution, got {}",
                Repr(&given)
            ))
        })?),
    };
    let default = FrictionOptions::default();
    let most = keywords.count("max_convolutions", 1)?;
    let options = FrictionOptions {
        tolerance: keywords.real("tolerance", default.tolerance)?,
        max_convolutions: most.unwrap_or(default.max_convolutions),
        coupling: keywords.flag("coupling", default.coupling)?,
    };
    let progress = keywords.callable("progress")?;
    keywords.flag("check", true)?;
    let shape = shape(&keywords.any("shape")?)?.get().0.clone();
    let (asked, several) = asked(&shape)?;
    let contact = match contact {
        Some(contact) => Arc::clone(&contact.get().contact),
        None => planned(py, keywords, &shape, asked.widest())?,
    };
    let problem = Arc::new(Problem { contact, shape, asked, options });
    Ok(PyFrictionSteps { problem, several, progress, number: 0, last })
}

/// A contact of the given bodies, on the given grid or on that which fits the shape.
fn planned(
    py: Python<'_>,
    keywords: &Keywords,
    shape: &Shape,
    motion: Option<Motion>,
) -> PyResult<Arc<Contact>> {
    let grid: Option<PyGrid> = keywords.object("grid", "a nacre.Grid")?;
    let body = Body::from(body(&keywords.any("body")?)?);
    let setup = setup(keywords.given("counterbody")?.as_ref(), keywords)?;
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

/// Steps of a history. The first one moves along z, and has the friction, as the call says where it does not say it.
fn history(call: Step, given: &Bound<'_, PyAny>) -> PyResult<Vec<Step>> {
    let plain = Step { motion: call.motion, friction: call.friction.clone(), ..Step::default() };
    if plain != call {
        return Err(PyValueError::new_err(
            "shift, force, twist and torque must be given in the steps, where there are steps",
        ));
    }
    let listed = given.try_iter().map_err(|_| {
        PyTypeError::new_err(format!("steps must be an iterable of mappings, got {}", Repr(given)))
    })?;
    let mut steps = Vec::new();
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
        steps.push(step(&keywords).map_err(named)?);
        keywords.finish("keys of a step").map_err(named)?;
    }
    let Some(first) = steps.first_mut() else {
        return Err(PyValueError::new_err("steps must hold a step at least"));
    };
    first.motion = first.motion.or(call.motion);
    first.friction = first.friction.take().or(call.friction);
    Ok(steps)
}

/// Rolling of a shape; it says in which direction if it rolls in one alone.
fn rolling(shape: &Shape, keywords: &Keywords) -> PyResult<Rolling> {
    let words = "direction must be \"+x\", \"-x\", \"+y\" or \"-y\"";
    let friction = friction(keywords)?
        .ok_or_else(|| PyValueError::new_err("friction must be given in rolling"))?;
    let direction = match (keywords.optional_text("direction")?, shape.rolling_direction()) {
        (Some(word), _) => {
            let reader: StrDeserializer<'_, Error> = word.as_str().into_deserializer();
            RollingDirection::deserialize(reader)
                .map_err(|_| PyValueError::new_err(format!("{words}, got {word:?}")))?
        }
        (None, Some([x, _])) if x.abs() < 0.5 => RollingDirection::PlusY,
        (None, Some(_)) => RollingDirection::PlusX,
        (None, None) => {
            let told = format!("{words} for a shape that rolls in any direction");
            return Err(PyValueError::new_err(told));
        }
    };
    Ok(Rolling {
        creepage: pair("creepage", keywords.given("creepage")?.as_ref())?,
        force: pair("force", keywords.given("force")?.as_ref())?,
        spin: keywords.real("spin", 0.0)?,
        ..Rolling::new(keywords::motion(keywords)?, friction, direction)
    })
}

fn friction(keywords: &Keywords) -> PyResult<Option<Friction>> {
    keywords.given("friction")?.map(|given| coefficient(&given)).transpose()
}
