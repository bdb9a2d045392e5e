//! A bound of what one end of a body adds to the stress.

use std::ops::ControlFlow;

use ndarray::Array2;

use crate::compliance::response::interior::Place;
use crate::error::Result;
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;
use crate::numerics::parallel::Threads;
use crate::stress::half_space::{HalfSpacePlan, Loading, components};
use crate::stress::options::Side;
use crate::stress::section::place;

/// Rows and columns of cells beside a load, and the row from which on the stress counts, which is that of the contact.
const CELLS: [usize; 2] = [48, 9];
const FROM: usize = 32;

/// Largest stress that an end adds, over the bound without this factor. Measured at ends 3 and 9 contact widths away, for ν = 0,
/// 0.3 and 0.5 of the substrate, bare and with layers of a tenth to ten times its modulus and 0.1 to 5 widths thick: 0.2 to 1.5.
const WITHIN: f64 = 2.0;

/// A share of what one end of a body adds to the stress.
///
/// From a distance, what an end adds is the stress under loads about as large as the contact's and about as far away as the
/// end: the bound is the largest component under the load of the contact, as a point at the distance of the end, in the body
/// without ends. Between two signs it may vanish at a depth where what the end adds does not; so the larger one counts of that
/// at the depth itself and at half the distance, below the layers. Derived here.
#[derive(Debug)]
pub(super) struct EndBound {
    plan: HalfSpacePlan,
    /// Depth above which the stress at this depth counts as well \[m\].
    deep: f64,
    share: f64,
}

impl EndBound {
    /// The `share` of what an end at this `distance` from the nearest pressure adds to the stress of a plan, whose contact has
    /// this `size`, in the `endless` body. None where that is less than rounding.
    pub(super) fn new(
        whole: &HalfSpacePlan,
        endless: &HalfSpace,
        (distance, size): (f64, f64),
        share: f64,
    ) -> Result<Option<Self>> {
        // From within the contact, its load is no point.
        let distance = distance.max(0.5 * size);
        let peak = whole.pressure.iter().fold(0.0_f64, |most, p| most.max(p.abs()));
        let load = whole.pressure.iter().map(|p| p.abs()).sum::<f64>() * whole.grid.cell_area();
        if share <= 0.0 || load <= f64::EPSILON * peak * distance * distance {
            return Ok(None);
        }
        let side = distance / FROM as f64;
        let grid = Grid::new(CELLS, CELLS.map(|count| count as f64 * side))?;
        let mut pressure = Array2::zeros(CELLS);
        pressure[[0, CELLS[1] / 2]] = load / (side * side);
        let wanted = [FROM..CELLS[0], 0..CELLS[1]];
        let plan =
            HalfSpacePlan::uniform(endless, (&grid, &wanted), &pressure, &Threads::new(Some(1))?)?;
        Ok(Some(Self { plan, deep: (0.5 * distance).max(endless.thickness()), share }))
    }

    /// The bound \[Pa\] at a place.
    pub(super) fn at(&self, at: &Place) -> f64 {
        let below = place(&self.plan.body, at.depth.max(self.deep), Side::Below);
        let largest = below.iter().map(|below| self.largest(below)).fold(0.0, f64::max);
        self.share * WITHIN * largest.max(self.largest(at))
    }

    /// Largest component of stress at a place, at the distance of the end and farther.
    fn largest(&self, at: &Place) -> f64 {
        let loading = Loading::new([0.0; 2], false);
        let mut memory = self.plan.plane_memory(&loading);
        let mut planes = vec![vec![0.0; CELLS[0] * CELLS[1]]; components(false)];
        let mut outputs: Vec<&mut [f64]> = planes.iter_mut().map(|plane| &mut plane[..]).collect();
        let mut unwatched = |_| ControlFlow::Continue(());
        let _ = self.plan.plane(&loading, at, &mut memory, &mut outputs, &mut unwatched);
        let beyond = planes.iter().flat_map(|plane| &plane[FROM * CELLS[1]..]);
        beyond.fold(0.0, |most, stress| most.max(stress.abs()))
    }
}
