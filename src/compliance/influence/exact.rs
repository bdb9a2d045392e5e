//! Influence coefficients without aliasing: the kernel at z = 0, integrated over the cell.
//!
//! A unit force displaces the surface at distance r by
//!
//! ```text
//! K(r) = 1/2π ∫ D(α) J0(αr) dα = A1/2πr + (A − A1)/2π√(r² + d²) + H(r)          D = α û/p̂
//! ```
//!
//! A1 and A are D at short and at long wavelengths. The second term is an image at depth d, with
//! D = (A − A1) e^{−αd}; it leaves a remainder that vanishes at both ends of the spectrum, and H is its
//! transform ([`crate::compliance::kernel::series`]). The first term has Love's closed form over a cell
//! ([`crate::compliance::kernel::rectangle`]); the others are tabulated, with their means η(r) = 1/r ∫₀ʳ K r' dr',
//! and integrated over the cell ([`crate::compliance::kernel::quadrature`]). The image and the adaptive sampling of
//! the remainder were derived here.
//!
//! In line contact, strips are endless along x, in plane strain. The displacement of a strip \[0, Y\] under unit pressure,
//! at its end, is the limit of the sum over the corners of an endless rectangle. With A of the substrate and the datum at
//! distance ℓ from the load,
//!
//! ```text
//! G(Y) = Y [A/π (1 + ln ℓ/Y) + 2 ∫₀^∞ (η(Y cosh u) − η(∞)) du]        η(∞) = (A − A1)/2π
//! ```
//!
//! and C(y) = G(y + dy/2) − G(y − dy/2). The formula was derived here.

use std::f64::consts::PI;

use ndarray::Array2;

use crate::compliance::kernel::quadrature::{CellRules, Rules};
use crate::compliance::kernel::rectangle::potential;
use crate::compliance::kernel::series::{Order, Series, TransformKind};
use crate::compliance::kernel::table::Precise;
use crate::compliance::response::{Body, Response, check, refuse_free, size};
use crate::error::{Error, Result, positive};
use crate::model::grid::Grid;
use crate::numerics::parallel::Threads;

/// Displacement around one uniformly loaded cell: influence coefficients without aliasing, at any
/// offset.
///
/// ```
/// use nacre::{Elastic, HalfSpace, Layer, influence::CellInfluence};
/// let (soft, hard) = (Elastic::new(1.0, 0.3)?, Elastic::new(4.0, 0.3)?);
/// let body = HalfSpace::new(soft, [Layer::new(hard, 8.0)?])?;
/// let cell = CellInfluence::plan(&body, [1.0, 1.0], 200.0)?;
/// // Reference value by Hankel quadrature.
/// assert!((cell.at([0.0, 0.0]) / 0.282_429_656_405_885_74 - 1.0).abs() < 1e-11);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug)]
pub struct CellInfluence {
    /// α û/p̂ at short wavelengths.
    short: f64,
    local: f64,
    half: [f64; 2],
    cells: CellRules,
    /// Where the response changes with the wavenumber.
    tables: Option<Tables>,
    error: f64,
}

impl CellInfluence {
    /// Plans the displacement of `body` around a cell of sides `spacing` \[m\], for offsets up to
    /// `reach` \[m\]; beyond it falls as 1/r.
    ///
    /// # Errors
    /// Unless the lengths are finite and above 0; a response that contradicts itself.
    pub fn plan(body: impl Into<Body>, spacing: [f64; 2], reach: f64) -> Result<Self> {
        let body = body.into();
        refuse_free(&*body, "the body around one cell")?;
        check(&*body)?;
        Self::plan_on(&*body, spacing, NEAREST_RIM, reach, &Threads::new(None)?)
    }

    /// [`CellInfluence::plan`] on `threads`, for offsets at which no corner of the cell is nearer than
    /// `nearest` shorter sides; `body` has been checked.
    pub(super) fn plan_on(
        body: &dyn Response,
        spacing @ [dx, dy]: [f64; 2],
        nearest: f64,
        reach: f64,
        threads: &Threads,
    ) -> Result<Self> {
        positive("spacing", dx)?;
        positive("spacing", dy)?;
        positive("reach", reach)?;
        // Nodes of the quadratures lie inside the cells.
        let range = [nearest * dx.min(dy), 1.01 * (reach + dx.hypot(dy))];
        let tables = Tables::new(body, range, threads)?;
        let missed = tables.as_ref().map_or(0.0, |tables| tables.error);
        Ok(Self {
            short: body.asymptotes().short,
            local: body.local(),
            half: spacing.map(|d| 0.5 * d),
            cells: CellRules::new(Rules::displacement()),
            tables,
            error: missed + QUADRATURE * size(body) / (2.0 * PI),
        })
    }

