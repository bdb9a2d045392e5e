//! Shapes: `nacre.Shape` and its kinds.

use ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::PyClass;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use super::arrays::{Repr, array_repr, hash, read_only, real_matrix};
use super::grid::PyGrid;
use super::profiles;
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::surface::{
    CrownedProfile, Cylinder, Extent, FlatPunch, HeightMap, Paraboloid, Profile, Roller, Sphere,
    Surface,
};

/// Any shape that Python can name: so that it has a value to compare, copy and print.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Shape {
    Sphere(Sphere),
    Paraboloid(Paraboloid),
    Cylinder(Cylinder),
    Roller(Roller),
    FlatPunch(FlatPunch),
    HeightMap(HeightMap),
    Sum(Box<[Shape; 2]>),
    Shifted(Box<Shape>, [f64; 2]),
}

impl Shape {
    /// Calls `f` with the surface that this is.
    fn with<R>(&self, f: impl FnOnce(&dyn Surface) -> R) -> R {
        match self {
            Self::Sphere(shape) => f(shape),
            Self::Paraboloid(shape) => f(shape),
            Self::Cylinder(shape) => f(shape),
            Self::Roller(shape) => f(shape),
            Self::FlatPunch(shape) => f(shape),
            Self::HeightMap(shape) => f(shape),
            Self::Sum(parts) => f(&(&parts[0]).plus(&parts[1])),
            Self::Shifted(shape, [x, y]) => match shape.as_ref().shifted(*x, *y) {
                Ok(shifted) => f(&shifted),
                Err(_) => unreachable!("checked when it was made"),
            },
        }
    }

    fn into_python(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        let base = PyClassInitializer::from(PyShape(self.clone()));
        Ok(match self {
            Self::Sphere(_) => Bound::new(py, base.add_subclass(PySphere))?.into_any(),
            Self::Paraboloid(_) => Bound::new(py, base.add_subclass(PyParaboloid))?.into_any(),
            Self::Cylinder(_) => Bound::new(py, base.add_subclass(PyCylinder))?.into_any(),
            Self::Roller(_) => Bound::new(py, base.add_subclass(PyRoller))?.into_any(),
            Self::FlatPunch(_) => Bound::new(py, base.add_subclass(PyFlatPunch))?.into_any(),
            Self::HeightMap(_) => Bound::new(py, base.add_subclass(PyHeightMap))?.into_any(),
            Self::Sum(_) | Self::Shifted(..) => Bound::new(py, base)?.into_any(),
        })
    }

    /// A text that equal shapes share: without the numbers of measured surfaces and profiles.
    fn key(&self) -> String {
        match self {
            Self::HeightMap(s) => format!("HeightMap {:?} {:?}", s.heights().dim(), s.spacing()),
            Self::Roller(s) if matches!(s.profile(), Profile::Sampled(_)) => {
                format!("Roller {:?} {:?}", s.radius(), s.length())
            }
            Self::Sum(parts) => format!("({} + {})", parts[0].key(), parts[1].key()),
            Self::Shifted(shape, by) => format!("{} {by:?}", shape.key()),
            other => format!("{other:?}"),
        }
    }

    fn repr(&self, py: Python<'_>) -> PyResult<String> {
        Ok(match self {
            Self::Sphere(s) => format!("Sphere(radius={:?})", s.radius()),
            Self::Paraboloid(s) => {
                format!(
                    "Paraboloid(radius_x={:?}, radius_y={:?})",
                    s.radius_x(),
                    s.radius_y()
                )
            }
            Self::Cylinder(s) => format!("Cylinder(radius={:?})", s.radius()),
            Self::Roller(s) => {
                let length = s
                    .length()
                    .map_or("None".into(), |length| format!("{length:?}"));
                let profile = match (s.profile(), profiles::to_python(py, s.profile())?) {
                    (Profile::Crowned(p), _) => format!(
                        "flat_length={:?}, crown_radius={:?}",
                        p.flat_length(),
                        p.crown_radius()
                    ),
                    (_, profile) => format!("profile={}", profile.into_pyobject(py)?.repr()?),
                };
                format!(
                    "Roller(radius={:?}, {profile}, length={length})",
                    s.radius()
                )
            }
            Self::FlatPunch(s) => format!("FlatPunch(radius={:?})", s.radius()),
            Self::HeightMap(s) => {
                let ([dx, dy], [x, y]) = (s.spacing(), s.center());
                let heights = array_repr(py, s.heights().to_owned())?;
                format!("HeightMap({heights}, spacing=({dx:?}, {dy:?}), center=({x:?}, {y:?}))")
            }
            Self::Sum(parts) => {
                let second = parts[1].repr(py)?;
                let nested = matches!(parts[1], Self::Sum(_));
                let second = if nested {
                    format!("({second})")
                } else {
                    second
                };
                format!("{} + {second}", parts[0].repr(py)?)
            }
            Self::Shifted(shape, [x, y]) => {
                let inner = shape.repr(py)?;
                let inner = if matches!(**shape, Self::Sum(_)) {
                    format!("({inner})")
                } else {
                    inner
                };
                format!("{inner}.shifted({x:?}, {y:?})")
            }
        })
    }
}

