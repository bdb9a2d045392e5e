//! Tangential influence coefficients: what tractions and pressure do to the surface along x and y.
//!
//! With the compliances of [`crate::compliance::response`], φ the direction of the wave vector, S, D = (c22 ± c_t)/2,
//!
//! ```text
//! û_x = (S + D cos 2φ) q̂_x + D sin 2φ q̂_y + i cos φ c12 p̂
//! û_y = D sin 2φ q̂_x + (S − D cos 2φ) q̂_y + i sin φ c12 p̂
//! û_z = −i cos φ c12 q̂_x − i sin φ c12 q̂_y + c11 p̂
//! ```
//!
//! q acts on the body, −q on the counterbody, p on both. The displacement of the body relative to the counterbody
//! has the sums of c22 and c_t of both, and the difference of c12, as the gap has. Coefficients are exact, as those
//! of stresses are ([`mod@crate::stress`]).

use std::f64::consts::PI;

use ndarray::{Array2, Array3, ArrayView1, Axis};
use rayon::prelude::*;

use crate::compliance::kernel::COMPONENTS;
use crate::compliance::kernel::loads::{EXCHANGED, ODD, TractionDisplacement};
use crate::compliance::kernel::plane::{CellPlan, CellSource, Kernel};
use crate::compliance::kernel::strip::LinePlan;
use crate::compliance::response::interior::Place;
use crate::compliance::response::{Body, refuse_free};
use crate::error::{Error, Result};
use crate::model::body::{HalfSpace, Interface, Layer, Substrate};
use crate::model::grid::Grid;
use crate::model::material::Elastic;
use crate::numerics::parallel::{Threads, check_memory};

mod convolution;

pub(crate) use convolution::{Tangential, TangentialWindow};

/// What friction asks of bodies.
pub(crate) const FRICTION_NEEDS_ENDLESS_BODIES: &str = "friction needs bodies without free ends along x: what tractions do near such ends is not known";

/// Displacement \[m/Pa\] of the surface at cell offsets (i, j) ≥ 0 from a cell under a unit traction. Arrays are (nx, ny).
///
/// At other offsets, xx and yy are even, xy is odd along x and along y, zx is odd along x, and zy odd along y. The
/// displacement along x under a unit pressure is −zx, and along y −zy. In line contact, xx is that of antiplane shear,
/// and displacements are 0 at the width of the grid.
#[derive(Debug, Clone, PartialEq)]
pub struct TractionCoefficients {
    /// u_x under a traction along x.
    pub xx: Array2<f64>,
    /// u_y under a traction along x, and u_x under one along y.
    pub xy: Array2<f64>,
    /// u_y under a traction along y.
    pub yy: Array2<f64>,
    /// u_z under a traction along x.
    pub zx: Array2<f64>,
    /// u_z under a traction along y.
    pub zy: Array2<f64>,
}

/// Coefficients of `body` on `grid`, without aliasing.
///
/// # Errors
/// A body without layers and substrate; too little memory.
///
/// ```
/// use nacre::{Elastic, Grid, traction_coefficients};
/// let body = Elastic::new(2.6, 0.3)?;
/// let c = traction_coefficients(body, &Grid::new([4, 4], [4.0, 4.0])?)?;
/// // A unit square, from its centre: (2 − ν) asinh(1)/πG
/// let own = 1.7 * 1.0_f64.asinh() / std::f64::consts::PI;
/// assert!((c.xx[[0, 0]] / own - 1.0).abs() < 1e-13);
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn traction_coefficients(body: impl Into<Body>, grid: &Grid) -> Result<TractionCoefficients> {
    let body = body.into();
    of_body(half_space(&body)?, grid, &Threads::new(None)?)
}

/// The layers of a body.
///
/// # Errors
/// Where it is of another kind.
fn half_space(body: &Body) -> Result<&HalfSpace> {
    let layers = body.half_space().ok_or(Error::Inconsistent(
        "friction needs bodies with a substrate and layers: the response along the surface of this body is not known",
    ))?;
    refuse_free(&**body, "bodies with friction")?;
    if layers.slips() {
        return Err(Error::Inconsistent(
            "friction needs bodies without frictionless interfaces: nothing holds the layers above one against tractions",
        ));
    }
    Ok(layers)
}

