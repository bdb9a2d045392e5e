//! Handle of a solved contact; `nacre.Solution` is the class around it.

use std::sync::Arc;

use numpy::PyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::{Deserialize, Deserializer, Serialize};

use super::arguments::{read_only, real_array, real_matrix};
use super::background::{self, Caller};
use super::bodies::PyBody;
use super::data::{Plain, read};
use super::grid::PyGrid;
use crate::compliance::response::Body;
use crate::conductance::Conductor;
use crate::contact::{
    Balance, Compliance, Discretisation, Hardness, Motion, Report, Solution, Solver, Termination,
    Warning,
};

/// A report as data, but for its grid and its bodies.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ReportData {
    termination: Termination,
    solver: Option<Solver>,
    iterations: usize,
    convolutions: f64,
    #[serde(deserialize_with = "or_infinite")]
    residual: f64,
    #[serde(deserialize_with = "or_infinite")]
    overlap: f64,
    balance: Balance,
    discretisation: Option<Discretisation>,
    warnings: Vec<Warning>,
    motion: Motion,
    rolling_direction: Option<[f64; 2]>,
    tolerance: f64,
    seconds: f64,
}

/// Number that is infinite where it is null, as JSON has it.
fn or_infinite<'de, D: Deserializer<'de>>(data: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(data)?.unwrap_or(f64::INFINITY))
}

/// How free ends are counted, as data.
#[derive(Serialize)]
struct FreeEndsData {
    plates: bool,
    error: Option<f64>,
}

/// Fields of a report: its data, the sentences of its warnings, and how free ends are counted.
#[derive(Serialize)]
pub(super) struct ReportFields {
    data: ReportData,
    messages: Vec<String>,
    free_ends: Option<FreeEndsData>,
}

/// Fields of a report, its grid and its bodies.
pub(super) type ReportParts = (Plain<ReportFields>, PyGrid, PyBody, Option<PyBody>);

/// JSON text of a report's data, its grid and its bodies.
type ReportState = (String, PyGrid, PyBody, Option<PyBody>);

/// The report for `nacre.types.Report`.
pub(super) fn report_parts(report: &Report) -> ReportParts {
    let of = report.clone();
    let fields = ReportFields {
        messages: report.warnings.iter().map(ToString::to_string).collect(),
        free_ends: report
            .free_ends()
            .map(|ends| FreeEndsData { plates: ends.plates, error: ends.error }),
        data: ReportData {
            termination: of.termination,
            solver: of.solver,
            iterations: of.iterations,
            convolutions: of.convolutions,
            residual: of.residual,
            overlap: of.overlap,
            balance: of.balance,
            discretisation: of.discretisation,
            warnings: of.warnings,
            motion: of.motion,
            rolling_direction: of.rolling_direction,
            tolerance: of.tolerance,
            seconds: of.seconds,
        },
    };
    let counterbody = report.counterbody.as_ref().map(PyBody::from);
    (Plain(fields), PyGrid(report.grid), (&report.body).into(), counterbody)
}

/// Report of JSON text, a grid and bodies, checked.
fn report_of((text, grid, body, counterbody): ReportState) -> PyResult<Report> {
    let of: ReportData = read("Report", &text)?;
    for (name, value) in [
        ("convolutions", of.convolutions),
        ("residual", of.residual.min(f64::MAX)),
        ("overlap", of.overlap.min(f64::MAX)),
        ("tolerance", of.tolerance),
        ("seconds", of.seconds),
    ] {
        crate::error::not_negative(name, value)?;
    }
    Ok(Report {
        termination: of.termination,
        solver: of.solver,
        iterations: of.iterations,
        convolutions: of.convolutions,
        residual: of.residual,
        overlap: of.overlap,
        balance: of.balance,
        discretisation: of.discretisation,
        warnings: of.warnings,
        grid: grid.0,
        body: body.into(),
        counterbody: counterbody.map(Body::from),
        motion: of.motion,
        rolling_direction: of.rolling_direction,
        tolerance: of.tolerance,
        seconds: of.seconds,
    })
}

/// Parts of the report that JSON text, a grid and bodies describe, checked.
#[pyfunction]
pub(super) fn checked_report(
    text: String,
    grid: PyGrid,
    body: PyBody,
    counterbody: Option<PyBody>,
) -> PyResult<ReportParts> {
    Ok(report_parts(&report_of((text, grid, body, counterbody))?))
}

/// Position of a solution from a state.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Position {
    approach: f64,
    tilt: [f64; 2],
}

/// Numbers of a solution.
#[derive(Serialize)]
pub(super) struct Numbers {
    load: f64,
    eccentricity: [f64; 2],
    moment: [f64; 2],
    approach: f64,
    tilt: [f64; 2],
    contact_area: f64,
    contact_extent: [[f64; 2]; 2],
    peak_pressure: f64,
    peak_position: [f64; 2],
    central_pressure: f64,
    plastic_work: f64,
}

/// A solved contact.
#[pyclass(name = "Solved", module = "nacre._core", frozen, eq)]
#[derive(PartialEq)]
pub(super) struct PySolved(pub(super) Arc<Solution>);

impl From<Solution> for PySolved {
    fn from(solution: Solution) -> Self {
        Self(Arc::new(solution))
    }
}

/// Hardness: a number, or one for each cell.
pub(super) fn hardness(value: &Bound<'_, PyAny>) -> PyResult<Hardness> {
    let values = real_array("hardness", value)?;
    Ok(match values.ndim() {
        0 => Hardness::Uniform(values.sum()),
        _ => Hardness::Cells(real_matrix("hardness", value)?),
    })
}

