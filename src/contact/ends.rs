//! Ends of a contact, located within its outermost cells.

use ndarray::Array2;

use crate::model::grid::Grid;

/// An end of a contact.
#[derive(Debug, Clone, Copy)]
pub(in crate::contact) struct ContactEnd {
    /// Coordinate \[m\].
    pub(in crate::contact) at: f64,
    /// Whether the pressure tells where in or beside its outermost cell the contact ends.
    pub(in crate::contact) is_located: bool,
}

/// Ends of the contact along x and along y, as [`Solution::contact_extent`](crate::contact::Solution::contact_extent) has them.
pub(in crate::contact) fn contact_ends(
    pressure: &Array2<f64>,
    grid: &Grid,
) -> [[ContactEnd; 2]; 2] {
    let unlocated = |at: f64| ContactEnd { at, is_located: false };
    [0, 1].map(|axis| {
        let lanes = || pressure.lanes(ndarray::Axis(axis)).into_iter();
        let wraps = |p: ndarray::ArrayView1<f64>| p[0] > 0.0 && p[p.len() - 1] > 0.0;
        if grid.is_periodic()[axis] && lanes().any(wraps) {
            return [unlocated(f64::NAN); 2];
        }
        let farther = |[a, b]: [ContactEnd; 2], [c, d]: [ContactEnd; 2]| {
            [if c.at < a.at { c } else { a }, if d.at > b.at { d } else { b }]
        };
        let ends = lanes().filter_map(line_ends).reduce(farther);
        let first = grid.coordinates(axis)[0];
        let spacing = grid.spacing()[axis];
        ends.map_or([unlocated(0.0); 2], |ends| {
            ends.map(|end| ContactEnd { at: first + spacing * end.at, ..end })
        })
    })
}

/// Ends of the contact on one line of cells, in cells from the centre of the first.
fn line_ends(pressure: ndarray::ArrayView1<f64>) -> Option<[ContactEnd; 2]> {
    let first = pressure.iter().position(|&p| p > 0.0)?;
    let last = pressure.iter().rposition(|&p| p > 0.0)?;
    let width = last - first + 1;
    let square = |k: usize| pressure[k] * pressure[k];
    let end = |beyond: Option<f64>, at: usize, outwards: f64| ContactEnd {
        at: at as f64 + outwards * beyond.unwrap_or(OUTER_CELL),
        is_located: beyond.is_some(),
    };
    Some([
        end(edge_beyond(|k| square(first + k), width), first, -1.0),
        end(edge_beyond(|k| square(last - k), width), last, 1.0),
    ])
}

/// Distance of the end of the outermost cell from its centre, in cells.
const OUTER_CELL: f64 = 0.5;

/// Distance by which the contact ends beyond the centre of its outermost cell, in cells; `square(k)` is p²
/// of the k-th cell from the edge inwards. `None` where it cannot be told.
fn edge_beyond(square: impl Fn(usize) -> f64, width: usize) -> Option<f64> {
    // The outer two cells carry the discretisation of the edge.
    const FIRST: usize = 2;
    // Cells that the parabola is fitted to: two more than determine it.
    const POINTS: usize = 5;
    if width < 2 * (FIRST + POINTS) {
        return None;
    }
    // Least squares on evenly spaced points, in orthogonal polynomials of t = −2 … 2:
    // p² = mean + slope t + bend (t² − 2).
    let half = (POINTS / 2) as f64;
    let (mut mean, mut slope, mut bend) = (0.0, 0.0, 0.0);
    for k in 0..POINTS {
        let t = k as f64 - half;
        let s = square(FIRST + k);
        mean += s / 5.0;
        slope += t * s / 10.0;
        bend += (t * t - 2.0) * s / 14.0;
    }
    // The outer zero of the parabola: t = −2c/(slope + √…), which holds for bend = 0 too.
    let constant = mean - 2.0 * bend;
    let discriminant = slope * slope - 4.0 * bend * constant;
    if slope <= 0.0 || discriminant < 0.0 {
        return None;
    }
    let zero = -2.0 * constant / (slope + discriminant.sqrt());
    let beyond = -(zero + half + FIRST as f64);
    (-1.0..=1.0).contains(&beyond).then_some(beyond)
}
