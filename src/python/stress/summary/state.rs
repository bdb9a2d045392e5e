//! Named state of `nacre.StressSummary`, `nacre.LayerStress` and `nacre.InterfaceStress`.

use pyo3::prelude::*;

use super::{PyInterfaceStress, PyLayerStress, PyStressSummary};
use crate::python::state::{Fields, State};
use crate::stress::{InterfaceSummary, LayerSummary, Peak, StressSummary};

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
