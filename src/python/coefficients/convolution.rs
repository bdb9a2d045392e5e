//! `nacre.Convolution`.

use std::sync::Arc;

use ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::compliance::convolution::Convolution;
use crate::compliance::influence::{Method, coefficients_on};
use crate::compliance::response::Body;
use crate::model::body::HalfSpace;
use crate::numerics::parallel::Threads;
use crate::python::arguments::{count, read_only, real_matrix, remade};
use crate::python::background::{self, Caller};
use crate::python::bodies::body;
use crate::python::grid::PyGrid;

/// A planned convolution: the displacement of a surface under any pressure.
///
/// ``u[i, j] = sum over k, l of C[|i - k|, |j - l|] p[k, l]``: as a matrix it is symmetric, and its own
/// adjoint.
///
/// Parameters
/// ----------
/// coefficients : array_like
///     Influence coefficients C ``(nx, ny)`` [m/Pa] of the offsets ``(i dx, j dy)``, ``i, j >= 0``.
/// threads : int, optional
///     Number of threads; all of the machine's by default.
///
/// Raises
/// ------
/// TypeError
///     If the coefficients are not real numbers.
/// ValueError
///     If a coefficient is not finite, there is none, or `threads` is below 1.
///
/// Examples
/// --------
/// >>> convolution = nacre.Convolution([[1.0, 0.5], [0.25, 0.125]])
/// >>> convolution.apply([[2.0, 0.0], [0.0, 0.0]]).round(12)
/// array([[2.  , 1.  ],
///        [0.5 , 0.25]])
#[pyclass(name = "Convolution", module = "nacre", frozen)]
pub(in crate::python) struct PyConvolution {
    convolution: Arc<Convolution>,
    coefficients: Array2<f64>,
    /// Number of threads that was asked for.
    threads: Option<usize>,
}

impl PyConvolution {
    fn plan(
        coefficients: Array2<f64>,
        threads: Option<usize>,
        shared: Arc<Threads>,
    ) -> crate::Result<Self> {
        Ok(Self {
            convolution: Arc::new(Convolution::plan_on(&coefficients, shared)?),
            coefficients,
            threads,
        })
    }
}

#[pymethods]
impl PyConvolution {
    #[new]
    #[pyo3(signature = (coefficients, *, threads=None))]
    fn new(
        py: Python<'_>,
        coefficients: &Bound<'_, PyAny>,
        threads: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let coefficients = real_matrix("coefficients", coefficients)?;
        let threads = threads.map(|n| count("threads", 1, n)).transpose()?;
        Ok(background::run(py, None, move |_: &mut Caller<()>| {
            Self::plan(coefficients, threads, Arc::new(Threads::new(threads)?))
        })??)
    }

    /// Convolution with the exact influence coefficients of one or two bodies.
    ///
    /// Parameters
    /// ----------
    /// body : HalfSpace or Elastic
    ///     Body under the pressure. Free ends are not counted, of either body.
    /// grid : Grid
    ///     Cells of the pressure.
    /// counterbody : HalfSpace or Elastic, optional
    ///     Second body under the same pressure; rigid where there is none.
    /// threads : int, optional
    ///     Number of threads; all of the machine's by default.
    ///
    /// Returns
    /// -------
    /// Convolution
    ///     Convolution that gives the displacement of both surfaces together.
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
    /// >>> grid = nacre.Grid(shape=(8, 6), size=(8e-6, 6e-6))
    /// >>> nacre.Convolution.of_bodies(steel, grid).shape
    /// (8, 6)
    #[staticmethod]
    #[pyo3(signature = (body, grid, counterbody=None, *, threads=None))]
    fn of_bodies(
        py: Python<'_>,
        #[pyo3(from_py_with = body)] body: HalfSpace,
        grid: PyGrid,
        counterbody: Option<&Bound<'_, PyAny>>,
        threads: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let threads = threads.map(|n| count("threads", 1, n)).transpose()?;
        let counterbody = counterbody.map(self::body).transpose()?;
        Ok(background::run(py, None, move |_: &mut Caller<()>| {
            let grid = grid.0;
            crate::numerics::parallel::check_memory(
                grid.shape(),
                Convolution::memory(grid.shape()),
            )?;
            let shared = Arc::new(Threads::new(threads)?);
            let mut coefficients =
                coefficients_on(&*Body::from(body), &grid, Method::Exact, &shared)?;
            if let Some(counterbody) = counterbody {
                let body = Body::from(counterbody);
                coefficients += &coefficients_on(&*body, &grid, Method::Exact, &shared)?;
            }
            Self::plan(coefficients, threads, shared)
        })??)
    }

    /// Displacement under a pressure.
    ///
    /// Parameters
    /// ----------
    /// pressure : array_like
    ///     Pressure ``(nx, ny)`` [Pa].
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Displacement ``(nx, ny)`` [m].
    ///
    /// Raises
    /// ------
    /// TypeError
    ///     If the pressure is not real.
    /// ValueError
    ///     If the pressure has another shape, or is not finite.
    ///
    /// Examples
    /// --------
    /// >>> convolution = nacre.Convolution(np.ones((3, 2)))
    /// >>> convolution.apply(np.ones((3, 2))).round(12)
    /// array([[6., 6.],
    ///        [6., 6.],
    ///        [6., 6.]])
    fn apply<'py>(
        &self,
        py: Python<'py>,
        pressure: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let pressure = real_matrix("pressure", pressure)?;
        let displacement = py.detach(|| self.convolution.apply(&pressure))?;
        Ok(displacement.into_pyarray(py))
    }

    /// SciPy's linear operator that applies the convolution; needs SciPy.
    ///
    /// Returns
    /// -------
    /// scipy.sparse.linalg.LinearOperator
    ///     Symmetric operator ``(nx ny, nx ny)`` on pressures that are flattened in C order.
    ///
    /// Raises
    /// ------
    /// ModuleNotFoundError
    ///     If SciPy is missing.
    ///
    /// Examples
    /// --------
    /// The pressure under a flat rigid punch that covers the grid:
    ///
    /// >>> from scipy.sparse.linalg import cg
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> grid = nacre.Grid(shape=(8, 6), size=(8e-6, 6e-6))
    /// >>> convolution = nacre.Convolution.of_bodies(steel, grid)
    /// >>> pressure, failed = cg(convolution.as_linear_operator(), np.full(48, 1e-9), rtol=1e-10)
    /// >>> displacement = convolution.apply(pressure.reshape(8, 6))
    /// >>> failed, bool(np.allclose(displacement, 1e-9, rtol=1e-8))
    /// (0, True)
    fn as_linear_operator<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let module = slf.py().import("nacre._operator")?;
        module.call_method1("linear_operator", (slf,))
    }

    /// Shape ``(nx, ny)`` of pressures and displacements.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        self.convolution.shape().into()
    }

    /// Influence coefficients ``(nx, ny)`` [m/Pa].
    #[getter]
    fn coefficients<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        read_only(py, self.coefficients.clone())
    }

    /// Number of threads.
    #[getter]
    fn threads(&self) -> usize {
        self.convolution.threads()
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.coefficients == other.coefficients && self.threads == other.threads
    }

    fn __repr__(&self) -> String {
        let [nx, ny] = self.convolution.shape();
        format!("<Convolution on {nx} x {ny} cells, {} threads>", self.convolution.threads())
    }

    /// Callable and arguments that make the convolution again.
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let keywords = PyDict::new(py);
        keywords.set_item("threads", self.threads)?;
        remade(py.get_type::<Self>(), (self.coefficients(py)?,), keywords)
    }
}
