//! Derivatives of a layer's elements with respect to Poisson's ratio.

use super::{SMALL, Shapes, Symmetric};
use crate::model::material::Elastic;

/// ∂(tᵀ H11 t + 2 tᵀ H12 u − uᵀ H22 u)/∂ν of a layer of `material` with x = αh, at fixed shear modulus; t is the
/// `traction` on its top, and u the `displacement` of its bottom times α.
///
/// Each element is a quotient N/Δ, so that dN Δ − N dΔ over Δ² is its derivative. The elements 11 and 22 of H12 are 1
/// at x = 0 for any ν. For small x their derivatives come from D = Δ − N, which vanishes as x²:
///
/// ```text
/// D = 8η² (1 − cosh x) + 2k (sinh²x − x²) + 8η x² ∓ 4η x sinh x
/// ```
pub(in crate::compliance::response) fn of_energy(
    material: Elastic,
    x: f64,
    [p, tau]: [f64; 2],
    [w, v]: [f64; 2],
) -> f64 {
    let (g, nu) = (material.shear(), material.poisson());
    let (eta, epsilon, k) = (1.0 - nu, 1.0 - 2.0 * nu, 3.0 - 4.0 * nu);
    let shapes = Shapes::new(x);
    let delta = shapes.delta(nu);
    let Shapes {
        scale, decay: [_, e2], cosh, sinh, xs, x2s, sinh2_2x, xcosh_sinh, sinhsq_x2, ..
    } = shapes;
    let (xsinh, xcosh) = (x * sinh, x * cosh);
    let d_delta = -4.0 * (1.0 + e2 * e2) - scale * (12.0 - 16.0 * nu);
    let inverse = 1.0 / delta;
    let of = |n: f64, dn: f64| (dn - n * inverse * d_delta) * inverse;

    let (n11, n22) = (k * sinh2_2x + 4.0 * epsilon * xs, k * sinh2_2x + 8.0 * eta * xs);
    let slope = 4.0 * sinh2_2x + 8.0 * xs;
    let top = Symmetric(
        of(eta * n11, -n11 - eta * slope),
        of(
            epsilon * k * sinhsq_x2 + (epsilon * k - 1.0) * x2s,
            (16.0 * nu - 10.0) * (sinhsq_x2 + x2s),
        ),
        of(eta * n22, -n22 - eta * slope),
    );
    let bottom = Symmetric(
        of(eta * sinh2_2x, -sinh2_2x),
        of(epsilon * sinhsq_x2 + 2.0 * eta * x2s, -2.0 * (sinhsq_x2 + x2s)),
        of(eta * (sinh2_2x + 4.0 * xs), -(sinh2_2x + 4.0 * xs)),
    );
    let diagonal = |sign: f64| {
        if x < SMALL {
            let half = (0.5 * x).sinh();
            let versine = 2.0 * half * half * scale;
            let d = -8.0 * eta * eta * versine + 2.0 * k * sinhsq_x2 + 8.0 * eta * x2s
                - sign * 4.0 * eta * xsinh;
            let dd = 16.0 * eta * versine - 8.0 * (sinhsq_x2 + x2s) + sign * 4.0 * xsinh;
            -of(d, dd)
        } else {
            let n = 2.0 * eta * cosh + sign * xsinh;
            4.0 * of(eta * n, -n - 2.0 * eta * cosh)
        }
    };
    let (n12, n21) = (2.0 * nu * xcosh + epsilon * xcosh_sinh, 2.0 * eta * sinh + xcosh_sinh);
    let across = 4.0 * of(-eta * n12, n12 - 2.0 * eta * sinh);
    let along = 4.0 * of(eta * n21, -n21 - 2.0 * eta * sinh);
    let mixed = p * (diagonal(1.0) * w + across * v) + tau * (along * w + diagonal(-1.0) * v);
    top.form([p, tau]) / g + 2.0 * mixed - 4.0 * g * bottom.form([w, v])
}
