//! Undeformed shapes: the gap h(x, y) between a shape and the plane surface that it is pressed on.
//!
//! A gap of +∞ means "cannot touch". The approach is measured from the plane h = 0.

mod height_map;
mod profile;
mod quadric;
mod roller;

use std::fmt;
use std::ops::Deref;

use ndarray::{Array2, Axis};

use crate::error::{Error, Result, finite, refuse_if};
use crate::model::grid::Grid;
use crate::numerics::layout::slice_mut;
use crate::numerics::parallel::each_row;

pub use profile::{CrownedProfile, FujiwaraKawase, LogarithmicProfile, Profile, SampledProfile};
pub use shapes::*;

/// The shapes, which the root of the crate names, too.
pub(crate) mod shapes {
    pub use super::height_map::HeightMap;
    pub use super::quadric::{Cylinder, FlatPunch, Paraboloid, Sphere};
    pub use super::roller::Roller;
}

/// Array of `value(i, j)` at the cells of a grid.
fn sampled(grid: &Grid, value: impl Fn(usize, usize) -> f64 + Sync) -> Array2<f64> {
    let [nx, ny] = grid.shape();
    let mut values = Array2::zeros((nx, ny));
    each_row(slice_mut(&mut values), ny, |i, row| {
        for (j, cell) in row.iter_mut().enumerate() {
            *cell = value(i, j);
        }
    });
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

    /// Shape that this one changes: what this one does not define itself, apart from gaps and parameters, is that of
    /// the base. `None` by default.
    fn base(&self) -> Option<&dyn Surface> {
        None
    }

    /// Extents along x and along y. By default those of the base or, also for a gap that levels off,
    /// [`Extent::Rising`].
    fn extent(&self) -> [Extent; 2] {
        self.base().map_or([Extent::Rising; 2], Surface::extent)
    }

    /// Coordinates along x and along y \[m\] through which the search for a grid looks at the shape,
    /// beside lines that it chooses itself: those of corners, steps and separate high places, such as
    /// the ends of lands. Between neighbouring coordinates the gap along the axis should have one
    /// lowest place at most. None by default; a shape whose contact has several parts should have them.
    fn marks(&self) -> [Vec<f64>; 2] {
        self.base().map_or_else(Default::default, Surface::marks)
    }

    /// Smallest radii of curvature along x and along y \[m\]. nacre warns where the contact is not
    /// small compared with them. ∞ means that there is no such limit.
    fn radii(&self) -> [f64; 2] {
        self.base().map_or([f64::INFINITY; 2], Surface::radii)
    }

    /// Range of x \[m\] over which a roller is straight whose ends only a crown rounds, and which has no length; `None` for
    /// other shapes. nacre warns where such a roller is loaded on its crown alone.
    fn endless_crown(&self) -> Option<[f64; 2]> {
        self.base()?.endless_crown()
    }

    /// The grid of a measured surface; `None` for other shapes.
    fn grid(&self) -> Option<Grid> {
        self.base()?.grid()
    }

    /// Unit vector along which the shape rolls: across the axis of a roller. Friction acts along it
    /// where no other direction is given. `None` for shapes that roll in any direction, or in none.
    fn rolling_direction(&self) -> Option<[f64; 2]> {
        self.base()?.rolling_direction()
    }

    /// Whether the shape is a body of revolution about the z axis. False by default.
    fn is_round(&self) -> bool {
        false
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
        Err(absent(name))
    }

    /// Other shapes that a measurement of this one may mean, as curves through its stations. A solution is compared with
    /// those of them: the differences are part of its discretisation errors. None by default.
    fn alternatives(&self) -> Vec<Box<dyn Surface + '_>> {
        Vec::new()
    }

    /// Whether gaps depend smoothly on where the shape lies. Default: yes.
    fn is_smooth(&self) -> bool {
        self.base().is_none_or(Surface::is_smooth)
    }

    /// This shape, moved by (x, y) \[m\].
    ///
    /// # Errors
    /// Unless both are finite.
    fn shifted(self, x: f64, y: f64) -> Result<Shifted<Self>>
    where
        Self: Sized,
    {
        Ok(Shifted::by(self, [finite("x", x)? + 0.0, finite("y", y)? + 0.0]))
    }

    /// The sum of this shape and `other`, for example of a sphere and a rough surface. For a long list of shapes,
    /// make a [`Superposition`].
    fn plus<'a, S: Surface + 'a>(self, other: S) -> Superposition<Box<dyn Surface + 'a>>
    where
        Self: Sized + 'a,
    {
        Superposition::of_two(Box::new(self), Box::new(other))
    }
}

