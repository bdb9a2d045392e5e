//! Moments of fields, and the motion of the loaded freedoms that fits them best.

use std::ops::Range;

use super::freedoms::Freedoms;
use super::passes::Row;
use super::sums::{ONE, all, sum, update, where_member, where_positive};

/// Sums over rows of which [`Freedoms::fitted`] makes a motion: Bᵀv, and the upper half of BᵀB.
pub(super) type FitSums = [f64; 9];

impl Freedoms {
    /// Rows of the grid: x, and which cells.
    pub(super) fn rows(&self) -> impl Iterator<Item = (f64, Range<usize>)> {
        let ny = self.columns[1].len();
        let x = self.columns[0].iter().enumerate();
        x.map(move |(i, &x)| (x, i * ny..(i + 1) * ny))
    }

    /// Calls `f` with each cell and its Bλ.
    pub(super) fn for_each(&self, lambda: [f64; 3], mut f: impl FnMut(usize, f64)) {
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
    pub(super) fn moments(&self, values: &[f64]) -> [f64; 3] {
        let mut sums = [0.0; 3];
        for (x, row) in self.rows() {
            let [s, sy] = sum([&values[row], &self.columns[1]], |[v, y]| [v, v * y]);
            add_moments(&mut sums, x, [s, sy]);
        }
        sums
    }

    /// The same of one row; without what is not loaded.
    pub(super) fn moments_of(&self, row: Row, values: &[f64]) -> [f64; 3] {
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
    pub(super) fn products_on(
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

    /// What one row adds to the fit of u + h − Bλ over the cells with pressure, where λ is `near`.
    pub(super) fn fit_of(&self, row: Row, [p, u, h]: [&[f64]; 3], near: [f64; 3]) -> FitSums {
        let (base, slope) = (all(near[0] + near[1] * row.x), all(near[2]));
        let [s, sy, syy, f, fy] = if self.loaded[2] {
            sum([p, u, h, row.y], |[p, u, h, y]| {
                let weight = where_positive(p, ONE);
                let value = where_positive(p, (h - (base + slope * y)) + u);
                [weight, weight * y, weight * y * y, value, value * y]
            })
        } else {
            let [s, f] = sum([p, u, h, row.y], |[p, u, h, y]| {
                let value = where_positive(p, (h - (base + slope * y)) + u);
                [where_positive(p, ONE), value]
            });
            [s, 0.0, 0.0, f, 0.0]
        };
        let x = row.x;
        [f, f * x, fy, s, s * x, sy, s * x * x, sy * x, syy]
    }

    /// The change of λ that the sums of [`Freedoms::fit_of`] give.
    pub(super) fn fitted(&self, sums: FitSums) -> [f64; 3] {
        let [f, fx, fy, s, sx, sy, sxx, sxy, syy] = sums;
        let gram = [[s, sx, sy], [sx, sxx, sxy], [sy, sxy, syy]];
        self.solve(&gram, [f, fx, fy])
    }

    /// Takes from `values` what is nearest to them of the form Bλ over the cells of which `member` is
    /// not 0, and all of them outside.
    pub(super) fn project(&self, values: &mut [f64], member: &[f64]) {
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
    pub(super) fn solve(&self, matrix: &[[f64; 3]; 3], right: [f64; 3]) -> [f64; 3] {
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
pub(super) fn add_moments(sums: &mut [f64; 3], x: f64, [s, sy]: [f64; 2]) {
    sums[0] += s;
    sums[1] += s * x;
    sums[2] += sy;
}

/// Adds the sums of a row, of 1, y and y², to the upper half of those of b bᵀ, b = (1, x, y).
pub(super) fn add_gram(sums: &mut [[f64; 3]; 3], x: f64, [s, sy, syy]: [f64; 3]) {
    sums[0][0] += s;
    sums[0][1] += s * x;
    sums[0][2] += sy;
    sums[1][1] += s * x * x;
    sums[1][2] += sy * x;
    sums[2][2] += syy;
}

pub(super) fn symmetric(mut upper: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    upper[1][0] = upper[0][1];
    upper[2][0] = upper[0][2];
    upper[2][1] = upper[1][2];
    upper
}
