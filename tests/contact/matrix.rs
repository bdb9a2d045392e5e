//! What holds of every contact, tried on every kind: a matrix of contacts and invariants. A new kind of contact is a row of
//! [`KINDS`].

use nacre::{
    Contact, Elastic, Grid, HalfSpace, Hardness, HeightMap, Interface, Layer, Motion, Options,
    Paraboloid, Result, Roller, SampledProfile, Setup, Solution, Spring, Surface,
};
use ndarray::{Array2, Axis};

use crate::support::checks::difference;
use crate::support::settings::{against, tolerance};

/// Tolerance of the iterations.
const SOLVED: f64 = 1e-11;

/// Difference of pressures, relative to the peak, and of approaches, of two formulations that are solved so far.
const SAME: f64 = 1e-7;

/// The same of a free end beneath layers of the body's own material: ends of layered bodies are computed by waves
/// along the end, and those of bare ones in closed form.
const SAME_END: f64 = 2e-4;

/// Variations of a contact whose answers follow from that of the first.
#[derive(Debug, Clone, Copy)]
struct Scene {
    /// Units of length in a metre, and of force in a newton.
    metre: f64,
    newton: f64,
    /// -1 for the mirror image about x = 0.
    side: f64,
    /// Cells along each side for one of the first.
    cells: usize,
    /// Whether the substrate has two layers of its own material.
    same: bool,
}

const FIRST: Scene = Scene { metre: 1.0, newton: 1.0, side: 1.0, cells: 1, same: false };

impl Scene {
    fn elastic(&self, young: f64, poisson: f64) -> Result<Elastic> {
        Elastic::new(young * self.newton / self.metre.powi(2), poisson)
    }

    fn steel(&self) -> Result<Elastic> {
        self.elastic(210e9, 0.3)
    }

    fn film(&self, interface: Interface) -> Result<Vec<Layer>> {
        let layer = Layer::new(self.elastic(420e9, 0.2)?, 20e-6 * self.metre)?;
        Ok(vec![layer.with_interface(interface)])
    }

    fn bonded(&self) -> Result<HalfSpace> {
        self.body(self.film(Interface::Bonded)?)
    }

    fn body(&self, mut layers: Vec<Layer>) -> Result<HalfSpace> {
        let same: &[f64] = if self.same { &[7e-6, 40e-6] } else { &[] };
        for thickness in same {
            layers.push(Layer::new(self.steel()?, thickness * self.metre)?);
        }
        HalfSpace::new(self.steel()?, layers)
    }

    fn grid(&self, shape: [usize; 2], size: f64) -> Result<Grid> {
        let size = size * self.metre;
        Grid::new(shape.map(|n| n * self.cells), [size, 0.9 * size])
    }

    /// A ball under a force beside its lowest point, free to tilt about one axis.
    fn press(&self, body: HalfSpace, setup: Setup, options: &Options) -> Result<Solution> {
        let ball = Paraboloid::new(5e-3 * self.metre, 7e-3 * self.metre)?
            .shifted(1e-5 * self.metre * self.side, 6e-6 * self.metre)?;
        let arm = 1.2e-5 * self.metre * self.side;
        let motion = Motion::load(10.0 * self.newton).with_eccentricity([Some(arm), None]);
        let contact = Contact::plan(body, self.grid([72, 64], 3e-4)?, setup)?;
        contact.solve(&ball, &motion, options)
    }

    /// A load in the middle of a shape, on a coated body.
    fn load(
        &self,
        shape: &dyn Surface,
        grid: Grid,
        load: f64,
        options: &Options,
    ) -> Result<Solution> {
        let contact = Contact::plan(self.bonded()?, grid, Setup::default())?;
        contact.solve(shape, &Motion::load(load * self.newton), options)
    }

    fn end(&self, layers: Vec<Layer>, options: &Options) -> Result<Solution> {
        let end = 6.25e-5 * self.metre; // an edge of cells
        let ends = if self.side > 0.0 { [None, Some(end)] } else { [Some(-end), None] };
        self.press(self.body(layers)?.with_ends(ends)?, Setup::default(), options)
    }
}

