//! `nacre.Elastic`, `nacre.Spring`, `nacre.Layer`, `nacre.HalfSpace`, `nacre.Response`, `nacre.RIGID`, `nacre.FREE`.

use std::hash::{DefaultHasher, Hash, Hasher};

use numpy::PyArray1;
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyTuple;

use super::arguments::{Real, Repr, ends, items, read_only, real, real_array};
use super::value::{self, Arguments, Value, class};
use crate::compliance::response::{Body, Sampled};
use crate::model::body::{HalfSpace, Interface, Layer, Spring, Substrate};
use crate::model::material::Elastic;

class! {
    /// An isotropic linear elastic material.
    ///
    /// Parameters
    /// ----------
    /// young : float
    ///     Young's modulus [Pa], above 0.
    /// poisson : float
    ///     Poisson's ratio, above -1 and at most 0.5.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If a constant is out of range.
    ///
    /// Examples
    /// --------
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> round(steel.plane_strain_modulus / 1e9, 2)
    /// 230.77
    PyElastic(Elastic) is "Elastic" of "nacre";
    |of, py|
    arguments {
        /// Young's modulus [Pa].
        young: f64 = of.young();
        /// Poisson's ratio.
        poisson: f64 = of.poisson();
    }
    attributes {
        /// Shear modulus ``E / (2 (1 + nu))`` [Pa].
        shear: f64 = of.shear();
        /// Plane strain modulus ``E / (1 - nu**2)`` [Pa], the contact modulus against a rigid body.
        plane_strain_modulus: f64 = of.plane_strain_modulus();
    }
    methods {
        #[new]
        fn new(young: Real, poisson: Real) -> PyResult<Self> {
            Ok(Self(Elastic::new(young.0, poisson.0)?))
        }
    }
}

/// Type of `nacre.RIGID`, a rigid base.
#[pyclass(name = "Rigid", module = "nacre", frozen, eq)]
#[derive(Clone, PartialEq)]
pub(super) struct PyRigid;

#[pymethods]
impl PyRigid {
    fn __repr__(&self) -> &'static str {
        "RIGID"
    }

    fn __reduce__(&self) -> &'static str {
        "RIGID"
    }
}

/// The one object `nacre.RIGID`.
pub(super) fn rigid(py: Python<'_>) -> PyResult<Bound<'_, PyRigid>> {
    static RIGID: PyOnceLock<Py<PyRigid>> = PyOnceLock::new();
    Ok(RIGID.get_or_try_init(py, || Py::new(py, PyRigid))?.bind(py).clone())
}

/// Type of `nacre.FREE`, a base without tractions.
#[pyclass(name = "Free", module = "nacre", frozen, eq)]
#[derive(Clone, PartialEq)]
pub(super) struct PyFree;

#[pymethods]
impl PyFree {
    fn __repr__(&self) -> &'static str {
        "FREE"
    }

    fn __reduce__(&self) -> &'static str {
        "FREE"
    }
}

