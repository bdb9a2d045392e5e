//! Values of outputs, and their derivatives with respect to pressure and motion.

use ndarray::Array2;

use crate::contact::Solution;
use crate::error::{Error, Result, finite, require, same_shape};
use crate::gradient::parameter::Parameter;
use crate::gradient::state::Linearised;
use crate::model::grid::{Axis, Grid, Window};
use crate::stress::{Member, Side};

/// Relative difference of two pressures that tie.
const TIE: f64 = 1e-9;

/// One output: its value, and what the adjoint system needs.
pub(super) struct Seed {
    pub(super) value: f64,
    /// ∂J/∂p in the window, 0 outside the contact.
    pub(super) pressure: Vec<f64>,
    /// ∂J/∂λ of loaded freedoms.
    pub(super) motion: [f64; 3],
    /// ∂J/∂s of prescribed freedoms.
    pub(super) prescribed: [f64; 3],
    /// Cells whose displacement is part of the output, and weights.
    pub(super) displaced: Vec<([usize; 2], f64)>,
    /// Whether the gap itself is part of the output, beside the displacement.
    pub(super) is_gap: bool,
    pub(super) warning: Option<String>,
}

impl Seed {
    fn new(state: &Linearised, value: f64) -> Self {
        Self {
            value,
            pressure: vec![0.0; state.pressure.len()],
            motion: [0.0; 3],
            prescribed: [0.0; 3],
            displaced: Vec::new(),
            is_gap: false,
            warning: None,
        }
    }

    /// The seed of an output other than a stress.
    pub(super) fn of(solution: &Solution, state: &Linearised, output: &Output) -> Result<Self> {
        let area = solution.grid().cell_area();
        let p = &state.pressure;
        Ok(match output {
            Output::Approach => Self::of_motion(state, 0),
            Output::Tilt(axis) | Output::Moment(axis)
                if solution.grid().is_periodic()[axis.index()] =>
            {
                return Err(Error::no_derivative(
                    "a tilt or a moment",
                    "the grid is periodic along this axis: there is neither a tilt nor a moment",
                ));
            }
            Output::Tilt(axis) => Self::of_motion(state, 1 + axis.index()),
            Output::Load => Self::of_moment(state, 0, area),
            Output::Moment(axis) => Self::of_moment(state, 1 + axis.index(), area),
            Output::PressureNorm(r) => Self::pressure_norm(state, area, *r)?,
            Output::ParticipationArea => {
                let (sum, square) = (p.iter().sum::<f64>(), p.iter().map(|p| p * p).sum::<f64>());
                let slope = |p: &f64| 2.0 * area * (sum / square) * (1.0 - p * sum / square);
                Self::of_pressures(state, area * sum * (sum / square), slope)
            }
            Output::CellPeak => {
                let [(k, value), (_, next)] = largest(p);
                if value - next <= TIE * value {
                    return Err(Error::no_derivative(
                        "the cell peak",
                        "two cells have the largest pressure; take the located peak or a pressure norm",
                    ));
                }
                let mut seed = Self::new(state, value);
                seed.pressure[k] = 1.0;
                seed
            }
            Output::LocatedPeak => Self::located_peak(state),
            Output::Pressure(at) => {
                let cells = bilinear(solution.grid(), *at)?;
                let mut seed = Self::new(state, 0.0);
                for (cell, weight) in cells {
                    if let Some(k) = number_in(&state.tangent.window, cell)
                        && state.tangent.contact[k]
                    {
                        seed.pressure[k] = weight;
                        seed.value += weight * p[k];
                    }
                }
                seed
            }
            Output::Displacement(at) | Output::Gap(at) => {
                let cells = bilinear(solution.grid(), *at)?;
                Self::displacement(solution, state, cells, matches!(output, Output::Gap(_)))?
            }
            Output::AreaEstimate => {
                let (value, slopes) = area_estimate(state, area)?;
                let warning = "the area is an estimate by level sets: its derivative is in error by 1 to 2 % from 50 \
                               cells a radius on, and more below";
                Self { warning: Some(warning.to_owned()), ..Self::linear(state, value, slopes) }
            }
            Output::Weighted(weights) => {
                let name = "weights of the pressure";
                same_shape(name, weights, solution.grid().shape())?;
                let part = crate::contact::block(weights, &state.tangent.window);
                let part = state.masked(&part.iter().copied().collect::<Vec<_>>());
                let value = part.iter().zip(p).map(|(w, p)| w * p).sum();
                Self::linear(state, value, part)
            }
            Output::ContactArea => {
                return Err(Error::no_derivative(
                    "the area of the cells in contact",
                    "it changes by whole cells; take the participation area, which is smooth, or the area estimate",
                ));
            }
            Output::ContactExtent => {
                return Err(Error::no_derivative(
                    "the extent of the contact",
                    "at a fixed number of cells its derivative is 20 to 40 % wrong on any grid; take the participation \
                     area or the area estimate",
                ));
            }
            Output::Stress(_) => {
                return Err(Error::Inconsistent("a stress has a seed of its own"));
            }
        })
    }

