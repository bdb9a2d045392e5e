//! The contact problem in the form that the algorithms solve.

use super::freedoms::Freedoms;
use super::passes::{Passes, Row, add};
use super::patch::Window;
use super::sums::{Lanes, ZERO, all, largest, largest_and_sum, sum, update, where_positive};
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
    /// Whether all displacements are finite; [`Problem::judge`] alone looks.
    pub(super) finite: bool,
}

impl Quality {
    pub(super) fn meets(&self, tolerance: f64) -> bool {
        let close = self.residual <= tolerance && self.overlap <= tolerance;
        self.balanced && self.finite && close
    }

    /// Whether sums overflowed: such numbers do not come back.
    pub(super) fn overflows(&self) -> bool {
        self.residual.is_infinite()
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

    /// The rows of its arrays.
    pub(super) fn passes(&self) -> Passes<'_> {
        Passes::new(&self.freedoms.columns, self.convolution.own_threads())
    }

    /// Change of λ from `near` that makes u + h − Bλ least over the cells with pressure. Freedoms that
    /// these do not determine (one or two cells have no tilt) stay as they are.
    pub(super) fn fit(&self, p: &[f64], u: &[f64], h: &[f64], near: [f64; 3]) -> [f64; 3] {
        let sums = self.passes().each([p, u, h], [], add, |row, fields, []| {
            self.freedoms.fit_of(row, fields, near)
        });
        self.freedoms.fitted(sums)
    }

    /// λ that makes the gap least over the contact, as [`Problem::fit`] does, and how good `p` is; it is
    /// zero outside `window`, and not read there.
    pub(super) fn judge(
        &self,
        p: &[f64],
        window: &Window,
        u: &[f64],
        near: [f64; 3],
    ) -> (Multipliers, Quality) {
        let (passes, fields) = (self.passes(), [p, u, self.gap]);
        let sums = passes.each(fields, [], add, |row, fields, []| {
            row.part(window, fields).map_or([0.0; 9], |(row, fields)| {
                self.freedoms.fit_of(row, fields, near)
            })
        });
        let motion = Multipliers {
            base: near,
            change: self.freedoms.fitted(sums),
        };
        let sums = passes.each(fields, [], join, |row, fields @ [_, u, h], []| {
            let gap = motion.gap_of(row);
            let [deepest, most, lost] = largest_and_sum([u, h, row.y], |[u, h, y]| {
                let [deepest, most] = overlap(u, gap([u, h, y]));
                [deepest, most, u * ZERO]
            });
            let carried = row.part(window, fields).map(|(row, [p, u, h])| {
                let mut g = vec![0.0; u.len()];
                motion.gap(row, [u, h], &mut g);
                self.carried_of(row, [p, u, &g])
            });
            let [work, mismatch, f, fx, fy] = carried.unwrap_or_default();
            [deepest, most, work, mismatch, f, fx, fy, lost]
        });
        let [sums @ .., lost] = sums;
        let quality = Quality {
            // The sum is 0, unless one is not finite.
            finite: lost <= 0.0,
            ..self.quality(sums)
        };
        (motion, quality)
    }

    /// g = u + h − Bλ
    pub(super) fn gap_into(&self, u: &[f64], motion: Multipliers, g: &mut [f64]) {
        let fields = [u, self.gap];
        self.passes().each(fields, [g], add, |row, fields, [g]| {
            motion.gap(row, fields, g);
            []
        });
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

    /// What one row adds to the work, the mismatch and the moments of the pressure.
    pub(super) fn carried_of(&self, row: Row, [p, u, g]: [&[f64]; 3]) -> [f64; 5] {
        let [work, mismatch] = sum([p, u, g], |[p, u, g]| {
            // The gap is infinite only where there is no pressure.
            [p * u, where_positive(p, p * g.abs())]
        });
        let [f, fx, fy] = self.freedoms.moments_of(row, p);
        [work, mismatch, f, fx, fy]
    }

    /// The quality of which these are the sums.
    pub(super) fn quality(&self, sums: QualitySums) -> Quality {
        let [deepest, most, work, mismatch, f, fx, fy] = sums;
        // Before anything is deformed there is no scale: whatever overlaps, overlaps wholly.
        let over = |a: f64, scale: f64| match (a > 0.0, scale > 0.0) {
            _ if !(a + scale).is_finite() => f64::INFINITY,
            (true, true) => a / scale,
            (true, false) => f64::INFINITY,
            (false, _) => 0.0,
        };
        Quality {
            residual: over(mismatch, work),
            overlap: over(deepest, most),
            balanced: self.freedoms.on_target([f, fx, fy]),
            finite: true,
        }
    }
}

/// Of which [`Problem::quality`] makes the quality: two largest values, and sums.
pub(super) type QualitySums = [f64; 7];

/// Joins two largest values, and sums.
pub(super) fn join<const S: usize>(a: [f64; S], b: [f64; S]) -> [f64; S] {
    std::array::from_fn(|k| match k {
        0 | 1 if b[k] > a[k] => b[k],
        0 | 1 => a[k],
        _ => a[k] + b[k],
    })
}

/// The deepest overlap of one row, and the largest displacement where it can touch.
pub(super) fn overlap_of(fields: [&[f64]; 2]) -> [f64; 2] {
    largest(fields, |[u, g]| overlap(u, g))
}

/// How deep cells overlap, and their displacement where they can touch.
fn overlap(u: Lanes, g: Lanes) -> [Lanes; 2] {
    let touches = g.simd_lt(all(f64::INFINITY));
    [-g, touches & u.abs()]
}

/// λ in two parts: where loads are small, h − Bλ is far less than either.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Multipliers {
    pub(super) base: [f64; 3],
    pub(super) change: [f64; 3],
}

impl Multipliers {
    /// λ
    pub(super) fn lambda(self) -> [f64; 3] {
        [0, 1, 2].map(|k| self.base[k] + self.change[k])
    }

    /// The gap g = u + h − Bλ of cells in a row, from u, h and their coordinates.
    fn gap_of(self, row: Row) -> impl Fn([Lanes; 3]) -> Lanes {
        let [[a, b], [c, d]] =
            [self.base, self.change].map(|l| [all(l[0] + l[1] * row.x), all(l[2])]);
        move |[u, h, y]| (h - (a + b * y)) + u - (c + d * y)
    }

    /// The gap in a row.
    pub(super) fn gap(self, row: Row, [u, h]: [&[f64]; 2], g: &mut [f64]) {
        let gap = self.gap_of(row);
        update([u, h, row.y], [g], |fields, _| ([gap(fields)], []));
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
pub(super) type Watch<'a> = dyn FnMut(usize, f64, Quality) -> bool + Send + 'a;

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
