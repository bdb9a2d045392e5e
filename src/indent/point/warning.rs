//! Contacts to which the theory of small slopes does not apply.

use std::fmt;

use super::Point;
use crate::indent::tip::Tip;

/// Slope above which a contact is warned of. The theory leaves out the square of the slope, a quarter here; the cone of Berkovich's
/// pyramid has 0.36.
const STEEP: f64 = 0.5;

/// What makes a state of an indentation doubtful.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// The tip is steep within the contact, or the surface at the edge of a flat punch.
    Steep {
        /// Largest slope of the tip within the contact; of a flat punch 2/π of its approach over its radius, the slope of a
        /// cone of the same approach and radius.
        slope: f64,
    },
}

impl Warning {
    /// Warnings of a contact.
    pub(in crate::indent) fn of(tip: &Tip, radius: f64, approach: f64) -> Vec<Self> {
        let slope = match tip.fixed_radius() {
            Some(a) => approach.abs() / a * std::f64::consts::FRAC_2_PI,
            None => tip.steepest(radius),
        };
        match slope > STEEP {
            true => vec![Self::Steep { slope }],
            false => vec![],
        }
    }

    /// Name of the kind of warning, without numbers.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Steep { .. } => "steep",
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Steep { slope } => write!(
                f,
                "the contact is too deep for its radius: its slope against the surface is up to {slope:.2}, and the theory \
                 of small slopes errs by about its square; above {STEEP} it is not to be trusted"
            ),
        }
    }
}

impl Point {
    /// What makes the state doubtful; empty as a rule.
    ///
    /// ```
    /// use nacre::indent::{Indent, Stack, Tip};
    /// use nacre::{Elastic, HalfSpace};
    /// let stack = Stack::plan(&[HalfSpace::new(Elastic::new(1.0, 0.3)?, [])?.into()])?;
    /// let indent = Indent::new(&stack, &Tip::sphere(5.0)?);
    /// assert!(indent.at_approach(0.5)?.warnings().is_empty());
    /// assert_eq!(indent.at_approach(10.0)?.warnings()[0].kind(), "steep");
    /// # Ok::<(), nacre::Error>(())
    /// ```
    pub fn warnings(&self) -> Vec<Warning> {
        Warning::of(&self.parts.tip, self.radius, self.approach)
    }
}
