//! Axial profiles of rollers: the drop d(x) of the generatrix relative to the middle of the roller.

use std::sync::Arc;

use super::quadric::sagitta;
use super::sagitta_slope;
use crate::error::{Error, Result, positive, require};

mod logarithmic;

pub use logarithmic::{FujiwaraKawase, LogarithmicProfile};

/// Largest number of coordinates at which a search for the contact looks at a profile: within a thousandth of
/// its length a tilt changes little.
const MARKS: usize = 1024;

/// An axial profile of a roller.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Profile {
    /// A straight profile with rounded ends.
    Crowned(CrownedProfile),
    /// A logarithmic profile.
    Logarithmic(LogarithmicProfile),
    /// A measured profile.
    Sampled(SampledProfile),
}

impl From<CrownedProfile> for Profile {
    fn from(profile: CrownedProfile) -> Self {
        Self::Crowned(profile)
    }
}

impl From<LogarithmicProfile> for Profile {
    fn from(profile: LogarithmicProfile) -> Self {
        Self::Logarithmic(profile)
    }
}

impl From<SampledProfile> for Profile {
    fn from(profile: SampledProfile) -> Self {
        Self::Sampled(profile)
    }
}

impl Profile {
    /// Drop \[m\] at x \[m\]; +∞ beyond the ends.
    pub fn drop(&self, x: f64) -> f64 {
        match self {
            Self::Crowned(profile) => profile.drop(x),
            Self::Logarithmic(profile) => profile.drop(x),
            Self::Sampled(profile) => profile.drop(x),
        }
    }

    /// Mean drop \[m\] over the part of the cell from a to b \[m\] that the roller covers; +∞
    /// where this is less than half of the cell. The drop of a crowned profile, which is smooth, is
    /// taken at the middle of the cell.
    pub(super) fn mean_drop(&self, a: f64, b: f64) -> f64 {
        let [low, high] = self.ends();
        let (from, to) = (a.max(low), b.min(high));
        // Rounding of coordinates must not exclude a cell that is half covered.
        if to - from < 0.5 * (b - a) * (1.0 - 1e-9) {
            return f64::INFINITY;
        }
        match self {
            Self::Crowned(profile) => profile.drop(0.5 * (a + b)),
            Self::Logarithmic(profile) => profile.integral(from, to) / (to - from),
            Self::Sampled(profile) => profile.integral(from, to) / (to - from),
        }
    }

    /// Numbers on which the drop depends smoothly, by their names in case files.
    pub(super) fn parameters(&self) -> Vec<(String, f64)> {
        let named = |name: &str, value: f64| (name.to_owned(), value);
        match self {
            Self::Crowned(profile) => vec![
                named("flat_length", profile.flat_length),
                named("crown_radius", profile.crown_radius),
            ],
            Self::Logarithmic(profile) => {
                let numbers = profile.parameters().into_iter();
                numbers.map(|(name, value)| named(&format!("profile.{name}"), value)).collect()
            }
            Self::Sampled(profile) => {
                let drops = profile.samples.iter().enumerate();
                drops.map(|(k, [_, drop])| named(&format!("profile.drop[{k}]"), *drop)).collect()
            }
        }
    }

    /// Derivative of [`Profile::mean_drop`], where that is finite, with respect to the number `name`; `None` for a name
    /// that is not among the parameters.
    pub(super) fn mean_drop_slope(&self, name: &str, a: f64, b: f64) -> Option<f64> {
        let [low, high] = self.ends();
        let (from, to) = (a.max(low), b.min(high));
        match self {
            Self::Crowned(profile) => profile.slope(name, 0.5 * (a + b)),
            Self::Logarithmic(profile) => {
                let integral = profile.integral_slope(name.strip_prefix("profile.")?, from, to)?;
                Some(integral / (to - from))
            }
            Self::Sampled(profile) => {
                let number = name.strip_prefix("profile.drop[")?.strip_suffix(']')?;
                let number: usize = number.parse().ok()?;
                Some(profile.hat(number)?.integral(from, to) / (to - from))
            }
        }
    }

    /// Coordinates of the ends \[m\].
    pub(super) fn ends(&self) -> [f64; 2] {
        match self {
            Self::Crowned(_) => [f64::NEG_INFINITY, f64::INFINITY],
            Self::Logarithmic(profile) => [-0.5 * profile.length(), 0.5 * profile.length()],
            Self::Sampled(profile) => profile.ends(),
        }
    }

    /// Whether a contact that reaches an end of the profile has a sharp edge there.
    pub(super) fn has_sharp_ends(&self) -> bool {
        match self {
            Self::Crowned(_) => false,
            Self::Logarithmic(_) | Self::Sampled(_) => true,
        }
    }

    /// Coordinates of the corners \[m\], [`MARKS`] at most; the others are convex.
    pub(super) fn marks(&self) -> Vec<f64> {
        match self {
            Self::Crowned(_) | Self::Logarithmic(_) => Vec::new(),
            Self::Sampled(profile) => profile.marks(),
        }
    }

    /// Smallest radius of curvature \[m\], compared with which a contact must be small.
    pub(super) fn radius(&self) -> f64 {
        match self {
            Self::Crowned(profile) => profile.crown_radius,
            Self::Logarithmic(_) | Self::Sampled(_) => f64::INFINITY,
        }
    }
}

/// A profile that is straight over `flat_length` and rounded with `crown_radius` beyond.
///
/// ```text
/// d(x) = 0                            |x| ≤ L = flat_length / 2
/// d(x) = R_a − √(R_a² − (|x| − L)²)   |x| > L
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrownedProfile {
    flat_length: f64,
    crown_radius: f64,
}

