//! Force and moments brought to their targets: a method of nacre's own.

use super::bounds::{Bounds, clip, is_free};
use super::fit::{add_gram, add_moments};
use super::freedoms::Freedoms;
use crate::numerics::parallel::{Lanes, ONE, all, sum};

/// Largest error of force and scaled moments, relative to the force, that counts as balanced: rounding in
/// sums over up to 4096² cells.
const BALANCE_TOLERANCE: f64 = 2e-13;

/// Newton steps after which the balance is given up: a bound against rounding, far above the usual number.
const STEPS: usize = 100;

/// Smallest fraction of a Newton step that is tried. Where no fraction helps, only rounding is left, or the cells
/// cannot carry the moments; chosen by trial.
const SHORTEST_STEP: f64 = 1e-9;

/// Bμ beyond which a force is given up.
const FARTHEST: f64 = 1e30;

impl Freedoms {
    /// Whether a pressure of these `moments` is on target, within rounding.
    pub(crate) fn on_target(&self, moments: [f64; 3]) -> bool {
        let force = moments[0].abs().max(largest(self.target));
        (0..3).all(|k| {
            !self.loaded[k] || (moments[k] - self.target[k]).abs() <= BALANCE_TOLERANCE * force
        })
    }

    /// The factor by which a pressure of this `force` carries the load; `None` where there is none, or it
    /// is not a number.
    pub(crate) fn to_load(&self, force: f64) -> Option<f64> {
        let factor = self.target[0] / force;
        (self.loaded[0] && force > 0.0 && factor > 0.0 && factor.is_finite()).then_some(factor)
    }

    /// Restores balance: p ← \[p (1 + Bμ)\]₊ with Bᵀp on target, up to the bounds; pressures at their upper bound stay.
    /// Returns whether it succeeded.
    pub(crate) fn balance(&self, pressure: &mut [f64], bounds: &Bounds) -> bool {
        if !self.any_loaded() {
            return true;
        }
        if self.loaded[0] && !bounds.is_limited() {
            // The force alone comes first, so that μ stays small compared with 1.
            let Some(factor) = self.to_load(self.moments(pressure)[0]) else {
                return false;
            };
            pressure.iter_mut().for_each(|p| *p *= factor);
            if self.only_force() {
                return true;
            }
        }
        self.bring_on_target(pressure, bounds, [0.0; 3], |p, limit, factor| {
            let free = is_free(p, limit);
            let new = clip(p * factor, limit);
            [free.bitselect(new, p), free & is_free(new, limit) & p]
        })
    }

    /// Restores balance by a pressure on all cells: p ← `p` + `rise` Bμ up to the bounds, where a `p` of −∞ stays 0.
    /// Returns whether it succeeded.
    pub(crate) fn spread(&self, p: &mut [f64], bounds: &Bounds, rise: f64) -> bool {
        let rise = all(rise);
        let raised = |p, limit, factor| {
            let new = p + rise * (factor - ONE);
            [clip(new, limit), is_free(new, limit) & rise]
        };
        let mut mu = [0.0; 3];
        if self.loaded[0] {
            // By bisection for the force alone, since at first no pressure may be free.
            let carries = |mu| self.mismatch(p, bounds, [mu, 0.0, 0.0], &raised).1[0] <= 0.0;
            let [mut low, mut high] = [-1.0, 1.0];
            while high < FARTHEST && !carries(high) {
                high *= 2.0;
            }
            while low > -FARTHEST && carries(low) {
                low *= 2.0;
            }
            for _ in 0..STEPS {
                let middle = 0.5 * (low + high);
                *(if carries(middle) { &mut high } else { &mut low }) = middle;
            }
            mu[0] = high;
        }
        self.bring_on_target(p, bounds, mu, raised)
    }

