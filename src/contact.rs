//! The contact problem: g = h + u − δ − s_x x − s_y y ≥ 0, p ≥ 0, p g = 0.

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::compliance::convolution::Convolution;
use crate::compliance::response::Body;
use crate::compliance::traction::Tangential;
use crate::error::Result;
use crate::model::grid::Grid;
use crate::model::surface::Surface;

mod automatic;
mod batch;
mod cascade;
mod driver;
mod options;
mod plan;
mod problem;
mod solution;
mod solver;
mod start;

pub use automatic::{choose_grid, solve, solve_watched};
pub use batch::Case;
pub use cascade::discretisation::Discretisation;
pub use options::{Algorithm, Motion, Options, Setup};
pub use problem::bounds::Hardness;
pub(crate) use problem::freedoms::OVERFLOW;
pub(crate) use problem::patch::{block, bounds};
pub(crate) use solution::tangent::Tangent;
pub use solution::warnings::Warning;
pub use solution::{Balance, Progress, Report, Solution};

pub use solver::{Solver, Termination};

use plan::Plan;
use start::Sampled;

/// A body on a grid, planned once: influence coefficients and their transform.
///
/// A plan and a solve take up to 170 bytes a cell, with a hardness 210; a grid that does not fit into memory is refused
/// before it starts. Between solves a plan keeps the memory that they worked in: up to 130 bytes a cell.
///
/// ```
/// use nacre::{Contact, Elastic, Grid, Motion, Options, Paraboloid, Setup};
///
/// // Hertz: δ = (9 W² / 16 R E*²)^{1/3}
/// let contact = Contact::plan(Elastic::new(1.0, 0.0)?, Grid::new([64, 64], [4.0, 4.0])?, Setup::default())?;
/// let solution = contact.solve(&Paraboloid::new(1e3, 1e3)?, &Motion::load(1e-3), &Options::default())?;
/// let hertz = (9.0 * 1e-6 / (16.0 * 1e3_f64)).powf(1.0 / 3.0);
/// assert!((solution.approach / hertz - 1.0).abs() < 2e-3);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug)]
pub struct Contact(Plan);

impl Contact {
    /// Plans contacts of `body` on `grid`.
    ///
    /// # Errors
    /// A method that does not suit the grid, no threads, or too little memory.
    pub fn plan(body: impl Into<Body>, grid: Grid, setup: Setup) -> Result<Self> {
        Ok(Self(Plan::new(body.into(), grid, setup)?))
    }

    /// The body that shapes are pressed into.
    pub fn body(&self) -> &Body {
        &self.0.body
    }

    /// The setup that was planned: counterbody, method and threads.
    pub fn setup(&self) -> &Setup {
        &self.0.setup
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.0.grid
    }

    /// The convolution with the influence coefficients of both bodies together. In a line contact whose
    /// coefficients are not positive definite with the datum of [`Grid::line`], it has a farther datum, which
    /// raises the displacement everywhere by the same; solutions have the datum of the grid.
    pub fn convolution(&self) -> &Convolution {
        &self.0.convolution
    }

    /// The operators of tractions, made when they are first needed.
    ///
    /// # Errors
    /// Bodies without layers and substrate, and such with free ends.
    pub(crate) fn tangential(&self) -> Result<Arc<Tangential>> {
        self.0.tangential()
    }

