//! The contact problem in the form that the algorithms solve.
//!
//! ```text
//! minimise ½ pᵀK p + pᵀh     over 0 ≤ p ≤ H,     subject to Bᵀp = F
//! ```
//!
//! Its multipliers λ are the loaded degrees of freedom of the rigid motion, g = K p + h − Bλ. Without a hardness H,
//! g ≥ 0 and p g = 0; [`bounds`] has the conditions with one.
//! Polonsky & Keer, Wear 231 (1999) 206, eqs (1)–(4), doi:10.1016/S0043-1648(99)00113-1, have one column
//! of B, the approach.

pub(super) mod balance;
pub(super) mod bounds;
pub(super) mod freedoms;
pub(super) mod patch;
pub(super) mod springs;

use std::f64::consts::PI;

use ndarray::Array2;

use crate::compliance::convolution::{Convolution, Workspace};
use crate::compliance::response::Body;
use crate::contact::problem::balance::FitSums;
use crate::contact::problem::bounds::{Bounds, is_below, not_allowed, residual};
use crate::contact::problem::freedoms::Freedoms;
use crate::contact::problem::patch::Patch;
use crate::model::grid::{Grid, Window};
use crate::numerics::layout::{slice, slice_mut};
use crate::numerics::parallel::{
    Lanes, ONE, Row, Rows, Total, ZERO, all, sum, update, update_with_largest, where_positive,
};

/// One contact problem: operator, degrees of freedom and undeformed gap.
pub(super) struct Problem<'a> {
    /// K
    pub(super) convolution: &'a Convolution,
    /// B and F
    pub(super) freedoms: &'a Freedoms,
    /// h, less the prescribed motion; +∞ where the shape cannot touch.
    pub(super) gap: &'a [f64],
    /// 0 ≤ p ≤ H
    pub(super) bounds: &'a Bounds<'a>,
    pub(super) local: &'a LocalDisplacement,
}

/// How well a pressure solves the problem.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Quality {
    /// Σ p|g| over the cells whose pressure no bound holds, relative to Σ p u, or to Σ p times the local displacement
    /// if that is less; 0 when p = 0.
    pub(super) residual: f64,
    /// max(−g, 0) over the cells that can touch and are below the hardness, relative to max |u|, or to the local
    /// displacement if that is less.
    pub(super) overlap: f64,
    /// Whether force and moments are balanced.
    pub(super) balanced: bool,
    /// Whether the bounds allow the pressure; only [`Problem::judge`] checks it.
    pub(super) allowed: bool,
    /// Whether all sums are finite; [`Problem::judge`] checks the displacement of each cell as well.
    pub(super) finite: bool,
}

/// Smallest scale of the overlap, relative to max |u|. The rounding of displacements is some 1e-15 of them,
/// so that no smaller overlap can be asked for by the usual tolerance of 1e-8.
const SMALLEST_SCALE: f64 = 1e-6;

impl Quality {
    /// Whether the pressure is a solution within `tolerance`.
    pub(super) fn meets(&self, tolerance: f64) -> bool {
        let close = self.residual <= tolerance && self.overlap <= tolerance;
        self.balanced && self.allowed && self.finite && close
    }

    /// Whether sums overflowed, which no further iteration can mend.
    pub(super) fn overflows(&self) -> bool {
        !self.finite
    }
}

/// Extremes and sums over cells from which [`Problem::quality`] is found.
#[derive(Debug, Clone, Copy)]
pub(super) struct QualitySums {
    /// Deepest overlap −g below the hardness; 0 where nothing overlaps.
    overlap: f64,
    /// Largest magnitude of the displacement where the shape can touch.
    displacement: f64,
    /// Σ p u
    work: f64,
    /// Σ p|g| where no bound holds the pressure.
    mismatch: f64,
    /// Number of cells at the hardness.
    at_hardness: f64,
}

impl Total for QualitySums {
    const ZERO: Self =
        Self { overlap: 0.0, displacement: 0.0, work: 0.0, mismatch: 0.0, at_hardness: 0.0 };

