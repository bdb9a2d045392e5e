//! The parameters of a contact, by name.

use std::fmt;

use crate::compliance::response::Body;
use crate::contact::Solution;
use crate::error::{Error, Result};
use crate::model::body::{BodyParameter, HalfSpace};
use crate::model::surface::Surface;
use crate::stress::Member;

/// One number that a solved contact depends on.
///
/// Its text is its path in a case file: `body.layers[0].material.young`, `counterbody.substrate.poisson`,
/// `shape.radius`, `load`, `eccentricity[0]`, `moment[1]`, `approach`, `tilt[0]`.
#[derive(Debug, Clone, PartialEq)]
pub enum Parameter {
    /// A number of one of the bodies: a modulus, Poisson's ratio or a thickness.
    Body(Member, BodyParameter, String),
    /// A number of the shape, as [`Surface::parameters`] names it.
    Shape(String),
    /// The load W.
    Load,
    /// The eccentricity of the load along x or y.
    Eccentricity(usize),
    /// The prescribed moment Σ p x dA or Σ p y dA.
    Moment(usize),
    /// The prescribed approach.
    Approach,
    /// The prescribed slope along x or y.
    Tilt(usize),
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
            Self::Eccentricity(axis) => write!(f, "eccentricity[{axis}]"),
            Self::Moment(axis) => write!(f, "moment[{axis}]"),
            Self::Approach => f.write_str("approach"),
            Self::Tilt(axis) => write!(f, "tilt[{axis}]"),
            Self::Friction => f.write_str("friction"),
        }
    }
}

/// Why the layers of a body with free ends have no derivatives.
const ENDS: &str = "the correction for free ends is tabulated for the body as it is; leave the ends out, or take \
                    differences of solves";

/// The half-space of a body whose numbers have derivatives.
///
/// # Errors
/// A body that is a response alone, or has free ends.
pub(super) fn layered(body: &Body, path: &str) -> Result<HalfSpace> {
    let refused = |reason| Error::NotDifferentiable {
        what: path.to_owned(),
        reason,
    };
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
    let bodies = [
        (Member::Body, Some(&report.body)),
        (Member::Counterbody, report.counterbody.as_ref()),
    ];
    let mut parameters = Vec::new();
    for (member, body) in bodies {
        let Some(Ok(body)) = body.map(|body| layered(body, "")) else {
            continue;
        };
        let named = |one: BodyParameter| Parameter::Body(member, one, one.path(&body));
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
    for axis in 0..2 {
        // A line contact has no tilt along its strips.
        let tilts = !(grid.is_periodic()[axis] || grid.is_line() && axis == 0);
        match (motion.eccentricity[axis], motion.moment[axis]) {
            (Some(_), _) => parameters.push(Parameter::Eccentricity(axis)),
            (_, Some(_)) => parameters.push(Parameter::Moment(axis)),
            _ if tilts => parameters.push(Parameter::Tilt(axis)),
            _ => {}
        }
    }
    parameters
}

/// The parameters among `known` with these paths.
///
/// # Errors
/// A path that is not among them.
pub(super) fn named(known: &[Parameter], paths: &[&str]) -> Result<Vec<Parameter>> {
    let find = |path: &&str| {
        let found = known.iter().find(|one| one.to_string() == **path);
        found.cloned().ok_or_else(|| refusal(path, known))
    };
    paths.iter().map(find).collect()
}

/// The error for a path without a derivative.
fn refusal(path: &str, known: &[Parameter]) -> Error {
    let reason = match path {
        "shape.length" | "shape.profile.length" => {
            "cells join and leave where a shape is cut off, one by one; take the drop of its profile near the end"
        }
        _ if path.starts_with("shape.")
            && !known.iter().any(|one| matches!(one, Parameter::Shape(_))) =>
        {
            "the shape is not given, or has no number on which the gap depends smoothly (a flat punch's radius moves \
             whole cells); give `shape`, or use the derivative with respect to the gap itself, gradient.gap"
        }
        _ if path.starts_with("body.") || path.starts_with("counterbody.") => {
            "it is not a number of a stack of layers without free ends"
        }
        _ => "it is not a number of this contact",
    };
    Error::NotDifferentiable {
        what: path.to_owned(),
        reason,
    }
}
