//! Indentation by axisymmetric tips: contacts, adhesion, derivatives, tables.

mod indent {
    pub mod adhesion;
    pub mod contact;
    pub mod curves;
    pub mod derivatives;
    pub mod ranges;
    pub mod support;
}
