//! The pressures by which stresses near a free end are those of two half-spaces: the excess P − p on the surface,
//! and Q on the end face.

use std::f64::consts::PI;

use ndarray::{Array2, Axis};
use rayon::prelude::*;
use realfft::RealFftPlanner;
use rustfft::num_complex::Complex64;

use super::VANISHED;
use super::quarter_space::Nodes;
use super::reduction::{KernelProducts, Modes, Reduction};
use super::waves::{WaveRule, Width};
use crate::compliance::convolution::RowWeights;
use crate::numerics::fft::fast_length;

/// Where a pressure is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Where {
    /// P − p on the surface, by the distance from the end.
    Surface,
    /// Q on the end face, by the depth.
    Face,
}

/// Pressure on rows of cells at increasing distances from a free end.
#[derive(Debug)]
pub(crate) struct EndPressure {
    nodes: Nodes,
    /// Pressure on the nodes: (nodes, ny).
    values: Array2<f64>,
    /// Width of the cells along y.
    dy: f64,
}

impl EndPressure {
    /// The `pressure` on rows of cells of sides \[dx, dy\], of which the first has its centre at the distance
    /// `nearest` from the end.
    pub(crate) fn new(pressure: &Array2<f64>, nearest: f64, [dx, dy]: [f64; 2]) -> Self {
        let nodes = Nodes::new(nearest, dx, pressure.nrows());
        let mut values = Array2::zeros((nodes.distances.len(), pressure.ncols()));
        for (RowWeights { first, weights }, row) in nodes.rows.iter().zip(pressure.rows()) {
            for (k, weight) in weights.iter().enumerate() {
                values.row_mut(first + k).scaled_add(*weight, &row);
            }
        }
        Self { nodes, values, dy }
    }

    /// Means over `count` rows of cells from the end on, of length `spacing`, and over as many columns of cells as
    /// the pressure has and `margin` more on both sides, for a body with this Poisson's ratio. On the threads of the
    /// caller.
    pub(crate) fn spread(
        &self,
        place: Where,
        poisson: f64,
        spacing: f64,
        count: usize,
        margin: usize,
    ) -> Array2<f64> {
        let reduction = Reduction::of(poisson);
        let products = match place {
            Where::Surface => reduction.surface.products(),
            Where::Face => reduction.face.products(),
        };
        let targets = Nodes::new(0.5 * spacing, spacing, count);
        let width = self.values.ncols() + 2 * margin;
        let length = fast_length(self.values.ncols() + width);
        let kernel = self.kernel(products, &targets, length);
        let at_nodes = self.convolved(&kernel, targets.distances.len(), margin, length);
        let mut means = Array2::zeros((count, width));
        for (RowWeights { first, weights }, mut row) in targets.rows.iter().zip(means.rows_mut()) {
            for (k, weight) in weights.iter().enumerate() {
                row.scaled_add(*weight, &at_nodes.row(first + k));
            }
        }
        means
    }

    /// Pressure on each target node per pressure on each source node, by the distance along y: pairs (target,
    /// source), distances up to half the `length` of a transform.
    fn kernel(&self, products: &KernelProducts, targets: &Nodes, length: usize) -> Array2<f64> {
        let (dx, dy) = (self.nodes.spacing, self.dy);
        let along_y: Vec<f64> = (0..=length / 2).map(|l| l as f64 * dy).collect();
        let reach = along_y.last().copied().unwrap_or(0.0) + dy;
        // Means over cells leave amplitudes that fall as k⁻³; the rest is 1e-6 of the integral.
        let fallen = 3000.0 / (dx * targets.spacing * dy).cbrt();
        let first = self.nodes.distances[0] - 0.5 * dx;
        let highest = if first > 1e-9 * dx { fallen.min(VANISHED / first) } else { fallen };
        let waves = WaveRule::new(&along_y, Width::LoadAndMean(0.5 * dy), reach, highest);
        let (rows, columns) = (targets.distances.len(), self.nodes.distances.len());
        let mut amplitudes = Array2::zeros((waves.wavenumbers.len(), rows * columns));
        (amplitudes.axis_iter_mut(Axis(0)).into_par_iter()).zip(&waves.wavenumbers).for_each(
            |(mut row, &k)| {
                let here = means(&products.targets, targets, k);
                let there = means(&products.sources, &self.nodes, k);
                let of_pairs = here.dot(&there.t()) * (k * dx * dy / PI);
                row.iter_mut().zip(&of_pairs).for_each(|(a, b)| *a = *b);
            },
        );
        let weights = Array2::from_shape_fn((along_y.len(), waves.wavenumbers.len()), |(l, k)| {
            waves.weights[k][l]
        });
        amplitudes.t().dot(&weights.t())
    }

    /// Sums over all sources, on the target nodes.
    fn convolved(
        &self,
        kernel: &Array2<f64>,
        targets: usize,
        margin: usize,
        length: usize,
    ) -> Array2<f64> {
        let mut planner = RealFftPlanner::new();
        let forward = planner.plan_fft_forward(length);
        let inverse = planner.plan_fft_inverse(length);
        let transformed = |values: &mut dyn Iterator<Item = f64>| -> Vec<Complex64> {
            let mut padded: Vec<f64> = values.chain(std::iter::repeat(0.0)).take(length).collect();
            let mut waves = forward.make_output_vec();
            let done = forward.process(&mut padded, &mut waves);
            debug_assert!(done.is_ok(), "lengths are those of the plan");
            waves
        };
        let sources: Vec<Vec<Complex64>> = (self.values.rows().into_iter())
            .map(|row| transformed(&mut row.iter().copied()))
            .collect();
        let width = self.values.ncols() + 2 * margin;
        let mut sums = Array2::zeros((targets, width));
        (sums.axis_iter_mut(Axis(0)).into_par_iter()).enumerate().for_each(|(target, mut row)| {
            let mut total = inverse.make_input_vec();
            for (s, source) in sources.iter().enumerate() {
                let by_distance = kernel.row(target * sources.len() + s);
                let even = |l: usize| by_distance[l.min(length - l)];
                let factors = transformed(&mut (0..length).map(even));
                for ((sum, factor), wave) in total.iter_mut().zip(factors).zip(source) {
                    *sum += factor.re * wave;
                }
            }
            total[0].im = 0.0;
            if let Some(last) = total.last_mut()
                && length.is_multiple_of(2)
            {
                last.im = 0.0;
            }
            let mut values = inverse.make_output_vec();
            let done = inverse.process(&mut total, &mut values);
            debug_assert!(done.is_ok(), "lengths are those of the plan");
            for (j, sum) in row.iter_mut().enumerate() {
                *sum = values[(j + length - margin) % length] / length as f64;
            }
        });
        sums
    }
}

/// Means of functions of kx over the cells of all nodes: (nodes, functions).
fn means(modes: &Modes, nodes: &Nodes, k: f64) -> Array2<f64> {
    let mut means = Array2::zeros((nodes.distances.len(), modes.count()));
    for (&distance, mut row) in nodes.distances.iter().zip(means.rows_mut()) {
        row.assign(&nodes.mean(modes, k, distance));
    }
    means
}
