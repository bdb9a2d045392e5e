//! Contacts: every algorithm, control, domain and body, and what cannot be solved.

#[macro_use]
#[path = "support/root.rs"]
#[expect(dead_code, reason = "no binary uses all of it")]
mod support;
#[macro_use]
#[path = "support/messages.rs"]
mod messages;

mod contact {
    mod algorithms;
    mod automatic;
    mod batch;
    mod conductance;
    mod discretisation;
    mod ends;
    mod errors;
    mod few_cells;
    mod foundation;
    mod fuzz;
    mod hardness;
    mod interface;
    mod invariants;
    #[cfg(feature = "serde")]
    mod json;
    mod layouts;
    mod line;
    mod matrix;
    mod periodic;
    mod springs;
    mod stiffness;
    mod thin_layers;
    mod two_bodies;
    mod warnings;
}
