//! Dry wear: what sliding takes off both bodies, step after step, until a layer is through.
//!
//! The depth w_i that is taken off body i grows with the sliding distance s by Archard's law, and the gap with it:
//!
//! ```text
//! dw_i/ds = κ_i v p      g = h + w_1 + w_2 + u(p) − δ − s_x x − s_y y
//! ```
//!
//! κ is the specific wear rate \[m²/N\] of the layer that is bare in a cell, v the slip of the cell per sliding distance. A step Δs
//! with the weight θ of its end (1: Euler's; ½: the trapezoidal rule) is the contact problem on springs,
//!
//! ```text
//! g = h + w + (1 − θ) κ v Δs p + [u(p') + θ κ v Δs p'] − … ≥ 0,   p' ≥ 0,   p' g = 0
//! ```
//!
//! symmetric and positive definite, so that no step is too long to be stable; explicit steps are, beyond 2 λ/κ, where λ is the
//! smallest eigenvalue of the influence coefficients in contact: about 4 dx/πE*κ. Archard, J. Appl. Phys. 24 (1953) 981,
//! doi:10.1063/1.1721448; the implicit step was derived here.
//!
//! | file | what |
//! |---|---|
//! | `rates` | wear rates over the depth of a body |
//! | `regrid` | larger grids, and depths on them |
//! | `thickness` | layers that are thinner where they are worn |
//! | `session` | steps, their control, and events |

mod rates;
mod regrid;
mod session;
mod thickness;

use ndarray::Array2;

use crate::contact::{Options, Solution};
use crate::friction::{FrictionOptions, Rolling, Step};
use crate::stress::Member;

pub use session::WearSession;

/// What slides how far, and what it wears.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Wear {
    /// Specific wear rates \[m²/N\] of body and counterbody: of the layers from the surface down and of the substrate, or one
    /// for all of them.
    pub rates: [Vec<f64>; 2],
    /// Where it slips. Default: everywhere as far as the bodies slide.
    pub slip: Slip,
    /// Ends of the steps \[m\] or \[cycles\].
    pub steps: WearSteps,
    /// How a step is made. Default: [`WearScheme::Trapezoidal`].
    pub scheme: WearScheme,
    /// What wear does to the elastic contact. Default: [`Thickness::Frozen`].
    pub thickness: Thickness,
    /// Whether to end where the first layer is through. Default: false.
    pub until_through: bool,
    /// Depths removed before from body and counterbody \[m\]. Default: none.
    pub initial: Option<[Array2<f64>; 2]>,
    /// Whether `initial` is the end of a history, which knows the layers that are through there. Default: false.
    pub goes_on: bool,
    /// Options of the solves, which have no springs.
    pub options: Options,
}

builders! {
    Wear {
        with_slip(slip: Slip),
        with_steps(steps: WearSteps),
        with_scheme(scheme: WearScheme),
        with_thickness(thickness: Thickness),
        with_until_through(until_through: bool),
        with_initial(initial: impl Into<Option<[Array2<f64>; 2]>>),
        with_goes_on(goes_on: bool),
        with_options(options: Options),
    }
}

impl Wear {
    /// Gross sliding over a `distance` \[m\], with steps that keep an error of 1e-3 of the peak pressure.
    pub fn sliding(rates: [Vec<f64>; 2], distance: f64) -> Self {
        Self {
            rates,
            slip: Slip::Everywhere,
            steps: WearSteps::Auto { end: distance, tolerance: 1e-3 },
            scheme: WearScheme::default(),
            thickness: Thickness::default(),
            until_through: false,
            initial: None,
            goes_on: false,
            options: Options::default(),
        }
    }
}

/// Where surfaces slip, per unit of the distance.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub enum Slip {
    /// Everywhere by 1: the distance is that of sliding.
    #[default]
    Everywhere,
    /// By so much in each cell, (nx, ny).
    Cells(Array2<f64>),
    /// As in one cycle of friction, whose steps are made twice; the slips of the second time count. The distance is in cycles.
    Cycle(Vec<Step>, FrictionOptions),
    /// As in a pass of steady rolling, which takes κ ∫ p |slip| off a whole track. The distance is in passes, and steps are explicit.
    Pass(Box<Rolling>, FrictionOptions),
}

/// The steps of a history.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum WearSteps {
    /// Steps that add an error of at most a `tolerance` to the pressure, up to the `end`: the root of its mean square within the
    /// contact, relative to the largest pressure of the history. Cells at the edge do not count: they join the contact at once.
    Auto {
        /// Distance of the last step.
        end: f64,
        /// Largest error of a step.
        tolerance: f64,
    },
    /// Steps that end at these distances, which increase.
    Ends(Vec<f64>),
}

/// How the pressure over a step is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum WearScheme {
    /// The mean of its start and its end: second order. Short waves that it does not resolve change sign from step to step
    /// and fade slowly.
    #[default]
    Trapezoidal,
    /// That of its end: first order, and all that is not resolved fades at once.
    Euler,
}

/// How thick the layers are in the elastic contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Thickness {
    /// As before wear.
    #[default]
    Frozen,
    /// The top layers of both bodies are thinner in each cell by what is worn there, to first order in the depth. Slips of
    /// friction, stiffness and stresses of the solutions stay those of layers as thick as before.
    #[cfg_attr(feature = "serde", serde(rename = "first order"))]
    FirstOrder,
}

/// A worn contact.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct WearState {
    /// Sliding distance \[m\], cycles or passes.
    pub distance: f64,
    /// Depths removed from body and counterbody (nx, ny) \[m\].
    pub depth: [Array2<f64>; 2],
    /// The contact; its gap has the wear in it.
    pub solution: Solution,
    /// Layers of which the first cell is through here.
    pub through: Vec<WearThrough>,
    /// Estimated error of the pressure by the steps until then, the largest of a cell relative to the peak.
    pub step_error: f64,
    /// Estimated error of the peak pressure by the length of the steps, relative to it.
    pub peak_error: f64,
    /// Whether pressures of cells rise and fall from step to step, as the trapezoidal rule makes them where steps are too long.
    pub rings: bool,
    /// Whether the end is where a layer is through, if one is: the search for that distance may end before it is there.
    pub settled: bool,
    /// Number of times that the grid has grown.
    pub regrids: usize,
    /// Why the step wore nothing, if it did not: by cycles of friction alone.
    pub idle: Option<Idle>,
}

/// Why a cycle of friction wears nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Idle {
    /// No cell in contact slips.
    Sticks,
    /// Cells slip when the steps are made for the first time, and no more the second time: the steps do not lead back.
    DoesNotReturn,
}

/// A layer is worn through at one place.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct WearThrough {
    /// Distance at which it is.
    pub distance: f64,
    /// Estimated error of the distance by the steps.
    pub error: f64,
    /// Centre of the cell.
    pub position: [f64; 2],
    /// Number of the layer, from the surface down.
    pub layer: usize,
    /// Whose layer it is.
    pub member: Member,
}
