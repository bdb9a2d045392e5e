//! What cells resolve of the pressure of a solved contact: whether the law at a smooth edge, and with which error.
//!
//! # The law at an edge
//!
//! p = √d (c0 + c1 d + …) is the law of bodies that respond alike at all wavelengths. On a coating it
//! holds at distances d that are short compared with its thickness, with the coating's response, and at
//! distances that are long, with the response of what is below; in between it is another one, as p ∝ d
//! on a thin soft coating. A polynomial fitted to p² over some cells finds the edge if one of the two
//! holds from the cells inside the edge to within a cell of it.
//!
//! # The error
//!
//! Within a cell the pressure is known up to a part of the step to the next cell: a quarter where it is
//! taken as uniform. Where an edge is reconstructed it is a thirtieth, and as much more as the bodies
//! respond otherwise to a wave than to waves of a cell, from which the edge was found; a hundredth in the
//! interior, where it is parabolic. Of tractions that are uniform over cells, as those of partial slip are, it is a half:
//! the surface beside a cell that the edge crosses sees the whole error. A step on cells of side d holds wavelengths of about 4 d and less, shorter ones in proportion to their length, and each
//! reaches a depth z with the transfer of the layered body, (1 + αz) e^{−αz} and the like:
//!
//! ```text
//! max over axes, α ≥ 1.5/d, components:   share · step · |D(α; z)| · 1.5/(α d)
//! ```
//!
//! D is the stress under a unit pressure of wavenumber α, and under the friction in proportion to it. On
//! hard coatings it is large at wavelengths of a few thicknesses.

use crate::compliance::response::Response;
use crate::compliance::response::interior::{Column, Place};
use crate::model::body::HalfSpace;
use crate::model::grid::{Grid, Window};

use super::edge::{BAND, around, edge_distances};
use super::reconstruction::Reconstruction;

// With these shares, the estimate is some three times the error (`tests/stress/resolution.rs`).

/// Share of a step that is not known where pressure is uniform over cells.
const UNIFORM_SHARE: f64 = 0.25;

/// Share of a step that is not known where an edge is reconstructed.
const EDGE_SHARE: f64 = 0.03;

/// Share of a step that is not known in the interior. Below Hertz' contact of 128 cells to the half-width,
/// stresses there err by 3.3e-4 of the peak pressure (`tests/stress/edge.rs`), and a step is a 34th of it.
const INTERIOR_SHARE: f64 = 0.01;

/// Share of a step that is not known where an edge is reconstructed, per relative change of the response.
const SHARE_OF_CHANGE: f64 = 2.0;

/// Share of a step of the tractions that is not known where they are uniform over cells. Under a sliding ball of 21 to 85
/// cells to the radius, stresses at the surface err by 0.38 to 0.43 of it.
const TRACTION_SHARE: f64 = 0.5;

/// Wavenumber of the longest waves of a step, times the side of a cell.
const LONGEST: f64 = 1.5;

/// Largest wavenumber that is looked at, as a multiple of that of the longest waves.
const HIGHEST_RATIO: f64 = 100.0;

/// Number of those wavenumbers, even in their logarithm: four to an octave.
const COUNT: u32 = 27;

/// Distance in cells to which a step is felt near the surface.
const STEP_REACH: usize = 6;

/// What is not known of the pressure of a solved contact, at the wavenumbers that matter.
#[derive(Debug)]
pub(super) struct Uncertainty {
    shape: [usize; 2],
    known: Vec<Known>,
    /// Waves along x and along y.
    waves: [Vec<Wave>; 2],
}

/// One wave of a step of the pressure.
#[derive(Debug)]
struct Wave {
    /// Its pressure over the step, by how well the pressure is known.
    shares: [f64; 3],
    /// The same of tractions that are uniform over cells.
    uniform: f64,
    /// The body at its wavenumber.
    column: Column,
}

/// Largest steps of the pressure from cell to cell along one axis \[Pa\], by how well the pressure is known
/// in the worse of the two cells.
type AxisSteps = [f64; 3];

/// Largest steps along x and along y in a part of the grid.
#[derive(Debug, Clone, Copy)]
pub(in crate::stress) struct LocalSteps([AxisSteps; 2]);

