//! Derivatives of a state with respect to the numbers of bodies, tip and adhesion, and along the curve.
//!
//! At fixed contact radius and approach φ changes by φ_θ, and the edge condition φ(a) = e(a) then moves the approach:
//!
//! ```text
//! B φ_θ = f_θ (δ − F) − f F_θ − 2/π ∫ M_θ b̂ p̂ dα      δ_θ φ₁(a) + φ_θ(a) = e_θ      S_θ = S f_θ/f − 4/f ∫ M_θ φ̂₁² dα
//! ```
//!
//! What is given (radius, load or approach) is held by a change of the radius along the curve; the outer radius of a cohesive zone
//! follows everything. Derived here; not published elsewhere.
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
//! Derived here; not published elsewhere. The energy of the stress between the surfaces makes P_c = 2πcσ₀ (u₁(c) − 1), which a test confirms.

use std::f64::consts::PI;
use std::sync::Arc;

use super::adhesion::Adhesion;
use super::equation::stack::{IndentParameter, StackLevel};
use super::equation::{add, times};
use super::point::{Point, check_distances};
use super::pressure::{Answer, Density, Rate, WHOLE, Zone, bessel_sum};
use super::tip::TipParameter;
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
    Parameter(IndentParameter),
    /// What was given.
    Held,
}

/// Derivatives of a state, per unit of the variable.
#[derive(Debug)]
#[non_exhaustive]
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
    effect: Effect,
    /// Change of the cohesive zone.
    zone: Rate,
    /// φ at fixed place, in the basis.
    values: Vec<f64>,
    density: Density<'a>,
}

/// How a variable enters the equations, per unit of it.
#[derive(Debug, Default)]
struct Effect {
    /// Its number among the parameters of the bodies.
    number: Option<usize>,
    /// The number of the tip that it is.
    rate: Option<TipParameter>,
    /// Derivative of lim α û/p̂, relative to it.
    short: f64,
    /// Derivative of the radius of a flat punch.
    widening: f64,
    /// Derivative of φ at the edge.
    edge: f64,
    /// Derivative of w/σ₀.
    opening: f64,
    /// Derivative of σ₀, relative to it.
    stress: f64,
    /// Derivative of the force outside of the contact.
    outside: f64,
}

/// Derivatives at fixed radius and approach: of φ(a) − e(a), of the load, and of the outer radius.
struct Fixed {
    edge: f64,
    load: f64,
    outer: f64,
}

