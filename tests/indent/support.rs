//! Reference numbers and the bodies that they are of.

use nacre::{Elastic, HalfSpace, Interface, Layer, Result, Substrate};
use serde_json::Value;

/// Numbers of other programs, from the folder of test data.
pub(crate) fn reference(name: &str) -> Value {
    let path = format!("{}/tests/data/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// A number of a reference.
pub(crate) fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} must be a number"))
}

/// The body of a case.
pub(crate) fn body(case: &Value) -> Result<HalfSpace> {
    let elastic = |v: &Value| Elastic::new(number(&v["young"]), number(&v["poisson"]));
    let layers = case["layers"]
        .as_array()
        .into_iter()
        .flatten()
        .map(|layer| {
            let interface = match layer["interface"].as_str() {
                Some("frictionless") => Interface::Frictionless,
                _ => Interface::Bonded,
            };
            let made = Layer::new(elastic(layer)?, number(&layer["thickness"]))?;
            Ok(made.with_interface(interface))
        });
    let layers: Vec<Layer> = layers.collect::<Result<_>>()?;
    let base = match case["substrate"].is_object() {
        true => Substrate::Elastic(elastic(&case["substrate"])?),
        false => Substrate::Rigid,
    };
    HalfSpace::new(base, layers)
}

/// A coat of E1/E2 = `ratio` and thickness `h` on E2* = 1, ν = 0.3 both.
pub(crate) fn coated(ratio: f64, h: f64) -> Result<HalfSpace> {
    let substrate = Elastic::new(1.0 - 0.09, 0.3)?;
    let coat = Elastic::new(ratio * substrate.young(), 0.3)?;
    HalfSpace::new(substrate, [Layer::new(coat, h)?])
}

/// Weights of f(x + kh) − f(x − kh), k = 1 … 4, in the first derivative of eighth order times h.
pub(crate) const EIGHTH: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];

/// Nodes and weights of Gauss and Legendre's rule of `n` points on \[0, 1\], by Newton's iteration.
pub(crate) fn unit_rule(n: usize) -> Vec<[f64; 2]> {
    let node = |i: usize| {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..8 {
            let (mut p, mut before) = (1.0, 0.0);
            for k in 0..n {
                let k = k as f64;
                (p, before) = (((2.0 * k + 1.0) * x * p - k * before) / (k + 1.0), p);
            }
            slope = n as f64 * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        [0.5 + 0.5 * x, 1.0 / ((1.0 - x * x) * slope * slope)]
    };
    (0..n).map(node).collect()
}
