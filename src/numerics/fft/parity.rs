//! Convolutions with kernels that are each even or odd along x and along y: of one input with several of them, and of
//! several inputs with a matrix of them.
//!
//! For the first, kernels are given at offsets ≥ 0 and transformed along each direction by a cosine or sine transform
//! of half the length, see [`super::cosine`]. Rows are transformed when they are computed. Columns are
//! transformed when they are needed, one block at a time, so that the full transform is never stored.

use std::f64::consts::PI;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use realfft::{RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftPlanner};

use super::cosine::{Angles, fold, fold_pairs, unfold, unfold_pair};
use super::stages::{COLUMN_GROUP, gather, scatter};
use super::{BLOCK, PaddedTransform, ParitySpectrum, Scratch, TransformMemory, ZERO};
use crate::numerics::parallel::Threads;

/// The half spectrum of padded data, scaled by 1/(mx my) and stored column after column.
#[derive(Debug)]
pub(crate) struct Transformed(Vec<Complex64>);

/// Receives one row of a kernel: (row, kernel, values).
pub(crate) type Keep<'a> = dyn FnMut(usize, usize, &[f64]) + 'a;

/// Plans of the cosine and sine transforms of half the padded lengths.
pub(crate) struct QuarterTransform {
    row: Arc<dyn RealToComplex<f64>>,
    column: Arc<dyn Fft<f64>>,
    /// Angles of the transforms along x and along y.
    angles: [Angles; 2],
}

impl fmt::Debug for QuarterTransform {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [nx, ny] = self.angles.each_ref().map(|angles| angles.sin.len() + 1);
        write!(f, "QuarterTransform({nx} x {ny})")
    }
}

/// Several kernels at offsets (i, j) ≥ 0, transformed along y.
#[derive(Debug)]
pub(crate) struct KernelRows {
    /// Numbers of offsets along x and along y.
    offsets: [usize; 2],
    /// Whether each kernel is odd along x and along y.
    odd: Vec<[bool; 2]>,
    /// Number of rows that one task computes.
    rows_per_task: usize,
    /// Rows, ordered by task, block of columns and kernel.
    values: Vec<[f64; BLOCK]>,
    /// Position in `values` of each row of the first kernel in the first block.
    starts: Vec<usize>,
}

impl KernelRows {
    fn odd(&self, kernel: usize) -> [bool; 2] {
        self.odd[kernel]
    }

    /// Row i of a kernel in a block of columns; zero beyond the given offsets.
    fn line(&self, [block, kernel]: [usize; 2], i: usize) -> &[f64; BLOCK] {
        let part = (block * self.odd.len() + kernel) * self.rows_per_task;
        self.starts.get(i).map_or(&[0.0; BLOCK], |start| &self.values[start + part])
    }
}

impl QuarterTransform {
    fn new(padded: [usize; 2]) -> Self {
        let half = padded.map(|m| m / 2);
        let angles = half.map(|n| {
            let angles = (1..n).map(|j| (PI * j as f64 / n as f64).sin_cos());
            let (sin, cos) = angles.unzip();
            Angles { sin, cos }
        });
        Self {
            row: RealFftPlanner::new().plan_fft_forward(half[1]),
            column: FftPlanner::new().plan_fft_forward(half[0]),
            angles,
        }
    }

    /// Half the padded length along x, which is the length of a folded column.
    fn column_length(&self) -> usize {
        self.angles[0].sin.len() + 1
    }

    /// Transforms the columns of one block of a kernel into `folded`, two columns as one complex
    /// sequence, and returns the term 1 of each column, which [`unfold_pair`] needs.
    fn columns(
        &self,
        rows: &KernelRows,
        [block, kernel]: [usize; 2],
        pairs: usize,
        folded: &mut [Complex64],
        fft: &mut Vec<Complex64>,
    ) -> [f64; BLOCK] {
        let length = self.column_length();
        let folded = &mut folded[..pairs * length];
        let line = |i: usize| rows.line([block, kernel], i);
        let first = fold_pairs(line, rows.odd[kernel][0], &self.angles[0], folded);
        fft.resize(fft.len().max(self.column.get_inplace_scratch_len()), ZERO);
        self.column.process_with_scratch(folded, fft);
        first
    }
}

