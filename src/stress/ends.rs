//! What the free ends of a body add to the stress of the endless body.
//!
//! The stress of a quarter space is the sum of those of two half-spaces: one under the even pressure P on the
//! surface, and one under Q on the end face ([`crate::compliance::ends`]). What is added is therefore the stress of the
//! layered half-space under the mirror image of the pressure and under P − p on both sides of the end, and that of
//! a half-space of the substrate below the end face. The two ends of a body are superposed.
//!
//! Tractions of friction have no such solution: their stress is that of the endless body.

use ndarray::Array2;

use super::half_space::{HalfSpacePlan, Part};
use super::options::StressProgress;
use super::section::Span;
use crate::compliance::ends::{Where, unknown_share};
use crate::compliance::response::interior::Place;
use crate::error::Result;
use crate::model::body::Substrate;
use crate::numerics::rounding::cells_within;

mod bound;
mod face;
mod pressures;

use bound::EndBound;
use face::Face;
use pressures::{EndImages, FOLLOWED, NearEnd, STRIP, Strip, excess_part};

/// What the ends of a body add.
#[derive(Debug, Default)]
pub(super) struct EndStress {
    /// The body without ends under mirror images and excesses, beside each end the same on finer cells instead; then
    /// the faces. Empty where the ends add nothing.
    pub(super) parts: Vec<Box<dyn Part>>,
    pub(super) errors: EndErrors,
}

/// What is known of the errors of the stress that ends add.
#[derive(Debug, Default)]
pub(super) struct EndErrors {
    /// Errors of ends that are counted; none where there is none.
    counted: Option<CountedErrors>,
    /// What is not known of the single ends: of the model of those with layers a share, of those that are far all.
    unknown: Vec<EndBound>,
}

/// What is known of the errors of the stress that counted ends of a bare body add.
#[derive(Debug)]
struct CountedErrors {
    /// Length of the contact's cells along x \[m\].
    spacing: f64,
    /// Largest pressure \[Pa\].
    peak: f64,
    /// What one end of a body does to the other, and that is left out \[Pa\]; 0 where there is one.
    left_out: f64,
}

/// Error of the stress from one cell below the surface on, over the peak pressure, and at most. In between it falls
/// as z⁻². Measured on the face as its normal traction, for ν = 0, 0.3 and 0.5 and cells of an eighth to a
/// thirty-second of the contact's half-length: 0.18 on the edge; 4e-3, 1e-3 and 9e-4 at ¼, ½ and one cell where a smooth
/// pressure vanishes at the end; 0.02, 7e-3 and 2e-3 at ¼, ½ and one cell where it reaches it, bounded or as x^−0.226, and 2.4e-3
/// farther down (`tests/stress/ends.rs`).
const ERRORS: [f64; 2] = [3e-3, 0.2];

/// Distance of the load from an end, relative to the longer side of the contact, from which on the end is not counted. Below
/// it, a bare body has 1e-3 of the peak pressure from the end at most; the uncertainty has what is left out.
const FAR_END: f64 = 10.0;

impl EndStress {
    /// What the ends of the body of a plan add; none where `progress` stops it.
    pub(super) fn plan(
        whole: &HalfSpacePlan,
        span: &Span,
        progress: &mut StressProgress,
    ) -> Result<Option<Self>> {
        let (body, grid, threads) = (&whole.body, &whole.grid, &whole.threads);
        let Substrate::Elastic(material) = body.substrate() else {
            return Ok(Some(Self::default()));
        };
        let ([nx, ny], [dx, dy]) = (grid.shape(), grid.spacing());
        let pressure = Array2::from_shape_fn((nx, ny), |(i, j)| whole.pressure[i * ny + j]);
        let loaded_lines = |lines: ndarray::iter::Lanes<'_, f64, ndarray::Ix1>| {
            let lines = lines.into_iter();
            lines.filter(|line| line.iter().any(|p| *p != 0.0)).count()
        };
        let width = loaded_lines(pressure.columns()) as f64 * dy;
        let size = width.max(loaded_lines(pressure.rows()) as f64 * dx);
        let endless = body.clone().with_ends([None; 2])?;
        let mut images = EndImages::new(grid);
        let known = [0, 1].map(|k| body.ends()[k].filter(|_| span.faces[k].is_some()));
        let (mut parts, mut faces) = (Vec::<Box<dyn Part>>::new(), Vec::<Box<dyn Part>>::new());
        let mut errors = EndErrors::default();
        for (end, sign) in body.ends().into_iter().zip([1.0, -1.0]) {
            let Some(end) = end else { continue };
            let near = NearEnd::new((&pressure, width), grid, (end, sign), material);
            let Some(near) = near else { continue };
            let is_far = near.nearest > FAR_END * size;
            let share = if is_far { 1.0 } else { unknown_share(body) };
            errors.unknown.extend(EndBound::new(whole, &endless, (near.nearest, size), share)?);
            if is_far {
                continue;
            }
            images.add_mirror(&pressure, end);
            let excess = near.followed(Where::Surface, dx, threads);
            let far = cells_within(FAR_END * near.reach / FOLLOWED, dx);
            let (excess, rows) = ((&*excess, end, near.margin), &near.rows(far));
            parts.push(Box::new(excess_part(excess, &endless, grid, (rows, 1), threads)?));
            let strip = Strip::new(&near, Where::Surface, dx, dx, threads);
            for part in strip.parts(&endless, grid, &near.rows(STRIP), end, threads)? {
                parts.push(Box::new(part));
            }
            match Face::plan(&near, grid, known, threads, progress)? {
                Some(face) => faces.push(Box::new(face)),
                None => return Ok(None),
            }
        }
        if faces.is_empty() {
            return Ok(Some(Self { parts, errors }));
        }
        parts.push(Box::new(images.part(&endless, threads)?));
        parts.extend(faces);
        errors.counted = Some(CountedErrors::of(whole));
        Ok(Some(Self { parts, errors }))
    }
}

impl EndErrors {
    /// Whether an end is counted.
    pub(super) fn any_counted(&self) -> bool {
        self.counted.is_some()
    }

    /// Estimated error \[Pa\] of the stress that the ends add at a place, where it is worst; none where the body has no ends.
    pub(super) fn at(&self, place: &Place) -> Option<f64> {
        if self.counted.is_none() && self.unknown.is_empty() {
            return None;
        }
        let counted = self.counted.as_ref().map_or(0.0, |errors| errors.at(place.depth));
        Some(counted + self.unknown.iter().map(|end| end.at(place)).sum::<f64>())
    }
}

impl CountedErrors {
    fn of(whole: &HalfSpacePlan) -> Self {
        Self {
            spacing: whole.grid.spacing()[0],
            peak: whole.pressure.iter().fold(0.0, |most, p| most.max(p.abs())),
            left_out: match whole.body.ends() {
                [Some(low), Some(high)] => {
                    let load = whole.pressure.iter().sum::<f64>() * whole.grid.cell_area();
                    load / std::f64::consts::PI / (high - low).powi(2)
                }
                _ => 0.0,
            },
        }
    }

    /// Estimated error \[Pa\] of the stress that the ends add at the depth `z`, at the worst place, which is beside
    /// the face. Two ends a distance L apart, superposed, leave W/πL² of the load W: for ν = 0 and a pressure along all of
    /// the body, where they should change nothing, 0.97 and 0.86 of that at L = 20 and 10 half-widths.
    fn at(&self, z: f64) -> f64 {
        let [deep, most] = ERRORS;
        let cells = (z / self.spacing).min(1.0);
        self.peak * (deep / cells.powi(2)).min(most) + self.left_out
    }
}
