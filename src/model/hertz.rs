//! Closed-form solutions on a homogeneous half-space, for documentation, tests and scales.
//!
//! E* is the contact modulus, with 1/E* = Σ (1−ν²)/E over both bodies. All solutions are from
//! K. L. Johnson, Contact Mechanics, Cambridge University Press (1985), doi:10.1017/CBO9781139171731.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::error::{Error, Result, finite, positive, refuse_if, require};
use crate::model::material::Elastic;
use crate::numerics::special::{arithmetic_geometric_mean, carlson_rd};

/// Equivalent radius R \[m\] of two surfaces in contact, in one direction.
///
/// ```text
/// 1/R = 1/R_1 + 1/R_2
/// ```
///
/// `radius` and `counter_radius` \[m\] are above 0 where the surface is convex, below 0 where it is
/// concave (a raceway, a groove), and `None` or infinite where it is straight.
///
/// # Errors
/// Unless no radius is 0, and 1/R is above 0.
///
/// ```
/// use nacre::hertz::equivalent_radius;
/// // A roller of 5 mm in a raceway of 30 mm.
/// assert!((equivalent_radius(Some(5e-3), Some(-30e-3))? / 6e-3 - 1.0).abs() < 1e-14);
/// assert_eq!(equivalent_radius(Some(5e-3), None)?, 5e-3);
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn equivalent_radius(radius: Option<f64>, counter_radius: Option<f64>) -> Result<f64> {
    curvature("radius", radius)?;
    curvature("counter_radius", counter_radius)?;
    let curved = |radius: Option<f64>| radius.filter(|radius| radius.is_finite());
    let equivalent = match (curved(radius), curved(counter_radius)) {
        // Below 0 where both are concave, or the wider one is the convex one.
        (Some(one), Some(two)) => one * (two / (one + two)),
        (Some(one), None) | (None, Some(one)) => one,
        (None, None) => f64::INFINITY,
    };
    if equivalent > 0.0 && equivalent.is_finite() {
        return Ok(equivalent);
    }
    Err(Error::Inconsistent(
        "radius and counter_radius must be convex together: 1/radius + 1/counter_radius must be above 0",
    ))
}

/// Curvature 1/R \[1/m\]; 0 where the surface is straight.
fn curvature(name: &'static str, radius: Option<f64>) -> Result<f64> {
    let Some(value) = radius else {
        return Ok(0.0);
    };
    require(
        name,
        value,
        value.abs() > 0.0,
        "other than 0 (infinite or None for a straight surface)",
    )?;
    Ok(1.0 / value)
}

