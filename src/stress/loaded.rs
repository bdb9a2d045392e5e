//! A body under pressure and friction: one component on one plane is one convolution.

use ndarray::ArrayRef2;

use super::StressOptions;
use super::cells::{Cells, Source};
use super::components::{self, COMPONENTS, EXCHANGED, ODD};
use super::kernel::{Kernel, Plan};
use super::line::{self, LinePlan};
use super::rectangle;
use crate::body::{HalfSpace, Interface};
use crate::error::{Error, Result, finite};
use crate::fft::{KernelRows, PaddedTransform, ParitySpectrum, Transformed, Workspace};
use crate::grid::Grid;
use crate::response::interior::Place;
use crate::threads::Threads;

/// A body under a load, of which planes are evaluated.
#[derive(Debug)]
pub(super) struct Loaded {
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
#[derive(Debug)]
enum Kernels {
    Plane {
        plan: Box<Plan>,
        pressure: Vec<Vec<(f64, f64)>>,
        traction: Vec<Vec<(f64, f64)>>,
    },
    Line(LinePlan),
}

/// Memory that all depths use.
#[derive(Debug)]
pub(super) struct Scratch {
    loads: Vec<LoadCells>,
    rows: KernelRows,
    workspace: Workspace,
}

/// Coefficients of one load at one depth.
#[derive(Debug)]
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
    pub(super) fn new(
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
                plan: Box::new(plan),
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

    /// μ times the unit vector of the traction on the body.
    pub(super) fn friction(&self) -> [f64; 2] {
        self.friction
    }

    /// Bytes that it takes, with the coefficients of one depth.
    pub(super) fn memory(grid: &Grid, options: &StressOptions) -> u64 {
        let [nx, ny] = grid.shape().map(|n| n as u64);
        let loads = if options.friction == 0.0 { 1 } else { 3 };
        let fields = if options.displacement { 9 } else { 6 };
        // Coefficients of each load, and a spectrum; transforms of the pressure and of a plane.
        (nx + 1) * (ny + 1) * 8 * (loads * (2 * fields + 2) + 14)
    }

    /// Memory for `fields` components.
    pub(super) fn scratch(&self, fields: usize) -> Scratch {
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
    pub(super) fn coefficients(&self, place: &Place, scratch: &mut Scratch) {
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
    pub(super) fn apply(&self, k: usize, output: &mut [f64], scratch: &mut Scratch) {
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
        self.transform.convolve_parities(
            &self.pressure,
            &kernels,
            output,
            workspace,
            &self.threads,
        );
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
