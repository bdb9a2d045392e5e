//! The state of a solved contact: pressure and motion, exact on the cells in contact.

use std::ops::ControlFlow;

use crate::contact::{Solution, Tangent, block};
use crate::error::{Error, Result};
use crate::model::grid::Window;
use crate::numerics::parallel::dot;

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

/// Callback before each iteration of a linear solve that says whether to continue.
pub(super) type StopCheck<'a> = Option<&'a dyn Fn() -> ControlFlow<()>>;

/// A contact linearised at its solution. Arrays are those of the tangent's window, in C order.
pub(super) struct Linearised {
    pub(super) tangent: Tangent,
    pub(super) pressure: Vec<f64>,
    /// Gap, 0 in contact.
    pub(super) gap: Vec<f64>,
    /// δ, s_x, s_y.
    pub(super) motion: [f64; 3],
    pub(super) loaded: [bool; 3],
    /// F/dA: right sides of the balance of loaded freedoms.
    target: [f64; 3],
    /// Columns of the loaded freedoms.
    columns: Vec<LoadedColumn>,
    /// Smallest gap outside of the window.
    outside: f64,
}

/// Part of a column that is rounding where the columns before span it.
const SINGULAR: f64 = 1e-10;

/// One loaded freedom: the column of Q, and that of R, in B_f = Q R.
struct LoadedColumn {
    freedom: usize,
    values: Vec<f64>,
    factors: Vec<f64>,
}

/// Solution of a saddle point system: ψ on the window, χ of (1, x, y).
pub(super) struct Saddle {
    pub(super) psi: Vec<f64>,
    pub(super) chi: [f64; 3],
}

