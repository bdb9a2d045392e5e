//! What a solved contact returns.

pub(super) mod fields;
pub(super) mod gap;
pub(super) mod stiffness;
pub(super) mod warnings;

use std::fmt;

use ndarray::{Array1, Array2};

use super::problem::Termination;
use crate::contact::cascade::discretisation::Discretisation;
use crate::contact::problem::freedoms::Motion;
use crate::contact::solution::gap::Gap;
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::influence::Method;
use crate::response::Body;

/// Something about a solution that its user should know.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// The contact touches the edge of the grid, and the shape goes on beyond it.
    GridEdge,
    /// The contact reaches the end of a shape of finite length.
    SharpEnd {
        /// 0 along x, 1 along y.
        axis: usize,
    },
    /// Fewer than eight cells resolve the contact.
    Coarse {
        /// 0 along x, 1 along y.
        axis: usize,
        /// How many there are.
        cells: usize,
    },
    /// The contact is not small against a radius of curvature.
    LargeContact {
        /// 0 along x, 1 along y.
        axis: usize,
        /// Half-width over radius.
        ratio: f64,
    },
}

/// Half-width over radius at which a circle leaves its parabola by 1 %: (a/R)²/4.
pub(super) const LARGE_CONTACT: f64 = 0.2;

/// Cells across the contact below which pressure errs by some per cent.
pub(super) const FEW_CELLS: usize = 8;

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let along = |axis: &usize| if *axis == 0 { "x" } else { "y" };
        match self {
            Self::GridEdge => {
                write!(
                    f,
                    "the contact touches the edge of the grid; take a larger grid"
                )
            }
            Self::SharpEnd { axis } => write!(
                f,
                "the contact reaches the end of the shape along {}: the pressure there is that of \
                 a sharp edge on a half-space that goes on, and grows as the grid is refined",
                along(axis)
            ),
            Self::Coarse { axis, cells } => write!(
                f,
                "the contact is only {cells} cells wide along {}; take a finer grid",
                along(axis)
            ),
            Self::LargeContact { axis, ratio } => write!(
                f,
                "the contact is not small against the radius along {}: half-width/radius = \
                 {ratio:.2}; the bodies are taken as half-spaces",
                along(axis)
            ),
        }
    }
}

/// Mismatch of force and moments.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Balance {
    /// |Σ p dA − W| / W; 0 where the force is not given.
    pub force: f64,
    /// |Σ p x dA − M_x| / (W × half side), along y alike; 0 where the moment is not given.
    pub moment: [f64; 2],
}

/// How a solution came about, and how good it is. All figures are computed afresh at the end.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// How the iteration ended.
    pub termination: Termination,
    /// Iterations done.
    pub iterations: usize,
    /// Work done, in convolutions of the whole grid: those of coarser grids, of windows and of the
    /// preconditioner count by the points P of their meshes, as P log P.
    pub convolutions: f64,
    /// Complementarity: Σ p|g| / Σ p u over the cells that can touch; 0 when p = 0.
    pub residual: f64,
    /// max(−g, 0) / max u over them.
    pub overlap: f64,
    /// Mismatch of force and moments.
    pub balance: Balance,
    /// What the size of the cells leaves, estimated from coarser grids. None where none was solved:
    /// on small grids, from a given pressure, by another algorithm, before the end.
    pub discretisation: Option<Discretisation>,
    /// What the user should know.
    pub warnings: Vec<Warning>,
    /// The grid.
    pub grid: Grid,
    /// The body that the shape was pressed into.
    pub body: Body,
    /// The body that carries the shape; rigid where `None`.
    pub counterbody: Option<Body>,
    /// How the influence coefficients were computed.
    pub method: Method,
    /// What was asked: load or approach, and of the tilts.
    pub motion: Motion,
    /// The tolerance that was asked.
    pub tolerance: f64,
    /// Seconds the solve took, planning excluded.
    pub seconds: f64,
}

impl Report {
    /// Whether the tolerance was met.
    pub fn converged(&self) -> bool {
        self.termination == Termination::Converged
    }
}

/// A solved contact. Arrays are (nx, ny), at cell centres.
#[derive(Debug, Clone)]
pub struct Solution {
    /// Pressure \[Pa\], ≥ 0.
    pub pressure: Array2<f64>,
    /// Normal displacement of both bodies together \[m\], positive into them.
    pub displacement: Array2<f64>,
    /// Approach δ of the origin \[m\].
    pub approach: f64,
    /// Tilt (s_x, s_y).
    pub tilt: [f64; 2],
    /// How it came about.
    pub report: Report,
    pub(super) gap: Gap,
}

impl PartialEq for Solution {
    fn eq(&self, other: &Self) -> bool {
        let motion = |solution: &Self| (solution.approach, solution.tilt);
        motion(self) == motion(other)
            && self.report == other.report
            && self.pressure == other.pressure
            && self.displacement == other.displacement
            && self.gap() == other.gap()
    }
}

