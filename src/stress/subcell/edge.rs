//! Pressure near the edge of a contact, where it falls as a square root.
//!
//! Where the surfaces part smoothly p = √d (c0 + c1 d + …) at the distance d inside of the edge:
//! p² is smooth up to it, and for Hertz' contact a polynomial of second degree. One of second or of
//! third degree is fitted to p² of cells that are [`BAND`] cells from the edge and farther, and
//! continued to it: the outermost two cells carry the staircase of the solver's contact, the others
//! tell the edge within some thousandths of a cell. It is not taken
//!
//! - where too few cells are inside: contacts of few cells, ridges, tips;
//! - where it does not tell the edge within [`SURE`] cells, from how well it fits: rough surfaces;
//! - where its edge is farther than [`NEAR`] cells from that of the solver's cells: sharp edges, at
//!   which p grows;
//! - where the grid's border cuts the contact, which is no edge of it;
//! - within [`NEIGHBOURS`] cells of where it is not taken.

use rayon::prelude::*;

use super::fit::{Samples, Square, may_fit};
use crate::parallel::Threads;

/// How far from the edge, in cells, pressure is fitted: from here on inwards. Cells up to here take
/// what was fitted.
pub(super) const BAND: u8 = 3;

/// Degrees of the polynomials that are tried.
const DEGREES: [u8; 2] = [2, 3];

/// How far, in cells, all must have been fitted that are near the edge.
const NEIGHBOURS: usize = 3;

/// Cells that are fitted between two questions whether to go on: some hundredths of a second.
const BLOCK: usize = 4096;

/// Uncertainty of the place of the edge that is allowed, in cells: a root of it, times the slope, is
/// missed in the pressure there. Rough contacts are told apart by a tenth.
const SURE: f64 = 0.05;

/// Distance between the edge and the centres of the outer cells of the contact, in cells: half a
/// cell where the solver's contact ends with the pressure, and a tenth for the fit.
const NEAR: f64 = 0.6;

/// A cell near the edge, and p² in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct EdgeCell {
    pub(super) cell: [usize; 2],
    pub(super) square: Square,
}

/// How many cells each is from the nearest that does not touch, diagonally too; up to `most`.
/// Beyond the grid nothing touches; a row of line contact is endless.
pub(super) fn distances(pressure: &[f64], [nx, ny]: [usize; 2], most: u8) -> Vec<u8> {
    let mut distances: Vec<u8> = pressure.iter().map(|p| u8::from(*p > 0.0)).collect();
    for level in 1..most {
        let before = distances.clone();
        let inside = |i: isize, j: isize| {
            let row = nx == 1 || (0..nx as isize).contains(&i);
            let column = (0..ny as isize).contains(&j);
            let i = if nx == 1 { 0 } else { i };
            row && column && before[i as usize * ny + j as usize] >= level
        };
        for (cell, distance) in distances.iter_mut().enumerate() {
            if *distance == level {
                let (i, j) = ((cell / ny) as isize, (cell % ny) as isize);
                let all = (-1..=1).all(|a| (-1..=1).all(|b| inside(i + a, j + b)));
                *distance += u8::from(all);
            }
        }
    }
    distances
}

