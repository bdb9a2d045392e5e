//! A body of any kind, as contacts take it.

use std::any::Any;
use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use super::Response;
use super::sampled::Sampled;
use crate::model::body::HalfSpace;
use crate::model::material::Elastic;

/// A body of any kind, shared by whatever was planned with it.
#[derive(Clone)]
pub struct Body(Arc<dyn Response>);

impl Body {
    /// The body with this `response`.
    pub fn new(response: impl Response + 'static) -> Self {
        Self(Arc::new(response))
    }

    /// The samples of the response, if the body is known by them.
    pub fn sampled(&self) -> Option<&Sampled> {
        (&*self.0 as &dyn Any).downcast_ref()
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

/// Half-spaces are equal if their layers and substrates are, sampled bodies if their samples are; others if they are the
/// same object.
impl PartialEq for Body {
    fn eq(&self, other: &Self) -> bool {
        match (self.half_space(), other.half_space()) {
            (Some(a), Some(b)) => a == b,
            (None, None) => {
                let sampled = (self.sampled(), other.sampled());
                Arc::ptr_eq(&self.0, &other.0) || matches!(sampled, (Some(a), Some(b)) if a == b)
            }
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
