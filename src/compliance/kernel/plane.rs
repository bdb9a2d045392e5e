//! Influence coefficients of stress and displacement at one depth, without aliasing.
//!
//! The layered body at a place differs from a half-space of the material that is there by a
//! response whose transforms ([`Series`]) are smooth.
//!
//! On the loaded cell and next to it, the half-space is taken in closed form ([`super::rectangle`]) and the difference is
//! integrated from its corners ([`super::quadrature`]). Farther off, or deeper, one table holds both together, to be
//! integrated over the cell. Far off, at R = √(r² + z²) ≫ dx, dy, the mean over a cell is that of the kernel's values at
//! the centres of cells around it,
//!
//! ```text
//! K̄ = K + (δ_x² + δ_y²) K / 24          δ² the second difference
//! ```
//!
//! Its error, 17/5760 δ⁴ K, is below 1e-7 of K from [`FAR`] cells on, and 1e-8 of the pressure in a sum
//! over any number of cells.

use std::ops::Range;
use std::sync::OnceLock;

use super::COMPONENTS;
use super::loads::{Load, PointLoad, Radial};
use super::quadrature::{CellRules, Rules};
use super::series::{Order, Series, Spectrum, TermTransforms};
use super::strip::LinePlan;
use super::table::{FewPieces, FewTerms};
use crate::compliance::response::interior::Place;
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;
use crate::model::material::Elastic;
use crate::numerics::fft::Keep;
use crate::numerics::rounding::cells_within;

/// The plan of a body's kernels, which all depths share.
#[derive(Debug)]
pub(crate) struct CellPlan {
    pub(crate) body: HalfSpace,
    spacing: [f64; 2],
    /// Nearest distance to a corner of a cell, or of a piece of one.
    nearest: f64,
    reach: f64,
    cells: CellRules,
    /// None where the body is homogeneous.
    spectrum: Option<Spectrum>,
    /// Transforms of powers of the wavenumber for the functions of a pressure, and of a traction.
    transforms: [OnceLock<Vec<TermTransforms>>; 2],
}

impl CellPlan {
    /// Plans kernels for cells of sides `spacing`, and pieces down to `finest` of them, at offsets up to `reach`.
    pub(crate) fn new(body: &HalfSpace, spacing: [f64; 2], finest: f64, reach: f64) -> Self {
        let nearest = NEAREST_CORNER * finest * 0.5 * spacing[0].min(spacing[1]);
        Self {
            body: body.clone(),
            spacing,
            nearest,
            reach,
            cells: CellRules::new(Rules::stress()),
            spectrum: Spectrum::new(body, [nearest, reach]),
            transforms: Default::default(),
        }
    }

    /// Transforms for the functions of a load, made at the first place: without rayon, so that a thread that waits for
    /// them cannot be asked to make them.
    fn transforms<const N: usize, L: Radial<N>>(&self, spectrum: &Spectrum) -> &[TermTransforms] {
        let of = |order: &Order| spectrum.mesh.transforms(*order);
        let all = || L::Load::ORDERS.iter().map(of).collect();
        let known = &self.transforms[usize::from(L::IS_TRACTION)];
        &known.get_or_init(all)[L::FIRST..][..N]
    }
}

/// Nearest distance to a corner of a cell, in half sides: half a side, and some more for the nodes of
/// quadratures.
const NEAREST_CORNER: f64 = 0.4;

/// The coefficients of one load at one place.
#[derive(Debug)]
pub(crate) struct Kernel<'a, const N: usize> {
    plan: &'a CellPlan,
    material: Elastic,
    depth: f64,
    /// h_ν of the layered body.
    layered: FewPieces<N>,
    /// h_ν of the layered body far off.
    far: FewTerms<N>,
    /// η_ν of the difference from a half-space, where there is one and cells are not small compared with the
    /// depth.
    mean_difference: Option<FewPieces<N>>,
}

