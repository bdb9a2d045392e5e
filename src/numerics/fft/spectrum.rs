//! Spectra of kernels that are even or odd along x and along y, and of inverses.

use ndarray::ArrayRef2;
use rustfft::num_complex::Complex64;

use super::{BLOCK, PaddedTransform, Scratch, TransformMemory, ZERO};
use crate::numerics::parallel::Threads;

/// The transform of a kernel that is even along x and along y, scaled by 1/(mx my). It is real and
/// even, so that only a quarter is stored, by blocks of columns.
#[derive(Debug)]
pub(crate) struct EvenSpectrum(pub(super) Vec<f64>);

/// Spectrum of a kernel that is even or odd along each direction, scaled by 1/(mx my), less the factor i for each
/// direction in which it is odd. A quarter is stored, column by column.
#[derive(Debug)]
pub(crate) struct ParitySpectrum {
    pub(super) values: Vec<f64>,
    pub(super) odd: [bool; 2],
}

impl PaddedTransform {
    /// Spectrum of the even kernel with the values `quarter` (nx, ny) at offsets (i, j) ≥ 0. On a
    /// periodic mesh, only offsets of up to half a period count.
    pub(crate) fn even_spectrum(
        &self,
        quarter: &ArrayRef2<f64>,
        workspace: &mut TransformMemory,
        threads: &Threads,
    ) -> EvenSpectrum {
        let strides = [1, BLOCK];
        EvenSpectrum(self.quarter_spectrum(quarter, [false; 2], strides, workspace, threads))
    }

    /// Spectrum of the kernel with the values `quarter` (nx, ny) at offsets (i, j) ≥ 0, which is `odd` along x and
    /// along y or not.
    pub(crate) fn parity_spectrum(
        &self,
        quarter: &ArrayRef2<f64>,
        odd: [bool; 2],
        workspace: &mut TransformMemory,
        threads: &Threads,
    ) -> ParitySpectrum {
        let strides = [self.quarter_rows(), 1];
        let values = self.quarter_spectrum(quarter, odd, strides, workspace, threads);
        ParitySpectrum { values, odd }
    }

    /// The quarter of a spectrum less the factors i, by blocks of columns. In a block, columns and rows are so many entries
    /// apart.
    fn quarter_spectrum(
        &self,
        quarter: &ArrayRef2<f64>,
        odd: [bool; 2],
        [next_column, next_row]: [usize; 2],
        workspace: &mut TransformMemory,
        threads: &Threads,
    ) -> Vec<f64> {
        let ([nx, _], [mx, my]) = (self.shape, self.padded);
        let (columns, quarter_rows) = (self.columns(), self.quarter_rows());
        let TransformMemory { mesh, scratches } = workspace;
        let rows = &mut mesh.as_flattened_mut()[..nx * columns];
        let [sign_x, sign_y] = odd.map(|odd| if odd { -1.0 } else { 1.0 });
        let part = |value: Complex64, odd: bool| if odd { value.im } else { value.re };
        let forward = |first: usize, rows: &mut [Complex64], scratch: &mut Scratch| {
            for (row, spectrum) in rows.chunks_exact_mut(columns).enumerate() {
                let real = &mut scratch.real[..my];
                real.fill(0.0);
                for (j, &c) in quarter.row(first + row).iter().take(columns).enumerate() {
                    real[(my - j) % my] = sign_y * c;
                    real[j] = c;
                }
                self.rows_to_spectrum(real, spectrum, &mut scratch.fft);
            }
        };
        self.over_items(threads, rows, columns, scratches, forward);
        let rows = &*rows;
        let scale = 1.0 / self.points();
        let size = quarter_rows * BLOCK;
        let mut spectrum = vec![0.0; self.blocks() * size];
        let transform = |first: usize, blocks: &mut [f64], scratch: &mut Scratch| {
            for (block, values) in blocks.chunks_exact_mut(size).enumerate() {
                let start = (first + block) * BLOCK;
                let width = BLOCK.min(columns - start);
                let block_columns = &mut scratch.columns[..width * mx];
                block_columns.fill(ZERO);
                for i in 0..nx.min(quarter_rows) {
                    for b in 0..width {
                        let value = part(rows[i * columns + start + b], odd[1]);
                        block_columns[b * mx + (mx - i) % mx] = Complex64::new(sign_x * value, 0.0);
                        block_columns[b * mx + i] = Complex64::new(value, 0.0);
                    }
                }
                self.column_forward.process_with_scratch(block_columns, &mut scratch.fft);
                for k in 0..quarter_rows {
                    for b in 0..width {
                        values[k * next_row + b * next_column] =
                            part(block_columns[b * mx + k], odd[0]) * scale;
                    }
                }
            }
        };
        self.over_items(threads, &mut spectrum, size, scratches, transform);
        spectrum
    }

