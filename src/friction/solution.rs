//! The solution of a contact with friction.

use std::sync::Arc;

use ndarray::{Array1, Array2, Axis};

use super::step::{Friction, RollingDirection};
use crate::contact::{Solution, Termination};
use crate::error::{Error, Result, all_finite, same_shape};
use crate::model::grid::Grid;
use crate::stress::{Member, Strengths, Stress, StressPlan, StressSummary, WatchedStress};

/// Tangential motion of the counterbody over the body.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(untagged, deny_unknown_fields)
)]
pub enum TangentialMotion {
    /// Sliding, counted from the first touch.
    Slide {
        /// Shift (δ_x, δ_y) \[m\].
        shift: [f64; 2],
        /// Twist about the origin \[rad\].
        twist: f64,
    },
    /// Rolling at constant speed.
    Roll {
        /// Creepages (ξ, η), along the direction of rolling e and along z × e.
        creepage: [f64; 2],
        /// Spin about +z \[1/m\].
        spin: f64,
        /// The direction.
        direction: RollingDirection,
    },
}

/// Estimated discretisation errors of sliding and of steady rolling: differences from the limit of ever finer cells.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[non_exhaustive]
pub struct FrictionDiscretisation {
    /// Error of the force \[N\]: the length of the difference; 0 where both forces are given.
    pub force: f64,
    /// Error of the torque \[N m\]; 0 where it is given.
    pub torque: f64,
    /// Error of the energy dissipated in the step \[J\], or in rolling over the distance rolled \[N\].
    pub dissipated: f64,
    /// Error of the shift \[m\]: the length of the difference; 0 where both shifts are given. `None` in rolling.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub shift: Option<f64>,
    /// Error of the twist \[rad\]; 0 where it is given. `None` in rolling.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub twist: Option<f64>,
    /// Error of the creepage: the length of the difference; 0 where both creepages are given. `None` in sliding.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub creepage: Option<f64>,
    /// Error of the share of the contact that sticks.
    pub stick_share: f64,
}

/// Course and quality of a solve. All errors are computed afresh from the tractions, with the operator of the whole
/// grid.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[non_exhaustive]
pub struct FrictionReport {
    /// How the iteration ended.
    pub termination: Termination,
    /// Tangential convolutions of the window of the contact: from two components to two.
    pub convolutions: usize,
    /// Solves of the pressure for given tractions, and of tractions for given pressure.
    pub sweeps: usize,
    /// Largest slip of a sticking cell, or slip across the traction, over the largest displacement.
    pub violation: f64,
    /// Largest error of a given force or torque, over the largest that friction can carry.
    pub imbalance: f64,
    /// Largest |q| − μp over the largest μp.
    pub excess: f64,
    /// Change of the pressure in the last sweep over the peak; 0 without coupling.
    pub pressure_change: f64,
    /// Elastic energy ½ Σ p v dA of the pressure and the normal displacement v that tractions make \[J\]; 0 without
    /// coupling.
    #[cfg_attr(feature = "serde", serde(default))]
    pub coupling_energy: f64,
    /// Whether tractions and pressure act on each other.
    pub coupled: bool,
    /// Whether all cells in contact slip.
    pub full_slip: bool,
    /// Estimated discretisation errors of sliding, and of steady rolling to second order. `None` in rolling cell by cell, and
    /// where a warning says why.
    #[cfg_attr(feature = "serde", serde(default))]
    pub discretisation: Option<FrictionDiscretisation>,
    /// Order of steady rolling in the length of a cell; 0 in sliding and in rolling cell by cell.
    #[cfg_attr(feature = "serde", serde(default))]
    pub order: usize,
    /// The tolerance.
    pub tolerance: f64,
    /// Seconds that the step took, without planning.
    pub seconds: f64,
}

impl FrictionReport {
    /// Whether the tolerance was met.
    pub fn converged(&self) -> bool {
        self.termination == Termination::Converged
    }
}

