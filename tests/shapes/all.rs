//! Every shape: the closed form of its gap, derivatives of its gaps by differences, and its value in JSON.

use approx::assert_relative_eq;
use nacre::{
    Cylinder, FlatPunch, Grid, HeightMap, LogarithmicProfile, Paraboloid, Result, Roller,
    SampledProfile, Sphere, Superposition, Surface,
};
use ndarray::{Array2, array};

use crate::support::checks::{apart, kept, largest};

/// Rounding of a few operations, of which the differences of nearly equal circles lose two digits.
const ROUNDING: f64 = 1e-12;

/// Differences of sixth order with steps of 1e-2.
const DIFFERENCE: f64 = 1e-8;

/// Gap \[m\] at a point.
type Gap = ([f64; 2], f64);

/// Checks the shape that `make` makes of `numbers`, of which the first ones have the `names` of its parameters, and
/// returns it.
fn check<S: Surface>(
    names: &[&str],
    numbers: &[f64],
    make: impl Fn(&[f64]) -> Result<S>,
    gaps: &[Gap],
) -> Result<S> {
    let shape = make(numbers)?;
    for ([x, y], gap) in gaps {
        assert_relative_eq!(shape.gap(*x, *y), gap, max_relative = ROUNDING);
    }
    let (grid, parameters) = (Grid::new([32, 20], [2.0, 1.0])?, shape.parameters());
    for (k, name) in names.iter().enumerate() {
        let value = parameters.iter().find(|(one, _)| one == name).map(|(_, value)| *value);
        assert!(value.is_some(), "{shape:?} {name}");
        let value = value.unwrap_or_default();
        below!((value - numbers[k]).abs(), 1e-15, name);
        let derivative = shape.gap_derivative(name, &grid)?;
        // Ends of profiles, at which the end factor has its pole, need the smaller step.
        let is_end = name.ends_with("factor");
        let step = if is_end { 5e-4 } else { 1e-2 * value.abs() };
        let at = |factor: f64| -> Result<_> {
            let mut numbers = numbers.to_vec();
            numbers[k] += factor * step;
            make(&numbers)?.gaps(&grid)
        };
        let mut difference = Array2::<f64>::zeros(derivative.dim());
        for (factor, weight) in [(1.0, 0.75), (2.0, -0.15), (3.0, 1.0 / 60.0)] {
            difference = difference + (at(factor)? - at(-factor)?) * (weight / step);
        }
        let size = largest(&difference);
        assert!(size > 0.0, "{name}");
        // The second derivative of a gap jumps where a straight part ends: a part of the step.
        let is_jump = name.ends_with("flat_length");
        let bar = if is_jump { 3e-3 } else { DIFFERENCE };
        below!(apart(&derivative, &difference), bar * size, shape, name);
    }
    Ok(shape)
}

/// Depth of a circle below its highest point.
fn circle(radius: f64, x: f64) -> f64 {
    radius - (radius * radius - x * x).sqrt()
}

#[test]
fn spheres() -> Result<()> {
    kept(&check(&["radius"], &[5.0], |v| Sphere::new(v[0]), &[([3.0, 0.0], 1.0)])?);
    let own = circle(5.0, 3.0);
    kept(&check(
        &["radius", "counter_radius_x", "counter_radius_y"],
        &[5.0, -9.0, 7.0],
        |v| Sphere::new(v[0])?.with_counter_radii([Some(v[1]), Some(v[2])]),
        &[([3.0, 0.0], own - circle(9.0, 3.0)), ([0.0, 3.0], own + circle(7.0, 3.0))],
    )?);
    kept(&Sphere::new(5e-3)?.with_counter_radii([Some(-6e-3), None])?);
    Ok(())
}

#[test]
fn paraboloids() -> Result<()> {
    kept(&check(
        &["radius_x", "radius_y", "counter_radius_y"],
        &[5.0, 3.0, -7.0],
        |v| Paraboloid::new(v[0], v[1])?.with_counter_radii([None, Some(v[2])]),
        &[([1.0, 2.0], 0.1 + 2.0 * (1.0 / 3.0 - 1.0 / 7.0))],
    )?);
    kept(&Paraboloid::new(5e-3, 1.0)?);
    Ok(())
}

#[test]
fn cylinders() -> Result<()> {
    kept(&check(
        &["radius", "counter_radius"],
        &[5.0, -8.0],
        |v| Cylinder::new(v[0])?.with_counter_radius(v[1]),
        &[([9.0, 3.0], 1.0 - circle(8.0, 3.0))],
    )?);
    kept(&Cylinder::new(5e-3)?.with_counter_radius(-0.1 / 3.0)?);
    Ok(())
}

#[test]
fn flat_punches() -> Result<()> {
    // Cells join and leave the face one by one: the radius is no parameter.
    let gaps = [([1.0, 0.0], 0.0), ([1.0, 0.1], f64::INFINITY)];
    let punch = check(&[], &[1.0], |v| FlatPunch::new(v[0]), &gaps)?;
    kept(&punch);
    assert!(punch.parameters().is_empty());
    kept(&FlatPunch::new(0.1)?);
    Ok(())
}

