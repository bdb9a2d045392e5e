//! Extremes of the pressure, and an estimate of the area by level sets.

use super::state::{State, refused};
use crate::error::Result;

/// The largest and the second largest of `values`, with their numbers.
pub(super) fn largest(values: &[f64]) -> [(usize, f64); 2] {
    let mut found = [(0, f64::NEG_INFINITY); 2];
    for (k, &value) in values.iter().enumerate() {
        if value > found[0].1 {
            found = [(k, value), found[0]];
        } else if value > found[1].1 {
            found[1] = (k, value);
        }
    }
    found
}

/// Distance from the edge, in cells, of the pressures that set the level.
const INWARDS: usize = 3;

/// Area of the contact by level sets of p², and its derivative with respect to the pressure. Near the edge p² grows in
/// proportion to the distance, so that the area above a level t falls by a part in proportion to t, which 2A(t) − A(2t)
/// takes back:
///
/// ```text
/// A ≈ 2A(t) − A(2t)      A(t) = dA Σ S(p²/t)      S(u) = s² (3 − 2s), s = min(u/2, 1)
/// ```
///
/// t is the mean of p² three cells from the edge, and is kept while differentiating. The method is nacre's own.
///
/// # Errors
/// A contact without such cells.
pub(super) fn area_estimate(state: &State, area: f64) -> Result<(f64, Vec<f64>)> {
    let ny = state.tangent.window()[1].len();
    let nx = state.pressure.len() / ny;
    let mut left = state.tangent.contact.clone();
    for _ in 1..INWARDS {
        left = eroded(&left, [nx, ny]);
    }
    let inner = eroded(&left, [nx, ny]);
    let ring = left.iter().zip(&inner).map(|(left, inner)| *left && !inner);
    let squares: Vec<f64> = (ring.zip(&state.pressure))
        .filter_map(|(ring, p)| ring.then_some(p * p))
        .collect();
    if squares.is_empty() {
        return Err(refused(
            "its contact is too small for an estimate of the area: refine the grid",
        ));
    }
    let level = squares.iter().sum::<f64>() / squares.len() as f64;
    let mut total = 0.0;
    let slopes = state.pressure.iter().map(|p| {
        let step = |level: f64| {
            let s = (0.5 * p * p / level).min(1.0);
            let slope = if s < 1.0 {
                6.0 * s * (1.0 - s) * p / level
            } else {
                0.0
            };
            [s * s * (3.0 - 2.0 * s), slope]
        };
        let ([one, d_one], [two, d_two]) = (step(level), step(2.0 * level));
        total += area * (2.0 * one - two);
        area * (2.0 * d_one - d_two)
    });
    let slopes: Vec<f64> = slopes.collect();
    Ok((total, state.masked(&slopes)))
}

/// The cells all of whose neighbours along both axes are `inside`.
fn eroded(inside: &[bool], [nx, ny]: [usize; 2]) -> Vec<bool> {
    let at = |i: usize, j: usize| inside[i * ny + j];
    let cells = (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j)));
    cells
        .map(|(i, j)| {
            // A line contact is endless along x.
            let along = nx == 1 || i > 0 && i + 1 < nx && at(i - 1, j) && at(i + 1, j);
            at(i, j) && along && j > 0 && j + 1 < ny && at(i, j - 1) && at(i, j + 1)
        })
        .collect()
}