impl<'a, const N: usize> Kernel<'a, N> {
    /// The kernel of load L at `place`. On the threads of the caller.
    pub(crate) fn new<L: Radial<N>>(plan: &'a CellPlan, place: &Place) -> Self {
        let (material, depth, orders) = (place.material, place.depth, L::orders());
        let point = PointLoad::new::<L>(material, depth);
        let series = plan.spectrum.as_ref().map(|spectrum| {
            let differences = spectrum.differences(&plan.body, place, L::radial);
            let samples = std::array::from_fn(|k| {
                let bias = orders[k].kind.bias();
                let values = differences.iter();
                values.map(|(alpha, d)| alpha.powf(bias) * d[k]).collect()
            });
            let transforms = plan.transforms::<N, L>(spectrum);
            Series::new(&spectrum.mesh, &orders, transforms, samples, depth)
        });
        let half = plan.spacing.map(|d| 0.5 * d);
        let (least, most) = (half[0].min(half[1]), half[0].max(half[1]));
        // Deep enough, no cell is treated as near.
        let nearest = if plan.cells.all_far(depth, least) { 0.0 } else { plan.nearest };
        let layered = FewPieces::new([nearest, plan.reach], depth * depth, |r| {
            let mut h = r.map(|r| point.at(r * r));
            if let Some(series) = &series {
                let rest = series.reduced(r);
                let pairs = h.iter_mut().flatten().zip(rest.iter().flatten());
                pairs.for_each(|(h, d)| *h += d);
            }
            h
        });
        let mean_difference = series
            .filter(|_| nearest > 0.0)
            .map(|series| FewPieces::new([nearest, 12.0 * most], 0.0, |r| series.mean(r)));
        // Differences reach one cell further in.
        let far = 2.0 * (FAR - 2.0) * most;
        let start = (far * far - depth * depth).max(0.0).sqrt();
        let far = FewTerms::new([start.min(plan.reach), plan.reach], depth * depth, |r| {
            r.map(|r| layered.at(r * r))
        });
        Self { plan, material, depth, layered, far, mean_difference }
    }

    /// Components of a unit load on a cell of half sides `half`, at (x, y) from its centre.
    pub(crate) fn at<L: Radial<N>>(&self, at: [f64; 2], half: [f64; 2]) -> [f64; COMPONENTS] {
        let mut sum = [0.0; COMPONENTS];
        let mut add = |weight: f64, values: [f64; COMPONENTS]| {
            sum.iter_mut().zip(values).for_each(|(s, v)| *s += weight * v);
        };
        let cells = &self.plan.cells;
        let point = |x: f64, y: f64| L::components(&self.layered.at(x * x + y * y), x, y);
        if !cells.nodes(at, half, self.depth, |weight, x, y| add(weight, point(x, y))) {
            add(1.0, L::Load::closed(self.material, half, at, self.depth));
            if let Some(mean) = &self.mean_difference {
                cells.corners(at, half, |weight, r, [cos, sin]| {
                    add(weight, L::components(&mean.at(r * r), cos, sin));
                });
            }
        }
        sum
    }

    /// Components of a unit load on a point, at (x, y) from it, where that is far.
    #[inline]
    pub(crate) fn far<L: Radial<N>>(&self, x: f64, y: f64) -> [f64; COMPONENTS] {
        L::components(&self.far.at(x * x + y * y), x, y)
    }
}

/// Plans of cells, or of strips of line contact.
#[derive(Debug)]
pub(crate) enum Kernels {
    Plane(Box<CellPlan>),
    Line(Box<LinePlan>),
}

impl Kernels {
    /// Plans kernels on `grid`, of pieces down to `finest` of a cell, at offsets up to `reach`.
    pub(crate) fn new(body: &HalfSpace, grid: &Grid, finest: f64, reach: f64) -> Self {
        match grid.is_line() {
            true => Self::Line(Box::new(LinePlan::new(body, grid, finest))),
            false => Self::Plane(Box::new(CellPlan::new(body, grid.spacing(), finest, reach))),
        }
    }
}

/// Distance, in longer sides of a cell, from which differences are used.
pub(crate) const FAR: f64 = 60.0;

/// Where the coefficients of C components come from.
pub(crate) struct CellSource<M, P, const C: usize> {
    /// Numbers of offsets along x and y.
    pub(crate) offsets: [usize; 2],
    pub(crate) spacing: [f64; 2],
    pub(crate) depth: f64,
    /// Whether row i is at i + ½ cells along x: its offsets lead to the line between two rows.
    pub(crate) between: bool,
    /// Whether each component is odd in x and in y.
    pub(crate) odd: [[bool; 2]; C],
    /// Mean over a cell at an offset, times its area.
    pub(crate) mean: M,
    /// Value at a point that is far.
    pub(crate) point: P,
}

