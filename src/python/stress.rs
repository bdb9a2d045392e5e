//! `nacre.stress`, `nacre.StressPlan`, and the results of evaluations of stress.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::arguments::keywords::Keywords;
use super::arguments::real_matrix;
use super::bodies::{PyHalfSpace, body};
use super::grid::PyGrid;
use super::words::Word;
use crate::model::body::HalfSpace;
use crate::stress::{Member, StressPlan};

mod field;
pub(super) mod keywords;
mod summary;

pub(super) use field::PyStress;
pub(super) use summary::{PyInterfaceStress, PyLayerStress, PyStressSummary};

use keywords::{
    depths, issue_warnings, options, progress_docs, run_signature, section, section_docs,
    section_signature, strength_docs, strength_signature, strengths, threads_docs, traction_docs,
    traction_signature, watched,
};

#[doc = concat!("stress(body, grid, pressure, z, *, ", section_signature!(), ", ", traction_signature!(), ", ", run_signature!(), ")\n--\n")]
/// Stress of a body under a pressure, at any depth.
///
/// Parameters
/// ----------
/// body : HalfSpace or Elastic
///     Body under the pressure; its free ends are counted, but not in the stress of friction.
/// grid : Grid
///     Cells of the pressure.
/// pressure : array_like
///     Pressure ``(nx, ny)`` on the cells [Pa], uniform over each.
/// z : float or array_like
///     Depths, at least 0 [m].
#[doc = section_docs!()]
#[doc = traction_docs!()]
#[doc = threads_docs!()]
#[doc = progress_docs!()]
///
/// Returns
/// -------
/// Stress
///     Components, invariants and displacement.
///
/// Raises
/// ------
/// ValueError
///     If an argument is out of range.
/// MemoryError
///     If the fields do not fit.
///
/// Notes
/// -----
/// The pressure is uniform over a cell. `Solution.stress` uses the pressure within cells of a solved
/// contact, and is more accurate within some cells of the surface.
///
/// Friction does not change the pressure. That is exact where the bodies are alike or
/// incompressible, and a good approximation where the friction is small: the neglected coupling
/// changes the pressure by the order of ``friction * (1 - 2 nu) / (2 - 2 nu)``.
///
/// Examples
/// --------
/// The normal stress under a uniformly loaded square, at the surface minus the pressure:
///
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> grid = nacre.Grid(shape=(65, 65), size=(2e-3, 2e-3))
/// >>> field = nacre.stress(steel, grid, np.full((65, 65), 1e9), [0.0, 0.5e-3], y=0.0)
/// >>> field.zz.shape
/// (2, 65)
/// >>> bool(abs(field.zz[0, 32] + 1e9) < 1.0)
/// True
#[pyfunction]
#[pyo3(signature = (body, grid, pressure, z, **keywords), text_signature = None)]
pub(super) fn stress<'py>(
    py: Python<'py>,
    #[pyo3(from_py_with = body)] body: HalfSpace,
    grid: PyGrid,
    pressure: &Bound<'py, PyAny>,
    z: &Bound<'py, PyAny>,
    keywords: Option<&Bound<'py, PyDict>>,
) -> PyResult<PyStress> {
    let pressure = real_matrix("pressure", pressure)?;
    let (depths, one) = depths(z)?;
    let keywords = Keywords::new(py, keywords)?;
    let mut options = options(&keywords, &body)?;
    options.threads = keywords.count("threads", 1)?;
    let lines = section(&keywords, &mut options)?;
    let progress = keywords.callable("progress")?;
    keywords.finish("keywords of stress")?;
    let evaluated = watched(py, progress, move |progress| {
        let options = options.watched(progress);
        crate::stress::stress(&body, &grid.0, &pressure, &depths, options)
    })?;
    Ok(PyStress::new(evaluated, one, lines))
}

/// A plan of the stress in one body of a solved contact: made once, evaluated any number of times.
///
/// `Solution.stress_plan` makes it. An evaluation has the bits of `Solution.stress` and of
/// `Solution.stress_summary`, without the time that these take to plan.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
/// >>> plan = solution.stress_plan()
/// >>> peaks = [
/// ...     plan.stress(10e-6, friction=mu, direction=(1, 0)).peak()[0] for mu in (0.0, 0.3)
/// ... ]
/// >>> peaks[0] < peaks[1]
/// True
#[pyclass(name = "StressPlan", module = "nacre.types", frozen)]
pub(super) struct PyStressPlan {
    plan: Arc<StressPlan>,
    member: Member,
    /// Number of threads that was asked for.
    threads: Option<usize>,
    /// Solution that the plan was made from, which is pickled in its place.
    solution: Py<PyAny>,
}

