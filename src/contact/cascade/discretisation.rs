//! Estimates of the discretisation error of a solution, derived here: from the changes between the cascade's grids, and,
//! since coarser grids do not show all of it, from the response of the body, the pressure and the shape.
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
//! # Hard layers thinner than some cells
//!
//! Below the length of a cell, or of six where the body is three times stiffer to short waves than to those as long as the
//! grid, it is stiffer by the ratio M of its response at q = π/Δ, or π/6Δ, and q = ∞. Like
//! a plate on a foundation, a hard layer of thickness h gathers the force at the rim of the contact over a
//! length of about h M^⅓ and presses it on over h: the pressure of the outermost cells rises M^⅓ times. The
//! error of the peak is what this exceeds the peak by. Where the peak stands at the rim already, the response at π/2Δ counts.
//!
//! # Peak between cells
//!
//! The peak is that of a cell, whose centre may be half a cell beside the largest pressure. This error and that of the
//! cells' pressures are of opposite signs and nearly the same size, so that changes between grids do not show either. What
//! parabolas through three cells along each axis exceed the peak by is added.
//!
//! # Peak at the rim
//!
//! On a stiff coat that is some cells thick the peak stands within some cells of the rim, and its cells lie anew on each
//! grid: its changes have no rate. There the error is at least the spread of the last three grids.
//!
//! # Rim
//!
//! The rim jumps from cell to cell, so that changes from grid to grid may be small by chance. A contact n cells
//! wide has at least a relative error of [`CHANCE`]/n². Between two sharp edges, which
//! may lie anywhere in their cells, it has 1/2n.
//!
//! The area is a number of cells. On each line of cells it begins and ends anywhere in a cell, which makes an error of
//! variance 1/12; ends of neighbouring lines in one column have the same. Runs of l such ends so have a variance of
//! Σ l²/12 cells, and besides the outermost cells lie [`OUTSIDE`] of a cell too far out.
//!
//! # Corners
//!
//! The cells of coarser grids average the corners of a shape away.
//!
//! Where the gap has a corner at which its slope grows by Δs, as a profile of straight lines has between two of them,
//! the pressure rises as (E* Δs/2π) ln(2a/|x|): Johnson, Contact Mechanics (1985), §5.2,
//! doi:10.1017/CBO9781139171731. It has no limit, and cells half as long carry E* Δs ln 2/2π more. The error is what
//! cells four times shorter would add to the peak. The estimate was derived here.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use ndarray::{Array2, Axis};

use crate::compliance::response::Body;
use crate::contact::ends::{ContactEnd, contact_ends};
use crate::contact::problem::patch::rows;
use crate::model::grid::{Grid, Window};
use crate::model::surface::Surface;
use crate::numerics::layout::slice;
use crate::numerics::parallel::{Lanes, ONE, update_with_largest, where_positive};

/// Estimated discretisation errors: differences from the limit of ever finer cells. Files of earlier versions do not have
/// all of them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[non_exhaustive]
pub struct Discretisation {
    /// Error of the peak pressure \[Pa\]. `None` where the pressure is singular, at a sharp edge of the
    /// shape or where the grid cuts the contact: then the peak has no limit, and a warning says so.
    pub peak_pressure: Option<f64>,
    /// Error of the approach \[m\]; 0 where the approach is prescribed.
    pub approach: f64,
    /// Error of the load \[N\]; 0 where the load is prescribed.
    pub load: f64,
    /// Error of the area of the cells in contact \[m²\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub contact_area: Option<f64>,
    /// Error of the ends of the contact along x and along y \[m\]; `None` along an axis on which it has no ends.
    #[cfg_attr(feature = "serde", serde(default))]
    pub contact_extent: [Option<f64>; 2],
    /// Error of the slopes (s_x, s_y); 0 where they are prescribed.
    #[cfg_attr(feature = "serde", serde(default))]
    pub tilt: Option<[f64; 2]>,
}

/// Numbers of a solution on one grid that are compared with those on other grids.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct GridResult {
    pub(crate) peak_pressure: f64,
    pub(crate) approach: f64,
    pub(crate) load: f64,
    pub(crate) contact_area: f64,
    pub(crate) contact_extent: [[f64; 2]; 2],
    pub(crate) tilt: [f64; 2],
}

