//! Small dense systems: Cholesky's factors, elimination without row exchanges, and with them.

use ndarray::{Array2, Axis};

use crate::numerics::parallel::dot;

/// Cholesky factor L of K = L Lᵀ, by rows up to the diagonal; `None` where a pivot is not above
/// `smallest` times the diagonal entry that it comes from. Golub & Van Loan, Matrix Computations, 4th ed.
/// (2013), §4.2.
pub(crate) fn cholesky(
    cells: usize,
    smallest: f64,
    matrix: impl Fn(usize, usize) -> f64,
) -> Option<Vec<Vec<f64>>> {
    let mut lower: Vec<Vec<f64>> = Vec::with_capacity(cells);
    for a in 0..cells {
        let mut row = Vec::with_capacity(a + 1);
        for (b, above) in lower.iter().enumerate() {
            row.push((matrix(a, b) - dot(&row, &above[..b])) / above[b]);
        }
        let diagonal = matrix(a, a);
        let pivot = diagonal - dot(&row, &row);
        if pivot.is_nan() || pivot <= smallest * diagonal {
            return None;
        }
        row.push(pivot.sqrt());
        lower.push(row);
    }
    Some(lower)
}

/// L⁻¹v
pub(crate) fn forward(lower: &[Vec<f64>], mut v: Vec<f64>) -> Vec<f64> {
    for (a, row) in lower.iter().enumerate() {
        v[a] = (v[a] - dot(&row[..a], &v[..a])) / row[a];
    }
    v
}

/// L⁻ᵀv
pub(crate) fn backward(lower: &[Vec<f64>], mut v: Vec<f64>) -> Vec<f64> {
    for (a, row) in lower.iter().enumerate().rev() {
        v[a] /= row[a];
        let known = v[a];
        for (v, entry) in v.iter_mut().zip(&row[..a]) {
            *v -= entry * known;
        }
    }
    v
}

/// Replaces `right` by the solution of a system near a symmetric and positive one, by elimination without
/// row exchanges. Unknowns that are not `used`, given their number and pivot, and those that the ones
/// before determine are 0.
pub(crate) fn eliminate<R: AsRef<[f64]> + AsMut<[f64]>>(
    matrix: &mut [R],
    right: &mut [f64],
    used: impl Fn(usize, f64) -> bool,
) {
    // A pivot below this part of its diagonal is rounding: 450 ε.
    const SMALLEST_PIVOT: f64 = 1e-13;
    let n = right.len();
    let diagonal: Vec<f64> = (0..n).map(|k| matrix[k].as_ref()[k].abs()).collect();
    let mut pivots = vec![0.0; n];
    for k in 0..n {
        let (above, below) = matrix.split_at_mut(k + 1);
        let row = above[k].as_ref();
        if !used(k, row[k]) || row[k].abs() <= SMALLEST_PIVOT * diagonal[k] || row[k] == 0.0 {
            continue;
        }
        pivots[k] = row[k];
        for (other, l) in below.iter_mut().zip(k + 1..) {
            let other = other.as_mut();
            let factor = other[k] / row[k];
            let entries = other.iter_mut().zip(row).skip(k);
            entries.for_each(|(entry, above)| *entry -= factor * above);
            right[l] -= factor * right[k];
        }
    }
    for k in (0..n).rev() {
        let row = matrix[k].as_ref();
        let known: f64 = (k + 1..n).map(|l| row[l] * right[l]).sum();
        right[k] = match pivots[k] {
            0.0 => 0.0,
            pivot => (right[k] - known) / pivot,
        };
    }
}

/// Factors L U of a matrix whose rows are exchanged.
#[derive(Debug)]
pub(crate) struct Factors {
    /// U, and L below the diagonal, on which L is 1.
    both: Array2<f64>,
    /// Row of the matrix that each row of the factors stands for.
    order: Vec<usize>,
}

impl Factors {
    /// The factors of a `matrix` that is regular, by elimination with row exchanges.
    pub(crate) fn new(mut matrix: Array2<f64>) -> Self {
        let n = matrix.nrows();
        let mut order: Vec<usize> = (0..n).collect();
        for k in 0..n {
            let largest =
                (k..n).max_by(|&a, &b| matrix[[a, k]].abs().total_cmp(&matrix[[b, k]].abs()));
            let pivot = largest.unwrap_or(k);
            if pivot != k {
                order.swap(k, pivot);
                for column in 0..n {
                    matrix.swap([k, column], [pivot, column]);
                }
            }
            let (above, mut below) = matrix.view_mut().split_at(Axis(0), k + 1);
            let row = above.row(k);
            for mut other in below.rows_mut() {
                other[k] /= row[k];
                let factor = other[k];
                let rest = other.iter_mut().zip(row).skip(k + 1);
                rest.for_each(|(other, entry)| *other -= factor * entry);
            }
        }
        Self { both: matrix, order }
    }

    /// The solution for each column of `right`.
    pub(crate) fn solve(&self, right: Array2<f64>) -> Array2<f64> {
        let Self { both, order } = self;
        let mut solution = right.select(Axis(0), order);
        let n = both.nrows();
        for i in 0..n {
            let (done, mut rest) = solution.view_mut().split_at(Axis(0), i);
            let mut row = rest.row_mut(0);
            for (k, known) in done.rows().into_iter().enumerate() {
                row.scaled_add(-both[[i, k]], &known);
            }
        }
        for i in (0..n).rev() {
            let (mut rest, done) = solution.view_mut().split_at(Axis(0), i + 1);
            let mut row = rest.row_mut(i);
            for (k, known) in done.rows().into_iter().enumerate() {
                row.scaled_add(-both[[i, i + 1 + k]], &known);
            }
            row /= both[[i, i]];
        }
        solution
    }
}

