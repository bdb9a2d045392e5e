//! `nacre.Contact` and `nacre.solve`.

use std::sync::Arc;

use pyo3::prelude::*;

use super::arrays::count;
use super::background::{self, Caller};
use super::batch;
use super::bodies::{PyHalfSpace, body};
use super::call::{Call, options};
use super::grid::PyGrid;
use super::solution::PySolution;
use crate::body::HalfSpace;
use crate::contact::{Contact, Setup, choose_grid};
use crate::error::Error;
use crate::influence::Method;
use crate::response::Body;

/// The method of that name.
pub(super) fn method(word: &str, refinement: usize) -> PyResult<Method> {
    Ok(match word {
        "exact" => Method::Exact,
        "plain" => Method::Plain { refinement },
        "difference" => Method::Difference { refinement },
        "image" => Method::Image { refinement },
        other => {
            return Err(Error::Choice {
                name: "method",
                requirement: "\"exact\", \"plain\", \"difference\" or \"image\"",
                value: other.into(),
            }
            .into());
        }
    })
}

/// Name and refinement of a method.
pub(super) fn method_words(method: Method) -> (&'static str, usize) {
    match method {
        Method::Exact => ("exact", REFINEMENT),
        Method::Plain { refinement } => ("plain", refinement),
        Method::Difference { refinement } => ("difference", refinement),
        Method::Image { refinement } => ("image", refinement),
    }
}

const REFINEMENT: usize = 4;

/// A body on a grid, planned once: influence coefficients and their transform.
///
/// Parameters
/// ----------
/// body : HalfSpace or Elastic
///     The body that the shape is pressed into.
/// grid : Grid
///     The cells.
/// counterbody : HalfSpace or Elastic, optional
///     The body that carries the shape; rigid where there is none.
/// method : {"exact", "plain", "difference", "image"}, optional
///     How influence coefficients are computed; see `influence_coefficients`.
/// refinement : int, optional
///     Refinement of the spectral mesh of the conversions, 4 by default.
/// threads : int, optional
///     Threads that belong to the plan; all of the machine's by default.
///
/// Raises
/// ------
/// ValueError
///     If an argument is out of range.
/// MemoryError
///     If the grid does not fit: a plan and a solve take up to 160 bytes a cell.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> contact = nacre.Contact(steel, nacre.Grid(shape=(64, 64), size=(4e-4, 4e-4)))
/// >>> solution = contact.solve(nacre.Sphere(5e-3), load=10.0)
/// >>> round(solution.load, 6)
/// 10.0
#[pyclass(name = "Contact", module = "nacre", frozen)]
pub(super) struct PyContact {
    contact: Arc<Contact>,
}

fn setup(
    counterbody: Option<&Bound<'_, PyAny>>,
    method: &str,
    refinement: Option<&Bound<'_, PyAny>>,
    threads: Option<&Bound<'_, PyAny>>,
) -> PyResult<Setup> {
    let refinement = refinement.map_or(Ok(REFINEMENT), |r| count("refinement", 1, r))?;
    Ok(Setup {
        counterbody: counterbody.map(body).transpose()?.map(Body::from),
        method: self::method(method, refinement)?,
        threads: threads
            .map(|value| count("threads", 1, value))
            .transpose()?,
    })
}

type NewArguments = (PyHalfSpace, PyGrid, Option<PyHalfSpace>);
type NewKeywords = std::collections::BTreeMap<&'static str, Py<PyAny>>;

