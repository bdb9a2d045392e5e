//! A body: a substrate and the layers on it.

use crate::error::{Result, positive};
use crate::material::Elastic;

/// How a layer is joined to what lies below it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Interface {
    /// Displacement and traction are continuous.
    #[default]
    Bonded,
    /// The two sides slip freely and never open: no shear traction on either.
    Frictionless,
}

/// One layer of uniform thickness, and the interface **below** it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer {
    material: Elastic,
    thickness: f64,
    interface: Interface,
}

impl Layer {
    /// A layer of `material`, bonded to what lies below it.
    ///
    /// # Errors
    /// Unless `thickness` \[m\] is finite and above 0.
    pub fn new(material: Elastic, thickness: f64) -> Result<Self> {
        positive("thickness", thickness)?;
        Ok(Self {
            material,
            thickness,
            interface: Interface::Bonded,
        })
    }

    /// The same layer with another interface below it.
    pub fn with_interface(self, interface: Interface) -> Self {
        Self { interface, ..self }
    }

    /// What it is made of.
    pub fn material(&self) -> Elastic {
        self.material
    }

    /// Its thickness \[m\].
    pub fn thickness(&self) -> f64 {
        self.thickness
    }

    /// The interface below it.
    pub fn interface(&self) -> Interface {
        self.interface
    }
}

/// What lies below the layers.
#[derive(Debug, Clone, Copy, PartialEq)]
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

/// A half-space: a substrate with layers on it.
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
}

impl HalfSpace {
    /// `layers` from the surface down, on `substrate`.
    ///
    /// # Errors
    /// A rigid substrate without a layer: such a body is rigid, and as a counterbody it is `None`.
    pub fn new(
        substrate: impl Into<Substrate>,
        layers: impl IntoIterator<Item = Layer>,
    ) -> Result<Self> {
        let substrate = substrate.into();
        let layers: Vec<Layer> = layers.into_iter().collect();
        if layers.is_empty() && substrate == Substrate::Rigid {
            return Err(crate::Error::Inconsistent(
                "layers must hold at least one layer where the substrate is rigid",
            ));
        }
        Ok(Self { substrate, layers })
    }

    /// What lies below the layers.
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

    /// Thickness of all layers together \[m\].
    pub fn thickness(&self) -> f64 {
        self.layers.iter().map(Layer::thickness).sum()
    }

    /// The material at the surface: the top layer's, or the substrate's.
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
        Self {
            substrate: material.into(),
            layers: Vec::new(),
        }
    }
}
