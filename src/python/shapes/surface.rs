//! Shapes of Python as surfaces: those of the kinds that they hold.

use ndarray::Array2;

use super::base::Shape;
use crate::error::Result;
use crate::model::grid::Grid;
use crate::model::surface::{Extent, Surface};

impl Surface for Shape {
    fn gap(&self, x: f64, y: f64) -> f64 {
        self.with(|shape| shape.gap(x, y))
    }
    fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
        self.with(|shape| shape.gaps(grid))
    }
    fn extent(&self) -> [Extent; 2] {
        self.with(|shape| shape.extent())
    }
    fn marks(&self) -> [Vec<f64>; 2] {
        self.with(|shape| shape.marks())
    }
    fn radii(&self) -> [f64; 2] {
        self.with(|shape| shape.radii())
    }
    fn endless_crown(&self) -> Option<[f64; 2]> {
        self.with(|shape| shape.endless_crown())
    }
    fn grid(&self) -> Option<Grid> {
        self.with(|shape| shape.grid())
    }
    fn rolling_direction(&self) -> Option<[f64; 2]> {
        self.with(|shape| shape.rolling_direction())
    }
    fn parameters(&self) -> Vec<(String, f64)> {
        self.with(|shape| shape.parameters())
    }
    fn gap_derivative(&self, name: &str, grid: &Grid) -> Result<Array2<f64>> {
        self.with(|shape| shape.gap_derivative(name, grid))
    }
    fn alternatives(&self) -> Vec<Box<dyn Surface + '_>> {
        self.with(Surface::alternatives)
    }
    fn is_smooth(&self) -> bool {
        self.with(|shape| shape.is_smooth())
    }
}
