//! The integral equation of a contact: response of the bodies, functions on the contact, linear system.

pub(super) mod basis;
pub(super) mod stack;

use std::f64::consts::PI;
use std::sync::Arc;

use crate::error::{Error, Result, require};
use crate::indent::equation::basis::{Basis, Waves};
use crate::indent::equation::stack::{Stack, StackLevel};
use crate::indent::tip::{MOST_KINKS, Tip};
use crate::numerics::dense::{backward, cholesky, forward};
use crate::numerics::parallel::{Lanes, dot};
use crate::numerics::roots;

/// The root of `f` in a bracket.
///
/// # Errors
/// Errors of `f`, and equal signs at both ends.
pub(super) fn bracketed(f: impl FnMut(f64) -> Result<f64>, bracket: [f64; 2]) -> Result<f64> {
    roots::bracketed(f, bracket)?
        .ok_or(Error::NoState("no state of this kind exists within the radii that can be computed"))
}

/// B = 1 + 2/π ∫ M b̂ b̂ᵀ dα on the functions b of a contact, with its factor.
#[derive(Debug)]
pub(in crate::indent) struct ContactSystem {
    /// Contact radius a \[m\].
    pub(in crate::indent) radius: f64,
    pub(in crate::indent) basis: Basis,
    /// Response at the waves; none of bare bodies.
    pub(in crate::indent) level: Option<Arc<StackLevel>>,
    /// Transforms of the functions at the waves.
    rows: Vec<Vec<f64>>,
    factor: Vec<Vec<f64>>,
    /// ∫ bᵢ.
    pub(in crate::indent) ones: Vec<f64>,
    /// cos αa and sin αa at the waves.
    pub(in crate::indent) edge: [Vec<f64>; 2],
}

impl ContactSystem {
    /// The system of the contact radius `a` \[m\], with waves that resolve oscillations over `length` \[m\], at least 2a.
    pub(in crate::indent) fn new(stack: &Stack, tip: &Tip, a: f64, length: f64) -> Result<Self> {
        tip.check_radius(a)?;
        let requirement = "at most 1024 times the thickness of the top layer";
        require("radius", a, a <= stack.largest_radius(), requirement)?;
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
        Ok(Self { radius: a, basis, level, rows, factor, ones, edge })
    }

    /// B⁻¹ `right`.
    pub(in crate::indent) fn solve(&self, right: Vec<f64>) -> Vec<f64> {
        backward(&self.factor, forward(&self.factor, right))
    }

    /// p̂(α) = ∫ φ cos αt dt at the waves, of a φ in the basis.
    pub(in crate::indent) fn transform(&self, values: &[f64]) -> Vec<f64> {
        combined(&self.rows, values, self.waves())
    }

    /// [`ContactSystem::transform`] of each of several φ at other waves.
    pub(in crate::indent) fn transforms_at<const N: usize>(
        &self,
        waves: &Waves,
        values: [&[f64]; N],
    ) -> [Vec<f64>; N] {
        let rows = self.basis.transforms(waves);
        values.map(|values| combined(&rows, values, waves.len()))
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

/// Adds `factor` times `more` to `sum`.
pub(in crate::indent) fn add(sum: &mut [f64], factor: f64, more: &[f64]) {
    let pairs = sum.iter_mut().zip(more);
    pairs.for_each(|(sum, more)| *sum += factor * more);
}

/// Σ of `rows`, each times its value.
fn combined(rows: &[Vec<f64>], values: &[f64], length: usize) -> Vec<f64> {
    let mut sums = vec![0.0; length];
    for (row, value) in rows.iter().zip(values) {
        add(&mut sums, *value, row);
    }
    sums
}

/// Products of the elements.
pub(in crate::indent) fn times(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}

/// φ₁ of a flat punch at unit approach and φ_F of the profile, with what follows from them.
#[derive(Debug)]
pub(in crate::indent) struct Parts {
    pub(in crate::indent) stack: Stack,
    pub(in crate::indent) tip: Tip,
    pub(in crate::indent) system: ContactSystem,
    /// φ₁ and φ_F in the basis.
    pub(in crate::indent) values: [Vec<f64>; 2],
    /// Their transforms at the waves.
    pub(in crate::indent) hats: [Vec<f64>; 2],
    /// Their values at the edge.
    pub(in crate::indent) edge: [f64; 2],
    /// S = 2π ∫ φ₁ \[N/m\], and P_F = 2π ∫ φ_F \[N\].
    pub(in crate::indent) loads: [f64; 2],
}

impl Parts {
    /// The parts at the contact radius `a` \[m\]; `length` as in [`ContactSystem::new`].
    pub(in crate::indent) fn new(stack: &Stack, tip: &Tip, a: f64, length: f64) -> Result<Self> {
        let system = ContactSystem::new(stack, tip, a, length)?;
        let f = stack.surface_modulus() / PI;
        let places = system.basis.places();
        let profile: Vec<f64> = places.iter().map(|s| f * tip.transform(*s)[0]).collect();
        let punch = system.ones.iter().map(|one| f * one).collect();
        let rights = [(punch, f), (system.basis.project(&profile), f * tip.transform(a)[0])];
        let mut loads = [0.0; 2];
        let mut edge = [0.0; 2];
        let mut hats = [Vec::new(), Vec::new()];
        let mut k = 0;
        let values = rights.map(|(right, at_edge)| {
            let values = system.solve(right);
            hats[k] = system.transform(&values);
            let weighted = times(system.excess(), &hats[k]);
            edge[k] = at_edge - system.couple_edge(&weighted);
            loads[k] = 2.0 * PI * dot(&values, &system.ones);
            k += 1;
            values
        });
        let are_finite = edge.iter().chain(&loads).all(|value| value.is_finite());
        let requirement = "one whose load and stiffness are numbers of the machine";
        let holds = are_finite && edge[0] > 0.0 && loads[0] > 0.0;
        require("radius", a, holds, requirement)?;
        Ok(Self { stack: stack.clone(), tip: tip.clone(), system, values, hats, edge, loads })
    }

    /// f = E*/π.
    pub(in crate::indent) fn f(&self) -> f64 {
        self.stack.surface_modulus() / PI
    }

    /// Approach \[m\] without adhesion: φ vanishes at the edge.
    pub(in crate::indent) fn hertzian(&self) -> f64 {
        self.edge[1] / self.edge[0]
    }

    /// S' = 2π² φ₁(a)²/E* \[N/m²\].
    pub(in crate::indent) fn stiffness_slope(&self) -> f64 {
        2.0 * (PI * self.edge[0]).powi(2) / self.stack.surface_modulus()
    }
}
