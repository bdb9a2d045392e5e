//! Each iteration keeps its invariants.

use ndarray::Array2;

use super::Preconditioned;
use crate::compliance::convolution::Convolution;
use crate::compliance::influence::{Method, influence_coefficients};
use crate::compliance::response::Body;
use crate::contact::options::Motion;
use crate::contact::problem::bounds::{Bounds, Hardness};
use crate::contact::problem::freedoms::Freedoms;
use crate::contact::problem::{LocalDisplacement, Problem};
use crate::error::Result;
use crate::model::body::{HalfSpace, Layer};
use crate::model::grid::Grid;
use crate::model::material::Elastic;

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |a, b| a.max(b.abs()))
}

/// A gap as a function of x and y.
type GapOf<'a> = &'a dyn Fn(f64, f64) -> f64;

#[test]
fn each_iteration_keeps_its_invariants() -> Result<()> {
    let rough = |x: f64, y: f64| {
        let height = ((127.1 * x + 311.7 * y).sin() * 43758.5).fract();
        if x.hypot(y) > 1.3 { f64::INFINITY } else { 3e-4 * (x * x + y * y) + 1e-4 * height }
    };
    let crowned = |x: f64, y: f64| 1e-3 * y * y + 2e-4 * (x.abs() - 0.5).max(0.0).powi(2);
    let coat = Layer::new(Elastic::new(4.0, 0.2)?, 0.4)?;
    let coated = Body::from(HalfSpace::new(Elastic::new(1.0, 0.3)?, [coat])?);
    let bare = Body::from(Elastic::new(1.0, 0.0)?);
    let turned = Motion { moment: [Some(3e-5), Some(-5e-6)], ..Motion::load(1e-4) };
    let tilting = Motion { eccentricity: [Some(0.31), Some(-0.02)], ..Motion::load(1e-3) };
    let tilted = Motion { tilt: [Some(2e-4), Some(-1e-4)], ..Motion::approach(5e-4) };
    let gaps: [GapOf; 2] = [&rough, &crowned];
    for (body, motion, gap, limit) in [
        (&bare, Motion::load(1e-3), gaps[0], f64::INFINITY),
        (&coated, turned, gaps[0], f64::INFINITY),
        (&bare, tilting, gaps[1], f64::INFINITY),
        (&coated, Motion::load(1e-3), gaps[0], 4e-3),
        (&bare, tilted, gaps[1], f64::INFINITY),
    ] {
        keeps_its_invariants(body, &motion, gap, limit)?;
    }
    Ok(())
}

/// In each iteration, until the quality is 1e-10: u = K p, though it is a sum over the steps; a direction that is
/// not conjugate changes neither force nor moments, where the images are those of the contact; r is the overlap on
/// the contact; the pressure is within its bounds and in balance. To the rounding of some thousand cells.
fn keeps_its_invariants(body: &Body, motion: &Motion, gap: GapOf, limit: f64) -> Result<()> {
    let grid = Grid::new([60, 55], [3.0, 2.5])?;
    let [nx, ny] = grid.shape();
    let coefficients = influence_coefficients(body.clone(), &grid, Method::Exact)?;
    let convolution = Convolution::plan(&coefficients, Some(1))?;
    let approximation = convolution.approximation(&coefficients, [false; 2]);
    let freedoms = Freedoms::new(motion, &grid)?;
    let (x, y) = (grid.x(), grid.y());
    let mut h = Array2::from_shape_fn((nx, ny), |(i, j)| gap(x[i], y[j]));
    freedoms.prescribe(&mut h);
    let h = h.into_raw_vec_and_offset().0;
    let hardness = Hardness::Uniform(limit);
    let bounds = if limit.is_finite() { Bounds::of(&hardness, ny) } else { Bounds::none(ny) };
    let problem = Problem {
        convolution: &convolution,
        freedoms: &freedoms,
        gap: &h,
        local: &LocalDisplacement::new(&[body], &grid),
        bounds: &bounds,
    };
    let mut p: Vec<f64> = h.iter().map(|h| f64::from(u8::from(h.is_finite()))).collect();
    p.iter_mut().for_each(|p| *p *= 1e-4);
    assert!(freedoms.balance(&mut p, &bounds));
    let mut solver = Preconditioned::new(&problem, &approximation);
    solver.start(&p);
    let mut workspace = convolution.workspace();
    let (mut u, mut truncated) = (vec![0.0; p.len()], 0);
    for iteration in 0.. {
        assert!(iteration < 200, "{motion:?}: not converged");
        let quality = solver.assess(&p);
        problem.apply(&p, &mut u, &mut workspace);
        let scale = largest(u.iter().copied());
        let apart = largest(u.iter().zip(&solver.u).map(|(a, b)| a - b));
        assert!(apart <= 1e-12 * scale, "{motion:?} {iteration}: {apart:e}");
        freedoms.for_each(solver.lambda, |k, b| {
            let overlap = b - h[k] - u[k];
            if bounds.is_free(k, p[k]) {
                assert!((solver.r[k] - overlap).abs() <= 1e-12 * scale);
            } else if p[k] <= 0.0 {
                assert!((solver.r[k] - overlap.max(0.0)).abs() <= 1e-12 * scale);
            }
        });
        if quality.meets(1e-10) {
            break;
        }
        // A conjugate direction loses the balance of the cells that left since the last one.
        let fresh = iteration % 2 == 0;
        if fresh {
            solver.conjugacy.restart();
        }
        assert!(solver.step(&mut p), "{motion:?} {iteration}");
        let size: f64 = solver.direction.iter().map(|d| d.abs()).sum();
        let changed = freedoms.moments(&solver.direction);
        for k in (0..3).filter(|&k| fresh && !solver.stale && freedoms.loaded[k]) {
            assert!(
                changed[k].abs() <= 1e-13 * size,
                "{motion:?} {iteration}: {k} {:e}",
                changed[k] / size
            );
        }
        assert!((0..p.len()).all(|k| (0.0..=bounds.limit(k)).contains(&p[k])));
        assert!(freedoms.on_target(freedoms.moments(&p)), "{motion:?} {iteration}");
        truncated += usize::from(solver.losing);
    }
    assert!(truncated > 0, "{motion:?}: no step on which cells leave");
    Ok(())
}
