//! Cells near a smooth edge of the contact, with a polynomial for p² that is continued from the
//! interior.
//!
//! A polynomial of second or of third degree is fitted to p² of cells that are [`BAND`] cells from the
//! edge and farther ([`super::fit`]), and continued to the edge. The outermost two cells carry the
//! staircase of the solver's contact; those farther inside determine the edge within some thousandths
//! of a cell. A cell keeps its uniform pressure
//!
//! - where too few cells are inside: contacts of few cells, ridges, tips;
//! - where the residuals of the fit leave the edge uncertain by more than [`UNCERTAINTY_LIMIT`] cells:
//!   rough surfaces;
//! - where the fitted edge is farther than [`OFFSET_LIMIT`] cells from that of the solver's cells: sharp
//!   edges, at which p grows;
//! - where the grid's border cuts the contact, which is no edge of it;
//! - within [`NEIGHBOURS`] cells of such a place: a fit that looks certain among others that are not does
//!   so by chance.

use std::ops::ControlFlow;

use rayon::prelude::*;

use super::fit::{Fit, NormalEquations, SquaredPressure, may_be_fitted};
use super::neighbours::{around, is_at_border};
use crate::numerics::parallel::Threads;
use crate::stress::options::StressProgress;

/// Distance from the edge, in cells, from which on inwards pressure is fitted. Cells up to here take
/// the fitted pressure. Two cells carry the staircase.
pub(super) const BAND: u8 = 3;

/// Degrees of the polynomials that are tried: at the second, Hertz' contact is exact.
const DEGREES: [u8; 2] = [2, 3];

/// Distance, in cells, around a cell without a fit in which no other cell takes its own. Chosen by
/// trial.
const NEIGHBOURS: usize = 3;

/// Cells that are fitted between two calls of the callback: some hundredths of a second of work.
const BLOCK: usize = 4096;

/// Largest uncertainty of the place of the edge, in cells, at which a fit is taken: the pressure there
/// errs by the root of it times the slope of p². Chosen by trial: rough contacts are a tenth of a cell
/// uncertain or more, smooth ones some thousandths.
const UNCERTAINTY_LIMIT: f64 = 0.05;

/// Largest distance, in cells, of the fitted edge from the centres of the outermost cells of the
/// contact: half a cell where the solver's contact ends with the pressure, and a tenth for the fit.
const OFFSET_LIMIT: f64 = 0.6;

/// A cell near the edge, and the polynomial for p² in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct EdgeCell {
    pub(super) cell: [usize; 2],
    pub(super) squared: SquaredPressure,
}

/// Cells near the edge in which a fitted polynomial is taken, in the order of the grid. `progress` is
/// asked before every block of them.
pub(super) fn edge_cells(
    pressure: &[f64],
    distances: &[u8],
    shape: [usize; 2],
    threads: &Threads,
    progress: &mut StressProgress,
) -> ControlFlow<(), Vec<EdgeCell>> {
    let known = squared_pressures(pressure, distances, shape);
    progress(0.0)?;
    let band = edge_band(distances, shape);
    progress(0.0)?;
    let mut open = OpenCells::new(&band, shape);
    for cell in band.iter().filter(|cell| is_at_border(shape, **cell)) {
        open.close(*cell, usize::from(BAND) - 1 + NEIGHBOURS);
    }
    // Every third cell along x and y first: where those are refused, the others need no fit.
    let (first, others): (Vec<usize>, Vec<usize>) =
        (0..band.len()).partition(|k| band[*k].iter().all(|at| at % NEIGHBOURS == 0));
    let mut fitted: Vec<Option<SquaredPressure>> = vec![None; band.len()];
    for block in first.chunks(BLOCK).chain(others.chunks(BLOCK)) {
        progress(0.0)?;
        let is_needed = |k: &usize| open.any_around(band[*k], NEIGHBOURS);
        let needed: Vec<usize> = block.iter().copied().filter(is_needed).collect();
        let fit = |k: &usize| accepted_fit(&known, pressure, shape, band[*k]);
        let found: Vec<_> = threads.run(|| needed.par_iter().map(fit).collect());
        for (k, squared) in needed.into_iter().zip(found) {
            if squared.is_none() {
                open.close(band[k], NEIGHBOURS);
            }
            fitted[k] = squared;
        }
    }
    let cells = band.into_iter().zip(fitted).filter_map(|(cell, squared)| {
        let squared = squared.filter(|_| open.is_open(cell))?;
        Some(EdgeCell { cell, squared })
    });
    ControlFlow::Continue(cells.collect())
}

/// Cells up to [`BAND`] from the edge, and those beside them that have no pressure.
fn edge_band(distances: &[u8], shape @ [nx, ny]: [usize; 2]) -> Vec<[usize; 2]> {
    let loaded = |[i, j]: [usize; 2]| distances[i * ny + j] > 0;
    let is_in_band = |cell: &[usize; 2]| match distances[cell[0] * ny + cell[1]] {
        0 => around(shape, *cell, 1).any(loaded),
        distance => distance <= BAND,
    };
    let cells = (0..nx * ny).map(|cell| [cell / ny, cell % ny]);
    cells.filter(is_in_band).collect()
}

/// Cells near the edge that may still take a fitted pressure.
struct OpenCells {
    shape: [usize; 2],
    open: Vec<bool>,
}

