//! A tip on a stack: states by radius, load and approach, and where a tip lets go.

use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

use super::adhesion::{Adhesion, Branch, Control};
use super::cohesion::{self, Apart};
use super::parts::Parts;
use super::point::Point;
use super::root::{bracketed, newton};
use super::stack::Stack;
use super::tip::Tip;
use crate::error::{Error, Result, finite, positive};

/// Radii in each factor of e at which the end of an adhering contact is looked for.
const SCAN: usize = 4;

/// Powers of e below the radius of no load in which it is looked for: a bare cone lets go at 1/4 of it, a bare sphere at
/// 1/1.65 of it under a load.
const DEPTH: usize = 8;

/// Smallest contact radius, in end radii or thicknesses, at which a contact is looked for.
const SMALLEST: f64 = 1e-9;

/// A tip on a stack.
#[derive(Debug, Clone)]
pub struct Indent {
    stack: Stack,
    tip: Tip,
    adhesion: Adhesion,
    lasts: [Arc<OnceLock<PullOff>>; 2],
}

/// The last stable state of a tip that is pulled off.
#[derive(Debug, Clone)]
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

impl Indent {
    /// A tip that is pressed into this stack without adhesion.
    pub fn new(stack: &Stack, tip: &Tip) -> Self {
        Self {
            stack: stack.clone(),
            tip: tip.clone(),
            adhesion: Adhesion::None,
            lasts: Default::default(),
        }
    }

    /// The same tip with `adhesion`.
    ///
    /// # Errors
    /// Numbers that are not above 0, and Derjaguin, Muller and Toporov's for a tip without an end radius.
    pub fn with_adhesion(self, adhesion: Adhesion) -> Result<Self> {
        if matches!(adhesion, Adhesion::Dmt { .. }) && self.tip.end_radius().is_none() {
            return Err(Error::Inconsistent(
                "the adhesion of Derjaguin, Muller and Toporov needs a tip with an end radius: a paraboloid, a sphere or a \
                 rounded cone",
            ));
        }
        if matches!(adhesion, Adhesion::Maugis { .. }) && self.tip.fixed_radius().is_some() {
            return Err(Error::Inconsistent(
                "the adhesion of Maugis and Dugdale is for tips whose contact grows: a flat punch has that of Johnson, \
                 Kendall and Roberts",
            ));
        }
        Ok(Self {
            adhesion: adhesion.checked()?,
            lasts: Default::default(),
            ..self
        })
    }

    /// Bodies.
    pub fn stack(&self) -> &Stack {
        &self.stack
    }

    /// Tip.
    pub fn tip(&self) -> &Tip {
        &self.tip
    }

    /// Adhesion.
    pub fn adhesion(&self) -> Adhesion {
        self.adhesion
    }

    /// Smallest and largest contact radius \[m\] that are looked at.
    fn range(&self) -> [f64; 2] {
        let [low, high] = self.tip.range();
        let high = high.min(self.stack.largest_radius());
        let size = self.tip.end_radius().or(self.stack.thickness());
        let low = low.max(SMALLEST * size.unwrap_or(1e-3).min(high));
        [low * (1.0 + 1e-9), high * (1.0 - 1e-9)]
    }

    /// The parts at the radius `a`.
    fn parts(&self, a: f64) -> Result<Arc<Parts>> {
        Ok(Arc::new(Parts::new(&self.stack, &self.tip, a, 0.0)?))
    }

    /// The contact of radius `a` \[m\].
    ///
    /// # Errors
    /// A radius that is not above 0, that the tip cannot have, or beyond 1024 thicknesses of the top layer; a flat punch, whose
    /// radius says nothing of its load; no state with a cohesive zone.
    pub fn at_radius(&self, a: f64) -> Result<Point> {
        if self.tip.fixed_radius().is_some() {
            return Err(Error::Inconsistent(
                "the contact of a flat punch has the radius of the punch at every load: give load or approach",
            ));
        }
        self.state(a)
    }

    fn state(&self, a: f64) -> Result<Point> {
        self.state_from(a, &mut (a.ln() - 3.0))
    }

