//! The chain from a body to displacement: response, influence coefficients, convolution.

#[macro_use]
#[path = "support/root.rs"]
#[expect(dead_code, reason = "no binary uses all of it")]
mod support;
#[macro_use]
#[path = "support/messages.rs"]
mod messages;

mod compliance {
    mod convolution_direct;
    mod ends;
    mod errors;
    mod foundation;
    mod graded;
    mod influence_conversion;
    mod influence_exact;
    mod response;
    mod response_derivatives;
    mod springs;
}
