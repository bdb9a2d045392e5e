//! Handle of a planned contact, and solves; `nacre.Contact` and `nacre.solve` are around them.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use numpy::PyArray2;
use pyo3::prelude::*;

use super::arguments::{Argument, count, read_only, real_matrix};
use super::background::{self, Caller};
use super::bodies::{PyBody, body};
use super::grid::PyGrid;
use super::shapes::{Shape, shape};
use super::solved::{PySolved, ReportParts, compliance, hardness, report_parts};
use crate::compliance::response::Body;
use crate::contact::{
    Case, Contact, Motion, Options, Report, SMALLEST_GRID, Setup, Solution, solve_with,
};
use crate::error::Result;
use crate::model::grid::Grid;

/// A body on a grid, planned.
#[pyclass(name = "Plan", module = "nacre._core", frozen)]
pub(super) struct PyPlan(pub(super) Arc<Contact>);

#[pymethods]
impl PyPlan {
    #[new]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = body)] body: Body,
        grid: PyGrid,
        counterbody: Option<&Bound<'_, PyAny>>,
        coefficients: Option<&Bound<'_, PyAny>>,
        threads: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let coefficients = coefficients.map(|object| real_matrix("coefficients", object));
        let setup = Setup {
            counterbody: counterbody.map(self::body).transpose()?,
            coefficients: coefficients.transpose()?.map(|matrix| matrix.into_shared()),
            threads: threads.map(|number| count("threads", 1, number)).transpose()?,
        };
        let contact = background::run(py, None, move |_: &mut Caller<()>| {
            Contact::plan(&body, grid.0, setup)
        })??;
        Ok(Self(Arc::new(contact)))
    }

    fn body(&self) -> PyBody {
        self.0.body().into()
    }

    fn counterbody(&self) -> Option<PyBody> {
        self.0.setup().counterbody.as_ref().map(PyBody::from)
    }

    fn grid(&self) -> PyGrid {
        PyGrid(*self.0.grid())
    }

    fn coefficients<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let coefficients = self.0.setup().coefficients.as_ref();
        coefficients.map(|matrix| read_only(py, matrix.to_owned())).transpose()
    }

    fn threads(&self) -> usize {
        self.0.convolution().threads()
    }

    /// Number of threads that was asked for.
    fn asked_threads(&self) -> Option<usize> {
        self.0.setup().threads
    }

    fn __eq__(&self, other: &Self) -> bool {
        let (a, b) = (&self.0, &other.0);
        (a.grid(), a.body(), a.setup()) == (b.grid(), b.body(), b.setup())
    }

    /// Solutions of cases, each a shape and its motion: of each the solution, an error, or `None` where it was not
    /// finished; and the error that interrupted it.
    fn solve_many<'py>(
        &self,
        py: Python<'py>,
        cases: Vec<(Bound<'py, PyAny>, PyMotion<'py>)>,
        options: PySolveOptions<'py>,
    ) -> PyResult<Outcomes<'py>> {
        let (options, progress) = options.read()?;
        let mut parsed = Vec::new();
        for (number, (shape, motion)) in cases.iter().enumerate() {
            let parts = shape_of(shape).and_then(|shape| Ok((shape, motion.read()?)));
            parsed.push(parts.map_err(|error| of_case(py, error, number))?);
        }
        let finished: Finished = Arc::default();
        lock(&finished).resize_with(parsed.len(), || None);
        let (contact, kept) = (Arc::clone(&self.0), Arc::clone(&finished));
        let ended = background::run(py, progress, move |caller| {
            solve_each(&contact, &parsed, &options, &kept, caller)
        });
        let interrupt = match ended {
            Ok(solved) => solved.map(|()| None)?,
            Err(interrupt) => Some(interrupt.into_value(py).into_bound(py).into_any()),
        };
        let solved = std::mem::take(&mut *lock(&finished));
        let outcome = |(number, solved): (usize, Option<Result<Solution>>)| match solved {
            None => Ok(py.None().into_bound(py)),
            Some(Ok(solution)) => Ok(Bound::new(py, PySolved::from(solution))?.into_any()),
            Some(Err(error)) => {
                Ok(of_case(py, error.into(), number).into_value(py).into_bound(py).into_any())
            }
        };
        Ok((solved.into_iter().enumerate().map(outcome).collect::<PyResult<_>>()?, interrupt))
    }
}

