//! The state of a solved contact: pressure and motion, exact on the cells in contact.

use std::ops::ControlFlow;

use crate::contact::{Solution, Tangent, block, bounds};
use crate::dense::{backward, cholesky, forward};
use crate::error::{Error, Result};
use crate::grid::{Window, full_window};
use crate::parallel::dot;

/// Cells around the contact that the window holds, which may join it first.
const RING: usize = 2;

/// Residual of one pass of the polish, relative to what it starts from.
const POLISH: f64 = 1e-5;

/// Change of the pressure that is left, relative to the peak, and passes of the polish: one or two as a rule.
const SETTLED: f64 = 1e-11;
const PASSES: usize = 4;
/// Rounds in which cells may join or leave the contact while it is polished. A converged solution takes one; a second one
/// where its tolerance left a cell on the wrong side.
const ROUNDS: usize = 20;

/// Overlap relative to the displacement below which a cell outside does not join: rounding.
const ROUNDING: f64 = 1e-13;

/// Difference between the displacement of a solution and that of its pressure, relative to the largest.
const OTHER_DISPLACEMENT: f64 = 1e-5;

/// A contact linearised at its solution. Arrays are those of the tangent's window, in C order.
pub(super) struct State {
    pub(super) tangent: Tangent,
    pub(super) pressure: Vec<f64>,
    /// Gap, 0 in contact.
    pub(super) gap: Vec<f64>,
    /// δ, s_x, s_y.
    pub(super) motion: [f64; 3],
    pub(super) loaded: [bool; 3],
    /// F/dA: right sides of the balance of loaded freedoms.
    target: [f64; 3],
    /// K⁻¹ of the columns of loaded freedoms, and the inverse of Bᵀ K⁻¹ B.
    columns: Vec<Column>,
    tolerance: f64,
    /// Smallest gap outside of the window.
    outside: f64,
}

/// One loaded freedom k: its centred and scaled column b_k of B, and K⁻¹ b_k.
struct Column {
    freedom: usize,
    values: Vec<f64>,
    image: Vec<f64>,
}

/// Solution of a saddle point system: ψ on the window, χ of (1, x, y).
pub(super) struct Saddle {
    pub(super) psi: Vec<f64>,
    pub(super) chi: [f64; 3],
}

