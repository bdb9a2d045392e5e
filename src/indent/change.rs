//! Derivatives of a state with respect to the numbers of bodies, tip and adhesion, and along the curve.
//!
//! At fixed contact radius and approach φ changes by φ_θ, and the edge condition φ(a) = e(a) then moves the approach:
//!
//! ```text
//! B φ_θ = f_θ (δ − F) − f F_θ − 2/π ∫ M_θ b̂ p̂ dα      δ_θ φ₁(a) + φ_θ(a) = e_θ      S_θ = S f_θ/f − 4/f ∫ M_θ φ̂₁² dα
//! ```
//!
//! What is given (radius, load or approach) is held by a change of the radius along the curve; the outer radius of a cohesive zone
//! follows everything. Derived for nacre.
//!
//! Derivatives along the states of one adhesion, on which the outer radius of a cohesive zone follows everything else.
//!
//! At fixed contact radius a, the edge condition D = φ(a) − ψ(a) = 0 and the gap G = g(c) + u(c) − δ − w/σ₀ = 0 at the outer radius
//! depend on δ and c; a change of a at fixed δ and c changes neither the load nor G, since the density has no step at a:
//!
//! ```text
//! dD = φ₁(a) dδ + D_c dc + (φ' − ψ')(a) da      dG = (u₁(c) − 1) dδ + G_c dc = 0      dP = S dδ + P_c dc
//! ```
//!
//! Derived for nacre. The energy of the stress between the surfaces makes P_c = 2πcσ₀ (u₁(c) − 1), which a test confirms.

use std::f64::consts::PI;

use super::adhesion::Adhesion;
use super::density::{Density, bessel_sum};
use super::equation::stack::{Level, Parameter};
use super::equation::system::times;
use super::point::{Point, distance};
use super::tip::TipParameter;
use super::zone::{Rate, Zone};
use crate::error::{Error, Result};
use crate::numerics::parallel::dot;

/// What was given of a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Held {
    /// The contact radius.
    Radius,
    /// The load.
    Load,
    /// The approach.
    Approach,
}

/// With respect to what a state is differentiated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variable {
    /// A number of bodies, tip or adhesion.
    Parameter(Parameter),
    /// What was given.
    Held,
}

/// Derivatives of a state, per unit of the variable.
#[derive(Debug)]
pub struct Change<'a> {
    /// Derivative of the contact radius.
    pub radius: f64,
    /// Derivative of the load.
    pub load: f64,
    /// Derivative of the approach.
    pub approach: f64,
    /// Derivative of the stiffness.
    pub stiffness: f64,
    /// Derivative of the outer radius of a cohesive zone.
    pub outer_radius: Option<f64>,
    point: &'a Point,
    /// Derivative of lim α û/p̂, relative to it.
    short: f64,
    number: Option<usize>,
    rate: Option<TipParameter>,
    /// Change of the cohesive zone.
    zone: Rate,
    /// φ at fixed place, in the basis.
    values: Vec<f64>,
    density: Density<'a>,
}

