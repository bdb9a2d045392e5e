//! The error type of the crate: invalid input, and iterations that did not converge.

/// `Result` with the error type [`enum@Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// Invalid input, a resource that this machine lacks, or an iteration that did not converge.
///
/// Messages name the argument, the requirement and the value that was given.
#[derive(Debug, Clone, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number outside its permitted range.
    #[error("{name} must be {requirement}, got {value}")]
    Parameter {
        /// Name of the argument.
        name: &'static str,
        /// The permitted range, in words.
        requirement: &'static str,
        /// The value that was given.
        value: f64,
    },
    /// A word that is not one of the choices.
    #[error("{name} must be {requirement}, got {value:?}")]
    Choice {
        /// Name of the argument.
        name: &'static str,
        /// The choices.
        requirement: &'static str,
        /// The word that was given.
        value: String,
    },
    /// A quantity without a derivative, or one that is not known.
    #[error("{what} has no derivative: {reason}")]
    NotDifferentiable {
        /// The quantity.
        what: String,
        /// Why, and what to take instead.
        reason: &'static str,
    },
    /// An array of the wrong shape.
    #[error("{name}: expected shape {expected:?}, got {found:?}")]
    Shape {
        /// Name of the argument.
        name: &'static str,
        /// The required shape.
        expected: [usize; 2],
        /// The shape that was given.
        found: [usize; 2],
    },
    /// An array with an element that is infinite or not a number.
    #[error("{name} is not finite at {index:?}")]
    NonFinite {
        /// Name of the argument.
        name: &'static str,
        /// Indices of the first such element.
        index: [usize; 2],
    },
    /// A response that is no compliance.
    #[error(
        "the function of the wavenumber must be finite and at least 0 everywhere, and above 0 somewhere, got {value} at {}",
        plain(*wavenumber)
    )]
    NoCompliance {
        /// Value of the response \[m/Pa\].
        value: f64,
        /// Wavenumber \[1/m\].
        wavenumber: f64,
    },
    /// A response that has no limit at long or at short waves.
    #[error(
        "the function of the wavenumber must settle before {}: at small wavenumbers to c/wavenumber or to a constant, at \
         large ones to c/wavenumber, to a constant or to less", plain(*wavenumber)
    )]
    NoLimit {
        /// Wavenumber \[1/m\] at which the limit was sought.
        wavenumber: f64,
    },
    /// A response of which a constant hides the rest at short waves.
    #[error(
        "the function of the wavenumber ends in a constant, in whose rounding the rest is lost: return the rest, and give \
         the constant as local"
    )]
    HiddenBySprings,
    /// Influence coefficients with which some pressure has an elastic energy below 0.
    #[error(
        "the influence coefficients are not positive definite, so that the contact has no unique solution; \
         leave out coefficients that are given, or take a grid of more cells"
    )]
    Indefinite,
    /// A plate with a free base, where its load has no equilibrium.
    #[error(
        "{what} must not have a free base: nothing carries a net load there, and the approach has no bound; take \
         nacre.RIGID with a spring interface as the substrate, or a grid that is periodic along x and along y, on which \
         a uniform pressure on the free face balances the mean"
    )]
    FreeBase {
        /// The bodies, and what is computed.
        what: &'static str,
    },
    /// Numbers that are too large or too small to be computed with.
    #[error(
        "load, lengths, moduli and friction must be in units in which their products neither overflow nor vanish"
    )]
    Overflow,
    /// Arguments that contradict each other or do not suffice.
    #[error("{0}")]
    Inconsistent(&'static str),
    /// Something that the kind of adhesion does not permit.
    #[error("{0}")]
    Adhesion(&'static str),
    /// A state of an indentation that does not exist.
    #[error("{0}")]
    NoState(&'static str),
    /// A rolling contact that reaches the edge of the grid.
    #[error(
        "in rolling, the contact must end a cell or more before the edge of the grid: give a wider grid"
    )]
    RollsOffGrid,
    /// A contact of a tip that is no disc, which the theory of discs cannot have.
    #[error(
        "the contact of this tip is no disc but a ring here: the pressure of a disc would be negative or the surfaces would \
         overlap; use nacre.solve"
    )]
    Ring,
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
    /// A solution to start from that is on another grid.
    #[error(
        "initial must be a solution on the grid of this contact, {expected}, was one on {found}"
    )]
    OtherGrid {
        /// The grid of the contact, in words.
        expected: String,
        /// The grid of the solution, in words.
        found: String,
    },
    /// A grid that needs more memory than is available.
    #[error(
        "a grid of {shape:?} cells needs about {} MiB, and {} MiB are available; take fewer cells",
        needed >> 20,
        available >> 20
    )]
    Memory {
        /// Numbers of cells of the grid.
        shape: [usize; 2],
        /// Bytes needed.
        needed: u64,
        /// Bytes available.
        available: u64,
    },
    /// No automatic grid was found: it was enlarged as often as permitted, and the contact still
    /// reached its edge.
    #[error(
        "no grid found: after {enlargements} enlargements, to {size:?}, the contact still touches \
         the edge; give a grid"
    )]
    NoGrid {
        /// Number of enlargements.
        enlargements: usize,
        /// Side lengths of the last grid.
        size: [f64; 2],
    },
    /// A free end of a body within a cell.
    #[error(
        "ends must lie on edges of the grid's cells along x, or outside the grid, was {end:e} between the edges \
         {:e} and {:e}", edges[0], edges[1]
    )]
    EndOffGrid {
        /// Coordinate x of the end \[m\].
        end: f64,
        /// Edges of cells next to it \[m\].
        edges: [f64; 2],
    },
    /// Layers with a free end that are thicker than the period of a grid.
    #[error(
        "layers of a body with free ends must be at most as thick as the period of the grid along y, {}, were {}: take a \
         longer period, which holds more than one of the shape's, a grid that does not repeat, or leave out the ends",
        plain(*period), plain(*thickness)
    )]
    ThickEnd {
        /// Thickness of all layers of the body \[m\].
        thickness: f64,
        /// Period along y \[m\].
        period: f64,
    },
    /// A body that ends where the shape that it carries extends beyond it.
    #[error(
        "ends of the counterbody must not lie within the shape that it carries: it ends at x = {end:e}, and the shape \
         at {shape:e}"
    )]
    EndWithinShape {
        /// Coordinate x of the body's end \[m\].
        end: f64,
        /// Coordinate x of the shape's end \[m\].
        shape: f64,
    },
    /// An approach that is prescribed to a line contact whose datum lies too near.
    #[error(
        "approach cannot be prescribed on this grid: it is counted from the bare substrate's surface at \
         {width:.3e} from the load, the grid's width, where stiff layers move the surface less; give a \
         load, or a width of {needed:.3e} or more"
    )]
    Datum {
        /// Width of the grid.
        width: f64,
        /// Width from which on the approach can be prescribed, estimated.
        needed: f64,
    },
    /// A shift or creepage that is prescribed, or kept, in a line contact whose datum lies too near.
    #[error(
        "{motion} cannot be prescribed on this grid: it is counted from the bare substrate's surface at \
         {width:.3e} from the load, the grid's width, where stiff layers move the surface less; give a \
         force, or a width of {needed:.3e} or more"
    )]
    TangentialDatum {
        /// `shift` or `creepage`.
        motion: &'static str,
        /// Width of the grid.
        width: f64,
        /// Width from which on the motion can be prescribed, estimated.
        needed: f64,
    },
    /// A shape that does not repeat with its grid.
    #[error(
        "shape must repeat along {axis} as the grid does: its gap is {:e} at the one end of the period and {:e} at the \
         other; a periodic height map must say so", gaps[0], gaps[1]
    )]
    Seam {
        /// `x` or `y`.
        axis: &'static str,
        /// Gaps at both ends of the period \[m\].
        gaps: [f64; 2],
    },
    /// A shape that repeats on a grid that does not, or with another period.
    #[error(
        "grid must repeat along {axis} as the shape does, with its period {period:e} or a multiple, was {}; a piece of a \
         periodic height map is one that is not periodic", repeats(*grid)
    )]
    Period {
        /// `x` or `y`.
        axis: &'static str,
        /// Period of the shape \[m\].
        period: f64,
        /// Period of the grid \[m\]; `None` where it does not repeat.
        grid: Option<f64>,
    },
    /// An approach to which no pressure belongs.
    #[error(
        "approach must be below {}, the mean gap, on a grid that repeats in both directions, was {}: the \
         approach is that of the mean plane, and stays there while the load of a full contact grows; give a load",
        plain(*most), plain(*approach)
    )]
    FullContact {
        /// The approach \[m\].
        approach: f64,
        /// The approach of full contact \[m\].
        most: f64,
    },
    /// A load above what the surfaces carry at their hardness.
    #[error(
        "load must be below what the hardness can carry on the cells that can touch, {}, was {}: where all of them \
         yield, no approach is determined", plain(*bears), plain(*load)
    )]
    Overload {
        /// The load \[N\].
        load: f64,
        /// Σ H dA over the cells that can touch \[N\].
        bears: f64,
    },
    /// A moment that the surfaces cannot carry at their hardness.
    #[error(
        "moment, or load times eccentricity, along {axis} must be between {} and {}, which the hardness can carry, was \
         {}", plain(range[0]), plain(range[1]), plain(*moment)
    )]
    Overturned {
        /// `x` or `y`.
        axis: &'static str,
        /// The moment about the origin \[N m\].
        moment: f64,
        /// The least and the largest moment \[N m\].
        range: [f64; 2],
    },
    /// A tangential force or torque that friction cannot carry.
    #[error(
        "{name} must be below what friction can carry, {}, was {}: the contact would slide as a whole",
        plain(*bears), plain(*value)
    )]
    FullSlip {
        /// `force` or `torque`.
        name: &'static str,
        /// The force \[N\] or torque \[N m\].
        value: f64,
        /// Σ μp dA \[N\], or Σ μp r dA \[N m\].
        bears: f64,
    },
    /// Work that its caller stopped.
    #[error("the work was stopped before it was complete")]
    Stopped,
    /// An iteration that ended before the tolerance was met.
    #[error(
        "not converged after {iterations} iterations: {}; raise {limit} or the tolerance",
        missed([*residual, *overlap, *balance], *tolerance)
    )]
    NotConverged {
        /// Number of iterations.
        iterations: usize,
        /// Complementarity residual at the end.
        residual: f64,
        /// Relative overlap at the end.
        overlap: f64,
        /// Largest relative error of force and moments.
        balance: f64,
        /// Requested tolerance.
        tolerance: f64,
        /// Option that limits the number of iterations.
        limit: &'static str,
    },
}

