//! Rolling to second order in the length d of a cell; derived here.
//!
//! The difference u(x) − u(x + d) is d times the slope of u half a cell ahead of the cell. There the slip is, over a cell,
//!
//! ```text
//! s d = W(x + d/2) d − [u(x) − u(x + d)] − Γ q                                          (1)
//! ```
//!
//! A leading cell, which has pressure while the cell ahead has none, compares itself with a place outside of the contact.
//! From the edge outwards, at a distance ρ, gap and displacement leave the line of rigid motion like ρ^{3/2}: from
//! p = A_p √ρ and q = A_q √ρ inside follow the gap ⅔ αc11 A_p ρ^{3/2} and the deviation of u ⅔ αc A_q ρ^{3/2}, with c22 across
//! the edge and c_t along it. So the deviation is Γ q with
//!
//! ```text
//! Γ = g [κ_n n nᵀ + κ_t (1 − n nᵀ)]      g = gap ahead/p      κ_n = c22/c11      κ_t = c_t/c11      (2)
//! ```
//!
//! wherever the edge lies in its cell. The normal n of the edge is that along which p², linear in ρ, falls. At a sharp
//! edge, where p grows outwards, or where the surface ahead cannot touch, the border of the cell is the edge:
//! both p and q are as 1/√ρ, and
//!
//! ```text
//! g = 0.153 d αc11                                                                      (3)
//! ```
//!
//! is that with which the force on a plane punch that sticks, πW/αc11 per half-width, has no error of first order.
//!
//! A slipping cell has its traction along the slip at its centre, which follows from those of two half-points, or at the
//! leading edge from the motion alone:
//!
//! ```text
//! s̃ = s + φ/2 (s − s ahead)      φ = min(1, |s|/|s − s ahead|)
//! s̃ = s − φ [W(x + d/2) − W(x)]   φ = min(1, |s|/2|W(x + d/2) − W(x)|)    in leading cells   (4)
//! ```
//!
//! so that |s̃ − s| ≤ |s|/2, and slip is not against the traction.

use std::f64::consts::PI;

use ndarray::Array2;

use super::coulomb::CellState;
use super::step::RollingDirection;
use crate::compliance::traction::Tangential;
use crate::model::grid::{Grid, Window, each_cell};

/// Factor of (3): the root of the error of that force on n cells, found on 40 to 1280 cells; it is 0.15297 − 0.037/n.
const SHARP: f64 = 0.15297;

/// Largest g over the difference of the coefficients of a cell and of that ahead. From there on a leading cell has no
/// traction to a thousandth.
const RIGID: f64 = 1e3;

/// The leading cells of a contact, and the change from half-points to centres, on a window.
#[derive(Debug)]
pub(super) struct SecondOrder {
    /// Places of leading cells, and xx, xy, yy of their Γ.
    leading: Vec<(usize, [f64; 3])>,
    /// Place of the cell ahead where that has pressure.
    ahead: Vec<Option<usize>>,
    /// W(x + d/2) − W(x), over a cell.
    arm: [f64; 2],
    is_forward: bool,
}

impl SecondOrder {
    /// Rolling along `direction` with a rotation of `turn` over a cell, where the `pressure` and the `gap` are those of
    /// the grid, on cells of the `window`. `own` are the coefficients of a cell less those of the cell ahead.
    pub(super) fn new(
        direction: RollingDirection,
        turn: f64,
        [pressure, gap]: [&Array2<f64>; 2],
        (grid, window): (&Grid, &Window),
        (tangential, own): (&Tangential, [f64; 2]),
    ) -> Self {
        let axis = direction.axis();
        let spacing = grid.spacing();
        let (d, across) = (spacing[axis], spacing[1 - axis]);
        let [ex, ey] = direction.vector();
        let columns = window[1].len();
        let place = |[i, j]: [usize; 2]| (i - window[0].start) * columns + j - window[1].start;
        let beside = |[i, j]: [usize; 2], [x, y]: [f64; 2]| {
            let cell = [i.checked_add_signed(x as isize)?, j.checked_add_signed(y as isize)?];
            (cell[0] < pressure.nrows() && cell[1] < pressure.ncols()).then_some(cell)
        };
        let [c11, c22, ct] = tangential.waves(PI / (2.0 * d));
        let kappa = [c22 / c11, ct / c11];
        let sharp = SHARP * d * c11;
        let most = RIGID * own[0].max(own[1]);
        let mut leading = Vec::new();
        let mut ahead = vec![None; window[0].len() * columns];
        for (i, j) in each_cell(window).filter(|(i, j)| pressure[[*i, *j]] > 0.0) {
            let cell = [i, j];
            let p = pressure[cell];
            // RollsOffGrid refuses contacts without a cell ahead.
            let Some(next) = beside(cell, [ex, ey]) else { continue };
            if pressure[next] > 0.0 {
                ahead[place(cell)] = Some(place(next));
                continue;
            }
            let at = |offset: [f64; 2]| beside(cell, offset).map_or(0.0, |cell| pressure[cell]);
            let behind = at([-ex, -ey]);
            let is_sharp = p > behind || !gap[next].is_finite();
            let g = if is_sharp { sharp } else { gap[next].max(0.0) / p };
            let along = (behind.powi(2) - p.powi(2)).max(0.0) / d;
            let sideways = (at([ey, -ex]).powi(2) - at([-ey, ex]).powi(2)) / (2.0 * across);
            let size = along.hypot(sideways);
            let [a, b] = if size > 0.0 { [along / size, sideways / size] } else { [1.0, 0.0] };
            let n = [a * ex - b * ey, a * ey + b * ex];
            let [normal, parallel] = kappa.map(|kappa| (g * kappa).min(most));
            let entry = |k: usize, l: usize| {
                let unit = if k == l { 1.0 } else { 0.0 };
                normal * n[k] * n[l] + parallel * (unit - n[k] * n[l])
            };
            leading.push((place(cell), [entry(0, 0), entry(0, 1), entry(1, 1)]));
        }
        let arm = [-0.5 * d * turn * ey, 0.5 * d * turn * ex];
        Self { leading, ahead, arm, is_forward: direction.is_forward() }
    }

