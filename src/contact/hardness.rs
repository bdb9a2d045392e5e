//! A limit of the pressure: elastic, perfectly plastic surfaces, which yield at their hardness.
//!
//! ```text
//! p = 0: g ≥ 0      0 < p < H: g = 0      p = H: g ≤ 0, and −g is the permanent indentation
//! ```
//!
//! Polonsky & Keer, Wear 231 (1999) 206, §2.3, doi:10.1016/S0043-1648(99)00113-1; Almqvist, Sahlin, Larsson &
//! Glavatskih, Tribol. Int. 40 (2007) 574, doi:10.1016/j.triboint.2005.11.008. The algorithm is nacre's own.
//!
//! Cells that yield bear H. The others are an elastic contact, under the rest of the load, with the surface that
//! the yielding cells have displaced. From the elastic solution on, cells that bear more than H yield, until there are
//! none. On a half-space no cell yields too early: the others can only come to bear more while cells yield. Cells that
//! part nevertheless, as they may on layers, bear less than H again.

use ndarray::{Array2, ArrayRef2};

use super::problem::Problem;
use super::problem::fields::{Fields, array, slice, slice_mut};
use super::problem::freedoms::Freedoms;
use super::solver::{Outcome, StopCriteria, Termination, Watch};
use crate::error::{Error, Result};
use crate::grid::{Grid, full_window};

/// Largest pressure that a surface bears \[Pa\], above 0; +∞ where it does not yield.
#[derive(Debug, Clone, PartialEq)]
pub enum Hardness {
    /// The same everywhere.
    Uniform(f64),
    /// One for each cell of the grid, (nx, ny).
    Cells(Array2<f64>),
}

impl Hardness {
    /// The hardness as it was given, on `grid`.
    ///
    /// # Errors
    /// An array of another shape than the grid, and a value that is not above 0.
    pub(super) fn check(&self, grid: &Grid) -> Result<()> {
        let (name, requirement) = ("hardness", "above 0");
        let values = match self {
            Self::Uniform(value) => std::slice::from_ref(value),
            Self::Cells(values) => {
                check_shape(name, values, grid)?;
                values.as_slice().unwrap_or(&[])
            }
        };
        match values.iter().find(|h| h.is_nan() || **h <= 0.0) {
            Some(&value) => Err(Error::Parameter {
                name,
                requirement,
                value,
            }),
            None => Ok(()),
        }
    }

    /// Hardness of a cell by its number in C order.
    pub(crate) fn at(&self, cell: usize) -> f64 {
        match self {
            Self::Uniform(value) => *value,
            Self::Cells(values) => slice(values)[cell],
        }
    }

    /// The hardness, where it is the same everywhere: grids may be chosen with it.
    pub(super) fn uniform(&self) -> Option<&Self> {
        matches!(self, Self::Uniform(_)).then_some(self)
    }
}

/// An error unless an array has the shape of `grid`.
fn check_shape(name: &'static str, values: &ArrayRef2<f64>, grid: &Grid) -> Result<()> {
    let (expected, found) = (grid.shape(), [values.nrows(), values.ncols()]);
    match found == expected {
        true => Ok(()),
        false => Err(Error::Shape {
            name,
            expected,
            found,
        }),
    }
}

/// An error unless an indentation to start with suits `grid`, and is finite and nowhere below 0.
pub(super) fn check_indentation(indentation: &ArrayRef2<f64>, grid: &Grid) -> Result<()> {
    let name = "indentation";
    check_shape(name, indentation, grid)?;
    if let Some((index, _)) = indentation.indexed_iter().find(|(_, w)| !w.is_finite()) {
        return Err(Error::NonFinite {
            name,
            index: index.into(),
        });
    }
    match indentation.iter().find(|w| **w < 0.0) {
        Some(&value) => Err(Error::Parameter {
            name,
            requirement: "at least 0 everywhere",
            value,
        }),
        None => Ok(()),
    }
}

/// An error where the load is above what the cells that can touch bear.
///
/// # Errors
/// [`Error::Overload`].
pub(super) fn check_load(problem: &Problem, hardness: &Hardness) -> Result<()> {
    let touching = (0..problem.gap.len()).filter(|&k| problem.gap[k].is_finite());
    let bears: f64 = touching.map(|k| hardness.at(k)).sum();
    let freedoms = problem.freedoms;
    match freedoms.loaded[0] && freedoms.target[0] >= bears {
        true => Err(Error::Overload {
            load: freedoms.target[0] * freedoms.cell_area,
            bears: bears * freedoms.cell_area,
        }),
        false => Ok(()),
    }
}

