//! Low places of a shape that is tilted: the places where it may touch.

use ndarray::Axis;

use crate::compliance::influence::CellInfluence;
use crate::contact::automatic::trial::{Frame, Trial, enclosing};
use crate::contact::plan::bodies;
use crate::contact::problem::patch::block;
use crate::contact::solution::Solution;
use crate::error::Result;
use crate::model::surface::{Extent, Surface};

/// Even parts of a side of the region that is looked at. Chosen by trial: 6 and 24 find the same grids for 13 contacts.
const PARTS: u32 = 12;

/// Distances from the middle of interest at which lines are looked at: each a quarter of the one before.
const DISTANCES: i32 = 10;

/// Steps that narrow the place of a lowest point, each by the golden section: to 2e-4 of the distance
/// between two lines, so that the gap of a smooth shape is known to 4e-8 of its rise there.
const NARROWINGS: u32 = 18;

/// Lines between which a lowest point is looked for, in one region, which bounds the time.
const VALLEYS: usize = 8;

/// Doublings of the distance at which the end of an overlap is looked for, up to the side of the region.
const DOUBLINGS: i32 = 60;

/// Length at which a shape without end is looked at, relative to the length of interest.
const FAR: f64 = 1e4;

/// A place where a shape is lowest along a line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Low {
    pub(super) at: [f64; 2],
    /// h − s_x x − s_y y
    pub(super) gap: f64,
}

/// A tilted shape: h − s_x x − s_y y.
pub(super) struct Relief<'a> {
    shape: &'a dyn Surface,
    tilt: [f64; 2],
    marks: [Vec<f64>; 2],
}

impl<'a> Relief<'a> {
    pub(super) fn new(shape: &'a dyn Surface, tilt: [f64; 2]) -> Self {
        Self { shape, tilt, marks: shape.marks() }
    }

    /// h − s_x x − s_y y
    pub(super) fn gap(&self, [x, y]: [f64; 2]) -> f64 {
        self.shape.gap(x, y) - (self.tilt[0] * x + self.tilt[1] * y)
    }

    /// The rectangle in which the gap can be finite; where the shape has no end, a rectangle around `middle` that
    /// is far larger than `length`.
    pub(super) fn region(&self, middle: [f64; 2], length: f64) -> Frame {
        let extent = self.shape.extent();
        [0, 1].map(|k| {
            let [low, high] = extent[k].range();
            [low.max(middle[k] - FAR * length), high.min(middle[k] + FAR * length)]
        })
    }

    /// The lowest points along lines across `region`, which are densest around `middle`.
    pub(super) fn lows(&self, region: Frame, middle: [f64; 2]) -> Vec<Low> {
        let mut lows = Vec::new();
        if region.iter().any(|[low, high]| low.partial_cmp(high).is_none_or(|o| o.is_ge())) {
            return lows;
        }
        let [xs, ys] = [0, 1].map(|k| stations(region[k], middle[k], &self.marks[k]));
        let along = |x: f64| {
            let values: Vec<f64> = ys.iter().map(|&y| self.gap([x, y])).collect();
            let minima = valleys(&values).into_iter();
            minima
                .map(|k| narrowed(&ys, &values, k, |y| self.gap([x, y])))
                .map(move |(y, gap)| Low { at: [x, y], gap })
                .collect::<Vec<_>>()
        };
        let lowest =
            |lows: &[Low]| lows.iter().fold(f64::INFINITY, |least, low| least.min(low.gap));
        let mut profile = Vec::new();
        for &x in &xs {
            let line_lows = along(x);
            profile.push(lowest(&line_lows));
            lows.extend(line_lows);
        }
        let mut between = valleys(&profile);
        between.sort_by(|&a, &b| profile[a].total_cmp(&profile[b]));
        for k in between.into_iter().take(VALLEYS) {
            let (x, _) = narrowed(&xs, &profile, k, |x| lowest(&along(x)));
            lows.extend(along(x));
        }
        lows
    }

    /// The low places outside `frame`.
    pub(super) fn lows_outside(&self, frame: Frame) -> Vec<Low> {
        let [x, y] = frame;
        let middle = frame.map(|[low, high]| 0.5 * (low + high));
        let length = (x[1] - x[0]).max(y[1] - y[0]);
        let [ex, ey] = self.region(middle, length);
        let strips = [
            ([[ex[0], x[0].min(ex[1])], ey], [x[0], middle[1]]),
            ([[x[1].max(ex[0]), ex[1]], ey], [x[1], middle[1]]),
            ([x, [ey[0], y[0].min(ey[1])]], [middle[0], y[0]]),
            ([x, [y[1].max(ey[0]), ey[1]]], [middle[0], y[1]]),
        ];
        let strips = strips.into_iter();
        strips.flat_map(|(strip, near)| self.lows(strip, near)).collect()
    }

    /// A rectangle around the places near `lows` whose gap is below `level`: on the lines through each of them,
    /// up to twice as far as necessary. `None` where there is no such place in `region`.
    pub(super) fn below(&self, lows: &[Low], level: f64, region: Frame) -> Option<Frame> {
        let deep = lows.iter().filter(|low| low.gap < level);
        let reach = |low: &Low| [0, 1].map(|axis| self.reach(low.at, axis, level, region[axis]));
        deep.map(reach).reduce(enclosing)
    }

    /// Ends of the line through `at` along `axis` on which the gap is below `level`.
    fn reach(&self, at: [f64; 2], axis: usize, level: f64, [low, high]: [f64; 2]) -> [f64; 2] {
        [-1.0, 1.0].map(|side| {
            let mut distance = 0.5_f64.powi(DOUBLINGS) * (high - low);
            for _ in 0..DOUBLINGS {
                let mut beyond = at;
                beyond[axis] += side * distance;
                // NaN is not below either.
                let inside = self.gap(beyond) < level;
                if !inside {
                    break;
                }
                distance *= 2.0;
            }
            at[axis] + side * distance
        })
    }
}

