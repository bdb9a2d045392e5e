//! A value that cannot be is an error whose message names it, what it must be and what it was.

use nacre::influence::{CellInfluence, Method, influence_coefficients};
use nacre::response::{frequency_response, surface_compliance};
use nacre::{
    Convolution, Cylinder, Elastic, FlatPunch, Grid, HalfSpace, HeightMap, Layer,
    LogarithmicProfile, Paraboloid, Result, Roller, SampledProfile, Sphere, Substrate, Surface,
    graded_layers, hertz,
};
use ndarray::{Array2, array};

use crate::messages::message;
use crate::support::settings::{plan, steel};

const NAN: f64 = f64::NAN;
const INFINITY: f64 = f64::INFINITY;

#[test]
fn materials_and_bodies() -> Result<()> {
    refused! {
        Elastic::new(-1.0, 0.3) => "young must be finite and above 0, got -1";
        Elastic::new(0.0, 0.3) => "young must be finite and above 0, got 0";
        Elastic::new(INFINITY, 0.3) => "young must be finite and above 0, got inf";
        Elastic::new(NAN, 0.3) => "young must be finite and above 0, got NaN";
        Elastic::new(1.0, 0.51) => "poisson must be above -1 and at most 0.5, got 0.51";
        Elastic::new(1.0, -1.0) => "poisson must be above -1 and at most 0.5, got -1";
        Elastic::new(1.0, NAN) => "poisson must be above -1 and at most 0.5, got NaN";
        Layer::new(steel()?, 0.0) => "thickness must be finite and above 0, got 0";
        Layer::new(steel()?, -1e-6) => "thickness must be finite and above 0, got -0.000001";
        Layer::new(steel()?, NAN) => "thickness must be finite and above 0, got NaN";
    }
    let named = |name: &str| Layer::new(steel()?, 1.0)?.with_name(name);
    let must = "name must be a text on one line, other than a number and \"substrate\", got";
    for name in ["", " ", "0", "12", "substrate", "two\nlines"] {
        assert_eq!(message(named(name)), format!("{must} {name:?}"));
    }
    assert_eq!(named("DLC")?.name(), Some("DLC"));
    assert_ne!(named("DLC")?, Layer::new(steel()?, 1.0)?);
    let graded = |thickness, tolerance, young| {
        graded_layers(steel()?, thickness, tolerance, &[], |_| Elastic::new(young, 0.3))
    };
    refused! {
        HalfSpace::new(Substrate::Rigid, []) => "layers must hold at least one layer where the substrate is rigid";
        graded(0.0, 1e-3, 1.0) => "thickness must be finite and above 0, got 0";
        graded(1.0, 0.0, 1.0) => "tolerance must be above 0 and below 1, got 0";
        // An error of the caller's own function is kept.
        graded(1.0, 1e-3, -1.0) => "young must be finite and above 0, got -1";
    }
    Ok(())
}

#[test]
fn grids() -> Result<()> {
    refused! {
        Grid::new([0, 0], [1.0, 1.0]) => "shape must be at least 2 cells in each direction, got 0";
        Grid::new([1, 1], [1.0, 1.0]) => "shape must be at least 2 cells in each direction, got 1";
        Grid::new([8, 1], [1.0, 1.0]) => "shape must be at least 2 cells in each direction, got 1";
        Grid::new([4, 4], [0.0, 1.0]) => "size must be finite and above 0, got 0";
        Grid::new([4, 4], [1.0, -2.0]) => "size must be finite and above 0, got -2";
        Grid::new([4, 4], [1.0, NAN]) => "size must be finite and above 0, got NaN";
        Grid::new([4, 4], [1.0, 1.0])?.centered_at([0.0, INFINITY]) => "center must be finite, got inf";
    }
    let uncountable = message(Grid::new([usize::MAX / 2, 16], [1.0, 1.0]));
    let begins = "shape must be a number of cells that this machine can count";
    assert!(uncountable.starts_with(begins), "{uncountable}");
    Ok(())
}

#[test]
fn a_grid_too_large_for_memory() -> Result<()> {
    let grid = || Grid::new([1 << 21, 1 << 21], [1.0, 1.0]);
    let body: HalfSpace = steel()?.into();
    let planned = grid().and_then(|grid| plan(&body, grid));
    let coefficients = grid().and_then(|grid| influence_coefficients(&body, &grid, Method::Exact));
    for text in [message(planned), message(coefficients)] {
        let begins = "a grid of [2097152, 2097152] cells needs about ";
        assert!(text.starts_with(begins), "{text}");
        let ends = " MiB are available; take fewer cells";
        assert!(text.ends_with(ends), "{text}");
    }
    Ok(())
}

