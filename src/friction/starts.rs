//! Tractions from which an iteration starts.

use ndarray::Array2;

use super::session::Session;
use super::step::Friction;
use crate::contact::{Motion, Options, Solution};
use crate::error::Result;

/// Tolerance of a start.
const START: f64 = 1e-3;

impl Session<'_> {
    /// Tractions to start from: those before; for the whole force by superposition, as if there had been no history;
    /// and those before with the change of the force by superposition, as after a reversal.
    pub(super) fn starts(
        &self,
        motion: &Motion,
        normal: &Solution,
        (forces, bears): ([f64; 2], f64),
        friction: &Friction,
        traction: &[Array2<f64>; 2],
    ) -> Result<Vec<[Array2<f64>; 2]>> {
        let area = normal.grid().cell_area();
        let before = traction.each_ref().map(|q| q.sum() * area);
        let whole = self.superposed(motion, normal, (forces, bears), friction)?;
        if before[0].hypot(before[1]) <= 0.0 {
            return Ok(vec![whole]);
        }
        let mut starts = vec![traction.clone(), whole];
        let half = [0, 1].map(|axis| 0.5 * (forces[axis] - before[axis]));
        if half[0].hypot(half[1]) < bears {
            let mut changed = self.superposed(motion, normal, (half, bears), friction)?;
            for (changed, before) in changed.iter_mut().zip(traction) {
                changed.zip_mut_with(before, |q, before| *q = 2.0 * *q + before);
            }
            starts.push(changed);
        }
        Ok(starts)
    }

    /// Tractions after Cattaneo, Mindlin, Jäger and Ciavarella: μ times the pressure less that of the load less
    /// |Q|/μ. They are exact for equal bodies with ν = 0, and a good start elsewhere. Ciavarella, J. Appl. Mech. 65
    /// (1998) 998, doi:10.1115/1.2791936.
    fn superposed(
        &self,
        motion: &Motion,
        normal: &Solution,
        (forces, bears): ([f64; 2], f64),
        friction: &Friction,
    ) -> Result<[Array2<f64>; 2]> {
        let force = forces[0].hypot(forces[1]);
        let zero = || Array2::zeros(normal.grid().shape());
        if force <= 0.0 {
            return Ok([zero(), zero()]);
        }
        let less = Motion {
            load: Some(normal.load() * (1.0 - force / bears)),
            approach: None,
            ..*motion
        };
        let options = Options {
            tolerance: START,
            ..Options::default()
        };
        let sticking = self.contact.solve(self.shape, &less, &options)?;
        let mut tractions = [zero(), zero()];
        for ((i, j), p) in normal.pressure.indexed_iter() {
            let q = friction.at([i, j]) * (p - sticking.pressure[[i, j]]).max(0.0);
            for (traction, component) in tractions.iter_mut().zip(forces) {
                traction[[i, j]] = q * component / force;
            }
        }
        Ok(tractions)
    }
}
