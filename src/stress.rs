//! Stress and displacement below the surface, under the pressure of a contact and its friction.
//!
//! ```text
//! σ[i, j] = Σ_kl K[i−k, j−l; z] p[k, l]
//! ```
//!
//! K are influence coefficients at depth z, without aliasing: closed forms of a half-space of the
//! material at that depth, and exact transforms of what the layers add. Both fall off as in an
//! infinite body: a larger domain changes nothing, and the error does not depend on how deep or how
//! thick a layer is. It is below 1e-8 of the pressure (`tests/stress/closed_forms.rs`). The sum is one
//! discrete convolution for each component: Liu, Wang & Liu, Wear 243 (2000) 101,
//! doi:10.1016/S0043-1648(00)00427-0.
//!
//! The remaining error comes from how pressure is distributed within a cell. [`stress`] takes it as
//! uniform. For a solved contact, [`Solution::stress`](crate::Solution::stress) reconstructs it
//! (`stress/subcell.rs`): parabolic in the interior, with a square-root profile near a smooth edge,
//! and uniform where the edge is not known. Tractions at the surface stay those of the solution's
//! pressure, and displacements are those of uniform cells.
//!
//! The reconstruction, the transforms and the spectrum of the layered body depend on the body and the
//! pressure alone. A [`StressPlan`] makes them once; it is then evaluated for any depths, sections,
//! friction and residual stress. The functions here and those of `Solution` make a plan for one call.
//!
//! Friction adds the traction q = μ p along a direction; its effect on the pressure is neglected. That
//! is exact where both bodies have the same elastic constants or ν = ½, and a good approximation for
//! small μ: the neglected coupling changes the pressure by the order of μ (1 − 2ν)/(2 − 2ν). See
//! Johnson, Contact Mechanics (1985), chapter 7, doi:10.1017/CBO9781139171731.

use ndarray::{Array2, ArrayRef2};

use crate::compliance::response::Body;
use crate::contact::Solution;
use crate::error::{Error, Result};
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;

mod ends;
mod field;
mod half_space;
mod options;
mod outside_grid;
mod outside_patch;
mod plan;
mod refined;
mod section;
mod subcell;
mod summary;

pub(crate) use field::Tensor;
pub use field::{Peak, Stress};
pub use options::{Section, Side, StressOptions, StressProgress, WatchedStress};
pub use plan::StressPlan;
pub(crate) use plan::Weights;
pub use summary::{InterfaceSummary, LayerSummary, Strengths, StressSummary};

use options::SlidingSense;
use plan::{PressureSource, stress_once};
use refined::refined_summary;
use subcell::BodyPair;
use summary::summary_once;

/// Stress of `body` at `depths` under `pressure` (nx, ny) \[Pa\] on `grid`, uniform over each cell.
///
/// For a solved contact, [`Solution::stress`](crate::Solution::stress) also reconstructs the pressure
/// within cells. To evaluate one pressure several times, make a [`StressPlan`]. A callback of
/// [`StressOptions::watched`] is told the fraction done; when it breaks, the result holds the depths finished so far.
///
/// # Errors
/// Bad input, or too little memory.
///
/// ```
/// use ndarray::array;
/// use nacre::{Elastic, Grid, StressOptions, stress};
/// // Under the middle of a uniformly loaded square of side 2: Love (1929), doi:10.1098/rsta.1929.0006.
/// let grid = Grid::new([2, 2], [2.0, 2.0])?;
/// let pressure = array![[1.0, 1.0], [1.0, 1.0]];
/// let options = StressOptions::default().with_section(nacre::Section::Y(0.0));
/// let field = stress(&Elastic::new(1.0, 0.3)?.into(), &grid, &pressure, &[0.0, 1.0], &options)?;
/// assert!((field.zz()[[0, 0, 0]] + 1.0).abs() < 1e-12);
/// assert!(field.zz()[[1, 0, 0]] > -0.7);
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn stress<'a>(
    body: &HalfSpace,
    grid: &Grid,
    pressure: &ArrayRef2<f64>,
    depths: &[f64],
    options: impl Into<WatchedStress<'a>>,
) -> Result<Stress> {
    stress_once(&PressureSource::uniform(body, grid, pressure), depths, options.into())
}

/// One of the two bodies of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "lowercase")
)]
pub enum Member {
    /// The body that the shape is pressed into.
    #[default]
    Body,
    /// The body that carries the shape. z points into it; x and y are those of the contact.
    Counterbody,
}