impl Point {
    /// Derivatives with respect to `variable`, where `held` was given.
    ///
    /// # Errors
    /// A number that this state does not depend on, and a radius held of a flat punch, whose load it does not give.
    pub fn derivative(&self, variable: Variable, held: Held) -> Result<Change<'_>> {
        let parts = &*self.parts;
        let (stack, tip, system) = (&parts.stack, &parts.tip, &parts.system);
        let (f, edge) = (parts.f(), self.step());
        let is_flat = tip.fixed_radius().is_some();
        let unknown = Error::Inconsistent(
            "the state does not depend on this parameter: take one of the bodies, the tip or the adhesion",
        );
        let (mut number, mut rate, mut short) = (None, None, 0.0);
        let (mut widening, mut of_edge) = (0.0, 0.0);
        // Of w/σ₀, and of the stress relative to it.
        let (mut of_opening, mut of_stress) = (0.0, 0.0);
        let outside = match variable {
            Variable::Parameter(parameter) => self.adhesion.outside_rate(tip, parameter),
            Variable::Held => 0.0,
        };
        match variable {
            Variable::Held => {}
            Variable::Parameter(Parameter::Work) => match self.adhesion {
                Adhesion::Jkr { work } => of_edge = edge / (2.0 * work),
                Adhesion::Dmt { .. } => {}
                Adhesion::Maugis { strength, .. } => of_opening = 1.0 / strength,
                Adhesion::None => return Err(unknown),
            },
            Variable::Parameter(Parameter::Strength) => match (self.adhesion, &self.zone) {
                (Adhesion::Maugis { work, strength }, Some(zone)) => {
                    of_stress = 1.0 / strength;
                    of_opening = -work / (strength * strength);
                    of_edge = of_stress * zone.density();
                }
                _ => return Err(unknown),
            },
            Variable::Parameter(Parameter::Tip(own)) => {
                if let TipParameter::Number(k) = own
                    && k >= tip.numbers().len()
                {
                    return Err(unknown);
                }
                rate = Some(own);
                if let Some(a) = tip.fixed_radius() {
                    widening = match own {
                        TipParameter::Area => 0.5 * a,
                        TipParameter::Number(_) => 1.0,
                    };
                }
            }
            Variable::Parameter(parameter) => {
                let found = stack.parameters().iter().position(|own| *own == parameter);
                let found = found.ok_or(unknown)?;
                number = Some(found);
                short = -stack.modulus_rate(found);
                if matches!(self.adhesion, Adhesion::Jkr { .. }) && !is_flat {
                    of_edge = -0.5 * edge * short;
                }
            }
        }
        let f_rate = -short * f;
        let excess_rate = number.zip(system.level.as_ref());
        let excess_rate = excess_rate.map(|(number, level)| stack.excess_rate(level, number));
        let hat = self.hat();
        // At fixed radius and approach.
        let places = system.basis.places();
        let rates = rate.map(|rate| tip.rate(rate, &places));
        let known = |k: usize, s: f64| {
            let shape = rates.as_ref().map_or(0.0, |rates| f * rates[k][0]);
            f_rate * (self.approach - tip.transform(s)[0]) - shape
        };
        let known: Vec<f64> = places
            .iter()
            .enumerate()
            .map(|(k, s)| known(k, *s))
            .collect();
        let mut right = system.basis.project(&known);
        let mut g = vec![0.0; hat.len()];
        if let Some(excess_rate) = excess_rate {
            g = times(excess_rate, &hat);
            let coupled = system.couple(&g);
            right
                .iter_mut()
                .zip(coupled)
                .for_each(|(right, c)| *right -= c);
        }
        let mut values = system.solve(right);
        let mut change = system.transform(&values);
        let add = |sum: &mut [f64], factor: f64, more: &[f64]| {
            let pairs = sum.iter_mut().zip(more);
            pairs.for_each(|(sum, more)| *sum += factor * more);
        };
        if let Some(zone) = &self.zone {
            add(&mut values, of_stress, &zone.answer.values);
            add(&mut change, of_stress, &zone.answer.hat);
        }
        let a = self.radius;
        let with_excess = |change: &[f64]| -> Vec<f64> {
            let own = times(system.excess(), change);
            g.iter().zip(own).map(|(g, own)| g + own).collect()
        };
        let shape = rate.map_or(0.0, |rate| f * tip.rate(rate, &[a])[0][0]);
        let at_edge = f_rate * (self.approach - tip.transform(a)[0])
            - shape
            - system.couple_edge(&with_excess(&change));
        let free = self.free();
        // Approach, load and outer radius at fixed radius, and their slopes along the curve.
        let mut fixed_edge = at_edge - of_edge;
        let mut fixed_load = 2.0 * PI * dot(&values, &system.ones) - outside;
        let mut fixed_outer = 0.0;
        if let (Some(zone), Some(outer)) = (&self.zone, &free.outer) {
            let rate_known = [f_rate * self.approach, f_rate];
            let own = self.moved(rate_known, rate, with_excess(&change), at_edge);
            let displaced = own.displaced(zone.outer) + of_stress * zone.abel(zone.outer);
            let gap = self.displacement(&[zone.outer])?[0] * short
                + stack.short() * displaced
                + rate.map_or(0.0, |rate| tip.gap_rate(rate, zone.outer))
                - of_opening;
            fixed_outer = outer.following(gap);
            fixed_edge += outer.edge * fixed_outer;
            fixed_load += of_stress * zone.load() + outer.load * fixed_outer;
        }
        let given = if variable == Variable::Held { 1.0 } else { 0.0 };
        let (approach_rate, radius_rate, load);
        if is_flat {
            let own = fixed_load + self.stiffness_slope * self.approach * widening;
            approach_rate = match held {
                Held::Approach => given,
                Held::Load => (given - own) / free.load,
                Held::Radius => {
                    return Err(Error::Inconsistent(
                        "the radius of a flat punch does not give its load: hold load or approach",
                    ));
                }
            };
            radius_rate = widening;
            load = own + free.load * approach_rate;
        } else {
            let fixed = -fixed_edge / free.edge;
            let own = fixed_load + free.load * fixed;
            let [approach_slope, load_slope] = self.along_with(&free);
            radius_rate = match held {
                Held::Radius => given,
                Held::Load => (given - own) / load_slope,
                Held::Approach => (given - fixed) / approach_slope,
            };
            approach_rate = fixed + approach_slope * radius_rate;
            load = own + load_slope * radius_rate;
        }
        // Along the curve: a punch, what the wider contact adds, and the outer radius.
        add(&mut values, approach_rate, &parts.values[0]);
        add(&mut change, approach_rate, &parts.hats[0]);
        if edge.abs() > 0.0 && radius_rate.abs() > 0.0 {
            let (more, hat, _) = self.widening(edge);
            add(&mut values, radius_rate, &more);
            add(&mut change, radius_rate, &hat);
        }
        let outer_radius = free
            .outer
            .as_ref()
            .map(|outer| fixed_outer + approach_rate * outer.following(outer.gap_of_approach));
        let zone: Rate = [of_stress, outer_radius.unwrap_or(0.0)];
        if let Some(outer) = &free.outer {
            add(&mut values, zone[1], &outer.values);
            add(&mut change, zone[1], &outer.hat);
        }
        let mut of_stiffness = -short * self.stiffness + self.stiffness_slope * radius_rate;
        if let Some(excess_rate) = excess_rate {
            let [punch, _] = &parts.hats;
            of_stiffness -= 4.0 / f * dot(&times(excess_rate, punch), punch);
        }
        let known = [f_rate * self.approach + f * approach_rate, f_rate];
        let g = with_excess(&change);
        let at_edge = known[0] - known[1] * tip.transform(a)[0] - shape - system.couple_edge(&g);
        Ok(Change {
            radius: radius_rate,
            load,
            approach: approach_rate,
            stiffness: of_stiffness,
            outer_radius,
            point: self,
            short,
            number,
            rate,
            zone,
            values,
            density: self.moved(known, rate, g, at_edge),
        })
    }

    /// A change of the density.
    fn moved(
        &self,
        known: [f64; 2],
        rate: Option<TipParameter>,
        g: Vec<f64>,
        edge: f64,
    ) -> Density<'_> {
        Density {
            parts: &self.parts,
            known,
            rate,
            g,
            edge,
        }
    }
}

