//! Elastic contact of coated bodies.
//!
//! A shape is pressed by a centred or off-centre force into a half-space with any number of layers.
//! nacre computes the pressure p, the contact area, the approach δ and the tilts s:
//!
//! ```text
//! g = h + u(p) − δ − s_x x − s_y y ≥ 0      p ≥ 0      p g = 0      ∬ p {1, x, y} dA = W {1, e_x, e_y}
//! ```
//!
//! ```
//! use nacre::{Elastic, HalfSpace, Layer, Motion, Sphere, solve};
//!
//! let steel = Elastic::new(210e9, 0.3)?;
//! let dlc = Elastic::new(420e9, 0.3)?;
//! let body = HalfSpace::new(steel, [Layer::new(dlc, 40e-6)?])?;
//! let solution = solve(&Sphere::new(5e-3)?, &body, &Motion::load(100.0))?;
//! assert!((solution.load() / 100.0 - 1.0).abs() < 1e-12);
//! assert!(solution.peak_pressure() > 2.5e9);
//! # Ok::<(), nacre::Error>(())
//! ```
//!
//! # Modules
//!
//! The core solves the contact of coated bodies, as Spinu et al. do: frequency response, influence
//! coefficients, convolution by FFT, conjugate gradients. The rest stands on it. The modules form one
//! chain; each imports only from earlier ones.
//!
//! | module | contents |
//! |---|---|
//! | builders | methods `with_…` of options |
//! | error | [`mod@error`]: the error type |
//! | numerics | small dense systems, Fourier transforms, threads |
//! | model | [`material`], [`body`]: elastic materials, layers, half-spaces; [`grid`]: cells of uniform pressure; [`surface`]: undeformed shapes; [`hertz`]: closed forms for points, lines and ellipses |
//! | compliance | [`response`]: frequency response û(α)/p̂(α) of a body; [`influence`]: influence coefficients `C[i, j]`; [`convolution`]: displacement from pressure, by DC-FFT; [`traction`]: the same of tractions; [`ends`]: free ends of bodies |
//! | contact | [`contact`]: pressure from shape, load and moments |
//! | *on the core* | |
//! | conductance | [`conductance`]: heat or current through a solved contact |
//! | stress | [`mod@stress`]: stress and displacement below the surface |
//! | fatigue | [`fatigue`]: shakedown and multiaxial fatigue of a history of stresses |
//! | friction | [`friction`]: partial slip, histories and rolling |
//! | wear | [`wear`]: pressure, contact and depths as layers wear |
//! | indent | [`indent`]: indentation by axisymmetric tips, without a grid |
//! | gradient | [`gradient`]: derivatives of solved contacts |
//!
//! # Features
//!
//! `serde` reads and writes materials, bodies, grids, profiles, shapes and what is asked of the motion; values
//! are checked when they are read.
//!
//! # Conventions
//!
//! - Units are any consistent set; documentation and tests use m, N, Pa.
//! - Arrays are (nx, ny) in C order, with `[i, j]` at the cell centre
//!   x_i = center_x − lx/2 + (i + ½) dx; z points into the body.
//! - Pressure is positive in compression, displacement is positive into the body that it belongs to,
//!   and the gap is positive when open.
//! - The Fourier transform is f̂(m, n) = ∬ f e^{−i(mx+ny)} dx dy, with α = √(m² + n²). The discrete
//!   forward transform is unscaled, and the inverse divides by the number of points.

#[macro_use]
mod builders;
mod compliance;
pub mod conductance;
pub mod contact;
pub mod error;
pub mod fatigue;
pub mod friction;
pub mod gradient;
pub mod indent;
mod model;
mod numerics;
#[cfg(feature = "python")]
mod python;
pub mod stress;
pub mod wear;

pub use compliance::{convolution, ends, influence, response, traction};
pub use model::{body, grid, hertz, material, surface};

pub use body::{BodyParameter, HalfSpace, Interface, Layer, Spring, Substrate};
pub use compliance::graded::graded_layers;
pub use contact::{
    Algorithm, Case, Compliance, Contact, Discretisation, Hardness, Motion, Options, Report, Setup,
    Solution, Solver, Termination, Unestimated, Warning, solve,
};
pub use convolution::Convolution;
pub use error::{Error, Result};
pub use grid::{Axis, Grid};
pub use influence::Method;
pub use material::Elastic;
pub use response::{Body, Response};
pub use stress::{Member, Section, Side, Stress, StressOptions, StressPlan, stress};
pub use surface::shapes::*;
pub use surface::{LogarithmicProfile, SampledProfile, Superposition, Surface};
pub use traction::{TractionCoefficients, traction_coefficients};

/// The Rust program of the README, which runs as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
