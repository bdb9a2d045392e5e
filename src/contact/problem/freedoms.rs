//! The rigid motion of the body that is pressed on: what is prescribed, what is loaded.

use std::ops::Range;

use ndarray::{Array2, ArrayRef2};

use crate::contact::problem::load_point::{hull_half_planes, interval, outline};
use crate::error::{Error, Result, finite, positive};
use crate::grid::Grid;

/// What is asked of the rigid motion (δ, s_x, s_y), in g = h + u − δ − s_x x − s_y y.
///
/// Each of the three freedoms is prescribed or loaded. Exactly one of `load` and `approach`; along
/// x and along y at most one of `eccentricity` (which needs a load), `moment` and `tilt`, and a
/// tilt of 0 where there is none. Lengths and moments are about the origin x = y = 0.
///
/// ```
/// use nacre::Motion;
/// // Free to tilt along x only, under a force at x = 2.87 mm.
/// let motion = Motion { eccentricity: [Some(2.87e-3), None], ..Motion::load(1e3) };
/// assert_eq!(motion.load, Some(1e3));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// Σ p dA \[N\], above 0.
    pub load: Option<f64>,
    /// Approach δ \[m\] of the origin, from the datum h = 0.
    pub approach: Option<f64>,
    /// Where the load acts \[m\]: Σ p x dA = W e_x, along y alike.
    pub eccentricity: [Option<f64>; 2],
    /// First moments of the pressure \[N m\]: Σ p x dA = M_x, along y alike.
    pub moment: [Option<f64>; 2],
    /// Slopes s_x, s_y.
    pub tilt: [Option<f64>; 2],
}

impl Motion {
    /// A force `load` \[N\], the tilt locked at 0.
    pub fn load(load: f64) -> Self {
        Self {
            load: Some(load),
            ..Self::default()
        }
    }

    /// A prescribed `approach` \[m\], the tilt locked at 0.
    pub fn approach(approach: f64) -> Self {
        Self {
            approach: Some(approach),
            ..Self::default()
        }
    }
}

/// A [`Motion`] that was checked, on a grid: g = h + u − Bλ, where the columns of B are the loaded
/// freedoms 1, (x − x0)/ℓx, (y − y0)/ℓy, and the prescribed ones are part of h.
#[derive(Debug, Clone)]
pub(crate) struct Freedoms {
    pub(crate) loaded: [bool; 3],
    /// Bᵀp for the loaded freedoms.
    pub(crate) target: [f64; 3],
    /// δ, s_x, s_y of the prescribed freedoms, 0 of the loaded ones.
    prescribed: [f64; 3],
    origin: [f64; 2],
    scale: [f64; 2],
    pub(crate) columns: [Vec<f64>; 2],
    coordinates: [Vec<f64>; 2],
    pub(crate) cell_area: f64,
}

const DIRECTIONS: [&str; 2] = [
    "along x at most one of eccentricity, moment and tilt can be a number",
    "along y at most one of eccentricity, moment and tilt can be a number",
];

/// Numbers that are too large to be computed with.
pub(crate) const OVERFLOW: Error = Error::Inconsistent(
    "load, lengths and moduli must be in units in which their products do not overflow",
);

