//! Options of a plan and of a solve.

use ndarray::Array2;

use super::hardness::Hardness;
use crate::compliance::influence::Method;
use crate::compliance::response::Body;
use crate::error::{Error, Result};

/// Options of a plan, beside body and grid.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Setup {
    /// Body that carries the shape; `None` is rigid.
    pub counterbody: Option<Body>,
    /// Method by which influence coefficients are computed. Default: [`Method::Exact`].
    pub method: Method,
    /// Threads of the plan. Default: all of the machine's.
    pub threads: Option<usize>,
}

/// Algorithm that a solve starts with; [`Report::solver`](super::Report::solver) says which one ended it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Algorithm {
    /// Preconditioned conjugate gradients on nested grids, in a window around the contact.
    #[default]
    Cascade,
    /// The constrained conjugate gradients of Polonsky & Keer, which Spinu et al. use, as a reference.
    PolonskyKeer,
}

/// Options of a solve: where it starts and when it ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Largest residual and overlap of a converged solution. Default: 1e-8.
    pub tolerance: f64,
    /// Iterations after which to give up. Default: 10 000.
    pub max_iterations: Option<usize>,
    /// Algorithm that the solve starts with. Default: [`Algorithm::Cascade`].
    pub algorithm: Algorithm,
    /// Pressure to start from (nx, ny) \[Pa\]. Default: uniform.
    pub initial: Option<Array2<f64>>,
    /// Largest pressure that the surfaces bear. Default: they do not yield.
    pub hardness: Option<Hardness>,
    /// Permanent indentation (nx, ny) \[m\] that the surfaces have already: that of the solution before, in a
    /// history of loads. Default: none.
    pub indentation: Option<Array2<f64>>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tolerance: 1e-8,
            max_iterations: None,
            algorithm: Algorithm::default(),
            initial: None,
            hardness: None,
            indentation: None,
        }
    }
}

/// Default of [`Options::max_iterations`]: far above the 10 … 300 that solvable problems take.
const MAX_ITERATIONS: usize = 10_000;

impl Options {
    /// The criteria that end an iteration, checked.
    pub(super) fn stop_criteria(&self) -> Result<StopCriteria> {
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            return Err(Error::Parameter {
                name: "tolerance",
                requirement: "above 0 and below 1",
                value: self.tolerance,
            });
        }
        Ok(StopCriteria {
            tolerance: self.tolerance,
            max_iterations: self.max_iterations.unwrap_or(MAX_ITERATIONS),
        })
    }
}

/// Conditions that end an iteration.
#[derive(Debug, Clone, Copy)]
pub(super) struct StopCriteria {
    pub(super) tolerance: f64,
    pub(super) max_iterations: usize,
}
