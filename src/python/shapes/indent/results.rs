//! What `nacre.indent.Indentation` returns beside states: `IndentCurve` and `PullOff`.

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

/// Loads at approaches, with their derivatives; see `Indentation.curve`.
#[pyclass(name = "IndentCurve", module = "nacre.indent", frozen, get_all)]
pub(in crate::python) struct PyIndentCurve {
    /// Approaches [m].
    pub(super) approach: Py<PyArray1<f64>>,
    /// Loads [N].
    pub(super) load: Py<PyArray1<f64>>,
    /// Contact radii [m].
    pub(super) radius: Py<PyArray1<f64>>,
    /// dP/dδ along the curve [N/m].
    pub(super) slope: Py<PyArray1<f64>>,
    /// Derivatives of the loads at given approach, (points, parameters), per unit of each parameter.
    pub(super) derivatives: Py<PyArray2<f64>>,
    /// What makes the deepest point doubtful, a list of sentences, empty as a rule. Each was also issued as a `nacre.NacreWarning`.
    pub(super) warnings: Vec<String>,
}

/// Last stable state of a tip that is pulled off; see `Indentation.pull_off`.
#[pyclass(name = "PullOff", module = "nacre.indent", frozen, eq, get_all)]
#[derive(PartialEq)]
pub(in crate::python) struct PyPullOff {
    /// Load [N], below 0.
    pub(super) load: f64,
    /// Approach [m].
    pub(super) approach: f64,
    /// Contact radius [m]; 0 where the surfaces attract each other without touching.
    pub(super) radius: f64,
    /// Radius up to which the surfaces attract each other [m].
    pub(super) outer_radius: f64,
}

#[pymethods]
impl PyPullOff {
    fn __repr__(&self) -> String {
        format!(
            "PullOff(load={:?}, approach={:?}, radius={:?}, outer_radius={:?})",
            self.load, self.approach, self.radius, self.outer_radius
        )
    }
}
