//! Benchmarks of the steps of the chain; `benches/README.md` describes each.
//!
//! Inputs are fixed, and results are asserted once before timing. Benchmarks run on one thread unless
//! the id says otherwise.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use nacre::conductance::Conductor;
use nacre::influence::{CellInfluence, Method, influence_coefficients};
use nacre::{
    Algorithm, Contact, Convolution, Cylinder, Elastic, Grid, HalfSpace, Layer, Motion, Options,
    Paraboloid, Result, Roller, Setup, Solution, StressOptions, Surface, stress,
};
use ndarray::Array2;

const HERTZ_RADIUS: f64 = 1e3;

/// A coating of E1/E2 = 4 in `layers` equal layers, together 8 cells of unit size thick.
fn coated(layers: usize) -> Result<HalfSpace> {
    let hard = Elastic::new(4.0, 0.3)?;
    let layer = Layer::new(hard, 8.0 / layers as f64)?;
    HalfSpace::new(Elastic::new(1.0, 0.3)?, vec![layer; layers])
}

/// A square of n² cells of unit size.
fn square(n: usize) -> Result<Grid> {
    Grid::new([n, n], [n as f64; 2])
}

fn response(c: &mut Criterion) {
    let mut group = c.benchmark_group("response");
    for layers in [1, 10] {
        let body = coated(layers).expect("valid");
        let wavenumbers: Vec<f64> = (0..1024).map(|k| 1e-3 * 1.01_f64.powi(k)).collect();
        group.throughput(Throughput::Elements(wavenumbers.len() as u64));
        group.bench_function(BenchmarkId::new("layers", layers), |b| {
            b.iter(|| {
                let responses = wavenumbers
                    .iter()
                    .map(|&alpha| nacre::response::frequency_response(&body, alpha));
                responses.sum::<Result<f64>>()
            });
        });
    }
    group.finish();
}

fn coefficients(c: &mut Criterion) {
    let mut group = c.benchmark_group("coefficients");
    group.sample_size(10);
    let bare = HalfSpace::from(Elastic::new(1.0, 0.3).expect("valid"));
    let (one, ten) = (coated(1).expect("valid"), coated(10).expect("valid"));
    for n in [128, 512, 1024] {
        let grid = square(n).expect("valid");
        group.throughput(Throughput::Elements((n * n) as u64));
        for (name, body) in [("bare", &bare), ("coated", &one), ("ten_layers", &ten)] {
            group.bench_function(BenchmarkId::new(name, n), |b| {
                b.iter(|| influence_coefficients(body, &grid, Method::Exact));
            });
        }
    }
    let grid = square(128).expect("valid");
    let image = Method::Image { refinement: 4 };
    group.bench_function("image/128", |b| b.iter(|| influence_coefficients(&one, &grid, image)));
    group.bench_function("tables", |b| b.iter(|| CellInfluence::plan(&one, [1.0; 2], 1500.0)));
    group.finish();
}

fn convolution(c: &mut Criterion) {
    let mut group = c.benchmark_group("convolution");
    group.sample_size(20);
    let bare = HalfSpace::from(Elastic::new(1.0, 0.3).expect("valid"));
    for n in [128, 256, 512, 1024] {
        let grid = square(n).expect("valid");
        let coefficients = influence_coefficients(&bare, &grid, Method::Exact).expect("valid");
        group.throughput(Throughput::Elements((n * n) as u64));
        group.bench_function(BenchmarkId::new("plan", n), |b| {
            b.iter(|| Convolution::plan(&coefficients, Some(1)));
        });
        for (name, threads) in [("apply", 1), ("apply_two_threads", 2)] {
            let convolution = Convolution::plan(&coefficients, Some(threads)).expect("valid");
            let mut workspace = convolution.workspace();
            let mut point = Array2::zeros((n, n));
            point[[0, 0]] = 1.0;
            let mut out = Array2::zeros((n, n));
            convolution.apply_into(&point, &mut out, &mut workspace).expect("same shape");
            assert!((&out - &coefficients).iter().all(|d| d.abs() < 1e-14 * coefficients[[0, 0]]));
            group.bench_function(BenchmarkId::new(name, n), |b| {
                b.iter(|| convolution.apply_into(black_box(&point), &mut out, &mut workspace));
            });
        }
    }
    group.finish();
}

fn hertz(n: usize, threads: usize) -> Result<(Contact, Paraboloid, Motion)> {
    let grid = Grid::new([n, n], [2.0, 2.0])?;
    let setup = Setup::default().with_threads(threads);
    let contact = Contact::plan(Elastic::new(1.0, 0.0)?, grid, setup)?;
    // The load 4/3 E* a³/R for a contact radius a of a third.
    let load = 4.0 / 81.0 / HERTZ_RADIUS;
    Ok((contact, Paraboloid::new(HERTZ_RADIUS, HERTZ_RADIUS)?, Motion::load(load)))
}

fn converged(
    contact: &Contact,
    shape: &dyn Surface,
    motion: &Motion,
    options: &Options,
) -> Solution {
    let solution = contact.solve(shape, motion, options).expect("valid");
    assert!(solution.report.converged());
    solution
}

