//! Overlap outside a grid: the deformed surface there, from the pressure on the grid.

use super::relief::Relief;
use super::task::{Frame, Task, cells_in_contact, enclosing, frame_of};
use crate::compliance::influence::CellInfluence;
use crate::compliance::response::Body;
use crate::contact::problem::patch::block;
use crate::contact::solution::Solution;
use crate::error::Result;

/// Blocks of cells along each axis whose mean pressure stands for their own: a block is then at most a third
/// of its distance from places outside the margin of a grid.
const BLOCKS: usize = 16;

/// Places where a shape overlaps the deformed surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Overlap {
    /// A rectangle that holds them.
    pub(super) frame: Frame,
    /// Deepest overlap \[m\].
    pub(super) depth: f64,
}

/// Places outside `frame`, which holds the contact of `solution`, where the shape overlaps the deformed surface;
/// `None` where it does so nowhere.
pub(super) fn overlap(task: &Task, solution: &Solution, frame: Frame) -> Result<Option<Overlap>> {
    let relief = Relief::new(task.shape, solution.tilt);
    let mut lows = relief.lows_outside(frame);
    // Pressure pushes the surface away, so that only these can touch.
    lows.retain(|low| low.gap < solution.approach);
    let nearby = Nearby::of(task, solution);
    lows.retain(|low| low.gap + nearby.displacement(low.at) < solution.approach);
    if lows.is_empty() {
        return Ok(None);
    }
    let pressed = Pressed::by(solution);
    let reach = lows.iter().fold(0.0, |reach: f64, low| reach.max(pressed.farthest(low.at)));
    let bodies = pressed.plan(task, reach)?;
    let mut found: Option<Overlap> = None;
    for low in lows {
        let displacement: f64 = bodies.iter().map(|body| pressed.displacement(body, low.at)).sum();
        let depth = solution.approach - low.gap - displacement;
        if depth > 0.0 {
            let frame = low.at.map(|at| [at, at]);
            found = Some(found.map_or(Overlap { frame, depth }, |found| Overlap {
                frame: enclosing(found.frame, frame),
                depth: found.depth.max(depth),
            }));
        }
    }
    Ok(found)
}

/// The displacement outside a grid, at least: from the displacement u at the nearest cell, without sums over the
/// pressure.
///
/// At a distance d from this cell, which is m away from the contact, no pressure is more than (1 + d/m) times as
/// far away. The displacement around a force falls as 1/r on a half-space, more slowly where the substrate is
/// softer than the surface, and faster where it is harder: u (1 + d/m)^−q, with q = 1 or a larger one.
struct Nearby<'a> {
    solution: &'a Solution,
    contact: Frame,
    rate: i32,
}

/// Rate q at which the displacement falls on a substrate that is harder than the surface; chosen by trial.
const FAST_DECAY: i32 = 4;

impl<'a> Nearby<'a> {
    fn of(task: &Task, solution: &'a Solution) -> Self {
        let hard = |body: &Body| {
            let limits = body.asymptotes();
            limits.long < limits.short || body.local() > 0.0
        };
        let any_hard = hard(task.body) || task.setup.counterbody.as_ref().is_some_and(hard);
        let (frame, spacing) = (frame_of(solution.grid()), solution.grid().spacing());
        let window = cells_in_contact(solution).unwrap_or([0..0, 0..0]);
        let end = |k: usize, cell: usize| frame[k][0] + spacing[k] * cell as f64;
        Self {
            solution,
            contact: [0, 1].map(|k| [end(k, window[k].start), end(k, window[k].end)]),
            rate: if any_hard { FAST_DECAY } else { 1 },
        }
    }

    fn displacement(&self, at: [f64; 2]) -> f64 {
        let grid = self.solution.grid();
        let (low, spacing, shape) = (frame_of(grid), grid.spacing(), grid.shape());
        let cell = [0, 1].map(|k| (((at[k] - low[k][0]) / spacing[k]) as usize).min(shape[k] - 1));
        let center = [0, 1].map(|k| low[k][0] + spacing[k] * (cell[k] as f64 + 0.5));
        let distance = (at[0] - center[0]).hypot(at[1] - center[1]);
        let [mx, my] = [0, 1].map(|k| {
            let [start, end] = self.contact[k];
            (start - center[k]).max(center[k] - end).max(0.0)
        });
        let margin = mx.hypot(my);
        if margin > 0.0 {
            self.solution.displacement[cell] / (1.0 + distance / margin).powi(self.rate)
        } else {
            0.0
        }
    }
}

/// The pressure of a solution, uniform on each of a few blocks of cells.
struct Pressed {
    /// Centre and pressure of each block.
    blocks: Vec<([f64; 2], f64)>,
    sides: [f64; 2],
}

impl Pressed {
    fn by(solution: &Solution) -> Self {
        let (grid, pressure) = (solution.grid(), &solution.pressure);
        let window = cells_in_contact(solution).unwrap_or([0..0, 0..0]);
        let across = [0, 1].map(|k| window[k].len().div_ceil(BLOCKS).max(1));
        let sides = [0, 1].map(|k| across[k] as f64 * grid.spacing()[k]);
        let parts = |k: usize| {
            let range = window[k].clone();
            range
                .clone()
                .step_by(across[k])
                .map(move |first| first..(first + across[k]).min(range.end))
        };
        let low = [0, 1].map(|k| grid.center()[k] - 0.5 * grid.size()[k]);
        let mut blocks = Vec::new();
        for x in parts(0) {
            for y in parts(1) {
                // A block that reaches beyond the contact has no pressure there.
                let sum = block(pressure, &[x.clone(), y.clone()]).sum();
                let center = [0, 1].map(|k| {
                    let first = [x.start, y.start][k] as f64;
                    low[k] + grid.spacing()[k] * first + 0.5 * sides[k]
                });
                blocks.push((center, sum / (across[0] * across[1]) as f64));
            }
        }
        Self { blocks, sides }
    }

    /// Largest distance of `at` from the centre of a block.
    fn farthest(&self, at: [f64; 2]) -> f64 {
        let distance = |[x, y]: [f64; 2]| (x - at[0]).hypot(y - at[1]);
        self.blocks.iter().fold(0.0, |most, (center, _)| distance(*center).max(most))
    }

    /// The influence of one block on each of the two bodies, for offsets up to `reach`.
    fn plan(&self, task: &Task, reach: f64) -> Result<Vec<CellInfluence>> {
        if self.blocks.is_empty() {
            return Ok(Vec::new());
        }
        let bodies = [Some(task.body), task.setup.counterbody.as_ref()];
        let bodies = bodies.into_iter().flatten().cloned();
        bodies.map(|body| CellInfluence::plan(body, self.sides, reach)).collect()
    }

    /// Displacement of one of the bodies at a place outside all blocks.
    fn displacement(&self, body: &CellInfluence, [x, y]: [f64; 2]) -> f64 {
        let blocks = self.blocks.iter();
        blocks.map(|([cx, cy], pressure)| pressure * body.at([x - cx, y - cy])).sum()
    }
}
