//! `nacre.stress` and `nacre.Stress`.

use std::sync::Arc;

use ndarray::{Array3, ArrayD, Axis};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::exceptions::{PyAttributeError, PyValueError};
use pyo3::prelude::*;

use super::arrays::{read_only, real_array, real_matrix};
use super::bodies::{PyHalfSpace, body};
use super::evaluation::{self, Keywords, side_word, watched};
use super::grid::PyGrid;
use crate::body::HalfSpace;
use crate::error::Error;
use crate::stress::{Stress, stress_watched};

/// Names of the components, in the order of [`Stress`].
const COMPONENTS: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

/// Stress below the surface, and displacement where it was asked for.
///
/// Fields have an axis for each of depth, x and y that was not given as a number: ``(nz, nx, ny)``
/// for depths, ``(nx, ny)`` at one depth, ``(nz, nx)`` on the section ``y = const``. Tension is
/// positive; at the surface ``zz`` is minus the pressure.
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
#[pyclass(name = "Stress", module = "nacre", frozen)]
pub(super) struct PyStress {
    stress: Arc<Stress>,
    /// Whether depth, x and y were numbers.
    dropped: [bool; 3],
}

impl PyStress {
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

    /// The body it is in.
    #[getter]
    fn body(&self) -> PyHalfSpace {
        PyHalfSpace(self.stress.body.clone())
    }

    /// The side of an interface that depths on one are on: "above" or "below".
    #[getter]
    fn side(&self) -> &'static str {
        side_word(self.stress.side)
    }

    /// Traction over pressure, ``(x, y)``: the coefficient of friction times its direction.
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

    /// Largest shear stress on any plane: half of Tresca's [Pa].
    #[getter]
    fn max_shear<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let field = py.detach(|| self.stress.max_shear());
        self.shaped(py, field)
    }

    /// The three principal stresses, the largest first [Pa].
    #[getter]
    fn principal<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyArrayDyn<f64>>; 3]> {
        let [a, b, c] = py.detach(|| self.stress.principal());
        Ok([
            self.shaped(py, a)?,
            self.shaped(py, b)?,
            self.shaped(py, c)?,
        ])
    }

    /// The largest value of a field, and where it is.
    ///
    /// Parameters
    /// ----------
    /// field : str, optional
    ///     A component, ``"von_mises"``, ``"tresca"``, ``"max_shear"``, or ``"tension"``: the
    ///     largest principal stress.
    ///
    /// Returns
    /// -------
    /// tuple
    ///     The value [Pa] and ``(x, y, z)`` [m].
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If there is no such field, or it is empty.
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
        let peak = stress
            .peak(&values)
            .ok_or_else(|| PyValueError::new_err("the field holds no depth"))?;
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
            "<nacre.Stress: depths {}, x {}, y {}, side '{}'>",
            range(&s.z),
            range(&s.x),
            range(&s.y),
            self.side()
        )
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (State<'py>,))> {
        let whole = |field: &Array3<f64>| {
            Ok::<_, PyErr>(read_only(py, field.clone().into_dyn())?.into_any())
        };
        let s = &self.stress;
        let mut fields = Vec::new();
        for field in s.components.iter().chain(s.displacement.iter().flatten()) {
            fields.push(whole(field)?);
        }
        let restore = py.import("nacre._core")?.getattr("_restore_stress")?;
        let state = (
            [s.z.to_vec(), s.x.to_vec(), s.y.to_vec()],
            fields,
            self.body(),
            self.side().to_owned(),
            s.friction,
            self.dropped,
        );
        Ok((restore, (state,)))
    }
}

/// Coordinates, fields, body, side, friction and shape.
type State<'py> = (
    [Vec<f64>; 3],
    Vec<Bound<'py, PyAny>>,
    PyHalfSpace,
    String,
    [f64; 2],
    [bool; 3],
);

/// A stress field from its pickled state.
#[pyfunction(name = "_restore_stress")]
pub(super) fn restore_stress(state: State<'_>) -> PyResult<PyStress> {
    let ([z, x, y], fields, body, side, friction, dropped) = state;
    let mut arrays = Vec::new();
    for field in &fields {
        let array = real_array("field", field)?;
        let wrong = |_| PyValueError::new_err("field must have three dimensions");
        arrays.push(array.into_dimensionality().map_err(wrong)?);
    }
    let wrong = || PyValueError::new_err("state must hold 6 or 9 fields");
    let displacement = match arrays.len() {
        6 => None,
        _ => Some(arrays.split_off(6).try_into().map_err(|_| wrong())?),
    };
    let stress = Stress::from_fields(
        [z.into(), x.into(), y.into()],
        body.0,
        evaluation::side(&side)?,
        friction,
        arrays.try_into().map_err(|_| wrong())?,
        displacement,
    )?;
    Ok(PyStress {
        stress: Arc::new(stress),
        dropped,
    })
}