impl PaddedTransform {
    /// Transforms `input` (nx, ny) in C order.
    pub(crate) fn transform(
        &self,
        input: &[f64],
        workspace: &mut TransformMemory,
        threads: &Threads,
    ) -> Transformed {
        let (nx, mx) = (self.shape[0], self.padded[0]);
        self.rows_in((input, 0..nx), workspace, threads);
        let TransformMemory { mesh, scratches } = workspace;
        let (mesh, size) = (&*mesh, self.block_rows());
        let scale = 1.0 / self.points();
        let mut spectrum = vec![ZERO; self.columns() * mx];
        let along = |first: usize, part: &mut [Complex64], scratch: &mut Scratch| {
            for (number, column) in (first..).zip(part.chunks_exact_mut(mx)) {
                let lines = &mesh[number / BLOCK * size..];
                for (value, line) in column[..nx].iter_mut().zip(lines) {
                    *value = line[number % BLOCK] * scale;
                }
                self.column_forward.process_with_scratch(column, &mut scratch.fft);
            }
        };
        self.over_items(threads, &mut spectrum, mx, scratches, along);
        Transformed(spectrum)
    }

    pub(crate) fn quarter_transform(&self) -> QuarterTransform {
        QuarterTransform::new(self.padded)
    }

    /// Memory for kernels of these parities along x and y, with the numbers of `offsets` along x and y.
    pub(crate) fn kernel_rows(&self, offsets: [usize; 2], odd: Vec<[bool; 2]>) -> KernelRows {
        let rows_per_task = offsets[0].div_ceil(self.tasks);
        let tasks = offsets[0].div_ceil(rows_per_task);
        let per_task = self.blocks() * odd.len() * rows_per_task;
        let start = |i: usize| i / rows_per_task * per_task + i % rows_per_task;
        KernelRows {
            offsets,
            odd,
            rows_per_task,
            values: vec![[0.0; BLOCK]; tasks * per_task],
            starts: (0..offsets[0]).map(start).collect(),
        }
    }

    /// Transforms kernels along y. `source` is called with ranges of rows, and passes each row of each
    /// kernel to its second argument.
    pub(crate) fn transform_rows(
        &self,
        transform: &QuarterTransform,
        kernels: &mut KernelRows,
        source: impl Fn(Range<usize>, &mut Keep) + Sync,
        workspace: &mut TransformMemory,
        threads: &Threads,
    ) {
        let KernelRows { offsets: [nx, ny], odd, rows_per_task, values, .. } = kernels;
        let ([nx, ny], per_task) = ([*nx, *ny], *rows_per_task);
        let (columns, count) = (self.columns(), odd.len());
        let (plan, angles) = (&transform.row, &transform.angles[1]);
        let odd = &*odd;
        let work = |first: usize, part: &mut [[f64; BLOCK]], scratch: &mut Scratch| {
            let (length, fft) = (columns - 1, &mut scratch.fft);
            fft.resize(fft.len().max(plan.get_scratch_len()), ZERO);
            let fft = &mut fft[..plan.get_scratch_len()];
            let half = &mut scratch.spectra[..length / 2 + 1];
            let (padded, folded) = scratch.real[..2 * length].split_at_mut(length);
            padded.fill(0.0);
            let mut line = vec![0.0; self.blocks() * BLOCK];
            let mut keep = |i: usize, k: usize, row: &[f64]| {
                padded[..ny].copy_from_slice(&row[..ny]);
                let start = fold(padded, odd[k][1], angles, folded);
                let done = plan.process_with_scratch(folded, half, fft);
                debug_assert!(done.is_ok(), "the lengths are those of the plan");
                unfold(half, odd[k][1], start, &mut line[..columns]);
                let (lines, _) = line.as_chunks::<BLOCK>();
                for (block, line) in lines.iter().enumerate() {
                    part[(block * count + k) * per_task + i - first] = *line;
                }
            };
            source(first..(first + per_task).min(nx), &mut keep);
        };
        let (size, scratches) = (self.blocks() * count, &workspace.scratches);
        self.over_tasks(threads, values, (size, per_task), scratches, work);
    }

