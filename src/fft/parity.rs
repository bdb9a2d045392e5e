//! Convolution of one input with many kernels, each even or odd along x and along y.
//!
//! Of such a kernel only offsets ≥ 0 are given and transformed: along each direction a cosine or
//! sine transform of half the length, see [`super::cosine`].

use std::f64::consts::PI;
use std::fmt;
use std::sync::Arc;

use realfft::{RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftPlanner};

use super::cosine::{Angles, fold, unfold, unfold_pair};
use super::{BLOCK, PaddedTransform, TaskScratch, Workspace, ZERO};
use crate::threads::Threads;

/// Columns of real numbers that are gathered together: those of a cache line.
const GROUP: usize = 8;

/// The transform of padded data: columns of the half spectrum, one after another.
#[derive(Debug)]
pub(crate) struct Transformed(Vec<Complex64>);

/// Memory for planes whose columns are transformed back, by blocks of columns.
#[derive(Debug)]
pub(crate) struct Blocks(Vec<Complex64>);

/// The transform of a kernel that is even or odd along x and along y: a quarter of it, less the
/// factor i for each direction in which it is odd. Scaled by 1/(mx my), by columns.
#[derive(Debug, Clone)]
pub(crate) struct ParitySpectrum {
    odd: [bool; 2],
    values: Vec<f64>,
}

/// Cosine and sine transforms of kernels, and memory for one at a time.
pub(crate) struct KernelTransform {
    row: Arc<dyn RealToComplex<f64>>,
    column: Arc<dyn Fft<f64>>,
    /// Along x and along y.
    angles: [Angles; 2],
    /// Transformed along y.
    rows: Vec<f64>,
}

impl fmt::Debug for KernelTransform {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [nx, ny] = self.angles.each_ref().map(|angles| angles.sin.len() + 1);
        write!(f, "KernelTransform({nx} x {ny})")
    }
}

