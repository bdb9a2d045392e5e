//! Discretisation errors that solutions on coarser grids do not show, found from the response of the body and
//! the pressure on the finest grid: a method of nacre's own.
//!
//! # Aliases
//!
//! Cells of length Δ cannot tell a wave exp(iξx) of pressure from its aliases of wavenumbers ξ + 2πk/Δ. The
//! displacement at the centres of cells of uniform pressure contains all of them,
//!
//! ```text
//! û(ξ) = Σ_k c(|ξ + 2πk/Δ|) sinc((ξ + 2πk/Δ) Δ/2) p̂(ξ)
//! ```
//!
//! with the response c = û_z/p̂. To the lowest order in ξ, the aliases add E ξ² to the response at k = 0,
//!
//! ```text
//! E = 2 Σ_{k ≥ 1} (−1)^k d/dq [c(q)/q]      q = 2πk/Δ
//! ```
//!
//! which is 0.0145 A Δ³ for a half-space, c = A/q: much less than other errors. A thin, nearly incompressible
//! layer of thickness h and shear modulus G hardly yields to long waves, c = h³ q²/3G, so that its error is
//! large unless Δ < h; and since E is nearly the same for Δ = 2.5 h and 5 h, coarser grids do not show it.
//!
//! By this error, a given pressure changes the elastic energy by half of
//!
//! ```text
//! X = ∫ E_x (∂p/∂x)² + E_y (∂p/∂y)² dA
//! ```
//!
//! and to first order the approach under a load W by X/W, times the rate at which its logarithm grows
//! relative to that of the energy.
//!
//! # Hard layers thinner than a cell
//!
//! Below the length of a cell, the body is stiffer by the ratio M of its response at q = π/Δ and q = ∞. Like
//! a plate on a foundation, a hard layer of thickness h gathers the force at the rim of the contact over a
//! length of about h M^⅓ and presses it on over h: the pressure of the outermost cells rises M^⅓ times. The
//! error of the peak is what this exceeds the peak by.
//!
//! # Rim
//!
//! The rim jumps from cell to cell, so that changes from grid to grid may be small by chance. A contact n cells
//! wide has at least a relative error of 0.1/n², by trial on random contacts. Between two sharp edges, which
//! may lie anywhere in their cells, it has 1/2n.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use ndarray::Array2;

use super::discretisation::Discretisation;
use crate::compliance::response::Body;
use crate::contact::problem::patch::rows;
use crate::model::grid::{Grid, Window};
use crate::numerics::parallel::{Lanes, ONE, update_with_largest, where_positive};

/// Terms of the alternating series.
const TERMS: usize = 16;

/// Relative step of the derivative.
const STEP: f64 = 1e-4;

/// Relative error of approach or load, times the square of the cells across the contact; chosen by trial.
const CHANCE: f64 = 0.1;

/// Coefficients of a body, or of two, on a grid.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Unresolved {
    /// E_x and E_y \[m³/Pa\].
    aliases: [f64; 2],
    /// M, at least 1.
    stiffening: f64,
}

/// Sums over pairs of neighbouring cells.
#[derive(Default)]
struct Pairs {
    /// Σ (p − p')²
    squares: f64,
    /// Pairs of a cell in contact after one that is not.
    starts: f64,
    /// Largest pressure beside a cell without.
    rim: f64,
}

impl Pairs {
    /// Adds the pairs of the cells of `p` and those before them.
    fn add(&mut self, p: &[f64], before: &[f64]) {
        let only = |a: Lanes, b: Lanes| a - where_positive(b, a);
        let ([rim], [squares, starts]) = update_with_largest([p, before], [], |[p, q], []| {
            let (begun, ended) = (only(p, q), only(q, p));
            let starts = where_positive(begun, ONE);
            ([], [begun.fast_max(ended)], [(p - q) * (p - q), starts])
        });
        self.squares += squares;
        self.starts += starts;
        self.rim = self.rim.max(rim);
    }
}

