//! Named state of a solution.

use pyo3::prelude::*;

use super::PySolution;
use super::report::PyReport;
use crate::contact::Solution;
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
        Ok(Solution::from_fields(arrays, approach, tilt, report.0)?.into())
    }
}
