//! Stress in either body of a solved contact.

use std::ops::ControlFlow;

use ndarray::Array2;

use super::field::Stress;
use super::friction::Sliding;
use super::half_space::{Form, Source};
use super::options::{StressOptions, StressProgress};
use super::plan::StressPlan;
use super::request::stress_once;
use super::subcell::Pair;
use super::summary::{Strengths, StressSummary, summary_once};
use crate::compliance::response::Body;
use crate::contact::Solution;
use crate::error::{Error, Result};
use crate::model::body::HalfSpace;

/// One of the two bodies of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
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
    /// times, make its [`StressPlan`] with [`Solution::stress_plan`].
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
    pub fn stress(
        &self,
        depths: &[f64],
        member: Member,
        options: &StressOptions,
    ) -> Result<Stress> {
        let mut progress = |_| ControlFlow::Continue(());
        self.stress_watched(depths, member, options, &mut progress)
    }

    /// [`Solution::stress`] with a callback: `progress` is told the fraction done, 0 while planning.
    /// When it breaks, the result holds the depths finished so far.
    ///
    /// # Errors
    /// As [`Solution::stress`].
    pub fn stress_watched(
        &self,
        depths: &[f64],
        member: Member,
        options: &StressOptions,
        progress: &mut StressProgress,
    ) -> Result<Stress> {
        stress_once(&self.source(member)?, depths, options, progress)
    }

    /// Peaks in each layer and tractions at each interface of one of the bodies, compared with
    /// `strengths`; see [`StressPlan::summary`]. The pressure is that of [`Solution::stress`].
    ///
    /// # Errors
    /// As [`Solution::stress`], and a strength that is not finite and above 0.
    pub fn stress_summary(
        &self,
        member: Member,
        strengths: &Strengths,
        options: &StressOptions,
        progress: &mut StressProgress,
    ) -> Result<StressSummary> {
        summary_once(&self.source(member)?, strengths, options, progress)
    }

    /// A plan of the stress in one of the bodies, evaluated any number of times without planning again.
    /// It works on `threads` threads; none: all of the machine's. The pressure is that of
    /// [`Solution::stress`], and the plan does not borrow the solution.
    ///
    /// # Errors
    /// A counterbody that is rigid, no threads, or too little memory.
    pub fn stress_plan(&self, member: Member, threads: Option<usize>) -> Result<StressPlan> {
        self.source(member)?.complete_unwatched(threads)
    }

    /// [`Solution::stress_plan`] with a callback: `progress` is told 0 while planning; when it breaks,
    /// there is no plan.
    ///
    /// # Errors
    /// As [`Solution::stress_plan`].
    pub fn stress_plan_watched(
        &self,
        member: Member,
        threads: Option<usize>,
        progress: &mut StressProgress,
    ) -> Result<Option<StressPlan>> {
        self.source(member)?.complete(threads, progress)
    }

    /// A plan of the stress under the pressure and the `tractions` (q_x, q_y) on the body; on the counterbody, their
    /// opposites act. They are uniform over each cell. `progress` is told 0 while planning; when it breaks, there is no
    /// plan.
    ///
    /// # Errors
    /// As [`Solution::stress_plan`], and tractions of another shape than the grid's.
    pub(crate) fn stress_plan_with(
        &self,
        member: Member,
        tractions: [&Array2<f64>; 2],
        threads: Option<usize>,
        progress: &mut StressProgress,
    ) -> Result<Option<StressPlan>> {
        let source = self.source(member)?;
        let source = Source {
            sliding: Sliding {
                is_known: true,
                ..source.sliding
            },
            tractions: Some(tractions.map(|traction| &**traction)),
            ..source
        };
        source.complete(threads, progress)
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
        let source = Source {
            body,
            pressure,
            form: Form::Uniform,
            ..self.source(member)?
        };
        source.complete_unwatched(None)
    }

    /// The layers of one of the bodies.
    ///
    /// # Errors
    /// A rigid counterbody, or a body that is known by its normal response alone.
    pub fn member(&self, member: Member) -> Result<&HalfSpace> {
        match (member, &self.report.counterbody) {
            (Member::Body, _) => layered(&self.report.body),
            (Member::Counterbody, Some(counterbody)) => layered(counterbody),
            (Member::Counterbody, None) => Err(Error::Inconsistent(
                "body must be \"body\" where the counterbody is rigid",
            )),
        }
    }

    /// The pressure on one of the bodies, with the sign of friction there.
    fn source(&self, member: Member) -> Result<Source<'_>> {
        let (body, counterbody) = (&self.report.body, &self.report.counterbody);
        let bodies = std::iter::once(body).chain(counterbody);
        Ok(Source {
            body: self.member(member)?,
            grid: self.grid(),
            pressure: &self.pressure,
            form: Form::Solved(Pair(bodies.map(|body| &**body).collect())),
            sliding: Sliding {
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
