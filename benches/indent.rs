//! Benchmarks of indentations; `benches/README.md` describes each.
//!
//! Inputs are fixed, and results are asserted once before timing. All run on one thread.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use nacre::indent::{Indent, IndentParameter, Stack, Tip};
use nacre::{Body, BodyParameter, Elastic, HalfSpace, Layer, Result};
use std::hint::black_box;

fn body() -> Result<Body> {
    let coat = Layer::new(Elastic::new(4.0, 0.3)?, 1.0)?;
    Ok(HalfSpace::new(Elastic::new(1.0, 0.3)?, [coat])?.into())
}

fn indent() -> Result<Indent> {
    Ok(Indent::new(&Stack::plan(&[body()?])?, &Tip::paraboloid(10.0)?))
}

/// A curve of 60 points up to a contact radius of 3 layers, with three derivatives.
fn curve(indent: &Indent, approaches: &[f64]) -> Result<f64> {
    let parameters = [
        IndentParameter::Body(0, BodyParameter::Young(0)),
        IndentParameter::Body(0, BodyParameter::Young(1)),
        IndentParameter::Body(0, BodyParameter::Thickness(0)),
    ];
    let curve = indent.curve(approaches, &parameters)?;
    Ok(curve.load[approaches.len() - 1])
}

fn run(criterion: &mut Criterion) -> Result<()> {
    let planned = indent()?;
    let mut group = criterion.benchmark_group("indent");
    group.bench_function("plan", |b| b.iter(|| indent().and_then(|i| i.at_radius(0.3)).ok()));
    for ratio in [0.3, 1.0, 3.0, 30.0] {
        assert!(planned.at_radius(ratio)?.load > 0.0);
        group.bench_function(BenchmarkId::new("point", ratio), |b| {
            b.iter(|| planned.at_radius(black_box(ratio)).ok());
        });
    }
    let deepest = planned.at_radius(3.0)?;
    let approaches: Vec<f64> = (1..=60).map(|k| deepest.approach * f64::from(k) / 60.0).collect();
    assert!((curve(&planned, &approaches)? / deepest.load - 1.0).abs() < 1e-8);
    group.bench_function("curve", |b| {
        b.iter(|| indent().and_then(|indent| curve(&indent, black_box(&approaches))).ok());
    });
    group.bench_function("load", |b| b.iter(|| planned.at_load(black_box(1.0)).ok()));
    group.finish();
    Ok(())
}

fn bench(criterion: &mut Criterion) {
    if let Err(error) = run(criterion) {
        panic!("{error}");
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
