//! `nacre.Solution`.

use std::sync::Arc;

use ndarray::Array2;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyTuple};

use super::arrays::{read_only, real_matrix};
use super::background::{self, Caller};
use super::bodies::PyHalfSpace;
use super::evaluation::{self, Keywords};
use super::report::PyReport;
use super::stress::{PyStress, field};
use super::summary::PyStressSummary;
use crate::contact::Solution;
use crate::stress::Strengths;

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
    pressure: PyOnceLock<Py<PyArray2<f64>>>,
    gap: PyOnceLock<Py<PyArray2<f64>>>,
    displacement: PyOnceLock<Py<PyArray2<f64>>>,
}

impl From<Solution> for PySolution {
    fn from(solution: Solution) -> Self {
        Self {
            solution: Arc::new(solution),
            pressure: PyOnceLock::new(),
            gap: PyOnceLock::new(),
            displacement: PyOnceLock::new(),
        }
    }
}

impl PySolution {
    pub(super) fn pressure_field(&self) -> &Array2<f64> {
        &self.solution.pressure
    }
}

/// The array of `cell`: that of `field`, at the first use.
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
    /// Pressure [Pa], at least 0.
    #[getter]
    fn pressure<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        cached(py, &self.pressure, || self.solution.pressure.clone())
    }

    /// Gap [m]: 0 in contact, within the tolerance; +inf where the shape cannot touch.
    #[getter]
    fn gap<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        cached(py, &self.gap, || py.detach(|| self.solution.gap()))
    }

    /// Normal displacement of both bodies together [m], positive into them.
    #[getter]
    fn displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        cached(py, &self.displacement, || {
            self.solution.displacement.clone()
        })
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

    /// Where the force acts, ``(e_x, e_y)`` [m]; the origin where there is none.
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

    /// Ends of the contact ``((x0, x1), (y0, y1))`` [m], within a fraction of a cell.
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

    /// Centre of the cell of the largest pressure [m].
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

    /// The exact tangent stiffness ``(3, 3)`` of ``(sum p dA, sum p x dA, sum p y dA)``.
    ///
    /// Its columns are the derivatives with respect to the approach [m] and the slopes ``s_x``,
    /// ``s_y``, of the discrete contact; symmetric. The second row is the couple about y in which
    /// force at positive x is positive. All zero where nothing touches.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     In N/m, N and N m.
    ///
    /// Raises
    /// ------
    /// MemoryError
    ///     If the influence coefficients do not fit.
    ///
    /// Examples
    /// --------
    /// Of a sphere on a half-space, dW/dδ = 2 E* a:
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
            solution.stiffness_watched(&mut || caller.go_on())
        })??;
        Ok(PyArray2::from_owned_array(
            py,
            Array2::from(stiffness.unwrap_or_default().to_vec()),
        ))
    }

    /// Stress below the surface, at any depth of either body.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Depths into the body, at least 0 [m].
    /// side : {"below", "above"}, optional
    ///     The side that a depth on an interface is on.
    /// body : {"body", "counterbody"}, optional
    ///     Which of the two; in the counterbody z points into it, and x and y are the same.
    /// x, y : float, optional
    ///     A vertical section: only the line ``x = const`` or ``y = const`` of every depth is kept,
    ///     by linear interpolation between cell centres; only a point where both are given.
    /// friction : float, optional
    ///     Coefficient of friction: adds the traction ``friction * pressure``.
    /// direction : tuple of float, optional
    ///     Direction of the traction on the body, of any length, along x by default; the counterbody
    ///     gets the opposite.
    /// residual : dict or sequence, optional
    ///     Residual stress [Pa], equal along x and y, that is added in a layer: from its number (0
    ///     at the surface) or ``"substrate"``, or in that order.
    /// displacement : bool, optional
    ///     Whether displacements are evaluated too.
    /// threads : int, optional
    ///     Threads; all of the machine's by default.
    /// progress : callable, optional
    ///     Called with the part that is done, from 0 to 1; returning False stops, and gives the
    ///     depths that are done.
    ///
    /// Returns
    /// -------
    /// Stress
    ///     Components, invariants and displacement.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If an argument is out of range, or the counterbody is rigid.
    /// MemoryError
    ///     If the fields do not fit.
    ///
    /// Notes
    /// -----
    /// Pressure is taken within cells too: inside with the slopes and curvatures that neighbours
    /// tell, near a smooth edge as a root. `nacre.stress` takes it as uniform over a cell: within
    /// some cells of the surface the two differ.
    ///
    /// Friction does not act back on the pressure. That is exact where the bodies are alike or
    /// incompressible, and good where friction is small: what is left out is of the order of
    /// ``friction * (1 - 2 nu) / (2 - 2 nu)`` of the pressure.
    ///
    /// Examples
    /// --------
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> body = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(420e9, 0.3), 20e-6)])
    /// >>> solution = nacre.solve(nacre.Sphere(5e-3), body, load=10.0)
    /// >>> above = solution.stress(body.interfaces[0], side="above")
    /// >>> below = solution.stress(body.interfaces[0])
    /// >>> bool(np.allclose(above.xz, below.xz)), bool(np.allclose(above.xx, below.xx))
    /// (True, False)
    #[expect(
        clippy::too_many_arguments,
        reason = "keywords of the public signature"
    )]
    #[pyo3(signature = (z, *, side="below", body="body", x=None, y=None, friction=0.0,
        direction=None, residual=None, displacement=false, threads=None, progress=None))]
    fn stress(
        &self,
        py: Python<'_>,
        z: &Bound<'_, PyAny>,
        side: &str,
        body: &str,
        x: Option<f64>,
        y: Option<f64>,
        friction: f64,
        direction: Option<(f64, f64)>,
        residual: Option<&Bound<'_, PyAny>>,
        displacement: bool,
        threads: Option<&Bound<'_, PyAny>>,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PyStress> {
        let member = evaluation::member(body)?;
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
        let options = keywords.options(self.solution.member(member)?)?;
        let solution = Arc::clone(&self.solution);
        let evaluated = evaluation::watched(py, progress, move |progress| {
            solution.stress_watched(&depths, member, &options, progress)
        })?;
        Ok(field(evaluated, one, &keywords))
    }

    /// The extremes of the stress in each layer and at each interface, and margins.
    ///
    /// Depths are the faces of the layers and some 18 inside each, spread over its thickness and
    /// over the width of the contact; peaks inside are then found by parabolas through three
    /// depths.
    ///
    /// Parameters
    /// ----------
    /// body : {"body", "counterbody"}, optional
    ///     Which of the two.
    /// yield_stress : dict or sequence, optional
    ///     Yield stress [Pa] of layers: from their number (0 at the surface) or ``"substrate"``, or
    ///     in that order, with None where it is not known.
    /// strength : dict or sequence, optional
    ///     Tensile strength [Pa], likewise.
    /// friction : float, optional
    ///     Coefficient of friction, as in `stress`.
    /// direction : tuple of float, optional
    ///     Direction of the traction on the body, along x by default.
    /// residual : dict or sequence, optional
    ///     Residual stress [Pa] that is added in a layer.
    /// threads : int, optional
    ///     Threads; all of the machine's by default.
    /// progress : callable, optional
    ///     Called with the part that is done; returning False stops, and gives what is done.
    ///
    /// Returns
    /// -------
    /// StressSummary
    ///     Peaks and their places; printed it is a table.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If an argument is out of range, or the counterbody is rigid.
    /// MemoryError
    ///     If the grid does not fit.
    ///
    /// Notes
    /// -----
    /// As in `stress`, pressure is taken within cells too, near a smooth edge as a root;
    /// `nacre.stress` takes it as uniform over a cell.
    ///
    /// Examples
    /// --------
    /// >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    /// >>> grid = nacre.Grid(shape=(32, 32), size=(4e-4, 4e-4))
    /// >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0, grid=grid)
    /// >>> summary = solution.stress_summary(yield_stress={"substrate": 1.8e9})
    /// >>> bool(summary.layers[0].yield_margin > 1.0)
    /// True
    #[expect(
        clippy::too_many_arguments,
        reason = "keywords of the public signature"
    )]
    #[pyo3(signature = (*, body="body", yield_stress=None, strength=None, friction=0.0,
        direction=None, residual=None, threads=None, progress=None))]
    fn stress_summary(
        &self,
        py: Python<'_>,
        body: &str,
        yield_stress: Option<&Bound<'_, PyAny>>,
        strength: Option<&Bound<'_, PyAny>>,
        friction: f64,
        direction: Option<(f64, f64)>,
        residual: Option<&Bound<'_, PyAny>>,
        threads: Option<&Bound<'_, PyAny>>,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PyStressSummary> {
        let member = evaluation::member(body)?;
        let of = self.solution.member(member)?;
        let strengths = Strengths {
            yield_stress: evaluation::by_layer("yield_stress", of, yield_stress)?,
            strength: evaluation::by_layer("strength", of, strength)?,
        };
        let keywords = Keywords {
            side: "below",
            x: None,
            y: None,
            friction,
            direction,
            residual,
            displacement: false,
            threads,
        };
        let options = keywords.options(of)?;
        let solution = Arc::clone(&self.solution);
        let summary = evaluation::watched(py, progress, move |progress| {
            solution.stress_summary(member, &strengths, &options, progress)
        })?;
        Ok(PyStressSummary(summary))
    }

    /// How the solution came about, and how good it is.
    #[getter]
    fn report(&self) -> PyReport {
        PyReport(self.solution.report.clone())
    }

    /// Draws map, sections and key figures; needs ``nacre[plot]``.
    ///
    /// Parameters
    /// ----------
    /// axes : matplotlib.axes.Axes or dict of them, optional
    ///     Where to draw: by any of the names "map", "x", "y" and "figures", as
    ///     ``subplot_mosaic`` makes them, or one for the map; a new figure by default.
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
    /// ['figures', 'map', 'x', 'y']
    #[pyo3(signature = (axes=None))]
    fn plot<'py>(
        slf: &Bound<'py, Self>,
        axes: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        call(slf, "nacre.plot", "overview", (axes,))
    }

    /// Draws the pressure as a relief; needs ``nacre[plot]``, or ``nacre[view]`` to turn it by hand.
    ///
    /// Parameters
    /// ----------
    /// axes : mpl_toolkits.mplot3d.axes3d.Axes3D, optional
    ///     Where to draw; a new figure by default.
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

    /// Draws a quantity along x or y; needs ``nacre[plot]``.
    ///
    /// Parameters
    /// ----------
    /// along : {"x", "y"}, optional
    ///     Direction of the section.
    /// at : float, optional
    ///     Its place in the other direction [m]; the row of the largest pressure by default.
    /// quantity : {"pressure", "gap", "displacement", "line_load"}, optional
    ///     What to draw.
    /// axes : matplotlib.axes.Axes, optional
    ///     Where to draw; a new figure by default.
    ///
    /// Returns
    /// -------
    /// matplotlib.axes.Axes
    ///     The axes.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If there is no such direction or quantity, or the place is off the grid.
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

    /// Fields with coordinates, units and everything that was asked; needs ``nacre[files]``.
    ///
    /// Returns
    /// -------
    /// xarray.Dataset
    ///     Fields over x and y; key figures, bodies, motion and options as attributes.
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

    /// Writes a file, whole or not at all; needs ``nacre[files]``.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    ///     Its ending says what is written: ``.nc`` everything, as NetCDF, for `nacre.load` and
    ///     xarray; ``.vtr`` the fields, for ParaView; ``.csv`` the sections along x and y through
    ///     the largest pressure.
    /// depths : float or array_like, optional
    ///     Depths below the surface [m], each above the last. The ``.vtr`` then holds pressure and
    ///     gap, the stresses ``stress_xx`` … ``stress_xz``, ``von_mises``, ``max_shear`` and
    ///     ``tension`` (the largest principal stress) at points below the cell centres; those of a
    ///     depth on an interface twice, above and below it.
    /// options : optional
    ///     With depths, those of `stress`: ``body``, ``friction``, ``direction``, ``residual``,
    ///     ``threads``, and ``displacement``, which adds a vector of that name.
    ///
    /// Returns
    /// -------
    /// pathlib.Path
    ///     The file.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the ending is another, depths do not grow or belong to no ``.vtr``, or `stress` would
    ///     raise.
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
    #[pyo3(signature = (path, *, depths=None, **options))]
    fn save<'py>(
        slf: &Bound<'py, Self>,
        path: &Bound<'py, PyAny>,
        depths: Option<&Bound<'py, PyAny>>,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        call(slf, "nacre.files", "save", (path, depths, options))
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

    fn __repr__(&self) -> String {
        let s = &self.solution;
        let [nx, ny] = s.grid().shape();
        let counterbody = s.report.counterbody.as_ref().map(PyHalfSpace::of);
        let counterbody = counterbody.map_or_else(|| "rigid".into(), |body| body.__repr__());
        format!(
            "<nacre.Solution on {nx} x {ny} cells, counterbody {counterbody}: load {:.6e} N, peak pressure {:.6e} Pa, \
             approach {:.6e} m, tilt ({:.3e}, {:.3e}), {}>",
            s.load(),
            s.peak_pressure(),
            s.approach,
            s.tilt[0],
            s.tilt[1],
            if s.report.converged() {
                "converged"
            } else {
                "not converged"
            }
        )
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Pickled<'py>)> {
        let fields = (self.pressure(py)?, self.gap(py)?, self.displacement(py)?);
        let motion = (self.approach(), self.tilt());
        let restore = py.import("nacre._core")?.getattr("_restore_solution")?;
        Ok((restore, (fields, motion, self.report())))
    }
}

/// What a function of the Python package returns for a solution.
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
    solution
        .py()
        .import(module)?
        .call_method1(function, arguments)
}

type Field<'py> = Bound<'py, PyArray2<f64>>;
type Pickled<'py> = (
    (Field<'py>, Field<'py>, Field<'py>),
    (f64, (f64, f64)),
    PyReport,
);

/// A solution from its pickled state.
#[pyfunction(name = "_restore_solution")]
pub(super) fn restore_solution(
    fields: [Bound<'_, PyAny>; 3],
    motion: (f64, (f64, f64)),
    report: PyReport,
) -> PyResult<PySolution> {
    let [pressure, gap, displacement] = fields;
    let fields = [
        real_matrix("pressure", &pressure)?,
        real_matrix("gap", &gap)?,
        real_matrix("displacement", &displacement)?,
    ];
    Ok(Solution::from_fields(fields, motion.0, motion.1.into(), report.0)?.into())
}
