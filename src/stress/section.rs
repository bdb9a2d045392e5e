//! Where fields are evaluated: the layer that a depth lies in, and the points of a plane.

use std::ops::Range;

use ndarray::Array1;

use super::half_space::MAGNITUDES;
use super::options::{Section, Side};
use super::subcell::CellPoint;
use crate::compliance::response::interior::Place;
use crate::error::{Error, Result, finite, not_negative, require};
use crate::model::body::{HalfSpace, Substrate};
use crate::model::grid::{Grid, Window};
use crate::numerics::rounding;

/// Relative distance within which a depth counts as that of an interface: depths of interfaces are
/// sums of thicknesses, which round by some 1e-16 each.
const INTERFACE_TOLERANCE: f64 = 1e-12;

/// Distance, in cells, within which a coordinate counts as that of a cell centre or of the grid's
/// border: some 1e6 times the rounding of a coordinate.
const CENTRE_TOLERANCE: f64 = 1e-9;

/// Place of the depth `z` in `body`.
pub(super) fn place(body: &HalfSpace, z: f64, side: Side) -> Result<Place> {
    not_negative("z", z)?;
    require("z", z, z <= MAGNITUDES[1], "at most 1e60 (take other units)")?;
    let mut top = 0.0;
    for ((layer, count), interface) in body.layers().iter().zip(0..).zip(body.interfaces()) {
        let on = (z - interface).abs() <= INTERFACE_TOLERANCE * interface;
        if z < interface && !on || on && side == Side::Above {
            let below_top = if on { layer.thickness() } else { z - top };
            return Ok(Place {
                layer: count,
                below_top,
                depth: if on { interface } else { z },
                material: layer.material(),
            });
        }
        top = if on { z } else { interface };
    }
    match body.substrate() {
        Substrate::Elastic(material) => {
            Ok(Place { layer: body.layers().len(), below_top: z - top, depth: z, material })
        }
        Substrate::Rigid => Err(Error::Parameter {
            name: "z",
            requirement: "above the rigid substrate (on it, with side \"above\")",
            value: z,
        }),
        Substrate::Free => Err(Error::Parameter {
            name: "z",
            requirement: "in the plate (on its free base, with side \"above\")",
            value: z,
        }),
    }
}

/// Points of a plane at which fields are returned.
pub(super) struct Points {
    pub(super) x: Array1<f64>,
    pub(super) y: Array1<f64>,
    pub(super) shape: [usize; 2],
    /// Interpolation along x and along y; none along an axis whose cells are all returned.
    interpolation: [Option<Interpolation>; 2],
    /// Rows and columns of the grid. Behind the rows, planes have one for each of the body's two end faces.
    cells: [usize; 2],
    span: Span,
    /// Whether all points are beyond an end of the body.
    pub(super) are_beyond: bool,
}

/// Linear interpolation between two cells of one axis; `weight` is that of `upper`. In the outer half of the first and
/// last cells it extends beyond their centres.
#[derive(Debug, Clone, Copy)]
struct Interpolation {
    lower: usize,
    upper: usize,
    weight: f64,
}

impl Points {
    /// Points of `section` of `body` on `grid`.
    pub(super) fn new(body: &HalfSpace, grid: &Grid, section: Section) -> Result<Self> {
        let at = match section {
            Section::Plane => [None, None],
            Section::X(x) => [Some(x), None],
            Section::Y(y) => [None, Some(y)],
            Section::Axis([x, y]) => [Some(x), Some(y)],
        };
        let mut points = Self {
            x: grid.x(),
            y: grid.y(),
            shape: grid.shape(),
            interpolation: [None; 2],
            cells: grid.shape(),
            span: Span::of(body, grid),
            are_beyond: false,
        };
        for (axis, at) in at.into_iter().enumerate() {
            let Some(at) = at else { continue };
            // A line contact is the same at every x.
            if axis == 0 && grid.is_line() {
                continue;
            }
            let position = position(grid, axis, at)?;
            points.interpolation[axis] = Some(match axis {
                0 if body.ends() != [None; 2] => {
                    points.are_beyond = !points.span.has(position);
                    points.beside_ends(position)
                }
                _ => interpolation(position, grid.shape()[axis], grid.is_periodic()[axis]),
            });
            points.shape[axis] = 1;
            let centres = if axis == 0 { &mut points.x } else { &mut points.y };
            *centres = Array1::from_elem(1, at);
        }
        Ok(points)
    }

