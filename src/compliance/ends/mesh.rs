//! Points along ln kx: interpolation and integrals of functions given there.

use std::sync::LazyLock;

use ndarray::{Array1, Array2};

use super::VANISHED;
use crate::numerics::quadrature::Rule;

/// Points of a panel.
pub(super) const POINTS: usize = 10;

/// Ends of the panels, kx. Below the lowest, P is taken as constant; above the highest, all kernels are below
/// 1e-19.
pub(super) const ENDS: [f64; 2] = [1e-11, VANISHED];

/// Panels from the lowest end to the highest, each longer than the one before by a factor of 2.5. With
/// 12 points and a factor of 2.3 displacements change by 1e-9 of the largest.
pub(super) const PANELS: usize = 32;

/// kx from which on the solution is independent of the lowest end, to 1e-9; smaller ones are taken as equal to it.
const RELIABLE: f64 = 1e-9;

/// Points along ln kx, and integrals over them.
#[derive(Debug)]
pub(super) struct Mesh {
    pub(super) points: Vec<f64>,
    pub(super) weights: Vec<f64>,
    /// Barycentric weights of a panel's points, and the points on (−1, 1).
    barycentric: Vec<f64>,
    local: Vec<f64>,
}

pub(super) fn step() -> f64 {
    (ENDS[1] / ENDS[0]).ln() / PANELS as f64
}

/// The mesh of all materials.
pub(super) static MESH: LazyLock<Mesh> = LazyLock::new(Mesh::new);

impl Mesh {
    fn new() -> Self {
        let rule = Rule::gauss_legendre(POINTS);
        let mut unit: Vec<(f64, f64)> = rule.nodes(0.0, 1.0).collect();
        unit.sort_by(|a, b| a.0.total_cmp(&b.0));
        let local: Vec<f64> = unit.iter().map(|(t, _)| *t).collect();
        let barycentric = local.iter().enumerate().map(|(q, t)| {
            let others = local.iter().enumerate().filter(|(other, _)| *other != q);
            1.0 / others.map(|(_, other)| t - other).product::<f64>()
        });
        let (mut points, mut weights) = (Vec::new(), Vec::new());
        for panel in 0..PANELS {
            let [low, high] = edges(panel);
            for (t, w) in &unit {
                let u = 0.5 * (low + high + t * (high - low));
                points.push(u.exp());
                weights.push(0.5 * w * (high - low) * u.exp());
            }
        }
        Self { barycentric: barycentric.collect(), points, weights, local }
    }

    /// Panel of kx = ξ, and the weights with which its points interpolate to ξ.
    fn interpolation(&self, xi: f64) -> (usize, [f64; POINTS]) {
        let place = (xi.max(RELIABLE) / ENDS[0]).ln() / step();
        let panel = (place as usize).min(PANELS - 1);
        (panel, self.lagrange(2.0 * (place - panel as f64) - 1.0))
    }

    /// Lagrange's polynomials of a panel's points at t on (−1, 1).
    pub(super) fn lagrange(&self, t: f64) -> [f64; POINTS] {
        if let Some(at) = self.local.iter().position(|x| (x - t).abs() < 1e-15) {
            return std::array::from_fn(|q| if q == at { 1.0 } else { 0.0 });
        }
        let terms: [f64; POINTS] =
            std::array::from_fn(|q| self.barycentric[q] / (t - self.local[q]));
        let sum: f64 = terms.iter().sum();
        terms.map(|term| term / sum)
    }
}

/// Ends of a panel, ln kx.
pub(super) fn edges(panel: usize) -> [f64; 2] {
    [panel, panel + 1].map(|k| ENDS[0].ln() + step() * k as f64)
}

/// Functions of ξ = kx, given at the points of the mesh.
#[derive(Debug)]
pub(super) struct Modes {
    /// Values: (points, functions).
    values: Array2<f64>,
    /// Integrals from 0 to each point, over ξ.
    means: Array2<f64>,
}

impl Modes {
    pub(super) fn new(values: Array2<f64>) -> Self {
        Self { means: means(&values), values }
    }

    /// Number of functions.
    pub(super) fn count(&self) -> usize {
        self.values.ncols()
    }

    /// Adds `factor` times the functions at ξ to `sums`.
    pub(super) fn add(&self, xi: f64, factor: f64, sums: &mut Array1<f64>) {
        interpolate(&self.values, xi, factor, sums);
    }

    /// Adds `factor` times the integrals of the functions from 0 to ξ to `sums`.
    pub(super) fn add_integrals(&self, xi: f64, factor: f64, sums: &mut Array1<f64>) {
        let xi = xi.min(VANISHED);
        interpolate(&self.means, xi, factor * xi, sums);
    }
}

fn interpolate(values: &Array2<f64>, xi: f64, factor: f64, sums: &mut Array1<f64>) {
    if xi > VANISHED {
        return;
    }
    let (panel, weights) = MESH.interpolation(xi);
    for (q, weight) in weights.into_iter().enumerate() {
        sums.scaled_add(factor * weight, &values.row(panel * POINTS + q));
    }
}

/// First point of the first panel with a point that counts.
pub(super) fn first_reliable() -> usize {
    let first = MESH.points.iter().position(|xi| *xi >= RELIABLE);
    first.unwrap_or(0) / POINTS * POINTS
}

/// Integral of each φ from 0 to each point ξ, over ξ. Below the points that count, φ is constant.
fn means(modes: &Array2<f64>) -> Array2<f64> {
    let mesh = &*MESH;
    let mut means = Array2::zeros(modes.dim());
    let first = mesh.points.iter().position(|xi| *xi >= RELIABLE).unwrap_or(0) / POINTS;
    let start = edges(first)[0].exp();
    let rule = Rule::gauss_legendre(POINTS);
    let mut sum = modes.row(first * POINTS).to_owned() * start;
    for panel in first..PANELS {
        let [low, high] = edges(panel);
        let part = |from: f64, to: f64, sum: &mut Array1<f64>| {
            for (u, w) in rule.nodes(0.5 * (from + to), 0.5 * (to - from)) {
                let polynomials = mesh.lagrange((2.0 * u - low - high) / (high - low));
                for (q, l) in polynomials.into_iter().enumerate() {
                    sum.scaled_add(l * w * u.exp(), &modes.row(panel * POINTS + q));
                }
            }
        };
        let mut from = low;
        for q in 0..POINTS {
            let point = mesh.points[panel * POINTS + q];
            part(from, point.ln(), &mut sum);
            from = point.ln();
            means.row_mut(panel * POINTS + q).assign(&(&sum / point));
        }
        part(from, high, &mut sum);
    }
    means
}
