//! The response of the bodies, planned for contacts of any radius.

use std::sync::{Arc, OnceLock};

use super::super::tip::TipParameter;
use super::basis::Waves;
use crate::compliance::response::{Body, asymptote_derivatives, normal_derivatives, refuse_free};
use crate::error::{Result, refuse_if};
use crate::model::body::BodyParameter;
use crate::numerics::rounding;

/// Contact radius, in thicknesses of the thinnest top layer, up to which contacts are computed.
pub(in crate::indent) const MOST_RATIO: f64 = 1024.0;

/// Longest oscillation of the first level, in top layers: that of contacts of a radius of one.
const FIRST_LENGTH: f64 = 2.0;

/// Levels, each for twice the length of the one before.
const LEVELS: usize = 12;

/// A number that an indentation depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum IndentParameter {
    /// A number of the body of this position.
    Body(usize, BodyParameter),
    /// A number of the tip.
    Tip(TipParameter),
    /// Work of adhesion.
    Work,
    /// Tensile strength of the adhesion of Maugis and Dugdale.
    Strength,
}

/// The response at the wavenumbers of one quadrature.
#[derive(Debug)]
pub(in crate::indent) struct StackLevel {
    /// Longest oscillation over α that the waves resolve \[m\].
    pub(in crate::indent) length: f64,
    pub(in crate::indent) waves: Waves,
    /// Weights times M(α).
    pub(in crate::indent) excess: Vec<f64>,
    /// Weights times the derivative of M with respect to each parameter of the bodies.
    rates: OnceLock<Vec<Vec<f64>>>,
}

/// Bodies that are indented, planned once.
///
/// ```
/// use nacre::indent::{Indent, Stack, Tip};
/// use nacre::{Elastic, HalfSpace, Layer};
/// let (soft, hard) = (Elastic::new(1.0, 0.3)?, Elastic::new(4.0, 0.3)?);
/// let body = HalfSpace::new(soft, [Layer::new(hard, 1.0)?])?;
/// let stack = Stack::plan(&[body.into()])?;
/// let point = Indent::new(&stack, &Tip::paraboloid(10.0)?).at_radius(0.5)?;
/// assert!(point.load > 0.0 && point.approach > 0.0);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Stack(Arc<Shared>);

#[derive(Debug)]
struct Shared {
    bodies: Vec<Body>,
    parameters: Vec<IndentParameter>,
    /// lim α û/p̂ of all bodies for short waves, and its derivatives.
    short: f64,
    short_rates: Vec<f64>,
    thickness: Option<f64>,
    /// Factor by which all resolutions are raised; 1 but for estimates of the error.
    finer: f64,
    levels: [OnceLock<Arc<StackLevel>>; LEVELS],
}

impl Stack {
    /// Plans `bodies`, which touch in the contact.
    ///
    /// # Errors
    /// No bodies, all of them rigid, one with a local compliance or with free ends.
    pub fn plan(bodies: &[Body]) -> Result<Self> {
        Self::with_resolution(bodies, 1.0)
    }

    /// These bodies with `finer` times as many nodes of all quadratures.
    pub(in crate::indent) fn refined(&self, finer: f64) -> Result<Self> {
        Self::with_resolution(&self.0.bodies, finer)
    }

    fn with_resolution(bodies: &[Body], finer: f64) -> Result<Self> {
        for body in bodies {
            refuse_free(&**body, "bodies that are indented")?;
        }
        let short: f64 = bodies.iter().map(|body| body.asymptotes().short).sum();
        refuse_if(
            bodies.is_empty() || short <= 0.0 || bodies.iter().any(|body| body.local() > 0.0),
            "bodies must be at least one, elastic, and without a local compliance",
        )?;
        let ends = |body: &Body| body.half_space().is_some_and(|body| body.ends() != [None; 2]);
        refuse_if(
            bodies.iter().any(ends),
            "bodies that are indented must extend on all sides: leave out their ends, or use nacre.solve",
        )?;
        let tops = bodies.iter().filter_map(|body| body.lengths()).map(|[top, _]| top);
        let (mut parameters, mut short_rates) = (Vec::new(), Vec::new());
        for (number, body) in bodies.iter().enumerate() {
            let Some(body) = body.half_space() else {
                continue;
            };
            let own = body.parameters();
            let rates = asymptote_derivatives(body, &own);
            short_rates.extend(rates.iter().map(|rate| rate.short));
            parameters.extend(own.iter().map(|own| IndentParameter::Body(number, *own)));
        }
        Ok(Self(Arc::new(Shared {
            bodies: bodies.to_vec(),
            parameters,
            short,
            short_rates,
            thickness: tops.reduce(f64::min),
            finer,
            levels: [const { OnceLock::new() }; LEVELS],
        })))
    }

