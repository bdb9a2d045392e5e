//! Force and moments on target.

use crate::contact::problem::fit::{add_gram, add_moments, symmetric};
use crate::contact::problem::freedoms::Freedoms;
use crate::parallel::{all, sum, where_positive};

/// Mismatch of force and scaled moments, over the force, that rounding leaves in large sums.
const BALANCED: f64 = 2e-13;

impl Freedoms {
    /// Whether a pressure of these moments is on target, within rounding.
    pub(crate) fn on_target(&self, sums: [f64; 3]) -> bool {
        let asked = self.target.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        let force = sums[0].abs().max(asked);
        (0..3).all(|k| !self.loaded[k] || (sums[k] - self.target[k]).abs() <= BALANCED * force)
    }

    /// The factor by which a pressure of this `force` carries the load. None where it carries nothing;
    /// sums may overflow, or vanish.
    pub(crate) fn to_load(&self, force: f64) -> Option<f64> {
        let factor = self.target[0] / force;
        (self.loaded[0] && force > 0.0 && factor > 0.0 && factor.is_finite()).then_some(factor)
    }

    /// Whether the force alone is loaded.
    pub(crate) fn only_force(&self) -> bool {
        self.loaded == [true, false, false]
    }

    /// Restores balance: p ← [p (1 + Bμ)]₊ with Bᵀp on target. Returns whether it got there.
    ///
    /// μ maximises the concave μᵀF − ½ Σ p [1 + Bμ]₊², of which the gradient is the mismatch: by
    /// Newton's method, with steps halved until the mismatch falls.
    pub(crate) fn balance(&self, pressure: &mut [f64]) -> bool {
        if !self.any_loaded() {
            return true;
        }
        if self.loaded[0] {
            // First the force alone, so that μ stays small against 1.
            let Some(factor) = self.to_load(self.moments(pressure)[0]) else {
                return false;
            };
            pressure.iter_mut().for_each(|p| *p *= factor);
            if self.only_force() {
                return true;
            }
        }
        // p [1 + Bμ]₊ summed: Bᵀ of it less the target, and how large its force is.
        let mismatch = |p: &[f64], mu: [f64; 3]| {
            let mut sums = [0.0; 3];
            for (x, row) in self.rows() {
                let along = 1.0 + mu[0] + mu[1] * x;
                let row = sum([&p[row], &self.columns[1]], |[p, y]| {
                    let factor = all(along) + all(mu[2]) * y;
                    let p = where_positive(factor, p * factor);
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
        };
        let curvature = |p: &[f64], mu: [f64; 3]| {
            let mut gram = [[0.0; 3]; 3];
            for (x, row) in self.rows() {
                let along = 1.0 + mu[0] + mu[1] * x;
                let row = sum([&p[row], &self.columns[1]], |[p, y]| {
                    let p = where_positive(all(along) + all(mu[2]) * y, p);
                    [p, p * y, p * y * y]
                });
                add_gram(&mut gram, x, row);
            }
            symmetric(gram)
        };
        let size = |gap: [f64; 3]| gap.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        let mut mu = [0.0; 3];
        let (mut force, mut gap) = mismatch(pressure, mu);
        let enough = |force: f64| 4.0 * f64::EPSILON * force.max(size(self.target));
        let mut helps = true;
        for _ in 0..100 {
            if size(gap) <= enough(force) || !helps {
                break;
            }
            let step = self.solve(&curvature(pressure, mu), gap);
            let mut length = 1.0;
            // Where no step helps it is rounding, or there is no such pressure on these cells.
            helps = loop {
                let trial = [0, 1, 2].map(|k| mu[k] + length * step[k]);
                let (w, g) = mismatch(pressure, trial);
                if size(g) < size(gap) {
                    (mu, force, gap) = (trial, w, g);
                    break true;
                }
                length *= 0.5;
                if length < 1e-9 {
                    break false;
                }
            };
        }
        let done = size(gap) <= 1e3 * enough(force);
        if done || helps {
            self.for_each(mu, |k, b| pressure[k] *= (1.0 + b).max(0.0));
        }
        done
    }
}