    /// Estimated error \[1/Pa\] of C r/(dx dy), where r is the offset or half the shorter side: in this
    /// form the coefficients of a homogeneous body are all about the same, 1/(πE*).
    pub fn error(&self) -> f64 {
        self.error
    }

    /// Displacement \[m\] per unit pressure on the cell, at `offset` \[m\] from its centre.
    ///
    /// A local compliance acts inside the cell, and by half on its rim.
    pub fn at(&self, offset: [f64; 2]) -> f64 {
        let inside = |axis: usize| match offset[axis].abs() - self.half[axis] {
            beyond if beyond < 0.0 => 1.0,
            beyond if beyond > 0.0 => 0.0,
            _ => 0.5,
        };
        self.at_distance(offset) + self.local * inside(0) * inside(1)
    }

    /// [`CellInfluence::at`] without the local compliance.
    pub(super) fn at_distance(&self, offset: [f64; 2]) -> f64 {
        let love =
            || self.short * potential(self.cells.rules(), self.half, offset, 0.0) / (2.0 * PI);
        let Some(tables) = &self.tables else {
            return love();
        };
        let at = offset.map(f64::abs);
        let mut sum = 0.0;
        let far = (self.cells).nodes(at, self.half, 0.0, |weight, x, y| {
            sum += weight * tables.displacement(x * x + y * y);
        });
        if !far {
            sum = love();
            (self.cells).corners(at, self.half, |weight, r, _| {
                sum += weight * tables.mean(r * r);
            });
        }
        sum
    }
}

/// Relative error of the quadratures over the cell; `tests/compliance/influence_exact.rs` shows that
/// the estimate which contains it bounds the true error.
const QUADRATURE: f64 = 1e-12;

/// Distance to the rim of the cell, in shorter sides, from which on the public tables hold.
const NEAREST_RIM: f64 = 1e-6;

/// Nearest distance to a corner, in shorter sides, at offsets of whole cells: corners lie half a side
/// from the axes.
pub(super) const WHOLE_CELLS: f64 = 0.49;

/// The kernel of a response at the surface, without the local term.
struct SurfaceKernel {
    /// A1/2π.
    short: f64,
    /// (A − A1)/2π.
    image: f64,
    image_depth: f64,
    remainder: Series<1>,
    /// Estimated error of r K and of η \[1/Pa\].
    error: f64,
}

/// The error for layers whose response, or its derivative, is lost in rounding.
const TOO_DIFFERENT: Error = Error::Inconsistent(
    "layers and substrate must differ less in moduli and thicknesses: rounding of numbers hides the displacement of the \
     body, or its derivatives, at long waves; take the stiffer of two parts as rigid, or leave out the thin one",
);

/// Size of the remainder, relative to the response, below which it is rounding.
const VANISHED: f64 = 1e-15;

/// Size of the remainder, relative to the response, at which a search ends without an error: the
/// accuracy that the exact method promises.
const REACHED: f64 = 1e-9;

/// Length in ln α, beyond the response's own lengths, in which the remainder must vanish: it does where
/// it falls as α^{±0.6} or faster, and comes below [`REACHED`] where it falls as α^{±0.35}.
const SEARCH: f64 = 60.0;

/// Length in ln r over which kernels fall by rounding, that of the remainder as r at small and as 1/r at
/// large distance: e^{−38} = 3e-17.
const FALL: f64 = 38.0;

