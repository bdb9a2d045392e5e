//! `nacre.HeightMap`: measured surfaces.

use numpy::PyArrayDyn;
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use super::shape_class;
use crate::model::surface::HeightMap;
use crate::python::arguments::{Coordinate, Pair, Real, Repr, flags, read_only, real_matrix};

shape_class! {
    /// A measured surface: heights at cell centres, positive towards the other body.
    ///
    /// ``h = max(heights) - heights`` at the samples; bilinear on another grid, +inf outside.
    ///
    /// Parameters
    /// ----------
    /// heights : array_like
    ///     Heights ``(nx, ny)`` [m], finite. Of a DataArray with dimensions x and y, in any order, the coordinates must
    ///     ascend, and have this spacing; integers that number the samples may have any.
    /// spacing : float or tuple of float
    ///     Distances between samples ``(dx, dy)`` [m], or one for both.
    /// center : tuple of float, optional
    ///     Centre [m]; the origin by default.
    /// periodic : tuple of bool, optional
    ///     Whether the surface repeats along x and along y, which it does not by default; its period is its size. It is then pressed on a grid that
    ///     repeats too.
    ///
    /// Raises
    /// ------
    /// TypeError
    ///     If the heights are not real numbers.
    /// ValueError
    ///     If a height is not finite, there are fewer than two samples in a direction, or the spacing
    ///     is not finite and above 0, or contradicts the coordinates of a DataArray.
    ///
    /// Examples
    /// --------
    /// >>> nacre.HeightMap([[0.0, 1e-6], [2e-6, 3e-6]], spacing=1e-6).spacing
    /// (1e-06, 1e-06)
    PyHeightMap(HeightMap) is "HeightMap";
    |of, py|
    arguments {
        /// Heights ``(nx, ny)`` [m].
        heights(&Bound<'_, PyAny>): Bound<'py, PyArrayDyn<f64>> = read_only(py, of.heights().to_owned().into_dyn())?;
        /// Distances between samples ``(dx, dy)`` [m].
        spacing(&Bound<'_, PyAny>): (f64, f64) = <(f64, f64)>::from(of.spacing());
        /// Centre [m].
        center(Option<Pair> = None): (f64, f64) = <(f64, f64)>::from(of.center());
        /// Whether the surface repeats along x and along y.
        periodic(Option<&Bound<'_, PyAny>> = None): (bool, bool) = <(bool, bool)>::from(of.is_periodic());
    }
    attributes {}
    make {
        let both = spacing.extract::<Real>().map(|spacing| [spacing.0; 2]);
        let spacing =
            both.or_else(|_| spacing.extract::<Pair>().map(|pair| pair.0)).map_err(|_| {
                PyTypeError::new_err(format!(
                    "spacing must be a number or a pair of numbers, got {}",
                    Repr(spacing)
                ))
            })?;
        let map = HeightMap::new(real_matrix("heights", heights)?, spacing)?;
        for (coordinate, spacing) in Coordinate::both(heights)?.iter().zip(spacing) {
            if let Some(coordinate) = coordinate {
                coordinate.check_spacing("heights", spacing)?;
            }
        }
        let map = map.centered_at(center.map_or([0.0; 2], |center| center.0))?;
        map.periodic(flags("periodic", periodic)?)?
    }
}
