//! Convolution of one input with several kernels, each even or odd along x and along y.

use std::ops::Range;

use rustfft::num_complex::Complex64;

use super::cosine::unfold_pair;
use super::quarter::{KernelRows, QuarterTransform};
use super::stages::scatter;
use super::{BLOCK, PaddedTransform, Scratch, Workspace, ZERO};
use crate::numerics::parallel::Threads;

/// The half spectrum of padded data, scaled by 1/(mx my) and stored column after column.
#[derive(Debug)]
pub(crate) struct Transformed(Vec<Complex64>);

impl PaddedTransform {
    /// Transforms `input` (nx, ny) in C order.
    pub(crate) fn transform(
        &self,
        input: &[f64],
        workspace: &mut Workspace,
        threads: &Threads,
    ) -> Transformed {
        let nx = self.shape[0];
        let (mx, columns) = (self.padded[0], self.columns());
        let Workspace { mesh, scratches } = workspace;
        let rows = &mut mesh.as_flattened_mut()[..nx * columns];
        self.rows_forward(input, rows, scratches, threads);
        let rows = &*rows;
        let scale = 1.0 / (mx as f64 * self.padded[1] as f64);
        let mut spectrum = vec![ZERO; columns * mx];
        let along = |first: usize, part: &mut [Complex64], scratch: &mut Scratch| {
            for (l, column) in part.chunks_exact_mut(mx).enumerate() {
                for (i, value) in column[..nx].iter_mut().enumerate() {
                    *value = rows[i * columns + first + l] * scale;
                }
                self.column_forward
                    .process_with_scratch(column, &mut scratch.fft);
            }
        };
        self.over_items(threads, &mut spectrum, mx, scratches, along);
        Transformed(spectrum)
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
        workspace: &mut Workspace,
        threads: &Threads,
    ) {
        let [nx, ny] = self.shape;
        let mx = self.padded[0];
        let (columns, quarter_rows) = (self.columns(), self.quarter_rows());
        let Workspace { mesh, scratches } = workspace;
        let block_rows = self.block_rows();
        let size = numbers.len() * block_rows;
        mesh.resize(mesh.len().max(self.blocks() * size), [ZERO; BLOCK]);
        let blocks = &mut mesh[..self.blocks() * size];
        let multiply = |first: usize, blocks: &mut [[Complex64; BLOCK]], scratch: &mut Scratch| {
            let Scratch {
                real,
                columns: memory,
                fft,
                ..
            } = scratch;
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

        let blocks = &*blocks;
        for (k, output) in outputs.iter_mut().enumerate() {
            let inverse = |first: usize, output: &mut [f64], scratch: &mut Scratch| {
                let blocks = blocks.chunks_exact(size);
                let parts = blocks.map(|block| &block[k * block_rows..]);
                self.rows_from_blocks(parts, first, output, scratch);
            };
            self.over_items(threads, output, ny, scratches, inverse);
        }
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

#[cfg(test)]
mod tests {
    use super::super::quarter::Keep;
    use super::*;

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
                let side = |a: usize, b: usize, odd: bool| {
                    let sign = if !odd {
                        1.0
                    } else {
                        (a > b) as u8 as f64 - (a < b) as u8 as f64
                    };
                    (a.abs_diff(b), sign)
                };
                for (k, odd) in odd.into_iter().enumerate() {
                    let values = kernel(k);
                    for (at, sum) in exact.iter_mut().enumerate() {
                        for (from, value) in input.iter().enumerate() {
                            let (i, sx) = side(at / ny, from / ny, odd[0]);
                            let (j, sy) = side(at % ny, from % ny, odd[1]);
                            *sum += weight * sx * sy * values[i * ny + j] * value;
                        }
                    }
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
}
