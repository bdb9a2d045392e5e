//! A symmetric operator that is added to a convolution: it depends on the distance along y, and on both
//! places along x.
//!
//! ```text
//! u[i, j] = Σ_ab B[i, a] Σ_l A[a, b, |j−l|] Σ_k B[k, b] p[k, l]
//! ```
//!
//! B interpolates from a few nodes along x to the rows of cells. The sum over l is a product in the
//! Fourier domain, a symmetric matrix for each wavenumber.

use std::fmt;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

use ndarray::{Array2, Axis};
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex64;

use crate::numerics::fft::fast_length;
use crate::numerics::parallel::{Threads, each_chunk};

const ZERO: Complex64 = Complex64::new(0.0, 0.0);

/// Weights with which one row of cells is interpolated from consecutive nodes; none for a row that takes
/// no part.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct RowWeights {
    pub(crate) first: usize,
    pub(crate) weights: Vec<f64>,
}

/// Length of the transform along y of [`Addition::new`] for rows of `ny` cells, which is the period where the grid
/// `repeats`. A is taken at the distances 0 to half of it, in cells.
pub(crate) fn length(ny: usize, repeats: bool) -> usize {
    if repeats { ny } else { fast_length(2 * ny - 1) }
}

/// Index of the pair of nodes (a, b) in the triangle of all pairs.
pub(crate) fn pair(a: usize, b: usize) -> usize {
    let (low, high) = (a.min(b), a.max(b));
    high * (high + 1) / 2 + low
}

/// The operator B A Bᵀ.
#[derive(Clone)]
pub(crate) struct Addition {
    rows: Arc<Vec<RowWeights>>,
    /// Rows of all that the convolution has.
    window: Range<usize>,
    nodes: usize,
    length: usize,
    /// Transform of A over the inverse transform's factor: pairs of nodes, wavenumbers.
    spectrum: Arc<Array2<f64>>,
    /// A, for [`Addition::entry`], which few solves need.
    coefficients: Arc<OnceLock<Array2<f64>>>,
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
}

impl fmt::Debug for Addition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Addition({} nodes, length {})", self.nodes, self.length)
    }
}

/// Memory for one application.
#[derive(Debug, Default)]
pub(super) struct AdditionMemory {
    /// Values at the nodes, padded with zeros.
    values: Vec<f64>,
    spectra: Vec<Complex64>,
    products: Vec<Complex64>,
}

impl Addition {
    /// The operator for these `rows` with the `coefficients` A: pairs of nodes as [`pair`] counts them, distances up
    /// to half the [`length`].
    pub(crate) fn new(rows: Vec<RowWeights>, length: usize, coefficients: &Array2<f64>) -> Self {
        let mut planner = RealFftPlanner::new();
        let (forward, inverse) =
            (planner.plan_fft_forward(length), planner.plan_fft_inverse(length));
        let mut spectrum = Array2::zeros((coefficients.nrows(), length / 2 + 1));
        let (mut even, mut waves) = (vec![0.0; length], vec![ZERO; length / 2 + 1]);
        let mut scratch = vec![ZERO; forward.get_scratch_len()];
        let triples = coefficients.axis_iter(Axis(0));
        for (from, mut to) in triples.zip(spectrum.axis_iter_mut(Axis(0))) {
            for (l, value) in even.iter_mut().enumerate() {
                *value = from[l.min(length - l)] / length as f64;
            }
            let done = forward.process_with_scratch(&mut even, &mut waves, &mut scratch);
            debug_assert!(done.is_ok(), "lengths are those of the plan");
            to.iter_mut().zip(&waves).for_each(|(to, wave)| *to = wave.re);
        }
        let nodes = rows.iter().map(|row| row.first + row.weights.len());
        Self {
            nodes: nodes.max().unwrap_or(0),
            window: 0..rows.len(),
            rows: Arc::new(rows),
            length,
            spectrum: Arc::new(spectrum),
            coefficients: Arc::default(),
            forward,
            inverse,
        }
    }

    /// This operator on `rows` of those that it has; the rows may be shorter.
    pub(crate) fn on_rows(&self, rows: Range<usize>) -> Self {
        let first = self.window.start;
        Self { window: first + rows.start..first + rows.end, ..self.clone() }
    }

