//! Stress and displacement below the surface, under the pressure of a contact and its friction.
//!
//! ```text
//! σ[i, j] = Σ_kl K[i−k, j−l; z] p[k, l]
//! ```
//!
//! at depth z, where K are influence coefficients without aliasing: closed forms of a half-space of
//! the material at that depth, and exact transforms of what the layers add. Both fall off as they
//! do in an endless body, so that a larger domain changes nothing, and the error does not depend on
//! how deep or how thick a layer is: it is below 1e-8 of the pressure (`tests/stress_*.rs`). What is
//! left is what pressure is within a cell. [`stress`] takes it as uniform. In a solved contact
//! ([`Solution::stress`](crate::Solution::stress)) it is parabolic inside, and near a smooth edge
//! the root of a polynomial, which cells farther inside tell; where they do not, it stays uniform.
//! Tractions at the surface stay those of the solution's pressure, and displacements are of uniform
//! cells.
//!
//! Sliding adds the traction q = μ p along a direction; it does not act back on the pressure. That
//! holds where the bodies are alike (the same elastic constants), where ν = ½, or where μ is small:
//! the coupling that is left out changes the pressure by the order of μ (1 − 2ν)/(2 − 2ν).

use std::ops::ControlFlow;

use ndarray::{Array1, Array3, ArrayRef2};

use crate::body::HalfSpace;
use crate::error::{Error, Result, finite};
use crate::grid::Grid;
use crate::parallel::check_memory;
use crate::response::interior::Place;

mod depths;
mod derived;
mod friction;
mod loaded;
mod member;
mod section;
mod subcell;
mod summary;

pub use derived::Peak;
pub use member::Member;
pub use summary::{InterfaceSummary, LayerSummary, Limits, StressSummary};

use crate::kernel::loads::COMPONENTS;
use friction::friction;
use loaded::{Form, Loaded};
use section::{Lines, place};

/// Which side of an interface a depth is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Side {
    /// In the layer above.
    Above,
    /// In the layer below, or the substrate.
    #[default]
    Below,
}

/// Where on a plane at some depth fields are kept.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Section {
    /// Everywhere.
    #[default]
    Plane,
    /// On the line x = const, by linear interpolation between cell centres.
    X(f64),
    /// On the line y = const.
    Y(f64),
    /// At the point (x, y).
    Axis([f64; 2]),
}

/// What is evaluated beside the depths.
#[derive(Debug, Clone, PartialEq)]
pub struct StressOptions {
    /// Side of an interface, for depths that lie on one. Default: below.
    pub side: Side,
    /// Where fields are kept. Default: on whole planes.
    pub section: Section,
    /// Coefficient of friction μ. Default: 0.
    pub friction: f64,
    /// Direction of the traction that acts on the body, of any length. Default: along x.
    pub direction: [f64; 2],
    /// Residual stress \[Pa\], equal in x and y, of each layer from the surface down and of the
    /// substrate; those that are left out have none. It is added to σ_xx and σ_yy. Default: none.
    pub residual: Vec<f64>,
    /// Whether displacements are evaluated too. Default: no.
    pub displacement: bool,
    /// Threads. Default: all of the machine's.
    pub threads: Option<usize>,
}

impl Default for StressOptions {
    fn default() -> Self {
        Self {
            side: Side::default(),
            section: Section::default(),
            friction: 0.0,
            direction: [1.0, 0.0],
            residual: Vec::new(),
            displacement: false,
            threads: None,
        }
    }
}

/// Is told what part of the work is done, from 0 to 1, and breaks to stop.
pub type StressProgress<'a> = dyn FnMut(f64) -> ControlFlow<()> + 'a;

