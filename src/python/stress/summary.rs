//! `nacre.StressSummary`, `nacre.LayerStress`, `nacre.InterfaceStress`.

use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::python::state::{self as named, Fields, Reduced, State, from_dict_docs, to_dict_docs};
use crate::stress::{InterfaceSummary, LayerSummary, Peak, StressSummary};

/// Value, and point (x, y, z) where it occurs.
type PyPeak = (f64, (f64, f64, f64));

fn peak(peak: &Peak) -> PyPeak {
    (peak.value, peak.position.into())
}

/// Printed form of a result, in the units that are set.
fn displayed<'py>(result: &Bound<'py, impl PyClass>, form: &str) -> PyResult<Bound<'py, PyAny>> {
    let display = result.py().import("nacre._display")?;
    display.getattr(form)?.call1((result,))
}

/// Extremes of the stress in each layer and at each interface.
///
/// Printing it shows a table, and so does a notebook. Each value comes with its point ``(x, y, z)``, which is a cell centre.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> body = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(420e9, 0.3), 20e-6)])
/// >>> grid = nacre.Grid(shape=(32, 32), size=(4e-4, 4e-4))
/// >>> solution = nacre.solve(nacre.Sphere(5e-3), body, load=10.0, grid=grid)
/// >>> summary = solution.stress_summary(yield_stress={"substrate": 2e9})
/// >>> coating, substrate = summary.layers
/// >>> bool(coating.tension[0] > 0.0 and substrate.yield_safety_factor > 1.0)
/// True
#[pyclass(name = "StressSummary", module = "nacre.types", frozen, eq)]
#[derive(Clone, PartialEq)]
pub(in crate::python) struct PyStressSummary(pub(in crate::python) StressSummary);

#[pymethods]
impl PyStressSummary {
    /// Extremes in the layers from the surface down, and in the substrate.
    #[getter]
    fn layers(&self) -> Vec<PyLayerStress> {
        self.0.layers.iter().cloned().map(PyLayerStress).collect()
    }

    /// Extremes at the interfaces from the surface down.
    #[getter]
    fn interfaces(&self) -> Vec<PyInterfaceStress> {
        let interfaces = self.0.interfaces.iter();
        interfaces.cloned().map(PyInterfaceStress).collect()
    }

    /// Whether all depths were evaluated; False where a callback stopped the evaluation.
    #[getter]
    fn finished(&self) -> bool {
        self.0.finished
    }

    /// Warnings about extremes that the cells do not resolve, each also issued as `nacre.NacreWarning`.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.0.warnings()
    }

    fn __str__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        displayed(slf, "stresses")
    }

    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        displayed(slf, "stresses_markup")
    }

    #[doc = to_dict_docs!()]
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> grid = nacre.Grid(shape=(32, 32), size=(4e-4, 4e-4))
    /// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0, grid=grid)
    /// >>> summary = solution.stress_summary()
    /// >>> summary.to_dict()["finished"]
    /// True
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        named::to_dict(py, self)
    }

    #[doc = from_dict_docs!()]
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> grid = nacre.Grid(shape=(32, 32), size=(4e-4, 4e-4))
    /// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0, grid=grid)
    /// >>> summary = solution.stress_summary()
    /// >>> nacre.types.StressSummary.from_dict(summary.to_dict()) == summary
    /// True
    #[staticmethod]
    fn from_dict(data: &Bound<'_, PyAny>) -> PyResult<Self> {
        named::from_dict(data)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        named::reduce(py, self)
    }

    fn __repr__(&self) -> String {
        format!(
            "<StressSummary of {} layers and {} interfaces>",
            self.0.layers.len(),
            self.0.interfaces.len()
        )
    }
}

/// Extremes of the stress in one layer, or in the substrate.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> grid = nacre.Grid(shape=(32, 32), size=(4e-4, 4e-4))
/// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0, grid=grid)
/// >>> (substrate,) = solution.stress_summary().layers
/// >>> value, (x, y, z) = substrate.von_mises
/// >>> round(value / solution.peak_pressure, 1), substrate.yield_safety_factor
/// (0.6, None)
#[pyclass(name = "LayerStress", module = "nacre.types", frozen, eq)]
#[derive(Clone, PartialEq)]
pub(in crate::python) struct PyLayerStress(LayerSummary);

#[pymethods]
impl PyLayerStress {
    /// Number of the layer, from 0 at the surface; the substrate comes after the last layer.
    #[getter]
    fn layer(&self) -> usize {
        self.0.layer
    }

    /// Name of the layer; None where it has none.
    #[getter]
    fn name(&self) -> Option<&str> {
        self.0.name.as_deref()
    }

    /// Depths of the two faces [m]; the lower one is infinite for the substrate.
    #[getter]
    fn depths(&self) -> (f64, f64) {
        self.0.depths.into()
    }

    /// Largest von Mises stress [Pa], and its point [m].
    #[getter]
    fn von_mises(&self) -> PyPeak {
        peak(&self.0.von_mises)
    }

