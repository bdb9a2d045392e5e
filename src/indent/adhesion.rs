//! Adhesion of the surfaces.

use std::f64::consts::PI;

use super::equation::stack::IndentParameter;
use super::tip::{Tip, TipParameter};
use crate::error::{Result, positive, require};

/// How the surfaces adhere.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub enum Adhesion {
    /// They do not.
    #[default]
    None,
    /// Within the contact alone: Johnson, Kendall & Roberts, Proc. R. Soc. Lond. A 324 (1971) 301, doi:10.1098/rspa.1971.0141.
    Jkr {
        /// Work of adhesion w \[J/m²\].
        work: f64,
    },
    /// By a force 2πwR around the contact that does not deform: Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53
    /// (1975) 314, doi:10.1016/0021-9797(75)90018-1.
    Dmt {
        /// Work of adhesion w \[J/m²\].
        work: f64,
    },
    /// By a constant stress up to a gap of w/σ₀ around the contact: Maugis, J. Colloid Interface Sci. 150 (1992) 243,
    /// doi:10.1016/0021-9797(92)90285-T.
    Maugis {
        /// Work of adhesion w \[J/m²\].
        work: f64,
        /// Tensile strength σ₀ \[Pa\].
        strength: f64,
    },
}

/// What is given while a tip is moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "lowercase")
)]
pub enum Control {
    /// The load.
    Load,
    /// The approach.
    Approach,
}

impl Control {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Load => "load",
            Self::Approach => "approach",
        }
    }

    /// That of approach and load which is given.
    pub(super) fn of(self, [approach, load]: [f64; 2]) -> f64 {
        match self {
            Self::Load => load,
            Self::Approach => approach,
        }
    }
}

/// Part of the curve on which a state lies, where two have the same load or approach.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "lowercase")
)]
pub enum Branch {
    /// The contact of the larger radius, to which a disturbed tip returns.
    #[default]
    Stable,
    /// The contact of the smaller radius, from which a disturbed tip departs.
    Unstable,
}

impl Adhesion {
    /// The adhesion itself, if its numbers are above 0.
    ///
    /// # Errors
    /// A number that is not finite and above 0, and a gap work/strength beyond all lengths.
    pub fn checked(self) -> Result<Self> {
        if let Some(work) = self.work() {
            positive("work", work)?;
        }
        if let Self::Maugis { work, strength } = self {
            positive("strength", strength)?;
            let (length, requirement) = (work / strength, "a length between 1e-100 and 1e100");
            require("work/strength", length, (1e-100..=1e100).contains(&length), requirement)?;
        }
        Ok(self)
    }

    /// Work of adhesion \[J/m²\]; none without adhesion.
    pub fn work(&self) -> Option<f64> {
        match *self {
            Self::None => None,
            Self::Jkr { work } | Self::Dmt { work } | Self::Maugis { work, .. } => Some(work),
        }
    }

    /// φ(a) = −√(2aE*w/π) \[N/m²\] at the edge of a contact of radius `a`; 0 where nothing adheres within it.
    ///
    /// The energy that is released as the edge recedes is w: with S' = 2π²φ₁²/E*,
    ///
    /// ```text
    /// w = S'(δ − δ_H)²/(4πa) = π φ(a)²/(2a E*)
    /// ```
    pub(super) fn edge(&self, modulus: f64, a: f64) -> f64 {
        match *self {
            Self::Jkr { work } => -(2.0 * a * modulus * work / PI).sqrt(),
            _ => 0.0,
        }
    }

    /// Force 2πwR \[N\] that pulls outside of the contact.
    pub(super) fn outside(&self, tip: &Tip) -> f64 {
        match (*self, tip.end_radius()) {
            (Self::Dmt { work }, Some(radius)) => 2.0 * PI * work * radius,
            _ => 0.0,
        }
    }

    /// Derivative of the force outside with respect to `parameter`. Where all sections have κ times the area, the end radius is κR.
    pub(super) fn outside_rate(&self, tip: &Tip, parameter: IndentParameter) -> f64 {
        let (Self::Dmt { work }, Some(radius)) = (*self, tip.end_radius()) else {
            return 0.0;
        };
        match parameter {
            IndentParameter::Work => 2.0 * PI * radius,
            IndentParameter::Tip(TipParameter::Area) => 2.0 * PI * work * radius,
            // The end radius is the last number of the form.
            IndentParameter::Tip(TipParameter::Number(k)) if k + 1 == tip.numbers().len() => {
                2.0 * PI * work
            }
            _ => 0.0,
        }
    }
}
