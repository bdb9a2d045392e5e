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
//! left is that the pressure is uniform over a cell.
//!
//! Sliding adds the traction q = μ p along a direction; it does not act back on the pressure. That
//! holds where the bodies are alike (the same elastic constants), where ν = ½, or where μ is small:
//! the coupling that is left out changes the pressure by the order of μ (1 − 2ν)/(2 − 2ν).

use std::ops::ControlFlow;

use ndarray::{Array1, Array3, ArrayRef2};

use crate::body::{HalfSpace, Interface, Substrate};
use crate::error::{Error, Result, finite};
use crate::fft::{KernelRows, PaddedTransform, ParitySpectrum, Transformed, Workspace};
use crate::grid::Grid;
use crate::memory::check_memory;
use crate::response::interior::Place;
use crate::threads::Threads;

mod cells;
mod components;
mod hankel;
mod kernel;
mod line;
mod rectangle;
mod table;

use cells::{Cells, Source};
use components::{COMPONENTS, EXCHANGED, ODD};
use kernel::{Kernel, Plan};
use line::LinePlan;

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
    /// The side of an interface that was asked for.
    pub side: Side,
    /// σ_xx, σ_yy, σ_zz, σ_xy, σ_yz, σ_xz \[Pa\], in this order.
    pub components: [Array3<f64>; 6],
    /// u_x, u_y, u_z \[m\], where they were asked for; in line contact relative to the substrate's
    /// surface at a distance of the grid's width, as all displacements there.
    pub displacement: Option<[Array3<f64>; 3]>,
}

/// Stress of `body` at `depths` under `pressure` (nx, ny) \[Pa\] on `grid`.
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
    let places = depths
        .iter()
        .map(|&z| place(body, z, options.side))
        .collect::<Result<Vec<_>>>()?;
    let lines = Lines::new(grid, options.section)?;
    let fields = if options.displacement { COMPONENTS } else { 6 };
    let [ox, oy] = lines.shape;
    check_memory(
        grid.shape(),
        8 * (depths.len() * ox * oy * fields) as u64 + Loaded::memory(grid, options),
    )?;
    let loaded = Loaded::new(body, grid, pressure, options)?;
    let cells = ox * oy;
    let mut kept: Vec<Vec<f64>> = vec![vec![0.0; depths.len() * cells]; fields];
    let mut plane = vec![0.0; pressure.len()];
    let mut scratch = loaded.scratch(fields);
    let mut done = 0;
    'depths: for place in &places {
        loaded.coefficients(place, &mut scratch);
        for (k, kept) in kept.iter_mut().enumerate() {
            let part = (done as f64 + k as f64 / fields as f64) / places.len() as f64;
            if progress(part).is_break() {
                break 'depths;
            }
            let kept = &mut kept[done * cells..(done + 1) * cells];
            if lines.section.is_none() {
                loaded.apply(k, kept, &mut scratch);
            } else {
                loaded.apply(k, &mut plane, &mut scratch);
                lines.keep(&plane, grid.shape(), kept);
            }
        }
        done += 1;
    }
    if done == places.len() {
        // The last word; there is nothing left to stop.
        let _ = progress(1.0);
    }
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
        side: options.side,
        components,
        displacement,
    })
}

/// Where the depth `z` lies in `body`.
fn place(body: &HalfSpace, z: f64, side: Side) -> Result<Place> {
    /// Nearer than this to an interface, relatively, a depth lies on it: sums of thicknesses are
    /// rounded.
    const ON: f64 = 1e-12;
    if !(z >= 0.0 && z.is_finite()) {
        return Err(Error::Parameter {
            name: "z",
            requirement: "finite and at least 0",
            value: z,
        });
    }
    let mut top = 0.0;
    for ((layer, count), interface) in body.layers().iter().zip(0..).zip(body.interfaces()) {
        let on = (z - interface).abs() <= ON * interface;
        if z < interface && !on || on && side == Side::Above {
            let below_top = if on { layer.thickness() } else { z - top };
            return Ok(Place {
                layer: count,
                below_top,
                depth: if on { interface } else { z },
                material: layer.material(),
            });
        }
        top = if on { z } else { interface };
    }
    match body.substrate() {
        Substrate::Elastic(material) => Ok(Place {
            layer: body.layers().len(),
            below_top: z - top,
            depth: z,
            material,
        }),
        Substrate::Rigid => Err(Error::Parameter {
            name: "z",
            requirement: "above the rigid substrate (on it, with side \"above\")",
            value: z,
        }),
    }
}

/// The part of a plane that is kept.
struct Lines {
    x: Array1<f64>,
    y: Array1<f64>,
    shape: [usize; 2],
    section: Option<Line>,
}

/// A line across `axis`, between the cells `lower` and `lower + 1`.
struct Line {
    axis: usize,
    lower: usize,
    upper: usize,
    weight: f64,
}

