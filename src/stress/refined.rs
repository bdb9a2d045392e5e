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
//! A patch holds the cells in which an extreme may be larger than its value by more than is asked for, of those extremes whose
//! largest bounds are within a width of the contact. It counts within a quarter of the half-width of them and ends a half-width
//! farther off, where the pressure of the grid follows, which is uniform over cells. Of an extreme, the largest value and the
//! largest bound count of those of the patches and of the rest of the grid.

use std::ops::Range;

use ndarray::Array2;

use super::field::{Bound, Extreme};
use super::options::{StressOptions, StressProgress, WatchedStress};
use super::outside_patch::{OutsidePatch, Sampled};
use super::plan::{Evaluation, PressureSource, StressPlan};
use super::section::Span;
use super::subcell::{BodyPair, ErrorOf};
use super::summary::{Extremes, Scope, Strengths, StressSummary, SummaryRequest, place_of};
use crate::compliance::response::Body;
use crate::compliance::response::interior::Place;
use crate::contact::{Contact, Motion, Options, Setup, Solution};
use crate::error::{Error, Result, refuse_if, require};
use crate::model::body::HalfSpace;
use crate::model::grid::{Grid, Window};
use crate::numerics::rounding::{self, cells_within};

/// Distance, in half-widths of the contact, within which extremes are found on one patch: from edge to edge, and what is felt
/// outside.
const NEAR: f64 = 2.5;

/// Margins around the places of extremes, in half-widths of the contact: of the cells that count, as extremes may move, and of
/// the patch.
const MARGINS: [f64; 2] = [0.25, 1.25];

/// Error of an extreme on finer cells, as a part of it, however fine they are: from the gap that is interpolated and from loads
/// beside the patch, which are uniform over cells of the grid. Found by trial: below coats, extremes on patches are within 5e-4 of
/// those of whole grids of such cells.
const LEAST_ERROR: f64 = 5e-4;

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
    /// Whether it holds all of the load.
    is_whole: bool,
}

/// An extreme that is more uncertain than is asked for.
#[derive(Clone)]
struct Suspect {
    /// Its number in [`Extremes`].
    which: usize,
    /// What its bound exceeds the value by, as a part of it.
    ratio: f64,
    /// Where its bound is, and the cell of that.
    at: [f64; 2],
    cell: [usize; 2],
    place: Place,
    /// The cells in which it may be larger than its value by more than is allowed.
    cells: Window,
    /// Error that is allowed.
    allowed: f64,
}

/// What suspects are chosen from: all extremes, the bounds in each cell of the grid, and the parts of it that finer cells stand
/// for.
struct Suspects<'a> {
    all: &'a Extremes,
    bounds: &'a [Vec<f64>],
    cores: &'a [Window],
}

fn holds(window: &Window, cell: [usize; 2]) -> bool {
    [0, 1].iter().all(|axis| window[*axis].contains(&cell[*axis]))
}

/// The shortest range that holds both.
fn joined(a: &Range<usize>, b: &Range<usize>) -> Range<usize> {
    a.start.min(b.start)..a.end.max(b.end)
}

/// The summary of [`Solution::stress_summary`], with finer cells where an extreme is more uncertain than the part
/// `target` of it.
pub(super) fn refined_summary(
    solution: &Solution,
    source: PressureSource,
    strengths: &Strengths,
    target: f64,
    mut watched_options: WatchedStress,
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
        options: watched_options.options(),
        target,
    };
    refined.summary(strengths, &mut watched_options)
}

