//! `nacre.Solution` and `nacre.Report`.

use std::ffi::CString;
use std::sync::Arc;

use ndarray::Array2;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyTuple};

use super::arguments::keywords::Keywords;
use super::arguments::read_only;
use super::background::{self, Caller};
use super::errors::{ConvergenceError, NacreWarning};
use super::grid::PyGrid;
use super::shapes::Shape;
use super::state::{self, Reduced, from_dict_docs, to_dict_docs};
use super::stress::{PyStressPlan, evaluated, planned, summarised};
use super::words::Word;
use crate::contact::{Hardness, Solution, Termination};
use crate::stress::Member;

mod direction;
mod gradient;
mod linear;
mod named;
mod output;
mod report;

pub(super) use direction::PyDirection;
pub(super) use gradient::PyGradient;
pub(super) use report::PyReport;

use linear::Linear;

/// A solved contact. Fields are ``(nx, ny)``, at cell centres, and read-only.
///
/// Examples
/// --------
/// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
/// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
/// >>> solution.pressure.shape == solution.in_contact.shape == (solution.x.size, solution.y.size)
/// True
#[pyclass(name = "Solution", module = "nacre", frozen)]
pub(super) struct PySolution {
    solution: Arc<Solution>,
    /// Shape that the contact was solved with, where it is known.
    shape: Option<Shape>,
    pressure: PyOnceLock<Py<PyArray2<f64>>>,
    gap: PyOnceLock<Py<PyArray2<f64>>>,
    displacement: PyOnceLock<Py<PyArray2<f64>>>,
    indentation: PyOnceLock<Py<PyArray2<f64>>>,
}

impl From<Solution> for PySolution {
    fn from(solution: Solution) -> Self {
        Self {
            solution: Arc::new(solution),
            shape: None,
            pressure: PyOnceLock::new(),
            gap: PyOnceLock::new(),
            displacement: PyOnceLock::new(),
            indentation: PyOnceLock::new(),
        }
    }
}

impl PySolution {
    /// The solution.
    pub(super) fn solution(&self) -> &Solution {
        &self.solution
    }

    /// Solution for a `shape`, whose warnings were issued.
    ///
    /// # Errors
    /// With `check`, a `ConvergenceError` if the tolerance was not met.
    pub(super) fn finished(
        py: Python<'_>,
        solution: Solution,
        shape: &Shape,
        tolerance: f64,
        check: bool,
    ) -> PyResult<Self> {
        let category = py.get_type::<NacreWarning>();
        for warning in &solution.report.warnings {
            let message = CString::new(warning.to_string())?;
            PyErr::warn(py, &category, &message, 1)?;
        }
        let made = |solution: Solution| Self { shape: Some(shape.clone()), ..solution.into() };
        if !check || solution.report.termination != Termination::IterationLimit {
            return Ok(made(solution));
        }
        let message = solution.report.not_converged(tolerance);
        let error = ConvergenceError::new_err(message.to_string());
        let unfinished = Bound::new(py, made(solution))?;
        error.value(py).setattr("solution", unfinished)?;
        Err(error)
    }
}

/// Array in `cell`, which is made from `field` at the first use.
fn cached<'py>(
    py: Python<'py>,
    cell: &PyOnceLock<Py<PyArray2<f64>>>,
    field: impl FnOnce() -> Array2<f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let array = cell.get_or_try_init(py, || read_only(py, field()).map(Bound::unbind))?;
    Ok(array.bind(py).clone())
}

#[pymethods]
impl PySolution {
    /// Grid.
    #[getter]
    fn grid(&self) -> PyGrid {
        PyGrid(*self.solution.grid())
    }

