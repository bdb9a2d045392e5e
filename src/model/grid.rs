//! Grids of rectangular cells. The pressure is uniform over each cell.

use std::fmt;
use std::ops::Range;

use ndarray::Array1;

use crate::error::{Error, Result, finite, positive, refuse_if, require};
use crate::model::data::value;
use crate::numerics::parallel::check_memory;

/// An axis of the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize), serde(try_from = "usize"))]
pub enum Axis {
    /// Along x.
    X,
    /// Along y.
    Y,
}

impl Axis {
    /// Both, x first.
    pub const ALL: [Self; 2] = [Self::X, Self::Y];

    /// 0 of x, 1 of y: its place in a pair such as [`Grid::spacing`].
    pub fn index(self) -> usize {
        self as usize
    }
}

impl TryFrom<usize> for Axis {
    type Error = Error;

    fn try_from(index: usize) -> Result<Self> {
        require("axis", index as f64, index < 2, "0 (x) or 1 (y)").map(|_| Self::ALL[index])
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(["x", "y"][self.index()])
    }
}

/// A uniform grid of `shape` cells over a rectangle of `size` around `center`.
///
/// ```text
/// x_i = center_x − lx/2 + (i + ½) dx,   dx = lx / nx        (y alike)
/// ```
///
/// ```
/// let grid = nacre::Grid::new([4, 2], [8.0, 2.0])?;
/// assert_eq!(grid.x().to_vec(), [-3.0, -1.0, 1.0, 3.0]);
/// assert_eq!(grid.spacing(), [2.0, 1.0]);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    shape: [usize; 2],
    size: [f64; 2],
    center: [f64; 2],
    plane_strain: bool,
    periodic: [bool; 2],
}

impl Grid {
    /// A grid of `[nx, ny]` cells over a rectangle of sides `[lx, ly]` \[m\] around the origin.
    ///
    /// # Errors
    /// Unless there are at least two cells in each direction, one array of them fits into memory,
    /// and the sides are finite and above 0.
    pub fn new(shape: [usize; 2], size: [f64; 2]) -> Result<Self> {
        for n in shape {
            let requirement = "at least 2 cells in each direction";
            require("shape", n as f64, n >= 2, requirement)?;
        }
        // A padded mesh has up to (2·9/8)² ≈ 5 times as many points of 16 bytes each, together below
        // 128 bytes a cell. This number of bytes must not overflow.
        let cells = shape[0].checked_mul(shape[1]);
        let holds = cells.and_then(|cells| cells.checked_mul(128)).is_some();
        let requirement = "a number of cells that this machine can count";
        require("shape", shape[0] as f64 * shape[1] as f64, holds, requirement)?;
        // At least one array of f64 must fit.
        check_memory(shape, 8 * shape[0] as u64 * shape[1] as u64)?;
        for length in size {
            positive("size", length)?;
            let holds = (1e-100..=1e100).contains(&length);
            let requirement =
                "between 1e-100 and 1e100, so that products of lengths do not overflow";
            require("size", length, holds, requirement)?;
        }
        Ok(Self { shape, size, center: [0.0; 2], plane_strain: false, periodic: [false; 2] })
    }

    /// A grid for line contact in plane strain: `cells` strips over `width` \[m\] along y, of
    /// infinite length along x.
    ///
    /// The shape of the grid is (1, `cells`). Loads are per unit length along x, so that forces are
    /// in \[N/m\]. In plane strain the displacement of an elastic half-space grows without limit
    /// with the distance. Displacements, approach and shifts are therefore relative to the surface of the
    /// bare substrate at a distance `width` from the load, whatever layers there are. Under a load this
    /// datum moves displacements, approach and shifts, and changes no pressure. Below stiff layers that are wider
    /// than the grid approach and shift cannot be prescribed, since they would fall as the load or force grows.
    ///
    /// # Errors
    /// Unless there are at least two cells, one array of them fits into memory, and `width` is
    /// finite and above 0.
    pub fn line(cells: usize, width: f64) -> Result<Self> {
        positive("width", width)?;
        let grid = Self::new([2, cells], [1.0, width])?;
        Ok(Self { shape: [1, cells], plane_strain: true, ..grid })
    }

    /// This grid, repeated along x, along y, or both: shape, pressure and displacement are periodic, with the sides of
    /// the rectangle as periods. Forces are those of one rectangle.
    ///
    /// Where both directions are periodic and no base is rigid, a mean pressure would displace the half-space without
    /// limit. Displacement is therefore relative to its mean, and the approach is that of the mean plane of the deformed
    /// surface. Where one direction is periodic, the datum is that of [`Grid::line`], with the width of the other one.
    ///
    /// # Errors
    /// On a grid for line contact.
    pub fn periodic(self, periodic: [bool; 2]) -> Result<Self> {
        refuse_if(
            self.plane_strain && periodic != [false; 2],
            "a grid for line contact must not be periodic: give a grid of two or more cells along x that is periodic \
                 along x",
        )?;
        Ok(Self { periodic, ..self })
    }