/// Stress at some depths. Arrays are (depths, nx, ny); on a section nx or ny is 1. Tension is
/// positive.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Stress {
    /// Depths z \[m\].
    pub z: Array1<f64>,
    /// Coordinates x \[m\].
    pub x: Array1<f64>,
    /// Coordinates y \[m\].
    pub y: Array1<f64>,
    /// The body.
    pub body: HalfSpace,
    /// The side of an interface that was asked for.
    pub side: Side,
    /// μ times the unit vector of the traction that acts on the body.
    pub friction: [f64; 2],
    /// σ_xx, σ_yy, σ_zz, σ_xy, σ_yz, σ_xz \[Pa\], in this order.
    pub components: [Array3<f64>; 6],
    /// u_x, u_y, u_z \[m\], where they were asked for; in line contact relative to the substrate's
    /// surface at a distance of the grid's width, as all displacements there.
    pub displacement: Option<[Array3<f64>; 3]>,
}

impl Stress {
    /// From its parts, of which fields are (depths, nx, ny).
    ///
    /// # Errors
    /// Where the shapes do not agree.
    pub fn from_fields(
        [z, x, y]: [Array1<f64>; 3],
        body: HalfSpace,
        side: Side,
        friction: [f64; 2],
        components: [Array3<f64>; 6],
        displacement: Option<[Array3<f64>; 3]>,
    ) -> Result<Self> {
        let shape = (z.len(), x.len(), y.len());
        let fields = components.iter().chain(displacement.iter().flatten());
        if fields.into_iter().any(|field| field.dim() != shape) {
            return Err(Error::Inconsistent(
                "fields must be of the shape of their depths and coordinates",
            ));
        }
        Ok(Self {
            z,
            x,
            y,
            body,
            side,
            friction,
            components,
            displacement,
        })
    }
}

/// Stress of `body` at `depths` under `pressure` (nx, ny) \[Pa\] on `grid`, uniform over a cell;
/// [`Solution::stress`](crate::Solution::stress) knows that of a contact within cells.
///
/// # Errors
/// Bad input, or too little memory.
///
/// ```
/// use ndarray::array;
/// use nacre::{Elastic, Grid, StressOptions, stress};
/// // Under the middle of a uniformly loaded square of side 2: Love (1929).
/// let grid = Grid::new([2, 2], [2.0, 2.0])?;
/// let pressure = array![[1.0, 1.0], [1.0, 1.0]];
/// let options = StressOptions { section: nacre::Section::Y(0.0), ..StressOptions::default() };
/// let field = stress(&Elastic::new(1.0, 0.3)?.into(), &grid, &pressure, &[0.0, 1.0], &options)?;
/// assert!((field.components[2][[0, 0, 0]] + 1.0).abs() < 1e-12);
/// assert!(field.components[2][[1, 0, 0]] > -0.7);
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn stress(
    body: &HalfSpace,
    grid: &Grid,
    pressure: &ArrayRef2<f64>,
    depths: &[f64],
    options: &StressOptions,
) -> Result<Stress> {
    let mut go_on = |_| ControlFlow::Continue(());
    stress_watched(body, grid, pressure, depths, options, &mut go_on)
}

/// [`stress`], telling `progress` how far it is; its break ends with the depths that are done.
///
/// # Errors
/// As [`stress`].
pub fn stress_watched(
    body: &HalfSpace,
    grid: &Grid,
    pressure: &ArrayRef2<f64>,
    depths: &[f64],
    options: &StressOptions,
    progress: &mut StressProgress,
) -> Result<Stress> {
    watched(
        body,
        grid,
        pressure,
        Form::Uniform,
        depths,
        options,
        progress,
    )
}

