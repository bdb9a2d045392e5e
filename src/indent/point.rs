//! States of an indentation.

use std::fmt;
use std::sync::Arc;

use super::adhesion::{Adhesion, Control};
use super::equation::stack::StackLevel;
use super::equation::{Parts, add, times};
use super::pressure::{Answer, Density, WHOLE, Zone, bessel_sum};
use super::tip::Tip;
use crate::error::{Result, not_negative};

mod disc;
mod interior;

pub use interior::InteriorStress;

/// One state of an indentation.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Point {
    /// Contact radius a \[m\].
    pub radius: f64,
    /// Load P \[N\], below 0 where the tip is pulled.
    pub load: f64,
    /// Approach δ \[m\].
    pub approach: f64,
    /// Stiffness dP/dδ of this contact area \[N/m\]: that of unloading, and without adhesion that along the curve.
    pub stiffness: f64,
    /// Its derivative with respect to the contact radius \[N/m²\].
    pub stiffness_slope: f64,
    /// Radius \[m\] up to which the surfaces attract each other, with the adhesion of Maugis and Dugdale.
    pub outer_radius: Option<f64>,
    pub(super) parts: Arc<Parts>,
    pub(super) adhesion: Adhesion,
    pub(super) zone: Option<Zone>,
}

impl Point {
    /// The contact of `parts` at an `approach`.
    pub(super) fn new(parts: Arc<Parts>, adhesion: Adhesion, approach: f64) -> Self {
        let [stiffness, profile] = parts.loads;
        Self {
            radius: parts.system.radius,
            load: stiffness * approach - profile - adhesion.outside(&parts.tip),
            approach,
            stiffness,
            stiffness_slope: parts.stiffness_slope(),
            outer_radius: None,
            parts,
            adhesion,
            zone: None,
        }
    }

    /// Load or approach, whichever is controlled.
    pub(super) fn value(&self, control: Control) -> f64 {
        control.of([self.approach, self.load])
    }

    /// φ in the basis.
    pub(super) fn values(&self) -> Vec<f64> {
        self.combined(|parts| &parts.values, |answer| &answer.values)
    }

    /// p̂ at the waves, with that of a cohesive zone.
    pub(super) fn hat(&self) -> Vec<f64> {
        self.combined(|parts| &parts.hats, |answer| &answer.hat)
    }

    fn combined<'a>(
        &'a self,
        of: impl Fn(&'a Parts) -> &'a [Vec<f64>; 2],
        more: impl Fn(&'a Answer) -> &'a [f64],
    ) -> Vec<f64> {
        let [punch, profile] = of(&self.parts);
        let pairs = punch.iter().zip(profile);
        let mut all: Vec<f64> = pairs.map(|(a, b)| self.approach * a - b).collect();
        if let Some(zone) = &self.zone {
            add(&mut all, 1.0, more(&zone.answer));
        }
        all
    }

    /// φ at the edge.
    pub(super) fn edge(&self) -> f64 {
        let [punch, profile] = self.parts.edge;
        self.zone.as_ref().map_or(0.0, |zone| zone.answer.edge) + self.approach * punch - profile
    }

    /// The density of the state.
    pub(super) fn density(&self) -> Density<'_> {
        let f = self.parts.f();
        Density {
            parts: &self.parts,
            known: [f * self.approach, f],
            rate: None,
            g: times(self.parts.system.excess(), &self.hat()),
            edge: self.exact_edge(),
        }
    }

    /// φ at the edge, without the rounding of what vanishes there.
    pub(super) fn exact_edge(&self) -> f64 {
        let is_sharp = self.parts.tip.fixed_radius().is_some();
        match (self.adhesion, &self.zone) {
            (_, Some(_)) => self.edge(),
            (Adhesion::None | Adhesion::Dmt { .. }, None) if !is_sharp => 0.0,
            (Adhesion::Jkr { .. }, None) if !is_sharp => {
                self.adhesion.edge(self.parts.stack.surface_modulus(), self.radius)
            }
            _ => self.edge(),
        }
    }

    /// Pressure at each distance r from the axis \[Pa\], 0 outside of the contact; +∞ on the axis below a sharp tip, and ±∞
    /// at an edge where it has no limit. The stress of a cohesive zone is negative.
    ///
    /// # Errors
    /// A distance that is negative or not finite.
    pub fn pressure(&self, r: &[f64]) -> Result<Vec<f64>> {
        check_distances(r)?;
        let (density, a) = (self.density(), self.radius);
        let at = |r: &f64| -> f64 {
            if *r > a {
                return self.zone.as_ref().map_or(0.0, |zone| zone.outside(*r));
            }
            if let Some(zone) = &self.zone {
                // φ continues into the zone, so that no edge is singular.
                let from_contact = match *r < a {
                    true => Density { edge: 0.0, ..self.density() }.pressure(*r),
                    false => 0.0,
                };
                return from_contact + zone.inside(WHOLE, *r);
            }
            if *r >= a {
                return match density.edge.abs() > 0.0 {
                    true => density.edge.signum() * f64::INFINITY,
                    false => 0.0,
                };
            }
            if *r <= 0.0 && self.parts.tip.is_sharp() {
                return f64::INFINITY;
            }
            density.pressure(*r)
        };
        Ok(r.iter().map(at).collect())
    }