/// Coefficients of `body` and `counterbody` together: sums of xx, xy and yy, and differences of zx and zy.
pub(super) fn of_pair(
    body: &Body,
    counterbody: Option<&Body>,
    grid: &Grid,
    threads: &Threads,
) -> Result<TractionCoefficients> {
    let body = half_space(body)?;
    let Some(counterbody) = counterbody else {
        return of_body(body, grid, threads);
    };
    let counterbody = half_space(counterbody)?;
    let mut sum = of_body(body, grid, threads)?;
    if surface(body) == surface(counterbody) {
        for c in [&mut sum.xx, &mut sum.xy, &mut sum.yy] {
            *c *= 2.0;
        }
        sum.zx.fill(0.0);
        sum.zy.fill(0.0);
        return Ok(sum);
    }
    let other = of_body(counterbody, grid, threads)?;
    sum.xx += &other.xx;
    sum.xy += &other.xy;
    sum.yy += &other.yy;
    sum.zx -= &other.zx;
    sum.zy -= &other.zy;
    Ok(sum)
}

/// What makes a body's response: two bodies that are the same but for names and ends have the same.
fn surface(body: &HalfSpace) -> (Substrate, Vec<(Elastic, f64, Interface)>) {
    let layer = |layer: &Layer| (layer.material(), layer.thickness(), layer.interface());
    (body.substrate(), body.layers().iter().map(layer).collect())
}

/// The coefficients of a half-space: of tractions along x and y, by cells of the layered kernel.
fn of_body(body: &HalfSpace, grid: &Grid, threads: &Threads) -> Result<TractionCoefficients> {
    let [nx, ny] = grid.shape();
    check_memory(grid.shape(), 8 * 5 * (nx * ny) as u64)?;
    let place = Place::surface(body);
    if grid.is_line() {
        return Ok(of_strips(body, grid, &place));
    }
    if let (Substrate::Elastic(material), []) = (body.substrate(), body.layers()) {
        return Ok(with_parities(of_cells(material, grid)));
    }
    let spacing = grid.spacing();
    let [lx, ly] = grid.size();
    // One per cent more than the diagonal, for rounding.
    let plan = threads.run(|| CellPlan::new(body, spacing, 1.0, 1.01 * lx.hypot(ly)));
    let kernel = threads.run(|| Kernel::new::<TractionDisplacement>(&plan, &place));
    let half @ [a, b] = spacing.map(|d| 0.5 * d);
    let displacements = |axis: usize| -> [Array2<f64>; 3] {
        // Traction along y is traction along x with both exchanged.
        let as_if_along_x = |values: [f64; COMPONENTS]| match axis {
            0 => values,
            _ => EXCHANGED.map(|k| values[k]),
        };
        // The displacements come first, and the stresses are not computed.
        let displacements_first = |values: [f64; COMPONENTS]| {
            let mut values = as_if_along_x(values);
            values.rotate_right(DISPLACEMENTS);
            values
        };
        // A traction along an axis flips the parity along it.
        let odd = |k: usize| [0, 1].map(|along| ODD[k][along] != (axis == along));
        let source = CellSource {
            between: false,
            offsets: [nx, ny],
            spacing,
            depth: 0.0,
            odd: [6, 7, 8].map(odd),
            mean: |x: f64, y: f64| match axis {
                0 => displacements_first(kernel.at::<TractionDisplacement>([x, y], half)),
                _ => displacements_first(kernel.at::<TractionDisplacement>([y, x], [b, a])),
            },
            point: |x: f64, y: f64| match axis {
                0 => displacements_first(kernel.far::<TractionDisplacement>(x, y)),
                _ => displacements_first(kernel.far::<TractionDisplacement>(y, x)),
            },
        };
        let mut rows = Array3::zeros((nx, DISPLACEMENTS, ny));
        let chunks = rows.axis_chunks_iter_mut(Axis(0), ROWS).into_par_iter().enumerate();
        chunks.for_each(|(chunk, mut values)| {
            let first_row = chunk * ROWS;
            source.rows(first_row..first_row + values.len_of(Axis(0)), &mut |i, k, row| {
                let mut components = values.index_axis_mut(Axis(0), i - first_row);
                components.row_mut(k).assign(&ArrayView1::from(row));
            });
        });
        [0, 1, 2].map(|k| rows.index_axis(Axis(1), k).to_owned())
    };
    // yx = xy.
    let ([xx, xy, zx], [_, yy, zy]) = threads.run(|| (displacements(0), displacements(1)));
    Ok(with_parities([xx, xy, yy, zx, zy]))
}

