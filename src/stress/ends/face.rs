//! The stress below an end face, as that of a half-space whose surface is the face.

use std::ops::ControlFlow;
use std::sync::OnceLock;

use super::pressures::{EndImages, NearEnd, STRIP, Strip};
use crate::compliance::convolution::RowWeights;
use crate::compliance::ends::{Nodes, Where};
use crate::compliance::kernel::COMPONENTS;
use crate::compliance::response::interior::Place;
use crate::error::Result;
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;
use crate::numerics::parallel::{Threads, check_memory};
use crate::stress::half_space::{HalfSpacePart, Loading, Part, PlaneMemory, components};
use crate::stress::options::{Side, StressProgress};
use crate::stress::section::place;

/// Components of the half-space below the face for each component of the body. The axes of the first are z, y
/// and x of the second. Beside them, whether they change sign with z, and with the direction of x.
const TURNED: [(usize, bool, bool); 9] = [
    (2, false, false), // xx: normal to the face
    (1, false, false), // yy
    (0, false, false), // zz: along the face
    (4, false, true),  // xy
    (3, true, false),  // yz
    (5, true, true),   // xz
    (8, false, true),  // u_x: into the face
    (7, false, false), // u_y
    (6, true, false),  // u_z
];

/// Rows of cells down the face, at least and at most.
const FACE_ROWS: [f64; 2] = [64.0, 256.0];

/// Cells between which the components are interpolated along z.
const BETWEEN: usize = 4;

/// Components at several depths below the face, on (z, y) in C order.
type FaceFields = Vec<Vec<Vec<f64>>>;

/// Stress below one end face.
#[derive(Debug)]
pub(super) struct Face {
    sign: f64,
    /// Depths below the face at which the fields are known.
    depths: Vec<f64>,
    /// Weights of these depths for each row of the contact's grid, then for each of the body's two end faces.
    rows: Vec<RowWeights>,
    /// Numbers of the contact's rows and columns.
    shape: [usize; 2],
    tables: Vec<FaceTable>,
}

/// Fields below one part of the pressure on a face.
#[derive(Debug)]
struct FaceTable {
    part: HalfSpacePart,
    /// Length of its rows, which begin at z = 0.
    spacing: f64,
    /// Depth z, and depth below the face, down to which it counts.
    reach: f64,
    /// At depths below the face where it does not count, there are none.
    stresses: FaceFields,
    displacements: OnceLock<FaceFields>,
}

impl Face {
    /// The face of the end that the pressure is seen from. The body's faces at the x in `known` lie between rows. None
    /// where `progress` stops it.
    pub(super) fn plan(
        near: &NearEnd,
        grid: &Grid,
        known: [Option<f64>; 2],
        threads: &Threads,
        progress: &mut StressProgress,
    ) -> Result<Option<Self>> {
        let (depths, rows) = depths_of_rows(near, grid, known);
        let mut face =
            Self { sign: near.sign, depths, rows, shape: grid.shape(), tables: Vec::new() };
        for mut table in face.tables_of(near, grid, threads)? {
            match table.fields(&face.depths, false, progress) {
                ControlFlow::Continue(fields) => table.stresses = fields,
                ControlFlow::Break(()) => return Ok(None),
            }
            face.tables.push(table);
        }
        Ok(Some(face))
    }