impl Error {
    /// A linear iteration that ended with this residual.
    pub(crate) fn not_converged(
        iterations: usize,
        residual: f64,
        tolerance: f64,
        limit: &'static str,
    ) -> Self {
        let (overlap, balance) = (0.0, 0.0);
        Self::NotConverged { iterations, residual, overlap, balance, tolerance, limit }
    }

    /// The refusal of a derivative.
    pub(crate) fn no_derivative(what: impl Into<String>, reason: &'static str) -> Self {
        Self::NotDifferentiable { what: what.into(), reason }
    }
}

/// The period of a grid in words.
fn repeats(period: Option<f64>) -> String {
    period.map_or_else(
        || "a grid that does not repeat there".to_owned(),
        |period| format!("a grid of period {period:e}"),
    )
}

/// Seven digits of a number, without an exponent where it is neither large nor small.
fn plain(value: f64) -> String {
    let rounded: f64 = format!("{value:.6e}").parse().unwrap_or(value);
    match rounded.abs() {
        1e-4..1e6 | 0.0 => rounded.to_string(),
        _ => format!("{rounded:e}"),
    }
}

/// The conditions of convergence that were not met.
fn missed([residual, overlap, balance]: [f64; 3], tolerance: f64) -> String {
    // Errors of force and moments of balanced pressures are below this.
    const BALANCED: f64 = 1e-12;
    let above = [("residual", residual), ("overlap", overlap)];
    let above = above.iter().filter(|(_, value)| *value > tolerance);
    let above: Vec<String> = above.map(|(name, value)| format!("{name} {value:.2e}")).collect();
    let mut missed = Vec::new();
    if !above.is_empty() {
        let above = above.join(", ");
        missed.push(format!("{above} above the tolerance {tolerance:.0e}"));
    }
    if missed.is_empty() || balance > BALANCED {
        missed.push(format!("force and moments in error by {balance:.2e}"));
    }
    missed.join(", ")
}

