//! Linear equations with several right sides, by elimination with row exchanges.

use ndarray::{Array2, Axis};

/// Factors L U of a matrix whose rows are exchanged.
pub(super) struct Factors {
    /// U, and L below the diagonal, on which L is 1.
    both: Array2<f64>,
    /// Row of the matrix that each row of the factors stands for.
    order: Vec<usize>,
}

/// The factors of a `matrix` that is regular.
pub(super) fn factors(mut matrix: Array2<f64>) -> Factors {
    let n = matrix.nrows();
    let mut order: Vec<usize> = (0..n).collect();
    for k in 0..n {
        let largest = (k..n).max_by(|&a, &b| matrix[[a, k]].abs().total_cmp(&matrix[[b, k]].abs()));
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
    Factors {
        both: matrix,
        order,
    }
}

/// The solution for each column of `right`.
pub(super) fn solve(factors: &Factors, right: Array2<f64>) -> Array2<f64> {
    let Factors { both, order } = factors;
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

#[cfg(test)]
mod tests {
    use ndarray::Array2;

    use super::{factors, solve};

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
        let found = solve(&factors(matrix.clone()), matrix.dot(&expected));
        for (found, expected) in found.iter().zip(&expected) {
            assert!((found - expected).abs() < 1e-11, "{found} {expected}");
        }
    }
}