    /// Whether a row takes part.
    pub(crate) fn has(&self, row: usize) -> bool {
        !self.row(row).weights.is_empty()
    }

    fn row(&self, row: usize) -> &RowWeights {
        &self.rows[self.window.start + row]
    }

    /// Entry of the operator for cells of two rows at a `distance` along y.
    pub(crate) fn entry(&self, rows: [usize; 2], distance: usize) -> f64 {
        let coefficients = self.coefficients.get_or_init(|| self.inverted());
        let distance = distance.min(self.length - distance);
        let [here, there] = rows.map(|row| self.row(row));
        let mut sum = 0.0;
        for (k, a) in here.weights.iter().enumerate() {
            for (l, b) in there.weights.iter().enumerate() {
                sum += a * b * coefficients[[pair(here.first + k, there.first + l), distance]];
            }
        }
        sum
    }

    /// A, from all wavenumbers: pairs of nodes, distances.
    fn inverted(&self) -> Array2<f64> {
        let mut coefficients = Array2::zeros(self.spectrum.dim());
        let (mut even, mut waves) = (vec![0.0; self.length], vec![ZERO; self.length / 2 + 1]);
        let mut scratch = vec![ZERO; self.inverse.get_scratch_len()];
        let pairs = self.spectrum.axis_iter(Axis(0));
        for (from, mut to) in pairs.zip(coefficients.axis_iter_mut(Axis(0))) {
            waves.iter_mut().zip(from).for_each(|(wave, from)| *wave = from.into());
            let done = (self.inverse).process_with_scratch(&mut waves, &mut even, &mut scratch);
            debug_assert!(done.is_ok(), "lengths are those of the plan");
            to.iter_mut().zip(&even).for_each(|(to, value)| *to = *value);
        }
        coefficients
    }

    /// A Bᵀ p of the rows `occupied` of `input`, outside of which it is 0.
    pub(super) fn respond(
        &self,
        input: &[f64],
        occupied: Range<usize>,
        memory: &mut AdditionMemory,
        threads: &Threads,
    ) {
        let (length, waves) = (self.length, self.length / 2 + 1);
        let ny = input.len() / self.window.len().max(1);
        memory.values.resize(self.nodes * length, 0.0);
        memory.spectra.resize(self.nodes * waves, ZERO);
        memory.products.resize(self.nodes * waves, ZERO);
        let AdditionMemory { values, spectra, products } = memory;
        values.fill(0.0);
        for i in occupied {
            let RowWeights { first, weights } = self.row(i);
            let pressures = &input[i * ny..(i + 1) * ny];
            let nodes = values[first * length..].chunks_exact_mut(length);
            for (weight, node) in weights.iter().zip(nodes) {
                for (value, p) in node.iter_mut().zip(pressures) {
                    *value += weight * p;
                }
            }
        }
        let part = self.nodes.div_ceil(4 * threads.count()).max(1);
        let cells = self.nodes * self.nodes * waves;
        threads.run_inside(cells, || {
            let both: &mut [_] = &mut values
                .chunks_exact_mut(length)
                .zip(spectra.chunks_exact_mut(waves))
                .collect::<Vec<_>>();
            each_chunk(both, part, 0, &|_, nodes| {
                let mut scratch = vec![ZERO; self.forward.get_scratch_len()];
                for (values, spectrum) in nodes {
                    let done = (self.forward).process_with_scratch(values, spectrum, &mut scratch);
                    debug_assert!(done.is_ok(), "lengths are those of the plan");
                }
            });
            let spectra = &*spectra;
            let both: &mut [_] = &mut values
                .chunks_exact_mut(length)
                .zip(products.chunks_exact_mut(waves))
                .collect::<Vec<_>>();
            each_chunk(both, part, 0, &|chunk, nodes| {
                let mut scratch = vec![ZERO; self.inverse.get_scratch_len()];
                for (k, (values, product)) in nodes.iter_mut().enumerate() {
                    self.multiply(chunk * part + k, spectra, product);
                    // Rounding must not make these two complex.
                    product[0].im = 0.0;
                    if length.is_multiple_of(2) {
                        product[waves - 1].im = 0.0;
                    }
                    let done = (self.inverse).process_with_scratch(product, values, &mut scratch);
                    debug_assert!(done.is_ok(), "lengths are those of the plan");
                }
            });
        });
    }

