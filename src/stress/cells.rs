//! Influence coefficients at all offsets of a grid.
//!
//! Far off, at R = √(r² + z²) ≫ dx, dy, the mean over a cell is that of the kernel's values at the
//! centres of cells around it,
//!
//! ```text
//! K̄ = K + (δ_x² + δ_y²) K / 24          δ² the second difference
//! ```
//!
//! of which the error, 17/5760 δ⁴ K, is below 1e-7 of K from [`FAR`] cells on, and 1e-8 of the
//! pressure in a sum over any number of cells. Nearer it is integrated ([`super::kernel`]).

use rayon::prelude::*;

use super::components::{COMPONENTS, ODD};

/// Distance, in longer sides of a cell, from which differences are used.
const FAR: f64 = 60.0;

/// Coefficients at offsets (i, j) ≥ 0: in each row i, the components one after another.
#[derive(Debug)]
pub(super) struct Cells {
    shape: [usize; 2],
    /// How many components are kept.
    count: usize,
    values: Vec<f64>,
    /// Values at centres, one row and one column more.
    points: Vec<f64>,
}

/// What makes coefficients.
pub(super) struct Source<M, P> {
    pub(super) spacing: [f64; 2],
    pub(super) depth: f64,
    /// Whether parities of the components are turned, in x and in y.
    pub(super) flipped: [bool; 2],
    /// Mean over a cell at an offset.
    pub(super) mean: M,
    /// Value at a point.
    pub(super) point: P,
}

impl Cells {
    pub(super) fn new([nx, ny]: [usize; 2], count: usize) -> Self {
        Self {
            shape: [nx, ny],
            count,
            values: vec![0.0; nx * ny * count],
            points: vec![0.0; (nx + 1) * (ny + 1) * count],
        }
    }

    /// Component `k` in row i.
    pub(super) fn row(&self, i: usize, k: usize) -> &[f64] {
        let ny = self.shape[1];
        let start = (i * self.count + k) * ny;
        &self.values[start..start + ny]
    }

    /// Coefficients from given values, of line contact.
    pub(super) fn fill_line(&mut self, values: &[[f64; COMPONENTS]]) {
        for (k, row) in self.values.chunks_exact_mut(self.shape[1]).enumerate() {
            row.iter_mut().zip(values).for_each(|(c, v)| *c = v[k]);
        }
    }

    /// Computes all, on the threads of the caller.
    pub(super) fn fill<M, P>(&mut self, source: &Source<M, P>)
    where
        M: Fn(f64, f64) -> [f64; COMPONENTS] + Sync,
        P: Fn(f64, f64) -> [f64; COMPONENTS] + Sync,
    {
        let ([_, ny], [dx, dy], count) = (self.shape, source.spacing, self.count);
        let far = FAR * dx.max(dy);
        // The first offset in a row that is far.
        let first = |i: usize| {
            let rest = far * far - source.depth * source.depth - (i as f64 * dx).powi(2);
            if rest <= 0.0 {
                0
            } else {
                ((rest.sqrt() / dy).ceil() as usize).min(ny)
            }
        };
        let width = ny + 1;
        self.points
            .par_chunks_exact_mut(count * width)
            .enumerate()
            .for_each(|(i, row)| {
                let start = first(i + 1).min(first(i).saturating_sub(1));
                for j in start..width {
                    let values = (source.point)(i as f64 * dx, j as f64 * dy);
                    for (k, value) in values[..count].iter().enumerate() {
                        row[k * width + j] = *value;
                    }
                }
            });
        let points = &self.points;
        let area = dx * dy;
        self.values
            .par_chunks_exact_mut(count * ny)
            .enumerate()
            .for_each(|(i, row)| {
                let start = first(i);
                for j in 0..start {
                    let values = (source.mean)(i as f64 * dx, j as f64 * dy);
                    for (k, value) in values[..count].iter().enumerate() {
                        row[k * ny + j] = *value;
                    }
                }
                if start == ny {
                    return;
                }
                for (k, out) in row.chunks_exact_mut(ny).enumerate() {
                    let [odd_x, odd_y] = [0, 1].map(|axis| ODD[k][axis] != source.flipped[axis]);
                    let line = |i: usize| {
                        let start = (i * count + k) * width;
                        &points[start..start + width]
                    };
                    let (mirror, before) = match i {
                        0 => (if odd_x { -1.0 } else { 1.0 }, line(1)),
                        _ => (1.0, line(i - 1)),
                    };
                    let (here, after) = (line(i), line(i + 1));
                    let mean = |j: usize, left: f64| {
                        let sum = mirror * before[j] + after[j] + left + here[j + 1];
                        area * (here[j] + (sum - 4.0 * here[j]) / 24.0)
                    };
                    let begin = if start == 0 {
                        out[0] = mean(0, if odd_y { -here[1] } else { here[1] });
                        1
                    } else {
                        start
                    };
                    let windows = here[begin - 1..].windows(3);
                    let across = before[begin..].iter().zip(&after[begin..]);
                    for ((c, near), (b, a)) in out[begin..].iter_mut().zip(windows).zip(across) {
                        let sum = mirror * b + a + near[0] + near[2];
                        *c = area * (near[1] + (sum - 4.0 * near[1]) / 24.0);
                    }
                }
            });
    }
}