    /// The contact of radius `a`, whose cohesive zone is looked for as [`cohesion::contact`] says.
    fn state_from(&self, a: f64, start: &mut f64) -> Result<Point> {
        self.tip.check_radius(a)?;
        if let Adhesion::Maugis { work, strength } = self.adhesion {
            return cohesion::contact(&self.stack, &self.tip, a, [work, strength], start);
        }
        let parts = self.parts(a)?;
        let edge = self.adhesion.edge(self.stack.surface_modulus(), a);
        let approach = parts.hertzian() + edge / parts.edge[0];
        Ok(Point::new(parts, self.adhesion, approach))
    }

    /// The contact under a `load` \[N\]: above 0 without adhesion, and above that of pull-off with it.
    ///
    /// # Errors
    /// As [`Indent::at_radius`], a load under which there is no contact or that needs too large a radius, and a contact that is
    /// no disc.
    pub fn at_load(&self, load: f64) -> Result<Point> {
        self.at(Control::Load, load, Branch::Stable)
    }

    /// The contact at an `approach` \[m\]: above 0 without adhesion, and above that of pull-off with it.
    ///
    /// # Errors
    /// As [`Indent::at_load`].
    pub fn at_approach(&self, approach: f64) -> Result<Point> {
        self.at(Control::Approach, approach, Branch::Stable)
    }

    /// The contact at a `value` of what is given, on a branch of the curve.
    ///
    /// # Errors
    /// As [`Indent::at_load`], and no state on this branch.
    pub fn at(&self, control: Control, value: f64, branch: Branch) -> Result<Point> {
        let name = match control {
            Control::Load => "load",
            Control::Approach => "approach",
        };
        finite(name, value)?;
        let floor = match (self.adhesion, control) {
            (Adhesion::None, _) | (Adhesion::Dmt { .. }, Control::Approach) => Some(0.0),
            (Adhesion::Dmt { .. }, Control::Load) => Some(self.pull_off(control)?.load),
            _ => None,
        };
        if let Some(floor) = floor
            && value <= floor
        {
            return Err(Error::Parameter {
                name,
                requirement: match floor < 0.0 {
                    true => "above that of pull-off, or nothing touches",
                    false => "above 0, or nothing touches",
                },
                value,
            });
        }
        if let Some(a) = self.tip.fixed_radius() {
            return self.punch(a, control, value);
        }
        let of = |point: &Point| match control {
            Control::Load => point.load,
            Control::Approach => point.approach,
        };
        let [mut low, high] = self.range();
        if floor.is_none() {
            let last = self.pull_off(control)?;
            let least = match control {
                Control::Load => last.load,
                Control::Approach => last.approach,
            };
            if value < least || branch == Branch::Stable && value <= least && last.radius <= 0.0 {
                return Err(Error::Parameter {
                    name,
                    requirement: "at least that of pull-off, or nothing touches",
                    value,
                });
            }
            if branch == Branch::Unstable {
                return self.unstable(of, value, [low, last.radius]);
            }
            low = low.max(last.radius);
        } else if branch == Branch::Unstable {
            return Err(Error::Inconsistent(
                "only adhesion within the contact has an unstable branch",
            ));
        }
        let too_large = Error::Parameter {
            name,
            requirement: "one that needs no larger radius than 1024 thicknesses of the top layer, and no larger one than the tip",
            value,
        };
        // A bracket from a guess on.
        let guess = self.guess(control, value).clamp(low, high);
        let mut top = guess;
        while of(&self.state(top)?) < value {
            if top >= high {
                return Err(too_large);
            }
            low = top;
            top = (1.5 * top).min(high);
        }
        let is_cohesive = matches!(self.adhesion, Adhesion::Maugis { .. });
        let mut last = None;
        let log = if is_cohesive {
            let error = |log: f64| Ok(of(&self.state(log.exp())?) - value);
            bracketed(error, [low.ln(), top.ln()])?
        } else {
            let error = |log: f64| {
                let point = self.state(log.exp())?;
                let [approach, load] = point.along();
                let slope = match control {
                    Control::Load => load,
                    Control::Approach => approach,
                };
                let found = [of(&point) - value, slope * point.radius];
                last = Some(point);
                Ok(found)
            };
            newton(error, [low.ln(), top.ln()], top.ln())?
        };
        let point = match last {
            Some(point) if (point.radius / log.exp() - 1.0).abs() < 4.0 * f64::EPSILON => point,
            _ => self.state(log.exp())?,
        };
        point.check_disc()?;
        Ok(point)
    }

