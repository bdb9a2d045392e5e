//! `nacre.Grid`.

use numpy::PyArray1;
use pyo3::prelude::*;

use super::arrays::{count, read_only};
use crate::grid::Grid;

/// A uniform grid of rectangular cells, over each of which the pressure is constant.
///
/// Cell centres are ``x_i = center_x - lx/2 + (i + 1/2) dx``, ``dx = lx/nx``.
///
/// Parameters
/// ----------
/// shape : tuple of int
///     Numbers of cells ``(nx, ny)``, at least 2 in each direction.
/// size : tuple of float
///     Side lengths ``(lx, ly)`` [m].
/// center : tuple of float, optional
///     Centre [m].
///
/// Raises
/// ------
/// ValueError
///     If there are fewer than two cells, or a length is not finite and above 0.
///
/// Examples
/// --------
/// >>> nacre.Grid(shape=(4, 2), size=(8.0, 2.0)).x
/// array([-3., -1.,  1.,  3.])
#[pyclass(name = "Grid", module = "nacre", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub(super) struct PyGrid(pub(super) Grid);

#[pymethods]
impl PyGrid {
    #[new]
    #[pyo3(signature = (shape, size, center=(0.0, 0.0)))]
    fn new(shape: [Bound<'_, PyAny>; 2], size: [f64; 2], center: (f64, f64)) -> PyResult<Self> {
        let shape = [count("shape", 2, &shape[0])?, count("shape", 2, &shape[1])?];
        Ok(Self(Grid::new(shape, size)?.centered_at(center.into())?))
    }

    /// Numbers of cells ``(nx, ny)``.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        self.0.shape().into()
    }

    /// Side lengths ``(lx, ly)`` [m].
    #[getter]
    fn size(&self) -> (f64, f64) {
        self.0.size().into()
    }

    /// Centre [m].
    #[getter]
    fn center(&self) -> (f64, f64) {
        self.0.center().into()
    }

    /// Side lengths of a cell ``(dx, dy)`` [m].
    #[getter]
    fn spacing(&self) -> (f64, f64) {
        self.0.spacing().into()
    }

    /// Cell centres along x, ``(nx,)`` [m].
    #[getter]
    fn x<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        read_only(py, self.0.x())
    }

    /// Cell centres along y, ``(ny,)`` [m].
    #[getter]
    fn y<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        read_only(py, self.0.y())
    }

    pub(super) fn __repr__(&self) -> String {
        format!(
            "Grid(shape={:?}, size={:?}, center={:?})",
            self.shape(),
            self.size(),
            self.center()
        )
    }

    fn __getnewargs__(&self) -> ((usize, usize), (f64, f64), (f64, f64)) {
        (self.shape(), self.size(), self.center())
    }
}
