//! Fourier transforms of zero-padded real data, and convolutions with kernels of given parity.
//!
//! The forward transform is unscaled; the inverse divides by the number of points, here and
//! nowhere else. Rows of the padding are not transformed, in either direction: of a padded mesh
//! (mx, my), only nx rows are transformed along y, and no padding is stored.

use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use ndarray::{Array2, Axis};
use rayon::prelude::*;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftPlanner};

use crate::numerics::parallel::{Threads, each_chunk, number};

mod cosine;
mod parity;
mod spectrum;
mod stages;

pub(crate) use parity::{Keep, KernelRows, QuarterTransform, Term, Transformed};
pub(crate) use spectrum::{EvenSpectrum, ParitySpectrum};

/// Columns that are transformed together. Four complex numbers fill a cache line of 64 bytes, and
/// sixteen columns of a few thousand points stay in a second-level cache of 1 MiB or more. The value
/// was chosen by trial.
const BLOCK: usize = 16;

/// Rows whose entries in a block of columns are read or written together. They are two kilobytes of
/// contiguous memory; single rows lie on different pages, and each access would have to wait. The
/// value was chosen by trial.
const ROW_GROUP: usize = 8;

const ZERO: Complex64 = Complex64::new(0.0, 0.0);

/// The smallest length ≥ `n` of the form 2^a 3^b 5^c.
pub(crate) fn fast_length(n: usize) -> usize {
    let smooth = |mut m: usize| {
        for p in [2, 3, 5] {
            while m.is_multiple_of(p) {
                m /= p;
            }
        }
        m == 1
    };
    (n.max(1)..).find(|&m| smooth(m)).unwrap_or(n)
}

/// Transforms of (nx, ny) data, padded with zeros to (mx, my).
#[derive(Clone)]
pub(crate) struct PaddedTransform {
    shape: [usize; 2],
    padded: [usize; 2],
    tasks: usize,
    threads: usize,
    row_forward: Arc<dyn RealToComplex<f64>>,
    row_inverse: Arc<dyn ComplexToReal<f64>>,
    column_forward: Arc<dyn Fft<f64>>,
    column_inverse: Arc<dyn Fft<f64>>,
}

impl fmt::Debug for PaddedTransform {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "PaddedTransform({:?} in {:?})", self.shape, self.padded)
    }
}

/// Memory for one convolution at a time; it may be larger than a transform needs.
#[derive(Debug, Default)]
pub(crate) struct TransformMemory {
    /// Half spectra of rows, stored by rows or by blocks of columns.
    mesh: Vec<[Complex64; BLOCK]>,
    scratches: Scratches,
}

/// Working memory of the threads, one entry for each.
#[derive(Debug, Default)]
pub(crate) struct Scratches(Vec<Mutex<Scratch>>);

#[derive(Debug, Default)]
struct Scratch {
    real: Vec<f64>,
    /// Half spectra of a group of rows.
    spectra: Vec<Complex64>,
    columns: Vec<Complex64>,
    fft: Vec<Complex64>,
}

/// Number of tasks into which a transform of `shape` is divided.
fn tasks(shape: [usize; 2], threads: &Threads) -> usize {
    // Many more tasks than threads keep all threads busy until the last few tasks. The factor 16 was
    // chosen by trial.
    match threads.divide(shape[0] * shape[1]) {
        true => 16 * threads.count(),
        false => 1,
    }
}

/// Row capacity of a block of columns: `rows`, rounded up so that consecutive blocks lie an odd number
/// of pages plus one row apart. A power-of-two stride would put equal rows of all blocks into the same
/// few cache sets.
fn block_rows(rows: usize) -> usize {
    const PAGE: usize = 4096 / size_of::<[Complex64; BLOCK]>();
    let beyond = PAGE + 1;
    rows.saturating_sub(beyond).next_multiple_of(2 * PAGE) + beyond
}

impl PaddedTransform {
    /// Transforms padded to lengths ≥ 2n − 1, so that convolutions have no periodic images.
    pub(crate) fn plan(shape: [usize; 2], threads: &Threads) -> Self {
        Self::plan_repeated(shape, [false; 2], threads)
    }

    /// Transforms that are padded, but along directions that are `periodic`, with n as the period.
    pub(crate) fn plan_repeated(shape: [usize; 2], periodic: [bool; 2], threads: &Threads) -> Self {
        Self::with_periods(shape, shape.map(|n| 2 * n - 1), periodic, threads)
    }

    /// Transforms that are padded by the share `margin` of n. Convolutions are periodic, with n as the period along
    /// directions that are `periodic`, and the fast length ≥ (1 + margin) n along others.
    pub(crate) fn plan_margin(
        shape: [usize; 2],
        margin: f64,
        periodic: [bool; 2],
        threads: &Threads,
    ) -> Self {
        let longer = |n: usize| n + (margin * n as f64).ceil() as usize;
        Self::with_periods(shape, shape.map(longer), periodic, threads)
    }

