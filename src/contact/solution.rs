//! The solution of a contact.

pub(super) mod tangent;
pub(super) mod warnings;

use std::ops::ControlFlow;
use std::sync::Arc;

use ndarray::{ArcArray2, Array1, Array2};

use crate::compliance::ends::{Ends, FreeEnds};
use crate::compliance::response::Body;
use crate::contact::cascade::discretisation::Discretisation;
use crate::contact::ends::contact_ends;
use crate::contact::options::{Motion, Options};
use crate::contact::plan::{Contact, PlannedOperator, check_coefficients};
use crate::contact::problem::bounds::{Hardness, check_indentation};
use crate::contact::problem::freedoms::Freedoms;
use crate::contact::problem::patch::{bounds, rows};
use crate::contact::problem::springs::Compliance;
use crate::contact::problem::{Multipliers, Quality};
use crate::contact::solution::warnings::Warning;
use crate::contact::solver::{Solver, Termination};
use crate::error::{Error, Result, all_finite, finite, refuse_if, same_shape};
use crate::model::grid::{Grid, Window, full_window};
use crate::model::surface::Surface;
use crate::numerics::layout::{slice, slice_mut};
use crate::numerics::parallel::{Row, update_with_largest};

/// A solved contact. Arrays are (nx, ny), at cell centres.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Solution {
    /// Pressure \[Pa\], ≥ 0.
    pub pressure: Array2<f64>,
    /// Normal displacement of both bodies together \[m\], positive into them.
    pub displacement: Array2<f64>,
    /// Approach δ of the origin \[m\].
    pub approach: f64,
    /// Tilt (s_x, s_y).
    pub tilt: [f64; 2],
    /// Largest pressure that the surfaces carry; `None` where they do not yield.
    pub hardness: Option<Hardness>,
    /// Permanent indentation \[m\], ≥ 0, with that of the solves before; `None` where no cell has one. The gap
    /// contains it.
    pub indentation: Option<Array2<f64>>,
    /// Compliance of springs between the surfaces; `None` where there are none. The gap contains what they give.
    pub compliance: Option<Compliance>,
    /// Influence coefficients that were given ([`Setup`](super::Setup)); `None` where they are those of the bodies.
    pub coefficients: Option<ArcArray2<f64>>,
    /// Course of the solve and quality of the solution.
    pub report: Report,
    pub(super) gap: Gap,
    /// What it was solved with; `None` where no plan did.
    pub(super) operator: Option<Arc<PlannedOperator>>,
}

/// Whether problem and numbers are equal; the seconds that the solves took do not count.
impl PartialEq for Solution {
    fn eq(&self, other: &Self) -> bool {
        let position = |solution: &Self| (solution.approach, solution.tilt);
        let seconds = self.report.seconds;
        position(self) == position(other)
            && self.report == Report { seconds, ..other.report.clone() }
            && self.pressure == other.pressure
            && self.displacement == other.displacement
            && self.hardness == other.hardness
            && self.indentation == other.indentation
            && self.compliance == other.compliance
            && self.coefficients == other.coefficients
            && self.gap() == other.gap()
    }
}

