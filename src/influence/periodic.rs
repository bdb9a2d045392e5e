//! Influence coefficients of grids that repeat: sums of the coefficients of one cell over its images.
//!
//! Images nearer than the longer period are summed one by one. The others together are smooth, and interpolated from
//! Chebyshev nodes. There, M rings of them are summed; all beyond have the means of the kernel over whole periods, which
//! are everything less the displacement U under one rectangle of (2M + 1)² periods. With central differences δ over a
//! period L, and cells of length rL,
//!
//! ```text
//! Σ K(x + kL) = const − (1 + (r² − 1) δ²/24 + (r² − 1)(r² − 9) δ⁴/1920 + …) U     from sinh(r asinh s)/(r s), s = δ/2
//! ```
//!
//! along each direction. A constant is left, which the mean displacement fixes: under a pressure everywhere it is
//! û/p̂(0) on a rigid base, and taken as 0 otherwise; where one direction is open, it is that of the line contact. The
//! method is nacre's own.

use std::f64::consts::PI;

use ndarray::{Array2, Axis, Zip};

use super::exact::{CellInfluence, WHOLE_CELLS};
use super::line;
use crate::error::{Error, Result};
use crate::fft::inverse_even;
use crate::grid::Grid;
use crate::parallel::Threads;
use crate::response::Response;

/// Distance of the end of the sums, in longest lengths of what is summed. What the differences leave falls as its ninth
/// power, and is 1e-10 of the coefficient of the loaded cell.
const RINGS: f64 = 16.0;

/// Chebyshev nodes along each direction: images that are summed lie as far away as the interval is long.
const NODES: usize = 20;

/// Coefficients (nx, ny) \[m/Pa\] without the local compliance; C\[n − i\] = C\[i\] along periodic directions.
pub(super) fn coefficients(
    body: &dyn Response,
    grid: &Grid,
    threads: &Threads,
) -> Result<Array2<f64>> {
    let (spacing, size, periodic) = (grid.spacing(), grid.size(), grid.is_periodic());
    let longest = size[0].max(size[1]);
    // Offsets that are computed: half a period, or all.
    let kept = [0, 1].map(|k| match periodic[k] {
        true => grid.shape()[k] / 2 + 1,
        false => grid.shape()[k],
    });
    let span = [0, 1].map(|k| match periodic[k] {
        true => 0.5 * size[k],
        false => size[k],
    });
    let images = |distance: f64| {
        [0, 1].map(|k| match periodic[k] {
            true => (distance / size[k]).ceil() as i64,
            false => 0,
        })
    };
    let (near, all) = (images(longest), images(RINGS * longest));
    let cell = CellInfluence::plan_on(
        body,
        spacing,
        WHOLE_CELLS,
        2.0 * (RINGS + 2.0) * longest,
        threads,
    )?;
    let block = Block::plan(body, grid, all, threads)?;
    // Images from −(near − 1) to near along a periodic direction, the middle of which is that of the offsets.
    let range = |k: usize| match periodic[k] {
        true => 1 - near[k]..=near[k],
        false => 0..=0,
    };
    let place =
        |at: [f64; 2], [k, l]: [i64; 2]| [at[0] - k as f64 * size[0], at[1] - l as f64 * size[1]];
    let nodes = span.map(chebyshev);
    let mut far = Array2::zeros((NODES, NODES));
    let [xs, ys] = [0, 1].map(|k| interpolation(&nodes[k], spacing[k], kept[k]));
    let mut result = Array2::zeros((kept[0], kept[1]));
    threads.run(|| {
        Zip::indexed(&mut far).par_for_each(|(a, b), sum| {
            let at = [nodes[0][a], nodes[1][b]];
            for k in -all[0]..=all[0] {
                for l in -all[1]..=all[1] {
                    if !(range(0).contains(&k) && range(1).contains(&l)) {
                        *sum += cell.at_distance(place(at, [k, l]));
                    }
                }
            }
            *sum -= block.at(at);
        });
        let smooth = xs.dot(&far).dot(&ys.t());
        Zip::indexed(&mut result)
            .and(&smooth)
            .par_for_each(|(i, j), c, smooth| {
                let at = [i as f64 * spacing[0], j as f64 * spacing[1]];
                *c = *smooth;
                for k in range(0) {
                    for l in range(1) {
                        *c += cell.at_distance(place(at, [k, l]));
                    }
                }
            });
    });
    let [nx, ny] = grid.shape();
    let folded = |i: usize, n: usize, periodic: bool| if periodic { i.min(n - i) } else { i };
    let mut whole = Array2::from_shape_fn((nx, ny), |(i, j)| {
        result[[folded(i, nx, periodic[0]), folded(j, ny, periodic[1])]]
    });
    if periodic == [true; 2] {
        let mean = whole.sum() / (nx * ny) as f64;
        whole += uniform(body) / (nx * ny) as f64 - mean;
    } else {
        let open = usize::from(periodic[0]);
        let strips = Grid::line(grid.shape()[open], size[open])?;
        let strips = line::coefficients(body, &strips, threads)?;
        for (mut line, strip) in whole.axis_iter_mut(Axis(open)).zip(&strips) {
            let mean = line.sum() / line.len() as f64;
            line += strip / line.len() as f64 - mean;
        }
    }
    Ok(whole)
}

