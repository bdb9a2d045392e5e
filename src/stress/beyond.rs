//! Extremes beyond the grid, for those that lie on its border.
//!
//! Where the largest value at a depth lies on the border of the grid, the plane is evaluated again on wider grids, each twice
//! as wide as the last, until it lies within. Beyond the grid, the load is far: its cells are taken as uniform, and from the
//! second grid on they are merged into larger ones of the same force and moments. The method was derived here.

use std::ops::ControlFlow;

use ndarray::{Array2, ArrayRef2};

use super::field::{Peak, Tensor};
use super::options::StressProgress;
use super::plan::{Evaluation, PressureSource, StressPlan};
use super::subcell::STRESSES;
use crate::compliance::response::interior::Place;
use crate::error::Result;
use crate::model::grid::Grid;

/// Growth of a value from one grid to the next, as a part of it, below which the place does not matter: a stress that
/// rises to its residual value at infinity has none. Growth falls at least by half from grid to grid, since stresses fall off
/// at least as the distance: as much again is left.
const NEGLIGIBLE_GROWTH: f64 = 1e-3;

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

    /// `peaks` at the last of `places`, or larger ones beyond the grid. `of` has the values of a cell, from its stresses at
    /// `places`. Where memory does not suffice for a wider grid, the peaks found so far stand.
    pub(super) fn peaks<const N: usize, const K: usize>(
        &mut self,
        mut peaks: [Peak; N],
        places: &[Place; K],
        residual: &[f64],
        of: impl Fn(&[Tensor; K]) -> [f64; N],
        progress: &mut StressProgress,
    ) -> ControlFlow<(), [Peak; N]> {
        let mut inner = self.plan.whole.grid;
        for level in 0.. {
            let cut = borders(&inner, &peaks);
            if cut == [false; 2] || !self.has(level, cut, progress)? {
                break;
            }
            let plan = &self.wider[level];
            let planes = self.planes(plan, places, residual, progress)?;
            let grid = &plan.whole.grid;
            let (x, y) = (grid.x(), grid.y());
            let mut grown = false;
            for (k, [x, y]) in x.iter().flat_map(|x| y.iter().map(|y| [*x, *y])).enumerate() {
                if inner.holds([x, y]) {
                    continue;
                }
                let tensors = planes
                    .each_ref()
                    .map(|fields| Tensor::new(fields.each_ref().map(|field| field[k])));
                for (peak, value) in peaks.iter_mut().zip(of(&tensors)) {
                    if value > peak.value {
                        grown |= value - peak.value > NEGLIGIBLE_GROWTH * value.abs();
                        (peak.value, peak.position[0], peak.position[1]) = (value, x, y);
                        let rest = 2.0 * NEGLIGIBLE_GROWTH * value.abs();
                        peak.uncertainty = peak.uncertainty.map(|error| error.max(rest));
                    }
                }
            }
            if !grown {
                break;
            }
            inner = *grid;
        }
        ControlFlow::Continue(peaks)
    }

    /// Whether there is a plan of this level, which is made where it lacks.
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
                Err(_) => return ControlFlow::Continue(false),
            }
        }
        ControlFlow::Continue(true)
    }

    /// The plan on a grid 2^(`level` + 1) times as wide.
    fn widened(&self, level: usize, progress: &mut StressProgress) -> Result<Option<StressPlan>> {
        let whole = &self.plan.whole;
        let grid = whole.grid.widened(self.axes, level)?;
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

/// Axes along which a peak lies in the outermost cells of `grid`, which does not repeat there.
fn borders(grid: &Grid, peaks: &[Peak]) -> [bool; 2] {
    [0, 1].map(|axis| {
        let centres = grid.coordinates(axis);
        let ends = [centres[0], centres[centres.len() - 1]];
        let half = 0.75 * grid.spacing()[axis];
        let is_beside =
            |peak: &Peak| ends.iter().any(|end| (peak.position[axis] - end).abs() < half);
        centres.len() > 1 && !grid.is_periodic()[axis] && peaks.iter().any(is_beside)
    })
}

/// The loads of `field`, in the cells of `from`, on the cells of `to`. Each is shared among the three nearest along each axis,
/// so that force, moments and second moments are the same: those of a cell of side s around t are 1, t and t² + s²/12.
fn moved(field: &[f64], from: &Grid, to: &Grid) -> Array2<f64> {
    /// Shares that are roundings.
    const ROUNDING: f64 = 1e-9;
    let shares = |axis: usize| -> Vec<Vec<(usize, f64)>> {
        let (first, spacing) = (to.coordinates(axis)[0], to.spacing()[axis]);
        let side = from.spacing()[axis] / spacing;
        let share = |at: &f64| {
            let nearest = ((at - first) / spacing).round();
            let moment = (at - first) / spacing - nearest;
            let second = moment * moment + (side * side - 1.0) / 12.0;
            let shares = [0.5 * (second - moment), 1.0 - second, 0.5 * (second + moment)];
            let cells = (0..3).map(|k| (nearest as usize + k).wrapping_sub(1));
            cells.zip(shares).filter(|(_, share)| share.abs() > ROUNDING).collect()
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
