//! Dense symmetric systems, by Cholesky's factors.

use crate::numerics::parallel::dot;

/// Cholesky factor L of K = L Lᵀ, by rows up to the diagonal; `None` where a pivot is not positive.
pub(crate) fn cholesky(
    cells: usize,
    matrix: impl Fn(usize, usize) -> f64,
) -> Option<Vec<Vec<f64>>> {
    let mut lower: Vec<Vec<f64>> = Vec::with_capacity(cells);
    for a in 0..cells {
        let mut row = Vec::with_capacity(a + 1);
        for (b, above) in lower.iter().enumerate() {
            row.push((matrix(a, b) - dot(&row, &above[..b])) / above[b]);
        }
        let pivot = matrix(a, a) - dot(&row, &row);
        if pivot.is_nan() || pivot <= 0.0 {
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

#[cfg(test)]
mod tests {
    use super::{backward, cholesky, forward};

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
        let lower = cholesky(CELLS, matrix).expect("positive definite");
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
        for (name, found) in [
            ("L", forward(&lower, times(&entry))),
            ("Lᵀ", backward(&lower, times(&|a, b| entry(b, a)))),
            ("A", backward(&lower, forward(&lower, times(&matrix)))),
        ] {
            for (found, x) in found.iter().zip(&x) {
                assert!((found - x).abs() < 1e-12, "{name}: {found} {x}");
            }
        }
    }

    /// Where a pivot is 0, negative or no number, there are no factors.
    #[test]
    fn indefinite_matrices_are_refused() {
        assert!(cholesky(2, |a, b| if a == b { 1.0 } else { 2.0 }).is_none());
        assert!(cholesky(2, |_, _| 1.0).is_none());
        assert!(cholesky(1, |_, _| f64::NAN).is_none());
        assert!(cholesky(CELLS, |a, b| matrix(a, b) - if a == b { 9.0 } else { 0.0 }).is_none());
        let diagonal = cholesky(2, |a, b| if a == b { 4.0 } else { 0.0 });
        assert_eq!(diagonal, Some(vec![vec![2.0], vec![0.0, 2.0]]));
    }
}
