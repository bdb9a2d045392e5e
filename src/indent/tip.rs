//! Profiles of tips.

use std::f64::consts::FRAC_PI_2;

use super::equation::basis::Break;
use crate::error::{Result, positive, require};

mod profile_terms;

use profile_terms::ProfileTerm;

/// An axisymmetric tip.
///
/// ```
/// use nacre::indent::Tip;
/// let tip = Tip::paraboloid(1e-6)?;
/// assert!((tip.gap(1e-7) - 5e-9).abs() < 1e-20);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Tip {
    form: Form,
    terms: Vec<ProfileTerm>,
    pub(super) kinks: Vec<f64>,
}

/// A number that the profile of a tip depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum TipParameter {
    /// The number of this position in [`Tip::numbers`].
    Number(usize),
    /// Area of all sections, relative to that of the tip: the profile becomes g(r/√area).
    Area,
}

/// Kinks of a profile at most at which the panels end whose nodes make its load; those of more are as small as their distances.
pub(super) const MOST_KINKS: usize = 64;

/// Kinks at most at which the panels of pressures and displacements end.
pub(super) const FEW_KINKS: usize = 4;

impl Tip {
    /// A tip of this form.
    ///
    /// # Errors
    /// A length that is not between 1e-100 and 1e100, a slope above [`STEEPEST`], an exponent that is not between 0.01 and 100, and samples
    /// that make no profile.
    pub fn new(form: Form) -> Result<Self> {
        form.check()?;
        let terms = match &form {
            Form::FlatPunch { .. } => vec![],
            Form::Paraboloid { radius } => vec![ProfileTerm::paraboloid(1.0 / radius)],
            Form::Sphere { radius } => vec![ProfileTerm::Sphere { radius: *radius }],
            Form::Cone { slope } => vec![ProfileTerm::power(*slope, 1.0)],
            Form::Power { factor, exponent } => vec![ProfileTerm::power(*factor, *exponent)],
            Form::RoundedCone { slope, radius } => {
                vec![ProfileTerm::Rounded { at: slope * radius, curvature: 1.0 / radius }]
            }
            Form::RoundedPunch { flat, radius } => {
                vec![ProfileTerm::Hinge { at: *flat, curvature: 1.0 / radius }]
            }
            Form::FlatCone { flat, slope } => vec![ProfileTerm::Step { at: *flat, slope: *slope }],
            Form::Profile { radii, heights } => profile_terms::profile(radii, heights)?,
            Form::Area { coefficients, depth } => {
                profile_terms::area_function(coefficients, *depth)?
            }
        };
        let mut kinks: Vec<f64> = terms.iter().filter_map(ProfileTerm::kink).collect();
        kinks.sort_by(f64::total_cmp);
        if kinks.len() > FEW_KINKS {
            kinks.clear();
        }
        Ok(Self { form, terms, kinks })
    }

    /// A paraboloid of this radius of curvature \[m\].
    ///
    /// # Errors
    /// Unless the radius is finite and above 0.
    pub fn paraboloid(radius: f64) -> Result<Self> {
        Self::new(Form::Paraboloid { radius })
    }

    /// A sphere of this radius \[m\].
    ///
    /// # Errors
    /// Unless the radius is finite and above 0.
    pub fn sphere(radius: f64) -> Result<Self> {
        Self::new(Form::Sphere { radius })
    }

    /// A cone whose flanks have this slope against the surface.
    ///
    /// # Errors
    /// Unless the slope is above 0 and at most [`STEEPEST`].
    pub fn cone(slope: f64) -> Result<Self> {
        Self::new(Form::Cone { slope })
    }

    /// A cone of this half angle between axis and flank \[rad\].
    ///
    /// ```
    /// use nacre::indent::Tip;
    /// let tip = Tip::cone_of_half_angle(70.3_f64.to_radians())?;
    /// assert!((tip.gap(1.0) - 0.358).abs() < 1e-3);
    /// # Ok::<(), nacre::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`slope_of`], and an angle whose slope is above [`STEEPEST`].
    pub fn cone_of_half_angle(half_angle: f64) -> Result<Self> {
        Self::cone(slope_of(half_angle)?)
    }

