//! Frequency response: surface displacement per surface traction of the same wavenumber
//! α = √(m² + n²).
//!
//! [`Response`] is what all later steps know of a body. The rest is the response of a half-space with
//! layers. In the frame of the wave vector (L along it, T across it), for pressure p and surface tractions
//! q_L, q_T that act on the body:
//!
//! ```text
//! u_z = c11 p − i c12 q_L      u_L = i c12 p + c22 q_L      u_T = ct q_T
//! ```
//!
//! All four are computed as α·c, which is finite from α = 0 to ∞, by a recursion from the
//! substrate up (`layer`), which is nacre's own. Only sums of positive terms occur in it: the result is
//! accurate to a few units in the last place for any thickness, contrast and Poisson's ratio up to 0.5.

use crate::error::{Error, Result, positive};
use crate::model::body::{HalfSpace, Interface, Substrate};

mod body;
mod derivatives;
pub(crate) mod interior;
mod layer;

pub use body::{Body, Response};
pub(crate) use body::{check, size};
pub(crate) use derivatives::ResponseSlope;
pub use derivatives::{asymptote_derivatives, normal_derivatives};
pub use layer::Compliance;

use layer::Slab;

/// Normal displacement per pressure, û_z/p̂ \[m/Pa\], at `wavenumber` α > 0 \[1/m\].
///
/// One layer has the closed form (θ = e^{−2αh}, μ = G1/G2, κ = (μ−1)/(μ+3−4ν1),
/// λ = 1 − 4(1−ν1)/(1+μ(3−4ν2)))
///
/// ```text
/// c11 = (1−ν1)/(G1 α) · [1 + 4αhκθ − λκθ²] / [1 − (λ + κ + 4κα²h²)θ + λκθ²]
/// ```
///
/// Nogi & Kato, J. Tribol. 119 (1997) 493; O'Sullivan & King, J. Tribol. 110
/// (1988) 235. The recursion that is used here equals it and keeps its digits
/// at small αh.
///
/// # Errors
/// Unless `wavenumber` is finite and above 0, and the response is a number of the machine.
///
/// ```
/// let steel = nacre::Elastic::new(210e9, 0.3)?;
/// let c11 = nacre::response::frequency_response(&steel.into(), 1e3)?;
/// assert!((c11 * 1e3 * steel.plane_strain_modulus() / 2.0 - 1.0).abs() < 1e-15);
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn frequency_response(body: &HalfSpace, wavenumber: f64) -> Result<f64> {
    Ok(surface_compliance(body, wavenumber)?.c11)
}

/// All four surface compliances \[m/Pa\] at `wavenumber` α > 0 \[1/m\].
///
/// # Errors
/// Unless `wavenumber` is finite and above 0, and the compliances are numbers of the machine.
pub fn surface_compliance(body: &HalfSpace, wavenumber: f64) -> Result<Compliance> {
    positive("wavenumber", wavenumber)?;
    let compliance = alpha_compliance(body, wavenumber).scaled(1.0 / wavenumber);
    let Compliance { c11, c12, c22, ct } = compliance;
    if [c11, c12, c22, ct].iter().all(|c| c.is_finite()) {
        return Ok(compliance);
    }
    Err(Error::Parameter {
        name: "wavenumber",
        requirement: "such that the response is finite: neither that small nor that large",
        value: wavenumber,
    })
}

/// α times the surface compliance \[1/Pa\], α > 0.
pub(crate) fn alpha_compliance(body: &HalfSpace, alpha: f64) -> Compliance {
    let below = match body.substrate() {
        Substrate::Elastic(material) => Compliance::homogeneous(material),
        Substrate::Rigid => Compliance::RIGID,
    };
    body.layers().iter().rev().fold(below, |below, layer| {
        let slab = Slab::new(layer.material(), alpha * layer.thickness());
        slab.onto(below, layer.interface())
    })
}

/// Limits of the normal response û_z/p̂ at both ends of the spectrum, without the local compliance.
///
/// ```text
/// û_z/p̂ → long/α + constant   (α → 0)        û_z/p̂ → short/α   (α → ∞)
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asymptotes {
    /// Limit of α û_z/p̂ for α → 0 \[1/Pa\], at least 0: that of the substrate; 0 on a rigid base.
    pub long: f64,
    /// The next term for α → 0 \[m/Pa\]: the compression of the layers.
    pub constant: f64,
    /// Limit of α û_z/p̂ for α → ∞ \[1/Pa\], at least 0: that of the surface material.
    pub short: f64,
}

/// Limits of the normal response of a half-space.
///
/// The constant, derived for nacre from the recursion, is the compression of the layers under a pressure that varies slowly (plane strain
/// across the wave vector). Where the layers follow the substrate's surface strain, with
/// g = (1−2ν_s) G/G_s (0 on a rigid base), each contributes
///
/// ```text
/// h (1+g)(1−2ν−g) / [2G (1−ν)]
/// ```
///
/// Layers above a frictionless interface stretch freely together, by e per unit pressure such that
/// their membrane forces cancel, Σ h [2G e − ν]/(1−ν) = 0, and each contributes
///
/// ```text
/// h [(1−2ν)/2G + ν e] / (1−ν)
/// ```
pub(crate) fn asymptotes(body: &HalfSpace) -> Asymptotes {
    let layers = body.layers();
    let substrate = match body.substrate() {
        Substrate::Elastic(material) => Some(material),
        Substrate::Rigid => None,
    };
    let mut constant = 0.0;
    for group in layers.split_inclusive(|layer| layer.interface() == Interface::Frictionless) {
        let terms = group.iter().map(|layer| {
            let (g, nu) = (layer.material().shear(), layer.material().poisson());
            (layer.thickness(), g, nu)
        });
        let free = group.last().is_some_and(|layer| layer.interface() == Interface::Frictionless);
        if free {
            let (push, stiffness) =
                terms.clone().fold((0.0, 0.0), |(push, stiffness), (h, g, nu)| {
                    (push + h * nu / (1.0 - nu), stiffness + h * 2.0 * g / (1.0 - nu))
                });
            let e = push / stiffness;
            constant += terms
                .map(|(h, g, nu)| h * ((1.0 - 2.0 * nu) / (2.0 * g) + nu * e) / (1.0 - nu))
                .sum::<f64>();
        } else {
            constant += terms
                .map(|(h, g, nu)| {
                    let strain =
                        substrate.map_or(0.0, |s| (1.0 - 2.0 * s.poisson()) * g / s.shear());
                    h * (1.0 + strain) * (1.0 - 2.0 * nu - strain) / (2.0 * g * (1.0 - nu))
                })
                .sum::<f64>();
        }
    }
    Asymptotes {
        long: substrate.map_or(0.0, |material| Compliance::homogeneous(material).c11),
        constant,
        short: Compliance::homogeneous(body.surface_material()).c11,
    }
}
