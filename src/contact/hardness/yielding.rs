//! Cells that yield, found in rounds of elastic contacts of the others.

use ndarray::Array2;

use super::Hardness;
use crate::contact::problem::fields::{Fields, array, slice, slice_mut};
use crate::contact::problem::freedoms::Freedoms;
use crate::contact::problem::{Multipliers, Problem};
use crate::contact::solver::{Outcome, Solver, StopCriteria, Termination, Watch};
use crate::error::{Error, Result};
use crate::model::grid::full_window;

/// Solves an elastic contact from a pressure, or from a uniform one. The arguments are the problem, its gap as an
/// array, the pressure, the fields of the solution and when to end.
pub(in crate::contact) type Elastic<'a> = dyn FnMut(
        &Problem,
        &Array2<f64>,
        Option<Array2<f64>>,
        &mut Fields,
        StopCriteria,
        &mut Watch,
    ) -> Result<Outcome>
    + 'a;

/// Rounds of yielding after which the solve is given up: rough contacts take some ten to thirty.
const ROUNDS: usize = 300;

/// Load that is left to the cells that do not yield, relative to all, which is rounding: a tenth of what counts as
/// balanced.
const NO_LOAD: f64 = 2e-14;

/// Residual, overlap and gaps of the parts, relative to those of the whole.
const TIGHTER: f64 = 0.03;

/// Largest residual and overlap of the elastic part where it carries little of the load.
const LOOSEST: f64 = 1e-3;

/// The error where moments are asked for that the yielding surfaces do not bear.
const NOT_BORNE: Error = Error::Inconsistent(
    "no pressure up to the hardness has this eccentricity or moment: give a larger hardness or a smaller load",
);

/// Local displacement \[m\] under a pressure.
fn local(problem: &Problem, pressure: impl Iterator<Item = f64>) -> f64 {
    let loaded = pressure.filter(|p| *p > 0.0);
    let [force, cells] = loaded.fold([0.0, 0.0], |[force, cells], p| [force + p, cells + 1.0]);
    problem.local.under(force, cells)
}

/// Cells that yield, and how the others are solved.
pub(in crate::contact) struct Yielding<'a, 'b> {
    hardness: &'a Hardness,
    /// Pressure of the cells that yield, 0 in the others.
    held: Vec<f64>,
    /// Displacement under it.
    displaced: Vec<f64>,
    /// Overlap −g of all cells after the last round.
    overlap: Vec<f64>,
    criteria: StopCriteria,
    elastic: &'a mut Elastic<'b>,
    watch: &'a mut Watch<'b>,
    /// All that was done so far.
    outcome: Outcome,
}

impl<'a, 'b> Yielding<'a, 'b> {
    /// No cell yields after the elastic solution that ended with `outcome`.
    pub(in crate::contact) fn new(
        hardness: &'a Hardness,
        cells: usize,
        criteria: StopCriteria,
        outcome: Outcome,
        (elastic, watch): (&'a mut Elastic<'b>, &'a mut Watch<'b>),
    ) -> Self {
        let zeros = || vec![0.0; cells];
        Self {
            hardness,
            held: zeros(),
            displaced: zeros(),
            overlap: zeros(),
            criteria,
            elastic,
            watch,
            outcome,
        }
    }

    /// Lets cells yield until the pressure in `fields`, which is the elastic solution of `problem`, is nowhere above
    /// the hardness. Returns how the solve ended, and the permanent indentation that this makes; `None` where no cell
    /// yields, and the elastic solution stays as it is.
    ///
    /// # Errors
    /// Eccentricity or moment that no pressure up to the hardness has; errors of the elastic contacts.
    pub(in crate::contact) fn solve(
        mut self,
        problem: &Problem,
        fields: &mut Fields,
    ) -> Result<(Outcome, Option<Vec<f64>>)> {
        for _ in 0..ROUNDS {
            if self.stopped() || !self.update(problem, slice(&fields.pressure))? {
                break;
            }
            self.round(problem, fields)?;
        }
        if !self.any() {
            return Ok((self.outcome, None));
        }
        // What was certified is the elastic part alone.
        fields.quality = None;
        fields.window = full_window(problem.convolution.shape());
        let pressure = slice_mut(&mut fields.pressure).iter_mut();
        pressure.zip(&self.held).for_each(|(p, held)| *p += held);
        let held = self.overlap.iter().zip(&self.held);
        let deeper = held.map(|(o, held)| if *held > 0.0 { o.max(0.0) } else { 0.0 });
        Ok((self.outcome, Some(deeper.collect())))
    }

    /// Whether any cell yields.
    fn any(&self) -> bool {
        self.held.iter().any(|p| *p > 0.0)
    }

    /// Whether the caller stopped the solve.
    fn stopped(&self) -> bool {
        self.outcome.termination == Termination::Stopped
    }

    /// Displacement \[m\] to which gaps and overlaps are compared, under this `pressure` and that of the cells that
    /// yield.
    fn scale(&self, problem: &Problem, pressure: &[f64]) -> f64 {
        local(
            problem,
            pressure.iter().zip(&self.held).map(|(p, held)| p + held),
        )
    }