/// An error with this `message`, of arguments that contradict each other, where they are `wrong`.
pub(crate) fn refuse_if(wrong: bool, message: &'static str) -> Result<()> {
    if wrong { Err(Error::Inconsistent(message)) } else { Ok(()) }
}

/// Returns `value`, or an error with the `requirement` unless it `holds`.
pub(crate) fn require(
    name: &'static str,
    value: f64,
    holds: bool,
    requirement: &'static str,
) -> Result<f64> {
    match holds {
        true => Ok(value),
        false => Err(Error::Parameter { name, requirement, value }),
    }
}

/// Returns `value`, or an error unless it is finite and above 0.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64> {
    let holds = value > 0.0 && value.is_finite();
    require(name, value, holds, "finite and above 0")
}

/// Returns `value`, or an error unless it is finite and at least 0.
pub(crate) fn not_negative(name: &'static str, value: f64) -> Result<f64> {
    let holds = value >= 0.0 && value.is_finite();
    require(name, value, holds, "finite and at least 0")
}

/// Returns `value`, or an error unless it is finite.
pub(crate) fn finite(name: &'static str, value: f64) -> Result<f64> {
    require(name, value, value.is_finite(), "finite")
}

/// Returns `value`, or an error unless it is above 0 and below 1.
pub(crate) fn fraction(name: &'static str, value: f64) -> Result<f64> {
    require(name, value, value > 0.0 && value < 1.0, "above 0 and below 1")
}

