//! A polynomial through values at the centres of cells, by least squares.

use super::edge::around;

/// Cells to each side that a fit looks at: over more of them p² of a small contact is no polynomial,
/// over fewer the solver's staircase is felt more. Chosen by trial.
pub(super) const WINDOW: usize = 8;

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

/// The fewest values that a polynomial of so many terms is fitted to.
fn fewest(terms: usize, line: bool) -> usize {
    if line { terms + 2 } else { 2 * terms }
}

/// Whether there may be values enough around a cell for a polynomial of second degree: they are
/// counted in a square, of which the fit takes a circle. To count is far cheaper than to sum.
pub(super) fn may_fit(squares: &[Option<f64>], shape: [usize; 2], cell: [usize; 2]) -> bool {
    let line = shape[0] == 1;
    let terms = if line { 3 } else { 6 };
    let known = |[i, j]: &[usize; 2]| squares[i * shape[1] + j].is_some();
    around(shape, cell, WINDOW).filter(known).count() >= fewest(terms, line)
}

/// Sums over the cells around one, nearer ones counting more, for least squares.
pub(super) struct Samples {
    line: bool,
    normal: [[f64; TERMS]; TERMS],
    right: [f64; TERMS],
    squares: f64,
    weights: f64,
    count: usize,
}

impl Samples {
    pub(super) fn around(
        squares: &[Option<f64>],
        shape: [usize; 2],
        cell @ [i, j]: [usize; 2],
    ) -> Self {
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
    pub(super) fn fit(&self, degree: u8) -> Option<(Square, f64)> {
        let used = |[a, b]: [u8; 2]| a + b <= degree && !(self.line && a > 0);
        let powers: Vec<usize> = (0..TERMS).filter(|k| used(POWERS[*k])).collect();
        let terms = powers.len();
        if self.count < fewest(terms, self.line) {
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
