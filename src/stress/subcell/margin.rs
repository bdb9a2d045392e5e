//! A margin of images around the cells of a grid that repeats, so that the seam is like any other place.

use std::borrow::Cow;

use super::near::STRESSES;
use crate::model::grid::{Grid, Window};

/// Cells of the margin: more than fits, closings of edges and the reach of loads together.
const CELLS: usize = 24;

/// Numbers of cells of a grid, and of its margin on each side.
#[derive(Debug, Clone, Copy)]
pub(super) struct Margin {
    shape: [usize; 2],
    width: [usize; 2],
}

impl Margin {
    /// The margin of `grid`; it has no cells along directions that do not repeat.
    pub(super) fn of(grid: &Grid) -> Self {
        Self {
            shape: grid.shape(),
            width: grid
                .is_periodic()
                .map(|repeats| if repeats { CELLS } else { 0 }),
        }
    }

    /// Whether there is any.
    fn is_empty(self) -> bool {
        self.width == [0; 2]
    }

    fn wide_shape(self) -> [usize; 2] {
        [0, 1].map(|k| self.shape[k] + 2 * self.width[k])
    }

    /// The grid with its margin. Sides of cells stay to rounding, and the place does not matter.
    pub(super) fn wide(self, grid: &Grid) -> Grid {
        let shape = self.wide_shape();
        let size = [0, 1].map(|k| shape[k] as f64 * grid.spacing()[k]);
        match self.is_empty() {
            true => *grid,
            false => Grid::new(shape, size).unwrap_or(*grid),
        }
    }

    /// Values of the cells with those of the margin, which repeat them.
    pub(super) fn around(self, values: &[f64]) -> Cow<'_, [f64]> {
        if self.is_empty() {
            return Cow::Borrowed(values);
        }
        let ([nx, ny], [wx, wy]) = (self.shape, self.wide_shape());
        // Before the first cell lies the last.
        let place = |k: usize, at: usize| {
            let n = self.shape[k];
            (at + n * CELLS - self.width[k]) % n
        };
        debug_assert!(nx > 0 && ny > 0);
        let cells = (0..wx).flat_map(|i| (0..wy).map(move |j| (i, j)));
        Cow::Owned(
            cells
                .map(|(i, j)| values[place(0, i) * ny + place(1, j)])
                .collect(),
        )
    }

    /// Values of the cells from those with the margin.
    pub(super) fn middle(self, wide: &[f64]) -> Vec<f64> {
        let ([nx, ny], [_, wy]) = (self.shape, self.wide_shape());
        let rows = (0..nx).map(|i| (i + self.width[0]) * wy + self.width[1]);
        rows.flat_map(|start| wide[start..start + ny].iter().copied())
            .collect()
    }

    /// Number of a cell along both directions, counted with the margin.
    pub(super) fn cell(self, cell: [usize; 2]) -> [usize; 2] {
        [0, 1].map(|k| cell[k] + self.width[k])
    }

    /// A window, counted with the margin.
    pub(super) fn window(self, window: &Window) -> Window {
        [0, 1].map(|k| window[k].start + self.width[k]..window[k].end + self.width[k])
    }

    /// Calls `add` for stresses on the cells with their margin, and adds the middle of them to `stresses`.
    pub(super) fn add(self, stresses: &mut [&mut [f64]], add: impl FnOnce(&mut [&mut [f64]])) {
        if self.is_empty() {
            add(stresses);
            return;
        }
        let [wx, wy] = self.wide_shape();
        let mut wide = vec![vec![0.0; wx * wy]; STRESSES];
        let mut planes: Vec<&mut [f64]> = wide.iter_mut().map(Vec::as_mut_slice).collect();
        add(&mut planes);
        for (stress, wide) in stresses.iter_mut().zip(&wide) {
            let middle = self.middle(wide);
            stress.iter_mut().zip(middle).for_each(|(s, w)| *s += w);
        }
    }
}
