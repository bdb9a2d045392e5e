//! Layered half-spaces: a substrate and the layers on it.

use crate::error::{Error, Result, finite, not_negative, positive, refuse_if, require};
use crate::model::data::value;
use crate::model::material::Elastic;

/// The kind of interface between a layer and the layer or substrate below it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Interface {
    /// Displacements and tractions are continuous.
    #[default]
    Bonded,
    /// The two sides slip without shear traction and never separate.
    Frictionless,
    /// The two sides are joined by springs: an imperfect bond.
    Spring(Spring),
}

impl Interface {
    /// Whether nothing holds the two sides against each other along the interface.
    pub fn slips(self) -> bool {
        match self {
            Self::Bonded => false,
            Self::Frictionless => true,
            Self::Spring(spring) => spring.tangential == Some(0.0),
        }
    }

    /// Compliances \[m/Pa\] of the interface across and along it; 0 where its sides do not move apart, and along it where
    /// they slip.
    pub(crate) fn compliances(self) -> [f64; 2] {
        let of = |stiffness: Option<f64>| match stiffness {
            Some(k) if k > 0.0 => 1.0 / k,
            _ => 0.0,
        };
        match self {
            Self::Spring(spring) => [of(spring.normal), of(spring.tangential)],
            Self::Bonded | Self::Frictionless => [0.0; 2],
        }
    }
}

/// Springs between the two sides of an interface: tractions are continuous, and the displacement jumps by traction over
/// stiffness.
///
/// ```text
/// u_z⁺ − u_z⁻ = −σ_zz/k_n      u_x⁺ − u_x⁻ = −σ_xz/k_t      u_y⁺ − u_y⁻ = −σ_yz/k_t
/// ```
///
/// with ⁺ the upper side. A bond line of thickness t and moduli E, ν, G that is much thinner than its layers has
/// k_n = E (1−ν)/[(1+ν)(1−2ν) t] and k_t = G/t. Jones & Whittier, J. Appl. Mech. 34 (1967) 905.
///
/// ```
/// use nacre::{Elastic, Interface, Layer, Spring};
/// // An adhesive of 1 µm, E = 1 GPa and ν = 0.35.
/// let spring = Spring::new(Some(1.6e15), Some(3.7e14))?;
/// let coating = Layer::new(Elastic::new(420e9, 0.3)?, 2e-6)?.with_interface(Interface::Spring(spring));
/// assert!(!coating.interface().slips());
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    normal: Option<f64>,
    tangential: Option<f64>,
}

impl Spring {
    /// Springs of these stiffnesses \[Pa/m\] across and along the interface; `None` where its sides do not move apart.
    ///
    /// # Errors
    /// Unless `normal` is finite and above 0, and `tangential` finite and at least 0; 0 slips freely. Where both are
    /// `None`, which is a bonded interface.
    pub fn new(normal: Option<f64>, tangential: Option<f64>) -> Result<Self> {
        refuse_if(
            normal.is_none() && tangential.is_none(),
            "normal or tangential must be given: an interface that is rigid in both is \"bonded\"",
        )?;
        normal.map(|k| positive("normal", k)).transpose()?;
        let tangential = tangential.map(|k| not_negative("tangential", k)).transpose()?;
        // −0 is 0.
        Ok(Self { normal, tangential: tangential.map(|k| k + 0.0) })
    }

    /// Stiffness across the interface \[Pa/m\]; `None` where it is rigid.
    pub fn normal(&self) -> Option<f64> {
        self.normal
    }

    /// Stiffness along the interface \[Pa/m\]; `None` where it is rigid.
    pub fn tangential(&self) -> Option<f64> {
        self.tangential
    }
}

