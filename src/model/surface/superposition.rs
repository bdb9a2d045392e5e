//! Sums of any number of shapes.

use ndarray::Array2;

use super::slope::{absent, of_part, part};
use super::{Extent, Surface};
use crate::error::{Error, Result};
use crate::model::grid::Grid;

/// A shape whose gap is the sum of the gaps of any number of shapes.
///
/// The shapes are evaluated one after the other, so that their number is limited by memory only.
///
/// ```
/// use nacre::{Paraboloid, Superposition, Surface};
/// let shapes = vec![Paraboloid::new(1e5, 1e5)?; 100_000];
/// let sum = Superposition::new(shapes)?;
/// assert!((sum.gap(1.0, 0.0) / 0.5 - 1.0).abs() < 1e-9);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Superposition<S>(Vec<S>);

impl<S> Superposition<S> {
    /// The sum of `shapes`.
    ///
    /// # Errors
    /// Where there is no shape.
    pub fn new(shapes: impl IntoIterator<Item = S>) -> Result<Self> {
        let shapes: Vec<S> = shapes.into_iter().collect();
        if shapes.is_empty() {
            return Err(Error::Inconsistent(
                "shapes must hold at least one shape to be added",
            ));
        }
        Ok(Self(shapes))
    }

    /// The shapes that are added.
    pub fn shapes(&self) -> &[S] {
        &self.0
    }
}

impl<S: Surface> Surface for Superposition<S> {
    fn gap(&self, x: f64, y: f64) -> f64 {
        self.0.iter().map(|shape| shape.gap(x, y)).sum()
    }

    fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
        let mut gaps = self.0[0].gaps(grid)?;
        for shape in &self.0[1..] {
            gaps += &shape.gaps(grid)?;
        }
        Ok(gaps)
    }

    fn extent(&self) -> [Extent; 2] {
        let extents = self.0.iter().map(Surface::extent);
        let both = extents.reduce(|[ax, ay], [bx, by]| [ax.and(bx), ay.and(by)]);
        both.unwrap_or([Extent::Endless; 2])
    }

    fn radii(&self) -> [f64; 2] {
        let radii = self.0.iter().map(Surface::radii);
        radii.fold([f64::INFINITY; 2], |[ax, ay], [bx, by]| {
            [ax.min(bx), ay.min(by)]
        })
    }

    fn grid(&self) -> Option<Grid> {
        self.0.iter().find_map(Surface::grid)
    }

    fn marks(&self) -> [Vec<f64>; 2] {
        let mut all = [Vec::new(), Vec::new()];
        for shape in &self.0 {
            for (all, marks) in all.iter_mut().zip(shape.marks()) {
                all.extend(marks);
            }
        }
        all.map(|mut marks| {
            marks.sort_by(f64::total_cmp);
            marks.dedup();
            marks
        })
    }

    /// Numbers of the only shape or, of several, each with the prefix `parts[k].`.
    fn parameters(&self) -> Vec<(String, f64)> {
        match &self.0[..] {
            [only] => only.parameters(),
            shapes => {
                let shapes = shapes.iter().enumerate();
                shapes
                    .flat_map(|(k, shape)| of_part(k, shape.parameters()))
                    .collect()
            }
        }
    }

    fn gap_derivative(&self, name: &str, grid: &Grid) -> Result<Array2<f64>> {
        match (&self.0[..], part(name)) {
            ([only], _) => only.gap_derivative(name, grid),
            (shapes, Some((k, name))) if k < shapes.len() => shapes[k].gap_derivative(name, grid),
            _ => Err(absent(name)),
        }
    }

    fn is_smooth(&self) -> bool {
        self.0.iter().all(Surface::is_smooth)
    }

    /// Direction of the shapes that have one; `None` where two differ.
    fn rolling_direction(&self) -> Option<[f64; 2]> {
        let mut directions = self.0.iter().filter_map(Surface::rolling_direction);
        let [x, y] = directions.next()?;
        directions
            .all(|other| (x - other[0]).hypot(y - other[1]) < f64::EPSILON)
            .then_some([x, y])
    }
}