    fn joined(self, other: Self) -> Self {
        let larger = |a: f64, b: f64| if b > a { b } else { a };
        Self {
            overlap: larger(self.overlap, other.overlap),
            displacement: larger(self.displacement, other.displacement),
            work: self.work + other.work,
            mismatch: self.mismatch + other.mismatch,
            at_hardness: self.at_hardness + other.at_hardness,
        }
    }
}

impl QualitySums {
    /// The sums from their values in one row: those of [`depths`] and of [`works`].
    pub(super) fn of_row(
        [overlap, displacement]: [f64; 2],
        [work, mismatch, at_hardness]: [f64; 3],
    ) -> Self {
        Self { overlap, displacement, work, mismatch, at_hardness }
    }
}

impl Problem<'_> {
    /// u = K p
    pub(super) fn apply(&self, p: &[f64], u: &mut [f64], workspace: &mut Workspace) {
        self.convolution.apply_slices(p, u, workspace);
    }

    /// Displacement of a cell under its own unit pressure.
    pub(super) fn self_influence(&self) -> f64 {
        self.convolution.self_influence()
    }

    /// The rows of the problem's arrays.
    pub(super) fn rows(&self) -> Rows<'_> {
        Rows::new(&self.freedoms.columns, self.convolution.own_threads())
    }

    /// λ that makes u + h − Bλ least over the cells whose pressure is free. Degrees of freedom that these cells do
    /// not determine are 0: one or two cells have no tilt.
    pub(super) fn fit(&self, p: &[f64], u: &[f64], h: &[f64]) -> [f64; 3] {
        let sums = self.rows().each([p, u, h], [], |row, fields, []| {
            fit_near([0.0; 3], row, self.bounds.row(row.number), fields)
        });
        self.freedoms.fitted(sums)
    }

    /// Computes the displacement `u` of a pressure that is zero outside `window`. Returns λ that makes the
    /// gap least over the contact, and the quality of `p`. Degrees of freedom that the contact does not
    /// determine stay as they are in `near`.
    pub(super) fn judge(
        &self,
        p: &[f64],
        window: &Window,
        u: &mut [f64],
        near: [f64; 3],
        workspace: &mut Workspace,
    ) -> (Multipliers, Quality) {
        let (multipliers, free_cells) = self.judge_near(p, window, u, near, workspace);
        if free_cells > 0.0 || !self.bounds.is_limited() {
            return multipliers;
        }
        let near = self.until_touching(p, u, near);
        self.judge_near(p, window, u, near, workspace).0
    }

    /// [`Problem::judge`] without a rule for contacts of which no pressure is free; the number of cells whose pressure
    /// is.
    fn judge_near(
        &self,
        p: &[f64],
        window: &Window,
        u: &mut [f64],
        near: [f64; 3],
        workspace: &mut Workspace,
    ) -> ((Multipliers, Quality), f64) {
        self.convolution.apply_rows(window[0].clone(), p, u, workspace);
        let (rows, inputs) = (self.rows(), [p, u, self.gap]);
        let fit = rows.each(inputs, [], |row, [p, u, h], []| {
            let inside = row.within(window, [p, u, h, self.bounds.row(row.number)]);
            inside.map_or(FitSums::ZERO, |(row, [p, u, h, limit])| {
                fit_near(near, row, limit, [p, u, h])
            })
        });
        let multipliers = Multipliers { base: near, change: self.freedoms.fitted(fit) };
        let (sums, [not_finite, not_allowed]) = rows.each(inputs, [], |row, [p, u, h], []| {
            let fields = [p, self.bounds.row(row.number), u, h];
            let (extremes, not_finite) = depths_of(multipliers, row, fields);
            let inside = row.within(window, fields);
            let carried = inside.map(|(row, fields)| row_sums(multipliers, row, fields));
            let RowSums { works, not_allowed } = carried.unwrap_or_default();
            let sums = QualitySums::of_row(extremes, works);
            (sums, [not_finite, not_allowed])
        });
        let quality = self.quality(sums, &fit);
        let quality = Quality {
            allowed: not_allowed <= 0.0,
            finite: quality.finite && not_finite <= 0.0,
            ..quality
        };
        ((multipliers, quality), fit.cells())
    }

    /// λ where no pressure is free to tell it: `near` it, the surfaces approach until the next cell touches.
    pub(super) fn until_touching(&self, p: &[f64], u: &[f64], near: [f64; 3]) -> [f64; 3] {
        if !self.bounds.is_limited() {
            return [0.0; 3];
        }
        if !self.freedoms.loaded[0] {
            return near;
        }
        let mut first = f64::INFINITY;
        self.freedoms.for_each(near, |k, b| {
            if p[k] <= 0.0 {
                first = first.min(self.gap[k] + u[k] - b);
            }
        });
        let further = if first.is_finite() { first } else { 0.0 };
        [near[0] + further, near[1], near[2]]
    }

    /// g = u + h − Bλ
    pub(super) fn gap_into(&self, u: &[f64], multipliers: Multipliers, g: &mut [f64]) {
        let fields = [u, self.gap];
        self.rows().each(fields, [g], |row, fields, [g]| {
            multipliers.gap(row, fields, g);
        });
    }

    /// Restores balance, by [`Problem::press_springs`] where the cells whose pressure is free cannot carry what is missing,
    /// as two cells cannot carry moments. `u` and `lambda` are those of a pressure near `p`.
    pub(super) fn rebalance(&self, p: &mut [f64], u: &[f64], lambda: [f64; 3]) {
        if !self.freedoms.balance(p, self.bounds) {
            let mut g = vec![0.0; p.len()];
            (self.freedoms).for_each(lambda, |k, b| g[k] = self.gap[k] + u[k] - b);
            self.press_springs(p, &g);
        }
    }

    /// Makes `p`, whose gap is `g`, a balanced pressure within the bounds: that of a spring in each cell which a motion
    /// loads and unloads. Returns whether there is one.
    pub(super) fn press_springs(&self, p: &mut [f64], g: &[f64]) -> bool {
        let rise = self.freedoms.typical_pressure(p.len());
        // Softer springs where too few cells lie between the bounds.
        [1.0, 1e-1, 1e-2, 1e-3].into_iter().any(|softer| {
            let spring = softer / self.self_influence();
            let mut pressed: Vec<f64> = p.iter().zip(g).map(|(p, g)| p - spring * g).collect();
            let balanced = self.freedoms.spread(&mut pressed, self.bounds, rise);
            if balanced {
                p.copy_from_slice(&pressed);
            }
            balanced
        })
    }

    /// The quality of a pressure with these sums, which is allowed; `fit` are its sums for the fit of λ.
    pub(super) fn quality(&self, sums: QualitySums, fit: &FitSums) -> Quality {
        // Before anything is deformed there is no scale: whatever overlaps, overlaps wholly.
        let relative = |a: f64, scale: f64| match (a > 0.0, scale > 0.0) {
            (true, true) => a / scale,
            (true, false) => f64::INFINITY,
            (false, _) => 0.0,
        };
        let [force, ..] = fit.moments;
        let far = sums.displacement;
        let pressed = fit.cells() + sums.at_hardness;
        let local = (self.local.under(force, pressed)).max(SMALLEST_SCALE * far);
        let work = sums.work.abs().min(local * force);
        Quality {
            residual: relative(sums.mismatch, work),
            overlap: relative(sums.overlap, local.min(far)),
            balanced: self.freedoms.on_target(fit.moments),
            allowed: true,
            finite: (sums.mismatch + sums.work + sums.overlap + far).is_finite(),
        }
    }
}