/// Principal relative radii \[m\] of two surfaces in contact, the longer first, and the angle \[rad\] from the x axis of
/// the first surface to the axis of the longer radius, above −π/2 and at most π/2.
///
/// ```text
/// A + B = ½ (1/R_1x + 1/R_1y + 1/R_2x + 1/R_2y)          R′ = 1/2A      R″ = 1/2B
/// B − A = ½ √[(1/R_1x − 1/R_1y)² + (1/R_2x − 1/R_2y)² + 2 (1/R_1x − 1/R_1y)(1/R_2x − 1/R_2y) cos 2φ]
/// ```
///
/// `radii` and `counter_radii` \[m\] are those of each surface along its own principal axes x and y, above 0 where it is
/// convex, below 0 where it is concave, `None` or infinite where it is straight; the x axis of the second surface is at the `angle` φ
/// \[rad\] from that of the first. A is computed from 4AB, the determinant of the sum of both curvatures, which has no
/// cancellation between convex surfaces. Johnson (1985), eqs (4.4) and (4.5).
///
/// # Errors
/// Unless no radius is 0, the angle is finite, and A > 0.
///
/// ```
/// use nacre::hertz::relative_radii;
/// // Cylinders of 5 mm and 8 mm, crossed at right angles.
/// let ([longer, shorter], turn) =
///     relative_radii([None, Some(5e-3)], [None, Some(8e-3)], std::f64::consts::FRAC_PI_2)?;
/// assert!((longer / 8e-3 - 1.0).abs() < 1e-14 && (shorter / 5e-3 - 1.0).abs() < 1e-14);
/// assert!(turn.abs() < 1e-14);
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn relative_radii(
    radii: [Option<f64>; 2],
    counter_radii: [Option<f64>; 2],
    angle: f64,
) -> Result<([f64; 2], f64)> {
    let [x, y] = [curvature("radii", radii[0])?, curvature("radii", radii[1])?];
    let [along, across] = counter_radii;
    let [along, across] = [curvature("counter_radii", along)?, curvature("counter_radii", across)?];
    let (sin, cos) = finite("angle", angle)?.sin_cos();
    let counter_x = along * cos * cos + across * sin * sin;
    let counter_y = along * sin * sin + across * cos * cos;
    let mixed = (along - across) * sin * cos;
    let (mean, half) = (0.5 * (x + y + along + across), 0.5 * (x + counter_x - y - counter_y));
    let larger = mean + half.hypot(mixed);
    let determinant = x * y + along * across + x * counter_y + y * counter_x;
    let smaller = determinant / larger;
    let principal_radii = [1.0 / smaller, 1.0 / larger];
    // Cylinders at a smaller angle than some 1e-8 are parallel but for rounding.
    if smaller > f64::EPSILON * larger && principal_radii.iter().all(|radius| radius.is_finite()) {
        // The rounding of an angle is no turn, and an axis at −π/2 is one at π/2.
        let rounding = f64::EPSILON * angle.abs().max(1.0) * (along - across).abs();
        let mixed = if mixed.abs() > rounding { mixed } else { 0.0 };
        let turn = 0.5 * (0.0 - mixed).atan2(-half);
        return Ok((principal_radii, if turn > -FRAC_PI_2 { turn } else { FRAC_PI_2 }));
    }
    Err(Error::Inconsistent(
        "radii and counter_radii must be convex together in every direction (parallel cylinders touch along a line)",
    ))
}

/// Contact modulus E* \[Pa\] of two bodies; without a counterbody that of `body` on a rigid one.
///
/// ```text
/// 1/E* = (1 − ν_1²)/E_1 + (1 − ν_2²)/E_2
/// ```
///
/// ```
/// let steel = nacre::Elastic::new(210e9, 0.3)?;
/// let both = nacre::hertz::contact_modulus(&steel, Some(&steel));
/// assert!((both / 115.385e9 - 1.0).abs() < 1e-5);
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn contact_modulus(body: &Elastic, counterbody: Option<&Elastic>) -> f64 {
    let counter = counterbody.map_or(0.0, |other| 1.0 / other.plane_strain_modulus());
    1.0 / (1.0 / body.plane_strain_modulus() + counter)
}

/// Contact of a paraboloid of revolution. Johnson (1985), eqs (4.22)–(4.24).
///
/// ```
/// let contact = nacre::hertz::Point::new(5e-3, 115e9, 10.0)?;
/// // W = 2/3 π a² p0
/// let load = 2.0 / 3.0 * std::f64::consts::PI * contact.radius.powi(2) * contact.peak_pressure;
/// assert!((load / 10.0 - 1.0).abs() < 1e-14);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Point {
    /// Contact radius a = (3WR/4E*)^{1/3} \[m\].
    pub radius: f64,
    /// Peak pressure p0 = 3W/2πa² \[Pa\].
    pub peak_pressure: f64,
    /// Approach δ = a²/R \[m\].
    pub approach: f64,
}

impl Point {
    /// The contact for a radius of curvature `radius` \[m\], a `contact_modulus` E* \[Pa\] and a
    /// `load` \[N\].
    ///
    /// # Errors
    /// Unless all are finite and above 0.
    pub fn new(radius: f64, contact_modulus: f64, load: f64) -> Result<Self> {
        positive("radius", radius)?;
        positive("contact_modulus", contact_modulus)?;
        positive("load", load)?;
        let a = (0.75 * load * radius / contact_modulus).cbrt();
        Ok(Self { radius: a, peak_pressure: 1.5 * load / (PI * a * a), approach: a * a / radius })
    }

    /// Pressure at distance `r` from the axis \[Pa\]: p0 √(1 − r²/a²), 0 outside.
    pub fn pressure(&self, r: f64) -> f64 {
        self.peak_pressure * (1.0 - (r / self.radius).powi(2)).max(0.0).sqrt()
    }