impl Solution {
    /// A solution from the parts that a file has: pressure, gap and displacement, approach and tilt.
    ///
    /// # Errors
    /// A field whose shape is not that of the report's grid, a pressure that is negative or not finite, a
    /// displacement, approach or tilt that is not finite, and a gap that is −∞ or not a number.
    ///
    /// ```
    /// use nacre::{Contact, Elastic, Grid, Motion, Options, Paraboloid, Setup, Solution};
    ///
    /// let contact = Contact::plan(Elastic::new(1.0, 0.0)?, Grid::new([64, 64], [4.0, 4.0])?, Setup::default())?;
    /// let solution = contact.solve(&Paraboloid::new(1e3, 1e3)?, &Motion::load(1e-3), &Options::default())?;
    /// let fields = [solution.pressure.clone(), solution.gap(), solution.displacement.clone()];
    /// let again = Solution::from_fields(fields, solution.approach, solution.tilt, solution.report.clone())?;
    /// assert_eq!(again, solution);
    /// # Ok::<(), nacre::Error>(())
    /// ```
    pub fn from_fields(
        [pressure, gap, displacement]: [Array2<f64>; 3],
        approach: f64,
        tilt: [f64; 2],
        report: Report,
    ) -> Result<Self> {
        let expected = report.grid.shape();
        let fields = [&pressure, &gap, &displacement];
        for (name, field) in ["pressure", "gap", "displacement"].into_iter().zip(fields) {
            same_shape(name, field, expected)?;
        }
        all_finite("pressure", &pressure)?;
        all_finite("displacement", &displacement)?;
        for (name, requirement, field, smallest) in [
            ("pressure", "at least 0", &pressure, 0.0),
            ("gap", "a number or +inf", &gap, f64::MIN),
        ] {
            if let Some(&value) = field.iter().find(|&&v| v.is_nan() || v < smallest) {
                return Err(Error::Parameter { name, requirement, value });
            }
        }
        finite("approach", approach)?;
        for slope in tilt {
            finite("tilt", slope)?;
        }
        Ok(Self {
            pressure,
            displacement,
            approach,
            tilt,
            hardness: None,
            indentation: None,
            compliance: None,
            coefficients: None,
            report,
            gap: Gap::Known(gap),
            operator: None,
        })
    }

    /// The solution with the hardness and the permanent indentation that it has in a file.
    ///
    /// # Errors
    /// An array of another shape than the grid, a hardness that is not above 0, an indentation that is negative or not
    /// finite.
    pub fn yielding(
        self,
        hardness: Option<Hardness>,
        indentation: Option<Array2<f64>>,
    ) -> Result<Self> {
        if let Some(hardness) = &hardness {
            hardness.check(self.grid())?;
        }
        if let Some(indentation) = &indentation {
            check_indentation(indentation, self.grid())?;
        }
        Ok(Self { hardness, indentation, ..self })
    }

    /// The solution with the compliance of springs that it has in a file.
    ///
    /// # Errors
    /// An array of another shape than the grid, a compliance that is negative or not finite.
    pub fn with_compliance(self, compliance: Compliance) -> Result<Self> {
        compliance.on(self.grid())?;
        Ok(Self { compliance: Some(compliance), ..self })
    }

    /// Takes what `springs` give from the displacement, which then is that of the bodies alone.
    pub(in crate::contact) fn take_springs(&mut self, springs: &Array2<f64>) {
        let deflections = springs * &self.pressure;
        self.displacement -= &deflections;
        if let Gap::Computed { deflection, .. } = &mut self.gap {
            *deflection = Some(deflections);
        }
    }

    /// Makes what the springs gave a part of the undeformed gap; `depth` takes its place, where there is one.
    pub(crate) fn release_springs(&mut self, depth: Option<Array2<f64>>) {
        if let Gap::Computed { undeformed, deflection, .. } = &mut self.gap
            && let Some(deflection) = deflection.take()
        {
            *Arc::make_mut(undeformed) += &depth.unwrap_or(deflection);
        }
    }

    /// Displacement of the bodies and deflection of the springs together \[m\].
    pub(crate) fn total_displacement(&self) -> Array2<f64> {
        let springs = self.compliance.as_ref().and_then(|c| c.on(self.grid()).ok());
        match springs {
            Some(springs) => springs * &self.pressure + &self.displacement,
            None => self.displacement.clone(),
        }
    }

    /// The solution with the influence coefficients that were given.
    ///
    /// # Errors
    /// Coefficients that do not suit the grid.
    pub fn with_coefficients(self, coefficients: Array2<f64>) -> Result<Self> {
        check_coefficients(&coefficients, self.grid())?;
        Ok(Self { coefficients: Some(coefficients.into_shared()), ..self })
    }

