//! Friction in the contact: tractions, partial slip, histories and rolling.

mod support {
    pub(crate) mod bodies;
    pub(crate) mod reference;
}

mod friction {
    mod coefficients;
    mod rolling;
    mod sliding;
}