    /// Transforms for kernels of either parity with the given numbers of `offsets` along x and y. These
    /// are at most the numbers of cells, and fewer where the input is zero near the edges.
    pub(crate) fn plan_even(shape: [usize; 2], offsets: [usize; 2], threads: &Threads) -> Self {
        let even = |n: usize| {
            let mut half = n.max(2);
            while super::fast_length(half) != half {
                half += 1;
            }
            2 * half
        };
        Self::on(shape, offsets.map(even), threads)
    }

    /// Computes one output, (nx, ny) in C order, for each of the `numbers`: the sum over all sets of
    /// weight · kernel ∗ input, with the kernel of this number in the set.
    ///
    /// All outputs are computed together, so that the input is read from memory once.
    pub(crate) fn convolve_parities(
        &self,
        input: &Transformed,
        (transform, sets): (&QuarterTransform, &[(f64, &KernelRows)]),
        numbers: Range<usize>,
        outputs: &mut [&mut [f64]],
        workspace: &mut TransformMemory,
        threads: &Threads,
    ) {
        let nx = self.shape[0];
        let mx = self.padded[0];
        let (columns, quarter_rows) = (self.columns(), self.quarter_rows());
        let TransformMemory { mesh, scratches } = workspace;
        let block_rows = self.block_rows();
        let size = numbers.len() * block_rows;
        mesh.resize(mesh.len().max(self.blocks() * size), [ZERO; BLOCK]);
        let blocks = &mut mesh[..self.blocks() * size];
        let multiply = |first: usize, blocks: &mut [[Complex64; BLOCK]], scratch: &mut Scratch| {
            let Scratch { real, columns: memory, fft, .. } = scratch;
            let length = quarter_rows - 1;
            memory.resize(memory.len().max(BLOCK * mx + BLOCK / 2 * length), ZERO);
            real.resize(real.len().max(2 * quarter_rows), 0.0);
            let (memory, folded) = memory.split_at_mut(BLOCK * mx);
            let (one, other) = real[..2 * quarter_rows].split_at_mut(quarter_rows);
            for (block, parts) in blocks.chunks_exact_mut(size).enumerate() {
                let block = first + block;
                let start = block * BLOCK;
                let width = BLOCK.min(columns - start);
                let pairs = width.div_ceil(2);
                let buffer = &mut memory[..width * mx];
                for (number, kept) in numbers.clone().zip(parts.chunks_exact_mut(block_rows)) {
                    for (set, (weight, kernels)) in sets.iter().enumerate() {
                        let odd = kernels.odd(number);
                        let terms = transform.columns(kernels, [block, number], pairs, folded, fft);
                        let (terms, _) = terms.as_chunks::<2>();
                        let folded = folded.chunks_exact(length).zip(terms);
                        let data = input.0[start * mx..].chunks(2 * mx);
                        let columns = buffer.chunks_mut(2 * mx).zip(data);
                        for ((columns, data), (y, term)) in columns.zip(folded) {
                            let term = Complex64::new(term[0], term[1]);
                            unfold_pair(y, odd[0], term, one, other);
                            let pairs = columns.chunks_exact_mut(mx).zip(data.chunks_exact(mx));
                            for ((column, data), values) in pairs.zip([&*one, &*other]) {
                                multiply_add(column, data, values, odd, *weight, set > 0);
                            }
                        }
                    }
                    self.column_inverse.process_with_scratch(buffer, fft);
                    scatter(buffer, mx, &mut kept[..nx]);
                }
            }
        };
        self.over_items(threads, blocks, size, scratches, multiply);
        self.rows_from_parts(blocks, [size, block_rows], outputs, scratches, threads);
    }
}

/// Sets `column` to weight · kernel · `data`, or adds this product where `add`. `values` is the lower
/// half of the kernel's column, less the factor i for each direction in which the kernel is odd.
pub(super) fn multiply_add(
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
    // Two odd directions give i² = −1; one gives i.
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

/// One kernel of a matrix: which output it makes of which input, and the sign.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Term<'a> {
    pub(crate) output: usize,
    pub(crate) input: usize,
    pub(crate) spectrum: &'a ParitySpectrum,
    pub(crate) sign: f64,
}

