//! A tip on a stack: states by radius, load and approach, and where a tip lets go.

use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

use spec_math::cephes64::j1;

use crate::error::{Error, Result, finite, refuse_if, require};
use crate::indent::adhesion::{Adhesion, Branch, Control};
use crate::indent::equation::stack::Stack;
use crate::indent::equation::{Parts, bracketed, times};
use crate::indent::point::{Point, PullOff};
use crate::indent::pressure::{WHOLE, Zone, bessel_sum};
use crate::indent::tip::Tip;
use crate::numerics::parallel::dot;
use crate::numerics::roots::newton;

/// Smallest contact radius, in end radii or thicknesses, at which a contact is looked for.
const SMALLEST: f64 = 1e-9;

/// Smallest contact radius, in any unit, where nothing has a length; its cube is a number of the machine.
const TINY: f64 = 1e-60;

/// Largest approach of a flat punch, in its radii, whose pressures are floating-point numbers.
const DEEPEST: f64 = 1e100;

/// Smallest contact radius beyond a flat end, relative to it.
const BEYOND: f64 = 1e-12;

/// Difference of a load or approach from the given one above which no radius that is looked at has it; solutions differ by rounding.
const MISSED: f64 = 1e-6;

/// Contact radius, in thicknesses of the top layer, below which load and approach grow with it.
const SMALL: f64 = 1e-2;

/// Step of the logarithm of the radius in the search for another contact.
const STEP: f64 = 0.1;

/// Excess of load or approach, in what is given, beyond which they do not come back.
const PASSED: f64 = 3.0;

/// A tip on a stack.
#[derive(Debug, Clone)]
pub struct Indent {
    pub(super) stack: Stack,
    pub(super) tip: Tip,
    pub(super) adhesion: Adhesion,
    pub(super) lasts: [Arc<OnceLock<PullOff>>; 2],
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