impl Change<'_> {
    /// Derivative of the pressure at each distance r from the axis \[Pa per unit\]; 0 outside of the contact, and at the edge
    /// itself, where it has no limit.
    ///
    /// # Errors
    /// As [`Point::pressure`].
    pub fn pressure(&self, r: &[f64]) -> Result<Vec<f64>> {
        r.iter().try_for_each(|r| distance(*r))?;
        let (a, edge) = (self.point.radius, self.point.step());
        let zone = self.point.zone.as_ref();
        let density = Density {
            edge: self.density.edge - zone.map_or(0.0, |zone| zone.density_rate(self.zone)),
            g: self.density.g.clone(),
            ..self.density
        };
        let at = |r: &f64| {
            if *r > a {
                return zone.map_or(0.0, |zone| self.zone[0] * zone.outside(*r));
            }
            if *r >= a || *r <= 0.0 && self.point.parts.tip.is_sharp() {
                return 0.0;
            }
            let moved = edge * a * self.radius / ((a - r) * (a + r)).powf(1.5);
            let from_zone = zone.map_or(0.0, |zone| zone.inside_rate(self.zone, *r));
            density.pressure(*r) - moved + from_zone
        };
        Ok(r.iter().map(at).collect())
    }

    /// Derivative of the displacement at each distance r from the axis \[m per unit\].
    ///
    /// # Errors
    /// As [`Point::displacement`].
    pub fn displacement(&self, r: &[f64]) -> Result<Vec<f64>> {
        r.iter().try_for_each(|r| distance(*r))?;
        let point = self.point;
        let (a, edge) = (point.radius, point.step());
        let zone = point.zone.as_ref();
        let stack = &point.parts.stack;
        let displaced = point.displacement(r)?;
        let far = r.iter().fold(0.0_f64, |most, r| most.max(*r));
        let waves = stack.level(a + far).map(|level| (self.wider(level), level));
        let at = |(r, u): (&f64, f64)| -> f64 {
            if *r <= a {
                let shape = self
                    .rate
                    .map_or(0.0, |rate| point.parts.tip.gap_rate(rate, *r));
                return self.approach - shape;
            }
            let moved = match edge.abs() > 0.0 {
                true => edge * self.radius / ((r - a) * (r + a)).sqrt(),
                false => 0.0,
            };
            let layers = waves
                .as_ref()
                .map_or(0.0, |(g, level)| bessel_sum(g, &level.waves.alpha, *r));
            let from_zone = zone.map_or(0.0, |zone| zone.abel_rate(self.zone, *r));
            self.short * u + stack.short() * (self.density.abel(*r) + moved + from_zone + layers)
        };
        Ok(r.iter().zip(displaced).map(at).collect())
    }

    /// What oscillates in the density, at the waves of `level`.
    fn wider(&self, level: &Level) -> Vec<f64> {
        let point = self.point;
        let system = &point.parts.system;
        if system
            .level
            .as_ref()
            .is_some_and(|own| std::ptr::eq(&**own, level))
        {
            return self.density.g.clone();
        }
        let rows = system.basis.transforms(&level.waves);
        let sum = |values: &[f64]| {
            let mut sums = vec![0.0; level.waves.len()];
            for (row, value) in rows.iter().zip(values) {
                sums.iter_mut()
                    .zip(row)
                    .for_each(|(sum, b)| *sum += value * b);
            }
            sums
        };
        let mut change = sum(&self.values);
        let moved = point.step() * self.radius;
        let (mut cos, mut sin) = (change.clone(), change.clone());
        level.waves.circular(point.radius, &mut cos, &mut sin);
        change
            .iter_mut()
            .zip(&cos)
            .for_each(|(sum, cos)| *sum += moved * cos);
        let mut hat = sum(&point.values());
        if let Some(zone) = &point.zone {
            let pairs = change
                .iter_mut()
                .zip(zone.transform_rate(self.zone, &level.waves));
            pairs.for_each(|(sum, more)| *sum += more);
            let pairs = hat.iter_mut().zip(zone.transform(&level.waves));
            pairs.for_each(|(sum, more)| *sum += more);
        }
        let mut g = times(&level.excess, &change);
        if let Some(number) = self.number {
            let own = times(point.parts.stack.excess_rate(level, number), &hat);
            g.iter_mut().zip(own).for_each(|(g, own)| *g += own);
        }
        g
    }
}

