//! The search for the rectangle of a contact, on a coarse grid that is enlarged and reduced until it fits.

use crate::compliance::response::Body;
use crate::contact::automatic::relief::{Low, Overlap, Relief, limited};
use crate::contact::automatic::trial::{Frame, Trial, enclosing, frame_of};
use crate::contact::options::{Algorithm, Options};
use crate::contact::plan::bodies;
use crate::contact::solution::{Progress, Solution};
use crate::contact::solver::Termination;
use crate::error::{Error, Result};
use crate::model::grid::{Grid, Window};
use crate::model::surface::Extent;
use crate::numerics::rounding::cells_within;

/// Cells across the narrower width of the contact. The 64 that are promised are raised by 7 %, because the
/// contact on the coarse grid is up to 6 % too wide.
const ACROSS: f64 = 64.0 * 1.07;

/// Free width on either side of the contact, relative to the width of the contact: room for pictures. Of 13 contacts of balls,
/// rollers and a punch, 0.1 takes 28 % fewer cells and 0.5 takes 55 % more, in the same time.
const FRAME_MARGIN: f64 = 0.25;

/// Cells of the coarse grid in each direction. Chosen by trial: with 24 the peak pressure of a punch is 3 % off, and 96 take
/// 27 % more time.
const COARSE_CELLS: usize = 48;

/// Cells of the coarse grid in each direction where it holds places that lie apart, each of which may be a quarter of it.
const OVERLAP_CELLS: usize = 4 * COARSE_CELLS;

/// Tolerance on the coarse grid, of which the outermost cells count alone: the pressure there is above a tenth of the peak.
const FRAME_TOLERANCE: f64 = 1e-4;

/// Largest ratio of a cell's sides. Chosen by trial: 4 takes up to four times the cells for peak pressures that differ by 2e-6,
/// and 64 takes up to 17 % fewer.
const ASPECT_RATIO: f64 = 16.0;

/// Smallest number of cells along a contact whose cells are oblong. Chosen by trial: peak pressures of rollers differ by 1e-6
/// with half as many, by 1e-5 with a quarter, and the ends of the contact are as much less sharp.
const LONG_CONTACT: f64 = 1024.0;

/// Enlargements of the coarse grid by a factor of up to 3: 3¹⁰ in all.
const ENLARGEMENTS: usize = 10;

/// Reductions of the coarse grid around a contact that is small on it, by a factor of 4/3 at least.
const REDUCTIONS: usize = 40;

/// The search for the grid of one contact. It remembers the places that the grid must hold.
pub(super) struct Search<'a> {
    trial: Trial<'a>,
    options: Options,
    extent: [Extent; 2],
    overlap_frame: Option<Frame>,
}

impl<'a> Search<'a> {
    pub(super) fn new(trial: Trial<'a>, options: &Options) -> Result<Self> {
        let extent = trial.shape.extent();
        if extent.contains(&Extent::Endless) {
            return Err(Error::Inconsistent(
                "grid must be given for a shape without end: its contact is as long as the grid",
            ));
        }
        // Options that only the real grid can meet are checked here and left out.
        options.stop_criteria()?;
        Ok(Self {
            trial,
            options: Options {
                tolerance: FRAME_TOLERANCE,
                initial: None,
                indentation: None,
                algorithm: Algorithm::default(),
                ..options.clone()
            },
            extent,
            overlap_frame: None,
        })
    }

    /// The grid that is found from the shape alone.
    pub(super) fn grid(&mut self, progress: &mut Progress) -> Result<Grid> {
        let frame = first_frame(&self.trial)?;
        self.fit(frame, progress)
    }

    /// The grid that also holds the place of an `overlap` outside the grid of `solution`.
    pub(super) fn holding(
        &mut self,
        overlap: Overlap,
        solution: &Solution,
        progress: &mut Progress,
    ) -> Result<Grid> {
        let frame = self.hold(overlap, solution);
        self.fit(frame, progress)
    }

