//! Harmonic potentials of a uniformly loaded rectangle, as sums over its corners, and the stress and displacement of a
//! homogeneous half-space that they make.
//!
//! With (x, y) the distances to a corner, z the depth and ρ² = x² + y² + z²,
//!
//! ```text
//! T  = atan(xy/zρ)       L_y = asinh(y/√(x²+z²))      U_x = −atan[xy(ρ−z)/(x²ρ + y²z)]
//! F  = x L_y + y L_x − z T      X = −[y ln(ρ+z) + z L_y − x U_x]      Y_x = −x L_y − z U_x
//! ```
//!
//! (L_x, U_y, Y_y with x and y exchanged), T = −U_x − U_y, and F_xx = −xy/ρ(x²+z²), T_x =
//! yz/ρ(x²+z²). F is the potential itself, ∬ 1/ρ.

use std::f64::consts::PI;

use super::COMPONENTS;
use super::quadrature::Rules;
use crate::model::material::Elastic;

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
        product(self.x, self.ly) + product(self.y, self.lx) - self.z * self.t
    }

    fn potential_x(&self) -> f64 {
        -(self.y * self.log + self.z * self.ly - self.x * self.ux)
    }

    fn potential_y(&self) -> f64 {
        -(self.x * self.log + self.z * self.lx - self.y * self.uy)
    }
}

/// x L, which is 0 at x = 0, where L of a corner at the surface is infinite.
fn product(x: f64, l: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x * l }
}

/// Sum over the corners, with their signs, of N functions, at (x, y) from the centre of a
/// rectangle of half sides `half` and at depth z.
fn corners<const N: usize>(
    [a, b]: [f64; 2],
    [x, y]: [f64; 2],
    z: f64,
    function: impl Fn(&Corner) -> [f64; N],
) -> [f64; N] {
    let [pp, mp, pm, mm] = [[x + a, y + b], [x - a, y + b], [x + a, y - b], [x - a, y - b]]
        .map(|[x, y]| function(&Corner::new(x, y, z)));
    std::array::from_fn(|k| pp[k] - mp[k] - pm[k] + mm[k])
}

/// The potential ∬ 1/ρ of a rectangle of half sides `half`, at `at` from its centre and depth z,
/// anywhere.
///
/// Near the rectangle it is the sum of F over its corners (Love, Phil. Trans. R. Soc. A 228 (1929)
/// 377, doi:10.1098/rsta.1929.0009, at z = 0). Farther off, where that sum cancels, it is a Gauss
/// quadrature over the shorter side, or over both.
pub(crate) fn potential(rules: &Rules, half: [f64; 2], at: [f64; 2], z: f64) -> f64 {
    // Long side along x.
    let [a, b, x, y] = if half[0] >= half[1] {
        [half[0], half[1], at[0].abs(), at[1].abs()]
    } else {
        [half[1], half[0], at[1].abs(), at[0].abs()]
    };
    let distance = (x - a).max(0.0).hypot((y - b).max(0.0)).hypot(z);
    let Some(across) = rules.at(distance / b) else {
        let [sum] = corners([a, b], [x, y], z, |corner| [corner.f()]);
        return sum;
    };
    match rules.at(distance / a) {
        Some(along) => across.around(y, b, |y| {
            let s2 = y * y + z * z;
            along.around(x, a, |x| 1.0 / (x * x + s2).sqrt())
        }),
        None => across.around(y, b, |y| segment(x - a, x + a, y * y + z * z)),
    }
}

/// ∫ dx/√(x² + s²) = 2 atanh(ℓ/(r1 + r2)), which does not cancel.
fn segment(x1: f64, x2: f64, s2: f64) -> f64 {
    let (r1, r2) = ((x1 * x1 + s2).sqrt(), (x2 * x2 + s2).sqrt());
    2.0 * ((x2 - x1) / (r1 + r2)).atanh()
}

