//! The contact of one radius.

use std::f64::consts::PI;

use super::stack::Stack;
use super::tip::Tip;
use crate::dense::{backward, cholesky, forward};
use crate::error::{Error, Result, positive};
use crate::kernel::quadrature::Rule;

/// Nodes of the contact without layers, of which eight give all digits of smooth tips.
const BARE: usize = 8;

/// Nodes at most: thinner layers need other methods.
const MOST: usize = 600;

/// Nodes of the integrals of the pressure, beside four for each thickness of the top layer in the radius.
const PRESSURE: usize = 48;

/// Newton steps for a radius; some five suffice.
const STEPS: usize = 100;

/// A tip on a stack.
#[derive(Debug, Clone)]
pub struct Indent<'a> {
    stack: &'a Stack,
    tip: Tip,
}

/// One state of an indentation.
#[derive(Debug, Clone)]
pub struct Point<'a> {
    /// Contact radius a \[m\].
    pub radius: f64,
    /// Load P \[N\].
    pub load: f64,
    /// Approach δ \[m\].
    pub approach: f64,
    /// Stiffness dP/dδ of this contact \[N/m\]: that of unloading, and without adhesion along the curve.
    pub stiffness: f64,
    /// Its derivative with respect to the contact radius \[N/m²\].
    pub stiffness_slope: f64,
    stack: &'a Stack,
    tip: Tip,
    /// Approach without adhesion at this radius \[m\].
    pub(super) hertzian: f64,
    /// P_F \[N\]: the load is S δ − P_F.
    profile_load: f64,
    /// φ₁(a) of the flat punch at unit approach \[N/m²\].
    pub(super) edge: f64,
    /// p̂ at the waves of the stack, of the flat punch at unit approach and of the profile.
    hats: [Vec<f64>; 2],
}

impl Stack {
    /// A tip that is pressed into this stack.
    ///
    /// # Errors
    /// A tip with a number that is not above 0.
    pub fn indent(&self, tip: &Tip) -> Result<Indent<'_>> {
        Ok(Indent {
            stack: self,
            tip: tip.checked()?,
        })
    }
}