    /// Directions in which the grid repeats.
    pub fn is_periodic(&self) -> [bool; 2] {
        self.periodic
    }

    /// Periods along x and along y \[m\]; `None` where the grid does not repeat.
    pub(crate) fn periods(&self) -> [Option<f64>; 2] {
        [0, 1].map(|axis| self.periodic[axis].then_some(self.size[axis]))
    }

    /// Where a coordinate lies along an axis, in cells from the centre of the first.
    pub(crate) fn position(&self, axis: usize, coordinate: f64) -> f64 {
        (coordinate - self.center[axis]) / self.spacing()[axis]
            + 0.5 * (self.shape[axis] - 1) as f64
    }

    /// Indices of the cells whose centres are below and above a coordinate along an axis, and the weight of the latter; beyond
    /// the outermost centres theirs alone, unless the grid repeats.
    pub(crate) fn around(&self, axis: usize, coordinate: f64) -> ([usize; 2], f64) {
        let (n, position) = (self.shape[axis], self.position(axis, coordinate));
        if self.periodic[axis] {
            let below = position.floor();
            let index = below.rem_euclid(n as f64) as usize % n;
            return ([index, (index + 1) % n], position - below);
        }
        let position = position.clamp(0.0, (n - 1) as f64);
        let below = (position as usize).min(n.saturating_sub(2));
        ([below, (below + 1).min(n - 1)], position - below as f64)
    }

    /// Whether this is a grid for line contact in plane strain.
    pub fn is_line(&self) -> bool {
        self.plane_strain
    }

    /// This grid, moved to be centred at `center` \[m\].
    ///
    /// # Errors
    /// Unless `center` is finite.
    pub fn centered_at(self, center: [f64; 2]) -> Result<Self> {
        finite("center", center[0])?;
        finite("center", center[1])?;
        // Adding 0.0 turns −0.0 into 0.0: equal values then print alike.
        Ok(Self { center: center.map(|c| c + 0.0), ..self })
    }

    /// An error unless a solution to start from, if there is one, is on this grid.
    pub(crate) fn check_initial(&self, other: Option<&Self>) -> Result<()> {
        match other {
            None => Ok(()),
            Some(other) if other == self => Ok(()),
            Some(other) => Err(Error::OtherGrid { expected: self.words(), found: other.words() }),
        }
    }

    fn words(&self) -> String {
        let ([nx, ny], [lx, ly], [x, y]) = (self.shape, self.size, self.center);
        let repeats = match self.periodic {
            [false, false] => "",
            [true, false] => ", periodic along x",
            [false, true] => ", periodic along y",
            [true, true] => ", periodic along x and y",
        };
        match self.plane_strain {
            true => format!("a line of {ny} cells over {ly:e} around {y:e}"),
            false => {
                format!("{nx} x {ny} cells over ({lx:e}, {ly:e}) around ({x:e}, {y:e}){repeats}")
            }
        }
    }

    /// Unit vector along which a contact on this grid rolls: across the strips of a line contact. `None`
    /// for other grids, where it is a matter of the shape.
    pub(crate) fn rolling_direction(&self) -> Option<[f64; 2]> {
        self.plane_strain.then_some([0.0, 1.0])
    }

    /// Numbers of cells `[nx, ny]`.
    pub fn shape(&self) -> [usize; 2] {
        self.shape
    }

    /// Side lengths `[lx, ly]` of the rectangle \[m\].
    pub fn size(&self) -> [f64; 2] {
        self.size
    }

    /// Centre of the rectangle \[m\].
    pub fn center(&self) -> [f64; 2] {
        self.center
    }

    /// Side lengths of a cell `[dx, dy]` \[m\].
    pub fn spacing(&self) -> [f64; 2] {
        [self.size[0] / self.shape[0] as f64, self.size[1] / self.shape[1] as f64]
    }

    /// Area of a cell \[m²\].
    pub fn cell_area(&self) -> f64 {
        let [dx, dy] = self.spacing();
        dx * dy
    }

    /// Coordinates of cell centres along x, (nx,) \[m\].
    pub fn x(&self) -> Array1<f64> {
        self.coordinates(0)
    }

    /// Coordinates of cell centres along y, (ny,) \[m\].
    pub fn y(&self) -> Array1<f64> {
        self.coordinates(1)
    }