/// The sums of one row for the fit of λ − `near`.
fn fit_near(near: [f64; 3], row: Row, limit: &[f64], fields: [&[f64]; 3]) -> FitSums {
    let (base, slope) = (all(near[0] + near[1] * row.x), all(near[2]));
    Freedoms::fit_row(row, limit, fields, [], |[p, u, h, _, y], []| {
        ([], [p, (h - (base + slope * y)) + u])
    })
}

/// [`depths`] of one row; and a number that is 0 unless a displacement is not finite.
fn depths_of(multipliers: Multipliers, row: Row, [p, limit, u, h]: [&[f64]; 4]) -> ([f64; 2], f64) {
    let overlap = multipliers.overlap(row);
    let (extremes, [not_finite]) =
        update_with_largest([p, limit, u, h, row.y], [], |[p, limit, u, h, y], []| {
            ([], depths(p, limit, u, overlap([u, h, y])), [u * ZERO])
        });
    (extremes, not_finite)
}

/// Sums over one row.
#[derive(Debug, Clone, Copy, Default)]
struct RowSums {
    /// Work, mismatch and number of cells at the hardness, as [`works`] has them.
    works: [f64; 3],
    /// Number of pressures that are not allowed.
    not_allowed: f64,
}

/// Sums over one row of its cells' [`works`], and the number of its pressures that are not allowed.
fn row_sums(multipliers: Multipliers, row: Row, [p, limit, u, h]: [&[f64]; 4]) -> RowSums {
    let overlap = multipliers.overlap(row);
    let [work, mismatch, at_hardness, not_allowed] =
        sum([p, limit, u, h, row.y], |[p, limit, u, h, y]| {
            let [work, mismatch, at_hardness] = works(p, limit, u, overlap([u, h, y]));
            [work, mismatch, at_hardness, not_allowed(p, limit)]
        });
    RowSums { works: [work, mismatch, at_hardness], not_allowed }
}

