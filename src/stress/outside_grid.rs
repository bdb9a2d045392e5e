//! Extremes beyond the grid.
//!
//! Where the largest value at a depth lies on the border of the grid, the plane is evaluated again on wider grids, each twice
//! as wide as the last, until it lies within. Below layers that bend, a larger value may lie farther out than one within the
//! grid: there wider grids are searched in any case, as far as the layers bend. Beyond the grid, the load is far: its cells
//! are taken as uniform, and merged into larger ones of the same force and moments. The method was derived here.

use std::ops::ControlFlow;

use ndarray::{Array2, ArrayRef2};

use super::field::{Extreme, Largest, Tensor};
use super::half_space::HalfSpacePlan;
use super::options::StressProgress;
use super::plan::{Evaluation, PressureSource, StressPlan};
use super::subcell::STRESSES;
use crate::compliance::response::interior::Place;
use crate::compliance::response::substrate_material;
use crate::error::Result;
use crate::model::body::{HalfSpace, Layer};
use crate::model::grid::Grid;
use crate::numerics::rounding;

/// Growth of a value from one grid to the next below which the place does not matter, as a part of the value, and of the
/// largest stress at the depth: a stress that rises to its residual value at infinity has no place. Growth falls at least by
/// half from grid to grid, since stresses approach their limit at least as fast as the inverse of the distance: as much
/// again is left.
const NEGLIGIBLE_GROWTH: [f64; 2] = [1e-3, 1e-6];

/// A value on the border below this part of the layer's largest is not followed, unless that largest is itself below this part
/// of the largest stress at the depth: it would have to grow tenfold.
const LEAST_ON_BORDER: f64 = 0.1;

/// Cells across the grid within, at least, after merging.
const ACROSS: usize = 32;

/// Cells between the load and the border, at least, after merging; where there are fewer before, none are merged.
const BETWEEN: usize = 4;

/// Error of stresses beyond the grid where the load is uniform over cells, and merged so that its third moments differ,
/// as a part of the largest of them on that grid. Of 20 stacks, all extremes are within it (`tests/stress/outside_grid.rs` has
/// some).
const MERGING: f64 = 2e-3;

/// Part of a value by which one beyond the grid must be larger: less is rounding.
const ROUNDING: f64 = 1e-6;

/// Distance from a load at which a plate that it bends on an elastic half-space has its largest moment of the other sign, in
/// ℓ = (2 D/E')^⅓ of the plate's stiffness D and the half-space's modulus E': the minimum of the moment of a line load,
/// ∫ k cos(kx)/(k³ + 1) dk. That of a point load is nearer, at 1.9 to 2.5 for ν from 0 to ½. Computed here.
const BENDING: f64 = 2.65;

/// The same for a line of couples, ∫ k² sin(kx)/(k³ + 1) dk, as tractions on a plate are. Computed here.
const TURNING: f64 = 3.8;

/// Distance behind a traction at which the tension below layers may be largest, in their thickness. Chosen by trial: in 270
/// line contacts, it is at 5 to 25.
const BEHIND: f64 = 25.0;

/// Cells of a plane of which one is evaluated before all are: a prime number, so that their columns differ from row to row.
pub(super) const SAMPLED: usize = 61;

/// Widest grid, in periods of the other axis, where one repeats: the time for its coefficients grows with that number.
const PERIODS: f64 = 64.0;

/// Wider grids that are searched in any case, at most: 10⁴ times as wide, where a load on the grid makes 1e-8 of its pressure.
const FARTHEST: usize = 14;

/// Wider grids at most: 2⁵² times as wide, where the grid is a rounding of the width.
const WIDEST: usize = 52;

/// What evaluates a plan beyond its grid.
#[derive(Debug)]
pub(super) struct OutsideGrid<'a> {
    plan: &'a StressPlan,
    friction: [f64; 2],
    /// Number of wider grids that are searched in any case, and at most.
    searched: usize,
    most: usize,
    /// Axes along which `wider` are wider than the grid.
    axes: [bool; 2],
    /// Plans on wider grids, made when they are needed.
    wider: Vec<StressPlan>,
}

impl<'a> OutsideGrid<'a> {
    pub(super) fn new(plan: &'a StressPlan, friction: [f64; 2]) -> Self {
        let slides = friction.iter().any(|f| *f != 0.0) || plan.known.is_some();
        let searched = searched(&plan.whole, slides);
        let grid = &plan.whole.grid;
        let periods = |axis: usize| grid.size()[axis] / grid.size()[1 - axis];
        let most = match grid.is_periodic() {
            [true, false] => (PERIODS / periods(1)).log2() as usize,
            [false, true] => (PERIODS / periods(0)).log2() as usize,
            _ => WIDEST,
        };
        Self { plan, friction, searched, most, axes: [false; 2], wider: Vec::new() }
    }

