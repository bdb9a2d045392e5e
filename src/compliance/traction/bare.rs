//! Influence coefficients of tractions on a half-space without layers.

use std::f64::consts::PI;

use ndarray::Array2;

use crate::model::grid::Grid;
use crate::model::material::Elastic;

/// Coefficients xx, xy, yy, zx and zy in closed form: sums over the corners of a cell of functions f, by Cerruti's solution (Johnson, Contact
/// Mechanics, 1985, §3.6, doi:10.1017/CBO9781139171731).
///
/// ```text
/// u_x = [(1 − ν) f_A + ν f_xx] / 2πG     u_y = ν [f_xy] / 2πG     u_z = (1 − 2ν) [f_x] / 4πG
/// f_A = x asinh(y/|x|) + y asinh(x/|y|)  f_xx = y asinh(x/|y|)    f_xy = −√(x² + y²)
/// f_x = ½ y ln(x² + y²) + x atan(y/x)
/// ```
pub(super) fn of_cells(material: Elastic, grid: &Grid) -> [Array2<f64>; 5] {
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
    if x == 0.0 {
        0.0
    } else {
        x * (y / x.abs()).asinh()
    }
}

/// x atan(y/x)
fn times_atan(x: f64, y: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x * (y / x).atan() }
}

/// ½ y ln(x² + y²)
fn half_log(x: f64, y: f64) -> f64 {
    if y == 0.0 { 0.0 } else { y * x.hypot(y).ln() }
}
