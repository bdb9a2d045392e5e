//! Force and moments brought to their targets; the method was derived here.

use std::ops::Range;

use crate::contact::problem::bounds::{Bounds, clip, in_contact, is_free};
use crate::contact::problem::freedoms::Freedoms;
use crate::numerics::dense::eliminate;
use crate::numerics::parallel::{Lanes, ONE, Row, Total, all, sum, update};

/// Largest error of force and scaled moments, relative to the force, that counts as balanced: rounding in
/// sums over up to 4096² cells.
const BALANCE_TOLERANCE: f64 = 2e-13;

/// Newton steps after which the balance is given up: a bound against rounding, far above the usual number.
const STEPS: usize = 100;

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
            let carries =
                |mu| self.answer_sums(p, bounds, [mu, 0.0, 0.0], &raised).mismatch[0] <= 0.0;
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
        let mut sums = self.answer_sums(pressure, bounds, mu, &answer);
        let size = |force: f64| force.max(largest(self.target));
        let mut descends = true;
        for _ in 0..STEPS {
            if largest(sums.mismatch) <= 4.0 * f64::EPSILON * size(sums.force) || !descends {
                break;
            }
            let step = self.solve(&sums.gram, sums.mismatch);
            let mut length = 1.0;
            descends = loop {
                let shorter = [0, 1, 2].map(|k| mu[k] + length * step[k]);
                let trial = self.answer_sums(pressure, bounds, shorter, &answer);
                if largest(trial.mismatch) < largest(sums.mismatch) {
                    (mu, sums) = (shorter, trial);
                    break true;
                }
                length *= 0.5;
                // Only rounding is left, or the cells cannot carry the moments.
                if length < f64::EPSILON.sqrt() {
                    break false;
                }
            };
        }
        let balanced = largest(sums.mismatch) <= BALANCE_TOLERANCE * size(sums.force);
        if balanced || descends {
            self.for_each(mu, |k, b| {
                let [new, _] = answer(all(pressure[k]), all(bounds.limit(k)), all(1.0 + b));
                [pressure[k], ..] = new.to_array();
            });
        }
        balanced
    }

    /// The sums of the answer to Bμ.
    fn answer_sums(
        &self,
        p: &[f64],
        bounds: &Bounds,
        mu: [f64; 3],
        answer: &impl Fn(Lanes, Lanes, Lanes) -> [Lanes; 2],
    ) -> AnswerSums {
        let (mut sums, mut gram) = ([0.0; 3], [[0.0; 3]; 3]);
        for (number, (x, row)) in self.rows().enumerate() {
            let (along, slope) = (all(1.0 + mu[0] + mu[1] * x), all(mu[2]));
            let fields = [&p[row], bounds.row(number), &self.columns[1]];
            let [p, py, s, sy, syy] = sum(fields, |[p, limit, y]| {
                let [p, rate] = answer(p, limit, along + slope * y);
                [p, p * y, rate, rate * y, rate * y * y]
            });
            add_moments(&mut sums, x, [p, py]);
            add_gram(&mut gram, x, [s, sy, syy]);
        }
        let missing = |k: usize| {
            if self.loaded[k] { self.target[k] - sums[k] } else { 0.0 }
        };
        AnswerSums { force: sums[0], mismatch: [0, 1, 2].map(missing), gram }
    }
}

/// Sums of a pressure that answers a motion Bμ.
struct AnswerSums {
    force: f64,
    /// Target less Bᵀp.
    mismatch: [f64; 3],
    /// Derivative of Bᵀp with respect to μ.
    gram: [[f64; 3]; 3],
}

/// The largest magnitude.
fn largest(values: [f64; 3]) -> f64 {
    values.iter().fold(0.0_f64, |a, b| a.max(b.abs()))
}

/// Sums over cells from which [`Freedoms::fitted`] finds the multipliers of the rigid motion.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FitSums {
    /// Force and scaled moments Bᵀp of the pressure.
    pub(crate) moments: [f64; 3],
    /// Bᵀv of the fitted values v over the contact.
    right: [f64; 3],
    /// Elements 11, 12, 13, 22, 23, 33 of BᵀB over the contact.
    gram: [f64; 6],
}