    /// Interpolation along x at a `position` in a body with ends: between its rows and its faces alone.
    fn beside_ends(&self, position: f64) -> Interpolation {
        let Span { rows, faces, .. } = &self.span;
        let last = rows.end.saturating_sub(1);
        let [before, behind] = [rows.start as f64 - position, position - last as f64];
        let face = |end: usize, row: usize, outside: f64| Interpolation {
            lower: row,
            upper: self.cells[0] + end,
            weight: (2.0 * outside).min(1.0),
        };
        match faces {
            [Some(_), _] if before > CENTRE_TOLERANCE => face(0, rows.start, before),
            [_, Some(_)] if behind > CENTRE_TOLERANCE => face(1, last, behind),
            _ => {
                let within = interpolation(position - rows.start as f64, rows.len(), false);
                Interpolation {
                    lower: rows.start + within.lower,
                    upper: rows.start + within.upper,
                    ..within
                }
            }
        }
    }

    pub(super) fn count(&self) -> usize {
        self.shape[0] * self.shape[1]
    }

    /// Whether they are all cell centres.
    pub(super) fn are_all_cells(&self) -> bool {
        self.interpolation.iter().all(Option::is_none)
    }

    /// The end on whose face some of the values must be known, and the row behind that face.
    pub(super) fn face(&self) -> Option<(usize, usize)> {
        let end = self.interpolation[0]?.upper.checked_sub(self.cells[0])?;
        Some((end, self.span.faces[end]?))
    }

    /// Whether the values in cells do not matter.
    pub(super) fn are_on_face(&self) -> bool {
        self.face().is_some() && self.interpolation[0].is_some_and(|at| at.weight >= 1.0)
    }

    /// Cells that the points are interpolated from.
    pub(super) fn window(&self) -> Window {
        [0, 1].map(|axis| match self.interpolation[axis] {
            Some(Interpolation { lower, upper, .. }) if upper < self.cells[axis] => {
                lower.min(upper)..lower.max(upper) + 1
            }
            Some(Interpolation { lower, .. }) => lower..lower + 1,
            None => 0..self.cells[axis],
        })
    }

    /// Cells that a single point is interpolated from, and their weights.
    pub(super) fn weighted_cells(&self) -> Vec<([usize; 2], f64)> {
        let along = |axis: usize| match self.interpolation[axis] {
            Some(at) => vec![(at.lower, 1.0 - at.weight), (at.upper, at.weight)],
            None => vec![(0, 1.0)],
        };
        let (rows, columns) = (along(0), along(1));
        let pairs = rows.iter().flat_map(|(i, wx)| {
            let pair = move |(j, wy): &(usize, f64)| ([*i, *j], wx * wy);
            columns.iter().map(pair)
        });
        pairs.filter(|(_, weight)| *weight != 0.0).collect()
    }

    /// A single point that is not the centre of a cell, in its cell; none for other points, and for those on the face of an end.
    pub(super) fn between(&self) -> Option<CellPoint> {
        if self.shape != [1; 2] || self.face().is_some() {
            return None;
        }
        let position = |axis: usize| {
            self.interpolation[axis]
                .map_or(0.0, |at| at.lower as f64 + (at.upper as f64 - at.lower as f64) * at.weight)
        };
        let position = [position(0), position(1)];
        let cell = [0, 1].map(|axis| {
            (rounding::round(position[axis]).max(0.0) as usize).min(self.cells[axis] - 1)
        });
        let within = [0, 1].map(|axis| position[axis] - cell[axis] as f64);
        within.iter().any(|u| *u != 0.0).then_some(CellPoint { cell, within })
    }

    /// Number of values of a plane: of the cells, and of the two faces.
    pub(super) fn of_plane(&self) -> usize {
        (self.cells[0] + 2) * self.cells[1]
    }

    /// Writes the values of `plane`, of (nx, ny) cells, at these points to `values`.
    pub(super) fn interpolate(&self, plane: &[f64], values: &mut [f64]) {
        let [nx, ny] = self.cells;
        let everywhere = |n: usize| (0..n).map(|k| (k, k, 0.0)).collect::<Vec<_>>();
        let nodes = |axis: usize, n: usize| match self.interpolation[axis] {
            Some(at) => vec![(at.lower, at.upper, at.weight)],
            None => everywhere(n),
        };
        let (rows, columns) = (nodes(0, nx), nodes(1, ny));
        // Values that do not count may be NaN.
        let mix = |a: f64, b: f64, weight: f64| match weight {
            0.0 => a,
            1.0 => b,
            _ => a + weight * (b - a),
        };
        for (out, (i, i2, wx)) in values.chunks_exact_mut(columns.len()).zip(rows) {
            for (value, (j, j2, wy)) in out.iter_mut().zip(&columns) {
                let row = |i: usize| mix(plane[i * ny + j], plane[i * ny + j2], *wy);
                *value = mix(row(i), row(i2), wx);
            }
        }
    }
}

