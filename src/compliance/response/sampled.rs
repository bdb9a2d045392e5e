//! A body of which values of its response are known: measured, published, or those of any function.

use std::fmt;

use super::{Asymptotes, Response, check};
use crate::error::{Error, Result, not_negative};

/// Samples per unit of ln α. The exact coefficients sample no closer, and at these places.
const DENSITY: usize = 320;

/// Number of samples on either side of α = 1: wavenumbers from 1e-25 to 1e25.
const REACH: usize = 58 * DENSITY;

/// Number of samples.
const COUNT: usize = 2 * REACH + 1;

/// Number of samples that one polynomial interpolates: its error is rounding where the response is smooth.
const STENCIL: usize = 6;

/// Change over the last unit of ln α, relative to the largest value, below which α û/p̂ has reached a limit.
const SETTLED: f64 = 1e-8;

/// Change of α û/p̂, relative to the largest value, that is rounding.
const ROUNDING: f64 = 1e-12;

/// A body by the values of its response û_z/p̂ at the wavenumbers [`Sampled::wavenumbers`].
///
/// Limits and lengths follow from the values. The response must behave as long/α or as a constant at long waves, and as
/// short/α, as a constant (springs) or less at short ones, and reach these limits about as α^{±1/2} or faster.
///
/// ```
/// use nacre::response::{Response, Sampled};
/// // Pasternak's foundation of stiffness 2 Pa/m and shear stiffness 8 N/m.
/// let values = Sampled::wavenumbers().map(|alpha| 1.0 / (2.0 + 8.0 * alpha * alpha)).collect();
/// let body = Sampled::new(values, 0.0)?;
/// assert!((body.normal(0.3) / (0.3 / (2.0 + 8.0 * 0.09)) - 1.0).abs() < 1e-13);
/// assert!((body.asymptotes().constant - 0.5).abs() < 1e-13);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Clone, PartialEq)]
pub struct Sampled {
    values: Vec<f64>,
    /// Local compliance beside the values.
    beside: f64,
    /// Local compliance in which the values end at short waves.
    springs: f64,
    /// α û/p̂ without the springs.
    normal: Vec<f64>,
    limits: Asymptotes,
    lengths: Option<[f64; 2]>,
}

impl Sampled {
    /// Wavenumbers α \[1/m\] of the values, ascending.
    pub fn wavenumbers() -> impl ExactSizeIterator<Item = f64> {
        (0..COUNT).map(wavenumber)
    }

    /// The body with these values of û_z/p̂ \[m/Pa\], and a local compliance beside them \[m/Pa\].
    ///
    /// # Errors
    /// Values that are not finite or below 0, another number of them than of wavenumbers, a response that is 0 or reaches
    /// no limit; a local compliance below 0.
    pub fn new(values: Vec<f64>, local: f64) -> Result<Self> {
        not_negative("local", local)?;
        if values.len() != COUNT {
            return Err(Error::Shape {
                name: "values",
                expected: [COUNT, 1],
                found: [values.len(), 1],
            });
        }
        let refuse = |n: usize, value| Error::NoCompliance { value, wavenumber: wavenumber(n) };
        if let Some(n) = values.iter().position(|value| !(value.is_finite() && *value >= 0.0)) {
            return Err(refuse(n, values[n]));
        }
        let springs = springs(&values);
        if values.iter().all(|value| *value <= 0.0) && local <= 0.0 {
            return Err(refuse(REACH, 0.0));
        }
        let normal = without(&values, springs);
        let size = largest_distance(&normal, 0.0);
        // Where the rest is lost in the rounding of the springs, it must have vanished.
        let last = normal.iter().rposition(|value| value.abs() > 0.0);
        if last.is_some_and(|n| wavenumber(n) * rounding(springs) > 1e-7 * size) {
            return Err(Error::HiddenBySprings);
        }
        let (limits, lengths) = limits(&normal, size)?;
        let response = Self { values, beside: local, springs, normal, limits, lengths };
        check(&response)?;
        Ok(response)
    }

    /// Values of û_z/p̂ \[m/Pa\] at the wavenumbers.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Local compliance \[m/Pa\] beside the values.
    pub fn beside(&self) -> f64 {
        self.beside
    }
}

