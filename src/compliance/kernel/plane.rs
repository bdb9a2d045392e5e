//! Influence coefficients of stress and displacement at one depth, without aliasing.
//!
//! The layered body at a place differs from a half-space of the material that is there by a
//! response whose transforms ([`Series`]) are smooth.
//!
//! On the loaded cell and next to it, the half-space is taken in closed form ([`super::rectangle`]) and the difference is integrated from its corners ([`super::quadrature`]). Farther
//! off, or deeper, one table holds both together, to be integrated over the cell.

use std::sync::OnceLock;

use super::COMPONENTS;
use super::cells::FAR;
use super::loads::{Load, PointLoad, Radial};
use super::mesh::{Multipliers, Spectrum};
use super::quadrature::{CellRules, Rules};
use super::series::Series;
use super::strip::LinePlan;
use super::table::{FewPieces, FewTerms};
use crate::compliance::response::interior::Place;
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;
use crate::model::material::Elastic;

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
        }
    }

    /// Transforms of powers of the wavenumber, for the functions of a load.
    pub(crate) fn multipliers<const N: usize, L: Radial<N>>(&self) -> Vec<Multipliers> {
        let of = |spectrum: &Spectrum| L::orders().map(|order| spectrum.mesh.multipliers(order));
        self.spectrum.as_ref().map(of).into_iter().flatten().collect()
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
    pub(crate) fn new<L: Radial<N>>(
        plan: &'a CellPlan,
        multipliers: &[Multipliers],
        place: &Place,
    ) -> Self {
        let (material, depth, orders) = (place.material, place.depth, L::orders());
        let point = PointLoad::new::<L>(material, depth);
        let series = plan.spectrum.as_ref().map(|spectrum| {
            let differences = spectrum.differences(&plan.body, place, L::radial);
            let samples = std::array::from_fn(|k| {
                let bias = orders[k].kind.bias();
                let values = differences.iter();
                values.map(|(alpha, d)| alpha.powf(bias) * d[k]).collect()
            });
            Series::new(&spectrum.mesh, &orders, multipliers, samples, depth)
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
    Plane {
        plan: Box<CellPlan>,
        pressure: Vec<Multipliers>,
        /// Multipliers of the traction, made at the first place with friction.
        traction: OnceLock<Vec<Multipliers>>,
    },
    Line(LinePlan),
}

impl Kernels {
    /// Plans the load L on pieces down to `finest` of a cell, at offsets up to `reach`. It runs on the threads
    /// of the caller.
    pub(crate) fn new<const N: usize, L: Radial<N>>(
        body: &HalfSpace,
        grid: &Grid,
        finest: f64,
        reach: f64,
    ) -> Self {
        if grid.is_line() {
            return Self::Line(LinePlan::new(body, grid, finest));
        }
        Self::of_cells::<N, L>(body, grid.spacing(), finest, reach)
    }

    /// [`Kernels::new`] for cells of sides `spacing`.
    pub(crate) fn of_cells<const N: usize, L: Radial<N>>(
        body: &HalfSpace,
        spacing: [f64; 2],
        finest: f64,
        reach: f64,
    ) -> Self {
        let plan = CellPlan::new(body, spacing, finest, reach);
        Self::Plane {
            pressure: plan.multipliers::<N, L>(),
            traction: OnceLock::new(),
            plan: Box::new(plan),
        }
    }
}