/// The coordinate `at` along `axis`, in cells from the centre of the first.
fn position(grid: &Grid, axis: usize, at: f64) -> Result<f64> {
    let n = grid.shape()[axis];
    let name = ["x", "y"][axis];
    finite(name, at)?;
    let position = (at - grid.center()[axis]) / grid.spacing()[axis] + 0.5 * (n - 1) as f64;
    let on_grid = -0.5 - CENTRE_TOLERANCE..=n as f64 - 0.5 + CENTRE_TOLERANCE;
    require(name, at, on_grid.contains(&position), "on the grid")?;
    // Rounding must not mix a neighbour into a line through cell centres.
    let nearest = position.round();
    Ok(if (position - nearest).abs() < CENTRE_TOLERANCE { nearest } else { position })
}

/// Interpolation between `count` cells, or beyond the outer ones, to a `position`. Where they are periodic, the first
/// cell follows the last.
fn interpolation(position: f64, count: usize, periodic: bool) -> Interpolation {
    let below = position.floor();
    if periodic {
        let lower = below.rem_euclid(count as f64) as usize;
        return Interpolation { lower, upper: (lower + 1) % count, weight: position - below };
    }
    let lower = below.clamp(0.0, count.saturating_sub(2) as f64);
    Interpolation {
        lower: lower as usize,
        upper: (lower as usize + 1).min(count.saturating_sub(1)),
        weight: position - lower,
    }
}

/// Rows of a grid that a body has, and its end faces.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Span {
    /// Rows with their centres in the body, or on a face.
    pub(super) rows: Range<usize>,
    /// The row behind each end face that lies between two rows, or on the border of the grid.
    pub(super) faces: [Option<usize>; 2],
    /// Where the body is, in rows: 0 is the centre of the first.
    reach: [f64; 2],
    columns: usize,
}

/// Distance in cells that is rounding.
const ROUNDED_ROW: f64 = 1e-6;

impl Span {
    pub(super) fn of(body: &HalfSpace, grid: &Grid) -> Self {
        let [nx, columns] = grid.shape();
        let first = grid.x()[0];
        let at = |x: f64| (x - first) / grid.spacing()[0];
        let [low, high] = body.ends();
        let reach = [
            low.map_or(f64::NEG_INFINITY, at) - ROUNDED_ROW,
            high.map_or(f64::INFINITY, at) + ROUNDED_ROW,
        ];
        let row = |k: f64| k.clamp(0.0, nx as f64) as usize;
        let start = row(reach[0].ceil());
        let face = |end: Option<f64>| {
            let behind = at(end?) + 0.5;
            let row = behind.round();
            let is_there = (behind - row).abs() < ROUNDED_ROW && (0.0..=nx as f64).contains(&row);
            is_there.then_some(row as usize)
        };
        Self {
            rows: start..row(reach[1].floor() + 1.0).max(start),
            faces: body.ends().map(face),
            reach,
            columns,
        }
    }

    /// Whether the body is at the place `at`, in rows.
    pub(super) fn has(&self, at: f64) -> bool {
        (self.reach[0]..=self.reach[1]).contains(&at)
    }

    /// The cells of the body around a point, and their weights in a linear interpolation along both axes.
    pub(super) fn around(
        &self,
        CellPoint { cell, within }: &CellPoint,
        shape: [usize; 2],
    ) -> Vec<([usize; 2], f64)> {
        let along = |axis: usize| {
            let ends = if axis == 0 { self.rows.clone() } else { 0..shape[1] };
            let beside = cell[axis].checked_add_signed(if within[axis] < 0.0 { -1 } else { 1 });
            match beside.filter(|beside| ends.contains(beside)) {
                Some(beside) => {
                    let weight = within[axis].abs();
                    vec![(cell[axis], 1.0 - weight), (beside, weight)]
                }
                None => vec![(cell[axis], 1.0)],
            }
        };
        let (rows, columns) = (along(0), along(1));
        let pairs =
            rows.iter().flat_map(|(i, wx)| columns.iter().map(move |(j, wy)| ([*i, *j], wx * wy)));
        pairs.filter(|(_, weight)| *weight != 0.0).collect()
    }

    /// Makes the values of a `plane` NaN where there is no body.
    pub(super) fn blank(&self, plane: &mut [f64]) {
        let cells = self.rows.start * self.columns..self.rows.end * self.columns;
        plane[..cells.start].fill(f64::NAN);
        plane[cells.end..].fill(f64::NAN);
    }
}