/// Drop of a logarithmic profile of length 2.
fn logarithmic(amplitude: f64, flat_length: f64, end_factor: f64, x: f64) -> f64 {
    let u = (2.0 * x - flat_length) / (2.0 - flat_length);
    -amplitude * (-end_factor * u * u).ln_1p()
}

/// Gap of a roller of radius 5 with a drop.
fn roller(drop: f64, y: f64) -> f64 {
    5.0 - ((5.0 - drop).powi(2) - y * y).sqrt()
}

#[test]
fn rollers() -> Result<()> {
    kept(&check(
        &["radius", "flat_length", "crown_radius"],
        &[5.0, 0.61, 9.0],
        |v| Roller::new(v[0], v[1], v[2]),
        &[([0.3, 3.0], 1.0), ([1.0, 3.0], roller(circle(9.0, 0.695), 3.0))],
    )?);
    kept(&check(
        &[
            "radius",
            "profile.amplitude",
            "profile.flat_length",
            "profile.end_factor",
            "counter_radius",
        ],
        &[5.0, 0.01, 0.61, 0.95, -8.0],
        |v| {
            let profile = LogarithmicProfile::new(v[1], 2.0, v[2], v[3])?;
            Roller::with_profile(v[0], profile)?.with_counter_radius(v[4])
        },
        &[([0.8, 2.0], roller(logarithmic(0.01, 0.61, 0.95, 0.8), 2.0) - circle(8.0, 2.0))],
    )?);
    // Radii vanish at the apex: 0.8 of them are left at x = 0.8.
    let drop = logarithmic(0.01, 0.61, 0.95, 0.8) / 0.8;
    kept(&check(
        &["radius", "profile.amplitude", "profile.flat_length", "counter_radius", "apex"],
        &[5.0, 0.01, 0.61, -8.0, 4.0],
        |v| {
            let profile = LogarithmicProfile::new(v[1], 2.0, v[2], 0.95)?;
            Roller::with_profile(v[0], profile)?.with_counter_radius(v[3])?.with_apex(v[4])
        },
        &[([0.8, 1.6], 0.8 * (roller(drop, 2.0) - circle(8.0, 2.0)))],
    )?);
    kept(&check(
        &["radius", "profile.drop[0]", "profile.drop[1]"],
        &[5.0, 0.01, 0.02],
        |v| {
            let profile = SampledProfile::new(&[-1.0, 0.1, 1.0], &[v[1], v[2], 0.03])?;
            Roller::with_profile(v[0], profile)
        },
        &[([0.1, 3.0], roller(0.02, 3.0)), ([1.0, 0.0], 0.03), ([1.1, 0.0], f64::INFINITY)],
    )?);
    kept(&Roller::new(5e-3, 1e-2, 1.0)?.with_length(2e-2)?);
    let iso = LogarithmicProfile::iso16281(1e-2, 3e-2)?;
    kept(&Roller::with_profile(5e-3, iso)?.with_counter_radius(0.1)?);
    kept(&Roller::new(5e-3, 1e-2, 1.0)?.with_apex(-0.1)?);
    kept(&Roller::with_profile(5e-3, SampledProfile::new(&[0.0, 0.1], &[0.0, 1e-6])?)?);
    Ok(())
}

#[test]
fn height_maps() -> Result<()> {
    let heights = array![[0.0, 1.0 / 3.0], [2.0, 3.0]];
    let make = |_: &[f64]| HeightMap::new(heights.clone(), [0.1, 0.2]);
    let gaps = [([0.05, 0.1], 0.0), ([0.0, 0.0], 5.0 / 3.0), ([0.2, 0.0], f64::INFINITY)];
    kept(&check(&[], &[], make, &gaps)?);
    Ok(())
}

#[test]
fn moved_shapes_and_sums() -> Result<()> {
    check(
        &["radius", "shift[0]", "shift[1]"],
        &[5.0, 0.03, 0.05],
        |v| Sphere::new(v[0])?.shifted(v[1], v[2]),
        &[([3.03, 0.05], 1.0)],
    )?;
    check(
        &["parts[0].radius", "parts[1].radius"],
        &[5.0, 7.0],
        |v| Superposition::new([Sphere::new(v[0])?, Sphere::new(v[1])?]),
        &[([3.0, 0.0], 1.0 + circle(7.0, 3.0))],
    )?;
    Ok(())
}

#[test]
fn a_number_that_is_no_parameter_is_refused() -> Result<()> {
    let grid = Grid::new([4, 4], [1.0, 1.0])?;
    let error = Sphere::new(5.0)?.gap_derivative("length", &grid);
    assert!(error.is_err_and(|error| error.to_string().contains("\"length\"")));
    Ok(())
}
