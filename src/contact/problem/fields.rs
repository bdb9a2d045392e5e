//! The fields of a solution while it is found.

use ndarray::Array2;

use crate::contact::problem::patch::Patch;
use crate::contact::problem::{Multipliers, Problem, Quality};
use crate::model::grid::Window;
use crate::numerics::parallel::Rows;

/// Pressure and displacement of a problem, and their quality once it was checked.
pub(crate) struct Fields {
    pub(crate) pressure: Array2<f64>,
    /// Window outside which the pressure is zero.
    pub(crate) window: Window,
    pub(crate) displacement: Array2<f64>,
    /// Multipliers of the displacement, once it was computed.
    pub(crate) multipliers: Multipliers,
    pub(crate) quality: Option<Quality>,
}

impl Fields {
    /// Fields of zeros.
    ///
    /// The system hands out their memory as it is written, most of it when the memory of the iteration is
    /// free again.
    pub(crate) fn new(shape: [usize; 2], rows: &Rows) -> Self {
        let zeros = || Array2::zeros(shape);
        let (pressure, displacement) = rows.both(zeros, zeros);
        Self {
            pressure,
            window: [0..0, 0..0],
            displacement,
            multipliers: Multipliers::default(),
            quality: None,
        }
    }

    /// The gap.
    pub(crate) fn gap(&self, problem: &Problem) -> Vec<f64> {
        let mut g = vec![0.0; problem.gap.len()];
        problem.gap_into(slice(&self.displacement), self.multipliers, &mut g);
        g
    }

    /// The permanent indentation: −g of the cells at the hardness, 0 of the others.
    pub(crate) fn indentation(&self, problem: &Problem) -> Array2<f64> {
        let cells = self.gap(problem).into_iter().zip(&self.pressure).enumerate();
        let deeper = cells.map(|(k, (g, p))| match *p >= problem.bounds.limit(k) {
            true => (-g).max(0.0),
            false => 0.0,
        });
        array([self.pressure.nrows(), self.pressure.ncols()], deeper.collect())
    }

    /// Takes the pressure of a window that holds the window before.
    pub(crate) fn take(&mut self, patch: &Patch) {
        let columns = self.pressure.ncols();
        patch.paste(slice_mut(&mut self.pressure), columns);
        self.window = patch.window.clone();
    }

    /// Lowers displacement and approach, which is loaded, by `distance`; the gap stays.
    pub(crate) fn lower(&mut self, distance: f64) {
        self.displacement -= distance;
        self.multipliers.base[0] -= distance;
    }

    /// Computes displacement, rigid motion and quality of the pressure afresh. Degrees of freedom that the
    /// contact does not determine stay as they are in `near`.
    pub(crate) fn certify(&mut self, problem: &Problem, near: [f64; 3]) -> Quality {
        let (p, window) = (slice(&self.pressure), &self.window);
        let workspace = &mut problem.convolution.workspace();
        let u = slice_mut(&mut self.displacement);
        let (multipliers, quality) = problem.judge(p, window, u, near, workspace);
        self.multipliers = multipliers;
        self.quality = Some(quality);
        quality
    }
}

/// Values in C order as an array.
pub(crate) fn array(shape: [usize; 2], values: Vec<f64>) -> Array2<f64> {
    Array2::from_shape_vec(shape, values).unwrap_or_else(|_| Array2::zeros(shape))
}

/// The values of an array that was made in C order.
pub(crate) fn slice(array: &Array2<f64>) -> &[f64] {
    array.as_slice().unwrap_or(&[])
}

/// The values of an array that was made in C order, to be written.
pub(crate) fn slice_mut(array: &mut Array2<f64>) -> &mut [f64] {
    array.as_slice_mut().unwrap_or(&mut [])
}
