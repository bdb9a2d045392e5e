//! Convolution of one input with many kernels, each even or odd along x and along y.

use rustfft::num_complex::Complex64;

use super::{BLOCK, PaddedTransform, TaskScratch, Workspace, ZERO};
use crate::threads::Threads;

/// The transform of padded data: columns of the half spectrum, one after another.
#[derive(Debug)]
pub(crate) struct Transformed(Vec<Complex64>);

/// The transform of a kernel that is even or odd along x and along y: a quarter of it, less the
/// factor i for each direction in which it is odd. Scaled by 1/(mx my), by columns.
#[derive(Debug, Clone)]
pub(crate) struct ParitySpectrum {
    odd: [bool; 2],
    values: Vec<f64>,
}

/// Memory for the transform of one kernel at a time.
#[derive(Debug)]
pub(crate) struct KernelRows(Vec<f64>);

impl PaddedTransform {
    /// Of data (nx, ny) in C order.
    pub(crate) fn transform(
        &self,
        input: &[f64],
        workspace: &mut Workspace,
        threads: &Threads,
    ) -> Transformed {
        let [nx, ny] = self.shape;
        let (mx, columns) = (self.padded[0], self.columns());
        let Workspace { rows, tasks, .. } = workspace;
        let rows_of_a_task = nx.div_ceil(self.tasks);
        let forward = |first: usize, rows: &mut [Complex64], scratch: &mut TaskScratch| {
            for (row, half) in rows.chunks_exact_mut(columns).enumerate() {
                let start = (first + row) * ny;
                scratch.real[..ny].copy_from_slice(&input[start..start + ny]);
                scratch.real[ny..].fill(0.0);
                self.rows_to_spectrum(&mut scratch.real, half, &mut scratch.fft);
            }
        };
        self.over_rows(
            threads,
            rows,
            columns * rows_of_a_task,
            tasks,
            rows_of_a_task,
            forward,
        );
        let rows = &*rows;
        let mut spectrum = vec![ZERO; columns * mx];
        let along = |first: usize, part: &mut [Complex64], scratch: &mut TaskScratch| {
            for (l, column) in part.chunks_exact_mut(mx).enumerate() {
                for (i, value) in column[..nx].iter_mut().enumerate() {
                    *value = rows[i * columns + first + l];
                }
                self.column_forward
                    .process_with_scratch(column, &mut scratch.fft);
            }
        };
        let columns_of_a_task = columns.div_ceil(self.tasks);
        self.over_rows(
            threads,
            &mut spectrum,
            columns_of_a_task * mx,
            tasks,
            columns_of_a_task,
            along,
        );
        Transformed(spectrum)
    }

    pub(crate) fn kernel_rows(&self) -> KernelRows {
        KernelRows(vec![0.0; self.shape[0] * self.columns()])
    }

    /// Room for the transform of a kernel.
    pub(crate) fn empty_spectrum(&self) -> ParitySpectrum {
        ParitySpectrum {
            odd: [false; 2],
            values: vec![0.0; self.columns() * self.quarter_rows()],
        }
    }

