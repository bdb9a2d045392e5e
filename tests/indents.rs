//! Indentation by axisymmetric tips: contacts, adhesion, derivatives, tables.

mod support {
    pub(crate) mod claims;
}

mod indent {
    mod adhesion;
    mod contact;
    mod curves;
    mod derivatives;
    mod profiles;
    mod ranges;
    pub(crate) mod support;
}