impl Surface for Shape {
    fn gap(&self, x: f64, y: f64) -> f64 {
        self.with(|shape| shape.gap(x, y))
    }
    fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
        self.with(|shape| shape.gaps(grid))
    }
    fn extent(&self) -> [Extent; 2] {
        self.with(|shape| shape.extent())
    }
    fn radii(&self) -> [f64; 2] {
        self.with(|shape| shape.radii())
    }
    fn grid(&self) -> Option<Grid> {
        self.with(|shape| shape.grid())
    }
}

/// An undeformed shape: the gap h(x, y) to the plane z = 0.
///
/// Shapes add (``sphere + roughness``) and move (``shape.shifted(x, y)``). A gap of +inf means
/// 'cannot touch'.
///
/// Examples
/// --------
/// >>> nacre.Sphere(5e-3) + nacre.HeightMap([[0.0, 1e-9], [1e-9, 0.0]], spacing=1e-6)
/// Sphere(radius=0.005) + HeightMap([[0.0, 1e-09], [1e-09, 0.0]], spacing=(1e-6, 1e-6), center=(0.0, 0.0))
#[pyclass(name = "Shape", module = "nacre", frozen, eq, subclass)]
#[derive(Clone, PartialEq)]
pub(super) struct PyShape(pub(super) Shape);

#[pymethods]
impl PyShape {
    /// Gaps at the cells of a grid.
    ///
    /// Parameters
    /// ----------
    /// grid : Grid
    ///     The grid.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Gaps ``(nx, ny)`` [m]; +inf where the shape cannot touch.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If a height map is too fine for the grid.
    ///
    /// Examples
    /// --------
    /// >>> grid = nacre.Grid(shape=(2, 2), size=(2.0, 2.0))
    /// >>> nacre.Paraboloid(1.0, 1.0).gaps(grid)
    /// array([[0.25, 0.25],
    ///        [0.25, 0.25]])
    fn gaps<'py>(&self, py: Python<'py>, grid: PyGrid) -> PyResult<Bound<'py, PyArray2<f64>>> {
        Ok(self.0.gaps(&grid.0)?.into_pyarray(py))
    }

    /// The same shape, moved.
    ///
    /// Parameters
    /// ----------
    /// x, y : float
    ///     By how much [m].
    ///
    /// Returns
    /// -------
    /// Shape
    ///     The moved shape.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If a number is not finite.
    ///
    /// Examples
    /// --------
    /// >>> nacre.Sphere(5e-3).shifted(1e-3, 0.0)
    /// Sphere(radius=0.005).shifted(0.001, 0.0)
    fn shifted(&self, x: f64, y: f64) -> PyResult<Self> {
        (&self.0).shifted(x, y)?;
        Ok(Self(Shape::Shifted(
            Box::new(self.0.clone()),
            [x + 0.0, y + 0.0],
        )))
    }

    fn __add__(&self, other: &Self) -> Self {
        Self(Shape::Sum(Box::new([self.0.clone(), other.0.clone()])))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        self.0.repr(py)
    }

    fn __hash__(&self) -> u64 {
        hash(&self.0.key())
    }

    /// How to make it again: a callable and its arguments.
    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let py = slf.py();
        let class = slf.get_type().into_any();
        let operator = py.import("operator")?;
        Ok(match &slf.get().0 {
            Shape::Sphere(s) => (class, (s.radius(),).into_pyobject(py)?),
            Shape::Paraboloid(s) => (class, (s.radius_x(), s.radius_y()).into_pyobject(py)?),
            Shape::Cylinder(s) => (class, (s.radius(),).into_pyobject(py)?),
            Shape::Roller(s) => {
                let (flat_length, crown_radius) = match s.profile() {
                    Profile::Crowned(p) => (Some(p.flat_length()), Some(p.crown_radius())),
                    _ => (None, None),
                };
                let profile = profiles::to_python(py, s.profile())?;
                let arguments = (s.radius(), flat_length, crown_radius, s.length(), profile);
                (class, arguments.into_pyobject(py)?)
            }
            Shape::FlatPunch(s) => (class, (s.radius(),).into_pyobject(py)?),
            Shape::HeightMap(s) => {
                let heights = read_only(py, s.heights().to_owned())?;
                let (spacing, center): ((f64, f64), (f64, f64)) =
                    (s.spacing().into(), s.center().into());
                (class, (heights, spacing, center).into_pyobject(py)?)
            }
            Shape::Sum(parts) => {
                let [a, b] = parts.as_ref().clone();
                let parts = (a.into_python(py)?, b.into_python(py)?).into_pyobject(py)?;
                (operator.getattr("add")?, parts)
            }
            Shape::Shifted(shape, [x, y]) => {
                let shift = operator.call_method1("methodcaller", ("shifted", *x, *y))?;
                (
                    shift,
                    (shape.as_ref().clone().into_python(py)?,).into_pyobject(py)?,
                )
            }
        })
    }
}

