//! Rollers of finite length.

use ndarray::{Array1, Array2};

use super::profile::{CrownedProfile, Profile};
use super::quadric::{ACROSS, Counterpart, convex, sagitta};
use super::{Extent, Surface, absent, by_difference, sagitta_slope, sampled};
use crate::error::{Result, positive, require};
use crate::model::data::value;
use crate::model::grid::Grid;

/// A roller of radius R with its axis along x and an axial profile d(x).
///
/// ```text
/// h = R − √((R − d)² − y²)
/// ```
///
/// Spinu et al., The normal contact of finite length coated cylinders, eq. (3). The gap is +∞ where
/// the root has no value, beyond the ends of the profile, and beyond |x| = `length` / 2 where a
/// length is given. On a grid, the drop d of a crowned profile is taken at cell centres. Other
/// profiles are steep at the ends, and their drop is averaged over each cell.
///
/// On a raceway of radius R_2, which is below 0 for a concave one, h has R_2 − √(R_2² − y²) added:
/// [`Roller::with_counter_radius`]. The radii of a tapered roller and of its raceway are those at x = 0
/// and vanish at the common apex x_A, so that with s = 1 − x/x_A the gap is
/// s h(d/s, y/s): [`Roller::with_apex`].
///
/// ```
/// use nacre::{LogarithmicProfile, Roller, Surface};
/// let roller = Roller::new(5e-3, 19.13e-3, 7.5)?.with_length(26e-3)?;
/// assert!((roller.gap(0.0, 3e-3) / 1e-3 - 1.0).abs() < 1e-15);
/// assert_eq!(roller.gap(14e-3, 0.0), f64::INFINITY);
///
/// let iso = Roller::with_profile(5e-3, LogarithmicProfile::iso16281(10e-3, 20e-3)?)?;
/// assert!((iso.gap(5e-3, 0.0) / (3.5e-6 * (4.0_f64 / 3.0).ln()) - 1.0).abs() < 1e-9);
///
/// // On the raceways of an inner ring (convex) and of an outer ring (concave).
/// let inner = iso.clone().with_counter_radius(20e-3)?;
/// let outer = iso.with_counter_radius(-30e-3)?;
/// assert!((inner.equivalent_radius() / 4e-3 - 1.0).abs() < 1e-14);
/// assert!((outer.equivalent_radius() / 6e-3 - 1.0).abs() < 1e-14);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Roller {
    radius: f64,
    profile: Profile,
    length: Option<f64>,
    counterpart: Counterpart,
    apex: Option<f64>,
}

impl Roller {
    /// A roller of `radius` \[m\], straight over `flat_length` ≥ 0 \[m\], with ends rounded with
    /// `crown_radius` \[m\].
    ///
    /// # Errors
    /// Unless both radii are finite and above 0, and `flat_length` is finite and at least 0.
    pub fn new(radius: f64, flat_length: f64, crown_radius: f64) -> Result<Self> {
        Self::with_profile(radius, CrownedProfile::new(flat_length, crown_radius)?)
    }

    /// A roller of `radius` \[m\] with any axial profile.
    ///
    /// # Errors
    /// Unless `radius` is finite and above 0.
    pub fn with_profile(radius: f64, profile: impl Into<Profile>) -> Result<Self> {
        Ok(Self {
            radius: convex("radius", radius)?,
            profile: profile.into(),
            length: None,
            counterpart: Counterpart::default(),
            apex: None,
        })
    }

    /// This roller on a raceway of radius `counter_radius` \[m\] along y: above 0 where the raceway is
    /// convex, as of an inner ring, below 0 where it is concave, as of an outer ring, and infinite for a plane. A
    /// crown of the raceway is part of the profile: its drop adds to that of the roller.
    ///
    /// # Errors
    /// Unless `counter_radius` is above 0, or below minus the radius of the roller.
    pub fn with_counter_radius(self, counter_radius: f64) -> Result<Self> {
        Ok(Self { counterpart: Counterpart::cylindrical(counter_radius, self.radius)?, ..self })
    }

    /// This roller as a cone that rolls on a conical raceway about the same apex at x = `apex` \[m\], where both
    /// end. x runs along the line of contact, and the radii of roller and raceway are those of the normal sections:
    /// half the diameter over the cosine of the half angle of each cone. The profile is normal to the line.
    ///
    /// # Errors
    /// Unless `apex` is finite and not 0.
    ///
    /// ```
    /// use nacre::{Roller, SampledProfile, Surface};
    /// let straight = Roller::with_profile(5e-3, SampledProfile::new(&[-0.01, 0.01], &[0.0; 2])?)?;
    /// let tapered = straight.with_counter_radius(20e-3)?.with_apex(0.1)?;
    /// // At 8 mm of 100 mm the radii are 8 % smaller.
    /// assert!((tapered.gap(8e-3, 1e-4) / (1e-8 / (2.0 * 0.92 * 4e-3)) - 1.0).abs() < 1e-3);
    /// # Ok::<(), nacre::Error>(())
    /// ```
    pub fn with_apex(self, apex: f64) -> Result<Self> {
        require("apex", apex, apex.is_finite() && apex != 0.0, "finite and not 0")?;
        Ok(Self { apex: Some(apex), ..self })
    }

