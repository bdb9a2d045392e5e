//! Preconditioned conjugate gradients, deflated by the loaded degrees of freedom; developed here
//! from known parts.
//!
//! On the contact C the gap must vanish: K p = Bλ − h. The residual r = Bλ − h − K p is preconditioned by
//! an approximate inverse M of the convolution, and made orthogonal to the loaded degrees of freedom, so
//! that force and moments stay balanced. Cells leave C when their pressure turns negative, and join it
//! when they overlap; neither restarts the iteration.
//!
//! - Vollebregt, J. Optim. Theory Appl. 162 (2014) 931, doi:10.1007/s10957-013-0499-x: conjugate gradients
//!   with bounds, which restart when cells join.
//! - Vollebregt, J. Comput. Phys. 257 (2014) 333, doi:10.1016/j.jcp.2013.10.005: preconditioning by FFT,
//!   and deflation.
//!
//! Passes over arrays would take as long as the transforms if each operation were a pass of its own:
//! operations that can share a pass do. `textbook.rs` has the same iteration with one operation a line.

mod steps;
#[cfg(test)]
mod textbook;

use std::mem;

use crate::compliance::convolution::{Convolution, Workspace};
use crate::contact::problem::balance::FitSums;
use crate::contact::problem::bounds::{in_contact, is_free, residual};
use crate::contact::problem::{Problem, Quality, QualitySums, depths, works};
use crate::contact::solver::linear_cg::Conjugacy;
use crate::contact::solver::{Outcome, Solver, StopCriteria, Tally, Termination, active_set};
use crate::numerics::parallel::{
    Lanes, Lease, ONE, Rows, ZERO, all, update, update_with_largest, where_positive,
};

/// Approximations of the convolution, periodic on the window.
pub(crate) struct Approximation {
    /// M, an approximation of the inverse.
    pub(crate) inverse: Convolution,
    /// An approximation of the convolution itself, at a quarter of its cost.
    pub(crate) periodic: Convolution,
}

/// The iteration of one problem.
pub(crate) struct Preconditioned<'a> {
    problem: &'a Problem<'a>,
    approximation: &'a Approximation,
    rows: Rows<'a>,
    workspace: Workspace,
    memory: Lease<Memory>,
    displacement: Displacement,
    images: Images,
    conjugacy: Conjugacy,
    /// Number of cells in the contact.
    members: f64,
    /// λ of the last assessment.
    lambda: [f64; 3],
    /// Curvature of the energy by the exact convolution, relative to that by the periodic one, in the last
    /// step that used both.
    curvature_ratio: f64,
    /// Work done so far, in the unit of [`Convolution::work`].
    work: f64,
}

/// Iterations by which most contacts have converged. After them a contact of a few cells is left to
/// [`active_set`], and images do not grow old; chosen by trial.
const PATIENCE: usize = 20;

/// What the last step left to do before the displacement u is that of the pressure.
#[derive(Debug, Clone, Copy)]
enum Displacement {
    /// u = K p.
    Current,
    /// u = K p, and the sums for the fit of λ are known.
    Fitted(FitSums),
    /// This multiple of the response must still be added to u.
    Behind(f64),
}

/// Contact that the images of the loaded degrees of freedom were computed for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Images {
    /// The images belong to the contact as it was last seen.
    Current,
    /// The contact has changed this many times since the images were computed.
    Stale(usize),
}

/// Outcome of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum StepOutcome {
    /// The step was made as planned.
    Whole,
    /// Cells lost their pressure on the way.
    Truncated,
    /// No descent direction is left; the pressure is unchanged up to rounding.
    Stalled,
}

/// The state of an iteration, as [`Preconditioned::assess`] finds it.
struct Assessment {
    lambda: [f64; 3],
    quality: Quality,
    /// Whether any cell has left or joined the contact since the last assessment.
    contact_changed: bool,
}

