//! What the free ends of a body add to the stress of the body that goes on.
//!
//! The stress of a quarter space is the sum of those of two half-spaces: one under the even pressure P on the
//! surface, and one under Q on the end face ([`crate::ends`]). What is added is therefore the stress of the
//! layered half-space under the mirror image of the pressure and under P − p on both sides of the end, and that of
//! a half-space of the substrate below the end face. The two ends of a body are superposed.
//!
//! Tractions of friction have no such solution: their stress is that of the body that goes on.

use std::ops::ControlFlow;

use ndarray::Array2;

use super::half_space::{HalfSpacePlan, PlaneEvaluator, PointEvaluator, Source, components};
use super::options::StressProgress;
use crate::body::{HalfSpace, Substrate};
use crate::ends::{EndPressure, Where};
use crate::error::Result;
use crate::response::interior::Place;

mod face;
mod images;

use face::{Face, NearEnd};
use images::Images;

/// Stress beyond that of the body that goes on, on the cells of a contact's grid.
#[derive(Debug)]
pub(super) struct EndStress {
    /// The body without ends under mirror images and excesses, on a larger grid.
    surface: HalfSpacePlan,
    /// First row and column of that grid that are the contact's.
    first: [usize; 2],
    /// Numbers of rows and columns of the contact's grid.
    shape: [usize; 2],
    faces: Vec<Face>,
    /// Largest pressure \[Pa\].
    peak: f64,
}

/// Error of the stress one cell below the surface beside the face, over the peak pressure, and that left far below. The
/// first falls with the depth z as z^−3/2. Measured under a smooth pressure half its length from the end, for ν = 0,
/// the worst: 0.022, 0.008 and 0.002 at one, two and four cells, 0.001 from there on (`tests/stress/ends.rs`).
const ERRORS: [f64; 2] = [0.025, 1.5e-3];

/// Length over which the pressures beside the load are followed, in widths of the contact or in distances of it from
/// the end, if that is more: they fall with the square of the distance at least.
const REACH: f64 = 4.0;

/// Columns beyond the contact's on either side, in the same unit.
const MARGIN: f64 = 1.0;

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
        let mut images = Images::new(grid);
        let mut faces = Vec::new();
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
            let over = |place: Where, spacing: f64| {
                let count = ((REACH * scale / spacing).ceil() as usize).min(MOST_ROWS);
                threads.run(|| spread.spread(place, material.poisson(), spacing, count, margin))
            };
            images.add_mirror(&pressure, end);
            images.add_excess(&over(Where::Surface, dx), end, margin);
            let spacing = Face::spacing(grid, REACH * scale);
            let below = HalfSpace::from(material);
            let pressed = over(Where::Face, spacing);
            match Face::plan(
                &below,
                grid,
                &near,
                sign,
                (&pressed, spacing),
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
        let pressure_peak = whole
            .pressure
            .iter()
            .fold(0.0, |most: f64, p| most.max(p.abs()));
        let (pressure, grid, first) = images.together()?;
        let endless = body.clone().with_ends([None; 2])?;
        let surface = Source::uniform(&endless, &grid, &pressure);
        Ok(ControlFlow::Continue(Some(Self {
            surface: surface.plan_unwatched(Some(threads.count()))?,
            first,
            shape,
            faces,
            peak: pressure_peak,
        })))
    }

    /// Estimated error \[Pa\] of the stress that the ends add at the depth `z`, at the worst place, which is beside
    /// the face.
    pub(super) fn uncertainty(&self, z: f64) -> f64 {
        let cells = (z / self.surface.grid.spacing()[0]).max(1.0);
        self.peak * (ERRORS[0] * cells.powf(-1.5) + ERRORS[1])
    }
}

/// The stress of the ends on whole planes, with the memory that all planes use.
#[derive(Debug)]
pub(super) struct EndPlanes<'a> {
    ends: &'a EndStress,
    surface: PlaneEvaluator<'a>,
    displacement: bool,
    /// Components on the larger grid.
    fields: Vec<Vec<f64>>,
}

impl<'a> EndPlanes<'a> {
    pub(super) fn new(ends: &'a EndStress, displacement: bool) -> Self {
        let [nx, ny] = ends.surface.grid.shape();
        Self {
            ends,
            surface: PlaneEvaluator::new(&ends.surface, [0.0; 2], displacement),
            displacement,
            fields: vec![vec![0.0; nx * ny]; components(displacement)],
        }
    }

    /// Adds the components at `place` to `outputs`, planes of the contact's cells.
    pub(super) fn add(
        &mut self,
        place: &Place,
        outputs: &mut [&mut [f64]],
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        let mut fields: Vec<&mut [f64]> = self.fields.iter_mut().map(|f| &mut f[..]).collect();
        self.surface.evaluate(place, &mut fields, progress)?;
        let ([row, column], [_, ny]) = (self.ends.first, self.ends.shape);
        let width = self.ends.surface.grid.shape()[1];
        for (field, output) in self.fields.iter().zip(&mut *outputs) {
            let rows = field.chunks_exact(width).skip(row);
            for (output, field) in output.chunks_exact_mut(ny).zip(rows) {
                let columns = output.iter_mut().zip(&field[column..]);
                columns.for_each(|(output, value)| *output += value);
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

/// The stress of the ends in some cells.
#[derive(Debug)]
pub(super) struct EndPoints<'a> {
    ends: &'a EndStress,
    surface: PointEvaluator<'a>,
    displacement: bool,
    cells: Vec<[usize; 2]>,
}

impl<'a> EndPoints<'a> {
    pub(super) fn new(ends: &'a EndStress, displacement: bool, cells: &[[usize; 2]]) -> Self {
        let [row, column] = ends.first;
        let there = cells.iter().map(|[i, j]| [i + row, j + column]).collect();
        Self {
            ends,
            surface: PointEvaluator::new(&ends.surface, [0.0; 2], displacement, there),
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
        let surface = self.surface.evaluate(place, progress)?;
        for (sums, surface) in sums.iter_mut().zip(surface) {
            sums.iter_mut()
                .zip(surface)
                .for_each(|(sum, value)| *sum += value);
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
