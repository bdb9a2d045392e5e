//! `nacre.FrictionSolution`.

use std::ffi::CString;
use std::sync::Arc;

use ndarray::{Array2, Array3, Axis, stack};
use numpy::{PyArray1, PyArray2, PyArray3};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyTuple};

use super::report::PyFrictionReport;
use crate::contact::{Solution, Termination};
use crate::friction::{Friction, FrictionSolution, TangentialMotion};
use crate::python::arguments::keywords::Keywords;
use crate::python::arguments::read_only;
use crate::python::errors::{ConvergenceError, NacreWarning};
use crate::python::grid::PyGrid;
use crate::python::solution::PySolution;
use crate::python::state::{self, Fields, Reduced, State, from_dict_docs, to_dict_docs};
use crate::python::stress::{PyStressPlan, evaluated, planned, summarised};
use crate::python::words::Word;
use crate::stress::Member;

/// A contact with friction: one step of a history, or rolling. Fields are at cell centres, and read-only.
///
/// Tractions act on the body, and their opposites on the counterbody. Displacements are those of the body less those of
/// the counterbody; slip is that of the counterbody over the body.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> ball = nacre.slide(nacre.Sphere(5e-3), steel, steel, load=10.0, friction=0.3, force=(1.5, None))
/// >>> ball.traction.shape == (2, *ball.pressure.shape), bool(ball.stick.any())
/// (True, True)
#[pyclass(name = "FrictionSolution", module = "nacre.types", frozen, eq)]
pub(in crate::python) struct PyFrictionSolution {
    solution: Arc<FrictionSolution>,
    normal: PyOnceLock<Py<PySolution>>,
}

impl PartialEq for PyFrictionSolution {
    fn eq(&self, other: &Self) -> bool {
        self.solution == other.solution
    }
}

impl From<FrictionSolution> for PyFrictionSolution {
    fn from(solution: FrictionSolution) -> Self {
        Self { solution: Arc::new(solution), normal: PyOnceLock::new() }
    }
}

impl PyFrictionSolution {
    pub(in crate::python::contact) fn inner(&self) -> &Arc<FrictionSolution> {
        &self.solution
    }

    pub(super) fn is_stopped(&self) -> bool {
        self.solution.report.termination == Termination::Stopped
    }

    /// Solution whose warnings were issued.
    ///
    /// # Errors
    /// With `check`, a `ConvergenceError` if the tolerance was not met.
    pub(super) fn finished(
        py: Python<'_>,
        solution: FrictionSolution,
        check: bool,
    ) -> PyResult<Self> {
        let category = py.get_type::<NacreWarning>();
        let stopped = solution.report.termination == Termination::Stopped;
        for warning in solution.normal.report.warnings.iter().filter(|_| !stopped) {
            let message = CString::new(warning.to_string())?;
            PyErr::warn(py, &category, &message, 1)?;
        }
        if !check || solution.report.termination != Termination::IterationLimit {
            return Ok(solution.into());
        }
        let error = match solution.clone().require_converged() {
            Err(error) => ConvergenceError::new_err(error.to_string()),
            Ok(_) => return Ok(solution.into()),
        };
        let unfinished = Bound::new(py, Self::from(solution))?;
        error.value(py).setattr("solution", unfinished)?;
        Err(error)
    }

    fn normal<'py>(&self, py: Python<'py>) -> PyResult<&Bound<'py, PySolution>> {
        let normal = || Py::new(py, PySolution::from(self.solution.normal.clone()));
        Ok(self.normal.get_or_try_init(py, normal)?.bind(py))
    }
}

/// Both components of a field: (2, nx, ny).
fn vector([x, y]: &[Array2<f64>; 2]) -> Array3<f64> {
    stack(Axis(0), &[x.view(), y.view()]).unwrap_or_default()
}

/// Components of a field (2, nx, ny).
fn components(field: &Array3<f64>) -> PyResult<[Array2<f64>; 2]> {
    match field.len_of(Axis(0)) {
        2 => Ok([0, 1].map(|axis| field.index_axis(Axis(0), axis).to_owned())),
        count => Err(PyValueError::new_err(format!(
            "a vector field must have 2 components, got {count}"
        ))),
    }
}

impl State for PyFrictionSolution {
    const KIND: &'static str = "FrictionSolution";