    /// A seed with `slopes` with respect to the pressure.
    pub(super) fn linear(state: &Linearised, value: f64, slopes: Vec<f64>) -> Self {
        Self { pressure: slopes, ..Self::new(state, value) }
    }

    /// A seed with this slope with respect to the pressure of each cell in contact.
    fn of_pressures(state: &Linearised, value: f64, slope: impl Fn(&f64) -> f64) -> Self {
        let slopes: Vec<f64> = state.pressure.iter().map(slope).collect();
        Self::linear(state, value, state.masked(&slopes))
    }

    fn pressure_norm(state: &Linearised, area: f64, r: f64) -> Result<Self> {
        let holds = r >= 1.0 && r.is_finite();
        require("exponent of the norm", r, holds, "finite and at least 1")?;
        let p = &state.pressure;
        // Relative to the peak, so that powers neither overflow nor vanish.
        let peak = p.iter().fold(0.0, |a: f64, p| a.max(*p));
        let sum: f64 = p.iter().map(|p| (p / peak).powf(r)).sum();
        let value = peak * (area * sum).powf(1.0 / r);
        let slope = |p: &f64| value / peak / sum * (p / peak).powf(r - 1.0);
        Ok(Self::of_pressures(state, value, slope))
    }

    fn of_motion(state: &Linearised, freedom: usize) -> Self {
        let mut seed = Self::new(state, state.motion[freedom]);
        if state.loaded[freedom] {
            seed.motion[freedom] = 1.0;
        } else {
            seed.prescribed[freedom] = 1.0;
        }
        seed
    }

    /// Σ p (1, x, y) dA.
    fn of_moment(state: &Linearised, freedom: usize, area: f64) -> Self {
        let value = area * state.moments(&state.pressure)[freedom];
        let mut unit = [0.0; 3];
        unit[freedom] = area;
        Self::linear(state, value, state.masked(&state.moved(unit)))
    }

    /// The peak of parabolas through the cell of the largest pressure and its neighbours. Neighbours that tie share it: their
    /// parabolas differ by third differences of the pressure alone.
    fn located_peak(state: &Linearised) -> Self {
        let p = &state.pressure;
        let [(first, value), _] = largest(p);
        let ny = state.tangent.window[1].len();
        let tied: Vec<usize> = (0..p.len()).filter(|&k| value - p[k] <= TIE * value).collect();
        let mut seed = Self::new(state, 0.0);
        let share = 1.0 / tied.len() as f64;
        for &k in &tied {
            seed.value += share * Self::add_peak(state, k, share, &mut seed.pressure);
        }
        seed.pressure = state.masked(&seed.pressure);
        let apart =
            |k: &usize| (k / ny).abs_diff(first / ny) > 1 || (k % ny).abs_diff(first % ny) > 1;
        if tied.iter().any(apart) {
            seed.warning = Some(
                "cells apart from each other have the largest pressure: the derivative of the peak is a mean of those of \
                 each, and differs on both sides"
                    .to_owned(),
            );
        }
        seed
    }

