//! A homogeneous half-space under uniform pressure on a rectangle.
//!
//! With the corner functions of [`super::rectangle`], times 2π,
//!
//! ```text
//! σ_xx = U_x + 2ν U_y − z F_xx      σ_zz = −T + z (F_xx + F_yy)      σ_xz = z T_x
//! σ_xy = −(1−2ν) ln(ρ+z) − z/ρ
//! 2G u_z = 2(1−ν) F + z T           2G u_x = (1−2ν) X − z L_y
//! ```
//!
//! and those with x and y exchanged. Love, Phil. Trans. R. Soc. A 228 (1929) 377,
//! doi:10.1098/rsta.1929.0009.

use std::f64::consts::PI;

use super::COMPONENTS;
use super::rectangle::{Corner, corners};
use crate::model::material::Elastic;

/// Components at `at` from the centre of a cell of half sides `half`, at depth z, under unit pressure
/// on the cell.
pub(super) fn components(
    material: Elastic,
    half: [f64; 2],
    at: [f64; 2],
    z: f64,
) -> [f64; COMPONENTS] {
    let nu = material.poisson();
    let far = 1.0 - 2.0 * nu;
    let c = 0.5 / material.shear();
    let sums = corners(half, at, z, |corner: &Corner| {
        let (fxx, fyy) = (corner.fxx(), corner.fyy());
        [
            corner.ux + 2.0 * nu * corner.uy - z * fxx,
            corner.uy + 2.0 * nu * corner.ux - z * fyy,
            z * (fxx + fyy) - corner.t,
            -far * corner.log - z / corner.rho,
            z * corner.ty(),
            z * corner.tx(),
            c * (far * corner.potential_x() - z * corner.ly),
            c * (far * corner.potential_y() - z * corner.lx),
            c * (2.0 * (1.0 - nu) * corner.f() + z * corner.t),
        ]
    });
    sums.map(|sum| sum / (2.0 * PI))
}
