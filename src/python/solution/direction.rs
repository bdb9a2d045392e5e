//! `nacre.Direction`: the change of a solved contact along a direction of parameters.

use ndarray::Array2;
use numpy::PyArray2;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use super::linear::{Linear, Made};
use crate::gradient::Direction;
use crate::python::arguments::{read_only, real_matrix};

/// Change of a solved contact along a direction of parameters; `Solution.jvp` makes it.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
/// >>> change = solution.jvp({"load": 1.0})
/// >>> round(change.approach * 10.0 / solution.approach, 2)
/// 0.67
#[pyclass(name = "Direction", module = "nacre.types", frozen)]
pub(in crate::python) struct PyDirection {
    direction: Direction,
    made: Made,
}

#[pymethods]
impl PyDirection {
    /// Change of the pressure ``(nx, ny)``; 0 outside the contact.
    #[getter]
    fn pressure<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let pressure: Array2<f64> = self.direction.pressure.clone();
        read_only(py, pressure)
    }

    /// Change of the approach.
    #[getter]
    fn approach(&self) -> f64 {
        self.direction.approach
    }

    /// Change of the tilts.
    #[getter]
    fn tilt(&self) -> (f64, f64) {
        self.direction.tilt.into()
    }

    /// Largest step along the direction, of either sign, for which the contact keeps its cells to first order.
    #[getter]
    fn valid_step(&self) -> f64 {
        self.direction.valid_step
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.direction == other.direction
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        self.made.reduced(py)
    }

    fn __repr__(&self) -> String {
        format!(
            "Direction(approach={:.6e}, tilt=({:.6e}, {:.6e}), valid_step={:.3e})",
            self.direction.approach,
            self.direction.tilt[0],
            self.direction.tilt[1],
            self.direction.valid_step
        )
    }
}

impl Linear {
    /// Change of the solution along `directions`, a mapping of paths to rates, and along a rate of the gap.
    pub(super) fn jvp(
        &self,
        py: Python<'_>,
        directions: Option<&Bound<'_, PyAny>>,
        gap: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PyDirection> {
        let mut rates: Vec<(String, f64)> = Vec::new();
        if let Some(given) = directions {
            let given = given.cast::<PyDict>().map_err(|_| {
                PyTypeError::new_err("directions must be a dict of paths and their rates")
            })?;
            for (path, rate) in given {
                rates.push((path.extract()?, rate.extract()?));
            }
        }
        let arguments = (directions, gap).into_pyobject(py)?;
        let gap = gap.map(|gap| real_matrix("gap", gap)).transpose()?;
        let found = self.run(py, move |plan| {
            let rates: Vec<(&str, f64)> =
                rates.iter().map(|(path, rate)| (path.as_str(), *rate)).collect();
            plan.jvp(&rates, gap.as_deref())
        })?;
        Ok(PyDirection { direction: found, made: self.made(py, "jvp", arguments)? })
    }
}
