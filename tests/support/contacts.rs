//! Random contacts of all shapes, bodies and controls.

use std::fmt;
use std::sync::Arc;

use nacre::surface::Profile;
use nacre::{
    Contact, Cylinder, Elastic, FlatPunch, Grid, HalfSpace, HeightMap, LogarithmicProfile, Motion,
    Options, Paraboloid, Result, Roller, SampledProfile, Setup, Sphere, Substrate, Surface,
};

use ndarray::Array2;

use crate::support::random::uniform;
use crate::support::settings::stack;

/// Random numbers, one after the other.
#[derive(Debug)]
pub(crate) struct Random {
    seed: u64,
    taken: u64,
}

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self { seed, taken: 0 }
    }

    /// A number between the two.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        self.taken += 1;
        low + (high - low) * uniform([1, 1], (self.seed << 20) + self.taken)[[0, 0]]
    }

    /// A power of ten with an exponent between the two.
    pub(crate) fn power(&mut self, low: f64, high: f64) -> f64 {
        10_f64.powf(self.between(low, high))
    }

    /// One of `count` numbers from 0 on.
    pub(crate) fn choice(&mut self, count: usize) -> usize {
        self.between(0.0, count as f64) as usize
    }

    fn one_of<T: Copy>(&mut self, values: &[T]) -> T {
        values[self.choice(values.len())]
    }
}

/// A contact to be solved.
#[derive(Debug)]
pub(crate) struct RandomContact {
    pub(crate) name: String,
    pub(crate) body: HalfSpace,
    pub(crate) grid: Grid,
    shape: Box<dyn Surface>,
    measured: Option<Measured>,
    pub(crate) motion: Motion,
}

/// A body of modulus 1 or so at the surface of cells of side `cell`: bare, hard, soft or thin layers, with any
/// Poisson's ratio.
fn body(random: &mut Random, cell: f64) -> Result<(String, HalfSpace)> {
    let ratio = |random: &mut Random| random.one_of(&[0.0, 0.2, 0.3, 0.4, 0.45, 0.49, 0.499, 0.5]);
    let kind = random.choice(8);
    let base = Elastic::new(1.0, ratio(random))?;
    let thick = |random: &mut Random, [low, high]: [f64; 2]| cell * random.power(low, high);
    let one = |kind: &str, on: Substrate, [young, nu, h]: [f64; 3]| {
        let name = format!("{kind} {young:.0e} {nu} {:.2}", h / cell);
        Ok((name, stack(on, [[young, nu, h]])?))
    };
    match kind {
        0 => Ok(("bare".into(), base.into())),
        1 | 2 => {
            let (kind, powers) = [("hard", [0.0, 4.0]), ("soft", [-4.0, 0.0])][kind - 1];
            let (young, nu) = (random.power(powers[0], powers[1]), ratio(random));
            one(kind, base.into(), [young, nu, thick(random, [-2.0, 1.5])])
        }
        3 | 4 => {
            let (young, nu) = (random.power(-5.0, -2.0), random.one_of(&[0.49, 0.499, 0.5]));
            one("rubber", base.into(), [young, nu, thick(random, [-1.0, 1.0])])
        }
        5 | 6 => {
            let nu = random.one_of(&[0.3, 0.45, 0.49, 0.499, 0.5, 0.5]);
            let h = thick(random, [-0.8, 1.5]);
            let made = stack(Substrate::Rigid, [[1.0, nu, h]])?;
            Ok((format!("on rigid {nu} {:.2}", h / cell), made))
        }
        _ => {
            let top = thick(random, [-1.0, 1.0]);
            let (young, nu) = (random.power(-3.0, 2.0), ratio(random));
            let below = thick(random, [-1.0, 1.0]);
            let places = format!("{:.2} {:.2}", top / cell, below / cell);
            let layers = [[1.0, 0.3, top], [young, nu, below]];
            Ok((format!("two layers {young:.0e} {nu} {places}"), stack(base, layers)?))
        }
    }
}

/// Heights of a rough surface as a function of x and y, without waves shorter than `shortest`.
fn rough(random: &mut Random, shortest: f64, height: f64) -> impl Fn(f64, f64) -> f64 + use<> {
    let longest = std::f64::consts::TAU / shortest;
    let waves: Vec<[f64; 4]> = (0..60)
        .map(|_| {
            let k = longest * random.between(0.0, 1.0).sqrt();
            let angle = random.between(0.0, 3.2);
            let (phase, amplitude) = (random.between(0.0, 6.3), random.between(0.0, 1.0));
            [k * angle.cos(), k * angle.sin(), phase, amplitude]
        })
        .collect();
    move |x, y| {
        let waves = waves.iter();
        let sum: f64 = waves.map(|[kx, ky, phase, a]| a * (kx * x + ky * y + phase).cos()).sum();
        height * sum / 4.5
    }
}

/// A surface that is measured at the centres of the cells of any grid.
#[derive(Clone)]
struct Measured(Arc<dyn Fn(f64, f64) -> f64 + Send + Sync>);

impl fmt::Debug for Measured {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Measured")
    }
}

impl Measured {
    fn map(&self, grid: &Grid) -> Result<HeightMap> {
        let (x, y) = (grid.x(), grid.y());
        let heights = Array2::from_shape_fn(grid.shape(), |(i, j)| (self.0)(x[i], y[j]));
        HeightMap::new(heights, grid.spacing())
    }
}

