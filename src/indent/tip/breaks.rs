//! Places at which quadratures over a profile end their panels.

use super::term::Term;
use super::{Form, Tip};
use crate::indent::equation::basis::Break;

/// Ratio of the distances of successive breaks from a singularity: 24 nodes on a panel between them leave 3⁻⁴⁸.
const RATIO: f64 = 4.0;

/// Radius over that of a sphere up to which the eight nodes of smooth profiles leave 1e-14 of its logarithm at R.
const ROUND: f64 = 0.4;

/// Breaks towards the axis of powers of s, the first panel of which counts nothing: 4⁻¹² = 6e-8 of 1e-6.
const TO_AXIS: f64 = 12.0;

impl Tip {
    /// Places up to the contact radius `a` at which panels end, ascending, where the profile has `most` kinks there at most; none
    /// where F is smooth from the axis to `a`.
    pub(in crate::indent) fn breaks(&self, a: f64, most: usize) -> Option<Vec<Break>> {
        let smooth = |at: f64| Break {
            at,
            has_root: false,
        };
        let root = |at: f64| Break { at, has_root: true };
        let mut breaks = Vec::new();
        match self.form {
            Form::FlatPunch { .. } | Form::Paraboloid { .. } | Form::Cone { .. } => return None,
            Form::Sphere { radius } if a <= ROUND * radius => return None,
            // A logarithm at R.
            Form::Sphere { radius } => {
                let mut distance = RATIO * (radius - a);
                while RATIO * distance < radius {
                    breaks.insert(0, smooth(radius - distance));
                    distance *= RATIO;
                }
            }
            // A root on the axis, or s ln s in the derivative, and a steep rise within a/n of the edge.
            Form::Power { exponent, .. } => {
                breaks.push(root(0.0));
                let count = (TO_AXIS / (1.0 + exponent)).ceil();
                let mut at = a * RATIO.powf(-count);
                while at < 0.5 * a {
                    breaks.push(smooth(at));
                    at *= RATIO;
                }
                if exponent > 16.0 {
                    breaks.push(smooth(a * (1.0 - 8.0 / exponent)));
                }
            }
            _ => {
                let mut kinks: Vec<f64> = self.terms.iter().filter_map(Term::kink).collect();
                kinks.retain(|b| *b < a);
                kinks.sort_by(f64::total_cmp);
                if kinks.len() > most {
                    let steps = [-3, -2, -1].map(|k| smooth(a * RATIO.powi(k)));
                    return Some(steps.into());
                }
                let ends = kinks.iter().skip(1).chain(std::iter::once(&a));
                let mut before = 0.0;
                for (kink, end) in kinks.iter().zip(ends) {
                    breaks.push(root(*kink));
                    // The singularity before this one, or its image at −b.
                    let mut distance = kink - before;
                    while distance > 0.0 && kink + 2.0 * distance < *end {
                        breaks.push(smooth(kink + distance));
                        distance *= RATIO;
                    }
                    before = *kink;
                }
            }
        }
        Some(breaks)
    }
}