impl PaddedTransform {
    /// Writes to each output, (nx, ny) in C order, the sum over its `terms` of sign · kernel ∗ input.
    pub(crate) fn convolve_tensor(
        &self,
        terms: &[Term],
        inputs: &[&[f64]],
        outputs: &mut [&mut [f64]],
        workspace: &mut TransformMemory,
        threads: &Threads,
    ) {
        let (nx, mx) = (self.shape[0], self.padded[0]);
        let (columns, quarter_rows, blocks) = (self.columns(), self.quarter_rows(), self.blocks());
        let count = inputs.len().max(outputs.len());
        let part = self.block_rows();
        let size = count * part;
        let TransformMemory { mesh, scratches } = workspace;
        if mesh.len() < blocks * size {
            mesh.resize(blocks * size, [ZERO; BLOCK]);
        }
        let mesh = &mut mesh[..blocks * size];
        self.divided(threads, || {
            for (number, input) in inputs.iter().enumerate() {
                let (_, rows) = self.blocks_of(mesh, size).split(number * part);
                self.rows_into((input, 0..nx), rows, scratches, threads);
            }
        });
        let convolve = |first: usize, blocks: &mut [[Complex64; BLOCK]], scratch: &mut Scratch| {
            let length = BLOCK * mx;
            let needed = (inputs.len() + 1) * length;
            let memory = &mut scratch.columns;
            memory.resize(memory.len().max(needed), ZERO);
            let (data, sums) = memory[..needed].split_at_mut(inputs.len() * length);
            for (block, lines) in blocks.chunks_exact_mut(size).enumerate() {
                let start = (first + block) * BLOCK;
                let width = BLOCK.min(columns - start);
                for (data, lines) in data.chunks_exact_mut(length).zip(lines.chunks_exact(part)) {
                    let filled = width.next_multiple_of(COLUMN_GROUP) * mx;
                    gather(lines, 0..nx, mx, &mut data[..filled]);
                    self.column_forward
                        .process_with_scratch(&mut data[..width * mx], &mut scratch.fft);
                }
                for (number, lines) in lines.chunks_exact_mut(part).take(outputs.len()).enumerate()
                {
                    let mut add = false;
                    for term in terms.iter().filter(|term| term.output == number) {
                        let data = data[term.input * length..].chunks_exact(mx);
                        let values =
                            term.spectrum.values[start * quarter_rows..].chunks_exact(quarter_rows);
                        let sums = sums.chunks_exact_mut(mx).take(width);
                        for ((column, data), values) in sums.zip(data).zip(values) {
                            multiply_add(column, data, values, term.spectrum.odd, term.sign, add);
                        }
                        add = true;
                    }
                    let sums = &mut sums[..width * mx];
                    if !add {
                        sums.fill(ZERO);
                    }
                    self.column_inverse.process_with_scratch(sums, &mut scratch.fft);
                    scatter(sums, mx, &mut lines[..nx]);
                }
            }
        };
        self.over_items(threads, mesh, size, scratches, convolve);
        self.rows_from_parts(mesh, [size, part], outputs, scratches, threads);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::fft::tests::add_double_sum;
    use crate::numerics::layout::slice;
    use ndarray::Array2;

    /// Convolutions of each parity, and their sum, equal the double sum, for odd and even lengths.
    #[test]
    fn convolutions_of_every_parity_equal_the_double_sum() -> crate::Result<()> {
        let threads = Threads::new(Some(1))?;
        let parities = [[false, false], [true, false], [false, true], [true, true]];
        // Shapes, and the numbers of offsets between a loaded cell and any cell.
        let cases = [
            ([5, 4], [5, 4]),
            ([1, 7], [1, 7]),
            ([6, 1], [6, 1]),
            ([3, 8], [3, 8]),
            ([9, 40], [9, 40]),
            ([8, 40], [6, 24]),
        ];
        for ([nx, ny], offsets) in cases {
            let transform = PaddedTransform::plan_even([nx, ny], offsets, &threads);
            let mut workspace = transform.workspace();
            let loaded = |at: usize, n: usize, offsets: usize| (n - offsets..offsets).contains(&at);
            let input: Vec<f64> = (0..nx * ny)
                .map(|k| {
                    let inside = loaded(k / ny, nx, offsets[0]) && loaded(k % ny, ny, offsets[1]);
                    f64::from(u8::from(inside)) * ((k * k + 3) % 7) as f64
                })
                .collect();
            let transformed = transform.transform(&input, &mut workspace, &threads);
            let quarter = transform.quarter_transform();
            let mut exact = vec![0.0; nx * ny];
            let mut sets = Vec::new();
            for seed in 0..2 {
                let kernel = |k: usize| {
                    let values = (0..nx * ny).map(move |at| ((at + 2 * seed + k) % 5) as f64);
                    values.collect::<Vec<_>>()
                };
                let odd = parities[2 * seed..][..2].to_vec();
                let mut rows = transform.kernel_rows(offsets, odd.clone());
                let source = |rows: Range<usize>, keep: &mut Keep| {
                    for i in rows {
                        (0..2).for_each(|k| keep(i, k, &kernel(k)[i * ny..(i + 1) * ny]));
                    }
                };
                transform.transform_rows(&quarter, &mut rows, source, &mut workspace, &threads);
                let weight = 1.0 + seed as f64;
                sets.push((weight, rows));
                for (k, odd) in odd.into_iter().enumerate() {
                    add_double_sum(&mut exact, ny, weight, &input, &kernel(k), odd);
                }
            }
            let sets: Vec<_> = sets.iter().map(|(weight, rows)| (*weight, rows)).collect();
            let mut outputs = [vec![0.0; nx * ny], vec![0.0; nx * ny]];
            transform.convolve_parities(
                &transformed,
                (&quarter, &sets),
                0..2,
                &mut outputs.each_mut().map(Vec::as_mut_slice),
                &mut workspace,
                &threads,
            );
            for ((a, b), exact) in outputs[0].iter().zip(&outputs[1]).zip(&exact) {
                let value = a + b;
                // Rounding of a sum of some hundred numbers of at most 4 · 24.
                assert!((value - exact).abs() < 1e-11, "{nx} {ny}: {value} {exact}");
            }
        }
        Ok(())
    }

    /// A matrix of kernels of all parities equals the double sums, for odd and even lengths.
    #[test]
    fn a_matrix_of_kernels_equals_the_double_sums() -> crate::Result<()> {
        let threads = Threads::new(Some(1))?;
        for [nx, ny] in [[5, 4], [1, 7], [6, 1], [9, 40]] {
            let transform = PaddedTransform::plan([nx, ny], &threads);
            let mut workspace = transform.workspace();
            let kernel = |seed: usize| {
                Array2::from_shape_fn((nx, ny), |(i, j)| ((3 * i + 5 * j + seed) % 7) as f64)
            };
            let parities = [[false, false], [true, true], [true, false], [false, true]];
            let spectra: Vec<_> = parities
                .iter()
                .enumerate()
                .map(|(seed, odd)| {
                    transform.parity_spectrum(&kernel(seed), *odd, &mut workspace, &threads)
                })
                .collect();
            let inputs: Vec<Vec<f64>> = (0..2)
                .map(|k| (0..nx * ny).map(|at| ((at * at + k) % 5) as f64 - 1.0).collect())
                .collect();
            let terms = [(0, 0, 0, 1.0), (0, 1, 1, -2.0), (1, 0, 2, 1.0), (1, 1, 3, 0.5)];
            let chosen: Vec<_> = terms
                .iter()
                .map(|&(output, input, kernel, sign)| Term {
                    output,
                    input,
                    spectrum: &spectra[kernel],
                    sign,
                })
                .collect();
            let mut outputs = [vec![f64::NAN; nx * ny], vec![f64::NAN; nx * ny]];
            transform.convolve_tensor(
                &chosen,
                &[&inputs[0], &inputs[1]],
                &mut outputs.each_mut().map(Vec::as_mut_slice),
                &mut workspace,
                &threads,
            );
            for (number, output) in outputs.iter().enumerate() {
                let mut exact = vec![0.0; nx * ny];
                for &(_, input, k, sign) in terms.iter().filter(|term| term.0 == number) {
                    let kernel = kernel(k);
                    let values = &slice(&kernel);
                    add_double_sum(&mut exact, ny, sign, &inputs[input], values, parities[k]);
                }
                for (value, exact) in output.iter().zip(exact) {
                    assert!((value - exact).abs() < 1e-11, "{nx} {ny}: {value} {exact}");
                }
            }
        }
        Ok(())
    }
}
