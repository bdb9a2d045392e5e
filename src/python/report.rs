//! `nacre.Report`.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::bodies::PyHalfSpace;
use super::contact::{method, method_words};
use super::grid::PyGrid;
use crate::contact::{Balance, Discretisation, Motion, Report, Termination, Warning};

/// How a solution came about, and how good it is: computed afresh at the end.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> report = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0).report
/// >>> report.termination, report.residual < 1e-8, report.warnings
/// ('converged', True, [])
#[pyclass(name = "Report", module = "nacre", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub(super) struct PyReport(pub(super) Report);

/// Load, approach, eccentricity, moment and tilt.
type MotionState = (Option<f64>, Option<f64>, [[Option<f64>; 2]; 3]);

/// Termination, iterations and convolutions, quality, balance and discretisation, warnings, grid and bodies, method and
/// refinement, motion, tolerance and seconds.
type State = (
    String,
    (usize, f64),
    [f64; 2],
    (f64, [f64; 2], Option<[f64; 3]>),
    Vec<(String, usize, f64)>,
    (PyGrid, PyHalfSpace, Option<PyHalfSpace>),
    (String, usize),
    MotionState,
    (f64, f64),
);

fn termination_word(termination: Termination) -> &'static str {
    match termination {
        Termination::Converged => "converged",
        Termination::IterationLimit => "iteration limit",
        Termination::Stopped => "stopped",
    }
}

#[pymethods]
impl PyReport {
    /// Whether the tolerance was met.
    #[getter]
    fn converged(&self) -> bool {
        self.0.converged()
    }

    /// How the iteration ended: "converged", "iteration limit" or "stopped".
    #[getter]
    fn termination(&self) -> &'static str {
        termination_word(self.0.termination)
    }

    /// Iterations done.
    #[getter]
    fn iterations(&self) -> usize {
        self.0.iterations
    }

    /// Work done, in convolutions of the whole grid.
    #[getter]
    fn convolutions(&self) -> f64 {
        self.0.convolutions
    }

    /// Complementarity ``sum(p |g|) / sum(p u)`` over the cells that can touch.
    #[getter]
    fn residual(&self) -> f64 {
        self.0.residual
    }

    /// ``max(-g, 0) / max(u)`` over the cells that can touch.
    #[getter]
    fn overlap(&self) -> f64 {
        self.0.overlap
    }

    /// Mismatch of the force over W, and of the moments over W times half the side.
    #[getter]
    fn balance(&self) -> (f64, f64, f64) {
        let Balance {
            force,
            moment: [x, y],
        } = self.0.balance;
        (force, x, y)
    }

    /// Estimated errors that the size of the cells leaves, from coarser grids.
    ///
    /// Of ``peak_pressure`` [Pa], ``approach`` [m] and ``load`` [N]; what is prescribed has none.
    /// `None` where no coarser grid was solved: on small grids, from a given pressure, by
    /// another algorithm, or without convergence.
    #[getter]
    fn discretisation<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(errors) = self.0.discretisation else {
            return Ok(None);
        };
        let named = PyDict::new(py);
        named.set_item("peak_pressure", errors.peak_pressure)?;
        named.set_item("approach", errors.approach)?;
        named.set_item("load", errors.load)?;
        Ok(Some(named))
    }

    /// What the user should know; each was also issued as a `nacre.NacreWarning`.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.0.warnings.iter().map(ToString::to_string).collect()
    }

    /// The grid.
    #[getter]
    fn grid(&self) -> PyGrid {
        PyGrid(self.0.grid)
    }

    /// The body that the shape was pressed into.
    #[getter]
    fn body(&self) -> PyHalfSpace {
        PyHalfSpace::of(&self.0.body)
    }

    /// The body that carries the shape; rigid where `None`.
    #[getter]
    fn counterbody(&self) -> Option<PyHalfSpace> {
        self.0.counterbody.as_ref().map(PyHalfSpace::of)
    }

    /// How the influence coefficients were computed.
    #[getter]
    fn method(&self) -> &'static str {
        method_words(self.0.method).0
    }

    /// Refinement of the spectral mesh of the conversions; 4 with exact coefficients, which have none.
    #[getter]
    fn refinement(&self) -> usize {
        method_words(self.0.method).1
    }

    /// What was asked, as keywords of `Contact.solve`: load or approach, and of the tilts.
    #[getter]
    fn motion<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let motion = &self.0.motion;
        let keywords = PyDict::new(py);
        for (name, value) in [("load", motion.load), ("approach", motion.approach)] {
            if let Some(value) = value {
                keywords.set_item(name, value)?;
            }
        }
        for (name, pair) in [
            ("eccentricity", motion.eccentricity),
            ("moment", motion.moment),
            ("tilt", motion.tilt),
        ] {
            if pair != [None; 2] {
                keywords.set_item(name, (pair[0], pair[1]))?;
            }
        }
        Ok(keywords)
    }

    /// The tolerance that was asked.
    #[getter]
    fn tolerance(&self) -> f64 {
        self.0.tolerance
    }

    /// Seconds the solve took, planning excluded.
    #[getter]
    fn seconds(&self) -> f64 {
        self.0.seconds
    }

    fn __repr__(&self) -> String {
        format!(
            "<nacre.Report: {} after {} iterations, {:.1} convolutions, {:.3} s; residual {:.1e}, \
             overlap {:.1e}; {} warnings>",
            self.termination(),
            self.0.iterations,
            self.0.convolutions,
            self.0.seconds,
            self.0.residual,
            self.0.overlap,
            self.0.warnings.len()
        )
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (State,))> {
        let report = &self.0;
        let (word, refinement) = method_words(report.method);
        let warnings = report.warnings.iter().map(|warning| match *warning {
            Warning::GridEdge => ("grid edge", 0, 0.0),
            Warning::SharpEnd { axis } => ("sharp end", axis, 0.0),
            Warning::Coarse { axis, cells } => ("coarse", axis, cells as f64),
            Warning::LargeContact { axis, ratio } => ("large contact", axis, ratio),
        });
        let state = (
            self.termination().into(),
            (report.iterations, report.convolutions),
            [report.residual, report.overlap],
            (
                report.balance.force,
                report.balance.moment,
                report
                    .discretisation
                    .map(|d| [d.peak_pressure, d.approach, d.load]),
            ),
            warnings
                .map(|(kind, axis, value)| (kind.into(), axis, value))
                .collect(),
            (PyGrid(report.grid), self.body(), self.counterbody()),
            (word.into(), refinement),
            (
                report.motion.load,
                report.motion.approach,
                [
                    report.motion.eccentricity,
                    report.motion.moment,
                    report.motion.tilt,
                ],
            ),
            (report.tolerance, report.seconds),
        );
        Ok((
            py.import("nacre._core")?.getattr("_restore_report")?,
            (state,),
        ))
    }
}

