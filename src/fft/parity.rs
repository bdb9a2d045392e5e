//! Convolution of one input with many kernels, each even or odd along x and along y.

use rustfft::num_complex::Complex64;

use super::{BLOCK, PaddedTransform, TaskScratch, Workspace, ZERO};
use crate::threads::Threads;

/// The transform of padded data: columns of the half spectrum, one after another.
#[derive(Debug)]
pub(crate) struct Transformed(Vec<Complex64>);

/// The transform of a kernel that is even or odd along x and along y: a quarter of it, less the
/// factor i for each direction in which it is odd. Scaled by 1/(mx my), by columns.
#[derive(Debug)]
pub(crate) struct ParitySpectrum {
    odd: [bool; 2],
    values: Vec<f64>,
}

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

    /// Transform of the kernel with `value(i, j)` at offsets (i, j) ≥ 0 of cells, i < nx, j < ny.
    pub(crate) fn parity_spectrum(
        &self,
        odd: [bool; 2],
        value: impl Fn(usize, usize) -> f64 + Sync,
        workspace: &mut Workspace,
        threads: &Threads,
    ) -> ParitySpectrum {
        let ([nx, ny], [mx, my]) = (self.shape, self.padded);
        let (columns, quarter_rows) = (self.columns(), self.quarter_rows());
        let Workspace { rows, tasks, .. } = workspace;
        let scale = 1.0 / (mx as f64 * my as f64);
        let rows_of_a_task = nx.div_ceil(self.tasks);
        let [odd_x, odd_y] = odd;
        let mirror = |odd: bool| if odd { -1.0 } else { 1.0 };
        let forward = |first: usize, rows: &mut [Complex64], scratch: &mut TaskScratch| {
            for (row, half) in rows.chunks_exact_mut(columns).enumerate() {
                let real = &mut scratch.real;
                real.fill(0.0);
                for j in 0..ny {
                    let c = value(first + row, j);
                    real[(my - j) % my] = mirror(odd_y) * c;
                    real[j] = c;
                }
                if odd_y {
                    real[0] = 0.0;
                }
                self.rows_to_spectrum(real, half, &mut scratch.fft);
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
        let mut values = vec![0.0; columns * quarter_rows];
        // What is left along x is real: two columns make one complex transform.
        let pair = |first: usize, part: &mut [f64], scratch: &mut TaskScratch| {
            for (k, values) in part.chunks_mut(2 * quarter_rows).enumerate() {
                let l = first + 2 * k;
                let two = l + 1 < columns;
                let kept = |c: Complex64| if odd_y { c.im } else { c.re };
                let buffer = &mut scratch.columns[..mx];
                buffer.fill(ZERO);
                for i in 0..nx {
                    let row = &rows[i * columns..(i + 1) * columns];
                    let second = if two { kept(row[l + 1]) } else { 0.0 };
                    let entry = Complex64::new(kept(row[l]), second);
                    buffer[(mx - i) % mx] = entry * mirror(odd_x);
                    buffer[i] = entry;
                }
                if odd_x {
                    buffer[0] = ZERO;
                }
                self.column_forward
                    .process_with_scratch(buffer, &mut scratch.fft);
                // Of an odd column, i times a real one.
                let (one, other) = values.split_at_mut(quarter_rows);
                for (c, value) in buffer.iter().zip(one) {
                    *value = scale * if odd_x { c.im } else { c.re };
                }
                for (c, value) in buffer.iter().zip(other) {
                    *value = scale * if odd_x { -c.re } else { c.im };
                }
            }
        };
        let columns_of_a_task = 2 * columns.div_ceil(2 * self.tasks);
        self.over_rows(
            threads,
            &mut values,
            columns_of_a_task * quarter_rows,
            tasks,
            columns_of_a_task,
            pair,
        );
        ParitySpectrum { odd, values }
    }

    /// `output` = Σ weight · kernel ∗ input, (nx, ny) in C order.
    pub(crate) fn convolve_parities(
        &self,
        input: &Transformed,
        kernels: &[(f64, ParitySpectrum)],
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
                    self.multiplier(kernels, l * quarter_rows, column);
                    let data = &input.0[l * mx..(l + 1) * mx];
                    column.iter_mut().zip(data).for_each(|(c, d)| *c *= d);
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

    /// The whole column of the sum of the kernels' spectra that starts at `offset` of theirs.
    fn multiplier(
        &self,
        kernels: &[(f64, ParitySpectrum)],
        offset: usize,
        column: &mut [Complex64],
    ) {
        let (mx, quarter_rows) = (self.padded[0], self.quarter_rows());
        column.fill(ZERO);
        for (weight, ParitySpectrum { odd, values }) in kernels {
            let values = &values[offset..offset + quarter_rows];
            // i for each direction in which the kernel is odd.
            let turn = match odd {
                [false, false] => Complex64::new(*weight, 0.0),
                [true, true] => Complex64::new(-weight, 0.0),
                _ => Complex64::new(0.0, *weight),
            };
            for (c, value) in column.iter_mut().zip(values) {
                *c += turn * value;
            }
            let mirrored = if odd[0] { -turn } else { turn };
            for (k, c) in column[quarter_rows..].iter_mut().enumerate() {
                *c += mirrored * values[mx - quarter_rows - k];
            }
        }
    }
}
