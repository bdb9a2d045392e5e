//! Force and moments that a pressure carries.

use ndarray::Array2;

use crate::contact::motion::Motion;
use crate::contact::problem::patch::rows;
use crate::model::grid::{Grid, Window};
use crate::numerics::parallel::update_with_largest;

/// Errors of force and moments, relative to what was asked for.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Balance {
    /// |Σ p dA − W| / W; 0 where the force is not given.
    pub force: f64,
    /// |Σ p x dA − M_x| / (W × half side), along y alike; 0 where the moment is not given.
    pub moment: [f64; 2],
}

/// Force, moments and peak of a pressure.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Carried {
    pub(crate) force: f64,
    moment: [f64; 2],
    pub(crate) peak: f64,
}

impl Carried {
    /// Force, moments and peak of `pressure`, which is zero outside `window`.
    pub(crate) fn by(pressure: &Array2<f64>, window: &Window, grid: &Grid) -> Self {
        let [x, y] = [0, 1].map(|k| grid.coordinates(k).to_vec()[window[k].clone()].to_vec());
        let mut carried = Self::default();
        for (row, x) in rows(pressure, window).zip(x) {
            let ([peak], [force, moment]) =
                update_with_largest([row, &y], [], |[p, y], []| ([], [p], [p, p * y]));
            carried.force += force;
            carried.moment[0] += force * x;
            carried.moment[1] += moment;
            carried.peak = carried.peak.max(peak);
        }
        let area = grid.cell_area();
        Self {
            force: carried.force * area,
            moment: carried.moment.map(|m| m * area),
            ..carried
        }
    }

    /// Errors of force and moments against those that `motion` asks for.
    pub(crate) fn balance(&self, grid: &Grid, motion: &Motion) -> Balance {
        let scale = motion.load.unwrap_or(self.force);
        let relative = |a: f64, b: f64| if a > 0.0 && b > 0.0 { a / b } else { 0.0 };
        let half = grid.size().map(|length| 0.5 * length);
        let moment = [0, 1].map(|k| {
            let eccentricity = || Some(motion.eccentricity[k]? * motion.load.unwrap_or(0.0));
            let asked = motion.moment[k].or_else(eccentricity);
            asked.map_or(0.0, |m| {
                relative((self.moment[k] - m).abs(), scale * half[k])
            })
        });
        let force = motion.load;
        Balance {
            force: force.map_or(0.0, |w| relative((self.force - w).abs(), w)),
            moment,
        }
    }
}
