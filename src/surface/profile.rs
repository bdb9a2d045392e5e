//! Axial profiles of rollers: the drop d(x) of the generatrix relative to the middle of the roller.

use std::f64::consts::PI;
use std::sync::Arc;

use super::quadric::sagitta;
use crate::error::{Error, Result, positive};
use crate::hertz::Line;

/// Largest number of coordinates at which a search for the contact looks at a profile: within a thousandth of
/// its length a tilt changes little.
const MARKS: usize = 1024;

/// An axial profile of a roller.
#[derive(Debug, Clone, PartialEq)]
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
            Self::Logarithmic(profile) => {
                (profile.integral(to) - profile.integral(from)) / (to - from)
            }
            Self::Sampled(profile) => (profile.integral(to) - profile.integral(from)) / (to - from),
        }
    }

    /// Coordinates of the ends \[m\].
    pub(super) fn ends(&self) -> [f64; 2] {
        match self {
            Self::Crowned(_) => [f64::NEG_INFINITY, f64::INFINITY],
            Self::Logarithmic(profile) => [-0.5 * profile.length, 0.5 * profile.length],
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
        if !(flat_length >= 0.0 && flat_length.is_finite()) {
            return Err(Error::Parameter {
                name: "flat_length",
                requirement: "finite and at least 0",
                value: flat_length,
            });
        }
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
}

/// A logarithmic profile, which has a straight middle where `flat_length` > 0.
///
/// ```text
/// d(x) = A ln 1/(1 − f u²)      u = max(2|x| − flat_length, 0) / (length − flat_length)
/// ```
///
/// The drop is +∞ beyond |x| = `length` / 2. The amplitude A and the end factor f ≤ 1 are, after
///
/// - Lundberg (Forsch. Ing.-Wes. 10 (1939) 201): A = W/(π L E*), f = 1, for which the load W causes
///   the same peak pressure at every x;
/// - Johns & Gohar (Tribol. Int. 14 (1981) 131): Lundberg's amplitude and f = 1 − 0.3033 b/a, with
///   the half-width b and the half-length a of the contact, for a finite drop at the ends;
/// - ISO/TS 16281: A = 0.00035 D and f = 1 for L ≤ 2.5 D; for longer rollers A = 0.0005 D and f = 1
///   over the last 1.25 D at each end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogarithmicProfile {
    amplitude: f64,
    length: f64,
    flat_length: f64,
    end_factor: f64,
}

impl LogarithmicProfile {
    /// A profile of `amplitude` A \[m\] and `length` \[m\] with `end_factor` f, straight over
    /// `flat_length` \[m\].
    ///
    /// # Errors
    /// Unless amplitude and length are finite and above 0, 0 ≤ `flat_length` < `length` and
    /// 0 < f ≤ 1.
    pub fn new(amplitude: f64, length: f64, flat_length: f64, end_factor: f64) -> Result<Self> {
        positive("amplitude", amplitude)?;
        positive("length", length)?;
        if !(0.0..length).contains(&flat_length) {
            return Err(Error::Parameter {
                name: "flat_length",
                requirement: "at least 0 and below the length",
                value: flat_length,
            });
        }
        if !(end_factor > 0.0 && end_factor <= 1.0) {
            return Err(Error::Parameter {
                name: "end_factor",
                requirement: "above 0 and at most 1",
                value: end_factor,
            });
        }
        Ok(Self {
            amplitude,
            length,
            flat_length: flat_length + 0.0,
            end_factor,
        })
    }

    /// Lundberg's profile for a `load` W \[N\] and a `contact_modulus` E* \[Pa\].
    ///
    /// # Errors
    /// Unless all are finite and above 0.
    pub fn lundberg(length: f64, load: f64, contact_modulus: f64) -> Result<Self> {
        positive("length", length)?;
        positive("load", load)?;
        positive("contact_modulus", contact_modulus)?;
        Self::new(load / (PI * length * contact_modulus), length, 0.0, 1.0)
    }

    /// Johns & Gohar's profile for a `load` W \[N\], a `contact_modulus` E* \[Pa\] and the `radius`
    /// \[m\], from which the Hertzian half-width follows.
    ///
    /// # Errors
    /// Unless all are finite and above 0, and the contact is longer than wide.
    pub fn johns_gohar(length: f64, load: f64, contact_modulus: f64, radius: f64) -> Result<Self> {
        let lundberg = Self::lundberg(length, load, contact_modulus)?;
        let b = Line::new(radius, contact_modulus, load / length)?.half_width;
        Self::new(
            lundberg.amplitude,
            length,
            0.0,
            1.0 - 0.3033 * b / (0.5 * length),
        )
    }

