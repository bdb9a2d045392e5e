//! Indentation by axisymmetric tips: contacts, adhesion, derivatives, tables.

#[macro_use]
#[path = "support/root.rs"]
#[expect(dead_code, reason = "no binary uses all of it")]
mod support;

mod indent {
    mod adhesion;
    mod contact;
    mod derivatives;
    mod profiles;
    mod ranges;

    use nacre::{Elastic, HalfSpace, Result};

    /// A coat of E1/E2 = `ratio` and thickness `h` on E2* = 1, ν = 0.3 both.
    fn coated(ratio: f64, h: f64) -> Result<HalfSpace> {
        crate::support::settings::coated(Elastic::new(1.0 - 0.09, 0.3)?, ratio, h)
    }
}
