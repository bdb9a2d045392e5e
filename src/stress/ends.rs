//! What the free ends of a body add to the stress of the body that goes on.
//!
//! The stress of a quarter space is the sum of those of two half-spaces: one under the even pressure P on the
//! surface, and one under Q on the end face ([`crate::compliance::ends`]). What is added is therefore the stress of the
//! layered half-space under the mirror image of the pressure and under P − p on both sides of the end, and that of
//! a half-space of the substrate below the end face. The two ends of a body are superposed.
//!
//! Tractions of friction have no such solution: their stress is that of the body that goes on.

use std::ops::ControlFlow;

use ndarray::Array2;

use super::half_space::{HalfSpacePlan, PlaneEvaluator, PointEvaluator, components};
use super::options::StressProgress;
use super::section::Span;
use crate::compliance::ends::{EndPressure, Where};
use crate::compliance::response::interior::Place;
use crate::error::Result;
use crate::model::body::{HalfSpace, Substrate};

mod face;
mod images;
mod part;
mod strip;

use face::{Face, FacePressure, NearEnd};
use images::Images;
use part::Part;
use strip::{STRIP, Strip};

/// Stress beyond that of the body that goes on, on the cells of a contact's grid.
#[derive(Debug)]
pub(super) struct EndStress {
    /// The body without ends under mirror images and excesses; beside each end the same on finer cells instead.
    surfaces: Vec<Part>,
    /// Numbers of rows and columns of the contact's grid.
    shape: [usize; 2],
    faces: Vec<Face>,
    /// Length of the contact's cells along x \[m\].
    spacing: f64,
    /// Largest pressure \[Pa\].
    peak: f64,
    /// What one end of a body does to the other, and that is left out \[Pa\]; 0 where there is one.
    left_out: f64,
}

/// Error of the stress from one cell below the surface on, over the peak pressure, and at most. In between it falls
/// as z⁻². Measured on the face as its normal traction, for ν = 0, 0.3 and 0.5 and cells of an eighth to a
/// thirty-second of the contact's half-length: 0.18 on the edge; 4e-3, 1e-3 and 9e-4 at ¼, ½ and one cell where a smooth
/// pressure vanishes at the end; 0.02, 7e-3 and 2e-3 at ¼, ½ and one cell where it reaches it, bounded or as x^−0.226, and 2.4e-3
/// farther down (`tests/stress/ends.rs`).
const ERRORS: [f64; 2] = [3e-3, 0.2];

/// Length over which the pressures beside the load are followed, in widths of the contact or in distances of it from
/// the end, if that is more: they fall with the square of the distance at least.
const REACH: f64 = 3.0;

/// Columns beyond the contact's on either side, in the same unit.
const MARGIN: f64 = 3.0;

/// Distance of the load from an end, relative to the longer side of the contact, from which on the end adds less than
/// 1e-3 of the peak pressure: the image of a force p b² at 20 b.
const FAR: f64 = 10.0;

/// Rows of cells on which the excess is followed.
const MOST_ROWS: usize = 1024;