    /// The contact of smaller radius at a `value`.
    fn unstable(
        &self,
        of: impl Fn(&Point) -> f64,
        value: f64,
        [low, high]: [f64; 2],
    ) -> Result<Point> {
        let error = |log: f64| Ok(of(&self.state(log.exp())?) - value);
        let mut start = high;
        while start > low.max(1e-6 * high) {
            start = (0.5 * start).max(low);
            if error(start.ln())? > 0.0 {
                return self.state(bracketed(error, [start.ln(), high.ln()])?.exp());
            }
        }
        Err(Error::Inconsistent(
            "no state of the unstable branch has this load or approach",
        ))
    }

    /// The contact of a flat punch.
    fn punch(&self, a: f64, control: Control, value: f64) -> Result<Point> {
        let parts = self.parts(a)?;
        let approach = match control {
            Control::Approach => value,
            Control::Load => value / parts.loads[0],
        };
        let least = match self.adhesion.work() {
            Some(_) => self.adhesion.edge(self.stack.surface_modulus(), a) / parts.edge[0],
            None => 0.0,
        };
        if approach < least {
            return Err(Error::Parameter {
                name: match control {
                    Control::Load => "load",
                    Control::Approach => "approach",
                },
                requirement: "at least that of pull-off, or nothing touches",
                value,
            });
        }
        Ok(Point::new(parts, self.adhesion, approach))
    }

    /// Contact radius \[m\] of the same tip on a bare body of the surface's modulus, to start from.
    fn guess(&self, control: Control, value: f64) -> f64 {
        let [low, high] = self.range();
        let modulus = self.stack.surface_modulus();
        let mut a = low;
        let reached = |a: f64| {
            let [depth, ..] = self.tip.transform(a);
            match control {
                Control::Approach => depth >= value,
                Control::Load => modulus * a * depth >= value,
            }
        };
        while !reached(a) && a < high {
            a *= 1.3;
        }
        a.min(high)
    }

    /// The state in which the tip is pulled off: of the smallest load or approach, the deepest minimum where there are more.
    ///
    /// # Errors
    /// As [`Indent::at_radius`], no adhesion, and no minimum within the radii that can be computed.
    pub fn pull_off(&self, control: Control) -> Result<PullOff> {
        let cell = &self.lasts[control as usize];
        if let Some(known) = cell.get() {
            return Ok(known.clone());
        }
        let found = self.find_pull_off(control)?;
        Ok(cell.get_or_init(|| found).clone())
    }

    fn find_pull_off(&self, control: Control) -> Result<PullOff> {
        let touching = |point: Point| PullOff {
            control,
            load: point.load,
            approach: point.approach,
            radius: point.radius,
            outer_radius: point.outer_radius,
            point: Some(point),
        };
        if let Some(a) = self.tip.fixed_radius() {
            let parts = self.parts(a)?;
            let edge = self.adhesion.edge(self.stack.surface_modulus(), a);
            let approach = edge / parts.edge[0];
            return Ok(touching(Point::new(parts, self.adhesion, approach)));
        }
        match self.adhesion {
            Adhesion::None => Err(Error::Inconsistent(
                "a tip without adhesion is not pulled off: give an adhesion",
            )),
            // The force outside stays until the last point parts.
            Adhesion::Dmt { work } => Ok(PullOff {
                control,
                load: -2.0 * PI * work * self.tip.end_radius().unwrap_or(0.0),
                approach: 0.0,
                radius: 0.0,
                outer_radius: None,
                point: None,
            }),
            Adhesion::Jkr { .. } => Ok(touching(self.least(control)?)),
            Adhesion::Maugis { work, strength } => {
                let numbers = [work, strength];
                let apart = self.least_apart(control, numbers)?;
                let of = |load: f64, approach: f64| match control {
                    Control::Load => load,
                    Control::Approach => approach,
                };
                match self.least(control) {
                    Ok(point)
                        if of(point.load, point.approach) < of(apart.load, apart.approach) =>
                    {
                        Ok(touching(point))
                    }
                    _ => Ok(PullOff {
                        control,
                        load: apart.load,
                        approach: apart.approach,
                        radius: 0.0,
                        outer_radius: Some(apart.outer_radius),
                        point: None,
                    }),
                }
            }
        }
    }

