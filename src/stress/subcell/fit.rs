//! A polynomial through values at cell centres, by weighted least squares.

use super::neighbours::around;
use crate::numerics::dense::{backward, cholesky, forward};

/// Cells to each side of a cell that its fit uses. Chosen by trial: over more of them p² of a small
/// contact is no polynomial, over fewer the solver's staircase is felt more.
const WINDOW: usize = 8;

/// Square of the distance, in windows, at which the weight (1.1 − r²)² of a value falls to 0: cells at
/// the window's sides still count a little.
const WEIGHT_RADIUS_SQUARED: f64 = 1.1;

/// Smallest pivot of Cholesky's factorisation, over the diagonal entry that it comes from: below it
/// the values do not determine the polynomial. Far above rounding and far below the pivots of windows
/// that are half filled.
const PIVOT_LIMIT: f64 = 1e-9;

/// Terms of a polynomial of third degree in two variables.
const TERMS: usize = 10;

/// Powers of u and of v in each term.
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

/// The square of the pressure near a cell: a polynomial in the distances u, v from the cell's centre,
/// in cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SquaredPressure([f64; TERMS]);

impl SquaredPressure {
    /// Value at (u, v); negative beyond the edge.
    pub(super) fn at(&self, u: f64, v: f64) -> f64 {
        let [c, cu, cv, cuu, cuv, cvv, cuuu, cuuv, cuvv, cvvv] = self.0;
        let along = cu + u * (cuu + u * cuuu);
        let across = cv + v * (cvv + v * cvvv);
        c + u * along + v * across + u * v * (cuv + u * cuuv + v * cuvv)
    }

    /// The polynomial plus a constant, which shifts the edge.
    pub(super) fn raised(mut self, by: f64) -> Self {
        self.0[0] += by;
        self
    }

    /// Change from the centre to a corner of a rectangle of half sides (a, b), at the slope of the
    /// cell's centre.
    pub(super) fn variation(&self, [a, b]: [f64; 2]) -> f64 {
        self.0[1].abs() * a + self.0[2].abs() * b
    }

    /// Magnitude of the gradient at the cell's centre.
    pub(super) fn slope(&self) -> f64 {
        self.0[1].hypot(self.0[2])
    }
}

/// A fitted polynomial, and how certain it is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fit {
    pub(super) polynomial: SquaredPressure,
    /// Standard deviation of the place of the edge, in cells, from the residuals of the fit.
    pub(super) uncertainty: f64,
}

/// Fewest values that a polynomial of so many terms is fitted to.
fn fewest_values(terms: usize, line: bool) -> usize {
    if line { terms + 2 } else { 2 * terms }
}

/// Whether there may be values enough around a cell for a polynomial of second degree. They are
/// counted in a square, and the fit uses a circle within it: counting is far cheaper than summing.
pub(super) fn may_be_fitted(values: &[Option<f64>], shape: [usize; 2], cell: [usize; 2]) -> bool {
    let line = shape[0] == 1;
    let terms = if line { 3 } else { 6 };
    let known = |[i, j]: &[usize; 2]| values[i * shape[1] + j].is_some();
    around(shape, cell, WINDOW).filter(known).count() >= fewest_values(terms, line)
}

/// Normal equations of the values around one cell.
pub(super) struct NormalEquations {
    line: bool,
    /// Lower triangle of the matrix.
    matrix: [[f64; TERMS]; TERMS],
    right: [f64; TERMS],
    /// Weighted sum of the squares of the values.
    values_squared: f64,
    weights: f64,
    count: usize,
}

impl NormalEquations {
    /// Sums over the known `values` of the cells around `cell`, nearer ones weighing more.
    pub(super) fn around(
        values: &[Option<f64>],
        shape: [usize; 2],
        cell @ [i, j]: [usize; 2],
    ) -> Self {
        let scale = 1.0 / WINDOW as f64;
        let mut equations = Self {
            line: shape[0] == 1,
            matrix: [[0.0; TERMS]; TERMS],
            right: [0.0; TERMS],
            values_squared: 0.0,
            weights: 0.0,
            count: 0,
        };
        for [k, l] in around(shape, cell, WINDOW) {
            let Some(value) = values[k * shape[1] + l] else {
                continue;
            };
            let u = (k as f64 - i as f64) * scale;
            let v = (l as f64 - j as f64) * scale;
            let (uu, vv) = (u * u, v * v);
            let rest = WEIGHT_RADIUS_SQUARED - (uu + vv);
            if rest > 0.0 {
                let basis = [1.0, u, v, uu, u * v, vv, u * uu, uu * v, u * vv, v * vv];
                equations.add(rest * rest, basis, value);
            }
        }
        equations
    }

