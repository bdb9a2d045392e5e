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