    fn write(&self, fields: &Fields) -> PyResult<()> {
        let solution = &self.solution;
        fields.set_fields("normal", |normal| {
            PySolution::from(solution.normal.clone()).write(normal)
        })?;
        match &solution.friction {
            Friction::Uniform(coefficient) => fields.set("friction", *coefficient)?,
            Friction::Cells(cells) => fields.set_array("friction", cells)?,
        }
        fields.set_array("traction", &vector(&solution.traction))?;
        fields.set_array("displacement", &vector(&solution.displacement))?;
        fields.set_array("slip", &vector(&solution.slip))?;
        fields.set_fields("motion", |motion| match solution.motion {
            TangentialMotion::Slide { shift, twist } => {
                motion.set("shift", shift)?;
                motion.set("twist", twist)
            }
            TangentialMotion::Roll { creepage, spin, direction } => {
                motion.set("creepage", creepage)?;
                motion.set("spin", spin)?;
                motion.set("direction", direction.word())
            }
        })?;
        fields
            .set_fields("report", |report| PyFrictionReport(solution.report.clone()).write(report))
    }

    fn read(fields: &Fields) -> PyResult<Self> {
        let normal: Solution = fields.get_fields("normal")?.read(PySolution::read)?.inner();
        let friction = fields.get_array::<ndarray::IxDyn>("friction")?;
        let friction = match friction.ndim() {
            0 => Friction::Uniform(friction.sum()),
            _ => Friction::Cells(
                friction
                    .into_dimensionality()
                    .map_err(|error| PyValueError::new_err(format!("friction: {error}")))?,
            ),
        };
        let field = |name: &str| components(&fields.get_array(name)?);
        let [traction, displacement, slip] =
            [field("traction")?, field("displacement")?, field("slip")?];
        let motion = fields.get_fields("motion")?.read(|motion| {
            if let Some(shift) = motion.get_newer("shift")? {
                let twist = motion.get("twist")?;
                return Ok(TangentialMotion::Slide { shift, twist });
            }
            let direction: String = motion.get("direction")?;
            Ok(TangentialMotion::Roll {
                creepage: motion.get("creepage")?,
                spin: motion.get("spin")?,
                direction: Word::from_word(&direction)?,
            })
        })?;
        let report = fields.get_fields("report")?.read(PyFrictionReport::read)?.0;
        let solution =
            FrictionSolution { normal, friction, traction, displacement, slip, motion, report };
        Ok(solution.checked()?.into())
    }
}

#[pymethods]
impl PyFrictionSolution {
    /// Normal contact: pressure, gap, approach, tilt.
    #[getter(normal)]
    fn normal_solution<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PySolution>> {
        self.normal(py).cloned()
    }