    /// Largest principal stress [Pa], tension where it is positive, and its point [m].
    #[getter]
    fn tension(&self) -> PyPeak {
        peak(&self.0.tension)
    }

    /// Largest shear stress on any plane [Pa], and its point [m].
    #[getter]
    fn max_shear(&self) -> PyPeak {
        peak(&self.0.shear)
    }

    /// Estimated errors of the values [Pa], by name, due to the size of the cells; see `Stress.uncertainty`.
    ///
    /// Where one is not small compared with its value, the cells do not resolve it: take smaller cells.
    #[getter]
    fn uncertainty<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let layer = &self.0;
        let peaks = [
            ("von_mises", Some(&layer.von_mises)),
            ("tension", Some(&layer.tension)),
            ("max_shear", Some(&layer.shear)),
        ];
        uncertainties(py, peaks)
    }

    /// Yield stress divided by the largest von Mises stress; None where no yield stress was given.
    #[getter]
    fn yield_safety_factor(&self) -> Option<f64> {
        self.0.yield_safety_factor
    }

    /// Strength divided by the largest tension; None without a strength, or without tension.
    #[getter]
    fn strength_safety_factor(&self) -> Option<f64> {
        self.0.strength_safety_factor
    }

    #[doc = to_dict_docs!()]
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> grid = nacre.Grid(shape=(32, 32), size=(4e-4, 4e-4))
    /// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0, grid=grid)
    /// >>> (layer,) = solution.stress_summary().layers
    /// >>> layer.to_dict()["layer"]
    /// 0
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        named::to_dict(py, self)
    }

    #[doc = from_dict_docs!()]
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> grid = nacre.Grid(shape=(32, 32), size=(4e-4, 4e-4))
    /// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0, grid=grid)
    /// >>> (layer,) = solution.stress_summary().layers
    /// >>> nacre.types.LayerStress.from_dict(layer.to_dict()) == layer
    /// True
    #[staticmethod]
    fn from_dict(data: &Bound<'_, PyAny>) -> PyResult<Self> {
        named::from_dict(data)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        named::reduce(py, self)
    }

    fn __repr__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        displayed(slf, "layer_line")
    }
}

/// Extremes of the tractions at one interface.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> body = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(420e9, 0.3), 20e-6)])
/// >>> grid = nacre.Grid(shape=(32, 32), size=(4e-4, 4e-4))
/// >>> solution = nacre.solve(nacre.Sphere(5e-3), body, load=10.0, grid=grid)
/// >>> (interface,) = solution.stress_summary().interfaces
/// >>> interface.depth, bool(interface.shear[0] > 0.0)
/// (2e-05, True)
#[pyclass(name = "InterfaceStress", module = "nacre.types", frozen, eq)]
#[derive(Clone, PartialEq)]
pub(in crate::python) struct PyInterfaceStress(InterfaceSummary);

#[pymethods]
impl PyInterfaceStress {
    /// Number of the interface, from 0 below the first layer.
    #[getter]
    fn interface(&self) -> usize {
        self.0.interface
    }

    /// Depth of the interface [m].
    #[getter]
    fn depth(&self) -> f64 {
        self.0.depth
    }

    /// Largest normal traction [Pa], tension where it is positive, and its point [m].
    #[getter]
    fn tension(&self) -> PyPeak {
        peak(&self.0.tension)
    }

    /// Smallest normal traction [Pa], and its point [m].
    #[getter]
    fn compression(&self) -> PyPeak {
        peak(&self.0.compression)
    }

    /// Largest shear traction [Pa], and its point [m].
    #[getter]
    fn shear(&self) -> PyPeak {
        peak(&self.0.shear)
    }

    /// Estimated errors of the values [Pa], by name, due to the size of the cells; see `Stress.uncertainty`.
    ///
    /// Where one is not small compared with its value, the cells do not resolve it: take smaller cells.
    #[getter]
    fn uncertainty<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let interface = &self.0;
        let peaks = [
            ("tension", Some(&interface.tension)),
            ("compression", Some(&interface.compression)),
            ("shear", Some(&interface.shear)),
            ("jump", interface.jump.as_ref()),
        ];
        uncertainties(py, peaks)
    }

    /// Largest jump of the in-plane stress [Pa], and its point [m]; None on a rigid base.
    #[getter]
    fn jump(&self) -> Option<PyPeak> {
        self.0.jump.as_ref().map(peak)
    }

    #[doc = to_dict_docs!()]
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> body = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(420e9, 0.3), 20e-6)])
    /// >>> grid = nacre.Grid(shape=(32, 32), size=(4e-4, 4e-4))
    /// >>> solution = nacre.solve(nacre.Sphere(5e-3), body, load=10.0, grid=grid)
    /// >>> (interface,) = solution.stress_summary().interfaces
    /// >>> interface.to_dict()["depth"]
    /// 2e-05
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        named::to_dict(py, self)
    }

    #[doc = from_dict_docs!()]
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> body = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(420e9, 0.3), 20e-6)])
    /// >>> grid = nacre.Grid(shape=(32, 32), size=(4e-4, 4e-4))
    /// >>> solution = nacre.solve(nacre.Sphere(5e-3), body, load=10.0, grid=grid)
    /// >>> (interface,) = solution.stress_summary().interfaces
    /// >>> nacre.types.InterfaceStress.from_dict(interface.to_dict()) == interface
    /// True
    #[staticmethod]
    fn from_dict(data: &Bound<'_, PyAny>) -> PyResult<Self> {
        named::from_dict(data)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        named::reduce(py, self)
    }

    fn __repr__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        displayed(slf, "interface_line")
    }
}

