//! Two coated bodies have the contact of one body whose response is the sum of both, in either order.

use nacre::influence::{Method, influence_coefficients};
use nacre::{
    Contact, Convolution, Elastic, Grid, HalfSpace, Motion, Paraboloid, Result, Setup, Solution,
};

use crate::support::checks::pressure_off;
use crate::support::random::uniform;
use crate::support::settings::{against, converged, stack, steel, tolerance};

/// Rounding of sums in different order.
const ROUNDING: f64 = 1e-12;

/// Difference of two solutions that are converged to 1e-13.
const CONVERGED: f64 = 1e-12;

fn grid() -> Result<Grid> {
    Grid::new([72, 60], [3.0e-4, 2.8e-4])
}

/// A body with a hard coating, and a body of another metal with two layers.
fn bodies() -> Result<[HalfSpace; 2]> {
    let hard = stack(steel()?, [[420e9, 0.2, 2e-6]])?;
    let layers = [[3e9, 0.4, 5e-6], [600e9, 0.25, 30e-6]];
    Ok([hard, stack(Elastic::new(110e9, 0.34)?, layers)?])
}

fn plan(body: &HalfSpace, counterbody: Option<HalfSpace>) -> Result<Contact> {
    let setup = counterbody.map_or_else(Setup::default, against);
    Contact::plan(body, grid()?, setup)
}

fn press(contact: &Contact, motion: &Motion) -> Result<Solution> {
    let options = tolerance(1e-13);
    converged(contact, &Paraboloid::new(5e-3, 8e-3)?, motion, &options)
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
        near!(sum, together, ROUNDING);
    }
    Ok(())
}

/// Asserts that two solutions are one.
fn same(one: &Solution, other: &Solution) {
    below!(pressure_off(one, other), CONVERGED);
    near!(one.approach, other.approach, CONVERGED);
    near!(one.load(), other.load(), CONVERGED);
    near!(one.tilt[0], other.tilt[0], CONVERGED);
}

#[test]
fn two_bodies_are_one_of_the_summed_response() -> Result<()> {
    // Halving every modulus doubles the response.
    let body = |scale: f64| {
        let layer = [scale * 630e9, 0.22, 12e-6];
        stack(Elastic::new(scale * 210e9, 0.3)?, [layer])
    };
    // 1/E* = Σ (1 − ν²)/E of bare bodies.
    let (a, b) = (steel()?, Elastic::new(70e9, 0.33)?);
    let modulus = 1.0 / (1.0 / a.plane_strain_modulus() + 1.0 / b.plane_strain_modulus());
    let bare = Elastic::new(modulus, 0.0)?;
    let (loaded, moved) = (Motion::load(20.0), Motion::approach(2e-6));
    for (two, one, motion) in
        [([body(1.0)?, body(1.0)?], body(0.5)?, loaded), ([a.into(), b.into()], bare.into(), moved)]
    {
        let [first, second] = two;
        let two = press(&plan(&first, Some(second))?, &motion)?;
        same(&two, &press(&plan(&one, None)?, &motion)?);
    }
    Ok(())
}

#[test]
fn swapping_the_bodies_changes_nothing() -> Result<()> {
    let [first, second] = bodies()?;
    let motion = Motion::load(20.0).with_eccentricity([Some(5e-6), None]);
    let there = press(&plan(&first, Some(second.clone()))?, &motion)?;
    let back = press(&plan(&second, Some(first))?, &motion)?;
    same(&there, &back);
    Ok(())
}
