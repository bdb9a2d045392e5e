//! Values of outputs, and their derivatives with respect to pressure and motion.

use super::contact::{area_estimate, largest};
use super::output::Output;
use super::point::{bilinear, parabola};
use super::state::State;
use crate::contact::Solution;
use crate::error::{Error, Result};
use crate::model::grid::Window;

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
    fn new(state: &State, value: f64) -> Self {
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
    ///
    /// # Errors
    /// An output without a derivative; a point off the grid.
    pub(super) fn of(solution: &Solution, state: &State, output: &Output) -> Result<Self> {
        let area = solution.grid().cell_area();
        let p = &state.pressure;
        Ok(match output {
            Output::Approach => Self::of_motion(state, 0),
            Output::Tilt(axis) => Self::of_motion(state, 1 + axis_of(*axis)?),
            Output::Load => Self::of_moment(state, 0, area),
            Output::Moment(axis) => Self::of_moment(state, 1 + axis_of(*axis)?, area),
            Output::PressureNorm(r) => {
                if !(*r >= 1.0 && r.is_finite()) {
                    return Err(Error::Parameter {
                        name: "exponent of the norm",
                        requirement: "finite and at least 1",
                        value: *r,
                    });
                }
                // Relative to the peak, so that powers neither overflow nor vanish.
                let peak = p.iter().fold(0.0, |a: f64, p| a.max(*p));
                let sum: f64 = p.iter().map(|p| (p / peak).powf(*r)).sum();
                let value = peak * (area * sum).powf(1.0 / r);
                let slope = |p: &f64| value / peak / sum * (p / peak).powf(r - 1.0);
                let slopes: Vec<f64> = p.iter().map(slope).collect();
                Self {
                    pressure: state.masked(&slopes),
                    ..Self::new(state, value)
                }
            }
            Output::ParticipationArea => {
                let (sum, square) = (p.iter().sum::<f64>(), p.iter().map(|p| p * p).sum::<f64>());
                let slope = |p: &f64| 2.0 * area * (sum / square) * (1.0 - p * sum / square);
                let slopes: Vec<f64> = p.iter().map(slope).collect();
                Self {
                    pressure: state.masked(&slopes),
                    ..Self::new(state, area * sum * (sum / square))
                }
            }
            Output::CellPeak => {
                let [(k, value), (_, next)] = largest(p);
                if value - next <= TIE * value {
                    return Err(refused(
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
                    if let Some(k) = place(state.tangent.window(), cell)
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
                Self {
                    pressure: slopes,
                    warning: Some(
                        "the area is an estimate by level sets: its derivative is in error by 1 to 2 % from 50 cells a \
                         radius on, and more below"
                            .to_owned(),
                    ),
                    ..Self::new(state, value)
                }
            }
            Output::Weighted(weights) => {
                let found = [weights.nrows(), weights.ncols()];
                if found != solution.grid().shape() {
                    return Err(Error::Shape {
                        name: "weights of the pressure",
                        expected: solution.grid().shape(),
                        found,
                    });
                }
                let part = crate::contact::block(weights, state.tangent.window());
                let part = state.masked(&part.iter().copied().collect::<Vec<_>>());
                let value = part.iter().zip(p).map(|(w, p)| w * p).sum();
                Self {
                    pressure: part,
                    ..Self::new(state, value)
                }
            }
            Output::ContactArea => {
                return Err(refused(
                    "the area of the cells in contact",
                    "it changes by whole cells; take the participation area, which is smooth, or the area estimate",
                ));
            }
            Output::ContactExtent => {
                return Err(refused(
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
    pub(super) fn linear(state: &State, value: f64, slopes: Vec<f64>) -> Self {
        Self {
            pressure: slopes,
            ..Self::new(state, value)
        }
    }

    fn of_motion(state: &State, freedom: usize) -> Self {
        let mut seed = Self::new(state, state.motion[freedom]);
        if state.loaded[freedom] {
            seed.motion[freedom] = 1.0;
        } else {
            seed.prescribed[freedom] = 1.0;
        }
        seed
    }

    /// Σ p (1, x, y) dA.
    fn of_moment(state: &State, freedom: usize, area: f64) -> Self {
        let value = area * state.moments(&state.pressure)[freedom];
        let mut unit = [0.0; 3];
        unit[freedom] = area;
        Self {
            pressure: state.masked(&state.moved(unit)),
            ..Self::new(state, value)
        }
    }

    /// The peak of parabolas through the cell of the largest pressure and its neighbours. Neighbours that tie share it: their
    /// parabolas differ by third differences of the pressure alone.
    fn located_peak(state: &State) -> Self {
        let p = &state.pressure;
        let [(first, value), _] = largest(p);
        let ny = state.tangent.window()[1].len();
        let tied: Vec<usize> = (0..p.len())
            .filter(|&k| value - p[k] <= TIE * value)
            .collect();
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
    fn add_peak(state: &State, k: usize, share: f64, weights: &mut [f64]) -> f64 {
        let p = &state.pressure;
        let ny = state.tangent.window()[1].len();
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
        state: &State,
        cells: Vec<([usize; 2], f64)>,
        is_gap: bool,
    ) -> Result<Self> {
        let [x0, y0] = [0, 1].map(|axis| state.tangent.window()[axis].start);
        let ny = state.tangent.window()[1].len();
        let mut seed = Self::new(state, 0.0);
        state
            .tangent
            .reach(offsets(state.tangent.window(), &cells))?;
        for &(cell, weight) in &cells {
            let mut displaced = 0.0;
            for (k, slope) in seed.pressure.iter_mut().enumerate() {
                if state.tangent.contact[k] {
                    let entry =
                        state.tangent.entry(cell, [x0 + k / ny, y0 + k % ny]) - state.tangent.raise;
                    *slope += weight * entry;
                    displaced += entry * state.pressure[k];
                }
            }
            let mut value = displaced;
            if is_gap {
                let at = [solution.grid().x()[cell[0]], solution.grid().y()[cell[1]]];
                let moved = |[delta, sx, sy]: [f64; 3]| delta + sx * at[0] + sy * at[1];
                // The undeformed gap, from the fields of the solution.
                let given = [solution.approach, solution.tilt[0], solution.tilt[1]];
                let undeformed = solution.gap()[cell] - solution.displacement[cell] + moved(given);
                if !undeformed.is_finite() {
                    return Err(refused(
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
        cells
            .iter()
            .map(distance)
            .max()
            .unwrap_or(0)
            .max(range.len())
    })
}

/// Number of a cell of the grid in the window.
pub(super) fn place([x, y]: &Window, [i, j]: [usize; 2]) -> Option<usize> {
    (x.contains(&i) && y.contains(&j)).then(|| (i - x.start) * y.len() + (j - y.start))
}

fn axis_of(axis: usize) -> Result<usize> {
    if axis < 2 {
        return Ok(axis);
    }
    Err(Error::Parameter {
        name: "axis",
        requirement: "0 (x) or 1 (y)",
        value: axis as f64,
    })
}

pub(super) fn refused(what: &str, reason: &'static str) -> Error {
    Error::NotDifferentiable {
        what: what.to_owned(),
        reason,
    }
}