impl<P> Surface for P
where
    P: Deref<Target: Surface> + fmt::Debug + Send + Sync,
{
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

    fn endless_crown(&self) -> Option<[f64; 2]> {
        (**self).endless_crown()
    }

    fn grid(&self) -> Option<Grid> {
        (**self).grid()
    }

    fn rolling_direction(&self) -> Option<[f64; 2]> {
        (**self).rolling_direction()
    }

    fn is_round(&self) -> bool {
        (**self).is_round()
    }

    fn parameters(&self) -> Vec<(String, f64)> {
        (**self).parameters()
    }

    fn gap_derivative(&self, name: &str, grid: &Grid) -> Result<Array2<f64>> {
        (**self).gap_derivative(name, grid)
    }

    fn alternatives(&self) -> Vec<Box<dyn Surface + '_>> {
        (**self).alternatives()
    }

    fn is_smooth(&self) -> bool {
        (**self).is_smooth()
    }
}

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

    fn endless_crown(&self) -> Option<[f64; 2]> {
        self.shape.endless_crown().map(|flat| flat.map(|x| x + self.by[0]))
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

    fn alternatives(&self) -> Vec<Box<dyn Surface + '_>> {
        let others = self.shape.alternatives().into_iter();
        others.map(|shape| Box::new(Shifted::by(shape, self.by)) as Box<_>).collect()
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
        refuse_if(shapes.is_empty(), "shapes must hold at least one shape to be added")?;
        Ok(Self(shapes))
    }

    /// The sum of two shapes.
    fn of_two(one: S, other: S) -> Self {
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
        radii.fold([f64::INFINITY; 2], |[ax, ay], [bx, by]| [ax.min(bx), ay.min(by)])
    }

    fn endless_crown(&self) -> Option<[f64; 2]> {
        self.0.iter().find_map(Surface::endless_crown)
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

    fn is_round(&self) -> bool {
        matches!(&self.0[..], [only] if only.is_round())
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

    /// Sums of the alternatives of all shapes with the same number; shapes with fewer keep the last.
    fn alternatives(&self) -> Vec<Box<dyn Surface + '_>> {
        let most = self.0.iter().map(|shape| shape.alternatives().len()).max().unwrap_or(0);
        let other = |number: usize| {
            let shapes = self.0.iter().map(|shape| alternative(shape, number)).collect();
            Box::new(Superposition(shapes)) as Box<_>
        };
        (0..most).map(other).collect()
    }

    fn is_smooth(&self) -> bool {
        self.0.iter().all(Surface::is_smooth)
    }

    /// Direction of the shapes that have one; `None` where two differ.
    fn rolling_direction(&self) -> Option<[f64; 2]> {
        let mut directions = self.0.iter().filter_map(Surface::rolling_direction);
        let [x, y] = directions.next()?;
        directions.all(|other| (x - other[0]).hypot(y - other[1]) < f64::EPSILON).then_some([x, y])
    }
}

/// The alternative of `shape` with this number, or the last; the shape itself where it has none.
fn alternative<S: Surface>(shape: &S, number: usize) -> Box<dyn Surface + '_> {
    let mut others = shape.alternatives();
    match others.len() {
        0 => Box::new(shape),
        count => others.swap_remove(number.min(count - 1)),
    }
}

/// The extent of a shape along one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Extent {
    /// A shape whose gap increases without limit in both directions.
    Rising,
    /// A shape whose gap is constant along the axis, so that the contact has no end.
    Endless,
    /// A shape whose gap repeats along the axis with this period \[m\].
    Repeating(f64),
    /// A shape that ends smoothly at these coordinates \[m\], as a sphere; the gap is +∞ beyond.
    Within([f64; 2]),
    /// A shape that is cut off at these coordinates \[m\], as a roller by its faces or a height map
    /// by its rim. The gap is +∞ beyond, and a contact that reaches an end has a sharp edge there.
    CutOff([f64; 2]),
}

impl Extent {
    /// Range of coordinates in which the gap can be finite.
    pub fn range(&self) -> [f64; 2] {
        match *self {
            Self::Rising | Self::Endless | Self::Repeating(_) => [f64::NEG_INFINITY, f64::INFINITY],
            Self::Within(range) | Self::CutOff(range) => range,
        }
    }

    /// An error unless a grid with this period along `axis` repeats as the shape does.
    pub(crate) fn check_period(&self, axis: usize, grid: Option<f64>) -> Result<()> {
        let Self::Repeating(period) = *self else {
            return Ok(());
        };
        let times = grid.map_or(0.0, |size| size / period);
        // Rounding of sides that are products of spacings.
        match times >= 0.5 && (times - times.round()).abs() <= 1e-9 * times {
            true => Ok(()),
            false => Err(Error::Period { axis: ["x", "y"][axis], period, grid }),
        }
    }

    pub(super) fn shifted(self, by: f64) -> Self {
        match self {
            Self::Within([a, b]) => Self::Within([a + by, b + by]),
            Self::CutOff([a, b]) => Self::CutOff([a + by, b + by]),
            other => other,
        }
    }

