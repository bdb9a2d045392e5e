//! Summaries on finer cells, where those of the grid leave an extreme more uncertain than is asked for.
//!
//! A patch around the place of such an extreme is solved again on finer cells, under the load that it has on the grid. With
//! the pressure p of the grid inside the patch and p' outside of it, its gap is
//!
//! ```text
//! g = r + u[p_fine]          r = g_grid − u[p] = h + u[p'] − δ − s_x x − s_y y
//! ```
//!
//! u is the displacement of bodies without ends, of the same cells in both. r holds the shape, the rest of the load, free ends
//! and the rigid motion. It is smooth where the shape is, and is interpolated by cubics. Stresses are those of p_fine in the
//! patch, and
//!
//! ```text
//! σ = σ[p_fine] + (σ_grid[p + p'] − σ[p])
//! ```
//!
//! of which the difference is interpolated likewise: in bodies without ends it is the stress of p'. The method was derived here.
//!
//! A patch holds the places of extremes that are within a width of the contact. It counts within a quarter of the half-width of
//! them and ends a half-width farther off, where the pressure of the grid follows, which is uniform over cells.

use ndarray::Array2;

use super::beside::{Beside, Sampled};
use super::field::Peak;
use super::options::{StressOptions, StressProgress, WatchedStress};
use super::plan::{Evaluation, PressureSource, StressPlan};
use super::section::Span;
use super::subcell::BodyPair;
use super::summary::{Strengths, StressSummary, SummaryRequest, place_of};
use crate::compliance::response::Body;
use crate::compliance::response::interior::Place;
use crate::contact::{Contact, Motion, Options, Setup, Solution};
use crate::error::{Error, Result, refuse_if, require};
use crate::model::body::HalfSpace;
use crate::model::grid::{Grid, Window};

/// Distance, in half-widths of the contact, within which extremes are found on one patch: from edge to edge.
const NEAR: f64 = 2.0;

/// Margins around the places of extremes, in half-widths of the contact: of the cells that count, as extremes may move, and of
/// the patch.
const MARGINS: [f64; 2] = [0.25, 1.25];

/// Number of cells that a patch may have, however small the grid is: 512².
const FEWEST_CELLS: usize = 1 << 18;

/// What a refined summary is made of.
struct Refined<'a> {
    solution: &'a Solution,
    /// Its pressure on the wanted body.
    source: PressureSource<'a>,
    /// The bodies of the contact, without ends.
    bodies: Vec<Body>,
    /// The layers of the wanted one.
    layers: HalfSpace,
    options: &'a StressOptions,
    target: f64,
}

/// A window of the grid, with the gap without the displacement of its own pressure, and its load.
struct Patch {
    window: Window,
    gap: Sampled,
    load: f64,
}

/// The summary of [`Solution::stress_summary`], with finer cells where an extreme is more uncertain than the part
/// `target` of it.
pub(super) fn refined_summary(
    solution: &Solution,
    source: PressureSource,
    strengths: &Strengths,
    target: f64,
    mut asked: WatchedStress,
) -> Result<StressSummary> {
    let requirement = "above 0 and below 1: the largest error of an extreme, as a part of it";
    require("refine", target, target > 0.0 && target < 1.0, requirement)?;
    refuse_if(
        solution.grid().is_periodic() != [false; 2],
        "refine must be None on a periodic grid: the surface between its cells is not known",
    )?;
    refuse_if(
        solution.indentation.is_some(),
        "refine must be None where the surface has yielded: dents are not known within cells",
    )?;
    refuse_if(
        solution.coefficients.is_some(),
        "refine must be None with influence coefficients that were given: those of finer cells are not known",
    )?;
    let all = std::iter::once(&solution.report.body).chain(&solution.report.counterbody);
    let plain = |body: &Body| match body.half_space() {
        Some(layers) => Ok(Body::from(layers.clone().with_ends([None; 2])?)),
        None => Ok(body.clone()),
    };
    let refined = Refined {
        solution,
        bodies: all.map(plain).collect::<Result<_>>()?,
        layers: source.body.clone().with_ends([None; 2])?,
        source,
        options: asked.options(),
        target,
    };
    refined.summary(strengths, &mut asked)
}