    /// Adds Γ q.
    pub(super) fn deviate(&self, q: &[f64], out: &mut [f64]) {
        let cells = self.ahead.len();
        for (i, [xx, xy, yy]) in &self.leading {
            let (x, y) = (q[*i], q[cells + i]);
            out[*i] += xx * x + xy * y;
            out[cells + i] += xy * x + yy * y;
        }
    }

    /// Places of leading cells, and xx and yy of their Γ.
    pub(super) fn leading(&self) -> impl Iterator<Item = (usize, [f64; 2])> {
        self.leading.iter().map(|(place, [xx, _, yy])| (*place, [*xx, *yy]))
    }

    /// Takes residuals −s d of the half-points to the centres of slipping cells, by (4); `arm` is the factor of the motion's
    /// part: 1, and 0 for changes of residuals under a given motion.
    pub(super) fn centre(&self, states: &[CellState], field: &mut [f64], arm: f64) {
        let cells = states.len();
        let mut take = |i: usize| {
            let CellState::Slip { centring, .. } = states[i] else { return };
            for (axis, part) in self.arm.into_iter().enumerate() {
                let here = axis * cells + i;
                field[here] += centring
                    * match self.ahead[i] {
                        Some(ahead) => 0.5 * (field[here] - field[axis * cells + ahead]),
                        None => arm * part,
                    };
            }
        };
        // A cell before that ahead of it.
        match self.is_forward {
            true => (0..cells).for_each(&mut take),
            false => (0..cells).rev().for_each(&mut take),
        }
    }

    /// φ and λ/μp of slipping cells, for residuals `r` of the half-points.
    pub(super) fn weigh(&self, bound: &[f64], r: &[f64], states: &mut [CellState]) {
        let cells = states.len();
        let at = |place: usize| [r[place], r[cells + place]];
        for (i, state) in states.iter_mut().enumerate() {
            if let CellState::Slip { n, weight, centring } = state {
                let here = at(i);
                let change = match self.ahead[i] {
                    Some(ahead) => [0, 1].map(|axis| 0.5 * (here[axis] - at(ahead)[axis])),
                    None => self.arm,
                };
                let (size, most) = (0.5 * here[0].hypot(here[1]), change[0].hypot(change[1]));
                *centring = if most > size { size / most } else { 1.0 };
                let along = |axis: usize| n[axis] * (here[axis] + *centring * change[axis]);
                *weight = (-along(0) - along(1)).max(0.0) / bound[i];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use ndarray::Array2;

    use super::SecondOrder;
    use crate::compliance::response::Body;
    use crate::compliance::traction::Tangential;
    use crate::error::Result;
    use crate::friction::RollingDirection;
    use crate::model::grid::{Grid, full_window};
    use crate::model::material::Elastic;
    use crate::numerics::parallel::Threads;

    /// Γ has the axes of the slope of p², here of an ellipse: (2x − d)/a² towards the cell behind, 2y/b² between those
    /// on both sides.
    #[test]
    fn the_edge_is_normal_to_the_slope_of_the_squared_pressure() -> Result<()> {
        let (body, grid) = (Body::from(Elastic::new(1.0, 0.3)?), Grid::new([24, 20], [2.4, 1.6])?);
        let tangential = Tangential::plan(&body, None, &grid, &Arc::new(Threads::new(Some(1))?))?;
        let (x, y, d, [a, b]) = (grid.x(), grid.y(), grid.spacing()[0], [1.0, 0.7]);
        let squared = |i: usize, j: usize| 1.0 - (x[i] / a).powi(2) - (y[j] / b).powi(2);
        let pressure = Array2::from_shape_fn(grid.shape(), |(i, j)| squared(i, j).max(0.0).sqrt());
        let gap = pressure.mapv(|p| if p > 0.0 { 0.0 } else { 0.01 });
        let order = SecondOrder::new(
            RollingDirection::PlusX,
            0.0,
            [&pressure, &gap],
            (&grid, &full_window(grid.shape())),
            (&tangential, [1.0; 2]),
        );
        let mut compared = 0;
        for (place, [xx, xy, yy]) in &order.leading {
            let [i, j] = [place / y.len(), place % y.len()];
            if squared(i, j - 1).min(squared(i, j + 1)) > 0.0 {
                let n = [(2.0 * x[i] - d) / (a * a), 2.0 * y[j] / (b * b)];
                let turned = xy * (n[0] * n[0] - n[1] * n[1]) - (xx - yy) * n[0] * n[1];
                assert!(turned.abs() < 1e-12 * (xx + yy) * (n[0] * n[0] + n[1] * n[1]));
                compared += 1;
            }
        }
        assert!(compared > 4, "{compared}");
        Ok(())
    }
}