    /// This roller, cut off at |x| = `length` / 2 \[m\].
    ///
    /// # Errors
    /// Unless `length` is finite, above 0 and at least the flat length of a crowned profile.
    pub fn with_length(self, length: f64) -> Result<Self> {
        positive("length", length)?;
        if let Profile::Crowned(crowned) = &self.profile {
            let holds = length >= crowned.flat_length();
            require("length", length, holds, "at least flat_length")?;
        }
        Ok(Self { length: Some(length), ..self })
    }

    /// Radius of the roller \[m\].
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Radius of the raceway along y \[m\]; `None` for a plane.
    pub fn counter_radius(&self) -> Option<f64> {
        self.counterpart.radii[1]
    }

    /// Coordinate x \[m\] of the apex of a tapered roller and its raceway; `None` of a cylindrical one.
    pub fn apex(&self) -> Option<f64> {
        self.apex
    }

    /// Equivalent radius along y \[m\], 1/(1/R + 1/R_counter), which formulas of Hertz take.
    pub fn equivalent_radius(&self) -> f64 {
        self.counterpart.equivalent([self.radius; 2])[1]
    }

    /// Axial profile of the roller.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// Length at which the roller is cut off \[m\]; `None` where only the profile ends it.
    pub fn length(&self) -> Option<f64> {
        self.length
    }

    /// Coordinates x \[m\] of the ends, which its body takes ([`HalfSpace::with_ends`]): ±`length` / 2 or, without
    /// a length, the ends of a logarithmic or sampled profile. `None` where a crown ends the roller.
    ///
    /// ```
    /// use nacre::{Elastic, HalfSpace, Roller};
    /// let roller = Roller::new(5e-3, 8e-3, 7.5)?.with_length(10e-3)?;
    /// let body = HalfSpace::from(Elastic::new(210e9, 0.3)?).with_ends(roller.ends())?;
    /// assert_eq!(body.ends(), [Some(-5e-3), Some(5e-3)]);
    /// # Ok::<(), nacre::Error>(())
    /// ```
    ///
    /// [`HalfSpace::with_ends`]: crate::HalfSpace::with_ends
    pub fn ends(&self) -> [Option<f64>; 2] {
        match self.length {
            Some(length) => [-0.5 * length, 0.5 * length].map(Some),
            None if self.profile.has_sharp_ends() => self.profile.ends().map(Some),
            None => [None; 2],
        }
    }

    /// Whether x is within the length of the roller.
    fn reaches(&self, x: f64) -> bool {
        self.length.is_none_or(|length| x.abs() <= 0.5 * length)
    }

    /// Drops of the rows of `grid`; +∞ beyond the ends.
    fn drops(&self, grid: &Grid) -> Array1<f64> {
        let half = 0.5 * grid.spacing()[0];
        grid.x().mapv(|x| {
            if self.reaches(x) { self.profile.mean_drop(x - half, x + half) } else { f64::INFINITY }
        })
    }

    /// Radii at x over those at x = 0; at most 0 at the apex and beyond it.
    fn scale(&self, x: f64) -> f64 {
        self.apex.map_or(1.0, |apex| 1.0 - x / apex)
    }

    /// Ends of the profile along x.
    fn natural_span(&self) -> [f64; 2] {
        match &self.profile {
            Profile::Crowned(crowned) => {
                // The crown ends where the drop is R, or at a quarter of the crown's circle.
                let (r, ra) = (self.radius, crowned.crown_radius());
                let crown = if r < ra { (r * (2.0 * ra - r)).sqrt() } else { ra };
                let half = 0.5 * crowned.flat_length() + crown;
                [-half, half]
            }
            other => other.ends(),
        }
    }

    /// Ends of the profile along x, cut off by the length.
    fn span(&self) -> [f64; 2] {
        let half = 0.5 * self.length.unwrap_or(f64::INFINITY);
        self.natural_span().map(|x| x.clamp(-half, half))
    }

    /// Scale at the end that is nearer to the apex; 0 where the roller ends at the apex.
    fn smallest_scale(&self) -> f64 {
        self.span().map(|x| self.scale(x)).into_iter().fold(1.0, f64::min).max(0.0)
    }

    /// Scales of the rows of `grid`.
    fn scales(&self, grid: &Grid) -> Array1<f64> {
        grid.x().mapv(|x| self.scale(x))
    }

    /// Gap for the drop d where the radii have the `scale` s.
    fn scaled_gap(&self, scale: f64, drop: f64, y: f64) -> f64 {
        if scale > 0.0 { scale * self.gap_at(drop / scale, y / scale) } else { f64::INFINITY }
    }

    /// Gap R − √((R − d)² − y²) to a plane for the drop d, computed from (R − d)² − y² = R² − (d (2R − d) + y²).
    fn gap_at(&self, drop: f64, y: f64) -> f64 {
        if drop > self.radius {
            return f64::INFINITY;
        }
        sagitta(self.radius, drop * (2.0 * self.radius - drop) + y * y)
            + self.counterpart.gap(0.0, y)
    }
}