    /// A flat punch of this radius \[m\].
    ///
    /// # Errors
    /// Unless the radius is finite and above 0.
    pub fn flat_punch(radius: f64) -> Result<Self> {
        Self::new(Form::FlatPunch { radius })
    }

    /// Form of the tip, with its numbers.
    pub fn form(&self) -> &Form {
        &self.form
    }

    /// Names and values of the numbers that the form has.
    pub fn numbers(&self) -> Vec<(&'static str, f64)> {
        self.form.numbers()
    }

    /// Contact radius \[m\] of a flat punch; none of other tips.
    pub fn fixed_radius(&self) -> Option<f64> {
        match self.form {
            Form::FlatPunch { radius } => Some(radius),
            _ => None,
        }
    }

    /// Radius of curvature \[m\] of the end of a paraboloid, sphere or rounded cone; none of other tips.
    pub fn end_radius(&self) -> Option<f64> {
        match self.form {
            Form::Paraboloid { radius }
            | Form::Sphere { radius }
            | Form::RoundedCone { radius, .. } => Some(radius),
            _ => None,
        }
    }

    /// Smallest and largest contact radius \[m\].
    pub fn range(&self) -> [f64; 2] {
        match &self.form {
            Form::FlatPunch { radius } => [*radius; 2],
            Form::Sphere { radius } => [0.0, *radius],
            Form::RoundedPunch { flat, .. } | Form::FlatCone { flat, .. } => [*flat, f64::INFINITY],
            Form::Profile { radii, .. } => [0.0, radii[radii.len() - 1]],
            Form::Area { coefficients, depth } => {
                [0.0, profile_terms::radius(coefficients, *depth)]
            }
            _ => [0.0, f64::INFINITY],
        }
    }

    /// Profile g(r) \[m\]; +∞ beyond a sphere and beyond a flat punch.
    pub fn gap(&self, r: f64) -> f64 {
        match self.form {
            Form::Sphere { radius } | Form::FlatPunch { radius } if r > radius => f64::INFINITY,
            _ => self.terms.iter().map(|term| term.gap(r)).sum(),
        }
    }

    /// Slope g'(r) of the profile, within its [`Tip::range`].
    pub(super) fn slope(&self, r: f64) -> f64 {
        self.terms.iter().map(|term| term.slope(r)).sum()
    }

    /// Largest slope of the profile up to `a`: of convex ones that at `a`, of others at most the largest of many. Where the slope has no
    /// limit on the axis, it is that over a tenth of the contact and more.
    pub(super) fn steepest(&self, a: f64) -> f64 {
        let from = if self.is_convex() { 64 } else { 7 };
        let slopes = (from..=64).map(|k| self.slope(a * f64::from(k) / 64.0));
        slopes.fold(0.0, f64::max)
    }

    /// Whether the slope of the profile nowhere falls, so that the contact is a disc at every load.
    pub(super) fn is_convex(&self) -> bool {
        self.terms.iter().all(|term| match term {
            ProfileTerm::Hinge { curvature, .. } => *curvature >= 0.0,
            ProfileTerm::Power { factor, exponent, .. } => *factor >= 0.0 && *exponent >= 1.0,
            _ => true,
        })
    }

    /// Places \[m\] of the kinks of a sampled profile, ascending, which are too many for panels of a quadrature.
    pub(super) fn knots(&self) -> impl Iterator<Item = f64> {
        let terms = if self.kinks.is_empty() { &self.terms[..] } else { &[] };
        terms.iter().filter_map(ProfileTerm::kink)
    }

    /// Whether the pressure has no limit on the axis: a cone's.
    pub(super) fn is_sharp(&self) -> bool {
        self.transform(0.0)[1] > 0.0
            || matches!(self.form, Form::Power { exponent, .. } if exponent < 1.0)
    }

    /// F, dF/ds and d²F/ds² at s.
    pub(super) fn transform(&self, s: f64) -> [f64; 3] {
        sum(&self.terms, s)
    }

