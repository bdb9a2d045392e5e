//! The response of the bodies at the nodes of a quadrature.

use crate::error::{Error, Result, positive};
use crate::kernel::quadrature::Rule;
use crate::response::Body;

/// Wavenumber, in inverse top layers, from which on the response is that of the top layer: e^{−28} is left of the rest.
const TAIL: f64 = 14.0;

/// Halvings of the first uniform panel towards wavenumber 0.
const HALVINGS: i32 = 26;

/// Nodes of a panel.
const NODES: usize = 8;

/// Panels of the quadrature at most.
const MOST_PANELS: f64 = 1e5;

/// Bodies that are indented, planned once for all contact radii up to a largest.
///
/// ```
/// use nacre::indent::{Stack, Tip};
/// use nacre::{Elastic, HalfSpace, Layer};
/// let (soft, hard) = (Elastic::new(1.0, 0.3)?, Elastic::new(4.0, 0.3)?);
/// let body = HalfSpace::new(soft, [Layer::new(hard, 1.0)?])?;
/// let stack = Stack::plan(&[body.into()], 2.0)?;
/// let point = stack.indent(&Tip::Paraboloid(10.0))?.at_radius(0.5)?;
/// assert!(point.load > 0.0 && point.approach > 0.0);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Stack {
    /// E* of the bodies at short wavelengths \[Pa\].
    pub(super) modulus: f64,
    /// Wavenumbers α, and weights times M(α); none where the response does not depend on the wavelength.
    pub(super) waves: Vec<[f64; 2]>,
    /// Thickness of the thinnest top layer \[m\]; none without layers.
    pub(super) thickness: Option<f64>,
    /// Largest contact radius \[m\] that the nodes resolve.
    pub(super) largest: f64,
}

impl Stack {
    /// Plans `bodies`, which touch in the contact, for contact radii up to `largest` \[m\].
    ///
    /// # Errors
    /// No bodies, all of them rigid, one with a local compliance, a radius that is not above 0, or more than 1e4 times the
    /// thickness of the top layer.
    pub fn plan(bodies: &[Body], largest: f64) -> Result<Self> {
        positive("largest contact radius", largest)?;
        let short: f64 = bodies.iter().map(|body| body.asymptotes().short).sum();
        if bodies.is_empty() || short <= 0.0 || bodies.iter().any(|body| body.local() > 0.0) {
            return Err(Error::Inconsistent(
                "bodies must be at least one, elastic, and without a local compliance",
            ));
        }
        let tops = bodies
            .iter()
            .filter_map(|body| body.lengths())
            .map(|[top, _]| top);
        let thickness = tops.reduce(f64::min);
        let mut waves = Vec::new();
        if let Some(h) = thickness {
            let first = (0.5 / h).min(1.5 / largest);
            let panels = (TAIL / h / first).ceil();
            if panels > MOST_PANELS || largest > 1e4 * h {
                return Err(Error::Parameter {
                    name: "largest contact radius",
                    requirement: "at most 1e4 times the thickness of the top layer",
                    value: largest,
                });
            }
            let rule = Rule::gauss_legendre(NODES);
            let mut add = |low: f64, high: f64| {
                for (alpha, weight) in rule.nodes(0.5 * (low + high), 0.5 * (high - low)) {
                    let response: f64 = bodies.iter().map(|body| body.normal(alpha)).sum();
                    waves.push([alpha, weight * (response / short - 1.0)]);
                }
            };
            add(0.0, first * 2.0_f64.powi(-HALVINGS));
            for k in (0..HALVINGS).rev() {
                add(first * 2.0_f64.powi(-k - 1), first * 2.0_f64.powi(-k));
            }
            for k in 1..panels as usize {
                add(first * k as f64, first * (k + 1) as f64);
            }
        }
        Ok(Self {
            modulus: 2.0 / short,
            waves,
            thickness,
            largest,
        })
    }

    /// Contact modulus E* of the bodies at their surfaces \[Pa\].
    pub fn surface_modulus(&self) -> f64 {
        self.modulus
    }
}
