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
//! The modules form one chain; each imports from earlier ones only.
//!
//! | module | contents |
//! |---|---|
//! | [`mod@error`] | the error type |
//! | [`material`], [`body`] | elastic materials, layers, half-spaces |
//! | [`hertz`] | closed forms for points, lines and ellipses, equivalent radii |
//! | [`grid`], [`surface`] | cells of uniform pressure, undeformed shapes |
//! | [`response`] | frequency response û(α)/p̂(α) of a body |
//! | [`indent`] | indentation by axisymmetric tips, without a grid |
//! | [`influence`] | influence coefficients `C[i, j]` |
//! | [`convolution`] | displacement from pressure, by DC-FFT |
//! | [`ends`] | free ends of bodies |
//! | [`traction`] | influence coefficients of tractions, and their convolution |
//! | [`contact`] | pressure from shape, load and moments, by constrained conjugate gradients |
//! | [`mod@stress`] | stress and displacement below the surface |
//! | [`friction`] | partial slip, histories and rolling |
//! | [`gradient`] | derivatives of solved contacts |
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

pub mod error;

mod parallel;

mod dense;

pub mod material;

pub mod body;

pub mod hertz;

pub mod grid;

pub mod surface;

pub mod response;

mod graded;

mod fft;

mod kernel;

mod images;

pub mod indent;

pub mod influence;

pub mod convolution;

pub mod ends;

pub mod traction;

pub mod contact;

pub mod stress;

pub mod friction;

pub mod gradient;

#[cfg(feature = "serde")]
mod serial;

#[cfg(feature = "python")]
mod python;

pub use body::{BodyParameter, HalfSpace, Interface, Layer, Substrate};
pub use contact::{
    Algorithm, Case, Contact, Discretisation, Hardness, Motion, Options, Report, Setup, Solution,
    Solver, Termination, Warning, solve,
};
pub use convolution::Convolution;
pub use error::{Error, Result};
pub use graded::graded_layers;
pub use grid::Grid;
pub use influence::Method;
pub use material::Elastic;
pub use response::{Body, Response};
pub use stress::{Member, Section, Side, Stress, StressOptions, StressPlan, stress};
pub use surface::{
    Cylinder, FlatPunch, HeightMap, LogarithmicProfile, Paraboloid, Roller, SampledProfile, Sphere,
    Superposition, Surface,
};
pub use traction::{TractionCoefficients, traction_coefficients};

/// The Rust program of the README, which runs as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