impl PyStressPlan {
    /// Plan of a Python solution.
    pub(super) fn new(
        plan: StressPlan,
        member: Member,
        threads: Option<usize>,
        solution: Py<PyAny>,
    ) -> Self {
        Self { plan: Arc::new(plan), member, threads, solution }
    }
}

#[pymethods]
impl PyStressPlan {
    #[doc = concat!("stress($self, z, *, ", section_signature!(), ", ", traction_signature!(), ", progress=None)\n--\n")]
    /// Stress below the surface, at any depth; see `Solution.stress`.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Depths into the body, at least 0 [m].
    #[doc = section_docs!()]
    #[doc = traction_docs!()]
    #[doc = progress_docs!()]
    ///
    /// Returns
    /// -------
    /// Stress
    ///     Components, invariants and displacement.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If an argument is out of range.
    /// MemoryError
    ///     If the fields do not fit.
    ///
    /// Examples
    /// --------
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
    /// >>> solution.stress_plan().stress(10e-6) == solution.stress(10e-6)
    /// True
    #[pyo3(signature = (z, **keywords), text_signature = None)]
    fn stress<'py>(
        &self,
        py: Python<'py>,
        z: &Bound<'py, PyAny>,
        keywords: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<PyStress> {
        let keywords = Keywords::new(py, keywords)?;
        let (depths, one) = depths(z)?;
        let mut options = options(&keywords, self.plan.body())?;
        let lines = section(&keywords, &mut options)?;
        let progress = keywords.callable("progress")?;
        keywords.finish("keywords of StressPlan.stress")?;
        let plan = Arc::clone(&self.plan);
        let evaluated =
            watched(py, progress, move |progress| plan.stress(&depths, options.watched(progress)))?;
        issue_warnings(py, evaluated.warnings())?;
        Ok(PyStress::new(evaluated, one, lines))
    }

    #[doc = concat!("summary($self, *, ", strength_signature!(), ", ", traction_signature!(), ", progress=None)\n--\n")]
    /// Extremes of the stress in each layer and at each interface; see `Solution.stress_summary`.
    ///
    /// Parameters
    /// ----------
    #[doc = strength_docs!()]
    #[doc = traction_docs!()]
    #[doc = progress_docs!()]
    ///
    /// Returns
    /// -------
    /// StressSummary
    ///     Peaks and their points; printing it shows a table.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If an argument is out of range.
    /// MemoryError
    ///     If the grid does not fit.
    ///
    /// Examples
    /// --------
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> grid = nacre.Grid(shape=(32, 32), size=(4e-4, 4e-4))
    /// >>> plan = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0, grid=grid).stress_plan()
    /// >>> bool(plan.summary(yield_stress={"substrate": 1.8e9}).layers[0].yield_safety_factor > 1.0)
    /// True
    #[pyo3(signature = (**keywords), text_signature = None)]
    fn summary<'py>(
        &self,
        py: Python<'py>,
        keywords: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<PyStressSummary> {
        let keywords = Keywords::new(py, keywords)?;
        let body = self.plan.body();
        let strengths = strengths(&keywords, body)?;
        let options = options(&keywords, body)?;
        let progress = keywords.callable("progress")?;
        keywords.finish("keywords of StressPlan.summary")?;
        let plan = Arc::clone(&self.plan);
        let summary = watched(py, progress, move |progress| {
            plan.summary(&strengths, options.watched(progress))
        })?;
        issue_warnings(py, summary.warnings())?;
        Ok(PyStressSummary(summary))
    }

    /// Body in which the stress is.
    #[getter]
    fn body(&self) -> PyHalfSpace {
        PyHalfSpace(self.plan.body().clone())
    }

    fn __eq__(&self, py: Python<'_>, other: &Self) -> PyResult<bool> {
        let alike = (self.member, self.threads) == (other.member, other.threads);
        Ok(alike && self.solution.bind(py).eq(&other.solution)?)
    }

    fn __repr__(&self) -> String {
        format!("<StressPlan of the {}>", self.member.word())
    }

    /// Method and arguments that make the plan again.
    #[expect(clippy::type_complexity, reason = "what pickle takes")]
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, (&'static str, Option<usize>))> {
        let make = self.solution.bind(py).getattr("stress_plan")?;
        Ok((make, (self.member.word(), self.threads)))
    }
}