/// Overlap of cells below the hardness, and the magnitude of the displacement of cells that can touch.
pub(super) fn depths(p: Lanes, limit: Lanes, u: Lanes, overlap: Lanes) -> [Lanes; 2] {
    let touches = overlap.simd_gt(all(f64::NEG_INFINITY));
    [is_below(p, limit) & overlap, touches & u.abs()]
}

/// Work p u of cells, mismatch p|g| where no bound holds the pressure, and 1 in cells at the hardness.
pub(super) fn works(p: Lanes, limit: Lanes, u: Lanes, overlap: Lanes) -> [Lanes; 3] {
    // The gap is infinite only where there is no pressure.
    let mismatch = where_positive(p, p * residual(p, limit, overlap).abs());
    [p * u, mismatch, is_below(p, limit).select(ZERO, ONE)]
}

/// Multipliers λ in two parts: at small loads h − Bλ is far smaller than either term, and taking the larger
/// part of λ from h first keeps its digits.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Multipliers {
    pub(super) base: [f64; 3],
    pub(super) change: [f64; 3],
}

impl Multipliers {
    /// λ
    pub(super) fn lambda(self) -> [f64; 3] {
        [0, 1, 2].map(|k| self.base[k] + self.change[k])
    }

    /// The overlap −g = Bλ − (u + h) of cells in a row, as a function of u, h and y.
    fn overlap(self, row: Row) -> impl Fn([Lanes; 3]) -> Lanes {
        let [[a, b], [c, d]] =
            [self.base, self.change].map(|l| [all(l[0] + l[1] * row.x), all(l[2])]);
        move |[u, h, y]| (c + d * y) - ((h - (a + b * y)) + u)
    }

    /// Writes the gap of a row.
    pub(super) fn gap(self, row: Row, [u, h]: [&[f64]; 2], g: &mut [f64]) {
        let overlap = self.overlap(row);
        update([u, h, row.y], [g], |fields, _| ([ZERO - overlap(fields)], []));
    }
}