    /// The half-space below the face under all of the pressure; and beside the edge, what finer cells change.
    fn tables_of(&self, near: &NearEnd, grid: &Grid, threads: &Threads) -> Result<[FaceTable; 3]> {
        let ([_, columns], [dx, dy]) = (grid.shape(), grid.spacing());
        let [least, most] = FACE_ROWS;
        let spacing = dx.min(near.reach / least).max(near.reach / most);
        let means = near.followed(Where::Face, spacing, threads);
        let strip = Strip::new(near, Where::Face, spacing, dx, threads);
        let rows = means.nrows();
        // Rows that the interpolation needs beyond a depth.
        let beside = 0..(STRIP + BETWEEN).min(rows);
        let finer = beside.len() * strip.division;
        let values = self.depths.len() * components(true) * (rows + beside.len() + finer) * columns;
        check_memory([rows, columns], 8 * values as u64)?;
        let size = [rows as f64 * spacing, columns as f64 * dy];
        let on = Grid::new([rows, columns], size)?.centered_at([0.5 * size[0], 0.0])?;
        let below = HalfSpace::from(near.material);
        let mut images = EndImages::new(&on);
        images.add_excess(&means, 0.0, near.margin);
        let whole = images.part(&below, threads)?;
        let [coarse, fine] = strip.parts(&below, &on, &beside, 0.0, threads)?;
        // In every finer cell.
        let fine = HalfSpacePart {
            first: fine.first - fine.stride / 2,
            rows: 0..finer,
            stride: 1,
            ..fine
        };
        let reach = strip.reach;
        let tables = [
            (whole, spacing, f64::INFINITY),
            (coarse, spacing, reach),
            (fine, spacing / strip.division as f64, reach),
        ];
        Ok(tables.map(|(part, spacing, reach)| FaceTable {
            part,
            spacing,
            reach,
            stresses: FaceFields::new(),
            displacements: OnceLock::new(),
        }))
    }

    /// The components at the depth `z` of the body: for each depth below the face and each component, along y.
    fn at_depth(&self, z: f64, displacement: bool) -> ControlFlow<(), Vec<Vec<Vec<f64>>>> {
        let count = components(displacement);
        let mut lines = vec![vec![vec![0.0; self.shape[1]]; count]; self.depths.len()];
        for table in self.tables.iter().filter(|table| z < table.reach) {
            if displacement && table.displacements.get().is_none() {
                let mut unwatched = |_| ControlFlow::Continue(());
                let fields = table.fields(&self.depths, true, &mut unwatched)?;
                let _ = table.displacements.set(fields);
            }
            table.add(z, self.sign, &mut lines);
        }
        ControlFlow::Continue(lines)
    }

    /// Adds component `k` to the row `i` of the contact's grid or, beyond its last row, on a face.
    fn add_row(&self, lines: &[Vec<Vec<f64>>], k: usize, i: usize, output: &mut [f64]) {
        let RowWeights { first, weights } = &self.rows[i];
        for (weight, line) in weights.iter().zip(&lines[*first..]) {
            let values = output.iter_mut().zip(&line[k]);
            values.for_each(|(output, value)| *output += weight * value);
        }
    }
}

impl Part for Face {
    fn plane(
        &self,
        place: &Place,
        displacement: bool,
        _: &mut Option<PlaneMemory>,
        outputs: &mut [&mut [f64]],
        _: &mut StressProgress,
    ) -> ControlFlow<()> {
        let lines = self.at_depth(place.depth, displacement)?;
        for (k, output) in outputs.iter_mut().enumerate() {
            let rows = output.chunks_exact_mut(self.shape[1]).enumerate();
            rows.for_each(|(i, row)| self.add_row(&lines, k, i, row));
        }
        ControlFlow::Continue(())
    }

    fn points(
        &self,
        place: &Place,
        displacement: bool,
        cells: &[[usize; 2]],
        sums: &mut [[f64; COMPONENTS]],
        _: &mut StressProgress,
    ) -> ControlFlow<()> {
        let lines = self.at_depth(place.depth, displacement)?;
        for (sums, [i, j]) in sums.iter_mut().zip(cells) {
            let RowWeights { first, weights } = &self.rows[*i];
            for (k, sum) in sums.iter_mut().enumerate().take(components(displacement)) {
                let lines = weights.iter().zip(&lines[*first..]);
                *sum += lines.map(|(weight, line)| weight * line[k][*j]).sum::<f64>();
            }
        }
        ControlFlow::Continue(())
    }

    fn on_face(
        &self,
        place: &Place,
        displacement: bool,
        (end, _): (usize, usize),
        lines: &mut [Vec<f64>],
        _: &mut StressProgress,
    ) -> ControlFlow<()> {
        let lines_at_depth = self.at_depth(place.depth, displacement)?;
        for (k, line) in lines.iter_mut().enumerate() {
            self.add_row(&lines_at_depth, k, self.shape[0] + end, line);
        }
        ControlFlow::Continue(())
    }
}