impl PaddedTransform {
    /// Of data (nx, ny) in C order.
    pub(crate) fn transform(
        &self,
        input: &[f64],
        workspace: &mut Workspace,
        threads: &Threads,
    ) -> Transformed {
        let nx = self.shape[0];
        let (mx, columns) = (self.padded[0], self.columns());
        let Workspace { rows, tasks, .. } = workspace;
        let rows = &mut rows[..nx * columns];
        self.rows_forward(input, rows, tasks, threads);
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

    /// Lengths are even, as kernels of either parity need.
    pub(crate) fn plan_even(shape: [usize; 2], threads: &Threads) -> Self {
        let even = |n: usize| {
            let mut half = n.max(2);
            while super::fast_length(half) != half {
                half += 1;
            }
            2 * half
        };
        Self::on(shape, shape.map(even), threads)
    }

    pub(crate) fn kernel_transform(&self) -> KernelTransform {
        let half = self.padded.map(|m| m / 2);
        let angles = half.map(|n| {
            let angles = (1..n).map(|j| (PI * j as f64 / n as f64).sin_cos());
            let (sin, cos) = angles.unzip();
            Angles { sin, cos }
        });
        KernelTransform {
            row: RealFftPlanner::new().plan_fft_forward(half[1]),
            column: FftPlanner::new().plan_fft_forward(half[0]),
            angles,
            rows: vec![0.0; self.shape[0] * self.columns()],
        }
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
        kernel: &mut KernelTransform,
        workspace: &mut Workspace,
        threads: &Threads,
    ) {
        let ([nx, ny], columns, quarter_rows) = (self.shape, self.columns(), self.quarter_rows());
        let KernelTransform {
            row: row_plan,
            column: column_plan,
            angles,
            rows,
        } = kernel;
        let tasks = &mut workspace.tasks;
        let [odd_x, odd_y] = odd;
        let rows_of_a_task = nx.div_ceil(self.tasks);
        let along_y = |first: usize, rows: &mut [f64], scratch: &mut TaskScratch| {
            let (length, fft) = (columns - 1, &mut scratch.fft);
            fft.resize(fft.len().max(row_plan.get_scratch_len()), ZERO);
            let half = &mut scratch.spectrum[..length / 2 + 1];
            let (values, folded) = scratch.real[..2 * length].split_at_mut(length);
            for (i, kept) in rows.chunks_exact_mut(columns).enumerate() {
                values[..ny].copy_from_slice(&row(first + i)[..ny]);
                values[ny..].fill(0.0);
                let start = fold(values, odd_y, &angles[1], folded);
                let fft = &mut fft[..row_plan.get_scratch_len()];
                let done = row_plan.process_with_scratch(folded, half, fft);
                debug_assert!(done.is_ok(), "lengths are the plan's own");
                unfold(half, odd_y, start, kept);
            }
        };
        self.over_rows(
            threads,
            rows,
            columns * rows_of_a_task,
            tasks,
            rows_of_a_task,
            along_y,
        );
        let rows = &*rows;
        let scale = 1.0 / (self.padded[0] as f64 * self.padded[1] as f64);
        // Two columns, which are real, make one complex transform.
        let along_x = |first: usize, part: &mut [f64], scratch: &mut TaskScratch| {
            let length = quarter_rows - 1;
            let fft = &mut scratch.fft;
            fft.resize(fft.len().max(column_plan.get_inplace_scratch_len()), ZERO);
            let (values, folded) = scratch.columns.split_at_mut(GROUP / 2 * length);
            let folded = &mut folded[..length];
            let mut spare = vec![0.0; quarter_rows];
            for (k, group) in part.chunks_mut(GROUP * quarter_rows).enumerate() {
                let l = first + GROUP * k;
                let width = group.len() / quarter_rows;
                for (i, row) in rows.chunks_exact(columns).enumerate() {
                    for (pair, two) in row[l..l + width].chunks(2).enumerate() {
                        let second = two.get(1).copied().unwrap_or(0.0);
                        values[pair * length + i] = Complex64::new(two[0], second) * scale;
                    }
                }
                let pairs = group.chunks_mut(2 * quarter_rows);
                for (pair, values) in pairs.zip(values.chunks_exact_mut(length)) {
                    values[nx..].fill(ZERO);
                    let start = fold(values, odd_x, &angles[0], folded);
                    column_plan.process_with_scratch(folded, fft);
                    let two = pair.len() > quarter_rows;
                    let (one, other) = pair.split_at_mut(quarter_rows);
                    let other = if two { other } else { &mut spare };
                    unfold_pair(folded, odd_x, start, one, other);
                }
            }
        };
        let columns_of_a_task = GROUP * columns.div_ceil(GROUP * self.tasks);
        self.over_rows(
            threads,
            &mut spectrum.values,
            columns_of_a_task * quarter_rows,
            tasks,
            columns_of_a_task,
            along_x,
        );
        spectrum.odd = odd;
    }

    /// Memory for [`Self::convolve_parities`] with up to `count` outputs.
    pub(crate) fn block_memory(&self, count: usize) -> Blocks {
        Blocks(vec![ZERO; self.blocks() * count * self.shape[0] * BLOCK])
    }

    /// Each output, (nx, ny) in C order, = Σ weight · kernel ∗ input over its kernels.
    ///
    /// All at once, so that the input passes through the caches once.
    pub(crate) fn convolve_parities(
        &self,
        input: &Transformed,
        kernels: &[Vec<(f64, &ParitySpectrum)>],
        outputs: &mut [&mut [f64]],
        blocks: &mut Blocks,
        workspace: &mut Workspace,
        threads: &Threads,
    ) {
        let [nx, ny] = self.shape;
        let mx = self.padded[0];
        let (columns, quarter_rows) = (self.columns(), self.quarter_rows());
        let tasks = &mut workspace.tasks;
        let size = kernels.len() * nx * BLOCK;
        let blocks = &mut blocks.0[..self.blocks() * size];
        let multiply = |first: usize, blocks: &mut [Complex64], scratch: &mut TaskScratch| {
            for (block, parts) in blocks.chunks_exact_mut(size).enumerate() {
                let start = (first + block) * BLOCK;
                let width = BLOCK.min(columns - start);
                let buffer = &mut scratch.columns[..width * mx];
                for (kernels, kept) in kernels.iter().zip(parts.chunks_exact_mut(nx * BLOCK)) {
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
            }
        };
        let blocks_of_a_task = self.blocks().div_ceil(self.tasks);
        let chunk = blocks_of_a_task * size;
        self.over_rows(threads, blocks, chunk, tasks, blocks_of_a_task, multiply);

        let blocks = &*blocks;
        let rows_of_a_task = nx.div_ceil(self.tasks);
        for (k, output) in outputs.iter_mut().enumerate() {
            let inverse = |first: usize, output: &mut [f64], scratch: &mut TaskScratch| {
                for (row, values) in output.chunks_exact_mut(ny).enumerate() {
                    let blocks = blocks.chunks_exact(size);
                    let parts = blocks.map(|block| &block[k * nx * BLOCK..(k + 1) * nx * BLOCK]);
                    self.row_from_parts(parts, first + row, scratch);
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
            let transform = PaddedTransform::plan_even([nx, ny], &threads);
            let (mut workspace, mut rows) = (transform.workspace(), transform.kernel_transform());
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
            let (first, last) = (kernels[..3].to_vec(), kernels[3..].to_vec());
            let mut outputs = [vec![0.0; nx * ny], vec![0.0; nx * ny]];
            transform.convolve_parities(
                &transformed,
                &[first, last],
                &mut outputs.each_mut().map(Vec::as_mut_slice),
                &mut transform.block_memory(2),
                &mut workspace,
                &threads,
            );
            for ((a, b), exact) in outputs[0].iter().zip(&outputs[1]).zip(&exact) {
                let value = a + b;
                // Sums of some hundred numbers of at most 4 · 24.
                assert!((value - exact).abs() < 1e-11, "{nx} {ny}: {value} {exact}");
            }
        }
        Ok(())
    }
}
