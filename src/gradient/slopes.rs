//! Right sides of the tangent: how the equations of a contact depend on each parameter.

use std::ops::ControlFlow;

use ndarray::Array2;

use super::parameter::{Parameter, layered};
use super::state::State;
use crate::compliance::influence::unchecked_coefficients;
use crate::compliance::response::ResponseSlope;
use crate::contact::{Solution, block};
use crate::error::{Error, Result};
use crate::model::grid::{full_window, repeating};
use crate::model::surface::Surface;
use crate::stress::Member;

/// b = K̇ p + ḣ − B_q ṡ_q and Ḟ/dA of one parameter.
pub(super) struct Slope {
    /// b in the window.
    pub(super) field: Vec<f64>,
    /// Ḟ/dA of the three freedoms; 0 where they are prescribed.
    pub(super) target: [f64; 3],
    source: Source,
}

/// What b is made of outside of the window.
enum Source {
    /// Coefficients of K̇.
    Coefficients(Array2<f64>),
    /// ḣ on the whole grid.
    Gap(Array2<f64>),
    /// ṡ
    Motion([f64; 3]),
}

impl Slope {
    /// The slope with respect to `parameter`, for [`Slope::at`] at cells within `reach` offsets; `None` where `watch`
    /// breaks.
    ///
    /// # Errors
    /// A parameter that the contact does not have.
    pub(super) fn new(
        (solution, shape): (&Solution, Option<&dyn Surface>),
        state: &State,
        parameter: &Parameter,
        reach: [usize; 2],
        watch: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Result<Option<Self>> {
        if watch().is_break() {
            return Ok(None);
        }
        let report = &solution.report;
        let grid = solution.grid();
        let load = report.motion.load.unwrap_or(0.0);
        let area = grid.cell_area();
        Ok(Some(match parameter {
            Parameter::Body(member, one, _) => {
                let body = match member {
                    Member::Body => Some(&report.body),
                    Member::Counterbody => report.counterbody.as_ref(),
                };
                let body = layered(
                    body.ok_or_else(|| unknown(parameter))?,
                    &parameter.to_string(),
                )?;
                Self::of_body(solution, state, &ResponseSlope::new(&body, *one), reach)?
            }
            Parameter::Shape(name) => {
                let shape = shape.ok_or_else(|| unknown(parameter))?;
                let slopes = shape.gap_derivative(name, grid)?;
                Self {
                    field: block(&slopes, state.tangent.window())
                        .iter()
                        .copied()
                        .collect(),
                    target: [0.0; 3],
                    source: Source::Gap(slopes),
                }
            }
            Parameter::Load => {
                let mut target = [1.0 / area, 0.0, 0.0];
                for (target, e) in target[1..].iter_mut().zip(report.motion.eccentricity) {
                    *target = e.unwrap_or(0.0) / area;
                }
                Self::of_target(state, target)
            }
            Parameter::Eccentricity(axis) | Parameter::Moment(axis) => {
                let mut target = [0.0; 3];
                target[axis + 1] = match parameter {
                    Parameter::Moment(_) => 1.0 / area,
                    _ => load / area,
                };
                Self::of_target(state, target)
            }
            Parameter::Approach => Self::of_motion(state, [1.0, 0.0, 0.0]),
            Parameter::Tilt(axis) => {
                let mut motion = [0.0; 3];
                motion[axis + 1] = 1.0;
                Self::of_motion(state, motion)
            }
            Parameter::Friction => Self::of_motion(state, [0.0; 3]),
        }))
    }

    /// K̇ p.
    fn of_body(
        solution: &Solution,
        state: &State,
        slope: &ResponseSlope,
        reach: [usize; 2],
    ) -> Result<Self> {
        let (grid, window) = (solution.grid(), state.tangent.window());
        let convolution = state.tangent.convolution();
        let method = solution.report.method;
        let coefficients = unchecked_coefficients(
            slope,
            &grid.of_offsets(reach),
            method,
            convolution.own_threads(),
        )?;
        let shape = [window[0].len(), window[1].len()];
        let corner = block(&coefficients, &full_window(shape)).to_owned();
        let companion = convolution.companion(&corner, repeating(grid, window));
        let mut field = vec![0.0; state.pressure.len()];
        companion.apply_slices(&state.pressure, &mut field, &mut companion.workspace());
        Ok(Self {
            field,
            target: [0.0; 3],
            source: Source::Coefficients(coefficients),
        })
    }

    fn of_target(state: &State, target: [f64; 3]) -> Self {
        Self {
            field: vec![0.0; state.pressure.len()],
            target,
            source: Source::Motion([0.0; 3]),
        }
    }

    fn of_motion(state: &State, motion: [f64; 3]) -> Self {
        let field = state.moved(motion).iter().map(|moved| -moved).collect();
        Self {
            field,
            target: [0.0; 3],
            source: Source::Motion(motion),
        }
    }

    /// b of a parameter that moves the gap by `slopes` (nx, ny) per unit.
    pub(super) fn of_gap(state: &State, slopes: &Array2<f64>) -> Self {
        Self {
            field: block(slopes, state.tangent.window())
                .iter()
                .copied()
                .collect(),
            target: [0.0; 3],
            source: Source::Gap(slopes.clone()),
        }
    }

    /// K̇ p and b at a cell of the grid, which may lie outside of the window.
    pub(super) fn at(&self, solution: &Solution, state: &State, cell: [usize; 2]) -> [f64; 2] {
        match &self.source {
            Source::Coefficients(coefficients) => {
                let entry = |other: [usize; 2]| {
                    let [i, j] = [0, 1].map(|axis| cell[axis].abs_diff(other[axis]));
                    coefficients[[i, j]]
                };
                let sum = state.sum_over_contact(entry);
                [sum, sum]
            }
            Source::Gap(slopes) => [0.0, slopes[cell]],
            Source::Motion([delta, sx, sy]) => {
                let (x, y) = (solution.grid().x()[cell[0]], solution.grid().y()[cell[1]]);
                [0.0, -(delta + sx * x + sy * y)]
            }
        }
    }
}

fn unknown(parameter: &Parameter) -> Error {
    Error::NotDifferentiable {
        what: parameter.to_string(),
        reason: "it is not a number of this contact",
    }
}
