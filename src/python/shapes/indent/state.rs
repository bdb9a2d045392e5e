//! States of an indentation: `IndentState` and `StateDerivative`.

use ndarray::ArrayD;
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::super::super::arguments::{Real, real_array};
use super::super::super::background::{self, Caller};
use crate::Result;
use crate::indent::{Held, IndentParameter, IndentWarning, InteriorStress, Point, Variable};
use crate::python::errors::issue_warnings;

/// One number of a state of stress.
type Component = fn(&InteriorStress) -> f64;

/// Values in the shape of what was given: a number or an array.
pub(super) fn shaped<'py>(
    py: Python<'py>,
    values: Vec<f64>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    if shape.is_empty() {
        return Ok(values[0].into_pyobject(py)?.into_any());
    }
    let array = ArrayD::from_shape_vec(shape.to_vec(), values);
    let array =
        array.map_err(|error| pyo3::exceptions::PyValueError::new_err(error.to_string()))?;
    Ok(array.into_pyarray(py).into_any())
}

/// Results of `work` on each of the items, on a thread of its own, so that Ctrl-C is seen at once; the work ends before its
/// next item then.
pub(super) fn worked<I: Send + 'static, T: Send + 'static>(
    py: Python<'_>,
    items: Vec<I>,
    work: impl Fn(&I) -> Result<T> + Send + 'static,
) -> PyResult<Vec<T>> {
    let results = background::run(py, None, move |caller: &mut Caller<()>| {
        let going = items.iter().take_while(|_| caller.go_on().is_continue());
        going.map(work).collect::<Result<Vec<T>>>()
    })?;
    Ok(results?)
}

/// Values at distances r of all points, in the shape of the points followed by that of r.
fn field<'py>(
    r: &Bound<'py, PyAny>,
    points: &[Point],
    shape: &[usize],
    of: impl Fn(&Point, &[f64]) -> Result<Vec<f64>> + Send + 'static,
) -> PyResult<Bound<'py, PyAny>> {
    let py = r.py();
    let r = real_array("r", r)?;
    let shape = [shape, r.shape()].concat();
    let r: Vec<f64> = r.into_iter().collect();
    let all = worked(py, points.to_vec(), move |point| of(point, &r))?;
    shaped(py, all.into_iter().flatten().collect(), &shape)
}

/// Contacts of an indentation, one for each load, approach or radius that was given, in the shape of the latter.
///
/// Examples
/// --------
/// >>> body = nacre.HalfSpace(nacre.Elastic(70e9, 0.33))
/// >>> test = nacre.indent.Indentation(body, nacre.indent.Tip.sphere(10e-6))
/// >>> state = test.at(load=[1e-3, 2e-3])
/// >>> state.approach.shape
/// (2,)
#[pyclass(name = "IndentState", module = "nacre.indent", frozen)]
pub(in crate::python) struct PyIndentState {
    pub(super) points: Vec<Point>,
    pub(super) shape: Vec<usize>,
    pub(super) held: Held,
    pub(super) parameters: Vec<(String, IndentParameter)>,
}

/// Sentences of the worst warning of all points.
pub(super) fn worst(warnings: impl IntoIterator<Item = IndentWarning>) -> Vec<String> {
    let slope = |warning: &IndentWarning| match warning {
        IndentWarning::Steep { slope } => *slope,
    };
    let worst = warnings.into_iter().max_by(|a, b| slope(a).total_cmp(&slope(b)));
    worst.iter().map(ToString::to_string).collect()
}

impl PyIndentState {
    /// The states, whose warnings are issued.
    pub(super) fn warned(self, py: Python<'_>) -> PyResult<Self> {
        issue_warnings(py, self.warnings())?;
        Ok(self)
    }

    fn each<'py>(
        &self,
        py: Python<'py>,
        of: impl Fn(&Point) -> f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        shaped(py, self.points.iter().map(of).collect(), &self.shape)
    }

    fn field<'py>(
        &self,
        r: &Bound<'py, PyAny>,
        of: fn(&Point, &[f64]) -> Result<Vec<f64>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        field(r, &self.points, &self.shape, of)
    }
}