impl Uncertainty {
    pub(super) fn new(
        (body, pair): (&HalfSpace, &BodyPair),
        grid: &Grid,
        pressure: &[f64],
        reconstruction: &Reconstruction,
    ) -> Self {
        let shape = grid.shape();
        let distances = edge_distances(pressure, shape, BAND + 1);
        let state = |distance: &u8| match *distance {
            1..=BAND => Known::Mean,
            _ => Known::Well,
        };
        let mut known: Vec<Known> = distances.iter().map(state).collect();
        for root in &reconstruction.roots {
            known[root.cell[0] * shape[1] + root.cell[1]] = Known::Edge;
        }
        let waves = |spacing: f64| {
            let of_cell = pair.response(1.0 / spacing);
            let wave = |k: u32| {
                let ratio = HIGHEST_RATIO.powf(f64::from(k) / f64::from(COUNT - 1));
                let alpha = ratio * LONGEST / spacing;
                let change = (pair.response(alpha) / of_cell - 1.0).abs();
                let share = (SHARE_OF_CHANGE * change).clamp(EDGE_SHARE, UNIFORM_SHARE);
                Wave {
                    shares: [INTERIOR_SHARE, share, UNIFORM_SHARE].map(|share| share / ratio),
                    uniform: TRACTION_SHARE / ratio,
                    column: Column::new(body, alpha),
                }
            };
            (0..COUNT).map(wave).collect()
        };
        Self { shape, known, waves: grid.spacing().map(waves) }
    }

    /// Whether the pressure is known within a cell and those beside it.
    pub(super) fn is_known_around(&self, cell: [usize; 2]) -> bool {
        around(self.shape, cell, 1).all(|[i, j]| self.known[i * self.shape[1] + j] != Known::Mean)
    }

    /// Largest steps of `pressure` that are felt in the cells of `window`.
    pub(super) fn steps(&self, pressure: &[f64], window: &Window) -> LocalSteps {
        let [nx, ny] = self.shape;
        let rows = window[0].start.saturating_sub(STEP_REACH)..(window[0].end + STEP_REACH).min(nx);
        let columns =
            window[1].start.saturating_sub(STEP_REACH)..(window[1].end + STEP_REACH).min(ny);
        let count = |steps: &mut AxisSteps, a: usize, b: usize| {
            let step = (pressure[a] - pressure[b]).abs();
            let largest = &mut steps[self.known[a].max(self.known[b]) as usize];
            *largest = largest.max(step);
        };
        let [mut along, mut across] = [AxisSteps::default(); 2];
        for i in rows.clone() {
            for j in columns.clone() {
                let cell = i * ny + j;
                if i + 1 < rows.end {
                    count(&mut along, cell, cell + ny);
                }
                if j + 1 < columns.end {
                    count(&mut across, cell, cell + 1);
                }
            }
        }
        LocalSteps([along, across])
    }

    /// Estimated errors \[Pa\] of the components of the stress at `place`, from waves along x and along y, under pressure and `friction` times
    /// it, where the pressure has these steps. With the friction, whether its tractions are uniform over cells.
    pub(super) fn at(
        &self,
        body: &HalfSpace,
        place: &Place,
        (friction, uniform): ([f64; 2], bool),
        LocalSteps(steps): LocalSteps,
    ) -> [f64; 2] {
        let friction = friction[0].hypot(friction[1]);
        let material = place.material;
        let error = |(steps, wave): (AxisSteps, &Wave)| {
            let parts = wave.shares.iter().zip(steps);
            let pressure = parts.map(|(share, step)| share * step).fold(0.0, f64::max);
            if pressure <= 0.0 {
                return 0.0;
            }
            let largest = steps.into_iter().fold(0.0, f64::max);
            let traction = friction * if uniform { wave.uniform * largest } else { pressure };
            let fields = wave.column.at(body, place);
            let [pressed, sheared] = [&fields.pressure, &fields.shear].map(|state| {
                let (along, across) = state.lateral_stress(material);
                [state.p, state.tau, along, across].map(f64::abs)
            });
            let (q, u) = fields.twist;
            let twisted = q.abs().max((material.shear() * u).abs());
            let pairs = pressed.into_iter().zip(sheared);
            let in_plane = pairs.map(|(pressed, sheared)| pressure * pressed + traction * sheared);
            in_plane.fold(traction * twisted, f64::max)
        };
        [0, 1].map(|axis| {
            let waves = self.waves[axis].iter().map(|wave| error((steps[axis], wave)));
            waves.fold(0.0, f64::max)
        })
    }
}