    /// Transforms of fast lengths of at `least` so many points, but along directions that are `periodic`.
    fn with_periods(
        shape: [usize; 2],
        least: [usize; 2],
        periodic: [bool; 2],
        threads: &Threads,
    ) -> Self {
        let length = |k: usize| match periodic[k] {
            true => shape[k],
            false => fast_length(least[k]),
        };
        Self::on(shape, [length(0), length(1)], threads)
    }

    fn on(shape: [usize; 2], padded: [usize; 2], threads: &Threads) -> Self {
        let mut real = RealFftPlanner::new();
        let mut complex = FftPlanner::new();
        Self {
            shape,
            padded,
            tasks: tasks(shape, threads),
            threads: threads.count(),
            row_forward: real.plan_fft_forward(padded[1]),
            row_inverse: real.plan_fft_inverse(padded[1]),
            column_forward: complex.plan_fft_forward(padded[0]),
            column_inverse: complex.plan_fft_inverse(padded[0]),
        }
    }

    /// A copy of this transform for other threads.
    pub(crate) fn on_threads(&self, threads: &Threads) -> Self {
        Self { tasks: tasks(self.shape, threads), threads: threads.count(), ..self.clone() }
    }

    /// Cost of a transform, in arbitrary units: points of the mesh times their logarithm.
    pub(crate) fn work(&self) -> f64 {
        self.points() * self.points().ln()
    }

    /// Periods of the mesh, in cells.
    pub(crate) fn periods(&self) -> [usize; 2] {
        self.padded
    }

    /// Points of the mesh.
    pub(crate) fn points(&self) -> f64 {
        self.padded[0] as f64 * self.padded[1] as f64
    }

    /// Number of stored columns of the half spectrum.
    fn columns(&self) -> usize {
        self.padded[1] / 2 + 1
    }

    /// Number of stored rows of the quarter spectrum.
    fn quarter_rows(&self) -> usize {
        self.padded[0] / 2 + 1
    }

    fn blocks(&self) -> usize {
        self.columns().div_ceil(BLOCK)
    }

    /// Row capacity of a block of columns.
    fn block_rows(&self) -> usize {
        block_rows(self.shape[0])
    }

    /// Number of threads that can work at the same time.
    pub(crate) fn scratches(&self) -> usize {
        self.threads.min(self.tasks)
    }

    pub(crate) fn workspace(&self) -> TransformMemory {
        let mut workspace = TransformMemory::default();
        self.reserve(&mut workspace);
        workspace
    }

    /// Bytes by which the mesh of `workspace` is too small for this transform; all else is far smaller.
    pub(crate) fn missing(&self, workspace: &TransformMemory) -> u64 {
        let elements = self.blocks() * self.block_rows();
        (elements.saturating_sub(workspace.mesh.len()) * size_of::<[Complex64; BLOCK]>()) as u64
    }

    /// Enlarges `workspace` where it is too small for this transform.
    pub(crate) fn reserve(&self, workspace: &mut TransformMemory) {
        fn at_least<T: Clone>(memory: &mut Vec<T>, length: usize, zero: T) {
            if memory.len() < length {
                memory.resize(length, zero);
            }
        }
        let fft = self
            .column_forward
            .get_inplace_scratch_len()
            .max(self.column_inverse.get_inplace_scratch_len())
            .max(self.row_forward.get_scratch_len())
            .max(self.row_inverse.get_scratch_len());
        let TransformMemory { mesh, scratches: Scratches(scratches) } = workspace;
        at_least(mesh, self.blocks() * self.block_rows(), [ZERO; BLOCK]);
        if scratches.len() < self.scratches() {
            scratches.resize_with(self.scratches(), Mutex::default);
        }
        for scratch in &mut scratches[..self.scratches()] {
            let scratch = scratch.get_mut().unwrap_or_else(PoisonError::into_inner);
            at_least(&mut scratch.real, self.padded[1], 0.0);
            at_least(&mut scratch.spectra, ROW_GROUP * self.blocks() * BLOCK, ZERO);
            at_least(&mut scratch.columns, BLOCK * self.padded[0], ZERO);
            at_least(&mut scratch.fft, fft, ZERO);
        }
    }

    /// Transforms one row of data, padded with zeros.
    fn data_to_spectrum(
        &self,
        values: &[f64],
        half: &mut [Complex64],
        real: &mut [f64],
        scratch: &mut [Complex64],
    ) {
        if values.iter().all(|&value| value == 0.0) {
            half.fill(ZERO);
            return;
        }
        let (data, padding) = real[..self.padded[1]].split_at_mut(values.len());
        data.copy_from_slice(values);
        padding.fill(0.0);
        self.rows_to_spectrum(&mut real[..self.padded[1]], half, scratch);
    }

