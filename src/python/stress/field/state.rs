//! Named state of `nacre.Stress`.

use std::sync::Arc;

use ndarray::Array3;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::{AXES, COMPONENTS, DISPLACEMENTS, PyStress};
use crate::python::bodies::PyHalfSpace;
use crate::python::state::{Fields, State};
use crate::python::words::Word;
use crate::stress::Stress;

/// Named state; its arrays have all three axes, and "axes" lists those that fields have.
impl State for PyStress {
    const KIND: &'static str = "Stress";

    fn write(&self, fields: &Fields) -> PyResult<()> {
        let stress = &self.stress;
        let kept = AXES.iter().zip(self.dropped);
        fields.set_array("z", &stress.z)?;
        fields.set_array("x", &stress.x)?;
        fields.set_array("y", &stress.y)?;
        let kept: Vec<_> = kept.filter(|(_, dropped)| !dropped).map(|(axis, _)| *axis).collect();
        fields.set("axes", kept)?;
        fields.set_part("body", self.body())?;
        fields.set("side", stress.side.word())?;
        fields.set("friction", stress.friction)?;
        match &stress.uncertainty {
            None => fields.set("uncertainty", None::<f64>)?,
            Some(errors) => fields.set_array("uncertainty", errors)?,
        }
        fields.set_fields("components", |fields| {
            write_arrays(fields, &COMPONENTS, &stress.components)
        })?;
        match &stress.displacement {
            None => fields.set("displacement", None::<f64>),
            Some(displacement) => fields.set_fields("displacement", |fields| {
                write_arrays(fields, &DISPLACEMENTS, displacement)
            }),
        }
    }

    fn read(fields: &Fields) -> PyResult<Self> {
        let axes: Vec<String> = fields.get("axes")?;
        let body: PyHalfSpace = fields.get_part("body")?;
        let side: String = fields.get("side")?;
        let displacement = match fields.get_optional("displacement")? {
            None => None,
            Some(fields) => Some(fields.read(|fields| read_arrays(fields, DISPLACEMENTS))?),
        };
        let stress = Stress::from_fields(
            [fields.get_array("z")?, fields.get_array("x")?, fields.get_array("y")?],
            body.0,
            Word::from_word(&side)?,
            fields.get("friction")?,
            fields.get_fields("components")?.read(|fields| read_arrays(fields, COMPONENTS))?,
            displacement,
            fields.get_newer_array("uncertainty")?,
        )?;
        if let Some(other) = axes.iter().find(|axis| !AXES.contains(&axis.as_str())) {
            return Err(PyValueError::new_err(format!(
                "axes must be among {AXES:?}, got {other:?}"
            )));
        }
        let dropped = AXES.map(|axis| !axes.iter().any(|kept| kept == axis));
        let lengths = [stress.z.len(), stress.x.len(), stress.y.len()];
        if dropped.iter().zip(lengths).any(|(&dropped, n)| dropped && n != 1) {
            return Err(PyValueError::new_err(format!(
                "axes must name each axis with more or less than one coordinate, got {axes:?}"
            )));
        }
        Ok(Self { stress: Arc::new(stress), dropped })
    }
}

fn write_arrays(fields: &Fields, names: &[&str], arrays: &[Array3<f64>]) -> PyResult<()> {
    let mut named = names.iter().zip(arrays);
    named.try_for_each(|(name, array)| fields.set_array(name, array))
}

fn read_arrays<const N: usize>(fields: &Fields, names: [&str; N]) -> PyResult<[Array3<f64>; N]> {
    let mut arrays = [(); N].map(|()| Array3::default((0, 0, 0)));
    for (name, array) in names.into_iter().zip(&mut arrays) {
        *array = fields.get_array(name)?;
    }
    Ok(arrays)
}
