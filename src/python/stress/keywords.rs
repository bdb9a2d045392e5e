//! Keyword arguments of the evaluations of stress: signature, documentation and meaning of each.

use std::ffi::CString;

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::model::body::{HalfSpace, Layer, Substrate};
use crate::python::arguments::keywords::Keywords;
use crate::python::arguments::{Pair, Real, Repr, real_array};
use crate::python::background;
use crate::python::errors::NacreWarning;
use crate::stress::{Section, Strengths, StressOptions, StressProgress};

/// Signature of the keywords that say which fields are evaluated, and where.
macro_rules! section_signature {
    () => {
        "side='below', x=None, y=None, displacement=False"
    };
}

/// Documentation of the keywords of `section_signature`.
macro_rules! section_docs {
    () => {
        "\
side : {\"below\", \"above\"}, optional
    Side of an interface, for a depth that lies on one.
x, y : float, optional
    Place of a vertical section. With one of them, the fields are kept on the line ``x = const`` or
    ``y = const`` at every depth, by linear interpolation between cell centres and free ends; with both, at
    a point.
displacement : bool, optional
    Whether displacements are evaluated too."
    };
}

/// Signature of the keywords that say what acts beside the pressure.
macro_rules! traction_signature {
    () => {
        "friction=0.0, direction=None, residual=None"
    };
}

/// Documentation of the keywords of `traction_signature`.
macro_rules! traction_docs {
    () => {
        "\
friction : float, optional
    Coefficient of friction: adds the traction ``friction * pressure``.
direction : tuple of float, optional
    Direction ``(x, y)`` of the traction on the body, of any length; the traction on the counterbody is
    opposite. By default the direction in which the shape rolls, `Report.rolling_direction`: across
    the axis of a roller or cylinder, and across the strips of a line contact. For other shapes it
    must be given where `friction` is above 0.
residual : dict or sequence, optional
    Residual stress [Pa], equal along x and y, that is added in a layer. A dict maps layers to
    it, by number (0 at the surface) or name, and ``\"substrate\"``; a sequence holds it from the
    surface down."
    };
}

/// Signature of the keywords that say what a summary compares with.
macro_rules! strength_signature {
    () => {
        "yield_stress=None, strength=None"
    };
}

/// Documentation of the keywords of `strength_signature`.
macro_rules! strength_docs {
    () => {
        "\
yield_stress : dict or sequence, optional
    Yield stress [Pa] of layers. A dict maps layers to it, by number (0 at the surface) or name, and
    ``\"substrate\"``; a sequence holds it from the surface down, with None where it is not known.
strength : dict or sequence, optional
    Tensile strength [Pa] of layers, likewise."
    };
}

/// Signature of the keywords that say how an evaluation runs.
macro_rules! run_signature {
    () => {
        "threads=None, progress=None"
    };
}

/// Documentation of the keyword `threads`.
macro_rules! threads_docs {
    () => {
        "\
threads : int, optional
    Number of threads; all of the machine's by default."
    };
}

/// Documentation of the keyword `progress`.
macro_rules! progress_docs {
    () => {
        "\
progress : callable, optional
    Function that is called with the part of the work that is done, from 0 to 1; returning False
    stops, and gives the depths that are done."
    };
}

pub(in crate::python) use {
    progress_docs, run_signature, section_docs, section_signature, strength_docs,
    strength_signature, threads_docs, traction_docs, traction_signature,
};

/// Puts section, side and displacement into the options; returns whether x and y were given.
pub(in crate::python) fn section(
    keywords: &Keywords,
    options: &mut StressOptions,
) -> PyResult<[bool; 2]> {
    options.side = keywords.word("below")?;
    let (x, y) = (keywords.optional_real("x")?, keywords.optional_real("y")?);
    options.section = match (x, y) {
        (None, None) => Section::Plane,
        (Some(x), None) => Section::X(x),
        (None, Some(y)) => Section::Y(y),
        (Some(x), Some(y)) => Section::Axis([x, y]),
    };
    options.displacement = keywords.flag("displacement", false)?;
    Ok([x.is_some(), y.is_some()])
}

/// Options with friction and residual stress.
pub(in crate::python) fn options(keywords: &Keywords, body: &HalfSpace) -> PyResult<StressOptions> {
    let direction = keywords.given("direction")?.map(|value| match value.extract::<Pair>() {
        Ok(pair) => Ok(pair.0),
        Err(_) => {
            let got = Repr(&value);
            let message = format!("direction must be a pair of numbers, got {got}");
            Err(PyTypeError::new_err(message))
        }
    });
    let residual = by_layer(keywords, "residual", body)?;
    Ok(StressOptions {
        friction: keywords.real("friction", 0.0)?,
        direction: direction.transpose()?,
        residual: residual.into_iter().map(|s| s.unwrap_or(0.0)).collect(),
        ..StressOptions::default()
    })
}

