//! `nacre.creep_coefficients`.

use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::compliance::response::Body;
use crate::friction::{self, CreepCoefficients};
use crate::model::body::HalfSpace;
use crate::python::arguments::{Pair, count};
use crate::python::background::{self, Caller};
use crate::python::bodies::body;
use crate::python::state::{self, Fields, Reduced, State, from_dict_docs, to_dict_docs};

/// Kalker's linear coefficients of an elliptic contact, with their estimated errors.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.25)
/// >>> creep = nacre.creep_coefficients(steel, steel, (1e-3, 1e-3))
/// >>> round(creep.c11, 1), round(creep.c22, 1), round(creep.c23, 1)
/// (4.1, 3.7, 1.5)
#[pyclass(name = "CreepCoefficients", module = "nacre.types", frozen, eq)]
#[derive(PartialEq)]
pub(in crate::python) struct PyCreepCoefficients(CreepCoefficients);

impl State for PyCreepCoefficients {
    const KIND: &'static str = "CreepCoefficients";

    fn write(&self, fields: &Fields) -> PyResult<()> {
        let found = &self.0;
        fields.set("c11", found.c11)?;
        fields.set("c22", found.c22)?;
        fields.set("c23", found.c23)?;
        fields.set("c33", found.c33)?;
        fields.set("errors", self.errors())?;
        fields.set("shear", found.shear)?;
        fields.set("semi_axes", self.semi_axes())
    }

    fn read(fields: &Fields) -> PyResult<Self> {
        Ok(Self(CreepCoefficients {
            c11: fields.get("c11")?,
            c22: fields.get("c22")?,
            c23: fields.get("c23")?,
            c33: fields.get("c33")?,
            errors: fields.get("errors")?,
            shear: fields.get("shear")?,
            semi_axes: fields.get("semi_axes")?,
        }))
    }
}

#[pymethods]
impl PyCreepCoefficients {
    /// C11, of the longitudinal creepage: ``F_x = a b G C11 xi``.
    #[getter]
    fn c11(&self) -> f64 {
        self.0.c11
    }

    /// C22, of the lateral creepage: ``F_y = a b G C22 eta``.
    #[getter]
    fn c22(&self) -> f64 {
        self.0.c22
    }

    /// C23, of the spin in the lateral force: ``F_y = (a b)**1.5 G C23 phi``.
    #[getter]
    fn c23(&self) -> f64 {
        self.0.c23
    }

    /// C33, of the spin in the torque: ``M_z = (a b)**2 G C33 phi``.
    #[getter]
    fn c33(&self) -> f64 {
        self.0.c33
    }

    /// Estimated errors of C11, C22, C23 and C33.
    #[getter]
    fn errors(&self) -> (f64, f64, f64, f64) {
        self.0.errors.into()
    }

    /// Modulus G [Pa]: 1/G is the mean of 1/G of both substrates.
    #[getter]
    fn shear(&self) -> f64 {
        self.0.shear
    }

    /// Semi-axes ``(a, b)`` [m], a along the direction of rolling.
    #[getter]
    fn semi_axes(&self) -> (f64, f64) {
        self.0.semi_axes.into()
    }

    fn __repr__(&self) -> String {
        let CreepCoefficients { c11, c22, c23, c33, errors, .. } = self.0;
        format!(
            "<CreepCoefficients: C11 {c11:.4} ± {:.4}, C22 {c22:.4} ± {:.4}, C23 {c23:.4} ± {:.4}, C33 {c33:.4} ± {:.4}>",
            errors[0], errors[1], errors[2], errors[3]
        )
    }

    #[doc = to_dict_docs!()]
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.25)
    /// >>> creep = nacre.creep_coefficients(steel, steel, (1e-3, 2e-3), cells=16)
    /// >>> creep.to_dict()["semi_axes"]
    /// (0.001, 0.002)
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        state::to_dict(py, self)
    }

    #[doc = from_dict_docs!()]
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.25)
    /// >>> creep = nacre.creep_coefficients(steel, steel, (1e-3, 2e-3), cells=16)
    /// >>> nacre.types.CreepCoefficients.from_dict(creep.to_dict()) == creep
    /// True
    #[staticmethod]
    fn from_dict(data: &Bound<'_, PyAny>) -> PyResult<Self> {
        state::from_dict(data)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        state::reduce(py, self)
    }
}

fn cells(given: &Bound<'_, PyAny>) -> PyResult<usize> {
    count("cells", 8, given)
}

/// Kalker's linear coefficients of two bodies with any layers, by one call.
///
/// Parameters
/// ----------
/// body, counterbody : HalfSpace, Elastic or None
///     Bodies; a counterbody that is `None` is rigid.
/// semi_axes : tuple of float
///     Semi-axes ``(a, b)`` of the contact [m], a along the direction of rolling.
/// cells : int, optional
///     Cells along each axis of the ellipse, at least 8. The coefficients are extrapolated from these and from half
///     as many.
///
/// Returns
/// -------
/// CreepCoefficients
///     C11, C22, C23 and C33, as Kalker (1990) defines them; those of coated bodies are nacre's own.
///
/// Raises
/// ------
/// ValueError
///     If a semi-axis is not above 0, there are fewer cells, both substrates are rigid, or a body has no response
///     along its surface.
/// ConvergenceError
///     If the iteration did not converge.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.25)
/// >>> rubber = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(50e9, 0.25), 0.5e-3)])
/// >>> coated = nacre.creep_coefficients(rubber, rubber, (1e-3, 1e-3))
/// >>> coated.c11 < 0.5 * nacre.creep_coefficients(steel, steel, (1e-3, 1e-3)).c11
/// True
#[pyfunction]
#[pyo3(signature = (body, counterbody, semi_axes, *, cells=64))]
pub(in crate::python) fn creep_coefficients(
    py: Python<'_>,
    #[pyo3(from_py_with = body)] body: HalfSpace,
    counterbody: Option<&Bound<'_, PyAny>>,
    semi_axes: Pair,
    #[pyo3(from_py_with = cells)] cells: usize,
) -> PyResult<PyCreepCoefficients> {
    let counterbody = counterbody.map(crate::python::bodies::body).transpose()?.map(Body::from);
    let Pair(axes) = semi_axes;
    let found = background::run(py, None, move |caller: &mut Caller<()>| {
        let mut watch = || caller.ask(|| ());
        friction::creep_coefficients(body, counterbody, axes, Some(cells), Some(&mut watch))
    })??;
    Ok(PyCreepCoefficients(found))
}
