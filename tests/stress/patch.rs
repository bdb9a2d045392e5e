//! Stress and displacement under a uniform square of pressure or traction, on layered bodies:
//! double Fourier integrals, eleven digits.

use crate::support::claims::claim;
use crate::support::reference::{cases, list, number};
use nacre::{Elastic, Grid, HalfSpace, Layer, Result, Side, Stress, StressOptions, stress};
use ndarray::Array2;
use serde_json::Value;

/// Components under traction alone, as in the reference: those at friction 1 less those of the
/// pressure.
fn field(case: &Value, friction: f64) -> Result<Stress> {
    let layers = list(case, "layers");
    let material = |layer: &Value| {
        Elastic::new(layer[1].as_f64().unwrap_or(f64::NAN), layer[2].as_f64().unwrap_or(f64::NAN))
    };
    let coatings = layers[..layers.len() - 1]
        .iter()
        .map(|layer| Layer::new(material(layer)?, layer[0].as_f64().unwrap_or(f64::NAN)))
        .collect::<Result<Vec<_>>>()?;
    let body = HalfSpace::new(material(&layers[layers.len() - 1])?, coatings)?;
    // Cell centres are at odd multiples of 1/40, and the square's edges at ±0.5. The reference's
    // points are cell centres of the grid that is shifted by half a cell.
    let n = 96;
    let grid = Grid::new([n, n], [n as f64 / 20.0; 2])?;
    let (x, y) = (grid.x(), grid.y());
    let inside = |v: f64| v.abs() < 0.5;
    let pressure =
        Array2::from_shape_fn((n, n), |(i, j)| f64::from(u8::from(inside(x[i]) && inside(y[j]))));
    let options = StressOptions::default()
        .with_side(if number(case, "side") < 0.0 { Side::Above } else { Side::Below })
        .with_friction(friction)
        .with_direction(if case["load"] == "qy" { [0.0, 1.0] } else { [1.0, 0.0] })
        .with_displacement(true);
    stress(&body, &grid, &pressure, &[number(case, "z")], &options)
}

/// Value at (x, y), a corner of cells, by interpolation of sixth order along both directions.
fn at(field: &Stress, k: usize, [x, y]: [f64; 2]) -> f64 {
    const WEIGHTS: [f64; 6] =
        [3.0 / 256.0, -25.0 / 256.0, 150.0 / 256.0, 150.0 / 256.0, -25.0 / 256.0, 3.0 / 256.0];
    let values = match (&field.displacement, k) {
        (Some(displacement), 6..) => &displacement[k - 6],
        _ => &field.components[k],
    };
    let first = |at: f64, centres: &ndarray::Array1<f64>| {
        let d = centres[1] - centres[0];
        let position = (at - centres[0]) / d + 0.5;
        assert!((position - position.round()).abs() < 1e-9);
        position.round() as usize - 3
    };
    let (i, j) = (first(x, &field.x), first(y, &field.y));
    let mut sum = 0.0;
    for (a, wa) in WEIGHTS.iter().enumerate() {
        for (b, wb) in WEIGHTS.iter().enumerate() {
            sum += wa * wb * values[[0, i + a, j + b]];
        }
    }
    sum
}

const NAMES: [&str; 9] = ["sxx", "syy", "szz", "sxy", "syz", "sxz", "ux", "uy", "uz"];

/// The worst error comes from the interpolation of sixth order over cells of 1/20, half a side of the square below the
/// surface.

#[test]
#[ignore = "slow"]
fn all_components_match_the_integrals() -> Result<()> {
    for case in cases("stress_patch.json") {
        let point = [number(&case, "x"), number(&case, "y")];
        let pressure = field(&case, 0.0)?;
        let loaded = case["load"] == "p";
        let sliding = if loaded { None } else { Some(field(&case, 1.0)?) };
        for (k, name) in NAMES.iter().enumerate() {
            let alone = at(&pressure, k, point);
            let value = sliding.as_ref().map_or(alone, |s| at(s, k, point) - alone);
            let expected = number(&case, name);
            println!("{} at {point:?}, z {}: {name} {value}", case["load"], case["z"]);
            claim("patch", value - expected);
        }
    }
    Ok(())
}
