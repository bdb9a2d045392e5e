//! Convolution of several inputs with a matrix of kernels, each even or odd along x and along y.

use rustfft::num_complex::Complex64;

use super::parity::multiply_add;
use super::stages::{COLUMN_GROUP, gather, scatter};
use super::{BLOCK, PaddedTransform, ParitySpectrum, Scratch, Workspace, ZERO};
use crate::numerics::parallel::Threads;

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
        workspace: &mut Workspace,
        threads: &Threads,
    ) {
        let (nx, mx) = (self.shape[0], self.padded[0]);
        let (columns, quarter_rows, blocks) = (self.columns(), self.quarter_rows(), self.blocks());
        let count = inputs.len().max(outputs.len());
        let part = self.block_rows();
        let size = count * part;
        let Workspace { mesh, scratches } = workspace;
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
            let (data, made) = memory[..needed].split_at_mut(inputs.len() * length);
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
                        let made = made.chunks_exact_mut(mx).take(width);
                        for ((column, data), values) in made.zip(data).zip(values) {
                            multiply_add(column, data, values, term.spectrum.odd, term.sign, add);
                        }
                        add = true;
                    }
                    let made = &mut made[..width * mx];
                    if !add {
                        made.fill(ZERO);
                    }
                    self.column_inverse.process_with_scratch(made, &mut scratch.fft);
                    scatter(made, mx, &mut lines[..nx]);
                }
            }
        };
        self.over_items(threads, mesh, size, scratches, convolve);
        self.rows_from_parts(mesh, [size, part], outputs, scratches, threads);
    }
}

#[cfg(test)]
mod tests {
    use ndarray::Array2;

    use super::*;
    use crate::numerics::fft::tests::add_double_sum;

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
                    let values = kernel.as_slice().unwrap_or_default();
                    add_double_sum(&mut exact, ny, sign, &inputs[input], values, parities[k]);
                }
                for (found, exact) in output.iter().zip(exact) {
                    assert!((found - exact).abs() < 1e-11, "{nx} {ny}: {found} {exact}");
                }
            }
        }
        Ok(())
    }
}
