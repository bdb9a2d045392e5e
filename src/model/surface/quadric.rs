//! Spheres, paraboloids, cylinders and flat punches.

use ndarray::Array2;

use super::{Extent, Surface, absent, by_difference, sagitta_slope, sampled};
use crate::error::{Result, positive, require};
use crate::model::data::value;
use crate::model::grid::Grid;
use crate::model::hertz::equivalent_radius;

/// Rolling direction of a shape whose axis lies along x.
pub(super) const ACROSS: [f64; 2] = [0.0, 1.0];

/// Returns the radius of a convex shape; for one below 0 the error says how a concave counterpart is given.
pub(super) fn convex(name: &'static str, radius: f64) -> Result<f64> {
    let requirement = "that of a convex shape (for a concave raceway or groove use counter_radius), finite and above 0";
    require(name, radius, radius >= 0.0 || radius.is_nan(), requirement)?;
    positive(name, radius)
}

/// Returns the radius of a shape that is convex, or flat where it is infinite.
fn convex_or_flat(name: &'static str, radius: f64) -> Result<f64> {
    if radius == f64::INFINITY { Ok(radius) } else { convex(name, radius) }
}

/// Radii that are infinite as data: nothing, as JSON has no infinite numbers.
#[cfg(feature = "serde")]
mod flat_as_nothing {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(radius: &f64, to: S) -> Result<S::Ok, S::Error> {
        Some(*radius).filter(|radius| radius.is_finite()).serialize(to)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(of: D) -> Result<f64, D::Error> {
        Ok(Option::deserialize(of)?.unwrap_or(f64::INFINITY))
    }
}

/// Names of the radii of a counterpart along x and y.
const COUNTER_RADII: [&str; 2] = ["counter_radius_x", "counter_radius_y"];

/// A sphere: h = R − √(R² − r²), and +∞ for r > R.
///
/// It is pressed on a plane, or on a counterpart that is curved itself, such as a groove or a socket:
/// [`Sphere::with_counter_radii`]. The gap to a counterpart is that of two circles in every direction.
///
/// ```
/// use nacre::{Sphere, Surface};
/// assert_eq!(Sphere::new(5.0)?.gap(3.0, 0.0), 1.0);
/// // A ball in a groove that is concave across (x) and convex along (y), as of an inner ring.
/// let ball = Sphere::new(5e-3)?.with_counter_radii([Some(-5.2e-3), Some(20e-3)])?;
/// assert!((ball.equivalent_radii()[0] / 130e-3 - 1.0).abs() < 1e-14);
/// assert!((ball.equivalent_radii()[1] / 4e-3 - 1.0).abs() < 1e-14);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    radius: f64,
    counterpart: Counterpart,
}

impl Sphere {
    /// A sphere of `radius` \[m\].
    ///
    /// # Errors
    /// Unless `radius` is finite and above 0.
    pub fn new(radius: f64) -> Result<Self> {
        Ok(Self { radius: convex("radius", radius)?, counterpart: Counterpart::default() })
    }

    /// This sphere on a counterpart with radii of curvature along x and y \[m\]: above 0 where it is
    /// convex, below 0 where it is concave (a groove, a socket), `None` or infinite where it is straight.
    ///
    /// # Errors
    /// Unless each radius is above 0, or below minus the radius of the sphere.
    pub fn with_counter_radii(self, radii: [Option<f64>; 2]) -> Result<Self> {
        Ok(Self { counterpart: Counterpart::new(COUNTER_RADII, radii, [self.radius; 2])?, ..self })
    }

    /// Radius of the sphere \[m\].
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Radii of the counterpart along x and y \[m\]; `None` where it is straight.
    pub fn counter_radii(&self) -> [Option<f64>; 2] {
        self.counterpart.radii
    }

    /// Equivalent radii along x and y \[m\], 1/(1/R + 1/R_counter), which formulas of Hertz take.
    pub fn equivalent_radii(&self) -> [f64; 2] {
        self.counterpart.equivalent([self.radius; 2])
    }
}