impl Linearised {
    /// Polishes `solution`.
    pub(super) fn new(solution: &Solution, watch: StopCheck) -> Result<Self> {
        check(solution)?;
        let grid = solution.grid();
        let shape = grid.shape();
        let Some(inner) = solution.cells_in_contact() else {
            return Err(refused("nothing touches, so that every derivative is 0 or undefined"));
        };
        let window: Window = [0, 1].map(|axis| {
            let cells = &inner[axis];
            cells.start.saturating_sub(RING)..(cells.end + RING).min(shape[axis])
        });
        let motion = [solution.approach, solution.tilt[0], solution.tilt[1]];
        let tangent = Tangent::plan(solution, window)?;
        let control = &solution.report.motion;
        let load = control.load.unwrap_or(0.0);
        let mut loaded = [control.load.is_some(), false, false];
        let mut target = [load / grid.cell_area(), 0.0, 0.0];
        for axis in 0..2 {
            let moment = control.moment[axis].or(control.eccentricity[axis].map(|e| e * load));
            loaded[axis + 1] = moment.is_some();
            target[axis + 1] = moment.unwrap_or(0.0) / grid.cell_area();
        }
        let gap = solution.gap();
        let outside = (gap.indexed_iter())
            .filter(|((i, j), _)| !(tangent.window[0].contains(i) && tangent.window[1].contains(j)))
            .fold(f64::INFINITY, |least, (_, g)| least.min(*g));
        let flat = |field: &ndarray::Array2<f64>| -> Vec<f64> {
            block(field, &tangent.window).iter().copied().collect()
        };
        let (gap, displacement) = (flat(&gap), flat(&solution.total_displacement()));
        let pressure = flat(&solution.pressure);
        let mut state =
            Self { pressure, gap, motion, loaded, target, columns: Vec::new(), outside, tangent };
        if !loaded[0] {
            // Without a column of 1, the others must be counted from the origin, not from the middle of the window.
            state.tangent.origin = [0.0; 2];
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
        state.polish(&undeformed, watch)?;
        Ok(state)
    }

    /// δ + s_x x + s_y y of a `motion` in each cell.
    pub(super) fn moved(&self, [delta, sx, sy]: [f64; 3]) -> Vec<f64> {
        let [x, y] = &self.tangent.coordinates;
        let row = |x: &f64| delta + sx * x;
        x.iter().flat_map(|x| y.iter().map(move |y| row(x) + sy * y)).collect()
    }

    /// K `pressure` in all cells of the window.
    pub(super) fn displaced(&self, pressure: &[f64]) -> Vec<f64> {
        let convolution = &self.tangent.convolution;
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
    fn polish(&mut self, undeformed: &[f64], watch: StopCheck) -> Result<()> {
        for _ in 0..ROUNDS {
            self.plan_columns()?;
            for _ in 0..PASSES {
                self.open(undeformed);
                let right: Vec<f64> = self.masked(&self.gap).iter().map(|g| -g).collect();
                let carried = self.moments(&self.pressure);
                let missing = [0, 1, 2].map(|k| carried[k] - self.target[k]);
                let change = self.saddle(&right, missing, POLISH, watch)?;
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
                return Ok(());
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
        cells.map(|(v, inside)| if *inside { *v } else { 0.0 }).collect()
    }

    /// Σ `factor`(cell) p over the cells in contact, numbered as in the grid.
    pub(super) fn sum_over_contact(&self, factor: impl Fn([usize; 2]) -> f64) -> f64 {
        let [x, y] = &self.tangent.window;
        let cells = x.clone().flat_map(|i| y.clone().map(move |j| [i, j]));
        let loaded = cells.zip(&self.pressure).filter(|(_, p)| **p != 0.0);
        loaded.map(|(cell, p)| p * factor(cell)).sum()
    }

    /// Makes the columns of loaded freedoms orthonormal on the contact.
    fn plan_columns(&mut self) -> Result<()> {
        let mut columns: Vec<LoadedColumn> = Vec::new();
        for freedom in (0..3).filter(|&k| self.loaded[k]) {
            let mut values = self.tangent.column(freedom);
            let size = dot(&values, &values).sqrt();
            let mut factors = Vec::new();
            for before in &columns {
                let factor = dot(&before.values, &values);
                for (v, q) in values.iter_mut().zip(&before.values) {
                    *v -= factor * q;
                }
                factors.push(factor);
            }
            let norm = dot(&values, &values).sqrt();
            if norm <= SINGULAR * size {
                return Err(refused(
                    "the cells in contact are too few for the loaded freedoms: refine the grid",
                ));
            }
            values.iter_mut().for_each(|v| *v /= norm);
            factors.push(norm);
            columns.push(LoadedColumn { freedom, values, factors });
        }
        self.columns = columns;
        Ok(())
    }

    /// Solves K ψ − B_f χ = `right` on the contact, −B_fᵀ ψ = `balance`, to `tolerance`.
    ///
    /// With B_f = Q R on the contact, ψ is −Q R⁻ᵀ `balance` and a part without any sum Qᵀψ, which conjugate gradients find
    /// among such fields; χ = R⁻¹ Qᵀ (K ψ − `right`).
    pub(super) fn saddle(
        &self,
        right: &[f64],
        balance: [f64; 3],
        tolerance: f64,
        watch: StopCheck,
    ) -> Result<Saddle> {
        let balance = self.tangent.to_scaled(balance);
        let mut psi = vec![0.0; right.len()];
        let mut sums: Vec<f64> = Vec::new();
        for (k, column) in self.columns.iter().enumerate() {
            let known: f64 = column.factors[..k].iter().zip(&sums).map(|(r, w)| r * w).sum();
            let sum = (-balance[column.freedom] - known) / column.factors[k];
            for (psi, q) in psi.iter_mut().zip(&column.values) {
                *psi += sum * q;
            }
            sums.push(sum);
        }
        let mut image = vec![0.0; right.len()];
        let mut residual = right.to_vec();
        if sums.iter().any(|sum| *sum != 0.0) {
            self.tangent.apply(&psi, &mut image);
            residual.iter_mut().zip(&image).for_each(|(r, image)| *r -= image);
        }
        let span: Vec<&[f64]> = self.columns.iter().map(|column| &*column.values).collect();
        let mut ask = || watch.map_or(ControlFlow::Continue(()), |watch| watch());
        let correction = self.tangent.solve_beside(&residual, &span, tolerance, &mut ask)?;
        psi.iter_mut().zip(correction).for_each(|(psi, y)| *psi += y);
        self.tangent.apply(&psi, &mut image);
        image.iter_mut().zip(right).for_each(|(image, r)| *image -= r);
        let mut scaled = [0.0; 3];
        for (k, column) in self.columns.iter().enumerate().rev() {
            let mut factor = dot(&column.values, &image);
            for later in &self.columns[k + 1..] {
                factor -= later.factors[k] * scaled[later.freedom];
            }
            scaled[column.freedom] = factor / column.factors[k];
        }
        // The operator is K + s 1ᵀ1 where the datum of a line contact lies farther away.
        let mut chi = self.tangent.unscaled(scaled);
        chi[0] -= self.tangent.raise * psi.iter().sum::<f64>();
        Ok(Saddle { psi, chi })
    }

    /// Smaller of the least pressure in contact over the largest, and the least gap outside over the deepest displacement.
    pub(super) fn margin(&self) -> f64 {
        let (peak, depth) = (peak(&self.pressure), self.depth());
        let cells = self.tangent.contact.iter().zip(self.pressure.iter().zip(&self.gap));
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
    Ok(())
}

/// The error for a solution without a derivative.
fn refused(reason: &'static str) -> Error {
    Error::no_derivative("the solution", reason)
}
