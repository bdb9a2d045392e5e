//! The stress that pressure within cells adds nearby.
//!
//! The load of a cell, less its mean and the shares of its first moment
//! ([`super::reconstruction`]), has neither force nor moment: its stresses fall off as the fourth
//! power of the distance. At shallow depths they are summed over some cells around each, from the
//! stresses of pieces of a cell ([`super::reconstruction`]).

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use rayon::prelude::*;

use super::edge::{Fitting, around};
use super::law::EdgeLaw;
use super::reconstruction::{
    CUTS, Cut, Cuts, INERTIA, Interior, Piece, Reconstruction, RootCell, SHIFT_LIMIT,
    SMALLEST_AT_POINT, mean_root,
};
use crate::model::grid::Grid;
use crate::numerics::parallel::Threads;
use crate::numerics::rounding::{self, cells_within};
use crate::stress::options::StressProgress;

/// Number of stress components; pressure within cells adds no displacements.
pub(in crate::stress) const STRESSES: usize = 6;

/// A point of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::stress) struct CellPoint {
    pub(in crate::stress) cell: [usize; 2],
    /// Distances from the cell's centre along x and y, in cells: at most ½.
    pub(in crate::stress) within: [f64; 2],
}

/// The stress components σ_xx, σ_yy, σ_zz, σ_xy, σ_yz, σ_xz.
pub(super) type Components = [f64; STRESSES];

// With 5, 7, 3 and 4 in place of the next four constants, errors of Hertz' contacts of 128 cells to the half-width
// change by 3e-5 of the peak pressure at most, less than a tenth of the largest. What is left out is in proportion to the
// step of the pressure at the edge, and is part of the stated errors ([`super::uncertainty`]): with 8 cells to the
// half-width it is up to 9e-5 of the peak within the reach, and 3e-4 at the largest depth.

/// Distance to which the load of a cell near the edge is followed, in cells of the longer side.
const NEAR_REACH: f64 = 3.0;

/// Depth, in shorter sides of a cell, below which loads near the edge are not felt.
pub(super) const DEPTH_LIMIT: f64 = 4.0;

/// Depth, in shorter sides of a cell, below which parabolas of the interior are not felt: they fall off
/// as e^{−2πz/dx}.
const INTERIOR_DEPTH_LIMIT: f64 = 1.5;

/// Distance, in cells, to which parabolas of the interior are followed.
const INTERIOR_REACH: usize = 2;

/// Largest number of cells along the shorter side to which a load is followed, which bounds the time:
/// cells more than 3.3 times as long as wide lose some. Twelve times is tested (`tests/stress/edge.rs`).
const REACH_LIMIT: usize = 10;

/// Side of the smallest piece around a point over its depth.
const SMALLEST_OF_DEPTH: f64 = 0.125;

/// Cells near the edge whose stresses are held at a time, which bounds the memory.
const CELLS_HELD: usize = 512;

/// The pressure within cells, and how its stresses are summed at any depth.
#[derive(Debug)]
pub(super) struct NearPlan {
    pub(super) reconstruction: Reconstruction,
    shape: [usize; 2],
    /// Sides of a cell; a strip's width, twice.
    sides: [f64; 2],
    line: bool,
    /// Cells along x and y to which a load is followed.
    reach: [usize; 2],
    cuts: Cuts,
}

/// Stresses at a target, of the parts of the load of one cell.
#[derive(Debug)]
struct Offset {
    /// Target minus loaded cell, in cells.
    by: [isize; 2],
    /// Number of the cut into pieces.
    cut: usize,
    /// Under uniform unit pressure.
    uniform: Components,
    /// Under unit slopes along x and along y, less the shares of their first moments.
    slopes: [Components; 2],
    /// Under unit curvatures along x and along y.
    curvatures: [Components; 2],
    /// Under the shares of unit first moments along x and along y.
    shares: [Components; 2],
    /// Under unit pressure on each piece.
    pieces: Vec<Components>,
}

impl Offset {
    /// Whether parabolas of the interior are felt.
    fn feels_interior(&self) -> bool {
        self.by.iter().all(|by| by.unsigned_abs() <= INTERIOR_REACH)
    }

    /// Stress of a cell near the edge, from the `pressures` on its pieces.
    fn root_stress(&self, cell: &RootCell, pressures: &[f64]) -> Components {
        let ([mx, my], [along, across]) = (cell.moments, &self.shares);
        let mut sum = std::array::from_fn(|k| -mx * along[k] - my * across[k]);
        for (coefficients, pressure) in self.pieces.iter().zip(pressures) {
            for (sum, coefficient) in sum.iter_mut().zip(coefficients) {
                *sum += coefficient * pressure;
            }
        }
        sum
    }
}