    /// Calls `work` on the plan's threads.
    pub(crate) fn run<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        self.0.run(work)
    }

    /// Presses `shape` into the body. The solution says whether it converged.
    ///
    /// # Errors
    /// Bad input only.
    pub fn solve(
        &self,
        shape: &dyn Surface,
        motion: &Motion,
        options: &Options,
    ) -> Result<Solution> {
        self.solve_watched(shape, motion, options, &mut |_| ControlFlow::Continue(()))
    }

    /// [`Contact::solve`] that calls `progress` with each iteration; its break ends the solve with
    /// [`Termination::Stopped`].
    ///
    /// # Errors
    /// Bad input only.
    pub fn solve_watched(
        &self,
        shape: &dyn Surface,
        motion: &Motion,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Solution> {
        let (plan, sampled) = (&self.0, &mut Sampled::default());
        plan.run(|| plan.solve(shape, sampled, motion, options, progress))
    }

    /// Solves many cases side by side, each on one of the plan's threads, or on several where there
    /// are fewer cases than threads. Solutions come in the order of the cases, and equal those of
    /// [`Contact::solve`] to the bit. Under a load, successive cases of one shape (at one address) share
    /// its undeformed gap.
    ///
    /// `progress` gets the number of finished cases, on the calling thread, every 20 ms and at the
    /// end. Its break stops the rest: cases that are not finished are `None`.
    ///
    /// # Errors
    /// Too little memory. An error of one case is that case's own result.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// use nacre::{Case, Contact, Elastic, Grid, Motion, Options, Paraboloid, Setup};
    ///
    /// let contact = Contact::plan(Elastic::new(1.0, 0.0)?, Grid::new([64, 64], [4.0, 4.0])?, Setup::default())?;
    /// let shape = Paraboloid::new(1e3, 1e3)?;
    /// let cases = [1e-3, 8e-3].map(|load| Case { shape: &shape, motion: Motion::load(load) });
    /// let solved = contact.solve_many(&cases, &Options::default(), &mut |_| ControlFlow::Continue(()))?;
    /// // Hertz: δ grows as W^{2/3}
    /// let approach: Vec<f64> = solved.into_iter().flatten().map(|s| Ok(s?.approach)).collect::<nacre::Result<_>>()?;
    /// assert!((approach[1] / approach[0] / 4.0 - 1.0).abs() < 1e-3);
    /// # Ok::<(), nacre::Error>(())
    /// ```
    pub fn solve_many(
        &self,
        cases: &[Case],
        options: &Options,
        progress: &mut dyn FnMut(usize) -> ControlFlow<()>,
    ) -> Result<Vec<Option<Result<Solution>>>> {
        batch::solve_many(&self.0, cases, options, progress)
    }

    /// [`Contact::solve_many`] that hands over each solution, so that not all of them need be kept.
    ///
    /// `take` gets the number of a case and its solution as soon as it is finished, on the thread
    /// that solved it. `ask` is called on the calling thread, every 20 ms and at the end; its break
    /// stops the rest, which are not handed over.
    ///
    /// # Errors
    /// Too little memory for the cases that are solved at once. An error of one case is that case's own
    /// result.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// use std::sync::Mutex;
    /// use nacre::{Case, Contact, Elastic, Grid, Motion, Options, Paraboloid, Setup};
    ///
    /// let contact = Contact::plan(Elastic::new(1.0, 0.0)?, Grid::new([64, 64], [4.0, 4.0])?, Setup::default())?;
    /// let shape = Paraboloid::new(1e3, 1e3)?;
    /// let cases = [1e-3, 2e-3, 8e-3].map(|load| Case { shape: &shape, motion: Motion::load(load) });
    /// let peak = Mutex::new(0.0_f64);
    /// let take = |_, solved: nacre::Result<nacre::Solution>| {
    ///     if let (Ok(solution), Ok(mut peak)) = (solved, peak.lock()) {
    ///         *peak = peak.max(solution.peak_pressure());
    ///     }
    /// };
    /// contact.solve_each(&cases, &Options::default(), &take, &mut || ControlFlow::Continue(()))?;
    /// // Hertz: p0 = (6 W E*² / π³ R²)^{1/3}
    /// let hertz = (6.0 * 8e-3 / std::f64::consts::PI.powi(3) / 1e6).powf(1.0 / 3.0);
    /// assert!((peak.into_inner().unwrap_or(0.0) / hertz - 1.0).abs() < 0.01);
    /// # Ok::<(), nacre::Error>(())
    /// ```
    pub fn solve_each(
        &self,
        cases: &[Case],
        options: &Options,
        take: &(dyn Fn(usize, Result<Solution>) + Sync),
        ask: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Result<()> {
        batch::solve_each(&self.0, cases, options, take, ask)
    }

    /// An error where there is too little memory to solve `cases` and to keep all solutions.
    #[cfg(feature = "python")]
    pub(crate) fn check_memory_for(&self, cases: &[Case]) -> Result<()> {
        batch::check_memory_for(&self.0, cases)
    }
}
