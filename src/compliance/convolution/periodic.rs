//! Periodic stand-ins for a convolution on a window: a quarter of its cost, and easy to invert.
//!
//! On a periodic mesh, offsets of more than half a period take the coefficients of their images: Vollebregt, J.
//! Comput. Phys. 257 (2014) 333, doi:10.1016/j.jcp.2013.10.005. For pressures on a part C of the mesh, the inverse
//! M of the periodic convolution P obeys M_CC ≥ (P_CC)⁻¹ (Schur complement), and is a good preconditioner where P_CC is
//! close to the exact convolution. On a mesh as large as the window, the images of cells near one edge are neighbours of
//! those near the other; on a mesh that is an eighth longer they are not, and contacts that fill the window take half as
//! many iterations. A longer mesh saves none.
//!
//! Springs c of the cells are a diagonal. M is then the inverse with their mean, between factors √((C₀ + c̄)/(C₀ + c)), where C₀ is
//! the influence of a cell on itself: exact where c is uniform, and the inverse of the diagonal where c is far above C₀. Developed
//! here; without the factors, springs of one half of a contact took up to six times the convolutions.
//!
//! The images bend the kernel at half a period. Under a hard coating on a soft body the displacement is so smooth, and
//! its response to short waves so small, that the bend is larger: entries of the spectrum become negative. There the
//! coefficients C are tapered and wrapped around,
//!
//! ```text
//! c[d] = w[d] C[d] + w[P − d] C[P − d]      w[d] = Σ t[i] t[i + d] / Σ t[i]²      t[i] = sin(π (i + ½)/n)
//! ```
//!
//! along each direction of n cells and period P. Each entry of the spectrum is then a Rayleigh quotient of
//! the convolution, for a wave with the envelope t: it lies between the smallest and the largest eigenvalue.
//! T. Chan, SIAM J. Sci. Stat. Comput. 9 (1988) 766, doi:10.1137/0909051, has t = 1, with which more of the
//! response to long waves gets into the entries of short ones. The envelope was chosen here.

use std::f64::consts::PI;
use std::sync::Arc;

use ndarray::{Array2, ArrayRef2, Axis};

use super::Convolution;
use crate::numerics::fft::PaddedTransform;

/// Approximations of a convolution on the same window, periodic on a mesh that is longer by [`MARGIN`]. Each
/// costs a quarter of an exact convolution.
pub(crate) struct Approximation {
    /// M, an approximation of the inverse, which preconditions: symmetric and positive definite.
    pub(crate) inverse: Convolution,
    /// An approximation of the convolution itself.
    pub(crate) periodic: Convolution,
}

/// Cells by which the mesh is longer than the window, as a share of it; see the head of this file.
pub(crate) const MARGIN: f64 = 0.125;

