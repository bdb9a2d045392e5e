//! `nacre.Grid`.

use numpy::PyArray1;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use super::arguments::{Pair, Real, Two, count, flags, read_only, real};
use super::value::{self, Arguments, Value, class};
use crate::model::grid::Grid;

class! {
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
    ///     Centre [m]; the origin by default.
    /// periodic : tuple of bool, optional
    ///     Whether shape, pressure and displacement repeat along x and along y, with the sides as periods; by default
    ///     they do not. Forces are
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
    PyGrid(Grid) is "Grid" of "nacre";
    |of, py|
    attributes {
        /// Whether this is the grid of a line contact.
        is_line: bool = of.is_line();
        /// Numbers of cells ``(nx, ny)``.
        shape: (usize, usize) = of.shape().into();
        /// Side lengths ``(lx, ly)`` [m].
        size: (f64, f64) = of.size().into();
        /// Centre [m].
        center: (f64, f64) = of.center().into();
        /// Whether the grid repeats along x and along y.
        periodic: (bool, bool) = of.is_periodic().into();
        /// Side lengths of a cell ``(dx, dy)`` [m].
        spacing: (f64, f64) = of.spacing().into();
        /// Cell centres along x, ``(nx,)`` [m].
        x: Bound<'py, PyArray1<f64>> = read_only(py, of.x())?;
        /// Cell centres along y, ``(ny,)`` [m].
        y: Bound<'py, PyArray1<f64>> = read_only(py, of.y())?;
    }
    methods {
        #[new]
        #[pyo3(signature = (shape, size, center=None, periodic=None))]
        fn new(
            shape: Two<'_>,
            size: Pair,
            center: Option<Pair>,
            periodic: Option<&Bound<'_, PyAny>>,
        ) -> PyResult<Self> {
            let Two([nx, ny]) = shape;
            let shape = [count("shape", 2, &nx)?, count("shape", 2, &ny)?];
            let center = center.map_or([0.0; 2], |center| center.0);
            let grid = Grid::new(shape, size.0)?.centered_at(center)?;
            Ok(Self(grid.periodic(flags("periodic", periodic)?)?))
        }

        /// Grid of a line contact: strips side by side along y, endless along x, in plane strain.
        ///
        /// Its shape is ``(1, cells)``, and loads on it are per unit length along x [N/m]. In plane
        /// strain the displacement of an elastic half-space has no limit at a distance. Displacements, approach and
        /// shifts are therefore relative to the bare substrate's surface at a distance `width` from the load,
        /// whatever layers there are: under a stiff layer the body's own surface moves less than that there, under a
        /// soft one more. Under a load this datum moves displacements, approach and shifts, and changes no
        /// pressure. Below stiff layers that are wider than the grid approach and shift cannot be prescribed, since
        /// they would fall as the load or force grows.
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
        #[pyo3(signature = (cells, width, center=0.0))]
        fn line(
            cells: &Bound<'_, PyAny>,
            width: Real,
            #[pyo3(from_py_with = real)] center: f64,
        ) -> PyResult<Self> {
            Ok(Self(Grid::line(count("cells", 2, cells)?, width.0)?.centered_at([0.0, center])?))
        }
    }
}

impl Value for PyGrid {
    const NAME: &'static str = "Grid";

    fn maker(&self) -> Option<&'static str> {
        self.0.is_line().then_some("line")
    }

    fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Arguments<'py>> {
        let ([nx, ny], [lx, ly], [x, y]) = (self.0.shape(), self.0.size(), self.0.center());
        if self.0.is_line() {
            return Ok(vec![
                ("cells", ny.into_bound_py_any(py)?),
                ("width", ly.into_bound_py_any(py)?),
                ("center", y.into_bound_py_any(py)?),
            ]);
        }
        Ok(vec![
            ("shape", (nx, ny).into_bound_py_any(py)?),
            ("size", (lx, ly).into_bound_py_any(py)?),
            ("center", (x, y).into_bound_py_any(py)?),
            ("periodic", <(bool, bool)>::from(self.0.is_periodic()).into_bound_py_any(py)?),
        ])
    }
}