/// Pressure and displacement of a problem, and their quality once it was checked.
pub(crate) struct SolutionFields {
    pub(crate) pressure: Array2<f64>,
    /// Window outside which the pressure is zero.
    pub(crate) window: Window,
    pub(crate) displacement: Array2<f64>,
    /// Multipliers of the displacement, once it was computed.
    pub(crate) multipliers: Multipliers,
    pub(crate) quality: Option<Quality>,
}

impl SolutionFields {
    /// Fields of zeros.
    pub(crate) fn new(shape: [usize; 2]) -> Self {
        Self {
            pressure: Array2::zeros(shape),
            window: [0..0, 0..0],
            displacement: Array2::zeros(shape),
            multipliers: Multipliers::default(),
            quality: None,
        }
    }

    /// The gap.
    pub(crate) fn gap(&self, problem: &Problem) -> Vec<f64> {
        let mut g = vec![0.0; problem.gap.len()];
        problem.gap_into(&slice(&self.displacement), self.multipliers, &mut g);
        g
    }

    /// The permanent indentation: −g of the cells at the hardness, 0 of the others.
    pub(crate) fn indentation(&self, problem: &Problem) -> Array2<f64> {
        let cells = self.gap(problem).into_iter().zip(&self.pressure).enumerate();
        let deeper = cells
            .map(|(k, (g, p))| if *p >= problem.bounds.limit(k) { (-g).max(0.0) } else { 0.0 });
        array([self.pressure.nrows(), self.pressure.ncols()], deeper.collect())
    }

    /// Takes the pressure of a window that holds the window before.
    pub(crate) fn take(&mut self, patch: &Patch) {
        let columns = self.pressure.ncols();
        patch.paste(slice_mut(&mut self.pressure), columns);
        self.window = patch.window.clone();
    }

    /// Lowers displacement and approach, which is loaded, by `distance`; the gap stays.
    pub(crate) fn lower(&mut self, distance: f64) {
        self.displacement -= distance;
        self.multipliers.base[0] -= distance;
    }

    /// Computes displacement, rigid motion and quality of the pressure afresh. Degrees of freedom that the
    /// contact does not determine stay as they are in `near`.
    pub(crate) fn certify(&mut self, problem: &Problem, near: [f64; 3]) -> Quality {
        let (p, window) = (slice(&self.pressure), &self.window);
        let workspace = &mut problem.convolution.workspace();
        let u = slice_mut(&mut self.displacement);
        let (multipliers, quality) = problem.judge(&p, window, u, near, workspace);
        self.multipliers = multipliers;
        self.quality = Some(quality);
        quality
    }
}

/// Values in C order as an array.
pub(crate) fn array(shape: [usize; 2], values: Vec<f64>) -> Array2<f64> {
    Array2::from_shape_vec(shape, values).unwrap_or_else(|_| Array2::zeros(shape))
}

/// Local displacements of contacts of any number of cells, to which residual and overlap are compared.
///
/// On a substrate that is much softer than its coat, the coat sinks in as a whole. This part of the
/// displacement does not change over the contact, and says nothing about how well the surfaces fit. The
/// local displacement is of the size of the part that does: of contacts of radius a with mean pressure p,
/// it is a multiple of p a D(1/a), where D(α) = α û/p̂ is the response of both bodies together. The estimate
/// was derived here.
#[derive(Debug, Clone)]
pub(crate) struct LocalDisplacement {
    /// Displacement per mean pressure \[m/Pa\] of contacts of 1, 2, 4, … cells.
    per_pressure: Vec<f64>,
}

/// Multiple of p a D(1/a) that counts as the local displacement. The largest displacement of a bare body is
/// less: 1.2 p a D under a sphere, 0.8 under a punch, 4 in a line contact on a grid of 160 half-widths.
/// Under a point contact on a coat 100 times harder than the substrate, it is 8 at most.
const MULTIPLE: f64 = 10.0;

