//! Stress and displacement of a homogeneous half-space under a uniformly loaded rectangle.
//!
//! Sums over the corners, with signs, of functions of the corner's distances (x, y) and of the
//! depth z. With ρ² = x² + y² + z², the harmonic potentials of the rectangle are
//!
//! ```text
//! T  = atan(xy/zρ)       L_y = asinh(y/√(x²+z²))      U_x = −atan[xy(ρ−z)/(x²ρ + y²z)]
//! F  = x L_y + y L_x − z T      X = −[y ln(ρ+z) + z L_y − x U_x]      Y_x = −x L_y − z U_x
//! ```
//!
//! (L_x, U_y, Y_y with x and y exchanged), T = −U_x − U_y, and F_xx = −xy/ρ(x²+z²), T_x =
//! yz/ρ(x²+z²). Under pressure, after Love, Phil. Trans. R. Soc. A 228 (1929) 377, times 2π,
//!
//! ```text
//! σ_xx = U_x + 2ν U_y − z F_xx      σ_zz = −T + z (F_xx + F_yy)      σ_xz = z T_x
//! σ_xy = −(1−2ν) ln(ρ+z) − z/ρ
//! 2G u_z = 2(1−ν) F + z T           2G u_x = (1−2ν) X − z L_y
//! ```
//!
//! and under traction along x
//!
//! ```text
//! σ_xx = 2 L_y − z T_x + (2ν + z/ρ) y/(ρ+z)     σ_yy = 2ν L_y − (2ν + z/ρ) y/(ρ+z)
//! σ_zz = z T_x      σ_xy = L_x − (2ν + z/ρ) x/(ρ+z)
//! σ_xz = −T − z F_xx      σ_yz = −z/ρ
//! 2G u_x = 2F + 2ν Y_x + z U_x      2G u_y = 2ν [z ln(ρ+z) − ρ] − z ln(ρ+z)
//! 2G u_z = −(1−2ν) X − z L_y
//! ```

use std::f64::consts::PI;

use super::loads::COMPONENTS;
use crate::material::Elastic;

/// Functions of a corner.
struct Corner {
    x: f64,
    y: f64,
    z: f64,
    rho: f64,
    /// ln(ρ + z).
    log: f64,
    t: f64,
    lx: f64,
    ly: f64,
    ux: f64,
    uy: f64,
}

impl Corner {
    fn new(x: f64, y: f64, z: f64) -> Self {
        let rho = x.hypot(y).hypot(z);
        // ρ − z, which cancels above a deep point.
        let lower = (x * x + y * y) / (rho + z);
        let u = |x: f64, y: f64| -(x * y * lower).atan2(x * x * rho + y * y * z);
        Self {
            x,
            y,
            z,
            rho,
            log: (rho + z).ln(),
            t: (x * y).atan2(z * rho),
            lx: (x / y.hypot(z)).asinh(),
            ly: (y / x.hypot(z)).asinh(),
            ux: u(x, y),
            uy: u(y, x),
        }
    }

    fn fxx(&self) -> f64 {
        -self.x * self.y / (self.rho * (self.x * self.x + self.z * self.z))
    }

    fn fyy(&self) -> f64 {
        -self.x * self.y / (self.rho * (self.y * self.y + self.z * self.z))
    }

    fn tx(&self) -> f64 {
        self.y * self.z / (self.rho * (self.x * self.x + self.z * self.z))
    }

    fn ty(&self) -> f64 {
        self.x * self.z / (self.rho * (self.y * self.y + self.z * self.z))
    }

    fn f(&self) -> f64 {
        self.x * self.ly + self.y * self.lx - self.z * self.t
    }

    fn potential_x(&self) -> f64 {
        -(self.y * self.log + self.z * self.ly - self.x * self.ux)
    }

    fn potential_y(&self) -> f64 {
        -(self.x * self.log + self.z * self.lx - self.y * self.uy)
    }

    fn pressure(&self, material: Elastic) -> [f64; COMPONENTS] {
        let (nu, z) = (material.poisson(), self.z);
        let far = 1.0 - 2.0 * nu;
        let c = 0.5 / material.shear();
        let (fxx, fyy) = (self.fxx(), self.fyy());
        [
            self.ux + 2.0 * nu * self.uy - z * fxx,
            self.uy + 2.0 * nu * self.ux - z * fyy,
            z * (fxx + fyy) - self.t,
            -far * self.log - z / self.rho,
            z * self.ty(),
            z * self.tx(),
            c * (far * self.potential_x() - z * self.ly),
            c * (far * self.potential_y() - z * self.lx),
            c * (2.0 * (1.0 - nu) * self.f() + z * self.t),
        ]
    }

    fn traction(&self, material: Elastic) -> [f64; COMPONENTS] {
        let (nu, z, rho) = (material.poisson(), self.z, self.rho);
        let far = 1.0 - 2.0 * nu;
        let c = 0.5 / material.shear();
        let bend = (2.0 * nu + z / rho) / (rho + z);
        let yx = -self.x * self.ly - z * self.ux;
        [
            2.0 * self.ly - z * self.tx() + bend * self.y,
            2.0 * nu * self.ly - bend * self.y,
            z * self.tx(),
            self.lx - bend * self.x,
            -z / rho,
            -self.t - z * self.fxx(),
            c * (2.0 * self.f() + 2.0 * nu * yx + z * self.ux),
            c * (2.0 * nu * (z * self.log - rho) - z * self.log),
            -c * (far * self.potential_x() + z * self.ly),
        ]
    }
}

/// Components at (x, y) from the centre of a cell of half sides `half`, at depth z, of unit
/// pressure on it.
pub(crate) fn under_pressure(
    material: Elastic,
    half: [f64; 2],
    at: [f64; 2],
    z: f64,
) -> [f64; COMPONENTS] {
    corners(half, at, |x, y| Corner::new(x, y, z).pressure(material))
}

/// The same of unit traction along x.
pub(crate) fn under_traction(
    material: Elastic,
    half: [f64; 2],
    at: [f64; 2],
    z: f64,
) -> [f64; COMPONENTS] {
    corners(half, at, |x, y| Corner::new(x, y, z).traction(material))
}

fn corners(
    [a, b]: [f64; 2],
    [x, y]: [f64; 2],
    function: impl Fn(f64, f64) -> [f64; COMPONENTS],
) -> [f64; COMPONENTS] {
    let [pp, mp, pm, mm] = [
        function(x + a, y + b),
        function(x - a, y + b),
        function(x + a, y - b),
        function(x - a, y - b),
    ];
    std::array::from_fn(|k| (pp[k] - mp[k] - pm[k] + mm[k]) / (2.0 * PI))
}