#[pymethods]
impl PyIndentState {
    /// Contact radius [m].
    #[getter]
    fn radius<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.each(py, |point| point.radius)
    }

    /// Load [N], below 0 where the tip is pulled.
    #[getter]
    fn load<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.each(py, |point| point.load)
    }

    /// Approach [m].
    #[getter]
    fn approach<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.each(py, |point| point.approach)
    }

    /// Stiffness of this contact area [N/m]: that of unloading, and without adhesion the slope of the curve.
    #[getter]
    fn stiffness<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.each(py, |point| point.stiffness)
    }

    /// Derivative of the stiffness with respect to the contact radius [N/m^2].
    #[getter]
    fn stiffness_slope<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.each(py, |point| point.stiffness_slope)
    }

    /// Radius up to which the surfaces attract each other [m]: that of the contact but for Maugis's adhesion.
    #[getter]
    fn outer_radius<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.each(py, |point| point.outer_radius.unwrap_or(point.radius))
    }

    /// What makes the contacts doubtful, a list of sentences, empty as a rule: slopes above 0.5. Each was also issued as a
    /// `nacre.NacreWarning`.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        worst(self.points.iter().flat_map(Point::warnings))
    }

    /// Pressure [Pa] at distances r from the axis [m], 0 outside of the contact, infinite below a sharp tip and at a sharp edge. Its
    /// shape is that of the state followed by that of r.
    fn pressure<'py>(&self, r: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        self.field(r, Point::pressure)
    }

    /// Displacement of both surfaces together [m] at distances r from the axis [m], positive into the bodies.
    fn displacement<'py>(&self, r: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        self.field(r, Point::displacement)
    }

    /// Gap between tip and surface [m] at distances r from the axis [m], infinite beyond the tip.
    fn gap<'py>(&self, r: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        self.field(r, Point::gap)
    }

    /// Stresses in the body below the surface.
    ///
    /// Parameters
    /// ----------
    /// r : array_like
    ///     Distances from the axis [m].
    /// z : float
    ///     Depth [m], at least 1e-2 of the contact radius. On an interface the stresses are those below it.
    ///
    /// Returns
    /// -------
    /// dict of str to numpy.ndarray
    ///     rr, tt, zz, rz and von_mises [Pa], tension positive, each in the shape of the state followed by that of r.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the depth is too small or below a rigid base, or a distance is negative.
    fn stress<'py>(&self, r: &Bound<'py, PyAny>, z: Real) -> PyResult<Bound<'py, PyDict>> {
        let py = r.py();
        let found = PyDict::new(py);
        let of: [(&str, Component); 5] = [
            ("rr", |s| s.rr),
            ("tt", |s| s.tt),
            ("zz", |s| s.zz),
            ("rz", |s| s.rz),
            ("von_mises", InteriorStress::von_mises),
        ];
        let r = real_array("r", r)?;
        let shape = [&self.shape, r.shape()].concat();
        let r: Vec<f64> = r.into_iter().collect();
        let all = worked(py, self.points.clone(), move |point| point.stress(0, z.0, &r))?;
        for (name, of) in of {
            let values = all.iter().flatten().map(of).collect();
            found.set_item(name, shaped(py, values, &shape)?)?;
        }
        Ok(found)
    }

    /// Derivatives with respect to parameters by path, where what was given is held.
    ///
    /// Parameters
    /// ----------
    /// wrt : list of str, optional
    ///     Paths as `Indentation.parameters` lists them; all of them by default.
    ///
    /// Returns
    /// -------
    /// dict of str to StateDerivative
    ///     Derivatives of all numbers and fields of the states, per unit of the parameter.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If there is no such parameter.
    #[pyo3(signature = (wrt=None))]
    fn derivatives<'py>(
        &self,
        py: Python<'py>,
        wrt: Option<Vec<String>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let chosen = chosen(&self.parameters, wrt)?;
        let found = PyDict::new(py);
        for (path, parameter) in chosen {
            let (variable, held) = (Variable::Parameter(parameter), self.held);
            let values = worked(py, self.points.clone(), move |point| {
                let change = point.derivative(variable, held)?;
                Ok([
                    change.radius,
                    change.load,
                    change.approach,
                    change.stiffness,
                    change.outer_radius.unwrap_or(change.radius),
                ])
            })?;
            let derivative = PyStateDerivative {
                points: self.points.clone(),
                variable,
                held,
                values,
                shape: self.shape.clone(),
            };
            found.set_item(path, Py::new(py, derivative)?)?;
        }
        Ok(found)
    }

    fn __repr__(&self) -> String {
        match &self.points[..] {
            [point] => format!(
                "<IndentState: radius {:.4e} m, load {:.4e} N, approach {:.4e} m>",
                point.radius, point.load, point.approach
            ),
            points => format!("<IndentState: {} contacts>", points.len()),
        }
    }
}

