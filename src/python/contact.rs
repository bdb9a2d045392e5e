//! `nacre.Contact` and `nacre.solve`.

use std::sync::Arc;

use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use super::arguments::keywords::{
    self, Keywords, motion_docs, motion_signature, search_docs, search_signature, single_docs,
    single_signature,
};
use super::arguments::{array_repr, read_only, real_matrix, remade};
use super::background::{self, Caller};
use super::bodies::{PyHalfSpace, body};
use super::grid::PyGrid;
use super::solution::PySolution;
use crate::contact::Contact;
use crate::model::body::HalfSpace;

mod batch;
mod friction;
mod single;

pub(super) use friction::{PyFrictionSolved, PyFrictionSteps, creep_coefficients, roll, slide};
pub(super) use single::solve;
use single::{Call, setup};

/// A body on a grid, planned once: influence coefficients and their transform.
///
/// Parameters
/// ----------
/// body : HalfSpace or Elastic
///     Body that the shape is pressed into.
/// grid : Grid
///     Cells of the pressure.
/// counterbody : HalfSpace or Elastic, optional
///     Body that carries the shape; rigid where there is none.
/// coefficients : array_like, optional
///     Influence coefficients ``(nx, ny)`` [m/Pa] of both bodies together, such as those of another method of
///     `influence_coefficients`; by default the exact ones of the bodies.
/// threads : int, optional
///     Number of threads; all of the machine's by default.
///
/// Raises
/// ------
/// ValueError
///     If an argument is out of range.
/// MemoryError
///     If the grid does not fit into memory: a plan and a solve take up to 170 bytes a cell, with a hardness 210.
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