value! {
    Roller by RollerData {
        radius: f64 = of.radius();
        profile: Profile = of.profile().clone();
        length: Option<f64> = of.length();
        counter_radius: Option<f64> = of.counter_radius();
        #[serde(default, skip_serializing_if = "crate::model::data::is_default")]
        apex: Option<f64> = of.apex();
    }
    of, fields => {
        let mut roller = Self::with_profile(fields.radius, fields.profile)?;
        if let Some(length) = fields.length {
            roller = roller.with_length(length)?;
        }
        if let Some(radius) = fields.counter_radius {
            roller = roller.with_counter_radius(radius)?;
        }
        match fields.apex {
            Some(apex) => roller.with_apex(apex),
            None => Ok(roller),
        }
    }
}

impl Surface for Roller {
    fn gap(&self, x: f64, y: f64) -> f64 {
        if self.reaches(x) {
            self.scaled_gap(self.scale(x), self.profile.drop(x), y)
        } else {
            f64::INFINITY
        }
    }

    fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
        let (drops, scales, y) = (self.drops(grid), self.scales(grid), grid.y());
        Ok(sampled(grid, |i, j| self.scaled_gap(scales[i], drops[i], y[j])))
    }

    fn extent(&self) -> [Extent; 2] {
        let (ends, natural) = (self.span(), self.natural_span());
        let cut = self.profile.has_sharp_ends() || natural[0] < ends[0] || ends[1] < natural[1];
        let x = if cut { Extent::CutOff(ends) } else { Extent::Within(ends) };
        let [_, half] = self.counterpart.reach([self.smallest_scale() * self.radius; 2]);
        [x, Extent::Within([-half, half])]
    }

    fn endless_crown(&self) -> Option<[f64; 2]> {
        match (&self.profile, self.length) {
            (Profile::Crowned(crowned), None) => {
                let half = 0.5 * crowned.flat_length();
                Some([-half, half])
            }
            _ => None,
        }
    }

    fn marks(&self) -> [Vec<f64>; 2] {
        [self.profile.marks(), Vec::new()]
    }

    fn radii(&self) -> [f64; 2] {
        let [_, smaller] = self.counterpart.smaller([self.radius; 2]);
        [self.profile.radius(), self.smallest_scale() * smaller]
    }

    fn rolling_direction(&self) -> Option<[f64; 2]> {
        Some(ACROSS)
    }

    fn alternatives(&self) -> Vec<Box<dyn Surface + '_>> {
        let others = self.profile.alternatives().into_iter();
        others.map(|profile| Box::new(Self { profile, ..self.clone() }) as Box<_>).collect()
    }

    /// Radii, the apex, and the numbers of the profile: `flat_length` and `crown_radius`, `profile.amplitude`,
    /// `profile.flat_length` and `profile.end_factor`, or `profile.drop[k]`.
    fn parameters(&self) -> Vec<(String, f64)> {
        let mut parameters = vec![("radius".to_owned(), self.radius)];
        parameters.extend(self.counter_radius().map(|r| ("counter_radius".to_owned(), r)));
        parameters.extend(self.apex.map(|x| ("apex".to_owned(), x)));
        parameters.extend(self.profile.parameters());
        parameters
    }

    /// With the root of [`Roller`], ∂h/∂R = 1 − (R − d)/√ and ∂h/∂d = (R − d)/√, of d/s and y/s at the scale s.
    fn gap_derivative(&self, name: &str, grid: &Grid) -> Result<Array2<f64>> {
        let (drops, scales, y) = (self.drops(grid), self.scales(grid), grid.y());
        let per_radius = |i: usize, j: usize| {
            let [drop, y] = [drops[i], y[j]].map(|length| length / scales[i]);
            match scales[i] > 0.0 && drop < self.radius {
                true => sagitta_slope(self.radius - drop, y * y),
                false => 0.0,
            }
        };
        match (name, self.counter_radius(), self.apex) {
            ("radius", ..) => Ok(sampled(grid, |i, j| scales[i] * per_radius(i, j))),
            ("counter_radius", Some(radius), _) => {
                by_difference(radius, |radius| self.clone().with_counter_radius(radius)?.gaps(grid))
            }
            ("apex", _, Some(apex)) => {
                by_difference(apex, |apex| self.clone().with_apex(apex)?.gaps(grid))
            }
            _ => {
                let half = 0.5 * grid.spacing()[0];
                let cells: Vec<[f64; 2]> = grid.x().iter().map(|x| [x - half, x + half]).collect();
                let slopes = self.profile.mean_drop_slopes(name, &cells);
                let slopes = slopes.ok_or_else(|| absent(name))?;
                Ok(sampled(grid, |i, j| match drops[i].is_finite() {
                    true => slopes[i] * (1.0 - per_radius(i, j)),
                    false => 0.0,
                }))
            }
        }
    }
}
