//! Derivatives of the normal response of a half-space with respect to its numbers. The formulas were derived here.
//!
//! The recursion of [`response`](crate::compliance::response) makes α c11 = tᵀ C t of tractions t that a unit pressure on the
//! surface sends down. A change of the body changes it by the energies of the states that it has anyway (reciprocity),
//! with t the traction on top of a layer, u the displacement of its bottom times α, and C what lies below:
//!
//! ```text
//! ∂(α c11) = Σ_layers [tᵀ ∂H11 t + 2 tᵀ ∂H12 u − uᵀ ∂H22 u] + t_sᵀ ∂C_s t_s
//! ```
//!
//! One step up and one down serve all parameters. Young's modulus scales H11 by 1/E and H22 by E:
//! −(tᵀ H11 t + uᵀ H22 u)/E, a sum of positive terms. A thicker layer is one into which a thin slab was put at its
//! bottom: with D = C − C_∞, where C_∞ is the half-space of the layer's own material, and v the traction there,
//!
//! ```text
//! ∂(α c11)/∂h = α vᵀ R v     R = A D + D Aᵀ − D diag(0, 2G/η) D     A = ((0, −1), (1, −2))     η = 1 − ν
//! ```
//!
//! which is 0 for a layer like what it lies on. Springs of stiffness k below a layer add α/k to C: with the traction t
//! that they carry, −α (t/k)² is the derivative with respect to k.

use super::layer::{Compliance, Slab, Support, of_energy};
use super::{Asymptotes, Response, substrate_material};
use crate::model::body::{BodyParameter, HalfSpace, Layer};
use crate::model::material::Elastic;

/// Derivative of a half-space's response with respect to one of its numbers, as a response that influence coefficients
/// are made of. It has the limits that derivatives have, which may be negative.
#[derive(Debug, Clone)]
pub(crate) struct ResponseSlope {
    body: HalfSpace,
    parameter: BodyParameter,
    limits: Asymptotes,
}

impl ResponseSlope {
    pub(crate) fn new(body: &HalfSpace, parameter: BodyParameter) -> Self {
        Self { body: body.clone(), parameter, limits: asymptote_derivatives(body, &[parameter])[0] }
    }

    /// The derivative of another `body` with respect to the same number.
    pub(crate) fn of(&self, body: &HalfSpace) -> Self {
        Self::new(body, self.parameter)
    }
}

impl Response for ResponseSlope {
    fn normal(&self, wavenumber: f64) -> f64 {
        let mut slope = [0.0];
        normal_derivatives(&self.body, &[self.parameter], wavenumber, &mut slope);
        slope[0]
    }

    fn asymptotes(&self) -> Asymptotes {
        self.limits
    }

    fn lengths(&self) -> Option<[f64; 2]> {
        self.body.lengths()
    }

    fn half_space(&self) -> Option<&HalfSpace> {
        Some(&self.body)
    }
}

/// State of one layer under a unit pressure on the surface.
struct LayerState {
    slab: Slab,
    /// What lies below.
    below: Support,
    /// Traction on top.
    top: [f64; 2],
    /// Traction at the bottom.
    bottom: [f64; 2],
    /// α times the displacement of the layer's side of the bottom.
    displacement: [f64; 2],
}

