//! Numerical methods that know nothing of contact.

pub(crate) mod dense;
pub(crate) mod fft;
pub(crate) mod parallel;
