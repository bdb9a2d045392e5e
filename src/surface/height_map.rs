//! Measured surfaces.

use std::sync::Arc;

use ndarray::{Array2, ArrayRef2};

use super::{Extent, Surface, sampled};
use crate::error::{Error, Result};
use crate::grid::Grid;

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
        if let Some((index, _)) = heights.indexed_iter().find(|(_, h)| !h.is_finite()) {
            return Err(Error::NonFinite {
                name: "heights",
                index: [index.0, index.1],
            });
        }
        let shape = [heights.nrows(), heights.ncols()];
        if let Some(&few) = shape.iter().find(|&&n| n < 2) {
            return Err(Error::Parameter {
                name: "number of heights along x and along y",
                requirement: "at least 2",
                value: few as f64,
            });
        }
        for d in spacing {
            crate::error::positive("spacing", d)?;
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
        Ok(Self {
            grid: self.grid.centered_at(center)?,
            ..self
        })
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

/// Relative tolerance of positions and spacings: rounding of coordinates must not exclude a cell
/// whose centre lies on the rim of the map.
const ROUNDING: f64 = 1e-9;

/// Index of the sample at or below `coordinate`, and the weight of the next sample; `None` outside
/// the map.
fn locate(coordinate: f64, center: f64, n: usize, spacing: f64) -> Option<(usize, f64)> {
    let position = (coordinate - center) / spacing + 0.5 * (n - 1) as f64;
    // The map ends half a cell beyond the outermost samples.
    if !(-0.5 - ROUNDING..=n as f64 - 0.5 + ROUNDING).contains(&position) {
        return None;
    }
    let position = position.clamp(0.0, (n - 1) as f64);
    let below = (position as usize).min(n - 2);
    Some((below, position - below as f64))
}

impl Surface for HeightMap {
    fn gap(&self, x: f64, y: f64) -> f64 {
        let ([nx, ny], [dx, dy], [cx, cy]) =
            (self.grid.shape(), self.grid.spacing(), self.grid.center());
        let (Some((i, s)), Some((j, t))) = (locate(x, cx, nx, dx), locate(y, cy, ny, dy)) else {
            return f64::INFINITY;
        };
        let at = |i: usize, j: usize| self.highest - self.heights[[i, j]];
        (1.0 - s) * ((1.0 - t) * at(i, j) + t * at(i, j + 1))
            + s * ((1.0 - t) * at(i + 1, j) + t * at(i + 1, j + 1))
    }

    fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
        if *grid == self.grid {
            return Ok(sampled(grid, |i, j| self.highest - self.heights[[i, j]]));
        }
        for (cell, sample) in grid.spacing().into_iter().zip(self.grid.spacing()) {
            if cell > 2.0 * sample * (1.0 + ROUNDING) {
                return Err(Error::Parameter {
                    name: "grid spacing",
                    requirement: "at most twice the spacing of the height map",
                    value: cell,
                });
            }
        }
        let (x, y) = (grid.x(), grid.y());
        Ok(sampled(grid, |i, j| self.gap(x[i], y[j])))
    }

    fn extent(&self) -> [Extent; 2] {
        let (center, size) = (self.grid.center(), self.grid.size());
        [0, 1].map(|k| Extent::CutOff([center[k] - 0.5 * size[k], center[k] + 0.5 * size[k]]))
    }

    fn grid(&self) -> Option<Grid> {
        Some(self.grid)
    }
}