impl<'a> Indent<'a> {
    /// The contact of radius `a` \[m\] without adhesion; a flat tip, whose load its radius does not decide, at the approach 1.
    ///
    /// # Errors
    /// A radius that is not above 0, beyond that of the plan or of the tip, or too large for the thickness of the top layer.
    pub fn at_radius(&self, a: f64) -> Result<Point<'a>> {
        let point = self.solve(a)?;
        let approach = match self.tip {
            Tip::Flat => 1.0,
            _ => point.hertzian,
        };
        Ok(point.at(approach))
    }

    /// Largest contact radius \[m\] that can be asked for.
    pub(super) fn largest(&self) -> f64 {
        self.stack
            .largest
            .min(self.tip.largest_radius() * (1.0 - 1e-9))
    }

    /// The contact under a `load` \[N\] above 0, without adhesion.
    ///
    /// # Errors
    /// As [`Indent::at_radius`], a flat tip, and a load that needs a larger radius than was planned.
    pub fn at_load(&self, load: f64) -> Result<Point<'a>> {
        positive("load", load)?;
        self.find("load", load, |point| [point.load, point.stiffness])
    }

    /// The contact at an `approach` \[m\] above 0, without adhesion.
    ///
    /// # Errors
    /// As [`Indent::at_radius`], a flat tip, and an approach that needs a larger radius than was planned.
    pub fn at_approach(&self, approach: f64) -> Result<Point<'a>> {
        positive("approach", approach)?;
        self.find("approach", approach, |point| [point.approach, 1.0])
    }

    /// The radius at which a quantity that grows with it has a value; `of` gives it, and its derivative with respect to the
    /// approach.
    fn find(
        &self,
        name: &'static str,
        wanted: f64,
        of: fn(&Point<'_>) -> [f64; 2],
    ) -> Result<Point<'a>> {
        if self.tip == Tip::Flat {
            return Err(Error::Inconsistent(
                "the radius of a flat tip is its own: take the contact at this radius, whose load is proportional to the approach",
            ));
        }
        let most = self.largest();
        let least = self
            .tip
            .kink()
            .filter(|_| matches!(self.tip, Tip::RoundedPunch(..)));
        let (mut low, mut high) = (least.unwrap_or(0.0), most);
        let top = self.at_radius(most)?;
        if of(&top)[0] < wanted {
            return Err(Error::Parameter {
                name,
                requirement: "no more than at the largest contact radius that was planned",
                value: wanted,
            });
        }
        // Bisection of ln a, and secants of the logarithms where they stay inside.
        let mut a = 0.5 * (low + high);
        let mut last: Option<[f64; 2]> = None;
        for _ in 0..STEPS {
            let point = self.at_radius(a)?;
            let [found, _] = of(&point);
            let error = (found / wanted).ln();
            if error.abs() < 4.0 * f64::EPSILON {
                return Ok(point);
            }
            match found < wanted {
                true => low = a,
                false => high = a,
            }
            let here = [a.ln(), error];
            let slope = last.map(|[x, y]| (here[1] - y) / (here[0] - x));
            last = Some(here);
            let next = slope
                .filter(|s| *s > 0.0)
                .map(|s| (here[0] - error / s).exp());
            let inside = next.filter(|next| *next > low && *next < high);
            let next = inside.unwrap_or_else(|| {
                if low > 0.0 {
                    (low * high).sqrt()
                } else {
                    0.1 * high
                }
            });
            if (next / a - 1.0).abs() < 2.0 * f64::EPSILON {
                return Ok(point);
            }
            a = next;
        }
        self.at_radius(a)
    }

    /// The contact of radius `a`, with the approach 0.
    pub(super) fn solve(&self, a: f64) -> Result<Point<'a>> {
        let Stack {
            modulus,
            waves,
            thickness,
            largest,
        } = self.stack;
        self.tip.check_radius(a)?;
        if a > *largest {
            return Err(Error::Parameter {
                name: "contact radius",
                requirement: "at most the largest that was planned",
                value: a,
            });
        }
        let count = thickness.map_or(BARE, |h| 8 + (4.0 * a / h).ceil() as usize);
        if count > MOST {
            return Err(Error::Parameter {
                name: "contact radius",
                requirement: "at most 148 times the thickness of the top layer",
                value: a,
            });
        }
        let f = modulus / PI;
        let nodes = self.nodes(a, count);
        let n = nodes.len();
        // B = 1 + 2/π C D Cᵀ, symmetric with the roots of the weights.
        let cosines: Vec<Vec<f64>> = nodes
            .iter()
            .map(|(s, w)| {
                waves
                    .iter()
                    .map(|[alpha, _]| w.sqrt() * (alpha * s).cos())
                    .collect()
            })
            .collect();
        let factor = cholesky(n, |i, j| {
            let terms = cosines[i].iter().zip(&cosines[j]).zip(waves);
            let sum: f64 = terms.map(|((a, b), [_, m])| a * b * m).sum();
            2.0 / PI * sum + if i == j { 1.0 } else { 0.0 }
        });
        let factor = factor.ok_or(Error::Inconsistent(
            "the response of the bodies must be positive at every wavenumber",
        ))?;
        let unit = nodes.iter().map(|(_, w)| f * w.sqrt());
        let profile = nodes
            .iter()
            .map(|(s, w)| f * w.sqrt() * self.tip.transform(*s)[0]);
        let [punch, profile] = [unit.collect(), profile.collect()]
            .map(|right| backward(&factor, forward(&factor, right)));
        // p̂ of each, and the values at the edge.
        let transform = |values: &[f64]| -> Vec<f64> {
            (0..waves.len())
                .map(|q| cosines.iter().zip(values).map(|(row, v)| row[q] * v).sum())
                .collect()
        };
        let hats = [transform(&punch), transform(&profile)];
        let total = |values: &[f64]| -> f64 {
            let pairs = nodes.iter().zip(values);
            2.0 * PI * pairs.map(|((_, w), v)| w.sqrt() * v).sum::<f64>()
        };
        let edge = |right: f64, hat: &[f64]| {
            let waves = waves.iter().zip(hat);
            f * right
                - 2.0 / PI
                    * waves
                        .map(|([alpha, m], p)| m * (alpha * a).cos() * p)
                        .sum::<f64>()
        };
        let (unit, of_profile) = (
            edge(1.0, &hats[0]),
            edge(self.tip.transform(a)[0], &hats[1]),
        );
        Ok(Point {
            radius: a,
            load: 0.0,
            approach: 0.0,
            stiffness: total(&punch),
            stiffness_slope: 2.0 * (PI * unit).powi(2) / modulus,
            stack: self.stack,
            tip: self.tip,
            hertzian: of_profile / unit,
            profile_load: total(&profile),
            edge: unit,
            hats,
        })
    }

    /// Nodes and weights on \[0, a\], in panels that end at a kink.
    fn nodes(&self, a: f64, count: usize) -> Vec<(f64, f64)> {
        let rule = Rule::gauss_legendre(count);
        let kink = self.tip.kink().filter(|b| *b < a);
        panels(0.0, kink, a)
            .flat_map(|panel| panel.nodes(&rule))
            .collect()
    }
}

