//! Plans of a body's kernels under pressure and traction, for cells or for strips.

use super::loads::Load;
use super::mesh::Multipliers;
use super::plane::Plan;
use super::strip::LinePlan;
use crate::body::HalfSpace;
use crate::grid::Grid;

/// Plans of cells, or of strips of line contact.
#[derive(Debug)]
pub(crate) enum Kernels {
    Plane {
        plan: Box<Plan>,
        pressure: Vec<Multipliers>,
        /// Multipliers of traction; empty without friction.
        traction: Vec<Multipliers>,
    },
    Line(LinePlan),
}

impl Kernels {
    /// Plans loads P and T (where the body `slides`) on pieces down to `finest` of a cell, at offsets up
    /// to `reach`. On the threads of the caller.
    pub(crate) fn new<const N: usize, const M: usize, P: Load<N>, T: Load<M>>(
        body: &HalfSpace,
        grid: &Grid,
        finest: f64,
        reach: f64,
        slides: bool,
    ) -> Self {
        if grid.is_line() {
            return Self::Line(LinePlan::new(body, grid, finest));
        }
        let plan = Plan::new(body, grid.spacing(), finest, reach);
        Self::Plane {
            pressure: plan.multipliers::<N, P>(),
            traction: if slides {
                plan.multipliers::<M, T>()
            } else {
                Vec::new()
            },
            plan: Box::new(plan),
        }
    }
}
