//! What the tests of several modules share.

pub(crate) mod bodies;
#[macro_use]
pub(crate) mod checks;
pub(crate) mod claims;
pub(crate) mod contacts;
pub(crate) mod foundation;
pub(crate) mod numerics;
pub(crate) mod pairs;
pub(crate) mod random;
pub(crate) mod reference;
pub(crate) mod rings;
pub(crate) mod settings;
pub(crate) mod sphere;
