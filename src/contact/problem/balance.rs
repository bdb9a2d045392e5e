//! Force and moments brought to their targets: a method of nacre's own.

use super::constraint::NonNegative;
use super::fit::{add_gram, add_moments};
use super::freedoms::Freedoms;
use crate::parallel::{all, sum};

/// Largest error of force and scaled moments, relative to the force, that counts as balanced: rounding in
/// sums over up to 4096² cells.
const BALANCED: f64 = 2e-13;

/// Newton steps after which the balance is given up: a bound against rounding, far above the usual number.
const STEPS: usize = 100;

/// Part of a Newton step below which no part of it helps: its square root is far above rounding.
const SHORTEST_STEP: f64 = 1e-9;

impl Freedoms {
    /// Whether a pressure of these `moments` is on target, within rounding.
    pub(crate) fn on_target(&self, moments: [f64; 3]) -> bool {
        let force = moments[0].abs().max(largest(self.target));
        (0..3).all(|k| !self.loaded[k] || (moments[k] - self.target[k]).abs() <= BALANCED * force)
    }

    /// The factor by which a pressure of this `force` carries the load; `None` where there is none, or it
    /// is not a number.
    pub(crate) fn to_load(&self, force: f64) -> Option<f64> {
        let factor = self.target[0] / force;
        (self.loaded[0] && force > 0.0 && factor > 0.0 && factor.is_finite()).then_some(factor)
    }

    /// Restores balance: p ← \[p (1 + Bμ)\]₊ with Bᵀp on target. Returns whether it succeeded.
    ///
    /// μ maximises the concave function μᵀF − ½ Σ p \[1 + Bμ\]₊². Its gradient is the mismatch of force and
    /// moments. Newton's method is used, with steps halved until the mismatch falls.
    pub(crate) fn balance(&self, pressure: &mut [f64]) -> bool {
        if !self.any_loaded() {
            return true;
        }
        if self.loaded[0] {
            // The force alone comes first, so that μ stays small compared with 1.
            let Some(factor) = self.to_load(self.moments(pressure)[0]) else {
                return false;
            };
            pressure.iter_mut().for_each(|p| *p *= factor);
            if self.only_force() {
                return true;
            }
        }
        let mut mu = [0.0; 3];
        let (mut force, mut mismatch) = self.mismatch(pressure, mu);
        let rounding = |force: f64| 4.0 * f64::EPSILON * force.max(largest(self.target));
        let mut descends = true;
        for _ in 0..STEPS {
            if largest(mismatch) <= rounding(force) || !descends {
                break;
            }
            let step = self.solve(&self.curvature(pressure, mu), mismatch);
            let mut length = 1.0;
            // Where no step helps, only rounding is left, or these cells cannot carry the moments.
            descends = loop {
                let trial = [0, 1, 2].map(|k| mu[k] + length * step[k]);
                let (trial_force, trial_mismatch) = self.mismatch(pressure, trial);
                if largest(trial_mismatch) < largest(mismatch) {
                    (mu, force, mismatch) = (trial, trial_force, trial_mismatch);
                    break true;
                }
                length *= 0.5;
                if length < SHORTEST_STEP {
                    break false;
                }
            };
        }
        let balanced = largest(mismatch) <= 1e3 * rounding(force);
        if balanced || descends {
            self.for_each(mu, |k, b| {
                pressure[k] *= NonNegative.nearest(1.0 + b);
            });
        }
        balanced
    }

    /// Force of \[p (1 + Bμ)\]₊, and target less Bᵀ of it.
    fn mismatch(&self, p: &[f64], mu: [f64; 3]) -> (f64, [f64; 3]) {
        let mut sums = [0.0; 3];
        for (x, row) in self.rows() {
            let along = 1.0 + mu[0] + mu[1] * x;
            let row = sum([&p[row], &self.columns[1]], |[p, y]| {
                let factor = all(along) + all(mu[2]) * y;
                let p = NonNegative.where_free(factor, p * factor);
                [p, p * y]
            });
            add_moments(&mut sums, x, row);
        }
        let missing = |k: usize| {
            if self.loaded[k] {
                self.target[k] - sums[k]
            } else {
                0.0
            }
        };
        (sums[0], [0, 1, 2].map(missing))
    }

    /// Second derivatives Σ p b bᵀ over the cells where 1 + Bμ > 0.
    fn curvature(&self, p: &[f64], mu: [f64; 3]) -> [[f64; 3]; 3] {
        let mut gram = [[0.0; 3]; 3];
        for (x, row) in self.rows() {
            let along = 1.0 + mu[0] + mu[1] * x;
            let row = sum([&p[row], &self.columns[1]], |[p, y]| {
                let p = NonNegative.where_free(all(along) + all(mu[2]) * y, p);
                [p, p * y, p * y * y]
            });
            add_gram(&mut gram, x, row);
        }
        gram
    }
}

/// The largest magnitude.
fn largest(values: [f64; 3]) -> f64 {
    values.iter().fold(0.0_f64, |a, b| a.max(b.abs()))
}
