//! `nacre.FrictionReport`.

use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::friction::FrictionReport;
use crate::python::state::{self, Fields, Reduced, State, from_dict_docs, to_dict_docs};
use crate::python::words::Word;

/// Report of a contact with friction: its course, and how well the laws hold.
///
/// Errors are computed afresh at the end, with the operator of the whole grid.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> ball = nacre.slide(nacre.Sphere(5e-3), steel, steel, load=10.0, friction=0.3, force=(1.5, None))
/// >>> ball.report.termination, ball.report.violation < 1e-8, ball.report.full_slip
/// ('converged', True, False)
#[pyclass(name = "FrictionReport", module = "nacre.types", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub(in crate::python) struct PyFrictionReport(pub(in crate::python) FrictionReport);

impl State for PyFrictionReport {
    const KIND: &'static str = "FrictionReport";

    fn write(&self, fields: &Fields) -> PyResult<()> {
        let report = &self.0;
        fields.set("termination", report.termination.word())?;
        fields.set("convolutions", report.convolutions)?;
        fields.set("sweeps", report.sweeps)?;
        fields.set("violation", report.violation)?;
        fields.set("imbalance", report.imbalance)?;
        fields.set("excess", report.excess)?;
        fields.set("pressure_change", report.pressure_change)?;
        fields.set("coupled", report.coupled)?;
        fields.set("full_slip", report.full_slip)?;
        fields.set("tolerance", report.tolerance)?;
        fields.set("seconds", report.seconds)
    }

    fn read(fields: &Fields) -> PyResult<Self> {
        let termination: String = fields.get("termination")?;
        Ok(Self(FrictionReport {
            termination: Word::from_word(&termination)?,
            convolutions: fields.get("convolutions")?,
            sweeps: fields.get("sweeps")?,
            violation: fields.get("violation")?,
            imbalance: fields.get("imbalance")?,
            excess: fields.get("excess")?,
            pressure_change: fields.get("pressure_change")?,
            coupled: fields.get("coupled")?,
            full_slip: fields.get("full_slip")?,
            tolerance: fields.get("tolerance")?,
            seconds: fields.get("seconds")?,
        }))
    }
}

#[pymethods]
impl PyFrictionReport {
    /// Whether the tolerance was met.
    #[getter]
    fn converged(&self) -> bool {
        self.0.converged()
    }

    /// How the iteration ended: "converged", "iteration limit" or "stopped"; "running" in progress.
    #[getter]
    fn termination(&self) -> &'static str {
        self.0.termination.word()
    }

    /// Tangential convolutions of the window of the contact, from two components to two.
    #[getter]
    fn convolutions(&self) -> usize {
        self.0.convolutions
    }

    /// Solves of the pressure for given tractions, and of tractions for given pressure.
    #[getter]
    fn sweeps(&self) -> usize {
        self.0.sweeps
    }

    /// Largest slip of a sticking cell, or slip across the traction, over the largest displacement.
    #[getter]
    fn violation(&self) -> f64 {
        self.0.violation
    }

    /// Largest error of a given force or torque, over the largest that friction bears.
    #[getter]
    fn imbalance(&self) -> f64 {
        self.0.imbalance
    }

    /// Largest traction above its bound, over the largest bound.
    #[getter]
    fn excess(&self) -> f64 {
        self.0.excess
    }

    /// Change of the pressure in the last sweep, over the peak; 0 without coupling.
    #[getter]
    fn pressure_change(&self) -> f64 {
        self.0.pressure_change
    }

    /// Whether tractions and pressure act on each other.
    #[getter]
    fn coupled(&self) -> bool {
        self.0.coupled
    }

    /// Whether all cells in contact slip.
    #[getter]
    fn full_slip(&self) -> bool {
        self.0.full_slip
    }

    /// Tolerance that was asked for.
    #[getter]
    fn tolerance(&self) -> f64 {
        self.0.tolerance
    }

    /// Seconds that the step took, without planning.
    #[getter]
    fn seconds(&self) -> f64 {
        self.0.seconds
    }

    fn __repr__(&self) -> String {
        let report = &self.0;
        format!(
            "<FrictionReport: {}, {} convolutions, violation {:.1e}, imbalance {:.1e}>",
            report.termination.word(),
            report.convolutions,
            report.violation,
            report.imbalance,
        )
    }

    #[doc = to_dict_docs!()]
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> ball = nacre.slide(nacre.Sphere(5e-3), steel, steel, load=10.0, friction=0.3, force=(1.5, None))
    /// >>> ball.report.to_dict()["sweeps"]
    /// 1
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        state::to_dict(py, self)
    }

    #[doc = from_dict_docs!()]
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> ball = nacre.slide(nacre.Sphere(5e-3), steel, steel, load=10.0, friction=0.3, force=(1.5, None))
    /// >>> nacre.types.FrictionReport.from_dict(ball.report.to_dict()) == ball.report
    /// True
    #[staticmethod]
    fn from_dict(data: &Bound<'_, PyAny>) -> PyResult<Self> {
        state::from_dict(data)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        state::reduce(py, self)
    }
}
