//! Friction: `nacre.slide`, `nacre.roll`, `nacre.creep_coefficients` and their results.

mod creep;
mod keywords;
mod report;
mod rolling;
mod sliding;
mod solution;

pub(in crate::python) use creep::creep_coefficients;
pub(super) use keywords::{
    found_docs, found_signature, roll_docs, roll_signature, rolled_docs, slid_docs, slide_docs,
    slide_signature,
};
pub(in crate::python) use report::PyFrictionReport;
pub(super) use rolling::Rolled;
pub(in crate::python) use rolling::roll;
pub(super) use sliding::Sliding;
pub(in crate::python) use sliding::slide;
pub(in crate::python) use solution::PyFrictionSolution;
