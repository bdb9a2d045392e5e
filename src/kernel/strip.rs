//! Influence coefficients of line contact: strips that are endless along x, in plane strain, and
//! under traction along x in antiplane shear.
//!
//! Each component is the cosine or sine transform of one function of the wavenumber. With
//! K = 1/π ∫ D {cos, sin} αy dα and S(y) = ∫₀^y K dy, the coefficient of a strip of width dy is
//! S(y + dy/2) − S(y − dy/2). D of a homogeneous half-space, (c0 + c1 αz) e^{−αz}, gives closed
//! forms; the rest is transformed in ln α ([`Series`]). Displacements, of which D/α is transformed,
//! grow as ln y: the rest's share D(0) e^{−αd}/α of that is another closed form.

use std::f64::consts::PI;

use super::COMPONENTS;
use super::mesh::{Kind, LogMesh, Order};
use super::series::Series;
use crate::body::HalfSpace;
use crate::grid::Grid;
use crate::material::Elastic;
use crate::response::interior::{Column, Fields, Place};

/// One function of the wavenumber: the component that it makes, with its sign.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Part {
    component: usize,
    sign: f64,
    sine: bool,
    displacement: bool,
}

const fn part(component: usize, sign: f64, sine: bool) -> Part {
    Part {
        component,
        sign,
        sine,
        displacement: component >= 6,
    }
}

/// A load on a strip.
pub(crate) trait StripLoad<const N: usize> {
    const PARTS: [Part; N];

    /// D of each part; displacements times α.
    fn functions(fields: &Fields, material: Elastic) -> [f64; N];
}

/// Unit pressure.
pub(crate) struct Pressure;

impl StripLoad<6> for Pressure {
    const PARTS: [Part; 6] = [
        part(0, 1.0, false),
        part(1, 1.0, false),
        part(2, -1.0, false),
        part(4, 1.0, true),
        part(7, -1.0, true),
        part(8, 1.0, false),
    ];

    fn functions(fields: &Fields, material: Elastic) -> [f64; 6] {
        let state = &fields.pressure;
        let (along, across) = state.lateral_stress(material);
        [across, along, state.p, state.tau, state.v, state.w]
    }
}

/// Unit traction along y.
pub(crate) struct Across;

impl StripLoad<6> for Across {
    const PARTS: [Part; 6] = [
        part(0, 1.0, true),
        part(1, 1.0, true),
        part(2, -1.0, true),
        part(4, -1.0, false),
        part(7, 1.0, false),
        part(8, 1.0, true),
    ];

    fn functions(fields: &Fields, material: Elastic) -> [f64; 6] {
        let state = &fields.shear;
        let (along, across) = state.lateral_stress(material);
        [across, along, state.p, state.tau, state.v, state.w]
    }
}

/// Unit traction along x.
pub(crate) struct Along;

impl StripLoad<3> for Along {
    const PARTS: [Part; 3] = [
        part(3, -1.0, true),
        part(5, -1.0, false),
        part(6, 1.0, false),
    ];

    fn functions(fields: &Fields, material: Elastic) -> [f64; 3] {
        let (q, u) = fields.twist;
        [material.shear() * u, q, u]
    }
}

/// What all depths of a line contact share.
#[derive(Debug)]
pub(crate) struct LinePlan {
    body: HalfSpace,
    cells: usize,
    width: f64,
    /// Where the displacement is measured from.
    datum: f64,
    thickness: f64,
    spectrum: Option<(LogMesh, Vec<(f64, Column)>)>,
}

impl LinePlan {
    /// For the grid's strips, and pieces down to `finest` of them.
    pub(crate) fn new(body: &HalfSpace, grid: &Grid, finest: f64) -> Self {
        let thickness: f64 = body.layers().iter().map(crate::Layer::thickness).sum();
        let (width, datum) = (grid.spacing()[1], grid.size()[1]);
        let spectrum = body.layers().first().map(|top| {
            let mesh = LogMesh::new(
                top.thickness(),
                thickness,
                [0.4 * finest * width, 2.0 * datum],
            );
            let columns = mesh
                .wavenumbers()
                .map(|alpha| (alpha, Column::new(body, alpha)))
                .collect();
            (mesh, columns)
        });
        Self {
            body: body.clone(),
            cells: grid.shape()[1],
            width,
            datum,
            thickness,
            spectrum,
        }
    }

    /// Components at offsets of 0, 1, … cells from a strip under a unit load.
    pub(crate) fn coefficients<const N: usize, L: StripLoad<N>>(
        &self,
        place: &Place,
    ) -> Vec<[f64; COMPONENTS]> {
        let strips = self.strips::<N, L>(place);
        // S at the edges of the cells, (j ± ½) dy.
        let mut before = strips.integral(-0.5 * self.width);
        (0..self.cells)
            .map(|j| {
                let next = strips.integral((j as f64 + 0.5) * self.width);
                let values = strips.components(&before, &next);
                before = next;
                values
            })
            .collect()
    }

