//! Benchmarks of contact with friction; `benches/README.md` describes each.
//!
//! Inputs are fixed, and results are asserted once before timing. All run on one thread. The number of tangential
//! convolutions of each problem to 1e-6 is printed first.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use nacre::friction::{
    FrictionOptions, FrictionSolution, Rolling, RollingDirection, Step, creep_coefficients,
};
use nacre::{Contact, Elastic, Grid, HalfSpace, Layer, Motion, Options, Paraboloid, Result, Setup};

const RADIUS: f64 = 50.0;

const FRICTION: f64 = 0.4;

/// Two equal bodies, bare or with a layer of E1/E2 = 4 of 0.3 contact radii, and the load at which bare ones touch a ball
/// on 83 % of the grid's width.
struct Pair {
    body: HalfSpace,
    contact: Contact,
    ball: Paraboloid,
    load: f64,
}

impl Pair {
    fn new(coated: bool, cells: usize) -> Result<Self> {
        let steel = Elastic::new(2.0 * 1.42, 0.42)?;
        let layer = Layer::new(Elastic::new(8.0 * 1.42, 0.42)?, 0.3)?;
        let body = HalfSpace::new(steel, coated.then_some(layer))?;
        let setup = Setup::default().with_counterbody(body.clone()).with_threads(1);
        let width = 2.0 / 0.83;
        Ok(Self {
            contact: Contact::plan(&body, Grid::new([cells, cells], [width, width])?, setup)?,
            body,
            ball: Paraboloid::new(RADIUS, RADIUS)?,
            load: 4.0 / 3.0 / 0.58 / RADIUS,
        })
    }

    /// The largest force that friction bears.
    fn bears(&self) -> f64 {
        FRICTION * self.load
    }

    fn slide(&self, force: f64, last: Option<&FrictionSolution>) -> FrictionSolution {
        let step = Step::press(Motion::load(self.load), FRICTION)
            .with_force([Some(force * self.bears()), None]);
        let solutions = self.contact.slide(&self.ball, &[step], &options(), last);
        let solution = solutions.expect("valid").pop().expect("one step");
        assert!(solution.report.converged());
        solution
    }

    fn roll(&self, friction: f64, creepage: f64) -> FrictionSolution {
        self.rolled(
            &Rolling::new(Motion::load(self.load), friction, RollingDirection::PlusX)
                .with_creepage([Some(creepage * self.bears()), None]),
        )
    }

    /// Lateral creepage against spin, with the pole of the motion in the contact.
    fn spin(&self) -> FrictionSolution {
        self.rolled(
            &Rolling::new(Motion::load(self.load), FRICTION, RollingDirection::PlusX)
                .with_creepage([None, Some(-CREEPAGE * self.bears())])
                .with_spin(SPIN * self.bears()),
        )
    }

    fn rolled(&self, rolling: &Rolling) -> FrictionSolution {
        let solution = self.contact.roll(&self.ball, rolling, &options());
        let solution = solution.expect("valid");
        assert!(solution.report.converged());
        solution
    }
}

/// Spin over the largest force, with which its motion at the edge is some times the creepage.
const SPIN: f64 = 0.34;

/// Creepage over the largest force with which some half of the contact slips.
const CREEPAGE: f64 = 0.17;

fn options() -> FrictionOptions {
    FrictionOptions::default().with_tolerance(1e-6)
}

fn friction(c: &mut Criterion) {
    let mut group = c.benchmark_group("friction");
    group.sample_size(10);
    for (name, coated) in [("bare", false), ("coated", true)] {
        for cells in [128, 256] {
            let pair = Pair::new(coated, cells).expect("valid");
            let before = pair.slide(0.5, None);
            let id = |problem: &str| BenchmarkId::new(format!("{problem}/{name}"), cells);
            let counts = [
                ("force", pair.slide(0.875, None)),
                ("history", pair.slide(0.625, Some(&before))),
                ("reversal", pair.slide(0.375, Some(&before))),
                ("rolling", pair.roll(FRICTION, CREEPAGE)),
                ("adhesion", pair.roll(1e3, CREEPAGE)),
                ("spin", pair.spin()),
            ];
            for (problem, solution) in counts {
                println!("{problem}/{name}/{cells}: {} convolutions", solution.report.convolutions);
            }
            group.bench_function(id("normal"), |b| {
                let motion = Motion::load(pair.load);
                b.iter(|| pair.contact.solve(&pair.ball, &motion, &Options::default()));
            });
            group.bench_function(id("force"), |b| b.iter(|| pair.slide(0.875, None)));
            group.bench_function(id("history"), |b| {
                b.iter(|| pair.slide(0.625, Some(&before)));
            });
            group.bench_function(id("rolling"), |b| b.iter(|| pair.roll(FRICTION, CREEPAGE)));
            group.bench_function(id("spin"), |b| b.iter(|| pair.spin()));
            group.bench_function(id("adhesion"), |b| b.iter(|| pair.roll(1e3, CREEPAGE)));
        }
        let body = Pair::new(coated, 16).expect("valid").body;
        group.bench_function(BenchmarkId::new("kalker", name), |b| {
            b.iter(|| creep_coefficients(&body, Some((&body).into()), [1.0, 1.0], None, None));
        });
    }
    group.finish();
}

criterion_group!(benches, friction);
criterion_main!(benches);