    /// The profile of ISO/TS 16281 for a roller of `diameter` D \[m\] and effective `length` \[m\].
    ///
    /// # Errors
    /// Unless both are finite and above 0.
    pub fn iso16281(diameter: f64, length: f64) -> Result<Self> {
        positive("diameter", diameter)?;
        positive("length", length)?;
        let rounded = 2.5 * diameter;
        if length <= rounded {
            Self::new(0.00035 * diameter, length, 0.0, 1.0)
        } else {
            Self::new(0.0005 * diameter, length, length - rounded, 1.0)
        }
    }

    /// Amplitude A of the profile \[m\].
    pub fn amplitude(&self) -> f64 {
        self.amplitude
    }

    /// Length of the roller \[m\].
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Length of the straight part \[m\].
    pub fn flat_length(&self) -> f64 {
        self.flat_length
    }

    /// End factor f.
    pub fn end_factor(&self) -> f64 {
        self.end_factor
    }

    fn drop(&self, x: f64) -> f64 {
        if x.abs() > 0.5 * self.length {
            return f64::INFINITY;
        }
        let beyond = (2.0 * x.abs() - self.flat_length).max(0.0);
        let u = beyond / (self.length - self.flat_length);
        -self.amplitude * (-self.end_factor * u * u).ln_1p()
    }

    /// Integral of the drop from 0 to x \[m²\]. With v² = f u²,
    ///
    /// ```text
    /// ∫ −ln(1 − v²) dv = (1 − v) ln(1 − v) − (1 + v) ln(1 + v) + 2v
    /// ```
    fn integral(&self, x: f64) -> f64 {
        let beyond = (2.0 * x.abs() - self.flat_length).max(0.0);
        let root = self.end_factor.sqrt();
        let v = (root * beyond / (self.length - self.flat_length)).min(1.0);
        let xlnx = |x: f64| if x > 0.0 { x * x.ln() } else { 0.0 };
        let sum = xlnx(1.0 - v) - xlnx(1.0 + v) + 2.0 * v;
        let scale = 0.5 * (self.length - self.flat_length) / root;
        x.signum() * self.amplitude * scale * sum
    }
}

/// A measured profile: drops at increasing positions, with linear interpolation, and +∞ beyond.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledProfile {
    /// Position, drop, and integral of the drop from the first position to this one, per sample.
    samples: Arc<[[f64; 3]]>,
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
                return Err(Error::NonFinite {
                    name: "profile",
                    index: [index, 0],
                });
            }
        }
        if let Some(pair) = x.windows(2).find(|pair| pair[1] <= pair[0]) {
            return Err(Error::Parameter {
                name: "profile positions",
                requirement: "increasing",
                value: pair[1],
            });
        }
        let mut integral = 0.0;
        let samples = (0..x.len()).map(|k| {
            if k > 0 {
                integral += 0.5 * (drop[k] + drop[k - 1]) * (x[k] - x[k - 1]);
            }
            [x[k], drop[k], integral]
        });
        Ok(Self {
            samples: samples.collect(),
        })
    }

    /// Position and drop of each sample \[m\].
    pub fn samples(&self) -> impl Iterator<Item = [f64; 2]> {
        self.samples.iter().map(|&[x, drop, _]| [x, drop])
    }

    /// Positions of the samples; of very many samples, the highest of each of [`MARKS`] groups.
    fn marks(&self) -> Vec<f64> {
        let highest = |group: &[[f64; 3]]| {
            let by_drop = |a: &&[f64; 3], b: &&[f64; 3]| a[1].total_cmp(&b[1]);
            group.iter().min_by(by_drop).map(|sample| sample[0])
        };
        let groups = self.samples.chunks(self.samples.len().div_ceil(MARKS));
        groups.filter_map(highest).collect()
    }

    fn ends(&self) -> [f64; 2] {
        [self.samples[0][0], self.samples[self.samples.len() - 1][0]]
    }

    /// The sample at or below x, the slope of the drop after it, and the distance of x from it; x is
    /// clamped to the ends.
    fn locate(&self, x: f64) -> ([f64; 3], f64, f64) {
        let [low, high] = self.ends();
        let x = x.clamp(low, high);
        let above = self.samples.partition_point(|s| s[0] <= x);
        let k = above.clamp(1, self.samples.len() - 1) - 1;
        let ([x0, d0, integral], [x1, d1, _]) = (self.samples[k], self.samples[k + 1]);
        ([x0, d0, integral], (d1 - d0) / (x1 - x0), x - x0)
    }

    fn drop(&self, x: f64) -> f64 {
        let [low, high] = self.ends();
        if !(low..=high).contains(&x) {
            return f64::INFINITY;
        }
        let ([_, d0, _], slope, along) = self.locate(x);
        d0 + slope * along
    }

    fn integral(&self, x: f64) -> f64 {
        let ([_, d0, integral], slope, along) = self.locate(x);
        integral + along * (d0 + 0.5 * slope * along)
    }
}