#[pymethods]
impl PyContact {
    #[new]
    #[pyo3(signature = (body, grid, counterbody=None, *, method="exact", refinement=None, threads=None))]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = body)] body: HalfSpace,
        grid: PyGrid,
        counterbody: Option<&Bound<'_, PyAny>>,
        method: &str,
        refinement: Option<&Bound<'_, PyAny>>,
        threads: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let setup = setup(counterbody, method, refinement, threads)?;
        let contact = background::run(py, None, move |_: &mut Caller<()>| {
            Contact::plan(&body, grid.0, setup)
        })??;
        Ok(Self {
            contact: Arc::new(contact),
        })
    }

    /// The body that the shape is pressed into.
    #[getter]
    fn body(&self) -> PyHalfSpace {
        PyHalfSpace::of(self.contact.body())
    }

    /// The body that carries the shape; rigid where `None`.
    #[getter]
    fn counterbody(&self) -> Option<PyHalfSpace> {
        self.contact
            .setup()
            .counterbody
            .as_ref()
            .map(PyHalfSpace::of)
    }

    /// The cells.
    #[getter]
    fn grid(&self) -> PyGrid {
        PyGrid(*self.contact.grid())
    }

    /// How influence coefficients are computed.
    #[getter]
    fn method(&self) -> &'static str {
        method_words(self.contact.setup().method).0
    }

    /// Threads of the plan.
    #[getter]
    fn threads(&self) -> usize {
        self.contact.convolution().threads()
    }

    /// Presses `shape` into the body.
    ///
    /// Each of the three freedoms of the rigid motion is prescribed or loaded, in any mixture:
    /// exactly one of `load` and `approach`, and along x and along y at most one of
    /// `eccentricity`, `moment` and `tilt`; with none of them the tilt is locked at 0.
    ///
    /// Parameters
    /// ----------
    /// shape : Shape
    ///     What is pressed in.
    /// load : float, optional
    ///     Force W [N], above 0.
    /// approach : float, optional
    ///     Approach of the origin [m], from the datum h = 0.
    /// eccentricity : tuple of float or None, optional
    ///     Where the load acts, ``(e_x, e_y)`` [m].
    /// moment : tuple of float or None, optional
    ///     First moments of the pressure about the origin [N m].
    /// tilt : tuple of float or None, optional
    ///     Slopes ``(s_x, s_y)``.
    /// tolerance : float, optional
    ///     Largest residual and overlap of a converged solution.
    /// max_iterations : int, optional
    ///     Iterations after which to give up; 10 000 by default.
    /// algorithm : {"cascade", "polonsky-keer"}, optional
    ///     Preconditioned conjugate gradients on nested grids, in a window around the contact; or
    ///     the paper's solver (doi:10.1016/S0043-1648(99)00113-1), as a reference.
    /// initial : Solution or array_like, optional
    ///     Pressure to start from ``(nx, ny)`` [Pa].
    /// progress : callable, optional
    ///     Called with a `Report` at each iteration; returning False stops, and gives the
    ///     unfinished solution.
    /// check : bool, optional
    ///     Whether to raise where the tolerance was not met.
    ///
    /// Returns
    /// -------
    /// Solution
    ///     Pressure, gap, displacement, approach and tilt.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If an argument is out of range, or the arguments contradict each other.
    /// ConvergenceError
    ///     If the tolerance was not met; the unfinished solution is its `solution`.
    ///
    /// Examples
    /// --------
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> contact = nacre.Contact(steel, nacre.Grid(shape=(64, 64), size=(4e-4, 4e-4)))
    /// >>> contact.solve(nacre.Sphere(5e-3), approach=-1e-6).load
    /// 0.0
    #[expect(
        clippy::too_many_arguments,
        reason = "keywords of the public signature"
    )]
    #[pyo3(signature = (shape, *, load=None, approach=None, eccentricity=None, moment=None, tilt=None,
        tolerance=1e-8, max_iterations=None, algorithm="cascade", initial=None, progress=None,
        check=true))]
    fn solve<'py>(
        &self,
        py: Python<'py>,
        shape: &Bound<'py, PyAny>,
        load: Option<&Bound<'py, PyAny>>,
        approach: Option<&Bound<'py, PyAny>>,
        eccentricity: Option<&Bound<'py, PyAny>>,
        moment: Option<&Bound<'py, PyAny>>,
        tilt: Option<&Bound<'py, PyAny>>,
        tolerance: f64,
        max_iterations: Option<&Bound<'py, PyAny>>,
        algorithm: &str,
        initial: Option<&Bound<'py, PyAny>>,
        progress: Option<&Bound<'py, PyAny>>,
        check: bool,
    ) -> PyResult<PySolution> {
        let call = Call::new(
            shape,
            load,
            approach,
            eccentricity,
            moment,
            tilt,
            tolerance,
            max_iterations,
            algorithm,
            initial,
            progress,
            check,
        )?;
        let contact = Arc::clone(&self.contact);
        call.run(py, move |shape, motion, options, progress| {
            contact.solve_watched(shape, motion, options, progress)
        })
    }

    /// Solves many load cases side by side, each on a thread of its own.
    ///
    /// Parameters
    /// ----------
    /// cases : iterable of mapping
    ///     Of each case, `shape` and the keywords of `solve` that say how it is pressed: `load`,
    ///     `approach`, `eccentricity`, `moment`, `tilt`.
    /// tolerance : float, optional
    ///     Largest residual and overlap of a converged solution.
    /// max_iterations : int, optional
    ///     Iterations of one case after which to give up; 10 000 by default.
    /// algorithm : {"cascade", "polonsky-keer"}, optional
    ///     As in `solve`.
    /// progress : callable, optional
    ///     Called with the number of finished cases and of all, at most 50 times a second, and at
    ///     the end. What it returns is ignored.
    /// check : bool, optional
    ///     Whether to raise where the tolerance was not met.
    ///
    /// Returns
    /// -------
    /// list of Solution
    ///     In the order of the cases; each is that of `solve` to the bit.
    ///
    /// Raises
    /// ------
    /// TypeError
    ///     If a case is not a mapping of keywords of `solve`.
    /// ValueError
    ///     If a case is out of range. A note of the error says which case it is.
    /// ConvergenceError
    ///     If the tolerance was not met in a case.
    ///
    /// Notes
    /// -----
    /// Once it solves, every exception that ends it, `KeyboardInterrupt` included, carries what was
    /// finished as `solutions`: a list in the order of the cases, with `None` for those that were not.
    ///
    /// Under a load, successive cases of which the shape is the same object share its undeformed gap:
    /// they take two thirds of the memory.
    ///
    /// Examples
    /// --------
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> contact = nacre.Contact(steel, nacre.Grid(shape=(64, 64), size=(4e-4, 4e-4)))
    /// >>> ball = nacre.Sphere(5e-3)
    /// >>> cases = [{"shape": ball, "load": load} for load in (5.0, 10.0)]
    /// >>> [round(solution.load, 6) for solution in contact.solve_many(cases)]
    /// [5.0, 10.0]
    #[expect(
        clippy::too_many_arguments,
        reason = "keywords of the public signature"
    )]
    #[pyo3(signature = (cases, *, tolerance=1e-8, max_iterations=None, algorithm="cascade", progress=None,
        check=true))]
    fn solve_many(
        &self,
        py: Python<'_>,
        cases: &Bound<'_, PyAny>,
        tolerance: f64,
        max_iterations: Option<&Bound<'_, PyAny>>,
        algorithm: &str,
        progress: Option<&Bound<'_, PyAny>>,
        check: bool,
    ) -> PyResult<Vec<Py<PySolution>>> {
        let options = options(tolerance, max_iterations, algorithm, None)?;
        batch::solve_many(py, &self.contact, cases, options, progress, check)
    }

    fn __eq__(&self, other: &Self) -> bool {
        let (a, b) = (&self.contact, &other.contact);
        (a.grid(), a.body(), a.setup()) == (b.grid(), b.body(), b.setup())
    }

    fn __repr__(&self) -> String {
        let (method, refinement) = method_words(self.contact.setup().method);
        let none = || "None".to_owned();
        format!(
            "Contact({}, {}, counterbody={}, method='{method}', refinement={refinement}, threads={})",
            self.body().__repr__(),
            self.grid().__repr__(),
            self.counterbody().map_or_else(none, |body| body.__repr__()),
            self.contact
                .setup()
                .threads
                .map_or_else(none, |threads| threads.to_string()),
        )
    }

    fn __getnewargs_ex__(&self, py: Python<'_>) -> PyResult<(NewArguments, NewKeywords)> {
        let (method, refinement) = method_words(self.contact.setup().method);
        let keywords = [
            ("method", method.into_pyobject(py)?.into_any().unbind()),
            (
                "refinement",
                refinement.into_pyobject(py)?.into_any().unbind(),
            ),
            (
                "threads",
                self.contact
                    .setup()
                    .threads
                    .into_pyobject(py)?
                    .into_any()
                    .unbind(),
            ),
        ];
        Ok((
            (self.body(), self.grid(), self.counterbody()),
            keywords.into(),
        ))
    }
}