    /// Contact modulus E* of the bodies at their surfaces \[Pa\].
    pub fn surface_modulus(&self) -> f64 {
        2.0 / self.0.short
    }

    /// Bodies that were planned.
    pub fn bodies(&self) -> &[Body] {
        &self.0.bodies
    }

    /// Numbers of the bodies, with respect to which there are derivatives: those of half-spaces.
    pub fn parameters(&self) -> &[IndentParameter] {
        &self.0.parameters
    }

    /// Thickness \[m\] of the thinnest top layer; none without layers.
    pub fn thickness(&self) -> Option<f64> {
        self.0.thickness
    }

    /// Largest contact radius \[m\] that is computed.
    pub fn largest_radius(&self) -> f64 {
        self.0.thickness.map_or(f64::INFINITY, |h| MOST_RATIO * h)
    }

    /// Contact modulus \[Pa\] of a half-space whose response is the largest one of these bodies at any wavenumber.
    pub(in crate::indent) fn softest_modulus(&self) -> f64 {
        let excess = self.level(0.0).map_or(0.0, |level| {
            let pairs = level.excess.iter().zip(&level.waves.weight);
            pairs.fold(0.0_f64, |most, (excess, w)| most.max(excess / w))
        });
        self.surface_modulus() / (1.0 + excess)
    }

    /// Longest oscillation \[m\] that a level resolves; none bounds it without layers.
    pub(in crate::indent) fn longest(&self) -> f64 {
        let most = FIRST_LENGTH * 2.0_f64.powi(LEVELS as i32 - 1);
        self.0.thickness.map_or(f64::INFINITY, |h| most * h)
    }

    pub(in crate::indent) fn finer(&self) -> f64 {
        self.0.finer
    }

    /// lim α û/p̂ for short waves \[1/Pa\].
    pub(in crate::indent) fn short(&self) -> f64 {
        self.0.short
    }

    /// Derivative of the modulus E* with respect to the `number`th parameter, relative to E*.
    pub(in crate::indent) fn modulus_rate(&self, number: usize) -> f64 {
        -self.0.short_rates[number] / self.0.short
    }

    /// Response for functions that oscillate over lengths up to `length` in α; none where it is that of bare bodies. The
    /// longest level serves beyond.
    pub(in crate::indent) fn level(&self, length: f64) -> Option<&Arc<StackLevel>> {
        let h = self.0.thickness?;
        let doublings = rounding::ceil((length / (FIRST_LENGTH * h)).log2()).max(0.0) as usize;
        let number = doublings.min(LEVELS - 1);
        Some(self.0.levels[number].get_or_init(|| {
            let length = FIRST_LENGTH * h * 2.0_f64.powi(number as i32);
            let excess = |alpha: f64| -> f64 {
                let response: f64 = self.0.bodies.iter().map(|body| body.normal(alpha)).sum();
                response / self.0.short - 1.0
            };
            let waves = Waves::plan(h, length, self.0.finer, excess);
            let pairs = waves.alpha.iter().zip(&waves.weight);
            let excess = pairs.map(|(alpha, w)| w * excess(*alpha)).collect();
            Arc::new(StackLevel { length, waves, excess, rates: OnceLock::new() })
        }))
    }

    /// Weights times the derivative of M with respect to the `number`th parameter, at the waves of `level`.
    pub(in crate::indent) fn excess_rate<'a>(
        &self,
        level: &'a StackLevel,
        number: usize,
    ) -> &'a [f64] {
        let rates = level.rates.get_or_init(|| {
            let shared = &self.0;
            let mut all = vec![vec![0.0; level.waves.len()]; shared.parameters.len()];
            let own: Vec<Vec<BodyParameter>> = shared
                .bodies
                .iter()
                .map(|body| body.half_space().map_or(vec![], |body| body.parameters()))
                .collect();
            let most = own.iter().map(Vec::len).max().unwrap_or(0);
            let mut slopes = vec![0.0; most];
            for (q, (alpha, w)) in level.waves.alpha.iter().zip(&level.waves.weight).enumerate() {
                // M = response/short − 1.
                let ratio = level.excess[q] + w;
                let mut first = 0;
                for (body, own) in shared.bodies.iter().zip(&own) {
                    let Some(body) = body.half_space() else {
                        continue;
                    };
                    normal_derivatives(body, own, *alpha, &mut slopes[..own.len()]);
                    for (k, slope) in slopes[..own.len()].iter().enumerate() {
                        let short_rate = shared.short_rates[first + k];
                        all[first + k][q] = (w * slope - ratio * short_rate) / shared.short;
                    }
                    first += own.len();
                }
            }
            all
        });
        &rates[number]
    }
}