/// What a unit of approach does at fixed contact radius: to φ(a) − ψ(a) and to the load, with the outer radius that follows.
#[derive(Debug)]
struct Free {
    edge: f64,
    load: f64,
    outer: Option<Outer>,
}

/// What a unit of the outer radius does at fixed contact radius and approach.
#[derive(Debug)]
struct Outer {
    /// φ_c in the basis.
    values: Vec<f64>,
    /// Transform of φ_c and of ψ_c at the waves.
    hat: Vec<f64>,
    /// D_c, P_c and G_c.
    edge: f64,
    load: f64,
    gap: f64,
    /// u₁(c) − 1.
    gap_of_approach: f64,
}

impl Outer {
    /// Change of the outer radius that keeps the gap there, where all else at fixed outer radius changes it by `gap`.
    fn following(&self, gap: f64) -> f64 {
        -gap / self.gap
    }
}

impl Point {
    /// What a unit of approach does at fixed contact radius.
    fn free(&self) -> Free {
        let outer = self.zone.as_ref().map(|zone| self.outer(zone));
        let mut free = Free {
            edge: self.parts.edge[0],
            load: self.stiffness,
            outer: None,
        };
        if let Some(outer) = &outer {
            let following = outer.following(outer.gap_of_approach);
            free.edge += outer.edge * following;
            free.load += outer.load * following;
        }
        Free { outer, ..free }
    }

    /// Derivatives of approach and load with respect to the contact radius, along the states of the same adhesion.
    pub(super) fn along(&self) -> [f64; 2] {
        self.along_with(&self.free())
    }