    /// Pressure [Pa], at least 0.
    #[getter]
    fn pressure<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        cached(py, &self.pressure, || self.solution.pressure.clone())
    }

    /// Gap [m]: 0 in contact, within the tolerance, and +inf where the shape cannot touch.
    #[getter]
    fn gap<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        cached(py, &self.gap, || py.detach(|| self.solution.gap()))
    }

    /// Normal displacement of both bodies together [m], positive into them.
    #[getter]
    fn displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        cached(py, &self.displacement, || self.solution.displacement.clone())
    }

    /// Largest pressure that the surfaces bear [Pa], of all cells or of each; None where they do not yield.
    #[getter]
    fn hardness<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        Ok(match &self.solution.hardness {
            None => None,
            Some(Hardness::Uniform(value)) => Some(value.into_pyobject(py)?.into_any()),
            Some(Hardness::Cells(values)) => Some(read_only(py, values.clone())?.into_any()),
        })
    }

    /// Permanent indentation of the surfaces [m], at least 0, with that of the solutions before; the gap contains it.
    #[getter]
    fn indentation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        cached(py, &self.indentation, || {
            let zeros = || Array2::zeros(self.solution.pressure.dim());
            self.solution.indentation.clone().unwrap_or_else(zeros)
        })
    }

    /// Influence coefficients ``(nx, ny)`` [m/Pa] that the contact was given; None where they are those of the bodies.
    #[getter]
    fn coefficients<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let given = self.solution.coefficients.as_ref();
        given.map(|given| read_only(py, given.to_owned())).transpose()
    }

    /// Energy that the permanent indentation has taken [N m], ``sum H w dA``; 0 without hardness.
    #[getter]
    fn plastic_work(&self) -> f64 {
        self.solution.plastic_work()
    }

    /// Whether each cell is in contact: its pressure is above 0.
    #[getter]
    fn in_contact<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<bool>>> {
        read_only(py, self.solution.in_contact())
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

    /// Normal force [N].
    #[getter]
    fn load(&self) -> f64 {
        self.solution.load()
    }

    /// Point where the force acts, ``(e_x, e_y)`` [m]; the origin where there is no force.
    #[getter]
    fn eccentricity(&self) -> (f64, f64) {
        self.solution.eccentricity().into()
    }

    /// First moments of the pressure about the origin [N m].
    #[getter]
    fn moment(&self) -> (f64, f64) {
        self.solution.moment().into()
    }

    /// Approach of the origin [m].
    #[getter]
    fn approach(&self) -> f64 {
        self.solution.approach
    }

    /// Slopes ``(s_x, s_y)``.
    #[getter]
    fn tilt(&self) -> (f64, f64) {
        self.solution.tilt.into()
    }

    /// Area of the cells in contact [m^2].
    #[getter]
    fn contact_area(&self) -> f64 {
        self.solution.contact_area()
    }

    /// Ends of the contact ``((x0, x1), (y0, y1))`` [m], accurate to a fraction of a cell.
    #[getter]
    fn contact_extent(&self) -> ((f64, f64), (f64, f64)) {
        let [x, y] = self.solution.contact_extent();
        (x.into(), y.into())
    }

    /// Largest pressure of a cell [Pa].
    #[getter]
    fn peak_pressure(&self) -> f64 {
        self.solution.peak_pressure()
    }

    /// Centre of the cell of the largest pressure [m]; of several, that of the deepest indentation.
    #[getter]
    fn peak_position(&self) -> (f64, f64) {
        self.solution.peak_position().into()
    }

    /// Pressure at the origin [Pa], by cubic interpolation; 0 off the grid.
    #[getter]
    fn central_pressure(&self) -> f64 {
        self.solution.central_pressure()
    }

    /// Force per length along x, ``(nx,)`` [N/m].
    #[getter]
    fn line_load<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        read_only(py, self.solution.line_load())
    }

    /// Exact tangent stiffness ``(3, 3)`` of ``(sum p dA, sum p x dA, sum p y dA)``.
    ///
    /// The columns are the derivatives of the discrete contact with respect to the approach [m] and the
    /// slopes ``s_x`` and ``s_y``. The matrix is symmetric. The second row is the couple about y, to
    /// which force at positive x contributes positively. All elements are 0 where nothing touches.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Stiffness in N/m, N and N m.
    ///
    /// Raises
    /// ------
    /// MemoryError
    ///     If the influence coefficients do not fit.
    ///
    /// Examples
    /// --------
    /// For a sphere on a half-space, dW/dδ = 2 E* a:
    ///
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
    /// >>> radius = (0.75 * 10.0 * 5e-3 / steel.plane_strain_modulus) ** (1 / 3)
    /// >>> stiffness = float(solution.stiffness()[0, 0])
    /// >>> round(stiffness / (2 * steel.plane_strain_modulus * radius), 2)
    /// 1.0
    fn stiffness<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let solution = Arc::clone(&self.solution);
        let stiffness = background::run(py, None, move |caller: &mut Caller<()>| {
            solution.stiffness(Some(&mut || caller.go_on()))
        })??;
        Ok(PyArray2::from_owned_array(py, Array2::from(stiffness.to_vec())))
    }

    /// Derivatives of an output with respect to all parameters of the contact.
    ///
    /// They are those of the discrete contact with its cells, exact but for the tolerance of one linear
    /// solve for each output. Against the continuum they are in error by some 2e-4 with 64 cells along
    /// the radius of the contact, see :doc:`/theory/gradients`.
    ///
    /// Parameters
    /// ----------
    /// output : str, tuple, dict or list
    ///     ``"approach"``, ``"tilt[0]"``, ``"tilt[1]"``, ``"load"``, ``"moment[0]"``, ``"moment[1]"``,
    ///     ``"located_peak"``, ``"cell_peak"``, ``"participation_area"`` or ``"area_estimate"``;
    ///     ``("pressure_norm", r)``, ``("pressure", (x, y))``, ``("displacement", (x, y))`` or
    ///     ``("gap", (x, y))``; a dict of a stress, with ``stress`` (``"xx"`` to ``"xz"``,
    ///     ``"von_mises"``, ``"principal[0]"``, ``"max_shear"``, ``"plane_shear"``), one of ``at=(x, y, z)``,
    ///     ``layer`` and ``interface``, and ``depths``, ``sharpness``, ``side``, ``body``, ``friction`` and
    ///     ``direction``; or a list of these.
    /// wrt : list of str, optional
    ///     Paths of the parameters, such as ``"body.layers[0].material.young"``, ``"shape.radius"`` or
    ///     ``"load"``; all by default.
    /// shape : Shape, optional
    ///     Shape that the contact was solved with, which a solution from a file does not know.
    /// tolerance : float, optional
    ///     Residual of the linear solves, relative to their right sides.
    ///
    /// Returns
    /// -------
    /// Gradient or list of Gradient
    ///     Derivatives by path, and with respect to the gap of each cell.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the output, a parameter or the solution has no derivative; the message says what to take instead.
    ///
    /// Examples
    /// --------
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> ball = nacre.Sphere(5e-3)
    /// >>> solution = nacre.solve(ball, steel, load=10.0)
    /// >>> peak = solution.gradient("located_peak")
    /// >>> round(peak["shape.radius"] * 5e-3 / peak.value, 2)  # p0 ~ R^(-2/3)
    /// -0.67
    #[pyo3(signature = (output, wrt=None, *, shape=None, tolerance=1e-9))]
    fn gradient<'py>(
        slf: &Bound<'_, Self>,
        py: Python<'py>,
        output: &Bound<'py, PyAny>,
        wrt: Option<Vec<String>>,
        shape: Option<&Bound<'py, PyAny>>,
        tolerance: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let this = slf.get();
        let known = (slf.as_any(), &this.solution);
        let linear = Linear::new(known, this.shape.as_ref(), shape, tolerance)?;
        linear.gradient(py, output, wrt)
    }

    /// Change of the solution along a direction of parameters.
    ///
    /// Parameters
    /// ----------
    /// directions : dict, optional
    ///     Rates of the parameters, by path.
    /// gap : array_like, optional
    ///     Rate of the undeformed gap ``(nx, ny)``.
    /// shape : Shape, optional
    ///     Shape that the contact was solved with, which a solution from a file does not know.
    /// tolerance : float, optional
    ///     Residual of the linear solve, relative to its right side.
    ///
    /// Returns
    /// -------
    /// Direction
    ///     Changes of pressure, approach and tilt, and the step for which the contact keeps its cells.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If a parameter or the solution has no derivative.
    ///
    /// Examples
    /// --------
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
    /// >>> change = solution.jvp({"load": 1.0})
    /// >>> round(float(change.pressure.sum() / solution.pressure.sum()), 6)
    /// 0.1
    #[pyo3(signature = (directions=None, gap=None, *, shape=None, tolerance=1e-9))]
    fn jvp(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        directions: Option<&Bound<'_, PyAny>>,
        gap: Option<&Bound<'_, PyAny>>,
        shape: Option<&Bound<'_, PyAny>>,
        tolerance: f64,
    ) -> PyResult<PyDirection> {
        let this = slf.get();
        let known = (slf.as_any(), &this.solution);
        let linear = Linear::new(known, this.shape.as_ref(), shape, tolerance)?;
        linear.jvp(py, directions, gap)
    }

    /// Derivatives of ``(cotangent * pressure).sum()``: a cotangent of the pressure times its Jacobian.
    ///
    /// Parameters
    /// ----------
    /// cotangent : array_like
    ///     Weights of the pressures ``(nx, ny)``.
    /// wrt : list of str, optional
    ///     Paths of the parameters; all by default.
    /// shape : Shape, optional
    ///     Shape that the contact was solved with, which a solution from a file does not know.
    /// tolerance : float, optional
    ///     Residual of the linear solve, relative to its right side.
    ///
    /// Returns
    /// -------
    /// Gradient
    ///     Derivatives by path, and with respect to the gap of each cell.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If a parameter or the solution has no derivative.
    ///
    /// Examples
    /// --------
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
    /// >>> total = solution.vjp(solution.pressure * 0.0 + 1.0, ["load"])
    /// >>> round(total["load"] * 10.0 / total.value, 6)
    /// 1.0
    #[pyo3(signature = (cotangent, wrt=None, *, shape=None, tolerance=1e-9))]
    fn vjp(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        cotangent: &Bound<'_, PyAny>,
        wrt: Option<Vec<String>>,
        shape: Option<&Bound<'_, PyAny>>,
        tolerance: f64,
    ) -> PyResult<PyGradient> {
        let this = slf.get();
        let known = (slf.as_any(), &this.solution);
        let linear = Linear::new(known, this.shape.as_ref(), shape, tolerance)?;
        linear.vjp(py, cotangent, wrt)
    }

    fn _stress<'py>(
        &self,
        z: &Bound<'py, PyAny>,
        asked: &Bound<'py, PyDict>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let keywords = Keywords::new(z.py(), Some(asked))?;
        let member = keywords.word("body")?;
        let solution = Arc::clone(&self.solution);
        evaluated(z, &keywords, self.solution.member(member)?, move |depths, options| {
            solution.stress(depths, member, options)
        })
    }

    fn _stress_summary(&self, asked: &Bound<'_, PyDict>) -> PyResult<String> {
        let keywords = Keywords::new(asked.py(), Some(asked))?;
        let member = keywords.word("body")?;
        let solution = Arc::clone(&self.solution);
        let body = self.solution.member(member)?;
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

    /// Report: how the solution came about, and how good it is.
    #[getter]
    fn report(&self) -> PyReport {
        PyReport(self.solution.report.clone())
    }

    /// Draws map, sections and main numbers; needs ``nacre-contact[plot]``.
    ///
    /// Parameters
    /// ----------
    /// axes : matplotlib.axes.Axes or dict of them, optional
    ///     Axes to draw into: a dict with any of the names "map", "x", "y" and "numbers", as
    ///     ``subplot_mosaic`` makes it, or one for the map; a new figure by default.
    ///
    /// Returns
    /// -------
    /// dict of matplotlib.axes.Axes
    ///     The axes, by name.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If there is no part of that name.
    ///
    /// Examples
    /// --------
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
    /// >>> sorted(solution.plot())
    /// ['map', 'numbers', 'x', 'y']
    #[pyo3(signature = (axes=None))]
    fn plot<'py>(
        slf: &Bound<'py, Self>,
        axes: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        call(slf, "nacre.plot", "overview", (axes,))
    }

    /// Draws the pressure as a relief; needs ``nacre-contact[plot]``, or ``nacre-contact[view]`` to turn it by hand.
    ///
    /// Parameters
    /// ----------
    /// axes : mpl_toolkits.mplot3d.axes3d.Axes3D, optional
    ///     Axes to draw into; a new figure by default.
    /// interactive : bool, optional
    ///     Whether to open a window of PyVista's instead.
    ///
    /// Returns
    /// -------
    /// mpl_toolkits.mplot3d.axes3d.Axes3D or pyvista.Plotter
    ///     The axes, or the plotter.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the grid is one of strips, `Grid.line`.
    ///
    /// Examples
    /// --------
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> nacre.solve(nacre.Sphere(5e-3), steel, load=10.0).plot_3d().get_zlabel()
    /// 'pressure [GPa]'
    #[pyo3(signature = (axes=None, *, interactive=false))]
    fn plot_3d<'py>(
        slf: &Bound<'py, Self>,
        axes: Option<&Bound<'py, PyAny>>,
        interactive: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        match interactive {
            false => call(slf, "nacre.plot", "relief", (axes,)),
            true => call(slf, "nacre.plot", "view", ()),
        }
    }

    /// Draws a quantity along x or y; needs ``nacre-contact[plot]``.
    ///
    /// Parameters
    /// ----------
    /// along : {"x", "y"}, optional
    ///     Direction of the section.
    /// at : float, optional
    ///     Position of the section in the other direction [m]; through the largest pressure by default.
    /// quantity : {"pressure", "gap", "displacement", "indentation", "line_load"}, optional
    ///     Quantity to draw.
    /// axes : matplotlib.axes.Axes, optional
    ///     Axes to draw into; a new figure by default.
    ///
    /// Returns
    /// -------
    /// matplotlib.axes.Axes
    ///     The axes.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If there is no such direction or quantity, or the position is off the grid.
    ///
    /// Examples
    /// --------
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> nacre.solve(nacre.Sphere(5e-3), steel, load=10.0).plot_section("y").get_xlabel()
    /// 'y [µm]'
    #[pyo3(signature = (along="x", *, at=None, quantity="pressure", axes=None))]
    fn plot_section<'py>(
        slf: &Bound<'py, Self>,
        along: &str,
        at: Option<f64>,
        quantity: &str,
        axes: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        call(slf, "nacre.plot", "section", (along, at, quantity, axes))
    }

    /// Dataset of the fields, with coordinates, units and the whole problem; needs ``nacre-contact[files]``.
    ///
    /// Returns
    /// -------
    /// xarray.Dataset
    ///     Fields on x and y; main numbers, bodies, motion and options as attributes.
    ///
    /// Examples
    /// --------
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> dataset = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0).to_xarray()
    /// >>> sorted(dataset.data_vars), dataset.pressure.units
    /// (['displacement', 'gap', 'line_load', 'pressure'], 'Pa')
    fn to_xarray<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        call(slf, "nacre.files", "to_xarray", ())
    }

    /// Writes a file, whole or not at all; needs ``nacre-contact[files]``.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    ///     File to write. Its ending chooses the content: ``.nc`` is everything, as NetCDF, for
    ///     `nacre.load` and xarray; ``.vtr`` is the fields, for ParaView; ``.csv`` is the sections
    ///     along x and y through the largest pressure; ``.png``, ``.pdf`` and ``.svg`` are the picture
    ///     that `plot` draws, which needs ``nacre[plot]``.
    /// depths : float or array_like, optional
    ///     Depths below the surface [m], each above the last. The ``.vtr`` then holds pressure and
    ///     gap, the stresses ``stress_xx`` … ``stress_xz``, ``von_mises``, ``max_shear`` and
    ///     ``tension`` (the largest principal stress) at points below the cell centres. A depth on an
    ///     interface occurs twice, above and below it.
    /// whole : bool, optional
    ///     Whether the ``.csv`` holds every cell, in place of the two sections, after a block of
    ///     comments ``# name: value`` with the most important numbers.
    /// options : optional
    ///     Keywords of `stress`, with depths only: ``body``, ``friction``, ``direction``, ``residual``,
    ///     ``threads``, and ``displacement``, which adds a vector of that name.
    ///
    /// Returns
    /// -------
    /// pathlib.Path
    ///     Path of the file.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the ending is another, the depths do not increase, depths are given for another file than
    ///     ``.vtr`` or `whole` for another than ``.csv``, or `stress` would raise.
    /// TypeError
    ///     If there is no such option.
    /// OSError
    ///     If the file cannot be written.
    ///
    /// Examples
    /// --------
    /// >>> import tempfile
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
    /// >>> with tempfile.TemporaryDirectory() as folder:
    /// ...     nacre.load(solution.save(f"{folder}/ball.nc")) == solution
    /// True
    #[pyo3(signature = (path, *, depths=None, whole=false, **options))]
    fn save<'py>(
        slf: &Bound<'py, Self>,
        path: &Bound<'py, PyAny>,
        depths: Option<&Bound<'py, PyAny>>,
        whole: bool,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        call(slf, "nacre.files", "save", (path, depths, whole, options))
    }

    fn __str__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        call(slf, "nacre._display", "text", ())
    }

    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        call(slf, "nacre._display", "markup", ())
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.solution == other.solution
    }

    fn __repr__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        call(slf, "nacre._display", "line", ())
    }

    #[doc = to_dict_docs!()]
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> state = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0).to_dict()
    /// >>> state["format"], state["pressure"].ndim, state["report"]["body"]
    /// (1, 2, {'HalfSpace': {'substrate': {'Elastic': {'young': 210000000000.0, 'poisson': 0.3}}, 'layers': []}})
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        state::to_dict(py, self)
    }

    #[doc = from_dict_docs!()]
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
    /// >>> nacre.Solution.from_dict(solution.to_dict()) == solution
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
    solution: &Bound<'py, PySolution>,
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
