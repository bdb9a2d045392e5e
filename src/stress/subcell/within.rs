//! The stress that pressure within cells adds in a given body, for a plan.

use std::ops::ControlFlow;

use super::cut::Cuts;
use super::margin::Margin;
use super::near::{Components, NearPlan, NearTable};
use super::scale::Pair;
use super::uncertainty::{LocalSteps, Uncertainty};
use crate::compliance::kernel::loads::{COMPONENTS, EXCHANGED, PressureStress, TractionStress};
use crate::compliance::kernel::plane::Kernel;
use crate::compliance::kernel::plans::Kernels;
use crate::compliance::kernel::strip;
use crate::compliance::response::interior::Place;
use crate::model::body::HalfSpace;
use crate::model::grid::{Grid, Window};
use crate::numerics::parallel::Threads;
use crate::stress::options::StressProgress;

/// A body under the pressure within the cells of a solved contact. The uniform part of the pressure is
/// left to the convolution.
#[derive(Debug)]
pub(in crate::stress) struct SubcellStress {
    kernels: Kernels,
    near: NearPlan,
    uncertainty: Uncertainty,
    /// The solver's pressure: tractions at the surface are those of it.
    given: Vec<f64>,
    /// Where the grid repeats, the pressure is reconstructed with a margin of its images.
    margin: Margin,
    /// Pressure that is taken as uniform over the cells of the grid.
    uniform: Vec<f64>,
}

impl SubcellStress {
    /// Reconstructs `pressure` within cells, for one body of a contact of the `pair`. `progress` is asked many times, with 0.
    pub(in crate::stress) fn plan(
        (body, pair): (&HalfSpace, &Pair),
        grid: &Grid,
        pressure: &[f64],
        threads: &Threads,
        progress: &mut StressProgress,
    ) -> ControlFlow<(), Self> {
        let [dx, dy] = grid.spacing();
        let side = if grid.is_line() { dy } else { dx.min(dy) };
        let edges = pair.root_law_holds(side);
        let margin = Margin::of(grid);
        let wide = margin.wide(grid);
        let pressure = &*margin.around(pressure);
        let near = NearPlan::new(pressure, &wide, edges, threads, progress)?;
        let reach = near.farthest();
        let kernels =
            threads.run(|| Kernels::new::<4, PressureStress>(body, grid, Cuts::SMALLEST, reach));
        let uncertainty = Uncertainty::new((body, pair), &wide, pressure, &near.reconstruction);
        ControlFlow::Continue(Self {
            uniform: margin.middle(&near.reconstruction.uniform),
            margin,
            kernels,
            uncertainty,
            near,
            given: pressure.to_vec(),
        })
    }

    /// Largest steps of the pressure that are felt in the cells of `window`.
    pub(in crate::stress) fn steps(&self, window: &Window) -> LocalSteps {
        self.uncertainty
            .steps(&self.given, &self.margin.window(window))
    }

    /// Estimated error \[Pa\] of the stress in `body` at `place`, from the size of the cells, where the
    /// pressure has these steps.
    pub(in crate::stress) fn uncertainty(
        &self,
        body: &HalfSpace,
        place: &Place,
        friction: [f64; 2],
        steps: LocalSteps,
    ) -> f64 {
        self.uncertainty.at(body, place, friction, steps)
    }

    /// Pressure that is taken as uniform over cells.
    pub(in crate::stress) fn uniform(&self) -> &[f64] {
        &self.uniform
    }

    /// Stresses of pieces of cells at `place`, under pressure and `friction` times it. On the threads of
    /// the caller.
    pub(in crate::stress) fn table(&self, place: &Place, friction: [f64; 2]) -> NearTable {
        if !self.near.reaches(place.depth) {
            return NearTable::default();
        }
        let [fx, fy] = friction;
        let none = [0.0; COMPONENTS];
        let sum = |normal: [f64; COMPONENTS], x: [f64; COMPONENTS], y: [f64; COMPONENTS]| {
            std::array::from_fn(|k| normal[k] + fx * x[k] + fy * y[k])
        };
        match &self.kernels {
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
                let lateral = slides.then(|| {
                    let traction = traction.get_or_init(|| plan.multipliers::<6, TractionStress>());
                    Kernel::new::<TractionStress>(plan, traction, place)
                });
                self.near
                    .table(place.depth, |[x, y], [a, b]| -> Components {
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

    /// Adds the stresses of a table to those of the uniform part, one plane of each component; at the
    /// surface, sets the tractions to those of the solver's pressure. On the threads of the caller.
    pub(in crate::stress) fn add(
        &self,
        near: &NearTable,
        friction: [f64; 2],
        stresses: &mut [&mut [f64]],
    ) {
        self.margin
            .add(stresses, |stresses| self.near.add(near, stresses));
        if near.at_surface() {
            let given = self.margin.middle(&self.given);
            for (k, factor) in tractions(friction) {
                let tractions = stresses[k].iter_mut().zip(&given);
                tractions.for_each(|(stress, p)| *stress = -factor * p);
            }
        }
    }

    /// What [`SubcellStress::add`] does, for the `stresses` of one cell.
    pub(in crate::stress) fn add_at(
        &self,
        near: &NearTable,
        friction: [f64; 2],
        cell: [usize; 2],
        stresses: &mut [f64],
    ) {
        let cell = self.margin.cell(cell);
        let added = self.near.sum_at(near, cell);
        stresses.iter_mut().zip(added).for_each(|(s, d)| *s += d);
        if near.at_surface() {
            let p = self.given[self.near.number(cell)];
            for (k, factor) in tractions(friction) {
                stresses[k] = -factor * p;
            }
        }
    }
}

/// Components of the traction at the surface, σ_zz, σ_yz and σ_xz, and their ratios to minus the pressure.
fn tractions([fx, fy]: [f64; 2]) -> [(usize, f64); 3] {
    [(2, 1.0), (4, fy), (5, fx)]
}
