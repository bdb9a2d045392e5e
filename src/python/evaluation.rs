//! Arguments that evaluations of stress share, and how they are run.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::arrays::{Repr, count, real_array};
use super::background;
use super::call::progress_callable;
use crate::body::{HalfSpace, Substrate};
use crate::error::Error;
use crate::stress::{Member, Section, Side, StressOptions, StressProgress};

pub(super) fn side_word(side: Side) -> &'static str {
    match side {
        Side::Above => "above",
        Side::Below => "below",
    }
}

pub(super) fn side(word: &str) -> PyResult<Side> {
    match word {
        "above" => Ok(Side::Above),
        "below" => Ok(Side::Below),
        other => Err(Error::Choice {
            name: "side",
            requirement: "\"above\" or \"below\"",
            value: other.into(),
        }
        .into()),
    }
}

/// The body of a solution by its name.
pub(super) fn member(word: &str) -> PyResult<Member> {
    match word {
        "body" => Ok(Member::Body),
        "counterbody" => Ok(Member::Counterbody),
        other => Err(Error::Choice {
            name: "body",
            requirement: "\"body\" or \"counterbody\"",
            value: other.into(),
        }
        .into()),
    }
}

/// Values of some layers: a sequence from the surface down, or a mapping from the number of a
/// layer, or "substrate".
pub(super) fn by_layer(
    name: &str,
    body: &HalfSpace,
    given: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<Option<f64>>> {
    let Some(given) = given else {
        return Ok(Vec::new());
    };
    let layers = body.layers().len();
    let count = layers + usize::from(body.substrate() != Substrate::Rigid);
    let number = |value: &Bound<'_, PyAny>| {
        value.extract::<f64>().map_err(|_| {
            PyTypeError::new_err(format!(
                "{name} must hold real numbers, got {}",
                Repr(value)
            ))
        })
    };
    let Ok(mapping) = given.cast::<PyDict>() else {
        let values: Vec<Option<f64>> = given.extract().map_err(|_| {
            PyTypeError::new_err(format!(
                "{name} must be a dict from layers to numbers, or a sequence of them, got {}",
                Repr(given)
            ))
        })?;
        if values.len() > count {
            return Err(PyValueError::new_err(format!(
                "{name} must hold at most {count} values, one for each layer and the substrate, \
                 got {}",
                values.len()
            )));
        }
        return Ok(values);
    };
    let mut values = vec![None; count];
    for (key, value) in mapping {
        let layer = match key.extract::<String>() {
            Ok(word) if word == "substrate" && count > layers => layers,
            Ok(_) => count,
            Err(_) => key.extract::<usize>().unwrap_or(count),
        };
        if layer >= count {
            return Err(PyValueError::new_err(format!(
                "keys of {name} must be \"substrate\" (where it is elastic) or numbers of layers \
                 from 0 at the surface to {}, got {}",
                count - 1,
                Repr(&key)
            )));
        }
        values[layer] = Some(number(&value)?);
    }
    Ok(values)
}

/// Keywords that all evaluations share.
pub(super) struct Keywords<'a, 'py> {
    pub(super) side: &'a str,
    pub(super) x: Option<f64>,
    pub(super) y: Option<f64>,
    pub(super) friction: f64,
    pub(super) direction: Option<(f64, f64)>,
    pub(super) residual: Option<&'a Bound<'py, PyAny>>,
    pub(super) displacement: bool,
    pub(super) threads: Option<&'a Bound<'py, PyAny>>,
}

impl Keywords<'_, '_> {
    pub(super) fn options(&self, body: &HalfSpace) -> PyResult<StressOptions> {
        let residual = by_layer("residual", body, self.residual)?;
        Ok(StressOptions {
            side: side(self.side)?,
            section: match (self.x, self.y) {
                (None, None) => Section::Plane,
                (Some(x), None) => Section::X(x),
                (None, Some(y)) => Section::Y(y),
                (Some(x), Some(y)) => Section::Axis([x, y]),
            },
            friction: self.friction,
            direction: self.direction.map_or([1.0, 0.0], Into::into),
            residual: residual.into_iter().map(|s| s.unwrap_or(0.0)).collect(),
            displacement: self.displacement,
            threads: self
                .threads
                .map(|threads| count("threads", 1, threads))
                .transpose()?,
        })
    }
}

/// Runs `work` in the background; it is interrupted by Ctrl-C, and by the callback.
pub(super) fn watched<R: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&mut StressProgress) -> crate::Result<R> + Send + 'static,
) -> PyResult<R> {
    let callback = progress_callable(progress)?;
    let result = background::run(py, callback, move |caller| {
        work(&mut |part: f64| caller.ask(|| (part,)))
    })?;
    Ok(result?)
}

/// Depths, and whether they were one number.
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
