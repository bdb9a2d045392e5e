//! Kernels: what a uniform load on one cell of the surface does at (x, y, z).
//!
//! Loads are a pressure and tractions along x and y; what they do is stress and displacement, at any
//! depth, the surface included.

pub(crate) mod cells;
pub(crate) mod loads;
pub(crate) mod plane;
pub(crate) mod plans;
pub(crate) mod quadrature;
pub(crate) mod rectangle;
pub(crate) mod series;
pub(crate) mod strip;
pub(crate) mod table;
