//! `nacre.Stress`.

use std::sync::Arc;

use ndarray::{Array3, ArrayD, Axis};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::exceptions::{PyAttributeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::Error;
use crate::python::arguments::read_only;
use crate::python::bodies::PyHalfSpace;
use crate::python::state::{self as named, Fields, Reduced, State, from_dict_docs, to_dict_docs};
use crate::python::words::Word;
use crate::stress::Stress;

/// Names of the components, in the order of [`Stress`].
const COMPONENTS: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

/// Names of the displacements, in their order.
const DISPLACEMENTS: [&str; 3] = ["ux", "uy", "uz"];

/// Names of the axes of a field, in their order.
const AXES: [&str; 3] = ["z", "x", "y"];

/// Stress below the surface, and displacement where it was asked for.
///
/// A field has an axis for depth, x and y unless that one was given as a number: ``(nz, nx, ny)`` for
/// several depths, ``(nx, ny)`` at one depth, ``(nz, nx)`` on the section ``y = const``. Tension is
/// positive; at the surface ``zz`` is minus the pressure. Beyond a free end of the body there is no material: fields are
/// NaN.
///
/// Examples
/// --------
/// Below a sphere the largest shear is 0.31 of the peak pressure, at 0.48 contact radii:
///
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
/// >>> radius = (0.75 * 10.0 * 5e-3 / steel.plane_strain_modulus) ** (1 / 3)
/// >>> field = solution.stress(np.linspace(0.3, 0.7, 9) * radius, y=0.0)
/// >>> value, (x, y, z) = field.peak("max_shear")
/// >>> round(value / solution.peak_pressure, 2), round(z / radius, 1)
/// (0.31, 0.5)
#[pyclass(name = "Stress", module = "nacre.types", frozen)]
pub(in crate::python) struct PyStress {
    stress: Arc<Stress>,
    /// Whether depth, x and y were given as numbers; fields have no axis for those.
    dropped: [bool; 3],
}

impl PyStress {
    /// Stress without an axis for a single depth, and for x and y where they were numbers.
    pub(in crate::python) fn new(stress: Stress, one_depth: bool, [x, y]: [bool; 2]) -> Self {
        Self { stress: Arc::new(stress), dropped: [one_depth, x, y] }
    }

    fn shaped<'py>(
        &self,
        py: Python<'py>,
        field: Array3<f64>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let mut field: ArrayD<f64> = field.into_dyn();
        for axis in (0..3).rev() {
            if self.dropped[axis] && field.len_of(Axis(axis)) == 1 {
                field = field.index_axis_move(Axis(axis), 0);
            }
        }
        read_only(py, field)
    }

    fn component<'py>(&self, py: Python<'py>, k: usize) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.shaped(py, self.stress.components[k].clone())
    }

    fn displacement<'py>(
        &self,
        py: Python<'py>,
        k: usize,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        match &self.stress.displacement {
            Some(displacement) => self.shaped(py, displacement[k].clone()),
            None => Err(PyAttributeError::new_err(
                "displacements were not evaluated: ask for them with displacement=True",
            )),
        }
    }
}

