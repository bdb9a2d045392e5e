//! Friction in the contact: tractions, partial slip, histories and rolling.

mod support {
    pub(crate) mod pairs;
    pub(crate) mod reference;
    pub(crate) mod seeded;
}

mod friction {
    mod cattaneo;
    mod coefficients;
    mod histories;
    mod kalker;
    mod lines;
    mod random;
    mod rolling;
    mod stiffness;
    mod stresses;
}
