//! Pairs of equal bodies, and balls whose contact has a radius of 1.

use nacre::friction::{FrictionSolution, TangentialMotion};
use nacre::{Contact, Elastic, Grid, HalfSpace, Layer, Paraboloid, Result, Setup};

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
    let layer = Elastic::new(2.6 * ratio, 0.3)?;
    HalfSpace::new(Elastic::new(2.6, 0.3)?, [Layer::new(layer, thickness)?])
}

/// Two equal bodies, on one thread.
pub(crate) fn equal(body: impl Into<HalfSpace>, grid: Grid) -> Result<Contact> {
    let body = body.into();
    let setup = Setup {
        counterbody: Some(body.clone().into()),
        threads: Some(1),
        ..Setup::default()
    };
    Contact::plan(body, grid, setup)
}

/// Two equal bodies with the shear modulus 1, on a square grid over which a contact of radius 1 takes 83 %.
pub(crate) fn pair(poisson: f64, cells: usize) -> Result<Contact> {
    let width = 2.0 / 0.83;
    equal(
        material(poisson)?,
        Grid::new([cells, cells], [width, width])?,
    )
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
