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
//! substrate up (`layer`), which was derived here. Only sums of positive terms occur in it: the result is
//! accurate to a few units in the last place for any thickness, contrast and Poisson's ratio up to 0.5.

use std::any::Any;
use std::fmt;

use crate::error::{Error, Result, finite, not_negative, positive, require};
use crate::model::body::{HalfSpace, Layer, Substrate};
use crate::model::material::Elastic;
use crate::numerics::rounding;

mod body;
mod derivatives;
pub(crate) mod interior;
mod layer;
mod sampled;

pub use body::Body;
pub(crate) use derivatives::ResponseSlope;
pub use derivatives::{asymptote_derivatives, normal_derivatives};
pub use layer::Compliance;
pub use sampled::Sampled;

use layer::{Slab, Support};

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
    let holds = [c11, c12, c22, ct].iter().all(|c| c.is_finite());
    let requirement = "such that the response is finite: neither that small nor that large";
    require("wavenumber", wavenumber, holds, requirement)?;
    Ok(compliance)
}

/// α times the surface compliance \[1/Pa\], α > 0.
pub(crate) fn alpha_compliance(body: &HalfSpace, alpha: f64) -> Compliance {
    let below = Compliance::of_substrate(body.substrate());
    body.layers().iter().rev().fold(below, |below, layer| {
        let slab = Slab::new(layer.material(), alpha * layer.thickness());
        slab.onto(Support::new(below, layer.interface(), alpha))
    })
}

/// The material of what the lowest layer lies on; none where it is rigid or free.
pub(crate) fn substrate_material(body: &HalfSpace) -> Option<Elastic> {
    match body.substrate() {
        Substrate::Elastic(material) => Some(material),
        Substrate::Rigid | Substrate::Free => None,
    }
}

