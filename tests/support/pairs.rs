//! Pairs of equal bodies, and balls whose contact has a radius of 1.

use nacre::friction::{
    FrictionOptions, FrictionSolution, Rolling, RollingDirection, Step, TangentialMotion,
};
use nacre::{Contact, Elastic, Grid, HalfSpace, Motion, Paraboloid, Result, Surface};

use crate::support::checks::apart;
use crate::support::settings::{self, one_thread};

/// Radius of the ball.
pub(crate) const RADIUS: f64 = 50.0;

/// The ball.
pub(crate) fn ball() -> Result<Paraboloid> {
    Paraboloid::new(RADIUS, RADIUS)
}

/// Material with the shear modulus 1.
pub(crate) fn material(poisson: f64) -> Result<Elastic> {
    Elastic::new(2.0 * (1.0 + poisson), poisson)
}

/// Load at which two equal bodies with the shear modulus 1 touch the ball on a circle of radius 1, after Hertz.
pub(crate) fn load(poisson: f64) -> f64 {
    4.0 / 3.0 / (1.0 - poisson) / RADIUS
}

/// A body of shear modulus 1 with one layer of the given ratio of moduli, both with ν = 0.3.
pub(crate) fn coated(ratio: f64, thickness: f64) -> Result<HalfSpace> {
    settings::coated(Elastic::new(2.6, 0.3)?, ratio, thickness)
}

/// Two equal bodies, on one thread.
pub(crate) fn equal(body: impl Into<HalfSpace>, grid: Grid) -> Result<Contact> {
    let body = body.into();
    let setup = one_thread(body.clone());
    Contact::plan(body, grid, setup)
}

/// Two equal bodies with the shear modulus 1, on a square grid over which a contact of radius 1 takes 83 %.
pub(crate) fn pair(poisson: f64, cells: usize) -> Result<Contact> {
    let width = 2.0 / 0.83;
    equal(material(poisson)?, Grid::new([cells, cells], [width, width])?)
}

/// A coated body on another one, which couples pressure and tractions.
pub(crate) fn unlike(cells: usize, width: f64) -> Result<Contact> {
    let grid = Grid::new([cells, cells], [width, width])?;
    Contact::plan(coated(3.0, 0.2)?, grid, one_thread(material(0.2)?))
}

/// Options with this tolerance.
pub(crate) fn precise(tolerance: f64) -> FrictionOptions {
    FrictionOptions::default().with_tolerance(tolerance)
}

/// The ball after a single step, which converges.
pub(crate) fn slide(
    contact: &Contact,
    step: Step,
    options: &FrictionOptions,
) -> Result<FrictionSolution> {
    slide_once(contact, &ball()?, step, options)
}

/// A shape after a single step, which converges.
pub(crate) fn slide_once(
    contact: &Contact,
    shape: &dyn Surface,
    step: Step,
    options: &FrictionOptions,
) -> Result<FrictionSolution> {
    let solution = contact.slide(shape, &[step], options, None)?.remove(0);
    assert!(solution.report.converged(), "{:?}", solution.report);
    Ok(solution)
}

/// Largest difference of two tractions.
pub(crate) fn tractions_apart(a: &FrictionSolution, b: &FrictionSolution) -> f64 {
    let [x, y] = [0, 1].map(|k| apart(&a.traction[k], &b.traction[k]));
    x.max(y)
}

/// Rolling with a creepage or under a force along x, or along y on a line.
pub(crate) fn rolling(
    load: f64,
    friction: f64,
    direction: RollingDirection,
    [creepage, force]: [Option<f64>; 2],
) -> Rolling {
    Rolling::new(Motion::load(load), friction, direction)
        .with_creepage([creepage, None])
        .with_force([force, None])
}

/// The steady state of rolling, which converges.
pub(crate) fn rolled(
    contact: &Contact,
    shape: &dyn Surface,
    rolling: &Rolling,
    options: &FrictionOptions,
) -> Result<FrictionSolution> {
    let solution = contact.roll(shape, rolling, options)?;
    assert!(solution.report.converged(), "{:?}", solution.report);
    Ok(solution)
}

/// Shift and twist.
pub(crate) fn slid(solution: &FrictionSolution) -> ([f64; 2], f64) {
    match solution.motion {
        TangentialMotion::Slide { shift, twist } => (shift, twist),
        TangentialMotion::Roll { .. } => panic!("it rolls"),
    }
}

/// Creepages.
pub(crate) fn creepage(solution: &FrictionSolution) -> [f64; 2] {
    match solution.motion {
        TangentialMotion::Roll { creepage, .. } => creepage,
        TangentialMotion::Slide { .. } => panic!("it slides"),
    }
}

/// Radius of the circle with the area of the cells that stick.
pub(crate) fn stick_radius(solution: &FrictionSolution) -> f64 {
    let cells = solution.stick().iter().filter(|stick| **stick).count();
    (cells as f64 * solution.grid().cell_area() / std::f64::consts::PI).sqrt()
}