/// A report from its pickled state.
#[pyfunction(name = "_restore_report")]
pub(super) fn restore_report(state: State) -> PyResult<PyReport> {
    let (
        termination,
        counts,
        quality,
        balance,
        warnings,
        (grid, body, counterbody),
        (word, refinement),
        (load, approach, [eccentricity, moment, tilt]),
        (tolerance, seconds),
    ) = state;
    let unknown = |word: &str| PyValueError::new_err(format!("not a pickled report: {word:?}"));
    let termination = [
        Termination::Converged,
        Termination::IterationLimit,
        Termination::Stopped,
    ]
    .into_iter()
    .find(|t| termination_word(*t) == termination)
    .ok_or_else(|| unknown(&termination))?;
    let warnings = warnings
        .into_iter()
        .map(|(kind, axis, value)| match kind.as_str() {
            "grid edge" => Ok(Warning::GridEdge),
            "sharp end" => Ok(Warning::SharpEnd { axis }),
            "coarse" => Ok(Warning::Coarse {
                axis,
                cells: value as usize,
            }),
            "large contact" => Ok(Warning::LargeContact { axis, ratio: value }),
            other => Err(unknown(other)),
        });
    Ok(PyReport(Report {
        termination,
        solver: None,
        iterations: counts.0,
        convolutions: counts.1,
        residual: quality[0],
        overlap: quality[1],
        balance: Balance {
            force: balance.0,
            moment: balance.1,
        },
        discretisation: balance
            .2
            .map(|[peak_pressure, approach, load]| Discretisation {
                peak_pressure,
                approach,
                load,
            }),
        warnings: warnings.collect::<PyResult<_>>()?,
        grid: grid.0,
        body: body.0.into(),
        counterbody: counterbody.map(|body| body.0.into()),
        method: method(&word, refinement)?,
        motion: Motion {
            load,
            approach,
            eccentricity,
            moment,
            tilt,
        },
        tolerance,
        seconds,
    }))
}
