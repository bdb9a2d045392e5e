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

use super::super::density::Density;
use super::super::equation::system::times;
use super::super::point::Point;
use super::super::zone::Zone;
use crate::numerics::parallel::dot;

/// What a unit of approach does at fixed contact radius: to φ(a) − ψ(a) and to the load, with the outer radius that follows.
#[derive(Debug)]
pub(super) struct Free {
    pub(super) edge: f64,
    pub(super) load: f64,
    pub(super) outer: Option<Outer>,
}

/// What a unit of the outer radius does at fixed contact radius and approach.
#[derive(Debug)]
pub(super) struct Outer {
    /// φ_c in the basis.
    pub(super) values: Vec<f64>,
    /// Transform of φ_c and of ψ_c at the waves.
    pub(super) hat: Vec<f64>,
    /// D_c, P_c and G_c.
    pub(super) edge: f64,
    pub(super) load: f64,
    pub(super) gap: f64,
    /// u₁(c) − 1.
    pub(super) gap_of_approach: f64,
}

impl Outer {
    /// Change of the outer radius that keeps the gap there, where all else at fixed outer radius changes it by `gap`.
    pub(super) fn following(&self, gap: f64) -> f64 {
        -gap / self.gap
    }
}

impl Point {
    /// What a unit of approach does at fixed contact radius.
    pub(super) fn free(&self) -> Free {
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
    pub(in crate::indent) fn along(&self) -> [f64; 2] {
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
    pub(super) fn along_with(&self, free: &Free) -> [f64; 2] {
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
    pub(super) fn widening(&self, edge: f64) -> (Vec<f64>, Vec<f64>, f64) {
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
