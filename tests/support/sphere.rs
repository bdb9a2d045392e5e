//! A paraboloid on a coated body, in the scales of the Hertzian contact of a reference material.

use nacre::{Grid, HalfSpace, Method, Motion, Options, Paraboloid, Result, Solution, hertz};

use crate::support::settings::{converged, converted, plan};

/// Peak pressure, approach and contact radius, each divided by its Hertzian scale.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measures {
    pub(crate) peak: f64,
    pub(crate) approach: f64,
    pub(crate) radius: f64,
}

impl Measures {
    /// Relative errors of these numbers compared with `exact`.
    pub(crate) fn errors(self, exact: Self) -> Self {
        Self {
            peak: self.peak / exact.peak - 1.0,
            approach: self.approach / exact.approach - 1.0,
            radius: self.radius / exact.radius - 1.0,
        }
    }

    /// Richardson extrapolation of these numbers and those on cells of half the size, for errors of
    /// second order.
    pub(crate) fn extrapolated(self, finer: Self) -> Self {
        let limit = |coarse: f64, fine: f64| (4.0 * fine - coarse) / 3.0;
        Self {
            peak: limit(self.peak, finer.peak),
            approach: limit(self.approach, finer.approach),
            radius: limit(self.radius, finer.radius),
        }
    }
}

/// A solved contact on n² cells over a side of 6, in units in which the Hertzian contact of the reference
/// material (`modulus` E*) has a radius of 1.
pub(crate) fn solve(body: &HalfSpace, modulus: f64, n: usize, method: Method) -> Result<Solution> {
    let grid = Grid::new([n; 2], [6.0; 2])?;
    let contact = match method {
        Method::Exact => plan(body, grid)?,
        _ => converted(body, grid, method)?,
    };
    let (shape, motion) = (Paraboloid::new(RADIUS, RADIUS)?, Motion::load(load(modulus)));
    converged(&contact, &shape, &motion, &Options::default())
}

/// Radius of the paraboloid, far larger than the contact radius.
const RADIUS: f64 = 100.0;

fn load(modulus: f64) -> f64 {
    4.0 * modulus / (3.0 * RADIUS)
}

/// Numbers of a solution, divided by the scales of the reference material.
pub(crate) fn measures(solution: &Solution, modulus: f64) -> Result<Measures> {
    let scale = hertz::Point::new(RADIUS, modulus, load(modulus))?;
    let [x, y] = solution.contact_extent().map(|[low, high]| 0.5 * (high - low));
    Ok(Measures {
        peak: solution.peak_pressure() / scale.peak_pressure,
        approach: solution.approach / scale.approach,
        radius: 0.5 * (x + y) / scale.radius,
    })
}
