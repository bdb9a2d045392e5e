//! `nacre.indent`: tips, adhesion, indentations and their states.

mod adhesion;
mod indentation;
mod state;
mod tip;

pub(super) use adhesion::PyAdhesion;
pub(super) use indentation::{PyIndentCurve, PyIndentation, PyPullOff};
pub(super) use state::{PyIndentState, PyStateDerivative};
pub(super) use tip::{PyTip, slope_of};
