//! Fields of `nacre.types.Stress`: from the crate, and from Python where they are checked.

use ndarray::{Array1, Array3, Dimension};
use numpy::PyArray3;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::python::arguments::{read_only, real_array, word};
use crate::python::bodies::PyHalfSpace;
use crate::python::data::Plain;
use crate::stress::Stress;

/// Names of the components, in the order of [`Stress`].
const COMPONENTS: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

/// Names of the displacements, in their order.
const DISPLACEMENTS: [&str; 3] = ["ux", "uy", "uz"];

/// Names of the axes of a field, in their order.
const AXES: [&str; 3] = ["z", "x", "y"];

/// Fields of a stress by their names. Arrays have all three axes; `is_number` says along which axes the
/// coordinate was a number: such an axis has length 1 and is left out of "axes".
pub(super) fn fields(
    py: Python<'_>,
    stress: Stress,
    is_number: [bool; 3],
) -> PyResult<Bound<'_, PyDict>> {
    let warnings = stress.warnings();
    let Stress { z, x, y, body, side, friction, components, uncertainty, displacement } = stress;
    let lengths = [z.len(), x.len(), y.len()];
    let kept = (0..3).filter(|&axis| !is_number[axis] || lengths[axis] != 1);
    let fields = PyDict::new(py);
    fields.set_item("z", read_only(py, z)?)?;
    fields.set_item("x", read_only(py, x)?)?;
    fields.set_item("y", read_only(py, y)?)?;
    fields.set_item("axes", PyTuple::new(py, kept.map(|axis| AXES[axis]).collect::<Vec<_>>())?)?;
    fields.set_item("body", PyHalfSpace(body))?;
    fields.set_item("side", Plain(side))?;
    fields.set_item("friction", (friction[0], friction[1]))?;
    fields.set_item("uncertainty", uncertainty.map(|errors| read_only(py, errors)).transpose()?)?;
    fields.set_item("components", by_name(py, COMPONENTS, components)?)?;
    let displacement = displacement.map(|parts| by_name(py, DISPLACEMENTS, parts)).transpose()?;
    fields.set_item("displacement", displacement)?;
    fields.set_item("warnings", warnings)?;
    Ok(fields)
}

fn by_name<'py, const N: usize>(
    py: Python<'py>,
    names: [&str; N],
    arrays: [Array3<f64>; N],
) -> PyResult<Bound<'py, PyDict>> {
    let named = PyDict::new(py);
    for (name, array) in names.into_iter().zip(arrays) {
        named.set_item(name, read_only(py, array)?)?;
    }
    Ok(named)
}

/// Fields of `nacre.types.Stress`, as they come from Python.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(in crate::python) struct StressState<'py> {
    z: Bound<'py, PyAny>,
    x: Bound<'py, PyAny>,
    y: Bound<'py, PyAny>,
    axes: Vec<String>,
    body: PyHalfSpace,
    side: String,
    friction: [f64; 2],
    uncertainty: Option<Bound<'py, PyAny>>,
    components: Bound<'py, PyDict>,
    displacement: Option<Bound<'py, PyDict>>,
}

impl StressState<'_> {
    /// The stress, and which of its axes had their coordinate given as a number.
    fn stress(self) -> PyResult<(Stress, [bool; 3])> {
        let line = |name: &str, field| array::<ndarray::Ix1>(name, field);
        let coordinates: [Array1<f64>; 3] =
            [line("z", &self.z)?, line("x", &self.x)?, line("y", &self.y)?];
        if let Some(other) = self.axes.iter().find(|axis| !AXES.contains(&axis.as_str())) {
            return Err(PyValueError::new_err(format!(
                "axes must be among {AXES:?}, got {other:?}"
            )));
        }
        let is_number = AXES.map(|axis| !self.axes.iter().any(|kept| kept == axis));
        if is_number.iter().zip(&coordinates).any(|(&number, axis)| number && axis.len() != 1) {
            return Err(PyValueError::new_err(format!(
                "axes must name each axis with more or less than one coordinate, got {:?}",
                self.axes
            )));
        }
        let displacement = self.displacement.as_ref();
        let uncertainty = self.uncertainty.as_ref();
        let stress = Stress::from_fields(
            coordinates,
            self.body.0,
            word("side", &self.side)?,
            self.friction,
            arrays("components", &self.components, COMPONENTS)?,
            displacement
                .map(|displacement| arrays("displacement", displacement, DISPLACEMENTS))
                .transpose()?,
            uncertainty.map(|errors| line("uncertainty", errors)).transpose()?,
        )?;
        Ok((stress, is_number))
    }
}

/// Array of a number of dimensions.
fn array<D: Dimension>(name: &str, field: &Bound<'_, PyAny>) -> PyResult<ndarray::Array<f64, D>> {
    let array = real_array(name, field)?;
    let shape = array.shape().to_vec();
    array.into_dimensionality().map_err(|_| {
        PyValueError::new_err(format!("{name} has the wrong number of dimensions: shape {shape:?}"))
    })
}

fn arrays<const N: usize>(
    whole: &str,
    fields: &Bound<'_, PyDict>,
    names: [&str; N],
) -> PyResult<[Array3<f64>; N]> {
    let wrong = || PyValueError::new_err(format!("{whole} must have the keys {names:?}"));
    let mut arrays = [(); N].map(|()| Array3::default((0, 0, 0)));
    for (name, component) in names.into_iter().zip(&mut arrays) {
        *component = array(name, &fields.get_item(name)?.ok_or_else(wrong)?)?;
    }
    if fields.len() == N { Ok(arrays) } else { Err(wrong()) }
}

/// Fields of a stress, checked.
#[pyfunction]
pub(in crate::python) fn checked_stress<'py>(
    py: Python<'py>,
    stress: StressState<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let (stress, is_number) = stress.stress()?;
    fields(py, stress, is_number)
}

/// An invariant of a stress, by its name in Python; three arrays where it has three values.
#[pyfunction]
pub(in crate::python) fn stress_invariants<'py>(
    py: Python<'py>,
    stress: StressState<'py>,
    name: &str,
) -> PyResult<Vec<Bound<'py, PyArray3<f64>>>> {
    let (stress, _) = stress.stress()?;
    let fields = py.detach(|| match name {
        "von_mises" => vec![stress.von_mises()],
        "tresca" => vec![stress.tresca()],
        "max_shear" => vec![stress.max_shear()],
        _ => stress.principal().into(),
    });
    fields.into_iter().map(|field| read_only(py, field)).collect()
}
