//! The fields of a solution while it is found.

use ndarray::Array2;

use crate::contact::cascade::patch::{Patch, Window};
use crate::contact::problem::{Multipliers, Problem, Quality};
use crate::parallel::Passes;

/// Pressure and displacement of a problem, and how good they are, once that was seen.
pub(crate) struct Fields {
    pub(crate) pressure: Array2<f64>,
    /// The pressure is zero outside it.
    pub(crate) window: Window,
    pub(crate) displacement: Array2<f64>,
    pub(crate) motion: Multipliers,
    pub(crate) quality: Option<Quality>,
}

impl Fields {
    /// The system hands out its memory as it is written, most of it when that of the iteration is no
    /// longer needed.
    pub(crate) fn new(shape: [usize; 2], passes: &Passes) -> Self {
        let zeros = || Array2::zeros(shape);
        let (pressure, displacement) = passes.both(zeros, zeros);
        Self {
            pressure,
            window: [0..0, 0..0],
            displacement,
            motion: Multipliers::default(),
            quality: None,
        }
    }

    /// Takes the pressure of a window that holds the one before.
    pub(crate) fn take(&mut self, patch: &Patch) {
        let columns = self.pressure.ncols();
        patch.paste(slice_mut(&mut self.pressure), columns);
        self.window = patch.window.clone();
    }

    /// Computes displacement, rigid motion and quality of the pressure afresh. Where the contact
    /// does not determine a freedom, it stays as in `near`.
    pub(crate) fn certify(&mut self, problem: &Problem, near: [f64; 3]) -> Quality {
        let (p, window) = (slice(&self.pressure), &self.window);
        let workspace = &mut problem.convolution.workspace();
        let u = slice_mut(&mut self.displacement);
        let (motion, quality) = problem.judge(p, window, u, near, workspace);
        self.motion = motion;
        self.quality = Some(quality);
        quality
    }
}

/// Values in C order as an array.
pub(crate) fn array(shape: [usize; 2], values: Vec<f64>) -> Array2<f64> {
    Array2::from_shape_vec(shape, values).unwrap_or_else(|_| Array2::zeros(shape))
}

/// Arrays here are made in C order, and stay so.
pub(crate) fn slice(array: &Array2<f64>) -> &[f64] {
    array.as_slice().unwrap_or(&[])
}

pub(crate) fn slice_mut(array: &mut Array2<f64>) -> &mut [f64] {
    array.as_slice_mut().unwrap_or(&mut [])
}
