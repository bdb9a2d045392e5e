//! One layer as an element between its two faces: the step of the recursion, which was derived here.

use crate::model::body::{Interface, Substrate};
use crate::model::material::Elastic;

/// Surface compliance at one wavenumber: [`c11`](Self::c11), [`c12`](Self::c12),
/// [`c22`](Self::c22), [`ct`](Self::ct), as in the formula of [`response`](crate::compliance::response).
///
/// In \[m/Pa\] when returned by [`surface_compliance`](super::surface_compliance).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compliance {
    /// Normal displacement under pressure.
    pub c11: f64,
    /// Lateral displacement under pressure, and normal displacement under lateral traction.
    pub c12: f64,
    /// Lateral displacement under traction along the wave vector.
    pub c22: f64,
    /// Displacement under traction across the wave vector.
    pub ct: f64,
}

impl Compliance {
    /// α times the compliance of a homogeneous half-space \[1/Pa\], the same at every α.
    ///
    /// ```text
    /// α c11 = α c22 = (1 − ν)/G     α c12 = (1 − 2ν)/2G     α ct = 1/G
    /// ```
    pub fn homogeneous(material: Elastic) -> Self {
        let (g, nu) = (material.shear(), material.poisson());
        let c11 = (1.0 - nu) / g;
        Self { c11, c12: (1.0 - 2.0 * nu) / (2.0 * g), c22: c11, ct: 1.0 / g }
    }

    /// α times the compliance of what the lowest layer lies on; 0 of a rigid base, infinite where that is free.
    pub(crate) fn of_substrate(substrate: Substrate) -> Self {
        let base = |c: f64| Self { c11: c, c12: 0.0, c22: c, ct: c };
        match substrate {
            Substrate::Elastic(material) => Self::homogeneous(material),
            Substrate::Rigid => base(0.0),
            Substrate::Free => base(f64::INFINITY),
        }
    }

    /// All four compliances times `factor`.
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self {
            c11: self.c11 * factor,
            c12: self.c12 * factor,
            c22: self.c22 * factor,
            ct: self.ct * factor,
        }
    }
}

/// What is below a layer: compliances times α, those of an interface included, and how they hold the layer.
#[derive(Debug, Clone, Copy)]
pub(super) enum Support {
    /// All tractions pass.
    Held(Compliance),
    /// The shear traction is 0.
    Slips(Compliance),
    /// No traction passes: the bottom face of a plate.
    Free,
}

impl Support {
    /// A body of compliance `below`, and the `interface` on it, at wavenumber `alpha`: springs of stiffness k add α/k.
    pub(super) fn new(below: Compliance, interface: Interface, alpha: f64) -> Self {
        if below.c11.is_infinite() {
            return Self::Free;
        }
        let [normal, tangential] = interface.compliances().map(|c| alpha * c);
        let Compliance { c11, c12, c22, ct } = below;
        let all = Compliance { c11: c11 + normal, c12, c22: c22 + tangential, ct: ct + tangential };
        if interface.slips() { Self::Slips(all) } else { Self::Held(all) }
    }
}

/// A layer of thickness h at wavenumber α, x = αh, with traction t = (P, τ) given on top and
/// displacement u = (W, V) given at the bottom:
///
/// ```text
/// u_top = H11 t_top + H12 u_bot      t_bot = H12ᵀ t_top − H22 u_bot
/// ```
///
/// H11 is stored times α \[1/Pa\], H22 over α \[Pa\]. With η = 1−ν, ε = 1−2ν, k = 3−4ν,
/// Δ = k cosh 2x + 2x² + 5 − 12ν + 8ν²:
///
/// ```text
/// Gα H11 Δ :    11  η (k sinh 2x − 2x)      22  η (k sinh 2x + 2x)      12  εk sinh²x − x²
/// H12 Δ :       11  4η (2η cosh x + x sinh x)     12  4η (ε sinh x − x cosh x)
///               21  4η (ε sinh x + x cosh x)      22  4η (2η cosh x − x sinh x)
/// H22 Δ/(Gα) :  11  4η (sinh 2x − 2x)       22  4η (sinh 2x + 2x)       12  4 (ε sinh²x + x²)
/// det H22 = 8 (sinh²x − x²)/Δ · (Gα)²
/// twist:        Gα h11 = h22/(Gα) = tanh x         h12 = 1/cosh x
/// ```
///
/// Numerators and Δ are multiplied by 2e^{−2x}, so that nothing grows; the differences that cancel
/// at small x come from their power series. Derived for nacre from the stresses of a layer (Burmister,
/// J. Appl. Phys. 16 (1945) 89).
pub(super) struct Slab {
    h11: Symmetric,
    h12: [[f64; 2]; 2],
    h22: Symmetric,
    det_h22: f64,
    twist: Twist,
}

