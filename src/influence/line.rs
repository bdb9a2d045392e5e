//! Influence coefficients of line contact: strips that are endless along x, in plane strain.
//!
//! The displacement of a strip \[0, Y\] under unit pressure, at its end, is the limit of the corner
//! function of `exact` for an endless rectangle. With A of the substrate, η of [`RadialKernel`],
//! and the datum at distance ℓ from the load,
//!
//! ```text
//! π G(Y) = Y [A (1 + ln ℓ/Y) + ∫₀^∞ (η(Y cosh u) − η(∞)) du]        η(∞) = A − A1
//! ```
//!
//! and C(y) = G(y + dy/2) − G(y − dy/2).

use std::f64::consts::PI;

use ndarray::Array2;

use super::exact::Tables;
use super::radial::RadialKernel;
use crate::grid::Grid;
use crate::kernel::quadrature::Rule;
use crate::parallel::Threads;
use crate::response::Response;

/// Beyond this many thicknesses of the coating, η − η(∞) is its leading term, of order 1/R; the
/// next one is of relative order R^{−2}.
const FAR: f64 = 1e7;

/// Coefficients (1, ny) \[m/Pa\].
pub(super) fn coefficients(body: &dyn Response, grid: &Grid, threads: &Threads) -> Array2<f64> {
    let [_, ny] = grid.shape();
    let dy = grid.spacing()[1];
    let datum = grid.size()[1];
    let limits = body.asymptotes();
    let thickness = body.lengths().map_or(0.0, |[_, longest]| longest);
    let far = FAR * thickness.max(datum);
    let range = [0.49 * dy, 1.01 * far];
    let tables = RadialKernel::new(body, range[0], range[1])
        .map(|kernel| threads.run(|| Tables::new(&kernel, range).0));
    let rule = Rule::gauss_legendre(10);
    let end = limits.long - limits.short;
    let coating = |y: f64| {
        let Some(tables) = &tables else { return 0.0 };
        let last = (far / y).acosh();
        let rest = |u: f64| tables.mean.at((y * u.cosh()).powi(2)) - end;
        // Beyond: rest(u) ≈ rest(last) cosh(last)/cosh u, of which ∫ 1/cosh u = 2 atan e^{−u}.
        let tail = rest(last) * (far / y) * 2.0 * (-last).exp().atan();
        rule.over_panels(0.0, last, rest) + tail
    };
    // G at the edges of the cells, (j + ½) dy.
    let strip: Vec<f64> = (0..ny)
        .map(|j| {
            let y = (j as f64 + 0.5) * dy;
            y / PI * (limits.long * (1.0 + (datum / y).ln()) + coating(y))
        })
        .collect();
    Array2::from_shape_fn((1, ny), |(_, j)| {
        if j == 0 {
            2.0 * strip[0]
        } else {
            strip[j] - strip[j - 1]
        }
    })
}