impl OpenCells {
    fn new(band: &[[usize; 2]], shape @ [nx, ny]: [usize; 2]) -> Self {
        let mut open = vec![false; nx * ny];
        for [i, j] in band {
            open[i * ny + j] = true;
        }
        Self { shape, open }
    }

    fn is_open(&self, [i, j]: [usize; 2]) -> bool {
        self.open[i * self.shape[1] + j]
    }

    fn any_around(&self, cell: [usize; 2], reach: usize) -> bool {
        around(self.shape, cell, reach).any(|cell| self.is_open(cell))
    }

    fn close(&mut self, cell: [usize; 2], reach: usize) {
        for [i, j] in around(self.shape, cell, reach) {
            self.open[i * self.shape[1] + j] = false;
        }
    }
}

/// p² at the centres of cells that are [`BAND`] cells from the edge and farther. A solver's pressure
/// stands for the mean over its cell, which differs from the value at the centre by
/// (δ_x² + δ_y²) p / 24.
fn squared_pressures(pressure: &[f64], distances: &[u8], [nx, ny]: [usize; 2]) -> Vec<Option<f64>> {
    let squared = |cell: usize| {
        let p = pressure[cell];
        let mut differences = pressure[cell - 1] + pressure[cell + 1] - 2.0 * p;
        if nx > 1 {
            differences += pressure[cell - ny] + pressure[cell + ny] - 2.0 * p;
        }
        (p + differences / 24.0).powi(2)
    };
    let inside = |(cell, distance): (usize, &u8)| (*distance >= BAND).then(|| squared(cell));
    distances.iter().enumerate().map(inside).collect()
}

/// The most certain of the fits around one cell, if it is certain enough and its edge agrees with the
/// solver's cells.
fn accepted_fit(
    known: &[Option<f64>],
    pressure: &[f64],
    shape: [usize; 2],
    cell @ [i, j]: [usize; 2],
) -> Option<SquaredPressure> {
    if !may_be_fitted(known, shape, cell) {
        return None;
    }
    let equations = NormalEquations::around(known, shape, cell);
    let fits = DEGREES
        .into_iter()
        .filter_map(|degree| equations.fit(degree));
    let Fit {
        polynomial,
        uncertainty,
    } = fits.reduce(|a, b| if b.uncertainty < a.uncertainty { b } else { a })?;
    // Distance of the cell's centre from the edge, positive inside.
    let distance = polynomial.at(0.0, 0.0) / polynomial.slope();
    let agrees = if pressure[i * shape[1] + j] > 0.0 {
        distance > -OFFSET_LIMIT
    } else {
        distance < OFFSET_LIMIT
    };
    (uncertainty <= UNCERTAINTY_LIMIT && agrees).then_some(polynomial)
}

#[cfg(test)]
mod tests {
    use super::super::neighbours::edge_distances;
    use super::*;
    use crate::error::Result;

    const SHAPE: [usize; 2] = [41, 44];

    /// Values of a function of the distances, in cells, from a centre that is off the grid's.
    fn field(q: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        let [nx, ny] = SHAPE;
        let at = |cell: usize| ((cell / ny) as f64 - 20.3, (cell % ny) as f64 - 21.1);
        (0..nx * ny).map(at).map(|(x, y)| q(x, y)).collect()
    }

    /// All edges of a smooth contact are known; none of one that is rough by 5 %, nor under a punch.
    /// Values at centres are taken for those of a solver: that shifts the edge by p p''/12 over the
    /// slope of p², 1/48 of a cell at one cell from it, twice as much at half a cell.
    #[test]
    fn edges_are_known_where_they_are_smooth() -> Result<()> {
        let hertz = field(|x, y| (1.0 - (x * x + y * y) / 225.0).max(0.0).sqrt());
        let found = |pressure: &[f64]| -> Result<Vec<EdgeCell>> {
            let distances = edge_distances(pressure, SHAPE, BAND + 1);
            let threads = Threads::new(Some(2))?;
            let mut progress = |_| ControlFlow::Continue(());
            match edge_cells(pressure, &distances, SHAPE, &threads, &mut progress) {
                ControlFlow::Continue(cells) => Ok(cells),
                ControlFlow::Break(()) => panic!("nothing stops it"),
            }
        };
        let edges = found(&hertz)?;
        assert!(edges.len() > 300);
        for EdgeCell { cell, squared } in edges {
            let (x, y) = (cell[0] as f64 - 20.3, cell[1] as f64 - 21.1);
            let exact = 1.0 - (x * x + y * y) / 225.0;
            // In cells, by the slope 2/15 of p² at the edge.
            let shift = (squared.at(0.0, 0.0) - exact) * 7.5;
            assert!(shift.abs() < 1.0 / 24.0, "{cell:?}: {shift:.1e}");
        }
        let wave = field(|x, y| 1.0 + 0.05 * (1.7 * x).sin() * (1.9 * y).cos());
        let rough: Vec<f64> = hertz.iter().zip(&wave).map(|(p, w)| p * w).collect();
        assert!(found(&rough)?.is_empty());
        let punch: Vec<f64> = hertz
            .iter()
            .map(|p| if *p > 0.0 { 1.0 / p } else { 0.0 })
            .collect();
        assert!(found(&punch)?.is_empty());
        Ok(())
    }
}