impl Refined<'_> {
    fn summary(&self, strengths: &Strengths, asked: &mut WatchedStress) -> Result<StressSummary> {
        let source = &self.source;
        let body = source.body;
        let request =
            SummaryRequest::checked(body, source.grid, &source.sliding, strengths, self.options)?;
        let mut progress = |part: f64| asked.tell(0.5 * part);
        let Some(plan) = source.plan(self.options.threads, &mut progress)? else {
            return Ok(StressSummary::default());
        };
        let half_width = plan.whole.half_width();
        let mut summary = request.evaluate(&plan, None, half_width, &mut progress);
        drop(plan);
        if !summary.finished {
            return Ok(summary);
        }
        let mut progress = |part: f64| asked.tell(0.5 + 0.5 * part);
        let mut left = self.uncertain(&mut summary);
        while let Some(worst) = left.first().copied() {
            let places: Vec<_> = summary.peaks().into_iter().map(|peak| peak.map(|p| *p)).collect();
            let at = |which: usize| places[which].map_or([0.0; 3], |peak| peak.position);
            let is_near = |which: &usize| {
                let far = |axis: usize| (at(*which)[axis] - at(worst)[axis]).abs();
                far(0).max(far(1)) <= NEAR * half_width
            };
            let (here, others): (Vec<usize>, Vec<usize>) = left.into_iter().partition(is_near);
            left = others;
            let around = |reach: f64| {
                let windows = here.iter().map(|which| self.window(at(*which), reach * half_width));
                windows.fold(self.window(at(worst), 0.0), |a, b| {
                    [0, 1]
                        .map(|axis| a[axis].start.min(b[axis].start)..a[axis].end.max(b[axis].end))
                })
            };
            let (inner, window) = (around(MARGINS[0]), around(MARGINS[1]));
            let rows = Span::of(body, self.solution.grid()).rows;
            let is_whole = rows.start <= window[0].start && window[0].end <= rows.end;
            let at_end = body.ends() != [None; 2]
                && (!is_whole || rows.start == window[0].start || rows.end == window[0].end);
            if at_end {
                continue;
            }
            let wanted: Vec<_> = here
                .iter()
                .filter_map(|which| {
                    Some((place_of(&self.layers, *which, places[*which]?), places[*which]?))
                })
                .collect();
            let patch = self.patch(window)?;
            let wanted = (&*wanted, summary.least_value());
            let Some(plan) = self.fine_plan(&patch, wanted, &mut progress)? else {
                continue;
            };
            let beside = self.plans_beside(&patch)?;
            let friction = source.sliding.traction(&self.layers, self.options)?;
            let parts = beside
                .iter()
                .map(|(plan, factor)| (Evaluation::new(plan, friction, false), *factor));
            let finer = [0, 1].map(|axis| {
                plan.whole.grid.shape()[axis] / (patch.window[axis].end - patch.window[axis].start)
            });
            let core = [0, 1].map(|axis| {
                let start = patch.window[axis].start;
                (inner[axis].start - start) * finer[axis]..(inner[axis].end - start) * finer[axis]
            });
            let beside = Beside {
                grid: self.solution.grid(),
                parts: parts.collect(),
                core,
                fields: Vec::new(),
            };
            let mut fine = request.evaluate(&plan, Some(beside), half_width, &mut progress);
            if !fine.finished {
                summary.finished = false;
                return Ok(summary);
            }
            for (which, (own, finer)) in summary.peaks().into_iter().zip(fine.peaks()).enumerate() {
                if let (true, Some(own), Some(finer)) = (here.contains(&which), own, finer)
                    && finer.uncertainty.is_some_and(|error| Some(error) < own.uncertainty)
                {
                    *own = *finer;
                }
            }
        }
        summary.compare(strengths);
        Ok(summary)
    }

    /// Numbers of the extremes on the grid that are more uncertain than is asked for, the worst first.
    fn uncertain(&self, summary: &mut StressSummary) -> Vec<usize> {
        let least = summary.least_value();
        let grid = self.solution.grid();
        let ratio = |peak: &Peak| {
            let [x, y, _] = peak.position;
            let ratio =
                peak.uncertainty.filter(|_| grid.holds([x, y]))? / peak.value.abs().max(least);
            Some(ratio).filter(|ratio| *ratio > self.target)
        };
        let peaks = summary.peaks().into_iter().enumerate();
        let mut found: Vec<(usize, f64)> =
            peaks.filter_map(|(which, peak)| Some((which, ratio(peak?)?))).collect();
        found.sort_by(|a, b| b.1.total_cmp(&a.1));
        found.into_iter().map(|(which, _)| which).collect()
    }

    /// Number of the cell at a coordinate along an axis.
    fn cell(&self, axis: usize, at: f64) -> usize {
        let grid = self.solution.grid();
        let position = (at - grid.coordinates(axis)[0]) / grid.spacing()[axis];
        (position.round().max(0.0) as usize).min(grid.shape()[axis] - 1)
    }

    /// Cells of the grid within a distance of a place along both axes.
    fn window(&self, place: [f64; 3], reach: f64) -> Window {
        [0, 1].map(|axis| {
            let cells = (reach / self.solution.grid().spacing()[axis]).ceil() as usize;
            let cell = self.cell(axis, place[axis]);
            cell.saturating_sub(cells)..(cell + cells + 1).min(self.solution.grid().shape()[axis])
        })
    }

    fn setup(&self) -> Setup {
        Setup {
            counterbody: self.bodies.get(1).cloned(),
            threads: self.options.threads,
            ..Setup::default()
        }
    }

    /// The cells of a window, `finer` times as many along each axis.
    fn grid(&self, window: &Window, finer: [usize; 2]) -> Result<Grid> {
        let whole = self.solution.grid();
        let cells = window.clone().map(|range| range.len());
        let shape = [0, 1].map(|axis| cells[axis] * finer[axis]);
        let size = [0, 1].map(|axis| cells[axis] as f64 * whole.spacing()[axis]);
        let centre = [0, 1].map(|axis| {
            let along = whole.coordinates(axis);
            0.5 * (along[window[axis].start] + along[window[axis].end - 1])
        });
        match whole.is_line() {
            true => Grid::line(shape[1], size[1])?.centered_at(centre),
            false => Grid::new(shape, size)?.centered_at(centre),
        }
    }

    fn patch(&self, window: Window) -> Result<Patch> {
        let grid = self.grid(&window, [1, 1])?;
        let [first, column] = window.each_ref().map(|range| range.start);
        let of_window = |field: &Array2<f64>| {
            Array2::from_shape_fn(grid.shape(), |(i, j)| field[[first + i, column + j]])
        };
        let pressure = of_window(&self.solution.pressure);
        let contact = Contact::plan(&self.bodies[0], grid, self.setup())?;
        let gap = of_window(&self.solution.gap()) - contact.convolution().apply(&pressure)?;
        let load = pressure.sum() * grid.cell_area();
        Ok(Patch { window, gap: Sampled::new(&grid, gap), load })
    }

    /// Plan of the stress of a patch on cells that are fine enough for the `wanted` extremes, or as fine as may be; none where
    /// the grid's are.
    fn fine_plan(
        &self,
        patch: &Patch,
        (wanted, least): (&[(Place, Peak)], f64),
        progress: &mut StressProgress,
    ) -> Result<Option<StressPlan>> {
        let most = self.solution.grid().shape().iter().product::<usize>().max(FEWEST_CELLS);
        let mut finer = match self.solution.grid().is_line() {
            true => [1, 2],
            false => [2, 2],
        };
        let mut found = None;
        loop {
            let grid = self.grid(&patch.window, finer)?;
            if grid.shape().iter().product::<usize>() > most {
                return Ok(found);
            }
            if progress(0.0).is_break() {
                return Err(Error::Stopped);
            }
            let contact = Contact::plan(&self.bodies[0], grid, self.setup())?;
            let options = Options::default();
            let solved = contact.solve(&patch.gap, &Motion::load(patch.load), &options)?;
            let solved = solved.require_converged(options.tolerance)?;
            let sliding = self.source.sliding;
            let source = PressureSource {
                body: &self.layers,
                grid: &grid,
                pressure: &solved.pressure,
                solved: Some(BodyPair(self.bodies.iter().map(|body| &**body).collect())),
                sliding,
                tractions: None,
            };
            let friction = source.sliding.traction(&self.layers, self.options)?;
            let Some(plan) = source.plan(self.options.threads, progress)? else {
                return Err(Error::Stopped);
            };
            // Axes along which a wanted extreme is too uncertain.
            let mut coarse = [false; 2];
            for (place, peak) in wanted {
                let near = [0, 1].map(|axis| {
                    let at = |shift: f64| {
                        let spacing = self.solution.grid().spacing()[axis];
                        let from = grid.coordinates(axis)[0];
                        let cell =
                            (peak.position[axis] + shift * spacing - from) / grid.spacing()[axis];
                        (cell.round().max(0.0) as usize).min(grid.shape()[axis] - 1)
                    };
                    at(-1.0)..at(1.0) + 1
                });
                let errors = plan.whole.uncertainties_by_axis(place, friction, &near);
                for (coarse, error) in coarse.iter_mut().zip(errors) {
                    *coarse |= error > self.target * peak.value.abs().max(least);
                }
            }
            found = Some(plan);
            if coarse == [false; 2] {
                return Ok(found);
            }
            for (finer, coarse) in finer.iter_mut().zip(coarse) {
                *finer *= if coarse { 2 } else { 1 };
            }
        }
    }

    /// Plans on the whole grid of what the stress of a patch lacks, with the factor of each.
    fn plans_beside(&self, patch: &Patch) -> Result<Vec<(StressPlan, f64)>> {
        let whole = &self.source;
        let mut outside = self.solution.pressure.clone();
        for i in patch.window[0].clone() {
            patch.window[1].clone().for_each(|j| outside[[i, j]] = 0.0);
        }
        let threads = StressOptions::with_threads(self.options.threads);
        let planned = |body: &HalfSpace, pressure: &Array2<f64>| {
            let source = PressureSource {
                body,
                pressure,
                grid: whole.grid,
                solved: None,
                sliding: whole.sliding,
                tractions: None,
            };
            source.planned((&threads).into())
        };
        if whole.body.ends() == [None; 2] {
            return Ok(vec![(planned(&self.layers, &outside)?, 1.0)]);
        }
        let inside = &self.solution.pressure - &outside;
        let all = planned(whole.body, &self.solution.pressure)?;
        Ok(vec![(all, 1.0), (planned(&self.layers, &inside)?, -1.0)])
    }
}