impl FitSums {
    /// Number of cells whose pressure is free.
    pub(crate) fn cells(&self) -> f64 {
        self.gram[0]
    }
}

impl Total for FitSums {
    const ZERO: Self = Self { moments: [0.0; 3], right: [0.0; 3], gram: [0.0; 6] };

    fn joined(self, other: Self) -> Self {
        Self {
            moments: self.moments.joined(other.moments),
            right: self.right.joined(other.right),
            gram: self.gram.joined(other.gram),
        }
    }
}

/// Sums over the contact of a field that is to be made orthogonal to the loaded degrees of freedom.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Products {
    /// Force and scaled moments of the field.
    pub(crate) moments: [f64; 3],
    /// Product with the residual.
    pub(crate) with_residual: f64,
    /// Product with the residual of the iteration before.
    pub(crate) with_last: f64,
}

impl Total for Products {
    const ZERO: Self = Self { moments: [0.0; 3], with_residual: 0.0, with_last: 0.0 };

    fn joined(self, other: Self) -> Self {
        Self {
            moments: self.moments.joined(other.moments),
            with_residual: self.with_residual + other.with_residual,
            with_last: self.with_last + other.with_last,
        }
    }
}

impl Freedoms {
    /// Rows of the grid: the coordinate x, and the range of cells.
    pub(crate) fn rows(&self) -> impl Iterator<Item = (f64, Range<usize>)> {
        let ny = self.columns[1].len();
        let x = self.columns[0].iter().enumerate();
        x.map(move |(i, &x)| (x, i * ny..(i + 1) * ny))
    }

    /// Calls `f` with each cell and its Bλ.
    pub(crate) fn for_each(&self, lambda: [f64; 3], mut f: impl FnMut(usize, f64)) {
        let [x, y] = &self.columns;
        let mut cell = 0;
        for x in x {
            let row = lambda[0] + lambda[1] * x;
            for y in y {
                f(cell, row + lambda[2] * y);
                cell += 1;
            }
        }
    }

    /// Force and scaled moments Bᵀv of `values` v.
    pub(crate) fn moments(&self, values: &[f64]) -> [f64; 3] {
        let mut sums = [0.0; 3];
        for (x, row) in self.rows() {
            let [s, sy] = sum([&values[row], &self.columns[1]], |[v, y]| [v, v * y]);
            add_moments(&mut sums, x, [s, sy]);
        }
        sums
    }

    /// Force and scaled moments of one row.
    pub(crate) fn moments_of(row: Row, values: &[f64]) -> [f64; 3] {
        let [s, sy] = sum([values, row.y], |[v, y]| [v, v * y]);
        [s, s * row.x, sy]
    }

    /// Sums over the contact cells of one row of a field; `p` is the pressure and `limit` its bound, `r` the residual
    /// and `before` the residual of the iteration before.
    pub(crate) fn products(
        row: Row,
        [p, limit, r, before]: [&[f64]; 4],
        values: &[f64],
    ) -> Products {
        let inputs = [p, limit, r, before, values, row.y];
        let [s, with_residual, with_last, sy] = sum(inputs, |[p, limit, r, before, v, y]| {
            let v = in_contact(p, limit, r) & v;
            [v, r * v, before * v, v * y]
        });
        Products { moments: [s, s * row.x, sy], with_residual, with_last }
    }

    /// Updates `fields` of one row by `step`, and returns the row's sums for a fit over the cells whose pressure is
    /// free below its `limit`.
    ///
    /// `step` gets the cells of three inputs, `limit` and y. It returns the new fields, and pressure and value to be
    /// fitted.
    pub(crate) fn fit_row<const N: usize>(
        row: Row,
        limit: &[f64],
        [a, b, c]: [&[f64]; 3],
        fields: [&mut [f64]; N],
        step: impl Fn([Lanes; 5], [Lanes; N]) -> ([Lanes; N], [Lanes; 2]),
    ) -> FitSums {
        let inputs = [a, b, c, limit, row.y];
        let [p, py, s, sy, syy, v, vy] = update(inputs, fields, |from, old| {
            let (new, [p, value]) = step(from, old);
            let (y, free) = (from[4], is_free(p, from[3]));
            let [weight, value] = [free & ONE, free & value];
            (new, [p, p * y, weight, weight * y, weight * y * y, value, value * y])
        });
        let x = row.x;
        FitSums {
            moments: [p, p * x, py],
            right: [v, v * x, vy],
            gram: [s, s * x, sy, s * x * x, sy * x, syy],
        }
    }

