//! What is planned, and how a solution is found.

use ndarray::Array2;

use super::problem::Limits;
use crate::error::{Error, Result};
use crate::influence::Method;
use crate::response::Body;

/// What is planned beside body and grid.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Setup {
    /// The body that carries the shape; `None` is rigid.
    pub counterbody: Option<Body>,
    /// How influence coefficients are computed. Default: [`Method::Exact`].
    pub method: Method,
    /// Threads of the plan. Default: all of the machine's.
    pub threads: Option<usize>,
}

/// How a solution is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Algorithm {
    /// Preconditioned conjugate gradients on nested grids, in a window around the contact.
    #[default]
    Cascade,
    /// The constrained conjugate gradient method of the paper, as a reference.
    PolonskyKeer,
}

/// When to end an iteration, and where to start it.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Largest residual and overlap of a converged solution. Default: 1e-8.
    pub tolerance: f64,
    /// Iterations after which to give up. Default: 10 000.
    pub max_iterations: Option<usize>,
    /// Default: [`Algorithm::Cascade`].
    pub algorithm: Algorithm,
    /// Pressure to start from (nx, ny) \[Pa\]. Default: uniform.
    pub initial: Option<Array2<f64>>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tolerance: 1e-8,
            max_iterations: None,
            algorithm: Algorithm::default(),
            initial: None,
        }
    }
}

const MAX_ITERATIONS: usize = 10_000;

impl Options {
    pub(super) fn limits(&self) -> Result<Limits> {
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            return Err(Error::Parameter {
                name: "tolerance",
                requirement: "above 0 and below 1",
                value: self.tolerance,
            });
        }
        Ok(Limits {
            tolerance: self.tolerance,
            max_iterations: self.max_iterations.unwrap_or(MAX_ITERATIONS),
        })
    }
}
