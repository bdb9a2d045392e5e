//! Transforms of kernels that are even or odd along x and along y.
//!
//! Only offsets ≥ 0 are given and transformed: along each direction a cosine or sine transform of
//! half the length, see [`super::cosine`]. Rows are transformed as they are made; columns where
//! they are needed, a block of them at a time, so that the transform as a whole is never stored.

use std::f64::consts::PI;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use realfft::{RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftPlanner};

use super::cosine::{Angles, fold, fold_lines, unfold};
use super::{BLOCK, PaddedTransform, Scratch, Workspace, ZERO};
use crate::parallel::Threads;

/// Takes row i of kernel k: (i, k, values).
pub(crate) type Keep<'a> = dyn FnMut(usize, usize, &[f64]) + 'a;

/// Cosine and sine transforms of half the padded lengths.
pub(crate) struct QuarterTransform {
    row: Arc<dyn RealToComplex<f64>>,
    column: Arc<dyn Fft<f64>>,
    /// Along x and along y.
    angles: [Angles; 2],
}

impl fmt::Debug for QuarterTransform {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [nx, ny] = self.angles.each_ref().map(|angles| angles.sin.len() + 1);
        write!(f, "QuarterTransform({nx} x {ny})")
    }
}

/// Some kernels at offsets (i, j) ≥ 0, transformed along y.
#[derive(Debug)]
pub(crate) struct KernelRows {
    /// Offsets along x and along y.
    offsets: [usize; 2],
    /// Of each kernel, whether it is odd along x and along y.
    odd: Vec<[bool; 2]>,
    /// How many rows one task makes.
    rows_of_a_task: usize,
    /// For each task, block of columns, and kernel: its rows.
    values: Vec<[f64; BLOCK]>,
    /// Where each row is, in the first block of the first kernel.
    starts: Vec<usize>,
}

impl KernelRows {
    /// How many kernels.
    pub(crate) fn count(&self) -> usize {
        self.odd.len()
    }

    pub(super) fn odd(&self, kernel: usize) -> [bool; 2] {
        self.odd[kernel]
    }

    /// Row i of a kernel within a block of columns; zero beyond the offsets that are given.
    fn line(&self, [block, kernel]: [usize; 2], i: usize) -> &[f64; BLOCK] {
        let part = (block * self.odd.len() + kernel) * self.rows_of_a_task;
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

    /// Points along x of a column's transform, less one.
    pub(super) fn column_length(&self) -> usize {
        self.angles[0].sin.len() + 1
    }

    /// Transforms the columns of one block of a kernel, in pairs, into `folded`; returns the
    /// term 1 of each, which is needed to unfold them.
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

    /// Memory for kernels of these parities along x and y, given at `offsets` along x and y.
    pub(crate) fn kernel_rows(&self, offsets: [usize; 2], odd: Vec<[bool; 2]>) -> KernelRows {
        let rows_of_a_task = offsets[0].div_ceil(self.tasks);
        let tasks = offsets[0].div_ceil(rows_of_a_task);
        let of_a_task = self.blocks() * odd.len() * rows_of_a_task;
        let start = |i: usize| i / rows_of_a_task * of_a_task + i % rows_of_a_task;
        KernelRows {
            offsets,
            odd,
            rows_of_a_task,
            values: vec![[0.0; BLOCK]; tasks * of_a_task],
            starts: (0..offsets[0]).map(start).collect(),
        }
    }

    /// Transforms kernels along y. `source` is called for ranges of rows, and gives each row of
    /// each kernel to its second argument.
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
            rows_of_a_task,
            values,
            ..
        } = kernels;
        let ([nx, ny], of_a_task) = ([*nx, *ny], *rows_of_a_task);
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
                debug_assert!(done.is_ok(), "lengths are the plan's own");
                unfold(half, odd[k][1], start, &mut line[..columns]);
                let (lines, _) = line.as_chunks::<BLOCK>();
                for (block, line) in lines.iter().enumerate() {
                    part[(block * count + k) * of_a_task + i - first] = *line;
                }
            };
            source(first..(first + of_a_task).min(nx), &mut keep);
        };
        let (size, scratches) = (self.blocks() * count, &workspace.scratches);
        self.over_tasks(threads, values, (size, of_a_task), scratches, work);
    }
}
