//! Axial profiles of rollers: the drop d(x) of the generatrix relative to the middle of the roller.

mod sampled;
mod stations;

use std::f64::consts::PI;

use crate::error::{Result, not_negative, positive, require};
use crate::model::data::value;
use crate::model::hertz::Line;
use crate::model::surface::quadric::sagitta;
use crate::model::surface::sagitta_slope;

pub use sampled::SampledProfile;

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
                let drops = profile.samples().enumerate();
                drops.map(|(k, [_, drop])| named(&format!("profile.drop[{k}]"), drop)).collect()
            }
        }
    }

    /// Derivatives of [`Profile::mean_drop`] over `cells`, where that is finite, with respect to the number `name`; `None`
    /// for a name that is not among the parameters.
    pub(super) fn mean_drop_slopes(&self, name: &str, cells: &[[f64; 2]]) -> Option<Vec<f64>> {
        let [low, high] = self.ends();
        let covered = cells.iter().map(|[a, b]| [a.max(low), b.min(high)]);
        match self {
            Self::Crowned(profile) => {
                cells.iter().map(|[a, b]| profile.slope(name, 0.5 * (a + b))).collect()
            }
            Self::Logarithmic(profile) => {
                let name = name.strip_prefix("profile.")?;
                let slope = |[a, b]: [f64; 2]| Some(profile.integral_slope(name, a, b)? / (b - a));
                covered.map(slope).collect()
            }
            Self::Sampled(profile) => {
                let number = name.strip_prefix("profile.drop[")?.strip_suffix(']')?;
                let ([more, less], step) = profile.changed(number.parse().ok()?)?;
                let slope = |[a, b]: [f64; 2]| {
                    (more.integral(a, b) - less.integral(a, b)) / (2.0 * step * (b - a))
                };
                Some(covered.map(slope).collect())
            }
        }
    }

    /// Other profiles that a measured one may mean.
    pub(super) fn alternatives(&self) -> Vec<Self> {
        match self {
            Self::Crowned(_) | Self::Logarithmic(_) => Vec::new(),
            Self::Sampled(profile) => profile.alternatives().into_iter().map(Self::from).collect(),
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

    /// Coordinates of the stations \[m\], a thousand at most.
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
        Ok(Self {
            flat_length: not_negative("flat_length", flat_length)? + 0.0,
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

value! {
    CrownedProfile by CrownedProfileData {
        flat_length: f64 = of.flat_length();
        crown_radius: f64 = of.crown_radius();
    }
    of, fields => Self::new(fields.flat_length, fields.crown_radius)
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
/// - Fujiwara & Kawase (NTN Technical Review 75 (2007)): A = K_1 W/(π L E*), crowned over the part K_2
///   of each half, f = 1 − e^{−z_m/A}, for which the drop at the ends is z_m;
/// - ISO/TS 16281 and DIN 26281: A = 0.00035 D and f = 1 for L ≤ 2.5 D; for longer rollers A = 0.0005 D
///   and f = 1 over the last 1.25 D at each end.
///
/// W and L are those of the roller, and E* is the modulus of both bodies. Of these formulas only that of
/// Johns & Gohar has a radius of curvature in it, by way of b: the equivalent radius of roller and
/// raceway. D is the diameter of the roller itself.
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
        let holds = (0.0..length).contains(&flat_length);
        require("flat_length", flat_length, holds, "at least 0 and below the length")?;
        let holds = end_factor > 0.0 && end_factor <= 1.0;
        require("end_factor", end_factor, holds, "above 0 and at most 1")?;
        Ok(Self { amplitude, length, flat_length: flat_length + 0.0, end_factor })
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

    /// Johns & Gohar's profile for a `load` W \[N\], a `contact_modulus` E* \[Pa\] and the equivalent
    /// `radius` \[m\] of roller and raceway, from which the Hertzian half-width follows.
    ///
    /// # Errors
    /// Unless all are finite and above 0, and the contact is longer than wide.
    pub fn johns_gohar(length: f64, load: f64, contact_modulus: f64, radius: f64) -> Result<Self> {
        let lundberg = Self::lundberg(length, load, contact_modulus)?;
        let b = Line::new(radius, contact_modulus, load / length)?.half_width;
        Self::new(lundberg.amplitude, length, 0.0, 1.0 - 0.3033 * b / (0.5 * length))
    }

    /// Fujiwara & Kawase's profile for a `load` W \[N\], a `contact_modulus` E* \[Pa\] and a choice of
    /// their parameters.
    ///
    /// ```text
    /// d(x) = A ln 1/{1 − (1 − e^{−z_m/A}) [(|x| − a)/(K_2 a) + 1]²}   |x| ≥ a (1 − K_2)    a = L/2
    /// A = K_1 W / (π L E*)
    /// ```
    ///
    /// The paper has 2W/(π L E′) with E′ = 2 E*; with K_1 = K_2 = 1 and z_m → ∞ it is Lundberg's profile.
    ///
    /// # Errors
    /// Unless all are finite and above 0, and K_2 ≤ 1.
    ///
    /// ```
    /// use nacre::{LogarithmicProfile, surface::{FujiwaraKawase, Profile}};
    /// let crown = FujiwaraKawase { k1: 1.5, k2: 0.5, z_m: 20e-6 };
    /// let profile = LogarithmicProfile::fujiwara_kawase(20e-3, 20e3, 115e9, crown)?;
    /// let profile = Profile::from(profile);
    /// assert_eq!(profile.drop(5e-3), 0.0);
    /// assert!((profile.drop(10e-3) / 20e-6 - 1.0).abs() < 1e-12);
    /// # Ok::<(), nacre::Error>(())
    /// ```
    pub fn fujiwara_kawase(
        length: f64,
        load: f64,
        contact_modulus: f64,
        crown: FujiwaraKawase,
    ) -> Result<Self> {
        let amplitude =
            positive("k1", crown.k1)? * Self::lundberg(length, load, contact_modulus)?.amplitude;
        positive("z_m", crown.z_m)?;
        require("k2", crown.k2, crown.k2 > 0.0 && crown.k2 <= 1.0, "above 0 and at most 1")?;
        let end_factor = -(-crown.z_m / amplitude).exp_m1();
        Self::new(amplitude, length, length * (1.0 - crown.k2), end_factor)
    }

    /// The profile of ISO/TS 16281:2008, now ISO 16281:2025, for a cylindrical roller of `diameter` D \[m\] and effective
    /// `length` L \[m\].
    ///
    /// Its amplitude is 0.00035 D up to L = 2.5 D, and 0.0005 D beyond, where the middle is straight; section 5.2.3 of
    /// the standard as programs and a manual quote it. A tapered roller has 0.00045 D: `LogarithmicProfile::new(0.00045 *
    /// diameter, length, 0.0, 1.0)`, as a book quotes the standard.
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

    /// Integral of the drop from a to b \[m²\], a < b.
    fn integral(&self, a: f64, b: f64) -> f64 {
        // The profile is symmetric: a part on either side, or one from |x| to |x|.
        if a < 0.0 && b > 0.0 {
            return self.one_sided(0.0, -a) + self.one_sided(0.0, b);
        }
        self.one_sided(a.abs().min(b.abs()), a.abs().max(b.abs()))
    }

    /// Numbers on which the drop depends smoothly. The end factor 1 is none: the drop is infinite at the ends there, and
    /// nowhere else.
    fn parameters(&self) -> Vec<(&'static str, f64)> {
        let mut parameters = vec![("amplitude", self.amplitude), ("flat_length", self.flat_length)];
        if self.end_factor < 1.0 {
            parameters.push(("end_factor", self.end_factor));
        }
        parameters
    }

    /// Derivative of [`LogarithmicProfile::integral`] with respect to a number. With u and f as in the formula of the
    /// profile, and the length L less the flat length F,
    ///
    /// ```text
    /// ∂d/∂A = d/A      ∂d/∂F = −2 A f u (1 − u)/[(1 − f u²)(L − F)]      ∂d/∂f = A u²/(1 − f u²)
    /// ```
    fn integral_slope(&self, name: &str, a: f64, b: f64) -> Option<f64> {
        let (f, crowned) = (self.end_factor, self.length - self.flat_length);
        let along = |x: f64| ((2.0 * x - self.flat_length).max(0.0) / crowned).min(1.0);
        let one_sided = |a: f64, b: f64, slope: &dyn Fn(f64, f64) -> f64| {
            let (from, to) = (along(a), along(b));
            // dx = (L − F)/2 du.
            0.5 * crowned * if to > from { slope(from, to) } else { 0.0 }
        };
        let both = |slope: &dyn Fn(f64, f64) -> f64| {
            if a < 0.0 && b > 0.0 {
                return one_sided(0.0, -a, slope) + one_sided(0.0, b, slope);
            }
            one_sided(a.abs().min(b.abs()), a.abs().max(b.abs()), slope)
        };
        match name {
            "amplitude" => Some(self.integral(a, b) / self.amplitude),
            "flat_length" => {
                let factor = -2.0 * self.amplitude * f / crowned;
                let slope = |u: f64| u * (1.0 - u) / ((1.0 - u) * (1.0 + u) + (1.0 - f) * u * u);
                Some(factor * both(&|from, to| gauss(from, to, slope)))
            }
            "end_factor" if f < 1.0 => {
                let slope = |u: f64| u * u / (1.0 - f * u * u);
                let root = f.sqrt();
                // u²/(1 − f u²) has the integral [atanh(√f u)/√f − u]/f, for use next to its pole.
                let closed = |u: f64| ((root * u).atanh() / root - u) / f;
                let integral =
                    |from: f64, to: f64| match 1.0 - root * to >= 0.5 * root * (to - from) {
                        true => gauss(from, to, slope),
                        false => closed(to) - closed(from),
                    };
                Some(self.amplitude * both(&integral))
            }
            _ => None,
        }
    }

    /// Integral of the drop between two positions 0 ≤ a ≤ b \[m²\]. With v² = f u²,
    ///
    /// ```text
    /// −ln(1 − v²) = −ln(1 − v) − ln(1 + v)
    /// ```
    ///
    /// The integrand is evaluated by Gauss's rule, which keeps the digits of a small drop; of the first
    /// term next to its pole v = 1, the integral (1 − v)[1 − ln(1 − v)] is taken in closed form.
    fn one_sided(&self, a: f64, b: f64) -> f64 {
        let root = self.end_factor.sqrt();
        let crowned = 0.5 * (self.length - self.flat_length);
        let along = |x: f64| root * ((x - 0.5 * self.flat_length).max(0.0) / crowned).min(1.0);
        let (from, to) = (along(a), along(b));
        let width = to - from;
        if width <= 0.0 {
            return 0.0;
        }
        // The rule's error falls by a factor of 14 or more per node at this distance from the pole: 1e-18.
        let sum = if 1.0 - to >= 0.5 * width {
            gauss(from, to, |v| -(-v * v).ln_1p())
        } else {
            let closed = |rest: f64| if rest > 0.0 { rest * (1.0 - rest.ln()) } else { 0.0 };
            closed(1.0 - from) - closed(1.0 - to) - gauss(from, to, f64::ln_1p)
        };
        self.amplitude * crowned / root * sum
    }
}

value! {
    LogarithmicProfile by LogarithmicProfileData {
        amplitude: f64 = of.amplitude();
        length: f64 = of.length();
        flat_length: f64 = of.flat_length();
        end_factor: f64 = of.end_factor();
    }
    of, fields => Self::new(fields.amplitude, fields.length, fields.flat_length, fields.end_factor)
}

/// Parameters of the profile of Fujiwara and Kawase.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FujiwaraKawase {
    /// K_1: ratio of the load for which the profile is made to the load that is given.
    pub k1: f64,
    /// K_2: part of the half-length that is crowned, at most 1.
    pub k2: f64,
    /// z_m: drop at the ends \[m\].
    pub z_m: f64,
}

/// Nodes and weights of Gauss's rule with 16 points on [−1, 1], for positive nodes. Abramowitz & Stegun,
/// table 25.4.
const GAUSS: [[f64; 2]; 8] = [
    [0.095_012_509_837_637_44, 0.189_450_610_455_068_5],
    [0.281_603_550_779_258_9, 0.182_603_415_044_923_6],
    [0.458_016_777_657_227_4, 0.169_156_519_395_002_54],
    [0.617_876_244_402_643_7, 0.149_595_988_816_576_73],
    [0.755_404_408_355_003, 0.124_628_971_255_533_87],
    [0.865_631_202_387_831_7, 0.095_158_511_682_492_78],
    [0.944_575_023_073_232_6, 0.062_253_523_938_647_89],
    [0.989_400_934_991_649_9, 0.027_152_459_411_754_095],
];

/// Integral of a function by Gauss's rule.
fn gauss(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let pairs = GAUSS
        .iter()
        .map(|[node, weight]| weight * (f(middle - half * node) + f(middle + half * node)));
    half * pairs.sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of a sum of 32 terms.
    const ROUNDING: f64 = 1e-14;

    /// Mean drop of −A ln(1 − v²) between two values of v, by its series Σ v^{2k}/k: v^{2k+1}/k(2k+1).
    fn series(from: f64, to: f64) -> f64 {
        let integral = |v: f64| {
            let terms = (1..200).map(|k| v.powi(2 * k + 1) / f64::from(k * (2 * k + 1)));
            terms.sum::<f64>()
        };
        // Written as a sum of positive terms where the two are close together.
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        if half < 0.01 * middle {
            let second = 2.0 * (1.0 + middle * middle) / (1.0 - middle * middle).powi(2);
            return -(-middle * middle).ln_1p() + second * half * half / 6.0;
        }
        (integral(to) - integral(from)) / (to - from)
    }

    #[test]
    fn small_drops_keep_their_digits() -> Result<()> {
        // A drop of 1e-8 of the amplitude at the ends, and cells of a four-hundredth of the length.
        let profile = LogarithmicProfile::new(1e-3, 2e-2, 0.0, 1e-8)?;
        for k in 0..200 {
            let (a, b) = (5e-5 * f64::from(k), 5e-5 * f64::from(k + 1));
            // −ln(1 − v²) = v² to 1e-8; the mean of x² is (a² + ab + b²)/3.
            let exact = 1e-3 * 1e-8 * (a * a + a * b + b * b) / 3.0 / 1e-4;
            for (a, b) in [(a, b), (-b, -a)] {
                let mean = profile.integral(a, b) / (b - a);
                assert!((mean / exact - 1.0).abs() < 1e-7, "{k}: {mean:e} {exact:e}");
            }
        }
        Ok(())
    }

    #[test]
    fn the_integral_is_that_of_the_logarithm_up_to_the_pole() -> Result<()> {
        let profile = LogarithmicProfile::new(1.0, 2.0, 0.0, 1.0)?;
        for (a, b) in [(0.0, 0.3), (0.0, 0.8), (0.5, 0.8), (0.6, 0.601), (0.1, 0.1003)] {
            let mean = profile.integral(a, b) / (b - a);
            let exact = series(a, b);
            assert!((mean / exact - 1.0).abs() < 1e-9, "{a} {b}: {mean} {exact}");
        }
        // ∫_0^1 −ln(1 − v²) dv = 2 − 2 ln 2, and its parts add up.
        let whole = profile.integral(0.0, 1.0);
        assert!((whole / (2.0 - 2.0 * 2.0_f64.ln()) - 1.0).abs() < ROUNDING, "{whole}");
        let parts = profile.integral(0.0, 0.9)
            + profile.integral(0.9, 0.9999)
            + profile.integral(0.9999, 1.0);
        assert!((parts / whole - 1.0).abs() < 10.0 * ROUNDING, "{parts}");
        assert!(
            (profile.integral(-0.4, 1.0) - whole - profile.integral(0.0, 0.4)).abs() < ROUNDING
        );
        Ok(())
    }
}