    /// A grid with the offsets of `cells` cells along x and y of this one, for coefficients that do not depend on where a
    /// grid ends; where they do, in line contacts and where a grid repeats, this grid.
    pub(crate) fn of_offsets(&self, cells: [usize; 2]) -> Self {
        if self.is_line() || self.is_periodic() != [false; 2] {
            return *self;
        }
        let [dx, dy] = self.spacing();
        let size = [cells[0] as f64 * dx, cells[1] as f64 * dy];
        Self::new(cells, size).unwrap_or(*self)
    }

    /// A grid with the same centre, along axes that have a pair (wider, larger) about 2^wider times as wide, with cells
    /// 2^larger times as large.
    pub(crate) fn widened(&self, powers: [Option<(usize, usize)>; 2]) -> Result<Self> {
        let wide = |axis: usize| {
            let (cells, spacing) = (self.shape[axis], self.spacing()[axis]);
            powers[axis].map_or((cells, self.size[axis]), |(wider, larger)| {
                let [wider, larger] = [wider, larger].map(|power| (power as f64).exp2());
                let within = (cells as f64 / larger).ceil();
                // The same parity, so that centres coincide where cells are as large.
                let cells = within + 2.0 * (0.5 * (wider - 1.0) / larger * cells as f64).ceil();
                (cells as usize, larger * spacing * cells)
            })
        };
        let [(nx, lx), (ny, ly)] = [wide(0), wide(1)];
        let grid = match self.is_line() {
            true => Self::line(ny, ly)?,
            false => Self::new([nx, ny], [lx, ly])?,
        };
        grid.periodic(self.periodic)?.centered_at(self.center)
    }

    /// The grid whose cells are twice as long along the axes that are `halved`; it starts where this one does.
    ///
    /// # Errors
    /// As [`Grid::new`].
    pub(crate) fn coarser(&self, halved: [bool; 2]) -> Result<Self> {
        let (shape, spacing) = (self.shape, self.spacing());
        let cells = [0, 1].map(|k| if halved[k] { shape[k].div_ceil(2) } else { shape[k] });
        let longer = halved.map(|halved| if halved { 2.0 } else { 1.0 });
        let sides = [0, 1].map(|k| longer[k] * spacing[k] * cells[k] as f64);
        let grown = [0, 1].map(|k| 0.5 * (sides[k] - self.size[k]));
        let grid = match self.is_line() {
            true => Self::line(cells[1], sides[1])?,
            false => Self::new(cells, sides)?.periodic(self.periodic)?,
        };
        grid.centered_at([0, 1].map(|k| self.center[k] + grown[k]))
    }

    /// Whether a point lies in the grid.
    pub(crate) fn holds(&self, point: [f64; 2]) -> bool {
        (0..2).all(|axis| (point[axis] - self.center[axis]).abs() < 0.5 * self.size[axis])
    }

    /// Coordinates of cell centres along `axis`. They are computed from the centre of the grid, so
    /// that they are exactly symmetric about it.
    pub(crate) fn coordinates(&self, axis: usize) -> Array1<f64> {
        Array1::from_shape_fn(self.shape[axis], |i| self.coordinate(axis, i))
    }

    /// The coordinate of one cell centre along `axis`.
    pub(crate) fn coordinate(&self, axis: usize, cell: usize) -> f64 {
        let middle = 0.5 * (self.shape[axis] - 1) as f64;
        self.center[axis] + (cell as f64 - middle) * self.spacing()[axis]
    }
}

value! {
    // A line has one cell along x.
    Grid by GridData {
        shape: [usize; 2] = of.shape();
        size: [f64; 2] = of.size();
        #[serde(default)]
        center: [f64; 2] = of.center();
        #[serde(default, skip_serializing_if = "crate::model::data::is_default")]
        periodic: [bool; 2] = of.is_periodic();
    }
    of, fields => {
        let grid = match fields.shape {
            [1, cells] => Self::line(cells, fields.size[1])?,
            shape => Self::new(shape, fields.size)?,
        };
        grid.centered_at(fields.center)?.periodic(fields.periodic)
    }
}

/// A rectangle of cells of a grid: rows i0..i1 and columns j0..j1.
pub(crate) type Window = [Range<usize>; 2];

/// The cells of a window, row by row.
pub(crate) fn each_cell(window: &Window) -> impl Iterator<Item = (usize, usize)> + use<> {
    let [rows, columns] = window.clone();
    rows.flat_map(move |i| columns.clone().map(move |j| (i, j)))
}

/// Directions along which a window of a grid is a whole period.
pub(crate) fn repeating(grid: &Grid, window: &Window) -> [bool; 2] {
    let (shape, periodic) = (grid.shape(), grid.is_periodic());
    [0, 1].map(|k| periodic[k] && window[k].len() == shape[k])
}

/// The window of all cells of a grid of `shape`.
pub(crate) fn full_window(shape: [usize; 2]) -> Window {
    shape.map(|n| 0..n)
}
