//! Python bindings: newtypes and one-line wrappers. Nothing else in the crate knows Python.

use pyo3::create_exception;
use pyo3::exceptions::{PyMemoryError, PyRuntimeError, PyUserWarning, PyValueError};
use pyo3::prelude::*;

use crate::error::Error;

mod arrays;
mod background;
mod batch;
mod bodies;
mod call;
mod contact;
mod evaluation;
mod functions;
mod grid;
mod profiles;
mod report;
mod shapes;
mod solution;
mod stress;
mod summary;

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
    "Something about a solution that its user should know."
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

#[pymodule(name = "_core")]
mod core {
    #[pymodule_export]
    use super::bodies::{PyElastic, PyHalfSpace, PyLayer, PyRigid};
    #[pymodule_export]
    use super::contact::{PyContact, solve};
    #[pymodule_export]
    use super::functions::{frequency_response, graded_layers, influence_coefficients};
    #[pymodule_export]
    use super::grid::PyGrid;
    #[pymodule_export]
    use super::profiles::{PyLogarithmicProfile, PySampledProfile};
    #[pymodule_export]
    use super::report::{PyReport, restore_report};
    #[pymodule_export]
    use super::shapes::{
        PyCylinder, PyFlatPunch, PyHeightMap, PyParaboloid, PyRoller, PyShape, PySphere,
    };
    #[pymodule_export]
    use super::solution::{PySolution, restore_solution};
    #[pymodule_export]
    use super::stress::{PyStress, restore_stress, stress};
    #[pymodule_export]
    use super::summary::{
        PyInterfaceStress, PyLayerStress, PyStressSummary, restore_interface_stress,
        restore_layer_stress, restore_stress_summary,
    };
    #[pymodule_export]
    use super::{ConvergenceError, NacreWarning};
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("RIGID", Py::new(module.py(), PyRigid)?)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