    /// Derivatives of the terms with respect to a number of the form.
    fn rates(&self, number: usize) -> Vec<ProfileTerm> {
        match (&self.form, number) {
            (Form::Paraboloid { radius }, _) => vec![ProfileTerm::paraboloid(-radius.powi(-2))],
            (Form::Sphere { radius }, _) => vec![ProfileTerm::SphereRate { radius: *radius }],
            (Form::Cone { .. }, _) => vec![ProfileTerm::power(1.0, 1.0)],
            (Form::Power { exponent, .. }, 0) => vec![ProfileTerm::power(1.0, *exponent)],
            (Form::Power { factor, exponent }, _) => {
                let ProfileTerm::Power { rate, .. } = ProfileTerm::power(*factor, *exponent) else {
                    return vec![];
                };
                vec![ProfileTerm::ExponentRate { exponent: *exponent, rate }]
            }
            // b = m R; ∂Rounded/∂b is a step of its curvature.
            (Form::RoundedCone { slope, radius }, 0) => {
                vec![ProfileTerm::Step { at: slope * radius, slope: 1.0 }]
            }
            (Form::RoundedCone { slope, radius }, _) => {
                let (at, rate) = (slope * radius, -radius.powi(-2));
                vec![
                    ProfileTerm::Rounded { at, curvature: rate },
                    ProfileTerm::Step { at, slope: slope / radius },
                ]
            }
            (Form::RoundedPunch { flat, radius }, 0) => {
                vec![ProfileTerm::Step { at: *flat, slope: -1.0 / radius }]
            }
            (Form::RoundedPunch { flat, radius }, _) => {
                vec![ProfileTerm::Hinge { at: *flat, curvature: -radius.powi(-2) }]
            }
            (Form::FlatCone { flat, slope }, 0) => {
                vec![ProfileTerm::PlaceRate { at: *flat, slope: *slope }]
            }
            (Form::FlatCone { flat, .. }, _) => vec![ProfileTerm::Step { at: *flat, slope: 1.0 }],
            _ => vec![],
        }
    }

    /// Derivatives of F and dF/ds at each of `places` with respect to `parameter`.
    pub(super) fn rate(&self, parameter: TipParameter, places: &[f64]) -> Vec<[f64; 2]> {
        match parameter {
            // F of g(r/√κ) is F(s/√κ).
            TipParameter::Area => {
                let rate = |s: &f64| {
                    let [_, slope, bend] = self.transform(*s);
                    // The product vanishes at s = 0 with the curvature of a sharp end.
                    let bend = if *s > 0.0 { s * bend } else { 0.0 };
                    [-0.5 * s * slope, -0.5 * (slope + bend)]
                };
                places.iter().map(rate).collect()
            }
            TipParameter::Number(number) => {
                let terms = self.rates(number);
                let rate = |s: &f64| {
                    let [value, slope, _] = sum(&terms, *s);
                    [value, slope]
                };
                places.iter().map(rate).collect()
            }
        }
    }

    /// Derivative of the profile g(r) with respect to `parameter`.
    pub(super) fn gap_rate(&self, parameter: TipParameter, r: f64) -> f64 {
        match parameter {
            // Where the slope has no limit on the axis, the product vanishes.
            TipParameter::Area if r > 0.0 => -0.5 * r * self.slope(r),
            TipParameter::Area => 0.0,
            TipParameter::Number(number) => self.rates(number).iter().map(|term| term.gap(r)).sum(),
        }
    }

    /// An error unless the contact radius `a` is one that the tip can have.
    pub(super) fn check_radius(&self, a: f64) -> Result<f64> {
        positive("radius", a)?;
        let [low, high] = self.range();
        let requirement = match self.form {
            Form::FlatPunch { .. } => "the radius of the flat punch, which is that of its contact",
            Form::Sphere { .. } => "below the radius of the sphere",
            Form::Profile { .. } | Form::Area { .. } => {
                "within the radii up to which the tip is known"
            }
            _ => "above the radius of the flat end",
        };
        let inside = match self.form {
            Form::FlatPunch { radius } => (a - radius).abs() <= 1e-12 * radius,
            _ => a > low && a < high,
        };
        require("radius", a, inside, requirement)
    }
}

/// Σ of the terms at s; F = (π/2) m s of a cone is among them.
fn sum(terms: &[ProfileTerm], s: f64) -> [f64; 3] {
    let mut total = [0.0; 3];
    for term in terms {
        for (total, value) in total.iter_mut().zip(term.transform(s)) {
            *total += value;
        }
    }
    total
}