    /// Peak of the parabolas around cell k; adds `share` of its weights to `weights`.
    fn add_peak(state: &Linearised, k: usize, share: f64, weights: &mut [f64]) -> f64 {
        let p = &state.pressure;
        let ny = state.tangent.window[1].len();
        let (i, j, nx) = (k / ny, k % ny, p.len() / ny);
        let mut value = p[k];
        weights[k] += share;
        for (at, n, stride) in [(i, nx, ny), (j, ny, 1)] {
            if at == 0 || at + 1 >= n {
                continue;
            }
            let cells = [k - stride, k, k + stride];
            // By the envelope theorem, the place of the peak needs no derivative.
            if let Some(parabola) = parabola(cells.map(|k| p[k])) {
                for (cell, weight) in cells.into_iter().zip(parabola) {
                    value += weight * p[cell];
                    weights[cell] += share * weight;
                }
                value -= p[k];
                weights[k] -= share;
            }
        }
        value
    }

    /// Displacement, or gap, of weighted cells.
    fn displacement(
        solution: &Solution,
        state: &Linearised,
        cells: Vec<([usize; 2], f64)>,
        is_gap: bool,
    ) -> Result<Self> {
        let [x0, y0] = [0, 1].map(|axis| state.tangent.window[axis].start);
        let ny = state.tangent.window[1].len();
        let mut seed = Self::new(state, 0.0);
        let springs = solution.compliance.as_ref().filter(|_| is_gap);
        let springs = springs.map(|c| c.on(solution.grid())).transpose()?;
        let total = solution.total_displacement();
        state.tangent.reach(offsets(&state.tangent.window, &cells))?;
        for &(cell, weight) in &cells {
            let mut displaced = 0.0;
            for (k, slope) in seed.pressure.iter_mut().enumerate() {
                if state.tangent.contact[k] {
                    let other = [x0 + k / ny, y0 + k % ny];
                    let own = springs.as_ref().filter(|_| cell == other).map_or(0.0, |c| c[cell]);
                    let entry = state.tangent.entry(cell, other) - state.tangent.raise + own;
                    *slope += weight * entry;
                    displaced += entry * state.pressure[k];
                }
            }
            let mut value = displaced;
            if is_gap {
                let at = [solution.grid().x()[cell[0]], solution.grid().y()[cell[1]]];
                let moved = |[delta, sx, sy]: [f64; 3]| delta + sx * at[0] + sy * at[1];
                // The undeformed gap, from the fields of the solution.
                let motion = [solution.approach, solution.tilt[0], solution.tilt[1]];
                let undeformed = solution.gap()[cell] - total[cell] + moved(motion);
                if !undeformed.is_finite() {
                    return Err(Error::no_derivative(
                        "the gap",
                        "it is infinite there: the shape has no surface",
                    ));
                }
                value += undeformed - moved(state.motion);
                for (freedom, unit) in [1.0, at[0], at[1]].into_iter().enumerate() {
                    match state.loaded[freedom] {
                        true => seed.motion[freedom] -= weight * unit,
                        false => seed.prescribed[freedom] -= weight * unit,
                    }
                }
            }
            seed.value += weight * value;
        }
        seed.displaced = cells;
        seed.is_gap = is_gap;
        Ok(seed)
    }
}

/// Numbers of offsets along x and y, 0 included, between any of `cells` and the cells of a window.
pub(super) fn offsets(window: &Window, cells: &[([usize; 2], f64)]) -> [usize; 2] {
    [0, 1].map(|axis| {
        let range = &window[axis];
        let distance = |(cell, _): &([usize; 2], f64)| {
            let [first, last] = [range.start, range.end - 1].map(|end| end.abs_diff(cell[axis]));
            first.max(last) + 1
        };
        cells.iter().map(distance).max().unwrap_or(0).max(range.len())
    })
}