/// A symmetric 2 × 2 matrix: elements 11, 12, 22.
struct Symmetric(f64, f64, f64);

impl Symmetric {
    /// vᵀ M v
    fn form(&self, [a, b]: [f64; 2]) -> f64 {
        a * (self.0 * a + self.1 * b) + b * (self.1 * a + self.2 * b)
    }
}

struct Twist {
    h11: f64,
    h12: f64,
    h22: f64,
}

/// x below which differences that cancel come from their power series.
const SMALL: f64 = 0.5;

/// sinh 2x − 2x, x cosh x − sinh x, sinh²x − x², by their power series; for 0 ≤ x < [`SMALL`], where
/// twelve terms leave (2x)²⁴/27! < 1e-28.
fn small_differences(x: f64) -> (f64, f64, f64) {
    let (x2, y2) = (x * x, 4.0 * x * x);
    // Each sum runs over k = 1, 2, …; its term is the one before times the ratio of the series.
    let (mut sinh, mut mixed, mut square) = (0.0, 0.0, 0.0);
    let mut a = 2.0 * x; // (2x)^{2k+1}/(2k+1)!
    let mut b = x; // x^{2k+1}/(2k+1)!
    let mut c = x2; // (2x)^{2k+2}/(2 (2k+2)!)
    for k in 1..=12 {
        let k = f64::from(k);
        a *= y2 / (2.0 * k * (2.0 * k + 1.0));
        b *= x2 / (2.0 * k * (2.0 * k + 1.0));
        c *= y2 / ((2.0 * k + 1.0) * (2.0 * k + 2.0));
        sinh += a;
        mixed += 2.0 * k * b;
        square += c;
    }
    (sinh, mixed, square)
}

/// The functions of x that the elements consist of, each times 2e^{−2x}.
struct Shapes {
    /// 2e^{−2x}
    scale: f64,
    /// e^{−x} and e^{−2x}, as they are.
    decay: [f64; 2],
    cosh: f64,
    sinh: f64,
    /// x
    xs: f64,
    /// x²
    x2s: f64,
    /// sinh 2x − 2x
    sinh2_2x: f64,
    /// x cosh x − sinh x
    xcosh_sinh: f64,
    /// sinh²x − x²
    sinhsq_x2: f64,
}

impl Shapes {
    fn new(x: f64) -> Self {
        let e1 = (-x).exp();
        let e2 = e1 * e1;
        let scale = 2.0 * e2;
        let (cosh, sinh) = (e1 * (1.0 + e2), -e1 * (-2.0 * x).exp_m1());
        let (xs, x2s) = (x * scale, x * x * scale);
        let (sinh2_2x, xcosh_sinh, sinhsq_x2) = if x < SMALL {
            let (a, b, c) = small_differences(x);
            (scale * a, scale * b, scale * c)
        } else {
            let half = (-2.0 * x).exp_m1();
            (-(-4.0 * x).exp_m1() - 2.0 * xs, x * cosh - sinh, 0.5 * half * half - x2s)
        };
        Self { scale, decay: [e1, e2], cosh, sinh, xs, x2s, sinh2_2x, xcosh_sinh, sinhsq_x2 }
    }