    /// Transform of the kernel of which `row(i)` are the values at offsets (i, j) ≥ 0, i < nx and
    /// j < ny.
    pub(crate) fn parity_spectrum_into<'a>(
        &self,
        odd: [bool; 2],
        row: impl Fn(usize) -> &'a [f64] + Sync,
        spectrum: &mut ParitySpectrum,
        rows: &mut KernelRows,
        workspace: &mut Workspace,
        threads: &Threads,
    ) {
        let ([nx, ny], [mx, my]) = (self.shape, self.padded);
        let (columns, quarter_rows) = (self.columns(), self.quarter_rows());
        let tasks = &mut workspace.tasks;
        let [odd_x, odd_y] = odd;
        let scale = 1.0 / (mx as f64 * my as f64);
        let rows_of_a_task = nx.div_ceil(self.tasks);
        let forward = |first: usize, rows: &mut [f64], scratch: &mut TaskScratch| {
            for (i, kept) in rows.chunks_exact_mut(columns).enumerate() {
                let TaskScratch {
                    real,
                    spectrum,
                    fft,
                    ..
                } = &mut *scratch;
                mirrored(&row(first + i)[..ny], odd_y, real);
                self.rows_to_spectrum(real, spectrum, fft);
                for (k, c) in kept.iter_mut().zip(&*spectrum) {
                    *k = if odd_y { c.im } else { c.re };
                }
            }
        };
        let rows = &mut rows.0;
        self.over_rows(
            threads,
            rows,
            columns * rows_of_a_task,
            tasks,
            rows_of_a_task,
            forward,
        );
        let rows = &*rows;
        // What is left along x is real: two columns make one complex transform.
        let pairs = |first: usize, part: &mut [f64], scratch: &mut TaskScratch| {
            for (block, values) in part.chunks_mut(BLOCK * quarter_rows).enumerate() {
                let start = first + block * BLOCK;
                let width = BLOCK.min(columns - start);
                let count = width.div_ceil(2);
                let buffer = &mut scratch.columns[..count * mx];
                for pair in buffer.chunks_exact_mut(mx) {
                    pair[nx..mx + 1 - nx].fill(ZERO);
                }
                for i in 0..nx {
                    let row = &rows[i * columns + start..i * columns + start + width];
                    let turned = (mx - i) % mx;
                    for (pair, two) in row.chunks(2).enumerate() {
                        let second = if two.len() > 1 { two[1] } else { 0.0 };
                        let entry = Complex64::new(two[0], second);
                        let entry = if odd_x && i == 0 { ZERO } else { entry };
                        buffer[pair * mx + turned] = if odd_x { -entry } else { entry };
                        buffer[pair * mx + i] = entry;
                    }
                }
                self.column_forward
                    .process_with_scratch(buffer, &mut scratch.fft);
                for (two, pair) in values
                    .chunks_mut(2 * quarter_rows)
                    .zip(buffer.chunks_exact(mx))
                {
                    let (one, other) = two.split_at_mut(quarter_rows);
                    // Of an odd column, i times a real one.
                    if odd_x {
                        pair.iter().zip(one).for_each(|(c, v)| *v = scale * c.im);
                        pair.iter().zip(other).for_each(|(c, v)| *v = -scale * c.re);
                    } else {
                        pair.iter().zip(one).for_each(|(c, v)| *v = scale * c.re);
                        pair.iter().zip(other).for_each(|(c, v)| *v = scale * c.im);
                    }
                }
            }
        };
        let blocks_of_a_task = self.blocks().div_ceil(self.tasks);
        self.over_rows(
            threads,
            &mut spectrum.values,
            blocks_of_a_task * BLOCK * quarter_rows,
            tasks,
            blocks_of_a_task * BLOCK,
            pairs,
        );
        spectrum.odd = odd;
    }

    /// `output` = Σ weight · kernel ∗ input, (nx, ny) in C order.
    pub(crate) fn convolve_parities(
        &self,
        input: &Transformed,
        kernels: &[(f64, &ParitySpectrum)],
        output: &mut [f64],
        workspace: &mut Workspace,
        threads: &Threads,
    ) {
        let [nx, ny] = self.shape;
        let mx = self.padded[0];
        let (columns, quarter_rows) = (self.columns(), self.quarter_rows());
        let Workspace { blocks, tasks, .. } = workspace;
        let multiply = |first: usize, blocks: &mut [Complex64], scratch: &mut TaskScratch| {
            for (block, kept) in blocks.chunks_exact_mut(nx * BLOCK).enumerate() {
                let start = (first + block) * BLOCK;
                let width = BLOCK.min(columns - start);
                let buffer = &mut scratch.columns[..width * mx];
                for (b, column) in buffer.chunks_exact_mut(mx).enumerate() {
                    let l = start + b;
                    let data = &input.0[l * mx..(l + 1) * mx];
                    for (k, (weight, kernel)) in kernels.iter().enumerate() {
                        let values = &kernel.values[l * quarter_rows..(l + 1) * quarter_rows];
                        multiply_add(column, data, values, kernel.odd, *weight, k > 0);
                    }
                }
                self.column_inverse
                    .process_with_scratch(buffer, &mut scratch.fft);
                for (b, column) in buffer.chunks_exact(mx).enumerate() {
                    for (i, value) in column[..nx].iter().enumerate() {
                        kept[i * BLOCK + b] = *value;
                    }
                }
            }
        };
        let blocks_of_a_task = self.blocks().div_ceil(self.tasks);
        let chunk = blocks_of_a_task * nx * BLOCK;
        self.over_rows(threads, blocks, chunk, tasks, blocks_of_a_task, multiply);

        let blocks = &*blocks;
        let rows_of_a_task = nx.div_ceil(self.tasks);
        let inverse = |first: usize, output: &mut [f64], scratch: &mut TaskScratch| {
            for (row, values) in output.chunks_exact_mut(ny).enumerate() {
                self.row_from_blocks(blocks, first + row, scratch);
                values.copy_from_slice(&scratch.real[..ny]);
            }
        };
        self.over_rows(
            threads,
            output,
            ny * rows_of_a_task,
            tasks,
            rows_of_a_task,
            inverse,
        );
    }
}

