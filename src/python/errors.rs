//! Exceptions of Python: `nacre.ConvergenceError`, `nacre.NacreWarning`, and those that errors become.

use pyo3::create_exception;
use pyo3::exceptions::{PyMemoryError, PyRuntimeError, PyUserWarning, PyValueError};
use pyo3::prelude::*;

use crate::error::Error;

create_exception!(
    nacre,
    ConvergenceError,
    PyRuntimeError,
    "The iteration did not reach its tolerance; the unfinished solution is `.solution`."
);
create_exception!(
    nacre,
    NacreWarning,
    PyUserWarning,
    "Warning about a solution that its user should read."
);

impl From<Error> for PyErr {
    fn from(error: Error) -> Self {
        let message = error.to_string();
        match error {
            Error::NotConverged { .. } => ConvergenceError::new_err(message),
            Error::Memory { .. } => PyMemoryError::new_err(message),
            _ => PyValueError::new_err(message),
        }
    }
}
