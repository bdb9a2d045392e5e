//! Benchmarks of histories of wear; `benches/README.md` describes each.
//!
//! Inputs are fixed, and results are asserted once before timing. All run on one thread. The number of convolutions of the
//! history and of the solves beside it is printed first.

use std::ops::ControlFlow;
use std::sync::Arc;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use nacre::wear::{Wear, WearSession, WearState, WearSteps};
use nacre::{Contact, Elastic, Grid, HalfSpace, Layer, Motion, Options, Paraboloid, Result, Setup};

const RADIUS: f64 = 50.0;

const CELLS: usize = 256;

/// Steps of the history, and solves beside it.
const STEPS: usize = 100;

/// Worn volume over that of the cap whose base is the contact of Hertz: the contact becomes half as wide again.
const WORN: f64 = 4.0;

/// A ball on a body with a layer of E1/E2 = 4 of 0.3 contact radii, whose contact without it has half the grid's width.
struct Worn {
    plan: Arc<Contact>,
    ball: Paraboloid,
    motion: Motion,
    /// Distance at a rate of 1.
    distance: f64,
}

impl Worn {
    fn new() -> Result<Self> {
        let layer = Layer::new(Elastic::new(4.0 * 0.91, 0.3)?, 0.3)?;
        let body = HalfSpace::new(Elastic::new(0.91, 0.3)?, [layer])?;
        let grid = Grid::new([CELLS, CELLS], [4.0, 4.0])?;
        let setup = Setup::default().with_threads(1);
        // E* = 1 and a contact radius of 1.
        let load = 4.0 / 3.0 / RADIUS;
        Ok(Self {
            plan: Arc::new(Contact::plan(&body, grid, setup)?),
            ball: Paraboloid::new(RADIUS, RADIUS)?,
            motion: Motion::load(load),
            distance: WORN * std::f64::consts::PI / (4.0 * RADIUS) / load,
        })
    }

    /// All states of the history.
    fn history(&self) -> Vec<WearState> {
        let end = |k: usize| self.distance * k as f64 / STEPS as f64;
        let wear = Wear::sliding([vec![1.0, 1.0], vec![0.0]], self.distance)
            .with_steps(WearSteps::Ends((1..=STEPS).map(end).collect()));
        let plan = Arc::clone(&self.plan);
        let session = WearSession::new(plan, self.ball, self.motion, wear, false);
        let mut session = session.expect("valid");
        let mut states = Vec::new();
        while let Some(state) =
            session.advance(&mut |_| ControlFlow::Continue(())).expect("it converges")
        {
            states.push(state);
        }
        states
    }

    /// Convolutions of as many contacts of the new ball as the history has steps, each from the pressure of the one before, under
    /// loads that grow by 1 % each.
    fn solves(&self) -> f64 {
        let mut options = Options::default();
        let mut load = self.motion.load.expect("a load");
        let mut convolutions = 0.0;
        for _ in 0..STEPS {
            load *= 1.01;
            let solution = self.plan.solve(&self.ball, &Motion::load(load), &options);
            let solution = solution.expect("it converges");
            convolutions += solution.report.convolutions;
            options.initial = Some(solution.pressure);
        }
        convolutions
    }
}

fn wear(c: &mut Criterion) {
    let mut group = c.benchmark_group("wear");
    group.sample_size(10);
    let worn = Worn::new().expect("valid");
    let states = worn.history();
    let last = states.last().expect("a state");
    let volume = last.depth[0].sum() * worn.plan.grid().cell_area();
    let due = worn.distance * worn.motion.load.expect("a load");
    assert!((volume / due - 1.0).abs() < 1e-10, "{volume:e}, {due:e}");
    let convolutions: f64 = states.iter().map(|one| one.solution.report.convolutions).sum();
    println!("history: {convolutions:.0} convolutions, solves: {:.0}", worn.solves());
    group.bench_function(BenchmarkId::new("history", CELLS), |b| b.iter(|| worn.history()));
    group.bench_function(BenchmarkId::new("solves", CELLS), |b| b.iter(|| worn.solves()));
    group.finish();
}

criterion_group!(benches, wear);
criterion_main!(benches);
