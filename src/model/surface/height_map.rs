//! Measured surfaces.

use std::sync::Arc;

use ndarray::{Array2, ArrayRef2};

use super::{Extent, Surface, sampled};
use crate::error::{Result, all_finite, positive, require};
use crate::model::data::value;
use crate::model::grid::Grid;

/// A measured surface: heights at the centres of a grid's cells, positive towards the other body.
///
/// ```text
/// h = max(heights) − heights
/// ```
///
/// On another grid, gaps are interpolated bilinearly. They are constant over the outer half of the
/// outermost cells, and +∞ beyond.
///
/// ```
/// use nacre::{HeightMap, Surface};
/// let map = HeightMap::new(ndarray::array![[0.0, 1.0], [2.0, 3.0]], [1.0, 1.0])?;
/// assert_eq!(map.gap(0.0, 0.0), 1.5);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct HeightMap {
    heights: Arc<Array2<f64>>,
    highest: f64,
    spacing: [f64; 2],
    grid: Grid,
}

impl HeightMap {
    /// A height map of `heights` (nx, ny) \[m\] at a `spacing` \[m\], centred at the origin.
    ///
    /// # Errors
    /// Where a height is not finite, there are fewer than two samples in a direction, or the
    /// spacing is not finite and above 0.
    pub fn new(heights: Array2<f64>, spacing: [f64; 2]) -> Result<Self> {
        all_finite("heights", &heights)?;
        let shape = [heights.nrows(), heights.ncols()];
        for n in shape {
            let name = "number of heights along x and along y";
            require(name, n as f64, n >= 2, "at least 2")?;
        }
        for d in spacing {
            positive("spacing", d)?;
        }
        let size = [shape[0] as f64 * spacing[0], shape[1] as f64 * spacing[1]];
        Ok(Self {
            highest: heights.fold(f64::NEG_INFINITY, |a, &b| a.max(b)),
            heights: Arc::new(heights),
            spacing,
            grid: Grid::new(shape, size)?,
        })
    }

    /// This surface, moved to be centred at `center` \[m\].
    ///
    /// # Errors
    /// Unless `center` is finite.
    pub fn centered_at(self, center: [f64; 2]) -> Result<Self> {
        Ok(Self { grid: self.grid.centered_at(center)?, ..self })
    }

    /// This surface, repeated along x, along y, or both: its period is its size.
    ///
    /// # Errors
    /// None: every map has two samples or more along each direction.
    pub fn periodic(self, periodic: [bool; 2]) -> Result<Self> {
        Ok(Self { grid: self.grid.periodic(periodic)?, ..self })
    }

    /// Directions in which it repeats.
    pub fn is_periodic(&self) -> [bool; 2] {
        self.grid.is_periodic()
    }

    /// Heights, (nx, ny) \[m\].
    pub fn heights(&self) -> &ArrayRef2<f64> {
        &self.heights
    }

    /// Distances between samples \[m\].
    pub fn spacing(&self) -> [f64; 2] {
        self.spacing
    }

    /// Centre of the map \[m\].
    pub fn center(&self) -> [f64; 2] {
        self.grid.center()
    }
}

value! {
    HeightMap by HeightMapData {
        heights: Vec<Vec<f64>> = of.heights().outer_iter().map(|row| row.to_vec()).collect();
        spacing: [f64; 2] = of.spacing();
        #[serde(default)]
        center: [f64; 2] = of.center();
        #[serde(default, skip_serializing_if = "crate::model::data::is_default")]
        periodic: [bool; 2] = of.is_periodic();
    }
    of, fields => {
        let shape = [fields.heights.len(), fields.heights.first().map_or(0, Vec::len)];
        let heights = Array2::from_shape_vec(shape, fields.heights.concat()).map_err(|_| {
            crate::error::Error::Inconsistent("heights must be rows of the same length")
        })?;
        Self::new(heights, fields.spacing)?
            .centered_at(fields.center)?
            .periodic(fields.periodic)
    }
}

/// Relative tolerance of positions and spacings: rounding of coordinates must not exclude a cell
/// whose centre lies on the rim of the map.
const ROUNDING: f64 = 1e-9;

/// [`Grid::around`]; `None` outside the map, which ends half a cell beyond the outermost samples unless it repeats.
fn locate(grid: &Grid, axis: usize, coordinate: f64) -> Option<([usize; 2], f64)> {
    let map = -0.5 - ROUNDING..=grid.shape()[axis] as f64 - 0.5 + ROUNDING;
    let holds = grid.is_periodic()[axis] || map.contains(&grid.position(axis, coordinate));
    holds.then(|| grid.around(axis, coordinate))
}

impl Surface for HeightMap {
    fn gap(&self, x: f64, y: f64) -> f64 {
        let along = |axis: usize, at: f64| locate(&self.grid, axis, at);
        let (Some(([a, b], s)), Some(([c, d], t))) = (along(0, x), along(1, y)) else {
            return f64::INFINITY;
        };
        let at = |i: usize, j: usize| self.highest - self.heights[[i, j]];
        (1.0 - s) * ((1.0 - t) * at(a, c) + t * at(a, d))
            + s * ((1.0 - t) * at(b, c) + t * at(b, d))
    }

    fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
        if *grid == self.grid {
            return Ok(sampled(grid, |i, j| self.highest - self.heights[[i, j]]));
        }
        let (own, periods) = (self.extent(), grid.periods());
        for axis in 0..2 {
            if periods[axis].is_some() {
                own[axis].check_period(axis, periods[axis])?;
            }
        }
        for (cell, sample) in grid.spacing().into_iter().zip(self.grid.spacing()) {
            let is_fine = cell <= 2.0 * sample * (1.0 + ROUNDING);
            let requirement = "at most twice the spacing of the height map";
            require("grid spacing", cell, is_fine, requirement)?;
        }
        let (x, y) = (grid.x(), grid.y());
        Ok(sampled(grid, |i, j| self.gap(x[i], y[j])))
    }

    fn extent(&self) -> [Extent; 2] {
        let (center, size) = (self.grid.center(), self.grid.size());
        let periodic = self.grid.is_periodic();
        [0, 1].map(|k| match periodic[k] {
            true => Extent::Repeating(size[k]),
            false => Extent::CutOff([center[k] - 0.5 * size[k], center[k] + 0.5 * size[k]]),
        })
    }

    fn grid(&self) -> Option<Grid> {
        Some(self.grid)
    }

    /// Not: the gap has corners at the samples.
    fn is_smooth(&self) -> bool {
        false
    }
}
