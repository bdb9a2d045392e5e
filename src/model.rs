//! What a contact is made of: materials, bodies, grids, shapes, and Hertz's closed forms.

pub mod body;
pub(crate) mod data;
pub mod grid;
pub mod hertz;
pub mod material;
pub mod surface;
