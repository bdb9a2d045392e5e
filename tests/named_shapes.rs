//! Every shape, and contacts of named shapes against closed forms and published numbers.

#[macro_use]
#[path = "support/root.rs"]
#[expect(dead_code, reason = "no binary uses all of it")]
mod support;

mod shapes {
    mod all;
    mod coated_sphere;
    mod counterparts;
    mod hertz;
    mod roller;
    mod roller_profiles;
}
