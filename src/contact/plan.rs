//! A body on a grid, planned: coefficients, their transform, and the coarser grids.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use ndarray::{Array2, ArrayRef2};

use crate::compliance::convolution::{Addition, Convolution};
use crate::compliance::ends::Ends;
use crate::compliance::influence::{Method, coefficients_on};
use crate::compliance::response::{Body, refuse_free};
use crate::compliance::traction::Tangential;
use crate::contact::cascade::Levels;
use crate::contact::cascade::discretisation::Unresolved;
use crate::contact::options::Setup;
use crate::contact::problem::LocalDisplacement;
use crate::contact::solver::linear_cg;
use crate::error::{Error, Result, all_finite, refuse_if, same_shape};
use crate::model::grid::Grid;
use crate::numerics::parallel::{Threads, check_memory};

/// Arrays of a solve, as many as there are on one cell at the same time. Measured: 135 bytes a cell in all
/// where the contact fills the grid, 151 where it tilts as well, 67 where it fills a ninth.
const ARRAYS: u64 = 18;

/// Arrays of a solve after the first one, whose memory the plan keeps. Measured: 46 bytes a cell.
const LATER_ARRAYS: u64 = 7;

/// Arrays that a hardness adds. Measured: 40 bytes a cell.
const YIELDING_ARRAYS: u64 = 5;

/// Arrays that free ends add to the plan and to each workspace. Measured: 68 bytes a cell.
const ENDS_ARRAYS: u64 = 9;

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
pub struct Contact {
    pub(super) body: Body,
    pub(super) grid: Grid,
    pub(super) setup: Setup,
    pub(super) convolution: Convolution,
    pub(super) levels: Levels,
    pub(super) local: LocalDisplacement,
    pub(super) datum: Datum,
    pub(super) unresolved: Unresolved,
    pub(super) ends: Ends,
    /// Operators of tractions, made when friction first needs them.
    pub(super) tangential: OnceLock<Arc<Tangential>>,
    /// Whether a solve has begun, whose memory the plan keeps.
    worked: AtomicBool,
}

impl Contact {
    /// Plans contacts of `body` on `grid`.
    ///
    /// # Errors
    /// Given coefficients that do not suit the grid, no threads, or too little memory.
    pub fn plan(body: impl Into<Body>, grid: Grid, setup: Setup) -> Result<Self> {
        let body = body.into();
        if grid.is_periodic() != [true; 2] {
            for body in bodies(&body, &setup) {
                refuse_free(&**body, "bodies on a grid that is not periodic along x and along y")?;
            }
        }
        let ends = Ends::of(&bodies(&body, &setup));
        check_memory(grid.shape(), Self::memory(&grid, &ends))?;
        ends.check(&grid)?;
        refuse_if(
            ends.any() && grid.is_periodic()[0],
            "bodies must go on along x where the grid is periodic along x: leave out their ends",
        )?;
        let threads = Arc::new(Threads::new(setup.threads)?);
        let additions = ends.additions(&grid, &grid, &threads)?;
        let (finest, datum) = operator(&body, &setup, &grid, &additions, &threads)?;
        let convolution =
            Convolution::plan_repeated(&finest, grid.is_periodic(), Arc::clone(&threads))?
                .plus(additions);
        let levels = Levels::plan(grid, finest, &convolution, |coarse| {
            let coefficients = total_coefficients(&body, &setup, coarse, &threads)?;
            let local = LocalDisplacement::new(&bodies(&body, &setup), coarse);
            let additions = ends.additions(coarse, &grid, &threads)?;
            Ok((datum.moved(coefficients, coarse), additions, local))
        })?;
        let local = LocalDisplacement::new(&bodies(&body, &setup), &grid);
        let unresolved = Unresolved::new(&bodies(&body, &setup), &grid);
        Ok(Self {
            body,
            grid,
            setup,
            convolution,
            levels,
            local,
            datum,
            unresolved,
            ends,
            tangential: OnceLock::new(),
            worked: AtomicBool::new(false),
        })
    }

    /// The body that shapes are pressed into.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The setup that was planned: counterbody, given coefficients and threads.
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The convolution with the influence coefficients of both bodies together. In a line contact whose
    /// coefficients are not positive definite with the datum of [`Grid::line`], it has a farther datum, which
    /// raises the displacement everywhere by the same; solutions have the datum of the grid.
    pub fn convolution(&self) -> &Convolution {
        &self.convolution
    }

