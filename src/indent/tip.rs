//! Profiles of tips.

use std::f64::consts::{FRAC_PI_2, PI};

use spec_math::cephes64::gamma;

use crate::error::{Error, Result, positive};

/// An axisymmetric tip. Its profile g(r) is the gap of the undeformed bodies, and g(0) = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Tip {
    /// A flat end: g = 0.
    Flat,
    /// g = r²/2R, with the radius R \[m\].
    Paraboloid(f64),
    /// A sphere of radius R \[m\], g = R − √(R² − r²).
    Sphere(f64),
    /// g = m r, with the slope m of the flanks.
    Cone(f64),
    /// g = b rⁿ, with b \[m^(1−n)\] and n > 0.
    Power(f64, f64),
    /// A cone of this slope with a rounded end: a paraboloid of the radius \[m\] up to where both have the same slope.
    RoundedCone(f64, f64),
    /// A flat end of this radius b \[m\] with a rounded edge: g = (r − b)²/2R beyond b.
    RoundedPunch(f64, f64),
}

impl Tip {
    /// The tip itself, if all its numbers are above 0.
    ///
    /// # Errors
    /// A number that is not finite and above 0.
    pub fn checked(self) -> Result<Self> {
        match self {
            Self::Flat => {}
            Self::Paraboloid(radius) | Self::Sphere(radius) => {
                positive("radius", radius)?;
            }
            Self::Cone(slope) => {
                positive("slope", slope)?;
            }
            Self::Power(factor, exponent) => {
                positive("factor", factor)?;
                positive("exponent", exponent)?;
            }
            Self::RoundedCone(slope, radius) => {
                positive("slope", slope)?;
                positive("radius", radius)?;
            }
            Self::RoundedPunch(flat, radius) => {
                positive("flat", flat)?;
                positive("radius", radius)?;
            }
        }
        Ok(self)
    }

    /// Largest contact radius \[m\], which only a sphere has.
    pub fn largest_radius(&self) -> f64 {
        match self {
            Self::Sphere(radius) => *radius,
            _ => f64::INFINITY,
        }
    }

    /// Radius \[m\] at which the profile has a kink in its curvature, where it has one.
    pub(super) fn kink(&self) -> Option<f64> {
        match self {
            Self::RoundedCone(slope, radius) => Some(slope * radius),
            Self::RoundedPunch(flat, _) => Some(*flat),
            _ => None,
        }
    }

    /// F and dF/ds at s: the indentation at which a bare body would be in contact up to s.
    pub(super) fn transform(&self, s: f64) -> [f64; 2] {
        match *self {
            Self::Flat => [0.0; 2],
            Self::Paraboloid(radius) => [s * s / radius, 2.0 * s / radius],
            Self::Sphere(radius) => {
                let x = s / radius;
                [s * x.atanh(), x.atanh() + x / (1.0 - x * x)]
            }
            Self::Cone(slope) => [FRAC_PI_2 * slope * s, FRAC_PI_2 * slope],
            Self::Power(factor, n) => {
                let ratio = gamma(0.5 * n) / gamma(0.5 * n + 0.5);
                let rate = factor * n * 0.5 * PI.sqrt() * ratio;
                [rate * s.powf(n), n * rate * s.powf(n - 1.0)]
            }
            Self::RoundedCone(slope, radius) => {
                let b = slope * radius;
                if s <= b {
                    return [s * s / radius, 2.0 * s / radius];
                }
                let (root, angle) = ((s * s - b * b).sqrt(), (b / s).acos());
                // d/ds of s (s − √) and of b s arccos(b/s).
                let first = [s * (s - root), 2.0 * s - root - s * s / root];
                let second = [b * s * angle, b * angle + b * b / root];
                [0, 1].map(|k| (first[k] + second[k]) / radius)
            }
            Self::RoundedPunch(flat, radius) => {
                if s <= flat {
                    return [0.0; 2];
                }
                let (root, angle) = ((s * s - flat * flat).sqrt(), (flat / s).acos());
                let value = s * (root - flat * angle);
                let slope = root - flat * angle + s * s / root - flat * flat / root;
                [value / radius, slope / radius]
            }
        }
    }

    /// An error unless the contact radius `a` is above 0 and within the tip.
    pub(super) fn check_radius(&self, a: f64) -> Result<f64> {
        positive("contact radius", a)?;
        match a < self.largest_radius() {
            true => Ok(a),
            false => Err(Error::Parameter {
                name: "contact radius",
                requirement: "below the radius of the sphere",
                value: a,
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Tip;
    use crate::error::Result;
    use crate::kernel::quadrature::Rule;

    /// F equals its definition s ∫ g'(r)/√(s² − r²) dr, with r = s sin θ, of differences of the profiles; dF/ds equals its
    /// own difference. Panels end at kinks.
    #[test]
    fn transforms_are_those_of_the_profiles() -> Result<()> {
        let slope_of = |tip: Tip, r: f64| match tip {
            Tip::Flat => 0.0,
            Tip::Paraboloid(radius) => r / radius,
            Tip::Sphere(radius) => r / (radius * radius - r * r).sqrt(),
            Tip::Cone(slope) => slope,
            Tip::Power(factor, n) => factor * n * r.powf(n - 1.0),
            Tip::RoundedCone(slope, radius) => slope.min(r / radius),
            Tip::RoundedPunch(flat, radius) => (r - flat).max(0.0) / radius,
        };
        let rule = Rule::gauss_legendre(40);
        for tip in [
            Tip::Flat,
            Tip::Paraboloid(3.0),
            Tip::Sphere(2.0),
            Tip::Cone(0.3),
            Tip::Power(0.2, 4.0),
            Tip::Power(0.2, 1.5),
            Tip::RoundedCone(0.3, 2.0),
            Tip::RoundedPunch(0.5, 4.0),
        ] {
            let tip = tip.checked()?;
            for s in [0.3, 0.8, 1.4] {
                let kink = tip
                    .kink()
                    .filter(|b| *b < s)
                    .map_or(0.0, |b| (b / s).asin());
                let mut due = 0.0;
                for [low, high] in [[0.0, kink], [kink, std::f64::consts::FRAC_PI_2]] {
                    let nodes = rule.nodes(0.5 * (low + high), 0.5 * (high - low));
                    due += nodes
                        .map(|(angle, w)| w * s * slope_of(tip, s * angle.sin()))
                        .sum::<f64>();
                }
                let [value, slope] = tip.transform(s);
                // Forty nodes leave 1e-12; a root of r leaves 1e-5.
                let error = if tip == Tip::Power(0.2, 1.5) {
                    1e-5
                } else {
                    1e-12
                };
                assert!(
                    (value - due).abs() <= error * due,
                    "{tip:?} {s}: {value} {due}"
                );
                let h = 1e-6;
                let difference = (tip.transform(s + h)[0] - tip.transform(s - h)[0]) / (2.0 * h);
                assert!(
                    (slope - difference).abs() < 1e-8,
                    "{tip:?} {s}: {slope} {difference}"
                );
            }
        }
        assert!(Tip::Cone(-1.0).checked().is_err());
        Ok(())
    }
}
