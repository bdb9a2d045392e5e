//! What a free end adds to the displacement of a quarter space: at points, and to the influence coefficients of cells.
//!
//! The displacement of cell a under unit pressure on cell b is the sum of that from the mirror image of b,
//! in closed form at the centre of a, and of the mean over a of what keeps the face free. The means make the
//! second symmetric and positive; the first is symmetric as it is.

use std::f64::consts::PI;

use ndarray::{Array1, Array2, Axis};
use rayon::prelude::*;

use super::reduction::{Modes, Reduction};
use super::waves::{Along, WaveRule, Width};
use super::{VANISHED, layers_factor};
use crate::compliance::convolution::{RowWeights, pair};
use crate::compliance::influence::{CellInfluence, coefficients_apart};
use crate::error::{Error, Result, finite, not_negative, positive, refuse_if};
use crate::model::body::{HalfSpace, Substrate};
use crate::model::grid::Grid;
use crate::model::material::Elastic;
use crate::numerics::parallel::Threads;
use crate::numerics::quadrature::Rule;
use crate::numerics::rounding;
use crate::numerics::special::{EULER_GAMMA, barycentric, chebyshev_nodes};

/// Cells next to the end that are nodes themselves. Farther off, coefficients are polynomials of the place on
/// panels that end at twice the distance from which they start.
const NODES_THEMSELVES: f64 = 8.0;

/// Nodes of a panel. The nearest singularity is a panel's length before its start, so that the polynomials err by
/// 6^−8, 6e-7 of a coefficient.
const PANEL_NODES: usize = 8;

/// Distances from the end up to which φ is averaged by its integral, in cells; farther off by Gauss's rule.
const INTEGRATED: f64 = 4.0;

/// Rows of cells at increasing distances from an end, interpolated from nodes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Nodes {
    /// Distance of each node from the end.
    pub(crate) distances: Vec<f64>,
    pub(crate) rows: Vec<RowWeights>,
    /// Length of a cell.
    pub(super) spacing: f64,
}

impl Nodes {
    /// Nodes for `count` rows of cells, of which the first has its centre at the distance `nearest`.
    pub(crate) fn new(nearest: f64, spacing: f64, count: usize) -> Self {
        let (mut distances, mut rows) = (Vec::new(), Vec::new());
        let at = |row: usize| nearest + spacing * row as f64;
        while rows.len() < count {
            let start = at(rows.len()) - 0.5 * spacing;
            let doubled = rounding::round(start / spacing).min((count - rows.len()) as f64);
            let first = distances.len();
            if start < NODES_THEMSELVES * spacing || doubled <= PANEL_NODES as f64 {
                distances.push(at(rows.len()));
                rows.push(RowWeights { first, weights: vec![1.0] });
                continue;
            }
            let last = rows.len() + doubled as usize - 1;
            let (low, high) = (at(rows.len()), at(last));
            let nodes = chebyshev_nodes::<PANEL_NODES>();
            distances
                .extend((nodes.iter()).map(|[x, _]| 0.5 * (low + high) + 0.5 * (high - low) * x));
            for row in rows.len()..=last {
                let t = 2.0 * (at(row) - low) / (high - low) - 1.0;
                rows.push(RowWeights { first, weights: barycentric(&nodes, t) });
            }
        }
        Self { distances, rows, spacing }
    }

    /// Means of functions of kx over a cell around x = `distance`.
    pub(super) fn mean(&self, modes: &Modes, k: f64, distance: f64) -> Array1<f64> {
        let dx = self.spacing;
        if distance < INTEGRATED * dx {
            let ends = [(distance - 0.5 * dx).max(0.0), distance + 0.5 * dx];
            return modes.integrals(ends.map(|x| k * x), 1.0 / (k * dx));
        }
        let mut sums = Array1::zeros(modes.count());
        for (part, w) in Rule::gauss_legendre(3).nodes(0.0, 0.5) {
            modes.add(k * (distance + part * dx), w, &mut sums);
        }
        sums
    }

    /// Nodes that are within `most` of the end with all of their cell, or part of it.
    fn within(&self, most: f64) -> usize {
        let near = |d: &&f64| **d - 0.5 * self.spacing < most;
        self.distances.iter().take_while(near).count()
    }
}

