//! Loads: which radial functions make which components, and with what angular part.
//!
//! A load at the origin gives, with the transforms H_ν of what [`UnitFields`] holds, and φ the polar
//! angle of (x, y); under pressure, with S, D = (σ_LL ± σ_TT)/2,
//!
//! ```text
//! σ_zz = −H0[P]      σ_xz = H1[τ] cos φ      σ_yz = H1[τ] sin φ
//! σ_xx, σ_yy = H0[S] ∓ H2[D] cos 2φ          σ_xy = −H2[D] sin 2φ
//! u_z = H0[W]        u_x = −H1[V] cos φ      u_y = −H1[V] sin φ
//! ```
//!
//! and under traction along x, with A, B = (τ ± Q)/2, E1, E3 = (D ∓ GU)/2, M, N = (V ± U)/2,
//!
//! ```text
//! σ_zz = −H1[P] cos φ      σ_xz = −H0[A] + H2[B] cos 2φ      σ_yz = H2[B] sin 2φ
//! σ_xx, σ_yy = H1[S] cos φ ± (H1[E1] cos φ − H3[E3] cos 3φ)  σ_xy = H1[E1] sin φ − H3[E3] sin 3φ
//! u_z = H1[W] cos φ        u_x = H0[M] − H2[N] cos 2φ        u_y = −H2[N] sin 2φ
//! ```

use std::marker::PhantomData;

pub(crate) use super::COMPONENTS;
use super::rectangle::{under_pressure, under_traction};
use super::series::{Order, TransformKind, homogeneous};
use crate::compliance::response::interior::UnitFields;
use crate::model::material::Elastic;

/// Whether each component is odd in x and in y, under pressure.
pub(crate) const ODD: [[bool; 2]; COMPONENTS] = [
    [false, false],
    [false, false],
    [false, false],
    [true, true],
    [false, true],
    [true, false],
    [true, false],
    [false, true],
    [false, false],
];

/// Position of each component after x and y are exchanged.
pub(crate) const EXCHANGED: [usize; COMPONENTS] = [1, 0, 2, 3, 5, 4, 7, 6, 8];

/// A unit load on a point or a cell: pressure, or traction along x.
pub(crate) trait Load: Sync {
    /// Bessel orders and kinds of the radial functions: those of the stresses, then those of the displacements. There
    /// may be fewer than [`RADIAL`].
    const ORDERS: &'static [Order];

    /// Whether this is a traction along x, instead of a pressure.
    const IS_TRACTION: bool;

    /// D of each radial function of [`super::series`]; displacements times α.
    fn radial(fields: &UnitFields, material: Elastic) -> [f64; RADIAL];

    /// Components at (x, y), made of h_ν = H_ν/r^ν.
    fn components(h: &[f64; RADIAL], x: f64, y: f64) -> [f64; COMPONENTS];

    /// Components in a homogeneous half-space, of a unit load on a cell of half sides `half`, at
    /// (x, y) from its centre and depth z.
    fn closed(material: Elastic, half: [f64; 2], at: [f64; 2], z: f64) -> [f64; COMPONENTS];
}

/// Most radial functions that a load has.
const RADIAL: usize = 9;

const fn stress(nu: f64) -> Order {
    Order { nu, kind: TransformKind::Stress }
}

const fn displacement(nu: f64) -> Order {
    Order { nu, kind: TransformKind::Displacement }
}

/// Unit pressure.
#[derive(Debug, Clone, Copy)]
pub(crate) struct UnitPressure;

impl Load for UnitPressure {
    const ORDERS: &'static [Order] =
        &[stress(0.0), stress(0.0), stress(2.0), stress(1.0), displacement(0.0), displacement(1.0)];

    const IS_TRACTION: bool = false;

    fn radial(fields: &UnitFields, material: Elastic) -> [f64; RADIAL] {
        let state = &fields.pressure;
        let (along, across) = state.lateral_stress(material);
        let (s, d) = (0.5 * (along + across), 0.5 * (along - across));
        [state.p, s, d, state.tau, state.w, state.v, 0.0, 0.0, 0.0]
    }

    fn components(h: &[f64; RADIAL], x: f64, y: f64) -> [f64; COMPONENTS] {
        let [p, s, d, tau, w, v, ..] = *h;
        let d2 = d * (x * x - y * y);
        [s - d2, s + d2, -p, -2.0 * d * x * y, tau * y, tau * x, -v * x, -v * y, w]
    }

    fn closed(material: Elastic, half: [f64; 2], at: [f64; 2], z: f64) -> [f64; COMPONENTS] {
        under_pressure(material, half, at, z)
    }
}

/// Unit traction along x.
#[derive(Debug, Clone, Copy)]
pub(crate) struct UnitTraction;