/// Slope of a cone whose half angle, between axis and flank, is `angle` \[rad\].
///
/// # Errors
/// Unless the angle lies between 0 and π/2.
pub fn slope_of(angle: f64) -> Result<f64> {
    let requirement = "between 0 and pi/2, in radians; np.deg2rad makes them of degrees";
    let holds = angle > 0.0 && angle < FRAC_PI_2;
    require("half_angle", angle, holds, requirement)?;
    Ok(angle.tan().recip())
}

/// Steepest slope of a cone, of a half angle of 11°. The theory is that of small slopes, and errs by their square: there is no such tip
/// above, and the number is a half angle, in degrees or radians.
pub const STEEPEST: f64 = 5.0;

/// Form of a tip: its profile g(r) is the gap of the undeformed bodies, and g(0) = 0. Lengths in \[m\].
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Form {
    /// A flat end of this radius, with a sharp edge.
    FlatPunch {
        /// Radius of the end, which is that of the contact.
        radius: f64,
    },
    /// g = r²/2R.
    Paraboloid {
        /// Radius of curvature R.
        radius: f64,
    },
    /// g = R − √(R² − r²).
    Sphere {
        /// Radius R.
        radius: f64,
    },
    /// g = m r.
    Cone {
        /// Slope m of the flanks against the surface: cot of the half angle.
        slope: f64,
    },
    /// g = b rⁿ.
    Power {
        /// Factor b \[m^(1−n)\].
        factor: f64,
        /// Exponent n.
        exponent: f64,
    },
    /// A cone with a spherical end: a paraboloid up to where both have the same slope.
    RoundedCone {
        /// Slope of the flanks.
        slope: f64,
        /// Radius of curvature of the end.
        radius: f64,
    },
    /// A flat end with a rounded edge: g = (r − b)²/2R beyond b.
    RoundedPunch {
        /// Radius b of the flat end.
        flat: f64,
        /// Radius of curvature R of the edge.
        radius: f64,
    },
    /// A cone whose end is cut off: g = m (r − b) beyond b.
    FlatCone {
        /// Radius b of the flat end.
        flat: f64,
        /// Slope m of the flanks.
        slope: f64,
    },
    /// Samples g(r), from the axis on.
    Profile {
        /// Distances from the axis, ascending from 0.
        radii: Vec<f64>,
        /// Heights g, from 0 on.
        heights: Vec<f64>,
    },
    /// A tip whose section at the distance d from its end has the area Σ C_k d^(2^(1−k)).
    Area {
        /// Coefficients C_0, C_1, …
        coefficients: Vec<f64>,
        /// Deepest distance from the end up to which the function holds.
        depth: f64,
    },
}

impl Form {
    /// Names and values of the numbers, in the order in which they are written.
    fn numbers(&self) -> Vec<(&'static str, f64)> {
        match self {
            Self::FlatPunch { radius } | Self::Paraboloid { radius } | Self::Sphere { radius } => {
                vec![("radius", *radius)]
            }
            Self::Cone { slope } => vec![("slope", *slope)],
            Self::Power { factor, exponent } => {
                vec![("factor", *factor), ("exponent", *exponent)]
            }
            Self::RoundedCone { slope, radius } => vec![("slope", *slope), ("radius", *radius)],
            Self::RoundedPunch { flat, radius } => vec![("flat", *flat), ("radius", *radius)],
            Self::FlatCone { flat, slope } => vec![("flat", *flat), ("slope", *slope)],
            Self::Profile { .. } => vec![],
            Self::Area { depth, .. } => vec![("depth", *depth)],
        }
    }

    /// An error unless the numbers are those of a tip, in any unit.
    fn check(&self) -> Result<()> {
        for (name, value) in self.numbers() {
            let (range, requirement) = match name {
                "slope" => (
                    0.0..=STEEPEST,
                    "above 0 and at most 5, a half angle of 11 degrees; half_angle= takes an angle in radians",
                ),
                "exponent" => (0.01..=100.0, "between 0.01 and 100"),
                "factor" => (0.0..=f64::MAX, "finite and above 0"),
                _ => (1e-100..=1e100, "between 1e-100 and 1e100"),
            };
            positive(name, value)?;
            require(name, value, range.contains(&value), requirement)?;
        }
        Ok(())
    }
}