    /// `peaks` at the last of `places`, or larger ones beyond the grid, and those beyond it alone. `of` has the values of a
    /// cell, from its stresses at `places`, of which the `largest` matters; values that stay below the `best` of other
    /// depths do not. `bound` tells cheaply how large all magnitudes are of a cell whose values do not exceed others; none where they may.
    /// Where memory does not suffice for a wider grid, the peaks so far stand.
    pub(super) fn peaks<const N: usize, const K: usize>(
        &mut self,
        (mut peaks, largest, best): ([Extreme; N], f64, [f64; N]),
        places: &[Place; K],
        residual: &[f64],
        (of, bound): (
            impl Fn(&[Tensor; K]) -> [f64; N],
            impl Fn(&[Tensor; K], [f64; N]) -> Option<f64>,
        ),
        progress: &mut StressProgress,
    ) -> ControlFlow<(), [[Extreme; N]; 2]> {
        let mut inner = self.plan.whole.grid;
        let mut beyond = [Extreme::NONE; N];
        for level in 0..self.most {
            let matters = |(peak, best): &(&Extreme, f64)| {
                peak.value >= LEAST_ON_BORDER * best || *best < LEAST_ON_BORDER * largest
            };
            let followed = peaks.iter().zip(best).filter(matters).map(|(peak, _)| peak);
            // Far away there is no stress but the residual one.
            let is_free = inner.is_periodic() == [false; 2]
                && places.iter().all(|place| residual[place.layer] == 0.0);
            let rises =
                is_free && peaks.iter().zip(best).any(|(p, best)| p.value < 0.0 && best < 0.0);
            let axes = match level < self.searched || rises {
                true => open_axes(&self.plan.whole),
                false => borders(&self.plan.whole.body, &inner, followed),
            };
            if axes == [false; 2] || !self.has(level, axes, progress)? {
                break;
            }
            let plan = &self.wider[level];
            let planes = self.planes(plan, places, residual, progress)?;
            let tensors = |cell: usize| {
                planes
                    .each_ref()
                    .map(|fields| Tensor::new(fields.each_ref().map(|field| field[cell])))
            };
            let values = |cell: usize| of(&tensors(cell));
            let grid = &plan.whole.grid;
            let (x, y) = (grid.x(), grid.y());
            let mut outside = [Largest::NONE; N];
            let mut largest_here = 0.0_f64;
            let cells = x.iter().flat_map(|x| y.iter().map(|y| [*x, *y])).enumerate();
            let cells = cells.filter(|(_, at)| !inner.holds(*at)).map(|(cell, _)| cell);
            // Values that some cells reach rule out most of the others at once.
            for cell in cells.clone().step_by(SAMPLED).chain(cells) {
                let tensors = tensors(cell);
                if let Some(most) = bound(&tensors, outside.map(|largest| largest.value)) {
                    largest_here = largest_here.max(most);
                    continue;
                }
                for (outside, value) in outside.iter_mut().zip(of(&tensors)) {
                    outside.offer(value, cell);
                    largest_here = largest_here.max(value.abs());
                }
            }
            let mut grown = false;
            for (k, (peak, outside)) in peaks.iter_mut().zip(outside).enumerate() {
                if outside.value == f64::NEG_INFINITY {
                    continue;
                }
                let growth = outside.value - peak.value;
                let [own, of_largest] = NEGLIGIBLE_GROWTH;
                let rest = (own * outside.value.abs()).max(of_largest * largest);
                let between = outside.between(grid, |cell| Some(values(cell)[k]));
                let error = 2.0 * rest + between + MERGING * largest_here;
                let (i, j) = (outside.cell / y.len(), outside.cell % y.len());
                let position = [x[i], y[j], peak.position[2]];
                let value = outside.value + 0.5 * between;
                let farther = Extreme::of(value, position, peak.bound.map(|_| error));
                beyond[k] = beyond[k].with(farther);
                if growth > ROUNDING * peak.value.abs() {
                    grown |= growth > rest && outside.value + growth >= best[k];
                    *peak = peak.with(farther);
                } else {
                    *peak = peak.bounded_by(farther);
                }
            }
            if !grown && level + 1 >= self.searched {
                break;
            }
            inner = *grid;
        }
        ControlFlow::Continue([peaks, beyond])
    }