/// A contact with friction: one step of a history, or steady rolling. Arrays are (nx, ny), at cell centres.
///
/// Tractions act on the body; on the counterbody their opposites do. Displacements are those of the body less those of
/// the counterbody.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct FrictionSolution {
    /// Pressure, gap and approach.
    pub normal: Solution,
    /// Coefficient of friction.
    pub friction: Friction,
    /// Tractions (q_x, q_y) on the body \[Pa\].
    pub traction: [Array2<f64>; 2],
    /// Tangential displacements (u_x, u_y) of the body relative to the counterbody \[m\].
    pub displacement: [Array2<f64>; 2],
    /// Slip (s_x, s_y) of the counterbody over the body: in the step \[m\], or in rolling over the speed; 0 outside the
    /// contact.
    pub slip: [Array2<f64>; 2],
    /// Tangential motion.
    pub motion: TangentialMotion,
    /// Course and quality.
    pub report: FrictionReport,
    /// The same history on cells of twice the length, with which the next step is compared; `None` where there is none, and
    /// in a solution from a file. It does not count in comparisons.
    pub half: Option<Arc<FrictionSolution>>,
}

/// Whether problem and numbers are equal; the seconds that the solves took do not count.
impl PartialEq for FrictionSolution {
    fn eq(&self, other: &Self) -> bool {
        let seconds = self.report.seconds;
        self.normal == other.normal
            && self.friction == other.friction
            && self.traction == other.traction
            && self.displacement == other.displacement
            && self.slip == other.slip
            && self.motion == other.motion
            && self.report == FrictionReport { seconds, ..other.report.clone() }
    }
}

impl FrictionSolution {
    /// The grid.
    pub fn grid(&self) -> &Grid {
        self.normal.grid()
    }

    /// The solution itself, if the tolerance was met.
    ///
    /// # Errors
    /// [`Error::NotConverged`] where it was not met.
    pub fn require_converged(self) -> Result<Self> {
        let report = &self.report;
        if report.converged() {
            return Ok(self);
        }
        Err(Error::NotConverged {
            iterations: report.convolutions,
            residual: report.violation.max(report.pressure_change),
            overlap: self.normal.report.overlap,
            balance: report.imbalance,
            tolerance: report.tolerance,
            limit: "max_convolutions",
        })
    }

