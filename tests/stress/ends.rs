//! Stress near a free end.

use nacre::{Elastic, Grid, HalfSpace, Result, Stress, StressOptions, StressPlan};
use ndarray::{Array2, Array3};

/// A smooth pressure of height 1 around (x, 0), with these half-widths.
fn smooth(grid: &Grid, x: f64, half: [f64; 2]) -> Array2<f64> {
    let bell = |t: f64| (1.0 - t * t).max(0.0).powi(3);
    let (xs, ys) = (grid.x(), grid.y());
    Array2::from_shape_fn((xs.len(), ys.len()), |(i, j)| {
        bell((xs[i] - x) / half[0]) * bell(ys[j] / half[1])
    })
}

/// Stress of a body with a free end at x = 0, on cells of side 1/n over 0 ≤ x ≤ 4, |y| ≤ 2.
fn near_end(n: usize, x: f64, depths: &[f64], poisson: f64) -> Result<Stress> {
    let body = HalfSpace::from(Elastic::new(1.0, poisson)?).with_ends([Some(0.0), None])?;
    // The first row of cells has its centres on the face.
    let half = 0.5 / n as f64;
    let grid = Grid::new([4 * n, 4 * n], [4.0, 4.0])?.centered_at([2.0 - half, 0.0])?;
    let pressure = smooth(&grid, x, [1.5, 1.5]);
    let start = std::time::Instant::now();
    let plan = StressPlan::plan(&body, &grid, &pressure, None)?;
    println!("plan {:.2} s", start.elapsed().as_secs_f64());
    let field = plan.stress(depths, &StressOptions::default())?;
    println!(
        "{} depths: {:.2} s",
        depths.len(),
        start.elapsed().as_secs_f64()
    );
    Ok(field)
}

/// Value on the face, from the three rows next to it.
fn on_face(field: &Array3<f64>, k: usize, j: usize) -> f64 {
    field[[k, 0, j]]
}

#[test]
fn the_face_is_free_of_traction() -> Result<()> {
    for poisson in [0.0, 0.3] {
        for x in [2.0, 1.6] {
            for n in [8, 16, 32] {
                let h = 1.0 / n as f64;
                let depths = [h, 2.0 * h, 0.25, 0.5, 1.0, 2.0, 4.0];
                let field = near_end(n, x, &depths, poisson)?;
                let mut worst = vec![[0.0_f64; 3]; depths.len()];
                for (k, worst) in worst.iter_mut().enumerate() {
                    for j in 0..4 * n {
                        for (c, component) in
                            [field.xx(), field.xy(), field.xz()].into_iter().enumerate()
                        {
                            worst[c] = worst[c].max(on_face(component, k, j).abs());
                        }
                    }
                }
                let text: Vec<String> = worst
                    .iter()
                    .map(|w| format!("{:.0e} {:.0e} {:.0e}", w[0], w[1], w[2]))
                    .collect();
                println!("nu {poisson} x {x} n {n}: {}", text.join(" | "));
            }
        }
    }
    Ok(())
}
