//! Friction: steps of `nacre.slide` and `nacre.roll`, handles of their solutions, and `nacre.creep_coefficients`.

use std::sync::Arc;

use ndarray::{Array2, Axis, Ix3, stack};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use super::arguments::{
    Argument, Pair, check_memory, count, read_only, real_array, real_matrix, word,
};
use super::background::{self, Caller};
use super::bodies::half_space;
use super::contact::{PyMotion, PyOn, PySetup, shape_of};
use super::data::{Plain, read};
use super::shapes::Shape;
use super::solved::PySolved;
use crate::compliance::response::Body;
use crate::contact::{Contact, Motion, Options, Solution, choose_grid};
use crate::friction::{
    CreepCoefficients, Friction, FrictionOptions, FrictionReport, FrictionSolution, Last, Move,
    Rolling, RollingDirection, Step, TangentialMotion,
};
use crate::model::body::HalfSpace;
use crate::model::surface::Surface;

/// A solved contact with friction.
#[pyclass(name = "FrictionSolved", module = "nacre._core", frozen, eq)]
#[derive(PartialEq)]
pub(super) struct PyFrictionSolved(pub(super) Arc<FrictionSolution>);

/// Coefficient of friction: a number, or one for each cell.
fn coefficient(value: &Bound<'_, PyAny>) -> PyResult<Friction> {
    let values = real_array("friction", value)?;
    Ok(match values.ndim() {
        0 => Friction::Uniform(values.sum()),
        _ => Friction::Cells(real_matrix("friction", value)?),
    })
}

/// Both components of a field (2, nx, ny).
fn components(name: &str, value: &Bound<'_, PyAny>) -> PyResult<[Array2<f64>; 2]> {
    let field = real_array(name, value)?;
    let shape = field.shape().to_vec();
    match field.into_dimensionality::<Ix3>() {
        Ok(field) if field.len_of(Axis(0)) == 2 => {
            Ok([0, 1].map(|axis| field.index_axis(Axis(0), axis).to_owned()))
        }
        Ok(field) => {
            let count = field.len_of(Axis(0));
            Err(PyValueError::new_err(format!("{name} must have 2 components, got {count}")))
        }
        Err(_) => Err(PyValueError::new_err(format!(
            "{name} must have three dimensions (2, nx, ny), got shape {shape:?}"
        ))),
    }
}

/// What a state holds beside fields.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Rest {
    motion: TangentialMotion,
    report: FrictionReport,
}

/// Numbers that follow from the fields, with the rest.
#[derive(Serialize)]
struct Numbers {
    force: [f64; 2],
    torque: f64,
    dissipated: f64,
    tangential_energy: Option<f64>,
    #[serde(flatten)]
    motion: TangentialMotion,
    report: FrictionReport,
}

#[pymethods]
impl PyFrictionSolved {
    /// Solution with this normal contact, these fields, and JSON text of motion and report.
    #[new]
    fn new(
        normal: &Bound<'_, PySolved>,
        friction: &Bound<'_, PyAny>,
        traction: &Bound<'_, PyAny>,
        displacement: &Bound<'_, PyAny>,
        slip: &Bound<'_, PyAny>,
        rest: &str,
    ) -> PyResult<Self> {
        let Rest { motion, report } = read("FrictionSolution", rest)?;
        let solution = FrictionSolution {
            normal: Solution::clone(&normal.get().0),
            friction: coefficient(friction)?,
            traction: components("traction", traction)?,
            displacement: components("displacement", displacement)?,
            slip: components("slip", slip)?,
            motion,
            report,
            half: None,
        };
        Ok(Self(Arc::new(solution.checked()?)))
    }

    fn normal(&self) -> PySolved {
        self.0.normal.clone().into()
    }

    /// All numbers, with motion and report.
    fn numbers(&self) -> Plain<Numbers> {
        Plain(Numbers {
            force: self.0.force(),
            torque: self.0.torque(),
            dissipated: self.0.dissipated(),
            tangential_energy: Some(self.0.tangential_energy()).filter(|energy| !energy.is_nan()),
            motion: self.0.motion,
            report: self.0.report.clone(),
        })
    }

