//! Two coated bodies have the contact of one body whose response is the sum of both, in either order.

use approx::assert_relative_eq;
use nacre::influence::{Method, influence_coefficients};
use nacre::{
    Body, Contact, Convolution, Elastic, Grid, HalfSpace, Layer, Motion, Options, Paraboloid,
    Result, Setup, Solution,
};

use crate::support::random::uniform;

/// Rounding of sums in different order.
const ROUNDING: f64 = 1e-12;

/// Difference of two solutions that are converged to 1e-13.
const CONVERGED: f64 = 1e-12;

fn grid() -> Result<Grid> {
    Grid::new([72, 60], [3.0e-4, 2.8e-4])
}

/// A body with a hard coating, and a body of another metal with two layers.
fn bodies() -> Result<[HalfSpace; 2]> {
    let steel = Elastic::new(210e9, 0.3)?;
    let hard = HalfSpace::new(steel, [Layer::new(Elastic::new(420e9, 0.2)?, 2e-6)?])?;
    let bronze = Elastic::new(110e9, 0.34)?;
    let stack = [
        Layer::new(Elastic::new(3e9, 0.4)?, 5e-6)?,
        Layer::new(Elastic::new(600e9, 0.25)?, 30e-6)?,
    ];
    Ok([hard, HalfSpace::new(bronze, stack)?])
}

fn plan(body: &HalfSpace, counterbody: Option<HalfSpace>) -> Result<Contact> {
    let setup = Setup {
        counterbody: counterbody.map(Body::from),
        ..Setup::default()
    };
    Contact::plan(body, grid()?, setup)
}

fn press(contact: &Contact, motion: &Motion) -> Result<Solution> {
    let options = Options {
        tolerance: 1e-13,
        ..Options::default()
    };
    let solution = contact.solve(&Paraboloid::new(5e-3, 8e-3)?, motion, &options)?;
    solution.require_converged(options.tolerance)
}

/// Largest difference of two pressures relative to the peak.
fn difference(a: &Solution, b: &Solution) -> f64 {
    let pairs = a.pressure.iter().zip(&b.pressure);
    let worst = pairs.fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()));
    worst / b.peak_pressure()
}

#[test]
fn displacements_of_two_bodies_add() -> Result<()> {
    let [first, second] = bodies()?;
    let pressure = uniform(grid()?.shape(), 3);
    let alone = |body: &HalfSpace| {
        let coefficients = influence_coefficients(body, &grid()?, Method::Exact)?;
        Convolution::plan(&coefficients, None)?.apply(&pressure)
    };
    let sum = alone(&first)? + alone(&second)?;
    let together = plan(&first, Some(second))?.convolution().apply(&pressure)?;
    for (sum, together) in sum.iter().zip(&together) {
        assert_relative_eq!(sum, together, max_relative = ROUNDING);
    }
    Ok(())
}

#[test]
fn equal_bodies_are_one_of_half_the_modulus() -> Result<()> {
    // Halving every modulus doubles the response.
    let body = |scale: f64| {
        let substrate = Elastic::new(scale * 210e9, 0.3)?;
        let coating = Elastic::new(scale * 630e9, 0.22)?;
        HalfSpace::new(substrate, [Layer::new(coating, 12e-6)?])
    };
    let motion = Motion::load(20.0);
    let two = press(&plan(&body(1.0)?, Some(body(1.0)?))?, &motion)?;
    let one = press(&plan(&body(0.5)?, None)?, &motion)?;
    let pressure = difference(&two, &one);
    println!("two bodies, one: pressure {pressure:.1e}");
    assert!(pressure < CONVERGED, "{pressure:e}");
    assert_relative_eq!(two.approach, one.approach, max_relative = CONVERGED);
    Ok(())
}

#[test]
fn bare_bodies_are_one_of_the_contact_modulus() -> Result<()> {
    // 1/E* = Σ (1 − ν²)/E.
    let (a, b) = (Elastic::new(210e9, 0.3)?, Elastic::new(70e9, 0.33)?);
    let modulus = 1.0 / (1.0 / a.plane_strain_modulus() + 1.0 / b.plane_strain_modulus());
    let motion = Motion::approach(2e-6);
    let two = press(&plan(&a.into(), Some(b.into()))?, &motion)?;
    let one = press(&plan(&Elastic::new(modulus, 0.0)?.into(), None)?, &motion)?;
    assert!(difference(&two, &one) < CONVERGED);
    assert_relative_eq!(two.load(), one.load(), max_relative = CONVERGED);
    Ok(())
}

#[test]
fn swapping_the_bodies_changes_nothing() -> Result<()> {
    let [first, second] = bodies()?;
    let motion = Motion {
        eccentricity: [Some(5e-6), None],
        ..Motion::load(20.0)
    };
    let there = press(&plan(&first, Some(second.clone()))?, &motion)?;
    let back = press(&plan(&second, Some(first))?, &motion)?;
    let pressure = difference(&there, &back);
    println!("swapped: pressure {pressure:.1e}");
    assert!(pressure < CONVERGED, "{pressure:e}");
    assert_relative_eq!(there.approach, back.approach, max_relative = CONVERGED);
    assert_relative_eq!(there.tilt[0], back.tilt[0], max_relative = CONVERGED);
    Ok(())
}