/// Stresses of the parts of a cell's load at one depth; empty where none are felt.
#[derive(Debug, Default)]
pub(in crate::stress) struct NearTable {
    offsets: Vec<Offset>,
    /// Number of the finest cut that is used.
    finest: usize,
    feels_interior: bool,
    at_surface: bool,
}

impl NearTable {
    pub(super) fn at_surface(&self) -> bool {
        self.at_surface
    }
}

impl NearPlan {
    pub(super) fn new(
        pressure: &[f64],
        grid: &Grid,
        law: Option<(EdgeLaw, Fitting)>,
        threads: &Threads,
        progress: &mut StressProgress,
    ) -> ControlFlow<(), Self> {
        let (shape, line) = (grid.shape(), grid.is_line());
        let sides = if line { [grid.spacing()[1]; 2] } else { grid.spacing() };
        let longer = sides[0].max(sides[1]);
        let reach = |side: f64| cells_within(NEAR_REACH * longer, side).min(REACH_LIMIT);
        ControlFlow::Continue(Self {
            reconstruction: Reconstruction::new(pressure, shape, law, threads, progress)?,
            shape,
            sides,
            line,
            reach: [if line { 0 } else { reach(sides[0]) }, reach(sides[1])],
            cuts: Cuts::new(line),
        })
    }

    /// Largest distance of a piece of a cell from a target.
    pub(super) fn farthest(&self) -> f64 {
        let [along, across] = [0, 1].map(|axis| (self.reach[axis] + 2) as f64 * self.sides[axis]);
        along.hypot(across)
    }

    /// Whether anything is felt at a depth.
    pub(super) fn reaches(&self, depth: f64) -> bool {
        depth < DEPTH_LIMIT * self.shorter()
    }

    fn shorter(&self) -> f64 {
        self.sides[0].min(self.sides[1])
    }

    /// The table at a depth. `stresses` gives those at (x, y) from the centre of a rectangle of half sides
    /// (a, b) under unit pressure. On the threads of the caller.
    pub(super) fn table(
        &self,
        depth: f64,
        stresses: impl Fn([f64; 2], [f64; 2]) -> Components + Sync,
    ) -> NearTable {
        let [rx, ry] = self.reach.map(|reach| reach as isize);
        // One more, for the shares on the neighbours.
        let ends = [if self.line { 0 } else { rx + 1 }, ry + 1];
        let range = |end: isize| -end..=end;
        let all: Vec<[isize; 2]> =
            range(ends[0]).flat_map(|i| range(ends[1]).map(move |j| [i, j])).collect();
        let mut offsets: Vec<Offset> =
            all.into_par_iter().map(|by| self.offset(by, depth, &stresses)).collect();
        let width = 2 * ends[1] + 1;
        let place = |[i, j]: [isize; 2]| ((i + ends[0]) * width + j + ends[1]) as usize;
        let uniform: Vec<Components> = offsets.iter().map(|o| o.uniform).collect();
        offsets.retain(|o| o.by[0].abs() <= rx && o.by[1].abs() <= ry);
        for offset in &mut offsets {
            let [i, j] = offset.by;
            for axis in 0..2 {
                if self.line && axis == 0 {
                    continue;
                }
                let [ax, ay] = [[1, 0], [0, 1]][axis];
                // From the cell on the right the target is one less off.
                let (right, left) =
                    (uniform[place([i - ax, j - ay])], uniform[place([i + ax, j + ay])]);
                for k in 0..STRESSES {
                    offset.shares[axis][k] = 0.5 * (right[k] - left[k]);
                    offset.slopes[axis][k] -= INERTIA * offset.shares[axis][k];
                }
            }
        }
        NearTable {
            offsets,
            finest: Cuts::finest_at(depth / self.shorter()),
            feels_interior: depth < INTERIOR_DEPTH_LIMIT * self.shorter(),
            at_surface: depth == 0.0,
        }
    }

