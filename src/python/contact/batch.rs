//! Many load cases on one plan.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyMapping};

use crate::contact::{Case, Contact, Motion, Options, Solution};
use crate::error::Result;
use crate::python::arguments::Repr;
use crate::python::arguments::keywords::{self, Keywords};
use crate::python::background::{self, Caller};
use crate::python::shapes::{PyShape, Shape, shape};
use crate::python::solution::PySolution;

/// Shape and motion of a case.
fn case(case: &Bound<'_, PyAny>) -> PyResult<(Py<PyShape>, Motion)> {
    let mapping = case.cast::<PyMapping>().map_err(|_| {
        let got = Repr(case);
        PyTypeError::new_err(format!("a case must be a mapping of keywords of `solve`, got {got}"))
    })?;
    let keywords = Keywords::of_mapping(mapping)?;
    let pressed = keywords.given("shape")?;
    let motion = keywords::motion(&keywords)?;
    keywords.finish("a case's keys")?;
    let pressed = pressed.ok_or_else(|| PyTypeError::new_err("a case must have a shape"))?;
    Ok((shape(&pressed)?.clone().unbind(), motion))
}

/// `error` with a note that names its case.
fn of_case(py: Python<'_>, error: PyErr, number: usize) -> PyErr {
    let noted = error.value(py).call_method1("add_note", (format!("in case {number}"),));
    noted.err().unwrap_or(error)
}

/// Finished solutions, at the place of their case.
type Finished = Arc<Mutex<Vec<Option<Result<Solution>>>>>;

fn lock(finished: &Finished) -> MutexGuard<'_, Vec<Option<Result<Solution>>>> {
    finished.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Solutions of `cases` on `contact`. An error that interrupts it carries the finished ones as its
/// `solutions`.
pub(super) fn solve_many(
    py: Python<'_>,
    contact: &Arc<Contact>,
    cases: &Bound<'_, PyAny>,
    options: Options,
    progress: Option<Py<PyAny>>,
    check: bool,
) -> PyResult<Vec<Py<PySolution>>> {
    let mut parsed = Vec::new();
    let iterable = cases.try_iter().map_err(|_| {
        let got = Repr(cases);
        PyTypeError::new_err(format!("cases must be an iterable of mappings, got {got}"))
    })?;
    for (number, item) in iterable.enumerate() {
        parsed.push(case(&item?).map_err(|error| of_case(py, error, number))?);
    }
    let (total, tolerance) = (parsed.len(), options.tolerance);
    let shapes: Vec<Shape> = parsed.iter().map(|(shape, _)| shape.get().0.clone()).collect();
    let finished = Finished::default();
    lock(&finished).resize_with(total, || None);
    let (contact, kept) = (Arc::clone(contact), Arc::clone(&finished));
    let ended = background::run(py, progress, move |caller: &mut Caller<(usize, usize)>| {
        let cases: Vec<Case> = parsed
            .iter()
            .map(|(shape, motion)| Case { shape: &shape.get().0, motion: *motion })
            .collect();
        contact.check_memory_for(&cases)?;
        let done = AtomicUsize::new(0);
        let keep = |number: usize, solved| {
            // After an interrupt there is no place left.
            if let Some(place) = lock(&kept).get_mut(number) {
                *place = Some(solved);
                done.fetch_add(1, Ordering::Relaxed);
            }
        };
        let mut told = 0;
        contact.solve_each(&cases, &options, &keep, &mut || {
            let done = done.load(Ordering::Relaxed);
            if done > told {
                told = done;
                caller.tell(|| (done, total));
            }
            caller.go_on()
        })
    });
    let mut failure = match ended {
        Ok(solved) => solved.map(|()| None)?,
        Err(interrupt) => Some(interrupt),
    };
    let solved = std::mem::take(&mut *lock(&finished));
    let mut solutions: Vec<Option<Py<PySolution>>> = Vec::with_capacity(total);
    for (number, solved) in solved.into_iter().enumerate() {
        let finished = |solved: Result<Solution>| {
            PySolution::finished(py, solved?, &shapes[number], tolerance, check)
        };
        let outcome = solved.map(finished);
        let solution = match outcome {
            None => None,
            Some(Ok(solution)) => Some(Py::new(py, solution)?),
            Some(Err(error)) => {
                let unfinished = error.value(py).getattr_opt("solution")?;
                failure.get_or_insert_with(|| of_case(py, error, number));
                unfinished.and_then(|solution| solution.extract().ok())
            }
        };
        solutions.push(solution);
    }
    if let Some(error) = failure {
        error.value(py).setattr("solutions", PyList::new(py, solutions)?)?;
        return Err(error);
    }
    Ok(solutions.into_iter().flatten().collect())
}