    /// Enlarges and reduces a coarse grid over `frame` until it fits the contact.
    fn fit(&mut self, mut frame: Frame, progress: &mut Progress) -> Result<Grid> {
        let (mut enlargements, mut reductions, mut elsewhere) = (0, 0, false);
        loop {
            let cells = if self.overlap_frame.is_some() { OVERLAP_CELLS } else { COARSE_CELLS };
            let grid = self.trial.grid_over(frame, [cells; 2])?;
            frame = frame_of(&grid);
            let solution = self.trial.solve(grid, &self.options, progress)?;
            let Some(contact) = solution.cells_in_contact() else {
                // Nothing touches there: where nothing overlaps anywhere, any grid shows that.
                match self.deepest().filter(|_| !elsewhere) {
                    Some(place) => (frame, elsewhere) = (place, true),
                    None => return Ok(grid),
                }
                continue;
            };
            if solution.report.termination == Termination::Stopped {
                return Ok(grid);
            }
            let touched = touched_sides(&contact, &grid, self.extent);
            let contact = [0, 1].map(|k| {
                let cell = |number: usize| frame[k][0] + number as f64 * grid.spacing()[k];
                [cell(contact[k].start), cell(contact[k].end)]
            });
            let contact =
                self.overlap_frame.map_or(contact, |overlaps| enclosing(contact, overlaps));
            let (mut grown, mut shrunk) = (false, false);
            for axis in [0, 1] {
                let width = frame[axis][1] - frame[axis][0];
                let across = contact[axis][1] - contact[axis][0];
                // An edge that is touched moves out by the width, as far as the shape goes.
                if touched[axis] != [false; 2] {
                    grown = true;
                    frame[axis] = moved_out(frame[axis], touched[axis], width);
                } else if across < 0.25 * width - 0.5 * grid.spacing()[axis] {
                    shrunk = true;
                    frame[axis] = moved_out(contact[axis], [true; 2], across);
                }
            }
            if grown {
                if enlargements == ENLARGEMENTS {
                    return Err(Error::NoGrid { enlargements, size: grid.size() });
                }
                enlargements += 1;
            } else if shrunk && reductions < REDUCTIONS {
                reductions += 1;
            } else {
                return self.final_grid(&solution);
            }
        }
    }

    /// Remembers the place of an overlap. Returns a rectangle with a margin around this place and the contact.
    fn hold(&mut self, overlap: Overlap, solution: &Solution) -> Frame {
        let overlap_frame =
            self.overlap_frame.map_or(overlap.frame, |overlaps| enclosing(overlaps, overlap.frame));
        self.overlap_frame = Some(overlap_frame);
        let frame = enclosing(solution.contact_extent(), overlap_frame);
        let wider = frame.map(|[low, high]| {
            let margin = FRAME_MARGIN * (high - low);
            [low - margin, high + margin]
        });
        limited(wider, self.extent)
    }

    /// A rectangle around the place where the shape overlaps the undeformed surface most; `None` where it overlaps
    /// nowhere, or where the motion is not prescribed.
    fn deepest(&self) -> Option<Frame> {
        let (approach, tilt) = self.trial.prescribed()?;
        let (relief, region, lows) = survey(&self.trial, tilt);
        let deepest = lows.into_iter().min_by(|a, b| a.gap.total_cmp(&b.gap))?;
        let frame = relief.below(&[deepest], approach, region)?;
        Some(limited(frame, self.extent))
    }

    /// The final grid: the contact of the coarse `solution` and a margin around it, in fine cells.
    fn final_grid(&self, solution: &Solution) -> Result<Grid> {
        let contact = solution.contact_extent();
        let contact = self.overlap_frame.map_or(contact, |overlaps| enclosing(contact, overlaps));
        let widths = contact.map(|[low, high]| high - low);
        let finest = widths[0].min(widths[1]) / ACROSS;
        let frame: Frame = std::array::from_fn(|axis| {
            let margin = FRAME_MARGIN * widths[axis];
            let [low, high] = self.extent[axis].range();
            // A shape that ends needs no more than a cell beyond its end.
            let low = (contact[axis][0] - margin).max(low - 2.0 * finest);
            let high = (contact[axis][1] + margin).min(high + 2.0 * finest);
            [low, high]
        });
        let shape = std::array::from_fn(|axis| {
            let cells = (widths[axis] / finest)
                .min((widths[axis] / (ASPECT_RATIO * finest)).max(LONG_CONTACT));
            let cell = widths[axis] / cells.max(ACROSS);
            let count = cells_within(frame[axis][1] - frame[axis][0], cell);
            // Even, so that the middle of a symmetric contact lies between cells.
            count.next_multiple_of(2)
        });
        self.trial.grid_over(frame, self.trial.at_most(shape))
    }
}

/// Lower and upper sides of a grid that the `contact` touches although the shape extends there, by more than rounding.
pub(super) fn touched_sides(contact: &Window, grid: &Grid, extent: [Extent; 2]) -> [[bool; 2]; 2] {
    let frame = frame_of(grid);
    [0, 1].map(|k| {
        let [low, high] = extent[k].range();
        let beyond = 1e-9 * grid.size()[k];
        [
            contact[k].start == 0 && frame[k][0] > low + beyond,
            contact[k].end == grid.shape()[k] && frame[k][1] < high - beyond,
        ]
    })
}

/// A range whose `sides` are moved out by `distance`.
pub(super) fn moved_out([low, high]: [f64; 2], sides: [bool; 2], distance: f64) -> [f64; 2] {
    [if sides[0] { low - distance } else { low }, if sides[1] { high + distance } else { high }]
}

