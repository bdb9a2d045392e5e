//! Stress and displacement of the body that goes on along x and y.

mod coefficients;
mod plan;
mod plane;
mod points;
mod repeats;
mod tractions;

pub(super) use coefficients::{SurfaceLoad, components};
pub(super) use plan::{Form, HalfSpacePlan, MAGNITUDES, Source};
pub(super) use plane::PlaneEvaluator;
pub(super) use points::PointEvaluator;
pub(super) use tractions::{TractionPlanes, TractionPoints, Tractions};
