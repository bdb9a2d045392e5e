//! `nacre.Report`.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::compliance::ends::FreeEnds;
use crate::contact::{Balance, Discretisation, Motion, Report, Warning};
use crate::python::bodies::PyHalfSpace;
use crate::python::grid::PyGrid;
use crate::python::state::{self, Fields, Reduced, State, from_dict_docs, to_dict_docs};
use crate::python::words::{Word, warning, warning_words};

/// Report of a solve: how the solution came about and how good it is, computed afresh at the end.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> report = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0).report
/// >>> report.termination, report.residual < 1e-8, report.warnings
/// ('converged', True, [])
#[pyclass(name = "Report", module = "nacre.types", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub(in crate::python) struct PyReport(pub(in crate::python) Report);

/// Named state of a report: a field stands here once in `write`, once in `read`, and once as a getter of
/// [`PyReport`].
impl State for PyReport {
    const KIND: &'static str = "Report";

    fn write(&self, fields: &Fields) -> PyResult<()> {
        let report = &self.0;
        fields.set("termination", report.termination.word())?;
        fields.set("solver", report.solver.map(Word::word))?;
        fields.set("iterations", report.iterations)?;
        fields.set("convolutions", report.convolutions)?;
        fields.set("residual", report.residual)?;
        fields.set("overlap", report.overlap)?;
        fields.set_fields("balance", |balance| {
            balance.set("force", report.balance.force)?;
            balance.set("moment", report.balance.moment)
        })?;
        match &report.discretisation {
            None => fields.set("discretisation", None::<f64>)?,
            Some(errors) => fields.set_fields("discretisation", |fields| {
                fields.set("peak_pressure", errors.peak_pressure)?;
                fields.set("approach", errors.approach)?;
                fields.set("load", errors.load)
            })?,
        }
        fields.set_list("warnings", &report.warnings, |warning, fields| {
            let (kind, axis, figure) = warning_words(warning);
            fields.set("kind", kind)?;
            fields.set("axis", axis)?;
            fields.set("figure", figure)
        })?;
        fields.set_part("grid", PyGrid(report.grid))?;
        fields.set_part("body", PyHalfSpace::of(&report.body))?;
        fields.set_part("counterbody", self.counterbody())?;
        fields.set_fields("motion", |motion| {
            motion.set("load", report.motion.load)?;
            motion.set("approach", report.motion.approach)?;
            motion.set("eccentricity", report.motion.eccentricity)?;
            motion.set("moment", report.motion.moment)?;
            motion.set("tilt", report.motion.tilt)
        })?;
        fields.set("rolling_direction", report.rolling_direction)?;
        fields.set("tolerance", report.tolerance)?;
        fields.set("seconds", report.seconds)
    }

    fn read(fields: &Fields) -> PyResult<Self> {
        let termination: String = fields.get("termination")?;
        let solver: Option<String> = fields.get("solver")?;
        let counterbody: Option<PyHalfSpace> = fields.get_part("counterbody")?;
        checked(Report {
            termination: Word::from_word(&termination)?,
            solver: solver.as_deref().map(Word::from_word).transpose()?,
            iterations: fields.get("iterations")?,
            convolutions: fields.get("convolutions")?,
            residual: fields.get("residual")?,
            overlap: fields.get("overlap")?,
            balance: fields.get_fields("balance")?.read(|balance| {
                Ok(Balance { force: balance.get("force")?, moment: balance.get("moment")? })
            })?,
            discretisation: match fields.get_optional("discretisation")? {
                None => None,
                Some(errors) => Some(errors.read(|errors| {
                    Ok(Discretisation {
                        peak_pressure: errors.get("peak_pressure")?,
                        approach: errors.get("approach")?,
                        load: errors.get("load")?,
                    })
                })?),
            },
            warnings: fields.get_list("warnings", |fields| {
                let kind: String = fields.get("kind")?;
                warning(&kind, fields.get("axis")?, fields.get("figure")?)
            })?,
            grid: fields.get_part::<PyGrid>("grid")?.0,
            body: fields.get_part::<PyHalfSpace>("body")?.0.into(),
            counterbody: counterbody.map(|body| body.0.into()),
            motion: fields.get_fields("motion")?.read(|motion| {
                Ok(Motion {
                    load: motion.get("load")?,
                    approach: motion.get("approach")?,
                    eccentricity: motion.get("eccentricity")?,
                    moment: motion.get("moment")?,
                    tilt: motion.get("tilt")?,
                })
            })?,
            rolling_direction: fields.get_newer("rolling_direction")?,
            tolerance: fields.get("tolerance")?,
            seconds: fields.get("seconds")?,
        })
        .map(Self)
    }
}

/// `report`, if all its numbers are ones that a solve can have.
fn checked(report: Report) -> PyResult<Report> {
    let motion = &report.motion;
    let pairs = [motion.eccentricity, motion.moment, motion.tilt].concat();
    let asked = [motion.load, motion.approach].into_iter().chain(pairs);
    let balance = [report.balance.force].into_iter().chain(report.balance.moment);
    let estimates = report.discretisation.iter().flat_map(|errors| {
        let others = [errors.approach, errors.load];
        errors.peak_pressure.into_iter().chain(others)
    });
    let sizes = [
        ("residual", report.residual),
        ("overlap", report.overlap),
        ("convolutions", report.convolutions),
        ("tolerance", report.tolerance),
        ("seconds", report.seconds),
    ];
    let numbers = asked
        .flatten()
        .map(|number| ("motion", number))
        .chain(balance.map(|number| ("balance", number)))
        .chain(estimates.map(|number| ("discretisation", number)));
    let sizes = sizes.map(|(name, value)| (name, value, value >= 0.0));
    let numbers = numbers.map(|(name, value)| (name, value, value.is_finite()));
    match sizes.into_iter().chain(numbers).find(|(.., fits)| !fits) {
        None => Ok(report),
        Some((name, value, _)) => Err(PyValueError::new_err(format!(
            "report: the value of the key {name:?} does not fit: {value}"
        ))),
    }
}