/// The one object `nacre.FREE`.
pub(super) fn free(py: Python<'_>) -> PyResult<Bound<'_, PyFree>> {
    static FREE: PyOnceLock<Py<PyFree>> = PyOnceLock::new();
    Ok(FREE.get_or_try_init(py, || Py::new(py, PyFree))?.bind(py).clone())
}

class! {
    /// Springs between the two sides of an interface: an imperfect bond.
    ///
    /// Tractions pass, and the displacement jumps by traction over stiffness.
    ///
    /// Parameters
    /// ----------
    /// normal : float, optional
    ///     Stiffness across the interface [Pa/m], above 0. By default its sides do not move apart.
    /// tangential : float, optional
    ///     Stiffness along the interface [Pa/m], at least 0; 0 slips freely. By default its sides do not slip.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If neither is given, which is a bonded interface; if a stiffness is not finite or out of range.
    ///
    /// Notes
    /// -----
    /// A film of thickness t and constants E, nu, G that is much thinner than the layers next to it has the stiffnesses
    /// ``E (1 - nu) / ((1 + nu) (1 - 2 nu) t)`` and ``G / t``. Springs hold against tension as against pressure. Jones &
    /// Whittier, Waves at a flexibly bonded interface, J. Appl. Mech. 34 (1967) 905.
    ///
    /// Examples
    /// --------
    /// >>> dlc = nacre.Elastic(young=420e9, poisson=0.3)
    /// >>> bond = nacre.Spring(normal=1.6e15, tangential=3.7e14)
    /// >>> nacre.Layer(dlc, thickness=2e-6, interface=bond).interface.tangential
    /// 370000000000000.0
    PySpring(Spring) is "Spring" of "nacre";
    |of, py|
    arguments {
        /// Stiffness across the interface [Pa/m]; None where it is rigid.
        normal: Option<f64> = of.normal();
        /// Stiffness along the interface [Pa/m]; None where it is rigid.
        tangential: Option<f64> = of.tangential();
    }
    attributes {}
    methods {
        #[new]
        #[pyo3(signature = (normal=None, tangential=None))]
        fn new(normal: Option<Real>, tangential: Option<Real>) -> PyResult<Self> {
            Ok(Self(Spring::new(normal.map(|k| k.0), tangential.map(|k| k.0))?))
        }
    }
}

/// Interface from an argument: a word, or springs.
pub(super) struct PyInterface(Interface);

impl<'a, 'py> FromPyObject<'a, 'py> for PyInterface {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(spring) = object.extract::<PySpring>() {
            return Ok(Self(Interface::Spring(spring.0)));
        }
        match object.extract::<&str>() {
            Ok("bonded") => Ok(Self(Interface::Bonded)),
            Ok("frictionless") => Ok(Self(Interface::Frictionless)),
            Ok(other) => Err(PyValueError::new_err(format!(
                "interface must be \"bonded\", \"frictionless\" or a nacre.Spring, got {other:?}"
            ))),
            Err(_) => Err(PyTypeError::new_err(format!(
                "interface must be \"bonded\", \"frictionless\" or a nacre.Spring, got {}",
                Repr(&object)
            ))),
        }
    }
}

/// Object for an interface.
fn interface(py: Python<'_>, of: Interface) -> PyResult<Bound<'_, PyAny>> {
    match of {
        Interface::Bonded => "bonded".into_bound_py_any(py),
        Interface::Frictionless => "frictionless".into_bound_py_any(py),
        Interface::Spring(spring) => PySpring(spring).into_bound_py_any(py),
    }
}

class! {
    /// A layer of uniform thickness, and the interface below it.
    ///
    /// Parameters
    /// ----------
    /// material : Elastic
    ///     Material of the layer.
    /// thickness : float
    ///     Thickness [m], above 0.
    /// interface : {"bonded", "frictionless"} or Spring, optional
    ///     Interface below the layer. At a bonded one displacement and traction are continuous; a
    ///     frictionless one slips freely and never opens; at a `Spring` the displacement jumps by traction over
    ///     stiffness.
    /// name : str, optional
    ///     Name of the layer, which results show: any text on one line but a number and "substrate".
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the thickness is not finite and above 0, there is no such interface, or the name is empty,
    ///     a number or "substrate".
    ///
    /// Examples
    /// --------
    /// >>> dlc = nacre.Elastic(young=420e9, poisson=0.3)
    /// >>> coating = nacre.Layer(dlc, thickness=2e-6, name="DLC")
    /// >>> coating.name, coating.interface
    /// ('DLC', 'bonded')
    PyLayer(Layer) is "Layer" of "nacre";
    |of, py|
    attributes {
        /// Material of the layer.
        material: PyElastic = PyElastic(of.material());
        /// Thickness [m].
        thickness: f64 = of.thickness();
        /// Interface below the layer: "bonded", "frictionless" or a `Spring`.
        interface: Bound<'py, PyAny> = interface(py, of.interface())?;
        /// Name of the layer; None where it has none.
        name: Option<String> = of.name().map(String::from);
    }
    methods {
        #[new]
        #[pyo3(
            signature = (material, thickness, interface=PyInterface(Interface::Bonded), name=None),
            text_signature = "(material, thickness, interface='bonded', name=None)"
        )]
        fn new(
            material: &Bound<'_, PyAny>,
            thickness: Real,
            interface: PyInterface,
            name: Option<&str>,
        ) -> PyResult<Self> {
            let refuse = |_| wrong_body("material must be an Elastic", material);
            let material = material.extract::<PyElastic>().map_err(refuse)?;
            let layer = Layer::new(material.0, thickness.0)?.with_interface(interface.0);
            Ok(Self(match name {
                Some(name) => layer.with_name(name)?,
                None => layer,
            }))
        }
    }
}

impl Value for PyLayer {
    const NAME: &'static str = "Layer";
    const UNNAMED: usize = 1;

    fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Arguments<'py>> {
        Ok(vec![
            ("material", PyElastic(self.0.material()).into_bound_py_any(py)?),
            ("thickness", self.0.thickness().into_bound_py_any(py)?),
            ("interface", interface(py, self.0.interface())?),
            ("name", self.0.name().into_bound_py_any(py)?),
        ])
    }
}