value! {
    Sphere by SphereData {
        radius: f64 = of.radius();
        counter_radius_x: Option<f64> = of.counter_radii()[0];
        counter_radius_y: Option<f64> = of.counter_radii()[1];
    }
    of, fields => Self::new(fields.radius)?
        .with_counter_radii([fields.counter_radius_x, fields.counter_radius_y])
}

impl Surface for Sphere {
    fn gap(&self, x: f64, y: f64) -> f64 {
        sagitta(self.radius, x * x + y * y) + self.counterpart.gap(x, y)
    }

    fn is_round(&self) -> bool {
        let [x, y] = self.counter_radii();
        x == y
    }

    fn extent(&self) -> [Extent; 2] {
        let reach = self.counterpart.reach([self.radius; 2]);
        reach.map(|half| Extent::Within([-half, half]))
    }

    fn radii(&self) -> [f64; 2] {
        self.counterpart.smaller([self.radius; 2])
    }

    fn parameters(&self) -> Vec<(String, f64)> {
        let own = [("radius", Some(self.radius))];
        let counter = COUNTER_RADII.into_iter().zip(self.counter_radii());
        present(own.into_iter().chain(counter))
    }

    fn gap_derivative(&self, name: &str, grid: &Grid) -> Result<Array2<f64>> {
        if name == "radius" {
            let (x, y) = (grid.x(), grid.y());
            let square = |i: usize, j: usize| x[i] * x[i] + y[j] * y[j];
            return Ok(sampled(grid, |i, j| sagitta_slope(self.radius, square(i, j))));
        }
        let (axis, radius) = counter_radius(name, self.counter_radii())?;
        by_difference(radius, |radius| {
            let mut radii = self.counter_radii();
            radii[axis] = Some(radius);
            self.with_counter_radii(radii)?.gaps(grid)
        })
    }
}

/// Names and values of the radii that a shape has.
fn present<'a>(numbers: impl Iterator<Item = (&'a str, Option<f64>)>) -> Vec<(String, f64)> {
    let named = |(name, value): (&str, Option<f64>)| {
        Some((name.to_owned(), value.filter(|radius| radius.is_finite())?))
    };
    numbers.filter_map(named).collect()
}

/// Axis and value of the radius `name` of a counterpart.
fn counter_radius(name: &str, radii: [Option<f64>; 2]) -> Result<(usize, f64)> {
    let axis = COUNTER_RADII.iter().position(|one| *one == name);
    let axis_and_radius = axis.and_then(|axis| Some((axis, radii[axis]?)));
    axis_and_radius.ok_or_else(|| absent(name))
}

/// An elliptic paraboloid: h = x²/2R_x + y²/2R_y.
///
/// On a counterpart that is curved itself, R_x and R_y are the equivalent radii of both.
///
/// ```
/// use nacre::{Paraboloid, Surface};
/// assert_eq!(Paraboloid::new(2.0, 1.0)?.gap(2.0, 1.0), 1.5);
/// // In a trough of radius 2 along y: 1/1 − 1/2 = 1/2.
/// let barrel = Paraboloid::new(2.0, 1.0)?.with_counter_radii([None, Some(-2.0)])?;
/// assert_eq!(barrel.equivalent_radii(), [2.0, 2.0]);
/// assert_eq!(barrel.gap(2.0, 1.0), 1.25);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paraboloid {
    radius_x: f64,
    radius_y: f64,
    counterpart: Counterpart,
    equivalent_radii: [f64; 2],
}

impl Paraboloid {
    /// A paraboloid of radii of curvature `radius_x` and `radius_y` \[m\] at its apex, infinite where it is straight.
    ///
    /// # Errors
    /// Unless both radii are above 0.
    pub fn new(radius_x: f64, radius_y: f64) -> Result<Self> {
        let radius_x = convex_or_flat("radius_x", radius_x)?;
        let radius_y = convex_or_flat("radius_y", radius_y)?;
        let (counterpart, equivalent_radii) = (Counterpart::default(), [radius_x, radius_y]);
        Ok(Self { radius_x, radius_y, counterpart, equivalent_radii })
    }