impl State {
    /// Polishes `solution`; linear systems are solved to `tolerance`. `None` where `watch` breaks.
    ///
    /// # Errors
    /// A solution that has no derivative, and failing solves.
    pub(super) fn new(
        solution: &Solution,
        tolerance: f64,
        watch: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Result<Option<Self>> {
        check(solution)?;
        let grid = solution.grid();
        let shape = grid.shape();
        let touching = |i: usize, j: usize| solution.pressure[[i, j]] > 0.0;
        let Some(inner) = bounds(&full_window(shape), touching) else {
            return Err(refused(
                "nothing touches, so that every derivative is 0 or undefined",
            ));
        };
        let window: Window = [0, 1].map(|axis| {
            let cells = &inner[axis];
            cells.start.saturating_sub(RING)..(cells.end + RING).min(shape[axis])
        });
        let motion = [solution.approach, solution.tilt[0], solution.tilt[1]];
        let tangent = Tangent::plan(solution, window)?;
        let asked = &solution.report.motion;
        let load = asked.load.unwrap_or(0.0);
        let mut loaded = [asked.load.is_some(), false, false];
        let mut target = [load / grid.cell_area(), 0.0, 0.0];
        for axis in 0..2 {
            let moment = asked.moment[axis].or(asked.eccentricity[axis].map(|e| e * load));
            loaded[axis + 1] = moment.is_some();
            target[axis + 1] = moment.unwrap_or(0.0) / grid.cell_area();
        }
        let gap = solution.gap();
        let outside = (gap.indexed_iter())
            .filter(|((i, j), _)| {
                !(tangent.window()[0].contains(i) && tangent.window()[1].contains(j))
            })
            .fold(f64::INFINITY, |least, (_, g)| least.min(*g));
        let flat = |field: &ndarray::Array2<f64>| -> Vec<f64> {
            block(field, tangent.window()).iter().copied().collect()
        };
        let (gap, displacement) = (flat(&gap), flat(&solution.displacement));
        let pressure = flat(&solution.pressure);
        let mut state = Self {
            pressure,
            gap,
            motion,
            loaded,
            target,
            columns: Vec::new(),
            tolerance,
            outside,
            tangent,
        };
        if !loaded[0] {
            state.tangent.centre_at_origin();
        }
        let undeformed: Vec<f64> = (state.gap.iter().zip(&displacement))
            .zip(state.moved(motion))
            .map(|((g, u), moved)| g - u + moved)
            .collect();
        let own = state.displaced(&state.pressure);
        let largest = peak(&displacement);
        let differs = |(a, b): (&f64, &f64)| (a - b).abs() > OTHER_DISPLACEMENT * largest;
        if own.iter().zip(&displacement).any(differs) {
            return Err(refused(
                "its displacement is not that of its pressure alone, as under friction between unlike bodies",
            ));
        }
        if state.polish(&undeformed, watch)?.is_none() {
            return Ok(None);
        }
        Ok(Some(state))
    }

    /// δ + s_x x + s_y y of a `motion` in each cell.
    pub(super) fn moved(&self, [delta, sx, sy]: [f64; 3]) -> Vec<f64> {
        let [x, y] = &self.tangent.coordinates;
        let row = |x: &f64| delta + sx * x;
        x.iter()
            .flat_map(|x| y.iter().map(move |y| row(x) + sy * y))
            .collect()
    }

    /// K `pressure` in all cells of the window.
    pub(super) fn displaced(&self, pressure: &[f64]) -> Vec<f64> {
        let convolution = self.tangent.convolution();
        let mut out = vec![0.0; pressure.len()];
        convolution.apply_slices(pressure, &mut out, &mut convolution.workspace());
        let raised = self.tangent.raise * pressure.iter().sum::<f64>();
        out.iter_mut().for_each(|u| *u -= raised);
        out
    }

    /// Σ v, Σ v x, Σ v y.
    pub(super) fn moments(&self, values: &[f64]) -> [f64; 3] {
        let [x, y] = &self.tangent.coordinates;
        let mut sums = [0.0; 3];
        for (x, row) in x.iter().zip(values.chunks_exact(y.len())) {
            let sum: f64 = row.iter().sum();
            sums[0] += sum;
            sums[1] += x * sum;
            sums[2] += dot(y, row);
        }
        sums
    }

    /// Makes pressure and motion exact on the contact, from which cells may leave, and which they may join.
    fn polish(
        &mut self,
        undeformed: &[f64],
        watch: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Result<Option<()>> {
        for _ in 0..ROUNDS {
            if self.plan_columns(watch)?.is_none() {
                return Ok(None);
            }
            for _ in 0..PASSES {
                self.open(undeformed);
                let right: Vec<f64> = self.masked(&self.gap).iter().map(|g| -g).collect();
                let carried = self.moments(&self.pressure);
                let missing = [0, 1, 2].map(|k| carried[k] - self.target[k]);
                let Some(change) = self.saddle(&right, missing, POLISH, watch)? else {
                    return Ok(None);
                };
                let (largest, changed) = (peak(&self.pressure), peak(&change.psi));
                for (p, change) in self.pressure.iter_mut().zip(&change.psi) {
                    *p += change;
                }
                for k in (0..3).filter(|&k| self.loaded[k]) {
                    self.motion[k] += change.chi[k];
                }
                if POLISH * changed <= SETTLED * largest {
                    break;
                }
            }
            self.open(undeformed);
            let scale = self.depth();
            let mut settled = true;
            for k in 0..self.pressure.len() {
                let inside = self.tangent.contact[k];
                if inside && self.pressure[k] <= 0.0 {
                    (self.tangent.contact[k], self.pressure[k]) = (false, 0.0);
                    settled = false;
                } else if !inside && self.gap[k] < -ROUNDING * scale {
                    self.tangent.contact[k] = true;
                    settled = false;
                }
            }
            if settled {
                for (g, inside) in self.gap.iter_mut().zip(&self.tangent.contact) {
                    if *inside {
                        *g = 0.0;
                    }
                }
                return Ok(Some(()));
            }
        }
        Err(refused(
            "cells at the edge of the contact join and leave it by turns: move the load or the grid a little",
        ))
    }

    /// Computes the gap K p + h − B λ.
    fn open(&mut self, undeformed: &[f64]) {
        let displaced = self.displaced(&self.pressure);
        let moved = self.moved(self.motion);
        let parts = undeformed.iter().zip(displaced).zip(moved);
        for (g, ((h, u), moved)) in self.gap.iter_mut().zip(parts) {
            *g = (h - moved) + u;
        }
    }

    /// A length by which gaps are measured: the largest displacement relative to the rim of the window, or the approach.
    pub(super) fn depth(&self) -> f64 {
        peak(&self.displaced(&self.pressure))
    }

    /// `values` in contact, 0 elsewhere.
    pub(super) fn masked(&self, values: &[f64]) -> Vec<f64> {
        let cells = values.iter().zip(&self.tangent.contact);
        cells
            .map(|(v, inside)| if *inside { *v } else { 0.0 })
            .collect()
    }

    /// Σ `factor`(cell) p over the cells in contact, numbered as in the grid.
    pub(super) fn sum_over_contact(&self, factor: impl Fn([usize; 2]) -> f64) -> f64 {
        let [x, y] = self.tangent.window();
        let cells = x.clone().flat_map(|i| y.clone().map(move |j| [i, j]));
        let loaded = cells.zip(&self.pressure).filter(|(_, p)| **p != 0.0);
        loaded.map(|(cell, p)| p * factor(cell)).sum()
    }

    /// Solves for the columns of loaded freedoms.
    fn plan_columns(&mut self, watch: &mut dyn FnMut() -> ControlFlow<()>) -> Result<Option<()>> {
        let mut columns = Vec::new();
        for freedom in (0..3).filter(|&k| self.loaded[k]) {
            let values = self.tangent.column(freedom);
            let Some(image) = self.tangent.solve(&values, self.tolerance, watch)? else {
                return Ok(None);
            };
            columns.push(Column {
                freedom,
                values,
                image,
            });
        }
        self.columns = columns;
        Ok(Some(()))
    }

    /// Solves K ψ − B_f χ = `right` on the contact, −B_fᵀ ψ = `balance`, to `tolerance`; `None` where `watch` breaks.
    ///
    /// # Errors
    /// A contact of too few cells for its loaded freedoms, and those of the linear solve.
    pub(super) fn saddle(
        &self,
        right: &[f64],
        balance: [f64; 3],
        tolerance: f64,
        watch: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Result<Option<Saddle>> {
        // What lies in the span of B_f only moves χ; without it, nothing large cancels.
        let n = self.columns.len();
        let gram = |i: usize, j: usize| dot(&self.columns[i].values, &self.columns[j].values);
        let gram: Vec<Vec<f64>> = (0..n)
            .map(|i| (0..n).map(|j| gram(i, j)).collect())
            .collect();
        let sums = self.columns.iter().map(|column| dot(&column.values, right));
        let spanned = solved(&gram, sums.collect()).ok_or_else(too_few)?;
        let mut rest = right.to_vec();
        for (column, factor) in self.columns.iter().zip(&spanned) {
            for (r, b) in rest.iter_mut().zip(&column.values) {
                *r -= factor * b;
            }
        }
        let mut psi = vec![0.0; right.len()];
        if rest.iter().any(|r| *r != 0.0) {
            let Some(found) = self.tangent.solve(&rest, tolerance, watch)? else {
                return Ok(None);
            };
            psi = found;
        }
        // B = B̂ A, with the centred and scaled columns B̂: −B̂ᵀψ = A⁻ᵀ balance.
        let balance = self.tangent.to_scaled(balance);
        let mut matrix = vec![vec![0.0; n]; n];
        let mut sides = vec![0.0; n];
        for (i, one) in self.columns.iter().enumerate() {
            for (j, other) in self.columns.iter().enumerate() {
                let [a, b] = [
                    dot(&one.values, &other.image),
                    dot(&other.values, &one.image),
                ];
                matrix[i][j] = 0.5 * (a + b);
            }
            sides[i] = -balance[one.freedom] - dot(&one.values, &psi);
        }
        let factors = solved(&matrix, sides).ok_or_else(too_few)?;
        let mut scaled = [0.0; 3];
        for ((column, factor), spanned) in self.columns.iter().zip(factors).zip(spanned) {
            scaled[column.freedom] = factor - spanned;
            for (psi, z) in psi.iter_mut().zip(&column.image) {
                *psi += factor * z;
            }
        }
        // The operator is K + s 1ᵀ1 where the datum of a line contact lies farther away.
        let mut chi = self.tangent.from_scaled(scaled);
        chi[0] -= self.tangent.raise * psi.iter().sum::<f64>();
        Ok(Some(Saddle { psi, chi }))
    }

    /// Smaller of the least pressure in contact over the largest, and the least gap outside over the deepest displacement.
    pub(super) fn margin(&self) -> f64 {
        let (peak, depth) = (peak(&self.pressure), self.depth());
        let cells = self
            .tangent
            .contact
            .iter()
            .zip(self.pressure.iter().zip(&self.gap));
        let relative = |(inside, (p, g)): (&bool, (&f64, &f64))| match inside {
            true => p / peak,
            false => g / depth,
        };
        cells.map(relative).fold(self.outside / depth, f64::min)
    }
}

/// Largest magnitude of `values`.
fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |a, v| a.max(v.abs()))
}

/// Refuses a solution that has no derivative.
fn check(solution: &Solution) -> Result<()> {
    if !solution.report.converged() {
        return Err(refused("its solve did not converge: raise max_iterations"));
    }
    if solution.hardness.is_some() || solution.indentation.is_some() {
        return Err(refused(
            "surfaces that yield depend on the history of loads: leave out hardness and indentation",
        ));
    }
    if solution.report.method != crate::influence::Method::Exact
        && !matches!(solution.report.method, crate::influence::Method::Spectral)
    {
        return Err(refused(
            "its coefficients are conversions: take the method \"exact\"",
        ));
    }
    Ok(())
}

fn too_few() -> Error {
    refused("the cells in contact are too few for the loaded freedoms: refine the grid")
}

/// The error for a solution without a derivative.
pub(super) fn refused(reason: &'static str) -> Error {
    Error::NotDifferentiable {
        what: "the solution".to_owned(),
        reason,
    }
}

/// Part of a diagonal entry below which a pivot is rounding.
const SINGULAR: f64 = 1e-14;

/// Solution of a small symmetric positive definite system; none where it is singular.
fn solved(matrix: &[Vec<f64>], sides: Vec<f64>) -> Option<Vec<f64>> {
    let lower = cholesky(sides.len(), |i, j| matrix[i][j])?;
    let pivots = lower.iter().enumerate();
    let mut small = pivots.filter(|(k, row)| row[*k] * row[*k] < SINGULAR * matrix[*k][*k]);
    match small.next() {
        Some(_) => None,
        None => Some(backward(&lower, forward(&lower, sides))),
    }
}