impl Convolution {
    /// Approximations of the convolution with `coefficients`. Along directions in which pressures repeat, the mesh has no
    /// margin; where they repeat along both, the approximation is the convolution itself.
    pub(crate) fn approximation(
        &self,
        coefficients: &ArrayRef2<f64>,
        repeats: [bool; 2],
    ) -> Approximation {
        // Bound on the smallest entry of the spectrum, as a share of the largest, so that the inverse
        // is positive for any coefficients, and rounding does not grow further.
        const FLOOR: f64 = 1e-6;
        // Smallest entry, relative to the response to the shortest waves, below which the mesh is not
        // trusted. Measured for coatings 0.1 to 1e5 times as hard as the body: above 0.95, or below 0.
        const TRUSTED: f64 = 0.5;
        let shape = [coefficients.nrows(), coefficients.ncols()];
        let transform = PaddedTransform::plan_margin(shape, MARGIN, repeats, &self.threads);
        let with = |coefficients: &ArrayRef2<f64>| {
            let (idle, clock) = (self.idle.clone(), Arc::clone(&self.clock));
            Self::with(coefficients, transform.clone(), &self.threads, idle, clock)
        };
        let raised = (repeats == [true; 2]).then(|| raised(coefficients));
        let mut tapered_coefficients = None;
        let mut coefficients = raised.as_deref().unwrap_or(coefficients);
        let mut periodic = with(coefficients);
        let [smallest, mut largest] = transform.extremes(&periodic.spectrum);
        if repeats != [true; 2]
            && smallest * transform.points() < TRUSTED * shortest_waves(coefficients)
        {
            coefficients = tapered_coefficients.insert(tapered(coefficients, transform.periods()));
            periodic = with(coefficients);
            [_, largest] = transform.extremes(&periodic.spectrum);
        }
        let mean = self.mean_spring();
        let uneven =
            |springs: &&Arc<[f64]>| springs.windows(2).any(|pair| (pair[0] - pair[1]).abs() > 0.0);
        let scale = self.springs.as_ref().filter(uneven).map(|springs| {
            let own = coefficients[[0, 0]];
            springs.iter().map(|c| ((own + mean) / (own + c)).sqrt()).collect()
        });
        let inverse = || transform.inverse_spectrum(&periodic.spectrum, mean, FLOOR * largest);
        let inverse = periodic.clock.during(inverse);
        periodic.springs.clone_from(&self.springs);
        let inverse = Self {
            spectrum: Arc::new(inverse),
            springs: None,
            scale,
            transform: transform.clone(),
            threads: Arc::clone(&self.threads),
            additions: Vec::new(),
            beside: Vec::new(),
            idle: periodic.idle.clone(),
            clock: Arc::clone(&periodic.clock),
            ..periodic
        };
        Approximation { inverse, periodic }
    }
}

/// Coefficients of a grid that repeats in both directions with a mean displacement, which they lack on an elastic base:
/// that of the longest wave. Under a given load it changes no pressure.
fn raised(coefficients: &ArrayRef2<f64>) -> Array2<f64> {
    let cells = coefficients.len() as f64;
    let wave = |axis: usize| {
        let lines = coefficients.sum_axis(Axis(1 - axis));
        let n = lines.len() as f64;
        let terms = lines.iter().enumerate();
        terms.map(|(i, c)| c * (2.0 * PI * i as f64 / n).cos()).sum::<f64>()
    };
    let mean = coefficients.sum();
    coefficients + (wave(0).max(wave(1)).max(mean) - mean) / cells
}

/// Weights w\[d\] of the offsets 0, …, n − 1 between `n` cells: with θ = π/n, the sum of the products of sines is
/// (1 − d/n) cos θd + sin θd / (n sin θ).
fn weights(n: usize) -> Vec<f64> {
    let (cells, angle) = (n as f64, PI / n as f64);
    let weight = |d: usize| match (d, d as f64) {
        (0, _) => 1.0,
        (_, d) => (1.0 - d / cells) * (angle * d).cos() + (angle * d).sin() / (cells * angle.sin()),
    };
    (0..n).map(weight).collect()
}

/// The `coefficients` tapered and wrapped around a mesh of these `periods`; offsets of more than half a period
/// are not read.
fn tapered(coefficients: &ArrayRef2<f64>, periods: [usize; 2]) -> Array2<f64> {
    let shape = [coefficients.nrows(), coefficients.ncols()];
    let weights = shape.map(weights);
    // The offset itself, and its image where cells are that far apart.
    let images = |k: usize, d: usize| {
        let image = (d > 0).then(|| periods[k] - d);
        [Some(d), image.filter(|&image| image < shape[k])]
    };
    Array2::from_shape_fn(shape, |(i, j)| {
        let mut sum = 0.0;
        for a in images(0, i).into_iter().flatten() {
            for b in images(1, j).into_iter().flatten() {
                sum += weights[0][a] * weights[1][b] * coefficients[[a, b]];
            }
        }
        sum
    })
}

