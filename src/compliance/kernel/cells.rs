//! Kernels of cells at all offsets of a grid.
//!
//! Far off, at R = √(r² + z²) ≫ dx, dy, the mean over a cell is that of the kernel's values at the
//! centres of cells around it,
//!
//! ```text
//! K̄ = K + (δ_x² + δ_y²) K / 24          δ² the second difference
//! ```
//!
//! Its error, 17/5760 δ⁴ K, is below 1e-7 of K from [`FAR`] cells on, and 1e-8 of the pressure in a sum
//! over any number of cells. Nearer, the kernel is integrated ([`super::plane`]).

use std::ops::Range;

use super::COMPONENTS;
use crate::numerics::fft::Keep;

/// Distance, in longer sides of a cell, from which differences are used.
pub(crate) const FAR: f64 = 60.0;

/// CellSource of the coefficients of C components.
pub(crate) struct CellSource<M, P, const C: usize> {
    /// Numbers of offsets along x and y.
    pub(crate) offsets: [usize; 2],
    pub(crate) spacing: [f64; 2],
    pub(crate) depth: f64,
    /// Whether row i is at i + ½ cells along x: its offsets lead to the line between two rows.
    pub(crate) between: bool,
    /// Whether each component is odd in x and in y.
    pub(crate) odd: [[bool; 2]; C],
    /// Mean over a cell at an offset, times its area.
    pub(crate) mean: M,
    /// Value at a point that is far.
    pub(crate) point: P,
}

/// Components at (x, y).
pub(crate) trait ComponentsAt: Fn(f64, f64) -> [f64; COMPONENTS] + Sync {}

impl<F: Fn(f64, f64) -> [f64; COMPONENTS] + Sync> ComponentsAt for F {}

impl<M: ComponentsAt, P: ComponentsAt, const C: usize> CellSource<M, P, C> {
    /// Gives `keep` the coefficients of `rows`.
    pub(crate) fn rows(&self, rows: Range<usize>, keep: &mut Keep) {
        let ny = self.offsets[1];
        let width = ny + 1;
        let memory = || vec![0.0; C * width];
        let (mut before, mut here, mut after) = (memory(), memory(), memory());
        let mut means = vec![0.0; C * ny];
        self.points(rows.start, &mut here);
        match rows.start {
            // The row before the first mirrors the row after it or, between rows, the first.
            0 => {
                self.points(usize::from(!self.between), &mut before);
                for (row, [odd, _]) in before.chunks_exact_mut(width).zip(self.odd) {
                    if odd {
                        row.iter_mut().for_each(|value| *value = -*value);
                    }
                }
            }
            first => self.points(first - 1, &mut before),
        }
        for i in rows {
            self.points(i + 1, &mut after);
            self.means(i, [&before, &here, &after], &mut means);
            for (k, row) in means.chunks_exact(ny).enumerate() {
                keep(i, k, row);
            }
            std::mem::swap(&mut before, &mut here);
            std::mem::swap(&mut here, &mut after);
        }
    }

    /// Offset of row i along x.
    fn along_x(&self, i: usize) -> f64 {
        let half = if self.between { 0.5 } else { 0.0 };
        (i as f64 + half) * self.spacing[0]
    }

    /// The first offset in row i that is far.
    fn first(&self, i: usize) -> usize {
        let [dx, dy] = self.spacing;
        let far = FAR * dx.max(dy);
        let rest = far * far - self.depth * self.depth - (i as f64 * dx).powi(2);
        if rest <= 0.0 { 0 } else { ((rest.sqrt() / dy).ceil() as usize).min(self.offsets[1]) }
    }

    /// Computes the values at the points of row i that differences need, one component after another.
    fn points(&self, i: usize, row: &mut [f64]) {
        let width = self.offsets[1] + 1;
        let [_, dy] = self.spacing;
        let start = self.first(i + 1).min(self.first(i).saturating_sub(1));
        let x = self.along_x(i);
        for j in start..width {
            let values = (self.point)(x, j as f64 * dy);
            for k in 0..C {
                row[k * width + j] = values[k];
            }
        }
    }

    /// Computes the coefficients of row i, from the points of three rows.
    fn means(&self, i: usize, [before, here, after]: [&[f64]; 3], means: &mut [f64]) {
        let ny = self.offsets[1];
        let width = ny + 1;
        let [dx, dy] = self.spacing;
        let area = dx * dy;
        let start = self.first(i);
        for j in 0..start {
            let values = (self.mean)(self.along_x(i), j as f64 * dy);
            for k in 0..C {
                means[k * ny + j] = values[k];
            }
        }
        if start == ny {
            return;
        }
        // K + (Σ − 4 K)/24, with the sum Σ over the neighbours.
        let (of_sum, of_here) = (area / 24.0, area * 20.0 / 24.0);
        for (k, out) in means.chunks_exact_mut(ny).enumerate() {
            let [before, here, after] =
                [before, here, after].map(|row| &row[k * width..(k + 1) * width]);
            let begin = start.max(1);
            if start == 0 {
                let left = if self.odd[k][1] { -here[1] } else { here[1] };
                let sum = before[0] + after[0] + left + here[1];
                out[0] = of_here * here[0] + of_sum * sum;
            }
            let across = before[begin..ny].iter().zip(&after[begin..ny]);
            let along = here[begin - 1..ny - 1].iter().zip(&here[begin + 1..]);
            let middle = out[begin..].iter_mut().zip(&here[begin..ny]);
            for (((out, here), (a, b)), (c, d)) in middle.zip(across).zip(along) {
                *out = of_here * here + of_sum * ((a + b) + (c + d));
            }
        }
    }
}