/// Presses a shape into a body, in one call: chooses a grid where none is given, plans, solves.
///
/// The grid is a height map's own; else it has 64 cells across the narrower width of the contact,
/// oblong where the contact is long, and a margin of a quarter of the contact on every side.
///
/// Parameters
/// ----------
/// shape : Shape
///     What is pressed in.
/// body : HalfSpace or Elastic
///     What it is pressed into.
/// counterbody : HalfSpace or Elastic, optional
///     The body that carries the shape; rigid where there is none.
/// grid : Grid, optional
///     The cells. A shape without end, as a cylinder, needs one.
/// method : {"exact", "plain", "difference", "image"}, optional
///     How influence coefficients are computed; see `influence_coefficients`.
/// refinement : int, optional
///     Refinement of the spectral mesh of the conversions, 4 by default.
/// threads : int, optional
///     All of the machine's by default.
/// load, approach, eccentricity, moment, tilt : optional
///     What is asked of the rigid motion; see `Contact.solve`.
/// tolerance, max_iterations, algorithm, initial, progress, check : optional
///     How it is found; see `Contact.solve`.
///
/// Returns
/// -------
/// Solution
///     Pressure, gap, displacement, approach and tilt.
///
/// Raises
/// ------
/// ValueError
///     If an argument is out of range, the arguments contradict each other, or no grid is found.
/// ConvergenceError
///     If the tolerance was not met; the unfinished solution is its `solution`.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> dlc = nacre.Elastic(young=420e9, poisson=0.3)
/// >>> body = nacre.HalfSpace(steel, layers=[nacre.Layer(dlc, thickness=40e-6)])
/// >>> roller = nacre.Roller(radius=5e-3, flat_length=19.13e-3, crown_radius=7.5)
/// >>> solution = nacre.solve(roller, body, load=1e3, eccentricity=(2.87e-3, None))
/// >>> round(solution.eccentricity[0], 8)
/// 0.00287
#[expect(
    clippy::too_many_arguments,
    reason = "keywords of the public signature"
)]
#[pyfunction]
#[pyo3(signature = (shape, body, counterbody=None, *, grid=None, method="exact", refinement=None,
    threads=None, load=None, approach=None, eccentricity=None, moment=None, tilt=None,
    tolerance=1e-8, max_iterations=None, algorithm="cascade", initial=None, progress=None,
    check=true))]