pub(crate) trait ComponentsAt: Fn(f64, f64) -> [f64; COMPONENTS] + Sync {}

impl<F: Fn(f64, f64) -> [f64; COMPONENTS] + Sync> ComponentsAt for F {}

impl<M: ComponentsAt, P: ComponentsAt, const C: usize> CellSource<M, P, C> {
    /// Gives `keep` the coefficients of `rows`.
    pub(crate) fn rows(&self, rows: Range<usize>, keep: &mut Keep) {
        let ny = self.offsets[1];
        let width = ny + 1;
        let memory = || vec![0.0; C * width];
        let (mut before, mut here, mut after) = (memory(), memory(), memory());
        let mut means = vec![0.0; C * ny];
        self.points(rows.start, &mut here);
        match rows.start {
            // The row before the first mirrors the row after it or, between rows, the first.
            0 => {
                self.points(usize::from(!self.between), &mut before);
                for (row, [odd, _]) in before.chunks_exact_mut(width).zip(self.odd) {
                    if odd {
                        row.iter_mut().for_each(|value| *value = -*value);
                    }
                }
            }
            first => self.points(first - 1, &mut before),
        }
        for i in rows {
            self.points(i + 1, &mut after);
            self.means(i, [&before, &here, &after], &mut means);
            for (k, row) in means.chunks_exact(ny).enumerate() {
                keep(i, k, row);
            }
            std::mem::swap(&mut before, &mut here);
            std::mem::swap(&mut here, &mut after);
        }
    }

    fn along_x(&self, i: usize) -> f64 {
        let half = if self.between { 0.5 } else { 0.0 };
        (i as f64 + half) * self.spacing[0]
    }

    /// The first offset in row i that is far.
    fn first(&self, i: usize) -> usize {
        let [dx, dy] = self.spacing;
        let far = FAR * dx.max(dy);
        let rest = far * far - self.depth * self.depth - (i as f64 * dx).powi(2);
        if rest <= 0.0 { 0 } else { cells_within(rest.sqrt(), dy).min(self.offsets[1]) }
    }

    /// Computes the values at the points of row i that differences need, one component after another.
    fn points(&self, i: usize, row: &mut [f64]) {
        let width = self.offsets[1] + 1;
        let [_, dy] = self.spacing;
        let start = self.first(i + 1).min(self.first(i).saturating_sub(1));
        let x = self.along_x(i);
        for j in start..width {
            let values = (self.point)(x, j as f64 * dy);
            for k in 0..C {
                row[k * width + j] = values[k];
            }
        }
    }

    /// Computes the coefficients of row i, from the points of three rows.
    fn means(&self, i: usize, [before, here, after]: [&[f64]; 3], means: &mut [f64]) {
        let ny = self.offsets[1];
        let width = ny + 1;
        let [dx, dy] = self.spacing;
        let area = dx * dy;
        let start = self.first(i);
        for j in 0..start {
            let values = (self.mean)(self.along_x(i), j as f64 * dy);
            for k in 0..C {
                means[k * ny + j] = values[k];
            }
        }
        if start == ny {
            return;
        }
        // K + (Σ − 4 K)/24, with the sum Σ over the neighbours.
        let (of_sum, of_here) = (area / 24.0, area * 20.0 / 24.0);
        for (k, out) in means.chunks_exact_mut(ny).enumerate() {
            let [before, here, after] =
                [before, here, after].map(|row| &row[k * width..(k + 1) * width]);
            let begin = start.max(1);
            if start == 0 {
                let left = if self.odd[k][1] { -here[1] } else { here[1] };
                let sum = before[0] + after[0] + left + here[1];
                out[0] = of_here * here[0] + of_sum * sum;
            }
            let across = before[begin..ny].iter().zip(&after[begin..ny]);
            let along = here[begin - 1..ny - 1].iter().zip(&here[begin + 1..]);
            let middle = out[begin..].iter_mut().zip(&here[begin..ny]);
            for (((out, here), (a, b)), (c, d)) in middle.zip(across).zip(along) {
                *out = of_here * here + of_sum * ((a + b) + (c + d));
            }
        }
    }
}
