//! Stresses below the middle of a contact.

use crate::error::{Error, Result};
use crate::numerics::special::carlson_rd;

/// Largest shear stress, and the depth at which it is.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Shear {
    /// Half the difference of the largest and the smallest principal stress \[Pa\].
    pub stress: f64,
    /// Depth below the surface \[m\].
    pub depth: f64,
}

/// Largest shear stress on the axis of an ellipse of pressure, in a body of Poisson's ratio `poisson`.
///
/// With T_x = √(a² + z²), T_y = √(b² + z²), from the potentials of Boussinesq, integrated by parts:
///
/// ```text
/// σ_z = −p0 a b / T_x T_y
/// σ_x = p0 a b [(1−ν) z J_x − ν z J − (1−2ν) / T_x (T_x + T_y)]
/// z J_x = 2/3 z R_D(z², T_y², T_x²)      z J = 2 / T_x T_y − z J_x − z J_y
/// ```
///
/// Derived for nacre; for a = b they are Johnson (1985), eqs (3.45).
pub(super) fn below_ellipse(axes: [f64; 2], peak: f64, poisson: f64) -> Result<Shear> {
    let [a, b] = axes;
    // In units of the shorter axis.
    let scale = a.min(b);
    let [a, b] = [a / scale, b / scale];
    let stresses = |z: f64| {
        let (sx, sy) = (a * a + z * z, b * b + z * z);
        let (tx, ty) = (sx.sqrt(), sy.sqrt());
        let whole = 2.0 / (tx * ty);
        // z J_x, of which the limit at the surface is 0.
        let along = |y: f64, z2: f64| match z > 0.0 {
            true => 2.0 / 3.0 * z * carlson_rd([z * z, y, z2]),
            false => 0.0,
        };
        let (jx, jy) = (along(sy, sx), along(sx, sy));
        let j = whole - jx - jy;
        let lateral = |own: f64, t: f64| {
            a * b * ((1.0 - poisson) * own - poisson * j - (1.0 - 2.0 * poisson) / (t * (tx + ty)))
        };
        [lateral(jx, tx), lateral(jy, ty), -a * b / (tx * ty)]
    };
    largest(stresses, poisson, peak, scale)
}

/// Largest shear stress below the middle of a strip of pressure, in plane strain. Johnson (1985), eq.
/// (4.46), and σ_axial = ν (σ_y + σ_z).
pub(super) fn below_line(half_width: f64, peak: f64, poisson: f64) -> Result<Shear> {
    let stresses = |z: f64| {
        let t = (1.0 + z * z).sqrt();
        // −[(1 + 2z²)/t − 2z], without cancellation.
        let across = -1.0 / (t * (1.0 + 2.0 * z * (z + t)));
        let down = -1.0 / t;
        [poisson * (across + down), across, down]
    };
    largest(stresses, poisson, peak, half_width)
}

/// Points of the search for the depth, up to two half-widths, below which shear only falls.
const SEARCH: usize = 64;

/// Largest shear of principal stresses that depend on the depth in units of `scale`, per peak pressure.
fn largest(
    stresses: impl Fn(f64) -> [f64; 3],
    poisson: f64,
    peak: f64,
    scale: f64,
) -> Result<Shear> {
    if !(poisson > -1.0 && poisson <= 0.5) {
        return Err(Error::Parameter {
            name: "poisson",
            requirement: "above -1 and at most 0.5",
            value: poisson,
        });
    }
    let shear = |z: f64| {
        let [x, y, z] = stresses(z);
        0.5 * (x.max(y).max(z) - x.min(y).min(z))
    };
    let step = 2.0 / SEARCH as f64;
    let points = (0..=SEARCH).map(|k| k as f64 * step);
    let best = points.fold(0.0, |best, z| if shear(z) > shear(best) { z } else { best });
    // Golden section between the neighbours of the best point.
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = ((best - step).max(0.0), best + step);
    while high - low > 1e-9 {
        let width = golden * (high - low);
        if shear(high - width) > shear(low + width) {
            high = low + width;
        } else {
            low = high - width;
        }
    }
    let middle = 0.5 * (low + high);
    // At the surface itself, the section ends beside it.
    let z = if shear(best) >= shear(middle) {
        best
    } else {
        middle
    };
    Ok(Shear {
        stress: peak * shear(z),
        depth: scale * z,
    })
}
