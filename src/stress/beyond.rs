//! Extremes beyond the grid, for those that lie on its border.
//!
//! Where the largest value at a depth lies on the border of the grid, the plane is evaluated again on wider grids, each twice
//! as wide as the last, until it lies within. Beyond the grid, the load is far: its cells are taken as uniform, and from the
//! second grid on they are merged into larger ones of the same force and moments. The method was derived here.

use std::ops::ControlFlow;

use ndarray::{Array2, ArrayRef2};

use super::field::{Largest, Peak, Tensor};
use super::options::StressProgress;
use super::plan::{Evaluation, PressureSource, StressPlan};
use super::subcell::STRESSES;
use crate::compliance::response::interior::Place;
use crate::error::Result;
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;

/// Growth of a value from one grid to the next, as a part of it, below which the place does not matter: a stress that
/// rises to its residual value at infinity has none. Growth falls at least by half from grid to grid, since stresses approach
/// their limit at least as fast as the inverse of the distance: as much again is left.
const NEGLIGIBLE_GROWTH: f64 = 1e-3;

/// Growth that does not matter, as a part of the largest stress at the depth.
const NEGLIGIBLE_STRESS: f64 = 1e-6;

/// What evaluates a plan beyond its grid.
#[derive(Debug)]
pub(super) struct Beyond<'a> {
    plan: &'a StressPlan,
    friction: [f64; 2],
    /// Axes along which `wider` are wider than the grid.
    axes: [bool; 2],
    /// Plans on wider grids, made when they are needed.
    wider: Vec<StressPlan>,
}

impl<'a> Beyond<'a> {
    pub(super) fn new(plan: &'a StressPlan, friction: [f64; 2]) -> Self {
        Self { plan, friction, axes: [false; 2], wider: Vec::new() }
    }

    /// Whether a peak lies on the border of the grid.
    pub(super) fn is_cut(&self, peak: &Peak) -> bool {
        let whole = &self.plan.whole;
        borders(&whole.body, &whole.grid, &[*peak]) != [false; 2]
    }

    /// `peaks` at the last of `places`, or larger ones beyond the grid. `of` has the values of a cell, from its stresses at
    /// `places`, of which the `largest` matters. Where memory does not suffice for a wider grid, the peaks found so far stand.
    pub(super) fn peaks<const N: usize, const K: usize>(
        &mut self,
        (mut peaks, largest): ([Peak; N], f64),
        places: &[Place; K],
        residual: &[f64],
        of: impl Fn(&[Tensor; K]) -> [f64; N],
        progress: &mut StressProgress,
    ) -> ControlFlow<(), [Peak; N]> {
        let mut inner = self.plan.whole.grid;
        for level in 0.. {
            let cut = borders(&self.plan.whole.body, &inner, &peaks);
            if cut == [false; 2] || !self.has(level, cut, progress)? {
                break;
            }
            let plan = &self.wider[level];
            let planes = self.planes(plan, places, residual, progress)?;
            let values = |cell: usize| {
                let tensor = |fields: &[Vec<f64>; STRESSES]| {
                    Tensor::new(fields.each_ref().map(|field| field[cell]))
                };
                of(&planes.each_ref().map(tensor))
            };
            let grid = &plan.whole.grid;
            let (x, y) = (grid.x(), grid.y());
            let mut found = peaks.map(|peak| Largest { value: peak.value, cell: usize::MAX });
            for (cell, at) in x.iter().flat_map(|x| y.iter().map(|y| [*x, *y])).enumerate() {
                if !inner.holds(at) {
                    let offered = found.iter_mut().zip(values(cell));
                    offered.for_each(|(found, value)| found.offer(value, cell));
                }
            }
            let mut grown = false;
            for (k, (peak, found)) in peaks.iter_mut().zip(found).enumerate() {
                if found.cell == usize::MAX {
                    continue;
                }
                let growth = found.value - peak.value;
                let rest = NEGLIGIBLE_GROWTH * found.value.abs();
                grown |= growth > rest && growth > NEGLIGIBLE_STRESS * largest;
                let between = found.between(grid, |cell| Some(values(cell)[k]));
                peak.value = found.value;
                peak.position[0] = x[found.cell / y.len()];
                peak.position[1] = y[found.cell % y.len()];
                peak.uncertainty = peak.uncertainty.map(|_| 2.0 * rest + between);
            }
            if !grown {
                break;
            }
            inner = *grid;
        }
        ControlFlow::Continue(peaks)
    }

    /// Whether there is a plan of this level, which is made if it does not exist yet.
    fn has(
        &mut self,
        level: usize,
        cut: [bool; 2],
        progress: &mut StressProgress,
    ) -> ControlFlow<(), bool> {
        let axes = [0, 1].map(|axis| self.axes[axis] || cut[axis]);
        if axes != self.axes {
            self.wider.clear();
            self.axes = axes;
        }
        while self.wider.len() <= level {
            match self.widened(self.wider.len(), progress) {
                Ok(Some(plan)) => self.wider.push(plan),
                Ok(None) => return ControlFlow::Break(()),
                // The source was checked for the grid within: what can lack is memory.
                Err(_) => return ControlFlow::Continue(false),
            }
        }
        ControlFlow::Continue(true)
    }