/// What became of each case, and what interrupted them.
type Outcomes<'py> = (Vec<Bound<'py, PyAny>>, Option<Bound<'py, PyAny>>);

/// Finished solutions, at the place of their case.
type Finished = Arc<Mutex<Vec<Option<Result<Solution>>>>>;

fn lock(finished: &Finished) -> MutexGuard<'_, Vec<Option<Result<Solution>>>> {
    finished.lock().unwrap_or_else(PoisonError::into_inner)
}

/// `error` with a note that names its case.
fn of_case(py: Python<'_>, error: PyErr, number: usize) -> PyErr {
    let _ = error.add_note(py, format!("in case {number}"));
    error
}

/// Solves `cases`, and tells the caller how many of them are `finished`.
fn solve_each(
    contact: &Contact,
    cases: &[(Shape, Motion)],
    options: &Options,
    finished: &Finished,
    caller: &mut Caller<(usize, usize)>,
) -> Result<()> {
    let cases: Vec<Case> =
        cases.iter().map(|(shape, motion)| Case { shape, motion: *motion }).collect();
    contact.check_memory_for(&cases)?;
    let done = AtomicUsize::new(0);
    let keep = |number: usize, solved| {
        // After an interrupt there is no place left.
        if let Some(place) = lock(finished).get_mut(number) {
            *place = Some(solved);
            done.fetch_add(1, Ordering::Relaxed);
        }
    };
    let mut last_count = 0;
    contact.solve_each(&cases, options, &keep, &mut || {
        let done = done.load(Ordering::Relaxed);
        if done > last_count {
            last_count = done;
            caller.tell(|| (done, cases.len()));
        }
        caller.go_on()
    })
}

/// Shape that is pressed in.
pub(super) fn shape_of(object: &Bound<'_, PyAny>) -> PyResult<Shape> {
    Ok(shape(object)?.get().0.clone())
}

/// `nacre.contact.arguments.Motion`.
#[derive(FromPyObject)]
pub(super) struct PyMotion<'py> {
    load: Argument<'py>,
    approach: Argument<'py>,
    eccentricity: Argument<'py>,
    moment: Argument<'py>,
    tilt: Argument<'py>,
}

impl PyMotion<'_> {
    pub(super) fn read(&self) -> PyResult<Motion> {
        Ok(Motion {
            load: self.load.number("load")?,
            approach: self.approach.number("approach")?,
            eccentricity: self.eccentricity.pair("eccentricity")?,
            moment: self.moment.pair("moment")?,
            tilt: self.tilt.pair("tilt")?,
        })
    }
}

/// `nacre.contact.arguments.SolveOptions`.
#[derive(FromPyObject)]
pub(super) struct PySolveOptions<'py> {
    hardness: Argument<'py>,
    compliance: Argument<'py>,
    tolerance: Argument<'py>,
    max_iterations: Argument<'py>,
    algorithm: Argument<'py>,
    initial: Argument<'py>,
    progress: Argument<'py>,
    check: Argument<'py>,
}

impl PySolveOptions<'_> {
    /// Options of a solve from a uniform pressure, and its callback.
    fn read(&self) -> PyResult<(Options, Option<Py<PyAny>>)> {
        let options = Options {
            tolerance: self.tolerance.real("tolerance")?,
            max_iterations: self.max_iterations.count("max_iterations", 0)?,
            algorithm: self.algorithm.word("algorithm")?,
            hardness: self.hardness.map(hardness)?,
            compliance: self.compliance.map(compliance)?,
            ..Options::default()
        };
        self.check.flag("check")?;
        Ok((options, self.progress.callable("progress")?))
    }
}

