//! One solve, as named steps in order.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use ndarray::Array2;

use super::cascade::corners;
use super::cascade::discretisation::{GridResult, estimate};
use super::cascade::{Cascade, Coarser};
use super::hardness::{Hardness, check_indentation, check_load};
use super::motion::Motion;
use super::options::{Algorithm, Options};
use super::plan::{Plan, bodies};
use super::problem::bounds::Bounds;
use super::problem::fields::{Fields, array, slice};
use super::problem::freedoms::{Freedoms, OVERFLOW};
use super::problem::{Problem, Quality};
use super::solution::Solution;
use super::solution::carried::Carried;
use super::solution::gap::Gap;
use super::solution::report::{Progress, Report};
use super::solution::warnings::{Warning, warnings};
use super::solver::{Outcome, StopCriteria, Termination, Watch, polonsky_keer};
use super::start::{
    Sampled, check_seam, checked_gaps, given_pressure, uniform_pressure, yielding_pressure,
};
use crate::compliance::ends::check_carried;
use crate::error::Result;
use crate::model::surface::{Lifted, Surface};
use crate::numerics::parallel::Rows;

/// Certificates that may fail on a window that need not open, by rounding of the displacement.
const RETRIES: usize = 2;

impl Plan {
    /// Presses `shape` into the body, on this thread and on threads of the plan that are free. Where `shape`
    /// was sampled last, its gaps are not computed again.
    pub(super) fn solve<'a>(
        &self,
        shape: &'a dyn Surface,
        sampled: &mut Sampled<'a>,
        motion: &Motion,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Solution> {
        check_carried(self.setup.counterbody.as_ref(), shape)?;
        check_seam(shape, &self.grid)?;
        let Some(before) = &options.indentation else {
            return self.press(shape, sampled, motion, options, progress);
        };
        check_indentation(before, &self.grid)?;
        let dented = Lifted::new(shape, &self.grid, before.clone());
        let mut solution =
            self.press(&dented, &mut Sampled::default(), motion, options, progress)?;
        solution.indentation = Some(match solution.indentation {
            Some(deeper) => deeper + before,
            None => before.clone(),
        });
        Ok(solution)
    }