type Kind = fn(&Scene, &Options) -> Result<Solution>;

fn bare(scene: &Scene, options: &Options) -> Result<Solution> {
    scene.press(scene.body(vec![])?, Setup::default(), options)
}

fn coated(scene: &Scene, options: &Options) -> Result<Solution> {
    scene.press(scene.bonded()?, Setup::default(), options)
}

fn both_coated(scene: &Scene, options: &Options) -> Result<Solution> {
    let thin = Layer::new(scene.elastic(70e9, 0.35)?, 5e-6 * scene.metre)?;
    let other = HalfSpace::new(scene.steel()?, [thin])?;
    scene.press(scene.bonded()?, against(other), options)
}

fn springs(scene: &Scene, options: &Options) -> Result<Solution> {
    let stiffness = scene.newton / scene.metre.powi(3);
    let springs = Spring::new(Some(3e15 * stiffness), Some(1e15 * stiffness))?;
    let film = scene.film(Interface::Spring(springs))?;
    scene.press(scene.body(film)?, Setup::default(), options)
}

fn frictionless(scene: &Scene, options: &Options) -> Result<Solution> {
    let film = scene.film(Interface::Frictionless)?;
    scene.press(scene.body(film)?, Setup::default(), options)
}

fn periodic(scene: &Scene, options: &Options) -> Result<Solution> {
    let grid = scene.grid([64, 72], 3e-4)?.periodic([true; 2])?;
    // The highest point is the centre of a cell, also on grids of odd multiples of cells.
    let top = 5 * scene.cells + scene.cells / 2;
    let (x, y, size) = (grid.x(), grid.y(), grid.size());
    let angle = |place: f64, top: f64, side: f64| std::f64::consts::TAU * (place - top) / side;
    let heights = Array2::from_shape_fn(grid.shape(), |(i, j)| {
        let along = angle(x[i], scene.side * x[top], size[0]);
        let across = angle(y[j], y[top], size[1]);
        2e-8 * scene.metre * (along.cos() * across.cos() + 0.3 * (2.0 * along).cos())
    });
    let map = HeightMap::new(heights, grid.spacing())?.periodic([true; 2])?;
    scene.load(&map, grid, 2.0, options)
}

fn yielding(scene: &Scene, options: &Options) -> Result<Solution> {
    let limit = 1.2e9 * scene.newton / scene.metre.powi(2);
    let options = options.clone().with_hardness(Hardness::Uniform(limit));
    scene.press(scene.bonded()?, Setup::default(), &options)
}

fn free_end(scene: &Scene, options: &Options) -> Result<Solution> {
    scene.end(vec![], options)
}

fn coated_end(scene: &Scene, options: &Options) -> Result<Solution> {
    scene.end(scene.film(Interface::Bonded)?, options)
}

fn sampled_profile(scene: &Scene, options: &Options) -> Result<Solution> {
    let length = 4e-4 * scene.metre;
    let places: Vec<f64> = (-20..=20).map(|k| f64::from(k) / 20.0).collect();
    let drop = |x: f64| 1e-6 * x * x + 4e-7 * (x * scene.side).max(0.0).powi(3);
    let drops: Vec<f64> = places.iter().map(|&x| scene.metre * drop(x)).collect();
    let x: Vec<f64> = places.iter().map(|x| 0.5 * length * x).collect();
    let profile = SampledProfile::new(&x, &drops)?;
    let roller = Roller::with_profile(5e-3 * scene.metre, profile)?.with_length(length)?;
    scene.load(&roller, scene.grid([72, 64], 4e-4)?, 20.0, options)
}

/// Each kind with its load, whether the force acts beside the middle, and whether errors are stated.
const KINDS: [(&str, Kind, f64, bool, bool); 10] = [
    ("bare", bare, 10.0, true, true),
    ("coated", coated, 10.0, true, true),
    ("both coated", both_coated, 10.0, true, true),
    ("springs", springs, 10.0, true, true),
    ("frictionless", frictionless, 10.0, true, true),
    ("periodic", periodic, 2.0, false, true),
    ("hardness", yielding, 10.0, true, false),
    ("free end", free_end, 10.0, true, true),
    ("coated end", coated_end, 10.0, true, true),
    ("sampled profile", sampled_profile, 20.0, false, true),
];