    /// Multipliers λ that make v − Bλ least over the contact, from the sums of [`Freedoms::fit_row`].
    /// Degrees of freedom that the contact does not determine are 0.
    pub(crate) fn fitted(&self, sums: FitSums) -> [f64; 3] {
        let [s, sx, sy, sxx, sxy, syy] = sums.gram;
        let gram = [[s, sx, sy], [sx, sxx, sxy], [sy, sxy, syy]];
        self.solve(&gram, sums.right)
    }

    /// Subtracts from `values`, which are 0 outside the contact, their best fit Bλ over the cells inside.
    pub(crate) fn project(&self, values: &mut [f64], inside: impl Fn(usize) -> bool) {
        let mut gram = [[0.0; 3]; 3];
        for (x, cells) in self.rows() {
            let members = cells.zip(&self.columns[1]).filter(|(k, _)| inside(*k));
            let add =
                |[s, sy, syy]: [f64; 3], (_, y): (usize, &f64)| [s + 1.0, sy + y, syy + y * y];
            add_gram(&mut gram, x, members.fold([0.0; 3], add));
        }
        self.for_each(self.solve(&gram, self.moments(values)), |k, b| {
            if inside(k) {
                values[k] -= b;
            }
        });
    }

    /// Solves for the loaded degrees of freedom; one that the others determine (a contact of one cell has
    /// no tilt) stays 0.
    pub(crate) fn solve(&self, matrix: &[[f64; 3]; 3], right: [f64; 3]) -> [f64; 3] {
        let (mut matrix, mut solution) = (*matrix, right);
        eliminate(&mut matrix, &mut solution, |k, pivot| self.loaded[k] && pivot > 0.0);
        solution
    }
}

/// Adds a row's sums of 1 and y to the sums of 1, x and y.
pub(crate) fn add_moments(sums: &mut [f64; 3], x: f64, [s, sy]: [f64; 2]) {
    sums[0] += s;
    sums[1] += s * x;
    sums[2] += sy;
}

/// Adds a row's sums of 1, y and y² to the symmetric matrix Σ b bᵀ, b = (1, x, y).
pub(crate) fn add_gram(sums: &mut [[f64; 3]; 3], x: f64, [s, sy, syy]: [f64; 3]) {
    let row = [[s, s * x, sy], [s * x, s * x * x, sy * x], [sy, sy * x, syy]];
    for (sum, value) in sums.as_flattened_mut().iter_mut().zip(row.as_flattened()) {
        *sum += value;
    }
}

#[cfg(test)]
mod tests {
    use crate::contact::options::Motion;
    use crate::contact::problem::bounds::Bounds;
    use crate::contact::problem::freedoms::Freedoms;
    use crate::error::Result;
    use crate::model::grid::Grid;
    use crate::numerics::parallel::{Lanes, Rows, Threads};

    const CELLS: [usize; 2] = [13, 18];
    const FIT_CELLS: [usize; 2] = [9, 14];

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

    /// Freedoms of a load that may tilt both ways, on a grid off the origin.
    fn tilting() -> Result<Freedoms> {
        let motion = Motion { eccentricity: [Some(0.1), Some(0.2)], ..Motion::load(1.0) };
        let grid = Grid::new(FIT_CELLS, [2.0, 3.0])?.centered_at([0.1, 0.2])?;
        Freedoms::new(&motion, &grid)
    }