    /// Presses a shape into the body that has the indentations of earlier solves.
    fn press<'a>(
        &self,
        shape: &'a dyn Surface,
        sampled: &mut Sampled<'a>,
        motion: &Motion,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Solution> {
        let start = Instant::now();
        let freedoms = Freedoms::new(motion, &self.grid)?;
        if let Some(hardness) = &options.hardness {
            hardness.check(&self.grid)?;
        }
        let limited = self.ends.limit(shape);
        let (given, shape): (_, &dyn Surface) = match self.ends.any() {
            true => (shape, &limited),
            false => (shape, shape),
        };
        if !freedoms.loaded[0] {
            self.datum.check_approach()?;
        }
        let criteria = options.stop_criteria()?;
        let rows = Rows::new(&freedoms.columns, self.convolution.own_threads());
        let mut report = Report::planned(self, shape, motion, criteria.tolerance);
        let unit = self.convolution.work();
        let mut watch = |iterations: usize, work: f64, quality: Quality| -> ControlFlow<()> {
            report.count(iterations, work / unit, quality);
            report.seconds = start.elapsed().as_secs_f64();
            progress(&report)
        };

        // The gap on the finest grid; at the same time coarser solutions, since fetching memory may take
        // long and the coarsest grids are too small for several threads.
        let cascades = options.algorithm == Algorithm::Cascade;
        // An approach that may be too large for a solution is looked at before.
        let yields = (options.hardness.as_ref()).is_some_and(Hardness::is_limited);
        let bounded = self.datum.floats() && !freedoms.loaded[0] && !yields;
        let mut coarser = |gap: Option<&Array2<f64>>| {
            Coarser::solve(&freedoms, gap, shape, &self.levels, criteria, &mut watch)
        };
        let (finest, ahead) = rows.both(
            || self.finest_gap(given, shape, sampled, &freedoms, &rows),
            || (cascades && options.initial.is_none() && !bounded).then(|| coarser(None)),
        );
        let (gap, mut fields) = finest?;
        if bounded {
            self.datum.check_gap(motion.approach.unwrap_or(0.0), &gap)?;
        }
        let no_limit = Bounds::none(self.grid.shape()[1]);
        let problem = Problem {
            convolution: &self.convolution,
            freedoms: &freedoms,
            gap: slice(&gap),
            local: &self.local,
            bounds: &no_limit,
        };

        if let Some(hardness) = &options.hardness {
            check_load(&problem, hardness)?;
        }

        // The start: a given pressure, or the coarser solutions.
        let initial = given_pressure(&problem, options.initial.as_deref())?;
        let cascade = match &initial {
            _ if !cascades => None,
            Some(given) => Some(Cascade::from(given, &problem, &gap, &self.levels)),
            None => (ahead.flatten())
                .or_else(|| coarser(Some(&gap)))
                .and_then(|coarser| Cascade::after(coarser, &problem, &gap, &self.levels)),
        };

        // The iteration.
        let mut results = Vec::new();
        let mut outcome = if let Some(mut cascade) = cascade {
            results = std::mem::take(&mut cascade.results);
            solve_in_window(&problem, cascade, &mut fields, criteria, &mut watch)?
        } else {
            fields.pressure = initial.map_or_else(|| uniform_pressure(&problem), Ok)?;
            polonsky_keer::solve(&problem, &mut fields, criteria, &mut watch)?
        };

        // The cells that yield: where there are any, the coarser grids say nothing.
        let limited = (options.hardness.as_ref()).map(|h| Bounds::of(h, self.grid.shape()[1]));
        let over = |bounds: &Bounds| {
            let mut cells = slice(&fields.pressure).iter().enumerate();
            cells.any(|(k, p)| *p > bounds.limit(k))
        };
        let limited = limited.filter(over);
        let problem = Problem {
            bounds: limited.as_ref().unwrap_or(problem.bounds),
            ..problem
        };
        let yields = limited.is_some() && outcome.termination != Termination::Stopped;
        if yields {
            let mut g = vec![0.0; problem.gap.len()];
            problem.gap_into(slice(&fields.displacement), fields.multipliers, &mut g);
            let start = yielding_pressure(&problem, slice(&fields.pressure), &g)?;
            let before = (outcome.iterations, outcome.work);
            let left = criteria.after(outcome.iterations.min(criteria.max_iterations));
            let mut counted = |more: usize, spent: f64, quality| {
                watch(before.0 + more, before.1 + spent, quality)
            };
            fields.pressure.fill(0.0);
            let end = if cascades {
                let cascade = Cascade::from(&start, &problem, &gap, &self.levels);
                solve_in_window(&problem, cascade, &mut fields, left, &mut counted)?
            } else {
                fields.pressure = start;
                polonsky_keer::solve(&problem, &mut fields, left, &mut counted)?
            };
            outcome = end.after(before.0, before.1);
        }

        // The certificate: everything that is reported is computed afresh from the pressure.
        let quality = (fields.quality).unwrap_or_else(|| fields.certify(&problem, outcome.lambda));
        if quality.overflows() {
            return Err(OVERFLOW);
        }
        let mut indentation = None;
        let mut dented = Arc::clone(&gap);
        if limited.is_some() {
            let mut deeper = vec![0.0; problem.gap.len()];
            problem.gap_into(slice(&fields.displacement), fields.multipliers, &mut deeper);
            for (k, (w, p)) in deeper.iter_mut().zip(slice(&fields.pressure)).enumerate() {
                let held = *p >= problem.bounds.limit(k);
                *w = if held { (-*w).max(0.0) } else { 0.0 };
            }
            let deeper = array(self.grid.shape(), deeper);
            dented = Arc::new(&*gap + &deeper);
            indentation = Some(deeper);
        }
        let (approach, tilt) = freedoms.rigid_motion(fields.multipliers.lambda());
        let (pressure, window) = (&fields.pressure, &fields.window);
        let (carried, warnings) = rows.both(
            || Carried::by(pressure, window, &self.grid),
            || warnings(pressure, window, &dented, &self.grid, shape, &self.ends),
        );
        report.count(outcome.iterations, outcome.work / unit, quality);
        // One rule decides, on the numbers that are reported.
        report.termination = match outcome.termination {
            Termination::Stopped => Termination::Stopped,
            _ if quality.meets(criteria.tolerance) => Termination::Converged,
            _ => Termination::IterationLimit,
        };
        report.solver = Some(outcome.solver);
        if report.converged() && indentation.is_none() {
            results.push(GridResult {
                peak_pressure: carried.peak,
                approach,
                load: carried.force,
            });
            let singular = warnings.iter().any(Warning::is_singular);
            report.discretisation = estimate(&results, singular).map(|changes| {
                let (fields, loaded) = ([pressure, &fields.displacement], motion.load.is_some());
                let unresolved = &self.unresolved;
                let others = unresolved.errors(fields, window, &self.grid, loaded, singular);
                let corners = corners::peak_error(pressure, &self.grid, shape, self.short_waves());
                changes.plus(others).at_least(corners)
            });
        }
        let raised = self.datum.raise() * carried.force;
        if raised != 0.0 {
            fields.lower(raised);
        }
        report.balance = carried.balance(&self.grid, motion);
        report.warnings = warnings;
        report.seconds = start.elapsed().as_secs_f64();
        Ok(Solution {
            pressure: fields.pressure,
            displacement: fields.displacement,
            approach: approach - raised,
            tilt,
            hardness: options.hardness.clone(),
            indentation,
            report,
            gap: Gap::Computed {
                undeformed: dented,
                freedoms: Box::new(freedoms),
                multipliers: fields.multipliers,
            },
        })
    }