/// Limits of the normal response û_z/p̂ at both ends of the spectrum, without the local compliance.
///
/// ```text
/// û_z/p̂ → long/α + constant   (α → 0)        û_z/p̂ → short/α   (α → ∞)
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asymptotes {
    /// Limit of α û_z/p̂ for α → 0 \[1/Pa\], at least 0: that of the substrate; 0 on a rigid base, and infinite where
    /// that is free.
    pub long: f64,
    /// The next term for α → 0 \[m/Pa\]: the compression of the layers and of springs between them.
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
///
/// Springs across an interface contribute 1/k_n. Those along it hold long waves as a bond does.
pub(crate) fn asymptotes(body: &HalfSpace) -> Asymptotes {
    let layers = body.layers();
    let substrate = substrate_material(body);
    let mut constant: f64 = layers.iter().map(|layer| layer.interface().compliances()[0]).sum();
    for group in layers.split_inclusive(|layer| layer.interface().slips()) {
        let terms = group.iter().map(|layer| {
            let (g, nu) = (layer.material().shear(), layer.material().poisson());
            (layer.thickness(), g, nu)
        });
        let free = group.last().is_some_and(|layer| layer.interface().slips());
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
        long: Compliance::of_substrate(body.substrate()).c11,
        constant,
        short: Compliance::homogeneous(body.surface_material()).c11,
    }
}

/// Normal frequency response of a body: surface displacement per pressure of the same wavenumber.
///
/// [`HalfSpace`] implements it, and [`Sampled`] for values of a response. A body of another kind (an elastic foundation, a membrane, a
/// transversely isotropic half-space) needs nothing else to go through influence coefficients,
/// convolution and contact. It must be the same in all directions of the surface: û_z/p̂ depends on
/// α = √(m² + n²) alone.
///
/// # What to implement
///
/// - [`normal`](Self::normal): α û_z/p̂, accurate to rounding, since the coefficients are as accurate
///   as it is. The factor α keeps it finite for a body that is a half-space far down.
/// - [`asymptotes`](Self::asymptotes): its limits. The exact method takes them in closed form and
///   transforms what is left, which must vanish for long and for short waves, about as α^{±1/2} or
///   faster; a response that does not is refused. What is left is sampled evenly in ln α, at up to 320
///   points per unit; where that does not resolve a resonance, `CellInfluence::error` says so.
/// - [`lengths`](Self::lengths): between which wavelengths (over 2π) the response leaves one limit for the
///   other. They tell where to look, to a factor of ten or so.
/// - [`local`](Self::local): a part of u/p that does not depend on α (Winkler's springs, asperities).
///   It stays out of the other three, because its α û_z/p̂ grows without limit.
///
/// A line contact measures its displacement from a datum where `asymptotes().long` is above 0;
/// otherwise the displacement vanishes far away by itself. The conversions by inverse FFT use the
/// same limits. Stresses need the layers of a [`HalfSpace`].
///
/// # Example
///
/// Pasternak's foundation, springs of stiffness k \[Pa/m\] joined by a shear layer G \[N/m\]:
/// p = k w − G ∇²w, or û_z/p̂ = 1/(k + Gα²).
///
/// ```
/// use nacre::response::{Asymptotes, Response};
/// use nacre::{Contact, Grid, Motion, Options, Paraboloid, Setup};
///
/// #[derive(Debug)]
/// struct Pasternak {
///     k: f64,
///     g: f64,
/// }
///
/// impl Response for Pasternak {
///     fn normal(&self, alpha: f64) -> f64 {
///         alpha / (self.k + self.g * alpha * alpha)
///     }
///     fn asymptotes(&self) -> Asymptotes {
///         // α û/p̂ vanishes at both ends; long waves meet the springs alone.
///         Asymptotes { long: 0.0, constant: 1.0 / self.k, short: 0.0 }
///     }
///     fn lengths(&self) -> Option<[f64; 2]> {
///         Some([(self.g / self.k).sqrt(); 2])
///     }
/// }
///
/// let contact = Contact::plan(Pasternak { k: 1.0, g: 1.0 }, Grid::new([64, 64], [4.0, 4.0])?, Setup::default())?;
/// let ball = Paraboloid::new(10.0, 10.0)?;
/// let solution = contact.solve(&ball, &Motion::approach(0.1), &Options::default())?;
/// // Below the middle p = k δ + 2G/R.
/// assert!((solution.central_pressure() / 0.3 - 1.0).abs() < 0.01);
/// # Ok::<(), nacre::Error>(())
/// ```
pub trait Response: Any + fmt::Debug + Send + Sync {
    /// α û_z/p̂ \[1/Pa\] at wavenumber α > 0 \[1/m\], finite and at least 0, without the local
    /// compliance.
    fn normal(&self, wavenumber: f64) -> f64;

    /// Limits of [`Response::normal`] at long and at short wavelengths.
    fn asymptotes(&self) -> Asymptotes;

    /// Shortest and longest length \[m\] of the body itself, between whose inverses the response
    /// changes; `None` where [`Response::normal`] is the same at every wavenumber.
    fn lengths(&self) -> Option<[f64; 2]>;

    /// Local compliance \[m/Pa\]: displacement of a point per pressure on that point, as Winkler's
    /// springs have it. It adds to the displacement of the rest of the body. Default: 0.
    fn local(&self) -> f64 {
        0.0
    }

    /// The half-space with layers, if the body is one; stresses need it. Default: `None`.
    fn half_space(&self) -> Option<&HalfSpace> {
        None
    }
}

impl Response for HalfSpace {
    fn normal(&self, wavenumber: f64) -> f64 {
        alpha_compliance(self, wavenumber).c11
    }

    fn asymptotes(&self) -> Asymptotes {
        asymptotes(self)
    }

    /// Long waves see springs of stiffness k as a bond beyond E/k, or the longest of their plates' own lengths, which lies
    /// between that and the thickness h: √(hE/k) for shear, ⁴√(h³E/k) for bending.
    fn lengths(&self) -> Option<[f64; 2]> {
        let top = self.layers().first()?.thickness();
        let softest = (self.layers().iter())
            .flat_map(|layer| layer.interface().compliances())
            .fold(0.0, f64::max);
        let materials = self.layers().iter().map(Layer::material).chain(substrate_material(self));
        let stiffest =
            materials.map(|material| material.plane_strain_modulus()).fold(0.0, f64::max);
        Some([top, self.thickness().max(softest * stiffest)])
    }

    fn half_space(&self) -> Option<&HalfSpace> {
        Some(self)
    }
}

/// Refuses a plate with a free base; `what` names the bodies of what is computed.
pub(crate) fn refuse_free(body: &dyn Response, what: &'static str) -> Result<()> {
    match is_free(body) {
        true => Err(Error::FreeBase { what }),
        false => Ok(()),
    }
}

/// Whether the body is a plate with a free base.
pub(crate) fn is_free(body: &dyn Response) -> bool {
    body.half_space().is_some_and(|body| body.substrate() == Substrate::Free)
}

/// Checks what a response says of itself, where that costs little.
///
/// # Errors
/// Limits that are not finite or below 0, lengths that are not above 0 or out of order, a local
/// compliance below 0; limits that differ where there are no lengths.
pub(crate) fn check(body: &dyn Response) -> Result<()> {
    let Asymptotes { long, constant, short } = body.asymptotes();
    if !is_free(body) {
        not_negative("asymptotes().long", long)?;
    }
    not_negative("asymptotes().short", short)?;
    finite("asymptotes().constant", constant)?;
    not_negative("local()", body.local())?;
    let Some([shortest, longest]) = body.lengths() else {
        // Not `==`, which the lints keep for bits.
        if (long - short).abs() > 0.0 || constant.abs() > 0.0 {
            return Err(Error::Inconsistent(
                "lengths() must be given for a body whose asymptotes() differ or have a constant",
            ));
        }
        return Ok(());
    };
    positive("lengths()[0]", shortest)?;
    let ordered = longest >= shortest && longest.is_finite();
    require("lengths()[1]", longest, ordered, "finite and at least lengths()[0]")?;
    not_negative("normal(1 / lengths()[0])", body.normal(1.0 / shortest))?;
    not_negative("normal(1 / lengths()[1])", body.normal(1.0 / longest))?;
    Ok(())
}

/// Size of α û_z/p̂ \[1/Pa\] without its sign: the larger of its limits; where both are 0, the largest value at octaves
/// between the body's lengths.
pub(crate) fn size(body: &dyn Response) -> f64 {
    let limits = body.asymptotes();
    let larger = limits.short.abs().max(limits.long.abs());
    match body.lengths() {
        Some([shortest, longest]) if larger <= 0.0 => {
            let octaves = rounding::ceil((longest / shortest).log2()) as i32;
            (0..=octaves)
                .map(|octave| body.normal(f64::from(octave).exp2() / longest).abs())
                .fold(0.0, f64::max)
        }
        _ => larger,
    }
}