/// Yield stresses and strengths.
pub(in crate::python) fn strengths(keywords: &Keywords, body: &HalfSpace) -> PyResult<Strengths> {
    Ok(Strengths {
        yield_stress: by_layer(keywords, "yield_stress", body)?,
        strength: by_layer(keywords, "strength", body)?,
    })
}

/// Values of some layers, from the surface down and the substrate last. The argument is a sequence of
/// them, or a dict from layers, by number or name, and "substrate". A name stands for all layers that
/// have it.
fn by_layer(keywords: &Keywords, name: &str, body: &HalfSpace) -> PyResult<Vec<Option<f64>>> {
    let Some(given) = keywords.given(name)? else {
        return Ok(Vec::new());
    };
    let layers = body.layers().len();
    let count = layers + usize::from(body.substrate() != Substrate::Rigid);
    let number = |value: &Bound<'_, PyAny>| match value.extract::<Real>() {
        Ok(number) => Ok(number.0),
        Err(_) => {
            Err(PyTypeError::new_err(format!("{name} must hold real numbers, got {}", Repr(value))))
        }
    };
    let Ok(mapping) = given.cast::<PyDict>() else {
        let values: Vec<Option<Real>> = given.extract().map_err(|_| {
            PyTypeError::new_err(format!(
                "{name} must be a dict from layers to numbers, or a sequence of them, got {}",
                Repr(&given)
            ))
        })?;
        if values.len() > count {
            return Err(PyValueError::new_err(format!(
                "{name} must hold at most {count} values, one for each layer and the substrate, \
                 got {}",
                values.len()
            )));
        }
        return Ok(values.iter().map(|value| value.map(|v| v.0)).collect());
    };
    let mut values = vec![None; count];
    for (key, value) in mapping {
        let is_meant = |layer: usize| match key.extract::<String>() {
            Ok(word) if layer == layers => word == "substrate",
            Ok(word) => body.layers()[layer].name() == Some(&word),
            Err(_) => key.extract().is_ok_and(|number: usize| number == layer),
        };
        let meant: Vec<_> = (0..count).filter(|layer| is_meant(*layer)).collect();
        if meant.is_empty() {
            return Err(PyValueError::new_err(format!(
                "keys of {name} must be \"substrate\" (where it is elastic), numbers of layers from 0 \
                 at the surface to {}, or names of layers ({}), got {}",
                count - 1,
                names(body),
                Repr(&key)
            )));
        }
        let value = number(&value)?;
        for layer in meant {
            values[layer] = Some(value);
        }
    }
    Ok(values)
}

/// Names of the layers of a body, for a message.
fn names(body: &HalfSpace) -> String {
    let names: Vec<_> = body.layers().iter().filter_map(Layer::name).collect();
    match names.is_empty() {
        true => "here they have none".into(),
        false => names.join(", "),
    }
}

/// Depths, and whether the argument was a single number.
pub(in crate::python) fn depths(z: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, bool)> {
    let values = real_array("z", z)?;
    if values.ndim() > 1 {
        return Err(PyValueError::new_err(format!(
            "z must be a depth or a sequence of depths, got shape {:?}",
            values.shape()
        )));
    }
    Ok((values.iter().copied().collect(), values.ndim() == 0))
}

/// Runs `work` in the background; Ctrl-C and the callback can stop it.
pub(in crate::python) fn watched<R: Send + 'static>(
    py: Python<'_>,
    callback: Option<Py<PyAny>>,
    work: impl FnOnce(&mut StressProgress) -> crate::Result<R> + Send + 'static,
) -> PyResult<R> {
    let result =
        background::run(py, callback, move |caller| work(&mut |part: f64| caller.ask(|| (part,))))?;
    Ok(result?)
}

/// Issues each message as a `nacre.NacreWarning`.
pub(in crate::python) fn issue_warnings(py: Python<'_>, messages: Vec<String>) -> PyResult<()> {
    let category = py.get_type::<NacreWarning>();
    let issue = |text: String| {
        let text = CString::new(text).unwrap_or_default();
        PyErr::warn(py, &category, &text, 1)
    };
    messages.into_iter().try_for_each(issue)
}