impl Solution {
    /// Stress at `depths` in one of the bodies. The direction of friction is that of the traction on the
    /// body; the counterbody gets the opposite. Without a direction, friction acts along the direction in
    /// which the shape rolls.
    ///
    /// The pressure is reconstructed within cells, with a square-root profile near a smooth edge;
    /// [`stress`](crate::stress()) takes it as uniform over each cell. To evaluate a solution several
    /// times, make its [`StressPlan`] with [`Solution::stress_plan`]. A callback of [`StressOptions::watched`]
    /// is told the fraction done, 0 while planning; when it breaks, the result holds the depths finished so far.
    ///
    /// # Errors
    /// Bad input, a counterbody that is rigid, friction without a direction on a shape that has none, too
    /// little memory.
    ///
    /// ```
    /// use nacre::{Elastic, Member, Motion, Sphere, StressOptions, solve};
    /// let steel = Elastic::new(210e9, 0.3)?;
    /// let solution = solve(&Sphere::new(5e-3)?, &steel, &Motion::load(10.0))?;
    /// let a = (0.75 * 10.0 * 5e-3 / steel.plane_strain_modulus()).cbrt();
    /// let field = solution.stress(&[0.48 * a], Member::Body, &StressOptions::default())?;
    /// let shear = field.max_shear().fold(0.0_f64, |m, s| m.max(*s));
    /// assert!((shear / solution.peak_pressure() / 0.31 - 1.0).abs() < 5e-3);
    /// # Ok::<(), nacre::Error>(())
    /// ```
    pub fn stress<'a>(
        &self,
        depths: &[f64],
        member: Member,
        options: impl Into<WatchedStress<'a>>,
    ) -> Result<Stress> {
        stress_once(&self.source(member)?, depths, options.into())
    }

    /// Peaks in each layer and tractions at each interface of one of the bodies, compared with
    /// `strengths`; see [`StressPlan::summary`]. The pressure is that of [`Solution::stress`]. With
    /// [`StressOptions::refine`], extremes that are more uncertain are found on finer cells around them.
    ///
    /// # Errors
    /// As [`Solution::stress`], and a strength that is not finite and above 0. With `refine`, one that is not between 0 and
    /// 1, a periodic grid, a surface that has yielded, given coefficients, and a patch that does not converge.
    pub fn stress_summary<'a>(
        &self,
        member: Member,
        strengths: &Strengths,
        options: impl Into<WatchedStress<'a>>,
    ) -> Result<StressSummary> {
        let watched_options = options.into();
        match watched_options.options().refine {
            Some(target) => {
                refined_summary(self, self.source(member)?, strengths, target, watched_options)
            }
            None => summary_once(&self.source(member)?, strengths, watched_options),
        }
    }

    /// A plan of the stress in one of the bodies, evaluated any number of times without planning again. The pressure is
    /// that of [`Solution::stress`], and the plan does not borrow the solution. Of the options, only `threads` is used. A
    /// callback of [`StressOptions::watched`] is told 0 while planning.
    ///
    /// # Errors
    /// A counterbody that is rigid, no threads, too little memory, or a callback that breaks.
    pub fn stress_plan<'a>(
        &self,
        member: Member,
        options: impl Into<WatchedStress<'a>>,
    ) -> Result<StressPlan> {
        self.source(member)?.planned(options.into())
    }

    /// A plan of the stress under the pressure and the `tractions` (q_x, q_y) on the body; on the counterbody, their
    /// opposites act. They are uniform over each cell.
    ///
    /// # Errors
    /// As [`Solution::stress_plan`], and tractions of another shape than the grid's.
    pub(crate) fn stress_plan_with(
        &self,
        member: Member,
        tractions: [&Array2<f64>; 2],
        watched_options: WatchedStress,
    ) -> Result<StressPlan> {
        let mut source = self.source(member)?;
        source.sliding.is_known = true;
        source.tractions = Some(tractions.map(|traction| &**traction));
        source.planned(watched_options)
    }

    /// A plan of the stress in `body`, which stands for one of the bodies, under `pressure` that is uniform over each
    /// cell.
    ///
    /// # Errors
    /// As [`Solution::stress_plan`].
    pub(crate) fn uniform_stress_plan(
        &self,
        member: Member,
        body: &HalfSpace,
        pressure: &Array2<f64>,
    ) -> Result<StressPlan> {
        let source = PressureSource { body, pressure, solved: None, ..self.source(member)? };
        source.planned((&StressOptions::default()).into())
    }

    /// The layers of one of the bodies.
    ///
    /// # Errors
    /// A rigid counterbody, or a body that is known by its normal response alone.
    pub fn member(&self, member: Member) -> Result<&HalfSpace> {
        match (member, &self.report.counterbody) {
            (Member::Body, _) => layered(&self.report.body),
            (Member::Counterbody, Some(counterbody)) => layered(counterbody),
            (Member::Counterbody, None) => {
                Err(Error::Inconsistent("body must be \"body\" where the counterbody is rigid"))
            }
        }
    }

    /// The pressure on one of the bodies, with the sign of friction there.
    fn source(&self, member: Member) -> Result<PressureSource<'_>> {
        let (body, counterbody) = (&self.report.body, &self.report.counterbody);
        let bodies = std::iter::once(body).chain(counterbody);
        Ok(PressureSource {
            body: self.member(member)?,
            grid: self.grid(),
            pressure: &self.pressure,
            solved: Some(BodyPair(bodies.map(|body| &**body).collect())),
            sliding: SlidingSense {
                sign: match member {
                    Member::Body => 1.0,
                    Member::Counterbody => -1.0,
                },
                direction: self.report.rolling_direction,
                is_known: false,
            },
            tractions: None,
        })
    }
}

/// The layers of a body.
fn layered(body: &Body) -> Result<&HalfSpace> {
    body.half_space().ok_or(Error::Inconsistent(
        "stresses need a body that is a stack of layers: this one is a normal response alone; \
         give the contact a HalfSpace",
    ))
}