impl GridResult {
    /// The numbers in a row.
    fn numbers(&self) -> [f64; 10] {
        let [[x0, x1], [y0, y1]] = self.contact_extent;
        let [tilt_x, tilt_y] = self.tilt;
        let [peak, area] = [self.peak_pressure, self.contact_area];
        [peak, self.approach, self.load, area, x0, x1, y0, y1, tilt_x, tilt_y]
    }

    /// How far the numbers are from those of `other`.
    pub(crate) fn distance(&self, other: &Self) -> Discretisation {
        let (own, other) = (self.numbers(), other.numbers());
        Discretisation::of(std::array::from_fn(|k| (own[k] - other[k]).abs()))
    }
}

impl GridResult {
    /// The numbers that follow from a pressure alone.
    pub(crate) fn of_pressure(pressure: &Array2<f64>, grid: &Grid) -> Self {
        let (mut peak_pressure, mut sum, mut cells) = (0.0_f64, 0.0, 0.0);
        for p in pressure.iter().filter(|p| **p > 0.0) {
            (peak_pressure, sum, cells) = (peak_pressure.max(*p), sum + p, cells + 1.0);
        }
        Self {
            peak_pressure,
            load: sum * grid.cell_area(),
            contact_area: cells * grid.cell_area(),
            contact_extent: contact_ends(pressure, grid).map(|ends| ends.map(|end| end.at)),
            ..Self::default()
        }
    }
}

/// Number of changes from grid to grid that are looked at: the ratio of two is the rate, and a third shows whether it holds.
const CHANGES: i32 = 3;

/// First of the slopes among the numbers of a result.
const SLOPES: usize = 8;

/// Rate where only one change is known. Of 815 random contacts of all shapes, 1.3 % have errors, compared with
/// four times finer cells, above three times the estimate with a rate of 1, and 0.4 % with this one; it
/// makes half of the estimates more than four times too large, though.
const UNKNOWN_RATE: f64 = 0.75;

/// The error of the last of `results`; each result is from cells half as long as the one before. `None`
/// where there are fewer than two results.
///
/// With errors that fall as dx^q, f(dx) − f(0) = (f(2dx) − f(dx))/(2^q − 1). The rate q is observed, and
/// limited to 1 … 2: a smooth contact has 2. Approach and load of a contact whose pressure is `singular`
/// have 1, while its peak grows without end. One change alone shows no rate: then q = [`UNKNOWN_RATE`].
/// The edge of the contact jumps from cell to cell, so that a change may be small
/// by chance: the last three changes are taken, each scaled to the finest grid, and the largest counts. A peak that
/// `stands_at_rim` has at least the spread of the last three grids.
pub(crate) fn estimate(
    results: &[GridResult],
    singular: bool,
    stands_at_rim: bool,
) -> Option<Discretisation> {
    let results: Vec<_> = results.iter().rev().map(GridResult::numbers).collect();
    if results.len() < 2 {
        return None;
    }
    let error = |number: usize| -> f64 {
        let changes: Vec<f64> =
            results.windows(2).map(|pair| (pair[1][number] - pair[0][number]).abs()).collect();
        let last = changes[0];
        let rate = match changes.get(1) {
            _ if singular => 1.0,
            // Both ends of a contact jump, and a slope shows only by how much more one of them does.
            _ if number >= SLOPES => 2.0,
            Some(before) if last > 0.0 => (before / last).log2().clamp(1.0, 2.0),
            Some(_) => 2.0,
            None => UNKNOWN_RATE,
        };
        let growth = rate.exp2();
        let scaled = changes.iter().zip(0..CHANGES).map(|(c, k)| c / growth.powi(k));
        scaled.fold(0.0, f64::max) / (growth - 1.0)
    };
    let errors = Discretisation::of(std::array::from_fn(error));
    let last = results.iter().take(CHANGES as usize).map(|numbers| numbers[0]);
    let [least, most] = [last.clone().fold(f64::MAX, f64::min), last.fold(0.0, f64::max)];
    let errors = errors.at_least(if stands_at_rim { most - least } else { 0.0 });
    let peak_pressure = errors.peak_pressure.filter(|_| !singular);
    Some(Discretisation { peak_pressure, ..errors })
}