/// What is odd vanishes on its axis, where rounding leaves a remainder.
fn with_parities([xx, mut xy, yy, mut zx, mut zy]: [Array2<f64>; 5]) -> TractionCoefficients {
    let (along_x, along_y) = (Axis(0), Axis(1));
    for (odd, axis) in [(&mut xy, along_x), (&mut zx, along_x), (&mut zy, along_y)] {
        odd.index_axis_mut(axis, 0).fill(0.0);
    }
    xy.index_axis_mut(along_y, 0).fill(0.0);
    TractionCoefficients { xx, xy, yy, zx, zy }
}

/// Rows of coefficients that are computed together.
const ROWS: usize = 8;

/// Number of displacements, the last of the components.
const DISPLACEMENTS: usize = 3;

fn of_strips(body: &HalfSpace, grid: &Grid, place: &Place) -> TractionCoefficients {
    let plan = LinePlan::new(body, grid, 1.0);
    let along = plan.coefficients(place, Some(0));
    let across = plan.coefficients(place, Some(1));
    let row = |values: &[[f64; 9]], k: usize| {
        Array2::from_shape_fn(grid.shape(), |(_, j)| values[j][6 + k])
    };
    TractionCoefficients {
        xx: row(&along, 0),
        xy: Array2::zeros(grid.shape()),
        yy: row(&across, 1),
        zx: Array2::zeros(grid.shape()),
        zy: row(&across, 2),
    }
}

/// Coefficients xx, xy, yy, zx and zy of a half-space without layers: sums over the corners of a cell of functions f, by Cerruti's solution (Johnson, Contact
/// Mechanics, 1985, §3.6, doi:10.1017/CBO9781139171731).
///
/// ```text
/// u_x = [(1 − ν) f_A + ν f_xx] / 2πG     u_y = ν [f_xy] / 2πG     u_z = (1 − 2ν) [f_x] / 4πG
/// f_A = x asinh(y/|x|) + y asinh(x/|y|)  f_xx = y asinh(x/|y|)    f_xy = −√(x² + y²)
/// f_x = ½ y ln(x² + y²) + x atan(y/x)
/// ```
fn of_cells(material: Elastic, grid: &Grid) -> [Array2<f64>; 5] {
    let (nu, unit) = (material.poisson(), 2.0 * PI * material.shear());
    let [dx, dy] = grid.spacing();
    let along = move |[x, y]: [f64; 2]| ((1.0 - nu) * times_asinh(x, y) + times_asinh(y, x)) / unit;
    let across = move |[x, y]: [f64; 2]| -nu * x.hypot(y) / unit;
    let lift = move |[x, y]: [f64; 2]| (0.5 - nu) * (half_log(x, y) + times_atan(x, y)) / unit;
    let turned = |f: &dyn Fn([f64; 2]) -> f64, [x, y]: [f64; 2]| f([y, x]);
    let cells = |f: &dyn Fn([f64; 2]) -> f64| {
        Array2::from_shape_fn(grid.shape(), |(i, j)| {
            let [left, right] = [i as f64 - 0.5, i as f64 + 0.5].map(|k| k * dx);
            let [low, high] = [j as f64 - 0.5, j as f64 + 0.5].map(|k| k * dy);
            (f([right, high]) - f([left, high])) - (f([right, low]) - f([left, low]))
        })
    };
    [
        cells(&along),
        cells(&across),
        cells(&|at| turned(&along, at)),
        cells(&lift),
        cells(&|at| turned(&lift, at)),
    ]
}

/// x asinh(y/|x|)
fn times_asinh(x: f64, y: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x * (y / x.abs()).asinh() }
}

/// x atan(y/x)
fn times_atan(x: f64, y: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x * (y / x).atan() }
}

/// ½ y ln(x² + y²)
fn half_log(x: f64, y: f64) -> f64 {
    if y == 0.0 { 0.0 } else { y * x.hypot(y).ln() }
}
