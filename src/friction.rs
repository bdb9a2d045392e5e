//! Friction in the contact: partial slip, load histories and rolling.
//!
//! Tractions q keep Coulomb's law in each cell: |q| ≤ μp; no slip where |q| < μp; slip against the traction on the body
//! where |q| = μp. With the rigid motion w of the counterbody over the body, and the displacements u of the body less
//! those of the counterbody, both from the first touch on, the slip of the counterbody over the body in a step is
//!
//! ```text
//! s = Δw − Δu      u = K q + K_tz p      w = (δ_x − ω y, δ_y + ω x)
//! ```
//!
//! and in rolling at constant speed, d being the length of a cell and W the creepages,
//!
//! ```text
//! s/V = W − [u(x) − u(x + d)]/d          W = ξ e + η z × e + φ (−y, x)
//! ```
//!
//! of which `second_order` says where it holds in a cell.
//!
//! Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, Kluwer (1990), doi:10.1007/978-94-015-7889-9. Bodies are
//! half-spaces with any layers ([`crate::compliance::traction`]).
//!
//! | file | what |
//! |---|---|
//! | `step` | what is asked for |
//! | `coulomb` | Coulomb's law in cells |
//! | `second_order` | rolling to second order in the length of a cell |
//! | `newton` | tractions for a pressure: the operators of sliding and of rolling, Newton's linear systems |
//! | `tangential_problem` | sliding in one step, rolling; fields of the whole grid, and their errors |
//! | `halved` | from a solution on cells of twice the length: a start, and the discretisation error |
//! | `session` | pressure and tractions in turn |
//! | `solution` | what comes out |
//! | `creep` | Kalker's coefficients |

use std::ops::ControlFlow;

use crate::contact::{Contact, Termination};
use crate::error::Result;
use crate::model::surface::Surface;

mod coulomb;
mod creep;
mod halved;
mod newton;
mod second_order;
mod session;
mod solution;
mod step;
mod tangential_problem;

pub use creep::{CreepCoefficients, CreepWatch, creep_coefficients};
pub use session::{FrictionProgress, Last};
pub use solution::{FrictionDiscretisation, FrictionReport, FrictionSolution, TangentialMotion};
pub use step::{Friction, FrictionOptions, Move, Rolling, RollingDirection, Step};

use session::Session;

impl Contact {
    /// Presses `shape` into the body and moves it tangentially, step after step, from `last` on or from the first touch.
    /// Each step's solution says whether it converged.
    ///
    /// # Errors
    /// Bad input, bodies without layers and substrate or with free ends, a force that friction cannot carry.
    ///
    /// ```
    /// use nacre::friction::{FrictionOptions, Step};
    /// use nacre::{Contact, Elastic, Grid, Motion, Paraboloid, Setup};
    /// let steel = Elastic::new(1.0, 0.0)?;
    /// let setup = Setup::default().with_counterbody(steel);
    /// let contact = Contact::plan(steel, Grid::new([64, 64], [0.24, 0.24])?, setup)?;
    /// let load = 1e-6;
    /// let pull = Step::press(Motion::load(load), 0.3).with_force([Some(0.15 * load), None]);
    /// let solutions = contact.slide(&Paraboloid::new(1e3, 1e3)?, &[pull], &FrictionOptions::default(), None)?;
    /// // Cattaneo and Mindlin: the radius that sticks is (1 − Q/μP)^{1/3} of the contact's.
    /// let [stick, contact] = [solutions[0].stick(), solutions[0].normal.in_contact()];
    /// let count = |cells: &ndarray::Array2<bool>| cells.iter().filter(|cell| **cell).count() as f64;
    /// assert!(((count(&stick) / count(&contact)).sqrt() / 0.5_f64.cbrt() - 1.0).abs() < 0.05);
    /// # Ok::<(), nacre::Error>(())
    /// ```
    pub fn slide(
        &self,
        shape: &dyn Surface,
        steps: &[Step],
        options: &FrictionOptions,
        last: Option<&FrictionSolution>,
    ) -> Result<Vec<FrictionSolution>> {
        self.history(shape, steps.iter().map(Move::Slide), options, last)
    }

    /// Presses `shape` into the body, which rolls at constant speed.
    ///
    /// # Errors
    /// As [`Contact::slide`].
    pub fn roll(
        &self,
        shape: &dyn Surface,
        rolling: &Rolling,
        options: &FrictionOptions,
    ) -> Result<FrictionSolution> {
        let mut progress = |_: &_| ControlFlow::Continue(());
        self.friction_step(shape, Move::RollSteadily(rolling), options, None, &mut progress)
    }

    /// Rolls cell by cell from `last` on, or from the first touch, one solution for each of `rolling`.
    ///
    /// # Errors
    /// As [`Contact::slide`].
    pub fn roll_transient(
        &self,
        shape: &dyn Surface,
        rolling: &[Rolling],
        options: &FrictionOptions,
        last: Option<&FrictionSolution>,
    ) -> Result<Vec<FrictionSolution>> {
        self.history(shape, rolling.iter().map(Move::RollOneCell), options, last)
    }

    /// The move `next` after `last`. It calls `progress` with its report so far; where that breaks, the solution is
    /// unfinished, with [`Termination::Stopped`](crate::contact::Termination::Stopped), and with tractions and shift as they
    /// were before.
    ///
    /// # Errors
    /// As [`Contact::slide`].
    pub fn friction_step(
        &self,
        shape: &dyn Surface,
        next: Move,
        options: &FrictionOptions,
        last: Option<Last>,
        progress: &mut FrictionProgress,
    ) -> Result<FrictionSolution> {
        self.run(|| Session::new(self, shape, *options)?.solve(next, last, progress))
    }

    /// The moves in turn, the first one from nothing, whose errors nobody asks for: only the first one is made on coarser cells, too,
    /// to start from there. `None` where `progress` breaks.
    ///
    /// # Errors
    /// As [`Contact::slide`], and [`Error::NotConverged`](crate::Error::NotConverged).
    pub(crate) fn friction_cycle<'m>(
        &self,
        shape: &dyn Surface,
        moves: impl Iterator<Item = Move<'m>> + Send,
        options: &FrictionOptions,
        progress: &mut FrictionProgress,
    ) -> Result<Option<Vec<FrictionSolution>>> {
        self.run(|| {
            let session = Session::new(self, shape, *options)?.without_errors();
            let mut solutions: Vec<FrictionSolution> = Vec::new();
            for next in moves {
                let last = solutions.last().map(|solution| Last { solution, is_own: true });
                let solution = session.solve(next, last, progress)?;
                if solution.report.termination == Termination::Stopped {
                    return Ok(None);
                }
                solutions.push(solution.require_converged()?);
            }
            Ok(Some(solutions))
        })
    }

    fn history<'m>(
        &self,
        shape: &dyn Surface,
        moves: impl Iterator<Item = Move<'m>> + Send,
        options: &FrictionOptions,
        before: Option<&FrictionSolution>,
    ) -> Result<Vec<FrictionSolution>> {
        self.run(|| {
            let session = Session::new(self, shape, *options)?;
            let mut solutions: Vec<FrictionSolution> = Vec::new();
            for (number, next) in moves.enumerate() {
                let last = solutions
                    .last()
                    .or(before)
                    .map(|solution| Last { solution, is_own: number > 0 });
                let mut progress = |_: &_| ControlFlow::Continue(());
                solutions.push(session.solve(next, last, &mut progress)?);
            }
            Ok(solutions)
        })
    }
}