/// The result of an operation on two errors, of which both are known.
fn both<T>(a: Option<T>, b: Option<T>, operation: impl Fn(T, T) -> T) -> Option<T> {
    a.zip(b).map(|(a, b)| operation(a, b))
}

impl Discretisation {
    /// The errors of the numbers of a result.
    fn of([peak, approach, load, area, x0, x1, y0, y1, tilt_x, tilt_y]: [f64; 10]) -> Self {
        let ends = |a: f64, b: f64| Some(a.max(b)).filter(|error| !error.is_nan());
        Self {
            peak_pressure: Some(peak),
            approach,
            load,
            contact_area: Some(area),
            contact_extent: [ends(x0, x1), ends(y0, y1)],
            tilt: Some([tilt_x, tilt_y]),
        }
    }

    /// These errors, with that of the peak pressure raised to `peak` where it is less.
    pub(crate) fn at_least(self, peak: f64) -> Self {
        Self { peak_pressure: self.peak_pressure.map(|error| error.max(peak)), ..self }
    }

    /// Each error after an `operation` on it and on that of `other`.
    fn with(self, other: Self, operation: impl Fn(f64, f64) -> f64) -> Self {
        let [x, y] =
            [0, 1].map(|k| both(self.contact_extent[k], other.contact_extent[k], &operation));
        Self {
            peak_pressure: both(self.peak_pressure, other.peak_pressure, &operation),
            approach: operation(self.approach, other.approach),
            load: operation(self.load, other.load),
            contact_area: both(self.contact_area, other.contact_area, &operation),
            contact_extent: [x, y],
            tilt: both(self.tilt, other.tilt, |a, b| {
                [operation(a[0], b[0]), operation(a[1], b[1])]
            }),
        }
    }

    /// The sum of two independent errors.
    pub(crate) fn plus(self, other: Self) -> Self {
        self.with(other, |a, b| a + b)
    }

    /// These errors times a `factor`.
    pub(crate) fn times(self, factor: f64) -> Self {
        self.with(self, |error, _| factor * error)
    }

    /// The larger of two errors each.
    pub(crate) fn or_larger(self, other: Self) -> Self {
        self.with(other, f64::max)
    }
}

/// Terms of the alternating series.
const TERMS: usize = 16;

/// Relative step of the derivative.
const STEP: f64 = 1e-4;

/// Relative error of approach or load, times the square of the cells across the contact; chosen by trial.
const CHANCE: f64 = 0.1;

/// Relative error of a number that is stationary in the place of the rim, which is known to a fraction of one of the cells
/// of a contact that is so many `across`: changes between grids may be less by chance.
pub(crate) fn chance_error(across: f64) -> f64 {
    CHANCE / (across * across)
}

/// Cells from the rim within which a stiff coat gathers the force. Chosen by trial: of 100 peaks on coats 3 to 200 times
/// stiffer than the body and half a cell to eight cells thick in line contact, 8 are outside with 1, two with 4, one with 6.
const WITHIN: f64 = 6.0;

/// The same where the peak stands at the rim: of 200 such peaks five are outside with 1, by up to a factor of two, while with 6
/// errors of coats that are resolved are ten times too large.
const AT_RIM: f64 = 2.0;

/// Cells between the peak and the rim, at most, where changes of the peak have no rate.
const NEAR_RIM: usize = 3;

/// Error of a slope, relative to the mean depth of the form over half of the contact's length along this axis, times the
/// square of the cells along it: 99 % of 300 slopes of paraboloids that are loaded beside their vertex.
const TILTED: f64 = 0.9;

/// How far the outermost cells lie outside an edge at which the surfaces part, on average, in cells: measured on 200 lines
/// that lie anywhere on their grids.
const OUTSIDE: f64 = 0.2;

/// Error of an edge that is located, in cells: 99 % of 300 lines and ellipses that lie anywhere on their grids.
const LOCATED: f64 = 0.05;