impl Unresolved {
    /// Coefficients of `bodies` together, on the cells of `grid`.
    pub(crate) fn new(bodies: &[&Body], grid: &Grid) -> Self {
        let spacing = grid.spacing();
        // α û_z/p̂ of all bodies; c/q = α û_z/p̂ / q².
        let normal = |q: f64| bodies.iter().map(|body| body.normal(q)).sum::<f64>();
        let ratio = |q: f64| normal(q) / (q * q);
        let alias = |spacing: f64| {
            let term = |k: usize| {
                let q = 2.0 * PI * (k + 1) as f64 / spacing;
                let step = STEP * q;
                (ratio(q - step) - ratio(q + step)) / (2.0 * step)
            };
            2.0 * alternating_sum(term)
        };
        let mut aliases = spacing.map(|spacing| {
            // The sign of E changes at some spacing, where higher orders are left.
            let nearby = alias(FRAC_1_SQRT_2 * spacing);
            alias(spacing).abs().max(nearby.abs())
        });
        let mut finest = spacing[1];
        if grid.is_line() {
            aliases[0] = 0.0;
        } else {
            finest = finest.min(spacing[0]);
        }
        let short: f64 = bodies.iter().map(|body| body.asymptotes().short).sum();
        let local: f64 = bodies.iter().map(|body| body.local()).sum();
        let stiffening = if short > 0.0 && local <= 0.0 {
            (normal(PI / finest) / short).max(1.0)
        } else {
            1.0
        };
        Self {
            aliases,
            stiffening,
        }
    }

    /// Errors of a solution whose pressure is zero outside `window`: of the approach where it is `loaded`,
    /// of the load where its approach is prescribed.
    pub(crate) fn errors(
        &self,
        [pressure, displacement]: [&Array2<f64>; 2],
        window: &Window,
        grid: &Grid,
        loaded: bool,
        singular: bool,
    ) -> Discretisation {
        let (mut force, mut work, mut cells) = (0.0, 0.0, 0.0);
        let (mut peak, mut deepest): (f64, f64) = (0.0, 0.0);
        let (mut along_x, mut along_y) = (Pairs::default(), Pairs::default());
        let columns = window[1].len();
        let none = vec![0.0; columns];
        let mut before: &[f64] = &none;
        for (p, u) in rows(pressure, window).zip(rows(displacement, window)) {
            let ([top, depth], [total, product, touching]) =
                update_with_largest([p, u], [], |[p, u], []| {
                    let touches = where_positive(p, ONE);
                    ([], [p, touches * u], [p, p * u, touches])
                });
            (peak, deepest) = (peak.max(top), deepest.max(depth));
            force += total;
            work += product;
            cells += touching;
            along_x.add(p, before);
            if let ([first, ..], [_, rest @ ..]) = (p, p) {
                along_y.add(&[*first], &[0.0]);
                along_y.add(rest, &p[..columns - 1]);
            }
            before = p;
        }
        if !(force > 0.0 && work.abs() > 0.0) {
            return Discretisation {
                peak_pressure: Some(0.0),
                ..Discretisation::default()
            };
        }
        let [weight_x, weight_y] = [0, 1].map(|k| self.aliases[k] / grid.spacing()[k].powi(2));
        let excess = weight_x * along_x.squares + weight_y * along_y.squares;
        // Work of the pressure on the form of the indentation, without what moves the contact as a whole.
        let form = (deepest * force - work).abs();
        let relative = match excess > 0.0 {
            true if excess < form => excess / form,
            true => 1.0,
            false => 0.0,
        };
        let rim = along_x.rim.max(along_y.rim);
        let concentrated = (rim * self.stiffening.cbrt() - peak).max(0.0);
        let starts = if grid.is_line() {
            along_y.starts
        } else {
            along_x.starts.max(along_y.starts)
        };
        let width = cells / starts;
        let rim_error = if singular && grid.is_line() {
            0.5 / width
        } else {
            CHANCE / (width * width)
        };
        let (approach, load) = if loaded {
            (excess / force + rim_error * (work / force).abs(), 0.0)
        } else {
            let part = excess / work.abs() + rim_error;
            (0.0, part.min(1.0) * force * grid.cell_area())
        };
        Discretisation {
            peak_pressure: Some(peak * relative + concentrated),
            approach,
            load,
        }
    }
}

