//! A finished solution, looked at: balance and warnings.

use ndarray::Array2;

use crate::contact::cascade::discretisation::Figures;
use crate::contact::cascade::patch::{Window, rows};
use crate::contact::problem::freedoms::Motion;
use crate::contact::solution::{Balance, FEW_CELLS, LARGE_CONTACT, Warning};
use crate::grid::Grid;
use crate::parallel::update_with_largest;
use crate::surface::{Extent, Surface};

/// What a pressure carries.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Carried {
    force: f64,
    moment: [f64; 2],
    peak: f64,
}

impl Carried {
    /// By the pressure of a window, outside of which there is none.
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

    /// What is compared with coarser grids.
    pub(crate) fn figures(&self, approach: f64) -> Figures {
        Figures {
            peak_pressure: self.peak,
            approach,
            load: self.force,
        }
    }

    /// Mismatch of force and moments against what was asked.
    pub(crate) fn balance(&self, grid: &Grid, motion: &Motion) -> Balance {
        let scale = motion.load.unwrap_or(self.force);
        let over = |a: f64, b: f64| if a > 0.0 && b > 0.0 { a / b } else { 0.0 };
        let half = grid.size().map(|length| 0.5 * length);
        let moment = [0, 1].map(|k| {
            let eccentricity = || Some(motion.eccentricity[k]? * motion.load.unwrap_or(0.0));
            let asked = motion.moment[k].or_else(eccentricity);
            asked.map_or(0.0, |m| over((self.moment[k] - m).abs(), scale * half[k]))
        });
        Balance {
            force: motion.load.map_or(0.0, |w| over((self.force - w).abs(), w)),
            moment,
        }
    }
}

/// What the user of a solution should know.
pub(crate) fn warnings(
    pressure: &Array2<f64>,
    window: &Window,
    grid: &Grid,
    shape: &dyn Surface,
) -> Vec<Warning> {
    let [nx, ny] = grid.shape();
    let [dx, dy] = grid.spacing();
    let (x, y) = (grid.x(), grid.y());
    let mut warnings = Vec::new();

    let goes_on = |i: usize, j: usize| {
        let beyond = |at: usize, n: usize, d: f64| match at {
            _ if n == 1 => 0.0,
            0 => -d,
            _ if at == n - 1 => d,
            _ => 0.0,
        };
        shape
            .gap(x[i] + beyond(i, nx, dx), y[j] + beyond(j, ny, dy))
            .is_finite()
    };
    let mut at_edge = false;
    // Largest pressures of the lines of cells across each axis.
    let mut highest = [vec![0.0; nx], vec![0.0; ny]];
    for (i, row) in window[0].clone().zip(rows(pressure, window)) {
        let columns = &mut highest[1][window[1].clone()];
        let ([top], []) = update_with_largest([row], [columns], |[p], [highest]| {
            ([highest.fast_max(p)], [p], [])
        });
        highest[0][i] = top;
        let reaches = |j: usize| row[j - window[1].start] > 0.0 && goes_on(i, j);
        let mut ends = [0, ny - 1].into_iter().filter(|j| window[1].contains(j));
        at_edge |= if !grid.is_line() && (i == 0 || i == nx - 1) {
            window[1].clone().any(reaches)
        } else {
            ends.any(reaches)
        };
    }
    if at_edge {
        warnings.push(Warning::GridEdge);
    }

    let (mut cells, mut ends) = ([0; 2], [[f64::INFINITY, f64::NEG_INFINITY]; 2]);
    for (axis, coordinates) in [&x, &y].into_iter().enumerate() {
        let lines = coordinates.iter().zip(&highest[axis]);
        for (at, _) in lines.filter(|(_, highest)| **highest > 0.0) {
            cells[axis] += 1;
            ends[axis] = [ends[axis][0].min(*at), ends[axis][1].max(*at)];
        }
    }
    if cells[0] == 0 {
        return warnings;
    }
    for axis in if grid.is_line() { 1..2 } else { 0..2 } {
        let spacing = grid.spacing()[axis];
        if let Extent::CutOff([low, high]) = shape.extent()[axis]
            && (ends[axis][0] - spacing < low || ends[axis][1] + spacing > high)
        {
            warnings.push(Warning::SharpEnd { axis });
        }
        if cells[axis] < FEW_CELLS {
            warnings.push(Warning::Coarse {
                axis,
                cells: cells[axis],
            });
        }
        let half_width = 0.5 * (ends[axis][1] - ends[axis][0] + spacing);
        let ratio = half_width / shape.radii()[axis];
        if ratio > LARGE_CONTACT {
            warnings.push(Warning::LargeContact { axis, ratio });
        }
    }
    warnings
}
