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

/// Checks the shape that `make` makes of `numbers`, and its gaps \[m\] at some points, and returns it. The first numbers
/// have the `names` of its parameters.
fn check<S: Surface>(
    names: &[&str],
    numbers: &[f64],
    make: impl Fn(&[f64]) -> Result<S>,
    gaps: &[([f64; 2], f64)],
) -> Result<S> {
    let shape = make(numbers)?;
    for ([x, y], gap) in gaps {
        assert_relative_eq!(shape.gap(*x, *y), gap, max_relative = ROUNDING);
    }
    let (grid, parameters) = (Grid::new([32, 20], [2.0, 1.0])?, shape.parameters());
    for (k, name) in names.iter().enumerate() {
        let Some((_, value)) = parameters.iter().find(|(one, _)| one == name) else {
            panic!("{shape:?} {name}");
        };
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

#[test]
fn spheres() -> Result<()> {
    kept(&check(&["radius"], &[5.0], |v| Sphere::new(v[0]), &[([3.0, 0.0], 1.0)])?);
    let names = ["radius", "counter_radius_x", "counter_radius_y"];
    let make = |v: &[f64]| Sphere::new(v[0])?.with_counter_radii([Some(v[1]), Some(v[2])]);
    let gaps = [([3.0, 0.0], 72_f64.sqrt() - 8.0), ([0.0, 3.0], 8.0 - 40_f64.sqrt())];
    kept(&check(&names, &[5.0, -9.0, 7.0], make, &gaps)?);
    Ok(())
}

#[test]
fn paraboloids() -> Result<()> {
    let names = ["radius_x", "radius_y", "counter_radius_y"];
    let make = |v: &[f64]| Paraboloid::new(v[0], v[1])?.with_counter_radii([None, Some(v[2])]);
    kept(&check(&names, &[5.0, 3.0, -7.0], make, &[([1.0, 2.0], 0.1 + 8.0 / 21.0)])?);
    Ok(())
}

#[test]
fn cylinders() -> Result<()> {
    let make = |v: &[f64]| Cylinder::new(v[0])?.with_counter_radius(v[1]);
    let gaps = [([9.0, 3.0], 55_f64.sqrt() - 7.0)];
    kept(&check(&["radius", "counter_radius"], &[5.0, -8.0], make, &gaps)?);
    Ok(())
}

#[test]
fn flat_punches() -> Result<()> {
    // Cells join and leave the face one by one: the radius is no parameter.
    let gaps = [([0.1, 0.0], 0.0), ([0.1, 0.01], f64::INFINITY)];
    let punch = check(&[], &[0.1], |v| FlatPunch::new(v[0]), &gaps)?;
    assert!(punch.parameters().is_empty());
    kept(&punch);
    Ok(())
}

#[test]
fn rollers() -> Result<()> {
    let names = ["radius", "flat_length", "crown_radius"];
    let make = |v: &[f64]| Roller::new(v[0], v[1], v[2])?.with_length(3.0);
    let gaps = [([0.3, 3.0], 1.0), ([1.6, 3.0], f64::INFINITY)];
    kept(&check(&names, &[5.0, 0.61, 9.0], make, &gaps)?);

    let [radius, amplitude, flat] = ["radius", "profile.amplitude", "profile.flat_length"];
    let logarithmic = |v: &[f64], end_factor: f64| -> Result<_> {
        Roller::with_profile(v[0], LogarithmicProfile::new(v[1], 2.0, v[2], end_factor)?)
    };
    // A ln 1/(1 − f u²), u = (2x − F)/(L − F).
    let drop = -0.01 * (-0.95 * (0.99_f64 / 1.39).powi(2)).ln_1p();
    let names = [radius, amplitude, flat, "profile.end_factor", "counter_radius"];
    let make = |v: &[f64]| logarithmic(v, v[3])?.with_counter_radius(v[4]);
    let gaps = [([0.8, 0.0], drop), ([0.0, 3.0], 55_f64.sqrt() - 7.0)];
    kept(&check(&names, &[5.0, 0.01, 0.61, 0.95, -8.0], make, &gaps)?);

    let names = [radius, amplitude, flat, "counter_radius", "apex"];
    let make = |v: &[f64]| logarithmic(v, 0.95)?.with_counter_radius(v[3])?.with_apex(v[4]);
    kept(&check(&names, &[5.0, 0.01, 0.61, -8.0, 4.0], make, &[([0.8, 0.0], drop)])?);

    let make = |v: &[f64]| {
        let profile = SampledProfile::new(&[-1.0, 0.1, 1.0], &[v[1], v[2], 0.03])?;
        Roller::with_profile(v[0], profile)
    };
    let gaps = [([0.1, 0.0], 0.02), ([1.0, 0.0], 0.03), ([1.1, 0.0], f64::INFINITY)];
    kept(&check(&[radius, "profile.drop[0]", "profile.drop[1]"], &[5.0, 0.01, 0.02], make, &gaps)?);
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
        &[([3.0, 0.0], 8.0 - 40_f64.sqrt())],
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
