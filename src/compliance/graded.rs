//! Graded coatings: layers thin enough to stand for properties that vary with depth. The method is
//! nacre's own.

use crate::compliance::response::frequency_response;
use crate::error::{Error, Result, positive};
use crate::model::body::{HalfSpace, Layer, Substrate};
use crate::model::material::Elastic;

mod search;

use search::Samples;

/// Largest number of layers of a graded coating, at which the search for a number ends. Chosen by trial.
const MAX_LAYERS: usize = 4096;

/// Wavenumbers, times the thickness, at which the response is compared: wavelengths from 600 times the
/// coating's thickness to a fifth of it.
const WAVENUMBERS: [f64; 9] = [0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 8.0, 16.0, 32.0];

/// Layers, from the surface down, of a coating whose `material` depends on depth.
///
/// First the material is searched: it is evaluated at two thousand depths, and wherever two neighbours
/// differ, the interval is bisected. Jumps are located to rounding and steep parts are set apart, so that
/// the coating becomes sections without either. Each section is then cut into equal layers, each of the
/// material at its middle. Their number is doubled until the frequency response on `substrate`, at
/// wavelengths down to a fifth of the `thickness`, is within the relative `tolerance` of its limit. The
/// error falls with the second power of the layers' thickness. It is estimated from the last two
/// doublings, which must both meet the tolerance, and from the mean material that the search found in each
/// layer, which must not change the response by more.
///
/// No number of samples shows what lies between them: a feature that is thinner than a thousandth of the
/// `thickness` may be missed. `breakpoints` \[m\] are depths, in any order, where the caller knows of a
/// jump or of a thin feature. A section begins at each, and its neighbourhood is searched down to a
/// trillionth of the thickness.
///
/// # Errors
/// Unless `thickness` is finite and above 0, 0 < `tolerance` < 1 and the breakpoints lie inside the
/// coating; an error of `material`; where the material varies at every scale, so that its jumps cannot be
/// counted; where 4096 layers do not meet the tolerance.
///
/// ```
/// use nacre::{Elastic, HalfSpace, graded_layers};
/// let steel = Elastic::new(210e9, 0.3)?;
/// // From 420 GPa at the surface to the substrate's modulus.
/// let layers = graded_layers(steel, 10e-6, 1e-3, &[], |z| Elastic::new(420e9 - 21e15 * z, 0.3))?;
/// assert!(layers.len() < 200);
/// let body = HalfSpace::new(steel, layers)?;
/// assert!(body.interfaces().last().is_some_and(|depth| (depth / 10e-6 - 1.0).abs() < 1e-12));
///
/// // A soft adhesive of 20 nm, which only the caller can know of.
/// let glued = |z: f64| Elastic::new(if (z - 5e-6).abs() < 10e-9 { 1e9 } else { 210e9 }, 0.3);
/// let layers = graded_layers(steel, 10e-6, 1e-3, &[5e-6], glued)?;
/// assert_eq!(layers.len(), 3);
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn graded_layers(
    substrate: impl Into<Substrate>,
    thickness: f64,
    tolerance: f64,
    breakpoints: &[f64],
    mut material: impl FnMut(f64) -> Result<Elastic>,
) -> Result<Vec<Layer>> {
    positive("thickness", thickness)?;
    if !(tolerance > 0.0 && tolerance < 1.0) {
        return Err(Error::Parameter {
            name: "tolerance",
            requirement: "above 0 and below 1",
            value: tolerance,
        });
    }
    if let Some(&value) = breakpoints.iter().find(|z| !(**z > 0.0 && **z < thickness)) {
        return Err(Error::Parameter {
            name: "breakpoints",
            requirement: "above 0 and below the thickness",
            value,
        });
    }
    let substrate = substrate.into();
    let samples = Samples::of(thickness, tolerance, breakpoints, &mut material)?;
    let respond = |layers: &[Layer]| -> Result<Vec<f64>> {
        let body = HalfSpace::new(substrate, layers.iter().cloned())?;
        let response = WAVENUMBERS.iter().map(|x| frequency_response(&body, x / thickness));
        response.collect()
    };
    let mut before: Option<Vec<f64>> = None;
    let mut agreed = false;
    let mut count = 2;
    while count <= MAX_LAYERS {
        let layers = cut(&samples, count, &mut material)?;
        if layers.len() > MAX_LAYERS {
            break;
        }
        let response = respond(&layers)?;
        // Second order: the error is a third of the last change.
        let enough =
            before.as_ref().is_some_and(|before| change(&response, before) / 3.0 <= tolerance);
        if enough && agreed {
            let mean = samples.mean_layers(&layers)?;
            if change(&respond(&mean)?, &response) <= tolerance {
                return merged(layers);
            }
        }
        agreed = enough;
        before = Some(response);
        count *= 2;
    }
    Err(Error::Parameter {
        name: "tolerance",
        requirement: "large enough to be met by 4096 layers",
        value: tolerance,
    })
}

/// Largest relative change of a response.
fn change(new: &[f64], old: &[f64]) -> f64 {
    let changes = new.iter().zip(old).map(|(new, old)| (new / old - 1.0).abs());
    changes.fold(0.0, f64::max)
}

/// Layers of the material at their middle, `count` in each section that is not uniform.
fn cut(
    samples: &Samples,
    count: usize,
    material: &mut impl FnMut(f64) -> Result<Elastic>,
) -> Result<Vec<Layer>> {
    let mut layers = Vec::new();
    for section in samples.sections() {
        let count = if section.uniform { 1 } else { count };
        let each = (section.to - section.from) / count as f64;
        for k in 0..count {
            let middle = section.from + (k as f64 + 0.5) * each;
            layers.push(Layer::new(material(middle)?, each)?);
        }
    }
    Ok(layers)
}

/// Layers without those that have the material of the layer above.
fn merged(layers: Vec<Layer>) -> Result<Vec<Layer>> {
    let mut kept: Vec<Layer> = Vec::new();
    for layer in layers {
        match kept.last_mut() {
            Some(last) if last.material() == layer.material() => {
                *last = Layer::new(layer.material(), last.thickness() + layer.thickness())?;
            }
            _ => kept.push(layer),
        }
    }
    Ok(kept)
}
