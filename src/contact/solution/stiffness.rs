//! The tangent stiffness of a solved contact.

use std::ops::ControlFlow;

use super::tangent::Tangent;
use crate::contact::Solution;
use crate::contact::problem::patch::bounds;
use crate::error::Result;
use crate::model::grid::full_window;
use crate::numerics::parallel::dot;

/// Residual of the linear systems. The error of the stiffness is its square.
const TOLERANCE: f64 = 1e-9;

impl Solution {
    /// The exact tangent of (Σ p dA, Σ p x dA, Σ p y dA) with respect to (δ, s_x, s_y), of the
    /// discrete contact: symmetric, in N/m, N and N m.
    ///
    /// In a line contact δ is counted from the datum of [`Grid::line`](crate::Grid::line): below a stiff layer
    /// that is wider than the grid, δ may fall as the load grows. There is no tilt along directions in which the grid
    /// repeats: rows and columns of these are 0.
    ///
    /// The second row is the couple about y in which force at positive x is positive. While the
    /// contact C stays, K p = δ + s_x x + s_y y − h on it, so that the tangent is
    /// dA Bᵀ K_CC⁻¹ B, where B = (1, x, y) on C. All zero where nothing touches.
    ///
    /// # Errors
    /// Too little memory, or [`Error::NotConverged`](crate::Error::NotConverged).
    ///
    /// ```
    /// use nacre::{Contact, Elastic, FlatPunch, Grid, Motion, Options, Setup};
    /// // A rigid flat punch of radius a on a half-space: dW/dδ = 2 E* a.
    /// let contact = Contact::plan(Elastic::new(1.0, 0.0)?, Grid::new([64, 64], [2.5, 2.5])?, Setup::default())?;
    /// let solution = contact.solve(&FlatPunch::new(1.0)?, &Motion::load(1.0), &Options::default())?;
    /// let [[normal, coupled, _], ..] = solution.stiffness()?;
    /// assert!((normal / 2.0 - 1.0).abs() < 0.02 && coupled.abs() < 1e-9);
    /// # Ok::<(), nacre::Error>(())
    /// ```
    pub fn stiffness(&self) -> Result<[[f64; 3]; 3]> {
        let never = &mut || ControlFlow::Continue(());
        Ok(self.stiffness_watched(never)?.unwrap_or_default())
    }

    /// [`Solution::stiffness`] that asks `watch` before each iteration whether to go on; `None` where
    /// `watch` breaks.
    ///
    /// # Errors
    /// Too little memory, or [`Error::NotConverged`](crate::Error::NotConverged).
    pub fn stiffness_watched(
        &self,
        watch: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Result<Option<[[f64; 3]; 3]>> {
        let touching = |i: usize, j: usize| self.pressure[[i, j]] > 0.0;
        let Some(window) = bounds(&full_window(self.grid().shape()), touching) else {
            return Ok(Some([[0.0; 3]; 3]));
        };
        let tangent = Tangent::plan(self, window)?;
        let mut columns: Vec<[Vec<f64>; 2]> = Vec::new();
        for freedom in 0..3 {
            let right = tangent.column(freedom);
            let Some(pressure) = tangent.solve(&right, TOLERANCE, watch)? else {
                return Ok(None);
            };
            columns.push([right, pressure]);
        }
        // bᵢᵀxⱼ + xᵢᵀ(bⱼ − K xⱼ): symmetric, and in error by the square of the residual alone.
        let mut workspace = tangent.convolution().workspace();
        let mut stiffness = [[0.0; 3]; 3];
        for (j, [b, x]) in columns.iter().enumerate() {
            let mut rest = vec![0.0; b.len()];
            tangent.apply_on_contact(x, &mut rest, &mut workspace);
            rest.iter_mut().zip(b).for_each(|(r, b)| *r = b - *r);
            for (i, [b, y]) in columns.iter().enumerate() {
                stiffness[i][j] = dot(b, x) + dot(y, &rest);
            }
        }
        tangent.lower_datum(&mut stiffness);
        let mut stiffness = tangent.about_origin(stiffness);
        for axis in (0..2).filter(|&axis| self.grid().is_periodic()[axis]) {
            stiffness[axis + 1] = [0.0; 3];
            stiffness.iter_mut().for_each(|row| row[axis + 1] = 0.0);
        }
        Ok(Some(stiffness))
    }
}

impl Tangent {
    /// Turns the tangent for K into that for K − s 1ᵀ1, by the formula of Sherman & Morrison.
    fn lower_datum(&self, stiffness: &mut [[f64; 3]; 3]) {
        let column = stiffness.map(|row| row[0]);
        let factor = self.raise / (1.0 - self.raise * column[0]);
        for (row, a) in stiffness.iter_mut().zip(column) {
            for (entry, b) in row.iter_mut().zip(column) {
                *entry += factor * a * b;
            }
        }
    }

    /// Aᵀ S A dA, where (1, x, y) = (columns of B) A.
    fn about_origin(&self, scaled: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        let ([x, y], [lx, ly]) = (self.origin, self.scale);
        let columns = [[1.0, 0.0, 0.0], [x, lx, 0.0], [y, 0.0, ly]];
        let form = |a: [f64; 3], b: [f64; 3]| -> f64 {
            let row = |i: usize| (0..3).map(|j| scaled[i][j] * b[j]).sum::<f64>();
            (0..3).map(|i| a[i] * row(i)).sum::<f64>() * self.cell_area
        };
        columns.map(|a| columns.map(|b| form(a, b)))
    }
}
