//! Bodies in the formats of the reference data.

use nacre::{Elastic, HalfSpace, Interface, Layer, Result, Spring, Substrate};
use serde_json::Value;

use crate::support::reference::{list, number};

/// The body of a case with `layers` and `substrate`. Layers are bonded where nothing else is said.
pub(crate) fn body(case: &Value) -> Result<HalfSpace> {
    body_by(["young", "poisson", "thickness"], case, 1.0)
}

/// The body of a case that has moduli, Poisson's ratios and thicknesses by these names, the last in this unit.
pub(crate) fn body_by([e, nu, h]: [&str; 3], case: &Value, unit: f64) -> Result<HalfSpace> {
    let material = |value: &Value| Elastic::new(number(value, e), number(value, nu));
    let layer = |layer: &Value| {
        let interface = match &layer["interface"] {
            Value::Null => Interface::Bonded,
            Value::String(word) if word == "bonded" => Interface::Bonded,
            Value::String(word) if word == "frictionless" => Interface::Frictionless,
            Value::Object(spring) => {
                let stiffness = |key: &str| spring[key].as_f64();
                Interface::Spring(Spring::new(stiffness("normal"), stiffness("tangential"))?)
            }
            other => panic!("interface {other:?}"),
        };
        let made = Layer::new(material(layer)?, number(layer, h) * unit)?;
        Ok(made.with_interface(interface))
    };
    let layers: Result<Vec<Layer>> = list(case, "layers").iter().map(layer).collect();
    let substrate = match &case["substrate"] {
        Value::Object(_) => material(&case["substrate"])?.into(),
        Value::String(word) if word == "free" => Substrate::Free,
        _ => Substrate::Rigid,
    };
    HalfSpace::new(substrate, layers?)
}
