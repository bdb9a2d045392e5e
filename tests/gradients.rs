//! Derivatives of solved contacts.

#[macro_use]
#[path = "support/root.rs"]
#[expect(dead_code, reason = "no binary uses all of it")]
mod support;

mod gradient {
    mod cases;
    mod coated_sphere;
    mod differences;
    mod identities;
    mod kinks;
    mod stresses;
}