/// α û_z/p̂ \[1/Pa\] at wavenumber `alpha` > 0 \[1/m\], and its derivative with respect to each of `parameters`, into
/// `out`; 0 for a parameter that the body does not have. Derivatives are per unit of the parameter itself (Pa, 1, m);
/// those with respect to Poisson's ratio are at fixed Young's modulus.
///
/// # Panics
/// Unless `out` has as many places as `parameters`.
///
/// ```
/// use nacre::response::normal_derivatives;
/// use nacre::{BodyParameter, Elastic, HalfSpace};
///
/// let steel = HalfSpace::from(Elastic::new(210e9, 0.3)?);
/// let mut slope = [0.0];
/// // α c11 = 2 (1 − ν²)/E
/// let value = normal_derivatives(&steel, &[BodyParameter::Young(0)], 1e3, &mut slope);
/// assert!((slope[0] * 210e9 / value + 1.0).abs() < 1e-15);
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn normal_derivatives(
    body: &HalfSpace,
    parameters: &[BodyParameter],
    alpha: f64,
    out: &mut [f64],
) -> f64 {
    assert_eq!(parameters.len(), out.len(), "a place for each parameter");
    let layers = body.layers();
    let mut compliance = Compliance::of_substrate(body.substrate());
    let mut states: Vec<LayerState> = Vec::with_capacity(layers.len());
    for layer in layers.iter().rev() {
        let slab = Slab::new(layer.material(), alpha * layer.thickness());
        let below = Support::new(compliance, layer.interface(), alpha);
        compliance = slab.onto(below);
        states.push(LayerState {
            slab,
            below,
            top: [0.0; 2],
            bottom: [0.0; 2],
            displacement: [0.0; 2],
        });
    }
    states.reverse();
    let mut traction = [1.0, 0.0];
    for state in &mut states {
        state.top = traction;
        (state.bottom, state.displacement) = state.slab.through(state.below, traction);
        traction = state.bottom;
    }
    for (parameter, out) in parameters.iter().zip(out) {
        let place = parameter.layer();
        *out = match (layers.get(place), substrate_material(body)) {
            (Some(layer), _) => {
                let value = body.value(*parameter).unwrap_or(0.0);
                of_layer(*parameter, value, layer, &states[place], alpha)
            }
            (None, Some(material)) if place == layers.len() => {
                of_substrate(*parameter, material, traction)
            }
            _ => 0.0,
        };
    }
    compliance.c11
}

/// Derivative with respect to a number of `layer`, which has this `value`; 0 for springs that it does not have.
fn of_layer(
    parameter: BodyParameter,
    value: f64,
    layer: &Layer,
    state: &LayerState,
    alpha: f64,
) -> f64 {
    let material = layer.material();
    let spring = |traction: f64| match value > 0.0 {
        true => -alpha * (traction / value).powi(2),
        false => 0.0,
    };
    let stretch = || -state.slab.energy(state.top, state.displacement);
    match parameter {
        BodyParameter::Young(_) => stretch() / material.young(),
        BodyParameter::Poisson(_) => {
            let x = alpha * layer.thickness();
            let fixed = of_energy(material, x, state.top, state.displacement);
            // G = E/2(1+ν) falls by G/(1+ν) per unit of ν.
            fixed - stretch() / (1.0 + material.poisson())
        }
        BodyParameter::Thickness(_) => alpha * thickening(material, state),
        BodyParameter::NormalStiffness(_) => spring(state.bottom[0]),
        BodyParameter::TangentialStiffness(_) => spring(state.bottom[1]),
    }
}

/// vᵀ R v, the derivative per α times thickness. Where the layer slips or is free, and C has no inverse, it is the same
/// form in tractions and displacements:
///
/// ```text
/// P² ε/2Gη − 2 (ν/η) P V − (2G/η) V²      ε = 1 − 2ν
/// ```
fn thickening(material: Elastic, state: &LayerState) -> f64 {
    let (g, nu) = (material.shear(), material.poisson());
    let eta = 1.0 - nu;
    let [p, tau] = state.bottom;
    match state.below {
        Support::Held(below) => {
            let far = Compliance::homogeneous(material);
            let d11 = below.c11 - far.c11;
            let d12 = below.c12 - far.c12;
            let d22 = below.c22 - far.c22;
            let stiff = 2.0 * g / eta;
            let r11 = -d12 * (2.0 + stiff * d12);
            let r12 = d11 - d22 - d12 * (2.0 + stiff * d22);
            let r22 = 2.0 * d12 - d22 * (4.0 + stiff * d22);
            p * p * r11 + 2.0 * p * tau * r12 + tau * tau * r22
        }
        Support::Slips(_) | Support::Free => {
            let [_, v] = state.displacement;
            (p * p * (1.0 - 2.0 * nu) / (2.0 * g) - 2.0 * v * (nu * p + g * v)) / eta
        }
    }
}

