//! Stress in either body of a solved contact.

use std::ops::ControlFlow;

use super::loaded::Form;
use super::summary::{Limits, StressSummary, stress_summary};
use super::{Stress, StressOptions, StressProgress, watched};
use crate::body::HalfSpace;
use crate::contact::Solution;
use crate::error::{Error, Result};
use crate::response::Body;

/// One of the two bodies of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Member {
    /// The body that the shape is pressed into.
    #[default]
    Body,
    /// The body that carries the shape: z points into it, x and y are the same.
    Counterbody,
}

impl Solution {
    /// Stress at `depths` in one of the bodies. The traction of friction is that on the body; the
    /// counterbody gets the opposite.
    ///
    /// Pressure is taken within cells too, near a smooth edge as a root;
    /// [`stress`](crate::stress()) takes it as uniform over a cell.
    ///
    /// # Errors
    /// Bad input, a counterbody that is rigid, too little memory.
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
        let mut go_on = |_| ControlFlow::Continue(());
        self.stress_watched(depths, member, options, &mut go_on)
    }

    /// [`Solution::stress`], telling `progress` how far it is; its break ends with the depths that
    /// are done.
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
        let (body, options) = self.loaded_member(member, options)?;
        watched(
            body,
            self.grid(),
            &self.pressure,
            Form::Solved,
            depths,
            &options,
            progress,
        )
    }

    /// What is worth knowing of the stress in one of the bodies: peaks in each layer, tractions at
    /// each interface, margins. Pressure is taken within cells, as in [`Solution::stress`].
    ///
    /// # Errors
    /// As [`Solution::stress`], and where a limit is not finite and above 0.
    pub fn stress_summary(
        &self,
        member: Member,
        limits: &Limits,
        options: &StressOptions,
        progress: &mut StressProgress,
    ) -> Result<StressSummary> {
        let (body, options) = self.loaded_member(member, options)?;
        stress_summary(
            body,
            self.grid(),
            &self.pressure,
            limits,
            &options,
            progress,
        )
    }

    /// That body.
    ///
    /// # Errors
    /// Where it is rigid.
    pub fn member(&self, member: Member) -> Result<&HalfSpace> {
        match (member, &self.report.counterbody) {
            (Member::Body, _) => layered(&self.report.body),
            (Member::Counterbody, Some(counterbody)) => layered(counterbody),
            (Member::Counterbody, None) => Err(Error::Inconsistent(
                "body must be \"body\" where the counterbody is rigid",
            )),
        }
    }

    /// That body, and the options with the traction that acts on it.
    fn loaded_member(
        &self,
        member: Member,
        options: &StressOptions,
    ) -> Result<(&HalfSpace, StressOptions)> {
        let body = self.member(member)?;
        let mut options = options.clone();
        if member == Member::Counterbody {
            options.direction = options.direction.map(|d| -d);
        }
        Ok((body, options))
    }
}

/// The layers of a body.
fn layered(body: &Body) -> Result<&HalfSpace> {
    body.half_space().ok_or(Error::Inconsistent(
        "stresses need a body that is a stack of layers: this one tells its normal response alone",
    ))
}
