//! The conversion of Spinu et al.: sample the response, transform it back, keep the middle.
//!
//! 1. A mesh of step Δ, N points and refinement χ is chosen: 2χN points in each direction, of
//!    which the spectral step is 2π/(2χNΔ). (The paper prints 2π/(NΔ).)
//! 2. Its nodes, 3. the response there, 4. in wrap-around order,
//! 5. inverse FFT, of which the middle 2N points are kept: by symmetry, N offsets ≥ 0.

use std::f64::consts::PI;

use ndarray::Array2;
use rayon::prelude::*;

use super::method::{Method, memory};
use crate::compliance::kernel::quadrature::Rules;
use crate::compliance::kernel::rectangle::potential;
use crate::compliance::response::Response;
use crate::error::{Error, Result};
use crate::model::grid::Grid;
use crate::numerics::fft::inverse_even;
use crate::numerics::parallel::Threads;
use crate::numerics::parallel::check_memory;

/// Coefficients in the shape of `grid` \[m/Pa\], without the local compliance.
pub(super) fn coefficients(
    body: &dyn Response,
    grid: &Grid,
    method: Method,
    refinement: usize,
    threads: &Threads,
) -> Result<Array2<f64>> {
    let shape = grid.shape();
    let [dx, dy] = grid.spacing();
    let too_fine = || Error::Parameter {
        name: "refinement",
        requirement: "small enough for the number of points to be counted",
        value: refinement as f64,
    };
    let mut mesh = [0; 2];
    for (points, n) in mesh.iter_mut().zip(shape) {
        *points = n.checked_mul(2).and_then(|n| n.checked_mul(refinement)).ok_or_else(too_fine)?;
    }
    let half_spectrum = (mesh[1] / 2 + 1).checked_mul(8 * shape[0]).ok_or_else(too_fine)?;
    check_memory(shape, memory(grid) + half_spectrum as u64)?;
    let step = [2.0 * PI / (mesh[0] as f64 * dx), 2.0 * PI / (mesh[1] as f64 * dy)];
    let longest = body.lengths().map_or(0.0, |[_, longest]| longest);
    let limits = body.asymptotes();
    let rest = limits.long - limits.short;
    let mean = mean_of_inverse(step);
    let image_depth = 2.0 * longest;

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
    let mut coefficients = inverse_even(shape, mesh, value, threads);
    if with_cell {
        let (rules, half) = (Rules::displacement(), [0.5 * dx, 0.5 * dy]);
        let image = if matches!(method, Method::Image { .. }) { rest } else { 0.0 };
        threads.run(|| {
            let rows = coefficients.axis_iter_mut(ndarray::Axis(0));
            rows.into_par_iter().enumerate().for_each(|(i, mut row)| {
                for (j, c) in row.iter_mut().enumerate() {
                    let (x, y) = (i as f64 * dx, j as f64 * dy);
                    let potential = |depth: f64| potential(&rules, half, [x, y], depth);
                    *c += limits.short / (2.0 * PI) * potential(0.0);
                    if image != 0.0 {
                        *c += image / (2.0 * PI) * potential(image_depth);
                    }
                }
            });
        });
    }
    Ok(coefficients)
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
