//! Contacts of named shapes against closed forms and published numbers.

mod support {
    pub(crate) mod claims;
    pub(crate) mod reference;
    pub(crate) mod sphere;
}

mod shapes {
    mod coated_sphere;
    mod counterparts;
    mod hertz;
    mod roller;
    mod roller_profiles;
    mod sums;
}
