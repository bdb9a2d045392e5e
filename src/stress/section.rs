//! Where fields are evaluated: the place of a depth in a body, and the part of a plane that is kept.

use ndarray::Array1;

use super::{Section, Side};
use crate::body::{HalfSpace, Substrate};
use crate::error::{Error, Result, finite};
use crate::grid::Grid;
use crate::response::interior::Place;

/// Where the depth `z` lies in `body`.
pub(super) fn place(body: &HalfSpace, z: f64, side: Side) -> Result<Place> {
    /// Nearer than this to an interface, relatively, a depth lies on it: sums of thicknesses are
    /// rounded.
    const ON: f64 = 1e-12;
    if !(z >= 0.0 && z.is_finite()) {
        return Err(Error::Parameter {
            name: "z",
            requirement: "finite and at least 0",
            value: z,
        });
    }
    let mut top = 0.0;
    for ((layer, count), interface) in body.layers().iter().zip(0..).zip(body.interfaces()) {
        let on = (z - interface).abs() <= ON * interface;
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

/// The part of a plane that is kept.
pub(super) struct Lines {
    pub(super) x: Array1<f64>,
    pub(super) y: Array1<f64>,
    pub(super) shape: [usize; 2],
    /// Where each axis is cut.
    cuts: [Option<Cut>; 2],
}

/// A place between the cells `lower` and `upper` of an axis.
#[derive(Debug, Clone, Copy)]
struct Cut {
    lower: usize,
    upper: usize,
    weight: f64,
}

impl Lines {
    pub(super) fn new(grid: &Grid, section: Section) -> Result<Self> {
        let at = match section {
            Section::Plane => [None, None],
            Section::X(x) => [Some(x), None],
            Section::Y(y) => [None, Some(y)],
            Section::Axis([x, y]) => [Some(x), Some(y)],
        };
        let mut lines = Self {
            x: grid.x(),
            y: grid.y(),
            shape: grid.shape(),
            cuts: [None; 2],
        };
        for (axis, at) in at.into_iter().enumerate() {
            let Some(at) = at else { continue };
            // A line contact is the same at every x.
            if axis == 0 && grid.is_line() {
                continue;
            }
            lines.cuts[axis] = Some(cut(grid, axis, at)?);
            lines.shape[axis] = 1;
            let centres = if axis == 0 {
                &mut lines.x
            } else {
                &mut lines.y
            };
            *centres = Array1::from_elem(1, at);
        }
        Ok(lines)
    }

    /// Whether whole planes are kept.
    pub(super) fn whole(&self) -> bool {
        self.cuts.iter().all(Option::is_none)
    }

    /// The section of a plane.
    pub(super) fn keep(&self, plane: &[f64], [nx, ny]: [usize; 2], kept: &mut [f64]) {
        let everywhere = |n: usize| (0..n).map(|k| (k, k, 0.0)).collect::<Vec<_>>();
        let nodes = |axis: usize, n: usize| match self.cuts[axis] {
            Some(cut) => vec![(cut.lower, cut.upper, cut.weight)],
            None => everywhere(n),
        };
        let (rows, columns) = (nodes(0, nx), nodes(1, ny));
        let mix = |a: f64, b: f64, weight: f64| a + weight * (b - a);
        for (out, (i, i2, wx)) in kept.chunks_exact_mut(columns.len()).zip(rows) {
            for (value, (j, j2, wy)) in out.iter_mut().zip(&columns) {
                let row = |i: usize| mix(plane[i * ny + j], plane[i * ny + j2], *wy);
                *value = mix(row(i), row(i2), wx);
            }
        }
    }
}

fn cut(grid: &Grid, axis: usize, at: f64) -> Result<Cut> {
    let n = grid.shape()[axis];
    let name = ["x", "y"][axis];
    finite(name, at)?;
    let position = (at - grid.center()[axis]) / grid.spacing()[axis] + 0.5 * (n - 1) as f64;
    if !(-0.5 - 1e-9..=n as f64 - 0.5 + 1e-9).contains(&position) {
        return Err(Error::Parameter {
            name,
            requirement: "on the grid",
            value: at,
        });
    }
    // Rounding must not mix a neighbour into a line through cell centres.
    let nearest = position.round();
    let position = if (position - nearest).abs() < 1e-9 {
        nearest
    } else {
        position
    };
    let position = position.clamp(0.0, (n - 1) as f64);
    let lower = position as usize;
    Ok(Cut {
        lower,
        upper: (lower + 1).min(n - 1),
        weight: position - lower as f64,
    })
}