impl<'a> Preconditioned<'a> {
    pub(crate) fn new(
        problem: &'a Problem<'a>,
        approximation: &'a Approximation,
        memory: Lease<Memory>,
    ) -> Self {
        Self {
            problem,
            approximation,
            rows: problem.rows(),
            workspace: problem.convolution.workspace(),
            memory,
            displacement: Displacement::Current,
            images: Images::Current,
            conjugacy: Conjugacy::default(),
            members: 0.0,
            lambda: [0.0; 3],
            curvature_ratio: 1.0,
            work: 0.0,
        }
    }

    /// Solves from the balanced pressure `p`, which becomes the solution. It ends early with
    /// [`Termination::IterationLimit`] where [`active_set`] can go on, and with the best pressure where it
    /// stagnates. Displacements are sums over the steps and carry their rounding: a caller that needs them
    /// computes them afresh.
    pub(crate) fn solve(
        &mut self,
        p: &mut [f64],
        criteria: StopCriteria,
        tally: &mut Tally,
    ) -> Outcome {
        let before = tally.work;
        let mut last = StepOutcome::Truncated;
        let mut course = Course::new();
        self.start(p);
        for iterations in 0.. {
            let Assessment { lambda, quality, contact_changed } = self.assess(p);
            tally.work = before + self.work;
            let end = |termination| Outcome { solver: Solver::Preconditioned, termination, lambda };
            if quality.meets(criteria.tolerance) {
                return end(Termination::Converged);
            }
            if tally.tell(quality).is_break() {
                return end(Termination::Stopped);
            }
            let limited = tally.iterations >= criteria.max_iterations || quality.overflows();
            if limited || (iterations >= PATIENCE && active_set::is_small(self.problem, p)) {
                return end(Termination::IterationLimit);
            }
            if course.stagnates(iterations, quality, p) {
                course.restore(p);
                return end(Termination::IterationLimit);
            }
            self.prepare_images(p, contact_changed, iterations);
            last = self.step(p, last);
            tally.work = before + self.work;
            if last == StepOutcome::Stalled {
                return end(Termination::IterationLimit);
            }
            tally.iterations += 1;
        }
        unreachable!("the loop ends by its limit")
    }

    /// Takes the cells with a pressure for the contact.
    fn start(&mut self, p: &[f64]) {
        let Arrays { r, .. } = self.memory.arrays(p.len());
        let bounds = self.problem.bounds;
        [self.members] = self.rows.each([p], [r], |row, [p], [r]| {
            update([p, bounds.row(row.number)], [r], |[p, limit], _| {
                ([ZERO], [is_free(p, limit) & ONE])
            })
        });
        self.invert_freedoms(p);
        self.displace(p);
    }

    /// u = K p
    fn displace(&mut self, p: &[f64]) {
        let Arrays { u, .. } = self.memory.arrays(p.len());
        self.problem.apply(p, u, &mut self.workspace);
        self.work += self.problem.convolution.work();
        self.displacement = Displacement::Current;
    }

