//! Pressures that a cell can carry.

use crate::numerics::parallel::{Lanes, ONE, ZERO, where_positive};

/// The constraint p ≥ 0: surfaces that touch push each other, and never pull.
///
/// A pressure above 0 is free to change. A pressure of 0 is held by the bound until the bodies overlap
/// there. The contact is made of all cells that are free or overlap.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct NonNegative;

impl NonNegative {
    /// Whether the pressure `p` of a cell is free to change.
    pub(crate) fn is_free(self, p: f64) -> bool {
        p > 0.0
    }

    /// Whether a cell of pressure `p` belongs to the contact; `overlap` is −g, or 0 outside the contact.
    pub(crate) fn is_in_contact(self, p: f64, overlap: f64) -> bool {
        p > 0.0 || overlap > 0.0
    }

    /// The allowed pressure nearest to `p`.
    pub(crate) fn nearest(self, p: f64) -> f64 {
        p.max(0.0)
    }

    /// `value` in cells whose pressure is free, 0 in the others.
    pub(crate) fn where_free(self, p: Lanes, value: Lanes) -> Lanes {
        where_positive(p, value)
    }

    /// `value` in the cells of the contact, 0 in the others; `overlap` is −g, or 0 outside the contact.
    pub(crate) fn where_in_contact(self, p: Lanes, overlap: Lanes, value: Lanes) -> Lanes {
        (p.simd_gt(ZERO) | overlap.simd_gt(ZERO)) & value
    }

    /// The allowed pressures nearest to `p`, and 1 in cells where `p` itself is not allowed, 0 in the others.
    pub(crate) fn clip(self, p: Lanes) -> (Lanes, Lanes) {
        (where_positive(p, p), where_positive(-p, ONE))
    }
}
