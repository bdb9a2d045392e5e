//! Transforms of kernels that are even or odd along x and along y.
//!
//! Kernels are given at offsets ≥ 0 and transformed along each direction by a cosine or sine transform
//! of half the length, see [`super::cosine`]. Rows are transformed when they are computed. Columns are
//! transformed when they are needed, one block at a time, so that the full transform is never stored.

use std::f64::consts::PI;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use realfft::{RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftPlanner};

use super::cosine::{Angles, fold, fold_lines, unfold};
use super::{BLOCK, PaddedTransform, Scratch, Workspace, ZERO};
use crate::numerics::parallel::Threads;

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
    pub(super) fn odd(&self, kernel: usize) -> [bool; 2] {
        self.odd[kernel]
    }

    /// Row i of a kernel in a block of columns; zero beyond the given offsets.
    fn line(&self, [block, kernel]: [usize; 2], i: usize) -> &[f64; BLOCK] {
        let part = (block * self.odd.len() + kernel) * self.rows_per_task;
        self.starts
            .get(i)
            .map_or(&[0.0; BLOCK], |start| &self.values[start + part])
    }
}

impl QuarterTransform {
    pub(super) fn new(padded: [usize; 2]) -> Self {
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
    pub(super) fn column_length(&self) -> usize {
        self.angles[0].sin.len() + 1
    }

    /// Transforms the columns of one block of a kernel into `folded`, two columns as one complex
    /// sequence, and returns the term 1 of each column, which [`unfold_pair`] needs.
    ///
    /// [`unfold_pair`]: super::cosine::unfold_pair
    pub(super) fn columns(
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
        let first = fold_lines(line, rows.odd[kernel][0], &self.angles[0], folded);
        fft.resize(fft.len().max(self.column.get_inplace_scratch_len()), ZERO);
        self.column.process_with_scratch(folded, fft);
        first
    }
}

impl PaddedTransform {
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
        workspace: &mut Workspace,
        threads: &Threads,
    ) {
        let KernelRows {
            offsets: [nx, ny],
            odd,
            rows_per_task,
            values,
            ..
        } = kernels;
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
}