impl EndStress {
    /// What the ends of the body of a plan add; none where it has none, or no pressure. [`ControlFlow::Break`]
    /// where `progress` stops it.
    pub(super) fn plan(
        whole: &HalfSpacePlan,
        span: &Span,
        progress: &mut StressProgress,
    ) -> Result<ControlFlow<(), Option<Self>>> {
        let (body, grid, threads) = (&whole.body, &whole.grid, &whole.threads);
        let Substrate::Elastic(material) = body.substrate() else {
            return Ok(ControlFlow::Continue(None));
        };
        let shape @ [nx, ny] = grid.shape();
        let pressure = Array2::from_shape_fn((nx, ny), |(i, j)| whole.pressure[i * ny + j]);
        let bears = |lines: ndarray::iter::Lanes<'_, f64, ndarray::Ix1>| {
            let lines = lines.into_iter();
            lines.filter(|line| line.iter().any(|p| *p != 0.0)).count()
        };
        let [dx, dy] = grid.spacing();
        let width = bears(pressure.columns()) as f64 * dy;
        let size = width.max(bears(pressure.rows()) as f64 * dx);
        let endless = body.clone().with_ends([None; 2])?;
        let mut images = Images::new(grid);
        let known = [0, 1].map(|k| body.ends()[k].filter(|_| span.faces[k].is_some()));
        let (mut surfaces, mut faces) = (Vec::new(), Vec::new());
        for (end, sign) in body.ends().into_iter().zip([1.0, -1.0]) {
            let Some(end) = end else { continue };
            let Some(near) = NearEnd::new(&pressure, grid, end, sign) else {
                continue;
            };
            if near.nearest > FAR * size {
                continue;
            }
            let scale = width.max(near.nearest);
            let margin = ((MARGIN * scale / dy).ceil() as usize).min(2 * ny);
            let spread = EndPressure::new(&near.pressure, near.first, grid.spacing());
            let means = |place: Where, spacing: f64, count: usize| {
                threads.run(|| spread.spread(place, material.poisson(), spacing, count, margin))
            };
            let over = |place: Where, spacing: f64| {
                let count = ((REACH * scale / spacing).ceil() as usize).min(MOST_ROWS);
                means(place, spacing, count)
            };
            images.add_mirror(&pressure, end);
            images.add_excess(&over(Where::Surface, dx), end, margin);
            let strip = Strip::new(dx, dx, |spacing, count| {
                means(Where::Surface, spacing, count)
            });
            surfaces.extend(Part::beside(
                &endless,
                (grid, near.rows(STRIP)),
                &strip,
                end,
                margin,
                threads,
            )?);
            let spacing = Face::spacing(grid, REACH * scale);
            let strip = Strip::new(spacing, dx, |spacing, count| {
                means(Where::Face, spacing, count)
            });
            let below = HalfSpace::from(material);
            let pressed = FacePressure {
                spacing,
                margin,
                means: over(Where::Face, spacing),
                strip,
            };
            match Face::plan(
                &below,
                grid,
                &near,
                (end, known),
                &pressed,
                threads,
                progress,
            )? {
                ControlFlow::Continue(face) => faces.push(face),
                ControlFlow::Break(()) => return Ok(ControlFlow::Break(())),
            }
        }
        if faces.is_empty() {
            return Ok(ControlFlow::Continue(None));
        }
        let peak = |most: f64, p: &f64| most.max(p.abs());
        surfaces.push(Part::new(&endless, &images, threads)?);
        Ok(ControlFlow::Continue(Some(Self {
            surfaces,
            shape,
            faces,
            spacing: dx,
            peak: whole.pressure.iter().fold(0.0, peak),
            left_out: match body.ends() {
                [Some(low), Some(high)] => {
                    let load = whole.pressure.iter().sum::<f64>() * grid.cell_area();
                    load / std::f64::consts::PI / (high - low).powi(2)
                }
                _ => 0.0,
            },
        })))
    }

    /// Estimated error \[Pa\] of the stress that the ends add at the depth `z`, at the worst place, which is beside
    /// the face. Two ends a distance L apart, superposed, leave W/πL² of the load W: for ν = 0 and a pressure along all of
    /// the body, where they should change nothing, 0.97 and 0.86 of that at L = 20 and 10 half-widths.
    pub(super) fn uncertainty(&self, z: f64) -> f64 {
        let [deep, most] = ERRORS;
        let cells = (z / self.spacing).min(1.0);
        self.peak * (deep / cells.powi(2)).min(most) + self.left_out
    }
}

/// The stress of the ends on whole planes, with the memory that all planes use.
#[derive(Debug)]
pub(super) struct EndPlanes<'a> {
    ends: &'a EndStress,
    surfaces: Vec<PlaneEvaluator<'a>>,
    displacement: bool,
    /// Components on the cells of the largest part.
    fields: Vec<Vec<f64>>,
}

