//! The three stages of a convolution with an even kernel: rows are transformed along y; columns are
//! transformed along x, multiplied by the kernel's spectrum and transformed back; rows are transformed
//! back.

use std::ops::Range;

use ndarray::{ArrayViewMut2, Axis};
use rustfft::num_complex::Complex64;

use super::{
    BLOCK, EvenSpectrum, PaddedTransform, ROW_GROUP, Scratch, Scratches, TransformMemory, ZERO,
};
use crate::numerics::parallel::{Threads, each_chunk, join};

/// Half spectra of consecutive rows, stored by blocks of columns.
pub(crate) struct HalfSpectra<'a>(ArrayViewMut2<'a, [Complex64; BLOCK]>);

impl HalfSpectra<'_> {
    /// The first `rows` of these half spectra, and the remaining ones.
    pub(crate) fn split(self, rows: usize) -> (Self, Self) {
        let (near, far) = self.0.split_at(Axis(1), rows);
        (Self(near), Self(far))
    }
}

/// Divides `rows` into groups of `length` rows or fewer, and calls `work` for each with the index of its
/// first row; `first` is the index of the first of all.
fn each_group(
    rows: HalfSpectra,
    length: usize,
    first: usize,
    work: &(impl Fn(usize, HalfSpectra) + Sync),
) {
    let count = rows.0.len_of(Axis(1));
    if count <= length {
        work(first, rows);
        return;
    }
    let half = count.div_ceil(length) / 2 * length;
    let (near, far) = rows.split(half);
    join(|| each_group(near, length, first, work), || each_group(far, length, first + half, work));
}

impl PaddedTransform {
    /// Computes `output` = kernel ∗ `input`, both (nx, ny) in C order, without allocating memory. Only the `occupied`
    /// rows of the input are read; the others are zero.
    pub(crate) fn convolve_into(
        &self,
        spectrum: &EvenSpectrum,
        (input, occupied): (&[f64], Range<usize>),
        output: &mut [f64],
        workspace: &mut TransformMemory,
        threads: &Threads,
    ) {
        // All three stages run in one call of the threads, which takes less time than three calls.
        self.divided(threads, || {
            self.rows_in((input, occupied.clone()), workspace, threads);
            self.columns_through(spectrum, occupied, workspace, threads);
            let ny = self.shape[1];
            let per_task = self.shape[0].div_ceil(self.tasks);
            let workspace = &*workspace;
            each_chunk(output, per_task * ny, 0, &|task, output| {
                self.rows_out(task * per_task, output, workspace);
            });
        });
    }

    /// First stage: transforms the `occupied` rows of `input` along y.
    pub(crate) fn rows_in(
        &self,
        (input, occupied): (&[f64], Range<usize>),
        workspace: &mut TransformMemory,
        threads: &Threads,
    ) {
        let (rows, scratches) = self.half_spectra(workspace);
        self.rows_into((input, occupied), rows, scratches, threads);
    }

    /// Transforms the `occupied` rows of `input` along y into those of `rows`.
    pub(super) fn rows_into(
        &self,
        (input, occupied): (&[f64], Range<usize>),
        rows: HalfSpectra,
        scratches: &Scratches,
        threads: &Threads,
    ) {
        let (_, rows) = rows.split(occupied.start);
        let (rows, _) = rows.split(occupied.len());
        let per_task = occupied.len().div_ceil(self.tasks).max(1);
        let ny = self.shape[1];
        let work = |first: usize, rows: HalfSpectra| {
            self.some_rows_in(&input[first * ny..], rows, scratches)
        };
        self.divided(threads, || each_group(rows, per_task, occupied.start, &work));
    }

