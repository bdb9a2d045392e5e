//! `nacre.Elastic`, `nacre.Layer`, `nacre.HalfSpace`, `nacre.RIGID`.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};

use super::arguments::{Real, Repr, ends, hash, items, remade, word, word_of};
use crate::compliance::response::Body;
use crate::model::body::{HalfSpace, Interface, Layer, Substrate};
use crate::model::material::Elastic;

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
#[pyclass(name = "Elastic", module = "nacre", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub(super) struct PyElastic(pub(super) Elastic);

#[pymethods]
impl PyElastic {
    #[new]
    fn new(young: Real, poisson: Real) -> PyResult<Self> {
        Ok(Self(Elastic::new(young.0, poisson.0)?))
    }

    /// Young's modulus [Pa].
    #[getter]
    fn young(&self) -> f64 {
        self.0.young()
    }

    /// Poisson's ratio.
    #[getter]
    fn poisson(&self) -> f64 {
        self.0.poisson()
    }

    /// Shear modulus ``E / (2 (1 + nu))`` [Pa].
    #[getter]
    fn shear(&self) -> f64 {
        self.0.shear()
    }

    /// Plane strain modulus ``E / (1 - nu**2)`` [Pa], the contact modulus against a rigid body.
    #[getter]
    fn plane_strain_modulus(&self) -> f64 {
        self.0.plane_strain_modulus()
    }

    fn __repr__(&self) -> String {
        elastic_repr(&self.0)
    }

    fn __hash__(&self) -> u64 {
        hash(&self.__repr__())
    }

    /// Callable and arguments that make the material again.
    fn __reduce__<'py>(&self, py: Python<'py>) -> (Bound<'py, PyType>, (f64, f64)) {
        (py.get_type::<Self>(), (self.0.young(), self.0.poisson()))
    }
}

fn elastic_repr(material: &Elastic) -> String {
    format!("Elastic(young={:?}, poisson={:?})", material.young(), material.poisson())
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

/// A layer of uniform thickness, and the interface below it.
///
/// Parameters
/// ----------
/// material : Elastic
///     Material of the layer.
/// thickness : float
///     Thickness [m], above 0.
/// interface : {"bonded", "frictionless"}, optional
///     Interface below the layer. At a bonded one displacement and traction are continuous; a
///     frictionless one slips freely and never opens.
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
#[pyclass(name = "Layer", module = "nacre", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub(super) struct PyLayer(pub(super) Layer);

#[pymethods]
impl PyLayer {
    #[new]
    #[pyo3(signature = (material, thickness, interface="bonded", name=None))]
    fn new(
        material: PyElastic,
        thickness: Real,
        interface: &str,
        name: Option<&str>,
    ) -> PyResult<Self> {
        let interface: Interface = word("interface", interface)?;
        let layer = Layer::new(material.0, thickness.0)?.with_interface(interface);
        Ok(Self(match name {
            Some(name) => layer.with_name(name)?,
            None => layer,
        }))
    }

    /// Material of the layer.
    #[getter]
    fn material(&self) -> PyElastic {
        PyElastic(self.0.material())
    }

    /// Thickness [m].
    #[getter]
    fn thickness(&self) -> f64 {
        self.0.thickness()
    }

    /// Interface below the layer: "bonded" or "frictionless".
    #[getter]
    fn interface(&self) -> String {
        word_of(&self.0.interface())
    }

    /// Name of the layer; None where it has none.
    #[getter]
    fn name(&self) -> Option<&str> {
        self.0.name()
    }

    fn __repr__(&self) -> String {
        let name = self.0.name().map(|name| format!(", name={}", quoted(name)));
        format!(
            "Layer({}, thickness={:?}, interface='{}'{})",
            elastic_repr(&self.0.material()),
            self.0.thickness(),
            self.interface(),
            name.unwrap_or_default()
        )
    }

    fn __hash__(&self) -> u64 {
        hash(&self.__repr__())
    }

    /// Callable and arguments that make the layer again.
    fn __reduce__<'py>(&self, py: Python<'py>) -> (Bound<'py, PyType>, LayerArguments<'_>) {
        let arguments = (self.material(), self.0.thickness(), self.interface(), self.0.name());
        (py.get_type::<Self>(), arguments)
    }
}

/// Literal of Python for a text without control characters.
fn quoted(text: &str) -> String {
    let quote = match text.contains('\'') && !text.contains('"') {
        true => '"',
        false => '\'',
    };
    let mut literal = String::from(quote);
    for character in text.chars() {
        if character == quote || character == '\\' {
            literal.push('\\');
        }
        literal.push(character);
    }
    literal.push(quote);
    literal
}

type LayerArguments<'a> = (PyElastic, f64, String, Option<&'a str>);