/// An error unless an array has the shape of its grid.
pub(crate) fn same_shape<T>(
    name: &'static str,
    array: &ndarray::ArrayRef2<T>,
    expected: [usize; 2],
) -> Result<()> {
    match array.dim().into() {
        shape if shape == expected => Ok(()),
        shape => Err(Error::Shape { name, expected, found: shape }),
    }
}

/// An error unless all elements of an array are finite.
pub(crate) fn all_finite(name: &'static str, array: &ndarray::ArrayRef2<f64>) -> Result<()> {
    match array.indexed_iter().find(|(_, value)| !value.is_finite()) {
        Some((index, _)) => Err(Error::NonFinite { name, index: index.into() }),
        None => Ok(()),
    }
}

/// An error unless all elements of an array are finite and at least 0.
pub(crate) fn none_negative(name: &'static str, array: &ndarray::ArrayRef2<f64>) -> Result<()> {
    all_finite(name, array)?;
    match array.iter().find(|value| **value < 0.0) {
        Some(&value) => Err(Error::Parameter { name, requirement: "at least 0 everywhere", value }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::missed;

    /// The message names the conditions that were not met, and no others.
    #[test]
    fn conditions_that_were_not_met() {
        for (errors, expected) in [
            ([2e-6, 1e-9, 1e-15], "residual 2.00e-6 above the tolerance 1e-8"),
            ([2e-6, 3e-3, 1e-15], "residual 2.00e-6, overlap 3.00e-3 above the tolerance 1e-8"),
            ([7e-17, 0.0, 4e-10], "force and moments in error by 4.00e-10"),
            ([7e-17, 0.0, 4e-13], "force and moments in error by 4.00e-13"),
            (
                [0.0, 1e-4, 3e-2],
                "overlap 1.00e-4 above the tolerance 1e-8, force and moments in error by 3.00e-2",
            ),
        ] {
            assert_eq!(missed(errors, 1e-8), expected);
        }
    }
}