/// Number of a cell of the grid among those of the window, row by row; `None` outside it.
fn number_in([x, y]: &Window, [i, j]: [usize; 2]) -> Option<usize> {
    (x.contains(&i) && y.contains(&j)).then(|| (i - x.start) * y.len() + (j - y.start))
}

/// The largest and the second largest of `values`, with their numbers.
pub(super) fn largest(values: &[f64]) -> [(usize, f64); 2] {
    let mut largest_two = [(0, f64::NEG_INFINITY); 2];
    for (k, &value) in values.iter().enumerate() {
        if value > largest_two[0].1 {
            largest_two = [(k, value), largest_two[0]];
        } else if value > largest_two[1].1 {
            largest_two[1] = (k, value);
        }
    }
    largest_two
}

/// Distance from the edge, in cells, of the pressures that set the level.
const INWARDS: usize = 3;

/// Area of the contact by level sets of p², and its derivative with respect to the pressure. Near the edge p² grows in
/// proportion to the distance, so that the area above a level t falls by a part in proportion to t, which 2A(t) − A(2t)
/// takes back:
///
/// ```text
/// A ≈ 2A(t) − A(2t)      A(t) = dA Σ S(p²/t)      S(u) = s² (3 − 2s), s = min(u/2, 1)
/// ```
///
/// t is the mean of p² three cells from the edge, and is kept while differentiating. Derived here; not published elsewhere.
pub(super) fn area_estimate(state: &Linearised, area: f64) -> Result<(f64, Vec<f64>)> {
    let ny = state.tangent.window[1].len();
    let nx = state.pressure.len() / ny;
    let mut left = state.tangent.contact.clone();
    for _ in 1..INWARDS {
        left = eroded(&left, [nx, ny]);
    }
    let inner = eroded(&left, [nx, ny]);
    let ring = left.iter().zip(&inner).map(|(left, inner)| *left && !inner);
    let squares: Vec<f64> =
        (ring.zip(&state.pressure)).filter_map(|(ring, p)| ring.then_some(p * p)).collect();
    if squares.is_empty() {
        return Err(Error::no_derivative(
            "the solution",
            "its contact is too small for an estimate of the area: refine the grid",
        ));
    }
    let level = squares.iter().sum::<f64>() / squares.len() as f64;
    let mut total = 0.0;
    let slopes = state.pressure.iter().map(|p| {
        let step = |level: f64| {
            let s = (0.5 * p * p / level).min(1.0);
            let slope = if s < 1.0 { 6.0 * s * (1.0 - s) * p / level } else { 0.0 };
            [s * s * (3.0 - 2.0 * s), slope]
        };
        let ([one, d_one], [two, d_two]) = (step(level), step(2.0 * level));
        total += area * (2.0 * one - two);
        area * (2.0 * d_one - d_two)
    });
    let slopes: Vec<f64> = slopes.collect();
    Ok((total, state.masked(&slopes)))
}

/// The cells all of whose neighbours along both axes are `inside`.
fn eroded(inside: &[bool], [nx, ny]: [usize; 2]) -> Vec<bool> {
    let at = |i: usize, j: usize| inside[i * ny + j];
    let cells = (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j)));
    cells
        .map(|(i, j)| {
            // A line contact is endless along x.
            let along = nx == 1 || i > 0 && i + 1 < nx && at(i - 1, j) && at(i + 1, j);
            at(i, j) && along && j > 0 && j + 1 < ny && at(i, j - 1) && at(i, j + 1)
        })
        .collect()
}

/// Distance, in cells, within which a coordinate counts as that of a cell centre or of the grid's border.
const CENTRE: f64 = 1e-9;

