//! Pressure near the edge of a contact, where it falls as a square root.
//!
//! Where the surfaces part smoothly p = √d (c0 + c1 d + …) at the distance d inside of the edge:
//! p² is smooth up to it, and for Hertz' contact a polynomial of second degree. One is fitted to p²
//! of cells that are some way inside, and continued to the edge: the outermost two cells carry the
//! staircase of the solver's contact. It is not taken
//!
//! - where too few cells are inside: contacts of few cells, ridges, tips;
//! - where it does not tell the edge within [`SURE`] cells, from how well it fits: rough surfaces;
//! - where its edge is farther than [`NEAR`] cells from that of the solver's cells: sharp edges, at
//!   which p grows.

use rayon::prelude::*;

/// How many cells from the edge p² is not fitted, but replaced.
pub(super) const BAND: u8 = 3;

/// Cells to each side that a fit looks at.
const WINDOW: isize = 8;

/// Fewest cells that are fitted, in two dimensions and in one.
const FEWEST: [usize; 2] = [16, 5];

/// Uncertainty of the place of the edge, in cells.
const SURE: f64 = 0.05;

/// Distance between the edge and the outer cells of the contact, in cells.
const NEAR: f64 = 0.6;

/// A polynomial of second degree in the distances u, v from a cell's centre, in cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Square([f64; 6]);

impl Square {
    pub(super) fn at(&self, u: f64, v: f64) -> f64 {
        let [c, cu, cv, cuu, cuv, cvv] = self.0;
        c + u * (cu + u * cuu + v * cuv) + v * (cv + v * cvv)
    }

    pub(super) fn raise(&mut self, by: f64) {
        self.0[0] += by;
    }

    /// How much it changes from the centre to the corners of a piece of half sides (a, b), at the
    /// slope of the cell's centre.
    pub(super) fn varies(&self, [a, b]: [f64; 2]) -> f64 {
        self.0[1].abs() * a + self.0[2].abs() * b
    }

    /// Its slope at the centre.
    fn slope(&self) -> f64 {
        self.0[1].hypot(self.0[2])
    }
}

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

/// The cells in which p² is known from within the contact, by rows.
pub(super) fn edge_cells(
    pressure: &[f64],
    distances: &[u8],
    shape @ [nx, ny]: [usize; 2],
) -> Vec<EdgeCell> {
    let squares = squares(pressure, distances, shape);
    // The band, with the cells beside it that do not touch.
    let beside = |i: usize, j: usize| {
        around(shape, [i, j], 1).any(|[i, j]| distances[i * ny + j] > 0)
    };
    let band: Vec<[usize; 2]> = (0..nx * ny)
        .map(|cell| [cell / ny, cell % ny])
        .filter(|&[i, j]| match distances[i * ny + j] {
            0 => beside(i, j),
            distance => distance <= BAND,
        })
        .collect();
    let fits: Vec<Option<Square>> = band
        .par_iter()
        .map(|cell| fit(&squares, pressure, shape, *cell))
        .collect();
    let mut refused = vec![false; pressure.len()];
    for ([i, j], fit) in band.iter().zip(&fits) {
        refused[i * ny + j] = fit.is_none();
    }
    // What one cell's neighbour says of the edge, the cell must know too.
    let known = |cell: [usize; 2]| !around(shape, cell, 1).any(|[i, j]| refused[i * ny + j]);
    let cells = band.into_iter().zip(fits).filter_map(|(cell, fit)| {
        let square = fit.filter(|_| known(cell))?;
        Some(EdgeCell { cell, square })
    });
    cells.collect()
}

