//! The linear system of one contact radius, factored.

use std::f64::consts::PI;
use std::sync::Arc;

use super::super::tip::{MOST_KINKS, Tip};
use super::basis::Basis;
use super::stack::{Level, Stack};
use crate::error::{Error, Result};
use crate::numerics::dense::{backward, cholesky, forward};
use crate::numerics::parallel::{Lanes, dot};

/// B = 1 + 2/π ∫ M b̂ b̂ᵀ dα on the functions b of a contact, with its factor.
#[derive(Debug)]
pub(in crate::indent) struct System {
    /// Contact radius a \[m\].
    pub(in crate::indent) radius: f64,
    pub(in crate::indent) basis: Basis,
    /// Response at the waves; none of bare bodies.
    pub(in crate::indent) level: Option<Arc<Level>>,
    /// Transforms of the functions at the waves.
    rows: Vec<Vec<f64>>,
    factor: Vec<Vec<f64>>,
    /// ∫ bᵢ.
    pub(in crate::indent) ones: Vec<f64>,
    /// cos αa and sin αa at the waves.
    pub(in crate::indent) edge: [Vec<f64>; 2],
}

impl System {
    /// The system of the contact radius `a` \[m\], with waves that resolve oscillations over `length` \[m\], at least 2a.
    ///
    /// # Errors
    /// A radius beyond those that are computed, and a response that is not positive.
    pub(in crate::indent) fn new(stack: &Stack, tip: &Tip, a: f64, length: f64) -> Result<Self> {
        tip.check_radius(a)?;
        if a > stack.largest_radius() {
            return Err(Error::Parameter {
                name: "radius",
                requirement: "at most 1024 times the thickness of the top layer",
                value: a,
            });
        }
        let breaks = tip.breaks(a, MOST_KINKS);
        let basis = Basis::new(a, stack.thickness(), breaks.as_deref(), stack.finer());
        let ones = basis.project(&vec![1.0; basis.places().len()]);
        let level = stack.level(length.max(2.0 * a)).cloned();
        let (mut rows, mut edge) = (Vec::new(), [Vec::new(), Vec::new()]);
        if let Some(level) = &level {
            rows = basis.transforms(&level.waves);
            let [cos, sin] = &mut edge;
            cos.resize(level.waves.len(), 0.0);
            sin.resize(level.waves.len(), 0.0);
            level.waves.circular(a, cos, sin);
        }
        let excess = level.as_ref().map_or(&[][..], |level| &level.excess);
        let matrix = products(&rows, excess);
        let factor = cholesky(basis.len(), 0.0, |i, j| {
            let identity = if i == j { 1.0 } else { 0.0 };
            identity + matrix.get(i).map_or(0.0, |row| 2.0 / PI * row[j])
        });
        let factor = factor.ok_or(Error::Inconsistent(
            "the response of the bodies must be positive at every wavenumber",
        ))?;
        Ok(Self {
            radius: a,
            basis,
            level,
            rows,
            factor,
            ones,
            edge,
        })
    }

    /// B⁻¹ `right`.
    pub(in crate::indent) fn solve(&self, right: Vec<f64>) -> Vec<f64> {
        backward(&self.factor, forward(&self.factor, right))
    }

    /// p̂(α) = ∫ φ cos αt dt at the waves, of a φ in the basis.
    pub(in crate::indent) fn transform(&self, values: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.waves()];
        for (row, value) in self.rows.iter().zip(values) {
            for (sum, b) in sums.iter_mut().zip(row) {
                *sum += value * b;
            }
        }
        sums
    }

    /// 2/π Σ g b̂ᵢ over the waves, for each function.
    pub(in crate::indent) fn couple(&self, g: &[f64]) -> Vec<f64> {
        match self.level {
            Some(_) => self.rows.iter().map(|row| 2.0 / PI * dot(row, g)).collect(),
            None => vec![0.0; self.ones.len()],
        }
    }

    /// 2/π Σ g cos αa over the waves.
    pub(in crate::indent) fn couple_edge(&self, g: &[f64]) -> f64 {
        2.0 / PI * dot(&self.edge[0], g)
    }

    /// Number of waves.
    pub(in crate::indent) fn waves(&self) -> usize {
        self.edge[0].len()
    }

    /// Weights times M(α); none of bare bodies.
    pub(in crate::indent) fn excess(&self) -> &[f64] {
        self.level.as_ref().map_or(&[], |level| &level.excess)
    }
}

/// Waves whose transforms of all functions stay in the nearest cache.
const BLOCK: usize = 256;

/// Σ m b̂ᵢ b̂ⱼ over the waves for j ≤ i, block by block, and by twos, whose four sums share what they read.
fn products(rows: &[Vec<f64>], m: &[f64]) -> Vec<Vec<f64>> {
    // One more column than needed in every second row.
    let mut sums: Vec<Vec<f64>> = (0..rows.len()).map(|i| vec![0.0; (i + 2) & !1]).collect();
    for start in (0..m.len()).step_by(BLOCK) {
        let block = start..(start + BLOCK).min(m.len());
        let row = |j: usize| &rows[j.min(rows.len() - 1)][block.clone()];
        for (pair, sums) in sums.chunks_mut(2).enumerate() {
            let weighted = [0, 1].map(|k| times(row(2 * pair + k), &m[block.clone()]));
            for j in (0..=2 * pair).step_by(2) {
                let more = four_dots([&weighted[0], &weighted[1]], [row(j), row(j + 1)]);
                for (sums, more) in sums.iter_mut().zip(more) {
                    sums[j] += more[0];
                    sums[j + 1] += more[1];
                }
            }
        }
    }
    sums
}

/// Sums of the products of each of two with each of two others, of equal lengths, a multiple of the lanes.
fn four_dots(left: [&[f64]; 2], right: [&[f64]; 2]) -> [[f64; 2]; 2] {
    let [a, b] = left.map(|values| values.as_chunks::<4>().0);
    let [c, d] = right.map(|values| values.as_chunks::<4>().0);
    let mut sums = [[Lanes::ZERO; 2]; 2];
    for ((a, b), (c, d)) in a.iter().zip(b).zip(c.iter().zip(d)) {
        let [a, b, c, d] = [a, b, c, d].map(|lanes| Lanes::new(*lanes));
        sums[0][0] += a * c;
        sums[0][1] += a * d;
        sums[1][0] += b * c;
        sums[1][1] += b * d;
    }
    sums.map(|pair| pair.map(Lanes::reduce_add))
}

/// Products of the elements.
pub(in crate::indent) fn times(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}