    /// λ that fits `values` where `p` is positive.
    fn fit(freedoms: &Freedoms, p: &[f64], values: &[f64]) -> Result<[f64; 3]> {
        let threads = Threads::new(Some(1))?;
        let rows = Rows::new(&freedoms.columns, &threads);
        let bounds = Bounds::none(FIT_CELLS[1]);
        let sums = rows.each([p, values, values], [], |row, fields, []| {
            let step = |[p, v, ..]: [Lanes; 5], []: [Lanes; 0]| ([], [p, v]);
            Freedoms::fit_row(row, bounds.row(row.number), fields, [], step)
        });
        Ok(freedoms.fitted(sums))
    }

    /// An exact plane over the contact is found, whatever there is beside it: 1e-14 is the rounding of a hundred cells.
    #[test]
    fn a_plane_is_found() -> Result<()> {
        let freedoms = tilting()?;
        let lambda = [0.7, -1.3, 0.4];
        let cells = FIT_CELLS[0] * FIT_CELLS[1];
        let p: Vec<f64> = (0..cells).map(|k| (k * k % 11) as f64 - 2.0).collect();
        let mut values = vec![0.0; cells];
        freedoms.for_each(lambda, |k, b| {
            values[k] = if p[k] > 0.0 { b } else { f64::INFINITY };
        });
        let coefficients = fit(&freedoms, &p, &values)?;
        for k in 0..3 {
            assert!((coefficients[k] - lambda[k]).abs() < 1e-14, "{coefficients:?}");
        }
        Ok(())
    }

    /// Moments are those of plain sums, and the best plane through other values leaves a mismatch without them.
    #[test]
    fn the_mismatch_has_no_moments() -> Result<()> {
        let freedoms = tilting()?;
        let cells = FIT_CELLS[0] * FIT_CELLS[1];
        let p = vec![1.0; cells];
        let mut values: Vec<f64> = (0..cells).map(|k| (k * k % 23) as f64).collect();
        let [x, y] = &freedoms.columns;
        let mut sums = [0.0; 3];
        for (k, value) in values.iter().enumerate() {
            let (x, y) = (x[k / FIT_CELLS[1]], y[k % FIT_CELLS[1]]);
            sums = [sums[0] + value, sums[1] + value * x, sums[2] + value * y];
        }
        for (moment, sum) in freedoms.moments(&values).iter().zip(sums) {
            assert!((moment - sum).abs() < 1e-11, "{moment} {sum}");
        }
        let lambda = fit(&freedoms, &p, &values)?;
        freedoms.for_each(lambda, |k, b| values[k] -= b);
        for moment in freedoms.moments(&values) {
            assert!(moment.abs() < 1e-11, "{moment:e}");
        }
        Ok(())
    }

    /// One cell has no tilt; two in a line have one along the line, and none across.
    #[test]
    fn few_cells_leave_tilts_alone() -> Result<()> {
        let freedoms = tilting()?;
        let [x, y] = &freedoms.columns;
        let [cell, along_x, along_y] =
            [4 * FIT_CELLS[1] + 3, 7 * FIT_CELLS[1] + 3, 4 * FIT_CELLS[1] + 8];
        let with = |cells: &[(usize, f64)]| {
            let (mut p, mut values) = (vec![0.0; FIT_CELLS[0] * FIT_CELLS[1]], Vec::new());
            values.resize(p.len(), 9.0);
            for &(k, value) in cells {
                (p[k], values[k]) = (2.0, value);
            }
            fit(&freedoms, &p, &values)
        };
        let sx = 0.5 / (x[7] - x[4]);
        let sy = 0.5 / (y[8] - y[3]);
        for (coefficients, expected) in [
            (with(&[(cell, 2.5)])?, [2.5, 0.0, 0.0]),
            (with(&[(cell, 2.5), (along_x, 3.0)])?, [2.5 - sx * x[4], sx, 0.0]),
            (with(&[(cell, 2.5), (along_y, 3.0)])?, [2.5 - sy * y[3], 0.0, sy]),
        ] {
            for k in 0..3 {
                assert!(
                    (coefficients[k] - expected[k]).abs() < 1e-13,
                    "{coefficients:?} {expected:?}"
                );
            }
        }
        Ok(())
    }
}
