//! The parameters of a contact, by name.

use std::fmt;

use ndarray::Array2;

use super::state::Linearised;
use crate::compliance::influence::{Method, unchecked_coefficients};
use crate::compliance::response::{Body, ResponseSlope};
use crate::contact::{Solution, block};
use crate::error::{Error, Result};
use crate::model::body::{BodyParameter, HalfSpace};
use crate::model::grid::{Axis, full_window, repeating};
use crate::model::surface::Surface;
use crate::stress::Member;

/// One number that a solved contact depends on.
///
/// Its text is its path in a case file: `body.layers[0].material.young`, `counterbody.substrate.poisson`,
/// `shape.radius`, `load`, `eccentricity[0]`, `moment[1]`, `approach`, `tilt[0]`.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Parameter {
    /// A number of one of the bodies: a modulus, Poisson's ratio or a thickness.
    Body(Member, BodyParameter, String),
    /// A number of the shape, as [`Surface::parameters`] names it.
    Shape(String),
    /// The load W.
    Load,
    /// The eccentricity of the load along x or y.
    Eccentricity(Axis),
    /// The prescribed moment Σ p x dA or Σ p y dA.
    Moment(Axis),
    /// The prescribed approach.
    Approach,
    /// The prescribed slope along x or y.
    Tilt(Axis),
    /// The coefficient of friction of the stress that is the output.
    Friction,
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Body(Member::Body, _, path) => write!(f, "body.{path}"),
            Self::Body(Member::Counterbody, _, path) => write!(f, "counterbody.{path}"),
            Self::Shape(name) => write!(f, "shape.{name}"),
            Self::Load => f.write_str("load"),
            Self::Eccentricity(axis) => write!(f, "eccentricity[{}]", axis.index()),
            Self::Moment(axis) => write!(f, "moment[{}]", axis.index()),
            Self::Approach => f.write_str("approach"),
            Self::Tilt(axis) => write!(f, "tilt[{}]", axis.index()),
            Self::Friction => f.write_str("friction"),
        }
    }
}

/// Why the layers of a body with free ends have no derivatives.
const ENDS: &str = "the correction for free ends is tabulated for the body as it is; leave the ends out, or take \
                    differences of solves";

/// The half-space of a body whose numbers have derivatives.
fn layered(body: &Body, path: &str) -> Result<HalfSpace> {
    let refused = |reason| Error::no_derivative(path, reason);
    let body = body.half_space().ok_or_else(|| {
        refused("the body is a response alone, whose numbers are not known; give a HalfSpace")
    })?;
    match body.ends() {
        [None, None] => Ok(body.clone()),
        _ => Err(refused(ENDS)),
    }
}

/// All parameters of `solution` with respect to which outputs have derivatives; those of the shape if it is given.
pub(super) fn all(solution: &Solution, shape: Option<&dyn Surface>) -> Vec<Parameter> {
    let report = &solution.report;
    let bodies =
        [(Member::Body, Some(&report.body)), (Member::Counterbody, report.counterbody.as_ref())];
    let mut parameters = Vec::new();
    for (member, body) in bodies {
        let body = body.filter(|_| solution.coefficients.is_none());
        let Some(Ok(body)) = body.map(|body| layered(body, "")) else {
            continue;
        };
        let named = |number: BodyParameter| Parameter::Body(member, number, number.path(&body));
        parameters.extend(body.parameters().into_iter().map(named));
    }
    if let Some(shape) = shape {
        let names = shape.parameters().into_iter();
        parameters.extend(names.map(|(name, _)| Parameter::Shape(name)));
    }
    let motion = &report.motion;
    parameters.push(match motion.load {
        Some(_) => Parameter::Load,
        None => Parameter::Approach,
    });
    let grid = solution.grid();
    for direction in Axis::ALL {
        let axis = direction.index();
        // A line contact has no tilt along its strips.
        let tilts = !(grid.is_periodic()[axis] || grid.is_line() && axis == 0);
        match (motion.eccentricity[axis], motion.moment[axis]) {
            (Some(_), _) => parameters.push(Parameter::Eccentricity(direction)),
            (_, Some(_)) => parameters.push(Parameter::Moment(direction)),
            _ if tilts => parameters.push(Parameter::Tilt(direction)),
            _ => {}
        }
    }
    parameters
}

/// The parameters of `solution` among `known` with these paths.
pub(super) fn named(
    solution: &Solution,
    known: &[Parameter],
    paths: &[&str],
) -> Result<Vec<Parameter>> {
    let find = |path: &&str| {
        let parameter = known.iter().find(|parameter| parameter.to_string() == **path);
        parameter.cloned().ok_or_else(|| refusal(solution, path, known))
    };
    paths.iter().map(find).collect()
}

/// The error for a path without a derivative.
fn refusal(solution: &Solution, path: &str, known: &[Parameter]) -> Error {
    let of_body = path.starts_with("body.") || path.starts_with("counterbody.");
    let reason = match path {
        "shape.length" | "shape.profile.length" => {
            "cells join and leave where a shape is cut off, one by one; take the drop of its profile near the end"
        }
        _ if path.starts_with("shape.")
            && !known.iter().any(|parameter| matches!(parameter, Parameter::Shape(_))) =>
        {
            "the shape is not given, or has no number on which the gap depends smoothly (a flat punch's radius moves \
             whole cells); give `shape`, or use the derivative with respect to the gap itself, gradient.gap"
        }
        _ if of_body && solution.coefficients.is_some() => {
            "the contact was given influence coefficients, which do not change with its bodies; leave out `coefficients`"
        }
        _ if of_body => "it is not a number of a stack of layers without free ends",
        _ => "it is not a number of this contact",
    };
    Error::no_derivative(path, reason)
}