impl Lines {
    fn new(grid: &Grid, section: Section) -> Result<Self> {
        let [nx, ny] = grid.shape();
        let (axis, at) = match section {
            Section::Plane => {
                return Ok(Self {
                    x: grid.x(),
                    y: grid.y(),
                    shape: [nx, ny],
                    section: None,
                });
            }
            Section::X(at) => (0, at),
            Section::Y(at) => (1, at),
        };
        let n = grid.shape()[axis];
        let name = ["x", "y"][axis];
        finite(name, at)?;
        let position =
            (at - grid.center()[axis]) / grid.spacing()[axis] + 0.5 * (n - 1) as f64;
        if !(-0.5 - 1e-9..=n as f64 - 0.5 + 1e-9).contains(&position) {
            return Err(Error::Parameter {
                name,
                requirement: "on the grid",
                value: at,
            });
        }
        // Rounding must not mix a neighbour into a line through cell centres.
        let nearest = position.round();
        let position = if (position - nearest).abs() < 1e-9 {
            nearest
        } else {
            position
        };
        let position = position.clamp(0.0, (n - 1) as f64);
        let lower = position as usize;
        let line = Line {
            axis,
            lower,
            upper: (lower + 1).min(n - 1),
            weight: position - lower as f64,
        };
        let here = Array1::from_elem(1, at);
        Ok(match axis {
            0 => Self {
                x: here,
                y: grid.y(),
                shape: [1, ny],
                section: Some(line),
            },
            _ => Self {
                x: grid.x(),
                y: here,
                shape: [nx, 1],
                section: Some(line),
            },
        })
    }

    /// The section of a plane.
    fn keep(&self, plane: &[f64], [nx, ny]: [usize; 2], kept: &mut [f64]) {
        let Some(line) = &self.section else {
            kept.copy_from_slice(plane);
            return;
        };
        // Along the line, from one cell to the next; across it.
        let (along, across, count) = match line.axis {
            0 => (1, ny, ny),
            _ => (ny, 1, nx),
        };
        for (k, value) in kept.iter_mut().enumerate().take(count) {
            let lower = plane[k * along + line.lower * across];
            let upper = plane[k * along + line.upper * across];
            *value = lower + line.weight * (upper - lower);
        }
    }
}

/// A body under a load, of which planes are evaluated.
struct Loaded {
    shape: [usize; 2],
    spacing: [f64; 2],
    kind: Kernels,
    /// μ times the unit vector of the traction.
    friction: [f64; 2],
    transform: PaddedTransform,
    pressure: Transformed,
    threads: Threads,
}

/// What makes the coefficients.
enum Kernels {
    Plane {
        plan: Plan,
        pressure: Vec<Vec<(f64, f64)>>,
        traction: Vec<Vec<(f64, f64)>>,
    },
    Line(LinePlan),
}

/// Memory that all depths use.
struct Scratch {
    loads: Vec<LoadCells>,
    rows: KernelRows,
    workspace: Workspace,
}

/// Coefficients of one load at one depth.
struct LoadCells {
    factor: f64,
    /// The axis along which it acts, and of which it turns the parities; none for pressure.
    axis: Option<usize>,
    cells: Cells,
    spectrum: ParitySpectrum,
}

impl LoadCells {
    fn flipped(&self) -> [bool; 2] {
        [0, 1].map(|axis| self.axis == Some(axis))
    }
}

impl Loaded {
    fn new(
        body: &HalfSpace,
        grid: &Grid,
        pressure: &ArrayRef2<f64>,
        options: &StressOptions,
    ) -> Result<Self> {
        let shape = grid.shape();
        let found = [pressure.nrows(), pressure.ncols()];
        if found != shape {
            return Err(Error::Shape {
                name: "pressure",
                expected: shape,
                found,
            });
        }
        if let Some((index, _)) = pressure.indexed_iter().find(|(_, p)| !p.is_finite()) {
            return Err(Error::NonFinite {
                name: "pressure",
                index: [index.0, index.1],
            });
        }
        let friction = friction(body, options)?;
        let threads = Threads::new(options.threads)?;
        let spacing = grid.spacing();
        let kind = if grid.is_line() {
            Kernels::Line(LinePlan::new(body, grid))
        } else {
            let [lx, ly] = grid.size();
            let plan = threads.run(|| Plan::new(body, spacing, 1.01 * lx.hypot(ly)));
            Kernels::Plane {
                pressure: plan.multipliers::<6, components::Pressure>(),
                traction: plan.multipliers::<9, components::Traction>(),
                plan,
            }
        };
        let transform = PaddedTransform::plan(shape, &threads);
        let input: Vec<f64> = pressure.iter().copied().collect();
        let pressure = transform.transform(&input, &mut transform.workspace(), &threads);
        Ok(Self {
            shape,
            spacing,
            kind,
            friction,
            transform,
            pressure,
            threads,
        })
    }

    /// Bytes that it takes, with the coefficients of one depth.
    fn memory(grid: &Grid, options: &StressOptions) -> u64 {
        let [nx, ny] = grid.shape().map(|n| n as u64);
        let loads = if options.friction == 0.0 { 1 } else { 3 };
        let fields = if options.displacement { 9 } else { 6 };
        // Coefficients of each load, and a spectrum; transforms of the pressure and of a plane.
        (nx + 1) * (ny + 1) * 8 * (loads * (2 * fields + 2) + 14)
    }

