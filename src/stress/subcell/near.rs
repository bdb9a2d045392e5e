//! What pressure within cells adds to the stress nearby.
//!
//! The load of a cell less its mean and the shares of its first moment
//! ([`super::reconstruction`]) has neither force nor moment: its stresses fall off as the fourth
//! power of the distance. They are summed over some cells around each, at shallow depths, from the
//! stresses of pieces of a cell ([`super::cut`]).

use rayon::prelude::*;

use super::cut::{Cuts, Piece};
use super::reconstruction::{INERTIA, Reconstruction, RootCell, root};
use crate::grid::Grid;
use crate::parallel::Threads;

/// Stresses, as there are no displacements here.
pub(in crate::stress) const STRESSES: usize = 6;

// These four leave little: with 5, 7, 3 and 4 in their places, errors of Hertz' contacts of 128 cells
// to the half-width change by 3e-5 of the peak pressure at most, less than a tenth of the largest.

/// How far the load of a cell is followed, in cells of the longer side.
const REACH: f64 = 3.0;

/// Depth, in shorter sides of a cell, below which the edge's loads are not felt.
const EDGES: f64 = 4.0;

/// The same of slopes inside, which fall off as e^{−2πz/dx}.
const BENDS: f64 = 1.5;

/// How far they are followed, in cells.
const CLOSE: usize = 2;

/// The most cells of the shorter side that a load is followed, for the sake of time: cells more than
/// 3.3 times as long as wide lose some. Twelve times is tested (`tests/stress_edge.rs`).
const MOST: usize = 10;

/// Cells at a time.
const BLOCK: usize = 512;

/// How cells are cut and followed.
#[derive(Debug)]
pub(in crate::stress) struct NearPlan {
    pub(in crate::stress) reconstruction: Reconstruction,
    shape: [usize; 2],
    /// Of a cell; a strip's width, twice.
    sides: [f64; 2],
    line: bool,
    reach: [usize; 2],
    cuts: Cuts,
}

/// A target, seen from a cell.
#[derive(Debug)]
struct Offset {
    by: [isize; 2],
    /// Of the pieces that it sees; 0 those of its own cell.
    cut: usize,
    /// Of uniform pressure, of unit slopes and curvatures, and of shares of a unit first moment.
    uniform: [f64; STRESSES],
    bends: [[f64; STRESSES]; 4],
    shares: [[f64; STRESSES]; 2],
    /// Of unit pressure on each piece.
    pieces: Vec<[f64; STRESSES]>,
}

impl Offset {
    /// Whether bends are felt.
    fn is_close(&self) -> bool {
        self.by.iter().all(|by| by.unsigned_abs() <= CLOSE)
    }
}

/// Stresses of the parts of one cell at one depth.
#[derive(Debug, Default)]
pub(in crate::stress) struct NearTable {
    offsets: Vec<Offset>,
    /// The first cut that is used.
    finest: usize,
    bends: bool,
    surface: bool,
}

impl NearTable {
    /// Whether it is the surface's.
    pub(in crate::stress) fn at_surface(&self) -> bool {
        self.surface
    }
}