    /// The operators of tractions, made when they are first needed.
    ///
    /// # Errors
    /// Bodies without layers and substrate, and such with free ends.
    pub(crate) fn tangential(&self) -> Result<Arc<Tangential>> {
        if let Some(known) = self.tangential.get() {
            return Ok(Arc::clone(known));
        }
        refuse_if(self.ends.any(), crate::compliance::traction::GO_ON)?;
        refuse_if(
            self.grid.is_periodic() != [false; 2],
            "friction needs a grid that is not periodic: give a wider grid",
        )?;
        let counterbody = self.setup.counterbody.as_ref();
        let threads = Arc::new(Threads::new(Some(self.convolution.threads()))?);
        let new = Tangential::plan(&self.body, counterbody, &self.grid, &threads)?;
        Ok(Arc::clone(self.tangential.get_or_init(|| Arc::new(new))))
    }

    /// This plan on other threads; all large arrays are shared.
    pub(super) fn on_threads(&self, threads: &Arc<Threads>) -> Self {
        let convolution = self.convolution.on_threads(threads);
        Self {
            body: self.body.clone(),
            grid: self.grid,
            setup: self.setup.clone(),
            levels: self.levels.beside(&convolution),
            unresolved: self.unresolved,
            convolution,
            local: self.local.clone(),
            datum: self.datum,
            ends: self.ends.clone(),
            tangential: self.tangential.clone(),
            worked: AtomicBool::new(false),
        }
    }

    /// Calls `work`, a whole solve, on the plan's threads.
    pub(crate) fn run<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        let [nx, ny] = self.grid.shape();
        self.convolution.own_threads().run_inside(nx * ny, work)
    }

    /// Bytes that a plan with its coefficients, and the arrays of one solve take between free `ends`.
    fn memory(grid: &Grid, ends: &Ends) -> u64 {
        let of_ends = if ends.any() { ENDS_ARRAYS } else { 0 };
        Convolution::memory(grid.shape()) + array(grid) * (ARRAYS + of_ends)
    }

    /// Bytes of this plan and the arrays of one solve.
    pub(super) fn own_memory(&self) -> u64 {
        Self::memory(&self.grid, &self.ends)
    }

    /// Checks that there is memory for a solve, of surfaces that yield where they have a hardness.
    ///
    /// # Errors
    /// Too little memory.
    pub(super) fn check_memory_of_solve(&self, yields: bool) -> Result<()> {
        let arrays = match self.worked.swap(true, Ordering::Relaxed) {
            true => LATER_ARRAYS,
            false if self.ends.any() => ARRAYS + ENDS_ARRAYS,
            false => ARRAYS,
        };
        let of_hardness = if yields { YIELDING_ARRAYS } else { 0 };
        check_memory(self.grid.shape(), array(&self.grid) * (arrays + of_hardness))
    }
}

/// Bytes of an array of the cells of `grid`.
fn array(grid: &Grid) -> u64 {
    let [nx, ny] = grid.shape();
    8 * nx as u64 * ny as u64
}

/// The two bodies, or the one that is not rigid.
pub(super) fn bodies<'a>(body: &'a Body, setup: &'a Setup) -> Vec<&'a Body> {
    [Some(body), setup.counterbody.as_ref()].into_iter().flatten().collect()
}

/// Coefficients of body and counterbody together with which a contact on `grid` is solved beside the `additions` of
/// free ends, and their datum.
///
/// # Errors
/// [`Error::Indefinite`] where the coefficients show that they are not positive definite.
pub(super) fn operator(
    body: &Body,
    setup: &Setup,
    grid: &Grid,
    additions: &[Addition],
    threads: &Arc<Threads>,
) -> Result<(Array2<f64>, Datum)> {
    let coefficients = match &setup.coefficients {
        Some(given) => {
            check_coefficients(given, grid)?;
            given.to_owned()
        }
        None => total_coefficients(body, setup, grid, threads)?,
    };
    let datum = Datum::find(&bodies(body, setup), grid, (&coefficients, additions), threads)?;
    let coefficients = datum.moved(coefficients, grid);
    // No coefficient of a positive definite operator is larger than that of the loaded cell.
    let own = coefficients[[0, 0]];
    let larger = |c: &f64| c.abs() > own;
    if setup.coefficients.is_some() && (own <= 0.0 || coefficients.iter().any(larger)) {
        return Err(Error::Indefinite);
    }
    Ok((coefficients, datum))
}

