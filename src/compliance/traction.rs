//! Tangential influence coefficients: what tractions and pressure do to the surface along x and y.
//!
//! With the compliances of [`crate::compliance::response`], φ the direction of the wave vector, S, D = (c22 ± c_t)/2,
//!
//! ```text
//! û_x = (S + D cos 2φ) q̂_x + D sin 2φ q̂_y + i cos φ c12 p̂
//! û_y = D sin 2φ q̂_x + (S − D cos 2φ) q̂_y + i sin φ c12 p̂
//! û_z = −i cos φ c12 q̂_x − i sin φ c12 q̂_y + c11 p̂
//! ```
//!
//! q acts on the body, −q on the counterbody, p on both. The displacement of the body relative to the counterbody
//! has the sums of c22 and c_t of both, and the difference of c12, as the gap has. Coefficients are exact, as those
//! of stresses are ([`mod@crate::stress`]).
//!
//! | file | what |
//! |---|---|
//! | `coefficients` | coefficients of one body, and of a pair |
//! | `convolution` | tractions to displacements, by FFT |

/// What friction asks of bodies.
pub(crate) const GO_ON: &str =
    "friction needs bodies that go on along x: what tractions do near free ends is not known";

mod coefficients;
mod convolution;

pub use coefficients::{TractionCoefficients, traction_coefficients};
pub(crate) use convolution::{Tangential, TangentialWindow};