/// Coefficient of the logarithm in what keeps the face free, −c ln k as k → 0. The whole body is displaced as much more than
/// a half-space as the edge of a quarter space of ν = ½ is.
pub(super) fn logarithm() -> f64 {
    2.0 * PI * PI / (PI * PI - 4.0) - 2.0
}

/// Longest wave that stands for a pressure that is uniform along y, over the distance from the end. The displacement
/// differs by a term that is linear in k, which twice the wave takes away, and by 1e-7.
const UNIFORM: f64 = 1e-4;

/// Coefficients \[m/Pa\] that a free end adds for a `body` on a substrate of `material` on cells of a `grid`: pairs of
/// nodes, distances along y. Where the grid repeats, with the `datum` at this distance. On the threads of the caller.
pub(super) fn coefficients(
    (body, material): (&HalfSpace, Elastic),
    nodes: &Nodes,
    (grid, datum): (&Grid, f64),
    threads: &Threads,
) -> Result<Array2<f64>> {
    let ([dx, dy], count) = (grid.spacing(), nodes.distances.len());
    let along = Along::of(grid);
    // Means over cells leave amplitudes that fall as k⁻²; the rest is 1e-7 of the integral.
    let fallen = 150.0 / (dx * dx * dy).cbrt();
    let first = nodes.distances[0] - 0.5 * dx;
    let highest = if first > 1e-9 * dx { fallen.min(VANISHED / first) } else { fallen };
    let uniform = UNIFORM / nodes.distances[count - 1];
    let zeroth = [(uniform, 2.0), (2.0 * uniform, -1.0)];
    let waves = along.waves(along.farthest(), highest, &zeroth);
    let reduction = Reduction::of(material.poisson());

    let pairs = pair(count - 1, count - 1) + 1;
    let mut amplitudes = Array2::zeros((waves.wavenumbers.len(), pairs));
    (amplitudes.axis_iter_mut(Axis(0)).into_par_iter()).zip(&waves.wavenumbers).for_each(
        |(mut row, &k)| {
            let near = nodes.within(VANISHED / k);
            let means: Vec<Array1<f64>> = nodes.distances[..near]
                .iter()
                .map(|&d| nodes.mean(&reduction.displacement, k, d))
                .collect();
            let factor = layers_factor(body, k);
            for a in 0..near {
                for b in 0..=a {
                    row[pair(a, b)] = factor * means[a].dot(&means[b]);
                }
            }
        },
    );
    let short = 2.0 / material.plane_strain_modulus();
    let factor = short * dx * dy / PI.powi(2);
    let weights =
        Array2::from_shape_fn((along.distances.len(), waves.wavenumbers.len()), |(l, k)| {
            factor * waves.weights[k][l]
        });
    let mut coefficients = amplitudes.t().dot(&weights.t());

    let apart = (0..count).flat_map(|a| (0..=a).map(move |b| [a, b]));
    let apart = apart.map(|[a, b]| nodes.distances[a] + nodes.distances[b]);
    let apart: Vec<f64> = apart.collect();
    if along.repeats {
        // The wave ½ uniform stands for the limit; with the datum, 2 exp(−γ)/datum does.
        let limit = (0.25 * uniform * datum).ln() + EULER_GAMMA;
        coefficients += factor * PI / grid.size()[1] * logarithm() * limit;
        coefficients += &coefficients_apart(body, grid, (&apart, datum), threads)?;
        return Ok(coefficients);
    }
    let reach = 2.0 * nodes.distances[count - 1] + along.farthest();
    let mirror = CellInfluence::plan(body, [dx, dy], reach)?;
    (coefficients.axis_iter_mut(Axis(0)).into_par_iter()).zip(apart).for_each(|(row, apart)| {
        for (c, &y) in row.into_iter().zip(&along.distances) {
            *c += mirror.at([apart, y]);
        }
    });
    Ok(coefficients)
}

