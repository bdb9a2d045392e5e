//! Influence coefficients of line contact: strips that are endless along x, in plane strain.
//!
//! The displacement of a strip \[0, Y\] under unit pressure, at its end, is the limit of the sum over
//! the corners of an endless rectangle ([`crate::compliance::kernel::quadrature`]). With A of the substrate, η of
//! [`super::exact`], and the datum at distance ℓ from the load,
//!
//! ```text
//! G(Y) = Y [A/π (1 + ln ℓ/Y) + 2 ∫₀^∞ (η(Y cosh u) − η(∞)) du]        η(∞) = (A − A1)/2π
//! ```
//!
//! and C(y) = G(y + dy/2) − G(y − dy/2). The formula is nacre's own.

use std::f64::consts::PI;

use ndarray::Array2;

use super::exact::{Tables, WHOLE_CELLS};
use crate::compliance::kernel::quadrature::{CellRules, Rules};
use crate::compliance::response::Response;
use crate::error::Result;
use crate::model::grid::Grid;
use crate::numerics::parallel::Threads;

/// Distance, in lengths of the response or of the grid, beyond which η − η(∞) is its leading term, of
/// order 1/R. The next term is of relative order R^{−2}, 1e-14.
const FAR: f64 = 1e7;

/// The displacement G of strips of any width, without the local compliance.
struct Strips {
    /// A of the substrate \[1/Pa\].
    long: f64,
    datum: f64,
    /// Distance from which on the leading term is left.
    far: f64,
    /// η(∞)
    end: f64,
    tables: Option<Tables>,
    rules: CellRules,
}

impl Strips {
    /// Strips whose ends are no nearer than half the `spacing` of cells.
    fn plan(body: &dyn Response, spacing: f64, datum: f64, threads: &Threads) -> Result<Self> {
        let limits = body.asymptotes();
        let longest = body.lengths().map_or(0.0, |[_, longest]| longest);
        let far = FAR * longest.max(datum);
        Ok(Self {
            long: limits.long,
            datum,
            far,
            end: (limits.long - limits.short) / (2.0 * PI),
            tables: Tables::new(body, [WHOLE_CELLS * spacing, 1.01 * far], threads)?,
            rules: CellRules::new(Rules::displacement()),
        })
    }

    /// G(Y)
    fn at(&self, y: f64) -> f64 {
        y * (self.long / PI * (1.0 + (self.datum / y).ln()) + self.remainder(y))
    }

    fn remainder(&self, y: f64) -> f64 {
        let Some(tables) = &self.tables else {
            return 0.0;
        };
        let last = (self.far / y).acosh();
        let mean = |u: f64| tables.mean((y * u.cosh()).powi(2)) - self.end;
        // Beyond: mean(u) ≈ mean(last) cosh(last)/cosh u, and ∫ 1/cosh u = 2 atan e^{−u}.
        let tail = mean(last) * (self.far / y) * 2.0 * (-last).exp().atan();
        2.0 * (self.rules.panel().over_panels(0.0, last, mean) + tail)
    }
}

/// Coefficients \[m/Pa\] of strips of this `width` at `offsets` of at least the width, with the datum at a distance.
pub(super) fn apart(
    body: &dyn Response,
    (width, datum): (f64, f64),
    offsets: &[f64],
    threads: &Threads,
) -> Result<Vec<f64>> {
    let strips = Strips::plan(body, width, datum, threads)?;
    let at = |offset: &f64| strips.at(offset + 0.5 * width) - strips.at(offset - 0.5 * width);
    Ok(offsets.iter().map(at).collect())
}

/// Coefficients (1, ny) \[m/Pa\], without the local compliance.
pub(super) fn coefficients(
    body: &dyn Response,
    grid: &Grid,
    threads: &Threads,
) -> Result<Array2<f64>> {
    let [_, ny] = grid.shape();
    let dy = grid.spacing()[1];
    let strips = Strips::plan(body, dy, grid.size()[1], threads)?;
    // G at the edges of the cells, (j + ½) dy.
    let strip: Vec<f64> = (0..ny).map(|j| strips.at((j as f64 + 0.5) * dy)).collect();
    Ok(Array2::from_shape_fn((1, ny), |(_, j)| {
        if j == 0 { 2.0 * strip[0] } else { strip[j] - strip[j - 1] }
    }))
}
