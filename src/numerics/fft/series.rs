//! Transforms that are used once and therefore have no plan.

use ndarray::{Array2, Axis};
use rayon::prelude::*;
use realfft::RealFftPlanner;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex64;

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
    let mut columns = Array2::zeros((my / 2 + 1, nx));
    let mut out = Array2::zeros((nx, ny));
    let scale = 1.0 / (mx as f64 * my as f64);
    threads.run(|| {
        even_lines(&mut columns, mx, 1.0, |l, k| value(k, l));
        even_lines(&mut out, my, scale, |i, l| columns[[l, i]]);
    });
    out
}

/// Transforms real and even sequences of `period` points, for which the forward transform equals the unscaled inverse
/// transform. `value(i, k)` returns the entries of row i at 0 ≤ k ≤ period/2.
fn even_lines(
    out: &mut Array2<f64>,
    period: usize,
    scale: f64,
    value: impl Fn(usize, usize) -> f64 + Sync,
) {
    let fft = FftPlanner::new().plan_fft_forward(period);
    let memory = || [period, fft.get_inplace_scratch_len()].map(|length| vec![ZERO; length]);
    out.axis_iter_mut(Axis(0)).into_par_iter().enumerate().for_each_init(
        memory,
        |[buffer, scratch], (i, mut row)| {
            for k in 0..=period / 2 {
                let entry = Complex64::new(value(i, k), 0.0);
                buffer[k] = entry;
                buffer[(period - k) % period] = entry;
            }
            fft.process_with_scratch(buffer, scratch);
            row.iter_mut().zip(&*buffer).for_each(|(to, from)| *to = from.re * scale);
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
