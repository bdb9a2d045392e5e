//! What arrays of other libraries hold beside their numbers: units, dimensions and coordinates.

use std::f64::consts::PI;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyInt;

/// Units of arrays, as text, and their size in SI.
const UNITS: [(&str, f64); 33] = [
    ("", 1.0),
    ("1", 1.0),
    ("dimensionless", 1.0),
    ("m", 1.0),
    ("m²", 1.0),
    ("1/m", 1.0),
    ("N", 1.0),
    ("N m", 1.0),
    ("N/m", 1.0),
    ("m/N", 1.0),
    ("Pa", 1.0),
    ("m/Pa", 1.0),
    ("J", 1.0),
    ("J/m", 1.0),
    ("J/m²", 1.0),
    ("s", 1.0),
    ("m/s", 1.0),
    ("rad", 1.0),
    ("radian", 1.0),
    ("mrad", 1e-3),
    ("milliradian", 1e-3),
    ("µrad", 1e-6),
    ("urad", 1e-6),
    ("microradian", 1e-6),
    ("°", DEGREE),
    ("deg", DEGREE),
    ("degree", DEGREE),
    ("degrees", DEGREE),
    ("%", 1e-2),
    ("percent", 1e-2),
    ("‰", 1e-3),
    ("permille", 1e-3),
    ("ppm", 1e-6),
];
const DEGREE: f64 = PI / 180.0;

/// The numbers of `object` in SI: itself where it has no unit, and `None` where its unit is none of SI and no ratio.
/// Units are those of pint, astropy, unyt, quantities or xarray.
pub(super) fn in_si<'py>(object: &Bound<'py, PyAny>) -> PyResult<Option<Bound<'py, PyAny>>> {
    let same = Ok(Some(object.clone()));
    if object.is_exact_instance_of::<PyInt>() {
        return same;
    }
    let base = object.getattr_opt("to_base_units")?;
    if base.is_some() || object.hasattr("magnitude")? {
        // Of pint: a ratio may be in percent or degrees, and only in base units it is in 1.
        let ratio = object.getattr_opt("dimensionless")?;
        let ratio = ratio.is_some_and(|is| is.is_truthy().unwrap_or(false));
        return match base.filter(|_| ratio) {
            Some(base) => Ok(Some(base.call0()?.getattr("magnitude")?)),
            None => Ok(None),
        };
    }
    let unit = match object.getattr_opt("unit")? {
        Some(unit) if !unit.is_none() => Some(unit),
        _ => object.getattr_opt("units")?,
    };
    let Some(unit) = unit.filter(|unit| !unit.is_none() && !unit.is_callable()) else {
        return same;
    };
    let unit = unit.str()?.to_string();
    match UNITS.iter().find(|(name, _)| *name == unit.trim()) {
        Some((_, 1.0)) => same,
        Some((_, size)) => object.mul(size).map(Some),
        None => Ok(None),
    }
}

/// Names of the dimensions of an array with labels.
pub(super) fn axes(object: &Bound<'_, PyAny>) -> PyResult<Option<Vec<String>>> {
    match object.getattr_opt("dims")? {
        Some(axes) if object.hasattr("values")? => {
            let axes = axes.try_iter()?.map(|axis| Ok(axis?.str()?.to_string()));
            Ok(Some(axes.collect::<PyResult<_>>()?))
        }
        _ => Ok(None),
    }
}

/// Coordinates of one dimension of an array with labels.
pub(in crate::python) struct Coordinate<'py> {
    axis: String,
    places: Vec<f64>,
    /// Whether they number the samples.
    counts: bool,
    unit: Option<Bound<'py, PyAny>>,
}

/// Largest distance of a sample from its place at equal distances, in steps. Coordinates of two digits a step are within it.
const IRREGULAR: f64 = 0.05;

/// Relative rounding of a spacing that is written with seven digits, or in single precision.
const ROUNDED: f64 = 1e-6;

impl<'py> Coordinate<'py> {
    /// Coordinates of the dimension `axis` of `object`; `None` where it has no numbers.
    pub(super) fn of(object: &Bound<'py, PyAny>, axis: &str) -> PyResult<Option<Self>> {
        let Some(all) = object.getattr_opt("coords")? else {
            return Ok(None);
        };
        if !all.contains(axis)? {
            return Ok(None);
        }
        let labels = all.get_item(axis)?;
        let values = labels.getattr("values")?;
        let kind: String = values.getattr("dtype")?.getattr("kind")?.extract()?;
        if !["i", "u", "f"].contains(&kind.as_str()) {
            return Ok(None);
        }
        let places: Vec<f64> = values.call_method0("tolist")?.extract()?;
        let steps = || places.windows(2).map(|pair| pair[1] - pair[0]);
        let counts = kind != "f" && steps().all(|step| (step - 1.0).abs() < 0.5);
        let unit = match labels.getattr_opt("unit")? {
            Some(unit) => Some(unit),
            None => labels.getattr_opt("units")?,
        };
        Ok(Some(Self { axis: axis.into(), places, counts, unit }))
    }

    /// Those of both dimensions of a map, along x and along y.
    pub(in crate::python) fn both(object: &Bound<'py, PyAny>) -> PyResult<[Option<Self>; 2]> {
        match axes(object)?.as_deref() {
            Some([first, second]) => {
                let both = [Self::of(object, first)?, Self::of(object, second)?];
                let [one, other] = both;
                let turned = first.to_lowercase() == "y" && second.to_lowercase() == "x";
                Ok(if turned { [other, one] } else { [one, other] })
            }
            _ => Ok([None, None]),
        }
    }

    /// An error unless each coordinate is above the one before.
    pub(super) fn check_ascending(&self, name: &str) -> PyResult<()> {
        match self.places.windows(2).find(|pair| pair[0].is_nan() || pair[1] <= pair[0]) {
            Some(pair) => Err(PyValueError::new_err(format!(
                "{name} must have ascending coordinates {}, got {} before {}: sort it, as by sortby(\"{}\")",
                self.axis, pair[0], pair[1], self.axis
            ))),
            None => Ok(()),
        }
    }

    /// An error unless the samples of `name` lie at distances of `spacing` \[m\], in metres or in the unit of the coordinates.
    pub(in crate::python) fn check_spacing(&self, name: &str, spacing: f64) -> PyResult<()> {
        self.check_ascending(name)?;
        let ([first, .., last], false) = (&self.places[..], self.counts) else {
            return Ok(());
        };
        let steps = (self.places.len() - 1) as f64;
        let step = (last - first) / steps;
        let off = |(k, place): (usize, &f64)| ((place - first) / step - k as f64).abs();
        let off = self.places.iter().enumerate().map(off).fold(0.0, f64::max);
        if off > IRREGULAR {
            return Err(PyValueError::new_err(format!(
                "{name} must have coordinates {} at equal distances, got one {off:.2} steps off: interpolate it",
                self.axis
            )));
        }
        let size = match &self.unit {
            Some(unit) => {
                let units = unit.py().import("nacre._tools.text")?;
                let known = units.call_method1("unit_of", (unit.str()?,))?;
                known.extract::<Option<(String, f64)>>()?.map_or(1.0, |(_, size)| size)
            }
            None => 1.0,
        };
        // Coordinates that are rounded are off by as much at both ends.
        let tolerance = ROUNDED + 2.0 * off / steps;
        if [1.0, size].iter().any(|size| (step * size / spacing - 1.0).abs() <= tolerance) {
            return Ok(());
        }
        Err(PyValueError::new_err(format!(
            "spacing along {} must be that of the coordinates of {name}, {}, got {spacing}",
            self.axis,
            step * size
        )))
    }
}
