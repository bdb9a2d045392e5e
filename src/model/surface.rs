//! Undeformed shapes: the gap h(x, y) between a shape and the plane surface that it is pressed on.
//!
//! A gap of +∞ means "cannot touch". The approach is measured from the plane h = 0.

use std::fmt;
use std::sync::Arc;

use ndarray::Array2;

use crate::error::{Result, finite};
use crate::model::grid::Grid;
use crate::numerics::parallel::each_row;

mod counterpart;
mod extent;
mod height_map;
mod lifted;
mod limited;
mod profile;
mod quadric;
mod roller;
mod slope;
mod superposition;

pub use extent::Extent;
pub use height_map::HeightMap;
pub(crate) use lifted::Lifted;
pub(crate) use limited::Limited;
pub use profile::{CrownedProfile, FujiwaraKawase, LogarithmicProfile, Profile, SampledProfile};
pub use quadric::{Cylinder, FlatPunch, Paraboloid, Sphere};
pub use roller::Roller;
pub use superposition::Superposition;

/// Array of `value(i, j)` at the cells of a grid.
fn sampled(grid: &Grid, value: impl Fn(usize, usize) -> f64 + Sync) -> Array2<f64> {
    let [nx, ny] = grid.shape();
    let mut values = Array2::zeros((nx, ny));
    if let Some(values) = values.as_slice_mut() {
        each_row(values, ny, |i, row| {
            for (j, cell) in row.iter_mut().enumerate() {
                *cell = value(i, j);
            }
        });
    }
    values
}

/// An undeformed shape. [`Surface::gap`] is the only function that an implementation must have.
pub trait Surface: fmt::Debug + Send + Sync {
    /// Gap \[m\] to the plane z = 0 at (x, y) \[m\]; +∞ where the shape cannot touch; never NaN.
    fn gap(&self, x: f64, y: f64) -> f64;

    /// Gaps at the cells of `grid`, (nx, ny) \[m\]. They are taken at cell centres, unless the
    /// documentation of the shape says otherwise. On a thread of a plan, all threads of this plan
    /// are used.
    ///
    /// # Errors
    /// Where the grid does not suit the shape.
    fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
        let (x, y) = (grid.x(), grid.y());
        Ok(sampled(grid, |i, j| self.gap(x[i], y[j])))
    }

    /// Extents along x and along y.
    fn extent(&self) -> [Extent; 2] {
        [Extent::Rising; 2]
    }

    /// Coordinates along x and along y \[m\] through which the search for a grid looks at the shape,
    /// beside lines that it chooses itself: those of corners, steps and separate high places, such as
    /// the ends of lands. Between neighbouring coordinates the gap along the axis should have one
    /// lowest place at most. None by default; a shape whose contact has several parts should have them.
    fn marks(&self) -> [Vec<f64>; 2] {
        [Vec::new(), Vec::new()]
    }

    /// Smallest radii of curvature along x and along y \[m\]. nacre warns where the contact is not
    /// small compared with them. ∞ means that there is no such limit.
    fn radii(&self) -> [f64; 2] {
        [f64::INFINITY; 2]
    }

    /// The grid of a measured surface; `None` for other shapes.
    fn grid(&self) -> Option<Grid> {
        None
    }

    /// Unit vector along which the shape rolls: across the axis of a roller. Friction acts along it
    /// where no other direction is given. `None` for shapes that roll in any direction, or in none.
    fn rolling_direction(&self) -> Option<[f64; 2]> {
        None
    }

    /// Numbers of the shape on which its gaps depend smoothly, by name, with their values. None by default. Lengths at
    /// which a shape is cut off are not among them: cells join and leave there one by one.
    fn parameters(&self) -> Vec<(String, f64)> {
        Vec::new()
    }

    /// Derivative of [`Surface::gaps`] with respect to the number `name` of [`Surface::parameters`], (nx, ny); 0 where
    /// the gap is +∞.
    ///
    /// # Errors
    /// A name that is not in the list, and those of [`Surface::gaps`].
    ///
    /// ```
    /// use nacre::{Grid, Sphere, Surface};
    /// let (sphere, grid) = (Sphere::new(5.0)?, Grid::new([3, 3], [9.0, 9.0])?);
    /// assert_eq!(sphere.parameters(), [("radius".to_owned(), 5.0)]);
    /// // At x = 3: 1 − R/√(R² − x²) = 1 − 5/4.
    /// assert!((sphere.gap_derivative("radius", &grid)?[[2, 1]] + 0.25).abs() < 1e-15);
    /// # Ok::<(), nacre::Error>(())
    /// ```
    fn gap_derivative(&self, name: &str, grid: &Grid) -> Result<Array2<f64>> {
        let _ = grid;
        Err(slope::absent(name))
    }

    /// Whether gaps depend smoothly on where the shape lies. Default: yes.
    fn is_smooth(&self) -> bool {
        true
    }

    /// This shape, moved by (x, y) \[m\].
    ///
    /// # Errors
    /// Unless both are finite.
    fn shifted(self, x: f64, y: f64) -> Result<Shifted<Self>>
    where
        Self: Sized,
    {
        Ok(Shifted::by(
            self,
            [finite("x", x)? + 0.0, finite("y", y)? + 0.0],
        ))
    }

    /// The sum of this shape and `other`, for example of a sphere and a rough surface. Sums within sums
    /// are evaluated one within the other: for a long list of shapes, make a [`Superposition`].
    fn plus<S: Surface>(self, other: S) -> Sum<Self, S>
    where
        Self: Sized,
    {
        Sum(self, other)
    }
}