impl RandomContact {
    /// The contact with this number, on a grid of 24 to 96 cells along each side of 2.
    pub(crate) fn new(number: u64) -> Result<Self> {
        let random = &mut Random::new(number);
        let mut cells =
            [random.between(24.0, 97.0), random.between(24.0, 97.0)].map(|n| n as usize);
        if random.choice(2) == 0 {
            cells[1] = cells[0];
        }
        let line = random.choice(8) == 0;
        let grid = match line {
            true => Grid::line(cells[1], 2.0)?,
            false => Grid::new(cells, [2.0, 2.0])?,
        };
        let cell = grid.spacing()[1];
        let (body_name, body) = body(random, cell)?;
        // Half-width of the overlap, without elastic deformation.
        let width = random.between(0.15, 0.8);
        let radius = random.power(1.0, 3.0);
        let depth = width * width / (2.0 * radius);
        let at = [random.between(-0.1, 0.1), random.between(-0.1, 0.1)];
        let kind = match line {
            true => random.one_of(&[1, 2, 4]),
            false => random.choice(9),
        };
        let mut measured = None;
        let [x, y] = at;
        let (kind, shape): (&str, Box<dyn Surface>) = match kind {
            0 => ("sphere", Box::new(Sphere::new(radius)?.shifted(x, y)?)),
            1 => {
                let oblong = Paraboloid::new(radius * random.power(-0.7, 0.7), radius)?;
                ("paraboloid", Box::new(oblong.shifted(x, y)?))
            }
            2 => ("cylinder", Box::new(Cylinder::new(radius)?.shifted(x, y)?)),
            3 => {
                let (flat, crown) = (random.between(0.0, 1.0), radius * random.power(0.0, 1.5));
                ("roller", Box::new(Roller::new(radius, flat, crown)?.shifted(x, y)?))
            }
            4 => ("punch", Box::new(FlatPunch::new(width)?.shifted(x, y)?)),
            5 => {
                let length = random.between(0.5, 1.7);
                let profile: Profile = if random.choice(2) == 0 {
                    let amplitude = depth * random.power(-1.5, 0.5);
                    let end = random.one_of(&[1.0, 0.99, 0.9]);
                    LogarithmicProfile::new(amplitude, length, 0.0, end)?.into()
                } else {
                    let x: Vec<f64> = (0..9).map(|k| length * (k as f64 / 8.0 - 0.5)).collect();
                    let wave = |x: &f64| (2.0 * x / length).powi(4);
                    let drop = x.iter().map(|x| depth * (wave(x) + random.between(0.0, 0.1)));
                    SampledProfile::new(&x, &drop.collect::<Vec<f64>>())?.into()
                };
                let roller = Roller::with_profile(radius, profile)?;
                ("profiled roller", Box::new(roller.shifted(at[0], at[1])?))
            }
            6 => {
                let radii = [0, 1].map(|_| radius * random.power(-0.5, 1.0));
                let second = Paraboloid::new(radii[0], radii[1])?;
                let sum = Sphere::new(radius)?.plus(second.shifted(x, y)?);
                ("sum", Box::new(sum))
            }
            7 => {
                let shortest = cell * random.between(6.0, 24.0);
                let height = depth * random.power(-1.0, 0.3);
                let heights = rough(random, shortest, height);
                measured = Some(Measured(Arc::new(move |x, y| {
                    heights(x, y) - (x * x + y * y) / (2.0 * radius)
                })));
                ("map", Box::new(FlatPunch::new(9.0)?))
            }
            _ => {
                measured = Some(Measured(Arc::new(move |x, y| {
                    let (x, y) = (x - at[0], y - at[1]);
                    -(x * x + y * y) / (2.0 * radius)
                })));
                ("smooth map", Box::new(FlatPunch::new(9.0)?))
            }
        };
        let made =
            Self { name: String::new(), body, grid, shape, measured, motion: Motion::default() };
        let lowest = made.shape_on(&grid)?.gaps(&grid)?.fold(f64::INFINITY, |a, b| a.min(*b));
        let slope = match random.choice(3) {
            0 => random.between(-0.3, 0.3) * depth,
            _ => 0.0,
        };
        let tilt = [None, Some(slope)];
        let moved = Motion::approach(lowest + depth).with_tilt(tilt);
        let motion = if random.choice(2) == 0 {
            moved
        } else {
            // The load of this approach.
            let contact = Contact::plan(&made.body, grid, Setup::default())?;
            let solution = contact.solve(&*made.shape_on(&grid)?, &moved, &Options::default())?;
            match solution.load() {
                load if load > 0.0 => Motion::load(load).with_tilt(tilt),
                _ => moved,
            }
        };
        let how = motion.load.map_or("approach", |_| "load");
        let line = if line { " line" } else { "" };
        let name = format!("{number}: {kind}, {how}, {body_name}, {cells:?}{line}");
        Ok(Self { name, motion, ..made })
    }

    /// The shape on `grid`, where it is measured if it is a map.
    pub(crate) fn shape_on(&self, grid: &Grid) -> Result<Box<dyn Surface + '_>> {
        Ok(match &self.measured {
            Some(measured) => Box::new(measured.map(grid)?),
            None => Box::new(&*self.shape),
        })
    }

    /// The contact's grid with cells `factor` times as fine.
    pub(crate) fn finer(&self, factor: usize) -> Result<Grid> {
        let ([nx, ny], size) = (self.grid.shape(), self.grid.size());
        if self.grid.is_line() {
            Grid::line(factor * ny, size[1])
        } else {
            Grid::new([factor * nx, factor * ny], size)
        }
    }
}
