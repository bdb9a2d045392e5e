//! The stress below an end face, as that of a half-space whose surface is the face.

use std::ops::{ControlFlow, Range};
use std::sync::OnceLock;

use ndarray::{Array2, ArrayRef2};

use super::images::Images;
use super::part::Part;
use super::strip::{STRIP, Strip};
use crate::compliance::convolution::RowWeights;
use crate::compliance::ends::node_rows;
use crate::error::Result;
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;
use crate::numerics::parallel::{Threads, check_memory};
use crate::stress::half_space::{PlaneEvaluator, components};
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
const ROWS: [f64; 2] = [64.0, 256.0];

/// Cells between which the components are interpolated along z.
const BETWEEN: usize = 4;

/// The pressure of a contact, seen from an end.
pub(super) struct NearEnd {
    sign: f64,
    /// Distance of the first row from the end \[m\].
    pub(super) first: f64,
    /// Rows between the contact's first one and that, which lie beyond the end.
    beyond: usize,
    /// Distance of the first row that bears pressure \[m\].
    pub(super) nearest: f64,
    /// Pressure on rows at increasing distances.
    pub(super) pressure: Array2<f64>,
}

impl NearEnd {
    /// The `pressure` on `grid`, from an end at x = `end` from which the body goes on in the direction of `sign`.
    /// None where there is no pressure.
    pub(super) fn new(pressure: &ArrayRef2<f64>, grid: &Grid, end: f64, sign: f64) -> Option<Self> {
        let nx = pressure.nrows();
        let row = |k: usize| if sign > 0.0 { k } else { nx - 1 - k };
        let x = grid.x();
        let distance = |k: usize| sign * (x[row(k)] - end);
        let beyond = (0..nx).take_while(|k| distance(*k) < 0.0).count();
        let bears = |k: &usize| pressure.row(row(*k)).iter().any(|p| *p != 0.0);
        let loaded = (beyond..nx).find(bears)?;
        let shape = (nx - beyond, pressure.ncols());
        Some(Self {
            sign,
            first: distance(beyond),
            beyond,
            nearest: distance(loaded),
            pressure: Array2::from_shape_fn(shape, |(k, j)| pressure[[row(beyond + k), j]]),
        })
    }

    /// The `count` rows of the contact next to the end, or as many as it has.
    pub(super) fn rows(&self, count: usize) -> Range<usize> {
        let rows = self.pressure.nrows();
        let count = count.min(rows);
        if self.sign > 0.0 {
            self.beyond..self.beyond + count
        } else {
            rows - count..rows
        }
    }
}

/// The pressure Q on an end face.
pub(super) struct FacePressure {
    /// Length of its cells along z.
    pub(super) spacing: f64,
    /// Columns beyond the contact's on either side.
    pub(super) margin: usize,
    /// Means over cells of (z, y), from z = 0 down.
    pub(super) means: Array2<f64>,
    /// Means beside the edge, over finer cells too.
    pub(super) strip: Strip,
}

/// Components at several depths below the face, on (z, y) in C order.
type Fields = Vec<Vec<Vec<f64>>>;

/// Stress below one end face.
#[derive(Debug)]
pub(super) struct Face {
    sign: f64,
    /// Depths below the face at which the fields are known.
    depths: Vec<f64>,
    /// Weights of these depths for each row of the contact's grid, then for each of the body's two end faces.
    rows: Vec<RowWeights>,
    /// Number of the contact's columns.
    columns: usize,
    tables: Vec<Table>,
}

/// Fields of one part of the pressure on a face.
#[derive(Debug)]
struct Table {
    part: Part,
    /// Rows, from z = 0 down, and their length.
    rows: usize,
    spacing: f64,
    /// Depth z down to which it counts.
    reach: f64,
    stresses: Fields,
    displacements: OnceLock<Fields>,
}

impl Face {
    /// Length of cells along z, down to the depth `reach`.
    pub(super) fn spacing(grid: &Grid, reach: f64) -> f64 {
        let [least, most] = ROWS;
        grid.spacing()[0].min(reach / least).max(reach / most)
    }

