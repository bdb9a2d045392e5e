//! The report of a solve, and the force and moments that its pressure carries.

use std::ops::ControlFlow;

use ndarray::Array2;

use super::warnings::Warning;
use crate::compliance::ends::{Ends, FreeEnds};
use crate::compliance::response::Body;
use crate::contact::cascade::discretisation::Discretisation;
use crate::contact::options::Motion;
use crate::contact::plan::Plan;
use crate::contact::problem::Quality;
use crate::contact::problem::patch::rows;
use crate::contact::solver::{Solver, Termination};
use crate::error::Error;
use crate::model::grid::{Grid, Window};
use crate::model::surface::Surface;
use crate::numerics::parallel::update_with_largest;

/// Course of a solve and quality of its solution. All numbers are computed afresh at the end.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// How the iteration ended.
    pub termination: Termination,
    /// Solver that produced the solution, also where the algorithm that was asked for fell back to another.
    /// `None` where it is not known: in the reports of a running solve.
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
        let Balance { force, moment: [x, y] } = self.balance;
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
            motion: *motion,
            rolling_direction: plan.grid.rolling_direction().or_else(|| shape.rolling_direction()),
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

/// Errors of force and moments, relative to what was asked for.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Balance {
    /// |Σ p dA − W| / W; 0 where the force is not given.
    pub force: f64,
    /// |Σ p x dA − M_x| / (W × half side), along y alike; 0 where the moment is not given.
    pub moment: [f64; 2],
}

/// Force, moments and peak of a pressure.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Carried {
    pub(crate) force: f64,
    moment: [f64; 2],
    pub(crate) peak: f64,
}

impl Carried {
    /// Force, moments and peak of `pressure`, which is zero outside `window`.
    pub(crate) fn by(pressure: &Array2<f64>, window: &Window, grid: &Grid) -> Self {
        let [x, y] = [0, 1].map(|k| grid.coordinates(k).to_vec()[window[k].clone()].to_vec());
        let mut carried = Self::default();
        for (row, x) in rows(pressure, window).zip(x) {
            let ([peak], [force, moment]) =
                update_with_largest([row, &y], [], |[p, y], []| ([], [p], [p, p * y]));
            carried.force += force;
            carried.moment[0] += force * x;
            carried.moment[1] += moment;
            carried.peak = carried.peak.max(peak);
        }
        let area = grid.cell_area();
        Self { force: carried.force * area, moment: carried.moment.map(|m| m * area), ..carried }
    }

    /// Errors of force and moments against those that `motion` asks for.
    pub(crate) fn balance(&self, grid: &Grid, motion: &Motion) -> Balance {
        let scale = motion.load.unwrap_or(self.force);
        let relative = |a: f64, b: f64| if a > 0.0 && b > 0.0 { a / b } else { 0.0 };
        let half = grid.size().map(|length| 0.5 * length);
        let moment = [0, 1].map(|k| {
            let eccentricity = || Some(motion.eccentricity[k]? * motion.load.unwrap_or(0.0));
            let asked = motion.moment[k].or_else(eccentricity);
            asked.map_or(0.0, |m| relative((self.moment[k] - m).abs(), scale * half[k]))
        });
        let force = motion.load;
        Balance { force: force.map_or(0.0, |w| relative((self.force - w).abs(), w)), moment }
    }
}
