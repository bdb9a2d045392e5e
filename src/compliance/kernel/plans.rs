//! Plans of a body's kernels under pressure and traction, for cells or for strips.

use std::sync::OnceLock;

use super::loads::Load;
use super::mesh::Multipliers;
use super::plane::Plan;
use super::strip::LinePlan;
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;

/// Plans of cells, or of strips of line contact.
#[derive(Debug)]
pub(crate) enum Kernels {
    Plane {
        plan: Box<Plan>,
        pressure: Vec<Multipliers>,
        /// Multipliers of the traction, made at the first place with friction.
        traction: OnceLock<Vec<Multipliers>>,
    },
    Line(LinePlan),
}

impl Kernels {
    /// Plans the load P on pieces down to `finest` of a cell, at offsets up to `reach`. It runs on the threads
    /// of the caller.
    pub(crate) fn new<const N: usize, P: Load<N>>(
        body: &HalfSpace,
        grid: &Grid,
        finest: f64,
        reach: f64,
    ) -> Self {
        if grid.is_line() {
            return Self::Line(LinePlan::new(body, grid, finest));
        }
        Self::of_cells::<N, P>(body, grid.spacing(), finest, reach)
    }

    /// [`Kernels::new`] for cells of sides `spacing`.
    pub(crate) fn of_cells<const N: usize, P: Load<N>>(
        body: &HalfSpace,
        spacing: [f64; 2],
        finest: f64,
        reach: f64,
    ) -> Self {
        let plan = Plan::new(body, spacing, finest, reach);
        Self::Plane {
            pressure: plan.multipliers::<N, P>(),
            traction: OnceLock::new(),
            plan: Box::new(plan),
        }
    }
}
