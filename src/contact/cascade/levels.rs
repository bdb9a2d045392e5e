//! Nested grids: one grid's coefficients, its problem, and its solution in a window around the contact.
//!
//! Its influence coefficients are a corner of the grid's.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use ndarray::Array2;

use crate::contact::cascade::discretisation::Figures;
use crate::contact::cascade::patch::{Patch, block, copied, hull, rows, widened};
use crate::contact::problem::freedoms::Freedoms;
use crate::contact::problem::{Limits, Outcome, Problem, Termination, Watch};
use crate::contact::solver::active_set;
use crate::contact::solver::preconditioned::{Approximation, Memory, Preconditioned};
use crate::contact::start::checked_gaps;
use crate::convolution::Convolution;
use crate::error::Result;
use crate::grid::Grid;
use crate::parallel::Passes;
use crate::parallel::Pool;
use crate::parallel::{all, update, update_with_largest};
use crate::surface::Surface;

/// A direction with fewer cells is not halved.
const COARSEST: usize = 32;

/// Which directions of a grid are halved for the next coarser one; none at the coarsest.
pub(crate) fn halved(shape: [usize; 2]) -> [bool; 2] {
    shape.map(|n| n >= 2 * COARSEST)
}

/// The grid of cells twice as long in the directions of `halved`, which starts where `fine` does.
fn coarse_grid(fine: &Grid, halved: [bool; 2]) -> Result<Grid> {
    let (shape, spacing, center) = (fine.shape(), fine.spacing(), fine.center());
    let cells = [0, 1].map(|k| {
        if halved[k] {
            shape[k].div_ceil(2)
        } else {
            shape[k]
        }
    });
    let longer = halved.map(|halved| if halved { 2.0 } else { 1.0 });
    let sides = [0, 1].map(|k| longer[k] * spacing[k] * cells[k] as f64);
    let grown = [0, 1].map(|k| 0.5 * (sides[k] - fine.size()[k]));
    let grid = if fine.is_line() {
        Grid::line(cells[1], sides[1])?
    } else {
        Grid::new(cells, sides)?
    };
    grid.centered_at([0, 1].map(|k| center[k] + grown[k]))
}

/// A grid and all coarser ones, each with its own influence coefficients.
#[derive(Debug)]
pub(crate) struct Levels {
    /// From the finest on.
    coefficients: Arc<Vec<Array2<f64>>>,
    /// Of the coarser ones.
    convolutions: Vec<Convolution>,
    grids: Vec<Grid>,
    memory: Pool<Memory>,
}

impl Levels {
    /// Plans the coarser grids of `finest`, which has the coefficients `of` gives and `convolution`.
    pub(crate) fn plan(
        finest: Grid,
        coefficients: Array2<f64>,
        convolution: &Convolution,
        of: impl Fn(&Grid) -> Result<Array2<f64>>,
    ) -> Result<Self> {
        let (mut coefficients, mut grids) = (vec![coefficients], vec![finest]);
        let mut convolutions = Vec::new();
        let mut fine = finest;
        while halved(fine.shape()) != [false; 2] {
            fine = coarse_grid(&fine, halved(fine.shape()))?;
            let coarse = of(&fine)?;
            convolutions.push(convolution.companion(&coarse));
            coefficients.push(coarse);
            grids.push(fine);
        }
        Ok(Self {
            coefficients: Arc::new(coefficients),
            convolutions,
            grids,
            memory: Pool::default(),
        })
    }

    /// The same levels on the threads of `finest`; they share all that is large.
    pub(crate) fn beside(&self, finest: &Convolution) -> Self {
        let convolutions = self.convolutions.iter();
        Self {
            coefficients: Arc::clone(&self.coefficients),
            convolutions: convolutions.map(|c| c.sharing_with(finest)).collect(),
            grids: self.grids.clone(),
            memory: Pool::default(),
        }
    }

    /// The finest level, of `problem`, which has this `gap`.
    pub(crate) fn finest<'a>(&'a self, problem: &Problem<'a>, gap: &'a Array2<f64>) -> Level<'a> {
        Level {
            coefficients: &self.coefficients[0],
            convolution: problem.convolution,
            freedoms: problem.freedoms.clone(),
            gap: Cow::Borrowed(gap),
            memory: self.memory(),
        }
    }

    /// The coarser levels, from the finest of them on; `freedoms` and `gap` are those of the finest level.
    /// None where a gap must be made of that one, and it is not given.
    pub(crate) fn coarser(
        &self,
        freedoms: &Freedoms,
        gap: Option<&Array2<f64>>,
        shape: &dyn Surface,
    ) -> Option<Vec<Level<'_>>> {
        let mut levels: Vec<Level> = Vec::new();
        let coarser = self.coefficients.iter().zip(&self.grids).skip(1);
        let finer = self.grids.iter().map(Grid::shape);
        for (((coefficients, grid), convolution), finer) in
            coarser.zip(&self.convolutions).zip(finer)
        {
            let halved = halved(finer);
            let fine = levels.last();
            let freedoms = fine.map_or(freedoms, |fine| &fine.freedoms).coarse(halved);
            let passes = Passes::new(&freedoms.columns, convolution.own_threads());
            // A measured surface has no values for cells that are much larger than its own.
            let gap = match checked_gaps(shape, grid, &passes) {
                Ok(mut gap) => {
                    if freedoms.any_prescribed() {
                        freedoms.prescribe(&mut gap);
                    }
                    gap
                }
                Err(_) => coarse_gap(fine.map_or(gap, |fine| Some(&fine.gap))?, halved),
            };
            levels.push(Level {
                coefficients,
                convolution,
                freedoms,
                gap: Cow::Owned(gap),
                memory: self.memory(),
            });
        }
        Some(levels)
    }

    /// Of iterations, and how many cells they may have.
    fn memory(&self) -> (&Pool<Memory>, usize) {
        (&self.memory, self.coefficients[0].len())
    }
}

