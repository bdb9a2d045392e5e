//! Handle of a solved contact with friction; `nacre.types.FrictionSolution` is the class around it.

use std::sync::Arc;

use ndarray::{Array2, Axis, Ix3, stack};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::{Deserialize, Serialize};

use crate::friction::{Friction, FrictionReport, FrictionSolution, TangentialMotion};
use crate::python::arguments::keywords::Keywords;
use crate::python::arguments::{read_only, real_array, real_matrix};
use crate::python::data::{read, text};
use crate::python::solution::PySolution;
use crate::python::stress::{PyStressPlan, evaluated, planned, summarised};
use crate::python::words::Word;
use crate::stress::Member;

/// A solved contact with friction.
#[pyclass(name = "FrictionSolved", module = "nacre._core", frozen, eq)]
#[derive(PartialEq)]
pub(in crate::python) struct PyFrictionSolved(pub(super) Arc<FrictionSolution>);

/// Solution of a `nacre.types.FrictionSolution`, which has its handle under this name.
pub(in crate::python::contact) fn solved(
    object: &Bound<'_, PyAny>,
) -> Option<Arc<FrictionSolution>> {
    let handle = object.getattr_opt("_solved").ok()??;
    Some(Arc::clone(&handle.cast::<PyFrictionSolved>().ok()?.get().0))
}

/// Coefficient of friction: a number, or one for each cell.
pub(super) fn coefficient(given: &Bound<'_, PyAny>) -> PyResult<Friction> {
    let values = real_array("friction", given)?;
    Ok(match values.ndim() {
        0 => Friction::Uniform(values.sum()),
        _ => Friction::Cells(real_matrix("friction", given)?),
    })
}

/// Both components of a field (2, nx, ny).
fn components(name: &str, given: &Bound<'_, PyAny>) -> PyResult<[Array2<f64>; 2]> {
    let field = real_array(name, given)?;
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
struct Numbers<'a> {
    force: [f64; 2],
    torque: f64,
    dissipated: f64,
    tangential_energy: f64,
    #[serde(flatten)]
    motion: TangentialMotion,
    report: &'a FrictionReport,
}

#[pymethods]
impl PyFrictionSolved {
    /// Solution with this normal contact, these fields, and JSON text of motion and report.
    #[new]
    fn new(
        normal: &Bound<'_, PySolution>,
        friction: &Bound<'_, PyAny>,
        traction: &Bound<'_, PyAny>,
        displacement: &Bound<'_, PyAny>,
        slip: &Bound<'_, PyAny>,
        rest: &str,
    ) -> PyResult<Self> {
        let Rest { motion, report } = read("FrictionSolution", rest)?;
        let solution = FrictionSolution {
            normal: normal.get().solution().clone(),
            friction: coefficient(friction)?,
            traction: components("traction", traction)?,
            displacement: components("displacement", displacement)?,
            slip: components("slip", slip)?,
            motion,
            report,
        };
        Ok(Self(Arc::new(solution.checked()?)))
    }

    fn normal(&self) -> PySolution {
        self.0.normal.clone().into()
    }

    /// JSON text of all numbers, with motion and report.
    fn numbers(&self) -> PyResult<String> {
        text(&Numbers {
            force: self.0.force(),
            torque: self.0.torque(),
            dissipated: self.0.dissipated(),
            tangential_energy: self.0.tangential_energy(),
            motion: self.0.motion,
            report: &self.0.report,
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

    fn stress<'py>(
        &self,
        z: &Bound<'py, PyAny>,
        asked: &Bound<'py, PyDict>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let keywords = Keywords::new(z.py(), Some(asked))?;
        let member = keywords.word("body")?;
        let solution = Arc::clone(&self.0);
        evaluated(z, &keywords, self.0.normal.member(member)?, move |depths, options| {
            solution.stress(depths, member, options)
        })
    }

    fn stress_summary(&self, asked: &Bound<'_, PyDict>) -> PyResult<String> {
        let keywords = Keywords::new(asked.py(), Some(asked))?;
        let member = keywords.word("body")?;
        let solution = Arc::clone(&self.0);
        let body = self.0.normal.member(member)?;
        summarised(asked.py(), &keywords, body, move |strengths, options| {
            solution.stress_summary(member, strengths, options)
        })
    }

    fn stress_plan(
        &self,
        py: Python<'_>,
        body: &str,
        threads: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PyStressPlan> {
        let member = Member::from_word(body)?;
        let solution = Arc::clone(&self.0);
        planned(py, threads, move |options| solution.stress_plan(member, options))
    }
}
