//! The contact problem in the form that the algorithms solve.

pub(super) mod balance;
pub(super) mod fit;
pub(super) mod freedoms;
pub(super) mod load_point;

use crate::contact::cascade::patch::Window;
use crate::contact::problem::fit::FitSums;
use crate::contact::problem::freedoms::Freedoms;
use crate::convolution::{Convolution, Workspace};
use crate::parallel::{Lanes, ZERO, all, sum, update, update_with_largest, where_positive};
use crate::parallel::{Passes, Row, add};

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

    /// λ that makes u + h − Bλ least over the cells with pressure. Freedoms that these do not determine (one
    /// or two cells have no tilt) are 0.
    pub(super) fn fit(&self, p: &[f64], u: &[f64], h: &[f64]) -> [f64; 3] {
        let sums = self.passes().each([p, u, h], [], add, |row, fields, []| {
            self.fit_near([0.0; 3], row, fields)
        });
        self.freedoms.fitted(sums)
    }

    /// What one row adds to the fit of the change of λ from `near`.
    fn fit_near(&self, near: [f64; 3], row: Row, fields: [&[f64]; 3]) -> FitSums {
        let (base, slope) = (all(near[0] + near[1] * row.x), all(near[2]));
        self.freedoms.fit_of(row, fields, [], |[p, u, h, y], []| {
            ([], [p, (h - (base + slope * y)) + u, ZERO])
        })
    }

    /// Computes the displacement `u` of a pressure that is zero outside `window`, of which the rows alone are
    /// read; λ that makes the gap least over the contact, and how good `p` is. Freedoms that the contact does
    /// not determine stay as they are in `near`.
    pub(super) fn judge(
        &self,
        p: &[f64],
        window: &Window,
        u: &mut [f64],
        near: [f64; 3],
        workspace: &mut Workspace,
    ) -> (Multipliers, Quality) {
        let (passes, ny) = (self.passes(), self.convolution.shape()[1]);
        let rows = || window[0].clone();
        self.convolution.rows_in(p, rows(), workspace);
        let outwards = self.convolution.outwards(rows(), workspace);
        let displace = |first: usize, u: &mut [f64]| {
            if !u.is_empty() {
                outwards.rows(first, u);
            }
        };
        let inputs = [p, self.gap];
        // Rows of the window first: what λ depends on.
        let fit = passes.parts(inputs, [&mut *u], add, |part, [p, h], [u]| {
            let [start, end] = part.within(&window[0]);
            displace(part.first + start, &mut u[start * ny..end * ny]);
            part.each([p, u, h], [], add, |row, fields, []| {
                let part = row.part(window, fields);
                let sums = part.map(|(row, fields)| self.fit_near(near, row, fields));
                sums.unwrap_or_default()
            })
        });
        let motion = Multipliers {
            base: near,
            change: self.freedoms.fitted(fit),
        };
        let [_, f, fx, fy, ..] = fit;
        let sums = passes.parts(inputs, [u], join, |part, [p, h], [u]| {
            let [start, end] = part.within(&window[0]);
            displace(part.first, &mut u[..start * ny]);
            displace(part.first + end, &mut u[end * ny..]);
            part.each([p, u, h], [], join, |row, fields, []| {
                let [deepest, most, lost] = overlap_of(motion, row, fields);
                let part = row.part(window, fields);
                let carried = part.map(|(row, fields)| mismatch_of(motion, row, fields));
                let [work, mismatch] = carried.unwrap_or_default();
                [deepest, most, work, mismatch, lost]
            })
        });
        let [sums @ .., lost] = sums;
        let quality = Quality {
            // The sum is 0, unless one is not finite.
            finite: lost <= 0.0,
            ..self.quality(sums, [f, fx, fy])
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

    /// The quality of a pressure with these `moments`: the deepest overlap, the largest displacement, the
    /// work and the mismatch.
    pub(super) fn quality(
        &self,
        [deepest, most, work, mismatch]: [f64; 4],
        moments: [f64; 3],
    ) -> Quality {
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
            balanced: self.freedoms.on_target(moments),
            finite: true,
        }
    }
}

/// Joins two largest values, and sums.
pub(super) fn join<const S: usize>(a: [f64; S], b: [f64; S]) -> [f64; S] {
    std::array::from_fn(|k| match k {
        0 | 1 if b[k] > a[k] => b[k],
        0 | 1 => a[k],
        _ => a[k] + b[k],
    })
}

/// The deepest overlap of one row, and the largest displacement where it can touch; and 0, unless a
/// displacement is not finite.
fn overlap_of(motion: Multipliers, row: Row, [_, u, h]: [&[f64]; 3]) -> [f64; 3] {
    let step = |u, overlap| ([], depths(u, overlap), [u * ZERO]);
    let overlap = motion.overlap(row);
    let (largest, [lost]) = if motion.tilts() {
        update_with_largest([u, h, row.y], [], |[u, h, y], []| {
            step(u, overlap([u, h, y]))
        })
    } else {
        update_with_largest([u, h], [], |[u, h], []| step(u, overlap([u, h, ZERO])))
    };
    let [deepest, most] = largest;
    [deepest, most, lost]
}

/// What one row adds to the work and the mismatch.
fn mismatch_of(motion: Multipliers, row: Row, [p, u, h]: [&[f64]; 3]) -> [f64; 2] {
    let overlap = motion.overlap(row);
    sum([p, u, h, row.y], |[p, u, h, y]| {
        // The gap is infinite only where there is no pressure.
        let mismatch = where_positive(p, p * overlap([u, h, y]).abs());
        [p * u, mismatch]
    })
}

/// How deep cells overlap, and their displacement where they can touch.
pub(super) fn depths(u: Lanes, overlap: Lanes) -> [Lanes; 2] {
    let touches = overlap.simd_gt(all(f64::NEG_INFINITY));
    [overlap, touches & u.abs()]
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

    /// Whether the motion depends on y.
    fn tilts(self) -> bool {
        self.base[2] != 0.0 || self.change[2] != 0.0
    }

    /// How deep cells in a row overlap, −g = Bλ − (u + h), from u, h and their coordinates.
    fn overlap(self, row: Row) -> impl Fn([Lanes; 3]) -> Lanes {
        let [[a, b], [c, d]] =
            [self.base, self.change].map(|l| [all(l[0] + l[1] * row.x), all(l[2])]);
        move |[u, h, y]| (c + d * y) - ((h - (a + b * y)) + u)
    }

    /// The gap in a row.
    pub(super) fn gap(self, row: Row, [u, h]: [&[f64]; 2], g: &mut [f64]) {
        let overlap = self.overlap(row);
        update([u, h, row.y], [g], |fields, _| {
            ([ZERO - overlap(fields)], [])
        });
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