class! {
    /// A half-space: a substrate, and layers from the surface down; free ends cut it off along x.
    ///
    /// Parameters
    /// ----------
    /// substrate : Elastic, nacre.RIGID or nacre.FREE
    ///     Material below the layers. With `nacre.FREE` the layers are a plate, whose lower face has no tractions: it takes
    ///     part in contacts on grids that are periodic along x and along y, where a uniform pressure on that face balances
    ///     the mean, and is refused elsewhere.
    /// layers : sequence of Layer, optional
    ///     Layers from the surface down.
    /// ends : tuple of float, optional
    ///     Coordinates x of free ends [m], the lower one first: the body is cut off there, and nothing holds
    ///     the end face. None, -inf or inf where it has no end, the default on both sides. A body with ends
    ///     needs bonded interfaces.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the substrate is rigid or free and there is no layer, or there are ends; if the interface of the lowest layer
    ///     of a plate is not bonded; if the ends are not finite or not in ascending order, or an interface is not bonded.
    ///
    /// Notes
    /// -----
    /// Contacts count the ends of both bodies, and so do stresses but for those of friction. A body that ends is
    /// a quarter space: Hetényi, A general solution for the elastic quarter space, J. Appl. Mech. 37 (1970) 75,
    /// doi:10.1115/1.3408508. Its reduction to the half-space, and that of a body with two ends, were derived here.
    /// What the end of a body with layers adds is a model, and a warning tells of its error. Ends lie on edges of
    /// the cells of a grid, or outside it.
    ///
    /// Examples
    /// --------
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> dlc = nacre.Elastic(young=420e9, poisson=0.3)
    /// >>> nacre.HalfSpace(steel, layers=[nacre.Layer(dlc, thickness=2e-6)]).interfaces
    /// [2e-06]
    ///
    /// A roller of 10 mm on a raceway that extends beyond it:
    ///
    /// >>> roller = nacre.Roller(radius=5e-3, flat_length=8e-3, crown_radius=0.5, length=10e-3)
    /// >>> counterbody = nacre.HalfSpace(steel, ends=roller.ends)
    /// >>> counterbody.ends
    /// (-0.005, 0.005)
    /// >>> free = nacre.solve(roller, steel, counterbody, load=100.0)
    /// >>> whole = nacre.solve(roller, steel, steel, load=100.0)
    /// >>> bool(free.approach > whole.approach)
    /// True
    PyHalfSpace(HalfSpace) is "HalfSpace" of "nacre";
    |of, py|
    attributes {
        /// Material below the layers: an `Elastic`, `nacre.RIGID` or `nacre.FREE`.
        substrate: Bound<'py, PyAny> = base(py, of.substrate())?;
        /// Layers from the surface down.
        layers: Bound<'py, PyTuple> = PyTuple::new(py, of.layers().iter().cloned().map(PyLayer))?;
        /// Depths of the interfaces [m], from the surface down.
        interfaces: Vec<f64> = of.interfaces();
        /// Coordinates x of the free ends [m]; None where the body has no end.
        ends: (Option<f64>, Option<f64>) = of.ends().into();
    }
    methods {
        #[new]
        #[pyo3(signature = (substrate, layers=None, *, ends=None))]
        fn new(
            substrate: &Bound<'_, PyAny>,
            layers: Option<&Bound<'_, PyAny>>,
            ends: Option<&Bound<'_, PyAny>>,
        ) -> PyResult<Self> {
            let substrate = self::substrate(substrate)?;
            let layers: Vec<PyLayer> = match layers {
                Some(layers) => items("layers", "Layer", layers)?,
                None => Vec::new(),
            };
            let layers = layers.into_iter().map(|layer| layer.0);
            Ok(Self(HalfSpace::new(substrate, layers)?.with_ends(self::ends(ends)?)?))
        }

        /// A body with ends, for pickles.
        #[staticmethod]
        fn _ended(
            substrate: &Bound<'_, PyAny>,
            layers: &Bound<'_, PyAny>,
            ends: &Bound<'_, PyAny>,
        ) -> PyResult<Self> {
            Self::new(substrate, Some(layers), Some(ends))
        }
    }
}

impl Value for PyHalfSpace {
    const NAME: &'static str = "HalfSpace";
    const UNNAMED: usize = 1;