/// Extent of a frame along both axes, limited to somewhat more than `extent`.
pub(super) fn limited(frame: Frame, extent: [Extent; 2]) -> Frame {
    [0, 1].map(|k| {
        let [low, high] = extent[k].range();
        // Somewhat beyond the ends of the shape, where it has any.
        let beyond = 0.02 * (high - low);
        [frame[k][0].max(low - beyond), frame[k][1].min(high + beyond)]
    })
}

/// Coordinates from `low` to `high`: evenly spaced, ever closer towards `middle`, and at `marks`.
fn stations([low, high]: [f64; 2], middle: f64, marks: &[f64]) -> Vec<f64> {
    let span = high - low;
    let even = (0..=PARTS).map(|k| low + span * f64::from(k) / f64::from(PARTS));
    let near = (0..DISTANCES).flat_map(|k| {
        let distance = span * 0.25_f64.powi(k);
        [middle - distance, middle + distance]
    });
    let all = even.chain(near).chain([middle]).chain(marks.iter().copied());
    let mut stations: Vec<f64> = all.filter(|at| (low..=high).contains(at)).collect();
    stations.sort_by(f64::total_cmp);
    stations.dedup();
    stations
}

/// Numbers of the values that are finite and lower than their neighbours; the first one of equal values.
fn valleys(values: &[f64]) -> Vec<usize> {
    let at = |k: usize| values.get(k).copied().unwrap_or(f64::INFINITY);
    let lower = |k: &usize| {
        let value = at(*k);
        value.is_finite() && (*k == 0 || value < at(k - 1)) && value <= at(k + 1)
    };
    (0..values.len()).filter(lower).collect()
}

/// The lowest point of `f` between the neighbours of the station `k`, and its value, by the golden section.
fn narrowed(stations: &[f64], values: &[f64], k: usize, f: impl Fn(f64) -> f64) -> (f64, f64) {
    // 1 − 1/golden ratio
    const SECTION: f64 = 0.381_966_011_250_105;
    let (mut at, mut least) = (stations[k], values[k]);
    let mut low = stations[k.saturating_sub(1)];
    let mut high = stations[(k + 1).min(stations.len() - 1)];
    for _ in 0..NARROWINGS {
        let above = high - at > at - low;
        let end = if above { high } else { low };
        let tried = at + SECTION * (end - at);
        let value = f(tried);
        if value < least {
            if above {
                low = at;
            } else {
                high = at;
            }
            (at, least) = (tried, value);
        } else if above {
            high = tried;
        } else {
            low = tried;
        }
    }
    (at, least)
}

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
pub(super) fn overlap(trial: &Trial, solution: &Solution, frame: Frame) -> Result<Option<Overlap>> {
    let relief = Relief::new(trial.shape, solution.tilt);
    let mut lows = relief.lows_outside(frame);
    // Pressure pushes the surface away, so that only these can touch.
    lows.retain(|low| low.gap < solution.approach);
    if lows.is_empty() {
        return Ok(None);
    }
    let pressed = Pressed::by(solution);
    let reach = lows.iter().fold(0.0, |reach: f64, low| reach.max(pressed.farthest(low.at)));
    let bodies = pressed.plan(trial, reach)?;
    let mut overlap: Option<Overlap> = None;
    for low in lows {
        let displacement: f64 = bodies.iter().map(|body| pressed.displacement(body, low.at)).sum();
        let depth = solution.approach - low.gap - displacement;
        if depth > 0.0 {
            let frame = low.at.map(|at| [at, at]);
            overlap = Some(overlap.map_or(Overlap { frame, depth }, |overlap| Overlap {
                frame: enclosing(overlap.frame, frame),
                depth: overlap.depth.max(depth),
            }));
        }
    }
    Ok(overlap)
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
        let window = solution.cells_in_contact().unwrap_or([0..0, 0..0]);
        let across = [0, 1].map(|k| window[k].len().div_ceil(BLOCKS).max(1));
        let sides = [0, 1].map(|k| across[k] as f64 * grid.spacing()[k]);
        let first = [0, 1].map(|k| {
            let low = grid.center()[k] - 0.5 * grid.size()[k];
            low + grid.spacing()[k] * window[k].start as f64 + 0.5 * sides[k]
        });
        let mut blocks = Vec::new();
        let loaded = block(pressure, &window);
        for (i, rows) in loaded.axis_chunks_iter(Axis(0), across[0]).enumerate() {
            for (j, cells) in rows.axis_chunks_iter(Axis(1), across[1]).enumerate() {
                let center = [first[0] + i as f64 * sides[0], first[1] + j as f64 * sides[1]];
                // A block that reaches beyond the contact has no pressure there.
                blocks.push((center, cells.sum() / (across[0] * across[1]) as f64));
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
    fn plan(&self, trial: &Trial, reach: f64) -> Result<Vec<CellInfluence>> {
        if self.blocks.is_empty() {
            return Ok(Vec::new());
        }
        let bodies = bodies(trial.body, trial.setup).into_iter().cloned();
        bodies.map(|body| CellInfluence::plan(body, self.sides, reach)).collect()
    }

    /// Displacement of one of the bodies at a place outside all blocks.
    fn displacement(&self, body: &CellInfluence, [x, y]: [f64; 2]) -> f64 {
        let blocks = self.blocks.iter();
        blocks.map(|([cx, cy], pressure)| pressure * body.at([x - cx, y - cy])).sum()
    }
}