/// [`stress_watched`] under a pressure of either form.
fn watched(
    body: &HalfSpace,
    grid: &Grid,
    pressure: &ArrayRef2<f64>,
    form: Form,
    depths: &[f64],
    options: &StressOptions,
    progress: &mut StressProgress,
) -> Result<Stress> {
    let places = depths
        .iter()
        .map(|&z| place(body, z, options.side))
        .collect::<Result<Vec<_>>>()?;
    let lines = Lines::new(grid, options.section)?;
    let fields = if options.displacement { COMPONENTS } else { 6 };
    let [ox, oy] = lines.shape;
    check_memory(
        grid.shape(),
        8 * (depths.len() * ox * oy * fields) as u64 + Loaded::memory(grid, form, options),
    )?;
    let residual = residual(body, &options.residual)?;
    let friction = friction(body, options)?;
    let mut go_on = || progress(0.0) == ControlFlow::Continue(());
    let loaded = Loaded::new(body, grid, pressure, form, options, &mut go_on)?;
    let cells = ox * oy;
    let mut kept = zeros(fields, depths.len() * cells);
    let done = match &loaded {
        Some(loaded) => evaluate(
            loaded, grid, &lines, &places, &residual, &mut kept, progress,
        ),
        // It was stopped.
        None => 0,
    };
    let mut arrays = kept.into_iter().map(|mut values| {
        values.truncate(done * cells);
        Array3::from_shape_vec((done, ox, oy), values).unwrap_or_else(|_| Array3::zeros((0, 0, 0)))
    });
    let mut next = || arrays.next().unwrap_or_default();
    let components = std::array::from_fn(|_| next());
    let displacement = options
        .displacement
        .then(|| std::array::from_fn(|_| next()));
    Ok(Stress {
        z: depths[..done].to_vec().into(),
        x: lines.x,
        y: lines.y,
        body: body.clone(),
        side: options.side,
        friction,
        components,
        displacement,
    })
}

/// Fields of zeros. Each by itself: a copy would touch its memory, here and on one thread.
fn zeros(fields: usize, length: usize) -> Vec<Vec<f64>> {
    (0..fields).map(|_| vec![0.0; length]).collect()
}

/// Evaluates places one after another into `kept`; returns how many were done.
fn evaluate(
    loaded: &Loaded,
    grid: &Grid,
    lines: &Lines,
    places: &[Place],
    residual: &[f64],
    kept: &mut [Vec<f64>],
    progress: &mut StressProgress,
) -> usize {
    let shape @ [nx, ny] = grid.shape();
    let [ox, oy] = lines.shape;
    let cells = ox * oy;
    // Planes go where they are kept, sections by way of a plane.
    let mut planes = match lines.whole() {
        true => Vec::new(),
        false => zeros(kept.len(), nx * ny),
    };
    let mut scratch = loaded.scratch(kept.len());
    for (done, place) in places.iter().enumerate() {
        loaded.coefficients(place, &mut scratch);
        let mut go_on = |part: f64| {
            progress((done as f64 + part) / places.len() as f64) == ControlFlow::Continue(())
        };
        let mut here: Vec<&mut [f64]> = kept
            .iter_mut()
            .map(|kept| &mut kept[done * cells..(done + 1) * cells])
            .collect();
        let whole = if planes.is_empty() {
            loaded.plane(&mut here, &mut scratch, &mut go_on)
        } else {
            let mut outputs: Vec<_> = planes.iter_mut().map(Vec::as_mut_slice).collect();
            loaded.plane(&mut outputs, &mut scratch, &mut go_on)
        };
        if !whole {
            return done;
        }
        for (plane, kept) in planes.iter().zip(&mut here) {
            lines.keep(plane, shape, kept);
        }
        let residual = residual[place.layer];
        if residual != 0.0 {
            for kept in &mut here[..2] {
                kept.iter_mut().for_each(|s| *s += residual);
            }
        }
    }
    // The last word; there is nothing left to stop.
    let _ = progress(1.0);
    places.len()
}

/// Residual stress of every layer and of the substrate.
fn residual(body: &HalfSpace, given: &[f64]) -> Result<Vec<f64>> {
    let count = body.layers().len() + 1;
    if given.len() > count {
        return Err(Error::Parameter {
            name: "residual",
            requirement: "of one value for each layer and the substrate, at most",
            value: given.len() as f64,
        });
    }
    let mut values = vec![0.0; count];
    for (value, given) in values.iter_mut().zip(given) {
        *value = finite("residual", *given)?;
    }
    Ok(values)
}
