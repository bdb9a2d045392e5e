//! Where fields are evaluated: the layer that a depth lies in, and the points of a plane.

use ndarray::Array1;

use super::half_space::MAGNITUDES;
use super::options::{Section, Side};
use crate::body::{HalfSpace, Substrate};
use crate::error::{Error, Result, finite};
use crate::grid::{Grid, Window};
use crate::response::interior::Place;

/// Relative distance within which a depth counts as that of an interface: depths of interfaces are
/// sums of thicknesses, which round by some 1e-16 each.
const INTERFACE_TOLERANCE: f64 = 1e-12;

/// Distance, in cells, within which a coordinate counts as that of a cell centre or of the grid's
/// border: some 1e6 times the rounding of a coordinate.
const CENTRE_TOLERANCE: f64 = 1e-9;

/// Place of the depth `z` in `body`.
pub(super) fn place(body: &HalfSpace, z: f64, side: Side) -> Result<Place> {
    if !(z >= 0.0 && z.is_finite()) {
        return Err(Error::Parameter {
            name: "z",
            requirement: "finite and at least 0",
            value: z,
        });
    }
    if z > MAGNITUDES[1] {
        return Err(Error::Parameter {
            name: "z",
            requirement: "at most 1e60 (take other units)",
            value: z,
        });
    }
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
        Substrate::Elastic(material) => Ok(Place {
            layer: body.layers().len(),
            below_top: z - top,
            depth: z,
            material,
        }),
        Substrate::Rigid => Err(Error::Parameter {
            name: "z",
            requirement: "above the rigid substrate (on it, with side \"above\")",
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
}

/// Linear interpolation between the cells `lower` and `upper` of one axis; `weight` is that of `upper`.
#[derive(Debug, Clone, Copy)]
struct Interpolation {
    lower: usize,
    upper: usize,
    weight: f64,
}

impl Points {
    /// Points of `section` on `grid`.
    pub(super) fn new(grid: &Grid, section: Section) -> Result<Self> {
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
        };
        for (axis, at) in at.into_iter().enumerate() {
            let Some(at) = at else { continue };
            // A line contact is the same at every x.
            if axis == 0 && grid.is_line() {
                continue;
            }
            points.interpolation[axis] = Some(interpolation(grid, axis, at)?);
            points.shape[axis] = 1;
            let centres = if axis == 0 {
                &mut points.x
            } else {
                &mut points.y
            };
            *centres = Array1::from_elem(1, at);
        }
        Ok(points)
    }

    /// How many points there are.
    pub(super) fn count(&self) -> usize {
        self.shape[0] * self.shape[1]
    }

    /// Whether they are all cell centres.
    pub(super) fn are_all_cells(&self) -> bool {
        self.interpolation.iter().all(Option::is_none)
    }

    /// Cells that the points are interpolated from.
    pub(super) fn window(&self, shape: [usize; 2]) -> Window {
        [0, 1].map(|axis| match self.interpolation[axis] {
            Some(at) => at.lower..at.upper + 1,
            None => 0..shape[axis],
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
        pairs.filter(|(_, weight)| *weight > 0.0).collect()
    }

    /// Writes the values of `plane`, of (nx, ny) cells, at these points to `values`.
    pub(super) fn interpolate(&self, plane: &[f64], [nx, ny]: [usize; 2], values: &mut [f64]) {
        let everywhere = |n: usize| (0..n).map(|k| (k, k, 0.0)).collect::<Vec<_>>();
        let nodes = |axis: usize, n: usize| match self.interpolation[axis] {
            Some(at) => vec![(at.lower, at.upper, at.weight)],
            None => everywhere(n),
        };
        let (rows, columns) = (nodes(0, nx), nodes(1, ny));
        let mix = |a: f64, b: f64, weight: f64| a + weight * (b - a);
        for (out, (i, i2, wx)) in values.chunks_exact_mut(columns.len()).zip(rows) {
            for (value, (j, j2, wy)) in out.iter_mut().zip(&columns) {
                let row = |i: usize| mix(plane[i * ny + j], plane[i * ny + j2], *wy);
                *value = mix(row(i), row(i2), wx);
            }
        }
    }
}

/// Interpolation along `axis` to the coordinate `at`.
fn interpolation(grid: &Grid, axis: usize, at: f64) -> Result<Interpolation> {
    let n = grid.shape()[axis];
    let name = ["x", "y"][axis];
    finite(name, at)?;
    let position = (at - grid.center()[axis]) / grid.spacing()[axis] + 0.5 * (n - 1) as f64;
    if !(-0.5 - CENTRE_TOLERANCE..=n as f64 - 0.5 + CENTRE_TOLERANCE).contains(&position) {
        return Err(Error::Parameter {
            name,
            requirement: "on the grid",
            value: at,
        });
    }
    // Rounding must not mix a neighbour into a line through cell centres.
    let nearest = position.round();
    let position = if (position - nearest).abs() < CENTRE_TOLERANCE {
        nearest
    } else {
        position
    };
    let position = position.clamp(0.0, (n - 1) as f64);
    let lower = position as usize;
    Ok(Interpolation {
        lower,
        upper: (lower + 1).min(n - 1),
        weight: position - lower as f64,
    })
}