impl Load for UnitTraction {
    const ORDERS: &'static [Order] = &[
        stress(1.0),
        stress(0.0),
        stress(2.0),
        stress(1.0),
        stress(1.0),
        stress(3.0),
        displacement(1.0),
        displacement(0.0),
        displacement(2.0),
    ];

    const IS_TRACTION: bool = true;

    fn radial(fields: &UnitFields, material: Elastic) -> [f64; RADIAL] {
        let state = &fields.shear;
        let (q, u) = fields.twist;
        let (along, across) = state.lateral_stress(material);
        let (s, d) = (0.5 * (along + across), 0.5 * (along - across));
        let gu = material.shear() * u;
        [
            state.p,
            0.5 * (state.tau + q),
            0.5 * (state.tau - q),
            s,
            0.5 * (d - gu),
            0.5 * (d + gu),
            state.w,
            0.5 * (state.v + u),
            0.5 * (state.v - u),
        ]
    }

    fn components(h: &[f64; RADIAL], x: f64, y: f64) -> [f64; COMPONENTS] {
        let [p, a, b, s, e1, e3, w, m, n] = *h;
        let (x2, y2) = (x * x, y * y);
        let (cos2, sin2) = (x2 - y2, 2.0 * x * y);
        let cos = e1 * x - e3 * x * (x2 - 3.0 * y2);
        let sin = e1 * y - e3 * y * (3.0 * x2 - y2);
        [
            s * x + cos,
            s * x - cos,
            -p * x,
            sin,
            b * sin2,
            b * cos2 - a,
            m - n * cos2,
            -n * sin2,
            w * x,
        ]
    }

    fn closed(material: Elastic, half: [f64; 2], at: [f64; 2], z: f64) -> [f64; COMPONENTS] {
        under_traction(material, half, at, z)
    }
}

/// `N` radial functions of a load, which make all of its components or some.
pub(crate) trait Radial<const N: usize>: Sync {
    type Load: Load;

    /// Number of the first of the functions.
    const FIRST: usize;

    /// Whether the load is a traction along x, instead of a pressure.
    const IS_TRACTION: bool = Self::Load::IS_TRACTION;

    /// Bessel orders and kinds of the functions.
    fn orders() -> [Order; N] {
        std::array::from_fn(|k| Self::Load::ORDERS[Self::FIRST + k])
    }

    /// D of the functions.
    fn radial(fields: &UnitFields, material: Elastic) -> [f64; N] {
        let all = Self::Load::radial(fields, material);
        std::array::from_fn(|k| all[Self::FIRST + k])
    }

    /// The components that the functions make.
    #[inline]
    fn components(h: &[f64; N], x: f64, y: f64) -> [f64; COMPONENTS] {
        let mut all = [0.0; RADIAL];
        all[Self::FIRST..Self::FIRST + N].copy_from_slice(h);
        Self::Load::components(&all, x, y)
    }
}

/// `N` radial functions of a load, from number `FIRST` on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RadialFunctions<L, const FIRST: usize, const N: usize>(PhantomData<L>);

impl<L: Load, const FIRST: usize, const N: usize> Radial<N> for RadialFunctions<L, FIRST, N> {
    type Load = L;

    const FIRST: usize = FIRST;
}

/// Stresses and displacements of a pressure.
pub(crate) type Pressure = RadialFunctions<UnitPressure, 0, 6>;

/// Stresses of a pressure.
pub(crate) type PressureStress = RadialFunctions<UnitPressure, 0, 4>;

/// Stresses and displacements of a traction along x.
pub(crate) type Traction = RadialFunctions<UnitTraction, 0, 9>;

/// Stresses of a traction along x.
pub(crate) type TractionStress = RadialFunctions<UnitTraction, 0, 6>;

/// Displacements of a traction along x.
pub(crate) type TractionDisplacement = RadialFunctions<UnitTraction, 6, 3>;

/// Radial functions h_ν = H_ν/r^ν of a point load on a homogeneous half-space, at depth z.
///
/// D there is (c0 + c1 αz) e^{−αz}, and
///
/// ```text
/// ∫ α^k e^{−αz} J_ν dα = t^ν/R · {1, (z + νR)/R², [3z² + 3νzR + (ν²−1)R²]/R⁴}
/// ```
///
/// with R² = s + z², t = r/(R + z), k = 0, 1, 2.
#[derive(Debug)]
pub(crate) struct PointLoad<const N: usize> {
    orders: [Order; N],
    z: f64,
    /// c0 and c1.
    coefficients: [[f64; 2]; N],
}

impl<const N: usize> PointLoad<N> {
    pub(crate) fn new<L: Radial<N>>(material: Elastic, z: f64) -> Self {
        Self { orders: L::orders(), z, coefficients: homogeneous(material, L::radial) }
    }

    /// h_ν at the squared distance s = r².
    pub(crate) fn at(&self, s: f64) -> [f64; N] {
        let z = self.z;
        let root = (s + z * z).sqrt();
        let inverse = 1.0 / root;
        let lean = 1.0 / (root + z);
        std::array::from_fn(|k| {
            let Order { nu, kind } = self.orders[k];
            let [c0, c1] = self.coefficients[k];
            let power = lean.powi(nu as i32) * inverse / (2.0 * std::f64::consts::PI);
            let first = (z + nu * root) * inverse * inverse;
            match kind {
                TransformKind::Displacement | TransformKind::Vanishing => {
                    power * (c0 + c1 * z * first)
                }
                TransformKind::Stress | TransformKind::Line => {
                    let second =
                        (3.0 * z * z + 3.0 * nu * z * root + (nu * nu - 1.0) * root * root)
                            * inverse.powi(4);
                    power * (c0 * first + c1 * z * second)
                }
            }
        })
    }
}
