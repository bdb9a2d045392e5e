//! Bodies in the format of the reference data.

use nacre::{Elastic, HalfSpace, Interface, Layer, Result, Substrate};
use serde_json::Value;

use crate::support::reference::{list, number};

/// The body of a case with `layers` and `substrate`.
pub(crate) fn body(case: &Value) -> Result<HalfSpace> {
    let material = |value: &Value| Elastic::new(number(value, "young"), number(value, "poisson"));
    let layers: Result<Vec<Layer>> = list(case, "layers")
        .iter()
        .map(|layer| {
            let interface = match layer["interface"].as_str() {
                Some("bonded") => Interface::Bonded,
                Some("frictionless") => Interface::Frictionless,
                other => panic!("interface {other:?}"),
            };
            let made = Layer::new(material(layer)?, number(layer, "thickness"))?;
            Ok(made.with_interface(interface))
        })
        .collect();
    let substrate = match &case["substrate"] {
        Value::Null => Substrate::Rigid,
        value => material(value)?.into(),
    };
    HalfSpace::new(substrate, layers?)
}