/// Parameters of these paths, or all.
pub(super) fn chosen(
    known: &[(String, IndentParameter)],
    wrt: Option<Vec<String>>,
) -> PyResult<Vec<(String, IndentParameter)>> {
    let Some(paths) = wrt else {
        return Ok(known.to_vec());
    };
    let find = |path: String| {
        let found = known.iter().find(|(own, _)| *own == path).cloned();
        found.ok_or_else(|| {
            let all: Vec<&str> = known.iter().map(|(path, _)| path.as_str()).collect();
            pyo3::exceptions::PyValueError::new_err(format!(
                "wrt must be paths among {}, got {path:?}",
                all.join(", ")
            ))
        })
    };
    paths.into_iter().map(find).collect()
}

/// Derivatives of the states of an indentation with respect to one parameter, in the shape of the states.
///
/// Examples
/// --------
/// >>> body = nacre.HalfSpace(nacre.Elastic(70e9, 0.33))
/// >>> test = nacre.indent.Indentation(body, nacre.indent.Tip.paraboloid(10e-6))
/// >>> state = test.at(load=1e-3)
/// >>> change = state.derivatives(["body.substrate.young"])["body.substrate.young"]
/// >>> round(change.approach * 70e9 / state.approach, 6)  # Hertz: -2/3
/// -0.666667
#[pyclass(name = "StateDerivative", module = "nacre.indent", frozen)]
pub(in crate::python) struct PyStateDerivative {
    points: Vec<Point>,
    variable: Variable,
    held: Held,
    values: Vec<[f64; 5]>,
    shape: Vec<usize>,
}

impl PyStateDerivative {
    fn each<'py>(&self, py: Python<'py>, k: usize) -> PyResult<Bound<'py, PyAny>> {
        shaped(py, self.values.iter().map(|v| v[k]).collect(), &self.shape)
    }
}

#[pymethods]
impl PyStateDerivative {
    /// Derivative of the contact radius.
    #[getter]
    fn radius<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.each(py, 0)
    }

    /// Derivative of the load.
    #[getter]
    fn load<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.each(py, 1)
    }

    /// Derivative of the approach.
    #[getter]
    fn approach<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.each(py, 2)
    }

    /// Derivative of the stiffness.
    #[getter]
    fn stiffness<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.each(py, 3)
    }

    /// Derivative of the radius up to which the surfaces attract each other: that of the contact but for Maugis's adhesion.
    #[getter]
    fn outer_radius<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.each(py, 4)
    }

    /// Derivative of the pressure at distances r from the axis [m], 0 outside of the contact. Its shape is that of the state
    /// followed by that of r.
    fn pressure<'py>(&self, r: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let (variable, held) = (self.variable, self.held);
        field(r, &self.points, &self.shape, move |point, r| {
            point.derivative(variable, held)?.pressure(r)
        })
    }

    /// Derivative of the displacement of both surfaces together at distances r from the axis [m].
    fn displacement<'py>(&self, r: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let (variable, held) = (self.variable, self.held);
        field(r, &self.points, &self.shape, move |point, r| {
            point.derivative(variable, held)?.displacement(r)
        })
    }
}
