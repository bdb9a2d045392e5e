//! Indentation: the classes of tips and adhesion, and the handles that `nacre.indent.solution` is around.

use ndarray::{Array1, Array2, ArrayD};
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::arguments::{Real, read_only, real_array, shaped, word};
use super::background::{self, Caller};
use super::bodies::{PyHalfSpace, half_space};
use crate::Result;
use crate::compliance::response::Body;
use crate::indent::{
    Adhesion, Branch, Control, Held, Indent, IndentParameter, IndentWarning, InteriorStress, Point,
    Stack, TipParameter, Variable,
};

mod adhesion;
mod tip;

pub(super) use adhesion::PyAdhesion;
pub(super) use tip::{PyTip, slope_of};

/// An axisymmetric tip on a stack of layers, planned.
#[pyclass(name = "Indentation", module = "nacre._core", frozen)]
pub(super) struct PyIndentation {
    indent: Indent,
    body: crate::HalfSpace,
    counterbody: Option<crate::HalfSpace>,
    parameters: Parameters,
}

/// Paths of parameters, and the parameters.
type Parameters = Vec<(String, IndentParameter)>;

/// Result of one piece of work, during which Ctrl-C is seen.
fn one<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T> + Send + 'static,
) -> PyResult<T> {
    Ok(background::run(py, None, move |_: &mut Caller<()>| work())??)
}

/// Results of `work` on each of the items, on a thread of its own, so that Ctrl-C is seen at once; the work ends before its
/// next item then. `progress` is told the number of finished items and of all.
fn worked<I: Send + 'static, T: Send + 'static>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    items: Vec<I>,
    work: impl Fn(&I) -> Result<T> + Send + 'static,
) -> PyResult<Vec<T>> {
    let results = background::run(
        py,
        progress,
        move |caller: &mut Caller<(usize, usize)>| -> Result<Vec<T>> {
            let mut results = Vec::with_capacity(items.len());
            for item in &items {
                if caller.go_on().is_break() {
                    break;
                }
                results.push(work(item)?);
                caller.tell(|| (results.len(), items.len()));
            }
            Ok(results)
        },
    )?;
    Ok(results?)
}

/// Names of all parameters, with what they are.
fn named(indent: &Indent) -> Parameters {
    let mut all = Vec::new();
    for parameter in indent.stack().parameters() {
        if let IndentParameter::Body(number, own) = parameter {
            let owner = if *number == 0 { "body" } else { "counterbody" };
            let body = indent.stack().bodies()[*number].half_space();
            let path = body.map_or(String::new(), |body| own.path(body));
            all.push((format!("{owner}.{path}"), *parameter));
        }
    }
    let is_sampled = indent.tip().numbers().iter().any(|(name, _)| *name == "depth");
    if !is_sampled {
        for (k, (name, _)) in indent.tip().numbers().into_iter().enumerate() {
            let parameter = IndentParameter::Tip(TipParameter::Number(k));
            all.push((format!("tip.{name}"), parameter));
        }
    }
    all.push(("tip.area".to_owned(), IndentParameter::Tip(TipParameter::Area)));
    if indent.adhesion().work().is_some() {
        all.push(("adhesion.work".to_owned(), IndentParameter::Work));
    }
    if matches!(indent.adhesion(), Adhesion::Maugis { .. }) {
        all.push(("adhesion.strength".to_owned(), IndentParameter::Strength));
    }
    all
}

/// Parameters of these paths.
fn chosen(known: &Parameters, paths: Vec<String>) -> PyResult<Vec<IndentParameter>> {
    let find = |path: String| {
        let entry = known.iter().find(|(own, _)| *own == path);
        entry.map(|(_, parameter)| *parameter).ok_or_else(|| {
            let all: Vec<&str> = known.iter().map(|(path, _)| path.as_str()).collect();
            PyValueError::new_err(format!(
                "wrt must be paths among {}, got {path:?}",
                all.join(", ")
            ))
        })
    };
    paths.into_iter().map(find).collect()
}

/// Sentences of the worst warning of all points.
fn worst(warnings: impl IntoIterator<Item = IndentWarning>) -> Vec<String> {
    let slope = |warning: &IndentWarning| match warning {
        IndentWarning::Steep { slope } => *slope,
    };
    let worst = warnings.into_iter().max_by(|a, b| slope(a).total_cmp(&slope(b)));
    worst.iter().map(ToString::to_string).collect()
}

/// Approaches, loads, radii, slopes, derivatives by parameter, and warnings of a curve.
type CurveParts<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
    Vec<String>,
);