/// Solves an elastic contact from a pressure, or from a uniform one. The arguments are the problem, its gap as an
/// array, the pressure, the fields of the solution and when to end.
pub(super) type Elastic<'a> = dyn FnMut(
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

/// Local displacement \[m\] under a pressure.
fn local(problem: &Problem, pressure: impl Iterator<Item = f64>) -> f64 {
    let loaded = pressure.filter(|p| *p > 0.0);
    let [force, cells] = loaded.fold([0.0, 0.0], |[force, cells], p| [force + p, cells + 1.0]);
    problem.local.under(force, cells)
}

/// Cells that yield, and what they leave to the others.
pub(super) struct Yielding<'a> {
    problem: &'a Problem<'a>,
    hardness: &'a Hardness,
    /// Pressure of the cells that yield, 0 in the others.
    held: Vec<f64>,
    /// Displacement under it.
    displaced: Vec<f64>,
}

impl<'a> Yielding<'a> {
    /// No cell yields.
    pub(super) fn new(problem: &'a Problem<'a>, hardness: &'a Hardness) -> Self {
        let cells = problem.gap.len();
        Self {
            problem,
            hardness,
            held: vec![0.0; cells],
            displaced: vec![0.0; cells],
        }
    }

    /// Lets cells yield until the pressure in `fields`, which is the elastic solution that ended with `outcome`, is
    /// nowhere above the hardness. Returns the permanent indentation that this makes; `None` where no cell yields,
    /// and the elastic solution stays as it is.
    ///
    /// # Errors
    /// Eccentricity or moment that no pressure up to the hardness has; errors of `elastic`.
    pub(super) fn solve(
        &mut self,
        fields: &mut Fields,
        outcome: &mut Outcome,
        criteria: StopCriteria,
        elastic: &mut Elastic,
        watch: &mut Watch,
    ) -> Result<Option<Vec<f64>>> {
        let mut overlap = vec![0.0; self.held.len()];
        for _ in 0..ROUNDS {
            if outcome.termination == Termination::Stopped {
                break;
            }
            if !self.update(slice(&fields.pressure), &overlap, criteria.tolerance)? {
                break;
            }
            let left = criteria.after(outcome.iterations.min(criteria.max_iterations));
            let done = self.round(fields, left, elastic, &mut |more, spent, quality| {
                watch(outcome.iterations + more, outcome.work + spent, quality)
            })?;
            *outcome = done.after(outcome.iterations, outcome.work);
            self.overlap_into(fields, &mut overlap);
        }
        if self.held.iter().all(|p| *p <= 0.0) {
            return Ok(None);
        }
        // What was certified is the elastic part alone.
        fields.quality = None;
        fields.window = full_window(self.problem.convolution.shape());
        let pressure = slice_mut(&mut fields.pressure).iter_mut();
        pressure.zip(&self.held).for_each(|(p, held)| *p += held);
        let held = overlap.iter().zip(&self.held);
        let deeper = held.map(|(o, held)| if *held > 0.0 { o.max(0.0) } else { 0.0 });
        Ok(Some(deeper.collect()))
    }

    /// Displacement \[m\] to which gaps and overlaps are compared, under this `pressure` and that of the cells that
    /// yield.
    fn scale(&self, pressure: &[f64]) -> f64 {
        local(
            self.problem,
            pressure.iter().zip(&self.held).map(|(p, held)| p + held),
        )
    }

    /// Finds which cells yield, from the pressure of those that did not and the overlap of those that did. False
    /// where they are the same as before.
    ///
    /// # Errors
    /// Eccentricity or moment that no pressure up to the hardness has.
    fn update(&mut self, pressure: &[f64], overlap: &[f64], tolerance: f64) -> Result<bool> {
        let slack = TIGHTER * tolerance * self.scale(pressure);
        let mut changed = false;
        let mut joining = Vec::new();
        for (k, held) in self.held.iter_mut().enumerate() {
            let limit = self.hardness.at(k);
            if *held > 0.0 && overlap[k] < -slack {
                (*held, changed) = (0.0, true);
            } else if *held <= 0.0 && pressure[k] > limit {
                joining.push((k, pressure[k] / limit));
            }
        }
        joining.sort_by(|(_, a), (_, b)| b.total_cmp(a));
        let mut count = joining.len();
        for (k, _) in &joining {
            self.held[*k] = self.hardness.at(*k);
        }
        // Where the others could not bear the rest of the moments, only those yield that bear most too much.
        while !self.rest_is_feasible() {
            if count == 0 {
                return Err(Error::Inconsistent(
                    "no pressure up to the hardness has this eccentricity or moment under this load",
                ));
            }
            for (k, _) in &joining[count / 2..count] {
                self.held[*k] = 0.0;
            }
            count /= 2;
        }
        Ok(changed || count > 0)
    }

