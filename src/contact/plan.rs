//! A body on a grid, planned: coefficients, their transform, and the coarser grids.

mod datum;

use std::sync::{Arc, OnceLock};

use ndarray::{Array2, ArrayRef2};

use super::cascade::discretisation::Unresolved;
use super::cascade::levels::Levels;
use super::options::Setup;
use super::problem::INDEFINITE;
use super::problem::scale::LocalDisplacement;
use crate::compliance::convolution::{Addition, Convolution};
use crate::compliance::ends::Ends;
use crate::compliance::influence::{Method, coefficients_on};
use crate::compliance::response::Body;
use crate::compliance::traction::Tangential;
use crate::error::{Error, Result};
use crate::model::grid::Grid;
use crate::numerics::parallel::{Threads, check_memory};
use datum::Datum;

/// Arrays of a solve, as many as there are on one cell at the same time. Measured: 135 bytes a cell in all
/// where the contact fills the grid, 151 where it tilts as well, 67 where it fills a ninth.
const ARRAYS: u64 = 18;

/// What all solves on one grid share.
#[derive(Debug)]
pub(super) struct Plan {
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
}

impl Plan {
    pub(super) fn new(body: Body, grid: Grid, setup: Setup) -> Result<Self> {
        check_memory(grid.shape(), Self::memory(&grid))?;
        let ends = Ends::of(&bodies(&body, &setup));
        ends.check(&grid)?;
        if ends.any() && grid.is_periodic()[0] {
            return Err(Error::Inconsistent(
                "bodies must go on along x where the grid is periodic along x: leave out their ends",
            ));
        }
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
        })
    }

    /// The operators of tractions.
    ///
    /// # Errors
    /// Bodies without layers and substrate, and such with free ends.
    pub(super) fn tangential(&self) -> Result<Arc<Tangential>> {
        if let Some(known) = self.tangential.get() {
            return Ok(Arc::clone(known));
        }
        if self.ends.any() {
            return Err(Error::Inconsistent(crate::compliance::traction::GO_ON));
        }
        if self.grid.is_periodic() != [false; 2] {
            return Err(Error::Inconsistent(
                "friction needs a grid that is not periodic: give a wider grid",
            ));
        }
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
        }
    }

    /// Calls `work`, a whole solve, on the plan's threads.
    pub(super) fn run<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        let [nx, ny] = self.grid.shape();
        self.convolution.own_threads().run_inside(nx * ny, work)
    }

    /// Bytes that a plan with its coefficients, and the arrays of one solve take.
    pub(super) fn memory(grid: &Grid) -> u64 {
        let [nx, ny] = grid.shape();
        Convolution::memory(grid.shape()) + (nx as u64 * ny as u64) * 8 * ARRAYS
    }
}

/// The two bodies, or the one that is not rigid.
pub(super) fn bodies<'a>(body: &'a Body, setup: &'a Setup) -> Vec<&'a Body> {
    [Some(body), setup.counterbody.as_ref()].into_iter().flatten().collect()
}

/// Coefficients of body and counterbody together with which a contact on `grid` is solved beside the `additions` of
/// free ends, and their datum.
///
/// # Errors
/// [`INDEFINITE`] where the coefficients show that they are not positive definite.
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
        return Err(INDEFINITE);
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
    let (name, expected) = ("coefficients", grid.shape());
    let found @ [nx, ny] = [coefficients.nrows(), coefficients.ncols()];
    if found != expected {
        return Err(Error::Shape { name, expected, found });
    }
    if let Some((index, _)) = coefficients.indexed_iter().find(|(_, c)| !c.is_finite()) {
        return Err(Error::NonFinite { name, index: index.into() });
    }
    let [along_x, along_y] = grid.is_periodic();
    let image = |i: usize, n: usize, repeats: bool| if repeats { (n - i) % n } else { i };
    let uneven = |((i, j), c): ((usize, usize), &f64)| {
        let same = coefficients[[image(i, nx, along_x), image(j, ny, along_y)]];
        (c - same).abs() > UNEVEN * coefficients[[0, 0]].abs()
    };
    if coefficients.indexed_iter().any(uneven) {
        return Err(Error::Inconsistent(
            "coefficients must be the same at the offsets d and n - d along a direction in which a grid of n cells repeats",
        ));
    }
    Ok(())
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
