//! Options of a plan and of a solve, and what is asked of the rigid motion.

use ndarray::{ArcArray2, Array2};

use super::problem::bounds::Hardness;
use super::problem::springs::Compliance;
use crate::compliance::response::Body;
use crate::error::{Result, fraction, require};

/// Options of a plan, beside body and grid.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Setup {
    /// Body that carries the shape; `None` is rigid.
    pub counterbody: Option<Body>,
    /// Influence coefficients (nx, ny) \[m/Pa\] of both bodies together, with which contacts are solved, such as those of
    /// another [`Method`](crate::influence::Method). Default: the exact ones of the bodies, from which solves also start
    /// on coarser grids where others are given.
    pub coefficients: Option<ArcArray2<f64>>,
    /// Threads of the plan. Default: all of the machine's, or fewer where an environment variable says so:
    /// `NACRE_NUM_THREADS`, else `RAYON_NUM_THREADS`, else `OMP_NUM_THREADS`.
    pub threads: Option<usize>,
}

builders! {
    Setup {
        with_coefficients(coefficients: impl Into<Option<ArcArray2<f64>>>),
        with_threads(threads: impl Into<Option<usize>>),
    }
}

impl Setup {
    /// This, with a counterbody that carries the shape.
    #[must_use]
    pub fn with_counterbody(mut self, counterbody: impl Into<Body>) -> Self {
        self.counterbody = Some(counterbody.into());
        self
    }
}

/// Algorithm that a solve starts with; [`Report::solver`](super::Report::solver) says which one ended it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Algorithm {
    /// Preconditioned conjugate gradients on nested grids, in a window around the contact.
    #[default]
    Cascade,
    /// The constrained conjugate gradients of Polonsky & Keer, which Spinu et al. use, as a reference.
    PolonskyKeer,
}

/// Options of a solve: where it starts and when it ends.
///
/// ```
/// let options = nacre::Options::default().with_tolerance(1e-10).with_max_iterations(500);
/// assert_eq!(options.max_iterations, Some(500));
/// ```
///
/// As options may gain fields, other crates do not write them as literals:
///
/// ```compile_fail,E0639
/// let options = nacre::Options { tolerance: 1e-10, ..nacre::Options::default() };
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// Largest residual and overlap of a converged solution. Default: 1e-8.
    pub tolerance: f64,
    /// Iterations after which to give up. Default: 10 000.
    pub max_iterations: Option<usize>,
    /// Algorithm that the solve starts with. Default: [`Algorithm::Cascade`].
    pub algorithm: Algorithm,
    /// Pressure to start from (nx, ny) \[Pa\]. Default: uniform.
    pub initial: Option<Array2<f64>>,
    /// Largest pressure that the surfaces carry. Default: they do not yield.
    pub hardness: Option<Hardness>,
    /// Compliance of springs between the surfaces, one in each cell: a bed, soft asperities. Default: none.
    pub compliance: Option<Compliance>,
    /// Permanent indentation (nx, ny) \[m\] that the surfaces have already: that of the solution before, in a
    /// history of loads. Default: none.
    pub indentation: Option<Array2<f64>>,
    /// Largest number of cells of a grid that is chosen, at least 4096. Where the peak pressure needs more, the solution
    /// has a warning. Default: 2²², which take 0.7 GB.
    pub cells: Option<usize>,
}

builders! {
    Options {
        with_tolerance(tolerance: f64),
        with_max_iterations(max_iterations: impl Into<Option<usize>>),
        with_algorithm(algorithm: Algorithm),
        with_initial(initial: impl Into<Option<Array2<f64>>>),
        with_hardness(hardness: impl Into<Option<Hardness>>),
        with_compliance(compliance: impl Into<Option<Compliance>>),
        with_indentation(indentation: impl Into<Option<Array2<f64>>>),
        with_cells(cells: impl Into<Option<usize>>),
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tolerance: 1e-8,
            max_iterations: None,
            algorithm: Algorithm::default(),
            initial: None,
            hardness: None,
            compliance: None,
            indentation: None,
            cells: None,
        }
    }
}

/// Default of [`Options::cells`].
const LARGEST_GRID: usize = 1 << 22;

/// Least of [`Options::cells`]: with fewer along an axis there is no coarser grid, and no estimate of the error.
pub(crate) const SMALLEST_GRID: usize = 64 * 64;

