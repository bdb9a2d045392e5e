//! The one error type: bad input, and an iteration that a caller insisted should converge.

/// Short form of `Result` with [`enum@Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// What a caller got wrong, or what this machine cannot do.
///
/// Messages name the argument, what it must be and what it was.
#[derive(Debug, Clone, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number outside its range.
    #[error("{name} must be {requirement}, got {value}")]
    Parameter {
        /// The argument.
        name: &'static str,
        /// What it must be.
        requirement: &'static str,
        /// What it was.
        value: f64,
    },
    /// A word that is not one of the choices.
    #[error("{name} must be {requirement}, got {value:?}")]
    Choice {
        /// The argument.
        name: &'static str,
        /// The choices.
        requirement: &'static str,
        /// What it was.
        value: String,
    },
    /// An array of the wrong shape.
    #[error("{name}: expected shape {expected:?}, got {found:?}")]
    Shape {
        /// The argument.
        name: &'static str,
        /// The shape it must have.
        expected: [usize; 2],
        /// The shape it had.
        found: [usize; 2],
    },
    /// An array of which one element is infinite or not a number.
    #[error("{name} is not finite at {index:?}")]
    NonFinite {
        /// The argument.
        name: &'static str,
        /// Where.
        index: [usize; 2],
    },
    /// Arguments that contradict each other or do not suffice.
    #[error("{0}")]
    Inconsistent(&'static str),
    /// A load point at which no pressure p ≥ 0 can balance the load.
    #[error(
        "the load point ({x:.6e}, {y:.6e}) must lie strictly inside the convex hull of the cells \
         that can touch, x {x_range:?}, y {y_range:?}"
    )]
    LoadPoint {
        /// Eccentricity along x.
        x: f64,
        /// Eccentricity along y.
        y: f64,
        /// Smallest and largest x of the cells that can touch.
        x_range: [f64; 2],
        /// Smallest and largest y of the cells that can touch.
        y_range: [f64; 2],
    },
    /// A moment that no pressure can have.
    #[error(
        "no pressure p >= 0 on the cells that can touch has this moment: moment ({:.6e}, {:.6e}), cells \
         in x {x_range:?}, y {y_range:?}; a moment has the direction of the point where the force acts",
        moment[0],
        moment[1]
    )]
    Moment {
        /// Moments (M_x, M_y) \[N m\] that were asked for; 0 where the tilt is prescribed.
        moment: [f64; 2],
        /// Smallest and largest x of the cells that can touch.
        x_range: [f64; 2],
        /// Smallest and largest y of the cells that can touch.
        y_range: [f64; 2],
    },
    /// More memory than there is.
    #[error(
        "a grid of {shape:?} cells needs about {} MiB, and {} MiB are available; take fewer cells",
        needed >> 20,
        available >> 20
    )]
    Memory {
        /// The grid.
        shape: [usize; 2],
        /// Bytes needed.
        needed: u64,
        /// Bytes that are available.
        available: u64,
    },
    /// The grid that is chosen where none is given was enlarged ten times, and the contact still
    /// reached its edge.
    #[error(
        "no grid found: after {enlargements} enlargements, to {size:?}, the contact still touches \
         the edge; give a grid"
    )]
    NoGrid {
        /// How often it was enlarged.
        enlargements: usize,
        /// Its last size.
        size: [f64; 2],
    },
    /// The iteration ended before its tolerance was met.
    #[error(
        "residual {residual:.2e}, overlap {overlap:.2e} above the tolerance {tolerance:.0e} after \
         {iterations} iterations; raise max_iterations or the tolerance"
    )]
    NotConverged {
        /// Iterations done.
        iterations: usize,
        /// Complementarity reached.
        residual: f64,
        /// Overlap reached.
        overlap: f64,
        /// The tolerance that was asked.
        tolerance: f64,
    },
}

/// `value` if it is finite and above zero.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(Error::Parameter {
            name,
            requirement: "finite and above 0",
            value,
        })
    }
}

/// `value` if it is finite.
pub(crate) fn finite(name: &'static str, value: f64) -> Result<f64> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Error::Parameter {
            name,
            requirement: "finite",
            value,
        })
    }
}
