//! The contact problem: g = h + u − δ − s_x x − s_y y ≥ 0, p ≥ 0, p g = 0.

mod automatic;
mod batch;
mod between_stations;
mod cascade;
mod driver;
mod ends;
mod options;
mod plan;
mod problem;
mod solution;
mod solver;
mod start;

pub use automatic::{choose_grid, solve, solve_with};
pub use batch::Case;
pub use cascade::discretisation::Discretisation;
pub(crate) use cascade::discretisation::{chance_error, outline_error};
pub use driver::WatchedSolve;
#[cfg(feature = "python")]
pub(crate) use options::SMALLEST_GRID;
pub use options::{Algorithm, Motion, Options, Setup};
pub use plan::Contact;
pub use problem::bounds::Hardness;
pub(crate) use problem::patch::{block, bounds, enclosing};
pub use problem::springs::Compliance;
pub(crate) use solution::tangent::Tangent;
pub use solution::warnings::{Unestimated, Warning};
pub use solution::{Balance, Progress, Report, Solution};
pub use solver::{Solver, Termination};

pub use crate::numerics::linear_cg::Watch;
