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
use super::series::{Order, Series, Spectrum, TransformKind, homogeneous};
use crate::compliance::response::Response;
use crate::compliance::response::interior::{InPlane, Place, UnitFields};
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;
use crate::model::material::Elastic;

/// The component that one function of the wavenumber makes, with its sign.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StripOutput {
    component: usize,
    sign: f64,
    sine: bool,
    displacement: bool,
}

const fn output(component: usize, sign: f64, sine: bool) -> StripOutput {
    StripOutput { component, sign, sine, displacement: component >= 6 }
}

/// A load on a strip.
pub(crate) trait StripLoad<const N: usize> {
    const OUTPUTS: [StripOutput; N];

    /// D of each output; displacements times α.
    fn functions(fields: &UnitFields, material: Elastic) -> [f64; N];
}

/// Unit pressure.
pub(crate) struct StripPressure;

impl StripLoad<6> for StripPressure {
    const OUTPUTS: [StripOutput; 6] = [
        output(0, 1.0, false),
        output(1, 1.0, false),
        output(2, -1.0, false),
        output(4, 1.0, true),
        output(7, -1.0, true),
        output(8, 1.0, false),
    ];

    fn functions(fields: &UnitFields, material: Elastic) -> [f64; 6] {
        in_plane(&fields.pressure, material)
    }
}

/// Unit traction along y.
pub(crate) struct StripAcross;

impl StripLoad<6> for StripAcross {
    const OUTPUTS: [StripOutput; 6] = [
        output(0, 1.0, true),
        output(1, 1.0, true),
        output(2, -1.0, true),
        output(4, -1.0, false),
        output(7, 1.0, false),
        output(8, 1.0, true),
    ];

    fn functions(fields: &UnitFields, material: Elastic) -> [f64; 6] {
        in_plane(&fields.shear, material)
    }
}

fn in_plane(state: &InPlane, material: Elastic) -> [f64; 6] {
    let (along, across) = state.lateral_stress(material);
    [across, along, state.p, state.tau, state.v, state.w]
}

/// Unit traction along x.
pub(crate) struct StripAlong;

impl StripLoad<3> for StripAlong {
    const OUTPUTS: [StripOutput; 3] =
        [output(3, -1.0, true), output(5, -1.0, false), output(6, 1.0, false)];

    fn functions(fields: &UnitFields, material: Elastic) -> [f64; 3] {
        let (q, u) = fields.twist;
        [material.shear() * u, q, u]
    }
}

/// The plan of a line contact's kernels, which all depths share.
#[derive(Debug)]
pub(crate) struct LinePlan {
    body: HalfSpace,
    cells: usize,
    width: f64,
    /// Distance from the load at which the displacement is 0.
    datum: f64,
    /// The longest length of the body.
    longest: f64,
    /// None where the body is homogeneous.
    spectrum: Option<Spectrum>,
    /// Transforms of the terms of cosines and of sines, which depend on the mesh alone.
    transforms: Option<[super::series::TermTransforms; 2]>,
}

impl LinePlan {
    /// Plans kernels of the grid's strips, and pieces down to `finest` of them.
    pub(crate) fn new(body: &HalfSpace, grid: &Grid, finest: f64) -> Self {
        let (width, datum) = (grid.spacing()[1], grid.size()[1]);
        let spectrum = Spectrum::new(body, [0.4 * finest * width, 2.0 * datum]);
        let transforms = spectrum.as_ref().map(|spectrum| {
            [-0.5, 0.5].map(|nu| spectrum.mesh.transforms(Order { nu, kind: TransformKind::Line }))
        });
        Self {
            transforms,
            cells: grid.shape()[1],
            width,
            datum,
            longest: body.lengths().map_or(0.0, |[_, longest]| longest),
            spectrum,
            body: body.clone(),
        }
    }

    /// Components at offsets of 0, 1, … cells from a strip under a unit pressure, or a unit traction along an axis.
    pub(crate) fn coefficients(
        &self,
        place: &Place,
        axis: Option<usize>,
    ) -> Vec<[f64; COMPONENTS]> {
        match axis {
            None => self.at_offsets::<6, StripPressure>(place),
            Some(0) => self.at_offsets::<3, StripAlong>(place),
            Some(_) => self.at_offsets::<6, StripAcross>(place),
        }
    }