/// The wavenumber of a sample.
fn wavenumber(n: usize) -> f64 {
    ((n as f64 - REACH as f64) / DENSITY as f64).exp()
}

/// The constant in which values end at short waves; 0 where they fall on.
fn springs(values: &[f64]) -> f64 {
    let (last, before) = (values[COUNT - 1], values[COUNT - 1 - DENSITY]);
    if (before - last).abs() <= 1e-6 * last { last } else { 0.0 }
}

/// Size of what is left of values that equal the constant of the springs.
fn rounding(springs: f64) -> f64 {
    4.0 * f64::EPSILON * springs
}

/// α û/p̂ of values without the springs.
fn without(values: &[f64], springs: f64) -> Vec<f64> {
    let rest = |(value, alpha): (&f64, f64)| match value - springs {
        rest if rest.abs() <= rounding(springs) => 0.0,
        rest => rest * alpha,
    };
    values.iter().zip(Sampled::wavenumbers()).map(rest).collect()
}

/// The largest distance of values from a limit.
fn largest_distance(values: &[f64], limit: f64) -> f64 {
    values.iter().map(|value| (value - limit).abs()).fold(0.0, f64::max)
}

/// Limits and lengths of α û/p̂, whose largest value is given.
fn limits(normal: &[f64], size: f64) -> Result<(Asymptotes, Option<[f64; 2]>)> {
    let limit = |end: usize, before: usize| {
        let limit = if normal[end].abs() <= SETTLED * size { 0.0 } else { normal[end] };
        let settled = (normal[before] - limit).abs() <= SETTLED * size;
        settled.then_some(limit).ok_or(Error::NoLimit { wavenumber: wavenumber(end) })
    };
    let (long, short) = (limit(0, DENSITY)?, limit(COUNT - 1, COUNT - 1 - DENSITY)?);
    if largest_distance(normal, long) <= ROUNDING * size {
        let middle = normal[REACH];
        return Ok((Asymptotes { long: middle, constant: 0.0, short: middle }, None));
    }
    // Where α û/p̂ has left a limit by a tenth of what it changes, or of the limit.
    let left = |limit: f64| {
        let scale = if limit > 0.0 { limit } else { size };
        let enough = 0.1 * largest_distance(normal, limit).min(scale);
        move |value: &f64| (value - limit).abs() > enough
    };
    let first = normal.iter().position(left(long)).unwrap_or(REACH);
    let last = normal.iter().rposition(left(short)).unwrap_or(REACH);
    let lengths = [first.max(last), first.min(last)].map(|n| 1.0 / wavenumber(n));
    // The next term at long waves, where those after it are small, and it is not lost beside long/α.
    let below = if long > 0.0 { 1e5_f64 } else { 1e8 };
    let n = first.min(last).saturating_sub((below.ln() * DENSITY as f64) as usize);
    let constant = (normal[n] - long) / wavenumber(n);
    Ok((Asymptotes { long, constant, short }, Some(lengths)))
}

impl Response for Sampled {
    fn normal(&self, alpha: f64) -> f64 {
        let place = alpha.ln() * DENSITY as f64 + REACH as f64;
        if self.lengths.is_none() || place <= 0.0 {
            return self.limits.long;
        }
        if place >= (COUNT - 1) as f64 {
            return self.limits.short;
        }
        let first = (place - 0.5 * (STENCIL - 1) as f64).ceil().max(0.0) as usize;
        let first = first.min(COUNT - STENCIL);
        let t = place - first as f64;
        let term = |k: usize| {
            let others = (0..STENCIL).filter(|j| *j != k).map(|j| j as f64);
            self.normal[first + k] * others.map(|j| (t - j) / (k as f64 - j)).product::<f64>()
        };
        (0..STENCIL).map(term).sum()
    }

    fn asymptotes(&self) -> Asymptotes {
        self.limits
    }

    fn lengths(&self) -> Option<[f64; 2]> {
        self.lengths
    }

    fn local(&self) -> f64 {
        self.beside + self.springs
    }
}

impl fmt::Debug for Sampled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (limits, lengths) = (self.limits, self.lengths);
        write!(f, "Sampled({limits:?}, lengths {lengths:?}, local {:?})", self.local())
    }
}