    /// Memory for the half spectra of all rows, which [`Self::some_rows_in`] can fill row by row, and
    /// the working memory of the threads.
    pub(crate) fn half_spectra<'a>(
        &self,
        workspace: &'a mut TransformMemory,
    ) -> (HalfSpectra<'a>, &'a Scratches) {
        let TransformMemory { mesh, scratches } = workspace;
        let size = self.block_rows();
        let (rows, _) = self.blocks_of(mesh, size).split(self.shape[0]);
        (rows, scratches)
    }

    /// The blocks of columns in `mesh`, each of `size` rows.
    pub(super) fn blocks_of<'a>(
        &self,
        mesh: &'a mut [[Complex64; BLOCK]],
        size: usize,
    ) -> HalfSpectra<'a> {
        let shape = [self.blocks(), size];
        let Ok(rows) = ArrayViewMut2::from_shape(shape, &mut mesh[..shape[0] * size]) else {
            unreachable!("the mesh has space for the rows of all blocks");
        };
        HalfSpectra(rows)
    }

    /// Transforms the first rows of `input` along y into `halves`, as many as `halves` has.
    pub(crate) fn some_rows_in(&self, input: &[f64], halves: HalfSpectra, scratches: &Scratches) {
        let Scratch { real, spectra, fft, .. } = &mut *self.scratch(scratches);
        let (ny, blocks, columns) = (self.shape[1], self.blocks(), self.columns());
        let HalfSpectra(mut rows) = halves;
        let input = &input[..rows.len_of(Axis(1)) * ny];
        let groups = rows.axis_chunks_iter_mut(Axis(1), ROW_GROUP);
        for (mut rows, input) in groups.zip(input.chunks(ROW_GROUP * ny)) {
            let spectra_of = spectra.chunks_exact_mut(blocks * BLOCK);
            for (spectrum, values) in spectra_of.zip(input.chunks_exact(ny)) {
                let (half, beyond) = spectrum.split_at_mut(columns);
                self.data_to_spectrum(values, half, real, fft);
                beyond.fill(ZERO);
            }
            let (spectra, _) = spectra.as_chunks();
            for (block, lines) in rows.outer_iter_mut().enumerate() {
                let spectra = spectra[block..].iter().step_by(blocks);
                for (line, spectrum) in lines.into_iter().zip(spectra) {
                    *line = *spectrum;
                }
            }
        }
    }

    /// Second stage: convolves all columns along x. The `occupied` rows have passed the first stage; all
    /// other rows are zero.
    pub(crate) fn columns_through(
        &self,
        spectrum: &EvenSpectrum,
        occupied: Range<usize>,
        workspace: &mut TransformMemory,
        threads: &Threads,
    ) {
        let (nx, mx) = (self.shape[0], self.padded[0]);
        let (columns, size) = (self.columns(), self.block_rows());
        let kernel = spectrum.0.as_chunks().0;
        let TransformMemory { mesh, scratches } = workspace;
        let blocks = &mut mesh[..self.blocks() * size];
        let convolve = |first: usize, blocks: &mut [_], scratch: &mut Scratch| {
            let kernels = kernel.chunks_exact(self.quarter_rows()).skip(first);
            let blocks = blocks.chunks_exact_mut(size).zip(kernels);
            for (block, (lines, kernel)) in blocks.enumerate() {
                let width = (columns - (first + block) * BLOCK).min(BLOCK);
                let buffer = &mut scratch.columns[..width.next_multiple_of(COLUMN_GROUP) * mx];
                gather(lines, occupied.clone(), mx, buffer);
                self.column_forward.process_with_scratch(buffer, &mut scratch.fft);
                multiply(buffer, mx, kernel);
                self.column_inverse.process_with_scratch(buffer, &mut scratch.fft);
                scatter(buffer, mx, &mut lines[..nx]);
            }
        };
        self.over_items(threads, blocks, size, scratches, convolve);
    }

    /// Third stage: transforms rows back along y into `values`, from row `first` on and as many as fit.
    pub(crate) fn rows_out(&self, first: usize, values: &mut [f64], workspace: &TransformMemory) {
        let TransformMemory { mesh, scratches } = workspace;
        let size = self.block_rows();
        let blocks = mesh[..self.blocks() * size].chunks_exact(size);
        self.rows_from_blocks(blocks, first, values, &mut self.scratch(scratches));
    }
}