/// Estimated errors of peaks, by name, as far as they are known.
fn uncertainties<'py, const N: usize>(
    py: Python<'py>,
    peaks: [(&str, Option<&Peak>); N],
) -> PyResult<Bound<'py, PyDict>> {
    let known = PyDict::new(py);
    for (name, peak) in peaks {
        if let Some(error) = peak.and_then(|peak| peak.uncertainty) {
            known.set_item(name, error)?;
        }
    }
    Ok(known)
}

fn write_peak(fields: &Fields, name: &str, peak: &Peak) -> PyResult<()> {
    fields.set_fields(name, |fields| {
        fields.set("value", peak.value)?;
        fields.set("at", peak.position)?;
        fields.set("uncertainty", peak.uncertainty)
    })
}

fn read_peak(fields: &Fields) -> PyResult<Peak> {
    fields.read(|fields| {
        Ok(Peak {
            value: fields.get("value")?,
            position: fields.get("at")?,
            uncertainty: fields.get_newer::<Option<f64>>("uncertainty")?.flatten(),
        })
    })
}

impl State for PyStressSummary {
    const KIND: &'static str = "StressSummary";

    fn write(&self, fields: &Fields) -> PyResult<()> {
        fields.set_list("layers", &self.layers(), State::write)?;
        fields.set_list("interfaces", &self.interfaces(), State::write)?;
        fields.set("finished", self.0.finished)
    }

    fn read(fields: &Fields) -> PyResult<Self> {
        Ok(Self(StressSummary {
            layers: fields.get_list("layers", |fields| Ok(PyLayerStress::read(fields)?.0))?,
            interfaces: fields
                .get_list("interfaces", |fields| Ok(PyInterfaceStress::read(fields)?.0))?,
            finished: fields.get("finished")?,
        }))
    }
}

impl State for PyLayerStress {
    const KIND: &'static str = "LayerStress";

    fn write(&self, fields: &Fields) -> PyResult<()> {
        let layer = &self.0;
        fields.set("layer", layer.layer)?;
        fields.set("name", &layer.name)?;
        fields.set("depths", layer.depths)?;
        write_peak(fields, "von_mises", &layer.von_mises)?;
        write_peak(fields, "tension", &layer.tension)?;
        write_peak(fields, "max_shear", &layer.shear)?;
        fields.set("yield_safety_factor", layer.yield_safety_factor)?;
        fields.set("strength_safety_factor", layer.strength_safety_factor)
    }

    fn read(fields: &Fields) -> PyResult<Self> {
        Ok(Self(LayerSummary {
            layer: fields.get("layer")?,
            name: fields.get("name")?,
            depths: fields.get("depths")?,
            von_mises: read_peak(&fields.get_fields("von_mises")?)?,
            tension: read_peak(&fields.get_fields("tension")?)?,
            shear: read_peak(&fields.get_fields("max_shear")?)?,
            yield_safety_factor: fields.get("yield_safety_factor")?,
            strength_safety_factor: fields.get("strength_safety_factor")?,
        }))
    }
}

impl State for PyInterfaceStress {
    const KIND: &'static str = "InterfaceStress";

    fn write(&self, fields: &Fields) -> PyResult<()> {
        let interface = &self.0;
        fields.set("interface", interface.interface)?;
        fields.set("depth", interface.depth)?;
        write_peak(fields, "tension", &interface.tension)?;
        write_peak(fields, "compression", &interface.compression)?;
        write_peak(fields, "shear", &interface.shear)?;
        match &interface.jump {
            None => fields.set("jump", None::<f64>),
            Some(jump) => write_peak(fields, "jump", jump),
        }
    }

    fn read(fields: &Fields) -> PyResult<Self> {
        let jump = fields.get_optional("jump")?;
        Ok(Self(InterfaceSummary {
            interface: fields.get("interface")?,
            depth: fields.get("depth")?,
            tension: read_peak(&fields.get_fields("tension")?)?,
            compression: read_peak(&fields.get_fields("compression")?)?,
            shear: read_peak(&fields.get_fields("shear")?)?,
            jump: jump.as_ref().map(read_peak).transpose()?,
        }))
    }
}