fn contact(c: &mut Criterion) {
    let mut group = c.benchmark_group("contact");
    group.sample_size(10);
    let options = Options::default();
    for n in [128, 256, 512, 1024] {
        for (name, threads) in [("hertz", 1), ("hertz_two_threads", 2)] {
            let (contact, shape, motion) = hertz(n, threads).expect("valid");
            let solution = converged(&contact, &shape, &motion, &options);
            assert!((solution.approach * HERTZ_RADIUS * 9.0 - 1.0).abs() < 1e-3);
            group.bench_function(BenchmarkId::new(name, n), |b| {
                b.iter(|| converged(&contact, &shape, &motion, &options));
            });
        }
    }
    let reference = Options::default().with_algorithm(Algorithm::PolonskyKeer);
    let (plan, shape, motion) = hertz(256, 1).expect("valid");
    group.bench_function("hertz_polonsky_keer/256", |b| {
        b.iter(|| converged(&plan, &shape, &motion, &reference));
    });
    // A ball through a coating that conducts four times as well.
    let (plan, shape, motion) = hertz(256, 1).expect("valid");
    let solution = converged(&plan, &shape, &motion, &options);
    let conductors = || -> Result<[Conductor; 2]> {
        let body = Conductor::homogeneous(1.0)?.below_layer(4.0, 0.1, 0.0)?;
        Ok([body, Conductor::homogeneous(f64::INFINITY)?])
    };
    let resistance = |solution: &Solution| {
        let conductance = solution.conductance(conductors()?, None, None)?;
        Result::Ok(conductance.resistance)
    };
    // Between a coating and a substrate of that conductivity throughout.
    assert!((0.25 * 0.75..0.75).contains(&resistance(&solution).expect("valid")));
    group.bench_function("conductance/256", |b| b.iter(|| resistance(&solution)));
    let (plan, motion) = roller().expect("valid");
    let shape = Roller::new(5e-3, 19.13e-3, 7.5).expect("valid");
    group.bench_function("roller/1024x128", |b| {
        b.iter(|| converged(&plan, &shape, &motion, &options));
    });
    group.finish();
}

/// A straight roller of 20 half-widths on a race, whose ends are free or none: half-width and pressure of Hertz's line
/// are 1.
fn straight(ends: [Option<f64>; 2]) -> Result<Contact> {
    let race = HalfSpace::from(Elastic::new(0.91, 0.3)?);
    let setup = Setup::default().with_counterbody(race.clone().with_ends(ends)?).with_threads(1);
    Contact::plan(&race, Grid::new([1024, 128], [20.0, 4.0])?, setup)
}

fn free_ends(c: &mut Criterion) {
    let mut group = c.benchmark_group("ends");
    group.sample_size(10);
    let shape = Cylinder::new(0.25).expect("valid");
    let (motion, options) = (Motion::load(10.0 * std::f64::consts::PI), Options::default());
    for (name, ends) in [
        ("none", [None; 2]),
        ("quarter_space", [Some(-10.0), None]),
        ("plate", [Some(-10.0), Some(10.0)]),
    ] {
        let contact = straight(ends).expect("valid");
        let solution = converged(&contact, &shape, &motion, &options);
        assert!(solution.peak_pressure() > 1.0);
        group.bench_function(BenchmarkId::new("plan", name), |b| b.iter(|| straight(ends)));
        group.bench_function(BenchmarkId::new("solve", name), |b| {
            b.iter(|| converged(&contact, &shape, &motion, &options));
        });
    }
    group.finish();
}

/// The roller of Spinu et al., E1/E2 = 4, under an off-centre force.
fn roller() -> Result<(Contact, Motion)> {
    let steel = Elastic::new(210e9, 0.3)?;
    let body = HalfSpace::new(steel, [Layer::new(Elastic::new(840e9, 0.3)?, 40e-6)?])?;
    let grid = Grid::new([1024, 128], [29e-3, 0.16e-3])?;
    let setup = Setup::default().with_threads(1);
    let motion = Motion::load(1e3).with_eccentricity([Some(2.8695e-3), Some(0.0)]);
    Ok((Contact::plan(&body, grid, setup)?, motion))
}

fn interior(c: &mut Criterion) {
    let mut group = c.benchmark_group("stress");
    group.sample_size(10);
    let body = coated(1).expect("valid");
    let depths: Vec<f64> = (0..16).map(|k| 0.5 + f64::from(k)).collect();
    let options = StressOptions::default().with_threads(1);
    for n in [128, 512] {
        let grid = square(n).expect("valid");
        let inside = |i: usize| (n / 4..3 * n / 4).contains(&i);
        let pressure =
            Array2::from_shape_fn((n, n), |(i, j)| f64::from(u8::from(inside(i) && inside(j))));
        let field = stress(&body, &grid, &pressure, &[0.0], &options).expect("valid");
        assert!((field.zz()[[0, n / 2, n / 2]] + 1.0).abs() < 1e-12);
        group.throughput(Throughput::Elements((16 * n * n) as u64));
        group.bench_function(BenchmarkId::new("depths16", n), |b| {
            b.iter(|| stress(&body, &grid, &pressure, &depths, &options));
        });
    }
    group.finish();
}

criterion_group!(chain, response, coefficients, convolution, contact, free_ends, interior);
criterion_main!(chain);