    /// This paraboloid on a counterpart with radii of curvature along x and y \[m\]: above 0 where it is
    /// convex, below 0 where it is concave (a groove, a raceway), `None` or infinite where it is straight.
    ///
    /// # Errors
    /// Unless each radius is above 0, or below minus that of the paraboloid.
    pub fn with_counter_radii(self, radii: [Option<f64>; 2]) -> Result<Self> {
        let own = [self.radius_x, self.radius_y];
        let counterpart = Counterpart::new(COUNTER_RADII, radii, own)?;
        Ok(Self { counterpart, equivalent_radii: counterpart.equivalent(own), ..self })
    }

    /// Radius of curvature along x \[m\]; ∞ where it is straight.
    pub fn radius_x(&self) -> f64 {
        self.radius_x
    }

    /// Radius of curvature along y \[m\]; ∞ where it is straight.
    pub fn radius_y(&self) -> f64 {
        self.radius_y
    }

    /// Radii of the counterpart along x and y \[m\]; `None` where it is straight.
    pub fn counter_radii(&self) -> [Option<f64>; 2] {
        self.counterpart.radii
    }

    /// Equivalent radii along x and y \[m\], 1/(1/R + 1/R_counter), which formulas of Hertz take.
    pub fn equivalent_radii(&self) -> [f64; 2] {
        self.equivalent_radii
    }
}

value! {
    Paraboloid by ParaboloidData {
        #[serde(with = "flat_as_nothing")]
        radius_x: f64 = of.radius_x();
        #[serde(with = "flat_as_nothing")]
        radius_y: f64 = of.radius_y();
        counter_radius_x: Option<f64> = of.counter_radii()[0];
        counter_radius_y: Option<f64> = of.counter_radii()[1];
    }
    of, fields => Self::new(fields.radius_x, fields.radius_y)?
        .with_counter_radii([fields.counter_radius_x, fields.counter_radius_y])
}

impl Surface for Paraboloid {
    fn gap(&self, x: f64, y: f64) -> f64 {
        let [radius_x, radius_y] = self.equivalent_radii;
        x * x / (2.0 * radius_x) + y * y / (2.0 * radius_y)
    }

    fn extent(&self) -> [Extent; 2] {
        self.equivalent_radii.map(|r| if r.is_finite() { Extent::Rising } else { Extent::Endless })
    }

    fn is_round(&self) -> bool {
        let [x, y] = self.equivalent_radii;
        (x / y - 1.0).abs() < 4.0 * f64::EPSILON
    }

    fn radii(&self) -> [f64; 2] {
        self.counterpart.smaller([self.radius_x, self.radius_y])
    }

    fn parameters(&self) -> Vec<(String, f64)> {
        let own = [("radius_x", Some(self.radius_x)), ("radius_y", Some(self.radius_y))];
        let counter = COUNTER_RADII.into_iter().zip(self.counter_radii());
        present(own.into_iter().chain(counter))
    }

    /// −x²/2R², for its own radii and those of its counterpart.
    fn gap_derivative(&self, name: &str, grid: &Grid) -> Result<Array2<f64>> {
        let (axis, radius) = match name {
            "radius_x" => (0, self.radius_x),
            "radius_y" => (1, self.radius_y),
            _ => counter_radius(name, self.counter_radii())?,
        };
        let coordinates = [grid.x(), grid.y()];
        Ok(sampled(grid, |i, j| {
            let ratio = coordinates[axis][[i, j][axis]] / radius;
            -0.5 * ratio * ratio
        }))
    }
}

/// A cylinder of infinite length along x: h = R − √(R² − y²), and +∞ for |y| > R.
///
/// On a raceway of radius R_2, which is below 0 for a concave one, h has R_2 − √(R_2² − y²) added.
///
/// ```
/// use nacre::{Cylinder, Surface};
/// assert_eq!(Cylinder::new(5.0)?.gap(7.0, 4.0), 2.0);
/// let in_a_raceway = Cylinder::new(5e-3)?.with_counter_radius(-30e-3)?;
/// assert!((in_a_raceway.equivalent_radius() / 6e-3 - 1.0).abs() < 1e-14);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cylinder {
    radius: f64,
    counterpart: Counterpart,
}