    /// The state of least load or approach among those without contact.
    fn least_apart(&self, control: Control, numbers: [f64; 2]) -> Result<Apart> {
        let touching = Apart::touching(&self.stack, &self.tip, numbers)?;
        if control == Control::Load {
            return Ok(touching);
        }
        // δ(c) falls from −w/σ₀ and may rise again before the tip touches.
        let at = |part: f64| {
            Apart::new(
                &self.stack,
                &self.tip,
                part * touching.outer_radius,
                numbers,
            )
        };
        let approach = |part: f64| at(part).approach;
        let slope = |part: f64| Ok(approach(part * (1.0 + 1e-5)) - approach(part * (1.0 - 1e-5)));
        if slope(1.0)? <= 0.0 {
            return Ok(touching);
        }
        match bracketed(slope, [1e-3, 1.0]) {
            Ok(part) => Ok(at(part)),
            Err(_) => Ok(touching),
        }
    }

    /// The contact of least load or approach.
    fn least(&self, control: Control) -> Result<Point> {
        let [low, high] = self.range();
        let of = |point: &Point| match control {
            Control::Load => point.load,
            Control::Approach => point.approach,
        };
        // Up to a radius under pressure.
        let mut top = low;
        let mut start = top.ln() - 3.0;
        let mut state = self.state_from(top, &mut start);
        while state.as_ref().map_or(true, |point| of(point) <= 0.0) && top < high {
            top = (2.0 * top).min(high);
            state = self.state_from(top, &mut start);
        }
        let places: Vec<f64> = (0..=SCAN * DEPTH)
            .map(|k| top.ln() + 0.7 - k as f64 / SCAN as f64)
            .filter(|log| log.exp() > low && log.exp() < high)
            .collect();
        let values: Vec<f64> = places
            .iter()
            .map(|log| {
                let state = self.state_from(log.exp(), &mut start);
                state.map_or(f64::INFINITY, |point| of(&point))
            })
            .collect();
        let inner = 1..values.len().saturating_sub(1);
        let least = inner
            .filter(|k| values[*k] <= values[k - 1] && values[*k] < values[k + 1])
            .min_by(|a, b| values[*a].total_cmp(&values[*b]));
        let least = least.ok_or(Error::Inconsistent(
            "the load and the approach have no minimum within the radii that can be computed",
        ))?;
        let bracket = [places[least + 1], places[least - 1]];
        let log = match self.adhesion {
            Adhesion::Maugis { .. } => {
                // A central difference, whose error moves a minimum by 1e-6 of its width and its value by the square.
                let h = 1e-4;
                let slope = |log: f64| {
                    let low = self.state_from((log - h).exp(), &mut start)?;
                    let high = self.state_from((log + h).exp(), &mut start)?;
                    Ok(of(&high) - of(&low))
                };
                bracketed(slope, bracket)?
            }
            _ => {
                let slope = |log: f64| {
                    let [approach, load] = self.state(log.exp())?.along();
                    Ok(match control {
                        Control::Load => load,
                        Control::Approach => approach,
                    })
                };
                bracketed(slope, bracket)?
            }
        };
        self.state(log.exp())
    }