/// The cells of the grid within `reach` of one, itself too.
pub(super) fn around(
    [nx, ny]: [usize; 2],
    [i, j]: [usize; 2],
    reach: usize,
) -> impl Iterator<Item = [usize; 2]> {
    let rows = i.saturating_sub(reach)..(i + reach + 1).min(nx);
    rows.flat_map(move |i| {
        (j.saturating_sub(reach)..(j + reach + 1).min(ny)).map(move |j| [i, j])
    })
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

/// Least squares around one cell, nearer cells counting more; none where it is not sure.
fn fit(
    squares: &[Option<f64>],
    pressure: &[f64],
    [nx, ny]: [usize; 2],
    [i, j]: [usize; 2],
) -> Option<Square> {
    let line = nx == 1;
    let terms = if line { 3 } else { 6 };
    let scale = WINDOW as f64;
    let basis = |u: f64, v: f64| {
        if line {
            [1.0, v, v * v, 0.0, 0.0, 0.0]
        } else {
            [1.0, u, v, u * u, u * v, v * v]
        }
    };
    let (mut normal, mut right) = ([[0.0; 6]; 6], [0.0; 6]);
    let (mut total, mut weights, mut count) = (0.0, 0.0, 0);
    for [k, l] in around([nx, ny], [i, j], WINDOW as usize) {
        let Some(square) = squares[k * ny + l] else {
            continue;
        };
        let u = (k as f64 - i as f64) / scale;
        let v = (l as f64 - j as f64) / scale;
        let rest = 1.1 - (u * u + v * v);
        if rest <= 0.0 {
            continue;
        }
        let weight = rest * rest;
        let basis = basis(u, v);
        for a in 0..terms {
            for b in 0..=a {
                normal[a][b] += weight * basis[a] * basis[b];
            }
            right[a] += weight * basis[a] * square;
        }
        total += weight * square * square;
        weights += weight;
        count += 1;
    }
    if count < FEWEST[usize::from(line)] {
        return None;
    }
    cholesky(&mut normal, terms)?;
    let explained = right;
    let solution = solved(&normal, right, terms);
    let spread = solved(&normal, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0], terms)[0];
    let [c, a, b, aa, ab, bb] = solution;
    let (s, t) = (1.0 / scale, 1.0 / (scale * scale));
    let square = Square(if line {
        [c, 0.0, a * s, 0.0, 0.0, b * t]
    } else {
        [c, a * s, b * s, aa * t, ab * t, bb * t]
    });
    let product: f64 = solution.iter().zip(&explained).map(|(c, r)| c * r).sum();
    let variance = ((total - product) / weights).max(0.0);
    // In the units in which the edge is one cell off.
    let slope = square.slope();
    let sure = (variance * spread * weights / count as f64).sqrt() <= SURE * slope;
    let place = solution[0] / slope;
    let agrees = if pressure[i * ny + j] > 0.0 {
        place > -NEAR
    } else {
        place < NEAR
    };
    (slope > 0.0 && sure && agrees).then_some(square)
}

/// The factor of Cholesky in the lower triangle, in place; none where a pivot is lost.
fn cholesky(matrix: &mut [[f64; 6]; 6], terms: usize) -> Option<()> {
    for a in 0..terms {
        let scale = matrix[a][a];
        for b in 0..=a {
            let sum: f64 = (0..b).map(|k| matrix[a][k] * matrix[b][k]).sum();
            let rest = matrix[a][b] - sum;
            if a == b {
                if rest <= 1e-9 * scale {
                    return None;
                }
                matrix[a][a] = rest.sqrt();
            } else {
                matrix[a][b] = rest / matrix[b][b];
            }
        }
    }
    Some(())
}

/// Solution with that factor.
fn solved(factor: &[[f64; 6]; 6], mut right: [f64; 6], terms: usize) -> [f64; 6] {
    for a in 0..terms {
        let sum: f64 = (0..a).map(|k| factor[a][k] * right[k]).sum();
        right[a] = (right[a] - sum) / factor[a][a];
    }
    for a in (0..terms).rev() {
        let sum: f64 = (a + 1..terms).map(|k| factor[k][a] * right[k]).sum();
        right[a] = (right[a] - sum) / factor[a][a];
    }
    right
}
