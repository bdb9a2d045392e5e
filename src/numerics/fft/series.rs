//! Transforms that are used once and therefore have no plan.

use std::sync::Arc;

use ndarray::Array2;
use rayon::prelude::*;
use realfft::RealFftPlanner;
use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftPlanner};

use super::ZERO;
use crate::numerics::parallel::Threads;

/// The corner (nx, ny) of the inverse transform of a real and even spectrum of (mx, my) points, both
/// even. `value(k, l)` returns the entries at 0 ≤ k ≤ mx/2 and 0 ≤ l ≤ my/2.
pub(crate) fn inverse_even(
    [nx, ny]: [usize; 2],
    [mx, my]: [usize; 2],
    value: impl Fn(usize, usize) -> f64 + Sync,
    threads: &Threads,
) -> Array2<f64> {
    let mut planner = FftPlanner::new();
    let (along_x, along_y) = (planner.plan_fft_forward(mx), planner.plan_fft_forward(my));
    let (half_x, half_y) = (mx / 2, my / 2);
    // For real and even data, the forward transform equals the unscaled inverse transform.
    let even = |fft: &Arc<dyn Fft<f64>>, buffer: &mut [Complex64], scratch: &mut Vec<Complex64>| {
        scratch.resize(fft.get_inplace_scratch_len(), ZERO);
        fft.process_with_scratch(buffer, scratch);
    };
    let mut columns = Array2::<f64>::zeros((half_y + 1, nx));
    let mut out = Array2::<f64>::zeros((nx, ny));
    let scale = 1.0 / (mx as f64 * my as f64);
    threads.run(|| {
        columns
            .axis_iter_mut(ndarray::Axis(0))
            .into_par_iter()
            .enumerate()
            .for_each_init(
                || (vec![ZERO; mx], Vec::new()),
                |(buffer, scratch), (l, mut column)| {
                    for k in 0..=half_x {
                        let entry = Complex64::new(value(k, l), 0.0);
                        buffer[k] = entry;
                        buffer[(mx - k) % mx] = entry;
                    }
                    even(&along_x, buffer, scratch);
                    column.iter_mut().zip(&*buffer).for_each(|(c, b)| *c = b.re);
                },
            );
        out.axis_iter_mut(ndarray::Axis(0))
            .into_par_iter()
            .enumerate()
            .for_each_init(
                || (vec![ZERO; my], Vec::new()),
                |(buffer, scratch), (i, mut row)| {
                    for l in 0..=half_y {
                        let entry = Complex64::new(columns[[l, i]], 0.0);
                        buffer[l] = entry;
                        buffer[(my - l) % my] = entry;
                    }
                    even(&along_y, buffer, scratch);
                    row.iter_mut()
                        .zip(&*buffer)
                        .for_each(|(c, b)| *c = b.re * scale);
                },
            );
    });
    out
}

/// Fourier coefficients c_m = 1/N Σ f_n e^{−2πi mn/N} of the `samples` f_n, at 0 ≤ m ≤ N/2, as pairs
/// of real and imaginary parts.
pub(crate) fn fourier_coefficients(mut samples: Vec<f64>) -> Vec<(f64, f64)> {
    let scale = 1.0 / samples.len() as f64;
    let fft = RealFftPlanner::new().plan_fft_forward(samples.len());
    let mut spectrum = fft.make_output_vec();
    let done = fft.process(&mut samples, &mut spectrum);
    debug_assert!(done.is_ok(), "the lengths are those of the plan");
    spectrum
        .iter()
        .map(|c| (c.re * scale, c.im * scale))
        .collect()
}