#[pymethods]
impl PyContact {
    #[new]
    #[pyo3(
        signature = (body, grid, counterbody=None, **keywords),
        text_signature = "(body, grid, counterbody=None, *, coefficients=None, threads=None)"
    )]
    fn new<'py>(
        py: Python<'py>,
        #[pyo3(from_py_with = body)] body: HalfSpace,
        grid: PyGrid,
        counterbody: Option<&Bound<'py, PyAny>>,
        keywords: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Self> {
        let keywords = Keywords::new(py, keywords)?;
        let mut setup = setup(counterbody, &keywords)?;
        if let Some(given) = keywords.given("coefficients")? {
            setup.coefficients = Some(real_matrix("coefficients", &given)?.into_shared());
        }
        keywords.finish("keywords of Contact")?;
        let contact = background::run(py, None, move |_: &mut Caller<()>| {
            Contact::plan(&body, grid.0, setup)
        })??;
        Ok(Self { contact: Arc::new(contact) })
    }

    /// Body that the shape is pressed into.
    #[getter]
    fn body(&self) -> PyHalfSpace {
        PyHalfSpace::of(self.contact.body())
    }

    /// Body that carries the shape; rigid where `None`.
    #[getter]
    fn counterbody(&self) -> Option<PyHalfSpace> {
        self.contact.setup().counterbody.as_ref().map(PyHalfSpace::of)
    }

    /// Cells of the pressure.
    #[getter]
    fn grid(&self) -> PyGrid {
        PyGrid(*self.contact.grid())
    }

    /// Influence coefficients ``(nx, ny)`` [m/Pa] that were given; None where they are those of the bodies.
    #[getter]
    fn coefficients<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let given = self.contact.setup().coefficients.as_ref();
        given.map(|given| read_only(py, given.to_owned())).transpose()
    }

    /// Number of threads of the plan.
    #[getter]
    fn threads(&self) -> usize {
        self.contact.convolution().threads()
    }

    #[doc = concat!("solve($self, shape, *, ", motion_signature!(), ", ", search_signature!(), ", ", single_signature!(), ")\n--\n")]
    /// Presses `shape` into the body.
    ///
    /// Each of the three degrees of freedom of the rigid motion is prescribed or loaded, in any
    /// mixture. Exactly one of `load` and `approach` is given, and along x and along y at most one of
    /// `eccentricity`, `moment` and `tilt`; with none of them the tilt is locked at 0.
    ///
    /// Parameters
    /// ----------
    /// shape : Shape
    ///     Shape that is pressed in.
    #[doc = motion_docs!()]
    #[doc = search_docs!()]
    #[doc = single_docs!()]
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
    #[pyo3(signature = (shape, **keywords), text_signature = None)]
    fn solve<'py>(
        &self,
        py: Python<'py>,
        shape: &Bound<'py, PyAny>,
        keywords: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<PySolution> {
        let keywords = Keywords::new(py, keywords)?;
        let call = Call::new(shape, &keywords)?;
        keywords.finish("keywords of Contact.solve")?;
        self.contact.grid().check_initial(call.initial.as_ref())?;
        let contact = Arc::clone(&self.contact);
        call.run(py, move |shape, motion, options, progress| {
            contact.solve(shape, motion, options.watched(progress))
        })
    }

    #[doc = concat!("solve_many($self, cases, *, ", search_signature!(), ", progress=None, check=True)\n--\n")]
    /// Solves many load cases side by side, each on a thread of its own.
    ///
    /// Parameters
    /// ----------
    /// cases : iterable of mapping
    ///     Cases, each with `shape` and the keywords of `solve` that say how it is pressed: `load`,
    ///     `approach`, `eccentricity`, `moment`, `tilt`.
    #[doc = search_docs!()]
    /// progress : callable, optional
    ///     Function that is called with the number of finished cases and of all cases, at most 50 times
    ///     a second, and at the end. Its result is ignored.
    /// check : bool, optional
    ///     Whether to raise an error if the tolerance was not met.
    ///
    /// Returns
    /// -------
    /// list of Solution
    ///     Solutions in the order of the cases; each has the bits that `solve` gives.
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
    /// Once the solves have begun, every exception that ends them, `KeyboardInterrupt` included, carries
    /// the finished ones as `solutions`: a list in the order of the cases, with `None` for a case that
    /// is not finished.
    ///
    /// Under a load, successive cases whose shape is the same object share its undeformed gap: they take
    /// two thirds of the memory.
    ///
    /// Examples
    /// --------
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> contact = nacre.Contact(steel, nacre.Grid(shape=(64, 64), size=(4e-4, 4e-4)))
    /// >>> ball = nacre.Sphere(5e-3)
    /// >>> cases = [{"shape": ball, "load": load} for load in (5.0, 10.0)]
    /// >>> [round(solution.load, 6) for solution in contact.solve_many(cases)]
    /// [5.0, 10.0]
    #[pyo3(signature = (cases, **keywords), text_signature = None)]
    fn solve_many<'py>(
        &self,
        py: Python<'py>,
        cases: &Bound<'py, PyAny>,
        keywords: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Vec<Py<PySolution>>> {
        let keywords = Keywords::new(py, keywords)?;
        let options = keywords::options(&keywords)?;
        let progress = keywords.callable("progress")?;
        let check = keywords.flag("check", true)?;
        keywords.finish("keywords of Contact.solve_many")?;
        batch::solve_many(py, &self.contact, cases, options, progress, check)
    }

    fn __eq__(&self, other: &Self) -> bool {
        let (a, b) = (&self.contact, &other.contact);
        (a.grid(), a.body(), a.setup()) == (b.grid(), b.body(), b.setup())
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (setup, none) = (self.contact.setup(), || "None".to_owned());
        let coefficients = setup.coefficients.as_ref();
        let coefficients =
            coefficients.map(|given| array_repr(py, given.to_owned())).transpose()?;
        Ok(format!(
            "Contact({}, {}, counterbody={}, coefficients={}, threads={})",
            self.body().__repr__(),
            self.grid().__repr__(),
            self.counterbody().map_or_else(none, |body| body.__repr__()),
            coefficients.unwrap_or_else(none),
            setup.threads.map_or_else(none, |threads| threads.to_string()),
        ))
    }

    /// Callable and arguments that make the plan again.
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let setup = self.contact.setup();
        let keywords = PyDict::new(py);
        keywords.set_item("coefficients", self.coefficients(py)?)?;
        keywords.set_item("threads", setup.threads)?;
        let arguments = (self.body(), self.grid(), self.counterbody());
        remade(py.get_type::<Self>(), arguments, keywords)
    }
}