    /// The solution itself, if the tolerance was met.
    ///
    /// # Errors
    /// [`Error::NotConverged`] where it was not met; the message quotes `tolerance`.
    pub fn require_converged(self, tolerance: f64) -> Result<Self> {
        if self.report.converged() {
            return Ok(self);
        }
        Err(self.report.not_converged(tolerance))
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.report.grid
    }

    /// Gap \[m\], h + u − δ − s_x x − s_y y: 0 in contact within the tolerance, +∞ where the shape
    /// cannot touch. It is computed at each call from the displacement that the solution has then.
    pub fn gap(&self) -> Array2<f64> {
        self.gap.field(&self.displacement)
    }

    /// Whether each cell is in contact, p > 0.
    pub fn in_contact(&self) -> Array2<bool> {
        self.pressure.mapv(|p| p > 0.0)
    }

    /// Normal force Σ p dA \[N\].
    pub fn load(&self) -> f64 {
        self.pressure.sum() * self.grid().cell_area()
    }

    /// First moments of the pressure about the origin (Σ p x dA, Σ p y dA) \[N m\]; NaN along an axis on which the grid
    /// is periodic, where they depend on the cell that is the first.
    pub fn moment(&self) -> [f64; 2] {
        let area = self.grid().cell_area();
        let by_axis = |axis: usize| {
            if self.grid().is_periodic()[axis] {
                return f64::NAN;
            }
            let line = self.pressure.sum_axis(ndarray::Axis(1 - axis));
            line.dot(&self.grid().coordinates(axis)) * area
        };
        [by_axis(0), by_axis(1)]
    }

    /// Point where the force acts \[m\]; the origin where there is no force, and NaN along an axis on which the grid is
    /// periodic.
    pub fn eccentricity(&self) -> [f64; 2] {
        let load = self.load();
        self.moment().map(|moment| match moment.is_nan() || load > 0.0 {
            true => moment / load,
            false => 0.0,
        })
    }

    /// Area of the cells in contact \[m²\].
    pub fn contact_area(&self) -> f64 {
        let cells = self.pressure.iter();
        cells.filter(|p| **p > 0.0).count() as f64 * self.grid().cell_area()
    }

    /// Energy that the permanent indentation w has taken \[J\], Σ H w dA; 0 where the surfaces do not yield.
    ///
    /// It is the work that a history of loads with one hardness leaves when the load is taken away.
    pub fn plastic_work(&self) -> f64 {
        let (Some(hardness), Some(indentation)) = (&self.hardness, &self.indentation) else {
            return 0.0;
        };
        let deeper = indentation.iter().enumerate().filter(|(_, w)| **w > 0.0);
        deeper.map(|(k, w)| hardness.at(k) * w).sum::<f64>() * self.grid().cell_area()
    }

    /// Largest pressure of a cell \[Pa\].
    pub fn peak_pressure(&self) -> f64 {
        self.pressure.fold(0.0, |peak, &p| peak.max(p))
    }

    /// Centre of the cell of the largest pressure \[m\]; of several, the one of the deepest indentation, or the first.
    pub fn peak_position(&self) -> [f64; 2] {
        let peak = self.peak_pressure();
        let mut highest = self.pressure.indexed_iter().filter(|(_, p)| **p >= peak);
        let depth = |at: (usize, usize)| self.indentation.as_ref().map_or(0.0, |w| w[at]);
        let first = highest.next().map_or((0, 0), |(at, _)| at);
        let deepest =
            highest.fold(first, |best, (at, _)| if depth(at) > depth(best) { at } else { best });
        [self.grid().x()[deepest.0], self.grid().y()[deepest.1]]
    }