impl Point {
    /// Derivatives with respect to `variable`, where `held` was given.
    ///
    /// # Errors
    /// A number that this state does not depend on, and a radius held of a flat punch, whose load it does not give.
    pub fn derivative(&self, variable: Variable, held: Held) -> Result<Change<'_>> {
        let parts = &*self.parts;
        let (system, f) = (&parts.system, parts.f());
        let effect = self.effect(variable)?;
        let (f_rate, free) = (-effect.short * f, self.free());
        let excess_rate = self.excess_rate(effect.number);
        let g = excess_rate.map_or_else(
            || vec![0.0; system.waves()],
            |excess_rate| times(excess_rate, &self.hat()),
        );
        // What oscillates in a density whose transform changes by `hat`.
        let with_excess = |hat: &[f64]| -> Vec<f64> {
            let own = times(system.excess(), hat);
            g.iter().zip(own).map(|(g, own)| g + own).collect()
        };
        let mut change = self.at_fixed(&effect, excess_rate.map(|_| &g[..]));
        let [depth, ..] = parts.tip.transform(self.radius);
        let known = [f_rate * self.approach, f_rate];
        let known_at_edge = f_rate * (self.approach - depth);
        let own = self.moved(known, known_at_edge, &effect, with_excess(&change.hat));
        let fixed = self.fixed(&effect, &free, &change, own)?;
        let held_rate = f64::from(variable == Variable::Held);
        let [approach, radius, load] = self.rates(&effect, &free, &fixed, held, held_rate)?;
        // Along the curve: a punch, what the wider contact adds, and the outer radius.
        add(&mut change.values, approach, &parts.values[0]);
        add(&mut change.hat, approach, &parts.hats[0]);
        let edge = self.step();
        if edge.abs() > 0.0 && radius.abs() > 0.0 {
            change.add(radius, &self.widening(edge));
        }
        let outer_radius = free.outer.as_ref().map(|outer| {
            let outer_rate = fixed.outer + approach * outer.following(outer.gap_of_approach);
            change.add(outer_rate, &outer.answer);
            outer_rate
        });
        let mut stiffness = -effect.short * self.stiffness + self.stiffness_slope * radius;
        if let Some(excess_rate) = excess_rate {
            let [punch, _] = &parts.hats;
            stiffness -= 4.0 / f * dot(&times(excess_rate, punch), punch);
        }
        let known = [f_rate * self.approach + f * approach, f_rate];
        let known_at_edge = known[0] - known[1] * depth;
        let density = self.moved(known, known_at_edge, &effect, with_excess(&change.hat));
        Ok(Change {
            radius,
            load,
            approach,
            stiffness,
            outer_radius,
            point: self,
            zone: [effect.stress, outer_radius.unwrap_or(0.0)],
            effect,
            values: change.values,
            density,
        })
    }

    /// How `variable` enters the equations.
    fn effect(&self, variable: Variable) -> Result<Effect> {
        let Variable::Parameter(parameter) = variable else {
            return Ok(Effect::default());
        };
        let (stack, tip) = (&self.parts.stack, &self.parts.tip);
        let mut effect =
            Effect { outside: self.adhesion.outside_rate(tip, parameter), ..Effect::default() };
        let unknown = Error::Inconsistent(
            "the state does not depend on this parameter: take one of the bodies, the tip or the adhesion",
        );
        match (parameter, self.adhesion) {
            (IndentParameter::Work, Adhesion::Jkr { work }) => {
                effect.edge = self.step() / (2.0 * work)
            }
            (IndentParameter::Work, Adhesion::Dmt { .. }) => {}
            (IndentParameter::Work, Adhesion::Maugis { strength, .. }) => {
                effect.opening = 1.0 / strength;
            }
            (IndentParameter::Strength, Adhesion::Maugis { work, strength }) => {
                let zone = self.zone.as_ref().ok_or(unknown)?;
                effect.stress = 1.0 / strength;
                effect.opening = -work / (strength * strength);
                effect.edge = effect.stress * zone.density(WHOLE);
            }
            (IndentParameter::Work | IndentParameter::Strength, _) => return Err(unknown),
            (IndentParameter::Tip(TipParameter::Number(k)), _) if k >= tip.numbers().len() => {
                return Err(unknown);
            }
            (IndentParameter::Tip(own), _) => {
                effect.rate = Some(own);
                effect.widening = tip.fixed_radius().map_or(0.0, |a| match own {
                    TipParameter::Area => 0.5 * a,
                    TipParameter::Number(_) => 1.0,
                });
            }
            (IndentParameter::Body(..), adhesion) => {
                let number = stack.parameters().iter().position(|own| *own == parameter);
                let number = number.ok_or(unknown)?;
                effect.number = Some(number);
                effect.short = -stack.modulus_rate(number);
                if matches!(adhesion, Adhesion::Jkr { .. }) && tip.fixed_radius().is_none() {
                    effect.edge = -0.5 * self.step() * effect.short;
                }
            }
        }
        Ok(effect)
    }

    /// Weights times the derivative of M with respect to this parameter of the bodies, where there are layers.
    fn excess_rate(&self, number: Option<usize>) -> Option<&[f64]> {
        let level = self.parts.system.level.as_ref()?;
        Some(self.parts.stack.excess_rate(level, number?))
    }

    /// φ_θ at fixed radius and approach; `g` is what M_θ adds to what oscillates.
    fn at_fixed(&self, effect: &Effect, g: Option<&[f64]>) -> Answer {
        let parts = &*self.parts;
        let (tip, system, f) = (&parts.tip, &parts.system, parts.f());
        let places = system.basis.places();
        let rates = effect.rate.map(|rate| tip.rate(rate, &places));
        let known = |(k, s): (usize, &f64)| {
            let shape = rates.as_ref().map_or(0.0, |rates| f * rates[k][0]);
            -effect.short * f * (self.approach - tip.transform(*s)[0]) - shape
        };
        let known: Vec<f64> = places.iter().enumerate().map(known).collect();
        let mut right = system.basis.project(&known);
        if let Some(g) = g {
            add(&mut right, -1.0, &system.couple(g));
        }
        let values = system.solve(right);
        let mut change = Answer { hat: system.transform(&values), values, edge: 0.0 };
        if let Some(zone) = &self.zone {
            change.add(effect.stress, &zone.answer);
        }
        change
    }

    /// What φ_θ at fixed radius and approach does; `own` is its density.
    fn fixed(&self, effect: &Effect, free: &Free, change: &Answer, own: Density) -> Result<Fixed> {
        let parts = &*self.parts;
        let mut fixed = Fixed {
            edge: own.edge - effect.edge,
            load: 2.0 * PI * dot(&change.values, &parts.system.ones) - effect.outside,
            outer: 0.0,
        };
        if let (Some(zone), Some(outer)) = (&self.zone, &free.outer) {
            let displaced =
                own.displaced(zone.outer) + effect.stress * zone.abel(WHOLE, zone.outer);
            let shape = effect.rate.map_or(0.0, |rate| parts.tip.gap_rate(rate, zone.outer));
            let gap = self.displacement(&[zone.outer])?[0] * effect.short
                + parts.stack.short() * displaced
                + shape
                - effect.opening;
            fixed.outer = outer.following(gap);
            fixed.edge += outer.answer.edge * fixed.outer;
            fixed.load += effect.stress * zone.load(WHOLE) + outer.load * fixed.outer;
        }
        Ok(fixed)
    }

    /// Derivatives of approach, radius and load where `held` changes by `held_rate`.
    fn rates(
        &self,
        effect: &Effect,
        free: &Free,
        fixed: &Fixed,
        held: Held,
        held_rate: f64,
    ) -> Result<[f64; 3]> {
        if self.parts.tip.fixed_radius().is_some() {
            let own = fixed.load + self.stiffness_slope * self.approach * effect.widening;
            let approach = match held {
                Held::Approach => held_rate,
                Held::Load => (held_rate - own) / free.load,
                Held::Radius => {
                    return Err(Error::Inconsistent(
                        "the radius of a flat punch does not give its load: hold load or approach",
                    ));
                }
            };
            return Ok([approach, effect.widening, own + free.load * approach]);
        }
        let approach = -fixed.edge / free.edge;
        let load = fixed.load + free.load * approach;
        let [approach_slope, load_slope] = self.along_with(free);
        let radius = match held {
            Held::Radius => held_rate,
            Held::Load => (held_rate - load) / load_slope,
            Held::Approach => (held_rate - approach) / approach_slope,
        };
        Ok([approach + approach_slope * radius, radius, load + load_slope * radius])
    }

    /// A change of the density at fixed place, of which `g` oscillates.
    fn moved(
        &self,
        known: [f64; 2],
        known_at_edge: f64,
        effect: &Effect,
        g: Vec<f64>,
    ) -> Density<'_> {
        let (parts, a) = (&*self.parts, self.radius);
        let shape = effect.rate.map_or(0.0, |rate| parts.f() * parts.tip.rate(rate, &[a])[0][0]);
        Density {
            parts,
            known,
            rate: effect.rate,
            edge: known_at_edge - shape - parts.system.couple_edge(&g),
            g,
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
        check_distances(r)?;
        let (a, edge) = (self.point.radius, self.point.step());
        let zone = self.point.zone.as_ref();
        let density = Density {
            edge: self.density.edge - zone.map_or(0.0, |zone| zone.density(self.zone)),
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
            let from_zone = zone.map_or(0.0, |zone| zone.inside(self.zone, *r));
            density.pressure(*r) - moved + from_zone
        };
        Ok(r.iter().map(at).collect())
    }

    /// Derivative of the displacement at each distance r from the axis \[m per unit\].
    ///
    /// # Errors
    /// As [`Point::displacement`].
    pub fn displacement(&self, r: &[f64]) -> Result<Vec<f64>> {
        check_distances(r)?;
        let point = self.point;
        let (a, edge) = (point.radius, point.step());
        let zone = point.zone.as_ref();
        let stack = &point.parts.stack;
        let displaced = point.displacement(r)?;
        let far = r.iter().fold(0.0_f64, |most, r| most.max(*r));
        let waves = stack.level(a + far);
        let waves = waves.map(|level| (self.wider(level), &level.waves.alpha));
        let at = |(r, u): (&f64, f64)| -> f64 {
            if *r <= a {
                let tip = &point.parts.tip;
                let shape = self.effect.rate.map_or(0.0, |rate| tip.gap_rate(rate, *r));
                return self.approach - shape;
            }
            let moved = match edge.abs() > 0.0 {
                true => edge * self.radius / ((r - a) * (r + a)).sqrt(),
                false => 0.0,
            };
            let layers = waves.as_ref();
            let layers = layers.map_or(0.0, |(g, alpha)| bessel_sum(g, alpha, *r));
            let from_zone = zone.map_or(0.0, |zone| zone.abel(self.zone, *r));
            self.effect.short * u
                + stack.short() * (self.density.abel(*r) + moved + from_zone + layers)
        };
        Ok(r.iter().zip(displaced).map(at).collect())
    }

    /// What oscillates in the density, at the waves of `level`.
    fn wider(&self, level: &Arc<StackLevel>) -> Vec<f64> {
        let (point, waves) = (self.point, &level.waves);
        let system = &point.parts.system;
        if system.level.as_ref().is_some_and(|own| Arc::ptr_eq(own, level)) {
            return self.density.g.clone();
        }
        let values = point.values();
        let [mut change, mut hat] = system.transforms_at(waves, [&self.values, &values]);
        let (mut cos, mut sin) = (change.clone(), change.clone());
        waves.circular(point.radius, &mut cos, &mut sin);
        add(&mut change, point.step() * self.radius, &cos);
        if let Some(zone) = &point.zone {
            add(&mut change, 1.0, &zone.transform(self.zone, waves));
            add(&mut hat, 1.0, &zone.transform(WHOLE, waves));
        }
        let mut g = times(&level.excess, &change);
        if let Some(number) = self.effect.number {
            let rate = point.parts.stack.excess_rate(level, number);
            add(&mut g, 1.0, &times(rate, &hat));
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
    /// φ_c, the transform of φ_c and of ψ_c, and D_c.
    answer: Answer,
    /// P_c and G_c.
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
        let mut free = Free { edge: self.parts.edge[0], load: self.stiffness, outer: None };
        if let Some(outer) = &outer {
            let following = outer.following(outer.gap_of_approach);
            free.edge += outer.answer.edge * following;
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
        let mut needed = edge / (2.0 * self.radius) + around - self.density().slope_at_edge();
        let mut more = edge;
        if edge.abs() > 0.0 {
            let wider = self.widening(edge);
            needed -= wider.edge;
            more += dot(&wider.values, &system.ones);
        }
        let approach = needed / free.edge;
        [approach, free.load * approach + 2.0 * PI * more]
    }

    /// φ_a of a density that is `edge` at the edge: in the basis, its transform with that of the wider contact, and at the edge.
    fn widening(&self, edge: f64) -> Answer {
        let system = &self.parts.system;
        let outer = times(system.excess(), &system.edge[0]);
        let right = system.couple(&outer).iter().map(|c| -edge * c).collect();
        let values = system.solve(right);
        let mut hat = system.transform(&values);
        add(&mut hat, edge, &system.edge[0]);
        let edge = -system.couple_edge(&times(system.excess(), &hat));
        Answer { values, hat, edge }
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
        let own = Density { edge: self.edge(), ..self.density() };
        let moved = own.displaced_slope(c) + zone.abel(WHOLE, c) / (c - zone.inner);
        Outer {
            load: 2.0 * PI * dot(&answer.values, &system.ones) + zone.load([0.0, 1.0]),
            gap: parts.tip.slope(c) + short * (moved + of_outer),
            gap_of_approach: short * of_approach - 1.0,
            answer: Answer { edge: answer.edge - zone.density([0.0, 1.0]), ..answer },
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
                let adhesion = Adhesion::Maugis { work: 0.02, strength };
                let indent = Indent::new(&stack, &Tip::paraboloid(2.0)?).with_adhesion(adhesion)?;
                let point = indent.at_radius(0.4)?;
                let free = point.free();
                let outer = free.outer.as_ref().expect("a cohesive zone");
                let c = point.outer_radius.expect("a cohesive zone");
                let due = 2.0 * PI * c * strength * outer.gap_of_approach;
                assert!((outer.load / due - 1.0).abs() < 1e-9, "{c}: {} {due}", outer.load);
            }
        }
        Ok(())
    }
}