/// Components at `at` from the centre of a cell of half sides `half`, at depth z of a homogeneous half-space, under unit
/// pressure on the cell. Times 2π,
///
/// ```text
/// σ_xx = U_x + 2ν U_y − z F_xx      σ_zz = −T + z (F_xx + F_yy)      σ_xz = z T_x
/// σ_xy = −(1−2ν) ln(ρ+z) − z/ρ
/// 2G u_z = 2(1−ν) F + z T           2G u_x = (1−2ν) X − z L_y
/// ```
///
/// and those with x and y exchanged. Love, Phil. Trans. R. Soc. A 228 (1929) 377, doi:10.1098/rsta.1929.0009.
pub(crate) fn under_pressure(
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

/// Components as of [`under_pressure`], under unit traction along x on the cell. Times 2π,
///
/// ```text
/// σ_xx = 2 L_y − z T_x + (2ν + z/ρ) y/(ρ+z)     σ_yy = 2ν L_y − (2ν + z/ρ) y/(ρ+z)
/// σ_zz = z T_x      σ_xy = L_x − (2ν + z/ρ) x/(ρ+z)
/// σ_xz = −T − z F_xx      σ_yz = −z/ρ
/// 2G u_x = 2F + 2ν Y_x + z U_x      2G u_y = 2ν [z ln(ρ+z) − ρ] − z ln(ρ+z)
/// 2G u_z = −(1−2ν) X − z L_y
/// ```
///
/// They are Cerruti's solution for a point force (Johnson, Contact Mechanics (1985), §3.6,
/// doi:10.1017/CBO9781139171731), integrated over the rectangle.
pub(super) fn under_traction(
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

#[cfg(test)]
mod tests {
    use super::super::quadrature::CellRules;
    use super::*;

    /// Both evaluations where each is good: 2 to 30 half-sides off the closed form loses at most
    /// (r/b)² = 1e3 of its 1e-16.
    #[test]
    fn quadrature_continues_the_closed_form() {
        for (dx, dy) in [(1.0, 1.0), (1.0, 0.3), (0.02, 1.0), (1.0, 1e-3)] {
            let half = [0.5 * dx, 0.5 * dy];
            for z in [0.0, 0.4, 3.0] {
                for (i, j) in
                    [(1.3, 0.0), (0.0, 1.4), (1.2, 1.2), (1.6, 0.4), (3.0, 4.0), (0.2, 9.0)]
                {
                    let at = [i * dx, j * dy];
                    let [closed] = corners(half, at, z, |corner| [corner.f()]);
                    let value = potential(&Rules::displacement(), half, at, z);
                    let lost = 1e3_f64.max(z * z / (dx * dy)).max(dx / dy);
                    assert!(
                        (value / closed - 1.0).abs() < 1e-14 * lost,
                        "{dx} {dy} {z} {i} {j}: {value} {closed}"
                    );
                }
            }
        }
    }

    /// 1/r, whose mean η is 1, over cells of any shape, near and far.
    #[test]
    fn quadrature_over_cells_is_the_closed_form() {
        let cells = CellRules::new(Rules::displacement());
        for half in [[0.5, 0.5], [8.0, 0.5], [0.5, 40.0]] {
            for at in [[0.0, 0.0], [1.0, 0.0], [0.3, 3.0], [17.0, 0.1], [9.0, 9.0], [500.0, 90.0]] {
                let mut sum = 0.0;
                let far = cells.nodes(at, half, 0.0, |weight, x, y| sum += weight / x.hypot(y));
                if !far {
                    cells.corners(at, half, |weight, _, _| sum += weight);
                }
                let exact = potential(cells.rules(), half, at, 0.0);
                assert!((sum / exact - 1.0).abs() < 3e-12, "{half:?} {at:?}: {sum}");
            }
        }
    }

    #[test]
    fn far_potential_is_that_of_a_point() {
        // Quadrupole: 1/24 [dx² (3x²/r² − 1) + dy² (3y²/r² − 1)]/r²
        let at = [3e3, 4e3];
        let quadrupole = ((3.0 * 0.36 - 1.0) + 4.0 * (3.0 * 0.64 - 1.0)) / 24.0 / 25e6;
        let value = potential(&Rules::displacement(), [0.5, 1.0], at, 0.0);
        let point = 2.0 / 5e3;
        assert!((value / point / (1.0 + quadrupole) - 1.0).abs() < 1e-14);
    }
}