pub(super) fn solve<'py>(
    py: Python<'py>,
    shape: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = body)] body: HalfSpace,
    counterbody: Option<&Bound<'py, PyAny>>,
    grid: Option<PyGrid>,
    method: &str,
    refinement: Option<&Bound<'py, PyAny>>,
    threads: Option<&Bound<'py, PyAny>>,
    load: Option<&Bound<'py, PyAny>>,
    approach: Option<&Bound<'py, PyAny>>,
    eccentricity: Option<&Bound<'py, PyAny>>,
    moment: Option<&Bound<'py, PyAny>>,
    tilt: Option<&Bound<'py, PyAny>>,
    tolerance: f64,
    max_iterations: Option<&Bound<'py, PyAny>>,
    algorithm: &str,
    initial: Option<&Bound<'py, PyAny>>,
    progress: Option<&Bound<'py, PyAny>>,
    check: bool,
) -> PyResult<PySolution> {
    let setup = setup(counterbody, method, refinement, threads)?;
    let call = Call::new(
        shape,
        load,
        approach,
        eccentricity,
        moment,
        tilt,
        tolerance,
        max_iterations,
        algorithm,
        initial,
        progress,
        check,
    )?;
    let body = Body::from(body);
    call.run(py, move |shape, motion, options, progress| {
        let grid = match grid {
            Some(PyGrid(grid)) => grid,
            None => choose_grid(shape, &body, &setup, motion, options, progress)?,
        };
        Contact::plan(&body, grid, setup)?.solve_watched(shape, motion, options, progress)
    })
}
