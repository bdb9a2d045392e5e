//! Algorithms that solve a contact problem, and what they have in common.

pub(super) mod active_set;
pub(super) mod polonsky_keer;
pub(super) mod preconditioned;

use std::ops::ControlFlow;

pub(super) use super::options::StopCriteria;
use super::problem::Quality;

/// How an iteration ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "lowercase")
)]
pub enum Termination {
    /// It has not ended: the report is one of a running solve.
    #[default]
    Running,
    /// The tolerance was met.
    Converged,
    /// The tolerance was not met within the iterations allowed.
    #[cfg_attr(feature = "serde", serde(rename = "iteration limit"))]
    IterationLimit,
    /// The caller asked to stop.
    Stopped,
}

/// Iterative solver that produced a solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
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

/// The end of an iteration.
#[derive(Debug, Clone, Copy)]
pub(super) struct Outcome {
    pub(super) solver: Solver,
    pub(super) termination: Termination,
    /// Multipliers of the loaded degrees of freedom.
    pub(super) lambda: [f64; 3],
}

/// What was done so far, and the caller, who is told of each iteration and may stop it.
pub(super) struct Tally<'a> {
    /// Iterations on the grid that is being solved.
    pub(super) iterations: usize,
    /// Work on all grids, in the unit of `Convolution::work`.
    pub(super) work: f64,
    caller: &'a mut Listener<'a>,
}

/// Callback that gets the iterations, the work and the quality, and breaks to stop.
type Listener<'a> = dyn FnMut(usize, f64, Quality) -> ControlFlow<()> + Send + 'a;

impl<'a> Tally<'a> {
    /// Nothing is done yet.
    pub(super) fn new(caller: &'a mut Listener<'a>) -> Self {
        Self { iterations: 0, work: 0.0, caller }
    }

    /// Tells the caller of a pressure of this quality; a break ends the solve.
    pub(super) fn tell(&mut self, quality: Quality) -> ControlFlow<()> {
        (self.caller)(self.iterations, self.work, quality)
    }
}