    /// Pressure ``(nx, ny)`` [Pa].
    #[getter]
    fn pressure<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.normal(py)?.getattr("pressure")
    }

    /// Grid.
    #[getter]
    fn grid(&self) -> PyGrid {
        PyGrid(*self.solution.grid())
    }

    /// Cell centres along x, ``(nx,)`` [m].
    #[getter]
    fn x<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        read_only(py, self.solution.grid().x())
    }

    /// Cell centres along y, ``(ny,)`` [m].
    #[getter]
    fn y<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        read_only(py, self.solution.grid().y())
    }

    /// Tractions on the body along x and y, ``(2, nx, ny)`` [Pa].
    #[getter]
    fn traction<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        read_only(py, vector(&self.solution.traction))
    }

    /// Tangential displacements of the body relative to the counterbody, ``(2, nx, ny)`` [m].
    #[getter]
    fn displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        read_only(py, vector(&self.solution.displacement))
    }

    /// Slip of the counterbody over the body, ``(2, nx, ny)``; 0 outside the contact.
    ///
    /// It is that in the step [m], or in rolling the slip velocity over the speed of rolling.
    #[getter]
    fn slip<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        read_only(py, vector(&self.solution.slip))
    }

    /// Whether each cell sticks, ``(nx, ny)``: it is in contact, and its traction is below the bound.
    #[getter]
    fn stick<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<bool>>> {
        read_only(py, self.solution.stick())
    }

    /// Bound of the traction, friction times pressure, ``(nx, ny)`` [Pa].
    #[getter]
    fn bound<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        read_only(py, self.solution.bound())
    }

    /// Coefficient of friction: a number, or one for each cell ``(nx, ny)``.
    #[getter]
    fn friction<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(match &self.solution.friction {
            Friction::Uniform(coefficient) => coefficient.into_pyobject(py)?.into_any(),
            Friction::Cells(cells) => read_only(py, cells.clone())?.into_any(),
        })
    }

    /// Forces of the tractions on the body along x and y [N].
    #[getter]
    fn force(&self) -> (f64, f64) {
        self.solution.force().into()
    }

    /// Torque of the tractions on the body about the origin [N m].
    #[getter]
    fn torque(&self) -> f64 {
        self.solution.torque()
    }

    /// Shift of the counterbody over the body since the first touch [m]; `None` in rolling.
    #[getter]
    fn shift(&self) -> Option<(f64, f64)> {
        match self.solution.motion {
            TangentialMotion::Slide { shift, .. } => Some(shift.into()),
            TangentialMotion::Roll { .. } => None,
        }
    }

    /// Twist of the counterbody over the body since the first touch [rad]; `None` in rolling.
    #[getter]
    fn twist(&self) -> Option<f64> {
        match self.solution.motion {
            TangentialMotion::Slide { twist, .. } => Some(twist),
            TangentialMotion::Roll { .. } => None,
        }
    }

    /// Creepages along the direction of rolling e and along z × e; `None` in sliding.
    #[getter]
    fn creepage(&self) -> Option<(f64, f64)> {
        match self.solution.motion {
            TangentialMotion::Slide { .. } => None,
            TangentialMotion::Roll { creepage, .. } => Some(creepage.into()),
        }
    }

    /// Spin [1/m]; `None` in sliding.
    #[getter]
    fn spin(&self) -> Option<f64> {
        match self.solution.motion {
            TangentialMotion::Slide { .. } => None,
            TangentialMotion::Roll { spin, .. } => Some(spin),
        }
    }

    /// Direction of rolling, "+x", "-x", "+y" or "-y"; `None` in sliding.
    #[getter]
    fn direction(&self) -> Option<&'static str> {
        match self.solution.motion {
            TangentialMotion::Slide { .. } => None,
            TangentialMotion::Roll { direction, .. } => Some(direction.word()),
        }
    }

    /// Energy that friction dissipates by area, traction times slip, ``(nx, ny)``.
    ///
    /// It is that of the step [J/m²], or in rolling that of the distance rolled [J/m³].
    #[getter]
    fn dissipation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        read_only(py, self.solution.dissipation())
    }

    /// Energy that friction dissipates in the step [J].
    ///
    /// In rolling it is that of the distance rolled [N], the power over the speed.
    #[getter]
    fn dissipated(&self) -> f64 {
        self.solution.dissipated()
    }

    /// Elastic energy of the tractions and their displacements [J].
    #[getter]
    fn tangential_energy(&self) -> f64 {
        self.solution.tangential_energy()
    }

    /// Course of the solve, and how well the laws hold.
    #[getter]
    fn report(&self) -> PyFrictionReport {
        PyFrictionReport(self.solution.report.clone())
    }

    fn _stress<'py>(
        &self,
        z: &Bound<'py, PyAny>,
        asked: &Bound<'py, PyDict>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let keywords = Keywords::new(z.py(), Some(asked))?;
        let member = keywords.word("body")?;
        let solution = Arc::clone(&self.solution);
        evaluated(z, &keywords, self.solution.normal.member(member)?, move |depths, options| {
            solution.stress(depths, member, options)
        })
    }

    fn _stress_summary(&self, asked: &Bound<'_, PyDict>) -> PyResult<String> {
        let keywords = Keywords::new(asked.py(), Some(asked))?;
        let member = keywords.word("body")?;
        let solution = Arc::clone(&self.solution);
        let body = self.solution.normal.member(member)?;
        summarised(asked.py(), &keywords, body, move |strengths, options| {
            solution.stress_summary(member, strengths, options)
        })
    }

    fn _stress_plan(
        &self,
        py: Python<'_>,
        body: &str,
        threads: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PyStressPlan> {
        let member = Member::from_word(body)?;
        let solution = Arc::clone(&self.solution);
        planned(py, threads, move |options| solution.stress_plan(member, options))
    }

    /// Draws stick and slip, with arrows of the traction; needs ``nacre-contact[plot]``.
    ///
    /// Parameters
    /// ----------
    /// axes : matplotlib.axes.Axes, optional
    ///     Axes to draw into; a new figure by default.
    ///
    /// Returns
    /// -------
    /// matplotlib.axes.Axes
    ///     Axes of the picture.
    ///
    /// Raises
    /// ------
    /// TypeError
    ///     If `axes` are not axes.
    ///
    /// Examples
    /// --------
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> ball = nacre.slide(nacre.Sphere(5e-3), steel, steel, load=10.0, friction=0.3, force=(1.5, None))
    /// >>> ball.plot().get_xlabel()
    /// 'x [µm]'
    #[pyo3(signature = (axes=None))]
    fn plot<'py>(
        slf: &Bound<'py, Self>,
        axes: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        call(slf, "nacre.plot", "friction", (axes,))
    }

    /// Dataset of the fields, with coordinates, units and the whole problem; needs ``nacre-contact[files]``.
    ///
    /// Returns
    /// -------
    /// xarray.Dataset
    ///     Fields on x and y; main numbers and the report as attributes.
    ///
    /// Examples
    /// --------
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> ball = nacre.slide(nacre.Sphere(5e-3), steel, steel, load=10.0, friction=0.3, force=(1.5, None))
    /// >>> dataset = ball.to_xarray()
    /// >>> dataset.traction.dims, dataset.traction.units
    /// (('component', 'x', 'y'), 'Pa')
    fn to_xarray<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        call(slf, "nacre._friction_files", "to_xarray", ())
    }

    /// Writes a file, whole or not at all; needs ``nacre-contact[files]``.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    ///     File to write. Its ending chooses the content: ``.nc`` is everything, as NetCDF, for `nacre.load` and
    ///     xarray; ``.vtr`` is the fields, for ParaView; ``.csv`` is every cell; ``.png``, ``.pdf`` and ``.svg`` are
    ///     the picture that `plot` draws, which needs ``nacre-contact[plot]``.
    ///
    /// Returns
    /// -------
    /// pathlib.Path
    ///     Path of the file.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the ending is another.
    /// OSError
    ///     If the file cannot be written.
    ///
    /// Examples
    /// --------
    /// >>> import tempfile
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> ball = nacre.slide(nacre.Sphere(5e-3), steel, steel, load=10.0, friction=0.3, force=(1.5, None))
    /// >>> with tempfile.TemporaryDirectory() as folder:
    /// ...     nacre.load(ball.save(f"{folder}/ball.nc")) == ball
    /// True
    fn save<'py>(slf: &Bound<'py, Self>, path: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        call(slf, "nacre._friction_files", "save", (path,))
    }

    fn __str__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        call(slf, "nacre._friction_display", "text", ())
    }

    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        call(slf, "nacre._friction_display", "markup", ())
    }

    fn __repr__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        call(slf, "nacre._friction_display", "line", ())
    }

    #[doc = to_dict_docs!()]
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> ball = nacre.slide(nacre.Sphere(5e-3), steel, steel, load=10.0, friction=0.3, force=(1.5, None))
    /// >>> ball.to_dict()["traction"].shape == ball.traction.shape
    /// True
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        state::to_dict(py, self)
    }

    #[doc = from_dict_docs!()]
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> ball = nacre.slide(nacre.Sphere(5e-3), steel, steel, load=10.0, friction=0.3, force=(1.5, None))
    /// >>> nacre.types.FrictionSolution.from_dict(ball.to_dict()) == ball
    /// True
    #[staticmethod]
    fn from_dict(data: &Bound<'_, PyAny>) -> PyResult<Self> {
        state::from_dict(data)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        state::reduce(py, self)
    }
}

/// Result of a function of the Python package for a solution.
fn call<'py, A>(
    solution: &Bound<'py, PyFrictionSolution>,
    module: &str,
    function: &str,
    arguments: A,
) -> PyResult<Bound<'py, PyAny>>
where
    A: IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>>,
    PyErr: From<A::Error>,
{
    let first = PyTuple::new(solution.py(), [solution])?;
    let arguments = first.add(arguments.into_pyobject(solution.py())?)?;
    let arguments = arguments.cast_into::<PyTuple>()?;
    solution.py().import(module)?.call_method1(function, arguments)
}