/// A half-space: a substrate, and layers from the surface down; free ends cut it off along x.
///
/// Parameters
/// ----------
/// substrate : Elastic or nacre.RIGID
///     Material below the layers.
/// layers : sequence of Layer, optional
///     Layers from the surface down.
/// ends : tuple of float, optional
///     Coordinates x of free ends [m], the lower one first: the body is cut off there, and nothing holds
///     the end face. None, -inf or inf where it goes on. By default it goes on at both sides.
///
/// Raises
/// ------
/// ValueError
///     If the substrate is rigid and there is no layer, or there are ends; if the ends are not finite or not
///     in ascending order.
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
/// A roller of 10 mm on a raceway that goes on:
///
/// >>> roller = nacre.Roller(radius=5e-3, flat_length=8e-3, crown_radius=0.5, length=10e-3)
/// >>> counterbody = nacre.HalfSpace(steel, ends=roller.ends)
/// >>> counterbody.ends
/// (-0.005, 0.005)
/// >>> free = nacre.solve(roller, steel, counterbody, load=100.0)
/// >>> whole = nacre.solve(roller, steel, steel, load=100.0)
/// >>> bool(free.approach > whole.approach)
/// True
#[pyclass(name = "HalfSpace", module = "nacre", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub(super) struct PyHalfSpace(pub(super) HalfSpace);

impl PyHalfSpace {
    /// Half-space of a body; every body that Python makes is one.
    pub(super) fn of(body: &Body) -> Self {
        match body.half_space() {
            Some(layers) => Self(layers.clone()),
            None => unreachable!("Python makes no other bodies"),
        }
    }
}

#[pymethods]
impl PyHalfSpace {
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
        let ends = self::ends(ends)?;
        Ok(Self(HalfSpace::new(substrate, layers)?.with_ends(ends)?))
    }

    /// Material below the layers: an `Elastic`, or `nacre.RIGID`.
    #[getter]
    fn substrate<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match self.0.substrate() {
            Substrate::Elastic(material) => Ok(Bound::new(py, PyElastic(material))?.into_any()),
            Substrate::Rigid => py.import("nacre._core")?.getattr("RIGID"),
        }
    }

    /// Layers from the surface down.
    #[getter]
    fn layers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.0.layers().iter().cloned().map(PyLayer))
    }

    /// Depths of the interfaces [m], from the surface down.
    #[getter]
    fn interfaces(&self) -> Vec<f64> {
        self.0.interfaces()
    }

    /// Coordinates x of the free ends [m]; None where the body goes on.
    #[getter]
    fn ends(&self) -> (Option<f64>, Option<f64>) {
        self.0.ends().into()
    }

    pub(super) fn __repr__(&self) -> String {
        let substrate = match self.0.substrate() {
            Substrate::Elastic(material) => elastic_repr(&material),
            Substrate::Rigid => "RIGID".into(),
        };
        let layers = self.0.layers().iter().cloned().map(PyLayer);
        let layers: Vec<_> = layers.map(|layer| layer.__repr__()).collect();
        let written = |end: Option<f64>| end.map_or("None".into(), |x| format!("{x:?}"));
        let ends = match self.0.ends() {
            [None, None] => String::new(),
            [low, high] => format!(", ends=({}, {})", written(low), written(high)),
        };
        format!("HalfSpace({substrate}, layers=[{}]{ends})", layers.join(", "))
    }

    fn __hash__(&self) -> u64 {
        hash(&self.__repr__())
    }

    /// Callable and arguments that make the half-space again.
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (class, arguments) = (py.get_type::<Self>(), (self.substrate(py)?, self.layers(py)?));
        if self.0.ends() == [None; 2] {
            // Earlier versions read it.
            return Ok((class.into_any(), arguments.into_pyobject(py)?));
        }
        let keywords = PyDict::new(py);
        keywords.set_item("ends", self.ends())?;
        remade(class, arguments, keywords)
    }
}

/// Substrate from an argument.
pub(super) fn substrate(object: &Bound<'_, PyAny>) -> PyResult<Substrate> {
    if object.cast::<PyRigid>().is_ok() {
        return Ok(Substrate::Rigid);
    }
    match object.extract::<PyElastic>() {
        Ok(material) => Ok(material.0.into()),
        Err(_) => Err(PyTypeError::new_err(format!(
            "substrate must be an Elastic or nacre.RIGID, got {}",
            Repr(object)
        ))),
    }
}

/// Body from an argument: a half-space, or a material that fills one.
pub(super) fn body(object: &Bound<'_, PyAny>) -> PyResult<HalfSpace> {
    if let Ok(body) = object.extract::<PyHalfSpace>() {
        return Ok(body.0);
    }
    match object.extract::<PyElastic>() {
        Ok(material) => Ok(material.0.into()),
        Err(_) => Err(PyTypeError::new_err(format!(
            "body and counterbody must be a HalfSpace or an Elastic, got {}",
            Repr(object)
        ))),
    }
}