    /// Normal displacement of the surfaces of all bodies together at each distance r from the axis \[m\], positive into
    /// them; within the contact it is δ − g(r).
    ///
    /// # Errors
    /// A distance that is negative or not finite.
    pub fn displacement(&self, r: &[f64]) -> Result<Vec<f64>> {
        check_distances(r)?;
        let density = self.density();
        let short = self.parts.stack.short();
        let far = r.iter().fold(0.0_f64, |most, r| most.max(*r));
        let waves = self.wider(far);
        let at = |r: &f64| -> f64 {
            if *r <= self.radius {
                return self.approach - self.parts.tip.gap(*r);
            }
            let zone = self.zone.as_ref().map_or(0.0, |zone| zone.abel(WHOLE, *r));
            let layers =
                waves.as_ref().map_or(0.0, |(g, level)| bessel_sum(g, &level.waves.alpha, *r));
            short * (density.abel(*r) + zone + layers)
        };
        Ok(r.iter().map(at).collect())
    }

    /// Gap between tip and surface \[m\] at each distance r from the axis; +∞ beyond the tip.
    ///
    /// # Errors
    /// A distance that is negative or not finite.
    pub fn gap(&self, r: &[f64]) -> Result<Vec<f64>> {
        let gap = |(r, u): (&f64, f64)| {
            if *r <= self.radius { 0.0 } else { self.parts.tip.gap(*r) + u - self.approach }
        };
        Ok(r.iter().zip(self.displacement(r)?).map(gap).collect())
    }

    /// Weights times M p̂ at the waves of a level that resolves J₀(αr) up to `far`; none of bare bodies.
    pub(super) fn wider(&self, far: f64) -> Option<(Vec<f64>, &Arc<StackLevel>)> {
        let own = self.parts.system.level.as_ref()?;
        // The level of a cohesive zone may already be wider.
        let level = self.parts.stack.level(self.radius + far)?;
        let level = if level.length > own.length { level } else { own };
        let hat = match Arc::ptr_eq(level, own) {
            true => self.hat(),
            false => {
                let system = &self.parts.system;
                let [mut hat] = system.transforms_at(&level.waves, [&self.values()]);
                if let Some(zone) = &self.zone {
                    add(&mut hat, 1.0, &zone.transform(WHOLE, &level.waves));
                }
                hat
            }
        };
        Some((times(&level.excess, &hat), level))
    }

    /// Step of the density at the edge: φ there, but for a cohesive zone, into which φ continues.
    pub(super) fn step(&self) -> f64 {
        match self.zone {
            Some(_) => 0.0,
            None => self.exact_edge(),
        }
    }

    /// What makes the state doubtful; empty as a rule.
    ///
    /// ```
    /// use nacre::indent::{Indent, Stack, Tip};
    /// use nacre::{Elastic, HalfSpace};
    /// let stack = Stack::plan(&[HalfSpace::new(Elastic::new(1.0, 0.3)?, [])?.into()])?;
    /// let indent = Indent::new(&stack, &Tip::sphere(5.0)?);
    /// assert!(indent.at_approach(0.5)?.warnings().is_empty());
    /// assert_eq!(indent.at_approach(10.0)?.warnings()[0].kind(), "steep");
    /// # Ok::<(), nacre::Error>(())
    /// ```
    pub fn warnings(&self) -> Vec<IndentWarning> {
        IndentWarning::of(&self.parts.tip, self.radius, self.approach)
    }
}

/// Slope above which a contact is warned of. The theory leaves out the square of the slope, a quarter here; the cone of Berkovich's
/// pyramid has 0.36.
const STEEP: f64 = 0.5;

/// What makes a state of an indentation doubtful.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum IndentWarning {
    /// The tip is steep within the contact, or the surface at the edge of a flat punch.
    Steep {
        /// Largest slope of the tip within the contact; of a flat punch 2/π of its approach over its radius, the slope of a
        /// cone of the same approach and radius.
        slope: f64,
    },
}

impl IndentWarning {
    /// Warnings of a contact.
    pub(super) fn of(tip: &Tip, radius: f64, approach: f64) -> Vec<Self> {
        let slope = match tip.fixed_radius() {
            Some(a) => approach.abs() / a * std::f64::consts::FRAC_2_PI,
            None => tip.steepest(radius),
        };
        if slope > STEEP { vec![Self::Steep { slope }] } else { vec![] }
    }

    /// Name of the kind of warning, without numbers.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Steep { .. } => "steep",
        }
    }
}

impl fmt::Display for IndentWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Steep { slope } => write!(
                f,
                "the contact is too deep for its radius: its slope against the surface is up to {slope:.2}, and the theory \
                 of small slopes errs by about its square; above {STEEP} it is not to be trusted"
            ),
        }
    }
}

/// The last stable state of a tip that is pulled off.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct PullOff {
    /// What was given.
    pub control: Control,
    /// Load \[N\], below 0.
    pub load: f64,
    /// Approach \[m\].
    pub approach: f64,
    /// Contact radius \[m\]; 0 where the tip lets go while the surfaces attract each other without touching.
    pub radius: f64,
    /// Radius \[m\] up to which the surfaces attract each other, with the adhesion of Maugis and Dugdale.
    pub outer_radius: Option<f64>,
    /// The contact; none where the surfaces do not touch.
    pub point: Option<Point>,
}

/// An error unless each of `r` is a distance from the axis.
pub(super) fn check_distances(r: &[f64]) -> Result<()> {
    r.iter().try_for_each(|r| not_negative("r", *r).map(|_| ()))
}
