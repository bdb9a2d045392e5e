//! Influence coefficients of stress and displacement at one depth, without aliasing.
//!
//! The layered body at a place differs from a half-space of the material that is there by a
//! response whose transforms ([`Series`]) are smooth.
//!
//! - On the loaded cell and next to it: the half-space in closed form ([`super::rectangle`]), and the
//!   difference by the sum over the corners of
//!
//! ```text
//! ∫₀^x ∫₀^y H_ν(r) a(φ) dy dx = x ∫ η_ν(x cosh u) a du + y ∫ η_ν(y cosh u) a du
//! ```
//!
//!   with tan φ = sinh u, and its inverse in the second; this holds however thin a layer is.
//! - Farther off, or deeper: both together from one table, by Gauss quadrature over the cell.

use rayon::prelude::*;

use super::cells::FAR;
use super::loads::{COMPONENTS, Load, PointLoad};
use super::series::{LogMesh, Series};
use super::table::{Coarse, Fine};
use crate::body::HalfSpace;
use crate::kernel::quadrature::{Rule, Rules};
use crate::material::Elastic;
use crate::response::interior::{Column, Fields, Place};

/// Singularities of the kernels lie in a sector beside the imaginary axis: to the rules they are
/// nearer than they are.
const SECTOR: f64 = 0.7;

/// What all depths of a body share.
#[derive(Debug)]
pub(crate) struct Plan {
    pub(crate) body: HalfSpace,
    spacing: [f64; 2],
    /// Nearest distance to a corner of a cell, or of a piece of one.
    nearest: f64,
    reach: f64,
    rules: Rules,
    panel: Rule,
    /// Where the body is layered.
    spectrum: Option<Spectrum>,
}

/// The body at all wavenumbers.
#[derive(Debug)]
struct Spectrum {
    mesh: LogMesh,
    columns: Vec<(f64, Column)>,
}

impl Plan {
    /// For cells of sides `spacing`, and pieces down to `finest` of them, at offsets up to `reach`.
    pub(crate) fn new(body: &HalfSpace, spacing: [f64; 2], finest: f64, reach: f64) -> Self {
        let nearest = NEAREST * finest * 0.5 * spacing[0].min(spacing[1]);
        let thickness: f64 = body.layers().iter().map(crate::Layer::thickness).sum();
        let spectrum = body.layers().first().map(|top| {
            let mesh = LogMesh::new(top.thickness(), thickness, [nearest, reach]);
            let columns = mesh
                .wavenumbers()
                .map(|alpha| (alpha, Column::new(body, alpha)))
                .collect();
            Spectrum { mesh, columns }
        });
        Self {
            body: body.clone(),
            spacing,
            nearest,
            reach,
            rules: Rules::coarse(),
            panel: Rule::gauss_legendre(10),
            spectrum,
        }
    }

    /// Transforms of powers of the wavenumber, for the functions of a load.
    pub(crate) fn multipliers<const N: usize, L: Load<N>>(&self) -> Vec<Vec<(f64, f64)>> {
        let of = |spectrum: &Spectrum| L::ORDERS.map(|order| spectrum.mesh.multipliers(order));
        self.spectrum
            .as_ref()
            .map(of)
            .into_iter()
            .flatten()
            .collect()
    }
}

/// How near to a corner of a cell distances go, in half sides.
const NEAREST: f64 = 0.4;

/// The coefficients of one load at one place.
#[derive(Debug)]
pub(crate) struct Kernel<'a, const N: usize> {
    plan: &'a Plan,
    material: Elastic,
    depth: f64,
    /// h_ν, of the layered body.
    whole: Coarse<N>,
    /// The same, far off.
    far: Fine<N>,
    /// η_ν of the difference, where there is one and cells are not small against the depth.
    mean: Option<Coarse<N>>,
}

impl<'a, const N: usize> Kernel<'a, N> {
    /// On the threads of the caller.
    pub(crate) fn new<L: Load<N>>(
        plan: &'a Plan,
        multipliers: &[Vec<(f64, f64)>],
        place: &Place,
    ) -> Self {
        let (material, depth) = (place.material, place.depth);
        let point = PointLoad::new::<L>(material, depth);
        let series = plan.spectrum.as_ref().map(|spectrum| {
            let sample = |(alpha, column): &(f64, Column)| -> [f64; N] {
                let layered = L::radial(&column.at(&plan.body, place), material);
                let homogeneous = Fields::homogeneous(material, alpha * depth);
                let homogeneous = L::radial(&homogeneous, material);
                std::array::from_fn(|k| layered[k] - homogeneous[k])
            };
            let differences: Vec<_> = spectrum.columns.par_iter().map(sample).collect();
            let samples = std::array::from_fn(|k| {
                let bias = L::ORDERS[k].kind.bias();
                let columns = spectrum.columns.iter().zip(&differences);
                columns
                    .map(|((alpha, _), difference)| alpha.powf(bias) * difference[k])
                    .collect()
            });
            Series::new(&spectrum.mesh, &L::ORDERS, multipliers, samples, depth)
        });
        let half = plan.spacing.map(|d| 0.5 * d);
        let (least, most) = (half[0].min(half[1]), half[0].max(half[1]));
        // Deep enough, no cell is treated as near.
        let nearest = if plan.rules.at(SECTOR * depth / least).is_some() {
            0.0
        } else {
            plan.nearest
        };
        let whole = Coarse::new([nearest, plan.reach], depth * depth, |r| {
            let mut h = r.map(|r| point.at(r * r));
            if let Some(series) = &series {
                let rest = series.reduced(r);
                let pairs = h.iter_mut().flatten().zip(rest.iter().flatten());
                pairs.for_each(|(h, d)| *h += d);
            }
            h
        });
        let mean = series
            .filter(|_| nearest > 0.0)
            .map(|series| Coarse::new([nearest, 12.0 * most], 0.0, |r| series.mean(r)));
        // Differences reach one cell further in.
        let far = 2.0 * (FAR - 2.0) * most;
        let start = (far * far - depth * depth).max(0.0).sqrt();
        let far = Fine::new([start.min(plan.reach), plan.reach], depth * depth, |r| {
            r.map(|r| whole.at(r * r))
        });
        Self {
            plan,
            material,
            depth,
            whole,
            far,
            mean,
        }
    }