/// A body x ≥ 0, z ≥ 0 whose face x = 0 is free, under uniform pressure on the rectangle
/// d ≤ x ≤ d + l, |y| ≤ b of its surface z = 0.
///
/// The displacement is that of a half-space under the load and its mirror image, and of what keeps the face
/// free. The reduction to one equation was derived here, after Hetényi, J. Appl. Mech. 37 (1970) 289,
/// doi:10.1115/1.3408508.
///
/// ```
/// use nacre::{Elastic, ends::QuarterSpace};
/// use std::f64::consts::PI;
/// // For ν = ½, the edge sinks 2π²/(π² − 4) times as far as the surface of a half-space.
/// let rubber = Elastic::new(1e6, 0.5)?;
/// let body = QuarterSpace::new(rubber, 0.0, [2.0, 1.0])?;
/// let half_space = nacre::influence::CellInfluence::plan(&rubber, [2.0, 2.0], 10.0)?;
/// let ratio = body.displacement([0.0, 0.0])? / half_space.at([1.0, 0.0]);
/// assert!((ratio / (2.0 * PI * PI / (PI * PI - 4.0)) - 1.0).abs() < 1e-5);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug)]
pub struct QuarterSpace {
    body: HalfSpace,
    material: Elastic,
    distance: f64,
    length: f64,
    half_width: f64,
}

impl QuarterSpace {
    /// A `body`, which may have layers ([the model](crate::compliance::ends)), under unit pressure on the rectangle at this `distance` d \[m\] from the end, of
    /// length l and half-width b \[m\].
    ///
    /// # Errors
    /// On a rigid substrate; where an interface is not bonded; unless the distance is at least 0, and all lengths are finite and the last two above 0.
    pub fn new(
        body: impl Into<HalfSpace>,
        distance: f64,
        [length, half_width]: [f64; 2],
    ) -> Result<Self> {
        let body = body.into();
        let Substrate::Elastic(material) = body.substrate() else {
            return Err(Error::Inconsistent(
                "body must have an elastic substrate: the face of a layer on a rigid base is not free",
            ));
        };
        refuse_if(
            !body.is_bonded(),
            "body must have bonded interfaces: what its end does where layers slip or have springs is not known",
        )?;
        not_negative("distance", distance)?;
        positive("length", length)?;
        positive("half_width", half_width)?;
        Ok(Self { body, material, distance, length, half_width })
    }

    /// Displacement \[m/Pa\] of the surface at (x, y) \[m\], x ≥ 0, per unit pressure.
    ///
    /// # Errors
    /// Unless x is at least 0 and both are finite.
    pub fn displacement(&self, [x, y]: [f64; 2]) -> Result<f64> {
        not_negative("x", x)?;
        finite("y", y)?;
        let middle = self.distance + 0.5 * self.length;
        let sides = [self.length, 2.0 * self.half_width];
        let reach = (x + middle).hypot(y) + sides[0].hypot(sides[1]);
        let half_space = CellInfluence::plan(&self.body, sides, reach)?;
        let images = half_space.at([x - middle, y]) + half_space.at([x + middle, y]);
        Ok(images + self.excess([x, y]))
    }

    /// The displacement beyond that of the load and its image.
    pub(crate) fn excess(&self, [x, y]: [f64; 2]) -> f64 {
        let reduction = Reduction::of(self.material.poisson());
        let end = self.distance + self.length;
        // On the edge itself amplitudes fall as k⁻² only; the rest is 1e-8 of the integral.
        let shortest = self.length.min(self.half_width);
        let highest = (VANISHED / (x + self.distance).max(1e-30)).min(1e4 / shortest);
        let reach = y.abs() + self.half_width + end + x;
        let waves = WaveRule::new(&[y.abs()], Width::Load(self.half_width), reach, highest);
        let mut sum = 0.0;
        for (k, weights) in waves.wavenumbers.iter().zip(&waves.weights) {
            let modes = &reduction.displacement;
            let load = modes.integrals([k * self.distance, k * end], 1.0 / k);
            sum += layers_factor(&self.body, *k) * weights[0] * modes.at(k * x).dot(&load);
        }
        let short = 2.0 / self.material.plane_strain_modulus();
        sum * short * 2.0 * self.half_width / (PI * PI)
    }
}