    /// Finds which cells yield, from the pressure of those that did not and the overlap of those that did. False
    /// where they are the same as before.
    ///
    /// # Errors
    /// Eccentricity or moment that no pressure up to the hardness has.
    fn update(&mut self, problem: &Problem, pressure: &[f64]) -> Result<bool> {
        let slack = TIGHTER * self.criteria.tolerance * self.scale(problem, pressure);
        let mut changed = false;
        let mut joining = Vec::new();
        for (k, held) in self.held.iter_mut().enumerate() {
            let limit = self.hardness.at(k);
            if *held > 0.0 && self.overlap[k] < -slack {
                (*held, changed) = (0.0, true);
            } else if *held <= 0.0 && pressure[k] > limit {
                joining.push((k, pressure[k] / limit));
            }
        }
        // Where the others could not bear the rest, only those yield that bear most too much.
        joining.sort_by(|(_, a), (_, b)| b.total_cmp(a));
        let mut count = joining.len();
        loop {
            for (place, (k, _)) in joining.iter().enumerate() {
                self.held[*k] = if place < count {
                    self.hardness.at(*k)
                } else {
                    0.0
                };
            }
            if self.rest_is_borne(problem) {
                break;
            }
            if count == 0 {
                return Err(NOT_BORNE);
            }
            count /= 2;
        }
        match changed || count > 0 || joining.is_empty() {
            true => Ok(changed || count > 0),
            false => Err(NOT_BORNE),
        }
    }

    /// Whether the cells that do not yield can bear the rest of load and moments.
    fn rest_is_borne(&self, problem: &Problem) -> bool {
        let (rest, share) = self.rest(problem);
        if !(rest.loaded[1] || rest.loaded[2]) {
            return share >= -NO_LOAD;
        }
        let cells = self.held.iter().zip(problem.gap);
        let gap = cells.map(|(held, h)| if *held > 0.0 { f64::INFINITY } else { *h });
        let gap = array(problem.convolution.shape(), gap.collect());
        share > NO_LOAD && rest.check_feasible(&gap).is_ok()
    }

    /// The elastic contact of the cells that do not yield: its pressure, without that of the cells that yield, and the
    /// displacement of both go into `fields`.
    fn round(&mut self, problem: &Problem, fields: &mut Fields) -> Result<()> {
        let (convolution, shape) = (problem.convolution, problem.convolution.shape());
        let workspace = &mut convolution.workspace();
        problem.apply(&self.held, &mut self.displaced, workspace);
        let (freedoms, share) = self.rest(problem);
        let cells = self.held.iter().zip(&self.displaced).zip(problem.gap);
        let gap = cells.map(|((held, u), h)| if *held > 0.0 { f64::INFINITY } else { h + u });
        let gap = array(shape, gap.collect());
        let rest = Problem {
            freedoms: &freedoms,
            gap: slice(&gap),
            ..*problem
        };
        let done = if share <= NO_LOAD {
            touch(&rest, fields)
        } else {
            self.press(&rest, &gap, fields)?
        };
        self.outcome = done.after(
            self.outcome.iterations,
            self.outcome.work + convolution.work(),
        );
        let u = slice_mut(&mut fields.displacement);
        u.iter_mut().zip(&self.displaced).for_each(|(u, d)| *u += d);
        problem.gap_into(u, fields.multipliers, &mut self.overlap);
        self.overlap.iter_mut().for_each(|g| *g = -*g);
        Ok(())
    }

    /// Solves the contact of the cells that do not yield, from the pressure that they had.
    fn press(&mut self, rest: &Problem, gap: &Array2<f64>, fields: &mut Fields) -> Result<Outcome> {
        let mut start = fields.pressure.clone();
        let cells = slice_mut(&mut start).iter_mut().zip(rest.gap);
        cells.for_each(|(p, h)| *p = if h.is_finite() { *p } else { 0.0 });
        let balanced = rest.freedoms.balance(slice_mut(&mut start));
        // The same error is a larger one of the lesser displacement under the rest of the load, where that is known.
        let less = if balanced {
            let whole = self.scale(rest, slice(&start));
            whole / local(rest, slice(&start).iter().copied()).min(whole)
        } else {
            1.0
        };
        let (before, most) = (self.outcome, self.criteria.max_iterations);
        let criteria = StopCriteria {
            tolerance: (TIGHTER * less * self.criteria.tolerance).min(LOOSEST),
            ..self.criteria.after(before.iterations.min(most))
        };
        fields.pressure.fill(0.0);
        fields.multipliers = Multipliers::default();
        let watch = &mut self.watch;
        let mut counted = |more: usize, spent: f64, quality| {
            watch(before.iterations + more, before.work + spent, quality)
        };
        let start = balanced.then_some(start);
        (self.elastic)(rest, gap, start, fields, criteria, &mut counted)
    }

    /// Degrees of freedom of the cells that do not yield, and their share of the load; 1 where it is not given.
    fn rest(&self, problem: &Problem) -> (Freedoms, f64) {
        let mut freedoms = problem.freedoms.clone();
        let (all, held) = (freedoms.target[0], freedoms.moments(&self.held));
        for k in (0..3).filter(|&k| problem.freedoms.loaded[k]) {
            freedoms.target[k] -= held[k];
        }
        let share = match freedoms.loaded[0] {
            true => freedoms.target[0] / all,
            false => 1.0,
        };
        (freedoms, share)
    }
}

/// The cells that yield bear the whole load, and the surfaces approach until the next cell touches.
fn touch(rest: &Problem, fields: &mut Fields) -> Outcome {
    fields.pressure.fill(0.0);
    let first = rest.gap.iter().copied().fold(f64::INFINITY, f64::min);
    let lambda = [if first.is_finite() { first } else { 0.0 }, 0.0, 0.0];
    let quality = fields.certify(rest, lambda);
    Outcome {
        solver: Solver::ActiveSet,
        termination: match quality.overflows() {
            true => Termination::IterationLimit,
            false => Termination::Converged,
        },
        iterations: 0,
        work: rest.convolution.work(),
        lambda,
    }
}
