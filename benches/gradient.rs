//! Benchmarks of gradients; `benches/README.md` describes each.
//!
//! Inputs are fixed, and results are asserted once before timing. All run on the threads of the machine, as solves do.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use nacre::gradient::{LinearOptions, Linearisation, Output};
use nacre::response::normal_derivatives;
use nacre::{
    Contact, Elastic, Grid, HalfSpace, Layer, Motion, Options, Paraboloid, Result, Setup, Solution,
};
use std::hint::black_box;

const RADIUS: f64 = 50.0;

/// Load at which the contact of the coated body has a half-width of about 0.95.
const LOAD: f64 = 0.053;

fn body() -> Result<HalfSpace> {
    let coat = Layer::new(Elastic::new(4.0, 0.3)?, 0.5)?;
    HalfSpace::new(Elastic::new(1.0, 0.3)?, [coat])
}

/// Plan and solve with 256² cells, of whose width the contact takes about this part.
fn solve(part: f64) -> Result<Solution> {
    let grid = Grid::new([256, 256], [2.0 / part; 2])?;
    let contact = Contact::plan(&body()?, grid, Setup::default())?;
    let ball = Paraboloid::new(RADIUS, RADIUS)?;
    contact.solve(&ball, &Motion::load(LOAD), &Options::default())
}

/// Derivatives of the first `count` of six outputs with respect to all parameters.
fn gradients(solution: &Solution, count: usize) -> Result<f64> {
    let ball = Paraboloid::new(RADIUS, RADIUS)?;
    let outputs = [
        Output::LocatedPeak,
        Output::Approach,
        Output::PressureNorm(8.0),
        Output::ParticipationArea,
        Output::Displacement([0.0, 0.0]),
        Output::Pressure([0.1, 0.1]),
    ];
    let plan = Linearisation::plan(solution, Some(&ball), &LinearOptions::default())?;
    let found = plan.gradients(&outputs[..count], None)?;
    Ok(found.iter().filter_map(|gradient| gradient.get("load")).sum())
}

fn benches(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("gradient");
    group.sample_size(10);
    for part in [0.33, 0.83] {
        let solution = solve(part).expect("valid");
        assert!(solution.report.converged());
        let name = |what: &str| BenchmarkId::new(what, format!("{:.0} %", 100.0 * part));
        group.bench_function(name("solve"), |bencher| {
            bencher.iter(|| black_box(solve(part)));
        });
        for (what, count) in [("one output", 1), ("six outputs", 6)] {
            let slope = gradients(&solution, count).expect("differentiable");
            assert!(slope > 0.0, "{slope}");
            group.bench_function(name(what), |bencher| {
                bencher.iter(|| black_box(gradients(&solution, count)));
            });
        }
    }
    let body = body().expect("valid");
    let parameters = body.parameters();
    let mut slopes = vec![0.0; parameters.len()];
    let value = normal_derivatives(&body, &parameters, 1.0, &mut slopes);
    assert!(value > 0.0 && slopes[0] < 0.0);
    group.bench_function("response", |bencher| {
        bencher.iter(|| normal_derivatives(black_box(&body), &parameters, 1.0, &mut slopes));
    });
    group.finish();
}

criterion_group!(gradient, benches);
criterion_main!(gradient);