    /// Spectra with the `values` of their quarters at the waves (m, n) \[rad per cell\], m, n ≥ 0, less the factors i.
    pub(crate) fn spectra_of<const N: usize>(
        &self,
        odd: [[bool; 2]; N],
        values: impl Fn(f64, f64) -> [f64; N],
    ) -> [ParitySpectrum; N] {
        let wave = |k: usize, period: usize| std::f64::consts::TAU * k as f64 / period as f64;
        let scale = 1.0 / self.points();
        let [mx, my] = self.padded;
        let count = self.columns() * self.quarter_rows();
        let mut spectra = odd.map(|odd| ParitySpectrum { values: Vec::with_capacity(count), odd });
        for l in 0..self.columns() {
            for k in 0..self.quarter_rows() {
                let values = values(wave(k, mx), wave(l, my));
                for (spectrum, value) in spectra.iter_mut().zip(values) {
                    // Odd kernels have no wave of two cells.
                    let none = spectrum.odd[0] && 2 * k == mx || spectrum.odd[1] && 2 * l == my;
                    spectrum.values.push(if none { 0.0 } else { scale * value });
                }
            }
        }
        spectra
    }

    /// Spectra of the inverse of a symmetric matrix of kernels, given as its elements xx, xy and yy, of which xy is odd along
    /// both directions. Where an entry is not near that of the `others`, as on a mesh that is too small for the kernels, it
    /// is theirs.
    pub(crate) fn inverse_spectra(
        &self,
        kernels: [ParitySpectrum; 3],
        mut others: [ParitySpectrum; 3],
    ) -> [ParitySpectrum; 3] {
        // Ratio of the traces. Entries of bare bodies lie between 0.7 and 1.2, those of coats up to 4.
        const NEAR: std::ops::Range<f64> = 0.25..4.0;
        let points = self.points();
        for at in 0..others[0].values.len() {
            let [xx, xy, yy] = kernels.each_ref().map(|kernel| kernel.values[at]);
            // Two odd directions have the factor i² = −1.
            let scale = (xx * yy - xy * xy) * points * points;
            let inverse = [yy / scale, -xy / scale, xx / scale];
            let trace = others[0].values[at] + others[2].values[at];
            let near = NEAR.contains(&((inverse[0] + inverse[2]) / trace));
            if near && scale > 0.0 {
                for (other, value) in others.iter_mut().zip(inverse) {
                    other.values[at] = value;
                }
            }
        }
        others
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

    /// Spectrum of the inverse of a kernel: that of a `spectrum`, with `diagonal` added at the offset 0. Entries below
    /// `bound` are raised to it, so that the inverse is positive and finite.
    pub(crate) fn inverse_spectrum(
        &self,
        spectrum: &EvenSpectrum,
        diagonal: f64,
        bound: f64,
    ) -> EvenSpectrum {
        let points = self.points();
        let more = diagonal / points;
        let inverse = |c: &f64| 1.0 / ((c + more).max(bound) * points * points);
        let values = spectrum.0.iter().map(inverse).collect();
        EvenSpectrum(values)
    }
}