impl Solution {
    /// A solution from its parts, as a file has them: pressure, gap and displacement, approach and tilt.
    ///
    /// # Errors
    /// A field of another shape than that of the report's grid.
    ///
    /// ```
    /// use nacre::{Contact, Elastic, Grid, Motion, Options, Paraboloid, Setup, Solution};
    ///
    /// let contact = Contact::plan(&Elastic::new(1.0, 0.0)?, Grid::new([64, 64], [4.0, 4.0])?, Setup::default())?;
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
            let found = [field.nrows(), field.ncols()];
            if found != expected {
                return Err(Error::Shape {
                    name,
                    expected,
                    found,
                });
            }
        }
        Ok(Self {
            pressure,
            displacement,
            approach,
            tilt,
            report,
            gap: Gap::Known(gap),
        })
    }

    /// Itself, if the tolerance was met.
    ///
    /// # Errors
    /// [`Error::NotConverged`] where it was not; `tolerance` is quoted.
    pub fn require_converged(self, tolerance: f64) -> Result<Self> {
        if self.report.converged() {
            return Ok(self);
        }
        let Report {
            iterations,
            residual,
            overlap,
            ..
        } = self.report;
        Err(Error::NotConverged {
            iterations,
            residual,
            overlap,
            tolerance,
        })
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.report.grid
    }

    /// Gap \[m\], h + u − δ − s_x x − s_y y: 0 in contact within the tolerance, +∞ where the shape
    /// cannot touch. Computed at each call, of the displacement that the solution has then.
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

    /// First moments of the pressure about the origin (Σ p x dA, Σ p y dA) \[N m\].
    pub fn moment(&self) -> [f64; 2] {
        let area = self.grid().cell_area();
        let by_axis = |axis: usize| {
            let line = self.pressure.sum_axis(ndarray::Axis(1 - axis));
            line.dot(&self.grid().coordinates(axis)) * area
        };
        [by_axis(0), by_axis(1)]
    }

    /// Where the force acts \[m\]; the origin where there is none.
    pub fn eccentricity(&self) -> [f64; 2] {
        let load = self.load();
        self.moment()
            .map(|moment| if load > 0.0 { moment / load } else { 0.0 })
    }

    /// Area of the cells in contact \[m²\].
    pub fn contact_area(&self) -> f64 {
        self.pressure.iter().filter(|p| **p > 0.0).count() as f64 * self.grid().cell_area()
    }

    /// Largest pressure of a cell \[Pa\].
    pub fn peak_pressure(&self) -> f64 {
        self.pressure.fold(0.0, |peak, &p| peak.max(p))
    }

    /// Centre of the cell of the largest pressure \[m\]; the first of several.
    pub fn peak_position(&self) -> [f64; 2] {
        let peak = self.peak_pressure();
        let found = self.pressure.indexed_iter().find(|(_, p)| **p >= peak);
        let (i, j) = found.map_or((0, 0), |(index, _)| index);
        [self.grid().x()[i], self.grid().y()[j]]
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
    /// contact.
    pub fn contact_extent(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|axis| {
            let lanes = self.pressure.lanes(ndarray::Axis(axis)).into_iter();
            let ends = lanes
                .filter_map(line_ends)
                .reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]);
            let first = self.grid().coordinates(axis)[0];
            let spacing = self.grid().spacing()[axis];
            ends.map_or([0.0; 2], |ends| ends.map(|end| first + spacing * end))
        })
    }
}

/// Ends of the contact on one line of cells, in cells from the centre of the first.
fn line_ends(pressure: ndarray::ArrayView1<f64>) -> Option<[f64; 2]> {
    let first = pressure.iter().position(|&p| p > 0.0)?;
    let last = pressure.iter().rposition(|&p| p > 0.0)?;
    let width = last - first + 1;
    let square = |k: usize| pressure[k] * pressure[k];
    Some([
        first as f64 - edge_beyond(|k| square(first + k), width),
        last as f64 + edge_beyond(|k| square(last - k), width),
    ])
}

/// How far the contact ends beyond the centre of its outermost cell, in cells: from p² of the cells
/// from the edge inwards, `square(k)`.
fn edge_beyond(square: impl Fn(usize) -> f64, width: usize) -> f64 {
    const OUTER_CELL: f64 = 0.5;
    // The outer two cells carry the discretisation of the edge.
    const FIRST: usize = 2;
    const POINTS: usize = 5;
    if width < 2 * (FIRST + POINTS) {
        return OUTER_CELL;
    }
    // Least squares on evenly spaced points, in orthogonal polynomials of t = −2 … 2:
    // p² = mean + slope t + bend (t² − 2).
    let half = (POINTS / 2) as f64;
    let (mut mean, mut slope, mut bend) = (0.0, 0.0, 0.0);
    for k in 0..POINTS {
        let t = k as f64 - half;
        let s = square(FIRST + k);
        mean += s / 5.0;
        slope += t * s / 10.0;
        bend += (t * t - 2.0) * s / 14.0;
    }
    // The outer zero of it: t = −2c/(slope + √…), which holds for bend = 0 too.
    let constant = mean - 2.0 * bend;
    let discriminant = slope * slope - 4.0 * bend * constant;
    if slope <= 0.0 || discriminant < 0.0 {
        return OUTER_CELL;
    }
    let zero = -2.0 * constant / (slope + discriminant.sqrt());
    let beyond = -(zero + half + FIRST as f64);
    if (-1.0..=1.0).contains(&beyond) {
        beyond
    } else {
        OUTER_CELL
    }
}