macro_rules! forward_surface {
    ($pointer:ty) => {
        impl<S: Surface + ?Sized> Surface for $pointer {
            fn gap(&self, x: f64, y: f64) -> f64 {
                (**self).gap(x, y)
            }
            fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
                (**self).gaps(grid)
            }
            fn extent(&self) -> [Extent; 2] {
                (**self).extent()
            }
            fn marks(&self) -> [Vec<f64>; 2] {
                (**self).marks()
            }
            fn radii(&self) -> [f64; 2] {
                (**self).radii()
            }
            fn grid(&self) -> Option<Grid> {
                (**self).grid()
            }
            fn rolling_direction(&self) -> Option<[f64; 2]> {
                (**self).rolling_direction()
            }
            fn parameters(&self) -> Vec<(String, f64)> {
                (**self).parameters()
            }
            fn gap_derivative(&self, name: &str, grid: &Grid) -> Result<Array2<f64>> {
                (**self).gap_derivative(name, grid)
            }
            fn is_smooth(&self) -> bool {
                (**self).is_smooth()
            }
        }
    };
}
forward_surface!(&S);
forward_surface!(Box<S>);
forward_surface!(Arc<S>);

/// Names of the shifts.
const SHIFTS: [&str; 2] = ["shift[0]", "shift[1]"];
/// Step of differences with respect to a shift, in cells.
const SHIFT_STEP: f64 = 0.02;

/// A shape that is moved in the plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Shifted<S> {
    shape: S,
    by: [f64; 2],
}

impl<S> Shifted<S> {
    /// A shape that is moved by `by` \[m\].
    pub(crate) fn by(shape: S, by: [f64; 2]) -> Self {
        Self { shape, by }
    }

    /// The shape, not moved.
    pub fn shape(&self) -> &S {
        &self.shape
    }

    /// Distances along x and y by which it is moved \[m\].
    pub fn shift(&self) -> [f64; 2] {
        self.by
    }
}

impl<S: Surface> Surface for Shifted<S> {
    fn gap(&self, x: f64, y: f64) -> f64 {
        self.shape.gap(x - self.by[0], y - self.by[1])
    }

    fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
        let [x, y] = grid.center();
        self.shape
            .gaps(&grid.centered_at([x - self.by[0], y - self.by[1]])?)
    }

    fn extent(&self) -> [Extent; 2] {
        let [x, y] = self.shape.extent();
        [x.shifted(self.by[0]), y.shifted(self.by[1])]
    }

    fn marks(&self) -> [Vec<f64>; 2] {
        let mut marks = self.shape.marks();
        for (marks, by) in marks.iter_mut().zip(self.by) {
            marks.iter_mut().for_each(|mark| *mark += by);
        }
        marks
    }

    fn radii(&self) -> [f64; 2] {
        self.shape.radii()
    }

    fn grid(&self) -> Option<Grid> {
        let grid = self.shape.grid()?;
        let [x, y] = grid.center();
        grid.centered_at([x + self.by[0], y + self.by[1]]).ok()
    }

    fn rolling_direction(&self) -> Option<[f64; 2]> {
        self.shape.rolling_direction()
    }

    /// The parameters of the shape, and its shifts where no end is cut off.
    fn parameters(&self) -> Vec<(String, f64)> {
        let mut parameters = self.shape.parameters();
        let extents = self.shape.extent();
        for (axis, name) in SHIFTS.into_iter().enumerate() {
            let moves = !matches!(extents[axis], Extent::CutOff(_) | Extent::Endless);
            if moves && self.shape.is_smooth() {
                parameters.push((name.to_owned(), self.by[axis]));
            }
        }
        parameters
    }

    fn gap_derivative(&self, name: &str, grid: &Grid) -> Result<Array2<f64>> {
        let [x, y] = grid.center();
        let listed = self.parameters().iter().any(|(one, _)| one == name);
        match SHIFTS.iter().position(|shift| *shift == name) {
            Some(axis) if listed => {
                // A small part of a cell, over which the slope of the shape hardly changes.
                let step = SHIFT_STEP * grid.spacing()[axis];
                slope::difference(self.by[axis], step, |by| {
                    let mut moved = self.by;
                    moved[axis] = by;
                    Shifted::by(&self.shape, moved).gaps(grid)
                })
            }
            _ => {
                let moved = grid.centered_at([x - self.by[0], y - self.by[1]])?;
                self.shape.gap_derivative(name, &moved)
            }
        }
    }

    fn is_smooth(&self) -> bool {
        self.shape.is_smooth()
    }
}

/// A shape whose gap is the sum of the gaps of two shapes.
#[derive(Debug, Clone, PartialEq)]
pub struct Sum<A, B>(A, B);

impl<A: Surface, B: Surface> Surface for Sum<A, B> {
    fn gap(&self, x: f64, y: f64) -> f64 {
        self.0.gap(x, y) + self.1.gap(x, y)
    }

    fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
        Ok(self.0.gaps(grid)? + self.1.gaps(grid)?)
    }

    fn extent(&self) -> [Extent; 2] {
        let ([ax, ay], [bx, by]) = (self.0.extent(), self.1.extent());
        [ax.and(bx), ay.and(by)]
    }

    fn marks(&self) -> [Vec<f64>; 2] {
        let ([ax, ay], [bx, by]) = (self.0.marks(), self.1.marks());
        [[ax, bx].concat(), [ay, by].concat()]
    }

    fn radii(&self) -> [f64; 2] {
        let ([ax, ay], [bx, by]) = (self.0.radii(), self.1.radii());
        [ax.min(bx), ay.min(by)]
    }

    fn grid(&self) -> Option<Grid> {
        self.0.grid().or_else(|| self.1.grid())
    }

    /// Numbers of the first shape, as `parts[0].…`, and of the second, as `parts[1].…`.
    fn parameters(&self) -> Vec<(String, f64)> {
        let mut parameters = slope::of_part(0, self.0.parameters());
        parameters.extend(slope::of_part(1, self.1.parameters()));
        parameters
    }

    fn gap_derivative(&self, name: &str, grid: &Grid) -> Result<Array2<f64>> {
        match slope::part(name) {
            Some((0, name)) => self.0.gap_derivative(name, grid),
            Some((1, name)) => self.1.gap_derivative(name, grid),
            _ => Err(slope::absent(name)),
        }
    }

    fn is_smooth(&self) -> bool {
        self.0.is_smooth() && self.1.is_smooth()
    }

    /// Direction of the part that has one, as that of a roller with roughness; `None` where two differ.
    fn rolling_direction(&self) -> Option<[f64; 2]> {
        match (self.0.rolling_direction(), self.1.rolling_direction()) {
            (Some([x, y]), Some(other)) => {
                let [dx, dy] = [x - other[0], y - other[1]];
                (dx.hypot(dy) < f64::EPSILON).then_some(other)
            }
            (one, other) => one.or(other),
        }
    }
}