#[pymethods]
impl PyIndentation {
    #[new]
    fn new(
        #[pyo3(from_py_with = half_space)] body: crate::HalfSpace,
        tip: PyTip,
        counterbody: Option<&Bound<'_, PyAny>>,
        adhesion: Option<PyAdhesion>,
    ) -> PyResult<Self> {
        let counterbody = counterbody.map(half_space).transpose()?;
        let bodies: Vec<Body> =
            std::iter::once(&body).chain(&counterbody).map(Body::from).collect();
        let stack = Stack::plan(&bodies)?;
        let adhesion = adhesion.map_or(Adhesion::None, |a| a.0);
        let indent = Indent::new(&stack, &tip.0).with_adhesion(adhesion)?;
        let parameters = named(&indent);
        Ok(Self { indent, body, counterbody, parameters })
    }

    fn body(&self) -> PyHalfSpace {
        PyHalfSpace(self.body.clone())
    }

    fn counterbody(&self) -> Option<PyHalfSpace> {
        self.counterbody.clone().map(PyHalfSpace)
    }

    fn surface_modulus(&self) -> f64 {
        self.indent.stack().surface_modulus()
    }

    fn parameters(&self) -> Vec<String> {
        self.parameters.iter().map(|(path, _)| path.clone()).collect()
    }

    /// Contacts by load, approach or radius, whichever is given.
    #[pyo3(signature = (branch, *, load=None, approach=None, radius=None, progress=None))]
    fn at(
        &self,
        py: Python<'_>,
        branch: &str,
        load: Option<Bound<'_, PyAny>>,
        approach: Option<Bound<'_, PyAny>>,
        radius: Option<Bound<'_, PyAny>>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<PyIndentStates> {
        let branch: Branch = word("branch", branch)?;
        let all = [
            ("load", load, Held::Load),
            ("approach", approach, Held::Approach),
            ("radius", radius, Held::Radius),
        ];
        let mut conditions = Vec::new();
        for (name, value, held) in all {
            if let Some(value) = value {
                conditions.push((held, real_array(name, &value)?));
            }
        }
        let (Some((held, values)), true) = (conditions.pop(), conditions.is_empty()) else {
            return Err(PyValueError::new_err(
                "exactly one of load, approach and radius must be given",
            ));
        };
        let shape = values.shape().to_vec();
        let indent = self.indent.clone();
        let points = worked(py, progress, values.into_iter().collect(), move |value| match held {
            Held::Load => indent.at(Control::Load, *value, branch),
            Held::Approach => indent.at(Control::Approach, *value, branch),
            Held::Radius => indent.at_radius(*value),
        })?;
        if points.is_empty() {
            return Err(PyValueError::new_err(
                "no load, approach or radius was given: the array is empty",
            ));
        }
        Ok(PyIndentStates { points, shape, held, parameters: self.parameters.clone() })
    }

    fn curve<'py>(
        &self,
        py: Python<'py>,
        approach: &Bound<'py, PyAny>,
        wrt: Vec<String>,
    ) -> PyResult<CurveParts<'py>> {
        let approach = real_array("approach", approach)?;
        if approach.ndim() != 1 {
            return Err(PyValueError::new_err(format!(
                "approach must have one dimension, got shape {:?}",
                approach.shape()
            )));
        }
        let approach: Vec<f64> = approach.into_iter().collect();
        let parameters = chosen(&self.parameters, wrt)?;
        let shape = (approach.len(), parameters.len());
        let (indent, at) = (self.indent.clone(), approach.clone());
        let curve = one(py, move || indent.curve(&at, &parameters))?;
        let rows: Vec<f64> = curve.derivatives.into_iter().flatten().collect();
        let derivatives = Array2::from_shape_vec(shape, rows);
        let derivatives = derivatives.map_err(|error| PyValueError::new_err(error.to_string()))?;
        let line = |values: Vec<f64>| read_only(py, Array1::from(values));
        Ok((
            line(approach)?,
            line(curve.load)?,
            line(curve.radius)?,
            line(curve.slope)?,
            read_only(py, derivatives)?,
            worst(curve.warnings),
        ))
    }

    /// Load, approach, contact radius and radius of attraction of the last stable state.
    fn pull_off(&self, py: Python<'_>, control: &str) -> PyResult<(f64, f64, f64, f64)> {
        let control: Control = word("control", control)?;
        let indent = self.indent.clone();
        let last = one(py, move || indent.pull_off(control))?;
        let outer = last.outer_radius.unwrap_or(last.radius);
        Ok((last.load, last.approach, last.radius, outer))
    }

    fn snap_in(&self, py: Python<'_>, control: &str) -> PyResult<PyIndentStates> {
        let control: Control = word("control", control)?;
        let indent = self.indent.clone();
        let point = one(py, move || indent.snap_in(control))?;
        let held = match control {
            Control::Load => Held::Load,
            Control::Approach => Held::Approach,
        };
        let parameters = self.parameters.clone();
        Ok(PyIndentStates { points: vec![point], shape: vec![], held, parameters })
    }

    fn work_from_pull_off(&self, py: Python<'_>, force: Real, control: &str) -> PyResult<f64> {
        let control: Control = word("control", control)?;
        let indent = self.indent.clone();
        one(py, move || indent.work_from_pull_off(force.0, control))
    }
}