/// The response to pressures that alternate from cell to cell in both directions, from the nearest cells.
fn shortest_waves(coefficients: &ArrayRef2<f64>) -> f64 {
    // Cells along each direction: enough for some per cent.
    const NEAREST: usize = 16;
    let alternating = |n: usize| -> Vec<f64> {
        let weights = weights(n.min(NEAREST)).into_iter().enumerate();
        let signed = weights.map(|(d, w)| match d {
            0 => w,
            _ if d.is_multiple_of(2) => 2.0 * w,
            _ => -2.0 * w,
        });
        signed.collect()
    };
    let [along_x, along_y] = [coefficients.nrows(), coefficients.ncols()].map(alternating);
    let rows = along_x.iter().zip(coefficients.rows());
    rows.map(|(a, row)| {
        let products = along_y.iter().zip(row).map(|(b, c)| b * c);
        a * products.sum::<f64>()
    })
    .sum()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use ndarray::Array2;

    use super::{Approximation, weights};
    use crate::compliance::convolution::Convolution;
    use crate::compliance::influence::{Method, influence_coefficients};
    use crate::error::Result;
    use crate::model::body::{HalfSpace, Layer};
    use crate::model::grid::Grid;
    use crate::model::material::Elastic;
    use crate::numerics::fft::PaddedTransform;

    /// The formula of the weights is the sum that defines them, to the rounding of some tens of terms.
    #[test]
    fn weights_are_products_of_envelopes() {
        for n in [1, 2, 3, 17, 40] {
            let t = |i: usize| (PI * (i as f64 + 0.5) / n as f64).sin();
            let sum = |d: usize| (0..n - d).map(|i| t(i) * t(i + d)).sum::<f64>();
            for (d, weight) in weights(n).into_iter().enumerate() {
                assert!((weight - sum(d) / sum(0)).abs() < 1e-14, "{n} {d}");
            }
        }
    }

    /// Under coatings 1 to 1e5 times as hard as the body, and 0.05 to 5 cells thick, all entries of the spectrum
    /// are positive, and on the whole mesh the inverse undoes the periodic convolution wherever they are above 1e-6 of
    /// the largest: to rounding, some 1e-15 of a field of 10, times 1e6.
    #[test]
    fn spectra_are_positive_under_hard_coatings() -> Result<()> {
        let on_whole_mesh = |part: Convolution| {
            let shape = part.transform.periods();
            let transform = PaddedTransform::plan_margin(shape, 0.0, [false; 2], &part.threads);
            Convolution { shape, transform, ..part }
        };
        let mut bounded = 0;
        for shape in [[24, 30], [40, 16]] {
            for ratio in [1.0, 66.0, 1e3, 1e5] {
                for thickness in [0.05, 0.5, 3.2, 5.0] {
                    let coating = Layer::new(Elastic::new(ratio, 0.25)?, thickness)?;
                    let body = HalfSpace::new(Elastic::new(1.0, 0.38)?, [coating])?;
                    let grid = Grid::new(shape, shape.map(|n| n as f64))?;
                    let coefficients = influence_coefficients(body, &grid, Method::Exact)?;
                    let convolution = Convolution::plan(&coefficients, Some(1))?;
                    let Approximation { inverse, periodic } =
                        convolution.approximation(&coefficients, [false; 2]);
                    let [smallest, largest] = periodic.transform.extremes(&periodic.spectrum);
                    assert!(smallest > 0.0, "{ratio} {thickness}: {smallest:e} {largest:e}");
                    if smallest < 1e-6 * largest {
                        bounded += 1;
                        continue;
                    }
                    let [periodic, inverse] = [periodic, inverse].map(on_whole_mesh);
                    let field = Array2::from_shape_fn(periodic.shape(), |(i, j)| {
                        ((7 * i + 3 * j + i * j) % 11) as f64
                    });
                    let apart = inverse.apply(&periodic.apply(&field)?)? - &field;
                    let apart = apart.fold(0.0_f64, |a, b| a.max(b.abs()));
                    assert!(apart < 1e-8, "{ratio} {thickness}: {apart:e}");
                }
            }
        }
        assert!(bounded < 8, "{bounded}");
        Ok(())
    }
}