/// Columns of a block that are processed together. In each row they fill a cache line of 64 bytes.
pub(super) const COLUMN_GROUP: usize = 4;

/// The first [`COLUMN_GROUP`] of consecutive columns of `length` points each.
fn split_columns(columns: &mut [Complex64], length: usize) -> [&mut [Complex64]; COLUMN_GROUP] {
    let (ab, cd) = columns.split_at_mut(2 * length);
    let ((a, b), (c, d)) = (ab.split_at_mut(length), cd.split_at_mut(length));
    [a, b, c, d]
}

/// Copies the columns of `lines` into `columns`, of `length` points each. Only the `occupied` rows are
/// read; all other points are set to zero.
pub(super) fn gather(
    lines: &[[Complex64; BLOCK]],
    occupied: Range<usize>,
    length: usize,
    columns: &mut [Complex64],
) {
    let lines = &lines[occupied.clone()];
    for (k, columns) in columns.chunks_exact_mut(COLUMN_GROUP * length).enumerate() {
        let [a, b, c, d] = split_columns(columns, length).map(|column| {
            column[..occupied.start].fill(ZERO);
            column[occupied.end..].fill(ZERO);
            &mut column[occupied.clone()]
        });
        let entries = a.iter_mut().zip(b).zip(c.iter_mut().zip(d));
        for (line, ((a, b), (c, d))) in lines.iter().zip(entries) {
            [*a, *b, *c, *d] = line.as_chunks().0[k];
        }
    }
}

/// Multiplies columns of `length` points by the columns of a real and even `kernel`, which has the first
/// half of the points.
fn multiply(columns: &mut [Complex64], length: usize, kernel: &[[f64; BLOCK]]) {
    for (k, columns) in columns.chunks_exact_mut(COLUMN_GROUP * length).enumerate() {
        let halves = split_columns(columns, length).map(|column| column.split_at_mut(kernel.len()));
        let [(a, a_high), (b, b_high), (c, c_high), (d, d_high)] = halves;
        let times = |entries: [&mut Complex64; COLUMN_GROUP], values: &[f64; BLOCK]| {
            let values: [f64; COLUMN_GROUP] = values.as_chunks().0[k];
            entries.into_iter().zip(values).for_each(|(e, v)| *e *= v);
        };
        let low = a.iter_mut().zip(b).zip(c.iter_mut().zip(d)).zip(kernel);
        low.for_each(|(((a, b), (c, d)), values)| times([a, b, c, d], values));
        // The upper half mirrors the lower half without the first point.
        let high = a_high.iter_mut().zip(b_high).zip(c_high.iter_mut().zip(d_high));
        let high = high.rev().zip(&kernel[1..]);
        high.for_each(|(((a, b), (c, d)), values)| times([a, b, c, d], values));
    }
}

/// Copies the first points of columns of `length` points into `lines`, as many points as there are lines.
pub(super) fn scatter(columns: &[Complex64], length: usize, lines: &mut [[Complex64; BLOCK]]) {
    let mut four = columns.chunks_exact(COLUMN_GROUP * length);
    for (k, columns) in four.by_ref().enumerate() {
        let (ab, cd) = columns.split_at(2 * length);
        let ((a, b), (c, d)) = (ab.split_at(length), cd.split_at(length));
        let entries = a.iter().zip(b).zip(c.iter().zip(d));
        for (line, ((a, b), (c, d))) in lines.iter_mut().zip(entries) {
            line.as_chunks_mut().0[k] = [*a, *b, *c, *d];
        }
    }
    let done = columns.len() / length / COLUMN_GROUP * COLUMN_GROUP;
    for (k, column) in four.remainder().chunks_exact(length).enumerate() {
        for (line, value) in lines.iter_mut().zip(column) {
            line[done + k] = *value;
        }
    }
}