    /// Memory for `fields` components.
    fn scratch(&self, fields: usize) -> Scratch {
        let [fx, fy] = self.friction;
        let loads = [(1.0, None), (fx, Some(0)), (fy, Some(1))];
        Scratch {
            loads: loads
                .into_iter()
                .filter(|(factor, _)| *factor != 0.0)
                .map(|(factor, axis)| LoadCells {
                    factor,
                    axis,
                    cells: Cells::new(self.shape, fields),
                    spectrum: self.transform.empty_spectrum(),
                })
                .collect(),
            rows: self.transform.kernel_rows(),
            workspace: self.transform.workspace(),
        }
    }

    /// Computes the coefficients at `place`.
    fn coefficients(&self, place: &Place, scratch: &mut Scratch) {
        let (plan, pressure, traction) = match &self.kind {
            Kernels::Line(plan) => {
                for LoadCells { axis, cells, .. } in &mut scratch.loads {
                    cells.fill_line(&match axis {
                        None => plan.coefficients::<6, line::Pressure>(place),
                        Some(0) => plan.coefficients::<3, line::Along>(place),
                        Some(_) => plan.coefficients::<6, line::Across>(place),
                    });
                }
                return;
            }
            Kernels::Plane {
                plan,
                pressure,
                traction,
            } => (plan, pressure, traction),
        };
        self.threads.run(|| {
            let half @ [a, b] = self.spacing.map(|d| 0.5 * d);
            let mut of_traction = None;
            for load in &mut scratch.loads {
                let (spacing, depth, flipped) = (self.spacing, place.depth, load.flipped());
                let Some(axis) = load.axis else {
                    let kernel = Kernel::new::<components::Pressure>(plan, pressure, place);
                    let closed = rectangle::under_pressure;
                    load.cells.fill(&Source {
                        spacing,
                        depth,
                        flipped,
                        mean: |x, y| kernel.at::<components::Pressure>([x, y], half, closed),
                        point: |x, y| kernel.point::<components::Pressure>(x, y),
                    });
                    continue;
                };
                let kernel = of_traction.get_or_insert_with(|| {
                    Kernel::new::<components::Traction>(plan, traction, place)
                });
                let closed = rectangle::under_traction;
                let mean = |x, y, half| kernel.at::<components::Traction>([x, y], half, closed);
                let point = |x, y| kernel.point::<components::Traction>(x, y);
                if axis == 0 {
                    load.cells.fill(&Source {
                        spacing,
                        depth,
                        flipped,
                        mean: |x, y| mean(x, y, half),
                        point,
                    });
                } else {
                    let exchanged = |values: [f64; COMPONENTS]| EXCHANGED.map(|k| values[k]);
                    load.cells.fill(&Source {
                        spacing,
                        depth,
                        flipped,
                        mean: |x, y| exchanged(mean(y, x, [b, a])),
                        point: |x, y| exchanged(point(y, x)),
                    });
                }
            }
        });
    }

    /// Component `k` on the plane of the coefficients.
    fn apply(&self, k: usize, output: &mut [f64], scratch: &mut Scratch) {
        let Scratch {
            loads,
            rows,
            workspace,
        } = scratch;
        for load in loads.iter_mut() {
            let flipped = load.flipped();
            let odd = [0, 1].map(|axis| ODD[k][axis] != flipped[axis]);
            let cells = &load.cells;
            self.transform.parity_spectrum_into(
                odd,
                |i| cells.row(i, k),
                &mut load.spectrum,
                rows,
                workspace,
                &self.threads,
            );
        }
        let kernels: Vec<(f64, &ParitySpectrum)> = loads
            .iter()
            .map(|load| (load.factor, &load.spectrum))
            .collect();
        self.transform
            .convolve_parities(&self.pressure, &kernels, output, workspace, &self.threads);
    }
}

/// μ times the unit vector of the traction on the body.
fn friction(body: &HalfSpace, options: &StressOptions) -> Result<[f64; 2]> {
    let friction = finite("friction", options.friction)?;
    if friction < 0.0 {
        return Err(Error::Parameter {
            name: "friction",
            requirement: "at least 0 (turn the direction)",
            value: friction,
        });
    }
    let [x, y] = options.direction;
    let length = x.hypot(y);
    if !(length > 0.0 && length.is_finite()) {
        return Err(Error::Parameter {
            name: "direction",
            requirement: "a vector of finite length above 0",
            value: length,
        });
    }
    let slips = |layer: &crate::Layer| layer.interface() == Interface::Frictionless;
    if friction > 0.0 && body.layers().iter().any(slips) {
        return Err(Error::Inconsistent(
            "friction must be 0 on a body with a frictionless interface: nothing holds the layers \
             above it",
        ));
    }
    Ok([friction * x / length, friction * y / length])
}