/// The cells in which p² is known from within the contact, by rows; none where `go_on`, which is
/// asked before every block of them, stops it.
pub(super) fn edge_cells(
    pressure: &[f64],
    distances: &[u8],
    shape @ [nx, ny]: [usize; 2],
    threads: &Threads,
    go_on: &mut dyn FnMut() -> bool,
) -> Option<Vec<EdgeCell>> {
    let squares = squares(pressure, distances, shape);
    if !go_on() {
        return None;
    }
    // The band, with the cells beside it that do not touch.
    let beside =
        |i: usize, j: usize| around(shape, [i, j], 1).any(|[i, j]| distances[i * ny + j] > 0);
    let band: Vec<[usize; 2]> = (0..nx * ny)
        .map(|cell| [cell / ny, cell % ny])
        .filter(|&[i, j]| match distances[i * ny + j] {
            0 => beside(i, j),
            distance => distance <= BAND,
        })
        .collect();
    if !go_on() {
        return None;
    }
    // Those that may still be taken: a fit that is sure among others that are not is so by chance.
    let mut open = vec![false; pressure.len()];
    for [i, j] in &band {
        open[i * ny + j] = true;
    }
    let close = |open: &mut [bool], cell: [usize; 2], reach: usize| {
        around(shape, cell, reach).for_each(|[i, j]| open[i * ny + j] = false);
    };
    for cell in band.iter().filter(|cell| is_outermost(shape, **cell)) {
        close(&mut open, *cell, usize::from(BAND) - 1 + NEIGHBOURS);
    }
    // Every third cell along x and y first: where those are refused, none of the others are fitted.
    let (first, others): (Vec<usize>, Vec<usize>) =
        (0..band.len()).partition(|k| band[*k].iter().all(|at| at % NEIGHBOURS == 0));
    let mut fits: Vec<Option<Square>> = vec![None; band.len()];
    for block in first.chunks(BLOCK).chain(others.chunks(BLOCK)) {
        if !go_on() {
            return None;
        }
        // A fit matters only to the open cells around it.
        let needed: Vec<usize> = block
            .iter()
            .copied()
            .filter(|k| around(shape, band[*k], NEIGHBOURS).any(|[i, j]| open[i * ny + j]))
            .collect();
        let of = |k: &usize| fit(&squares, pressure, shape, band[*k]);
        let found: Vec<_> = threads.run(|| needed.par_iter().map(of).collect());
        for (k, fit) in needed.into_iter().zip(found) {
            if fit.is_none() {
                close(&mut open, band[k], NEIGHBOURS);
            }
            fits[k] = fit;
        }
    }
    let cells = band.into_iter().zip(fits).filter_map(|(cell, fit)| {
        let square = fit.filter(|_| open[cell[0] * ny + cell[1]])?;
        Some(EdgeCell { cell, square })
    });
    Some(cells.collect())
}

/// Whether a cell is at the border of the grid. A contact that goes on to there is cut, which is no
/// edge of it; a row of line contact is endless.
fn is_outermost([nx, ny]: [usize; 2], [i, j]: [usize; 2]) -> bool {
    let ends = |at: usize, count: usize| at == 0 || at + 1 == count;
    ends(j, ny) || nx > 1 && ends(i, nx)
}

/// The cells of the grid within `reach` of one, itself too.
pub(super) fn around(
    [nx, ny]: [usize; 2],
    [i, j]: [usize; 2],
    reach: usize,
) -> impl Iterator<Item = [usize; 2]> {
    let rows = i.saturating_sub(reach)..(i + reach + 1).min(nx);
    rows.flat_map(move |i| (j.saturating_sub(reach)..(j + reach + 1).min(ny)).map(move |j| [i, j]))
}

/// p² at the centres of cells that are inside, where it is fitted. A solver's pressure stands for
/// the uniform one over its cell, which is right for all that is farther off:
/// p = p_cell + (δ_x² + δ_y²) p_cell / 24.
fn squares(pressure: &[f64], distances: &[u8], [nx, ny]: [usize; 2]) -> Vec<Option<f64>> {
    let square = |cell: usize| {
        let p = pressure[cell];
        let mut bend = pressure[cell - 1] + pressure[cell + 1] - 2.0 * p;
        if nx > 1 {
            bend += pressure[cell - ny] + pressure[cell + ny] - 2.0 * p;
        }
        (p + bend / 24.0).powi(2)
    };
    let inside = |(cell, distance): (usize, &u8)| (*distance >= BAND).then(|| square(cell));
    distances.iter().enumerate().map(inside).collect()
}

