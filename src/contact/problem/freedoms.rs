//! Degrees of freedom of the rigid motion on a grid: a [`Motion`] that was checked. The load must act inside the convex
//! hull of the cells that can touch.

use std::ops::Range;

use ndarray::{Array2, ArrayRef2};

use crate::contact::options::Motion;
use crate::error::{Error, Result, finite, positive, refuse_if};
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
                return Err(Error::Inconsistent("exactly one of load and approach must be given"));
            }
        }
        // Under a load the columns may be centred, which keeps them independent.
        let origin = if loaded[0] { grid.center() } else { [0.0; 2] };
        for k in 0..2 {
            let rotation = [motion.eccentricity[k], motion.moment[k], motion.tilt[k]];
            refuse_if(grid.is_periodic()[k] && rotation != [None; 3], PERIODIC[k])?;
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
            refuse_if(
                k == 0 && grid.is_line(),
                "along x a line contact has no eccentricity and no moment",
            )?;
            loaded[k + 1] = true;
            target[k + 1] = (moment / area - origin[k] * target[0]) / scale[k];
        }
        // Products like Σ p u are of second degree in the target.
        let vanishes = loaded[0] && target[0] < f64::MIN_POSITIVE / f64::EPSILON;
        if vanishes || target.iter().any(|sum| !(sum * sum).is_finite()) {
            return Err(Error::Overflow);
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
        let target = self.target.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        if target > 0.0 { target / cells as f64 } else { 1.0 }
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
            row.iter_mut().zip(y).for_each(|(h, y)| *h -= shift + sy * y);
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
        Self { columns: cut(&self.columns), coordinates: cut(&self.coordinates), ..self.clone() }
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

/// Distance from the rim, in half sides of the grid, below which a load point counts as being on it: some
/// units of rounding of scaled coordinates.
const RIM: f64 = 4.0 * f64::EPSILON;

/// Twice the area, in half sides of the grid, of a triangle whose corners count as lying on a line:
/// rounding of products of scaled coordinates, 45 ε.
const COLLINEAR_AREA: f64 = 1e-14;

/// The half-plane n · v > c, as (n_x, n_y, c).
type HalfPlane = [f64; 3];

impl Freedoms {
    /// An error unless some p ≥ 0 on the cells of finite `gap` carries the load and the moments,
    /// with room on every side.
    ///
    /// The load point M/W must lie strictly inside the convex hull of those cells. Where there are
    /// moments without a load, the ray along M must cross its inside.
    pub(crate) fn check_feasible(&self, gap: &ArrayRef2<f64>) -> Result<()> {
        let points = outline(gap, &self.columns);
        refuse_if(points.is_empty(), "no cell of the grid can touch: the gap is infinite")?;
        let half_planes = match (self.loaded[1], self.loaded[2]) {
            (false, false) => return Ok(()),
            (true, true) => convex_hull(&points),
            (true, false) => interval(points.iter().map(|p| p[0])).map(|(s, c)| [s, 0.0, c]).into(),
            (false, true) => interval(points.iter().map(|p| p[1])).map(|(s, c)| [0.0, s, c]).into(),
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
            if self.loaded[0] || slope.abs() <= f64::MIN_POSITIVE {
                inside &= slope * low > c + RIM * c.abs().max(1.0);
            } else if slope > 0.0 {
                low = low.max(c / slope);
            } else {
                high = high.min(c / slope);
            }
        }
        if inside && (self.loaded[0] || low < high) {
            return Ok(());
        }
        let range = |k: usize| {
            let at = |c: f64| self.origin[k] + self.scale[k] * c;
            points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], p| {
                [a.min(at(p[k])), b.max(at(p[k]))]
            })
        };
        let [x_range, y_range] = [range(0), range(1)];
        if !self.loaded[0] {
            let moment = |k: usize| self.target[k + 1] * self.scale[k] * self.cell_area;
            return Err(Error::Moment { moment: [moment(0), moment(1)], x_range, y_range });
        }
        let at = |k: usize| self.origin[k] + self.scale[k] * self.target[k + 1] / self.target[0];
        Err(Error::LoadPoint { x: at(0), y: at(1), x_range, y_range })
    }
}