    fn maker(&self) -> Option<&'static str> {
        (self.0.ends() != [None; 2]).then_some("_ended")
    }

    fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Arguments<'py>> {
        let layers = self.0.layers().iter().cloned().map(PyLayer);
        let mut arguments = vec![
            ("substrate", base(py, self.0.substrate())?),
            ("layers", PyTuple::new(py, layers)?.into_any()),
        ];
        if self.0.ends() != [None; 2] {
            let ends = <(Option<f64>, Option<f64>)>::from(self.0.ends());
            arguments.push(("ends", ends.into_bound_py_any(py)?));
        }
        Ok(arguments)
    }
}

/// A body that is known by its normal response, a function of the wavenumber.
///
/// An elastic foundation, a plate, or a compliance that was measured or published takes part in contacts as a
/// body or a counterbody. It must be the same in all directions of the surface.
///
/// Parameters
/// ----------
/// function : callable
///     Function that takes wavenumbers ``alpha = sqrt(m**2 + n**2)`` [1/m], an array, and returns the normal
///     displacement of the surface per unit pressure at each, ``u_z/p`` [m/Pa], finite and at least 0. It is called
///     once, with 37121 wavenumbers from 6e-26 to 2e25, and must keep its digits there.
/// local : float, optional
///     Displacement of a point per pressure on that point [m/Pa], at least 0, beside that of the function, as springs
///     have it. A function that ends in a constant contains it.
///
/// Raises
/// ------
/// TypeError
///     If the function is not callable, or does not return real numbers.
/// ValueError
///     If what the function returns has another shape than its argument, is not finite, below 0 or 0 everywhere, or does
///     not settle: to ``c/alpha`` or a constant at long waves, and to ``c/alpha``, a constant or less at short ones.
///
/// Notes
/// -----
/// Values between the wavenumbers, 320 in a factor of e, are interpolated. Pickles and files keep the values, and not
/// the function. Friction, stresses, tips and derivatives by the numbers of a body need a `HalfSpace`.
///
/// Examples
/// --------
/// A Winkler bed of 1e12 Pa/m: the pressure is the displacement times the stiffness.
///
/// >>> bed = nacre.Response(lambda alpha: np.full_like(alpha, 1e-12))
/// >>> grid = nacre.Grid(shape=(64, 64), size=(4e-4, 4e-4))
/// >>> solution = nacre.solve(nacre.Paraboloid(5e-3, 5e-3), bed, grid=grid, approach=2e-6)
/// >>> bool(np.allclose(solution.pressure, 1e12 * solution.displacement))
/// True
#[pyclass(name = "Response", module = "nacre", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub(super) struct PyResponse(Body);

impl PyResponse {
    /// Response of values at the wavenumbers.
    fn of(name: &str, values: &Bound<'_, PyAny>, local: f64) -> PyResult<Self> {
        let values = real_array(name, values)?;
        let (count, shape) = (Sampled::wavenumbers().len(), values.shape().to_vec());
        if shape != [count] {
            return Err(PyValueError::new_err(format!(
                "{name} must have the shape of the wavenumbers, ({count},), got shape {shape:?}"
            )));
        }
        Ok(Self(Sampled::new(values.into_iter().collect(), local)?.into()))
    }

    /// The samples, of which every response of Python is made.
    fn sampled(&self) -> PyResult<&Sampled> {
        self.0.sampled().ok_or_else(|| PyTypeError::new_err("this body is no response of samples"))
    }
}

#[pymethods]
impl PyResponse {
    #[new]
    #[pyo3(signature = (function, *, local=0.0))]
    fn new(function: &Bound<'_, PyAny>, #[pyo3(from_py_with = real)] local: f64) -> PyResult<Self> {
        if !function.is_callable() {
            return Err(PyTypeError::new_err(format!(
                "function must be a function of an array of wavenumbers, got {}",
                Repr(function)
            )));
        }
        let wavenumbers = PyArray1::from_iter(function.py(), Sampled::wavenumbers());
        Self::of("function(wavenumbers)", &function.call1((wavenumbers,))?, local)
    }

    /// Response of values, for pickles and files.
    #[staticmethod]
    fn _of(values: &Bound<'_, PyAny>, #[pyo3(from_py_with = real)] local: f64) -> PyResult<Self> {
        Self::of("values", values, local)
    }