/// The surest of the fits around one cell, if it is sure, and agrees with the solver's cells.
fn fit(
    squares: &[Option<f64>],
    pressure: &[f64],
    shape: [usize; 2],
    cell @ [i, j]: [usize; 2],
) -> Option<Square> {
    if !may_fit(squares, shape, cell) {
        return None;
    }
    let samples = Samples::around(squares, shape, cell);
    let fits = DEGREES.into_iter().filter_map(|degree| samples.fit(degree));
    let (square, uncertain) = fits.reduce(|a, b| if b.1 < a.1 { b } else { a })?;
    let place = square.at(0.0, 0.0) / square.slope();
    let agrees = if pressure[i * shape[1] + j] > 0.0 {
        place > -NEAR
    } else {
        place < NEAR
    };
    (uncertain <= SURE && agrees).then_some(square)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::{Error, Result};

    const SHAPE: [usize; 2] = [41, 44];

    /// q in the units of cells, around a centre off the grid's.
    fn field(q: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        let [nx, ny] = SHAPE;
        let at = |cell: usize| ((cell / ny) as f64 - 20.3, (cell % ny) as f64 - 21.1);
        (0..nx * ny).map(at).map(|(x, y)| q(x, y)).collect()
    }

    /// A polynomial is found from cells inside, and continued over the edge: three cells beyond
    /// those that are fitted, rounding grows by 1e4.
    #[test]
    fn polynomials_are_exact() {
        const ROUNDING: f64 = 1e-12;
        let ellipse = |x: f64, y: f64| 1.0 - x * x / 200.0 - y * y / 310.0 + x * y / 900.0;
        let cubic = |x: f64, y: f64| ellipse(x, y) + x.powi(3) / 3e4 - x * y * y / 5e4;
        let check = |q: &dyn Fn(f64, f64) -> f64, degree: u8| {
            let values = field(q);
            let pressure: Vec<f64> = values.iter().map(|q| q.max(0.0).sqrt()).collect();
            let distances = distances(&pressure, SHAPE, BAND + 1);
            let inside = |(q, d): (&f64, &u8)| (*d >= BAND).then_some(*q);
            let squares: Vec<_> = values.iter().zip(&distances).map(inside).collect();
            let mut count = 0;
            for (cell, distance) in distances.iter().enumerate() {
                let cell = [cell / SHAPE[1], cell % SHAPE[1]];
                let samples = Samples::around(&squares, SHAPE, cell);
                if *distance == 0 || *distance > BAND {
                    continue;
                }
                let Some((square, uncertain)) = samples.fit(degree) else {
                    panic!("too few")
                };
                let (x, y) = (cell[0] as f64 - 20.3, cell[1] as f64 - 21.1);
                for (u, v) in [(0.0, 0.0), (0.5, -0.5), (-1.0, 0.7)] {
                    let error = square.at(u, v) - q(x + u, y + v);
                    assert!(error.abs() < 1e4 * ROUNDING, "{cell:?}: {error:.1e}");
                }
                // The residual is a difference of squares.
                assert!(uncertain < 1e-5, "{cell:?}: {uncertain:.1e}");
                count += 1;
            }
            assert!(count > 200);
        };
        check(&ellipse, 2);
        check(&cubic, 3);
    }

    /// Of a smooth contact all edges are known; of one that is rough by 5 %, and under a punch, none.
    /// Values at centres are taken for those of a solver: that moves the edge by p p''/12 over the
    /// slope of p², 1/48 of a cell at one cell from it, twice as much at half a cell.
    #[test]
    fn edges_are_known_where_they_are_smooth() -> Result<()> {
        let hertz = field(|x, y| (1.0 - (x * x + y * y) / 225.0).max(0.0).sqrt());
        let found = |pressure: &[f64]| -> Result<Vec<EdgeCell>> {
            let distances = distances(pressure, SHAPE, BAND + 1);
            let threads = Threads::new(Some(2))?;
            edge_cells(pressure, &distances, SHAPE, &threads, &mut || true)
                .ok_or(Error::Inconsistent("it was stopped"))
        };
        let edges = found(&hertz)?;
        assert!(edges.len() > 300);
        for EdgeCell { cell, square } in edges {
            let (x, y) = (cell[0] as f64 - 20.3, cell[1] as f64 - 21.1);
            let exact = 1.0 - (x * x + y * y) / 225.0;
            // In cells, by the slope 2/15 of p² at the edge.
            let moved = (square.at(0.0, 0.0) - exact) * 7.5;
            assert!(moved.abs() < 1.0 / 24.0, "{cell:?}: {moved:.1e}");
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
