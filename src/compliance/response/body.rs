//! Bodies as their responses: the trait that a body of any kind implements, and the body itself.

use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use super::{Asymptotes, alpha_compliance, asymptotes};
use crate::error::{Error, Result, finite, positive};
use crate::model::body::HalfSpace;
use crate::model::material::Elastic;

/// Normal frequency response of a body: surface displacement per pressure of the same wavenumber.
///
/// [`HalfSpace`] implements it. A body of another kind (an elastic foundation, a membrane, a
/// transversely isotropic half-space) needs nothing else to go through influence coefficients,
/// convolution and contact. It must be the same in all directions of the surface: û_z/p̂ depends on
/// α = √(m² + n²) alone.
///
/// # What to implement
///
/// - [`normal`](Self::normal): α û_z/p̂, accurate to rounding, since the coefficients are as accurate
///   as it is. The factor α keeps it finite for a body that is a half-space far down.
/// - [`asymptotes`](Self::asymptotes): its limits. The exact method takes them in closed form and
///   transforms what is left, which must vanish for long and for short waves, about as α^{±1/2} or
///   faster; a response that does not is refused. What is left is sampled evenly in ln α, at up to 320
///   points per unit; where that does not resolve a resonance, `CellInfluence::error` says so.
/// - [`lengths`](Self::lengths): between which wavelengths (over 2π) the response leaves one limit for the
///   other. They tell where to look, to a factor of ten or so.
/// - [`local`](Self::local): a part of u/p that does not depend on α (Winkler's springs, asperities).
///   It stays out of the other three, because its α û_z/p̂ grows without limit.
///
/// A line contact measures its displacement from a datum where `asymptotes().long` is above 0;
/// otherwise the displacement vanishes far away by itself. The conversions by inverse FFT use the
/// same limits. Stresses need the layers of a [`HalfSpace`].
///
/// # Example
///
/// Pasternak's foundation, springs of stiffness k \[Pa/m\] joined by a shear layer G \[N/m\]:
/// p = k w − G ∇²w, or û_z/p̂ = 1/(k + Gα²).
///
/// ```
/// use nacre::response::{Asymptotes, Response};
/// use nacre::{Contact, Grid, Motion, Options, Paraboloid, Setup};
///
/// #[derive(Debug)]
/// struct Pasternak {
///     k: f64,
///     g: f64,
/// }
///
/// impl Response for Pasternak {
///     fn normal(&self, alpha: f64) -> f64 {
///         alpha / (self.k + self.g * alpha * alpha)
///     }
///     fn asymptotes(&self) -> Asymptotes {
///         // α û/p̂ vanishes at both ends; long waves meet the springs alone.
///         Asymptotes { long: 0.0, constant: 1.0 / self.k, short: 0.0 }
///     }
///     fn lengths(&self) -> Option<[f64; 2]> {
///         Some([(self.g / self.k).sqrt(); 2])
///     }
/// }
///
/// let contact = Contact::plan(Pasternak { k: 1.0, g: 1.0 }, Grid::new([64, 64], [4.0, 4.0])?, Setup::default())?;
/// let ball = Paraboloid::new(10.0, 10.0)?;
/// let solution = contact.solve(&ball, &Motion::approach(0.1), &Options::default())?;
/// // Below the middle p = k δ + 2G/R.
/// assert!((solution.central_pressure() / 0.3 - 1.0).abs() < 0.01);
/// # Ok::<(), nacre::Error>(())
/// ```
pub trait Response: fmt::Debug + Send + Sync {
    /// α û_z/p̂ \[1/Pa\] at wavenumber α > 0 \[1/m\], finite and at least 0, without the local
    /// compliance.
    fn normal(&self, wavenumber: f64) -> f64;

    /// Limits of [`Response::normal`] at long and at short wavelengths.
    fn asymptotes(&self) -> Asymptotes;

    /// Shortest and longest length \[m\] of the body itself, between whose inverses the response
    /// changes; `None` where [`Response::normal`] is the same at every wavenumber.
    fn lengths(&self) -> Option<[f64; 2]>;

    /// Local compliance \[m/Pa\]: displacement of a point per pressure on that point, as Winkler's
    /// springs have it. It adds to the displacement of the rest of the body. Default: 0.
    fn local(&self) -> f64 {
        0.0
    }