    /// Stresses at a target `by` cells away, without those of shares.
    fn offset(
        &self,
        by @ [i, j]: [isize; 2],
        depth: f64,
        stresses: impl Fn([f64; 2], [f64; 2]) -> Components,
    ) -> Offset {
        let [dx, dy] = self.sides;
        let number = self.cuts.cut_number(by, depth / self.shorter());
        let cut = self.cuts.get(number);
        let stress = |Piece { centre, half }: &Piece| {
            let at = [(i as f64 - centre[0]) * dx, (j as f64 - centre[1]) * dy];
            stresses(at, [half[0] * dx, half[1] * dy])
        };
        let pieces: Vec<Components> = cut.pieces.iter().map(stress).collect();
        let mut uniform = [0.0; STRESSES];
        let [mut slopes, mut curvatures] = [[[0.0; STRESSES]; 2]; 2];
        for (value, piece) in pieces.iter().zip(&cut.pieces) {
            let means = [0, 1].map(|axis| piece.mean_square(axis));
            for k in 0..STRESSES {
                uniform[k] += value[k];
                for axis in 0..2 {
                    slopes[axis][k] += cut.norms[axis] * piece.centre[axis] * value[k];
                    curvatures[axis][k] += 0.5 * (means[axis] - INERTIA) * value[k];
                }
            }
        }
        Offset {
            by,
            cut: number,
            uniform,
            slopes,
            curvatures,
            shares: [[0.0; STRESSES]; 2],
            pieces,
        }
    }

    /// Adds the stresses of pressure within cells to `outputs`, one plane of each component. On the
    /// threads of the caller.
    pub(super) fn add(&self, near: &NearTable, outputs: &mut [&mut [f64]]) {
        if near.offsets.is_empty() {
            return;
        }
        for block in self.reconstruction.roots.chunks(CELLS_HELD) {
            let stresses: Vec<_> =
                block.par_iter().map(|cell| self.root_stresses(near, cell)).collect();
            outputs.par_iter_mut().enumerate().for_each(|(k, output)| {
                for (cell, stresses) in block.iter().zip(&stresses) {
                    for (offset, stress) in near.offsets.iter().zip(stresses) {
                        if let Some(target) = self.cell_at(cell.cell, offset.by) {
                            output[self.number(target)] += stress[k];
                        }
                    }
                }
            });
        }
        if near.feels_interior {
            outputs
                .par_iter_mut()
                .enumerate()
                .for_each(|(k, output)| self.add_interior(near, k, output));
        }
    }

    /// Pressures on the pieces of a cut, less the cell's mean, and linearly corrected: their first
    /// moments are those that the shares in the convolution stand for.
    fn piece_pressures(&self, cell: &RootCell, cut: &Cut) -> Vec<f64> {
        let profile = self.reconstruction.law.profile(&cell.squared);
        let pressure = |piece| mean_root(&profile, piece, cut.points, self.line);
        let mut pressures: Vec<f64> = cut.pieces.iter().map(pressure).collect();
        let (mut mean, mut missing) = (0.0, cell.moments);
        for (pressure, piece) in pressures.iter().zip(&cut.pieces) {
            let load = pressure * piece.area();
            mean += load;
            missing[0] -= load * piece.centre[0];
            missing[1] -= load * piece.centre[1];
        }
        let [along, across] = [0, 1].map(|axis| missing[axis] * cut.norms[axis] / INERTIA);
        for (pressure, piece) in pressures.iter_mut().zip(&cut.pieces) {
            *pressure += along * piece.centre[0] + across * piece.centre[1] - mean;
        }
        pressures
    }

    /// Stresses of the load of one cell near the edge, at all offsets.
    fn root_stresses(&self, near: &NearTable, cell: &RootCell) -> Vec<Components> {
        let pressures: [Vec<f64>; CUTS] = std::array::from_fn(|cut| {
            if cut < near.finest {
                Vec::new()
            } else {
                self.piece_pressures(cell, self.cuts.get(cut))
            }
        });
        let stress = |offset: &Offset| offset.root_stress(cell, &pressures[offset.cut]);
        near.offsets.iter().map(stress).collect()
    }

    /// What [`NearPlan::add`] adds in one cell.
    pub(super) fn sum_at(&self, near: &NearTable, target: [usize; 2]) -> Components {
        let mut sum = [0.0; STRESSES];
        let Reconstruction { interior, roots, .. } = &self.reconstruction;
        for offset in &near.offsets {
            let Some(cell) = self.cell_at(target, offset.by.map(|by| -by)) else {
                continue;
            };
            if near.feels_interior && offset.feels_interior() {
                let number = self.number(cell);
                for axis in 0..2 {
                    let slope = interior.slopes[axis][number];
                    let curvature = interior.curvatures[axis][number];
                    for (k, sum) in sum.iter_mut().enumerate() {
                        *sum += offset.slopes[axis][k] * slope;
                        *sum += offset.curvatures[axis][k] * curvature;
                    }
                }
            }
            // Roots are in the order of the grid.
            if let Ok(index) = roots.binary_search_by_key(&cell, |root| root.cell) {
                let pressures = self.piece_pressures(&roots[index], self.cuts.get(offset.cut));
                let stress = offset.root_stress(&roots[index], &pressures);
                sum.iter_mut().zip(stress).for_each(|(sum, s)| *sum += s);
            }
        }
        sum
    }