/// A field, of which the axes that were numbers are dropped.
pub(super) fn field(stress: Stress, one_depth: bool, keywords: &Keywords) -> PyStress {
    PyStress {
        stress: Arc::new(stress),
        dropped: [one_depth, keywords.x.is_some(), keywords.y.is_some()],
    }
}

/// Stress of a body under a pressure, at any depth.
///
/// Parameters
/// ----------
/// body : HalfSpace or Elastic
///     The body.
/// grid : Grid
///     The cells.
/// pressure : array_like
///     Pressure ``(nx, ny)`` on them [Pa], uniform over a cell.
/// z : float or array_like
///     Depths, at least 0 [m].
/// side : {"below", "above"}, optional
///     The side that a depth on an interface is on.
/// x, y : float, optional
///     A vertical section: only the line ``x = const`` or ``y = const`` of every depth is kept, by
///     linear interpolation between cell centres; only a point where both are given.
/// friction : float, optional
///     Coefficient of friction: adds the traction ``friction * pressure``.
/// direction : tuple of float, optional
///     Direction of the traction that acts on the body, of any length; along x by default.
/// residual : dict or sequence, optional
///     Residual stress [Pa], equal along x and y, that is added in a layer: from its number (0 at
///     the surface) or ``"substrate"``, or in that order.
/// displacement : bool, optional
///     Whether displacements are evaluated too.
/// threads : int, optional
///     Threads; all of the machine's by default.
/// progress : callable, optional
///     Called with the part that is done, from 0 to 1; returning False stops, and gives the depths
///     that are done.
///
/// Returns
/// -------
/// Stress
///     Components, invariants and displacement.
///
/// Raises
/// ------
/// ValueError
///     If an argument is out of range.
/// MemoryError
///     If the fields do not fit.
///
/// Notes
/// -----
/// The pressure is uniform over a cell. `Solution.stress` knows that of a solved contact within
/// cells, and is better within some cells of the surface.
///
/// The pressure is not coupled to friction. That is exact where the bodies are alike or
/// incompressible, and good where the friction is small: what is left out is of the order of
/// ``friction * (1 - 2 nu) / (2 - 2 nu)`` of the pressure.
///
/// Examples
/// --------
/// The largest shear below a uniformly loaded square, over the pressure:
///
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> grid = nacre.Grid(shape=(65, 65), size=(2e-3, 2e-3))
/// >>> field = nacre.stress(steel, grid, np.full((65, 65), 1e9), [0.0, 0.5e-3], y=0.0)
/// >>> field.zz.shape
/// (2, 65)
/// >>> bool(abs(field.zz[0, 32] + 1e9) < 1.0)
/// True
#[expect(
    clippy::too_many_arguments,
    reason = "keywords of the public signature"
)]
#[pyfunction]
#[pyo3(signature = (body, grid, pressure, z, *, side="below", x=None, y=None, friction=0.0,
    direction=None, residual=None, displacement=false, threads=None, progress=None))]
pub(super) fn stress(
    py: Python<'_>,
    #[pyo3(from_py_with = body)] body: HalfSpace,
    grid: PyGrid,
    pressure: &Bound<'_, PyAny>,
    z: &Bound<'_, PyAny>,
    side: &str,
    x: Option<f64>,
    y: Option<f64>,
    friction: f64,
    direction: Option<(f64, f64)>,
    residual: Option<&Bound<'_, PyAny>>,
    displacement: bool,
    threads: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyStress> {
    let pressure = real_matrix("pressure", pressure)?;
    let (depths, one) = evaluation::depths(z)?;
    let keywords = Keywords {
        side,
        x,
        y,
        friction,
        direction,
        residual,
        displacement,
        threads,
    };
    let options = keywords.options(&body)?;
    let evaluated = watched(py, progress, move |progress| {
        stress_watched(&body, &grid.0, &pressure, &depths, &options, progress)
    })?;
    Ok(field(evaluated, one, &keywords))
}