/// Depths below the face at which fields are to be known, and the weights of these for each row of the `grid`, then for
/// each of the body's two end faces, where they are at `known` x.
fn depths_of_rows(
    near: &NearEnd,
    grid: &Grid,
    known: [Option<f64>; 2],
) -> (Vec<f64>, Vec<RowWeights>) {
    let (nx, dx) = (grid.shape()[0], grid.spacing()[0]);
    let Nodes { distances: mut depths, rows: near_rows, .. } =
        Nodes::new(near.first, dx, nx - near.beyond);
    let mut rows = vec![RowWeights::default(); nx];
    for (row, weights) in (near.beyond..).zip(near_rows) {
        rows[if near.sign > 0.0 { row } else { nx - 1 - row }] = weights;
    }
    // On faces, the stress is known for itself.
    for x in known {
        rows.push(RowWeights { first: depths.len(), weights: x.iter().map(|_| 1.0).collect() });
        depths.extend(x.map(|x| near.sign * (x - near.end)));
    }
    (depths, rows)
}

impl FaceTable {
    /// The stresses at all `depths` below the face, or the displacements.
    fn fields(
        &self,
        depths: &[f64],
        displacement: bool,
        progress: &mut StressProgress,
    ) -> ControlFlow<(), FaceFields> {
        let plan = &self.part.plan;
        let loading = Loading::new([0.0; 2], displacement);
        let mut memory = plan.plane_memory(&loading);
        let mut planes = vec![vec![0.0; plan.pressure.len()]; components(displacement)];
        let first = if displacement { components(false) } else { 0 };
        let mut fields = FaceFields::new();
        for depth in depths {
            if *depth >= self.reach {
                fields.push(Vec::new());
                continue;
            }
            let Ok(place) = place(&plan.body, *depth, Side::Below) else {
                return ControlFlow::Break(());
            };
            let mut outputs: Vec<&mut [f64]> = planes.iter_mut().map(|p| &mut p[..]).collect();
            let mut poll = |_| progress(0.0);
            plan.plane(&loading, &place, &mut memory, &mut outputs, &mut poll)?;
            let kept = planes[first..].iter().map(|plane| {
                let mut kept = vec![0.0; self.part.rows.end * self.part.columns];
                self.part.add(plane, &mut kept);
                kept
            });
            fields.push(kept.collect());
        }
        ControlFlow::Continue(fields)
    }

    /// Adds components of the body at the depth `z` to `lines`: for each depth below the face and component, along y.
    fn add(&self, z: f64, sign: f64, lines: &mut [Vec<Vec<f64>>]) {
        let at = z / self.spacing - 0.5;
        let below = at.floor();
        // Lagrange's polynomials of four cells around.
        let t = at - below;
        let weights: [f64; BETWEEN] = std::array::from_fn(|q| {
            let node = q as f64 - 1.0;
            (0..BETWEEN)
                .filter(|other| *other != q)
                .map(|other| (t - (other as f64 - 1.0)) / (node - (other as f64 - 1.0)))
                .product()
        });
        let known = |(node, _): &(usize, _)| !self.stresses[*node].is_empty();
        for (node, lines) in lines.iter_mut().enumerate().filter(known) {
            let displacements = self.displacements.get();
            let fields: Vec<&Vec<f64>> = self.stresses[node]
                .iter()
                .chain(displacements.into_iter().flat_map(|fields| &fields[node]))
                .collect();
            for (line, &(turned, odd, along_x)) in lines.iter_mut().zip(&TURNED) {
                for (q, weight) in weights.iter().enumerate() {
                    let cell = below as i64 + q as i64 - 1;
                    let (cell, mirrored) = if cell < 0 {
                        (-1 - cell, if odd { -1.0 } else { 1.0 })
                    } else {
                        (cell, 1.0)
                    };
                    let factor = mirrored * weight * if along_x { sign } else { 1.0 };
                    // Below the last row there is nothing.
                    let row = fields[turned].chunks_exact(line.len()).nth(cell as usize);
                    let values = line.iter_mut().zip(row.into_iter().flatten());
                    values.for_each(|(sum, value)| *sum += factor * value);
                }
            }
        }
    }
}