fn solve(kind: Kind, scene: &Scene) -> Result<Solution> {
    kind(scene, &tolerance(SOLVED))?.require_converged(SOLVED)
}

/// Assert that the answer of a variation is that of the first scene in other units or mirrored.
fn assert_same(name: &str, kind: Kind, scene: &Scene, limit: f64) -> Result<()> {
    let (first, other) = (solve(kind, &FIRST)?, solve(kind, scene)?);
    let mut pressure = &other.pressure * (scene.metre.powi(2) / scene.newton);
    if scene.side < 0.0 {
        pressure.invert_axis(Axis(0));
    }
    below!(difference(&pressure, &first.pressure), limit, name);
    below!((other.approach / scene.metre / first.approach - 1.0).abs(), limit, name);
    Ok(())
}

#[test]
#[ignore = "slow"]
fn forces_balance() -> Result<()> {
    for (name, kind, load, eccentric, _) in KINDS {
        let solution = solve(kind, &FIRST)?;
        let area = solution.grid().cell_area();
        let x = solution.grid().x();
        let sum = solution.pressure.sum() * area;
        below!((sum / load - 1.0).abs(), 1e-9, name);
        if eccentric {
            let moment: f64 =
                solution.pressure.outer_iter().zip(&x).map(|(row, x)| row.sum() * x).sum();
            below!((moment * area / (1.2e-5 * load) - 1.0).abs(), 1e-6, name);
        }
    }
    Ok(())
}

#[test]
#[ignore = "slow"]
fn mirror_images_have_mirrored_answers() -> Result<()> {
    for (name, kind, ..) in KINDS {
        assert_same(name, kind, &Scene { side: -1.0, ..FIRST }, SAME)?;
    }
    Ok(())
}

#[test]
#[ignore = "slow"]
fn units_change_nothing() -> Result<()> {
    // Millimetres and newtons; inches and tonnes-force.
    for (metre, newton) in [(1e3, 1.0), (39.37, 1.0 / 9806.65)] {
        for (name, kind, ..) in KINDS {
            assert_same(name, kind, &Scene { metre, newton, ..FIRST }, SAME)?;
        }
    }
    Ok(())
}

#[test]
#[ignore = "slow"]
fn layers_of_the_substrate_change_nothing() -> Result<()> {
    for (name, kind, ..) in KINDS {
        let limit = if name == "free end" { SAME_END } else { SAME };
        assert_same(name, kind, &Scene { same: true, ..FIRST }, limit)?;
    }
    Ok(())
}

#[test]
#[ignore = "slow"]
fn finer_grids_are_within_the_stated_error() -> Result<()> {
    for (name, kind, _, _, stated) in KINDS {
        let coarse = solve(kind, &FIRST)?;
        let Some(errors) = coarse.report.discretisation else {
            assert!(!stated, "{name}");
            continue;
        };
        let fine = solve(kind, &Scene { cells: 3, ..FIRST })?;
        let peaks = [&coarse, &fine].map(Solution::peak_pressure);
        let approach = (coarse.approach - fine.approach).abs();
        below!(approach, errors.approach + SAME * fine.approach, name);
        let error = errors.peak_pressure.expect("no edge is sharp");
        below!((peaks[0] - peaks[1]).abs(), error + SAME * peaks[1], name);
    }
    Ok(())
}

#[test]
#[ignore = "slow"]
fn the_pressure_of_a_solution_is_a_start_that_changes_nothing() -> Result<()> {
    for (name, kind, ..) in KINDS {
        let first = solve(kind, &FIRST)?;
        let options = tolerance(SOLVED).with_initial(first.pressure.clone());
        let again = kind(&FIRST, &options)?;
        below!(difference(&again.pressure, &first.pressure), SAME, name);
    }
    Ok(())
}