    /// Sum of the responses α û/p̂ of both bodies to waves of the length of two cells \[1/Pa\].
    fn short_waves(&self) -> f64 {
        let [dx, dy] = self.grid.spacing();
        let finest = if self.grid.is_line() { dy } else { dx.min(dy) };
        let bodies = bodies(&self.body, &self.setup);
        bodies.iter().map(|body| body.normal(PI / finest)).sum()
    }

    /// The gap on the finest grid, less the prescribed motion, and room for the fields of the solution. The shape
    /// that is `given` tells whether the `limited` one was sampled before.
    fn finest_gap<'a>(
        &self,
        given: &'a dyn Surface,
        limited: &dyn Surface,
        sampled: &mut Sampled<'a>,
        freedoms: &Freedoms,
        rows: &Rows,
    ) -> Result<(Arc<Array2<f64>>, Fields)> {
        let mut gap = sampled.gaps(given, || checked_gaps(limited, &self.grid, rows))?;
        freedoms.check_feasible(&gap)?;
        if freedoms.any_prescribed() {
            freedoms.prescribe(Arc::make_mut(&mut gap));
        }
        Ok((gap, Fields::new(self.grid.shape(), rows)))
    }
}

/// Residual and overlap from which on the reference algorithm goes on where the preconditioned iteration ended. A worse
/// pressure cost it two to five times the iterations that it takes from a uniform one, on coats 1e3 to 1e5 times harder
/// than the body.
const GOOD_START: f64 = 1e-5;

/// Solves in a window, which opens until nothing overlaps on the whole grid. Where the cascade breaks down, the
/// reference algorithm goes on.
fn solve_in_window(
    problem: &Problem,
    mut cascade: Cascade,
    fields: &mut Fields,
    criteria: StopCriteria,
    watch: &mut Watch,
) -> Result<Outcome> {
    let (mut iterations, mut retries) = (0, 0);
    loop {
        let outcome = cascade.solve(fields, criteria.after(iterations), watch);
        let quality = fields.certify(problem, outcome.lambda);
        cascade.work += problem.convolution.work();
        iterations += outcome.iterations;
        let outcome = Outcome {
            iterations,
            work: cascade.work,
            ..outcome
        };
        let stopped = outcome.termination == Termination::Stopped;
        if stopped || quality.meets(criteria.tolerance) || iterations >= criteria.max_iterations {
            return Ok(outcome);
        }
        let converged = outcome.termination == Termination::Converged;
        if converged && cascade.open(problem, fields) {
            continue;
        }
        retries += 1;
        if !converged || retries > RETRIES {
            let (left, before) = (criteria.after(iterations), cascade.work);
            if !converged && !quality.meets(GOOD_START) {
                fields.pressure = uniform_pressure(problem)?;
            }
            let end = polonsky_keer::solve(problem, fields, left, &mut |more, work, quality| {
                watch(iterations + more, before + work, quality)
            })?;
            return Ok(end.after(iterations, before));
        }
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use crate::contact::{Algorithm, Contact, Motion, Options, Report, Setup, Solver, Termination};
    use crate::error::Result;
    use crate::model::grid::Grid;
    use crate::model::material::Elastic;
    use crate::model::surface::Paraboloid;

    /// A break at any iteration, on the two coarser grids or on the finest, ends the solve at once. The pressure
    /// of that moment carries the load, and the report is that of a stopped solve.
    #[test]
    fn a_break_stops_the_solve_on_any_grid() -> Result<()> {
        let grid = Grid::new([128, 128], [4.0, 4.0])?;
        let contact = Contact::plan(Elastic::new(1.0, 0.0)?, grid, Setup::default())?;
        let (shape, motion) = (Paraboloid::new(1e3, 1e3)?, Motion::load(1e-3));
        for algorithm in [Algorithm::Cascade, Algorithm::PolonskyKeer] {
            let options = Options {
                algorithm,
                ..Options::default()
            };
            let mut last = 1;
            for stop in 1.. {
                let (mut calls, mut work) = (0, 0.0);
                let mut progress = |report: &Report| {
                    calls += 1;
                    work = report.convolutions;
                    if calls == stop {
                        ControlFlow::Break(())
                    } else {
                        ControlFlow::Continue(())
                    }
                };
                let solution = contact.solve_watched(&shape, &motion, &options, &mut progress)?;
                let report = &solution.report;
                let expected = match algorithm {
                    Algorithm::Cascade => Solver::Preconditioned,
                    Algorithm::PolonskyKeer => Solver::PolonskyKeer,
                };
                assert_eq!(report.solver, Some(expected));
                assert!(report.convolutions >= work, "{stop}");
                assert!(report.balance.force < 1e-12, "{stop}");
                if report.converged() {
                    last = stop;
                    break;
                }
                assert_eq!((report.termination, calls), (Termination::Stopped, stop));
                let worst = report.residual.max(report.overlap);
                assert!(worst > options.tolerance, "{stop}: {worst:e}");
                assert_eq!(report.discretisation, None);
            }
            // Three grids, or one, with several iterations each.
            assert!(last > 10, "{last}");
        }
        Ok(())
    }
}