/// b = K̇ p + ḣ − B_q ṡ_q and Ḟ/dA of one parameter.
pub(super) struct Slope {
    /// b in the window.
    pub(super) field: Vec<f64>,
    /// Ḟ/dA of the three freedoms; 0 where they are prescribed.
    pub(super) target: [f64; 3],
    source: SlopeSource,
}

/// What b is made of outside of the window.
enum SlopeSource {
    /// Coefficients of K̇.
    Coefficients(Array2<f64>),
    /// ḣ on the whole grid.
    Gap(Array2<f64>),
    /// ṡ
    Motion([f64; 3]),
}

impl Slope {
    /// The slope with respect to `parameter`, for [`Slope::at`] at cells within `reach` offsets.
    pub(super) fn new(
        solution: &Solution,
        shape: Option<&dyn Surface>,
        state: &Linearised,
        parameter: &Parameter,
        reach: [usize; 2],
    ) -> Result<Self> {
        let report = &solution.report;
        let grid = solution.grid();
        let load = report.motion.load.unwrap_or(0.0);
        let area = grid.cell_area();
        Ok(match parameter {
            Parameter::Body(member, one, _) => {
                let body = match member {
                    Member::Body => Some(&report.body),
                    Member::Counterbody => report.counterbody.as_ref(),
                };
                let body =
                    layered(body.ok_or_else(|| unknown(parameter))?, &parameter.to_string())?;
                Self::of_body(solution, state, &ResponseSlope::new(&body, *one), reach)?
            }
            Parameter::Shape(name) => {
                let shape = shape.ok_or_else(|| unknown(parameter))?;
                Self::of_gap(state, shape.gap_derivative(name, grid)?)
            }
            Parameter::Load => {
                let mut target = [1.0 / area, 0.0, 0.0];
                for (target, e) in target[1..].iter_mut().zip(report.motion.eccentricity) {
                    *target = e.unwrap_or(0.0) / area;
                }
                Self::of_target(state, target)
            }
            Parameter::Eccentricity(axis) | Parameter::Moment(axis) => {
                let moment = match parameter {
                    Parameter::Moment(_) => 1.0,
                    _ => load,
                };
                Self::of_target(state, unit(axis.index() + 1).map(|of| of * moment / area))
            }
            Parameter::Approach => Self::of_motion(state, unit(0)),
            Parameter::Tilt(axis) => Self::of_motion(state, unit(axis.index() + 1)),
            Parameter::Friction => Self::of_motion(state, [0.0; 3]),
        })
    }

    /// K̇ p.
    fn of_body(
        solution: &Solution,
        state: &Linearised,
        slope: &ResponseSlope,
        reach: [usize; 2],
    ) -> Result<Self> {
        let (grid, window) = (solution.grid(), &state.tangent.window);
        let convolution = &state.tangent.convolution;
        let threads = convolution.own_threads();
        let coefficients =
            unchecked_coefficients(slope, &grid.of_offsets(reach), Method::Exact, threads)?;
        let shape = [window[0].len(), window[1].len()];
        let corner = block(&coefficients, &full_window(shape)).to_owned();
        let companion = convolution.companion(&corner, repeating(grid, window));
        let mut field = vec![0.0; state.pressure.len()];
        companion.apply_slices(&state.pressure, &mut field, &mut companion.workspace());
        Ok(Self { field, target: [0.0; 3], source: SlopeSource::Coefficients(coefficients) })
    }

    fn of_target(state: &Linearised, target: [f64; 3]) -> Self {
        Self {
            field: vec![0.0; state.pressure.len()],
            target,
            source: SlopeSource::Motion([0.0; 3]),
        }
    }

    fn of_motion(state: &Linearised, motion: [f64; 3]) -> Self {
        let field = state.moved(motion).iter().map(|moved| -moved).collect();
        Self { field, target: [0.0; 3], source: SlopeSource::Motion(motion) }
    }

    /// b of a parameter that moves the gap by `slopes` (nx, ny) per unit.
    pub(super) fn of_gap(state: &Linearised, slopes: Array2<f64>) -> Self {
        let field = block(&slopes, &state.tangent.window);
        Self {
            field: field.iter().copied().collect(),
            target: [0.0; 3],
            source: SlopeSource::Gap(slopes),
        }
    }

    /// K̇ p and b at a cell of the grid, which may lie outside of the window.
    pub(super) fn at(&self, solution: &Solution, state: &Linearised, cell: [usize; 2]) -> [f64; 2] {
        match &self.source {
            SlopeSource::Coefficients(coefficients) => {
                let entry = |other: [usize; 2]| {
                    let [i, j] = [0, 1].map(|axis| cell[axis].abs_diff(other[axis]));
                    coefficients[[i, j]]
                };
                let sum = state.sum_over_contact(entry);
                [sum, sum]
            }
            SlopeSource::Gap(slopes) => [0.0, slopes[cell]],
            SlopeSource::Motion([delta, sx, sy]) => {
                let (x, y) = (solution.grid().x()[cell[0]], solution.grid().y()[cell[1]]);
                [0.0, -(delta + sx * x + sy * y)]
            }
        }
    }
}

/// A unit of one of the three degrees of freedom.
fn unit(freedom: usize) -> [f64; 3] {
    let mut unit = [0.0; 3];
    unit[freedom] = 1.0;
    unit
}

fn unknown(parameter: &Parameter) -> Error {
    Error::no_derivative(parameter.to_string(), "it is not a number of this contact")
}