/// First and last cell of finite gap in each row, as scaled coordinates.
fn outline(gap: &ArrayRef2<f64>, [x, y]: &[Vec<f64>; 2]) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    for (row, &x) in gap.rows().into_iter().zip(x) {
        let touches = |h: &f64| h.is_finite();
        let (Some(first), Some(last)) =
            (row.iter().position(touches), row.iter().rposition(touches))
        else {
            continue;
        };
        points.push([x, y[first]]);
        if last > first {
            points.push([x, y[last]]);
        }
    }
    points
}

/// The inside of the interval that holds `values`, as s · v > c from both ends.
fn interval(values: impl Iterator<Item = f64>) -> [(f64, f64); 2] {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    [(1.0, low), (-1.0, -high)]
}

/// The inside of the convex hull of `points`, as one half-plane for each edge; none where the hull has no
/// inside. Points come in order of x, then y.
///
/// Andrew, Inf. Process. Lett. 9 (1979) 216, doi:10.1016/0020-0190(79)90072-3.
fn convex_hull(points: &[[f64; 2]]) -> Vec<HalfPlane> {
    let turn = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let chain = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..] {
                if turn(a, b, point) > COLLINEAR_AREA {
                    break;
                }
                chain.pop();
            }
            chain.push(point);
        }
        chain
    };
    let lower = chain(&mut points.iter().copied());
    let upper = chain(&mut points.iter().rev().copied());
    if lower.len() + upper.len() < 5 {
        return Vec::new();
    }
    let edges = lower.windows(2).chain(upper.windows(2));
    edges
        .map(|edge| {
            // Counter-clockwise: the inside is to the left.
            let [a, b] = [edge[0], edge[1]];
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            let n = [-(b[1] - a[1]) / length, (b[0] - a[0]) / length];
            [n[0], n[1], n[0] * a[0] + n[1] * a[1]]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use ndarray::array;

    use super::{convex_hull, interval, outline};

    /// The triangle of sides 3, 4, 5 has an inscribed circle of radius 1 around (1, 1); points inside it, and on
    /// its sides, change nothing.
    #[test]
    fn half_planes_of_a_triangle() {
        let corners = [[0.0, 0.0], [0.0, 3.0], [4.0, 0.0]];
        let more = [[0.0, 0.0], [0.0, 1.0], [0.0, 3.0], [1.0, 1.0], [2.0, 0.0], [4.0, 0.0]];
        for points in [&corners[..], &more] {
            let half_planes = convex_hull(points);
            assert_eq!(half_planes.len(), 3);
            for [nx, ny, c] in half_planes {
                assert!((nx.hypot(ny) - 1.0).abs() < 1e-15);
                assert!((nx + ny - c - 1.0).abs() < 1e-15, "{nx} {ny} {c}");
            }
        }
    }

    #[test]
    fn without_an_inside_there_is_none() {
        let line: Vec<[f64; 2]> = (0..5).map(|k| [f64::from(k), 0.5 * f64::from(k)]).collect();
        for points in [&line[..], &line[..2], &line[..1], &[]] {
            assert!(convex_hull(points).is_empty());
        }
    }

    #[test]
    fn interval_from_both_ends() {
        let inside =
            |v: f64| interval([2.0, -1.0, 0.5].into_iter()).iter().all(|(s, c)| s * v > *c);
        let expected = [(-1.01, false), (-1.0, false), (-0.99, true), (1.99, true), (2.01, false)];
        for (v, expected) in expected {
            assert_eq!(inside(v), expected, "{v}");
        }
    }

    #[test]
    fn outline_of_the_cells_that_touch() {
        const NO: f64 = f64::INFINITY;
        let gap =
            array![[NO, 1.0, 1.0, 1.0], [NO, NO, NO, NO], [0.0, 2.0, NO, NO], [NO, NO, -1.0, NO]];
        let columns = [vec![0.0, 1.0, 2.0, 3.0], vec![10.0, 20.0, 30.0, 40.0]];
        let expected = [[0.0, 20.0], [0.0, 40.0], [2.0, 10.0], [2.0, 20.0], [3.0, 30.0]];
        assert_eq!(outline(&gap, &columns), expected);
    }
}
