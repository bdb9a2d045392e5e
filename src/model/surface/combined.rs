//! Shapes made of other shapes: moved, added, raised, and cut off.

use ndarray::{Array2, Axis};

use super::{Extent, Surface, absent, difference};
use crate::error::{Error, Result};
use crate::model::grid::Grid;

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

    /// The grid as the shape sees it.
    fn own(&self, grid: &Grid) -> Result<Grid> {
        let [x, y] = grid.center();
        grid.centered_at([x - self.by[0], y - self.by[1]])
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
    fn base(&self) -> Option<&dyn Surface> {
        Some(&self.shape)
    }

    fn gap(&self, x: f64, y: f64) -> f64 {
        self.shape.gap(x - self.by[0], y - self.by[1])
    }

    fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
        self.shape.gaps(&self.own(grid)?)
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

    fn grid(&self) -> Option<Grid> {
        let grid = self.shape.grid()?;
        let [x, y] = grid.center();
        grid.centered_at([x + self.by[0], y + self.by[1]]).ok()
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
        let listed = self.parameters().iter().any(|(one, _)| one == name);
        match SHIFTS.iter().position(|shift| *shift == name) {
            Some(axis) if listed => {
                // A small part of a cell, over which the slope of the shape hardly changes.
                let step = SHIFT_STEP * grid.spacing()[axis];
                difference(self.by[axis], step, |by| {
                    let mut moved = self.by;
                    moved[axis] = by;
                    Shifted::by(&self.shape, moved).gaps(grid)
                })
            }
            _ => self.shape.gap_derivative(name, &self.own(grid)?),
        }
    }
}

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

    /// The sum of two shapes.
    pub(super) fn of_two(one: S, other: S) -> Self {
        Self(vec![one, other])
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
            shapes => (shapes.iter().enumerate())
                .flat_map(|(k, shape)| {
                    let numbers = shape.parameters().into_iter();
                    numbers.map(move |(name, value)| (format!("parts[{k}].{name}"), value))
                })
                .collect(),
        }
    }

    fn gap_derivative(&self, name: &str, grid: &Grid) -> Result<Array2<f64>> {
        if let [only] = &self.0[..] {
            return only.gap_derivative(name, grid);
        }
        let part = |name: &str| {
            let (number, name) = name.strip_prefix("parts[")?.split_once("].")?;
            let shape = self.0.get(number.parse::<usize>().ok()?)?;
            Some(shape.gap_derivative(name, grid))
        };
        part(name).unwrap_or_else(|| Err(absent(name)))
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

/// A shape plus a field on the cells of a grid, bilinear between cell centres and constant beyond the outer ones.
#[derive(Debug)]
pub(crate) struct Lifted<'a> {
    shape: &'a dyn Surface,
    grid: Grid,
    lift: Array2<f64>,
}

impl<'a> Lifted<'a> {
    pub(crate) fn new(shape: &'a dyn Surface, grid: &Grid, lift: Array2<f64>) -> Self {
        Self {
            shape,
            grid: *grid,
            lift,
        }
    }

    fn at(&self, x: f64, y: f64) -> f64 {
        let around = |axis: usize, at: f64| {
            let (n, spacing) = (self.grid.shape()[axis], self.grid.spacing()[axis]);
            let first = self.grid.center()[axis] - 0.5 * (n - 1) as f64 * spacing;
            let position = ((at - first) / spacing).clamp(0.0, (n - 1) as f64);
            let below = (position as usize).min(n.saturating_sub(2));
            (below, (below + 1).min(n - 1), position - below as f64)
        };
        let ((i, k, s), (j, l, t)) = (around(0, x), around(1, y));
        let along = |i: usize| self.lift[[i, j]] * (1.0 - t) + self.lift[[i, l]] * t;
        along(i) * (1.0 - s) + along(k) * s
    }
}

impl Surface for Lifted<'_> {
    fn base(&self) -> Option<&dyn Surface> {
        Some(self.shape)
    }

    fn gap(&self, x: f64, y: f64) -> f64 {
        self.shape.gap(x, y) + self.at(x, y)
    }

    fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
        let gaps = self.shape.gaps(grid)?;
        if *grid == self.grid {
            return Ok(gaps + &self.lift);
        }
        let (x, y) = (grid.x(), grid.y());
        let lift = Array2::from_shape_fn(gaps.dim(), |(i, j)| self.at(x[i], y[j]));
        Ok(gaps + lift)
    }
}

/// A shape within a range of x.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limited<'a> {
    shape: &'a dyn Surface,
    range: [f64; 2],
}

impl<'a> Limited<'a> {
    pub(crate) fn new(shape: &'a dyn Surface, range: [f64; 2]) -> Self {
        Self { shape, range }
    }

    fn is_within(&self, x: f64) -> bool {
        x >= self.range[0] && x <= self.range[1]
    }
}

impl Surface for Limited<'_> {
    fn base(&self) -> Option<&dyn Surface> {
        Some(self.shape)
    }

    fn gap(&self, x: f64, y: f64) -> f64 {
        if self.is_within(x) {
            self.shape.gap(x, y)
        } else {
            f64::INFINITY
        }
    }

    fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
        let mut gaps = self.shape.gaps(grid)?;
        for (x, mut row) in grid.x().iter().zip(gaps.axis_iter_mut(Axis(0))) {
            if !self.is_within(*x) {
                row.fill(f64::INFINITY);
            }
        }
        Ok(gaps)
    }

    fn extent(&self) -> [Extent; 2] {
        let [along_x, along_y] = self.shape.extent();
        [along_x.and(Extent::CutOff(self.range)), along_y]
    }
}