    /// Array of that name; `friction` may be a number.
    fn field<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let solution = &self.0;
        let vector = |[x, y]: &[Array2<f64>; 2]| {
            read_only(py, stack(Axis(0), &[x.view(), y.view()]).unwrap_or_default())
        };
        Ok(match name {
            "traction" => vector(&solution.traction)?.into_any(),
            "displacement" => vector(&solution.displacement)?.into_any(),
            "slip" => vector(&solution.slip)?.into_any(),
            "stick" => read_only(py, solution.stick())?.into_any(),
            "bound" => read_only(py, solution.bound())?.into_any(),
            "dissipation" => read_only(py, solution.dissipation())?.into_any(),
            _ => match &solution.friction {
                Friction::Uniform(coefficient) => coefficient.into_pyobject(py)?.into_any(),
                Friction::Cells(cells) => read_only(py, cells.clone())?.into_any(),
            },
        })
    }

    /// Message of the error where the tolerance was not met.
    fn not_converged(&self) -> Option<String> {
        let checked = FrictionSolution::clone(&self.0).require_converged();
        checked.err().map(|error| error.to_string())
    }
}

/// Bytes that a solution keeps for each cell of its grid: of pressure, displacement and gap, and two components of
/// tractions, displacements and slip.
const KEPT_BYTES: f64 = 72.0;

/// Steps that are asked for.
enum Moves {
    Slide(Vec<Step>),
    RollSteadily(Rolling),
    /// Rolling by so many cells, one at a time.
    RollCells(Rolling, usize),
}

impl Moves {
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
    moves: Moves,
    options: FrictionOptions,
}

/// Iterator of solutions, step after step. Each is solved in the background; Ctrl-C and the callback can stop it.
#[pyclass(name = "FrictionSteps", module = "nacre._core")]
pub(super) struct PyFrictionSteps {
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
        let solution =
            background::run(py, progress, move |caller: &mut Caller<(usize, Plain<_>)>| {
                let mut tell =
                    |report: &FrictionReport| caller.ask(|| (number, Plain(report.clone())));
                // The first step begins where another call ended.
                let last = last.as_deref().map(|solution| Last { solution, is_own: number > 0 });
                let Problem { contact, shape, moves, options } = &*problem;
                let next = moves.step(number)?;
                Some(contact.friction_step(shape, next, options, last, &mut tell))
            })?;
        let Some(solution) = solution else {
            return Ok(None);
        };
        let solution = solution.map_err(|error| {
            let error = PyErr::from(error);
            if self.several {
                let _ = error.add_note(py, format!("step {number}"));
            }
            error
        })?;
        let solution = Arc::new(solution);
        self.last = Some(Arc::clone(&solution));
        self.number += 1;
        Ok(Some(PyFrictionSolved(solution)))
    }
}

/// `nacre.contact.arguments.FrictionStep`.
#[derive(FromPyObject)]
pub(super) struct PyFrictionStep<'py> {
    motion: PyMotion<'py>,
    friction: Argument<'py>,
    shift: Argument<'py>,
    force: Argument<'py>,
    twist: Argument<'py>,
    torque: Argument<'py>,
}

impl PyFrictionStep<'_> {
    /// The step. Along z it moves where the motion says anything.
    pub(super) fn read(&self) -> PyResult<Step> {
        let motion = self.motion.read()?;
        Ok(Step {
            motion: (motion != Motion::default()).then_some(motion),
            friction: self.friction.map(coefficient)?,
            shift: self.shift.pair("shift")?,
            force: self.force.pair("force")?,
            twist: self.twist.number("twist")?,
            torque: self.torque.number("torque")?,
        })
    }
}

/// `nacre.contact.arguments.Rolling`.
#[derive(FromPyObject)]
pub(super) struct PyRolling<'py> {
    motion: PyMotion<'py>,
    friction: Argument<'py>,
    creepage: Argument<'py>,
    force: Argument<'py>,
    spin: Argument<'py>,
    direction: Argument<'py>,
    cells: Argument<'py>,
    order: Argument<'py>,
}

