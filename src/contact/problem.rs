//! The contact problem in the form that the algorithms solve.

use super::freedoms::Freedoms;
use super::sums::{largest, sum};
use crate::convolution::{Convolution, Workspace};

/// Minimise ½ pᵀK p + pᵀh over p ≥ 0 subject to Bᵀp = F.
///
/// Its multipliers are the loaded freedoms of the rigid motion: g = K p + h − Bλ ≥ 0, p g = 0.
/// Polonsky & Keer, Wear 231 (1999) 206, eqs (1)–(4), with one column of B a loaded freedom.
pub(super) struct Problem<'a> {
    pub(super) convolution: &'a Convolution,
    pub(super) freedoms: &'a Freedoms,
    /// h, less the prescribed motion; +∞ where the shape cannot touch.
    pub(super) gap: &'a [f64],
}

/// How well a pressure solves the problem.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Quality {
    /// Σ p|g| / Σ p u over the cells that can touch; 0 when p = 0.
    pub(super) residual: f64,
    /// max(−g, 0) / max u over them.
    pub(super) overlap: f64,
    /// Whether force and moments are balanced.
    pub(super) balanced: bool,
}

impl Quality {
    pub(super) fn meets(&self, tolerance: f64) -> bool {
        self.balanced && self.residual <= tolerance && self.overlap <= tolerance
    }
}

impl Problem<'_> {
    pub(super) fn apply(&self, p: &[f64], out: &mut [f64], workspace: &mut Workspace) {
        self.convolution.apply_slices(p, out, workspace);
    }

    /// The displacement of a cell under its own unit pressure.
    pub(super) fn self_influence(&self) -> f64 {
        self.convolution.self_influence()
    }

    /// Gap g = u + h − Bλ, where λ makes it least over the contact; λ, and how good it is.
    pub(super) fn gap_into(&self, p: &[f64], u: &[f64], g: &mut [f64]) -> ([f64; 3], Quality) {
        let lambda = self.freedoms.fit(p, u, self.gap);
        for ((g, u), h) in g.iter_mut().zip(u).zip(self.gap) {
            *g = u + h;
        }
        if self.freedoms.any_loaded() {
            self.freedoms.for_each(lambda, |k, b| g[k] -= b);
        }
        (lambda, self.quality(p, u, g))
    }

    /// The same where λ is about `near`: freedoms that the contact does not determine (one or two
    /// cells have no tilt) stay so, where [`Problem::gap_into`] takes 0.
    pub(super) fn gap_near(
        &self,
        p: &[f64],
        u: &[f64],
        near: [f64; 3],
        g: &mut [f64],
    ) -> ([f64; 3], Quality) {
        g.copy_from_slice(self.gap);
        self.freedoms.for_each(near, |k, b| g[k] -= b);
        let change = self.freedoms.fit(p, u, g);
        g.iter_mut().zip(u).for_each(|(g, u)| *g += u);
        self.freedoms.for_each(change, |k, b| g[k] -= b);
        let lambda = [0, 1, 2].map(|k| near[k] + change[k]);
        (lambda, self.quality(p, u, g))
    }

    /// Restores balance. Where the contact cannot carry the moments, as two cells cannot, all cells
    /// that can touch join it.
    pub(super) fn rebalance(&self, p: &mut [f64]) {
        if self.freedoms.balance(p) {
            return;
        }
        let little = 1e-3 * self.freedoms.typical_pressure(p.len());
        for (p, h) in p.iter_mut().zip(self.gap) {
            if h.is_finite() {
                *p += little;
            }
        }
        self.freedoms.balance(p);
    }

    fn quality(&self, p: &[f64], u: &[f64], g: &[f64]) -> Quality {
        let [work, mismatch] = sum([p, u, g], |[p, u, g]| {
            // The gap is infinite only where there is no pressure.
            let mismatch = if p > 0.0 { p * g.abs() } else { 0.0 };
            [p * u, mismatch]
        });
        let [deepest, largest] = largest([u, g], |[u, g]| {
            let touches = g < f64::INFINITY;
            [-g, if touches { u.abs() } else { 0.0 }]
        });
        // Before anything is deformed there is no scale: whatever overlaps, overlaps wholly.
        let over = |a: f64, scale: f64| match (a > 0.0, scale > 0.0) {
            _ if !(a + scale).is_finite() => f64::INFINITY,
            (true, true) => a / scale,
            (true, false) => f64::INFINITY,
            (false, _) => 0.0,
        };
        let balanced = self.freedoms.balanced(p);
        Quality {
            residual: over(mismatch, work),
            overlap: over(deepest, largest),
            balanced,
        }
    }
}

/// How an iteration ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Termination {
    /// The tolerance was met.
    Converged,
    /// It was not, within the iterations allowed.
    IterationLimit,
    /// The caller asked to stop.
    Stopped,
}

/// Counts of an iteration that ended.
#[derive(Debug, Clone, Copy)]
pub(super) struct Outcome {
    pub(super) termination: Termination,
    pub(super) iterations: usize,
    /// In the unit of [`Convolution::work`].
    pub(super) work: f64,
    /// Multipliers of the loaded freedoms.
    pub(super) lambda: [f64; 3],
}

/// Is told an iteration's number, the work done and the quality; true asks to stop.
pub(super) type Watch<'a> = dyn FnMut(usize, f64, Quality) -> bool + 'a;

/// When to end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    pub(super) tolerance: f64,
    pub(super) max_iterations: usize,
}

impl Limits {
    /// Those that are left after so many iterations.
    pub(super) fn after(self, iterations: usize) -> Self {
        Self {
            max_iterations: self.max_iterations - iterations,
            ..self
        }
    }
}
