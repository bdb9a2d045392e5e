//! `nacre.indent`: tips, adhesion, indentations and their states.

mod adhesion;
mod indentation;
mod state;
mod tip;

pub(in crate::python) use adhesion::PyAdhesion;
pub(in crate::python) use indentation::{PyIndentCurve, PyIndentation, PyPullOff};
pub(in crate::python) use state::{PyIndentState, PyStateDerivative};
pub(in crate::python) use tip::{PyTip, slope_of};