    /// Extent of the sum of two shapes, and of a shape within a range.
    pub(super) fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Endless, other) | (other, Self::Endless) => other,
            // The period of the sum, where one is a multiple of the other.
            (Self::Repeating(a), Self::Repeating(b)) => Self::Repeating(a.max(b)),
            (a, b) => {
                let ([a0, a1], [b0, b1]) = (a.range(), b.range());
                let range = [a0.max(b0), a1.min(b1)];
                match (a, b) {
                    (Self::CutOff(_), _) | (_, Self::CutOff(_)) => Self::CutOff(range),
                    (Self::Within(_), _) | (_, Self::Within(_)) => Self::Within(range),
                    _ => Self::Rising,
                }
            }
        }
    }
}

/// Step of differences, relative to the number: gaps are analytic in it, so that the sixth-order formula leaves some
/// 1e-18 of the derivative, and rounding 1e-13.
const STEP: f64 = 1e-3;

/// Weights of the central difference of sixth order at one, two and three steps, per step.
const WEIGHTS: [f64; 3] = [0.75, -0.15, 1.0 / 60.0];

/// Derivative of `values(θ)` at θ = `value` by central differences of sixth order, for values that are analytic.
pub(super) fn difference(
    value: f64,
    step: f64,
    values: impl Fn(f64) -> Result<Array2<f64>>,
) -> Result<Array2<f64>> {
    let mut sum: Option<Array2<f64>> = None;
    for (k, weight) in (1..=3).zip(WEIGHTS) {
        let away = f64::from(k) * step;
        let mut change = values(value + away)?;
        // +∞ at both places leaves no number: such cells never touch.
        change.zip_mut_with(&values(value - away)?, |a, b| {
            let d = (*a - b) * (weight / step);
            *a = if d.is_finite() { d } else { 0.0 };
        });
        sum = Some(match sum {
            None => change,
            Some(sum) => sum + change,
        });
    }
    Ok(sum.unwrap_or_default())
}

/// [`difference`] with a step for numbers other than 0.
pub(super) fn by_difference(
    value: f64,
    values: impl Fn(f64) -> Result<Array2<f64>>,
) -> Result<Array2<f64>> {
    difference(value, STEP * value.abs(), values)
}

/// ∂(R − √(R² − s))/∂R = 1 − R/√(R² − s), without cancellation; 0 where s ≥ R².
pub(super) fn sagitta_slope(radius: f64, s: f64) -> f64 {
    let under = radius * radius - s;
    if under <= 0.0 {
        return 0.0;
    }
    let root = under.sqrt();
    -s / (root * (radius + root))
}

/// The error for a name that is not among a shape's parameters.
pub(super) fn absent(name: &str) -> Error {
    Error::Choice {
        name: "parameter of the shape",
        requirement: "one of those that its parameters() lists: numbers on which the gap depends smoothly",
        value: name.to_owned(),
    }
}

/// A shape plus a field on the cells of a grid, bilinear between cell centres; it repeats where the grid does, and is constant
/// beyond the outer ones elsewhere.
#[derive(Debug)]
pub(crate) struct OffsetShape<S> {
    shape: S,
    grid: Grid,
    lift: Array2<f64>,
}

impl<S: Surface> OffsetShape<S> {
    pub(crate) fn new(shape: S, grid: &Grid, lift: Array2<f64>) -> Self {
        Self { shape, grid: *grid, lift }
    }

    fn at(&self, x: f64, y: f64) -> f64 {
        let ([i, k], s) = self.grid.around(0, x);
        let ([j, l], t) = self.grid.around(1, y);
        let along = |i: usize| self.lift[[i, j]] * (1.0 - t) + self.lift[[i, l]] * t;
        along(i) * (1.0 - s) + along(k) * s
    }
}

impl<S: Surface> Surface for OffsetShape<S> {
    fn base(&self) -> Option<&dyn Surface> {
        Some(&self.shape)
    }

    fn alternatives(&self) -> Vec<Box<dyn Surface + '_>> {
        let others = self.shape.alternatives().into_iter();
        let offset = |shape| OffsetShape::new(shape, &self.grid, self.lift.clone());
        others.map(|shape| Box::new(offset(shape)) as Box<_>).collect()
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
pub(crate) struct ShapeInRange<'a> {
    shape: &'a dyn Surface,
    range: [f64; 2],
}

impl<'a> ShapeInRange<'a> {
    pub(crate) fn new(shape: &'a dyn Surface, range: [f64; 2]) -> Self {
        Self { shape, range }
    }

    fn is_within(&self, x: f64) -> bool {
        x >= self.range[0] && x <= self.range[1]
    }
}

impl Surface for ShapeInRange<'_> {
    fn base(&self) -> Option<&dyn Surface> {
        Some(self.shape)
    }

    fn gap(&self, x: f64, y: f64) -> f64 {
        if self.is_within(x) { self.shape.gap(x, y) } else { f64::INFINITY }
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
