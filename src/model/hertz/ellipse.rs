//! Contacts whose area is an ellipse.

use std::f64::consts::PI;

use super::shear::{self, Shear};
use crate::error::{Error, Result, positive};
use crate::numerics::special::{arithmetic_geometric_mean, carlson_rd};

/// Iterations for the ratio of the semi-axes, each of which divides its error by four at least; 27 give
/// all digits.
const RATIO_ITERATIONS: usize = 60;

/// Contact of two bodies that are curved differently along x and y: a ball in a groove, a barrel on a
/// ring, crossed cylinders. Johnson (1985), eqs (4.25)–(4.32).
///
/// ```text
/// p = p0 √(1 − x²/a² − y²/b²)          p0 = 3W / 2πab
/// 1/2R_x = p0 a b R_D(0, b², a²) / 3E*    1/2R_y = p0 a b R_D(0, a², b²) / 3E*
/// δ = p0 a b R_F(0, a², b²) / E*
/// ```
///
/// R_F and R_D are Carlson's elliptic integrals (doi:10.1007/BF02198293), which are symmetric: either
/// semi-axis may be the longer one. R_F is computed by the arithmetic-geometric mean.
///
/// ```
/// use nacre::hertz::{Ellipse, equivalent_radius};
/// // A ball of 5 mm in the groove of an inner ring, 5.2 mm across and 20 mm along.
/// let across = equivalent_radius(Some(5e-3), Some(-5.2e-3))?;
/// let along = equivalent_radius(Some(5e-3), Some(20e-3))?;
/// let contact = Ellipse::new([across, along], 115.4e9, 1e3)?;
/// assert!(contact.semi_axes[0] > 9.0 * contact.semi_axes[1]);
/// let load = 2.0 / 3.0 * std::f64::consts::PI * contact.semi_axes[0] * contact.semi_axes[1];
/// assert!((load * contact.peak_pressure / 1e3 - 1.0).abs() < 1e-14);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ellipse {
    /// Semi-axes a along x and b along y \[m\].
    pub semi_axes: [f64; 2],
    /// Peak pressure p0 = 3W/2πab \[Pa\].
    pub peak_pressure: f64,
    /// Approach δ \[m\].
    pub approach: f64,
}

impl Ellipse {
    /// The contact for equivalent radii along x and y \[m\], a `contact_modulus` E* \[Pa\] and a `load`
    /// \[N\].
    ///
    /// # Errors
    /// Unless all are finite and above 0, and semi-axes and pressure are numbers of the machine.
    pub fn new(radii: [f64; 2], contact_modulus: f64, load: f64) -> Result<Self> {
        positive("radius_x", radii[0])?;
        positive("radius_y", radii[1])?;
        positive("contact_modulus", contact_modulus)?;
        positive("load", load)?;
        let [longer, shorter] = [radii[0].max(radii[1]), radii[0].min(radii[1])];
        let k = axis_ratio(longer / shorter);
        // 1/2R = p0 a b R_D(0, b², a²)/3E* of the longer radius, with p0 = 3W/2πab and b = k a.
        let rd = carlson_rd([0.0, k * k, 1.0]);
        let a = (load / contact_modulus * longer * rd / PI).cbrt();
        let b = k * a;
        let peak_pressure = 1.5 * load / (PI * a * b);
        let approach = 0.75 * load / (contact_modulus * arithmetic_geometric_mean(1.0, k) * a);
        let made = [a, b, peak_pressure, approach];
        if !made.iter().all(|value| value.is_finite() && *value > 0.0) {
            return Err(Error::Inconsistent(
                "radii, contact_modulus and load must be such that semi-axes, pressure and approach are \
                 numbers of the machine: they are too different in size",
            ));
        }
        Ok(Self {
            semi_axes: if radii[0] >= radii[1] { [a, b] } else { [b, a] },
            peak_pressure,
            approach,
        })
    }

    /// Pressure at (x, y) from the middle \[Pa\]: p0 √(1 − x²/a² − y²/b²), 0 outside.
    pub fn pressure(&self, x: f64, y: f64) -> f64 {
        let [a, b] = self.semi_axes;
        let inside = 1.0 - (x / a).powi(2) - (y / b).powi(2);
        self.peak_pressure * inside.max(0.0).sqrt()
    }

    /// Largest shear stress below the middle, in a body of Poisson's ratio `poisson`.
    ///
    /// # Errors
    /// Unless −1 < `poisson` ≤ 0.5.
    pub fn max_shear(&self, poisson: f64) -> Result<Shear> {
        shear::below_ellipse(self.semi_axes, self.peak_pressure, poisson)
    }
}

/// Ratio k = b/a ≤ 1 of the semi-axes for a ratio λ ≥ 1 of the equivalent radii, by the iteration
///
/// ```text
/// k² = [k² R_D(0, 1, k²)] / [λ R_D(0, k², 1)]
/// ```
///
/// whose right side varies slowly: like the square root of k near 1, like a logarithm for small k.
fn axis_ratio(radii: f64) -> f64 {
    let mut k = radii.powf(-2.0 / 3.0);
    for _ in 0..RATIO_ITERATIONS {
        let square = k * k;
        let next = square * carlson_rd([0.0, 1.0, square]) / carlson_rd([0.0, square, 1.0]);
        let next = (next / radii).sqrt();
        if (next - k).abs() <= f64::EPSILON * k {
            return next;
        }
        k = next;
    }
    k
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of sums, divisions and roots.
    const ROUNDING: f64 = 1e-14;

    /// K(e) = π / 2 agm(1, k) against the values of Abramowitz & Stegun, table 17.1, for the parameters
    /// m = 1 − k² = 0, 0.5 and 0.9.
    #[test]
    fn mean_gives_the_complete_integral_of_the_first_kind() {
        for (m, exact) in [
            (0.0, 0.5 * PI),
            (0.5, 1.854_074_677_301_372),
            (0.9, 2.578_092_113_348_173),
        ] {
            let k = 0.5 * PI / arithmetic_geometric_mean(1.0, f64::sqrt(1.0 - m));
            assert!((k / exact - 1.0).abs() < ROUNDING, "{m}: {k}");
        }
    }

    /// R_D(0, 1 − m, 1) = 3 (K − E)/m, with E(0.5) = 1.3506438810476755 (the same table).
    #[test]
    fn carlsons_integral_is_that_of_legendre() {
        let exact = 3.0 * (1.854_074_677_301_372 - 1.350_643_881_047_675_5) / 0.5;
        assert!((carlson_rd([0.0, 0.5, 1.0]) / exact - 1.0).abs() < 10.0 * ROUNDING);
        // R_D(x, x, x) = x^{−3/2}.
        assert!((carlson_rd([4.0, 4.0, 4.0]) * 8.0 - 1.0).abs() < ROUNDING);
    }

    #[test]
    fn ratio_of_the_axes_solves_its_equation_for_any_ratio_of_radii() {
        for exponent in 0..=24 {
            let radii = 10.0_f64.powf(0.5 * f64::from(exponent));
            let k = axis_ratio(radii);
            let square = k * k;
            let found = carlson_rd([0.0, 1.0, square]) / carlson_rd([0.0, square, 1.0]);
            assert!((found / radii - 1.0).abs() < 1e-12, "{radii:e}: {found:e}");
        }
    }
}
