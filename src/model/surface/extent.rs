//! Where shapes end.

use crate::error::{Error, Result};

/// The extent of a shape along one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Extent {
    /// A shape whose gap increases without limit in both directions.
    Rising,
    /// A shape whose gap is constant along the axis, so that the contact has no end.
    Endless,
    /// A shape whose gap repeats along the axis with this period \[m\].
    Repeating(f64),
    /// A shape that ends smoothly at these coordinates \[m\], as a sphere; the gap is +∞ beyond.
    Within([f64; 2]),
    /// A shape that is cut off at these coordinates \[m\], as a roller by its faces or a height map
    /// by its rim. The gap is +∞ beyond, and a contact that reaches an end has a sharp edge there.
    CutOff([f64; 2]),
}

impl Extent {
    /// Range of coordinates in which the gap can be finite.
    pub fn range(&self) -> [f64; 2] {
        match *self {
            Self::Rising | Self::Endless | Self::Repeating(_) => [f64::NEG_INFINITY, f64::INFINITY],
            Self::Within(range) | Self::CutOff(range) => range,
        }
    }

    /// An error unless a grid with this period along `axis` repeats as the shape does.
    ///
    /// # Errors
    /// [`Error::Period`].
    pub(crate) fn check_period(&self, axis: usize, grid: Option<f64>) -> Result<()> {
        let Self::Repeating(period) = *self else {
            return Ok(());
        };
        let times = grid.map_or(0.0, |size| size / period);
        // Rounding of sides that are products of spacings.
        match times >= 0.5 && (times - times.round()).abs() <= 1e-9 * times {
            true => Ok(()),
            false => Err(Error::Period {
                axis: ["x", "y"][axis],
                period,
                grid,
            }),
        }
    }

    pub(super) fn shifted(self, by: f64) -> Self {
        match self {
            Self::Within([a, b]) => Self::Within([a + by, b + by]),
            Self::CutOff([a, b]) => Self::CutOff([a + by, b + by]),
            other => other,
        }
    }

    /// Extent of the sum of two shapes, and of a shape within a range.
    pub(super) fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Endless, other) | (other, Self::Endless) => other,
            // The period of the sum, where one is a multiple of the other.
            (Self::Repeating(a), Self::Repeating(b)) => Self::Repeating(a.max(b)),
            (a, b) => {
                let ([a0, a1], [b0, b1]) = (a.range(), b.range());
                let range = [a0.max(b0), a1.min(b1)];
                match (a, b) {
                    (Self::CutOff(_), _) | (_, Self::CutOff(_)) => Self::CutOff(range),
                    (Self::Within(_), _) | (_, Self::Within(_)) => Self::Within(range),
                    _ => Self::Rising,
                }
            }
        }
    }
}