    /// Wavenumbers ``(37121,)`` [1/m] at which the function was called.
    #[getter]
    fn wavenumbers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        read_only(py, Sampled::wavenumbers().collect())
    }

    /// Values of the function there [m/Pa].
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        read_only(py, self.sampled()?.values().to_vec().into())
    }

    /// Local compliance [m/Pa] beside the function.
    #[getter]
    fn local(&self) -> PyResult<f64> {
        Ok(self.sampled()?.beside())
    }

    /// Limits of ``alpha u_z/p`` [1/Pa] at long and at short waves, found from the values, without the springs.
    #[getter]
    fn limits(&self) -> (f64, f64) {
        let limits = self.0.asymptotes();
        (limits.long, limits.short)
    }

    fn __repr__(&self) -> String {
        let brief = |value: f64| format!("{value:.3e}").parse().unwrap_or(value);
        let [long, short] = <[f64; 2]>::from(self.limits()).map(brief);
        let springs = brief(self.0.local());
        format!("<Response: limits ({long:?}, {short:?}) 1/Pa, springs {springs:?} m/Pa>")
    }

    fn __hash__(&self) -> PyResult<u64> {
        let sampled = self.sampled()?;
        let mut hasher = DefaultHasher::new();
        sampled.values().iter().for_each(|value| value.to_bits().hash(&mut hasher));
        Ok(hasher.finish())
    }

    /// Callable and arguments that make the response again.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<value::Reduced<'py>> {
        let (py, of) = (slf.py(), slf.get());
        let arguments = (of.values(py)?, of.local()?).into_pyobject(py)?;
        Ok((slf.get_type().getattr("_of")?, arguments))
    }
}

/// A body of Python.
#[derive(FromPyObject, IntoPyObject)]
pub(super) enum PyBody {
    HalfSpace(PyHalfSpace),
    Response(PyResponse),
}

impl From<&Body> for PyBody {
    fn from(body: &Body) -> Self {
        match body.half_space() {
            Some(layers) => Self::HalfSpace(PyHalfSpace(layers.clone())),
            None => Self::Response(PyResponse(body.clone())),
        }
    }
}

impl From<PyBody> for Body {
    fn from(body: PyBody) -> Self {
        match body {
            PyBody::HalfSpace(layers) => layers.0.into(),
            PyBody::Response(response) => response.0,
        }
    }
}

/// Object for a substrate.
fn base(py: Python<'_>, substrate: Substrate) -> PyResult<Bound<'_, PyAny>> {
    match substrate {
        Substrate::Elastic(material) => PyElastic(material).into_bound_py_any(py),
        Substrate::Rigid => Ok(rigid(py)?.into_any()),
        Substrate::Free => Ok(free(py)?.into_any()),
    }
}

/// Substrate from an argument.
pub(super) fn substrate(object: &Bound<'_, PyAny>) -> PyResult<Substrate> {
    if object.cast::<PyRigid>().is_ok() {
        return Ok(Substrate::Rigid);
    }
    if object.cast::<PyFree>().is_ok() {
        return Ok(Substrate::Free);
    }
    match object.extract::<PyElastic>() {
        Ok(material) => Ok(material.0.into()),
        Err(_) => {
            Err(wrong_body("substrate must be an Elastic, nacre.RIGID or nacre.FREE", object))
        }
    }
}

/// Body from an argument: a half-space, a material that fills one, or a response.
pub(super) fn body(object: &Bound<'_, PyAny>) -> PyResult<Body> {
    if let Ok(body) = object.extract::<PyBody>() {
        return Ok(body.into());
    }
    match object.extract::<PyElastic>() {
        Ok(material) => Ok(material.0.into()),
        Err(_) => Err(no_body("a HalfSpace, an Elastic or a Response", object)),
    }
}

/// Half-space from an argument, or a material that fills one.
pub(super) fn half_space(object: &Bound<'_, PyAny>) -> PyResult<HalfSpace> {
    if let Ok(body) = object.extract::<PyHalfSpace>() {
        return Ok(body.0);
    }
    match object.extract::<PyElastic>() {
        Ok(material) => Ok(material.0.into()),
        Err(_) => Err(no_body("a HalfSpace or an Elastic", object)),
    }
}

fn no_body(kinds: &str, object: &Bound<'_, PyAny>) -> PyErr {
    wrong_body(&format!("body and counterbody must be {kinds}"), object)
}

/// Error on an object that is no body or material; a card of a material has one.
fn wrong_body(must: &str, object: &Bound<'_, PyAny>) -> PyErr {
    let is_card = object.hasattr("elastic").unwrap_or(false);
    let hint = if is_card { ": give its .elastic" } else { "" };
    PyTypeError::new_err(format!("{must}, got {}{hint}", Repr(object)))
}