/// Largest difference between given coefficients that are the same on a grid that repeats, relative to that of the loaded
/// cell: rounding.
const UNEVEN: f64 = 1e-9;

/// Checks given coefficients.
///
/// # Errors
/// Another shape than the grid, a coefficient that is not finite, and coefficients that do not repeat where the grid does.
pub(super) fn check_coefficients(coefficients: &ArrayRef2<f64>, grid: &Grid) -> Result<()> {
    same_shape("coefficients", coefficients, grid.shape())?;
    all_finite("coefficients", coefficients)?;
    let ([nx, ny], [along_x, along_y]) = (grid.shape(), grid.is_periodic());
    let image = |i: usize, n: usize, repeats: bool| if repeats { (n - i) % n } else { i };
    let uneven = |((i, j), c): ((usize, usize), &f64)| {
        let same = coefficients[[image(i, nx, along_x), image(j, ny, along_y)]];
        (c - same).abs() > UNEVEN * coefficients[[0, 0]].abs()
    };
    refuse_if(
        coefficients.indexed_iter().any(uneven),
        "coefficients must be the same at the offsets d and n - d along a direction in which a grid of n cells repeats",
    )
}

/// Exact influence coefficients of body and counterbody together.
fn total_coefficients(
    body: &Body,
    setup: &Setup,
    grid: &Grid,
    threads: &Threads,
) -> Result<Array2<f64>> {
    let mut coefficients = coefficients_on(&**body, grid, Method::Exact, threads)?;
    if let Some(counterbody) = &setup.counterbody {
        coefficients += &coefficients_on(&**counterbody, grid, Method::Exact, threads)?;
    }
    Ok(coefficients)
}

/// Factor between data that are tried.
const FARTHER: f64 = 10.0;

/// Number of data that are tried: far more than the stiffest layers need, whose reach is the thickness times
/// the cube root of the ratio of moduli.
const TRIALS: i32 = 15;

/// Residual of the linear system. The error of the sum that is found is its square.
const TOLERANCE: f64 = 1e-6;

/// The datum that line contacts are solved with: where the displacement is 0.
///
/// In plane strain the displacement grows as A/π ln(1/y) with the distance y from the load, where A belongs
/// to the substrates, so that it is counted from that of the bare substrate at a distance, the datum. Users
/// see the datum at the width of the grid ([`Grid::line`]). Below a stiff layer that is wider than the grid
/// the true displacement at this distance is far less: pressures would lift the surface, and the operator
/// would not be positive definite. Such contacts are solved with a farther datum ℓ'. Under a load W this
/// changes no pressure, and displacement and approach by the same A W/π ln(ℓ'/ℓ), which is taken back in the
/// end. The method was derived here.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Datum {
    /// A of both bodies \[1/Pa\], over the period where a grid repeats in one direction; 0 where there is no datum.
    compliance: f64,
    /// ℓ' \[m\].
    distance: f64,
    /// Width ℓ of the grid \[m\].
    width: f64,
    /// Datum from which on the operator is positive definite \[m\]; 0 where that of the grid does.
    least: f64,
    /// Whether a uniform pressure displaces nothing, as on a grid that repeats in both directions on an elastic base: a
    /// prescribed approach is that of the mean plane of the deformed surface.
    pub(super) floats: bool,
}

/// Mean of coefficients, relative to that of their magnitudes, which is rounding.
const ROUNDING: f64 = 1e-12;

