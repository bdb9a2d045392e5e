//! Where an adhering tip lets go and where it jumps into contact.

use std::f64::consts::PI;

use super::adhesion::{Adhesion, Control};
use super::equation::bracketed;
use super::indenter::{Apart, Indent};
use super::point::{Point, PullOff};
use crate::error::{Error, Result, positive, require};

/// Radii in each factor of e at which the end of an adhering contact is looked for.
const SCAN: f64 = 4.0;

/// Depth F(a) of a bare body, in the depth √(2πaw/E*) that adhesion takes away, from which on it is looked for: a bare body lets go at
/// some 1, one of a thickness h on a rigid base at some √(h/a).
const SHALLOWEST: f64 = 3e-3;

/// That depth for the softest response, up to which it is looked for: an rⁿ of n ≥ 1/2 carries no load at 1 + 1/n.
const DEEPEST: f64 = 3.0;

/// Rise from the least load or approach, relative to it, after which no other one is looked for on a stack that is softest at its
/// surface.
const RISEN: f64 = 0.2;

/// Step of differences with respect to the logarithm of the radius.
const DIFFERENCE: f64 = 1e-4;

impl Indent {
    /// The state in which the tip is pulled off: of the smallest load or approach, the deepest minimum where there are more.
    ///
    /// # Errors
    /// As [`Indent::at_radius`], no adhesion, and no minimum within the radii that can be computed.
    pub fn pull_off(&self, control: Control) -> Result<PullOff> {
        let cell = &self.lasts[control as usize];
        if let Some(known) = cell.get() {
            return Ok(known.clone());
        }
        let pull_off = self.find_pull_off(control)?;
        Ok(cell.get_or_init(|| pull_off).clone())
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
            Adhesion::None => {
                Err(Error::Adhesion("a tip without adhesion is not pulled off: give an adhesion"))
            }
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
                let apart = self.least_apart(control, [work, strength])?;
                let least = control.of([apart.approach, apart.load]);
                match self.least(control) {
                    Ok(point) if point.value(control) < least => Ok(touching(point)),
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
        let at = |fraction: f64| {
            let outer = fraction * touching.outer_radius;
            Apart::new(&self.stack, &self.tip, outer, numbers)
        };
        let approach = |fraction: f64| at(fraction).approach;
        let slope = |fraction: f64| {
            Ok(approach(fraction * (1.0 + 1e-5)) - approach(fraction * (1.0 - 1e-5)))
        };
        if slope(1.0)? <= 0.0 {
            return Ok(touching);
        }
        match bracketed(slope, [1e-3, 1.0]) {
            Ok(fraction) => Ok(at(fraction)),
            Err(_) => Ok(touching),
        }
    }

    /// The contact of least load or approach.
    fn least(&self, control: Control) -> Result<Point> {
        let [low, high] = self.range();
        // Depth F(a) of a bare body, in the depth that adhesion takes away from it.
        let work = self.adhesion.work().unwrap_or(0.0);
        let depth = |a: f64, modulus: f64| {
            self.tip.transform(a)[0] / (2.0 * PI * a * work / modulus).sqrt()
        };
        let [surface, softest] = [self.stack.surface_modulus(), self.stack.softest_modulus()];
        let mut log = low.ln();
        while depth(log.exp(), surface) < SHALLOWEST && log.exp() < high {
            log += 1.0 / SCAN;
        }
        let (mut places, mut values) = (Vec::new(), Vec::new());
        let (mut start, mut least) = (log - 3.0, f64::INFINITY);
        while log.exp() < high {
            let state = self.state_from(log.exp(), &mut start);
            let value = state.map_or(f64::INFINITY, |point| point.value(control));
            places.push(log);
            values.push(value);
            least = least.min(value);
            // Where nothing is softer than the surface, the load only rises from there.
            let is_over = softest >= surface && value.is_finite() && value > (1.0 - RISEN) * least;
            if is_over || value > 0.0 && depth(log.exp(), softest) > DEEPEST {
                break;
            }
            log += 1.0 / SCAN;
        }
        let inner = 1..values.len().saturating_sub(1);
        let mut minima: Vec<usize> =
            inner.filter(|k| values[*k] <= values[k - 1] && values[*k] < values[k + 1]).collect();
        minima.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
        let mut point = Err(Error::NoState(
            "the load and the approach have no minimum within the radii that can be computed",
        ));
        // A minimum at which the contact is no disc is no state.
        for k in minima {
            let bracket = [places[k + 1], places[k - 1]];
            point = self.minimum(control, bracket, &mut start);
            if point.is_ok() {
                break;
            }
        }
        point
    }

    /// The contact of least load or approach between two logarithms of the radius.
    fn minimum(&self, control: Control, bracket: [f64; 2], start: &mut f64) -> Result<Point> {
        let slope = |log: f64| {
            if !matches!(self.adhesion, Adhesion::Maugis { .. }) {
                return Ok(control.of(self.state(log.exp())?.along()));
            }
            // A central difference, whose error moves a minimum by 1e-6 of its width and its value by the square.
            let low = self.state_from((log - DIFFERENCE).exp(), start)?;
            let high = self.state_from((log + DIFFERENCE).exp(), start)?;
            Ok(high.value(control) - low.value(control))
        };
        let log = bracketed(slope, bracket)?;
        let point = self.state(log.exp())?;
        point.check_disc()?;
        Ok(point)
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
                return Err(Error::Adhesion(
                    "a tip without adhesion does not jump into contact: give an adhesion",
                ));
            }
            _ => 0.0,
        };
        match (control, self.adhesion) {
            (Control::Load, _) => self.at_load(0.0),
            (Control::Approach, Adhesion::Dmt { .. }) => Err(Error::Adhesion(
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
            return Err(Error::Adhesion(
                "only the adhesion of Maugis and Dugdale acts between surfaces that do not touch",
            ));
        };
        positive("outer radius", outer)?;
        let apart = Apart::new(&self.stack, &self.tip, outer, [work, strength]);
        let requirement = "at most that at which the tip begins to touch";
        require("outer radius", outer, apart.gap >= 0.0, requirement)?;
        Ok(apart)
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
        let mut find_logarithm = || {
            while ratio(low)? > 0.0 {
                low -= 1.0;
            }
            while ratio(high)? < 0.0 {
                high += 1.0;
            }
            bracketed(ratio, [low, high])
        };
        self.clone().with_adhesion(with(1.0))?;
        // The caller gave no work and no radius.
        let log = find_logarithm().map_err(|_| Error::Parameter {
            name: "force",
            requirement: "that of a contact within the radii that can be computed",
            value: force,
        })?;
        Ok(log.exp())
    }
}