    /// Working memory of the current thread. The lock is never contended, since a task never waits
    /// for another task while it holds the lock.
    fn scratch<'a>(&self, scratches: &'a Scratches) -> MutexGuard<'a, Scratch> {
        let scratch = &scratches.0[number() % self.scratches()];
        scratch.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Divides `data`, items of `size` elements each, into tasks, and calls `work` for each task with
    /// the index of its first item, its items, and the working memory of the thread.
    fn over_items<T: Send>(
        &self,
        threads: &Threads,
        data: &mut [T],
        size: usize,
        scratches: &Scratches,
        work: impl Fn(usize, &mut [T], &mut Scratch) + Sync + Send,
    ) {
        let per_task = (data.len() / size).div_ceil(self.tasks);
        self.over_tasks(threads, data, (size, per_task), scratches, work);
    }

    /// Divides `data`, items of `size` elements each, into tasks of `per_task` items, and calls `work`
    /// for each as [`Self::over_items`] does.
    fn over_tasks<T: Send>(
        &self,
        threads: &Threads,
        data: &mut [T],
        (size, per_task): (usize, usize),
        scratches: &Scratches,
        work: impl Fn(usize, &mut [T], &mut Scratch) + Sync + Send,
    ) {
        let work = |task: usize, part: &mut [T]| {
            work(task * per_task, part, &mut self.scratch(scratches));
        };
        self.divided(threads, || each_chunk(data, size * per_task, 0, &work));
    }

    /// Calls `work`, which divides itself into tasks, on `threads`; a single task runs on the calling
    /// thread.
    fn divided<R: Send>(&self, threads: &Threads, work: impl FnOnce() -> R + Send) -> R {
        if self.tasks == 1 { work() } else { threads.run(work) }
    }

    /// Transforms rows back along y into `values`, from row `first` on and as many as fit. `blocks` are
    /// the blocks of columns, already transformed back along x.
    fn rows_from_blocks<'a>(
        &self,
        blocks: impl Iterator<Item = &'a [[Complex64; BLOCK]]> + Clone,
        first: usize,
        values: &mut [f64],
        scratch: &mut Scratch,
    ) {
        let (ny, count) = (self.shape[1], self.blocks());
        for (group, values) in values.chunks_mut(ROW_GROUP * ny).enumerate() {
            let rows = first + group * ROW_GROUP..first + group * ROW_GROUP + values.len() / ny;
            let (spectra, _) = scratch.spectra.as_chunks_mut();
            for (block, lines) in blocks.clone().enumerate() {
                let spectra = spectra[block..].iter_mut().step_by(count);
                for (spectrum, line) in spectra.zip(&lines[rows.clone()]) {
                    *spectrum = *line;
                }
            }
            let spectra = scratch.spectra.chunks_exact_mut(count * BLOCK);
            for (spectrum, values) in spectra.zip(values.chunks_exact_mut(ny)) {
                let real = &mut scratch.real[..self.padded[1]];
                self.spectrum_to_rows(&mut spectrum[..self.columns()], real, &mut scratch.fft);
                values.copy_from_slice(&real[..ny]);
            }
        }
    }

    /// Transforms rows back along y into all `outputs`. A block of columns has `part` rows for each output, and `size` in
    /// all.
    fn rows_from_parts(
        &self,
        mesh: &[[Complex64; BLOCK]],
        [size, part]: [usize; 2],
        outputs: &mut [&mut [f64]],
        scratches: &Scratches,
        threads: &Threads,
    ) {
        for (number, output) in outputs.iter_mut().enumerate() {
            let inverse = |first: usize, output: &mut [f64], scratch: &mut Scratch| {
                let blocks = mesh.chunks_exact(size);
                let parts = blocks.map(|block| &block[number * part..]);
                self.rows_from_blocks(parts, first, output, scratch);
            };
            self.over_items(threads, output, self.shape[1], scratches, inverse);
        }
    }

    fn rows_to_spectrum(
        &self,
        real: &mut [f64],
        half: &mut [Complex64],
        scratch: &mut [Complex64],
    ) {
        let scratch = &mut scratch[..self.row_forward.get_scratch_len()];
        let done = self.row_forward.process_with_scratch(real, half, scratch);
        debug_assert!(done.is_ok(), "the lengths are those of the plan");
    }

    fn spectrum_to_rows(
        &self,
        half: &mut [Complex64],
        real: &mut [f64],
        scratch: &mut [Complex64],
    ) {
        // Real data have real entries there; rounding must not leave an imaginary part.
        half[0].im = 0.0;
        if self.padded[1].is_multiple_of(2) {
            half[self.padded[1] / 2].im = 0.0;
        }
        let scratch = &mut scratch[..self.row_inverse.get_scratch_len()];
        let done = self.row_inverse.process_with_scratch(half, real, scratch);
        debug_assert!(done.is_ok(), "the lengths are those of the plan");
    }
}

