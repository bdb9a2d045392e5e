//! Materials, bodies, grids and motions come back from JSON, and are checked when they are read.

use std::error::Error;

use nacre::influence::Method;
use nacre::{
    Algorithm, Cylinder, Elastic, FlatPunch, Grid, HalfSpace, HeightMap, Interface, Layer, Motion,
    Spring, Substrate,
};
use serde::de::DeserializeOwned;

use crate::support::checks::kept;

/// Message of the error with which JSON is refused.
fn refused<T: DeserializeOwned>(text: &str) -> String {
    serde_json::from_str::<T>(text).err().map_or_else(String::new, |error| error.to_string())
}

#[test]
fn values_come_back_from_json() -> nacre::Result<()> {
    let steel = Elastic::new(210e9, 0.3)?;
    let layer = Layer::new(Elastic::new(1e11 / 3.0, 0.2)?, 1e-6)?;
    let layers = [layer.clone().with_name("DLC")?, layer.with_interface(Interface::Frictionless)];
    kept(&HalfSpace::new(steel, layers.clone())?);
    let bonded = [layers[0].clone()];
    kept(&HalfSpace::new(steel, bonded)?.with_ends([Some(-1e-2 / 3.0), None])?);
    kept(&HalfSpace::new(Substrate::Rigid, layers.clone())?);
    let spring = Interface::Spring(Spring::new(Some(1e15), None)?);
    kept(&spring);
    kept(&HalfSpace::new(
        Substrate::Free,
        [layers[0].clone().with_interface(spring), layers[0].clone()],
    )?);
    kept(&Grid::new([4, 3], [0.1, 0.2])?.centered_at([0.3, -0.4])?);
    kept(&Grid::new([4, 3], [0.1, 0.2])?.periodic([true, false])?);
    kept(&Grid::line(5, 0.1)?.centered_at([0.0, 0.3])?);
    kept(&Motion::load(10.0).with_tilt([Some(1e-3), None]));
    kept(&[Algorithm::Cascade, Algorithm::PolonskyKeer]);
    kept(&[Method::Exact, Method::Image { refinement: 4 }]);
    Ok(())
}

#[test]
fn ends_are_left_out_where_a_body_goes_on() -> Result<(), Box<dyn Error>> {
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