#[pymethods]
impl PyReport {
    /// Whether the tolerance was met.
    #[getter]
    fn converged(&self) -> bool {
        self.0.converged()
    }

    /// End of the iteration: "converged", "iteration limit" or "stopped"; "running" before it.
    #[getter]
    fn termination(&self) -> &'static str {
        self.0.termination.word()
    }

    /// Iteration that produced the solution: "preconditioned", "active-set" or "polonsky-keer".
    ///
    /// The algorithm "cascade" starts with the first and falls back to the others. `None` where it is not
    /// known: before the end.
    #[getter]
    fn solver(&self) -> Option<&'static str> {
        self.0.solver.map(Word::word)
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
    ///
    /// Where the local displacement is less than u, as on a substrate much softer than its coating, it
    /// takes the place of u.
    #[getter]
    fn residual(&self) -> f64 {
        self.0.residual
    }

    /// Largest overlap ``max(-g, 0) / max(u)`` of the cells that can touch.
    ///
    /// Where the local displacement is less than the largest u, it takes its place.
    #[getter]
    fn overlap(&self) -> f64 {
        self.0.overlap
    }

    /// Mismatch of the force, as a part of W, and of the moments along x and y, of W times half a side.
    #[getter]
    fn balance(&self) -> (f64, f64, f64) {
        let Balance { force, moment: [x, y] } = self.0.balance;
        (force, x, y)
    }

    /// Errors due to the size of the cells, estimated from coarser grids.
    ///
    /// The keys are ``peak_pressure`` [Pa], ``approach`` [m] and ``load`` [N]; a prescribed quantity
    /// has the error 0. The peak pressure has none, `None`, where the pressure is singular: at a sharp
    /// edge of the shape, or where the grid cuts the contact; a warning says so. `None` altogether where
    /// no coarser grid was solved: on small grids, from a given pressure, by another algorithm, where
    /// surfaces yield, or without convergence.
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

    /// How free ends of the bodies are counted; None where there are none.
    ///
    /// ``plates`` says whether a body has two ends, and is taken as a plate. ``error`` is the largest error of
    /// the displacement, relative to it, that was measured for such bodies, for bare plates that of the pressure
    /// too, larger for lengths below a quarter of the grid's width; None for layers whose moduli differ by a factor of
    /// more than 10.
    #[getter]
    fn free_ends<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(FreeEnds { plates, error }) = self.0.free_ends() else {
            return Ok(None);
        };
        let named = PyDict::new(py);
        named.set_item("plates", plates)?;
        named.set_item("error", error)?;
        Ok(Some(named))
    }

    /// Warnings about the solution; each was also issued as a `nacre.NacreWarning`.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.0.warnings.iter().map(ToString::to_string).collect()
    }

    /// Kinds of the warnings, without their numbers: words by which warnings are counted.
    ///
    /// They are "grid edge", "sharp end", "free end", "coated end", "sharp edge", "map rim", "coarse",
    /// "coarse spots", "large contact", "outside grid" and "peak error".
    #[getter]
    fn warning_kinds(&self) -> Vec<&'static str> {
        self.0.warnings.iter().map(Warning::kind).collect()
    }

    /// Grid of the solve.
    #[getter]
    fn grid(&self) -> PyGrid {
        PyGrid(self.0.grid)
    }

    /// Body that the shape was pressed into.
    #[getter]
    fn body(&self) -> PyHalfSpace {
        PyHalfSpace::of(&self.0.body)
    }

    /// Body that carries the shape; rigid where `None`.
    #[getter]
    fn counterbody(&self) -> Option<PyHalfSpace> {
        self.0.counterbody.as_ref().map(PyHalfSpace::of)
    }

    /// Motion that was asked, as keywords of `Contact.solve`: load or approach, and the tilts.
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

    /// Unit vector ``(x, y)`` along which the shape rolls: across the axis of a roller, y in line contact.
    ///
    /// Friction acts along it where no `direction` is given. `None` where the shape has no such direction,
    /// or it is not known, as in files of earlier versions.
    #[getter]
    fn rolling_direction(&self) -> Option<(f64, f64)> {
        self.0.rolling_direction.map(Into::into)
    }

    /// Tolerance that was asked.
    #[getter]
    fn tolerance(&self) -> f64 {
        self.0.tolerance
    }

    /// Seconds that the solve took, planning excluded.
    #[getter]
    fn seconds(&self) -> f64 {
        self.0.seconds
    }

    fn __repr__(&self) -> String {
        format!(
            "<Report: {} after {} iterations, {:.1} convolutions, {:.3} s; residual {:.1e}, \
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

    #[doc = to_dict_docs!()]
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> state = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0).report.to_dict()
    /// >>> state["format"], state["termination"], state["motion"]["load"]
    /// (1, 'converged', 10.0)
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        state::to_dict(py, self)
    }

    #[doc = from_dict_docs!()]
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> report = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0).report
    /// >>> nacre.types.Report.from_dict(report.to_dict()) == report
    /// True
    #[staticmethod]
    fn from_dict(data: &Bound<'_, PyAny>) -> PyResult<Self> {
        state::from_dict(data)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        state::reduce(py, self)
    }
}