/// A sphere: ``h = R - sqrt(R**2 - r**2)``, +inf beyond R.
///
/// Parameters
/// ----------
/// radius : float
///     Radius [m], above 0.
///
/// Raises
/// ------
/// ValueError
///     If it is not finite and above 0.
///
/// Examples
/// --------
/// >>> nacre.Sphere(radius=5e-3)
/// Sphere(radius=0.005)
#[pyclass(name = "Sphere", module = "nacre", frozen, extends = PyShape)]
pub(super) struct PySphere;

#[pymethods]
impl PySphere {
    #[new]
    fn new(radius: f64) -> PyResult<PyClassInitializer<Self>> {
        Ok(subclass(Self, Shape::Sphere(Sphere::new(radius)?)))
    }

    /// Radius [m].
    #[getter]
    fn radius(slf: &Bound<'_, Self>) -> f64 {
        match &slf.as_super().get().0 {
            Shape::Sphere(shape) => shape.radius(),
            _ => unreachable!("made by its own constructor"),
        }
    }
}

/// An elliptic paraboloid: ``h = x**2/(2 R_x) + y**2/(2 R_y)``.
///
/// Parameters
/// ----------
/// radius_x, radius_y : float
///     Radii of curvature at the apex [m], above 0.
///
/// Raises
/// ------
/// ValueError
///     If one is not finite and above 0.
///
/// Examples
/// --------
/// >>> nacre.Paraboloid(5e-3, 5e-3)
/// Paraboloid(radius_x=0.005, radius_y=0.005)
#[pyclass(name = "Paraboloid", module = "nacre", frozen, extends = PyShape)]
pub(super) struct PyParaboloid;

#[pymethods]
impl PyParaboloid {
    #[new]
    fn new(radius_x: f64, radius_y: f64) -> PyResult<PyClassInitializer<Self>> {
        Ok(subclass(
            Self,
            Shape::Paraboloid(Paraboloid::new(radius_x, radius_y)?),
        ))
    }

    /// Radius of curvature along x [m].
    #[getter]
    fn radius_x(slf: &Bound<'_, Self>) -> f64 {
        match &slf.as_super().get().0 {
            Shape::Paraboloid(shape) => shape.radius_x(),
            _ => unreachable!("made by its own constructor"),
        }
    }

    /// Radius of curvature along y [m].
    #[getter]
    fn radius_y(slf: &Bound<'_, Self>) -> f64 {
        match &slf.as_super().get().0 {
            Shape::Paraboloid(shape) => shape.radius_y(),
            _ => unreachable!("made by its own constructor"),
        }
    }
}

/// An endless cylinder, axis along x: ``h = R - sqrt(R**2 - y**2)``, +inf beyond R.
///
/// Its contact is as long as the grid, which must be given.
///
/// Parameters
/// ----------
/// radius : float
///     Radius [m], above 0.
///
/// Raises
/// ------
/// ValueError
///     If it is not finite and above 0.
///
/// Examples
/// --------
/// >>> nacre.Cylinder(radius=5e-3)
/// Cylinder(radius=0.005)
#[pyclass(name = "Cylinder", module = "nacre", frozen, extends = PyShape)]
pub(super) struct PyCylinder;

#[pymethods]
impl PyCylinder {
    #[new]
    fn new(radius: f64) -> PyResult<PyClassInitializer<Self>> {
        Ok(subclass(Self, Shape::Cylinder(Cylinder::new(radius)?)))
    }

    /// Radius [m].
    #[getter]
    fn radius(slf: &Bound<'_, Self>) -> f64 {
        match &slf.as_super().get().0 {
            Shape::Cylinder(shape) => shape.radius(),
            _ => unreachable!("made by its own constructor"),
        }
    }
}