/// Derivative with respect to a number of the substrate, under `traction`.
///
/// ```text
/// α c11 = α c22 = 2 (1 − ν²)/E      α c12 = (1 + ν)(1 − 2ν)/E
/// ```
fn of_substrate(parameter: BodyParameter, material: Elastic, [p, tau]: [f64; 2]) -> f64 {
    let (e, nu) = (material.young(), material.poisson());
    let form = |direct: f64, across: f64| (p * p + tau * tau) * direct + 2.0 * p * tau * across;
    match parameter {
        BodyParameter::Young(_) => {
            let Compliance { c11, c12, .. } = Compliance::homogeneous(material);
            -form(c11, c12) / e
        }
        BodyParameter::Poisson(_) => form(-4.0 * nu, -1.0 - 4.0 * nu) / e,
        _ => 0.0,
    }
}

/// Derivatives of the limits of the response (see [`Asymptotes`]) with respect to each of `parameters`.
///
/// ```
/// use nacre::response::asymptote_derivatives;
/// use nacre::{BodyParameter, Elastic, HalfSpace};
///
/// let steel = HalfSpace::from(Elastic::new(2.0, 0.25)?);
/// let slope = asymptote_derivatives(&steel, &[BodyParameter::Poisson(0)])[0];
/// // 2 (1 − ν²)/E
/// assert_eq!((slope.long, slope.constant, slope.short), (-0.5, 0.0, -0.5));
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn asymptote_derivatives(body: &HalfSpace, parameters: &[BodyParameter]) -> Vec<Asymptotes> {
    let layers = body.layers().len();
    let homogeneous = |parameter: BodyParameter, place: usize, material: Elastic| {
        let (e, nu) = (material.young(), material.poisson());
        match parameter {
            BodyParameter::Young(one) if one == place => -Compliance::homogeneous(material).c11 / e,
            BodyParameter::Poisson(one) if one == place => -4.0 * nu / e,
            _ => 0.0,
        }
    };
    let of = |&parameter: &BodyParameter| Asymptotes {
        long: substrate_material(body)
            .map_or(0.0, |material| homogeneous(parameter, layers, material)),
        constant: compression(body, parameter),
        short: homogeneous(parameter, 0, body.surface_material()),
    };
    parameters.iter().map(of).collect()
}

/// Derivative of the compression of the layers, `constant` of [`Asymptotes`], with respect to `parameter`.
fn compression(body: &HalfSpace, parameter: BodyParameter) -> f64 {
    let layers = body.layers();
    let place = parameter.layer();
    let substrate = substrate_material(body);
    match parameter {
        BodyParameter::NormalStiffness(_) => {
            let stiffness = body.value(parameter).filter(|k| *k > 0.0);
            return stiffness.map_or(0.0, |k| -1.0 / (k * k));
        }
        BodyParameter::TangentialStiffness(_) => return 0.0,
        BodyParameter::Young(_) | BodyParameter::Poisson(_) | BodyParameter::Thickness(_) => {}
    }
    let loose = layers.iter().rposition(|layer| layer.interface().slips());
    let first_bonded = loose.map_or(0, |last| last + 1);
    if place >= layers.len() {
        let bonded = layers[first_bonded..].iter();
        return match substrate {
            Some(material) if place == layers.len() => {
                bonded.map(|layer| held_by(layer, material, parameter)).sum()
            }
            _ => 0.0,
        };
    }
    if place >= first_bonded {
        return held_layer(&layers[place], substrate, parameter);
    }
    let starts = layers[..place]
        .iter()
        .rposition(|layer| layer.interface().slips())
        .map_or(0, |last| last + 1);
    let ends = place
        + layers[place..]
            .iter()
            .position(|layer| layer.interface().slips())
            .map_or(0, |more| more + 1);
    free_layer(&layers[starts..ends], &layers[place], parameter)
}