/// Error of an edge, in cells, over the logarithm of the ratio of the responses to waves of [`LOCATING`] cells and of one: within
/// them a layer changes the response, and with it the law of the pressure by which the edge is located. For 980 lines on layers of a
/// tenth to five times the modulus of the body, 0.05 to 40 cells thick, all errors are within the stated ones, which are 2.8 times
/// as large in the median where they exceed [`LOCATED`].
const EDGE_ON_LAYERS: f64 = 1.5;

/// Half of the wavelength, in cells, that the pressure at an edge feels: twice the seven cells that locate it.
const LOCATING: f64 = 14.0;

/// Error of an edge, in cells, at most: none of these lines had more.
const EDGE_AT_MOST: f64 = 1.2;

/// 99 % of the sums of two errors that are uniform within a cell, over their standard deviation: (1 − √0.01)/√(1/6) = 2.2.
const ENDS_TOGETHER: f64 = 2.2;

/// Coefficients of a body, or of two, on a grid.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Unresolved {
    /// E_x and E_y \[m³/Pa\].
    aliases: [f64; 2],
    /// M
    stiffening: f64,
    /// Ratio of the responses at q = π/2Δ and q = ∞.
    below_cell: f64,
    /// Response α û/p̂ of all bodies to waves of the length of two cells \[1/Pa\].
    pub(crate) short_waves: f64,
    /// Whether stiff coats may gather the pressure at the rim.
    gathers: bool,
    /// Error of edges across x and across y on layers, in cells.
    on_layers: [f64; 2],
}