    /// Whether the cells that do not yield can bear the rest of the load and of the moments.
    fn rest_is_feasible(&self) -> bool {
        let (freedoms, share) = self.rest();
        if freedoms.only_force() || !freedoms.any_loaded() {
            return share >= -NO_LOAD;
        }
        let cells = self.held.iter().zip(self.problem.gap);
        let gap = cells.map(|(held, h)| if *held > 0.0 { f64::INFINITY } else { *h });
        let gap = array(self.problem.convolution.shape(), gap.collect());
        share > NO_LOAD && freedoms.check_feasible(&gap).is_ok()
    }

    /// The elastic contact of the cells that do not yield, whose pressure goes into `fields`.
    fn round(
        &mut self,
        fields: &mut Fields,
        criteria: StopCriteria,
        elastic: &mut Elastic,
        watch: &mut Watch,
    ) -> Result<Outcome> {
        let problem = self.problem;
        let (convolution, shape) = (problem.convolution, problem.convolution.shape());
        problem.apply(
            &self.held,
            &mut self.displaced,
            &mut convolution.workspace(),
        );
        let (freedoms, share) = self.rest();
        let cells = self.held.iter().zip(&self.displaced).zip(problem.gap);
        let gap = cells.map(|((held, u), h)| if *held > 0.0 { f64::INFINITY } else { h + u });
        let gap = array(shape, gap.collect());
        let rest = Problem {
            freedoms: &freedoms,
            gap: slice(&gap),
            ..*problem
        };
        // The pressure so far, without that of the cells that yield.
        let mut start = fields.pressure.clone();
        let cells = slice_mut(&mut start).iter_mut().zip(rest.gap);
        cells.for_each(|(p, h)| *p = if h.is_finite() { *p } else { 0.0 });
        let near = fields.multipliers;
        fields.pressure.fill(0.0);
        if share <= NO_LOAD {
            return Ok(self.touch(&rest, fields));
        }
        let balanced = freedoms.balance(slice_mut(&mut start));
        fields.multipliers = near;
        // The same error is a larger one of the lesser displacement under the rest of the load.
        let (whole, part) = (self.scale(slice(&start)), slice(&start).iter().copied());
        let less = whole / local(problem, part).min(whole);
        let criteria = StopCriteria {
            tolerance: (TIGHTER * less * criteria.tolerance).min(LOOSEST),
            ..criteria
        };
        let done = elastic(
            &rest,
            &gap,
            balanced.then_some(start),
            fields,
            criteria,
            watch,
        )?;
        Ok(Outcome {
            work: done.work + convolution.work(),
            ..done
        })
    }

    /// Degrees of freedom of the cells that do not yield, and their share of the load; 1 where it is not given.
    fn rest(&self) -> (Freedoms, f64) {
        let mut freedoms = self.problem.freedoms.clone();
        let (all, held) = (freedoms.target[0], freedoms.moments(&self.held));
        for k in (0..3).filter(|&k| self.problem.freedoms.loaded[k]) {
            freedoms.target[k] -= held[k];
        }
        let share = match freedoms.loaded[0] {
            true => freedoms.target[0] / all,
            false => 1.0,
        };
        (freedoms, share)
    }

    /// The cells that yield bear the whole load, and the surfaces approach until the next cell touches.
    fn touch(&self, rest: &Problem, fields: &mut Fields) -> Outcome {
        let first = rest.gap.iter().copied().fold(f64::INFINITY, f64::min);
        let lambda = [if first.is_finite() { first } else { 0.0 }, 0.0, 0.0];
        let quality = fields.certify(rest, lambda);
        Outcome {
            solver: super::solver::Solver::ActiveSet,
            termination: match quality.overflows() {
                true => Termination::IterationLimit,
                false => Termination::Converged,
            },
            iterations: 0,
            work: rest.convolution.work(),
            lambda,
        }
    }

    /// Writes the overlap −g of all cells, for the pressure in `fields` and that of the cells that yield. The
    /// displacement in `fields` becomes that of both.
    fn overlap_into(&self, fields: &mut Fields, overlap: &mut [f64]) {
        let u = slice_mut(&mut fields.displacement);
        u.iter_mut().zip(&self.displaced).for_each(|(u, d)| *u += d);
        self.problem.gap_into(u, fields.multipliers, overlap);
        overlap.iter_mut().for_each(|g| *g = -*g);
    }
}
