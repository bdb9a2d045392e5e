//! `nacre.indent.Indentation`, and what it returns beside states.

use ndarray::{Array1, Array2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::super::super::arguments::{Real, read_only, real_array};
use super::super::super::background::{self, Caller};
use super::super::super::bodies::{PyHalfSpace, body};
use super::adhesion::PyAdhesion;
use super::results::{PyIndentCurve, PyPullOff};
use super::state::{PyIndentState, chosen, worked, worst};
use super::tip::PyTip;
use crate::Result;
use crate::compliance::response::Body;
use crate::indent::{
    Adhesion, Branch, Control, Held, Indent, IndentParameter, Stack, TipParameter,
};
use crate::python::errors::issue_warnings;

/// An axisymmetric tip on a stack of layers, planned once: exact, and without a grid.
///
/// Parameters
/// ----------
/// body : HalfSpace or Elastic
///     Body that is indented.
/// tip : Tip
///     Form of the tip.
/// counterbody : HalfSpace or Elastic, optional
///     Material of the tip; rigid by default.
/// adhesion : Adhesion, optional
///     Adhesion of the surfaces; none by default.
///
/// Raises
/// ------
/// ValueError
///     If a body has free ends, or the tip cannot have this adhesion.
///
/// Examples
/// --------
/// >>> glass, film = nacre.Elastic(70e9, 0.22), nacre.Elastic(3e9, 0.4)
/// >>> body = nacre.HalfSpace(glass, [nacre.Layer(film, thickness=1e-6)])
/// >>> test = nacre.indent.Indentation(body, nacre.indent.Tip.sphere(5e-6))
/// >>> state = test.at(load=1e-3)
/// >>> f"{state.approach * 1e9:.1f} nm, contact radius {state.radius * 1e9:.0f} nm"
/// '115.5 nm, contact radius 938 nm'
#[pyclass(name = "Indentation", module = "nacre.indent", frozen)]
pub(in crate::python) struct PyIndentation {
    indent: Indent,
    body: crate::HalfSpace,
    counterbody: Option<crate::HalfSpace>,
    parameters: Vec<(String, IndentParameter)>,
}

fn control(word: &str) -> PyResult<Control> {
    match word {
        "load" => Ok(Control::Load),
        "approach" => Ok(Control::Approach),
        _ => Err(PyValueError::new_err(format!(
            "control must be \"load\" or \"approach\", got {word:?}"
        ))),
    }
}

/// Result of one piece of work, during which Ctrl-C is seen.
fn one<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T> + Send + 'static,
) -> PyResult<T> {
    Ok(background::run(py, None, move |_: &mut Caller<()>| work())??)
}