/// Default of [`Options::max_iterations`]: far above the 10 … 300 that solvable problems take.
const MAX_ITERATIONS: usize = 10_000;

impl Options {
    /// The criteria that end an iteration, checked.
    pub(super) fn stop_criteria(&self) -> Result<StopCriteria> {
        Ok(StopCriteria {
            tolerance: fraction("tolerance", self.tolerance)?,
            max_iterations: self.max_iterations.unwrap_or(MAX_ITERATIONS),
        })
    }

    /// Whether hardness and springs are the same at all places, which have no dents.
    pub(super) fn is_uniform(&self) -> bool {
        !matches!(self.hardness, Some(Hardness::Cells(_)))
            && !matches!(self.compliance, Some(Compliance::Cells(_)))
            && self.indentation.is_none()
    }

    /// The largest number of cells of a grid that is chosen, checked.
    pub(super) fn largest_grid(&self) -> Result<usize> {
        let most = self.cells.unwrap_or(LARGEST_GRID);
        require("cells", most as f64, most >= SMALLEST_GRID, "at least 4096")?;
        Ok(most)
    }
}

/// Conditions that end an iteration.
#[derive(Debug, Clone, Copy)]
pub(super) struct StopCriteria {
    pub(super) tolerance: f64,
    pub(super) max_iterations: usize,
}

/// Prescribed and loaded degrees of freedom of the rigid motion (δ, s_x, s_y) in
/// g = h + u − δ − s_x x − s_y y.
///
/// Each of the three is prescribed or loaded. Exactly one of `load` and `approach` is given; along x and
/// along y at most one of `eccentricity` (which needs a load), `moment` and `tilt`. A direction without
/// any of them has a tilt of 0. Lengths and moments are about the origin x = y = 0.
///
/// ```
/// use nacre::Motion;
/// // Free to tilt along x only, under a force at x = 2.87 mm.
/// let motion = Motion::load(1e3).with_eccentricity([Some(2.87e-3), None]);
/// assert_eq!(motion.load, Some(1e3));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[non_exhaustive]
pub struct Motion {
    /// Force Σ p dA \[N\], above 0.
    pub load: Option<f64>,
    /// Approach δ \[m\] of the origin, from the datum h = 0.
    pub approach: Option<f64>,
    /// Point (e_x, e_y) at which the load acts \[m\]: Σ p x dA = W e_x, along y alike.
    pub eccentricity: [Option<f64>; 2],
    /// First moments of the pressure \[N m\]: Σ p x dA = M_x, along y alike.
    pub moment: [Option<f64>; 2],
    /// Slopes s_x, s_y.
    pub tilt: [Option<f64>; 2],
}

builders! {
    Motion {
        with_load(load: impl Into<Option<f64>>),
        with_approach(approach: impl Into<Option<f64>>),
        with_eccentricity(eccentricity: [Option<f64>; 2]),
        with_moment(moment: [Option<f64>; 2]),
        with_tilt(tilt: [Option<f64>; 2]),
    }
}

impl Motion {
    /// A force `load` \[N\], with both tilts locked at 0.
    pub fn load(load: f64) -> Self {
        Self { load: Some(load), ..Self::default() }
    }

    /// This motion, with what it leaves open as in one `before`: load or approach, and on each axis the eccentricity,
    /// moment or tilt.
    pub(crate) fn after(mut self, before: &Self) -> Self {
        if self.load.is_none() && self.approach.is_none() {
            (self.load, self.approach) = (before.load, before.approach);
        }
        for axis in 0..2 {
            let rotation = [self.eccentricity[axis], self.moment[axis], self.tilt[axis]];
            if rotation == [None; 3] {
                self.eccentricity[axis] = before.eccentricity[axis];
                self.moment[axis] = before.moment[axis];
                self.tilt[axis] = before.tilt[axis];
            }
        }
        self
    }

    /// Whether the shape is neither tilted nor loaded beside the origin.
    pub(crate) fn is_centred(&self) -> bool {
        let rotations = [self.eccentricity, self.moment, self.tilt];
        rotations.as_flattened().iter().flatten().all(|value| value.abs() <= 0.0)
    }

    /// A prescribed `approach` \[m\], with both tilts locked at 0.
    pub fn approach(approach: f64) -> Self {
        Self { approach: Some(approach), ..Self::default() }
    }
}