/// Coefficients with which waves of the grid are displaced by û/p̂ at their wave number.
///
/// # Errors
/// Unless both directions are periodic.
pub(super) fn sampled(body: &dyn Response, grid: &Grid, threads: &Threads) -> Result<Array2<f64>> {
    if grid.is_periodic() != [true; 2] {
        return Err(Error::Inconsistent(
            "method \"spectral\" needs a grid that is periodic along x and along y",
        ));
    }
    let step = grid.size().map(|length| 2.0 * PI / length);
    let response = |k: usize, l: usize| {
        let alpha = (k as f64 * step[0]).hypot(l as f64 * step[1]);
        match alpha > 0.0 {
            true => body.normal(alpha) / alpha,
            false => uniform(body),
        }
    };
    Ok(inverse_even(grid.shape(), grid.shape(), response, threads))
}

/// Displacement under a unit pressure everywhere, on a rigid base; 0 on an elastic one, without the local compliance.
fn uniform(body: &dyn Response) -> f64 {
    let limits = body.asymptotes();
    match limits.long > 0.0 {
        true => 0.0,
        false => limits.constant,
    }
}

/// The displacement under a rectangle of many periods, with the differences that turn it into a sum.
struct Block {
    cell: CellInfluence,
    /// Area of a cell over that of a period.
    share: f64,
    periods: [f64; 2],
    /// Weights of 1, δ², δ⁴ and δ⁶.
    weights: [[f64; 4]; 2],
}

impl Block {
    fn plan(body: &dyn Response, grid: &Grid, images: [i64; 2], threads: &Threads) -> Result<Self> {
        let (spacing, periodic) = (grid.spacing(), grid.is_periodic());
        // An open direction has the cell itself.
        let periods = [0, 1].map(|k| match periodic[k] {
            true => grid.size()[k],
            false => spacing[k],
        });
        let sides = [0, 1].map(|k| (2 * images[k] + 1) as f64 * periods[k]);
        let ratios = [0, 1].map(|k| (spacing[k] / periods[k]).powi(2));
        let reach = 3.0 * (grid.size()[0] + grid.size()[1]);
        Ok(Self {
            cell: CellInfluence::plan_on(body, sides, NEAREST, reach, threads)?,
            share: spacing[0] * spacing[1] / (periods[0] * periods[1]),
            periods,
            weights: ratios.map(|r| {
                let [second, fourth] = [(r - 1.0) / 24.0, (r - 9.0) / 80.0];
                [
                    1.0,
                    second,
                    second * fourth,
                    second * fourth * (r - 25.0) / 168.0,
                ]
            }),
        })
    }

    fn at(&self, at: [f64; 2]) -> f64 {
        let [along, across] = self.weights.map(stencil);
        let mut sum = 0.0;
        for (k, a) in (-3..=3).zip(along) {
            for (l, b) in (-3..=3).zip(across) {
                if a * b != 0.0 {
                    let place = [
                        at[0] + f64::from(k) * self.periods[0],
                        at[1] + f64::from(l) * self.periods[1],
                    ];
                    sum += a * b * self.cell.at_distance(place);
                }
            }
        }
        self.share * sum
    }
}

/// Distance of the offsets from the corners of a block, in its shorter sides, at least.
const NEAREST: f64 = 1e-3;

/// Weights of the places −3, …, 3 for those of 1, δ², δ⁴ and δ⁶.
fn stencil([one, second, fourth, sixth]: [f64; 4]) -> [f64; 7] {
    let middle = one - 2.0 * second + 6.0 * fourth - 20.0 * sixth;
    let first = second - 4.0 * fourth + 15.0 * sixth;
    let next = fourth - 6.0 * sixth;
    [sixth, next, first, middle, first, next, sixth]
}

/// Chebyshev nodes on \[0, span\].
fn chebyshev(span: f64) -> Vec<f64> {
    let angle = |k: usize| PI * (k as f64 + 0.5) / NODES as f64;
    (0..NODES)
        .map(|k| 0.5 * span * (1.0 - angle(k).cos()))
        .collect()
}

/// Matrix (count, nodes) from values at the nodes to those at whole `spacing`s from 0 on, in barycentric form.
fn interpolation(nodes: &[f64], spacing: f64, count: usize) -> Array2<f64> {
    let weight = |k: usize| {
        let angle = PI * (k as f64 + 0.5) / NODES as f64;
        if k.is_multiple_of(2) {
            angle.sin()
        } else {
            -angle.sin()
        }
    };
    let mut matrix = Array2::zeros((count, nodes.len()));
    for (i, mut row) in matrix.axis_iter_mut(Axis(0)).enumerate() {
        let x = i as f64 * spacing;
        if let Some(k) = nodes
            .iter()
            .position(|node| (node - x).abs() < 1e-14 * spacing)
        {
            row[k] = 1.0;
            continue;
        }
        for (k, value) in row.iter_mut().enumerate() {
            *value = weight(k) / (x - nodes[k]);
        }
        let sum = row.sum();
        row /= sum;
    }
    matrix
}
