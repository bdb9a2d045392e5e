//! Stresses of what the pressure of a solved contact is within its cells.

use super::components::{COMPONENTS, EXCHANGED, PressureStress, TractionStress};
use super::kernel::{Kernel, Plan};
use super::line::{self, LinePlan};
use super::near::{Near, NearPlan, STRESSES};
use crate::body::HalfSpace;
use crate::grid::Grid;
use crate::response::interior::Place;

/// A body under the pressure of a contact and its friction, of which only what is within cells is
/// looked at.
#[derive(Debug)]
pub(super) struct Within {
    kind: Kernels,
    near: NearPlan,
    friction: [f64; 2],
    /// The cells' pressure: the tractions at the surface are of that.
    given: Vec<f64>,
}

/// What makes the stresses of a piece of a cell.
#[derive(Debug)]
enum Kernels {
    Plane {
        plan: Box<Plan>,
        pressure: Vec<Vec<(f64, f64)>>,
        traction: Vec<Vec<(f64, f64)>>,
    },
    Line(LinePlan),
}

/// Sides of the smallest pieces, in cells.
const FINEST: f64 = 1.0 / 135.0;

impl Within {
    /// On the threads of the caller.
    pub(super) fn new(body: &HalfSpace, grid: &Grid, pressure: &[f64], friction: [f64; 2]) -> Self {
        let near = NearPlan::new(pressure, grid);
        let kind = if grid.is_line() {
            Kernels::Line(LinePlan::new(body, grid, FINEST))
        } else {
            let plan = Plan::new(body, grid.spacing(), FINEST, near.farthest());
            Kernels::Plane {
                pressure: plan.multipliers::<4, PressureStress>(),
                traction: plan.multipliers::<6, TractionStress>(),
                plan: Box::new(plan),
            }
        };
        Self {
            kind,
            near,
            friction,
            given: pressure.to_vec(),
        }
    }

    /// What is to be taken as uniform over cells.
    pub(super) fn uniform(&self) -> &[f64] {
        &self.near.reconstruction.uniform
    }

    /// Stresses of pieces of cells at `place`, where they are felt. On the threads of the caller.
    pub(super) fn at(&self, place: &Place) -> Near {
        if !self.near.reaches(place.depth) {
            return Near::default();
        }
        let [fx, fy] = self.friction;
        let none = [0.0; COMPONENTS];
        let sum = |normal: [f64; COMPONENTS], x: [f64; COMPONENTS], y: [f64; COMPONENTS]| {
            let stress = |k: usize| normal[k] + fx * x[k] + fy * y[k];
            std::array::from_fn::<f64, STRESSES, _>(stress)
        };
        match &self.kind {
            Kernels::Line(plan) => {
                let normal = plan.strips::<6, line::Pressure>(place);
                let along = (fx != 0.0).then(|| plan.strips::<3, line::Along>(place));
                let across = (fy != 0.0).then(|| plan.strips::<6, line::Across>(place));
                self.near.table(place.depth, |[_, y], [_, half]| {
                    let along = along.as_ref().map_or(none, |strips| strips.at(y, half));
                    let across = across.as_ref().map_or(none, |strips| strips.at(y, half));
                    sum(normal.at(y, half), along, across)
                })
            }
            Kernels::Plane {
                plan,
                pressure,
                traction,
            } => {
                let slides = fx != 0.0 || fy != 0.0;
                let normal = Kernel::new::<PressureStress>(plan, pressure, place);
                let lateral = slides.then(|| Kernel::new::<TractionStress>(plan, traction, place));
                self.near.table(place.depth, |[x, y], [a, b]| {
                    let pressed = normal.at::<PressureStress>([x, y], [a, b]);
                    let Some(lateral) = &lateral else {
                        return sum(pressed, none, none);
                    };
                    // Traction along y is traction along x with both exchanged.
                    let along = lateral.at::<TractionStress>([x, y], [a, b]);
                    let across = lateral.at::<TractionStress>([y, x], [b, a]);
                    sum(pressed, along, EXCHANGED.map(|k| across[k]))
                })
            }
        }
    }

    /// Adds them to the stresses of the uniform pressure on a plane. On the threads of the caller.
    pub(super) fn add(&self, near: &Near, stresses: &mut [&mut [f64]]) {
        self.near.add(near, stresses);
        if near.at_surface() {
            let [fx, fy] = self.friction;
            for (k, factor) in [(2, 1.0), (4, fy), (5, fx)] {
                let tractions = stresses[k].iter_mut().zip(&self.given);
                tractions.for_each(|(stress, p)| *stress = -factor * p);
            }
        }
    }
}