/// Ratio of the distances of successive breaks from a singularity: 24 nodes on a panel between them leave 3⁻⁴⁸.
const RATIO: f64 = 4.0;

/// Radius over that of a sphere up to which the eight nodes of smooth profiles leave 1e-14 of its logarithm at R.
const ROUND: f64 = 0.4;

/// Breaks towards the axis of powers of s, the first panel of which counts nothing: 4⁻¹² = 6e-8 of 1e-6.
const TO_AXIS: f64 = 12.0;

impl Tip {
    /// Places up to the contact radius `a` at which panels end, ascending, where the profile has `most` kinks there at most; none
    /// where F is smooth from the axis to `a`.
    pub(super) fn breaks(&self, a: f64, most: usize) -> Option<Vec<Break>> {
        let smooth = |at: f64| Break { at, has_root: false };
        let root = |at: f64| Break { at, has_root: true };
        let mut breaks = Vec::new();
        match self.form {
            Form::FlatPunch { .. } | Form::Paraboloid { .. } | Form::Cone { .. } => return None,
            Form::Sphere { radius } if a <= ROUND * radius => return None,
            // A logarithm at R.
            Form::Sphere { radius } => {
                let mut distance = RATIO * (radius - a);
                while RATIO * distance < radius {
                    breaks.insert(0, smooth(radius - distance));
                    distance *= RATIO;
                }
            }
            // A root on the axis, or s ln s in the derivative, and a steep rise within a/n of the edge.
            Form::Power { exponent, .. } => {
                breaks.push(root(0.0));
                let count = (TO_AXIS / (1.0 + exponent)).ceil();
                let mut at = a * RATIO.powf(-count);
                while at < 0.5 * a {
                    breaks.push(smooth(at));
                    at *= RATIO;
                }
                if exponent > 16.0 {
                    breaks.push(smooth(a * (1.0 - 8.0 / exponent)));
                }
            }
            _ => {
                let mut kinks: Vec<f64> = self.terms.iter().filter_map(ProfileTerm::kink).collect();
                kinks.retain(|b| *b < a);
                kinks.sort_by(f64::total_cmp);
                if kinks.len() > most {
                    let steps = [-3, -2, -1].map(|k| smooth(a * RATIO.powi(k)));
                    return Some(steps.into());
                }
                let ends = kinks.iter().skip(1).chain(std::iter::once(&a));
                let mut before = 0.0;
                for (kink, end) in kinks.iter().zip(ends) {
                    breaks.push(root(*kink));
                    // The singularity before this one, or its image at −b.
                    let mut distance = kink - before;
                    while distance > 0.0 && kink + 2.0 * distance < *end {
                        breaks.push(smooth(kink + distance));
                        distance *= RATIO;
                    }
                    before = *kink;
                }
            }
        }
        Some(breaks)
    }
}

#[cfg(test)]
mod tests {
    use super::{Form, Tip, TipParameter};
    use crate::error::Result;
    use crate::indent::equation::basis::{Break, Panel};
    use crate::numerics::quadrature::Rule;

    /// Forms with their numbers as `numbers` has them.
    fn forms([x, y]: [f64; 2]) -> [Form; 9] {
        [
            Form::Paraboloid { radius: 3.0 * x },
            Form::Sphere { radius: 2.0 * x },
            Form::Cone { slope: 0.3 * x },
            Form::Power { factor: 0.2 * x, exponent: 4.0 * y },
            Form::Power { factor: 0.2 * x, exponent: 2.5 * y },
            Form::RoundedCone { slope: 0.3 * x, radius: 2.0 * y },
            Form::RoundedPunch { flat: 0.5 * x, radius: 4.0 * y },
            Form::FlatCone { flat: 0.5 * x, slope: 0.2 * y },
            Form::FlatPunch { radius: x },
        ]
    }