/// The corner (nx, ny) of the inverse transform of a real and even spectrum of (mx, my) points, both
/// even. `value(k, l)` returns the entries at 0 ≤ k ≤ mx/2 and 0 ≤ l ≤ my/2.
pub(crate) fn inverse_even(
    [nx, ny]: [usize; 2],
    [mx, my]: [usize; 2],
    value: impl Fn(usize, usize) -> f64 + Sync,
    threads: &Threads,
) -> Array2<f64> {
    inverse_corner([nx, ny], [mx, my], false, value, threads)
}

/// [`inverse_even`] of a spectrum that is odd along both directions.
pub(crate) fn inverse_odd(
    corner: [usize; 2],
    mesh: [usize; 2],
    value: impl Fn(usize, usize) -> f64 + Sync,
    threads: &Threads,
) -> Array2<f64> {
    // Two odd directions have the factor i² = −1.
    -inverse_corner(corner, mesh, true, value, threads)
}

fn inverse_corner(
    [nx, ny]: [usize; 2],
    [mx, my]: [usize; 2],
    odd: bool,
    value: impl Fn(usize, usize) -> f64 + Sync,
    threads: &Threads,
) -> Array2<f64> {
    let mut columns = Array2::zeros((my / 2 + 1, nx));
    let mut out = Array2::zeros((nx, ny));
    let scale = 1.0 / (mx as f64 * my as f64);
    threads.run(|| {
        parity_lines(&mut columns, mx, (1.0, odd), |l, k| value(k, l));
        parity_lines(&mut out, my, (scale, odd), |i, l| columns[[l, i]]);
    });
    out
}

/// Transforms real sequences of `period` points that are even, for which the forward transform equals the unscaled inverse
/// transform, or odd, for which it is −i times the result. `value(i, k)` returns the entries of row i at 0 ≤ k ≤ period/2.
fn parity_lines(
    out: &mut Array2<f64>,
    period: usize,
    (scale, odd): (f64, bool),
    value: impl Fn(usize, usize) -> f64 + Sync,
) {
    let fft = FftPlanner::new().plan_fft_forward(period);
    let memory = || [period, fft.get_inplace_scratch_len()].map(|length| vec![ZERO; length]);
    out.axis_iter_mut(Axis(0)).into_par_iter().enumerate().for_each_init(
        memory,
        |[buffer, scratch], (i, mut row)| {
            for k in 0..=period / 2 {
                let entry = Complex64::new(value(i, k), 0.0);
                buffer[(period - k) % period] = if odd { -entry } else { entry };
                buffer[k] = entry;
            }
            fft.process_with_scratch(buffer, scratch);
            let part = |value: &Complex64| if odd { -value.im } else { value.re };
            row.iter_mut().zip(&*buffer).for_each(|(to, from)| *to = part(from) * scale);
        },
    );
}

/// Fourier coefficients c_m = 1/N Σ f_n e^{−2πi mn/N} of the `samples` f_n, at 0 ≤ m ≤ N/2, as pairs
/// of real and imaginary parts.
pub(crate) fn fourier_coefficients(mut samples: Vec<f64>) -> Vec<(f64, f64)> {
    let scale = 1.0 / samples.len() as f64;
    let fft = RealFftPlanner::new().plan_fft_forward(samples.len());
    let mut spectrum = fft.make_output_vec();
    let done = fft.process(&mut samples, &mut spectrum);
    debug_assert!(done.is_ok(), "the lengths are those of the plan");
    spectrum.iter().map(|c| (c.re * scale, c.im * scale)).collect()
}

#[cfg(test)]
mod tests {

    /// Adds to `sums`, rows of `ny` cells, `weight` times the double sum of kernel and input. The kernel has these values at
    /// offsets ≥ 0.
    pub(super) fn add_double_sum(
        sums: &mut [f64],
        ny: usize,
        weight: f64,
        input: &[f64],
        kernel: &[f64],
        odd: [bool; 2],
    ) {
        let side = |a: usize, b: usize, odd: bool| match a.cmp(&b) {
            _ if !odd => 1.0,
            order => f64::from(order as i8),
        };
        for (at, sum) in sums.iter_mut().enumerate() {
            for (from, value) in input.iter().enumerate() {
                let ([i, j], [k, l]) = ([at / ny, at % ny], [from / ny, from % ny]);
                let entry = kernel[i.abs_diff(k) * ny + j.abs_diff(l)];
                *sum += weight * side(i, k, odd[0]) * side(j, l, odd[1]) * entry * value;
            }
        }
    }
}
