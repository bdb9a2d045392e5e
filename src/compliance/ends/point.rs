//! The surface of a quarter space at points, under uniform pressure on a rectangle.

use std::f64::consts::PI;

use ndarray::Array1;

use super::reduction::Reduction;
use super::waves::{Waves, Width};
use super::{VANISHED, layers};
use crate::compliance::influence::CellInfluence;
use crate::error::{Error, Result, finite, positive};
use crate::model::body::{HalfSpace, Substrate};
use crate::model::material::Elastic;

/// A body x ≥ 0, z ≥ 0 whose face x = 0 is free, under uniform pressure on the rectangle
/// d ≤ x ≤ d + l, |y| ≤ b of its surface z = 0.
///
/// The displacement is that of a half-space under the load and its mirror image, and of what keeps the face
/// free. The reduction to one equation is nacre's own, after Hetényi, J. Appl. Mech. 37 (1970) 289,
/// doi:10.1115/1.3408508.
///
/// ```
/// use nacre::{Elastic, ends::QuarterSpace};
/// use std::f64::consts::PI;
/// // For ν = ½, the edge sinks 2π²/(π² − 4) times as far as the surface of a half-space.
/// let rubber = Elastic::new(1e6, 0.5)?;
/// let body = QuarterSpace::new(rubber, 0.0, [2.0, 1.0])?;
/// let half_space = nacre::influence::CellInfluence::plan(&rubber, [2.0, 2.0], 10.0)?;
/// let ratio = body.displacement([0.0, 0.0])? / half_space.at([1.0, 0.0]);
/// assert!((ratio / (2.0 * PI * PI / (PI * PI - 4.0)) - 1.0).abs() < 1e-5);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug)]
pub struct QuarterSpace {
    body: HalfSpace,
    material: Elastic,
    distance: f64,
    length: f64,
    half_width: f64,
}

impl QuarterSpace {
    /// A `body`, which may have layers ([the model](crate::compliance::ends)), under unit pressure on the rectangle at this `distance` d \[m\] from the end, of
    /// length l and half-width b \[m\].
    ///
    /// # Errors
    /// On a rigid substrate; unless the distance is at least 0, and all lengths are finite and the last two above 0.
    pub fn new(
        body: impl Into<HalfSpace>,
        distance: f64,
        [length, half_width]: [f64; 2],
    ) -> Result<Self> {
        let body = body.into();
        let Substrate::Elastic(material) = body.substrate() else {
            return Err(Error::Inconsistent(
                "body must not have a rigid substrate: its face is not free there",
            ));
        };
        not_negative("distance", distance)?;
        positive("length", length)?;
        positive("half_width", half_width)?;
        Ok(Self { body, material, distance, length, half_width })
    }

    /// Displacement \[m/Pa\] of the surface at (x, y) \[m\], x ≥ 0, per unit pressure.
    ///
    /// # Errors
    /// Unless x is at least 0 and both are finite.
    pub fn displacement(&self, [x, y]: [f64; 2]) -> Result<f64> {
        not_negative("x", x)?;
        finite("y", y)?;
        let middle = self.distance + 0.5 * self.length;
        let sides = [self.length, 2.0 * self.half_width];
        let reach = (x + middle).hypot(y) + sides[0].hypot(sides[1]);
        let half_space = CellInfluence::plan(&self.body, sides, reach)?;
        let images = half_space.at([x - middle, y]) + half_space.at([x + middle, y]);
        Ok(images + self.excess([x, y]))
    }

    /// The displacement beyond that of the load and its image.
    pub(crate) fn excess(&self, [x, y]: [f64; 2]) -> f64 {
        let reduction = Reduction::of(self.material.poisson());
        let end = self.distance + self.length;
        // On the edge itself amplitudes fall as k⁻² only; the rest is 1e-8 of the integral.
        let shortest = self.length.min(self.half_width);
        let highest = (VANISHED / (x + self.distance).max(1e-30)).min(1e4 / shortest);
        let reach = y.abs() + self.half_width + end + x;
        let waves = Waves::new(&[y.abs()], Width::Load(self.half_width), reach, highest);
        let mut sum = 0.0;
        for (k, weights) in waves.wavenumbers.iter().zip(&waves.weights) {
            let [mut at, mut load] = [
                Array1::zeros(reduction.displacement.count()),
                Array1::zeros(reduction.displacement.count()),
            ];
            reduction.displacement.add(k * x, 1.0, &mut at);
            reduction.displacement.add_integrals(k * end, 1.0 / k, &mut load);
            reduction.displacement.add_integrals(k * self.distance, -1.0 / k, &mut load);
            sum += layers::factor(&self.body, *k) * weights[0] * at.dot(&load);
        }
        let short = 2.0 / self.material.plane_strain_modulus();
        sum * short * 2.0 * self.half_width / (PI * PI)
    }
}

fn not_negative(name: &'static str, value: f64) -> Result<()> {
    if value >= 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(Error::Parameter { name, requirement: "finite and at least 0", value })
}