impl PyRolling<'_> {
    /// Order in the length of a cell; `usual` where none is given.
    pub(super) fn order(&self, usual: usize) -> PyResult<usize> {
        Ok(self.order.count("order", 1)?.unwrap_or(usual))
    }

    /// Rolling of a shape, which says in which direction if it rolls in one alone.
    pub(super) fn read(&self, shape: &Shape) -> PyResult<Rolling> {
        let friction = self.friction.map(coefficient)?;
        let friction =
            friction.ok_or_else(|| PyValueError::new_err("friction must be given in rolling"))?;
        let direction: Option<String> = self.direction.of("direction", "a str")?;
        let direction = match (direction, shape.rolling_direction()) {
            (Some(direction), _) => word("direction", &direction)?,
            (None, Some([x, _])) if x.abs() < 0.5 => RollingDirection::PlusY,
            (None, Some(_)) => RollingDirection::PlusX,
            (None, None) => {
                return Err(PyValueError::new_err(
                    "direction must be \"+x\", \"-x\", \"+y\" or \"-y\" for a shape that rolls in any direction",
                ));
            }
        };
        Ok(Rolling {
            creepage: self.creepage.pair("creepage")?,
            force: self.force.pair("force")?,
            spin: self.spin.real("spin")?,
            ..Rolling::new(self.motion.read()?, friction, direction)
        })
    }
}

/// `nacre.contact.arguments.FrictionOptions`.
#[derive(FromPyObject)]
pub(super) struct PyFrictionOptions<'py> {
    tolerance: Argument<'py>,
    max_convolutions: Argument<'py>,
    coupling: Argument<'py>,
    initial: Argument<'py>,
    progress: Argument<'py>,
    check: Argument<'py>,
}

impl PyFrictionOptions<'_> {
    /// How tractions are found.
    pub(super) fn read(&self) -> PyResult<FrictionOptions> {
        let default = FrictionOptions::default();
        let most = self.max_convolutions.count("max_convolutions", 1)?;
        Ok(FrictionOptions {
            tolerance: self.tolerance.real("tolerance")?,
            max_convolutions: most.unwrap_or(default.max_convolutions),
            coupling: self.coupling.flag("coupling")?,
            ..default
        })
    }
}

/// Steps of sliding: one step, or those of a history.
#[pyfunction]
pub(super) fn slide(
    py: Python<'_>,
    shape: &Bound<'_, PyAny>,
    step: PyFrictionStep<'_>,
    steps: Option<Vec<PyFrictionStep<'_>>>,
    options: PyFrictionOptions<'_>,
    on: PyOn<'_>,
) -> PyResult<PyFrictionSteps> {
    let (first, several) = (step.read()?, steps.is_some());
    let steps = match steps {
        Some(steps) => history(py, first, &steps)?,
        None => vec![first],
    };
    friction_steps(py, shape, options, on, |_, _| Ok((Moves::Slide(steps), several)))
}

/// Steps of rolling: one step, or one for each cell that is rolled.
#[pyfunction]
pub(super) fn roll(
    py: Python<'_>,
    shape: &Bound<'_, PyAny>,
    rolling: PyRolling<'_>,
    options: PyFrictionOptions<'_>,
    on: PyOn<'_>,
) -> PyResult<PyFrictionSteps> {
    let cells = rolling.cells.count("cells", 1)?;
    if cells.is_none() && options.initial.get().is_some() {
        return Err(PyValueError::new_err(
            "initial must be given with cells: the steady state does not depend on it",
        ));
    }
    friction_steps(py, shape, options, on, |shape, options| {
        options.order = rolling.order(options.order)?;
        let rolling = rolling.read(shape)?;
        Ok(match cells {
            Some(cells) => (Moves::RollCells(rolling, cells), true),
            None => (Moves::RollSteadily(rolling), false),
        })
    })
}

