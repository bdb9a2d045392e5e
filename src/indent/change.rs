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

mod along;

use std::f64::consts::PI;

use super::adhesion::Adhesion;
use super::density::{Density, bessel_sum};
use super::equation::stack::{Level, Parameter};
use super::equation::system::times;
use super::point::{Point, distance};
use super::tip::TipParameter;
use super::zone::Rate;
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