impl Freedoms {
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
        // Σ p u and its like are products of two of these and a coefficient.
        if target.iter().any(|sum| !(sum * sum).is_finite()) {
            return Err(OVERFLOW);
        }
        let coordinates = [0, 1].map(|k| grid.coordinates(k).to_vec());
        let columns = [0, 1].map(|k| {
            coordinates[k]
                .iter()
                .map(|x| (x - origin[k]) / scale[k])
                .collect::<Vec<_>>()
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

    /// An error unless some p ≥ 0 on the cells of finite `gap` carries the load and the moments,
    /// with room on every side.
    ///
    /// The load point M/W must lie strictly inside the convex hull of those cells; where there are
    /// moments without a load, the ray along M must cross its inside.
    pub(crate) fn check_feasible(&self, gap: &ArrayRef2<f64>) -> Result<()> {
        let points = outline(gap, &self.columns);
        if points.is_empty() {
            return Err(Error::Inconsistent(
                "no cell of the grid can touch: the gap is infinite",
            ));
        }
        let half_planes = match (self.loaded[1], self.loaded[2]) {
            (false, false) => return Ok(()),
            (true, true) => hull_half_planes(&points),
            (true, false) => interval(points.iter().map(|p| p[0]))
                .map(|(s, c)| [s, 0.0, c])
                .into(),
            (false, true) => interval(points.iter().map(|p| p[1]))
                .map(|(s, c)| [0.0, s, c])
                .into(),
        };
        // n · (t M) > c for some t > 0, or at t = 1/W.
        let (mut low, mut high) = if self.loaded[0] {
            (1.0 / self.target[0], 1.0 / self.target[0])
        } else {
            (0.0, f64::MAX)
        };
        let mut inside = !half_planes.is_empty();
        for [nx, ny, c] in half_planes {
            let slope = nx * self.target[1] + ny * self.target[2];
            let margin = 1e-9;
            if self.loaded[0] || slope.abs() <= f64::MIN_POSITIVE {
                inside &= slope * low > c + margin * c.abs().max(1.0) * f64::EPSILON.sqrt();
            } else if slope > 0.0 {
                low = low.max(c / slope);
            } else {
                high = high.min(c / slope);
            }
        }
        if inside && (self.loaded[0] || low < high) {
            return Ok(());
        }
        if !self.loaded[0] {
            return Err(Error::Inconsistent(
                "moment must be one that a pressure on the cells that can touch can have",
            ));
        }
        let range = |k: usize| {
            let map = |c: f64| self.origin[k] + self.scale[k] * c;
            points
                .iter()
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], p| {
                    [a.min(map(p[k])), b.max(map(p[k]))]
                })
        };
        let at = |k: usize| self.origin[k] + self.scale[k] * self.target[k + 1] / self.target[0];
        Err(Error::LoadPoint {
            x: at(0),
            y: at(1),
            x_range: range(0),
            y_range: range(1),
        })
    }

    /// A uniform pressure whose sum is of the size of what is asked.
    pub(crate) fn typical_pressure(&self, cells: usize) -> f64 {
        let asked = self.target.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        if asked > 0.0 {
            asked / cells as f64
        } else {
            1.0
        }
    }

    /// Whether the prescribed freedoms change the gap.
    pub(crate) fn any_prescribed(&self) -> bool {
        self.prescribed.iter().any(|&freedom| freedom != 0.0)
    }

    /// Takes the prescribed freedoms from the gap: h − δ − s_x x − s_y y.
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

    /// (δ, s_x, s_y) of all freedoms, from the multipliers λ of the loaded ones.
    pub(crate) fn motion(&self, lambda: [f64; 3]) -> (f64, [f64; 2]) {
        let slope = [0, 1].map(|k| lambda[k + 1] / self.scale[k]);
        let tilt = [0, 1].map(|k| self.prescribed[k + 1] + slope[k]);
        let shift = slope[0] * self.origin[0] + slope[1] * self.origin[1];
        (self.prescribed[0] + lambda[0] - shift, tilt)
    }

    /// Those of a part of the grid.
    pub(crate) fn part(&self, [x, y]: [Range<usize>; 2]) -> Self {
        let part =
            |lines: &[Vec<f64>; 2]| [lines[0][x.clone()].to_vec(), lines[1][y.clone()].to_vec()];
        Self {
            columns: part(&self.columns),
            coordinates: part(&self.coordinates),
            ..self.clone()
        }
    }

    /// Those of a grid of cells twice as long in the directions of `halved`.
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
        let cells = halved
            .iter()
            .map(|&h| if h { 2.0 } else { 1.0 })
            .product::<f64>();
        Self {
            columns: coarse(&self.columns),
            coordinates: coarse(&self.coordinates),
            target: self.target.map(|sum| sum / cells),
            cell_area: self.cell_area * cells,
            ..self.clone()
        }
    }

    /// Whether any freedom is loaded.
    pub(crate) fn any_loaded(&self) -> bool {
        self.loaded.contains(&true)
    }
}
