//! Stress and displacement below the surface.

mod support {
    pub(crate) mod claims;
    pub(crate) mod huber;
    pub(crate) mod random;
    pub(crate) mod reference;
    pub(crate) mod stresses;
}

mod stress {
    mod closed_forms;
    mod coated;
    mod coats;
    mod edge;
    mod ends;
    mod faces;
    mod friction;
    mod invariants;
    mod limits;
    mod outside_grid;
    mod patch;
    mod periodic;
    mod plan;
    mod resolution;
    mod threads;
}
