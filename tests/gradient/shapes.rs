//! Derivatives of gaps equal differences of gaps, for every number of every shape.

use nacre::{
    Cylinder, Grid, LogarithmicProfile, Paraboloid, Result, Roller, SampledProfile, Sphere,
    Superposition, Surface,
};

use crate::support::checks::{apart, largest};

/// Differences of sixth order with steps of 1e-2.
const DIFFERENCE: f64 = 1e-8;

/// A shape made of numbers.
type Maker = fn(&[f64]) -> Result<Box<dyn Surface>>;

fn log(v: &[f64]) -> Result<LogarithmicProfile> {
    LogarithmicProfile::new(v[1], 2.0, v[2], v[3])
}

#[test]
fn derivatives_of_gaps_equal_differences() -> Result<()> {
    let grid = Grid::new([32, 20], [2.0, 1.0])?;
    #[rustfmt::skip]
    let shapes: [(&[&str], &[f64], Maker); 10] = [
        (&["radius"], &[5.0], |v| Ok(Box::new(Sphere::new(v[0])?))),
        (&["radius", "counter_radius_x", "counter_radius_y"], &[5.0, -9.0, 7.0],
            |v| Ok(Box::new(Sphere::new(v[0])?.with_counter_radii([Some(v[1]), Some(v[2])])?))),
        (&["radius_x", "radius_y", "counter_radius_y"], &[5.0, 3.0, -7.0],
            |v| Ok(Box::new(Paraboloid::new(v[0], v[1])?.with_counter_radii([None, Some(v[2])])?))),
        (&["radius", "counter_radius"], &[5.0, -8.0],
            |v| Ok(Box::new(Cylinder::new(v[0])?.with_counter_radius(v[1])?))),
        (&["radius", "flat_length", "crown_radius"], &[5.0, 0.61, 9.0],
            |v| Ok(Box::new(Roller::new(v[0], v[1], v[2])?))),
        (&["radius", "profile.amplitude", "profile.flat_length", "profile.end_factor", "counter_radius"],
            &[5.0, 0.01, 0.61, 0.95, -8.0],
            |v| Ok(Box::new(Roller::with_profile(v[0], log(v)?)?.with_counter_radius(v[4])?))),
        (&["radius", "profile.amplitude", "profile.flat_length", "counter_radius", "apex"],
            &[5.0, 0.01, 0.61, -8.0, 4.0],
            |v| {
                let profile = LogarithmicProfile::new(v[1], 2.0, v[2], 0.95)?;
                let roller = Roller::with_profile(v[0], profile)?.with_counter_radius(v[3])?;
                Ok(Box::new(roller.with_apex(v[4])?))
            }),
        (&["radius", "profile.drop[0]", "profile.drop[1]"], &[5.0, 0.01, 0.02], |v| {
            let profile = SampledProfile::new(&[-1.0, 0.1, 1.0], &[v[1], v[2], 0.03])?;
            Ok(Box::new(Roller::with_profile(v[0], profile)?))
        }),
        (&["radius", "shift[0]", "shift[1]"], &[5.0, 0.03, 0.05],
            |v| Ok(Box::new(Sphere::new(v[0])?.shifted(v[1], v[2])?))),
        (&["parts[0].radius", "parts[1].radius"], &[5.0, 7.0],
            |v| Ok(Box::new(Superposition::new([Sphere::new(v[0])?, Sphere::new(v[1])?])?))),
    ];
    for (names, values, make) in shapes {
        let shape = make(values)?;
        for name in names {
            let all = shape.parameters();
            assert!(all.iter().any(|(one, _)| one == name), "{shape:?} {name}");
        }
        for (name, value) in shape.parameters() {
            let Some(k) = names.iter().position(|one| *one == name) else {
                continue;
            };
            below!((value - values[k]).abs(), 1e-15, name);
            let found = shape.gap_derivative(&name, &grid)?;
            // Ends of profiles, at which the end factor has its pole, need the smaller step.
            let is_end = name.ends_with("factor");
            let step = if is_end { 5e-4 } else { 1e-2 * value.abs() };
            let at = |factor: f64| -> Result<_> {
                let mut values = values.to_vec();
                values[k] += factor * step;
                make(&values)?.gaps(&grid)
            };
            let mut difference = ndarray::Array2::<f64>::zeros(found.dim());
            for (factor, weight) in [(1.0, 0.75), (2.0, -0.15), (3.0, 1.0 / 60.0)] {
                difference = difference + (at(factor)? - at(-factor)?) * (weight / step);
            }
            let size = largest(&difference);
            assert!(size > 0.0, "{name}");
            // The second derivative of a gap jumps where a straight part ends: a part of the step.
            let is_jump = name.ends_with("flat_length");
            let bar = if is_jump { 3e-3 } else { DIFFERENCE };
            below!(apart(&found, &difference), bar * size, shape, name);
        }
    }
    Ok(())
}

#[test]
fn a_number_that_is_no_parameter_is_refused() -> Result<()> {
    let grid = Grid::new([4, 4], [1.0, 1.0])?;
    let error = Sphere::new(5.0)?.gap_derivative("length", &grid);
    assert!(error.is_err_and(|error| error.to_string().contains("\"length\"")));
    Ok(())
}
