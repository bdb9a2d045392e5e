//! Values as data, with the feature `serde`: materials, bodies, grids, profiles and shapes are structures of
//! the arguments that make them, under the names that Python uses. Reading them checks them as their
//! constructors do.

use ndarray::Array2;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::contact::{Unestimated, Warning};
use crate::error::{Error, Result};
use crate::model::body::{HalfSpace, Interface, Layer, Spring, Substrate};
use crate::model::grid::Grid;
use crate::model::material::Elastic;
use crate::model::surface::{
    CrownedProfile, Cylinder, FlatPunch, HeightMap, LogarithmicProfile, Paraboloid, Profile,
    Roller, SampledProfile, Sphere,
};

/// Implements both traits of a type by its fields, the expressions that read them from `self`, and the
/// call that makes the value.
macro_rules! value {
    (
        $kind:ident by $data:ident { $($(#[$meta:meta])* $field:ident: $type:ty = $read:expr;)* }
        $of:ident, $fields:ident => $make:expr
    ) => {
        #[derive(Serialize, Deserialize)]
        #[serde(deny_unknown_fields)]
        struct $data {
            $($(#[$meta])* $field: $type,)*
        }

        impl Serialize for $kind {
            fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
                let $of = self;
                $data { $($field: $read,)* }.serialize(serializer)
            }
        }

        impl<'de> Deserialize<'de> for $kind {
            fn deserialize<D: Deserializer<'de>>(data: D) -> std::result::Result<Self, D::Error> {
                let $fields = $data::deserialize(data)?;
                let make = || -> Result<Self> { $make };
                make().map_err(D::Error::custom)
            }
        }
    };
}

value! {
    Elastic by ElasticData { young: f64 = of.young(); poisson: f64 = of.poisson(); }
    of, fields => Self::new(fields.young, fields.poisson)
}

value! {
    Spring by SpringData {
        normal: Option<f64> = of.normal();
        tangential: Option<f64> = of.tangential();
    }
    of, fields => Self::new(fields.normal, fields.tangential)
}

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

value! {
    HalfSpace by HalfSpaceData {
        substrate: Substrate = of.substrate();
        #[serde(default)]
        layers: Vec<Layer> = of.layers().to_vec();
        #[serde(default, skip_serializing_if = "goes_on")]
        ends: [Option<f64>; 2] = of.ends();
    }
    of, fields => Self::new(fields.substrate, fields.layers)?.with_ends(fields.ends)
}

/// Whether a body has no free end.
fn goes_on(ends: &[Option<f64>; 2]) -> bool {
    *ends == [None; 2]
}

/// Whether a grid repeats in no direction.
fn is_open(periodic: &[bool; 2]) -> bool {
    *periodic == [false; 2]
}

value! {
    // A line has one cell along x.
    Grid by GridData {
        shape: [usize; 2] = of.shape();
        size: [f64; 2] = of.size();
        #[serde(default)]
        center: [f64; 2] = of.center();
        #[serde(default, skip_serializing_if = "is_open")]
        periodic: [bool; 2] = of.is_periodic();
    }
    of, fields => {
        let grid = match fields.shape {
            [1, cells] => Self::line(cells, fields.size[1])?,
            shape => Self::new(shape, fields.size)?,
        };
        grid.centered_at(fields.center)?.periodic(fields.periodic)
    }
}

value! {
    Sphere by SphereData {
        radius: f64 = of.radius();
        counter_radius_x: Option<f64> = of.counter_radii()[0];
        counter_radius_y: Option<f64> = of.counter_radii()[1];
    }
    of, fields => Self::new(fields.radius)?
        .with_counter_radii([fields.counter_radius_x, fields.counter_radius_y])
}

value! {
    Paraboloid by ParaboloidData {
        radius_x: f64 = of.radius_x();
        radius_y: f64 = of.radius_y();
        counter_radius_x: Option<f64> = of.counter_radii()[0];
        counter_radius_y: Option<f64> = of.counter_radii()[1];
    }
    of, fields => Self::new(fields.radius_x, fields.radius_y)?
        .with_counter_radii([fields.counter_radius_x, fields.counter_radius_y])
}

value! {
    Cylinder by CylinderData {
        radius: f64 = of.radius();
        counter_radius: Option<f64> = of.counter_radius();
    }
    of, fields => {
        let cylinder = Self::new(fields.radius)?;
        match fields.counter_radius {
            Some(radius) => cylinder.with_counter_radius(radius),
            None => Ok(cylinder),
        }
    }
}

value! {
    FlatPunch by FlatPunchData { radius: f64 = of.radius(); }
    of, fields => Self::new(fields.radius)
}

value! {
    CrownedProfile by CrownedProfileData {
        flat_length: f64 = of.flat_length();
        crown_radius: f64 = of.crown_radius();
    }
    of, fields => Self::new(fields.flat_length, fields.crown_radius)
}

value! {
    LogarithmicProfile by LogarithmicProfileData {
        amplitude: f64 = of.amplitude();
        length: f64 = of.length();
        flat_length: f64 = of.flat_length();
        end_factor: f64 = of.end_factor();
    }
    of, fields => Self::new(fields.amplitude, fields.length, fields.flat_length, fields.end_factor)
}

value! {
    SampledProfile by SampledProfileData {
        x: Vec<f64> = of.samples().map(|[x, _]| x).collect();
        drop: Vec<f64> = of.samples().map(|[_, drop]| drop).collect();
        smooth: bool = !of.is_straight();
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        corners: Vec<f64> = of.corners().to_vec();
        smoothing: Option<f64> = of.smoothing();
    }
    of, fields => {
        let mut profile = Self::new(&fields.x, &fields.drop)?.with_corners(&fields.corners)?;
        if !fields.smooth {
            profile = profile.straight();
        }
        match fields.smoothing {
            Some(wavelength) => profile.smoothed(wavelength),
            None => Ok(profile),
        }
    }
}

value! {
    Roller by RollerData {
        radius: f64 = of.radius();
        profile: Profile = of.profile().clone();
        length: Option<f64> = of.length();
        counter_radius: Option<f64> = of.counter_radius();
        #[serde(default, skip_serializing_if = "Option::is_none")]
        apex: Option<f64> = of.apex();
    }
    of, fields => {
        let mut roller = Self::with_profile(fields.radius, fields.profile)?;
        if let Some(length) = fields.length {
            roller = roller.with_length(length)?;
        }
        if let Some(radius) = fields.counter_radius {
            roller = roller.with_counter_radius(radius)?;
        }
        match fields.apex {
            Some(apex) => roller.with_apex(apex),
            None => Ok(roller),
        }
    }
}

value! {
    HeightMap by HeightMapData {
        heights: Vec<Vec<f64>> = of.heights().outer_iter().map(|row| row.to_vec()).collect();
        spacing: [f64; 2] = of.spacing();
        #[serde(default)]
        center: [f64; 2] = of.center();
        #[serde(default, skip_serializing_if = "is_open")]
        periodic: [bool; 2] = of.is_periodic();
    }
    of, fields => {
        let shape = [fields.heights.len(), fields.heights.first().map_or(0, Vec::len)];
        let heights = Array2::from_shape_vec(shape, fields.heights.concat()).map_err(|_| {
            Error::Inconsistent("heights must be rows of the same length")
        })?;
        Self::new(heights, fields.spacing)?
            .centered_at(fields.center)?
            .periodic(fields.periodic)
    }
}

/// A warning by its kind, axis and figure, which are 0 where it has none.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WarningData {
    kind: String,
    axis: usize,
    figure: f64,
}

/// Reasons why sliding or rolling has no estimate, by their numbers in a file.
const REASONS: [Unestimated; 4] =
    [Unestimated::Coarse, Unestimated::Unsolved, Unestimated::Coefficients, Unestimated::Before];

impl Serialize for Warning {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let (axis, figure) = match *self {
            Self::GridEdge | Self::SharpEdge | Self::FreeEnd | Self::CoatedEnd => (0, 0.0),
            Self::UnknownStations => (0, 0.0),
            Self::EndlessCrown { at } => (0, at),
            Self::SharpEnd { axis } | Self::MapRim { axis } => (axis, 0.0),
            Self::Coarse { axis, cells } => (axis, cells as f64),
            Self::CoarseSpots { axis, cells } => (axis, cells),
            Self::LargeContact { axis, ratio } => (axis, ratio),
            Self::OutsideGrid { depth } => (0, depth),
            Self::PeakError { error } | Self::Stations { error } => (0, error),
            Self::LargeMotion { size } => (0, size),
            Self::Unestimated { reason } => (reason as usize, 0.0),
        };
        WarningData { kind: self.kind().into(), axis, figure }.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Warning {
    fn deserialize<D: Deserializer<'de>>(data: D) -> std::result::Result<Self, D::Error> {
        let WarningData { kind, axis, figure } = WarningData::deserialize(data)?;
        let all = [
            Self::GridEdge,
            Self::SharpEnd { axis },
            Self::FreeEnd,
            Self::CoatedEnd,
            Self::SharpEdge,
            Self::MapRim { axis },
            Self::Coarse { axis, cells: figure as usize },
            Self::CoarseSpots { axis, cells: figure },
            Self::LargeContact { axis, ratio: figure },
            Self::OutsideGrid { depth: figure },
            Self::PeakError { error: figure },
            Self::Stations { error: figure },
            Self::UnknownStations,
            Self::EndlessCrown { at: figure },
            Self::LargeMotion { size: figure },
        ];
        let unestimated = || {
            let reason = *REASONS.get(axis)?;
            Some(Self::Unestimated { reason }).filter(|warning| warning.kind() == kind)
        };
        let warning = all.iter().find(|warning| warning.kind() == kind);
        warning
            .copied()
            .or_else(unestimated)
            .ok_or_else(|| D::Error::custom(format!("no warning is of the kind {kind:?}")))
    }
}

/// Depths of two faces, of which the lower one is infinite where it is null, as JSON has it.
pub(crate) fn depths<'de, D: Deserializer<'de>>(
    data: D,
) -> std::result::Result<[f64; 2], D::Error> {
    let (top, bottom) = <(f64, Option<f64>)>::deserialize(data)?;
    Ok([top, bottom.unwrap_or(f64::INFINITY)])
}

#[cfg(test)]
mod tests {
    use std::fmt::Debug;

    use serde::de::DeserializeOwned;

    use super::*;
    use crate::compliance::influence::Method;
    use crate::contact::{Algorithm, Motion};

    /// Asserts that JSON gives a value back.
    fn kept<T: Serialize + DeserializeOwned + PartialEq + Debug>(
        value: T,
    ) -> serde_json::Result<()> {
        let text = serde_json::to_string(&value)?;
        println!("{text}");
        assert_eq!(serde_json::from_str::<T>(&text)?, value);
        Ok(())
    }

    /// Message of the error with which JSON is refused.
    fn refused<T: DeserializeOwned>(text: &str) -> String {
        serde_json::from_str::<T>(text).err().map_or_else(String::new, |error| error.to_string())
    }

    #[test]
    fn values_come_back_from_json() -> std::result::Result<(), Box<dyn std::error::Error>> {
        let steel = Elastic::new(210e9, 0.3)?;
        let layer = Layer::new(Elastic::new(1e11 / 3.0, 0.2)?, 1e-6)?;
        let layers =
            [layer.clone().with_name("DLC")?, layer.with_interface(Interface::Frictionless)];
        kept(HalfSpace::new(steel, layers.clone())?)?;
        let bonded = [layers[0].clone()];
        kept(HalfSpace::new(steel, bonded)?.with_ends([Some(-1e-2 / 3.0), None])?)?;
        kept(HalfSpace::new(Substrate::Rigid, layers.clone())?)?;
        let spring = Interface::Spring(Spring::new(Some(1e15), None)?);
        kept(spring)?;
        kept(HalfSpace::new(
            Substrate::Free,
            [layers[0].clone().with_interface(spring), layers[0].clone()],
        )?)?;
        kept(Grid::new([4, 3], [0.1, 0.2])?.centered_at([0.3, -0.4])?)?;
        kept(Grid::new([4, 3], [0.1, 0.2])?.periodic([true, false])?)?;
        kept(Grid::line(5, 0.1)?.centered_at([0.0, 0.3])?)?;
        kept(Sphere::new(5e-3)?.with_counter_radii([Some(-6e-3), None])?)?;
        kept(Paraboloid::new(5e-3, 1.0)?)?;
        kept(Cylinder::new(5e-3)?.with_counter_radius(-0.1 / 3.0)?)?;
        kept(FlatPunch::new(0.1)?)?;
        kept(Roller::new(5e-3, 1e-2, 1.0)?.with_length(2e-2)?)?;
        let logarithmic = LogarithmicProfile::iso16281(1e-2, 3e-2)?;
        kept(Roller::with_profile(5e-3, logarithmic)?.with_counter_radius(0.1)?)?;
        kept(Roller::new(5e-3, 1e-2, 1.0)?.with_apex(-0.1)?)?;
        kept(Roller::with_profile(5e-3, SampledProfile::new(&[0.0, 0.1], &[0.0, 1e-6])?)?)?;
        let heights = Array2::from_shape_fn((2, 3), |(i, j)| (i + j) as f64 / 3.0);
        kept(HeightMap::new(heights, [0.1, 0.2])?)?;
        kept(Motion { tilt: [Some(1e-3), None], ..Motion::load(10.0) })?;
        kept([Algorithm::Cascade, Algorithm::PolonskyKeer])?;
        kept([Method::Exact, Method::Image { refinement: 4 }])?;
        Ok(())
    }

    #[test]
    fn ends_are_left_out_where_a_body_goes_on()
    -> std::result::Result<(), Box<dyn std::error::Error>> {
        let body = HalfSpace::from(Elastic::new(1.0, 0.3)?);
        assert!(!serde_json::to_string(&body)?.contains("ends"));
        let body = body.with_ends([None, Some(0.25)])?;
        assert!(serde_json::to_string(&body)?.contains(r#""ends":[null,0.25]"#));
        // As data that were written before bodies had ends.
        let older = r#"{"substrate": {"elastic": {"young": 1.0, "poisson": 0.3}}, "layers": []}"#;
        assert_eq!(serde_json::from_str::<HalfSpace>(older)?.ends(), [None; 2]);
        Ok(())
    }

    #[test]
    fn values_are_checked_when_they_are_read() {
        let negative = r#"{"young": -1.0, "poisson": 0.3}"#;
        assert!(refused::<Elastic>(negative).contains("young must be finite and above 0, got -1"));
        assert!(refused::<Elastic>(r#"{"young": 1.0}"#).contains("missing field `poisson`"));
        let unknown = r#"{"radius": 1.0, "width": 2.0}"#;
        assert!(refused::<FlatPunch>(unknown).contains("unknown field `width`"));
        let ragged = r#"{"heights": [[0.0, 1.0], [2.0]], "spacing": [1.0, 1.0]}"#;
        assert!(refused::<HeightMap>(ragged).contains("rows of the same length"));
        assert!(refused::<HalfSpace>(r#"{"substrate": "rigid"}"#).contains("at least one layer"));
        let reversed =
            r#"{"substrate": {"elastic": {"young": 1.0, "poisson": 0.3}}, "ends": [1.0, 0.0]}"#;
        assert!(refused::<HalfSpace>(reversed).contains("ends must be in ascending order"));
        let narrow = r#"{"radius": 1.0, "counter_radius": -0.5}"#;
        assert!(refused::<Cylinder>(narrow).contains("counter_radius"));
    }
}