#[cfg(test)]
mod tests {
    use ndarray::Array2;

    use super::{Factors, backward, cholesky, eliminate, forward};

    const CELLS: usize = 17;

    /// Numbers between −1 and 1 in no order.
    fn number(k: usize) -> f64 {
        ((k * k + 3 * k + 1) as f64 * 12.9898).sin()
    }

    /// A = GᵀG + I, symmetric and positive definite.
    fn matrix(a: usize, b: usize) -> f64 {
        let product = |k: usize| number(CELLS * k + a) * number(CELLS * k + b);
        (0..CELLS).map(product).sum::<f64>() + f64::from(u8::from(a == b))
    }

    /// L Lᵀ = A, and L⁻¹, L⁻ᵀ undo the products; the solution of A x = v follows. Rounding is less than
    /// 17 · 2e-16 times the condition of A, some hundred.
    #[test]
    fn factors_and_triangular_solves() {
        let lower = cholesky(CELLS, 0.0, matrix).expect("positive definite");
        let entry = |a: usize, b: usize| lower[a].get(b).copied().unwrap_or(0.0);
        for (a, row) in lower.iter().enumerate() {
            assert_eq!(row.len(), a + 1);
            for b in 0..CELLS {
                let product: f64 = (0..CELLS).map(|k| entry(a, k) * entry(b, k)).sum();
                assert!((product - matrix(a, b)).abs() < 1e-13, "{a} {b}");
            }
        }
        let x: Vec<f64> = (0..CELLS).map(|k| number(1000 + k)).collect();
        let times = |f: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
            let row = |a: usize| (0..CELLS).map(|b| f(a, b) * x[b]).sum();
            (0..CELLS).map(row).collect()
        };
        for (name, solution) in [
            ("L", forward(&lower, times(&entry))),
            ("Lᵀ", backward(&lower, times(&|a, b| entry(b, a)))),
            ("A", backward(&lower, forward(&lower, times(&matrix)))),
        ] {
            for (value, x) in solution.iter().zip(&x) {
                assert!((value - x).abs() < 1e-12, "{name}: {value} {x}");
            }
        }
    }

    /// Where a pivot is 0, negative or no number, there are no factors.
    #[test]
    fn indefinite_matrices_are_refused() {
        assert!(cholesky(2, 0.0, |a, b| if a == b { 1.0 } else { 2.0 }).is_none());
        assert!(cholesky(2, 0.0, |_, _| 1.0).is_none());
        assert!(cholesky(1, 0.0, |_, _| f64::NAN).is_none());
        assert!(
            cholesky(CELLS, 0.0, |a, b| matrix(a, b) - if a == b { 9.0 } else { 0.0 }).is_none()
        );
        let diagonal = cholesky(2, 0.0, |a, b| if a == b { 4.0 } else { 0.0 });
        assert_eq!(diagonal, Some(vec![vec![2.0], vec![0.0, 2.0]]));
    }

    /// Solutions satisfy their equations, to rounding, also where the first pivot is 0.
    #[test]
    fn solutions_satisfy_their_equations() {
        let n = 13;
        let entry = |(i, j): (usize, usize)| match (i, j) {
            (0, 0) => 0.0,
            _ => ((i * i + 3 * j + i * j) as f64 * 12.9898).sin(),
        };
        let matrix = Array2::from_shape_fn((n, n), entry);
        let expected = Array2::from_shape_fn((n, 3), |(i, j)| (i as f64 - 4.0) * (j + 1) as f64);
        let solution = Factors::new(matrix.clone()).solve(matrix.dot(&expected));
        for (value, expected) in solution.iter().zip(&expected) {
            assert!((value - expected).abs() < 1e-11, "{value} {expected}");
        }
    }

    /// An unknown that is not used, and one that the others determine, stay 0; the others solve the rest.
    #[test]
    fn elimination_leaves_out_what_is_determined() {
        let b = [[1.0, 0.0, 2.0, 2.0], [1.0, 1.0, 1.0, 1.0], [1.0, 2.0, -1.0, -1.0]];
        let gram = |a: usize, c: usize| b.iter().map(|row: &[f64; 4]| row[a] * row[c]).sum::<f64>();
        let mut matrix = [0, 1, 2, 3].map(|a| [0, 1, 2, 3].map(|c| gram(a, c)));
        let mut x = [0, 1, 2, 3].map(|a| gram(a, 1) + 2.0 * gram(a, 2));
        eliminate(&mut matrix, &mut x, |_, _| true);
        let mut left_out = [0, 1, 2, 3].map(|a| vec![gram(a, 0), 1.0, gram(a, 2), gram(a, 3)]);
        let mut y = [0, 1, 2, 3].map(|a| 3.0 * gram(a, 0));
        eliminate(&mut left_out, &mut y, |k, _| k != 1);
        for (value, expected) in
            x.iter().zip([0.0, 1.0, 2.0, 0.0]).chain(y.iter().zip([3.0, 0.0, 0.0, 0.0]))
        {
            assert!((value - expected).abs() < 1e-12, "{x:?} {y:?}");
        }
    }
}