/// `half` at offsets ≥ 0, and what the parity makes of it at those below, in wrap-around order.
fn mirrored(half: &[f64], odd: bool, whole: &mut [f64]) {
    let (n, m) = (half.len(), whole.len());
    whole[..n].copy_from_slice(half);
    whole[n..m + 1 - n].fill(0.0);
    let negative = &mut whole[m + 1 - n..];
    for (turned, value) in negative.iter_mut().rev().zip(&half[1..]) {
        *turned = if odd { -value } else { *value };
    }
    if odd {
        whole[0] = 0.0;
    }
}

/// `column` = or += weight · (the kernel's column) · `data`.
fn multiply_add(
    column: &mut [Complex64],
    data: &[Complex64],
    values: &[f64],
    odd: [bool; 2],
    weight: f64,
    add: bool,
) {
    let (low, high) = column.split_at_mut(values.len());
    let (low_data, high_data) = data.split_at(values.len());
    // The upper half of the column mirrors 1 … of the quarter.
    let turned = values[1..=high.len()].iter().rev();
    let of_high = if odd[0] { -weight } else { weight };
    // i for each direction in which the kernel is odd.
    if odd[0] == odd[1] {
        let sign = if odd[0] { -1.0 } else { 1.0 };
        let real = |c: Complex64, v: f64| c * v;
        accumulate(low, low_data, values.iter(), sign * weight, add, real);
        accumulate(high, high_data, turned, sign * of_high, add, real);
    } else {
        let imaginary = |c: Complex64, v: f64| Complex64::new(-c.im * v, c.re * v);
        accumulate(low, low_data, values.iter(), weight, add, imaginary);
        accumulate(high, high_data, turned, of_high, add, imaginary);
    }
}

fn accumulate<'a>(
    column: &mut [Complex64],
    data: &[Complex64],
    values: impl Iterator<Item = &'a f64>,
    weight: f64,
    add: bool,
    product: impl Fn(Complex64, f64) -> Complex64,
) {
    let entries = column.iter_mut().zip(data).zip(values);
    if add {
        entries.for_each(|((c, d), v)| *c += product(*d, weight * v));
    } else {
        entries.for_each(|((c, d), v)| *c = product(*d, weight * v));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the double sum, for each parity and for their sum, on odd and even lengths.
    #[test]
    fn convolutions_of_every_parity_equal_the_double_sum() -> crate::Result<()> {
        let threads = Threads::new(Some(1))?;
        let parities = [[false, false], [true, false], [false, true], [true, true]];
        for [nx, ny] in [[5, 4], [1, 7], [6, 1], [3, 8]] {
            let transform = PaddedTransform::plan([nx, ny], &threads);
            let (mut workspace, mut rows) = (transform.workspace(), transform.kernel_rows());
            let input: Vec<f64> = (0..nx * ny).map(|k| ((k * k + 3) % 7) as f64).collect();
            let transformed = transform.transform(&input, &mut workspace, &threads);
            let mut exact = vec![0.0; nx * ny];
            let mut spectra = Vec::new();
            for (seed, odd) in parities.into_iter().enumerate() {
                let quarter: Vec<f64> = (0..nx * ny).map(|k| ((k + seed) % 5) as f64).collect();
                let mut spectrum = transform.empty_spectrum();
                let row = |i: usize| &quarter[i * ny..(i + 1) * ny];
                transform.parity_spectrum_into(
                    odd,
                    row,
                    &mut spectrum,
                    &mut rows,
                    &mut workspace,
                    &threads,
                );
                spectra.push((1.0 + seed as f64, spectrum));
                let side = |a: usize, b: usize, odd: bool| {
                    let sign = if !odd {
                        1.0
                    } else {
                        (a > b) as u8 as f64 - (a < b) as u8 as f64
                    };
                    (a.abs_diff(b), sign)
                };
                for (at, sum) in exact.iter_mut().enumerate() {
                    for (from, value) in input.iter().enumerate() {
                        let (i, sx) = side(at / ny, from / ny, odd[0]);
                        let (j, sy) = side(at % ny, from % ny, odd[1]);
                        *sum += (1.0 + seed as f64) * sx * sy * quarter[i * ny + j] * value;
                    }
                }
            }
            let kernels: Vec<_> = spectra.iter().map(|(w, s)| (*w, s)).collect();
            let mut output = vec![0.0; nx * ny];
            transform.convolve_parities(
                &transformed,
                &kernels,
                &mut output,
                &mut workspace,
                &threads,
            );
            for (value, exact) in output.iter().zip(&exact) {
                // Sums of some hundred numbers of at most 4 · 24.
                assert!((value - exact).abs() < 1e-11, "{nx} {ny}: {value} {exact}");
            }
        }
        Ok(())
    }
}