    /// The plan on a grid about 2^(`level` + 1) times as wide.
    fn widened(&self, level: usize, progress: &mut StressProgress) -> Result<Option<StressPlan>> {
        let whole = &self.plan.whole;
        // Along x, larger cells might reach beyond a free end.
        let ended = whole.body.ends() != [None; 2];
        let levels = [if ended { 0 } else { level }, level];
        let grid = whole.grid.widened([0, 1].map(|k| self.axes[k].then_some(levels[k])))?;
        let moved = |field: &[f64]| moved(field, &whole.grid, &grid);
        let pressure = moved(&whole.pressure);
        let sign = self.plan.sliding.sign;
        let known = self.plan.known.as_ref();
        let tractions = known.map(|both| both.each_ref().map(|q| sign * moved(q)));
        let source = PressureSource {
            body: &whole.body,
            grid: &grid,
            pressure: &pressure,
            solved: None,
            sliding: self.plan.sliding,
            tractions: tractions
                .as_ref()
                .map(|both| both.each_ref().map(|q| -> &ArrayRef2<f64> { q })),
        };
        source.plan(Some(whole.threads.count()), progress)
    }

    /// The six components at each of `places`.
    fn planes<const K: usize>(
        &self,
        plan: &StressPlan,
        places: &[Place; K],
        residual: &[f64],
        progress: &mut StressProgress,
    ) -> ControlFlow<(), [[Vec<f64>; STRESSES]; K]> {
        let mut evaluation = Evaluation::new(plan, self.friction, false);
        let cells = plan.whole.grid.shape().iter().product();
        let mut planes: [[Vec<f64>; STRESSES]; K] =
            std::array::from_fn(|_| std::array::from_fn(|_| vec![0.0; cells]));
        for (fields, place) in planes.iter_mut().zip(places) {
            evaluation.plane(place, &mut fields.each_mut().map(Vec::as_mut_slice), progress)?;
            for field in &mut fields[..2] {
                field.iter_mut().for_each(|s| *s += residual[place.layer]);
            }
        }
        ControlFlow::Continue(planes)
    }
}

/// Axes along which a peak lies in the outermost cells of `grid`, where neither the grid repeats nor the body ends.
fn borders(body: &HalfSpace, grid: &Grid, peaks: &[Peak]) -> [bool; 2] {
    [0, 1].map(|axis| {
        let (centres, cell) = (grid.coordinates(axis), grid.spacing()[axis]);
        let ends = if axis == 0 { body.ends() } else { [None; 2] };
        let is_cut = |peak: &Peak| {
            let borders =
                [centres[0], centres[centres.len() - 1]].into_iter().zip(ends).zip([-1.0, 1.0]);
            borders.into_iter().any(|((border, end), side)| {
                let goes_on = end.is_none_or(|end: f64| side * (end - border) > cell);
                goes_on && (peak.position[axis] - border).abs() < 0.75 * cell
            })
        };
        centres.len() > 1 && !grid.is_periodic()[axis] && peaks.iter().any(is_cut)
    })
}

/// The loads of `field`, in the cells of `from`, on the cells of `to`. Each is shared among the three nearest along each axis,
/// so that force, moments and second moments are the same: those of a cell of side s around t are 1, t and t² + s²/12.
fn moved(field: &[f64], from: &Grid, to: &Grid) -> Array2<f64> {
    /// Shares that are roundings.
    const ROUNDING: f64 = 1e-9;
    let shares = |axis: usize| -> Vec<Vec<(usize, f64)>> {
        let (first, spacing) = (to.coordinates(axis)[0], to.spacing()[axis]);
        let (side, count) = (from.spacing()[axis] / spacing, to.shape()[axis]);
        let share = |at: &f64| {
            let nearest = ((at - first) / spacing).round();
            let moment = (at - first) / spacing - nearest;
            let second = moment * moment + (side * side - 1.0) / 12.0;
            let shares = [0.5 * (second - moment), 1.0 - second, 0.5 * (second + moment)];
            let cells = (0..3).map(|k| (nearest as usize + k).wrapping_sub(1));
            let kept = |(cell, share): &(usize, f64)| *cell < count && share.abs() > ROUNDING;
            cells.zip(shares).filter(kept).collect()
        };
        from.coordinates(axis).iter().map(share).collect()
    };
    let (rows, columns) = (shares(0), shares(1));
    let mut sum = Array2::zeros(to.shape());
    let factor = from.cell_area() / to.cell_area();
    for (k, value) in field.iter().enumerate().filter(|(_, value)| **value != 0.0) {
        for (i, of_row) in &rows[k / columns.len()] {
            for (j, of_column) in &columns[k % columns.len()] {
                sum[[*i, *j]] += factor * of_row * of_column * value;
            }
        }
    }
    sum
}
