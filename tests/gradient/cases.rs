//! Random layered contacts on small grids.

use nacre::gradient::{LinearOptions, Linearisation};
use nacre::{
    Contact, Elastic, Grid, HalfSpace, Interface, Layer, LogarithmicProfile, Motion, Paraboloid,
    Result, Roller, Setup, Solution, Sphere, Substrate, Surface,
};

use crate::support::contacts::Random;
use crate::support::settings::{self, against};

/// A contact to be solved.
#[derive(Debug)]
pub(crate) struct Case {
    pub(crate) body: HalfSpace,
    pub(crate) counterbody: Option<HalfSpace>,
    pub(crate) grid: Grid,
    pub(crate) shape: Box<dyn Surface>,
    pub(crate) motion: Motion,
}

fn chance(numbers: &mut Random, part: f64) -> bool {
    numbers.between(0.0, 1.0) < part
}

fn material(numbers: &mut Random) -> Result<Elastic> {
    let young = numbers.power(-0.6, 0.6);
    Elastic::new(young, numbers.between(0.0, 0.5))
}

/// A body of up to two layers.
fn body(numbers: &mut Random) -> Result<HalfSpace> {
    let count = numbers.choice(3);
    let mut layers = Vec::new();
    for _ in 0..count {
        let layer = Layer::new(material(numbers)?, numbers.between(0.1, 0.8))?;
        layers.push(match chance(numbers, 0.2) {
            true => layer.with_interface(Interface::Frictionless),
            false => layer,
        });
    }
    let substrate = match count > 0 && chance(numbers, 0.15) {
        true => Substrate::Rigid,
        false => material(numbers)?.into(),
    };
    HalfSpace::new(substrate, layers)
}

impl Case {
    /// The case with this number: spheres, paraboloids and rollers, under all kinds of motion.
    pub(crate) fn new(number: u64) -> Result<Self> {
        let numbers = &mut Random::new(number);
        let cells = [0, 1].map(|_| numbers.between(18.0, 30.0) as usize);
        let line = chance(numbers, 0.1);
        let grid = match line {
            true => Grid::line(40, 2.4)?,
            false => Grid::new(cells, [2.4, 2.4])?,
        };
        let body = body(numbers)?;
        let counterbody = match chance(numbers, 0.4) {
            true => Some(self::body(numbers)?),
            false => None,
        };
        let radius = numbers.between(8.0, 20.0);
        let by = [numbers.between(-0.1, 0.1), numbers.between(-0.1, 0.1)];
        let kind = if line { 3 } else { numbers.choice(4) };
        let shape: Box<dyn Surface> = match kind {
            0 => Box::new(Sphere::new(radius)?.shifted(by[0], by[1])?),
            1 => Box::new(Roller::new(radius, 0.6, radius)?.shifted(by[0], by[1])?),
            2 => {
                let profile = LogarithmicProfile::new(0.02, 2.0, 0.7, 0.9)?;
                Box::new(Roller::with_profile(radius, profile)?)
            }
            _ => {
                let oblong = radius * numbers.between(0.7, 1.4);
                Box::new(Paraboloid::new(radius, oblong)?.shifted(by[0], by[1])?)
            }
        };
        let depth = numbers.between(0.2, 0.5) / radius;
        let mut motion = match chance(numbers, 0.6) {
            true => Motion::load(if line { 0.3 * depth } else { depth }),
            false if line => Motion::load(0.3 * depth),
            false => Motion::approach(depth),
        };
        for (axis, by) in by.into_iter().enumerate().skip(usize::from(line)) {
            match numbers.choice(4) {
                0 if motion.load.is_some() => {
                    motion.eccentricity[axis] = Some(by + numbers.between(-0.05, 0.05));
                }
                1 => motion.tilt[axis] = Some(numbers.between(-0.01, 0.01)),
                2 if motion.load.is_some() => {
                    motion.moment[axis] = motion.load.map(|load| load * by);
                }
                _ => {}
            }
        }
        Ok(Self { body, counterbody, grid, shape, motion })
    }

    /// The solved contact; `tolerance` is that of the solve.
    pub(crate) fn solve(&self, tolerance: f64) -> Result<Solution> {
        let setup = self.counterbody.as_ref().map_or_else(Setup::default, against);
        let options = settings::tolerance(tolerance).with_max_iterations(20_000);
        Contact::plan(&self.body, self.grid, setup)?.solve(&*self.shape, &self.motion, &options)
    }
}

/// A linearisation whose solves end at 1e-12.
pub(crate) fn linearised<'a>(
    solution: &'a Solution,
    shape: Option<&'a dyn Surface>,
) -> Result<Linearisation<'a>> {
    Linearisation::plan(solution, shape, &LinearOptions::default().with_tolerance(1e-12))
}
