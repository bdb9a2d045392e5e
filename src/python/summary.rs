//! `nacre.StressSummary`, `nacre.LayerStress`, `nacre.InterfaceStress`.

use pyo3::prelude::*;

use crate::stress::{InterfaceSummary, LayerSummary, Peak, StressSummary};

/// A value and where it is.
type PyPeak = (f64, (f64, f64, f64));

fn peak(peak: &Peak) -> PyPeak {
    (peak.value, peak.position.into())
}

/// Extremes of the stress in each layer and at each interface.
///
/// Printed it is a table. Values come with their places ``(x, y, z)``, which are cell centres.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> body = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(420e9, 0.3), 20e-6)])
/// >>> grid = nacre.Grid(shape=(32, 32), size=(4e-4, 4e-4))
/// >>> solution = nacre.solve(nacre.Sphere(5e-3), body, load=10.0, grid=grid)
/// >>> summary = solution.stress_summary(yield_stress={"substrate": 2e9})
/// >>> coating, substrate = summary.layers
/// >>> bool(coating.tension[0] > 0.0 and substrate.yield_margin > 1.0)
/// True
#[pyclass(name = "StressSummary", module = "nacre", frozen, eq)]
#[derive(Clone, PartialEq)]
pub(super) struct PyStressSummary(pub(super) StressSummary);

#[pymethods]
impl PyStressSummary {
    /// The layers from the surface down, and the substrate.
    #[getter]
    fn layers(&self) -> Vec<PyLayerStress> {
        self.0.layers.iter().cloned().map(PyLayerStress).collect()
    }

    /// The interfaces from the surface down.
    #[getter]
    fn interfaces(&self) -> Vec<PyInterfaceStress> {
        let interfaces = self.0.interfaces.iter();
        interfaces.cloned().map(PyInterfaceStress).collect()
    }

    /// Whether it was not stopped before all depths were done.
    #[getter]
    fn finished(&self) -> bool {
        self.0.finished
    }