/// Ratio of the response to waves as long as the grid and to short ones from which on the coat of a body may gather the
/// pressure at the rim.
const STIFF: f64 = 3.0;

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
            let (entry, exit) = (only(p, q), only(q, p));
            let starts = where_positive(entry, ONE);
            ([], [entry.fast_max(exit)], [(p - q) * (p - q), starts])
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
        let short_waves = normal(PI / finest);
        let side = grid.size().into_iter().fold(0.0, f64::max);
        let gathers = short > 0.0 && normal(2.0 * PI / side) > STIFF * short;
        let cells = if gathers { [WITHIN, AT_RIM] } else { [1.0; 2] };
        let [stiffening, below_cell] = cells.map(|cells| {
            let waves = normal(PI / (cells * finest));
            if short > 0.0 && local <= 0.0 { waves / short } else { 1.0 }
        });
        let on_layers = spacing.map(|spacing| {
            let half_wave = |cells: f64| normal(PI / (cells * spacing));
            EDGE_ON_LAYERS * (half_wave(LOCATING) / half_wave(1.0)).ln().abs()
        });
        Self { aliases, stiffening, below_cell, short_waves, gathers, on_layers }
    }

    /// Whether the peak of a `pressure` stands so near to the rim, on a stiff coat, that its changes have no rate.
    pub(crate) fn stands_at_rim(&self, pressure: &Array2<f64>) -> bool {
        let Some((_, [i, j])) = peak_cell(pressure).filter(|_| self.gathers) else {
            return false;
        };
        let lines = [(pressure.column(j), i), (pressure.row(i), j)];
        lines.into_iter().filter(|(line, _)| line.len() > 1).any(|(line, at)| {
            let touches = |k: usize| line.get(k).is_some_and(|p| *p > 0.0);
            (1..=NEAR_RIM).any(|k| !touches(at + k) || !touches(at.wrapping_sub(k)))
        })
    }

    /// Errors of a solution whose pressure is zero outside `window`, with no error of approach and tilts that are not
    /// `loaded`, but prescribed, or of the load of such an approach.
    pub(crate) fn errors(
        &self,
        [pressure, displacement]: [&Array2<f64>; 2],
        window: &Window,
        grid: &Grid,
        loaded: [bool; 3],
        singular: bool,
    ) -> Discretisation {
        let (mut force, mut work, mut cells) = (0.0, 0.0, 0.0);
        let (mut peak, mut deepest): (f64, f64) = (0.0, 0.0);
        let (mut along_x, mut along_y) = (Pairs::default(), Pairs::default());
        let columns = window[1].len();
        let none = vec![0.0; columns];
        let mut before: &[f64] = &none;
        let fields = [slice(pressure), slice(displacement)];
        let [pressures, displacements] = [0, 1].map(|k| rows(&fields[k], grid.shape()[1], window));
        for (p, u) in pressures.zip(displacements) {
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
            return Discretisation::of([0.0; 10]);
        }
        let [weight_x, weight_y] = [0, 1].map(|k| self.aliases[k] / grid.spacing()[k].powi(2));
        let excess = weight_x * along_x.squares + weight_y * along_y.squares;
        // Work of the pressure on the form of the indentation, without what moves the contact as a whole.
        let form = (deepest * force - work).abs();
        let relative = if excess > 0.0 { (excess / form).min(1.0) } else { 0.0 };
        // Strips of a line contact have no rim across x.
        let rim = if grid.is_line() { along_y.rim } else { along_x.rim.max(along_y.rim) };
        // Cells that have the peak at the rim resolve what gathers there, but for what is below their length.
        let below = if self.stands_at_rim(pressure) { self.below_cell } else { self.stiffening };
        let concentrated = (rim * below.max(1.0).cbrt() - peak).max(0.0);
        let starts =
            if grid.is_line() { along_y.starts } else { along_x.starts.max(along_y.starts) };
        let width = cells / starts;
        let chance = crate::contact::chance_error(width);
        let rim_error = if singular && grid.is_line() { 0.5 / width } else { chance };
        let (approach, load) = if loaded[0] {
            (excess / force + rim_error * (work / force).abs(), 0.0)
        } else {
            let part = excess / work.abs() + rim_error;
            (0.0, part.min(1.0) * force * grid.cell_area())
        };
        let between = beside_centres(pressure);
        let [dx, dy] = grid.spacing();
        let edges = contact_ends(pressure, grid);
        let [x, y] = [0, 1].map(|axis| {
            let unlocated = |end: ContactEnd| if end.is_located { 0.0 } else { OUTSIDE + 0.5 };
            edges[axis].map(|end| match end.at.is_nan() {
                true => f64::NAN,
                false => (unlocated(end) + LOCATED + self.on_layers[axis]).min(EDGE_AT_MOST),
            })
        });
        let tilt = [0, 1].map(|axis| {
            let [low, high] = edges[axis].map(|end| end.at);
            let length = (high - low).max(grid.spacing()[axis]);
            let slope = form / force / (0.5 * length);
            if loaded[axis + 1] {
                TILTED * (grid.spacing()[axis] / length).powi(2) * slope
            } else {
                0.0
            }
        });
        Discretisation::of([
            (peak * relative + concentrated + between).max(peak * chance),
            approach,
            load,
            outline_error(pressure, grid) * grid.cell_area(),
            x[0] * dx,
            x[1] * dx,
            y[0] * dy,
            y[1] * dy,
            tilt[0],
            tilt[1],
        ])
    }
}

/// What parabolas through the largest pressure and its neighbours along both axes exceed it by.
fn beside_centres(pressure: &Array2<f64>) -> f64 {
    let Some((most, [i, j])) = peak_cell(pressure) else { return 0.0 };
    let lines = [(pressure.column(j), i), (pressure.row(i), j)];
    lines
        .map(|(line, at)| {
            let beside = [at.wrapping_sub(1), at + 1].map(|k| line.get(k));
            let [Some(before), Some(after)] = beside else { return 0.0 };
            let bend = 2.0 * most - before - after;
            if bend > 0.0 { (after - before).powi(2) / (8.0 * bend) } else { 0.0 }
        })
        .into_iter()
        .sum()
}

/// The largest pressure and its cell; `None` where there is none.
fn peak_cell(pressure: &Array2<f64>) -> Option<(f64, [usize; 2])> {
    let peak = pressure.fold(0.0_f64, |most, p| most.max(*p));
    let cell = pressure.indexed_iter().find(|(_, p)| **p >= peak && **p > 0.0);
    cell.map(|((i, j), _)| (peak, [i, j]))
}

