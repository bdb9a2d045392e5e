//! Layered half-spaces: a substrate and the layers on it.

use crate::error::{Error, Result, finite, positive, refuse_if, require};
use crate::model::material::Elastic;

/// The kind of interface between a layer and the layer or substrate below it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Interface {
    /// Displacements and tractions are continuous.
    #[default]
    Bonded,
    /// The two sides slip without shear traction and never separate.
    Frictionless,
}

/// One layer of uniform thickness, and the interface **below** it.
///
/// ```
/// use nacre::{Elastic, Layer};
/// let coating = Layer::new(Elastic::new(420e9, 0.3)?, 2e-6)?.with_name("DLC")?;
/// assert_eq!(coating.name(), Some("DLC"));
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    material: Elastic,
    thickness: f64,
    interface: Interface,
    name: Option<String>,
}

impl Layer {
    /// A layer of `material`, bonded to the layer or substrate below it.
    ///
    /// # Errors
    /// Unless `thickness` \[m\] is finite and above 0.
    pub fn new(material: Elastic, thickness: f64) -> Result<Self> {
        positive("thickness", thickness)?;
        Ok(Self { material, thickness, interface: Interface::Bonded, name: None })
    }

    /// This layer with `interface` below it.
    pub fn with_interface(self, interface: Interface) -> Self {
        Self { interface, ..self }
    }

    /// This layer with a name, which results and messages show.
    ///
    /// # Errors
    /// For an empty text, one of several lines, a number (by which layers are counted) and "substrate".
    pub fn with_name(self, name: impl Into<String>) -> Result<Self> {
        let name = name.into();
        // An empty text has digits only, too.
        let counted = name.trim().bytes().all(|byte| byte.is_ascii_digit());
        if counted || name == "substrate" || name.contains(char::is_control) {
            return Err(Error::Choice {
                name: "name",
                requirement: "a text on one line, other than a number and \"substrate\"",
                value: name,
            });
        }
        Ok(Self { name: Some(name), ..self })
    }

    /// Material of the layer.
    pub fn material(&self) -> Elastic {
        self.material
    }

    /// Thickness of the layer \[m\].
    pub fn thickness(&self) -> f64 {
        self.thickness
    }

    /// Interface below the layer.
    pub fn interface(&self) -> Interface {
        self.interface
    }

    /// Name of the layer, if it has one.
    pub fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }
}

/// The body below all layers.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Substrate {
    /// An elastic half-space.
    Elastic(Elastic),
    /// A rigid base.
    Rigid,
}

impl From<Elastic> for Substrate {
    fn from(material: Elastic) -> Self {
        Self::Elastic(material)
    }
}

/// A half-space: a substrate with layers on it, which may end along x.
///
/// ```
/// use nacre::{Elastic, HalfSpace, Layer};
///
/// let steel = Elastic::new(210e9, 0.3)?;
/// let dlc = Elastic::new(420e9, 0.3)?;
/// let body = HalfSpace::new(steel, [Layer::new(dlc, 2e-6)?])?;
/// assert_eq!(body.interfaces(), [2e-6]);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct HalfSpace {
    substrate: Substrate,
    layers: Vec<Layer>,
    ends: [Option<f64>; 2],
}

impl HalfSpace {
    /// A half-space of `layers`, from the surface down, on `substrate`.
    ///
    /// # Errors
    /// Where the substrate is rigid and there is no layer. A rigid counterbody is `None`.
    pub fn new(
        substrate: impl Into<Substrate>,
        layers: impl IntoIterator<Item = Layer>,
    ) -> Result<Self> {
        let substrate = substrate.into();
        let layers: Vec<Layer> = layers.into_iter().collect();
        refuse_if(
            layers.is_empty() && substrate == Substrate::Rigid,
            "layers must hold at least one layer where the substrate is rigid",
        )?;
        Ok(Self { substrate, layers, ends: [None; 2] })
    }

