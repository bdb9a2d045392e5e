//! Algorithms that solve a contact problem, and what they have in common.

pub(super) mod active_set;
mod conjugacy;
pub(super) mod linear_cg;
pub(super) mod polonsky_keer;
pub(super) mod preconditioned;

use std::ops::ControlFlow;

pub(super) use super::options::StopCriteria;
use super::problem::Quality;

/// How an iteration ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Termination {
    /// It has not ended: the report is one of a running solve.
    Running,
    /// The tolerance was met.
    Converged,
    /// The tolerance was not met within the iterations allowed.
    IterationLimit,
    /// The caller asked to stop.
    Stopped,
}

/// Iterative solver that produced a solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Solver {
    /// Preconditioned conjugate gradients on nested grids: what
    /// [`Algorithm::Cascade`](crate::Algorithm::Cascade) starts with.
    Preconditioned,
    /// An active-set method, to which the cascade falls back on contacts of a few cells.
    ActiveSet,
    /// The conjugate gradients of Polonsky & Keer: asked for, or where the cascade broke down.
    PolonskyKeer,
}

/// The end of an iteration, with its counts.
#[derive(Debug, Clone, Copy)]
pub(super) struct Outcome {
    pub(super) solver: Solver,
    pub(super) termination: Termination,
    pub(super) iterations: usize,
    /// Work done, in the unit of `Convolution::work`.
    pub(super) work: f64,
    /// Multipliers of the loaded degrees of freedom.
    pub(super) lambda: [f64; 3],
}

impl Outcome {
    /// This outcome with what was done before: iterations and work.
    pub(super) fn after(self, iterations: usize, work: f64) -> Self {
        Self {
            iterations: iterations + self.iterations,
            work: work + self.work,
            ..self
        }
    }
}

/// Callback that gets the number of an iteration, the work done and the quality, and breaks to stop.
pub(super) type Watch<'a> = dyn FnMut(usize, f64, Quality) -> ControlFlow<()> + Send + 'a;