/// `nacre.contact.arguments.Setup`.
#[derive(FromPyObject)]
pub(super) struct PySetup<'py> {
    body: Argument<'py>,
    counterbody: Argument<'py>,
    grid: Argument<'py>,
    max_cells: Argument<'py>,
    threads: Argument<'py>,
}

impl PySetup<'_> {
    /// Bodies, and the grid where one is given.
    pub(super) fn read(&self) -> PyResult<(Body, Setup, Option<Grid>)> {
        let grid: Option<PyGrid> = self.grid.of("grid", "a nacre.Grid")?;
        let setup = Setup {
            counterbody: self.counterbody.map(body)?,
            coefficients: None,
            threads: self.threads.count("threads", 1)?,
        };
        Ok((body(&self.body.0)?, setup, grid.map(|grid| grid.0)))
    }

    /// Largest number of cells of a grid that is chosen.
    pub(super) fn max_cells(&self) -> PyResult<Option<usize>> {
        self.max_cells.count("max_cells", SMALLEST_GRID)
    }
}

/// What a contact is solved on.
#[derive(FromPyObject)]
pub(super) enum PyOn<'py> {
    Plan(Bound<'py, PyPlan>),
    Setup(PySetup<'py>),
}

/// Where a contact is solved: on a plan, or on one that is made.
enum On {
    Plan(Arc<Contact>),
    Bodies(Body, Setup, Option<Grid>),
}

/// Solution of a shape that is pressed in, on a plan or on one that is made for it.
#[pyfunction]
pub(super) fn solve(
    py: Python<'_>,
    shape: &Bound<'_, PyAny>,
    motion: PyMotion<'_>,
    options: PySolveOptions<'_>,
    on: PyOn<'_>,
) -> PyResult<PySolved> {
    let (shape, motion, initial) = (shape_of(shape)?, motion.read()?, options.initial.get());
    let (mut options, progress) = options.read()?;
    let (mut first, mut dented) = (None, None);
    if let Some(initial) = initial {
        if let Ok(before) = initial.cast::<PySolved>() {
            let before = &before.get().0;
            options.initial = Some(before.pressure.clone());
            options.indentation.clone_from(&before.indentation);
            first = Some(*before.grid());
            dented = before.indentation.as_ref().map(|_| Arc::clone(before));
        } else {
            options.initial = Some(real_matrix("initial", initial)?);
        }
    }
    let on = match on {
        PyOn::Plan(plan) => On::Plan(Arc::clone(&plan.get().0)),
        PyOn::Setup(setup) => {
            options.cells = setup.max_cells()?;
            let (body, setup, grid) = setup.read()?;
            // A permanent indentation lies on its grid.
            let grid = grid.or_else(|| dented.as_ref().map(|before| *before.grid()));
            On::Bodies(body, setup, grid)
        }
    };
    if let Some(before) = dented {
        let (body, setup) = match &on {
            On::Plan(plan) => (plan.body(), plan.setup()),
            On::Bodies(body, setup, _) => (body, setup),
        };
        before.report.check_bodies(body, setup.counterbody.as_ref())?;
    }
    let solution = background::run(py, progress, move |caller: &mut Caller<ReportParts>| {
        let tell = &mut |report: &Report| caller.ask(|| report_parts(report));
        let watched = options.watched(tell);
        match on {
            On::Bodies(body, setup, None) => {
                let solution = solve_with(&shape, &body, &setup, &motion, watched)?;
                solution.grid().check_initial(first.as_ref())?;
                Ok(solution)
            }
            On::Bodies(body, setup, Some(grid)) => {
                grid.check_initial(first.as_ref())?;
                Contact::plan(&body, grid, setup)?.solve(&shape, &motion, watched)
            }
            On::Plan(plan) => {
                plan.grid().check_initial(first.as_ref())?;
                plan.solve(&shape, &motion, watched)
            }
        }
    })?;
    Ok(solution?.into())
}
