//! Shapes: `nacre.Shape`, its kinds, and the value that it holds; the profiles of rollers.

mod height_map;
mod logarithmic;
mod profiles;
mod quadric;
mod roller;

use std::fmt;
use std::ops::Deref;
use std::sync::{Arc, OnceLock};

use numpy::{IntoPyArray, PyArray2};
use pyo3::IntoPyObjectExt;
use pyo3::PyClass;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyList, PyTuple};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::model::surface::{self, Profile, Shifted, Superposition, Surface};
use crate::python::arguments::{Pair, Real, Repr, hash};
use crate::python::grid::PyGrid;
use crate::python::value::{Arguments, INNER, Reduced, call_text};

pub(super) use logarithmic::PyLogarithmicProfile;
pub(super) use profiles::PySampledProfile;

/// A kind of shape with a Python class of the same name, which is also data. `repr` and pickles are made of its arguments.
trait Kind: Surface + Serialize + DeserializeOwned {
    /// Class of the objects.
    type Class: PyClass<BaseType = PyShape>;
    /// What an object of the class holds beside its shape: nothing.
    const CLASS: Self::Class;

    /// Arguments of the constructor.
    fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Arguments<'py>>;
}

/// Writes the class of a kind of shape: the arguments of its constructor, which are also attributes, what follows from them,
/// and the call that makes the shape. `of` names the shape and `py` Python in the expressions.
macro_rules! shape_class {
    (
        $(#[$meta:meta])*
        $class:ident($kind:ty) is $name:literal;
        |$of:ident, $py:ident|
        arguments {
            $($(#[$doc:meta])* $argument:ident($from:ty $(= $default:tt)?): $type:ty = $read:expr;)*
        }
        attributes { $($(#[$more:meta])* $attribute:ident: $of_type:ty = $compute:expr;)* }
        make $make:block
    ) => {
        $(#[$meta])*
        #[pyclass(name = $name, module = "nacre", frozen, extends = $crate::python::shapes::PyShape)]
        pub(in crate::python) struct $class;

        impl $crate::python::shapes::Kind for $kind {
            type Class = $class;
            const CLASS: $class = $class;

            fn arguments<'py>(&self, $py: Python<'py>) -> PyResult<$crate::python::value::Arguments<'py>> {
                let $of = self;
                Ok(vec![$((stringify!($argument), ($read).into_bound_py_any($py)?),)*])
            }
        }

        #[pymethods]
        impl $class {
            #[new]
            #[pyo3(signature = ($($argument $(= $default)?),*))]
            fn new($($argument: $from),*) -> PyResult<PyClassInitializer<Self>> {
                let shape: $kind = $make;
                Ok($crate::python::shapes::object(Self, shape))
            }

            $($(#[$doc])*
            #[getter]
            fn $argument<'py>(slf: &Bound<'py, Self>) -> PyResult<$type> {
                let ($of, $py) = ($crate::python::shapes::inner_shape::<_, $kind>(slf), slf.py());
                let _ = $py;
                Ok($read)
            })*

            $($(#[$more])*
            #[getter]
            fn $attribute<'py>(slf: &Bound<'py, Self>) -> PyResult<$of_type> {
                let $of = $crate::python::shapes::inner_shape::<_, $kind>(slf);
                Ok($compute)
            })*
        }
    };
}

use shape_class;

/// The kinds of shapes.
macro_rules! kinds {
    ($($kind:ident),* $(,)?) => {
        /// Any shape that Python can name, as a value to compare, copy and print.
        #[derive(Clone)]
        pub(super) enum Shape {
            $($kind(surface::$kind),)*
            Combined(Arc<Combined>),
        }

        impl Shape {
            /// Name of the class.
            fn name(&self) -> &'static str {
                match self {
                    $(Self::$kind(_) => stringify!($kind),)*
                    Self::Combined(_) => "Shape",
                }
            }

            /// Arguments of the call that makes the shape; of a shape that is moved, that shape and its shift.
            fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Arguments<'py>> {
                match self {
                    $(Self::$kind(shape) => shape.arguments(py),)*
                    Self::Combined(sum) => sum.arguments(py),
                }
            }

            /// Object of Python.
            fn to_python<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                Ok(match self {
                    $(Self::$kind(shape) => {
                        let initializer = object(surface::$kind::CLASS, shape.clone());
                        Bound::new(py, initializer)?.into_any()
                    })*
                    Self::Combined(_) => Bound::new(py, PyShape(self.clone()))?.into_any(),
                })
            }
        }

        impl Deref for Shape {
            type Target = dyn Surface;

            fn deref(&self) -> &Self::Target {
                match self {
                    $(Self::$kind(shape) => shape,)*
                    Self::Combined(sum) => sum.flat(),
                }
            }
        }

        impl PartialEq for Shape {
            fn eq(&self, other: &Self) -> bool {
                match (self, other) {
                    $((Self::$kind(one), Self::$kind(two)) => one == two,)*
                    (Self::Combined(one), Self::Combined(two)) => one.flat() == two.flat(),
                    (Self::Combined(sum), one) | (one, Self::Combined(sum)) => sum.is_only(one),
                    _ => false,
                }
            }
        }

        /// Adds `nacre.Shape` and the classes of all kinds to the module.
        pub(super) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
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

impl fmt::Debug for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(f)
    }
}

/// Object of `class` that holds `shape`.
fn object<C: PyClass<BaseType = PyShape>>(
    class: C,
    shape: impl Into<Shape>,
) -> PyClassInitializer<C> {
    PyClassInitializer::from(PyShape(shape.into())).add_subclass(class)
}

/// Shape that an object holds.
fn inner_shape<'a, C: PyClass<BaseType = PyShape>, K>(object: &'a Bound<'_, C>) -> &'a K
where
    &'a K: From<&'a Shape>,
{
    (&object.as_super().get().0).into()
}

/// A sum of moved shapes, which may be sums themselves. The flat list of all is made once, when it is needed.
pub(super) struct Combined {
    parts: Vec<(Shape, [f64; 2])>,
    flat: OnceLock<Superposition<Shifted<Shape>>>,
}

impl Combined {
    /// Shapes that are no sums, in their order, each with its whole shift.
    fn flat(&self) -> &Superposition<Shifted<Shape>> {
        self.flat.get_or_init(|| {
            let mut shapes = Vec::new();
            // Parts that are left with the shift of the sum around them, the next one last.
            let mut left: Vec<_> = self.parts.iter().rev().map(|part| (part, [0.0; 2])).collect();
            while let Some(((shape, [x, y]), [around_x, around_y])) = left.pop() {
                let by = [x + around_x, y + around_y];
                match shape {
                    Shape::Combined(inner) => {
                        left.extend(inner.parts.iter().rev().map(|part| (part, by)));
                    }
                    single => shapes.push(Shifted::by(single.clone(), by)),
                }
            }
            Superposition::new(shapes).unwrap_or_else(|_| unreachable!("one shape at least"))
        })
    }

    /// The shapes; or the one that is moved, and its shift.
    fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Arguments<'py>> {
        if let [only] = self.flat().shapes() {
            let shift = <(f64, f64)>::from(only.shift()).into_bound_py_any(py)?;
            return Ok(vec![(INNER, only.shape().to_python(py)?), ("shift", shift)]);
        }
        let parts = self.flat().shapes().iter().map(|part| match is_moved(part) {
            true => Shape::combined(vec![(part.shape().clone(), part.shift())]).to_python(py),
            false => part.shape().to_python(py),
        });
        Ok(vec![("parts", PyList::new(py, parts.collect::<PyResult<Vec<_>>>()?)?.into_any())])
    }

    /// Whether this is `shape` alone, not moved.
    fn is_only(&self, shape: &Shape) -> bool {
        match self.flat().shapes() {
            [one] => !is_moved(one) && one.shape() == shape,
            _ => false,
        }
    }
}

fn is_moved(part: &Shifted<Shape>) -> bool {
    part.shift().into_iter().any(|by| by.abs() > 0.0)
}

impl Drop for Combined {
    /// Takes sums within sums apart one by one: to any depth on the same piece of stack.
    fn drop(&mut self) {
        let mut left = std::mem::take(&mut self.parts);
        while let Some((shape, _)) = left.pop() {
            if let Shape::Combined(inner) = shape
                && let Some(mut inner) = Arc::into_inner(inner)
            {
                left.append(&mut inner.parts);
            }
        }
    }
}

impl Shape {
    /// The sum of moved shapes.
    fn combined(parts: Vec<(Self, [f64; 2])>) -> Self {
        let flat = OnceLock::new();
        Self::Combined(Arc::new(Combined { parts, flat }))
    }

    /// Text that equal shapes share, without the numbers of measured surfaces and profiles.
    fn key(&self) -> String {
        match self {
            Self::HeightMap(s) => format!("HeightMap {:?} {:?}", s.heights().dim(), s.spacing()),
            Self::Roller(s) if matches!(s.profile(), Profile::Sampled(_)) => s.radius().to_string(),
            Self::Combined(sum) => {
                let keys = sum.flat().shapes().iter().map(|part| match is_moved(part) {
                    true => format!("{} {:?}", part.shape().key(), part.shift()),
                    false => part.shape().key(),
                });
                keys.collect::<Vec<_>>().join(" + ")
            }
            other => format!("{other:?}"),
        }
    }

    fn repr(&self, py: Python<'_>) -> PyResult<String> {
        if let Self::Combined(sum) = self {
            let texts = sum.flat().shapes().iter().map(|part| {
                let text = part.shape().repr(py)?;
                let [x, y] = part.shift();
                Ok(match is_moved(part) {
                    true => format!("{text}.shifted({x:?}, {y:?})"),
                    false => text,
                })
            });
            return Ok(texts.collect::<PyResult<Vec<_>>>()?.join(" + "));
        }
        call_text(self.name(), &self.arguments(py)?, 0)
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
#[pyclass(name = "Shape", module = "nacre.types", frozen, eq, subclass)]
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

    /// Unit vector ``(x, y)`` along which the shape rolls: across the axis of a roller or cylinder.
    ///
    /// `None` for shapes that roll in any direction, or in none. The sum of a shape that has one and a
    /// shape that has none, such as a roller with roughness, has that of its part. Friction acts along
    /// it where no `direction` is given.
    #[getter]
    fn rolling_direction(&self) -> Option<(f64, f64)> {
        Surface::rolling_direction(&self.0).map(Into::into)
    }

    /// Whether the shape is a body of revolution about the z axis.
    ///
    /// Friction acts along x where it is pressed without
    /// tilt, and no `direction` is given.
    #[getter]
    fn is_round(&self) -> bool {
        Surface::is_round(&self.0)
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
    fn shifted(&self, x: Real, y: Real) -> PyResult<Self> {
        let shift = (&self.0).shifted(x.0, y.0)?.shift();
        Ok(Self(Shape::combined(vec![(self.0.clone(), shift)])))
    }

    fn __add__(&self, other: &Self) -> Self {
        let parts = [self, other].map(|shape| (shape.0.clone(), [0.0; 2]));
        Self(Shape::combined(parts.into()))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        self.0.repr(py)
    }

    fn __hash__(&self) -> u64 {
        hash(&self.0.key())
    }

    /// Arguments of the call that makes the shape, by name: the parts of a sum, or a shape and its shift.
    fn _arguments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.0.arguments(py)?.into_py_dict(py)
    }

    /// Sum of shapes, for pickles.
    #[staticmethod]
    fn _sum(parts: Vec<Bound<'_, Self>>) -> Self {
        Self(Shape::combined(parts.iter().map(|part| (part.get().0.clone(), [0.0; 2])).collect()))
    }

    /// Shape that is moved, for pickles.
    #[staticmethod]
    fn _moved(shape: &Bound<'_, Self>, shift: Pair) -> PyResult<Self> {
        shape.get().shifted(Real(shift.0[0]), Real(shift.0[1]))
    }

    /// Callable and arguments that make the shape again.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let (py, class) = (slf.py(), slf.get_type().into_any());
        let make = match &slf.get().0 {
            Shape::Combined(sum) if sum.flat().shapes().len() == 1 => class.getattr("_moved")?,
            Shape::Combined(_) => class.getattr("_sum")?,
            _ => class,
        };
        let arguments = slf.get().0.arguments(py)?.into_iter().map(|(_, argument)| argument);
        Ok((make, PyTuple::new(py, arguments.collect::<Vec<_>>())?))
    }
}

/// Shape from an argument.
pub(super) fn shape<'a, 'py>(object: &'a Bound<'py, PyAny>) -> PyResult<&'a Bound<'py, PyShape>> {
    object.cast::<PyShape>().map_err(|_| {
        PyTypeError::new_err(format!("shape must be a nacre.Shape, got {}", Repr(object)))
    })
}
