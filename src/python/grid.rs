//! `nacre.Grid`.

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use super::arguments::{Pair, Real, count, flags, hash, read_only, truth};
use crate::model::grid::Grid;

/// A uniform grid of rectangular cells, with constant pressure over each.
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
/// periodic : tuple of bool, optional
///     Whether shape, pressure and displacement repeat along x and along y, with the sides as periods. Forces are
///     those of one period. Where both directions repeat and no base is rigid, displacement is relative to its mean,
///     and the approach is that of the mean plane of the deformed surface. Where one repeats, the datum is that of
///     `Grid.line`, with the width of the other.
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
    #[pyo3(
        signature = (shape, size, center=Pair([0.0; 2]), periodic=None),
        text_signature = "(shape, size, center=(0.0, 0.0), periodic=(False, False))"
    )]
    fn new(
        shape: [Bound<'_, PyAny>; 2],
        size: Pair,
        center: Pair,
        periodic: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let shape = [count("shape", 2, &shape[0])?, count("shape", 2, &shape[1])?];
        let grid = Grid::new(shape, size.0)?.centered_at(center.0)?;
        Ok(Self(grid.periodic(flags("periodic", periodic)?)?))
    }

    /// Grid of a line contact: strips side by side along y, endless along x, in plane strain.
    ///
    /// Its shape is ``(1, cells)``, and loads on it are per unit length along x [N/m]. In plane
    /// strain the displacement of an elastic half-space has no limit at a distance. Displacement and
    /// approach are therefore relative to the bare substrate's surface at a distance `width` from the load,
    /// whatever layers there are. Under a load this datum shifts displacement and approach, and changes no
    /// pressure. Below stiff layers that are wider than the grid an approach cannot be prescribed, since it
    /// would fall as the load grows.
    ///
    /// Parameters
    /// ----------
    /// cells : int
    ///     Number of strips, at least 2.
    /// width : float
    ///     Width of all strips together [m].
    /// center : float, optional
    ///     Centre along y [m].
    ///
    /// Returns
    /// -------
    /// Grid
    ///     Grid of strips.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If there are fewer than two cells, or the width is not finite and above 0.
    ///
    /// Examples
    /// --------
    /// >>> nacre.Grid.line(cells=256, width=1e-3).shape
    /// (1, 256)
    #[staticmethod]
    #[pyo3(signature = (cells, width, center=Real(0.0)), text_signature = "(cells, width, center=0.0)")]
    fn line(cells: &Bound<'_, PyAny>, width: Real, center: Real) -> PyResult<Self> {
        Ok(Self(Grid::line(count("cells", 2, cells)?, width.0)?.centered_at([0.0, center.0])?))
    }

    /// Whether this is the grid of a line contact.
    #[getter]
    fn is_line(&self) -> bool {
        self.0.is_line()
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

    /// Whether the grid repeats along x and along y.
    #[getter]
    fn periodic(&self) -> (bool, bool) {
        self.0.is_periodic().into()
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
        let ([nx, ny], [lx, ly], [x, y]) = (self.0.shape(), self.0.size(), self.0.center());
        if self.0.is_line() {
            format!("Grid.line(cells={ny}, width={ly:?}, center={y:?})")
        } else {
            let repeats = match self.0.is_periodic() {
                [false, false] => String::new(),
                [x, y] => format!(", periodic=({}, {})", truth(x), truth(y)),
            };
            format!(
                "Grid(shape=({nx}, {ny}), size=({lx:?}, {ly:?}), center=({x:?}, {y:?}){repeats})"
            )
        }
    }

    fn __hash__(&self) -> u64 {
        hash(&self.__repr__())
    }

    /// Callable and arguments that make the grid again.
    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let py = slf.py();
        let class = slf.get_type().into_any();
        let grid = slf.get();
        if grid.0.is_line() {
            let ([_, cells], [_, width], [_, y]) = (grid.0.shape(), grid.0.size(), grid.0.center());
            Ok((class.getattr("line")?, (cells, width, y).into_pyobject(py)?))
        } else if grid.0.is_periodic() == [false; 2] {
            // Earlier versions read it.
            let arguments = (grid.shape(), grid.size(), grid.center());
            Ok((class, arguments.into_pyobject(py)?))
        } else {
            let arguments = (grid.shape(), grid.size(), grid.center(), grid.periodic());
            Ok((class, arguments.into_pyobject(py)?))
        }
    }
}