/// Cells around (x, y) and their weights, bilinear between cell centres and constant beyond the outer ones. A line contact is
/// the same at every x.
pub(super) fn bilinear(grid: &Grid, at: [f64; 2]) -> Result<Vec<([usize; 2], f64)>> {
    let along = |axis: usize| -> Result<Vec<(usize, f64)>> {
        let n = grid.shape()[axis];
        if axis == 0 && grid.is_line() {
            return Ok(vec![(0, 1.0)]);
        }
        let name = ["x", "y"][axis];
        let value = finite(name, at[axis])?;
        let position = (value - grid.center()[axis]) / grid.spacing()[axis] + 0.5 * (n - 1) as f64;
        let is_on_grid = (-0.5 - CENTRE..=n as f64 - 0.5 + CENTRE).contains(&position);
        require(name, value, is_on_grid, "on the grid")?;
        let nearest = position.round();
        let position = if (position - nearest).abs() < CENTRE { nearest } else { position };
        let position = position.clamp(0.0, (n - 1) as f64);
        let below = position as usize;
        let weight = position - below as f64;
        Ok([(below, 1.0 - weight), (below + 1, weight)]
            .into_iter()
            .filter(|(_, weight)| *weight > 0.0)
            .collect())
    };
    let (rows, columns) = (along(0)?, along(1)?);
    let pairs = rows.iter().flat_map(|(i, s)| {
        let pair = move |(j, t): &(usize, f64)| ([*i, *j], s * t);
        columns.iter().map(pair)
    });
    Ok(pairs.collect())
}

/// Weights (before, at, after) whose sum with three values is the peak of the parabola through them, and whose sum is 1;
/// none where the middle is no maximum.
///
/// ```text
/// w = (t (t − 1)/2, 1 − t², t (t + 1)/2)      t = (p₋ − p₊)/(2 (p₋ − 2 p + p₊))
/// ```
pub(super) fn parabola([before, at, after]: [f64; 3]) -> Option<[f64; 3]> {
    let bend = before - 2.0 * at + after;
    if bend >= 0.0 {
        return None;
    }
    let t = 0.5 * (before - after) / bend;
    Some([0.5 * t * (t - 1.0), 1.0 - t * t, 0.5 * t * (t + 1.0)])
}

/// A number that a solved contact gives, and that has a derivative.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Deserialize),
    serde(rename_all = "snake_case", deny_unknown_fields)
)]
#[non_exhaustive]
pub enum Output {
    /// Approach of the origin \[m\].
    Approach,
    /// Slope along x or y.
    Tilt(Axis),
    /// Load Σ p dA \[N\].
    Load,
    /// First moment Σ p x dA or Σ p y dA \[N m\].
    Moment(Axis),
    /// (Σ pʳ dA)^{1/r}, a smooth stand-in for the peak pressure where r is 8 to 30.
    PressureNorm(f64),
    /// Peak of parabolas through the cell of the largest pressure and its neighbours along x and y \[Pa\].
    LocatedPeak,
    /// Largest pressure of a cell \[Pa\]; refused where two cells tie.
    CellPeak,
    /// Pressure at (x, y) \[Pa\], bilinear between cell centres.
    Pressure([f64; 2]),
    /// Displacement of both bodies together at (x, y) \[m\], bilinear between cell centres.
    Displacement([f64; 2]),
    /// Gap at (x, y) \[m\], bilinear between cell centres.
    Gap([f64; 2]),
    /// W²/Σ p² dA \[m²\], a smooth measure of the area: (8/9) π a² for Hertz' contact.
    ParticipationArea,
    /// Level-set estimate of the contact area \[m²\], in error by 1 to 2 % of its derivative from 50 cells a radius on.
    AreaEstimate,
    /// Area of the cells in contact, which has no derivative: refused.
    ContactArea,
    /// Ends of the contact, which have no derivative: refused.
    ContactExtent,
    /// Σ w p with given weights (nx, ny).
    #[cfg_attr(feature = "serde", serde(skip))]
    Weighted(Array2<f64>),
    /// A stress.
    Stress(StressOutput),
}

/// A stress under the pressure as uniform over each cell, which is what [`stress`](crate::stress()) computes.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct StressOutput {
    /// The body.
    pub member: Member,
    /// What of the stress is taken.
    pub measure: Measure,
    /// Where.
    pub place: StressPlace,
    /// Coefficient of friction. Default: 0.
    pub friction: f64,
    /// Direction of the traction on the body; the counterbody gets the opposite. Default: that in which the shape rolls.
    pub direction: Option<[f64; 2]>,
}