/// A roller, axis along x, with an axial profile d(x): ``h = R - sqrt((R - d)**2 - y**2)``.
///
/// Crowned: ``d(x) = 0`` for ``|x| <= L = flat_length/2``, beyond it
/// ``d = R_a - sqrt(R_a**2 - (|x| - L)**2)`` with ``R_a = crown_radius``. Spinu et al., The normal
/// contact of finite length coated cylinders, eq. (3). Any other profile is averaged over each cell,
/// so that the ends do not depend on where a cell's centre falls.
///
/// Parameters
/// ----------
/// radius : float
///     Radius R [m], above 0.
/// flat_length : float, optional
///     Length of the straight part [m], at least 0.
/// crown_radius : float, optional
///     Radius R_a of the rounded ends [m], above 0.
/// length : float, optional
///     Whole length [m], at least `flat_length`: the gap is +inf beyond its ends.
/// profile : LogarithmicProfile, SampledProfile or tuple of array_like, optional
///     Another axial profile, in place of `flat_length` and `crown_radius`; a pair is positions and
///     drops.
///
/// Raises
/// ------
/// ValueError
///     If a length is out of range, or there is neither a crown nor a profile, or both.
///
/// Examples
/// --------
/// >>> nacre.Roller(radius=5e-3, flat_length=19.13e-3, crown_radius=7.5)
/// Roller(radius=0.005, flat_length=0.01913, crown_radius=7.5, length=None)
#[pyclass(name = "Roller", module = "nacre", frozen, extends = PyShape)]
pub(super) struct PyRoller;

#[pymethods]
impl PyRoller {
    #[new]
    #[pyo3(signature = (radius, flat_length=None, crown_radius=None, length=None, profile=None))]
    fn new(
        radius: f64,
        flat_length: Option<f64>,
        crown_radius: Option<f64>,
        length: Option<f64>,
        profile: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let mut roller = match (flat_length, crown_radius, profile) {
            (Some(flat_length), Some(crown_radius), None) => {
                Roller::new(radius, flat_length, crown_radius)?
            }
            (None, None, Some(profile)) => {
                Roller::with_profile(radius, profiles::profile(profile)?)?
            }
            _ => {
                return Err(Error::Inconsistent(
                    "either flat_length and crown_radius or profile must be given",
                )
                .into());
            }
        };
        if let Some(length) = length {
            roller = roller.with_length(length)?;
        }
        Ok(subclass(Self, Shape::Roller(roller)))
    }

    /// Radius [m].
    #[getter]
    fn radius(slf: &Bound<'_, Self>) -> f64 {
        roller(slf).radius()
    }

    /// Length of the straight part of a crowned roller [m].
    #[getter]
    fn flat_length(slf: &Bound<'_, Self>) -> Option<f64> {
        crown(slf).map(|crown| crown.flat_length())
    }

    /// Radius of the ends of a crowned roller [m].
    #[getter]
    fn crown_radius(slf: &Bound<'_, Self>) -> Option<f64> {
        crown(slf).map(|crown| crown.crown_radius())
    }

    /// Whole length [m], where it is cut off.
    #[getter]
    fn length(slf: &Bound<'_, Self>) -> Option<f64> {
        roller(slf).length()
    }

    /// The axial profile, where it is not a crown.
    #[getter]
    fn profile<'py>(slf: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyAny>>> {
        profiles::to_python(slf.py(), roller(slf).profile())
    }
}

/// A flat circular punch: ``h = 0`` for ``r <= a``, +inf beyond.
///
/// Parameters
/// ----------
/// radius : float
///     Radius a [m], above 0.
///
/// Raises
/// ------
/// ValueError
///     If it is not finite and above 0.
///
/// Examples
/// --------
/// >>> nacre.FlatPunch(radius=1e-3)
/// FlatPunch(radius=0.001)
#[pyclass(name = "FlatPunch", module = "nacre", frozen, extends = PyShape)]
pub(super) struct PyFlatPunch;

#[pymethods]
impl PyFlatPunch {
    #[new]
    fn new(radius: f64) -> PyResult<PyClassInitializer<Self>> {
        Ok(subclass(Self, Shape::FlatPunch(FlatPunch::new(radius)?)))
    }

    /// Radius [m].
    #[getter]
    fn radius(slf: &Bound<'_, Self>) -> f64 {
        match &slf.as_super().get().0 {
            Shape::FlatPunch(shape) => shape.radius(),
            _ => unreachable!("made by its own constructor"),
        }
    }
}

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

