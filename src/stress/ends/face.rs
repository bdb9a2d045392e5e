//! The stress below an end face, as that of a half-space whose surface is the face.

use std::ops::ControlFlow;
use std::sync::OnceLock;

use ndarray::{Array2, ArrayRef2};

use crate::body::HalfSpace;
use crate::convolution::RowWeights;
use crate::ends::node_rows;
use crate::error::Result;
use crate::grid::Grid;
use crate::parallel::{Threads, check_memory};
use crate::stress::half_space::{HalfSpacePlan, PlaneEvaluator, Source, components};
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
            first: distance(beyond),
            beyond,
            nearest: distance(loaded),
            pressure: Array2::from_shape_fn(shape, |(k, j)| pressure[[row(beyond + k), j]]),
        })
    }
}

/// Fields of components at several depths below the face, on (z, y).
type Fields = Vec<Vec<Array2<f64>>>;

/// Stress below one end face.
#[derive(Debug)]
pub(super) struct Face {
    sign: f64,
    /// Depths below the face at which the fields are known.
    depths: Vec<f64>,
    /// Weights of these depths for each row of the contact's grid.
    rows: Vec<RowWeights>,
    plan: HalfSpacePlan,
    /// Rows of cells from z = 0 down, and the first of the contact's columns.
    cells: usize,
    margin: usize,
    columns: usize,
    stresses: Fields,
    displacements: OnceLock<Fields>,
}

impl Face {
    /// Length of cells along z, down to the depth `reach`.
    pub(super) fn spacing(grid: &Grid, reach: f64) -> f64 {
        let [least, most] = ROWS;
        grid.spacing()[0].min(reach / least).max(reach / most)
    }

    /// The half-space `below` the face under a pressure on (z, y), from z = 0 down in cells of a given length.
    pub(super) fn plan(
        below: &HalfSpace,
        grid: &Grid,
        near: &NearEnd,
        sign: f64,
        (pressure, spacing): (&ArrayRef2<f64>, f64),
        threads: &Threads,
        progress: &mut StressProgress,
    ) -> Result<ControlFlow<(), Self>> {
        let [nx, columns] = grid.shape();
        let (cells, width) = (pressure.nrows(), pressure.ncols());
        let even = Array2::from_shape_fn((2 * cells, width), |(i, j)| {
            let depth = if i < cells { cells - 1 - i } else { i - cells };
            pressure[[depth, j]]
        });
        let size = [
            2.0 * cells as f64 * spacing,
            width as f64 * grid.spacing()[1],
        ];
        let on = Grid::new([2 * cells, width], size)?;
        let (depths, near_rows) = node_rows(near.first, grid.spacing()[0], nx - near.beyond);
        let values = depths.len() as u64 * components(true) as u64 * (cells * columns) as u64;
        check_memory([cells, columns], 8 * values)?;
        let mut rows = vec![RowWeights::default(); nx];
        for (k, weights) in near_rows.into_iter().enumerate() {
            let row = near.beyond + k;
            rows[if sign > 0.0 { row } else { nx - 1 - row }] = weights;
        }
        let plan = Source::uniform(below, &on, &even).plan_unwatched(Some(threads.count()))?;
        let mut face = Self {
            sign,
            depths,
            rows,
            plan,
            cells,
            margin: (width - columns) / 2,
            columns,
            stresses: Fields::new(),
            displacements: OnceLock::new(),
        };
        Ok(match face.fields(false, progress) {
            ControlFlow::Continue(fields) => {
                face.stresses = fields;
                ControlFlow::Continue(face)
            }
            ControlFlow::Break(()) => ControlFlow::Break(()),
        })
    }

    /// The stresses at all depths below the face, or the displacements.
    fn fields(&self, displacement: bool, progress: &mut StressProgress) -> ControlFlow<(), Fields> {
        let mut evaluator = PlaneEvaluator::new(&self.plan, [0.0; 2], displacement);
        let [rows, width] = self.plan.grid.shape();
        let mut planes = vec![vec![0.0; rows * width]; components(displacement)];
        let first = if displacement { components(false) } else { 0 };
        let mut fields = Fields::new();
        for depth in &self.depths {
            let Ok(place) = place(&self.plan.body, *depth, Side::Below) else {
                return ControlFlow::Break(());
            };
            let mut outputs: Vec<&mut [f64]> = planes.iter_mut().map(|p| &mut p[..]).collect();
            evaluator.evaluate(&place, &mut outputs, &mut |_| progress(0.0))?;
            let kept = planes[first..].iter().map(|plane| {
                Array2::from_shape_fn((self.cells, self.columns), |(i, j)| {
                    plane[(self.cells + i) * width + self.margin + j]
                })
            });
            fields.push(kept.collect());
        }
        ControlFlow::Continue(fields)
    }

    /// The components at the depth `z` of the body.
    pub(super) fn at_depth(&self, z: f64, displacement: bool) -> ControlFlow<(), AtDepth<'_>> {
        if displacement && self.displacements.get().is_none() {
            let fields = self.fields(true, &mut |_| ControlFlow::Continue(()))?;
            let _ = self.displacements.set(fields);
        }
        let spacing = self.plan.grid.spacing()[0];
        let at = z / spacing - 0.5;
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
        let between = |field: &Array2<f64>, odd: bool| -> Vec<f64> {
            let mut line = vec![0.0; self.columns];
            for (q, weight) in weights.iter().enumerate() {
                let cell = below as i64 + q as i64 - 1;
                let (cell, sign) = if cell < 0 {
                    (-1 - cell, if odd { -1.0 } else { 1.0 })
                } else {
                    (cell, 1.0)
                };
                if cell < self.cells as i64 {
                    let row = field.row(cell as usize);
                    let values = line.iter_mut().zip(row);
                    values.for_each(|(sum, value)| *sum += sign * weight * value);
                }
            }
            line
        };
        let count = components(displacement);
        let lines = (0..self.depths.len()).map(|node| {
            let stresses = self.stresses[node].iter();
            let displacements = self.displacements.get().filter(|_| displacement);
            let fields: Vec<&Array2<f64>> = stresses
                .chain(displacements.into_iter().flat_map(|fields| &fields[node]))
                .collect();
            let line = |&(turned, odd, along_x): &(usize, bool, bool)| {
                let mut line = between(fields[turned], odd);
                if along_x {
                    line.iter_mut().for_each(|value| *value *= self.sign);
                }
                line
            };
            TURNED[..count].iter().map(line).collect()
        });
        ControlFlow::Continue(AtDepth {
            rows: &self.rows,
            lines: lines.collect(),
        })
    }
}

/// The components of a face's stress at one depth of the body.
pub(super) struct AtDepth<'a> {
    rows: &'a [RowWeights],
    /// For each depth below the face and each component, values along y.
    lines: Vec<Vec<Vec<f64>>>,
}

impl AtDepth<'_> {
    /// Adds component `k` to the row `i` of the contact's grid.
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
