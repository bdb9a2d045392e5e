//! Keyword arguments of a solve, and how it runs: without the interpreter, told of Ctrl-C.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use super::arrays::{Repr, count, number, pair, real_matrix};
use super::background;
use super::report::PyReport;
use super::shapes::{PyShape, Shape};
use super::solution::PySolution;
use super::{ConvergenceError, NacreWarning};
use crate::contact::{Algorithm, Motion, Options, Report, Solution, Termination};
use crate::error::Error;

pub(super) fn algorithm(word: &str) -> PyResult<Algorithm> {
    match word {
        "cascade" => Ok(Algorithm::Cascade),
        "polonsky-keer" => Ok(Algorithm::PolonskyKeer),
        other => Err(Error::Choice {
            name: "algorithm",
            requirement: "\"cascade\" or \"polonsky-keer\"",
            value: other.into(),
        }
        .into()),
    }
}

/// A shape.
pub(super) fn shape<'a, 'py>(shape: &'a Bound<'py, PyAny>) -> PyResult<&'a Bound<'py, PyShape>> {
    shape.cast::<PyShape>().map_err(|_| {
        PyTypeError::new_err(format!("shape must be a nacre.Shape, got {}", Repr(shape)))
    })
}

/// The rigid motion that is asked.
pub(super) fn motion(
    load: Option<&Bound<'_, PyAny>>,
    approach: Option<&Bound<'_, PyAny>>,
    eccentricity: Option<&Bound<'_, PyAny>>,
    moment: Option<&Bound<'_, PyAny>>,
    tilt: Option<&Bound<'_, PyAny>>,
) -> PyResult<Motion> {
    Ok(Motion {
        load: number("load", load)?,
        approach: number("approach", approach)?,
        eccentricity: pair("eccentricity", eccentricity)?,
        moment: pair("moment", moment)?,
        tilt: pair("tilt", tilt)?,
    })
}

/// How a solution is found.
pub(super) fn options(
    tolerance: f64,
    max_iterations: Option<&Bound<'_, PyAny>>,
    algorithm: &str,
    initial: Option<&Bound<'_, PyAny>>,
) -> PyResult<Options> {
    let initial = match initial {
        Some(initial) => Some(match initial.cast::<PySolution>() {
            Ok(solution) => solution.get().pressure_field().clone(),
            Err(_) => real_matrix("initial", initial)?,
        }),
        None => None,
    };
    Ok(Options {
        tolerance,
        max_iterations: max_iterations
            .map(|value| count("max_iterations", 0, value))
            .transpose()?,
        algorithm: self::algorithm(algorithm)?,
        initial,
    })
}

/// A callback, if there is one.
pub(super) fn progress_callable(
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Option<Py<PyAny>>> {
    match progress {
        Some(progress) if !progress.is_callable() => Err(PyTypeError::new_err(format!(
            "progress must be callable, got {}",
            Repr(progress)
        ))),
        progress => Ok(progress.map(|progress| progress.clone().unbind())),
    }
}

/// Keyword arguments that `solve` and `Contact.solve` share.
pub(super) struct Call {
    shape: Shape,
    motion: Motion,
    options: Options,
    progress: Option<Py<PyAny>>,
    check: bool,
}

impl Call {
    #[expect(
        clippy::too_many_arguments,
        reason = "one for each keyword of Python's signature"
    )]
    pub(super) fn new(
        shape: &Bound<'_, PyAny>,
        load: Option<&Bound<'_, PyAny>>,
        approach: Option<&Bound<'_, PyAny>>,
        eccentricity: Option<&Bound<'_, PyAny>>,
        moment: Option<&Bound<'_, PyAny>>,
        tilt: Option<&Bound<'_, PyAny>>,
        tolerance: f64,
        max_iterations: Option<&Bound<'_, PyAny>>,
        algorithm: &str,
        initial: Option<&Bound<'_, PyAny>>,
        progress: Option<&Bound<'_, PyAny>>,
        check: bool,
    ) -> PyResult<Self> {
        Ok(Self {
            shape: self::shape(shape)?.get().0.clone(),
            motion: self::motion(load, approach, eccentricity, moment, tilt)?,
            options: self::options(tolerance, max_iterations, algorithm, initial)?,
            progress: progress_callable(progress)?,
            check,
        })
    }

    /// Runs `work` in the background; it is interrupted by Ctrl-C, and by the callback.
    pub(super) fn run(
        self,
        py: Python<'_>,
        work: impl FnOnce(
            &Shape,
            &Motion,
            &Options,
            &mut crate::contact::Progress,
        ) -> crate::Result<Solution>
        + Send
        + 'static,
    ) -> PyResult<PySolution> {
        let Self {
            shape,
            motion,
            options,
            progress,
            check,
        } = self;
        let tolerance = options.tolerance;
        let solution = background::run(py, progress, move |caller| {
            work(&shape, &motion, &options, &mut |report| {
                caller.ask(|| (PyReport(report.clone()),))
            })
        })?;
        finish(py, solution?, tolerance, check)
    }
}

/// Issues the warnings, and raises where the tolerance was not met.
pub(super) fn finish(
    py: Python<'_>,
    solution: Solution,
    tolerance: f64,
    check: bool,
) -> PyResult<PySolution> {
    let category = py.get_type::<NacreWarning>();
    for warning in &solution.report.warnings {
        let message = std::ffi::CString::new(warning.to_string())?;
        PyErr::warn(py, &category, &message, 1)?;
    }
    if check && solution.report.termination == Termination::IterationLimit {
        let Report {
            iterations,
            residual,
            overlap,
            ..
        } = solution.report;
        let message = Error::NotConverged {
            iterations,
            residual,
            overlap,
            tolerance,
        }
        .to_string();
        let error = ConvergenceError::new_err(message);
        error
            .value(py)
            .setattr("solution", Bound::new(py, PySolution::from(solution))?)?;
        return Err(error);
    }
    Ok(solution.into())
}
