//! Grids that repeat.

use std::f64::consts::PI;

use nacre::influence::{Method, influence_coefficients};
use nacre::{
    Contact, Elastic, Grid, HalfSpace, HeightMap, Layer, Motion, Options, Result, Setup, Substrate,
    response::frequency_response,
};
use ndarray::Array2;

/// Bodies: bare, thin and thick coats, a layer on a rigid base.
fn bodies(dx: f64) -> Result<Vec<HalfSpace>> {
    let (soft, hard) = (Elastic::new(1.0, 0.3)?, Elastic::new(5.0, 0.2)?);
    let mut bodies = vec![soft.into()];
    for h in [0.01, 1.0, 100.0] {
        bodies.push(HalfSpace::new(soft, [Layer::new(hard, h * dx)?])?);
    }
    bodies.push(HalfSpace::new(
        Substrate::Rigid,
        [Layer::new(hard, 3.0 * dx)?],
    )?);
    Ok(bodies)
}

/// Eigenvalue of the coefficients for the wave (k, l), which the DFT has.
fn eigenvalue(c: &Array2<f64>, [k, l]: [usize; 2]) -> f64 {
    let (nx, ny) = c.dim();
    c.indexed_iter()
        .map(|((i, j), c)| {
            let x = 2.0 * PI * (k * i) as f64 / nx as f64;
            let y = 2.0 * PI * (l * j) as f64 / ny as f64;
            c * x.cos() * y.cos()
        })
        .sum()
}

#[test]
fn coefs() -> Result<()> {
    for (n, d) in [
        ([32, 32], [1.0, 1.0]),
        ([32, 32], [20.0, 1.0]),
        ([30, 64], [1.0, 1.0]),
    ] {
        for (b, body) in bodies(1.0)?.into_iter().enumerate() {
            let grid =
                Grid::new(n, [n[0] as f64 * d[0], n[1] as f64 * d[1]])?.periodic([true; 2])?;
            let t = std::time::Instant::now();
            let c = influence_coefficients(&body, &grid, Method::Exact)?;
            let time = t.elapsed();
            let own = c[[0, 0]];
            let mut worst = [0.0_f64; 2];
            for (axis, k) in [(0, 1), (0, 5), (0, 15), (1, 1), (1, 7)] {
                let wave = if axis == 0 { [k, 0] } else { [0, k] };
                let found = eigenvalue(&c, wave);
                let step = 2.0 * PI / (n[axis] as f64 * d[axis]);
                // Aliases: the terms alternate; the mean of two sums.
                let term = |m: i64| -> f64 {
                    let alpha = step * (k as f64 + m as f64 * n[axis] as f64);
                    let x = 0.5 * alpha * d[axis];
                    frequency_response(&body, alpha.abs()).unwrap() * x.sin() / x
                };
                let mut sum = term(0);
                let m = 20000;
                for a in 1..m {
                    sum += term(a) + term(-a);
                }
                sum += 0.5 * (term(m) + term(-m));
                let e = (found - sum).abs() / own;
                worst[axis] = worst[axis].max(e);
            }
            println!("{n:?} {d:?} body {b}: {worst:?} own {own} time {time:?}");
        }
    }
    Ok(())
}

/// A periodic map of heights on the cells of `grid`.
fn map(grid: &Grid, height: impl Fn(f64, f64) -> f64) -> Result<HeightMap> {
    let (x, y) = (grid.x(), grid.y());
    let heights = Array2::from_shape_fn((x.len(), y.len()), |(i, j)| height(x[i], y[j]));
    HeightMap::new(heights, grid.spacing())?.periodic(grid.is_periodic())
}

#[test]
fn full() -> Result<()> {
    for n in [32, 64, 128] {
        for (b, body) in bodies(0.3)?.into_iter().enumerate() {
            for method in [Method::Spectral, Method::Exact] {
                let grid = Grid::new([n, n], [10.0, 10.0])?.periodic([true; 2])?;
                let setup = Setup { method, threads: Some(1), ..Setup::default() };
                let contact = Contact::plan(&body, grid, setup)?;
                let (k, amp) = (2.0 * PI / 10.0, 1e-3);
                let shape = map(&grid, |x, y| amp * (k * x).cos() * (k * y).cos())?;
                let c11 = frequency_response(&body, k * 2.0_f64.sqrt())?;
                let peak = amp / c11;
                let motion = Motion::load(1.5 * peak * 100.0);
                let t = std::time::Instant::now();
                let s = contact.solve(&shape, &motion, &Options { tolerance: 1e-12, ..Options::default() })?;
                let time = t.elapsed();
                let (x, y) = (grid.x(), grid.y());
                let mut worst = 0.0_f64;
                for ((i, j), p) in s.pressure.indexed_iter() {
                    worst = worst.max((p - peak * (1.5 + (k * x[i]).cos() * (k * y[j]).cos())).abs() / peak);
                }
                println!("{n} body {b} {method:?}: {worst:e} conv {} it {} {:?} warn {:?} res {:e} {time:?}", s.report.convolutions, s.report.iterations, s.report.termination, s.report.warnings, s.report.residual);
            }
        }
    }
    Ok(())
}

