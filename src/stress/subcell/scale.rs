//! Whether cells resolve the law by which pressure falls to zero at a smooth edge.
//!
//! p = √d (c0 + c1 d + …) is the law of bodies that respond alike at all wavelengths. On a coating it
//! holds at distances d that are short compared with its thickness, with the coating's response, and at
//! distances that are long, with the response of what is below; in between it is another one, as p ∝ d
//! on a thin soft coating. A polynomial fitted to p² over some cells finds the edge if one of the two
//! holds from the cells inside the edge to within a cell of it.

use crate::compliance::response::Response;

/// Longest wavelength over 2π that a fit sees, in cells: the window of [`super::fit`].
const LONGEST: f64 = 8.0;

/// Shortest wavelength over 2π that is looked at, in cells.
const SHORTEST: f64 = 1e-3;

/// Wavenumbers per octave at which responses are compared.
const PER_OCTAVE: f64 = 4.0;

/// Largest change of the response, relative, with which one law holds. Chosen by trial: coatings of
/// 0.05 to 8 cells and 0.01 to 100 times the modulus of the substrate, on contacts of 20 cells to the
/// half-width. Where the response changes less, errors are well below those of uniform cells; where it
/// changes by 0.07 to 0.09, they are up to 2.3 times as large a tenth of a cell deep, and beyond, 4.4 times.
const LARGEST_CHANGE: f64 = 0.06;

/// The bodies of a contact, whose responses add.
pub(in crate::stress) struct Pair<'a>(pub(in crate::stress) Vec<&'a dyn Response>);

impl Pair<'_> {
    /// α û/p̂ of all bodies at the wavenumber α, with the local compliance, which grows without limit.
    pub(super) fn response(&self, alpha: f64) -> f64 {
        let of = |body: &&dyn Response| body.normal(alpha) + alpha * body.local();
        self.0.iter().map(of).sum()
    }

    /// Whether the response is that of a half-space at the wavelengths of some cells of the side `cell`, or
    /// at all that are shorter than a cell.
    pub(super) fn root_law_holds(&self, cell: f64) -> bool {
        let change = |from: f64, to: f64| {
            let count = ((to / from).log2() * PER_OCTAVE).ceil();
            let at = |k: u32| from * (to / from).powf(f64::from(k) / count) / cell;
            let ends = [f64::INFINITY, f64::NEG_INFINITY];
            let [low, high] = (0..=count as u32)
                .map(|k| self.response(at(k)))
                .fold(ends, |[low, high], r| [low.min(r), high.max(r)]);
            high / low - 1.0
        };
        change(1.0 / LONGEST, 1.0) <= LARGEST_CHANGE
            || change(1.0, 1.0 / SHORTEST) <= LARGEST_CHANGE
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;
    use crate::model::body::{HalfSpace, Layer};
    use crate::model::material::Elastic;

    /// Bare bodies and coatings that are thin or thick compared with a cell; not those of about a cell,
    /// nor thin ones that are soft enough to bear the pressure as springs do.
    #[test]
    fn the_law_holds_where_cells_see_one_material() -> Result<()> {
        let steel = Elastic::new(1.0, 0.3)?;
        let bare = HalfSpace::from(steel);
        assert!(Pair(vec![&bare, &bare]).root_law_holds(1.0));
        for (ratio, thickness, expected) in [
            (0.3, 0.05, true),
            (3.0, 0.05, true),
            (3.0, 8.0, true),
            (0.01, 8.0, true),
            (3.0, 0.5, false),
            (3.0, 1.0, false),
            (0.1, 0.05, false),
            (0.02, 0.12, false),
        ] {
            let layer = Layer::new(Elastic::new(ratio, 0.3)?, thickness)?;
            let coated = HalfSpace::new(steel, [layer])?;
            let found = Pair(vec![&coated]).root_law_holds(1.0);
            assert_eq!(found, expected, "{ratio} {thickness}");
        }
        Ok(())
    }
}
