//! Surface displacement that a pressure causes: frequency response, influence coefficients, convolution.

pub mod convolution;
pub(crate) mod datum;
pub mod ends;
pub(crate) mod graded;
pub(crate) mod images;
pub mod influence;
pub(crate) mod kernel;
pub mod response;
pub(crate) mod strain;
pub mod traction;
