//! Work of a corpus of contacts: convolutions, and cells of grids that are chosen. `benches/constants.py` builds and runs it
//! with each constant of the solver that was found by trial halved and doubled.
//!
//! Counts depend on no machine and no number of threads.

use nacre::friction::{FrictionOptions, Rolling, RollingDirection, Step};
use nacre::{
    Body, Compliance, Contact, Cylinder, Elastic, FlatPunch, Grid, HalfSpace, Hardness, HeightMap,
    Interface, Layer, Motion, Options, Paraboloid, Result, Roller, Setup, Surface, contact,
};
use ndarray::Array2;

/// Lengths are in radii of the bare contact of the ball, of radius [`RADIUS`], under the load [`LOAD`].
const RADIUS: f64 = 100.0;
const LOAD: f64 = 4.0 / 3.0 / RADIUS / 0.91;
const FRICTION: f64 = 0.3;

/// A body of E = 1, with layers of Young's modulus and thickness, the top first.
fn body(layers: &[(f64, f64)]) -> Result<HalfSpace> {
    let layer = |&(young, thickness): &(f64, f64)| Layer::new(Elastic::new(young, 0.3)?, thickness);
    HalfSpace::new(Elastic::new(1.0, 0.3)?, layers.iter().map(layer).collect::<Result<Vec<_>>>()?)
}

/// Heights of n² cells of one radius together, between −`height` and `height`: white noise by a linear congruence.
fn rough(n: usize, height: f64) -> Array2<f64> {
    let mut state = 1_u32;
    Array2::from_shape_simple_fn((n, n), || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        height * (f64::from(state >> 8) / f64::from(1_u32 << 23) - 1.0)
    })
}

/// Convolutions, cells of grids that are chosen, and contacts that did not converge.
#[derive(Default)]
struct Work {
    convolutions: f64,
    cells: usize,
    failed: usize,
}

impl Work {
    fn add(&mut self, convolutions: f64, converged: bool) {
        self.convolutions += convolutions;
        self.failed += usize::from(!converged);
    }

    fn solve(
        &mut self,
        body: &HalfSpace,
        grid: Grid,
        shape: &dyn Surface,
        motion: &Motion,
        options: &Options,
    ) -> Result<()> {
        let contact = Contact::plan(body, grid, Setup::default())?;
        let report = contact.solve(shape, motion, options)?.report;
        self.add(report.convolutions, report.converged());
        Ok(())
    }

    fn choose(&mut self, body: &HalfSpace, shape: &dyn Surface, motion: &Motion) -> Result<()> {
        let (setup, options) = (Setup::default(), Options::default());
        let body = Body::from(body.clone());
        let solution = contact::solve_with(shape, &body, &setup, motion, &options)?;
        self.cells += solution.pressure.len();
        self.add(solution.report.convolutions, solution.report.converged());
        Ok(())
    }
}

fn main() -> Result<()> {
    let (options, load) = (Options::default(), Motion::load(LOAD));
    let ball = Paraboloid::new(RADIUS, RADIUS)?;
    let roller = Roller::new(RADIUS, 12.0, 1e3)?;
    let slipping =
        Layer::new(Elastic::new(4.0, 0.3)?, 0.3)?.with_interface(Interface::Frictionless);
    let bodies = [
        body(&[])?,
        body(&[(4.0, 0.3)])?,
        body(&[(0.1, 0.3)])?,
        body(&[(30.0, 0.05)])?,
        body(&[(100.0, 0.05)])?,
        body(&[(3.0, 0.1), (0.5, 0.2), (2.0, 0.4)])?,
        HalfSpace::new(Elastic::new(1.0, 0.3)?, vec![slipping])?,
    ];
    let eccentric = Motion::load(LOAD).with_eccentricity([Some(0.3), None]);
    let along = Motion::load(20.0 * LOAD).with_eccentricity([Some(1.0), None]);
    let mut work = Work::default();
    for body in &bodies {
        work.solve(body, Grid::new([128, 128], [6.0, 6.0])?, &ball, &load, &options)?;
        work.solve(body, Grid::new([100, 96], [2.4, 2.4])?, &ball, &load, &options)?;
        work.solve(
            body,
            Grid::new([128, 128], [3.0, 3.0])?,
            &FlatPunch::new(0.6)?,
            &load,
            &options,
        )?;
        let grid = Grid::new([192, 32], [16.0, 4.0])?;
        work.solve(body, grid, &roller, &Motion::load(20.0 * LOAD), &options)?;
        work.solve(body, grid, &roller, &along, &options)?;
        let line = Grid::line(256, 3.0)?;
        work.solve(body, line, &Cylinder::new(RADIUS)?, &load, &options)?;
        let waves = HeightMap::new(rough(64, 2e-3), [1.0 / 64.0; 2])?;
        let grid = Grid::new([64, 64], [1.0, 1.0])?;
        work.solve(body, grid, &waves, &eccentric, &options)?;
        let waves = waves.periodic([true, true])?;
        work.solve(body, grid.periodic([true, true])?, &waves, &load, &options)?;
    }
    for body in &bodies[..3] {
        work.choose(body, &ball, &load)?;
        work.choose(body, &roller, &along)?;
    }
    let grid = Grid::new([128, 128], [3.0, 3.0])?;
    for body in &bodies[..3] {
        let hard = Options::default().with_hardness(Hardness::Uniform(3e-3));
        work.solve(body, grid, &ball, &load, &hard)?;
        let soft = Options::default().with_compliance(Compliance::Uniform(0.3));
        work.solve(body, grid, &ball, &load, &soft)?;
    }
    let friction = FrictionOptions::default().with_tolerance(1e-6);
    for body in &bodies[..3] {
        let setup = Setup::default().with_counterbody(bodies[0].clone());
        let contact = Contact::plan(body, Grid::new([64, 64], [3.6, 3.6])?, setup)?;
        let press = Step::press(load, FRICTION);
        let push = |share: f64| press.clone().with_force([Some(share * FRICTION * LOAD), None]);
        for step in contact.slide(&ball, &[push(0.4), push(0.9), push(-0.5)], &friction, None)? {
            work.add(step.report.convolutions as f64, step.report.converged());
        }
        for (creepage, spin) in [(0.5, 0.0), (2.0, 0.0), (0.5, 2.0)] {
            let rolling = Rolling::new(load, FRICTION, RollingDirection::PlusX)
                .with_creepage([Some(creepage * FRICTION * LOAD), None])
                .with_spin(spin * FRICTION * LOAD);
            let report = contact.roll(&ball, &rolling, &friction)?.report;
            work.add(report.convolutions as f64, report.converged());
        }
    }
    println!("{:.1} {} {}", work.convolutions, work.cells, work.failed);
    Ok(())
}
