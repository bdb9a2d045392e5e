//! The chain from a body to displacement: response, influence coefficients, convolution.

mod support {
    pub(crate) mod bodies;
    pub(crate) mod claims;
    pub(crate) mod foundation;
    pub(crate) mod messages;
    pub(crate) mod random;
    pub(crate) mod reference;
    pub(crate) mod seeded;
}

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
}