    /// The half-space with layers, if the body is one; stresses need it. Default: `None`.
    fn half_space(&self) -> Option<&HalfSpace> {
        None
    }
}

impl Response for HalfSpace {
    fn normal(&self, wavenumber: f64) -> f64 {
        alpha_compliance(self, wavenumber).c11
    }

    fn asymptotes(&self) -> Asymptotes {
        asymptotes(self)
    }

    fn lengths(&self) -> Option<[f64; 2]> {
        let top = self.layers().first()?.thickness();
        Some([top, self.thickness()])
    }

    fn half_space(&self) -> Option<&HalfSpace> {
        Some(self)
    }
}

/// A body of any kind, shared by whatever was planned with it.
#[derive(Clone)]
pub struct Body(Arc<dyn Response>);

impl Body {
    /// The body with this `response`.
    pub fn new(response: impl Response + 'static) -> Self {
        Self(Arc::new(response))
    }
}

impl Deref for Body {
    type Target = dyn Response;

    fn deref(&self) -> &Self::Target {
        &*self.0
    }
}

impl fmt::Debug for Body {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// Half-spaces are equal if their layers and substrates are; other bodies if they are the same object.
impl PartialEq for Body {
    fn eq(&self, other: &Self) -> bool {
        match (self.half_space(), other.half_space()) {
            (Some(a), Some(b)) => a == b,
            (None, None) => Arc::ptr_eq(&self.0, &other.0),
            _ => false,
        }
    }
}

impl<R: Response + 'static> From<R> for Body {
    fn from(response: R) -> Self {
        Self::new(response)
    }
}

impl From<&HalfSpace> for Body {
    fn from(body: &HalfSpace) -> Self {
        Self::new(body.clone())
    }
}

impl From<&Body> for Body {
    fn from(body: &Body) -> Self {
        body.clone()
    }
}

impl From<Elastic> for Body {
    fn from(material: Elastic) -> Self {
        Self::new(HalfSpace::from(material))
    }
}

impl From<&Elastic> for Body {
    fn from(material: &Elastic) -> Self {
        (*material).into()
    }
}

/// Checks what a response says of itself, where that costs little.
///
/// # Errors
/// Limits that are not finite or below 0, lengths that are not above 0 or out of order, a local
/// compliance below 0; limits that differ where there are no lengths.
pub(crate) fn check(body: &dyn Response) -> Result<()> {
    let Asymptotes { long, constant, short } = body.asymptotes();
    not_negative("asymptotes().long", long)?;
    not_negative("asymptotes().short", short)?;
    finite("asymptotes().constant", constant)?;
    not_negative("local()", body.local())?;
    let Some([shortest, longest]) = body.lengths() else {
        // Not `==`, which the lints keep for bits.
        if (long - short).abs() > 0.0 || constant.abs() > 0.0 {
            return Err(Error::Inconsistent(
                "lengths() must be given for a body whose asymptotes() differ or have a constant",
            ));
        }
        return Ok(());
    };
    positive("lengths()[0]", shortest)?;
    if !(longest >= shortest && longest.is_finite()) {
        return Err(Error::Parameter {
            name: "lengths()[1]",
            requirement: "finite and at least lengths()[0]",
            value: longest,
        });
    }
    not_negative("normal(1 / lengths()[0])", body.normal(1.0 / shortest))?;
    not_negative("normal(1 / lengths()[1])", body.normal(1.0 / longest))
}

fn not_negative(name: &'static str, value: f64) -> Result<()> {
    if value >= 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(Error::Parameter { name, requirement: "finite and at least 0", value })
}

/// Size of α û_z/p̂ \[1/Pa\] without its sign: the larger of its limits; where both are 0, the largest value at octaves
/// between the body's lengths.
pub(crate) fn size(body: &dyn Response) -> f64 {
    let limits = body.asymptotes();
    let larger = limits.short.abs().max(limits.long.abs());
    match body.lengths() {
        Some([shortest, longest]) if larger <= 0.0 => {
            let octaves = (longest / shortest).log2().ceil() as i32;
            (0..=octaves)
                .map(|octave| body.normal(f64::from(octave).exp2() / longest).abs())
                .fold(0.0, f64::max)
        }
        _ => larger,
    }
}