    /// This body with free ends at these coordinates x \[m\]: it is cut off there, across the axis of a roller,
    /// and nothing holds the end face. `None` where the body extends further.
    ///
    /// Contacts count both ends ([`crate::compliance::ends`]), and stresses do but for those of friction; frequency response and
    /// influence coefficients are those of the body without ends.
    ///
    /// ```
    /// use nacre::{Elastic, HalfSpace};
    /// // The material of a roller of 10 mm.
    /// let roller = HalfSpace::from(Elastic::new(210e9, 0.3)?).with_ends([Some(-5e-3), Some(5e-3)])?;
    /// assert_eq!(roller.ends(), [Some(-5e-3), Some(5e-3)]);
    /// # Ok::<(), nacre::Error>(())
    /// ```
    ///
    /// # Errors
    /// Unless the coordinates are finite and the first is below the second; where the substrate is rigid.
    pub fn with_ends(self, ends: [Option<f64>; 2]) -> Result<Self> {
        for end in ends.into_iter().flatten() {
            finite("ends", end)?;
        }
        if let [Some(low), Some(high)] = ends {
            let requirement = "in ascending order: the body lies between them";
            require("ends", high, low < high, requirement)?;
        }
        refuse_if(
            ends != [None; 2] && self.substrate == Substrate::Rigid,
            "ends must not be given for a body on a rigid substrate: its face is not free there",
        )?;
        Ok(Self { ends: ends.map(|end| end.map(|x| x + 0.0)), ..self })
    }

    /// Coordinates x \[m\] of the free ends; `None` where the body extends further.
    pub fn ends(&self) -> [Option<f64>; 2] {
        self.ends
    }

    /// The substrate below the layers.
    pub fn substrate(&self) -> Substrate {
        self.substrate
    }

    /// The layers, from the surface down.
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// Depths of the interfaces \[m\], from the surface down.
    pub fn interfaces(&self) -> Vec<f64> {
        let mut depth = 0.0;
        self.layers
            .iter()
            .map(|layer| {
                depth += layer.thickness();
                depth
            })
            .collect()
    }

    /// Total thickness of the layers \[m\].
    pub fn thickness(&self) -> f64 {
        self.layers.iter().map(Layer::thickness).sum()
    }

    /// Material at the surface, which is that of the top layer or, without layers, of the substrate.
    pub fn surface_material(&self) -> Elastic {
        match (self.layers.first(), self.substrate) {
            (Some(layer), _) => layer.material(),
            (None, Substrate::Elastic(material)) => material,
            (None, Substrate::Rigid) => unreachable!("the constructor asks for a layer"),
        }
    }
}

impl From<Elastic> for HalfSpace {
    fn from(material: Elastic) -> Self {
        Self { substrate: material.into(), layers: Vec::new(), ends: [None; 2] }
    }
}

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
        let (place, inner) = match layer < body.layers().len() {
            true => (format!("layers[{layer}]"), ".material"),
            false => ("substrate".to_owned(), ""),
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
        use BodyParameter::{Poisson, Thickness, Young};
        let layers = self.layers.len();
        let of_layers = (0..layers).flat_map(|k| [Young(k), Poisson(k), Thickness(k)]);
        let of_substrate = match self.substrate {
            Substrate::Elastic(_) => vec![Young(layers), Poisson(layers)],
            Substrate::Rigid => vec![],
        };
        of_layers.chain(of_substrate).collect()
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
        let known = |place| self.material(place).ok_or(ABSENT);
        let (place, material) = match parameter {
            BodyParameter::Thickness(place) => {
                let layer = body.layers.get_mut(place).ok_or(ABSENT)?;
                layer.thickness = Layer::new(layer.material, value)?.thickness;
                return Ok(body);
            }
            BodyParameter::Young(place) => (place, Elastic::new(value, known(place)?.poisson())?),
            BodyParameter::Poisson(place) => (place, Elastic::new(known(place)?.young(), value)?),
        };
        match body.layers.get_mut(place) {
            Some(layer) => layer.material = material,
            None => body.substrate = Substrate::Elastic(material),
        }
        Ok(body)
    }

    /// Material of a layer, or of the substrate, which has the number of layers.
    pub(crate) fn material(&self, place: usize) -> Option<Elastic> {
        match (self.layers.get(place), self.substrate) {
            (Some(layer), _) => Some(layer.material),
            (None, Substrate::Elastic(material)) if place == self.layers.len() => Some(material),
            _ => None,
        }
    }
}