/// Compliance of springs: a number, or one for each cell.
pub(super) fn compliance(value: &Bound<'_, PyAny>) -> PyResult<Compliance> {
    let values = real_array("compliance", value)?;
    Ok(match values.ndim() {
        0 => Compliance::Uniform(values.sum()),
        _ => Compliance::Cells(real_matrix("compliance", value)?),
    })
}

#[pymethods]
impl PySolved {
    /// Solution with JSON text of its position, the state of its report, and its fields.
    #[new]
    #[pyo3(signature = (
        position, report, *, pressure, gap, displacement, hardness=None, indentation=None, coefficients=None,
        compliance=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "one for each field of a state")]
    fn new(
        position: &str,
        report: ReportState,
        pressure: Option<Bound<'_, PyAny>>,
        gap: Option<Bound<'_, PyAny>>,
        displacement: Option<Bound<'_, PyAny>>,
        hardness: Option<Bound<'_, PyAny>>,
        indentation: Option<Bound<'_, PyAny>>,
        coefficients: Option<Bound<'_, PyAny>>,
        compliance: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let field = |name: &str, value: Option<Bound<'_, PyAny>>| -> PyResult<_> {
            value.map(|value| real_matrix(name, &value)).transpose()
        };
        let needed = |name: &str, value: Option<Bound<'_, PyAny>>| {
            let missing = || PyValueError::new_err(format!("{name} must be an array, got None"));
            field(name, value)?.ok_or_else(missing)
        };
        let Position { approach, tilt } = read("Solution", position)?;
        let arrays = [
            needed("pressure", pressure)?,
            needed("gap", gap)?,
            needed("displacement", displacement)?,
        ];
        let mut solution = Solution::from_fields(arrays, approach, tilt, report_of(report)?)?;
        if let Some(coefficients) = field("coefficients", coefficients)? {
            solution = solution.with_coefficients(coefficients)?;
        }
        if let Some(compliance) = compliance {
            solution = solution.with_compliance(self::compliance(&compliance)?)?;
        }
        let hardness = hardness.map(|value| self::hardness(&value)).transpose()?;
        Ok(solution.yielding(hardness, field("indentation", indentation)?)?.into())
    }

    fn numbers(&self) -> Plain<Numbers> {
        let of = &self.0;
        Plain(Numbers {
            load: of.load(),
            eccentricity: of.eccentricity(),
            moment: of.moment(),
            approach: of.approach,
            tilt: of.tilt,
            contact_area: of.contact_area(),
            contact_extent: of.contact_extent(),
            peak_pressure: of.peak_pressure(),
            peak_position: of.peak_position(),
            central_pressure: of.central_pressure(),
            plastic_work: of.plastic_work(),
        })
    }

    /// Array of that name, or `None`; the hardness may be a number.
    fn field<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
        let of = &self.0;
        let array = match name {
            "in_contact" => return Ok(Some(read_only(py, of.in_contact())?.into_any())),
            "pressure" => Some(of.pressure.clone()),
            "gap" => Some(py.detach(|| of.gap())),
            "displacement" => Some(of.displacement.clone()),
            "indentation" => of.indentation.clone(),
            "coefficients" => of.coefficients.as_ref().map(|matrix| matrix.to_owned()),
            "compliance" => match &of.compliance {
                Some(Compliance::Uniform(value)) => {
                    return Ok(Some(value.into_pyobject(py)?.into_any()));
                }
                Some(Compliance::Cells(values)) => Some(values.clone()),
                None => None,
            },
            "line_load" => return Ok(Some(read_only(py, of.line_load())?.into_any())),
            _ => match &of.hardness {
                Some(Hardness::Uniform(value)) => {
                    return Ok(Some(value.into_pyobject(py)?.into_any()));
                }
                Some(Hardness::Cells(values)) => Some(values.clone()),
                None => None,
            },
        };
        array.map(|array| Ok(read_only(py, array)?.into_any())).transpose()
    }

    fn grid(&self) -> PyGrid {
        PyGrid(*self.0.grid())
    }

    fn report(&self) -> ReportParts {
        report_parts(&self.0.report)
    }

    /// Sentences of the warnings.
    fn warnings(&self) -> Vec<String> {
        self.0.report.warnings.iter().map(ToString::to_string).collect()
    }

    /// Message of the error where the tolerance was not met before a limit.
    fn not_converged(&self) -> Option<String> {
        let report = &self.0.report;
        let missed = report.termination == Termination::IterationLimit;
        missed.then(|| report.not_converged(report.tolerance).to_string())
    }

    fn stiffness<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let solution = Arc::clone(&self.0);
        let stiffness = background::run(py, None, move |caller: &mut Caller<()>| {
            solution.stiffness(Some(&mut || caller.go_on()))
        })??;
        Ok(PyArray2::from_owned_array(py, stiffness.to_vec().into()))
    }

    /// Resistance, its error, and the share of each cell of the flux; conductivities of body and counterbody from the surface down.
    fn conductance<'py>(
        &self,
        py: Python<'py>,
        conductivities: [Vec<f64>; 2],
        film: &Bound<'py, PyAny>,
    ) -> PyResult<(f64, f64, Bound<'py, PyArray2<f64>>)> {
        let report = &self.0.report;
        let [body, counterbody] = &conductivities;
        let conductors = [
            Conductor::of(Some(&report.body), body)?,
            Conductor::of(report.counterbody.as_ref(), counterbody)?,
        ];
        let (solution, film) = (Arc::clone(&self.0), compliance(film)?);
        let through = background::run(py, None, move |caller: &mut Caller<()>| {
            solution.conductance(conductors, Some(film), Some(&mut || caller.go_on()))
        })??;
        let flux = PyArray2::from_owned_array(py, through.flux);
        Ok((through.resistance, through.uncertainty, flux))
    }
}