    /// Components of strips of any width at one place.
    pub(crate) fn strips<const N: usize, L: StripLoad<N>>(&self, place: &Place) -> Strips<N> {
        let (material, depth) = (place.material, place.depth);
        let unit = |y: f64| L::functions(&Fields::homogeneous(material, y), material);
        let (zero, one) = (unit(0.0), unit(1.0));
        Strips {
            parts: L::PARTS,
            closed: std::array::from_fn(|k| Closed {
                c0: zero[k],
                c1: one[k] * std::f64::consts::E - zero[k],
                depth,
            }),
            rest: self.rest::<N, L>(place, self.thickness + depth),
            datum: self.datum,
        }
    }

    /// Of the difference between the body and a half-space of what is at `place`.
    fn rest<const N: usize, L: StripLoad<N>>(
        &self,
        place: &Place,
        image_depth: f64,
    ) -> Option<(Series<N>, [Closed; N])> {
        let (mesh, columns) = self.spectrum.as_ref()?;
        let material = place.material;
        let difference = |alpha: f64, column: &Column| -> [f64; N] {
            let layered = L::functions(&column.at(&self.body, place), material);
            let homogeneous = Fields::homogeneous(material, alpha * place.depth);
            let homogeneous = L::functions(&homogeneous, material);
            std::array::from_fn(|k| layered[k] - homogeneous[k])
        };
        let (lowest, column) = columns.first()?;
        let limit = difference(*lowest, column);
        let images = std::array::from_fn(|k| Closed {
            c0: if L::PARTS[k].displacement {
                limit[k]
            } else {
                0.0
            },
            c1: 0.0,
            depth: image_depth,
        });
        let mut samples: [Vec<f64>; N] = std::array::from_fn(|_| Vec::new());
        for (alpha, column) in columns {
            let values = difference(*alpha, column);
            // Below this wavenumber nothing is seen at any distance of interest, but D − D(0)
            // cancels.
            let seen = (alpha * self.thickness.max(self.datum) / 1e-10).powi(2);
            for k in 0..N {
                let value = if L::PARTS[k].displacement {
                    let image = images[k].c0 * (-alpha * image_depth).exp();
                    (values[k] - image) / alpha * (seen / (1.0 + seen))
                } else {
                    values[k]
                };
                samples[k].push(value * alpha.sqrt());
            }
        }
        let orders = L::PARTS.map(|part| Order {
            nu: if part.sine { 0.5 } else { -0.5 },
            kind: Kind::Line,
        });
        let multipliers = orders.map(|order| mesh.multipliers(order));
        Some((
            Series::new(mesh, &orders, &multipliers, samples, 0.0),
            images,
        ))
    }
}

/// A load at one depth, on strips of any width.
pub(crate) struct Strips<const N: usize> {
    parts: [Part; N],
    closed: [Closed; N],
    rest: Option<(Series<N>, [Closed; N])>,
    datum: f64,
}

impl<const N: usize> Strips<N> {
    /// Components at y from the middle of a strip of half width `half` under a unit load.
    pub(crate) fn at(&self, y: f64, half: f64) -> [f64; COMPONENTS] {
        self.components(&self.integral(y - half), &self.integral(y + half))
    }

    /// S(y).
    fn integral(&self, y: f64) -> [f64; N] {
        let mut sums: [f64; N] =
            std::array::from_fn(|k| self.closed[k].integral(self.parts[k], y, self.datum));
        if let Some((series, images)) = &self.rest {
            let [mean] = series.mean([y.abs()]);
            for (k, sum) in sums.iter_mut().enumerate() {
                let sign = if self.parts[k].sine { 1.0 } else { y.signum() };
                *sum += sign * mean[k] + images[k].integral(self.parts[k], y, self.datum);
            }
        }
        sums
    }

    /// Between two places.
    fn components(&self, before: &[f64; N], next: &[f64; N]) -> [f64; COMPONENTS] {
        let mut values = [0.0; COMPONENTS];
        for (k, part) in self.parts.iter().enumerate() {
            values[part.component] = part.sign * (next[k] - before[k]);
        }
        values
    }
}

/// D = (c0 + c1 αz) e^{−αz}.
struct Closed {
    c0: f64,
    c1: f64,
    depth: f64,
}

impl Closed {
    /// S(y), up to a constant; with R² = y² + z² and the datum ℓ, π times
    ///
    /// ```text
    ///          c0                                        c1
    /// cos      atan(y/z)                                 z y/R²
    /// sin      ln R                                      −z²/R²
    /// cos/α    −y ln(R/ℓ) + y − z atan(y/z)              z atan(y/z)
    /// sin/α    y atan(y/z) − z ln R                      z ln R
    /// ```
    fn integral(&self, part: Part, y: f64, datum: f64) -> f64 {
        let Self { c0, c1, depth: z } = *self;
        let square = y * y + z * z;
        // In units of the datum, so that logarithms are of numbers.
        let log = 0.5 * (square / (datum * datum)).ln();
        let angle = if z > 0.0 {
            (y / z).atan()
        } else {
            0.5 * PI * y.signum()
        };
        let (first, second) = match (part.sine, part.displacement) {
            (false, false) => (angle, z * y / square),
            (true, false) => (log, -z * z / square),
            (false, true) => (y - y * log - z * angle, z * angle),
            (true, true) => (y * angle - z * log, z * log),
        };
        (c0 * first + c1 * second) / PI
    }
}