impl LocalDisplacement {
    /// Tabulates the local displacements of `bodies` on the cells of `grid`.
    pub(crate) fn new(bodies: &[&Body], grid: &Grid) -> Self {
        let response = |alpha: f64| -> f64 {
            let of = |body: &&Body| body.normal(alpha) + alpha * body.local();
            bodies.iter().map(of).sum()
        };
        let [nx, ny] = grid.shape();
        let doublings = (nx * ny).ilog2() + 1;
        // Cells of a contact may lie apart: it is as soft as the softest contact of fewer cells.
        let mut softest = 0.0_f64;
        let per_pressure = (0..=doublings).map(|k| {
            let cells = f64::from(k).exp2();
            let radius = if grid.is_line() {
                0.5 * cells * grid.spacing()[1]
            } else {
                (cells * grid.cell_area() / PI).sqrt()
            };
            softest = softest.max(MULTIPLE * radius * response(1.0 / radius));
            softest
        });
        Self { per_pressure: per_pressure.collect() }
    }

    /// These displacements and those of springs of this mean compliance \[m/Pa\].
    pub(crate) fn with_springs(mut self, compliance: f64) -> Self {
        self.per_pressure.iter_mut().for_each(|c| *c += MULTIPLE * compliance);
        self
    }

    /// Local displacement \[m\] under a pressure with this `sum` over `cells` cells; 0 without cells.
    pub(crate) fn under(&self, sum: f64, cells: f64) -> f64 {
        if cells < 1.0 {
            return 0.0;
        }
        let doublings = cells.log2();
        let below = doublings as usize;
        let at = |k: usize| self.per_pressure.get(k).or(self.per_pressure.last());
        let [near, far] = [below, below + 1].map(|k| at(k).copied().unwrap_or(0.0));
        (near + (doublings - below as f64) * (far - near)) * sum / cells
    }
}

#[cfg(test)]
mod tests {
    use super::{LocalDisplacement, MULTIPLE};
    use crate::compliance::response::Body;
    use crate::error::Result;
    use crate::model::body::{HalfSpace, Layer};
    use crate::model::grid::Grid;
    use crate::model::material::Elastic;

    /// A bare body of E* = 1 has D = 2, so that the local displacement of a disc of radius a under a force F is
    /// 20 F/πa, and that of a strip under a line load F 10 F. Between powers of two, the table is linear in
    /// ln n, which misses n by up to 6 %.
    #[test]
    fn bare_bodies() -> Result<()> {
        let body = Body::from(Elastic::new(1.0, 0.0)?);
        for (grid, line) in
            [(Grid::new([64, 32], [4.0, 1.0])?, false), (Grid::line(64, 4.0)?, true)]
        {
            let local = LocalDisplacement::new(&[&body], &grid);
            for cells in [1.0, 3.0, 16.0, 37.0] {
                let area = cells * grid.cell_area();
                let radius = (area / std::f64::consts::PI).sqrt();
                let force = 0.7 * area;
                let expected = if line {
                    MULTIPLE * force
                } else {
                    2.0 * MULTIPLE * force / (std::f64::consts::PI * radius)
                };
                let displacement = local.under(0.7 * cells, cells);
                assert!((displacement / expected - 1.0).abs() < 0.07, "{displacement} {expected}");
            }
            assert!(local.under(0.0, 0.0).abs() <= 0.0);
        }
        Ok(())
    }

    /// On a substrate 1e12 times softer than the coat, a contact much smaller than the thickness has the
    /// local displacement of the coat.
    #[test]
    fn the_far_displacement_is_left_out() -> Result<()> {
        let (soft, hard) = (Elastic::new(1e-12, 0.3)?, Elastic::new(1.0, 0.3)?);
        let coated = Body::from(HalfSpace::new(soft, [Layer::new(hard, 100.0)?])?);
        let grid = Grid::new([8, 8], [8.0, 8.0])?;
        let [coat, bare] =
            [&coated, &Body::from(hard)].map(|body| LocalDisplacement::new(&[body], &grid));
        let ratio = coat.under(4.0, 4.0) / bare.under(4.0, 4.0);
        assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
        Ok(())
    }
}