    /// Δ times 2e^{−2x}.
    fn delta(&self, nu: f64) -> f64 {
        let (k, [_, e2]) = (3.0 - 4.0 * nu, self.decay);
        k * (1.0 + e2 * e2) + 2.0 * self.x2s + self.scale * (5.0 - 12.0 * nu + 8.0 * nu * nu)
    }
}

impl Slab {
    pub(super) fn new(material: Elastic, x: f64) -> Self {
        let shapes = Shapes::new(x);
        let (g, nu) = (material.shear(), material.poisson());
        let (eta, epsilon, k) = (1.0 - nu, 1.0 - 2.0 * nu, 3.0 - 4.0 * nu);
        let delta = shapes.delta(nu);
        let Shapes {
            decay: [e1, e2], cosh, sinh, xs, x2s, sinh2_2x, xcosh_sinh, sinhsq_x2, ..
        } = shapes;
        let (xsinh, xcosh) = (x * sinh, x * cosh);
        let h11 = 1.0 / (g * delta);
        let h12 = 4.0 * eta / delta;
        let h22 = 4.0 * g / delta;
        Self {
            h11: Symmetric(
                h11 * eta * (k * sinh2_2x + 4.0 * epsilon * xs),
                h11 * (epsilon * k * sinhsq_x2 + (epsilon * k - 1.0) * x2s),
                h11 * eta * (k * sinh2_2x + 8.0 * eta * xs),
            ),
            h12: [
                [
                    h12 * (2.0 * eta * cosh + xsinh),
                    -h12 * (2.0 * nu * xcosh + epsilon * xcosh_sinh),
                ],
                [h12 * (2.0 * eta * sinh + xcosh_sinh), h12 * (2.0 * eta * cosh - xsinh)],
            ],
            h22: Symmetric(
                h22 * eta * sinh2_2x,
                h22 * (epsilon * sinhsq_x2 + 2.0 * eta * x2s),
                h22 * eta * (sinh2_2x + 4.0 * xs),
            ),
            det_h22: 8.0 * sinhsq_x2 / delta * g * g,
            twist: Twist { h11: x.tanh() / g, h12: 2.0 * e1 / (1.0 + e2), h22: x.tanh() * g },
        }
    }

    /// α times the compliance of the top face of this layer on `below`.
    ///
    /// Held, with all terms positive:
    ///
    /// ```text
    /// X = (C⁻¹ + H22)⁻¹ = (C + det C · adj H22) / (1 + tr(C H22) + det C · det H22)
    /// C_top = H11 + H12 X H12ᵀ
    /// ```
    ///
    /// Where it slips, C⁻¹ becomes diag(1/c11, 0), and 0 where it is free: X = H22⁻¹.
    pub(super) fn onto(&self, below: Support) -> Compliance {
        let Symmetric(k11, k12, k22) = self.h22;
        let (x, twist) = match below {
            Support::Held(Compliance { c11, c12, c22, ct }) => {
                let det = c11 * c22 - c12 * c12;
                let den = 1.0 + c11 * k11 + 2.0 * c12 * k12 + c22 * k22 + det * self.det_h22;
                let x = Symmetric(
                    (c11 + det * k22) / den,
                    (c12 - det * k12) / den,
                    (c22 + det * k11) / den,
                );
                (x, ct / (1.0 + ct * self.twist.h22))
            }
            Support::Slips(Compliance { c11, .. }) => {
                let den = c11 * self.det_h22 + k22;
                let x = Symmetric(c11 * k22 / den, -c11 * k12 / den, (1.0 + c11 * k11) / den);
                (x, 1.0 / self.twist.h22)
            }
            Support::Free => {
                let den = self.det_h22;
                (Symmetric(k22 / den, -k12 / den, k11 / den), 1.0 / self.twist.h22)
            }
        };
        let [[a, b], [c, d]] = self.h12;
        let Symmetric(x11, x12, x22) = x;
        Compliance {
            c11: self.h11.0 + a * a * x11 + 2.0 * a * b * x12 + b * b * x22,
            c12: self.h11.1 + a * c * x11 + (a * d + b * c) * x12 + b * d * x22,
            c22: self.h11.2 + c * c * x11 + 2.0 * c * d * x12 + d * d * x22,
            ct: self.twist.h11 + self.twist.h12 * self.twist.h12 * twist,
        }
    }

