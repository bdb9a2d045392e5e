//! Shapes: `nacre.Shape` and its kinds.

use ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use super::arrays::{array_repr, hash, read_only};
use super::grid::PyGrid;
use super::profiles;
use crate::error::Result;
use crate::grid::Grid;
use crate::surface::{
    Cylinder, Extent, FlatPunch, HeightMap, Paraboloid, Profile, Roller, Sphere, Surface,
};

mod height_map;
mod quadric;
mod roller;

pub(super) use height_map::PyHeightMap;
pub(super) use quadric::{PyCylinder, PyFlatPunch, PyParaboloid, PySphere};
pub(super) use roller::PyRoller;

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

/// A kind of shape, on its base.
fn subclass<T: PyClass<BaseType = PyShape>>(kind: T, shape: Shape) -> PyClassInitializer<T> {
    PyClassInitializer::from(PyShape(shape)).add_subclass(kind)
}