    /// Largest shear stress on the axis of a body of Poisson's ratio `poisson`: for 0.3 it is 0.310 p0 at
    /// the depth 0.48 a.
    ///
    /// # Errors
    /// Unless −1 < `poisson` ≤ 0.5.
    pub fn max_shear(&self, poisson: f64) -> Result<Shear> {
        below_ellipse([self.radius; 2], self.peak_pressure, poisson)
    }
}

/// Contact of a cylinder, per unit length. Johnson (1985), eqs (4.43)–(4.45).
///
/// The approach of a line contact depends on a datum in each body. The axes of two rollers, each loaded at the opposite
/// side, approach by (§5.6)
///
/// ```text
/// Σ W' (1 − ν²)/πE [2 ln(4R/b) − 1]
/// ```
///
/// ```
/// let contact = nacre::hertz::Line::new(5e-3, 115e9, 1e5)?;
/// // W' = π/2 b p0
/// let load = std::f64::consts::FRAC_PI_2 * contact.half_width * contact.peak_pressure;
/// assert!((load / 1e5 - 1.0).abs() < 1e-14);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Line {
    /// Half-width b = √(4W'R/πE*) \[m\].
    pub half_width: f64,
    /// Peak pressure p0 = 2W'/πb \[Pa\].
    pub peak_pressure: f64,
}

impl Line {
    /// The contact for a `radius` \[m\], a `contact_modulus` E* \[Pa\] and a `line_load` W'
    /// \[N/m\].
    ///
    /// # Errors
    /// Unless all are finite and above 0.
    pub fn new(radius: f64, contact_modulus: f64, line_load: f64) -> Result<Self> {
        positive("radius", radius)?;
        positive("contact_modulus", contact_modulus)?;
        positive("line_load", line_load)?;
        let b = (4.0 * line_load * radius / (PI * contact_modulus)).sqrt();
        Ok(Self { half_width: b, peak_pressure: 2.0 * line_load / (PI * b) })
    }

    /// Pressure at distance `y` from the middle \[Pa\]: p0 √(1 − y²/b²), 0 outside.
    pub fn pressure(&self, y: f64) -> f64 {
        self.peak_pressure * (1.0 - (y / self.half_width).powi(2)).max(0.0).sqrt()
    }

    /// Largest shear stress below the middle, in a body of Poisson's ratio `poisson`: 0.300 p0 at the
    /// depth 0.786 b, unless `poisson` is below 0.2.
    ///
    /// # Errors
    /// Unless −1 < `poisson` ≤ 0.5.
    pub fn max_shear(&self, poisson: f64) -> Result<Shear> {
        // In plane strain, Johnson (1985), eq. (4.46), and σ_axial = ν (σ_y + σ_z).
        let stresses = |z: f64| {
            let t = (1.0 + z * z).sqrt();
            // −[(1 + 2z²)/t − 2z], without cancellation.
            let across = -1.0 / (t * (1.0 + 2.0 * z * (z + t)));
            let down = -1.0 / t;
            [poisson * (across + down), across, down]
        };
        largest(stresses, poisson, self.peak_pressure, self.half_width)
    }
}

/// Approach \[m\] and tilt of a rigid flat circular punch of `radius` a \[m\] under a `load` W \[N\]
/// whose first moment about the axis is `moment` M \[N m\].
///
/// ```text
/// δ = W / (2 E* a)        s = 3 M / (4 E* a³)
/// ```
///
/// Valid for |M| ≤ W a/3, where the whole face is in contact. Johnson (1985), eqs (3.36) and (3.37)
/// and §5.6.
///
/// # Errors
/// Unless radius, modulus and load are finite and above 0.
pub fn flat_punch(radius: f64, contact_modulus: f64, load: f64, moment: f64) -> Result<(f64, f64)> {
    positive("radius", radius)?;
    positive("contact_modulus", contact_modulus)?;
    positive("load", load)?;
    let approach = load / (2.0 * contact_modulus * radius);
    Ok((approach, 0.75 * moment / (contact_modulus * radius.powi(3))))
}

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
#[non_exhaustive]
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
    /// Unless all are finite and above 0, and semi-axes and pressure are floating-point numbers.
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
        let quantities = [a, b, peak_pressure, approach];
        refuse_if(
            !quantities.iter().all(|value| value.is_finite() && *value > 0.0),
            "radii, contact_modulus and load must be such that semi-axes, pressure and approach are \
                 numbers of the machine: they are too different in size",
        )?;
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
        below_ellipse(self.semi_axes, self.peak_pressure, poisson)
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

