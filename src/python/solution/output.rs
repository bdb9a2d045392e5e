//! Outputs of gradients, as Python names them.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::gradient::{Measure, Output, StressOutput, StressPlace};
use crate::python::arguments::Repr;
use crate::python::words::Word;
use crate::stress::{Member, Side};

/// Outputs that a word names.
const WORDS: [(&str, Output); 12] = [
    ("approach", Output::Approach),
    ("tilt[0]", Output::Tilt(0)),
    ("tilt[1]", Output::Tilt(1)),
    ("load", Output::Load),
    ("moment[0]", Output::Moment(0)),
    ("moment[1]", Output::Moment(1)),
    ("located_peak", Output::LocatedPeak),
    ("cell_peak", Output::CellPeak),
    ("participation_area", Output::ParticipationArea),
    ("area_estimate", Output::AreaEstimate),
    ("contact_area", Output::ContactArea),
    ("contact_extent", Output::ContactExtent),
];

/// Measures of a stress, by name.
const MEASURES: [(&str, Measure); 12] = [
    ("xx", Measure::Component(0)),
    ("yy", Measure::Component(1)),
    ("zz", Measure::Component(2)),
    ("xy", Measure::Component(3)),
    ("yz", Measure::Component(4)),
    ("xz", Measure::Component(5)),
    ("von_mises", Measure::VonMises),
    ("principal[0]", Measure::Principal(0)),
    ("principal[1]", Measure::Principal(1)),
    ("principal[2]", Measure::Principal(2)),
    ("max_shear", Measure::MaxShear),
    ("plane_shear", Measure::PlaneShear),
];

/// Sharpness of soft maxima, and depths in a layer, where none is given: the soft maximum is below the largest of 1e5
/// values by at most 6 % of it.
const SHARPNESS: f64 = 200.0;
const DEPTHS: usize = 9;

fn listed<T>(words: &[(&str, T)]) -> String {
    let words = words.iter().map(|(word, _)| format!("{word:?}"));
    words.collect::<Vec<_>>().join(", ")
}

/// Output that a Python object names.
pub(super) fn output(object: &Bound<'_, PyAny>) -> PyResult<Output> {
    if let Ok(word) = object.extract::<String>() {
        let found = WORDS.iter().find(|(one, _)| *one == word);
        return found.map(|(_, output)| output.clone()).ok_or_else(|| {
            PyValueError::new_err(format!(
                "output must be {}, a pair such as (\"pressure_norm\", 8.0), or a dict of a stress, got {word:?}",
                listed(&WORDS)
            ))
        });
    }
    if let Ok(table) = object.cast::<PyDict>() {
        return Ok(Output::Stress(stress(table)?));
    }
    let (word, value): (String, Bound<'_, PyAny>) = object.extract().map_err(|_| {
        PyTypeError::new_err(format!(
            "output must be a word, a pair or a dict, got {}",
            Repr(object)
        ))
    })?;
    Ok(match word.as_str() {
        "pressure_norm" => Output::PressureNorm(value.extract()?),
        "pressure" => Output::Pressure(value.extract::<(f64, f64)>()?.into()),
        "displacement" => Output::Displacement(value.extract::<(f64, f64)>()?.into()),
        "gap" => Output::Gap(value.extract::<(f64, f64)>()?.into()),
        _ => {
            return Err(PyValueError::new_err(format!(
                "output must be (\"pressure_norm\", r), (\"pressure\", (x, y)), (\"displacement\", (x, y)) or \
                 (\"gap\", (x, y)), got {}",
                Repr(object)
            )));
        }
    })
}

/// Stress that a dict names.
fn stress(table: &Bound<'_, PyDict>) -> PyResult<StressOutput> {
    const KEYS: [&str; 10] = [
        "stress",
        "at",
        "layer",
        "interface",
        "depths",
        "sharpness",
        "side",
        "body",
        "friction",
        "direction",
    ];
    for key in table.keys() {
        let key: String = key.extract()?;
        if !KEYS.contains(&key.as_str()) {
            return Err(PyValueError::new_err(format!(
                "keys of a stress are {}, got {key:?}",
                KEYS.join(", ")
            )));
        }
    }
    let word: String = table
        .get_item("stress")?
        .ok_or_else(|| PyValueError::new_err("a stress must have the key \"stress\""))?
        .extract()?;
    let measure = MEASURES.iter().find(|(one, _)| *one == word);
    let measure = measure.map(|(_, measure)| *measure).ok_or_else(|| {
        PyValueError::new_err(format!("stress must be {}, got {word:?}", listed(&MEASURES)))
    })?;
    let side = match table.get_item("side")? {
        Some(word) => Side::from_word(&word.extract::<String>()?)?,
        None => Side::Below,
    };
    let sharpness = match table.get_item("sharpness")? {
        Some(value) => value.extract()?,
        None => SHARPNESS,
    };
    let [at, layer, interface] = ["at", "layer", "interface"].map(|key| table.get_item(key));
    let place = match (at?, layer?, interface?) {
        (Some(at), None, None) => {
            let (x, y, z) = at.extract()?;
            StressPlace::Point([x, y, z], side)
        }
        (None, Some(layer), None) => StressPlace::Layer {
            layer: layer.extract()?,
            depths: table.get_item("depths")?.map_or(Ok(DEPTHS), |depths| depths.extract())?,
            sharpness,
        },
        (None, None, Some(interface)) => {
            StressPlace::Interface { interface: interface.extract()?, side, sharpness }
        }
        _ => {
            return Err(PyValueError::new_err(
                "a stress must have exactly one of the keys \"at\", \"layer\" and \"interface\"",
            ));
        }
    };
    Ok(StressOutput {
        member: match table.get_item("body")? {
            Some(word) => Member::from_word(&word.extract::<String>()?)?,
            None => Member::Body,
        },
        friction: table.get_item("friction")?.map_or(Ok(0.0), |friction| friction.extract())?,
        direction: table
            .get_item("direction")?
            .map(|direction| direction.extract::<(f64, f64)>())
            .transpose()?
            .map(Into::into),
        measure,
        place,
    })
}

/// Name of an output.
pub(super) fn name(output: &Output) -> String {
    if let Some((word, _)) = WORDS.iter().find(|(_, one)| one == output) {
        return (*word).to_owned();
    }
    let at = |word: &str, [x, y]: [f64; 2]| format!("{word} at ({x}, {y})");
    match output {
        Output::PressureNorm(r) => format!("pressure_norm {r}"),
        Output::Pressure(point) => at("pressure", *point),
        Output::Displacement(point) => at("displacement", *point),
        Output::Gap(point) => at("gap", *point),
        Output::Stress(stress) => {
            let measure = MEASURES.iter().find(|(_, one)| *one == stress.measure);
            let word = measure.map_or("stress", |(word, _)| word);
            match stress.place {
                StressPlace::Point([x, y, z], _) => format!("{word} at ({x}, {y}, {z})"),
                StressPlace::Layer { layer, .. } => format!("{word} in layer {layer}"),
                StressPlace::Interface { interface, .. } => {
                    format!("{word} at interface {interface}")
                }
            }
        }
        _ => "weighted pressure".to_owned(),
    }
}