#[pymethods]
impl PyHeightMap {
    #[new]
    #[pyo3(
        signature = (heights, spacing, center=[0.0, 0.0]),
        text_signature = "(heights, spacing, center=(0.0, 0.0))"
    )]
    fn new(
        heights: &Bound<'_, PyAny>,
        spacing: &Bound<'_, PyAny>,
        center: [f64; 2],
    ) -> PyResult<PyClassInitializer<Self>> {
        let both = spacing.extract::<f64>().map(|spacing| [spacing; 2]);
        let spacing = both
            .or_else(|_| spacing.extract::<[f64; 2]>())
            .map_err(|_| {
                PyTypeError::new_err(format!(
                    "spacing must be a number or a pair of numbers, got {}",
                    Repr(spacing)
                ))
            })?;
        let map = HeightMap::new(real_matrix("heights", heights)?, spacing)?;
        Ok(subclass(Self, Shape::HeightMap(map.centered_at(center)?)))
    }

    /// Reads a measured surface from a file.
    ///
    /// Instruments' files are read by SurfaceTopography, with ``nacre[surfaces]``. Missing points
    /// are filled smoothly from around them, and counted in a `nacre.NacreWarning`.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    ///     ``.npy``: a matrix of heights ``(nx, ny)``. ``.csv``: likewise, one line for each x;
    ///     comments ``# unit: um`` and ``# spacing: 0.5 0.5`` may precede. ``.xyz``: points on a
    ///     grid. Anything else that SurfaceTopography knows.
    /// spacing : float or tuple of float, optional
    ///     Distances between samples [m]; needed where the file does not say.
    /// unit : str, optional
    ///     Unit of the numbers in the file ("nm", "um", "mm", ...); the file's by default, metres
    ///     where it names none.
    /// detrend : {"plane", "none", "mean", "quadratic"}, optional
    ///     What is subtracted: the plane, the mean or the paraboloid that fits best.
    /// channel : str or int, optional
    ///     Which of an instrument's channels to read.
    ///
    /// Returns
    /// -------
    /// HeightMap
    ///     The surface.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the file cannot be understood, or less than half of it was measured.
    /// OSError
    ///     If it cannot be read.
    ///
    /// Examples
    /// --------
    /// >>> import tempfile
    /// >>> with tempfile.TemporaryDirectory() as folder:
    /// ...     np.save(f"{folder}/flat.npy", np.zeros((4, 3)))
    /// ...     nacre.HeightMap.read(f"{folder}/flat.npy", spacing=1e-6, unit="nm").heights.shape
    /// (4, 3)
    #[staticmethod]
    #[pyo3(signature = (path, *, spacing=None, unit=None, detrend="plane", channel=None))]
    fn read<'py>(
        py: Python<'py>,
        path: &Bound<'py, PyAny>,
        spacing: Option<&Bound<'py, PyAny>>,
        unit: Option<&str>,
        detrend: &str,
        channel: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let options = PyDict::new(py);
        options.set_item("spacing", spacing)?;
        options.set_item("unit", unit)?;
        options.set_item("detrend", detrend)?;
        options.set_item("channel", channel)?;
        let surfaces = py.import("nacre.surfaces")?;
        surfaces.call_method("read", (path,), Some(&options))
    }

    /// The heights ``(nx, ny)`` [m].
    #[getter]
    fn heights<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let map = height_map(slf);
        read_only(slf.py(), map.heights().to_owned())
    }

    /// Distances between samples ``(dx, dy)`` [m].
    #[getter]
    fn spacing(slf: &Bound<'_, Self>) -> (f64, f64) {
        height_map(slf).spacing().into()
    }

    /// Centre [m].
    #[getter]
    fn center(slf: &Bound<'_, Self>) -> (f64, f64) {
        height_map(slf).center().into()
    }
}

/// A kind of shape, on its base.
fn subclass<T: PyClass<BaseType = PyShape>>(kind: T, shape: Shape) -> PyClassInitializer<T> {
    PyClassInitializer::from(PyShape(shape)).add_subclass(kind)
}

fn height_map<'a>(object: &'a Bound<'_, PyHeightMap>) -> &'a HeightMap {
    match &object.as_super().get().0 {
        Shape::HeightMap(map) => map,
        _ => unreachable!("made by its own constructor"),
    }
}

fn roller<'a>(object: &'a Bound<'_, PyRoller>) -> &'a Roller {
    match &object.as_super().get().0 {
        Shape::Roller(roller) => roller,
        _ => unreachable!("made by its own constructor"),
    }
}

fn crown<'a>(object: &'a Bound<'_, PyRoller>) -> Option<&'a CrownedProfile> {
    match roller(object).profile() {
        Profile::Crowned(crown) => Some(crown),
        Profile::Logarithmic(_) | Profile::Sampled(_) => None,
    }
}