    /// Stress at `depths` in one of the bodies, under the pressure and the tractions. The pressure is reconstructed
    /// within cells, as [`Solution::stress`](crate::Solution::stress) does; tractions are uniform over cells, and at
    /// single points follow the pressure within the cells around.
    ///
    /// # Errors
    /// As [`Solution::stress`](crate::Solution::stress); friction among the `options`.
    pub fn stress<'a>(
        &self,
        depths: &[f64],
        member: Member,
        options: impl Into<WatchedStress<'a>>,
    ) -> Result<Stress> {
        let mut watched_options = options.into();
        let options = watched_options.options();
        let mut progress = |fraction| watched_options.tell(fraction);
        let plan = self.stress_plan(member, options.watched(&mut progress))?;
        plan.stress(depths, options.watched(&mut progress))
    }

    /// Peaks of this stress in each layer, and tractions at each interface.
    ///
    /// # Errors
    /// As [`FrictionSolution::stress`], and bad strengths.
    pub fn stress_summary<'a>(
        &self,
        member: Member,
        strengths: &Strengths,
        options: impl Into<WatchedStress<'a>>,
    ) -> Result<StressSummary> {
        let mut watched_options = options.into();
        let options = watched_options.options();
        let mut progress = |fraction| watched_options.tell(fraction);
        let plan = self.stress_plan(member, options.watched(&mut progress))?;
        plan.summary(strengths, options.watched(&mut progress))
    }

    /// A plan of the stress in one of the bodies under the pressure and the tractions, evaluated any number of times,
    /// also for a [`StressPlan::summary`]. Of the options, only `threads` is used. A callback of
    /// [`StressOptions::watched`](crate::StressOptions::watched) is told 0 while planning.
    ///
    /// # Errors
    /// A counterbody that is rigid, no threads, too little memory, or a callback that breaks.
    pub fn stress_plan<'a>(
        &self,
        member: Member,
        options: impl Into<WatchedStress<'a>>,
    ) -> Result<StressPlan> {
        let tractions = self.traction.each_ref();
        self.normal.stress_plan_with(member, tractions, options.into())
    }

    /// The solution itself, if its fields fit the grid and are finite.
    ///
    /// # Errors
    /// A field of another shape, or one that is not finite; a coefficient of friction below 0.
    pub fn checked(self) -> Result<Self> {
        self.friction.check(self.grid())?;
        let expected = self.grid().shape();
        let named = [
            ("traction", &self.traction),
            ("displacement", &self.displacement),
            ("slip", &self.slip),
        ];
        for (name, field) in named.into_iter().flat_map(|(name, [x, y])| [(name, x), (name, y)]) {
            same_shape(name, field, expected)?;
            all_finite(name, field)?;
        }
        Ok(self)
    }

    /// Forces (Σ q_x dA, Σ q_y dA) of the tractions on the body \[N\].
    pub fn force(&self) -> [f64; 2] {
        let area = self.grid().cell_area();
        self.traction.each_ref().map(|q| q.sum() * area)
    }

    /// Torque Σ (x q_y − y q_x) dA of the tractions on the body, about the origin \[N m\].
    pub fn torque(&self) -> f64 {
        let (x, y, [qx, qy]) = (self.grid().x(), self.grid().y(), &self.traction);
        let along = qy.sum_axis(Axis(1)).dot(&x);
        let across = qx.sum_axis(Axis(0)).dot(&y);
        (along - across) * self.grid().cell_area()
    }

    /// Bound μp of the traction \[Pa\].
    pub fn bound(&self) -> Array2<f64> {
        self.friction.times(&self.normal.pressure)
    }

    /// Size |q| of the traction \[Pa\].
    pub fn traction_size(&self) -> Array2<f64> {
        let [x, y] = &self.traction;
        let mut size = x.clone();
        size.zip_mut_with(y, |x, y| *x = x.hypot(*y));
        size
    }

    /// Cells in contact that stick: their traction is below the bound.
    pub fn stick(&self) -> Array2<bool> {
        let (bound, size) = (self.bound(), self.traction_size());
        let sticks =
            |(index, p): ((usize, usize), &f64)| *p > 0.0 && size[index] < AT_BOUND * bound[index];
        Array2::from_shape_fn(bound.dim(), |cell| sticks((cell, &self.normal.pressure[cell])))
    }

    /// Share of the cells in contact that stick; 0 where nothing touches.
    pub fn stick_share(&self) -> f64 {
        let count = |cells: &Array2<bool>| cells.iter().filter(|cell| **cell).count();
        count(&self.stick()) as f64 / count(&self.normal.in_contact()).max(1) as f64
    }

    /// Energy that friction dissipates in the step, by area: q · s \[J/m²\]; in rolling, over the distance rolled
    /// \[J/m³\].
    pub fn dissipation(&self) -> Array2<f64> {
        let ([qx, qy], [sx, sy]) = (&self.traction, &self.slip);
        qx * sx + qy * sy
    }

    /// Energy that friction dissipates in the step \[J\]; in rolling, over the distance rolled \[N\]: times the speed it is
    /// the power.
    ///
    /// In steady rolling to second order it is the work of the creepages, less that of what the pressure spreads,
    ///
    /// ```text
    /// Σ q · { W(x) − [u(x − d e) − u(x + d e)]/2d } dA
    /// ```
    ///
    /// to which the tractions' own displacements add nothing: their difference is antisymmetric in q. With full adhesion it
    /// is the energy that is set free at the trailing edge, of which the slips of cells know nothing. Derived here. The sum
    /// of [`FrictionSolution::dissipation`] lacks the slip of the cells in which the stick zone ends: some per cent on 40
    /// cells across the contact, a quarter of it on 80.
    pub fn dissipated(&self) -> f64 {
        match self.motion {
            TangentialMotion::Roll { creepage, spin, direction } if self.report.order == 2 => {
                let [x, y] = self.force();
                let [ex, ey] = direction.vector();
                let [along, across] = [x * ex + y * ey, y * ex - x * ey];
                let turns = if spin != 0.0 { spin * self.torque() } else { 0.0 };
                let work = along * creepage[0] + across * creepage[1] + turns;
                work - self.spreading_work(direction)
            }
            _ => self.dissipation().sum() * self.grid().cell_area(),
        }
    }

    /// Σ q · [u(x − d e) − u(x + d e)]/2d dA, 0 where pressure does not move the surfaces along each other. At the edge of
    /// the grid the difference is that to the one cell beside.
    fn spreading_work(&self, direction: RollingDirection) -> f64 {
        if !self.report.coupled {
            return 0.0;
        }
        let axis = direction.axis();
        let along = if direction.is_forward() { 1.0 } else { -1.0 };
        let mut sum = 0.0;
        for (q, u) in self.traction.iter().zip(&self.displacement) {
            for (q, u) in q.lanes(Axis(axis)).into_iter().zip(u.lanes(Axis(axis))) {
                for (k, q) in q.indexed_iter().filter(|(_, q)| **q != 0.0) {
                    let (low, high) = (k.saturating_sub(1), (k + 1).min(u.len() - 1));
                    sum += q * along * (u[low] - u[high]) / (high - low) as f64;
                }
            }
        }
        sum * self.grid().cell_area() / self.grid().spacing()[axis]
    }

    /// Σ p |s| d \[N/m\] of steady rolling over each line of cells in its direction. To second order it is Σ q · s d/μ with the
    /// slip s of [`FrictionSolution::dissipated`], of which the lines together have all; derived here. Cells without friction have
    /// their own slip.
    pub(crate) fn track(&self, direction: RollingDirection) -> Array1<f64> {
        let (grid, bound, axis) = (self.grid(), self.bound(), direction.axis());
        let (x, y, spacing) = (grid.x(), grid.y(), grid.spacing()[axis]);
        let [ex, ey] = direction.vector();
        let slipping = Array2::from_shape_fn(bound.dim(), |(i, j)| {
            let (p, bound) = (self.normal.pressure[[i, j]], bound[[i, j]]);
            let [own_x, own_y] = self.slip.each_ref().map(|slip| slip[[i, j]]);
            let (TangentialMotion::Roll { creepage: [along, across], spin, .. }, true, 2) =
                (self.motion, bound > 0.0, self.report.order)
            else {
                return p * own_x.hypot(own_y);
            };
            let rigid =
                [along * ex - across * ey - spin * y[j], along * ey + across * ex + spin * x[i]];
            let (n, mut low, mut high) = (grid.shape()[axis], [i, j], [i, j]);
            (low[axis], high[axis]) = (low[axis].saturating_sub(1), (high[axis] + 1).min(n - 1));
            let between = (high[axis] - low[axis]) as f64 * spacing * (ex + ey);
            let parts = self.traction.iter().zip(&self.displacement).zip(rigid);
            let work =
                parts.map(|((q, u), rigid)| q[[i, j]] * (rigid - (u[low] - u[high]) / between));
            work.sum::<f64>() * p / bound
        });
        slipping.sum_axis(Axis(axis)).mapv(|line| line.max(0.0) * spacing)
    }

    /// What tractions add to the elastic energy of the bodies \[J\]: with the normal displacement v that they make,
    ///
    /// ```text
    /// ½ Σ (q · u + p v) dA
    /// ```
    ///
    /// The normal contact has ½ Σ p w dA without v. The sum of both changes by the work of the forces less what friction
    /// dissipates. Without coupling v is 0; with it the share of the tractions alone may be below 0. It is not a number in line contact
    /// where stiff layers move less than the datum, so that what the tractions alone displace, ½ Σ q · u less the share of
    /// v, which is that of the pressure in u, would be below 0. Derived here.
    pub fn tangential_energy(&self) -> f64 {
        let ([qx, qy], [ux, uy]) = (&self.traction, &self.displacement);
        let work = 0.5 * self.grid().cell_area() * (qx * ux + qy * uy);
        let (own, rounding) = (work.sum() - self.report.coupling_energy, 1e-12 * work.abs().sum());
        if own < -rounding { f64::NAN } else { work.sum() + self.report.coupling_energy }
    }
}

/// Traction relative to its bound from which on a cell slips, but for rounding.
const AT_BOUND: f64 = 1.0 - 1e-9;
