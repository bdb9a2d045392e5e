//! The report of a solve.

use std::ops::ControlFlow;

use super::carried::Balance;
use super::warnings::Warning;
use crate::compliance::ends::{Ends, FreeEnds};
use crate::compliance::influence::Method;
use crate::compliance::response::Body;
use crate::contact::cascade::discretisation::Discretisation;
use crate::contact::motion::Motion;
use crate::contact::plan::Plan;
use crate::contact::problem::Quality;
use crate::contact::solver::{Solver, Termination};
use crate::error::Error;
use crate::model::grid::Grid;
use crate::model::surface::Surface;

/// Course of a solve and quality of its solution. All numbers are computed afresh at the end.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// How the iteration ended.
    pub termination: Termination,
    /// Solver that produced the solution, also where the algorithm that was asked for fell back to another.
    /// `None` where it is not known: in the reports of a running solve, and in files of format 0.
    pub solver: Option<Solver>,
    /// Iterations done.
    pub iterations: usize,
    /// Work done, in convolutions of the whole grid. Convolutions of coarser grids, of windows and of the
    /// preconditioner count by the points P of their meshes, as P log P.
    pub convolutions: f64,
    /// Complementarity: Σ p|g| / Σ p u over the cells that can touch; 0 when p = 0. Where Σ p u contains a far
    /// displacement that moves the whole contact, as that of a soft substrate below a hard coat, Σ p u₀
    /// takes its place: u₀ is 10 times the displacement that a wave of the mean pressure, 2πa long, causes,
    /// where πa² is the contact area (2a the width of a line contact).
    pub residual: f64,
    /// max(−g, 0) / max u over the cells that can touch; relative to u₀ as above where that is less.
    pub overlap: f64,
    /// Errors of force and moments.
    pub balance: Balance,
    /// Discretisation errors, estimated from coarser grids. `None` where no coarser grid was solved: on
    /// small grids, from a given pressure, by another algorithm, where surfaces yield, or without convergence.
    pub discretisation: Option<Discretisation>,
    /// Warnings: what the user should know.
    pub warnings: Vec<Warning>,
    /// The grid.
    pub grid: Grid,
    /// The body that the shape was pressed into.
    pub body: Body,
    /// The body that carries the shape; rigid where `None`.
    pub counterbody: Option<Body>,
    /// How the influence coefficients were computed.
    pub method: Method,
    /// Load or approach and tilts that were asked for.
    pub motion: Motion,
    /// Unit vector along which the shape rolls, and friction acts where no other direction is given: y in
    /// line contact. `None` where the shape has no such direction, or it is not known, as in files of
    /// earlier versions.
    pub rolling_direction: Option<[f64; 2]>,
    /// The tolerance that was asked for.
    pub tolerance: f64,
    /// Seconds that the solve took, without planning.
    pub seconds: f64,
}

impl Report {
    /// Whether the tolerance was met.
    pub fn converged(&self) -> bool {
        self.termination == Termination::Converged
    }

    /// How free ends of the bodies are counted; `None` where there are none.
    pub fn free_ends(&self) -> Option<FreeEnds> {
        let bodies = std::iter::once(&self.body).chain(&self.counterbody);
        Ends::of(&bodies.collect::<Vec<_>>()).form(self.grid.size()[1])
    }

    /// The error that says which conditions of convergence were not met; the message quotes `tolerance`.
    pub(crate) fn not_converged(&self, tolerance: f64) -> Error {
        let Balance {
            force,
            moment: [x, y],
        } = self.balance;
        Error::NotConverged {
            iterations: self.iterations,
            residual: self.residual,
            overlap: self.overlap,
            balance: force.max(x).max(y),
            tolerance,
            limit: "max_iterations",
        }
    }

    /// A report with nothing iterated yet.
    pub(in crate::contact) fn planned(
        plan: &Plan,
        shape: &dyn Surface,
        motion: &Motion,
        tolerance: f64,
    ) -> Self {
        Self {
            termination: Termination::Running,
            solver: None,
            iterations: 0,
            convolutions: 0.0,
            residual: 0.0,
            overlap: 0.0,
            balance: Balance::default(),
            discretisation: None,
            warnings: Vec::new(),
            grid: plan.grid,
            body: plan.body.clone(),
            counterbody: plan.setup.counterbody.clone(),
            method: plan.setup.method,
            motion: *motion,
            rolling_direction: plan
                .grid
                .rolling_direction()
                .or_else(|| shape.rolling_direction()),
            tolerance,
            seconds: 0.0,
        }
    }

    /// Counts work and quality so far.
    pub(in crate::contact) fn count(
        &mut self,
        iterations: usize,
        convolutions: f64,
        quality: Quality,
    ) {
        self.iterations = iterations;
        self.convolutions = convolutions;
        self.residual = quality.residual;
        self.overlap = quality.overlap;
    }
}

/// Callback that gets the report of each iteration and breaks to stop. It may be called on one of the
/// plan's threads.
pub type Progress<'a> = dyn FnMut(&Report) -> ControlFlow<()> + Send + 'a;