impl Cylinder {
    /// A cylinder of `radius` \[m\], which is a plane where it is infinite.
    ///
    /// # Errors
    /// Unless `radius` is above 0.
    pub fn new(radius: f64) -> Result<Self> {
        Ok(Self { radius: convex_or_flat("radius", radius)?, counterpart: Counterpart::default() })
    }

    /// This cylinder on a raceway of radius `counter_radius` \[m\] along y: above 0 where the raceway is
    /// convex, as of an inner ring, below 0 where it is concave, as of an outer ring, and infinite for a plane.
    ///
    /// # Errors
    /// Unless `counter_radius` is above 0, or below minus the radius of the cylinder.
    pub fn with_counter_radius(self, counter_radius: f64) -> Result<Self> {
        Ok(Self { counterpart: Counterpart::cylindrical(counter_radius, self.radius)?, ..self })
    }

    /// Radius of the cylinder \[m\]; ∞ for a plane.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Radius of the raceway along y \[m\]; `None` for a plane.
    pub fn counter_radius(&self) -> Option<f64> {
        self.counterpart.radii[1]
    }

    /// Equivalent radius \[m\], 1/(1/R + 1/R_counter), which formulas of Hertz take.
    pub fn equivalent_radius(&self) -> f64 {
        self.counterpart.equivalent([self.radius; 2])[1]
    }
}

value! {
    Cylinder by CylinderData {
        #[serde(with = "flat_as_nothing")]
        radius: f64 = of.radius();
        counter_radius: Option<f64> = of.counter_radius();
    }
    of, fields => {
        let cylinder = Self::new(fields.radius)?;
        match fields.counter_radius {
            Some(radius) => cylinder.with_counter_radius(radius),
            None => Ok(cylinder),
        }
    }
}

impl Surface for Cylinder {
    fn gap(&self, x: f64, y: f64) -> f64 {
        sagitta(self.radius, y * y) + self.counterpart.gap(x, y)
    }

    fn extent(&self) -> [Extent; 2] {
        let [_, half] = self.counterpart.reach([self.radius; 2]);
        let across = if half.is_finite() { Extent::Within([-half, half]) } else { Extent::Endless };
        [Extent::Endless, across]
    }

    fn radii(&self) -> [f64; 2] {
        [f64::INFINITY, self.counterpart.smaller([self.radius; 2])[1]]
    }

    fn parameters(&self) -> Vec<(String, f64)> {
        let numbers = [("radius", Some(self.radius)), ("counter_radius", self.counter_radius())];
        present(numbers.into_iter())
    }

    fn gap_derivative(&self, name: &str, grid: &Grid) -> Result<Array2<f64>> {
        match (name, self.counter_radius()) {
            ("radius", _) => {
                let y = grid.y();
                Ok(sampled(grid, |_, j| sagitta_slope(self.radius, y[j] * y[j])))
            }
            ("counter_radius", Some(radius)) => {
                by_difference(radius, |radius| self.with_counter_radius(radius)?.gaps(grid))
            }
            _ => Err(absent(name)),
        }
    }

    fn rolling_direction(&self) -> Option<[f64; 2]> {
        Some(ACROSS)
    }
}

/// A flat circular punch: h = 0 for r ≤ a, and +∞ beyond.
///
/// ```
/// use nacre::{FlatPunch, Surface};
/// let punch = FlatPunch::new(1.0)?;
/// assert_eq!((punch.gap(1.0, 0.0), punch.gap(1.0, 0.1)), (0.0, f64::INFINITY));
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlatPunch {
    radius: f64,
}

impl FlatPunch {
    /// A punch of `radius` a \[m\].
    ///
    /// # Errors
    /// Unless `radius` is finite and above 0.
    pub fn new(radius: f64) -> Result<Self> {
        Ok(Self { radius: positive("radius", radius)? })
    }

    /// Radius of the punch \[m\].
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

value! {
    FlatPunch by FlatPunchData { radius: f64 = of.radius(); }
    of, fields => Self::new(fields.radius)
}

impl Surface for FlatPunch {
    fn gap(&self, x: f64, y: f64) -> f64 {
        if x * x + y * y <= self.radius * self.radius { 0.0 } else { f64::INFINITY }
    }

    fn is_round(&self) -> bool {
        true
    }

