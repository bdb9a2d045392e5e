//! What the measurement of a shape leaves open: the error of a solution between the stations.

use crate::contact::cascade::discretisation::GridResult;
use crate::contact::options::{Motion, Options};
use crate::contact::plan::Contact;
use crate::contact::solution::warnings::Warning;
use crate::contact::solution::{Progress, Solution};
use crate::model::surface::Surface;

/// The error of a solution, relative to the largest difference from those of alternative shapes. Chosen by trial: 147 peaks of
/// 21 crowned, logarithmic, chamfered and worn rollers with 11 to 201 stations are all within the error, and 98 % of the
/// peaks of 89 random rollers.
const BEYOND: f64 = 2.0;

/// Tolerance of solutions of which only the difference counts.
const LOOSE: f64 = 1e-5;

/// Error of the peak, relative to it, from which on there is a warning although the report states it.
const UNCERTAIN: f64 = 0.1;

/// Error of the peak, relative to it, from which on there is a warning where the report states no error: that at which an
/// automatic grid is fine enough.
const UNSTATED: f64 = 0.01;

impl From<&Solution> for GridResult {
    fn from(solution: &Solution) -> Self {
        let (approach, tilt) = (solution.approach, solution.tilt);
        Self { approach, tilt, ..Self::of_pressure(&solution.pressure, solution.grid()) }
    }
}

impl Contact {
    /// Presses the [alternatives](Surface::alternatives) of `shape` into the body as it was pressed for `solution`, and
    /// counts how far their solutions differ as discretisation errors. Where those of the cells are not known, a warning
    /// tells of the peak's. All are unknown where an alternative has no solution.
    pub(crate) fn compare(
        &self,
        solution: &mut Solution,
        shape: &dyn Surface,
        motion: &Motion,
        options: &Options,
        progress: &mut Progress,
    ) {
        let others = shape.alternatives();
        if others.is_empty() || !solution.report.converged() {
            return;
        }
        let options = Options {
            initial: Some(solution.pressure.clone()),
            tolerance: options.tolerance.max(LOOSE),
            ..options.clone()
        };
        let own = GridResult::from(&*solution);
        let mut between = own.distance(&own);
        for other in &others {
            let solved = self.solve_alone(other, motion, &options, progress);
            let Some(other) = solved.ok().filter(|other| other.report.converged()) else {
                solution.report.discretisation = None;
                solution.report.warnings.push(Warning::UnknownStations);
                return;
            };
            between = between.or_larger(own.distance(&GridResult::from(&other)));
            solution.report.convolutions += other.report.convolutions;
            solution.report.seconds += other.report.seconds;
        }
        let between = between.times(BEYOND);
        let (error, peak) = (between.peak_pressure.unwrap_or_default(), own.peak_pressure);
        let known = solution.report.discretisation;
        solution.report.discretisation = known.map(|known| known.plus(between));
        let is_stated = known.is_some_and(|known| known.peak_pressure.is_some());
        let permitted = if is_stated { UNCERTAIN } else { UNSTATED };
        if error > permitted * peak {
            solution.report.warnings.push(Warning::Stations { error: error / peak });
        }
    }
}