    /// Pressure at the origin \[Pa\], by cubic interpolation between cell centres; 0 off the grid.
    pub fn central_pressure(&self) -> f64 {
        let (Some((i, wx)), Some((j, wy))) = (self.around_origin(0), self.around_origin(1)) else {
            return 0.0;
        };
        let [nx, ny] = self.grid().shape();
        let mut sum = 0.0;
        for (a, wx) in wx.into_iter().enumerate() {
            for (b, wy) in wy.into_iter().enumerate() {
                let (i, j) = ((i + a).saturating_sub(1), (j + b).saturating_sub(1));
                sum += wx * wy * self.pressure[[i.min(nx - 1), j.min(ny - 1)]];
            }
        }
        sum.max(0.0)
    }

    /// The cell below the origin along `axis`, and cubic weights of the four cells around it.
    fn around_origin(&self, axis: usize) -> Option<(usize, [f64; 4])> {
        let grid = self.grid();
        let n = grid.shape()[axis];
        let position = -grid.center()[axis] / grid.spacing()[axis] + 0.5 * (n - 1) as f64;
        if !(-0.5..=n as f64 - 0.5).contains(&position) {
            return None;
        }
        let position = position.clamp(0.0, (n - 1) as f64);
        let below = position as usize;
        let t = position - below as f64;
        Some((
            below,
            [
                -t * (t - 1.0) * (t - 2.0) / 6.0,
                (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
                -(t + 1.0) * t * (t - 2.0) / 2.0,
                (t + 1.0) * t * (t - 1.0) / 6.0,
            ],
        ))
    }

    /// The smallest window that holds all cells in contact; `None` where nothing touches.
    pub(crate) fn cells_in_contact(&self) -> Option<Window> {
        bounds(&full_window(self.grid().shape()), |i, j| self.pressure[[i, j]] > 0.0)
    }

    /// Force per length along x, Σ p dy (nx,) \[N/m\].
    pub fn line_load(&self) -> Array1<f64> {
        self.pressure.sum_axis(ndarray::Axis(1)) * self.grid().spacing()[1]
    }

    /// Ends of the contact along x and along y \[m\], within a fraction of a cell.
    ///
    /// p² falls to zero steeply and smoothly at an edge where the surfaces part: on each line of
    /// cells a parabola through p² of the third to the seventh cell is continued to its zero. At a
    /// sharp edge, where p grows, on lines of fewer than 14 cells, and where there is no such zero
    /// within a cell, the contact ends with its outermost cell. Both ends are 0 where there is no
    /// contact, and NaN along an axis on which the grid is periodic where the contact goes on from its last cell to its
    /// first.
    pub fn contact_extent(&self) -> [[f64; 2]; 2] {
        contact_ends(&self.pressure, self.grid()).map(|ends| ends.map(|end| end.at))
    }
}

/// The gap of a solution, or what it is computed from.
#[derive(Debug, Clone)]
pub(crate) enum Gap {
    /// g = h + u − Bλ, with the displacement u of the solution.
    Computed {
        /// h, less the prescribed motion; solutions of one shape may share it.
        undeformed: Arc<Array2<f64>>,
        /// B
        freedoms: Box<Freedoms>,
        /// λ
        multipliers: Multipliers,
        /// What springs give, c p.
        deflection: Option<Array2<f64>>,
    },
    /// g
    Known(Array2<f64>),
}

impl Gap {
    /// The gap of the solution, for its `displacement`.
    pub(crate) fn field(&self, displacement: &Array2<f64>) -> Array2<f64> {
        let (undeformed, freedoms, multipliers, deflection) = match self {
            Self::Computed { undeformed, freedoms, multipliers, deflection } => {
                (undeformed, freedoms, multipliers, deflection)
            }
            Self::Known(gap) => return gap.clone(),
        };
        let total = deflection.as_ref().map(|deflection| displacement + deflection);
        let displacement = total.as_ref().unwrap_or(displacement);
        let mut gap = Array2::zeros(undeformed.dim());
        let (columns, [x, y]) = (undeformed.ncols(), &freedoms.columns);
        let [u, h] = [slice(displacement), slice(undeformed)];
        let [u, h] = [&u, &h].map(|values| values.chunks_exact(columns));
        let rows = slice_mut(&mut gap).chunks_exact_mut(columns).zip(u.zip(h)).enumerate();
        for ((number, (g, (u, h))), &x) in rows.zip(x) {
            multipliers.gap(Row { number, x, y }, [u, h], g);
        }
        gap
    }
}

/// Course of a solve and quality of its solution. All numbers are computed afresh at the end.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
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
    /// line contact, and x of a body of revolution that is pressed on its axis, as all directions are alike. `None` where
    /// the shape has no such direction, or it is not known, as in files of earlier versions.
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

