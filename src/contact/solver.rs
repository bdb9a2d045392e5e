//! Algorithms that solve a contact problem.

pub(super) mod active_set;
pub(super) mod polonsky_keer;
pub(super) mod preconditioned;