    /// Components of a unit load on a cell of half sides `half`, at (x, y) from its centre.
    pub(crate) fn at<L: Load<N>>(
        &self,
        [x, y]: [f64; 2],
        half @ [a, b]: [f64; 2],
    ) -> [f64; COMPONENTS] {
        let outside = [(x.abs() - a).max(0.0), (y.abs() - b).max(0.0), self.depth];
        let distance = SECTOR * outside.iter().map(|d| d * d).sum::<f64>().sqrt();
        let rule = |half: f64| self.plan.rules.at(distance / half);
        let mut sum = [0.0; COMPONENTS];
        let mut add = |weight: f64, values: [f64; COMPONENTS]| {
            sum.iter_mut()
                .zip(values)
                .for_each(|(s, v)| *s += weight * v);
        };
        let whole = |x: f64, y: f64| self.point::<L>(x, y);
        match (rule(a), rule(b)) {
            (Some(along), Some(across)) => {
                for (x, wx) in along.nodes(x, a) {
                    for (y, wy) in across.nodes(y, b) {
                        add(wx * wy, whole(x, y));
                    }
                }
            }
            (None, Some(across)) => {
                for (y, wy) in across.nodes(y, b) {
                    self.strip(x - a, x + a, y, |x, wx| add(wx * wy, whole(x, y)));
                }
            }
            (Some(along), None) => {
                for (x, wx) in along.nodes(x, a) {
                    self.strip(y - b, y + b, x, |y, wy| add(wx * wy, whole(x, y)));
                }
            }
            (None, None) => {
                add(1.0, L::closed(self.material, half, [x, y], self.depth));
                if let Some(mean) = &self.mean {
                    for (sign, x, y) in [
                        (1.0, x + a, y + b),
                        (-1.0, x - a, y + b),
                        (-1.0, x + a, y - b),
                        (1.0, x - a, y - b),
                    ] {
                        self.corner::<L>(mean, x, y, |weight, values| add(sign * weight, values));
                    }
                }
            }
        }
        sum
    }

    /// Components of a unit load on a point, at (x, y) from it, where that is far.
    #[inline]
    pub(crate) fn far<L: Load<N>>(&self, x: f64, y: f64) -> [f64; COMPONENTS] {
        L::components(&self.far.at(x * x + y * y), x, y)
    }

    /// The same anywhere.
    fn point<L: Load<N>>(&self, x: f64, y: f64) -> [f64; COMPONENTS] {
        L::components(&self.whole.at(x * x + y * y), x, y)
    }

    /// Nodes of a quadrature from x1 to x2 of a function that varies over √(x² + y² + z²).
    fn strip(&self, x1: f64, x2: f64, y: f64, mut node: impl FnMut(f64, f64)) {
        let scale = y.hypot(self.depth);
        if x1 > scale {
            for (v, weight) in self.plan.panel.panels(x1.ln(), x2.ln()) {
                let x = v.exp();
                node(x, x * weight);
            }
        } else if x2 < -scale {
            for (v, weight) in self.plan.panel.panels((-x2).ln(), (-x1).ln()) {
                let x = v.exp();
                node(-x, x * weight);
            }
        } else {
            let ends = [x1, x2].map(|x| (x / scale).asinh());
            for (u, weight) in self.plan.panel.panels(ends[0], ends[1]) {
                node(scale * u.sinh(), scale * u.cosh() * weight);
            }
        }
    }

    /// Integral of the difference over the rectangle from the origin to (x, y).
    fn corner<L: Load<N>>(
        &self,
        mean: &Coarse<N>,
        x: f64,
        y: f64,
        mut add: impl FnMut(f64, [f64; COMPONENTS]),
    ) {
        let (sx, sy) = (x.signum(), y.signum());
        let (x, y) = (x.abs(), y.abs());
        for (near, far, first) in [(x, y, true), (y, x, false)] {
            for (u, weight) in self.plan.panel.panels(0.0, (far / near).asinh()) {
                let cosh = u.cosh();
                let (cos, sin) = (1.0 / cosh, u.tanh());
                let (cos, sin) = if first { (cos, sin) } else { (sin, cos) };
                let r = near * cosh;
                let values = L::components(&mean.at(r * r), sx * cos, sy * sin);
                add(sx * sy * near * weight, values);
            }
        }
    }
}
