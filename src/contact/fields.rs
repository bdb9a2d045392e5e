//! The fields of a solution while it is found.

use ndarray::Array2;

use super::problem::{Problem, Quality};

/// Pressure, displacement and gap of a problem, and how good they are, once that was seen.
pub(super) struct Fields {
    pub(super) pressure: Array2<f64>,
    pub(super) displacement: Array2<f64>,
    pub(super) gap: Array2<f64>,
    pub(super) lambda: [f64; 3],
    pub(super) quality: Option<Quality>,
}

impl Fields {
    pub(super) fn new(shape: [usize; 2]) -> Self {
        Self {
            pressure: Array2::zeros(shape),
            displacement: Array2::zeros(shape),
            gap: Array2::zeros(shape),
            lambda: [0.0; 3],
            quality: None,
        }
    }

    /// Computes displacement, rigid motion, gap and quality of the pressure afresh. Where the contact
    /// does not determine a freedom, it stays as it is.
    pub(super) fn certify(&mut self, problem: &Problem) -> Quality {
        let p = slice(&self.pressure);
        let workspace = &mut problem.convolution.workspace();
        problem.apply(p, slice_mut(&mut self.displacement), workspace);
        let u = slice(&self.displacement);
        let near = self.lambda;
        let (lambda, quality) = problem.gap_into(p, u, near, slice_mut(&mut self.gap));
        self.lambda = lambda;
        self.quality = Some(quality);
        quality
    }
}

/// Values in C order as an array.
pub(super) fn array(shape: [usize; 2], values: Vec<f64>) -> Array2<f64> {
    Array2::from_shape_vec(shape, values).unwrap_or_else(|_| Array2::zeros(shape))
}

/// Arrays here are made in C order, and stay so.
pub(super) fn slice(array: &Array2<f64>) -> &[f64] {
    array.as_slice().unwrap_or(&[])
}

pub(super) fn slice_mut(array: &mut Array2<f64>) -> &mut [f64] {
    array.as_slice_mut().unwrap_or(&mut [])
}
