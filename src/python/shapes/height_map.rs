//! `nacre.HeightMap`: measured surfaces.

use numpy::PyArray2;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::base::{Kind, PyShape, held, object};
use crate::model::surface::HeightMap;
use crate::python::arguments::{Pair, Real, Repr, flags, read_only, real_matrix};

/// A measured surface: heights at cell centres, positive towards the other body.
///
/// ``h = max(heights) - heights`` at the samples; bilinear on another grid, +inf outside.
///
/// Parameters
/// ----------
/// heights : array_like
///     Heights ``(nx, ny)`` [m], finite.
/// spacing : float or tuple of float
///     Distances between samples ``(dx, dy)`` [m], or one for both.
/// center : tuple of float, optional
///     Centre [m].
/// periodic : tuple of bool, optional
///     Whether the surface repeats along x and along y; its period is its size. It is then pressed on a grid that
///     repeats too.
///
/// Raises
/// ------
/// TypeError
///     If the heights are not real numbers.
/// ValueError
///     If a height is not finite, there are fewer than two samples in a direction, or the spacing
///     is not finite and above 0.
///
/// Examples
/// --------
/// >>> nacre.HeightMap([[0.0, 1e-6], [2e-6, 3e-6]], spacing=1e-6).spacing
/// (1e-06, 1e-06)
#[pyclass(name = "HeightMap", module = "nacre", frozen, extends = PyShape)]
pub(super) struct PyHeightMap;

impl Kind for HeightMap {
    type Class = PyHeightMap;

    fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let ([dx, dy], [x, y]) = (self.spacing(), self.center());
        let arguments = PyDict::new(py);
        arguments.set_item("heights", read_only(py, self.heights().to_owned().into_dyn())?)?;
        arguments.set_item("spacing", (dx, dy))?;
        arguments.set_item("center", (x, y))?;
        if self.is_periodic() != [false; 2] {
            arguments.set_item("periodic", <(bool, bool)>::from(self.is_periodic()))?;
        }
        Ok(arguments)
    }
}

#[pymethods]
impl PyHeightMap {
    #[new]
    #[pyo3(
        signature = (heights, spacing, center=Pair([0.0; 2]), periodic=None),
        text_signature = "(heights, spacing, center=(0.0, 0.0), periodic=(False, False))"
    )]
    fn new(
        heights: &Bound<'_, PyAny>,
        spacing: &Bound<'_, PyAny>,
        center: Pair,
        periodic: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let both = spacing.extract::<Real>().map(|spacing| [spacing.0; 2]);
        let spacing =
            both.or_else(|_| spacing.extract::<Pair>().map(|pair| pair.0)).map_err(|_| {
                PyTypeError::new_err(format!(
                    "spacing must be a number or a pair of numbers, got {}",
                    Repr(spacing)
                ))
            })?;
        let map = HeightMap::new(real_matrix("heights", heights)?, spacing)?;
        let map = map.centered_at(center.0)?;
        Ok(object(Self, map.periodic(flags("periodic", periodic)?)?))
    }

    /// Reads a measured surface from a file, or takes one from SurfaceTopography.
    ///
    /// Files of instruments are read by SurfaceTopography, with ``nacre-contact[surfaces]``. Missing points are
    /// filled smoothly from their surroundings; a `nacre.NacreWarning` tells how many there were.
    ///
    /// Parameters
    /// ----------
    /// path : str, os.PathLike or topography
    ///     A file ``.npy`` holds a matrix of heights ``(nx, ny)``; ``.csv`` likewise, with one line
    ///     for each x, after optional comments ``# unit: um`` and ``# spacing: 0.5 0.5``; ``.xyz``
    ///     holds points on a grid. Decimal commas are recognised, and headings are left out.
    ///     SurfaceTopography reads any other file; a matrix in a ``.txt`` has one line for each y. A
    ///     topography is an object of that library.
    /// spacing : float or tuple of float, optional
    ///     Distances between samples ``(dx, dy)`` [m]; needed where the file does not give them.
    /// unit : str, optional
    ///     Unit of the numbers in the file ("nm", "um", "mm", ...). By default the unit that the file
    ///     names. Where it names none, numbers in ``.npy`` and ``.csv`` are metres, unless the heights
    ///     would span more than ten times the map; anything else needs a unit.
    /// detrend : {"plane", "none", "mean", "quadratic"}, optional
    ///     Surface that is subtracted: the plane, the mean or the paraboloid that fits best.
    /// channel : str or int, optional
    ///     Channel of the instrument that is read.
    /// transpose : bool, optional
    ///     Whether to swap x and y of the file. Instruments export a ``.csv`` as an image, with one line
    ///     for each y: that needs ``transpose=True``. The first line then has the smallest y. A
    ///     `spacing` that is given is not swapped.
    /// periodic : tuple of bool, optional
    ///     Whether the surface repeats along x and along y.
    ///
    /// Returns
    /// -------
    /// HeightMap
    ///     The surface.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the file cannot be understood, its unit or spacing is not known, or less than half of it
    ///     was measured.
    /// TypeError
    ///     If an argument is of the wrong kind.
    /// OSError
    ///     If the file cannot be read.
    ///
    /// Examples
    /// --------
    /// >>> import tempfile
    /// >>> with tempfile.TemporaryDirectory() as folder:
    /// ...     np.save(f"{folder}/flat.npy", np.zeros((4, 3)))
    /// ...     nacre.HeightMap.read(f"{folder}/flat.npy", spacing=1e-6, unit="nm").heights.shape
    /// (4, 3)
    #[staticmethod]
    #[pyo3(
        signature = (path, **keywords),
        text_signature = "(path, *, spacing=None, unit=None, detrend='plane', channel=None, transpose=False, periodic=(False, False))"
    )]
    fn read<'py>(
        py: Python<'py>,
        path: &Bound<'py, PyAny>,
        keywords: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let surfaces = py.import("nacre.surfaces")?;
        surfaces.call_method("read", (path,), keywords)
    }

    /// Heights ``(nx, ny)`` [m].
    #[getter]
    fn heights<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let map = held::<_, HeightMap>(slf);
        read_only(slf.py(), map.heights().to_owned())
    }

    /// Distances between samples ``(dx, dy)`` [m].
    #[getter]
    fn spacing(slf: &Bound<'_, Self>) -> (f64, f64) {
        held::<_, HeightMap>(slf).spacing().into()
    }

    /// Whether the surface repeats along x and along y.
    #[getter]
    fn periodic(slf: &Bound<'_, Self>) -> (bool, bool) {
        held::<_, HeightMap>(slf).is_periodic().into()
    }

    /// Centre [m].
    #[getter]
    fn center(slf: &Bound<'_, Self>) -> (f64, f64) {
        held::<_, HeightMap>(slf).center().into()
    }
}