impl Refined<'_> {
    fn summary(
        &self,
        strengths: &Strengths,
        watched_options: &mut WatchedStress,
    ) -> Result<StressSummary> {
        let source = &self.source;
        let body = source.body;
        let request =
            SummaryRequest::checked(body, source.grid, &source.sliding, strengths, self.options)?;
        let mut progress = |fraction: f64| watched_options.tell(0.5 * fraction);
        let Some(plan) = source.plan(self.options.threads, &mut progress)? else {
            return Ok(StressSummary::default());
        };
        let half_width = plan.whole.half_width();
        let scope = Scope { records: true, ..Scope::of(&plan) };
        let mut of_grid = request.evaluate(&plan, scope, &mut progress);
        if !of_grid.finished {
            return Ok(of_grid.summary(body, strengths));
        }
        let mut progress = |fraction: f64| watched_options.tell(0.5 + 0.5 * fraction);
        let beyond = std::mem::take(&mut of_grid.beyond);
        // Parts of the grid that finer cells stand for, and the extremes of these.
        let mut cores: Vec<Window> = Vec::new();
        let mut of_patches: Option<Extremes> = None;
        let mut settled = vec![false; of_grid.values.len()];
        loop {
            let all = of_patches.as_ref().map_or_else(|| of_grid.clone(), |of| of_grid.with(of));
            let all = all.with_values(&beyond);
            let summary = all.summary(body, strengths);
            let suspects = Suspects { all: &all, bounds: &of_grid.bounds, cores: &cores };
            let suspects = self.suspects(&suspects, &settled, (summary.least_value(), half_width));
            if suspects.is_empty() {
                // Suspects are those of the cells alone: an error that is asked for may be smaller.
                let values =
                    all.values.into_iter().map(|extreme| extreme.uncertain_by(LEAST_ERROR));
                let all = Extremes { values: values.collect(), ..all };
                return Ok(all.summary(body, strengths));
            }
            let around = |reach: f64| {
                let windows = suspects.iter().map(|suspect| self.wider(&suspect.cells, reach));
                windows.reduce(|a, b| [0, 1].map(|axis| joined(&a[axis], &b[axis])))
            };
            let margins = MARGINS.map(|margin| around(margin * half_width).unwrap_or_default());
            let windows = self.within_ends(margins, half_width);
            // Largest bounds that are allowed; those that stay may be any.
            let allowed = |(extreme, stays): (&Extreme, &bool)| match stays {
                true => f64::INFINITY,
                false => {
                    extreme.value + self.target * extreme.value.abs().max(summary.least_value())
                }
            };
            let largest: Vec<f64> = all.values.iter().zip(&settled).map(allowed).collect();
            let (inside, outside): (Vec<_>, Vec<_>) =
                suspects.into_iter().partition(|suspect| holds(&windows[0], suspect.cell));
            let fine = match inside.is_empty() {
                true => None,
                false => self.fine_extremes(
                    (&request, &plan),
                    (&inside, &largest),
                    windows.clone(),
                    &mut progress,
                )?,
            };
            // The largest bounds of these stay, whatever is found elsewhere.
            let stay = if fine.is_some() { outside } else { [inside, outside].concat() };
            stay.iter().for_each(|suspect| settled[suspect.which] = true);
            let Some(fine) = fine else { continue };
            let [core, _] = windows;
            cores.push(core);
            let scope = Scope { without: &cores, records: true, ..Scope::of(&plan) };
            of_grid = request.evaluate(&plan, scope, &mut progress);
            if !(fine.finished && of_grid.finished) {
                return Ok(StressSummary { finished: false, ..summary });
            }
            of_patches = Some(of_patches.map_or(fine.clone(), |of| of.with(&fine)));
        }
    }

    /// The extremes whose largest bounds are too far from their values and near each other, the worst first, of those that are
    /// not `settled`; none where there are no more.
    fn suspects(
        &self,
        &Suspects { all, bounds, cores }: &Suspects,
        settled: &[bool],
        (least, half_width): (f64, f64),
    ) -> Vec<Suspect> {
        let [_, ny] = self.solution.grid().shape();
        let is_open = |cell: [usize; 2]| !cores.iter().any(|core| holds(core, cell));
        let uncertain = |(which, extreme): (usize, &Extreme)| {
            let Bound { value, position: [x, y, depth] } = extreme.bound?;
            let size = extreme.value.abs().max(least);
            let ratio = (value - extreme.value) / size;
            let cell = [self.cell(0, x), self.cell(1, y)];
            let counts = !settled[which] && value > 0.0 && ratio > self.target;
            let is_within = self.solution.grid().holds([x, y]) && is_open(cell);
            (counts && is_within).then(|| Suspect {
                which,
                ratio,
                at: [x, y],
                cell,
                place: place_of(&self.layers, which, depth),
                cells: cell.map(|k| k..k + 1),
                allowed: self.target * size,
            })
        };
        let mut suspects: Vec<_> = all.values.iter().enumerate().filter_map(uncertain).collect();
        suspects.sort_by(|a, b| b.ratio.total_cmp(&a.ratio));
        let Some(worst) = suspects.first() else { return suspects };
        let (at, near) = (worst.at, NEAR * half_width);
        let around = self.wider(&worst.cells, near);
        suspects.retain(|suspect| {
            (suspect.at[0] - at[0]).abs().max((suspect.at[1] - at[1]).abs()) <= near
        });
        for suspect in &mut suspects {
            let most = all.values[suspect.which].value + suspect.allowed;
            for i in around[0].clone() {
                for j in around[1].clone() {
                    if bounds[suspect.which][i * ny + j] > most && is_open([i, j]) {
                        let cell = [i..i + 1, j..j + 1];
                        suspect.cells =
                            [0, 1].map(|axis| joined(&suspect.cells[axis], &cell[axis]));
                    }
                }
            }
        }
        suspects
    }

    /// The windows of the cells that count and of the patch, cut so that neither reaches the margin at a free end.
    fn within_ends(&self, [mut core, mut window]: [Window; 2], half_width: f64) -> [Window; 2] {
        let (body, grid) = (self.source.body, self.solution.grid());
        let rows = Span::of(body, grid).rows;
        let margin = cells_within((MARGINS[1] - MARGINS[0]) * half_width, grid.spacing()[0]);
        let [low, high] = body.ends().map(|end| usize::from(end.is_some()));
        for (range, cells) in [(&mut window[0], 1), (&mut core[0], 1 + margin)] {
            range.start = range.start.max(low * (rows.start + cells));
            let end = if high > 0 { rows.end.saturating_sub(cells) } else { range.end };
            range.end = range.end.min(end).max(range.start);
        }
        [core, window]
    }

    /// The extremes in the core of a window, on cells with which their bounds are at most the `largest` that are allowed, or as
    /// fine as may be; none where the grid's are.
    fn fine_extremes(
        &self,
        (request, whole): (&SummaryRequest, &StressPlan),
        (suspects, largest): (&[Suspect], &[f64]),
        [core, window]: [Window; 2],
        progress: &mut StressProgress,
    ) -> Result<Option<Extremes>> {
        let patch = self.patch(window)?;
        let friction = self.source.sliding.traction(&self.layers, self.options)?;
        let is_line = self.solution.grid().is_line();
        let mut finer = if is_line { [1, 2] } else { [2, 2] };
        let beside = self.plans_beside(&patch)?;
        let mut extremes: Option<Extremes> = None;
        while let Some((plan, reached)) = self.fine_plan(&patch, suspects, finer, progress)? {
            finer = reached;
            let parts = beside
                .iter()
                .map(|(plan, factor)| (Evaluation::new(plan, friction, false), *factor))
                .collect();
            let core = [0, 1].map(|axis| {
                let [start, end] = [core[axis].start, core[axis].end]
                    .map(|cell| (cell - patch.window[axis].start) * finer[axis]);
                start..end
            });
            let beside =
                OutsidePatch { grid: self.solution.grid(), parts, core, fields: Vec::new() };
            let scope = Scope {
                beside: Some(beside),
                half_width: whole.whole.half_width(),
                contact: if patch.is_whole { &plan } else { whole },
                ..Scope::of(&plan)
            };
            let fine = request.evaluate(&plan, scope, progress);
            // At other depths and of other extremes, errors may be larger than at the places of the suspects.
            let is_known = |(extreme, most): (&Extreme, &f64)| {
                let most = most.max(extreme.value * (1.0 + self.target));
                extreme.bound.is_none_or(|bound| bound.value <= most)
            };
            let ends = !fine.finished || fine.values.iter().zip(largest).all(is_known);
            extremes = Some(fine);
            if ends {
                break;
            }
            finer = if is_line { [1, 2 * finer[1]] } else { finer.map(|times| 2 * times) };
        }
        Ok(extremes)
    }

    /// Number of the cell at a coordinate along an axis.
    fn cell(&self, axis: usize, at: f64) -> usize {
        let grid = self.solution.grid();
        let position = (at - grid.coordinates(axis)[0]) / grid.spacing()[axis];
        (rounding::round(position).max(0.0) as usize).min(grid.shape()[axis] - 1)
    }

    /// A window, wider by a distance to all sides, as far as the grid goes.
    fn wider(&self, window: &Window, reach: f64) -> Window {
        let grid = self.solution.grid();
        [0, 1].map(|axis| {
            let cells = cells_within(reach, grid.spacing()[axis]);
            let end = (window[axis].end + cells).min(grid.shape()[axis]);
            window[axis].start.saturating_sub(cells)..end
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
        let sum = pressure.sum();
        let loaded = |pressure: &Array2<f64>| pressure.iter().filter(|p| **p != 0.0).count();
        Ok(Patch {
            is_whole: loaded(&pressure) == loaded(&self.solution.pressure),
            window,
            gap: Sampled::new(&grid, gap),
            load: sum * grid.cell_area(),
        })
    }

    /// Plan of the stress of a patch on cells that are `finer` so many times and fine enough at the places of the `suspects`, or
    /// as fine as may be, with how many times finer they are; none where none may be so fine.
    fn fine_plan(
        &self,
        patch: &Patch,
        suspects: &[Suspect],
        mut finer: [usize; 2],
        progress: &mut StressProgress,
    ) -> Result<Option<(StressPlan, [usize; 2])>> {
        let most = self.solution.grid().shape().iter().product::<usize>().max(FEWEST_CELLS);
        let mut finest = None;
        loop {
            let grid = self.grid(&patch.window, finer)?;
            if grid.shape().iter().product::<usize>() > most {
                return Ok(finest);
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
            // Axes along which an extreme is too uncertain.
            let mut coarse = [false; 2];
            for suspect in suspects {
                let near = [0, 1].map(|axis| {
                    let [start, end] = [suspect.cells[axis].start, suspect.cells[axis].end]
                        .map(|cell| (cell - patch.window[axis].start) * finer[axis]);
                    start..end
                });
                let errors = plan.whole.errors(&suspect.place, (friction, false));
                let errors =
                    errors.unwrap_or_default().by_axis(&plan.whole.steps(&near), ErrorOf::Any);
                for (coarse, error) in coarse.iter_mut().zip(errors) {
                    *coarse |= error > suspect.allowed;
                }
            }
            finest = Some((plan, finer));
            if coarse == [false; 2] {
                return Ok(finest);
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
        let threads = StressOptions::default().with_threads(self.options.threads);
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
