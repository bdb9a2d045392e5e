//! Indentation by axisymmetric tips: exact, for any stack of layers, without a grid.
//!
//! A rigid tip of profile g(r) without friction is in contact up to r = a. With A1 = lim α û/p̂ of all bodies together,
//! E* = 2/A1, M(α) = α û/(p̂ A1) − 1, f = E*/π and p̂(α) = ∫₀^a φ(t) cos αt dt,
//!
//! ```text
//! φ(s) + 2/π ∫₀^a K(s,t) φ(t) dt = f [δ − F(s)]      K = ∫₀^∞ M cos αs cos αt dα      F = s ∫₀^s g'(r)/√(s²−r²) dr
//! P = 2π ∫ φ      p(r) = φ(a)/√(a²−r²) − ∫_r^a φ'(t)/√(t²−r²) dt      u(r) = A1 ∫₀^a φ/√(r²−t²) dt + A1 ∫₀^∞ M p̂ J₀(αr) dα
//! ```
//!
//! (Sneddon, Int. J. Eng. Sci. 3 (1965) 47, doi:10.1016/0020-7225(65)90019-4, for M = 0.) The solution is φ = δ φ₁ − φ_F,
//! that of a flat punch and that of the profile. With S = 2π ∫ φ₁, P = S δ − P_F; without adhesion the pressure ends at the
//! edge, φ(a) = 0; and the energy identity S' = 2π² φ₁(a)²/E* holds for every stack. The discretisation was derived here and is not published elsewhere.
//!
//! | file | what it holds |
//! |---|---|
//! | `tip` | profiles, and their F |
//! | `equation` | linear system and its two solutions; M of the bodies at the nodes of a quadrature, functions on the contact |
//! | `point`, `density` | states; pressure and displacement of a contact and of the cohesive zone around it |
//! | `adhesion` | kinds of adhesion |
//! | `change` | derivatives |
//! | `curve` | whole curves by interpolation |
//! | `indenter`, `pull_off` | states by radius, load and approach; pull-off and jump into contact |

mod adhesion;
mod curve;
mod derivatives;
mod equation;
mod indenter;
mod point;
mod pressure;
mod pull_off;
mod tip;

pub use adhesion::{Adhesion, Branch, Control};
pub use curve::Curve;
pub use derivatives::{Change, Held, Variable};
pub use equation::stack::{IndentParameter, Stack};
pub use indenter::{Apart, Indent};
pub use point::{IndentWarning, InteriorStress, Point, PullOff};
pub use tip::{Form, STEEPEST, Tip, TipParameter, slope_of};
