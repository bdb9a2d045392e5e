//! Adhesion of Johnson, Kendall and Roberts on any stack.
//!
//! The energy that is released when the edge recedes is the work of adhesion w (Johnson, Kendall & Roberts, Proc. R. Soc.
//! Lond. A 324 (1971) 301, doi:10.1098/rspa.1971.0141):
//!
//! ```text
//! w = S'(δ − δ_H)²/(4π a) = π φ(a)²/(2a E*)      δ = δ_H − √(4π a w/S')      P = S δ − P_F
//! ```
//!
//! Both forms are the same by the energy identity of [`crate::indent`]. The contact is pulled off where P is least under a given
//! load, and where δ is least under a given approach.

use std::f64::consts::PI;

use super::point::{Indent, Point};
use crate::error::{Error, Result, positive};

/// What is given while a tip is pulled off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Control {
    /// The load.
    Load,
    /// The approach.
    Approach,
}

/// Radii that are looked at for the end of a contact, in each factor of ten.
const SCAN: usize = 24;

/// Factors of ten below the largest radius in which it is looked for.
const DECADES: usize = 4;

/// Steps of the golden section; the least load is known to the square of the last.
const STEPS: usize = 60;

/// The last stable contact of a tip that is pulled off.
#[derive(Debug, Clone)]
pub struct PullOff<'a> {
    /// The contact; its load is below 0.
    pub point: Point<'a>,
    /// What was given.
    pub control: Control,
}

impl<'a> Indent<'a> {
    /// The contact of radius `a` \[m\] under the work of adhesion `w` \[J/m²\].
    ///
    /// # Errors
    /// As [`Indent::at_radius`], and a work of adhesion that is not above 0.
    pub fn adhering_at(&self, a: f64, w: f64) -> Result<Point<'a>> {
        positive("work of adhesion", w)?;
        let point = self.solve(a)?;
        let approach = point.hertzian - (4.0 * PI * a * w / point.stiffness_slope).sqrt();
        Ok(point.at(approach))
    }

    /// The contact at which a tip is pulled off under the work of adhesion `w` \[J/m²\]: of the deepest minimum of load or
    /// approach at radii from 1e-4 of the largest that was planned on.
    ///
    /// # Errors
    /// As [`Indent::adhering_at`], and no minimum within these radii.
    pub fn pull_off(&self, w: f64, control: Control) -> Result<PullOff<'a>> {
        let most = self.largest();
        let value = |log: f64| -> Result<f64> {
            let point = self.adhering_at(most * log.exp(), w)?;
            Ok(match control {
                Control::Load => point.load,
                Control::Approach => point.approach,
            })
        };
        let step = 10.0_f64.ln() / SCAN as f64;
        let places: Vec<f64> = (0..=SCAN * DECADES)
            .rev()
            .map(|k| -(k as f64) * step)
            .collect();
        let values: Vec<f64> = places
            .iter()
            .map(|log| value(*log))
            .collect::<Result<_>>()?;
        let inner = 1..values.len() - 1;
        let least = |k: &usize| values[*k] <= values[k - 1] && values[*k] < values[k + 1];
        let found = inner
            .filter(least)
            .min_by(|a, b| values[*a].total_cmp(&values[*b]));
        let found = found.ok_or(Error::Inconsistent(
            "the tip is not pulled off at radii up to the largest that was planned: plan a larger one",
        ))?;
        // The golden section.
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let (mut low, mut high) = (places[found - 1], places[found + 1]);
        let mut inside = [high - golden * (high - low), low + golden * (high - low)];
        let mut at = [value(inside[0])?, value(inside[1])?];
        for _ in 0..STEPS {
            if at[0] < at[1] {
                high = inside[1];
                inside = [high - golden * (high - low), inside[0]];
                at = [value(inside[0])?, at[0]];
            } else {
                low = inside[0];
                inside = [inside[1], low + golden * (high - low)];
                at = [at[1], value(inside[1])?];
            }
        }
        let point = self.adhering_at(most * (0.5 * (low + high)).exp(), w)?;
        Ok(PullOff { point, control })
    }
}