/// Names of all parameters, with what they are.
fn named(indent: &Indent) -> Vec<(String, IndentParameter)> {
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

#[pymethods]
impl PyIndentation {
    #[new]
    #[pyo3(signature = (body, tip, counterbody=None, *, adhesion=None))]
    fn new(
        #[pyo3(from_py_with = body)] body: crate::HalfSpace,
        tip: PyTip,
        counterbody: Option<&Bound<'_, PyAny>>,
        adhesion: Option<PyAdhesion>,
    ) -> PyResult<Self> {
        let counterbody = counterbody.map(self::body).transpose()?;
        let bodies: Vec<Body> =
            std::iter::once(&body).chain(&counterbody).map(Body::from).collect();
        let stack = Stack::plan(&bodies)?;
        let adhesion = adhesion.map_or(crate::indent::Adhesion::None, |a| a.0);
        let indent = Indent::new(&stack, &tip.0).with_adhesion(adhesion)?;
        let parameters = named(&indent);
        Ok(Self { indent, body, counterbody, parameters })
    }

    /// Body that is indented.
    #[getter]
    fn body(&self) -> PyHalfSpace {
        PyHalfSpace(self.body.clone())
    }

    /// Material of the tip; None where it is rigid.
    #[getter]
    fn counterbody(&self) -> Option<PyHalfSpace> {
        self.counterbody.clone().map(PyHalfSpace)
    }

    /// Form of the tip.
    #[getter]
    fn tip(&self) -> PyTip {
        PyTip(self.indent.tip().clone())
    }

    /// Adhesion of the surfaces, or None.
    #[getter]
    fn adhesion(&self) -> Option<PyAdhesion> {
        let adhesion = self.indent.adhesion();
        adhesion.work().map(|_| PyAdhesion(adhesion))
    }

    /// Contact modulus E* at the surfaces [Pa], which small contacts feel.
    #[getter]
    fn surface_modulus(&self) -> f64 {
        self.indent.stack().surface_modulus()
    }

    /// Paths of the parameters with respect to which there are derivatives.
    #[getter]
    fn parameters(&self) -> Vec<String> {
        self.parameters.iter().map(|(path, _)| path.clone()).collect()
    }

    /// Contacts by load, approach or contact radius.
    ///
    /// Parameters
    /// ----------
    /// load, approach, radius : float or array_like
    ///     Loads [N], approaches [m] or contact radii [m] of any shape; exactly one of them.
    /// branch : {"stable", "unstable"}, optional
    ///     Branch of the curve where adhesion gives two contacts the same load or approach.
    ///
    /// Returns
    /// -------
    /// IndentState
    ///     Contacts in the shape of what was given.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If not exactly one is given, where nothing touches, where the contact would be larger than the tip or than 1024 times the
    ///     thickness of the top layer, and where it is a ring: pressure and gap of every state are checked.
    #[pyo3(signature = (*, load=None, approach=None, radius=None, branch="stable"))]
    fn at(
        &self,
        py: Python<'_>,
        load: Option<&Bound<'_, PyAny>>,
        approach: Option<&Bound<'_, PyAny>>,
        radius: Option<&Bound<'_, PyAny>>,
        branch: &str,
    ) -> PyResult<PyIndentState> {
        let branch = match branch {
            "stable" => Branch::Stable,
            "unstable" => Branch::Unstable,
            _ => {
                return Err(PyValueError::new_err(format!(
                    "branch must be \"stable\" or \"unstable\", got {branch:?}"
                )));
            }
        };
        let (held, values) = match (load, approach, radius) {
            (Some(load), None, None) => (Held::Load, real_array("load", load)?),
            (None, Some(approach), None) => (Held::Approach, real_array("approach", approach)?),
            (None, None, Some(radius)) => (Held::Radius, real_array("radius", radius)?),
            _ => {
                return Err(PyValueError::new_err(
                    "exactly one of load, approach and radius must be given",
                ));
            }
        };
        let shape = values.shape().to_vec();
        let indent = self.indent.clone();
        let points = worked(py, values.into_iter().collect(), move |value| match held {
            Held::Load => indent.at(Control::Load, *value, branch),
            Held::Approach => indent.at(Control::Approach, *value, branch),
            Held::Radius => indent.at_radius(*value),
        })?;
        if points.is_empty() {
            return Err(PyValueError::new_err(
                "no load, approach or radius was given: the array is empty",
            ));
        }
        let state = PyIndentState { points, shape, held, parameters: self.parameters.clone() };
        state.warned(py)
    }

    /// Loads at approaches with their derivatives, by interpolation in the contact radius with an error of 1e-9: for fits.
    ///
    /// Parameters
    /// ----------
    /// approach : array_like
    ///     Approaches [m], of one dimension.
    /// wrt : list of str, optional
    ///     Paths of parameters, as `parameters` lists them.
    ///
    /// Returns
    /// -------
    /// IndentCurve
    ///     Load, radius, slope and derivatives, all 0 where nothing touches.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the adhesion is Maugis's, the largest approach needs too large a contact, or a contact is a ring.
    #[pyo3(signature = (*, approach, wrt=vec![]))]
    fn curve(
        &self,
        py: Python<'_>,
        approach: &Bound<'_, PyAny>,
        wrt: Vec<String>,
    ) -> PyResult<PyIndentCurve> {
        let approach = real_array("approach", approach)?;
        if approach.ndim() != 1 {
            return Err(PyValueError::new_err(format!(
                "approach must have one dimension, got shape {:?}",
                approach.shape()
            )));
        }
        let approach: Vec<f64> = approach.into_iter().collect();
        let parameters = chosen(&self.parameters, Some(wrt))?.into_iter();
        let parameters: Vec<IndentParameter> = parameters.map(|(_, parameter)| parameter).collect();
        let count = parameters.len();
        let (indent, at) = (self.indent.clone(), approach.clone());
        let curve = one(py, move || indent.curve(&at, &parameters))?;
        let warnings = worst(curve.warnings);
        issue_warnings(py, warnings.clone())?;
        let rows: Vec<f64> = curve.derivatives.into_iter().flatten().collect();
        let derivatives = Array2::from_shape_vec((approach.len(), count), rows);
        let derivatives = derivatives.map_err(|error| PyValueError::new_err(error.to_string()))?;
        let line = |values: Vec<f64>| read_only(py, Array1::from(values)).map(Bound::unbind);
        Ok(PyIndentCurve {
            approach: line(approach)?,
            load: line(curve.load)?,
            radius: line(curve.radius)?,
            slope: line(curve.slope)?,
            derivatives: read_only(py, derivatives)?.unbind(),
            warnings,
        })
    }

    /// Last stable state of the tip as it is pulled off under a given load or a given approach.
    ///
    /// Parameters
    /// ----------
    /// control : {"load", "approach"}, optional
    ///     What is given while it is pulled.
    ///
    /// Returns
    /// -------
    /// PullOff
    ///     Load, approach and radii.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If there is no adhesion.
    ///
    /// Examples
    /// --------
    /// >>> test = nacre.indent.Indentation(
    /// ...     nacre.Elastic(1e6, 0.5), nacre.indent.Tip.paraboloid(1e-5), adhesion=nacre.indent.Adhesion.jkr(0.05)
    /// ... )
    /// >>> last = test.pull_off()
    /// >>> round(last.load / (-1.5 * 3.141592653589793 * 0.05 * 1e-5), 9)
    /// 1.0
    #[pyo3(signature = (control="load"))]
    fn pull_off(&self, py: Python<'_>, control: &str) -> PyResult<PyPullOff> {
        let control = self::control(control)?;
        let indent = self.indent.clone();
        let last = one(py, move || indent.pull_off(control))?;
        Ok(PyPullOff {
            load: last.load,
            approach: last.approach,
            radius: last.radius,
            outer_radius: last.outer_radius.unwrap_or(last.radius),
        })
    }

    /// State into which the tip jumps as it comes near, under no load (`control` "load") or at the approach at which the surfaces begin
    /// to attract each other ("approach"): 0 for JKR's adhesion, -work/strength for Maugis's.
    #[pyo3(signature = (control="load"))]
    fn snap_in(&self, py: Python<'_>, control: &str) -> PyResult<PyIndentState> {
        let control = self::control(control)?;
        let indent = self.indent.clone();
        let point = one(py, move || indent.snap_in(control))?;
        let state = PyIndentState {
            points: vec![point],
            shape: vec![],
            held: match control {
                Control::Load => Held::Load,
                Control::Approach => Held::Approach,
            },
            parameters: self.parameters.clone(),
        };
        state.warned(py)
    }

    /// Work of adhesion [J/m^2] from the force of pull-off [N], above 0, on this stack: of JKR's adhesion where this indentation has
    /// none, else of its own kind.
    #[pyo3(signature = (force, control="load"))]
    fn work_from_pull_off(&self, py: Python<'_>, force: Real, control: &str) -> PyResult<f64> {
        let control = self::control(control)?;
        let indent = self.indent.clone();
        one(py, move || indent.work_from_pull_off(force.0, control))
    }

    fn __repr__(&self) -> String {
        let mut text = format!("Indentation({}, {}", self.body().__repr__(), self.tip().__repr__());
        if let Some(counterbody) = self.counterbody() {
            text += &format!(", {}", counterbody.__repr__());
        }
        if let Some(adhesion) = self.adhesion() {
            text += &format!(", adhesion={}", adhesion.__repr__());
        }
        text + ")"
    }
}