    /// Traction at the bottom face of this layer, on `below`, under `traction` (P, τ) on its top, and α times the
    /// displacement of the layer's side of that face.
    ///
    /// Held, with f = H12ᵀ t and M = H22 C:
    ///
    /// ```text
    /// D = 1 + tr M + det M      t_bot = (I + adj M) f / D      u_bot = (C + det C · adj H22) f / D
    /// ```
    ///
    /// Where it slips, the limit for C⁻¹ = diag(1/c11, 0), where the shear traction is 0; where it is free, for C⁻¹ = 0.
    pub(super) fn through(&self, below: Support, [p, tau]: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        let Symmetric(k11, k12, k22) = self.h22;
        let [[a, b], [c, d]] = self.h12;
        let (f1, f2) = (a * p + c * tau, b * p + d * tau);
        match below {
            Support::Held(Compliance { c11, c12, c22, .. }) => {
                let det = c11 * c22 - c12 * c12;
                let (m11, m12) = (k11 * c11 + k12 * c12, k11 * c12 + k12 * c22);
                let (m21, m22) = (k12 * c11 + k22 * c12, k12 * c12 + k22 * c22);
                let den = 1.0 + m11 + m22 + det * self.det_h22;
                let traction =
                    [((1.0 + m22) * f1 - m12 * f2) / den, ((1.0 + m11) * f2 - m21 * f1) / den];
                let displacement = [
                    ((c11 + det * k22) * f1 + (c12 - det * k12) * f2) / den,
                    ((c12 - det * k12) * f1 + (c22 + det * k11) * f2) / den,
                ];
                (traction, displacement)
            }
            Support::Slips(Compliance { c11, .. }) => {
                let den = c11 * self.det_h22 + k22;
                let pressure = (k22 * f1 - k12 * f2) / den;
                let lateral = ((1.0 + c11 * k11) * f2 - c11 * k12 * f1) / den;
                ([pressure, 0.0], [c11 * pressure, lateral])
            }
            Support::Free => {
                let den = self.det_h22;
                ([0.0; 2], [(k22 * f1 - k12 * f2) / den, (k11 * f2 - k12 * f1) / den])
            }
        }
    }

    /// Traction Q at the bottom face of this layer under the twist `q` on its top, and α times the displacement U there.
    pub(super) fn twist_through(&self, below: Support, q: f64) -> (f64, f64) {
        let f = self.twist.h12 * q;
        match below {
            Support::Held(Compliance { ct, .. }) => {
                let q = f / (1.0 + ct * self.twist.h22);
                (q, ct * q)
            }
            Support::Slips(_) | Support::Free => (0.0, f / self.twist.h22),
        }
    }

    /// Twice the strain energy of the layer under `traction` on its top and `displacement` of its bottom,
    /// tᵀ H11 t + uᵀ H22 u.
    pub(super) fn energy(&self, traction: [f64; 2], displacement: [f64; 2]) -> f64 {
        self.h11.form(traction) + self.h22.form(displacement)
    }
}

/// ∂(tᵀ H11 t + 2 tᵀ H12 u − uᵀ H22 u)/∂ν of a layer of `material` with x = αh, at fixed shear modulus; t is the
/// `traction` on its top, and u the `displacement` of its bottom times α.
///
/// Each element is a quotient N/Δ, so that dN Δ − N dΔ over Δ² is its derivative. The elements 11 and 22 of H12 are 1
/// at x = 0 for any ν. For small x their derivatives come from D = Δ − N, which vanishes as x²:
///
/// ```text
/// D = 8η² (1 − cosh x) + 2k (sinh²x − x²) + 8η x² ∓ 4η x sinh x
/// ```
pub(super) fn of_energy(material: Elastic, x: f64, [p, tau]: [f64; 2], [w, v]: [f64; 2]) -> f64 {
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
