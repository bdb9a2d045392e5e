//! What a body must tell so that coefficients, convolution and contact can work with it.

use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use crate::body::HalfSpace;
use crate::material::Elastic;

use super::{Asymptotes, alpha_compliance, asymptotes};

/// The normal frequency response of a body: surface displacement per pressure of the same wavenumber.
///
/// [`HalfSpace`] implements it. A body of another kind (transversely isotropic, an elastic foundation)
/// needs nothing else to go through influence coefficients, convolution and contact.
pub trait Response: fmt::Debug + Send + Sync {
    /// α û_z/p̂ \[1/Pa\] at wavenumber α > 0 \[1/m\], without the local term.
    fn normal(&self, wavenumber: f64) -> f64;

    /// Limits of the response at long and at short wavelengths.
    fn asymptotes(&self) -> Asymptotes;

    /// Shortest and longest length \[m\] of the body itself, between whose inverses the response changes;
    /// `None` where α û_z/p̂ is the same at every wavenumber.
    fn lengths(&self) -> Option<[f64; 2]>;

    /// Local compliance \[m/Pa\]: displacement of a point per pressure on that point, as Winkler's
    /// springs have it. It comes on top of [`Response::normal`]. Default: 0.
    fn local(&self) -> f64 {
        0.0
    }

    /// The stack of layers that the body is, where it is one; stresses need it. Default: `None`.
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

/// Stacks of layers are equal where their layers are; others where they are the same object.
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
