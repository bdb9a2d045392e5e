//! Degrees of freedom of the rigid motion on a grid: a [`Motion`] that was checked.

use std::ops::Range;

use ndarray::Array2;

use crate::contact::motion::Motion;
use crate::error::{Error, Result, finite, positive};
use crate::model::grid::Grid;

/// The degrees of freedom in g = h + u − Bλ: the columns of B are the loaded ones 1, (x − x0)/ℓx,
/// (y − y0)/ℓy, and the prescribed ones are part of h.
#[derive(Debug, Clone)]
pub(crate) struct Freedoms {
    /// Whether approach, tilt along x and tilt along y are loaded.
    pub(crate) loaded: [bool; 3],
    /// Bᵀp that is asked for; 0 where prescribed.
    pub(crate) target: [f64; 3],
    /// Prescribed δ, s_x, s_y; 0 where loaded.
    prescribed: [f64; 3],
    /// (x0, y0)
    pub(super) origin: [f64; 2],
    /// (ℓx, ℓy)
    pub(super) scale: [f64; 2],
    /// Scaled coordinates (x − x0)/ℓx and (y − y0)/ℓy of the lines of cells.
    pub(crate) columns: [Vec<f64>; 2],
    /// Coordinates of the lines of cells.
    coordinates: [Vec<f64>; 2],
    pub(crate) cell_area: f64,
}

/// Messages for a direction with more than one condition.
const DIRECTIONS: [&str; 2] = [
    "along x at most one of eccentricity, moment and tilt can be a number",
    "along y at most one of eccentricity, moment and tilt can be a number",
];

/// Messages for a direction in which the grid repeats.
const PERIODIC: [&str; 2] = [
    "along x the grid is periodic: eccentricity, moment and tilt must be None there",
    "along y the grid is periodic: eccentricity, moment and tilt must be None there",
];

/// The error for numbers that are too large to be computed with.
pub(crate) const OVERFLOW: Error = Error::Inconsistent(
    "load, lengths, moduli and friction must be in units in which their products neither overflow nor vanish",
);

impl Freedoms {
    /// Checks `motion` and expresses it on `grid`.
    pub(crate) fn new(motion: &Motion, grid: &Grid) -> Result<Self> {
        let mut prescribed = [0.0; 3];
        let mut loaded = [false; 3];
        let mut target = [0.0; 3];
        let area = grid.cell_area();
        let scale = grid.size().map(|length| 0.5 * length);
        match (motion.load, motion.approach) {
            (Some(load), None) => {
                loaded[0] = true;
                target[0] = positive("load", load)? / area;
            }
            (None, Some(approach)) => prescribed[0] = finite("approach", approach)?,
            _ => {
                return Err(Error::Inconsistent(
                    "exactly one of load and approach must be given",
                ));
            }
        }
        // Under a load the columns may be centred, which keeps them independent.
        let origin = if loaded[0] { grid.center() } else { [0.0; 2] };
        for k in 0..2 {
            let given = [motion.eccentricity[k], motion.moment[k], motion.tilt[k]];
            if grid.is_periodic()[k] && given != [None; 3] {
                return Err(Error::Inconsistent(PERIODIC[k]));
            }
            let moment = match (motion.eccentricity[k], motion.moment[k], motion.tilt[k]) {
                (None, None, None) => continue,
                (None, None, Some(tilt)) => {
                    prescribed[k + 1] = finite("tilt", tilt)?;
                    continue;
                }
                (None, Some(moment), None) => finite("moment", moment)?,
                (Some(eccentricity), None, None) => {
                    let load = motion.load.ok_or(Error::Inconsistent(
                        "eccentricity needs load: under a given approach, give moment",
                    ))?;
                    finite("eccentricity", eccentricity)? * load
                }
                _ => return Err(Error::Inconsistent(DIRECTIONS[k])),
            };
            if k == 0 && grid.is_line() {
                return Err(Error::Inconsistent(
                    "along x a line contact has no eccentricity and no moment",
                ));
            }
            loaded[k + 1] = true;
            target[k + 1] = (moment / area - origin[k] * target[0]) / scale[k];
        }
        // Products like Σ p u are of second degree in the target.
        let vanishes = loaded[0] && target[0] < f64::MIN_POSITIVE / f64::EPSILON;
        if vanishes || target.iter().any(|sum| !(sum * sum).is_finite()) {
            return Err(OVERFLOW);
        }
        let coordinates = [0, 1].map(|k| grid.coordinates(k).to_vec());
        let columns = [0, 1].map(|k| {
            let line = coordinates[k].iter();
            line.map(|x| (x - origin[k]) / scale[k]).collect()
        });
        Ok(Self {
            loaded,
            target,
            prescribed,
            origin,
            scale,
            columns,
            coordinates,
            cell_area: area,
        })
    }