impl NearPlan {
    /// None where `go_on` stops it.
    pub(in crate::stress) fn new(
        pressure: &[f64],
        grid: &Grid,
        threads: &Threads,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Option<Self> {
        let (shape, line) = (grid.shape(), grid.is_line());
        let sides = if line {
            [grid.spacing()[1]; 2]
        } else {
            grid.spacing()
        };
        let longer = sides[0].max(sides[1]);
        let reach = |side: f64| ((REACH * longer / side).ceil() as usize).min(MOST);
        Some(Self {
            reconstruction: Reconstruction::new(pressure, shape, threads, go_on)?,
            shape,
            sides,
            line,
            reach: [if line { 0 } else { reach(sides[0]) }, reach(sides[1])],
            cuts: Cuts::new(line),
        })
    }

    /// How far a piece of a cell is from a target, at most.
    pub(in crate::stress) fn farthest(&self) -> f64 {
        let [along, across] = [0, 1].map(|axis| (self.reach[axis] + 2) as f64 * self.sides[axis]);
        along.hypot(across)
    }

    /// Whether anything is felt at a depth.
    pub(in crate::stress) fn reaches(&self, depth: f64) -> bool {
        depth < EDGES * self.shorter()
    }

    fn shorter(&self) -> f64 {
        self.sides[0].min(self.sides[1])
    }

    /// The table at a depth, of the stresses at (x, y) from the centre of a unit load of half sides
    /// (a, b). On the threads of the caller.
    pub(in crate::stress) fn table(
        &self,
        depth: f64,
        load: impl Fn([f64; 2], [f64; 2]) -> [f64; STRESSES] + Sync,
    ) -> NearTable {
        let [rx, ry] = self.reach.map(|reach| reach as isize);
        // One more, for the shares.
        let ends = [if self.line { 0 } else { rx + 1 }, ry + 1];
        let range = |end: isize| -end..=end;
        let all: Vec<[isize; 2]> = range(ends[0])
            .flat_map(|i| range(ends[1]).map(move |j| [i, j]))
            .collect();
        let [dx, dy] = self.sides;
        let mut offsets: Vec<Offset> = all
            .into_par_iter()
            .map(|by @ [i, j]| {
                let cut = self.cuts.seen_from(by, depth / self.shorter());
                let pieces = &self.cuts.all[cut];
                let values: Vec<[f64; STRESSES]> = pieces
                    .iter()
                    .map(|Piece { centre, half }| {
                        let at = [(i as f64 - centre[0]) * dx, (j as f64 - centre[1]) * dy];
                        load(at, [half[0] * dx, half[1] * dy])
                    })
                    .collect();
                let mut uniform = [0.0; STRESSES];
                let mut bends = [[0.0; STRESSES]; 4];
                let norms = self.cuts.norms[cut];
                for (value, piece) in values.iter().zip(pieces) {
                    let means = [0, 1].map(|axis| piece.mean_square(axis));
                    for k in 0..STRESSES {
                        uniform[k] += value[k];
                        for axis in 0..2 {
                            bends[axis][k] += norms[axis] * piece.centre[axis] * value[k];
                            bends[axis + 2][k] += 0.5 * (means[axis] - INERTIA) * value[k];
                        }
                    }
                }
                Offset {
                    by,
                    cut,
                    uniform,
                    bends,
                    shares: [[0.0; STRESSES]; 2],
                    pieces: values,
                }
            })
            .collect();
        let width = 2 * ends[1] + 1;
        let place = |[i, j]: [isize; 2]| ((i + ends[0]) * width + j + ends[1]) as usize;
        let uniform: Vec<[f64; STRESSES]> = offsets.iter().map(|o| o.uniform).collect();
        offsets.retain(|o| o.by[0].abs() <= rx && o.by[1].abs() <= ry);
        for offset in &mut offsets {
            let [i, j] = offset.by;
            for axis in 0..2 {
                if self.line && axis == 0 {
                    continue;
                }
                let [ax, ay] = [[1, 0], [0, 1]][axis];
                // From the cell on the right the target is one less off.
                let (right, left) = (
                    uniform[place([i - ax, j - ay])],
                    uniform[place([i + ax, j + ay])],
                );
                for k in 0..STRESSES {
                    offset.shares[axis][k] = 0.5 * (right[k] - left[k]);
                    offset.bends[axis][k] -= INERTIA * offset.shares[axis][k];
                }
            }
        }
        NearTable {
            offsets,
            finest: Cuts::finest(depth / self.shorter()),
            bends: depth < BENDS * self.shorter(),
            surface: depth == 0.0,
        }
    }

    /// Adds the stresses of pressure within cells to those on a plane. On the threads of the caller.
    pub(in crate::stress) fn add(&self, near: &NearTable, outputs: &mut [&mut [f64]]) {
        if near.offsets.is_empty() {
            return;
        }
        for block in self.reconstruction.roots.chunks(BLOCK) {
            let stresses: Vec<_> = block
                .par_iter()
                .map(|cell| self.stresses(near, cell))
                .collect();
            outputs.par_iter_mut().enumerate().for_each(|(k, output)| {
                for (cell, stresses) in block.iter().zip(&stresses) {
                    for (offset, stress) in near.offsets.iter().zip(stresses) {
                        if let Some(target) = self.target(cell, offset) {
                            output[target] += stress[k];
                        }
                    }
                }
            });
        }
        if near.bends {
            outputs
                .par_iter_mut()
                .enumerate()
                .for_each(|(k, output)| self.add_bends(near, k, output));
        }
    }

    /// Pressure on the pieces of a cut, less the mean, with the moments that are left to the
    /// convolution.
    fn loads(&self, cell: &RootCell, cut: usize) -> Vec<f64> {
        // Points along a side of a piece.
        const POINTS: [usize; 3] = [1, 2, 2];
        let pieces = &self.cuts.all[cut];
        let value = |piece| root(&cell.square, piece, POINTS[cut], self.line);
        let mut values: Vec<f64> = pieces.iter().map(value).collect();
        let (mut mean, mut missing) = (0.0, cell.moments);
        for (value, piece) in values.iter().zip(pieces) {
            let load = value * piece.area();
            mean += load;
            missing[0] -= load * piece.centre[0];
            missing[1] -= load * piece.centre[1];
        }
        let norms = self.cuts.norms[cut];
        let [along, across] = [0, 1].map(|axis| missing[axis] * norms[axis] / INERTIA);
        for (value, piece) in values.iter_mut().zip(pieces) {
            *value += along * piece.centre[0] + across * piece.centre[1] - mean;
        }
        values
    }

    /// Stresses of the load of one cell near the edge, at all offsets.
    fn stresses(&self, near: &NearTable, cell: &RootCell) -> Vec<[f64; STRESSES]> {
        let loads = [0, 1, 2].map(|cut| {
            if cut < near.finest {
                Vec::new()
            } else {
                self.loads(cell, cut)
            }
        });
        let [mx, my] = cell.moments;
        let stress = |offset: &Offset| {
            let [along, across] = &offset.shares;
            let mut sum = std::array::from_fn(|k| -mx * along[k] - my * across[k]);
            for (coefficients, load) in offset.pieces.iter().zip(&loads[offset.cut]) {
                for (sum, coefficient) in sum.iter_mut().zip(coefficients) {
                    *sum += coefficient * load;
                }
            }
            sum
        };
        near.offsets.iter().map(stress).collect()
    }

    /// The cell at an offset from another, if it is on the grid.
    fn target(&self, cell: &RootCell, offset: &Offset) -> Option<usize> {
        let [nx, ny] = self.shape;
        let [i, j] = [0, 1].map(|axis| cell.cell[axis].checked_add_signed(offset.by[axis]));
        let (i, j) = (i.filter(|i| *i < nx)?, j.filter(|j| *j < ny)?);
        Some(i * ny + j)
    }

    /// Adds component `k` of the loads of cells with slopes.
    fn add_bends(&self, near: &NearTable, k: usize, output: &mut [f64]) {
        let [nx, ny] = self.shape;
        let bends = &self.reconstruction.bends;
        for i in 0..nx {
            let row = i * ny..(i + 1) * ny;
            let [ax, ay, bx, by] = bends.each_ref().map(|bend| &bend[row.clone()]);
            let bent = |j: usize| [ax, ay, bx, by].iter().any(|bend| bend[j] != 0.0);
            let Some(first) = (0..ny).find(|j| bent(*j)) else {
                continue;
            };
            let end = (0..ny).rfind(|j| bent(*j)).map_or(first, |j| j + 1);
            for offset in near.offsets.iter().filter(|offset| offset.is_close()) {
                let Some(target) = i.checked_add_signed(offset.by[0]).filter(|i| *i < nx) else {
                    continue;
                };
                let off = offset.by[1];
                let start = first.max(off.min(0).unsigned_abs());
                let end = end.min((ny as isize - off.max(0)) as usize);
                if start >= end {
                    continue;
                }
                let [cax, cay, cbx, cby] = offset.bends.map(|bend| bend[k]);
                let begin = (target * ny + start).saturating_add_signed(off);
                let targets = &mut output[begin..begin + end - start];
                let slopes = ax[start..end].iter().zip(&ay[start..end]);
                let curvatures = bx[start..end].iter().zip(&by[start..end]);
                let sources = slopes.zip(curvatures);
                for (output, ((ax, ay), (bx, by))) in targets.iter_mut().zip(sources) {
                    *output += cax * ax + cay * ay + cbx * bx + cby * by;
                }
            }
        }
    }
}