    /// The half-space `below` the face under a pressure.
    pub(super) fn plan(
        below: &HalfSpace,
        grid: &Grid,
        near: &NearEnd,
        (end, known): (f64, [Option<f64>; 2]),
        pressed: &FacePressure,
        threads: &Threads,
        progress: &mut StressProgress,
    ) -> Result<ControlFlow<(), Self>> {
        let ([nx, columns], [dx, dy]) = (grid.shape(), grid.spacing());
        let (rows, spacing) = (pressed.means.nrows(), pressed.spacing);
        let size = [rows as f64 * spacing, columns as f64 * dy];
        let on = Grid::new([rows, columns], size)?.centered_at([0.5 * size[0], 0.0])?;
        let sign = near.sign;
        let (mut depths, near_rows) = node_rows(near.first, dx, nx - near.beyond);
        let mut weights = vec![RowWeights::default(); nx];
        for (k, row_weights) in near_rows.into_iter().enumerate() {
            let row = near.beyond + k;
            weights[if sign > 0.0 { row } else { nx - 1 - row }] = row_weights;
        }
        // On faces, the stress is known for itself.
        for x in known {
            weights.push(RowWeights {
                first: depths.len(),
                weights: x.iter().map(|_| 1.0).collect(),
            });
            depths.extend(x.map(|x| sign * (x - end)));
        }
        let (strip, margin) = (&pressed.strip, pressed.margin);
        // Rows that the interpolation needs beyond a depth.
        let beside = 0..(STRIP + BETWEEN).min(rows);
        let finer = beside.len() * strip.division;
        let values = depths.len() * components(true) * (rows + beside.len() + finer) * columns;
        check_memory([rows, columns], 8 * values as u64)?;
        let mut images = Images::new(&on);
        images.add_excess(&pressed.means, 0.0, margin);
        let whole = Part::new(below, &images, threads)?;
        let near_rows = (&on, beside.clone());
        let [coarse, fine] = Part::beside(below, near_rows, strip, 0.0, margin, threads)?;
        let (reach, fine_spacing) = (STRIP as f64 * spacing, spacing / strip.division as f64);
        let tables = [
            (whole, rows, spacing, f64::INFINITY),
            (coarse, beside.len(), spacing, reach),
            (fine.in_finer_cells(), finer, fine_spacing, reach),
        ];
        let mut face = Self {
            sign,
            depths,
            rows: weights,
            columns,
            tables: Vec::new(),
        };
        for (part, rows, spacing, reach) in tables {
            let mut table = Table {
                part,
                rows,
                spacing,
                reach,
                stresses: Fields::new(),
                displacements: OnceLock::new(),
            };
            match table.fields(&face.depths, columns, false, progress) {
                ControlFlow::Continue(fields) => table.stresses = fields,
                ControlFlow::Break(()) => return Ok(ControlFlow::Break(())),
            }
            face.tables.push(table);
        }
        Ok(ControlFlow::Continue(face))
    }

    /// The components at the depth `z` of the body.
    pub(super) fn at_depth(&self, z: f64, displacement: bool) -> ControlFlow<(), AtDepth<'_>> {
        let count = components(displacement);
        let mut lines = vec![vec![vec![0.0; self.columns]; count]; self.depths.len()];
        for table in self.tables.iter().filter(|table| z < table.reach) {
            if displacement && table.displacements.get().is_none() {
                let mut unwatched = |_| ControlFlow::Continue(());
                let fields = table.fields(&self.depths, self.columns, true, &mut unwatched)?;
                let _ = table.displacements.set(fields);
            }
            table.add(z, self.sign, &mut lines);
        }
        ControlFlow::Continue(AtDepth {
            rows: &self.rows,
            lines,
        })
    }
}

impl Table {
    /// The stresses at all `depths` below the face, or the displacements.
    fn fields(
        &self,
        depths: &[f64],
        columns: usize,
        displacement: bool,
        progress: &mut StressProgress,
    ) -> ControlFlow<(), Fields> {
        let plan = &self.part.plan;
        let mut evaluator = PlaneEvaluator::new(plan, [0.0; 2], displacement);
        let cells: usize = plan.grid.shape().iter().product();
        let mut planes = vec![vec![0.0; cells]; components(displacement)];
        let first = if displacement { components(false) } else { 0 };
        let mut fields = Fields::new();
        for depth in depths {
            let Ok(place) = place(&plan.body, *depth, Side::Below) else {
                return ControlFlow::Break(());
            };
            let mut outputs: Vec<&mut [f64]> = planes.iter_mut().map(|p| &mut p[..]).collect();
            evaluator.evaluate(&place, &mut outputs, &mut |_| progress(0.0))?;
            let kept = planes[first..].iter().map(|plane| {
                let mut kept = vec![0.0; self.rows * columns];
                self.part.add(plane, columns, &mut kept);
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
        for (node, lines) in lines.iter_mut().enumerate() {
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
                    if cell < self.rows as i64 {
                        let factor = mirrored * weight * if along_x { sign } else { 1.0 };
                        let row = fields[turned].chunks_exact(line.len()).nth(cell as usize);
                        let values = line.iter_mut().zip(row.into_iter().flatten());
                        values.for_each(|(sum, value)| *sum += factor * value);
                    }
                }
            }
        }
    }
}

/// The components of a face's stress at one depth of the body.
pub(super) struct AtDepth<'a> {
    rows: &'a [RowWeights],
    /// For each depth below the face and each component, values along y.
    lines: Vec<Vec<Vec<f64>>>,
}

impl AtDepth<'_> {
    /// Adds component `k` to the row `i` of the contact's grid or, beyond its last row, on a face.
    pub(super) fn add_row(&self, k: usize, i: usize, output: &mut [f64]) {
        let RowWeights { first, weights } = &self.rows[i];
        for (weight, line) in weights.iter().zip(&self.lines[*first..]) {
            let values = output.iter_mut().zip(&line[k]);
            values.for_each(|(output, value)| *output += weight * value);
        }
    }

    /// Component `k` in one cell.
    pub(super) fn in_cell(&self, k: usize, [i, j]: [usize; 2]) -> f64 {
        let RowWeights { first, weights } = &self.rows[i];
        let lines = weights.iter().zip(&self.lines[*first..]);
        lines.map(|(weight, line)| weight * line[k][j]).sum()
    }
}