/// g = (1−2ν_s) G/G_s of a layer that follows the surface of `substrate`; 0 on a rigid base.
fn strain(layer: &Layer, substrate: Option<Elastic>) -> f64 {
    let g = layer.material().shear();
    substrate.map_or(0.0, |s| (1.0 - 2.0 * s.poisson()) * g / s.shear())
}

/// Derivative of h (1+ν)/(E (1−ν)) · f with f = (1+g)(1−2ν−g), with respect to the layer's own numbers.
fn held_layer(layer: &Layer, substrate: Option<Elastic>, parameter: BodyParameter) -> f64 {
    let (e, nu) = (layer.material().young(), layer.material().poisson());
    let (h, g) = (layer.thickness(), strain(layer, substrate));
    let f = (1.0 + g) * (1.0 - 2.0 * nu - g);
    let per_g = -2.0 * (nu + g);
    let factor = (1.0 + nu) / (e * (1.0 - nu));
    match parameter {
        BodyParameter::Thickness(_) => factor * f,
        // g grows with E.
        BodyParameter::Young(_) => h * factor * (per_g * g - f) / e,
        BodyParameter::Poisson(_) => {
            let steeper = 2.0 * f / (e * (1.0 - nu) * (1.0 - nu));
            h * (steeper - factor * (2.0 * (1.0 + g) + per_g * g / (1.0 + nu)))
        }
        BodyParameter::NormalStiffness(_) | BodyParameter::TangentialStiffness(_) => 0.0,
    }
}

/// Derivative of one layer's share with respect to a number of the `substrate` that it follows, through g.
fn held_by(layer: &Layer, substrate: Elastic, parameter: BodyParameter) -> f64 {
    let (e, nu) = (layer.material().young(), layer.material().poisson());
    let (es, nus) = (substrate.young(), substrate.poisson());
    let g = strain(layer, Some(substrate));
    let per_g = -2.0 * (nu + g) * layer.thickness() * (1.0 + nu) / (e * (1.0 - nu));
    per_g
        * match parameter {
            BodyParameter::Young(_) => -g / es,
            BodyParameter::Poisson(_) => -(1.0 + 4.0 * nus) * e / (es * (1.0 + nu)),
            _ => 0.0,
        }
}

/// Derivative of Σ h (1+ν)(1−2ν)/(E (1−ν)) + a²/b over the layers `group` that stretch together, with respect to a
/// number of one `layer` of them; a = Σ h ν/(1−ν) and b = Σ h E/(1−ν²), whose ratio is the stretch e.
fn free_layer(group: &[Layer], layer: &Layer, parameter: BodyParameter) -> f64 {
    let (push, stiffness) = group.iter().fold((0.0, 0.0), |(push, stiffness), layer| {
        let (h, nu) = (layer.thickness(), layer.material().poisson());
        (push + h * nu / (1.0 - nu), stiffness + h * layer.material().plane_strain_modulus())
    });
    let stretch = push / stiffness;
    let (h, e, nu) = (layer.thickness(), layer.material().young(), layer.material().poisson());
    let eta = 1.0 - nu;
    let plane = 1.0 / (eta * (1.0 + nu));
    let alone = (1.0 + nu) * (1.0 - 2.0 * nu) / (e * eta);
    let [d_alone, d_push, d_stiffness] = match parameter {
        BodyParameter::Thickness(_) => [alone, nu / eta, e * plane],
        BodyParameter::Young(_) => [-h * alone / e, 0.0, h * plane],
        BodyParameter::Poisson(_) => [
            h * nu * (2.0 * nu - 4.0) / (e * eta * eta),
            h / (eta * eta),
            h * e * 2.0 * nu * plane * plane,
        ],
        BodyParameter::NormalStiffness(_) | BodyParameter::TangentialStiffness(_) => [0.0; 3],
    };
    d_alone + stretch * (2.0 * d_push - stretch * d_stiffness)
}