/// The steps of the moves of a shape, on a plan or on one that is made for it.
fn friction_steps(
    py: Python<'_>,
    shape: &Bound<'_, PyAny>,
    keywords: PyFrictionOptions<'_>,
    on: PyOn<'_>,
    moves: impl FnOnce(&Shape, &mut FrictionOptions) -> PyResult<(Moves, bool)>,
) -> PyResult<PyFrictionSteps> {
    let last: Option<Bound<'_, PyFrictionSolved>> =
        keywords.initial.of("initial", "a nacre.types.FrictionSolution")?;
    let last = last.map(|last| Arc::clone(&last.get().0));
    let mut options = keywords.read()?;
    let progress = keywords.progress.callable("progress")?;
    keywords.check.flag("check")?;
    let shape = shape_of(shape)?;
    let (moves, several) = moves(&shape, &mut options)?;
    let contact = match on {
        PyOn::Plan(plan) => Arc::clone(&plan.get().0),
        PyOn::Setup(setup) => planned(py, &setup, &shape, moves.widest(), last.as_deref())?,
    };
    if let Moves::RollCells(_, cells) = moves {
        let [nx, ny] = contact.grid().shape();
        check_memory("cells", cells.into_pyobject(py)?.as_any(), KEPT_BYTES * (nx * ny) as f64)?;
    }
    let problem = Arc::new(Problem { contact, shape, moves, options });
    Ok(PyFrictionSteps { problem, several, progress, number: 0, last })
}

/// A contact of the given bodies: on the given grid, on that of the step before, or on one that fits the shape.
pub(super) fn planned(
    py: Python<'_>,
    setup: &PySetup<'_>,
    shape: &Shape,
    motion: Option<Motion>,
    last: Option<&FrictionSolution>,
) -> PyResult<Arc<Contact>> {
    let (cells, (body, setup, grid)) = (setup.max_cells()?, setup.read()?);
    let grid = grid.or_else(|| last.map(|last| *last.grid()));
    if motion.is_none() && last.is_none() {
        let message = "load or approach must be given, in the call or in the first step";
        return Err(PyValueError::new_err(message));
    }
    let (shape, motion) = (shape.clone(), motion.unwrap_or_default());
    let contact = background::run(py, None, move |caller: &mut Caller<()>| {
        let grid = match grid {
            Some(grid) => grid,
            None => {
                let (options, ask) =
                    (Options { cells, ..Options::default() }, &mut |_: &_| caller.ask(|| ()));
                choose_grid(&shape, &body, &setup, &motion, options.watched(ask))?
            }
        };
        Contact::plan(&body, grid, setup)
    })??;
    Ok(Arc::new(contact))
}

/// Steps of a history. The first one moves along z, and has the friction, as the call says where it does not say it.
fn history(py: Python<'_>, call: Step, steps: &[PyFrictionStep<'_>]) -> PyResult<Vec<Step>> {
    let plain = Step { motion: call.motion, friction: call.friction.clone(), ..Step::default() };
    if plain != call {
        return Err(PyValueError::new_err(
            "shift, force, twist and torque must be given in the steps, where there are steps",
        ));
    }
    let mut history = Vec::new();
    for (number, step) in steps.iter().enumerate() {
        history.push(step.read().inspect_err(|error| {
            let _ = error.add_note(py, format!("step {number}"));
        })?);
    }
    let Some(first) = history.first_mut() else {
        return Err(PyValueError::new_err("steps must hold a step at least"));
    };
    first.motion = first.motion.or(call.motion);
    first.friction = first.friction.take().or(call.friction);
    Ok(history)
}

fn cells(value: &Bound<'_, PyAny>) -> PyResult<usize> {
    count("cells", 8, value)
}

/// Kalker's linear coefficients of two bodies with any layers; `nacre.creep_coefficients`.
#[pyfunction]
pub(super) fn creep_coefficients(
    py: Python<'_>,
    #[pyo3(from_py_with = half_space)] body: HalfSpace,
    counterbody: Option<&Bound<'_, PyAny>>,
    semi_axes: Pair,
    #[pyo3(from_py_with = cells)] cells: usize,
) -> PyResult<Plain<CreepCoefficients>> {
    let counterbody = counterbody.map(half_space).transpose()?.map(Body::from);
    let Pair(axes) = semi_axes;
    let coefficients = background::run(py, None, move |caller: &mut Caller<()>| {
        let mut watch = || caller.ask(|| ());
        crate::friction::creep_coefficients(body, counterbody, axes, Some(cells), Some(&mut watch))
    })??;
    Ok(Plain(coefficients))
}