    /// Whether there is a plan of this level, which is made if it does not exist yet.
    fn has(
        &mut self,
        level: usize,
        needed_axes: [bool; 2],
        progress: &mut StressProgress,
    ) -> ControlFlow<(), bool> {
        let axes = [0, 1].map(|axis| self.axes[axis] || needed_axes[axis]);
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

    /// Power of two by which cells are larger along an axis in the first wider grid.
    fn merged(&self, axis: usize) -> usize {
        let whole = &self.plan.whole;
        let cells = (whole.gap(axis) / BETWEEN).min(whole.grid.shape()[axis] / ACROSS);
        cells.checked_ilog2().unwrap_or(0) as usize
    }

    /// The plan on the wider grid of this level, about 2^(`level` + 1) times as wide.
    fn widened(&self, level: usize, progress: &mut StressProgress) -> Result<Option<StressPlan>> {
        let whole = &self.plan.whole;
        // Along x, larger cells might reach beyond a free end: the grid is twice as wide there, in the same cells.
        let has_ends = whole.body.ends() != [None; 2];
        let powers = |axis: usize| match has_ends && axis == 0 {
            true => self.axes[axis].then_some((1, 0)),
            false => self.axes[axis].then_some((level + 1, level + self.merged(axis))),
        };
        let grid = whole.grid.widened([0, 1].map(powers))?;
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

/// Axes along which a grid can be wider and the body extends.
fn open_axes(whole: &HalfSpacePlan) -> [bool; 2] {
    let grid = &whole.grid;
    let goes_on = [whole.body.ends() == [None; 2], true];
    [0, 1].map(|axis| goes_on[axis] && grid.shape()[axis] > 1 && !grid.is_periodic()[axis])
}

/// Number of wider grids that hold all places where layers that bend may have their largest stresses; none where that is
/// within the grid, and none for a body with free ends and a grid that repeats, whose wider grids take long. All layers
/// together bend less than one of their thickness and of the largest modulus on a half-space of the smallest.
fn searched(whole: &HalfSpacePlan, slides: bool) -> usize {
    let (body, grid) = (&whole.body, &whole.grid);
    if body.ends() != [None; 2] || grid.is_periodic() != [false; 2] {
        return 0;
    }
    let materials = body.layers().iter().map(Layer::material).chain(substrate_material(body));
    let moduli = materials.map(|material| material.young() / (1.0 - material.poisson().powi(2)));
    let (least, most) = moduli.fold((f64::INFINITY, 0.0_f64), |(a, b), e| (a.min(e), b.max(e)));
    let thickness: f64 = body.layers().iter().map(Layer::thickness).sum();
    let length = thickness * (most / least / 6.0).cbrt();
    let far = if slides { (TURNING * length).max(BEHIND * thickness) } else { BENDING * length };
    let outside = |axis: &usize| {
        open_axes(whole)[*axis] && far >= whole.gap(*axis) as f64 * grid.spacing()[*axis]
    };
    let widths = [0, 1].into_iter().filter(outside).map(|axis| grid.size()[axis]);
    let times = 1.0 + 2.0 * far / widths.fold(f64::INFINITY, f64::min);
    (rounding::ceil(times.log2()) as usize).min(FARTHEST)
}

/// Axes along which a peak lies in the outermost cells of `grid`, where neither the grid repeats nor the body ends.
fn borders<'a>(
    body: &HalfSpace,
    grid: &Grid,
    peaks: impl Iterator<Item = &'a Extreme> + Clone,
) -> [bool; 2] {
    [0, 1].map(|axis| {
        let (centres, cell) = (grid.coordinates(axis), grid.spacing()[axis]);
        let ends = if axis == 0 { body.ends() } else { [None; 2] };
        let is_cut = |peak: &Extreme| {
            let borders =
                [centres[0], centres[centres.len() - 1]].into_iter().zip(ends).zip([-1.0, 1.0]);
            borders.into_iter().any(|((border, end), side)| {
                let goes_on = end.is_none_or(|end: f64| side * (end - border) > cell);
                goes_on && (peak.position[axis] - border).abs() < 0.75 * cell
            })
        };
        centres.len() > 1 && !grid.is_periodic()[axis] && peaks.clone().any(is_cut)
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
            let nearest = rounding::round((at - first) / spacing);
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