    /// F equals its definition s ∫ g'(r)/√(s² − r²) dr, with r = s sin θ and differences of the profile; its two derivatives and
    /// its rates with the numbers and the area equal differences.
    #[test]
    fn transforms_are_those_of_the_profiles() -> Result<()> {
        let rule = Rule::gauss_legendre(60);
        for (k, form) in forms([1.0; 2]).into_iter().enumerate() {
            let tip = Tip::new(form)?;
            for s in [0.3, 0.8, 1.4] {
                let angle = |b: &f64| Break { at: (b / s).min(1.0).asin(), has_root: true };
                let kinks: Vec<Break> = tip.kinks.iter().map(angle).collect();
                let mut due = 0.0;
                if k < 8 {
                    for panel in Panel::between(0.0, &kinks, std::f64::consts::FRAC_PI_2) {
                        for (angle, w) in panel.nodes(&rule) {
                            let r = s * angle.sin();
                            let h = 1e-5 * r;
                            due += w * s * (tip.gap(r + h) - tip.gap(r - h)) / (2.0 * h);
                        }
                    }
                }
                let [value, slope, bend] = tip.transform(s);
                // Differences leave h²/6 g''' and 1e-16/h, next to a kink some h of the slope.
                assert!((value - due).abs() <= 2e-6, "{tip:?} {s}: {value} {due}");
                let h = 1e-4;
                let [low, high] = [s - h, s + h].map(|s| tip.transform(s));
                assert!((slope - (high[0] - low[0]) / (2.0 * h)).abs() < 1e-6, "{tip:?} {s}");
                assert!((bend - (high[1] - low[1]) / (2.0 * h)).abs() < 1e-5, "{tip:?} {s}");
                for number in 0..tip.numbers().len() {
                    let step = |part: f64| {
                        let mut numbers = [1.0; 2];
                        numbers[number] += part;
                        Tip::new(forms(numbers)[k].clone())
                    };
                    let (low, high) = (step(-1e-5)?, step(1e-5)?);
                    let size = tip.numbers()[number].1;
                    let [of_value, of_slope] =
                        tip.rate(TipParameter::Number(number), &[s])[0].map(|rate| rate * size);
                    let (low, high) = (low.transform(s), high.transform(s));
                    assert!(
                        (of_value - (high[0] - low[0]) / 2e-5).abs() < 1e-7,
                        "{tip:?} {s} {number}"
                    );
                    assert!(
                        (of_slope - (high[1] - low[1]) / 2e-5).abs() < 1e-6,
                        "{tip:?} {s} {number}"
                    );
                }
                let [of_value, of_slope] = tip.rate(TipParameter::Area, &[s])[0];
                // F of g(r/√κ) is F(s/√κ).
                let at = |part: f64| {
                    let root = (1.0 + part).sqrt();
                    let [value, slope, _] = tip.transform(s / root);
                    [value, slope / root]
                };
                let (low, high) = (at(-1e-5), at(1e-5));
                assert!((of_value - (high[0] - low[0]) / 2e-5).abs() < 1e-7, "{tip:?} {s}");
                assert!((of_slope - (high[1] - low[1]) / 2e-5).abs() < 1e-6, "{tip:?} {s}");
            }
        }
        Ok(())
    }

    /// Samples of a paraboloid and the area function 2πRd of one have its F, as closely as their intervals are fine.
    #[test]
    fn sampled_tips() -> Result<()> {
        let (radius, due) = (5.0, Tip::paraboloid(5.0)?);
        let radii: Vec<f64> = (0..101).map(|k| 0.02 * f64::from(k)).collect();
        let heights = radii.iter().map(|r| r * r / (2.0 * radius)).collect();
        let profile = Tip::new(Form::Profile { radii, heights })?;
        let area = Tip::new(Form::Area {
            coefficients: vec![0.0, 2.0 * std::f64::consts::PI * radius],
            depth: 0.4,
        })?;
        // A cone: A = π (d/m)².
        let cone =
            Tip::new(Form::Area { coefficients: vec![std::f64::consts::PI / 0.09], depth: 0.6 })?;
        for s in [0.3, 1.0, 1.7] {
            assert!((profile.transform(s)[0] / due.transform(s)[0] - 1.0).abs() < 1e-12);
            assert!((area.transform(s)[0] / due.transform(s)[0] - 1.0).abs() < 1e-4);
            let due = Tip::cone(0.3)?.transform(s)[0];
            assert!((cone.transform(s)[0] / due - 1.0).abs() < 1e-4);
        }
        assert!(area.range()[1] > 1.99 && area.range()[1] < 2.01);
        let wrong = Form::Area { coefficients: vec![1.0, -1.0], depth: 1.0 };
        assert!(Tip::new(wrong).is_err());
        Ok(())
    }
}