impl<'a> EndPlanes<'a> {
    pub(super) fn new(ends: &'a EndStress, displacement: bool) -> Self {
        let cells = |part: &Part| part.plan.grid.shape().iter().product();
        let most: usize = ends.surfaces.iter().map(cells).max().unwrap_or(0);
        let surfaces = ends.surfaces.iter();
        Self {
            ends,
            surfaces: surfaces
                .map(|part| PlaneEvaluator::new(&part.plan, [0.0; 2], displacement))
                .collect(),
            displacement,
            fields: vec![vec![0.0; most]; components(displacement)],
        }
    }

    /// Adds the components at `place` to `outputs`, planes of the contact's cells.
    pub(super) fn add(
        &mut self,
        place: &Place,
        outputs: &mut [&mut [f64]],
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        let [_, ny] = self.ends.shape;
        for (part, surface) in self.ends.surfaces.iter().zip(&mut self.surfaces) {
            let cells: usize = part.plan.grid.shape().iter().product();
            let mut fields: Vec<&mut [f64]> =
                self.fields.iter_mut().map(|f| &mut f[..cells]).collect();
            surface.evaluate(place, &mut fields, progress)?;
            for (field, output) in fields.iter().zip(&mut *outputs) {
                part.add(field, ny, output);
            }
        }
        for face in &self.ends.faces {
            let at = face.at_depth(place.depth, self.displacement)?;
            for (k, output) in outputs.iter_mut().enumerate() {
                for (i, output) in output.chunks_exact_mut(ny).enumerate() {
                    at.add_row(k, i, output);
                }
            }
        }
        ControlFlow::Continue(())
    }
}

impl EndStress {
    /// Adds the components at `place` on the face of an end, which lies between the rows `row` − 1 and `row`, to `lines`,
    /// for each of them along y.
    pub(super) fn add_on_face(
        &self,
        place: &Place,
        (end, row): (usize, usize),
        displacement: bool,
        lines: &mut [Vec<f64>],
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        for part in &self.surfaces {
            part.add_between((place, row), displacement, lines, progress)?;
        }
        let [nx, _] = self.shape;
        for face in &self.faces {
            let at = face.at_depth(place.depth, displacement)?;
            for (k, line) in lines.iter_mut().enumerate() {
                at.add_row(k, nx + end, line);
            }
        }
        ControlFlow::Continue(())
    }
}

/// The stress of the ends in some cells.
#[derive(Debug)]
pub(super) struct EndPoints<'a> {
    ends: &'a EndStress,
    surfaces: Vec<PointEvaluator<'a>>,
    displacement: bool,
    cells: Vec<[usize; 2]>,
}

impl<'a> EndPoints<'a> {
    pub(super) fn new(ends: &'a EndStress, displacement: bool, cells: &[[usize; 2]]) -> Self {
        let surface = |part: &'a Part| {
            let there = cells.iter().map(|cell| part.cell(*cell).0).collect();
            PointEvaluator::new(&part.plan, [0.0; 2], displacement, there)
        };
        Self {
            ends,
            surfaces: ends.surfaces.iter().map(surface).collect(),
            displacement,
            cells: cells.to_vec(),
        }
    }

    /// Adds the components at `place` to those of the cells.
    pub(super) fn add<const N: usize>(
        &self,
        place: &Place,
        sums: &mut [[f64; N]],
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        for (part, surface) in self.ends.surfaces.iter().zip(&self.surfaces) {
            let found = surface.evaluate(place, progress)?;
            for ((sums, found), cell) in sums.iter_mut().zip(found).zip(&self.cells) {
                let (_, factor) = part.cell(*cell);
                sums.iter_mut()
                    .zip(found)
                    .for_each(|(sum, value)| *sum += factor * value);
            }
        }
        for face in &self.ends.faces {
            let at = face.at_depth(place.depth, self.displacement)?;
            for (sums, [i, j]) in sums.iter_mut().zip(&self.cells) {
                for (k, sum) in sums
                    .iter_mut()
                    .enumerate()
                    .take(components(self.displacement))
                {
                    *sum += at.in_cell(k, [*i, *j]);
                }
            }
        }
        ControlFlow::Continue(())
    }
}
