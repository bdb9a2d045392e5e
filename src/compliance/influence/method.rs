//! Methods of computing influence coefficients.

use crate::model::grid::Grid;

/// Method by which the frequency response becomes influence coefficients.
///
/// Two relative errors are given for each, at the loaded cell and the largest at any offset, for
/// E1/E2 = 4, h = 8 dx on a square of 64² cells and χ = 4.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum Method {
    /// Closed forms, and radial tables of what they leave: no aliasing, for any thickness of layer
    /// and any shape of cell. Relative error below 1e-9.
    #[default]
    Exact,
    /// The response alone, sampled: a point load cut off at the Nyquist frequency. 7e-4 and 6e-2;
    /// goes wrong on long thin domains.
    Plain {
        /// Refinement χ of the spectral mesh.
        refinement: usize,
    },
    /// Love's closed form for the surface material, and the sampled rest of the response times the
    /// transform of the cell. 6e-4 and 4e-2; goes wrong on long thin domains, where the rest, which
    /// falls off like the substrate's 1/r, meets its periodic images (by 3 % at the loaded cell of
    /// the roller of Spinu et al.).
    Difference {
        /// Refinement χ of the spectral mesh.
        refinement: usize,
    },
    /// `Difference`, with an image potential in closed form that takes the rest's 1/α singularity. 1e-5
    /// and 1e-3; needs layers thicker than a cell.
    Image {
        /// Refinement χ of the spectral mesh.
        refinement: usize,
    },
    /// The response, sampled at the wave numbers of a grid that is periodic in both directions: exact for pressures that
    /// are sums of these waves, as other programs for periodic contacts take them.
    Spectral,
}

/// Bytes that the coefficients of a grid take.
pub(crate) fn memory(grid: &Grid) -> u64 {
    let [nx, ny] = grid.shape().map(|n| n as u64);
    8 * nx * ny
}