    /// Finds the multipliers, the quality of the pressure, and the residual on the contact. Cells without
    /// pressure leave the contact, and cells that overlap join it.
    fn assess(&mut self, p: &[f64]) -> Assessment {
        // Pressed cells per joining cell below which the directions so far say little; chosen by trial.
        const PRESSED_PER_JOINING: f64 = 10.0;
        let (problem, bounds) = (self.problem, self.problem.bounds);
        let freedoms = problem.freedoms;
        self.memory.keep_residual();
        let Arrays { u, r, response, .. } = self.memory.arrays(p.len());
        let mut catch_up = |factor: f64| {
            let (factor, inputs) = (all(factor), [p, response, problem.gap]);
            self.rows.each(inputs, [&mut *u], |row, inputs, [u]| {
                let limit = bounds.row(row.number);
                freedoms.fit_row(row, limit, inputs, [u], |[p, response, h, ..], [u]| {
                    // At a factor of 0 the response may hold anything.
                    let u = u + where_positive(factor, factor * response);
                    ([u], [p, u + h, ZERO])
                })
            })
        };
        let fit = match mem::replace(&mut self.displacement, Displacement::Current) {
            Displacement::Fitted(sums) => sums,
            Displacement::Current => catch_up(0.0),
            Displacement::Behind(factor) => catch_up(factor),
        };
        let lambda = match fit.cells() > 0.0 {
            true => freedoms.fitted(fit),
            false => problem.until_touching(p, u, self.lambda),
        };
        self.lambda = lambda;
        let inputs = [p, u, problem.gap];
        let (sums, [free, inside]) = self.rows.each(inputs, [r], |row, [p, u, h], [r]| {
            let (base, slope) = (all(lambda[0] + lambda[1] * row.x), all(lambda[2]));
            let step = |[p, limit, u, h]: [Lanes; 4], motion: Lanes| {
                let overlap = motion - (h + u);
                let residual = residual(p, limit, overlap);
                let free = is_free(p, limit) & ONE;
                let inside = in_contact(p, limit, residual) & ONE;
                let [work, mismatch, held] = works(p, limit, u, overlap);
                let sums = [work, mismatch, held, free, inside];
                ([residual], depths(p, limit, u, overlap), sums)
            };
            let limit = bounds.row(row.number);
            let (extremes, sums) = if freedoms.loaded[2] {
                let inputs = [p, limit, u, h, row.y];
                update_with_largest(inputs, [r], |[p, limit, u, h, y], _| {
                    step([p, limit, u, h], base + slope * y)
                })
            } else {
                update_with_largest([p, limit, u, h], [r], |fields, _| step(fields, base))
            };
            let [work, mismatch, held, free, inside] = sums;
            let sums = QualitySums::of_row(extremes, [work, mismatch, held]);
            (sums, [free, inside])
        });
        let joined = inside - free;
        if PRESSED_PER_JOINING * joined > free {
            self.conjugacy.restart();
        }
        // A step gives no pressure to cells outside the contact: the difference is the cells that left.
        let left = mem::replace(&mut self.members, inside) - free;
        Assessment {
            lambda,
            quality: problem.quality(sums, &fit),
            contact_changed: joined > 0.0 || left.abs() > 0.0,
        }
    }
}

/// Memory of the arrays of an iteration; it may be larger than needed.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    u: Vec<f64>,
    r: Vec<f64>,
    r_before: Vec<f64>,
    z: Vec<f64>,
    direction: Vec<f64>,
    response: Vec<f64>,
    trial: Vec<f64>,
    images: [Vec<f64>; 3],
}

/// Arrays of an iteration, as long as there are cells.
struct Arrays<'a> {
    /// Displacement K p.
    u: &'a mut [f64],
    /// Residual −g on contact cells, 0 elsewhere.
    r: &'a mut [f64],
    /// Residual of the iteration before.
    r_before: &'a mut [f64],
    /// Preconditioned residual M r.
    z: &'a mut [f64],
    /// Search direction.
    direction: &'a mut [f64],
    /// K applied to the last direction, or to the last change of the pressure.
    response: &'a mut [f64],
    /// Trial pressure of a step on which cells leave, and then the change to it.
    trial: &'a mut [f64],
    /// M applied to each loaded degree of freedom on a contact; the others are not read.
    images: [&'a mut [f64]; 3],
}

impl Memory {
    /// Makes the arrays long enough for the cells of `rows`. A new array gets room for `most` cells, the
    /// largest number that a solve may need, which the plan's memory was checked for; most systems hand
    /// memory out only as it is written.
    pub(crate) fn reserve(&mut self, rows: &Rows, most: usize, loaded: [bool; 3]) {
        let Self { u, r, r_before, z, direction, response, trial, images } = self;
        let arrays = [u, r, r_before, z, direction, response, trial];
        let images = images.iter_mut().zip(loaded);
        let images = images.filter_map(|(image, loaded)| loaded.then_some(image));
        let short = |array: &&mut Vec<f64>| array.len() < rows.cells();
        let mut short: Vec<_> = arrays.into_iter().chain(images).filter(short).collect();
        for array in &mut short {
            if array.capacity() < rows.cells() {
                **array = Vec::with_capacity(most.max(rows.cells()));
            }
        }
        rows.zero(&mut short);
    }

