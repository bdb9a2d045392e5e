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
//! - within [`TOGETHER`] cells of where it is not taken.

use rayon::prelude::*;

/// Cells nearer to the edge than this are not fitted; those up to here are replaced.
pub(super) const BAND: u8 = 3;

/// Cells to each side that a fit looks at.
const WINDOW: usize = 8;

/// Degrees of the polynomials that are tried.
const DEGREES: [u8; 2] = [2, 3];

/// How far, in cells, all must have been fitted that are near the edge.
const TOGETHER: usize = 3;

/// Uncertainty of the place of the edge that is allowed, in cells: a root of it, times the slope, is
/// missed in the pressure there. Rough contacts are told apart by a tenth.
const SURE: f64 = 0.05;

/// Distance between the edge and the outer cells of the contact, in cells.
const NEAR: f64 = 0.6;

/// Terms of a polynomial of third degree: powers of u and of v.
const POWERS: [[u8; 2]; TERMS] = [
    [0, 0],
    [1, 0],
    [0, 1],
    [2, 0],
    [1, 1],
    [0, 2],
    [3, 0],
    [2, 1],
    [1, 2],
    [0, 3],
];

const TERMS: usize = 10;

/// A polynomial in the distances u, v from a cell's centre, in cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Square([f64; TERMS]);

impl Square {
    pub(super) fn at(&self, u: f64, v: f64) -> f64 {
        let [c, cu, cv, cuu, cuv, cvv, cuuu, cuuv, cuvv, cvvv] = self.0;
        let along = cu + u * (cuu + u * cuuu);
        let across = cv + v * (cvv + v * cvvv);
        c + u * along + v * across + u * v * (cuv + u * cuuv + v * cuvv)
    }

    pub(super) fn raised(mut self, by: f64) -> Self {
        self.0[0] += by;
        self
    }

    /// How much it changes from the centre to the corners of a piece of half sides (a, b), at the
    /// slope of the cell's centre.
    pub(super) fn varies(&self, [a, b]: [f64; 2]) -> f64 {
        self.0[1].abs() * a + self.0[2].abs() * b
    }

    /// Its slope at the centre.
    pub(super) fn slope(&self) -> f64 {
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
    let beside =
        |i: usize, j: usize| around(shape, [i, j], 1).any(|[i, j]| distances[i * ny + j] > 0);
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
    // Where a fit is sure among others that are not, it is so by chance.
    let known = |cell: [usize; 2]| !around(shape, cell, TOGETHER).any(|[i, j]| refused[i * ny + j]);
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
    let samples = Samples::around(squares, shape, cell);
    let fits = DEGREES.into_iter().filter_map(|degree| samples.fit(degree));
    let (square, uncertain) = fits.reduce(|a, b| if b.1 < a.1 { b } else { a })?;
    let place = square.0[0] / square.slope();
    let agrees = if pressure[i * shape[1] + j] > 0.0 {
        place > -NEAR
    } else {
        place < NEAR
    };
    (uncertain <= SURE && agrees).then_some(square)
}

/// Sums over the cells around one, nearer ones counting more, for least squares.
struct Samples {
    line: bool,
    normal: [[f64; TERMS]; TERMS],
    right: [f64; TERMS],
    squares: f64,
    weights: f64,
    count: usize,
}

impl Samples {
    fn around(squares: &[Option<f64>], shape: [usize; 2], cell @ [i, j]: [usize; 2]) -> Self {
        let scale = 1.0 / WINDOW as f64;
        let mut samples = Self {
            line: shape[0] == 1,
            normal: [[0.0; TERMS]; TERMS],
            right: [0.0; TERMS],
            squares: 0.0,
            weights: 0.0,
            count: 0,
        };
        for [k, l] in around(shape, cell, WINDOW) {
            let Some(square) = squares[k * shape[1] + l] else {
                continue;
            };
            let u = (k as f64 - i as f64) * scale;
            let v = (l as f64 - j as f64) * scale;
            let (uu, vv) = (u * u, v * v);
            let rest = 1.1 - (uu + vv);
            if rest > 0.0 {
                let basis = [1.0, u, v, uu, u * v, vv, u * uu, uu * v, u * vv, v * vv];
                samples.add(rest * rest, basis, square);
            }
        }
        samples
    }

    fn add(&mut self, weight: f64, basis: [f64; TERMS], square: f64) {
        for (a, row) in self.normal.iter_mut().enumerate() {
            let along = weight * basis[a];
            for (sum, across) in row[..=a].iter_mut().zip(&basis) {
                *sum += along * across;
            }
            self.right[a] += along * square;
        }
        self.squares += weight * square * square;
        self.weights += weight;
        self.count += 1;
    }

    /// The polynomial of some degree that fits best, and how uncertain the edge is by it, in cells;
    /// none where there are too few cells.
    fn fit(&self, degree: u8) -> Option<(Square, f64)> {
        let used = |[a, b]: [u8; 2]| a + b <= degree && !(self.line && a > 0);
        let powers: Vec<usize> = (0..TERMS).filter(|k| used(POWERS[*k])).collect();
        let terms = powers.len();
        if self.count < if self.line { terms + 2 } else { 2 * terms } {
            return None;
        }
        let (mut normal, mut right) = ([[0.0; TERMS]; TERMS], [0.0; TERMS]);
        for (a, row) in powers.iter().enumerate() {
            for (b, column) in powers[..=a].iter().enumerate() {
                normal[a][b] = self.normal[*row][*column];
            }
            right[a] = self.right[*row];
        }
        cholesky(&mut normal, terms)?;
        let solution = solved(&normal, right, terms);
        let mut first = [0.0; TERMS];
        first[0] = 1.0;
        let spread = solved(&normal, first, terms)[0];
        let product: f64 = solution.iter().zip(&right).map(|(c, r)| c * r).sum();
        let count = self.count as f64;
        let free = count / (count - terms as f64);
        let variance = ((self.squares - product) / self.weights * free).max(0.0);
        let mut square = Square([0.0; TERMS]);
        for (value, k) in solution.iter().zip(&powers) {
            let [a, b] = POWERS[*k];
            square.0[*k] = value / (WINDOW as f64).powi(i32::from(a + b));
        }
        let uncertain = (variance * spread * self.weights / count).sqrt() / square.slope();
        uncertain.is_finite().then_some((square, uncertain))
    }
}

/// The factor of Cholesky in the lower triangle, in place; none where a pivot is lost.
fn cholesky(matrix: &mut [[f64; TERMS]; TERMS], terms: usize) -> Option<()> {
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
fn solved(factor: &[[f64; TERMS]; TERMS], mut right: [f64; TERMS], terms: usize) -> [f64; TERMS] {
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

#[cfg(test)]
mod tests {
    use super::*;

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
    fn edges_are_known_where_they_are_smooth() {
        let hertz = field(|x, y| (1.0 - (x * x + y * y) / 225.0).max(0.0).sqrt());
        let found = |pressure: &[f64]| {
            let distances = distances(pressure, SHAPE, BAND + 1);
            edge_cells(pressure, &distances, SHAPE)
        };
        let edges = found(&hertz);
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
        assert!(found(&rough).is_empty());
        let punch: Vec<f64> = hertz
            .iter()
            .map(|p| if *p > 0.0 { 1.0 / p } else { 0.0 })
            .collect();
        assert!(found(&punch).is_empty());
    }
}