/// The middle of the shape, or the point where the load acts, where it lies on the shape.
fn middle(trial: &Trial) -> [f64; 2] {
    let extent = trial.shape.extent();
    std::array::from_fn(|axis| {
        let [low, high] = extent[axis].range();
        let middle = if low.is_finite() && high.is_finite() { 0.5 * (low + high) } else { 0.0 };
        trial.motion.eccentricity[axis].filter(|e| *e > low && *e < high).unwrap_or(middle)
    })
}

/// The low places of the whole shape with a given tilt, and the rectangle in which they were looked for.
fn survey<'a>(trial: &Trial<'a>, tilt: [f64; 2]) -> (Relief<'a>, Frame, Vec<Low>) {
    let relief = Relief::new(trial.shape, tilt);
    let middle = middle(trial);
    let radii = trial.shape.radii().into_iter().filter(|r| r.is_finite());
    let region = relief.region(middle, radii.reduce(f64::max).unwrap_or(1.0));
    let lows = relief.lows(region, middle);
    (relief, region, lows)
}

/// The rectangle around the load point in which the undeformed shape overlaps, at the approach that carries
/// the load by the estimate W = 2 E* δ √(a b), which holds for a flat square punch within 10 %. Where a motion
/// is prescribed with which nothing overlaps in the middle of the shape: the rectangle around all places that
/// overlap.
fn first_frame(trial: &Trial) -> Result<Frame> {
    let (extent, radii) = (trial.shape.extent(), trial.shape.radii());
    let center = middle(trial);
    let relief = Relief::new(trial.shape, trial.tilt());
    let base = relief.gap(center);
    if let Some((approach, tilt)) = trial.prescribed()
        && base >= approach
    {
        let (relief, region, lows) = survey(trial, tilt);
        if let Some(frame) = relief.below(&lows, approach, region) {
            return Ok(limited(frame, extent));
        }
    }
    let base = if base.is_finite() { base } else { 0.0 };
    // Half-widths of the overlap at approach δ, along both axes.
    let widths = |approach: f64| -> [f64; 2] {
        std::array::from_fn(|axis| {
            let inside = |d: f64| {
                [-d, d].into_iter().any(|d| {
                    let mut at = center;
                    at[axis] += d;
                    relief.gap(at) < base + approach
                })
            };
            // By powers of √2 from far below any contact to far above.
            let mut width = f64::MIN_POSITIVE.sqrt();
            while width < 1e12 && inside(width) {
                width *= std::f64::consts::SQRT_2;
            }
            width
        })
    };
    let approach = match (trial.motion.load, trial.motion.approach) {
        (Some(load), _) => approach_under(load, trial, &widths),
        (None, Some(approach)) => (approach - base).max(0.0),
        (None, None) => 0.0,
    };
    let halves = widths(approach);
    let frame = limited(
        [0, 1].map(|axis| {
            let half = 1.5 * halves[axis];
            [center[axis] - half, center[axis] + half]
        }),
        extent,
    );
    for [low, high] in &frame {
        if high - low <= 1e-100 || !(high - low).is_finite() {
            // Nothing overlaps: a grid around the middle shows that nothing touches.
            let sizes = [extent[0].range()[1], extent[1].range()[1], radii[0], radii[1]];
            let size = sizes.into_iter().map(f64::abs).filter(|s| s.is_finite() && *s > 0.0);
            let half = 0.01 * size.reduce(f64::min).unwrap_or(1.0);
            return Ok(center.map(|c| [c - half, c + half]));
        }
    }
    Ok(frame)
}

/// The approach that carries the load, by the estimate of [`first_frame`], for half-widths at each approach.
fn approach_under(load: f64, trial: &Trial, widths: &impl Fn(f64) -> [f64; 2]) -> f64 {
    let carries = |approach: f64| {
        let [a, b] = widths(approach);
        let half = (a * b).sqrt();
        4.0 * approach * half / compliance(trial, 1.0 / half)
    };
    let mut approach = 1.0;
    while approach > 1e-30 && carries(approach) > load {
        approach *= 0.5;
    }
    while approach < 1e12 && carries(approach) < load {
        approach *= 2.0;
    }
    approach
}

/// α û/p̂ of both bodies, for waves of a contact of half-width 1/α: where the limits say nothing, the response itself,
/// and the local compliance.
fn compliance(trial: &Trial, alpha: f64) -> f64 {
    let of = |body: &Body| {
        let limits = body.asymptotes();
        let larger = match limits.short.max(limits.long) {
            0.0 => body.normal(alpha),
            larger => larger,
        };
        larger + alpha * body.local()
    };
    bodies(trial.body, trial.setup).into_iter().map(of).sum()
}
