//! Derivatives of solved contacts.

mod support {
    pub(crate) mod random;
    pub(crate) mod reference;
}

mod gradient {
    mod cases;
    mod coated_sphere;
    mod differences;
    mod identities;
    mod kinks;
    mod shapes;
    mod stresses;
}
