//! The cohesive zone of Maugis and Dugdale around a contact, on any stack.
//!
//! A stress −σ₀ acts on a < r < c, and the gap is w/σ₀ at c. The density of a uniform stress is known,
//!
//! ```text
//! ψ(t) = −2/π σ₀ √(c²−t²)      a < t < c
//! ```
//!
//! so that φ on the contact satisfies its equation with −2/π ∫ M cos αs ψ̂ dα more on the right. φ(a) = ψ(a) fixes δ, since the
//! stress has no infinity, and the gap fixes c. Before the tip touches, ψ acts on 0 < t < c alone: the surfaces are apart, the
//! load is −πσ₀c², and δ = g(c) + u(c) − w/σ₀. On layers both were derived here; on a bare body they are Maugis's closed form
//! (J. Colloid Interface Sci. 150 (1992) 243, doi:10.1016/0021-9797(92)90285-T).

use std::f64::consts::PI;
use std::sync::Arc;

use spec_math::cephes64::j1;

use super::adhesion::Adhesion;
use super::density::bessel_sum;
use super::equation::bracketed;
use super::equation::stack::Stack;
use super::equation::system::Parts;
use super::equation::system::times;
use super::point::Point;
use super::tip::Tip;
use super::zone::Zone;
use crate::error::{Error, Result};
use crate::numerics::parallel::dot;

/// The contact of radius `a` with a cohesive zone, whose width c − a is looked for from e^`start` on; at the end its
/// logarithm is in `start`.
pub(super) fn contact(
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
        let approach = parts.hertzian() + (zone.density() - zone.answer.edge) / parts.edge[0];
        let mut point =
            Point::new(Arc::clone(&parts), Adhesion::Maugis { work, strength }, approach);
        point.load += zone.load() + 2.0 * PI * dot(&zone.answer.values, &parts.system.ones);
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