#[test]
fn shapes() -> Result<()> {
    refused! {
        Sphere::new(0.0) => "radius must be finite and above 0, got 0";
        Paraboloid::new(1.0, -1.0)
            => "radius_y must be that of a convex shape (for a concave raceway or groove use counter_radius), finite and above 0, got -1";
        Paraboloid::new(NAN, 1.0) => "radius_x must be finite and above 0, got NaN";
        Cylinder::new(-5.0)
            => "radius must be that of a convex shape (for a concave raceway or groove use counter_radius), finite and above 0, got -5";
        FlatPunch::new(INFINITY) => "radius must be finite and above 0, got inf";
        Roller::new(0.0, 1.0, 1.0) => "radius must be finite and above 0, got 0";
        Roller::new(1.0, -1.0, 1.0) => "flat_length must be finite and at least 0, got -1";
        Roller::new(1.0, 1.0, 0.0) => "crown_radius must be finite and above 0, got 0";
        Roller::new(1.0, 2.0, 9.0)?.with_length(1.5) => "length must be at least flat_length, got 1.5";
        Roller::new(1.0, 2.0, 9.0)?.with_length(NAN) => "length must be finite and above 0, got NaN";
        Sphere::new(1.0)?.shifted(NAN, 0.0) => "x must be finite, got NaN";
        Sphere::new(1.0)?.shifted(0.0, INFINITY) => "y must be finite, got inf";
        LogarithmicProfile::iso16281(0.0, 1.0) => "diameter must be finite and above 0, got 0";
        LogarithmicProfile::new(1.0, 1.0, 1.0, 1.0) => "flat_length must be at least 0 and below the length, got 1";
        LogarithmicProfile::new(1.0, 1.0, 0.0, 1.5) => "end_factor must be above 0 and at most 1, got 1.5";
        SampledProfile::new(&[0.0, 1.0, 1.0], &[0.0; 3]) => "profile positions must be increasing, got 1";
        SampledProfile::new(&[0.0, 1.0], &[0.0, NAN]) => "profile is not finite at [1, 0]";
    }
    Ok(())
}

#[test]
fn height_maps() -> Result<()> {
    let flat = || Array2::zeros([4, 6]);
    let mut broken = flat();
    broken[[2, 3]] = NAN;
    refused! {
        HeightMap::new(broken, [1.0, 1.0]) => "heights is not finite at [2, 3]";
        HeightMap::new(array![[1.0]], [1.0; 2]) => "number of heights along x and along y must be at least 2, got 1";
        HeightMap::new(flat(), [0.0, 1.0]) => "spacing must be finite and above 0, got 0";
        HeightMap::new(flat(), [1.0, NAN]) => "spacing must be finite and above 0, got NaN";
        HeightMap::new(flat(), [1.0, 1.0])?.centered_at([NAN, 0.0]) => "center must be finite, got NaN";
    }
    Ok(())
}

#[test]
fn responses_coefficients_and_convolutions() -> Result<()> {
    let body: HalfSpace = steel()?.into();
    refused! {
        frequency_response(&body, 0.0) => "wavenumber must be finite and above 0, got 0";
        frequency_response(&body, NAN) => "wavenumber must be finite and above 0, got NaN";
        surface_compliance(&body, -1.0) => "wavenumber must be finite and above 0, got -1";
        CellInfluence::plan(&body, [0.0, 1.0], 1.0) => "spacing must be finite and above 0, got 0";
        CellInfluence::plan(&body, [1.0, 1.0], NAN) => "reach must be finite and above 0, got NaN";
        Convolution::plan(&Array2::zeros([0, 3]), None) => "coefficients: expected shape [1, 1], got [0, 3]";
        Convolution::plan(&array![[1.0, INFINITY]], None) => "coefficients is not finite at [0, 1]";
        Convolution::plan(&array![[1.0]], Some(0)) => "threads must be at least 1, got 0";
        Convolution::plan(&array![[1.0]], Some(1000)) => "threads must be at most 256, got 1000";
    }
    let convolution = Convolution::plan(&Array2::ones([3, 4]), Some(1))?;
    let (pressure, mut short) = (Array2::zeros([3, 4]), Array2::zeros([2, 4]));
    let into = convolution.apply_into(&pressure, &mut short, &mut convolution.workspace());
    refused! {
        convolution.apply(&Array2::zeros([4, 3])) => "pressure: expected shape [3, 4], got [4, 3]";
        into => "displacement: expected shape [3, 4], got [2, 4]";
        hertz::Point::new(1.0, 1.0, -1.0) => "load must be finite and above 0, got -1";
    }
    Ok(())
}