/// Part of a range of integration.
#[derive(Debug, Clone, Copy)]
struct Panel {
    low: f64,
    high: f64,
    /// Whether the integrand has roots of the distance from the lower end, as beyond a kink of the profile.
    has_root: bool,
}

/// Panels from `low` to `high`, which end at a kink.
fn panels(low: f64, kink: Option<f64>, high: f64) -> impl Iterator<Item = Panel> {
    let first = Panel {
        low,
        high: kink.unwrap_or(high),
        has_root: false,
    };
    let second = kink.map(|low| Panel {
        low,
        high,
        has_root: true,
    });
    std::iter::once(first).chain(second)
}

impl Panel {
    /// Nodes and weights; a root is taken away by squares.
    fn nodes(self, rule: &Rule) -> Vec<(f64, f64)> {
        let length = self.high - self.low;
        match self.has_root {
            false => rule
                .nodes(0.5 * (self.low + self.high), 0.5 * length)
                .collect(),
            true => {
                let place = |(v, w): (f64, f64)| (self.low + length * v * v, 2.0 * length * v * w);
                rule.nodes(0.5, 0.5).map(place).collect()
            }
        }
    }
}

impl Point<'_> {
    /// This contact at an approach, with the load that belongs to it.
    pub(super) fn at(mut self, approach: f64) -> Self {
        self.approach = approach;
        self.load = self.stiffness * approach - self.profile_load;
        self
    }

    /// Pressure at r from the axis \[Pa\], 0 outside of the contact; +∞ below the tip of a cone, and at an edge where it
    /// has no limit.
    ///
    /// # Errors
    /// A place that is negative or not finite.
    pub fn pressure(&self, r: f64) -> Result<f64> {
        if !(r.is_finite() && r >= 0.0) {
            return Err(Error::Parameter {
                name: "r",
                requirement: "finite and at least 0",
                value: r,
            });
        }
        let a = self.radius;
        let density = (self.approach - self.hertzian) * self.edge;
        if r > a {
            return Ok(0.0);
        }
        if r >= a {
            return Ok(if density.abs() > 0.0 {
                density.signum() * f64::INFINITY
            } else {
                0.0
            });
        }
        let singular = density / ((a - r) * (a + r)).sqrt();
        let ratio = self.stack.thickness.map_or(0.0, |h| a / h);
        let rule = Rule::gauss_legendre(PRESSURE + (4.0 * ratio).ceil() as usize);
        let mut sum = 0.0;
        let kink = self.tip.kink().filter(|b| *b > r && *b < a);
        if r > 0.0 {
            // t = r cosh θ takes the root away.
            let angle = |t: f64| (t / r).acosh();
            for panel in panels(0.0, kink.map(angle), angle(a)) {
                let nodes = panel.nodes(&rule).into_iter();
                sum += nodes
                    .map(|(angle, w)| w * self.slope(r * angle.cosh()))
                    .sum::<f64>();
            }
            return Ok(singular - sum);
        }
        if self.tip.transform(0.0)[1] > 0.0 {
            return Ok(f64::INFINITY);
        }
        for panel in panels(0.0, kink, a) {
            let nodes = panel.nodes(&rule).into_iter();
            sum += nodes.map(|(t, w)| w * self.slope(t) / t).sum::<f64>();
        }
        Ok(singular - sum)
    }

    /// φ'(t) of the contact: −f F' + 2/π ∫ M α sin(αt) p̂ dα.
    fn slope(&self, t: f64) -> f64 {
        let [punch, profile] = &self.hats;
        let waves = self.stack.waves.iter().zip(punch.iter().zip(profile));
        let sum: f64 = waves
            .map(|([alpha, m], (punch, profile))| {
                m * alpha * (alpha * t).sin() * (self.approach * punch - profile)
            })
            .sum();
        2.0 / PI * sum - self.stack.modulus / PI * self.tip.transform(t)[1]
    }
}
