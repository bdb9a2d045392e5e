//! The contact window on nested grids, around preconditioned conjugate gradients.
//!
//! The problem is solved on a grid of a few cells first; each solution, interpolated, is where the
//! next finer grid starts. On each grid only a window around the contact is solved. What happens
//! outside is seen afterwards, when the displacement is computed on the whole grid: where something
//! overlaps there, the window opens.

pub(super) mod discretisation;
pub(super) mod levels;
pub(super) mod patch;

use ndarray::Array2;

use super::problem::{Limits, Outcome, Problem, Termination, Watch};
use crate::contact::cascade::discretisation::Figures;
use crate::contact::cascade::levels::{Level, Levels, halved};
use crate::contact::cascade::patch::{Patch, bounds, hull, whole, widened};
use crate::contact::problem::freedoms::Freedoms;
use crate::contact::solution::fields::{Fields, slice};
use crate::surface::Surface;

/// Tolerance of the last but one of the grids, with which the finest is compared.
const COARSE_TOLERANCE: f64 = 1e-5;

/// Tolerance of the grids before: somewhat below their discretisation error.
const COARSER_TOLERANCE: f64 = 1e-4;

/// Solutions of the coarser grids, from the coarsest on.
pub(super) struct Coarser {
    /// That of the last.
    pressure: Option<Patch>,
    figures: Vec<Figures>,
    work: f64,
    /// How it ended where the caller stopped it.
    stopped: Option<Outcome>,
}

impl Coarser {
    /// Solves on the coarser grids of `planned`; `freedoms` and `gap` are those of the finest. None where
    /// `shape` has no gaps for coarser cells, and that `gap`, which serves instead, is not known yet.
    pub(super) fn solve(
        freedoms: &Freedoms,
        gap: Option<&Array2<f64>>,
        shape: &dyn Surface,
        planned: &Levels,
        limits: Limits,
        watch: &mut Watch,
    ) -> Option<Self> {
        let levels = planned.coarser(freedoms, gap, shape)?;
        let mut solved = Self {
            pressure: None,
            figures: Vec::new(),
            work: 0.0,
            stopped: None,
        };
        for (coarser, level) in levels.iter().enumerate().rev() {
            let tolerance = match coarser {
                0 => COARSE_TOLERANCE,
                _ => COARSER_TOLERANCE,
            };
            let limits = Limits {
                tolerance: limits.tolerance.max(tolerance),
                ..limits
            };
            let Some(mut patch) = solved.start(level) else {
                continue;
            };
            if solved.stopped.is_none() {
                let outcome = level.solve(&mut patch, limits, &mut solved.work, watch);
                if outcome.termination == Termination::Stopped {
                    solved.stopped = Some(outcome);
                }
                let figures = level.figures(&patch, outcome.lambda);
                solved.figures.push(figures);
            }
            solved.pressure = Some(patch);
        }
        Some(solved)
    }

    /// What the next grid starts from: the interpolated pressure, or else a uniform one, balanced.
    /// None where that cannot be: coarse cells may not carry the moments that fine ones can.
    fn start(&mut self, level: &Level) -> Option<Patch> {
        let shape = level.shape();
        let halved = halved(shape);
        if (halved.iter().zip(shape)).any(|(halved, n)| !halved && n > 1) {
            // Grids are compared where all their directions were halved.
            self.figures.clear();
        }
        let mut patch = match self.pressure.take() {
            Some(coarse) => coarse.interpolated(shape, halved),
            None => {
                let uniform = level.freedoms.typical_pressure(level.gap.len());
                Patch::whole(&Array2::from_elem(shape, uniform))
            }
        };
        let balanced = level.balance(&mut patch);
        if !balanced {
            self.figures.clear();
        }
        balanced.then_some(patch)
    }
}

/// The finest grid, and where its contact is.
pub(super) struct Cascade<'a> {
    finest: Level<'a>,
    patch: Patch,
    /// Of the coarser grids, from the coarsest on.
    pub(super) figures: Vec<Figures>,
    pub(super) work: f64,
}

impl<'a> Cascade<'a> {
    /// Starts the finest grid from what was solved on the coarser ones, and says how that ended where the
    /// caller stopped it. None where no balanced pressure was found.
    pub(super) fn after(
        mut coarser: Coarser,
        problem: &Problem<'a>,
        gap: &'a Array2<f64>,
        planned: &'a Levels,
    ) -> Option<(Self, Option<Outcome>)> {
        let finest = planned.finest(problem, gap);
        let patch = coarser.start(&finest)?;
        let cascade = Self {
            finest,
            patch,
            figures: coarser.figures,
            work: coarser.work,
        };
        Some((cascade, coarser.stopped))
    }

    /// Starts the finest grid from a `given` pressure.
    pub(super) fn from(
        given: &Array2<f64>,
        problem: &Problem<'a>,
        gap: &'a Array2<f64>,
        planned: &'a Levels,
    ) -> Self {
        let finest = planned.finest(problem, gap);
        let mut patch = Patch::whole(given);
        if let Some(contact) = patch.contact() {
            patch = patch.moved(widened(&contact, finest.shape()));
        }
        Self {
            finest,
            patch,
            figures: Vec::new(),
            work: 0.0,
        }
    }

    /// Gives the pressure that it starts from.
    pub(super) fn give(&self, fields: &mut Fields) {
        fields.take(&self.patch);
    }

    /// Solves on the finest grid; its pressure goes into `fields`.
    pub(super) fn solve(
        &mut self,
        fields: &mut Fields,
        limits: Limits,
        watch: &mut Watch,
    ) -> Outcome {
        let outcome = self
            .finest
            .solve(&mut self.patch, limits, &mut self.work, watch);
        fields.take(&self.patch);
        outcome
    }

    /// Opens the window around the cells of which the gap is negative. False where there is none
    /// outside it.
    pub(super) fn open(&mut self, problem: &Problem, fields: &Fields) -> bool {
        let shape = self.finest.shape();
        let [x, y] = self.patch.window.clone();
        let outside = |i: usize, j: usize| !(x.contains(&i) && y.contains(&j));
        let mut g = vec![0.0; problem.gap.len()];
        problem.gap_into(slice(&fields.displacement), fields.motion, &mut g);
        let found = bounds(&whole(shape), |i, j| {
            outside(i, j) && g[i * shape[1] + j] < 0.0
        });
        if let Some(cells) = &found {
            self.patch = self
                .patch
                .moved(widened(&hull(cells, &self.patch.window), shape));
        }
        found.is_some()
    }
}
