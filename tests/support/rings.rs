//! The contact of a rigid sphere with a half-space whose pressure has a limit, by rings of uniform pressure.

use std::f64::consts::PI;

use crate::support::numerics::elliptic;

/// Rings of equal width, on a half-space with E* = 1.
pub(crate) struct Rings {
    width: f64,
    middles: Vec<f64>,
    /// Displacement in the middle of each ring under unit pressure on each.
    influence: Vec<Vec<f64>>,
}

impl Rings {
    pub(crate) fn new(outer: f64, count: usize) -> Self {
        let width = outer / count as f64;
        let middles: Vec<f64> = (0..count).map(|k| (k as f64 + 0.5) * width).collect();
        let row = |r: &f64| {
            let disc = |k: usize| disc_displacement(*r, k as f64 * width);
            (0..count).map(|k| disc(k + 1) - disc(k)).collect()
        };
        let influence = middles.iter().map(row).collect();
        Self { width, middles, influence }
    }

    fn area(&self, k: usize) -> f64 {
        2.0 * PI * self.middles[k] * self.width
    }

    /// Pressure and approach under a load: each ring is open, in contact or at the hardness, and changes its state
    /// until none has to.
    pub(crate) fn solve(&self, radius: f64, load: f64, hardness: f64) -> (Vec<f64>, f64) {
        let count = self.middles.len();
        let gap = |k: usize| self.middles[k].powi(2) / (2.0 * radius);
        let mut p = vec![0.0; count];
        // From Hertz' contact on.
        let a = (0.75 * load * radius).cbrt();
        let mut open: Vec<bool> = self.middles.iter().map(|r| *r > a).collect();
        let mut held = vec![false; count];
        for _ in 0..100 {
            let free: Vec<usize> = (0..count).filter(|&k| !open[k] && !held[k]).collect();
            let at_limit = (0..count).filter(|&k| held[k]);
            let borne: f64 = at_limit.clone().map(|k| hardness * self.area(k)).sum();
            // K p − δ = −h − K H, and the balance of forces.
            let mut rows: Vec<Vec<f64>> = free
                .iter()
                .map(|&i| {
                    let mut row: Vec<f64> = free.iter().map(|&k| self.influence[i][k]).collect();
                    let under: f64 =
                        at_limit.clone().map(|k| hardness * self.influence[i][k]).sum();
                    row.extend([-1.0, -gap(i) - under]);
                    row
                })
                .collect();
            let mut last: Vec<f64> = free.iter().map(|&k| self.area(k)).collect();
            last.extend([0.0, load - borne]);
            rows.push(last);
            let solution = eliminated(rows);
            let approach = solution[free.len()];
            p.fill(0.0);
            for k in 0..count {
                p[k] = if held[k] { hardness } else { 0.0 };
            }
            for (k, value) in free.iter().zip(&solution) {
                p[*k] = *value;
            }
            let mut changed = false;
            for k in 0..count {
                let g = self.gap_at(k, radius, &p, approach);
                let state = match (open[k], held[k]) {
                    (true, _) => (g >= 0.0, false),
                    (_, true) => (false, g <= 0.0),
                    _ => (p[k] < 0.0, p[k] > hardness),
                };
                changed |= state != (open[k], held[k]);
                (open[k], held[k]) = state;
            }
            if !changed {
                return (p, approach);
            }
        }
        panic!("the states of the rings go round in circles");
    }

    fn gap_at(&self, k: usize, radius: f64, p: &[f64], approach: f64) -> f64 {
        let u: f64 = self.influence[k].iter().zip(p).map(|(c, p)| c * p).sum();
        self.middles[k].powi(2) / (2.0 * radius) + u - approach
    }

    pub(crate) fn dent(&self, radius: f64, p: &[f64], approach: f64, hardness: f64) -> Vec<f64> {
        let of = |k: usize| match p[k] >= hardness {
            true => (-self.gap_at(k, radius, p, approach)).max(0.0),
            false => 0.0,
        };
        (0..p.len()).map(of).collect()
    }

    /// Linear interpolation between the middles.
    pub(crate) fn at(&self, values: &[f64], r: f64) -> f64 {
        let position = (r / self.width - 0.5).max(0.0);
        let below = position as usize;
        let value = |k: usize| values.get(k).copied().unwrap_or(0.0);
        let part = position - below as f64;
        value(below) * (1.0 - part) + value(below + 1) * part
    }
}

/// Displacement at r of a disc of radius a under unit pressure, E* = 1: Johnson, Contact Mechanics (1985), eqs (3.29)
/// and (3.30), doi:10.1017/CBO9781139171731.
fn disc_displacement(r: f64, a: f64) -> f64 {
    if a <= 0.0 {
        return 0.0;
    }
    if r <= a {
        return 4.0 * a / PI * elliptic(r / a)[1];
    }
    let [k, e] = elliptic(a / r);
    4.0 * r / PI * (e - (1.0 - (a / r).powi(2)) * k)
}

/// Solution of a dense system whose last column is the right side, by elimination with row pivots.
fn eliminated(mut rows: Vec<Vec<f64>>) -> Vec<f64> {
    let n = rows.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&a, &b| rows[a][k].abs().total_cmp(&rows[b][k].abs()));
        rows.swap(k, pivot.unwrap_or(k));
        let (above, below) = rows.split_at_mut(k + 1);
        let pivot = &above[k];
        for row in below {
            let factor = row[k] / pivot[k];
            for (value, p) in row[k..].iter_mut().zip(&pivot[k..]) {
                *value -= factor * p;
            }
        }
    }
    let mut x = vec![0.0; n];
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| rows[k][j] * x[j]).sum();
        x[k] = (rows[k][n] - known) / rows[k][k];
    }
    x
}