    /// The first `cells` elements of each array.
    fn arrays(&mut self, cells: usize) -> Arrays<'_> {
        Arrays {
            u: &mut self.u[..cells],
            r: &mut self.r[..cells],
            r_before: &mut self.r_before[..cells],
            z: &mut self.z[..cells],
            direction: &mut self.direction[..cells],
            response: &mut self.response[..cells],
            trial: &mut self.trial[..cells],
            images: self.images.each_mut().map(|image| {
                let kept = cells.min(image.len());
                &mut image[..kept]
            }),
        }
    }

    /// Makes the residual that of the iteration before.
    fn keep_residual(&mut self) {
        std::mem::swap(&mut self.r, &mut self.r_before);
    }
}

/// Iterations within which the error must halve. With fifty, contacts that take 250 to 400 iterations were given
/// up, and the reference took 500 to 5000; chosen by trial.
const HALVING: usize = 150;

/// Iterations after which the best pressure is kept: far more than most contacts take.
const KEEPING: usize = 40;

/// Error of an iteration when it last halved, and the pressure of that moment.
#[derive(Debug)]
struct Course {
    /// The larger of residual and overlap.
    error: f64,
    /// Number of the iteration.
    halved: usize,
    pressure: Option<Vec<f64>>,
}

impl Course {
    /// The course of an iteration that has not begun.
    fn new() -> Self {
        Self { error: f64::INFINITY, halved: 0, pressure: None }
    }

    /// Whether the error has not halved for [`HALVING`] iterations, the last of which led to `p`.
    fn stagnates(&mut self, iterations: usize, quality: Quality, p: &[f64]) -> bool {
        let error = quality.residual.max(quality.overlap);
        if error <= 0.5 * self.error {
            self.error = error;
            self.halved = iterations;
            if iterations >= KEEPING {
                self.pressure = Some(p.to_vec());
            }
        }
        iterations - self.halved >= HALVING
    }

    /// Makes `p` the best pressure, where one was kept.
    fn restore(&self, p: &mut [f64]) {
        if let Some(pressure) = &self.pressure {
            p.copy_from_slice(pressure);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Course, HALVING, KEEPING};
    use crate::contact::problem::Quality;

    fn quality(residual: f64, overlap: f64) -> Quality {
        Quality { residual, overlap, balanced: true, allowed: true, finite: true }
    }

    /// An error that goes round in circles stagnates when it has not halved for as many iterations as are
    /// allowed, and the pressure of the last time that it halved is restored. An error that halves in time
    /// does not stagnate, however long it takes.
    #[test]
    fn circles_stagnate() {
        let mut course = Course::new();
        let mut stagnates = |k: usize| {
            let falling = 0.5_f64.powi(k.min(KEEPING + 3) as i32);
            let circle = [1.0, 1.7, 0.6][k % 3];
            let error = if k > KEEPING + 3 { circle * falling } else { falling };
            course.stagnates(k, quality(0.1 * error, error), &[k as f64])
        };
        let end = (0..).find(|&k| stagnates(k));
        assert_eq!(end, Some(KEEPING + 3 + HALVING));
        let mut p = [0.0];
        course.restore(&mut p);
        assert_eq!(p.map(f64::to_bits), [((KEEPING + 3) as f64).to_bits()]);

        let mut slow = Course::new();
        let slowly = |k: usize| 0.5_f64.powf(k as f64 / (HALVING - 2) as f64);
        assert!((0..5000).all(|k| !slow.stagnates(k, quality(slowly(k), 0.0), &[1.0])));
    }

    /// Where the error halves early alone, no pressure was kept.
    #[test]
    fn short_iterations_keep_nothing() {
        let mut course = Course::new();
        assert!(!course.stagnates(0, quality(1.0, 0.0), &[3.0]));
        let mut p = [2.0];
        course.restore(&mut p);
        assert_eq!(p.map(f64::to_bits), [2.0_f64.to_bits()]);
    }
}
