//! Frequency response below the surface. The downward step through the layers was derived here, as the
//! upward one is.
//!
//! Everything is per unit load on the surface: pressure P0, in-plane traction T0 = −i q_L, twist
//! Q0 = q_T. At a depth, with α times the displacements,
//!
//! ```text
//! u_z = W   u_L = i V   u_T = U      σ_zz = −P   σ_Lz = −i τ   σ_Tz = −Q
//! σ_LL = −[ν P + 2G αV]/(1−ν)      σ_TT = −ν [P + 2G αV]/(1−ν)      σ_LT = i G αU
//! ```

use super::layer::{Compliance, Slab, Support};
use crate::model::body::HalfSpace;
use crate::model::material::Elastic;

/// Place of a plane: its depth, and the layer that it lies in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place {
    /// Number of the layer, from the surface down; the substrate has the number of layers.
    pub(crate) layer: usize,
    /// Depth below the top of that layer \[m\].
    pub(crate) below_top: f64,
    /// Depth below the surface \[m\].
    pub(crate) depth: f64,
    /// Material of that layer.
    pub(crate) material: Elastic,
}

impl Place {
    /// Place of the surface of `body`.
    pub(crate) fn surface(body: &HalfSpace) -> Self {
        Self { layer: 0, below_top: 0.0, depth: 0.0, material: body.surface_material() }
    }
}

/// Traction and displacement (times α) at a depth, under an in-plane load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct InPlane {
    pub(crate) p: f64,
    pub(crate) tau: f64,
    pub(crate) w: f64,
    pub(crate) v: f64,
}

impl InPlane {
    /// Lateral stresses σ_LL and σ_TT; under T0 both times i.
    pub(crate) fn lateral_stress(&self, material: Elastic) -> (f64, f64) {
        let nu = material.poisson();
        let stretch = 2.0 * material.shear() * self.v;
        (-(nu * self.p + stretch) / (1.0 - nu), -nu * (self.p + stretch) / (1.0 - nu))
    }
}

/// Fields at a depth, under unit loads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct UnitFields {
    pub(crate) pressure: InPlane,
    pub(crate) shear: InPlane,
    /// Q and αU.
    pub(crate) twist: (f64, f64),
}

impl UnitFields {
    /// Fields in a homogeneous half-space, at depth z, y = αz.
    ///
    /// ```text
    /// P = (P0 + s y) e^{−y}   τ = (T0 − s y) e^{−y}   Q = Q0 e^{−y}   U = Q/(Gα)      s = P0 + T0
    /// W = [P0 + (1−2ν+y) s] e^{−y}/2Gα      V = [(1−2ν−y) P0 + (2−2ν−y) T0] e^{−y}/2Gα
    /// ```
    pub(crate) fn homogeneous(material: Elastic, y: f64) -> Self {
        let nu = material.poisson();
        let e = (-y).exp();
        let c = e / (2.0 * material.shear());
        let far = 1.0 - 2.0 * nu;
        Self {
            pressure: InPlane {
                p: (1.0 + y) * e,
                tau: -y * e,
                w: (1.0 + far + y) * c,
                v: (far - y) * c,
            },
            shear: InPlane {
                p: y * e,
                tau: (1.0 - y) * e,
                w: (far + y) * c,
                v: (1.0 + far - y) * c,
            },
            twist: (e, 2.0 * c),
        }
    }

    /// Fields in a homogeneous body below the tractions of each load.
    fn below(loads: &Loads, material: Elastic, y: f64) -> Self {
        let unit = Self::homogeneous(material, y);
        let combine = |[p, t]: [f64; 2]| {
            let of = |f: fn(&InPlane) -> f64| p * f(&unit.pressure) + t * f(&unit.shear);
            InPlane { p: of(|s| s.p), tau: of(|s| s.tau), w: of(|s| s.w), v: of(|s| s.v) }
        };
        Self {
            pressure: combine(loads.pressure),
            shear: combine(loads.shear),
            twist: (unit.twist.0 * loads.twist, unit.twist.1 * loads.twist),
        }
    }
}

/// Tractions (P, τ) and Q at the top of a layer, under each unit load on the surface.
#[derive(Debug, Clone, Copy)]
struct Loads {
    pressure: [f64; 2],
    shear: [f64; 2],
    twist: f64,
}

/// A half-space at one wavenumber: what is below each layer, and the traction on it.
#[derive(Debug)]
pub(crate) struct Column {
    alpha: f64,
    /// Compliance and loads at the top of each layer and of the substrate.
    tops: Vec<(Compliance, Loads)>,
    /// What is below each layer.
    supports: Vec<Support>,
}

impl Column {
    /// The column of `body` at wavenumber `alpha`.
    pub(crate) fn new(body: &HalfSpace, alpha: f64) -> Self {
        let layers = body.layers();
        let mut compliances = vec![Compliance::of_substrate(body.substrate())];
        let mut supports = Vec::with_capacity(layers.len());
        let slabs: Vec<Slab> = layers
            .iter()
            .map(|layer| Slab::new(layer.material(), alpha * layer.thickness()))
            .collect();
        for (slab, layer) in slabs.iter().zip(layers).rev() {
            let below = compliances[compliances.len() - 1];
            let support = Support::new(below, layer.interface(), alpha);
            compliances.push(slab.onto(support));
            supports.push(support);
        }
        compliances.reverse();
        supports.reverse();
        let mut loads = Loads { pressure: [1.0, 0.0], shear: [0.0, 1.0], twist: 1.0 };
        let mut tops = vec![(compliances[0], loads)];
        for ((slab, support), below) in slabs.iter().zip(&supports).zip(&compliances[1..]) {
            loads = Loads {
                pressure: slab.through(*support, loads.pressure).0,
                shear: slab.through(*support, loads.shear).0,
                twist: slab.twist_through(*support, loads.twist).0,
            };
            tops.push((*below, loads));
        }
        Self { alpha, tops, supports }
    }

    /// Fields at `place`.
    pub(crate) fn at(&self, body: &HalfSpace, place: &Place) -> UnitFields {
        let (compliance, loads) = &self.tops[place.layer];
        let Some(layer) = body.layers().get(place.layer) else {
            return UnitFields::below(loads, place.material, self.alpha * place.below_top);
        };
        if place.below_top <= 0.0 {
            return on_top(compliance, loads);
        }
        let next = self.supports[place.layer];
        let rest = layer.thickness() - place.below_top;
        let below = if rest > 0.0 {
            Support::Held(Slab::new(layer.material(), self.alpha * rest).onto(next))
        } else {
            next
        };
        let upper = Slab::new(layer.material(), self.alpha * place.below_top);
        let state = |traction| {
            let ([p, tau], [w, v]) = upper.through(below, traction);
            InPlane { p, tau, w, v }
        };
        UnitFields {
            pressure: state(loads.pressure),
            shear: state(loads.shear),
            twist: upper.twist_through(below, loads.twist),
        }
    }
}

/// Fields at the top of a body of `compliance` under `loads`.
fn on_top(compliance: &Compliance, loads: &Loads) -> UnitFields {
    let Compliance { c11, c12, c22, ct } = *compliance;
    let state =
        |[p, tau]: [f64; 2]| InPlane { p, tau, w: c11 * p + c12 * tau, v: c12 * p + c22 * tau };
    UnitFields {
        pressure: state(loads.pressure),
        shear: state(loads.shear),
        twist: (loads.twist, ct * loads.twist),
    }
}