    fn __str__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let display = slf.py().import("nacre._display")?;
        display.getattr("stresses")?.call1((slf,))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (SummaryState,))> {
        let layers = self.layers().iter().map(PyLayerStress::state).collect();
        let interfaces = self.interfaces();
        let interfaces = interfaces.iter().map(PyInterfaceStress::state).collect();
        let state = (layers, interfaces, self.finished());
        Ok((restorer(py, "_restore_stress_summary")?, (state,)))
    }

    fn __repr__(&self) -> String {
        format!(
            "<nacre.StressSummary of {} layers and {} interfaces>",
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
/// >>> round(value / solution.peak_pressure, 1), substrate.yield_margin
/// (0.6, None)
#[pyclass(name = "LayerStress", module = "nacre", frozen, eq)]
#[derive(Clone, PartialEq)]
pub(super) struct PyLayerStress(LayerSummary);

#[pymethods]
impl PyLayerStress {
    /// Its number, from 0 at the surface; that of the substrate is the number of layers.
    #[getter]
    fn layer(&self) -> usize {
        self.0.layer
    }

    /// Depths of its faces [m]; of the substrate, of its top and infinity.
    #[getter]
    fn depths(&self) -> (f64, f64) {
        self.0.depths.into()
    }

    /// Largest von Mises stress [Pa], and where it is [m].
    #[getter]
    fn von_mises(&self) -> PyPeak {
        peak(&self.0.von_mises)
    }

    /// Largest principal stress [Pa], tension where it is positive, and where it is [m].
    #[getter]
    fn tension(&self) -> PyPeak {
        peak(&self.0.tension)
    }

    /// Largest shear stress on any plane [Pa], and where it is [m].
    #[getter]
    fn max_shear(&self) -> PyPeak {
        peak(&self.0.shear)
    }

    /// Yield stress over the largest von Mises stress; None where no yield stress was given.
    #[getter]
    fn yield_margin(&self) -> Option<f64> {
        self.0.yield_margin
    }

    /// Strength over the largest tension; None where no strength was given, or there is no tension.
    #[getter]
    fn strength_margin(&self) -> Option<f64> {
        self.0.strength_margin
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (LayerState,))> {
        Ok((restorer(py, "_restore_layer_stress")?, (self.state(),)))
    }

    fn __repr__(&self) -> String {
        format!(
            "<nacre.LayerStress of layer {}: von Mises {:.4e} Pa, tension {:.4e} Pa>",
            self.0.layer, self.0.von_mises.value, self.0.tension.value
        )
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
#[pyclass(name = "InterfaceStress", module = "nacre", frozen, eq)]
#[derive(Clone, PartialEq)]
pub(super) struct PyInterfaceStress(InterfaceSummary);

#[pymethods]
impl PyInterfaceStress {
    /// Its number, from 0 below the first layer.
    #[getter]
    fn interface(&self) -> usize {
        self.0.interface
    }

    /// Its depth [m].
    #[getter]
    fn depth(&self) -> f64 {
        self.0.depth
    }

    /// Largest normal traction [Pa], tension where it is positive, and where it is [m].
    #[getter]
    fn tension(&self) -> PyPeak {
        peak(&self.0.tension)
    }

    /// Smallest normal traction [Pa], and where it is [m].
    #[getter]
    fn compression(&self) -> PyPeak {
        peak(&self.0.compression)
    }

    /// Largest shear traction [Pa], and where it is [m].
    #[getter]
    fn shear(&self) -> PyPeak {
        peak(&self.0.shear)
    }

    /// Largest jump of the in-plane stress [Pa], and where it is [m]; None on a rigid base.
    #[getter]
    fn jump(&self) -> Option<PyPeak> {
        self.0.jump.as_ref().map(peak)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (InterfaceState,))> {
        Ok((restorer(py, "_restore_interface_stress")?, (self.state(),)))
    }

    fn __repr__(&self) -> String {
        format!(
            "<nacre.InterfaceStress at depth {:.4e} m: shear {:.4e} Pa, tension {:.4e} Pa>",
            self.0.depth, self.0.shear.value, self.0.tension.value
        )
    }
}

type PeakState = (f64, [f64; 3]);
type LayerState = (usize, [f64; 2], [PeakState; 3], (Option<f64>, Option<f64>));
type SummaryState = (Vec<LayerState>, Vec<InterfaceState>, bool);
type InterfaceState = (usize, f64, [PeakState; 3], Option<PeakState>);

fn state(peak: &Peak) -> PeakState {
    (peak.value, peak.position)
}

fn restored((value, position): PeakState) -> Peak {
    Peak { value, position }
}

impl PyLayerStress {
    fn state(&self) -> LayerState {
        let s = &self.0;
        (
            s.layer,
            s.depths,
            [&s.von_mises, &s.tension, &s.shear].map(state),
            (s.yield_margin, s.strength_margin),
        )
    }

    fn restored((layer, depths, peaks, margins): LayerState) -> Self {
        let [von_mises, tension, shear] = peaks.map(restored);
        Self(LayerSummary {
            layer,
            depths,
            von_mises,
            tension,
            shear,
            yield_margin: margins.0,
            strength_margin: margins.1,
        })
    }
}

impl PyInterfaceStress {
    fn state(&self) -> InterfaceState {
        let s = &self.0;
        (
            s.interface,
            s.depth,
            [&s.tension, &s.compression, &s.shear].map(state),
            s.jump.as_ref().map(state),
        )
    }

    fn restored((interface, depth, peaks, jump): InterfaceState) -> Self {
        let [tension, compression, shear] = peaks.map(restored);
        Self(InterfaceSummary {
            interface,
            depth,
            tension,
            compression,
            shear,
            jump: jump.map(restored),
        })
    }
}

/// The extremes of one layer from their pickled state.
#[pyfunction(name = "_restore_layer_stress")]
pub(super) fn restore_layer_stress(state: LayerState) -> PyLayerStress {
    PyLayerStress::restored(state)
}

/// The extremes of one interface from their pickled state.
#[pyfunction(name = "_restore_interface_stress")]
pub(super) fn restore_interface_stress(state: InterfaceState) -> PyInterfaceStress {
    PyInterfaceStress::restored(state)
}

/// A summary from its pickled state.
#[pyfunction(name = "_restore_stress_summary")]
pub(super) fn restore_stress_summary(state: SummaryState) -> PyStressSummary {
    let (layers, interfaces, finished) = state;
    PyStressSummary(StressSummary {
        layers: layers
            .into_iter()
            .map(|s| PyLayerStress::restored(s).0)
            .collect(),
        interfaces: interfaces
            .into_iter()
            .map(|s| PyInterfaceStress::restored(s).0)
            .collect(),
        finished,
    })
}

/// The function of `nacre._core` that restores a pickled value.
fn restorer<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("nacre._core")?.getattr(name)
}