    /// `product` of the matrices' row `a` with the `spectra` of all nodes.
    fn multiply(&self, a: usize, spectra: &[Complex64], product: &mut [Complex64]) {
        product.fill(ZERO);
        for (b, spectrum) in spectra.chunks_exact(product.len()).enumerate() {
            let matrix = self.spectrum.row(pair(a, b));
            for ((sum, factor), wave) in product.iter_mut().zip(matrix).zip(spectrum) {
                *sum += wave * factor;
            }
        }
    }

    /// Adds the interpolated response to rows of the output, from row `first` on.
    pub(super) fn add_rows(
        &self,
        first: usize,
        ny: usize,
        output: &mut [f64],
        memory: &AdditionMemory,
    ) {
        for (i, output) in output.chunks_exact_mut(ny).enumerate() {
            let row = self.row(first + i);
            let nodes = memory.values[row.first * self.length..].chunks_exact(self.length);
            for (weight, node) in row.weights.iter().zip(nodes) {
                for (u, value) in output.iter_mut().zip(node) {
                    *u += weight * value;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use ndarray::Array2;

    use super::{Addition, RowWeights, length, pair};
    use crate::compliance::convolution::Convolution;
    use crate::error::Result;

    const NODES: usize = 3;

    fn rows(count: usize) -> Vec<RowWeights> {
        let row = |i: usize| match i {
            0 => RowWeights::default(),
            1 => RowWeights { first: 0, weights: vec![1.0] },
            _ => RowWeights { first: 1, weights: vec![0.5 + i as f64, -0.25] },
        };
        (0..count).map(row).collect()
    }

    fn coefficient(a: usize, b: usize, distance: usize) -> f64 {
        (a + b + 1) as f64 / (1.0 + distance as f64) + ((a * b) as f64).cos()
    }

    /// Applications to whole fields, to some of the rows, and on a window are the sums that define the operator,
    /// to rounding: some 1e-15 of sums of 100.
    #[test]
    fn applications_are_sums() -> Result<()> {
        let cases =
            [[5, 7], [6, 8], [4, 1]].map(|shape| [false, true].map(|repeats| (shape, repeats)));
        for ([nx, ny], repeats) in cases.into_iter().flatten() {
            let length = length(ny, repeats);
            let distances = length / 2 + 1;
            let mut coefficients = Array2::zeros((pair(NODES - 1, NODES - 1) + 1, distances));
            for a in 0..NODES {
                for b in 0..=a {
                    for l in 0..distances {
                        coefficients[[pair(a, b), l]] = coefficient(a, b, l);
                    }
                }
            }
            let addition = Addition::new(rows(nx), length, &coefficients);
            for (first, height, width) in [(0, nx, ny), (1, nx - 2, ny.div_ceil(2))] {
                let plain = Convolution::plan(&Array2::zeros((height, width)), Some(2))?;
                let convolution = plain.plus(vec![addition.on_rows(first..first + height)]);
                let p = Array2::from_shape_fn((height, width), |(i, j)| {
                    ((7 * i + 3 * j + i * j) % 11) as f64 - 4.0
                });
                let displacement = convolution.apply(&p)?;
                let all = rows(nx);
                let weight = |i: usize, a: usize| {
                    let row = &all[first + i];
                    let k = a.checked_sub(row.first);
                    k.and_then(|k| row.weights.get(k)).copied().unwrap_or(0.0)
                };
                for ((i, j), u) in displacement.indexed_iter() {
                    let mut expected = 0.0;
                    for ((k, l), p) in p.indexed_iter() {
                        for a in 0..NODES {
                            for b in 0..NODES {
                                let apart = j.abs_diff(l);
                                let c = coefficient(a, b, apart.min(length - apart));
                                expected += weight(i, a) * c * weight(k, b) * p;
                            }
                        }
                    }
                    let scale = 1e-11 * expected.abs().max(1.0);
                    assert!((u - expected).abs() < scale, "{u} {expected}");
                    let entries: f64 = (p.indexed_iter())
                        .map(|((k, l), p)| convolution.added([i, j], [k, l]) * p)
                        .sum();
                    assert!((entries - expected).abs() < scale, "{entries} {expected}");
                }
            }
        }
        Ok(())
    }
}