impl Datum {
    /// Finds the datum for the `coefficients` of `bodies` together on `grid`, and what their free ends add.
    ///
    /// # Errors
    /// [`Error::Indefinite`] where the operator is not positive definite with any datum.
    pub(crate) fn find(
        bodies: &[&Body],
        grid: &Grid,
        (coefficients, additions): (&Array2<f64>, &[Addition]),
        threads: &Arc<Threads>,
    ) -> Result<Self> {
        let Some(open) = open_direction(grid) else {
            let magnitude: f64 = coefficients.iter().map(|c| c.abs()).sum();
            let displaced = coefficients.sum().abs() > ROUNDING * magnitude;
            return Ok(Self {
                floats: grid.is_periodic() == [true; 2] && !displaced,
                ..Self::default()
            });
        };
        let (width, period) = (grid.size()[open], grid.size()[1 - open]);
        let period = if grid.is_line() { 1.0 } else { period };
        let compliance: f64 = bodies.iter().map(|body| body.asymptotes().long).sum();
        let near =
            Self { compliance: compliance / period, distance: width, width, ..Self::default() };
        let homogeneous = bodies.iter().all(|body| body.lengths().is_none());
        if (homogeneous && additions.is_empty()) || near.compliance <= 0.0 {
            return Ok(near);
        }
        for trial in 0..TRIALS {
            let datum = Self { distance: width * FARTHER.powi(trial), ..near };
            let moved = datum.moved(coefficients.clone(), grid);
            let total = total_pressure((&moved, additions), grid, threads)?;
            let Some(total) = total.filter(|&total| total > 0.0) else {
                continue;
            };
            if trial == 0 {
                return Ok(near);
            }
            // K − s 1ᵀ1 is positive definite as long as s 1ᵀK⁻¹1 < 1.
            let nearer = PI / (near.compliance * grid.cell_area() * total);
            return Ok(Self {
                distance: FARTHER * datum.distance,
                least: datum.distance * (-nearer).exp(),
                ..near
            });
        }
        Err(Error::Indefinite)
    }

    /// Coefficients on `grid`, whose datum is its own width, with this datum.
    pub(crate) fn moved(&self, mut coefficients: Array2<f64>, grid: &Grid) -> Array2<f64> {
        if let Some(open) = open_direction(grid)
            && self.compliance > 0.0
        {
            let width = grid.size()[open];
            coefficients += self.compliance * grid.cell_area() / PI * (self.distance / width).ln();
        }
        coefficients
    }

    /// Displacement per load per length \[m²/N\] by which this datum raises displacement and approach.
    pub(crate) fn raise(&self) -> f64 {
        if self.compliance > 0.0 {
            self.compliance / PI * (self.distance / self.width).ln()
        } else {
            0.0
        }
    }

    /// An error where an `approach` cannot be prescribed to a shape with these gaps, less the approach.
    ///
    /// # Errors
    /// [`Error::FullContact`] where the mean of the gaps, which no pressure changes, would be 0 or less.
    pub(crate) fn check_gap(&self, approach: f64, gap: &Array2<f64>) -> Result<()> {
        let mean = gap.sum() / gap.len() as f64;
        match self.floats && mean <= 0.0 {
            true => Err(Error::FullContact { approach, most: approach + mean }),
            false => Ok(()),
        }
    }

    /// An error where an approach cannot be prescribed.
    ///
    /// # Errors
    /// [`Error::Datum`] where the operator is not positive definite with the datum of the grid.
    pub(crate) fn check_approach(&self) -> Result<()> {
        if self.least > 0.0 {
            return Err(Error::Datum {
                width: self.width,
                // The wider the grid, the farther its datum must lie, by a quarter of the width at last.
                needed: 2.0 * self.least,
            });
        }
        Ok(())
    }
}

/// The direction across a line contact, or the open one of a grid that repeats along the other.
fn open_direction(grid: &Grid) -> Option<usize> {
    match grid.is_periodic() {
        _ if grid.is_line() => Some(1),
        [true, false] => Some(1),
        [false, true] => Some(0),
        _ => None,
    }
}

/// Sum of the pressure that displaces all cells by 1 \[1/m\], 1ᵀK⁻¹1. It is above 0 where K, which is
/// positive definite for pressures of sum 0, is so for all; `None` where the system shows that it is not.
fn total_pressure(
    (coefficients, additions): (&Array2<f64>, &[Addition]),
    grid: &Grid,
    threads: &Arc<Threads>,
) -> Result<Option<f64>> {
    let repeats = grid.is_periodic();
    let convolution = Convolution::plan_repeated(coefficients, repeats, Arc::clone(threads))?;
    let convolution = convolution.plus(additions.to_vec());
    let inverse = convolution.approximation(coefficients, repeats).inverse;
    let [mut first, mut second] = [convolution.workspace(), convolution.workspace()];
    let pressure = linear_cg::solve(
        &vec![1.0; coefficients.len()],
        |input, out| convolution.apply_slices(input, out, &mut first),
        |input, out| inverse.apply_slices(input, out, &mut second),
        TOLERANCE,
        &mut || ControlFlow::Continue(()),
    );
    Ok(pressure.ok().map(|pressure| pressure.iter().sum()))
}
