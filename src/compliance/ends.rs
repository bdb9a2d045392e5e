//! Free ends of bodies: what the surface of a body that ends does beyond that of a half-space.
//!
//! [`HalfSpace::with_ends`](crate::HalfSpace::with_ends) gives a body its ends. A contact then adds, to the influence
//! coefficients K of the half-space, those of the mirror image and of what keeps the end face free of traction: for
//! one end the exact solution of a quarter space, for two ends of one body that of a plate. They are symmetric and
//! positive, and cost less than the transforms beside which they are applied. The ends of layered bodies are a model.
//! [`Report::free_ends`](crate::Report::free_ends) says what was used, and its error.
//!
//! Stresses are those of two half-spaces, one below the surface and one below the end face.
//!
//! | file | what |
//! |---|---|
//! | `reduction` | the quarter space, reduced to the half-space: one linear equation for each Poisson's ratio |
//! | `mesh` | points along the wavenumber times the distance from the end |
//! | `waves` | integrals over the wavenumber along y |
//! | `bodies` | the ends of the bodies of a contact, on a grid |
//! | `layers` | the model of layered bodies |
//! | `plate` | two free ends of one body |
//! | `cells` | coefficients of cells, from nodes along x |
//! | `spread` | the pressures by which stresses near an end are those of half-spaces |
//! | `point` | the displacement at a point |
//! | `linear` | linear equations |

mod bodies;
mod cells;
mod layers;
mod mesh;
mod plate;
mod point;
mod reduction;
mod spread;
#[cfg(test)]
mod tests;
mod waves;

pub use bodies::FreeEnds;
pub(crate) use bodies::{Ends, check_carried};
pub(crate) use cells::node_rows;
pub use point::QuarterSpace;
pub(crate) use spread::{EndPressure, Where};

/// kx above which the excess of P over p is less than 1e-19 of it.
const VANISHED: f64 = 45.0;