    /// A uniform pressure on `cells` cells whose sum is of the size of the target.
    pub(crate) fn typical_pressure(&self, cells: usize) -> f64 {
        let asked = self.target.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        if asked > 0.0 {
            asked / cells as f64
        } else {
            1.0
        }
    }

    /// Whether the prescribed motion changes the gap.
    pub(crate) fn any_prescribed(&self) -> bool {
        self.prescribed.iter().any(|&freedom| freedom != 0.0)
    }

    /// Subtracts the prescribed motion from the gap: h − δ − s_x x − s_y y.
    pub(crate) fn prescribe(&self, gap: &mut Array2<f64>) {
        let [delta, sx, sy] = self.prescribed;
        let [x, y] = &self.coordinates;
        for (mut row, x) in gap.rows_mut().into_iter().zip(x) {
            let shift = delta + sx * x;
            row.iter_mut()
                .zip(y)
                .for_each(|(h, y)| *h -= shift + sy * y);
        }
    }

    /// Approach δ and tilt (s_x, s_y), from the multipliers λ of the loaded degrees of freedom.
    pub(crate) fn rigid_motion(&self, lambda: [f64; 3]) -> (f64, [f64; 2]) {
        let slope = [0, 1].map(|k| lambda[k + 1] / self.scale[k]);
        let tilt = [0, 1].map(|k| self.prescribed[k + 1] + slope[k]);
        let shift = slope[0] * self.origin[0] + slope[1] * self.origin[1];
        (self.prescribed[0] + lambda[0] - shift, tilt)
    }

    /// The moment Σ p x dA or Σ p y dA about the origin of x and y, from that of a column.
    pub(crate) fn moment(&self, axis: usize, column: f64) -> f64 {
        let load = if self.loaded[0] { self.target[0] } else { 0.0 };
        (self.scale[axis] * column + self.origin[axis] * load) * self.cell_area
    }

    /// These degrees of freedom on the cells of a window of the grid.
    pub(crate) fn in_window(&self, [x, y]: [Range<usize>; 2]) -> Self {
        let cut =
            |lines: &[Vec<f64>; 2]| [lines[0][x.clone()].to_vec(), lines[1][y.clone()].to_vec()];
        Self {
            columns: cut(&self.columns),
            coordinates: cut(&self.coordinates),
            ..self.clone()
        }
    }

    /// These degrees of freedom on a grid whose cells are twice as long in the directions of `halved`.
    pub(crate) fn coarse(&self, halved: [bool; 2]) -> Self {
        let coarse = |lines: &[Vec<f64>; 2]| {
            [0, 1].map(|k| {
                if !halved[k] {
                    return lines[k].clone();
                }
                let step = lines[k][1] - lines[k][0];
                lines[k].iter().step_by(2).map(|x| x + 0.5 * step).collect()
            })
        };
        let cells: f64 = halved.iter().map(|&h| if h { 2.0 } else { 1.0 }).product();
        Self {
            columns: coarse(&self.columns),
            coordinates: coarse(&self.coordinates),
            target: self.target.map(|sum| sum / cells),
            cell_area: self.cell_area * cells,
            ..self.clone()
        }
    }

    /// Whether any degree of freedom is loaded.
    pub(crate) fn any_loaded(&self) -> bool {
        self.loaded.contains(&true)
    }

    /// Whether the force is the only loaded degree of freedom.
    pub(crate) fn only_force(&self) -> bool {
        self.loaded == [true, false, false]
    }
}