    /// Checks that a history that begins with this solution goes on with the same bodies.
    ///
    /// # Errors
    /// Where a body is another one.
    pub(crate) fn check_bodies(&self, body: &Body, counterbody: Option<&Body>) -> Result<()> {
        refuse_if(
            self.body != *body || self.counterbody.as_ref() != counterbody,
            "initial must be a solution of the body and the counterbody of this contact, was one of others: what has \
             slipped or yielded belongs to its bodies",
        )
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
        plan: &Contact,
        shape: &dyn Surface,
        motion: &Motion,
        options: &Options,
    ) -> Self {
        let is_round = shape.is_round()
            && motion.is_centred()
            && options.is_uniform()
            && plan.setup.coefficients.is_none()
            && plan.grid.is_periodic() == [false; 2];
        let direction = plan.grid.rolling_direction().or_else(|| shape.rolling_direction());
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
            rolling_direction: direction.or_else(|| is_round.then_some([1.0, 0.0])),
            tolerance: options.tolerance,
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
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[non_exhaustive]
pub struct Balance {
    /// |Σ p dA − W| / W; 0 where the force is not given.
    pub force: f64,
    /// |Σ p x dA − M_x| / (W × half side), along y alike; 0 where the moment is not given.
    pub moment: [f64; 2],
}

/// Force, moments and peak of a pressure.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Resultants {
    pub(crate) force: f64,
    moment: [f64; 2],
    pub(crate) peak: f64,
}

impl Resultants {
    /// Force, moments and peak of `pressure`, which is zero outside `window`.
    pub(crate) fn of(pressure: &Array2<f64>, window: &Window, grid: &Grid) -> Self {
        let [x, y] = [0, 1].map(|k| grid.coordinates(k).to_vec()[window[k].clone()].to_vec());
        let mut sums = Self::default();
        for (row, x) in rows(&slice(pressure), grid.shape()[1], window).zip(x) {
            let ([peak], [force, moment]) =
                update_with_largest([row, &y], [], |[p, y], []| ([], [p], [p, p * y]));
            sums.force += force;
            sums.moment[0] += force * x;
            sums.moment[1] += moment;
            sums.peak = sums.peak.max(peak);
        }
        let area = grid.cell_area();
        Self { force: sums.force * area, moment: sums.moment.map(|m| m * area), ..sums }
    }

    /// Errors of force and moments against those that `motion` asks for.
    pub(crate) fn balance(&self, grid: &Grid, motion: &Motion) -> Balance {
        let scale = motion.load.unwrap_or(self.force);
        let relative = |a: f64, b: f64| if a > 0.0 && b > 0.0 { a / b } else { 0.0 };
        let half = grid.size().map(|length| 0.5 * length);
        let moment = [0, 1].map(|k| {
            let eccentricity = || Some(motion.eccentricity[k]? * motion.load.unwrap_or(0.0));
            let target = motion.moment[k].or_else(eccentricity);
            target.map_or(0.0, |m| relative((self.moment[k] - m).abs(), scale * half[k]))
        });
        let force = motion.load;
        Balance { force: force.map_or(0.0, |w| relative((self.force - w).abs(), w)), moment }
    }
}