/// How well the pressure within a cell is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Known {
    /// Parabolic, or without pressure.
    Well,
    /// A root near a smooth edge.
    Edge,
    /// Uniform.
    Mean,
}

/// Longest wavelength over 2π that a fit sees, in cells: the window of its fit.
const LONGEST_SEEN: f64 = 8.0;

/// Shortest wavelength over 2π that is looked at, in cells.
const SHORTEST_SEEN: f64 = 1e-3;

/// Wavenumbers per octave at which responses are compared.
const PER_OCTAVE: f64 = 4.0;

/// Largest change of the response, relative, with which one law holds. Chosen by trial: coatings of
/// 0.05 to 8 cells and 0.01 to 100 times the modulus of the substrate, on contacts of 20 cells to the
/// half-width. Where the response changes less, errors are well below those of uniform cells; where it
/// changes by 0.07 to 0.09, they are up to 2.3 times as large a tenth of a cell deep, and beyond, 4.4 times.
const LARGEST_CHANGE: f64 = 0.06;

/// The bodies of a contact, whose responses add.
pub(in crate::stress) struct BodyPair<'a>(pub(in crate::stress) Vec<&'a dyn Response>);

impl BodyPair<'_> {
    /// α û/p̂ of all bodies at the wavenumber α, with the local compliance, which grows without limit.
    pub(super) fn response(&self, alpha: f64) -> f64 {
        let of = |body: &&dyn Response| body.normal(alpha) + alpha * body.local();
        self.0.iter().map(of).sum()
    }

    /// Whether the response is that of a half-space at the wavelengths of some cells of the side `cell`, or
    /// at all that are shorter than a cell.
    pub(super) fn root_law_holds(&self, cell: f64) -> bool {
        let change = |from: f64, to: f64| {
            let count = ((to / from).log2() * PER_OCTAVE).ceil();
            let at = |k: u32| from * (to / from).powf(f64::from(k) / count) / cell;
            let ends = [f64::INFINITY, f64::NEG_INFINITY];
            let [low, high] = (0..=count as u32)
                .map(|k| self.response(at(k)))
                .fold(ends, |[low, high], r| [low.min(r), high.max(r)]);
            high / low - 1.0
        };
        change(1.0 / LONGEST_SEEN, 1.0) <= LARGEST_CHANGE
            || change(1.0, 1.0 / SHORTEST_SEEN) <= LARGEST_CHANGE
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;
    use crate::model::body::{HalfSpace, Layer};
    use crate::model::material::Elastic;

    /// Bare bodies and coatings that are thin or thick compared with a cell; not those of about a cell,
    /// nor thin ones that are soft enough to bear the pressure as springs do.
    #[test]
    fn the_law_holds_where_cells_see_one_material() -> Result<()> {
        let steel = Elastic::new(1.0, 0.3)?;
        let bare = HalfSpace::from(steel);
        assert!(BodyPair(vec![&bare, &bare]).root_law_holds(1.0));
        for (ratio, thickness, expected) in [
            (0.3, 0.05, true),
            (3.0, 0.05, true),
            (3.0, 8.0, true),
            (0.01, 8.0, true),
            (3.0, 0.5, false),
            (3.0, 1.0, false),
            (0.1, 0.05, false),
            (0.02, 0.12, false),
        ] {
            let layer = Layer::new(Elastic::new(ratio, 0.3)?, thickness)?;
            let coated = HalfSpace::new(steel, [layer])?;
            let found = BodyPair(vec![&coated]).root_law_holds(1.0);
            assert_eq!(found, expected, "{ratio} {thickness}");
        }
        Ok(())
    }
}
