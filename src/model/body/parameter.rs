//! The numbers of a half-space, by name.

use super::{HalfSpace, Layer, Substrate};
use crate::error::{Error, Result};
use crate::model::material::Elastic;

/// One number of a half-space; layers are counted from the surface down.
///
/// ```
/// use nacre::{BodyParameter, Elastic, HalfSpace, Layer};
///
/// let steel = Elastic::new(210e9, 0.3)?;
/// let body = HalfSpace::new(steel, [Layer::new(Elastic::new(420e9, 0.2)?, 2e-6)?])?;
/// let names: Vec<String> = body.parameters().iter().map(|one| one.path(&body)).collect();
/// assert_eq!(names[..2], ["layers[0].material.young", "layers[0].material.poisson"]);
/// assert_eq!(names[2..], ["layers[0].thickness", "substrate.young", "substrate.poisson"]);
/// assert_eq!(body.value(BodyParameter::Thickness(0)), Some(2e-6));
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BodyParameter {
    /// Young's modulus of this layer; the number of layers stands for the substrate.
    Young(usize),
    /// Poisson's ratio of this layer, at fixed Young's modulus; the number of layers stands for the substrate.
    Poisson(usize),
    /// Thickness of this layer.
    Thickness(usize),
}

impl BodyParameter {
    /// The name in case files below the body's: `layers[0].thickness`, `substrate.young`.
    pub fn path(&self, body: &HalfSpace) -> String {
        let (Self::Young(layer) | Self::Poisson(layer) | Self::Thickness(layer)) = *self;
        let place = if layer < body.layers().len() {
            format!("layers[{layer}]")
        } else {
            "substrate".to_owned()
        };
        let inner = if layer < body.layers().len() {
            ".material"
        } else {
            ""
        };
        match self {
            Self::Young(_) => format!("{place}{inner}.young"),
            Self::Poisson(_) => format!("{place}{inner}.poisson"),
            Self::Thickness(_) => format!("{place}.thickness"),
        }
    }
}

impl HalfSpace {
    /// All numbers of the body: Young's modulus, Poisson's ratio and thickness of each layer, then Young's modulus and
    /// Poisson's ratio of the substrate, unless that is rigid.
    pub fn parameters(&self) -> Vec<BodyParameter> {
        let layers = self.layers.len();
        let mut parameters = Vec::with_capacity(3 * layers + 2);
        for layer in 0..layers {
            parameters.push(BodyParameter::Young(layer));
            parameters.push(BodyParameter::Poisson(layer));
            parameters.push(BodyParameter::Thickness(layer));
        }
        if matches!(self.substrate, Substrate::Elastic(_)) {
            parameters.push(BodyParameter::Young(layers));
            parameters.push(BodyParameter::Poisson(layers));
        }
        parameters
    }

    /// Value of a parameter; `None` for one that the body does not have.
    pub fn value(&self, parameter: BodyParameter) -> Option<f64> {
        match parameter {
            BodyParameter::Young(place) => self.material(place).map(|material| material.young()),
            BodyParameter::Poisson(place) => {
                self.material(place).map(|material| material.poisson())
            }
            BodyParameter::Thickness(place) => self.layers.get(place).map(Layer::thickness),
        }
    }

    /// This body with another value of a parameter.
    ///
    /// # Errors
    /// A parameter that the body does not have, and a value that it cannot have.
    pub fn with_value(&self, parameter: BodyParameter, value: f64) -> Result<Self> {
        const ABSENT: Error = Error::Inconsistent(
            "parameter must be one that the body has, as parameters() lists them",
        );
        let mut body = self.clone();
        let (place, material) = match parameter {
            BodyParameter::Thickness(place) => {
                let layer = body.layers.get_mut(place).ok_or(ABSENT)?;
                layer.thickness = Layer::new(layer.material, value)?.thickness;
                return Ok(body);
            }
            BodyParameter::Young(place) => {
                let material = self.material(place).ok_or(ABSENT)?;
                (place, Elastic::new(value, material.poisson())?)
            }
            BodyParameter::Poisson(place) => {
                let material = self.material(place).ok_or(ABSENT)?;
                (place, Elastic::new(material.young(), value)?)
            }
        };
        match body.layers.get_mut(place) {
            Some(layer) => layer.material = material,
            None => body.substrate = Substrate::Elastic(material),
        }
        Ok(body)
    }

    /// Material of a layer, or of the substrate, which has the number of layers.
    fn material(&self, place: usize) -> Option<Elastic> {
        match (self.layers.get(place), self.substrate) {
            (Some(layer), _) => Some(layer.material),
            (None, Substrate::Elastic(material)) if place == self.layers.len() => Some(material),
            _ => None,
        }
    }
}