impl CrownedProfile {
    /// A profile that is straight over `flat_length` ≥ 0 \[m\] and rounded with `crown_radius`
    /// \[m\] beyond.
    ///
    /// # Errors
    /// Unless `crown_radius` is finite and above 0, and `flat_length` finite and at least 0.
    pub fn new(flat_length: f64, crown_radius: f64) -> Result<Self> {
        require(
            "flat_length",
            flat_length,
            flat_length >= 0.0 && flat_length.is_finite(),
            "finite and at least 0",
        )?;
        Ok(Self {
            flat_length: flat_length + 0.0,
            crown_radius: positive("crown_radius", crown_radius)?,
        })
    }

    /// Length of the straight part \[m\].
    pub fn flat_length(&self) -> f64 {
        self.flat_length
    }

    /// Radius of the rounded ends \[m\].
    pub fn crown_radius(&self) -> f64 {
        self.crown_radius
    }

    fn drop(&self, x: f64) -> f64 {
        let beyond = (x.abs() - 0.5 * self.flat_length).max(0.0);
        sagitta(self.crown_radius, beyond * beyond)
    }

    /// Derivative of the drop with respect to a number.
    fn slope(&self, name: &str, x: f64) -> Option<f64> {
        let beyond = (x.abs() - 0.5 * self.flat_length).max(0.0);
        let square = beyond * beyond;
        match name {
            "crown_radius" => Some(sagitta_slope(self.crown_radius, square)),
            "flat_length" => {
                let under = self.crown_radius * self.crown_radius - square;
                Some(if under > 0.0 { -0.5 * beyond / under.sqrt() } else { 0.0 })
            }
            _ => None,
        }
    }
}

/// A measured profile: drops at increasing positions, with linear interpolation, and +∞ beyond.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledProfile {
    /// Position and drop of each sample.
    samples: Arc<[[f64; 2]]>,
}

impl SampledProfile {
    /// A profile with drops `drop` \[m\] at positions `x` \[m\].
    ///
    /// # Errors
    /// Unless there are at least two positions and as many drops, all are finite, and the positions
    /// increase.
    pub fn new(x: &[f64], drop: &[f64]) -> Result<Self> {
        if x.len() != drop.len() || x.len() < 2 {
            return Err(Error::Shape {
                name: "profile: positions and drops, at least two of each",
                expected: [x.len().max(2); 2],
                found: [x.len(), drop.len()],
            });
        }
        for (index, (x, d)) in x.iter().zip(drop).enumerate() {
            if !(x.is_finite() && d.is_finite()) {
                return Err(Error::NonFinite { name: "profile", index: [index, 0] });
            }
        }
        if let Some(pair) = x.windows(2).find(|pair| pair[1] <= pair[0]) {
            require("profile positions", pair[1], false, "increasing")?;
        }
        let samples = x.iter().zip(drop).map(|(x, drop)| [*x, *drop]);
        Ok(Self { samples: samples.collect() })
    }

    /// Position and drop of each sample \[m\].
    pub fn samples(&self) -> impl Iterator<Item = [f64; 2]> {
        self.samples.iter().copied()
    }

    /// The profile with a drop of 1 at one of the samples, and 0 at the others.
    fn hat(&self, number: usize) -> Option<Self> {
        let mut samples: Vec<[f64; 2]> = self.samples.iter().map(|[x, _]| [*x, 0.0]).collect();
        samples.get_mut(number)?[1] = 1.0;
        Some(Self { samples: samples.into() })
    }

    /// Positions of the samples; of very many samples, the highest of each of [`MARKS`] groups.
    fn marks(&self) -> Vec<f64> {
        let highest = |group: &[[f64; 2]]| {
            let by_drop = |a: &&[f64; 2], b: &&[f64; 2]| a[1].total_cmp(&b[1]);
            group.iter().min_by(by_drop).map(|sample| sample[0])
        };
        let groups = self.samples.chunks(self.samples.len().div_ceil(MARKS));
        groups.filter_map(highest).collect()
    }

    fn ends(&self) -> [f64; 2] {
        [self.samples[0][0], self.samples[self.samples.len() - 1][0]]
    }

    fn drop(&self, x: f64) -> f64 {
        let [low, high] = self.ends();
        if !(low..=high).contains(&x) {
            return f64::INFINITY;
        }
        let above = self.samples.partition_point(|s| s[0] <= x);
        let k = above.clamp(1, self.samples.len() - 1) - 1;
        line(self.samples[k], self.samples[k + 1], x)
    }

    /// Integral of the drop from a to b \[m²\], between the ends.
    fn integral(&self, a: f64, b: f64) -> f64 {
        let last = self.samples.len() - 1;
        let first = self.samples.partition_point(|s| s[0] <= a).clamp(1, last) - 1;
        let pieces = self.samples[first..].windows(2);
        let pieces = pieces.take_while(|pair| pair[0][0] < b);
        pieces
            .map(|pair| {
                let (from, to) = (pair[0][0].max(a), pair[1][0].min(b));
                line(pair[0], pair[1], 0.5 * (from + to)) * (to - from)
            })
            .sum()
    }
}

/// Straight line through two points (x, drop).
fn line([x0, d0]: [f64; 2], [x1, d1]: [f64; 2], x: f64) -> f64 {
    d0 + (d1 - d0) / (x1 - x0) * (x - x0)
}