/// Error of the area of the cells in contact, in cells.
pub(crate) fn outline_error(pressure: &Array2<f64>, grid: &Grid) -> f64 {
    let mut counts = [0.0; 2];
    let mut largest = 0.0_f64;
    for axis in if grid.is_line() { 1..2 } else { 0..2 } {
        let lanes = pressure.lanes(Axis(1 - axis));
        let lanes: Vec<_> = lanes.into_iter().collect();
        let (count, mut squares) = (lanes.len(), 0.0);
        let touches = |lane: Option<usize>, k: usize| {
            lane.is_some_and(|lane| lanes[lane].get(k).is_some_and(|p| *p > 0.0))
        };
        let wrapped = |lane: usize| if grid.is_periodic()[axis] { Some(lane) } else { None };
        // Between the cells of each two neighbouring lanes: runs of ends on the same side.
        for next in 0..=count {
            if next == count && grid.is_periodic()[axis] {
                break;
            }
            let before = next.checked_sub(1).or_else(|| wrapped(count - 1));
            let next = Some(next).filter(|next| *next < count);
            let (mut run, mut side) = (0.0, [false; 2]);
            for k in 0..=pressure.len_of(Axis(1 - axis)) {
                let sides = [touches(before, k), touches(next, k)];
                let ends = sides[0] != sides[1];
                counts[axis] += f64::from(u8::from(ends));
                if ends && sides == side {
                    run += 1.0;
                } else {
                    squares += run * run;
                    run = f64::from(u8::from(ends));
                }
                side = sides;
            }
        }
        largest = largest.max(squares);
    }
    OUTSIDE * counts[0].hypot(counts[1]) + ENDS_TOGETHER * (largest / 12.0).sqrt()
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

/// Parts into which an interval is divided in the search for a corner.
const PARTS: usize = 8;

/// Divisions of a cell: a smooth gap leaves 4⁻⁴ of the change of its slope over the cell.
const DIVISIONS: usize = 5;

/// Share of the largest change of the slope over an eighth of the cell that a corner keeps: all of it, or half where it
/// lies between two points.
const KEPT: f64 = 0.4;

/// How much finer cells are that the estimate looks at.
const FINER: f64 = 4.0;

/// Error of the peak of a `pressure` \[Pa\], on the lines of cells through it, for bodies whose responses α û/p̂ to waves
/// of a cell's length have this sum \[1/Pa\]. Measured surfaces have no other points than the cells.
pub(crate) fn corner_error(
    pressure: &Array2<f64>,
    grid: &Grid,
    shape: &dyn Surface,
    short: f64,
) -> f64 {
    if shape.grid().is_some() || short <= 0.0 {
        return 0.0;
    }
    let Some((peak, [row, column])) = peak_cell(pressure) else { return 0.0 };
    let (x, y, spacing) = (grid.x(), grid.y(), grid.spacing());
    // E* ln 4/2π
    let per_slope = 2.0 / short * FINER.ln() / (2.0 * PI);
    let mut most = 0.0_f64;
    let mut look = |p: f64, axis: usize, at: [f64; 2]| {
        if p > 0.0 {
            let gap = |offset: f64| {
                let mut at = at;
                at[axis] += offset;
                shape.gap(at[0], at[1])
            };
            most = most.max(p + per_slope * corner(gap, spacing[axis]) - peak);
        }
    };
    if !grid.is_line() {
        for (p, x) in pressure.column(column).iter().zip(&x) {
            look(*p, 0, [*x, y[column]]);
        }
    }
    for (p, y) in pressure.row(row).iter().zip(&y) {
        look(*p, 1, [x[row], *y]);
    }
    most
}

/// Growth of the slope at a corner of `gap` within half a `length` of 0; 0 where there is none.
fn corner(gap: impl Fn(f64) -> f64, length: f64) -> f64 {
    let (mut middle, mut length) = (0.0, length);
    let mut widest = None;
    let mut total = 0.0;
    for _ in 0..DIVISIONS {
        let part = length / PARTS as f64;
        // Slopes of the parts, and of one before and after: a corner may lie on the rim.
        let at = |k: usize| gap(middle + part * (k as f64 - 0.5 * PARTS as f64 - 1.0));
        let heights: [f64; PARTS + 3] = std::array::from_fn(at);
        let growths = heights.windows(3).map(|h| (h[2] - 2.0 * h[1] + h[0]) / part);
        total = growths.clone().sum();
        let sharpest = growths.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((place, growth)) = sharpest.filter(|(_, growth)| growth.is_finite()) else {
            return 0.0;
        };
        if growth <= 0.0 || growth < KEPT * *widest.get_or_insert(growth) {
            return 0.0;
        }
        middle += part * (place as f64 - 0.5 * PARTS as f64);
        length = 2.0 * part;
    }
    total
}

#[cfg(test)]
mod tests {
    use super::{GridResult, Pairs, Unresolved, alternating_sum, corner, estimate};
    use crate::compliance::response::Body;
    use crate::error::Result;
    use crate::model::body::{HalfSpace, Layer, Substrate};
    use crate::model::grid::Grid;
    use crate::model::material::Elastic;

    /// Errors estimated from `values` on grids from the coarsest on. Peak, approach and load are made from the
    /// values by shifts and factors; the factors are divided out again.
    fn error(values: &[f64]) -> Option<[f64; 3]> {
        let results: Vec<GridResult> = (values.iter())
            .map(|&value| GridResult {
                peak_pressure: 5.0 + value,
                approach: 1.0 - 0.1 * value,
                load: 3.0 * value,
                ..GridResult::default()
            })
            .collect();
        let errors = estimate(&results, false, false)?;
        let peak = errors.peak_pressure?;
        Some([peak, 10.0 * errors.approach, errors.load / 3.0])
    }

    fn assert_error(values: &[f64], expected: f64) {
        for error in self::error(values).expect("two grids or more") {
            assert!(
                (error - expected).abs() < 1e-12 * expected.max(1e-2),
                "{values:?}: {error} {expected}"
            );
        }
    }

    /// Values f + c dx^q, with dx = 8, 4, 2, 1: the error of the last is c. One grid tells nothing.
    #[test]
    fn known_rates_give_the_error_that_remains() {
        assert_eq!([error(&[]), error(&[0.3])], [None, None]);
        for rate in [1.0, 1.5, 2.0] {
            for c in [0.02, -0.02] {
                let values = [8.0_f64, 4.0, 2.0, 1.0].map(|dx| 0.3 + c * dx.powf(rate));
                assert_error(&values, c.abs());
                assert_error(&values[1..], c.abs());
            }
        }
    }

    /// A rate above 2 counts as 2, one below 1 as 1; the one that cannot be seen from two grids is assumed.
    #[test]
    fn rates_are_between_one_and_two() {
        // Changes 0.64 and 0.04: over 4 the first is 0.16, and over 2² − 1 that is the larger.
        assert_error(&[0.0, 0.64, 0.68], 0.16 / 3.0);
        assert_error(&[0.0, 0.04, 0.68], 0.64);
        assert_error(&[0.0, 0.04], 0.04 / (super::UNKNOWN_RATE.exp2() - 1.0));
    }

    /// Where the last change is small by chance, the two before count, scaled to the finest grid; the fourth does
    /// not.
    #[test]
    fn a_small_change_by_chance_is_no_convergence() {
        assert_error(&[0.0, 0.64, 0.80, 0.80], 0.16 / 4.0 / 3.0);
        assert_error(&[0.0, 0.96, 0.97, 0.97], 0.96 / 16.0 / 3.0);
        assert_error(&[0.0, 9.0, 9.96, 9.97, 9.97], 0.96 / 16.0 / 3.0);
        assert_error(&[0.5, 0.5, 0.5], 0.0);
    }

    /// A singular pressure has no peak; other errors fall as dx, whatever the changes look like.
    #[test]
    fn a_singular_pressure_has_no_peak() {
        let result = |value: f64| GridResult {
            peak_pressure: value,
            approach: value,
            load: 2.0 * value,
            ..GridResult::default()
        };
        let errors = estimate(&[0.0, 0.96, 1.2].map(result), true, false).expect("three grids");
        assert_eq!(errors.peak_pressure, None);
        assert!((errors.approach - 0.48).abs() < 1e-12 && (errors.load - 0.96).abs() < 1e-12);
        let other = estimate(&[0.0, 0.96, 1.2].map(result), false, false).expect("three grids");
        assert_eq!(other.plus(errors).peak_pressure, None);
        assert!((other.plus(other).load - 2.0 * other.load).abs() < 1e-12);
    }

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
        let unresolved = Unresolved::new(&[&body], &grid);
        for (alias, spacing) in unresolved.aliases.into_iter().zip([0.1, 0.05]) {
            let zeta = 1.202_056_903_159_594;
            let expected = 4.0 * 2.0 * (spacing / std::f64::consts::TAU).powi(3) * 0.75 * zeta;
            assert!((alias / expected - 1.0).abs() < 1e-7, "{alias:e} {expected:e}");
        }
        assert!((unresolved.stiffening - 1.0).abs() < 1e-12);
        Ok(())
    }

    /// On cells far longer than an incompressible layer on a rigid base is thick, waves of all lengths see no
    /// compliance at all: E = −h³/3G.
    #[test]
    fn cells_that_do_not_resolve_an_incompressible_layer_err_by_all() -> Result<()> {
        let (h, rubber) = (1e-3, Elastic::new(3.0, 0.5)?);
        let body = Body::from(HalfSpace::new(Substrate::Rigid, [Layer::new(rubber, h)?])?);
        let unresolved = Unresolved::new(&[&body], &Grid::line(10, 1.0)?);
        let (expected, [along_x, along_y]) = (h.powi(3) / 3.0, unresolved.aliases);
        assert!(along_x.abs() < f64::MIN_POSITIVE);
        assert!((along_y / expected - 1.0).abs() < 0.02, "{along_y:e} {expected:e}");
        Ok(())
    }

    /// A hard layer far thinner than a cell: M is the ratio of the moduli.
    #[test]
    fn a_hard_layer_stiffens_below_the_cell() -> Result<()> {
        let coat = Layer::new(Elastic::new(100.0, 0.3)?, 1e-6)?;
        let body = Body::from(HalfSpace::new(Elastic::new(1.0, 0.3)?, [coat])?);
        let unresolved = Unresolved::new(&[&body], &Grid::new([10, 10], [1.0, 1.0])?);
        assert!((unresolved.stiffening / 100.0 - 1.0).abs() < 0.01, "{unresolved:?}");
        Ok(())
    }

    #[test]
    fn pairs_of_cells_are_counted() {
        let mut pairs = Pairs::default();
        pairs.add(&[0.0, 2.0, 3.0, 0.0, 1.0], &[0.0, 0.0, 2.0, 5.0, 0.0]);
        // Exact in binary.
        let expected = [4.0 + 1.0 + 25.0 + 1.0, 2.0, 5.0_f64];
        let sums = [pairs.squares, pairs.starts, pairs.rim];
        assert_eq!(sums.map(f64::to_bits), expected.map(f64::to_bits));
    }

    /// A corner is found wherever it lies in the cell, to the rounding of second differences; circles, parabolas and
    /// logarithms have none.
    #[test]
    fn corners_are_told_from_curvature() {
        for place in [-0.5, -0.31, 0.0, 0.123, 0.5] {
            let gap = |x: f64| 0.2 * x + 1e-3 * (x - place).max(0.0) + 1e-3 * x * x;
            let slope_change = corner(gap, 1.0);
            assert!((slope_change / 1e-3 - 1.0).abs() < 0.02, "{place}: {slope_change}");
        }
        for gap in [|x: f64| x * x, |x: f64| 1.0 - (1.0 - x * x).sqrt(), |x: f64| -(0.9 - x).ln()] {
            assert!(corner(gap, 1.0).abs() <= 0.0);
        }
        assert!(corner(|x| -x.abs(), 1.0).abs() <= 0.0, "a reentrant corner lowers the pressure");
        assert!(corner(|x| if x < 0.2 { 0.0 } else { f64::INFINITY }, 1.0).abs() <= 0.0);
    }
}
