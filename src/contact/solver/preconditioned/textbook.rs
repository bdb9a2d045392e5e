//! The iteration of [`super`] with one operation a line, as an oracle.
