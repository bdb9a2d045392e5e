//! Influence coefficients: the displacement of cell centres under uniform pressure on one cell.
//!
//! ```text
//! C[i, j] = 1/4π² ∬ û/p̂(α) · sin(m dx/2)/(m/2) · sin(n dy/2)/(n/2) · e^{i(m i dx + n j dy)} dm dn
//! ```
//!
//! [`Method::Exact`] evaluates it without aliasing. The other methods sample the frequency
//! response and transform it back, as Spinu et al. do: they cost an inverse FFT of χ² times as many
//! points, and carry the errors that their descriptions state.

use ndarray::{Array2, Zip};

use crate::compliance::response::{Body, Response, check, refuse_free};
use crate::error::{Error, Result, require};
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;
use crate::numerics::parallel::{Threads, check_memory};

mod conversion;
mod exact;
mod periodic;

pub use conversion::Method;
pub(crate) use conversion::memory;
pub use exact::CellInfluence;
pub(crate) use periodic::PlateWaves;

/// Coefficients `C[i, j]` \[m/Pa\] of offsets (i dx, j dy) ≥ 0, in the shape (nx, ny) of `grid`.
///
/// C is even in both offsets. A local compliance of the body is part of `C[0, 0]`.
///
/// # Errors
/// Where a refinement is 0, there is too little memory, or the body's response contradicts itself; a plate with a free
/// base on a grid that is not periodic along x and along y, or with cells of more than four times its thickness.
///
/// ```
/// use nacre::influence::{Method, influence_coefficients};
/// let steel = nacre::Elastic::new(210e9, 0.3)?;
/// let grid = nacre::Grid::new([8, 8], [8.0, 8.0])?;
/// let c = influence_coefficients(&steel, &grid, Method::Exact)?;
/// // Mean of 1/r over a unit square, from its centre: 4 asinh(1)
/// let loaded = 4.0 * 1.0_f64.asinh() / (std::f64::consts::PI * steel.plane_strain_modulus());
/// assert!((c[[0, 0]] / loaded - 1.0).abs() < 1e-14);
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn influence_coefficients(
    body: impl Into<Body>,
    grid: &Grid,
    method: Method,
) -> Result<Array2<f64>> {
    check_memory(grid.shape(), memory(grid))?;
    coefficients_on(&*body.into(), grid, method, &Threads::new(None)?)
}

/// Coefficients on a `grid` that repeats along y alone, at any `offsets` along x of at least a cell, with the datum at a
/// distance: (offsets, ny/2 + 1).
pub(crate) fn coefficients_apart(
    body: &HalfSpace,
    grid: &Grid,
    (offsets, datum): (&[f64], f64),
    threads: &Threads,
) -> Result<Array2<f64>> {
    periodic::apart(&*Body::from(body), grid, (offsets, datum), threads)
}

/// [`influence_coefficients`] on given threads, memory having been checked.
pub(crate) fn coefficients_on(
    body: &dyn Response,
    grid: &Grid,
    method: Method,
    threads: &Threads,
) -> Result<Array2<f64>> {
    if grid.is_periodic() != [true; 2] {
        refuse_free(body, "bodies on a grid that is not periodic along x and along y")?;
    }
    check(body)?;
    unchecked_coefficients(body, grid, method, threads)
}

/// [`coefficients_on`] for a response that may be negative, as derivatives of responses are.
pub(crate) fn unchecked_coefficients(
    body: &dyn Response,
    grid: &Grid,
    method: Method,
    threads: &Threads,
) -> Result<Array2<f64>> {
    let mut coefficients = match method {
        Method::Exact if grid.is_line() => exact::strip_coefficients(body, grid, threads)?,
        Method::Exact if grid.is_periodic() != [false; 2] => {
            periodic::coefficients(body, grid, threads)?
        }
        Method::Spectral => periodic::sampled(body, grid, threads)?,
        _ if grid.is_periodic() != [false; 2] => {
            return Err(Error::Inconsistent(
                "method must be \"exact\" or \"spectral\" on a periodic grid",
            ));
        }
        _ if grid.is_line() => {
            return Err(Error::Inconsistent(
                "method must be \"exact\" on the grid of a line contact",
            ));
        }
        Method::Exact => {
            let spacing @ [dx, dy] = grid.spacing();
            let [lx, ly] = grid.size();
            let cell =
                CellInfluence::plan_on(body, spacing, exact::WHOLE_CELLS, lx.hypot(ly), threads)?;
            let mut coefficients = Array2::zeros(grid.shape());
            threads.run(|| {
                Zip::indexed(&mut coefficients).par_for_each(|(i, j), c| {
                    *c = cell.at_distance([i as f64 * dx, j as f64 * dy]);
                });
            });
            coefficients
        }
        Method::Plain { refinement }
        | Method::Difference { refinement }
        | Method::Image { refinement } => {
            require("refinement", refinement as f64, refinement > 0, "at least 1")?;
            conversion::coefficients(body, grid, method, refinement, threads)?
        }
    };
    coefficients[[0, 0]] += body.local();
    Ok(coefficients)
}
