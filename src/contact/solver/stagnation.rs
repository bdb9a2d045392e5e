//! Iterations that make no progress.

use crate::contact::problem::Quality;

/// Iterations within which the error must halve. With fifty, contacts that take 250 to 400 iterations were given
/// up, and the reference took 500 to 5000; chosen by trial.
const HALVING: usize = 150;

/// Iterations after which the best pressure is kept: far more than most contacts take.
const KEEPING: usize = 40;

/// Error of an iteration when it last halved, and the pressure of that moment.
#[derive(Debug)]
pub(super) struct Course {
    /// The larger of residual and overlap.
    error: f64,
    /// Number of the iteration.
    halved: usize,
    pressure: Option<Vec<f64>>,
}

impl Course {
    /// The course of an iteration that has not begun.
    pub(super) fn new() -> Self {
        Self { error: f64::INFINITY, halved: 0, pressure: None }
    }

    /// Whether the error has not halved for [`HALVING`] iterations, the last of which led to `p`.
    pub(super) fn stagnates(&mut self, iterations: usize, quality: Quality, p: &[f64]) -> bool {
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
    pub(super) fn restore(&self, p: &mut [f64]) {
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
