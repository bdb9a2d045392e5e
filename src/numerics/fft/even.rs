//! Spectra of even kernels and of their inverses.

use ndarray::ArrayRef2;
use rustfft::num_complex::Complex64;

use super::{BLOCK, EvenSpectrum, PaddedTransform, Scratch, Workspace, ZERO};
use crate::numerics::parallel::Threads;

impl PaddedTransform {
    /// Spectrum of the even kernel with the values `quarter` (nx, ny) at offsets (i, j) ≥ 0. On a
    /// periodic mesh, only offsets of up to half a period count.
    pub(crate) fn even_spectrum(
        &self,
        quarter: &ArrayRef2<f64>,
        workspace: &mut Workspace,
        threads: &Threads,
    ) -> EvenSpectrum {
        let ([nx, _], [mx, my]) = (self.shape, self.padded);
        let (columns, quarter_rows) = (self.columns(), self.quarter_rows());
        let Workspace { mesh, scratches } = workspace;
        let rows = &mut mesh.as_flattened_mut()[..nx * columns];
        let scale = 1.0 / (mx as f64 * my as f64);
        let forward = |first: usize, rows: &mut [Complex64], scratch: &mut Scratch| {
            for (row, spectrum) in rows.chunks_exact_mut(columns).enumerate() {
                let real = &mut scratch.real[..my];
                real.fill(0.0);
                for (j, &c) in quarter.row(first + row).iter().take(columns).enumerate() {
                    real[j] = c;
                    real[(my - j) % my] = c;
                }
                self.rows_to_spectrum(real, spectrum, &mut scratch.fft);
            }
        };
        self.over_items(threads, rows, columns, scratches, forward);
        let mut spectrum = vec![0.0; self.blocks() * quarter_rows * BLOCK];
        let rows = &*rows;
        let transform = |first: usize, blocks: &mut [f64], scratch: &mut Scratch| {
            for (block, values) in blocks.chunks_exact_mut(quarter_rows * BLOCK).enumerate() {
                let start = (first + block) * BLOCK;
                let width = BLOCK.min(columns - start);
                scratch.columns[..width * mx].fill(ZERO);
                for i in 0..nx.min(quarter_rows) {
                    for b in 0..width {
                        let value = Complex64::new(rows[i * columns + start + b].re, 0.0);
                        scratch.columns[b * mx + i] = value;
                        scratch.columns[b * mx + (mx - i) % mx] = value;
                    }
                }
                let columns = &mut scratch.columns[..width * mx];
                self.column_forward
                    .process_with_scratch(columns, &mut scratch.fft);
                for k in 0..quarter_rows {
                    for b in 0..width {
                        values[k * BLOCK + b] = columns[b * mx + k].re * scale;
                    }
                }
            }
        };
        let size = quarter_rows * BLOCK;
        self.over_items(threads, &mut spectrum, size, scratches, transform);
        EvenSpectrum(spectrum)
    }

    /// Smallest and largest entry of `spectrum`.
    pub(crate) fn extremes(&self, spectrum: &EvenSpectrum) -> [f64; 2] {
        let (columns, rows) = (self.columns(), self.quarter_rows());
        let mut extremes = [f64::INFINITY, f64::NEG_INFINITY];
        for (block, values) in spectrum.0.chunks_exact(rows * BLOCK).enumerate() {
            // The last block may have columns that are not used.
            let width = BLOCK.min(columns - block * BLOCK);
            for row in values.chunks_exact(BLOCK) {
                for &c in &row[..width] {
                    extremes = [extremes[0].min(c), extremes[1].max(c)];
                }
            }
        }
        extremes
    }

    /// Spectrum of the inverse kernel. Entries of `spectrum` below `bound` are raised to it, so that the
    /// inverse is positive and finite.
    pub(crate) fn inverse_spectrum(&self, spectrum: &EvenSpectrum, bound: f64) -> EvenSpectrum {
        let points = self.padded[0] as f64 * self.padded[1] as f64;
        let inverse = |c: &f64| 1.0 / (c.max(bound) * points * points);
        let values = spectrum.0.iter().map(inverse).collect();
        EvenSpectrum(values)
    }
}
