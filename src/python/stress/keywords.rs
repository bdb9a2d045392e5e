//! Keyword arguments of the evaluations of stress: the meaning of each.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::model::body::{HalfSpace, Layer, Substrate};
use crate::python::arguments::keywords::Keywords;
use crate::python::arguments::{Pair, Real, Repr, real_array};
use crate::python::background;
use crate::stress::{Section, Strengths, StressOptions, StressProgress};

/// Puts section, side and displacement into the options; returns whether x and y were given.
pub(super) fn section(keywords: &Keywords, options: &mut StressOptions) -> PyResult<[bool; 2]> {
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
pub(super) fn options(keywords: &Keywords, body: &HalfSpace) -> PyResult<StressOptions> {
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
pub(super) fn strengths(keywords: &Keywords, body: &HalfSpace) -> PyResult<Strengths> {
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
pub(super) fn depths(z: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, bool)> {
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
pub(super) fn watched<R: Send + 'static>(
    py: Python<'_>,
    callback: Option<Py<PyAny>>,
    work: impl FnOnce(&mut StressProgress) -> crate::Result<R> + Send + 'static,
) -> PyResult<R> {
    let result =
        background::run(py, callback, move |caller| work(&mut |part: f64| caller.ask(|| (part,))))?;
    Ok(result?)
}