/// Contacts of an indentation, in the shape of what was given.
#[pyclass(name = "IndentStates", module = "nacre._core", frozen)]
pub(super) struct PyIndentStates {
    points: Vec<Point>,
    shape: Vec<usize>,
    held: Held,
    parameters: Parameters,
}

type Five<'py> =
    (Bound<'py, PyAny>, Bound<'py, PyAny>, Bound<'py, PyAny>, Bound<'py, PyAny>, Bound<'py, PyAny>);

/// One number of a state of stress.
type Component = fn(&InteriorStress) -> f64;

impl PyIndentStates {
    /// Values of all points in the shape of the points, followed by `more`.
    fn shaped<'py>(
        &self,
        py: Python<'py>,
        values: Vec<f64>,
        more: &[usize],
    ) -> PyResult<Bound<'py, PyAny>> {
        let array = ArrayD::from_shape_vec([&self.shape, more].concat(), values);
        shaped(py, array.map_err(|error| PyValueError::new_err(error.to_string()))?)
    }

    fn variable(&self, path: &str) -> PyResult<Variable> {
        let parameters = chosen(&self.parameters, vec![path.to_owned()])?;
        Ok(Variable::Parameter(parameters[0]))
    }
}

#[pymethods]
impl PyIndentStates {
    /// Number of that name of each contact; the outer radius is that of the contact where nothing attracts beyond it.
    fn number<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let values = self.points.iter().map(|point| match name {
            "radius" => point.radius,
            "load" => point.load,
            "approach" => point.approach,
            "stiffness" => point.stiffness,
            "stiffness_slope" => point.stiffness_slope,
            _ => point.outer_radius.unwrap_or(point.radius),
        });
        self.shaped(py, values.collect(), &[])
    }

    fn warnings(&self) -> Vec<String> {
        worst(self.points.iter().flat_map(Point::warnings))
    }

    /// Pressure, displacement or gap at distances r, or its derivative with respect to a parameter.
    #[pyo3(signature = (name, r, wrt=None))]
    fn field<'py>(
        &self,
        name: String,
        r: &Bound<'py, PyAny>,
        wrt: Option<&str>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = r.py();
        let r = real_array("r", r)?;
        let more = r.shape().to_vec();
        let r: Vec<f64> = r.into_iter().collect();
        let (held, variable) = (self.held, wrt.map(|path| self.variable(path)).transpose()?);
        let all =
            worked(py, None, self.points.clone(), move |point| match (variable, name.as_str()) {
                (None, "pressure") => point.pressure(&r),
                (None, "displacement") => point.displacement(&r),
                (None, _) => point.gap(&r),
                (Some(variable), "pressure") => point.derivative(variable, held)?.pressure(&r),
                (Some(variable), _) => point.derivative(variable, held)?.displacement(&r),
            })?;
        self.shaped(py, all.into_iter().flatten().collect(), &more)
    }

    /// Components of the stress below the surface, by name.
    fn stress<'py>(
        &self,
        r: &Bound<'py, PyAny>,
        z: Real,
    ) -> PyResult<Vec<(&'static str, Bound<'py, PyAny>)>> {
        let of: [(&str, Component); 5] = [
            ("rr", |s| s.rr),
            ("tt", |s| s.tt),
            ("zz", |s| s.zz),
            ("rz", |s| s.rz),
            ("von_mises", InteriorStress::von_mises),
        ];
        let py = r.py();
        let r = real_array("r", r)?;
        let more = r.shape().to_vec();
        let r: Vec<f64> = r.into_iter().collect();
        let all = worked(py, None, self.points.clone(), move |point| point.stress(0, z.0, &r))?;
        let component = |(name, of): (&'static str, Component)| {
            Ok((name, self.shaped(py, all.iter().flatten().map(of).collect(), &more)?))
        };
        of.into_iter().map(component).collect()
    }

    fn parameters(&self) -> Vec<String> {
        self.parameters.iter().map(|(path, _)| path.clone()).collect()
    }

    /// Derivatives of radius, load, approach, stiffness and outer radius with respect to a parameter.
    fn derivatives<'py>(&self, py: Python<'py>, wrt: &str) -> PyResult<Five<'py>> {
        let (held, variable) = (self.held, self.variable(wrt)?);
        let values = worked(py, None, self.points.clone(), move |point| {
            let change = point.derivative(variable, held)?;
            let outer = change.outer_radius.unwrap_or(change.radius);
            Ok([change.radius, change.load, change.approach, change.stiffness, outer])
        })?;
        let of = |k: usize| self.shaped(py, values.iter().map(|one| one[k]).collect(), &[]);
        Ok((of(0)?, of(1)?, of(2)?, of(3)?, of(4)?))
    }
}
