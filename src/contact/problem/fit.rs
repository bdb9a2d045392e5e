//! Moments of fields, and the motion of the loaded freedoms that fits them best.

use std::ops::Range;

use crate::contact::problem::freedoms::Freedoms;
use crate::parallel::Row;
use crate::parallel::{Lanes, ONE, sum, update, where_member, where_positive};

/// Sums over cells, in this order: what [`Freedoms::fit_of`] counts; force and moments of the pressure; and
/// of which [`Freedoms::fitted`] makes a motion, Bᵀv, and the upper half of BᵀB. Those with y are 0 where the
/// tilt along y is not loaded.
pub(crate) type FitSums = [f64; 13];

impl Freedoms {
    /// Rows of the grid: x, and which cells.
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

    /// Σ over cells of `values` · (1, x, y).
    pub(crate) fn moments(&self, values: &[f64]) -> [f64; 3] {
        let mut sums = [0.0; 3];
        for (x, row) in self.rows() {
            let [s, sy] = sum([&values[row], &self.columns[1]], |[v, y]| [v, v * y]);
            add_moments(&mut sums, x, [s, sy]);
        }
        sums
    }

    /// The same of one row; without what is not loaded.
    pub(crate) fn moments_of(&self, row: Row, values: &[f64]) -> [f64; 3] {
        let [s, sy] = if self.loaded[2] {
            sum([values, row.y], |[v, y]| [v, v * y])
        } else {
            let [s] = sum([values], |[v]| [v]);
            [s, 0.0]
        };
        [s, s * row.x, sy]
    }

    /// Moments over the cells of which the residual `r` is not 0, as [`Freedoms::moments_of`] gives them;
    /// and the products with the residual, and over the same cells with the one `before`.
    pub(crate) fn products_on(
        &self,
        row: Row,
        [r, before]: [&[f64]; 2],
        values: &[f64],
    ) -> [f64; 5] {
        let [s, sy, now, last] = if self.loaded[2] {
            sum([r, before, values, row.y], |[r, before, v, y]| {
                let v = where_member(r, v);
                [v, v * y, r * v, before * v]
            })
        } else {
            let [s, now, last] = sum([r, before, values], |[r, before, v]| {
                let v = where_member(r, v);
                [v, r * v, before * v]
            });
            [s, 0.0, now, last]
        };
        [s, s * row.x, sy, now, last]
    }

    /// Updates fields of a row by `step`, from three others and y, and returns what the row adds to the fit
    /// over the cells with pressure. Beside the fields `step` makes pressure, what is fitted, and something
    /// to count.
    pub(crate) fn fit_of<const N: usize>(
        &self,
        row: Row,
        [a, b, c]: [&[f64]; 3],
        fields: [&mut [f64]; N],
        step: impl Fn([Lanes; 4], [Lanes; N]) -> ([Lanes; N], [Lanes; 3]),
    ) -> FitSums {
        let terms = |from, old| {
            let (new, [p, value, counted]) = step(from, old);
            let [weight, value] = [ONE, value].map(|value| where_positive(p, value));
            (new, [counted, p, weight, value])
        };
        let inputs = [a, b, c, row.y];
        let [counted, p, py, s, sy, syy, v, vy] = if self.loaded[2] {
            update(inputs, fields, |from, old| {
                let y = from[3];
                let (new, [counted, p, weight, value]) = terms(from, old);
                let [sy, syy] = [weight * y, weight * y * y];
                (new, [counted, p, p * y, weight, sy, syy, value, value * y])
            })
        } else {
            let [counted, p, s, v] = update(inputs, fields, terms);
            [counted, p, 0.0, s, 0.0, 0.0, v, 0.0]
        };
        let x = row.x;
        let (sx, sxx, sxy) = (s * x, s * x * x, sy * x);
        [
            counted,
            p,
            p * x,
            py,
            v,
            v * x,
            vy,
            s,
            sx,
            sy,
            sxx,
            sxy,
            syy,
        ]
    }

    /// The change of λ that the sums of [`Freedoms::fit_of`] give.
    pub(crate) fn fitted(&self, sums: FitSums) -> [f64; 3] {
        let [_, _, _, _, v, vx, vy, s, sx, sy, sxx, sxy, syy] = sums;
        let gram = [[s, sx, sy], [sx, sxx, sxy], [sy, sxy, syy]];
        self.solve(&gram, [v, vx, vy])
    }

    /// Takes from `values` what is nearest to them of the form Bλ over the cells of which `member` is
    /// not 0, and all of them outside.
    pub(crate) fn project(&self, values: &mut [f64], member: &[f64]) {
        let (mut right, mut gram) = ([0.0; 3], [[0.0; 3]; 3]);
        for (x, row) in self.rows() {
            let (values, member) = (&mut values[row.clone()], &member[row]);
            let sums = update(
                [member, &self.columns[1]],
                [values],
                |[member, y], [value]| {
                    let member = where_member(member, ONE);
                    let value = member * value;
                    let sums = [value, value * y, member, member * y, member * y * y];
                    ([value], sums)
                },
            );
            let [f, fy, s, sy, syy] = sums;
            add_moments(&mut right, x, [f, fy]);
            add_gram(&mut gram, x, [s, sy, syy]);
        }
        let mean = self.solve(&symmetric(gram), right);
        self.for_each(mean, |k, b| {
            if member[k] != 0.0 {
                values[k] -= b;
            }
        });
    }

    /// Solves for the loaded freedoms; one that the others determine (a contact of one cell has no
    /// tilt) stays 0.
    pub(crate) fn solve(&self, matrix: &[[f64; 3]; 3], right: [f64; 3]) -> [f64; 3] {
        let mut a = *matrix;
        let mut b = right;
        let mut pivots = self.loaded;
        for k in 0..3 {
            pivots[k] = pivots[k] && a[k][k] > 1e-13 * matrix[k][k];
            if !pivots[k] {
                continue;
            }
            for row in k + 1..3 {
                let factor = a[row][k] / a[k][k];
                let pivot_row = a[k];
                for (entry, above) in a[row].iter_mut().zip(pivot_row).skip(k) {
                    *entry -= factor * above;
                }
                b[row] -= factor * b[k];
            }
        }
        let mut solution = [0.0; 3];
        for k in (0..3).rev().filter(|&k| pivots[k]) {
            let known: f64 = (k + 1..3).map(|c| a[k][c] * solution[c]).sum();
            solution[k] = (b[k] - known) / a[k][k];
        }
        solution
    }
}

/// Adds the sums of a row, of 1 and y, to those of 1, x and y.
pub(crate) fn add_moments(sums: &mut [f64; 3], x: f64, [s, sy]: [f64; 2]) {
    sums[0] += s;
    sums[1] += s * x;
    sums[2] += sy;
}

/// Adds the sums of a row, of 1, y and y², to the upper half of those of b bᵀ, b = (1, x, y).
pub(crate) fn add_gram(sums: &mut [[f64; 3]; 3], x: f64, [s, sy, syy]: [f64; 3]) {
    sums[0][0] += s;
    sums[0][1] += s * x;
    sums[0][2] += sy;
    sums[1][1] += s * x * x;
    sums[1][2] += sy * x;
    sums[2][2] += syy;
}

pub(crate) fn symmetric(mut upper: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    upper[1][0] = upper[0][1];
    upper[2][0] = upper[0][2];
    upper[2][1] = upper[1][2];
    upper
}