value! {
    Spring by SpringData {
        normal: Option<f64> = of.normal();
        tangential: Option<f64> = of.tangential();
    }
    of, fields => Self::new(fields.normal, fields.tangential)
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

value! {
    Layer by LayerData {
        material: Elastic = of.material();
        thickness: f64 = of.thickness();
        #[serde(default)]
        interface: Interface = of.interface();
        name: Option<String> = of.name().map(String::from);
    }
    of, fields => {
        let layer = Self::new(fields.material, fields.thickness)?.with_interface(fields.interface);
        match fields.name {
            Some(name) => layer.with_name(name),
            None => Ok(layer),
        }
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
    /// Nothing: the lower face of the lowest layer is free of tractions, and the body is a plate.
    ///
    /// A net load on a free plate has no equilibrium, and long waves bend it as α⁻⁴: it has a response, influence
    /// coefficients and contacts on grids that are periodic along x and along y, where a uniform pressure on the free
    /// face, as that of a fluid, balances the mean. All else is refused by [`Error::FreeBase`].
    Free,
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
    /// Where the substrate is rigid or free and there is no layer (a rigid counterbody is `None`); where the interface of
    /// the lowest layer on a free base is not bonded.
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
        refuse_if(
            layers.is_empty() && substrate == Substrate::Free,
            "layers must hold at least one layer where the base is free: the layers are the plate",
        )?;
        let lowest = layers.last().map(Layer::interface);
        refuse_if(
            substrate == Substrate::Free && lowest.is_some_and(|one| one != Interface::Bonded),
            "interface of the lowest layer must be \"bonded\" (the default) on a free base: nothing lies below it",
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
    /// Unless the coordinates are finite and the first is below the second; where the substrate is rigid or free, and
    /// where an interface is not bonded.
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
        refuse_if(
            ends != [None; 2] && self.substrate == Substrate::Free,
            "ends must not be given for a plate with a free base: what its end does is not known",
        )?;
        refuse_if(
            ends != [None; 2] && !self.is_bonded(),
            "ends must not be given for a body with an interface that slips or has springs: what its end does is not \
             known; take \"bonded\" interfaces, or no ends",
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

    /// Whether all layers are bonded to what lies below.
    pub(crate) fn is_bonded(&self) -> bool {
        self.layers.iter().all(|layer| layer.interface == Interface::Bonded)
    }

    /// Whether layers above some interface slip freely on what lies below.
    pub(crate) fn slips(&self) -> bool {
        self.layers.iter().any(|layer| layer.interface.slips())
    }

    /// This body, on a rigid base where its base is free.
    pub(crate) fn with_rigid_base(&self) -> Self {
        let substrate = match self.substrate {
            Substrate::Free => Substrate::Rigid,
            other => other,
        };
        Self { substrate, ..self.clone() }
    }

    /// Material at the surface, which is that of the top layer or, without layers, of the substrate.
    pub fn surface_material(&self) -> Elastic {
        match (self.layers.first(), self.substrate) {
            (Some(layer), _) => layer.material(),
            (None, Substrate::Elastic(material)) => material,
            (None, Substrate::Rigid | Substrate::Free) => {
                unreachable!("the constructor asks for a layer")
            }
        }
    }
}

value! {
    HalfSpace by HalfSpaceData {
        substrate: Substrate = of.substrate();
        #[serde(default)]
        layers: Vec<Layer> = of.layers().to_vec();
        #[serde(default, skip_serializing_if = "crate::model::data::is_default")]
        ends: [Option<f64>; 2] = of.ends();
    }
    of, fields => Self::new(fields.substrate, fields.layers)?.with_ends(fields.ends)
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
    /// Stiffness of the springs across the interface below this layer.
    NormalStiffness(usize),
    /// Stiffness of the springs along the interface below this layer.
    TangentialStiffness(usize),
}

impl BodyParameter {
    /// The name in case files below the body's: `layers[0].thickness`, `substrate.young`.
    pub fn path(&self, body: &HalfSpace) -> String {
        let layer = self.layer();
        let (place, inner) = match layer < body.layers().len() {
            true => (format!("layers[{layer}]"), ".material"),
            false => ("substrate".to_owned(), ""),
        };
        match self {
            Self::Young(_) => format!("{place}{inner}.young"),
            Self::Poisson(_) => format!("{place}{inner}.poisson"),
            Self::Thickness(_) => format!("{place}.thickness"),
            Self::NormalStiffness(_) => format!("{place}.interface.normal"),
            Self::TangentialStiffness(_) => format!("{place}.interface.tangential"),
        }
    }

    /// The layer that has the parameter; the number of layers stands for the substrate.
    pub fn layer(self) -> usize {
        let (Self::Young(layer)
        | Self::Poisson(layer)
        | Self::Thickness(layer)
        | Self::NormalStiffness(layer)
        | Self::TangentialStiffness(layer)) = self;
        layer
    }
}

impl HalfSpace {
    /// All numbers of the body: Young's modulus, Poisson's ratio and thickness of each layer, and the stiffnesses of the
    /// springs below it that are above 0; then Young's modulus and Poisson's ratio of the substrate, if that is elastic.
    pub fn parameters(&self) -> Vec<BodyParameter> {
        use BodyParameter::{NormalStiffness, Poisson, TangentialStiffness, Thickness, Young};
        let layers = self.layers.len();
        let mut all = Vec::new();
        for k in 0..layers {
            all.extend([Young(k), Poisson(k), Thickness(k)]);
            let springs = [NormalStiffness(k), TangentialStiffness(k)];
            // Long waves have no derivative where the sides slip freely.
            all.extend(springs.into_iter().filter(|one| self.value(*one).is_some_and(|k| k > 0.0)));
        }
        if let Substrate::Elastic(_) = self.substrate {
            all.extend([Young(layers), Poisson(layers)]);
        }
        all
    }

    /// Value of a parameter; `None` for one that the body does not have.
    pub fn value(&self, parameter: BodyParameter) -> Option<f64> {
        match parameter {
            BodyParameter::Young(place) => self.material(place).map(|material| material.young()),
            BodyParameter::Poisson(place) => {
                self.material(place).map(|material| material.poisson())
            }
            BodyParameter::Thickness(place) => self.layers.get(place).map(Layer::thickness),
            BodyParameter::NormalStiffness(place) => self.spring(place)?.normal,
            BodyParameter::TangentialStiffness(place) => self.spring(place)?.tangential,
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
            BodyParameter::NormalStiffness(place) | BodyParameter::TangentialStiffness(place) => {
                let spring =
                    self.value(parameter).and_then(|_| self.spring(place)).ok_or(ABSENT)?;
                let spring = match parameter {
                    BodyParameter::NormalStiffness(_) => {
                        Spring::new(Some(value), spring.tangential)
                    }
                    _ => Spring::new(spring.normal, Some(value)),
                }?;
                body.layers[place].interface = Interface::Spring(spring);
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

    /// The springs below a layer, if there are any.
    fn spring(&self, place: usize) -> Option<Spring> {
        match self.layers.get(place)?.interface {
            Interface::Spring(spring) => Some(spring),
            Interface::Bonded | Interface::Frictionless => None,
        }
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

/// Interfaces as data.
#[cfg(feature = "serde")]
mod data {
    use serde::de::value::MapAccessDeserializer;
    use serde::de::{MapAccess, Visitor};
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::{Interface, Spring};

    /// A word, or the numbers of a spring.
    impl Serialize for Interface {
        fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
            match self {
                Self::Bonded => serializer.serialize_str("bonded"),
                Self::Frictionless => serializer.serialize_str("frictionless"),
                Self::Spring(spring) => spring.serialize(serializer),
            }
        }
    }

    impl<'de> Deserialize<'de> for Interface {
        fn deserialize<D: Deserializer<'de>>(data: D) -> std::result::Result<Self, D::Error> {
            struct Read;

            impl<'de> Visitor<'de> for Read {
                type Value = Interface;

                fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                    f.write_str("\"bonded\", \"frictionless\", or the stiffnesses of a spring, normal and tangential")
                }

                fn visit_str<E: serde::de::Error>(
                    self,
                    word: &str,
                ) -> std::result::Result<Interface, E> {
                    match word {
                        "bonded" => Ok(Interface::Bonded),
                        "frictionless" => Ok(Interface::Frictionless),
                        _ => Err(E::unknown_variant(word, &["bonded", "frictionless"])),
                    }
                }

                fn visit_map<A: MapAccess<'de>>(
                    self,
                    map: A,
                ) -> std::result::Result<Interface, A::Error> {
                    Spring::deserialize(MapAccessDeserializer::new(map)).map(Interface::Spring)
                }
            }

            data.deserialize_any(Read)
        }
    }
}
