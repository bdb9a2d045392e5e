//! Numerical methods that know nothing of contact.

pub(crate) mod clock;
pub(crate) mod dense;
pub(crate) mod enclosing_ball;
pub(crate) mod fft;
pub(crate) mod layout;
pub(crate) mod linear_cg;
pub(crate) mod parallel;
pub(crate) mod quadrature;
pub(crate) mod recent;
pub(crate) mod roots;
pub(crate) mod rounding;
pub(crate) mod special;
