//! Methods of computing influence coefficients, and the conversion of Spinu et al.: sample the response, transform it
//! back, keep the middle.
//!
//! 1. A mesh of step Δ, N points and refinement χ is chosen: 2χN points in each direction, of
//!    which the spectral step is 2π/(2χNΔ). (The paper prints 2π/(NΔ).)
//! 2. Its nodes, 3. the response there, 4. in wrap-around order,
//! 5. inverse FFT, of which the middle 2N points are kept: by symmetry, N offsets ≥ 0.

use std::f64::consts::PI;

use ndarray::{Array2, Zip};

use crate::compliance::kernel::quadrature::Rules;
use crate::compliance::kernel::rectangle::potential;
use crate::compliance::response::Response;
use crate::error::{Error, Result};
use crate::model::grid::Grid;
use crate::numerics::fft::inverse_even;
use crate::numerics::parallel::{Threads, check_memory};

/// Method by which the frequency response becomes influence coefficients.
///
/// Two relative errors are given for each, at the loaded cell and the largest at any offset, for
/// E1/E2 = 4, h = 8 dx on a square of 64² cells and χ = 4.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum Method {
    /// Closed forms, and radial tables of what they leave: no aliasing, for any thickness of layer
    /// and any shape of cell. Relative error below 1e-9.
    #[default]
    Exact,
    /// The response alone, sampled: a point load cut off at the Nyquist frequency. 7e-4 and 6e-2;
    /// goes wrong on long thin domains.
    Plain {
        /// Refinement χ of the spectral mesh.
        refinement: usize,
    },
    /// Love's closed form for the surface material, and the sampled rest of the response times the
    /// transform of the cell. 6e-4 and 4e-2; goes wrong on long thin domains, where the rest, which
    /// falls off like the substrate's 1/r, meets its periodic images (by 3 % at the loaded cell of
    /// the roller of Spinu et al.).
    Difference {
        /// Refinement χ of the spectral mesh.
        refinement: usize,
    },
    /// `Difference`, with an image potential in closed form that takes the rest's 1/α singularity. 1e-5
    /// and 1e-3; needs layers thicker than a cell.
    Image {
        /// Refinement χ of the spectral mesh.
        refinement: usize,
    },
    /// The response, sampled at the wave numbers of a grid that is periodic in both directions: exact for pressures that
    /// are sums of these waves, as other programs for periodic contacts take them.
    Spectral,
}

/// Bytes that the coefficients of a grid take.
pub(crate) fn memory(grid: &Grid) -> u64 {
    let [nx, ny] = grid.shape().map(|n| n as u64);
    8 * nx * ny
}

/// Coefficients in the shape of `grid` \[m/Pa\], without the local compliance.
pub(super) fn coefficients(
    body: &dyn Response,
    grid: &Grid,
    method: Method,
    refinement: usize,
    threads: &Threads,
) -> Result<Array2<f64>> {
    let (mesh, [dx, dy]) = (points(grid, refinement)?, grid.spacing());
    let step = [2.0 * PI / (mesh[0] as f64 * dx), 2.0 * PI / (mesh[1] as f64 * dy)];
    let limits = body.asymptotes();
    let rest = limits.long - limits.short;
    let mean = mean_of_inverse(step);
    let image_depth = 2.0 * body.lengths().map_or(0.0, |[_, longest]| longest);

    let (zero, with_cell): (f64, bool) = match method {
        Method::Difference { .. } => (rest * mean + limits.constant, true),
        Method::Image { .. } => (limits.constant + rest * image_depth, true),
        Method::Plain { .. } | Method::Exact | Method::Spectral => {
            (limits.long * mean + limits.constant, false)
        }
    };
    let value = |k: usize, l: usize| {
        if k == 0 && l == 0 {
            return zero;
        }
        let (m, n) = (k as f64 * step[0], l as f64 * step[1]);
        let alpha = m.hypot(n);
        let response = body.normal(alpha);
        let sampled = match method {
            Method::Difference { .. } => response - limits.short,
            Method::Image { .. } => response - limits.short - rest * (-alpha * image_depth).exp(),
            Method::Plain { .. } | Method::Exact | Method::Spectral => response,
        } / alpha;
        if with_cell { sampled * sinc(0.5 * m * dx) * sinc(0.5 * n * dy) } else { sampled }
    };
    let mut coefficients = inverse_even(grid.shape(), mesh, value, threads);
    let (rules, half) = (Rules::displacement(), [0.5 * dx, 0.5 * dy]);
    let mut add_potential = |strength: f64, depth: f64| {
        threads.run(|| {
            Zip::indexed(&mut coefficients).par_for_each(|(i, j), c| {
                let at = [i as f64 * dx, j as f64 * dy];
                *c += strength / (2.0 * PI) * potential(&rules, half, at, depth);
            });
        });
    };
    if with_cell {
        add_potential(limits.short, 0.0);
    }
    if matches!(method, Method::Image { .. }) {
        add_potential(rest, image_depth);
    }
    Ok(coefficients)
}

/// Points of the mesh along x and along y.
///
/// # Errors
/// More than can be counted, or than there is memory for.
fn points(grid: &Grid, refinement: usize) -> Result<[usize; 2]> {
    let too_fine = || Error::Parameter {
        name: "refinement",
        requirement: "small enough for the number of points to be counted",
        value: refinement as f64,
    };
    let shape = grid.shape();
    let mut mesh = [0; 2];
    for (points, n) in mesh.iter_mut().zip(shape) {
        *points = n.checked_mul(2).and_then(|n| n.checked_mul(refinement)).ok_or_else(too_fine)?;
    }
    let half_spectrum = (mesh[1] / 2 + 1).checked_mul(8 * shape[0]).ok_or_else(too_fine)?;
    check_memory(shape, memory(grid) + half_spectrum as u64)?;
    Ok(mesh)
}

fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sin() / x }
}

/// Mean of 1/α over a spectral cell around zero.
///
/// ```text
/// 2 [dm asinh(dn/dm) + dn asinh(dm/dn)] / (dm dn)
/// ```
fn mean_of_inverse([dm, dn]: [f64; 2]) -> f64 {
    2.0 * ((dn / dm).asinh() / dn + (dm / dn).asinh() / dm)
}
