//! Contacts: every algorithm, control, domain and body, and what cannot be solved.

mod support {
    pub(crate) mod claims;
    pub(crate) mod contacts;
    pub(crate) mod foundation;
    pub(crate) mod messages;
    pub(crate) mod random;
    pub(crate) mod reference;
    pub(crate) mod rings;
    pub(crate) mod seeded;
}

mod contact {
    mod algorithms;
    mod automatic;
    mod batch;
    mod discretisation;
    mod ends;
    mod errors;
    mod few_cells;
    mod foundation;
    mod fuzz;
    mod hardness;
    mod invariants;
    mod line;
    mod periodic;
    mod stiffness;
    mod thin_layers;
    mod two_bodies;
    mod warnings;
}
