//! Named state of a solution.

use ndarray::IxDyn;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::PySolution;
use super::report::PyReport;
use crate::contact::{Hardness, Solution};
use crate::python::state::{Fields, State};

impl State for PySolution {
    const KIND: &'static str = "Solution";

    fn write(&self, fields: &Fields) -> PyResult<()> {
        let solution = &self.solution;
        fields.set_array("pressure", &solution.pressure)?;
        fields.set_array("gap", &solution.gap())?;
        fields.set_array("displacement", &solution.displacement)?;
        fields.set("approach", solution.approach)?;
        fields.set("tilt", solution.tilt)?;
        // Left out where the surfaces do not yield, as in states of earlier versions.
        match &solution.hardness {
            None => {}
            Some(Hardness::Uniform(value)) => fields.set("hardness", value)?,
            Some(Hardness::Cells(values)) => fields.set_array("hardness", values)?,
        }
        if let Some(indentation) = &solution.indentation {
            fields.set_array("indentation", indentation)?;
        }
        if let Some(coefficients) = &solution.coefficients {
            fields.set_array("coefficients", &coefficients.to_owned())?;
        }
        fields.set_fields("report", |report| self.report().write(report))
    }

    fn read(fields: &Fields) -> PyResult<Self> {
        let arrays = [
            fields.get_array("pressure")?,
            fields.get_array("gap")?,
            fields.get_array("displacement")?,
        ];
        let (approach, tilt) = (fields.get("approach")?, fields.get("tilt")?);
        let report = fields.get_fields("report")?.read(PyReport::read)?;
        let hardness = fields.get_newer_array::<IxDyn>("hardness")?;
        let hardness = hardness.map(|values| match values.ndim() {
            0 => Ok(Hardness::Uniform(values.sum())),
            _ => values.into_dimensionality().map(Hardness::Cells),
        });
        let hardness = hardness
            .transpose()
            .map_err(|error| PyValueError::new_err(format!("hardness: {error}")))?;
        let indentation = fields.get_newer_array("indentation")?;
        let mut solution = Solution::from_fields(arrays, approach, tilt, report.0)?;
        if let Some(coefficients) = fields.get_newer_array("coefficients")? {
            solution = solution.with_coefficients(coefficients)?;
        }
        Ok(solution.yielding(hardness, indentation)?.into())
    }
}