    /// What pressure within cells adds to the stress at a `depth` below a point of a cell. `stresses` gives those at (x, y)
    /// from the centre of a rectangle of half sides (a, b) under unit pressure.
    pub(super) fn sum_at_point(
        &self,
        &CellPoint { cell: target, within }: &CellPoint,
        depth: f64,
        stresses: impl Fn([f64; 2], [f64; 2]) -> Components,
    ) -> Components {
        let mut sum = [0.0; STRESSES];
        let mut add = |factor: f64, values: Components| {
            sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += factor * value);
        };
        let [dx, dy] = self.sides;
        let [rx, ry] = self.reach.map(|reach| reach as isize);
        let Reconstruction { interior, roots, law, .. } = &self.reconstruction;
        let offsets = (-rx..=rx).flat_map(|i| (-ry..=ry).map(move |j| [i, j]));
        for by @ [i, j] in offsets {
            let Some(cell) = self.cell_at(target, [-i, -j]) else {
                continue;
            };
            let number = self.number(cell);
            // The target, from the centre of the cell.
            let at = [i as f64 + within[0], j as f64 + within[1]];
            let stress = |Piece { centre, half }: &Piece| {
                let from = [(at[0] - centre[0]) * dx, (at[1] - centre[1]) * dy];
                stresses(from, [half[0] * dx, half[1] * dy])
            };
            let root = roots.binary_search_by_key(&cell, |root| root.cell).ok();
            let curved = [0, 1]
                .map(|axis| [interior.slopes[axis][number], interior.curvatures[axis][number]]);
            if root.is_none() && curved == [[0.0; 2]; 2] {
                continue;
            }
            let smallest = (SMALLEST_OF_DEPTH * depth / self.shorter()).max(SMALLEST_AT_POINT);
            let graded =
                by.iter().all(|by| by.abs() <= 1).then(|| Cut::towards(at, smallest, self.line));
            let seen = self.cuts.cut_number(by, depth / self.shorter());
            let cut = graded.as_ref().unwrap_or_else(|| self.cuts.get(seen));
            let (pressures, moments) = match root {
                Some(root) => {
                    let root = &roots[root];
                    let mut pressures = self.piece_pressures(root, cut);
                    // The smallest piece has the pressure of its middle, the point, and not the larger mean of a root.
                    let has_point = |piece: &Piece| {
                        [0, 1].iter().all(|k| (at[*k] - piece.centre[*k]).abs() < piece.half[*k])
                    };
                    if let Some(own) = cut.pieces.iter().position(has_point) {
                        let profile = law.profile(&root.squared);
                        let mean = mean_root(&profile, &cut.pieces[own], 1, self.line);
                        pressures[own] += profile.at(at) - mean;
                    }
                    (pressures, root.moments)
                }
                None => {
                    let pressure = |piece: &Piece| -> f64 {
                        let along = |axis: usize| {
                            let [slope, curvature] = curved[axis];
                            let square = piece.mean_square(axis) - INERTIA;
                            slope * piece.centre[axis] + 0.5 * curvature * square
                        };
                        along(0) + along(1)
                    };
                    let moments = curved.map(|[slope, _]| INERTIA * slope);
                    (cut.pieces.iter().map(pressure).collect(), moments)
                }
            };
            for (piece, pressure) in cut.pieces.iter().zip(pressures) {
                add(pressure, stress(piece));
            }
            for (axis, moment) in moments.into_iter().enumerate() {
                if moment != 0.0 && !(self.line && axis == 0) {
                    for side in [1.0, -1.0] {
                        let mut neighbour = Piece::CELL;
                        neighbour.centre[axis] = side;
                        add(-0.5 * side * moment, stress(&neighbour));
                    }
                }
            }
        }
        sum
    }

    /// The pressure at a point of a cell whose mean is `mean`.
    pub(super) fn pressure_at(
        &self,
        &CellPoint { cell, within: [u, v] }: &CellPoint,
        mean: f64,
    ) -> f64 {
        let Reconstruction { interior, roots, law, .. } = &self.reconstruction;
        if let Ok(root) = roots.binary_search_by_key(&cell, |root| root.cell) {
            return law.profile(&roots[root].squared).at([u, v]);
        }
        let number = self.number(cell);
        let along = |axis: usize, u: f64| {
            u * interior.slopes[axis][number]
                + 0.5 * (u * u - INERTIA) * interior.curvatures[axis][number]
        };
        mean + along(0, u) + along(1, v)
    }

    /// Cells near the edge, and the pressure at their centres.
    pub(super) fn central_pressures(&self) -> impl Iterator<Item = (usize, f64)> {
        let Reconstruction { roots, law, .. } = &self.reconstruction;
        roots.iter().map(|root| (self.number(root.cell), law.profile(&root.squared).at([0.0; 2])))
    }

    /// Points of the edge, at most one in a cell.
    pub(super) fn edge(&self) -> Vec<CellPoint> {
        let roots = &self.reconstruction.roots;
        let own = roots.iter().filter_map(|root| Some((root.cell, root.edge(0.5)?)));
        let mut points: BTreeMap<[usize; 2], [f64; 2]> = own.collect();
        // Fits of two neighbours may each have the edge in the other's cell: by as much as a fit is uncertain.
        for root in roots {
            if around(self.shape, root.cell, 1).any(|cell| points.contains_key(&cell)) {
                continue;
            }
            if let Some(at) = root.edge(0.5 + SHIFT_LIMIT)
                && let by = at.map(|u| rounding::round(u) as isize)
                && let Some(cell) = self.cell_at(root.cell, by)
            {
                points.insert(cell, [0, 1].map(|axis| at[axis] - by[axis] as f64));
            }
        }
        points.into_iter().map(|(cell, within)| CellPoint { cell, within }).collect()
    }

    /// Cells near an edge that is reconstructed.
    pub(super) fn edge_cells(&self) -> impl Iterator<Item = [usize; 2]> {
        self.reconstruction.roots.iter().map(|root| root.cell)
    }

    /// Unit vector towards the inside of the contact at one of the points of its edge.
    pub(super) fn inward(&self, &CellPoint { cell, within }: &CellPoint) -> Option<[f64; 2]> {
        let roots = &self.reconstruction.roots;
        let root = roots.binary_search_by_key(&cell, |root| root.cell).ok()?;
        let slopes = roots[root].squared.gradient(within);
        let [x, y] = [0, 1].map(|axis| slopes[axis] / self.sides[axis]);
        let length = x.hypot(y);
        (length > 0.0).then(|| [x / length, y / length])
    }

    /// Number of a cell in the order of the grid.
    pub(super) fn number(&self, [i, j]: [usize; 2]) -> usize {
        i * self.shape[1] + j
    }

    /// The cell at an offset from another, if it is on the grid.
    fn cell_at(&self, cell: [usize; 2], by: [isize; 2]) -> Option<[usize; 2]> {
        let [nx, ny] = self.shape;
        let [i, j] = [0, 1].map(|axis| cell[axis].checked_add_signed(by[axis]));
        Some([i.filter(|i| *i < nx)?, j.filter(|j| *j < ny)?])
    }

    /// Adds component `k` of the parabolas of the interior.
    fn add_interior(&self, near: &NearTable, k: usize, output: &mut [f64]) {
        let [nx, ny] = self.shape;
        let Interior { slopes, curvatures } = &self.reconstruction.interior;
        for i in 0..nx {
            let row = i * ny..(i + 1) * ny;
            let [sx, sy] = slopes.each_ref().map(|part| &part[row.clone()]);
            let [kx, ky] = curvatures.each_ref().map(|part| &part[row.clone()]);
            let is_curved = |j: &usize| [sx, sy, kx, ky].iter().any(|part| part[*j] != 0.0);
            let Some(first) = (0..ny).find(is_curved) else {
                continue;
            };
            let end = (0..ny).rfind(is_curved).map_or(first, |j| j + 1);
            for offset in near.offsets.iter().filter(|offset| offset.feels_interior()) {
                let Some(target) = i.checked_add_signed(offset.by[0]).filter(|i| *i < nx) else {
                    continue;
                };
                let off = offset.by[1];
                let start = first.max(off.min(0).unsigned_abs());
                let end = end.min((ny as isize - off.max(0)) as usize);
                if start >= end {
                    continue;
                }
                let [of_sx, of_sy] = offset.slopes.map(|stresses| stresses[k]);
                let [of_kx, of_ky] = offset.curvatures.map(|stresses| stresses[k]);
                let begin = (target * ny + start).saturating_add_signed(off);
                let targets = &mut output[begin..begin + end - start];
                let slopes = sx[start..end].iter().zip(&sy[start..end]);
                let curvatures = kx[start..end].iter().zip(&ky[start..end]);
                let sources = slopes.zip(curvatures);
                for (output, ((sx, sy), (kx, ky))) in targets.iter_mut().zip(sources) {
                    *output += of_sx * sx + of_sy * sy + of_kx * kx + of_ky * ky;
                }
            }
        }
    }
}
