//! Friction in the contact: tractions, partial slip, histories and rolling.

#[macro_use]
#[path = "support/root.rs"]
#[expect(dead_code, reason = "no binary uses all of it")]
mod support;

mod friction {
    mod cattaneo;
    mod coefficients;
    mod histories;
    mod lines;
    mod random;
    mod rolling;
    mod second_order;
    mod stated_errors;
}
