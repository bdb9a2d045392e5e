//! A homogeneous half-space under uniform traction along x on a rectangle.
//!
//! With the corner functions of [`super::rectangle`], times 2π,
//!
//! ```text
//! σ_xx = 2 L_y − z T_x + (2ν + z/ρ) y/(ρ+z)     σ_yy = 2ν L_y − (2ν + z/ρ) y/(ρ+z)
//! σ_zz = z T_x      σ_xy = L_x − (2ν + z/ρ) x/(ρ+z)
//! σ_xz = −T − z F_xx      σ_yz = −z/ρ
//! 2G u_x = 2F + 2ν Y_x + z U_x      2G u_y = 2ν [z ln(ρ+z) − ρ] − z ln(ρ+z)
//! 2G u_z = −(1−2ν) X − z L_y
//! ```
//!
//! They are Cerruti's solution for a point force (Johnson, Contact Mechanics (1985), §3.6,
//! doi:10.1017/CBO9781139171731), integrated over the rectangle.

use std::f64::consts::PI;

use super::COMPONENTS;
use super::rectangle::{Corner, corners};
use crate::model::material::Elastic;

/// Components at `at` from the centre of a cell of half sides `half`, at depth z, under unit traction
/// along x on the cell.
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
        let bend = (2.0 * nu + z / corner.rho) / (corner.rho + z);
        let yx = -corner.x * corner.ly - z * corner.ux;
        [
            2.0 * corner.ly - z * corner.tx() + bend * corner.y,
            2.0 * nu * corner.ly - bend * corner.y,
            z * corner.tx(),
            corner.lx - bend * corner.x,
            -z / corner.rho,
            -corner.t - z * corner.fxx(),
            c * (2.0 * corner.f() + 2.0 * nu * yx + z * corner.ux),
            c * (2.0 * nu * (z * corner.log - corner.rho) - z * corner.log),
            -c * (far * corner.potential_x() + z * corner.ly),
        ]
    });
    sums.map(|sum| sum / (2.0 * PI))
}