    /// This tip with `adhesion`.
    ///
    /// # Errors
    /// Numbers that are not above 0, and Derjaguin, Muller and Toporov's for a tip without an end radius.
    pub fn with_adhesion(self, adhesion: Adhesion) -> Result<Self> {
        if matches!(adhesion, Adhesion::Dmt { .. }) && self.tip.end_radius().is_none() {
            return Err(Error::Adhesion(
                "the adhesion of Derjaguin, Muller and Toporov needs a tip with an end radius: a paraboloid, a sphere or a \
                 rounded cone",
            ));
        }
        if matches!(adhesion, Adhesion::Maugis { .. }) && self.tip.fixed_radius().is_some() {
            return Err(Error::Adhesion(
                "the adhesion of Maugis and Dugdale is for tips whose contact grows: a flat punch has that of Johnson, \
                 Kendall and Roberts",
            ));
        }
        Ok(Self { adhesion: adhesion.checked()?, lasts: Default::default(), ..self })
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
    pub(super) fn range(&self) -> [f64; 2] {
        let [low, high] = self.tip.range();
        let high = high.min(self.stack.largest_radius());
        // A cone on a bare body has no length of its own.
        let size = self.tip.end_radius().or(self.stack.thickness());
        let least = size.map_or(TINY, |size| (SMALLEST * size.min(high)).max(TINY * TINY));
        [low.max(least) * (1.0 + BEYOND), high * (1.0 - 1e-9)]
    }

    /// The parts at the radius `a`.
    pub(super) fn parts(&self, a: f64) -> Result<Arc<Parts>> {
        Ok(Arc::new(Parts::new(&self.stack, &self.tip, a, 0.0)?))
    }

    /// The contact of radius `a` \[m\].
    ///
    /// # Errors
    /// A radius that is not above 0, that the tip cannot have, or beyond 1024 thicknesses of the top layer; a flat punch, whose
    /// radius says nothing of its load; no state with a cohesive zone; a contact that is no disc.
    pub fn at_radius(&self, a: f64) -> Result<Point> {
        refuse_if(
            self.tip.fixed_radius().is_some(),
            "the contact of a flat punch has the radius of the punch at every load: give load or approach",
        )?;
        let point = self.state(a)?;
        point.check_disc()?;
        Ok(point)
    }

    pub(super) fn state(&self, a: f64) -> Result<Point> {
        self.state_from(a, &mut (a.ln() - 3.0))
    }

    /// The contact of radius `a`, whose cohesive zone is looked for as [`with_zone`] says.
    pub(super) fn state_from(&self, a: f64, start: &mut f64) -> Result<Point> {
        self.tip.check_radius(a)?;
        if let Adhesion::Maugis { work, strength } = self.adhesion {
            return with_zone(&self.stack, &self.tip, a, [work, strength], start);
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
        let name = control.name();
        finite(name, value)?;
        let floor = match (self.adhesion, control) {
            (Adhesion::None, _) | (Adhesion::Dmt { .. }, Control::Approach) => Some(0.0),
            (Adhesion::Dmt { .. }, Control::Load) => Some(self.pull_off(control)?.load),
            _ => None,
        };
        if let Some(floor) = floor {
            let requirement = match floor < 0.0 {
                true => "above that of pull-off, or nothing touches",
                false => "above 0, or nothing touches",
            };
            require(name, value, value > floor, requirement)?;
        }
        if let Some(a) = self.tip.fixed_radius() {
            return self.punch(a, control, value);
        }
        let [mut low, high] = self.range();
        if floor.is_none() {
            let last = self.pull_off(control)?;
            let least = control.of([last.approach, last.load]);
            // Where the tip lets go before it touches, no contact has the least value itself.
            let is_open = branch == Branch::Stable && last.radius <= 0.0;
            let touches = if is_open { value > least } else { value >= least };
            let requirement = "at least that of pull-off, or nothing touches";
            require(name, value, touches, requirement)?;
            if branch == Branch::Unstable {
                return self.unstable(control, value, [low, last.radius]);
            }
            low = low.max(last.radius);
        } else if branch == Branch::Unstable {
            return Err(Error::Adhesion("only adhesion within the contact has an unstable branch"));
        }
        let too_large = Error::Parameter {
            name,
            requirement: "one that needs no larger radius than 1024 thicknesses of the top layer, and no larger one than the tip, and \
                          whose contact has numbers of the machine",
            value,
        };
        let range = [low, high];
        let contact = match self.nearest(control, value, floor, range) {
            Ok(Some(point)) => point.check_disc().map(|()| point),
            // The caller gave no radius.
            Ok(None) | Err(Error::Parameter { name: "radius", .. }) => Err(too_large),
            Err(error) => Err(error),
        };
        match contact {
            Err(error @ (Error::Ring | Error::NoState(_) | Error::Inconsistent(_))) => {
                self.other(control, value, range)?.ok_or(error)
            }
            contact => contact,
        }
    }

    /// A contact at a `value` of what is given, which is above `floor`, on radii from `low` to `high`; none where they are too
    /// small.
    fn nearest(
        &self,
        control: Control,
        value: f64,
        floor: Option<f64>,
        [mut low, high]: [f64; 2],
    ) -> Result<Option<Point>> {
        if low >= high {
            return Ok(None);
        }
        // A bracket from a guess on.
        let smallest = low;
        let guess = self.guess(control, value).clamp(low, high);
        let mut top = guess;
        while self.value(control, top)? < value {
            if top >= high {
                return Ok(None);
            }
            low = top;
            top = (1.5 * top).min(high);
        }
        let mut last = None;
        let error = |log: f64| {
            let point = self.state(log.exp().max(smallest))?;
            let excess = point.value(control) - value;
            let slope = control.of(point.along()) * point.radius;
            last = Some(point);
            Ok([excess, slope])
        };
        let log = newton(error, [low.ln(), top.ln()], top.ln())?;
        let point = match last {
            Some(point) if (point.radius / log.exp() - 1.0).abs() < 4.0 * f64::EPSILON => point,
            _ => self.state(log.exp().max(smallest))?,
        };
        let is_flat = self.tip.range()[0] > 0.0;
        if let Some(floor) = floor
            && !is_flat
        {
            let missed = (point.value(control) - value).abs();
            let requirement =
                "at least that of a contact of 1e-9 of the end radius or of the top layer";
            let is_met = missed <= MISSED * value.abs().max(floor.abs());
            require(control.name(), value, is_met, requirement)?;
        }
        if self.adhesion == Adhesion::None && is_flat {
            // At a given approach the load is stationary at the contact radius, whose rounding is coarse next to a flat end; below
            // the smallest radius the contact is that of the end.
            let [stiffness, profile] = point.parts.loads;
            let approach = control.of([value, (value + profile) / stiffness]);
            let parts = Arc::clone(&point.parts);
            return Ok(Some(Point::new(parts, self.adhesion, approach)));
        }
        Ok(Some(point))
    }

    /// What is given of the contact of radius `a`.
    fn value(&self, control: Control, a: f64) -> Result<f64> {
        Ok(self.state(a)?.value(control))
    }

    /// The contact at a `value` that is a disc, where load and approach are no monotone functions of its radius: the smallest one,
    /// and the only one without adhesion, whose solution is unique.
    fn other(&self, control: Control, value: f64, [low, high]: [f64; 2]) -> Result<Option<Point>> {
        let error = |log: f64| Ok(self.value(control, log.exp())? - value);
        // Small contacts are those on a bare body, and wide ones those on the base: both monotone.
        let smallest = self.stack.thickness().map_or(low, |h| SMALL * h);
        let [low, high] = [low.max(smallest).min(high), high].map(f64::ln);
        let (mut log, mut last) = (low, error(low)?);
        let size = value.abs().max((last + value).abs());
        while log < high {
            let next = (log + STEP).min(high);
            let excess = error(next)?;
            if (excess > 0.0) != (last > 0.0) {
                let point = self.state(bracketed(error, [log, next])?.exp())?;
                if point.check_disc().is_ok() {
                    return Ok(Some(point));
                }
            }
            if excess > PASSED * size {
                break;
            }
            (log, last) = (next, excess);
        }
        Ok(None)
    }

    /// The contact of smaller radius at a `value`.
    fn unstable(&self, control: Control, value: f64, [low, high]: [f64; 2]) -> Result<Point> {
        let error = |log: f64| Ok(self.value(control, log.exp())? - value);
        let mut start = high;
        while start > low.max(1e-6 * high) {
            start = (0.5 * start).max(low);
            if error(start.ln())? > 0.0 {
                let point = self.state(bracketed(error, [start.ln(), high.ln()])?.exp())?;
                point.check_disc()?;
                return Ok(point);
            }
        }
        Err(Error::NoState("no state of the unstable branch has this load or approach"))
    }

    /// The contact of a flat punch.
    fn punch(&self, a: f64, control: Control, value: f64) -> Result<Point> {
        let parts = self.parts(a)?;
        let approach = control.of([value, value / parts.loads[0]]);
        let least = match self.adhesion.work() {
            Some(_) => self.adhesion.edge(self.stack.surface_modulus(), a) / parts.edge[0],
            None => 0.0,
        };
        let requirement = match approach < least {
            true => "at least that of pull-off, or nothing touches",
            false => "one whose approach is at most 1e100 radii",
        };
        let holds = (least..=DEEPEST * a).contains(&approach);
        require(control.name(), value, holds, requirement)?;
        let point = Point::new(parts, self.adhesion, approach);
        point.check_disc()?;
        Ok(point)
    }

    /// Contact radius \[m\] of the same tip on a bare body of the surface's modulus, to start from.
    pub(super) fn guess(&self, control: Control, value: f64) -> f64 {
        let [low, high] = self.range();
        let modulus = self.stack.surface_modulus();
        let mut a = low;
        let reached = |a: f64| {
            let [depth, ..] = self.tip.transform(a);
            control.of([depth, modulus * a * depth]) >= value
        };
        while !reached(a) && a < high {
            a *= 1.3;
        }
        a.min(high)
    }

    /// Largest relative difference of load, approach and stiffness from those with 1.5 times as many nodes of all quadratures, an
    /// estimate of the error of this state.
    ///
    /// # Errors
    /// As [`Indent::at_radius`].
    pub fn error_at(&self, point: &Point) -> Result<f64> {
        let finer = Self { stack: self.stack.refined(1.5)?, ..self.clone() };
        let parts = Arc::new(Parts::new(&finer.stack, &finer.tip, point.radius, 0.0)?);
        let again = match self.tip.fixed_radius() {
            Some(_) => Point::new(parts, self.adhesion, point.approach),
            None => finer.state(point.radius)?,
        };
        let errors = [
            (point.load, again.load),
            (point.approach, again.approach),
            (point.stiffness, again.stiffness),
        ]
        .map(|(a, b)| ((a - b) / b.abs().max(f64::MIN_POSITIVE)).abs());
        Ok(errors.into_iter().fold(0.0, f64::max))
    }
}

/// The contact of radius `a` with the cohesive zone of Maugis and Dugdale, on any stack, whose width c − a is looked for from e^`start` on; at the end its
/// logarithm is in `start`.
///
/// A stress −σ₀ acts on a < r < c, and the gap is w/σ₀ at c. The density of a uniform stress is known,
///
/// ```text
/// ψ(t) = −2/π σ₀ √(c²−t²)      a < t < c
/// ```
///
/// so that φ on the contact satisfies its equation with −2/π ∫ M cos αs ψ̂ dα more on the right. φ(a) = ψ(a) fixes δ, since the
/// stress has no infinity, and the gap fixes c. Before the tip touches, ψ acts on 0 < t < c alone: the surfaces are apart, the
/// load is −πσ₀c², and δ = g(c) + u(c) − w/σ₀. On layers both were derived here; on a bare body they are Maugis's closed form
/// (J. Colloid Interface Sci. 150 (1992) 243, doi:10.1016/0021-9797(92)90285-T).
fn with_zone(
    stack: &Stack,
    tip: &Tip,
    a: f64,
    [work, strength]: [f64; 2],
    start: &mut f64,
) -> Result<Point> {
    let opening = work / strength;
    let mut parts = Arc::new(Parts::new(stack, tip, a, 4.0 * a)?);
    // ln (c − a): the gap at c grows with it.
    let mut excess = |log: f64| -> Result<(f64, Point)> {
        let outer = a + log.exp();
        let level = parts.system.level.as_ref();
        if level.is_some_and(|level| 2.0 * outer > level.length) {
            parts = Arc::new(Parts::new(stack, tip, a, 2.0 * outer)?);
        }
        let zone = Zone::around(&parts, outer, strength);
        let approach = parts.hertzian() + (zone.density(WHOLE) - zone.answer.edge) / parts.edge[0];
        let mut point =
            Point::new(Arc::clone(&parts), Adhesion::Maugis { work, strength }, approach);
        point.load += zone.load(WHOLE) + 2.0 * PI * dot(&zone.answer.values, &parts.system.ones);
        point.outer_radius = Some(outer);
        point.zone = Some(zone);
        let gap = point.gap(&[outer])?[0];
        Ok((gap - opening, point))
    };
    let most = 0.5 * stack.largest_radius().min(1e6 * a);
    let from = start.clamp(a.ln() - 30.0, most.ln());
    let is_wide = excess(from)?.0 > 0.0;
    let (mut near, mut far, mut step) = (from, from, 0.25);
    loop {
        far += if is_wide { -step } else { step };
        if far < a.ln() - 34.0 || far > most.ln() {
            return Err(NO_ZONE);
        }
        if (excess(far)?.0 > 0.0) != is_wide {
            break;
        }
        (near, step) = (far, (2.0 * step).min(1.0));
    }
    *start = bracketed(|log| Ok(excess(log)?.0), [near, far])?;
    Ok(excess(*start)?.1)
}

const NO_ZONE: Error = Error::NoState(
    "no cohesive zone of this contact radius exists: the strength is too small or too large for the layers",
);

/// Surfaces that attract each other and do not touch.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Apart {
    /// Radius c \[m\] up to which the surfaces attract each other.
    pub outer_radius: f64,
    /// Load \[N\], below 0.
    pub load: f64,
    /// Approach \[m\].
    pub approach: f64,
    /// Gap on the axis \[m\]; 0 where the tip begins to touch.
    pub gap: f64,
}

impl Apart {
    /// The state in which the surfaces attract each other up to `outer` \[m\].
    pub(super) fn new(stack: &Stack, tip: &Tip, outer: f64, [work, strength]: [f64; 2]) -> Self {
        let c = outer;
        // u/A1 at c and on the axis.
        let (mut edge, mut axis) = (-2.0 / PI * strength * c, -strength * c);
        if let Some(level) = stack.level(2.0 * c) {
            let alpha = &level.waves.alpha;
            let hat = alpha.iter().map(|alpha| -strength * c * j1(alpha * c) / alpha);
            let g = times(&level.excess, &hat.collect::<Vec<f64>>());
            edge += bessel_sum(&g, alpha, c);
            axis += g.iter().sum::<f64>();
        }
        let approach = tip.gap(c) + stack.short() * edge - work / strength;
        Self {
            outer_radius: c,
            load: -PI * c * c * strength,
            approach,
            gap: stack.short() * axis - approach,
        }
    }

    /// The state in which the tip begins to touch.
    pub(super) fn touching(stack: &Stack, tip: &Tip, numbers: [f64; 2]) -> Result<Self> {
        let gap = |log: f64| Self::new(stack, tip, log.exp(), numbers).gap;
        // From the radius at which the profile itself has opened by w/σ₀, which is too large or too small by the deformation.
        let opening = numbers[0] / numbers[1];
        let mut log = 0.0_f64;
        while tip.gap(log.exp()) > opening {
            log -= 1.0;
        }
        while tip.gap(log.exp()) < opening && log.exp() < tip.range()[1] {
            log += 1.0;
        }
        let (mut low, mut high) = (log, log);
        while gap(low) < 0.0 {
            low -= 1.0;
        }
        while gap(high) > 0.0 {
            high += 0.25;
            if high.exp() > 0.5 * stack.largest_radius() {
                return Err(NO_ZONE);
            }
        }
        let log = bracketed(|log| Ok(gap(log)), [low, high])?;
        Ok(Self::new(stack, tip, log.exp(), numbers))
    }
}
