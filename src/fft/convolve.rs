//! The convolution: rows forward, columns there and back with the product in between, rows back.

use std::ops::Range;

use ndarray::{ArrayViewMut3, Axis};
use rustfft::num_complex::Complex64;

use super::{BLOCK, EvenSpectrum, PaddedTransform, Scratch, Scratches, Workspace, ZERO};
use crate::threads::{Threads, join};

/// Calls `work` with each `length` rows along the second axis, and the number of the first.
fn each_part(
    rows: ArrayViewMut3<Complex64>,
    length: usize,
    first: usize,
    work: &(impl Fn(usize, ArrayViewMut3<Complex64>) + Sync),
) {
    let count = rows.len_of(Axis(1));
    if count <= length {
        work(first, rows);
        return;
    }
    let half = count.div_ceil(length) / 2 * length;
    let (near, far) = rows.split_at(Axis(1), half);
    join(
        || each_part(near, length, first, work),
        || each_part(far, length, first + half, work),
    );
}

impl PaddedTransform {
    /// `output` = kernel ∗ `input`, both (nx, ny) in C order; `input` is read in the rows of
    /// `occupied`, and zero elsewhere. Allocates nothing.
    pub(crate) fn convolve_into(
        &self,
        spectrum: &EvenSpectrum,
        (input, occupied): (&[f64], Range<usize>),
        output: &mut [f64],
        workspace: &mut Workspace,
        threads: &Threads,
    ) {
        // Handed over once, rather than for each of the three parts.
        self.divided(threads, || {
            let [nx, ny] = self.shape;
            let mx = self.padded[0];
            let columns = self.columns();
            let Workspace { mesh, scratches } = workspace;
            let blocks = &mut mesh[..self.blocks() * nx * BLOCK];
            self.rows_to_blocks(input, occupied.clone(), blocks, scratches, threads);

            let quarter_rows = self.quarter_rows();
            let multiply = |first: usize, blocks: &mut [Complex64], scratch: &mut Scratch| {
                for (block, lines) in blocks.chunks_exact_mut(nx * BLOCK).enumerate() {
                    let start = (first + block) * BLOCK;
                    let width = BLOCK.min(columns - start);
                    let buffer = &mut scratch.columns[..width * mx];
                    for (b, column) in buffer.chunks_exact_mut(mx).enumerate() {
                        column[..occupied.start].fill(ZERO);
                        column[occupied.end..].fill(ZERO);
                        let values = column[occupied.clone()].iter_mut();
                        for (value, i) in values.zip(occupied.clone()) {
                            *value = lines[i * BLOCK + b];
                        }
                    }
                    self.column_forward
                        .process_with_scratch(buffer, &mut scratch.fft);
                    let offset = (first + block) * quarter_rows * BLOCK;
                    let values = &spectrum.0[offset..offset + quarter_rows * BLOCK];
                    for (b, column) in buffer.chunks_exact_mut(mx).enumerate() {
                        column[0] *= values[b];
                        let (low, high) = column[1..].split_at_mut(quarter_rows - 1);
                        for (k, value) in low.iter_mut().enumerate() {
                            *value *= values[(k + 1) * BLOCK + b];
                        }
                        for (k, value) in high.iter_mut().rev().enumerate() {
                            *value *= values[(k + 1) * BLOCK + b];
                        }
                    }
                    self.column_inverse
                        .process_with_scratch(buffer, &mut scratch.fft);
                    for (b, column) in buffer.chunks_exact(mx).enumerate() {
                        for (i, value) in column[..nx].iter().enumerate() {
                            lines[i * BLOCK + b] = *value;
                        }
                    }
                }
            };
            self.over_items(threads, blocks, nx * BLOCK, scratches, multiply);

            let blocks = &*blocks;
            let inverse = |first: usize, output: &mut [f64], scratch: &mut Scratch| {
                for (row, values) in output.chunks_exact_mut(ny).enumerate() {
                    self.row_from_parts(blocks.chunks(nx * BLOCK), first + row, scratch);
                    values.copy_from_slice(&scratch.real[..ny]);
                }
            };
            self.over_items(threads, output, ny, scratches, inverse);
        });
    }

    /// Transforms the `occupied` rows of `input` along y into `blocks`.
    fn rows_to_blocks(
        &self,
        input: &[f64],
        occupied: Range<usize>,
        blocks: &mut [Complex64],
        scratches: &Scratches,
        threads: &Threads,
    ) {
        let [nx, ny] = self.shape;
        let Ok(blocks) = ArrayViewMut3::from_shape([self.blocks(), nx, BLOCK], blocks) else {
            unreachable!("the mesh has room for the rows of all blocks");
        };
        let (_, blocks) = blocks.split_at(Axis(1), occupied.start);
        let (blocks, _) = blocks.split_at(Axis(1), occupied.len());
        let input = &input[occupied.start * ny..occupied.end * ny];
        let forward = |first: usize, mut blocks: ArrayViewMut3<Complex64>| {
            let scratch = &mut *self.scratch(scratches);
            let half = &mut scratch.spectrum[..self.columns()];
            let rows = input[first * ny..].chunks_exact(ny);
            for (mut lines, values) in blocks.axis_iter_mut(Axis(1)).zip(rows) {
                self.data_to_spectrum(values, half, &mut scratch.real, &mut scratch.fft);
                for (line, values) in lines.outer_iter_mut().zip(half.chunks(BLOCK)) {
                    if let Some(line) = line.into_slice() {
                        line[..values.len()].copy_from_slice(values);
                    }
                }
            }
        };
        let rows_of_a_task = occupied.len().div_ceil(self.tasks).max(1);
        self.divided(threads, || each_part(blocks, rows_of_a_task, 0, &forward));
    }
}
