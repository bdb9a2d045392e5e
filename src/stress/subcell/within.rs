//! Stresses of what the pressure of a solved contact is within its cells.

use super::near::{NearPlan, NearTable, STRESSES};
use crate::body::HalfSpace;
use crate::grid::Grid;
use crate::kernel::loads::{COMPONENTS, EXCHANGED, PressureStress, TractionStress};
use crate::kernel::plane::Kernel;
use crate::kernel::plans::Kernels;
use crate::kernel::strip;
use crate::parallel::Threads;
use crate::response::interior::Place;

/// A body under the pressure of a contact and its friction, of which only what is within cells is
/// looked at.
#[derive(Debug)]
pub(in crate::stress) struct Within {
    kind: Kernels,
    near: NearPlan,
    friction: [f64; 2],
    /// The cells' pressure: the tractions at the surface are of that.
    given: Vec<f64>,
}

/// Sides of the smallest pieces, in cells.
const FINEST: f64 = 1.0 / 135.0;

impl Within {
    /// None where `go_on` stops it.
    pub(in crate::stress) fn new(
        body: &HalfSpace,
        grid: &Grid,
        pressure: &[f64],
        friction: [f64; 2],
        threads: &Threads,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Option<Self> {
        let near = NearPlan::new(pressure, grid, threads, go_on)?;
        let (reach, slides) = (near.farthest(), friction != [0.0, 0.0]);
        let kind = threads.run(|| {
            Kernels::new::<4, 6, PressureStress, TractionStress>(body, grid, FINEST, reach, slides)
        });
        Some(Self {
            kind,
            near,
            friction,
            given: pressure.to_vec(),
        })
    }

    /// What is to be taken as uniform over cells.
    pub(in crate::stress) fn uniform(&self) -> &[f64] {
        &self.near.reconstruction.uniform
    }

    /// Stresses of pieces of cells at `place`, where they are felt. On the threads of the caller.
    pub(in crate::stress) fn at(&self, place: &Place) -> NearTable {
        if !self.near.reaches(place.depth) {
            return NearTable::default();
        }
        let [fx, fy] = self.friction;
        let none = [0.0; COMPONENTS];
        let sum = |normal: [f64; COMPONENTS], x: [f64; COMPONENTS], y: [f64; COMPONENTS]| {
            let stress = |k: usize| normal[k] + fx * x[k] + fy * y[k];
            std::array::from_fn::<f64, STRESSES, _>(stress)
        };
        match &self.kind {
            Kernels::Line(plan) => {
                let normal = plan.strips::<6, strip::Pressure>(place);
                let along = (fx != 0.0).then(|| plan.strips::<3, strip::Along>(place));
                let across = (fy != 0.0).then(|| plan.strips::<6, strip::Across>(place));
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
                    let stresses = |at, half| lateral.at::<TractionStress>(at, half);
                    let along = (fx != 0.0).then(|| stresses([x, y], [a, b]));
                    // Traction along y is traction along x with both exchanged.
                    let across = (fy != 0.0).then(|| stresses([y, x], [b, a]));
                    let across = across.map(|values| EXCHANGED.map(|k| values[k]));
                    sum(pressed, along.unwrap_or(none), across.unwrap_or(none))
                })
            }
        }
    }

    /// Adds them to the stresses of the uniform pressure on a plane. On the threads of the caller.
    pub(in crate::stress) fn add(&self, near: &NearTable, stresses: &mut [&mut [f64]]) {
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