    fn at_offsets<const N: usize, L: StripLoad<N>>(&self, place: &Place) -> Vec<[f64; COMPONENTS]> {
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
    pub(crate) fn strips<const N: usize, L: StripLoad<N>>(&self, place: &Place) -> StripKernel<N> {
        let (material, depth) = (place.material, place.depth);
        StripKernel {
            outputs: L::OUTPUTS,
            closed: homogeneous(material, L::functions).map(|[c0, c1]| Closed { c0, c1, depth }),
            rest: self.rest::<N, L>(place, self.longest + depth),
            datum: self.datum,
        }
    }

    /// Series of the difference between the body and a half-space of the material at `place`, and the
    /// images that take the growth of its displacements.
    fn rest<const N: usize, L: StripLoad<N>>(
        &self,
        place: &Place,
        image_depth: f64,
    ) -> Option<(Series<N>, [Closed; N])> {
        let spectrum = self.spectrum.as_ref()?;
        let mesh = &spectrum.mesh;
        let differences = spectrum.differences(&self.body, place, L::functions);
        let (_, limit) = *differences.first()?;
        let images = std::array::from_fn(|k| Closed {
            c0: if L::OUTPUTS[k].displacement { limit[k] } else { 0.0 },
            c1: 0.0,
            depth: image_depth,
        });
        let mut samples: [Vec<f64>; N] = std::array::from_fn(|_| Vec::new());
        for (alpha, values) in differences {
            // Below this wavenumber nothing is seen at any distance of interest, but D − D(0)
            // cancels.
            let seen = (alpha * self.longest.max(self.datum) / 1e-10).powi(2);
            for k in 0..N {
                let value = if L::OUTPUTS[k].displacement {
                    let image = images[k].c0 * (-alpha * image_depth).exp();
                    (values[k] - image) / alpha * (seen / (1.0 + seen))
                } else {
                    values[k]
                };
                samples[k].push(value * alpha.sqrt());
            }
        }
        let orders = L::OUTPUTS.map(|output| Order {
            nu: if output.sine { 0.5 } else { -0.5 },
            kind: TransformKind::Line,
        });
        let [even, odd] = self.transforms.as_ref()?;
        let transforms =
            L::OUTPUTS.map(|output| if output.sine { odd.clone() } else { even.clone() });
        Some((Series::new(mesh, &orders, &transforms, samples, 0.0), images))
    }
}

/// A load at one depth, on strips of any width.
pub(crate) struct StripKernel<const N: usize> {
    outputs: [StripOutput; N],
    closed: [Closed; N],
    rest: Option<(Series<N>, [Closed; N])>,
    datum: f64,
}

impl<const N: usize> StripKernel<N> {
    /// Components at y from the middle of a strip of half width `half` under a unit load.
    pub(crate) fn at(&self, y: f64, half: f64) -> [f64; COMPONENTS] {
        self.components(&self.integral(y - half), &self.integral(y + half))
    }

    /// S(y) of each output.
    fn integral(&self, y: f64) -> [f64; N] {
        let mut sums: [f64; N] =
            std::array::from_fn(|k| self.closed[k].integral(self.outputs[k], y, self.datum));
        if let Some((series, images)) = &self.rest {
            let [mean] = series.mean([y.abs()]);
            for (k, sum) in sums.iter_mut().enumerate() {
                let sign = if self.outputs[k].sine { 1.0 } else { y.signum() };
                *sum += sign * mean[k] + images[k].integral(self.outputs[k], y, self.datum);
            }
        }
        sums
    }

    /// Components of a strip, from S at its edges.
    fn components(&self, before: &[f64; N], next: &[f64; N]) -> [f64; COMPONENTS] {
        let mut values = [0.0; COMPONENTS];
        for (k, output) in self.outputs.iter().enumerate() {
            values[output.component] = output.sign * (next[k] - before[k]);
        }
        values
    }
}

/// A function of the wavenumber with a closed form: D = (c0 + c1 αz) e^{−αz}.
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
    fn integral(&self, output: StripOutput, y: f64, datum: f64) -> f64 {
        let Self { c0, c1, depth: z } = *self;
        let square = y * y + z * z;
        // Lengths over the datum, so that logarithms are those of numbers.
        let log = 0.5 * (square / (datum * datum)).ln();
        let angle = if z > 0.0 { (y / z).atan() } else { 0.5 * PI * y.signum() };
        let (first, second) = match (output.sine, output.displacement) {
            (false, false) => (angle, z * y / square),
            (true, false) => (log, -z * z / square),
            (false, true) => (y - y * log - z * angle, z * angle),
            (true, true) => (y * angle - z * log, z * log),
        };
        (c0 * first + c1 * second) / PI
    }
}