/// Σ (−1)^k term(k), k = 0, 1, …, accelerated: Cohen, Rodriguez Villegas & Zagier, Experiment. Math. 9 (2000) 3,
/// algorithm 1, doi:10.1080/10586458.2000.10504632. The error is of the order of 5.8^−TERMS.
fn alternating_sum(term: impl Fn(usize) -> f64) -> f64 {
    let n = TERMS as f64;
    let d = (3.0 + 8.0_f64.sqrt()).powi(TERMS as i32);
    let d = 0.5 * (d + 1.0 / d);
    let (mut b, mut c, mut sum) = (-1.0, -d, 0.0);
    for k in 0..TERMS {
        c = b - c;
        sum += c * term(k);
        let k = k as f64;
        b *= (k + n) * (k - n) / ((k + 0.5) * (k + 1.0));
    }
    sum / d
}

#[cfg(test)]
mod tests {
    use super::{Pairs, Unresolved, alternating_sum};
    use crate::compliance::response::Body;
    use crate::error::Result;
    use crate::model::body::{HalfSpace, Layer, Substrate};
    use crate::model::grid::Grid;
    use crate::model::material::Elastic;

    #[test]
    fn alternating_sums_are_known() {
        // ln 2, π/4, and Abel's sum ½ of 1 − 1 + 1 − …
        let quarter_pi = 0.25 * std::f64::consts::PI;
        for (sum, expected) in [
            (alternating_sum(|k| 1.0 / (k + 1) as f64), 2.0_f64.ln()),
            (alternating_sum(|k| 1.0 / (2 * k + 1) as f64), quarter_pi),
            (alternating_sum(|_| 1.0), 0.5),
        ] {
            assert!((sum - expected).abs() < 1e-11, "{sum} {expected}");
        }
    }

    /// With c = A/q, E = 4A (Δ/2π)³ Σ (−1)^{k+1} k⁻³, and the sum is ¾ ζ(3).
    #[test]
    fn a_half_space_has_a_small_coefficient() -> Result<()> {
        let body = Body::from(Elastic::new(1.0, 0.0)?);
        let grid = Grid::new([10, 20], [1.0, 1.0])?;
        let found = Unresolved::new(&[&body], &grid);
        for (found, spacing) in found.aliases.into_iter().zip([0.1, 0.05]) {
            let zeta = 1.202_056_903_159_594;
            let expected = 4.0 * 2.0 * (spacing / std::f64::consts::TAU).powi(3) * 0.75 * zeta;
            assert!(
                (found / expected - 1.0).abs() < 1e-7,
                "{found:e} {expected:e}"
            );
        }
        assert!((found.stiffening - 1.0).abs() < 1e-12);
        Ok(())
    }

    /// On cells far longer than an incompressible layer on a rigid base is thick, waves of all lengths see no
    /// compliance at all: E = −h³/3G.
    #[test]
    fn cells_that_do_not_resolve_an_incompressible_layer_err_by_all() -> Result<()> {
        let (h, rubber) = (1e-3, Elastic::new(3.0, 0.5)?);
        let body = Body::from(HalfSpace::new(Substrate::Rigid, [Layer::new(rubber, h)?])?);
        let found = Unresolved::new(&[&body], &Grid::line(10, 1.0)?);
        let (expected, [along_x, along_y]) = (h.powi(3) / 3.0, found.aliases);
        assert!(along_x.abs() < f64::MIN_POSITIVE);
        assert!(
            (along_y / expected - 1.0).abs() < 0.02,
            "{along_y:e} {expected:e}"
        );
        Ok(())
    }

    /// A hard layer far thinner than a cell: M is the ratio of the moduli.
    #[test]
    fn a_hard_layer_stiffens_below_the_cell() -> Result<()> {
        let coat = Layer::new(Elastic::new(100.0, 0.3)?, 1e-6)?;
        let body = Body::from(HalfSpace::new(Elastic::new(1.0, 0.3)?, [coat])?);
        let found = Unresolved::new(&[&body], &Grid::new([10, 10], [1.0, 1.0])?);
        assert!((found.stiffening / 100.0 - 1.0).abs() < 0.01, "{found:?}");
        Ok(())
    }

    #[test]
    fn pairs_of_cells_are_counted() {
        let mut pairs = Pairs::default();
        pairs.add(&[0.0, 2.0, 3.0, 0.0, 1.0], &[0.0, 0.0, 2.0, 5.0, 0.0]);
        // Exact in binary.
        let expected = [4.0 + 1.0 + 25.0 + 1.0, 2.0, 5.0_f64];
        let found = [pairs.squares, pairs.starts, pairs.rim];
        assert_eq!(found.map(f64::to_bits), expected.map(f64::to_bits));
    }
}
