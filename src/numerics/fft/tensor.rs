//! Convolution of several inputs with a matrix of kernels, each even or odd along x and along y.

use ndarray::{ArrayRef2, ArrayViewMut2, Axis};
use rustfft::num_complex::Complex64;

use super::parity::multiply_add;
use super::stages::{HalfSpectra, each_group, scatter};
use super::{BLOCK, PaddedTransform, Scratch, Workspace, ZERO};
use crate::numerics::parallel::Threads;

/// Spectrum of a kernel that is even or odd along each direction, scaled by 1/(mx my), less the factor i for each
/// direction in which it is odd. A quarter is stored, column by column.
#[derive(Debug)]
pub(crate) struct ParitySpectrum {
    values: Vec<f64>,
    odd: [bool; 2],
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
    /// Spectrum of the kernel with the values `quarter` (nx, ny) at offsets (i, j) ≥ 0, which is `odd` along x and
    /// along y or not.
    pub(crate) fn parity_spectrum(
        &self,
        quarter: &ArrayRef2<f64>,
        odd: [bool; 2],
        workspace: &mut Workspace,
        threads: &Threads,
    ) -> ParitySpectrum {
        let ([nx, _], [mx, my]) = (self.shape, self.padded);
        let (columns, quarter_rows) = (self.columns(), self.quarter_rows());
        let Workspace { mesh, scratches } = workspace;
        let rows = &mut mesh.as_flattened_mut()[..nx * columns];
        let [sign_x, sign_y] = odd.map(|odd| if odd { -1.0 } else { 1.0 });
        let part = |value: Complex64, odd: bool| if odd { value.im } else { value.re };
        let forward = |first: usize, rows: &mut [Complex64], scratch: &mut Scratch| {
            for (row, spectrum) in rows.chunks_exact_mut(columns).enumerate() {
                let real = &mut scratch.real[..my];
                real.fill(0.0);
                for (j, &c) in quarter.row(first + row).iter().enumerate() {
                    real[j] = c;
                    if j > 0 {
                        real[my - j] = sign_y * c;
                    }
                }
                self.rows_to_spectrum(real, spectrum, &mut scratch.fft);
            }
        };
        self.over_items(threads, rows, columns, scratches, forward);
        let rows = &*rows;
        let scale = 1.0 / self.points();
        let mut values = vec![0.0; columns * quarter_rows];
        let along = |first: usize, values: &mut [f64], scratch: &mut Scratch| {
            for (k, values) in values.chunks_exact_mut(quarter_rows).enumerate() {
                let column = &mut scratch.columns[..mx];
                column.fill(ZERO);
                for i in 0..nx {
                    let value = part(rows[i * columns + first + k], odd[1]);
                    column[i] = Complex64::new(value, 0.0);
                    if i > 0 {
                        column[mx - i] = Complex64::new(sign_x * value, 0.0);
                    }
                }
                self.column_forward
                    .process_with_scratch(column, &mut scratch.fft);
                for (value, wave) in values.iter_mut().zip(&*column) {
                    *value = part(*wave, odd[0]) * scale;
                }
            }
        };
        self.over_items(threads, &mut values, quarter_rows, scratches, along);
        ParitySpectrum { values, odd }
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
        let mut spectra = odd.map(|odd| ParitySpectrum {
            values: Vec::with_capacity(count),
            odd,
        });
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

    /// Writes to each output, (nx, ny) in C order, the sum over its `terms` of sign · kernel ∗ input.
    pub(crate) fn convolve_tensor(
        &self,
        terms: &[Term],
        inputs: &[&[f64]],
        outputs: &mut [&mut [f64]],
        workspace: &mut Workspace,
        threads: &Threads,
    ) {
        let ([nx, ny], mx) = (self.shape, self.padded[0]);
        let (columns, quarter_rows, blocks) = (self.columns(), self.quarter_rows(), self.blocks());
        let count = inputs.len().max(outputs.len());
        let part = self.block_rows();
        let size = count * part;
        let Workspace { mesh, scratches } = workspace;
        if mesh.len() < blocks * size {
            mesh.resize(blocks * size, [ZERO; BLOCK]);
        }
        let mesh = &mut mesh[..blocks * size];
        let per_task = nx.div_ceil(self.tasks).max(1);
        self.divided(threads, || {
            for (number, input) in inputs.iter().enumerate() {
                let Ok(mut halves) = ArrayViewMut2::from_shape([blocks, size], &mut *mesh) else {
                    unreachable!("the mesh has space for all inputs");
                };
                let (_, halves) = halves.view_mut().split_at(Axis(1), number * part);
                let (rows, _) = HalfSpectra::of(halves).split(nx);
                let work = |first: usize, rows: HalfSpectra| {
                    self.some_rows_in(&input[first * ny..], rows, scratches);
                };
                each_group(rows, per_task, 0, &work);
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
                    for (b, column) in data.chunks_exact_mut(mx).take(width).enumerate() {
                        let (values, padding) = column.split_at_mut(nx);
                        let entries = values.iter_mut().zip(lines);
                        entries.for_each(|(value, line)| *value = line[b]);
                        padding.fill(ZERO);
                    }
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
                    self.column_inverse
                        .process_with_scratch(made, &mut scratch.fft);
                    scatter(made, mx, &mut lines[..nx]);
                }
            }
        };
        self.over_items(threads, mesh, size, scratches, convolve);
        let mesh = &*mesh;
        for (number, output) in outputs.iter_mut().enumerate() {
            let inverse = |first: usize, output: &mut [f64], scratch: &mut Scratch| {
                let blocks = mesh.chunks_exact(size);
                let parts = blocks.map(|block| &block[number * part..]);
                self.rows_from_blocks(parts, first, output, scratch);
            };
            self.over_items(threads, output, ny, scratches, inverse);
        }
    }
}

#[cfg(test)]
mod tests {
    use ndarray::Array2;

    use super::*;

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
                .map(|k| {
                    (0..nx * ny)
                        .map(|at| ((at * at + k) % 5) as f64 - 1.0)
                        .collect()
                })
                .collect();
            let terms = [
                (0, 0, 0, 1.0),
                (0, 1, 1, -2.0),
                (1, 0, 2, 1.0),
                (1, 1, 3, 0.5),
            ];
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
                for (at, found) in output.iter().enumerate() {
                    let mut exact = 0.0;
                    for &(_, input, k, sign) in terms.iter().filter(|term| term.0 == number) {
                        for (from, value) in inputs[input].iter().enumerate() {
                            let side = |a: usize, b: usize, odd: bool| match a.cmp(&b) {
                                _ if !odd => 1.0,
                                std::cmp::Ordering::Less => -1.0,
                                std::cmp::Ordering::Equal => 0.0,
                                std::cmp::Ordering::Greater => 1.0,
                            };
                            let ([i, j], [k0, l0]) = ([at / ny, at % ny], [from / ny, from % ny]);
                            let c = kernel(k)[[i.abs_diff(k0), j.abs_diff(l0)]];
                            let [odd_x, odd_y] = parities[k];
                            exact += sign * side(i, k0, odd_x) * side(j, l0, odd_y) * c * value;
                        }
                    }
                    assert!((found - exact).abs() < 1e-11, "{nx} {ny}: {found} {exact}");
                }
            }
        }
        Ok(())
    }
}