    /// Derivatives of approach and load along the curve, where `free` is known.
    ///
    /// φ(a) = e(a), and φ changes at fixed t by that of a punch and, where the density has a step at the edge, by what the wider
    /// contact adds. Around it there may be a cohesive zone, with e = ψ:
    ///
    /// ```text
    /// B φ_a = −2/π φ(a) ∫ M b̂ cos αa dα      δ' φ₁(a) = e' − φ'(a) − φ_a(a)      P' = S δ' + 2π [∫ φ_a + φ(a)]
    /// ```
    fn along_with(&self, free: &Free) -> [f64; 2] {
        let edge = self.step();
        let system = &self.parts.system;
        let around = self.zone.as_ref().map_or(0.0, Zone::slope);
        let mut needed = edge / (2.0 * self.radius) + around - self.density().edge_slope();
        let mut more = edge;
        if edge.abs() > 0.0 {
            let (values, _, at_edge) = self.widening(edge);
            needed -= at_edge;
            more += dot(&values, &system.ones);
        }
        let approach = needed / free.edge;
        [approach, free.load * approach + 2.0 * PI * more]
    }

    /// φ_a of a density that is `edge` at the edge: in the basis, its transform with that of the wider contact, and at the edge.
    fn widening(&self, edge: f64) -> (Vec<f64>, Vec<f64>, f64) {
        let system = &self.parts.system;
        let outer = times(system.excess(), &system.edge[0]);
        let right = system.couple(&outer).iter().map(|c| -edge * c).collect();
        let values = system.solve(right);
        let mut hat = system.transform(&values);
        for (hat, cos) in hat.iter_mut().zip(&system.edge[0]) {
            *hat += edge * cos;
        }
        let at_edge = -system.couple_edge(&times(system.excess(), &hat));
        (values, hat, at_edge)
    }

    fn outer(&self, zone: &Zone) -> Outer {
        let parts = &*self.parts;
        let (c, short) = (zone.outer, parts.stack.short());
        let answer = zone.answer(parts, [0.0, 1.0]);
        let system = &parts.system;
        let excess = system.excess();
        let density = |known: f64, hat: &[f64], edge: f64| Density {
            parts,
            known: [known, 0.0],
            rate: None,
            g: times(excess, hat),
            edge,
        };
        // u/A1 at c of a unit of approach, and of a unit of c.
        let [punch, _] = &parts.hats;
        let of_approach = density(parts.f(), punch, parts.edge[0]);
        let of_approach = of_approach.displaced(c);
        let of_outer = density(0.0, &answer.hat, answer.edge);
        let of_outer = of_outer.displaced(c);
        // The place itself moves; ∫ ψ/√(c²−t²) is in proportion to c − a.
        let own = Density {
            edge: self.edge(),
            ..self.density()
        };
        let moved = own.displaced_slope(c) + zone.abel(c) / (c - zone.inner);
        Outer {
            edge: answer.edge - zone.density_rate([0.0, 1.0]),
            load: 2.0 * PI * dot(&answer.values, &system.ones) + zone.load_rate([0.0, 1.0]),
            gap: parts.tip.slope(c) + short * (moved + of_outer),
            gap_of_approach: short * of_approach - 1.0,
            values: answer.values,
            hat: answer.hat,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use crate::indent::{Adhesion, Indent, Stack, Tip};
    use crate::{Elastic, HalfSpace, Layer, Result};

    /// P_c = 2πcσ₀ (u₁(c) − 1), the reciprocity of approach and outer radius, on a bare and a coated body, and with zones from a
    /// hundredth of the contact to its size.
    #[test]
    fn reciprocity_of_approach_and_outer_radius() -> Result<()> {
        let base = Elastic::new(1.0, 0.3)?;
        let coated = HalfSpace::new(base, [Layer::new(Elastic::new(5.0, 0.2)?, 0.3)?])?;
        for body in [base.into(), coated.into()] {
            let stack = Stack::plan(&[body])?;
            for strength in [0.02, 0.1, 0.5] {
                let adhesion = Adhesion::Maugis {
                    work: 0.02,
                    strength,
                };
                let indent = Indent::new(&stack, &Tip::paraboloid(2.0)?).with_adhesion(adhesion)?;
                let point = indent.at_radius(0.4)?;
                let free = point.free();
                let outer = free.outer.as_ref().expect("a cohesive zone");
                let c = point.outer_radius.expect("a cohesive zone");
                let due = 2.0 * PI * c * strength * outer.gap_of_approach;
                assert!(
                    (outer.load / due - 1.0).abs() < 1e-9,
                    "{c}: {} {due}",
                    outer.load
                );
            }
        }
        Ok(())
    }
}
