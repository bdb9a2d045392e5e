//! Stress and displacement below the surface, under the pressure of a contact and its friction.
//!
//! ```text
//! σ[i, j] = Σ_kl K[i−k, j−l; z] p[k, l]
//! ```
//!
//! K are influence coefficients at depth z, without aliasing: closed forms of a half-space of the
//! material at that depth, and exact transforms of what the layers add. Both fall off as in an
//! infinite body: a larger domain changes nothing, and the error does not depend on how deep or how
//! thick a layer is. It is below 1e-8 of the pressure (`tests/stress/closed_forms.rs`). The sum is one
//! discrete convolution for each component: Liu, Wang & Liu, Wear 243 (2000) 101,
//! doi:10.1016/S0043-1648(00)00427-0.
//!
//! The remaining error comes from how pressure is distributed within a cell. [`stress`] takes it as
//! uniform. For a solved contact, [`Solution::stress`](crate::Solution::stress) reconstructs it
//! (`stress/subcell.rs`): parabolic in the interior, with a square-root profile near a smooth edge,
//! and uniform where the edge is not known. Tractions at the surface stay those of the solution's
//! pressure, and displacements are those of uniform cells.
//!
//! The reconstruction, the transforms and the spectrum of the layered body depend on the body and the
//! pressure alone. A [`StressPlan`] makes them once; it is then evaluated for any depths, sections,
//! friction and residual stress. The functions here and those of `Solution` make a plan for one call.
//!
//! Sliding adds the traction q = μ p along a direction; its effect on the pressure is neglected. That
//! is exact where both bodies have the same elastic constants or ν = ½, and a good approximation for
//! small μ: the neglected coupling changes the pressure by the order of μ (1 − 2ν)/(2 − 2ν). See
//! Johnson, Contact Mechanics (1985), chapter 7, doi:10.1017/CBO9781139171731.

use std::ops::ControlFlow;

use ndarray::ArrayRef2;

use crate::error::Result;
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;

mod derived;
mod ends;
mod field;
mod friction;
mod half_space;
mod member;
mod options;
mod plan;
mod request;
mod section;
mod subcell;
mod summary;

pub use derived::Peak;
pub(crate) use derived::Tensor;
pub use field::Stress;
pub use member::Member;
pub use options::{Section, Side, StressOptions, StressProgress};
pub use plan::StressPlan;
pub use summary::{InterfaceSummary, LayerSummary, Strengths, StressSummary};

pub(crate) use request::Weights;

use half_space::Source;
use request::stress_once;

/// Stress of `body` at `depths` under `pressure` (nx, ny) \[Pa\] on `grid`, uniform over each cell.
///
/// For a solved contact, [`Solution::stress`](crate::Solution::stress) also reconstructs the pressure
/// within cells. To evaluate one pressure several times, make a [`StressPlan`].
///
/// # Errors
/// Bad input, or too little memory.
///
/// ```
/// use ndarray::array;
/// use nacre::{Elastic, Grid, StressOptions, stress};
/// // Under the middle of a uniformly loaded square of side 2: Love (1929), doi:10.1098/rsta.1929.0006.
/// let grid = Grid::new([2, 2], [2.0, 2.0])?;
/// let pressure = array![[1.0, 1.0], [1.0, 1.0]];
/// let options = StressOptions { section: nacre::Section::Y(0.0), ..StressOptions::default() };
/// let field = stress(&Elastic::new(1.0, 0.3)?.into(), &grid, &pressure, &[0.0, 1.0], &options)?;
/// assert!((field.zz()[[0, 0, 0]] + 1.0).abs() < 1e-12);
/// assert!(field.zz()[[1, 0, 0]] > -0.7);
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn stress(
    body: &HalfSpace,
    grid: &Grid,
    pressure: &ArrayRef2<f64>,
    depths: &[f64],
    options: &StressOptions,
) -> Result<Stress> {
    let mut progress = |_| ControlFlow::Continue(());
    stress_watched(body, grid, pressure, depths, options, &mut progress)
}

/// [`stress`] with a callback: `progress` is told the fraction done. When it breaks, the result holds
/// the depths finished so far.
///
/// # Errors
/// As [`stress`].
pub fn stress_watched(
    body: &HalfSpace,
    grid: &Grid,
    pressure: &ArrayRef2<f64>,
    depths: &[f64],
    options: &StressOptions,
    progress: &mut StressProgress,
) -> Result<Stress> {
    stress_once(
        &Source::uniform(body, grid, pressure),
        depths,
        options,
        progress,
    )
}