#[test]
fn westergaard() -> Result<()> {
    for n in [256, 1024] {
    let grid = Grid::new([2, n], [2.0 / n as f64, 1.0])?.periodic([true; 2])?;
    let contact = Contact::plan(Elastic::new(1.0, 0.0)?, grid, Setup::default())?;
    let amp = 1e-3;
    let shape = map(&grid, |_, y| amp * (2.0 * PI * y).cos())?;
    let full = PI * amp;
    for share in [0.1, 0.3, 0.5, 0.7, 0.9] {
        let mean = share * full;
        let s = contact.solve(&shape, &Motion::load(mean * 2.0 / n as f64), &Options::default())?;
        let a = share.sqrt().asin() / PI;
        let mut worst = 0.0_f64;
        let dy = grid.spacing()[1];
        for (j, y) in grid.y().iter().enumerate() {
            if y.abs() < a - 2.0 * dy {
                let exact = 2.0 * mean * (PI * y).cos() / (PI * a).sin().powi(2) * ((PI * a).sin().powi(2) - (PI * y).sin().powi(2)).sqrt();
                worst = worst.max((s.pressure[[0, j]] / exact - 1.0).abs());
            }
        }
        let width = s.pressure.row(0).iter().filter(|p| **p > 0.0).count() as f64 * dy;
        println!("W {n} {share}: {worst:e} width {} {:?} {:?}", (0.5 * width - a) / dy, s.report.termination, s.report.warnings);
    }
    }
    Ok(())
}

#[test]
fn semi() -> Result<()> {
    // constant along y: line contact.
    let body = HalfSpace::new(Elastic::new(1.0, 0.3)?, [Layer::new(Elastic::new(4.0, 0.3)?, 0.3)?])?;
    for periodic in [[false, true], [true, false]] {
        let (n, m) = (128, 32);
        let (shape, size) = if periodic[1] { ([n, m], [4.0, 1.0]) } else { ([m, n], [1.0, 4.0]) };
        let grid = Grid::new(shape, size)?.periodic(periodic)?;
        let contact = Contact::plan(&body, grid, Setup::default())?;
        let s = contact.solve(&nacre::Paraboloid::new(if periodic[1] {50.0} else {1e30}, if periodic[1] {1e30} else {50.0})?, &Motion::load(0.02), &Options::default())?;
        let line = Contact::plan(&body, Grid::line(n, 4.0)?, Setup::default())?;
        let l = line.solve(&nacre::Cylinder::new(50.0)?, &Motion::load(0.02), &Options::default())?;
        let mut worst = 0.0_f64;
        for ((i, j), p) in s.pressure.indexed_iter() {
            let k = if periodic[1] { i } else { j };
            worst = worst.max((p - l.pressure[[0, k]]).abs() / l.peak_pressure());
        }
        println!("semi {periodic:?} {worst:e} approach {} {} {:?} {:?}", s.approach, l.approach, s.report.termination, s.report.warnings);
    }
    Ok(())
}

#[test]
fn rough() -> Result<()> {
    for n in [128, 256] {
        let grid = Grid::new([n, n], [1.0, 1.0])?.periodic([true; 2])?;
        let contact = Contact::plan(Elastic::new(1.0, 0.0)?, grid, Setup { threads: Some(1), ..Setup::default() })?;
        let shape = map(&grid, |x, y| {
            let mut h = 0.0;
            let mut s = 1u64;
            for k in 1..9 { for l in 0..9 {
                s = s.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                let ph = (s >> 11) as f64 / 2f64.powi(53) * 2.0 * PI;
                let q = ((k * k + l * l) as f64).sqrt();
                h += q.powf(-1.8) * (2.0 * PI * (k as f64 * x + l as f64 * y) + ph).cos();
            }}
            h * 0.01
        })?;
        for p in [0.001, 0.01, 0.1] {
            for motion in [Motion::load(p)] {
                let t = std::time::Instant::now();
                let s = contact.solve(&shape, &motion, &Options::default())?;
                println!("rough {n} {p}: area {} conv {} it {} {:?} {:?} approach {} warn {:?} {:?}", s.contact_area(), s.report.convolutions, s.report.iterations, s.report.solver, s.report.termination, s.approach, s.report.warnings, t.elapsed());
                let b = contact.solve(&shape, &Motion::approach(s.approach), &Options::default())?;
                println!("   back load {} {:?} it {}", b.load(), b.report.termination, b.report.iterations);
            }
        }
    }
    Ok(())
}