impl SurfaceKernel {
    /// The kernel for distances in `range`; none where the response is the same at all wavenumbers.
    fn new(body: &dyn Response, range: [f64; 2]) -> Result<Option<Self>> {
        let limits = body.asymptotes();
        let Some([shortest, longest]) = body.lengths() else {
            return Ok(None);
        };
        let size = size(body);
        let rest = limits.long - limits.short;
        // This depth takes the term of first order in α as well, where it is a depth at all.
        let matched = -limits.constant / rest;
        let image_depth = if (0.1 * shortest..1e3 * longest).contains(&matched) {
            matched
        } else {
            2.0 * longest
        };
        let remainder =
            |alpha: f64| body.normal(alpha) - limits.short - rest * (-alpha * image_depth).exp();
        let left = |log: f64| remainder(log.exp()).abs();
        let vanished = |log: f64| (0..3).all(|k| left(log + f64::from(k)) < VANISHED * size);
        let inner = [-longest.ln(), -shortest.ln()];
        let [mut low, mut high] = inner;
        while low > inner[0] - SEARCH && !vanished(low - 3.0) {
            low -= 1.0;
        }
        while high < inner[1] + SEARCH && !vanished(high) {
            high += 1.0;
        }
        let reached = |log: f64| left(log) <= REACHED * size;
        if !(reached(low - 1.0) && reached(high)) {
            if body.half_space().is_some() {
                return Err(TOO_DIFFERENT);
            }
            return Err(Error::Inconsistent(
                "normal(α) of the body must reach asymptotes().long for wavelengths above and \
                 asymptotes().short for wavelengths below its lengths()",
            ));
        }
        // The period keeps the ends of the kernels from overlapping, however slowly they fall.
        let near = (range[1] / shortest).ln().max(0.0) + FALL.max(high - inner[1]);
        let far = (longest / range[0]).ln().max(0.0) + FALL.max(inner[0] - low);
        let period = (high - low + 4.0).max(near).max(far);
        let order = Order { nu: 0.0, kind: TransformKind::Vanishing };
        let (remainder, error) = Series::resolved(remainder, [low, high], period, order, size);
        Ok(Some(Self {
            short: limits.short / (2.0 * PI),
            image: rest / (2.0 * PI),
            image_depth,
            remainder,
            error: (error + left(low - 1.0).max(left(high))) / (2.0 * PI),
        }))
    }

    /// K at four distances r > 0.
    fn displacement(&self, distances: [f64; 4]) -> [[f64; 1]; 4] {
        let mut values = self.remainder.reduced(distances);
        for ([value], r) in values.iter_mut().zip(distances) {
            *value += self.short / r + self.image / r.hypot(self.image_depth);
        }
        values
    }

    /// η of K − A1/2πr at four distances r > 0.
    fn mean(&self, distances: [f64; 4]) -> [[f64; 1]; 4] {
        let mut values = self.remainder.mean(distances);
        for ([value], r) in values.iter_mut().zip(distances) {
            *value += self.image * r / (r.hypot(self.image_depth) + self.image_depth);
        }
        values
    }
}

/// Tables of the kernel at the surface, over the squared distance.
#[derive(Debug)]
pub(super) struct Tables {
    /// Largest squared distance of the tables.
    end: f64,
    displacement: Precise<1>,
    mean: Precise<1>,
    /// Estimated error of r K and of η \[1/Pa\].
    error: f64,
}

/// Number of distances at which the interpolation of the tables is checked, times four.
const CHECKS: u32 = 16;

impl Tables {
    /// Tables for distances in `range`; none where the response is the same at all wavenumbers.
    pub(super) fn new(
        body: &dyn Response,
        range: [f64; 2],
        threads: &Threads,
    ) -> Result<Option<Self>> {
        let Some(kernel) = SurfaceKernel::new(body, range)? else {
            return Ok(None);
        };
        let (displacement, mean) = threads.run(|| {
            (
                Precise::new(range, 0.0, |r| kernel.displacement(r)),
                Precise::new(range, 0.0, |r| kernel.mean(r)),
            )
        });
        let mut missed = 0.0_f64;
        for check in 0..CHECKS {
            let distances = [0.5, 1.5, 2.5, 3.5].map(|k| {
                let position = (f64::from(4 * check) + k) / f64::from(4 * CHECKS);
                range[0] * (range[1] / range[0]).powf(position)
            });
            let (exact, exact_mean) = (kernel.displacement(distances), kernel.mean(distances));
            for (k, r) in distances.into_iter().enumerate() {
                let [displacement, mean] = [displacement.at(r * r), mean.at(r * r)].map(|[v]| v);
                missed = missed
                    .max(((displacement - exact[k][0]) * r).abs())
                    .max((mean - exact_mean[k][0]).abs());
            }
        }
        Ok(Some(Self {
            end: range[1] * range[1],
            displacement,
            mean,
            error: kernel.error + missed,
        }))
    }

    /// K at the squared distance s; as 1/r beyond the tables.
    #[inline]
    fn displacement(&self, s: f64) -> f64 {
        let [value] = self.displacement.at(s);
        if s > self.end { value * (self.end / s).sqrt() } else { value }
    }

    /// η of K − A1/2πr at the squared distance s.
    #[inline]
    pub(super) fn mean(&self, s: f64) -> f64 {
        let [value] = self.mean.at(s);
        value
    }
}

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
pub(super) fn strips_apart(
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
pub(super) fn strip_coefficients(
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
