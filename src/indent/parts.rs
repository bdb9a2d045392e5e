//! The two solutions of one contact radius, of the flat punch and of the profile, of which all its states are made.

use std::f64::consts::PI;

use super::equation::stack::Stack;
use super::equation::system::{System, times};
use super::tip::Tip;
use crate::error::{Error, Result};
use crate::numerics::parallel::dot;

/// φ₁ of a flat punch at unit approach and φ_F of the profile, with what follows from them.
#[derive(Debug)]
pub(super) struct Parts {
    pub(super) stack: Stack,
    pub(super) tip: Tip,
    pub(super) system: System,
    /// φ₁ and φ_F in the basis.
    pub(super) values: [Vec<f64>; 2],
    /// Their transforms at the waves.
    pub(super) hats: [Vec<f64>; 2],
    /// Their values at the edge.
    pub(super) edge: [f64; 2],
    /// S = 2π ∫ φ₁ \[N/m\], and P_F = 2π ∫ φ_F \[N\].
    pub(super) loads: [f64; 2],
}

impl Parts {
    /// The parts at the contact radius `a` \[m\]; `length` as in [`System::new`].
    ///
    /// # Errors
    /// As [`System::new`], and numbers beyond those of the machine.
    pub(super) fn new(stack: &Stack, tip: &Tip, a: f64, length: f64) -> Result<Self> {
        let system = System::new(stack, tip, a, length)?;
        let f = stack.surface_modulus() / PI;
        let places = system.basis.places();
        let profile: Vec<f64> = places.iter().map(|s| f * tip.transform(*s)[0]).collect();
        let punch = system.ones.iter().map(|one| f * one).collect();
        let rights = [
            (punch, f),
            (system.basis.project(&profile), f * tip.transform(a)[0]),
        ];
        let mut loads = [0.0; 2];
        let mut edge = [0.0; 2];
        let mut hats = [Vec::new(), Vec::new()];
        let mut k = 0;
        let values = rights.map(|(right, at_edge)| {
            let values = system.solve(right);
            hats[k] = system.transform(&values);
            let weighted = times(system.excess(), &hats[k]);
            edge[k] = at_edge - system.couple_edge(&weighted);
            loads[k] = 2.0 * PI * dot(&values, &system.ones);
            k += 1;
            values
        });
        if edge.iter().chain(&loads).any(|value| !value.is_finite())
            || edge[0] <= 0.0
            || loads[0] <= 0.0
        {
            return Err(Error::Parameter {
                name: "radius",
                requirement: "one whose load and stiffness are numbers of the machine",
                value: a,
            });
        }
        Ok(Self {
            stack: stack.clone(),
            tip: tip.clone(),
            system,
            values,
            hats,
            edge,
            loads,
        })
    }

    /// f = E*/π.
    pub(super) fn f(&self) -> f64 {
        self.stack.surface_modulus() / PI
    }

    /// Approach \[m\] without adhesion: φ vanishes at the edge.
    pub(super) fn hertzian(&self) -> f64 {
        self.edge[1] / self.edge[0]
    }

    /// S' = 2π² φ₁(a)²/E* \[N/m²\].
    pub(super) fn stiffness_slope(&self) -> f64 {
        2.0 * (PI * self.edge[0]).powi(2) / self.stack.surface_modulus()
    }
}
