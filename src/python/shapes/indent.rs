//! `nacre.indent`: tips, adhesion, indentations and their states.

mod adhesion;
mod indentation;
mod results;
mod state;
mod tip;

pub(in crate::python) use adhesion::PyAdhesion;
pub(in crate::python) use indentation::PyIndentation;
pub(in crate::python) use results::{PyIndentCurve, PyPullOff};
pub(in crate::python) use state::{PyIndentState, PyStateDerivative};
pub(in crate::python) use tip::{PyTip, slope_of};