builders! {
    StressOutput {
        with_member(member: Member),
        with_friction(friction: f64),
        with_direction(direction: impl Into<Option<[f64; 2]>>),
    }
}

impl StressOutput {
    /// `measure` of the stress in the body at `place`, without friction.
    pub fn new(measure: Measure, place: StressPlace) -> Self {
        Self { member: Member::Body, measure, place, friction: 0.0, direction: None }
    }
}

/// A scalar made of a stress.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Deserialize),
    serde(rename_all = "snake_case", deny_unknown_fields)
)]
#[non_exhaustive]
pub enum Measure {
    /// σ_xx, σ_yy, σ_zz, σ_xy, σ_yz, σ_xz, by number.
    Component(usize),
    /// Von Mises' equivalent stress.
    VonMises,
    /// A principal stress, 0 the largest; refused where it is repeated.
    Principal(usize),
    /// Half the difference of the largest and the smallest principal stress.
    MaxShear,
    /// Traction √(σ_xz² + σ_yz²) along the plane z = const, which an interface carries.
    PlaneShear,
}

/// Where a stress is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Deserialize),
    serde(rename_all = "snake_case", deny_unknown_fields)
)]
#[non_exhaustive]
pub enum StressPlace {
    /// The point (x, y, z), bilinear between cell centres, above or below an interface.
    Point([f64; 3], Side),
    /// Soft maximum over all cells at evenly spaced depths in a layer, both its faces among them.
    Layer {
        /// Number of the layer, from the surface down.
        layer: usize,
        /// Number of depths, 2 or more.
        depths: usize,
        /// β times about the largest value, see [`StressPlace::sharpness`].
        sharpness: f64,
    },
    /// Soft maximum over all cells at an interface.
    Interface {
        /// Number of the interface, that below the layer of this number.
        interface: usize,
        /// Side of the interface.
        side: Side,
        /// β times about the largest value, see [`StressPlace::sharpness`].
        sharpness: f64,
    },
}

impl StressPlace {
    /// Sharpness β s of a soft maximum (1/β) ln mean e^{βσ}, where s, the mean of order 32, is somewhat below the largest |σ|.
    /// The soft maximum is below the largest of N values by ln N/β at most.
    pub fn sharpness(&self) -> Option<f64> {
        match *self {
            Self::Point(..) => None,
            Self::Layer { sharpness, .. } | Self::Interface { sharpness, .. } => Some(sharpness),
        }
    }
}

/// Derivatives of one output.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Gradient {
    /// The output.
    pub output: Output,
    /// Value of the output at the polished solution.
    pub value: f64,
    /// Derivative with respect to each parameter, per unit of the parameter.
    pub values: Vec<(Parameter, f64)>,
    /// Derivative with respect to the undeformed gap of each cell (nx, ny); heights count −gap.
    pub gap: Array2<f64>,
    /// Smaller of the least pressure in contact, relative to the peak, and the least gap outside, relative to the largest
    /// displacement: how far the contact is from one of other cells, where derivatives jump.
    pub margin: f64,
    /// What makes the derivatives doubtful.
    pub warnings: Vec<String>,
}

impl Gradient {
    /// Derivative with respect to the parameter of this path.
    pub fn get(&self, path: &str) -> Option<f64> {
        let mut values = self.values.iter();
        values.find(|(parameter, _)| parameter.to_string() == path).map(|(_, value)| *value)
    }
}

/// Change of a solution along a direction of parameters, while the contact stays.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Direction {
    /// ṗ (nx, ny); 0 outside the contact.
    pub pressure: Array2<f64>,
    /// Change of the approach.
    pub approach: f64,
    /// Change of the tilts.
    pub tilt: [f64; 2],
    /// Largest step along the direction, of either sign, for which no pressure and no gap of the cells around the contact
    /// changes its sign to first order.
    pub valid_step: f64,
}
