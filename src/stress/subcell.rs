//! Pressure within the cells of a solved contact, and the stress that it adds: a method of nacre's own.

mod cut;
mod edge;
mod fit;
mod near;
mod reconstruction;
mod within;

pub(super) use near::{NearTable, STRESSES};
pub(super) use within::Within;
