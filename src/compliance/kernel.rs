//! Kernels: what a uniform load on one cell of the surface does at (x, y, z).
//!
//! Loads are a pressure and tractions along x and y; they make stress and displacement at any depth,
//! the surface included. Everything is the transform of a response in the wavenumber α,
//!
//! ```text
//! K(x, y, z) = 1/4π² ∬ D(α; z) · (powers of m/α, n/α) · transform of the cell · e^{i(mx + ny)} dm dn
//! ```
//!
//! and is computed as a closed form for a homogeneous half-space, plus a smooth remainder.
//!
//! | file | what it holds |
//! |---|---|
//! | `rectangle` | a homogeneous half-space under pressure and under traction on a rectangle; its potential 1/r |
//! | `quadrature` | Gauss rules; integrals over a cell, near and far |
//! | `series` | Hankel, sine and cosine transforms by Fourier series in ln α |
//! | `table` | tables of functions of the squared distance |
//! | `loads` | which transforms make which component under which load; point loads |
//! | `plane` | kernels of cells at one depth, also at all offsets of a grid; plans of these or of strips |
//! | `strip` | kernels of endless strips, for line contact |
//!
//! The displacement of the surface under pressure, for any response, is made of the same series, tables
//! and rules in `influence`.

pub(crate) mod loads;
pub(crate) mod plane;
pub(crate) mod quadrature;
pub(crate) mod rectangle;
pub(crate) mod series;
pub(crate) mod strip;
pub(crate) mod table;

/// Number of components: σxx, σyy, σzz, σxy, σyz, σxz, ux, uy, uz.
pub(crate) const COMPONENTS: usize = 9;