#[pymethods]
impl PyStress {
    /// Depths ``(nz,)`` [m].
    #[getter]
    fn z<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        read_only(py, self.stress.z.clone())
    }

    /// Coordinates along x ``(nx,)`` [m].
    #[getter]
    fn x<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        read_only(py, self.stress.x.clone())
    }

    /// Coordinates along y ``(ny,)`` [m].
    #[getter]
    fn y<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        read_only(py, self.stress.y.clone())
    }

    /// Body in which the stress is.
    #[getter]
    fn body(&self) -> PyHalfSpace {
        PyHalfSpace(self.stress.body.clone())
    }

    /// Side of an interface, for depths that lie on one: "above" or "below".
    #[getter]
    fn side(&self) -> &'static str {
        self.stress.side.word()
    }

    /// Traction divided by pressure, ``(x, y)``: the coefficient of friction times its direction.
    #[getter]
    fn friction(&self) -> (f64, f64) {
        self.stress.friction.into()
    }

    /// Normal stress along x [Pa].
    #[getter]
    fn xx<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.component(py, 0)
    }

    /// Normal stress along y [Pa].
    #[getter]
    fn yy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.component(py, 1)
    }

    /// Normal stress along z [Pa].
    #[getter]
    fn zz<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.component(py, 2)
    }

    /// Shear stress in the plane of the surface [Pa].
    #[getter]
    fn xy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.component(py, 3)
    }

    /// Shear stress along y on planes z = const [Pa].
    #[getter]
    fn yz<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.component(py, 4)
    }

    /// Shear stress along x on planes z = const [Pa].
    #[getter]
    fn xz<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.component(py, 5)
    }

    /// Estimated error of the components at each depth ``(nz,)`` [Pa], due to the size of the cells.
    ///
    /// It belongs to the worst place of a depth, of those that were evaluated: at the edge of the contact as
    /// a rule. The errors of the pressure itself add to it, which tractions at the surface have. Where it is not small compared with the stress, the cells do not resolve
    /// the depth, or the layer: take smaller cells. `None` for `nacre.stress`, whose pressure is given as
    /// uniform over cells, and in files of earlier versions.
    #[getter]
    fn uncertainty<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray1<f64>>>> {
        let errors = self.stress.uncertainty.as_ref();
        errors.map(|errors| read_only(py, errors.clone())).transpose()
    }

    /// Warnings about depths that the cells do not resolve; each was also issued as a `nacre.NacreWarning`.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.stress.warnings()
    }

    /// Displacement along x [m]; with ``displacement=True`` only.
    #[getter]
    fn ux<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.displacement(py, 0)
    }

    /// Displacement along y [m]; with ``displacement=True`` only.
    #[getter]
    fn uy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.displacement(py, 1)
    }

    /// Displacement into the body [m]; with ``displacement=True`` only.
    #[getter]
    fn uz<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.displacement(py, 2)
    }

    /// Von Mises' equivalent stress [Pa].
    #[getter]
    fn von_mises<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let field = py.detach(|| self.stress.von_mises());
        self.shaped(py, field)
    }

    /// Tresca's equivalent stress: the largest principal stress less the smallest [Pa].
    #[getter]
    fn tresca<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let field = py.detach(|| self.stress.tresca());
        self.shaped(py, field)
    }

    /// Largest shear stress on any plane: half of Tresca's equivalent stress [Pa].
    #[getter]
    fn max_shear<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let field = py.detach(|| self.stress.max_shear());
        self.shaped(py, field)
    }

    /// Three principal stresses, the largest first [Pa].
    #[getter]
    fn principal<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyArrayDyn<f64>>; 3]> {
        let [a, b, c] = py.detach(|| self.stress.principal());
        Ok([self.shaped(py, a)?, self.shaped(py, b)?, self.shaped(py, c)?])
    }

    /// Largest value of a field, and its point.
    ///
    /// Parameters
    /// ----------
    /// field : str, optional
    ///     Name of the field: a component, ``"von_mises"``, ``"tresca"``, ``"max_shear"``, or
    ///     ``"tension"``, the largest principal stress.
    ///
    /// Returns
    /// -------
    /// tuple
    ///     Value [Pa] and point ``(x, y, z)`` [m].
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If there is no such field, or no depth was evaluated.
    ///
    /// Examples
    /// --------
    /// >>> field = nacre.stress(nacre.Elastic(1.0, 0.3), nacre.Grid((2, 2), (2.0, 2.0)),
    /// ...                      np.ones((2, 2)), 1.0)
    /// >>> value, (x, y, z) = field.peak("von_mises")
    /// >>> z
    /// 1.0
    #[pyo3(signature = (field="von_mises"))]
    fn peak(&self, py: Python<'_>, field: &str) -> PyResult<(f64, (f64, f64, f64))> {
        let stress = &self.stress;
        let values = py.detach(|| match field {
            "von_mises" => Some(stress.von_mises()),
            "tresca" => Some(stress.tresca()),
            "max_shear" => Some(stress.max_shear()),
            "tension" => {
                let [largest, ..] = stress.principal();
                Some(largest)
            }
            name => COMPONENTS
                .iter()
                .position(|component| *component == name)
                .map(|k| stress.components[k].clone()),
        });
        let values = values.ok_or_else(|| Error::Choice {
            name: "field",
            requirement: "a component, \"von_mises\", \"tresca\", \"max_shear\" or \"tension\"",
            value: field.into(),
        })?;
        let peak = stress.peak(&values).ok_or_else(|| {
            PyValueError::new_err(
                "the field must hold at least one depth and point in the body, got none",
            )
        })?;
        Ok((peak.value, peak.position.into()))
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.dropped == other.dropped && self.stress == other.stress
    }

    fn __repr__(&self) -> String {
        let s = &self.stress;
        let range = |values: &ndarray::Array1<f64>| match (values.first(), values.last()) {
            (Some(first), Some(last)) => {
                format!("{} from {first:.6e} to {last:.6e}", values.len())
            }
            _ => "none".into(),
        };
        format!(
            "<Stress: depths {}, x {}, y {}, side '{}'{}>",
            range(&s.z),
            range(&s.x),
            range(&s.y),
            self.side(),
            match s.uncertainty.as_ref().map(|errors| errors.fold(0.0_f64, |m, e| m.max(*e))) {
                Some(largest) => format!(", uncertain by up to {largest:.1e} Pa"),
                None => String::new(),
            }
        )
    }

    #[doc = to_dict_docs!()]
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> grid = nacre.Grid((2, 2), (2.0, 2.0))
    /// >>> state = nacre.stress(steel, grid, np.ones((2, 2)), [0.5, 1.0], y=0.0).to_dict()
    /// >>> state["axes"], state["components"]["zz"].shape
    /// (['z', 'x'], (2, 2, 1))
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        named::to_dict(py, self)
    }

    #[doc = from_dict_docs!()]
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> field = nacre.stress(steel, nacre.Grid((2, 2), (2.0, 2.0)), np.ones((2, 2)), 1.0)
    /// >>> nacre.types.Stress.from_dict(field.to_dict()) == field
    /// True
    #[staticmethod]
    fn from_dict(data: &Bound<'_, PyAny>) -> PyResult<Self> {
        named::from_dict(data)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        named::reduce(py, self)
    }
}

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
