//! The integral equation of a contact: response of the bodies, functions on the contact, linear system.

pub(super) mod basis;
pub(super) mod root;
pub(super) mod stack;
pub(super) mod system;
pub(super) mod waves;