/// Mean gap over coarse cells; of the fine cells that can touch.
fn coarse_gap(fine: &Array2<f64>, halved: [bool; 2]) -> Array2<f64> {
    let (nx, ny) = fine.dim();
    let span = |i: usize, n: usize, halved: bool| -> Range<usize> {
        if halved {
            2 * i..(2 * i + 2).min(n)
        } else {
            i..i + 1
        }
    };
    let half = |n: usize, halved: bool| if halved { n.div_ceil(2) } else { n };
    Array2::from_shape_fn((half(nx, halved[0]), half(ny, halved[1])), |(i, j)| {
        let (mut sum, mut count) = (0.0, 0);
        for h in block(fine, &[span(i, nx, halved[0]), span(j, ny, halved[1])]) {
            if h.is_finite() {
                sum += h;
                count += 1;
            }
        }
        if count > 0 {
            sum / f64::from(count)
        } else {
            f64::INFINITY
        }
    })
}

/// One grid: its coefficients, and its problem.
pub(crate) struct Level<'a> {
    coefficients: &'a Array2<f64>,
    convolution: &'a Convolution,
    pub(crate) freedoms: Freedoms,
    pub(crate) gap: Cow<'a, Array2<f64>>,
    /// Of iterations, and how many cells they may have.
    memory: (&'a Pool<Memory>, usize),
}

impl Level<'_> {
    pub(crate) fn shape(&self) -> [usize; 2] {
        [self.gap.nrows(), self.gap.ncols()]
    }

    /// What a solution of this grid gives.
    pub(crate) fn figures(&self, patch: &Patch, lambda: [f64; 3]) -> Figures {
        let ([peak], [sum]) = update_with_largest([&patch.values], [], |[p], []| ([], [p], [p]));
        Figures {
            peak_pressure: peak,
            approach: self.freedoms.motion(lambda).0,
            load: sum * self.freedoms.cell_area,
        }
    }

    /// Makes a pressure one that cells can carry and that is balanced. False where that cannot be.
    pub(crate) fn balance(&self, patch: &mut Patch) -> bool {
        let pressures = patch.values.chunks_exact_mut(patch.window[1].len().max(1));
        for (p, gaps) in pressures.zip(rows(&self.gap, &patch.window)) {
            update([gaps], [p], |[h], [p]| {
                ([h.simd_lt(all(f64::INFINITY)) & p], [])
            });
        }
        self.freedoms
            .part(patch.window.clone())
            .balance(&mut patch.values)
    }

    /// Solves in the window of `patch`, which opens while the contact reaches its edge; `patch`
    /// becomes the solution.
    pub(crate) fn solve(
        &self,
        patch: &mut Patch,
        limits: Limits,
        work: &mut f64,
        watch: &mut Watch,
    ) -> Outcome {
        let shape = self.shape();
        let mut done = 0;
        loop {
            let window = &patch.window;
            let whole = *window == shape.map(|n| 0..n);
            let corner = block(self.coefficients, &[0..window[0].len(), 0..window[1].len()]);
            let freedoms = self.freedoms.part(window.clone());
            let passes = Passes::new(&freedoms.columns, self.convolution.own_threads());
            // Planning transforms leaves the other threads idle in part: meanwhile they get the memory.
            let ((part, [periodic, inverse]), (gap, memory)) = passes.both(
                || {
                    let part = (!whole).then(|| self.convolution.companion(&corner));
                    (part, self.convolution.preconditioner(&corner))
                },
                || {
                    let (memory, most) = self.memory;
                    let mut memory = memory.lease();
                    memory.fit(&passes, most, freedoms.loaded);
                    (copied(&self.gap, window), memory)
                },
            );
            let approximation = Approximation { inverse, periodic };
            let problem = Problem {
                convolution: part.as_ref().unwrap_or(self.convolution),
                freedoms: &freedoms,
                gap: &gap,
            };
            let mut solver = Preconditioned::new(&problem, &approximation, memory);
            let before = *work;
            let mut outcome = solver.solve(
                &mut patch.values,
                limits.after(done),
                &mut |iterations, spent, quality| watch(done + iterations, before + spent, quality),
            );
            *work += solver.work;
            done += outcome.iterations;
            // Its workspace serves the next.
            drop(solver);
            if outcome.termination == Termination::IterationLimit && done < limits.max_iterations {
                let before = *work;
                outcome = active_set::solve(
                    &problem,
                    &corner,
                    &mut patch.values,
                    outcome.lambda,
                    limits.after(done),
                    &mut |more, spent, quality| watch(done + more, before + spent, quality),
                );
                *work += outcome.work;
                done += outcome.iterations;
            }
            let outcome = Outcome {
                iterations: done,
                work: *work,
                ..outcome
            };
            let Some(contact) = patch.contact() else {
                return outcome;
            };
            let reached = (0..2).any(|k| {
                (contact[k].start == patch.window[k].start && contact[k].start > 0)
                    || (contact[k].end == patch.window[k].end && contact[k].end < shape[k])
            });
            if whole || !reached || outcome.termination != Termination::Converged {
                return outcome;
            }
            *patch = patch.moved(widened(&hull(&contact, &patch.window), shape));
        }
    }
}