    /// Brings Bᵀp on target by p ← `answer`(p, bound, 1 + Bμ), which also returns the derivative of p with respect to
    /// Bμ. It starts from `mu`, and returns whether it succeeded.
    ///
    /// The answer grows with Bμ: μ maximises a concave function whose gradient is the mismatch of force and moments.
    /// Newton's method is used, with steps halved until the mismatch falls.
    fn bring_on_target(
        &self,
        pressure: &mut [f64],
        bounds: &Bounds,
        mut mu: [f64; 3],
        answer: impl Fn(Lanes, Lanes, Lanes) -> [Lanes; 2],
    ) -> bool {
        let (mut force, mut mismatch) = self.mismatch(pressure, bounds, mu, &answer);
        let rounding = |force: f64| 4.0 * f64::EPSILON * force.max(largest(self.target));
        let mut descends = true;
        for _ in 0..STEPS {
            if largest(mismatch) <= rounding(force) || !descends {
                break;
            }
            let step = self.solve(&self.curvature(pressure, bounds, mu, &answer), mismatch);
            let mut length = 1.0;
            descends = loop {
                let trial = [0, 1, 2].map(|k| mu[k] + length * step[k]);
                let (trial_force, trial_mismatch) = self.mismatch(pressure, bounds, trial, &answer);
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
        // Multiple of the rounding of one sum that still counts as balanced; chosen by trial.
        const ROUNDINGS: f64 = 1e3;
        let balanced = largest(mismatch) <= ROUNDINGS * rounding(force);
        if balanced || descends {
            self.for_each(mu, |k, b| {
                let [new, _] = answer(all(pressure[k]), all(bounds.limit(k)), all(1.0 + b));
                [pressure[k], ..] = new.to_array();
            });
        }
        balanced
    }

    /// Force of the answer to Bμ, and target less Bᵀ of it.
    fn mismatch(
        &self,
        p: &[f64],
        bounds: &Bounds,
        mu: [f64; 3],
        answer: &impl Fn(Lanes, Lanes, Lanes) -> [Lanes; 2],
    ) -> (f64, [f64; 3]) {
        let mut sums = [0.0; 3];
        for (number, (x, row)) in self.rows().enumerate() {
            let (along, slope) = (all(1.0 + mu[0] + mu[1] * x), all(mu[2]));
            let fields = [&p[row], bounds.row(number), &self.columns[1]];
            let row = sum(fields, |[p, limit, y]| {
                let [p, _] = answer(p, limit, along + slope * y);
                [p, p * y]
            });
            add_moments(&mut sums, x, row);
        }
        let missing = |k: usize| {
            if self.loaded[k] { self.target[k] - sums[k] } else { 0.0 }
        };
        (sums[0], [0, 1, 2].map(missing))
    }

    /// Derivative of Bᵀ of the answer to Bμ.
    fn curvature(
        &self,
        p: &[f64],
        bounds: &Bounds,
        mu: [f64; 3],
        answer: &impl Fn(Lanes, Lanes, Lanes) -> [Lanes; 2],
    ) -> [[f64; 3]; 3] {
        let mut gram = [[0.0; 3]; 3];
        for (number, (x, row)) in self.rows().enumerate() {
            let (along, slope) = (all(1.0 + mu[0] + mu[1] * x), all(mu[2]));
            let fields = [&p[row], bounds.row(number), &self.columns[1]];
            let row = sum(fields, |[p, limit, y]| {
                let [_, p] = answer(p, limit, along + slope * y);
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

#[cfg(test)]
mod tests {
    use crate::contact::options::Motion;
    use crate::contact::problem::bounds::Bounds;
    use crate::contact::problem::freedoms::Freedoms;
    use crate::error::Result;
    use crate::model::grid::Grid;

    const CELLS: [usize; 2] = [13, 18];

    /// Freedoms under a load of 2 with these eccentricities, on a grid 2 × 3.
    fn freedoms(eccentricity: [Option<f64>; 2]) -> Result<Freedoms> {
        let grid = Grid::new(CELLS, [2.0, 3.0])?.centered_at([0.4, -0.3])?;
        let motion = Motion { eccentricity, ..Motion::load(2.0) };
        Freedoms::new(&motion, &grid)
    }

    /// Pressures between 0.5 and 2.5 in no order, 0 at every seventh cell.
    fn pressure() -> Vec<f64> {
        let p = |k: usize| {
            if k.is_multiple_of(7) { 0.0 } else { 0.5 + (k * 37 % 101) as f64 / 50.0 }
        };
        (0..CELLS[0] * CELLS[1]).map(p).collect()
    }

    #[test]
    fn a_load_alone_scales_the_pressure() -> Result<()> {
        let freedoms = freedoms([None, None])?;
        let before = pressure();
        let mut p = before.clone();
        assert!(freedoms.balance(&mut p, &Bounds::none(CELLS[1])));
        let factor = 2.0 / (freedoms.cell_area * before.iter().sum::<f64>());
        for (p, before) in p.iter().zip(&before) {
            assert!((p - factor * before).abs() <= 1e-13 * factor * before);
        }
        assert!(!freedoms.balance(&mut vec![0.0; before.len()], &Bounds::none(CELLS[1])));
        Ok(())
    }

    /// The load is 2 and acts at the eccentricity; p/p_before is affine in x and y where it is positive, and the
    /// affine function is negative where the pressure vanished. Both to the rounding of a few hundred cells.
    #[test]
    fn load_and_moments_by_an_affine_factor() -> Result<()> {
        let at = [0.95, -0.9];
        let freedoms = freedoms(at.map(Some))?;
        let before = pressure();
        let mut p = before.clone();
        assert!(freedoms.balance(&mut p, &Bounds::none(CELLS[1])));
        let grid = Grid::new(CELLS, [2.0, 3.0])?.centered_at([0.4, -0.3])?;
        let (x, y) = (grid.x(), grid.y());
        let place = |k: usize| [x[k / CELLS[1]], y[k % CELLS[1]]];
        let mut sums = [0.0; 3];
        for (k, p) in p.iter().enumerate() {
            let [x, y] = place(k);
            for (sum, term) in sums.iter_mut().zip([1.0, x, y]) {
                *sum += p * term * grid.cell_area();
            }
        }
        for (sum, expected) in sums.iter().zip([2.0, 2.0 * at[0], 2.0 * at[1]]) {
            assert!((sum - expected).abs() < 1e-12, "{sums:?}");
        }
        // Slopes from three cells that kept their pressure, in the corner towards the load point.
        let ratio = |i: usize, j: usize| p[i * CELLS[1] + j] / before[i * CELLS[1] + j];
        let [i, j] = [CELLS[0] - 2, 1];
        let sx = (ratio(i, j) - ratio(i - 3, j)) / (x[i] - x[i - 3]);
        let sy = (ratio(i, j + 3) - ratio(i, j)) / (y[j + 3] - y[j]);
        let mut lost = 0;
        for (k, &p) in p.iter().enumerate().filter(|&(k, _)| before[k] > 0.0) {
            let [a, b] = place(k);
            let affine = ratio(i, j) + sx * (a - x[i]) + sy * (b - y[j]);
            let expected = (before[k] * affine).max(0.0);
            assert!((p - expected).abs() < 1e-11, "{k}: {p} {expected}");
            lost += usize::from(p <= 0.0);
        }
        assert!(lost > 10, "{lost}");
        Ok(())
    }

    /// Pressures at x < 0.4 alone carry no load at x = 0.5, and one row of cells no load beside it.
    #[test]
    fn impossible_moments_are_refused() -> Result<()> {
        let half = CELLS[0] / 2 * CELLS[1];
        let mut p = pressure();
        p[half..].fill(0.0);
        assert!(!freedoms([Some(0.5), None])?.balance(&mut p.clone(), &Bounds::none(CELLS[1])));
        assert!(freedoms([Some(0.0), Some(0.1)])?.balance(&mut p.clone(), &Bounds::none(CELLS[1])));
        p[CELLS[1]..].fill(0.0);
        assert!(!freedoms([Some(0.0), None])?.balance(&mut p, &Bounds::none(CELLS[1])));
        Ok(())
    }

    /// A mismatch of 2e-13 of the force is rounding, of force and scaled moments alike.
    #[test]
    fn on_target_within_rounding() -> Result<()> {
        let freedoms = freedoms([Some(0.5), None])?;
        let [f, fx, _] = freedoms.target;
        for (mismatch, expected) in [(1e-13, true), (4e-13, false)] {
            assert_eq!(freedoms.on_target([f, fx + mismatch * f, 7.0]), expected);
            assert_eq!(freedoms.on_target([f * (1.0 - mismatch), fx, 7.0]), expected);
        }
        Ok(())
    }
}
