//! `nacre.Shape`, and the value that it holds.

use ndarray::Array2;
use numpy::{IntoPyArray, PyArray2, PyArrayDyn, PyArrayMethods};
use pyo3::PyClass;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyTuple};

use crate::error::Result;
use crate::grid::Grid;
use crate::python::arguments::{Repr, array_repr, hash};
use crate::python::grid::PyGrid;
use crate::surface::{self, Extent, Profile, Surface};

/// A kind of shape with a Python class of the same name. `repr` and pickles are made of its arguments.
pub(super) trait Kind: Surface {
    /// Class of the objects.
    type Class: PyClass<BaseType = PyShape>;

    /// Arguments of the constructor, by name and in their order.
    fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>>;
}

/// The kinds of shapes.
macro_rules! kinds {
    ($($kind:ident),* $(,)?) => {
        /// Any shape that Python can name, as a value to compare, copy and print.
        #[derive(Debug, Clone, PartialEq)]
        pub(in crate::python) enum Shape {
            $($kind(surface::$kind),)*
            Sum(Box<[Shape; 2]>),
            Shifted(Box<Shape>, [f64; 2]),
        }

        impl Shape {
            /// Calls `f` with the surface that this is.
            fn with<R>(&self, f: impl FnOnce(&dyn Surface) -> R) -> R {
                match self {
                    $(Self::$kind(shape) => f(shape),)*
                    Self::Sum(parts) => f(&(&parts[0]).plus(&parts[1])),
                    Self::Shifted(shape, [x, y]) => match shape.as_ref().shifted(*x, *y) {
                        Ok(shifted) => f(&shifted),
                        Err(_) => unreachable!("checked when it was made"),
                    },
                }
            }

            /// Name of the class and arguments of its constructor; none for sums and shifted shapes.
            fn constructor<'py>(
                &self,
                py: Python<'py>,
            ) -> PyResult<Option<(&'static str, Bound<'py, PyDict>)>> {
                Ok(match self {
                    $(Self::$kind(shape) => Some((stringify!($kind), shape.arguments(py)?)),)*
                    Self::Sum(_) | Self::Shifted(..) => None,
                })
            }
        }

        /// Adds `nacre.Shape` and the classes of all kinds to the module.
        pub(in crate::python) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
            module.add_class::<PyShape>()?;
            $(module.add_class::<<surface::$kind as Kind>::Class>()?;)*
            Ok(())
        }

        $(impl From<surface::$kind> for Shape {
            fn from(shape: surface::$kind) -> Self {
                Self::$kind(shape)
            }
        }

        impl<'a> From<&'a Shape> for &'a surface::$kind {
            fn from(shape: &'a Shape) -> Self {
                match shape {
                    Shape::$kind(shape) => shape,
                    _ => unreachable!("an object is made by the constructor of its class"),
                }
            }
        })*
    };
}

kinds! {
    Sphere,
    Paraboloid,
    Cylinder,
    Roller,
    FlatPunch,
    HeightMap,
}

/// Object of `class` that holds `shape`.
pub(super) fn object<C: PyClass<BaseType = PyShape>>(
    class: C,
    shape: impl Into<Shape>,
) -> PyClassInitializer<C> {
    PyClassInitializer::from(PyShape(shape.into())).add_subclass(class)
}

/// Shape that an object holds.
pub(super) fn held<'a, C: PyClass<BaseType = PyShape>, K>(object: &'a Bound<'_, C>) -> &'a K
where
    &'a K: From<&'a Shape>,
{
    (&object.as_super().get().0).into()
}

impl Shape {
    /// Text that equal shapes share, without the numbers of measured surfaces and profiles.
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

