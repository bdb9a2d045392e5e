//! Graded coatings: layers thin enough to stand for properties that vary with depth. The choice of
//! their number is nacre's own.

use crate::body::{HalfSpace, Layer, Substrate};
use crate::error::{Error, Result, positive};
use crate::material::Elastic;
use crate::response::frequency_response;

/// Largest number of layers of a graded coating, at which the search for a number ends. Chosen by trial.
const MAX_LAYERS: usize = 4096;

/// Wavenumbers, times the thickness, at which the response is compared: wavelengths from 600 times the
/// coating's thickness to a fifth of it.
const WAVENUMBERS: [f64; 9] = [0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 8.0, 16.0, 32.0];

/// Layers, from the surface down, of a coating whose `material` depends on depth.
///
/// The coating is cut into equal layers, each of the material at its middle. Their number is
/// doubled until the frequency response on `substrate`, at wavelengths down to a fifth of the
/// `thickness`, is within the relative `tolerance` of its limit. The error falls with the second
/// power of the layers' thickness, and is estimated from the last two doublings, which must both
/// meet the tolerance: one alone may miss a jump of the properties. (A jump is better an interface:
/// grade either side of it.)
///
/// # Errors
/// Unless `thickness` is finite and above 0 and 0 < `tolerance` < 1; an error of `material`; where 4096
/// layers do not meet the tolerance.
///
/// ```
/// use nacre::{Elastic, HalfSpace, graded_layers};
/// let steel = Elastic::new(210e9, 0.3)?;
/// // From 420 GPa at the surface to the substrate's modulus.
/// let layers = graded_layers(steel, 10e-6, 1e-3, |z| Elastic::new(420e9 - 21e15 * z, 0.3))?;
/// assert!(layers.len() < 200);
/// let body = HalfSpace::new(steel, layers)?;
/// assert!(body.interfaces().last().is_some_and(|depth| (depth / 10e-6 - 1.0).abs() < 1e-12));
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn graded_layers(
    substrate: impl Into<Substrate>,
    thickness: f64,
    tolerance: f64,
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
    let substrate = substrate.into();
    let mut cut = |count: usize| -> Result<(Vec<Layer>, Vec<f64>)> {
        let each = thickness / count as f64;
        let layers = (0..count)
            .map(|k| Layer::new(material((k as f64 + 0.5) * each)?, each))
            .collect::<Result<Vec<_>>>()?;
        let body = HalfSpace::new(substrate, layers.iter().cloned())?;
        let response = WAVENUMBERS
            .iter()
            .map(|x| frequency_response(&body, x / thickness));
        Ok((layers, response.collect::<Result<_>>()?))
    };
    let (_, mut before) = cut(2)?;
    let mut agreed = false;
    let mut count = 4;
    while count <= MAX_LAYERS {
        let (layers, response) = cut(count)?;
        let change = response
            .iter()
            .zip(&before)
            .map(|(new, old)| (new / old - 1.0).abs());
        // Second order: the error is a third of the last change.
        let enough = change.fold(0.0, f64::max) / 3.0 <= tolerance;
        if enough && agreed {
            return Ok(layers);
        }
        agreed = enough;
        before = response;
        count *= 2;
    }
    Err(Error::Parameter {
        name: "tolerance",
        requirement: "large enough to be met by 4096 layers",
        value: tolerance,
    })
}