    fn extent(&self) -> [Extent; 2] {
        [Extent::Within([-self.radius, self.radius]); 2]
    }

    /// Not: cells join and leave its face one by one.
    fn is_smooth(&self) -> bool {
        false
    }
}

/// Surface of the body that a shape is pressed on: a piece of a torus, of which every section along x and
/// the section y = 0 are circles. It touches the plane z = 0 at the origin.
///
/// ```text
/// d(x)    = R_x − √(R_x² − x²)                  in the section y = 0
/// h(x, y) = R_y − √((R_y − d(x))² − y²)
/// ```
///
/// A radius is above 0 where the counterpart is convex, below 0 where it is concave, and `None` where it
/// is straight, which an infinite one becomes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Counterpart {
    /// Radii along x and y \[m\].
    pub(super) radii: [Option<f64>; 2],
}

impl Counterpart {
    /// A counterpart with `radii` along x and y \[m\] under a shape with the convex radii `shape`.
    pub(super) fn new(
        names: [&'static str; 2],
        radii: [Option<f64>; 2],
        shape: [f64; 2],
    ) -> Result<Self> {
        for ((name, counter), own) in names.into_iter().zip(radii).zip(shape) {
            let requirement = "above 0 (convex), below minus the radius of the shape (a concave raceway or groove is wider \
                               than the shape), or infinite (flat)";
            if let Some(value) = counter.filter(|radius| !radius.is_infinite()) {
                let is_convex = equivalent_radius(Some(own), counter).is_ok();
                require(name, value, is_convex, requirement)?;
            }
        }
        Ok(Self { radii: radii.map(|radius| radius.filter(|radius| radius.is_finite())) })
    }

    /// A counterpart that is straight along x.
    pub(super) fn cylindrical(counter_radius: f64, shape: f64) -> Result<Self> {
        let names = ["counter_radius"; 2];
        Self::new(names, [None, Some(counter_radius)], [shape; 2])
    }

    /// Equivalent radii \[m\] of a shape with the radii `shape` on this counterpart.
    pub(super) fn equivalent(&self, shape: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| match (shape[axis], self.radii[axis]) {
            (f64::INFINITY, None) => f64::INFINITY,
            (own, counter) => match equivalent_radius(Some(own), counter) {
                Ok(radius) => radius,
                Err(_) => unreachable!("the constructor has checked it"),
            },
        })
    }

    /// Smaller of the radii of shape and counterpart along x and y \[m\], without their signs.
    pub(super) fn smaller(&self, shape: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| self.radii[axis].map_or(shape[axis], |r| shape[axis].min(r.abs())))
    }

    /// Half-widths \[m\] along x and y of a shape with the half-widths `shape`, as far as a convex
    /// counterpart reaches.
    pub(super) fn reach(&self, shape: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| match self.radii[axis] {
            Some(radius) if radius > 0.0 => shape[axis].min(radius),
            _ => shape[axis],
        })
    }

    /// Distance \[m\] of this surface from the plane z = 0 at (x, y), below 0 where it rises beside a
    /// concave origin, and +∞ beyond its end.
    pub(super) fn gap(&self, x: f64, y: f64) -> f64 {
        let drop = self.radii[0].map_or(0.0, |radius| arc(radius, x * x));
        let Some(radius) = self.radii[1] else {
            return drop;
        };
        let local = radius - drop;
        if drop.is_infinite() || local * radius <= 0.0 {
            return f64::INFINITY;
        }
        drop + arc(local, y * y)
    }
}

/// R − √(R² − s), computed without cancellation; +∞ where s > R².
///
/// ```text
/// R − √(R² − s) = s / (R + √(R² − s))
/// ```
pub(super) fn sagitta(radius: f64, s: f64) -> f64 {
    let under = radius * radius - s;
    if under < 0.0 { f64::INFINITY } else { s / (radius + under.sqrt()) }
}

/// R − √(R² − s) with the sign of R, and +∞ where s > R².
fn arc(radius: f64, s: f64) -> f64 {
    let depth = sagitta(radius.abs(), s);
    if depth.is_infinite() { depth } else { depth.copysign(radius) }
}