/// Largest shear stress, and the depth at which it is.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Shear {
    /// Half the difference of the largest and the smallest principal stress \[Pa\].
    pub stress: f64,
    /// Depth below the surface \[m\].
    pub depth: f64,
}

/// Largest shear stress on the axis of an ellipse of pressure, in a body of Poisson's ratio `poisson`.
///
/// With T_x = √(a² + z²), T_y = √(b² + z²), from the potentials of Boussinesq, integrated by parts:
///
/// ```text
/// σ_z = −p0 a b / T_x T_y
/// σ_x = p0 a b [(1−ν) z J_x − ν z J − (1−2ν) / T_x (T_x + T_y)]
/// z J_x = 2/3 z R_D(z², T_y², T_x²)      z J = 2 / T_x T_y − z J_x − z J_y
/// ```
///
/// Derived for nacre; for a = b they are Johnson (1985), eqs (3.45).
fn below_ellipse(axes: [f64; 2], peak: f64, poisson: f64) -> Result<Shear> {
    let [a, b] = axes;
    // In units of the shorter axis.
    let scale = a.min(b);
    let [a, b] = [a / scale, b / scale];
    let stresses = |z: f64| {
        let (sx, sy) = (a * a + z * z, b * b + z * z);
        let (tx, ty) = (sx.sqrt(), sy.sqrt());
        let whole = 2.0 / (tx * ty);
        // z J_x, of which the limit at the surface is 0.
        let along = |y: f64, z2: f64| match z > 0.0 {
            true => 2.0 / 3.0 * z * carlson_rd([z * z, y, z2]),
            false => 0.0,
        };
        let (jx, jy) = (along(sy, sx), along(sx, sy));
        let j = whole - jx - jy;
        let lateral = |own: f64, t: f64| {
            a * b * ((1.0 - poisson) * own - poisson * j - (1.0 - 2.0 * poisson) / (t * (tx + ty)))
        };
        [lateral(jx, tx), lateral(jy, ty), -a * b / (tx * ty)]
    };
    largest(stresses, poisson, peak, scale)
}

/// Points of the search for the depth, up to two half-widths, below which shear only falls.
const SEARCH: usize = 64;

/// Largest shear of principal stresses that depend on the depth in units of `scale`, per peak pressure.
fn largest(
    stresses: impl Fn(f64) -> [f64; 3],
    poisson: f64,
    peak: f64,
    scale: f64,
) -> Result<Shear> {
    require("poisson", poisson, poisson > -1.0 && poisson <= 0.5, "above -1 and at most 0.5")?;
    let shear = |z: f64| {
        let [x, y, z] = stresses(z);
        0.5 * (x.max(y).max(z) - x.min(y).min(z))
    };
    let step = 2.0 / SEARCH as f64;
    let points = (0..=SEARCH).map(|k| k as f64 * step);
    let best = points.fold(0.0, |best, z| if shear(z) > shear(best) { z } else { best });
    // Golden section between the neighbours of the best point.
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = ((best - step).max(0.0), best + step);
    while high - low > 1e-9 {
        let width = golden * (high - low);
        if shear(high - width) > shear(low + width) {
            high = low + width;
        } else {
            low = high - width;
        }
    }
    let middle = 0.5 * (low + high);
    // At the surface itself, the section ends beside it.
    let z = if shear(best) >= shear(middle) { best } else { middle };
    Ok(Shear { stress: peak * shear(z), depth: scale * z })
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
        for (m, exact) in
            [(0.0, 0.5 * PI), (0.5, 1.854_074_677_301_372), (0.9, 2.578_092_113_348_173)]
        {
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
            let ratio = carlson_rd([0.0, 1.0, square]) / carlson_rd([0.0, square, 1.0]);
            assert!((ratio / radii - 1.0).abs() < 1e-12, "{radii:e}: {ratio:e}");
        }
    }
}