    /// The state into which the tip jumps as it comes near, under no load or at the approach at which the surfaces begin to attract
    /// each other: 0 for adhesion within the contact, −w/σ₀ for a cohesive zone.
    ///
    /// # Errors
    /// As [`Indent::at_load`], and no adhesion.
    pub fn snap_in(&self, control: Control) -> Result<Point> {
        let approach = match self.adhesion {
            Adhesion::Maugis { work, strength } => -work / strength,
            Adhesion::None => {
                return Err(Error::Inconsistent(
                    "a tip without adhesion does not jump into contact: give an adhesion",
                ));
            }
            _ => 0.0,
        };
        match (control, self.adhesion) {
            (Control::Load, _) => self.at_load(0.0),
            (Control::Approach, Adhesion::Dmt { .. }) => Err(Error::Inconsistent(
                "with the adhesion of Derjaguin, Muller and Toporov the approach is continuous at first touch",
            )),
            (Control::Approach, _) => self.at_approach(approach),
        }
    }

    /// Surfaces that attract each other up to the radius `outer` \[m\] without touching, with the adhesion of Maugis and Dugdale.
    ///
    /// # Errors
    /// Another adhesion, and a radius that is not above 0 or at which they touch.
    pub fn apart(&self, outer: f64) -> Result<Apart> {
        let Adhesion::Maugis { work, strength } = self.adhesion else {
            return Err(Error::Inconsistent(
                "only the adhesion of Maugis and Dugdale acts between surfaces that do not touch",
            ));
        };
        positive("outer radius", outer)?;
        let found = Apart::new(&self.stack, &self.tip, outer, [work, strength]);
        match found.gap >= 0.0 {
            true => Ok(found),
            false => Err(Error::Parameter {
                name: "outer radius",
                requirement: "at most that at which the tip begins to touch",
                value: outer,
            }),
        }
    }

    /// Work of adhesion \[J/m²\] of which this tip is pulled off by a `force` \[N\], the largest one or that under a given approach;
    /// the kind of adhesion is that of this tip, and a strength stays as it is.
    ///
    /// # Errors
    /// As [`Indent::pull_off`], and a force that is not above 0.
    pub fn work_from_pull_off(&self, force: f64, control: Control) -> Result<f64> {
        positive("force", force)?;
        let with = |work: f64| match self.adhesion {
            Adhesion::None | Adhesion::Jkr { .. } => Adhesion::Jkr { work },
            Adhesion::Dmt { .. } => Adhesion::Dmt { work },
            Adhesion::Maugis { strength, .. } => Adhesion::Maugis { work, strength },
        };
        let ratio = |log: f64| -> Result<f64> {
            let own = self.clone().with_adhesion(with(log.exp()))?;
            Ok((-own.pull_off(control)?.load / force).ln())
        };
        // The force is about 1.5 πwR of a sphere, and of other tips it grows with w.
        let size = self.tip.end_radius().unwrap_or_else(|| {
            let a = self.guess(Control::Load, force);
            a * a / self.tip.gap(a).max(f64::MIN_POSITIVE)
        });
        let start = (force / (1.5 * PI * size)).ln();
        let (mut low, mut high) = (start - 1.0, start + 1.0);
        while ratio(low)? > 0.0 {
            low -= 1.0;
        }
        while ratio(high)? < 0.0 {
            high += 1.0;
        }
        Ok(bracketed(ratio, [low, high])?.exp())
    }

    /// Largest relative difference of load, approach and stiffness from those with 1.5 times as many nodes of all quadratures, an
    /// estimate of the error of this state.
    ///
    /// # Errors
    /// As [`Indent::at_radius`].
    pub fn error_at(&self, point: &Point) -> Result<f64> {
        let finer = Self {
            stack: self.stack.refined(1.5)?,
            ..self.clone()
        };
        let parts = Arc::new(Parts::new(&finer.stack, &finer.tip, point.radius, 0.0)?);
        let again = match self.tip.fixed_radius() {
            Some(_) => Point::new(parts, self.adhesion, point.approach),
            None => finer.state(point.radius)?,
        };
        let pairs = [
            (point.load, again.load),
            (point.approach, again.approach),
            (point.stiffness, again.stiffness),
        ];
        Ok(pairs
            .iter()
            .map(|(a, b)| ((a - b) / b.abs().max(f64::MIN_POSITIVE)).abs())
            .fold(0.0, f64::max))
    }
}
