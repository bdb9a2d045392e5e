//! The contact that is solved on one grid after another, and rectangles.

use crate::compliance::response::Body;
use crate::contact::options::{Motion, Options, Setup};
use crate::contact::plan::Contact;
use crate::contact::solution::{Progress, Solution};
use crate::error::Result;
use crate::model::grid::Grid;
use crate::model::surface::Surface;

/// Ends of a rectangle along x and along y.
pub(super) type Frame = [[f64; 2]; 2];

/// The smallest rectangle that holds both.
pub(super) fn enclosing(a: Frame, b: Frame) -> Frame {
    [0, 1].map(|k| [a[k][0].min(b[k][0]), a[k][1].max(b[k][1])])
}

/// The rectangle of a grid.
pub(super) fn frame_of(grid: &Grid) -> Frame {
    [0, 1].map(|k| {
        let half = 0.5 * grid.size()[k];
        [grid.center()[k] - half, grid.center()[k] + half]
    })
}

/// A shape that is pressed into a body.
#[derive(Clone, Copy)]
pub(super) struct Trial<'a> {
    pub(super) shape: &'a dyn Surface,
    pub(super) body: &'a Body,
    pub(super) setup: &'a Setup,
    pub(super) motion: &'a Motion,
    /// Range of x in which both bodies extend.
    pub(super) ends: [f64; 2],
    /// Largest number of cells.
    pub(super) most: usize,
}

impl Trial<'_> {
    /// A grid over the part of a rectangle that lies between the ends of the bodies. Cells of the rectangle are no
    /// smaller.
    pub(super) fn grid_over(&self, frame: Frame, shape: [usize; 2]) -> Result<Grid> {
        let [low, high] = self.ends;
        let frame = [[frame[0][0].max(low), frame[0][1].min(high)], frame[1]];
        Grid::new(shape, frame.map(|[low, high]| high - low))?
            .centered_at(frame.map(|[low, high]| 0.5 * (low + high)))
    }

    /// Numbers of `cells` along both axes; fewer along the longer one where they are too many, and along both where that is
    /// not enough.
    pub(super) fn at_most(&self, cells: [usize; 2]) -> [usize; 2] {
        let axis = usize::from(cells[1] < cells[0]);
        let mut fewer = cells;
        fewer[axis] = cells[axis].clamp(1, self.most.isqrt());
        fewer[1 - axis] = cells[1 - axis].min(self.most / fewer[axis]);
        fewer
    }

    /// Plans one grid, and solves on it.
    pub(super) fn solve(
        &self,
        grid: Grid,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Solution> {
        let plan = Contact::plan(self.body, grid, self.setup.clone())?;
        plan.run(|| plan.solve_alone(self.shape, self.motion, options, progress))
    }

    /// The approach and the tilts, where all three are prescribed; a direction without any condition
    /// has a tilt of 0.
    pub(super) fn prescribed(&self) -> Option<(f64, [f64; 2])> {
        let loaded =
            |k: usize| self.motion.eccentricity[k].is_some() || self.motion.moment[k].is_some();
        let free = self.motion.load.is_some() || loaded(0) || loaded(1);
        let approach = self.motion.approach.filter(|_| !free)?;
        Some((approach, self.tilt()))
    }

    /// The prescribed tilts; 0 where a tilt is free.
    pub(super) fn tilt(&self) -> [f64; 2] {
        self.motion.tilt.map(|tilt| tilt.unwrap_or(0.0))
    }
}