    fn add(&mut self, weight: f64, basis: [f64; TERMS], value: f64) {
        for (a, row) in self.matrix.iter_mut().enumerate() {
            let along = weight * basis[a];
            for (sum, across) in row[..=a].iter_mut().zip(&basis) {
                *sum += along * across;
            }
            self.right[a] += along * value;
        }
        self.values_squared += weight * value * value;
        self.weights += weight;
        self.count += 1;
    }

    /// The polynomial of `degree` that fits best; none where there are too few values, or they do not
    /// determine it.
    pub(super) fn fit(&self, degree: u8) -> Option<Fit> {
        let used = |[a, b]: [u8; 2]| a + b <= degree && !(self.line && a > 0);
        let powers: Vec<usize> = (0..TERMS).filter(|k| used(POWERS[*k])).collect();
        let terms = powers.len();
        if self.count < fewest_values(terms, self.line) {
            return None;
        }
        let right: Vec<f64> = powers.iter().map(|row| self.right[*row]).collect();
        let factor = cholesky(terms, PIVOT_LIMIT, |a, b| self.matrix[powers[a]][powers[b]])?;
        let solution = backward(&factor, forward(&factor, right.clone()));
        let mut first = vec![0.0; terms];
        first[0] = 1.0;
        // The first entry of the inverse: the variance of the value at the centre, over that of values.
        let spread = backward(&factor, forward(&factor, first))[0];
        let product: f64 = solution.iter().zip(&right).map(|(c, r)| c * r).sum();
        let count = self.count as f64;
        let free = count / (count - terms as f64);
        let variance = ((self.values_squared - product) / self.weights * free).max(0.0);
        let mut polynomial = SquaredPressure([0.0; TERMS]);
        for (value, k) in solution.iter().zip(&powers) {
            let [a, b] = POWERS[*k];
            polynomial.0[*k] = value / (WINDOW as f64).powi(i32::from(a + b));
        }
        let deviation = (variance * spread * self.weights / count).sqrt();
        let uncertainty = deviation / polynomial.slope();
        uncertainty.is_finite().then_some(Fit {
            polynomial,
            uncertainty,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::neighbours::edge_distances;
    use super::*;

    const SHAPE: [usize; 2] = [41, 44];

    /// A polynomial is found from cells that are three cells inside of its zero and farther, and
    /// continued over it: three cells beyond those that are fitted, rounding grows by 1e4.
    #[test]
    fn polynomials_are_exact() {
        const ROUNDING: f64 = 1e-12;
        const BAND: u8 = 3;
        let ellipse = |x: f64, y: f64| 1.0 - x * x / 200.0 - y * y / 310.0 + x * y / 900.0;
        let cubic = |x: f64, y: f64| ellipse(x, y) + x.powi(3) / 3e4 - x * y * y / 5e4;
        let check = |q: &dyn Fn(f64, f64) -> f64, degree: u8| {
            let place = |cell: usize| [cell / SHAPE[1], cell % SHAPE[1]];
            let value = |cell: usize| {
                let [i, j] = place(cell);
                q(i as f64 - 20.3, j as f64 - 21.1)
            };
            let values: Vec<f64> = (0..SHAPE[0] * SHAPE[1]).map(value).collect();
            let distances = edge_distances(&values, SHAPE, BAND + 1);
            let inside = |(q, d): (&f64, &u8)| (*d >= BAND).then_some(*q);
            let known: Vec<_> = values.iter().zip(&distances).map(inside).collect();
            let mut count = 0;
            for (cell, distance) in distances.iter().enumerate() {
                if *distance == 0 || *distance > BAND {
                    continue;
                }
                let cell @ [i, j] = place(cell);
                let Some(fit) = NormalEquations::around(&known, SHAPE, cell).fit(degree) else {
                    panic!("too few values around {cell:?}")
                };
                let (x, y) = (i as f64 - 20.3, j as f64 - 21.1);
                for (u, v) in [(0.0, 0.0), (0.5, -0.5), (-1.0, 0.7)] {
                    let error = fit.polynomial.at(u, v) - q(x + u, y + v);
                    assert!(error.abs() < 1e4 * ROUNDING, "{cell:?}: {error:.1e}");
                }
                // The residual is a difference of squares.
                assert!(fit.uncertainty < 1e-5, "{cell:?}: {:.1e}", fit.uncertainty);
                count += 1;
            }
            assert!(count > 200);
        };
        check(&ellipse, 2);
        check(&cubic, 3);
    }
}
