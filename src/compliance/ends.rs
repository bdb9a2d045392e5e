//! Free ends of bodies: what the surface of a body that ends does beyond that of a half-space.
//!
//! [`HalfSpace::with_ends`](crate::HalfSpace::with_ends) gives a body its ends. A contact then adds, to the influence
//! coefficients K of the half-space, those of the mirror image and of what keeps the end face free of traction: for
//! one end the exact solution of a quarter space, for two ends of one body that of a plate. They are symmetric and
//! positive, and cost less than the transforms beside which they are applied.
//! [`Report::free_ends`](crate::Report::free_ends) says what was used, and its error.
//!
//! Stresses are those of two half-spaces, one below the surface and one below the end face.
//!
//! The ends of layered bodies are a model that was derived here. The half-space under the even pressure P(|x|) is taken with its
//! layers, so that the mirror image is exact. What keeps the face free is that of the substrate, with a factor for each
//! wavenumber k along y,
//!
//! ```text
//! D_n^⅓ D_t^⅔        D_n = c11(k)/c11₀(k)        D_t = c22(k)/c22₀(k)
//! ```
//!
//! where c are the compliances of the layered surface and c₀ of the bare substrate. To free the face takes motion
//! along the surface rather than across it. The exponents were chosen by trial. With ν = 0.3 everywhere, one coating
//! up to 4 times as hard or as soft as the substrate, the displacement is within 3.2 % of a solution by finite elements
//! (`tests/compliance/ends.rs`), and within 9 % up to 10 times. Nearly incompressible soft coatings are the worst: 16 %.
//!
//! | file | what |
//! |---|---|
//! | `reduction` | the quarter space, reduced to the half-space: one linear equation for each Poisson's ratio |
//! | `waves` | integrals over the wavenumber along y |
//! | `quarter_space` | the displacement at a point, and coefficients of cells from nodes along x |
//! | `plate` | two free ends of one body |
//! | `bodies` | the ends of the bodies of a contact, on a grid |
//! | `spread` | the pressures by which stresses near an end are those of half-spaces |

use crate::compliance::response::{Compliance, alpha_compliance, substrate_material};
use crate::model::body::HalfSpace;

mod bodies;
mod plate;
mod quarter_space;
mod reduction;
mod spread;
#[cfg(test)]
mod tests;
mod waves;

pub use bodies::FreeEnds;
pub(crate) use bodies::{Ends, check_carried};
pub(crate) use quarter_space::Nodes;
pub use quarter_space::QuarterSpace;
pub(crate) use spread::{EndPressure, Where};

/// kx above which the excess of P over p is less than 1e-19 of it.
const VANISHED: f64 = 45.0;

/// Factor of what keeps the face free, at wavenumber `k`.
fn layers_factor(body: &HalfSpace, k: f64) -> f64 {
    let (Some(material), false) = (substrate_material(body), body.layers().is_empty()) else {
        return 1.0;
    };
    let (here, below) = (alpha_compliance(body, k), Compliance::homogeneous(material));
    (here.c11 / below.c11).cbrt() * (here.c22 / below.c22).cbrt().powi(2)
}

/// Largest error that was measured of what an end adds to the displacement of a body whose moduli have this ratio at most;
/// `None` where none was.
fn model_error(contrast: f64) -> Option<f64> {
    match contrast {
        mild if mild <= 4.0 => Some(0.04),
        high if high <= 10.0 => Some(0.09),
        _ => None,
    }
}

/// Share of what an end adds that is not known: all of it where no error was measured.
pub(crate) fn unknown_share(body: &HalfSpace) -> f64 {
    match body.layers().is_empty() {
        true => 0.0,
        false => model_error(contrast(body)).unwrap_or(1.0),
    }
}

/// Largest ratio of the moduli of a body, at least 1; 1 for a body without layers.
fn contrast(body: &HalfSpace) -> f64 {
    let layers = body.layers().iter().map(|layer| layer.material());
    let young = layers.chain(substrate_material(body)).map(|material| material.young());
    let [low, high] =
        young.fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], e| [low.min(e), high.max(e)]);
    if body.layers().is_empty() { 1.0 } else { (high / low).max(1.0 + f64::EPSILON) }
}