    fn to_python<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match self.constructor(py)? {
            Some((class, arguments)) => class_of(py, class)?.call((), Some(&arguments)),
            None => Ok(Bound::new(py, PyShape(self.clone()))?.into_any()),
        }
    }

    fn repr(&self, py: Python<'_>) -> PyResult<String> {
        let in_brackets = |shape: &Self, nested: bool| -> PyResult<String> {
            let text = shape.repr(py)?;
            Ok(if nested { format!("({text})") } else { text })
        };
        if let Some((class, arguments)) = self.constructor(py)? {
            let mut texts = Vec::new();
            for (name, value) in arguments {
                let text = match value.cast::<PyArrayDyn<f64>>() {
                    Ok(array) => array_repr(py, array.to_owned_array())?,
                    Err(_) => value.repr()?.to_string(),
                };
                texts.push(format!("{name}={text}"));
            }
            return Ok(format!("{class}({})", texts.join(", ")));
        }
        Ok(match self {
            Self::Sum(parts) => {
                let nested = matches!(parts[1], Self::Sum(_));
                format!(
                    "{} + {}",
                    parts[0].repr(py)?,
                    in_brackets(&parts[1], nested)?
                )
            }
            Self::Shifted(shape, [x, y]) => {
                let nested = matches!(**shape, Self::Sum(_));
                format!("{}.shifted({x:?}, {y:?})", in_brackets(shape, nested)?)
            }
            _ => unreachable!("all others have a constructor"),
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
    fn marks(&self) -> [Vec<f64>; 2] {
        self.with(|shape| shape.marks())
    }
    fn radii(&self) -> [f64; 2] {
        self.with(|shape| shape.radii())
    }
    fn grid(&self) -> Option<Grid> {
        self.with(|shape| shape.grid())
    }
    fn rolling_direction(&self) -> Option<[f64; 2]> {
        self.with(|shape| shape.rolling_direction())
    }
}

/// An undeformed shape: the gap h(x, y) to the plane z = 0.
///
/// Shapes can be added (``sphere + roughness``) and moved (``shape.shifted(x, y)``). Where the gap is
/// +inf, the shape cannot touch.
///
/// Examples
/// --------
/// >>> nacre.Sphere(5e-3) + nacre.HeightMap([[0.0, 1e-9], [1e-9, 0.0]], spacing=1e-6)
/// Sphere(radius=0.005) + HeightMap(heights=[[0.0, 1e-09], [1e-09, 0.0]], spacing=(1e-06, 1e-06), center=(0.0, 0.0))
#[pyclass(name = "Shape", module = "nacre", frozen, eq, subclass)]
#[derive(Clone, PartialEq)]
pub(in crate::python) struct PyShape(pub(in crate::python) Shape);

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

    /// Unit vector ``(x, y)`` along which the shape rolls: across the axis of a roller or cylinder.
    ///
    /// `None` for shapes that roll in any direction, or in none. The sum of a shape that has one and a
    /// shape that has none, such as a roller with roughness, has that of its part. Friction acts along
    /// it where no `direction` is given.
    #[getter]
    fn rolling_direction(&self) -> Option<(f64, f64)> {
        Surface::rolling_direction(&self.0).map(Into::into)
    }

    /// Shape that is moved along x and y.
    ///
    /// Parameters
    /// ----------
    /// x, y : float
    ///     Distances by which it is moved [m].
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

    /// Callable and arguments that make the shape again.
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        if let Some((class, arguments)) = self.0.constructor(py)? {
            return Ok((class_of(py, class)?, arguments.values().to_tuple()));
        }
        let operator = py.import("operator")?;
        Ok(match &self.0 {
            Shape::Sum(parts) => {
                let parts = (parts[0].to_python(py)?, parts[1].to_python(py)?);
                (operator.getattr("add")?, parts.into_pyobject(py)?)
            }
            Shape::Shifted(shape, [x, y]) => {
                let shift = operator.call_method1("methodcaller", ("shifted", *x, *y))?;
                (shift, (shape.to_python(py)?,).into_pyobject(py)?)
            }
            _ => unreachable!("all others have a constructor"),
        })
    }
}

fn class_of<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("nacre._core")?.getattr(name)
}

/// Shape from an argument.
pub(in crate::python) fn shape<'a, 'py>(
    object: &'a Bound<'py, PyAny>,
) -> PyResult<&'a Bound<'py, PyShape>> {
    object.cast::<PyShape>().map_err(|_| {
        PyTypeError::new_err(format!("shape must be a nacre.Shape, got {}", Repr(object)))
    })
}

/// Arguments of a constructor whose values are numbers.
pub(super) fn numbers<'py, const N: usize>(
    py: Python<'py>,
    arguments: [(&str, f64); N],
) -> PyResult<Bound<'py, PyDict>> {
    arguments.into_py_dict(py)
}
