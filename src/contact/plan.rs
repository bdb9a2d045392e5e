//! A body on a grid, planned: coefficients, their transform, and the coarser grids.

use std::sync::Arc;

use ndarray::Array2;

use super::cascade::levels::Levels;
use super::options::Setup;
use crate::convolution::Convolution;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::coefficients_on;
use crate::parallel::{Threads, check_memory};
use crate::response::Body;

/// Arrays of a solve, as many as there are on one cell at the same time. Measured: 135 bytes a cell in all
/// where the contact fills the grid, 151 where it tilts as well, 67 where it fills a ninth.
const ARRAYS: u64 = 18;

/// What all solves on one grid share.
#[derive(Debug)]
pub(super) struct Plan {
    pub(super) body: Body,
    pub(super) grid: Grid,
    pub(super) setup: Setup,
    pub(super) convolution: Convolution,
    pub(super) levels: Levels,
}

impl Plan {
    pub(super) fn new(body: Body, grid: Grid, setup: Setup) -> Result<Self> {
        check_memory(grid.shape(), Self::memory(&grid))?;
        let threads = Arc::new(Threads::new(setup.threads)?);
        let coefficients = |grid: &Grid| total_coefficients(&body, &setup, grid, &threads);
        let finest = coefficients(&grid)?;
        let convolution = Convolution::plan_on(&finest, Arc::clone(&threads))?;
        let levels = Levels::plan(grid, finest, &convolution, coefficients)?;
        Ok(Self {
            body,
            grid,
            setup,
            convolution,
            levels,
        })
    }

    /// This plan on other threads; all large arrays are shared.
    pub(super) fn on_threads(&self, threads: &Arc<Threads>) -> Self {
        let convolution = self.convolution.on_threads(threads);
        Self {
            body: self.body.clone(),
            grid: self.grid,
            setup: self.setup.clone(),
            levels: self.levels.beside(&convolution),
            convolution,
        }
    }

    /// Calls `work`, a whole solve, on the plan's threads.
    pub(super) fn run<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        let [nx, ny] = self.grid.shape();
        self.convolution.own_threads().run_inside(nx * ny, work)
    }

    /// Bytes that a plan with its coefficients, and the arrays of one solve take.
    pub(super) fn memory(grid: &Grid) -> u64 {
        let [nx, ny] = grid.shape();
        Convolution::memory(grid.shape()) + (nx as u64 * ny as u64) * 8 * ARRAYS
    }
}

/// Influence coefficients of body and counterbody together.
pub(super) fn total_coefficients(
    body: &Body,
    setup: &Setup,
    grid: &Grid,
    threads: &Threads,
) -> Result<Array2<f64>> {
    let mut coefficients = coefficients_on(&**body, grid, setup.method, threads)?;
    if let Some(counterbody) = &setup.counterbody {
        coefficients += &coefficients_on(&**counterbody, grid, setup.method, threads)?;
    }
    Ok(coefficients)
}
